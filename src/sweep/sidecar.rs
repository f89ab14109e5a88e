//! The file beside the results, `RESULTS.csv.spec.toml`: which sweep and which part of it they belong to, and what the
//! columns are.
//!
//! Many CSV readers do not accept comments, so the results themselves contain only the table. The sweep is recognised
//! by the hash of its canonical form, which is also in this file, with the whole preset, so that the results can be
//! computed again from it.

use super::record::{self, COUNTS, Layout};
use super::shard::Shard;
use super::spec::{canonical, identity};
use crate::mend::mend;
use crate::store::file::{self, FileError, read_text};
use pulloff_engine::report::columns::sentence as units_of_csv;
use pulloff_engine::sweep::Spec;
use pulloff_engine::sweep::document::SpecText;
use pulloff_engine::sweep::ensemble::{COUNT, STATISTICS};
use pulloff_engine::sweep::spec::of_canonical;
use pulloff_engine::text::{greek, headline, sanitize, show_path};
use pulloff_engine::units::{Quantity, Unit, UnitSystem};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use thiserror::Error;
use toml::{Table, Value};

/// The suffix added to the name of the results.
const ENDING: &str = ".spec.toml";

/// Why the file beside some results is of no use. Names and paths in the error are safe to show.
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

mend!(SidecarError, as 0 of File, always Unknown);

/// A column of the results.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct ColumnInfo {
    pub name: String,
    /// Its symbol in formulas; `None` where it has none.
    pub symbol: Option<String>,
    /// The unit of its numbers; `None` for pure numbers, text, and in reduced units.
    pub unit: Option<String>,
    /// The unit in which a figure shows them, where it differs.
    pub shown: Option<String>,
    pub meaning: String,
}

/// The contents of the file.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct Sidecar {
    pub identity: String,
    shard: String,
    pub rows: u64,
    /// Whether its rows are statistics of the members of an ensemble.
    #[serde(default)]
    statistics: bool,
    #[serde(rename = "column")]
    pub columns: Vec<ColumnInfo>,
    sweep: Canonical,
}

/// The part of the canonical form that is read.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
struct Canonical {
    /// The text of the preset.
    preset: String,
    axis: Vec<AxisKey>,
    /// How rows are drawn, if they are.
    random: Option<Draws>,
    ensemble: Option<Draws>,
}

#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
struct Draws {}

#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
struct AxisKey {
    key: String,
    /// The distribution from which its values are drawn, if they are.
    distribution: Option<Draws>,
}

/// The file beside the statistics of an ensemble, and their layout.
pub(super) struct Beside {
    pub(super) text: String,
    pub(super) layout: Layout,
}

/// The file beside these results.
pub fn path(results: &Path) -> PathBuf {
    let mut name = results.as_os_str().to_owned();
    name.push(ENDING);
    PathBuf::from(name)
}

/// The text of the file for a part of a sweep.
pub fn text(spec: &Spec, shard: Shard) -> String {
    let rows = format!("rows = {}", spec.rows);
    written(&identity(spec), shard, &rows, &canonical(spec), &columns(spec))
}

fn written(identity: &str, shard: Shard, rows: &str, canonical: &str, columns: &[ColumnInfo]) -> String {
    let mut text = format!(
        "# What the results beside this file belong to. `pulloff sweep` reads it to continue and to join shards.\n\
         identity = \"{identity}\"\nshard = \"{shard}\"\n{rows}\n\n{canonical}"
    );
    for ColumnInfo { name, symbol, unit, shown, meaning } in columns {
        let quoted = |text: &str| Value::String(text.to_owned()).to_string();
        let line = |key: &str, value: &Option<String>| {
            value.as_ref().map_or_else(String::new, |value| format!("{key} = {}\n", quoted(value)))
        };
        let (symbol, unit, shown) = (line("symbol", symbol), line("unit", unit), line("shown", shown));
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "\n[[column]]\nname = {}\n{symbol}{unit}{shown}meaning = {}\n",
            quoted(name),
            quoted(meaning)
        );
    }
    text
}

/// The canonical form in the text of the file.
pub(super) fn canonical_in(text: &str) -> Option<&str> {
    let (_, rest) = text.split_once("\n\n")?;
    Some(&rest[..rest.find("\n[[column]]\n").unwrap_or(rest.len())])
}

/// The text for the whole sweep, derived from that of a part.
pub fn of_whole(text: &str, part: Shard) -> String {
    let line = |shard: Shard| format!("\nshard = \"{shard}\"\n");
    text.replacen(&line(part), &line(Shard::WHOLE), 1)
}

/// The ways in which sweeps may differ: the keys in the canonical form, and the words for them.
const PARTS: [(&[&str], &str); 6] = [
    (&["program_version"], "another version of pulloff"),
    (&["preset"], "another preset"),
    (&["data"], "other measured data"),
    (&["combine", "random", "ensemble"], "other rows of the same axes"),
    (&["quantities"], "other quantities"),
    (&["axis"], "other axes or values"),
];

/// How a sweep differs from the one in this sidecar text, in words that are safe to show.
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
    if named.is_empty() { "a different form".to_owned() } else { named.join(", ") }
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
    /// The largest number listed.
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

/// A column without a unit.
fn plain(name: &str, meaning: &str) -> ColumnInfo {
    ColumnInfo { name: name.to_owned(), symbol: None, unit: None, shown: None, meaning: meaning.to_owned() }
}

/// The units of the columns of a sweep's results in one line; `None` if they have none.
pub fn units(spec: &Spec) -> Option<String> {
    let all = columns(spec);
    units_of_csv(all.iter().filter_map(|column| Some((column.name.as_str(), column.unit.as_deref()?))))
}

fn columns(spec: &Spec) -> Vec<ColumnInfo> {
    let units = &spec.preset.units;
    let measured = |info: ColumnInfo, quantity: Quantity, shown: Option<&Unit>| ColumnInfo {
        unit: (*units != UnitSystem::Reduced).then(|| quantity.si()).flatten().map(str::to_owned),
        shown: shown.map(ToString::to_string),
        ..info
    };
    let axes = spec.axes.iter().map(|axis| match spec.preset.row(&axis.key) {
        Some(row) => {
            let info = ColumnInfo { symbol: Some(greek(&row.label)), ..plain(&axis.key, &row.meaning) };
            measured(info, row.quantity, row.unit_in(units))
        }
        None => plain(&axis.key, ""),
    });
    let quantities = spec.columns.iter().map(|wanted| {
        let (name, quantity) = (wanted.name(), wanted.quantity);
        let under = match name.strip_prefix(quantity.name) {
            Some("") if quantity.is_of_control() => ", under path.control",
            Some("_displacement") => ", the approach held",
            Some("_force") => ", the force held",
            _ => "",
        };
        let symbol = Some(quantity.symbol).filter(|symbol| !symbol.is_empty()).map(str::to_owned);
        let info = ColumnInfo { symbol, ..plain(&name, &format!("{}{under}", quantity.meaning)) };
        measured(info, quantity.unit, units.unit(quantity.unit))
    });
    let row = plain(record::ROW, "number of the row, from 0");
    let error = plain(record::ERROR, "why a quantity could not be computed; empty if there is no error");
    std::iter::once(row).chain(axes).chain(quantities).chain([error]).collect()
}

impl ColumnInfo {
    /// The title of an axis: the meaning in words, the symbol, and the unit in which it is shown.
    pub fn title(&self) -> String {
        /// As many letters fit beside the shorter side of a figure.
        const ROOM: usize = 32;
        // A key of a preset contains a dot, and its meaning describes it; the name of a quantity describes itself.
        let of_name = self.name.rsplit('.').next().unwrap_or(&self.name);
        let of_name = of_name.replace("pull_off", "pull-off").replace('_', " ");
        let meaning = if self.name.contains('.') { headline(&self.meaning) } else { "" };
        let unit = self.shown.clone().or_else(|| self.unit.as_ref().map(|unit| unit.replace("^2", "²")));
        let unit = unit.map_or_else(String::new, |unit| format!(" ({unit})"));
        let symbol = self.symbol.as_deref().unwrap_or_default();
        let behind = if symbol.is_empty() { String::new() } else { format!(", {symbol}") };
        let worded = [meaning, &of_name].into_iter().filter(|words| !words.is_empty());
        let mut titles = worded.map(|words| format!("{words}{behind}{unit}")).collect::<Vec<_>>();
        titles.push(format!("{}{unit}", if symbol.is_empty() { &of_name } else { symbol }));
        let fitting = titles.iter().position(|title| title.chars().count() <= ROOM);
        titles.swap_remove(fitting.unwrap_or(titles.len() - 1))
    }

    /// A number of the column in the unit in which it is shown.
    pub fn shown(&self, number: f64) -> f64 {
        let unit = self.shown.as_ref().and_then(|unit| Unit::parse(unit, 0).ok());
        unit.map_or(number, |unit| unit.from_si(number))
    }
}

impl Sidecar {
    /// Reads the file beside `results`; returns it with its text.
    pub fn read(results: &Path) -> Result<(Self, String), SidecarError> {
        let path = path(results);
        // It contains every value of every axis.
        let unknown =
            |what: &str| SidecarError::Unknown { path: show_path(&path), what: sanitize(what, 120) };
        if results.is_file() && !path.exists() {
            let what = format!("is not the results of a sweep: there is no {} beside it", show_path(&path));
            return Err(SidecarError::Unknown { path: show_path(results), what });
        }
        // Where both are missing, the file that was asked for is the one to name.
        let missing = !path.exists() && !results.exists();
        let (text, _) = read_text(if missing { results } else { &path }, 4 * file::LARGEST)?;
        let sidecar: Self = toml::from_str(&text).map_err(|error| unknown(error.message()))?;
        sidecar.shard.parse::<Shard>().map_err(|error| unknown(&format!("shard: {error}")))?;
        Ok((sidecar, text))
    }

    /// The text of the swept preset.
    pub fn preset(&self) -> &str {
        &self.sweep.preset
    }

    /// The layout of the results beside this file, whose content is `text`.
    pub fn layout(&self, results: &Path, text: &str) -> Result<Layout, SidecarError> {
        let path = path(results);
        let document = SpecText { name: &path.to_string_lossy(), text };
        let (axes, design) = of_canonical(document)
            .map_err(|error| SidecarError::Unknown { path: error.origin.to_string(), what: error.what })?;
        let columns = self.columns.iter().map(|column| column.name.clone()).collect();
        let layout = Layout { axes, design, columns };
        Ok(if self.statistics { layout.of_points() } else { layout })
    }

    /// The file beside the statistics of the members that this file, with this `text`, describes.
    pub(super) fn of_statistics(&self, text: &str, members: &Layout, points: u64) -> Beside {
        let is_drawn = |column: &ColumnInfo| {
            members.axes.iter().any(|axis| axis.key == column.name && axis.count().is_none())
        };
        let is_axis = |name: &str| members.axes.iter().any(|axis| axis.key == name);
        let mut columns: Vec<ColumnInfo> = Vec::new();
        for column in self.columns.iter().filter(|column| !is_drawn(column)) {
            match column.name.as_str() {
                record::ROW => {
                    let meaning = "number of the point, from 0".to_owned();
                    columns.push(ColumnInfo { meaning, ..column.clone() });
                }
                record::ERROR => {
                    columns.extend(COUNTS.map(|(name, meaning)| plain(name, meaning)));
                    columns.push(plain(record::ERROR, "which members are missing or have an error"));
                }
                name if is_axis(name) => columns.push(column.clone()),
                name => columns.extend(STATISTICS.map(|(statistic, words)| {
                    let meaning = format!("{words} of {}: {}", name.replace('_', " "), column.meaning);
                    let own =
                        ColumnInfo { name: record::statistic(name, statistic), meaning, ..column.clone() };
                    if statistic == COUNT {
                        ColumnInfo { unit: None, shown: None, symbol: None, ..own }
                    } else {
                        own
                    }
                })),
            }
        }
        let rows = format!("rows = {points}\nstatistics = true");
        let canonical = canonical_in(text).unwrap_or_default();
        let text = written(&self.identity, Shard::WHOLE, &rows, canonical, &columns);
        let columns = columns.into_iter().map(|column| column.name).collect();
        Beside { text, layout: Layout { columns, ..members.clone().of_points() } }
    }

    /// The keys of the axes, which are also the names of their columns.
    pub fn axes(&self) -> Vec<String> {
        let all = self.sweep.axis.iter().filter(|axis| !self.statistics || axis.distribution.is_none());
        all.map(|axis| axis.key.clone()).collect()
    }

    /// Whether the rows are the members of an ensemble.
    pub fn is_of_members(&self) -> bool {
        self.sweep.ensemble.is_some() && !self.statistics
    }

    /// Whether the rows are statistics of the members of an ensemble.
    pub fn is_statistics(&self) -> bool {
        self.statistics
    }

    /// Whether the values of the axes are drawn at random.
    pub fn is_random(&self) -> bool {
        self.sweep.random.is_some() || self.is_of_members()
    }

    /// The part of the sweep.
    pub fn shard(&self) -> Shard {
        // Validated when it was read.
        self.shard.parse().unwrap_or(Shard::WHOLE)
    }
}
