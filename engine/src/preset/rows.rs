//! Every row by its dotted key: those of the table and those that no table can list.

use super::family;
use super::schema::{PARAMETERS, Row};
use std::borrow::Cow::{self, Borrowed};

/// The row of a dotted key: of the table, or of a [`family`].
pub fn parameter(key: &str) -> Option<Row> {
    PARAMETERS.iter().find(|row| row.key == key).map(Borrowed).or_else(|| family::row(key).map(Cow::Owned))
}

/// The keys that hold other keys: `material`, `gap`, …, `path.control` when it is a spring, and the two families.
pub fn tables() -> impl Iterator<Item = &'static str> {
    let families = [family::PARAMETER_TABLE, family::WAVE_TABLE];
    PARAMETERS
        .iter()
        .enumerate()
        .filter_map(|(i, row)| {
            let table = row.table()?;
            let seen = PARAMETERS.iter().take(i).any(|earlier| earlier.table() == Some(table));
            (!seen).then_some(table)
        })
        .chain(families)
}
