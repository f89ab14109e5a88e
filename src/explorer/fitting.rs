//! The measured curve and the model: a fit of the keys that may change, and how far each point is from the curve.
//!
//! Both take longer than a frame and are done by a worker. A fit ends with one change of the values, which is taken back as
//! one command; what it says of them stands beside them for as long as they are what it found.

use crate::mend::Reason;
use pulloff_engine::fit::run::{Residual, residuals_own};
use pulloff_engine::fit::{Fit, FitError, Options, fit_own};
use pulloff_engine::measured::Abscissa;
use pulloff_engine::preset::{Preset, data};
use pulloff_engine::progress::Progress;
use std::sync::Arc;

/// A fit, or residuals, that are wanted.
#[derive(Debug, Clone)]
pub struct FitWish {
    pub id: u64,
    pub preset: Preset,
}

/// A fit that is running.
#[derive(Debug, Clone)]
pub struct Fitting {
    pub id: u64,
    /// The values that it began with: a fit to others is not taken.
    pub preset: Preset,
    /// The share that is done, in per cent.
    pub percent: u8,
}

/// The distances of the points from the curve of a preset, in σ.
#[derive(Debug, Clone)]
pub struct Distances {
    pub id: u64,
    pub preset: Preset,
    pub found: Result<(Abscissa, Vec<Residual>), String>,
}

impl FitWish {
    /// Fits the free keys.
    pub fn fit(&self, progress: &dyn Progress) -> Result<Arc<Fit>, Reason> {
        let free = self.preset.data.free().map(str::to_owned).collect();
        let options = Options { free, ..Options::default() };
        fit_own(&self.preset, &options, progress).map(Arc::new).map_err(|error| {
            let can_be_mended = !matches!(error, FitError::NoStart | FitError::Cancelled);
            Reason { text: format!("not fitted: {error}"), can_be_mended }
        })
    }

    /// Finds the distances.
    pub fn distances(&self) -> Distances {
        let found = residuals_own(&self.preset).map_err(|error| error.to_string());
        Distances { id: self.id, preset: self.preset.clone(), found }
    }
}

/// The dotted key that a name in `data.free` means.
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
#[must_use]
pub fn is_free(preset: &Preset, key: &str) -> bool {
    preset.data.free().any(|name| name == key || named(preset, name).as_deref() == Some(key))
}
