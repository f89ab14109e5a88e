//! Why a session file cannot be read.

use thiserror::Error;

/// The version of the format; anything added without a new version has a default.
pub const FORMAT: u32 = 8;

/// Why a document is not a session of this program.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Unreadable {
    #[error("the session is damaged: {0}")]
    Damaged(String),
    /// Written by another version of the program.
    #[error(
        "the session has format {format} (it was written by pulloff {program}); this one reads format {FORMAT}"
    )]
    Format { format: u32, program: String },
}
