//! The smallest A/λ at which a problem snaps at all, computed after its curve and kept while only the amplitude is
//! turned.

use super::background::{Background, Tell, Want, Watcher};
use super::model::Model;
use pulloff_engine::gap::Shape;
use pulloff_engine::preset::Preset;
use pulloff_engine::stability::Onset;

/// Where snaps begin for the adhesion, device and start of a preset.
#[derive(Debug, Clone)]
pub struct FirstSnap {
    preset: Preset,
    /// A/λ; `None` for a gap that does not have exactly one wave, and where nothing snaps.
    pub amplitude_over_wavelength: Option<f64>,
}

impl Background for FirstSnap {
    type Key = Preset;
    const NAME: &'static str = "onset";

    /// Computed after the curve and the check of its admissibility.
    fn wanted(model: &Model) -> Want<Preset> {
        let is_checked = model.curve.as_ref().is_some_and(|curve| curve.is_checked());
        if is_checked && !model.is_computing() { Want::Now(model.preset.clone()) } else { Want::Later }
    }

    fn is_same(asked: &Preset, wanted: &Preset) -> bool {
        is_alike(asked, wanted)
    }

    fn is_of(&self, wanted: &Preset) -> bool {
        is_alike(&self.preset, wanted)
    }

    fn compute(preset: &Preset, progress: Watcher<'_>, _: Tell<'_, Self>) -> Option<Self> {
        // If the start does not exist at some amplitude, the curve reports it.
        let onset = Onset::of(preset, progress).ok().flatten();
        let amplitude_over_wavelength = onset.map(|onset| onset.amplitude_over_wavelength);
        (!progress.stop()).then(|| Self { preset: preset.clone(), amplitude_over_wavelength })
    }
}

/// Whether two presets differ at most in amplitude and basis.
fn is_alike(one: &Preset, other: &Preset) -> bool {
    let waves = match (&one.gap, &other.gap) {
        (
            Shape::WavySphere { radius_of_curvature: a, wavelength: b, .. },
            Shape::WavySphere { radius_of_curvature: c, wavelength: d, .. },
        ) => (a, b) == (c, d),
        (a, b) => a == b,
    };
    waves && one.material == other.material && one.path == other.path
}

impl Model {
    /// The smallest A/λ at which the problem snaps, if known.
    pub fn first_snap(&self) -> Option<f64> {
        let found = self.results.found::<FirstSnap>();
        found.filter(|found| is_alike(&found.preset, &self.preset))?.amplitude_over_wavelength
    }
}
