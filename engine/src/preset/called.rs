//! Keys as typed: the whole key, its last part, or the symbol on the screen.

use super::family::parameter_key;
use super::groups::{self, GROUPS};
use super::invalid::Invalid;
use super::model::{Preset, unknown_key};
use super::rows::parameter;
use super::schema::{CHOOSERS, Key, PARAMETERS, Parameter};
use crate::gap::formula::Formula;
use crate::text::{greek, quote};
use std::borrow::Cow;

/// The table of the units of the screen.
const DISPLAY: &str = "display.";

/// Whether a row has this name: its key, the last part of the key, or the symbol on the screen, also without the word
/// that tells it from the same symbol of another table, as in `n edge`.
pub fn is_called(row: &Parameter, name: &str) -> bool {
    let last = row.key.rsplit('.').next().unwrap_or_default();
    let table = row.table().unwrap_or_default();
    let symbol =
        row.label.strip_suffix(table).and_then(|symbol| symbol.strip_suffix(' ')).unwrap_or(&row.label);
    !name.is_empty() && [&*row.key, last, &*row.label, &*greek(&row.label), symbol].contains(&name)
}

/// The rows of a preset, and the groups.
pub fn settable(preset: &Preset) -> impl Iterator<Item = Parameter> {
    preset.rows().map(Cow::into_owned).chain(GROUPS.iter().cloned())
}

/// The rows with this name: if some have a value of their own in this preset, only those; if not, those of its shape, if
/// there are some. What is shown in which unit is no value of the problem, and has no short names.
pub fn rows_called(preset: &Preset, name: &str) -> Vec<Parameter> {
    let rows = settable(preset).filter(|row| row.key == name || !row.key.starts_with(DISPLAY));
    let rows = rows.filter(|row| is_called(row, name));
    // A group always has a value, which other values give.
    let has_own = |row: &Parameter| groups::row(&row.key).is_none() && preset.get(&row.key).is_some();
    let (own, others): (Vec<_>, Vec<_>) = rows.partition(has_own);
    if own.is_empty() { preferred(others, |row| row.fits(CHOOSERS[0], preset.gap.name())) } else { own }
}

/// The key of a preset with this name.
///
/// # Errors
/// There is none, or more than one.
pub fn key_called(preset: &Preset, name: &str) -> Result<Key, Invalid> {
    if parameter(name).is_some() || groups::row(name).is_some() {
        return Ok(name.to_owned().into());
    }
    let rows = rows_called(preset, name);
    one(name, rows.into_iter().map(|row| row.key)).unwrap_or_else(|| Err(preset.unknown_key(name)))
}

/// Those of `rows` that are `better`, or all of them if none is.
fn preferred<T>(rows: Vec<T>, better: impl Fn(&T) -> bool) -> Vec<T> {
    let (better, others): (Vec<T>, Vec<T>) = rows.into_iter().partition(better);
    if better.is_empty() { others } else { better }
}

/// The same where the preset is not complete; `shape` and `formula` are what is known of its gap. Of several rows, those
/// in a table that `is_used`.
pub(super) fn key_anywhere(
    shape: Option<&str>,
    formula: Option<&str>,
    is_used: &dyn Fn(&str) -> bool,
    name: &str,
) -> Result<Key, Invalid> {
    let fits = |row: &&Parameter| shape.is_none_or(|shape| row.fits(CHOOSERS[0], shape));
    let rows = PARAMETERS.iter().filter(fits).chain(&GROUPS).filter(|row| !row.key.starts_with(DISPLAY));
    let rows = rows.filter(|row| is_called(row, name));
    // A formula names its parameters even where they have no values yet.
    let own = formula.filter(|_| shape.is_none_or(|shape| shape == "formula"));
    let own = own.and_then(|text| Formula::parse(text).ok());
    let own = own.filter(|formula| formula.parameters().iter().any(|own| own == name));
    let own = own.map(|_| parameter_key(name).into());
    let (used, others): (Vec<_>, Vec<_>) =
        rows.partition(|row: &&Parameter| row.table().is_some_and(is_used));
    let rows = if used.is_empty() && own.is_none() { others } else { used };
    one(name, rows.into_iter().map(|row| row.key.clone()).chain(own))
        .unwrap_or_else(|| Err(unknown_key(name, shape)))
}

/// The only one of `keys`, of which a key of the preset comes before a group of the same name; `None` where there are
/// none.
fn one(name: &str, keys: impl Iterator<Item = Key>) -> Option<Result<Key, Invalid>> {
    let keys = preferred(keys.collect(), |key| groups::row(key).is_none());
    match &keys[..] {
        [] => None,
        [key] => Some(Ok(key.clone())),
        several => Some(Err(Invalid::Several { name: quote(name), keys: several.join(", ") })),
    }
}
