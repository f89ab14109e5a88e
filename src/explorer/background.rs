//! Results that belong to the values and are computed in the background.
//!
//! A result says which one is wanted now, computes it and is kept: [`Background`]. What is asked for, stopped, told of and thrown
//! away follows from that. A new one is a file with an `impl Background`, and its name in [`backgrounds`](super::backgrounds).

use super::effect::Effect;
use super::model::{Level, Model};
use super::results::{AnyResult, Found, Task};
use pulloff_engine::progress::Progress;
use std::fmt;
use std::sync::Arc;
use std::time::Duration;

/// What is wanted of a result now.
#[derive(Debug, Clone)]
pub enum Want<K> {
    /// The one of this key.
    Now(K),
    /// Nothing new: what was asked for goes on, and what is there stays.
    Later,
    /// None: what was asked for is stopped, and what is there is not shown.
    Not,
}

/// Whoever watches a computation.
pub type Watcher<'a> = &'a (dyn Progress + Sync);
/// Whoever is told what is done so far.
pub type Tell<'a, R> = &'a mut dyn FnMut(R);

/// A result that belongs to the values.
pub trait Background: fmt::Debug + Send + Sync + Sized + 'static {
    /// All that it is computed from.
    type Key: fmt::Debug + Clone + Send + Sync + 'static;

    /// Its name, and that of its thread.
    const NAME: &'static str;
    /// Computed this long, one is finished though a newer one waits, so that a held key shows some.
    const PATIENCE: Duration = Duration::ZERO;
    /// Whether an answer to an older question is of no use.
    const ONLY_NEWEST: bool = false;

    /// Whether it changes the values when it comes, which undo takes back.
    const CHANGES_VALUES: bool = false;

    /// What is wanted now.
    fn wanted(model: &Model) -> Want<Self::Key>;
    /// Whether two keys have the same answer.
    fn is_same(asked: &Self::Key, wanted: &Self::Key) -> bool;
    /// Computes it, and tells of what is done so far; `None` where it was stopped.
    fn compute(key: &Self::Key, progress: Watcher<'_>, told: Tell<'_, Self>) -> Option<Self>;

    /// Whether this is the answer, so that nothing need be asked.
    fn is_of(&self, _: &Self::Key) -> bool {
        false
    }
    /// Whether it is computed where nobody looks.
    fn is_for_scripts(_: &Self::Key) -> bool {
        true
    }
    /// What follows once it has come.
    fn came(_: &mut Model, _: Arc<Self>) -> Vec<Effect> {
        Vec::new()
    }
    /// What is said while it is under way, where that takes long.
    fn says(_: &Model) -> Option<String> {
        None
    }
    /// What is said when it is given up; `None` where it is not under way, or cannot be given up.
    fn given_up(_: &mut Model) -> Option<String> {
        None
    }
}

/// A kind of result, whatever it is.
#[derive(Debug, Clone, Copy)]
pub struct ResultKind {
    pub name: &'static str,
    pub changes_values: bool,
    /// Asks for it where it is wanted, and stops it where it is wanted no longer.
    pub want: fn(&mut Model) -> Option<Effect>,
    pub keep: fn(&mut Model, Found) -> Vec<Effect>,
    pub says: fn(&Model) -> Option<String>,
    /// Gives it up; `None` where there is nothing to give up.
    pub give_up: fn(&mut Model) -> Option<Vec<Effect>>,
}

impl ResultKind {
    /// That of a result.
    pub const fn of<R: Background>() -> Self {
        Self {
            name: R::NAME,
            changes_values: R::CHANGES_VALUES,
            want: want::<R>,
            keep: keep::<R>,
            says: R::says,
            give_up: give_up::<R>,
        }
    }
}

/// Asks for the result that is wanted, unless it is there or on its way; stops one that is wanted no longer.
fn want<R: Background>(model: &mut Model) -> Option<Effect> {
    let key = match R::wanted(model) {
        Want::Later => return None,
        Want::Not => {
            let stops = stop::<R>(model);
            model.results.slot_mut::<R>().asked = None;
            return stops;
        }
        Want::Now(key) => key,
    };
    if asked::<R>(model).is_some_and(|asked| R::is_same(asked, &key)) {
        return None;
    }
    let whole =
        model.results.slot::<R>().and_then(|slot| Some(slot.found.as_ref()?.0).filter(|id| *id <= slot.over));
    if let Some(id) = whole
        && model.results.found::<R>().is_some_and(|found| found.is_of(&key))
    {
        let stops = stop::<R>(model);
        model.results.slot_mut::<R>().asked = Some((id, Arc::new(key)));
        return stops;
    }
    Some(ask::<R>(model, key))
}

/// The key of what was asked for last, and is still wanted.
pub(super) fn asked<R: Background>(model: &Model) -> Option<&R::Key> {
    model.results.asked::<R, R::Key>()
}

/// Asks for a result.
pub(super) fn ask<R: Background>(model: &mut Model, key: R::Key) -> Effect {
    let id = model.number();
    let (name, patience, is_for_scripts) = (R::NAME, R::PATIENCE, R::is_for_scripts(&key));
    model.results.slot_mut::<R>().asked = Some((id, Arc::new(key.clone())));
    let share = |found: R| -> AnyResult { Arc::new(found) };
    let work = move |progress: &(dyn Progress + Sync), told: &mut dyn FnMut(AnyResult)| {
        R::compute(&key, progress, &mut |part| told(share(part))).map(share)
    };
    Effect::Compute(Task { name, id, patience, is_for_scripts, work: Arc::new(work) })
}

/// Stops what is under way; what comes of it is still taken.
pub(super) fn stop<R: Background>(model: &Model) -> Option<Effect> {
    model.results.under_way::<R>().map(|id| Effect::Stop { name: R::NAME, id })
}

/// Stops what is under way, says so, and does not ask for it again.
fn give_up<R: Background>(model: &mut Model) -> Option<Vec<Effect>> {
    let said = R::given_up(model)?;
    let stops = stop::<R>(model);
    if let Some(Effect::Stop { id, .. }) = stops {
        model.results.slot_mut::<R>().over = id;
    }
    model.tell(Level::Info, said);
    Some(stops.into_iter().collect())
}

/// Takes an answer, unless a newer one is there.
fn keep<R: Background>(model: &mut Model, found: Found) -> Vec<Effect> {
    let slot = model.results.slot_mut::<R>();
    let newest = slot.asked.as_ref().map(|(id, _)| *id);
    let is_old = slot.found.as_ref().is_some_and(|(id, _)| found.id < *id);
    let is_wanted = newest.is_some_and(|id| found.id == id || found.id < id && !R::ONLY_NEWEST);
    let Ok(what) = Arc::clone(&found.what).downcast::<R>() else { return Vec::new() };
    if is_old || !is_wanted {
        return Vec::new();
    }
    slot.found = Some((found.id, found.what));
    if found.is_whole {
        slot.over = slot.over.max(found.id);
    }
    R::came(model, what)
}
