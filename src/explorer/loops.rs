//! The whole loop of loading and unloading, computed in the background for gaps with more than one crest.
//!
//! It takes longer than the curve, which never waits for it. While values are being turned, the loop on the screen may
//! be that of earlier values; it then says so.

use super::background::{Background, Tell, Want, Watcher};
use super::curve::CurveData;
use super::effect::Effect;
use super::model::Model;
use super::setting::same_curve;
use super::view::View;
use crate::mend::WordedFault;
use pulloff_engine::case::{Case, CaseError};
use pulloff_engine::preset::Preset;
use pulloff_engine::problem::Begin;
use pulloff_engine::progress::Stopped;
use pulloff_engine::quasistatic::admissible::falls;
use pulloff_engine::quasistatic::path::{Losses, PathSetting};
use pulloff_engine::report::PathReport;
use std::sync::Arc;
use std::time::Duration;

/// A loop that is wanted.
#[derive(Debug, Clone)]
pub struct LoopKey {
    /// The preset with its control and its turn.
    pub preset: Preset,
    /// The curve of the same problem.
    pub curve: Arc<CurveData>,
    /// Whether the person is looking at the loop itself: a script computes no other.
    pub is_shown: bool,
}

/// A loop, or why there is none.
#[derive(Debug, Clone)]
pub struct LoopData {
    pub preset: Preset,
    pub report: Result<PathReport, WordedFault>,
}

impl Background for LoopData {
    type Key = LoopKey;
    const NAME: &'static str = "loop";
    const PATIENCE: Duration = Duration::from_millis(50);

    /// The loop of the present values, once their curve is there; if the gap has no crests, only when it is looked at.
    fn wanted(model: &Model) -> Want<LoopKey> {
        let curve = model.curve.as_ref().filter(|_| model.shows_its_curve() && !model.is_computing());
        let Some(curve) = curve.cloned() else { return Want::Later };
        // From apart, the loop is the path.
        let is_path = model.preset.path.begin == Begin::Apart;
        let is_shown = is_path || model.shown_views().into_iter().any(View::is_cycle);
        if !is_shown && !has_crests(&curve) {
            return Want::Not;
        }
        Want::Now(LoopKey { preset: model.preset.clone(), curve, is_shown })
    }

    fn is_same(asked: &LoopKey, wanted: &LoopKey) -> bool {
        // A script computes only a loop that is looked at, so it asks again for one that was not.
        same_loop(&asked.preset, &wanted.preset) && (asked.is_shown || !wanted.is_shown)
    }

    fn is_of(&self, wanted: &LoopKey) -> bool {
        same_loop(&self.preset, &wanted.preset)
    }

    fn is_for_scripts(key: &LoopKey) -> bool {
        key.is_shown
    }

    fn compute(key: &LoopKey, progress: Watcher<'_>, _: Tell<'_, Self>) -> Option<Self> {
        let base = &key.curve.case;
        let units = base.units();
        let turn = key.preset.path.turn;
        let turn = turn.map(|turn| turn.in_units(1.0 / units.length, 1.0 / units.force, base.control));
        let case = Case { turn, ..base.clone() };
        // Where the walk follows the loop, the loop is already known.
        if let (Begin::Apart, Some(Ok(along))) = (key.preset.path.begin, &key.curve.along) {
            let report = Ok(PathReport::new(&key.preset, &case, along));
            return Some(Self { preset: key.preset.clone(), report });
        }
        let setting = PathSetting { losses: Losses::Once, ..case.setting() };
        let report = match case.cycle(None, &setting, progress) {
            Err(CaseError::Stopped(Stopped)) => return None,
            Err(error) => Err(WordedFault::of("", &error)),
            Ok(cycle) => Ok(PathReport::new(&key.preset, &case, &cycle)),
        };
        Some(Self { preset: key.preset.clone(), report })
    }

    fn came(model: &mut Model, _: Arc<Self>) -> Vec<Effect> {
        model.event = model.event.min(model.log_lines().saturating_sub(1));
        Vec::new()
    }
}

impl Model {
    /// The loop of loading and unloading, if the gap has crests or it is looked at; it can be that of earlier values.
    pub fn cycle(&self) -> Option<&LoopData> {
        self.results.shown()
    }
}

impl LoopData {
    /// Whether it is the loop of `preset`.
    pub fn is_of_preset(&self, preset: &Preset) -> bool {
        same_loop(&self.preset, preset)
    }

    /// The loop.
    pub fn report(&self) -> Option<&PathReport> {
        self.report.as_ref().ok()
    }
}

/// Whether two presets have the same loop.
fn same_loop(a: &Preset, b: &Preset) -> bool {
    let of = |preset: &Preset| (preset.path.control, preset.path.contact, preset.path.turn);
    same_curve(a, b) && of(a) == of(b)
}

/// Whether the gap of a curve has crests further out; without them, the loop is the first touch and the unloading.
fn has_crests(curve: &CurveData) -> bool {
    let reduced = &curve.case.reduced;
    reduced.gap.wavelength().is_some() || falls(reduced.gap.as_ref(), curve.case.start)
}
