//! Steps, runs and jumps along the curve, made by hand.
//!
//! A request says where the walker stands and what it should do; the answer is new states, never a change to old ones.

use super::command::{Command, Id};
use super::curve::CurveData;
use super::follow::Before;
use super::history::History;
use super::node::{Node, NodeKind, Trace};
use pulloff_engine::annuli::Contacts;
use pulloff_engine::case::Case;
use pulloff_engine::problem::{Begin, Control, Turn};
use pulloff_engine::quasistatic::path::Direction;
pub(super) use pulloff_engine::quasistatic::walk::ROOM;
use pulloff_engine::quasistatic::walk::{
    Along, Arrival, At, Emit, Reached, Walk, WalkEnd, WalkFailure, Walked, edges,
};
use pulloff_engine::quasistatic::{Admissibility, State, StatePoint};
use pulloff_engine::report::problem::control_name;
use pulloff_engine::theory::Exact;
use pulloff_engine::units::Quantity;
use pulloff_engine::units::number::said;
use std::sync::Arc;

/// The most states of one request, after which a run that meets nothing ends.
pub const RUN_POINTS: usize = 5000;

/// What the walker should do.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// This many steps, stopping at a limit point of the control.
    Steps(usize),
    /// Steps to the next limit point of the control.
    ToLimit,
    /// The same, but outward no further than the end of the path, if there is one (reduced).
    ToEvent(Option<Turn>),
    /// The same, but no further than this many states.
    Run(usize),
    /// The edge runs at constant control to the next stable state.
    Jump,
    /// The state with this contact radius (reduced), on the explicit curve, and the command that leads there.
    MoveTo { radius: f64, command: Command },
    /// The state with this number on the path that the walker follows, and the command that leads there.
    MoveToState { at: usize, command: Command },
    /// The limit point of the curve with this number, where an event begins, and the command that leads there.
    MoveToLimit { limit: usize, command: Command },
    /// The equilibrium with these contacts at this value of the control (both reduced), where `at` waits, and the
    /// command that leads there.
    MoveToContacts { contacts: Contacts, value: f64, at: At, command: Command },
    /// The state of the current problem, at the control value and near the radius of the old state.
    Solve {
        /// The state before the change, in the user's units.
        state: State,
        /// Its edges, if there are rings.
        rings: Option<Box<Before>>,
        /// Whether it was stable, or at the end of the stable part: then a stable state is sought.
        was_stable: bool,
        /// How the walk begins again if there is no such state; `None` once it has left the state it began with.
        begin: Option<Begin>,
    },
    /// The first touch of bodies that were apart, and the state it jumps to.
    Begin,
}

impl Action {
    /// Whether it begins a new walk, wherever the walker stood.
    pub fn begins(&self) -> bool {
        let is_move = matches!(self, Self::MoveTo { .. } | Self::MoveToState { .. } | Self::Begin);
        is_move || matches!(self, Self::MoveToLimit { .. } | Self::MoveToContacts { .. })
    }

    /// Goes to where a walk on `curve` begins with `begin`, which need not be that of the curve's preset.
    pub fn beginning(begin: Begin, curve: &CurveData) -> Self {
        match begin {
            Begin::Disc if curve.along.is_none() => {
                Self::MoveTo { radius: curve.case.start, command: Id::Restart.into() }
            }
            Begin::Disc | Begin::Apart => Self::Begin,
        }
    }

    /// Solves the state of the walker again for other values; `None` before a walk.
    pub fn solve(history: &History, begin: Begin) -> Option<Self> {
        let node = history.current()?;
        Some(Self::Solve {
            state: node.state.in_units(node.setting.units()),
            rings: Before::of(node),
            was_stable: node.stability.under(node.control) || matches!(node.kind, NodeKind::Limit),
            begin: history.has_just_begun().then_some(begin),
        })
    }
}

/// One request.
#[derive(Debug, Clone)]
pub struct Request {
    pub id: u64,
    pub action: Action,
    /// The curve of the problem: its setting, and its limit points for jumps.
    pub curve: Arc<CurveData>,
    /// Where the walker stands; `None` only for moves.
    pub from: Option<StatePoint>,
    /// The number of the state on the path, if the walker follows one.
    pub on_path: Option<usize>,
    /// What the walker stands on.
    pub at: At,
    /// What is controlled (reduced).
    pub control: Control,
    pub inward: bool,
    pub length: f64,
    /// States per second; without it, they are made as fast as possible. Without a screen, nobody watches.
    pub pace: Option<f64>,
}

/// The end of a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum WalkOutcome {
    Done,
    /// A limit point of the control, or a touch, was reached.
    AtLimit,
    Paused,
    /// The end of what can be walked was reached; the reason in words.
    Ended(String),
    Stopped(String),
}

/// Does what `request` asks; each new state goes to `emit`, which says whether to go on.
pub fn walk(request: &Request, emit: &mut dyn FnMut(Node) -> bool) -> WalkOutcome {
    let mut arrive = |reached: Reached| emit(made(request, reached));
    let end = match (follow(request, &request.action, &mut arrive), &request.action) {
        (Err(WalkFailure::NotSolved), Action::Solve { begin: Some(begin), .. }) => {
            let solved = &mut |reached| arrive(Reached { arrival: Arrival::Solved, ..reached });
            follow(request, &Action::beginning(*begin, &request.curve), solved)
        }
        (end, _) => end,
    };
    outcome(request, end)
}

/// Does `action` on the curve of `request`, or along the path of the device.
fn follow(request: &Request, action: &Action, arrive: &mut Emit<'_>) -> Walked {
    if request.curve.along.is_some() {
        return along(request, action, arrive);
    }
    let case = &request.curve.case;
    let walk = Walk {
        curve: &request.curve.base.curve,
        range: [case.start, case.end],
        control: request.control,
        from: request.from.as_ref(),
        at: request.at,
        inward: request.inward,
        length: request.length,
    };
    match action {
        Action::Steps(count) => walk.steps(*count, false, arrive),
        Action::ToLimit | Action::ToEvent(None) => walk.steps(RUN_POINTS, true, arrive),
        Action::ToEvent(Some(end)) => to_end(&walk, *end, arrive),
        Action::Run(count) => walk.steps(*count, true, arrive),
        Action::Jump => walk.jump(arrive),
        Action::MoveTo { radius, .. } => walk.move_to(*radius, arrive),
        Action::MoveToContacts { contacts, value, at, .. } => {
            walk.move_to_contacts(contacts, *value, *at, arrive)
        }
        Action::MoveToLimit { limit, .. } => match request.curve.limits.get(*limit) {
            Some(limit) => walk.move_to_limit(limit.contact_radius, arrive),
            None => Err(WalkFailure::Edges("the curve has since changed".to_owned())),
        },
        Action::MoveToState { .. } => Err(WalkFailure::NoEquilibrium("on a path")),
        Action::Begin => walk.first_touch(arrive),
        Action::Solve { state, rings: Some(before), .. } => before.follow(&request.curve, state, arrive),
        Action::Solve { state, rings: None, was_stable, .. } => {
            let units = case.units();
            let value = request.control.value(state.approach / units.length, state.force / units.force);
            solve(&walk, value, state.contact_radius / units.length, *was_stable, arrive)
        }
    }
}

/// How a walk ended, in words where there is something to say.
fn outcome(request: &Request, end: Walked) -> WalkOutcome {
    let case = &request.curve.case;
    let length = |r: f64| said(&case.shown, Quantity::Length, r * case.units().length);
    let turn = Id::Reverse.named();
    match end {
        Ok(WalkEnd::Done) if matches!(request.action, Action::ToLimit | Action::ToEvent(_)) => {
            WalkOutcome::Ended(format!("no limit point and no touch within {RUN_POINTS} steps"))
        }
        Ok(WalkEnd::Done) => WalkOutcome::Done,
        Ok(WalkEnd::AtLimit | WalkEnd::AtTouch) => WalkOutcome::AtLimit,
        Ok(WalkEnd::Paused) => WalkOutcome::Paused,
        Ok(WalkEnd::PathEnds) => WalkOutcome::Ended(match &request.curve.along {
            Some(Ok(path)) => {
                format!("the path ends here: {}", path.stop.words(&case.printer()))
            }
            _ => "the path ends here".to_owned(),
        }),
        Ok(WalkEnd::AtEnd) => {
            WalkOutcome::Ended(format!("the end contact radius is reached; {turn} turns round"))
        }
        Ok(WalkEnd::EdgesMeet(radius)) => WalkOutcome::Ended(format!(
            "the branch ends here: two edges meet at r {}; {turn} turns round",
            length(radius)
        )),
        Ok(WalkEnd::Vanishes(radius)) => WalkOutcome::Ended(format!(
            "the branch ends here: the contact at r {} shrinks to nothing; {turn} turns round",
            length(radius)
        )),
        Ok(WalkEnd::OutOfRange) => WalkOutcome::Ended(format!(
            "nothing found up to three times the start radius; {turn} turns round"
        )),
        Err(WalkFailure::NotSolved) => {
            let held = match request.control {
                Control::Stiffness(_) => "place of the spring's far end",
                control => control_name(control),
            };
            WalkOutcome::Stopped(match request.action {
                Action::Solve { rings: Some(_), .. } => {
                    format!("no equilibrium of these contacts at this {held} near the old edges")
                }
                _ => format!("no equilibrium at this {held} near the old radius"),
            })
        }
        Err(failure) => WalkOutcome::Stopped(failure.to_string()),
    }
}

/// The same if the states lie on no single curve: along the path of the device.
fn along(request: &Request, action: &Action, arrive: &mut Emit<'_>) -> Walked {
    let (curve, case) = (&request.curve, &request.curve.case);
    let path = match &curve.along {
        Some(Ok(path)) => path,
        Some(Err(reason)) => return Err(WalkFailure::Edges(reason.clone())),
        None => return Err(WalkFailure::NoState("walk")),
    };
    let along = Along {
        path,
        scales: &curve.setting.scales,
        digits: curve.base.digits,
        from: request.on_path,
        length: request.length,
    };
    let direction = if request.inward { Direction::Unloading } else { Direction::Loading };
    match action {
        Action::Steps(count) | Action::Run(count) => along.steps(*count, arrive),
        Action::ToLimit | Action::ToEvent(_) => along.steps(RUN_POINTS, arrive),
        Action::Jump => along.jump(arrive),
        Action::Begin => along.move_to(0, arrive),
        Action::MoveTo { radius, .. } => along.move_near(*radius, direction, arrive),
        Action::MoveToState { at, .. } => along.move_to(*at, arrive),
        Action::MoveToLimit { .. } | Action::MoveToContacts { .. } => {
            Err(WalkFailure::NoEquilibrium("on a curve"))
        }
        Action::Solve { state, .. } => {
            let units = case.units();
            let value = request.control.value(state.approach / units.length, state.force / units.force);
            along.solve(value, state.contact_radius / units.length, direction, arrive)
        }
    }
}

/// The state at the held value. If the walker stood within the path and other values, such as those of a fit, would
/// leave it far beyond the path, it goes to where the path starts.
fn solve(walk: &Walk<'_>, value: f64, from: f64, was_stable: bool, arrive: &mut Emit<'_>) -> Walked {
    /// A state is far beyond the start at this many times its contact radius; a little further out it is still seen
    /// beside the curve.
    const BEYOND: f64 = 1.1;
    let [start, _] = walk.range;
    let mut solved = None;
    let end = walk.solve(value, from, was_stable, &mut |reached| {
        solved = Some(reached);
        true
    });
    match solved {
        Some(reached) if reached.state.contact_radius > BEYOND * start && from <= BEYOND * start => {
            walk.move_to(start, &mut |reached| arrive(Reached { arrival: Arrival::Solved, ..reached }))
        }
        Some(reached) => {
            arrive(reached);
            end
        }
        None => end,
    }
}

/// The quantity that marks the end of a path, in a state.
pub(super) fn measure(end: Turn, control: Control, state: &State) -> f64 {
    match end {
        Turn::Approach(_) => state.approach,
        Turn::Force(_) => state.force,
        Turn::Radius(_) => state.contact_radius,
        Turn::Control(_) => control.value(state.approach, state.force),
    }
}

/// Steps to the next event, but no further than `end`, which is found by halving the step that would pass it.
fn to_end(walk: &Walk<'_>, end: Turn, arrive: &mut Emit<'_>) -> Walked {
    /// Each round gives one binary digit.
    const ROUNDS: usize = 60;
    /// This close to the end, the walker counts as standing on it.
    const ON_IT: f64 = 1e-12;
    let over = |reached: &Reached| measure(end, walk.control, &reached.state) - end.value();
    let (mut last, mut passing): (Option<StatePoint>, Option<f64>) = (None, None);
    let ended = walk.steps(RUN_POINTS, true, &mut |reached| {
        if over(&reached) > 0.0 {
            passing = Some(reached.point.length);
            return false;
        }
        last = Some(reached.point.clone());
        arrive(reached)
    });
    let Some(passing) = passing else { return ended };
    let from = Walk {
        from: last.as_ref().or(walk.from),
        at: if last.is_some() { At::Nothing } else { walk.at },
        ..*walk
    };
    let mut found = None;
    if let (Turn::Radius(radius), false) = (end, from.from.is_some_and(edges::has_rings)) {
        // What fails here, as below, finds no state.
        let _ = from.move_to(radius, &mut |reached| {
            found = Some(reached);
            true
        });
    } else {
        let (mut short, mut long) = (0.0, 2.0 * passing);
        for _ in 0..ROUNDS {
            let length = 0.5 * (short + long);
            let mut here = None;
            let _ = Walk { length, ..from }.steps(1, false, &mut |reached| {
                here = Some(reached);
                true
            });
            let Some(here) = here else { break };
            let is_short = over(&here) <= 0.0;
            let is_on_it = over(&here).abs() <= ON_IT * end.value().abs();
            if is_short {
                short = length;
                found = Some(here);
            } else {
                long = length;
            }
            if is_short && is_on_it {
                break;
            }
        }
    }
    if let Some(found) = found {
        arrive(Reached { arrival: Arrival::Step, ..found });
    }
    Ok(WalkEnd::AtLimit)
}

/// The relative difference of the force of `state` from the exact solution of `case` at the same contact radius.
pub fn from_exact(case: &Case, state: &State) -> f64 {
    let state = state.in_units(case.units());
    let exact = Exact::of(&case.problem).force(state.contact_radius);
    (state.force - exact) / exact.abs()
}

/// A new state, which is not in the tree yet.
fn made(request: &Request, reached: Reached) -> Node {
    let Reached { arrival, point, state, stability, stiffness, admissibility, digits, on_path } = reached;
    let (kind, ahead) = match arrival {
        Arrival::Step => (NodeKind::Step, None),
        Arrival::Limit(ahead) => (NodeKind::Limit, ahead),
        Arrival::Touch(_) | Arrival::Moved if request.action == Action::Begin => (NodeKind::Start, None),
        Arrival::Touch(radius) => (NodeKind::Touch(radius), None),
        Arrival::Jump(event) => (NodeKind::Jump(event), None),
        Arrival::Moved => (NodeKind::Moved, None),
        Arrival::Solved => (NodeKind::Solved, None),
    };
    // The exact solution is that of one disc whose edge opens.
    // A crest that touches just here does not overlap, whatever the last digits of its gap say.
    let overlaps = admissibility.overlapping().is_some();
    let holds = admissibility.holds || overlaps && matches!(kind, NodeKind::Touch(_));
    let admissibility = Admissibility { holds, ..admissibility };
    let is_beside = on_path.is_some() || edges::has_rings(&point);
    let exact = if is_beside { f64::NAN } else { from_exact(&request.curve.case, &state) };
    Node {
        parent: None,
        control: request.curve.setting.control,
        step: 0,
        request: request.id,
        setting: Arc::clone(&request.curve.setting),
        stability,
        stiffness,
        admissibility,
        digits,
        from_exact: exact,
        on_path,
        begins: request.action.begins(),
        trace: Trace::default(),
        kind,
        ahead,
        point,
        state,
    }
}
