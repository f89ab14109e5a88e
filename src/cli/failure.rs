//! What a command can fail with, and the exit status that says so.

use crate::case::CaseError;
use crate::preset::{StoreError, WriteError};
use crate::quasistatic::StartError;
use crate::report::rows::RowsError;
use std::io;
use std::process::ExitCode;

/// Why a command ended without success.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The preset or an assignment is bad, or cannot be read.
    #[error(transparent)]
    Preset(#[from] StoreError),
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
    /// A figure of the paper could not be computed.
    #[error(transparent)]
    Paper(#[from] crate::plot::paper::PaperError),
    /// A figure could not be drawn as pixels.
    #[cfg(feature = "png")]
    #[error(transparent)]
    Png(#[from] crate::plot::png::PngError),
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
            Self::Preset(_)
            | Self::Usage(_)
            | Self::Case(
                CaseError::EndOutsideStart { .. }
                | CaseError::Basis(_)
                | CaseError::Start {
                    error: StartError::OutOfReach { .. } | StartError::NotReached { .. }, ..
                },
            ) => 2,
            Self::Inadmissible(_) => 3,
            _ => 1,
        })
    }
}
