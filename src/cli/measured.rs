//! What commands share that read measured curves.

use super::Failure;
use crate::store::data::read_points;
use pulloff_engine::measured::Spec;
use pulloff_engine::preset::invalid::Invalid;
use pulloff_engine::preset::{Preset, Value, data};
use pulloff_engine::units::Quantity;
use std::path::Path;
use std::sync::Arc;

/// Gives the preset the measured curve in the file `path`, or leaves it its own where that is `None`; the spring that it states
/// where the preset has none; and what is `said` of it. All at once, for what is said is not about the curve before.
pub(super) fn attach(
    preset: &mut Preset,
    path: Option<&Path>,
    said: &[(&'static str, Value)],
) -> Result<(), Failure> {
    let file = path.map(|path| Ok::<_, Failure>(Value::Points(Arc::new(read_points(path)?)))).transpose()?;
    let file = file.map(|points| (data::FILE, points));
    preset.set_all(file.into_iter().chain(said.iter().cloned())).map_err(|invalid| match invalid {
        Invalid::Made { cause, .. } => Failure::Usage(cause),
        invalid => Failure::Usage(invalid.to_string()),
    })
}

/// What `--columns` says, if it can be said of any file.
pub(super) fn columns(text: Option<&str>) -> Result<Option<(&'static str, Value)>, Failure> {
    let Some(text) = text else { return Ok(None) };
    Spec::parse(text).map_err(|error| Failure::Usage(format!("--columns: {error}")))?;
    Ok(Some((data::COLUMNS, Value::Text(text.to_owned()))))
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
