//! The file of a measured profile → rows of a gap.
//!
//! A name that begins with [`SHIPPED_DATA`] means data that comes with the program; any other is a path, relative to
//! the folder of the preset. A header names a unit of length for both columns or for neither. Gaps are converted to the
//! unit of the radii, so a gap in nm over a radius in µm is read correctly. In an SI preset, rows with a unit are
//! converted to metres. In reduced units they keep the numbers of the file, in the unit of its radii, which is then the
//! unit of all lengths; a warning says so.

use super::invalid::Invalid;
use super::profile::ProfileColumns;
use super::schema::{Kind, NONE, Parameter};
use super::value::Value;
use crate::gap::shapes::ProfileRows;
use crate::measured::PointsFile;
use crate::text::{quote, sanitize, show_path};
use std::path::Path;
use std::sync::Arc;

pub use crate::gap::shapes::measured::SHIPPED_DATA;
/// The longest message of what is wrong with a file.
const LONGEST_CAUSE: usize = 1000;

/// Where the files named in presets come from: the engine itself reads no disk.
///
/// Each function is given the folder of the preset, if it has one, and the name of the file. If it finds nothing, it
/// returns the reason in words that are safe to show.
#[derive(Debug, Clone, Copy)]
pub struct Files {
    /// The rows of a profile; [`rows`] makes them from the columns of a text.
    pub rows: fn(folder: Option<&Path>, name: &str) -> Result<ProfileRows, String>,
    /// The bytes of a measured curve.
    pub points: fn(folder: Option<&Path>, name: &str) -> Result<Vec<u8>, String>,
}

fn nothing<T>(_: Option<&Path>, name: &str) -> Result<T, String> {
    Err(format!("\"{}\": there are no files here", quote(name)))
}

impl Files {
    /// No files: a preset that names one is refused.
    pub const NONE: Self = Self { rows: nothing, points: nothing };
}

impl Default for Files {
    fn default() -> Self {
        Self::NONE
    }
}

impl PartialEq for Files {
    /// A preset is the same wherever its rows come from.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// An error in one line that is safe to show.
pub fn words(error: &impl ToString) -> String {
    sanitize(&error.to_string().replace('\n', "; "), LONGEST_CAUSE)
}

/// The rows of `columns`, from the file `name` relative to `folder`.
///
/// # Errors
/// An unknown unit, or a unit for one column only, in words.
pub fn rows(folder: Option<&Path>, name: &str, columns: ProfileColumns) -> Result<ProfileRows, String> {
    let named = ProfileRows {
        name: name.to_owned(),
        folder: folder.map(Path::to_path_buf),
        ..ProfileRows::default()
    };
    let shown = shown(&named);
    let notes = columns.notes.iter().map(|note| format!("{shown}: {note}")).collect();
    let (columns, unit) = columns.in_one_unit().map_err(|error| words(&format!("{shown}: {error}")))?;
    Ok(ProfileRows { radii: columns.radii, gaps: columns.gaps, unit, notes, ..named })
}

/// The file of `rows`, as messages name it.
pub(super) fn shown(rows: &ProfileRows) -> String {
    if rows.is_shipped() { quote(&rows.name) } else { show_path(&rows.path()) }
}

/// The file of a measured curve, as messages name it.
pub(super) fn shown_file(source: &PointsFile) -> String {
    if source.name.starts_with(SHIPPED_DATA) { quote(&source.name) } else { show_path(&source.path()) }
}

/// A value as it is kept: the name of a file is replaced by its content, which `files` supplies.
pub(super) fn located(
    files: Files,
    row: &Parameter,
    value: Value,
    folder: Option<&Path>,
) -> Result<Value, Invalid> {
    match value {
        Value::Text(name) if row.kind == Kind::File => {
            let cause = |cause| Invalid::Made { key: row.key.clone(), cause };
            Ok(Value::Profile(Arc::new((files.rows)(folder, &name).map_err(cause)?)))
        }
        Value::Text(name) if row.kind == Kind::Points && name != NONE => {
            let cause = |cause| Invalid::Made { key: row.key.clone(), cause };
            let bytes = (files.points)(folder, &name).map_err(cause)?;
            Ok(Value::Points(Arc::new(PointsFile::new(name, folder.map(Path::to_path_buf), bytes.into()))))
        }
        value => Ok(value),
    }
}
