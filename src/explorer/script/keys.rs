//! Keys as typed: the whole key, its last part, or the symbol on the screen.

use super::fault::ScriptFault;
use pulloff_engine::preset::family::parameter_key;
use pulloff_engine::preset::groups::{self, GROUPS};
use pulloff_engine::preset::{Key, PARAMETERS, Parameter, Preset, parameter};
use pulloff_engine::text::{closest_key, greek, quote};
use std::borrow::Cow;

/// A key, a group, or a short name for one: the preset decides for which.
pub(super) fn short(key: &str, column: usize) -> Result<Key, ScriptFault> {
    let is_short = PARAMETERS.iter().chain(&GROUPS).any(|row| is_called(row, key));
    // A formula has letters of its own; with one or two letters, too many keys are similar.
    let is_letter = || parameter(&parameter_key(key)).is_some() && (key.len() <= 2 || meant(key).is_none());
    if is_short || is_letter() { Ok(key.to_owned().into()) } else { known(key, column) }
}

/// The key most similar to an unknown one.
fn meant(key: &str) -> Option<&'static str> {
    closest_key(key, PARAMETERS.iter().chain(&GROUPS).map(|row| (&*row.key, &*row.label)))
}

/// Whether a row has this name: its key, the last part of the key, or the symbol on the screen.
fn is_called(row: &Parameter, name: &str) -> bool {
    let last = row.key.rsplit('.').next().unwrap_or_default();
    [&*row.key, last, &*row.label, &*greek(&row.label)].contains(&name)
}

/// The rows of a preset, and the groups.
pub(super) fn settable(preset: &Preset) -> impl Iterator<Item = Parameter> {
    preset.rows().map(Cow::into_owned).chain(GROUPS.iter().cloned())
}

/// The rows with this name: if some have a value in this preset, only those.
pub(super) fn rows_called(preset: &Preset, name: &str) -> Vec<Parameter> {
    let rows = settable(preset).filter(|row| is_called(row, name));
    let (own, others): (Vec<_>, Vec<_>) = rows.partition(|row| preset.get(&row.key).is_some());
    if own.is_empty() { others } else { own }
}

/// The key of a preset with this name, or why there is none or more than one.
pub(in crate::explorer) fn key_called(preset: &Preset, name: &str) -> Result<Key, String> {
    if parameter(name).is_some() || groups::row(name).is_some() {
        return Ok(name.to_owned().into());
    }
    let keys: Vec<Key> = rows_called(preset, name).into_iter().map(|row| row.key).collect();
    match &keys[..] {
        [key] => Ok(key.clone()),
        [] => Err(unknown(name)),
        several => Err(format!("{} is short for several: {}", quote(name), several.join(", "))),
    }
}

fn unknown(key: &str) -> String {
    // A letter or two is near to too much.
    let meant = meant(key).filter(|_| key.chars().count() > 2);
    let hint = meant.map_or_else(String::new, |meant| format!("; did you mean {meant}?"));
    format!("unknown key {}{hint}", quote(key))
}

/// A key or a group.
pub(super) fn known(key: &str, column: usize) -> Result<Key, ScriptFault> {
    if parameter(key).is_none() && groups::row(key).is_none() {
        return Err(ScriptFault::new(column, unknown(key)));
    }
    Ok(key.to_owned().into())
}
