//! `pulloff`: the explorer.

use super::{Failure, Problem};
use std::process::ExitCode;

/// How the explorer looks.
#[cfg(feature = "tui")]
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Explorer")]
pub struct Flags {
    /// Colours for a dark or a light background, or none; the variable `NO_COLOR` means mono
    #[arg(long, value_enum)]
    theme: Option<crate::tui::theme::Palette>,
    /// What curves are drawn with, for fonts without braille or without blocks
    #[arg(long, value_enum)]
    charts: Option<crate::tui::theme::Charts>,
    /// Only ASCII characters, as in a locale without UTF-8
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true", hide_possible_values = true)]
    ascii: Option<bool>,
    /// Take the mouse from the start; m takes it and gives it back
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true", hide_possible_values = true)]
    mouse: Option<bool>,
}

/// A build without the explorer has nothing to look at.
#[cfg(not(feature = "tui"))]
#[derive(Debug, clap::Args)]
pub struct Flags {}

#[cfg(feature = "tui")]
pub fn run(problem: &Problem, flags: &Flags) -> Result<ExitCode, Failure> {
    use crate::tui::look::{Environment, Look, LookFile};
    // What is wrong with the preset is wrong on any terminal.
    let loaded = problem.load()?;
    if let Some(reason) = crate::tui::refuse_reason() {
        let reason = reason.strip_prefix("pulloff ").unwrap_or(&reason);
        return Err(Failure::Usage(format!("{reason} (`pulloff trace` and `pulloff unload` need none)")));
    }
    let Flags { theme, charts, ascii, mouse } = *flags;
    let look = Look::resolve(LookFile { theme, charts, ascii, mouse }, None, &Environment::of_process());
    crate::tui::run(super::store(), loaded, look).map_err(|error| Failure::Terminal(error.to_string()))
}

#[cfg(not(feature = "tui"))]
pub fn run(_problem: &Problem, _flags: &Flags) -> Result<ExitCode, Failure> {
    Err(Failure::Usage(
        "this build has no explorer (feature `tui` is off); use `pulloff trace` or `pulloff unload`"
            .to_owned(),
    ))
}
