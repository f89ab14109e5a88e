//! Why a session file cannot be read.

use thiserror::Error;

/// The version of the format. A larger one is refused; what is added without a new version has a default.
///
/// 1: the first. 2: the rows of profiles can be in files beside it. 3: undo takes back commands, not single states.
pub const FORMAT: u32 = 3;
/// The first version in which undo takes back commands.
pub const BY_COMMANDS: u32 = 3;

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
