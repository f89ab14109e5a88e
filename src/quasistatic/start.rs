//! The state a path starts from.

use super::curve::{SWEEP_STEPS_PER_WAVE, radii};
use super::equilibrium::{Equilibrium, Scales};
use crate::contact::{Control, Gap, Reduced, Start, Units};
use crate::continuation::Settings;
use crate::continuation::Work;
use crate::continuation::locate::control_value;
use crate::ritz::{Basis, Evaluation};
use std::sync::Arc;

/// Why a start state was not found.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum StartError {
    /// The basis has no equilibrium at the radius.
    #[error("there is no equilibrium at the contact radius {0:.6e}")]
    NoEquilibrium(f64),
    /// No contact carries the value.
    #[error("no contact has the {name} {value:.6e}; the smallest on the curve is {smallest:.6e}")]
    OutOfReach {
        /// `approach` or `force`.
        name: &'static str,
        /// The value asked for.
        value: f64,
        /// The smallest on the curve.
        smallest: f64,
    },
    /// The curve was not found to rise above the value.
    #[error("no contact up to the radius {largest:.6e} reaches the {name} {value:.6e}")]
    NotReached {
        /// `approach` or `force`.
        name: &'static str,
        /// The value asked for.
        value: f64,
        /// The largest radius tried.
        largest: f64,
    },
}

impl StartError {
    /// The same error with its numbers in the user's units.
    #[must_use]
    pub fn in_units(self, units: &Units) -> Self {
        let of = |name: &str| if name == "force" { units.force } else { units.length };
        match self {
            Self::NoEquilibrium(s) => Self::NoEquilibrium(s * units.length),
            Self::OutOfReach { name, value, smallest } => {
                Self::OutOfReach { name, value: value * of(name), smallest: smallest * of(name) }
            }
            Self::NotReached { name, value, largest } => {
                Self::NotReached { name, value: value * of(name), largest: largest * units.length }
            }
        }
    }
}

/// The contact radius of the start state.
///
/// For an approach or a preload the explicit curve is sampled outward until it stays above the value over a
/// factor of two in radius; the outermost crossing, where the control grows with s, is the start.
///
/// # Errors
/// [`StartError`] when there is none.
pub fn contact_radius(problem: &Reduced, basis: &Arc<dyn Basis>, start: Start) -> Result<f64, StartError> {
    let (control, value, name) = match start {
        Start::ContactRadius(s) => {
            return basis.equilibrium(problem, s).map(|_| s).ok_or(StartError::NoEquilibrium(s));
        }
        Start::Approach(value) => (Control::Displacement, value, "approach"),
        Start::Force(value) => (Control::Force, value, "force"),
    };
    let below = |e: &Evaluation| control.value(e.approach, e.force) <= value;
    // The radii at which a paraboloid of R = 1 takes the value, with and without adhesion.
    let elastic = if control == Control::Force { value.abs().cbrt() } else { value.abs().sqrt() };
    let adhesive = problem.work_of_adhesion.cbrt();
    let unit = elastic.max(adhesive).max(f64::MIN_POSITIVE);
    let largest = 1e3 * unit;

    let mut samples: Vec<Evaluation> = Vec::new();
    let mut reach = 2.0 * unit;
    let mut from = 1e-3 * unit;
    loop {
        let steps = radii(from, reach, problem.gap.feature_length(), SWEEP_STEPS_PER_WAVE);
        samples.extend(steps.into_iter().filter_map(|s| basis.equilibrium(problem, s)));
        if samples.iter().filter(|e| e.contact_radius >= 0.5 * reach).all(|e| !below(e)) {
            break;
        }
        if reach >= largest {
            return Err(StartError::NotReached { name, value, largest });
        }
        from = reach;
        reach *= 2.0;
    }
    let smallest = samples.iter().map(|e| control.value(e.approach, e.force)).fold(f64::INFINITY, f64::min);
    let missing = StartError::OutOfReach { name, value, smallest };
    let last = samples.iter().rposition(below).ok_or(missing)?;
    let (inside, outside) = (&samples[last], samples.get(last + 1).ok_or(missing)?);
    let equilibrium = Equilibrium {
        problem: problem.clone(),
        basis: Arc::clone(basis),
        scales: Scales::of([inside, outside]),
    };
    let points = [outside, inside].map(|e| equilibrium.explicit(e.contact_radius));
    let [Some(outside), Some(inside)] = points else { return Err(missing) };
    let row = equilibrium.control_row(control);
    let settings = Settings::new(3);
    let found = control_value(&equilibrium, &outside, &inside, &row, value, &settings, &mut Work::default());
    found.map(|point| equilibrium.contact_radius(&point)).ok_or(missing)
}
