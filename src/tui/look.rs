//! The look of the screen and the use of the mouse, from the command line, the configuration and the environment: one
//! function.
//!
//! The command line overrides `NO_COLOR`, which overrides the configuration, which overrides what the terminal is known
//! to lack:
//!
//! | terminal | theme | charts | ascii |
//! |---|---|---|---|
//! | a locale without UTF-8 (`C`, `POSIX`) | | `ascii` | yes |
//! | TERM `vt100` … `vt520`: no colour | `mono` | `ascii` | yes |
//! | TERM `ansi`, `cygwin`, `ms`: an 8-bit code page | | `ascii` | yes |
//! | TERM `linux`: its font has half blocks and no braille | | `block` | |
//! | any other | `any` | `braille` | |
//!
//! If neither TERM nor `COLORTERM` indicates 256 colours, a theme uses the six normal ones and letters.

use super::terminal::utf8_locale;
use super::theme::{Charts, Palette, Theme};
use crate::config::Config;
use clap::ValueEnum;

/// What the command line or the table `[look]` of a configuration asks for; `None` where it says nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LookFile {
    pub theme: Option<Palette>,
    pub charts: Option<Charts>,
    pub ascii: Option<bool>,
    pub mouse: Option<bool>,
}

impl LookFile {
    /// What a configuration asks for.
    pub fn of(config: &Config) -> Self {
        let word = |row: &str| config.look.iter().find(|(name, _)| *name == row).map(|(_, word)| *word);
        let flag = |row| word(row).map(|word| word == "true");
        Self {
            theme: word("theme").and_then(|word| Palette::from_str(word, false).ok()),
            charts: word("charts").and_then(|word| Charts::from_str(word, false).ok()),
            ascii: flag("ascii"),
            mouse: flag("mouse"),
        }
    }
}

/// What the environment says about the terminal.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Environment {
    /// `NO_COLOR` is set and not empty.
    pub no_color: bool,
    /// `COLORTERM` says that there are many colours.
    pub many_colors: bool,
    /// The locale's characters are UTF-8.
    pub utf8: bool,
    pub term: String,
}

/// How the screen looks, and whether the mouse is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Look {
    pub theme: Palette,
    /// What curves are drawn with.
    pub charts: Charts,
    /// Only characters below 0x80.
    pub ascii: bool,
    /// Whether the mouse is taken from the start.
    pub mouse: bool,
}

/// Terminals without Unicode, by the part of TERM before the first `-`, `.` or `+`: those without colour,
const VIDEO: [&str; 6] = ["vt100", "vt102", "vt220", "vt320", "vt420", "vt520"];
/// and those with a code page.
const CODE_PAGE: [&str; 3] = ["ansi", "cygwin", "ms"];

impl Environment {
    /// The environment of this process.
    pub fn of_process() -> Self {
        Self {
            no_color: std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty()),
            many_colors: std::env::var_os("COLORTERM").is_some_and(|value| !value.is_empty()),
            utf8: utf8_locale(),
            term: std::env::var_os("TERM").unwrap_or_default().to_string_lossy().into_owned(),
        }
    }
}

impl Environment {
    /// Whether the terminal's own name says that it has 256 colours.
    fn has_256(&self) -> bool {
        const NAMES: [&str; 8] =
            ["256", "direct", "kitty", "alacritty", "ghostty", "foot", "wezterm", "konsole"];
        NAMES.iter().any(|name| self.term.contains(name))
    }
}

impl Look {
    /// What `flags` say, or else the environment's `NO_COLOR`, or else `from_file`, or else what the terminal can show.
    pub fn resolve(flags: LookFile, from_file: Option<LookFile>, environment: &Environment) -> Self {
        let file = from_file.unwrap_or_default();
        let family = environment.term.split(['-', '.', '+']).next().unwrap_or_default().to_ascii_lowercase();
        let is_video = VIDEO.contains(&family.as_str());
        let no_unicode = !environment.utf8 || is_video || CODE_PAGE.contains(&family.as_str());
        let ascii = flags.ascii.or(file.ascii).unwrap_or(no_unicode);
        let charts = flags.charts.or(file.charts);
        let usual = if family == "linux" { Charts::Block } else { Charts::Braille };
        let no_color = environment.no_color.then_some(Palette::Mono);
        let palette = flags.theme.or(no_color).or(file.theme);
        let palette = palette.unwrap_or(if is_video { Palette::Mono } else { Palette::Any });
        let has_many = environment.many_colors || environment.has_256();
        let theme = Theme::new(
            match palette {
                Palette::Any | Palette::Dark if !has_many => Palette::FewDark,
                Palette::Light if !has_many => Palette::FewLight,
                palette => palette,
            },
            charts.unwrap_or(usual),
            ascii,
        );
        Self {
            theme: theme.palette,
            charts: theme.charts,
            ascii: theme.ascii,
            mouse: flags.mouse.or(file.mouse).unwrap_or(false),
        }
    }

    /// The theme for drawing.
    pub fn theme(&self) -> Theme {
        Theme::new(self.theme, self.charts, self.ascii)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on(term: &str) -> Environment {
        Environment { no_color: false, many_colors: true, utf8: true, term: term.to_owned() }
    }

    fn resolved(environment: &Environment) -> (Palette, Charts, bool) {
        let look = Look::resolve(LookFile::default(), None, environment);
        (look.theme, look.charts, look.ascii)
    }

    #[test]
    fn the_terminal_decides_where_nobody_says_anything() {
        assert_eq!(resolved(&on("xterm-256color")), (Palette::Any, Charts::Braille, false));
        assert_eq!(resolved(&on("linux")), (Palette::Any, Charts::Block, false));
        assert_eq!(resolved(&on("vt220")), (Palette::Mono, Charts::Ascii, true));
        assert_eq!(resolved(&on("ansi")), (Palette::Any, Charts::Ascii, true));
        let plain = Environment { utf8: false, ..on("xterm") };
        assert_eq!(resolved(&plain), (Palette::Any, Charts::Ascii, true));
        let no_color = Environment { no_color: true, ..on("xterm") };
        assert_eq!(resolved(&no_color), (Palette::Mono, Charts::Braille, false));
    }

    #[test]
    fn flags_win_over_no_color_and_that_over_the_file() {
        let file = Some(LookFile { theme: Some(Palette::Light), mouse: Some(true), ..LookFile::default() });
        let none = LookFile::default();
        let no_color = Environment { no_color: true, ..on("xterm") };
        let look = Look::resolve(none, file, &on("xterm"));
        assert_eq!((look.theme, look.mouse), (Palette::Light, true));
        assert_eq!(Look::resolve(none, file, &no_color).theme, Palette::Mono);
        let flags = LookFile { theme: Some(Palette::Dark), mouse: Some(false), ..none };
        let look = Look::resolve(flags, file, &no_color);
        assert_eq!((look.theme, look.mouse), (Palette::Dark, false));
        // ASCII applies to the charts too, whatever else is requested.
        let ascii = LookFile { ascii: Some(true), charts: Some(Charts::Braille), ..none };
        assert_eq!(Look::resolve(ascii, None, &on("xterm")).charts, Charts::Ascii);
        let charts = LookFile { charts: Some(Charts::Ascii), ..none };
        let look = Look::resolve(charts, None, &on("xterm"));
        assert_eq!((look.charts, look.ascii), (Charts::Ascii, false));
    }

    #[test]
    fn a_file_knows_its_words_and_no_others() {
        let text = "[look]\ntheme = \"mono\"\ncharts = \"block\"\nmouse = true";
        let look = LookFile::of(&crate::config::read("c", text).unwrap());
        let wanted = LookFile {
            theme: Some(Palette::Mono),
            charts: Some(Charts::Block),
            ascii: None,
            mouse: Some(true),
        };
        assert_eq!(look, wanted);
        // Every word allowed in the file is known here.
        for (row, words) in crate::config::LOOK {
            for word in words {
                let config = crate::config::Config { look: vec![(row, *word)], ..Default::default() };
                assert_ne!(LookFile::of(&config), LookFile::default(), "{row} = {word}");
            }
        }
    }
}
