//! The equilibria of one disc, exactly, on the panels of the table: what a loop follows while there are no rings.
//!
//! One disc has one equilibrium for each radius. The stretches on which its control is monotone, its limit points and
//! its landings are found on every panel ([`Monotone`]), so that none is missed however close to another it lies, and
//! the length of the waves does not matter. A crest outside can touch only while the control goes up: contact gained
//! anywhere eases every other edge, so along a stable stretch the gap outside falls as the radius of the disc grows,
//! and changes its sign once.

use crate::annuli::Ground;
use crate::disc::solution::ExactSolution;
use crate::disc::{Place, Solution, TableError};
use crate::problem::{Control, Turn};
use crate::progress::Progress;
use crate::quasistatic::curve::Curve;
use crate::quasistatic::energy;
use crate::quasistatic::jump::{self, EdgeDirection};
use crate::quasistatic::monotone::Monotone;
use crate::root;
use std::sync::Arc;

/// Control values nearer to each other than this share of themselves count as equal.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The equilibria of one disc as far out as a ground reaches.
#[derive(Debug, Clone)]
pub struct Lane {
    pub(super) solution: Arc<dyn Solution>,
    pub(super) monotone: Arc<Monotone>,
    /// Where δ or P has an extreme.
    pub(super) extremes: Vec<Place>,
}

impl Lane {
    /// The equilibria under the adhesion `gamma` (E* = 1), which is positive, and a device.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn new(
        ground: &Ground,
        gamma: f64,
        control: Control,
        progress: &dyn Progress,
    ) -> Result<Self, TableError> {
        let solution = ExactSolution::refined(&ground.table, ground.reach(), gamma, progress)?;
        let solution: Arc<dyn Solution> = Arc::new(solution);
        Ok(Self::on(&solution, control, &|of| Arc::new(Monotone::of(&*solution, of))))
    }

    /// The equilibria of a curve, as far out as its solution goes.
    pub fn of(curve: &Curve, control: Control) -> Self {
        Self::on(&curve.solution, control, &|of| curve.monotone(of))
    }

    /// The equilibria of a solution, with its stretches by control.
    pub(super) fn on(
        solution: &Arc<dyn Solution>,
        control: Control,
        monotone: &dyn Fn(Control) -> Arc<Monotone>,
    ) -> Self {
        let held = monotone(control);
        let extremes = [Control::Displacement, Control::Force]
            .map(|of| if of == control { Arc::clone(&held) } else { monotone(of) })
            .map(|monotone| monotone.limits.iter().map(|limit| limit.place).collect::<Vec<_>>());
        Self { solution: Arc::clone(solution), monotone: held, extremes: extremes.concat() }
    }

    /// The weighted control of the control value `c`.
    fn weighted(&self, c: f64) -> f64 {
        let (of_approach, of_force) = self.monotone.control.weights();
        if self.monotone.control == Control::Force { of_force * c } else { of_approach * c }
    }

    /// The radius to which a disc of the radius `s`, in equilibrium or not, runs at the control value `c`: outward, to
    /// the least stable radius from there on; inward, to the largest. `None` where there is none.
    ///
    /// An edge that is not in equilibrium runs the way it is pulled, whatever `run` says: one that has come slightly
    /// too far goes back, not on to a state to which nothing drives it.
    pub fn landing(&self, s: f64, c: f64, run: EdgeDirection) -> Option<f64> {
        let value = self.weighted(c);
        let at = self.monotone.stretch_of(s);
        let stretch = self.monotone.stretches.get(at)?;
        let here = self.monotone.value(&self.solution.at(self.solution.place(s)?));
        let slack = ROUNDING * value.abs();
        let pulled = match here - value {
            by if by < -slack => EdgeDirection::Outward,
            by if by > slack => EdgeDirection::Inward,
            _ => run,
        };
        let lands_here = stretch.rising
            && match pulled {
                EdgeDirection::Outward => stretch.values[1] >= value - slack,
                EdgeDirection::Inward => stretch.values[0] <= value + slack,
            };
        let place = if lands_here {
            self.monotone.solve(&*self.solution, stretch, value)
        } else {
            let to = |run| jump::run(&*self.solution, &self.monotone, at, value, run).ok().flatten();
            to(pulled).or_else(|| to(run))?.place
        };
        Some(self.solution.radius(place))
    }

    /// What a jump between contacts, as [inner, outer], dissipates by area: from one disc to another, or to bodies
    /// apart; `None` for other contacts. A dead load of zero, at which bodies first touch, does no work: there the
    /// loss is the energy.
    pub fn area(&self, before: &[[f64; 2]], after: Option<&[[f64; 2]]>) -> Option<f64> {
        let place = |contacts: &[[f64; 2]]| match contacts {
            [[inner, outer]] if *inner <= 0.0 => self.solution.place(*outer),
            _ => None,
        };
        let from = place(before)?;
        if let Some(after) = after {
            return energy::area(&*self.solution, self.monotone.control, from, Some(place(after)?));
        }
        let held = self.monotone.control;
        let control = if held == Control::Force { Control::Displacement } else { held };
        energy::area(&*self.solution, control, from, None)
    }

    /// The first place between two on a stable stretch of zones at which the contact has the radius `s`; `None` where
    /// it never has.
    fn reaches(&self, s: f64, [from, to]: [Place; 2]) -> Option<Place> {
        let contact = |place: Place| self.solution.edges(place).contact_radius;
        if contact(from) >= s {
            return Some(from);
        }
        if contact(to) < s {
            return None;
        }
        let [lo, hi] = [from, to].map(|place| self.solution.radius(place));
        let [_, c] = root::halved(lo, hi, |c| self.solution.place(c).is_some_and(|place| contact(place) < s));
        self.solution.place(c)
    }

    /// The first place between two on a stable stretch at which `turn` is reached; `None` where it is not.
    pub fn turns(&self, turn: Turn, [from, to]: [Place; 2]) -> Option<Place> {
        let [inner, outer] = [from, to].map(|place| self.solution.radius(place));
        let measure = match turn {
            Turn::Radius(radius) if self.solution.edges(from).zone.is_some() => {
                return self.reaches(radius, [from, to]);
            }
            Turn::Radius(radius) => {
                return (radius <= outer).then(|| self.solution.place(radius.max(inner)).unwrap_or(to));
            }
            Turn::Approach(_) => Control::Displacement,
            Turn::Force(_) => Control::Force,
            Turn::Control(_) => self.monotone.control,
        };
        let other;
        let monotone = if measure == self.monotone.control {
            &self.monotone
        } else {
            other = Monotone::on(&*self.solution, measure, from.panel..to.panel + 1);
            &other
        };
        let value = match turn {
            Turn::Control(c) => self.weighted(c),
            turn => turn.value(),
        };
        let of = |place: Place| monotone.value(&self.solution.at(place));
        for stretch in &monotone.stretches {
            if !stretch.rising || stretch.radii[1] < inner || stretch.radii[0] > outer {
                continue;
            }
            let first = if stretch.radii[0] < inner { from } else { stretch.inner };
            let last = if stretch.radii[1] > outer { to } else { stretch.outer };
            if of(first) >= value {
                return Some(first);
            }
            if of(last) >= value {
                return Some(monotone.solve(&*self.solution, stretch, value));
            }
        }
        None
    }
}
