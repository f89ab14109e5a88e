//! How a curve is drawn: where its dots, dashes and letters stand on the screen.
//!
//! Distances are counted along the curve in character widths, a row counting twice, from its first point, so that the
//! pattern does not depend on where its points lie. What is outside the window is passed over, however long.

use super::theme::Theme;
use crate::figure::Bounds;
use line_clipping::{LineSegment, Point, Window, cohen_sutherland};
use ratatui::layout::Rect;
use ratatui::symbols::Marker;

/// How a curve is drawn; no two look alike, so that none needs its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// A line.
    Solid,
    /// Close dots.
    Dotted,
    /// Dots far apart.
    Sparse,
    /// Dashes.
    Dashed,
    /// Short dashes.
    ShortDashed,
    /// Long dashes.
    LongDashed,
    /// Dots with this letter between.
    Lettered(&'static str),
    /// This letter again and again, over what else is there.
    Repeated(&'static str),
}

/// Letters between dots are so far apart, and those alone.
const LETTERS: f64 = 14.0;
const REPEATED: f64 = 2.0;
/// Beyond so many widths from the window lengths mean nothing.
const FAR: f64 = 1e12;

impl Stroke {
    /// The distance between its spots, and of how many widths how many are drawn.
    fn pattern(self) -> (f64, [f64; 2]) {
        match self {
            Self::Solid => (0.25, [1.0, 1.0]),
            Self::Dotted => (0.75, [1.0, 1.0]),
            Self::Sparse => (2.5, [1.0, 1.0]),
            Self::Lettered(_) => (1.5, [1.0, 1.0]),
            Self::Repeated(_) => (REPEATED, [1.0, 1.0]),
            Self::Dashed => (0.25, [3.5, 2.0]),
            Self::ShortDashed => (0.25, [2.0, 1.0]),
            Self::LongDashed => (0.25, [8.0, 6.0]),
        }
    }

    /// The letter of a curve, and how far apart it stands.
    pub fn letter(self) -> Option<(&'static str, f64)> {
        match self {
            Self::Lettered(letter) => Some((letter, LETTERS)),
            Self::Repeated(letter) => Some((letter, REPEATED)),
            _ => None,
        }
    }

    /// The dots of the canvas; in ASCII one dot a cell, so each stroke needs a character of its own.
    pub fn marker(self, theme: Theme) -> Marker {
        if !theme.ascii {
            return Marker::Braille;
        }
        Marker::Custom(match self {
            Self::Solid => 'o',
            Self::Dotted | Self::Sparse | Self::Lettered(_) | Self::Repeated(_) => '.',
            Self::Dashed => '-',
            Self::ShortDashed => ':',
            Self::LongDashed => '~',
        })
    }
}

/// Places along a curve, `apart` from each other, inside the window: the distance from its first point, and where.
fn along(points: &[(f64, f64)], bounds: &Bounds, plot: Rect, apart: f64) -> Vec<(f64, f64, f64)> {
    let (width, height) = (f64::from(plot.width), f64::from(plot.height));
    let window = Window::new(0.0, width, 0.0, height);
    // In cells from the lower left corner.
    let cells = |(x, y): (f64, f64)| {
        let share = |value: f64, [lo, hi]: [f64; 2]| (value - lo) / (hi - lo);
        Point::new(share(x, bounds.x) * width, share(y, bounds.y) * height)
    };
    // A cell is twice as high as wide.
    let distance = |a: Point, b: Point| (b.x - a.x).hypot(2.0 * (b.y - a.y));
    let mut places = Vec::new();
    let mut before = 0.0;
    for pair in points.windows(2) {
        let [from, to] = [cells(pair[0]), cells(pair[1])];
        let length = distance(from, to);
        if ![from.x, from.y, to.x, to.y].iter().all(|x| x.abs() < FAR) {
            continue;
        }
        if let Some(seen) = cohen_sutherland::clip_line(LineSegment::new(from, to), window)
            && length > 0.0
        {
            let (first, last) = (before + distance(from, seen.p1), before + distance(from, seen.p2));
            let mut count = (first / apart).ceil();
            while count * apart < last {
                let share = (count * apart - before) / length;
                let at = |a: f64, b: f64| a + (b - a) * share;
                places.push((count * apart, at(from.x, to.x), at(from.y, to.y)));
                count += 1.0;
            }
        }
        before += length;
    }
    places
}

/// The spots of a curve in axis values.
pub fn spots(points: &[(f64, f64)], bounds: &Bounds, plot: Rect, stroke: Stroke) -> Vec<(f64, f64)> {
    let (apart, [period, drawn]) = stroke.pattern();
    let share = |cells: f64, count: u16| cells / f64::from(count);
    along(points, bounds, plot, apart)
        .into_iter()
        .filter(|(distance, ..)| distance % period < drawn)
        .map(|(_, x, y)| bounds.at((share(x, plot.width), share(y, plot.height))))
        .collect()
}

/// The cells in which the letters of a curve stand, so far apart.
pub fn letters(points: &[(f64, f64)], bounds: &Bounds, plot: Rect, apart: f64) -> Vec<(u16, u16)> {
    along(points, bounds, plot, apart)
        .into_iter()
        .map(|(_, x, y)| {
            // Inside the window, whose sides are below 2^16.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let (column, row) = (x.max(0.0) as u16, y.max(0.0) as u16);
            let (last_column, last_row) = (plot.width - 1, plot.height - 1);
            (plot.x + column.min(last_column), plot.y + last_row - row.min(last_row))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLOT: Rect = Rect { x: 3, y: 2, width: 50, height: 20 };

    #[test]
    fn a_pattern_does_not_depend_on_the_points_and_stays_inside() {
        let bounds = Bounds { x: [0.0, 1.0], y: [0.0, 1.0] };
        let coarse = [(-1.0, 0.5), (2.0, 0.5)];
        let fine: Vec<(f64, f64)> = (0..=300).map(|i| (-1.0 + f64::from(i) / 100.0, 0.5)).collect();
        for stroke in
            [Stroke::Dotted, Stroke::Sparse, Stroke::Dashed, Stroke::ShortDashed, Stroke::LongDashed]
        {
            let [a, b] = [&coarse[..], &fine].map(|points| spots(points, &bounds, PLOT, stroke));
            assert!(!a.is_empty() && a.len().abs_diff(b.len()) <= 1, "{stroke:?} {} {}", a.len(), b.len());
            assert!(a.iter().all(|spot| bounds.share(*spot).is_some()), "{stroke:?}");
        }
        assert_eq!(letters(&coarse, &bounds, PLOT, LETTERS).len(), 4);
    }

    #[test]
    fn far_lines_and_numbers_that_are_none_cost_nothing() {
        let deep = Bounds { x: [0.5, 0.5 + 1e-9], y: [0.0, 1e-9] };
        let line = [(0.0, 0.0), (1.0, 0.0), (f64::NAN, 0.0), (1e300, -1e300), (0.0, f64::INFINITY)];
        let spots = spots(&line, &deep, PLOT, Stroke::Dotted);
        assert!((60..=70).contains(&spots.len()), "{}", spots.len());
        assert!(letters(&line[2..], &deep, PLOT, LETTERS).is_empty());
    }
}
