//! The curves of pins that have none yet, computed one after the other.

use super::background::{Background, Tell, Want, Watcher};
use super::command::Id;
use super::curve::CurveData;
use super::effect::Effect;
use super::model::{Level, Model};
use super::progress::Staged;
use pulloff_engine::preset::Preset;
use std::sync::Arc;

/// The curve of a pin, by its number, or `None` where there is none.
#[derive(Debug, Clone)]
pub struct PinCurve {
    pub number: usize,
    pub curve: Option<Arc<CurveData>>,
}

impl Background for PinCurve {
    type Key = (usize, Preset);
    const NAME: &'static str = "pins";
    const ONLY_NEWEST: bool = true;

    fn wanted(model: &Model) -> Want<Self::Key> {
        model.pins.awaited().first().cloned().map_or(Want::Not, Want::Now)
    }

    fn is_same(asked: &Self::Key, wanted: &Self::Key) -> bool {
        asked == wanted
    }

    fn compute((number, preset): &Self::Key, progress: Watcher<'_>, _: Tell<'_, Self>) -> Option<Self> {
        let curve = CurveData::compute(preset, &Staged::new(&|_| progress.stop()));
        // Given up: another pin may have this number now.
        (!progress.stop()).then(|| Self { number: *number, curve: curve.ok().map(Arc::new) })
    }

    fn came(model: &mut Model, found: Arc<Self>) -> Vec<Effect> {
        let Self { number, curve } = &*found;
        if model.pins.came(*number, curve.clone()) && curve.is_none() {
            model.tell(Level::Error, format!("there is no curve for pin {number}"));
        }
        Vec::new()
    }

    fn says(model: &Model) -> Option<String> {
        let curves = match model.pins.awaited().len() {
            0 => return None,
            1 => "a pinned curve".to_owned(),
            count => format!("{count} pinned curves"),
        };
        Some(format!("computing {curves}; {} gives up", Id::Cancel.named()))
    }

    fn given_up(model: &mut Model) -> Option<String> {
        let curves = match model.pins.awaited().len() {
            0 => return None,
            1 => "the pinned curve",
            _ => "the pinned curves",
        };
        model.pins.give_up();
        Some(format!("cancelled: {curves} on the way will not be shown"))
    }
}
