//! The instabilities, one line each, and behind those of the curve its inadmissible parts.

use super::{is_selected, panel};
use crate::explorer::{EventSource, Inadmissible, Model, Panel};
use crate::report::OverlapReport;
use crate::report::number::{fixed, loss, significant, with_unit};
use crate::report::unload::EventReport;
use crate::tui::app::App;
use crate::units::{Quantity, UnitSystem};
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
    let events = model.shown_events();
    let selected = is_selected(app, Panel::Events);
    let title = theme.text(&title(model));
    let room = usize::from(area.width).saturating_sub(title.chars().count() + 3);
    let block = panel(theme, &title, selected)
        .title_top(Line::styled(theme.text(&headline(model, room)), theme.strong()).right_aligned());
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let [head, body] = Layout::vertical([Constraint::Length(1), Constraint::Fill(1)]).areas(inner);
    let wide = inner.width >= WIDE;
    let critical = model.curve.as_ref().map_or(0.0, |curve| curve.sweep.critical_force);
    frame.render_widget(Line::styled(theme.text(&heads(wide, critical)), theme.dim()), head);
    let parts = model.shown_inadmissible();
    if events.is_empty() && parts.is_empty() {
        frame.render_widget(Line::styled(theme.text(&empty(model)), theme.dim()), body);
        return;
    }
    let rows = usize::from(body.height);
    let count = events.len() + parts.len();
    let first = first(model, count, rows);
    let here = here(model, &events);
    let hidden = count.saturating_sub(first + rows);
    let texts = events.iter().enumerate().map(|(i, event)| {
        let mut text = row(&model.preset.units, i + 1, event, critical, wide);
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
    let notes = model.curve.iter().filter(|_| model.events == EventSource::Curve);
    let notes = notes.flat_map(|curve| &curve.sweep.notes);
    lines.extend(notes.map(|note| Line::styled(format!(" {}", theme.text(note)), theme.dim())));
    frame.render_widget(Paragraph::new(lines), body);
}

/// The first line shown, so that the selected one is.
fn first(model: &Model, count: usize, rows: usize) -> usize {
    (model.event + 1).saturating_sub(rows).min(count.saturating_sub(rows))
}

/// The line in this row of the screen, in the panel `area`.
pub fn line_at(model: &Model, area: Rect, row: u16) -> Option<usize> {
    // The frame and the heads.
    let rows = usize::from(area.height.saturating_sub(3));
    let count = model.shown_events().len() + model.shown_inadmissible().len();
    let below = usize::from(row.checked_sub(area.y + 2)?);
    let line = first(model, count, rows) + below;
    (below < rows && line < count).then_some(line)
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
    let s = node.state.in_units(node.setting.case.units()).contact_radius;
    events.iter().position(|event| (event.before.contact_radius - s).abs() <= 1e-6 * s)
}

fn title(model: &Model) -> String {
    let on_curve = model.curve.as_ref().and_then(|c| c.report.as_ref()).map_or(0, |r| r.events.len());
    let walked = model.walked_events().len();
    let units = &model.preset.units;
    let named = [Quantity::Length, Quantity::Force, Quantity::Energy].map(|quantity| units.unit(quantity));
    let named: Vec<String> = named.into_iter().flatten().map(ToString::to_string).collect();
    let units = if named.is_empty() { String::new() } else { format!(" in {}", named.join(", ")) };
    match model.events {
        EventSource::Curve => format!("Events on the curve: {on_curve}{units} (v: walked {walked})"),
        EventSource::Walked => format!("Events walked: {walked}{units} (v: on the curve {on_curve})"),
    }
}

/// Pull-off and total loss, as much of it as there is room for.
fn headline(model: &Model, room: usize) -> String {
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
    let Some(report) = &curve.report else { return String::new() };
    let force = if curve.sweep.critical_force > 0.0 {
        format!("{} Pc", significant(report.min_force / curve.sweep.critical_force, 4))
    } else {
        shown(Quantity::Force, report.min_force)
    };
    let bounded = report.events.iter().all(|e| e.dissipated.is_some());
    let parts = [
        format!("least P {force}"),
        format!("least δ {}", shown(Quantity::Length, report.min_approach)),
        lost(report.total_dissipated, bounded),
    ];
    let [force, _, lost] = &parts;
    [parts.join(", "), format!("{force}, {lost}"), force.clone()]
        .into_iter()
        .find(|text| text.chars().count() <= room)
        .unwrap_or_default()
}

fn empty(model: &Model) -> String {
    match (&model.curve, model.events) {
        (None, _) => " computing".to_owned(),
        (Some(_), EventSource::Walked) => " none yet: n runs to a limit point, x takes the jump".to_owned(),
        (Some(curve), EventSource::Curve) => match (&curve.unloading, &curve.report) {
            (Err(reason), _) => format!(" no path: {reason}"),
            (Ok(_), report) => format!(" none: {}", report.as_ref().map_or("", |report| &report.stop)),
        },
    }
}

/// The heads of the columns; without a `P_c` the forces over it are forces.
fn heads(wide: bool, critical: f64) -> String {
    let heads = if wide {
        "  # event            δ     after         P     after   P/Pc  after         s     after  crest lost      by area"
    } else {
        "   #          δ   P/Pc  after         s     after  crest lost      event"
    };
    if critical > 0.0 { heads.to_owned() } else { heads.replace("P/Pc", "   P") }
}

fn row(units: &UnitSystem, number: usize, event: &EventReport, critical: f64, wide: bool) -> String {
    let in_digits = |x, digits| significant(units.shown(Quantity::Length, x).number, digits);
    let length = |x| in_digits(x, 4);
    let energy = |x| loss(units.shown(Quantity::Energy, x).number);
    let dash = || "-".to_owned();
    let after = event.after.as_ref();
    let force = |p: f64| {
        if critical > 0.0 {
            fixed(p / critical, 3)
        } else {
            significant(units.shown(Quantity::Force, p).number, 3)
        }
    };
    let crest = |wave: Option<u64>| wave.map_or_else(dash, |m| m.to_string());
    let crests = format!("{}>{}", crest(event.before.wave), crest(after.and_then(|a| a.wave)));
    let lost = event.dissipated.map_or_else(|| "no bound".to_owned(), energy);
    let before = &event.before;
    let landed_force = after.map_or_else(dash, |a| force(a.force));
    if !wide {
        return format!(
            "{number:>3} {:>10} {:>6} {landed_force:>6} {:>9} {:>9} {crests:>6} {lost:<9} {}",
            length(before.approach),
            force(before.force),
            length(before.contact_radius),
            after.map_or_else(dash, |a| length(a.contact_radius)),
            event.kind,
        );
    }
    let agreement = match event.losses_agree() {
        Some(true) => "agrees".to_owned(),
        _ => event.dissipated_by_area.map_or_else(|| "dead load".to_owned(), energy),
    };
    format!(
        "{number:>2} {:<8} {:>9} {:>9} {:>9} {:>9} {:>6} {landed_force:>6} {:>9} {:>9} {crests:>6} {lost:<9} {agreement}",
        event.kind,
        length(before.approach),
        after.map_or_else(dash, |a| length(a.approach)),
        significant(units.shown(Quantity::Force, before.force).number, 4),
        after.map_or_else(dash, |a| significant(units.shown(Quantity::Force, a.force).number, 4)),
        force(before.force),
        in_digits(before.contact_radius, 5),
        after.map_or_else(dash, |a| in_digits(a.contact_radius, 5)),
    )
}
