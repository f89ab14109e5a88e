//! `pulloff run`: a script of the explorer's commands, without a terminal.

use super::Failure;
use super::problem::{Problem, store};
use crate::explorer::command::by_name;
use crate::explorer::export::{Page, Picture};
use crate::explorer::script::{self, Permission, ScriptLine, play};
use crate::explorer::{Inline, Model, open};
use crate::plot::picture::picture;
use crate::store::stream::{self, STANDARD};
use crate::tui::copy::screen;
use clap::Args;
use pulloff_engine::text::sanitize;
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The arguments of `pulloff run`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The script, one command a line; - reads standard input
    script: PathBuf,
    /// The preset it begins with, by name or file; - reads standard input; the wavy sphere when left out
    #[arg(long, value_name = "PRESET|FILE.toml")]
    preset: Option<OsString>,
    /// Give a key of the preset another value, such as gap.amplitude=0.003 (repeatable; the last of one key holds)
    ///
    /// In an SI preset a bare number is SI, and a value may have its unit: "gap.amplitude=2 um". A dimensionless group
    /// changes what it follows from: `groups.amplitude_over_wavelength`, `groups.wavelength_over_radius`, `groups.adhesion`.
    /// An SI preset is shown in the units of its display keys: display.force=mN.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    assignments: Vec<String>,
    /// Let the script replace files
    #[arg(long)]
    overwrite: bool,
    /// Let the script write files outside the current folder
    #[arg(long)]
    anywhere: bool,
    /// Say on standard error what became of each line
    #[arg(long, short)]
    verbose: bool,
}

/// Longest account of a line.
const ACCOUNT: usize = 200;

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    if arguments.script == Path::new(STANDARD)
        && arguments.preset.as_ref().is_some_and(|name| name == STANDARD)
    {
        let text = "standard input holds the script or the preset, not both: name a file for one of them";
        return Err(Failure::Usage(text.to_owned()));
    }
    let (name, text) = stream::read_given(&arguments.script, script::LARGEST)?;
    let lines = script::read(&name, &text).map_err(|error| Failure::Usage(error.to_string()))?;
    let chosen = arguments.preset.is_some() || !arguments.assignments.is_empty();
    if chosen && lines.first().is_some_and(|line| script::play::opens(&line.command)) {
        let text = format!("{name}: opens a preset of its own: --preset and --set would be lost");
        return Err(Failure::Usage(text));
    }
    let problem = Problem { preset: arguments.preset.clone(), assignments: arguments.assignments.clone() };
    let (mut model, effects) = open(problem.load()?);
    let permission = Permission { overwrite: arguments.overwrite, anywhere: arguments.anywhere };
    let mut told = |line: &ScriptLine, model: &Model| {
        if arguments.verbose {
            account(line, model);
        }
    };
    play(&mut model, &Inline::new(store()), effects, &lines, permission, &drawn, &mut told)
        .map_err(|failed| Failure::Script { text: format!("{name}:{failed}"), reason: failed.reason })?;
    Ok(ExitCode::SUCCESS)
}

/// What a screen would show, drawn.
fn drawn(model: &Model, what: Picture) -> Result<Page, String> {
    match what {
        Picture::Screen => Ok(Page::Screen(screen(model))),
        Picture::Figure(view) => picture(model, view.unwrap_or(model.view)).map(Page::Figure),
    }
}

/// What became of a line, in one line.
fn account(line: &ScriptLine, model: &Model) {
    let command = script::line(&line.command).unwrap_or_default();
    let text = format!("{}: {command}: {}", line.number, by_name(&model.status().1));
    // Nobody may be listening.
    let _ = writeln!(io::stderr(), "{}", sanitize(&text, ACCOUNT));
}
