//! What a panic leaves behind: a file in the person's state folder, and a limited number of them.

use std::{
    backtrace::Backtrace,
    env, fs,
    os::unix::fs::DirBuilderExt,
    path::{Path, PathBuf},
    process,
    time::{SystemTime, UNIX_EPOCH},
};

use etcetera::BaseStrategy;

use crate::store::atomic::{Overwrite, write_atomically};
use pulloff_engine::text::{sanitize, show_path};

/// The number of reports kept.
const KEPT: usize = 10;
/// Longest line of a report.
const LINE: usize = 1000;
const PREFIX: &str = "panic-";
const SUFFIX: &str = ".txt";

/// Writes a report about a panic, and says where it is.
pub(super) fn write(what: &str, trace: &Backtrace) -> Result<String, String> {
    let home = etcetera::base_strategy::Xdg::new().map_err(|error| error.to_string())?;
    let folder = home.state_dir().ok_or("no folder for reports is known")?.join("pulloff/reports");
    write_in(&folder, &text(what, trace)).map(|path| show_path(&path))
}

/// The whole report, without anything that a terminal showing it would obey.
fn text(what: &str, trace: &Backtrace) -> String {
    let command: Vec<String> = env::args_os().map(|word| word.to_string_lossy().into_owned()).collect();
    let all = format!(
        "{what}\n{} {} on {} {}\ncommand line: {}\nTERM: {}\n\n{trace}\n",
        env!("CARGO_PKG_NAME"),
        env!("CARGO_PKG_VERSION"),
        env::consts::OS,
        env::consts::ARCH,
        command.join(" "),
        env::var("TERM").unwrap_or_default(),
    );
    visible(&all)
}

/// The text without anything that a terminal would obey: a message may quote a file.
pub(super) fn visible(text: &str) -> String {
    let lines: Vec<String> = text.lines().map(|line| sanitize(line, LINE)).collect();
    lines.join("\n") + "\n"
}

fn write_in(folder: &Path, text: &str) -> Result<PathBuf, String> {
    let made = fs::DirBuilder::new().recursive(true).mode(0o700).create(folder);
    made.map_err(|error| format!("{}: {error}", show_path(folder)))?;
    make_room(folder);
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let path = folder.join(format!("{PREFIX}{}-{}{SUFFIX}", since.as_millis(), process::id()));
    write_atomically(&path, text.as_bytes(), Overwrite::Never).map_err(|error| error.to_string())?;
    Ok(path)
}

/// Removes the oldest reports; the names begin with their time.
fn make_room(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let mut names: Vec<String> = entries
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX))
        .collect();
    names.sort_unstable();
    for name in names.iter().rev().skip(KEPT - 1) {
        // One report too many is no reason to lose the new one.
        let _ = fs::remove_file(folder.join(name));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_cannot_steer_the_terminal() {
        assert_eq!(
            visible("a\n\x1b]0;t\x07\u{9b}31m\u{202e}ä"),
            "a\n\u{fffd}]0;t\u{fffd}\u{fffd}31m\u{fffd}ä\n"
        );
    }

    #[test]
    fn reports_are_bounded_and_nothing_else_is_removed() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("state/reports");
        let mut last = write_in(&folder, "first").unwrap();
        fs::write(folder.join("notes.txt"), "mine").unwrap();
        for _ in 0..2 * KEPT {
            // Two within a millisecond would have the same name; a program panics only once.
            while let Err(error) = write_in(&folder, "again").map(|path| last = path) {
                assert!(error.contains("exists"), "{error}");
            }
        }
        assert_eq!(fs::read_dir(&folder).unwrap().count(), KEPT + 1);
        assert!(folder.join("notes.txt").exists());
        assert_eq!(fs::read_to_string(last).unwrap(), "again");
    }

    #[test]
    fn a_report_says_what_happened_and_with_which_program() {
        let said = text("it broke", &Backtrace::force_capture());
        assert!(said.starts_with("it broke\npulloff ") && said.contains("command line: "), "{said}");
        assert!(said.contains("a_report_says_what_happened"), "the trace names functions: {said}");
    }
}
