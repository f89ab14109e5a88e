//! The equilibrium curve between two contact radii: its states to draw, its limit points, and the arc-length tracer.

use super::equilibrium::{Equilibrium, Scales, Stability, State, StatePoint, unknown};
use super::monotone::{Limit, Monotone};
use super::path::{PathError, Zones};
use super::places::{Detail, places};
use crate::continuation::{Branch, End, Settings, Stop, Tracer};
use crate::disc::exact::outer_side;
use crate::disc::{Basis, Local, Place, Solution, Table};
use crate::problem::{Control, Printer, Reduced};
use crate::progress::{Progress, Stopped, Unwatched};
use crate::root;
use std::sync::Arc;

/// A trace this near to a corner, in units of the ranges of δ, P and s, goes straight to it.
const CORNER_STEP: f64 = 0.02;
/// The edge moves at most this share of a wave per arc-length step: without it traces go astray.
pub const WAVE_SHARE: f64 = 1.0 / 12.0;

/// Why a curve ends where it does.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{}", self.words(&Printer::reduced()))]
pub enum CurveStop {
    /// It reached the end contact radius.
    End,
    /// The basis has no equilibrium beyond.
    NoEquilibrium(f64),
    /// The tracer stopped for another reason.
    Tracer(Stop),
}

impl CurveStop {
    /// Why, in words.
    pub fn words(&self, printer: &Printer) -> String {
        match self {
            Self::End => "the end contact radius was reached".to_owned(),
            Self::NoEquilibrium(s) => {
                let s = printer.length(*s);
                format!("the basis has no equilibrium below the contact radius {s} (a finer basis may help)")
            }
            Self::Tracer(stop) => stop.to_string(),
        }
    }
}

/// One state of the curve, without its energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// s.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// The slopes of the curve.
    pub slopes: Stability,
}

/// The equilibrium curve, with its states from the largest contact radius to the smallest.
#[derive(Debug, Clone)]
pub struct Curve {
    /// The equations it solves, with its scales.
    pub equilibrium: Equilibrium,
    /// The equilibria over all radii, from the axis to the outer end of the curve or further.
    pub solution: Arc<dyn Solution>,
    /// Its states, running inward.
    pub samples: Vec<Sample>,
    /// Why it ends.
    pub stop: CurveStop,
    /// The radii of the solution at which it begins and ends: contact radii, or outer edges of zones.
    ends: [f64; 2],
    /// The stretches kept so far, by control; they cover the whole solution.
    held: Vec<Arc<Monotone>>,
}

/// The settings of the arc-length tracer, which depend on the feature length of the gap.
pub fn settings(equilibrium: &Equilibrium) -> Settings {
    let mut settings = Settings::new(unknown::COUNT);
    if let Some(wave) = equilibrium.problem.gap.feature_length() {
        settings.largest_increment[unknown::CONTACT_RADIUS] =
            WAVE_SHARE * wave / equilibrium.scales.contact_radius;
    }
    settings
}

impl Curve {
    /// The curve from the contact radius `from` down to `to`.
    ///
    /// `None` when there is no equilibrium at `from`.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn new(
        problem: Reduced,
        basis: Arc<dyn Basis>,
        table: Arc<Table>,
        [from, to]: [f64; 2],
        detail: Detail,
        progress: &dyn Progress,
    ) -> Result<Option<Self>, Stopped> {
        let solution = basis.solution(&problem, to, from, progress)?;
        Ok(solution.and_then(|solution| Self::on(solution, problem, basis, table, [from, to], detail)))
    }

    fn on(
        solution: Arc<dyn Solution>,
        problem: Reduced,
        basis: Arc<dyn Basis>,
        table: Arc<Table>,
        [from, to]: [f64; 2],
        detail: Detail,
    ) -> Option<Self> {
        let sample = |at: Local| {
            let Local { contact_radius, approach, force, .. } = at;
            Sample { contact_radius, approach, force, slopes: at.stability() }
        };
        // Only as far as the curve is connected.
        let mut samples: Vec<Sample> = Vec::new();
        let mut stop = CurveStop::End;
        for on_panel in places(&*solution, from, to, detail).chunk_by(|a, b| a.panel == b.panel) {
            let panel = on_panel[0].panel;
            if !samples.is_empty() && !solution.is_joined(panel) {
                stop = CurveStop::NoEquilibrium(samples.last().map_or(from, |s| s.contact_radius));
                break;
            }
            for some in on_panel.chunks(4) {
                let x = std::array::from_fn(|i| some[i.min(some.len() - 1)].x);
                samples.extend(solution.at_four(panel, x).into_iter().take(some.len()).map(sample));
            }
        }
        // The radius returned is the one asked for, not what the panel's variable makes of it.
        samples.first_mut()?.contact_radius = from;
        let last = samples.last_mut()?;
        if stop == CurveStop::End {
            if last.contact_radius > to * (1.0 + 1e-9) {
                stop = CurveStop::NoEquilibrium(last.contact_radius);
            } else {
                last.contact_radius = to;
            }
        }
        let scales = Scales::of(samples.iter().map(|s| [s.approach, s.force, s.contact_radius]));
        let ends = [from, samples.last()?.contact_radius];
        let equilibrium = Equilibrium { problem, basis, table, scales };
        Some(Self { equilibrium, solution, samples, stop, ends, held: Vec::new() })
    }

    /// The curve of adhesion with a range, from the largest of `zones` inward, as long as each state is one disc in
    /// one zone. Its `equilibrium` knows no zone, so the states of this curve do not solve those equations. Its
    /// samples have the radius of the contact, 0 where there is none.
    ///
    /// # Errors
    /// [`PathError`] where no state is of that kind, or where that cannot be known.
    pub fn of_zones(
        problem: Reduced,
        basis: Arc<dyn Basis>,
        table: Arc<Table>,
        zones: &Zones,
        progress: &dyn Progress,
    ) -> Result<Self, PathError> {
        let solution = Arc::clone(&zones.solution);
        let (places, _) = zones.drawn(progress)?;
        let sample = |place: &Place| {
            let at = solution.at(*place);
            let contact_radius = solution.edges(*place).contact_radius;
            Sample { contact_radius, approach: at.approach, force: at.force, slopes: at.stability() }
        };
        let samples: Vec<Sample> = places.iter().map(sample).collect();
        let last = places.last().copied().unwrap_or(zones.start);
        let ends = [zones.start, last].map(|place| solution.radius(place));
        let scales = Scales::of(samples.iter().map(|s| [s.approach, s.force, s.contact_radius]));
        let equilibrium = Equilibrium { problem, basis, table, scales };
        Ok(Self { equilibrium, solution, samples, stop: CurveStop::End, ends, held: Vec::new() })
    }

    /// As `new`, but with a table of the gap of its own.
    pub fn of(problem: Reduced, basis: Arc<dyn Basis>, from: f64, to: f64) -> Option<Self> {
        let table = Table::new(Arc::clone(&problem.gap), from, &Unwatched).ok()?;
        Self::new(problem, basis, Arc::new(table), [from, to], Detail::Drawn, &Unwatched).ok().flatten()
    }

    /// The same curve under another work of adhesion, with the states between panels; `None` as for [`Curve::new`].
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn under(&self, work_of_adhesion: f64, progress: &dyn Progress) -> Result<Option<Self>, Stopped> {
        let Equilibrium { problem, basis, table, .. } = &self.equilibrium;
        let problem = Reduced { work_of_adhesion, ..problem.clone() };
        let (basis, table) = (Arc::clone(basis), Arc::clone(table));
        Self::new(problem, basis, table, [self.outermost(), self.innermost()], Detail::Borders, progress)
    }

    /// Whether its states are those of adhesion with a range.
    pub fn is_of_zones(&self) -> bool {
        let last = self.solution.len().checked_sub(1);
        last.is_some_and(|panel| self.solution.edges(Place { panel, x: 1.0 }).zone.is_some())
    }

    /// The largest contact radius of the curve.
    pub fn outermost(&self) -> f64 {
        self.samples.first().map_or(0.0, |at| at.contact_radius)
    }

    /// The smallest contact radius of the curve.
    pub fn innermost(&self) -> f64 {
        self.samples.last().map_or(0.0, |at| at.contact_radius)
    }

    /// The same curve on a solution that reaches further out, to `to` or as far as the gap is known; false when nothing
    /// could be added.
    pub fn reach(&mut self, to: f64) -> bool {
        self.reach_while(to, &Unwatched).unwrap_or(false)
    }

    /// The same while `progress` goes on.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn reach_while(&mut self, to: f64, progress: &dyn Progress) -> Result<bool, Stopped> {
        let to = to.min(self.equilibrium.problem.largest_contact());
        // Solving the equations of the curve again would give a solution without zones.
        if to <= self.solution.reach() || self.is_of_zones() {
            return Ok(false);
        }
        let Equilibrium { problem, basis, .. } = &self.equilibrium;
        let Some(solution) = basis.solution(problem, self.innermost(), to, progress)? else {
            return Ok(false);
        };
        let further = solution.reach() > self.solution.reach();
        self.solution = solution;
        self.held =
            self.held.iter().map(|held| Arc::new(Monotone::of(&*self.solution, held.control))).collect();
        Ok(further)
    }

    /// The stretches of `control` over the whole solution.
    pub fn monotone(&self, control: Control) -> Arc<Monotone> {
        let held = self.held.iter().find(|held| held.control == control);
        held.map_or_else(|| Arc::new(Monotone::of(&*self.solution, control)), Arc::clone)
    }

    /// Keeps the stretches of `control` from now on, so that they are found only once.
    pub fn hold(&mut self, control: Control) {
        if self.held.iter().all(|held| held.control != control) {
            self.held.push(self.monotone(control));
        }
    }

    /// The limit points of `control` on the curve, to rounding, from the start inward.
    pub fn limit_points(&self, control: Control) -> Vec<Limit> {
        let [hi, lo] = self.ends;
        let monotone = self.monotone(control);
        let on_curve =
            monotone.limits.iter().rev().filter(|at| lo <= at.contact_radius && at.contact_radius <= hi);
        let contact = |at: &Limit| self.solution.edges(at.place).contact_radius;
        let in_zones = self.is_of_zones();
        on_curve.map(|at| if in_zones { Limit { contact_radius: contact(at), ..*at } } else { *at }).collect()
    }

    /// The radii of the corners of the curve, where the slope of the gap jumps, ascending.
    pub fn corners(&self) -> Vec<f64> {
        let outer = |panel| self.solution.at(Place { panel, x: -1.0 });
        (1..self.solution.len())
            .map(outer)
            .filter(|at| at.stretch == 0.0 && at.slopes[0] != 0.0)
            .map(|at| at.contact_radius)
            .collect()
    }

    /// The state at a place, with its energy.
    pub fn state(&self, place: Place) -> State {
        let Local { contact_radius, approach, force, .. } = self.solution.at(place);
        State { contact_radius, approach, force, energy: self.solution.energy(place) }
    }

    /// The first point of a walk outward from the corner at the radius `s`: at the distance `length`, in units of the scales, or at
    /// the end of the panel. `None` where there is no corner.
    ///
    /// Just outside a corner the curve is vertical, which no tangent with respect to s can express.
    pub fn beyond_corner(&self, s: f64, length: f64) -> Option<StatePoint> {
        let place = self.solution.place(s)?;
        let Place { panel, .. } = outer_side(&*self.solution, place);
        if panel == place.panel {
            return None;
        }
        let corner = self.equilibrium.explicit(s)?;
        let span = self.solution.span(panel);
        let distance = |x: f64| {
            let point = self.equilibrium.explicit(span.radius(x));
            point.map_or(f64::INFINITY, |point| (point.y() - corner.y()).norm())
        };
        let far =
            if distance(1.0) > length { root::halved(-1.0, 1.0, |x| distance(x) <= length)[1] } else { 1.0 };
        self.equilibrium.explicit(span.radius(far))
    }

    /// The same stretch of curve by spherical arc-length continuation. It lands exactly on the end and on each corner
    /// on the way, and goes on from a corner with the tangent of the other side.
    ///
    /// `adjust` may change the settings of the tracer. The scales of the arc length are the ranges of δ, P and s.
    pub fn traced(
        &self,
        adjust: impl FnOnce(&mut Settings),
        progress: &dyn Progress,
    ) -> Option<(Branch, CurveStop)> {
        let mut settings = settings(&self.equilibrium);
        adjust(&mut settings);
        let (from, to) = (self.outermost(), self.innermost());
        let ends: Vec<f64> =
            self.corners().into_iter().rev().filter(|s| to < *s && *s < from).chain([to]).collect();
        let mut branch = Branch::default();
        let mut start = self.equilibrium.explicit(from)?;
        for end in ends {
            let last = self.equilibrium.explicit(end)?;
            let corner = end > to;
            let value = end / self.equilibrium.scales.contact_radius;
            // Next to a corner the curve is vertical, and Newton's method knows it only up to the corner.
            let is_near = |branch: &Branch| {
                let near = |point: &StatePoint| (point.y() - last.y()).norm() <= CORNER_STEP;
                corner && branch.points.last().is_some_and(near)
            };
            let aim = End { unknown: unknown::CONTACT_RADIUS, value };
            let (mut piece, stop) =
                Tracer::new(&self.equilibrium, settings.clone())
                    .trace(start, aim, |branch| !progress.stop() && !is_near(branch));
            branch.work += piece.work;
            let landed = !progress.stop() && stop != Stop::End && is_near(&piece);
            if landed {
                let point = last.clone();
                piece.points.push(match piece.points.last() {
                    Some(before) => point.after(before),
                    None => point,
                });
            }
            let joint = usize::from(!branch.points.is_empty());
            branch.points.extend(piece.points.into_iter().skip(joint));
            if stop != Stop::End && !landed {
                return Some((branch, CurveStop::Tracer(stop)));
            }
            start = last;
        }
        Some((branch, self.stop))
    }
}
