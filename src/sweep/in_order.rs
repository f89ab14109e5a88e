//! Many computations on every core, with their results in order.
//!
//! Each thread takes the next computation; finished ones wait for earlier ones in a window of bounded size, and none is
//! started beyond it. So a file grows in order whatever the threads do, and memory does not grow with the number of
//! rows.

use pulloff_engine::progress::Progress;
use rayon::ThreadPoolBuildError;
use rayon::iter::{ParallelBridge, ParallelIterator};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

/// How long the writer waits before it calls `write` with nothing.
const PAUSE: Duration = Duration::from_millis(100);

/// Which rows may be started.
struct RowWindow {
    state: Mutex<WindowState>,
    moved: Condvar,
    size: u64,
}

struct WindowState {
    written: u64,
    closed: bool,
}

impl RowWindow {
    fn change(&self, change: impl FnOnce(&mut WindowState)) {
        change(&mut self.state.lock().unwrap_or_else(PoisonError::into_inner));
        self.moved.notify_all();
    }

    /// Waits until `index` may be started; false if it never may.
    fn admits(&self, index: u64) -> bool {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        while !state.closed && index >= state.written + self.size {
            state = self.moved.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        !state.closed
    }
}

/// Computes all `indices` on `jobs` threads and passes the results to `write` in order; while there is none, `write`
/// gets `None` now and then. Ends early if `progress` or a computation (with `None`) says stop, or if `write` fails;
/// everything before that is written.
///
/// # Errors
/// The error of `write`, or that of threads that cannot be created.
pub fn in_order<T: Send, E: From<ThreadPoolBuildError>>(
    indices: Range<u64>,
    jobs: usize,
    window: u64,
    compute: &(impl Fn(u64) -> Option<T> + Sync),
    progress: &(dyn Progress + Sync),
    mut write: impl FnMut(Option<T>) -> Result<(), E>,
) -> Result<(), E> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs).thread_name(|n| format!("row-{n}"));
    let pool = pool.build()?;
    let mut next = indices.start;
    let state = Mutex::new(WindowState { written: next, closed: false });
    let window = &RowWindow { state, moved: Condvar::new(), size: window };
    let (sender, receiver) = channel();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            // Taken one by one in order, by whichever thread is free.
            let admitted = indices.take_while(|index| !progress.stop() && window.admits(*index));
            pool.install(|| {
                admitted.par_bridge().for_each_with(sender, |sender, index| match compute(index) {
                    // The writer is there until the last sender is gone or has closed the window.
                    Some(item) => drop(sender.send((index, item))),
                    None => window.change(|state| state.closed = true),
                });
            });
        });
        let mut waiting = BTreeMap::new();
        loop {
            let written = match receiver.recv_timeout(PAUSE) {
                Ok((index, item)) => {
                    waiting.insert(index, item);
                    let mut written = Ok(());
                    while let (Some(item), true) = (waiting.remove(&next), written.is_ok()) {
                        next += 1;
                        written = write(Some(item));
                    }
                    window.change(|state| state.written = next);
                    written
                }
                Err(RecvTimeoutError::Timeout) => write(None),
                Err(RecvTimeoutError::Disconnected) => return Ok(()),
            };
            if written.is_err() {
                window.change(|state| state.closed = true);
                return written;
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::OutputError;
    use pulloff_engine::progress::Unwatched;
    use std::sync::atomic::{AtomicU64, Ordering};

    /// The written part of `0..rows`, each row computed after its own pause.
    fn written(rows: u64, window: u64, last: u64) -> Vec<u64> {
        let begun = AtomicU64::new(0);
        let done = AtomicU64::new(0);
        let compute = |index: u64| {
            begun.fetch_max(index, Ordering::SeqCst);
            assert!(index < done.load(Ordering::SeqCst) + window, "row {index} was begun too early");
            if index.is_multiple_of(7) {
                std::thread::sleep(Duration::from_micros(300));
            }
            (index < last).then_some(index)
        };
        let mut all = Vec::new();
        in_order(0..rows, 4, window, &compute, &Unwatched, |item| {
            if let Some(item) = item {
                all.push(item);
                done.store(item + 1, Ordering::SeqCst);
            }
            Ok::<(), OutputError>(())
        })
        .unwrap();
        assert!(begun.load(Ordering::SeqCst) < all.len() as u64 + window);
        all
    }

    #[test]
    fn rows_come_in_order_through_a_small_window() {
        assert!(written(500, 5, u64::MAX).into_iter().eq(0..500));
        assert!(written(3, 1, u64::MAX).into_iter().eq(0..3));
        assert!(written(0, 1, u64::MAX).is_empty());
    }

    #[test]
    fn what_is_before_the_end_is_written() {
        assert!(written(500, 16, 100).into_iter().eq(0..100));
        let count = AtomicU64::new(0);
        let stop = || count.fetch_add(1, Ordering::SeqCst) >= 50;
        let mut all = Vec::new();
        in_order(10..500, 2, 100, &Some, &stop, |item| {
            all.extend(item);
            Ok::<(), OutputError>(())
        })
        .unwrap();
        assert!(all.into_iter().eq(10..60));
    }

    #[test]
    fn a_failed_write_ends_all() {
        let failed = || OutputError::Described { path: "no".to_owned() };
        let mut all = Vec::new();
        let result = in_order(0..1000, 4, 10, &Some, &Unwatched, |item| {
            all.extend(item);
            if all.len() == 30 { Err(failed()) } else { Ok(()) }
        });
        assert!(result.is_err());
        assert!(all.into_iter().eq(0..30));
    }
}
