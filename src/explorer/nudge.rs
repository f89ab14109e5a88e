//! A parameter turned by one of its digits, through round values, in the unit in which it is shown.
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
    /// The third digit.
    Third,
    /// The second digit; for the rate of a pull, a third of a decade.
    Second,
    /// The first digit; for the device's stiffness 1, 2 and 5 of a decade, for the rate of a pull a decade.
    First,
}

impl Amount {
    /// How many digits a turned value has.
    fn digits(self) -> i32 {
        match self {
            Self::Third => 3,
            Self::Second => 2,
            Self::First => 1,
        }
    }
}

/// The next value above or below `x` that has this many digits; `x` is not 0, and its sign stays.
fn turned(x: f64, up: bool, digits: i32) -> f64 {
    /// The rounding error allowed in a digit.
    const ROUNDING: f64 = 1e-9;
    let (size, grows) = (x.abs(), up == (x > 0.0));
    // For a double it is between -324 and 308.
    #[expect(clippy::cast_possible_truncation)]
    let mut unit = size.log10().floor() as i32 + 1 - digits;
    let steps = |unit: i32| size / 10f64.powi(unit);
    // Going down, a power of ten uses the digits of the decade below.
    if !grows && steps(unit) <= 10f64.powi(digits - 1) * (1.0 + ROUNDING) {
        unit -= 1;
    }
    let at = steps(unit);
    let next =
        if grows { (at * (1.0 + ROUNDING)).floor() + 1.0 } else { (at * (1.0 - ROUNDING)).ceil() - 1.0 };
    // Parsed from text: exactly the number that is written.
    format!("{}{next}e{unit}", if x < 0.0 { "-" } else { "" }).parse().unwrap_or(x)
}

/// `preset` with the value of `row` nudged up or down; `contact` is the contact's own stiffness in the user's units,
/// the scale for the stiffness of the device.
/// Errors: Why it cannot be nudged, in words: out of range, or a text.
pub fn nudge(
    preset: &Preset,
    row: &Parameter,
    up: bool,
    amount: Amount,
    contact: f64,
) -> Result<Preset, String> {
    let share = 0.1_f64.powi(amount.digits());
    let mut changed = preset.clone();
    let value = match (row.kind, preset.get(&row.key)) {
        (_, value) if matches!(&*row.key, data::OFFSET | data::BASELINE) => {
            Value::Number(tidy(shifted(preset, &row.key, value, if up { share } else { -share })?))
        }
        (Kind::Positive, Some(Value::Number(x))) if row.key == RATE && amount != Amount::Third => {
            let thirds = if amount == Amount::First { 3.0 } else { 1.0 };
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
            let shown = row.shown(&preset.units, x);
            let text = shown.text(&format!("{:?}", turned(shown.number, up, amount.digits())), true);
            preset.typed(row, &text).map_err(|invalid| invalid.to_string())?
        }
        (Kind::Integer { .. }, Some(Value::Integer(n))) => {
            // Exact for every count; at least one, so that small counts move too.
            #[expect(clippy::cast_possible_truncation)]
            let to = if n == 0 { 0 } else { turned(n as f64, up, amount.digits()).round() as i64 };
            Value::Integer(if up { to.max(n + 1) } else { to.min(n - 1) })
        }
        (Kind::Choice(words), Some(Value::Text(word))) => {
            let at = words.iter().position(|w| *w == word).unwrap_or(0);
            let step = if up { 1 } else { words.len() - 1 };
            Value::Text(words[(at + step) % words.len()].to_owned())
        }
        (Kind::Control, Some(Value::Control(control))) => {
            Value::Control(stiffened(control, up, amount, contact)?)
        }
        _ => return Err(format!("{} is text; {} types it", row.label, Id::Edit.named())),
    };
    changed.set(&row.key, value).map_err(|invalid| invalid.to_string())?;
    Ok(changed)
}

/// A rate this many thirds of a decade further: one at a third of a decade goes to another, whatever its last digits.
fn by_thirds(x: f64, thirds: f64) -> f64 {
    const NEAR: f64 = 1e-4;
    let here = 3.0 * x.log10();
    let there = thirds + if (here - here.round()).abs() < NEAR { here.round() } else { here };
    10.0_f64.powf(there / 3.0)
}

/// δ₀ or P₀ moved by a tenth of `share` of the range of the measured curve: either may be 0, so it has no scale of its
/// own.
fn shifted(preset: &Preset, key: &str, value: Option<Value>, share: f64) -> Result<f64, String> {
    let Some(branches) = preset.branches().transpose()? else {
        return Err("there is no measured curve to shift".to_owned());
    };
    let (range, found) = match key {
        data::OFFSET => (branches.ranges[0], 0.0),
        _ => (branches.ranges[1], branches.baseline.or(preset.data.tare).unwrap_or(0.0)),
    };
    Ok(value.and_then(|value| value.as_number()).unwrap_or(found) + 0.1 * share * range)
}

/// Stiffnesses over the contact's own; beyond them, the device is displacement or force control to a few thousandths.
const STIFFNESSES: RangeInclusive<f64> = 1e-3..=1e3;

/// `control` made stiffer or softer: force, a spring whose stiffness k is turned by its digits, displacement.
///
/// `contact` is the stiffness of the contact itself, in the user's units.
fn stiffened(control: Control, up: bool, amount: Amount, contact: f64) -> Result<Control, String> {
    // By the first digit: 1, 2 and 5 of a decade; that range has six decades.
    let next = |k: f64| {
        let round = |k: f64| turned(k, up, amount.digits());
        let is_round =
            |k: &f64| [1.0, 2.0, 5.0].iter().any(|m| (k / 10f64.powf(k.log10().floor()) - m).abs() < 1e-9);
        let all = std::iter::successors(Some(round(k)), |k| Some(round(*k))).take(10);
        if amount == Amount::First {
            all.clone().find(is_round).unwrap_or_else(|| round(k))
        } else {
            round(k)
        }
    };
    let (softest, stiffest) = (STIFFNESSES.start() * contact, STIFFNESSES.end() * contact);
    Ok(match (control, up) {
        (Control::Displacement, true) => {
            return Err("displacement control is the stiffest device there is".to_owned());
        }
        (Control::Force, false) => return Err("force control is the softest device there is".to_owned()),
        (Control::Displacement, false) => Control::Stiffness(tidy(stiffest)),
        (Control::Force, true) => Control::Stiffness(tidy(softest)),
        (Control::Stiffness(k), true) if next(k) > stiffest => Control::Displacement,
        (Control::Stiffness(k), false) if next(k) < softest => Control::Force,
        (Control::Stiffness(k), _) => Control::Stiffness(next(k)),
    })
}

/// The stiffness to offer for a spring: the `last` one, or one as stiff as the paper's contacts themselves in reduced
/// units, so that all three kinds of limit points differ.
pub fn spring(preset: &Preset, last: Option<f64>) -> f64 {
    const STIFFNESS: f64 = 0.15;
    last.unwrap_or_else(|| tidy(STIFFNESS * preset.reduced().units.stiffness))
}

/// `x` rounded to six significant digits: a stiffness derived from the problem stays readable.
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
    fn values_go_through_round_ones_and_never_reach_zero() {
        for (x, up, digits, next) in [
            (0.0025, true, 2, 0.0026),
            (0.0025, false, 2, 0.0024),
            (0.0025, true, 1, 0.003),
            (0.0025, false, 1, 0.002),
            (0.0025, true, 3, 0.00251),
            (0.001, false, 2, 0.00099),
            (0.00099, true, 2, 0.001),
            (0.001, false, 1, 0.0009),
            (9.7, true, 2, 9.8),
            (9.9, true, 2, 10.0),
            (0.003_978_87, true, 2, 0.004),
            (-0.3, true, 1, -0.2),
            (-0.3, false, 1, -0.4),
            (795.774_7, false, 3, 795.0),
        ] {
            let found = turned(x, up, digits);
            assert!(found.total_cmp(&next).is_eq(), "{x} {up} {digits}: {found} {next}");
        }
        let mut preset = preset();
        let row = &parameter("gap.amplitude").unwrap();
        let up = nudge(&preset, row, true, Amount::Second, 1.0).unwrap();
        assert_eq!(up.get(&row.key), Some(Value::Number(0.0026)));
        assert_eq!(nudge(&up, row, false, Amount::Second, 1.0).unwrap(), preset, "there and back");
        for _ in 0..200 {
            preset = nudge(&preset, row, false, Amount::First, 1.0).unwrap();
        }
        assert!(matches!(preset.get(&row.key), Some(Value::Number(x)) if x > 0.0));
        // In the preset's own unit.
        let preset = read("t", crate::store::shipped::find("fig-9-si").unwrap().text).unwrap();
        let up = nudge(&preset, row, true, Amount::Second, 1.0).unwrap();
        assert_eq!(up.get(&row.key), Some(Value::Number(1.3e-5)));
    }

    #[test]
    fn counts_stop_at_their_range() {
        let mut preset = preset();
        let rings = &parameter("basis.rings").unwrap();
        preset.set("basis.kind", "rings".into()).unwrap();
        for (amount, count) in [(Amount::First, 300), (Amount::Second, 210), (Amount::Third, 201)] {
            let more = nudge(&preset, rings, true, amount, 1.0).unwrap();
            assert_eq!(more.get("basis.rings"), Some(Value::Integer(count)));
        }
        preset.set("basis.rings", Value::Integer(4)).unwrap();
        assert!(nudge(&preset, rings, false, Amount::Third, 1.0).unwrap_err().contains('4'));
        let kind = &parameter("basis.kind").unwrap();
        let other = nudge(&preset, kind, true, Amount::Second, 1.0).unwrap();
        assert_eq!((other.get("basis.kind"), other.get("basis.rings")), (Some("exact".into()), None));
        let back = nudge(&other, kind, true, Amount::Second, 1.0).unwrap();
        assert_eq!(back.get("basis.rings"), Some(Value::Integer(200)));
        preset.set("gap.shape", "power-law".into()).unwrap();
        let exponent = &preset.row("gap.exponent").unwrap();
        let steeper = nudge(&preset, exponent, true, Amount::Second, 1.0).unwrap();
        assert_eq!(steeper.get("gap.exponent"), Some(Value::Number(2.1)));
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
        assert!(turn(&mut preset, true, Amount::Second).unwrap_err().contains("stiffest"));
        assert_eq!(turn(&mut preset, false, Amount::Second), Ok(Control::Stiffness(2000.0)));
        let mut passed = Vec::new();
        let softest = loop {
            match turn(&mut preset, false, Amount::First).unwrap() {
                Control::Stiffness(k) => passed.push(k),
                end => break end,
            }
        };
        assert_eq!((softest, &passed[..4]), (Control::Force, &[1000.0, 500.0, 200.0, 100.0][..]));
        assert_eq!(passed.len(), 18, "{passed:?}");
        assert!(turn(&mut preset, false, Amount::First).unwrap_err().contains("softest"));
        assert_eq!(turn(&mut preset, true, Amount::First), Ok(Control::Stiffness(0.002)));
        assert_eq!(turn(&mut preset, true, Amount::Second), Ok(Control::Stiffness(0.0021)));
        preset.path.control = Control::Stiffness(1999.0);
        assert_eq!(turn(&mut preset, true, Amount::First), Ok(Control::Stiffness(2000.0)));
        assert_eq!(turn(&mut preset, true, Amount::First), Ok(Control::Displacement));
        // A stiffness typed beyond the ends turns back in steps, and on to the end.
        preset.path.control = Control::Stiffness(1e6);
        assert_eq!(turn(&mut preset, false, Amount::First), Ok(Control::Stiffness(500_000.0)));
        assert_eq!(turn(&mut preset, true, Amount::First), Ok(Control::Displacement));
    }

    #[test]
    fn a_spring_is_offered_as_stiff_as_the_last_one() {
        let offered = [None, Some(0.2)].map(|last| Control::Stiffness(spring(&preset(), last)));
        assert_eq!(offered, [0.15, 0.2].map(Control::Stiffness));
    }
}
