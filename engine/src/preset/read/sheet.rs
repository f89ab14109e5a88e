//! The layers laid down so far: what is known about each key, and where it came from.

use super::mistake::{Mistake, ValueOrigin};
use crate::gap::Shape;
use crate::gap::shapes::ProfileRows;
use crate::measured::PointsFile;
use crate::preset::Preset;
use crate::preset::invalid::Invalid;
use crate::preset::measured::Files;
use crate::preset::model::put;
use crate::preset::rows::parameter;
use crate::preset::schema::{CHOOSERS, Key, Parameter, rivals};
use crate::preset::value::Value;
use crate::preset::values::Values;
use crate::text::quote;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// What is known about one key.
#[derive(Clone)]
pub(super) struct SheetEntry {
    pub(super) value: Result<Value, Invalid>,
    pub(super) origin: ValueOrigin,
}

/// What the files of a preset contain. For a preset without files it is empty, which is a mistake if a key names a
/// file.
#[derive(Debug, Clone)]
pub struct HeldFiles {
    /// The rows of its profile.
    pub rows: Arc<ProfileRows>,
    /// Its measured curve.
    pub points: Arc<PointsFile>,
}

impl Default for HeldFiles {
    fn default() -> Self {
        Self { rows: Arc::default(), points: Arc::new(PointsFile::new(String::new(), None, Arc::new([]))) }
    }
}

impl HeldFiles {
    /// What the files of `preset` contain.
    #[must_use]
    pub fn by(preset: &Preset) -> Self {
        let mut held = Self::default();
        if let Shape::Profile(measured) = &preset.gap {
            held.rows = Arc::clone(measured.rows());
        }
        if let Some(source) = &preset.data.source {
            held.points = Arc::clone(source);
        }
        held
    }
}

/// The layers laid down so far.
#[derive(Clone, Default)]
pub(super) struct Sheet {
    pub(super) name: String,
    /// Where the rows of profiles come from.
    pub(super) files: Files,
    /// The folder of the file.
    pub(super) folder: Option<PathBuf>,
    /// What its files contain, if that is known and no file is to be read.
    pub(super) held: Option<HeldFiles>,
    /// Whether an assignment chose a formula: its parameters need not fit those of the file.
    pub(super) refit: bool,
    pub(super) entries: BTreeMap<Key, SheetEntry>,
    /// Assignments of groups: laid over the whole once everything they follow from is known.
    pub(super) groups: Vec<(String, String, ValueOrigin)>,
    /// Where the file's tables begin.
    pub(super) tables: BTreeMap<Key, ValueOrigin>,
    pub(super) mistakes: Vec<Mistake>,
}

/// Where the values being laid down come from.
pub(super) enum LayerOrigin<'a> {
    File(&'a str),
    Assignment(&'a str),
}

impl Sheet {
    pub(super) fn origin(&self, place: &LayerOrigin<'_>, at: usize) -> ValueOrigin {
        match place {
            LayerOrigin::File(text) => {
                ValueOrigin::File { name: self.name.clone(), line: Some(line(text, at)) }
            }
            LayerOrigin::Assignment(text) => ValueOrigin::Assignment(quote(text)),
        }
    }

    /// Stores what was found for a key. An assignment replaces what the file gave in another form: another start, the
    /// waves of another shape, the size of another basis.
    pub(super) fn put(&mut self, row: &Parameter, value: Result<Value, Invalid>, origin: ValueOrigin) {
        if value.as_ref().is_ok_and(|value| row.takes_away(value)) {
            self.entries.remove(row.whole());
            return;
        }
        if matches!(origin, ValueOrigin::Assignment(_)) {
            self.refit = self.refit || row.key == "gap.formula";
            let rivals = rivals(&row.key);
            self.entries.retain(|key, _| !rivals.contains(&&**key));
            if let (Ok(word), true) = (&value, CHOOSERS.contains(&&*row.key)) {
                let word = word.to_string();
                self.entries.retain(|key, entry| {
                    matches!(entry.origin, ValueOrigin::Assignment(_))
                        || parameter(key).is_some_and(|other| other.fits(&row.key, &word))
                });
            }
        }
        match value {
            Ok(value) => {
                let mut one = Values::new();
                put(&mut one, row, value);
                for (key, value) in one {
                    self.entries.insert(key, SheetEntry { value: Ok(value), origin: origin.clone() });
                }
            }
            Err(invalid) => {
                self.entries
                    .insert(row.whole().to_owned().into(), SheetEntry { value: Err(invalid), origin });
            }
        }
    }

    pub(super) fn mistake(&mut self, origin: ValueOrigin, invalid: Invalid) {
        self.mistakes.push(Mistake { origin, invalid });
    }
}

/// The line of a byte, from 1.
pub fn line(text: &str, at: usize) -> usize {
    1 + text.bytes().take(at).filter(|byte| *byte == b'\n').count()
}
