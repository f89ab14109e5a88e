//! `pulloff`: the explorer.

use super::Failure;
use super::console::Console;
use super::problem::ProblemArguments;
use std::path::Path;
use std::process::ExitCode;

/// How the explorer looks.
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
    /// Take the mouse from the start; the command mouse takes it and gives it back
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true", hide_possible_values = true)]
    mouse: Option<bool>,
}

/// Runs the explorer on a preset, or on the session `resume`: the newest one where that is empty.
pub fn run(
    problem: &ProblemArguments,
    resume: Option<&str>,
    config: Option<&Path>,
    flags: &Flags,
) -> Result<ExitCode, Failure> {
    use crate::explorer::archive::Archive;
    use crate::tui::look::{Environment, Look, LookFile};
    let archive = Archive::open();
    // A fault in the preset, the session or the requested settings is an error on any terminal.
    let start = match resume {
        Some(name) => resumed(&archive, name)?,
        None => fresh(&archive, problem)?,
    };
    let settings = settings(config)?;
    if let Some(reason) = crate::tui::refuse_reason() {
        let reason = reason.strip_prefix("pulloff ").unwrap_or(&reason);
        return Err(Failure::Usage(format!("{reason} (`pulloff trace` and `pulloff unload` need none)")));
    }
    if let Some(notice) = &settings.notice {
        let _ = std::io::Write::write_fmt(&mut std::io::stderr(), format_args!("pulloff: {notice}\n"));
    }
    let Flags { theme, charts, ascii, mouse } = *flags;
    let asked = LookFile { theme, charts, ascii, mouse };
    let look = Look::resolve(asked, Some(settings.look), &Environment::of_process());
    crate::tui::run(super::problem::store(), archive, start, look, settings)
        .map_err(|error| Failure::Terminal(error.to_string()))
}

/// The settings from the requested file, or from the usual one; faults in the latter leave the defaults and a notice.
pub(super) fn settings(asked: Option<&Path>) -> Result<crate::tui::UserSettings, Failure> {
    use crate::config::{self, ConfigError};
    use crate::tui::{UserSettings, keymap::Keymap, look::LookFile};
    let ready = |config: Result<config::Config, ConfigError>| {
        config.and_then(|config| {
            Ok(UserSettings { keymap: Keymap::of(&config)?, look: LookFile::of(&config), notice: None })
        })
    };
    if let Some(path) = asked {
        return ready(config::load(path)).map_err(|error| Failure::Usage(error.to_string()));
    }
    let usual =
        config::path().map_or_else(|| Ok(config::Config::default()), |path| config::load_if_there(&path));
    Ok(ready(usual).unwrap_or_else(|error| UserSettings {
        notice: Some(format!("the settings are not used: {error}")),
        ..UserSettings::default()
    }))
}

fn resumed(archive: &crate::explorer::archive::Archive, name: &str) -> Result<crate::tui::Opening, Failure> {
    use crate::explorer::archive::ArchiveError;
    let name = if name.is_empty() { archive.newest()?.ok_or(ArchiveError::Empty)? } else { name.to_owned() };
    Ok(crate::tui::Opening::Resume(Box::new(archive.load(&name)?)))
}

/// Starts from a preset. A session that was cut off is offered if no preset was asked for, and otherwise only mentioned.
fn fresh(
    archive: &crate::explorer::archive::Archive,
    problem: &ProblemArguments,
) -> Result<crate::tui::Opening, Failure> {
    use crate::explorer::archive::ago;
    use crate::tui::Opening;
    let loaded = Box::new(problem.load(&Console::default())?);
    let is_plain = problem.preset.is_none() && problem.changes.is_empty();
    Ok(match archive.cut_off() {
        Ok(None) => Opening::Preset(loaded, None),
        Ok(Some(held)) if is_plain => Opening::Offer(loaded, Box::new(held)),
        Ok(Some(held)) => {
            let same = held.summary.preset_name == loaded.source.shown();
            let name = held.claim.name();
            let notice = format!("cut off {}: --resume {name} goes on", ago(held.summary.saved_at));
            Opening::Preset(loaded, same.then_some(notice))
        }
        Err(notice) => Opening::Preset(loaded, Some(notice)),
    })
}
