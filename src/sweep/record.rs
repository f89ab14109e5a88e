//! A row of the results as a line of CSV: its number, the values of its axes, the quantities, the fault.
//!
//! Numbers have all their digits, so the values of a row reproduce its problem. A line contains no line end but its own.

use pulloff_engine::sweep::axis::SweepAxis;
use pulloff_engine::sweep::spec::{Design, Spec, values};
use pulloff_engine::sweep::{Cell, Fault, MeasuredQuantities, QuantityColumn};
use pulloff_engine::text::quote;
use std::fmt;

/// The name of the first column.
pub const ROW: &str = "row";
/// The name of the last column.
pub const ERROR: &str = "error";

/// The columns that count the rows at a point of an ensemble and those of them with an error, with their meanings.
pub const COUNTS: [(&str, &str); 2] =
    [("members", "members computed"), ("refused", "members with an error, some of whose values are missing")];

/// The name of a statistic of a quantity.
pub fn statistic(quantity: &str, of: &str) -> String {
    format!("{quantity}.{of}")
}

/// What is known of the rows without computing them: the values of the axes in each, and the names of all columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    pub axes: Vec<SweepAxis>,
    pub design: Design,
    pub columns: Vec<String>,
}

/// The outcome of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowOutcome {
    /// The reason of its fault, if it has one.
    pub fault: Option<&'static str>,
    /// Whether it has a quantity; a fault in one quantity leaves the others.
    pub has_quantity: bool,
}

impl RowOutcome {
    /// Whether there is a fault and nothing else.
    pub fn is_failure(self) -> bool {
        self.fault.is_some() && !self.has_quantity
    }
}

/// Why a line is not the expected one, in words that are safe to show.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wrong(String);

impl Wrong {
    /// A line after that of the last row.
    pub(super) fn behind_the_last() -> Self {
        Self("there are more lines than rows".to_owned())
    }
}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

fn line<'a>(fields: impl IntoIterator<Item = &'a str>) -> String {
    let mut writer = csv::WriterBuilder::new().buffer_capacity(256).from_writer(Vec::new());
    // Writing to memory cannot fail, and all fields are text.
    let _ = writer.write_record(fields);
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// The names of all columns, in their order.
pub fn names(spec: &Spec) -> Vec<String> {
    let axes = spec.axes.iter().map(|axis| axis.key.clone());
    let columns = spec.columns.iter().map(QuantityColumn::name);
    std::iter::once(ROW.to_owned()).chain(axes).chain(columns).chain([ERROR.to_owned()]).collect()
}

/// The beginning of a row's line: its number and the values of its axes.
fn known(axes: &[SweepAxis], design: Design, row: u64) -> Vec<String> {
    let values = values(axes, design, row);
    std::iter::once(row.to_string()).chain(values.iter().map(ToString::to_string)).collect()
}

fn beginning(fields: &[String]) -> String {
    let mut text = line(fields.iter().map(String::as_str));
    text.pop();
    text.push(',');
    text
}

/// The line made of the known cells of a row and those that were found.
fn after(known: &[String], found: &[String]) -> String {
    format!("{}{}", beginning(known), line(found.iter().map(String::as_str)))
}

/// The line of a row.
pub fn record(spec: &Spec, row: u64, measured: &MeasuredQuantities) -> String {
    let cells = measured.cells.iter().map(|cell| cell.map_or_else(String::new, |cell| cell.to_string()));
    let fault = measured.fault.as_ref().map_or_else(String::new, Fault::to_string);
    let fields: Vec<String> = cells.chain([fault]).collect();
    after(&known(&spec.axes, spec.design, row), &fields)
}

/// The fields of a line; `None` where it is not CSV.
fn fields(line: &[u8]) -> Option<csv::StringRecord> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line);
    reader.records().next()?.ok()
}

impl Layout {
    /// The layout of the results of a spec.
    #[must_use]
    pub fn of(spec: &Spec) -> Self {
        Self { axes: spec.axes.clone(), design: spec.design, columns: names(spec) }
    }

    /// The layout for the points of an ensemble, which has no values for what the members draw.
    #[must_use]
    pub fn of_points(mut self) -> Self {
        self.axes.retain(|axis| axis.count().is_some());
        self.design = self.design.of_points();
        self
    }

    /// The first line.
    pub fn header(&self) -> String {
        line(self.columns.iter().map(String::as_str))
    }

    /// The line of a row whose other cells are `found`.
    pub(super) fn line(&self, row: u64, found: impl Iterator<Item = String>) -> String {
        after(&known(&self.axes, self.design, row), &found.collect::<Vec<_>>())
    }

    /// Checks the first line.
    pub fn check_header(&self, line: &[u8]) -> Result<(), Wrong> {
        if line == self.header().as_bytes() {
            return Ok(());
        }
        let names: Vec<&str> = self.columns.iter().map(String::as_str).collect();
        Err(Wrong(format!("the columns are not {}", names.join(", "))))
    }

    /// The outcome of a row, from its complete line.
    pub fn outcome(&self, row: u64, line: &[u8]) -> Result<RowOutcome, Wrong> {
        let known = known(&self.axes, self.design, row);
        let wrong = |what: &str| Wrong(format!("row {row}: {what}"));
        let fields = fields(line).ok_or_else(|| wrong("is not CSV"))?;
        let wrong_field = |at: usize, expected: &str| {
            let column = self.columns.get(at).map_or("", String::as_str);
            let found = fields.get(at).unwrap_or_default();
            wrong(&format!("column {} is {}, expected {expected}", quote(column), shown(found)))
        };
        if let Some(at) = (0..known.len()).find(|at| fields.get(*at) != Some(&known[*at])) {
            return Err(wrong_field(at, &shown(&known[at])));
        }
        if fields.len() != self.columns.len() {
            return Err(wrong(&format!("has {} fields, expected {}", fields.len(), self.columns.len())));
        }
        if !line.starts_with(beginning(&known).as_bytes()) {
            return Err(wrong("is not written as a sweep writes it"));
        }
        let last = fields.len() - 1;
        let fault = Fault::reason_of(&fields[last]);
        if fault.is_none() && !fields[last].is_empty() {
            return Err(wrong_field(last, "a fault or nothing"));
        }
        // As a sweep writes them.
        let is_count = |cell: &str| cell.parse().is_ok_and(|n: usize| n.to_string() == cell);
        let is_number = |cell: &str| {
            cell.parse().is_ok_and(|x: f64| x.is_finite() && Cell::Number(x).to_string() == cell)
        };
        for at in known.len()..last {
            let counts = QuantityColumn::named(&self.columns[at]).is_ok_and(|of| of.quantity.is_count);
            let (is_cell, expected) = match (&fields[at], counts) {
                ("", true) => (fault.is_some(), "a whole number, or nothing in a row with an error"),
                ("", false) => (true, ""),
                (cell, true) => (is_count(cell), "a whole number"),
                // The numbers of members in statistics are counts, too.
                (cell, false) => (is_number(cell) || is_count(cell), "a finite number or nothing"),
            };
            if !is_cell {
                return Err(wrong_field(at, expected));
            }
        }
        let has_quantity = (known.len()..last).any(|at| !fields[at].is_empty());
        Ok(RowOutcome { fault, has_quantity })
    }
}

fn shown(field: &str) -> String {
    if field.is_empty() { "empty".to_owned() } else { quote(field) }
}
