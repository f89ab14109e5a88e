//! What must hold for any external text: no panic, and what is accepted can be written and read again.
//!
//! To add a target, write a function here and a five-line file in `src/bin`.

use pulloff::tui::config;
use pulloff_engine::gap::formula::Formula;
use pulloff::explorer::script;
use pulloff::explorer::session::{Document, Ended};
use pulloff_engine::measured::{self, ColumnSpec};
use pulloff_engine::preset::profile::{self, ROW_RANGE};
use pulloff_engine::text::is_unsafe;
use pulloff::store::read;
use pulloff_engine::preset::write;
use pulloff_engine::units::value::parse_quantity;
use std::fmt::Display;

/// Users see errors, so an error must not steer their terminal. Line ends are allowed.
fn assert_shown_safely(error: &dyn Display) {
    let text = error.to_string();
    assert!(!text.chars().any(|c| c != '\n' && is_unsafe(c)), "unsafe message {text:?}");
}

/// A preset that is read is the same when it is written and read again.
pub fn preset(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match read("fuzz", text) {
        Err(error) => assert_shown_safely(&error),
        Ok(preset) => {
            let written = write(&preset);
            let back = read("written", &written).unwrap_or_else(|error| panic!("{error}\n{written}"));
            assert_eq!(back, preset, "another preset came back from\n{written}");
        }
    }
}

/// A formula that is read can be evaluated anywhere; the result is a number or `None`, never a panic.
pub fn formula(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match Formula::parse(text) {
        Err(error) => assert_shown_safely(&error),
        Ok(formula) => {
            let values: Vec<(&str, f64)> = formula
                .parameters()
                .iter()
                .zip([0.5, 2.0, -1.0].into_iter().cycle())
                .map(|(name, x)| (&**name, x))
                .collect();
            let bound = formula.bind(&values).expect("a value for each parameter");
            for r in [0.0, 1e-30, 0.3, 1.0, 1e30] {
                let _ = bound.jet(r);
            }
            let _ = bound.check(1.0);
        }
    }
}

/// A profile that is read is in order and within its bounds.
pub fn csv(bytes: &[u8]) {
    match profile::parse(bytes) {
        Err(error) => assert_shown_safely(&error),
        Ok(columns) => {
            assert!(ROW_RANGE.contains(&columns.radii.len()) && columns.radii.len() == columns.gaps.len());
            assert!(columns.radii.windows(2).all(|two| two[0] < two[1]), "radii out of order");
            assert!(columns.radii.iter().chain(&columns.gaps).all(|x| x.is_finite()));
        }
    }
}

/// A measured curve that is read contains only numbers, equally many in each column.
pub fn measured(bytes: &[u8]) {
    for columns in ["", "x=1,force=2"] {
        match measured::parse(bytes, &ColumnSpec::parse(columns).expect("a form of ours")) {
            Err(error) => assert_shown_safely(&error),
            Ok(read) => {
                let rows = read.columns[0].values.len();
                assert!(read.columns.iter().all(|column| column.values.len() == rows));
                assert!(read.columns.iter().flat_map(|column| &column.values).all(|x| x.is_finite()));
                assert!(read.segments.is_none_or(|segments| segments.len() == rows));
                assert!(!read.notes.iter().any(|note| note.chars().any(is_unsafe)), "{:?}", read.notes);
            }
        }
    }
    match measured::columns(bytes) {
        Err(error) => assert_shown_safely(&error),
        Ok(seen) => assert!(seen.iter().all(|seen| !seen.name.chars().any(is_unsafe))),
    }
}

/// A value that is read is finite.
pub fn value(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match parse_quantity(text) {
        Err(error) => assert_shown_safely(&error),
        Ok(value) => assert!(value.number.is_finite()),
    }
}

/// A script line that is read prints as a line that reads back.
pub fn script(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Err(error) = script::read("fuzz", text) {
        assert_shown_safely(&error);
    }
    for line in text.lines() {
        match script::parse(line) {
            Err(fault) => assert_shown_safely(&fault.what),
            Ok(command) => {
                if let Some(printed) = command.as_ref().and_then(script::line) {
                    assert_eq!(script::parse(&printed).expect("a line of ours"), command, "{printed}");
                }
            }
        }
    }
}

/// A user's settings: keys and appearance.
pub fn settings(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Err(error) = config::read("fuzz", text) {
        assert_shown_safely(&error);
    }
}

/// A session that is read can be written and read again with the same walk.
pub fn session(bytes: &[u8]) {
    match Document::read(bytes).and_then(Document::snapshot) {
        Err(error) => assert_shown_safely(&error),
        Ok(snapshot) => {
            let written = Document::new(&snapshot, Ended::Quit, 0).json().expect("every session has a document");
            let again = Document::read(&written).and_then(Document::snapshot).expect("a document of ours");
            assert_eq!(snapshot.history.len(), again.history.len());
        }
    }
}
