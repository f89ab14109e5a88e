//! Many problems on all cores: the rows of a sweep as columns.

use crate::arrays::arrays_ready;
use crate::errors;
use crate::problem::Problem;
use crate::running::Listener;
use numpy::PyArray1;
use pulloff::store::FILES;
use pulloff::store::file::{LARGEST, read_text};
use pulloff::store::stream::is_stream;
use pulloff::sweep::record::{COUNTS, statistic};
use pulloff::sweep::run::rows;
use pulloff::sweep::{Existing, Means, Output, OutputError, Shard, SweepResults, ensemble, run};
use pulloff_engine::preset::read::read_in;
use pulloff_engine::preset::{Preset, Value, shipped};
use pulloff_engine::progress::Progress;
use pulloff_engine::sweep::axis::SweepAxis;
use pulloff_engine::sweep::ensemble::{STATISTICS, Statistics, at_points};
use pulloff_engine::sweep::spec::{Design, points, values};
use pulloff_engine::sweep::{Cell, MeasuredQuantities, QUANTITIES, Spec};
use pulloff_engine::text::{quote, show_path};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The name, the SI unit and the meaning of every quantity, and whether it depends on the control.
#[pyfunction]
pub fn quantities() -> Vec<(&'static str, &'static str, &'static str, bool)> {
    let row = |quantity: &'static pulloff_engine::sweep::SweepQuantity| {
        (quantity.name, quantity.unit.si().unwrap_or("1"), quantity.meaning, quantity.is_of_control())
    };
    QUANTITIES.iter().map(row).collect()
}

/// The preset of a spec: one that comes with the package, or a file relative to `folder`.
fn preset(folder: &Path, name: &str, set: &[&str]) -> Result<Preset, String> {
    let is_path = name.contains('/') || Path::new(name).extension().is_some_and(|end| end == "toml");
    if is_path {
        let path = folder.join(name);
        let (text, _) = read_text(&path, LARGEST).map_err(|error| error.to_string())?;
        return read_in(FILES, path.parent(), name, &text, set).map_err(|error| error.to_string());
    }
    let found = shipped::find(name).ok_or_else(|| {
        format!(
            "no preset that comes with the package is called \"{}\"; a file has a '/' or ends in .toml",
            quote(name)
        )
    })?;
    read_in(FILES, None, name, found.text, set).map_err(|error| error.to_string())
}

/// The problem used instead of a preset, with the assignments of the spec.
fn assigned(problem: &Preset, set: &[&str]) -> Result<Preset, String> {
    let mut preset = problem.clone();
    for assignment in set {
        let (key, text) =
            assignment.split_once('=').ok_or_else(|| "an assignment must be KEY=VALUE".to_owned())?;
        preset.assign(key.trim(), text.trim()).map_err(|error| error.to_string())?;
    }
    Ok(preset)
}

/// Where the rows go, and which rows they are.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Wanted {
    jobs: usize,
    shard: Option<String>,
    row_limit: Option<f64>,
    out: Option<PathBuf>,
    resume: bool,
    overwrite: bool,
}

/// Rows as they are handed over: their numbers, the cells of each column, and their faults.
#[derive(Default)]
struct Rows {
    numbers: Vec<u64>,
    columns: Vec<Vec<f64>>,
    faults: Vec<Option<String>>,
}

/// Columns by name, and the keys of the axes.
type Columns<'py> = (Bound<'py, PyDict>, Vec<String>);
/// The rows of a sweep, the statistics of an ensemble, and the interrupt that ended it early.
type Swept<'py> = (Columns<'py>, Option<Columns<'py>>, Option<PyErr>);

/// The rows of the spec `text` as columns. `problem`, if given, replaces its preset.
#[pyfunction]
pub fn sweep<'py>(
    py: Python<'py>,
    text: &str,
    folder: PathBuf,
    problem: Option<&Bound<'py, Problem>>,
    wanted: Wanted,
    progress: Option<Py<PyAny>>,
) -> PyResult<Swept<'py>> {
    let given = problem.map(|problem| problem.get().preset.clone());
    let presets = |name: &str, set: &[&str]| match &given {
        Some(problem) => assigned(problem, set),
        None => preset(&folder, name, set),
    };
    let spec = Spec::read(&presets, "spec", text).map_err(|error| errors::of_spec(py, &error))?;
    let shard = wanted.shard.as_deref().map_or(Ok(Shard::WHOLE), str::parse);
    let shard: Shard = shard.map_err(|error| errors::of_shard(py, &format!("shard: {error}")))?;
    let row_limit = wanted.row_limit.map(Duration::try_from_secs_f64).transpose();
    let row_limit = row_limit.map_err(|error| errors::of_shard(py, &format!("row_limit: {error}")))?;
    let means = Means { jobs: wanted.jobs, row_limit };
    let (made, said) = py.detach(|| {
        let listener = Listener::new(progress);
        let made = match &wanted.out {
            Some(out) => to_file(&spec, shard, means, out, &wanted, &listener),
            None => in_memory(&spec, shard, means, &listener),
        };
        (made, listener.said())
    });
    let made = made.map_err(|sentence| errors::of_output(py, &sentence))?;
    // An exception of `progress` belongs to the caller; an interrupt keeps what is done.
    let interrupt = match said {
        Some(error) if error.is_instance_of::<PyKeyboardInterrupt>(py) => Some(error),
        Some(error) => return Err(error),
        None => None,
    };
    let axes = spec.axes.iter().map(|axis| axis.key.clone()).collect();
    let statistics = (shard == Shard::WHOLE).then(|| statistics(py, &spec, &made)).transpose()?.flatten();
    Ok(((columns(py, &spec, &made)?, axes), statistics, interrupt))
}

/// Joins the parts of a sweep into `out`.
#[pyfunction]
pub fn merge(py: Python<'_>, parts: Vec<PathBuf>, out: PathBuf, overwrite: bool) -> PyResult<()> {
    let existing = if overwrite { Existing::Overwrite } else { Existing::GoOn };
    let joined = py.detach(|| ensemble::join(&parts, &out, existing).map_err(|error| error.to_string()));
    joined.map(drop).map_err(|sentence| errors::of_output(py, &sentence))
}

/// Asks `listener`, on the listener's own thread, while rows are handed over, and passes its answer to all threads.
struct Stop(AtomicBool);

impl Stop {
    fn ask(&self, listener: &Listener, done: u64, of: u64) {
        listener.report(if of > 0 { done as f64 / of as f64 } else { 1.0 });
        if listener.stop() {
            self.0.store(true, Ordering::Relaxed);
        }
    }
}

impl Progress for Stop {
    fn stop(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// The rows of a part; if Python said stop, only the rows up to then.
fn in_memory(spec: &Spec, shard: Shard, means: Means, listener: &Listener) -> Result<Rows, String> {
    let (stop, of) = (Stop(AtomicBool::new(false)), shard.len(spec.rows));
    let mut made = Rows { columns: vec![Vec::new(); spec.columns.len()], ..Rows::default() };
    let make = |row: u64, measured: MeasuredQuantities| (row, measured);
    let write = |item: Option<(u64, MeasuredQuantities)>| {
        if let Some((row, measured)) = item {
            made.numbers.push(row);
            for (at, column) in made.columns.iter_mut().enumerate() {
                column.push(number(measured.cells.get(at).copied().flatten()));
            }
            made.faults.push(measured.fault.as_ref().map(ToString::to_string));
        }
        stop.ask(listener, made.numbers.len() as u64, of);
        Ok::<(), OutputError>(())
    };
    rows(spec, shard, 0..of, means, &stop, &make, write).map_err(|error| error.to_string())?;
    Ok(made)
}

/// The rows of a part, written to its file as the program does, including rows that were there before.
fn to_file(
    spec: &Spec,
    shard: Shard,
    means: Means,
    out: &Path,
    wanted: &Wanted,
    listener: &Listener,
) -> Result<Rows, String> {
    let words = |error: OutputError| error.to_string();
    if is_stream(out) {
        return Err(format!("{}: results are read back, so they must go to a file", show_path(out)));
    }
    let is_there = ensemble::file_of_rows(out, spec)
        .metadata()
        .is_ok_and(|metadata| metadata.is_file() && metadata.len() > 0);
    if is_there && !wanted.resume && !wanted.overwrite {
        return Err(format!(
            "{}: already exists; resume=True continues it, overwrite=True replaces it",
            show_path(out)
        ));
    }
    let existing = if wanted.overwrite { Existing::Overwrite } else { Existing::GoOn };
    let has_statistics = spec.is_ensemble() && shard == Shard::WHOLE;
    if has_statistics {
        ensemble::may_write(out, spec, existing).map_err(words)?;
    }
    let rows_in = ensemble::file_of_rows(out, spec);
    let output = Output::open(&rows_in, spec, shard, existing).map_err(words)?;
    let (stop, of) = (Stop(AtomicBool::new(false)), shard.len(spec.rows));
    run(spec, shard, output, means, &stop, |done, _| stop.ask(listener, done, of)).map_err(words)?;
    if has_statistics {
        ensemble::summarize(out).map_err(words)?;
    }
    read_back(spec, &rows_in)
}

/// The rows of the results in a file.
fn read_back(spec: &Spec, out: &Path) -> Result<Rows, String> {
    let results = SweepResults::open(out).map_err(|error| error.to_string())?;
    let names: Vec<String> = spec.columns.iter().map(pulloff_engine::sweep::QuantityColumn::name).collect();
    let names = std::iter::once("row").chain(names.iter().map(String::as_str)).chain(["error"]);
    let mut texts = results.texts(&names.collect::<Vec<_>>()).map_err(|error| error.to_string())?;
    let wrong = || format!("{}: changed while it was being written", show_path(out));
    let faults = texts.pop().ok_or_else(wrong)?;
    let mut columns = texts.into_iter();
    let numbers = columns.next().ok_or_else(wrong)?;
    let numbers: Option<Vec<u64>> = numbers.iter().map(|row| row.parse().ok()).collect();
    let cell = |text: &String| if text.is_empty() { Some(f64::NAN) } else { text.parse().ok() };
    let columns: Option<Vec<Vec<f64>>> =
        columns.map(|column| column.iter().map(cell).collect::<Option<Vec<f64>>>()).collect();
    Ok(Rows {
        numbers: numbers.ok_or_else(wrong)?,
        columns: columns.ok_or_else(wrong)?,
        faults: faults.into_iter().map(|fault| Some(fault).filter(|fault| !fault.is_empty())).collect(),
    })
}

/// The statistics of the members at each point; `None` if it is not an ensemble.
fn statistics<'py>(py: Python<'py>, spec: &Spec, made: &Rows) -> PyResult<Option<Columns<'py>>> {
    let Design::Ensemble { members, seed, .. } = spec.design else { return Ok(None) };
    arrays_ready(py)?;
    let design = spec.design.of_points();
    let axes: Vec<SweepAxis> = spec.axes.iter().filter(|axis| axis.count().is_some()).cloned().collect();
    let count = points(&axes, design);
    let at = usize::try_from(count).unwrap_or(usize::MAX);
    let all = PyDict::new(py);
    all.set_item("row", PyArray1::from_iter(py, 0..count.cast_signed()))?;
    let values: Vec<Vec<Value>> = (0..count).map(|point| values(&axes, design, point)).collect();
    lay_axes(py, &all, &axes, &values)?;
    for (column, cells) in spec.columns.iter().zip(&made.columns) {
        let found = at_points(cells, at, seed);
        for (which, (name, _)) in STATISTICS.iter().enumerate() {
            let cell = |found: &Option<Statistics>| Statistics::cells(found.as_ref())[which];
            let numbers = found.iter().map(|found| number(cell(found)));
            all.set_item(statistic(&column.name(), name), PyArray1::from_iter(py, numbers))?;
        }
    }
    let own = ensemble::members_at(at, made.faults.iter().map(|fault| fault.as_deref().unwrap_or_default()));
    let counts =
        [own.iter().map(|point| point.there).collect(), own.iter().map(ensemble::AtPoint::refused).collect()];
    for ((name, _), counts) in COUNTS.iter().zip(counts) {
        let counts: Vec<u64> = counts;
        all.set_item(name, PyArray1::from_iter(py, counts.into_iter().map(u64::cast_signed)))?;
    }
    let faults = own.iter().map(|point| point.fault(members).map(|fault| fault.to_string()));
    all.set_item("error", PyList::new(py, faults.collect::<Vec<_>>())?)?;
    Ok(Some((all, axes.into_iter().map(|axis| axis.key).collect())))
}

/// A cell as a number; NaN if it is missing.
fn number(cell: Option<Cell>) -> f64 {
    match cell {
        Some(Cell::Number(x)) => x,
        Some(Cell::Count(n)) => n as f64,
        None => f64::NAN,
    }
}

fn columns<'py>(py: Python<'py>, spec: &Spec, made: &Rows) -> PyResult<Bound<'py, PyDict>> {
    arrays_ready(py)?;
    let all = PyDict::new(py);
    all.set_item("row", PyArray1::from_iter(py, made.numbers.iter().map(|row| row.cast_signed())))?;
    let values: Vec<Vec<Value>> = made.numbers.iter().map(|row| spec.values(*row)).collect();
    lay_axes(py, &all, &spec.axes, &values)?;
    for (column, cells) in spec.columns.iter().zip(&made.columns) {
        all.set_item(column.name(), PyArray1::from_slice(py, cells))?;
    }
    all.set_item("error", PyList::new(py, &made.faults)?)?;
    Ok(all)
}

/// Lays the columns of the axes into `all`, from their values in each row.
fn lay_axes(
    py: Python<'_>,
    all: &Bound<'_, PyDict>,
    axes: &[SweepAxis],
    values: &[Vec<Value>],
) -> PyResult<()> {
    for (at, SweepAxis { key, .. }) in axes.iter().enumerate() {
        let axis = || values.iter().filter_map(|row| row.get(at));
        let whole = |value: &Value| if let Value::Integer(n) = value { Some(*n) } else { None };
        let number = |value: &Value| match value {
            Value::Number(x) => Some(*x),
            Value::Integer(n) => Some(*n as f64),
            _ => None,
        };
        if let Some(numbers) = axis().map(whole).collect::<Option<Vec<i64>>>() {
            all.set_item(key, PyArray1::from_vec(py, numbers))?;
        } else if let Some(numbers) = axis().map(number).collect::<Option<Vec<f64>>>() {
            all.set_item(key, PyArray1::from_vec(py, numbers))?;
        } else {
            all.set_item(key, PyList::new(py, axis().map(ToString::to_string))?)?;
        }
    }
    Ok(())
}
