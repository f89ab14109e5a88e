//! What goes to standard error (warnings, notes, questions, progress), and how `--quiet` and `--strict` affect it.

use super::Failure;
use super::watch::{Bar, Lines, StopSignal};
use clap::Args;
use std::cell::Cell;
use std::io::{IsTerminal, Write};
use std::process::ExitCode;

/// What is written to standard error, and what a warning means.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct Messages {
    /// Write nothing to standard error except why the command failed: no warnings, no notes, no progress
    #[arg(long, short)]
    quiet: bool,
    /// Exit with status 3 after a warning; the result is still written
    #[arg(long)]
    strict: bool,
}

/// Standard error, as used by a command.
#[derive(Debug, Default)]
pub struct Console {
    messages: Messages,
    warned: Cell<usize>,
}

impl Messages {
    /// The progress bar.
    pub fn bar(self, stop: Option<&StopSignal>) -> Bar<'_> {
        Bar::begin(stop, self.quiet)
    }

    /// The console of a command that begins now.
    pub fn open(self) -> Console {
        Console { messages: self, warned: Cell::new(0) }
    }
}

impl Console {
    /// Writes a line; an error is ignored, since nobody may be listening.
    pub fn say(&self, text: &str) {
        if !self.messages.quiet {
            let _ = writeln!(std::io::stderr(), "pulloff: {text}");
        }
    }

    /// Writes warnings, one per line; `--strict` counts them.
    pub fn warn(&self, warnings: &[String]) {
        self.warn_beside(warnings, 0);
    }

    /// The same where the first `told` of them are in a result on the same terminal.
    pub fn warn_beside(&self, warnings: &[String], told: usize) {
        self.warned.set(self.warned.get() + warnings.len());
        for warning in &warnings[told..] {
            self.say(&format!("warning: {warning}"));
        }
    }

    /// Writes a remark that has no place in the result.
    pub fn note(&self, text: Option<&str>) {
        if let Some(text) = text {
            self.say(&format!("note: {text}"));
        }
    }

    /// The progress bar.
    pub fn bar<'a>(&self, stop: Option<&'a StopSignal>) -> Bar<'a> {
        self.messages.bar(stop)
    }

    /// The progress of a script of `count` lines.
    pub fn lines(&self, count: usize) -> Lines {
        Lines::begin(count, self.messages.quiet)
    }

    pub fn is_quiet(&self) -> bool {
        self.messages.quiet
    }

    /// Ends a command that succeeded and has written its result: a failure under `--strict` if there was a warning.
    pub fn end(&self) -> Result<ExitCode, Failure> {
        if !self.messages.strict || self.warned.get() == 0 {
            return Ok(ExitCode::SUCCESS);
        }
        let warnings = match self.warned.get() {
            1 => "a warning".to_owned(),
            count => format!("{count} warnings"),
        };
        Err(Failure::Doubtful(format!("the result was written, with {warnings}, which --strict forbids")))
    }
}

/// Asks on standard error; any answer but `y` or `yes` is no.
pub(super) fn ask(question: &str) -> Result<(), Failure> {
    if !std::io::stdin().is_terminal() {
        return Err(Failure::Usage("nobody can answer here: --yes deletes without asking".to_owned()));
    }
    let _ = write!(std::io::stderr(), "{question} [y/N] ");
    let mut answer = String::new();
    let read = std::io::stdin().read_line(&mut answer);
    match answer.trim() {
        "y" | "yes" if read.is_ok() => Ok(()),
        _ => Err(Failure::Usage("not deleted".to_owned())),
    }
}
