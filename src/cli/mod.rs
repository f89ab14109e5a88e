//! The command line: one file per subcommand, exit codes, what goes to which stream.
//!
//! | exit status | when |
//! |---|---|
//! | 0 | success |
//! | 1 | something failed: the computation, a full disk |
//! | 2 | what the person can mend: bad usage, a bad value, a path that leads nowhere or must not be written |
//! | 3 | with `--strict`: the result has inadmissible states |
//! | 130, 143 | a sweep was stopped by Ctrl-C or SIGTERM; what was done is kept |
//!
//! Results go to standard output, everything else to standard error. A reader that goes away early
//! (`| head`) is a quiet end.

mod assigned;
mod completions;
mod explore;
mod failure;
mod figures;
mod man;
mod output;
mod plot;
mod presets;
mod run;
mod sessions;
mod sweep;
mod trace;
mod unload;
mod verify;

pub use failure::Failure;

use crate::store::file::LARGEST;
use crate::store::stream::{self, STANDARD};
use crate::store::{Loaded, Source, Store, StoreError};
use clap::{Args, CommandFactory, Parser, Subcommand};
use pulloff_engine::report::OverlapReport;
use signal_hook::consts::SIGXFSZ;
use signal_hook::flag;
use std::ffi::{OsStr, OsString};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

/// Explore adhesive contact: trace the equilibrium curve of a sphere on a surface and step its detachment.
#[derive(Debug, Parser)]
#[command(name = "pulloff", version, args_conflicts_with_subcommands = true, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    problem: Problem,
    /// Go on with a session that was left or cut off: the newest, or the one of this name
    #[arg(long, value_name = "NAME", num_args = 0..=1, default_missing_value = "",
          conflicts_with_all = ["preset", "assignments"])]
    resume: Option<String>,
    /// Take the settings of the explorer from this file; pulloff/config.toml in the configuration folder when left out
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    #[command(flatten)]
    flags: explore::Flags,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Trace the equilibrium curve and write its points
    Trace(trace::Arguments),
    /// Unload quasi-statically and write every instability
    Unload(unload::Arguments),
    /// Draw a view as a figure for print
    Plot(plot::Arguments),
    /// Compute the figures of the paper again: pictures, numbers and captions
    Figures(figures::Arguments),
    /// Compute one preset over many values of its keys, on all cores, into a CSV file
    Sweep(sweep::Arguments),
    /// Check this program's numbers against theory
    Verify(verify::Arguments),
    /// Run a script of the explorer's commands
    Run(run::Arguments),
    /// List and show presets
    #[command(subcommand)]
    Presets(presets::Command),
    /// List, show and delete sessions of the explorer
    #[command(subcommand)]
    Sessions(sessions::Command),
    /// Write the completions of a shell to standard output
    Completions(completions::Arguments),
    /// Write the manual page to standard output
    Man,
}

/// Which problem, as the explorer and every computing command take it.
#[derive(Debug, Args)]
struct Problem {
    /// A preset's name, or a preset file (with a '/' or ending in .toml; - is standard input); the wavy sphere when left out
    #[arg(value_name = "PRESET|FILE.toml")]
    preset: Option<OsString>,
    /// Give a key of the preset another value, such as gap.amplitude=0.003 (repeatable; the last of one key holds)
    ///
    /// In an SI preset a bare number is SI, and a value may have its unit: "gap.amplitude=2 um". A dimensionless group
    /// changes what it follows from: `groups.amplitude_over_wavelength`, `groups.wavelength_over_radius`, `groups.adhesion`.
    /// An SI preset is shown in the units of its display keys: display.force=mN.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    assignments: Vec<String>,
}

impl Problem {
    fn load(&self) -> Result<Loaded, Failure> {
        load(self.preset.as_ref(), &self.assignments)
    }
}

/// The store of presets; a preset cannot have the name of a subcommand.
pub fn store() -> Store {
    let command = Cli::command();
    let names: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).chain(["help"]).collect();
    Store::open(&names)
}

/// What the argument `preset` names: the text itself where it comes through a pipe, which can be read but once.
fn source(store: &Store, preset: &OsStr) -> Result<Source, Failure> {
    let path = Path::new(preset);
    if preset != STANDARD {
        match store.resolve(preset)? {
            Source::File(path) if stream::is_stream(&path) => {}
            source => return Ok(source),
        }
    }
    let (name, text) = stream::read_text(path, LARGEST).map_err(StoreError::from)?;
    Ok(Source::Piped { name, text: text.into() })
}

fn load(preset: Option<&OsString>, assignments: &[String]) -> Result<Loaded, Failure> {
    let store = store();
    let source = match preset {
        Some(argument) => source(&store, argument)?,
        None => store.resolve(crate::store::shipped::DEFAULT)?,
    };
    let loaded = store.load(&source, assignments)?;
    assigned::tell(&store, &source, assignments, &loaded.preset);
    Ok(loaded)
}

/// Makes the limit on the size of files an error of the write that meets it, as a full disk is, and not a signal that kills.
fn outlive_the_limit() {
    // A signal that is caught lets the write return. Should it not be caught, it kills as ever.
    let _ = flag::register(SIGXFSZ, Arc::default());
}

/// Runs the command line of this process.
pub fn run() -> ExitCode {
    outlive_the_limit();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version are no errors; clap knows which stream and status each has.
            let _ = error.print();
            return ExitCode::from(if error.use_stderr() { 2 } else { 0 });
        }
    };
    let result = match &cli.command {
        None => explore::run(&cli.problem, cli.resume.as_deref(), cli.config.as_deref(), &cli.flags),
        Some(Command::Trace(arguments)) => trace::run(arguments),
        Some(Command::Unload(arguments)) => unload::run(arguments),
        Some(Command::Plot(arguments)) => plot::run(arguments),
        Some(Command::Figures(arguments)) => figures::run(arguments),
        Some(Command::Sweep(arguments)) => sweep::run(arguments),
        Some(Command::Verify(arguments)) => verify::run(arguments),
        Some(Command::Run(arguments)) => run::run(arguments),
        Some(Command::Completions(arguments)) => completions::run(arguments),
        Some(Command::Man) => man::run(),
        Some(Command::Presets(command)) => presets::run(command),
        Some(Command::Sessions(command)) => sessions::run(command),
    };
    match result {
        Ok(code) => code,
        Err(failure) => {
            if let Some(text) = failure.text() {
                let _ = writeln!(std::io::stderr(), "{text}");
            }
            failure.exit_code()
        }
    }
}

/// Asks on standard error; any answer but `y` or `yes` is no.
fn ask(question: &str) -> Result<(), Failure> {
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
fn admissible(strict: bool, overlaps: &[OverlapReport]) -> Result<ExitCode, Failure> {
    if strict && !overlaps.is_empty() {
        let text = "the result was written, but has inadmissible states, which --strict forbids";
        return Err(Failure::Inadmissible(text.to_owned()));
    }
    Ok(ExitCode::SUCCESS)
}

/// Writes warnings to standard error, one line each.
fn warn(warnings: &[String]) {
    for warning in warnings {
        let _ = writeln!(std::io::stderr(), "pulloff: warning: {warning}");
    }
}

/// What is worth knowing, where the result has no place for it.
fn note(text: Option<&str>) {
    if let Some(text) = text {
        let _ = writeln!(std::io::stderr(), "pulloff: note: {text}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
