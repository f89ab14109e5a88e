//! What is wrong with a preset, and where it came from.

use crate::preset::invalid::Invalid;
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
    /// The first mistake, of those just typed if there are any: others may follow from it. Then how many more there are.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let is_typed = |mistake: &&Mistake| matches!(mistake.origin, ValueOrigin::Assignment(_));
        let typed = self.mistakes.iter().find(is_typed);
        if let Some(first) = typed.or(self.mistakes.first()) {
            write!(f, "{first}")?;
        }
        match self.mistakes.len() {
            0 | 1 => Ok(()),
            2 => f.write_str(" (and 1 more mistake)"),
            n => write!(f, " (and {} more mistakes)", n - 1),
        }
    }
}
