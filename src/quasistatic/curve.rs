//! The equilibrium curve between two contact radii, by either tracer, and its limit points.

use super::equilibrium::{Equilibrium, Point, Scales, inward, unknown};
use crate::contact::{Control, Gap, Reduced, Units};
use crate::continuation::sweep::sweep;
use crate::continuation::trace::trace;
use crate::continuation::{Branch, End, Settings, Stop, Work, events, locate};
use crate::ritz::{Basis, Evaluation, Order};
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// Steps of a sweep per wave of the gap: a wave drawn or searched with fewer loses its shape.
pub const SWEEP_STEPS_PER_WAVE: f64 = 40.0;
/// Largest step of a sweep relative to the radius: the curve behaves like √s towards s = 0.
pub const SWEEP_RATIO: f64 = 0.025;
/// The same beyond the inner end, where only landings are looked for: smaller discs are ever more alike.
const INWARD_RATIO: f64 = 0.1;
/// Points of a sweep: 500 waves at the full density.
pub const SWEEP_POINTS: usize = 20_000;
/// The edge moves at most this share of a wave per arc-length step: without it traces go astray.
pub const WAVE_SHARE: f64 = 1.0 / 12.0;

/// Why a curve ends where it does.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum CurveStop {
    /// It reached the end contact radius.
    End,
    /// The basis has no equilibrium beyond.
    NoEquilibrium(f64),
    /// The tracer stopped for another reason.
    Tracer(Stop),
}

impl fmt::Display for CurveStop {
    /// Its numbers as they stand.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words(&UnitSystem::Reduced))
    }
}

impl CurveStop {
    /// Why, with the numbers, which are in the user's units, as `shown` has them.
    pub fn words(&self, shown: &UnitSystem) -> String {
        match self {
            Self::End => "the end contact radius was reached".to_owned(),
            Self::NoEquilibrium(s) => {
                let s = said(shown, Quantity::Length, *s);
                format!("the basis has no equilibrium below the contact radius {s} (a finer basis may help)")
            }
            Self::Tracer(stop) => stop.to_string(),
        }
    }

    /// The same with its numbers in the user's units.
    #[must_use]
    pub fn in_units(self, units: &Units) -> Self {
        match self {
            Self::NoEquilibrium(s) => Self::NoEquilibrium(s * units.length),
            other => other,
        }
    }
}

/// Whether the control is smallest or largest at a limit point, along the contact radius.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Turn {
    /// A minimum over s: the edge runs inward from here (unloading).
    Minimum,
    /// A maximum over s: the edge runs outward from here (loading).
    Maximum,
}

/// A limit point of a control on a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// The control that turns here.
    pub control: Control,
    /// Which way it turns.
    pub turn: Turn,
    /// The index of the curve point before it.
    pub index: usize,
    /// The located point.
    pub point: Point,
}

/// The equilibrium curve, its points from the largest contact radius to the smallest.
#[derive(Debug, Clone)]
pub struct Curve {
    /// The equations it solves, with its scales.
    pub equilibrium: Equilibrium,
    /// Its points, running inward.
    pub branch: Branch<{ unknown::COUNT }>,
    /// Why it ends.
    pub stop: CurveStop,
    /// The limit points held, by control: those of all its points.
    held: Vec<(Control, Vec<Limit>)>,
}

/// The radii of a sweep from `from` to `to`, both included, in that order.
pub fn radii(from: f64, to: f64, feature_length: Option<f64>, steps_per_wave: f64) -> Vec<f64> {
    radii_by(SWEEP_RATIO, from, to, feature_length, steps_per_wave)
}

/// As [`radii`], with this largest step relative to the radius.
fn radii_by(ratio: f64, from: f64, to: f64, feature_length: Option<f64>, steps_per_wave: f64) -> Vec<f64> {
    let (lo, hi) = (from.min(to), from.max(to));
    let by_wave = feature_length.map_or(f64::INFINITY, |wave| wave / steps_per_wave);
    // With more waves than the budget allows the steps grow, so that the sweep still ends at `to`.
    let by_budget = (hi - lo) / SWEEP_POINTS as f64 * 2.0;
    let mut down = vec![hi];
    let mut s = hi;
    while down.len() < SWEEP_POINTS {
        s -= (ratio * s).min(by_wave.max(by_budget));
        if s <= lo {
            break;
        }
        down.push(s);
    }
    if lo < hi {
        down.push(lo);
    }
    if from < to {
        down.reverse();
    }
    down
}

/// The settings of the arc-length tracer for a gap with this feature length.
pub fn settings(equilibrium: &Equilibrium) -> Settings {
    let mut settings = Settings::new(unknown::COUNT);
    if let Some(wave) = equilibrium.problem.gap.feature_length() {
        settings.largest_increment[unknown::CONTACT_RADIUS] =
            WAVE_SHARE * wave / equilibrium.scales.contact_radius;
    }
    settings
}

impl Curve {
    /// The curve from `from` down to `to` through the explicit root at every radius.
    ///
    /// `None` when there is no equilibrium at `from`, or `go_on` said no before the first point.
    pub fn swept(
        problem: Reduced,
        basis: Arc<dyn Basis>,
        from: f64,
        to: f64,
        mut go_on: impl FnMut() -> bool,
    ) -> Option<Self> {
        let steps = radii(from, to, problem.gap.feature_length(), SWEEP_STEPS_PER_WAVE);
        let wanted = steps.len();
        let mut evaluations = basis.equilibria(&problem, &steps, Order::Curvature, &mut go_on);
        evaluations.retain(|e| e.approach.is_finite() && e.force.is_finite());
        let reached = evaluations.last()?.contact_radius;
        let equilibrium = Equilibrium { problem, basis, scales: Scales::of(&evaluations) };
        let branch = branch_through(&equilibrium, &evaluations);
        if branch.points.is_empty() {
            return None;
        }
        let complete = branch.points.len() == wanted;
        let stop = if complete { CurveStop::End } else { CurveStop::NoEquilibrium(reached) };
        Some(Self { equilibrium, branch, stop, held: Vec::new() })
    }

    /// The curve from `from` down to `to` by spherical arc-length continuation, landing exactly on `to`.
    ///
    /// `adjust` may change the settings of the tracer. The scales of the arc length are the ranges of δ, P and s over a coarse explicit curve.
    /// `None` when there is no equilibrium at `from`.
    pub fn traced(
        problem: Reduced,
        basis: Arc<dyn Basis>,
        from: f64,
        to: f64,
        adjust: impl FnOnce(&mut Settings),
        mut go_on: impl FnMut() -> bool,
    ) -> Option<Self> {
        /// Coarse sampling for the ranges only.
        const STEPS_PER_WAVE: f64 = 8.0;
        let steps = radii(from, to, problem.gap.feature_length(), STEPS_PER_WAVE);
        let evaluations = basis.equilibria(&problem, &steps, Order::State, &mut go_on);
        let equilibrium = Equilibrium { problem, basis, scales: Scales::of(&evaluations) };
        let start = equilibrium.explicit(from)?;
        let mut settings = settings(&equilibrium);
        adjust(&mut settings);
        let value = to / equilibrium.scales.contact_radius;
        let end = End { unknown: unknown::CONTACT_RADIUS, value };
        let (branch, stop) = trace(&equilibrium, start, end, &settings, |_| go_on());
        let stop = if stop == Stop::End { CurveStop::End } else { CurveStop::Tracer(stop) };
        Some(Self { equilibrium, branch, stop, held: Vec::new() })
    }

    /// The largest contact radius of the curve.
    pub fn outermost(&self) -> f64 {
        self.branch.points.first().map_or(0.0, |p| self.equilibrium.contact_radius(p))
    }

    /// The smallest contact radius of the curve.
    pub fn innermost(&self) -> f64 {
        self.branch.points.last().map_or(0.0, |p| self.equilibrium.contact_radius(p))
    }

    /// Continues the curve inward or outward to the radius `to`, as far as the gap is known, and the limit points it holds
    /// with it; false when nothing could be added.
    pub fn extend(&mut self, to: f64) -> bool {
        let to = to.min(self.equilibrium.problem.largest_contact());
        if (self.innermost()..=self.outermost()).contains(&to) {
            return false;
        }
        let inward = to < self.innermost();
        let from = if inward { self.innermost() } else { self.outermost() };
        let Equilibrium { problem, basis, .. } = &self.equilibrium;
        let ratio = if inward { INWARD_RATIO } else { SWEEP_RATIO };
        let steps = radii_by(ratio, from, to, problem.gap.feature_length(), SWEEP_STEPS_PER_WAVE);
        let new = steps.get(1..).unwrap_or_default();
        let mut evaluations = basis.equilibria(problem, new, Order::Curvature, &mut || true);
        if !inward {
            evaluations.reverse();
        }
        let added = branch_through(&self.equilibrium, &evaluations);
        let (before, count) = (self.branch.points.len(), added.points.len());
        self.branch.work += added.work;
        if inward {
            self.branch.points.extend(added.points);
        } else {
            self.branch.points.splice(0..0, added.points);
        }
        // The new pieces: the one that joins them to the old points is among them.
        let new = if inward { before - 1..before + count } else { 0..count + 1 };
        let mut held = std::mem::take(&mut self.held);
        for (control, limits) in &mut held {
            let found = self.limits_among(new.clone(), *control, &settings(&self.equilibrium));
            if inward {
                limits.extend(found);
            } else {
                for limit in limits.iter_mut() {
                    limit.index += count;
                }
                limits.splice(0..0, found);
            }
        }
        self.held = held;
        count > 0
    }

    /// Lets the curve begin with `point`, which lies on it: what is further out is forgotten.
    pub fn begin_at(&mut self, point: Point) {
        let s = self.equilibrium.contact_radius(&point);
        let outside =
            self.branch.points.iter().take_while(|p| self.equilibrium.contact_radius(p) >= s).count();
        self.branch.points.splice(..outside, [point]);
        for (_, limits) in &mut self.held {
            limits.retain(|limit| self.equilibrium.contact_radius(&limit.point) < s);
            for limit in limits {
                limit.index = (limit.index + 1).saturating_sub(outside);
            }
        }
    }

    /// The limit points of `control` on the curve, located to rounding, from the start inward: those held, if they are.
    pub fn limit_points(&self, control: Control) -> Vec<Limit> {
        let held = self.held.iter().find(|(held, _)| *held == control);
        held.map_or_else(|| self.limits_with(control, &|_| {}), |(_, limits)| limits.clone())
    }

    /// Holds the limit points of `control` from now on: they are located once.
    pub fn hold(&mut self, control: Control) {
        if self.held.iter().all(|(held, _)| *held != control) {
            self.held.push((control, self.limit_points(control)));
        }
    }

    /// The limit points of `control` as [`Curve::limit_points`], with changed settings: for measuring them.
    pub fn limits_with(&self, control: Control, adjust: &dyn Fn(&mut Settings)) -> Vec<Limit> {
        let mut settings = settings(&self.equilibrium);
        adjust(&mut settings);
        self.limits_among(0..self.branch.points.len(), control, &settings)
    }

    /// The limit points of `control` among these of the points.
    fn limits_among(&self, points: Range<usize>, control: Control, settings: &Settings) -> Vec<Limit> {
        let first = points.start;
        let row = self.equilibrium.control_row(control);
        let mut work = Work::default();
        events::brackets(&self.equilibrium, &self.branch.points[points], &row, settings, &mut work)
            .into_iter()
            .filter_map(|bracket| {
                // Rows differ by many orders between units: the location wants a unit row.
                let unit = row.normalize();
                let located = locate::limit_point(&self.equilibrium, &bracket, &unit, settings, &mut work);
                let (point, bend) = if let Some(found) = located {
                    (found.point, found.bend)
                } else {
                    let (from, to) = (&bracket.from, &bracket.to);
                    let point = self.equilibrium.bisect(from, to, |p| p.slope(&unit))?;
                    // The slope grows through a minimum.
                    (point, to.slope(&unit) - from.slope(&unit))
                };
                let turn = if bend > 0.0 { Turn::Minimum } else { Turn::Maximum };
                Some(Limit { control, turn, index: first + bracket.index, point })
            })
            .collect()
    }
}

/// A branch through explicit solutions in the order given, running inward.
fn branch_through(equilibrium: &Equilibrium, evaluations: &[Evaluation]) -> Branch<{ unknown::COUNT }> {
    sweep(
        evaluations,
        |e| Some((equilibrium.unknowns_of(e), equilibrium.linearization(e, e.force))),
        &inward(),
        |_| true,
    )
}
