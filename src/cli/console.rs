//! What goes to standard error: warnings, notes, questions.

use super::Failure;
use pulloff_engine::report::OverlapReport;
use std::io::{IsTerminal, Write};
use std::process::ExitCode;

/// Asks on standard error; any answer but `y` or `yes` is no.
pub(super) fn ask(question: &str) -> Result<(), Failure> {
    if !std::io::stdin().is_terminal() {
        return Err(Failure::Usage("nobody can be asked: --yes deletes without a question".to_owned()));
    }
    let _ = write!(std::io::stderr(), "{question} [y/N] ");
    let mut answer = String::new();
    let read = std::io::stdin().read_line(&mut answer);
    match answer.trim() {
        "y" | "yes" if read.is_ok() => Ok(()),
        _ => Err(Failure::Usage("not deleted".to_owned())),
    }
}

/// With `--strict` a failure where the result, which has been written, has inadmissible states.
pub(super) fn admissible(strict: bool, overlaps: &[OverlapReport]) -> Result<ExitCode, Failure> {
    if strict && !overlaps.is_empty() {
        let text = "the result was written, but has inadmissible states, which --strict forbids";
        return Err(Failure::Doubtful(text.to_owned()));
    }
    Ok(ExitCode::SUCCESS)
}

/// Writes warnings to standard error, one line each.
pub(super) fn warn(warnings: &[String]) {
    for warning in warnings {
        let _ = writeln!(std::io::stderr(), "pulloff: warning: {warning}");
    }
}

/// What is worth knowing, where the result has no place for it.
pub(super) fn note(text: Option<&str>) {
    if let Some(text) = text {
        let _ = writeln!(std::io::stderr(), "pulloff: note: {text}");
    }
}
