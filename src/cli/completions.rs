//! `pulloff completions`: what a shell needs to complete the command line.
//!
//! A shell that has run this text asks the program itself at every Tab, with `COMPLETE` in its environment, so that it
//! offers the presets, keys and sessions that exist now.

mod shells;
mod words;

use super::{Failure, output};
use clap::{Args, Command, ValueEnum};
use clap_complete::CompleteEnv;
use clap_complete::env::Shells;
use std::env;
use std::process::ExitCode;

/// The environment variable that holds the name of the asking shell.
const ASKED: &str = "COMPLETE";
/// The name by which a shell finds the program, to complete it and to ask it.
const PROGRAM: &str = "pulloff";

/// The arguments of `pulloff completions`.
#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// The shell
    shell: Shell,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Shell {
    Bash,
    Elvish,
    Fish,
    Powershell,
    Zsh,
}

/// Writes the text that a shell runs to set up completion.
pub fn run(arguments: &CompletionsArguments) -> Result<ExitCode, Failure> {
    let name = arguments.shell.to_possible_value();
    let shell = name.and_then(|name| Shells(shells::ALL).completer(name.get_name()));
    let mut text = Vec::new();
    if let Some(shell) = shell {
        let written = shell.write_registration(ASKED, PROGRAM, PROGRAM, PROGRAM, &mut text);
        written.map_err(|cause| Failure::System { what: "the completions".to_owned(), cause })?;
    }
    output::print(text)?;
    Ok(ExitCode::SUCCESS)
}

/// Answers a shell that asks, and reports whether one did.
pub fn answered(command: impl Fn() -> Command) -> Result<bool, Failure> {
    // The variable may belong to another program.
    let is_known = |name: String| Shells(shells::ALL).completer(&name).is_some();
    if !env::var(ASKED).is_ok_and(is_known) {
        return Ok(false);
    }
    let completer = CompleteEnv::with_factory(|| words::known(command()))
        .var(ASKED)
        .bin(PROGRAM)
        .completer(PROGRAM)
        .shells(Shells(shells::ALL));
    let folder = env::current_dir().ok();
    completer
        .try_complete(env::args_os(), folder.as_deref())
        .map_err(|error| Failure::Usage(error.to_string().trim_end().to_owned()))
}
