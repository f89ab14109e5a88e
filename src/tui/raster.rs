//! Curves as dots in the cells of a plot, and the colour of each cell.
//!
//! A solid line is stable, a broken one is not; the colour says which curve it is, or, where colours are few, a letter
//! along it does. A cell that one curve crosses shows that curve. Curves that are compared share the cells in which
//! they meet: these take their colours in turn, in runs of two or a few, so that none hides another. Lines beneath them
//! are visible where they are alone.
//!
//! Distances are measured along the curve in character widths from its first point, a row counting as two, so that the
//! pattern does not depend on where its points lie. The part outside the window is skipped, however long.

use super::theme::Charts;
use crate::figure::Bounds;
use line_clipping::{LineSegment, Point, Window, cohen_sutherland};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

/// The symbols of a curve and of its broken parts where a cell is one character; a bit says that a cell has solid
/// parts.
pub const STABLE: char = 'o';
pub const UNSTABLE: char = '.';
const SOLID: u8 = 0x80;

/// The distance between the dots of a line.
const DENSE: f64 = 0.25;
/// A broken line: the length of its period, and the part of it that is drawn. None of its cells stays empty.
const BROKEN: [f64; 2] = [1.5, 0.75];
/// The distance of the first letter from the beginning of a curve, and of each further letter from the previous one.
const LETTERS: [f64; 2] = [6.0, 17.0];
/// The same for a line that tints, which may be short.
const TINT_LETTERS: [f64; 2] = [0.5, 10.0];
/// At more than this many widths from the window, lengths have no meaning.
const FAR: f64 = 1e12;

/// How a line meets the others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meets {
    /// It shares the cells in which it meets other lines that share.
    Shares,
    /// It is visible only where no other line is.
    Beneath,
    /// It colours the cells of the line on which it lies.
    Tints,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RasterStroke {
    pub style: Style,
    pub meets: Meets,
    /// Broken: not stable, or not a state.
    pub is_broken: bool,
    /// Its symbol in a cell of its own where a cell is one character.
    pub symbol: char,
    /// The letter along it if its colour does not identify it.
    pub letter: Option<char>,
}

/// A curve in the cells of a plot; bits count from the upper left, rows first.
#[derive(Debug, Clone)]
pub struct Layer {
    pub stroke: RasterStroke,
    bits: Vec<u8>,
    /// The cells in which its letter may stand.
    letters: Vec<usize>,
}

/// The dots in a cell, across and down.
fn dots(charts: Charts) -> (u16, u16) {
    match charts {
        Charts::Braille => (2, 4),
        Charts::Block => (1, 2),
        Charts::Ascii => (1, 1),
    }
}

impl Layer {
    /// A layer without dots.
    pub fn new(stroke: RasterStroke, plot: Rect) -> Self {
        let cells = usize::from(plot.width) * usize::from(plot.height);
        Self { stroke, bits: vec![0; cells], letters: Vec::new() }
    }

    /// Adds a line of this layer, broken or not.
    pub fn add(
        &mut self,
        points: &[(f64, f64)],
        is_broken: bool,
        bounds: &Bounds,
        plot: Rect,
        charts: Charts,
    ) {
        let (across, down) = dots(charts);
        let (width, height) = (f64::from(plot.width), f64::from(plot.height));
        // Inside the window, whose sides are below 2^16.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let place = |at: f64, count: u16| (at.max(0.0) as u16).min(count - 1);
        let [mut next_letter, apart] = if self.stroke.meets == Meets::Tints { TINT_LETTERS } else { LETTERS };
        for (distance, x, y) in along(points, bounds, plot, DENSE) {
            if is_broken && distance % BROKEN[0] > BROKEN[1] {
                continue;
            }
            let column = place(x / width * f64::from(plot.width * across), plot.width * across);
            let row = place((height - y) / height * f64::from(plot.height * down), plot.height * down);
            let cell = usize::from(row / down) * usize::from(plot.width) + usize::from(column / across);
            self.bits[cell] |= 1 << (row % down * across + column % across);
            if charts == Charts::Ascii && !is_broken {
                self.bits[cell] |= SOLID;
            }
            if distance >= next_letter && self.letters.last() != Some(&cell) {
                self.letters.push(cell);
                next_letter = distance + apart;
            }
        }
    }
}

/// Which layers a cell shows.
fn owners(layers: &[Layer], cell: usize) -> impl Iterator<Item = usize> + '_ {
    layers.iter().enumerate().filter(move |(_, layer)| layer.bits[cell] != 0).map(|(at, _)| at)
}

/// Draws the layers, later ones over earlier ones; returns for each cell which layer it shows.
pub fn draw(layers: &[Layer], buffer: &mut Buffer, plot: Rect, charts: Charts) -> Vec<Option<usize>> {
    let (width, height) = (usize::from(plot.width), usize::from(plot.height));
    let mut all = vec![None; width * height];
    for (cell, shown) in all.iter_mut().enumerate() {
        let (column, row) = (cell % width, cell / width);
        let meets = |kind: Meets| {
            owners(layers, cell).filter(move |at| layers[*at].stroke.meets == kind).collect::<Vec<_>>()
        };
        let (sharing, beneath, tints) = (meets(Meets::Shares), meets(Meets::Beneath), meets(Meets::Tints));
        let below = beneath.last().copied();
        let shared = sharing.get(turn(column, row, sharing.len())).copied();
        let Some(at) = shared.or(tints.last().copied()).or(below) else {
            continue;
        };
        *shown = Some(at);
        // Both shapes are visible where two meet.
        let bits = if sharing.is_empty() {
            layers[at].bits[cell]
        } else {
            sharing.iter().fold(0, |bits, other| bits | layers[*other].bits[cell])
        };
        let stroke = layers[at].stroke;
        // The last of those that share is the curve of the problem, and a line that tints lies on it.
        let is_own = sharing.is_empty() || sharing.last() == Some(&at);
        let over = tints.last().filter(|_| is_own).map_or(stroke, |tint| layers[*tint].stroke);
        let symbol = match charts {
            Charts::Braille => char::from_u32(0x2800 + braille(bits)).unwrap_or(' '),
            Charts::Block => [' ', '\u{2580}', '\u{2584}', '\u{2588}'][usize::from(bits & 3)],
            Charts::Ascii if over.symbol == STABLE && layers[at].bits[cell] & SOLID == 0 => UNSTABLE,
            Charts::Ascii => over.symbol,
        };
        let place = &mut buffer[(plot.x + cell_at(column), plot.y + cell_at(row))];
        place.set_char(symbol).set_style(over.style);
    }
    letters(layers, &all, buffer, plot);
    all
}

/// Which of `count` curves gets a cell that all of them cross.
///
/// It depends only on the position of the cell: a curve that moves a little leaves the colours elsewhere unchanged.
/// Along any line all curves get cells equally often, in runs of two or a few: the shares of the steps have no common
/// multiple.
fn turn(column: usize, row: usize, count: usize) -> usize {
    /// What a step of two columns, and one of a row, adds to the turn, in whole turns.
    const STEPS: [f64; 2] = [0.381_966, 0.276_393];
    let turns = STEPS[0] * (column / 2) as f64 + STEPS[1] * row as f64;
    // From 0 to below the count.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let at = (turns.fract() * count as f64) as usize;
    at.min(count.saturating_sub(1))
}

/// Puts letters where their curve is alone.
fn letters(layers: &[Layer], all: &[Option<usize>], buffer: &mut Buffer, plot: Rect) {
    for (at, layer) in layers.iter().enumerate() {
        let Some(letter) = layer.stroke.letter else { continue };
        for cell in &layer.letters {
            let is_alone = owners(layers, *cell).all(|other| other == at) && all[*cell] == Some(at);
            if is_alone || layer.stroke.meets == Meets::Tints {
                let (column, row) = (cell % usize::from(plot.width), cell / usize::from(plot.width));
                let place = &mut buffer[(plot.x + cell_at(column), plot.y + cell_at(row))];
                place.set_char(letter).set_style(layer.stroke.style);
            }
        }
    }
}

/// A column or a row of a plot.
fn cell_at(at: usize) -> u16 {
    u16::try_from(at).unwrap_or(u16::MAX)
}

/// The dots of a cell, rows first, in the numbering of Unicode for braille.
fn braille(bits: u8) -> u32 {
    const PLACES: [u32; 8] = [0x01, 0x08, 0x02, 0x10, 0x04, 0x20, 0x40, 0x80];
    PLACES.iter().enumerate().filter(|(bit, _)| bits & (1 << bit) != 0).map(|(_, dot)| dot).sum()
}

/// Points along a curve, `apart` from each other, inside the window: the distance from its first point, and the
/// position.
fn along(points: &[(f64, f64)], bounds: &Bounds, plot: Rect, apart: f64) -> Vec<(f64, f64, f64)> {
    let (width, height) = (f64::from(plot.width), f64::from(plot.height));
    let window = Window::new(0.0, width, 0.0, height);
    // In cells from the lower left corner.
    let cells = |(x, y): (f64, f64)| {
        let share = |value: f64, [lo, hi]: [f64; 2]| (value - lo) / (hi - lo);
        Point::new(share(x, bounds.x) * width, share(y, bounds.y) * height)
    };
    // A cell is twice as high as it is wide.
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

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::style::Color;

    const PLOT: Rect = Rect { x: 3, y: 2, width: 60, height: 20 };
    const BOUNDS: Bounds = Bounds { x: [0.0, 1.0], y: [0.0, 1.0] };

    fn stroke(color: Color, symbol: char) -> RasterStroke {
        let style = Style::new().fg(color);
        RasterStroke { style, meets: Meets::Shares, is_broken: false, symbol, letter: Some(symbol) }
    }

    fn layer(points: &[(f64, f64)], is_broken: bool, color: Color, charts: Charts) -> Layer {
        let mut layer = Layer::new(stroke(color, color_letter(color)), PLOT);
        layer.add(points, is_broken, &BOUNDS, PLOT, charts);
        layer
    }

    fn color_letter(color: Color) -> char {
        if color == Color::Red { 'r' } else { 'g' }
    }

    fn lattice(f: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        (0..=400).map(|i| f64::from(i) / 400.0).map(|x| (x, f(x))).collect()
    }

    /// The cells that a curve passes through, from its points alone.
    fn passed(points: &[(f64, f64)]) -> Vec<(u16, u16)> {
        let mut cells: Vec<(u16, u16)> = Vec::new();
        for pair in points.windows(2) {
            for i in 0..40 {
                let share = f64::from(i) / 40.0;
                let x = pair[0].0 + share * (pair[1].0 - pair[0].0);
                let y = pair[0].1 + share * (pair[1].1 - pair[0].1);
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                let cell = ((x * 60.0) as u16, ((1.0 - y) * 20.0) as u16);
                if cells.last() != Some(&cell) {
                    cells.push(cell);
                }
            }
        }
        cells.retain(|(column, row)| *column < 60 && *row < 20);
        cells.sort_unstable();
        cells.dedup();
        cells
    }

    #[test]
    fn a_curve_shows_where_it_is_alone_and_two_share_where_they_meet() {
        let first = lattice(|x| 0.2 + 0.5 * x);
        // In the same cells over the first half, then away.
        let second = lattice(|x| 0.2 + 0.5 * x + 1.2 * (x - 0.5).max(0.0).powi(2));
        for charts in [Charts::Braille, Charts::Block, Charts::Ascii] {
            for is_broken in [false, true] {
                let layers = [
                    layer(&first, false, Color::Red, charts),
                    layer(&second, is_broken, Color::Green, charts),
                ];
                let mut buffer = Buffer::empty(Rect::new(0, 0, 70, 30));
                draw(&layers, &mut buffer, PLOT, charts);
                let cells = [passed(&first), passed(&second)];
                let shows = |cell: &(u16, u16)| {
                    let cell = &buffer[(PLOT.x + cell.0, PLOT.y + cell.1)];
                    (cell.symbol() != " ").then_some(cell.fg)
                };
                for (own, other, color) in [(0, 1, Color::Red), (1, 0, Color::Green)] {
                    let alone: Vec<_> = cells[own].iter().filter(|at| !cells[other].contains(at)).collect();
                    let seen = alone.iter().filter(|at| shows(at) == Some(color)).count();
                    assert!(alone.len() > 20 && 5 * seen >= 4 * alone.len(), "{charts:?} {color} {seen}");
                    let shared: Vec<_> = cells[own].iter().filter(|at| cells[other].contains(at)).collect();
                    let seen = shared.iter().filter(|at| shows(at) == Some(color)).count() as f64;
                    let share = seen / shared.len() as f64;
                    assert!(shared.len() > 20 && (0.4..=0.6).contains(&share), "{charts:?} {color} {share}");
                    // Without colours a letter identifies it, more than once.
                    let letter = color_letter(color).to_string();
                    let letters =
                        alone.iter().filter(|at| buffer[(PLOT.x + at.0, PLOT.y + at.1)].symbol() == letter);
                    assert!(letters.count() > 0, "{charts:?} {color}");
                }
            }
        }
    }

    #[test]
    fn along_any_line_all_have_their_share_of_the_cells() {
        for (right, down) in [(1, 0), (0, 1), (1, 1), (2, 1), (4, 1), (1, 2), (1, 3), (6, 1)] {
            for count in [2, 3, 4] {
                let cells: Vec<_> =
                    (0..120).map(|i| (i * right / right.max(down), i * down / right.max(down))).collect();
                for own in 0..count {
                    let has = cells.iter().filter(|(column, row)| turn(*column, *row, count) == own).count();
                    let share = has as f64 * count as f64 / cells.len() as f64;
                    assert!((0.8..=1.2).contains(&share), "{own} of {count} along {right}, {down}: {share}");
                }
            }
        }
    }

    #[test]
    fn a_tint_keeps_the_shape_and_what_is_beneath_shows_alone() {
        let line = lattice(|x| 0.3 + 0.4 * x);
        let plain = layer(&line, true, Color::Red, Charts::Braille);
        let mut tint = layer(&line, false, Color::Green, Charts::Braille);
        (tint.stroke.meets, tint.stroke.letter) = (Meets::Tints, None);
        let mut beneath = layer(&lattice(|x| 0.7 - 0.4 * x), false, Color::Blue, Charts::Braille);
        beneath.stroke.meets = Meets::Beneath;
        let draw_all = |layers: &[Layer]| {
            let mut buffer = Buffer::empty(Rect::new(0, 0, 70, 30));
            draw(layers, &mut buffer, PLOT, Charts::Braille);
            buffer
        };
        let [alone, all] =
            [draw_all(std::slice::from_ref(&plain)), draw_all(&[beneath, plain.clone(), tint])];
        let mut tinted = 0;
        for at in PLOT.positions().filter(|at| alone[*at].fg == Color::Red && alone[*at].symbol() != "r") {
            assert_eq!((alone[at].symbol(), all[at].fg), (all[at].symbol(), Color::Green), "{at}");
            tinted += 1;
        }
        assert!(tinted > 40 && PLOT.positions().filter(|at| all[*at].fg == Color::Blue).count() > 40);
    }

    #[test]
    fn far_lines_and_numbers_that_are_none_cost_nothing() {
        let deep = Bounds { x: [0.5, 0.5 + 1e-9], y: [0.0, 1e-9] };
        let line = [(0.0, 0.0), (1.0, 0.0), (f64::NAN, 0.0), (1e300, -1e300), (0.0, f64::INFINITY)];
        assert!((235..=245).contains(&along(&line, &deep, PLOT, DENSE).len()));
        assert!(along(&line[2..], &deep, PLOT, DENSE).is_empty());
    }
}
