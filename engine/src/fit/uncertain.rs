//! Values that are given with an error: `path.control.stiffness=10%,gap.radius_of_curvature=50 um+-1 um`.
//!
//! An error is a share of the value in per cent, or a number with or without a unit. The value is the one in the preset, unless
//! another stands before `+-` or `±`. A fit writes the second form: the value that it leaves in the preset comes from the points too,
//! and a second fit must not count them twice.

use super::options::{FitError, letter, target};
use super::prior::Prior;
use super::problem::{FitProblem, FreeParameter, Target};
use crate::measured::Abscissa;
use crate::preset::{Preset, Value};
use crate::text::quote;
use serde::Serialize;

/// The signs between a value and its error; the first is written.
const BETWEEN: [&str; 2] = ["+-", "±"];
/// The largest error in units of the value: a larger one says nothing about what must be positive.
const MOST: f64 = 1.0;

/// A value that is given with an error.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Uncertain {
    /// What it is.
    pub(super) target: Target,
    /// The value, in base units.
    mean: f64,
    /// Its standard deviation, likewise.
    sigma: f64,
}

/// What was known of a value before, with an error.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Given {
    /// Its dotted key.
    pub key: String,
    /// The value, in base units.
    pub value: f64,
    /// Its standard deviation, likewise.
    pub standard_error: f64,
    /// Its share of the variance of each fitted value, in their order.
    pub shares: Vec<f64>,
}

/// The values that `text` gives with an error.
///
/// # Errors
/// [`FitError::Uncertain`]: a key that cannot be fitted or occurs twice, something that is not a number, an error that
/// is zero or negative, or larger than a value that must be positive.
pub(super) fn uncertain(preset: &Preset, abscissa: Abscissa, text: &str) -> Result<Vec<Uncertain>, FitError> {
    let mut all: Vec<Uncertain> = Vec::new();
    for part in text.split(',').map(str::trim).filter(|part| !part.is_empty()) {
        let refused = |why: String| FitError::Uncertain { given: quote(part), why };
        let (key, error) = part.split_once('=').ok_or_else(|| {
            refused(
                "expected KEY=ERROR, as in path.control.stiffness=10% or gap.radius_of_curvature=1 um"
                    .to_owned(),
            )
        })?;
        let target = target(preset, abscissa, key.trim()).map_err(|error| match error {
            FitError::Key { why, .. } => refused(why),
            other => other,
        })?;
        if all.iter().any(|other| other.target == target) {
            return Err(refused("is given twice".to_owned()));
        }
        let name = target.key();
        let row = preset.row(&name).ok_or_else(|| refused("has no value".to_owned()))?;
        let number =
            |text: &str| preset.number(&row, text.trim()).map_err(|invalid| refused(invalid.to_string()));
        let split = BETWEEN.iter().find_map(|sign| error.split_once(sign));
        let (mean, error) = match split {
            Some((mean, error)) => (number(mean)?, error),
            None => match preset.get(&name) {
                Some(Value::Number(value)) => (value, error),
                // What lies between model and instrument is zero unless it is given.
                _ => (0.0, error),
            },
        };
        let sigma = match error.trim().strip_suffix('%') {
            Some(share) => {
                let share: f64 =
                    share.trim().parse().map_err(|_| refused("expected a number before %".to_owned()))?;
                0.01 * share * mean.abs()
            }
            None => number(error)?,
        };
        if !(sigma > 0.0 && sigma.is_finite()) {
            return Err(refused("a standard deviation must be above 0".to_owned()));
        }
        if matches!(target, Target::Key(_)) && sigma > MOST * mean {
            return Err(refused(
                "the standard deviation of a positive value is at most that value, 100 %".to_owned(),
            ));
        }
        all.push(Uncertain { target, mean, sigma });
    }
    Ok(all)
}

impl Uncertain {
    /// The same, of another target.
    pub(super) fn with_target(self, other: impl Fn(Target) -> Target) -> Self {
        Self { target: other(self.target), ..self }
    }

    /// What it says about parameter number `at`; an error of a logarithm is a share.
    pub(super) fn prior(&self, parameter: &FreeParameter, at: usize) -> Prior {
        let sigma = self.sigma / parameter.slope(self.mean).abs();
        Prior { parameter: at, mean: parameter.inner(self.mean), sigma }
    }
}

/// The text of what was known of a parameter before its fit, for the next fit of the same points.
pub(super) fn written(parameter: &FreeParameter, prior: &Prior) -> String {
    let [mean, sigma] = parameter.given(prior);
    format!("{}={mean:?}{}{sigma:?}", parameter.key(), BETWEEN[0])
}

/// What was known before, and a sentence where it decides how well a value is known.
pub(super) fn given(problem: &FitProblem, shares: &[Vec<f64>], notes: &mut Vec<String>) -> Vec<Given> {
    /// Above this share of the variance the points matter less.
    const MOST: f64 = 0.5;
    let none = Vec::new();
    let of = |(i, prior): (usize, &Prior)| {
        let parameter = &problem.parameters[prior.parameter];
        let [value, standard_error] = parameter.given(prior);
        let shares = shares.get(i).unwrap_or(&none).clone();
        Given { key: parameter.key(), value, standard_error, shares }
    };
    let given: Vec<Given> = problem.priors.iter().enumerate().map(of).collect();
    for Given { key, shares, .. } in &given {
        let of = problem.parameters.iter().zip(shares).filter(|(_, share)| **share > MOST);
        let told: Vec<String> = of
            .map(|(parameter, share)| {
                format!("{:.0} % of that of {}", 100.0 * share, letter(&problem.preset, &parameter.key()))
            })
            .collect();
        if !told.is_empty() {
            notes.push(format!("the given error of {key} makes up {} (variance)", told.join(", ")));
        }
    }
    given
}
