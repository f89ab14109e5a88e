//! Rows on every core, written in their order.
//!
//! Threads take the next row each; finished rows wait for those before them in a window of bounded size, beyond which no
//! row is begun. So the file grows in order whatever the threads do, and memory does not grow with the number of rows.

use super::output::{Faults, Output, OutputError};
use super::record::{self, Outcome};
use super::shard::Shard;
use pulloff_engine::progress::Progress;
use pulloff_engine::sweep::{Fault, Measured, Spec};
use rayon::iter::{ParallelBridge, ParallelIterator};
use std::collections::BTreeMap;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The most rows begun and not written: a slow one among fast ones, and a few megabytes.
const WINDOW: u64 = 1 << 14;
/// How long the writer waits before it says so.
const PAUSE: Duration = Duration::from_millis(100);

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Summary {
    /// The rows that were there before.
    pub before: u64,
    pub now: u64,
    pub of: u64,
    pub faults: Faults,
}

impl Summary {
    /// Whether all rows are there.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.before + self.now == self.of
    }

    /// Whether all rows are there, and none of them has a quantity.
    #[must_use]
    pub fn is_failure(&self) -> bool {
        self.is_complete() && self.faults.failures == self.of
    }
}

/// What a run may use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Means {
    /// Threads.
    pub jobs: usize,
    /// The longest that a row may take; then it has an error.
    pub row_limit: Option<Duration>,
}

/// Computes the rows of a part that `output` does not have.
///
/// `progress` is asked often, by every thread; when it says stop, what is done is kept. `written` is told how many rows there
/// are and how many of them have faults, several times a second.
pub fn run(
    spec: &Spec,
    shard: Shard,
    mut output: Output,
    means: Means,
    progress: &(dyn Progress + Sync),
    mut written: impl FnMut(u64, u64),
) -> Result<Summary, OutputError> {
    let of = shard.len(spec.rows);
    let (before, mut faults) = (output.rows, output.faults.clone());
    let mut now = 0;
    let make = |row: u64, measured: Measured| {
        let outcome = Outcome {
            fault: measured.fault.as_ref().map(|fault| fault.reason),
            has_quantity: measured.cells.iter().any(Option::is_some),
        };
        (record::record(spec, row, &measured), outcome)
    };
    rows(spec, shard, before..of, means, progress, &make, |item: Option<(String, Outcome)>| {
        let result = match item {
            Some((line, outcome)) => {
                now += 1;
                faults.count(outcome);
                output.append(&line)
            }
            None => output.flush(),
        };
        written(before + now, faults.total());
        result
    })?;
    output.finish()?;
    Ok(Summary { before, now, of, faults })
}

/// Computes the rows of a part whose places in it are `indices`, and hands what `make` makes of each over in order, on this
/// thread; nothing now and then, while there is none. Ends early where `progress` says stop or `write` fails: all before that is
/// handed over.
pub fn rows<T: Send>(
    spec: &Spec,
    shard: Shard,
    indices: Range<u64>,
    means: Means,
    progress: &(dyn Progress + Sync),
    make: &(impl Fn(u64, Measured) -> T + Sync),
    write: impl FnMut(Option<T>) -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    let compute = |index: u64| {
        let row = shard.row(index);
        let begun = Instant::now();
        let is_late = || means.row_limit.is_some_and(|limit| begun.elapsed() > limit);
        let measured = catch_unwind(AssertUnwindSafe(|| spec.measure(row, &|| progress.stop() || is_late())));
        let measured = measured.unwrap_or_else(|payload| Some(spec.lost(Fault::of_panic(payload.as_ref()))));
        let late =
            || means.row_limit.filter(|_| !progress.stop()).map(|limit| spec.lost(Fault::of_limit(limit)));
        Some(make(row, measured.or_else(late)?))
    };
    in_order(indices, means.jobs, WINDOW, &compute, progress, write)
}

/// Which rows may be begun.
struct Window {
    state: Mutex<State>,
    moved: Condvar,
    size: u64,
}

struct State {
    written: u64,
    closed: bool,
}

impl Window {
    fn change(&self, change: impl FnOnce(&mut State)) {
        change(&mut self.state.lock().unwrap_or_else(PoisonError::into_inner));
        self.moved.notify_all();
    }

    /// Waits until `index` may be begun; false when it never may.
    fn admits(&self, index: u64) -> bool {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        while !state.closed && index >= state.written + self.size {
            state = self.moved.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        !state.closed
    }
}

/// Computes all `indices` on `jobs` threads and hands the results over in order; nothing now and then, while there is
/// none. Ends early where `progress` or a computation (with `None`) says stop, or `write` fails: all before that is written.
fn in_order<T: Send>(
    indices: Range<u64>,
    jobs: usize,
    window: u64,
    compute: &(impl Fn(u64) -> Option<T> + Sync),
    progress: &(dyn Progress + Sync),
    mut write: impl FnMut(Option<T>) -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs).thread_name(|n| format!("sweep-{n}"));
    let pool = pool.build().map_err(|error| OutputError::Threads(error.to_string()))?;
    let mut next = indices.start;
    let state = Mutex::new(State { written: next, closed: false });
    let window = &Window { state, moved: Condvar::new(), size: window };
    let (sender, receiver) = channel();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            // Taken one by one and in order, whichever thread is free.
            let admitted = indices.take_while(|index| !progress.stop() && window.admits(*index));
            pool.install(|| {
                admitted.par_bridge().for_each_with(sender, |sender, index| match compute(index) {
                    // The writer is there until the last sender is gone, or has closed the window.
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
    use pulloff_engine::progress::Unwatched;
    use std::sync::atomic::{AtomicU64, Ordering};

    /// What was written of `0..rows`, each computed after its own pause.
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
            Ok(())
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
            Ok(())
        })
        .unwrap();
        assert!(all.into_iter().eq(10..60));
    }

    #[test]
    fn a_failed_write_ends_all() {
        let failed = || OutputError::Threads("no".to_owned());
        let mut all = Vec::new();
        let result = in_order(0..1000, 4, 10, &Some, &Unwatched, |item| {
            all.extend(item);
            if all.len() == 30 { Err(failed()) } else { Ok(()) }
        });
        assert!(result.is_err());
        assert!(all.into_iter().eq(0..30));
    }
}
