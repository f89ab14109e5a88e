//! What can be written to a file: the kinds of export and the endings of their files.

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

    /// What it is.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Curve => "every point of the equilibrium curve",
            Self::Walk => "the states walked by hand",
            Self::Events => "the instabilities listed",
            Self::Script => "what was done, for pulloff run",
            Self::Study => "the study: its values, or in a .toml the sweep that repeats it",
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

    /// What it is.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Screen => "what is on the screen, as text",
            Self::Figure(_) => "the first view for print: zoom, pins and theory with it",
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

/// The name of a file for a document of this name: that of the preset is in it.
pub fn file_for(source: &Source, document: &str, ending: &str) -> String {
    let base = match source {
        Source::User { name, .. } => name.clone(),
        Source::Shipped(shipped) => shipped.name.to_owned(),
        Source::Piped { .. } => "preset".to_owned(),
        Source::File(path) => path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned()),
    };
    format!("{}-{document}.{ending}", sanitize(&base, 60))
}

/// What is seen, for a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Page {
    Screen(String),
    /// A figure as SVG, drawn as its file's ending says.
    Figure(String),
}
