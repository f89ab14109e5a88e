//! The file of a measured profile → rows of a gap.
//!
//! A name that begins with [`SHIPPED_DATA`] means data that comes with the program; any other is a path, relative to the
//! folder of the preset. A header names a unit of length for both columns or for none; gaps are converted to that of the
//! radii, so a gap in nm over µm is what it says. In an SI preset rows with a unit become metres. In reduced units a unit is
//! refused, as with any other value; only data that come with the program are then in the unit of their radii, since the
//! shape is chosen before its units are.

use super::invalid::Invalid;
use super::profile::{TextError, parse, read_profile};
use super::schema::{Kind, Parameter};
use super::shipped;
use super::text::{is_unsafe, quote, sanitize, show_path};
use super::value::Value;
use crate::contact::shapes::Rows;
use crate::units::UnitSystem;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The beginning of a name of shipped data.
pub const SHIPPED_DATA: &str = "shipped:";
/// The longest message of what is wrong with a file.
const LONGEST_CAUSE: usize = 1000;

/// Reads the file `name`, relative to `folder` or to the current folder.
///
/// # Errors
/// Why there are no rows, in words that are safe to show.
pub fn load(folder: Option<&Path>, name: &str) -> Result<Rows, String> {
    let words = |cause: String| sanitize(&cause.replace('\n', "; "), LONGEST_CAUSE);
    if name.is_empty() || name.chars().any(is_unsafe) {
        return Err(format!("\"{}\" is no name of a file", quote(name)));
    }
    let (columns, shown) = if let Some(data) = name.strip_prefix(SHIPPED_DATA) {
        let text = shipped::data(data).ok_or_else(|| {
            let known: Vec<String> =
                shipped::DATA.iter().map(|data| format!("{SHIPPED_DATA}{}", data.name)).collect();
            format!("\"{}\" does not come with the program; there is {}", quote(name), known.join(", "))
        })?;
        (parse(text.as_bytes()).map_err(|error| words(error.to_string()))?, quote(name))
    } else {
        let path = folder.map_or_else(|| PathBuf::from(name), |folder| folder.join(name));
        let shown = show_path(&path);
        (read_profile(&path).map_err(|error| words(error.to_string()))?, shown)
    };
    let notes = columns.notes.iter().map(|note| format!("{shown}: {note}")).collect();
    let header = columns.header;
    let (columns, unit) =
        columns.in_one_unit().map_err(|error: TextError| words(format!("{shown}: {error}")))?;
    Ok(Rows {
        name: name.to_owned(),
        folder: folder.map(Path::to_path_buf),
        radii: columns.radii,
        gaps: columns.gaps,
        header: header.filter(|_| !name.starts_with(SHIPPED_DATA)),
        unit,
        notes,
    })
}

/// The file of `rows` as messages name it.
pub(super) fn shown(rows: &Rows) -> String {
    if rows.name.starts_with(SHIPPED_DATA) { quote(&rows.name) } else { show_path(&rows.path()) }
}

/// Whether a preset in `units` takes `rows` as their header has them.
///
/// # Errors
/// In reduced units their unit, in words.
pub(super) fn in_these_units(rows: &Rows, units: &UnitSystem) -> Result<(), String> {
    match (units, rows.header, &rows.unit) {
        (UnitSystem::Reduced, Some(line), Some(unit)) => Err(format!(
            "{}: line {line}: the header names a unit, {}, and the problem is in reduced units, where columns are pure \
             numbers: write r, h without, or set units = \"SI\"",
            shown(rows),
            unit.ascii()
        )),
        _ => Ok(()),
    }
}

/// A value as it is kept: the name of a file stands for its rows, read here from `folder`.
pub(super) fn located(row: &Parameter, value: Value, folder: Option<&Path>) -> Result<Value, Invalid> {
    match value {
        Value::Text(name) if row.kind == Kind::File => {
            let cause = |cause| Invalid::Gap { key: row.key.clone(), cause };
            Ok(Value::Profile(Arc::new(load(folder, &name).map_err(cause)?)))
        }
        value => Ok(value),
    }
}
