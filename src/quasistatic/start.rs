//! The state a path starts from.

use super::curve::{Curve, SWEEP_STEPS_PER_WAVE, radii};
use super::jump::Nodes;
use crate::contact::{Control, Gap, Reduced, Start, Units};
use crate::ritz::Basis;
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};
use std::fmt;
use std::sync::Arc;

/// Why a start state was not found.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum StartError {
    /// The basis has no equilibrium at the radius.
    NoEquilibrium(f64),
    /// No contact carries the value.
    OutOfReach {
        /// `approach` or `force`.
        name: &'static str,
        /// The value asked for.
        value: f64,
        /// The smallest on the curve.
        smallest: f64,
    },
    /// The value is beyond what is known of the gap.
    NotKnown {
        /// `approach` or `force`.
        name: &'static str,
        /// The value asked for.
        value: f64,
        /// The largest radius tried.
        searched: f64,
        /// The largest radius known.
        known: f64,
    },
    /// The curve was not found to rise above the value.
    NotReached {
        /// `approach` or `force`.
        name: &'static str,
        /// The value asked for.
        value: f64,
        /// The largest radius tried.
        largest: f64,
    },
}

impl fmt::Display for StartError {
    /// Its numbers as they stand.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words(&UnitSystem::Reduced))
    }
}

impl StartError {
    /// What is wrong, with the numbers, which are in the user's units, as `shown` has them.
    pub fn words(&self, shown: &UnitSystem) -> String {
        let radius = |s| said(shown, Quantity::Length, s);
        let of = |name, x| {
            let quantity = if name == "force" { Quantity::Force } else { Quantity::Length };
            said(shown, quantity, x)
        };
        match *self {
            Self::NoEquilibrium(s) => format!("there is no equilibrium at the contact radius {}", radius(s)),
            Self::OutOfReach { name, value, smallest } => {
                let (value, smallest) = (of(name, value), of(name, smallest));
                format!("no contact has the {name} {value}; the smallest on the curve is {smallest}")
            }
            Self::NotKnown { name, value, searched, known } => {
                let (value, searched, known) = (of(name, value), radius(searched), radius(known));
                format!(
                    "no contact up to the radius {searched} has the {name} {value}, and the gap is known up to the \
                     radius {known} only"
                )
            }
            Self::NotReached { name, value, largest } => {
                let (value, largest) = (of(name, value), radius(largest));
                format!("no contact up to the radius {largest} reaches the {name} {value}")
            }
        }
    }

    /// The same error with its numbers in the user's units.
    #[must_use]
    pub fn in_units(self, units: &Units) -> Self {
        let of = |name: &str| if name == "force" { units.force } else { units.length };
        match self {
            Self::NoEquilibrium(s) => Self::NoEquilibrium(s * units.length),
            Self::OutOfReach { name, value, smallest } => {
                Self::OutOfReach { name, value: value * of(name), smallest: smallest * of(name) }
            }
            Self::NotKnown { name, value, searched, known } => Self::NotKnown {
                name,
                value: value * of(name),
                searched: searched * units.length,
                known: known * units.length,
            },
            Self::NotReached { name, value, largest } => {
                Self::NotReached { name, value: value * of(name), largest: largest * units.length }
            }
        }
    }
}

/// The contact radius of the start state.
///
/// For an approach or a preload the curve is swept further and further out until it stays above the value over a
/// factor of two in radius; the outermost crossing, where the control grows with s, is the start. Where the gap is known
/// up to a radius only, the outermost crossing within it is.
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
    // The radii at which a paraboloid of R = 1 takes the value, with and without adhesion.
    let elastic = if control == Control::Force { value.abs().cbrt() } else { value.abs().sqrt() };
    let adhesive = problem.work_of_adhesion.cbrt();
    let unit = elastic.max(adhesive).max(f64::MIN_POSITIVE);
    let largest = 1e3 * unit;
    let most = problem.largest_contact();
    let from = 1e-3 * unit.min(most);
    let mut reach = (2.0 * unit).min(most);
    loop {
        let pieces: Vec<(Curve, Nodes)> = pieces(problem, basis, reach, from)
            .map(|curve| {
                let nodes = Nodes::new(&curve, control, &curve.limit_points(control));
                (curve, nodes)
            })
            .collect();
        let values = || {
            pieces.iter().flat_map(|(curve, nodes)| {
                nodes
                    .points()
                    .iter()
                    .enumerate()
                    .map(|(i, p)| (curve.equilibrium.contact_radius(p), nodes.value(i)))
            })
        };
        // Above the value over the outer half: no wave further out comes down to it again. Where no more is known, above
        // it at the end must do.
        let outer = if reach < most { 0.5 * reach } else { reach * (1.0 - 1e-9) };
        if values().take_while(|(s, _)| *s >= outer).all(|(_, v)| v > value) {
            let smallest = values().map(|(_, v)| v).fold(f64::INFINITY, f64::min);
            let found =
                pieces.iter().find_map(|(curve, nodes)| Some((curve, nodes.outermost(curve, value)?)));
            let (curve, start) = found.ok_or(StartError::OutOfReach { name, value, smallest })?;
            return Ok(curve.equilibrium.contact_radius(&start));
        }
        if reach >= most {
            let known = problem.gap.largest_radius().unwrap_or(most);
            return Err(StartError::NotKnown { name, value, searched: reach, known });
        }
        if reach >= largest {
            return Err(StartError::NotReached { name, value, largest });
        }
        reach = (2.0 * reach).min(most);
    }
}

/// The equilibrium curve from `reach` down to `from` in its connected pieces, the outermost first: rings too coarse
/// for the waves have radii without an equilibrium.
fn pieces(problem: &Reduced, basis: &Arc<dyn Basis>, reach: f64, from: f64) -> impl Iterator<Item = Curve> {
    /// Just below the last radius of a piece.
    const BELOW: f64 = 1.0 - 1e-6;
    let mut outer = Some(reach);
    std::iter::from_fn(move || {
        let steps = radii(outer?, from, problem.gap.feature_length(), SWEEP_STEPS_PER_WAVE);
        let first = steps.into_iter().find(|s| basis.equilibrium(problem, *s).is_some())?;
        let curve = Curve::swept(problem.clone(), Arc::clone(basis), first, from, || true)?;
        outer = Some(curve.innermost() * BELOW).filter(|s| *s > from);
        Some(curve)
    })
}
