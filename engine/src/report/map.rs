//! Maps of two numbers, and limit points over one, as a document.

use super::columns::columns;
use super::problem::Head;
use super::rows::{ReportTable, RowsError};
use crate::case::Case;
use crate::preset::{BasisSpec, Preset};
use crate::problem::{Control, Units};
use crate::progress::{Progress, ProgressPart, Stopped};
use crate::stability::axis::COMPLIANCE;
use crate::stability::{Counts, Family, FamilyError, Folds, Map, MapAxis, MapPoint, Onset, Sort, Spacing};
use serde::Serialize;

/// What stands on the ordinate.
#[derive(Debug, Clone, PartialEq)]
pub enum Ordinate {
    /// Another number of the preset.
    Key(MapAxis),
    /// The controlled quantity at a limit point: δ, P, or Δ.
    Control,
    /// δ.
    Approach,
    /// P.
    Force,
}

impl Ordinate {
    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Self::Key(axis) => &axis.key,
            Self::Control => "control",
            Self::Approach => "approach",
            Self::Force => "force",
        }
    }
}

/// A point of a line, in the user's units.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "RowReport"))]
pub struct MapRow {
    /// The number of its line, from 1; a cusp, swallowtail or landing on a line has the number of that line where it is known.
    pub line: Option<usize>,
    /// `fold`, `cusp`, `swallowtail`, `landing`, `start` or `change`: a count that changes for some other reason, from cell to cell.
    pub kind: &'static str,
    /// The crest at which the limit point is, counted from the axis; null without a wave.
    pub crest: Option<u32>,
    /// s.
    pub contact_radius: f64,
    /// The number on the x axis; null where it is infinite, the compliance of a dead load.
    pub x: Option<f64>,
    /// What stands on the y axis.
    pub y: Option<f64>,
    /// δ, P or Δ at the limit point.
    pub control: f64,
    /// For a fold, the side on which the states are stable, `outward` or `inward`; null for the others.
    pub stable: Option<&'static str>,
    /// For a line of a map, whether the number of snaps differs on its two sides; null for the others.
    pub changes: Option<bool>,
}

/// The columns of the points as CSV; they never change, new ones come after them.
pub const COLUMNS: &[&str] = columns!(line kind crest contact_radius x y control stable changes);

/// One axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct AxisReport {
    /// The key, the group, `compliance`, or `control`, `approach`, `force`.
    pub key: String,
    /// Where it begins and ends; null where it follows from the curves, or has no end.
    pub from: Option<f64>,
    /// Its end.
    pub to: Option<f64>,
    /// Whether its steps are equal factors.
    pub logarithmic: bool,
    /// The value in the middle of a compliance that goes on to infinity; null elsewhere.
    pub middle: Option<f64>,
}

impl AxisReport {
    fn of(axis: &MapAxis) -> Self {
        let end = |x: f64| Some(x).filter(|x| x.is_finite());
        Self {
            key: axis.key.clone(),
            from: end(axis.range[0]),
            to: end(axis.range[1]),
            logarithmic: axis.spacing == Spacing::Logarithmic,
            middle: if let Spacing::Share(unit) = axis.spacing { Some(unit) } else { None },
        }
    }
}

/// The number of snaps over a grid.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct CountsReport {
    /// The numbers of the columns; null for infinity.
    pub x: Vec<Option<f64>>,
    /// The numbers of the rows.
    pub y: Vec<Option<f64>>,
    /// The snaps without the pull-off, one list for each row; null where there is no path.
    pub snaps: Vec<Vec<Option<usize>>>,
}

/// Where snaps begin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct OnsetReport {
    /// The smallest A/λ at which the preset snaps, with its own adhesion, device and start.
    pub amplitude_over_wavelength: f64,
    /// What is controlled.
    pub control: Control,
}

/// A map or fold curves.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct MapReport {
    /// The head of the document.
    #[serde(flatten)]
    pub head: Head,
    /// What is controlled; null where that changes over an axis.
    pub control: Option<Control>,
    /// The axes.
    pub x: AxisReport,
    /// The ordinate.
    pub y: AxisReport,
    /// Remarks on the lines.
    pub notes: Vec<String>,
    /// Where snaps begin; null for a gap without a wave, where there are none, and where an axis is the device.
    pub onset: Option<OnsetReport>,
    /// The points of the lines, line by line.
    pub rows: Vec<MapRow>,
    /// The snaps over the map; null for fold curves.
    pub counts: Option<CountsReport>,
}

/// The note for a preset with the basis of rings.
pub const EXACT: &str =
    "all numbers follow from the exact equation of one disc, whatever the basis of the preset";

/// Why there is no map.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapError {
    /// A family cannot be made.
    #[error(transparent)]
    Family(FamilyError),
    /// The preset cannot be computed.
    #[error(transparent)]
    Case(#[from] crate::case::CaseError),
    /// The map was no longer wanted.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl From<FamilyError> for MapError {
    fn from(error: FamilyError) -> Self {
        match error {
            FamilyError::Stopped(stopped) => Self::Stopped(stopped),
            error => Self::Family(error),
        }
    }
}

impl MapReport {
    /// The map of `preset` over `x` and `y`; with `cells` columns and rows of counts where both are numbers.
    ///
    /// ```
    /// use pulloff_engine::report::map::{MapReport, Ordinate};
    /// use pulloff_engine::{Unwatched, preset, stability::MapAxis};
    ///
    /// let wavy = preset::read_shipped("fig-9").ok_or("no such preset")?;
    /// let amplitudes = MapAxis::new("gap.amplitude", [1e-4, 4e-3], false, 1.0)?;
    /// let folds = MapReport::compute(&wavy, amplitudes, &Ordinate::Control, [0, 0], &Unwatched)?;
    /// assert!(folds.rows.iter().any(|row| row.kind == "cusp"), "where a pair of limit points is born");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`MapError`].
    pub fn compute(
        preset: &Preset,
        x: MapAxis,
        y: &Ordinate,
        cells: [u32; 2],
        progress: &dyn Progress,
    ) -> Result<Self, MapError> {
        let case = Case::prepare(preset, &ProgressPart::new(progress, [0.0, 0.1]))?;
        let is_device = |key: &str| key == COMPLIANCE || key.starts_with("path.control");
        let has_device = is_device(&x.key) || matches!(y, Ordinate::Key(axis) if is_device(&axis.key));
        let mut report = Self {
            head: Head::new("map", preset, &case),
            control: (!has_device).then_some(preset.path.control),
            x: AxisReport::of(&x),
            y: AxisReport {
                key: y.name().to_owned(),
                from: None,
                to: None,
                logarithmic: false,
                middle: None,
            },
            notes: Vec::new(),
            onset: None,
            rows: Vec::new(),
            counts: None,
        };
        if preset.basis != BasisSpec::Exact {
            report.notes.push(EXACT.to_owned());
        }
        report.notes.extend(case.warning_of_dead_band());
        let found = if has_device { None } else { Onset::of(preset, progress)? };
        report.onset = found.map(|onset| OnsetReport {
            amplitude_over_wavelength: onset.amplitude_over_wavelength,
            control: preset.path.control,
        });
        if let Ordinate::Key(axis) = y {
            report.y = AxisReport::of(axis);
            let mut family = Family::new(preset, vec![x, axis.clone()])?;
            let (map, counts) = family.map(cells, &ProgressPart::new(progress, [0.1, 1.0]))?;
            report.rows_of_map(&family, &map);
            report.counts = Some(CountsReport::of(&family, counts));
            report.notes.extend(map.notes);
        } else {
            let family = Family::new(preset, vec![x])?;
            let folds = family.folds(progress)?;
            report.rows_of_folds(&family, &folds, y);
        }
        progress.go_on()?;
        Ok(report)
    }

    /// The points under the names of their columns.
    ///
    /// # Errors
    /// As [`ReportTable::of`].
    pub fn table(&self) -> Result<ReportTable, RowsError> {
        ReportTable::of(COLUMNS, &self.rows)
    }

    /// The points as CSV.
    ///
    /// # Errors
    /// As [`ReportTable::csv`].
    pub fn csv(&self) -> Result<String, RowsError> {
        self.table()?.csv()
    }

    fn rows_of_map(&mut self, family: &Family, map: &Map) {
        for (number, line) in map.lines.iter().enumerate() {
            let kind = match line.sort {
                Some(Sort::Cusp) => "cusp",
                Some(Sort::Landing) => "landing",
                Some(Sort::Start | Sort::Arrival) => "start",
                Some(Sort::Fold) => "fold",
                None => "change",
            };
            let row = |point: &MapPoint, kind, changes| MapRow {
                line: Some(number + 1),
                kind,
                crest: line.crest,
                changes,
                ..MapRow::of(family, point)
            };
            let points = line.points.iter().enumerate();
            self.rows.extend(points.map(|(k, point)| row(point, kind, line.changes.get(k).copied())));
            self.rows.extend(line.tips.iter().map(|point| row(point, "swallowtail", None)));
        }
    }

    fn rows_of_folds(&mut self, family: &Family, folds: &Folds, y: &Ordinate) {
        let row = |point: &MapPoint| {
            let mut row = MapRow::of(family, point);
            let (_, units) = device(family, point);
            row.y = Some(match y {
                Ordinate::Approach => point.approach * units.length,
                Ordinate::Force => point.force * units.force,
                Ordinate::Control | Ordinate::Key(_) => row.control,
            });
            row
        };
        for (number, line) in folds.lines.iter().enumerate() {
            let stable = Some(if line.is_minimum { "outward" } else { "inward" });
            self.rows.extend(line.points.iter().map(|point| MapRow {
                line: Some(number + 1),
                crest: line.crest,
                stable,
                ..row(point)
            }));
        }
        let crest = |point: &MapPoint| family.crest(point.contact_radius);
        for (kind, points) in [("cusp", &folds.cusps), ("landing", &folds.landings)] {
            self.rows.extend(points.iter().map(|point| MapRow { kind, crest: crest(point), ..row(point) }));
        }
    }
}

/// The device at a point of a map, and the units there.
fn device(family: &Family, point: &MapPoint) -> (Control, Units) {
    family.member(&point.at[..family.axes.len()]).map_or_else(
        |_| (Control::Displacement, family.preset.problem().reduced_by(family.length).units),
        |member| (member.control, member.units),
    )
}

impl MapRow {
    fn of(family: &Family, point: &MapPoint) -> Self {
        let (device, units) = device(family, point);
        let value = |k: usize| {
            family.axes.get(k).map(|axis| axis.value(point.at[k])).filter(|value| value.is_finite())
        };
        let unit = if device == Control::Force { units.force } else { units.length };
        Self {
            line: None,
            kind: "fold",
            crest: None,
            contact_radius: point.contact_radius * units.length,
            x: value(0),
            y: value(1),
            control: device.value(point.approach, point.force) * unit,
            stable: None,
            changes: None,
        }
    }
}

impl CountsReport {
    fn of(family: &Family, counts: Counts) -> Self {
        let values = |k: usize| {
            let value = |share: &f64| Some(family.axes[k].value(*share)).filter(|value| value.is_finite());
            counts.shares[k].iter().map(value).collect()
        };
        Self { x: values(0), y: values(1), snaps: counts.cells }
    }
}
