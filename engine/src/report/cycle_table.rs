//! A loop of loading and unloading as text for a terminal.

use super::cycle::{CycleEventReport, CycleReport, CycleStateReport};
use super::number::{loss, significant};
use super::table::{aligned, ascii_unit, control, head};
use crate::problem::Control;
use crate::units::{Quantity, UnitSystem};
use std::fmt::Write;

/// Rings told one by one in a line; a document lists all.
const TOLD: usize = 2;

/// The loop as lines of text.
#[must_use]
pub fn cycle(report: &CycleReport) -> String {
    let title = report.problem.preset.get("title").and_then(|title| title.as_str()).unwrap_or_default();
    let units = &report.problem.units.shown;
    let mut text = String::new();
    let mut line = |words: &str| {
        text.push_str(words);
        text.push('\n');
    };
    if !title.is_empty() {
        line(title);
    }
    line(&format!("control: {}", control(units, report.control)));
    for note in &report.notes {
        line(&format!("note: {note}"));
    }
    line("");
    text.push_str(&events(report, units));
    text.push('\n');
    text.push_str(&outcome(report, units));
    text
}

fn events(report: &CycleReport, units: &UnitSystem) -> String {
    let head = |name, quantity| head(units, name, quantity);
    let mut rows = vec![vec![
        "#".to_owned(),
        "event".to_owned(),
        head("contact", Quantity::Length),
        "> contact".to_owned(),
        head("delta", Quantity::Length),
        "> delta".to_owned(),
        head("P", Quantity::Force),
        "> P".to_owned(),
        head("lost", Quantity::Energy),
        "by area".to_owned(),
    ]];
    rows.extend(report.events.iter().enumerate().map(|(i, event)| row(units, i + 1, event)));
    aligned(&rows, 4)
}

fn row(units: &UnitSystem, number: usize, event: &CycleEventReport) -> Vec<String> {
    let dash = || "-".to_owned();
    let shown = |quantity, x| significant(units.shown(quantity, x).number, 5);
    let lost = |x| loss(units.shown(Quantity::Energy, x).number);
    let of = |state: &Option<CycleStateReport>, quantity, number: fn(&CycleStateReport) -> f64| {
        state.as_ref().map_or_else(dash, |state| shown(quantity, number(state)))
    };
    let contacts = |state: &Option<CycleStateReport>| {
        state.as_ref().map_or_else(|| "apart".to_owned(), |state| contacts(units, &state.contacts))
    };
    let (before, after) = (&event.before, &event.after);
    // Where nothing jumps there is one state.
    let still = before == after;
    let landed = |text: String| if still { dash() } else { text };
    vec![
        number.to_string(),
        match event.radius {
            Some(radius) => format!("{} {}", event.kind, shown(Quantity::Length, radius)),
            None => event.kind.to_owned(),
        },
        contacts(before),
        landed(contacts(after)),
        of(before, Quantity::Length, |state| state.approach),
        landed(of(after, Quantity::Length, |state| state.approach)),
        of(before, Quantity::Force, |state| state.force),
        landed(of(after, Quantity::Force, |state| state.force)),
        event.dissipated.map_or_else(dash, lost),
        match event.losses_agree() {
            Some(true) => "agrees".to_owned(),
            _ => event.dissipated_by_area.map_or_else(dash, lost),
        },
    ]
}

/// `0.1148 [0.1371, 0.1554]`: the disc by its radius, rings by their edges.
#[must_use]
pub fn contacts(units: &UnitSystem, contacts: &[[f64; 2]]) -> String {
    let shown = |x| significant(units.shown(Quantity::Length, x).number, 4);
    let (disc, rings) = match contacts {
        [[inner, outer], rings @ ..] if *inner == 0.0 => (Some(shown(*outer)), rings),
        rings => (None, rings),
    };
    let ring = |[inner, outer]: &[f64; 2]| format!("[{}, {}]", shown(*inner), shown(*outer));
    let more = rings.len().saturating_sub(TOLD);
    let told = rings.iter().take(TOLD).map(ring);
    let more = (more > 0).then(|| format!("+{more}"));
    disc.into_iter().chain(told).chain(more).collect::<Vec<_>>().join(" ")
}

fn outcome(report: &CycleReport, units: &UnitSystem) -> String {
    let mut text = String::new();
    let energy = |x| ascii_unit(units, Quantity::Energy, x, loss);
    let quantity = if report.turn.of == "force"
        || report.turn.of == "control_value" && report.control == Control::Force
    {
        Quantity::Force
    } else {
        Quantity::Length
    };
    let at = |x| ascii_unit(units, quantity, x, |x| significant(x, 6));
    let of = report.turn.of.replace('_', " ");
    let _ = writeln!(
        text,
        "turn: asked for the {of} {}, reached {}",
        at(report.turn.asked),
        at(report.turn.reached)
    );
    let states = report.states.iter();
    let least = states.clone().map(|state| state.state.force).fold(f64::INFINITY, f64::min);
    let rings = states.map(|state| state.state.contacts.iter().filter(|edges| edges[0] > 0.0).count()).max();
    let _ = writeln!(
        text,
        "smallest force of the loop: {}",
        ascii_unit(units, Quantity::Force, least, |x| significant(x, 7))
    );
    let _ = writeln!(text, "most rings at a time: {}", rings.unwrap_or_default());
    let sums = &report.totals;
    let _ = match sums.dissipated {
        Some(lost) => writeln!(
            text,
            "energy lost: {}, of it {} before the pull-off",
            energy(lost),
            energy(sums.dissipated_before_pull_off)
        ),
        None => writeln!(
            text,
            "energy lost before the pull-off: {}; the pull-off loses without bound",
            energy(sums.dissipated_before_pull_off)
        ),
    };
    let _ = writeln!(text, "end: {}", report.stop);
    text
}
