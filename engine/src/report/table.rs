//! An unloading and a verification as text for a terminal.

use super::number::{difference, loss, short, significant, with_unit};
use super::rows::Table;
use super::unload::{EventReport, UnloadReport};
use super::verify::{RowReport, VerifyReport};
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
pub fn rows(table: &Table) -> String {
    let shown = |cell: &Value| match cell {
        Value::Null => "-".to_owned(),
        Value::String(text) => text.clone(),
        Value::Number(number) if number.is_f64() => significant(number.as_f64().unwrap_or(f64::NAN), 8),
        other => other.to_string(),
    };
    let cells = table.rows.iter().map(|row| row.iter().map(shown).collect());
    aligned(&std::iter::once(table.columns.clone()).chain(cells).collect::<Vec<_>>(), 0)
}

/// The unloading as lines of text.
pub fn unload(report: &UnloadReport) -> String {
    let mut text = opening(report);
    text.push('\n');
    if report.events.is_empty() {
        text.push_str("no instabilities\n");
    } else {
        text.push_str(&events(report));
    }
    text.push('\n');
    text.push_str(&outcome(report));
    text
}

/// The case, its control, its start, and what is to be known of them.
fn opening(report: &UnloadReport) -> String {
    let title = report.problem.preset.get("title").and_then(|t| t.as_str()).unwrap_or("");
    let units = &report.problem.units.shown;
    let control = control(units, report.control);
    let shown = |quantity, x| ascii_unit(units, quantity, x, |x| significant(x, 6));
    let start = &report.start;
    let title = if title.is_empty() { String::new() } else { format!("{title}\n") };
    let mut text = format!(
        "{title}control: {control}\nstart: delta {}  P {}  s {}\n",
        shown(Quantity::Length, start.approach),
        shown(Quantity::Force, start.force),
        shown(Quantity::Length, start.contact_radius)
    );
    for note in start.note.iter().chain(&report.notes) {
        let _ = writeln!(text, "note: {note}");
    }
    text
}

/// The events as a table, and what is wrong with those that cannot be.
fn events(report: &UnloadReport) -> String {
    let units = &report.problem.units.shown;
    let head = |name, quantity| head(units, name, quantity);
    let mut rows = vec![vec![
        "#".to_owned(),
        "event".to_owned(),
        head("delta", Quantity::Length),
        "> delta".to_owned(),
        head("P", Quantity::Force),
        "> P".to_owned(),
        head("s", Quantity::Length),
        "> s".to_owned(),
        "crest".to_owned(),
        head("lost", Quantity::Energy),
        "by area".to_owned(),
    ]];
    rows.extend(report.events.iter().enumerate().map(|(i, event)| row(units, i + 1, event)));
    let mut text = aligned(&rows, 2);
    if report.events.iter().any(|event| event.admissible == Some(false)) {
        let found = report.inadmissible.as_deref().unwrap_or_default();
        let crest = found.iter().any(|part| part.crest_radius.is_some());
        let pull = found.iter().any(|part| part.crest_radius.is_none());
        let faults = [(crest, "the next crest would touch"), (pull, "the disc would have to pull")];
        let faults: Vec<&str> = faults.iter().filter(|(is, _)| *is).map(|(_, fault)| *fault).collect();
        let _ = writeln!(text, "! limit point or landing inadmissible: {}", faults.join(", or "));
    }
    text
}

/// What the path comes to: extreme values, losses, its end.
fn outcome(report: &UnloadReport) -> String {
    let units = &report.problem.units.shown;
    let least = |quantity, x| ascii_unit(units, quantity, x, |x| significant(x, 7));
    let mut text = format!(
        "smallest force on the path: {}{}\nsmallest approach on the path: {}\n",
        least(Quantity::Force, report.min_force),
        ratio(report.min_force, report.problem.critical_force),
        least(Quantity::Length, report.min_approach)
    );
    let unbounded = report.events.iter().any(|event| event.dissipated.is_none());
    let bounded = report.events.iter().any(|event| event.dissipated.is_some());
    let lost = ascii_unit(units, Quantity::Energy, report.total_dissipated, loss);
    let _ = match (unbounded, bounded) {
        (false, _) => writeln!(text, "energy lost: {lost}"),
        (true, true) => {
            writeln!(text, "energy lost before the pull-off: {lost}; the pull-off loses without bound")
        }
        (true, false) => {
            writeln!(text, "energy lost: the pull-off, the only instability, loses without bound")
        }
    };
    let _ = writeln!(text, "end: {}", report.stop);
    for event in report.events.iter().filter(|event| event.dissipated.is_none()) {
        let _ = writeln!(text, "{}: {}", event.kind, event.reason);
    }
    text
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
            format!("stiffness={}", ascii_unit(units, Quantity::ForcePerLength, k, |k| k.to_string()))
        }
        other => other.to_string(),
    }
}

fn ratio(force: f64, critical: Option<f64>) -> String {
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

fn row(units: &UnitSystem, number: usize, event: &EventReport) -> Vec<String> {
    let (before, after) = (&event.before, event.after.as_ref());
    let dash = || "-".to_owned();
    let number_in = |quantity, x| significant(units.shown(quantity, x).number, 5);
    let lost = |x| loss(units.shown(Quantity::Energy, x).number);
    let landed = |quantity, of: fn(&super::unload::StateReport) -> f64| {
        after.map_or_else(dash, |a| number_in(quantity, of(a)))
    };
    let crest = |wave: Option<u64>| wave.map_or_else(dash, |m| m.to_string());
    let agreement = match event.losses_agree() {
        Some(true) => "agrees".to_owned(),
        _ => event.dissipated_by_area.map_or_else(dash, lost),
    };
    vec![
        number.to_string(),
        if event.admissible == Some(false) { format!("{} !", event.kind) } else { event.kind.to_owned() },
        number_in(Quantity::Length, before.approach),
        landed(Quantity::Length, |a| a.approach),
        number_in(Quantity::Force, before.force),
        landed(Quantity::Force, |a| a.force),
        number_in(Quantity::Length, before.contact_radius),
        landed(Quantity::Length, |a| a.contact_radius),
        format!("{}>{}", crest(before.wave), crest(after.and_then(|a| a.wave))),
        event.dissipated.map_or_else(dash, lost),
        agreement,
    ]
}

/// The verification as lines of text, its rows under the headings of their groups; the last line counts them.
pub fn verify(report: &VerifyReport) -> String {
    // Beside ours stands the exact number or another of ours, which no heading may call exact.
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

fn verified(row: &RowReport) -> Vec<String> {
    let dash = || "-".to_owned();
    // Counts and orders are whole numbers: no decimals that say nothing.
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
