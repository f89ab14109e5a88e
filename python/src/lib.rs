//! The engine of pulloff for Python: the module `pulloff._engine`, inside the package `pulloff`, which is what users
//! see.
//!
//! Only what needs Rust is here: problems, long computations that let other threads run and can be interrupted, and
//! results as columns and JSON. Names, defaults and everything a user reads are in the package's Python.
//!
//! | file | what lives there |
//! |---|---|
//! | `arrays` | numpy, imported so that Ctrl-C cannot leave it half imported |
//! | `errors` | errors of the engine as exceptions of the package |
//! | `running` | a long computation: other threads run, Ctrl-C ends it, progress is reported |
//! | `document` | a result: its JSON, its columns as arrays |
//! | `problem` | a problem, and everything that is computed for it |
//! | `fit` | a problem fitted to a measured curve |
//! | `sweep` | many problems on all cores |

mod arrays;
mod document;
mod errors;
mod fit;
mod problem;
mod running;
mod sweep;

use pyo3::prelude::*;

/// The engine: not for direct use; use the package `pulloff`.
#[pymodule]
fn _engine(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(arrays::arrays_ready, module)?)?;
    module.add_class::<document::Document>()?;
    module.add_class::<problem::Problem>()?;
    module.add_function(wrap_pyfunction!(problem::presets, module)?)?;
    module.add_function(wrap_pyfunction!(fit::fitted, module)?)?;
    module.add_function(wrap_pyfunction!(fit::fitted_together, module)?)?;
    module.add_function(wrap_pyfunction!(fit::speeds, module)?)?;
    module.add_function(wrap_pyfunction!(problem::between, module)?)?;
    module.add_function(wrap_pyfunction!(problem::read_file, module)?)?;
    module.add_function(wrap_pyfunction!(problem::write_files, module)?)?;
    module.add_function(wrap_pyfunction!(sweep::sweep, module)?)?;
    module.add_function(wrap_pyfunction!(sweep::merge, module)?)?;
    module.add_function(wrap_pyfunction!(sweep::quantities, module)?)?;
    Ok(())
}
