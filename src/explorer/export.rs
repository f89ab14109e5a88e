//! What can be written to a file: the kinds of export and the extensions of their files.

use super::view::View;
use crate::print::PictureFormat;
use crate::store::Source;
use pulloff_engine::text::sanitize;
use std::path::Path;

/// What can be exported.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Export {
    Curve,
    Walk,
    Events,
    Script,
    /// The pull at the rate of the preset.
    Pull,
    /// The study on the screen: its values, or the spec of a sweep that repeats it.
    Study,
    /// A view as a figure for print; without a view, the first one on the screen.
    Figure(Option<View>),
    /// The screen as text.
    Screen,
    /// A figure or the screen, as it was drawn.
    Page(Page),
}

impl Export {
    /// All, in the order they are offered.
    pub const ALL: [Self; 8] = [
        Self::Curve,
        Self::Walk,
        Self::Events,
        Self::Script,
        Self::Pull,
        Self::Study,
        Self::Figure(None),
        Self::Screen,
    ];

    /// Its name.
    pub fn name(&self) -> &'static str {
        self.row().0
    }

    /// What it is.
    pub fn meaning(&self) -> &'static str {
        self.row().1
    }

    /// The extensions its file may have, the usual one first.
    pub fn endings(&self) -> &'static [&'static str] {
        self.row().2
    }

    fn row(&self) -> (&'static str, &'static str, &'static [&'static str]) {
        const TABLE: &[&str] = &["csv", "json"];
        match self {
            Self::Curve => ("curve", "every point of the equilibrium curve", TABLE),
            Self::Walk => ("walk", "the states walked by hand", TABLE),
            Self::Events => ("events", "the events of the path; jumps off it are in walk", TABLE),
            Self::Script => ("script", "what was done, for pulloff run", &["pulloff", "txt"]),
            Self::Pull => {
                let meaning = "the pull at the preset's rate: its moments, or the whole document in a .json";
                ("pull", meaning, TABLE)
            }
            Self::Study => {
                let meaning = "the study: its values, or in a .toml the sweep that repeats it";
                ("study", meaning, &["csv", "toml"])
            }
            Self::Figure(_) | Self::Page(Page::Figure(_)) => {
                let meaning = "the first view for print: zoom, pins and theory with it";
                ("figure", meaning, PictureFormat::ENDINGS)
            }
            Self::Screen | Self::Page(Page::Screen(_)) => {
                ("screen", "what is on the screen, as text", &["txt"])
            }
        }
    }
}

/// Whether a file name has one of these extensions.
pub fn ends_in(path: &str, endings: &[&str]) -> bool {
    let ending = Path::new(path).extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| endings.iter().any(|known| known.eq_ignore_ascii_case(ending)))
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
