//! How a curve is drawn: where its dots, dashes and letters stand on the screen.
//!
//! Distances are counted along the curve in character widths, a row counting twice, from its first point, so that the
//! pattern does not depend on where its points lie. What is outside the window is passed over, however long.

use super::theme::{Charts, Theme};
use crate::figure::Bounds;
use line_clipping::{LineSegment, Point, Window, cohen_sutherland};
use ratatui::layout::Rect;
use ratatui::symbols::Marker;

/// How a curve is drawn; no two look alike, so that none needs its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    Solid,
    Dotted,
    Sparse,
    Dashed,
    ShortDashed,
    LongDashed,
    /// Long and short dashes in turn.
    DashDotted,
    Marked(&'static str),
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
    /// Whether it is drawn without gaps.
    pub fn is_line(self) -> bool {
        matches!(self, Self::Solid | Self::Marked(_))
    }

    /// The distance between its spots, and of how many widths how many are drawn.
    fn pattern(self, charts: Charts) -> (f64, [f64; 2]) {
        let whole = [1.0, 1.0];
        // A block is as wide as a cell, where a dot has half of one: the gaps are wider.
        let (dense, dot) = if charts == Charts::Block { (0.5, 2.5) } else { (0.25, 0.75) };
        match self {
            Self::Solid | Self::Marked(_) => (dense, whole),
            Self::Dotted => (dot, whole),
            Self::Sparse if charts == Charts::Block => (5.0, whole),
            Self::Sparse => (2.5, whole),
            Self::Lettered(_) => (if charts == Charts::Block { 3.5 } else { 1.5 }, whole),
            Self::Repeated(_) => (REPEATED, whole),
            Self::Dashed => (dense, [3.5 + dense, 2.0]),
            Self::ShortDashed if charts == Charts::Block => (dense, [3.0, 1.5]),
            Self::ShortDashed => (dense, [2.0, 1.0]),
            Self::LongDashed => (dense, [8.0, 6.0]),
            Self::DashDotted => (dense, [7.0, 3.0]),
        }
    }

    /// Whether a spot so far along the curve is drawn.
    fn is_drawn(self, distance: f64, [period, drawn]: [f64; 2]) -> bool {
        let at = distance % period;
        // The dot of a dash and a dot stands in the middle of the gap.
        at < drawn || (self == Self::DashDotted && (at - 0.5 * (period + drawn)).abs() < 0.5)
    }

    /// The letter of a curve, and how far apart it stands.
    pub fn letter(self) -> Option<(&'static str, f64)> {
        match self {
            Self::Lettered(letter) | Self::Marked(letter) => Some((letter, LETTERS)),
            Self::Repeated(letter) => Some((letter, REPEATED)),
            _ => None,
        }
    }

    /// What the canvas draws it with; in ASCII one character a cell, so each stroke needs one of its own.
    pub fn marker(self, theme: Theme) -> Marker {
        match theme.charts {
            Charts::Braille => return Marker::Braille,
            Charts::Block => return Marker::HalfBlock,
            Charts::Ascii => {}
        }
        Marker::Custom(match self {
            Self::Solid => 'o',
            Self::Dotted | Self::Lettered(_) | Self::Repeated(_) => '.',
            Self::Sparse => ',',
            Self::Dashed => '-',
            Self::ShortDashed => ':',
            Self::LongDashed => '~',
            Self::DashDotted => '=',
            Self::Marked(letter) => letter.chars().next().unwrap_or('o'),
        })
    }

    /// How a legend shows it; no two are the same in one theme.
    pub fn glyph(self, theme: Theme) -> &'static str {
        let of = |[braille, block, ascii]: [&'static str; 3]| match theme.charts {
            Charts::Braille => braille,
            Charts::Block => block,
            Charts::Ascii => ascii,
        };
        of(match self {
            Self::Solid => ["━", "▄▄▄", "o"],
            Self::Dotted => ["┈", "▄ ▄", "."],
            Self::Sparse => ["· ·", "▄   ▄", ","],
            Self::Dashed => ["╌", "▄▄ ▄▄", "--"],
            Self::ShortDashed => ["┅", "▄ ▄▄", "::"],
            Self::LongDashed => ["━ ━", "▄▄▄ ▄▄▄", "~~"],
            Self::DashDotted => ["━·", "▄▄ ▄", "=="],
            Self::Lettered(letter) | Self::Repeated(letter) | Self::Marked(letter) => return letter,
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
pub fn spots(
    points: &[(f64, f64)],
    bounds: &Bounds,
    plot: Rect,
    stroke: Stroke,
    charts: Charts,
) -> Vec<(f64, f64)> {
    let (apart, pattern) = stroke.pattern(charts);
    let share = |cells: f64, count: u16| cells / f64::from(count);
    along(points, bounds, plot, apart)
        .into_iter()
        .filter(|(distance, ..)| stroke.is_drawn(*distance, pattern))
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
        for stroke in [
            Stroke::Dotted,
            Stroke::Sparse,
            Stroke::Dashed,
            Stroke::ShortDashed,
            Stroke::LongDashed,
            Stroke::DashDotted,
        ] {
            let draw = |points| spots(points, &bounds, PLOT, stroke, Charts::Braille);
            let [a, b] = [&coarse[..], &fine].map(draw);
            assert!(!a.is_empty() && a.len().abs_diff(b.len()) <= 1, "{stroke:?} {} {}", a.len(), b.len());
            assert!(a.iter().all(|spot| bounds.share(*spot).is_some()), "{stroke:?}");
        }
        assert_eq!(letters(&coarse, &bounds, PLOT, LETTERS).len(), 4);
    }

    #[test]
    fn far_lines_and_numbers_that_are_none_cost_nothing() {
        let deep = Bounds { x: [0.5, 0.5 + 1e-9], y: [0.0, 1e-9] };
        let line = [(0.0, 0.0), (1.0, 0.0), (f64::NAN, 0.0), (1e300, -1e300), (0.0, f64::INFINITY)];
        let spots = spots(&line, &deep, PLOT, Stroke::Dotted, Charts::Braille);
        assert!((60..=70).contains(&spots.len()), "{}", spots.len());
        assert!(letters(&line[2..], &deep, PLOT, LETTERS).is_empty());
    }
}
