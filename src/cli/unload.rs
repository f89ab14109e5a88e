//! `pulloff unload`: the quasi-static unloading, instability by instability.

use super::console::{admissible, note, warn};
use super::problem::Problem;
use super::watch::{Bar, Stop};
use super::{Failure, output};
use clap::{Args, ValueEnum};
use pulloff_engine::quasistatic::PathStop;
use pulloff_engine::report::unload::COLUMNS;
use pulloff_engine::report::{UnloadReport, columns, json, table};
use std::path::PathBuf;
use std::process::ExitCode;

/// The arguments of `pulloff unload`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    problem: Problem,
    /// What the loading device prescribes: displacement, force or stiffness=K, in an SI preset also as stiffness=5N/m (instead of the preset's)
    #[arg(long, value_name = "CONTROL")]
    control: Option<String>,
    /// table is for reading; csv has one row per instability; json has everything [default: by the ending of the file, else
    /// table]
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Exit with status 3 where a state is inadmissible: the next crest would already touch
    #[arg(long)]
    strict: bool,
    /// Write to this file instead of standard output, which is -
    #[arg(short, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Format {
    Table,
    Csv,
    Json,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let file = arguments.output.as_deref();
    let format = output::format(arguments.format, file, Format::Table)?;
    let loaded = arguments.problem.load()?;
    output::spares(file, "-o", &loaded)?;
    let mut preset = loaded.preset;
    if let Some(control) = &arguments.control {
        preset
            .assign("path.control", control)
            .map_err(|invalid| Failure::Usage(format!("--control: {invalid}")))?;
    }
    let report = UnloadReport::compute_while(&preset, &Bar::begin(Some(&Stop::catch()?)))?;
    warn(&report.warnings);
    let text = match format {
        Format::Table => table::unload(&report),
        Format::Csv => {
            note(columns::units(COLUMNS, report.control, &preset.units).as_deref());
            report.csv()?
        }
        Format::Json => json(&report)?,
    };
    output::write(&text, file)?;
    if [PathStop::PullOff, PathStop::End].iter().any(|end| report.stop == end.to_string()) {
        return admissible(arguments.strict, report.inadmissible.as_deref().unwrap_or_default());
    }
    Err(Failure::Incomplete(format!(
        "the unloading stopped early, its {} events were written: {}",
        report.events.len(),
        report.stop
    )))
}
