//! What undo goes back to, in a session.
//!
//! Commands from before another preset was opened are left out: that session is a document of its own.

use super::unreadable::Unreadable;
use crate::explorer::history::History;
use crate::explorer::pins::Pins;
use crate::explorer::undo::{SessionPlace, Undo};
use pulloff_engine::exact;
use pulloff_engine::preset::{Key, Preset};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The places before the commands done, and those of the commands undone; the newest last.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct SavedPlaces {
    past: Vec<SavedPlace>,
    future: Vec<SavedPlace>,
    /// The value that the last command turned: turning it again continues that command.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    gesture: Option<String>,
}

/// A place, with its preset and its state given by their numbers in the document.
#[derive(Debug, Serialize, Deserialize)]
struct SavedPlace {
    preset: usize,
    node: Option<usize>,
    inward: bool,
    #[serde(with = "exact")]
    length: f64,
    /// Each pin's number, and that of its preset.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pins: Vec<(usize, usize)>,
    settled: bool,
}

impl SavedPlaces {
    /// The places of `undo`; `preset` numbers their presets.
    pub(super) fn of(undo: &Undo, history: &History, mut preset: impl FnMut(&Preset) -> usize) -> Self {
        let mut own = |places: &[Arc<SessionPlace>]| -> Vec<SavedPlace> {
            let first = places.iter().rposition(|place| place.shelved.is_some()).map_or(0, |at| at + 1);
            let saved = places[first..].iter().map(|place| SavedPlace {
                preset: preset(&place.preset),
                node: place.node.and_then(|id| history.find(id)),
                inward: place.inward,
                length: place.length,
                pins: place.pins.presets().map(|(number, pinned)| (number, preset(pinned))).collect(),
                settled: place.settled,
            });
            saved.collect()
        };
        let gesture = undo.gesture.as_ref().map(ToString::to_string);
        Self { past: own(undo.past()), future: own(undo.future()), gesture }
    }

    /// The undo made from these places.
    pub(super) fn back(
        self,
        preset: impl Fn(usize) -> Result<Preset, Unreadable>,
    ) -> Result<Undo, Unreadable> {
        let place = |saved: SavedPlace| {
            let pins = saved.pins.into_iter().map(|(number, at)| Ok((number, preset(at)?)));
            Ok(SessionPlace {
                pins: Pins::awaiting(pins.collect::<Result<Vec<_>, Unreadable>>()?),
                preset: preset(saved.preset)?,
                // A tree that is read numbers its nodes afresh, from 0.
                node: saved.node.map(|at| at as u64),
                inward: saved.inward,
                length: saved.length,
                settled: saved.settled,
                is_step: false,
                shelved: None,
            })
        };
        let [past, future] = [self.past, self.future]
            .map(|places| places.into_iter().map(place).collect::<Result<Vec<_>, Unreadable>>());
        let mut undo = Undo::of(past?, future?);
        undo.gesture = self.gesture.map(Key::from);
        Ok(undo)
    }
}
