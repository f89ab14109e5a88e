//! Reads a number with its unit.

use super::dimension::{Dimension, Quantity};
use super::unit::{Unit, UnitError};
use crate::expression::program::Program;
use crate::expression::{FormulaError, grammar};
use std::borrow::Cow;
use std::fmt;
use thiserror::Error;

/// Most characters of a value that a message quotes.
const QUOTED: usize = 40;

/// A number as typed, with the unit that follows it.
#[derive(Debug, Clone, PartialEq)]
pub struct TypedValue {
    /// The number before the unit, finite.
    pub number: f64,
    /// The unit; a bare number has none.
    pub unit: Option<Unit>,
    text: String,
}

/// Why a text is not a value of the quantity it is meant for. Foreign text in it is short and safe to show.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ValueError {
    /// The number cannot be read.
    #[error(transparent)]
    Number(#[from] FormulaError),
    /// The unit cannot be read.
    #[error(transparent)]
    Unit(#[from] UnitError),
    /// An overflow, or a division of zero by zero.
    #[error("{text} is not a finite number")]
    NotFinite {
        /// The value as typed.
        text: String,
    },
    /// A dimension other than that of the quantity.
    #[error("expected {}, got {text}, {got}", wanted(*.expected))]
    Dimension {
        /// The quantity.
        expected: Quantity,
        /// The value as typed.
        text: String,
        /// What is measured in its unit.
        got: String,
    },
    /// A value with a unit where only pure numbers make sense.
    #[error("the problem is in reduced units: expected a pure number, got {text}, {got}")]
    Reduced {
        /// The value as typed.
        text: String,
        /// What is measured in its unit.
        got: String,
    },
}

fn wanted(quantity: Quantity) -> String {
    match quantity.example() {
        Some(unit) => format!("{} such as {unit}", quantity.name()),
        None => quantity.name().to_owned(),
    }
}

/// The two ends of a range as typed, `FROM..TO`; a unit behind the second end alone belongs to both: `1..5 um`.
pub fn range_ends(text: &str) -> Option<(Cow<'_, str>, &str)> {
    let (from, to) = text.split_once("..")?;
    let unit = |text: &str| parse_quantity(text.trim()).ok().map(|typed| typed.unit);
    Some(match (unit(from), unit(to)) {
        (Some(None), Some(Some(unit))) => (format!("{} {}", from.trim(), unit.ascii()).into(), to),
        _ => (from.into(), to),
    })
}

/// Parses a value: an expression of numbers, then a unit if there is one. If the expression ends with a division by a
/// unit, as in `3/mm^2`, the unit begins with that slash.
///
/// # Errors
/// Text that is neither, with its column; or a number that is not finite.
pub fn parse_quantity(text: &str) -> Result<TypedValue, ValueError> {
    let (program, end) = match grammar::number(text) {
        Ok(read) => read,
        Err(error) => divided(text, &error).ok_or(error)?,
    };
    let unit = if end < text.len() { Some(Unit::parse(text, end)?) } else { None };
    let number = program.value();
    let value = TypedValue { number, unit, text: quoted(text) };
    if number.is_finite() { Ok(value) } else { Err(ValueError::NotFinite { text: value.text }) }
}

/// The number in a text and the byte of the slash after it, if what the grammar refused comes after a slash.
fn divided(text: &str, error: &FormulaError) -> Option<(Program, usize)> {
    let before = text.get(..error.place.byte)?.trim_end().strip_suffix('/')?;
    let (program, end) = grammar::number(before).ok()?;
    let is_unit = Unit::parse(text, before.len()).is_ok();
    (end == before.len() && is_unit).then_some((program, end))
}

/// The text on one line and not too long; what could be read contains nothing unsafe.
fn quoted(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().nth(QUOTED).is_none() {
        return line;
    }
    line.chars().take(QUOTED - 3).chain("...".chars()).collect()
}

impl fmt::Display for TypedValue {
    /// As typed, on one line and not too long.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl TypedValue {
    /// The dimension of the unit; a bare number has none of its own.
    pub fn dimension(&self) -> Option<Dimension> {
        self.unit.as_ref().map(Unit::dimension)
    }

    /// The value of this quantity in SI; a bare number is taken in `unit`, or in SI without one.
    ///
    /// # Errors
    /// Another dimension; a value that is too large or too small for a double.
    pub fn in_si(&self, expected: Quantity, unit: Option<&Unit>) -> Result<f64, ValueError> {
        // Whether an angle counts in degrees or radians is for its key to say.
        if let Some(own) = &self.unit
            && (own.dimension() != expected.dimension() || own.is_angle())
        {
            return Err(ValueError::Dimension { expected, text: self.text.clone(), got: own.measures() });
        }
        self.in_si_of(unit)
    }

    /// The value in SI, whatever the dimension of its unit.
    ///
    /// # Errors
    /// A value that is too large or too small for a double.
    pub fn in_own_si(&self) -> Result<f64, ValueError> {
        self.in_si_of(None)
    }

    /// The value in SI; a bare number is taken in `unit`, or in SI without one.
    fn in_si_of(&self, unit: Option<&Unit>) -> Result<f64, ValueError> {
        let si = self.unit.as_ref().or(unit).map_or(self.number, |unit| unit.to_si(self.number));
        if si.is_finite() && (si != 0.0 || self.number == 0.0) {
            Ok(si)
        } else {
            Err(ValueError::NotFinite { text: self.text.clone() })
        }
    }

    /// Whether it has a unit made of those of angles.
    pub fn is_angle(&self) -> bool {
        self.unit.as_ref().is_some_and(Unit::is_angle)
    }

    /// An angle in degrees; `None` of what has not the unit of an angle, or a power of one.
    pub fn degrees(&self) -> Option<f64> {
        let unit = self.unit.as_ref().filter(|unit| unit.is_angle() && unit.is_single())?;
        // Degrees stay as they are typed.
        let is_degree = unit.to_si(1.0).to_bits() == 1_f64.to_radians().to_bits();
        Some(if is_degree { self.number } else { unit.to_si(self.number).to_degrees() })
    }

    /// The value of a quantity without units.
    ///
    /// # Errors
    /// A unit of another dimension or of an angle, or a value that is too large or too small for a double.
    pub fn pure(&self) -> Result<f64, ValueError> {
        match &self.unit {
            Some(unit) if unit.dimension() == Quantity::Number.dimension() && !unit.is_angle() => {
                self.in_si_of(None)
            }
            None => Ok(self.number),
            Some(unit) => Err(ValueError::Reduced { text: self.text.clone(), got: unit.measures() }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn si(text: &str, quantity: Quantity) -> Result<f64, String> {
        parse_quantity(text).and_then(|value| value.in_si(quantity, None)).map_err(|error| error.to_string())
    }

    #[test]
    fn values_as_people_type_them() {
        for (text, quantity, expected) in [
            ("3*pi/2 um", Quantity::Length, 3.0 * std::f64::consts::PI / 2.0 / 1e6),
            ("12.5um", Quantity::Length, 12.5e-6),
            ("2.5 MPa", Quantity::Stress, 2.5e6),
            ("30 mJ/m^2", Quantity::EnergyPerArea, 30e-3),
            ("30 mN/m", Quantity::EnergyPerArea, 30e-3),
            ("1/2 N/m", Quantity::ForcePerLength, 0.5),
            ("-(1+1) nN", Quantity::Force, -2e-9),
            ("2e3 eV", Quantity::Energy, 2e3 * 1.602_176_634 / 1e19),
            ("1e-3", Quantity::Number, 1e-3),
            ("3*pi/2", Quantity::Number, 3.0 * std::f64::consts::FRAC_PI_2),
            ("0 um", Quantity::Length, 0.0),
            ("2e3 m^-1", Quantity::InverseLength(1), 2e3),
            ("3 1/mm^2", Quantity::InverseLength(2), 3e6),
            ("3/mm^2", Quantity::InverseLength(2), 3e6),
            ("1/2/um", Quantity::InverseLength(1), 0.5e6),
            ("(1+1) / µm⁴", Quantity::InverseLength(4), 2e24),
        ] {
            assert_eq!(si(text, quantity), Ok(expected), "{text}");
        }
    }

    #[test]
    fn a_unit_behind_a_range_belongs_to_both_ends() {
        let ends = |text| range_ends(text).map(|(from, to)| (from.into_owned(), to.to_owned()));
        let some = |from: &str, to: &str| Some((from.to_owned(), to.to_owned()));
        assert_eq!(ends("1..5 um"), some("1 um", "5 um"));
        assert_eq!(ends("-1/2 .. 5mJ/m^2"), some("-1/2 mJ/m^2", " 5mJ/m^2"));
        assert_eq!(ends("1 nm..5 um"), some("1 nm", "5 um"));
        assert_eq!(ends("1..5"), some("1", "5"));
        assert_eq!(ends("..5 um"), some("", "5 um"));
        assert_eq!(ends("1 um.."), some("1 um", ""));
        assert_eq!(ends("1 um"), None);
    }

    #[test]
    fn ratios_are_pure_numbers_and_angles_and_lengths_are_not() {
        let pure = |text| parse_quantity(text).and_then(|value| value.pure());
        assert_eq!(pure("0.5"), Ok(0.5));
        assert_eq!(pure("3 mm/m"), Ok(3e-3));
        assert!(["90 deg", "1 rad/rad"].iter().all(|text| pure(text).is_err()));
        let degrees = |text| parse_quantity(text).ok().and_then(|value| value.degrees());
        assert_eq!([degrees("90 deg"), degrees("90"), degrees("1 deg^2")], [Some(90.0), None, None]);
        assert_eq!(parse_quantity("90 deg").unwrap().in_own_si(), Ok(std::f64::consts::FRAC_PI_2));
        assert!(matches!(pure("2 nm"), Err(ValueError::Reduced { .. })));
    }

    #[test]
    fn refusals_say_what_was_expected() {
        for (text, quantity, message) in [
            (
                "30 mJ/m^2",
                Quantity::Stress,
                "expected a stress such as kPa, got 30 mJ/m^2, an energy per area",
            ),
            ("3/um", Quantity::Length, "expected a length such as um, got 3/um, an inverse length"),
            (
                "3 1/mm^2",
                Quantity::InverseLength(4),
                "expected an inverse power of a length such as m^-4, got 3 1/mm^2, an inverse area",
            ),
            (
                "3/r",
                Quantity::InverseLength(1),
                "column 3: r has no value here: only numbers, pi, e and functions of them",
            ),
            ("3 um", Quantity::Number, "expected a pure number, got 3 um, a length"),
            ("3 m/s", Quantity::Length, "expected a length such as um, got 3 m/s, a speed"),
            ("10^10^10", Quantity::Number, "10^10^10 is not a finite number"),
            ("0/0 um", Quantity::Length, "0/0 um is not a finite number"),
            ("1e300 Ym", Quantity::Length, "1e300 Ym is not a finite number"),
            (
                "1e-300 ym^9 ym^9/ym^9/ym^8",
                Quantity::Length,
                "1e-300 ym^9 ym^9/ym^9/ym^8 is not a finite number",
            ),
            ("3 furlong", Quantity::Length, "column 3: unknown unit furlong"),
            (
                "2*r um",
                Quantity::Length,
                "column 3: r has no value here: only numbers, pi, e and functions of them",
            ),
            (
                "um",
                Quantity::Length,
                "column 1: um has no value here: only numbers, pi, e and functions of them",
            ),
            ("", Quantity::Length, "column 1: expected a number, a name or '(', found the end"),
            ("3 um)", Quantity::Length, "column 5: expected a unit such as um, mN, kPa or mJ/m^2, found ')'"),
            (
                "1,5 um",
                Quantity::Length,
                "column 2: expected a unit such as um, mN, kPa or mJ/m^2, found ',' (use a decimal point)",
            ),
        ] {
            assert_eq!(si(text, quantity), Err(message.to_owned()), "{text}");
        }
        assert_eq!(parse_quantity("2").unwrap().pure(), Ok(2.0));
        assert_eq!(
            parse_quantity("2 nm").unwrap().pure().unwrap_err().to_string(),
            "the problem is in reduced units: expected a pure number, got 2 nm, a length"
        );
    }
}
