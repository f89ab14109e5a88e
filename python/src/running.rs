//! A long computation: the interpreter's other threads keep running, Ctrl-C ends it, and progress is reported.

use crate::errors;
use pulloff_engine::progress::Progress;
use pyo3::prelude::*;
use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// How often Python is asked whether to go on.
pub const PAUSE: Duration = Duration::from_millis(25);

/// What Python says to a computation: whether a signal has come, or its progress function has failed.
pub struct Listener {
    progress: Option<Py<PyAny>>,
    share: Cell<f64>,
    asked: Cell<Option<Instant>>,
    said: RefCell<Option<PyErr>>,
}

impl Listener {
    /// A listener that reports the share done to `progress`, if there is one.
    pub fn new(progress: Option<Py<PyAny>>) -> Self {
        Self { progress, share: Cell::new(0.0), asked: Cell::new(None), said: RefCell::new(None) }
    }

    /// The exception that ended the computation, if one did.
    pub fn said(self) -> Option<PyErr> {
        self.said.into_inner()
    }
}

impl Progress for Listener {
    fn report(&self, share: f64) {
        self.share.set(share);
    }

    /// Python is asked no more often than is useful; the engine asks far more often.
    fn stop(&self) -> bool {
        if self.said.borrow().is_some() {
            return true;
        }
        if self.asked.get().is_some_and(|asked| asked.elapsed() < PAUSE) {
            return false;
        }
        let asked = Python::attach(|py| {
            py.check_signals()?;
            match &self.progress {
                Some(progress) => progress.call1(py, (self.share.get(),)).map(drop),
                None => Ok(()),
            }
        });
        // From the end: a slow progress function must not be called at every chance.
        self.asked.set(Some(Instant::now()));
        match asked {
            Ok(()) => false,
            Err(error) => {
                self.said.replace(Some(error));
                true
            }
        }
    }
}

/// Computes without the interpreter's lock. An exception of `progress`, or of a signal, is raised; so is a panic.
pub fn long<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    compute: impl FnOnce(&dyn Progress) -> T + Send,
) -> PyResult<T> {
    let (made, said) = py.detach(|| {
        let listener = Listener::new(progress);
        let made = catch_unwind(AssertUnwindSafe(|| compute(&listener)));
        (made, listener.said())
    });
    if let Some(error) = said {
        return Err(error);
    }
    made.map_err(|payload| errors::of_panic(py, payload.as_ref()))
}
