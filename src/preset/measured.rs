//! The file of a measured profile → rows of a gap.
//!
//! A name that begins with [`SHIPPED_DATA`] means data that comes with the program; any other is a path, relative to the
//! folder of the preset. In an SI preset rows with a unit become metres; in any other radii are taken as they stand;
//! where both columns name a unit of length, gaps are converted to the unit of the radii, so a gap in nm over µm is what it
//! says.

use super::invalid::Invalid;
use super::profile::{TextError, parse, read_profile};
use super::schema::{Kind, Parameter};
use super::shipped;
use super::text::{is_unsafe, quote, sanitize, show_path};
use super::value::Value;
use crate::contact::shapes::Rows;
use crate::units::dimension::Quantity;
use crate::units::unit::Unit;
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
    let radii_in = columns.units[0].clone();
    let columns = columns
        .in_units(|unit| ratio(unit, radii_in.as_deref()?))
        .map_err(|error: TextError| words(format!("{shown}: {error}")))?;
    Ok(Rows {
        name: name.to_owned(),
        folder: folder.map(Path::to_path_buf),
        radii: columns.radii,
        gaps: columns.gaps,
        unit: radii_in.and_then(|unit| Unit::parse(&unit, 0).ok()),
        notes,
    })
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

/// How many of the unit `of` one `unit` is; both are lengths.
fn ratio(unit: &str, of: &str) -> Option<f64> {
    if unit == of {
        return Some(1.0);
    }
    let length = |text: &str| {
        let unit = Unit::parse(text, 0).ok()?;
        (unit.dimension() == Quantity::Length.dimension()).then_some(unit)
    };
    Some(length(of)?.from_si(length(unit)?.to_si(1.0)))
}
