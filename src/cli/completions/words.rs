//! The words that only the program knows: presets, keys and their values, sessions.

use crate::cli::problem;
use crate::explorer::archive::Archive;
use crate::explorer::script::offers::CONTROLS;
use crate::store::Source;
use clap::{Arg, Command};
use clap_complete::engine::{ArgValueCompleter, CompletionCandidate, PathCompleter, ValueCompleter};
use pulloff_engine::preset::Preset;
use pulloff_engine::preset::groups::GROUPS;
use pulloff_engine::preset::schema::{Kind, NONE, Parameter, Row};
use pulloff_engine::stability::COMPLIANCE;
use std::env;
use std::ffi::{OsStr, OsString};
use std::path::Path;

/// The key that decides which keys `[gap]` has.
const GAP_SHAPE: &str = "gap.shape";

/// What the value of an argument is, by the name of the argument; the same in every subcommand.
const KNOWN: [(&str, Candidates); 11] = [
    ("preset", presets_or_files),
    ("assignments", assignments),
    ("free", free),
    ("uncertain", uncertain),
    ("x_key", axes),
    ("y_key", axes),
    ("control", controls),
    ("resume", sessions),
    // Both `presets` and `sessions` have an argument of this name.
    ("paths", points_or_presets),
    ("name", names),
    ("names", sessions),
];

/// Returns the candidates for a value that begins with what is typed.
type Candidates = fn(&OsStr) -> Vec<CompletionCandidate>;

/// The command, with completers added to its arguments.
pub(super) fn known(command: Command) -> Command {
    let with = |arg: Arg| match KNOWN.iter().find(|(id, _)| arg.get_id() == id) {
        Some((_, words)) => arg.add(ArgValueCompleter::new(*words)),
        None => arg,
    };
    command.mut_args(with).mut_subcommands(known)
}

/// A candidate, if it begins with what is typed.
fn candidate(typed: &str, text: String, help: &str) -> Option<CompletionCandidate> {
    let help = (!help.is_empty()).then(|| help.to_owned().into());
    text.starts_with(typed).then(|| CompletionCandidate::new(text).help(help))
}

/// What is typed so far; empty where it is not UTF-8.
fn typed(current: &OsStr) -> &str {
    current.to_str().unwrap_or_default()
}

/// The presets accepted by `is_wanted`, with their titles.
fn presets(current: &OsStr, is_wanted: fn(&Source) -> bool) -> Vec<CompletionCandidate> {
    let listed = problem::store().list().presets.into_iter().filter(|listed| is_wanted(&listed.source));
    let named = listed.filter_map(|listed| {
        candidate(typed(current), listed.name, listed.title.as_deref().unwrap_or_default())
    });
    named.collect()
}

fn files(current: &OsStr, ending: &'static str) -> Vec<CompletionCandidate> {
    let has_ending = move |path: &Path| path.extension().is_some_and(|found| found == ending);
    PathCompleter::any().filter(has_ending).complete(current)
}

fn presets_or_files(current: &OsStr) -> Vec<CompletionCandidate> {
    let mut found = presets(current, |_| true);
    found.extend(files(current, "toml"));
    found
}

/// The arguments of a fit.
fn points_or_presets(current: &OsStr) -> Vec<CompletionCandidate> {
    let mut found = PathCompleter::file().complete(current);
    found.extend(presets(current, |_| true));
    found
}

/// The names that subcommands of `presets` and `sessions` take.
fn names(current: &OsStr) -> Vec<CompletionCandidate> {
    let line = line();
    let has = |word: &str| line.iter().any(|other| other == word);
    match (has("sessions"), has("delete")) {
        (true, _) => sessions(current),
        (false, true) => presets(current, |source| matches!(source, Source::User { .. })),
        (false, false) => presets_or_files(current),
    }
}

fn sessions(current: &OsStr) -> Vec<CompletionCandidate> {
    let listed = Archive::open().list().unwrap_or_default();
    listed.into_iter().filter_map(|session| candidate(typed(current), session.name, "")).collect()
}

/// The words of the line being completed, after the name of the program.
fn line() -> Vec<OsString> {
    env::args_os().skip_while(|word| word != "--").skip(2).collect()
}

/// The preset on the line, with the assignments made there before its last word.
fn preset() -> Option<Preset> {
    let line = line();
    let store = problem::store();
    let assigned: Vec<&str> = line
        .windows(3)
        .filter(|words| words[0] == "--set")
        .filter_map(|words| words[1].to_str())
        .filter(|text| text.contains('='))
        .collect();
    let source = line.iter().rev().skip(1).find_map(|word| match store.resolve(word).ok()? {
        // A file that can be read only once is not read for this.
        Source::File(path) if !path.is_file() => None,
        source => Some(source),
    });
    let source = source.or_else(|| store.resolve(OsStr::new(crate::store::shipped::DEFAULT)).ok())?;
    if let Ok(loaded) = store.load(&source, &assigned) {
        return Some(loaded.preset);
    }
    // Another shape may need keys that are not typed yet; without them it begins as in the explorer.
    let mut preset = store.load(&source, &[] as &[&str]).ok()?.preset;
    for (key, value) in assigned.iter().filter_map(|text| text.split_once('=')) {
        let _ = preset.assign(key, value);
    }
    Some(preset)
}

/// The rows of the preset on the line, and the groups.
fn rows(preset: &Preset) -> impl Iterator<Item = Row> {
    let groups = GROUPS.iter().filter(|row| preset.get(&row.key).is_some());
    // The table has the keys of all shapes.
    let own = preset.rows().filter(|row| row.fits(GAP_SHAPE, preset.gap.name()));
    own.chain(groups.map(Row::Borrowed))
}

fn assignments(current: &OsStr) -> Vec<CompletionCandidate> {
    let (Some(preset), typed) = (preset(), typed(current)) else { return Vec::new() };
    if let Some((key, value)) = typed.split_once('=') {
        let Some(row) = preset.row(key) else { return Vec::new() };
        return values(&row, value, key);
    }
    rows(&preset).filter_map(|row| candidate(typed, format!("{}=", row.key), &row.meaning)).collect()
}

/// The values that a key takes, or the files.
fn values(row: &Parameter, typed: &str, key: &str) -> Vec<CompletionCandidate> {
    let word = |word: &str| candidate(typed, word.to_owned(), "");
    let mut found: Vec<CompletionCandidate> = match row.kind {
        Kind::Choice(words) => words.iter().filter_map(|text| word(text)).collect(),
        Kind::Control => controls(OsStr::new(typed)),
        Kind::Smoothing => {
            [NONE, pulloff_engine::preset::schema::AUTO].into_iter().filter_map(word).collect()
        }
        Kind::Points => word(NONE).into_iter().collect(),
        _ => Vec::new(),
    };
    if matches!(row.kind, Kind::File | Kind::Points) {
        found.extend(PathCompleter::any().complete(OsStr::new(typed)));
    }
    found.into_iter().map(|candidate| candidate.add_prefix(format!("{key}="))).collect()
}

/// Keys separated by commas.
fn free(current: &OsStr) -> Vec<CompletionCandidate> {
    numbers(current, "")
}

fn uncertain(current: &OsStr) -> Vec<CompletionCandidate> {
    numbers(current, "=")
}

/// The keys that a fit can change, for the last item of a list, each followed by `behind`.
fn numbers(current: &OsStr, behind: &str) -> Vec<CompletionCandidate> {
    let (Some(preset), typed) = (preset(), typed(current)) else { return Vec::new() };
    let (before, last) = typed.rfind(',').map_or(("", typed), |at| typed.split_at(at + 1));
    let numbers = preset.rows().filter(|row| row.kind.is_number() && !row.key.starts_with("path.start"));
    let keys = numbers.filter_map(|row| candidate(last, format!("{}{behind}", row.key), &row.meaning));
    keys.map(|candidate| candidate.add_prefix(before)).collect()
}

fn axes(current: &OsStr) -> Vec<CompletionCandidate> {
    let (Some(preset), typed) = (preset(), typed(current)) else { return Vec::new() };
    let numbers = rows(&preset).filter(|row| row.kind.is_number());
    let keys = numbers.filter_map(|row| candidate(typed, format!("{}=", row.key), &row.meaning));
    keys.chain(candidate(typed, format!("{COMPLIANCE}="), "1/k of the device, from 0 to inf")).collect()
}

fn controls(current: &OsStr) -> Vec<CompletionCandidate> {
    CONTROLS.into_iter().filter_map(|word| candidate(typed(current), word.to_owned(), "")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each name belongs to an argument somewhere, and the command remains valid.
    #[test]
    fn every_name_is_that_of_an_argument() {
        fn ids(command: &Command, all: &mut Vec<String>) {
            all.extend(command.get_arguments().map(|arg| arg.get_id().to_string()));
            command.get_subcommands().for_each(|below| ids(below, all));
        }
        let command = known(crate::cli::command());
        let mut all = Vec::new();
        ids(&command, &mut all);
        for (id, _) in KNOWN {
            assert!(all.iter().any(|other| other == id), "{id} is not in {all:?}");
        }
        command.debug_assert();
    }
}
