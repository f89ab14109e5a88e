//! Commands as text: scripts, the line typed on the screen, and the journal share one grammar.
//!
//! A line is a command's name from the [table](super::command::ROWS) and what it takes, in words divided by spaces.
//! A word with spaces, quotes or nothing in it stands in double quotes, in which `\"` and `\\` mean a quote and a backslash;
//! a quote may begin inside a word (`gap.wavelength="3 um"`). A word that begins with `#` begins a comment.
//!
//! | line | does |
//! |---|---|
//! | `open PRESET [KEY=VALUE ...]` | opens a preset, by name or path, with other values |
//! | `set KEY=VALUE ...` | other values, as one change; a bare number is SI in an SI preset |
//! | `control displacement`, `force`, `stiffness=K`, or nothing | what is controlled, or the next of them |
//! | `step [N]`, `step-length X`, `halve-step`, `double-step`, `reverse` | steps, their length, their way |
//! | `next-limit`, `run-to instability` | to the next limit point of the control |
//! | `run [N]`, `previous-limit`, `jump`, `undo`, `redo`, `restart` | as the keys of these names |
//! | `select-event N` | to the event of this number in the list |
//! | `events`, `pin`, `pins N`, `pins all` | whose events are listed; curves kept and taken away |
//! | `export WHAT FILE [replace]` | writes `curve`, `walk`, `events` or `script` |
//! | `save [replace]`, `save-as NAME [with-data] [replace]` | saves the preset |
//! | `quit` | ends the script |
//!
//! A script refuses what only changes what a screen shows (panels, views, the cross-hair, the help), and what depends on
//! a selection there (`more`, `edit`). A line that begins with `try` may fail without ending the script.
//!
//! | file | what lives there |
//! |---|---|
//! | `words` | a line → words with their columns, and the quoting |
//! | `parse` | words → a command |
//! | `print` | a command → its line |
//! | `complete` | what a line begun could go on with |
//! | `former` | the lines of a session of before, as they read now |
//! | [`mod@play`] | a script driven through a model, without a terminal |
//! | `borders` | where a script may write |

mod borders;
mod complete;
mod former;
mod parse;
pub mod play;
mod print;
mod words;

pub use complete::{Completion, complete};
pub(super) use former::without_former;
pub use parse::{for_script, parse};
pub use play::{Failed, Permission, play};
pub use print::line;

use super::command::Command;
use pulloff_engine::text::show_name;
use std::fmt;
use thiserror::Error;

/// The largest script, in bytes.
pub const LARGEST: u64 = 1 << 20;
/// The most lines of a script.
pub const MOST_LINES: usize = 20_000;
/// The longest line, in characters.
pub const LONGEST: usize = 16_384;
/// So many faults are listed.
const FAULTS: usize = 20;

/// One line of a script.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Its number, from 1.
    pub number: usize,
    /// Whether the script goes on when it fails.
    pub may_fail: bool,
    /// What is to be done.
    pub command: Command,
}

/// What is wrong with a line. Foreign text in it is safe to show.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{what}")]
pub struct Fault {
    /// The column, in characters from 1.
    pub column: usize,
    /// What is wrong and what is allowed.
    pub what: String,
}

impl Fault {
    pub(super) fn new(column: usize, what: impl Into<String>) -> Self {
        Self { column, what: what.into() }
    }
}

/// All that is wrong with a script, in the order of its lines.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub struct ScriptError {
    /// The script's name, safe to show.
    pub name: String,
    /// The lines, from 1, and what is wrong with them; at least one.
    pub faults: Vec<(usize, Fault)>,
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

/// Reads a script; `name` names it in messages. Nothing of it is done.
///
/// # Errors
/// All lines that are no commands, or none for a script.
pub fn read(name: &str, text: &str) -> Result<Vec<Line>, ScriptError> {
    let (mut lines, mut faults) = (Vec::new(), Vec::new());
    for (i, text) in text.lines().enumerate() {
        let number = i + 1;
        if number > MOST_LINES {
            faults.push((number, Fault::new(1, format!("a script has at most {MOST_LINES} lines"))));
            break;
        }
        match parse::script_line(text) {
            Ok(Some((may_fail, command))) => lines.push(Line { number, may_fail, command }),
            Ok(None) => {}
            Err(fault) => faults.push((number, fault)),
        }
        if faults.len() >= FAULTS {
            break;
        }
    }
    if faults.is_empty() { Ok(lines) } else { Err(ScriptError { name: show_name(name), faults }) }
}

#[cfg(test)]
mod tests;
