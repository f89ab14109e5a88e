//! Undo and redo, and going to states made earlier in the walk.

use super::curve::solve_again;
use super::walk::abandon;
use crate::explorer::command::Id;
use crate::explorer::effect::Effect;
use crate::explorer::look::carry_on;
use crate::explorer::model::{Level, Model};
use crate::explorer::pins::changes;
use crate::explorer::requests::{adopt_parameters, change, want_curve};
use crate::explorer::undo::{SessionPlace, Shelved};
use crate::store::Loaded;
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
    if let Some(to) = place.node.and_then(|id| model.history.find(id)) {
        to_node(model, to);
    }
}

/// Back to the node with this number, which comes before the walker's, with its values.
pub(super) fn travel_to(model: &mut Model, node: usize) -> Vec<Effect> {
    let mut effects = abandon(model);
    to_node(model, node);
    effects.extend(adopt_parameters(model));
    effects
}

fn to_node(model: &mut Model, node: usize) {
    if model.history.go(node) {
        model.stands();
    }
}

impl Model {
    /// The journal stands where the walker does.
    pub(super) fn stands(&mut self) {
        if let Some(node) = self.history.current() {
            self.journal.go(node.trace);
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
