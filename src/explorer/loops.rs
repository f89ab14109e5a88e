//! The whole loop of loading and unloading, computed in the background for gaps with more than one crest.
//!
//! It takes longer than the curve, which never waits for it. While values are turned the loop on the screen may be that of
//! values before: it says so.

use super::curve::CurveData;
use super::setting::same_curve;
use crate::mend::Reason;
use pulloff_engine::case::{Case, CaseError};
use pulloff_engine::preset::Preset;
use pulloff_engine::progress::Progress;
use pulloff_engine::quasistatic::admissible::falls;
use pulloff_engine::quasistatic::path::{Losses, Setting};
use pulloff_engine::report::PathReport;
use std::sync::Arc;

/// A loop that is wanted.
#[derive(Debug, Clone)]
pub struct LoopWish {
    pub id: u64,
    /// The preset with its control and its turn.
    pub preset: Preset,
    /// The curve of the same problem.
    pub curve: Arc<CurveData>,
    /// Whether the person looks at the loop itself: a script computes no other.
    pub is_shown: bool,
}

/// A loop, or why there is none.
#[derive(Debug, Clone)]
pub struct LoopData {
    /// The number it was asked for under.
    pub id: u64,
    pub preset: Preset,
    pub report: Result<PathReport, Reason>,
}

impl LoopWish {
    /// Computes it; `None` when `progress` said stop.
    #[must_use]
    pub fn run(&self, progress: &dyn Progress) -> Option<LoopData> {
        let base = &self.curve.case;
        let units = base.units();
        let turn = self.preset.path.turn;
        let turn = turn.map(|turn| turn.in_units(1.0 / units.length, 1.0 / units.force, base.control));
        let case = Case { turn, ..base.clone() };
        let setting = Setting { losses: Losses::Once, ..case.setting() };
        let report = match case.cycle(None, &setting, progress) {
            Err(CaseError::Cancelled) => return None,
            Err(error) => Err(Reason::of("", &error)),
            Ok(cycle) => Ok(PathReport::new(&self.preset, &case, &cycle)),
        };
        Some(LoopData { id: self.id, preset: self.preset.clone(), report })
    }
}

impl LoopData {
    /// Whether it is the loop of `preset`.
    #[must_use]
    pub fn is_of(&self, preset: &Preset) -> bool {
        same_loop(&self.preset, preset)
    }

    /// The loop.
    #[must_use]
    pub fn report(&self) -> Option<&PathReport> {
        self.report.as_ref().ok()
    }
}

/// Whether two presets have the same loop.
pub(super) fn same_loop(a: &Preset, b: &Preset) -> bool {
    let of = |preset: &Preset| (preset.path.control, preset.path.contact, preset.path.turn);
    same_curve(a, b) && of(a) == of(b)
}

/// Whether the gap of a curve has crests further out: else the loop is the first touch and the unloading.
#[must_use]
pub fn has_crests(curve: &CurveData) -> bool {
    let reduced = &curve.case.reduced;
    reduced.gap.wavelength().is_some() || falls(&reduced.gap, curve.case.start)
}
