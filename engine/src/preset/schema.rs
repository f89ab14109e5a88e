//! The table of parameters: what a row contains, and which rows there are.
//!
//! The rows themselves are in `schema/table.rs`. A new parameter needs a new row there, a field of
//! [`Preset`](super::Preset), and its two lines in `model` (get) and `build`; a test makes sure that none of the three
//! is forgotten.

mod table;

pub use table::PARAMETERS;
pub(super) use table::row;

use crate::units::{Quantity, Shown, Unit, UnitSystem};
use std::borrow::Cow;

/// The format number of the files this program reads and writes.
pub const FORMAT: i64 = 1;
/// The smallest magnitude accepted for a number that is not zero: far below any quantity in SI units.
pub const SMALLEST: f64 = 1e-30;
/// The largest magnitude accepted: its powers in reduced units still fit a double.
pub const LARGEST: f64 = 1e30;
/// The contact radius at which a path starts if none is given, over the radius of curvature.
pub const START_OVER_CURVATURE: f64 = 0.5;
/// The largest contact radius accepted, over the radius of curvature: further out the paraboloid has no meaning.
pub const RADIUS_OVER_CURVATURE: f64 = 10.0;
/// The three ways to give the start of a path; a preset has exactly one.
pub const START_KEYS: [&str; 3] = ["path.start_contact_radius", "path.start_approach", "path.start_force"];
/// The three ways to give the turn of a loop; a preset has at most one.
pub const TURN_KEYS: [&str; 3] = ["path.turn_approach", "path.turn_force", "path.turn_contact_radius"];

/// The word that leaves a value to the program.
pub const AUTO: &str = "auto";
/// The word for the exact basis.
pub const EXACT: &str = "exact";
/// The word for no smoothing, and for no measured curve.
pub const NONE: &str = "none";

/// What kind of value a parameter takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A number above zero, changed in steps of its logarithm.
    Positive,
    /// Zero or a number above it.
    NonNegative,
    /// Any finite number.
    Finite,
    /// A whole number from `min` to `max`.
    Integer {
        /// The smallest accepted.
        min: i64,
        /// The largest accepted.
        max: i64,
    },
    /// Printable text.
    Text {
        /// The longest accepted.
        max_chars: usize,
    },
    /// A number from `min` to `max`.
    Between {
        /// The smallest accepted.
        min: f64,
        /// The largest accepted.
        max: f64,
    },
    /// A file with a measured profile.
    File,
    /// A file with a measured curve, or [`NONE`].
    Points,
    /// A number above zero, or `none`, or [`AUTO`].
    Smoothing,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// What the loading device prescribes.
    Control,
}

/// What a parameter is when a file does not give it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fallback {
    /// It must be given (where it applies).
    Required,
    /// This number.
    Number(f64),
    /// This whole number.
    Integer(i64),
    /// This text, choice or control.
    Text(&'static str),
    /// It follows from other values, as these words describe, or is none.
    Described(&'static str),
    /// It always follows from other values; setting it changes those instead.
    Computed,
}

/// Where a parameter applies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Applies {
    /// In every preset.
    Always,
    /// Only where the choice `key` is one of `words`.
    With {
        /// The key that chooses.
        key: &'static str,
        /// Its words.
        words: &'static [&'static str],
    },
    /// Only while the device is a spring.
    Spring,
}

/// A dotted key: from the table, or made from what a preset contains.
pub type Key = Cow<'static, str>;

/// A row of the table, or a separate one for a key that only some presets have.
pub type Row = Cow<'static, Parameter>;

/// One row of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// The dotted TOML key.
    pub key: Key,
    /// A short name for the screen, in ASCII.
    pub label: Cow<'static, str>,
    /// What it is, in one line.
    pub meaning: Cow<'static, str>,
    /// Its dimension in words; empty for text, choices and pure numbers.
    pub dimension: Cow<'static, str>,
    /// The quantity of values with units; a pure number if there is no such quantity.
    pub quantity: Quantity,
    /// A unit of its own, in which an SI preset has it typed, shown and written, instead of the unit of the quantity.
    pub unit: Option<Unit>,
    /// What values it takes.
    pub kind: Kind,
    /// What it is when not given.
    pub fallback: Fallback,
    /// Where it applies.
    pub applies: Applies,
}

/// The key of the stiffness of the loading device.
pub const STIFFNESS: &str = "path.control.stiffness";
/// The key of the coefficient of a power law, whose dimension follows from the exponent.
pub const COEFFICIENT: &str = "gap.coefficient";
/// The key that says how the adhesion acts.
pub const ADHESION: &str = "material.adhesion";
/// The key of the work of adhesion.
pub const WORK_OF_ADHESION: &str = "material.work_of_adhesion";
/// The two ways to give the range of a constant tension; a preset has at most one.
pub const RANGE_KEYS: [&str; 2] = ["material.cohesive_strength", "material.cohesive_range"];
/// The keys of a liquid bridge.
pub const LIQUID_KEYS: [&str; 3] =
    ["material.surface_tension", "material.kelvin_radius", "material.contact_angle"];
/// The keys whose word decides which other keys apply.
pub const CHOOSERS: [&str; 4] = ["gap.shape", "basis.kind", "units", ADHESION];
/// The words of the key `units`.
pub const SYSTEMS: [&str; 2] = ["reduced", "SI"];
/// The keys of the units in which an SI preset is shown, each with its quantity.
pub const DISPLAY: [(&str, Quantity); 6] = [
    ("display.length", Quantity::Length),
    ("display.force", Quantity::Force),
    ("display.stress", Quantity::Stress),
    ("display.adhesion", Quantity::EnergyPerArea),
    ("display.energy", Quantity::Energy),
    ("display.stiffness", Quantity::ForcePerLength),
];

/// The keys that give the same thing as this one in other ways, including itself: a preset keeps the last one given.
pub fn rivals(key: &str) -> &'static [&'static str] {
    [&START_KEYS[..], &TURN_KEYS, &RANGE_KEYS]
        .into_iter()
        .find(|keys| keys.contains(&key))
        .unwrap_or_default()
}

/// The table that a dotted key is in, if any.
pub fn table_of(key: &str) -> Option<&str> {
    key.rsplit_once('.').map(|(table, _)| table)
}

impl Kind {
    /// Whether its values are real numbers, which may be typed with a unit.
    pub fn is_number(self) -> bool {
        match self {
            Self::Positive | Self::NonNegative | Self::Finite | Self::Between { .. } | Self::Smoothing => {
                true
            }
            Self::Integer { .. }
            | Self::Text { .. }
            | Self::File
            | Self::Points
            | Self::Choice(_)
            | Self::Control => false,
        }
    }
}

impl Parameter {
    /// The table that the key is in, if any.
    pub fn table(&self) -> Option<&str> {
        table_of(&self.key)
    }

    /// The last part of the key.
    pub fn name(&self) -> &str {
        self.key.rsplit_once('.').map_or(&*self.key, |(_, name)| name)
    }

    /// Whether the key is part of another parameter's value, as `path.control.stiffness` is.
    pub fn is_part(&self) -> bool {
        let is_whole = |row: &Parameter| row.kind == Kind::Control && Some(&*row.key) == self.table();
        PARAMETERS.iter().any(is_whole)
    }

    /// Whether the word [`NONE`] removes its value: it is a number that, if not given, follows from others or is none.
    pub fn is_optional(&self) -> bool {
        let is_described = matches!(self.fallback, Fallback::Described(_));
        is_described && self.kind.is_number()
    }

    /// The key whose value contains its own value.
    pub(super) fn whole(&self) -> &str {
        self.table().filter(|_| self.is_part()).unwrap_or(&self.key)
    }

    /// The unit in which a preset with these units has it typed and shown, if there is one.
    pub fn unit_in<'a>(&'a self, units: &'a UnitSystem) -> Option<&'a Unit> {
        let quantity = if self.kind == Kind::Control { Quantity::ForcePerLength } else { self.quantity };
        self.own_unit_in(units).or_else(|| units.unit(quantity))
    }

    /// The unit of its own, where it applies: bare numbers are in it.
    pub(super) fn own_unit_in(&self, units: &UnitSystem) -> Option<&Unit> {
        self.unit.as_ref().filter(|_| *units != UnitSystem::Reduced)
    }

    /// A bare number of it in SI or reduced units.
    pub fn in_own_unit(&self, units: &UnitSystem, x: f64) -> f64 {
        self.own_unit_in(units).map_or(x, |unit| unit.to_si(x))
    }

    /// How a number of it, in SI or reduced units, is shown.
    pub fn shown<'a>(&'a self, units: &'a UnitSystem, x: f64) -> Shown<'a> {
        let unit = self.unit_in(units);
        Shown { number: unit.map_or(x, |unit| unit.from_si(x)), unit }
    }

    /// A number in SI with its SI unit, so that exactly the same number is read back, where a bare number would be in a
    /// unit of its own.
    pub(super) fn exact_in_si(&self, units: &UnitSystem, x: f64) -> Option<String> {
        let base = self.own_unit_in(units)?.dimension().si();
        Some(format!("{x:?} {}", if base.is_empty() { "rad" } else { &base }))
    }

    /// Whether it applies where the choice `chooser` is `word`.
    pub fn fits(&self, chooser: &str, word: &str) -> bool {
        match self.applies {
            Applies::With { key, words } => key != chooser || words.contains(&word),
            Applies::Always | Applies::Spring => true,
        }
    }

    /// The values it takes, in words.
    pub fn allowed(&self) -> String {
        match self.kind {
            Kind::Positive => format!("a number from {SMALLEST:?} to {LARGEST:?}"),
            Kind::NonNegative => format!("0 or a number from {SMALLEST:?} to {LARGEST:?}"),
            Kind::Finite => format!("a number from -{LARGEST:?} to {LARGEST:?}"),
            Kind::Integer { min, max } if min == max => format!("the number {min}"),
            Kind::Integer { min, max } => format!("a whole number from {min} to {max}"),
            Kind::Between { min, max } => format!("a number from {min:?} to {max:?}"),
            Kind::File => "the name of a file".to_owned(),
            Kind::Points => format!("the name of a file, or \"{NONE}\""),
            Kind::Smoothing => format!("\"{NONE}\", \"{AUTO}\" or a number from {SMALLEST:?} to {LARGEST:?}"),
            Kind::Text { max_chars } => format!("printable text of at most {max_chars} characters"),
            Kind::Choice(words) => {
                words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(" or ")
            }
            Kind::Control => {
                "\"displacement\", \"force\" or stiffness=k (in a file: { stiffness = k }) with k > 0"
                    .to_owned()
            }
        }
    }

    /// What it is when not given, in words.
    pub fn fallback_text(&self) -> String {
        match self.fallback {
            Fallback::Required => "required".to_owned(),
            Fallback::Number(x) => format!("{x:?}"),
            Fallback::Integer(n) => n.to_string(),
            Fallback::Text(text) => format!("\"{text}\""),
            Fallback::Described(words) => words.to_owned(),
            Fallback::Computed => "computed".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests;
