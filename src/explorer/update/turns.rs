//! Which commands wait for which, and which of them undo can take back.

use crate::explorer::command::{Command, Id};
use crate::explorer::effect::Effect;
use crate::explorer::job::Job;
use crate::explorer::model::{Awaits, Model};
use crate::explorer::table::{Waits, is_available, row_of, why_unavailable};
use crate::explorer::undo::SessionPlace;
use pulloff_engine::preset::Key;

/// The most commands that may wait; more key presses than that come from a held key.
const QUEUE: usize = 1000;

/// The commands that turn the selected value.
const TURNS: [Id; 6] = [Id::FineLess, Id::FineMore, Id::Less, Id::More, Id::MuchLess, Id::MuchMore];

/// What a command waits for.
pub(super) fn waits(command: &Command) -> Waits {
    let is_control = |key: &str| matches!(key, "path.control" | "control");
    match command {
        // Another control holds the force or approach to which the previous values led.
        Command::Set { key, .. } | Command::Turn { key, .. } if is_control(key) => Waits::Curve,
        Command::Assign(all) if all.iter().any(|(key, _)| is_control(key)) => Waits::Curve,
        Command::Set { .. } | Command::Try { .. } | Command::Open(_) | Command::OpenWith { .. } => {
            Waits::InOrder
        }
        command => row_of(command.id()).waits,
    }
}

/// Whether a command has to wait for what is under way.
pub(super) fn is_blocked(model: &Model, command: &Command) -> bool {
    // Pressed again, it ends a run; pressed once more, it begins the next.
    if *command == Id::Run.into() && model.walking.is_some_and(|walking| !walking.solves && !walking.stops) {
        return false;
    }
    let is_walking = model.walking.is_some_and(|walking| !walking.solves);
    let waits_for_curve = || waits(command) == Waits::Curve && model.is_busy();
    model.awaits == Awaits::File || is_walking || waits_for_curve()
}

/// Lets a command wait for its turn.
pub(super) fn enqueue(model: &mut Model, command: Command) -> Vec<Effect> {
    let command = match command {
        // The value to turn is fixed when the key is pressed: another may be selected by the time its turn comes.
        Command::Plain(id) if TURNS.contains(&id) => {
            if !is_available(model, id) {
                return model.refuse(why_unavailable(model, id));
            }
            let Some((row, _)) = model.selected_knob() else { return Vec::new() };
            Command::Turn { id, key: row.key.clone() }
        }
        // What is being typed is shown when there is time.
        Command::Try { .. } => return Vec::new(),
        command => command,
    };
    if model.queue.len() < QUEUE {
        model.queue.push_back(command);
    }
    Vec::new()
}

/// What undo takes back together with its like before it.
pub(super) enum Gesture {
    /// The value that is turned.
    Turn(Key),
    /// A step that continues this many steps before it.
    Step(usize),
}

/// The gesture that a command is part of.
pub(super) fn gesture(model: &Model, command: &Command) -> Option<Gesture> {
    match command {
        Command::Steps(1) | Command::Plain(Id::Step) => Some(Gesture::Step(0)),
        Command::HeldStep(before) => Some(Gesture::Step(*before)),
        Command::Turn { key, .. } => Some(Gesture::Turn(key.clone())),
        Command::Plain(id) if TURNS.contains(id) => {
            model.selected_knob().map(|(row, _)| Gesture::Turn(row.key.clone()))
        }
        _ => None,
    }
}

/// Does something that undo can take back, together with the earlier parts of `gesture`.
pub(super) fn recorded(
    model: &mut Model,
    gesture: Option<Gesture>,
    act: impl FnOnce(&mut Model) -> Vec<Effect>,
) -> Vec<Effect> {
    let before = model.untried.as_ref().map_or_else(|| model.place(), |untried| untried.place.clone());
    let (session, walking) = (model.session, model.walking.map(|walking| walking.id));
    let effects = act(model);
    if effects.iter().any(changes_problem) {
        model.awaits = Awaits::File;
    }
    if model.session != session || model.untried.is_some() {
        return effects;
    }
    let step = if let Some(Gesture::Step(before)) = gesture { Some(before) } else { None };
    let gesture = if let Some(Gesture::Turn(key)) = gesture { Some(key) } else { None };
    let goes_on = gesture.is_some() && model.undo.gesture == gesture;
    if !model.is_at(&before) {
        if goes_on {
            model.undo.goes_on();
        } else {
            model.undo.did(before);
        }
        model.undo.gesture = gesture;
    } else if !goes_on {
        model.undo.gesture = None;
        if model.walking.is_some_and(|now| !now.solves && Some(now.id) != walking)
            && !step.is_some_and(|count| model.undo.holds(count))
        {
            model.undo.begins(SessionPlace { is_step: step.is_some(), ..before });
        }
    }
    effects
}

/// Whether an effect is answered by another problem.
fn changes_problem(effect: &Effect) -> bool {
    let Effect::File(job) = effect else { return false };
    matches!(**job, Job::Open { .. } | Job::Read { .. } | Job::Assign { .. })
}
