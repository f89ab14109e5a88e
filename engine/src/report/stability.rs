//! The law of stability over the contact radius as a document.

use super::columns::columns;
use super::map::EXACT;
use super::problem::Head;
use super::rows::{ReportTable, RowsError};
use crate::case::{Case, CaseError};
use crate::preset::{BasisSpec, Preset};
use crate::problem::Control;
use crate::progress::Progress;
use crate::stability::Law;
use serde::Serialize;

/// The work of adhesion at which a state is a limit point, an energy per area; null where the law is not known: on the
/// innermost part of the table, which holds no limit point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct CriticalReport {
    /// Under fixed grips.
    pub displacement: Option<f64>,
    /// Under a dead load.
    pub force: Option<f64>,
    /// Under the device of the preset.
    pub chosen: Option<f64>,
}

/// A contact radius.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "RowReport"))]
pub struct StabilityRow {
    /// `sample`; `minimum` or `maximum` of the law under the device of the preset, a cusp, where a pair of limit points is born;
    /// `corner`, where h'' jumps.
    pub kind: &'static str,
    /// s.
    pub contact_radius: f64,
    /// `γ_k(s)`: a state is stable where the work of adhesion is less.
    pub critical: CriticalReport,
}

/// The columns of the rows as CSV; they never change, new ones come after them.
pub const COLUMNS: &[&str] = columns!(
    kind contact_radius critical_displacement critical_force critical_chosen
);

/// The law of stability of one disc between the end and the start of a preset.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct StabilityReport {
    /// The head of the document.
    #[serde(flatten)]
    pub head: Head,
    /// What to be careful about.
    pub warnings: Vec<String>,
    /// What is controlled.
    pub control: Control,
    /// The work of adhesion of the preset, with which the law is compared.
    pub work_of_adhesion: f64,
    /// Equally spaced samples, cusps and corners, from the end outward.
    pub rows: Vec<StabilityRow>,
}

impl StabilityReport {
    /// The law of `preset` at `samples` equally spaced radii, at least 2, and at its cusps and corners.
    ///
    /// ```
    /// use pulloff_engine::report::StabilityReport;
    /// use pulloff_engine::{Unwatched, preset};
    ///
    /// let wavy = preset::read_shipped("fig-9").ok_or("no such preset")?;
    /// let law = StabilityReport::compute(&wavy, 200, &Unwatched)?;
    /// let is_unstable = |critical: Option<f64>| critical.is_some_and(|critical| critical < law.work_of_adhesion);
    /// assert!(law.rows.iter().any(|row| is_unstable(row.critical.displacement)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`CaseError`] when the preset cannot be made ready, or `progress` said stop.
    pub fn compute(preset: &Preset, samples: usize, progress: &dyn Progress) -> Result<Self, CaseError> {
        let case = Case::prepare(preset, progress)?;
        let panels = case.panels(progress)?;
        let units = case.units();
        let law = |control| Law { panels: panels.clone(), control };
        let own = law(case.control);
        let parts = samples.max(2) - 1;
        let radius = |k: usize| {
            let share = k as f64 / parts as f64;
            case.end * (1.0 - share) + case.start * share
        };
        let mut places: Vec<(f64, &'static str)> = (0..=parts).map(|k| (radius(k), "sample")).collect();
        let (cusps, corners) = own.cusps([case.end, case.start]);
        places.extend(
            cusps.iter().map(|c| (c.contact_radius, if c.is_minimum { "minimum" } else { "maximum" })),
        );
        places.extend(corners.iter().map(|s| (*s, "corner")));
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        let radii: Vec<f64> = places.iter().map(|place| place.0).collect();
        let over = |control| law(control).over(&radii);
        let [displacement, force, chosen] =
            [over(Control::Displacement), over(Control::Force), over(case.control)];
        let shown = |adhesion: f64| Some(adhesion * units.work_of_adhesion).filter(|x| x.is_finite());
        let row = |(k, (s, kind)): (usize, &(f64, &'static str))| StabilityRow {
            kind,
            contact_radius: s * units.length,
            critical: CriticalReport {
                displacement: shown(displacement[k]),
                force: shown(force[k]),
                chosen: shown(chosen[k]),
            },
        };
        let rows = places.iter().enumerate().map(row).collect();
        let mut warnings = case.warnings_of_problem(case.start);
        warnings.extend(case.warning_of_dead_band());
        if preset.basis != BasisSpec::Exact {
            warnings.push(EXACT.to_owned());
        }
        Ok(Self {
            head: Head::new("stability", preset, &case),
            warnings,
            control: preset.path.control,
            work_of_adhesion: preset.material.work_of_adhesion,
            rows,
        })
    }

    /// The rows under the names of their columns.
    ///
    /// # Errors
    /// As [`ReportTable::of`].
    pub fn table(&self) -> Result<ReportTable, RowsError> {
        ReportTable::of(COLUMNS, &self.rows)
    }
}
