//! What turns measured rows into states of a disc: the force, the approach and the radius of a row, and its G.

use crate::case::Case;
use crate::disc::{Panels, Place, chebyshev};
use crate::elementary::hypot;
use crate::measured::branches::MeasuredPoint;
use crate::measured::{Abscissa, Branches, Instrument};
use crate::problem::{Control, Units};
use crate::progress::{Progress, Unwatched};
use crate::quasistatic::admissible::Judge;
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
    /// Which of several contacts with one force and approach can be.
    pub(super) judge: Judge,
}

/// G of one row in base units, its standard deviation without the part from s, and its derivative with respect to s at
/// what else is measured.
#[derive(Debug, Clone, Copy)]
pub(super) struct Released {
    pub(super) contact_radius: f64,
    /// The standard deviation of a radius that force and approach give; 0 for one that is measured.
    pub(super) spread: f64,
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
            let is_wide = points.iter().all(|point| self.is_wide(point));
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

    /// Whether the gap is tabulated far enough for a row: from force and approach, as far as a disc whose edge pulls and whose
    /// force is smaller.
    fn is_wide(&self, point: &MeasuredPoint) -> bool {
        if self.pair != MeasuredPair::ForceApproach {
            return self.released(point).is_some();
        }
        let [approach, _] = self.approach(point);
        let held = HeldDisc::new(&self.panels, Control::Displacement, self.panels.reach(), approach);
        held.opening > 0.0 && held.force < self.force(point)
    }

    /// The approach at a row, reduced, and how much less it is for each unit of force.
    fn approach(&self, point: &MeasuredPoint) -> [f64; 2] {
        let way = (point.x - self.instrument.offset) / self.units.length;
        match self.control {
            Control::Stiffness(k) => [way - self.force(point) / k, 1.0 / k],
            _ => [way, 0.0],
        }
    }

    /// σ of x and P, reduced.
    fn noise(&self) -> [f64; 2] {
        [self.sigma[0] / self.units.length, self.sigma[1] / self.units.force]
    }

    /// The unit of G.
    fn unit(&self) -> f64 {
        self.units.force / self.units.length
    }

    /// G at a row; of several contacts with its force and approach that of the largest. `None` where its radius is not
    /// valid, or one for which the gap is not known.
    pub(super) fn released(&self, point: &MeasuredPoint) -> Option<Released> {
        if self.pair == MeasuredPair::ForceApproach {
            return self.all_released(point).pop();
        }
        let [sigma_x, sigma_force] = self.noise();
        let [approach, compliance] = self.approach(point);
        let radius = radius_of(self.abscissa, point)?;
        let s = radius / self.units.length;
        if !(s > 0.0 && s <= self.panels.reach()) {
            return None;
        }
        let (held, of_column) = if self.pair == MeasuredPair::ForceRadius {
            let held = HeldDisc::new(&self.panels, Control::Force, s, self.force(point));
            (held, held.by_control * sigma_force)
        } else {
            let held = HeldDisc::new(&self.panels, Control::Displacement, s, approach);
            (held, hypot(sigma_x, compliance * sigma_force))
        };
        let of_opening = 2.0 * held.opening / (TAU * s);
        let by_radius = of_opening * (held.slope - held.by_radius) - held.energy_release_rate() / s;
        Some(Released {
            contact_radius: radius,
            spread: 0.0,
            energy: signed(&held) * self.unit(),
            error: (of_opening * of_column).abs() * self.unit(),
            by_radius: by_radius * self.unit() / self.units.length,
        })
    }

    /// G of every contact that has the force and the approach of a row, by their radii.
    pub(super) fn all_released(&self, point: &MeasuredPoint) -> Vec<Released> {
        let [sigma_x, sigma_force] = self.noise();
        let [approach, compliance] = self.approach(point);
        let released = |held: HeldDisc| {
            let s = held.contact_radius;
            // δ and P move s, and both of them K: dP = 2s dδ − 2K ds.
            let of_opening = 2.0 * held.opening / (TAU * s);
            let of_radius = of_opening * held.slope - held.energy_release_rate() / s;
            let by_approach = -of_opening + of_radius * s / held.opening;
            let by_force = -of_radius / (2.0 * held.opening) - by_approach * compliance;
            let spread = hypot(s * sigma_x, (0.5 + compliance * s) * sigma_force) / held.opening;
            Released {
                contact_radius: s * self.units.length,
                spread: spread * self.units.length,
                energy: signed(&held) * self.unit(),
                error: hypot(by_approach * sigma_x, by_force * sigma_force) * self.unit(),
                by_radius: 0.0,
            }
        };
        self.at_force(approach, self.force(point)).into_iter().map(released).collect()
    }

    /// Whether the bodies stay apart around a contact at a row.
    pub(super) fn stays_apart(&self, point: &MeasuredPoint, released: &Released) -> bool {
        let [approach, _] = self.approach(point);
        self.judge.verdict(released.contact_radius / self.units.length, approach, &Unwatched).holds
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

    /// The discs that have the force `force` at the approach `approach` and pull at their edges, by their radii.
    fn at_force(&self, approach: f64, force: f64) -> Vec<HeldDisc> {
        let at = |s: f64| HeldDisc::new(&self.panels, Control::Displacement, s, approach);
        // At a held approach the force falls with s where the edge pulls, and rises where it is pressed.
        let mut ends = vec![self.panels.smallest()];
        for panel in 0..self.panels.list().len() {
            let mut series = self.panels.value_series(panel);
            let size: f64 = series.iter().map(|c| c.abs()).sum();
            series[0] -= approach;
            let places =
                chebyshev::roots(&series, f64::EPSILON * size).into_iter().map(|x| Place { panel, x });
            ends.extend(places.map(|place| self.panels.radius(place)));
        }
        ends.push(self.panels.reach());
        let of_stretch = |ends: &[f64]| {
            let [lo, hi] = [ends[0], ends[1]];
            let is_pulled = hi > lo && at(0.5 * (lo + hi)).opening > 0.0;
            if !is_pulled || at(lo).force < force || at(hi).force > force {
                return None;
            }
            let [_, found] = root::halved(lo, hi, |s| at(s).force >= force);
            Some(at(found)).filter(|held| held.opening > 0.0)
        };
        ends.windows(2).filter_map(of_stretch).collect()
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
