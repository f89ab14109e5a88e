//! Opening, saving, exporting, and reading profiles: what the driver does for the model.

use super::command::{Assignment, Command};
use super::curve::CurveData;
use super::data::{self, Folder};
use super::history::{Node, NodeKind};
use super::journal::Start;
use super::script;
use crate::mend::Reason;
use crate::print::Format;
use crate::store::{
    Fingerprint, Listing, Loaded, Overwrite, Source, Store, StoreError, WriteError, write_atomically,
};
use pulloff_engine::gap::shapes::Rows;
use pulloff_engine::preset::changes::{changes, differences};
use pulloff_engine::preset::{Key, Preset, Row};
use pulloff_engine::problem::Control;
use pulloff_engine::report::trace::StableReport;
use pulloff_engine::report::unload::{EventReport, StateReport};
use pulloff_engine::report::{ProblemReport, SCHEMA, TraceReport, json, rows};
use pulloff_engine::text::{quote, show_path};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What can be exported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Document {
    /// The points of the background curve.
    Curve,
    /// The states walked.
    Walk,
    /// The instabilities, of the source shown.
    Events,
    /// What was done, as a script.
    Script,
}

impl Document {
    /// All, in the order they are offered.
    pub const ALL: [Self; 4] = [Self::Curve, Self::Walk, Self::Events, Self::Script];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Curve => "curve",
            Self::Walk => "walk",
            Self::Events => "events",
            Self::Script => "script",
        }
    }

    /// The endings its file may have, the usual one first.
    pub fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Curve | Self::Walk | Self::Events => &["csv", "json"],
            Self::Script => &["pulloff", "txt"],
        }
    }
}

/// Whether the name of a file has one of these endings.
pub fn ends_in(path: &str, endings: &[&str]) -> bool {
    let ending = Path::new(path).extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| endings.iter().any(|known| known.eq_ignore_ascii_case(ending)))
}

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
    pub fn document(&self) -> Document {
        match self {
            Self::Curve(_) => Document::Curve,
            Self::Walk(..) => Document::Walk,
            Self::Events(..) => Document::Events,
            Self::Script(..) => Document::Script,
        }
    }
}

/// What is seen, for a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Page {
    /// The screen as text.
    Screen(String),
    /// A figure as SVG, drawn as its file's ending says.
    Figure(String),
}

impl Page {
    /// The bytes of its file `path`.
    fn bytes(&self, path: &str) -> Result<Vec<u8>, Reason> {
        match self {
            Self::Screen(text) => Ok(text.as_bytes().to_vec()),
            Self::Figure(svg) => {
                let format = Format::of(Path::new(path)).map_err(|error| Reason::of("", &error))?;
                format.bytes(svg).map_err(|error| Reason::of("", &error))
            }
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
    FileExists(Document, String),
    /// The same of this page, at this path.
    PageExists(Page, String),
    /// It failed; nothing was changed.
    Failed(Reason),
}

/// Does a job.
pub fn run(store: &Store, job: Job) -> Done {
    match job {
        Job::List => Done::Listed(Box::new(store.list())),
        Job::Names => Done::Named(store.known()),
        Job::Assign { mut preset, assignments } => {
            match assignments.iter().try_for_each(|(key, text)| preset.assign(key, text)) {
                Ok(()) => Done::Assigned(preset),
                Err(invalid) => Done::Failed(Reason::mendable(invalid.to_string())),
            }
        }
        Job::Open { name, assignments } => {
            let assignments: Vec<String> =
                assignments.iter().map(|(key, text)| format!("{key}={text}")).collect();
            let loaded = store.resolve(&name).and_then(|source| store.load(&source, &assignments));
            loaded.map_or_else(|e| Done::Failed(Reason::of("", &e)), |loaded| Done::Opened(Box::new(loaded)))
        }
        Job::Delete(name) => match store.delete(&name) {
            Ok(path) => Done::Deleted(show_path(&path), Box::new(store.list())),
            Err(error) => Done::Failed(Reason::of("not deleted: ", &error)),
        },
        Job::Browse { folder, own } => match data::list(folder.as_deref(), own.as_deref()) {
            Ok(folder) => Done::Browsed(Box::new(folder)),
            Err(reason) => Done::Failed(Reason::mendable(reason)),
        },
        Job::Read { folder, name } => {
            let path = target(&name).to_string_lossy().into_owned();
            match crate::store::load(folder.as_deref(), &path) {
                Ok(rows) => Done::Read(Arc::new(rows)),
                Err(reason) => Done::Failed(Reason::mendable(reason)),
            }
        }
        Job::Save { source, preset, overwrite } => {
            let Some(path) = source.path() else {
                let why = "the preset has no file of its own; save it under a name";
                return Done::Failed(Reason::mendable(why));
            };
            match crate::store::save_file(path, &preset, Some(&source), overwrite) {
                Ok(fingerprint) => Done::Saved { source, fingerprint, preset },
                Err(StoreError::Write(WriteError::Changed { .. })) => Done::Conflict,
                Err(error) => Done::Failed(Reason::of("not saved: ", &error)),
            }
        }
        Job::SaveAs { name, preset, replace, with_data, from } => {
            save_as(store, name, preset, replace, with_data, &from)
        }
        Job::Write { page, path, replace } => match page.bytes(&path) {
            Ok(bytes) => match put(&path, &bytes, replace) {
                Err(WriteError::Exists { .. }) => Done::PageExists(page, path),
                result => exported(path, result),
            },
            Err(reason) => Done::Failed(Reason::of("not exported: ", &reason)),
        },
        Job::Export { content, path, replace } => export(store, &content, path, replace),
    }
}

/// Saves under a name, the data of a profile beside it where they are to be.
fn save_as(
    store: &Store,
    name: String,
    preset: Box<Preset>,
    replace: bool,
    with_data: bool,
    from: &Source,
) -> Done {
    let overwrite = if replace { Overwrite::Always } else { Overwrite::Never };
    let saved = if with_data {
        let saved = store.save_with_data(&name, &preset, Some(from), overwrite);
        saved.map(|(source, fingerprint, preset)| (source, fingerprint, Box::new(preset)))
    } else {
        store
            .save(&name, &preset, Some(from), overwrite)
            .map(|(source, fingerprint)| (source, fingerprint, preset))
    };
    match saved {
        Ok((source, fingerprint, preset)) => Done::Saved { source, fingerprint, preset },
        Err(StoreError::Write(WriteError::Exists { .. })) => Done::NameTaken(name, with_data),
        Err(error) => Done::Failed(Reason::of("not saved: ", &error)),
    }
}

/// Writes a document.
fn export(store: &Store, content: &Content, path: String, replace: bool) -> Done {
    let as_json = Path::new(&path).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
    let text = match content {
        Content::Script(start, lines) => script_text(store, start, lines).map_err(Reason::mendable),
        numbers => {
            text(numbers, as_json).map_err(|error| Reason { text: error.to_string(), can_be_mended: false })
        }
    };
    let text = match text {
        Ok(text) => text,
        Err(reason) => return Done::Failed(Reason::of("not exported: ", &reason)),
    };
    match put(&path, text.as_bytes(), replace) {
        Err(WriteError::Exists { .. }) => Done::FileExists(content.document(), path),
        result => exported(path, result),
    }
}

fn put(path: &str, bytes: &[u8], replace: bool) -> Result<Fingerprint, WriteError> {
    let overwrite = if replace { Overwrite::Always } else { Overwrite::Never };
    write_atomically(&target(path), bytes, overwrite)
}

fn exported(path: String, result: Result<Fingerprint, WriteError>) -> Done {
    match result {
        Ok(_) => Done::Exported(path),
        Err(error) => Done::Failed(Reason::of("not exported: ", &error)),
    }
}

/// The path a person typed, `~/` meaning the home folder.
pub(super) fn target(path: &str) -> PathBuf {
    match (path.strip_prefix("~/"), std::env::var_os("HOME")) {
        (Some(rest), Some(home)) => Path::new(&home).join(rest),
        _ => PathBuf::from(path),
    }
}

/// One state of the walk as a row.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WalkRow {
    /// Steps since the start.
    pub step: usize,
    /// How it came about.
    pub kind: &'static str,
    /// What was controlled.
    pub control: String,
    /// s.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// U.
    pub energy: f64,
    /// The crest of the edge.
    pub wave: Option<u64>,
    /// Newton rounds spent.
    pub newton_iterations: usize,
    /// Stability under each control.
    pub stable: StableReport,
    /// The energy lost in the jump that led here.
    pub dissipated: Option<f64>,
    /// The same by the area.
    pub dissipated_by_area: Option<f64>,
    /// γ when it was solved: parameters may change during a walk.
    pub work_of_adhesion: f64,
    /// R when it was solved, where the gap has one.
    pub radius_of_curvature: Option<f64>,
    /// A when it was solved.
    pub amplitude: Option<f64>,
    /// λ when it was solved.
    pub wavelength: Option<f64>,
    /// Whether it is admissible; nothing once the bodies are apart.
    pub admissible: Option<bool>,
    /// The keys of the preset that changed during the walk, with their values when it was solved: null where the preset had
    /// none.
    #[serde(flatten)]
    pub changed: BTreeMap<String, Value>,
}

/// The columns of the walk as CSV; behind them stand the keys that changed during it.
pub const WALK_COLUMNS: &[&str] = &[
    "step",
    "kind",
    "control",
    "contact_radius",
    "approach",
    "force",
    "energy",
    "wave",
    "newton_iterations",
    "stable_displacement",
    "stable_force",
    "stable_chosen",
    "dissipated",
    "dissipated_by_area",
    "work_of_adhesion",
    "radius_of_curvature",
    "amplitude",
    "wavelength",
    "admissible",
];

/// The keys whose value is not the same in all states of a walk, in the order in which they changed. How the preset is
/// called and shown is of no state.
fn changed_keys(walk: &[Node]) -> Vec<Key> {
    // States of one problem share it.
    let mut presets: Vec<&Preset> = Vec::new();
    for nodes in walk.chunk_by(|a, b| Arc::ptr_eq(&a.setting, &b.setting)) {
        presets.push(&nodes[0].setting.preset);
    }
    let Some((first, rest)) = presets.split_first() else { return Vec::new() };
    let mut keys: Vec<Key> = Vec::new();
    for preset in rest {
        // A key may be of one of the two alone.
        let is_of_states =
            |row: &Row| !(row.is_part() || row.key == "title" || row.key.starts_with("display."));
        for row in first.rows().chain(preset.rows()).filter(is_of_states) {
            if first.get(&row.key) != preset.get(&row.key) && !keys.contains(&row.key) {
                keys.push(row.key.clone());
            }
        }
    }
    keys
}

impl WalkRow {
    fn new(node: &Node, changed: &[Key]) -> Self {
        let setting = &node.setting;
        let state = node.state.in_units(setting.units());
        let stability = node.stability();
        let event = match &node.kind {
            NodeKind::Jump(event) => Some(EventReport::new(&setting.reduced, node.control, event)),
            _ => None,
        };
        let wave = setting.preset.gap.wave();
        let apart = node.is_apart();
        Self {
            step: node.step,
            kind: kind_name(&node.kind),
            control: setting.shown_control(node.control).to_string(),
            contact_radius: if apart { 0.0 } else { state.contact_radius },
            approach: state.approach,
            force: if apart { 0.0 } else { state.force },
            energy: if apart { 0.0 } else { state.energy },
            wave: if apart { None } else { StateReport::new(&setting.reduced, &node.state).wave },
            newton_iterations: node.point.rounds,
            stable: StableReport {
                displacement: stability.under(Control::Displacement),
                force: stability.under(Control::Force),
                chosen: stability.under(node.control),
            },
            dissipated: event.as_ref().and_then(|e| e.dissipated),
            dissipated_by_area: event.as_ref().and_then(|e| e.dissipated_by_area),
            work_of_adhesion: setting.preset.material.work_of_adhesion,
            radius_of_curvature: setting.preset.gap.radius_of_curvature(),
            amplitude: wave.map(|(a, _)| a),
            wavelength: wave.map(|(_, l)| l),
            admissible: Some(node.admissibility.holds).filter(|_| !apart),
            changed: changed.iter().map(|key| (key.to_string(), value_of(&setting.preset, key))).collect(),
        }
    }
}

/// The value of a key as it stands in a cell: numbers in SI or reduced units, a control as it is typed.
fn value_of(preset: &Preset, key: &str) -> Value {
    match preset.get(key) {
        None => Value::Null,
        Some(pulloff_engine::preset::Value::Number(x)) => Value::from(x),
        Some(pulloff_engine::preset::Value::Integer(n)) => Value::from(n),
        Some(other) => Value::from(other.to_string()),
    }
}

/// The word for how a node came about.
pub fn kind_name(kind: &NodeKind) -> &'static str {
    match kind {
        NodeKind::Start => "start",
        NodeKind::Step => "step",
        NodeKind::Limit => "limit",
        NodeKind::Jump(event) => pulloff_engine::report::unload::kind_name(event.kind),
        NodeKind::Moved => "moved",
        NodeKind::Solved => "solved",
        NodeKind::Stale(_) => "unsolved",
    }
}

/// A document of the walk or of its events.
#[derive(Debug, Serialize)]
struct Walked<'a, R> {
    schema: u32,
    program_version: &'static str,
    problem: ProblemReport,
    warnings: &'a [String],
    notes: &'a [String],
    #[serde(skip_serializing_if = "<[R]>::is_empty")]
    points: &'a [R],
    #[serde(skip_serializing_if = "<[EventReport]>::is_empty")]
    events: &'a [EventReport],
}

/// A session as a script: the preset it began with, as the file of that name is now with what was otherwise, and its
/// lines.
fn script_text(store: &Store, start: &Start, lines: &[String]) -> Result<String, String> {
    let name = match &start.source {
        Source::Shipped(shipped) => shipped.name.to_owned(),
        Source::User { name, .. } => name.clone(),
        // The script may be run from another folder.
        Source::File(path) => {
            std::path::absolute(path).unwrap_or_else(|_| path.clone()).display().to_string()
        }
        Source::Piped { .. } => {
            let why = "the preset came through a pipe, and a script cannot open it: save it under a name, and open that";
            return Err(why.to_owned());
        }
    };
    let none = &[] as &[&str];
    let source = store.resolve(&name).map_err(|error| error.to_string())?;
    let now = store.load(&source, none).map_err(|error| error.to_string())?.preset;
    let lost = || format!("the walk did not begin with {}, and its values cannot be assigned", quote(&name));
    // Laid over the file as a whole, as a replay does.
    let leads_there = |assignments: &Vec<Assignment>| {
        let laid: Vec<String> = assignments.iter().map(|(key, text)| format!("{key}={text}")).collect();
        store.load(&source, &laid).is_ok_and(|back| back.preset == start.preset)
    };
    let ways = [Some(differences(&now, &start.preset)), changes(&now, &start.preset)];
    let assignments = ways.into_iter().flatten().find(leads_there).ok_or_else(lost)?;
    let open = script::line(&Command::OpenWith { name: name.clone(), assignments }).ok_or_else(lost)?;
    let head = "# A session of pulloff: `pulloff run` walks it again.";
    Ok(std::iter::once(head).chain([&*open]).chain(lines.iter().map(String::as_str)).fold(
        String::new(),
        |mut text, line| {
            text.push_str(line);
            text.push('\n');
            text
        },
    ))
}

/// The text of a document; of a script its lines alone.
fn text(content: &Content, as_json: bool) -> Result<String, rows::RowsError> {
    let walked = |curve: &CurveData, points: &[WalkRow], events: &[EventReport]| {
        json(&Walked {
            schema: SCHEMA,
            program_version: env!("CARGO_PKG_VERSION"),
            problem: ProblemReport::new(&curve.setting.preset, &curve.case),
            warnings: &curve.sweep.warnings,
            notes: &curve.sweep.notes,
            points,
            events,
        })
    };
    Ok(match content {
        Content::Curve(curve) => {
            let (drawn, of) = (&curve.sweep.curve, &curve.sweep.curve.equilibrium);
            let points: Vec<_> =
                drawn.samples.iter().filter_map(|at| of.explicit(at.contact_radius)).collect();
            let report = TraceReport::new(&curve.setting.preset, &curve.case, drawn, &points, drawn.stop);
            if as_json { json(&report)? } else { report.csv()? }
        }
        Content::Walk(curve, walk) => {
            let changed = changed_keys(walk);
            let points: Vec<WalkRow> = walk.iter().map(|node| WalkRow::new(node, &changed)).collect();
            if as_json {
                walked(curve, &points, &[])?
            } else {
                let columns = WALK_COLUMNS.iter().copied().chain(changed.iter().map(AsRef::as_ref));
                rows::csv(&columns.collect::<Vec<_>>(), &points)?
            }
        }
        Content::Events(curve, events) => {
            if as_json {
                walked(curve, &[], events)?
            } else {
                rows::csv(pulloff_engine::report::unload::COLUMNS, events)?
            }
        }
        Content::Script(_, lines) => lines.join("\n"),
    })
}
