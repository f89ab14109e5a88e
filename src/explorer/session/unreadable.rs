//! Why a session file cannot be read.

use thiserror::Error;

/// The version of the format. A larger one is refused; what is added without a new version has a default.
pub const FORMAT: u32 = 2;
/// The version of a session with nothing beside it, which programs before profiles had files of their own read as well.
pub const WITHIN: u32 = 1;

/// Why a document is no session of this program.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Unreadable {
    #[error("the session is damaged: {0}")]
    Damaged(String),
    /// Of a later version of the program.
    #[error(
        "the session has format {format}, of a later pulloff (it was written by {program}); this one reads format \
         {FORMAT}"
    )]
    Future { format: u32, program: String },
}
