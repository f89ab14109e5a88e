//! `pulloff unload`: the quasi-static unloading, instability by instability.

use super::Failure;
use super::console::Messages;
use super::format::{Format, FormatArgument};
use super::output::Destination;
use super::problem::Problem;
use super::watch::Stop;
use clap::Args;
use pulloff_engine::quasistatic::PathStop;
use pulloff_engine::report::unload::COLUMNS;
use pulloff_engine::report::{UnloadReport, columns, json, table};
use std::process::ExitCode;

/// The arguments of `pulloff unload`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    problem: Problem,
    #[command(flatten)]
    format: FormatArgument,
    #[command(flatten)]
    destination: Destination,
    #[command(flatten)]
    messages: Messages,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let console = arguments.messages.open();
    let format = arguments.format.of(arguments.destination.path(), Format::Table)?;
    let loaded = arguments.problem.load(&console)?;
    let sink = arguments.destination.sink(arguments.problem.inputs(&loaded))?;
    let preset = loaded.preset;
    let stop = Stop::catch()?;
    let report = UnloadReport::compute_while(&preset, &console.bar(Some(&stop)))?;
    console.warn(&report.warnings);
    let text = match format {
        Format::Table => table::unload(&report),
        Format::Csv => {
            console.note(columns::units(COLUMNS, report.control, &preset.units).as_deref());
            report.csv()?
        }
        Format::Json => json(&report)?,
    };
    sink.write(text)?;
    if [PathStop::PullOff, PathStop::End].iter().any(|end| report.stop == end.to_string()) {
        return console.end();
    }
    Err(Failure::Incomplete(format!(
        "the unloading stopped early, its {} events were written: {}",
        report.events.len(),
        report.stop
    )))
}
