//! What can be written to a file: the kinds of export and the extensions of their files.

use super::view::View;
use crate::print::PictureFormat;
use crate::store::Source;
use pulloff_engine::text::sanitize;
use std::path::Path;

/// What can be exported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExportKind {
    Curve,
    Walk,
    Events,
    Script,
    /// The pull at the rate of the preset.
    Pull,
    /// The study on the screen: its values, or the spec of a sweep that repeats it.
    Study,
}

impl ExportKind {
    /// All, in the order they are offered.
    pub const ALL: [Self; 6] = [Self::Curve, Self::Walk, Self::Events, Self::Script, Self::Pull, Self::Study];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Curve => "curve",
            Self::Walk => "walk",
            Self::Events => "events",
            Self::Script => "script",
            Self::Pull => "pull",
            Self::Study => "study",
        }
    }

    /// What it is.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Curve => "every point of the equilibrium curve",
            Self::Walk => "the states walked by hand",
            Self::Events => "the instabilities listed",
            Self::Script => "what was done, for pulloff run",
            Self::Pull => "the pull at the preset's rate: its moments, or the whole document in a .json",
            Self::Study => "the study: its values, or in a .toml the sweep that repeats it",
        }
    }

    /// The extensions its file may have, the usual one first.
    pub fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Curve | Self::Walk | Self::Events | Self::Pull => &["csv", "json"],
            Self::Script => &["pulloff", "txt"],
            Self::Study => &["csv", "toml"],
        }
    }
}

/// Whether a file name has one of these extensions.
pub fn ends_in(path: &str, endings: &[&str]) -> bool {
    let ending = Path::new(path).extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| endings.iter().any(|known| known.eq_ignore_ascii_case(ending)))
}

/// What is on the screen and can be written to a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Picture {
    /// The screen as text.
    Screen,
    /// A view as a figure for print; without a view, the first one on the screen.
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

    /// What it is.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Screen => "what is on the screen, as text",
            Self::Figure(_) => "the first view for print: zoom, pins and theory with it",
        }
    }

    /// The extensions its file may have, the usual one first.
    pub fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Screen => &["txt"],
            Self::Figure(_) => PictureFormat::ENDINGS,
        }
    }
}

/// The file name for a document of this name; it contains the name of the preset.
pub fn file_for(source: &Source, document: &str, ending: &str) -> String {
    let base = match source {
        Source::User { name, .. } => name.clone(),
        Source::Shipped(shipped) => shipped.name.to_owned(),
        Source::Piped { .. } => "preset".to_owned(),
        Source::File(path) => path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned()),
    };
    format!("{}-{document}.{ending}", sanitize(&base, 60))
}

/// What is on the screen, ready for a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Page {
    Screen(String),
    /// A figure as SVG, converted to the format of the file's extension.
    Figure(String),
}
