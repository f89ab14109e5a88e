//! Nested rows as a table, CSV, or with tabs: names joined by `_`, nothing for null.

use serde::Serialize;
use serde_json::Value;
use std::collections::HashMap;

/// Why rows could not be written as CSV.
#[derive(Debug, thiserror::Error)]
pub enum RowsError {
    /// A row does not fit the columns; the types of the documents exclude it.
    #[error("a row does not fit its columns: {0}")]
    Shape(String),
    /// A value could not be serialized.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// The CSV writer failed.
    #[error(transparent)]
    Csv(#[from] csv::Error),
}

/// Rows under the names of their columns; null where a row has nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportTable {
    /// The names, in the order of the cells.
    pub columns: Vec<String>,
    /// The cells of each row, one for each column.
    pub rows: Vec<Vec<Value>>,
}

impl ReportTable {
    /// `rows` under the names `columns`.
    ///
    /// # Errors
    /// [`RowsError::Shape`] when a row has a value without a column, so that none is lost silently.
    pub fn of<R: Serialize>(columns: &[&str], rows: &[R]) -> Result<Self, RowsError> {
        Self::filled(columns, rows, |surplus| {
            surplus.into_keys().next().map_or(Ok(()), |name| Err(RowsError::Shape(name)))
        })
    }

    /// The same where the rows hold more than is wanted, such as a whole state: only the named cells are taken.
    ///
    /// # Errors
    /// [`RowsError::Json`] when a row could not be serialized.
    pub(super) fn picking<R: Serialize>(
        columns: &[&str],
        rows: impl IntoIterator<Item = R>,
    ) -> Result<Self, RowsError> {
        Self::filled(columns, rows, |_| Ok(()))
    }

    fn filled<R: Serialize>(
        columns: &[&str],
        rows: impl IntoIterator<Item = R>,
        check: impl Fn(HashMap<String, Value>) -> Result<(), RowsError>,
    ) -> Result<Self, RowsError> {
        let cells = |row: R| {
            let mut cells = HashMap::new();
            flatten("", serde_json::to_value(row)?, &mut cells);
            let row = columns.iter().map(|column| cells.remove(*column).unwrap_or_default()).collect();
            check(cells).map(|()| row)
        };
        let rows = rows.into_iter().map(cells).collect::<Result<_, _>>()?;
        Ok(Self { columns: columns.iter().map(|column| (*column).to_owned()).collect(), rows })
    }

    /// As CSV text under a header.
    ///
    /// # Errors
    /// Only where the writer fails, which memory excludes.
    pub fn csv(&self) -> Result<String, RowsError> {
        self.separated(b',')
    }

    /// The same with tabs between the cells, as spreadsheets take it from a clipboard.
    ///
    /// # Errors
    /// As [`ReportTable::csv`].
    pub fn tsv(&self) -> Result<String, RowsError> {
        self.separated(b'\t')
    }

    fn separated(&self, separator: u8) -> Result<String, RowsError> {
        let mut writer = csv::WriterBuilder::new().delimiter(separator).from_writer(Vec::new());
        writer.write_record(&self.columns)?;
        for row in &self.rows {
            writer.write_record(row.iter().map(|cell| match cell {
                Value::Null => String::new(),
                Value::String(text) => text.clone(),
                other => other.to_string(),
            }))?;
        }
        let bytes = writer.into_inner().map_err(|e| RowsError::Csv(e.into_error().into()))?;
        String::from_utf8(bytes).map_err(|e| RowsError::Shape(e.to_string()))
    }
}

/// `rows` as CSV text with the header `columns`.
///
/// # Errors
/// As [`ReportTable::of`].
pub fn csv<R: Serialize>(columns: &[&str], rows: &[R]) -> Result<String, RowsError> {
    ReportTable::of(columns, rows)?.csv()
}

/// The same with tabs between the cells, as spreadsheets take it from a clipboard.
///
/// # Errors
/// As [`csv()`].
pub fn tsv<R: Serialize>(columns: &[&str], rows: &[R]) -> Result<String, RowsError> {
    ReportTable::of(columns, rows)?.separated(b'\t')
}

fn flatten(name: &str, value: Value, cells: &mut HashMap<String, Value>) {
    match value {
        Value::Null => {}
        Value::Object(members) => {
            for (key, value) in members {
                let name = if name.is_empty() { key } else { format!("{name}_{key}") };
                flatten(&name, value, cells);
            }
        }
        other => drop(cells.insert(name.to_owned(), other)),
    }
}

#[cfg(test)]
mod tests {
    use super::{ReportTable, csv, tsv};
    use serde_json::json;

    #[test]
    fn nested_names_are_joined_and_null_is_empty() {
        let rows = [json!({"a": 1.5e-9, "b": {"c": true, "d": null}}), json!({"a": -2.0, "b": null})];
        assert_eq!(csv(&["a", "b_c", "b_d"], &rows).unwrap(), "a,b_c,b_d\n1.5e-9,true,\n-2.0,,\n");
        assert_eq!(tsv(&["a", "b_c", "b_d"], &rows).unwrap(), "a\tb_c\tb_d\n1.5e-9\ttrue\t\n-2.0\t\t\n");
        assert!(csv(&["a"], &rows).is_err());
        let picked = ReportTable::picking(&["b_c", "a"], rows).unwrap();
        assert_eq!(picked.csv().unwrap(), "b_c,a\ntrue,1.5e-9\n,-2.0\n");
    }
}
