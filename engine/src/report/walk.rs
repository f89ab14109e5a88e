//! The states that a person walked through, as a document.

use super::Head;
use super::columns::columns;
use super::path::EventReport;
use super::trace::StableReport;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// A walk by hand.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct WalkReport {
    /// The head of the document.
    #[serde(flatten)]
    pub head: Head,
    /// What to be careful about.
    pub warnings: Vec<String>,
    /// What else is worth knowing.
    pub notes: Vec<String>,
    /// The states in order; left out where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<WalkRow>,
    /// The events of the path, where these were asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<EventReport>,
}

/// One state of the walk as a row.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct WalkRow {
    /// Its number, from 0.
    pub step: usize,
    /// How the walker came to it.
    pub kind: &'static str,
    /// What was controlled.
    pub control: String,
    /// s.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// U.
    pub energy: f64,
    /// The crest at the contact radius; null for a gap without waves.
    pub wave: Option<u64>,
    /// The Newton steps that led to it.
    pub newton_iterations: usize,
    /// Whether it is stable.
    pub stable: StableReport,
    /// The energy lost in the jump that led here.
    pub dissipated: Option<f64>,
    /// The same by area.
    pub dissipated_by_area: Option<f64>,
    /// γ when it was solved: parameters may change during a walk.
    pub work_of_adhesion: f64,
    /// R when it was solved, where the gap has one.
    pub radius_of_curvature: Option<f64>,
    /// A when it was solved.
    pub amplitude: Option<f64>,
    /// λ when it was solved.
    pub wavelength: Option<f64>,
    /// Whether it is admissible; null once the bodies are apart.
    pub admissible: Option<bool>,
    /// The keys that changed during the walk, with their values here; null where the preset had none.
    #[serde(flatten)]
    pub changed: BTreeMap<String, Value>,
}

/// The columns of the walk as CSV; after them come the keys that changed during it.
pub const WALK_COLUMNS: &[&str] = columns!(
    step kind control contact_radius approach force energy wave newton_iterations stable_displacement
    stable_force stable_chosen dissipated dissipated_by_area work_of_adhesion radius_of_curvature amplitude
    wavelength admissible
);
