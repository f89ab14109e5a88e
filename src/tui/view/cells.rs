//! Problem where panes are stacked: lines of values in cells, then the groups that can be set, and the state in a line
//! below.

use super::here;
use super::parts::{is_selected, panel};
use super::problem::{CELL, ShownValue, shown, standing};
use crate::explorer::ScreenPanel;
use crate::tui::app::App;
use crate::tui::layout::VALUE_LINES;
use ratatui::Frame;
use ratatui::layout::{Margin, Position, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

/// Where a value stands: its line, and its cells in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ValueSeat {
    line: usize,
    first: usize,
    cells: usize,
}

/// The seats of values of these widths, in lines of `count` cells; none is broken across lines.
fn seats(values: &[ShownValue], count: usize) -> Vec<ValueSeat> {
    let (mut line, mut first) = (0, 0);
    let mut seats = Vec::new();
    for value in values {
        let cells = value.cells.clamp(1, count);
        if first > 0 && first + cells > count {
            (line, first) = (line + 1, 0);
        }
        seats.push(ValueSeat { line, first, cells });
        first += cells;
    }
    seats
}

/// The first line shown: the selected line is the last one shown, once there are lines above.
fn first_line(seats: &[ValueSeat], selected: usize) -> usize {
    let last = seats.last().map_or(0, |seat| seat.line);
    let lines = usize::from(VALUE_LINES);
    let at = seats.get(selected).map_or(0, |seat| seat.line);
    (at + 1).saturating_sub(lines).min((last + 1).saturating_sub(lines))
}

fn count(width: u16) -> usize {
    (usize::from(width) / CELL).max(1)
}

/// Draws the values and the state.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let (model, theme) = (&app.model, app.theme);
    let selected = is_selected(app, ScreenPanel::Problem);
    let inner = area.inner(Margin::new(1, 1));
    let values = shown(app);
    let can_turn = model.knobs().len();
    let seats = seats(&values, count(inner.width));
    let first = first_line(&seats, model.parameter);
    let lines = usize::from(VALUE_LINES);
    let last = seats.last().map_or(0, |seat| seat.line);
    let above = if first > 0 { theme.glyph("‹", "<") } else { "" };
    let below = if last >= first + lines { theme.glyph("›", ">") } else { "" };
    let more = format!("{above}{below}");
    let more = if more.is_empty() { more } else { format!(" {more}") };
    let title = format!("Problem {}/{can_turn}{more}", model.parameter + 1);
    let mut block = panel(theme, &title, selected);
    let fits = |text: &String| text.chars().count() + title.chars().count() + 6 <= usize::from(area.width);
    if let Some(standing) = standing(app).filter(fits) {
        block = block.title_top(Line::styled(theme.text(&standing), theme.dim()).right_aligned());
    }
    frame.render_widget(block, area);
    let mut rows: Vec<Vec<Span<'static>>> = vec![Vec::new(); lines];
    for (at, (value, seat)) in values.iter().zip(&seats).enumerate() {
        let Some(row) = seat.line.checked_sub(first).and_then(|line| rows.get_mut(line)) else { continue };
        let is_chosen = selected && at == model.parameter;
        row.extend(value.spans(theme, seat.cells, is_chosen));
    }
    let mut rows: Vec<Line<'static>> = rows.into_iter().map(Line::from).collect();
    rows.push(here::line(app, usize::from(inner.width)));
    frame.render_widget(Paragraph::new(rows), inner);
}

/// The value at this position of the screen, in the pane `area`.
pub fn value_at(app: &App, area: Rect, at: Position) -> Option<usize> {
    let inner = area.inner(Margin::new(1, 1));
    let seats = seats(&shown(app), count(inner.width));
    let line = first_line(&seats, app.model.parameter) + usize::from(at.y.checked_sub(inner.y)?);
    if at.y >= inner.y + VALUE_LINES {
        return None;
    }
    let cell = usize::from(at.x.checked_sub(inner.x)?) / CELL;
    let is_it = |seat: &ValueSeat| seat.line == line && (seat.first..seat.first + seat.cells).contains(&cell);
    seats.iter().position(is_it).filter(|at| *at < app.model.knobs().len())
}

/// The value above or below the selected one in a pane of this width.
pub fn value_beside(app: &App, width: u16, down: bool) -> usize {
    let seats = seats(&shown(app), count(width));
    let selected = app.model.parameter;
    let last = app.model.knobs().len().saturating_sub(1);
    let Some(here) = seats.get(selected).copied() else { return selected };
    let line = if down { Some(here.line + 1) } else { here.line.checked_sub(1) };
    let is_it = |seat: &ValueSeat| Some(seat.line) == line && seat.first <= here.first;
    let found = seats.iter().take(last + 1).rposition(is_it);
    let first_of_line = || seats.iter().take(last + 1).position(|seat| Some(seat.line) == line);
    found.or_else(first_of_line).unwrap_or(selected)
}
