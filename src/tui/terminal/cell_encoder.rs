//! Cells as bytes, few of them: every byte is waited for on a slow line.
//!
//! The usual backend names a place by row and column, a colour by its number among 256 and each attribute alone; with
//! the many short changes of a chart that is two thirds of a frame. Here a place further right in the row is named by the
//! way there, what changes in the look is one sequence, and a blank takes the look that is there.

use std::fmt::Write;

use ratatui::{
    buffer::Cell,
    layout::Position,
    style::{Color, Modifier},
};

/// How characters look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Ink {
    fg: Color,
    bg: Color,
    modifier: Modifier,
}

/// As after a reset.
const PLAIN: Ink = Ink { fg: Color::Reset, bg: Color::Reset, modifier: Modifier::empty() };

/// The attributes that show on a blank.
const SEEN_ON_BLANKS: Modifier = Modifier::REVERSED.union(Modifier::UNDERLINED).union(Modifier::CROSSED_OUT);

/// Encodes the cells of one frame, which begins and ends with plain attributes.
pub(super) struct CellEncoder<'a> {
    frame: &'a mut Vec<u8>,
    ink: Ink,
    /// Where the next character goes, if that is known,
    at: Option<Position>,
    /// and whether that holds on any terminal: some show Greek letters and frames twice as wide.
    is_sure: bool,
}

impl<'a> CellEncoder<'a> {
    /// An encoder that does not know where the cursor is.
    pub(super) fn new(frame: &'a mut Vec<u8>) -> Self {
        Self { frame, ink: PLAIN, at: None, is_sure: false }
    }

    pub(super) fn write(&mut self, at: Position, cell: &Cell) {
        self.go(at);
        let ink = Ink { fg: cell.fg, bg: cell.bg, modifier: cell.modifier };
        let symbol = cell.symbol();
        if !(symbol == " " && looks_same_blank(self.ink, ink)) {
            self.dip(ink);
        }
        self.frame.extend_from_slice(symbol.as_bytes());
        let next = Position::new(at.x.saturating_add(1), at.y);
        (self.at, self.is_sure) = match width(symbol) {
            Width::One => (Some(next), self.is_sure),
            Width::MostlyOne => (Some(next), false),
            Width::Other => (None, false),
        };
    }

    pub(super) fn end(mut self) {
        self.dip(PLAIN);
    }

    fn go(&mut self, to: Position) {
        match self.at {
            Some(at) if at == to => {}
            Some(at) if self.is_sure && at.y == to.y && at.x < to.x => match to.x - at.x {
                1 => self.say(format_args!("\x1b[C")),
                columns => self.say(format_args!("\x1b[{columns}C")),
            },
            _ => {
                self.say(format_args!("\x1b[{};{}H", u32::from(to.y) + 1, u32::from(to.x) + 1));
                self.is_sure = true;
            }
        }
    }

    /// Changes the look, in one sequence; what is to be switched off is so by a reset.
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
        for (modifier, code) in MODIFIERS {
            if ink.modifier.difference(from.modifier).contains(modifier) {
                // Writing to a string cannot fail, here and below.
                let _ = write!(codes, "{code};");
            }
        }
        if ink.fg != from.fg {
            color(&mut codes, ink.fg, 0);
        }
        if ink.bg != from.bg {
            color(&mut codes, ink.bg, 10);
        }
        self.say(format_args!("\x1b[{}m", codes.trim_end_matches(';')));
        self.ink = ink;
    }

    fn say(&mut self, text: std::fmt::Arguments<'_>) {
        // Writing to memory cannot fail.
        let _ = std::io::Write::write_fmt(self.frame, text);
    }
}

/// The codes that switch attributes on.
const MODIFIERS: [(Modifier, u8); 9] = [
    (Modifier::BOLD, 1),
    (Modifier::DIM, 2),
    (Modifier::ITALIC, 3),
    (Modifier::UNDERLINED, 4),
    (Modifier::SLOW_BLINK, 5),
    (Modifier::RAPID_BLINK, 6),
    (Modifier::REVERSED, 7),
    (Modifier::HIDDEN, 8),
    (Modifier::CROSSED_OUT, 9),
];

fn looks_same_blank(a: Ink, b: Ink) -> bool {
    let marked = |ink: Ink| ink.modifier.intersects(SEEN_ON_BLANKS);
    a.bg == b.bg && !marked(a) && !marked(b)
}

/// The code of a colour: of the sixteen that every terminal has the short one. A background's is `shift` larger.
fn color(codes: &mut String, color: Color, shift: u8) {
    let short = match color {
        Color::Reset => 39,
        Color::Black => 30,
        Color::Red => 31,
        Color::Green => 32,
        Color::Yellow => 33,
        Color::Blue => 34,
        Color::Magenta => 35,
        Color::Cyan => 36,
        Color::Gray => 37,
        Color::DarkGray => 90,
        Color::LightRed => 91,
        Color::LightGreen => 92,
        Color::LightYellow => 93,
        Color::LightBlue => 94,
        Color::LightMagenta => 95,
        Color::LightCyan => 96,
        Color::White => 97,
        Color::Indexed(index) => {
            let _ = write!(codes, "{};5;{index};", 38 + shift);
            return;
        }
        Color::Rgb(r, g, b) => {
            let _ = write!(codes, "{};2;{r};{g};{b};", 38 + shift);
            return;
        }
    };
    let _ = write!(codes, "{};", short + shift);
}

/// How many columns a symbol takes.
enum Width {
    One,
    /// One, but two on some that are set up for East Asian text.
    MostlyOne,
    Other,
}

fn width(symbol: &str) -> Width {
    let mut chars = symbol.chars();
    match (chars.next(), chars.next()) {
        (Some(' '..='~' | '\u{2800}'..='\u{28ff}'), None) => Width::One,
        // Latin, Greek, Cyrillic; punctuation, arrows, mathematics, frames and blocks.
        (Some('\u{a1}'..='\u{2ff}' | '\u{370}'..='\u{482}' | '\u{2010}'..='\u{27bf}'), None) => {
            Width::MostlyOne
        }
        _ => Width::Other,
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
        let mut bytes = Vec::new();
        let mut encoder = CellEncoder::new(&mut bytes);
        for (x, y, cell) in old.diff(new) {
            encoder.write(Position::new(x, y), cell);
        }
        encoder.end();
        bytes
    }

    /// What a terminal shows of a colour.
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
        // Nothing else is left set.
        terminal.process(b"\x1b[HZ");
        let cell = terminal.screen().cell(0, 0).unwrap();
        assert!(cell.fgcolor() == vt100::Color::Default && !cell.bold() && !cell.inverse());
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
        assert_eq!(text, "\x1b[2;4H\x1b[32ma\x1b[Cb\x1b[3C\x1b[0mδ\x1b[2;13Hc");
        assert!(frame(&new, &new).is_empty());
        // A wide character leaves the place to the terminal.
        new.set_string(0, 0, "字x", Style::new());
        let text = String::from_utf8(frame(&old, &new)).unwrap();
        assert!(text.starts_with("\x1b[1;1H字\x1b[1;3Hx"), "{text:?}");
    }
}
