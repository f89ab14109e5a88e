//! The file beside the results, `RESULTS.csv.spec.toml`: which sweep they are of, which part of it, what the columns are.
//!
//! Readers of CSV dislike comments, so the results themselves hold nothing but the table. The sweep is recognised by the
//! hash of its canonical form, which stands here as well, with the whole preset: the results can be repeated from it.

use super::record::{self, Layout};
use super::shard::Shard;
use super::spec::{canonical, identity};
use crate::mend::Mend;
use crate::store::file::{self, FileError, read_text};
use pulloff_engine::sweep::Spec;
use pulloff_engine::sweep::document::SpecText;
use pulloff_engine::sweep::spec::of_canonical;
use pulloff_engine::text::{greek, sanitize, show_path};
use pulloff_engine::units::{Quantity, UnitSystem};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use thiserror::Error;
use toml::{Table, Value};

/// The ending added to the name of the results.
const ENDING: &str = ".spec.toml";

/// Why the file beside some results says nothing. Names and paths in it are safe to show.
#[derive(Debug, Error)]
pub enum SidecarError {
    #[error(transparent)]
    File(#[from] FileError),
    #[error("{path}: {what}")]
    Unknown {
        path: String,
        /// What is wrong, safe to show.
        what: String,
    },
}

impl Mend for SidecarError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::File(error) => error.can_be_mended(),
            Self::Unknown { .. } => true,
        }
    }
}

/// A column of the results.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct ColumnInfo {
    pub name: String,
    /// What it is called in formulas; `None` where it has no such name.
    pub symbol: Option<String>,
    /// The unit of its numbers; `None` for pure numbers, texts, and in reduced units.
    pub unit: Option<String>,
    pub meaning: String,
}

/// What the file says.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct Sidecar {
    pub identity: String,
    shard: String,
    pub rows: u64,
    #[serde(rename = "column")]
    pub columns: Vec<ColumnInfo>,
    sweep: Canonical,
}

/// What is read of the canonical form.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
struct Canonical {
    axis: Vec<AxisKey>,
    /// How rows are drawn, where they are.
    random: Option<Draws>,
}

#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
struct Draws {}

#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
struct AxisKey {
    key: String,
}

/// The file beside these results.
#[must_use]
pub fn path(results: &Path) -> PathBuf {
    let mut name = results.as_os_str().to_owned();
    name.push(ENDING);
    PathBuf::from(name)
}

/// The text of the file for a part of a sweep.
#[must_use]
pub fn text(spec: &Spec, shard: Shard) -> String {
    let mut text = format!(
        "# What the results beside this file are of. `pulloff sweep` reads it, to go on and to join shards.\n\
         identity = \"{}\"\nshard = \"{shard}\"\nrows = {}\n\n{}",
        identity(spec),
        spec.rows,
        canonical(spec)
    );
    for ColumnInfo { name, symbol, unit, meaning } in columns(spec) {
        let quoted = |text: String| Value::String(text).to_string();
        let line = |key: &str, value: Option<String>| {
            value.map_or_else(String::new, |value| format!("{key} = {}\n", quoted(value)))
        };
        let (symbol, unit) = (line("symbol", symbol), line("unit", unit));
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "\n[[column]]\nname = {}\n{symbol}{unit}meaning = {}\n",
            quoted(name),
            quoted(meaning)
        );
    }
    text
}

/// The text for the whole sweep, made from that of a part.
#[must_use]
pub fn of_whole(text: &str, part: Shard) -> String {
    let line = |shard: Shard| format!("\nshard = \"{shard}\"\n");
    text.replacen(&line(part), &line(Shard::WHOLE), 1)
}

/// What of a sweep may differ: its keys in the canonical form, and how it is called.
const PARTS: [(&[&str], &str); 6] = [
    (&["program_version"], "another version of pulloff"),
    (&["preset"], "another preset"),
    (&["data"], "another measured profile"),
    (&["combine", "random"], "other rows of the same axes"),
    (&["quantities"], "other quantities"),
    (&["axis"], "other axes or values"),
];

/// How a sweep differs from the one of this sidecar text, in words that are safe to show.
#[must_use]
pub fn differences(text: &str, spec: &Spec) -> String {
    let sweep = |text: &str| toml::from_str::<Table>(text).ok()?.remove("sweep");
    let (theirs, ours) = (sweep(text), sweep(&canonical(spec)));
    let part = |sweep: &Option<Value>, key: &str| sweep.as_ref().and_then(|sweep| sweep.get(key)).cloned();
    let differs = |key: &&str| part(&theirs, key) != part(&ours, key);
    let named = PARTS.iter().filter(|(keys, _)| keys.iter().any(differs)).map(|(keys, name)| {
        let values = [&theirs, &ours].map(|sweep| part(sweep, keys[0]));
        match values.map(|value| value.and_then(|value| value.as_str().map(values_of))) {
            [Some(theirs), Some(ours)] if *keys == ["preset"] => format!("{name}{}", changed(&theirs, &ours)),
            _ => (*name).to_owned(),
        }
    });
    let named: Vec<String> = named.collect();
    if named.is_empty() { "in another form".to_owned() } else { named.join(", ") }
}

/// The values of a preset by their dotted keys.
fn values_of(preset: &str) -> BTreeMap<String, Value> {
    let tables: Table = toml::from_str(preset).unwrap_or_default();
    let mut values = BTreeMap::new();
    for (key, value) in tables {
        match value {
            Value::Table(table) => {
                values.extend(table.into_iter().map(|(name, value)| (format!("{key}.{name}"), value)));
            }
            value => {
                values.insert(key, value);
            }
        }
    }
    values
}

fn changed(theirs: &BTreeMap<String, Value>, ours: &BTreeMap<String, Value>) -> String {
    /// Listed at most.
    const TOLD: usize = 3;
    let all: BTreeSet<&String> = theirs.keys().chain(ours.keys()).collect();
    let keys: Vec<String> = all
        .into_iter()
        .filter(|key| theirs.get(*key) != ours.get(*key))
        .map(|key| sanitize(key, 60))
        .collect();
    let rest = if keys.len() > TOLD { ", ..." } else { "" };
    let told: Vec<&str> = keys.iter().take(TOLD).map(String::as_str).collect();
    if told.is_empty() { String::new() } else { format!(" ({}{rest})", told.join(", ")) }
}

fn columns(spec: &Spec) -> Vec<ColumnInfo> {
    let is_si = spec.preset.units != UnitSystem::Reduced;
    let unit = |quantity: Quantity| is_si.then(|| quantity.si()).flatten().map(str::to_owned);
    let meanings = spec.axes.iter().map(|axis| {
        let row = spec.preset.row(&axis.key);
        let symbol = row.as_ref().map(|row| greek(&row.label));
        (symbol, row.as_ref().and_then(|row| unit(row.quantity)), row.map(|row| row.meaning.to_string()))
    });
    let meanings = std::iter::once((None, None, Some("number of the row, from 0".to_owned())))
        .chain(meanings)
        .chain(spec.columns.iter().map(|column| {
            let under = match column.name().strip_prefix(column.quantity.name) {
                Some("") if column.quantity.is_of_control() => ", under path.control",
                Some("_displacement") => ", the approach held",
                Some("_force") => ", the force held",
                _ => "",
            };
            (None, unit(column.quantity.unit), Some(format!("{}{under}", column.quantity.meaning)))
        }))
        .chain([(None, None, Some("why a quantity could not be had; empty where all is well".to_owned()))]);
    let column = |(name, (symbol, unit, meaning)): (String, (_, _, Option<String>))| ColumnInfo {
        name,
        symbol,
        unit,
        meaning: meaning.unwrap_or_default(),
    };
    record::names(spec).into_iter().zip(meanings).map(column).collect()
}

impl ColumnInfo {
    /// What stands beside an axis: its symbol or name, and its unit.
    #[must_use]
    pub fn title(&self) -> String {
        let name = self.symbol.as_ref().unwrap_or(&self.name);
        let unit = self.unit.as_ref().map(|unit| unit.replace("^2", "²"));
        unit.map_or_else(|| name.clone(), |unit| format!("{name} ({unit})"))
    }
}

impl Sidecar {
    /// Reads the file beside `results`, with its text.
    pub fn read(results: &Path) -> Result<(Self, String), SidecarError> {
        let path = path(results);
        // Every value of every axis stands in it.
        let (text, _) = read_text(&path, 4 * file::LARGEST)?;
        let unknown =
            |what: &str| SidecarError::Unknown { path: show_path(&path), what: sanitize(what, 120) };
        let sidecar: Self = toml::from_str(&text).map_err(|error| unknown(error.message()))?;
        sidecar.shard.parse::<Shard>().map_err(|error| unknown(&format!("shard: {error}")))?;
        Ok((sidecar, text))
    }

    /// The layout of the results beside `text`, that of this file.
    pub fn layout(&self, results: &Path, text: &str) -> Result<Layout, SidecarError> {
        let path = path(results);
        let document = SpecText { name: &path.to_string_lossy(), text };
        let (axes, design) = of_canonical(document)
            .map_err(|error| SidecarError::Unknown { path: error.origin.to_string(), what: error.what })?;
        let columns = self.columns.iter().map(|column| column.name.clone()).collect();
        Ok(Layout { axes, design, columns })
    }

    /// The keys of the axes, which are the names of their columns.
    #[must_use]
    pub fn axes(&self) -> Vec<String> {
        self.sweep.axis.iter().map(|axis| axis.key.clone()).collect()
    }

    /// Whether the values of the axes are drawn at random.
    #[must_use]
    pub fn is_random(&self) -> bool {
        self.sweep.random.is_some()
    }

    /// The part.
    #[must_use]
    pub fn shard(&self) -> Shard {
        // Checked when it was read.
        self.shard.parse().unwrap_or(Shard::WHOLE)
    }
}
