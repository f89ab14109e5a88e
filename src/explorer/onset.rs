//! The smallest A/λ at which a problem snaps at all, found behind its curve and kept while only the amplitude is turned.

use pulloff_engine::gap::Shape;
use pulloff_engine::preset::Preset;
use pulloff_engine::progress::Progress;
use pulloff_engine::stability::Onset;

/// Where snaps begin for the adhesion, device and start of a preset.
#[derive(Debug, Clone)]
pub struct SnapsFrom {
    preset: Preset,
    /// A/λ; `None` for a gap without one wave, and where nothing snaps.
    pub amplitude_over_wavelength: Option<f64>,
}

impl SnapsFrom {
    /// Finds it; `None` when `progress` said stop.
    #[must_use]
    pub fn find(preset: &Preset, progress: &dyn Progress) -> Option<Self> {
        // A start that some amplitude does not have is the curve's to tell.
        let onset = Onset::of(preset, progress).ok().flatten();
        let amplitude_over_wavelength = onset.map(|onset| onset.amplitude_over_wavelength);
        (!progress.stop()).then(|| Self { preset: preset.clone(), amplitude_over_wavelength })
    }

    /// Whether it is that of `preset`, whose amplitude and basis may be others.
    #[must_use]
    pub fn is_of(&self, preset: &Preset) -> bool {
        let waves = match (&self.preset.gap, &preset.gap) {
            (
                Shape::WavySphere { radius_of_curvature: a, wavelength: b, .. },
                Shape::WavySphere { radius_of_curvature: c, wavelength: d, .. },
            ) => (a, b) == (c, d),
            (a, b) => a == b,
        };
        waves && self.preset.material == preset.material && self.preset.path == preset.path
    }
}
