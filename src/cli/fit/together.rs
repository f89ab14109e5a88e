//! One law fitted to several files.

use super::done::{ended, status_of};
use super::{FitArguments, FitSinks, of_file, refused, table, with_points};
use crate::cli::Failure;
use crate::cli::console::Console;
use crate::cli::format::Format;
use crate::cli::measured::typed;
use crate::cli::watch::StopSignal;
use crate::store::Loaded;
use crate::store::atomic::folder_of;
use clap::Args;
use pulloff_engine::fit::{Options, fit_together};
use pulloff_engine::preset::edge::RATE;
use pulloff_engine::preset::{Preset, Value, write};
use pulloff_engine::report::{FitReport, TogetherReport, json};
use pulloff_engine::text::show_path;
use std::path::PathBuf;
use std::process::ExitCode;

/// The options for fitting several files at once.
#[derive(Debug, Args)]
pub(super) struct Several {
    /// Fit one law to all files: the free values of material, gap, edge and path are shared, those of data.* are each
    /// file's own; the report says whether the files follow one law
    #[arg(long, conflicts_with_all = ["residuals", "table", "profile", "bootstrap", "poisson"])]
    pub(super) together: bool,
    /// The rate of the device in each file, in order, or one for all; path.rate when left out. A file with times
    /// and the position of the device gives its own rate
    #[arg(long, value_name = "RATE,...", value_delimiter = ',')]
    pub(super) rate: Vec<String>,
}

impl Several {
    /// The rates of the files.
    pub(super) fn rates(&self, files: &[PathBuf], preset: &Preset) -> Result<Vec<f64>, Failure> {
        if self.rate.len() > 1 && self.rate.len() != files.len() {
            return Err(Failure::Usage(format!(
                "--rate: {} rates are given for {} files: give one for each, or one for all",
                self.rate.len(),
                files.len()
            )));
        }
        self.rate.iter().map(|text| typed(preset, "--rate", RATE, text)).collect()
    }
}

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
    let found = found.map_err(|(run, error)| refused(&files[run], &error))?;
    let names: Vec<String> = files.iter().map(|path| show_path(path)).collect();
    let report = TogetherReport::new(&names, &found);
    console.warn(&report.doubts);
    sinks.report.write(match sinks.format {
        Format::Json => json(&report)?,
        Format::Table => report.text(),
        Format::Csv => {
            table::csv(&report.runs.iter().map(|run| FitReport::row(&run.fit)).collect::<Vec<_>>())?
        }
    })?;
    if let Some(sink) = &sinks.fitted {
        sink.write(write(&found.preset.placed_in(folder_of(arguments.destination.path()))))?;
    }
    stopped("stopped: the result has the best values so far")?;
    ended(status_of(report.verdict.word()), arguments.accept, console)
}
