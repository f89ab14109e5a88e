//! The pace of a run and its end, set by the screen and observed by the walk.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The longest wait between two states, whatever the pace: longer than at the slowest pace that can be chosen.
const LONGEST: Duration = Duration::from_secs(2);

/// What a run has to watch.
#[derive(Debug, Default)]
pub(super) struct Watch {
    /// The walks up to this number must end.
    stopped: AtomicU64,
    /// States per second.
    pace: Mutex<f64>,
    changed: Condvar,
}

impl Watch {
    fn lock(&self) -> MutexGuard<'_, f64> {
        self.pace.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Ends the walks up to this number.
    pub(super) fn stop(&self, id: u64) {
        self.stopped.fetch_max(id, Ordering::AcqRel);
        // Whoever is about to wait holds the lock, so taking it here ensures that nobody misses the signal.
        drop(self.lock());
        self.changed.notify_all();
    }

    /// Sets the number of states per second from now on.
    pub(super) fn set(&self, pace: f64) {
        *self.lock() = pace;
        self.changed.notify_all();
    }

    /// Whether the walk with this number must end.
    pub(super) fn is_stopped(&self, id: u64) -> bool {
        self.stopped.load(Ordering::Acquire) >= id
    }

    /// Waits until the next state is due after one made at `last`; false if the walk must end.
    pub(super) fn wait(&self, id: u64, last: Instant) -> bool {
        let mut pace = self.lock();
        loop {
            if self.is_stopped(id) {
                return false;
            }
            let wait = Duration::try_from_secs_f64(1.0 / *pace).map_or(LONGEST, |wait| wait.min(LONGEST));
            let left = wait.saturating_sub(last.elapsed());
            if left.is_zero() {
                return true;
            }
            pace = self.changed.wait_timeout(pace, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}
