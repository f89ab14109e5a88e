//! One chart: axes with sensible ticks, curves in dots, marks as letters.
//!
//! A stable part is a line, an unstable part is dotted, so that neither needs a colour. No number that is not
//! finite reaches the canvas, and bounds always ascend.

use super::theme::Theme;
use crate::report::number::{fixed, short};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::canvas::{Canvas, Line as Segment, Points};
use ratatui::widgets::{Block, Widget};

/// How a curve is drawn; no two mean the same, so that none needs its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// A line.
    Solid,
    /// Close dots.
    Dotted,
    /// Dots far apart.
    Sparse,
}

impl Stroke {
    /// The distance between dots in character widths.
    fn apart(self) -> f64 {
        if self == Self::Sparse { 2.5 } else { 0.75 }
    }
}

/// A curve to draw.
#[derive(Debug, Clone)]
pub struct Series {
    /// Its points.
    pub points: Vec<(f64, f64)>,
    /// Its colour.
    pub color: Color,
    /// How it is drawn.
    pub stroke: Stroke,
}

/// A letter at a point.
#[derive(Debug, Clone)]
pub struct Mark {
    /// Where.
    pub at: (f64, f64),
    /// The letter.
    pub letter: &'static str,
    /// Its look.
    pub style: Style,
}

/// A chart.
#[derive(Debug, Clone)]
pub struct Chart {
    /// Title, with the axes' names.
    pub title: String,
    /// The name of the x axis, at its right end.
    pub x_title: String,
    /// The curves that set the bounds and those that only are drawn, in the order of drawing.
    pub series: Vec<Series>,
    /// The marks, the last on top.
    pub marks: Vec<Mark>,
    /// x and y range.
    pub bounds: Bounds,
    /// What lines and letters mean, for the frame's lower edge: the first that fits.
    pub legend: Vec<String>,
}

/// The range of both axes, ascending and finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Of x.
    pub x: [f64; 2],
    /// Of y.
    pub y: [f64; 2],
}

impl Bounds {
    /// The range of `points` with a little room; finite and ascending whatever the points are.
    pub fn of(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let empty = [f64::INFINITY, f64::NEG_INFINITY];
        let (mut x, mut y) = (empty, empty);
        for (px, py) in points {
            if px.is_finite() && py.is_finite() {
                x = [x[0].min(px), x[1].max(px)];
                y = [y[0].min(py), y[1].max(py)];
            }
        }
        Self { x: roomy(x), y: roomy(y) }
    }
}

fn roomy([lo, hi]: [f64; 2]) -> [f64; 2] {
    const ROOM: f64 = 0.04;
    if !(lo.is_finite() && hi.is_finite()) {
        return [0.0, 1.0];
    }
    let range = hi - lo;
    if !range.is_finite() || range <= f64::EPSILON * lo.abs().max(hi.abs()) || range == 0.0 {
        let half = (0.5 * lo.abs()).max(0.5 * hi.abs());
        let half = if half > 0.0 && half.is_finite() { half } else { 0.5 };
        return [0.5 * lo + 0.5 * hi - half, 0.5 * lo + 0.5 * hi + half];
    }
    [lo - ROOM * range, hi + ROOM * range]
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
    let plain = decimals <= 5.0 && lo.abs().max(hi.abs()) < 1e6;
    (0..=most)
        .map(|i| (first + i as f64) * step)
        .take_while(|tick| *tick <= hi + 1e-9 * step)
        .map(|tick| {
            let tick = if tick.abs() < 0.5 * step { 0.0 } else { tick };
            // Between 0 and 5, checked above.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let label = if plain { fixed(tick, decimals as usize) } else { short(tick, 3) };
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
            .title(Span::styled(theme.text(&self.title), theme.strong()));
        let fits = |text: &&String| text.chars().count() + 2 <= usize::from(area.width);
        if let Some(legend) = self.legend.iter().find(fits) {
            block = block.title_bottom(Line::styled(theme.text(legend), theme.dim()).right_aligned());
        }
        let inner = block.inner(area);
        frame.render_widget(block, area);
        if inner.width < 12 || inner.height < 4 {
            return;
        }
        let y_ticks = ticks(self.bounds.y, usize::from(inner.height / 3).clamp(2, 8));
        let gutter = y_ticks.iter().map(|(_, label)| label.len()).max().unwrap_or(0);
        let gutter = u16::try_from(gutter + 1).unwrap_or(u16::MAX).min(inner.width / 3);
        let plot =
            Rect { x: inner.x + gutter, width: inner.width - gutter, height: inner.height - 1, ..inner };
        self.draw_curves(frame, plot, theme);
        let buffer = frame.buffer_mut();
        for (value, label) in &y_ticks {
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
        for mark in &self.marks {
            let column = cell(mark.at.0, self.bounds.x, plot.width, false);
            let row = cell(mark.at.1, self.bounds.y, plot.height, true);
            if let (Some(column), Some(row)) = (column, row) {
                buffer.set_stringn(plot.x + column, plot.y + row, mark.letter, 1, mark.style);
            }
        }
    }

    /// The curves, each in a canvas of its own so that a later one does not recolour the cells of an earlier.
    fn draw_curves(&self, frame: &mut Frame<'_>, plot: Rect, theme: Theme) {
        for dotted in [true, false] {
            let marker = if dotted { theme.unstable_marker() } else { theme.marker() };
            let series: Vec<&Series> =
                self.series.iter().filter(|series| (series.stroke != Stroke::Solid) == dotted).collect();
            let canvas =
                Canvas::default().marker(marker).x_bounds(self.bounds.x).y_bounds(self.bounds.y).paint(
                    |context| {
                        for series in &series {
                            if dotted {
                                let dots = self.dots(series, plot);
                                context.draw(&Points::new(&dots, series.color));
                            } else {
                                for pair in series.points.windows(2) {
                                    if let Some([(x1, y1), (x2, y2)]) = finite(pair) {
                                        context.draw(&Segment { x1, y1, x2, y2, color: series.color });
                                    }
                                }
                            }
                            context.layer();
                        }
                    },
                );
            // Only the cells with dots: a later canvas leaves the others as they are.
            let mut layer = ratatui::buffer::Buffer::empty(plot);
            canvas.render(plot, &mut layer);
            let buffer = frame.buffer_mut();
            for position in plot.positions() {
                let drawn = &layer[position];
                if drawn.symbol() != " " && drawn.symbol() != "\u{2800}" {
                    buffer[position] = drawn.clone();
                }
            }
        }
    }

    /// Dots along a curve, evenly spaced on the screen.
    fn dots(&self, series: &Series, plot: Rect) -> Vec<(f64, f64)> {
        let apart = series.stroke.apart();
        let per_x = f64::from(plot.width) / (self.bounds.x[1] - self.bounds.x[0]);
        // A cell is twice as high as wide.
        let per_y = 2.0 * f64::from(plot.height) / (self.bounds.y[1] - self.bounds.y[0]);
        let mut dots = Vec::new();
        let mut since = apart;
        for pair in series.points.windows(2) {
            let Some([(x1, y1), (x2, y2)]) = finite(pair) else { continue };
            let length = ((x2 - x1) * per_x).hypot((y2 - y1) * per_y);
            // A piece far outside the window would give dots without end.
            if !length.is_finite() || length > 1e4 {
                continue;
            }
            let mut at = apart - since;
            while at < length {
                if at >= 0.0 {
                    let share = at / length;
                    dots.push((x1 + (x2 - x1) * share, y1 + (y2 - y1) * share));
                }
                at += apart;
            }
            since = length - (at - apart);
        }
        dots
    }
}

fn finite(pair: &[(f64, f64)]) -> Option<[(f64, f64); 2]> {
    let [a, b] = *pair else { return None };
    [a.0, a.1, b.0, b.1].iter().all(|x| x.is_finite()).then_some([a, b])
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
    fn bounds_are_finite_and_ascending_for_any_points() {
        for points in [
            vec![],
            vec![(f64::NAN, 1.0)],
            vec![(1.0, 2.0)],
            vec![(0.0, 0.0), (0.0, 0.0)],
            vec![(-1e300, 1e300), (1e300, -1e300)],
            vec![(1.0, f64::INFINITY), (2.0, 3.0)],
        ] {
            let Bounds { x, y } = Bounds::of(points.clone());
            for [lo, hi] in [x, y] {
                assert!(lo.is_finite() && hi.is_finite() && lo < hi, "{points:?}: {lo} {hi}");
            }
        }
    }

    #[test]
    fn ticks_are_round_and_inside() {
        let labels = |bounds, most| ticks(bounds, most).into_iter().map(|(_, l)| l).collect::<Vec<_>>();
        assert_eq!(labels([-0.061, 0.066], 4), ["-0.05", "0.00", "0.05"]);
        assert_eq!(labels([-1.5, 0.4], 5), ["-1.5", "-1.0", "-0.5", "0.0"]);
        assert_eq!(labels([0.0, 3e-9], 3), ["0", "1e-9", "2e-9", "3e-9"]);
        assert!(ticks([1.0, 1.0], 4).is_empty());
        assert!(ticks([0.0, f64::NAN], 4).is_empty());
    }
}
