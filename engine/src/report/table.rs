//! Cells in columns, numbers with their units, and a verification as text for a terminal.

use super::number::{TYPED, difference, short, significant, with_unit};
use super::rows::ReportTable;
use super::verify::{VerifiedRow, VerifyReport};
use crate::problem::Control;
use crate::units::{Quantity, UnitSystem};
use serde_json::Value;
use std::fmt::Write;

/// Aligns cells in columns, the first `left` of them left and the others right; a line for each row.
pub(super) fn aligned(rows: &[Vec<String>], left: usize) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width =
        |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|c| c.chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, cell) in row.iter().enumerate() {
            let width = widths[column];
            // Writing to a String cannot fail.
            let _ = if column < left {
                write!(line, "{cell:<width$}  ")
            } else {
                write!(line, "{cell:>width$}  ")
            };
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// Any rows as lines of text under the names of their columns, numbers to eight digits.
pub fn rows(table: &ReportTable) -> String {
    let shown = |cell: &Value| match cell {
        Value::Null => "-".to_owned(),
        Value::String(text) => text.clone(),
        Value::Number(number) if number.is_f64() => significant(number.as_f64().unwrap_or(f64::NAN), 8),
        other => other.to_string(),
    };
    let cells = table.rows.iter().map(|row| row.iter().map(shown).collect());
    aligned(&std::iter::once(table.columns.clone()).chain(cells).collect::<Vec<_>>(), 0)
}

/// The head of a column, with the unit of its numbers.
pub(super) fn head(units: &UnitSystem, name: &str, quantity: Quantity) -> String {
    match units.unit(quantity) {
        Some(unit) => format!("{name} [{}]", unit.ascii()),
        None => name.to_owned(),
    }
}

/// A control as it is typed.
pub(super) fn control(units: &UnitSystem, control: Control) -> String {
    match control {
        Control::Stiffness(k) => {
            format!("stiffness={}", ascii_unit(units, Quantity::ForcePerLength, k, |k| short(k, TYPED)))
        }
        other => other.to_string(),
    }
}

pub(super) fn ratio(force: f64, critical: Option<f64>) -> String {
    let critical = critical.filter(|critical| *critical > 0.0);
    critical.map_or_else(String::new, |critical| format!(" = {} P_c", short(force / critical, 6)))
}

/// A number with its unit in ASCII: a table may go anywhere.
pub(super) fn ascii_unit(
    units: &UnitSystem,
    quantity: Quantity,
    x: f64,
    number: impl Fn(f64) -> String,
) -> String {
    with_unit(units, quantity, x, true, number)
}

/// The verification as lines of text, its rows under the headings of their groups; the last line counts them.
pub fn verify(report: &VerifyReport) -> String {
    // Beside our number stands the exact one or another of ours, which no heading may call exact.
    let heads = ["exact", "ours too"].map(|beside| ["", "ours", beside, "difference", "bound", ""]);
    let mut rows: Vec<Vec<String>> = heads.iter().map(|head| head.map(str::to_owned).to_vec()).collect();
    rows.extend(report.rows.iter().map(verified));
    let lines = aligned(&rows, 1);
    let mut lines = lines.lines();
    let heads = [(); 2].map(|()| lines.next().unwrap_or_default());
    let mut text = String::new();
    let (mut group, mut head) = (None, None);
    for (row, line) in report.rows.iter().zip(lines) {
        if head != Some(row.is_own) {
            let apart = if head.is_some() { "\n" } else { "" };
            let _ = writeln!(text, "{apart}{}", heads[usize::from(row.is_own)]);
            head = Some(row.is_own);
        }
        if group != Some(&row.group) {
            let _ = writeln!(text, "\n{} ({})", row.group, row.measure);
            group = Some(&row.group);
        }
        let _ = writeln!(text, "{line}");
    }
    let _ = writeln!(text, "\n{}", report.verdict());
    text
}

fn verified(row: &VerifiedRow) -> Vec<String> {
    let dash = || "-".to_owned();
    // Counts and orders are whole numbers: they need no decimals.
    let number = |x: f64| if x.fract() == 0.0 { short(x, 8) } else { significant(x, 8) };
    let off = |x: f64| if x == 0.0 { short(x, 1) } else { difference(x) };
    vec![
        format!("  {}", row.what),
        row.ours.map_or_else(dash, number),
        row.exact.or(row.other).map_or_else(dash, number),
        row.difference.map_or_else(dash, off),
        short(row.bound, 2),
        if row.passes { "pass" } else { "FAIL" }.to_owned(),
    ]
}
