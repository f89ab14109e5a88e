//! Undo and redo, and going to states made earlier in the walk.

use super::curve::solve_again;
use super::walk::abandon;
use crate::explorer::availability::{redo, undo};
use crate::explorer::command::{Command, Id};
use crate::explorer::effect::Effect;
use crate::explorer::look::carry_on;
use crate::explorer::model::{Level, Model};
use crate::explorer::node::Node;
use crate::explorer::pins::changes;
use crate::explorer::requests::{adopt_parameters, change, take_back, want_curve};
use crate::explorer::undo::{SessionPlace, Shelved};
use crate::store::Loaded;
use pulloff_engine::quasistatic::State;
use pulloff_engine::text::greek;
use std::mem;
use std::sync::Arc;

/// Undoes or redoes this many commands, as far as there are any.
pub(in crate::explorer) fn travel(model: &mut Model, id: Id, count: usize) -> Vec<Effect> {
    let (before, pins, session) = (model.preset.clone(), model.pins.clone(), model.session);
    let mut effects = Vec::new();
    for _ in 0..count {
        match once(model, id == Id::Undo) {
            Some(more) => effects.extend(more),
            None => break,
        }
    }
    if model.session == session {
        // Where the walker went, the sentence of its state says.
        let pinned = (!model.pins.is_like(&pins)).then(|| "the pins".to_owned());
        let changed: Vec<String> = changes(&before, &model.preset).into_iter().chain(pinned).collect();
        if !changed.is_empty() {
            let word = if id == Id::Undo { "undone" } else { "redone" };
            model.tell(Level::Info, greek(&format!("{word}: {}", changed.join(", "))));
        }
    }
    effects
}

fn once(model: &mut Model, back: bool) -> Option<Vec<Effect>> {
    let here = model.place();
    let place = model.undo.take(back, &here)?;
    let mut effects = abandon(model);
    let Some(shelved) = &place.shelved else {
        model.undo.keep(back, here);
        go_to_node(model, &place);
        let mut preset = place.preset.clone();
        if let Some([_, title]) = model.retitled.as_ref().filter(|[before, _]| preset.title == *before) {
            preset.title.clone_from(title);
        }
        effects.extend(change(model, preset));
        model.is_tried = place.settled && model.is_computing();
        if !place.settled && !model.is_computing() {
            effects.extend(solve_again(model).unwrap_or_default());
        }
        return Some(effects);
    };
    let kept = shelve(model);
    model.undo.keep(back, SessionPlace { shelved: Some(Arc::new(kept)), ..here });
    swap(model, (**shelved).clone());
    go_to_node(model, &place);
    model.preset = place.preset.clone();
    model.is_tried = place.settled;
    effects.push(want_curve(model));
    Some(effects)
}

/// The session set aside for another preset.
pub(super) fn shelve(model: &Model) -> Shelved {
    Shelved {
        source: model.source.clone(),
        saved: model.saved.clone(),
        fingerprint: model.fingerprint,
        history: model.history.clone(),
        journal: model.journal.clone(),
    }
}

/// Another session takes the place of this one; the display and the undo stay.
fn swap(model: &mut Model, shelved: Shelved) {
    let Shelved { source, saved, fingerprint, history, journal } = shelved;
    let mut other = Model::new(Loaded { source, preset: saved, text: String::new(), fingerprint });
    other.replace(model);
    carry_on(model, &mut other);
    (other.history, other.journal) = (history, journal);
    *model = other;
}

impl Model {
    /// Takes the place of `before` when another preset is shown: what waits, and undo, continue.
    pub(super) fn replace(&mut self, before: &mut Self) {
        self.follow(before);
        self.undo = mem::take(&mut before.undo);
        self.queue = mem::take(&mut before.queue);
        self.preset_names = mem::take(&mut before.preset_names);
    }
}

/// Gives the walker, its direction, its step length and the pins the values of `place`.
fn go_to_node(model: &mut Model, place: &SessionPlace) {
    (model.inward, model.length) = (place.inward, place.length);
    model.pins.go_back_to(&place.pins);
    let (Some(from), Some(to)) = (model.history.cursor(), place.node.and_then(|id| model.history.find(id)))
    else {
        return;
    };
    let parent = |at: usize| model.history.node(at).and_then(|node| node.parent);
    let steps = |next: &dyn Fn(usize) -> Option<usize>| {
        std::iter::successors(Some(from), |at| next(*at)).take(model.history.len()).position(|at| at == to)
    };
    let (up, down) = (steps(&parent), steps(&|at| model.history.forward(at)));
    // As steps of the tree if possible, since a replay numbers its states differently.
    match (up, down) {
        (Some(0), _) => {}
        (Some(count), _) => along(model, Id::Undo, count),
        (_, Some(count)) => along(model, Id::Redo, count),
        _ => to_node(model, to),
    }
}

/// Moves along the tree by this many states, without their values.
fn along(model: &mut Model, id: Id, count: usize) {
    let gone = (0..count).take_while(|_| one_state(model, id)).count();
    if gone > 0 {
        let command = Command::Travel { id, count: gone, states: true };
        model.journal.travelled(&command, model.history.current());
    }
}

fn one_state(model: &mut Model, id: Id) -> bool {
    if id == Id::Redo { model.history.redo() } else { model.history.undo() }
}

/// Moves back or forward along the walk by this many single states, with their values.
pub(super) fn by_states(model: &mut Model, id: Id, count: usize) -> Vec<Effect> {
    let mut effects = Vec::new();
    let is_there = if id == Id::Undo {
        model.is_ahead() || model.history.parent().is_some()
    } else {
        model.history.redo_target().is_some()
    };
    if !is_there {
        let needs = if id == Id::Undo { undo } else { redo };
        model.tell(Level::Error, needs(model).err().unwrap_or_default());
    }
    for _ in 0..count {
        if id == Id::Undo && model.is_ahead() {
            effects.extend(take_back(model));
            continue;
        }
        effects.extend(abandon(model));
        let before = model.history.cursor();
        along(model, id, 1);
        if model.history.cursor() == before {
            break;
        }
        effects.extend(adopt_parameters(model));
    }
    effects
}

/// Back to the node with this number, which comes before the walker's.
pub(super) fn travel_to(model: &mut Model, node: usize) -> Vec<Effect> {
    let mut effects = abandon(model);
    while model.history.cursor() != Some(node) && model.history.parent().is_some() {
        along(model, Id::Undo, 1);
    }
    effects.extend(adopt_parameters(model));
    effects
}

fn to_node(model: &mut Model, node: usize) {
    if model.history.go(node) {
        let state = model.history.current().map(|node| node.state);
        if let Some(State { approach, force, contact_radius, .. }) = state {
            // By its values, since a replay numbers its states differently.
            let command = Command::GoToState([approach, force, contact_radius]);
            model.journal.travelled(&command, model.history.current());
        }
    }
}

/// To the end of a branch, with its parameters.
pub(super) fn go_to(model: &mut Model, node: usize, numbering: u64) -> Vec<Effect> {
    if model.history.numbering() != numbering || model.history.node(node).is_none() {
        return model.refuse("the walk has since changed: ask for its branches again");
    }
    let mut effects = abandon(model);
    to_node(model, node);
    effects.extend(adopt_parameters(model));
    effects
}

/// To the last state made with these δ, P and s, reduced, bit for bit.
pub(super) fn go_to_state(model: &mut Model, state: [f64; 3]) -> Vec<Effect> {
    let is_it = |node: &Node| {
        let State { approach, force, contact_radius, .. } = node.state;
        [approach, force, contact_radius].iter().zip(&state).all(|(a, b)| a.total_cmp(b).is_eq())
    };
    let found = (0..model.history.len()).rev().find(|at| model.history.node(*at).is_some_and(is_it));
    let Some(found) = found else {
        return model.refuse("no state of the walk has these values");
    };
    go_to(model, found, model.history.numbering())
}
