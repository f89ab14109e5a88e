//! Nested rows as CSV, or with tabs: names joined by `_`, nothing for null.

use serde::Serialize;
use serde_json::Value;
use std::collections::HashMap;

/// Why rows could not be written as CSV.
#[derive(Debug, thiserror::Error)]
pub enum RowsError {
    /// A row is no object of the columns; the types of the documents exclude it.
    #[error("a row does not fit its columns: {0}")]
    Shape(String),
    /// A value could not be serialized.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// The CSV writer failed.
    #[error(transparent)]
    Csv(#[from] csv::Error),
}

/// `rows` as CSV text with the header `columns`.
///
/// # Errors
/// [`RowsError::Shape`] when a row has a value without a column, so that none is lost silently.
pub fn csv<R: Serialize>(columns: &[&str], rows: &[R]) -> Result<String, RowsError> {
    separated(b',', columns, rows)
}

/// The same with tabs between the cells, as spreadsheets take it from a clipboard.
///
/// # Errors
/// As [`csv()`].
pub fn tsv<R: Serialize>(columns: &[&str], rows: &[R]) -> Result<String, RowsError> {
    separated(b'\t', columns, rows)
}

fn separated<R: Serialize>(separator: u8, columns: &[&str], rows: &[R]) -> Result<String, RowsError> {
    let mut writer = csv::WriterBuilder::new().delimiter(separator).from_writer(Vec::new());
    writer.write_record(columns)?;
    for row in rows {
        let mut cells = HashMap::new();
        flatten("", &serde_json::to_value(row)?, &mut cells);
        writer.write_record(columns.iter().map(|column| cells.remove(*column).unwrap_or_default()))?;
        if let Some(name) = cells.into_keys().next() {
            return Err(RowsError::Shape(name));
        }
    }
    let bytes = writer.into_inner().map_err(|e| RowsError::Csv(e.into_error().into()))?;
    String::from_utf8(bytes).map_err(|e| RowsError::Shape(e.to_string()))
}

fn flatten(name: &str, value: &Value, cells: &mut HashMap<String, String>) {
    match value {
        Value::Null => {}
        Value::Object(members) => {
            for (key, value) in members {
                let name = if name.is_empty() { key.clone() } else { format!("{name}_{key}") };
                flatten(&name, value, cells);
            }
        }
        Value::String(text) => drop(cells.insert(name.to_owned(), text.clone())),
        other => drop(cells.insert(name.to_owned(), other.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::{csv, tsv};
    use serde_json::json;

    #[test]
    fn nested_names_are_joined_and_null_is_empty() {
        let rows = [json!({"a": 1.5e-9, "b": {"c": true, "d": null}}), json!({"a": -2.0, "b": null})];
        assert_eq!(csv(&["a", "b_c", "b_d"], &rows).unwrap(), "a,b_c,b_d\n1.5e-9,true,\n-2.0,,\n");
        assert_eq!(tsv(&["a", "b_c", "b_d"], &rows).unwrap(), "a\tb_c\tb_d\n1.5e-9\ttrue\t\n-2.0\t\t\n");
        assert!(csv(&["a"], &rows).is_err());
    }
}
