//! `pulloff`: the explorer.

use super::{Failure, Problem};
use std::process::ExitCode;

#[cfg(feature = "tui")]
pub fn run(problem: &Problem) -> Result<ExitCode, Failure> {
    // What is wrong with the preset is wrong on any terminal.
    let loaded = problem.load()?;
    if let Some(reason) = crate::tui::refuse_reason() {
        let reason = reason.strip_prefix("pulloff ").unwrap_or(&reason);
        return Err(Failure::Usage(format!("{reason} (`pulloff trace` and `pulloff unload` need none)")));
    }
    crate::tui::run(super::store(), loaded).map_err(|error| Failure::Terminal(error.to_string()))
}

#[cfg(not(feature = "tui"))]
pub fn run(_problem: &Problem) -> Result<ExitCode, Failure> {
    Err(Failure::Usage(
        "this build has no explorer (feature `tui` is off); use `pulloff trace` or `pulloff unload`"
            .to_owned(),
    ))
}
