//! What can be wrong with a line of a script.

use thiserror::Error;

/// The longest line, in characters.
pub const LONGEST: usize = 16_384;

/// What is wrong with a line. Foreign text in it is safe to show.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{what}")]
pub struct ScriptFault {
    /// The column, counted in characters from 1.
    pub column: usize,
    pub what: String,
}

impl ScriptFault {
    pub(super) fn new(column: usize, what: impl Into<String>) -> Self {
        Self { column, what: what.into() }
    }
}
