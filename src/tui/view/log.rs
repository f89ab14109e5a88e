//! The log: what happens on the path, done, here and ahead, one line each; after it the inadmissible parts of the
//! curve.

use super::parts::{is_selected, panel};
use crate::explorer::log::{EventMark, Log, LogEntry};
use crate::explorer::node::{Node, NodeKind};
use crate::explorer::{Inadmissible, Model, ScreenPanel};
use crate::figure::{Axis, Scale};
use crate::tui::app::App;
use crate::tui::keymap::Keymap;
use crate::tui::theme::Theme;
use pulloff_engine::problem::{Begin, Control};
use pulloff_engine::report::PathReport;
use pulloff_engine::report::number::{fixed, loss, significant};
use pulloff_engine::report::path::{EventReport, StateReport};
use pulloff_engine::units::{Quantity, UnitSystem};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

/// With this many lines inside, there is room for the course of the control.
const BAR_ROWS: u16 = 4;

/// Draws the log.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let (model, theme) = (&app.model, app.theme);
    let log = model.log();
    let selected = is_selected(app, ScreenPanel::Log);
    let (head, sums) = title(model, &log, theme, usize::from(area.width));
    let block = panel(theme, &head, selected).title_top(Line::styled(sums, theme.strong()).right_aligned());
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let room = usize::from(inner.width);
    let bar = bar(model, theme, area);
    let rows = usize::from(inner.height).saturating_sub(usize::from(bar.is_some()));
    let mut lines: Vec<Line> = bar.into_iter().collect();
    let parts = model.shown_inadmissible();
    if log.entries.is_empty() && parts.is_empty() {
        lines.push(Line::styled(
            theme.whole_words(&theme.text(&empty(model, &app.keymap)), room),
            theme.dim(),
        ));
        frame.render_widget(Paragraph::new(lines), inner);
        return;
    }
    let count = log.entries.len() + parts.len();
    let shown = shown(&log, model, count, rows);
    // How many events, and how many inadmissible parts after them, are left out above the first line and below each.
    let events = log.entries.len();
    let left_out = |[from, to]: [usize; 2]| {
        let of = [to.min(events) - from.min(events), to.max(events) - from.max(events)];
        let texts = [(" +", of[0]), (" !", of[1])].map(|(sign, count)| format!("{sign}{count}"));
        texts.into_iter().zip(of).filter(|(_, count)| *count > 0).map(|(text, _)| text).collect::<String>()
    };
    let first = shown.first().copied().unwrap_or(0);
    let mut more: Vec<String> = shown
        .iter()
        .zip(shown.iter().skip(1).chain([&count]))
        .map(|(i, next)| left_out([i + 1, *next]))
        .collect();
    if let Some(below) = more.first_mut() {
        below.insert_str(0, &left_out([0, first]));
    }
    let width = room - more.iter().map(String::len).max().unwrap_or(0);
    let texts = table(model, theme, &log.entries, first, width.saturating_sub(1));
    let units = &model.preset.units;
    let texts: Vec<String> =
        texts.into_iter().chain(parts.iter().map(|found| part(found, units, theme.ascii))).collect();
    let rows = shown.into_iter().zip(more).filter_map(|(i, more)| Some((i, more, texts.get(i)?)));
    lines.extend(rows.map(|(i, more, text)| {
        let chosen = i == model.event && selected;
        let mark = if chosen { '>' } else { ' ' };
        let text = theme.whole_words(&theme.text(&format!("{mark}{text}")), width);
        let text = if more.is_empty() { text } else { format!("{text:<width$}{more}") };
        let style = match log.entries.get(i).map(|entry| entry.mark) {
            _ if chosen => theme.selection(),
            Some(EventMark::Here) => theme.strong(),
            Some(EventMark::Ahead) | None => Style::new(),
            Some(EventMark::Done | EventMark::PassedBy) => theme.dim(),
        };
        Line::styled(text.trim_end().to_owned(), style)
    }));
    let notes = model.curve.iter().flat_map(|curve| &curve.base.notes);
    let note =
        |text: &String| Line::styled(theme.whole_words(&theme.text(&format!(" {text}")), room), theme.dim());
    lines.extend(notes.map(note));
    frame.render_widget(Paragraph::new(lines), inner);
}

/// The lines shown: those around the selected one, and always the one where the walker stands, or the next one.
fn shown(log: &Log, model: &Model, count: usize, rows: usize) -> Vec<usize> {
    let next = || log.latest().map_or(0, |latest| latest + 1);
    let here = log.entries.iter().position(|entry| entry.mark == EventMark::Here).unwrap_or_else(next);
    // The last event done stays in sight.
    let above = if model.panel == ScreenPanel::Log { model.event + 1 } else { here + 2 };
    let about = |rows: usize| {
        let first = above.saturating_sub(rows).min(count.saturating_sub(rows));
        first..count.min(first + rows)
    };
    if rows < 2 || here >= count || about(rows).contains(&here) {
        return about(rows).collect();
    }
    let mut lines: Vec<usize> = about(rows - 1).chain([here]).collect();
    lines.sort_unstable();
    lines
}

/// The line in this row of the screen, in the pane `area`.
pub fn line_at(app: &App, area: Rect, row: u16) -> Option<usize> {
    let model = &app.model;
    let bar = u16::from(bar(model, app.theme, area).is_some());
    let rows = usize::from(area.height.saturating_sub(2 + bar));
    let log = model.log();
    let count = log.entries.len() + model.shown_inadmissible().len();
    let below = usize::from(row.checked_sub(area.y + 1 + bar)?);
    shown(&log, model, count, rows).get(below).copied()
}

/// An inadmissible part of the curve: it is not an event, so it has no number.
fn part(part: &Inadmissible, units: &UnitSystem, ascii: bool) -> String {
    let wave = part.report.crest_wave.map_or_else(String::new, |wave| format!(" ({wave})"));
    format!("! inadmissible {}{wave}", part.report.text(units, ascii))
}

/// The meaning of the marks, and whether all of it belongs to earlier values; and beside it the sums, which come first
/// where there is no room for both.
fn title(model: &Model, log: &Log, theme: Theme, width: usize) -> (String, String) {
    let is_old = model.preset.path.begin == Begin::Apart
        && model.cycle().is_some_and(|cycle| !cycle.is_of_preset(&model.preset));
    let old = if is_old { ", for the old values" } else { "" };
    let is_left = log.entries.iter().any(|entry| entry.mark == EventMark::PassedBy);
    let passed =
        if is_left { format!(" {} passed by", mark(theme, EventMark::PassedBy)) } else { String::new() };
    let marks = format!(
        "Log{old} {} done {} here {} ahead{passed}",
        mark(theme, EventMark::Done),
        mark(theme, EventMark::Here),
        mark(theme, EventMark::Ahead)
    );
    let beside = |head: String| {
        let room = width.saturating_sub(head.chars().count() + 4);
        let sums = theme.text(&sums(model, log, room));
        (head, sums)
    };
    let is_wide = marks.chars().count() + 30 < width;
    let with_marks = Some(marks).filter(|_| is_wide).map(beside);
    with_marks.filter(|(_, sums)| !sums.is_empty()).unwrap_or_else(|| beside(format!("Log{old}")))
}

fn mark(theme: Theme, mark: EventMark) -> &'static str {
    match mark {
        EventMark::Done => theme.glyph("✓", "x"),
        EventMark::Here => "@",
        EventMark::Ahead => theme.glyph("·", "."),
        EventMark::PassedBy => "-",
    }
}

/// The largest pull, the energy lost up to here, the loss over the whole path and what was passed by, as much of it as
/// fits; empty where nothing does.
fn sums(model: &Model, log: &Log, room: usize) -> String {
    let Some(path) = model.path() else { return String::new() };
    let units = &model.preset.units;
    let energy = |lost: f64, unbounded: bool| {
        let text = loss(units.shown(Quantity::Energy, lost).number);
        format!("{text}{}", if unbounded { "+" } else { "" })
    };
    let (so_far, unbounded) = log.lost();
    let totals = &path.totals;
    let all = totals.dissipated.unwrap_or(totals.dissipated_before_last_contact);
    let unit = units.unit(Quantity::Energy).map_or_else(String::new, |unit| format!(" {unit}"));
    // What is lost off the path is no part of its total.
    let of = if log.has_left_path() { ", on the path" } else { " of" };
    let of = format!("{}{of} {}{unit}", energy(so_far, unbounded), energy(all, totals.dissipated.is_none()));
    let passed = match log.passed_by() {
        (0.0, false) => String::new(),
        (lost, unbounded) => format!(", {} passed by", energy(lost, unbounded)),
    };
    let force = |force: f64| model.force_in_words(&model.preset, force, 4);
    let pull = path.totals.pull();
    let pull = pull.map_or_else(String::new, |at| format!("A {}  ", force(at.force)));
    // Beside a pull at a rate all of these are numbers of another path.
    let [slow, short] = if model.is_pulled() { ["quasi-static: ", "q-static "] } else { ["", ""] };
    let at_rate = model.pull_peak().map(|peak| format!("at the rate {}; ", force(peak))).unwrap_or_default();
    // What else would be lost is not known where a path stops before its end.
    let ends = if path.has_reached_its_end { "" } else { ", ends early" };
    // Where an edge is pinned, jumps are not all that a loop loses.
    let band = totals.dead_band.map(|band| format!(" + dead band {}", energy(band.dissipated, false)));
    let lost = if band.is_some() { "lost in jumps" } else { "lost" };
    let band = band.unwrap_or_default();
    let is_other = |node: &Node| matches!(node.kind, NodeKind::Jump(_)) && !model.is_of_present_values(node);
    let has_changed = model.history.path().iter().any(|(_, node)| is_other(node));
    let here = if has_changed { "at these values" } else { "up to here" };
    [
        format!("{at_rate}{slow}{pull}{lost} {here} {of}{band}{passed}{ends}"),
        format!("{at_rate}{slow}{pull}{lost} {here} {of}{band}{ends}"),
        format!("{slow}{pull}{lost} {here} {of}{band}{passed}{ends}"),
        format!("{slow}{pull}{lost} {here} {of}{band}{ends}"),
        format!("{short}{pull}{lost} {of}{band}{ends}"),
        format!("{slow}{lost} {here} {of}{band}{ends}"),
        format!("{short}{lost} {of}{band}{ends}"),
        format!("{short}{lost} {of}{band}"),
        format!("{short}lost {of}{band}"),
        format!("{short}{lost} {of}"),
    ]
    .into_iter()
    .find(|text| text.chars().count() <= room)
    .unwrap_or_default()
}

/// What to say of a path without events.
fn nothing(path: &PathReport) -> String {
    let what = if path.has_reached_its_end { "nothing happens" } else { "the path ends early" };
    format!(" {what}: {}", path.stop)
}

fn empty(model: &Model, keymap: &Keymap) -> String {
    let why = match (&model.curve, model.preset.path.begin, model.cycle()) {
        (None, ..) | (Some(_), Begin::Apart, None) => " computing the path".to_owned(),
        (Some(_), Begin::Apart, Some(cycle)) => match &cycle.report {
            Err(reason) => format!(" no path: {reason}"),
            Ok(report) => nothing(report),
        },
        (Some(curve), Begin::Disc, _) => match (&curve.unloading, &curve.report) {
            (Err(reason), _) => format!(" no path: {reason}"),
            (Ok(_), report) => report.as_ref().map_or_else(String::new, nothing),
        },
    };
    keymap.spelled(&why)
}

/// The course of the control, with its turn in the middle, and events and walker on it; `None` if the path does not
/// turn, or if there are few rows.
fn bar(model: &Model, theme: Theme, area: Rect) -> Option<Line<'static>> {
    let path = model.path().filter(|path| path.turn.is_some())?;
    let room = usize::from(area.width.checked_sub(4).filter(|_| area.height >= BAR_ROWS + 2)?);
    let (first, turn) = (path.events.first()?, path.events.iter().find(|event| event.kind == "turn")?);
    let last = path.events.last()?;
    let lowest = first.control.min(last.control);
    let span = turn.control - lowest;
    let half = 0.5 * room.saturating_sub(1) as f64;
    let place = |control: f64, down: bool| {
        let share = ((control - lowest) / span).clamp(0.0, 1.0);
        let at = if down { half * (2.0 - share) } else { half * share };
        // Between 0 and the width of the screen.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let at = at.round() as usize;
        at.min(room - 1)
    };
    let mut cells: Vec<char> = vec![if theme.ascii { '-' } else { '─' }; room];
    for event in &path.events {
        let digit = u32::try_from(event.number).ok().and_then(|number| char::from_digit(number, 10));
        cells[place(event.control, event.direction == "unloading")] = digit.unwrap_or('v');
    }
    if let Some(node) = model.walker() {
        let state = node.state.in_units(node.setting.units());
        let control = model.preset.path.control.value(state.approach, state.force);
        cells[place(control, model.inward)] = '@';
    }
    Some(Line::styled(format!(" {} ", cells.into_iter().collect::<String>()), theme.dim()))
}

/// A column: how soon it is left out, and whether its cells are left-aligned.
const COLUMNS: [(u8, bool); 10] = [
    // Mark and number.
    (0, true),
    // What happened.
    (3, true),
    // δ, and after it.
    (1, false),
    (4, false),
    // P, and after it.
    (0, false),
    (2, false),
    // s, and after it.
    (5, false),
    (6, false),
    // Crests.
    (0, true),
    // Loss.
    (0, true),
];

/// The lines of the entries, with as many columns as fit; the first line shown contains the column names, with their
/// units where all columns fit beside them.
fn table(model: &Model, theme: Theme, entries: &[LogEntry], named: usize, room: usize) -> Vec<String> {
    let Some(curve) = model.curve.as_deref() else { return Vec::new() };
    let scale = Scale::of(curve, model.axes);
    let [length, force, radius] = scale.state_axes();
    let control = model.control().unwrap_or(model.preset.path.control);
    let rows: Vec<[String; 10]> =
        entries.iter().map(|entry| cells(entry, scale, &model.preset.units, theme, control)).collect();
    let energy =
        model.preset.units.unit(Quantity::Energy).map_or_else(String::new, |unit| format!(" ({unit})"));
    // The charts say over what they are scaled: where there is no room for that, a column has only the letter.
    let names = |is_short: bool| {
        let name = |axis: &Axis| match (is_short, axis.shown.is_empty()) {
            (true, _) => axis.symbol.split('/').next().unwrap_or_default().to_owned(),
            (false, true) => axis.symbol.clone(),
            (false, false) => format!("{} ({})", axis.symbol, axis.shown),
        };
        let lost = if is_short { String::new() } else { format!("lost{energy}") };
        ["", "", &name(&length), "", &name(&force), "", &name(&radius), "", "", &lost].map(str::to_owned)
    };
    let width = |at: usize| rows.iter().map(|row| row[at].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..COLUMNS.len()).map(width).collect();
    let fit = |heads: &[String; 10]| {
        let full = |at: usize| match (widths[at], heads[at].chars().count()) {
            (0, _) => 0,
            (width, 0) => width + 1,
            (width, head) => width + head + 2,
        };
        let mut kept: Vec<usize> = (0..COLUMNS.len()).filter(|at| widths[*at] > 0).collect();
        let all = kept.len();
        while kept.iter().map(|at| full(*at)).sum::<usize>() > room + 1 {
            let worst = kept.iter().copied().max_by_key(|at| COLUMNS[*at].0);
            let Some(worst) = worst.filter(|at| COLUMNS[*at].0 > 0) else { break };
            kept.retain(|at| *at != worst);
        }
        (kept.len() == all, kept)
    };
    let [named_in_full, letters] = [false, true].map(names);
    let (is_whole, kept) = fit(&named_in_full);
    let (heads, kept) = if is_whole { (named_in_full, kept) } else { (letters.clone(), fit(&letters).1) };
    let text = |(i, row): (usize, &[String; 10])| {
        let cell = |at: &usize| {
            let (text, width) = (&row[*at], widths[*at]);
            let text = if COLUMNS[*at].1 { format!("{text:<width$}") } else { format!("{text:>width$}") };
            match heads[*at].chars().count() {
                0 => text,
                head if i == named => {
                    format!("{} {text}", heads[*at]).chars().take(head + 1 + width).collect()
                }
                head => format!("{:head$} {text}", ""),
            }
        };
        kept.iter().map(cell).collect::<Vec<_>>().join(" ").trim_end().to_owned()
    };
    rows.iter().enumerate().map(text).collect()
}

/// The cells of an entry, in the units of the charts.
fn cells(
    entry: &LogEntry,
    scale: Scale<'_>,
    units: &UnitSystem,
    theme: Theme,
    control: Control,
) -> [String; 10] {
    let event = &entry.event;
    let number = entry.number.map_or_else(String::new, |number| number.to_string());
    let arrow = theme.glyph("▸", ">");
    let changes = event.before != event.after;
    let ends = |shown: &dyn Fn(&StateReport) -> String| {
        let before = event.before.as_ref().or(event.after.as_ref()).map_or_else(String::new, shown);
        let after = event.after.as_ref().filter(|_| changes && event.before.is_some()).map(shown);
        (before, after.map_or_else(String::new, |after| format!("{arrow} {after}")))
    };
    let force = |at: &StateReport| {
        let force = scale.force(at.force);
        if scale.force.is_some() { fixed(force, 3) } else { significant(force, 4) }
    };
    let (delta, delta_after) = ends(&|at| significant(scale.length(at.approach), 4));
    let (load, load_after) = ends(&force);
    let (radius, radius_after) = ends(&|at| significant(scale.radius(at.contact_radius), 3));
    let crest = |state: &Option<StateReport>| state.as_ref().and_then(|at| at.wave);
    let crests = match (crest(&event.before), crest(&event.after)) {
        (Some(before), Some(after)) if changes => format!("{before}{arrow}{after}"),
        (Some(before), None) => format!("{before}{arrow}-"),
        _ => String::new(),
    };
    let lost = match event.dissipated {
        Some(0.0) => String::new(),
        Some(lost) => loss(units.shown(Quantity::Energy, lost).number),
        None => "no bound".to_owned(),
    };
    // Where the walker stands before an event, no mark says that it has happened already.
    let is_told = entry.times > u32::from(entry.mark == EventMark::Done);
    let times = if is_told { format!(" {}{}", theme.glyph("×", "x"), entry.times) } else { String::new() };
    let fault = if event.admissible == Some(false) { " !" } else { "" };
    // What is held does not change.
    let (delta_after, load_after) = match control {
        Control::Force => (delta_after, String::new()),
        Control::Displacement => (String::new(), load_after),
        Control::Stiffness(_) => (delta_after, load_after),
    };
    [
        format!("{}{number}", mark(theme, entry.mark)),
        event.kind.replace('-', " "),
        delta,
        delta_after,
        load,
        load_after,
        radius,
        radius_after,
        crests,
        format!("{lost}{times}{fault}{}", if disagrees(event) { " ?" } else { "" }),
    ]
}

/// Whether both computations of a loss are there and differ.
fn disagrees(event: &EventReport) -> bool {
    event.losses_agree() == Some(false)
}
