//! Where the walker is sent: to a contact radius, an event, the least force.

use super::travel::travel_to;
use super::walk::walk;
use crate::explorer::effect::Effect;
use crate::explorer::model::{Level, Model};
use crate::explorer::view::EventSource;
use crate::explorer::walk::{Action, ROOM};
use pulloff_engine::quasistatic::Event;
use pulloff_engine::report::number::{short, with_unit};
use pulloff_engine::units::Quantity;

/// Why the walker does not go to some events.
const WITH_RINGS: &str = "that state has rings of contact, and the walker is on the curve of one disc";

/// The walker goes to the state of this contact radius, in the user's units.
pub(super) fn move_to(model: &mut Model, radius: f64) -> Vec<Effect> {
    let Some(curve) = &model.curve else { return Vec::new() };
    let reduced = radius / curve.case.units().length;
    if reduced > ROOM * curve.case.start {
        let largest = ROOM * curve.case.start * curve.case.units().length;
        let length = |s| with_unit(&model.preset.units, Quantity::Length, s, false, |s| short(s, 6));
        let (asked, largest) = (length(radius), length(largest));
        model.tell(Level::Error,
            format!(
                "contact radius {asked} is out of range: it must be at most {largest}, three times that of the start"
            ),
        );
        return Vec::new();
    }
    walk(model, Action::MoveTo(reduced))
}

/// The walker goes to the least force of the quasi-static path.
pub(super) fn to_least_force(model: &mut Model) -> Vec<Effect> {
    /// Radii of one limit point, found in two ways, are as near as this.
    const SAME: f64 = 1e-6;
    let Some(curve) = &model.curve else { return Vec::new() };
    match &curve.unloading {
        Ok(path) => {
            let Some(least) = path.largest_pull() else { return Vec::new() };
            let radius = least.contact_radius;
            // Under a dead load it is where an event begins, and is reached as that.
            let begins = |event: &Event| {
                let before = event.before.as_ref().map(|before| before.contact_radius);
                before.is_some_and(|before| (before - radius).abs() <= SAME * radius)
            };
            match path.events.iter().position(begins) {
                Some(event) => {
                    (model.events, model.event) = (EventSource::Curve, event);
                    go_to_event(model)
                }
                None => walk(model, Action::MoveTo(radius)),
            }
        }
        Err(why) => {
            let text = format!("there is no path, and so no least force of it: {why}");
            model.tell(Level::Error, text);
            Vec::new()
        }
    }
}

/// The event of a number, where the list has it.
pub(super) fn select_event(model: &mut Model, number: usize) -> Vec<Effect> {
    let count = model.shown_events().len();
    if !(1..=count).contains(&number) {
        model.tell(Level::Error, format!("there is no event {number}: the list has {count}"));
        return Vec::new();
    }
    model.event = number - 1;
    go_to_event(model)
}

/// The walker goes to the limit point of the selected event.
pub(super) fn go_to_event(model: &mut Model) -> Vec<Effect> {
    if model.events == EventSource::Walked {
        let events = model.walked_events();
        let Some((node, _)) = events.get(model.event) else { return Vec::new() };
        let Some(parent) = model.history.node(*node).and_then(|n| n.parent) else { return Vec::new() };
        // The state before the jump, as it was walked.
        return travel_to(model, parent);
    }
    if model.events == EventSource::Cycle {
        return go_to_loop_event(model);
    }
    let Some(curve) = model.curve.clone() else { return Vec::new() };
    let Ok(unloading) = &curve.unloading else { return Vec::new() };
    let Some(event) = unloading.events.get(model.event) else {
        if !model.shown_inadmissible().is_empty() {
            model.tell(Level::Info, "no state to go to: the next crest would touch before");
        }
        return Vec::new();
    };
    let Some(before) = event.before.as_ref().filter(|before| before.rings() == 0) else {
        model.tell(Level::Info, WITH_RINGS);
        return Vec::new();
    };
    let away = |s: f64| (s - before.contact_radius).abs();
    let radius = |i: &usize| curve.limits[*i].contact_radius;
    let nearest = (0..curve.limits.len()).min_by(|a, b| away(radius(a)).total_cmp(&away(radius(b))));
    model.inward = true;
    let event = model.event;
    nearest.map_or_else(Vec::new, |limit| walk(model, Action::MoveToEvent { event, limit }))
}

/// The walker goes to the state before an event of the loop, where that is one disc.
fn go_to_loop_event(model: &mut Model) -> Vec<Effect> {
    let before = model.cycle.as_ref().and_then(|cycle| {
        let event = cycle.report()?.events.get(model.event)?;
        event.before.as_ref().map(|before| (before.contacts.clone(), before.contact_radius))
    });
    match before {
        Some((contacts, radius)) if contacts.len() == 1 && contacts[0][0] == 0.0 => move_to(model, radius),
        Some(_) => {
            model.tell(Level::Info, WITH_RINGS);
            Vec::new()
        }
        None => Vec::new(),
    }
}
