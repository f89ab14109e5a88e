//! A parameter changed by a little: logarithmic where a quantity is positive.

use crate::contact::Control;
use crate::preset::schema::Kind;
use crate::preset::{Parameter, Preset, Value};

/// How far one key press goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Amount {
    /// 1 %.
    Fine,
    /// 10 %.
    Coarse,
}

/// `preset` with the value of `row` nudged up or down.
///
/// # Errors
/// Why it cannot be nudged, in words: out of range, or a text.
pub fn nudge(preset: &Preset, row: &Parameter, up: bool, amount: Amount) -> Result<Preset, String> {
    let share = if amount == Amount::Fine { 0.01 } else { 0.1 };
    let mut changed = preset.clone();
    let value = match (row.kind, preset.get(row.key)) {
        (_, None) => {
            return Err(format!("{} follows from other values; Enter types one", row.label));
        }
        (Kind::Positive | Kind::NonNegative | Kind::Finite, Some(Value::Number(x))) => {
            if x == 0.0 {
                return Err(format!(
                    "{} is 0 and has no scale to nudge it by; Enter types a value",
                    row.label
                ));
            }
            Value::Number(tidy(if up == (x > 0.0) { x * (1.0 + share) } else { x / (1.0 + share) }))
        }
        (Kind::Integer { .. } | Kind::Count { .. }, Some(Value::Integer(n))) => {
            // Exact for every count; at least one, so that small counts move too.
            #[expect(clippy::cast_possible_truncation)]
            let by = ((n as f64 * share).round() as i64).max(1);
            Value::Integer(if up { n + by } else { n - by })
        }
        (Kind::Count { .. }, Some(_)) => {
            return Err(format!("{} is chosen by the program; Enter types a number", row.label));
        }
        (Kind::Choice(words), Some(Value::Text(word))) => {
            let at = words.iter().position(|w| *w == word).unwrap_or(0);
            let step = if up { 1 } else { words.len() - 1 };
            Value::Text(words[(at + step) % words.len()].to_owned())
        }
        (Kind::Control, Some(Value::Control(control))) => Value::Control(next_control(preset, control, up)),
        _ => return Err(format!("{} is a text; Enter types it", row.label)),
    };
    changed.set(row.key, value).map_err(|invalid| invalid.to_string())?;
    Ok(changed)
}

/// The control after `control`: displacement, force, a spring, and round again.
pub fn next_control(preset: &Preset, control: Control, up: bool) -> Control {
    // As stiff as the paper's contacts themselves in reduced units: all three kinds of limit points differ.
    const STIFFNESS: f64 = 0.15;
    let spring = || {
        let units = preset.problem().reduced().units;
        Control::Stiffness(tidy(STIFFNESS * units.stiffness))
    };
    match (control, up) {
        (Control::Displacement, true) | (Control::Stiffness(_), false) => Control::Force,
        (Control::Force, true) | (Control::Displacement, false) => spring(),
        (Control::Stiffness(_), true) | (Control::Force, false) => Control::Displacement,
    }
}

/// `x` rounded to six significant digits: nudged values stay readable and a nudge back comes close.
fn tidy(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preset::{parameter, read};

    /// The paper's Fig. 9, in 200 rings.
    fn preset() -> Preset {
        read("t", crate::preset::shipped::find("fig-9").unwrap().text).unwrap()
    }

    #[test]
    fn positive_values_move_by_a_share_and_never_reach_zero() {
        let mut preset = preset();
        let row = parameter("gap.amplitude").unwrap();
        let up = nudge(&preset, row, true, Amount::Fine).unwrap();
        assert_eq!(up.get(row.key), Some(Value::Number(0.002_525)));
        for _ in 0..200 {
            preset = nudge(&preset, row, false, Amount::Coarse).unwrap();
        }
        assert!(matches!(preset.get(row.key), Some(Value::Number(x)) if x > 0.0));
    }

    #[test]
    fn counts_stop_at_their_range_and_controls_go_round() {
        let mut preset = preset();
        let rings = parameter("basis.rings").unwrap();
        preset.set("basis.rings", Value::Integer(4)).unwrap();
        assert!(nudge(&preset, rings, false, Amount::Fine).unwrap_err().contains('4'));
        let kind = parameter("basis.kind").unwrap();
        let other = nudge(&preset, kind, true, Amount::Fine).unwrap();
        assert_eq!(other.get("basis.functions"), Some("auto".into()));
        let back = nudge(&other, kind, true, Amount::Fine).unwrap();
        assert_eq!(back.get("basis.rings"), Some(Value::Integer(200)));
        let control = parameter("path.control").unwrap();
        let start = preset.get("path.control");
        for _ in 0..3 {
            preset = nudge(&preset, control, true, Amount::Fine).unwrap();
        }
        assert_eq!(preset.get("path.control"), start);
    }
}
