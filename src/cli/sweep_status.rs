//! How far a sweep is, as a small file that another program may read at any time.

use super::Failure;
use super::format::{self, Format};
use super::output::{OutputSink, Outputs, Replacing, shown};
use crate::store::file::{LARGEST, read_text};
use crate::store::stream;
use crate::sweep::{RunSummary, Shard};
use serde::Serialize;
use std::path::Path;
use std::time::{Duration, Instant};

/// The file is replaced so often at most.
const PAUSE: Duration = Duration::from_secs(1);

/// What the file says.
#[derive(Debug, Serialize)]
struct StatusFile<'a> {
    schema: u32,
    /// `running`, `complete` or `stopped`.
    state: &'a str,
    results: &'a str,
    /// The hash of all that the numbers follow from.
    identity: &'a str,
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

/// Of what a status file tells.
#[derive(Debug, Clone)]
pub struct StatusSubject {
    /// How messages call the results.
    pub results: String,
    pub identity: String,
    pub shard: Shard,
}

impl StatusSubject {
    /// Whether `text` is a status of this very part of this very sweep, whatever its rows.
    fn is_of(&self, text: &str) -> bool {
        let Ok(status) = serde_json::from_str::<serde_json::Value>(text) else { return false };
        let has = |name: &str, value: &str| status.get(name).and_then(|found| found.as_str()) == Some(value);
        has("identity", &self.identity) && has("shard", &self.shard.to_string())
    }

    /// Looks at the file of the status before anything is computed.
    /// Errors: There is another file, and it is not to be replaced.
    pub fn sink(
        &self,
        file: &Path,
        outputs: &mut Outputs,
        replacing: Replacing,
    ) -> Result<OutputSink, Failure> {
        let refused = |what: &str| Failure::Usage(format!("--status {}: {what}", shown(file)));
        format::only("--status", file, Format::Json)?;
        if stream::is_stream(file) {
            return Err(refused("is replaced as a whole again and again; name a file"));
        }
        let sink = outputs.kept("--status", file)?;
        let is_ours = || read_text(file, LARGEST).is_ok_and(|(text, _)| self.is_of(&text));
        if file.exists() && !replacing.overwrite && !is_ours() {
            return Err(refused(
                "exists already, and is not the status of this sweep; --overwrite replaces it",
            ));
        }
        Ok(sink)
    }
}

/// The file, while a sweep runs.
#[derive(Debug)]
pub struct Reporter {
    sink: Option<OutputSink>,
    subject: StatusSubject,
    of: u64,
    before: u64,
    begun: Instant,
    written: Instant,
    /// Why it could not be replaced, once.
    pub trouble: Option<String>,
}

impl Reporter {
    /// Begins the file, where one is wanted.
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

    /// So many rows are there, so many of them with an error.
    pub fn tell(&mut self, rows: u64, with_error: u64) {
        if self.sink.is_some() && self.written.elapsed() >= PAUSE {
            self.replace("running", rows, with_error);
        }
    }

    /// The run is over.
    pub fn end(&mut self, summary: &RunSummary) {
        let state = if summary.is_complete() { "complete" } else { "stopped" };
        self.replace(state, summary.before + summary.now, summary.faults.total());
    }

    fn replace(&mut self, state: &str, rows: u64, with_error: u64) {
        let Some(sink) = &self.sink else { return };
        // The rows matter more than this: a full disk ends the sweep by itself.
        let done = sink.write(self.text(state, rows, with_error));
        self.trouble = done.err().map(|error| error.to_string());
        self.written = Instant::now();
    }
}
