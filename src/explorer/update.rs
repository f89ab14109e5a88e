//! The only code that changes the model. It never solves, never reads a file and never waits.

use super::command::{Command, Id, row_of};
use super::curve::CurveData;
use super::driver::{Effect, Reply};
use super::files::{Document, Done, Job};
use super::history::{Node, NodeKind};
use super::model::{Axes, Chart, EventSource, LENGTHS, Level, Model, Panel, Question};
use super::nudge::{Amount, next_control, nudge};
use super::walk::{Action, Made, Outcome, Request};
use crate::preset::{Loaded, Overwrite, Preset, Source};
use crate::quasistatic::EventKind;
use crate::report::number::{loss, significant};
use crate::report::unload::control_name;
use std::sync::Arc;

/// Walks waiting behind the one that runs; more key presses than these are a held key.
const QUEUE: usize = 1000;

/// Begins a session on a preset: its curve is asked for.
pub fn open(loaded: Loaded) -> (Model, Vec<Effect>) {
    let mut model = Model::new(loaded);
    let effect = want_curve(&mut model);
    (model, vec![effect])
}

/// What a command does to the model, and what it wants done.
pub fn update(model: &mut Model, command: Command) -> Vec<Effect> {
    let row = row_of(command.id());
    if !(row.enabled)(model) {
        tell(model, Level::Error, unavailable(model, command.id()));
        return Vec::new();
    }
    model.message = None;
    match command {
        Command::Plain(id) => plain(model, id),
        Command::Steps(count) => walk(model, Action::Steps(count)),
        Command::Set { key, text } => set(model, key, &text),
        Command::Open(name) => vec![file(Job::Open(name))],
        Command::SaveAs { name, replace } => {
            let preset = Box::new(model.preset.clone());
            vec![file(Job::SaveAs { name, preset, replace })]
        }
        Command::SaveAnyway => save(model, Overwrite::Always),
        Command::Export { what, path, replace } => export(model, what, path, replace),
    }
}

/// What a reply does to the model, and what follows from it.
pub fn answer(model: &mut Model, reply: Reply) -> Vec<Effect> {
    match reply {
        Reply::Curve { id, result } => curve_came(model, id, result),
        Reply::Walked { id, made, outcome } => walked(model, id, made, outcome),
        Reply::File(done) => file_done(model, *done),
    }
}

fn plain(model: &mut Model, id: Id) -> Vec<Effect> {
    match id {
        Id::Step => return walk(model, Action::Steps(1)),
        Id::NextLimit => return walk(model, Action::ToLimit),
        Id::PreviousLimit => {
            model.inward = !model.inward;
            return walk(model, Action::ToLimit);
        }
        Id::Jump => return walk(model, Action::Jump),
        Id::Run => return if model.walking.is_some() { stop(model) } else { walk(model, Action::ToLimit) },
        Id::Restart => return restart(model),
        Id::Reverse => model.inward = !model.inward,
        Id::Halve => scale_length(model, 0.5),
        Id::Double => scale_length(model, 2.0),
        Id::Undo if model.is_ahead() => return take_back(model),
        Id::Undo => return travel(model, super::History::undo),
        Id::Redo => return travel(model, super::History::redo),
        Id::Control => return change_control(model),
        Id::Less => return turn(model, false, Amount::Fine),
        Id::More => return turn(model, true, Amount::Fine),
        Id::MuchLess => return turn(model, false, Amount::Coarse),
        Id::MuchMore => return turn(model, true, Amount::Coarse),
        Id::Edit => return select(model),
        Id::Up => move_selection(model, false),
        Id::Down => move_selection(model, true),
        Id::NextPanel => next_panel(model, 1),
        Id::PreviousPanel => next_panel(model, Panel::ALL.len() - 1),
        Id::SwitchChart => {
            model.chart =
                if model.chart == Chart::ForceApproach { Chart::RadiusForce } else { Chart::ForceApproach };
        }
        Id::Axes => model.axes = if model.axes == Axes::Reduced { Axes::Raw } else { Axes::Reduced },
        Id::Events => {
            model.events =
                if model.events == EventSource::Curve { EventSource::Walked } else { EventSource::Curve };
            model.event = 0;
        }
        Id::Smooth => model.smooth = !model.smooth,
        Id::Open => return vec![file(Job::List)],
        Id::Save => return save_back(model),
        Id::Cancel => return if model.walking.is_some() { stop(model) } else { Vec::new() },
        Id::Quit => model.quit = true,
        // These need an argument, which the terminal asks for; or concern only what it shows.
        Id::SaveAs | Id::Export | Id::Help => {}
    }
    Vec::new()
}

fn tell(model: &mut Model, level: Level, text: impl Into<String>) {
    model.message = Some((level, text.into()));
}

fn number(model: &mut Model) -> u64 {
    let number = model.next_request;
    model.next_request += 1;
    number
}

fn file(job: Job) -> Effect {
    Effect::File(Box::new(job))
}

// ---- the background curve ----

fn want_curve(model: &mut Model) -> Effect {
    let id = number(model);
    model.curve_wanted = id;
    Effect::Curve { id, preset: Box::new(model.preset.clone()) }
}

fn curve_came(model: &mut Model, id: u64, result: Result<Arc<CurveData>, String>) -> Vec<Effect> {
    if id <= model.curve_shown {
        return Vec::new();
    }
    model.curve_shown = id;
    match result {
        Err(reason) => {
            tell(model, Level::Error, format!("no curve for these values: {reason}"));
            model.curve_error = Some(reason);
            Vec::new()
        }
        Ok(curve) => {
            model.curve_error = None;
            let first = model.history.current().is_none();
            model.curve = Some(Arc::clone(&curve));
            model.event = model.event.min(model.shown_events().len().saturating_sub(1));
            if first {
                begin_walk(model, &curve);
                return Vec::new();
            }
            let Some(node) = model.history.current() else { return Vec::new() };
            if model.is_on_curve(node) || node.is_apart() || model.walking.is_some() {
                return Vec::new();
            }
            let state = node.state.in_units(node.setting.case.units());
            walk(model, Action::Solve { state })
        }
    }
}

fn begin_walk(model: &mut Model, curve: &Arc<CurveData>) {
    let Some(point) = curve.curve.branch.points.first().cloned() else { return };
    let state = curve.setting.equilibrium.state(&point);
    let control = curve.setting.case.control;
    model.history.push(Node {
        parent: None,
        kind: NodeKind::Start,
        setting: Arc::clone(&curve.setting),
        control,
        point,
        state,
        step: 0,
        digits: curve.digits,
        from_exact: super::walk::from_exact(&curve.setting.case, &state),
        begins: true,
    });
}

// ---- the walk ----

fn walk(model: &mut Model, action: Action) -> Vec<Effect> {
    if model.walking.is_some() {
        if model.queue.len() < QUEUE {
            model.queue.push_back(action);
        }
        return Vec::new();
    }
    let Some(curve) = model.curve.clone() else {
        tell(model, Level::Info, "the curve is being computed");
        return Vec::new();
    };
    let control = curve.setting.case.control;
    let moves = matches!(action, Action::MoveTo(_) | Action::MoveToLimit(_) | Action::Solve { .. });
    let node = model.history.current();
    if !moves {
        if node.is_some_and(Node::is_apart) {
            tell(model, Level::Error, "the bodies are apart: u goes back, 0 restarts");
            return Vec::new();
        }
        if let Some(node) = node.filter(|node| !model.is_on_curve(node)) {
            if model.is_computing() {
                tell(model, Level::Info, "the curve is being computed");
                return Vec::new();
            }
            let stale = matches!(node.kind, NodeKind::Stale(_));
            if stale {
                tell(
                    model,
                    Level::Error,
                    "this state is not solved for the values as they are: u goes back, 0 restarts",
                );
                return Vec::new();
            }
        }
    }
    let on_limit = node.is_some_and(|node| node.is_limit(control));
    let from = node.map(|node| node.point.clone());
    let begins = node.is_some_and(|node| node.begins && !node.is_limit(control));
    let id = number(model);
    model.walking = Some(id);
    // From an unstable start the edge runs outward, as at the beginning of an unloading.
    let inward = model.inward && !(begins && action == Action::Jump);
    let length = model.length;
    vec![Effect::Walk(Box::new(Request { id, action, curve, from, on_limit, control, inward, length }))]
}

fn walked(model: &mut Model, id: u64, made: Vec<Made>, outcome: Option<Outcome>) -> Vec<Effect> {
    if model.walking != Some(id) {
        return Vec::new();
    }
    let Some(curve) = model.curve.clone() else { return Vec::new() };
    for state in made {
        append(model, &curve, state);
    }
    let Some(outcome) = outcome else { return Vec::new() };
    model.walking = None;
    match outcome {
        Outcome::Done => {}
        Outcome::AtLimit => {
            // A held key stops at the limit point; pressing it again goes on.
            model.queue.retain(|action| !matches!(action, Action::Steps(_)));
        }
        Outcome::Stopped(reason) => {
            model.queue.clear();
            let unsolved = model.history.current().is_some_and(|node| !model.is_on_curve(node));
            if unsolved {
                mark_stale(model, &reason);
            }
            tell(model, Level::Error, reason);
        }
    }
    // The problem may have changed while the walk ran.
    let outdated = model
        .history
        .current()
        .filter(|node| {
            !model.is_on_curve(node) && !matches!(node.kind, NodeKind::Stale(_)) && !node.is_apart()
        })
        .map(|node| node.state.in_units(node.setting.case.units()));
    if let (Some(state), false) = (outdated, model.is_computing()) {
        model.queue.clear();
        return walk(model, Action::Solve { state });
    }
    match model.queue.pop_front() {
        Some(next) => walk(model, next),
        None => Vec::new(),
    }
}

fn append(model: &mut Model, curve: &Arc<CurveData>, state: Made) {
    let step = model.history.current().map_or(0, |node| node.step + 1);
    let step = if state.begins { 0 } else { step };
    let solved = state.kind == NodeKind::Solved;
    let again = model
        .history
        .current()
        .is_some_and(|node| matches!(node.kind, NodeKind::Solved | NodeKind::Stale(_)));
    let node = Node {
        parent: None,
        kind: state.kind,
        setting: Arc::clone(&curve.setting),
        control: curve.setting.case.control,
        point: state.point,
        state: state.state,
        step,
        digits: state.digits,
        from_exact: state.from_exact,
        begins: state.begins,
    };
    // A knob turned further is one change: the states in between are kept, but undo leads before them.
    if solved && again { model.history.push_beside(node) } else { model.history.push(node) }
}

/// A state that could not be solved for the new values stays, marked, with the reason.
fn mark_stale(model: &mut Model, reason: &str) {
    let Some(node) = model.history.current().cloned() else { return };
    let again = matches!(node.kind, NodeKind::Stale(_) | NodeKind::Solved);
    let stale = Node { kind: NodeKind::Stale(reason.to_owned()), step: node.step + 1, begins: false, ..node };
    if again { model.history.push_beside(stale) } else { model.history.push(stale) }
}

fn stop(model: &mut Model) -> Vec<Effect> {
    model.queue.clear();
    model.walking.map(Effect::StopWalk).into_iter().collect()
}

fn restart(model: &mut Model) -> Vec<Effect> {
    model.queue.clear();
    model.inward = true;
    let start = model.curve.as_ref().map(|curve| curve.setting.case.start);
    start.map_or_else(Vec::new, |s| walk(model, Action::MoveTo(s)))
}

fn scale_length(model: &mut Model, by: f64) {
    model.length = (model.length * by).clamp(*LENGTHS.start(), *LENGTHS.end());
}

/// Undo and redo: the parameters of the node come back with it.
fn travel(model: &mut Model, go: fn(&mut super::History) -> bool) -> Vec<Effect> {
    let mut effects = stop(model);
    model.walking = None;
    if go(&mut model.history) {
        effects.extend(adopt_parameters(model));
    }
    effects
}

/// The parameters of the walker's state, where the curve on the screen has others.
fn adopt_parameters(model: &mut Model) -> Vec<Effect> {
    let Some(node) = model.history.current() else { return Vec::new() };
    if model.is_on_curve(node) || matches!(node.kind, NodeKind::Stale(_)) {
        return Vec::new();
    }
    take_back(model)
}

/// The parameters of the walker's state instead of those typed since.
fn take_back(model: &mut Model) -> Vec<Effect> {
    let Some(node) = model.history.current() else { return Vec::new() };
    let mut preset = node.setting.preset.clone();
    preset.title.clone_from(&model.preset.title);
    preset.path.control = model.preset.path.control;
    change(model, preset)
}

/// Takes a changed preset and asks for its curve.
fn change(model: &mut Model, preset: Preset) -> Vec<Effect> {
    if preset == model.preset {
        return Vec::new();
    }
    let same_problem = {
        let mut old = model.preset.clone();
        old.title.clone_from(&preset.title);
        old == preset
    };
    model.preset = preset;
    if same_problem {
        return Vec::new();
    }
    let knobs = model.knobs().len();
    model.parameter = model.parameter.min(knobs.saturating_sub(1));
    let mut effects = stop(model);
    effects.push(want_curve(model));
    effects
}

// ---- parameters ----

fn turn(model: &mut Model, up: bool, amount: Amount) -> Vec<Effect> {
    let Some((row, _)) = model.selected_knob() else { return Vec::new() };
    match nudge(&model.preset, row, up, amount) {
        Ok(preset) => change(model, preset),
        Err(reason) => {
            tell(model, Level::Error, reason);
            Vec::new()
        }
    }
}

fn set(model: &mut Model, key: &'static str, text: &str) -> Vec<Effect> {
    let Some(row) = crate::preset::parameter(key) else { return Vec::new() };
    let mut preset = model.preset.clone();
    let result = row.parse(text).and_then(|value| preset.set(key, value));
    match result {
        Ok(()) => change(model, preset),
        Err(invalid) => {
            tell(model, Level::Error, invalid.to_string());
            Vec::new()
        }
    }
}

fn change_control(model: &mut Model) -> Vec<Effect> {
    let mut preset = model.preset.clone();
    preset.path.control = next_control(&model.preset, preset.path.control, true);
    change(model, preset)
}

// ---- selecting ----

fn next_panel(model: &mut Model, by: usize) {
    let at = Panel::ALL.iter().position(|panel| *panel == model.panel).unwrap_or(0);
    model.panel = Panel::ALL[(at + by) % Panel::ALL.len()];
}

fn move_selection(model: &mut Model, down: bool) {
    let moved = |at: usize, count: usize| {
        let last = count.saturating_sub(1);
        if down { (at + 1).min(last) } else { at.saturating_sub(1).min(last) }
    };
    match model.panel {
        Panel::Problem => model.parameter = moved(model.parameter, model.knobs().len()),
        Panel::Events => model.event = moved(model.event, model.shown_events().len()),
        Panel::Walker | Panel::Charts => {}
    }
}

/// Enter on an event: the walker goes to its limit point.
fn select(model: &mut Model) -> Vec<Effect> {
    if model.panel != Panel::Events {
        return Vec::new();
    }
    if model.events == EventSource::Walked {
        let events = model.walked_events();
        let Some((node, _)) = events.get(model.event) else { return Vec::new() };
        let Some(parent) = model.history.nodes().get(*node).and_then(|n| n.parent) else { return Vec::new() };
        // The state before the jump, as it was walked.
        while model.history.cursor() != Some(parent) && model.history.undo() {}
        return adopt_parameters(model);
    }
    let Some(curve) = model.curve.clone() else { return Vec::new() };
    let Ok(unloading) = &curve.unloading else { return Vec::new() };
    let Some(event) = unloading.events.get(model.event) else { return Vec::new() };
    let away = |s: f64| (s - event.before.contact_radius).abs();
    let radius = |i: &usize| curve.curve.equilibrium.contact_radius(&curve.limits[*i].point);
    let nearest = (0..curve.limits.len()).min_by(|a, b| away(radius(a)).total_cmp(&away(radius(b))));
    model.inward = true;
    nearest.map_or_else(Vec::new, |number| walk(model, Action::MoveToLimit(number)))
}

// ---- files ----

fn save_back(model: &mut Model) -> Vec<Effect> {
    if let Source::Shipped(_) = model.source {
        tell(model, Level::Error, "shipped presets are read-only: S saves under a name of your own");
        return Vec::new();
    }
    let overwrite = model.fingerprint.map_or(Overwrite::Never, Overwrite::IfUnchanged);
    save(model, overwrite)
}

fn save(model: &mut Model, overwrite: Overwrite) -> Vec<Effect> {
    let (source, preset) = (model.source.clone(), Box::new(model.preset.clone()));
    vec![file(Job::Save { source, preset, overwrite })]
}

fn export(model: &mut Model, what: Document, path: String, replace: bool) -> Vec<Effect> {
    let Some(curve) = model.curve.clone() else {
        tell(model, Level::Error, "there is no curve to export yet");
        return Vec::new();
    };
    let ending = std::path::Path::new(&path).extension().and_then(|ending| ending.to_str());
    if !ending.is_some_and(|ending| ["csv", "json"].iter().any(|known| known.eq_ignore_ascii_case(ending))) {
        tell(model, Level::Error, "the file must end in .csv or .json");
        return Vec::new();
    }
    let walk = model.history.path().into_iter().map(|(_, node)| node.clone()).collect();
    let events = model.shown_events();
    vec![file(Job::Export { what, curve, walk, events, path, replace })]
}

fn file_done(model: &mut Model, done: Done) -> Vec<Effect> {
    match done {
        Done::Listed(listing) => model.listing = Some(*listing),
        Done::Opened(loaded) => {
            let (mut opened, effects) = open(*loaded);
            // Request numbers go on, so that late replies to the old session are recognised; so do the views.
            opened.next_request = model.next_request + 1;
            opened.curve_shown = model.next_request;
            (opened.axes, opened.smooth, opened.chart) = (model.axes, model.smooth, model.chart);
            (opened.panel, opened.events) = (model.panel, model.events);
            *model = opened;
            drop(effects);
            let effect = want_curve(model);
            return vec![effect];
        }
        Done::Saved { source, fingerprint, preset } => {
            tell(model, Level::Info, format!("saved as {}", source.shown()));
            (model.source, model.fingerprint, model.saved) = (source, Some(fingerprint), *preset);
        }
        Done::Conflict => {
            model.question = Some(Question::SaveAnyway);
            tell(model, Level::Error, "the file was changed by somebody else since it was read: not saved");
        }
        Done::NameTaken(name) => {
            tell(model, Level::Error, format!("a preset called {name} exists: not saved"));
            model.question = Some(Question::ReplacePreset(name));
        }
        Done::Exported(path) => tell(model, Level::Info, format!("exported to {path}")),
        Done::FileExists(what, path) => {
            tell(model, Level::Error, format!("{path} exists: not exported"));
            model.question = Some(Question::ReplaceFile(what, path));
        }
        Done::Failed(reason) => tell(model, Level::Error, reason),
    }
    Vec::new()
}

// ---- words ----

/// Why a command cannot be done now.
fn unavailable(model: &Model, id: Id) -> &'static str {
    let apart = model.history.current().is_some_and(Node::is_apart);
    match id {
        Id::Undo => "this is the start: there is nothing to undo",
        Id::Redo => "there is nothing to redo",
        Id::Jump if apart => "the bodies are apart: u goes back, 0 restarts",
        Id::Jump => "the state is stable: the edge stays; n runs to the next limit point",
        Id::Less | Id::More | Id::MuchLess | Id::MuchMore => {
            "select a parameter first: Tab goes to the Problem panel"
        }
        _ => "the curve is being computed",
    }
}

/// What the state is and which key is next.
pub fn hint(model: &Model) -> String {
    if let Some(error) = &model.curve_error {
        return format!("no curve for these values: {error}");
    }
    let Some(node) = model.history.current() else {
        return "computing the equilibrium curve".to_owned();
    };
    if model.walking.is_some() {
        return "walking; Esc stops".to_owned();
    }
    if let NodeKind::Stale(reason) = &node.kind {
        return format!("not solved: {reason}");
    }
    if model.is_computing() {
        return "computing the curve for the new values".to_owned();
    }
    let Some(control) = model.control() else { return String::new() };
    if let NodeKind::Jump(event) = &node.kind {
        let units = node.setting.case.units();
        let lost = event.dissipated.map(|lost| format!(", lost {}", loss(lost * units.energy)));
        return match event.kind {
            EventKind::PullOff => {
                format!(
                    "Pulled off: the bodies are apart{}. u goes back, 0 restarts",
                    lost.unwrap_or_default()
                )
            }
            EventKind::Snap => {
                format!(
                    "Landed, stable again{}. n runs to the next limit point, u undoes",
                    lost.unwrap_or_default()
                )
            }
        };
    }
    if let Some(at) = model.limit_number() {
        return limit_hint(model, at);
    }
    let way = if model.inward { "inward" } else { "outward" };
    let held = control_name(control);
    if node.is_limit(control) {
        return "Limit point outside the curve: x lets the edge run, Space goes on along it".to_owned();
    }
    match (node.stability().under(control), &node.kind) {
        (true, NodeKind::Start) => {
            format!("Start, stable under {held} control. n runs to a limit point, ? helps")
        }
        (true, NodeKind::Solved) => {
            format!("Solved again at the {held} held, stable. n runs to a limit point")
        }
        (true, _) => format!("Stable under {held} control. Space steps {way}, n runs to a limit point"),
        (false, NodeKind::Start | NodeKind::Moved) => {
            format!("This start is unstable under {held} control: x lets the edge run outward")
        }
        (false, NodeKind::Solved) => {
            format!("Solved again at the {held} held, unstable there: x lets the edge run")
        }
        (false, _) => format!("Unstable under {held} control. x lets the edge run, Space steps {way}"),
    }
}

fn limit_hint(model: &Model, at: usize) -> String {
    let Some(curve) = &model.curve else { return String::new() };
    let count = curve.limits.len();
    let events = curve.unloading.as_ref().ok().map(|u| u.events.as_slice()).unwrap_or_default();
    let s = curve.curve.equilibrium.contact_radius(&curve.limits[at].point);
    let event = events.iter().position(|e| (e.before.contact_radius - s).abs() <= 1e-7 * s);
    let report = event.and_then(|i| curve.report.as_ref()?.events.get(i));
    match report {
        Some(report) => {
            let lands = match (report.after, report.after.and_then(|a| a.wave)) {
                (None, _) => "pulls off".to_owned(),
                (Some(_), Some(wave)) => format!("jumps to crest {wave}"),
                (Some(after), None) => format!("jumps to s {}", significant(after.contact_radius, 4)),
            };
            let lost = report.dissipated.map_or_else(String::new, |lost| format!(" (loses {})", loss(lost)));
            format!("Limit point {}/{count}: x {lands}{lost}, Space goes on unstable", at + 1)
        }
        None => {
            format!("Limit point {}/{count}: x lets the edge run, Space goes on along the curve", at + 1)
        }
    }
}
