//! Computes rows of a sweep on every core and writes them in order.

use super::in_order::in_order;
use super::output::{FaultCounts, Output, OutputError};
use super::record::{self, RowOutcome};
use super::shard::Shard;
use pulloff_engine::progress::Progress;
use pulloff_engine::sweep::{Fault, MeasuredQuantities, Spec};
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// The largest number of rows started but not written: enough for one slow row among fast ones, in a few megabytes.
const WINDOW: u64 = 1 << 14;

/// The largest number of rows of an ensemble that one thread takes together.
const MOST_TOGETHER: u64 = 16;

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunSummary {
    /// The number of rows that existed before.
    pub before: u64,
    pub now: u64,
    pub of: u64,
    pub faults: FaultCounts,
}

impl RunSummary {
    /// Whether all rows exist.
    pub fn is_complete(&self) -> bool {
        self.before + self.now == self.of
    }

    /// Whether all rows exist and none of them has a quantity.
    pub fn is_failure(&self) -> bool {
        self.is_complete() && self.faults.failures == self.of
    }
}

/// What a run may use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Means {
    /// The number of threads.
    pub jobs: usize,
    /// The longest time that a row may take; after that it gets an error.
    pub row_limit: Option<Duration>,
}

/// Computes the rows of a shard that `output` does not have.
///
/// Every thread asks `progress` often; when it says stop, what is done is kept. `written` gets the number of existing
/// rows and of those with faults, several times a second.
pub fn run(
    spec: &Spec,
    shard: Shard,
    mut output: Output,
    means: Means,
    progress: &(dyn Progress + Sync),
    mut written: impl FnMut(u64, u64),
) -> Result<RunSummary, OutputError> {
    let of = shard.len(spec.rows);
    let (before, mut faults) = (output.rows, output.faults.clone());
    let mut now = 0;
    let make = |row: u64, measured: MeasuredQuantities| {
        let outcome = RowOutcome {
            fault: measured.fault.as_ref().map(|fault| fault.reason),
            has_quantity: measured.cells.iter().any(Option::is_some),
        };
        (record::record(spec, row, &measured), outcome)
    };
    rows(spec, shard, before..of, means, progress, &make, |item: Option<(String, RowOutcome)>| {
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
    Ok(RunSummary { before, now, of, faults })
}

/// Computes the rows with the positions `indices` in a shard, and passes what `make` makes of each to `write` in order,
/// on this thread; while there is none, `write` gets `None` now and then. Ends early if `progress` says stop or `write`
/// fails; everything before that has been passed on.
pub fn rows<T: Send>(
    spec: &Spec,
    shard: Shard,
    indices: Range<u64>,
    means: Means,
    progress: &(dyn Progress + Sync),
    make: &(impl Fn(u64, MeasuredQuantities) -> T + Sync),
    mut write: impl FnMut(Option<T>) -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    let one = |index: u64| {
        let row = shard.row(index);
        let begun = Instant::now();
        let is_late = || means.row_limit.is_some_and(|limit| begun.elapsed() > limit);
        let measured = catch_unwind(AssertUnwindSafe(|| spec.measure(row, &|| progress.stop() || is_late())));
        let measured = measured.unwrap_or_else(|payload| Some(spec.lost(Fault::of_panic(payload.as_ref()))));
        let late =
            || means.row_limit.filter(|_| !progress.stop()).map(|limit| spec.lost(Fault::of_limit(limit)));
        Some(make(row, measured.or_else(late)?))
    };
    // The points of a member share one surface, whose table costs more than they do, so one thread computes them all.
    let size = if spec.is_ensemble() { spec.points().min(MOST_TOGETHER) } else { 1 };
    let first = |unit: u64| (unit * size).saturating_sub(shard.number - 1).div_ceil(shard.of);
    let unit_of = |index: u64| shard.row(index) / size;
    let units = if indices.is_empty() { 0..0 } else { unit_of(indices.start)..unit_of(indices.end - 1) + 1 };
    let compute = |unit: u64| {
        let own = first(unit).max(indices.start)..first(unit + 1).min(indices.end);
        own.map(one).collect::<Option<Vec<T>>>()
    };
    in_order(units, means.jobs, WINDOW / size, &compute, progress, |unit| match unit {
        Some(items) => items.into_iter().try_for_each(|item| write(Some(item))),
        None => write(None),
    })
}
