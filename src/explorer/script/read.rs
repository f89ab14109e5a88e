//! Reads a whole script: every line is parsed before any is run.

use super::fault::ScriptFault;
use super::parse;
use crate::explorer::command::Command;
use pulloff_engine::text::show_name;
use std::fmt;
use thiserror::Error;

/// The largest script, in bytes.
pub const LARGEST: u64 = 1 << 20;

/// The most lines in a script.
pub const MOST_LINES: usize = 20_000;

/// At most this many faults are listed.
pub(super) const FAULTS: usize = 20;

/// One line of a script.
#[derive(Debug, Clone, PartialEq)]
pub struct ScriptLine {
    /// Its number, from 1.
    pub number: usize,
    /// Whether the script continues if it fails.
    pub may_fail: bool,
    pub command: Command,
}

/// Everything that is wrong with a script, in the order of its lines.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub struct ScriptError {
    /// The script's name, safe to show.
    pub name: String,
    /// The lines, from 1, and what is wrong with them; at least one.
    pub faults: Vec<(usize, ScriptFault)>,
}

impl fmt::Display for ScriptError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (line, fault)) in self.faults.iter().enumerate() {
            let end = if i + 1 < self.faults.len() { "\n" } else { "" };
            write!(f, "{}:{line}:{}: {fault}{end}", self.name, fault.column)?;
        }
        Ok(())
    }
}

/// Reads a script; `name` is its name in messages. Nothing of it is run.
pub fn read(name: &str, text: &str) -> Result<Vec<ScriptLine>, ScriptError> {
    let (mut lines, mut faults) = (Vec::new(), Vec::new());
    for (i, text) in text.lines().enumerate() {
        let number = i + 1;
        if number > MOST_LINES {
            faults.push((number, ScriptFault::new(1, format!("a script has at most {MOST_LINES} lines"))));
            break;
        }
        match parse::script_line(text) {
            Ok(Some((may_fail, command))) => lines.push(ScriptLine { number, may_fail, command }),
            Ok(None) => {}
            Err(fault) => faults.push((number, fault)),
        }
        if faults.len() >= FAULTS {
            break;
        }
    }
    if faults.is_empty() { Ok(lines) } else { Err(ScriptError { name: show_name(name), faults }) }
}
