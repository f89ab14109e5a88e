//! One chart: axes with sensible ticks, curves in strokes, areas hatched, marks as letters.
//!
//! No two strokes look alike without their colour: a line, a line with letters, close dots, dots far apart, dashes,
//! dots with digits between. No number that is not finite reaches the canvas, and nothing outside the window is drawn.

use super::hatch::{Texture, hatch};
use super::stroke::{Stroke, letters, spots};
use super::theme::Theme;
use crate::figure::Bounds;
use pulloff_engine::report::number::{fixed, short};
use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::{Margin, Rect};
use ratatui::style::{Color, Style};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::canvas::{Canvas, Context, Line as Segment, Points};
use ratatui::widgets::{Block, Widget};

/// A curve to draw.
#[derive(Debug, Clone)]
pub struct Series {
    pub points: Vec<(f64, f64)>,
    pub style: Style,
    /// How it is drawn.
    pub stroke: Stroke,
}

/// A closed outline that is filled.
#[derive(Debug, Clone)]
pub struct Region {
    pub outline: Vec<(f64, f64)>,
    pub style: Style,
    /// What it is filled with.
    pub texture: Texture,
}

/// A letter at a point.
#[derive(Debug, Clone)]
pub struct Mark {
    pub at: (f64, f64),
    pub letter: &'static str,
    pub style: Style,
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
    /// What lines and letters mean, for the frame's lower edge: the first that fits.
    pub legend: Vec<String>,
    /// What stands in it where there is nothing to draw.
    pub missing: Option<String>,
}

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
        let mut block = Block::bordered()
            .border_set(theme.border())
            .border_style(theme.frame(selected))
            .title(Span::styled(theme.text(&self.title), theme.title(selected)));
        let fits = |text: &&String| text.chars().count() + 2 <= usize::from(area.width);
        let titles = self.title.chars().count() + self.note.chars().count() + 3;
        if !self.note.is_empty() && titles <= usize::from(area.width) {
            block = block.title_top(Line::styled(theme.text(&self.note), theme.dim()).right_aligned());
        }
        if let Some(legend) = self.legend.iter().find(fits) {
            block = block.title_bottom(Line::styled(theme.text(legend), theme.dim()).right_aligned());
        }
        let inner = block.inner(area);
        frame.render_widget(block, area);
        let Some(plot) = self.plot(area) else { return };
        let gutter = plot.x - inner.x;
        let buffer = frame.buffer_mut();
        if let Some(reason) = &self.missing {
            let text = theme.text(reason);
            buffer.set_stringn(inner.x + 1, inner.y + 1, text, usize::from(inner.width) - 1, theme.dim());
            return;
        }
        self.draw_lines(buffer, plot, theme);
        self.draw_cross(buffer, plot, theme);
        for (value, label) in &self.y_ticks(inner) {
            if let Some(row) = cell(*value, self.bounds.y, plot.height, true) {
                let room = usize::from(gutter.saturating_sub(1));
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
            let x = (plot.x + column).saturating_sub(width / 2).max(inner.x);
            if x >= free && x + width <= end {
                buffer.set_stringn(x, below, &label, usize::from(width), theme.dim());
                free = x + width + 1;
            }
        }
        let x = inner.right().saturating_sub(title_width);
        buffer.set_stringn(x, below, title, usize::from(inner.width), theme.strong());
        for series in &self.series {
            let Some((letter, apart)) = series.stroke.letter() else { continue };
            for (x, y) in letters(&series.points, &self.bounds, plot, apart) {
                put(buffer, (x, y), letter, series.style);
            }
        }
        for mark in &self.marks {
            let column = cell(mark.at.0, self.bounds.x, plot.width, false);
            let row = cell(mark.at.1, self.bounds.y, plot.height, true);
            if let (Some(column), Some(row)) = (column, row) {
                put(buffer, (plot.x + column, plot.y + row), mark.letter, mark.style);
            }
        }
    }

    /// The ticks of y in a frame of this inside.
    fn y_ticks(&self, inner: Rect) -> Vec<(f64, String)> {
        ticks(self.bounds.y, usize::from(inner.height / 3).clamp(2, 8))
    }

    /// Where the curves are drawn, with the frame in `area`; `None` where there is no room for them.
    pub fn plot(&self, area: Rect) -> Option<Rect> {
        let inner = area.inner(Margin::new(1, 1));
        if inner.width < 12 || inner.height < 4 {
            return None;
        }
        let gutter = self.y_ticks(inner).iter().map(|(_, label)| label.len()).max().unwrap_or(0);
        let gutter = u16::try_from(gutter + 1).unwrap_or(u16::MAX).min(inner.width / 3);
        Some(Rect { x: inner.x + gutter, width: inner.width - gutter, height: inner.height - 1, ..inner })
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

    /// Areas and curves, whole lines over dots and dashes.
    fn draw_lines(&self, buffer: &mut Buffer, plot: Rect, theme: Theme) {
        let hatching = theme.hatch_marker();
        self.canvas(buffer, plot, hatching, |context| {
            for region in &self.areas {
                let dots = hatch(&region.outline, region.texture, &self.bounds, plot, hatching);
                context.draw(&Points::new(&dots, color(region.style)));
            }
        });
        let (broken, lines): (Vec<&Series>, Vec<&Series>) =
            self.series.iter().partition(|series| !series.stroke.is_line());
        let ordered = [broken, lines].concat();
        let marker = |series: &&Series| series.stroke.marker(theme);
        for group in ordered.chunk_by(|a, b| marker(a) == marker(b)) {
            let Some(first) = group.first() else { continue };
            self.canvas(buffer, plot, marker(first), |context| {
                for series in group {
                    self.draw_series(context, series, plot, theme);
                    // A layer of its own: a later one does not recolour the cells of an earlier.
                    context.layer();
                }
            });
        }
    }

    fn draw_series(&self, context: &mut Context<'_>, series: &Series, plot: Rect, theme: Theme) {
        let color = color(series.style);
        if !series.stroke.is_line() {
            let spots = spots(&series.points, &self.bounds, plot, series.stroke, theme.charts);
            context.draw(&Points::new(&spots, color));
            return;
        }
        for pair in series.points.windows(2) {
            if let [(x1, y1), (x2, y2)] = *pair
                && [x1, y1, x2, y2].iter().all(|x| x.is_finite())
            {
                context.draw(&Segment { x1, y1, x2, y2, color });
            }
        }
    }

    /// Draws on a canvas of its own and takes over only the cells with something in them.
    fn canvas(&self, buffer: &mut Buffer, plot: Rect, marker: Marker, paint: impl Fn(&mut Context<'_>)) {
        let canvas =
            Canvas::default().marker(marker).x_bounds(self.bounds.x).y_bounds(self.bounds.y).paint(paint);
        let mut layer = Buffer::empty(plot);
        canvas.render(plot, &mut layer);
        for position in plot.positions() {
            let drawn = &layer[position];
            if drawn.symbol() != " " && drawn.symbol() != "\u{2800}" {
                buffer[position] = drawn.clone();
            }
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
        for (i, j, line) in across.chain(upwards) {
            let cell = &mut buffer[(plot.x + i, plot.y + j)];
            if cell.symbol() == " " {
                cell.set_symbol(line).set_style(theme.dim());
            }
        }
        put(buffer, (plot.x + column, plot.y + row), "+", theme.strong());
    }
}

/// A letter in place of what is drawn there: of a block its background would shine through.
fn put(buffer: &mut Buffer, at: (u16, u16), letter: &str, style: Style) {
    let cell = &mut buffer[at];
    cell.reset();
    cell.set_symbol(letter).set_style(style);
}

/// The colour of a style; the terminal's own where it has none.
fn color(style: Style) -> Color {
    style.fg.unwrap_or(Color::Reset)
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
}
