//! Styles and glyphs. Every role has its style in one table per palette; no meaning is carried by colour alone.

use clap::ValueEnum;
use pulloff_engine::text::greek;
use ratatui::style::Color::{
    Black, Blue, Cyan, DarkGray, Gray, Green, LightBlue, LightCyan, LightGreen, LightMagenta, LightRed,
    LightYellow, Magenta, Red, White, Yellow,
};
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::{Marker, border};

/// Which colours, of the sixteen every terminal has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Palette {
    /// For a dark background.
    #[default]
    Dark,
    /// For a light background.
    Light,
    /// No colour: bold, reverse, underlined.
    Mono,
}

/// What the curves are drawn with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Charts {
    /// Eight dots a cell: the finest, where the font has them.
    #[default]
    Braille,
    /// Half blocks, two a cell: in every font with box drawing.
    Block,
    /// One character a cell.
    Ascii,
}

/// How the screen looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Theme {
    /// The colours.
    pub palette: Palette,
    /// The charts.
    pub charts: Charts,
    /// Only characters below 0x80.
    pub ascii: bool,
}

/// The style of every role.
#[derive(Debug, Clone, Copy)]
pub struct Styles {
    /// A panel's frame,
    pub frame: Style,
    /// that of the selected one,
    pub selected_frame: Style,
    /// and its title.
    pub selected_title: Style,
    /// Headlines.
    pub strong: Style,
    /// Secondary text.
    pub dim: Style,
    /// The selected line.
    pub selection: Style,
    /// Errors and warnings.
    pub error: Style,
    /// Keys in the footer and the help.
    pub key: Style,
    /// The stable parts of the curve; pressures, gaps and potentials.
    pub stable: Style,
    /// The unstable parts.
    pub unstable: Style,
    /// The smooth sphere, axes, crests.
    pub smooth: Style,
    /// The walk.
    pub walk: Style,
    /// Jumps.
    pub jump: Style,
    /// Where a jump lands.
    pub landing: Style,
    /// Energy lost.
    pub lost: Style,
    /// Lines that are no curve: the device, a barrier, what is inadmissible.
    pub aid: Style,
    /// Limit points and other marks.
    pub mark: Style,
    /// The walker.
    pub walker: Style,
    /// The walker in a state of other values.
    pub stray: Style,
    /// The state nearest to the cross-hair.
    pub nearest: Style,
    /// The exact solution and its envelope.
    pub exact: Style,
    /// The pinned curves, by number.
    pub pins: [Style; 6],
}

const fn ink(color: Color) -> Style {
    Style::new().fg(color)
}

const PLAIN: Style = Style::new();
const BOLD: Style = Style::new().add_modifier(Modifier::BOLD);
const REVERSED: Style = Style::new().add_modifier(Modifier::REVERSED);
const REVERSED_BOLD: Style = REVERSED.add_modifier(Modifier::BOLD);
const UNDERLINED: Style = Style::new().add_modifier(Modifier::UNDERLINED);

static DARK: Styles = Styles {
    frame: ink(DarkGray),
    selected_frame: ink(Cyan).add_modifier(Modifier::BOLD),
    selected_title: BOLD,
    strong: BOLD,
    dim: ink(DarkGray),
    selection: REVERSED,
    error: ink(Red).add_modifier(Modifier::BOLD),
    key: ink(Cyan),
    stable: ink(Green),
    unstable: ink(Yellow),
    smooth: ink(DarkGray),
    walk: ink(White),
    jump: ink(Magenta),
    landing: ink(Magenta).add_modifier(Modifier::BOLD),
    lost: ink(Magenta),
    aid: ink(Red),
    mark: ink(Red).add_modifier(Modifier::BOLD),
    walker: ink(Cyan).add_modifier(Modifier::BOLD.union(Modifier::REVERSED)),
    stray: ink(DarkGray).add_modifier(Modifier::REVERSED),
    nearest: ink(Cyan).add_modifier(Modifier::BOLD),
    exact: ink(LightBlue),
    pins: [ink(LightYellow), ink(LightCyan), ink(LightMagenta), ink(LightGreen), ink(LightRed), ink(Gray)],
};

static LIGHT: Styles = Styles {
    frame: ink(DarkGray),
    selected_frame: ink(Blue).add_modifier(Modifier::BOLD),
    selected_title: BOLD,
    strong: BOLD,
    dim: ink(DarkGray),
    selection: REVERSED,
    error: ink(Red).add_modifier(Modifier::BOLD),
    key: ink(Blue),
    stable: ink(Green),
    unstable: ink(Magenta),
    smooth: ink(DarkGray),
    walk: ink(Black),
    jump: ink(Blue),
    landing: ink(Blue).add_modifier(Modifier::BOLD),
    lost: ink(Magenta),
    aid: ink(Red),
    mark: ink(Red).add_modifier(Modifier::BOLD),
    walker: ink(Blue).add_modifier(Modifier::BOLD.union(Modifier::REVERSED)),
    stray: ink(DarkGray).add_modifier(Modifier::REVERSED),
    nearest: ink(Blue).add_modifier(Modifier::BOLD),
    exact: ink(Blue),
    pins: [ink(Cyan), ink(Black), ink(Magenta), ink(Green), ink(Red), ink(DarkGray)],
};

static MONO: Styles = Styles {
    frame: PLAIN,
    selected_frame: BOLD,
    selected_title: REVERSED_BOLD,
    strong: BOLD,
    dim: PLAIN,
    selection: REVERSED,
    error: UNDERLINED.add_modifier(Modifier::BOLD),
    key: UNDERLINED,
    stable: PLAIN,
    unstable: PLAIN,
    smooth: PLAIN,
    walk: BOLD,
    jump: PLAIN,
    landing: BOLD,
    lost: PLAIN,
    aid: PLAIN,
    mark: BOLD,
    walker: REVERSED_BOLD,
    stray: REVERSED,
    nearest: BOLD,
    exact: PLAIN,
    pins: [PLAIN; 6],
};

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
    /// A look; in ASCII the charts are too.
    pub fn new(palette: Palette, charts: Charts, ascii: bool) -> Self {
        Self { palette, charts: if ascii { Charts::Ascii } else { charts }, ascii }
    }

    /// The style of every role.
    pub fn styles(self) -> &'static Styles {
        match self.palette {
            Palette::Dark => &DARK,
            Palette::Light => &LIGHT,
            Palette::Mono => &MONO,
        }
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
        match self.charts {
            Charts::Braille => Marker::Braille,
            Charts::Block | Charts::Ascii => Marker::Custom('/'),
        }
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
        if selected { self.styles().selected_frame } else { self.styles().frame }
    }

    /// A panel's title, selected or not.
    pub fn title(self, selected: bool) -> Style {
        if selected { self.styles().selected_title } else { self.styles().strong }
    }

    /// The selected line.
    pub fn selection(self) -> Style {
        self.styles().selection
    }

    /// Secondary text.
    pub fn dim(self) -> Style {
        self.styles().dim
    }

    /// Headlines.
    pub fn strong(self) -> Style {
        self.styles().strong
    }

    /// Errors and warnings.
    pub fn error(self) -> Style {
        self.styles().error
    }

    /// Keys in the footer and the help.
    pub fn key(self) -> Style {
        self.styles().key
    }
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
