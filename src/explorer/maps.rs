//! The map of two numbers, or the limit points over one, computed while it is being looked at.
//!
//! Turning one of its numbers moves the preset on the map and requests nothing.

use super::background::{Background, Tell, Want, Watcher};
use super::command::Id;
use super::map_axes::MapAxes;
use super::model::Model;
use super::view::View;
use crate::mend::WordedFault;
use pulloff_engine::preset::Preset;
use pulloff_engine::progress::{Progress, Stopped};
use pulloff_engine::report::MapReport;
use pulloff_engine::report::map::MapError;
use pulloff_engine::stability::COMPLIANCE;

/// The columns and rows in which snaps are counted.
const CELLS: [u32; 2] = [32, 24];

/// A map that is wanted: its values and its axes.
pub type MapKey = (Preset, MapAxes);

/// A map, or why there is none.
#[derive(Debug, Clone)]
pub struct MapData {
    pub preset: Preset,
    pub axes: MapAxes,
    report: Result<MapReport, WordedFault>,
}

impl Background for MapData {
    type Key = MapKey;
    const NAME: &'static str = "map";

    fn wanted(model: &Model) -> Want<MapKey> {
        let is_shown = model.shown_views().contains(&View::Map);
        // One that was given up is computed again once it is shown again.
        if !is_shown && model.results.percent::<Self>().is_none() {
            return Want::Not;
        }
        if !is_shown || model.is_computing() {
            return Want::Later;
        }
        let axes = model.map_axes.clone().unwrap_or_else(|| MapAxes::usual(&model.preset));
        Want::Now((model.preset.clone(), axes))
    }

    fn is_same(asked: &MapKey, wanted: &MapKey) -> bool {
        asked == wanted
    }

    fn is_of(&self, (preset, axes): &MapKey) -> bool {
        self.is_over(preset, axes)
    }

    fn compute((preset, axes): &MapKey, progress: Watcher<'_>, _: Tell<'_, Self>) -> Option<Self> {
        Self::of(preset, axes, progress)
    }

    fn says(model: &Model) -> Option<String> {
        let percent = model.results.percent::<Self>()?;
        Some(format!("computing the map, {percent} %; {} cancels", Id::Cancel.named()))
    }

    fn given_up(model: &mut Model) -> Option<String> {
        Self::says(model).map(|_| {
            "the map is given up: it is computed when it is shown again, or with other axes".to_owned()
        })
    }
}

impl Model {
    /// The last map, or why there is none; `None` before the first one is there.
    pub fn map(&self) -> Option<Result<&MapReport, &str>> {
        let results = &self.results;
        let is_given_up =
            || results.asked::<MapData, MapKey>().is_some() && results.percent::<MapData>().is_none();
        results
            .found::<MapData>()
            .map(MapData::report)
            .or_else(|| is_given_up().then_some(Err("it was given up")))
    }
}

impl MapData {
    /// The map of a preset; `None` if `progress` asked to stop.
    pub fn of(preset: &Preset, axes: &MapAxes, progress: &dyn Progress) -> Option<Self> {
        let report = if preset.material.work_of_adhesion > 0.0 {
            match axes.ranges(preset) {
                Ok((x, y)) => match MapReport::compute(preset, x, &y, CELLS, progress) {
                    Err(MapError::Stopped(Stopped)) => return None,
                    found => found.map_err(|error| WordedFault::of("", &error)),
                },
                Err(why) => Err(WordedFault::mendable(why)),
            }
        } else {
            Err(WordedFault::mendable("a gap without adhesion has no limit points to follow"))
        };
        Some(Self { preset: preset.clone(), axes: axes.clone(), report })
    }

    /// The map.
    pub fn report(&self) -> Result<&MapReport, &str> {
        self.report.as_ref().map_err(|reason| reason.text.as_str())
    }

    /// Whether it is the map of `preset` over `axes`; the preset may be at another point of it.
    fn is_over(&self, preset: &Preset, axes: &MapAxes) -> bool {
        if self.axes != *axes {
            return false;
        }
        // Measured points do not affect it.
        let preset = &Preset { data: self.preset.data.clone(), ..preset.clone() };
        let Ok(report) = &self.report else { return self.preset == *preset };
        let mut moved = self.preset.clone();
        for axis in [&report.x, &report.y] {
            if axis.key == COMPLIANCE {
                moved.path.control = preset.path.control;
            }
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
