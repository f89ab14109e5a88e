//! The energy release rate of measured rows and the speed of the edge there, computed in the background when looked at.

use super::background::{Background, Tell, Want, Watcher};
use super::fitting::NO_POINTS;
use super::model::Model;
use super::view::View;
use pulloff_engine::preset::Preset;
use pulloff_engine::progress::Progress;
use pulloff_engine::report::SpeedsReport;
use pulloff_engine::report::speeds::UNTIMED;

/// The rows of the measured curve of a preset, or why there are none.
#[derive(Debug, Clone)]
pub struct SpeedsData {
    pub preset: Preset,
    pub report: Result<SpeedsReport, String>,
}

impl SpeedsData {
    /// Computes them; `None` if it was stopped.
    pub fn of(preset: &Preset, progress: &dyn Progress) -> Option<Self> {
        let report = SpeedsReport::compute(preset, None, progress).map_err(|error| error.to_string());
        (!progress.stop()).then(|| Self { preset: preset.clone(), report })
    }
}

impl Background for SpeedsData {
    type Key = Preset;
    const NAME: &'static str = "speeds";

    fn wanted(model: &Model) -> Want<Preset> {
        let is_shown = model.shown_views().contains(&View::Speeds) && untimed(&model.preset).is_none();
        if is_shown { Want::Now(model.preset.clone()) } else { Want::Later }
    }

    fn is_same(asked: &Preset, wanted: &Preset) -> bool {
        // The law of adhesion does not enter.
        let Preset { material, edge, .. } = wanted;
        let mut asked = Preset { edge: edge.clone(), title: wanted.title.clone(), ..asked.clone() };
        asked.material.work_of_adhesion = material.work_of_adhesion;
        asked == *wanted
    }

    fn is_of(&self, wanted: &Preset) -> bool {
        Self::is_same(&self.preset, wanted)
    }

    fn compute(preset: &Preset, progress: Watcher<'_>, _: Tell<'_, Self>) -> Option<Self> {
        Self::of(preset, progress)
    }
}

/// Why the rows of a preset have no speeds; `None` if they have.
pub fn untimed(preset: &Preset) -> Option<String> {
    let branches = match preset.branches() {
        None => return Some(NO_POINTS.to_owned()),
        Some(Err(why)) => return Some(why),
        Some(Ok(branches)) => branches,
    };
    let mut rows = branches.list.iter().flat_map(|branch| &branch.attached);
    let is_timed = rows.any(|row| row.time.is_finite());
    (!is_timed).then(|| UNTIMED.to_owned())
}
