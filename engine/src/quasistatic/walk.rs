//! A walk along the equilibrium curve, one request at a time: steps, runs, jumps, moves.
//!
//! A [`Walk`] says where the walker stands and how it goes; each state it arrives at is handed over with how it came about.
//! A step that would pass a limit point of the control, or a corner of the curve, stops exactly there. All quantities are
//! reduced.

use super::curve::{Curve, settings};
use super::equilibrium::{Equilibrium, Point, State};
use super::jump::{self, Run};
use super::monotone::{Limit, Monotone, Turn};
use super::unload::{Event, Losses};
use super::{energy, landscape};
use crate::continuation::{StepFailure, Tracer};
use crate::disc::Place;
use crate::gap::Gap;
use crate::problem::Control;
use crate::ritz::{self, NewtonSettings};
use thiserror::Error;

/// A walk leaves the range of the curve by at most this factor in the contact radius.
pub const ROOM: f64 = 3.0;

/// A landing outward is looked for further out by this factor, and up to this multiple of the radius.
const OUTWARD_STEP: f64 = 1.5;
const OUTWARD_REACH: f64 = 1000.0;

/// A state solved again lies within this share of a wave, or of its radius, of the old one.
const NEAR: f64 = 0.5;

/// Within this share of its radius the walker stands on a stop.
const LEFT: f64 = 1e-12;

/// Where a walker stands, and how it goes.
#[derive(Debug, Clone, Copy)]
pub struct Walk<'a> {
    /// The curve of the problem.
    pub curve: &'a Curve,
    /// The contact radii between which the curve is asked for: its start and its end.
    pub range: [f64; 2],
    /// What is controlled.
    pub control: Control,
    /// Where the walker stands; only moves need no such state.
    pub from: Option<&'a Point>,
    /// Whether it stands on a limit point of the control.
    pub on_limit: bool,
    /// Whether the contact is to shrink.
    pub inward: bool,
    /// The longest step, in the scaled unknowns.
    pub length: f64,
}

/// Where the edge would land from a limit point, and what it would cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ahead {
    /// The landing; `None` where the bodies come apart.
    pub after: Option<State>,
    /// The energy lost; `None` for a pull-off under a dead load.
    pub dissipated: Option<f64>,
}

/// How the walker came to a state.
#[derive(Debug, Clone, PartialEq)]
pub enum Arrival {
    /// By a step.
    Step,
    /// At a limit point of the control, with where the jump from there leads, if that is known.
    Limit(Option<Ahead>),
    /// By a jump.
    Jump(Box<Event>),
    /// Moved to a contact radius.
    Moved,
    /// Solved again for a changed problem.
    Solved,
}

/// How a request ended.
#[derive(Debug, Clone, PartialEq)]
pub enum WalkEnd {
    /// Done as asked.
    Done,
    /// At a limit point of the control.
    AtLimit,
    /// Whoever took the states did not want more.
    Paused,
    /// At the end contact radius.
    AtEnd,
    /// At [`ROOM`] times the start radius.
    OutOfRange,
    /// It could not go on.
    Failed(WalkFailure),
}

/// Why a walk cannot go on.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum WalkFailure {
    /// There is no state to begin with.
    #[error("there is no state to {0} from")]
    NoState(&'static str),
    /// The curve has no such state.
    #[error("there is no equilibrium {0}")]
    NoEquilibrium(&'static str),
    /// No step by arc length.
    #[error(transparent)]
    Step(#[from] StepFailure),
    /// The basis has no equilibrium where the walker stands.
    #[error("the basis has no equilibrium here")]
    NoBasis,
    /// The edge would have to climb.
    #[error("the edge cannot run to the next stable state: on the way the potential rises")]
    Rises,
    /// The edge runs outward and finds no stable state.
    #[error("no stable state lies outward at this control value")]
    NothingOutward,
    /// The edge runs inward beyond what the basis can tell.
    #[error("the basis has no equilibrium further in: the landing is not known")]
    NothingInward,
    /// The changed problem has no state near the old one.
    #[error("no equilibrium at this control value near the old contact radius")]
    NotSolved,
}

/// Takes the states of a walk, and says whether it is to go on.
pub type Emit<'a> = dyn FnMut(Arrival, Point) -> bool + 'a;

/// A place at which a step ends: a limit point of the control, or a corner of the curve.
#[derive(Debug, Clone, Copy)]
struct Stop {
    contact_radius: f64,
    is_limit: bool,
    is_corner: bool,
}

/// The first of `stops`, which ascend, on the way from one radius to another, the latter included.
fn first_between(stops: &[Stop], from: f64, to: f64) -> Option<Stop> {
    if to < from {
        let from = from * (1.0 - LEFT);
        stops.iter().rev().find(|stop| to <= stop.contact_radius && stop.contact_radius < from).copied()
    } else {
        let from = from * (1.0 + LEFT);
        stops.iter().find(|stop| from < stop.contact_radius && stop.contact_radius <= to).copied()
    }
}

impl Walk<'_> {
    fn equilibrium(&self) -> &Equilibrium {
        &self.curve.equilibrium
    }

    /// So many steps of the length asked for, or of a `run` of the length that the curve allows; stops at a limit point.
    pub fn steps(&self, count: usize, run: bool, emit: &mut Emit<'_>) -> WalkEnd {
        self.try_steps(count, run, emit).unwrap_or_else(WalkEnd::Failed)
    }

    /// Lets the edge run at constant control to the next stable state.
    pub fn jump(&self, emit: &mut Emit<'_>) -> WalkEnd {
        self.try_jump(emit).unwrap_or_else(WalkEnd::Failed)
    }

    /// Goes to the state of this contact radius.
    pub fn move_to(&self, s: f64, emit: &mut Emit<'_>) -> WalkEnd {
        let Some(point) = self.equilibrium().explicit(s) else {
            return WalkEnd::Failed(WalkFailure::NoEquilibrium("at that contact radius"));
        };
        emit(Arrival::Moved, point);
        WalkEnd::Done
    }

    /// Goes to the limit point at this contact radius.
    pub fn move_to_limit(&self, s: f64, emit: &mut Emit<'_>) -> WalkEnd {
        let Some(point) = self.equilibrium().explicit(s) else {
            return WalkEnd::Failed(WalkFailure::NoEquilibrium("at the limit point"));
        };
        emit(Arrival::Limit(self.ahead(&point)), point);
        WalkEnd::AtLimit
    }

    /// Goes to the state at this value of the control, nearest to the contact radius `s` before the problem changed.
    pub fn solve(&self, value: f64, s: f64, emit: &mut Emit<'_>) -> WalkEnd {
        let equilibrium = self.equilibrium();
        let problem = &equilibrium.problem;
        // Newton may find another state far away on a wavy gap: the old radius' own branch is wanted.
        let near = |found: f64| {
            let feature = problem.gap.feature_length().unwrap_or(s);
            (found - s).abs() <= NEAR * feature.min(s)
        };
        let settings = NewtonSettings::default();
        let newton = ritz::solve(equilibrium.basis.as_ref(), problem, self.control, value, s, settings)
            .ok()
            .filter(|solved| near(solved.evaluation.contact_radius))
            .and_then(|solved| {
                let mut point = equilibrium.point(&solved.evaluation)?;
                point.rounds = solved.rounds;
                Some(point)
            });
        let Some(point) = newton.or_else(|| self.nearest_crossing(value, s)) else {
            return WalkEnd::Failed(WalkFailure::NotSolved);
        };
        emit(Arrival::Solved, point);
        WalkEnd::Done
    }

    /// The stops on the curve up to the radius `reach`, ascending.
    fn stops(&self, reach: f64) -> Vec<Stop> {
        let mut curve = self.curve.clone();
        curve.reach(reach);
        let monotone = curve.monotone(self.control);
        let limits = monotone.limits.iter().map(|at| Stop {
            contact_radius: at.contact_radius,
            is_limit: true,
            is_corner: at.corner,
        });
        let mut stops: Vec<Stop> = limits.collect();
        for contact_radius in curve.corners() {
            if stops.iter().all(|stop| stop.contact_radius.to_bits() != contact_radius.to_bits()) {
                stops.push(Stop { contact_radius, is_limit: false, is_corner: true });
            }
        }
        stops.sort_by(|a, b| a.contact_radius.total_cmp(&b.contact_radius));
        stops
    }

    /// The stop computed with the smallest sufficient table, so that its bits do not depend on how far the walk has been.
    fn located(&self, stop: Stop) -> Stop {
        const SPARE: f64 = 1.05;
        let away = |other: &Stop| (other.contact_radius - stop.contact_radius).abs();
        let found = self.stops(SPARE * stop.contact_radius).into_iter();
        let mut found = found.min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(stop);
        if !found.is_corner {
            // A limit point is known to the root of rounding: the digits beyond differ from table to table, and a replay would too.
            const KNOWN: u64 = 1 << 8;
            let bits = found.contact_radius.to_bits();
            found.contact_radius = f64::from_bits((bits + KNOWN / 2) & !(KNOWN - 1));
        }
        found
    }

    fn try_steps(&self, count: usize, run: bool, emit: &mut Emit<'_>) -> Result<WalkEnd, WalkFailure> {
        let equilibrium = self.equilibrium();
        let from = self.from.ok_or(WalkFailure::NoState("walk"))?;
        let [start, end] = self.range;
        let mut settings = settings(equilibrium);
        if !run {
            settings.longest = self.length;
        }
        let mut tracer = Tracer::new(equilibrium, settings);
        tracer.length = self.length;
        let turned = |point: Point| {
            let shrinking = point.tangent()[2] < 0.0;
            if shrinking == self.inward { point } else { point.reversed() }
        };
        let mut here = turned(from.clone());
        let outermost = equilibrium.contact_radius(&here).max(start);
        let mut stops = self.stops(outermost);
        let mut known = outermost.max(self.curve.solution.reach());
        for _ in 0..count {
            if !run {
                // In steps by hand the length asked for counts, not the one the last step would allow.
                tracer.length = self.length;
            }
            let before = equilibrium.contact_radius(&here);
            let next = turned(self.next(&stops, &mut tracer, &here)?);
            let s = equilibrium.contact_radius(&next);
            if s > known {
                known = 1.2 * s;
                stops = self.stops(known);
            }
            if let Some(stop) = first_between(&stops, before, s) {
                let stop = self.located(stop);
                let point = equilibrium.explicit(stop.contact_radius).map(turned);
                let point = point.ok_or(WalkFailure::NoEquilibrium("at the next limit point"))?;
                let mut point = point.after(&here);
                point.rounds = next.rounds;
                here = point.clone();
                if stop.is_limit {
                    emit(Arrival::Limit(self.ahead(&point)), point);
                    return Ok(WalkEnd::AtLimit);
                }
                if !emit(Arrival::Step, point) {
                    return Ok(WalkEnd::Paused);
                }
                continue;
            }
            here = next.clone();
            if !emit(Arrival::Step, next) {
                return Ok(WalkEnd::Paused);
            }
            if self.inward && s < end {
                return Ok(WalkEnd::AtEnd);
            }
            if !self.inward && s > ROOM * start {
                return Ok(WalkEnd::OutOfRange);
            }
        }
        Ok(WalkEnd::Done)
    }

    /// The next point by arc length; a corner of the curve is left and reached without the tangent that it does not have.
    fn next(&self, stops: &[Stop], tracer: &mut Tracer<'_>, here: &Point) -> Result<Point, WalkFailure> {
        let equilibrium = self.equilibrium();
        let s = equilibrium.contact_radius(here);
        let towards = if self.inward { 0.0 } else { f64::INFINITY };
        let is_here = |stop: &Stop| (stop.contact_radius / s - 1.0).abs() <= LEFT;
        if stops.iter().any(|stop| stop.is_corner && is_here(stop)) && !self.inward {
            let mut curve = self.curve.clone();
            curve.reach(1.1 * s);
            let left = curve.beyond_corner(s, tracer.length);
            return left.ok_or(WalkFailure::NoEquilibrium("beyond the corner"));
        }
        let ahead = first_between(stops, s, towards).filter(|stop| stop.is_corner);
        let corner = ahead.and_then(|stop| equilibrium.explicit(stop.contact_radius));
        if let Some(corner) = corner.filter(|corner| (corner.y() - here.y()).norm() <= tracer.length) {
            return Ok(corner);
        }
        Ok(tracer.step(here)?)
    }

    fn try_jump(&self, emit: &mut Emit<'_>) -> Result<WalkEnd, WalkFailure> {
        let from = self.from.ok_or(WalkFailure::NoState("jump"))?;
        let (curve, leaves, landing) = self.landing(from)?;
        let event = Event::new(&curve, self.control, leaves, landing, Losses::Twice);
        let point = match landing {
            Some(place) => self.equilibrium().explicit(curve.solution.at(place).contact_radius),
            None => Some(from.clone()),
        };
        let point = point.ok_or(WalkFailure::NoEquilibrium("at the landing"))?;
        emit(Arrival::Jump(Box::new(event)), point);
        Ok(WalkEnd::Done)
    }

    /// The place that the edge leaves at constant control from `from`, and where it comes to rest, `None` where the bodies
    /// come apart; with a curve that reaches there.
    fn landing(&self, from: &Point) -> Result<(Curve, Place, Option<Place>), WalkFailure> {
        let s = self.equilibrium().contact_radius(from);
        let mut curve = self.curve.clone();
        curve.reach(s * (1.0 + 1e-9));
        let mut reach = s;
        loop {
            let monotone = curve.monotone(self.control);
            let place = curve.solution.place(s.min(curve.solution.reach())).ok_or(WalkFailure::NoBasis)?;
            // Away from the stable side of a limit point; from any other state, as walked.
            let limit = if self.on_limit { nearest_limit(&monotone, s) } else { None };
            let (place, stretch, run) = match limit {
                Some((index, limit)) => match limit.turn {
                    Turn::Minimum => (limit.place, index + 1, Run::Inward),
                    Turn::Maximum => (limit.place, index, Run::Outward),
                },
                None if self.inward => (place, monotone.stretch_of(s), Run::Inward),
                None => (place, monotone.stretch_of(s), Run::Outward),
            };
            let value = monotone.value(&curve.solution.at(place));
            match jump::run(&*curve.solution, &monotone, stretch, value, run) {
                Ok(Some(landing)) => {
                    let to = curve.solution.at(landing.place).contact_radius;
                    let held = curve.solution.at(place);
                    let held = self.control.value(held.approach, held.force);
                    if !landscape::falls(&curve, self.control, held, s, to) {
                        return Err(WalkFailure::Rises);
                    }
                    return Ok((curve, place, Some(landing.place)));
                }
                Ok(None) if run == Run::Inward => return Ok((curve, place, None)),
                Ok(None) => {
                    reach *= OUTWARD_STEP;
                    if reach > OUTWARD_REACH * s || !curve.reach(reach) {
                        return Err(WalkFailure::NothingOutward);
                    }
                }
                Err(_) => return Err(WalkFailure::NothingInward),
            }
        }
    }

    /// Where the edge runs from the limit point `from`, and what that costs; `None` where it is not known.
    fn ahead(&self, from: &Point) -> Option<Ahead> {
        let on_limit = Self { on_limit: true, ..*self };
        let (curve, leaves, landing) = on_limit.landing(from).ok()?;
        let after = landing.map(|place| curve.state(place));
        let dissipated = energy::loss(self.control, &curve.state(leaves), after.as_ref());
        Some(Ahead { after, dissipated })
    }

    /// The state nearest to the radius `s` at which the curve takes the control value.
    fn nearest_crossing(&self, value: f64, s: f64) -> Option<Point> {
        let curve = self.curve;
        let solution = &*curve.solution;
        let monotone = curve.monotone(self.control);
        let value = match self.control {
            Control::Displacement | Control::Force => value,
            // The stretches hold the value scaled so.
            Control::Stiffness(k) => value * (k / (1.0 + k)),
        };
        let radius = |place: Place| solution.at(place).contact_radius;
        let on_curve = |s: &f64| curve.innermost() <= *s && *s <= curve.outermost();
        monotone
            .crossings(solution, value)
            .into_iter()
            .map(|(place, _)| radius(place))
            .filter(on_curve)
            .min_by(|a, b| (a - s).abs().total_cmp(&(b - s).abs()))
            .and_then(|s| self.equilibrium().explicit(s))
    }
}

/// The limit point nearest to the radius `s`, with the number of the stretch that ends there.
fn nearest_limit(monotone: &Monotone, s: f64) -> Option<(usize, Limit)> {
    let limits = monotone.limits.iter().copied();
    let away = |limit: &Limit| (limit.contact_radius - s).abs();
    let limit = limits.min_by(|a, b| away(a).total_cmp(&away(b)))?;
    let inner = monotone.stretches.iter().position(|stretch| stretch.outer == limit.place)?;
    Some((inner, limit))
}
