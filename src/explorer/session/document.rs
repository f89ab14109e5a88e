//! A session as JSON.
//!
//! What a list of sessions shows comes first, so it can be read without understanding the rest.

use super::aside::{Aside, SavedFile};
use super::places::SavedPlaces;
use super::problems::{Collector, Problems, Restored};
use super::snapshot::{SessionLook, Snapshot};
use super::tree::{self, SavedNode};
use super::unreadable::{FORMAT, Unreadable};
use crate::explorer::journal::KeptJournal;
use crate::store::{Fingerprint, Source};
use pulloff_engine::quasistatic::State;
use serde::{Deserialize, Serialize};
use std::convert::Infallible;
use std::sync::Arc;

/// How a session ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ended {
    /// Still running, or its program was killed.
    Running,
    Quit,
    /// The connection dropped, or a signal or a fault ended the program.
    Dropped,
}

impl Ended {
    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Quit => "quit",
            Self::Dropped => "dropped",
        }
    }
}

/// What a list shows of a session.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SessionSummary {
    pub format: u32,
    pub program_version: String,
    pub ended: Ended,
    /// When it was written, in seconds since 1970.
    pub saved_at: u64,
    pub preset_name: String,
    pub title: String,
    pub steps: usize,
    /// Whether its preset has changes that are saved in no file.
    pub unsaved: bool,
}

/// A session.
#[derive(Debug, Serialize, Deserialize)]
pub struct Document {
    /// It comes first in the file.
    #[serde(flatten)]
    pub summary: SessionSummary,
    /// The walker's state in the user's units, for people who read the file.
    pub walker: Option<State>,
    source: Source,
    fingerprint: Option<Fingerprint>,
    /// The numbers of the current preset and of the saved one.
    preset: usize,
    saved: usize,
    look: SessionLook,
    pins: Vec<(usize, usize)>,
    journal: KeptJournal<usize>,
    /// The number of the preset from which the values were fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    fitted_from: Option<usize>,
    problems: Problems,
    settled: bool,
    cursor: Option<usize>,
    nodes: Vec<SavedNode>,
    #[serde(default)]
    undo: SavedPlaces,
}

impl Document {
    /// The document of a snapshot, made `saved_at` seconds after 1970.
    pub fn new(snapshot: &Snapshot, ended: Ended, saved_at: u64) -> Self {
        let mut problems = Collector::default();
        let preset = problems.preset(&snapshot.preset);
        let saved = problems.preset(&snapshot.saved);
        let fitted_from = snapshot.fitted_from.as_ref().map(|preset| problems.preset(preset));
        let pins = snapshot.pins.iter().map(|(number, preset)| (*number, problems.preset(preset))).collect();
        let Ok(journal) = snapshot.journal.map(|preset| Ok::<_, Infallible>(problems.preset(preset)));
        let nodes = tree::nodes(&snapshot.history, |setting| problems.setting(setting));
        let undo = SavedPlaces::of(&snapshot.undo, &snapshot.history, |preset| problems.preset(preset));
        let summary = SessionSummary {
            format: FORMAT,
            program_version: env!("CARGO_PKG_VERSION").to_owned(),
            ended,
            saved_at,
            preset_name: snapshot.source.shown(),
            title: snapshot.preset.title.clone(),
            steps: snapshot.steps(),
            unsaved: snapshot.preset != snapshot.saved,
        };
        let walker = snapshot.history.current();
        Self {
            summary,
            walker: walker.map(|node| node.state.in_units(node.setting.units())),
            source: snapshot.source.clone(),
            fingerprint: snapshot.fingerprint,
            preset,
            saved,
            look: snapshot.look.clone(),
            pins,
            journal,
            fitted_from,
            problems: problems.finish(),
            settled: snapshot.settled,
            cursor: snapshot.history.cursor(),
            nodes,
            undo,
        }
    }

    /// Gives what presets take from files to `keep`, which returns the hash of the file it is in. The document then
    /// refers to it by that hash.
    /// Errors: Those of `keep`.
    pub fn lay_aside<E>(&mut self, mut keep: impl FnMut(&Aside) -> Result<String, E>) -> Result<(), E> {
        for file in &mut self.problems.files {
            if let Some(held) = &file.held {
                file.data = Some(keep(held)?);
            }
        }
        Ok(())
    }

    /// The inverse: `fetch` gives the content of a file, which it finds by its hash.
    /// Errors: Those of `fetch`.
    pub fn take_back<E>(
        &mut self,
        mut fetch: impl FnMut(&SavedFile, &str) -> Result<Aside, E>,
    ) -> Result<(), E> {
        for file in &mut self.problems.files {
            if let Some(hash) = &file.data {
                file.held = Some(fetch(file, hash)?);
            }
        }
        Ok(())
    }

    /// As JSON, in one line. It contains what presets take from files, unless that is laid aside.
    pub fn json(mut self) -> serde_json::Result<Vec<u8>> {
        self.problems.files.iter_mut().for_each(SavedFile::lay_within);
        let mut bytes = serde_json::to_vec(&self)?;
        bytes.push(b'\n');
        Ok(bytes)
    }

    /// Reads a document.
    pub fn read(bytes: &[u8]) -> Result<Self, Unreadable> {
        check_format(bytes)?;
        serde_json::from_slice(bytes).map_err(|error| damaged(&error))
    }

    /// The number of pinned curves.
    pub fn pins(&self) -> usize {
        self.pins.len()
    }

    /// Its snapshot; no problem is prepared and no file is read.
    /// Errors: Something in it is inconsistent, or the rows of a profile were not taken back.
    pub fn snapshot(self) -> Result<Snapshot, Unreadable> {
        let Restored { presets, settings } = self.problems.back()?;
        let preset = |number: usize| {
            let found = presets.get(number).cloned();
            found.ok_or_else(|| Unreadable::Damaged("a preset is missing".to_owned()))
        };
        let journal = self.journal.map(|number| preset(*number).map(Arc::new))?;
        let history = tree::history(self.nodes, self.cursor, &settings)
            .filter(|history| journal.is_whole() && history.nodes().all(|node| journal.has(node.trace)))
            .ok_or_else(|| Unreadable::Damaged("the states do not form a walk".to_owned()))?;
        let pins = self.pins.iter().map(|(number, at)| Ok((*number, preset(*at)?)));
        let undo = self.undo.back(preset)?;
        Ok(Snapshot {
            session: 0,
            preset: preset(self.preset)?,
            saved: preset(self.saved)?,
            source: self.source,
            fingerprint: self.fingerprint,
            history,
            undo,
            settled: self.settled,
            pins: pins.collect::<Result<_, Unreadable>>()?,
            look: self.look,
            journal,
            fitted_from: self.fitted_from.map(preset).transpose()?,
        })
    }
}

fn damaged(error: &serde_json::Error) -> Unreadable {
    Unreadable::Damaged(error.to_string())
}

/// What a list shows of a document.
pub fn summary(bytes: &[u8]) -> Result<SessionSummary, Unreadable> {
    check_format(bytes)?;
    serde_json::from_slice(bytes).map_err(|error| damaged(&error))
}

/// Rejects a document of another format before reading anything else of it.
fn check_format(bytes: &[u8]) -> Result<(), Unreadable> {
    /// What every version has.
    #[derive(Deserialize)]
    struct Format {
        format: u32,
        program_version: String,
    }
    let Format { format, program_version } =
        serde_json::from_slice(bytes).map_err(|error| damaged(&error))?;
    if format != FORMAT {
        let program = pulloff_engine::text::sanitize(&program_version, 40);
        return Err(Unreadable::Format { format, program });
    }
    Ok(())
}
