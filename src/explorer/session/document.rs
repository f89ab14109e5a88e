//! A session as JSON.
//!
//! What a list of sessions shows comes first, so it can be read without understanding the rest.

use super::number::{Real, floats, reals};
use super::places::SavedPlaces;
use super::problems::{Aside, Collector, Problems, Restored, SavedPath};
use super::snapshot::{SessionLook, Snapshot};
use super::tree::{self, SavedNode};
use super::unreadable::{FORMAT, Unreadable};
use crate::explorer::journal::{Beginning, KeptJournal, Replay};
use crate::store::{Fingerprint, Source, shipped};
use pulloff_engine::preset::Preset;
use serde::{Deserialize, Serialize};
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
    // The fields of the summary come first in the file.
    format: u32,
    program_version: String,
    ended: Ended,
    saved_at: u64,
    preset_name: String,
    title: String,
    steps: usize,
    unsaved: bool,
    /// δ, P and s of the walker in the user's units, for people who read the file.
    walker: Option<[Real; 3]>,
    source: PresetOrigin,
    fingerprint: Option<Fingerprint>,
    /// The numbers of the current preset and of the saved one.
    preset: usize,
    saved: usize,
    look: SessionLook,
    pins: Vec<(usize, usize)>,
    journal: SavedScript,
    problems: Problems,
    settled: bool,
    cursor: Option<usize>,
    nodes: Vec<SavedNode>,
    #[serde(default)]
    undo: SavedPlaces,
}

/// The script that leads to where the session is.
#[derive(Debug, Serialize, Deserialize)]
struct SavedScript {
    lines: Vec<String>,
    /// Where the walk began: the source of its preset, and the number of the preset.
    start: Option<(PresetOrigin, usize)>,
    /// What a replay has set at the end: the number of the preset, the direction, the step length.
    replay: Option<(usize, bool, Real)>,
    steps: Option<usize>,
    broken: Option<String>,
}

impl SavedScript {
    fn of(kept: &KeptJournal, problems: &mut Collector) -> Self {
        let start = kept.start.as_ref();
        let replay = kept.replay.as_ref();
        Self {
            lines: kept.lines.to_vec(),
            start: start.map(|start| (PresetOrigin::of(&start.source), problems.preset(&start.preset))),
            replay: replay.map(|at| (problems.preset(&at.preset), at.inward, Real(at.length))),
            steps: kept.steps,
            broken: kept.broken.clone(),
        }
    }

    fn back(self, preset: impl Fn(usize) -> Result<Preset, Unreadable>) -> Result<KeptJournal, Unreadable> {
        let start =
            self.start.map(|(source, at)| Ok(Beginning { source: source.back()?, preset: preset(at)? }));
        let replay =
            self.replay.map(|(at, inward, Real(length))| Ok(Replay { preset: preset(at)?, inward, length }));
        Ok(KeptJournal {
            lines: Arc::new(self.lines),
            start: start.transpose()?,
            replay: replay.transpose()?,
            steps: self.steps,
            broken: self.broken,
        })
    }
}

/// Where a preset came from.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum PresetOrigin {
    Shipped(String),
    User { name: String, path: SavedPath },
    File(SavedPath),
    Piped { name: String, text: String },
}

impl PresetOrigin {
    fn of(source: &Source) -> Self {
        match source {
            Source::Shipped(shipped) => Self::Shipped(shipped.name.to_owned()),
            Source::User { name, path } => Self::User { name: name.clone(), path: SavedPath::of(path) },
            Source::File(path) => Self::File(SavedPath::of(path)),
            Source::Piped { name, text } => Self::Piped { name: name.clone(), text: text.to_string() },
        }
    }

    fn back(self) -> Result<Source, Unreadable> {
        Ok(match self {
            // If a preset no longer comes with the program, only its name is missing.
            Self::Shipped(name) => {
                let known = shipped::find(&name).or_else(|| shipped::find(shipped::DEFAULT));
                Source::Shipped(known.ok_or_else(|| Unreadable::Damaged(format!("no preset {name}")))?)
            }
            Self::User { name, path } => Source::User { name, path: path.path() },
            Self::File(path) => Source::File(path.path()),
            Self::Piped { name, text } => Source::Piped { name, text: text.into() },
        })
    }
}

impl Document {
    /// The document of a snapshot, made `saved_at` seconds after 1970. It contains the rows of the profiles.
    pub fn new(snapshot: &Snapshot, ended: Ended, saved_at: u64) -> Self {
        let mut problems = Collector::default();
        let preset = problems.preset(&snapshot.preset);
        let saved = problems.preset(&snapshot.saved);
        let pins = snapshot.pins.iter().map(|(number, preset)| (*number, problems.preset(preset))).collect();
        let journal = SavedScript::of(&snapshot.journal, &mut problems);
        let nodes = tree::nodes(&snapshot.history, |setting| problems.setting(setting));
        let undo = SavedPlaces::of(&snapshot.undo, &snapshot.history, |preset| problems.preset(preset));
        let walker = snapshot.history.current().map(|node| node.state.in_units(node.setting.units()));
        Self {
            format: FORMAT,
            program_version: env!("CARGO_PKG_VERSION").to_owned(),
            ended,
            saved_at,
            preset_name: snapshot.source.shown(),
            title: snapshot.preset.title.clone(),
            steps: snapshot.steps(),
            unsaved: snapshot.preset != snapshot.saved,
            walker: walker.map(|state| reals([state.approach, state.force, state.contact_radius])),
            source: PresetOrigin::of(&snapshot.source),
            fingerprint: snapshot.fingerprint,
            preset,
            saved,
            look: snapshot.look.clone(),
            pins,
            journal,
            problems: problems.finish(),
            settled: snapshot.settled,
            cursor: snapshot.history.cursor(),
            nodes,
            undo,
        }
    }

    /// Gives the data of each profile and each measured curve to `keep`, which returns the hash of the file they are
    /// in. The document then refers to them by that hash.
    /// Errors: Those of `keep`.
    pub fn lay_aside<E>(&mut self, keep: impl FnMut(&Aside) -> Result<String, E>) -> Result<(), E> {
        self.problems.lay_aside(keep)
    }

    /// Takes the data back into the document: `columns` gives r and h of the file with a hash, `bytes` its whole
    /// content; both also receive the name of the profile or the curve.
    /// Errors: Those of `columns` and `bytes`.
    pub fn take_back<E>(
        &mut self,
        columns: impl FnMut(&str, &str) -> Result<[Vec<f64>; 2], E>,
        bytes: impl FnMut(&str, &str) -> Result<Vec<u8>, E>,
    ) -> Result<(), E> {
        self.problems.take_back(columns, bytes)
    }

    /// As JSON, in one line.
    pub fn json(&self) -> serde_json::Result<Vec<u8>> {
        let mut bytes = serde_json::to_vec(self)?;
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

    /// δ, P and s of the walker in the user's units, as written.
    pub fn walker(&self) -> Option<[f64; 3]> {
        self.walker.map(floats)
    }

    /// Its snapshot; no problem is prepared and no file is read.
    /// Errors: Something in it is inconsistent, or the rows of a profile were not taken back.
    pub fn snapshot(self) -> Result<Snapshot, Unreadable> {
        let Restored { presets, settings } = self.problems.back()?;
        let preset = |number: usize| {
            let found = presets.get(number).cloned();
            found.ok_or_else(|| Unreadable::Damaged("a preset is missing".to_owned()))
        };
        let history = tree::history(self.nodes, self.cursor, &settings)
            .ok_or_else(|| Unreadable::Damaged("the states do not form a walk".to_owned()))?;
        let pins = self.pins.iter().map(|(number, at)| Ok((*number, preset(*at)?)));
        let undo = self.undo.back(preset)?;
        Ok(Snapshot {
            session: 0,
            preset: preset(self.preset)?,
            saved: preset(self.saved)?,
            source: self.source.back()?,
            fingerprint: self.fingerprint,
            history,
            undo,
            settled: self.settled,
            pins: pins.collect::<Result<_, Unreadable>>()?,
            look: self.look,
            journal: self.journal.back(preset)?,
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
