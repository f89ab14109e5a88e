//! The table of the states walked: what was done, one line each.

use super::parts::panel;
use crate::explorer::node::{Node, NodeKind};
use crate::explorer::pins::changed;
use crate::explorer::reach::{walk_line, why_not};
use crate::explorer::walk_table::kind_name;
use crate::explorer::{Model, View};
use crate::tui::app::App;
use pulloff_engine::case::critical_force;
use pulloff_engine::gap::wave_index;
use pulloff_engine::report::number::{fixed, in_column, loss, with_unit};
use pulloff_engine::text::counted;
use pulloff_engine::units::Quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::Line;
use ratatui::widgets::Paragraph;
use std::sync::Arc;

/// Draws the states that led to the walker.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App, selected: bool) {
    let (model, theme) = (&app.model, app.theme);
    let path = model.history.path();
    let jumps = path.iter().filter(|(_, node)| matches!(node.kind, NodeKind::Jump(_))).count();
    let mut title = format!("walk: {}, jumps {jumps}", counted(path.len(), "state"));
    let said = "; Enter goes there";
    if selected && title.len() + said.len() + 2 <= usize::from(area.width) {
        title.push_str(said);
    }
    let block = panel(theme, &title, selected);
    let inner = block.inner(area);
    frame.render_widget(block, area);
    if let Some(why) = why_not(model, View::Walk) {
        let line = Line::styled(format!(" {}", theme.text(&app.keymap.spelled(&why))), theme.dim());
        frame.render_widget(line, inner);
        return;
    }
    let room = usize::from(inner.width);
    let rows = usize::from(inner.height.saturating_sub(1));
    let chosen = walk_line(model);
    let first = first(path.len(), chosen, rows);
    let critical = divisor(&path);
    let largest = largest(&path);
    let left_out = left_out(room);
    let head = format!(" {}", laid(&head(model, critical), left_out));
    // What was lost is cut where there is no room for it, which shows that there is something.
    let left_out = &left_out[..left_out.len().min(2)];
    let mut lines = vec![Line::styled(theme.whole_words(&theme.text(&head), room), theme.dim())];
    lines.extend(path.iter().enumerate().skip(first).take(rows).map(|(i, (_, node))| {
        let before = i.checked_sub(1).and_then(|before| path.get(before)).map(|(_, node)| *node);
        let here = if i + 1 == path.len() { " @" } else { "" };
        let mark = if i == chosen && selected { '>' } else { ' ' };
        let text = format!("{mark}{}{here}", laid(&row(node, before, critical, largest), left_out));
        let style = if i == chosen && selected { theme.selection() } else { Style::new() };
        Line::styled(theme.whole_words(&theme.text(&text), room), style)
    }));
    frame.render_widget(Paragraph::new(lines), inner);
}

/// The first line shown, chosen so that the selected one is in the middle as far as there are lines.
fn first(count: usize, chosen: usize, rows: usize) -> usize {
    chosen.saturating_sub(rows / 2).min(count.saturating_sub(rows))
}

/// The line in this row of the screen, in the chart `area`.
pub fn line_at(model: &Model, area: Rect, row: u16) -> Option<usize> {
    // The frame and the column heads take three lines.
    let rows = usize::from(area.height.saturating_sub(3));
    let count = model.history.path().len();
    let below = usize::from(row.checked_sub(area.y + 2)?);
    let line = first(count, walk_line(model), rows) + below;
    (below < rows && line < count).then_some(line)
}

/// The cells of a line: step, what was done, δ, P, s, crest, and what was lost and changed.
type WalkCells = [String; 7];

/// Their widths, the last one the least that it needs.
const WIDTHS: [usize; 7] = [5, 9, 10, 8, 10, 5, 9];

/// The columns for which there is no room: the crest is left out first, then s, then what was lost.
fn left_out(room: usize) -> &'static [usize] {
    const FIRST: [usize; 3] = [5, 4, 6];
    let width = |without: &[usize]| -> usize {
        (0..WIDTHS.len()).filter(|at| !without.contains(at)).map(|at| WIDTHS[at] + 1).sum()
    };
    let count = (0..FIRST.len()).find(|count| width(&FIRST[..*count]) <= room);
    &FIRST[..count.unwrap_or(FIRST.len())]
}

/// A line of these cells without those `left_out`.
fn laid(cells: &WalkCells, left_out: &[usize]) -> String {
    let cell = |at: usize| match at {
        1 => format!("{:<1$}", cells[at], WIDTHS[at]),
        6 => cells[at].clone(),
        _ => format!("{:>1$}", cells[at], WIDTHS[at]),
    };
    let shown: Vec<String> = (0..WIDTHS.len()).filter(|at| !left_out.contains(at)).map(cell).collect();
    shown.join(" ").trim_end().to_owned()
}

/// The column heads, with the units of the preset.
fn head(model: &Model, critical: Option<f64>) -> WalkCells {
    let units = &model.preset.units;
    let [length, force] = [Quantity::Length, Quantity::Force]
        .map(|quantity| units.unit(quantity).map_or_else(String::new, |unit| format!(" {unit}")));
    let force = if critical.is_some() { "P/Pc".to_owned() } else { format!("P{force}") };
    let [step, kind, crest, last] = ["step", "", "crest", "lost"].map(str::to_owned);
    [step, kind, format!("δ{length}"), force, format!("s{length}"), crest, last]
}

/// `P_c`, by which forces are divided if all states have the same.
fn divisor(path: &[(usize, &Node)]) -> Option<f64> {
    let mut of_each = path
        .chunk_by(|(_, a), (_, b)| Arc::ptr_eq(&a.setting, &b.setting))
        .map(|states| critical_force(&states[0].1.setting.preset));
    let first = of_each.next()??;
    of_each.all(|other| other == Some(first)).then_some(first)
}

/// The largest δ, P and s of the walk by their size, in its own units.
fn largest(path: &[(usize, &Node)]) -> [f64; 3] {
    path.iter().filter(|(_, node)| !node.is_apart()).fold([0.0; 3], |largest, (_, node)| {
        let state = node.seen();
        let of = [state.approach, state.force, state.contact_radius];
        std::array::from_fn(|i| f64::max(largest[i], of[i].abs()))
    })
}

/// The cells of a state; `before` is the previous state, forces are divided by `critical`, and the columns of δ, P and s
/// go up to `largest`.
fn row(node: &Node, before: Option<&Node>, critical: Option<f64>, largest: [f64; 3]) -> WalkCells {
    let setting = &node.setting;
    let state = node.seen();
    let units = &setting.preset.units;
    let cell = |quantity, x, digits, largest| {
        let [x, largest] = [x, largest].map(|x| units.shown(quantity, x).number);
        in_column(x, digits, largest)
    };
    let length = |x, largest| cell(Quantity::Length, x, 4, largest);
    let force = match critical {
        Some(critical) => fixed(state.force / critical, 3),
        None => cell(Quantity::Force, state.force, 3, largest[1]),
    };
    let (force, radius, crest) = if node.is_apart() {
        ("apart".to_owned(), "-".to_owned(), "-".to_owned())
    } else {
        let crest = wave_index(node.state.contact_radius, setting.reduced.gap.wavelength());
        (
            force,
            length(state.contact_radius, largest[2]),
            crest.map_or_else(|| "-".to_owned(), |m| m.to_string()),
        )
    };
    let mut said: Vec<String> = Vec::new();
    if let NodeKind::Jump(event) = &node.kind {
        let lost = event.dissipated.map(|lost| lost * setting.units().energy);
        let energy = |x| with_unit(units, Quantity::Energy, x, false, loss);
        said.push(lost.map_or_else(|| "no bound".to_owned(), energy));
    }
    said.extend(before.and_then(|before| changed(&setting.preset, &before.setting.preset)));
    if !node.is_apart() && !node.admissibility.holds {
        said.push("!".to_owned());
    }
    let (step, kind) = (node.step.to_string(), kind_name(&node.kind).to_owned());
    [step, kind, length(state.approach, largest[0]), force, radius, crest, said.join(", ")]
}
