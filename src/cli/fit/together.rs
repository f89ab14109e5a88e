//! One law fitted to several files.

use super::arguments::{FitArguments, FitSinks, of_file, refused, with_points};
use super::done::{ended, status_of};
use super::table;
use crate::cli::Failure;
use crate::cli::console::Console;
use crate::cli::format::Format;
use crate::cli::watch::StopSignal;
use crate::store::Loaded;
use pulloff_engine::fit::{Options, fit_together};
use pulloff_engine::preset::{Preset, Value};
use pulloff_engine::report::{FitReport, TogetherReport, json};
use pulloff_engine::text::show_path;
use std::path::PathBuf;
use std::process::ExitCode;

/// Fits the law and writes what was found.
pub(super) fn run(
    arguments: &FitArguments,
    (files, loaded, options): (&[PathBuf], &Loaded, &Options),
    (said, rates): (&[(&'static str, Value)], &[f64]),
    console: &Console,
    sinks: &FitSinks,
    stop: &StopSignal,
) -> Result<ExitCode, Failure> {
    let mut options = options.clone();
    let preset_of =
        |(number, path): (usize, &PathBuf)| with_points(path, loaded, &of_file(said, Some(number), rates));
    let mut presets: Vec<Preset> = files.iter().enumerate().map(preset_of).collect::<Result<_, _>>()?;
    if let [model] = arguments.model[..] {
        let asked = options.free.clone();
        for preset in &mut presets {
            (*preset, options.free) = model.laid(preset, &asked);
        }
    }
    let bar = arguments.messages.bar(Some(stop));
    let found = fit_together(&presets, &options, &bar);
    drop(bar);
    let stopped = |text: &str| {
        let interrupted = |signal| Err(Failure::Interrupted { signal, text: text.to_owned() });
        stop.signal().map_or(Ok(()), interrupted)
    };
    if found.is_err() {
        stopped("stopped: nothing was fitted")?;
    }
    let found = found.map_err(|(run, error)| refused(&files[run], &presets[run], &error))?;
    let names: Vec<String> = files.iter().map(|path| show_path(path)).collect();
    let report = TogetherReport::new(&names, &found);
    console.warn(&report.doubts);
    sinks.report.write(match sinks.format {
        Format::Json => json(&report)?,
        Format::Table => report.text(),
        Format::Csv => {
            console.note(FitReport::units(report.runs.iter().map(|run| &run.fit)).as_deref());
            table::csv(&report.runs.iter().map(|run| FitReport::row(&run.fit)).collect::<Vec<_>>())?
        }
    })?;
    if let Some(sink) = &sinks.fitted {
        sink.write(arguments.fitted(&found.preset, &options.free)?)?;
    }
    stopped("stopped: the result has the best values so far")?;
    ended(status_of(report.verdict.word()), arguments.accept, console)
}
