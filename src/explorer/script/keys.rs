//! Keys as typed: the whole key, its last part, or the symbol on the screen.

use super::fault::ScriptFault;
use pulloff_engine::preset::called::{self, is_called};
use pulloff_engine::preset::family::parameter_key;
use pulloff_engine::preset::groups::{self, GROUPS};
use pulloff_engine::preset::{Invalid, Key, PARAMETERS, Preset, parameter};
use pulloff_engine::text::{closest_key, quote};

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

/// The key of a preset with this name, or why there is none or more than one.
pub(in crate::explorer) fn key_called(preset: &Preset, name: &str) -> Result<Key, String> {
    called::key_called(preset, name).map_err(|invalid| match invalid {
        Invalid::Several { .. } => invalid.to_string(),
        _ => unknown(name),
    })
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
