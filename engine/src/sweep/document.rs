//! A TOML text read entry by entry, with the line of each mistake.

use crate::preset::read::{ValueOrigin, line};
use crate::text::{closest, quote, sanitize, show_name};
use std::ops::RangeInclusive;
use thiserror::Error;
use toml::de::{DeArray, DeTable, DeValue};

/// What is wrong with a spec, in one line.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{origin}: {what}")]
pub struct SpecError {
    /// Where it is.
    pub origin: ValueOrigin,
    /// What is wrong, safe to show.
    pub what: String,
}

/// The text of a file with its name.
#[derive(Debug, Clone, Copy)]
pub struct SpecText<'a> {
    /// Its name, as shown to the user.
    pub name: &'a str,
    /// TOML.
    pub text: &'a str,
}

/// A table of the document.
#[derive(Debug, Clone)]
pub struct SpecSection<'a> {
    document: SpecText<'a>,
    /// Its dotted name; empty for the document itself.
    name: String,
    table: &'a DeTable<'a>,
    at: usize,
}

/// A key with its value.
#[derive(Debug, Clone)]
pub struct SpecEntry<'a> {
    document: SpecText<'a>,
    /// Its dotted name.
    pub name: String,
    /// Its value.
    pub value: &'a DeValue<'a>,
    at: usize,
}

impl<'a> SpecText<'a> {
    /// The document.
    ///
    /// # Errors
    /// [`SpecError`] with the line if it is not TOML.
    pub fn parse(self) -> Result<DeTable<'a>, SpecError> {
        match DeTable::parse(self.text) {
            Ok(table) => Ok(table.into_inner()),
            Err(error) => {
                let at = error.span().map_or(0, |span| span.start);
                Err(self.fault(at, sanitize(error.message(), 120)))
            }
        }
    }

    fn fault(self, at: usize, what: String) -> SpecError {
        let origin = ValueOrigin::File { name: show_name(self.name), line: Some(line(self.text, at)) };
        SpecError { origin, what }
    }

    /// The document itself as a table.
    pub fn section(self, table: &'a DeTable<'a>) -> SpecSection<'a> {
        SpecSection { document: self, name: String::new(), table, at: 0 }
    }
}

impl<'a> SpecSection<'a> {
    /// Refuses every key that is not among `keys`.
    ///
    /// # Errors
    /// [`SpecError`] that names the key, and the one that was probably meant.
    pub fn only(&self, keys: &[&str]) -> Result<(), SpecError> {
        for (key, _) in self.table {
            let name: &str = key.get_ref();
            if !keys.contains(&name) {
                let meant = closest(name, keys.iter().copied());
                let hint = meant.map_or_else(
                    || format!("; the keys are {}", keys.join(", ")),
                    |meant| format!("; did you mean {meant}?"),
                );
                let what = format!("unknown key {}{hint}", quote(&self.full(name)));
                return Err(self.document.fault(key.span().start, what));
            }
        }
        Ok(())
    }

    fn full(&self, key: &str) -> String {
        if self.name.is_empty() { key.to_owned() } else { format!("{}.{key}", self.name) }
    }

    /// The value of a key; `None` where the table has no such key.
    pub fn get(&self, key: &str) -> Option<SpecEntry<'a>> {
        let (found, value) = self.table.iter().find(|(name, _)| name.get_ref() == key)?;
        let at = found.span().start;
        Some(SpecEntry { document: self.document, name: self.full(key), value: value.get_ref(), at })
    }

    /// The same for a key that must be present.
    ///
    /// # Errors
    /// [`SpecError`], which says what is `allowed`.
    pub fn need(&self, key: &str, allowed: &str) -> Result<SpecEntry<'a>, SpecError> {
        self.get(key)
            .ok_or_else(|| self.fault(&format!("{} is missing: it must be {allowed}", self.full(key))))
    }

    /// An error that names this place.
    pub fn fault(&self, what: &str) -> SpecError {
        self.document.fault(self.at, what.to_owned())
    }
}

impl<'a> SpecEntry<'a> {
    /// An error that names this place.
    pub fn fault(&self, what: &str) -> SpecError {
        self.document.fault(self.at, what.to_owned())
    }

    fn wrong(&self, allowed: &str) -> SpecError {
        self.fault(&format!("{} must be {allowed}, not {}", self.name, found(self.value)))
    }

    /// The value as a text.
    ///
    /// # Errors
    /// [`SpecError`], which says what is `allowed`.
    pub fn text(&self, allowed: &str) -> Result<&'a str, SpecError> {
        self.value.as_str().ok_or_else(|| self.wrong(allowed))
    }

    /// The value as an array, its entries in order.
    ///
    /// # Errors
    /// [`SpecError`], which says what is `allowed`.
    pub fn array(&self, allowed: &str) -> Result<Vec<SpecEntry<'a>>, SpecError> {
        let array: &DeArray<'_> = self.value.as_array().ok_or_else(|| self.wrong(allowed))?;
        let entry = |value: &'a toml::Spanned<DeValue<'a>>| SpecEntry {
            document: self.document,
            name: self.name.clone(),
            value: value.get_ref(),
            at: value.span().start,
        };
        Ok(array.iter().map(entry).collect())
    }

    /// The value as an array of two.
    ///
    /// # Errors
    /// [`SpecError`] if it has another length.
    pub fn pair(&self) -> Result<[SpecEntry<'a>; 2], SpecError> {
        let allowed = "two values, [from, to]";
        <[SpecEntry<'a>; 2]>::try_from(self.array(allowed)?).map_err(|_| self.wrong(allowed))
    }

    /// The value as a table.
    ///
    /// # Errors
    /// [`SpecError`], which says what is `allowed`.
    pub fn section(&self, allowed: &str) -> Result<SpecSection<'a>, SpecError> {
        let table = self.value.as_table().ok_or_else(|| self.wrong(allowed))?;
        Ok(SpecSection { document: self.document, name: self.name.clone(), table, at: self.at })
    }

    /// A whole number in `range`.
    ///
    /// # Errors
    /// [`SpecError`] if it is not a whole number in the range.
    pub fn count(&self, range: RangeInclusive<u64>) -> Result<u64, SpecError> {
        let allowed = format!("a whole number from {} to {}", range.start(), range.end());
        let DeValue::Integer(n) = self.value else { return Err(self.wrong(&allowed)) };
        let n = u64::from_str_radix(n.as_str(), n.radix()).ok().filter(|n| range.contains(n));
        n.ok_or_else(|| {
            self.fault(&format!(
                "{} = {} is out of range: it must be {allowed}",
                self.name,
                found(self.value)
            ))
        })
    }
}

fn found(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("\"{}\"", quote(text)),
        DeValue::Integer(n) => quote(n.as_str()),
        DeValue::Float(x) => quote(x.as_str()),
        DeValue::Boolean(b) => b.to_string(),
        DeValue::Datetime(_) => "a date".to_owned(),
        DeValue::Array(values) => format!("an array of {}", values.len()),
        DeValue::Table(_) => "a table".to_owned(),
    }
}
