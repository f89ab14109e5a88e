//! `pulloff`: the explorer.

use super::Failure;
use super::console::Console;
use super::problem::ProblemArguments;
use crate::tui::look::LookWish;
use std::path::Path;
use std::process::ExitCode;

/// Runs the explorer on a preset, or on the session `resume`: the newest one where that is empty.
pub fn run(
    problem: &ProblemArguments,
    resume: Option<&str>,
    config: Option<&Path>,
    flags: LookWish,
) -> Result<ExitCode, Failure> {
    use crate::explorer::archive::Archive;
    use crate::tui::look::{Environment, Look};
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
    let look = Look::resolve(flags, settings.look, &Environment::of_process());
    crate::tui::run(super::problem::store(), archive, start, look, settings)
        .map_err(|error| Failure::Terminal(error.to_string()))
}

/// The settings from the requested file, or from the usual one; faults in the latter leave the defaults and a notice.
pub(super) fn settings(asked: Option<&Path>) -> Result<crate::tui::UserSettings, Failure> {
    use crate::tui::config::{self, ConfigError};
    use crate::tui::{UserSettings, keymap::Keymap};
    let ready = |config: Result<config::Config, ConfigError>| {
        config.and_then(|config| {
            Ok(UserSettings { keymap: Keymap::of(&config)?, look: config.look, notice: None })
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
    let name = if name.is_empty() { archive.to_resume()? } else { name.to_owned() };
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
