//! The parameters with their values, and the dimensionless groups that follow from them.

use super::parts::{is_selected, pair, panel};
use crate::explorer::fitting::is_free;
use crate::explorer::{Id, Model, Panel};
use crate::tui::app::App;
use crate::tui::keymap::Keymap;
use crate::tui::theme::Theme;
use pulloff_engine::gap::Gap;
use pulloff_engine::preset::{Parameter, Row, Value, groups};
use pulloff_engine::problem::{Control, Groups};
use pulloff_engine::report::number::{short, with_unit};
use pulloff_engine::units::{Quantity, UnitSystem};
use ratatui::Frame;
use ratatui::layout::{Margin, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

/// Parameters that are seen above the groups, unless one of these is selected.
const ABOVE: usize = 5;

/// How the panel is filled.
struct Arranged {
    /// Inside the frame.
    inner: Rect,
    /// How many parameters there are, the groups behind them not counted.
    parameters: usize,
    /// The first one shown: the list scrolls so that the selected line is seen.
    first: usize,
    rows: usize,
    groups: Vec<Line<'static>>,
}

fn arrange(app: &App, area: Rect, all: &[(Row, Option<Value>)]) -> Arranged {
    let model = &app.model;
    let selected = is_selected(app, Panel::Problem);
    let inner = area.inner(Margin::new(1, 1));
    // The groups that can be set stand behind the parameters, among those that cannot.
    let parameters = all.iter().take_while(|(row, _)| groups::row(&row.key).is_none()).count();
    let chosen = all.get(model.parameter).filter(|_| selected).map(|(row, _)| row.key.clone());
    let in_groups = model.parameter >= parameters && selected;
    let mut groups = group_lines(app, &all[parameters..], chosen.as_deref(), inner.width);
    let height = usize::from(inner.height);
    // Both are seen in part where they have no room; what is selected, whole.
    let above = if in_groups { 2 } else { ABOVE };
    groups.truncate(height.saturating_sub(parameters.min(above)));
    // Where there is room for it whatever is selected.
    let onset = onset(app.theme, model).filter(|_| parameters.min(ABOVE) + groups.len() < height);
    groups.extend(onset);
    let rows = height - groups.len();
    // By half a window at a time: a line at a time would send the whole list for every key.
    let half = (rows / 2).max(1);
    let first = (model.parameter + 1).saturating_sub(rows).div_ceil(half) * half;
    let first = first.min(parameters.saturating_sub(rows));
    Arranged { inner, parameters, first, rows, groups }
}

/// Draws the parameters and the groups.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let (model, theme) = (&app.model, app.theme);
    let selected = is_selected(app, Panel::Problem);
    let all = model.knobs();
    let Arranged { inner, parameters, first, rows, groups } = arrange(app, area, &all);
    let title = if rows < parameters {
        format!("Problem {}/{}", model.parameter + 1, all.len())
    } else {
        "Problem".to_owned()
    };
    frame.render_widget(panel(theme, &title, selected), area);
    let units = &model.preset.units;
    let keys = turning(&app.keymap);
    let shown = all[..parameters].iter().enumerate().skip(first).take(rows);
    let mut lines: Vec<Line> = shown
        .map(|(i, (row, value))| {
            let turning = (i == model.parameter && selected).then_some(&*keys);
            let fit = (is_free(&model.preset, &row.key), model.standard_error(&row.key));
            knob_line(theme, units, (row, value.as_ref()), fit, turning, inner.width)
        })
        .collect();
    lines.resize(rows, Line::default());
    lines.extend(groups);
    frame.render_widget(Paragraph::new(lines), inner);
}

/// The rows that show everything in a panel so wide.
pub fn rows(app: &App, width: u16) -> usize {
    let all = app.model.knobs();
    let parameters = all.iter().take_while(|(row, _)| groups::row(&row.key).is_none()).count();
    let onset = usize::from(app.model.snaps_from().is_some());
    parameters + group_lines(app, &all[parameters..], None, width).len() + onset
}

/// The parameter in this row of the screen, in the panel `area`.
pub fn line_at(app: &App, area: Rect, row: u16) -> Option<usize> {
    let Arranged { inner, parameters, first, rows, .. } = arrange(app, area, &app.model.knobs());
    let below = usize::from(row.checked_sub(inner.y)?);
    let line = first + below;
    (below < rows && line < parameters).then_some(line)
}

/// The keys that turn the selected value, behind it, where they are as short as the usual ones.
fn turning(keymap: &Keymap) -> String {
    let keys = [Id::Less, Id::More].map(|id| keymap.first(id));
    let is_short = keys.iter().all(|key| key.chars().count() == 1);
    if is_short { format!(" {}", keys.join(" ")) } else { String::new() }
}

/// The ways to write a standard error behind its value, the longest first; nothing without one. With one digit it is rounded up.
fn errors(theme: Theme, error: Option<f64>) -> Vec<String> {
    let Some(error) = error else { return vec![String::new()] };
    let up = |error: f64| {
        let place = 10.0_f64.powf(error.log10().floor());
        // What is one digit already stays what it is.
        place * (error / place - 1e-6).ceil()
    };
    [short(error, 2), short(up(error), 1)].map(|text| theme.text(&format!(" ±{text}"))).to_vec()
}

fn knob_line(
    theme: Theme,
    units: &UnitSystem,
    (row, value): (&Parameter, Option<&Value>),
    (is_free, error): (bool, Option<f64>),
    turning: Option<&str>,
    width: u16,
) -> Line<'static> {
    let (mark, ends) = turning.map_or((" ", ""), |keys| (">", keys));
    // A standard error is worth more than the signs that the value can be turned.
    let ends = if error.is_some() { "" } else { ends };
    let error = error.map(|error| row.shown(units, error).number.abs());
    let name = theme.symbols(&row.label);
    let label = format!("{mark}{:<9} ", if is_free { format!("{name}?") } else { name });
    let room = usize::from(width).saturating_sub(label.chars().count() + ends.chars().count());
    // As many digits as there is room for, so that neither a unit nor an error is cut.
    let shown = |x, most: usize, errors: &[String]| {
        let shown = row.shown(units, x);
        let text = |digits| shown.text(&short(shown.number, digits), theme.ascii);
        let with = |error: &String| {
            let texts = (3..=most).rev().map(|digits| text(digits) + error);
            texts.into_iter().find(|text| text.chars().count() <= room)
        };
        errors.iter().find_map(with).unwrap_or_else(|| text(3))
    };
    let text = match value {
        None => "auto".to_owned(),
        Some(Value::Number(x)) => shown(*x, 7, &errors(theme, error)),
        Some(Value::Control(Control::Stiffness(k))) => {
            format!("k {}", shown(*k, 5, &errors(theme, None)))
        }
        Some(value) => theme.text(&value.to_string()),
    };
    // A word is worth more than the sign that it can be turned.
    let (ends, room) =
        if text.chars().count() > room { ("", room + ends.chars().count()) } else { (ends, room) };
    let text: String = text.chars().take(room).collect();
    let line = format!("{label}{text}{ends}");
    let style = if turning.is_some() { theme.selection() } else { ratatui::style::Style::new() };
    Line::styled(format!("{line:<width$}", width = usize::from(width)), style)
}

/// The groups, as many on a line as fit; the one with the key `chosen` is selected.
fn group_lines(
    app: &App,
    settable: &[(Row, Option<Value>)],
    chosen: Option<&str>,
    width: u16,
) -> Vec<Line<'static>> {
    let (model, theme) = (&app.model, app.theme);
    let of = Groups::of(&model.preset.problem(), model.preset.range_of_action());
    let mut items: Vec<(String, f64, bool)> = settable
        .iter()
        .filter_map(|(row, value)| match value {
            Some(Value::Number(x)) => Some((theme.symbols(&row.label), *x, chosen == Some(&row.key))),
            _ => None,
        })
        .collect();
    for (name, value) in [("λ²/AR", of.connectivity), ("α", of.johnson), ("μ", of.tabor)] {
        items.extend(value.map(|value| (theme.text(name), value, false)));
    }
    let shortest = shortest_wave(theme, model);
    let mut lines: Vec<Line> = Vec::new();
    let mut used = usize::MAX;
    for (name, value, is_chosen) in items {
        let spans = if is_chosen {
            // As wide as the others: else the lines would break elsewhere, and the list above scroll.
            vec![Span::styled(format!(">{name} {}", short(value, 4)), theme.selection()), Span::raw(" ")]
        } else {
            let [name, value] = pair(theme, &format!(" {name} "), &format!("{} ", short(value, 4)));
            vec![name, value]
        };
        let length: usize = spans.iter().map(Span::width).sum();
        // The blank behind the last one may be cut.
        if used.saturating_add(length) > usize::from(width) + 1 {
            lines.push(Line::default());
            used = 0;
        }
        used += length;
        if let Some(line) = lines.last_mut() {
            line.spans.extend(spans);
        }
    }
    lines.extend(shortest);
    lines
}

/// From which amplitude on the problem snaps, under its control.
fn onset(theme: Theme, model: &Model) -> Option<Line<'static>> {
    let control = match model.preset.path.control {
        Control::Displacement => "δ",
        Control::Force => "P",
        Control::Stiffness(_) => "k",
    };
    let text = format!("{} ({control})", short(model.snaps_from()?, 4));
    Some(Line::from(pair(theme, " snaps from A/λ ", &text).to_vec()))
}

/// By what mesh and steps are measured, where that is no λ among the parameters: the waves of a formula or of measured
/// rows are found, not given.
fn shortest_wave(theme: Theme, model: &Model) -> Option<Line<'static>> {
    let gap = &model.preset.gap;
    let length = gap.feature_length().filter(|_| gap.wavelength().is_none())?;
    let text = with_unit(&model.preset.units, Quantity::Length, length, theme.ascii, |x| short(x, 4));
    Some(Line::from(pair(theme, " shortest wave ", &text).to_vec()))
}
