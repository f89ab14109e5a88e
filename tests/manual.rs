//! The README says what the program does: its generated parts are current.
//!
//! `UPDATE_README=1 cargo test --test manual` writes them.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff::preset::manual::key_table;
use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Standard output of the program in an empty home.
fn output(arguments: &[&str]) -> String {
    let home = tempfile::tempdir().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_pulloff"));
    command.env_clear().env("HOME", home.path()).env("XDG_CONFIG_HOME", home.path());
    let output = command.args(arguments).stdin(Stdio::null()).output().unwrap();
    assert!(output.status.success(), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn fenced(text: &str) -> String {
    format!("```text\n{text}```\n")
}

/// `text` with the part between the marks `<!-- name -->` and `<!-- /end -->` replaced.
fn replaced(text: &str, name: &str, end: &str, part: &str) -> String {
    let (from, to) = (format!("<!-- {name} -->\n"), format!("<!-- /{end} -->\n"));
    let start = text.find(&from).unwrap() + from.len();
    let length = text[start..].find(&to).unwrap();
    format!("{}{part}{}", &text[..start], &text[start + length..])
}

/// The explorer at its second limit point, as text.
#[cfg(feature = "tui")]
fn screen() -> String {
    use pulloff::explorer::{Id, Inline, update};
    use pulloff::tui::{app::App, theme::Theme, view};
    use ratatui::{Terminal, backend::TestBackend};

    let folder = tempfile::tempdir().unwrap();
    let store = pulloff::preset::Store::at(folder.path(), &[]);
    let loaded = store.load(&store.resolve("wavy-sphere").unwrap(), &[] as &[&str]).unwrap();
    let (mut app, effects) = App::new(loaded, Theme::default());
    let driver = Inline::new(store);
    driver.settle(&mut app.model, effects);
    for id in [Id::NextLimit, Id::Jump, Id::NextLimit] {
        let effects = update(&mut app.model, id.into());
        driver.settle(&mut app.model, effects);
    }
    let mut terminal = Terminal::new(TestBackend::new(80, 24)).unwrap();
    terminal
        .draw(|frame| {
            view::draw(frame, &app, &mut view::Pictures::default());
        })
        .unwrap();
    let buffer = terminal.backend().buffer();
    (0..24).fold(String::new(), |mut text, y| {
        let row: String = (0..80).map(|x| buffer[(x, y)].symbol()).collect();
        writeln!(text, "{}", row.trim_end()).unwrap();
        text
    })
}

#[test]
fn the_generated_parts_of_the_readme_are_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let readme = std::fs::read_to_string(&path).unwrap();
    let mut current = replaced(&readme, "key table", "key table", &key_table());
    for command in ["unload wavy-sphere", "verify --only uniform", "presets list"] {
        let text = fenced(&output(&command.split(' ').collect::<Vec<_>>()));
        current = replaced(&current, &format!("output: {command}"), "output", &text);
    }
    #[cfg(feature = "tui")]
    {
        current = replaced(&current, "keys", "keys", &pulloff::tui::keymap::markdown());
        current = replaced(&current, "screen", "screen", &fenced(&screen()));
    }
    // Of a trace only the columns are compared: the last digits of its points differ between machines.
    let head = output(&["trace", "wavy-sphere"]).lines().take(3).fold(String::new(), |mut text, line| {
        writeln!(text, "{line}").unwrap();
        text
    });
    if std::env::var_os("UPDATE_README").is_some() {
        current = replaced(&current, "output: trace wavy-sphere | head -3", "output", &fenced(&head));
        std::fs::write(&path, current).unwrap();
        return;
    }
    assert!(
        readme.contains(head.lines().next().unwrap()),
        "the columns of a trace in README.md are out of date"
    );
    assert_eq!(readme, current, "README.md is out of date: UPDATE_README=1 cargo test --test manual");
}
