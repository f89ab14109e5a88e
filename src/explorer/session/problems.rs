//! The presets and settings of a document, each stored once however many nodes share them.

use super::aside::{Aside, SavedFile};
use super::unreadable::Unreadable;
use crate::explorer::setting::Setting;
use crate::store::FILES;
use pulloff_engine::gap::Shape;
use pulloff_engine::preset::read::{HeldFiles, read_holding};
use pulloff_engine::preset::{Preset, write};
use pulloff_engine::quasistatic::Scales;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::sync::Arc;

/// Presets, settings and the content of files, by number.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Problems {
    presets: Vec<SavedPreset>,
    settings: Vec<SavedSetting>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) files: Vec<SavedFile>,
}

/// A preset as the text of its file, and the numbers of the files it takes data from.
#[derive(Debug, PartialEq, Eq, Hash, Clone, Serialize, Deserialize)]
struct SavedPreset {
    text: String,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    files: Vec<usize>,
}

/// A setting: its preset and δ₀, P₀, s₀, which only the swept curve knows.
#[derive(Debug, Serialize, Deserialize)]
struct SavedSetting {
    preset: usize,
    scales: Scales,
}

/// Assigns numbers to presets and settings while a document is made.
#[derive(Default)]
pub(super) struct Collector {
    problems: Problems,
    texts: HashMap<SavedPreset, usize>,
    /// The settings seen, by their addresses: nodes share them.
    settings: HashMap<*const Setting, usize>,
}

impl Collector {
    pub(super) fn preset(&mut self, preset: &Preset) -> usize {
        let rows = match &preset.gap {
            Shape::Profile(measured) => Some(Aside::Profile(Arc::clone(measured.rows()))),
            _ => None,
        };
        let curve = preset.data.source.as_ref().map(|source| Aside::Curve(Arc::clone(source)));
        let files = rows.into_iter().chain(curve).map(|file| self.file(&file)).collect();
        let presets = &mut self.problems.presets;
        *self.texts.entry(SavedPreset { text: write(preset), files }).or_insert_with_key(|saved| {
            presets.push(saved.clone());
            presets.len() - 1
        })
    }

    pub(super) fn setting(&mut self, setting: &Arc<Setting>) -> usize {
        if let Some(known) = self.settings.get(&Arc::as_ptr(setting)) {
            return *known;
        }
        let preset = self.preset(&setting.preset);
        self.problems.settings.push(SavedSetting { preset, scales: setting.scales });
        let number = self.problems.settings.len() - 1;
        self.settings.insert(Arc::as_ptr(setting), number);
        number
    }

    fn file(&mut self, file: &Aside) -> usize {
        let files = &mut self.problems.files;
        let known = files.iter().position(|known| known.held.as_ref().is_some_and(|held| held.is_same(file)));
        known.unwrap_or_else(|| {
            files.push(SavedFile::of(file));
            files.len() - 1
        })
    }

    pub(super) fn finish(self) -> Problems {
        self.problems
    }
}

/// What is read back.
pub(super) struct Restored {
    pub(super) presets: Vec<Preset>,
    pub(super) settings: Vec<Arc<Setting>>,
}

impl Problems {
    /// The presets and settings, none of them prepared.
    pub(super) fn back(self) -> Result<Restored, Unreadable> {
        let missing = |what: &str| Unreadable::Damaged(format!("a {what} is missing"));
        let file = |file: SavedFile| file.back().ok_or_else(|| missing("profile or measured curve"));
        let files = self.files.into_iter().map(file).collect::<Result<Vec<_>, _>>()?;
        let preset = |saved: &SavedPreset| {
            let mut held = HeldFiles::default();
            for at in &saved.files {
                files.get(*at).ok_or_else(|| missing("profile or measured curve"))?.put(&mut held);
            }
            let preset = read_holding(FILES, "a preset in it", &saved.text, held);
            preset.map_err(|error| Unreadable::Damaged(error.to_string()))
        };
        let presets = self.presets.iter().map(preset).collect::<Result<Vec<_>, _>>()?;
        let setting = |saved: SavedSetting| {
            let preset: &Preset = presets.get(saved.preset).ok_or_else(|| missing("preset"))?;
            Ok(Arc::new(Setting::new(preset.clone(), saved.scales)))
        };
        let settings = self.settings.into_iter().map(setting).collect::<Result<Vec<_>, Unreadable>>()?;
        Ok(Restored { presets, settings })
    }
}
