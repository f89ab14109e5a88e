//! The instabilities, one line each, and behind those of the curve its inadmissible parts.

use super::parts::{is_selected, panel, whole_words};
use crate::explorer::{Axes, EventSource, Id, Inadmissible, Model, Panel};
use crate::tui::app::App;
use crate::tui::keymap::Keymap;
use pulloff_engine::problem::Control;
use pulloff_engine::report::number::{fixed, loss, significant, with_unit};
use pulloff_engine::report::path::{EventReport, StateReport};
use pulloff_engine::report::{OverlapReport, path_table};
use pulloff_engine::units::{Quantity, UnitSystem};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::Style;
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

/// Width from which the long columns fit.
const WIDE: u16 = 112;

/// Draws the list of instabilities.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let (model, theme) = (&app.model, app.theme);
    let units = &model.preset.units;
    let events = model.shown_events();
    let selected = is_selected(app, Panel::Events);
    let title = theme.text(&title(model, &app.keymap));
    let room = usize::from(area.width).saturating_sub(title.chars().count() + 3);
    let block = panel(theme, &title, selected).title_top(
        Line::styled(theme.text(&headline(model, &app.keymap, room)), theme.strong()).right_aligned(),
    );
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let [head, body] = Layout::vertical([Constraint::Length(1), Constraint::Fill(1)]).areas(inner);
    let wide = inner.width >= WIDE;
    let critical = critical(model, wide);
    let held = model.control().is_some_and(|control| control == Control::Force);
    let room = usize::from(inner.width);
    let (heads, texts) = table(&model.preset.units, &events, critical, (wide, held), room.saturating_sub(3));
    frame.render_widget(Line::styled(whole_words(theme, &theme.text(&heads), room), theme.dim()), head);
    let parts = model.shown_inadmissible();
    if events.is_empty() && parts.is_empty() {
        frame.render_widget(Line::styled(theme.text(&empty(model, &app.keymap)), theme.dim()), body);
        return;
    }
    let rows = usize::from(body.height);
    let count = events.len() + parts.len();
    let first = first(model, count, rows);
    let here = here(model, &events);
    let hidden = count.saturating_sub(first + rows);
    let texts = events.iter().zip(texts).map(|(event, mut text)| {
        if event.admissible == Some(false) {
            text.push_str(" !");
        }
        text
    });
    let mut lines: Vec<Line> = texts
        .chain(parts.iter().map(|found| part(found, &model.preset.units, theme.ascii)))
        .enumerate()
        .skip(first)
        .take(rows)
        .map(|(i, mut text)| {
            if here == Some(i) {
                text.push_str(" @");
            }
            if hidden > 0 && i + 1 == first + rows {
                text.push_str(&format_args!(" (+{hidden})").to_string());
            }
            let chosen = i == model.event && selected;
            let mark = if chosen { '>' } else { ' ' };
            let style = if chosen { theme.selection() } else { Style::new() };
            Line::styled(format!("{mark}{}", theme.text(&text)), style)
        })
        .collect();
    // Where there is room; the documents have it too.
    if model.events == EventSource::Cycle {
        let found = model.cycle.iter().filter_map(|cycle| cycle.report());
        let rings =
            found.filter_map(|report| report.events.get(model.event)).map(|event| contacts(event, units));
        lines.extend(rings.map(|text| Line::styled(format!(" {}", theme.text(&text)), theme.dim())));
    }
    let notes = model.curve.iter().filter(|_| model.events.is_curve());
    let notes = notes.flat_map(|curve| &curve.base.notes);
    lines.extend(notes.map(|note| Line::styled(format!(" {}", theme.text(note)), theme.dim())));
    let fitted = lines.into_iter().map(|line| {
        let style = line.style;
        Line::styled(whole_words(theme, &line.to_string(), room), style)
    });
    frame.render_widget(Paragraph::new(fitted.collect::<Vec<_>>()), body);
}

/// The first line shown, so that the selected one is.
fn first(model: &Model, count: usize, rows: usize) -> usize {
    (model.event + 1).saturating_sub(rows).min(count.saturating_sub(rows))
}

/// The line in this row of the screen, in the panel `area`.
pub fn line_at(model: &Model, area: Rect, row: u16) -> Option<usize> {
    // Three lines are the frame and the column heads.
    let rows = usize::from(area.height.saturating_sub(3));
    let count = model.shown_events().len() + model.shown_inadmissible().len();
    let below = usize::from(row.checked_sub(area.y + 2)?);
    let line = first(model, count, rows) + below;
    (below < rows && line < count).then_some(line)
}

/// The contacts before and after an event of the loop.
fn contacts(event: &EventReport, units: &UnitSystem) -> String {
    let of = |state: &Option<StateReport>| {
        state
            .as_ref()
            .map_or_else(|| "apart".to_owned(), |state| path_table::contacts(units, &state.contacts))
    };
    format!("contact {} -> {}", of(&event.before), of(&event.after))
}

/// An inadmissible part of the curve: no event, so it has no number.
fn part(part: &Inadmissible, units: &UnitSystem, ascii: bool) -> String {
    let OverlapReport { crest_wave, .. } = part.report;
    let wave = crest_wave.map_or_else(String::new, |wave| format!(" ({wave})"));
    format!(" ! inadmissible {}{wave}", part.report.text(units, ascii))
}

/// The event of the limit point on which the walker stands.
fn here(model: &Model, events: &[EventReport]) -> Option<usize> {
    model.limit_number()?;
    let node = model.walker()?;
    let s = node.state.in_units(node.setting.units()).contact_radius;
    let near = |before: &StateReport| (before.contact_radius - s).abs() <= 1e-6 * s;
    events.iter().position(|event| event.before.as_ref().is_some_and(near))
}

fn title(model: &Model, keymap: &Keymap) -> String {
    let key = keymap.first(Id::Events);
    let on_curve = model.curve.as_ref().and_then(|c| c.report.as_ref()).map_or(0, |r| r.events.len());
    let walked = model.walked_events().len();
    let units = &model.preset.units;
    let named = [Quantity::Length, Quantity::Force, Quantity::Energy].map(|quantity| units.unit(quantity));
    let named: Vec<String> = named.into_iter().flatten().map(ToString::to_string).collect();
    let units = if named.is_empty() { String::new() } else { format!(" in {}", named.join(", ")) };
    let (next, there) = match model.events.next(model.cycle_wanted.is_some()) {
        EventSource::Curve => ("on the curve", format!(" {on_curve}")),
        EventSource::Walked => ("walked", format!(" {walked}")),
        EventSource::Folded => ("folds them", String::new()),
        EventSource::Cycle => {
            let count = model.cycle.as_ref().and_then(|cycle| cycle.report()).map(|r| r.events.len());
            ("of the loop", count.map_or_else(String::new, |count| format!(" {count}")))
        }
    };
    match model.events {
        EventSource::Cycle => {
            let count = model.shown_events().len();
            let old = model.cycle.as_ref().is_some_and(|cycle| !cycle.is_of(&model.preset));
            let old = if old { ", of the values before" } else { "" };
            format!("Events of the loop: {count}{old}{units} ({key}: {next}{there})")
        }
        EventSource::Curve => {
            let parts = match model.shown_inadmissible().len() {
                0 => String::new(),
                count => format!(", {count} inadmissible"),
            };
            format!("Events on the curve: {on_curve}{parts}{units} ({key}: {next}{there})")
        }
        EventSource::Folded => format!("Events on the curve: {on_curve} ({key}: unfolds them)"),
        EventSource::Walked => format!("Events walked: {walked}{units} ({key}: {next}{there})"),
    }
}

/// `P_c`, by which forces are divided; 0 without adhesion, and on raw axes where forces have no column of their own.
fn critical(model: &Model, wide: bool) -> f64 {
    let curve = model.curve.as_ref().filter(|_| wide || model.axes == Axes::Reduced);
    curve.map_or(0.0, |curve| curve.base.critical_force)
}

/// Pull-off and total loss, as much of it as there is room for.
fn headline(model: &Model, keymap: &Keymap, room: usize) -> String {
    let Some(curve) = &model.curve else { return String::new() };
    let units = &model.preset.units;
    let lost = |total: f64, bounded: bool| {
        let total = with_unit(units, Quantity::Energy, total, false, loss);
        format!("lost {total}{}", if bounded { "" } else { "+" })
    };
    let shown = |quantity, x| with_unit(units, quantity, x, false, |x| significant(x, 4));
    if model.events == EventSource::Walked {
        let events = model.walked_events();
        let total = events.iter().filter_map(|(_, e)| e.dissipated).fold(0.0, |a, b| a + b);
        return lost(total, events.iter().all(|(_, e)| e.dissipated.is_some()));
    }
    if model.events == EventSource::Cycle {
        let report = model.cycle.as_ref().and_then(|cycle| cycle.report());
        let total =
            report.map(|report| (report.totals.dissipated, report.totals.dissipated_before_last_contact));
        return total.map_or_else(String::new, |(all, before)| lost(all.unwrap_or(before), all.is_some()));
    }
    let Some(report) = &curve.report else { return String::new() };
    let totals = &report.totals;
    let [pull, far] = [&totals.largest_pull, &totals.farthest].map(Option::as_ref);
    let [pull, far] = [pull.map_or(f64::NAN, |at| at.force), far.map_or(f64::NAN, |at| at.approach)];
    let least = shown(Quantity::Force, pull);
    let share = (curve.base.critical_force > 0.0)
        .then(|| format!("{} Pc", significant(pull / curve.base.critical_force, 4)));
    let force = share.clone().filter(|_| model.axes == Axes::Reduced).unwrap_or_else(|| least.clone());
    // Both, where the one has a unit and there is room.
    let both =
        share.filter(|_| units.unit(Quantity::Force).is_some()).map(|share| format!("{least} = {share}"));
    let bounded = report.events.iter().all(|e| e.dissipated.is_some());
    let parts = [
        format!("least P {force}"),
        format!("least δ {}", shown(Quantity::Length, far)),
        lost(totals.dissipated.unwrap_or(totals.dissipated_before_last_contact), bounded),
    ];
    let [force, approach, lost] = &parts;
    let key = keymap.first(Id::LeastForce);
    let whole = both.map(|both| format!("least P {both} ({key}), {approach}, {lost}"));
    whole
        .into_iter()
        .chain([format!("{force} ({key}), {approach}, {lost}"), parts.join(", "), format!("{force}, {lost}")])
        .chain([force.clone()])
        .find(|text| text.chars().count() <= room)
        .unwrap_or_default()
}

fn empty(model: &Model, keymap: &Keymap) -> String {
    let [limit, jump] = [Id::NextLimit, Id::Jump].map(|id| keymap.first(id));
    match (&model.curve, model.events) {
        (None, _) => " computing".to_owned(),
        (Some(_), EventSource::Walked) => {
            format!(" none yet: {limit} runs to a limit point, {jump} takes the jump")
        }
        (Some(_), EventSource::Cycle) => match model.cycle.as_ref().map(|cycle| &cycle.report) {
            Some(Err(reason)) => format!(" no loop: {reason}"),
            _ => " computing the loop".to_owned(),
        },
        (Some(curve), EventSource::Curve | EventSource::Folded) => match (&curve.unloading, &curve.report) {
            (Err(reason), _) => format!(" no path: {reason}"),
            (Ok(_), report) => format!(" none: {}", report.as_ref().map_or("", |report| &report.stop)),
        },
    }
}

/// A column: its head, its least width, whether its cells begin at its left, and how soon it is left out.
type Column = (&'static str, usize, bool, u8);

/// The columns on a wide screen.
const LONG: &[Column] = &[
    ("#", 2, false, 0),
    ("event", 8, true, 5),
    ("δ", 9, false, 0),
    ("after", 9, false, 2),
    ("P", 9, false, 1),
    ("after", 9, false, 2),
    ("P/Pc", 6, false, 3),
    ("after", 6, false, 3),
    ("s", 9, false, 1),
    ("after", 9, false, 4),
    ("crest", 6, false, 2),
    ("lost", 9, true, 0),
    ("by area", 0, true, 6),
];

/// The columns on a narrow one.
const SHORT: &[Column] = &[
    ("#", 3, false, 0),
    ("δ", 10, false, 0),
    ("P/Pc", 6, false, 1),
    ("after", 6, false, 3),
    ("s", 9, false, 2),
    ("after", 9, false, 4),
    ("crest", 6, false, 2),
    ("lost", 9, true, 0),
    ("event", 0, true, 5),
];

/// The same under a dead load: the load once, the approach before and after.
const SHORT_HELD: &[Column] = &[
    ("#", 3, false, 0),
    ("P/Pc", 6, false, 0),
    ("δ", 10, false, 0),
    ("after", 10, false, 1),
    ("s", 9, false, 2),
    ("after", 9, false, 4),
    ("crest", 6, false, 2),
    ("lost", 9, true, 0),
    ("event", 0, true, 5),
];

/// The heads and the rows of the events, with as many columns as there is room for; without a `P_c` forces are shown in
/// their unit.
fn table(
    units: &UnitSystem,
    events: &[EventReport],
    critical: f64,
    (wide, held): (bool, bool),
    room: usize,
) -> (String, Vec<String>) {
    let columns = match (wide, held) {
        (true, _) => LONG,
        (false, true) => SHORT_HELD,
        (false, false) => SHORT,
    };
    let cells = |event| match (wide, held) {
        (true, _) => long(units, event, critical),
        (false, true) => held_row(units, event, critical),
        (false, false) => row(units, event, critical),
    };
    let rows: Vec<Vec<String>> = events.iter().map(cells).collect();
    let heads: Vec<String> = columns
        .iter()
        .map(|(head, ..)| if *head == "P/Pc" && critical <= 0.0 { "P" } else { head }.to_owned())
        .collect();
    // Under a dead load the force is held: after an event it is what it was.
    let is_said = |at: usize| !(wide && held && matches!(at, 5 | 7));
    let width = |at: usize| {
        let widest = rows.iter().filter_map(|row| row.get(at)).map(|cell| cell.chars().count()).max();
        widest.unwrap_or(0).max(columns[at].1).max(heads[at].chars().count())
    };
    let mut kept: Vec<usize> = (0..columns.len()).filter(|at| is_said(*at)).collect();
    while kept.iter().map(|at| width(*at) + 1).sum::<usize>() > room + 1 {
        let Some(worst) =
            kept.iter().copied().max_by_key(|at| columns[*at].3).filter(|at| columns[*at].3 > 0)
        else {
            break;
        };
        kept.retain(|at| *at != worst);
    }
    let join = |cells: &[String]| {
        let padded = kept.iter().filter_map(|at| Some((cells.get(*at)?, columns[*at].2, width(*at))));
        let padded = padded.map(
            |(cell, left, width)| {
                if left { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            },
        );
        padded.collect::<Vec<_>>().join(" ").trim_end().to_owned()
    };
    (format!(" {}", join(&heads)), rows.iter().map(|row| join(row)).collect())
}

/// The crests before and after.
fn crests(event: &EventReport) -> String {
    let crest = |wave: Option<u64>| wave.map_or_else(dash, |m| m.to_string());
    let [before, after] = [&event.before, &event.after].map(|state| state.as_ref().and_then(|at| at.wave));
    if before.or(after).is_none() {
        return dash();
    }
    format!("{}>{}", crest(before), crest(after))
}

fn dash() -> String {
    "-".to_owned()
}

fn lost(units: &UnitSystem, event: &EventReport) -> String {
    let energy = |x| loss(units.shown(Quantity::Energy, x).number);
    event.dissipated.map_or_else(|| "no bound".to_owned(), energy)
}

/// P before and after over `P_c`, or in its unit.
fn forces(units: &UnitSystem, event: &EventReport, critical: f64) -> [String; 2] {
    let force = |p: f64| {
        if critical > 0.0 {
            fixed(p / critical, 3)
        } else {
            significant(units.shown(Quantity::Force, p).number, 3)
        }
    };
    [&event.before, &event.after].map(|state| state.as_ref().map_or_else(dash, |at| force(at.force)))
}

/// A number of the states before and after.
fn ends(event: &EventReport, shown: impl Fn(&StateReport) -> String) -> [String; 2] {
    [&event.before, &event.after].map(|state| state.as_ref().map_or_else(dash, &shown))
}

fn row(units: &UnitSystem, event: &EventReport, critical: f64) -> Vec<String> {
    let length = |x| significant(units.shown(Quantity::Length, x).number, 4);
    let [before, after] = forces(units, event, critical);
    let [radius, radius_after] = ends(event, |at| length(at.contact_radius));
    let [approach, approach_after] = ends(event, |at| length(at.approach));
    vec![
        event.number.to_string(),
        if event.before.is_some() { approach } else { approach_after },
        before,
        after,
        radius,
        radius_after,
        crests(event),
        lost(units, event),
        event.kind.to_owned(),
    ]
}

/// Under a dead load.
fn held_row(units: &UnitSystem, event: &EventReport, critical: f64) -> Vec<String> {
    let length = |x| significant(units.shown(Quantity::Length, x).number, 4);
    let [force, force_after] = forces(units, event, critical);
    let [approach, approach_after] = ends(event, |at| length(at.approach));
    let [radius, radius_after] = ends(event, |at| length(at.contact_radius));
    vec![
        event.number.to_string(),
        if event.before.is_some() { force } else { force_after },
        approach,
        approach_after,
        radius,
        radius_after,
        crests(event),
        lost(units, event),
        event.kind.to_owned(),
    ]
}

fn long(units: &UnitSystem, event: &EventReport, critical: f64) -> Vec<String> {
    let shown = |quantity, x, digits| significant(units.shown(quantity, x).number, digits);
    let [approach, approach_after] = ends(event, |at| shown(Quantity::Length, at.approach, 4));
    let [force, force_after] = ends(event, |at| shown(Quantity::Force, at.force, 4));
    let [radius, radius_after] = ends(event, |at| shown(Quantity::Length, at.contact_radius, 5));
    let [share, share_after] = forces(units, event, critical);
    let agreement = match event.losses_agree() {
        Some(true) => "agrees".to_owned(),
        _ => event.dissipated_by_area.map_or_else(
            || if event.dissipated.is_none() { "dead load".to_owned() } else { dash() },
            |x| loss(units.shown(Quantity::Energy, x).number),
        ),
    };
    vec![
        event.number.to_string(),
        event.kind.to_owned(),
        approach,
        approach_after,
        force,
        force_after,
        share,
        share_after,
        radius,
        radius_after,
        crests(event),
        lost(units, event),
        agreement,
    ]
}
