//! Steps, runs, jumps and undo: what is requested of the walk, and what becomes of its answers.

use crate::explorer::availability::goes_on;
use crate::explorer::command::{Id, LENGTHS, PACES};
use crate::explorer::curve::CurveData;
use crate::explorer::effect::Effect;
use crate::explorer::model::{Level, Model, Walking};
use crate::explorer::node::{Node, NodeKind};
use crate::explorer::pins::letter;
use crate::explorer::requests::{stop, stop_walk, want_curve};
use crate::explorer::status_line::{back_or_anew, of_before};
use crate::explorer::walk::{Action, Request, WalkOutcome, from_exact};
use pulloff_engine::problem::Begin;
use pulloff_engine::quasistatic::path::Direction;
use pulloff_engine::quasistatic::walk::At;
use pulloff_engine::report::number::{short, significant, with_unit};
use pulloff_engine::units::Quantity;
use std::sync::Arc;

/// Requests a walk on the curve on the screen, or says why there is none.
pub(in crate::explorer) fn walk(model: &mut Model, action: Action) -> Vec<Effect> {
    if model.is_computing() {
        model.tell(Level::Info, "the curve is being computed");
        return Vec::new();
    }
    let Some(curve) = model.curve.clone() else {
        // It was given up before, so it is requested again.
        model.tell(Level::Info, "the curve is being computed");
        return vec![want_curve(model)];
    };
    if !model.shows_its_curve() {
        let reason = model.curve_error.as_ref().map(|error| error.text().to_owned());
        return model.refuse(reason.unwrap_or_else(of_before));
    }
    let control = curve.case.control;
    let moves = action.begins() || matches!(action, Action::Solve { .. });
    let node = model.history.current();
    if !moves {
        if let Err(why) = goes_on(model) {
            return model.refuse(why);
        }
        let is_stale = |node: &Node| !model.is_on_curve(node) && matches!(node.kind, NodeKind::Stale(_));
        if node.is_some_and(is_stale) {
            let text = format!("this state is not solved for the current values: {}", back_or_anew());
            return model.refuse(text);
        }
    }
    let at = node.map_or(At::Nothing, |node| node.at(control));
    let from = node.map(|node| node.point.clone());
    let on_path = node.and_then(|node| node.on_path);
    if curve.along.is_some() && matches!(action, Action::Steps(_)) && model.can_jump() {
        return model.refuse(format!("the path goes on after the jump: {} lets it happen", Id::Jump.named()));
    }
    let runs_inward = node.is_none_or(|node| model.runs_inward(node));
    let id = model.number();
    let wanted = if let Action::Steps(count) = action { Some(count) } else { None };
    let solves = matches!(action, Action::Solve { .. });
    model.walking =
        Some(Walking { id, made: 0, wanted, solves, instead_of: None, paced: false, stops: false });
    let inward = if action == Action::Jump { runs_inward } else { model.inward };
    let length = model.length;
    model.journal.walks(action.clone(), Arc::clone(&curve), model.inward, length);
    vec![Effect::Walk(Box::new(Request {
        id,
        action,
        curve,
        from,
        on_path,
        at,
        control,
        inward,
        length,
        pace: None,
    }))]
}

/// A step by a key that has been held for this many steps; at a limit point or a touch it must be pressed again.
pub(super) fn step(model: &mut Model, held: usize) -> Vec<Effect> {
    let at = model.walker().zip(model.control()).map(|(node, control)| node.at(control));
    let stays = held > 0 && at.is_some_and(|at| at != At::Nothing);
    if stays { Vec::new() } else { walk(model, Action::Steps(1)) }
}

/// Goes on to the next event of the path: what is pending happens, and where the path ends outward, it turns round.
pub(in crate::explorer) fn next_event(model: &mut Model) -> Vec<Effect> {
    if model.can_jump() {
        return walk(model, Action::Jump);
    }
    if !model.inward && model.is_at_outer_end() {
        if model.preset.path.begin == Begin::Disc {
            model.tell(
                Level::Info,
                format!(
                    "the path begins here: {} turns round, {} goes on outward",
                    Id::Reverse.named(),
                    Id::Step.named()
                ),
            );
            return Vec::new();
        }
        model.inward = true;
    }
    let end = (!model.inward).then(|| model.outer_end()).flatten();
    walk(model, Action::ToEvent(end))
}

/// The same, at the pace.
pub(super) fn run(model: &mut Model, action: Action) -> Vec<Effect> {
    let mut effects = walk(model, action);
    for effect in &mut effects {
        if let Effect::Walk(request) = effect {
            request.pace = Some(model.pace);
            model.walking = model.walking.map(|walking| Walking { paced: true, ..walking });
        }
    }
    effects
}

/// A run to the next limit point; if a run is under way, ends it.
pub(in crate::explorer) fn run_or_stop(model: &mut Model) -> Vec<Effect> {
    if model.walking.is_some() { stop(model) } else { run(model, Action::ToLimit) }
}

/// The contact radius of a walker that is stable in one disc, in the user's units.
fn stood_stable(model: &Model) -> Option<f64> {
    let node = model.history.current()?;
    let is_within = node.stability.under(node.control) && node.kind != NodeKind::Limit && !node.has_rings();
    is_within.then(|| node.state.contact_radius * node.setting.units().length)
}

/// Reports when a walker that was stable at `before` now stands, for other values, on another stable part of the curve.
fn tell_of_fold(model: &mut Model, before: f64) {
    let (Some(curve), Some(after)) = (&model.curve, stood_stable(model)) else { return };
    let between = |s: f64| (s - before) * (s - after) < 0.0;
    if !curve.shown_limits().iter().any(|limit| between(limit[2])) {
        return;
    }
    let length = |s| with_unit(&model.preset.units, Quantity::Length, s, false, |s| significant(s, 4));
    let text = format!(
        "now on the next stable part, s {} instead of {}: the walker's own part of the curve has no such state",
        length(after),
        length(before)
    );
    // What was said about the values comes first; an error that occurred meanwhile stays.
    let said = match &model.message {
        Some((level, _)) if level.is_bad() => return,
        said => said.as_ref().map(|(_, said)| said.clone()),
    };
    model.tell(Level::Info, said.into_iter().chain([text]).collect::<Vec<_>>().join("; "));
}

/// Sets another pace, also for the run under way.
pub(in crate::explorer) fn scale_pace(model: &mut Model, by: f64) -> Vec<Effect> {
    let pace = (model.pace * by).clamp(*PACES.start(), *PACES.end());
    if pace.total_cmp(&model.pace).is_eq() {
        let word = if by < 1.0 { "slowest" } else { "fastest" };
        model.tell(Level::Info, format!("{} states a second is the {word}", short(pace, 3)));
    } else if !model.is_running() {
        model.tell(Level::Info, format!("runs at {} states a second", short(pace, 3)));
    }
    model.pace = pace;
    vec![Effect::Pace(pace)]
}

/// Accepts the states that a walk made, and its end. `None`: the waiting commands may go on.
pub(super) fn walked(
    model: &mut Model,
    id: u64,
    made: Vec<Node>,
    outcome: Option<WalkOutcome>,
) -> Option<Vec<Effect>> {
    let Some(walking) = model.walking.as_mut().filter(|walking| walking.id == id) else {
        return Some(Vec::new());
    };
    walking.made += made.len();
    let (stepped, solves, instead_of) = (walking.wanted.is_some(), walking.solves, walking.instead_of);
    if !solves && !made.is_empty() {
        model.undo.walked();
    }
    let numbering = model.history.numbering();
    let before = solves.then(|| stood_stable(model)).flatten();
    for state in made {
        append(model, state);
    }
    if let Some(before) = before {
        tell_of_fold(model, before);
    }
    model.history.shorten(&model.undo.nodes());
    if numbering == 0 && model.history.numbering() > 0 {
        model.tell(Level::Info, "a long walk: only every second plain step far back is kept");
    }
    let Some(outcome) = outcome else { return Some(Vec::new()) };
    model.walking = None;
    let is_unsolved = matches!(outcome, WalkOutcome::Stopped(_))
        && model.history.current().is_some_and(|node| !model.is_on_curve(node));
    if let WalkOutcome::Stopped(reason) = &outcome
        && is_unsolved
    {
        mark_stale(model, id, reason);
    }
    model.journal.ended(&outcome);
    let is_there = matches!(outcome, WalkOutcome::Done | WalkOutcome::AtLimit);
    tell_of_end(model, outcome, stepped);
    if let Some(number) = instead_of.filter(|_| is_there) {
        tell_of_present(model, number);
    }
    // The problem may have changed while the walk ran.
    let outdated = model
        .history
        .current()
        .filter(|node| {
            !model.is_on_curve(node) && !matches!(node.kind, NodeKind::Stale(_)) && !node.is_apart()
        })
        .and_then(|_| Action::solve(&model.history, model.preset.path.begin));
    if let (Some(again), false) = (outdated, model.is_computing()) {
        return Some(walk(model, again));
    }
    None
}

/// Says where a walker stands that was sent to a state of the pinned curve with this number.
fn tell_of_present(model: &mut Model, number: usize) {
    let Some(node) = model.walker() else { return };
    let preset = &node.setting.preset;
    let state = node.seen();
    let shown = |quantity, x| with_unit(&preset.units, quantity, x, false, |x| significant(x, 5));
    let force = model.force_in_words(preset, state.force, 5);
    let text = format!(
        "now on the present curve, not on pin {}: s {}, P {force}, δ {}",
        letter(number),
        shown(Quantity::Length, state.contact_radius),
        shown(Quantity::Length, state.approach)
    );
    model.tell(Level::Info, text);
}

/// Says how a walk ended, and does what follows from it; `stepped` if it was of steps.
fn tell_of_end(model: &mut Model, outcome: WalkOutcome, stepped: bool) {
    match outcome {
        WalkOutcome::Done => {}
        WalkOutcome::AtLimit => {
            // A held key stops at the limit point; pressing it again continues.
            while stepped && model.queue.front().is_some_and(|command| command.id() == Id::Step) {
                model.queue.pop_front();
            }
        }
        // What is waiting was requested after the pause, since a pause empties the queue.
        WalkOutcome::Paused => {
            // Otherwise another value ended it, and its curve will be reported.
            if !model.is_computing() {
                let [step, run] = [Id::Step, Id::Run].map(Id::named);
                model.tell(Level::Info, format!("paused; {step} steps, {run} runs on"));
            }
        }
        WalkOutcome::Ended(reason) => model.tell(Level::Info, reason),
        WalkOutcome::Stopped(reason) if model.history.current().is_none() => {
            model.inward = true;
            if let Some(curve) = model.curve.clone() {
                begin_with_disc(model, &curve);
            }
            model.tell(
                Level::Failure,
                format!("there is no first touch: {reason}; the walk begins with the disc"),
            );
        }
        WalkOutcome::Stopped(reason) => {
            let is_stale =
                model.history.current().is_some_and(|node| matches!(node.kind, NodeKind::Stale(_)));
            let again =
                if is_stale { format!("; {} starts again", Id::Restart.named()) } else { String::new() };
            // What the new values have to say, such as a fit, comes first.
            match model.message.take() {
                Some((level, said)) if is_stale => model.tell(level, format!("{said}; {reason}{again}")),
                _ => model.tell(Level::Failure, format!("{reason}{again}")),
            }
        }
    }
}

fn append(model: &mut Model, made: Node) {
    let current = model.history.current();
    let again = current.is_some_and(|node| matches!(node.kind, NodeKind::Solved | NodeKind::Stale(_)));
    let beside = made.kind == NodeKind::Solved && again;
    // Continuing the same change is not another step.
    let step = current.map_or(0, |node| node.step + usize::from(!beside));
    let on_path = on_path_inward(model, made.on_path);
    if let Some(inward) = on_path {
        model.inward = inward;
    }
    let trace = model.journal.made(on_path);
    let node = Node { step: if made.begins { 0 } else { step }, trace, ..made };
    // Turning a knob further is one change: the states in between are kept, but undo goes back before all of them.
    if beside { model.history.push_beside(node) } else { model.history.push(node) }
}

/// The direction of the path at one of its states.
fn on_path_inward(model: &Model, at: Option<usize>) -> Option<bool> {
    let path = model.curve.as_ref()?.along.as_ref()?.as_ref().ok()?;
    Some(path.states.get(at?)?.direction == Direction::Unloading)
}

/// A state that could not be solved for the new values stays, marked with the reason.
fn mark_stale(model: &mut Model, request: u64, reason: &str) {
    let Some(node) = model.history.current().cloned() else { return };
    let again = matches!(node.kind, NodeKind::Stale(_) | NodeKind::Solved);
    let step = node.step + usize::from(!again);
    let kind = NodeKind::Stale(reason.to_owned());
    let trace = model.journal.unsolved();
    let stale = Node { kind, step, begins: false, request, trace, ..node };
    if again { model.history.push_beside(stale) } else { model.history.push(stale) }
}

/// Whether `node` is where the path begins.
fn has_begun(model: &Model, node: &Node) -> bool {
    let begin = model.preset.path.begin;
    let is_start = match node.kind {
        NodeKind::Start => true,
        NodeKind::Moved => begin == Begin::Disc && model.is_at_start(),
        _ => false,
    };
    // Where the bodies touch first depends on the control.
    let is_under = begin == Begin::Disc || model.control() == Some(node.control);
    is_start && is_under && node.begins && node.setting.preset.path.begin == begin && model.is_on_curve(node)
}

/// Back to where the walk begins; without a curve, the curve is requested again.
pub(in crate::explorer) fn restart(model: &mut Model) -> Vec<Effect> {
    model.inward = true;
    if !model.is_computing() && !model.shows_its_curve() {
        // It was given up or failed before, so it is requested again.
        return vec![want_curve(model)];
    }
    let begin = model.preset.path.begin;
    model.inward = begin == Begin::Disc;
    if model.history.current().is_some_and(|node| has_begun(model, node)) {
        return Vec::new();
    }
    let action = model.curve.as_deref().map(|curve| Action::beginning(begin, curve));
    action.map_or_else(Vec::new, |action| walk(model, action))
}

pub(in crate::explorer) fn scale_length(model: &mut Model, by: f64) {
    model.length = (model.length * by).clamp(*LENGTHS.start(), *LENGTHS.end());
}

/// Turns the walk round; no state is made.
pub(in crate::explorer) fn turn_round(model: &mut Model) {
    model.inward = !model.inward;
    // What is said of a stable state has the direction; of an unstable one, it says where the edge would run.
    if model.walker().zip(model.control()).is_none_or(|(node, control)| node.stability.under(control)) {
        return;
    }
    let way = if model.inward { "inward" } else { "outward" };
    let (step, undo) = (Id::Step.named(), Id::Undo.named());
    model.tell(Level::Info, format!("turned round: {step} goes {way} now; {undo} takes steps back"));
}

/// Ends the walk under way, without waiting for what it might still make.
pub(super) fn abandon(model: &mut Model) -> Vec<Effect> {
    let effects = stop_walk(model);
    model.walking = None;
    model.journal.abandoned();
    effects
}

/// The first state of the walk: the start of the curve, or the landing after the first touch. `None`: the waiting
/// commands may go on.
pub(super) fn begin_walk(model: &mut Model, curve: &Arc<CurveData>) -> Option<Vec<Effect>> {
    let preset = &curve.setting.preset;
    let apart = preset.path.begin == Begin::Apart;
    let (source, preset) = (model.source.clone(), preset.clone());
    let along = curve.along.is_some();
    let effects = (apart || along).then(|| {
        model.inward = !apart;
        walk(model, Action::Begin)
    });
    model.journal.begin(source, preset);
    if !apart && !along {
        begin_with_disc(model, curve);
    }
    effects
}

/// The first state of the walk: the start of the curve.
fn begin_with_disc(model: &mut Model, curve: &Arc<CurveData>) {
    let drawn = &curve.base.curve;
    let Some(point) = drawn.equilibrium.explicit(drawn.outermost()) else { return };
    let (Some(stiffness), Some(admissibility)) = (curve.base.stiffness, curve.base.start) else { return };
    let state = curve.base.curve.equilibrium.state(&point);
    let trace = model.journal.made(Some(true));
    let control = curve.case.control;
    model.history.push(Node {
        parent: None,
        kind: NodeKind::Start,
        setting: Arc::clone(&curve.setting),
        control,
        stability: drawn.equilibrium.stability(&point),
        point,
        state,
        step: 0,
        stiffness,
        ahead: None,
        admissibility,
        digits: curve.base.digits,
        from_exact: from_exact(&curve.case, &state),
        on_path: None,
        begins: true,
        request: 0,
        trace,
    });
}
