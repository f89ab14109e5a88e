//! Our numbers against theory, and against each other, as a document.

use super::SCHEMA;
use super::columns::columns;
use super::rows::{ReportTable, RowsError};
use crate::verify::{Group, VerifyRow};
use serde::Serialize;

/// A verification: one row per number.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct VerifyReport {
    /// The version of all documents.
    pub schema: u32,
    /// Which document it is.
    pub document: &'static str,
    /// The version of the program.
    pub program_version: &'static str,
    /// How many rows pass.
    pub passed: usize,
    /// How many rows there are.
    pub total: usize,
    /// The rows, those of a group together.
    pub rows: Vec<VerifiedRow>,
}

/// One number against theory, or against another of ours.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(rename = "RowReport"))]
pub struct VerifiedRow {
    /// What is compared, with the basis.
    pub group: String,
    /// What the difference is divided by.
    pub measure: &'static str,
    /// What the number is.
    pub what: String,
    /// The engine's number; null where it could not be computed.
    pub ours: Option<f64>,
    /// The exact number; null where ours stands beside another of ours.
    pub exact: Option<f64>,
    /// The other number of ours, where it is compared with that.
    pub other: Option<f64>,
    /// Whether it is compared with another of ours; the table has a heading for these.
    #[serde(skip)]
    pub is_own: bool,
    /// The difference, divided as `measure` says.
    pub difference: Option<f64>,
    /// The largest difference, without its sign, that passes.
    pub bound: f64,
    /// Whether it passes.
    pub passes: bool,
}

/// The columns of the rows.
pub const COLUMNS: &[&str] = columns!(group measure what ours exact other difference bound passes);

impl VerifyReport {
    /// The document of `groups`, or only of the rows whose group or name contains `only`, ignoring case.
    pub fn new(groups: &[Group], only: Option<&str>) -> Self {
        let wanted = only.map(str::to_lowercase);
        let is_wanted = |group: &Group, row: &VerifyRow| {
            wanted.as_ref().is_none_or(|wanted| {
                [&group.title, &row.what].into_iter().any(|text| text.to_lowercase().contains(wanted))
            })
        };
        let rows: Vec<VerifiedRow> = groups
            .iter()
            .flat_map(|group| group.rows.iter().map(move |row| (group, row)))
            .filter(|(group, row)| is_wanted(group, row))
            .map(|(group, row)| VerifiedRow::new(group, row))
            .collect();
        Self {
            schema: SCHEMA,
            document: "verify",
            program_version: env!("CARGO_PKG_VERSION"),
            passed: rows.iter().filter(|row| row.passes).count(),
            total: rows.len(),
            rows,
        }
    }

    /// The rows under the names of their columns.
    ///
    /// # Errors
    /// As [`ReportTable::of`].
    pub fn table(&self) -> Result<ReportTable, RowsError> {
        ReportTable::of(COLUMNS, &self.rows)
    }

    /// The count in words.
    pub fn verdict(&self) -> String {
        format!("{} of {} pass", self.passed, self.total)
    }
}

impl VerifiedRow {
    fn new(group: &Group, row: &VerifyRow) -> Self {
        let finite = |x: f64| x.is_finite().then_some(x);
        Self {
            group: group.title.clone(),
            measure: group.measure,
            what: row.what.clone(),
            ours: finite(row.ours),
            exact: finite(row.exact),
            other: row.other.and_then(finite),
            is_own: row.other.is_some(),
            difference: finite(row.difference),
            bound: row.bound,
            passes: row.passes(),
        }
    }
}
