//! A path as text for a terminal.

use super::number::{loss, significant};
use super::path::{EventReport, PathReport, StateReport};
use super::table::{aligned, ascii_unit, control, head, ratio};
use crate::problem::Control;
use crate::quasistatic::EventKind;
use crate::units::{Quantity, UnitSystem};
use std::fmt::Write;

/// The most rings listed one by one in a line; a document lists all.
const TOLD: usize = 2;

/// The path as lines of text.
pub fn path(report: &PathReport) -> String {
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

/// The case, its control, its start, and the notes about them.
fn opening(report: &PathReport) -> String {
    let title = report.head.problem.preset.get("title").and_then(|title| title.as_str()).unwrap_or_default();
    let units = &report.head.units.shown;
    let mut text = if title.is_empty() { String::new() } else { format!("{title}\n") };
    let _ = writeln!(text, "control: {}", control(units, report.control));
    let shown = |quantity, x| ascii_unit(units, quantity, x, |x| significant(x, 6));
    if let Some(start) = report.states.first().filter(|_| report.turn.is_none()) {
        let start = &start.state;
        let _ = writeln!(
            text,
            "start: delta {}  P {}  {} {}",
            shown(Quantity::Length, start.approach),
            shown(Quantity::Force, start.force),
            head(units, "contact", Quantity::Length),
            held(units, start, 6)
        );
    }
    for note in report.start_note.iter().chain(&report.notes) {
        let _ = writeln!(text, "note: {note}");
    }
    text
}

/// The events as a table, and what is wrong with those that are not admissible.
fn events(report: &PathReport) -> String {
    let units = &report.head.units.shown;
    let head = |name, quantity| head(units, name, quantity);
    let mut rows = vec![vec![
        "#".to_owned(),
        "event".to_owned(),
        head("contact", Quantity::Length),
        "> contact".to_owned(),
        "crest".to_owned(),
        head("delta", Quantity::Length),
        "> delta".to_owned(),
        head("P", Quantity::Force),
        "> P".to_owned(),
        head("lost", Quantity::Energy),
        "by area".to_owned(),
    ]];
    rows.extend(report.events.iter().map(|event| row(units, event)));
    let mut text = aligned(&rows, 4);
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

fn row(units: &UnitSystem, event: &EventReport) -> Vec<String> {
    let dash = || "-".to_owned();
    let shown = |quantity, x| significant(units.shown(quantity, x).number, 5);
    let lost = |x| loss(units.shown(Quantity::Energy, x).number);
    let of = |state: &Option<StateReport>, quantity, number: fn(&StateReport) -> f64| {
        state.as_ref().map_or_else(dash, |state| shown(quantity, number(state)))
    };
    let contacts = |state: &Option<StateReport>| {
        state.as_ref().map_or_else(|| "apart".to_owned(), |state| held(units, state, 5))
    };
    let (before, after) = (&event.before, &event.after);
    // Where nothing jumps, the two states are the same.
    let still = before == after;
    let landed = |text: String| if still { dash() } else { text };
    let crest = |state: &Option<StateReport>| {
        state.as_ref().and_then(|state| state.wave).map_or_else(dash, |wave| wave.to_string())
    };
    let mut kind = match event.radius {
        Some(radius) => format!("{} {}", event.kind, shown(Quantity::Length, radius)),
        None => event.kind.to_owned(),
    };
    if event.admissible == Some(false) {
        kind.push_str(" !");
    }
    vec![
        event.number.to_string(),
        kind,
        contacts(before),
        landed(contacts(after)),
        if still || [before, after].map(crest) == [dash(), dash()] {
            crest(before)
        } else {
            format!("{}>{}", crest(before), crest(after))
        },
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

/// `0.11480 [0.13710, 0.15540]`: the disc by its radius, rings by their edges.
pub fn contacts(units: &UnitSystem, contacts: &[[f64; 2]]) -> String {
    in_contact(units, contacts, 5)
}

/// The contacts of a state, with the outer edge of its zone: `0.11480 (zone 0.12130)`, `none (zone 0.02130)`.
fn held(units: &UnitSystem, state: &StateReport, digits: usize) -> String {
    let contacts = in_contact(units, &state.contacts, digits);
    let Some(edge) = state.zone_radius else { return contacts };
    let contacts = if state.contacts.is_empty() { "none".to_owned() } else { contacts };
    format!("{contacts} (zone {})", significant(units.shown(Quantity::Length, edge).number, digits))
}

fn in_contact(units: &UnitSystem, contacts: &[[f64; 2]], digits: usize) -> String {
    let shown = |x| significant(units.shown(Quantity::Length, x).number, digits);
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

/// The outcome of the path: where it turned, extreme states, losses, its end.
fn outcome(report: &PathReport) -> String {
    let (units, totals) = (&report.head.units.shown, &report.totals);
    let mut text = String::new();
    if let Some(turn) = &report.turn {
        let is_force = turn.of == "force" || turn.of == "control" && report.control == Control::Force;
        let quantity = if is_force { Quantity::Force } else { Quantity::Length };
        let at = |x| ascii_unit(units, quantity, x, |x| significant(x, 6));
        let of = match turn.of {
            "control" => "control value".to_owned(),
            of => of.replace('_', " "),
        };
        let _ = writeln!(text, "turn: asked for the {of} {}, reached {}", at(turn.asked), at(turn.reached));
    }
    let shown = |quantity, x| ascii_unit(units, quantity, x, |x| significant(x, 7));
    let delta = |at: &StateReport| shown(Quantity::Length, at.approach);
    let is_apart = report.events.last().is_some_and(|event| event.after.is_none());
    let so_far = if is_apart { "" } else { " up to the end" };
    if let Some(at) = &totals.largest_pull {
        let ratio = ratio(at.force, report.head.problem.critical_force);
        let pull = shown(Quantity::Force, at.force);
        let place =
            if at.force < 0.0 { format!(", at delta {}", delta(at)) } else { ": nothing pulls".to_owned() };
        let _ = writeln!(text, "largest pull{so_far}: {pull}{ratio}{place}");
    } else if report.has_reached_its_end {
        text += "largest pull: none: the bodies are still pressed together where the path ends\n";
    }
    if let Some(at) = &totals.farthest {
        let _ = writeln!(text, "farthest{so_far}: delta {}", delta(at));
    }
    let rings = |state: &StateReport| state.contacts.iter().filter(|edges| edges[0] > 0.0).count();
    let most = report.states.iter().map(|state| rings(&state.state)).max().unwrap_or(0);
    if most > 0 || report.turn.is_some() {
        let _ = writeln!(text, "most rings at a time: {most}");
    }
    let energy = |x| ascii_unit(units, Quantity::Energy, x, loss);
    let before = totals.dissipated_before_last_contact;
    let has_zone = report.events.iter().any(|event| event.kind == EventKind::SnapOff.name());
    let last = if has_zone { "the snap-off" } else { "the last contact" };
    // What a dead band loses is not among it.
    let lost_energy = if totals.dead_band.is_some() { "energy lost in jumps" } else { "energy lost" };
    let _ = match totals.dissipated {
        None if !is_apart => writeln!(text, "{lost_energy}{so_far}: {}", energy(before)),
        Some(lost) => {
            writeln!(text, "{lost_energy}: {}, including {} before {last}", energy(lost), energy(before))
        }
        None => writeln!(
            text,
            "{lost_energy} before {last}: {}; under a dead load the loss at {last} has no bound: the bodies keep \
             falling apart",
            energy(before)
        ),
    };
    if let Some(band) = totals.dead_band {
        let length = units.shown(Quantity::Length, 1.0);
        let area = length.text(&significant(band.area * length.number * length.number, 7), true);
        let square = if length.unit.is_some() { "^2" } else { "" };
        let lost = energy(band.dissipated);
        let _ =
            writeln!(text, "energy lost in the dead band: {lost}, on the area {area}{square} that closed");
        if let Some((up, down)) = totals.work_of_loading.zip(totals.work_of_unloading) {
            let _ = writeln!(text, "work of the loop: {}", energy(up + down));
        }
    }
    let _ = writeln!(text, "end: {}", report.stop);
    text
}
