//! Many problems on all cores: the rows of a sweep as columns.

use crate::problem::Problem;
use crate::running::{Listener, PAUSE};
use crate::{errors, files};
use numpy::PyArray1;
use pulloff_engine::preset::read::read_in;
use pulloff_engine::preset::{Preset, Value, shipped};
use pulloff_engine::progress::Progress;
use pulloff_engine::sweep::axis::SweepAxis;
use pulloff_engine::sweep::{Cell, Fault, Measured, QUANTITIES, Spec};
use pulloff_engine::text::quote;
use pyo3::exceptions::{PyMemoryError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;

/// The name, the SI unit and the meaning of every quantity.
#[pyfunction]
pub fn quantities() -> Vec<(&'static str, &'static str, &'static str, bool)> {
    let row = |quantity: &'static pulloff_engine::sweep::Quantity| {
        (quantity.name, quantity.unit.si().unwrap_or("1"), quantity.meaning, quantity.is_of_control())
    };
    QUANTITIES.iter().map(row).collect()
}

/// The preset of a spec: one that comes with the package, or a file relative to `folder`.
fn preset(folder: &Path, name: &str, set: &[&str]) -> Result<Preset, String> {
    let is_path = name.contains('/') || Path::new(name).extension().is_some_and(|end| end == "toml");
    if is_path {
        let path = folder.join(name);
        let text = files::text(&path)?;
        return read_in(files::FILES, path.parent(), name, &text, set).map_err(|error| error.to_string());
    }
    let found = shipped::find(name).ok_or_else(|| {
        format!(
            "no preset that comes with the package is called \"{}\"; a file has a '/' or ends in .toml",
            quote(name)
        )
    })?;
    read_in(files::FILES, None, name, found.text, set).map_err(|error| error.to_string())
}

/// The problem that stands in place of a preset, with the assignments of the spec.
fn assigned(problem: &Preset, set: &[&str]) -> Result<Preset, String> {
    let mut preset = problem.clone();
    for assignment in set {
        let (key, text) =
            assignment.split_once('=').ok_or_else(|| "an assignment is KEY=VALUE".to_owned())?;
        preset.assign(key.trim(), text.trim()).map_err(|error| error.to_string())?;
    }
    Ok(preset)
}

/// The rows of the spec `text`, on `jobs` threads: its columns by name, in order, and the keys of its axes. `problem` stands in place of its preset.
#[pyfunction]
pub fn sweep<'py>(
    py: Python<'py>,
    text: &str,
    folder: std::path::PathBuf,
    problem: Option<&Bound<'py, Problem>>,
    jobs: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Bound<'py, PyDict>, Vec<String>)> {
    let given = problem.map(|problem| problem.get().preset.clone());
    let presets = |name: &str, set: &[&str]| match &given {
        Some(problem) => assigned(problem, set),
        None => preset(&folder, name, set),
    };
    let spec = Spec::read(&presets, "spec", text).map_err(|error| errors::of_spec(py, &error))?;
    let rows = usize::try_from(spec.rows).map_err(|_| PyMemoryError::new_err("too many rows"))?;
    let (made, said) = py.detach(|| run(&spec, rows, jobs, progress))?;
    if let Some(error) = said {
        return Err(error);
    }
    let axes = spec.axes.iter().map(|axis| axis.key.clone()).collect();
    Ok((columns(py, &spec, &made)?, axes))
}

/// Computes all rows; less than all where Python said no.
fn run(
    spec: &Spec,
    rows: usize,
    jobs: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Vec<Measured>, Option<PyErr>)> {
    let (next, done, stopped) = (AtomicU64::new(0), AtomicU64::new(0), AtomicBool::new(false));
    let stop = || stopped.load(Ordering::Relaxed);
    let work = || {
        let mut own = Vec::new();
        while !stop() {
            let row = next.fetch_add(1, Ordering::Relaxed);
            if row >= spec.rows {
                break;
            }
            let measured = catch_unwind(AssertUnwindSafe(|| spec.measure(row, &stop)))
                .unwrap_or_else(|payload| Some(spec.lost(Fault::of_panic(payload.as_ref()))));
            let Some(measured) = measured else { break };
            own.push((row, measured));
            done.fetch_add(1, Ordering::Relaxed);
        }
        own
    };
    let listener = Listener::new(progress);
    let mut all: Vec<Option<Measured>> = vec![None; rows];
    thread::scope(|scope| {
        let mut threads = Vec::new();
        for number in 0..jobs {
            let named = thread::Builder::new().name(format!("sweep-{number}"));
            match named.spawn_scoped(scope, work) {
                Ok(thread) => threads.push(thread),
                // With fewer threads it takes longer, and that is all.
                Err(error) if threads.is_empty() => {
                    return Err(PyRuntimeError::new_err(format!("cannot start a thread: {error}")));
                }
                Err(_) => break,
            }
        }
        while !threads.iter().all(thread::ScopedJoinHandle::is_finished) {
            listener.report(done.load(Ordering::Relaxed) as f64 / spec.rows as f64);
            if listener.stop() {
                stopped.store(true, Ordering::Relaxed);
            }
            // A short sweep does not wait a whole pause for its end.
            thread::park_timeout(if done.load(Ordering::Relaxed) == 0 { PAUSE / 50 } else { PAUSE / 5 });
        }
        for thread in threads {
            for (row, measured) in thread.join().unwrap_or_default() {
                if let Some(cell) = usize::try_from(row).ok().and_then(|row| all.get_mut(row)) {
                    *cell = Some(measured);
                }
            }
        }
        Ok(())
    })?;
    Ok((all.into_iter().flatten().collect(), listener.said()))
}

fn columns<'py>(py: Python<'py>, spec: &Spec, made: &[Measured]) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    let rows = || 0..made.len() as u64;
    all.set_item("row", PyArray1::from_iter(py, rows().map(u64::cast_signed)))?;
    let values: Vec<Vec<Value>> = rows().map(|row| spec.values(row)).collect();
    for (at, SweepAxis { key, .. }) in spec.axes.iter().enumerate() {
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
    for (at, column) in spec.columns.iter().enumerate() {
        let cell = |measured: &Measured| match measured.cells.get(at).copied().flatten() {
            Some(Cell::Number(x)) => x,
            Some(Cell::Count(n)) => n as f64,
            None => f64::NAN,
        };
        all.set_item(column.name(), PyArray1::from_iter(py, made.iter().map(cell)))?;
    }
    let faults = made.iter().map(|measured| measured.fault.as_ref().map(ToString::to_string));
    all.set_item("error", PyList::new(py, faults)?)?;
    Ok(all)
}
