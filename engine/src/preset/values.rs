//! Values by dotted key, and the words of choices among them.

use super::rows::parameter;
use super::schema::{Applies, CHOOSERS, Fallback, Key};
use super::value::Value;
use crate::units::Quantity;
use std::collections::BTreeMap;

/// Values by dotted key. A part of a value (`path.control.stiffness`) is not a key here.
pub type Values = BTreeMap<Key, Value>;

/// The word of a choice, given or by default; `None` if it is missing or not a word of the choice.
///
/// Where the choice has a default and is not given, a key that belongs to one word alone decides it: a file with
/// nothing but `basis.rings` means rings. Units are never guessed, because that would change the meaning of every
/// number in the file.
pub(super) fn chosen(values: &Values, chooser: &str) -> Option<String> {
    let row = parameter(chooser)?;
    let implied = || {
        values.keys().find_map(|key| match parameter(key)?.applies {
            Applies::With { key, words: [word] } if key == chooser => Some(*word),
            _ => None,
        })
    };
    let word = match (values.get(chooser), row.fallback) {
        (Some(value), _) => value.clone(),
        (None, Fallback::Text(word)) if chooser == CHOOSERS[2] => word.into(),
        (None, Fallback::Text(word)) => implied().unwrap_or(word).into(),
        (None, _) => return None,
    };
    row.check(word).ok().map(|word| word.to_string())
}

/// The quantity of the coefficient c of a gap c rⁿ, a length to the power 1 − n; `None` if that power is not whole or
/// is beyond all units.
pub(super) fn of_coefficient(exponent: f64) -> Option<Quantity> {
    Quantity::of_inverse_length(exponent - 1.0)
}
