//! The only code that changes the model. It never solves, never reads a file and never waits.
//!
//! | file | what lives there |
//! |---|---|
//! | `update.rs` | hands commands and replies to the code for each; selecting |
//! | `curve` | what follows from a new curve |
//! | `walk` | steps, runs, jumps |
//! | `turns` | what waits for what, and what undo can take back |
//! | `places` | the walker sent to a radius, an event, the least force |
//! | `travel` | undo, redo, branches |
//! | `values` | parameters changed |
//! | `files` | opening, saving and exporting |

mod curve;
mod files;
mod places;
mod travel;
mod turns;
mod values;
mod walk;

use super::availability::{is_available, why_unavailable};
use super::command::{Command, Id, LENGTHS};
use super::effect::{Effect, Reply};
use super::fit::{fit, fit_came, mark, want_distances};
use super::job::{Done, Job};
use super::model::{Awaits, Level, Model};
use super::requests::{browse, file, stop, want_check, want_curve, want_loop, want_map, want_study};
use super::view::{Axes, Panel, View};
use super::walk::Action;
use super::{background_jobs, look, reach};
use crate::store::{Loaded, Overwrite};
use curve::{checked, curve_came, give_up};
use files::{export, export_page, file_done, save, save_back};
use places::{go_to_event, move_to, select_event, to_largest_pull};
use pulloff_engine::preset::{Row, Value, groups};
use pulloff_engine::text::{greek, show_name};
use travel::{by_states, go_to, go_to_state, travel};
use turns::{Turn, enqueue, gesture, is_blocked, recorded};
use values::{assign, change_control, set, try_out, turn, untry};
use walk::{next_event, restart, run, scale_length, scale_pace, walk, walked};

/// Begins a session on a preset: its curve is asked for.
pub fn open(loaded: Loaded) -> (Model, Vec<Effect>) {
    let mut model = Model::new(loaded);
    let effect = want_curve(&mut model);
    (model, vec![effect])
}

/// What a command does to the model, and what it wants done.
///
/// What changes the walk or the values is done in the order in which it came: it waits for the walk that runs, for the
/// curve where it needs one, and for what waits already. So keys that come late and together over a slow line mean what
/// they mean one by one.
pub fn update(model: &mut Model, command: Command) -> Vec<Effect> {
    model.message = None;
    let turn = Turn::of(&command);
    if turn > Turn::None && (!model.queue.is_empty() || is_blocked(model, &command)) {
        return enqueue(model, command);
    }
    let mut effects = allowed(model, command);
    effects.extend(look::want_profile(model));
    effects.extend(want_check(model));
    effects.extend(want_loop(model));
    effects.extend(want_map(model));
    effects.extend(want_distances(model));
    effects.extend(want_study(model));
    effects
}

/// Does what is allowed now; what is not is refused with the reason. What it changed can be taken back.
fn allowed(model: &mut Model, command: Command) -> Vec<Effect> {
    // Which states there are says the tree, not undo.
    let by_states = matches!(
        command,
        Command::Travel { states: true, .. } | Command::GoToState(_) | Command::GoTo { .. }
    );
    if !by_states && !is_available(model, command.id()) {
        model.tell(Level::Error, why_unavailable(model, command.id()));
        return Vec::new();
    }
    let is_travel =
        matches!(command, Command::Plain(Id::Undo | Id::Redo) | Command::Travel { states: false, .. });
    if is_travel || Turn::of(&command) == Turn::None && command != Id::Edit.into() {
        return obey(model, command);
    }
    let gesture = gesture(model, &command);
    recorded(model, gesture, |model| obey(model, command))
}

/// Takes what came of a file.
fn file_came(model: &mut Model, done: Done) -> Vec<Effect> {
    if matches!(
        done,
        Done::Opened(_) | Done::Read(_) | Done::Assigned(_) | Done::Foreign(..) | Done::Failed(_)
    ) {
        model.awaits = Awaits::Nothing;
    }
    // What was saved is no change of the session.
    if matches!(done, Done::Saved { .. }) {
        return file_done(model, done);
    }
    recorded(model, None, |model| file_done(model, done))
}

/// Does the commands that waited, in order, until one of them has to wait again.
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
        Command::Plain(id) => plain(model, id),
        Command::Steps(count) => walk(model, Action::Steps(count)),
        Command::RunOf(count) => run(model, Action::Run(count)),
        Command::StepLength(length) => {
            model.length = length.clamp(*LENGTHS.start(), *LENGTHS.end());
            Vec::new()
        }
        Command::SelectEvent(number) => select_event(model, number),
        Command::Assign(assignments) => assign(model, assignments),
        Command::Set { key, text } => set(model, &key, &text),
        Command::Try { key, text } => try_out(model, &key, &text),
        Command::TakeBack => untry(model),
        Command::Browse { key, folder } => vec![browse(model, key, folder)],
        Command::Pick { panel, line } => {
            pick(model, panel, line);
            Vec::new()
        }
        Command::MoveTo(radius) => move_to(model, radius),
        Command::Zoom { view, closer, about } => {
            look::zoom(model, view, closer, about);
            Vec::new()
        }
        Command::Show(view) => {
            reach::show(model, view);
            Vec::new()
        }
        Command::Go(home) => {
            reach::go(model, home);
            Vec::new()
        }
        Command::Study(column) => {
            model.studied = column;
            reach::show(model, View::Study);
            Vec::new()
        }
        Command::Overlay(overlay) => {
            look::overlay(model, overlay);
            Vec::new()
        }
        Command::Map { x, y } => {
            look::map_of(model, &x, y);
            Vec::new()
        }
        Command::GoTo { node, numbering } => go_to(model, node, numbering),
        Command::GoToState(state) => go_to_state(model, state),
        Command::Travel { id, count, states: false } => travel(model, id, count),
        Command::Travel { id, count, states: true } => by_states(model, id, count),
        Command::Turn { id, key } => turn(model, id, Some(&key)),
        Command::Unpin(number) => {
            look::unpin(model, number);
            Vec::new()
        }
        Command::Open(name) => vec![file(Job::Open { name, assignments: Vec::new() })],
        Command::OpenWith { name, assignments } => vec![file(Job::Open { name, assignments })],
        Command::Delete(name) => vec![file(Job::Delete(name))],
        Command::SaveAs { name, replace, with_data } => {
            let preset = Box::new(model.preset.clone());
            vec![file(Job::SaveAs { name, preset, replace, with_data, from: model.source.clone() })]
        }
        Command::SaveAnyway => save(model, Overwrite::Always),
        Command::Export { what, path, replace } => export(model, what, path, replace),
        Command::ExportPage { page, path, replace } => export_page(model, page, path, replace),
        Command::Picture { picture, .. } => {
            model.tell(Level::Error, format!("nothing here draws a {}", picture.name()));
            Vec::new()
        }
    }
}

/// What a reply does to the model, and what follows from it.
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
        Reply::Checked { id, curve, snaps_from } => {
            model.snaps_from = snaps_from.or_else(|| model.snaps_from.take());
            checked(model, id, curve);
            Vec::new()
        }
        Reply::Loop(found) => {
            if model.cycle_wanted.as_ref().is_some_and(|wanted| found.id <= wanted.id) {
                model.cycle = Some(found);
                model.event = model.event.min(model.log_lines().saturating_sub(1));
            }
            Vec::new()
        }
        Reply::Map(found) => {
            if model.map_wanted.as_ref().is_some_and(|wanted| found.id <= wanted.id) {
                model.map = Some(found);
            }
            Vec::new()
        }
        Reply::Fitting { id, percent } => {
            if let Some(fitting) = model.fitting.as_mut().filter(|fitting| fitting.id == id) {
                fitting.percent = percent;
            }
            return Vec::new();
        }
        Reply::Fitted { id, result } => recorded(model, None, |model| fit_came(model, id, result)),
        Reply::Distances(found) => {
            if model.distances_wanted.as_ref().is_some_and(|wanted| found.id <= wanted.id) {
                model.distances = Some(found);
            }
            Vec::new()
        }
        Reply::Study(found) => {
            // What is done of the newest, and of no other.
            if model.study_wanted.as_ref().is_some_and(|wanted| found.wish.id == wanted.id) {
                model.study = Some(found);
            }
            Vec::new()
        }
        Reply::Profile(profile) => {
            look::profile_came(model, profile);
            Vec::new()
        }
        Reply::Notice(text) => {
            model.tell(Level::Error, text);
            Vec::new()
        }
        Reply::Pinned(number, curve) => {
            look::pinned(model, number, curve);
            Vec::new()
        }
        Reply::File(done) => file_came(model, *done),
    };
    effects.extend(go_on(model));
    effects.extend(look::want_profile(model));
    effects.extend(want_check(model));
    effects.extend(want_loop(model));
    effects.extend(want_map(model));
    effects.extend(want_distances(model));
    effects.extend(want_study(model));
    effects
}

fn plain(model: &mut Model, id: Id) -> Vec<Effect> {
    match id {
        Id::Step => return walk(model, Action::Steps(1)),
        Id::NextEvent => return next_event(model),
        Id::Jump => return walk(model, Action::Jump),
        Id::LargestPull => return to_largest_pull(model),
        Id::Run => return if model.walking.is_some() { stop(model) } else { run(model, Action::ToLimit) },
        Id::Slower => return scale_pace(model, 0.5),
        Id::Faster => return scale_pace(model, 2.0),
        Id::Restart => return restart(model),
        Id::Reverse => model.inward = !model.inward,
        Id::Halve => scale_length(model, 0.5),
        Id::Double => scale_length(model, 2.0),
        Id::Undo | Id::Redo => return travel(model, id, 1),
        Id::Control => return change_control(model),
        Id::Free => return mark(model),
        Id::Fit => return fit(model),
        Id::FineLess | Id::FineMore | Id::Less | Id::More | Id::MuchLess | Id::MuchMore => {
            return turn(model, id, None);
        }
        Id::Edit => return select(model),
        Id::Up if model.panel == Panel::Charts => look::go(model, 0.0, 1.0),
        Id::Down if model.panel == Panel::Charts => look::go(model, 0.0, -1.0),
        Id::Left if model.panel == Panel::Charts => look::go(model, -1.0, 0.0),
        Id::Right if model.panel == Panel::Charts => look::go(model, 1.0, 0.0),
        Id::Up | Id::Left => move_selection(model, false),
        Id::Down | Id::Right => move_selection(model, true),
        Id::NextPanel => next_panel(model, 1),
        Id::PreviousPanel => next_panel(model, Panel::ALL.len() - 1),
        Id::NextView | Id::PreviousView => {
            let next = reach::next(model, id == Id::NextView);
            model.look_at(next);
        }
        Id::ZoomIn => look::zoom(model, model.view, true, model.cross.unwrap_or(look::MIDDLE)),
        Id::ZoomOut => look::zoom(model, model.view, false, model.cross.unwrap_or(look::MIDDLE)),
        Id::Whole => look::whole(model),
        Id::CrossHair => look::cross_hair(model),
        Id::Map => look::map(model),
        Id::Pin => look::pin(model),
        Id::Rings => return look::in_rings(model),
        Id::Axes => model.axes = if model.axes == Axes::Reduced { Axes::Raw } else { Axes::Reduced },
        Id::Device => model.device = Some(!model.shows_device()),
        Id::Open => return vec![file(Job::List)],
        Id::CommandLine => return vec![file(Job::Names)],
        Id::Save => return save_back(model),
        Id::Cancel if model.walking.is_some() => return stop(model),
        Id::Cancel if model.is_computing() => return give_up(model),
        Id::Cancel if model.fitting.is_some() => return fit(model),
        Id::Cancel if model.cross.is_some() => model.cross = None,
        Id::Cancel => return background_jobs::give_up(model),
        Id::Quit => model.quit = true,
        // These need an argument, which the terminal asks for; or concern only what it shows.
        Id::SaveAs
        | Id::Export
        | Id::Overlays
        | Id::Pins
        | Id::Go
        | Id::ChooseView
        | Id::Study
        | Id::Branches
        | Id::Copy
        | Id::Enlarge
        | Id::Mouse
        | Id::About
        | Id::Help
        | Id::Assign
        | Id::StepLength
        | Id::SelectEvent
        | Id::Data
        | Id::MoveTo => {}
    }
    Vec::new()
}

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
        Panel::Problem => {
            let knobs = model.knobs();
            model.parameter = moved(model.parameter, knobs.len());
            let selected = knobs.into_iter().nth(model.parameter);
            if let Some(text) = selected
                .and_then(|(row, value)| group_effect(&row).or_else(|| long_text(&row, value.as_ref())))
            {
                model.tell(Level::Info, text);
            }
        }
        Panel::Log => {
            model.event = moved(model.event, model.log_lines());
        }
        Panel::Here | Panel::Result | Panel::Charts => {}
    }
}

/// What a group changes, if this is one; in few words, since the list may scroll at the same time.
fn group_effect(row: &Row) -> Option<String> {
    let [changed, held] = groups::effect(&row.key)?;
    Some(greek(&format!("turning it changes {changed}, {held} held")))
}

/// A text that is longer than its place beside the label may be, whole.
fn long_text(row: &Row, value: Option<&Value>) -> Option<String> {
    /// Characters that fit on every screen.
    const FITTING: usize = 11;
    match value? {
        Value::Text(text) if text.chars().count() > FITTING => Some(format!("{}: {text}", row.label)),
        Value::Profile(rows) => Some(format!("{}: {}", row.label, show_name(&rows.name))),
        _ => None,
    }
}

/// A panel is selected, and a line of it, the last at most.
fn pick(model: &mut Model, panel: Panel, line: Option<usize>) {
    model.panel = panel;
    let lines = match panel {
        Panel::Problem => model.knobs().len(),
        Panel::Log => model.log_lines(),
        Panel::Charts if model.view.is_table() => model.history.path().len(),
        Panel::Here | Panel::Result | Panel::Charts => 0,
    };
    let Some(line) = line.map(|line| line.min(lines.saturating_sub(1))) else { return };
    match panel {
        Panel::Problem => model.parameter = line,
        Panel::Log => model.event = line,
        Panel::Charts if model.view.is_table() => reach::pick_walk_line(model, line),
        Panel::Here | Panel::Result | Panel::Charts => {}
    }
}

/// Enter on an event.
fn select(model: &mut Model) -> Vec<Effect> {
    match model.panel {
        // Chosen in the list of a curve that will have gone, or in the middle of a walk.
        Panel::Log if model.is_busy() => {
            let number = model.log().entries.get(model.event).and_then(|entry| entry.number);
            number.map_or_else(Vec::new, |number| update(model, Command::SelectEvent(number)))
        }
        Panel::Log => go_to_event(model),
        Panel::Charts if model.view.is_table() => go_to_line(model),
        _ => Vec::new(),
    }
}

/// The walker goes to the selected state of the table of states.
fn go_to_line(model: &mut Model) -> Vec<Effect> {
    let line = reach::walk_line(model);
    let state = model.history.path().get(line).map(|(node, _)| *node);
    let numbering = model.history.numbering();
    // As a command of its own: it waits for its turn, and can be taken back.
    state.map_or_else(Vec::new, |node| update(model, Command::GoTo { node, numbering }))
}
