//! Steps, runs and jumps along the curve, made by hand.
//!
//! A request says where the walker stands and what it is to do; the answer is new states, never a change of old
//! ones. A step that would pass a limit point of the control stops exactly there.

use super::curve::CurveData;
use super::history::{Ahead, NodeKind, Setting};
use crate::case::Case;
use crate::contact::Control;
use crate::continuation::{Stepper, Work, events, locate, step_size};
use crate::quasistatic::curve::settings;
use crate::quasistatic::energy;
use crate::quasistatic::jump::{Nodes, Run};
use crate::quasistatic::landscape;
use crate::quasistatic::unload::INWARD_REACH;
use crate::quasistatic::{Admissibility, Equilibrium, Event, Losses, Point, State, Stiffness};
use crate::ritz::{self, NewtonSettings};
use crate::theory::Exact;
use std::sync::Arc;

/// Most states of one request: a run that meets nothing ends.
pub const RUN_POINTS: usize = 5000;
/// A walk leaves the range of the curve by at most this factor in the contact radius.
pub(super) const ROOM: f64 = 3.0;

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
    /// Its number.
    pub id: u64,
    /// What to do.
    pub action: Action,
    /// The curve of the problem: its setting, and its limit points for jumps.
    pub curve: Arc<CurveData>,
    /// Where the walker stands; none only for moves.
    pub from: Option<Point>,
    /// Whether it stands on a limit point of the control.
    pub on_limit: bool,
    /// What is controlled (reduced).
    pub control: Control,
    /// Whether the contact is to shrink.
    pub inward: bool,
    /// The longest step.
    pub length: f64,
}

/// One new state.
#[derive(Debug, Clone)]
pub struct Made {
    /// How it came about.
    pub kind: NodeKind,
    /// The problem it solves, which may be no longer the one on the screen.
    pub setting: Arc<Setting>,
    /// The point.
    pub point: Point,
    /// The state, reduced.
    pub state: State,
    /// How force and area answer to the approach there, reduced.
    pub stiffness: Stiffness,
    /// At a limit point: where the jump leads, if that is known.
    pub ahead: Option<Ahead>,
    /// Whether the state is admissible, and the nearest crest.
    pub admissibility: Admissibility,
    /// Decimal digits the basis can be trusted for there.
    pub digits: f64,
    /// The difference of P from the exact solution at the same contact radius, relative to its force scale.
    pub from_exact: f64,
    /// Whether a walk of its own begins here.
    pub begins: bool,
}

/// The end of a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// Done as asked.
    Done,
    /// A limit point of the control was reached.
    AtLimit,
    /// It was paused.
    Paused,
    /// The end of what can be walked was reached, in words.
    Ended(String),
    /// It cannot go on, in words.
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
                emit(Made { begins: true, ..made(request, NodeKind::Limit, limit.point.clone()) });
                Outcome::AtLimit
            }
            None => Outcome::Stopped("the curve has changed meanwhile".to_owned()),
        },
        Action::Solve { state } => solve(request, state, emit),
    }
}

impl Request {
    fn equilibrium(&self) -> &Equilibrium {
        &self.curve.sweep.curve.equilibrium
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

fn steps(request: &Request, count: usize, run: bool, emit: &mut dyn FnMut(Made) -> bool) -> Outcome {
    let equilibrium = request.equilibrium();
    let Some(from) = &request.from else {
        return Outcome::Stopped("there is no state to walk from".to_owned());
    };
    let mut settings = settings(equilibrium);
    if !run {
        settings.longest = request.length;
    }
    let row = equilibrium.control_row(request.control);
    let unit = row.normalize();
    let mut stepper = Stepper::new(settings.clone());
    stepper.length = request.length;
    let shrinking = |p: &Point| p.frame.tangent[2] < 0.0;
    let mut here = from.clone();
    if shrinking(&here) != request.inward {
        here = here.reversed();
    }
    let case = &request.curve.case;
    let mut just_left = request.on_limit;
    for _ in 0..count {
        if !run {
            // In steps by hand the length asked for counts, not the one the last step would allow.
            stepper.length = request.length;
        }
        let next = match stepper.step(equilibrium, &here) {
            Ok(next) => next,
            Err(failure) => return Outcome::Stopped(failure.to_string()),
        };
        let piece = [here.clone(), next.clone()];
        let mut work = Work::default();
        let limit = events::brackets(equilibrium, &piece, &unit, &settings, &mut work)
            .iter()
            .filter_map(|bracket| locate::limit_point(equilibrium, bracket, &unit, &settings, &mut work))
            // The slope at the limit point just left is zero to rounding, of either sign: not a new one.
            .find(|found| !just_left || (found.point.y - here.y).norm() > 1e-3 * next.length);
        if let Some(found) = limit {
            let mut point = found.point;
            point.length = (point.y - here.y).norm();
            point.turning = step_size::turning(&here, &point);
            point.rounds = next.rounds;
            emit(made(request, NodeKind::Limit, point));
            return Outcome::AtLimit;
        }
        just_left = false;
        let s = equilibrium.contact_radius(&next);
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

fn jump(request: &Request, emit: &mut dyn FnMut(Made) -> bool) -> Outcome {
    let equilibrium = request.equilibrium();
    let Some(from) = &request.from else {
        return Outcome::Stopped("there is no state to jump from".to_owned());
    };
    // Away from the stable side of a limit point; from an unstable state, as walked.
    let as_walked = if request.inward { Run::Inward } else { Run::Outward };
    let run = if request.on_limit { away(request, from) } else { as_walked };
    let landing = match landing(request, from, run) {
        Ok(landing) => landing,
        Err(reason) => return Outcome::Stopped(reason.to_owned()),
    };
    let value = equilibrium.control_row(request.control).dot(&from.y);
    let before = equilibrium.state(from);
    let event = Event::new(equilibrium, request.control, value, before, landing.as_ref(), Losses::Twice);
    let point = landing.unwrap_or_else(|| from.clone());
    emit(made(request, NodeKind::Jump(Box::new(event)), point));
    Outcome::Done
}

/// Where the edge comes to rest when it runs from `from` at constant control: `None` where the bodies come apart.
///
/// # Errors
/// Why the landing is not known.
fn landing(request: &Request, from: &Point, run: Run) -> Result<Option<Point>, &'static str> {
    let equilibrium = request.equilibrium();
    let control = request.control;
    let value = equilibrium.control_row(control).dot(&from.y);
    let s = equilibrium.contact_radius(from);
    let mut curve = request.curve.sweep.curve.clone();
    let mut limits = request.curve.limits.clone();
    // The walker itself may be beyond the curve on the screen, and so may be the landing.
    let here = if s > curve.outermost() { s * 1.01 } else { s };
    let further = [0.1, INWARD_REACH].map(|share| match run {
        Run::Inward => s * share,
        Run::Outward => s / share.max(1e-3),
    });
    for reach in [here].into_iter().chain(further) {
        let beyond = reach < curve.innermost() || reach > curve.outermost();
        if beyond && curve.extend(reach) {
            limits = curve.limit_points(control);
        }
        let nodes = Nodes::new(&curve, control, &limits);
        let tolerance = s * 1e-9;
        let node = nodes.points().iter().rposition(|p| equilibrium.contact_radius(p) >= s - tolerance);
        if let Some(landing) = nodes.run(&curve, node.unwrap_or(0), value, run) {
            let to = equilibrium.contact_radius(&landing.point);
            if !landscape::falls(&curve.equilibrium, control, value, s, to) {
                return Err("the edge cannot run to the next stable state: on the way the potential rises");
            }
            return Ok(Some(landing.point));
        }
    }
    if run == Run::Outward {
        return Err("no stable state lies outward at this control value");
    }
    if curve.innermost() > s * INWARD_REACH * (1.0 + 1e-9) {
        return Err("the basis has no equilibrium further in: the landing is not known");
    }
    Ok(None)
}

/// Where the edge runs from the limit point `from`, and what that costs; `None` where it is not known.
fn ahead(request: &Request, from: &Point) -> Option<Ahead> {
    let equilibrium = request.equilibrium();
    let after = landing(request, from, away(request, from)).ok()?.map(|point| equilibrium.state(&point));
    let value = equilibrium.control_row(request.control).dot(&from.y);
    let dissipated = energy::loss(request.control, value, &equilibrium.state(from), after.as_ref());
    Some(Ahead { after, dissipated })
}

/// The way the edge runs from a limit point: away from its stable side.
fn away(request: &Request, limit: &Point) -> Run {
    let bend = request.equilibrium().control_row(request.control).dot(&limit.frame.curvature);
    // A minimum of the control along the curve is left inward, a maximum outward.
    if bend > 0.0 { Run::Inward } else { Run::Outward }
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
        let feature = crate::contact::Gap::feature_length(&problem.gap).unwrap_or(s);
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
            crate::report::unload::control_name(request.control)
        )),
    }
}

/// The state nearest to the radius `s` at which the curve takes the control value.
fn nearest_crossing(request: &Request, value: f64, s: f64) -> Option<Point> {
    let equilibrium = request.equilibrium();
    let curve = &request.curve.sweep.curve;
    let row = equilibrium.control_row(request.control);
    let nodes = Nodes::new(curve, request.control, &curve.limit_points(request.control));
    let settings = settings(equilibrium);
    nodes
        .points()
        .windows(2)
        .filter(|pair| (row.dot(&pair[0].y) > value) != (row.dot(&pair[1].y) > value))
        .min_by(|a, b| {
            let away = |pair: &[Point]| (equilibrium.contact_radius(&pair[0]) - s).abs();
            away(a).total_cmp(&away(b))
        })
        .and_then(|pair| {
            locate::control_value(
                equilibrium,
                &pair[0],
                &pair[1],
                &row,
                value,
                &settings,
                &mut Work::default(),
            )
        })
}
