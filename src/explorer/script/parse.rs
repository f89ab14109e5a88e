//! Words → a command.

use super::arguments::{Rest, unknown};
use super::fault::ScriptFault;
use super::lexer::{Word, split};
use crate::explorer::command::Command;
use crate::explorer::table::{ROWS, Script, called, row_of};

/// The word before a command that may fail.
const TRY: &str = "try";

/// The command of a line; `None` if there is none.
pub fn parse(line: &str) -> Result<Option<Command>, ScriptFault> {
    let words = split(line)?;
    let Some((name, rest)) = words.split_first() else { return Ok(None) };
    command(name, Rest { words: rest, end: line.trim_end().chars().count() + 2 }).map(Some)
}

/// The command of a script's line and whether it may fail.
pub(super) fn script_line(line: &str) -> Result<Option<(bool, Command)>, ScriptFault> {
    let words = split(line)?;
    let may_fail = words.first().is_some_and(|word| word.text == TRY);
    let Some((name, rest)) = words[usize::from(may_fail)..].split_first() else {
        return if may_fail { Err(ScriptFault::new(1, "try needs a command")) } else { Ok(None) };
    };
    let command = command(name, Rest { words: rest, end: line.trim_end().chars().count() + 2 })?;
    match for_script(&command) {
        Ok(()) => Ok(Some((may_fail, command))),
        Err(what) => Err(ScriptFault::new(name.column, what)),
    }
}

/// Whether a command is meaningful without a screen.
pub fn for_script(command: &Command) -> Result<(), String> {
    let row = row_of(command.id());
    let is_plain = matches!(command, Command::Plain(_));
    let why = match row.script {
        Script::Screen => "only changes what a screen shows".to_owned(),
        Script::Needs(what) if is_plain => format!("needs {what}"),
        Script::Selected(says) if is_plain => {
            format!("needs a selection on the screen; a script says set {says}")
        }
        _ => return Ok(()),
    };
    Err(format!("{} {why}", row.name))
}

fn command(name: &Word, mut rest: Rest<'_>) -> Result<Command, ScriptFault> {
    if name.text == TRY {
        return Err(ScriptFault::new(name.column, "try is for scripts, once, before a command"));
    }
    let Some(row) = called(&name.text) else {
        let names: Vec<&str> = ROWS.iter().map(|row| row.name).chain([TRY]).collect();
        return Err(unknown(name, "command", &names));
    };
    let takes = row.takes;
    let reads = takes.is_needed || !takes.what.is_empty() && !rest.words.is_empty();
    let command = if reads { (takes.read)(&mut rest)? } else { row.id.into() };
    rest.done(command)
}
