//! Watching a long computation: the watcher is told how far it is, and asked whether to end it.

/// Watches a long computation.
///
/// Every function of this crate that may take long accepts one. It asks [`Progress::stop`] at least every 50 ms,
/// usually far more often, so an answer should be cheap. A function without parameters that returns whether to stop is
/// a `Progress` too.
pub trait Progress {
    /// Takes the rough share of the work that is done, from 0 to 1.
    fn report(&self, share: f64) {
        _ = share;
    }

    /// Whether to end, because the result is no longer wanted. Once it is true, it must stay true.
    fn stop(&self) -> bool;

    /// Asks [`Progress::stop`].
    ///
    /// # Errors
    /// [`Stopped`] if the answer is yes.
    fn go_on(&self) -> Result<(), Stopped> {
        if self.stop() { Err(Stopped) } else { Ok(()) }
    }
}

/// A computation was ended before it had a result: its [`Progress`] said stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
#[error("cancelled")]
pub struct Stopped;

impl<F: Fn() -> bool> Progress for F {
    fn stop(&self) -> bool {
        self()
    }
}

/// Nobody watches: the computation runs to its end.
#[derive(Debug, Clone, Copy, Default)]
pub struct Unwatched;

impl Progress for Unwatched {
    fn stop(&self) -> bool {
        false
    }
}

/// One part of a longer computation: its shares are shares of that part.
pub(crate) struct ProgressPart<'a> {
    whole: &'a dyn Progress,
    from: f64,
    to: f64,
}

impl<'a> ProgressPart<'a> {
    /// The part of `whole` between these two shares.
    pub(crate) fn new(whole: &'a dyn Progress, [from, to]: [f64; 2]) -> Self {
        whole.report(from);
        Self { whole, from, to }
    }
}

impl Progress for ProgressPart<'_> {
    fn report(&self, share: f64) {
        self.whole.report(self.from + (self.to - self.from) * share.clamp(0.0, 1.0));
    }

    fn stop(&self) -> bool {
        self.whole.stop()
    }
}

/// Keeps the shares it is told, and stops from the share `stop` on: for tests.
#[cfg(test)]
pub(crate) struct Heard {
    pub(crate) told: std::cell::RefCell<Vec<f64>>,
    stop: f64,
}

#[cfg(test)]
impl Heard {
    pub(crate) fn until(stop: f64) -> Self {
        Self { told: std::cell::RefCell::default(), stop }
    }
}

#[cfg(test)]
impl Progress for Heard {
    fn report(&self, share: f64) {
        self.told.borrow_mut().push(share);
    }

    fn stop(&self) -> bool {
        self.told.borrow().last().is_some_and(|share| *share >= self.stop)
    }
}

/// Says stop from this question on, counted from 0.
pub(crate) fn until(questions: usize) -> impl Fn() -> bool {
    let asked = std::cell::Cell::new(0);
    move || {
        asked.set(asked.get() + 1);
        asked.get() > questions
    }
}
