//! One chart: axes with round ticks, curves, shaded areas, marks.
//!
//! No number that is not finite reaches a cell, and nothing outside the window is drawn.

use super::raster::{self, Layer, Stroke};
use super::theme::Theme;
use crate::figure::Bounds;
use pulloff_engine::report::number::{fixed, short};
use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::{Margin, Position, Rect};
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::Block;

/// A curve to draw: its parts, and whether each is broken.
#[derive(Debug, Clone)]
pub struct Series {
    pub parts: Vec<(Vec<(f64, f64)>, bool)>,
    pub stroke: Stroke,
}

/// A closed outline that is filled.
#[derive(Debug, Clone)]
pub struct Region {
    pub outline: Vec<(f64, f64)>,
    pub style: Style,
    /// What each of its cells is filled with.
    pub shade: &'static str,
}

/// A letter at a point.
#[derive(Debug, Clone)]
pub struct Mark {
    pub at: (f64, f64),
    pub letter: String,
    pub style: Style,
    /// Whether it stands beside the point where a cell is free there: what it marks stays seen.
    pub is_beside: bool,
}

/// An entry of the legend: what a line or a letter looks like, and what it means.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    pub glyph: String,
    pub style: Style,
    pub meaning: String,
}

impl Entry {
    fn width(&self) -> usize {
        self.glyph.chars().count() + 1 + self.meaning.chars().count()
    }
}

/// A chart.
#[derive(Debug, Clone)]
pub struct Chart {
    pub title: String,
    /// What else it says, at the right end of the title's line where it fits.
    pub note: String,
    /// The name of the x axis, at its right end.
    pub x_title: String,
    pub areas: Vec<Region>,
    /// The curves, in the order of drawing.
    pub series: Vec<Series>,
    /// The marks, the last on top.
    pub marks: Vec<Mark>,
    pub cross: Option<(f64, f64)>,
    pub bounds: Bounds,
    /// What lines and letters mean, the most important first.
    pub legend: Vec<Entry>,
    /// What stands in it where there is nothing to draw.
    pub missing: Option<String>,
}

/// A chart with fewer rows inside has no row for its legend.
const LEGEND_ROWS: u16 = 8;

/// Round ticks inside `bounds`, at most `most`, with labels of one precision.
pub fn ticks([lo, hi]: [f64; 2], most: usize) -> Vec<(f64, String)> {
    let range = hi - lo;
    if most == 0 || !range.is_finite() || range <= 0.0 {
        return Vec::new();
    }
    let raw = range / most as f64;
    let decade = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * decade).find(|step| *step >= raw).unwrap_or(raw);
    let first = (lo / step).ceil();
    // Decimals that tell neighbouring ticks apart; very small or large values get an exponent.
    let decimals = (-step.log10().floor()).max(0.0);
    let size = lo.abs().max(hi.abs());
    let plain = decimals <= 5.0 && size < 1e6;
    // Far into a curve only the last digits differ.
    let digits = (size / step).log10().ceil().clamp(2.0, 16.0) + 1.0;
    (0..=most)
        .map(|i| (first + i as f64) * step)
        .take_while(|tick| *tick <= hi + 1e-9 * step)
        .map(|tick| {
            let tick = if tick.abs() < 0.5 * step { 0.0 } else { tick };
            // Between 0 and 5, and between 3 and 17, see above.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let label = if plain { fixed(tick, decimals as usize) } else { short(tick, digits as usize) };
            (tick, label)
        })
        .collect()
}

impl Chart {
    /// Draws the chart with its frame into `area`.
    pub fn draw(&self, frame: &mut Frame<'_>, area: Rect, theme: Theme, selected: bool) {
        let mut block: Block<'_> =
            theme.block(selected).title(Span::styled(theme.text(&self.title), theme.title(selected)));
        let note = theme.text(&self.note);
        if self.legend_fits(area) {
            let mut spans = self.legend_spans(theme, usize::MAX);
            if !note.is_empty() && !spans.is_empty() {
                spans.push(Span::raw("  "));
            }
            spans.push(Span::styled(note, theme.dim()));
            block = block.title_top(Line::from(spans).right_aligned());
        } else if self.title.chars().count() + note.chars().count() + 3 <= usize::from(area.width) {
            block = block.title_top(Line::styled(note, theme.dim()).right_aligned());
        }
        let inner = block.inner(area);
        frame.render_widget(block, area);
        let buffer = frame.buffer_mut();
        if let Some(reason) = &self.missing {
            let text = theme.text(reason);
            let room = usize::from(inner.width.saturating_sub(1));
            buffer.set_stringn(inner.x + 1, inner.y + 1, text, room, theme.dim());
            return;
        }
        let Some(plot) = self.plot(area) else { return };
        if plot.y > inner.y {
            let line = Line::from(self.legend_spans(theme, usize::from(plot.width)));
            buffer.set_line(plot.x, inner.y, &line, plot.width);
        }
        for region in &self.areas {
            self.fill(buffer, plot, region);
        }
        self.draw_zero(buffer, plot, theme);
        let layers: Vec<Layer> = self.series.iter().map(|series| self.layer(series, plot, theme)).collect();
        let taken = raster::draw(&layers, buffer, plot, theme.charts);
        self.draw_cross(buffer, plot, theme);
        self.draw_labels(buffer, inner, plot, theme);
        self.draw_marks(buffer, plot, &taken);
    }

    fn layer(&self, series: &Series, plot: Rect, theme: Theme) -> Layer {
        let mut layer = Layer::new(series.stroke, plot);
        for (points, is_broken) in &series.parts {
            layer.add(points, *is_broken, &self.bounds, plot, theme.charts);
        }
        layer
    }

    /// Whether the whole legend stands in the upper wall.
    fn legend_fits(&self, area: Rect) -> bool {
        let legend: usize = self.legend.iter().map(|entry| entry.width() + 2).sum();
        self.title.chars().count() + self.note.chars().count() + legend + 4 <= usize::from(area.width)
    }

    /// As many entries as there is room for; an ellipsis where some are left out.
    fn legend_spans(&self, theme: Theme, room: usize) -> Vec<Span<'static>> {
        let mut spans = Vec::new();
        let mut used = 0;
        for (at, entry) in self.legend.iter().enumerate() {
            let gap = if at == 0 { 0 } else { 2 };
            let rest = if at + 1 < self.legend.len() { 2 } else { 0 };
            if used + gap + entry.width() + rest > room {
                if used + 2 <= room {
                    spans.push(Span::styled(theme.glyph(" …", " ."), theme.dim()));
                }
                break;
            }
            spans.push(Span::raw(" ".repeat(gap)));
            spans.push(Span::styled(entry.glyph.clone(), entry.style));
            spans.push(Span::styled(format!(" {}", theme.text(&entry.meaning)), theme.dim()));
            used += gap + entry.width();
        }
        spans
    }

    /// The ticks of y in a frame of this inside.
    fn y_ticks(&self, inner: Rect) -> Vec<(f64, String)> {
        ticks(self.bounds.y, usize::from(inner.height / 3).clamp(2, 8))
    }

    /// Where the curves are drawn, with the frame in `area`; `None` where there is no room for them.
    pub fn plot(&self, area: Rect) -> Option<Rect> {
        let inner = area.inner(Margin::new(1, 1));
        if inner.width < 12 || inner.height < 3 {
            return None;
        }
        let gutter = self.y_ticks(inner).iter().map(|(_, label)| label.len()).max().unwrap_or(0);
        let gutter = u16::try_from(gutter + 1).unwrap_or(u16::MAX).min(inner.width / 3);
        let has_row = inner.height >= LEGEND_ROWS && !self.legend.is_empty() && !self.legend_fits(area);
        let above = u16::from(has_row);
        Some(Rect {
            x: inner.x + gutter,
            y: inner.y + above,
            width: inner.width - gutter,
            height: inner.height - 1 - above,
        })
    }

    /// Widens the axes so that a circle is round in a frame of this area: a cell is twice as high as wide.
    pub fn make_even(&mut self, area: Rect) {
        let Some(plot) = self.plot(area) else { return };
        let [x, y] = [self.bounds.x, self.bounds.y].map(|[lo, hi]| hi - lo);
        let (across, upwards) = (f64::from(plot.width), 2.0 * f64::from(plot.height));
        let unit = (x / across).max(y / upwards);
        let spare = 0.5 * (unit * across - x);
        self.bounds.x = [self.bounds.x[0] - spare, self.bounds.x[1] + spare];
        self.bounds.y[1] = self.bounds.y[0] + unit * upwards;
    }

    /// The cells whose middle is inside of an outline.
    fn fill(&self, buffer: &mut Buffer, plot: Rect, region: &Region) {
        if region.outline.iter().any(|(x, y)| !(x.is_finite() && y.is_finite())) {
            return;
        }
        for row in 0..plot.height {
            let up = 1.0 - (f64::from(row) + 0.5) / f64::from(plot.height);
            let (_, y) = self.bounds.at((0.0, up));
            let crossings = crossings(&region.outline, y);
            if crossings.is_empty() {
                continue;
            }
            for column in 0..plot.width {
                let (x, _) = self.bounds.at(((f64::from(column) + 0.5) / f64::from(plot.width), 0.0));
                // Inside when an odd number of sides lies to the left.
                if crossings.iter().filter(|crossing| **crossing < x).count() % 2 == 1 {
                    put(buffer, (plot.x + column, plot.y + row), region.shade, region.style);
                }
            }
        }
    }

    /// The axes through zero, in the empty cells.
    fn draw_zero(&self, buffer: &mut Buffer, plot: Rect, theme: Theme) {
        let column = cell(0.0, self.bounds.x, plot.width, false);
        let row = cell(0.0, self.bounds.y, plot.height, true);
        let across = row.into_iter().flat_map(|row| (0..plot.width).map(move |i| (i, row)));
        let across = across.map(|at| (at, theme.glyph("┈", "-")));
        let upwards = column.into_iter().flat_map(|column| (0..plot.height).map(move |j| (column, j)));
        let upwards = upwards.map(|at| (at, theme.glyph("┊", ":")));
        for ((i, j), line) in across.chain(upwards) {
            let place = &mut buffer[(plot.x + i, plot.y + j)];
            if place.symbol() == " " {
                place.set_symbol(line).set_style(theme.dim());
            }
        }
    }

    /// Each label on its row or column, or not at all.
    fn draw_labels(&self, buffer: &mut Buffer, inner: Rect, plot: Rect, theme: Theme) {
        let gutter = plot.x - inner.x;
        for (value, label) in &self.y_ticks(inner) {
            let room = usize::from(gutter.saturating_sub(1));
            if let Some(row) = cell(*value, self.bounds.y, plot.height, true)
                && label.len() <= room
            {
                let text = format!("{label:>room$}");
                buffer.set_stringn(inner.x, plot.y + row, text, room, theme.dim());
            }
        }
        let below = plot.y + plot.height;
        let title = theme.text(&self.x_title);
        let title_width = u16::try_from(title.chars().count()).unwrap_or(u16::MAX);
        let end = inner.right().saturating_sub(title_width + 1);
        let mut free = inner.x;
        for (value, label) in ticks(self.bounds.x, usize::from(plot.width / 12).clamp(2, 10)) {
            let width = u16::try_from(label.len()).unwrap_or(u16::MAX);
            let Some(column) = cell(value, self.bounds.x, plot.width, false) else { continue };
            let Some(x) = (plot.x + column).checked_sub(width / 2) else { continue };
            if x >= free && x + width <= end {
                buffer.set_stringn(x, below, &label, usize::from(width), theme.dim());
                free = x + width + 1;
            }
        }
        let x = inner.right().saturating_sub(title_width).max(inner.x);
        buffer.set_stringn(x, below, title, usize::from(inner.width), theme.strong());
    }

    /// The marks; one that stands beside its point takes a free cell there, where there is one.
    fn draw_marks(&self, buffer: &mut Buffer, plot: Rect, taken: &[Option<usize>]) {
        let mut marked: Vec<Position> = Vec::new();
        for mark in &self.marks {
            let column = cell(mark.at.0, self.bounds.x, plot.width, false);
            let row = cell(mark.at.1, self.bounds.y, plot.height, true);
            let (Some(column), Some(row)) = (column, row) else { continue };
            let own = Position::new(plot.x + column, plot.y + row);
            let is_free = |at: &Position| {
                let index = usize::from(at.y - plot.y) * usize::from(plot.width) + usize::from(at.x - plot.x);
                taken.get(index).is_some_and(Option::is_none) && !marked.contains(at)
            };
            let beside = [(-1, 0), (1, 0), (0, -1), (0, 1)].into_iter().filter_map(|(right, down)| {
                let at = Position::new(own.x.checked_add_signed(right)?, own.y.checked_add_signed(down)?);
                plot.contains(at).then_some(at)
            });
            let found = if mark.is_beside { beside.into_iter().find(is_free) } else { None };
            let at = found.unwrap_or(own);
            if mark.is_beside && marked.contains(&at) {
                continue;
            }
            marked.push(at);
            put(buffer, (at.x, at.y), &mark.letter, mark.style);
        }
    }

    /// The cross-hair: lines in the empty cells of its row and column.
    fn draw_cross(&self, buffer: &mut Buffer, plot: Rect, theme: Theme) {
        let Some((x, y)) = self.cross else { return };
        let column = cell(x, self.bounds.x, plot.width, false);
        let row = cell(y, self.bounds.y, plot.height, true);
        let (Some(column), Some(row)) = (column, row) else { return };
        let across = (0..plot.width).map(|i| (i, row, theme.glyph("─", "-")));
        let upwards = (0..plot.height).map(|j| (column, j, theme.glyph("│", "|")));
        let free = [" ", theme.glyph("┈", "-"), theme.glyph("┊", ":")];
        for (i, j, line) in across.chain(upwards) {
            let place = &mut buffer[(plot.x + i, plot.y + j)];
            if free.contains(&place.symbol()) {
                place.set_symbol(line).set_style(theme.dim());
            }
        }
        put(buffer, (plot.x + column, plot.y + row), "+", theme.strong());
    }
}

/// Where the sides of the outline cross the level `y`.
fn crossings(outline: &[(f64, f64)], y: f64) -> Vec<f64> {
    let next = outline.iter().cycle().skip(1);
    outline
        .iter()
        .zip(next)
        .filter(|(a, b)| (a.1 > y) != (b.1 > y))
        .map(|(a, b)| a.0 + (b.0 - a.0) * (y - a.1) / (b.1 - a.1))
        .collect()
}

/// A letter in place of what is drawn there: of a block its background would shine through.
fn put(buffer: &mut Buffer, at: (u16, u16), letter: &str, style: Style) {
    let cell = &mut buffer[at];
    cell.reset();
    cell.set_symbol(letter).set_style(style);
}

/// The cell of `count` in which `value` falls; from the far end where `flipped`.
fn cell(value: f64, [lo, hi]: [f64; 2], count: u16, flipped: bool) -> Option<u16> {
    let share = (value - lo) / (hi - lo);
    if count == 0 || !(0.0..=1.0).contains(&share) {
        return None;
    }
    // Between 0 and count.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let at = ((share * f64::from(count)) as u16).min(count - 1);
    Some(if flipped { count - 1 - at } else { at })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let labels = |bounds, most| ticks(bounds, most).into_iter().map(|(_, l)| l).collect::<Vec<_>>();
        assert_eq!(labels([-0.061, 0.066], 4), ["-0.05", "0.00", "0.05"]);
        assert_eq!(labels([-1.5, 0.4], 5), ["-1.5", "-1.0", "-0.5", "0.0"]);
        assert_eq!(labels([0.0, 3e-9], 3), ["0", "1e-9", "2e-9", "3e-9"]);
        // Far into a curve neighbouring ticks still differ.
        let deep = labels([0.123_456_78, 0.123_456_82], 4);
        assert_eq!(deep, ["0.12345678", "0.12345679", "0.1234568", "0.12345681", "0.12345682"]);
        assert!(ticks([1.0, 1.0], 4).is_empty());
        assert!(ticks([0.0, f64::NAN], 4).is_empty());
    }

    #[test]
    fn an_outline_is_filled_inside_and_nowhere_else() {
        // A square with a notch.
        let outline = vec![(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (2.0, 1.5), (1.0, 3.0)];
        for (y, expected) in
            [(2.0, vec![1.0, 5.0 / 3.0, 7.0 / 3.0, 3.0]), (0.5, vec![]), (1.2, vec![1.0, 3.0])]
        {
            let mut found = crossings(&outline, y);
            found.sort_by(f64::total_cmp);
            assert_eq!(found.len(), expected.len(), "{y}");
            assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        }
    }
}
