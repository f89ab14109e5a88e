//! `pulloff verify`: compares our numbers with theory.

use super::Failure;
use super::format::{Format, FormatArgument};
use super::output::{Destination, Inputs};
use clap::Args;
use pulloff_engine::report::{VerifyReport, json, table};
use pulloff_engine::verify::{VerifySettings, verify};
use std::process::ExitCode;

/// The arguments of `pulloff verify`.
#[derive(Debug, Args)]
pub struct VerifyArguments {
    /// Only the rows whose heading or name contains this
    #[arg(long, value_name = "PATTERN")]
    only: Option<String>,
    #[command(flatten)]
    format: FormatArgument,
    #[command(flatten)]
    destination: Destination,
}

pub fn run(arguments: &VerifyArguments) -> Result<ExitCode, Failure> {
    let format = arguments.format.of(arguments.destination.path(), Format::Table)?;
    let sink = arguments.destination.sink(Inputs::default())?;
    let groups = verify(&VerifySettings::default())?;
    let report = VerifyReport::new(&groups, arguments.only.as_deref());
    if report.total == 0 {
        let headings: Vec<&str> = groups.iter().map(|group| group.title.as_str()).collect();
        return Err(Failure::Usage(format!(
            "--only: no row contains that text; the headings are\n  {}",
            headings.join("\n  ")
        )));
    }
    sink.write(match format {
        Format::Table => table::verify(&report),
        Format::Csv => report.table()?.csv()?,
        Format::Json => json(&report)?,
    })?;
    verdict(&report)
}

/// Success only when every row passes.
fn verdict(report: &VerifyReport) -> Result<ExitCode, Failure> {
    if report.passed == report.total {
        return Ok(ExitCode::SUCCESS);
    }
    Err(Failure::Disagreement(format!("disagrees with theory: only {}", report.verdict())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::Status;

    #[test]
    fn one_row_that_fails_is_exit_status_one() {
        // Too few rings for the waves of Fig. 9: they cannot follow its curve.
        let groups = verify(&VerifySettings { rings: 40 }).unwrap();
        let report = VerifyReport::new(&groups, None);
        assert!(report.passed < report.total);
        let failure = verdict(&report).unwrap_err();
        assert_eq!(failure.status(), Status::Failed);
        assert!(failure.text().unwrap().contains(&report.verdict()));
    }
}
