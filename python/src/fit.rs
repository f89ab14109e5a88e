//! A problem fitted to a measured curve.

use crate::document::{Document, Report};
use crate::errors;
use crate::problem::Problem;
use crate::running::long;
use pulloff_engine::fit::{FitError, Options, fit_own};
use pulloff_engine::measured::{Asked, Source, Span};
use pulloff_engine::preset::{Invalid, Preset, Value as PresetValue, data as data_keys};
use pulloff_engine::report;
use pulloff_engine::report::fit::FitReport;
use pulloff_engine::report::residuals;
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

/// What is asked of a fit, by the names that Python gives it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
#[expect(clippy::struct_excessive_bools, reason = "each is an argument of its own")]
pub struct Wanted {
    columns: Option<String>,
    segment: Option<String>,
    free_part: Option<String>,
    signs: Option<String>,
    skip: u32,
    free: Option<Vec<String>>,
    uncertain: Option<String>,
    separate: bool,
    robust: bool,
    sigma: [Option<f64>; 2],
    x_range: Option<[f64; 2]>,
    force_range: Option<[f64; 2]>,
    scan: bool,
    profile: bool,
    bootstrap: Option<(usize, u64)>,
    poisson: Option<f64>,
}

impl Wanted {
    /// The options of a fit to the points of `preset`.
    fn options(&self, preset: &Preset) -> Options {
        let span = |range: [f64; 2]| Span { lo: range[0], hi: range[1] };
        let asked = Asked {
            sigma: [self.sigma[0], self.sigma[1], None],
            x: self.x_range.map(span),
            force: self.force_range.map(span),
            ..Asked::default()
        };
        let own = || preset.data.free().map(str::to_owned).collect();
        Options {
            free: self.free.clone().unwrap_or_else(own),
            separate: self.separate,
            robust: self.robust,
            asked,
            scan: self.scan,
            profile: self.profile,
            bootstrap: self.bootstrap,
        }
    }
}

/// The fit of `problem` to `data`, the name and the text of a table, or to its own measured curve: the document, the fitted
/// problem, how it ended, what is not determined, and the points beside it as CSV.
#[pyfunction]
pub fn fitted(
    py: Python<'_>,
    problem: &Bound<'_, Problem>,
    data: Option<(String, Vec<u8>)>,
    wanted: Wanted,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Document, Problem, &'static str, Option<String>, String)> {
    let mut preset = problem.get().preset.clone();
    let own = preset.data.source.as_ref().map(|source| source.name.clone());
    let name = data.as_ref().map(|(name, _)| name.clone()).or(own).unwrap_or_else(|| "data".to_owned());
    let refused = |error: &dyn std::fmt::Display| errors::of_data(py, &format!("{name}: {error}"));
    let mut changes = Vec::new();
    if let Some((name, text)) = data {
        let source = Source::new(name, None, text.into());
        changes.push((data_keys::FILE, PresetValue::Points(Arc::new(source))));
    }
    // With the file that they are of, not with the one before.
    for (key, text) in [
        (data_keys::COLUMNS, &wanted.columns),
        (data_keys::SEGMENT, &wanted.segment),
        (data_keys::UNCERTAIN, &wanted.uncertain),
        (data_keys::FREE_PART, &wanted.free_part),
        (data_keys::SIGNS, &wanted.signs),
    ] {
        changes.extend(text.as_ref().map(|text| (key, PresetValue::Text(text.clone()))));
    }
    if wanted.skip > 0 {
        changes.push((data_keys::SKIP, PresetValue::Integer(wanted.skip.into())));
    }
    preset.set_all(changes).map_err(|invalid| match invalid {
        Invalid::Made { key, cause } if key == data_keys::FILE => errors::of_data(py, &cause),
        invalid => refused(&invalid),
    })?;
    let options = wanted.options(&preset);
    let made = long(py, progress, |progress| fit_own(&preset, &options, progress))?;
    let made = made.map_err(|error| match error {
        FitError::NoStart | FitError::Cancelled => errors::of_fit(py, &error.to_string()),
        FitError::NothingFree => errors::of_data(
            py,
            "nothing is free: name the keys to fit, as in free=[\"material.effective_modulus\"], or in data.free",
        ),
        FitError::NoData => {
            errors::of_data(py, "the problem has no measured curve of its own: give data, or set data.file")
        }
        error => refused(&error),
    })?;
    let report = FitReport::new(&name, &made, wanted.poisson);
    let (ended, direction) = (report.ended, report.direction.clone());
    let beside = residuals::csv(&report.residuals);
    Ok((Document::new(report), Problem { preset: made.preset }, ended, direction, beside))
}
