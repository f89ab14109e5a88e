//! `pulloff completions`: what a shell needs to complete the command line.

use super::{Failure, output};
use clap::{Args, Command};
use clap_complete::{Shell, generate};
use std::process::ExitCode;

/// The arguments of `pulloff completions`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The shell
    shell: Shell,
}

/// Writes the completions of `command`.
pub fn run(arguments: &Arguments, mut command: Command) -> Result<ExitCode, Failure> {
    let mut text = Vec::new();
    generate(arguments.shell, &mut command, "pulloff", &mut text);
    output::print(text)?;
    Ok(ExitCode::SUCCESS)
}
