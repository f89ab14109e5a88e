//! The presets and settings of a document, each stored once however many nodes share them.

use super::number::{Real, floats, reals};
use super::unreadable::Unreadable;
use crate::explorer::setting::Setting;
use crate::store::FILES;
use pulloff_engine::gap::Shape;
use pulloff_engine::gap::shapes::ProfileRows;
use pulloff_engine::measured::PointsFile;
use pulloff_engine::preset::read::HeldFiles;
use pulloff_engine::preset::{Preset, write};
use pulloff_engine::quasistatic::Scales;
use pulloff_engine::units::Unit;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::ffi::OsString;
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Presets, settings and the rows of profiles, by number.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Problems {
    presets: Vec<SavedPreset>,
    settings: Vec<SavedSetting>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    profiles: Vec<SavedProfile>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    curves: Vec<SavedCurve>,
}

/// A preset as the text of its file.
#[derive(Debug, PartialEq, Eq, Hash, Clone, Serialize, Deserialize)]
struct SavedPreset {
    text: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    profile: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    curve: Option<usize>,
}

/// The file of a measured curve, byte for byte.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(from = "WrittenCurve", into = "WrittenCurve")]
enum SavedCurve {
    /// In the document itself.
    Within(Arc<PointsFile>),
    /// In a file of its own, named by its hash.
    Beside { data: String, name: String, folder: Option<PathBuf> },
}

/// A measured curve in its written form.
#[derive(Serialize, Deserialize)]
struct WrittenCurve {
    name: String,
    folder: Option<SavedPath>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    data: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    text: Option<String>,
}

impl From<SavedCurve> for WrittenCurve {
    fn from(curve: SavedCurve) -> Self {
        match curve {
            SavedCurve::Within(source) => Self {
                name: source.name.clone(),
                folder: source.folder.as_deref().map(SavedPath::of),
                data: None,
                // It has been parsed, so it is text.
                text: Some(String::from_utf8_lossy(&source.bytes).into_owned()),
            },
            SavedCurve::Beside { data, name, folder } => {
                Self { name, folder: folder.as_deref().map(SavedPath::of), data: Some(data), text: None }
            }
        }
    }
}

impl From<WrittenCurve> for SavedCurve {
    fn from(WrittenCurve { name, folder, data, text }: WrittenCurve) -> Self {
        let folder = folder.map(SavedPath::path);
        if let Some(data) = data {
            return Self::Beside { data, name, folder };
        }
        let bytes = text.unwrap_or_default().into_bytes();
        Self::Within(Arc::new(PointsFile::new(name, folder, bytes.into())))
    }
}

/// A setting: its preset and δ₀, P₀, s₀, which only the swept curve knows.
#[derive(Debug, Serialize, Deserialize)]
struct SavedSetting {
    preset: usize,
    scales: [Real; 3],
}

/// The rows of a profile as they were, since its file may change.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(from = "WrittenProfile", into = "WrittenProfile")]
enum SavedProfile {
    /// In the document itself, as in all sessions of earlier versions.
    Within(Arc<ProfileRows>),
    /// In a file of their own, named by its hash; `rows` has everything but the two columns.
    Beside { data: String, rows: ProfileRows },
}

/// A profile in its written form.
#[derive(Serialize, Deserialize)]
struct WrittenProfile {
    name: String,
    folder: Option<SavedPath>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    data: Option<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    radii: Vec<Real>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    gaps: Vec<Real>,
    unit: Option<String>,
    notes: Vec<String>,
}

/// A path: its text, or its bytes if they are not text.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(untagged)]
pub(super) enum SavedPath {
    Text(String),
    Bytes(Vec<u8>),
}

impl SavedPath {
    pub(super) fn of(path: &Path) -> Self {
        path.to_str().map_or_else(
            || Self::Bytes(path.as_os_str().as_bytes().to_vec()),
            |text| Self::Text(text.to_owned()),
        )
    }

    pub(super) fn path(self) -> PathBuf {
        match self {
            Self::Text(text) => text.into(),
            Self::Bytes(bytes) => OsString::from_vec(bytes).into(),
        }
    }
}

/// What can be kept in a file of its own.
#[derive(Debug, Clone)]
pub enum Aside {
    Profile(Arc<ProfileRows>),
    Curve(Arc<PointsFile>),
}

/// Assigns numbers to presets and settings while a document is made.
#[derive(Default)]
pub(super) struct Collector {
    problems: Problems,
    texts: HashMap<SavedPreset, usize>,
    /// The settings seen, by their addresses: nodes share them.
    settings: HashMap<*const Setting, usize>,
    rows: Vec<Arc<ProfileRows>>,
    sources: Vec<Arc<PointsFile>>,
}

impl Collector {
    pub(super) fn preset(&mut self, preset: &Preset) -> usize {
        let profile = match &preset.gap {
            Shape::Profile(measured) => Some(self.profile(measured.rows())),
            _ => None,
        };
        let curve = preset.data.source.as_ref().map(|source| self.curve(source));
        let text = SavedPreset { text: write(preset), profile, curve };
        let presets = &mut self.problems.presets;
        *self.texts.entry(text).or_insert_with_key(|text| {
            presets.push(text.clone());
            presets.len() - 1
        })
    }

    pub(super) fn setting(&mut self, setting: &Arc<Setting>) -> usize {
        if let Some(known) = self.settings.get(&Arc::as_ptr(setting)) {
            return *known;
        }
        let Scales { approach, force, contact_radius } = setting.scales;
        let preset = self.preset(&setting.preset);
        self.problems
            .settings
            .push(SavedSetting { preset, scales: reals([approach, force, contact_radius]) });
        let number = self.problems.settings.len() - 1;
        self.settings.insert(Arc::as_ptr(setting), number);
        number
    }

    fn profile(&mut self, rows: &Arc<ProfileRows>) -> usize {
        let same = |known: &Arc<ProfileRows>| {
            Arc::ptr_eq(known, rows)
                || (known == rows && (&known.folder, &known.notes) == (&rows.folder, &rows.notes))
        };
        if let Some(known) = self.rows.iter().position(same) {
            return known;
        }
        self.rows.push(Arc::clone(rows));
        self.problems.profiles.push(SavedProfile::Within(Arc::clone(rows)));
        self.rows.len() - 1
    }

    fn curve(&mut self, source: &Arc<PointsFile>) -> usize {
        let same = |known: &Arc<PointsFile>| {
            Arc::ptr_eq(known, source) || (known == source && known.folder == source.folder)
        };
        if let Some(known) = self.sources.iter().position(same) {
            return known;
        }
        self.sources.push(Arc::clone(source));
        self.problems.curves.push(SavedCurve::Within(Arc::clone(source)));
        self.sources.len() - 1
    }

    pub(super) fn finish(self) -> Problems {
        self.problems
    }
}

impl From<SavedProfile> for WrittenProfile {
    fn from(profile: SavedProfile) -> Self {
        let (rows, data) = match profile {
            SavedProfile::Within(rows) => (rows, None),
            SavedProfile::Beside { data, rows } => (Arc::new(rows), Some(data)),
        };
        let numbers = |column: &[f64]| column.iter().copied().map(Real).collect();
        Self {
            name: rows.name.clone(),
            folder: rows.folder.as_deref().map(SavedPath::of),
            data,
            radii: numbers(&rows.radii),
            gaps: numbers(&rows.gaps),
            unit: rows.unit.as_ref().map(Unit::ascii),
            notes: rows.notes.clone(),
        }
    }
}

impl From<WrittenProfile> for SavedProfile {
    fn from(written: WrittenProfile) -> Self {
        let numbers = |column: Vec<Real>| column.into_iter().map(|real| real.0).collect();
        let rows = ProfileRows {
            name: written.name,
            folder: written.folder.map(SavedPath::path),
            radii: numbers(written.radii),
            gaps: numbers(written.gaps),
            unit: written.unit.and_then(|unit| Unit::parse(&unit, 0).ok()),
            notes: written.notes,
        };
        match written.data {
            Some(data) => Self::Beside { data, rows },
            None => Self::Within(Arc::new(rows)),
        }
    }
}

/// What is read back.
pub(super) struct Restored {
    pub(super) presets: Vec<Preset>,
    pub(super) settings: Vec<Arc<Setting>>,
}

impl Problems {
    /// Gives the data it contains to `keep`, which returns the hash of the file they are in, and keeps only that hash.
    pub(super) fn lay_aside<E>(
        &mut self,
        mut keep: impl FnMut(&Aside) -> Result<String, E>,
    ) -> Result<(), E> {
        for curve in &mut self.curves {
            if let SavedCurve::Within(source) = curve {
                let data = keep(&Aside::Curve(Arc::clone(source)))?;
                *curve =
                    SavedCurve::Beside { data, name: source.name.clone(), folder: source.folder.clone() };
            }
        }
        for profile in &mut self.profiles {
            if let SavedProfile::Within(rows) = profile {
                let data = keep(&Aside::Profile(Arc::clone(rows)))?;
                let ProfileRows { name, folder, unit, notes, .. } = &**rows;
                let (name, folder, unit) = (name.clone(), folder.clone(), unit.clone());
                let rows = ProfileRows { name, folder, unit, notes: notes.clone(), ..ProfileRows::default() };
                *profile = SavedProfile::Beside { data, rows };
            }
        }
        Ok(())
    }

    /// The inverse: `columns` gives the columns in the file with a hash, `bytes` all of it; both also receive the
    /// person's name for it.
    pub(super) fn take_back<E>(
        &mut self,
        mut columns: impl FnMut(&str, &str) -> Result<[Vec<f64>; 2], E>,
        mut bytes: impl FnMut(&str, &str) -> Result<Vec<u8>, E>,
    ) -> Result<(), E> {
        for curve in &mut self.curves {
            if let SavedCurve::Beside { data, name, folder } = curve {
                let bytes = bytes(data, name)?;
                let source = PointsFile::new(std::mem::take(name), folder.take(), bytes.into());
                *curve = SavedCurve::Within(Arc::new(source));
            }
        }
        for profile in &mut self.profiles {
            if let SavedProfile::Beside { data, rows } = profile {
                let [radii, gaps] = columns(data, &rows.name)?;
                *profile =
                    SavedProfile::Within(Arc::new(ProfileRows { radii, gaps, ..std::mem::take(rows) }));
            }
        }
        Ok(())
    }

    /// The presets and settings, none of them prepared.
    pub(super) fn back(self) -> Result<Restored, Unreadable> {
        let missing = |what: &str| Unreadable::Damaged(format!("a {what} is missing"));
        let within = |profile| match profile {
            SavedProfile::Within(rows) => Ok(rows),
            SavedProfile::Beside { .. } => Err(missing("column of a profile")),
        };
        let profiles = self.profiles.into_iter().map(within).collect::<Result<Vec<_>, _>>()?;
        let within = |curve| match curve {
            SavedCurve::Within(source) => Ok(source),
            SavedCurve::Beside { .. } => Err(missing("measured curve")),
        };
        let curves = self.curves.into_iter().map(within).collect::<Result<Vec<_>, _>>()?;
        let preset = |saved: &SavedPreset| {
            let mut held = HeldFiles::default();
            if let Some(at) = saved.profile {
                held.rows = profiles.get(at).cloned().ok_or_else(|| missing("profile"))?;
            }
            if let Some(at) = saved.curve {
                held.points = curves.get(at).cloned().ok_or_else(|| missing("measured curve"))?;
            }
            let preset =
                pulloff_engine::preset::read::read_holding(FILES, "a preset in it", &saved.text, held);
            preset.map_err(|error| Unreadable::Damaged(error.to_string()))
        };
        let presets = self.presets.iter().map(preset).collect::<Result<Vec<_>, _>>()?;
        let setting = |saved: SavedSetting| {
            let preset: &Preset = presets.get(saved.preset).ok_or_else(|| missing("preset"))?;
            let [approach, force, contact_radius] = floats(saved.scales);
            Ok(Arc::new(Setting::new(preset.clone(), Scales { approach, force, contact_radius })))
        };
        let settings = self.settings.into_iter().map(setting).collect::<Result<Vec<_>, Unreadable>>()?;
        Ok(Restored { presets, settings })
    }
}
