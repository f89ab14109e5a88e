//! Colours and glyphs. No meaning is carried by colour alone.

use super::terminal::utf8_locale;
use crate::preset::text::greek;
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::{Marker, border};

/// Looks, for a Unicode or an ASCII terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Theme {
    /// Only characters below 0x80.
    pub ascii: bool,
}

const ASCII_BORDER: border::Set<'static> = border::Set {
    top_left: "+",
    top_right: "+",
    bottom_left: "+",
    bottom_right: "+",
    vertical_left: "|",
    vertical_right: "|",
    horizontal_top: "-",
    horizontal_bottom: "-",
};

impl Theme {
    /// Unicode where the locale says so.
    pub fn of_environment() -> Self {
        Self { ascii: !utf8_locale() }
    }

    /// `unicode` or `ascii`, whichever the terminal can show.
    pub fn glyph<'a>(self, unicode: &'a str, ascii: &'a str) -> &'a str {
        if self.ascii { ascii } else { unicode }
    }

    /// Text that may hold Unicode, as the terminal can show it.
    pub fn text(self, text: &str) -> String {
        if !self.ascii {
            return text.to_owned();
        }
        text.chars().map(|c| if c.is_ascii() { c.to_string() } else { transliterate(c).to_owned() }).collect()
    }

    /// The dots of a hatched area.
    pub fn hatch_marker(self) -> Marker {
        if self.ascii { Marker::Custom('/') } else { Marker::Braille }
    }

    /// A label of the parameter table with its Greek letters, where the terminal can show them.
    pub fn symbols(self, label: &str) -> String {
        if self.ascii { self.text(label) } else { greek(label) }
    }

    /// The frame of a panel.
    pub fn border(self) -> border::Set<'static> {
        if self.ascii { ASCII_BORDER } else { border::PLAIN }
    }

    /// A panel's frame, selected or not.
    pub fn frame(self, selected: bool) -> Style {
        if selected {
            Style::new().fg(Color::Cyan).add_modifier(Modifier::BOLD)
        } else {
            Style::new().fg(Color::DarkGray)
        }
    }

    /// The selected line.
    pub fn selection(self) -> Style {
        Style::new().add_modifier(Modifier::REVERSED)
    }

    /// Secondary text.
    pub fn dim(self) -> Style {
        Style::new().fg(Color::DarkGray)
    }

    /// Headlines.
    pub fn strong(self) -> Style {
        Style::new().add_modifier(Modifier::BOLD)
    }

    /// Errors and warnings.
    pub fn error(self) -> Style {
        Style::new().fg(Color::Red).add_modifier(Modifier::BOLD)
    }

    /// Keys in the footer and the help.
    pub fn key(self) -> Style {
        Style::new().fg(Color::Cyan)
    }
}

/// Colours of the charts, of the sixteen every terminal has.
pub mod ink {
    use ratatui::style::Color;

    /// The stable parts of the curve.
    pub const STABLE: Color = Color::Green;
    /// The unstable parts.
    pub const UNSTABLE: Color = Color::Yellow;
    /// The smooth sphere.
    pub const SMOOTH: Color = Color::DarkGray;
    /// The walk.
    pub const WALK: Color = Color::White;
    /// Jumps.
    pub const JUMP: Color = Color::Magenta;
    /// Limit points and other marks.
    pub const MARK: Color = Color::Red;
    /// The walker.
    pub const WALKER: Color = Color::Cyan;
    /// The exact solution and its envelope.
    pub const EXACT: Color = Color::LightBlue;
    /// Pressures, gaps and potentials.
    pub const BODY: Color = Color::Green;
    /// Energy lost.
    pub const LOST: Color = Color::Magenta;
    /// The pinned curves, by number.
    pub const PINS: [Color; 6] = [
        Color::LightYellow,
        Color::LightCyan,
        Color::LightMagenta,
        Color::LightGreen,
        Color::LightRed,
        Color::Gray,
    ];
}

fn transliterate(c: char) -> &'static str {
    match c {
        'δ' => "d",
        'λ' => "l",
        'γ' => "g",
        'α' => "alpha",
        'μ' => "mu",
        'Δ' => "D",
        '²' => "2",
        '′' => "'",
        '→' | '▸' => ">",
        '←' => "<",
        '·' | '…' => ".",
        '–' | '—' | '−' => "-",
        '√' => "sqrt",
        'π' => "pi",
        _ => "?",
    }
}
