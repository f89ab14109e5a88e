//! What a command can fail with, and the exit status that says so.

use crate::explorer::archive::ArchiveError;
use crate::mend::{Mend, Reason};
use crate::print::DrawError;
use crate::print::FormatError;
use crate::store::data::PointsError;
use crate::store::file::FileError;
use crate::store::{StoreError, WriteError};
use crate::sweep::OutputError;
use crate::sweep::merge::MergeError;
use crate::sweep::spec::LoadError;
use pulloff_engine::case::CaseError;
use pulloff_engine::report::rows::RowsError;
use std::io;
use std::process::ExitCode;

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
    /// A comparison could not be made.
    #[error(transparent)]
    Verify(#[from] pulloff_engine::verify::VerifyError),
    /// A script cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A measured curve cannot be read.
    #[error(transparent)]
    Points(#[from] PointsError),
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
    Map(#[from] crate::plot::map::MapError),
    /// A map could not be computed.
    #[error(transparent)]
    Lines(#[from] pulloff_engine::report::map::MapError),
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
    /// The system says no.
    #[error("{what}: {cause}")]
    System {
        /// What was being done, or where, safe to show.
        what: String,
        /// What it says.
        cause: io::Error,
    },
    /// The reader of standard output went away: a quiet end.
    #[error("standard output was closed")]
    Closed,
    /// Bad usage, in words.
    #[error("{0}")]
    Usage(String),
    /// A computation that stopped before its end; what it has was written.
    #[error("{0}")]
    Incomplete(String),
    /// Numbers that are not what theory says; the comparison was written.
    #[error("{0}")]
    Disagreement(String),
    /// Inadmissible states where none are allowed; the result was written.
    #[error("{0}")]
    Inadmissible(String),
    /// A line of a script failed; those before it were done.
    #[error("{text}")]
    Script {
        /// The line and the reason.
        text: String,
        /// The reason.
        reason: Reason,
    },
    /// The spec of a sweep is bad, or cannot be read.
    #[error(transparent)]
    Spec(#[from] LoadError),
    /// The results of a sweep cannot be begun, gone on with or written.
    #[error(transparent)]
    Sweep(OutputError),
    /// The parts of a sweep cannot be joined.
    #[error(transparent)]
    Merge(MergeError),
    /// A signal ended a sweep; what was done is kept.
    #[error("{text}")]
    Interrupted {
        /// The signal's number.
        signal: u8,
        /// How to go on.
        text: String,
    },
    /// The terminal failed.
    #[error("{0}")]
    Terminal(String),
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        match error {
            // Only a reader that went away breaks a pipe.
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
    /// What to say on standard error: every line names the program.
    pub fn text(&self) -> Option<String> {
        if matches!(self, Self::Closed) {
            return None;
        }
        let lines: Vec<String> = self.to_string().lines().map(|line| format!("pulloff: {line}")).collect();
        Some(lines.join("\n"))
    }

    /// The exit status.
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Closed => 0,
            Self::Inadmissible(_) => 3,
            // As a shell says it of a program that a signal ended.
            Self::Interrupted { signal, .. } => 128 + signal,
            other if other.can_be_mended() => 2,
            _ => 1,
        })
    }

    fn can_be_mended(&self) -> bool {
        match self {
            Self::Preset(error) => error.can_be_mended(),
            Self::Session(error) => error.can_be_mended(),
            Self::Case(error) => error.can_be_mended(),
            Self::File(error) => error.can_be_mended(),
            Self::Points(error) => error.can_be_mended(),
            Self::Write(error) => error.can_be_mended(),
            Self::Map(error) => error.can_be_mended(),
            Self::Lines(error) => error.can_be_mended(),
            Self::Format(error) => error.can_be_mended(),
            Self::Draw(error) => error.can_be_mended(),
            Self::Script { reason, .. } => reason.can_be_mended(),
            Self::Spec(error) => error.can_be_mended(),
            Self::Sweep(error) => error.can_be_mended(),
            Self::Merge(error) => error.can_be_mended(),
            Self::System { cause, .. } => cause.can_be_mended(),
            Self::Usage(_) => true,
            Self::Rows(_)
            | Self::Csv(_)
            | Self::Paper(_)
            | Self::Verify(_)
            | Self::Json(_)
            | Self::Closed
            | Self::Incomplete(_)
            | Self::Disagreement(_)
            | Self::Inadmissible(_)
            | Self::Interrupted { .. }
            | Self::Terminal(_) => false,
        }
    }
}
