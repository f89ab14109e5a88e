//! The smallest amplitude of a wave at which a preset snaps at all, with its own adhesion, device and start.

use super::axis::MapAxis;
use super::count::{Cause, EXACTLY};
use super::family::{Family, FamilyError};
use crate::elementary::pow;
use crate::preset::Preset;
use crate::problem::Adhesion;
use crate::progress::Progress;

/// The group that is varied, and its range.
const GROUP: &str = "groups.amplitude_over_wavelength";
const RANGE: [f64; 2] = [0.0, 0.5];

/// Besides at the cusps, the snaps are counted at this many amplitudes in equal factors over this many decades.
const SAMPLES: i32 = 40;
const DECADES: f64 = 4.0;

/// Just before and just after a cusp, as a share of its amplitude.
const BESIDE: f64 = 1e-7;

/// Where snaps begin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Onset {
    /// A/λ.
    pub amplitude_over_wavelength: f64,
    /// Its cause.
    pub cause: Cause,
}

impl Onset {
    /// The onset of `preset`. `None` for a gap without a single wave, without adhesion, for adhesion with a range, and
    /// if nothing snaps up to A/λ = 0.5.
    ///
    /// # Errors
    /// The gap cannot be tabulated, or the path has no start state.
    pub fn of(preset: &Preset, progress: &dyn Progress) -> Result<Option<Self>, FamilyError> {
        let has_range = preset.material.adhesion != Adhesion::ShortRange;
        if preset.get(GROUP).is_none() || preset.material.work_of_adhesion <= 0.0 || has_range {
            return Ok(None);
        }
        let Ok(axis) = MapAxis::new(GROUP, RANGE, false, 1.0) else { return Ok(None) };
        let family = Family::new(preset, vec![axis])?;
        let mut samples: Vec<f64> = (0..=SAMPLES)
            .map(|k| pow(10f64, -DECADES * (1.0 - f64::from(k) / f64::from(SAMPLES))))
            .chain([0.0])
            .collect();
        for [_, share] in family.births()? {
            samples.extend([share * (1.0 - BESIDE), share * (1.0 + BESIDE)]);
        }
        samples.retain(|share| (0.0..=1.0).contains(share));
        samples.sort_by(f64::total_cmp);
        // Only as far as the first sample with a snap: the onset lies before it.
        let snaps = |share: &f64| family.passage(&[*share]).is_some_and(|passage| passage.snaps > 0);
        let Some(first) = samples.iter().position(|share| progress.stop() || snaps(share)) else {
            return Ok(None);
        };
        let from = first.saturating_sub(1);
        let changes = family.changes(0, &[0.0], &samples[from..=first], EXACTLY, progress);
        let change = changes.into_iter().find(|change| change.snaps[0] == 0 && change.snaps[1] > 0);
        Ok(change.map(|change| Self {
            amplitude_over_wavelength: family.axes[0].value(change.share),
            cause: change.cause,
        }))
    }
}
