//! `pulloff completions`: what a shell needs to complete the command line.

use super::{Cli, Failure, output};
use clap::{Args, CommandFactory};
use clap_complete::{Shell, generate};
use std::process::ExitCode;

/// The arguments of `pulloff completions`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The shell
    shell: Shell,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let mut text = Vec::new();
    generate(arguments.shell, &mut Cli::command(), "pulloff", &mut text);
    output::write(&String::from_utf8_lossy(&text), None)?;
    Ok(ExitCode::SUCCESS)
}
