//! Steps, runs and jumps along the curve, made by hand.
//!
//! A request says where the walker stands and what it is to do; the answer is new states, never a change of old
//! ones. A step that would pass a limit point of the control stops exactly there.

use super::curve::CurveData;
use super::node::{Ahead, NodeKind};
use super::setting::Setting;
use pulloff_engine::case::Case;
use pulloff_engine::continuation::Tracer;
use pulloff_engine::disc::Place;
use pulloff_engine::problem::Control;
use pulloff_engine::quasistatic::curve::settings;
use pulloff_engine::quasistatic::jump::{self, Run};
use pulloff_engine::quasistatic::{
    Admissibility, Curve, Equilibrium, Event, Limit, Losses, Monotone, Point, State, Stiffness, Turn, energy,
    landscape,
};
use pulloff_engine::ritz::{self, NewtonSettings};
use pulloff_engine::theory::Exact;
use std::sync::Arc;

/// Most states of one request: a run that meets nothing ends.
pub const RUN_POINTS: usize = 5000;
/// A walk leaves the range of the curve by at most this factor in the contact radius.
pub(super) const ROOM: f64 = 3.0;

/// A landing outward is looked for further out by this factor, and up to this multiple of the radius.
const OUTWARD_STEP: f64 = 1.5;
const OUTWARD_REACH: f64 = 1000.0;

/// A state solved again lies within this share of a wave, or of its radius, of the old one.
const NEAR: f64 = 0.5;

/// What the walker is to do.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// So many steps, stopping at a limit point of the control.
    Steps(usize),
    /// Steps to the next limit point of the control.
    ToLimit,
    /// The same, and no further than so many states.
    Run(usize),
    /// The edge runs at constant control to the next stable state.
    Jump,
    /// The state of this contact radius (reduced), on the explicit curve.
    MoveTo(f64),
    /// The limit point of this event.
    MoveToEvent {
        /// The number of the event, from 0, among those of the curve.
        event: usize,
        /// The number of its limit point on the curve.
        limit: usize,
    },
    /// The state of the problem as it is now, at the control value and near the radius of the old one.
    Solve {
        /// The state before the change, in the user's units.
        state: State,
    },
}

/// One request.
#[derive(Debug, Clone)]
pub struct Request {
    pub id: u64,
    pub action: Action,
    /// The curve of the problem: its setting, and its limit points for jumps.
    pub curve: Arc<CurveData>,
    /// Where the walker stands; none only for moves.
    pub from: Option<Point>,
    /// Whether it stands on a limit point of the control.
    pub on_limit: bool,
    /// What is controlled (reduced).
    pub control: Control,
    pub inward: bool,
    pub length: f64,
}

/// One new state; the fields are as in [`Node`](super::node::Node).
#[derive(Debug, Clone)]
pub struct Made {
    pub kind: NodeKind,
    /// The problem it solves, which may be no longer the one on the screen.
    pub setting: Arc<Setting>,
    pub point: Point,
    pub state: State,
    pub stiffness: Stiffness,
    pub ahead: Option<Ahead>,
    pub admissibility: Admissibility,
    pub digits: f64,
    pub from_exact: f64,
    pub begins: bool,
}

/// The end of a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    Done,
    /// A limit point of the control was reached.
    AtLimit,
    Paused,
    /// The end of what can be walked was reached, in words.
    Ended(String),
    Stopped(String),
}

/// Does what `request` asks; each new state goes to `emit`, which says whether to go on.
pub fn walk(request: &Request, emit: &mut dyn FnMut(Made) -> bool) -> Outcome {
    match &request.action {
        Action::Steps(count) => steps(request, *count, false, emit),
        Action::ToLimit => match steps(request, RUN_POINTS, true, emit) {
            Outcome::Done => Outcome::Ended(format!("no limit point within {RUN_POINTS} steps")),
            outcome => outcome,
        },
        Action::Run(count) => steps(request, *count, true, emit),
        Action::Jump => jump(request, emit),
        Action::MoveTo(s) => match request.equilibrium().explicit(*s) {
            Some(point) => {
                emit(Made { begins: true, ..made(request, NodeKind::Moved, point) });
                Outcome::Done
            }
            None => Outcome::Stopped("there is no equilibrium at that contact radius".to_owned()),
        },
        Action::MoveToEvent { limit, .. } => match request.curve.limits.get(*limit) {
            Some(limit) => {
                let Some(point) = request.equilibrium().explicit(limit.contact_radius) else {
                    return Outcome::Stopped("there is no equilibrium at the limit point".to_owned());
                };
                emit(Made { begins: true, ..made(request, NodeKind::Limit, point) });
                Outcome::AtLimit
            }
            None => Outcome::Stopped("the curve has changed meanwhile".to_owned()),
        },
        Action::Solve { state } => solve(request, state, emit),
    }
}

impl Request {
    fn equilibrium(&self) -> &Equilibrium {
        &self.curve.base.curve.equilibrium
    }

    fn case(&self) -> &Case {
        &self.curve.case
    }
}

/// The relative difference of the force of `state` from the exact solution of `case` at the same contact radius.
pub fn from_exact(case: &Case, state: &State) -> f64 {
    let state = state.in_units(case.units());
    let exact = Exact::of(&case.problem).force(state.contact_radius);
    (state.force - exact) / exact.abs()
}

fn made(request: &Request, kind: NodeKind, point: Point) -> Made {
    let equilibrium = request.equilibrium();
    let state = equilibrium.state(&point);
    Made {
        setting: Arc::clone(&request.curve.setting),
        stiffness: equilibrium.stiffness(&point),
        admissibility: equilibrium.admissibility(&point),
        ahead: if kind == NodeKind::Limit { ahead(request, &point) } else { None },
        digits: equilibrium.basis.trusted_digits(&equilibrium.problem, state.contact_radius),
        from_exact: from_exact(request.case(), &state),
        begins: false,
        kind,
        point,
        state,
    }
}

/// A place at which a step by hand ends: a limit point of the control, or a corner of the curve.
#[derive(Debug, Clone, Copy)]
struct Stop {
    contact_radius: f64,
    is_limit: bool,
    is_corner: bool,
}

/// Within this share of its radius the walker stands on a stop.
const LEFT: f64 = 1e-12;

/// The stops on the curve of `request` up to the radius `reach`, ascending.
fn stops(request: &Request, reach: f64) -> Vec<Stop> {
    let mut curve = request.curve.base.curve.clone();
    curve.reach(reach);
    let monotone = curve.monotone(request.control);
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
fn located(request: &Request, stop: Stop) -> Stop {
    const ROOM: f64 = 1.05;
    let away = |other: &Stop| (other.contact_radius - stop.contact_radius).abs();
    let found = stops(request, ROOM * stop.contact_radius).into_iter();
    let mut found = found.min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(stop);
    if !found.is_corner {
        // A limit point is known to the root of rounding: the digits beyond differ from table to table, and a replay would too.
        const KNOWN: u64 = 1 << 8;
        let bits = found.contact_radius.to_bits();
        found.contact_radius = f64::from_bits((bits + KNOWN / 2) & !(KNOWN - 1));
    }
    found
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

fn steps(request: &Request, count: usize, run: bool, emit: &mut dyn FnMut(Made) -> bool) -> Outcome {
    let equilibrium = request.equilibrium();
    let curve = &request.curve.base.curve;
    let Some(from) = &request.from else {
        return Outcome::Stopped("there is no state to walk from".to_owned());
    };
    let mut settings = settings(equilibrium);
    if !run {
        settings.longest = request.length;
    }
    let mut tracer = Tracer::new(equilibrium, settings);
    tracer.length = request.length;
    let turned = |point: Point| {
        let shrinking = point.tangent()[2] < 0.0;
        if shrinking == request.inward { point } else { point.reversed() }
    };
    let mut here = turned(from.clone());
    let case = &request.curve.case;
    let start = equilibrium.contact_radius(&here).max(case.start);
    let mut stops = stops(request, start);
    let mut known = start.max(curve.solution.reach());
    for _ in 0..count {
        if !run {
            // In steps by hand the length asked for counts, not the one the last step would allow.
            tracer.length = request.length;
        }
        let before = equilibrium.contact_radius(&here);
        let next = match next(request, &stops, &mut tracer, &here) {
            Ok(next) => turned(next),
            Err(failure) => return Outcome::Stopped(failure),
        };
        let s = equilibrium.contact_radius(&next);
        if s > known {
            known = 1.2 * s;
            stops = self::stops(request, known);
        }
        if let Some(stop) = first_between(&stops, before, s) {
            let stop = located(request, stop);
            let Some(mut point) = equilibrium.explicit(stop.contact_radius).map(turned) else {
                return Outcome::Stopped("there is no equilibrium at the next limit point".to_owned());
            };
            point = point.after(&here);
            point.rounds = next.rounds;
            let kind = if stop.is_limit { NodeKind::Limit } else { NodeKind::Step };
            here = point.clone();
            let wanted = emit(made(request, kind, point));
            if stop.is_limit {
                return Outcome::AtLimit;
            }
            if !wanted {
                return Outcome::Paused;
            }
            continue;
        }
        here = next.clone();
        if !emit(made(request, NodeKind::Step, next)) {
            return Outcome::Paused;
        }
        if request.inward && s < case.end {
            return Outcome::Ended("the end contact radius is reached; b turns round".to_owned());
        }
        if !request.inward && s > ROOM * case.start {
            return Outcome::Ended(
                "nothing found up to three times the start radius; b turns round".to_owned(),
            );
        }
    }
    Outcome::Done
}

/// The next point by arc length; a corner of the curve is left and reached without the tangent that it does not have.
///
/// # Errors
/// Why there is none, in words.
fn next(request: &Request, stops: &[Stop], tracer: &mut Tracer, here: &Point) -> Result<Point, String> {
    let equilibrium = request.equilibrium();
    let s = equilibrium.contact_radius(here);
    let towards = if request.inward { 0.0 } else { f64::INFINITY };
    let on_corner = stops.iter().any(|stop| stop.is_corner && (stop.contact_radius / s - 1.0).abs() <= LEFT);
    if on_corner && !request.inward {
        let mut curve = request.curve.base.curve.clone();
        curve.reach(1.1 * s);
        let left = curve.beyond_corner(s, tracer.length);
        return left.ok_or_else(|| "there is no equilibrium beyond the corner".to_owned());
    }
    let ahead = first_between(stops, s, towards).filter(|stop| stop.is_corner);
    let corner = ahead.and_then(|stop| equilibrium.explicit(stop.contact_radius));
    if let Some(corner) = corner.filter(|corner| (corner.y() - here.y()).norm() <= tracer.length) {
        return Ok(corner);
    }
    tracer.step(here).map_err(|failure| failure.to_string())
}

fn jump(request: &Request, emit: &mut dyn FnMut(Made) -> bool) -> Outcome {
    let Some(from) = &request.from else {
        return Outcome::Stopped("there is no state to jump from".to_owned());
    };
    let (curve, leaves, landing) = match landing(request, from) {
        Ok(found) => found,
        Err(reason) => return Outcome::Stopped(reason.to_owned()),
    };
    let event = Event::new(&curve, request.control, leaves, landing, Losses::Twice);
    let point = match landing {
        Some(place) => request.equilibrium().explicit(curve.solution.at(place).contact_radius),
        None => Some(from.clone()),
    };
    let Some(point) = point else {
        return Outcome::Stopped("there is no equilibrium at the landing".to_owned());
    };
    emit(made(request, NodeKind::Jump(Box::new(event)), point));
    Outcome::Done
}

/// The place that the edge leaves at constant control from `from`, and where it comes to rest: nowhere where the bodies come
/// apart; with a curve that reaches there.
/// Errors: Why the landing is not known.
fn landing(request: &Request, from: &Point) -> Result<(Curve, Place, Option<Place>), &'static str> {
    let equilibrium = request.equilibrium();
    let control = request.control;
    let s = equilibrium.contact_radius(from);
    let mut curve = request.curve.base.curve.clone();
    curve.reach(s * (1.0 + 1e-9));
    let mut reach = s;
    loop {
        let monotone = curve.monotone(control);
        let Some(place) = curve.solution.place(s.min(curve.solution.reach())) else {
            return Err("the basis has no equilibrium here");
        };
        // Away from the stable side of a limit point; from any other state, as walked.
        let limit = if request.on_limit { nearest_limit(&monotone, s) } else { None };
        let (place, stretch, run) = match limit {
            Some((index, limit)) => match limit.turn {
                Turn::Minimum => (limit.place, index + 1, Run::Inward),
                Turn::Maximum => (limit.place, index, Run::Outward),
            },
            None if request.inward => (place, monotone.stretch_of(s), Run::Inward),
            None => (place, monotone.stretch_of(s), Run::Outward),
        };
        let value = monotone.value(&curve.solution.at(place));
        match jump::run(&curve, &monotone, stretch, value, run) {
            Ok(Some(landing)) => {
                let to = curve.solution.at(landing.place).contact_radius;
                let held = curve.solution.at(place);
                let held = control.value(held.approach, held.force);
                if !landscape::falls(&curve, control, held, s, to) {
                    return Err(
                        "the edge cannot run to the next stable state: on the way the potential rises",
                    );
                }
                return Ok((curve, place, Some(landing.place)));
            }
            Ok(None) if run == Run::Inward => return Ok((curve, place, None)),
            Ok(None) => {
                reach *= OUTWARD_STEP;
                if reach > OUTWARD_REACH * s || !curve.reach(reach) {
                    return Err("no stable state lies outward at this control value");
                }
            }
            Err(_) => return Err("the basis has no equilibrium further in: the landing is not known"),
        }
    }
}

/// The limit point nearest to the radius `s`, with its number.
fn nearest_limit(monotone: &Monotone, s: f64) -> Option<(usize, Limit)> {
    let away = |limit: &Limit| (limit.contact_radius - s).abs();
    let limits = monotone.limits.iter().copied().enumerate();
    let (_, limit) = limits.min_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)))?;
    // The stretch that ends there.
    let inner = monotone.stretches.iter().position(|stretch| stretch.outer == limit.place)?;
    Some((inner, limit))
}

/// Where the edge runs from the limit point `from`, and what that costs; `None` where it is not known.
fn ahead(request: &Request, from: &Point) -> Option<Ahead> {
    let on_limit = Request { on_limit: true, ..request.clone() };
    let (curve, leaves, landing) = landing(&on_limit, from).ok()?;
    let after = landing.map(|place| curve.state(place));
    let dissipated = energy::loss(request.control, &curve.state(leaves), after.as_ref());
    Some(Ahead { after, dissipated })
}

/// The state at the old control value after a change, from the old contact radius.
fn solve(request: &Request, old: &State, emit: &mut dyn FnMut(Made) -> bool) -> Outcome {
    let equilibrium = request.equilibrium();
    let case = &request.curve.case;
    let units = case.units();
    let value = request.control.value(old.approach / units.length, old.force / units.force);
    let s = old.contact_radius / units.length;
    let settings = NewtonSettings::default();
    let problem = &equilibrium.problem;
    // Newton may find another state far away on a wavy gap: the old radius' own branch is wanted.
    let near = |found: f64| {
        let feature = pulloff_engine::gap::Gap::feature_length(&problem.gap).unwrap_or(s);
        (found - s).abs() <= NEAR * feature.min(s)
    };
    let newton = ritz::solve(equilibrium.basis.as_ref(), problem, request.control, value, s, settings)
        .ok()
        .filter(|solved| near(solved.evaluation.contact_radius))
        .and_then(|solved| {
            let mut point = equilibrium.point(&solved.evaluation)?;
            point.rounds = solved.rounds;
            Some(point)
        });
    let point = newton.or_else(|| nearest_crossing(request, value, s));
    match point {
        Some(point) => {
            emit(made(request, NodeKind::Solved, point));
            Outcome::Done
        }
        None => Outcome::Stopped(format!(
            "no equilibrium at this {} near the old contact radius",
            pulloff_engine::report::unload::control_name(request.control)
        )),
    }
}

/// The state nearest to the radius `s` at which the curve takes the control value.
fn nearest_crossing(request: &Request, value: f64, s: f64) -> Option<Point> {
    let curve = &request.curve.base.curve;
    let solution = &*curve.solution;
    let monotone = curve.monotone(request.control);
    let value = match request.control {
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
        .and_then(|s| request.equilibrium().explicit(s))
}
