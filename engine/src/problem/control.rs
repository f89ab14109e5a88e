//! What the loading device prescribes.

use crate::units::number::as_typed;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The controlled quantity of a quasi-static path.
///
/// A device of stiffness k moves its far end by Δ and feels P = k(Δ − δ), so it prescribes
/// Δ = δ + P/k; k → ∞ is displacement control, k → 0 is force control.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Control {
    /// The approach δ is prescribed (fixed grips).
    Displacement,
    /// The force P is prescribed (dead load).
    Force,
    /// The far end of a spring of this stiffness, a force per length, is prescribed.
    Stiffness(f64),
}

impl Control {
    /// The controlled quantity at approach `delta` and force `p`: δ, P, or Δ = δ + P/k.
    pub fn value(self, delta: f64, p: f64) -> f64 {
        match self {
            Self::Displacement => delta,
            Self::Force => p,
            Self::Stiffness(k) => delta + p / k,
        }
    }

    /// The weights of δ and P in a positive multiple of the controlled quantity. The larger one is between ½ and 1
    /// whatever the stiffness, so nothing overflows.
    pub fn weights(self) -> (f64, f64) {
        match self {
            Self::Displacement => (1.0, 0.0),
            Self::Force => (0.0, 1.0),
            Self::Stiffness(k) => (k / (1.0 + k), 1.0 / (1.0 + k)),
        }
    }

    /// The same control with its stiffness, in reduced units of the size `unit`, as it was given: the way to these units
    /// and back leaves a last digit that nobody typed.
    #[must_use]
    pub fn as_given(self, unit: f64) -> Self {
        match self {
            Self::Stiffness(k) => Self::Stiffness(as_typed(k * unit)),
            other => other,
        }
    }

    /// The same control with its stiffness divided by `unit`.
    #[must_use]
    pub fn in_units(self, unit: f64) -> Self {
        match self {
            Self::Stiffness(k) => Self::Stiffness(k / unit),
            other => other,
        }
    }
}

impl fmt::Display for Control {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Displacement => f.write_str("displacement"),
            Self::Force => f.write_str("force"),
            Self::Stiffness(k) => write!(f, "stiffness={k}"),
        }
    }
}

impl FromStr for Control {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "displacement" => return Ok(Self::Displacement),
            "force" => return Ok(Self::Force),
            _ => {}
        }
        let expected = "expected displacement, force or stiffness=K with K > 0";
        let Some(number) = text.strip_prefix("stiffness=") else {
            return Err(expected.to_owned());
        };
        match number.parse::<f64>() {
            Ok(k) if k.is_finite() && k > 0.0 => Ok(Self::Stiffness(k)),
            _ => Err(format!("the stiffness must be a positive number; {expected}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_what_it_prints() {
        for control in [Control::Displacement, Control::Force, Control::Stiffness(0.15)] {
            assert_eq!(control.to_string().parse(), Ok(control));
        }
        for bad in ["", "stiffness", "stiffness=", "stiffness=-1", "stiffness=inf", "Force", "load"] {
            assert!(bad.parse::<Control>().is_err(), "{bad}");
        }
    }

    #[test]
    fn json_is_the_documented_form() {
        let json = |c: Control| serde_json::to_string(&c).unwrap();
        assert_eq!(json(Control::Displacement), "\"displacement\"");
        assert_eq!(json(Control::Stiffness(0.15)), "{\"stiffness\":0.15}");
    }

    #[test]
    fn a_stiffness_comes_back_from_reduced_units_as_it_was_typed() {
        for k in [5.0, 0.3, 500.0, 0.123_456_789] {
            for unit in [3.7e5, 1.0 / 3.0, 8.1e-7] {
                let back = Control::Stiffness(k).in_units(unit).as_given(unit);
                assert_eq!(back.to_string(), format!("stiffness={k}"));
            }
        }
    }
}
