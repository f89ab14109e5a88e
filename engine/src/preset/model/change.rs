//! The preset changed by dotted key: a change is refused as a whole or made as a whole.

use super::Preset;
use crate::gap::Shape;
use crate::preset::build::build;
use crate::preset::data;
use crate::preset::edge;
use crate::preset::family::{self, parameter_key};
use crate::preset::groups;
use crate::preset::invalid::Invalid;
use crate::preset::measured;
use crate::preset::resolve::{count_in_own_units, in_units};
use crate::preset::rows::parameter;
use crate::preset::schema::{
    ADHESION, CHOOSERS, Fallback, Key, Kind, Parameter, RANGE_KEYS, SYSTEMS, rivals,
};
use crate::preset::shape;
use crate::preset::value::Value;
use crate::preset::values::Values;
use crate::problem::Control;
use crate::text::quote;
use crate::units::{Quantity, UnitSystem, parse_quantity};

const CONTROL: &str = "path.control";

impl Preset {
    /// Gives a key another value.
    ///
    /// The word `none` removes the value of an [optional](Parameter::is_optional) key.
    ///
    /// A start replaces another start, and a turn another turn; `path.control.stiffness` makes the device a spring. A
    /// `gap.shape` drops the keys of the old shape, and keeps the old waves, or takes the proportions of the paper's Fig. 9. A
    /// `gap.formula` keeps the parameters it has in common with the old one; its others begin with the value of an old
    /// one with a similar name, or with 1. A `basis.kind` drops the keys of the old basis and takes the defaults of the
    /// new one. In SI a control of another dimension drops the rate. A group (see [`groups`]) changes the values it
    /// follows from. The rows of a `gap.file` come from the preset's files, relative to the folder of the previous file.
    ///
    /// # Errors
    /// The key is unknown, or the preset would no longer be valid; it is left as it was.
    pub fn set(&mut self, key: &str, value: Value) -> Result<(), Invalid> {
        self.set_all([(key, value)])
    }

    /// Gives several keys other values at once. The whole is checked when all are laid down; choices come first, and
    /// groups are set last, in their order, as for assignments on the command line.
    ///
    /// # Errors
    /// As [`set`](Self::set).
    pub fn set_all<'a>(
        &mut self,
        changes: impl IntoIterator<Item = (&'a str, Value)>,
    ) -> Result<(), Invalid> {
        let (mut plain, mut grouped) = (Vec::new(), Vec::new());
        for (key, value) in changes {
            let row = self.row(key).ok_or_else(|| self.unknown_key(key))?;
            let value = row.check(self.located(&row, value)?)?;
            let list = if groups::row(key).is_some() { &mut grouped } else { &mut plain };
            list.push((row, value));
        }
        // What is specified about the columns of a file comes before the file, which is then read for its spring.
        let order = |row: &Parameter| match &*row.key {
            key if CHOOSERS.contains(&key) => 0,
            data::COLUMNS => 1,
            // A control takes away the rate that was, and not one that is given with it.
            edge::RATE => 3,
            _ => 2,
        };
        plain.sort_by_key(|(row, _)| order(row));
        let mut changed = self.clone();
        if !plain.is_empty() {
            let mut values = self.keyed();
            for (row, value) in plain {
                self.lay(&mut values, &row, value);
            }
            changed = build(&values, self.files).map_err(|mut all| all.swap_remove(0))?;
        }
        for (row, value) in grouped {
            changed.set_group(&row, value)?;
        }
        *self = changed;
        Ok(())
    }

    /// Lays a value over the others: removes what it displaces, and adds what it requires.
    fn lay(&self, values: &mut Values, row: &Parameter, value: Value) {
        if row.takes_away(&value) {
            // A number for the range gave the adhesion its range; without any such number it has none.
            let had_range = values.remove(row.whole()).is_some() && RANGE_KEYS.contains(&&*row.key);
            if had_range && self.range_of_action().is_none() {
                values.remove(ADHESION);
            }
            return;
        }
        if CHOOSERS.contains(&&*row.key) {
            values.retain(|key, _| {
                parameter(key).is_some_and(|other| other.fits(&row.key, &value.to_string()))
            });
        }
        // A rate of a force is none of a length: in SI it would become another rate of the same number.
        if row.whole() == CONTROL
            && (value.to_string() == "force") != (self.path.control == Control::Force)
            && self.units != UnitSystem::Reduced
        {
            values.remove(edge::RATE);
        }
        match &*row.key {
            "gap.shape" => {
                let radius = self.gap.length().unwrap_or_else(|| self.reduced().units.length);
                shape::begin(values, &value.to_string(), radius, self.gap.wave());
            }
            // A number beside a unit, which was only a remark, is now in that unit; values already in SI have lost
            // their unit.
            key if key == CHOOSERS[2] && self.units == UnitSystem::Reduced => {
                values.insert(row.key.clone(), value.clone());
                count_in_own_units(values);
            }
            key if key == CHOOSERS[2] && value.to_string() != SYSTEMS[1] => {
                values.retain(|key, _| !family::is_unit(key));
            }
            data::FILE if value.is_none() => {
                values.remove(data::FILE);
                return;
            }
            data::FILE => {
                // A tare was found for one file only.
                let own = self.data.source.as_ref();
                if let (Value::Points(source), Some(own)) = (&value, own)
                    && !source.has_bytes_of(own)
                {
                    values.remove(data::TARE);
                }
                // A device without a stiffness becomes the spring that the file states.
                let columns = values.get(data::COLUMNS).map(ToString::to_string).unwrap_or_default();
                let is_alone =
                    values.get(data::SETTINGS).is_some_and(|word| word.to_string() == data::SETTINGS_OF[1]);
                let states = !is_alone
                    && match &value {
                        Value::Points(source) => {
                            source.measured(&columns).is_ok_and(|of| of.stiffness.is_some())
                        }
                        _ => false,
                    };
                if states && !matches!(self.path.control, Control::Stiffness(_)) {
                    values.remove(CONTROL);
                }
            }
            key => {
                let rivals = rivals(key);
                values.retain(|key, _| !rivals.contains(&&**key));
            }
        }
        put(values, row, value);
        if row.key == "gap.formula" {
            for new in shape::fit_parameters(values, |_| false) {
                // For a partly typed or misspelt name, the value of the name it resembles does the least harm.
                let value = new.alike.map_or(Value::Number(1.0), |(_, value)| value);
                values.insert(parameter_key(&new.name).into(), value);
            }
        }
    }

    /// A value of a key as this preset would keep it: within the range of its row, and with a unit in a text read in
    /// the preset's units. Constraints from other keys are not checked.
    ///
    /// # Errors
    /// The key is unknown, or does not accept the value.
    pub fn resolved(&self, key: &str, value: Value) -> Result<Value, Invalid> {
        let row = self.row(key).ok_or_else(|| self.unknown_key(key))?;
        let Value::Typed(text) = row.check(value.clone())? else { return row.check(value) };
        let x = if groups::row(key).is_some() {
            pure(&row, &text)?
        } else {
            in_units(&self.keyed(), &self.units, &row.key, &text)?
        };
        row.check(if row.kind == Kind::Control { Control::Stiffness(x).into() } else { x.into() })
    }

    fn set_group(&mut self, row: &Parameter, value: Value) -> Result<(), Invalid> {
        let x = match value {
            Value::Number(x) => x,
            other => pure(row, &other.to_string())?,
        };
        let mut changed = self.clone();
        for (key, value) in groups::changes(self, row, x)? {
            changed.set(&key, value)?;
        }
        *self = changed;
        Ok(())
    }

    /// Gives a key the value of a text, as an assignment on the command line does: in SI a bare number is in SI units,
    /// or in the unit of its own if a formula's parameter has one.
    ///
    /// # Errors
    /// As [`Parameter::parse`] and [`Preset::set`].
    pub fn assign(&mut self, key: &str, text: &str) -> Result<(), Invalid> {
        self.set(key, self.assigned(key, text)?)
    }

    /// The value that an assignment gives to a key.
    fn assigned(&self, key: &str, text: &str) -> Result<Value, Invalid> {
        let row = self.row(key).ok_or_else(|| self.unknown_key(key))?;
        self.read(&row, text)
    }

    /// The value of a row that a text gives: a bare number is in the row's own unit if it has one.
    ///
    /// # Errors
    /// As [`Parameter::parse`].
    pub fn read(&self, row: &Parameter, text: &str) -> Result<Value, Invalid> {
        if row.own_unit_in(&self.units).is_some() { self.typed(row, text) } else { row.parse(text) }
    }

    /// A value in SI or reduced units with its unit, where a bare number would be in the row's own.
    pub fn with_unit(&self, key: &str, value: &Value) -> Value {
        match (self.row(key), value) {
            (Some(row), Value::Number(x)) => row.exact_in_si(&self.units, *x).map(Value::Typed),
            _ => None,
        }
        .unwrap_or_else(|| value.clone())
    }

    /// Gives several keys the values of texts, one after the other as on a command line, or all at once if one of them
    /// needs a later one.
    ///
    /// # Errors
    /// As [`assign`](Self::assign), for all at once; the preset is left as it was.
    pub fn assign_all(&mut self, assignments: &[(Key, String)]) -> Result<(), Invalid> {
        let mut changed = self.clone();
        let (rates, others): (Vec<_>, Vec<_>) = assignments.iter().partition(|(key, _)| key == edge::RATE);
        if others.into_iter().chain(rates).try_for_each(|(key, text)| changed.assign(key, text)).is_err() {
            changed = self.clone();
            let values = assignments.iter().map(|(key, text)| Ok((&**key, self.assigned(key, text)?)));
            changed.set_all(values.collect::<Result<Vec<_>, Invalid>>()?)?;
        }
        *self = changed;
        Ok(())
    }

    /// The value of a row as a user types it beside its unit: in SI a bare number is in the unit shown there.
    ///
    /// # Errors
    /// As [`Parameter::parse`].
    pub fn typed(&self, row: &Parameter, text: &str) -> Result<Value, Invalid> {
        let (Some(unit), true) =
            (row.unit_in(&self.units), row.kind.is_number() || row.kind == Kind::Control)
        else {
            return row.parse(text);
        };
        let number = text.trim();
        let number = if row.kind == Kind::Control {
            number.strip_prefix("stiffness=").unwrap_or(number)
        } else {
            number
        };
        match parse_quantity(number) {
            Ok(value) if value.unit.is_none() => row.parse(&format!("{number} {}", unit.ascii())),
            _ => row.parse(text),
        }
    }

    /// The number that a text gives for a row, as an assignment on the command line would read it, in SI or reduced
    /// units.
    ///
    /// # Errors
    /// As [`Parameter::parse`]; a unit of another dimension; a word.
    pub fn number(&self, row: &Parameter, text: &str) -> Result<f64, Invalid> {
        match self.resolved(&row.key, self.read(row, text)?)? {
            Value::Number(x) => Ok(x),
            Value::Integer(n) => Ok(n as f64),
            _ => Err(row.wrong_type(format!("the text \"{}\"", quote(text)))),
        }
    }

    /// Makes an optional key follow from others again, or sets it to its default.
    ///
    /// # Errors
    /// The key is unknown or required.
    pub fn reset(&mut self, key: &str) -> Result<(), Invalid> {
        let row = self.row(key).ok_or_else(|| self.unknown_key(key))?;
        let mut values = self.keyed();
        values.remove(row.whole());
        if let (Fallback::Text(word), true) = (row.fallback, CHOOSERS.contains(&&*row.key)) {
            values.retain(|key, _| parameter(key).is_some_and(|other| other.fits(&row.key, word)));
        }
        *self = build(&values, self.files).map_err(|mut all| all.swap_remove(0))?;
        Ok(())
    }

    /// A value in the form to be checked: a file is read from the folder of the previous one.
    fn located(&self, row: &Parameter, value: Value) -> Result<Value, Invalid> {
        let folder = match (&self.gap, row.kind) {
            (_, Kind::Points) => self.data.source.as_ref().and_then(|source| source.folder.as_deref()),
            (Shape::Profile(before), _) => before.rows().folder.as_deref(),
            _ => return Ok(value),
        };
        measured::located(self.files, row, value, folder)
    }
}

/// The number that a text gives for a group, which has no unit.
fn pure(row: &Parameter, text: &str) -> Result<f64, Invalid> {
    let cause = |cause| Invalid::Units { key: row.key.clone(), cause };
    parse_quantity(text).and_then(|typed| typed.in_si(Quantity::Number, None)).map_err(cause)
}

/// Stores a checked value; a part of a value becomes the whole.
pub(in crate::preset) fn put(values: &mut Values, row: &Parameter, value: Value) {
    match (&*row.key, value) {
        ("path.control.stiffness", Value::Number(k)) => {
            values.insert(CONTROL.into(), Control::Stiffness(k).into());
        }
        ("path.control.stiffness", Value::Typed(text)) => {
            values.insert(CONTROL.into(), Value::Typed(text));
        }
        (_, value) => {
            values.insert(row.key.clone(), value);
        }
    }
}
