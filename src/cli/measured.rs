//! What commands share that read measured curves.

use super::Failure;
use crate::store::data::read_points;
use pulloff_engine::preset::invalid::Invalid;
use pulloff_engine::preset::{Preset, Value, data};
use pulloff_engine::units::Quantity;
use std::path::Path;
use std::sync::Arc;

/// Gives the preset the measured curve in the file `path`, and the spring that it states where the preset has none.
pub(super) fn attach(preset: &mut Preset, path: &Path) -> Result<(), Failure> {
    let source = read_points(path)?;
    preset.set(data::FILE, Value::Points(Arc::new(source))).map_err(|invalid| match invalid {
        Invalid::Made { cause, .. } => Failure::Usage(cause),
        invalid => Failure::Usage(invalid.to_string()),
    })
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
