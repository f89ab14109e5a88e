//! The layers combined into one preset, or everything that is wrong with them.

use super::MISTAKES;
use super::mistake::{Mistake, ReadError, ValueOrigin};
use super::sheet::{Sheet, SheetEntry};
use crate::preset::build::build;
use crate::preset::family::{below, parameter_key};
use crate::preset::invalid::Invalid;
use crate::preset::model::Preset;
use crate::preset::resolve::count_in_own_units;
use crate::preset::schema::{Key, START_KEYS, table_of};
use crate::preset::shape::fit_parameters;
use crate::preset::values::Values;

impl Sheet {
    /// The preset, or everything that is wrong with it.
    pub(super) fn finish(mut self) -> Result<Preset, ReadError> {
        // If the file has another format, or is not TOML at all, its other mistakes mean nothing.
        if self.mistakes.iter().any(|mistake| matches!(mistake.invalid, Invalid::Syntax { .. })) {
            self.mistakes.retain(|mistake| matches!(mistake.invalid, Invalid::Syntax { .. }));
            return Err(ReadError { mistakes: self.mistakes });
        }
        if let Some(SheetEntry { value: Err(invalid @ Invalid::Format { .. }), origin }) =
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
                self.entries.get(key).is_some_and(|entry| matches!(entry.origin, ValueOrigin::Assignment(_)))
            };
            // Another formula's parameters are not guessed: a misspelt one would give a gap that nobody meant.
            for new in fit_parameters(&mut values, assigned) {
                let meant = new.alike.map(|(name, _)| parameter_key(&name).into());
                let key = parameter_key(&new.name).into();
                let origin = self.entries.get("gap.formula").map(|entry| entry.origin.clone());
                let origin = origin.unwrap_or(ValueOrigin::File { name: self.name.clone(), line: None });
                mistakes.push(Mistake { origin, invalid: Invalid::Unset { key, meant } });
            }
        }
        count_in_own_units(&mut values);
        match build(&values, self.files) {
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
        // Lines in order; at the end, mistakes without a line, and the assignments.
        mistakes.sort_by_key(|mistake| match mistake.origin {
            ValueOrigin::File { line: Some(line), .. } => (0, line),
            ValueOrigin::File { line: None, .. } => (1, 0),
            ValueOrigin::Assignment(_) => (2, 0),
        });
        mistakes.truncate(MISTAKES);
        Err(ReadError { mistakes })
    }

    /// Whether a key only seems to be missing: its value, or one below it, was refused, or its name is misspelt.
    fn is_echo(&self, fault: &Invalid, misspelt: &[&str]) -> bool {
        let of_table = |key: &str, table: &str| table_of(key) == Some(table);
        match fault {
            Invalid::Missing { key, .. } => {
                self.entries.contains_key(key)
                    || misspelt.iter().any(|wrong| *wrong == &**key || below(wrong, key).is_some())
            }
            Invalid::MissingTable { table, .. } => {
                self.entries.keys().any(|key| of_table(key, table))
                    || misspelt.iter().any(|key| *key == &**table || of_table(key, table))
            }
            _ => false,
        }
    }

    /// Where to point for a fault found in the whole: the key, otherwise its table, otherwise the file.
    fn origin_of(&self, invalid: &Invalid) -> ValueOrigin {
        // A range that two keys determine together is the fault of the later layer.
        if let Invalid::EndBeyondStart { .. } | Invalid::Wide { .. } = invalid {
            let partners = [START_KEYS[0], "path.end_contact_radius", "gap.radius_of_curvature"];
            let said = partners.iter().filter_map(|key| self.entries.get(*key));
            if let Some(entry) =
                said.into_iter().find(|entry| matches!(entry.origin, ValueOrigin::Assignment(_)))
            {
                return entry.origin.clone();
            }
        }
        let key = invalid.key();
        if let Some(entry) = key.and_then(|key| self.entries.get(key)) {
            return entry.origin.clone();
        }
        let table = key.and_then(|key| self.tables.get(table_of(key)?));
        table.cloned().unwrap_or(ValueOrigin::File { name: self.name.clone(), line: None })
    }
}

/// What the unknown keys were meant to be, and the keys already reported as lacking a value or having a wrong one.
fn meant_keys(mistakes: &[Mistake]) -> Vec<Key> {
    let meant = |mistake: &Mistake| match &mistake.invalid {
        Invalid::UnknownKey { meant, .. } => meant.clone(),
        // Already reported in its own words.
        Invalid::Unset { key, .. } | Invalid::Range { key, .. } => Some(key.clone()),
        Invalid::NotTable { table, .. } => Some(table.clone()),
        _ => None,
    };
    mistakes.iter().filter_map(meant).collect()
}
