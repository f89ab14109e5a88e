//! Values → preset: defaults, required keys, and the checks that span several keys.
//!
//! Every preset is made here, whether from a file, from `--set` or from a key on the screen.

use super::invalid::Invalid;
use super::model::{BasisSpec, Material, PathSpec, Preset};
use super::resolve::{quantity, resolved, shown, system, told};
use super::schema::{
    Applies, CHOOSERS, EXACT, Fallback, Key, PARAMETERS, RADIUS_OVER_CURVATURE, START_KEYS,
    START_OVER_CURVATURE, parameter, table_of,
};
use super::shape;
use super::value::Value;
use crate::contact::Start;
use crate::contact::{Control, Gap};
use crate::ritz::Grading;
use crate::units::{Quantity, UnitSystem};
use std::collections::BTreeMap;

/// Values by dotted key. A part of a value (`path.control.stiffness`) is not a key here.
pub type Values = BTreeMap<Key, Value>;

/// The preset these values make.
///
/// # Errors
/// All that is wrong, at least one.
pub fn build(values: &Values) -> Result<Preset, Vec<Invalid>> {
    let mut faults = Vec::new();
    let units = system(values, &mut faults);
    let values = &resolved(values, &units, &mut faults);
    let mut given = Given { values, units: units.clone(), faults };
    given.check_each();
    given.check_choices();
    let starts: Vec<_> = START_KEYS.into_iter().filter(|key| values.contains_key(*key)).collect();
    if let [first, second, ..] = starts[..] {
        given.faults.push(Invalid::Starts { first: first.into(), second: second.into() });
    }
    let gap = given.shape(starts.first().copied());
    let start = match starts.first() {
        Some(&key) if key == START_KEYS[1] => Start::Approach(given.number(key)),
        Some(&key) if key == START_KEYS[2] => Start::Force(given.number(key)),
        Some(&key) => Start::ContactRadius(given.number(key)),
        None => Start::ContactRadius(match gap.radius_of_curvature() {
            Some(radius) => START_OVER_CURVATURE * radius,
            None => given.required(START_KEYS[0]),
        }),
    };
    let (end, range) = ("path.end_contact_radius", "material.range_of_action");
    let preset = Preset {
        title: given.text("title"),
        units,
        material: Material {
            effective_modulus: given.number("material.effective_modulus"),
            work_of_adhesion: given.number("material.work_of_adhesion"),
            range_of_action: values.contains_key(range).then(|| given.number(range)),
        },
        gap,
        basis: given.basis(),
        path: PathSpec {
            control: given.control("path.control"),
            start,
            end_contact_radius: values.contains_key(end).then(|| given.number(end)),
        },
    };
    let mut faults = given.collapsed();
    if faults.is_empty() {
        faults = across(&preset);
    }
    if faults.is_empty() { Ok(preset) } else { Err(faults) }
}

/// The checks that span several keys.
fn across(preset: &Preset) -> Vec<Invalid> {
    let radius = preset.gap.radius_of_curvature();
    let known = preset.gap.largest_radius();
    let mut faults = Vec::new();
    let length = |x| shown(&preset.units, Quantity::Length, x);
    faults.extend(shape::falls_throughout(preset));
    let end = preset.path.end_contact_radius;
    let start = match preset.path.start {
        Start::ContactRadius(s) => Some(s),
        Start::Approach(_) | Start::Force(_) => None,
    };
    for (key, value) in [(START_KEYS[0], start), ("path.end_contact_radius", end)] {
        let Some(value) = value else { continue };
        if let Some(radius) = radius.filter(|radius| value > RADIUS_OVER_CURVATURE * radius) {
            let (value, radius) = (length(value), length(radius));
            faults.push(Invalid::Wide { key: key.into(), value, radius });
        } else if let Some(largest) = known.filter(|largest| value >= *largest) {
            let (value, largest) = (length(value), length(largest));
            faults.push(Invalid::Beyond { key: key.into(), value, largest });
        }
    }
    if let BasisSpec::Rings { rings, grading } = preset.basis
        && !grading.ring_range().contains(&rings)
    {
        faults.push(Invalid::Rings { key: "basis.rings".into(), rings, grading });
    }
    if let (Some(start), Some(end)) = (start, end)
        && end >= start
    {
        let (end, start) = (length(end), length(start));
        faults.push(Invalid::EndBeyondStart { key: "path.end_contact_radius".into(), end, start });
    }
    faults
}

/// The word of a choice, given or by default; `None` where it is missing or no word of the choice.
///
/// Where the choice has a default and is not given, a key that belongs to one word alone gives it: a file with
/// nothing but `basis.rings` means rings. Units are never guessed: every number of the file would count in others.
pub(super) fn chosen(values: &Values, chooser: &str) -> Option<String> {
    let row = parameter(chooser)?;
    let implied = || {
        values.keys().find_map(|key| match parameter(key)?.applies {
            Applies::With { key, words: [word] } if key == chooser => Some(*word),
            _ => None,
        })
    };
    let word = match (values.get(chooser), row.fallback) {
        (Some(value), _) => value.clone(),
        (None, Fallback::Text(word)) if chooser == CHOOSERS[2] => word.into(),
        (None, Fallback::Text(word)) => implied().unwrap_or(word).into(),
        (None, _) => return None,
    };
    row.check(word).ok().map(|word| word.to_string())
}

/// The values with what was found wrong so far. A value that is missing or wrong reads as one that keeps
/// the rest going; no preset comes of it.
pub(super) struct Given<'a> {
    pub(super) values: &'a Values,
    pub(super) units: UnitSystem,
    pub(super) faults: Vec<Invalid>,
}

impl Given<'_> {
    fn check_each(&mut self) {
        for (key, value) in self.values {
            let Some(row) = parameter(key) else { continue };
            if let Err(fault) = row.check(value.clone()) {
                self.faults.push(told(&self.units, quantity(self.values, key), value, fault));
            }
        }
    }

    /// Keys of other shapes and of the other basis are faults.
    fn check_choices(&mut self) {
        for row in self.values.keys().filter_map(|key| parameter(key)) {
            let Applies::With { key: chooser, words } = row.applies else { continue };
            let Some(word) = chosen(self.values, chooser) else { continue };
            if !row.fits(chooser, &word) {
                if chooser == CHOOSERS[2] {
                    self.faults.push(Invalid::NoUnits { key: row.key.clone() });
                    continue;
                }
                let belongs = words.join(" or ");
                let (what, chosen) = match (chooser, &*word) {
                    ("gap.shape", "harmonics" | "random-waves") => ("gap", format!("one of {word}")),
                    ("gap.shape", "exact-sphere") => ("gap", format!("an {word}")),
                    ("gap.shape", _) => ("gap", format!("a {word}")),
                    _ => ("basis", word),
                };
                self.faults.push(Invalid::OtherChoice { key: row.key.clone(), belongs, what, chosen });
            }
        }
    }

    fn basis(&mut self) -> BasisSpec {
        let count = |n: i64| usize::try_from(n).unwrap_or_default();
        match chosen(self.values, CHOOSERS[1]).as_deref() {
            Some(EXACT) => BasisSpec::Exact,
            // An unknown word is among the faults already.
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

    /// The checked value of a key, or its default; else it is missing.
    pub(super) fn value(&mut self, key: &str) -> Option<Value> {
        let row = parameter(key)?;
        if let Some(value) = self.values.get(key) {
            return row.check(value.clone()).ok();
        }
        let fallback = match row.fallback {
            Fallback::Number(x) => Some(Value::Number(x)),
            Fallback::Integer(n) => Some(Value::Integer(n)),
            Fallback::Text(text) => row.check(text.into()).ok(),
            Fallback::Required | Fallback::Described(_) => None,
        };
        if fallback.is_none() {
            self.faults.push(Invalid::Missing { key: row.key.clone(), allowed: row.allowed() });
        }
        fallback
    }

    pub(super) fn number(&mut self, key: &str) -> f64 {
        if let Some(Value::Number(x)) = self.value(key) { x } else { f64::NAN }
    }

    /// The number of a key that has a default elsewhere, but not here.
    fn required(&mut self, key: &str) -> f64 {
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

    fn control(&mut self, key: &str) -> Control {
        if let Some(Value::Control(control)) = self.value(key) { control } else { Control::Displacement }
    }

    /// The faults; the missing keys of a table that is missing as a whole become one.
    fn collapsed(self) -> Vec<Invalid> {
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
        .filter(|row| row.fallback == Fallback::Required && row.applies == Applies::Always)
        .map(super::schema::Parameter::name)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(pairs: &[(&'static str, Value)]) -> Values {
        pairs.iter().map(|(key, value)| ((*key).into(), value.clone())).collect()
    }

    #[test]
    fn defaults_are_the_documented_ones() {
        let preset = build(&values(&[
            ("material.effective_modulus", 2.0.into()),
            ("material.work_of_adhesion", 0.0.into()),
            ("gap.shape", "sphere".into()),
            ("gap.radius_of_curvature", 3.0.into()),
        ]))
        .unwrap();
        assert_eq!(preset.basis, BasisSpec::Exact);
        assert_eq!(preset.path.control, Control::Displacement);
        assert_eq!(preset.path.start, Start::ContactRadius(1.5));
        assert_eq!(preset.path.end_contact_radius, None);
    }

    #[test]
    fn a_count_alone_says_which_basis_is_meant() {
        let sphere = [
            ("material.effective_modulus", 2.0.into()),
            ("material.work_of_adhesion", 0.0.into()),
            ("gap.shape", "sphere".into()),
            ("gap.radius_of_curvature", 3.0.into()),
        ];
        let with =
            |key, value: Value| build(&values(&[&sphere[..], &[(key, value)]].concat())).map(|p| p.basis);
        let rings = |rings| BasisSpec::Rings { rings, grading: Grading::Uniform };
        assert_eq!(with("basis.rings", 70.into()), Ok(rings(70)));
        assert_eq!(with("basis.kind", "rings".into()), Ok(rings(200)));
        assert_eq!(with("basis.kind", "exact".into()), Ok(BasisSpec::Exact));
    }

    #[test]
    fn all_that_is_wrong_is_said() {
        let faults = build(&values(&[
            ("gap.shape", "sphere".into()),
            ("gap.amplitude", 1.0.into()),
            ("path.start_force", 1.0.into()),
            ("path.start_approach", 1.0.into()),
        ]))
        .unwrap_err();
        let lines: Vec<_> = faults.iter().map(ToString::to_string).collect();
        assert_eq!(
            lines,
            [
                "gap.amplitude belongs to wavy-sphere, and the gap is a sphere",
                "path.start_force and path.start_approach both say where the path starts: give exactly one",
                "gap.radius_of_curvature is missing: it must be a number from 1e-30 to 1e30",
                "the table [material] is missing: it needs effective_modulus, work_of_adhesion",
            ]
        );
    }
}
