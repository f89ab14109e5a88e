//! Prompts, choices and questions.

use super::charts;
use super::parts::panel;
use crate::explorer::script::parse;
use crate::explorer::{View, Window};
use crate::tui::app::App;
use crate::tui::overlay::{Choose, Dialog, Prompt, Purpose};
use crate::tui::theme::Theme;
use pulloff_engine::text::sanitize;
use ratatui::Frame;
use ratatui::layout::{Margin, Position, Rect};
use ratatui::text::Line;
use ratatui::widgets::{Block, Clear, Paragraph, Wrap};

/// The widest prompt or list.
const WIDEST: u16 = 160;
/// The width of a list beside a picture,
const LIST: u16 = 46;
/// the least width of the picture,
const NARROWEST: u16 = 20;
/// and the height of both, if there is room.
const PICTURE: u16 = 16;

/// Draws what lies over the screen, except the help.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App, overlay: &Dialog) {
    match overlay {
        Dialog::Prompt(prompt) => draw_prompt(frame, area, app, prompt),
        Dialog::Choose(choose) => draw_choose(frame, area, app.theme, choose),
        Dialog::Confirm(confirm) => draw_question(frame, area, app.theme, "Sure?", &confirm.question),
        Dialog::Offer(offer) => draw_question(frame, area, app.theme, "Go on?", &offer.question),
        Dialog::Help(_) => {}
    }
}

/// Draws a box over what is there; returns its interior.
fn over(frame: &mut Frame<'_>, area: Rect, block: &Block<'_>) -> Rect {
    frame.render_widget(Clear, area);
    frame.render_widget(block, area);
    block.inner(area)
}

/// A box of this size in the middle, as far as it fits.
fn middle(area: Rect, width: u16, height: u16) -> Rect {
    let width = width.min(area.width.saturating_sub(2));
    let height = height.min(area.height.saturating_sub(2));
    Rect { x: area.x + (area.width - width) / 2, y: area.y + (area.height - height) / 2, width, height }
}

/// The same at the lower end, above the status, so that values and curve stay visible.
fn lower(area: Rect, width: u16, height: u16) -> Rect {
    let middle = middle(area, width, height);
    Rect { y: area.bottom().saturating_sub(middle.height + 2).max(area.y), ..middle }
}

/// Where a prompt goes, and how many rows its list gets.
fn place_of_prompt(prompt: &Prompt, area: Rect) -> (Rect, u16) {
    // The list always has its full height, whatever is typed, so that what it leaves visible does not change.
    let is_line = matches!(prompt.purpose, Purpose::Line { .. });
    let rows = if is_line { area.height * 2 / 5 } else { 0 };
    let place = if is_line || matches!(prompt.purpose, Purpose::Formula(_)) { lower } else { middle };
    // A long reason takes as many lines as it needs at this width.
    let wide = usize::from(area.width.saturating_sub(4).clamp(1, WIDEST - 2));
    let lines = |text: &str| textwrap::wrap(text, wide).len();
    let error = prompt.error.as_ref().map_or(0, |error| lines(error) + 1);
    let said = lines(prompt.said()).max(if is_line { 2 } else { 1 });
    let more = u16::try_from(error + said).unwrap_or(u16::MAX);
    (place(area, WIDEST, more.saturating_add(4 + rows)), rows)
}

/// The entry of a prompt at this position of the screen.
pub fn entry_at(prompt: &Prompt, area: Rect, at: Position) -> Option<usize> {
    let (area, rows) = place_of_prompt(prompt, area);
    let inner = area.inner(Margin::new(1, 1));
    let row = at.y.checked_sub(inner.y + 2).filter(|row| *row < rows && inner.contains(at))?;
    let line = first(prompt.selected.unwrap_or(0), usize::from(rows)) + usize::from(row);
    (line < prompt.entries.len()).then_some(line)
}

/// A line of a list, marked if it is selected.
fn line_of(theme: Theme, text: &str, is_selected: bool, width: usize) -> Line<'static> {
    let mark = if is_selected { '>' } else { ' ' };
    let text = theme.whole_words(&format!("{mark} {text}"), width);
    if is_selected { Line::styled(text, theme.selection()) } else { Line::raw(text) }
}

/// The entries of a line, in this many rows.
fn entries(app: &App, prompt: &Prompt, rows: usize, width: usize) -> Vec<Line<'static>> {
    /// The columns of the keys, and at most those of the lines.
    const KEYS: usize = 11;
    const LINES: usize = 28;
    let theme = app.theme;
    let shown = prompt.entries.iter().enumerate().skip(first(prompt.selected.unwrap_or(0), rows)).take(rows);
    // Short lines leave more room for what they do.
    let longest = prompt.entries.iter().map(|entry| entry.line.chars().count()).max().unwrap_or(0).min(LINES);
    let mut lines: Vec<Line<'static>> = shown
        .map(|(at, entry)| {
            let keys = entry.id.map_or_else(String::new, |id| app.keymap.keys_of(id));
            let says = theme.text(&theme.symbols(&app.keymap.spelled(&entry.says)));
            let is_selected = prompt.selected == Some(at);
            let text = format!("{keys:<KEYS$} {:<longest$} {says}", entry.line);
            let line = line_of(theme, &text, is_selected, width);
            if !is_selected && entry.says.starts_with("- ") { line.style(theme.dim()) } else { line }
        })
        .collect();
    if lines.is_empty() && rows > 0 {
        // A line that can be run needs no list; below one that was refused stands why.
        let said = match parse(prompt.input.value()) {
            _ if prompt.error.is_some() => "",
            Ok(_) => "Enter runs it",
            Err(_) => "nothing matches",
        };
        lines.push(Line::styled(format!("  {said}"), theme.dim()));
    }
    lines.resize(rows, Line::default());
    lines
}

fn draw_prompt(frame: &mut Frame<'_>, area: Rect, app: &App, prompt: &Prompt) {
    let theme = app.theme;
    let (area, rows) = place_of_prompt(prompt, area);
    let mut block = panel(theme, &prompt.title, true);
    if rows > 0 {
        let at = prompt.selected.map_or_else(String::new, |at| format!("{} of ", at + 1));
        block = block.title_bottom(Line::from(format!("{at}{}", prompt.entries.len())).right_aligned());
    }
    let inner = over(frame, area, &block);
    let width = usize::from(inner.width.saturating_sub(3)).max(1);
    let scroll = prompt.input.visual_scroll(width);
    let shown: String = prompt.input.value().chars().skip(scroll).take(width).collect();
    // Below the error, if that is visible.
    let fault = prompt
        .fault
        .and_then(|column| (column + 1).checked_sub(scroll))
        .filter(|at| (2..=width + 2).contains(at));
    let caret = fault
        .map_or_else(Line::default, |at| Line::styled(format!("{:>w$}", "^", w = at + 1), theme.error()));
    let mut lines = vec![Line::raw(format!("> {}", theme.text(&shown))), caret];
    lines.extend(entries(app, prompt, usize::from(rows), usize::from(inner.width)));
    if let Some(error) = &prompt.error {
        lines.push(Line::styled(theme.text(error), theme.error()));
    }
    lines.push(Line::styled(theme.text(&theme.symbols(&app.keymap.spelled(prompt.said()))), theme.dim()));
    frame.render_widget(Paragraph::new(lines).wrap(Wrap { trim: false }), inner);
    let column = prompt.input.visual_cursor().saturating_sub(scroll).min(width);
    let column = u16::try_from(column).unwrap_or(0);
    if inner.height > 0 && inner.width > 2 {
        frame.set_cursor_position(Position::new(inner.x + 2 + column, inner.y));
    }
}

/// The title of a list and its keys; what was typed comes first, since a narrow screen cuts the end.
fn heading_of(choose: &Choose) -> String {
    let can_delete = choose.current().is_some_and(|(_, item)| item.delete.is_some());
    let delete = if can_delete { ", D deletes" } else { "" };
    let keys = format!("Enter accepts{delete}, Esc goes back");
    match &*choose.filter {
        "" => format!("{}: {keys}, letters filter", choose.title),
        filter => format!("{} (filter \"{}\"): {keys}", choose.title, sanitize(filter, 20)),
    }
}

fn place_of(choose: &Choose, area: Rect) -> Rect {
    let height = u16::try_from(choose.items.len() + 2 + usize::from(choose.has_notes())).unwrap_or(u16::MAX);
    // As wide as its longest line and its title, if the screen allows.
    let longest = choose.items.iter().map(|item| item.text.chars().count() + 4);
    let longest = longest.max().unwrap_or(0).max(heading_of(choose).chars().count() + 2);
    let longest = u16::try_from(longest).unwrap_or(WIDEST).clamp(76, WIDEST);
    let (width, height) =
        if choose.picture.is_some() { (110, height.max(PICTURE)) } else { (longest, height) };
    middle(area, width, height)
}

/// The first line of a list shown in this many rows.
fn first(selected: usize, rows: usize) -> usize {
    (selected + 1).saturating_sub(rows)
}

/// The line of a list at this position of the screen.
pub fn line_at(choose: &Choose, area: Rect, at: Position) -> Option<usize> {
    let mut inner = place_of(choose, area).inner(Margin::new(1, 1));
    inner.height = inner.height.saturating_sub(u16::from(choose.has_notes()));
    let line = first(choose.selected, usize::from(inner.height)) + usize::from(at.y.checked_sub(inner.y)?);
    (inner.contains(at) && line < choose.shown().len()).then_some(line)
}

fn draw_choose(frame: &mut Frame<'_>, area: Rect, theme: Theme, choose: &Choose) {
    let area = place_of(choose, area);
    let block = panel(
        theme,
        &theme.whole_words(&heading_of(choose), usize::from(area.width.saturating_sub(2))),
        true,
    );
    let mut inner = over(frame, area, &block);
    if let Some(figure) = &choose.picture
        && inner.width >= LIST + NARROWEST
    {
        let beside = Rect { x: inner.x + LIST, width: inner.width - LIST, ..inner };
        charts::chart(figure, View::Gap, &Window::WHOLE, theme).draw(frame, beside, false);
        inner.width = LIST;
    }
    if choose.has_notes() && inner.height > 1 {
        let note = choose.current().map_or("", |(_, item)| &*item.note);
        let below = Rect { y: inner.bottom() - 1, height: 1, ..inner };
        let text = theme.whole_words(&theme.text(&format!("  {note}")), usize::from(inner.width));
        frame.render_widget(Line::styled(text, theme.dim()), below);
        inner.height -= 1;
    }
    let rows = usize::from(inner.height);
    let first = first(choose.selected, rows);
    let shown = choose.shown();
    let mut lines: Vec<Line> = shown
        .iter()
        .enumerate()
        .skip(first)
        .take(rows)
        .map(|(i, (_, item))| {
            line_of(theme, &theme.text(&item.text), i == choose.selected, usize::from(inner.width))
        })
        .collect();
    if shown.is_empty() {
        let typed = sanitize(&choose.filter, 20);
        let said = format!("  no line matches \"{typed}\"; Backspace deletes a letter");
        lines.push(Line::styled(theme.text(&said), theme.dim()));
    }
    frame.render_widget(Paragraph::new(lines), inner);
}

fn draw_question(frame: &mut Frame<'_>, area: Rect, theme: Theme, title: &str, question: &str) {
    // A long path takes several lines.
    let lines = u16::try_from(question.chars().count() / 60).unwrap_or(u16::MAX);
    let area = middle(area, 70, 5u16.max(lines.saturating_add(3)));
    let block = panel(theme, title, true);
    let inner = over(frame, area, &block);
    let text = Paragraph::new(theme.text(question)).wrap(Wrap { trim: true });
    frame.render_widget(text, inner);
}
