//! The map of two numbers, computed in the background while it is looked at.
//!
//! Turning one of its two numbers moves the preset on it and asks for nothing.

use crate::mend::Reason;
use pulloff_engine::gap::Gap;
use pulloff_engine::preset::Preset;
use pulloff_engine::report::MapReport;
use pulloff_engine::report::map::{MapError, Ordinate};
use pulloff_engine::stability::{Axis, COMPLIANCE};

/// The groups on the axes, for a gap with one wave.
const AMPLITUDE: &str = "groups.amplitude_over_wavelength";
const ADHESIONS: [&str; 2] = ["groups.adhesion", "material.work_of_adhesion"];

/// Decades of adhesion on both sides of the preset's.
const DECADES: f64 = 1.0;

/// Columns and rows in which snaps are counted.
const CELLS: [u32; 2] = [32, 24];

/// A map that is wanted.
#[derive(Debug, Clone)]
pub struct MapWish {
    pub id: u64,
    pub preset: Preset,
}

/// A map, or why there is none.
#[derive(Debug, Clone)]
pub struct MapData {
    /// The number it was asked for under.
    pub id: u64,
    pub preset: Preset,
    report: Result<MapReport, Reason>,
}

impl MapWish {
    /// Computes it; `None` when `go_on`, which is asked often, said no.
    #[must_use]
    pub fn run(&self, go_on: &dyn Fn() -> bool) -> Option<MapData> {
        let found = axes(&self.preset)
            .map(|[x, y]| MapReport::compute(&self.preset, x, &Ordinate::Key(y), CELLS, go_on));
        let report = match found {
            Some(Err(MapError::Cancelled)) => return None,
            Some(found) => found.map_err(|error| Reason::of("", &error)),
            None => Err(Reason::mendable("a gap without adhesion has no limit points to follow")),
        };
        Some(MapData { id: self.id, preset: self.preset.clone(), report })
    }
}

impl MapData {
    /// The map.
    pub fn report(&self) -> Result<&MapReport, &str> {
        self.report.as_ref().map_err(|reason| reason.text.as_str())
    }

    /// Whether it is the map of `preset`, which may stand elsewhere on it.
    #[must_use]
    pub fn is_of(&self, preset: &Preset) -> bool {
        let Ok(report) = &self.report else { return self.preset == *preset };
        let mut moved = self.preset.clone();
        for axis in [&report.x, &report.y] {
            let number = preset.get(&axis.key).and_then(|value| value.as_number());
            let (Some(lo), Some(hi), Some(x)) = (axis.from, axis.to, number) else { continue };
            if !(lo..=hi).contains(&x) || moved.set(&axis.key, x.into()).is_err() {
                return false;
            }
        }
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a.abs().max(b.abs());
        moved == *preset
            || moved.path == preset.path
                && same(moved.material.work_of_adhesion, preset.material.work_of_adhesion)
                && moved
                    .gap
                    .wave()
                    .zip(preset.gap.wave())
                    .is_some_and(|(a, b)| same(a.0, b.0) && same(a.1, b.1))
                && moved.gap.radius_of_curvature() == preset.gap.radius_of_curvature()
    }
}

/// The axes of the map of `preset`: A/λ, or the compliance where there is no one wave, and the adhesion; `None` without
/// adhesion.
fn axes(preset: &Preset) -> Option<[Axis; 2]> {
    let number = |key: &str| preset.get(key).and_then(|value| value.as_number());
    let (key, adhesion) =
        ADHESIONS.iter().find_map(|key| Some((*key, number(key)?))).filter(|(_, x)| *x > 0.0)?;
    let factor = 10f64.powf(DECADES);
    let y = Axis::new(key, [adhesion / factor, adhesion * factor], true, 1.0).ok()?;
    let x = if let Some(amplitude) = number(AMPLITUDE) {
        let top = if amplitude > 0.0 { 2.0 * amplitude } else { 0.05 };
        Axis::new(AMPLITUDE, [0.0, top], false, 1.0)
    } else {
        let unit = preset.gap.reference_length() * preset.material.effective_modulus;
        Axis::new(COMPLIANCE, [0.0, f64::INFINITY], false, 1.0 / unit)
    };
    Some([x.ok()?, y])
}
