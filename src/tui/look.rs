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

/// How the explorer looks: what the command line or the table `[look]` of a configuration asks for; `None` where it says
/// nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::Args)]
#[command(next_help_heading = "Explorer")]
pub struct LookWish {
    /// Colours for a dark or a light background, or none; the variable `NO_COLOR` means mono
    #[arg(long, value_enum)]
    pub theme: Option<Palette>,
    /// What curves are drawn with, for fonts without braille or without blocks
    #[arg(long, value_enum)]
    pub charts: Option<Charts>,
    /// Only ASCII characters, as in a locale without UTF-8
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true", hide_possible_values = true)]
    pub ascii: Option<bool>,
    /// Take the mouse from the start; the command mouse takes it and gives it back
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true", hide_possible_values = true)]
    pub mouse: Option<bool>,
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

/// How the screen looks, and whether the mouse is taken from the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Look {
    pub theme: Theme,
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

    /// Whether the terminal's own name says that it has 256 colours.
    fn has_256(&self) -> bool {
        const NAMES: [&str; 8] =
            ["256", "direct", "kitty", "alacritty", "ghostty", "foot", "wezterm", "konsole"];
        NAMES.iter().any(|name| self.term.contains(name))
    }
}

impl Look {
    /// What `flags` say, or else the environment's `NO_COLOR`, or else `file`, or else what the terminal can show.
    pub fn resolve(flags: LookWish, file: LookWish, environment: &Environment) -> Self {
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
        Self { theme, mouse: flags.mouse.or(file.mouse).unwrap_or(false) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on(term: &str) -> Environment {
        Environment { no_color: false, many_colors: true, utf8: true, term: term.to_owned() }
    }

    fn resolved(environment: &Environment) -> (Palette, Charts, bool) {
        let theme = Look::resolve(LookWish::default(), LookWish::default(), environment).theme;
        (theme.palette, theme.charts, theme.ascii)
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
        let file = LookWish { theme: Some(Palette::Light), mouse: Some(true), ..LookWish::default() };
        let none = LookWish::default();
        let no_color = Environment { no_color: true, ..on("xterm") };
        let look = Look::resolve(none, file, &on("xterm"));
        assert_eq!((look.theme.palette, look.mouse), (Palette::Light, true));
        assert_eq!(Look::resolve(none, file, &no_color).theme.palette, Palette::Mono);
        let flags = LookWish { theme: Some(Palette::Dark), mouse: Some(false), ..none };
        let look = Look::resolve(flags, file, &no_color);
        assert_eq!((look.theme.palette, look.mouse), (Palette::Dark, false));
        // ASCII applies to the charts too, whatever else is requested.
        let ascii = LookWish { ascii: Some(true), charts: Some(Charts::Braille), ..none };
        assert_eq!(Look::resolve(ascii, none, &on("xterm")).theme.charts, Charts::Ascii);
        let charts = LookWish { charts: Some(Charts::Ascii), ..none };
        let look = Look::resolve(charts, none, &on("xterm"));
        assert_eq!((look.theme.charts, look.theme.ascii), (Charts::Ascii, false));
    }
}
