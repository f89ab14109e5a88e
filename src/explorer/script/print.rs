//! A command → its line.

use super::lexer::quoted;
use crate::explorer::command::{Assignment, Command};
use crate::explorer::export::Export;
use crate::explorer::pins::letter;

/// The line that reads back as this command; `None` for commands that need a screen.
pub fn line(command: &Command) -> Option<String> {
    let name = command.id().name();
    let rest = match command {
        Command::Plain(_) => String::new(),
        Command::Steps(count) | Command::RunOf(count) | Command::Travel { count, .. } => {
            format!(" {count}")
        }
        Command::SelectEvent(number) => format!(" event {number}"),
        Command::StepLength(length) => format!(" {length:?}"),
        Command::MoveTo(radius) => format!(" {}", quoted(radius)?),
        Command::Assign(all) => assignments(all)?,
        Command::Map { x, y } => {
            let y = y.as_ref().map_or(Some(String::new()), |y| Some(format!(" {}", quoted(y)?)))?;
            format!(" {}{y}", quoted(x)?)
        }
        Command::Go(home) => format!(" {}", home.name()),
        Command::Show(view) => format!(" {}", view.name()),
        Command::Study { column, over } => {
            format!(
                " {}{}",
                column.name(),
                over.as_ref().map_or(Some(String::new()), |over| Some(format!(" {}", quoted(over)?)))?
            )
        }
        Command::Overlay(overlay) => format!(" {}", overlay.name()),
        Command::Unpin(None) => " all".to_owned(),
        Command::Unpin(Some(number)) => format!(" {}", letter(*number)),
        Command::Open(name) => format!(" {}", quoted(name)?),
        Command::OpenWith { name, assignments: all } => format!(" {}{}", quoted(name)?, assignments(all)?),
        Command::SaveAs { name, replace, with_data } => {
            let with_data = if *with_data { " with-data" } else { "" };
            format!(" {}{with_data}{}", quoted(name)?, replacing(*replace))
        }
        Command::SaveAnyway => replacing(true).to_owned(),
        Command::HeldStep(_)
        | Command::Set { .. }
        | Command::Try { .. }
        | Command::TakeBack
        | Command::Turn { .. }
        | Command::Browse { .. }
        | Command::Pick { .. }
        | Command::GoTo { .. }
        | Command::Delete(_)
        | Command::Zoom { .. }
        | Command::Export { what: Export::Page(_), .. } => return None,
        Command::Export { what, path, replace } => {
            let view = match what {
                Export::Figure(Some(view)) => format!(" {}", view.name()),
                _ => String::new(),
            };
            format!(" {} {}{view}{}", what.name(), quoted(path)?, replacing(*replace))
        }
    };
    Some(format!("{name}{rest}"))
}

fn replacing(replace: bool) -> &'static str {
    if replace { " replace" } else { "" }
}

/// ` KEY=VALUE` for each assignment.
fn assignments(all: &[Assignment]) -> Option<String> {
    all.iter().map(|(key, text)| Some(format!(" {key}={}", quoted(text)?))).collect()
}
