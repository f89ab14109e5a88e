//! One value that a fit finds, and what a key measures.

use super::chance::t_of;
use super::problem::{ADHESION, FitProblem, FreeParameter};
use crate::preset::Preset;
use crate::preset::data::{BASELINE, OFFSET, TILT};
use crate::units::Quantity;
use crate::units::number::short;
use nalgebra::DVector;

/// Half a 95 % interval, in standard errors.
pub(super) const NORMAL: f64 = 1.96;

/// What a bootstrap found of one parameter, in base units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bootstrapped {
    /// The standard deviation.
    pub error: f64,
    /// The 2.5 and 97.5 % points of the fits.
    pub interval: [f64; 2],
}

impl Bootstrapped {
    /// Half the width of the interval.
    pub(super) fn half(&self) -> f64 {
        0.5 * (self.interval[1] - self.interval[0])
    }
}

/// One fitted value, in base units.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// Its dotted key.
    pub key: String,
    /// The value.
    pub value: f64,
    /// Its standard error; `None` where it is not determined.
    pub standard_error: Option<f64>,
    /// The degrees of freedom of the square of that error; `None` where it is not determined.
    pub degrees: Option<f64>,
    /// The 95 % interval by Student's t; `None` where it is not determined.
    pub interval: Option<[f64; 2]>,
    /// Where the fit started.
    pub start: f64,
    /// The 95 % interval by the profile of χ², where it was asked for and found.
    pub profile: Option<[f64; 2]>,
    /// What the bootstrap found.
    pub bootstrap: Option<Bootstrapped>,
}

impl Fitted {
    /// How many times too small the bootstrap finds the standard error to be, if that is more than twice. It goes by the
    /// interval: a few fits that went astray do not count.
    pub(super) fn too_small(&self) -> Option<f64> {
        const TIMES: f64 = 2.0;
        let times = self.bootstrap?.half() / (NORMAL * self.standard_error?);
        Some(times).filter(|times| *times > TIMES)
    }

    /// Whether there is a standard error that holds as far as the value alone shows.
    pub fn has_error(&self) -> bool {
        self.standard_error.is_some() && self.too_small().is_none()
    }
}

/// What a key measures.
pub fn quantity(preset: &Preset, key: &str) -> Quantity {
    match key {
        OFFSET => Quantity::Length,
        BASELINE => Quantity::Force,
        TILT => Quantity::ForcePerLength,
        key if key.starts_with(ADHESION) => Quantity::EnergyPerArea,
        key => preset.row(key).map_or(Quantity::Number, |row| row.quantity),
    }
}

/// The values with their errors, and the degrees of freedom of these.
pub(super) fn values(
    problem: &FitProblem,
    u: &[f64],
    known: Option<(&DVector<f64>, &DVector<f64>)>,
) -> Vec<Fitted> {
    /// The share of truths outside an interval.
    const OUTSIDE: f64 = 0.05;
    let of = |(j, parameter): (usize, &FreeParameter)| {
        let value = parameter.value(u[j]);
        let standard_error = known.map(|(errors, _)| errors[j] * parameter.slope(value).abs());
        let degrees = known.map(|(_, degrees)| degrees[j]);
        let interval = known.map(|(errors, degrees)| {
            let t = t_of(OUTSIDE, degrees[j]);
            [-t, t].map(|t| parameter.value(u[j] + t * errors[j]))
        });
        let (key, start) = (parameter.key(), parameter.start);
        Fitted { key, value, standard_error, degrees, interval, start, profile: None, bootstrap: None }
    };
    problem.parameters.iter().enumerate().map(of).collect()
}

/// Takes away the bootstrap of values that nearly all its fits left where they were, as they do where the path has a
/// corner in them: its interval has no width. Returns a sentence on them.
pub(super) fn unmoved(fitted: &mut [Fitted]) -> Option<String> {
    // Of points without noise all fits are the same.
    const EXACT: f64 = 1e-9;
    let is_noisy = |of: &Fitted| of.standard_error.is_some_and(|error| error > EXACT * of.value.abs());
    let stuck =
        fitted.iter_mut().filter(|of| is_noisy(of) && of.bootstrap.is_some_and(|found| found.half() <= 0.0));
    let keys: Vec<String> = stuck
        .map(|of| {
            of.bootstrap = None;
            of.key.clone()
        })
        .collect();
    (!keys.is_empty()).then(|| {
        format!(
            "nearly all fits of the bootstrap left {} where it was: the model has a corner there, and there is no \
             interval by the bootstrap",
            keys.join(" and ")
        )
    })
}

/// A sentence on the standard error that the bootstrap finds to be too small by most.
pub(super) fn too_small(fitted: &[Fitted]) -> Option<String> {
    let all = fitted.iter().filter_map(|of| Some((of.too_small()?, of)));
    all.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(times, of)| {
        format!(
            "the standard error of {} is {} times too small, as the model is not linear there: use the interval of \
             the bootstrap",
            of.key,
            short(times, 2)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bootstrap_that_moves_nothing_gives_no_interval() {
        let of = |error: f64, interval: [f64; 2]| Fitted {
            key: format!("{error}"),
            value: 2.0,
            standard_error: Some(error),
            degrees: None,
            interval: None,
            start: 1.0,
            profile: None,
            bootstrap: Some(Bootstrapped { error: 0.0, interval }),
        };
        let mut fitted = [of(0.1, [2.0, 2.0]), of(0.2, [1.9, 2.1]), of(1e-13, [2.0, 2.0])];
        let said = unmoved(&mut fitted).unwrap();
        assert!(said.contains("left 0.1 where it was"), "{said}");
        assert_eq!(fitted.map(|of| of.bootstrap.is_some()), [false, true, true]);
        assert_eq!(unmoved(&mut [of(0.2, [1.9, 2.1])]), None);
    }
}
