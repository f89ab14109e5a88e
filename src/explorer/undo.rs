//! What undo goes back to: where the session stood before each command that changed it.
//!
//! A place records everything that a command of the walk or of the values can change. States are named by their number
//! in the tree, which pruning keeps, so going back computes nothing but the curve. Views and the zoom are not included.

use super::history::History;
use super::journal::Journal;
use super::pins::Pins;
use crate::store::{Fingerprint, Source};
use pulloff_engine::preset::{Key, Preset};
use std::sync::Arc;

/// The most commands that can be undone.
pub const MOST: usize = 1000;
/// The most of them that may have opened another preset: each keeps a walk.
const MOST_OPENED: usize = 8;

/// A session set aside when another preset was opened.
#[derive(Debug, Clone)]
pub struct Shelved {
    pub source: Source,
    pub saved: Preset,
    pub fingerprint: Option<Fingerprint>,
    pub history: History,
    pub journal: Journal,
}

/// Where the session stood.
#[derive(Debug, Clone)]
pub struct SessionPlace {
    pub preset: Preset,
    /// The permanent number of the walker's state.
    pub node: Option<u64>,
    pub inward: bool,
    pub length: f64,
    pub pins: Pins,
    /// Whether the walker had been tried on these values.
    pub settled: bool,
    /// Whether a single step led on from it, which a held key continues.
    pub is_step: bool,
    /// The session it belongs to, if that differs from the session of the next place.
    pub shelved: Option<Arc<Shelved>>,
}

impl SessionPlace {
    /// Whether both are the same, apart from whether the state has been tried.
    pub fn is_like(&self, other: &Self) -> bool {
        self.shelved.is_none()
            && self.node == other.node
            && (self.inward, self.length.to_bits()) == (other.inward, other.length.to_bits())
            && self.preset == other.preset
            && self.pins.is_like(&other.pins)
    }
}

/// The places before the commands done, and after the commands undone; the newest last. A clone is cheap.
#[derive(Debug, Clone, Default)]
pub struct Undo {
    past: Vec<Arc<SessionPlace>>,
    future: Vec<Arc<SessionPlace>>,
    /// The place before a walk that has made no state yet.
    begun: Option<Arc<SessionPlace>>,
    /// The value that the last command turned.
    pub(super) gesture: Option<Key>,
}

impl Undo {
    /// The undo of a resumed session: the places before it, the newest last, and those undone.
    pub fn of(past: Vec<SessionPlace>, future: Vec<SessionPlace>) -> Self {
        let [past, future] = [past, future].map(|places| places.into_iter().map(Arc::new).collect());
        Self { past, future, ..Self::default() }
    }

    /// The places before the commands done, the newest last.
    pub fn past(&self) -> &[Arc<SessionPlace>] {
        &self.past
    }

    /// The places of the commands undone, the next one last.
    pub fn future(&self) -> &[Arc<SessionPlace>] {
        &self.future
    }

    /// A command changed something; `before` is where it began.
    pub(super) fn did(&mut self, before: SessionPlace) {
        self.begun = None;
        self.future.clear();
        self.add(Arc::new(before));
    }

    /// The last command continues: the place where it began is already kept.
    pub(super) fn goes_on(&mut self) {
        self.future.clear();
    }

    fn add(&mut self, place: Arc<SessionPlace>) {
        self.past.push(place);
        let opened = self.past.iter().rev().enumerate().filter(|(_, place)| place.shelved.is_some());
        let first = opened.map(|(at, _)| self.past.len() - at).nth(MOST_OPENED);
        let surplus = self.past.len().saturating_sub(MOST).max(first.unwrap_or(0));
        self.past.drain(..surplus);
    }

    /// A walk begins: once it has made a state, it is a command that changed something.
    pub(super) fn begins(&mut self, before: SessionPlace) {
        self.begun = Some(Arc::new(before));
    }

    /// A step continues this many steps before it, and they become one; false if there was none before.
    pub(super) fn holds(&mut self, count: usize) -> bool {
        let steps = self.past.iter().rev().take(count).take_while(|place| place.is_step).count();
        self.past.truncate(self.past.len() + 1 - steps.max(1));
        if steps > 0 {
            (self.begun, self.future) = (None, Vec::new());
        }
        steps > 0
    }

    /// A walk made a state.
    pub(super) fn walked(&mut self) {
        if let Some(before) = self.begun.take() {
            self.future.clear();
            self.add(before);
        }
    }

    /// Takes the place before the last command (or after the next one); the caller keeps the present one for the
    /// other way. Places like `here` are skipped: their commands changed nothing.
    pub(super) fn take(&mut self, back: bool, here: &SessionPlace) -> Option<Arc<SessionPlace>> {
        (self.begun, self.gesture) = (None, None);
        let from = if back { &mut self.past } else { &mut self.future };
        let at = from.iter().rposition(|place| !place.is_like(here))?;
        from.truncate(at + 1);
        from.pop()
    }

    /// Keeps `place` for the way back from where [`take`](Self::take) led.
    pub(super) fn keep(&mut self, back: bool, place: SessionPlace) {
        let place = Arc::new(place);
        if back { self.future.push(place) } else { self.add(place) }
    }

    /// The permanent numbers of the states it needs in the session on the screen.
    pub(super) fn nodes(&self) -> Vec<u64> {
        let own = |places: &[Arc<SessionPlace>]| -> Vec<u64> {
            let own = places.iter().rev().take_while(|place| place.shelved.is_none());
            own.filter_map(|place| place.node).collect()
        };
        let begun = self.begun.iter().filter_map(|place| place.node);
        let mut nodes: Vec<u64> = own(&self.past).into_iter().chain(own(&self.future)).chain(begun).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}
