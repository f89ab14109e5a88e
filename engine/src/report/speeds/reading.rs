//! What turns measured rows into states of a disc: the force, the approach and the radius of a row, and its G.

use crate::case::Case;
use crate::disc::Panels;
use crate::elementary::hypot;
use crate::measured::branches::MeasuredPoint;
use crate::measured::{Abscissa, Branches, Instrument};
use crate::problem::{Control, Units};
use crate::progress::Progress;
use crate::rate::equation::HeldDisc;
use crate::root;
use std::f64::consts::TAU;
use std::sync::Arc;

/// How many times the gap may be tabulated further out for radii that are not measured.
const WIDER: usize = 12;

/// What G is computed from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeasuredPair {
    /// P and s.
    ForceRadius,
    /// δ and s.
    ApproachRadius,
    /// P and δ.
    ForceApproach,
}

impl MeasuredPair {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::ForceRadius, Self::ApproachRadius, Self::ForceApproach];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::ForceRadius => "force-radius",
            Self::ApproachRadius => "approach-radius",
            Self::ForceApproach => "force-approach",
        }
    }

    /// What it is, in words.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::ForceRadius => "force and contact radius",
            Self::ApproachRadius => "approach and contact radius",
            Self::ForceApproach => "force and approach",
        }
    }
}

/// What turns rows into states.
#[derive(Clone)]
pub(super) struct RowReading {
    pub(super) panels: Arc<Panels>,
    pub(super) units: Units,
    pub(super) abscissa: Abscissa,
    pub(super) pair: MeasuredPair,
    /// The control that the measured way belongs to, reduced.
    pub(super) control: Control,
    /// δ₀, P₀ and its slope over x, in base units and in the signs of the points.
    pub(super) instrument: Instrument,
    /// σ of x and P.
    pub(super) sigma: [f64; 2],
}

/// G of one row in base units, its standard deviation without the part from s, and its derivative with respect to s at
/// what else is measured.
pub(super) struct Released {
    pub(super) contact_radius: f64,
    pub(super) energy: f64,
    pub(super) error: f64,
    pub(super) by_radius: f64,
}

impl RowReading {
    /// Tabulates the gap beyond `reach` until all points have their G: from force and approach, the radius is not known
    /// beforehand.
    pub(super) fn widen(
        &mut self,
        points: &[MeasuredPoint],
        case: &Case,
        mut reach: f64,
        progress: &dyn Progress,
    ) {
        for _ in 0..WIDER {
            let is_wide = points.iter().all(|point| self.released(point).is_some());
            if is_wide || reach >= case.reduced.largest_contact() {
                break;
            }
            reach = (2.0 * reach).min(case.reduced.largest_contact());
            let Ok(wider) = case.table.up_to_while(reach, 0, progress) else { break };
            self.panels = wider;
        }
    }

    /// P at a row, reduced.
    fn force(&self, point: &MeasuredPoint) -> f64 {
        let Instrument { baseline, tilt, .. } = self.instrument;
        (point.force - baseline - tilt * point.x) / self.units.force
    }

    /// G at a row; `None` where its radius is not valid, or one for which the gap is not known.
    pub(super) fn released(&self, point: &MeasuredPoint) -> Option<Released> {
        let force = self.force(point);
        let [sigma_x, sigma_force] = self.sigma;
        let [sigma_x, sigma_force] = [sigma_x / self.units.length, sigma_force / self.units.force];
        let unit = self.units.force / self.units.length;
        let is_known = |s: f64| s > 0.0 && s <= self.panels.reach();
        let way = (point.x - self.instrument.offset) / self.units.length;
        let (approach, compliance) = match self.control {
            Control::Stiffness(k) => (way - force / k, 1.0 / k),
            _ => (way, 0.0),
        };
        if self.pair != MeasuredPair::ForceApproach {
            let radius = radius_of(self.abscissa, point)?;
            let s = radius / self.units.length;
            if !is_known(s) {
                return None;
            }
            let (held, of_column) = if self.pair == MeasuredPair::ForceRadius {
                let held = HeldDisc::new(&self.panels, Control::Force, s, force);
                (held, held.by_control * sigma_force)
            } else {
                let held = HeldDisc::new(&self.panels, Control::Displacement, s, approach);
                (held, hypot(sigma_x, compliance * sigma_force))
            };
            let of_opening = 2.0 * held.opening / (TAU * s);
            let by_radius = of_opening * (held.slope - held.by_radius) - held.energy_release_rate() / s;
            return Some(Released {
                contact_radius: radius,
                energy: signed(&held) * unit,
                error: (of_opening * of_column).abs() * unit,
                by_radius: by_radius * unit / self.units.length,
            });
        }
        let held = self.at_force(approach, force)?;
        let s = held.contact_radius;
        // δ and P move s, and both of them K: dP = 2s dδ − 2K ds.
        let of_opening = 2.0 * held.opening / (TAU * s);
        let of_radius = of_opening * held.slope - held.energy_release_rate() / s;
        let by_approach = -of_opening + of_radius * s / held.opening;
        let by_force = -of_radius / (2.0 * held.opening) - by_approach * compliance;
        Some(Released {
            contact_radius: s * self.units.length,
            energy: signed(&held) * unit,
            error: hypot(by_approach * sigma_x, by_force * sigma_force) * unit,
            by_radius: 0.0,
        })
    }

    /// The x of a row less the approach, or the position, that its force and its contact radius give.
    pub(super) fn offset(&self, point: &MeasuredPoint) -> Option<f64> {
        let s = radius_of(self.abscissa, point)? / self.units.length;
        if !(s > 0.0 && s <= self.panels.reach()) {
            return None;
        }
        let force = self.force(point);
        let of_spring = match self.control {
            Control::Stiffness(k) => force / k,
            _ => 0.0,
        };
        let held = HeldDisc::new(&self.panels, Control::Force, s, force);
        Some(point.x - (held.approach + of_spring) * self.units.length)
    }

    /// G at a row with another instrument.
    pub(super) fn energy_with(&self, point: &MeasuredPoint, instrument: Instrument) -> Option<f64> {
        Some(Self { instrument, ..self.clone() }.released(point)?.energy)
    }

    /// The disc that has the force `force` at the approach `approach` and pulls at its edge.
    fn at_force(&self, approach: f64, force: f64) -> Option<HeldDisc> {
        let at = |s: f64| HeldDisc::new(&self.panels, Control::Displacement, s, approach);
        let (lo, hi) = (self.panels.smallest(), self.panels.reach());
        // Below the disc whose edge is free the force rises with s: the disc looked for lies beyond that one.
        let is_beyond = |held: &HeldDisc| held.opening > 0.0 && held.force < force;
        if !is_beyond(&at(hi)) {
            return None;
        }
        let [_, found] = root::halved(lo, hi, |s| !is_beyond(&at(s)));
        Some(at(found)).filter(|held| (held.force - force).abs() <= 1e-6 * (force.abs() + held.force.abs()))
    }
}

/// G, negative where the edge is pressed.
fn signed(held: &HeldDisc) -> f64 {
    held.energy_release_rate() * if held.opening < 0.0 { -1.0 } else { 1.0 }
}

/// The rows in contact.
pub(super) fn attached(branches: &Branches) -> impl Iterator<Item = &MeasuredPoint> {
    branches.list.iter().flat_map(|branch| &branch.attached)
}

/// The contact radius that is measured at a point.
pub(super) fn radius_of(abscissa: Abscissa, point: &MeasuredPoint) -> Option<f64> {
    let radius = if abscissa == Abscissa::Radius { point.x } else { point.radius };
    radius.is_finite().then_some(radius)
}
