//! A row of the results as a line of CSV: its number, the values of its axes, the quantities, the fault.
//!
//! Numbers have every digit, so the values of a row bring back its problem. A line never holds a line end but its own.

use super::fault::Fault;
use super::measure::Measured;
use super::spec::Spec;

/// The name of the first column.
pub const ROW: &str = "row";
/// The name of the last column.
pub const ERROR: &str = "error";

/// Fields as a line of CSV.
fn line<'a>(fields: impl IntoIterator<Item = &'a str>) -> String {
    let mut writer = csv::WriterBuilder::new().buffer_capacity(256).from_writer(Vec::new());
    // Writing to memory cannot fail, and all fields are text.
    let _ = writer.write_record(fields);
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// The names of all columns, in their order.
#[must_use]
pub fn names(spec: &Spec) -> Vec<String> {
    let axes = spec.axes.iter().map(|axis| axis.key.clone());
    let columns = spec.columns.iter().map(super::Column::name);
    std::iter::once(ROW.to_owned()).chain(axes).chain(columns).chain([ERROR.to_owned()]).collect()
}

/// The first line.
#[must_use]
pub fn header(spec: &Spec) -> String {
    line(names(spec).iter().map(String::as_str))
}

/// What the line of a row begins with: its number and the values of its axes.
#[must_use]
pub fn beginning(spec: &Spec, row: u64) -> String {
    let values = spec.values(row);
    let fields: Vec<String> =
        std::iter::once(row.to_string()).chain(values.iter().map(ToString::to_string)).collect();
    let mut text = line(fields.iter().map(String::as_str));
    text.pop();
    text.push(',');
    text
}

/// The line of a row.
#[must_use]
pub fn record(spec: &Spec, row: u64, measured: &Measured) -> String {
    let cells = measured.cells.iter().map(|cell| cell.map_or_else(String::new, |cell| cell.to_string()));
    let fault = measured.fault.as_ref().map_or_else(String::new, Fault::to_string);
    let fields: Vec<String> = cells.chain([fault]).collect();
    format!("{}{}", beginning(spec, row), line(fields.iter().map(String::as_str)))
}

/// The reason of the fault at the end of a line, if there is one.
#[must_use]
pub fn reason(line: &str) -> Option<&'static str> {
    let line = line.trim_end_matches('\n');
    if line.ends_with(',') {
        return None;
    }
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line.as_bytes());
    let record = reader.records().next()?.ok()?;
    Fault::reason_of(record.get(record.len().checked_sub(1)?)?)
}
