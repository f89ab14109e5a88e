//! A result: its JSON, exactly as the program writes it, and the columns of its CSV as arrays.

use crate::arrays::arrays_ready;
use crate::errors::in_python;
use numpy::PyArray1;
use pulloff_engine::report::rows::{ReportTable, RowsError};
use pulloff_engine::report::{
    self, MapReport, PathReport, PullReport, SpeedsReport, StabilityReport, TraceReport,
};
use pyo3::exceptions::{PyKeyError, PyRuntimeError};
use pyo3::prelude::*;
use serde_json::Value;
use std::sync::OnceLock;

/// What a result can give.
pub trait Report: Send + Sync {
    /// The document as JSON.
    fn json(&self) -> Result<String, serde_json::Error>;
    /// Its rows under the names of their columns.
    fn table(&self) -> Result<ReportTable, RowsError>;
    /// Its warnings.
    fn warnings(&self) -> &[String];
}

macro_rules! reports {
    ($($report:ty: $said:ident),*) => {
        $(impl Report for $report {
            fn json(&self) -> Result<String, serde_json::Error> {
                report::json(self)
            }

            fn table(&self) -> Result<ReportTable, RowsError> {
                Self::table(self)
            }

            fn warnings(&self) -> &[String] {
                &self.$said
            }
        })*
    };
}

reports!(
    TraceReport: warnings,
    PathReport: warnings,
    MapReport: notes,
    StabilityReport: warnings,
    PullReport: warnings,
    SpeedsReport: warnings
);

/// A result, immutable.
#[pyclass(frozen, module = "pulloff._engine")]
pub struct Document {
    report: Box<dyn Report>,
    table: OnceLock<ReportTable>,
}

impl Document {
    /// The result of a report.
    pub fn new(report: impl Report + 'static) -> Self {
        Self { report: Box::new(report), table: OnceLock::new() }
    }

    fn table(&self) -> PyResult<&ReportTable> {
        if let Some(table) = self.table.get() {
            return Ok(table);
        }
        let table = self.report.table().map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(self.table.get_or_init(|| table))
    }
}

#[pymethods]
impl Document {
    /// The document as JSON text.
    fn json(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| self.report.json()).map_err(|error| PyRuntimeError::new_err(error.to_string()))
    }

    /// The names of the columns.
    fn columns(&self) -> PyResult<Vec<String>> {
        Ok(self.table()?.columns.clone())
    }

    /// Its warnings.
    fn warnings(&self) -> Vec<String> {
        self.report.warnings().iter().map(|warning| in_python(warning).into_owned()).collect()
    }

    /// A column as an array; a column of texts as a list, with None for missing cells.
    fn column<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let table = self.table()?;
        let at = table.columns.iter().position(|column| column == name);
        let at = at.ok_or_else(|| PyKeyError::new_err(name.to_owned()))?;
        array(py, name, table.rows.iter().map(|row| &row[at]))
    }
}

/// Columns of true and false.
const FLAGS: [&str; 5] = ["stable_displacement", "stable_force", "stable_chosen", "admissible", "changes"];
/// Columns of whole numbers.
const WHOLE: [&str; 7] = ["step", "newton_iterations", "number", "row", "window", "tension_peaks", "snaps"];
/// Columns of texts.
const TEXTS: [&str; 6] = ["kind", "direction", "segment", "stable", "key", "unit"];

/// The cells of a column by its name, whatever its rows are: true or false, whole numbers, texts, otherwise numbers
/// with NaN for missing ones. Texts, and flags of which some are unknown, become a list with None for missing ones.
fn array<'py, 'a>(
    py: Python<'py>,
    name: &str,
    cells: impl Iterator<Item = &'a Value> + Clone,
) -> PyResult<Bound<'py, PyAny>> {
    arrays_ready(py)?;
    if TEXTS.contains(&name) {
        return Ok(cells.map(Value::as_str).collect::<Vec<_>>().into_pyobject(py)?.into_any());
    }
    if FLAGS.contains(&name) {
        let flags: Vec<Option<bool>> = cells.map(Value::as_bool).collect();
        return match flags.iter().copied().collect::<Option<Vec<bool>>>() {
            Some(flags) => Ok(PyArray1::from_vec(py, flags).into_any()),
            None => Ok(flags.into_pyobject(py)?.into_any()),
        };
    }
    if WHOLE.contains(&name) {
        return Ok(PyArray1::from_iter(py, cells.filter_map(Value::as_i64)).into_any());
    }
    Ok(PyArray1::from_iter(py, cells.map(|cell| cell.as_f64().unwrap_or(f64::NAN))).into_any())
}
