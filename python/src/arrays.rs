//! numpy, whose import must not be interrupted.

use numpy::PyArray1;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

static READY: PyOnceLock<()> = PyOnceLock::new();

/// Imports numpy and what makes its arrays, once.
///
/// It runs on a thread of its own: Python raises `KeyboardInterrupt` only on the main thread, and a half-imported numpy
/// can neither be used nor imported again. The signal is raised when this returns.
///
/// # Errors
///
/// What the import of numpy raised.
#[pyfunction]
pub fn arrays_ready(py: Python<'_>) -> PyResult<()> {
    READY
        .get_or_try_init(py, || {
            py.detach(|| {
                std::thread::spawn(|| {
                    Python::attach(|py| {
                        py.import("numpy")?;
                        PyArray1::<f64>::zeros(py, 0, false);
                        Ok(())
                    })
                })
                .join()
                .unwrap_or_else(|_| Err(PyRuntimeError::new_err("this numpy cannot be used")))
            })
        })
        .copied()
}
