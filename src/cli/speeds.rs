//! `pulloff speeds`: the energy release rate of a measured curve beside the speed of its edge.

use super::Failure;
use super::console::Messages;
use super::format::{Format, FormatArgument};
use super::measured::{ReadingArguments, apart, attach};
use super::output::Destination;
use super::problem::{Changes, ProblemArguments};
use super::watch::StopSignal;
use clap::Args;
use pulloff_engine::report::speeds::{COLUMNS, MeasuredPair, SpeedsError};
use pulloff_engine::report::{SpeedsReport, columns, json, table};
use pulloff_engine::text::show_path;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

/// The arguments of `pulloff speeds`.
#[derive(Debug, Args)]
pub struct SpeedsArguments {
    /// A file with a measured curve, followed by a preset's name or file (ending in .toml), the wavy sphere when left
    /// out; or only a preset that names its curve in data.file
    #[arg(required = true, num_args = 1..=2, value_name = "FILE [PRESET]")]
    paths: Vec<OsString>,
    /// What G is computed from: force and radius when left out, or force and approach for a file without contact radii
    #[arg(long, value_name = "COLUMNS", value_parser = MeasuredPair::ALL.map(MeasuredPair::name))]
    from: Option<String>,
    #[command(flatten)]
    changes: Changes,
    #[command(flatten)]
    reading: ReadingArguments,
    #[command(flatten)]
    format: FormatArgument,
    #[command(flatten)]
    destination: Destination,
    #[command(flatten)]
    messages: Messages,
}

pub fn run(arguments: &SpeedsArguments) -> Result<ExitCode, Failure> {
    let console = arguments.messages.open();
    let format = arguments.format.of(arguments.destination.path(), Format::Table)?;
    let (preset, files) = apart(&arguments.paths)?;
    let file = match &files[..] {
        [] => None,
        [file] => Some(file),
        [_, other, ..] => {
            return Err(Failure::Usage(format!("{}: neither a preset nor its file", show_path(other))));
        }
    };
    let problem = ProblemArguments { preset, changes: arguments.changes.clone() };
    let mut loaded = problem.load_for(file.is_some(), &console)?;
    let inputs = problem.inputs(&loaded);
    let inputs = file.map_or(inputs.clone(), |file| inputs.with("the points", file));
    let sink = arguments.destination.sink(inputs)?;
    attach(&mut loaded.preset, file.map(PathBuf::as_path), &arguments.reading.said()?)?;
    let preset = &loaded.preset;
    let stop = StopSignal::catch()?;
    let pair = MeasuredPair::ALL.into_iter().find(|pair| arguments.from.as_deref() == Some(pair.name()));
    let report =
        SpeedsReport::compute(preset, pair, &console.bar(Some(&stop))).map_err(|error| match error {
            SpeedsError::Case(error) => error.into(),
            error => Failure::Usage(error.to_string()),
        })?;
    console.warn(&report.warnings);
    for note in &report.notes {
        console.note(Some(note));
    }
    if format != Format::Json {
        console.note(columns::units(COLUMNS, preset.path.control, &preset.units).as_deref());
    }
    sink.write(match format {
        Format::Table => table::rows(&report.table()?),
        Format::Csv => report.table()?.csv()?,
        Format::Json => json(&report)?,
    })?;
    console.end()
}
