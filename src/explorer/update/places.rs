//! Where the walker is sent: to a contact radius, an event, the largest pull.

use super::travel::travel_to;
use super::walk::{restart, walk};
use crate::explorer::command::{Command, Id};
use crate::explorer::effect::Effect;
use crate::explorer::model::{Level, Model};
use crate::explorer::walk::{Action, ROOM};
use pulloff_engine::annuli::Contacts;
use pulloff_engine::case::Case;
use pulloff_engine::preset::schema::START_KEYS;
use pulloff_engine::problem::Begin;
use pulloff_engine::quasistatic::walk::{At, Passing};
use pulloff_engine::quasistatic::{Path, PathState};
use pulloff_engine::report::number::{short, with_unit};
use pulloff_engine::report::path::{EventReport, StateReport, TotalsReport};
use pulloff_engine::units::Quantity;

/// The letter of the farthest state on the charts.
const B: &str = "B";

/// Radii of one limit point that were found in two ways agree to this accuracy.
const SAME: f64 = 1e-6;

/// The walker goes to the state with this contact radius, as typed: a bare number is in the preset's base units.
pub(super) fn move_to(model: &mut Model, text: String) -> Vec<Effect> {
    if text == B {
        return to_marked(model, &FARTHEST, Command::MoveTo(text));
    }
    let Some(row) = model.preset.row(START_KEYS[0]) else { return Vec::new() };
    let radius = match model.preset.number(&row, &text) {
        Ok(radius) => radius,
        Err(invalid) => return model.refuse(invalid.to_string().replace(&*row.key, "contact radius")),
    };
    let Some(curve) = &model.curve else { return Vec::new() };
    let reduced = radius / curve.case.units().length;
    if reduced > ROOM * curve.case.start {
        let largest = ROOM * curve.case.start * curve.case.units().length;
        let length = |s| with_unit(&model.preset.units, Quantity::Length, s, false, |s| short(s, 6));
        let (asked, largest) = (length(radius), length(largest));
        return model.refuse(format!(
                "contact radius {asked} is out of range: it must be at most {largest}, three times that of the start"
            ));
    }
    if curve.along.is_some() {
        model.tell(Level::Info, "the walk follows the path: this is its nearest state");
    }
    walk(model, Action::MoveTo { radius: reduced, command: Command::MoveTo(text) })
}

/// The walker goes to A, the largest pull of the path.
pub(in crate::explorer) fn to_largest_pull(model: &mut Model) -> Vec<Effect> {
    to_marked(model, &LARGEST_PULL, Id::MoveTo.into())
}

/// A state of the path that has a letter on the charts.
struct MarkedState {
    name: &'static str,
    /// Why a path that has reached its end has none.
    missing: &'static str,
    told: fn(&TotalsReport) -> Option<&StateReport>,
    of: fn(&Path) -> Option<&PathState>,
}

const LARGEST_PULL: MarkedState = MarkedState {
    name: "largest pull",
    missing: "nothing pulls on this path",
    told: TotalsReport::pull,
    of: Path::largest_pull,
};
const FARTHEST: MarkedState = MarkedState {
    name: "farthest state",
    missing: "this path stops early",
    told: |totals| totals.farthest.as_ref(),
    of: Path::farthest,
};

/// The walker goes to a state of the path that has a letter.
fn to_marked(model: &mut Model, marked: &MarkedState, command: Command) -> Vec<Effect> {
    let MarkedState { name, missing, told, of } = *marked;
    let Some(curve) = &model.curve else { return Vec::new() };
    let Some(path) = model.path() else {
        let why = match (&curve.unloading, model.cycle().map(|cycle| &cycle.report)) {
            (_, Some(Err(why))) if model.preset.path.begin == Begin::Apart => why.to_string(),
            (Err(why), _) => why.clone(),
            _ => "it is being computed".to_owned(),
        };
        return model.refuse(format!("there is no path, so it has no {name}: {why}"));
    };
    if path.has_reached_its_end && told(&path.totals).is_none() {
        return model.refuse(format!("{missing}, so it has no {name}"));
    }
    if let Some(Ok(along)) = &curve.along {
        let least = of(along);
        let at = along.states.iter().position(|state| least.is_some_and(|least| std::ptr::eq(state, least)));
        return at.map_or_else(Vec::new, |at| walk(model, Action::MoveToState { at, command }));
    }
    let Some(state) = told(&path.totals) else { return Vec::new() };
    let radius = state.contact_radius;
    // Under a dead load an event begins at A, under fixed grips at B, and it is reached as that event.
    let begins = |event: &EventReport| {
        event.before.as_ref().is_some_and(|before| (before.contact_radius - radius).abs() <= SAME * radius)
    };
    if let Some(event) = path.events.iter().position(begins) {
        return select_event(model, event + 1);
    }
    let action = if state.contacts.len() > 1 {
        to_contacts(&curve.case, state, At::Nothing, command)
    } else {
        let reduced = match &curve.unloading {
            Ok(path) if model.preset.path.begin == Begin::Disc => of(path).map(|at| at.contact_radius),
            _ => None,
        };
        let radius = reduced.unwrap_or(radius / curve.case.units().length);
        Action::MoveTo { radius, command }
    };
    // Both lie on the way apart.
    model.inward = true;
    walk(model, action)
}

/// Selects the event with this number on the path.
pub(super) fn select_event(model: &mut Model, number: usize) -> Vec<Effect> {
    let count = model.path_events().len();
    let Some(line) = model.log().place(number) else {
        return model.refuse(format!("there is no event {number}: the path has {count}"));
    };
    model.event = line;
    go_to_event(model)
}

/// The walker goes to where the selected event begins.
pub(super) fn go_to_event(model: &mut Model) -> Vec<Effect> {
    let log = model.log();
    let Some(entry) = log.entries.get(model.event) else {
        if !model.shown_inadmissible().is_empty() {
            model.tell(Level::Info, "no state to go to: the next crest would touch first");
        }
        return Vec::new();
    };
    let Some(curve) = model.curve.clone() else { return Vec::new() };
    if let (Some(number), Some(Ok(along))) = (entry.number, &curve.along) {
        let at = Passing::all(along).get(number - 1).map(|passing| passing.before);
        let command = Command::SelectEvent(number);
        return at.map_or_else(Vec::new, |at| walk(model, Action::MoveToState { at, command }));
    }
    let (Some(number), Some(before)) = (entry.number, &entry.event.before) else {
        // The state before the jump, as it was walked.
        let parent = entry.node.and_then(|node| model.history.node(node)?.parent);
        if let Some(parent) = parent {
            return travel_to(model, parent);
        }
        // Before it the bodies are apart: the walk begins where it lands.
        return restart(model);
    };
    let command = Command::SelectEvent(number);
    model.inward = entry.event.direction == "unloading";
    let at = match (entry.event.kind, entry.event.radius) {
        ("touch", Some(radius)) => At::Touch(radius / curve.case.units().length),
        ("turn", _) => At::Nothing,
        _ => At::Limit,
    };
    if !matches!(before.contacts[..], [[0.0, _]]) || matches!(at, At::Touch(_)) {
        return walk(model, to_contacts(&curve.case, before, at, command));
    }
    let radius = before.contact_radius / curve.case.units().length;
    let away = |i: &usize| (curve.limits[*i].contact_radius - radius).abs();
    let nearest = (0..curve.limits.len()).min_by(|a, b| away(a).total_cmp(&away(b)));
    match nearest.filter(|limit| away(limit) <= SAME * radius) {
        Some(limit) => walk(model, Action::MoveToLimit { limit, command }),
        None => walk(model, Action::MoveTo { radius, command }),
    }
}

/// Goes to a state of the path of a problem by its edges, as `command` asks; `at` waits there.
fn to_contacts(case: &Case, state: &StateReport, at: At, command: Command) -> Action {
    let units = case.units();
    let edge = |radius: f64| radius / units.length;
    let of_disc = |contact: &&[f64; 2]| contact[0].total_cmp(&0.0).is_eq();
    let disc = state.contacts.first().filter(of_disc).map_or(0.0, |[_, outer]| edge(*outer));
    let rings =
        state.contacts.iter().filter(|contact| !of_disc(contact)).map(|ring| ring.map(edge)).collect();
    let value = case.control.value(state.approach / units.length, state.force / units.force);
    Action::MoveToContacts { contacts: Contacts { disc, rings }, value, at, command }
}
