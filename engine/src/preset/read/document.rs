//! Documents and assignments laid down: tables, arrays of waves, single keys.

use super::MISTAKES;
use super::mistake::ValueOrigin;
use super::sheet::{LayerOrigin, Sheet};
use crate::gap::shapes::harmonics::MOST_WAVES;
use crate::preset::called::{key_anywhere, key_called};
use crate::preset::data;
use crate::preset::family;
use crate::preset::groups;
use crate::preset::invalid::Invalid;
use crate::preset::measured::located;
use crate::preset::model::unknown_key;
use crate::preset::rows::{parameter, tables};
use crate::preset::schema::{CHOOSERS, Key, Kind, PARAMETERS};
use crate::preset::value::Value;
use crate::text::closest;
use crate::text::{quote, sanitize};
use std::sync::Arc;
use toml::de::{DeArray, DeTable, DeValue};

impl Sheet {
    /// Lays down the keys of a table, and of the tables in it.
    pub(super) fn lay(&mut self, prefix: &str, table: &DeTable<'_>, place: &LayerOrigin<'_>) {
        for (key, value) in table {
            if self.mistakes.len() >= MISTAKES {
                return;
            }
            let name: &str = key.get_ref();
            let full = match (prefix, name) {
                ("", _) => name.to_owned(),
                // `lambda = { value = 1, … }` means `lambda = 1` and more.
                (_, "value") if family::is_parameter(prefix) => prefix.to_owned(),
                _ => format!("{prefix}.{name}"),
            };
            let origin = self.origin(place, key.span().start);
            // A quoted key with a dot in it is unknown here, whatever it spells.
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
                (DeValue::Table(inner), Some(row), None) if row.key == data::UNCERTAIN => {
                    let mut parts = Vec::new();
                    let value = assigned("", inner, &mut parts).map(|()| Value::Text(parts.join(",")));
                    let value =
                        value.and_then(|value| row.check(value).map_err(|invalid| invalid.to_string()));
                    self.put(&row, value.map_err(|found| row.wrong_type(found)), origin);
                }
                (other, Some(row), _) => {
                    let value = Value::from_toml(other).map_err(|found| row.wrong_type(found));
                    let folder = match place {
                        LayerOrigin::File(_) => self.folder.as_deref(),
                        LayerOrigin::Assignment(_) => None,
                    };
                    let value = value.and_then(|value| match &self.held {
                        Some(held) if row.kind == Kind::File => Ok(Value::Profile(Arc::clone(&held.rows))),
                        Some(held) if row.kind == Kind::Points => Ok(Value::Points(Arc::clone(&held.points))),
                        _ => located(self.files, &row, row.check(value)?, folder),
                    });
                    // A curve may be gone from beside a preset that is good without it.
                    let value = value.map_err(|invalid| match (invalid, place) {
                        (Invalid::Made { key, cause }, LayerOrigin::File(_)) if row.kind == Kind::Points => {
                            Invalid::Made { key, cause: format!("{cause}; data.file = none does without it") }
                        }
                        (invalid, _) => invalid,
                    });
                    self.put(&row, value, origin);
                }
                (other, None, Some(table)) => self.mistake(origin, not_table(table, found(other))),
                (_, None, None) => {
                    let invalid = match (place, closest(&full, tables())) {
                        // A table with an unknown name is worth one message; no guess is made among the keys.
                        (_, Some(table)) if holds_tables(value.get_ref()) => {
                            Invalid::UnknownKey { key: quote(&full), meant: Some(table.into()) }
                        }
                        _ => unknown_key(&full, None),
                    };
                    self.mistake(origin, invalid);
                }
            }
        }
    }

    /// Lays down the waves of an array.
    fn lay_waves(&mut self, waves: &DeArray<'_>, origin: ValueOrigin, place: &LayerOrigin<'_>) {
        if matches!(place, LayerOrigin::Assignment(_)) {
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

    /// Lays down one assignment `KEY=VALUE`.
    pub(super) fn assign(&mut self, assignment: &str) {
        if self.mistakes.len() >= MISTAKES {
            return;
        }
        let place = LayerOrigin::Assignment(assignment);
        let origin = self.origin(&place, 0);
        let Some((key, text)) = assignment.split_once('=') else {
            return self.mistake(origin, Invalid::Assignment);
        };
        let key = key.trim();
        if key.is_empty() {
            return self.mistake(origin, Invalid::NoKey);
        }
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
                let value = row.parse(text).and_then(|value| located(self.files, &row, value, None));
                self.put(&row, value, origin);
            }
            (None, Some(table), _) => {
                self.mistake(origin, not_table(table, format!("\"{}\"", quote(text.trim()))));
            }
            (None, None, _) => match self.called(key) {
                Ok(key) => self.assign(&format!("{key}={text}")),
                Err(invalid) => self.mistake(origin, invalid),
            },
        }
    }

    /// The key that `name` is short for in what has been laid down so far.
    fn called(&self, name: &str) -> Result<Key, Invalid> {
        if let Ok(preset) = self.clone().finish() {
            return key_called(&preset, name);
        }
        let text = |key: &str| Some(self.entries.get(key)?.value.as_ref().ok()?.to_string());
        let is_used = |table: &str| {
            self.entries.keys().any(|key| key.rsplit_once('.').is_some_and(|(of, _)| of == table))
        };
        key_anywhere(text(CHOOSERS[0]).as_deref(), text("gap.formula").as_deref(), &is_used, name)
    }

    pub(super) fn syntax(&mut self, text: &str, error: &toml::de::Error) {
        let span = error.span().unwrap_or_default();
        let origin = self.origin(&LayerOrigin::File(text), span.start);
        // The parser's messages quote no source text, but nothing guarantees that they never will.
        let mut what = sanitize(error.message(), 120);
        if let Some(at) = text.get(span).map(str::trim).filter(|at| !at.is_empty()) {
            what = format!("{what}: {}", quote(at));
        }
        self.mistake(origin, Invalid::Syntax { what });
    }
}

/// The keys of a table with their values, as `KEY=VALUE`, or what is wrong with one of them, in words.
fn assigned(prefix: &str, table: &DeTable<'_>, parts: &mut Vec<String>) -> Result<(), String> {
    for (name, value) in table {
        let name = name.get_ref();
        let key = if prefix.is_empty() { name.to_string() } else { format!("{prefix}.{name}") };
        match value.get_ref() {
            DeValue::Table(inner) => assigned(&key, inner, parts)?,
            value => parts.push(format!("{key}={}", Value::from_toml(value)?)),
        }
    }
    Ok(())
}

/// Whether a key holds other keys.
fn is_table(key: &str) -> bool {
    family::is_table(key) || tables().any(|table| table == key)
}

/// Whether a value is a table, or an array of them.
fn holds_tables(value: &DeValue<'_>) -> bool {
    let of_tables = |array: &DeArray<'_>| array.iter().any(|value| value.get_ref().is_table());
    value.is_table() || value.as_array().is_some_and(of_tables)
}

fn not_table(table: &str, found: String) -> Invalid {
    let inside = PARAMETERS.iter().find(|row| row.table() == Some(table));
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
