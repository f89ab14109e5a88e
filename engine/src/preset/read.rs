//! TOML text and `--set` assignments → preset.
//!
//! The file is laid down first, then the assignments in order. The whole is checked once, and the assignments of groups
//! are made last. Every value remembers where it came from, so that a message can name the line or the assignment.
//!
//! | file | what lives there |
//! |---|---|
//! | `document` | documents and assignments laid down |
//! | `sheet` | what is known about each key, and where it came from |
//! | `whole` | the layers combined into one preset, or everything that is wrong |
//! | `mistake` | a mistake and its place |

mod document;
mod mistake;
mod sheet;
mod whole;

pub use mistake::{Mistake, ReadError, ValueOrigin};
pub use sheet::{HeldFiles, line};

use super::measured::Files;
use super::model::Preset;
use crate::text::show_name;
use sheet::{LayerOrigin, Sheet};
use std::path::Path;
use toml::de::DeTable;

/// How many mistakes are collected before reading stops.
const MISTAKES: usize = 20;

/// Reads a preset that names no files; `name` names the text in messages.
///
/// # Errors
/// Every mistake found, with its line.
pub fn read(name: &str, text: &str) -> Result<Preset, ReadError> {
    read_with(name, text, &[] as &[&str])
}

/// The preset of this name among those that come with the program, with its data.
pub fn read_shipped(name: &str) -> Option<Preset> {
    let found = super::shipped::find(name)?;
    read_in(Files::SHIPPED, None, name, found.text, &[] as &[&str]).ok()
}

/// Reads a preset and lays `KEY=VALUE` assignments over it, in order.
///
/// # Errors
/// Every mistake found, with its line or assignment.
pub fn read_with<S: AsRef<str>>(name: &str, text: &str, assignments: &[S]) -> Result<Preset, ReadError> {
    read_in(Files::NONE, None, name, text, assignments)
}

/// Reads a preset whose `files` are relative to `folder`, or to the current folder; those in assignments are always
/// relative to the current folder.
///
/// # Errors
/// Every mistake found, with its line or assignment.
pub fn read_in<S: AsRef<str>>(
    files: Files,
    folder: Option<&Path>,
    name: &str,
    text: &str,
    assignments: &[S],
) -> Result<Preset, ReadError> {
    let folder = folder.map(Path::to_path_buf);
    let mut sheet = Sheet { name: show_name(name), files, folder, ..Sheet::default() };
    match DeTable::parse(text) {
        Ok(document) => sheet.lay("", document.get_ref(), &LayerOrigin::File(text)),
        Err(error) => sheet.syntax(text, &error),
    }
    let mut assignments: Vec<&str> = assignments.iter().map(AsRef::as_ref).collect();
    // The shape and its formula decide which short names there are.
    assignments.sort_by_key(|text| match text.split('=').next().unwrap_or_default().trim() {
        "gap.shape" | "shape" => 0,
        "gap.formula" | "formula" => 1,
        _ => 2,
    });
    for assignment in assignments {
        sheet.assign(assignment);
    }
    sheet.finish()
}

/// Reads a preset as a session holds it: its files have the content in `held`, whatever is on disk by now; none is
/// read.
///
/// # Errors
/// Every mistake found, with its line.
pub fn read_holding(files: Files, name: &str, text: &str, held: HeldFiles) -> Result<Preset, ReadError> {
    let held = Some(held);
    let mut sheet = Sheet { name: show_name(name), files, held, ..Sheet::default() };
    match DeTable::parse(text) {
        Ok(document) => sheet.lay("", document.get_ref(), &LayerOrigin::File(text)),
        Err(error) => sheet.syntax(text, &error),
    }
    sheet.finish()
}

#[cfg(test)]
mod tests;
