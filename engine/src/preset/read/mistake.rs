//! What is wrong with a preset, and where it came from.

use crate::preset::invalid::Invalid;
use crate::text::listed;
use std::fmt;
use thiserror::Error;

/// Where a value came from. Names and texts in it have already been made safe to show.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ValueOrigin {
    /// A file, and the line if known.
    File {
        /// The file's name.
        name: String,
        /// The line, from 1.
        line: Option<usize>,
    },
    /// An assignment, as typed.
    Assignment(String),
}

impl fmt::Display for ValueOrigin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { name, line: Some(line) } => write!(f, "{name}:{line}"),
            Self::File { name, line: None } => f.write_str(name),
            Self::Assignment(text) => write!(f, "--set {text}"),
        }
    }
}

/// One thing wrong with a preset, and where.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{origin}: {invalid}")]
pub struct Mistake {
    /// Where it is.
    pub origin: ValueOrigin,
    /// What it is.
    pub invalid: Invalid,
}

/// Everything that is wrong with a preset, in the order of its lines; at least one mistake.
#[derive(Debug, Clone, PartialEq, Error)]
pub struct ReadError {
    /// The mistakes.
    pub mistakes: Vec<Mistake>,
}

impl fmt::Display for ReadError {
    /// One mistake a line. Those just typed come first: others may follow from them.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let is_typed = |mistake: &&Mistake| matches!(mistake.origin, ValueOrigin::Assignment(_));
        let (typed, others): (Vec<&Mistake>, Vec<&Mistake>) = self.mistakes.iter().partition(is_typed);
        f.write_str(&listed(typed.into_iter().chain(others)))
    }
}
