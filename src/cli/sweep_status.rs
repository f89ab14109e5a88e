//! The progress of a sweep, as a small file that another program may read at any time.

use super::Failure;
use super::format::{self, Format};
use super::output::{OutputSink, Outputs, Replacing, shown};
use crate::store::file::{LARGEST, read_text};
use crate::store::stream;
use crate::sweep::{RunSummary, Shard};
use serde::Serialize;
use std::path::Path;
use std::time::{Duration, Instant};

/// The shortest time between two replacements of the file.
const PAUSE: Duration = Duration::from_secs(1);

/// The contents of the file.
#[derive(Debug, Serialize)]
struct StatusFile<'a> {
    schema: u32,
    /// `running`, `complete` or `stopped`.
    state: &'a str,
    results: &'a str,
    /// The hash of everything that determines the numbers.
    identity: &'a str,
    shard: String,
    /// The number of rows that exist, of all rows of the shard.
    rows: u64,
    of: u64,
    /// How many of them existed when this run began, and how many have an error.
    before: u64,
    with_error: u64,
    /// The time since this run began.
    seconds: f64,
    rows_per_second: Option<f64>,
    process: u32,
}

/// What a status file reports on.
#[derive(Debug, Clone)]
pub struct StatusSubject {
    /// How messages name the results.
    pub results: String,
    pub identity: String,
    pub shard: Shard,
}

impl StatusSubject {
    /// Whether `text` is a status of this very shard of this very sweep, whatever its rows.
    fn is_of(&self, text: &str) -> bool {
        let Ok(status) = serde_json::from_str::<serde_json::Value>(text) else { return false };
        let has = |name: &str, value: &str| status.get(name).and_then(|found| found.as_str()) == Some(value);
        has("identity", &self.identity) && has("shard", &self.shard.to_string())
    }

    /// Checks the status file before anything is computed.
    /// Errors: A different file exists and must not be replaced.
    pub fn sink(
        &self,
        file: &Path,
        outputs: &mut Outputs,
        replacing: Replacing,
    ) -> Result<OutputSink, Failure> {
        let refused = |what: &str| Failure::Usage(format!("--status {}: {what}", shown(file)));
        format::only("--status", file, Format::Json)?;
        if stream::is_stream(file) {
            return Err(refused("is replaced as a whole repeatedly; name a file"));
        }
        let sink = outputs.kept("--status", file)?;
        let is_ours = || read_text(file, LARGEST).is_ok_and(|(text, _)| self.is_of(&text));
        if file.exists() && !replacing.overwrite && !is_ours() {
            return Err(refused(
                "already exists, and is not the status of this sweep; --overwrite replaces it",
            ));
        }
        Ok(sink)
    }
}

/// The status file, while a sweep runs.
#[derive(Debug)]
pub struct Reporter {
    sink: Option<OutputSink>,
    subject: StatusSubject,
    of: u64,
    before: u64,
    begun: Instant,
    written: Instant,
    /// Why it could not be replaced, reported once.
    pub trouble: Option<String>,
}

impl Reporter {
    /// Writes the first status, where a file is wanted.
    /// Errors: It cannot be written.
    pub fn begin(
        sink: Option<OutputSink>,
        subject: StatusSubject,
        [before, of]: [u64; 2],
    ) -> Result<Self, Failure> {
        let now = Instant::now();
        let reporter = Self { sink, subject, of, before, begun: now, written: now, trouble: None };
        if let Some(sink) = &reporter.sink {
            sink.write(reporter.text("running", before, 0))?;
        }
        Ok(reporter)
    }

    fn text(&self, state: &str, rows: u64, with_error: u64) -> String {
        let seconds = self.begun.elapsed().as_secs_f64();
        let now = rows.saturating_sub(self.before);
        let status = StatusFile {
            schema: 1,
            state,
            results: &self.subject.results,
            identity: &self.subject.identity,
            shard: self.subject.shard.to_string(),
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

    /// Reports that `rows` rows exist, `with_error` of them with an error.
    pub fn tell(&mut self, rows: u64, with_error: u64) {
        if self.sink.is_some() && self.written.elapsed() >= PAUSE {
            self.replace("running", rows, with_error);
        }
    }

    /// Reports that the run is over.
    pub fn end(&mut self, summary: &RunSummary) {
        let state = if summary.is_complete() { "complete" } else { "stopped" };
        self.replace(state, summary.before + summary.now, summary.faults.total());
    }

    fn replace(&mut self, state: &str, rows: u64, with_error: u64) {
        let Some(sink) = &self.sink else { return };
        // The rows matter more than this file: a full disk ends the sweep anyway.
        let done = sink.write(self.text(state, rows, with_error));
        self.trouble = done.err().map(|error| error.to_string());
        self.written = Instant::now();
    }
}
