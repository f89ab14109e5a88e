//! The parameters with their values, and the dimensionless groups that follow from them.

use super::{is_selected, pair, side_panel};
use crate::contact::{Control, Groups};
use crate::explorer::Panel;
use crate::preset::{Parameter, Value};
use crate::report::number::{short, with_unit};
use crate::tui::app::App;
use crate::tui::theme::Theme;
use crate::units::{Quantity, UnitSystem};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

/// Draws the parameters and the groups.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let (model, theme) = (&app.model, app.theme);
    let selected = is_selected(app, Panel::Problem);
    // The frame takes the top line and the left column.
    let inner = Rect {
        x: area.x + 1,
        y: area.y + 1,
        width: area.width.saturating_sub(1),
        height: area.height.saturating_sub(1),
    };
    let groups =
        group_lines(theme, &Groups::of(&model.preset.problem(), model.preset.range_of_action()), inner.width);
    let knobs = model.knobs();
    // The groups stand below as far as there is room for five parameters above them.
    let shown_groups = groups.len().min(usize::from(inner.height).saturating_sub(knobs.len().min(5)));
    let rows = usize::from(inner.height).saturating_sub(shown_groups);
    let title = if rows < knobs.len() {
        format!("Problem {}/{}", model.parameter + 1, knobs.len())
    } else {
        "Problem".to_owned()
    };
    frame.render_widget(side_panel(theme, &title, selected), area);
    // The list scrolls so that the selected line is seen.
    let first = (model.parameter + 1).saturating_sub(rows).min(knobs.len().saturating_sub(rows));
    let mut lines: Vec<Line> = knobs
        .iter()
        .enumerate()
        .skip(first)
        .take(rows)
        .map(|(i, (row, value))| {
            knob_line(
                theme,
                &model.preset.units,
                row,
                value.as_ref(),
                i == model.parameter && selected,
                inner.width,
            )
        })
        .collect();
    while lines.len() < rows {
        lines.push(Line::default());
    }
    lines.extend(groups.into_iter().take(shown_groups));
    frame.render_widget(Paragraph::new(lines), inner);
}

fn knob_line(
    theme: Theme,
    units: &UnitSystem,
    row: &Parameter,
    value: Option<&Value>,
    selected: bool,
    width: u16,
) -> Line<'static> {
    let shown = |quantity, x, digits| with_unit(units, quantity, x, theme.ascii, |x| short(x, digits));
    let text = match value {
        None => "auto".to_owned(),
        Some(Value::Number(x)) => shown(row.quantity, *x, 7),
        Some(Value::Control(Control::Stiffness(k))) => {
            format!("k {}", shown(Quantity::ForcePerLength, *k, 5))
        }
        Some(value) => theme.text(&value.to_string()),
    };
    let (mark, ends) = if selected { (">", " < >") } else { (" ", "") };
    let room = usize::from(width).saturating_sub(10 + ends.len());
    let text: String = text.chars().take(room).collect();
    let line = format!("{mark}{:<8} {text}{ends}", theme.symbols(&row.label));
    let style = if selected { theme.selection() } else { ratatui::style::Style::new() };
    Line::styled(format!("{line:<width$}", width = usize::from(width)), style)
}

fn group_lines(theme: Theme, groups: &Groups, width: u16) -> Vec<Line<'static>> {
    let mut items: Vec<(&str, f64)> = Vec::new();
    let mut add = |name, value: Option<f64>| items.extend(value.map(|value| (name, value)));
    add("A/λ ", groups.amplitude_over_wavelength);
    add("λ/R ", groups.wavelength_over_radius);
    add("λ²/AR ", groups.connectivity);
    add("γ' ", groups.adhesion);
    add("α ", groups.johnson);
    add("μ ", groups.tabor);
    let mut lines: Vec<Line> = Vec::new();
    let mut used = usize::MAX;
    for (name, value) in items {
        let spans: Vec<Span<'static>> = pair(theme, name, &format!("{}  ", short(value, 4))).to_vec();
        let length: usize = spans.iter().map(Span::width).sum();
        if used.saturating_add(length) > usize::from(width) + 2 {
            lines.push(Line::from(" "));
            used = 1;
        }
        used += length;
        if let Some(line) = lines.last_mut() {
            line.spans.extend(spans);
        }
    }
    lines
}
