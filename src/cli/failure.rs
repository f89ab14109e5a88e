//! The exit statuses of the program, and the ways in which a command can fail.

use crate::explorer::archive::ArchiveError;
use crate::mend::{Mend, WordedFault, mend};
use crate::print::DrawError;
use crate::print::FormatError;
use crate::store::data::PointsFileError;
use crate::store::file::FileError;
use crate::store::{StoreError, WriteError};
use crate::sweep::OutputError;
use crate::sweep::merge::MergeError;
use crate::sweep::spec::LoadError;
use pulloff_engine::case::CaseError;
use pulloff_engine::progress::Stopped;
use pulloff_engine::report::map::MapError;
use pulloff_engine::report::pull::PullError;
use pulloff_engine::report::rows::RowsError;
use std::io;
use std::process::ExitCode;

/// How the program ended: the table of exit statuses, from best to worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Status {
    /// Everything was done.
    Done,
    /// There is a result, but it is in doubt: a warning under `--strict`, or values that are not determined.
    Doubtful,
    /// There is a result, but the model does not describe the data.
    NotDescribed,
    /// Another call or another file can mend it.
    Mendable,
    /// Something failed that another call cannot mend.
    Failed,
    /// The explorer lost its terminal.
    HungUp,
    /// Ctrl-C.
    Cancelled,
    /// SIGTERM.
    Terminated,
    /// A fault in the program.
    Fault,
}

impl Status {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 9] = [
        Self::Done,
        Self::Failed,
        Self::Mendable,
        Self::Doubtful,
        Self::NotDescribed,
        Self::Fault,
        Self::HungUp,
        Self::Cancelled,
        Self::Terminated,
    ];

    /// The number that the shell sees. For a signal it is 128 plus the signal's number, as a shell reports a program
    /// ended by a signal.
    pub const fn code(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::Failed => 1,
            Self::Mendable => 2,
            Self::Doubtful => 3,
            Self::NotDescribed => 4,
            Self::Fault => 101,
            Self::HungUp => 129,
            Self::Cancelled => 130,
            Self::Terminated => 143,
        }
    }

    /// What it means, in words.
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Failed => {
                "something failed: a full disk, a curve or fit that did not finish, a row of verify, every row of a sweep"
            }
            Self::Mendable => {
                "what you can fix: a bad value, option or file, a path that leads nowhere or must not be written, a file that already exists"
            }
            Self::Doubtful => {
                "the result is written, but has a warning that --strict forbids, or a fit whose points do not determine its values"
            }
            Self::NotDescribed => "the result is written, but the model does not describe the measured curve",
            Self::Fault => "a fault in the program, with a message and a report",
            Self::HungUp => "the explorer lost its terminal",
            Self::Cancelled => "stopped by Ctrl-C; a sweep, and the table of a fit, keep what is done",
            Self::Terminated => "stopped by SIGTERM, likewise",
        }
    }

    /// The status of a program stopped by this signal.
    pub const fn of_signal(signal: u8) -> Self {
        if signal == 2 { Self::Cancelled } else { Self::Terminated }
    }

    /// The table for the book.
    pub fn markdown() -> String {
        let row = |status: Self| format!("| {} | {} |\n", status.code(), status.meaning());
        let rows: String = Self::ALL.into_iter().map(row).collect();
        format!("| status | when |\n|---|---|\n{rows}")
    }
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        Self::from(status.code())
    }
}

/// Why a command ended without success.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The preset or an assignment is bad, or cannot be read.
    #[error(transparent)]
    Preset(#[from] StoreError),
    /// A session cannot be read, resumed or deleted.
    #[error(transparent)]
    Session(#[from] ArchiveError),
    /// The problem could not be computed.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// There is no pull at a rate.
    #[error(transparent)]
    Pull(#[from] PullError),
    /// A comparison could not be made.
    #[error(transparent)]
    Verify(#[from] pulloff_engine::verify::VerifyError),
    /// A script cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A measured curve cannot be read.
    #[error(transparent)]
    Points(#[from] PointsFileError),
    /// The result could not be written to a file.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The result could not be written as CSV.
    #[error(transparent)]
    Rows(#[from] RowsError),
    /// The data of a figure could not be written as CSV.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// The results of a sweep make no map.
    #[error(transparent)]
    Map(#[from] crate::plot::map::MapChartError),
    /// A map could not be computed.
    #[error(transparent)]
    Lines(#[from] MapError),
    /// A figure of the paper could not be computed.
    #[error(transparent)]
    Paper(#[from] crate::plot::paper::PaperError),
    /// A figure has no file of this name.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// A figure could not be drawn.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// The result could not be written as JSON.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// The operating system refused.
    #[error("{what}: {cause}")]
    System {
        /// What was being done, or where; safe to show.
        what: String,
        /// The system's message.
        cause: io::Error,
    },
    /// The reader of standard output went away; the program ends quietly.
    #[error("standard output was closed")]
    Closed,
    /// Bad usage, with the message.
    #[error("{0}")]
    Usage(String),
    /// A computation that stopped before its end; its partial result was written.
    #[error("{0}")]
    Incomplete(String),
    /// Numbers that differ from theory; the comparison was written.
    #[error("{0}")]
    Disagreement(String),
    /// A result in doubt, because of inadmissible states where none are allowed or values that are not determined; it
    /// was written.
    #[error("{0}")]
    Doubtful(String),
    /// Points that the model does not describe; the result was written.
    #[error("{0}")]
    NotDescribed(String),
    /// A line of a script failed; those before it were done.
    #[error("{text}")]
    Script {
        /// The line and the reason.
        text: String,
        /// The reason.
        reason: WordedFault,
    },
    /// The spec of a sweep is bad, or cannot be read.
    #[error(transparent)]
    Spec(#[from] LoadError),
    /// The results of a sweep cannot be started, continued or written.
    #[error(transparent)]
    Sweep(OutputError),
    /// The parts of a sweep cannot be joined.
    #[error(transparent)]
    Merge(MergeError),
    /// A signal stopped the command; what was done is kept.
    #[error("{text}")]
    Interrupted {
        /// The signal's number.
        signal: u8,
        /// How to continue.
        text: String,
    },
    /// The terminal failed.
    #[error("{0}")]
    Terminal(String),
}

impl From<rayon::ThreadPoolBuildError> for Failure {
    fn from(error: rayon::ThreadPoolBuildError) -> Self {
        Self::Sweep(error.into())
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        match error {
            // A pipe breaks only when its reader goes away.
            OutputError::Io { cause, .. } if cause.kind() == io::ErrorKind::BrokenPipe => Self::Closed,
            error => Self::Sweep(error),
        }
    }
}

impl From<MergeError> for Failure {
    fn from(error: MergeError) -> Self {
        match error {
            MergeError::Output(error) => error.into(),
            error => Self::Merge(error),
        }
    }
}

impl Failure {
    /// The text for standard error; every line names the program.
    pub fn text(&self) -> Option<String> {
        if matches!(self, Self::Closed) {
            return None;
        }
        let lines: Vec<String> = self.to_string().lines().map(|line| format!("pulloff: {line}")).collect();
        Some(lines.join("\n"))
    }

    /// The exit status.
    pub fn status(&self) -> Status {
        match self {
            Self::Closed => Status::Done,
            Self::Doubtful(_) => Status::Doubtful,
            Self::NotDescribed(_) => Status::NotDescribed,
            Self::Interrupted { signal, .. } => Status::of_signal(*signal),
            other if other.can_be_mended() => Status::Mendable,
            _ => Status::Failed,
        }
    }

    /// The same failure, or a report that `signal` stopped the command where the computation ended because of it.
    #[must_use]
    pub fn or_stopped(self, signal: Option<u8>) -> Self {
        match (signal, &self) {
            (
                Some(signal),
                Self::Case(CaseError::Stopped(Stopped))
                | Self::Pull(PullError::Case(CaseError::Stopped(Stopped)))
                | Self::Lines(MapError::Stopped(Stopped) | MapError::Case(CaseError::Stopped(Stopped))),
            ) => Self::Interrupted { signal, text: "stopped: nothing was written".to_owned() },
            _ => self,
        }
    }
}

mend!(
    Failure,
    as 0 of Preset | Session | Case | Pull | File | Points | Write | Map | Lines | Format | Draw | Spec
        | Sweep | Merge,
    as reason of Script,
    as cause of System,
    never Rows | Csv | Paper | Verify | Json | Closed | Incomplete | Disagreement | Doubtful | NotDescribed
        | Interrupted | Terminal, always Usage);
