//! The study of the selected value, computed while it is being looked at.

use super::background::{Background, Tell, Want, Watcher};
use super::command::Id;
use super::model::Model;
use super::studies::{StudyData, StudyWish, is_over, range, threads, values_of};
use super::view::View;
use pulloff_engine::preset::{Key, Value};

/// The key that a study varies, and the values it takes: those of the selected value.
/// Errors: Why it has no range, in words.
pub fn study_range(model: &Model) -> Result<(Key, Vec<Value>), String> {
    let Some((row, _)) = model.selected_knob() else { return Err("no value is selected".to_owned()) };
    if let Some(axis) = model.studied_over.as_ref().filter(|axis| is_over(axis, &row)) {
        return Ok(values_of(axis, &model.preset));
    }
    range(&model.preset, &row).map_err(|why| format!("{why}; select another in Problem"))
}

impl Background for StudyData {
    type Key = StudyWish;
    const NAME: &'static str = "study";
    const ONLY_NEWEST: bool = true;

    fn wanted(model: &Model) -> Want<StudyWish> {
        if !model.shown_views().contains(&View::Study) || model.is_computing() {
            return Want::Later;
        }
        let Ok((key, values)) = study_range(model) else { return Want::Later };
        let over = model.studied_over.clone().filter(|axis| *axis.key == *key);
        Want::Now(StudyWish { preset: model.preset.clone(), key, column: model.studied, values, over })
    }

    fn is_same(asked: &StudyWish, wanted: &StudyWish) -> bool {
        asked.is_like(wanted)
    }

    fn is_of(&self, wanted: &StudyWish) -> bool {
        self.wish.is_like(wanted)
    }

    fn compute(key: &StudyWish, progress: Watcher<'_>, told: Tell<'_, Self>) -> Option<Self> {
        key.run(threads(), progress, told)
    }

    /// Only for other surfaces: the values themselves are seen to arrive.
    fn says(model: &Model) -> Option<String> {
        let study = model.results.so_far::<Self>()?;
        (study.done() == study.outcomes.len())
            .then(|| format!("computing other surfaces; {} keeps those done", Id::Cancel.named()))
    }

    fn given_up(model: &mut Model) -> Option<String> {
        Self::says(model).map(|_| "the study keeps the surfaces it has".to_owned())
    }
}
