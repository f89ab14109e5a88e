//! `pulloff trace`: the equilibrium curve by arc-length continuation.

use super::Failure;
use super::computed::{Computed, Opened};
use super::format::Format;
use super::watch::StopSignal;
use clap::Args;
use pulloff_engine::report::trace::{COLUMNS, EXACT_COLUMNS, ZONE_COLUMNS};
use pulloff_engine::report::{TraceReport, columns, json, table};
use pulloff_engine::theory::Exact;
use std::process::ExitCode;

/// The arguments of `pulloff trace`.
#[derive(Debug, Args)]
pub struct TraceArguments {
    /// Add the exact solution at the same contact radius, and the relative difference of the force
    #[arg(long)]
    theory: bool,
    #[command(flatten)]
    computed: Computed,
}

pub fn run(arguments: &TraceArguments) -> Result<ExitCode, Failure> {
    let Opened { console, format, preset, sink } = arguments.computed.open(Format::Csv)?;
    let stop = StopSignal::catch()?;
    let mut report = TraceReport::compute(&preset, &console.bar(Some(&stop)))?;
    if arguments.theory {
        report = report.beside(&Exact::of(&preset.problem()));
    }
    console.warn(&report.warnings);
    console.note(report.start_note.as_deref());
    if format != Format::Json {
        let exact = if arguments.theory { EXACT_COLUMNS } else { &[] };
        let zone: &[&str] = if preset.cohesion().is_some() { ZONE_COLUMNS } else { &[] };
        let units = columns::units(&[COLUMNS, exact, zone].concat(), preset.path.control, &preset.units);
        console.note(units.as_deref());
    }
    let text = match format {
        Format::Table => table::rows(&report.table()?),
        Format::Csv => report.csv()?,
        Format::Json => json(&report)?,
    };
    sink.write(text)?;
    if report.has_reached_its_end {
        return console.end();
    }
    Err(Failure::Incomplete(format!(
        "the trace stopped early, its {} points were written: {}",
        report.points.len(),
        report.stop
    )))
}
