//! `pulloff`: the explorer.

use super::Failure;
use std::ffi::OsString;
use std::process::ExitCode;

#[cfg(feature = "tui")]
pub fn run(preset: Option<&OsString>) -> Result<ExitCode, Failure> {
    if let Some(reason) = crate::tui::refuse_reason() {
        let reason = reason.strip_prefix("pulloff ").unwrap_or(&reason);
        return Err(Failure::Usage(format!("{reason} (`pulloff trace` and `pulloff unload` need none)")));
    }
    let loaded = super::load(preset, &[])?;
    crate::tui::run(super::store(), loaded).map_err(|error| Failure::Terminal(error.to_string()))
}

#[cfg(not(feature = "tui"))]
pub fn run(_preset: Option<&OsString>) -> Result<ExitCode, Failure> {
    Err(Failure::Usage(
        "this build has no explorer (feature `tui` is off); use `pulloff trace` or `pulloff unload`"
            .to_owned(),
    ))
}
