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

/// The fields of a line; none where it is no CSV.
#[must_use]
pub fn fields(line: &[u8]) -> Option<csv::StringRecord> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line);
    reader.records().next()?.ok()
}

/// What a line says of its row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// It is not the line of that row: another row, too few fields, no numbers.
    Other,
    /// It is, with the reason of its fault, if there is one.
    Row(Option<&'static str>),
}

/// What a whole line says of this row of the spec.
#[must_use]
pub fn found(spec: &Spec, row: u64, line: &[u8]) -> Found {
    let Some(fields) = line.starts_with(beginning(spec, row).as_bytes()).then(|| fields(line)).flatten()
    else {
        return Found::Other;
    };
    let cells = 1 + spec.axes.len()..1 + spec.axes.len() + spec.columns.len();
    let is_cell =
        |at: usize| fields.get(at).is_some_and(|cell| cell.is_empty() || cell.parse::<f64>().is_ok());
    let fault = fields.get(cells.end).filter(|_| fields.len() == cells.end + 1 && cells.clone().all(is_cell));
    match (fault, fault.and_then(Fault::reason_of)) {
        (Some(""), _) => Found::Row(None),
        (Some(_), Some(reason)) => Found::Row(Some(reason)),
        _ => Found::Other,
    }
}
