//! TOML text and `--set` assignments → preset.
//!
//! The file is laid down first, then the assignments in order; the whole is checked once, and the assignments of groups
//! are made last. Every value
//! remembers where it came from, so a message can name the line or the assignment.

use super::build::{Values, build};
use super::family;
use super::groups;
use super::invalid::Invalid;
use super::measured;
use super::model::{Preset, put, unknown_key};
use super::schema::{CHOOSERS, Key, Kind, Parameter, START_KEYS, parameter, table_of, tables};
use super::shape::fit_parameters;
use super::suggest::closest;
use super::text::{quote, sanitize, show_name};
use super::value::Value;
use crate::contact::shapes::harmonics::MOST_WAVES;
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use thiserror::Error;
use toml::de::{DeArray, DeTable, DeValue};

/// How many mistakes are collected before reading stops.
const MISTAKES: usize = 20;

/// Where a value came from. Names and texts in it are already safe to show.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// A file, and the line where known.
    File {
        /// The file's name.
        name: String,
        /// The line, from 1.
        line: Option<usize>,
    },
    /// An assignment, as typed.
    Assignment(String),
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { name, line: Some(line) } => write!(f, "{name}:{line}"),
            Self::File { name, line: None } => f.write_str(name),
            Self::Assignment(text) => write!(f, "--set {text}"),
        }
    }
}

/// One thing wrong with a preset, and where.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{origin}: {invalid}")]
pub struct Mistake {
    /// Where.
    pub origin: Origin,
    /// What.
    pub invalid: Invalid,
}

/// All that is wrong with a preset, in the order of its lines; at least one mistake.
#[derive(Debug, Clone, PartialEq, Error)]
pub struct ReadError {
    /// The mistakes.
    pub mistakes: Vec<Mistake>,
}

impl fmt::Display for ReadError {
    /// The first mistake, and how many more there are.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(first) = self.mistakes.first() {
            write!(f, "{first}")?;
        }
        match self.mistakes.len() {
            0 | 1 => Ok(()),
            2 => f.write_str(" (and 1 more mistake)"),
            n => write!(f, " (and {} more mistakes)", n - 1),
        }
    }
}

/// Reads a preset; `name` names the text in messages.
///
/// # Errors
/// Every mistake found, with its line.
pub fn read(name: &str, text: &str) -> Result<Preset, ReadError> {
    read_with(name, text, &[] as &[&str])
}

/// Reads a preset and lays `KEY=VALUE` assignments over it, in order.
///
/// # Errors
/// Every mistake found, with its line or assignment.
pub fn read_with<S: AsRef<str>>(name: &str, text: &str, assignments: &[S]) -> Result<Preset, ReadError> {
    read_in(None, name, text, assignments)
}

/// Reads a preset whose files are relative to `folder`, or to the current one; those of assignments always are relative
/// to the current one.
///
/// # Errors
/// Every mistake found, with its line or assignment.
pub fn read_in<S: AsRef<str>>(
    folder: Option<&Path>,
    name: &str,
    text: &str,
    assignments: &[S],
) -> Result<Preset, ReadError> {
    let folder = folder.map(Path::to_path_buf);
    let mut sheet = Sheet { name: show_name(name), folder, ..Sheet::default() };
    match DeTable::parse(text) {
        Ok(document) => sheet.lay("", document.get_ref(), &Place::File(text)),
        Err(error) => sheet.syntax(text, &error),
    }
    for assignment in assignments {
        sheet.assign(assignment.as_ref());
    }
    sheet.finish()
}

/// What is known of one key.
struct Entry {
    value: Result<Value, Invalid>,
    origin: Origin,
}

/// The layers laid down so far.
#[derive(Default)]
struct Sheet {
    name: String,
    /// The folder of the file.
    folder: Option<PathBuf>,
    /// Whether an assignment chose a formula: its parameters need not fit those of the file.
    refit: bool,
    entries: BTreeMap<Key, Entry>,
    /// Assignments of groups: laid over the whole, when all they follow from is known.
    groups: Vec<(String, String, Origin)>,
    /// Where the file's tables begin.
    tables: BTreeMap<Key, Origin>,
    mistakes: Vec<Mistake>,
}

/// Where the values being laid down come from.
enum Place<'a> {
    File(&'a str),
    Assignment(&'a str),
}

impl Sheet {
    fn origin(&self, place: &Place<'_>, at: usize) -> Origin {
        match place {
            Place::File(text) => Origin::File { name: self.name.clone(), line: Some(line(text, at)) },
            Place::Assignment(text) => Origin::Assignment(quote(text)),
        }
    }

    /// Lays down the keys of a table, and of the tables in it.
    fn lay(&mut self, prefix: &str, table: &DeTable<'_>, place: &Place<'_>) {
        for (key, value) in table {
            if self.mistakes.len() >= MISTAKES {
                return;
            }
            let name: &str = key.get_ref();
            let full = match (prefix, name) {
                ("", _) => name.to_owned(),
                // `lambda = { value = 1, … }` is `lambda = 1` and more.
                (_, "value") if family::is_parameter(prefix) => prefix.to_owned(),
                _ => format!("{prefix}.{name}"),
            };
            let origin = self.origin(place, key.span().start);
            // A quoted key with a dot in it is none of ours, whatever it spells.
            let plain = !name.contains('.');
            let row = parameter(&full).filter(|_| plain);
            let known_table = Some(&*full).filter(|table| plain && is_table(table));
            match (value.get_ref(), row, known_table) {
                (DeValue::Array(waves), _, Some(family::WAVE_TABLE)) => {
                    self.tables.insert(family::WAVE_TABLE.into(), origin.clone());
                    self.lay_waves(waves, origin, place);
                }
                (DeValue::Table(inner), row, Some(table)) if name != "value" => {
                    self.tables.insert(table.to_owned().into(), origin.clone());
                    match row {
                        Some(row) if inner.is_empty() => {
                            self.put(&row, Err(row.wrong_type("an empty table".to_owned())), origin);
                        }
                        _ => self.lay(table, inner, place),
                    }
                }
                (other, Some(row), _) => {
                    let value = Value::from_toml(other).map_err(|found| row.wrong_type(found));
                    let folder = match place {
                        Place::File(_) => self.folder.as_deref(),
                        Place::Assignment(_) => None,
                    };
                    let value = value.and_then(|value| located(&row, row.check(value)?, folder));
                    self.put(&row, value, origin);
                }
                (other, None, Some(table)) => self.mistake(origin, not_table(table, found(other))),
                (_, None, None) => {
                    let invalid = match (place, closest(&full, tables())) {
                        // A table by a wrong name is worth one message, and no guess among the keys.
                        (_, Some(table)) if value.get_ref().is_table() => {
                            Invalid::UnknownKey { key: quote(&full), meant: Some(table.into()) }
                        }
                        _ => unknown_key(&full),
                    };
                    self.mistake(origin, invalid);
                }
            }
        }
    }

    /// Lays down the waves of an array.
    fn lay_waves(&mut self, waves: &DeArray<'_>, origin: Origin, place: &Place<'_>) {
        if matches!(place, Place::Assignment(_)) {
            self.entries.retain(|key, _| family::below(key, family::WAVE_TABLE).is_none());
        }
        if waves.len() > MOST_WAVES {
            let invalid = Invalid::Range {
                key: family::WAVE_TABLE.into(),
                value: format!("{} waves", waves.len()),
                allowed: format!("at most {MOST_WAVES}"),
            };
            return self.mistake(origin, invalid);
        }
        for (i, wave) in waves.iter().enumerate() {
            if self.mistakes.len() >= MISTAKES {
                return;
            }
            let table = format!("{}.{}", family::WAVE_TABLE, i + 1);
            let origin = self.origin(place, wave.span().start);
            match wave.get_ref() {
                DeValue::Table(wave) => {
                    self.tables.insert(table.clone().into(), origin);
                    self.lay(&table, wave, place);
                }
                other => self.mistake(origin, not_table(&table, found(other))),
            }
        }
    }

    /// Lays down one `KEY=VALUE`.
    fn assign(&mut self, assignment: &str) {
        if self.mistakes.len() >= MISTAKES {
            return;
        }
        let place = Place::Assignment(assignment);
        let origin = self.origin(&place, 0);
        let Some((key, text)) = assignment.split_once('=') else {
            return self.mistake(origin, Invalid::Assignment);
        };
        let key = key.trim();
        let parsed = DeValue::parse(text.trim());
        let inner = parsed.as_ref().ok().and_then(|value| value.get_ref().as_table());
        if let (family::WAVE_TABLE, Ok(Some(waves))) =
            (key, parsed.as_ref().map(|value| value.get_ref().as_array()))
        {
            return self.lay_waves(waves, origin, &place);
        }
        if groups::row(key).is_some() {
            return self.groups.push((key.to_owned(), text.to_owned(), origin));
        }
        match (parameter(key), Some(key).filter(|key| is_table(key)), inner) {
            (_, Some(table), Some(inner)) if !inner.is_empty() => self.lay(table, inner, &place),
            (Some(row), _, _) => {
                let value = row.parse(text).and_then(|value| located(&row, value, None));
                self.put(&row, value, origin);
            }
            (None, Some(table), _) => {
                self.mistake(origin, not_table(table, format!("\"{}\"", quote(text.trim()))));
            }
            (None, None, _) => self.mistake(origin, unknown_key(key)),
        }
    }

    /// Stores what was found for a key. An assignment replaces what the file said in another way: another start,
    /// the waves of another shape, the size of another basis.
    fn put(&mut self, row: &Parameter, value: Result<Value, Invalid>, origin: Origin) {
        if matches!(origin, Origin::Assignment(_)) {
            self.refit = self.refit || row.key == "gap.formula";
            if START_KEYS.contains(&&*row.key) {
                self.entries.retain(|key, _| !START_KEYS.contains(&&**key));
            }
            if let (Ok(word), true) = (&value, CHOOSERS.contains(&&*row.key)) {
                let word = word.to_string();
                self.entries.retain(|key, entry| {
                    matches!(entry.origin, Origin::Assignment(_))
                        || parameter(key).is_some_and(|other| other.fits(&row.key, &word))
                });
            }
        }
        match value {
            Ok(value) => {
                let mut one = Values::new();
                put(&mut one, row, value);
                for (key, value) in one {
                    self.entries.insert(key, Entry { value: Ok(value), origin: origin.clone() });
                }
            }
            Err(invalid) => {
                let whole = row.table().filter(|_| row.is_part()).unwrap_or(&row.key).to_owned();
                self.entries.insert(whole.into(), Entry { value: Err(invalid), origin });
            }
        }
    }

    fn mistake(&mut self, origin: Origin, invalid: Invalid) {
        self.mistakes.push(Mistake { origin, invalid });
    }

    fn syntax(&mut self, text: &str, error: &toml::de::Error) {
        let span = error.span().unwrap_or_default();
        let origin = self.origin(&Place::File(text), span.start);
        // The parser's words quote no source text, but nothing promises that they never will.
        let mut what = sanitize(error.message(), 120);
        if let Some(at) = text.get(span).map(str::trim).filter(|at| !at.is_empty()) {
            what = format!("{what}: {}", quote(at));
        }
        self.mistake(origin, Invalid::Syntax { what });
    }

    /// The preset, or all that is wrong with it.
    fn finish(mut self) -> Result<Preset, ReadError> {
        // A file of another format, or no TOML at all: what else is wrong with it means nothing.
        if self.mistakes.iter().any(|mistake| matches!(mistake.invalid, Invalid::Syntax { .. })) {
            self.mistakes.retain(|mistake| matches!(mistake.invalid, Invalid::Syntax { .. }));
            return Err(ReadError { mistakes: self.mistakes });
        }
        if let Some(Entry { value: Err(invalid @ Invalid::Format { .. }), origin }) =
            self.entries.get("format")
        {
            let mistake = Mistake { origin: origin.clone(), invalid: invalid.clone() };
            return Err(ReadError { mistakes: vec![mistake] });
        }
        let mut values = Values::new();
        let mut mistakes = std::mem::take(&mut self.mistakes);
        for (key, entry) in &self.entries {
            match &entry.value {
                Ok(value) => {
                    values.insert(key.clone(), value.clone());
                }
                Err(invalid) => {
                    mistakes.push(Mistake { origin: entry.origin.clone(), invalid: invalid.clone() });
                }
            }
        }
        if self.refit {
            let assigned = |key: &str| {
                self.entries.get(key).is_some_and(|entry| matches!(entry.origin, Origin::Assignment(_)))
            };
            fit_parameters(&mut values, assigned);
        }
        match build(&values) {
            Ok(mut preset) if mistakes.is_empty() => {
                for (key, text, origin) in &self.groups {
                    if let Err(invalid) = preset.assign(key, text) {
                        mistakes.push(Mistake { origin: origin.clone(), invalid });
                    }
                }
                if mistakes.is_empty() {
                    return Ok(preset);
                }
            }
            Ok(_) => {}
            Err(faults) => {
                let misspelt = meant_keys(&mistakes);
                let misspelt: Vec<&str> = misspelt.iter().map(AsRef::as_ref).collect();
                for invalid in faults.into_iter().filter(|fault| !self.is_echo(fault, &misspelt)) {
                    mistakes.push(Mistake { origin: self.origin_of(&invalid), invalid });
                }
            }
        }
        // Lines in order; what has no line, and the assignments, at the end.
        mistakes.sort_by_key(|mistake| match mistake.origin {
            Origin::File { line: Some(line), .. } => (0, line),
            Origin::File { line: None, .. } => (1, 0),
            Origin::Assignment(_) => (2, 0),
        });
        mistakes.truncate(MISTAKES);
        Err(ReadError { mistakes })
    }

    /// Whether a key only seems to be missing: its value was refused, or its name is misspelt.
    fn is_echo(&self, fault: &Invalid, misspelt: &[&str]) -> bool {
        let of_table = |key: &str, table: &str| table_of(key) == Some(table);
        match fault {
            Invalid::Missing { key, .. } => self.entries.contains_key(key) || misspelt.contains(&&**key),
            Invalid::MissingTable { table, .. } => {
                self.entries.keys().any(|key| of_table(key, table))
                    || misspelt.iter().any(|key| *key == &**table || of_table(key, table))
            }
            _ => false,
        }
    }

    /// Where to point for a fault found in the whole: the key, else its table, else the file.
    fn origin_of(&self, invalid: &Invalid) -> Origin {
        // A range that two keys make together is the later layer's doing.
        if let Invalid::EndBeyondStart { .. } | Invalid::Wide { .. } = invalid {
            let partners = [START_KEYS[0], "path.end_contact_radius", "gap.radius_of_curvature"];
            let said = partners.iter().filter_map(|key| self.entries.get(*key));
            if let Some(entry) = said.into_iter().find(|entry| matches!(entry.origin, Origin::Assignment(_)))
            {
                return entry.origin.clone();
            }
        }
        let key = invalid.key();
        if let Some(entry) = key.and_then(|key| self.entries.get(key)) {
            return entry.origin.clone();
        }
        let table = key.and_then(|key| self.tables.get(table_of(key)?));
        table.cloned().unwrap_or(Origin::File { name: self.name.clone(), line: None })
    }
}

/// What the unknown keys were meant to be.
fn meant_keys(mistakes: &[Mistake]) -> Vec<Key> {
    let meant = |mistake: &Mistake| match &mistake.invalid {
        Invalid::UnknownKey { meant, .. } => meant.clone(),
        _ => None,
    };
    mistakes.iter().filter_map(meant).collect()
}

/// Whether a key holds other keys.
fn is_table(key: &str) -> bool {
    family::is_table(key) || tables().any(|table| table == key)
}

/// A value as it is kept: the name of a file stands for its rows, read here.
fn located(row: &Parameter, value: Value, folder: Option<&Path>) -> Result<Value, Invalid> {
    match value {
        Value::Text(name) if row.kind == Kind::File => {
            let cause = |cause| Invalid::Gap { key: row.key.clone(), cause };
            Ok(Value::Profile(Arc::new(measured::load(folder, &name).map_err(cause)?)))
        }
        value => Ok(value),
    }
}

fn not_table(table: &str, found: String) -> Invalid {
    let inside = super::schema::PARAMETERS.iter().find(|row| row.table() == Some(table));
    let table = Key::from(table.to_owned());
    let example = match (inside, &*table) {
        (Some(row), _) => row.key.clone(),
        (None, family::PARAMETER_TABLE) => family::parameter_key("R").into(),
        (None, family::WAVE_TABLE) => family::wave_key(1, "amplitude").into(),
        (None, wave) => format!("{wave}.amplitude").into(),
    };
    Invalid::NotTable { table, found, example }
}

fn found(value: &DeValue<'_>) -> String {
    match Value::from_toml(value) {
        Ok(value) => format!("\"{}\"", quote(&value.to_string())),
        Err(found) => found,
    }
}

/// The line of a byte, from 1.
pub fn line(text: &str, at: usize) -> usize {
    1 + text.bytes().take(at).filter(|byte| *byte == b'\n').count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Start;
    use crate::contact::{Control, Shape};
    use crate::preset::model::{BasisSpec, Functions};
    use crate::ritz::Grading;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    const WAVY: &str = r#"format = 1
title = "Wavy sphere, A/λ = 0.05"
[material]
effective_modulus = 1.0
work_of_adhesion = 0.003978873577297384
[gap]
shape = "wavy-sphere"
radius_of_curvature = 1.0
amplitude = 0.0025
wavelength = 0.05
[basis]
kind = "rings"
rings = 200
[path]
control = "displacement"
start_contact_radius = 0.5
end_contact_radius = 0.002
"#;

    fn messages(text: &str, assignments: &[&str]) -> Vec<String> {
        read_with("w.toml", text, assignments).unwrap_err().mistakes.iter().map(ToString::to_string).collect()
    }

    /// The one mistake in the file with `old` replaced by `new`.
    fn edited(old: &str, new: &str) -> String {
        assert!(WAVY.contains(old), "{old}");
        let all = messages(&WAVY.replacen(old, new, 1), &[]);
        assert_eq!(all.len(), 1, "{all:?}");
        all[0].clone()
    }

    fn set(assignments: &[&str]) -> Preset {
        read_with("w.toml", WAVY, assignments).unwrap()
    }

    #[test]
    fn the_contract_reads() {
        let preset = read("w.toml", WAVY).unwrap();
        assert_eq!(preset.title, "Wavy sphere, A/λ = 0.05");
        assert_eq!(
            preset.gap,
            Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 }
        );
        assert_eq!(preset.path.start, Start::ContactRadius(0.5));
        assert_eq!(preset.path.end_contact_radius, Some(0.002));
        let spring = WAVY.replace("\"displacement\"", "{ stiffness = 0.15 }");
        assert_eq!(read("w.toml", &spring).unwrap().path.control, Control::Stiffness(0.15));
        let dotted = WAVY.replace("control = \"displacement\"", "control.stiffness = 2");
        assert_eq!(read("w.toml", &dotted).unwrap().path.control, Control::Stiffness(2.0));
        assert_eq!(read("w.toml", &WAVY.replace('\n', "\r\n")).unwrap(), preset);
        assert_eq!(read("w.toml", &format!("\u{feff}{WAVY}")).unwrap(), preset);
    }

    #[test]
    fn material_and_gap_are_enough() {
        let end = WAVY.find("[basis]").unwrap();
        let preset = read("w.toml", &WAVY[..end]).unwrap();
        assert_eq!(preset.basis, BasisSpec::Spectral { functions: Functions::Auto });
        assert_eq!(preset.path.start, Start::ContactRadius(0.5));
    }

    #[test]
    fn each_mistake_names_file_line_key_and_what_was_meant() {
        for (old, new, expected) in [
            ("amplitude =", "amplitud =", "w.toml:9: unknown key gap.amplitud; did you mean gap.amplitude?"),
            ("[material]", "[materials]", "w.toml:3: unknown key materials; did you mean material?"),
            ("rings = 200", "rings = 200\nrings = 300", "w.toml:14: duplicate key: rings"),
            (
                "rings = 200",
                "rings = 3",
                "w.toml:13: basis.rings = 3 is out of range: it must be a whole number from 4 to 2000",
            ),
            (
                "rings = 200",
                "rings = 2e2",
                "w.toml:13: basis.rings must be a whole number from 4 to 2000, not the number 200.0",
            ),
            (
                "amplitude = 0.0025",
                "amplitude = \"big\"",
                "w.toml:9: gap.amplitude must be 0 or a number from 1e-30 to 1e30, not the text \"big\"",
            ),
            (
                "amplitude = 0.0025",
                "amplitude = [1]",
                "w.toml:9: gap.amplitude must be 0 or a number from 1e-30 to 1e30, not an array",
            ),
            (
                "wavelength = 0.05",
                "wavelength = inf",
                "w.toml:10: gap.wavelength = inf is out of range: it must be a number from 1e-30 to 1e30",
            ),
            (
                "wavelength = 0.05",
                "",
                "w.toml:6: gap.wavelength is missing: it must be a number from 1e-30 to 1e30",
            ),
            (
                "\"wavy-sphere\"",
                "\"wavy sphere\"",
                "w.toml:7: gap.shape = \"wavy sphere\" is not known: it must be \"sphere\" or \"wavy-sphere\" or \"exact-sphere\" or \"cone\" or \"power-law\" or \"harmonics\" or \"random-waves\" or \"formula\" or \"profile\"; did you mean wavy-sphere?",
            ),
            ("format = 1", "format = 2", "w.toml:1: format = 2 is not known: this version reads format 1"),
            (
                "[path]",
                "[path]\nstart_force = 1",
                "w.toml:15: path.start_force and path.start_contact_radius both say where the path starts: give exactly one",
            ),
            (
                "end_contact_radius = 0.002",
                "end_contact_radius = 0.6",
                "w.toml:17: path.end_contact_radius = 0.6 is not below path.start_contact_radius = 0.5",
            ),
            (
                "\"displacement\"",
                "{ stiffnes = 1 }",
                "w.toml:15: unknown key path.control.stiffnes; did you mean path.control.stiffness?",
            ),
            (
                "\"displacement\"",
                "{}",
                "w.toml:15: path.control must be \"displacement\", \"force\" or { stiffness = k } with k > 0, not an empty table",
            ),
            (
                "\"displacement\"",
                "{ stiffness = 0 }",
                "w.toml:15: path.control.stiffness = 0.0 is out of range: it must be a number from 1e-30 to 1e30",
            ),
            ("title = \"Wavy sphere, A/λ = 0.05\"", "\"gap.shape\" = 1", "w.toml:2: unknown key gap.shape"),
        ] {
            let message = edited(old, new);
            assert!(message.starts_with(expected), "{message}\n{expected}");
        }
        assert_eq!(
            messages("", &[]),
            [
                "w.toml: the table [gap] is missing: it needs shape",
                "w.toml: the table [material] is missing: it needs effective_modulus, work_of_adhesion"
            ]
        );
        assert!(
            messages("gap = 3", &[])[0]
                .starts_with("w.toml:1: gap is a table, not \"3\"; set one of its keys, as gap.shape")
        );
        assert!(messages("[[gap]]", &[])[0].starts_with("w.toml:1: gap is a table, not an array"));
    }

    #[test]
    fn stray_wave_keys_on_a_sphere_are_named() {
        let lines = messages(&WAVY.replace("wavy-sphere", "sphere"), &[]);
        assert_eq!(
            lines,
            [
                "w.toml:9: gap.amplitude belongs to wavy-sphere, and the gap is a sphere",
                "w.toml:10: gap.wavelength belongs to wavy-sphere, and the gap is a sphere"
            ]
        );
    }

    const FORMULA: &str = r#"[material]
effective_modulus = 1
work_of_adhesion = 0.004
[gap]
shape = "formula"
formula = "r^2/(2*R) + A*(1 - cos(2*pi*r/lambda))"
[gap.parameters]
R = 1
A = { value = 0.0025, min = 0, max = 0.01 }
lambda.value = 0.05
lambda.unit = "mm"
"#;

    const WAVES: &str = r#"[material]
effective_modulus = 1
work_of_adhesion = 0.004
[gap]
shape = "harmonics"
radius_of_curvature = 1
[[gap.waves]]
amplitude = 0.001
wavelength = 0.05
[[gap.waves]]
amplitude = 0.002
wavelength = 0.1
phase = 1
"#;

    #[test]
    fn formulas_and_waves_read() {
        let preset = read("f.toml", FORMULA).unwrap();
        assert_eq!(preset.path.start, Start::ContactRadius(0.5));
        for (key, value) in [
            ("gap.parameters.R", Value::Number(1.0)),
            ("gap.parameters.A.max", 0.01.into()),
            ("gap.parameters.lambda", 0.05.into()),
            ("gap.parameters.lambda.unit", "mm".into()),
        ] {
            assert_eq!(preset.get(key), Some(value), "{key}");
        }
        let with = |assignments: &[&str]| read_with("f.toml", FORMULA, assignments).unwrap();
        assert_eq!(with(&["gap.parameters.A=0.005"]).get("gap.parameters.A"), Some(0.005.into()));
        let other = with(&["gap.formula=r^2/(2*R) + b*r^4", "gap.parameters.R=2"]);
        assert_eq!(other.get("gap.parameters.R"), Some(2.0.into()));
        assert_eq!((other.get("gap.parameters.b"), other.get("gap.parameters.A")), (Some(1.0.into()), None));

        let preset = read("h.toml", WAVES).unwrap();
        assert_eq!(preset.get("gap.waves.1.phase"), Some(0.0.into()));
        assert_eq!(preset.get("gap.waves.2.wavelength"), Some(0.1.into()));
        let with = |assignments: &[&str]| read_with("h.toml", WAVES, assignments).unwrap();
        assert_eq!(with(&["gap.waves.2.phase=2"]).get("gap.waves.2.phase"), Some(2.0.into()));
        let one = with(&["gap.waves=[{amplitude=0.003, wavelength=0.2}]"]);
        assert_eq!(
            (one.get("gap.waves.1.wavelength"), one.get("gap.waves.2.phase")),
            (Some(0.2.into()), None)
        );
        assert_eq!(with(&["gap.waves=[]"]).gap.radius_of_curvature(), Some(1.0));
    }

    #[test]
    fn mistakes_in_formulas_and_waves_are_named() {
        let many = format!("gap.waves=[{}]", "{amplitude=1,wavelength=1},".repeat(1001));
        for (text, old, new, assignment, expected) in [
            (FORMULA, "/lambda))", "/lambda)", "", "f.toml:6: gap.formula: column 38: the '(' at column 15"),
            (FORMULA, "R = 1\n", "", "", "f.toml:7: gap.parameters.R is missing: it must be a number"),
            (
                FORMULA,
                "R = 1\n",
                "R = 1\nlamda = 1\n",
                "",
                "f.toml:9: the formula has no parameter for gap.parameters.lamda; did you mean gap.parameters.lambda?",
            ),
            (FORMULA, "R = 1\n", "R = 1\nr = 1\n", "", "f.toml:9: unknown key gap.parameters.r"),
            (FORMULA, "R = 1\n", "R = true\n", "", "f.toml:8: gap.parameters.R must be a number"),
            (
                FORMULA,
                "value = 0.0025",
                "value = 0.02",
                "",
                "f.toml:9: gap.parameters.A = 0.02 is out of range: it must be a number from 0.0 to 0.01",
            ),
            (FORMULA, "min = 0", "mini = 0", "", "f.toml:9: unknown key gap.parameters.A.mini"),
            (
                FORMULA,
                "r^2/(2*R)",
                "R - sqrt(0.09*R^2 - r^2)",
                "",
                "f.toml:6: gap.formula: the formula is not finite at r = 0.3 (up to r = 0.5",
            ),
            (FORMULA, "", "", "gap.parameters=3", "--set gap.parameters=3: gap.parameters is a table"),
            (FORMULA, "", "", "gap.parameters.x=3", "--set gap.parameters.x=3: the formula has no parameter"),
            (WAVES, "amplitude = 0.001\n", "", "", "h.toml:7: gap.waves.1.amplitude is missing"),
            (
                WAVES,
                "wavelength = 0.1",
                "wavelength = 0",
                "",
                "h.toml:12: gap.waves.2.wavelength = 0.0 is out",
            ),
            (WAVES, "phase = 1", "fase = 1", "", "h.toml:13: unknown key gap.waves.2.fase"),
            (WAVES, "", "", "gap.waves.4.phase=1", "h.toml: gap.waves.3.amplitude is missing"),
            (WAVES, "", "", &many, "--set gap.waves=[{amplitude=1,wavelength=1}...: gap.waves = 1001 waves"),
            (WAVES, "", "", "gap.waves=[1]", "--set gap.waves=[1]: gap.waves.1 is a table"),
        ] {
            let name = if text == WAVES { "h.toml" } else { "f.toml" };
            let assignments: Vec<&str> = Some(assignment).into_iter().filter(|a| !a.is_empty()).collect();
            assert!(text.contains(old));
            let error = read_with(name, &text.replacen(old, new, 1), &assignments).unwrap_err();
            let message = error.mistakes[0].to_string();
            assert!(message.starts_with(expected), "{message}\n{expected}");
        }
    }

    #[test]
    fn a_profile_is_read_from_beside_its_preset() {
        let folder = tempfile::tempdir().unwrap();
        let rows: Vec<String> = (0..20).map(|i| format!("{i}, {}\n", i * i)).collect();
        let rows = rows.concat();
        std::fs::write(folder.path().join("scan.csv"), format!("r [um], h [nm]\n{rows}")).unwrap();
        let text = "[material]\neffective_modulus=1\nwork_of_adhesion=0.1\n[gap]\nshape='profile'\nfile='scan.csv'\n                    [path]\nstart_contact_radius=5\n";
        let read =
            |text: &str, assignments: &[&str]| read_in(Some(folder.path()), "p.toml", text, assignments);
        let preset = read(text, &[]).unwrap();
        // h = r²/1000 in µm: R = 500 µm.
        assert!((preset.gap.radius_of_curvature().unwrap() - 500.0).abs() < 1e-6);
        assert_eq!(preset.get("gap.smoothing"), Some("none".into()));
        assert_eq!(read(text, &["gap.smoothing=4"]).unwrap().get("gap.smoothing"), Some(4.0.into()));
        for (old, new, expected) in [
            ("scan.csv", "none.csv", "p.toml:6: gap.file: "),
            ("scan.csv", ".", "p.toml:6: gap.file: "),
            ("scan.csv", "shipped:x", "p.toml:6: gap.file: \"shipped:x\" does not come with the program"),
            (
                "radius=5",
                "radius=19",
                "p.toml:8: path.start_contact_radius = 19.0 is out of range: the gap is known",
            ),
            ("[path]\nstart_contact_radius=5\n", "", "p.toml: path.start_contact_radius = 250.0"),
        ] {
            let message = read(&text.replace(old, new), &[]).unwrap_err().to_string();
            assert!(message.starts_with(expected), "{message}");
        }
        // A copy elsewhere still finds its rows.
        let other = tempfile::tempdir().unwrap();
        let moved = preset.placed_in(other.path());
        let back =
            read_in(Some(other.path()), "q.toml", &crate::preset::write(&moved), &[] as &[&str]).unwrap();
        assert_eq!(back.gap.radius_of_curvature(), preset.gap.radius_of_curvature());
        assert_eq!(preset.placed_in(folder.path()), preset);
    }

    #[test]
    fn all_mistakes_come_in_the_order_of_lines() {
        let text = WAVY.replace("= 200", "= 1").replace("= 0.0025", "= -1").replace("title", "titel");
        let lines = messages(&text, &["path.start=1"]);
        let starts = [
            "w.toml:2: unknown key titel; did you mean title?",
            "w.toml:9:",
            "w.toml:13:",
            "--set path.start=1:",
        ];
        assert_eq!(lines.len(), starts.len(), "{lines:?}");
        assert!(lines.iter().zip(starts).all(|(line, start)| line.starts_with(start)), "{lines:?}");
        let error = read("w.toml", &text).unwrap_err();
        assert!(error.to_string().ends_with("(and 2 more mistakes)"), "{error}");
    }

    #[test]
    fn assignments_are_laid_over_the_file_in_order() {
        assert_eq!(
            set(&["basis.rings=400"]).basis,
            BasisSpec::Rings { rings: 400, grading: Grading::Uniform }
        );
        assert_eq!(
            set(&["basis.rings=400", "basis.rings = 50"]).basis,
            BasisSpec::Rings { rings: 50, grading: Grading::Uniform }
        );
        assert_eq!(set(&["title=a = b"]).title, "a = b");
        for spring in [
            "path.control=stiffness=0.15",
            "path.control.stiffness=0.15",
            "path.control={stiffness=0.15}",
            "path={control={stiffness=0.15}}",
        ] {
            assert_eq!(set(&[spring]).path.control, Control::Stiffness(0.15), "{spring}");
        }
        assert_eq!(set(&["path.control.stiffness=1", "path.control=force"]).path.control, Control::Force);
        assert_eq!(set(&["path.start_force=0.02"]).path.start, Start::Force(0.02));
        assert_eq!(set(&["path.start_force=0.02", "path.start_approach=1"]).path.start, Start::Approach(1.0));
        assert_eq!(set(&["gap.shape=sphere"]).gap, Shape::Sphere { radius_of_curvature: 1.0 });
    }

    #[test]
    fn a_basis_drops_and_brings_its_keys() {
        let auto = BasisSpec::Spectral { functions: Functions::Auto };
        assert_eq!(set(&["basis.kind=spectral"]).basis, auto);
        assert_eq!(set(&["basis.kind=spectral", "basis.functions=auto"]).basis, auto);
        let count = BasisSpec::Spectral { functions: Functions::Count(64) };
        assert_eq!(set(&["basis.functions=64", "basis.kind=spectral"]).basis, count);
        let text = WAVY.replace("\"rings\"\nrings = 200", "\"spectral\"\nfunctions = \"auto\"");
        assert_eq!(read("w.toml", &text).unwrap().basis, auto);
        for (old, new, expected) in [
            (
                "\"rings\"",
                "\"spectral\"",
                "w.toml:13: basis.rings belongs to rings, and the basis is spectral",
            ),
            (
                "rings = 200",
                "functions = 9",
                "w.toml:13: basis.functions belongs to spectral, and the basis is rings",
            ),
            (
                "\"rings\"\nrings = 200",
                "\"spectral\"\nfunctions = 3",
                "w.toml:13: basis.functions = 3 is out of range: it must be \"auto\" or a whole number from 4 to 4096",
            ),
            (
                "\"rings\"\nrings = 200",
                "\"spectral\"\nfunctions = \"many\"",
                "w.toml:13: basis.functions must be \"auto\" or a whole number from 4 to 4096, not the text \"many\"",
            ),
        ] {
            assert_eq!(edited(old, new), expected);
        }
    }

    #[test]
    fn an_assignment_repairs_a_wrong_line() {
        let text = WAVY.replace("= 200", "= 1");
        assert_eq!(
            read_with("w.toml", &text, &["basis.rings=9"]).unwrap().basis,
            BasisSpec::Rings { rings: 9, grading: Grading::Uniform }
        );
    }

    #[test]
    fn a_wrong_assignment_is_named() {
        for (assignment, expected) in [
            ("gap.amplitude=-1", "--set gap.amplitude=-1: gap.amplitude = -1.0 is out of range"),
            ("gap.amplitude", "--set gap.amplitude: an assignment is KEY=VALUE"),
            (
                "gap.wavelenght=1",
                "--set gap.wavelenght=1: unknown key gap.wavelenght; did you mean gap.wavelength?",
            ),
            ("gap=1", "--set gap=1: gap is a table, not \"1\"; set one of its keys, as gap.shape"),
            ("=1", "--set =1: unknown key "),
            (
                "path.start_contact_radius=0.001",
                "--set path.start_contact_radius=0.001: path.end_contact_radius = 0.002 is not below",
            ),
            (
                "gap.radius_of_curvature=0.01",
                "--set gap.radius_of_curvature=0.01: path.start_contact_radius = 0.5 is out of range",
            ),
            ("format=3", "--set format=3: format = 3 is not known"),
        ] {
            let lines = messages(WAVY, &[assignment]);
            assert!(lines[0].starts_with(expected), "{lines:?}\n{expected}");
        }
        let lines = messages(WAVY, &["gap.shape=sphere", "gap.amplitude=1"]);
        assert_eq!(
            lines,
            ["--set gap.amplitude=1: gap.amplitude belongs to wavy-sphere, and the gap is a sphere"]
        );
        let sphere = "[material]\neffective_modulus=1\nwork_of_adhesion=0\n[gap]\nshape='sphere'\nradius_of_curvature=1";
        let lines = messages(sphere, &["gap.shape=wavy-sphere"]);
        assert!(lines[0].starts_with("w.toml:4: gap.amplitude is missing"), "{lines:?}");
    }

    #[test]
    fn foreign_text_is_short_and_harmless_in_messages() {
        let long = "x".repeat(5000);
        for text in [
            format!("\"\\u001b]0;owned\\u0007{long}\" = 1"),
            format!("[gap]\nshape = \"\\u001b[2J\\u202e{long}\""),
            format!("title = \"\u{202e}\"\n{long} = \u{1b}"),
            format!("{long} {long}"),
        ] {
            for mistake in read(&format!("a\nb\u{1b}{long}.toml"), &text).unwrap_err().mistakes {
                let message = mistake.to_string();
                assert!(message.len() < 500, "{message}");
                assert!(!message.chars().any(crate::preset::text::is_unsafe), "{message:?}");
            }
        }
    }

    #[test]
    fn many_mistakes_end_quickly() {
        let text: String = (0..50_000).map(|i| format!("k{i} = 1")).collect::<Vec<_>>().join("\n");
        assert_eq!(messages(&text, &[]).len(), MISTAKES);
    }

    fn config() -> ProptestConfig {
        ProptestConfig {
            cases: 256,
            rng_seed: RngSeed::Fixed(9),
            failure_persistence: None,
            ..ProptestConfig::default()
        }
    }

    proptest! {
        #![proptest_config(config())]

        #[test]
        fn no_text_brings_the_reader_down(text in "\\PC*|[\\x00-\\x7f]{0,200}", assignment in "\\PC{0,60}") {
            let _ = read_with("p.toml", &text, &[assignment]);
        }

        #[test]
        fn no_damage_to_a_preset_brings_the_reader_down(which in 0usize..3, at in 0..WAVY.len(), cut in 0usize..20, new in "[-a-z0-9.=\\[\\]{}\"' \n]{0,12}") {
            let chars: Vec<char> = [WAVY, FORMULA, WAVES][which].chars().collect();
            let at = at.min(chars.len());
            let end = (at + cut).min(chars.len());
            let text: String = chars[..at].iter().copied().chain(new.chars()).chain(chars[end..].iter().copied()).collect();
            match read("p.toml", &text) {
                Ok(preset) => prop_assert!(preset.check().is_ok()),
                Err(error) => prop_assert!(!error.mistakes.is_empty()),
            }
        }

        #[test]
        fn no_assignment_brings_the_reader_down(key in 0..crate::preset::PARAMETERS.len(), value in "[-a-z0-9.=\\[\\]{}\"' ]{0,12}") {
            let assignment = format!("{}={value}", crate::preset::PARAMETERS[key].key);
            if let Ok(preset) = read_with("p.toml", WAVY, &[assignment]) {
                prop_assert!(preset.check().is_ok());
            }
        }
    }
}
