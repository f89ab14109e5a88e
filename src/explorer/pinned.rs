//! The curves of pins that have none yet, computed one after the other; what a pin is compared with.

use super::background::{Background, Tell, Want, Watcher};
use super::command::Id;
use super::curve::CurveData;
use super::effect::Effect;
use super::model::{Level, Model};
use super::pins::{Elements, Pin, letter};
use super::progress::Staged;
use pulloff_engine::preset::Preset;
use pulloff_engine::report::PathReport;
use std::sync::Arc;

/// The curve of the pin with this number, or `None` if there is none.
#[derive(Debug, Clone)]
pub struct PinCurve {
    pub number: usize,
    pub curve: Option<Arc<CurveData>>,
    pub elements: Option<Elements>,
}

/// Two paths of the same kind.
pub struct Compared<'a> {
    pub now: &'a PathReport,
    pub pin: &'a PathReport,
    /// What both are in a word, for the title; `None` for the path on the screen.
    pub name: Option<&'static str>,
}

impl<'a> Compared<'a> {
    /// The path and that of the pin: two loops, or the unloadings from the start where one of them has none.
    pub fn of(model: &'a Model, pin: &'a Pin) -> Option<Self> {
        let now = model.path()?;
        let is_loop = now.turn.is_some();
        if let Some(pin) = pin.whole.as_deref().filter(|_| is_loop) {
            return Some(Self { now, pin, name: Some("Loop") });
        }
        let of_curve = model.curve.as_ref().and_then(|curve| curve.report.as_ref());
        let now = if is_loop { of_curve.unwrap_or(now) } else { now };
        Some(Self { now, pin: pin.curve.report.as_ref()?, name: is_loop.then_some("Unloading") })
    }
}

impl Background for PinCurve {
    /// Its number, its preset, and the curve on the screen beside it.
    type Key = (usize, Preset, Option<Arc<CurveData>>);
    const NAME: &'static str = "pins";
    const ONLY_NEWEST: bool = true;

    fn wanted(model: &Model) -> Want<Self::Key> {
        match model.pins.awaited().first().cloned() {
            None => Want::Not,
            // In a resumed session the curve on the screen is still to come.
            Some(_) if model.curve.is_none() && model.is_computing() => Want::Later,
            Some((number, preset)) => Want::Now((number, preset, model.curve.clone())),
        }
    }

    fn is_same((number, preset, _): &Self::Key, wanted: &Self::Key) -> bool {
        (*number, preset) == (wanted.0, &wanted.1)
    }

    fn compute(
        (number, preset, beside): &Self::Key,
        progress: Watcher<'_>,
        _: Tell<'_, Self>,
    ) -> Option<Self> {
        let curve = CurveData::compute(preset, &Staged::new(&|_| progress.stop())).ok().map(Arc::new);
        let elements =
            curve.as_ref().zip(beside.as_ref()).and_then(|(curve, other)| Elements::of(curve, other));
        // If it was given up, another pin may have this number now.
        (!progress.stop()).then(|| Self { number: *number, curve, elements })
    }

    fn came(model: &mut Model, found: Arc<Self>) -> Vec<Effect> {
        let Self { number, curve, elements } = &*found;
        if !model.pins.came(*number, curve.clone().map(|curve| (curve, *elements))) {
            return Vec::new();
        }
        match elements {
            _ if curve.is_none() => {
                model.tell(Level::Error, format!("there is no curve for pin {}", letter(*number)));
            }
            Some(elements) => {
                let which = format!("pin {}, {} ring elements", letter(*number), elements.count);
                let said = elements.said(&which, ["largest pull off by", "Newton iterations"]);
                model.tell(Level::Info, said);
            }
            None => {}
        }
        Vec::new()
    }

    fn says(model: &Model) -> Option<String> {
        let curves = match model.pins.awaited().len() {
            0 => return None,
            1 => "a pinned curve".to_owned(),
            count => format!("{count} pinned curves"),
        };
        Some(format!("computing {curves}; {} cancels", Id::Cancel.named()))
    }

    fn given_up(model: &mut Model) -> Option<String> {
        let curves = match model.pins.awaited().len() {
            0 => return None,
            1 => "the pinned curve",
            _ => "the pinned curves",
        };
        model.pins.give_up();
        Some(format!("cancelled: {curves} will not be shown"))
    }
}
