//! The parameters with their values, and the dimensionless groups that follow from them.

use super::parts::{is_selected, pair, panel, symbol};
use crate::explorer::fit::FittedError;
use crate::explorer::fitting::is_free;
use crate::explorer::{Id, Model, ScreenPanel};
use crate::tui::app::App;
use crate::tui::keymap::Keymap;
use crate::tui::theme::Theme;
use pulloff_engine::gap::Gap;
use pulloff_engine::preset::schema::Fallback;
use pulloff_engine::preset::{Parameter, Row, Value, groups};
use pulloff_engine::problem::{Control, Groups};
use pulloff_engine::report::number::{short, with_unit};
use pulloff_engine::units::{Quantity, UnitSystem};
use ratatui::Frame;
use ratatui::layout::{Margin, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

/// Parameters that stay visible above the groups, unless a group is selected.
const ABOVE: usize = 5;

/// How the panel is filled.
struct Arranged {
    /// Inside the frame.
    inner: Rect,
    /// The number of parameters, without the groups after them.
    parameters: usize,
    /// The first one shown: the list scrolls so that the selected line is visible.
    first: usize,
    rows: usize,
    groups: Vec<Line<'static>>,
}

fn arrange(app: &App, area: Rect, all: &[(Row, Option<Value>)]) -> Arranged {
    let model = &app.model;
    let selected = is_selected(app, ScreenPanel::Problem);
    let inner = area.inner(Margin::new(1, 1));
    // The groups that can be set come after the parameters, among those that cannot.
    let parameters = all.iter().take_while(|(row, _)| groups::row(&row.key).is_none()).count();
    let chosen = all.get(model.parameter).filter(|_| selected).map(|(row, _)| row.key.clone());
    let in_groups = model.parameter >= parameters && selected;
    let mut groups = group_lines(app, &all[parameters..], chosen.as_deref(), inner.width);
    let height = usize::from(inner.height);
    // If there is too little room, both are shown in part, and the selected one in full.
    let above = if in_groups { 2 } else { ABOVE };
    groups.truncate(height.saturating_sub(parameters.min(above)));
    // Only if there is room for it whatever is selected.
    let onset = onset(app.theme, model).filter(|_| parameters.min(ABOVE) + groups.len() < height);
    groups.extend(onset);
    let rows = height - groups.len();
    // It stays as long as the selected line is in it, and then moves so far that one line of those before is seen: a
    // line at a time would send the whole list for every key.
    let first = match (app.first_value, model.parameter) {
        (_, at) if at >= parameters => app.first_value,
        (first, at) if at < first => (at + 2).saturating_sub(rows),
        (first, at) if at >= first + rows => at - usize::from(rows > 1),
        (first, _) => first,
    };
    let first = first.min(parameters.saturating_sub(rows));
    Arranged { inner, parameters, first, rows, groups }
}

/// Draws the parameters and the groups.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let (model, theme) = (&app.model, app.theme);
    let selected = is_selected(app, ScreenPanel::Problem);
    let all = model.knobs();
    let Arranged { inner, parameters, first, rows, groups } = arrange(app, area, &all);
    let title = if rows < parameters {
        // What is seen, not what is selected: a title that changed with every key would be sent with every key.
        format!("Problem {}-{} of {}", first + 1, first + rows, all.len())
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
            let fit = (is_free(&model.preset, &row.key), model.fitted_error(&row.key));
            knob_line(theme, units, (row, value.as_ref()), fit, turning, inner.width)
        })
        .collect();
    lines.resize(rows, Line::default());
    lines.extend(groups);
    frame.render_widget(Paragraph::new(lines), inner);
}

/// The number of rows that show everything in a panel of this width.
pub fn rows(app: &App, width: u16) -> usize {
    let all = app.model.knobs();
    let parameters = all.iter().take_while(|(row, _)| groups::row(&row.key).is_none()).count();
    let onset = usize::from(app.model.first_snap().is_some());
    parameters + group_lines(app, &all[parameters..], None, width).len() + onset
}

/// The first value shown in the panel `area`.
pub fn first_value(app: &App, area: Rect) -> usize {
    arrange(app, area, &app.model.knobs()).first
}

/// The parameter in this row of the screen, in the panel `area`.
pub fn line_at(app: &App, area: Rect, row: u16) -> Option<usize> {
    let Arranged { inner, parameters, first, rows, .. } = arrange(app, area, &app.model.knobs());
    let below = usize::from(row.checked_sub(inner.y)?);
    let line = first + below;
    (below < rows && line < parameters).then_some(line)
}

/// The columns of a cell; a long word or an error takes two cells.
pub(super) const CELL: usize = 13;

/// A value as cells show it.
pub(super) struct ShownValue {
    label: String,
    text: String,
    /// How many cells it takes.
    pub(super) cells: usize,
}

impl ShownValue {
    /// A value of this many characters; `text` writes it for the room there is.
    fn new(label: String, width: usize, text: impl FnOnce(usize) -> String) -> Self {
        // The mark before the label, and a space after it.
        let taken = label.chars().count() + 2;
        let cells = (taken + width).div_ceil(CELL).max(1);
        Self { text: text(cells * CELL - taken), label, cells }
    }

    fn word(label: String, text: String) -> Self {
        Self::new(label, text.chars().count(), |_| text)
    }

    /// Its spans, if there is room for this many cells.
    pub(super) fn spans(&self, theme: Theme, cells: usize, is_chosen: bool) -> Vec<Span<'static>> {
        let room = (cells * CELL).saturating_sub(2 + self.label.chars().count());
        let text = theme.whole_words(&self.text, room);
        let rest = " ".repeat(room.saturating_sub(text.chars().count()));
        if is_chosen {
            let cell = format!(">{} {text}", self.label);
            return vec![Span::styled(cell, theme.selection()), Span::raw(rest)];
        }
        vec![Span::styled(format!(" {} ", self.label), theme.dim()), Span::raw(text + &rest)]
    }
}

/// The values, the groups that can be set, then those that cannot, in the form shown in cells.
pub(super) fn shown(app: &App) -> Vec<ShownValue> {
    /// A number keeps its cells while it is turned: room for this many characters, whatever its present length.
    const NUMBER: usize = 5;
    let (model, theme) = (&app.model, app.theme);
    let units = &model.preset.units;
    let values = model.knobs().into_iter().map(|(row, value)| {
        let label = theme.symbols(&row.label);
        let label = if is_free(&model.preset, &row.key) { format!("{label}?") } else { label };
        let error = model.fitted_error(&row.key);
        let number = |label, x| {
            let texts = numbers(theme, units, &row, x, error);
            let length = |text: Option<&String>| text.map_or(0, |text| text.chars().count());
            let unit = row.unit_in(units).map_or(0, |unit| unit.ascii().chars().count() + 1);
            // An error has both of its digits, and a space before the next cell.
            let width = match error {
                Some(_) => length(texts.first()) + 1,
                None => length(texts.last()).max(NUMBER + unit),
            };
            ShownValue::new(label, width, |room| fitting(&texts, room))
        };
        match value {
            None => ShownValue::word(label, unset(&row).to_owned()),
            Some(Value::Number(x)) => number(label, x),
            // Its stiffness has a cell of its own.
            Some(Value::Control(Control::Stiffness(_))) => ShownValue::word(label, "stiffness".to_owned()),
            Some(value) => ShownValue::word(label, theme.text(&value.to_string())),
        }
    });
    let of = Groups::of(&model.preset.problem(), model.preset.range_of_action(), model.preset.cohesion());
    let others = [("λ²/AR", of.connectivity), ("α", of.johnson), ("μ", of.tabor)];
    let others = others
        .into_iter()
        .filter_map(|(name, value)| Some(ShownValue::word(theme.text(name), short(value?, 4))));
    values.chain(others).collect()
}

/// The amplitude from which the problem snaps, or what is found of its gap, in a few words.
pub(super) fn standing(app: &App) -> Option<String> {
    let lines = [onset(app.theme, &app.model), found(app.theme, &app.model)];
    lines.into_iter().flatten().next().map(|line| line.to_string().trim().to_owned())
}

/// The keys that turn the selected value, shown after it if they are as short as the usual ones.
fn turning(keymap: &Keymap) -> String {
    let keys = [Id::Less, Id::More].map(|id| keymap.first(id));
    let is_short = keys.iter().all(|key| key.chars().count() == 1);
    if is_short { format!(" {}", keys.join(" ")) } else { String::new() }
}

/// The ways to write a number with its unit and its error, the longest first. Its digits end where those of the error
/// do; with one digit, the error is rounded up. A fitted number whose error is not known says so.
fn numbers(
    theme: Theme,
    units: &UnitSystem,
    row: &Parameter,
    x: f64,
    error: Option<FittedError>,
) -> Vec<String> {
    let shown = row.shown(units, x);
    let text = |digits| shown.text(&short(shown.number, digits), theme.ascii);
    let Some(error) = error else { return (3..=7).rev().map(text).collect() };
    let place = |x: f64| x.abs().log10().floor();
    let FittedError::Holds(error) = error else {
        return [4, 3].map(|digits| theme.text(&format!("{} ±?", text(digits)))).to_vec();
    };
    let error = row.shown(units, error).number.abs();
    let unit = 10.0_f64.powf(place(error));
    // An error that has only one digit stays as it is.
    let rounded_up = unit * (error / unit - 1e-6).ceil();
    let with = |(error, least): (f64, usize)| {
        let ends = |digits: &usize| place(shown.number) - *digits as f64 <= place(error) - least as f64;
        let digits = (least..9).find(ends).unwrap_or(9);
        theme.text(&format!("{} ±{}", text(digits), short(error, least)))
    };
    [(error, 2), (rounded_up, 1)].map(with).to_vec()
}

/// The first of these texts, the longest first, for which there is room; otherwise the last.
fn fitting(texts: &[String], room: usize) -> String {
    let fits = texts.iter().find(|text| text.chars().count() <= room);
    fits.or(texts.last()).cloned().unwrap_or_default()
}

fn knob_line(
    theme: Theme,
    units: &UnitSystem,
    (row, value): (&Parameter, Option<&Value>),
    (is_free, error): (bool, Option<FittedError>),
    turning: Option<&str>,
    width: u16,
) -> Line<'static> {
    let (mark, ends) = turning.map_or((" ", ""), |keys| (">", keys));
    // A standard error matters more than the signs that the value can be turned.
    let ends = if error.is_some() { "" } else { ends };
    let name = theme.symbols(&row.label);
    let name = if is_free { format!("{name}?") } else { name };
    // Beside an error, what a value needs is taken from the space after its name.
    let least = if error.is_some() { name.chars().count() } else { 9 };
    let room = usize::from(width).saturating_sub(2 + least + ends.chars().count());
    let text = match value {
        None => unset(row).to_owned(),
        Some(Value::Number(x)) => fitting(&numbers(theme, units, row, *x, error), room),
        // It has a line of its own.
        Some(Value::Control(Control::Stiffness(_))) => "stiffness".to_owned(),
        Some(value) => theme.text(&value.to_string()),
    };
    // A word matters more than the sign that it can be turned.
    let (ends, room) =
        if text.chars().count() > room { ("", room + ends.chars().count()) } else { (ends, room) };
    let text = match text.chars().count() {
        count if count > room => {
            let end = if theme.ascii { '.' } else { '\u{2026}' };
            text.chars().take(room.saturating_sub(1)).chain([end]).collect()
        }
        _ => text,
    };
    let padded = usize::from(width).saturating_sub(2 + text.chars().count()).clamp(least, 9);
    let label = format!("{mark}{name:<padded$} ");
    let style = if turning.is_some() { theme.selection() } else { ratatui::style::Style::new() };
    Line::styled(format!("{label}{text}{ends}"), style)
}

/// What stands for a value that is not given: what it is then, in a word.
fn unset(row: &Parameter) -> &'static str {
    match row.fallback {
        Fallback::Described(words) if words.starts_with("none") => "none",
        Fallback::Described("0") => "0",
        _ => "auto",
    }
}

/// The groups, as many per line as fit; the one with the key `chosen` is selected.
fn group_lines(
    app: &App,
    settable: &[(Row, Option<Value>)],
    chosen: Option<&str>,
    width: u16,
) -> Vec<Line<'static>> {
    let (model, theme) = (&app.model, app.theme);
    let of = Groups::of(&model.preset.problem(), model.preset.range_of_action(), model.preset.cohesion());
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
    let found = found(theme, model);
    let mut lines: Vec<Line> = Vec::new();
    let mut used = usize::MAX;
    for (name, value, is_chosen) in items {
        let spans = if is_chosen {
            // As wide as the others; otherwise the lines would break elsewhere and the list above would scroll.
            vec![Span::styled(format!(">{name} {}", short(value, 4)), theme.selection()), Span::raw(" ")]
        } else {
            let [name, value] = pair(theme, &format!(" {name} "), &format!("{} ", short(value, 4)));
            vec![name, value]
        };
        let length: usize = spans.iter().map(Span::width).sum();
        // The space after the last one may be cut.
        if used.saturating_add(length) > usize::from(width) + 1 {
            lines.push(Line::default());
            used = 0;
        }
        used += length;
        if let Some(line) = lines.last_mut() {
            line.spans.extend(spans);
        }
    }
    lines.extend(found);
    lines
}

/// The amplitude from which the problem snaps, under its control.
fn onset(theme: Theme, model: &Model) -> Option<Line<'static>> {
    let text = format!("{} ({})", short(model.first_snap()?, 3), symbol(model.preset.path.control));
    Some(Line::from(pair(theme, " first snap A/λ ", &text).to_vec()))
}

/// What is found of the gap, not given: R of the paraboloid nearest to the rows of a profile, by which `P_c` and the axes
/// are divided, and the wave by which mesh and steps are measured.
fn found(theme: Theme, model: &Model) -> Option<Line<'static>> {
    let gap = &model.preset.gap;
    let is_given =
        ["gap.radius_of_curvature", "gap.parameters.R"].iter().any(|key| model.preset.get(key).is_some());
    let radius = gap.radius_of_curvature().filter(|_| !is_given);
    let wave = gap.feature_length().filter(|_| gap.wavelength().is_none());
    let shown = |name, length: Option<f64>| {
        let text = with_unit(&model.preset.units, Quantity::Length, length?, theme.ascii, |x| short(x, 4));
        Some(pair(theme, name, &text))
    };
    let pairs = [shown(" R of the nearest paraboloid ", radius), shown(" shortest wave ", wave)];
    let spans: Vec<Span<'static>> = pairs.into_iter().flatten().flatten().collect();
    (!spans.is_empty()).then(|| Line::from(spans))
}
