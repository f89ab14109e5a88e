//! `pulloff`: the explorer.

use super::{Failure, Problem};
use std::process::ExitCode;

/// Runs the explorer on a preset, or on the session `resume`: the newest where that is empty.
#[cfg(feature = "tui")]
pub fn run(problem: &Problem, resume: Option<&str>) -> Result<ExitCode, Failure> {
    use crate::explorer::archive::Archive;
    let archive = Archive::open();
    // What is wrong with the preset or the session is wrong on any terminal.
    let start = match resume {
        Some(name) => resumed(&archive, name)?,
        None => fresh(&archive, problem)?,
    };
    if let Some(reason) = crate::tui::refuse_reason() {
        let reason = reason.strip_prefix("pulloff ").unwrap_or(&reason);
        return Err(Failure::Usage(format!("{reason} (`pulloff trace` and `pulloff unload` need none)")));
    }
    crate::tui::run(super::store(), archive, start).map_err(|error| Failure::Terminal(error.to_string()))
}

#[cfg(feature = "tui")]
fn resumed(archive: &crate::explorer::archive::Archive, name: &str) -> Result<crate::tui::Start, Failure> {
    use crate::explorer::archive::ArchiveError;
    let name = if name.is_empty() { archive.newest()?.ok_or(ArchiveError::Empty)? } else { name.to_owned() };
    Ok(crate::tui::Start::Resume(Box::new(archive.load(&name)?)))
}

/// A preset; a session that was cut off is offered where no preset was asked for, and else only mentioned.
#[cfg(feature = "tui")]
fn fresh(
    archive: &crate::explorer::archive::Archive,
    problem: &Problem,
) -> Result<crate::tui::Start, Failure> {
    use crate::explorer::archive::ago;
    use crate::tui::Start;
    let loaded = Box::new(problem.load()?);
    let is_plain = problem.preset.is_none() && problem.assignments.is_empty();
    Ok(match archive.cut_off() {
        Ok(None) => Start::Preset(loaded, None),
        Ok(Some(held)) if is_plain => Start::Offer(loaded, Box::new(held)),
        Ok(Some(held)) => {
            let same = held.summary.preset_name == loaded.source.shown();
            let name = held.claim.name();
            let notice = format!("cut off {}: --resume {name} goes on", ago(held.summary.saved_at));
            Start::Preset(loaded, same.then_some(notice))
        }
        Err(notice) => Start::Preset(loaded, Some(notice)),
    })
}

/// There is no explorer in this build.
#[cfg(not(feature = "tui"))]
pub fn run(_problem: &Problem, _resume: Option<&str>) -> Result<ExitCode, Failure> {
    Err(Failure::Usage(
        "this build has no explorer (feature `tui` is off); use `pulloff trace` or `pulloff unload`"
            .to_owned(),
    ))
}
