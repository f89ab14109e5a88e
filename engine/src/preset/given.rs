//! Values read one by one, each with its default if it is missing, and everything that is wrong with them.

use super::invalid::Invalid;
use super::measured::Files;
use super::model::BasisSpec;
use super::resolve::{quantity, told};
use super::rows::parameter;
use super::schema::{
    ADHESION, Applies, CHOOSERS, EXACT, Fallback, LIQUID_KEYS, PARAMETERS, Parameter, RANGE_KEYS,
    WORK_OF_ADHESION, table_of,
};
use super::value::Value;
use super::values::{Values, chosen};
use crate::problem::{Adhesion, Cohesion, Control, StatedCohesion};
use crate::ritz::Grading;
use crate::units::UnitSystem;

/// The values, with what was found wrong so far. A missing or wrong value is read as one that lets reading continue; no
/// preset results from it.
pub(super) struct GivenValues<'a> {
    pub(super) values: &'a Values,
    pub(super) units: UnitSystem,
    pub(super) files: Files,
    pub(super) faults: Vec<Invalid>,
}

impl GivenValues<'_> {
    pub(super) fn check_each(&mut self) {
        for (key, value) in self.values {
            let Some(row) = parameter(key) else { continue };
            if let Err(fault) = row.check(value.clone()) {
                self.faults.push(told(&self.units, quantity(self.values, key), value, fault));
            }
        }
    }

    /// Keys of other shapes and of the other basis are faults.
    pub(super) fn check_choices(&mut self) {
        for row in self.values.keys().filter_map(|key| parameter(key)) {
            let Applies::With { key: chooser, words } = row.applies else { continue };
            let Some(word) = chosen(self.values, chooser) else { continue };
            if !row.fits(chooser, &word) {
                if chooser == CHOOSERS[2] {
                    self.faults.push(Invalid::NoUnits { key: row.key.clone() });
                    continue;
                }
                let belongs = format!("{chooser} = {}", words.join(" or "));
                let (what, chosen) = match (chooser, &*word) {
                    ("gap.shape", "harmonics" | "random-waves") => ("gap", format!("one of {word}")),
                    ("gap.shape", "exact-sphere") => ("gap", format!("an {word}")),
                    ("gap.shape", _) => ("gap", format!("a {word}")),
                    (ADHESION, _) => ("adhesion", word),
                    _ => ("basis", word),
                };
                self.faults.push(Invalid::OtherChoice { key: row.key.clone(), belongs, what, chosen });
            }
        }
    }

    pub(super) fn basis(&mut self) -> BasisSpec {
        let count = |n: i64| usize::try_from(n).unwrap_or_default();
        match chosen(self.values, CHOOSERS[1]).as_deref() {
            Some(EXACT) => BasisSpec::Exact,
            // An unknown word has already been reported as a fault.
            _ => BasisSpec::Rings {
                rings: count(self.integer("basis.rings")),
                grading: if self.text("basis.grading") == Grading::Edge.name() {
                    Grading::Edge
                } else {
                    Grading::Uniform
                },
            },
        }
    }

    /// How the bodies adhere, and γ.
    pub(super) fn adhesion(&mut self) -> (Adhesion, f64) {
        let word = chosen(self.values, ADHESION).unwrap_or_default();
        if word == Adhesion::NAMES[2] {
            let [surface_tension, kelvin_radius, contact_angle] = LIQUID_KEYS.map(|key| self.number(key));
            let liquid = Adhesion::Capillary { surface_tension, kelvin_radius, contact_angle };
            return (liquid, liquid.cohesion(f64::NAN, None).map_or(f64::NAN, Cohesion::work));
        }
        let gamma = self.number(WORK_OF_ADHESION);
        if word != Adhesion::NAMES[1] {
            return (Adhesion::ShortRange, gamma);
        }
        let given: Vec<&str> = RANGE_KEYS.into_iter().filter(|key| self.values.contains_key(*key)).collect();
        if let [first, second] = given[..] {
            let does = "how far the adhesion reaches";
            self.faults.push(Invalid::Rivals { first: first.into(), second: second.into(), does });
        }
        let stated = match given.first() {
            Some(key) if *key == RANGE_KEYS[0] => StatedCohesion::Strength(self.number(key)),
            Some(key) => StatedCohesion::Range(self.number(key)),
            None => StatedCohesion::Action,
        };
        (Adhesion::Dugdale(stated), gamma)
    }

    /// The checked value of a key, or its default; otherwise it is missing.
    pub(super) fn value(&mut self, key: &str) -> Option<Value> {
        let row = parameter(key)?;
        if let Some(value) = self.values.get(key) {
            return row.check(value.clone()).ok();
        }
        let fallback = match row.fallback {
            Fallback::Number(x) => Some(Value::Number(x)),
            Fallback::Integer(n) => Some(Value::Integer(n)),
            Fallback::Text(text) => row.check(text.into()).ok(),
            Fallback::Required | Fallback::Described(_) | Fallback::Computed => None,
        };
        if fallback.is_none() {
            self.faults.push(Invalid::Missing { key: row.key.clone(), allowed: row.allowed() });
        }
        fallback
    }

    pub(super) fn number(&mut self, key: &str) -> f64 {
        if let Some(Value::Number(x)) = self.value(key) { x } else { f64::NAN }
    }

    /// The number of a key that has a default in other presets, but not in this one.
    pub(super) fn required(&mut self, key: &str) -> f64 {
        self.faults.extend(
            parameter(key).map(|row| Invalid::Missing { key: row.key.clone(), allowed: row.allowed() }),
        );
        f64::NAN
    }

    pub(super) fn integer(&mut self, key: &str) -> i64 {
        if let Some(Value::Integer(n)) = self.value(key) { n } else { 0 }
    }

    pub(super) fn text(&mut self, key: &str) -> String {
        if let Some(Value::Text(text)) = self.value(key) { text } else { String::new() }
    }

    pub(super) fn control(&mut self, key: &str) -> Control {
        if let Some(Value::Control(control)) = self.value(key) { control } else { Control::Displacement }
    }

    /// The faults; the missing keys of a table that is missing altogether become one fault.
    pub(super) fn collapsed(self) -> Vec<Invalid> {
        let present = |table: &str| self.values.keys().any(|key| table_of(key) == Some(table));
        let mut faults: Vec<Invalid> = Vec::new();
        for fault in self.faults {
            let table = match &fault {
                Invalid::Missing { key, .. } => {
                    table_of(key).filter(|table| !present(table) && !required(table).is_empty())
                }
                _ => None,
            };
            let fault = match table {
                Some(table) => {
                    Invalid::MissingTable { table: table.to_owned().into(), keys: required(table).join(", ") }
                }
                None => fault,
            };
            if !faults.contains(&fault) {
                faults.push(fault);
            }
        }
        faults
    }
}

/// The names that a table needs in every preset.
fn required(table: &str) -> Vec<&'static str> {
    PARAMETERS
        .iter()
        .filter(|row| row.table() == Some(table))
        .filter(|row| row.fallback == Fallback::Required)
        .filter(|row| row.applies == Applies::Always || row.key == WORK_OF_ADHESION)
        .map(Parameter::name)
        .collect()
}
