//! What can be written to a file: the kinds of export and the endings of their files.

use super::view::View;
use crate::print::PictureFormat;
use std::path::Path;

/// What can be exported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExportKind {
    Curve,
    Walk,
    Events,
    Script,
    /// The study on the screen: its values, or the spec of a sweep that repeats it.
    Study,
}

impl ExportKind {
    /// All, in the order they are offered.
    pub const ALL: [Self; 5] = [Self::Curve, Self::Walk, Self::Events, Self::Script, Self::Study];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Curve => "curve",
            Self::Walk => "walk",
            Self::Events => "events",
            Self::Script => "script",
            Self::Study => "study",
        }
    }

    /// The endings its file may have, the usual one first.
    pub fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Curve | Self::Walk | Self::Events => &["csv", "json"],
            Self::Script => &["pulloff", "txt"],
            Self::Study => &["csv", "toml"],
        }
    }
}

/// Whether the name of a file has one of these endings.
pub fn ends_in(path: &str, endings: &[&str]) -> bool {
    let ending = Path::new(path).extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| endings.iter().any(|known| known.eq_ignore_ascii_case(ending)))
}

/// What is seen and can be drawn for a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Picture {
    /// The screen as text.
    Screen,
    /// A view as a figure for print; the first on the screen where none is named.
    Figure(Option<View>),
}

impl Picture {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Screen => "screen",
            Self::Figure(_) => "figure",
        }
    }

    /// The endings its file may have, the usual one first.
    pub fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Screen => &["txt"],
            Self::Figure(_) => PictureFormat::ENDINGS,
        }
    }
}

/// What is seen, for a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Page {
    Screen(String),
    /// A figure as SVG, drawn as its file's ending says.
    Figure(String),
}
