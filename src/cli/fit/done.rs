//! Handles the fits of many files as they finish: reports each, puts it into the table, and sums all up at the end.

use super::arguments::{FitArguments, FitSinks};
use super::summary::FitSummary;
use super::table;
use crate::cli::console::Console;
use crate::cli::format::Format;
use crate::cli::watch::StopSignal;
use crate::cli::{Failure, Status};
use crate::store::Loaded;
use pulloff_engine::fit::{Models, Verdict};
use pulloff_engine::report::{FitReport, ModelsReport, SCHEMA, json, residuals};
use pulloff_engine::text::show_path;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What has been fitted so far.
pub(super) struct FinishedFits<'a> {
    arguments: &'a FitArguments,
    console: &'a Console,
    sinks: FitSinks,
    reports: Vec<FitReport>,
    /// The comparison, where several models were compared.
    compared: Option<ModelsReport>,
    worst: Status,
}

impl<'a> FinishedFits<'a> {
    pub(super) fn new(arguments: &'a FitArguments, console: &'a Console, sinks: FitSinks) -> Self {
        Self { arguments, console, sinks, reports: Vec::new(), compared: None, worst: Status::Done }
    }

    /// The files that the table does not have yet.
    pub(super) fn left(&mut self, files: &[PathBuf]) -> Vec<PathBuf> {
        let mut left = Vec::new();
        for path in files {
            let Some(state) = self.sinks.table.as_ref().and_then(|table| table.state(path)) else {
                left.push(path.clone());
                continue;
            };
            self.console.note(Some(&format!("{}: is already in the table: {state}", show_path(path))));
            self.worst = self.worst.max(status_of(state));
        }
        left
    }

    /// Writes the result for one file to every requested output.
    pub(super) fn keep(&mut self, path: &Path, models: &Models, stop: &StopSignal) -> Result<(), Failure> {
        let arguments = self.arguments;
        let Some((found, free)) = models.best() else {
            return self.refuse(
                path,
                &Failure::Incomplete(format!("{}: no model could be fitted", show_path(path))),
            );
        };
        if models.fits.len() > 1 {
            self.compared = Some(ModelsReport::new(&show_path(path), models, arguments.poisson));
        }
        let report = FitReport::new(&show_path(path), found, arguments.poisson);
        // A table gives the reasons too.
        let is_told = models.fits.len() == 1
            && self.sinks.format == Format::Table
            && arguments.destination.is_terminal();
        self.console.warn_beside(&report.doubts, if is_told { report.reasons.len() } else { 0 });
        // A rerun computes again what was cut off.
        if let Some(table) = self.sinks.table.as_mut().filter(|_| stop.signal().is_none()) {
            let fingerprint = table.fingerprint(path);
            table.add(path, Some(&fingerprint), &report.row())?;
        }
        if let Some(sink) = &self.sinks.residuals {
            self.console.note(report.units_of_residuals().as_deref());
            sink.write(residuals::csv(&report.residuals))?;
        }
        if let Some(sink) = &self.sinks.fitted {
            sink.write(arguments.fitted(&found.preset, free)?)?;
        }
        self.worst = self.worst.max(status_of(report.verdict.word()));
        self.reports.push(report);
        Ok(())
    }

    /// Says why a file among many could not be fitted.
    pub(super) fn refuse(&mut self, path: &Path, failure: &Failure) -> Result<(), Failure> {
        self.console.warn(&[failure.to_string()]);
        self.worst = self.worst.max(failure.status());
        match &mut self.sinks.table {
            Some(table) => table.add(path, None, &failed(show_path(path), failure)),
            None => Ok(()),
        }
    }

    /// Writes the report, with a summary if the file is one of `many`, and returns how the command ended.
    pub(super) fn end(self, many: bool, loaded: &Loaded, stop: &StopSignal) -> Result<ExitCode, Failure> {
        let Self { arguments, console, sinks, reports, compared, worst, .. } = self;
        let summary = match &sinks.table {
            Some(table) => FitSummary::of(table.header(), table.rows()),
            None => FitSummary::of_reports(&reports),
        };
        let summary = Some(summary).filter(|_| many);
        if sinks.format == Format::Csv || sinks.table.is_some() {
            let fits = compared.as_ref().map_or(&reports, |compared| &compared.fits);
            console.note(FitReport::units(fits).as_deref());
        }
        sinks.report.write(match (sinks.format, reports.as_slice(), &compared) {
            (Format::Json, _, Some(compared)) => json(compared)?,
            (Format::Table, _, Some(compared)) => compared.text(),
            (Format::Json, [report], None) if !many => json(report)?,
            (Format::Json, reports, None) => {
                json(&serde_json::json!({ "schema": SCHEMA, "document": "fits", "fits": reports, "summary": summary }))?
            }
            (Format::Csv, reports, compared) => {
                let fits = compared.as_ref().map_or(reports, |compared| &compared.fits);
                table::csv(&fits.iter().map(FitReport::row).collect::<Vec<_>>())?
            }
            (Format::Table, reports, None) => {
                let summary = summary.map(|summary| summary.text(&loaded.preset));
                reports.iter().map(FitReport::text).chain(summary).collect::<Vec<_>>().join("\n")
            }
        })?;
        if let Some(signal) = stop.signal() {
            let text = if sinks.table.is_some() {
                "stopped: the table has the files that are done; the same command goes on from there"
            } else if reports.is_empty() {
                "stopped: nothing was fitted"
            } else {
                "stopped: the result has the best values so far"
            };
            let text = text.to_owned();
            return Err(Failure::Interrupted { signal, text });
        }
        ended(worst, arguments.accept, console)
    }
}

/// The end of a command whose worst fit ended in the status `worst`.
pub(super) fn ended(worst: Status, accepts: bool, console: &Console) -> Result<ExitCode, Failure> {
    match worst {
        Status::Done => console.end(),
        Status::Doubtful => {
            let text = "the points do not determine all values; the result says which";
            Err(Failure::Doubtful(text.to_owned()))
        }
        Status::NotDescribed if accepts => Ok(ExitCode::SUCCESS),
        Status::NotDescribed => {
            let text =
                "the model does not describe all points; the result says why, and --accept takes it anyway";
            Err(Failure::NotDescribed(text.to_owned()))
        }
        Status::Mendable => {
            let text = "not every file could be fitted; a warning says why";
            Err(Failure::Usage(text.to_owned()))
        }
        _ => {
            let text = "not every fit finished; the result has the best values so far";
            Err(Failure::Incomplete(text.to_owned()))
        }
    }
}

/// The header and the row of a file that could not be fitted.
fn failed(file: String, failure: &Failure) -> [Vec<String>; 2] {
    let text = failure.to_string().replace('\n', "; ");
    [["file", "verdict"].map(str::to_owned).to_vec(), vec![file, text]]
}

/// How good a fit of this verdict is.
pub(super) fn status_of(verdict: &str) -> Status {
    match Verdict::of(verdict) {
        Some(Verdict::Describes) => Status::Done,
        Some(Verdict::DoesNotDescribe) => Status::NotDescribed,
        Some(Verdict::NotDetermined) => Status::Doubtful,
        Some(Verdict::NotConverged) | None => Status::Failed,
    }
}
