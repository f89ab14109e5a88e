//! The presets and settings of a document, each once, however many nodes share them.

use super::number::{Real, floats, reals};
use super::unreadable::Unreadable;
use crate::explorer::setting::Setting;
use crate::store::FILES;
use pulloff_engine::gap::Shape;
use pulloff_engine::gap::shapes::Rows;
use pulloff_engine::measured::Source;
use pulloff_engine::preset::read::Held;
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
    presets: Vec<Saved>,
    settings: Vec<Scaled>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    profiles: Vec<Profile>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    curves: Vec<Curve>,
}

/// A preset as its file.
#[derive(Debug, PartialEq, Eq, Hash, Clone, Serialize, Deserialize)]
struct Saved {
    text: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    profile: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    curve: Option<usize>,
}

/// The file of a measured curve, as it was.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(from = "WrittenCurve", into = "WrittenCurve")]
enum Curve {
    /// In the document itself.
    Within(Arc<Source>),
    /// In a file of its own, named by its hash.
    Beside { data: String, name: String, folder: Option<PathBuf> },
}

/// A measured curve as it is written.
#[derive(Serialize, Deserialize)]
struct WrittenCurve {
    name: String,
    folder: Option<Place>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    data: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    text: Option<String>,
}

impl From<Curve> for WrittenCurve {
    fn from(curve: Curve) -> Self {
        match curve {
            Curve::Within(source) => Self {
                name: source.name.clone(),
                folder: source.folder.as_deref().map(Place::of),
                data: None,
                // It was taken apart, and so is text.
                text: Some(String::from_utf8_lossy(&source.bytes).into_owned()),
            },
            Curve::Beside { data, name, folder } => {
                Self { name, folder: folder.as_deref().map(Place::of), data: Some(data), text: None }
            }
        }
    }
}

impl From<WrittenCurve> for Curve {
    fn from(WrittenCurve { name, folder, data, text }: WrittenCurve) -> Self {
        let folder = folder.map(Place::path);
        if let Some(data) = data {
            return Self::Beside { data, name, folder };
        }
        let bytes = text.unwrap_or_default().into_bytes();
        Self::Within(Arc::new(Source::new(name, folder, bytes.into())))
    }
}

/// A setting: its preset and δ₀, P₀, s₀, which only the swept curve knows.
#[derive(Debug, Serialize, Deserialize)]
struct Scaled {
    preset: usize,
    scales: [Real; 3],
}

/// The rows of a profile, as they were: its file may change.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(from = "Written", into = "Written")]
enum Profile {
    /// In the document itself, as in all sessions of before.
    Within(Arc<Rows>),
    /// In a file of their own, named by its hash; `rows` has all but the two columns.
    Beside { data: String, rows: Rows },
}

/// A profile as it is written.
#[derive(Serialize, Deserialize)]
struct Written {
    name: String,
    folder: Option<Place>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    data: Option<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    radii: Vec<Real>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    gaps: Vec<Real>,
    unit: Option<String>,
    notes: Vec<String>,
}

/// A path: its text, or its bytes where it is none.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(untagged)]
pub(super) enum Place {
    Text(String),
    Bytes(Vec<u8>),
}

impl Place {
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
    Profile(Arc<Rows>),
    Curve(Arc<Source>),
}

/// Numbers presets and settings while a document is made.
#[derive(Default)]
pub(super) struct Collector {
    problems: Problems,
    texts: HashMap<Saved, usize>,
    /// The settings seen, by where they are: nodes share them.
    settings: HashMap<*const Setting, usize>,
    rows: Vec<Arc<Rows>>,
    sources: Vec<Arc<Source>>,
}

impl Collector {
    pub(super) fn preset(&mut self, preset: &Preset) -> usize {
        let profile = match &preset.gap {
            Shape::Profile(measured) => Some(self.profile(measured.rows())),
            _ => None,
        };
        let curve = preset.data.source.as_ref().map(|source| self.curve(source));
        let text = Saved { text: write(preset), profile, curve };
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
        self.problems.settings.push(Scaled { preset, scales: reals([approach, force, contact_radius]) });
        let number = self.problems.settings.len() - 1;
        self.settings.insert(Arc::as_ptr(setting), number);
        number
    }

    fn profile(&mut self, rows: &Arc<Rows>) -> usize {
        let same = |known: &Arc<Rows>| {
            Arc::ptr_eq(known, rows)
                || (known == rows && (&known.folder, &known.notes) == (&rows.folder, &rows.notes))
        };
        if let Some(known) = self.rows.iter().position(same) {
            return known;
        }
        self.rows.push(Arc::clone(rows));
        self.problems.profiles.push(Profile::Within(Arc::clone(rows)));
        self.rows.len() - 1
    }

    fn curve(&mut self, source: &Arc<Source>) -> usize {
        let same = |known: &Arc<Source>| {
            Arc::ptr_eq(known, source) || (known == source && known.folder == source.folder)
        };
        if let Some(known) = self.sources.iter().position(same) {
            return known;
        }
        self.sources.push(Arc::clone(source));
        self.problems.curves.push(Curve::Within(Arc::clone(source)));
        self.sources.len() - 1
    }

    pub(super) fn finish(self) -> Problems {
        self.problems
    }
}

impl From<Profile> for Written {
    fn from(profile: Profile) -> Self {
        let (rows, data) = match profile {
            Profile::Within(rows) => (rows, None),
            Profile::Beside { data, rows } => (Arc::new(rows), Some(data)),
        };
        let numbers = |column: &[f64]| column.iter().copied().map(Real).collect();
        Self {
            name: rows.name.clone(),
            folder: rows.folder.as_deref().map(Place::of),
            data,
            radii: numbers(&rows.radii),
            gaps: numbers(&rows.gaps),
            unit: rows.unit.as_ref().map(Unit::ascii),
            notes: rows.notes.clone(),
        }
    }
}

impl From<Written> for Profile {
    fn from(written: Written) -> Self {
        let numbers = |column: Vec<Real>| column.into_iter().map(|real| real.0).collect();
        let rows = Rows {
            name: written.name,
            folder: written.folder.map(Place::path),
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
    /// Gives the data within to `keep`, which says the hash of the file they are in, and holds no more than that.
    pub(super) fn lay_aside<E>(
        &mut self,
        mut keep: impl FnMut(&Aside) -> Result<String, E>,
    ) -> Result<(), E> {
        for curve in &mut self.curves {
            if let Curve::Within(source) = curve {
                let data = keep(&Aside::Curve(Arc::clone(source)))?;
                *curve = Curve::Beside { data, name: source.name.clone(), folder: source.folder.clone() };
            }
        }
        for profile in &mut self.profiles {
            if let Profile::Within(rows) = profile {
                let data = keep(&Aside::Profile(Arc::clone(rows)))?;
                let Rows { name, folder, unit, notes, .. } = &**rows;
                let (name, folder, unit) = (name.clone(), folder.clone(), unit.clone());
                let rows = Rows { name, folder, unit, notes: notes.clone(), ..Rows::default() };
                *profile = Profile::Beside { data, rows };
            }
        }
        Ok(())
    }

    /// The way back: `columns` gives those in the file of a hash, `bytes` all of it; both are told what a person calls it.
    pub(super) fn take_back<E>(
        &mut self,
        mut columns: impl FnMut(&str, &str) -> Result<[Vec<f64>; 2], E>,
        mut bytes: impl FnMut(&str, &str) -> Result<Vec<u8>, E>,
    ) -> Result<(), E> {
        for curve in &mut self.curves {
            if let Curve::Beside { data, name, folder } = curve {
                let bytes = bytes(data, name)?;
                let source = Source::new(std::mem::take(name), folder.take(), bytes.into());
                *curve = Curve::Within(Arc::new(source));
            }
        }
        for profile in &mut self.profiles {
            if let Profile::Beside { data, rows } = profile {
                let [radii, gaps] = columns(data, &rows.name)?;
                *profile = Profile::Within(Arc::new(Rows { radii, gaps, ..std::mem::take(rows) }));
            }
        }
        Ok(())
    }

    /// The presets and settings, none of them made ready.
    pub(super) fn back(self) -> Result<Restored, Unreadable> {
        let missing = |what: &str| Unreadable::Damaged(format!("a {what} is missing"));
        let within = |profile| match profile {
            Profile::Within(rows) => Ok(rows),
            Profile::Beside { .. } => Err(missing("column of a profile")),
        };
        let profiles = self.profiles.into_iter().map(within).collect::<Result<Vec<_>, _>>()?;
        let within = |curve| match curve {
            Curve::Within(source) => Ok(source),
            Curve::Beside { .. } => Err(missing("measured curve")),
        };
        let curves = self.curves.into_iter().map(within).collect::<Result<Vec<_>, _>>()?;
        let preset = |saved: &Saved| {
            let mut held = Held::default();
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
        let setting = |saved: Scaled| {
            let preset: &Preset = presets.get(saved.preset).ok_or_else(|| missing("preset"))?;
            let [approach, force, contact_radius] = floats(saved.scales);
            Ok(Arc::new(Setting::new(preset.clone(), Scales { approach, force, contact_radius })))
        };
        let settings = self.settings.into_iter().map(setting).collect::<Result<Vec<_>, Unreadable>>()?;
        Ok(Restored { presets, settings })
    }
}
