//! Styles and glyphs. Every role has its style in one table per palette; no meaning is carried by colour alone.

use clap::ValueEnum;
use pulloff_engine::text::greek;
use ratatui::buffer::Buffer;
use ratatui::style::Color::{Blue, Cyan, Green, Magenta, Red, Yellow};
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::merge::MergeStrategy;
use ratatui::widgets::Block;

/// Which colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Palette {
    /// For any background, black and white alike.
    #[default]
    Any,
    /// For a dark background.
    Dark,
    /// For a light background.
    Light,
    /// No colour: bold, reverse, underlined.
    Mono,
    /// For a dark background, where the terminal has fewer than 256 colours.
    #[value(skip)]
    FewDark,
    /// The same for a light background.
    #[value(skip)]
    FewLight,
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

const fn ink(color: Color) -> Style {
    Style::new().fg(color)
}

/// One of the 240 colours that are the same on every terminal that has them.
const fn hue(index: u8) -> Style {
    Style::new().fg(Color::Indexed(index))
}

const fn bold(style: Style) -> Style {
    style.add_modifier(Modifier::BOLD)
}

const fn reversed(style: Style) -> Style {
    style.add_modifier(Modifier::REVERSED)
}

const PLAIN: Style = Style::new();
const BOLD: Style = bold(PLAIN);
const REVERSED: Style = reversed(PLAIN);
const UNDERLINED: Style = PLAIN.add_modifier(Modifier::UNDERLINED);

/// The table of styles: a role on each line and a palette in each column.
macro_rules! styles {
    ($(
        $(#[$doc:meta])*
        $role:ident: $of:ty = $any:expr, $dark:expr, $light:expr, $few_dark:expr, $few_light:expr, $mono:expr;
    )*) => {
        /// The style of every role.
        #[derive(Debug, Clone, Copy)]
        pub struct Styles {
            $($(#[$doc])* pub $role: $of,)*
        }

        /// Every colour has a contrast of at least 3 : 1 on black and on white, so that nothing needs to know
        /// the background. The walk has the terminal's own text colour.
        static ANY: Styles = Styles { $($role: $any,)* };

        /// Every colour has a contrast of at least 3 : 1 on black and on dark blue-green. The hues are those of
        /// the figures on paper: no two that are compared are red and green.
        static DARK: Styles = Styles { $($role: $dark,)* };

        /// The same on white and on pale yellow.
        static LIGHT: Styles = Styles { $($role: $light,)* };

        /// With the normal colours of any terminal; their appearance is up to the terminal, so letters identify
        /// curves too.
        static FEW_DARK: Styles = Styles { $($role: $few_dark,)* };

        /// The same on a light background.
        static FEW_LIGHT: Styles = Styles { $($role: $few_light,)* };

        static MONO: Styles = Styles { $($role: $mono,)* };
    };
}

styles! {
    // On any background, dark, light; with few colours on dark, on light; without colours.

    /// A panel's frame,
    frame: Style = hue(244), hue(244), hue(243), PLAIN, PLAIN, PLAIN;
    /// that of the selected one,
    selected_frame: Style =
        bold(hue(33)), bold(hue(81)), bold(hue(25)), bold(ink(Cyan)), bold(ink(Blue)), BOLD;
    /// and its title.
    selected_title: Style = BOLD, BOLD, BOLD, BOLD, BOLD, bold(REVERSED);
    /// Headlines.
    strong: Style = BOLD, BOLD, BOLD, BOLD, BOLD, BOLD;
    /// Secondary text, axes.
    dim: Style = hue(244), hue(246), hue(242), PLAIN, PLAIN, PLAIN;
    /// The selected line.
    selection: Style = REVERSED, REVERSED, REVERSED, REVERSED, REVERSED, REVERSED;
    /// Errors and warnings.
    error: Style =
        bold(hue(167)), bold(hue(209)), bold(hue(124)), bold(ink(Red)), bold(ink(Red)), bold(UNDERLINED);
    /// Keys in the footer and the help.
    key: Style = hue(33), hue(81), hue(25), ink(Cyan), ink(Blue), UNDERLINED;
    /// The curve of the problem; pressures, gaps and potentials.
    curve: Style = hue(32), hue(75), hue(25), ink(Cyan), ink(Blue), PLAIN;
    /// The smooth sphere, crests, other branches.
    smooth: Style = hue(243), hue(249), hue(243), PLAIN, PLAIN, PLAIN;
    /// The walk.
    walk: Style = bold(ink(Color::Reset)), bold(hue(231)), bold(hue(16)), BOLD, BOLD, BOLD;
    /// Jumps.
    jump: Style = hue(133), hue(182), hue(90), ink(Magenta), ink(Magenta), PLAIN;
    /// Where a jump lands.
    landing: Style =
        bold(hue(133)), bold(hue(182)), bold(hue(90)), bold(ink(Magenta)), bold(ink(Magenta)), BOLD;
    /// Energy lost.
    lost: Style = hue(97), hue(139), hue(133), ink(Magenta), ink(Magenta), PLAIN;
    /// Lines that are no curve: the device, a barrier.
    aid: Style = hue(131), hue(174), hue(131), ink(Red), ink(Red), PLAIN;
    /// Inadmissible states.
    warning: Style = hue(167), hue(209), hue(160), bold(ink(Red)), bold(ink(Red)), BOLD;
    /// Events and other marks.
    mark: Style = bold(hue(166)), bold(hue(215)), bold(hue(130)), bold(ink(Yellow)), bold(ink(Red)), BOLD;
    /// The walker.
    walker: Style =
        bold(reversed(hue(31))), bold(reversed(hue(87))), bold(reversed(hue(18))),
        bold(reversed(ink(Cyan))), bold(reversed(ink(Blue))), bold(REVERSED);
    /// The walker in a state of other values.
    stray: Style = reversed(hue(244)), reversed(hue(246)), reversed(hue(242)), REVERSED, REVERSED, REVERSED;
    /// The state nearest to the cross-hair.
    nearest: Style = bold(hue(31)), bold(hue(87)), bold(hue(18)), bold(ink(Cyan)), bold(ink(Blue)), BOLD;
    /// The exact solution,
    exact: Style = hue(136), hue(223), hue(94), ink(Blue), ink(Cyan), PLAIN;
    /// and the envelope of small waves.
    envelope: Style = hue(30), hue(79), hue(23), bold(ink(Blue)), bold(ink(Cyan)), PLAIN;
    /// The loop of loading and unloading.
    loops: Style = hue(62), hue(110), hue(61), PLAIN, PLAIN, PLAIN;
    /// A pull at a rate.
    pull: Style = bold(hue(64)), bold(hue(119)), bold(hue(64)), bold(ink(Green)), bold(ink(Green)), BOLD;
    /// The pinned curves, by number.
    pins: [Style; 6] =
        [hue(202), hue(169), hue(100), hue(29), hue(160), hue(99)],
        [hue(214), hue(176), hue(228), hue(43), hue(203), hue(159)],
        [hue(166), hue(126), hue(58), hue(29), hue(88), hue(30)],
        [ink(Yellow), ink(Magenta), ink(Green), bold(ink(Yellow)), bold(ink(Magenta)), bold(ink(Green))],
        [ink(Yellow), ink(Magenta), ink(Green), bold(ink(Yellow)), bold(ink(Magenta)), bold(ink(Green))],
        [PLAIN; 6];
}

impl Theme {
    /// A theme; in ASCII its charts are ASCII too.
    pub fn new(palette: Palette, charts: Charts, ascii: bool) -> Self {
        Self { palette, charts: if ascii { Charts::Ascii } else { charts }, ascii }
    }

    /// The style of every role.
    pub fn styles(self) -> &'static Styles {
        match self.palette {
            Palette::Any => &ANY,
            Palette::Dark => &DARK,
            Palette::Light => &LIGHT,
            Palette::Mono => &MONO,
            Palette::FewDark => &FEW_DARK,
            Palette::FewLight => &FEW_LIGHT,
        }
    }

    /// `unicode` or `ascii`, whichever the terminal can show.
    pub fn glyph<'a>(self, unicode: &'a str, ascii: &'a str) -> &'a str {
        if self.ascii { ascii } else { unicode }
    }

    /// Text that may contain Unicode, in the form the terminal can show.
    pub fn text(self, text: &str) -> String {
        if !self.ascii {
            return text.to_owned();
        }
        text.chars().map(|c| if c.is_ascii() { c.to_string() } else { transliterate(c).to_owned() }).collect()
    }

    /// Whether colours alone cannot tell curves apart.
    pub fn has_few_colours(self) -> bool {
        !matches!(self.palette, Palette::Any | Palette::Dark | Palette::Light)
    }

    /// What an area is filled with: block elements where charts have more than one character.
    pub fn shade<'a>(self, unicode: &'a str, ascii: &'a str) -> &'a str {
        if self.charts == Charts::Ascii { ascii } else { unicode }
    }

    /// The frame of a panel, which shares its walls with its neighbours.
    pub fn block<'a>(self, selected: bool) -> Block<'a> {
        Block::bordered().border_style(self.frame(selected)).merge_borders(MergeStrategy::Exact)
    }

    /// As much of a line as fits without cutting a word or a number; an ellipsis stands for the rest.
    pub fn whole_words(self, line: &str, room: usize) -> String {
        if line.chars().count() <= room {
            return line.to_owned();
        }
        let rest: String = self.glyph("…", "...").chars().take(room).collect();
        let kept: String = line.chars().take(room.saturating_sub(rest.chars().count())).collect();
        // A word that was cut in the middle is removed.
        let is_whole = line.chars().nth(kept.chars().count()).is_none_or(char::is_whitespace);
        let end = if is_whole { kept.len() } else { kept.rfind(' ').unwrap_or(0) };
        format!("{}{rest}", kept[..end].trim_end())
    }

    /// A label of the parameter table with its Greek letters, or in ASCII with their usual substitutes.
    pub fn symbols(self, label: &str) -> String {
        self.text(&greek(label))
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

    /// Puts what the terminal can show in place of frames, which know their walls by their Unicode, and of whatever else is left.
    pub fn shown_by_terminal(self, buffer: &mut Buffer) {
        if !self.ascii {
            return;
        }
        for cell in &mut buffer.content {
            if let Some(other) = cell.symbol().chars().next().filter(|c| !c.is_ascii()) {
                // A cell has room for one character.
                cell.set_symbol(&transliterate(other)[..1]);
            }
        }
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
        '│' => "|",
        // Corners and crossings of frames.
        '┌'..='╋' => "+",
        'δ' => "d",
        'λ' => "l",
        'γ' => "g",
        'α' => "alpha",
        'μ' => "mu",
        'µ' => "u",
        '₀' => "0",
        'Δ' => "D",
        '²' => "2",
        '′' => "'",
        '→' | '▸' => ">",
        '←' => "<",
        '³' => "^3",
        '⁴' => "^4",
        '…' => "...",
        '·' | '┈' => ".",
        '×' => "X",
        '±' => "+-",
        'χ' => "chi",
        'σ' => "sigma",
        '○' => "O",
        '–' | '—' | '−' | '─' => "-",
        '√' => "sqrt",
        'π' => "pi",
        _ => "?",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The relative luminance of one of the colours from 16 on, as WCAG defines it.
    fn luminance([r, g, b]: [u8; 3]) -> f64 {
        let linear = |x: u8| {
            let x = f64::from(x) / 255.0;
            if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b)
    }

    fn rgb(index: u8) -> [u8; 3] {
        assert!(index >= 16, "{index} is the terminal's own");
        if index >= 232 {
            return [8 + 10 * (index - 232); 3];
        }
        let level = |n: u8| if n == 0 { 0 } else { 55 + 40 * n };
        let at = index - 16;
        [level(at / 36), level(at / 6 % 6), level(at % 6)]
    }

    fn contrast(a: [u8; 3], b: [u8; 3]) -> f64 {
        let [a, b] = [a, b].map(luminance);
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    /// The styles that have a colour, with their names.
    fn coloured(styles: &Styles) -> Vec<(Color, &'static str)> {
        let Styles { frame, selected_frame, dim, error, key, curve, smooth, walk, jump, .. } = *styles;
        let Styles { landing, lost, aid, warning, mark, walker, stray, nearest, .. } = *styles;
        let lines = [
            (styles.exact, "exact"),
            (styles.envelope, "envelope"),
            (styles.loops, "loops"),
            (styles.pull, "pull"),
        ];
        let named = [
            (frame, "frame"),
            (selected_frame, "selected frame"),
            (dim, "dim"),
            (error, "error"),
            (key, "key"),
            (curve, "curve"),
            (smooth, "smooth"),
            (walk, "walk"),
            (jump, "jump"),
            (landing, "landing"),
            (lost, "lost"),
            (aid, "aid"),
            (warning, "warning"),
            (mark, "mark"),
            (walker, "walker"),
            (stray, "stray"),
            (nearest, "nearest"),
        ];
        let pins = styles.pins.into_iter().map(|style| (style, "pin"));
        named
            .into_iter()
            .chain(lines)
            .chain(pins)
            .filter_map(|(style, name)| Some((style.fg?, name)))
            .collect()
    }

    #[test]
    fn every_colour_stands_out_from_the_backgrounds_it_is_for() {
        let dark = [[0, 0, 0], [0x00, 0x2b, 0x36]];
        let light = [[0xff, 0xff, 0xff], [0xfd, 0xf6, 0xe3]];
        let any = [dark[0], light[0]];
        for (styles, backgrounds) in [(&ANY, any), (&DARK, dark), (&LIGHT, light)] {
            for (color, name) in coloured(styles) {
                // The terminal's own text stands out from its background.
                if color == Color::Reset {
                    continue;
                }
                let Color::Indexed(index) = color else { panic!("{name}: {color:?}") };
                for background in backgrounds {
                    let contrast = contrast(rgb(index), background);
                    assert!(contrast >= 3.0, "{name} {index} on {background:?}: {contrast:.2}");
                }
            }
        }
    }

    #[test]
    fn curves_that_are_compared_have_colours_of_their_own() {
        for styles in [&ANY, &DARK, &LIGHT] {
            let own = [styles.curve, styles.smooth, styles.exact, styles.envelope];
            let all: Vec<Option<Color>> = own.iter().chain(&styles.pins).map(|style| style.fg).collect();
            for (at, color) in all.iter().enumerate() {
                assert!(!all[at + 1..].contains(color), "{color:?}");
            }
        }
        // With fewer colours, only the six normal ones and none of the bright ones.
        for styles in [&FEW_DARK, &FEW_LIGHT] {
            for (color, name) in coloured(styles) {
                assert!([Red, Green, Yellow, Blue, Magenta, Cyan].contains(&color), "{name}: {color:?}");
            }
        }
        assert!(coloured(&MONO).is_empty());
    }
}
