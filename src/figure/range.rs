//! The requested part of an axis of a figure, in the units of that axis: `0..0.1`, `..0.1`, `-2..`.

use super::{Bounds, Figure};
use pulloff_engine::report::number::short;
use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

/// From one value of an axis to another; a missing end is that of the whole figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    lo: Option<f64>,
    hi: Option<f64>,
}

/// Why a figure cannot show a range.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RangeError {
    /// The text is not a range.
    #[error(
        "expected LO..HI, two numbers in the units of the axis, or one of them alone: 0..0.1, ..0.1, 0.1.."
    )]
    Text,
    /// The ends do not ascend, or are infinitely far apart.
    #[error("the range must go from a number up to a larger one, not from {0} to {1}")]
    Order(String, String),
    /// The ends are so close that the numbers beside the axis would be the same.
    #[error(
        "the range is too narrow to draw: the numbers along the axis would all look alike; it must be at least {0} wide"
    )]
    Narrow(String),
    /// No part of the figure is in it.
    #[error("shows none of the figure, where {title} goes from {from} to {to}")]
    Empty { title: String, from: String, to: String },
}

/// The number of digits of a number in a message and beside an axis.
const DIGITS: usize = 6;
/// The largest number of steps between numbers beside an axis.
const STEPS: f64 = 10.0;
/// How far the rounding of the ends may reduce the width.
const ROUNDING: f64 = 1e-9;

impl Range {
    /// Its ends on an axis with this title that shows `whole` by default and whose lines extend over `drawn`.
    /// Errors: [`RangeError`] when the ends do not ascend or nothing drawn lies between them.
    pub fn ends(self, title: &str, whole: [f64; 2], drawn: [f64; 2]) -> Result<[f64; 2], RangeError> {
        let empty = || RangeError::Empty {
            title: title.to_owned(),
            from: short(drawn[0], DIGITS),
            to: short(drawn[1], DIGITS),
        };
        let ends @ [lo, hi] = [self.lo.unwrap_or(whole[0]), self.hi.unwrap_or(whole[1])];
        if lo >= drawn[1] || hi <= drawn[0] {
            return Err(empty());
        }
        ascending(ends)
    }
}

fn ascending(ends: [f64; 2]) -> Result<[f64; 2], RangeError> {
    let [lo, hi] = ends;
    let apart = hi - lo;
    if !(apart > 0.0 && apart.is_finite()) {
        return Err(RangeError::Order(short(lo, DIGITS), short(hi, DIGITS)));
    }
    let least = narrowest(lo.abs().max(hi.abs()));
    // The width of decimal ends is exact only to their rounding.
    if apart < least * (1.0 - ROUNDING) {
        return Err(RangeError::Narrow(short(least, 1)));
    }
    Ok(ends)
}

/// The smallest width of a range whose axis numbers, the largest being `largest`, still differ in `DIGITS` digits.
fn narrowest(largest: f64) -> f64 {
    let digits = i32::try_from(DIGITS).unwrap_or(i32::MAX);
    // One end of a range of positive width is not zero.
    let decade = largest.log10().floor();
    STEPS * 10.0_f64.powf(decade + 1.0 - f64::from(digits))
}

impl Figure {
    /// The part of the figure with x in `range`; an empty figure is unchanged. Errors: those of [`Range::ends`].
    pub fn across(mut self, range: Range) -> Result<Self, RangeError> {
        if self.missing.is_none() {
            self.bounds.x = range.ends(&self.x.title(), self.bounds.x, self.drawn().x)?;
        }
        Ok(self)
    }

    /// The part of the figure with y in `range`; an empty figure is unchanged. Errors: those of [`Range::ends`].
    pub fn upwards(mut self, range: Range) -> Result<Self, RangeError> {
        if self.missing.is_none() {
            self.bounds.y = range.ends(&self.y.title(), self.bounds.y, self.drawn().y)?;
        }
        Ok(self)
    }

    /// The extent of everything drawn, together with what is shown.
    fn drawn(&self) -> Bounds {
        let Bounds { x, y } = &self.bounds;
        let lines = self.lines.iter().flat_map(|line| line.points.iter().copied());
        lines.filter(|(x, y)| x.is_finite() && y.is_finite()).fold(Bounds { x: *x, y: *y }, |all, (x, y)| {
            let wider = |[lo, hi]: [f64; 2], at: f64| [lo.min(at), hi.max(at)];
            Bounds { x: wider(all.x, x), y: wider(all.y, y) }
        })
    }
}

impl FromStr for Range {
    type Err = RangeError;

    fn from_str(text: &str) -> Result<Self, RangeError> {
        let (lo, hi) = text.split_once("..").ok_or(RangeError::Text)?;
        let end = |text: &str| match text.trim() {
            "" => Ok(None),
            text => text.parse().ok().filter(|x: &f64| x.is_finite()).map(Some).ok_or(RangeError::Text),
        };
        match (end(lo)?, end(hi)?) {
            (None, None) => Err(RangeError::Text),
            (lo, hi) => {
                if let (Some(lo), Some(hi)) = (lo, hi) {
                    ascending([lo, hi])?;
                }
                Ok(Self { lo, hi })
            }
        }
    }
}

impl Display for Range {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let end = |x: Option<f64>| x.map_or_else(String::new, |x| short(x, DIGITS));
        write!(f, "{}..{}", end(self.lo), end(self.hi))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_two_numbers_or_one_and_ascends() {
        let range = |text: &str| text.parse::<Range>();
        for (text, lo, hi) in [
            ("0..0.1", Some(0.0), Some(0.1)),
            ("..1e-2", None, Some(0.01)),
            (" -2.5 .. ", Some(-2.5), None),
            ("-2..-1", Some(-2.0), Some(-1.0)),
        ] {
            assert_eq!(range(text), Ok(Range { lo, hi }), "{text}");
        }
        for text in ["", "..", "0.1", "0,1", "a..b", "0..1 mm", "nan..1", "0..inf", "0..1..2"] {
            assert_eq!(range(text), Err(RangeError::Text), "{text}");
        }
        for text in ["1..0", "1..1", "-1e308..1e308"] {
            assert!(matches!(range(text), Err(RangeError::Order(..))), "{text}");
        }
        // Six digits beside the axis, in at most ten steps.
        for (text, wide, least) in [
            ("1..1.0000000000001", "1..1.0001", "0.0001"),
            ("0.02..0.0200009", "0.02..0.020001", "1e-6"),
            ("-7..-6.9999999", "-7..-6.9999", "0.0001"),
            ("123456..123456.5", "123456..123466", "10"),
            ("1e-300..1.00001e-300", "1e-300..1.0001e-300", "1e-304"),
        ] {
            let said = range(text).unwrap_err().to_string();
            assert!(said.ends_with(&format!("it must be at least {least} wide")), "{text}: {said}");
            assert!(range(wide).is_ok(), "{wide}");
        }
    }

    #[test]
    fn an_end_left_out_is_that_of_the_figure_and_nothing_is_not_shown() {
        let ends = |text: &str| text.parse::<Range>().unwrap().ends("s/λ", [-1.0, 2.0], [0.0, 4.0]);
        assert_eq!(ends("..1"), Ok([-1.0, 1.0]));
        assert_eq!(ends("1.."), Ok([1.0, 2.0]));
        assert_eq!(ends("3..9"), Ok([3.0, 9.0]));
        // What is drawn there lies beyond the end that was left out.
        assert!(matches!(ends("3.."), Err(RangeError::Order(..))));
        for text in ["4..5", "..-3", "-3..0"] {
            let said = ends(text).unwrap_err().to_string();
            assert_eq!(said, "shows none of the figure, where s/λ goes from 0 to 4", "{text}");
        }
    }
}
