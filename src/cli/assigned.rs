//! Reports on standard error what assignments on the command line did beyond their text: the values that a group
//! changed, and bare numbers of an SI preset that may have been meant in another unit.

use super::console::Console;
use crate::store::{Source, Store};
use pulloff_engine::preset::called::key_called;
use pulloff_engine::preset::{Preset, Value, groups};
use pulloff_engine::units::number::short;
use pulloff_engine::units::parse_quantity;

/// A bare number further than this factor from the preset's own value is reported: half of that between mm and um.
const FAR: f64 = 500.0;

/// Reports what the assignments changed in the preset from `source`, which is now `after`.
pub(super) fn report(
    console: &Console,
    store: &Store,
    source: &Source,
    assignments: &[String],
    after: &Preset,
) {
    let whole = |key: &str| key_called(after, key.trim()).unwrap_or_else(|_| key.trim().to_owned().into());
    let parted =
        || assignments.iter().filter_map(|text| text.split_once('=')).map(|(key, text)| (whole(key), text));
    let is_group = |key: &str| groups::row(key).is_some();
    if parted().any(|(key, _)| is_group(&key)) {
        let rest: Vec<&String> = assignments
            .iter()
            .filter(|text| !is_group(&whole(text.split('=').next().unwrap_or_default())))
            .collect();
        if let Ok(before) = store.load(source, &rest) {
            console.note(Some(&format!("groups changed {}", changed(&before.preset, after))));
        }
    }
    let bare = |text: &str| parse_quantity(text).is_ok_and(|value| value.unit.is_none());
    if parted().any(|(_, text)| bare(text))
        && let Ok(own) = store.load(source, &[] as &[&str])
    {
        let far =
            parted().filter(|(_, text)| bare(text)).filter_map(|(key, _)| far(&own.preset, after, &key));
        console.warn(&far.collect::<Vec<_>>());
    }
}

/// The values in which `after` differs from `before`.
fn changed(before: &Preset, after: &Preset) -> String {
    let moved = after.rows().filter(|row| before.get(&row.key) != after.get(&row.key));
    let named: Vec<String> =
        moved.filter_map(|row| Some(format!("{} = {}", row.key, describe(after, &row.key)?))).collect();
    if named.is_empty() { "nothing".to_owned() } else { named.join(", ") }
}

fn describe(preset: &Preset, key: &str) -> Option<String> {
    let row = preset.row(key)?;
    let Some(Value::Number(x)) = preset.get(key) else { return None };
    let shown = row.shown(&preset.units, x);
    Some(shown.text(&short(shown.number, 6), true))
}

/// How a bare number in SI was read, where it is far from the preset's own value.
fn far(own: &Preset, after: &Preset, key: &str) -> Option<String> {
    let row = after.row(key)?;
    row.unit_in(&after.units)?;
    let (Some(Value::Number(before)), Some(Value::Number(now))) = (own.get(key), after.get(key)) else {
        return None;
    };
    let ratio = (now / before).abs();
    let is_far =
        own.units == after.units && ratio.is_finite() && ratio > 0.0 && !(1.0 / FAR..=FAR).contains(&ratio);
    is_far.then(|| {
        let (now, before) = (describe(after, key), describe(own, key));
        format!(
            "{key} is {} now, {} in the preset: a bare number is {}",
            now.unwrap_or_default(),
            before.unwrap_or_default(),
            row.unit.as_ref().map_or_else(|| "SI".to_owned(), |unit| format!("in {}", unit.ascii()))
        )
    })
}
