//! Jobs on files that the model requests, and how they end.

use super::command::Assignment;
use super::curve::CurveData;
use super::data::{Folder, Foreign};
use super::export::{Export, Page};
use super::journal::Beginning;
use super::node::Node;
use super::studies::StudyData;
use crate::mend::WordedFault;
use crate::store::{Fingerprint, Listing, Loaded, Overwrite, Source};
use pulloff_engine::gap::shapes::ProfileRows;
use pulloff_engine::preset::{Key, Preset};
use pulloff_engine::report::path::EventReport;
use pulloff_engine::report::pull::PullReport;
use std::path::PathBuf;
use std::sync::Arc;

/// The content of a document.
#[derive(Debug, Clone)]
pub enum Content {
    Curve(Arc<CurveData>),
    /// The nodes walked, from the beginning of the walk to the walker, and the curve.
    Walk(Arc<CurveData>, Vec<Node>),
    Events(Arc<CurveData>, Vec<EventReport>),
    /// Where the session began, and the lines that follow.
    Script(Box<Beginning>, Vec<String>),
    /// A pull and its preset.
    Pull(Box<PullReport>, Box<Preset>),
    /// A study and where its preset comes from.
    Study(Arc<StudyData>, Box<Beginning>),
    Page(Page),
}

impl Content {
    /// What it is the content of.
    pub fn export(&self) -> Export {
        match self {
            Self::Curve(_) => Export::Curve,
            Self::Walk(..) => Export::Walk,
            Self::Events(..) => Export::Events,
            Self::Script(..) => Export::Script,
            Self::Pull(..) => Export::Pull,
            Self::Study(..) => Export::Study,
            Self::Page(page) => Export::Page(page.clone()),
        }
    }
}

/// Work on files.
#[derive(Debug, Clone)]
pub enum Job {
    List,
    Names,
    Open {
        name: String,
        assignments: Vec<Assignment>,
    },
    Delete(String),
    /// Give some keys other values, among them that of a file.
    Assign {
        preset: Box<Preset>,
        assignments: Vec<Assignment>,
    },
    Browse {
        /// The key whose file is chosen.
        key: Key,
        /// The folder; without one, the folder of the key's own file.
        folder: Option<PathBuf>,
        /// The folder that names are relative to; without one, the current folder.
        own: Option<PathBuf>,
    },
    Read {
        /// The folder that its name is relative to; without one, the current folder.
        folder: Option<PathBuf>,
        name: String,
    },
    Save {
        source: Source,
        preset: Box<Preset>,
        overwrite: Overwrite,
    },
    SaveAs {
        name: String,
        preset: Box<Preset>,
        /// Whether an existing preset of that name may be replaced.
        replace: bool,
        /// Whether the data of a profile are copied beside it.
        with_data: bool,
        from: Source,
    },
    Export {
        content: Content,
        path: String,
        replace: bool,
    },
}

/// How a job on files ended.
#[derive(Debug, Clone)]
pub enum Done {
    Listed(Box<Listing>),
    /// Names and titles of the presets.
    Named(Vec<[String; 2]>),
    Browsed(Key, Box<Folder>),
    /// A preset with other values for some keys, and those.
    Assigned(Box<Preset>, Vec<Assignment>),
    /// A measured curve whose columns must be named, and why.
    Foreign(Box<Foreign>, WordedFault),
    Read(Arc<ProfileRows>),
    Opened(Box<Loaded>),
    /// A preset was deleted: its file, safe to show, and what is left.
    Deleted(String, Box<Listing>),
    Saved {
        source: Source,
        fingerprint: Fingerprint,
        preset: Box<Preset>,
    },
    /// Somebody else has changed the file: not saved.
    Conflict,
    /// A preset of this name exists: not saved. Says whether its data were to be copied.
    NameTaken(String, bool),
    /// A document is in this file; what it says of itself, such as the units of its columns.
    Exported(String, Option<String>),
    FileExists(Export, String),
    Failed(WordedFault),
}
