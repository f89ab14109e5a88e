//! Jobs on files that the model asks for, and how they end.

use super::command::Assignment;
use super::curve::CurveData;
use super::data::Folder;
use super::export::{ExportKind, Page};
use super::journal::Start;
use super::node::Node;
use crate::mend::Reason;
use crate::store::{Fingerprint, Listing, Loaded, Overwrite, Source};
use pulloff_engine::gap::shapes::Rows;
use pulloff_engine::preset::Preset;
use pulloff_engine::report::unload::EventReport;
use std::path::PathBuf;
use std::sync::Arc;

/// What is written into a document.
#[derive(Debug, Clone)]
pub enum Content {
    /// The curve.
    Curve(Arc<CurveData>),
    /// The nodes walked, from where the walk began to the walker, and the curve.
    Walk(Arc<CurveData>, Vec<Node>),
    /// The events shown, and the curve.
    Events(Arc<CurveData>, Vec<EventReport>),
    /// Where the session began, and the lines that follow.
    Script(Box<Start>, Vec<String>),
}

impl Content {
    /// Its document.
    pub fn document(&self) -> ExportKind {
        match self {
            Self::Curve(_) => ExportKind::Curve,
            Self::Walk(..) => ExportKind::Walk,
            Self::Events(..) => ExportKind::Events,
            Self::Script(..) => ExportKind::Script,
        }
    }
}

/// Work on files.
#[derive(Debug, Clone)]
pub enum Job {
    /// List all presets.
    List,
    /// The names of all presets.
    Names,
    /// Open a preset.
    Open {
        /// Its name or path.
        name: String,
        /// Other values for some of its keys.
        assignments: Vec<Assignment>,
    },
    /// Delete a preset of the person's own.
    Delete(String),
    /// Give some keys other values, that of a file among them.
    Assign {
        /// The preset.
        preset: Box<Preset>,
        /// The values.
        assignments: Vec<Assignment>,
    },
    /// List the profiles of a folder.
    Browse {
        /// The folder; without one, the profile's own.
        folder: Option<PathBuf>,
        /// The folder that names are relative to; the current one without it.
        own: Option<PathBuf>,
    },
    /// Read a profile.
    Read {
        /// The folder that its name is relative to; the current one without it.
        folder: Option<PathBuf>,
        /// Its name.
        name: String,
    },
    /// Save back to the file it came from.
    Save {
        /// The file.
        source: Source,
        /// The preset.
        preset: Box<Preset>,
        /// What may be replaced.
        overwrite: Overwrite,
    },
    /// Save under a name.
    SaveAs {
        /// The name.
        name: String,
        /// The preset.
        preset: Box<Preset>,
        /// Whether a preset of that name may be replaced.
        replace: bool,
        /// Whether the data of a profile are copied beside it.
        with_data: bool,
        /// Where it was read from.
        from: Source,
    },
    /// Write a page.
    Write {
        /// The page.
        page: Page,
        /// The path as typed.
        path: String,
        /// Whether a file there may be replaced.
        replace: bool,
    },
    /// Export a document.
    Export {
        /// Which, and what is in it.
        content: Content,
        /// The path as typed.
        path: String,
        /// Whether a file there may be replaced.
        replace: bool,
    },
}

/// How a job on files ended.
#[derive(Debug, Clone)]
pub enum Done {
    /// The presets.
    Listed(Box<Listing>),
    /// The names of the presets.
    Named(Vec<String>),
    /// The profiles of a folder.
    Browsed(Box<Folder>),
    /// A preset got other values.
    Assigned(Box<Preset>),
    /// A profile was read.
    Read(Arc<Rows>),
    /// A preset was opened.
    Opened(Box<Loaded>),
    /// A preset was deleted: its file, safe to show, and what is left.
    Deleted(String, Box<Listing>),
    /// The preset was saved.
    Saved {
        /// Where.
        source: Source,
        /// How the file is now.
        fingerprint: Fingerprint,
        /// What was saved.
        preset: Box<Preset>,
    },
    /// The file was changed by somebody else: not saved.
    Conflict,
    /// A preset of this name exists: not saved; whether its data were to be copied.
    NameTaken(String, bool),
    /// An export was written.
    Exported(String),
    /// A file of this name exists: not written.
    FileExists(ExportKind, String),
    /// The same of this page, at this path.
    PageExists(Page, String),
    /// It failed; nothing was changed.
    Failed(Reason),
}
