//! A parameter changed by a little: logarithmic where a quantity is positive.
//!
//! The control is one knob: the stiffness k of the loading device, with force control (k → 0) and displacement control
//! (k → ∞) as its ends.

use super::command::Id;
use pulloff_engine::preset::edge::RATE;
use pulloff_engine::preset::schema::Kind;
use pulloff_engine::preset::{Parameter, Preset, Value, data};
use pulloff_engine::problem::Control;
use std::ops::RangeInclusive;

/// How far one key press goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Amount {
    /// 1 %, of the device's stiffness 3 %, of the rate of a pull a third of a decade.
    Fine,
    /// 10 %, of the device's stiffness a factor of 2, of the rate of a pull a decade.
    Coarse,
}

/// `preset` with the value of `row` nudged up or down; `contact` is the contact's own stiffness in the user's units,
/// against which that of the device is judged.
/// Errors: Why it cannot be nudged, in words: out of range, or a text.
pub fn nudge(
    preset: &Preset,
    row: &Parameter,
    up: bool,
    amount: Amount,
    contact: f64,
) -> Result<Preset, String> {
    let share = if amount == Amount::Fine { 0.01 } else { 0.1 };
    let mut changed = preset.clone();
    let value = match (row.kind, preset.get(&row.key)) {
        (_, value) if matches!(&*row.key, data::OFFSET | data::BASELINE) => {
            Value::Number(tidy(shifted(preset, &row.key, value, if up { share } else { -share })?))
        }
        (Kind::Positive, Some(Value::Number(x))) if row.key == RATE => {
            let thirds = if amount == Amount::Fine { 1.0 } else { 3.0 };
            Value::Number(tidy(by_thirds(x, if up { thirds } else { -thirds })))
        }
        (_, None) => {
            return Err(format!("{} follows from other values; {} types one", row.label, Id::Edit.named()));
        }
        (
            Kind::Positive | Kind::NonNegative | Kind::Finite | Kind::Between { .. } | Kind::Smoothing,
            Some(Value::Number(x)),
        ) => {
            if x == 0.0 {
                return Err(format!(
                    "{} is 0 and has no scale to nudge it by; {} types a value",
                    row.label,
                    Id::Edit.named()
                ));
            }
            Value::Number(tidy(if up == (x > 0.0) { x * (1.0 + share) } else { x / (1.0 + share) }))
        }
        (Kind::Integer { .. }, Some(Value::Integer(n))) => {
            // Exact for every count; at least one, so that small counts move too.
            #[expect(clippy::cast_possible_truncation)]
            let by = ((n as f64 * share).round() as i64).max(1);
            Value::Integer(if up { n + by } else { n - by })
        }
        (Kind::Choice(words), Some(Value::Text(word))) => {
            let at = words.iter().position(|w| *w == word).unwrap_or(0);
            let step = if up { 1 } else { words.len() - 1 };
            Value::Text(words[(at + step) % words.len()].to_owned())
        }
        (Kind::Control, Some(Value::Control(control))) => {
            Value::Control(stiffened(control, up, amount, contact)?)
        }
        _ => return Err(format!("{} is a text; {} types it", row.label, Id::Edit.named())),
    };
    changed.set(&row.key, value).map_err(|invalid| invalid.to_string())?;
    Ok(changed)
}

/// A rate so many thirds of a decade further: one that is at a third of a decade goes to another, whatever its last digits.
fn by_thirds(x: f64, thirds: f64) -> f64 {
    const NEAR: f64 = 1e-4;
    let here = 3.0 * x.log10();
    let there = thirds + if (here - here.round()).abs() < NEAR { here.round() } else { here };
    10.0_f64.powf(there / 3.0)
}

/// δ₀ or P₀ moved by a tenth of `share` of the range of the measured curve: either may be 0, and has no scale of its own.
fn shifted(preset: &Preset, key: &str, value: Option<Value>, share: f64) -> Result<f64, String> {
    let Some(branches) = preset.branches().transpose()? else {
        return Err("there is no measured curve to shift".to_owned());
    };
    let (range, found) = match key {
        data::OFFSET => (branches.ranges[0], 0.0),
        _ => (branches.ranges[1], branches.baseline.unwrap_or(0.0)),
    };
    Ok(value.and_then(|value| value.as_number()).unwrap_or(found) + 0.1 * share * range)
}

/// Stiffnesses over the contact's own; beyond them the device is displacement or force control to a few thousandths.
const STIFFNESSES: RangeInclusive<f64> = 1e-3..=1e3;

/// `control` made stiffer or softer: force, a spring of stiffness k by its logarithm, displacement.
///
/// `contact` is the stiffness of the contact itself, in the user's units.
fn stiffened(control: Control, up: bool, amount: Amount, contact: f64) -> Result<Control, String> {
    let by = if amount == Amount::Fine { 1.03 } else { 2.0 };
    let (softest, stiffest) = (STIFFNESSES.start() * contact, STIFFNESSES.end() * contact);
    Ok(match (control, up) {
        (Control::Displacement, true) => {
            return Err("displacement control is the stiffest device there is".to_owned());
        }
        (Control::Force, false) => return Err("force control is the softest device there is".to_owned()),
        (Control::Displacement, false) => Control::Stiffness(tidy(stiffest)),
        (Control::Force, true) => Control::Stiffness(tidy(softest)),
        (Control::Stiffness(k), true) if k * by > stiffest => Control::Displacement,
        (Control::Stiffness(k), false) if k / by < softest => Control::Force,
        (Control::Stiffness(k), true) => Control::Stiffness(tidy(k * by)),
        (Control::Stiffness(k), false) => Control::Stiffness(tidy(k / by)),
    })
}

/// The control after that of `preset`: displacement, force, a spring (of stiffness `last`), and round again.
pub fn next_control(preset: &Preset, last: Option<f64>) -> Control {
    // As stiff as the paper's contacts themselves in reduced units: all three kinds of limit points differ.
    const STIFFNESS: f64 = 0.15;
    match preset.path.control {
        Control::Displacement => Control::Force,
        Control::Force => {
            let k = last.unwrap_or_else(|| tidy(STIFFNESS * preset.reduced().units.stiffness));
            Control::Stiffness(k)
        }
        Control::Stiffness(_) => Control::Displacement,
    }
}

/// `x` rounded to six significant digits: nudged values stay readable and a nudge back comes close.
fn tidy(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::read;

    #[test]
    fn a_rate_goes_by_thirds_of_a_decade_and_back() {
        let mut x = 0.01;
        let found: Vec<f64> = (0..4)
            .map(|_| {
                x = tidy(by_thirds(x, 1.0));
                x
            })
            .collect();
        let near = |(a, b): (&f64, f64)| (a / b - 1.0).abs() < 1e-12;
        assert!(found.iter().zip([0.021_544_3, 0.046_415_9, 0.1, 0.215_443]).all(near), "{found:?}");
        assert!(near((&tidy(by_thirds(0.1, -3.0)), 0.01)));
        assert!((by_thirds(0.03, 1.0) / 0.03 - 10.0_f64.powf(1.0 / 3.0)).abs() < 1e-12);
    }
    use pulloff_engine::preset::parameter;

    /// The paper's Fig. 9, in 200 rings.
    fn preset() -> Preset {
        read("t", crate::store::shipped::find("fig-9").unwrap().text).unwrap()
    }

    #[test]
    fn positive_values_move_by_a_share_and_never_reach_zero() {
        let mut preset = preset();
        let row = &parameter("gap.amplitude").unwrap();
        let up = nudge(&preset, row, true, Amount::Fine, 1.0).unwrap();
        assert_eq!(up.get(&row.key), Some(Value::Number(0.002_525)));
        for _ in 0..200 {
            preset = nudge(&preset, row, false, Amount::Coarse, 1.0).unwrap();
        }
        assert!(matches!(preset.get(&row.key), Some(Value::Number(x)) if x > 0.0));
    }

    #[test]
    fn counts_stop_at_their_range() {
        let mut preset = preset();
        let rings = &parameter("basis.rings").unwrap();
        preset.set("basis.kind", "rings".into()).unwrap();
        preset.set("basis.rings", Value::Integer(4)).unwrap();
        assert!(nudge(&preset, rings, false, Amount::Fine, 1.0).unwrap_err().contains('4'));
        let kind = &parameter("basis.kind").unwrap();
        let other = nudge(&preset, kind, true, Amount::Fine, 1.0).unwrap();
        assert_eq!((other.get("basis.kind"), other.get("basis.rings")), (Some("exact".into()), None));
        let back = nudge(&other, kind, true, Amount::Fine, 1.0).unwrap();
        assert_eq!(back.get("basis.rings"), Some(Value::Integer(200)));
        preset.set("gap.shape", "power-law".into()).unwrap();
        let exponent = &preset.row("gap.exponent").unwrap();
        let steeper = nudge(&preset, exponent, true, Amount::Coarse, 1.0).unwrap();
        assert_eq!(steeper.get("gap.exponent"), Some(Value::Number(2.2)));
    }

    #[test]
    fn the_device_gets_stiffer_up_to_displacement_and_softer_down_to_force() {
        let mut preset = preset();
        let row = &parameter("path.control").unwrap();
        let contact = 2.0;
        let turn = |preset: &mut Preset, up, amount| {
            let turned = nudge(preset, row, up, amount, contact);
            turned.map(|turned| {
                *preset = turned;
                preset.path.control
            })
        };
        assert!(turn(&mut preset, true, Amount::Fine).unwrap_err().contains("stiffest"));
        assert_eq!(turn(&mut preset, false, Amount::Fine), Ok(Control::Stiffness(2000.0)));
        let mut before = 2000.0;
        let softest = loop {
            match turn(&mut preset, false, Amount::Coarse).unwrap() {
                Control::Stiffness(k) => {
                    assert!((before / k / 2.0 - 1.0).abs() < 1e-5, "{before} {k}");
                    before = k;
                }
                end => break end,
            }
        };
        assert_eq!(softest, Control::Force);
        assert!((0.002..0.004).contains(&before), "{before}");
        assert!(turn(&mut preset, false, Amount::Coarse).unwrap_err().contains("softest"));
        assert_eq!(turn(&mut preset, true, Amount::Coarse), Ok(Control::Stiffness(0.002)));
        preset.path.control = Control::Stiffness(1999.0);
        assert_eq!(turn(&mut preset, true, Amount::Fine), Ok(Control::Displacement));
        // A stiffness typed beyond the ends turns back by steps, and on to the end.
        preset.path.control = Control::Stiffness(1e6);
        assert_eq!(turn(&mut preset, false, Amount::Coarse), Ok(Control::Stiffness(500_000.0)));
        assert_eq!(turn(&mut preset, true, Amount::Coarse), Ok(Control::Displacement));
    }

    #[test]
    fn controls_go_round_and_come_back_to_the_last_stiffness() {
        let mut preset = preset();
        for expected in [Control::Force, Control::Stiffness(0.15), Control::Displacement, Control::Force] {
            preset.path.control = next_control(&preset, None);
            assert_eq!(preset.path.control, expected);
        }
        assert_eq!(next_control(&preset, Some(0.2)), Control::Stiffness(0.2));
    }
}
