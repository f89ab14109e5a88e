//! A study as documents: its values as CSV, and the spec of a sweep that repeats it.

use super::command::Assignment;
use super::studies::{StudyData, StudyOutcome, number};
use pulloff_engine::report::rows::{RowsError, csv as written};
use pulloff_engine::sweep::Cell;
use pulloff_engine::sweep::axis::{AxisValues, SweepAxis, overrides};
use serde_json::Value;
use std::collections::BTreeMap;

/// A row for each value: the key, the quantity, and why there is no result, as in the results of a sweep.
pub(super) fn csv(study: &StudyData) -> Result<String, RowsError> {
    let (key, name) = (study.wish.key.to_string(), study.wish.column.name());
    let columns = [&*key, &*name, "error"];
    let rows = study.wish.values.iter().zip(&study.outcomes).map(|(value, outcome)| {
        let [found, fault] = match outcome {
            StudyOutcome::Waits => [Value::Null, Value::Null],
            StudyOutcome::Missing(why) => [Value::Null, Value::from(why.as_str())],
            StudyOutcome::Found(Cell::Number(x)) => [Value::from(*x), Value::Null],
            StudyOutcome::Found(Cell::Count(n)) => [Value::from(*n), Value::Null],
        };
        let value = match value {
            pulloff_engine::preset::Value::Integer(n) => Value::from(*n),
            other => number(other).map_or(Value::Null, Value::from),
        };
        let cells = columns.map(str::to_owned).into_iter().zip([value, found, fault]);
        cells.collect::<BTreeMap<_, _>>()
    });
    written(&columns, &rows.collect::<Vec<_>>())
}

/// The spec of a sweep over the same values; its preset is given by name, with the values that differ from its file.
pub(super) fn spec(study: &StudyData, name: &str, over: &[Assignment]) -> String {
    let wish = &study.wish;
    let text = |text: &str| toml::Value::String(text.to_owned()).to_string();
    // What the axis sets in every row cannot be given beforehand.
    let over = over.iter().filter(|(key, _)| !overrides(&wish.key, key));
    let over: Vec<String> = over.map(|(key, value)| text(&format!("{key}={value}"))).collect();
    let set = if over.is_empty() { String::new() } else { format!("set = [{}]\n", over.join(", ")) };
    let values = wish.values.iter().map(|value| wish.preset.with_unit(&wish.key, value)).collect();
    let axis = SweepAxis { key: wish.key.to_string(), points: AxisValues::Values(values) };
    format!(
        "preset = {}\n{set}quantities = [{}]\n\n[[axis]]\nkey = {}\n{}\n",
        text(name),
        text(&wish.column.name()),
        text(&axis.key),
        axis.canonical()
    )
}
