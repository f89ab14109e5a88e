//! Rows that no table can list, recognized by the form of their keys: the parameters of a formula and the waves of a
//! sum.
//!
//! | key | row |
//! |---|---|
//! | `gap.parameters.NAME` | a parameter of the formula, `NAME` as in the formula |
//! | `gap.parameters.NAME.min`, `.max`, `.unit` | its range and its unit |
//! | `gap.waves.N.amplitude`, `.wavelength`, `.phase` | the Nth wave, counted from 1 |
//!
//! In a file a parameter is `NAME = value` or `NAME = { value = …, min = …, max = …, unit = … }` below
//! `[gap.parameters]`, and every wave is a table `[[gap.waves]]`.

use super::schema::{Applies, CHOOSERS, Fallback, Kind, Parameter};
use crate::expression::error::NAME;
use crate::expression::function::Function;
use crate::gap::shapes::harmonics::MOST_WAVES;
use crate::units::Quantity;
use std::borrow::Cow::{self, Borrowed};
use std::fmt::Display;

/// The table of the parameters of a formula.
pub const PARAMETER_TABLE: &str = "gap.parameters";
/// The tables of waves.
pub const WAVE_TABLE: &str = "gap.waves";
/// How many waves have knobs: a list of thousands would be of no use.
pub const WAVE_KNOBS: usize = 20;
/// The keys of a wave.
pub const WAVE_KEYS: [&str; 3] = ["amplitude", "wavelength", "phase"];
/// What a parameter may have besides its value.
pub const PARAMETER_KEYS: [&str; 3] = ["min", "max", "unit"];

/// The row of a key of either family.
pub fn row(key: &str) -> Option<Parameter> {
    if let Some(name) = below(key, PARAMETER_TABLE) {
        return match name.split_once('.') {
            None => is_name(name).then(|| parameter(name)),
            Some((name, part)) if is_name(name) => limit(name, part),
            Some(_) => None,
        };
    }
    let (number, name) = below(key, WAVE_TABLE)?.split_once('.')?;
    wave(wave_number(number)?, name)
}

/// The rows as the manual shows them: `NAME` and `N` stand for what a preset has in that place.
pub fn examples() -> impl Iterator<Item = Parameter> {
    let limits = PARAMETER_KEYS.iter().filter_map(|part| limit("NAME", part));
    std::iter::once(parameter("NAME"))
        .chain(limits)
        .chain(WAVE_KEYS.iter().filter_map(|name| wave("N", name)))
}

/// Whether a key holds other keys of a family: `gap.parameters`, one of its parameters, `gap.waves`, a wave.
pub fn is_table(key: &str) -> bool {
    let inside = |table| below(key, table);
    key == PARAMETER_TABLE
        || key == WAVE_TABLE
        || inside(PARAMETER_TABLE).is_some_and(is_name)
        || inside(WAVE_TABLE).is_some_and(|number| wave_number(number).is_some())
}

/// Whether a key is a parameter of a formula, not its range.
pub fn is_parameter(key: &str) -> bool {
    below(key, PARAMETER_TABLE).is_some_and(is_name)
}

/// Whether a key is the phase of a wave.
pub fn is_phase(key: &str) -> bool {
    below(key, WAVE_TABLE).and_then(|rest| rest.split_once('.')).is_some_and(|(_, name)| name == WAVE_KEYS[2])
}

/// Whether a key is the unit of a parameter.
pub fn is_unit(key: &str) -> bool {
    key.strip_suffix(".unit").is_some_and(is_parameter)
}

/// Whether a key may have a knob: the waves after the first [`WAVE_KNOBS`] have none.
pub fn has_knob(key: &str) -> bool {
    let number = below(key, WAVE_TABLE).and_then(|rest| wave_number(rest.split_once('.')?.0));
    number.is_none_or(|number| number <= WAVE_KNOBS)
}

/// The dotted key of a parameter.
pub fn parameter_key(name: &str) -> String {
    format!("{PARAMETER_TABLE}.{name}")
}

/// The dotted key of a wave, counted from 1.
pub fn wave_key(number: impl Display, name: &str) -> String {
    format!("{WAVE_TABLE}.{number}.{name}")
}

/// The rest of `key` below `table`.
pub fn below<'a>(key: &'a str, table: &str) -> Option<&'a str> {
    key.strip_prefix(table)?.strip_prefix('.')
}

/// Whether a formula can have a parameter of this name: `r`, `pi`, `e` and the functions are taken.
fn is_name(name: &str) -> bool {
    let mut bytes = name.bytes();
    bytes.next().is_some_and(|b| b.is_ascii_alphabetic())
        && bytes.all(|b| b.is_ascii_alphanumeric() || b == b'_')
        && name.len() <= NAME
        && !["r", "pi", "e"].contains(&name)
        && Function::named(name).is_none()
}

/// A wave's number in its only valid spelling: 1 to [`MOST_WAVES`] without leading zeros.
fn wave_number(text: &str) -> Option<usize> {
    text.parse().ok().filter(|n| (1..=MOST_WAVES).contains(n) && n.to_string() == text)
}

fn of_formula() -> Applies {
    Applies::With { key: CHOOSERS[0], words: &["formula"] }
}

pub(super) fn parameter(name: &str) -> Parameter {
    Parameter {
        key: parameter_key(name).into(),
        label: name.to_owned().into(),
        meaning: Borrowed("a parameter of the formula"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        unit: None,
        kind: Kind::Finite,
        fallback: Fallback::Required,
        applies: of_formula(),
    }
}

pub(super) fn limit(name: &str, part: &str) -> Option<Parameter> {
    let (part, meaning, kind) = match part {
        "min" => ("min", "its smallest value", Kind::Finite),
        "max" => ("max", "its largest value", Kind::Finite),
        "unit" => (
            "unit",
            "its unit: in an SI preset bare numbers of value, min and max are in it; in reduced units a remark",
            Kind::Text { max_chars: 20 },
        ),
        _ => return None,
    };
    Some(Parameter {
        key: format!("{}.{part}", parameter_key(name)).into(),
        label: format!("{name} {part}").into(),
        meaning: Borrowed(meaning),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        unit: None,
        kind,
        fallback: Fallback::Described("none"),
        applies: of_formula(),
    })
}

pub(super) fn wave(number: impl Display, name: &str) -> Option<Parameter> {
    let (label, meaning, dimension, kind, fallback) = match name {
        "amplitude" => ("A", "amplitude of a wave", "length", Kind::NonNegative, Fallback::Required),
        "wavelength" => ("lambda", "its wavelength", "length", Kind::Positive, Fallback::Required),
        "phase" => ("phi", "its phase in radians", "", Kind::Finite, Fallback::Number(0.0)),
        _ => return None,
    };
    Some(Parameter {
        key: wave_key(&number, name).into(),
        label: Cow::Owned(format!("{label}{number}")),
        meaning: Borrowed(meaning),
        dimension: Borrowed(dimension),
        quantity: if dimension.is_empty() { Quantity::Number } else { Quantity::Length },
        unit: None,
        kind,
        fallback,
        applies: Applies::With { key: CHOOSERS[0], words: &["harmonics"] },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_form_of_a_key_decides() {
        for key in [
            "gap.parameters.lambda",
            "gap.parameters.R",
            "gap.parameters.x_1.min",
            "gap.parameters.x.unit",
            "gap.waves.1.amplitude",
            "gap.waves.1000.phase",
        ] {
            assert_eq!(row(key).map(|row| row.key.into_owned()).as_deref(), Some(key));
        }
        for key in [
            "gap.parameters",
            "gap.parameters.",
            "gap.parameters.r",
            "gap.parameters.pi",
            "gap.parameters.sin",
            "gap.parameters.1x",
            "gap.parameters.x.y",
            "gap.parameters.x.min.max",
            "gap.parameters.λ",
            "gap.waves.0.amplitude",
            "gap.waves.01.amplitude",
            "gap.waves.1001.amplitude",
            "gap.waves.1",
            "gap.waves.1.A",
            "gap.wave",
        ] {
            assert_eq!(row(key), None, "{key}");
        }
        assert!(row(&parameter_key(&"x".repeat(41))).is_none());
        assert!(["gap.parameters", "gap.parameters.R", "gap.waves", "gap.waves.3"].into_iter().all(is_table));
        assert!(has_knob("gap.waves.20.phase") && !has_knob("gap.waves.21.phase") && has_knob("gap.shape"));
        assert!(!is_table("gap.waves.0") && !is_table("gap.parameters.R.min"));
    }

    #[test]
    fn the_manual_shows_every_form() {
        let keys: Vec<String> = examples().map(|row| row.key.into_owned()).collect();
        assert_eq!(keys.len(), 1 + PARAMETER_KEYS.len() + WAVE_KEYS.len());
        assert_eq!((&*keys[0], &*keys[6]), ("gap.parameters.NAME", "gap.waves.N.phase"));
    }
}
