//! One key of a preset over a range: an axis of a map.

use crate::elementary::{ln, pow};
use crate::preset::edge;
use crate::preset::schema::{STIFFNESS, TURN_KEYS, table_of};
use serde::{Deserialize, Serialize};
use std::fmt;

/// How the values of an axis are distributed over it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Spacing {
    /// Equal steps.
    Linear,
    /// Equal factors.
    Logarithmic,
    /// Equal steps of c/(c + c₀): from zero to infinity.
    Share(f64),
}

/// A number of a preset over a range, in SI or reduced units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapAxis {
    /// The dotted key, or [`COMPLIANCE`].
    pub key: String,
    /// The ends, ascending; the upper one may be infinite with [`Spacing::Share`].
    #[serde(with = "crate::exact")]
    pub range: [f64; 2],
    /// How its values are spread.
    pub spacing: Spacing,
}

/// The name of an axis of the compliance 1/k: zero is displacement control, infinity a dead load.
pub const COMPLIANCE: &str = "compliance";

/// A range that no axis can have.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{range:?} is not a range of {key}: {expected}")]
pub struct AxisError {
    key: String,
    range: [f64; 2],
    expected: &'static str,
}

/// The key that an axis gives its values to: a compliance is that of the device.
pub fn set_by(axis: &str) -> &str {
    if axis == COMPLIANCE { STIFFNESS } else { axis }
}

/// Whether a key moves no state of a map: the states are the equilibria of one disc with an opening edge.
pub fn is_blind(key: &str) -> bool {
    edge::KEYS.contains(&key) || TURN_KEYS.contains(&key) || table_of(key) == Some("data")
}

impl MapAxis {
    /// An axis of `key` from `lo` to `hi`. Only a compliance may have an infinite `hi`; `unit` is then the value in the
    /// middle.
    ///
    /// # Errors
    /// The range does not ascend, or is not positive on a logarithmic axis.
    pub fn new(key: &str, [lo, hi]: [f64; 2], logarithmic: bool, unit: f64) -> Result<Self, AxisError> {
        let refused = |expected| AxisError { key: key.to_owned(), range: [lo, hi], expected };
        if !(lo.is_finite() && lo < hi) {
            return Err(refused("it must go from a number to a larger one"));
        }
        if key == COMPLIANCE && lo < 0.0 {
            return Err(refused("a compliance is from 0 (displacement) to inf (a dead load)"));
        }
        let spacing = if hi.is_finite() {
            if logarithmic && lo <= 0.0 {
                return Err(refused("a logarithmic axis must begin above zero"));
            }
            if logarithmic { Spacing::Logarithmic } else { Spacing::Linear }
        } else {
            if key != COMPLIANCE || logarithmic {
                return Err(refused("only a compliance may go to infinity, and only on a linear axis"));
            }
            Spacing::Share(unit)
        };
        Ok(Self { key: key.to_owned(), range: [lo, hi], spacing })
    }

    /// The value at a share of the axis: 0 at its lower end, 1 at its upper end.
    pub fn value(&self, share: f64) -> f64 {
        let [lo, hi] = self.range;
        match self.spacing {
            Spacing::Linear => lo + (hi - lo) * share,
            Spacing::Logarithmic => lo * pow(hi / lo, share),
            Spacing::Share(unit) => {
                let from = lo / (lo + unit);
                let part = from + (1.0 - from) * share;
                if part >= 1.0 { f64::INFINITY } else { unit * part / (1.0 - part) }
            }
        }
    }

    /// The share of the axis at which the given value lies.
    pub fn share(&self, value: f64) -> f64 {
        let [lo, hi] = self.range;
        match self.spacing {
            Spacing::Linear => (value - lo) / (hi - lo),
            Spacing::Logarithmic => ln(value / lo) / ln(hi / lo),
            Spacing::Share(unit) => {
                let part = |c: f64| if c.is_finite() { c / (c + unit) } else { 1.0 };
                (part(value) - part(lo)) / (1.0 - part(lo))
            }
        }
    }
}

impl fmt::Display for MapAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [lo, hi] = self.range;
        let log = if self.spacing == Spacing::Logarithmic { "log:" } else { "" };
        write!(f, "{}={log}{lo:?}..{hi:?}", self.key)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_shares_belong_together_and_bad_ranges_are_refused() {
        let axes = [
            MapAxis::new("a", [-1.0, 3.0], false, 1.0),
            MapAxis::new("a", [1e-4, 10.0], true, 1.0),
            MapAxis::new(COMPLIANCE, [0.0, f64::INFINITY], false, 2.0),
            MapAxis::new(COMPLIANCE, [1.0, f64::INFINITY], false, 2.0),
        ];
        for axis in axes.map(Result::unwrap) {
            for share in [0.0, 0.3, 0.5, 0.99] {
                assert!((axis.share(axis.value(share)) - share).abs() < 1e-14, "{axis} {share}");
            }
            for (value, end) in [axis.value(0.0), axis.value(1.0)].into_iter().zip(axis.range) {
                assert!(
                    value.to_bits() == end.to_bits() || (value / end - 1.0).abs() < 1e-15,
                    "{axis}: {value}"
                );
            }
            assert!((axis.share(axis.range[1]) - 1.0).abs() < 1e-15);
        }
        let whole = MapAxis::new(COMPLIANCE, [0.0, f64::INFINITY], false, 2.0).unwrap();
        assert!((whole.value(0.5) - 2.0).abs() < 1e-15);
        for (range, logarithmic) in [
            ([1.0, 1.0], false),
            ([2.0, 1.0], false),
            ([f64::NAN, 1.0], false),
            ([0.0, 1.0], true),
            ([0.0, f64::INFINITY], false),
        ] {
            assert!(MapAxis::new("a", range, logarithmic, 1.0).is_err(), "{range:?}");
        }
    }
}
