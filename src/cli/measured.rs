//! What commands share that read measured curves.

use super::Failure;
use pulloff_engine::measured::Measured;
use pulloff_engine::measured::points::stiffness;
use pulloff_engine::preset::{Preset, Value};
use pulloff_engine::units::Quantity;

/// Gives the preset the spring that the file states, where it has none; the stiffness of the device.
pub(super) fn fill(preset: &mut Preset, measured: &Measured) -> Result<Option<f64>, String> {
    let spring = stiffness(measured.stiffness, preset.path.control, &preset.units)
        .map_err(|error| error.to_string())?;
    if let Some(k) = measured.stiffness {
        preset.set("path.control.stiffness", Value::Number(k)).map_err(|invalid| invalid.to_string())?;
    }
    Ok(spring)
}

/// A number as typed behind `flag`, in SI or reduced units, of what the key `key` measures.
pub(super) fn typed(preset: &Preset, flag: &str, key: &str, text: &str) -> Result<f64, Failure> {
    let wrong = |cause: &dyn std::fmt::Display| Failure::Usage(format!("{flag}: {cause}"));
    let row = preset.row(key).ok_or_else(|| wrong(&format!("expected {}", Quantity::Length.name())))?;
    // The row is that of another key, which the message must not blame.
    let words = |invalid: pulloff_engine::preset::Invalid| {
        let text = invalid.to_string();
        wrong(&text.strip_prefix(&*row.key).map_or(&*text, |rest| rest.trim_start_matches([':', ' '])))
    };
    preset.number(&row, text).map_err(words)
}
