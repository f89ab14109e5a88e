//! What a command can fail with, and the exit status that says so.

use crate::case::CaseError;
use crate::explorer::archive::ArchiveError;
use crate::preset::{StoreError, WriteError};
use crate::print::{DrawError, FormatError};
use crate::quasistatic::StartError;
use crate::report::rows::RowsError;
use crate::sweep::OutputError;
use crate::sweep::merge::MergeError;
use crate::sweep::spec::LoadError;
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
    /// Standard output could not be written.
    #[error("standard output: {0}")]
    Output(io::Error),
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
    #[error("{0}")]
    Script(String),
    /// The spec of a sweep is bad, or cannot be read.
    #[error(transparent)]
    Spec(#[from] LoadError),
    /// The results of a sweep cannot be begun, gone on with or written.
    #[error(transparent)]
    Sweep(#[from] OutputError),
    /// The parts of a sweep cannot be joined.
    #[error(transparent)]
    Merge(#[from] MergeError),
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
            Self::Map(_)
            | Self::Preset(_)
            | Self::Session(
                ArchiveError::NotFound { .. }
                | ArchiveError::Empty
                | ArchiveError::Running { .. }
                | ArchiveError::Unreadable { .. }
                | ArchiveError::NoFolder,
            )
            | Self::Usage(_)
            | Self::Format(_)
            | Self::Spec(_)
            | Self::Case(
                CaseError::EndOutsideStart { .. }
                | CaseError::Basis(_)
                | CaseError::Start {
                    error: StartError::OutOfReach { .. } | StartError::NotReached { .. }, ..
                },
            )
            | Self::Merge(
                MergeError::Exists { .. }
                | MergeError::NotOurs { .. }
                | MergeError::OtherSweep { .. }
                | MergeError::OtherDivision { .. }
                | MergeError::Doubled { .. }
                | MergeError::Missing(_),
            ) => 2,
            Self::Sweep(error) | Self::Merge(MergeError::Output(error)) if is_refusal(error) => 2,
            Self::Inadmissible(_) => 3,
            // As a shell says it of a program that a signal ended.
            Self::Interrupted { signal, .. } => 128 + signal,
            _ => 1,
        })
    }
}

/// Whether results were refused for what they are, not for what the system says.
fn is_refusal(error: &OutputError) -> bool {
    match error {
        OutputError::Write(error) => {
            matches!(error, WriteError::Exists { .. } | WriteError::NotRegular { .. })
        }
        OutputError::Io { .. } | OutputError::Threads(_) => false,
        _ => true,
    }
}
