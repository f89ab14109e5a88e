//! The measured curve and the model: how far each point is from the curve, and which keys a fit may change.

use super::background::{Background, Tell, Want, Watcher};
use super::model::Model;
use super::view::View;
use pulloff_engine::fit::residuals::{Residual, residuals_own};
use pulloff_engine::measured::Abscissa;
use pulloff_engine::preset::{Preset, data};

/// The message where there are no points to look at.
pub const NO_POINTS: &str = "no measured curve: :data FILE puts one behind the chart";

/// The distances of the points from the curve of a preset, in σ.
#[derive(Debug, Clone)]
pub struct Distances {
    pub preset: Preset,
    pub found: Result<(Abscissa, Vec<Residual>), String>,
}

impl Distances {
    /// Computes the distances.
    pub fn of(preset: &Preset) -> Self {
        let found = residuals_own(preset).map_err(|error| error.to_string());
        Self { preset: preset.clone(), found }
    }
}

impl Background for Distances {
    type Key = Preset;
    const NAME: &'static str = "distances";

    fn wanted(model: &Model) -> Want<Preset> {
        let is_shown = model.shown_views().contains(&View::Residuals) && model.preset.data.source.is_some();
        if is_shown { Want::Now(model.preset.clone()) } else { Want::Later }
    }

    fn is_same(asked: &Preset, wanted: &Preset) -> bool {
        asked == wanted
    }

    fn is_of(&self, wanted: &Preset) -> bool {
        self.preset == *wanted
    }

    fn compute(preset: &Preset, _: Watcher<'_>, _: Tell<'_, Self>) -> Option<Self> {
        Some(Self::of(preset))
    }
}

/// The dotted key that a name in `data.free` stands for.
pub(super) fn named(preset: &Preset, name: &str) -> Option<String> {
    use pulloff_engine::fit::problem::Target;
    Some(match pulloff_engine::fit::options::target(preset, Abscissa::Approach, name).ok()? {
        Target::Key(key) => key,
        Target::Offset => data::OFFSET.to_owned(),
        Target::Baseline => data::BASELINE.to_owned(),
        Target::Tilt => data::TILT.to_owned(),
        Target::Adhesion(_) => return None,
    })
}

/// Whether a fit may change this key.
pub fn is_free(preset: &Preset, key: &str) -> bool {
    preset.data.free().any(|name| name == key || named(preset, name).as_deref() == Some(key))
}
