//! `pulloff trace`: the equilibrium curve by arc-length continuation.

use super::{Failure, Problem, admissible, note, output, warn};
use crate::quasistatic::CurveStop;
use crate::report::{TraceReport, json};
use crate::theory::Exact;
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::process::ExitCode;

/// The arguments of `pulloff trace`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    problem: Problem,
    /// csv has one row per point; json also has the limit points and the problem
    #[arg(long, value_enum, default_value = "csv")]
    format: Format,
    /// Add the exact solution at the same contact radius, and the relative difference of the force
    #[arg(long)]
    theory: bool,
    /// Exit with status 3 where a state is inadmissible: the next crest would already touch
    #[arg(long)]
    strict: bool,
    /// Write to this file instead of standard output
    #[arg(short, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Format {
    Csv,
    Json,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let loaded = arguments.problem.load()?;
    output::spares(arguments.output.as_deref(), "-o", &loaded)?;
    let mut report = TraceReport::compute(&loaded.preset)?;
    if arguments.theory {
        report = report.beside(&Exact::of(&loaded.preset.problem()));
    }
    warn(&report.warnings);
    note(report.start_note.as_deref());
    let text = match arguments.format {
        Format::Csv => report.csv()?,
        Format::Json => json(&report)?,
    };
    output::write(&text, arguments.output.as_deref())?;
    if report.stop == CurveStop::End.to_string() {
        return admissible(arguments.strict, &report.inadmissible);
    }
    Err(Failure::Incomplete(format!(
        "the trace stopped early, its {} points were written: {}",
        report.points.len(),
        report.stop
    )))
}
