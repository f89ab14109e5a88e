//! A problem fitted to a measured curve.

use crate::document::{Document, Report};
use crate::errors;
use crate::problem::Problem;
use crate::running::long;
use pulloff_engine::fit::{AdhesionModel, FitError, Options, fit_models, fit_together};
use pulloff_engine::measured::{Asked, PointsFile, ValueRange};
use pulloff_engine::preset::{Invalid, Preset, Value as PresetValue, data as data_keys};
use pulloff_engine::progress::Stopped;
use pulloff_engine::report;
use pulloff_engine::report::fit::{FitReport, ModelsReport, ParameterReport, TogetherReport};
use pulloff_engine::report::residuals;
use pulloff_engine::report::rows::{ReportTable, RowsError};
use pulloff_engine::report::speeds::{MeasuredPair, SpeedsError, SpeedsReport};
use pulloff_engine::text::quote;
use pyo3::prelude::*;
use serde_json::Value;
use std::sync::Arc;

/// The result of a fit, in the order of [`fitted`].
type Fitted = (Document, Problem, &'static str, Option<String>, String, Option<String>);

/// The columns of a fit: one row for each value.
const COLUMNS: [&str; 5] = ["key", "value", "standard_error", "start", "unit"];

/// One row for each value.
fn table(values: &[ParameterReport]) -> ReportTable {
    let rows = values.iter().map(|parameter| {
        let error = parameter.standard_error.map_or(Value::Null, Value::from);
        vec![
            parameter.key.clone().into(),
            parameter.value.into(),
            error,
            parameter.start.into(),
            parameter.unit.into(),
        ]
    });
    ReportTable { columns: COLUMNS.map(str::to_owned).to_vec(), rows: rows.collect() }
}

impl Report for TogetherReport {
    fn json(&self) -> Result<String, serde_json::Error> {
        report::json(self)
    }

    fn table(&self) -> Result<ReportTable, RowsError> {
        Ok(table(&self.law))
    }

    fn warnings(&self) -> &[String] {
        self.doubts.as_slice()
    }
}

impl Report for FitReport {
    fn json(&self) -> Result<String, serde_json::Error> {
        report::json(self)
    }

    fn table(&self) -> Result<ReportTable, RowsError> {
        Ok(table(&self.parameters))
    }

    fn warnings(&self) -> &[String] {
        // Doubts about the fit are warnings too.
        self.doubts.as_slice()
    }
}

/// The arguments of a fit, under the names that Python gives them.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Wanted {
    columns: Option<String>,
    segment: Option<String>,
    free_part: Option<String>,
    signs: Option<String>,
    skip: u32,
    free: Option<Vec<String>>,
    uncertain: Option<String>,
    models: Vec<String>,
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
        let span = |range: [f64; 2]| ValueRange { lo: range[0], hi: range[1] };
        let asked = Asked {
            sigma: [self.sigma[0], self.sigma[1], None],
            x: self.x_range.map(span),
            force: self.force_range.map(span),
            ..Asked::default()
        };
        let own = || preset.data.free().map(str::to_owned).collect();
        Options {
            free: self.free.clone().unwrap_or_else(own),
            robust: self.robust,
            asked,
            scan: self.scan,
            profile: self.profile,
            bootstrap: self.bootstrap,
            ..Options::default()
        }
    }
}

/// The name of the points, and the preset of `problem` with `data`, the name and the text of a table, in place of its
/// own measured curve. The table is read as `reading` says: columns, segment, free part and signs.
fn attached(
    py: Python<'_>,
    problem: &Problem,
    data: Option<(String, Vec<u8>)>,
    reading: [&Option<String>; 4],
    skip: u32,
    uncertain: Option<&String>,
) -> PyResult<(String, Preset)> {
    let mut preset = problem.preset.clone();
    let own = preset.data.source.as_ref().map(|source| source.name.clone());
    let name = data.as_ref().map(|(name, _)| name.clone()).or(own).unwrap_or_else(|| "data".to_owned());
    let mut changes = Vec::new();
    if let Some((name, text)) = data {
        let source = PointsFile::new(name, None, text.into());
        changes.push((data_keys::FILE, PresetValue::Points(Arc::new(source))));
    }
    // Set together with the file they belong to, not with the previous one.
    let keys = [data_keys::COLUMNS, data_keys::SEGMENT, data_keys::FREE_PART, data_keys::SIGNS];
    let texts = keys.into_iter().zip(reading.map(Option::as_ref)).chain([(data_keys::UNCERTAIN, uncertain)]);
    changes.extend(texts.filter_map(|(key, text)| Some((key, PresetValue::Text(text?.clone())))));
    if skip > 0 {
        changes.push((data_keys::SKIP, PresetValue::Integer(skip.into())));
    }
    preset.set_all(changes).map_err(|invalid| match invalid {
        Invalid::Made { key, cause } if key == data_keys::FILE => errors::of_data(py, &cause),
        invalid => errors::of_data(py, &format!("{name}: {invalid}")),
    })?;
    Ok((name, preset))
}

/// G of the rows of `data`, or of the measured curve of `problem`, against the speed of their edge. `reading` gives the
/// columns, the branch used, the rows that are apart, and the signs; `of` gives the two columns from which G is
/// computed.
#[pyfunction]
pub fn speeds(
    py: Python<'_>,
    problem: &Bound<'_, Problem>,
    data: Option<(String, Vec<u8>)>,
    reading: [Option<String>; 4],
    skip: u32,
    of: Option<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Document> {
    let (name, preset) = attached(py, problem.get(), data, reading.each_ref(), skip, None)?;
    let names = MeasuredPair::ALL.map(MeasuredPair::name);
    let pair = MeasuredPair::ALL.into_iter().find(|pair| of.as_deref() == Some(pair.name()));
    if let Some(of) = of.filter(|_| pair.is_none()) {
        return Err(errors::of_data(
            py,
            &format!("of = \"{}\" is not one of {}", quote(&of), names.join(", ")),
        ));
    }
    let made = long(py, progress, |progress| SpeedsReport::compute(&preset, pair, progress))?;
    made.map(Document::new).map_err(|error| match error {
        SpeedsError::Case(error) => errors::of_case(py, &error),
        SpeedsError::NoData => {
            errors::of_data(py, "the problem has no measured curve of its own: give data, or set data.file")
        }
        error => errors::of_data(py, &format!("{name}: {error}")),
    })
}

/// The fit of `problem` to `data`, the name and the text of a table, or to its own measured curve: the document, the
/// fitted problem, how the fit ended, what is not determined, the points beside the fit as CSV, and, if several models
/// were fitted, the document that compares them.
#[pyfunction]
pub fn fitted(
    py: Python<'_>,
    problem: &Bound<'_, Problem>,
    data: Option<(String, Vec<u8>)>,
    wanted: Wanted,
    progress: Option<Py<PyAny>>,
) -> PyResult<Fitted> {
    let reading = [&wanted.columns, &wanted.segment, &wanted.free_part, &wanted.signs];
    let (name, preset) = attached(py, problem.get(), data, reading, wanted.skip, wanted.uncertain.as_ref())?;
    let options = wanted.options(&preset);
    let model = |word: &String| {
        AdhesionModel::of(word).ok_or_else(|| {
            let known = AdhesionModel::ALL.map(AdhesionModel::name).join(", ");
            errors::of_data(py, &format!("model = \"{}\" is not one of {known}", quote(word)))
        })
    };
    let models = wanted.models.iter().map(model).collect::<PyResult<Vec<AdhesionModel>>>()?;
    let made = long(py, progress, |progress| fit_models(&preset, &models, &options, progress))?;
    let made = made.and_then(|models| {
        let fit = models.best().map(|(fit, _)| fit.clone()).ok_or(FitError::NoStart)?;
        Ok((fit, models))
    });
    let (made, models) = made.map_err(|error| of_fit(py, &name, &error))?;
    let report = FitReport::new(&name, &made, wanted.poisson);
    let compared = ModelsReport::new(&name, &models, wanted.poisson);
    let compared = (models.fits.len() > 1).then(|| report::json(&compared)).transpose();
    let compared = compared.map_err(|error| errors::of_fit(py, &error.to_string()))?;
    let (ended, direction) = (report.ended, report.direction.clone());
    let beside = residuals::csv(&report.residuals);
    Ok((Document::new(report), Problem { preset: made.preset }, ended, direction, beside, compared))
}

/// Why the points called `name` could not be fitted.
fn of_fit(py: Python<'_>, name: &str, error: &FitError) -> PyErr {
    match error {
        FitError::NoStart | FitError::Stopped(Stopped) => errors::of_fit(py, &error.to_string()),
        FitError::NothingFree => errors::of_data(
            py,
            "nothing is free: name the keys to fit, as in free=[\"material.effective_modulus\"], or in data.free",
        ),
        FitError::NoData => {
            errors::of_data(py, "the problem has no measured curve of its own: give data, or set data.file")
        }
        error => errors::of_data(py, &format!("{name}: {error}")),
    }
}

/// One law fitted to the measured curves of `problems`: the document, the first problem with the law, and what is not
/// determined.
#[pyfunction]
pub fn fitted_together(
    py: Python<'_>,
    problems: Vec<Bound<'_, Problem>>,
    free: Option<Vec<String>>,
    robust: bool,
    scan: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Document, Problem, Option<String>)> {
    let presets: Vec<Preset> = problems.iter().map(|problem| problem.get().preset.clone()).collect();
    let Some(first) = presets.get(1).and(presets.first()) else {
        let text =
            format!("one law is fitted to two problems or more: the number given is {}", presets.len());
        return Err(errors::of_data(py, &text));
    };
    let free = free.unwrap_or_else(|| first.data.free().map(str::to_owned).collect());
    let name = |run: usize| {
        presets[run]
            .data
            .source
            .as_ref()
            .map_or_else(|| format!("problem {run}"), |source| source.name.clone())
    };
    let options = Options { free, robust, scan, ..Options::default() };
    let made = long(py, progress, |progress| fit_together(&presets, &options, progress))?;
    let made = made.map_err(|(run, error)| of_fit(py, &name(run), &error))?;
    let names: Vec<String> = (0..presets.len()).map(name).collect();
    let report = TogetherReport::new(&names, &made);
    let direction = report.direction.clone();
    Ok((Document::new(report), Problem { preset: made.preset }, direction))
}
