//! How far a sweep is, as a small file that another program may read at any time.

use super::Failure;
use crate::store::{Overwrite, write_atomically};
use crate::sweep::{Shard, Summary};
use pulloff_engine::text::show_path;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The file is replaced so often at most.
const PAUSE: Duration = Duration::from_secs(1);

/// What the file says.
#[derive(Debug, Serialize)]
struct Status<'a> {
    schema: u32,
    /// `running`, `complete` or `stopped`.
    state: &'a str,
    results: &'a str,
    shard: String,
    /// The rows that are there, of all of the shard.
    rows: u64,
    of: u64,
    /// Those among them that were there when this run began, and those with an error.
    before: u64,
    with_error: u64,
    /// Since this run began.
    seconds: f64,
    rows_per_second: Option<f64>,
    process: u32,
}

/// The file, while a sweep runs.
#[derive(Debug)]
pub struct Reporter {
    file: Option<PathBuf>,
    results: String,
    shard: Shard,
    of: u64,
    before: u64,
    begun: Instant,
    written: Instant,
    /// Why it could not be replaced, once.
    pub trouble: Option<String>,
}

impl Reporter {
    /// Begins the file, where one is wanted.
    /// Errors: It cannot be written, or is the file of the results or the spec.
    pub fn begin(
        file: Option<&Path>,
        [spec, results]: [&Path; 2],
        shard: Shard,
        [before, of]: [u64; 2],
    ) -> Result<Self, Failure> {
        let now = Instant::now();
        let shown = show_path(results);
        let mut reporter =
            Self { file: None, results: shown, shard, of, before, begun: now, written: now, trouble: None };
        let Some(file) = file else { return Ok(reporter) };
        let beside = crate::sweep::sidecar::path(results);
        let same = |other: &Path| {
            file == other
                || file.canonicalize().ok().zip(other.canonicalize().ok()).is_some_and(|(a, b)| a == b)
        };
        if [spec, results, &beside].into_iter().any(same) {
            return Err(Failure::Usage(format!(
                "--status {}: is a file of the sweep itself",
                show_path(file)
            )));
        }
        reporter.file = Some(file.to_owned());
        write_atomically(file, reporter.text("running", before, 0).as_bytes(), Overwrite::Always)?;
        Ok(reporter)
    }

    fn text(&self, state: &str, rows: u64, with_error: u64) -> String {
        let seconds = self.begun.elapsed().as_secs_f64();
        let now = rows.saturating_sub(self.before);
        let status = Status {
            schema: 1,
            state,
            results: &self.results,
            shard: self.shard.to_string(),
            rows,
            of: self.of,
            before: self.before,
            with_error,
            seconds,
            rows_per_second: (now > 0 && seconds > 0.0).then(|| now as f64 / seconds),
            process: std::process::id(),
        };
        serde_json::to_string_pretty(&status).unwrap_or_default() + "\n"
    }

    /// So many rows are there, so many of them with an error.
    pub fn tell(&mut self, rows: u64, with_error: u64) {
        if self.file.is_some() && self.written.elapsed() >= PAUSE {
            self.replace("running", rows, with_error);
        }
    }

    /// The run is over.
    pub fn end(&mut self, summary: &Summary) {
        let state = if summary.is_complete() { "complete" } else { "stopped" };
        self.replace(state, summary.before + summary.now, summary.faults.total());
    }

    fn replace(&mut self, state: &str, rows: u64, with_error: u64) {
        let Some(file) = &self.file else { return };
        // The rows matter more than this: a full disk ends the sweep by itself.
        let done = write_atomically(file, self.text(state, rows, with_error).as_bytes(), Overwrite::Always);
        self.trouble = done.err().map(|error| error.to_string());
        self.written = Instant::now();
    }
}
