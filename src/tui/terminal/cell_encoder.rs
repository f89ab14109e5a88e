//! Cells encoded in few bytes: on a slow line, one waits for every byte.
//!
//! The usual backend gives a position by row and column, a colour by its number among 256 and each attribute
//! separately; with the many short changes of a chart, that is two thirds of a frame. Here a nearby position is given
//! by the way there, a change of look is a single sequence, and a blank takes the present look. Where curves cross each
//! other, all cells of one look are sent first, then those of the next, if that is shorter than going row by row.

use std::fmt::Write;
use std::ops::Range;

use Color::{Black, Blue, Cyan, DarkGray, Gray, Green, LightBlue, LightCyan, LightGreen, LightMagenta};
use Color::{LightRed, LightYellow, Magenta, Red, White, Yellow};
use ratatui::{
    buffer::Cell,
    layout::Position,
    style::{Color, Modifier},
};

/// The look of characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Ink {
    fg: Color,
    bg: Color,
    modifier: Modifier,
}

/// The look after a reset.
const PLAIN: Ink = Ink { fg: Color::Reset, bg: Color::Reset, modifier: Modifier::empty() };

/// The attributes that show on a blank.
const SEEN_ON_BLANKS: Modifier = Modifier::REVERSED.union(Modifier::UNDERLINED).union(Modifier::CROSSED_OUT);

impl Ink {
    fn of(cell: &Cell) -> Self {
        Self { fg: cell.fg, bg: cell.bg, modifier: cell.modifier }
    }
}

/// Adjacent cells of one row with the same look, by their indices among all cells.
#[derive(Debug, Clone)]
struct CellRun {
    look: usize,
    cells: Range<usize>,
}

/// With more runs of one look than this, they are ordered by rows: the time to find a better order grows with their
/// square.
const MOST_RUNS: usize = 400;

/// The bytes that put `cells`, given row by row, on a screen with this many columns; the look is plain before and
/// after.
pub(super) fn encode(cells: &[(Position, &Cell)], columns: u16) -> Vec<u8> {
    let runs = runs(cells);
    let in_rows = in_order(cells, columns, runs.clone().into_iter());
    let mut by_look: Vec<Vec<CellRun>> = Vec::new();
    for run in runs {
        if by_look.len() <= run.look {
            by_look.resize_with(run.look + 1, Vec::new);
        }
        by_look[run.look].push(run);
    }
    let mut at = None;
    let by_look =
        by_look.into_iter().flat_map(|runs| nearest_first(cells, runs, &mut at)).collect::<Vec<_>>();
    let by_look = in_order(cells, columns, by_look.into_iter());
    if by_look.len() < in_rows.len() { by_look } else { in_rows }
}

/// The cells in runs; a blank takes the look of the cell before it if that makes no difference.
fn runs(cells: &[(Position, &Cell)]) -> Vec<CellRun> {
    let mut inks: Vec<Ink> = Vec::new();
    let mut runs: Vec<CellRun> = Vec::new();
    for (at, (place, cell)) in cells.iter().enumerate() {
        let ink = Ink::of(cell);
        let before = runs.last().map(|run| run.look);
        let shared = before.filter(|look| cell.symbol() == " " && looks_same_blank(inks[*look], ink));
        let look = shared.or_else(|| inks.iter().position(|other| *other == ink)).unwrap_or_else(|| {
            inks.push(ink);
            inks.len() - 1
        });
        match runs.last_mut() {
            Some(run)
                if run.look == look && cells[at - 1].0.y == place.y && cells[at - 1].0.x + 1 == place.x =>
            {
                run.cells.end = at + 1;
            }
            _ => runs.push(CellRun { look, cells: at..at + 1 }),
        }
    }
    runs
}

/// The runs in an order in which each is near the previous one: steep curves are followed down, not crossed in rows.
fn nearest_first(
    cells: &[(Position, &Cell)],
    mut runs: Vec<CellRun>,
    at: &mut Option<Position>,
) -> Vec<CellRun> {
    if runs.len() > MOST_RUNS {
        return runs;
    }
    let mut ordered = Vec::with_capacity(runs.len());
    while !runs.is_empty() {
        let cost = |run: &CellRun| at.map_or(0, |at| bytes_of_way(at, cells[run.cells.start].0));
        // The first of several that are equally near.
        let next = (0..runs.len()).min_by_key(|next| cost(&runs[*next])).unwrap_or(0);
        let run = runs.remove(next);
        let end = cells[run.cells.end - 1].0;
        *at = Some(Position::new(end.x + 1, end.y));
        ordered.push(run);
    }
    ordered
}

fn in_order(cells: &[(Position, &Cell)], columns: u16, runs: impl Iterator<Item = CellRun>) -> Vec<u8> {
    let mut encoder = CellEncoder { frame: Vec::new(), ink: PLAIN, at: None, is_sure: false, columns };
    for (place, cell) in runs.flat_map(|run| &cells[run.cells]) {
        encoder.write(*place, cell);
    }
    encoder.dip(PLAIN);
    encoder.frame
}

/// Encodes cells in any order.
struct CellEncoder {
    frame: Vec<u8>,
    ink: Ink,
    /// Where the next character goes, if known,
    at: Option<Position>,
    /// and whether that is true on every terminal: some show Greek letters and frames twice as wide.
    is_sure: bool,
    columns: u16,
}

impl CellEncoder {
    fn write(&mut self, at: Position, cell: &Cell) {
        self.go(at);
        let ink = Ink::of(cell);
        let symbol = cell.symbol();
        if !(symbol == " " && looks_same_blank(self.ink, ink)) {
            self.dip(ink);
        }
        self.frame.extend_from_slice(symbol.as_bytes());
        // After the last column, terminals differ in where the cursor is.
        let next = Some(Position::new(at.x.saturating_add(1), at.y)).filter(|next| next.x < self.columns);
        (self.at, self.is_sure) = match width(symbol) {
            SymbolWidth::One => (next, self.is_sure),
            SymbolWidth::MostlyOne => (next, false),
            SymbolWidth::Other => (None, false),
        };
    }

    fn go(&mut self, to: Position) {
        let near = match self.at {
            Some(at) if at == to => return,
            Some(at) if self.is_sure => Some(way(at, to)),
            _ => None,
        };
        let mut far = String::new();
        // Writing to a string cannot fail, here and below.
        let _ = write!(far, "\x1b[{};{}H", u32::from(to.y) + 1, u32::from(to.x) + 1);
        if let Some(near) = near.filter(|near| near.len() < far.len()) {
            self.frame.extend_from_slice(near.as_bytes());
        } else {
            self.frame.extend_from_slice(far.as_bytes());
            self.is_sure = true;
        }
    }

    /// Changes the look in one sequence; a reset switches off what has to be switched off.
    fn dip(&mut self, ink: Ink) {
        if ink == self.ink {
            return;
        }
        let mut codes = String::new();
        let mut from = self.ink;
        if ink == PLAIN || !ink.modifier.contains(from.modifier) {
            codes.push_str("0;");
            from = PLAIN;
        }
        // The attributes are in the order of the codes that switch them on, from 1.
        for (modifier, code) in Modifier::all().iter().zip(1_u8..) {
            if ink.modifier.difference(from.modifier).contains(modifier) {
                let _ = write!(codes, "{code};");
            }
        }
        if ink.fg != from.fg {
            color(&mut codes, ink.fg, 0);
        }
        if ink.bg != from.bg {
            color(&mut codes, ink.bg, 10);
        }
        // A reset needs no number.
        let codes = codes.trim_end_matches(';');
        let codes = if codes == "0" { "" } else { codes };
        self.frame.extend_from_slice(format!("\x1b[{codes}m").as_bytes());
        self.ink = ink;
    }
}

/// The steps from one position to another: how many, the byte that makes one, if there is one, and the letter of the
/// sequence that makes all of them. A line feed keeps the column on a terminal in raw mode.
fn steps(from: Position, to: Position) -> [(u16, Option<char>, char); 4] {
    [
        (to.y.saturating_sub(from.y), Some('\n'), 'B'),
        (from.y.saturating_sub(to.y), None, 'A'),
        (from.x.saturating_sub(to.x), Some('\x08'), 'D'),
        (to.x.saturating_sub(from.x), None, 'C'),
    ]
}

/// Up to this many steps are shorter as one byte each.
const BY_BYTES: u16 = 3;

/// The way from one position to another.
fn way(from: Position, to: Position) -> String {
    let mut way = String::new();
    for (count, byte, letter) in steps(from, to) {
        match (count, byte) {
            (0, _) => {}
            (..=BY_BYTES, Some(byte)) => way.extend(std::iter::repeat_n(byte, usize::from(count))),
            (1, None) => way.extend(['\x1b', '[', letter]),
            _ => {
                let _ = write!(way, "\x1b[{count}{letter}");
            }
        }
    }
    way
}

/// The length in bytes of the way from one position to another.
fn bytes_of_way(from: Position, to: Position) -> u32 {
    let cost = |(count, byte, _): (u16, Option<char>, char)| match (count, byte) {
        (0, _) => 0,
        (..=BY_BYTES, Some(_)) => u32::from(count),
        (1, None) => 3,
        _ => 4 + count.ilog10(),
    };
    steps(from, to).into_iter().map(cost).sum()
}

fn looks_same_blank(a: Ink, b: Ink) -> bool {
    let marked = |ink: Ink| ink.modifier.intersects(SEEN_ON_BLANKS);
    a.bg == b.bg && !marked(a) && !marked(b)
}

/// The sixteen colours that every terminal has, in the order of their codes.
const SIXTEEN: [[Color; 8]; 2] = [
    [Black, Red, Green, Yellow, Blue, Magenta, Cyan, Gray],
    [DarkGray, LightRed, LightGreen, LightYellow, LightBlue, LightMagenta, LightCyan, White],
];

/// The code of a colour: the short one for the sixteen. For a background it is `shift` larger.
fn color(codes: &mut String, color: Color, shift: u8) {
    let mut short = (30..38).chain(90..98).zip(SIXTEEN.as_flattened());
    let _ = match color {
        Color::Indexed(index) => write!(codes, "{};5;{index};", 38 + shift),
        Color::Rgb(r, g, b) => write!(codes, "{};2;{r};{g};{b};", 38 + shift),
        // What remains is the terminal's own colour.
        _ => write!(codes, "{};", shift + short.find(|(_, one)| **one == color).map_or(39, |(code, _)| code)),
    };
}

/// How many columns a symbol takes.
enum SymbolWidth {
    One,
    /// One, but two on some terminals that are set up for East Asian text.
    MostlyOne,
    Other,
}

fn width(symbol: &str) -> SymbolWidth {
    let mut chars = symbol.chars();
    match (chars.next(), chars.next()) {
        (Some(' '..='~' | '\u{2800}'..='\u{28ff}'), None) => SymbolWidth::One,
        // Latin, Greek, Cyrillic; punctuation, arrows, mathematics, frames and blocks.
        (Some('\u{a1}'..='\u{2ff}' | '\u{370}'..='\u{482}' | '\u{2010}'..='\u{27bf}'), None) => {
            SymbolWidth::MostlyOne
        }
        _ => SymbolWidth::Other,
    }
}

#[cfg(test)]
mod tests {
    use super::super::cell_encoder::*;
    use ratatui::buffer::Buffer;
    use ratatui::layout::Rect;
    use ratatui::style::Style;

    const COLORS: [Color; 8] = [
        Color::Reset,
        Color::Red,
        Color::DarkGray,
        Color::White,
        Color::LightCyan,
        Color::Black,
        Color::Indexed(200),
        Color::Rgb(1, 2, 3),
    ];

    fn frame(old: &Buffer, new: &Buffer) -> Vec<u8> {
        let cells: Vec<_> =
            old.diff(new).into_iter().map(|(x, y, cell)| (Position::new(x, y), cell)).collect();
        encode(&cells, new.area.width)
    }

    /// What a terminal shows for a colour.
    fn shown(color: Color) -> vt100::Color {
        match color {
            Color::Reset => vt100::Color::Default,
            Color::Black => vt100::Color::Idx(0),
            Color::Red => vt100::Color::Idx(1),
            Color::DarkGray => vt100::Color::Idx(8),
            Color::LightCyan => vt100::Color::Idx(14),
            Color::White => vt100::Color::Idx(15),
            Color::Indexed(index) => vt100::Color::Idx(index),
            Color::Rgb(r, g, b) => vt100::Color::Rgb(r, g, b),
            other => unreachable!("{other}"),
        }
    }

    fn assert_shows(screen: &vt100::Screen, buffer: &Buffer) {
        for at in buffer.area.positions() {
            let (cell, seen) = (&buffer[at], screen.cell(at.y, at.x).unwrap());
            let text = if seen.has_contents() { seen.contents() } else { " " };
            assert_eq!(text, cell.symbol(), "{at}");
            assert_eq!(seen.bgcolor(), shown(cell.bg), "{at}");
            assert_eq!(seen.inverse(), cell.modifier.contains(Modifier::REVERSED), "{at}");
            assert_eq!(seen.underline(), cell.modifier.contains(Modifier::UNDERLINED), "{at}");
            if text != " " {
                assert_eq!(seen.fgcolor(), shown(cell.fg), "{at}");
                assert_eq!(seen.bold(), cell.modifier.contains(Modifier::BOLD), "{at}");
            }
        }
    }

    #[test]
    fn a_terminal_shows_what_was_drawn_whatever_was_there() {
        let mut random = fastrand::Rng::with_seed(7);
        let area = Rect::new(0, 0, 37, 9);
        let [rows, columns] = [area.height, area.width].map(|count| count.try_into().unwrap());
        let mut terminal = vt100::Parser::new(rows, columns, 0);
        let mut old = Buffer::empty(area);
        for _ in 0..300 {
            let mut new = old.clone();
            for _ in 0..random.usize(0..120) {
                let at = Position::new(random.u16(0..area.width), random.u16(0..area.height));
                let symbol = [" ", "x", "δ", "⠿", "─", " ", "~"][random.usize(0..7)];
                let modifiers = [Modifier::BOLD, Modifier::REVERSED, Modifier::UNDERLINED];
                let mut style = Style::new().fg(COLORS[random.usize(0..8)]);
                if random.bool() {
                    style = style.bg(COLORS[random.usize(0..8)]);
                }
                for modifier in modifiers.into_iter().filter(|_| random.u8(0..4) == 0) {
                    style = style.add_modifier(modifier);
                }
                new[at].reset();
                new[at].set_symbol(symbol).set_style(style);
            }
            terminal.process(&frame(&old, &new));
            assert_shows(terminal.screen(), &new);
            old = new;
        }
        // No attribute stays set.
        terminal.process(b"\x1b[HZ");
        let cell = terminal.screen().cell(0, 0).unwrap();
        assert!(cell.fgcolor() == vt100::Color::Default && !cell.bold() && !cell.inverse());
    }

    #[test]
    fn every_attribute_and_colour_has_its_code() {
        let attributes = [
            Modifier::BOLD,
            Modifier::DIM,
            Modifier::ITALIC,
            Modifier::UNDERLINED,
            Modifier::SLOW_BLINK,
            Modifier::RAPID_BLINK,
            Modifier::REVERSED,
            Modifier::HIDDEN,
            Modifier::CROSSED_OUT,
        ];
        assert_eq!(Modifier::all().iter().collect::<Vec<_>>(), attributes);
        let code = |of: Color, shift| {
            let mut codes = String::new();
            color(&mut codes, of, shift);
            codes
        };
        let named = [(Color::Reset, 39), (Color::Black, 30), (Color::Red, 31), (Color::Green, 32)];
        let more = [(Color::Yellow, 33), (Color::Blue, 34), (Color::Magenta, 35), (Color::Cyan, 36)];
        let gray = [(Color::Gray, 37), (Color::DarkGray, 90), (Color::LightRed, 91), (Color::LightGreen, 92)];
        let light = [(Color::LightYellow, 93), (Color::LightBlue, 94), (Color::LightMagenta, 95)];
        let rest = [(Color::LightCyan, 96), (Color::White, 97)];
        for (of, expected) in [&named[..], &more, &gray, &light, &rest].concat() {
            assert_eq!(code(of, 0), format!("{expected};"), "{of}");
            assert_eq!(code(of, 10), format!("{};", expected + 10), "{of}");
        }
        assert_eq!(code(Color::Indexed(200), 10) + &code(Color::Rgb(1, 2, 3), 0), "48;5;200;38;2;1;2;3;");
    }

    #[test]
    fn curves_that_cross_are_sent_one_after_the_other_and_steep_ones_downwards() {
        let area = Rect::new(0, 0, 30, 9);
        let (old, mut new) = (Buffer::empty(area), Buffer::empty(area));
        // Two steep lines, which would take turns if sent in rows.
        for y in 0..8 {
            new[(4 + y / 3, y)].set_symbol("⠿").set_fg(Color::Red);
            new[(20 - y / 3, y)].set_symbol("⠿").set_fg(Color::Indexed(200));
        }
        let text = String::from_utf8(frame(&old, &new)).unwrap();
        assert_eq!(text.matches("\x1b[3").count(), 2, "each colour once: {text:?}");
        assert!(text.matches('\n').count() > 10, "{text:?}");
        let [rows, columns] = [area.height, area.width].map(|count| count.try_into().unwrap());
        let mut terminal = vt100::Parser::new(rows, columns, 0);
        terminal.process(text.as_bytes());
        assert_shows(terminal.screen(), &new);
    }

    #[test]
    fn the_length_of_a_way_is_known_before_it_is_gone() {
        let places = [(0, 0), (1, 0), (3, 2), (0, 3), (12, 7), (250, 60), (99, 61), (9, 10)];
        for (from, to) in places.into_iter().flat_map(|from| places.map(|to| (from, to))) {
            let (from, to) = (Position::from(from), Position::from(to));
            assert_eq!(bytes_of_way(from, to) as usize, way(from, to).len(), "{from} {to}");
        }
    }

    #[test]
    fn the_way_is_short_but_only_where_every_terminal_agrees_on_it() {
        let area = Rect::new(0, 0, 30, 2);
        let old = Buffer::empty(area);
        let mut new = old.clone();
        for (x, symbol, color) in [(3, "a", Color::Green), (5, "b", Color::Green), (9, "δ", Color::Reset)] {
            new[(x, 1)].set_symbol(symbol).set_fg(color);
        }
        new[(12, 1)].set_symbol("c");
        let text = String::from_utf8(frame(&old, &new)).unwrap();
        assert_eq!(text, "\x1b[2;4H\x1b[32ma\x1b[Cb\x1b[3C\x1b[mδ\x1b[2;13Hc");
        assert!(frame(&new, &new).is_empty());
        // A wide character leaves the next position to the terminal.
        new.set_string(0, 0, "字x", Style::new());
        let text = String::from_utf8(frame(&old, &new)).unwrap();
        assert!(text.starts_with("\x1b[1;1H字\x1b[1;3Hx"), "{text:?}");
    }
}
