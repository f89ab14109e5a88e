//! What the user specifies about the rows: which are used, which are apart, and the direction of the columns.

use super::points::{Abscissa, Points, Turned};
use super::role::Segment;
use crate::text::quote;
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem, range_ends};
use thiserror::Error;

/// Limits of values, as the file has them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValueRange {
    /// The smallest.
    pub lo: f64,
    /// The largest.
    pub hi: f64,
}

/// Which rows are apart.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum FreePart {
    /// The rows that are found to be apart.
    #[default]
    Found,
    /// None: all rows are in contact.
    None,
    /// The rows with x in this range, in base units and with the sign of the file.
    Within(ValueRange),
}

/// What is requested of a file's points.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Asked {
    /// How many rows at the beginning of the file are left out.
    pub skip: usize,
    /// The branch to which the points are restricted.
    pub segment: Option<Segment>,
    /// The range of x, in base units and with the signs of the file.
    pub x: Option<ValueRange>,
    /// The range of P, in the same form.
    pub force: Option<ValueRange>,
    /// Which rows are apart.
    pub free: FreePart,
    /// σ of x, P and s, where they are known.
    pub sigma: [Option<f64>; 3],
    /// The share of P by which its σ grows with it; `None` leaves it to the rows, unless σ of P is known.
    pub share: Option<f64>,
    /// Whether the signs of x and P are reversed, if the user specifies it.
    pub turned: Option<Turned>,
}

/// Why the user's text about the rows is not understood.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum AskedError {
    /// The text does not have the expected form.
    #[error("\"{text}\": expected {expected}")]
    Form {
        /// The text given, safe to show.
        text: String,
        /// What is allowed.
        expected: &'static str,
    },
    /// The range is empty.
    #[error("\"{0}\": the range is empty: it goes from the smaller value to the larger one")]
    Empty(String),
    /// An end of a range is not a number of this problem; explained in words.
    #[error("{0}")]
    Number(String),
}

/// Reads the end of a range.
pub type Number<'a> = &'a dyn Fn(&str) -> Result<f64, String>;

impl ValueRange {
    /// Whether it holds a value.
    pub fn holds(&self, value: f64) -> bool {
        self.lo <= value && value <= self.hi
    }

    /// The range given by a text such as `LO..HI`; either end may be left out.
    ///
    /// # Errors
    /// [`AskedError`]; `expected` says what `text` should have been.
    pub fn parse(
        text: &str,
        range: &str,
        expected: &'static str,
        number: Number<'_>,
    ) -> Result<Self, AskedError> {
        let (lo, hi) = range_ends(range).ok_or_else(|| form(text, expected))?;
        let end = |text: &str, open: f64| match text.trim() {
            "" => Ok(open),
            text => number(text).map_err(AskedError::Number),
        };
        let span = Self { lo: end(&lo, f64::NEG_INFINITY)?, hi: end(hi, f64::INFINITY)? };
        if span.lo < span.hi { Ok(span) } else { Err(AskedError::Empty(quote(text))) }
    }
}

impl Asked {
    /// Ranges that leave none of `points` out, in words: the ends of such a range may be meant in another unit.
    pub fn idle_ranges(&self, points: &Points, units: &UnitSystem) -> Vec<String> {
        let of = |(name, range, values, quantity): (&str, Option<ValueRange>, &[f64], Quantity)| {
            let range = range.filter(|range| values.iter().all(|value| range.holds(*value)))?;
            let text = |value: f64| said(units, quantity, value);
            let end = |value: f64| if value.is_finite() { text(value) } else { "no end".to_owned() };
            let [least, most] = [f64::min, f64::max].map(|of| values.iter().copied().reduce(of));
            Some(format!(
                "the range of {name} from {} to {} leaves no row out: the rows have {} to {}; a number without a unit is in base units",
                end(range.lo),
                end(range.hi),
                text(least?),
                text(most?)
            ))
        };
        let x = if points.abscissa == Abscissa::Radius { "the contact radius" } else { "x" };
        let ranges = [
            (x, self.x, &*points.x, Quantity::Length),
            ("the force", self.force, &points.force, Quantity::Force),
        ];
        ranges.into_iter().filter_map(of).collect()
    }
}

impl FreePart {
    /// The rows that `x=LO..HI` or `none` specifies; an empty text leaves them to be found.
    ///
    /// # Errors
    /// [`AskedError`].
    pub fn parse(text: &str, number: Number<'_>) -> Result<Self, AskedError> {
        const EXPECTED: &str = "x=LO..HI, or none if all rows are in contact";
        match text.trim() {
            "" => Ok(Self::Found),
            "none" => Ok(Self::None),
            said => match said.split_once('=') {
                Some((axis, range)) if axis.trim() == "x" => {
                    ValueRange::parse(text, range, EXPECTED, number).map(Self::Within)
                }
                _ => Err(form(text, EXPECTED)),
            },
        }
    }
}

/// Whether x and P are reversed, as `x=-,force=+` specifies.
///
/// # Errors
/// [`AskedError::Form`] unless each sign is given exactly once.
pub fn signs(text: &str) -> Result<Turned, AskedError> {
    const EXPECTED: &str = "the signs of both columns, as in x=-,force=+: minus reverses one, so that x \
        grows as the bodies approach and the force is positive where they are pressed together";
    let wrong = || form(text, EXPECTED);
    let mut turned = [None; 2];
    for part in text.split(',') {
        let (axis, sign) = part.split_once('=').ok_or_else(wrong)?;
        let slot = match axis.trim() {
            "x" => &mut turned[0],
            "force" | "f" | "P" => &mut turned[1],
            _ => return Err(wrong()),
        };
        let sign = match sign.trim() {
            "+" => false,
            "-" | "\u{2212}" => true,
            _ => return Err(wrong()),
        };
        if slot.replace(sign).is_some() {
            return Err(wrong());
        }
    }
    match turned {
        [Some(x), Some(force)] => Ok([x, force]),
        _ => Err(wrong()),
    }
}

/// The text that [`signs`] reads.
pub fn signs_text(turned: Turned) -> String {
    let [x, force] = turned.map(|turned| if turned { '-' } else { '+' });
    format!("x={x},force={force}")
}

fn form(text: &str, expected: &'static str) -> AskedError {
    AskedError::Form { text: quote(text), expected }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_is_read_or_refused_with_what_can_be_said() {
        let number = |text: &str| text.parse::<f64>().map_err(|error| format!("{text}: {error}"));
        let free = |text: &str| FreePart::parse(text, &number);
        assert_eq!(free(" none "), Ok(FreePart::None));
        assert_eq!(free(""), Ok(FreePart::Found));
        assert_eq!(free("x = -3 .. 1e-1"), Ok(FreePart::Within(ValueRange { lo: -3.0, hi: 0.1 })));
        assert_eq!(free("x=..2"), Ok(FreePart::Within(ValueRange { lo: f64::NEG_INFINITY, hi: 2.0 })));
        for text in ["x", "force=1..2", "x=1", "1..2", "x=2..1", "x=1..1", "x=a..2", "x=nan..2"] {
            assert!(free(text).is_err(), "{text}: {:?}", free(text));
        }
        for turned in [[false, false], [true, false], [false, true], [true, true]] {
            assert_eq!(signs(&signs_text(turned)), Ok(turned));
        }
        assert_eq!(signs("f=+, x=-"), Ok([true, false]));
        for text in ["", "x=-", "x=-,x=+", "x=1,force=-", "y=-,force=+", "x=-,force=+,x=-"] {
            assert!(signs(text).unwrap_err().to_string().contains("x=-,force=+"), "{text}");
        }
    }
}
