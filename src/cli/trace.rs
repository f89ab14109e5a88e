//! `pulloff trace`: the equilibrium curve by arc-length continuation.

use super::console::{admissible, note, warn};
use super::problem::Problem;
use super::watch::{Bar, Stop};
use super::{Failure, output};
use clap::{Args, ValueEnum};
use pulloff_engine::quasistatic::CurveStop;
use pulloff_engine::report::trace::{COLUMNS, EXACT_COLUMNS};
use pulloff_engine::report::{TraceReport, columns, json};
use pulloff_engine::theory::Exact;
use std::path::PathBuf;
use std::process::ExitCode;

/// The arguments of `pulloff trace`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    problem: Problem,
    /// csv has one row per point; json also has the limit points and the problem [default: by the ending of the file, else
    /// csv]
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Add the exact solution at the same contact radius, and the relative difference of the force
    #[arg(long)]
    theory: bool,
    /// Exit with status 3 where a state is inadmissible: the next crest would already touch
    #[arg(long)]
    strict: bool,
    /// Write to this file instead of standard output, which is -
    #[arg(short, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Format {
    Csv,
    Json,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let file = arguments.output.as_deref();
    let format = output::format(arguments.format, file, Format::Csv)?;
    let loaded = arguments.problem.load()?;
    output::spares(file, "-o", &loaded)?;
    let mut report = TraceReport::compute_while(&loaded.preset, &Bar::begin(Some(&Stop::catch()?)))?;
    if arguments.theory {
        report = report.beside(&Exact::of(&loaded.preset.problem()));
    }
    warn(&report.warnings);
    note(report.start_note.as_deref());
    let text = match format {
        Format::Csv => {
            let exact = if arguments.theory { EXACT_COLUMNS } else { &[] };
            let preset = &loaded.preset;
            note(columns::units(&[COLUMNS, exact].concat(), preset.path.control, &preset.units).as_deref());
            report.csv()?
        }
        Format::Json => json(&report)?,
    };
    output::write(&text, file)?;
    if report.stop == CurveStop::End.to_string() {
        return admissible(arguments.strict, &report.inadmissible);
    }
    Err(Failure::Incomplete(format!(
        "the trace stopped early, its {} points were written: {}",
        report.points.len(),
        report.stop
    )))
}
