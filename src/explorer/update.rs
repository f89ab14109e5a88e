//! The only code that changes the model. It never solves, never reads a file and never waits.
//!
//! | file | what lives there |
//! |---|---|
//! | `update.rs` | hands commands and replies to the code for each; selecting |
//! | `curve` | what follows from a new curve |
//! | `walk` | steps, runs, jumps |
//! | `selection` | panels, and the line selected in each |
//! | `turns` | what waits for what, and what undo can take back |
//! | `places` | the walker sent to a radius, an event, the largest pull |
//! | `travel` | undo, redo, branches |
//! | `values` | parameters changed |
//! | `files` | opening, saving and exporting |

mod curve;
pub(super) mod files;
pub(super) mod places;
pub(super) mod selection;
pub(super) mod travel;
mod turns;
pub(super) mod values;
pub(super) mod walk;

use super::backgrounds::{kind_of, want_all};
use super::command::{Command, Id, LENGTHS};
use super::effect::{Effect, Reply};
use super::job::{Done, Job};
use super::model::{Awaits, Model};
use super::requests::{browse, file, want_curve};
use super::table::{Waits, is_available, row_of, why_unavailable};
use super::view::ScreenPanel;
use super::walk::Action;
use super::{look, reach};
use crate::store::{Loaded, Overwrite};
use curve::curve_came;
use files::{export, file_done, save, save_as};
use places::{go_to_event, move_to, select_event};
use selection::{pick, study};
use travel::{go_to, travel};
use turns::{enqueue, gesture, is_blocked, recorded, waits};
use values::{assign, set, try_out, turn, untry};
use walk::{run, step, walk, walked};

/// Begins a session on a preset: requests its curve.
pub fn open(loaded: Loaded) -> (Model, Vec<Effect>) {
    let mut model = Model::new(loaded);
    let effect = want_curve(&mut model);
    (model, vec![effect])
}

/// Applies a command to the model, and returns the work it requests.
///
/// Commands that change the walk or the values are done in the order in which they came: each waits for the walk under
/// way, for the curve if it needs one, and for those already waiting. So keys that arrive late and together over a slow
/// line mean what they would mean one by one.
pub fn update(model: &mut Model, command: Command) -> Vec<Effect> {
    // The list shows the whole of the last message.
    if command.id() != Id::CommandLine {
        model.message = None;
    }
    if waits(&command) > Waits::Nothing && (!model.queue.is_empty() || is_blocked(model, &command)) {
        return enqueue(model, command);
    }
    let mut effects = allowed(model, command);
    effects.extend(want_all(model));
    effects
}

/// Does what is allowed now, and refuses the rest with the reason. What it changed can be undone.
fn allowed(model: &mut Model, command: Command) -> Vec<Effect> {
    // The tree decides which states there are, not undo.
    if !matches!(command, Command::GoTo { .. }) && !is_available(model, command.id()) {
        return model.refuse(why_unavailable(model, command.id()));
    }
    let is_travel = matches!(command, Command::Plain(Id::Undo | Id::Redo) | Command::Travel { .. });
    if is_travel || waits(&command) == Waits::Nothing && command != Id::Edit.into() {
        return obey(model, command);
    }
    let gesture = gesture(model, &command);
    recorded(model, gesture, |model| obey(model, command))
}

/// Accepts the outcome of a job on files.
fn file_came(model: &mut Model, done: Done) -> Vec<Effect> {
    if matches!(
        done,
        Done::Opened(_) | Done::Read(_) | Done::Assigned(..) | Done::Foreign(..) | Done::Failed(_)
    ) {
        model.awaits = Awaits::Nothing;
    }
    // A save does not change the session.
    if matches!(done, Done::Saved { .. }) {
        return file_done(model, done);
    }
    recorded(model, None, |model| file_done(model, done))
}

/// Runs the waiting commands in order, until one of them has to wait again.
fn go_on(model: &mut Model) -> Vec<Effect> {
    let mut effects = Vec::new();
    while model.queue.front().is_some_and(|command| !is_blocked(model, command)) {
        let Some(command) = model.queue.pop_front() else { break };
        effects.extend(allowed(model, command));
    }
    effects
}

fn obey(model: &mut Model, command: Command) -> Vec<Effect> {
    match command {
        Command::Plain(Id::Edit) => return select(model),
        Command::Plain(id) => return row_of(id).does(model),
        Command::Steps(count) => return walk(model, Action::Steps(count)),
        Command::HeldStep(before) => return step(model, before),
        Command::RunOf(count) => return run(model, Action::Run(count)),
        Command::StepLength(length) => model.length = length.clamp(*LENGTHS.start(), *LENGTHS.end()),
        Command::SelectEvent(number) => return select_event(model, number),
        Command::Assign(assignments) => return assign(model, assignments),
        Command::Set { key, text } => return set(model, &key, &text),
        Command::Try { key, text } => return try_out(model, &key, &text),
        Command::TakeBack => return untry(model),
        Command::Browse { key, folder } => return vec![browse(model, key, folder)],
        Command::Pick { panel, line } => pick(model, panel, line),
        Command::MoveTo(radius) => return move_to(model, radius),
        Command::Zoom { view, closer, about } => look::zoom(model, view, closer, about),
        Command::Show(view) => reach::show(model, view),
        Command::Go(home) => reach::go(model, home),
        Command::Study { column, over } => return study(model, column, over),
        Command::Overlay(overlay) => look::overlay(model, overlay),
        Command::Map { x, y } => look::map_of(model, &x, y.as_ref()),
        Command::GoTo { node, numbering } => return go_to(model, node, numbering),
        Command::Travel { id, count } => return travel(model, id, count),
        Command::Turn { id, key } => return turn(model, id, Some(&key)),
        Command::Unpin(number) => look::unpin(model, number),
        Command::Open(name) => return vec![file(Job::Open { name, assignments: Vec::new() })],
        Command::OpenWith { name, assignments } => return vec![file(Job::Open { name, assignments })],
        Command::Delete(name) => return vec![file(Job::Delete(name))],
        Command::SaveAs { name, replace, with_data } => return save_as(model, name, replace, with_data),
        Command::SaveAnyway => return save(model, Overwrite::Always),
        Command::Export { what, path, replace } => return export(model, what, path, replace),
    }
    Vec::new()
}

/// Applies a reply to the model, and returns what follows from it.
pub fn answer(model: &mut Model, reply: Reply) -> Vec<Effect> {
    let mut effects = match reply {
        Reply::Curve { id, result } => curve_came(model, id, result).unwrap_or_default(),
        Reply::Stage { id, stage } => {
            if id == model.curve_wanted && model.is_computing() {
                model.stage = Some(stage);
            }
            return Vec::new();
        }
        Reply::Walked { id, made, outcome } => walked(model, id, made, outcome).unwrap_or_default(),
        Reply::Found(found) => match kind_of(found.name) {
            Some(kind) if kind.changes_values => recorded(model, None, |model| (kind.keep)(model, found)),
            Some(kind) => (kind.keep)(model, found),
            None => Vec::new(),
        },
        Reply::SessionSaved(result) => {
            model.kept = result;
            model.refuse(match &model.kept {
                Ok(()) => "session saving works again".to_owned(),
                Err(why) => format!("the session is not being saved: {why}"),
            })
        }
        Reply::File(done) => file_came(model, *done),
    };
    effects.extend(go_on(model));
    effects.extend(want_all(model));
    effects
}

/// Enter on an event.
fn select(model: &mut Model) -> Vec<Effect> {
    match model.panel {
        // It was chosen in the list of a curve that is about to go, or in the middle of a walk.
        ScreenPanel::Log if model.is_busy() => {
            let number = model.log().entries.get(model.event).and_then(|entry| entry.number);
            number.map_or_else(Vec::new, |number| update(model, Command::SelectEvent(number)))
        }
        ScreenPanel::Log => go_to_event(model),
        ScreenPanel::Charts if model.view.is_table() => go_to_line(model),
        _ => Vec::new(),
    }
}

/// The walker goes to the selected state of the table of states.
fn go_to_line(model: &mut Model) -> Vec<Effect> {
    let line = reach::walk_line(model);
    let state = model.history.path().get(line).map(|(node, _)| *node);
    let numbering = model.history.numbering();
    // As a command of its own, so that it waits for its turn and can be undone.
    state.map_or_else(Vec::new, |node| update(model, Command::GoTo { node, numbering }))
}
