//! The file of the results: started, continued, appended to.
//!
//! Rows are only ever appended, whole lines at a time, so whatever ends the program leaves complete rows and at most
//! one torn line at the end, which the next run cuts off. The file beside the results is written first: results without
//! it are not ours and are not touched. Standard output, a pipe or a device gets the rows as they come, and nothing
//! else.

use super::record::{Layout, RowOutcome, Wrong};
use super::results::ResultsError;
use super::rows::{RowFault, RowReader};
use super::shard::Shard;
use super::sidecar::{self, Sidecar, SidecarError};
use super::spec::identity;
use crate::mend::mend;
use crate::store::atomic::{Overwrite, WriteError, check as check_writable, explained, write_atomically};
use crate::store::file::{LARGEST, read_text};
use crate::store::lock::lock_file;
use crate::store::stream;
use pulloff_engine::sweep::Spec;
use pulloff_engine::text::show_path;
use rayon::ThreadPoolBuildError;
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufReader, Seek, Write};
use std::path::Path;
use std::time::{Duration, Instant};
use thiserror::Error;

/// What to do with existing results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// Continue those of the same sweep, refuse all others.
    GoOn,
    Overwrite,
}

/// Why results cannot be started, continued or written. Paths are safe to show.
#[derive(Debug, Error)]
pub enum OutputError {
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error("{path}: cannot {doing}: {cause}")]
    Io { path: String, doing: &'static str, cause: io::Error },
    #[error("{path}: another pulloff is writing it")]
    Busy { path: String },
    /// A file exists, and nothing beside it says that it belongs to a sweep.
    #[error(
        "{path}: already exists, and is not known to belong to a sweep ({cause}); --overwrite replaces it"
    )]
    NotOurs { path: String, cause: SidecarError },
    /// What stands beside results does not say what they are.
    #[error(transparent)]
    Sidecar(#[from] SidecarError),
    /// The file beside the results exists without them.
    #[error("{path}: already exists, and does not describe this sweep; --overwrite replaces it")]
    Described { path: String },
    #[error("{path}: holds the results of another sweep: {what}; --overwrite replaces them")]
    OtherSweep { path: String, what: String },
    #[error("{path}: holds shard {found}, not {wanted}; --overwrite replaces it")]
    OtherShard { path: String, found: Shard, wanted: Shard },
    /// A complete line that differs from what this sweep writes there.
    #[error("{path}:{line}: {what}: the file was changed; --overwrite starts afresh")]
    Changed {
        path: String,
        /// The line, from 1.
        line: u64,
        what: Wrong,
    },
    /// Rows of members from which statistics cannot be made.
    #[error(transparent)]
    Rows(#[from] ResultsError),
    #[error("cannot start the threads: {0}")]
    Threads(#[from] ThreadPoolBuildError),
}

mend!(
    OutputError, as 0 of Write | Rows | Sidecar, as cause of Io | NotOurs, never Threads,
    always Busy | Described | OtherSweep | OtherShard | Changed
);

/// The faults of rows.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FaultCounts {
    /// Their number, by reason.
    pub reasons: BTreeMap<&'static str, u64>,
    /// The rows with a fault and no quantity.
    pub failures: u64,
}

impl FaultCounts {
    /// Counts a row.
    pub(super) fn count(&mut self, outcome: RowOutcome) {
        if let Some(reason) = outcome.fault {
            *self.reasons.entry(reason).or_default() += 1;
        }
        self.failures += u64::from(outcome.is_failure());
    }

    /// The rows with a fault.
    pub fn total(&self) -> u64 {
        self.reasons.values().sum()
    }
}

/// Results being written.
#[derive(Debug)]
pub struct Output {
    file: File,
    path: String,
    /// Whether the rows go directly to a reader; then there is nothing to continue.
    is_stream: bool,
    /// Complete lines that are not in the file yet.
    buffer: Vec<u8>,
    flushed: Instant,
    pub rows: u64,
    pub faults: FaultCounts,
}

/// The buffer is written once it has this many bytes, or after this time.
const BUFFER: usize = 1 << 16;
const LATEST: Duration = Duration::from_millis(200);

impl Output {
    /// Opens the results of a shard of a sweep, and finds how far they are.
    pub fn open(path: &Path, spec: &Spec, shard: Shard, existing: Existing) -> Result<Self, OutputError> {
        let shown = show_path(path);
        let failed = |doing| {
            let path = shown.clone();
            move |cause| OutputError::Io { path, doing, cause }
        };
        if stream::is_stream(path) {
            return Self::straight(path, spec);
        }
        check_writable(path, Overwrite::Always)?;
        let description = sidecar::text(spec, shard);
        if path.metadata().map_or(0, |metadata| metadata.len()) == 0 {
            begins(path, &description, existing)?;
        }
        let file =
            OpenOptions::new().read(true).append(true).create(true).open(path).map_err(failed("open"))?;
        if !lock_file(&file, Duration::ZERO).map_err(failed("lock"))? {
            return Err(OutputError::Busy { path: shown });
        }
        if existing == Existing::Overwrite {
            file.set_len(0).map_err(failed("empty"))?;
        }
        if file.metadata().map_err(failed("examine"))?.len() > 0 {
            check(path, spec, shard)?;
        } else {
            begins(path, &description, existing)?;
            write_atomically(&sidecar::path(path), description.as_bytes(), Overwrite::Always)?;
        }
        let mut output = Self::new(file, shown);
        output.scan(spec, shard)?;
        Ok(output)
    }

    /// Starts the results on standard output, a pipe or a device.
    fn straight(path: &Path, spec: &Spec) -> Result<Self, OutputError> {
        let shown = stream::shown(path);
        let file = stream::open(path);
        let file = file.map_err(|cause| OutputError::Io { path: shown.clone(), doing: "open", cause })?;
        let mut output = Self { is_stream: true, ..Self::new(file, shown) };
        output.append(&Layout::of(spec).header())?;
        Ok(output)
    }

    fn new(file: File, path: String) -> Self {
        let (buffer, flushed, faults) = (Vec::new(), Instant::now(), FaultCounts::default());
        Self { file, path, is_stream: false, buffer, flushed, rows: 0, faults }
    }

    fn failed(&self, doing: &'static str) -> impl FnOnce(io::Error) -> OutputError {
        let path = self.path.clone();
        move |cause| OutputError::Io { path, doing, cause: explained(cause) }
    }

    /// Finds the existing rows, and cuts off a torn line.
    fn scan(&mut self, spec: &Spec, shard: Shard) -> Result<(), OutputError> {
        let layout = Layout::of(spec);
        let mut reader = BufReader::new(&self.file);
        reader.rewind().map_err(self.failed("read"))?;
        let mut reader = RowReader::new(reader, &layout, shard, spec.rows);
        loop {
            match reader.next() {
                Ok(Some(outcome)) => self.faults.count(outcome),
                Ok(None) => break,
                Err(RowFault::Io(cause)) => return Err(self.failed("read")(cause)),
                Err(RowFault::Wrong(what)) => {
                    return Err(OutputError::Changed { path: self.path.clone(), line: reader.lines, what });
                }
            }
        }
        self.rows = reader.rows();
        let whole = reader.bytes;
        self.file.set_len(whole).map_err(self.failed("cut a torn line off"))?;
        if whole == 0 {
            self.append(&layout.header())?;
            self.flush()?;
        }
        Ok(())
    }

    /// Appends a complete line, now or a little later.
    pub fn append(&mut self, line: &str) -> Result<(), OutputError> {
        self.buffer.extend_from_slice(line.as_bytes());
        if self.buffer.len() >= BUFFER || self.flushed.elapsed() >= LATEST { self.flush() } else { Ok(()) }
    }

    /// Writes what was appended.
    pub fn flush(&mut self) -> Result<(), OutputError> {
        (&self.file).write_all(&self.buffer).map_err(self.failed("write"))?;
        self.buffer.clear();
        self.flushed = Instant::now();
        Ok(())
    }

    /// Makes sure that all rows are on the disk.
    pub fn finish(mut self) -> Result<(), OutputError> {
        self.flush()?;
        if self.is_stream { Ok(()) } else { self.file.sync_all().map_err(self.failed("write")) }
    }
}

/// Refuses to start results where the file beside them exists and describes another sweep.
fn begins(path: &Path, description: &str, existing: Existing) -> Result<(), OutputError> {
    let beside = sidecar::path(path);
    if existing == Existing::Overwrite || beside.symlink_metadata().is_err() {
        return Ok(());
    }
    match read_text(&beside, 4 * LARGEST) {
        Ok((text, _)) if text == description => Ok(()),
        _ => Err(OutputError::Described { path: show_path(&beside) }),
    }
}

/// Refuses results that do not belong to this shard of this sweep.
fn check(path: &Path, spec: &Spec, shard: Shard) -> Result<(), OutputError> {
    let shown = || show_path(path);
    let (sidecar, text) =
        Sidecar::read(path).map_err(|cause| OutputError::NotOurs { path: shown(), cause })?;
    if sidecar.identity != identity(spec) {
        return Err(OutputError::OtherSweep { path: shown(), what: sidecar::differences(&text, spec) });
    }
    if sidecar.shard() != shard {
        return Err(OutputError::OtherShard { path: shown(), found: sidecar.shard(), wanted: shard });
    }
    Ok(())
}
