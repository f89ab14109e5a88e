//! A problem fitted to a measured curve.

use crate::document::{Document, Report};
use crate::errors;
use crate::problem::Problem;
use crate::running::long;
use pulloff_engine::fit::{FitError, Options, fit_own};
use pulloff_engine::measured::{Asked, Source};
use pulloff_engine::preset::{Invalid, Value as PresetValue, data as data_keys};
use pulloff_engine::report;
use pulloff_engine::report::fit::FitReport;
use pulloff_engine::report::rows::{RowsError, Table};
use pyo3::prelude::*;
use serde_json::Value;
use std::sync::Arc;

/// The columns of a fit: a row for each value.
const COLUMNS: [&str; 5] = ["key", "value", "standard_error", "start", "unit"];

impl Report for FitReport {
    fn json(&self) -> Result<String, serde_json::Error> {
        report::json(self)
    }

    fn table(&self) -> Result<Table, RowsError> {
        let rows = self.parameters.iter().map(|parameter| {
            let error = parameter.standard_error.map_or(Value::Null, Value::from);
            vec![
                parameter.key.clone().into(),
                parameter.value.into(),
                error,
                parameter.start.into(),
                parameter.unit.into(),
            ]
        });
        Ok(Table { columns: COLUMNS.map(str::to_owned).to_vec(), rows: rows.collect() })
    }

    fn warnings(&self) -> &[String] {
        // What speaks against it is a warning too.
        self.doubts.as_slice()
    }
}

/// The fit of `problem` to the table `data`, the text of the file `name`; the document, the fitted problem, how it ended, and
/// what is not determined.
#[pyfunction]
#[expect(
    clippy::too_many_arguments,
    clippy::fn_params_excessive_bools,
    reason = "what Python asks for, by name there"
)]
pub fn fitted(
    py: Python<'_>,
    problem: &Bound<'_, Problem>,
    name: &str,
    data: &[u8],
    columns: Option<&str>,
    free: Vec<String>,
    separate: bool,
    robust: bool,
    sigma: [Option<f64>; 2],
    scan: bool,
    profile: bool,
    bootstrap: Option<(usize, u64)>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Document, Problem, &'static str, Option<String>)> {
    let mut preset = problem.get().preset.clone();
    let refused = |error: &dyn std::fmt::Display| errors::of_data(py, &format!("{name}: {error}"));
    let source = PresetValue::Points(Arc::new(Source::new(name.to_owned(), None, data.into())));
    let columns = columns.map(|columns| (data_keys::COLUMNS, PresetValue::Text(columns.to_owned())));
    // Together: the columns are those of this table, and not of the preset's own.
    let both = [(data_keys::FILE, source)].into_iter().chain(columns);
    preset.set_all(both).map_err(|invalid| match invalid {
        Invalid::Made { cause, .. } => errors::of_data(py, &cause),
        invalid => refused(&invalid),
    })?;
    let options = Options {
        free,
        separate,
        robust,
        asked: Asked { sigma: [sigma[0], sigma[1], None], ..Asked::default() },
        scan,
        profile,
        bootstrap,
    };
    let made = long(py, progress, |progress| fit_own(&preset, &options, progress))?;
    let made = made.map_err(|error| match error {
        FitError::NoStart | FitError::Cancelled => errors::of_fit(py, &error.to_string()),
        error => refused(&error),
    })?;
    let report = FitReport::new(name, &made, None);
    let (ended, direction) = (report.ended, report.direction.clone());
    Ok((Document::new(report), Problem { preset: made.preset }, ended, direction))
}
