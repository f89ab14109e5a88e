//! Results that belong to the values and are computed in the background.
//!
//! A result says which one is wanted now, computes it, and is then kept: see [`Background`]. What is requested,
//! stopped, reported and discarded follows from that. To add a result, write a file with an `impl Background` and add
//! its name to [`backgrounds`](super::backgrounds).

use super::effect::Effect;
use super::model::{Level, Model};
use super::results::{Answer, AnyResult, Found, Task};
use pulloff_engine::progress::Progress;
use std::fmt;
use std::sync::Arc;
use std::time::Duration;

/// Which result is wanted now.
#[derive(Debug, Clone)]
pub enum Want<K> {
    /// The result for this key.
    Now(K),
    /// Nothing new: a computation under way goes on, and the present result stays.
    Later,
    /// None: a computation under way is stopped, and the present result is not shown.
    Not,
}

/// Watches a computation, and can stop it.
pub type Watcher<'a> = &'a (dyn Progress + Sync);
/// Receives what is done so far.
pub type Tell<'a, R> = &'a mut dyn FnMut(R);

/// A result that belongs to the values of the preset.
pub trait Background: fmt::Debug + Send + Sync + Sized + 'static {
    /// Everything it is computed from.
    type Key: fmt::Debug + Clone + Send + Sync + 'static;

    /// Its name, which is also that of its thread.
    const NAME: &'static str;
    /// After this long, a computation is finished although a newer one waits, so that a held key shows some results.
    const PATIENCE: Duration = Duration::ZERO;
    /// Whether the answer to an older question is useless.
    const ONLY_NEWEST: bool = false;

    /// Whether its arrival changes the values, which undo takes back.
    const CHANGES_VALUES: bool = false;

    /// Which result is wanted now.
    fn wanted(model: &Model) -> Want<Self::Key>;
    /// Whether two keys have the same answer.
    fn is_same(asked: &Self::Key, wanted: &Self::Key) -> bool;
    /// Computes it and reports what is done so far; `None` if it was stopped.
    fn compute(key: &Self::Key, progress: Watcher<'_>, told: Tell<'_, Self>) -> Option<Self>;

    /// Whether this is the answer for the key, so that nothing need be requested.
    fn is_of(&self, _: &Self::Key) -> bool {
        false
    }
    /// Whether it is computed even where nobody looks, as in scripts.
    fn is_for_scripts(_: &Self::Key) -> bool {
        true
    }
    /// What follows once it has arrived.
    fn came(_: &mut Model, _: Arc<Self>) -> Vec<Effect> {
        Vec::new()
    }
    /// The message while it is under way, if that takes long.
    fn says(_: &Model) -> Option<String> {
        None
    }
    /// The message when it is given up; `None` if it is not under way, or cannot be given up.
    fn given_up(_: &mut Model) -> Option<String> {
        None
    }
}

/// One kind of result, with its type erased.
#[derive(Debug, Clone, Copy)]
pub struct ResultKind {
    pub name: &'static str,
    pub changes_values: bool,
    /// Requests it if it is wanted, and stops it once it is no longer wanted.
    pub want: fn(&mut Model) -> Option<Effect>,
    pub keep: fn(&mut Model, Found) -> Vec<Effect>,
    pub says: fn(&Model) -> Option<String>,
    /// Gives it up; `None` if there is nothing to give up.
    pub give_up: fn(&mut Model) -> Option<Vec<Effect>>,
}

impl ResultKind {
    /// The kind of the result `R`.
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

/// Requests the wanted result, unless it is there or on its way; stops one that is no longer wanted.
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

/// The key of the last request, if it is still wanted.
pub(super) fn asked<R: Background>(model: &Model) -> Option<&R::Key> {
    model.results.asked::<R, R::Key>()
}

/// Requests a result.
pub(super) fn ask<R: Background>(model: &mut Model, key: R::Key) -> Effect {
    let id = model.number();
    let (name, patience, is_for_scripts) = (R::NAME, R::PATIENCE, R::is_for_scripts(&key));
    let slot = model.results.slot_mut::<R>();
    slot.asked = Some((id, Arc::new(key.clone())));
    slot.percent = 0;
    let share = |found: R| -> AnyResult { Arc::new(found) };
    let work = move |progress: &(dyn Progress + Sync), told: &mut dyn FnMut(AnyResult)| {
        R::compute(&key, progress, &mut |part| told(share(part))).map(share)
    };
    Effect::Compute(Task { name, id, patience, is_for_scripts, work: Arc::new(work) })
}

/// Stops what is under way; a result that still arrives is accepted.
pub(super) fn stop<R: Background>(model: &Model) -> Option<Effect> {
    model.results.under_way::<R>().map(|id| Effect::Stop { name: R::NAME, id })
}

/// Stops what is under way, says so, and does not request it again.
fn give_up<R: Background>(model: &mut Model) -> Option<Vec<Effect>> {
    let said = R::given_up(model)?;
    let stops = stop::<R>(model);
    if let Some(Effect::Stop { id, .. }) = stops {
        model.results.slot_mut::<R>().over = id;
    }
    model.tell(Level::Info, said);
    Some(stops.into_iter().collect())
}

/// Accepts an answer, unless a newer one is there.
fn keep<R: Background>(model: &mut Model, found: Found) -> Vec<Effect> {
    let slot = model.results.slot_mut::<R>();
    let newest = slot.asked.as_ref().map(|(id, _)| *id);
    let is_old = slot.found.as_ref().is_some_and(|(id, _)| found.id < *id);
    let is_wanted = newest.is_some_and(|id| found.id == id || found.id < id && !R::ONLY_NEWEST);
    if is_old || !is_wanted {
        return Vec::new();
    }
    let (what, is_whole) = match found.what {
        Answer::Percent(percent) => {
            if newest == Some(found.id) {
                slot.percent = percent;
            }
            return Vec::new();
        }
        Answer::Part(what) => (what, false),
        Answer::Whole(what) => (what, true),
    };
    let Ok(result) = Arc::clone(&what).downcast::<R>() else { return Vec::new() };
    slot.found = Some((found.id, what));
    if is_whole {
        slot.over = slot.over.max(found.id);
    }
    R::came(model, result)
}
