//! The table of parameters: one row per dotted TOML key.
//!
//! A new parameter is a new row here, a field of [`Preset`](super::Preset) and its two lines in
//! `model` (get) and `build`; a test demands that none of the three is forgotten.

use super::family;
use crate::units::Quantity;
use std::borrow::Cow::{self, Borrowed};

/// The format number of the files this program reads and writes.
pub const FORMAT: i64 = 1;
/// The smallest magnitude accepted for a number that is not zero: far below any quantity in SI units.
pub const SMALLEST: f64 = 1e-30;
/// The largest magnitude accepted: its powers in reduced units still fit a double.
pub const LARGEST: f64 = 1e30;
/// The contact radius at which a path starts when nothing is said, over the radius of curvature.
pub const START_OVER_CURVATURE: f64 = 0.5;
/// The contact radius at which a path ends when nothing is said, over the one where it starts.
pub const END_OVER_START: f64 = 0.004;
/// The largest contact radius accepted, over the radius of curvature: the paraboloid means nothing so far out.
pub const RADIUS_OVER_CURVATURE: f64 = 10.0;
/// The three ways to say where a path starts; a preset has exactly one.
pub const START_KEYS: [&str; 3] = ["path.start_contact_radius", "path.start_approach", "path.start_force"];

/// The word that leaves a count to the program.
pub const AUTO: &str = "auto";
/// The word for no smoothing.
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
    /// A whole number from `min` to `max`, or the word [`AUTO`].
    Count {
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
    /// It follows from other values, in these words.
    Described(&'static str),
}

/// Where a parameter means something.
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

/// A dotted key: of the table, or made from what a preset says.
pub type Key = Cow<'static, str>;

/// A row of the table, or one of its own for a key that only some presets have.
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
    /// What is measured, for values with units; a pure number where there is no such quantity.
    pub quantity: Quantity,
    /// What values it takes.
    pub kind: Kind,
    /// What it is when not given.
    pub fallback: Fallback,
    /// Where it means something.
    pub applies: Applies,
}

/// The keys whose word decides which other keys apply.
pub const CHOOSERS: [&str; 3] = ["gap.shape", "basis.kind", "units"];
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

/// The row of the unit in which a quantity is shown.
const fn display(at: usize, label: &'static str, meaning: &'static str, fallback: &'static str) -> Parameter {
    Parameter {
        key: Borrowed(DISPLAY[at].0),
        label: Borrowed(label),
        meaning: Borrowed(meaning),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Text { max_chars: 20 },
        fallback: Fallback::Text(fallback),
        applies: Applies::With { key: CHOOSERS[2], words: &["SI"] },
    }
}

/// Where the gap has one of these shapes.
const fn of_shape(words: &'static [&'static str]) -> Applies {
    Applies::With { key: CHOOSERS[0], words }
}

/// The parameters, in the order in which files and screens show them.
pub static PARAMETERS: &[Parameter] = &[
    Parameter {
        key: Borrowed("format"),
        label: Borrowed("format"),
        meaning: Borrowed("version of this file format"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Integer { min: FORMAT, max: FORMAT },
        fallback: Fallback::Integer(FORMAT),
        applies: Applies::Always,
    },
    Parameter {
        key: Borrowed("title"),
        label: Borrowed("title"),
        meaning: Borrowed("one line that says what the preset shows"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Text { max_chars: 100 },
        fallback: Fallback::Text(""),
        applies: Applies::Always,
    },
    Parameter {
        key: Borrowed("units"),
        label: Borrowed("units"),
        meaning: Borrowed(
            "reduced: any consistent units; SI: bare numbers are SI, and text such as \"30 um\" has its unit",
        ),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Choice(&SYSTEMS),
        fallback: Fallback::Text("reduced"),
        applies: Applies::Always,
    },
    Parameter {
        key: Borrowed("material.effective_modulus"),
        label: Borrowed("E*"),
        meaning: Borrowed("effective elastic modulus of the two bodies"),
        dimension: Borrowed("stress"),
        quantity: Quantity::Stress,
        kind: Kind::Positive,
        fallback: Fallback::Required,
        applies: Applies::Always,
    },
    Parameter {
        key: Borrowed("material.work_of_adhesion"),
        label: Borrowed("gamma"),
        meaning: Borrowed(
            "work of adhesion w, the energy gained per unit area of contact (of both faces together)",
        ),
        dimension: Borrowed("stress x length"),
        quantity: Quantity::EnergyPerArea,
        kind: Kind::NonNegative,
        fallback: Fallback::Required,
        applies: Applies::Always,
    },
    Parameter {
        key: Borrowed("material.range_of_action"),
        label: Borrowed("z0"),
        meaning: Borrowed("range of action of the adhesion, for Tabor's number alone"),
        dimension: Borrowed("length"),
        quantity: Quantity::Length,
        kind: Kind::Positive,
        fallback: Fallback::Described("0.3 nm in SI; in reduced units none, and no Tabor number"),
        applies: Applies::Always,
    },
    Parameter {
        key: Borrowed("gap.shape"),
        label: Borrowed("gap"),
        meaning: Borrowed("shape of the gap between the undeformed bodies"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Choice(&[
            "sphere",
            "wavy-sphere",
            "exact-sphere",
            "cone",
            "power-law",
            "harmonics",
            "random-waves",
            "formula",
            "profile",
        ]),
        fallback: Fallback::Required,
        applies: Applies::Always,
    },
    Parameter {
        key: Borrowed("gap.radius_of_curvature"),
        label: Borrowed("R"),
        meaning: Borrowed("combined radius of curvature"),
        dimension: Borrowed("length"),
        quantity: Quantity::Length,
        kind: Kind::Positive,
        fallback: Fallback::Required,
        applies: of_shape(&["sphere", "wavy-sphere", "exact-sphere", "harmonics", "random-waves"]),
    },
    Parameter {
        key: Borrowed("gap.amplitude"),
        label: Borrowed("A"),
        meaning: Borrowed("amplitude of the wave"),
        dimension: Borrowed("length"),
        quantity: Quantity::Length,
        kind: Kind::NonNegative,
        fallback: Fallback::Required,
        applies: of_shape(&["wavy-sphere"]),
    },
    Parameter {
        key: Borrowed("gap.wavelength"),
        label: Borrowed("lambda"),
        meaning: Borrowed("wavelength"),
        dimension: Borrowed("length"),
        quantity: Quantity::Length,
        kind: Kind::Positive,
        fallback: Fallback::Required,
        applies: of_shape(&["wavy-sphere"]),
    },
    Parameter {
        key: Borrowed("gap.slope"),
        label: Borrowed("slope"),
        meaning: Borrowed("slope of the cone, the cotangent of its half apex angle"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Positive,
        fallback: Fallback::Required,
        applies: of_shape(&["cone"]),
    },
    Parameter {
        key: Borrowed("gap.coefficient"),
        label: Borrowed("c"),
        meaning: Borrowed("coefficient c of the gap c r^n"),
        dimension: Borrowed("length^(1-n)"),
        quantity: Quantity::Number,
        kind: Kind::Positive,
        fallback: Fallback::Required,
        applies: of_shape(&["power-law"]),
    },
    Parameter {
        key: Borrowed("gap.exponent"),
        label: Borrowed("n"),
        meaning: Borrowed("exponent n of the gap c r^n"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Between { min: 1.0, max: 100.0 },
        fallback: Fallback::Required,
        applies: of_shape(&["power-law"]),
    },
    Parameter {
        key: Borrowed("gap.rms"),
        label: Borrowed("rms"),
        meaning: Borrowed("root mean square of the random waves"),
        dimension: Borrowed("length"),
        quantity: Quantity::Length,
        kind: Kind::NonNegative,
        fallback: Fallback::Required,
        applies: of_shape(&["random-waves"]),
    },
    Parameter {
        key: Borrowed("gap.longest_wavelength"),
        label: Borrowed("longest"),
        meaning: Borrowed("longest of the random waves"),
        dimension: Borrowed("length"),
        quantity: Quantity::Length,
        kind: Kind::Positive,
        fallback: Fallback::Required,
        applies: of_shape(&["random-waves"]),
    },
    Parameter {
        key: Borrowed("gap.shortest_wavelength"),
        label: Borrowed("shortest"),
        meaning: Borrowed("shortest of the random waves"),
        dimension: Borrowed("length"),
        quantity: Quantity::Length,
        kind: Kind::Positive,
        fallback: Fallback::Required,
        applies: of_shape(&["random-waves"]),
    },
    Parameter {
        key: Borrowed("gap.hurst"),
        label: Borrowed("H"),
        meaning: Borrowed("Hurst exponent: near 0 the short waves are as high as the long ones"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Between { min: 0.01, max: 1.0 },
        fallback: Fallback::Number(0.8),
        applies: of_shape(&["random-waves"]),
    },
    Parameter {
        key: Borrowed("gap.count"),
        label: Borrowed("waves"),
        meaning: Borrowed("number of random waves"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Integer { min: 1, max: 1000 },
        fallback: Fallback::Integer(50),
        applies: of_shape(&["random-waves"]),
    },
    Parameter {
        key: Borrowed("gap.seed"),
        label: Borrowed("seed"),
        meaning: Borrowed("which of all surfaces with these numbers"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Integer { min: 0, max: i64::MAX },
        fallback: Fallback::Integer(1),
        applies: of_shape(&["random-waves"]),
    },
    Parameter {
        key: Borrowed("gap.formula"),
        label: Borrowed("h(r)"),
        meaning: Borrowed("the gap as a formula in r, pi, e and parameters"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Text { max_chars: 4096 },
        fallback: Fallback::Required,
        applies: of_shape(&["formula"]),
    },
    Parameter {
        key: Borrowed("gap.file"),
        label: Borrowed("file"),
        meaning: Borrowed("file with the columns r and h; relative to the preset's own folder"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::File,
        fallback: Fallback::Required,
        applies: of_shape(&["profile"]),
    },
    Parameter {
        key: Borrowed("gap.smoothing"),
        label: Borrowed("smoothing"),
        meaning: Borrowed("wavelength that passes the smoothing by half"),
        dimension: Borrowed("length"),
        quantity: Quantity::Length,
        kind: Kind::Smoothing,
        fallback: Fallback::Text("none"),
        applies: of_shape(&["profile"]),
    },
    Parameter {
        key: Borrowed("basis.kind"),
        label: Borrowed("basis"),
        meaning: Borrowed("functions in which the contact pressure is sought"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Choice(&["rings", "spectral"]),
        fallback: Fallback::Text("spectral"),
        applies: Applies::Always,
    },
    Parameter {
        key: Borrowed("basis.rings"),
        label: Borrowed("N"),
        meaning: Borrowed("number of ring elements"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Integer { min: 4, max: 2000 },
        fallback: Fallback::Integer(200),
        applies: Applies::With { key: CHOOSERS[1], words: &["rings"] },
    },
    Parameter {
        key: Borrowed("basis.grading"),
        label: Borrowed("grading"),
        meaning: Borrowed(
            "spacing of the rings: uniform as in the paper, edge crowds at most 400 towards the edge",
        ),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Choice(&["uniform", "edge"]),
        fallback: Fallback::Text("uniform"),
        applies: Applies::With { key: CHOOSERS[1], words: &["rings"] },
    },
    Parameter {
        key: Borrowed("basis.functions"),
        label: Borrowed("functions"),
        meaning: Borrowed("number of eigenfunctions; auto takes enough for the waves in the largest contact"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Count { min: 4, max: 4096 },
        fallback: Fallback::Text(AUTO),
        applies: Applies::With { key: CHOOSERS[1], words: &["spectral"] },
    },
    Parameter {
        key: Borrowed("path.control"),
        label: Borrowed("control"),
        meaning: Borrowed("what the loading device prescribes"),
        dimension: Borrowed(""),
        quantity: Quantity::Number,
        kind: Kind::Control,
        fallback: Fallback::Text("displacement"),
        applies: Applies::Always,
    },
    Parameter {
        key: Borrowed("path.control.stiffness"),
        label: Borrowed("k"),
        meaning: Borrowed("stiffness of the loading device"),
        dimension: Borrowed("force / length"),
        quantity: Quantity::ForcePerLength,
        kind: Kind::Positive,
        fallback: Fallback::Described("none: the device is not a spring"),
        applies: Applies::Spring,
    },
    Parameter {
        key: Borrowed(START_KEYS[0]),
        label: Borrowed("s start"),
        meaning: Borrowed("contact radius at which the path starts"),
        dimension: Borrowed("length"),
        quantity: Quantity::Length,
        kind: Kind::Positive,
        fallback: Fallback::Described("0.5 x the radius of curvature, if no start is given"),
        applies: Applies::Always,
    },
    Parameter {
        key: Borrowed(START_KEYS[1]),
        label: Borrowed("delta start"),
        meaning: Borrowed("approach at which the path starts"),
        dimension: Borrowed("length"),
        quantity: Quantity::Length,
        kind: Kind::Finite,
        fallback: Fallback::Described("none: another start is used"),
        applies: Applies::Always,
    },
    Parameter {
        key: Borrowed(START_KEYS[2]),
        label: Borrowed("P start"),
        meaning: Borrowed("force at which the path starts, a preload"),
        dimension: Borrowed("force"),
        quantity: Quantity::Force,
        kind: Kind::Finite,
        fallback: Fallback::Described("none: another start is used"),
        applies: Applies::Always,
    },
    Parameter {
        key: Borrowed("path.end_contact_radius"),
        label: Borrowed("s end"),
        meaning: Borrowed("contact radius at which the path ends"),
        dimension: Borrowed("length"),
        quantity: Quantity::Length,
        kind: Kind::Positive,
        fallback: Fallback::Described("0.004 x the contact radius at the start"),
        applies: Applies::Always,
    },
    display(0, "lengths", "unit in which lengths are shown", "um"),
    display(1, "forces", "unit in which forces are shown", "uN"),
    display(2, "stresses", "unit in which stresses are shown", "kPa"),
    display(3, "adhesions", "unit in which works of adhesion are shown", "mJ/m^2"),
    display(4, "energies", "unit in which energies are shown", "pJ"),
    display(5, "stiffnesses", "unit in which stiffnesses are shown", "N/m"),
];

/// The row of a dotted key: of the table, or of a [`family`].
#[must_use]
pub fn parameter(key: &str) -> Option<Row> {
    PARAMETERS.iter().find(|row| row.key == key).map(Borrowed).or_else(|| family::row(key).map(Cow::Owned))
}

/// The table that a dotted key stands in, if any.
#[must_use]
pub fn table_of(key: &str) -> Option<&str> {
    key.rsplit_once('.').map(|(table, _)| table)
}

/// The keys that hold other keys: `material`, `gap`, …, `path.control` when it is a spring, and the two families.
pub fn tables() -> impl Iterator<Item = &'static str> {
    let families = [family::PARAMETER_TABLE, family::WAVE_TABLE];
    PARAMETERS
        .iter()
        .enumerate()
        .filter_map(|(i, row)| {
            let table = row.table()?;
            let seen = PARAMETERS.iter().take(i).any(|earlier| earlier.table() == Some(table));
            (!seen).then_some(table)
        })
        .chain(families)
}

impl Kind {
    /// Whether its values are real numbers, which may be typed with a unit.
    #[must_use]
    pub fn is_number(self) -> bool {
        match self {
            Self::Positive | Self::NonNegative | Self::Finite | Self::Between { .. } | Self::Smoothing => {
                true
            }
            Self::Integer { .. }
            | Self::Count { .. }
            | Self::Text { .. }
            | Self::File
            | Self::Choice(_)
            | Self::Control => false,
        }
    }
}

impl Parameter {
    /// The table the key stands in, if any.
    #[must_use]
    pub fn table(&self) -> Option<&str> {
        table_of(&self.key)
    }

    /// The last part of the key.
    #[must_use]
    pub fn name(&self) -> &str {
        self.key.rsplit_once('.').map_or(&*self.key, |(_, name)| name)
    }

    /// Whether the key is a part of another parameter's value, as `path.control.stiffness` is.
    #[must_use]
    pub fn is_part(&self) -> bool {
        self.table().and_then(parameter).is_some_and(|whole| whole.kind == Kind::Control)
    }

    /// Whether a person changes it by factors rather than by differences.
    #[must_use]
    pub fn is_logarithmic(&self) -> bool {
        matches!(self.kind, Kind::Positive)
    }

    /// Whether it means something where the choice `chooser` is `word`.
    #[must_use]
    pub fn fits(&self, chooser: &str, word: &str) -> bool {
        match self.applies {
            Applies::With { key, words } => key != chooser || words.contains(&word),
            Applies::Always | Applies::Spring => true,
        }
    }

    /// The values it takes, in words.
    #[must_use]
    pub fn allowed(&self) -> String {
        match self.kind {
            Kind::Positive => format!("a number from {SMALLEST:?} to {LARGEST:?}"),
            Kind::NonNegative => format!("0 or a number from {SMALLEST:?} to {LARGEST:?}"),
            Kind::Finite => format!("a number from -{LARGEST:?} to {LARGEST:?}"),
            Kind::Integer { min, max } if min == max => format!("the number {min}"),
            Kind::Integer { min, max } => format!("a whole number from {min} to {max}"),
            Kind::Count { min, max } => format!("\"{AUTO}\" or a whole number from {min} to {max}"),
            Kind::Between { min, max } => format!("a number from {min:?} to {max:?}"),
            Kind::File => "the name of a file".to_owned(),
            Kind::Smoothing => format!("\"{NONE}\", \"{AUTO}\" or a number from {SMALLEST:?} to {LARGEST:?}"),
            Kind::Text { max_chars } => format!("printable text of at most {max_chars} characters"),
            Kind::Choice(words) => {
                words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(" or ")
            }
            Kind::Control => "\"displacement\", \"force\" or { stiffness = k } with k > 0".to_owned(),
        }
    }

    /// What it is when not given, in words.
    #[must_use]
    pub fn fallback_text(&self) -> String {
        match self.fallback {
            Fallback::Required => "required".to_owned(),
            Fallback::Number(x) => format!("{x:?}"),
            Fallback::Integer(n) => n.to_string(),
            Fallback::Text(text) => format!("\"{text}\""),
            Fallback::Described(words) => words.to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn keys_and_labels_are_unique_ascii_and_grouped() {
        let keys: BTreeSet<_> = PARAMETERS.iter().map(|row| &row.key).collect();
        let labels: BTreeSet<_> = PARAMETERS.iter().map(|row| &row.label).collect();
        assert_eq!((keys.len(), labels.len()), (PARAMETERS.len(), PARAMETERS.len()));
        for row in PARAMETERS {
            assert!(row.label.is_ascii() && row.label.len() <= 11, "{}", row.label);
            assert!(!row.meaning.is_empty() && !row.allowed().is_empty() && !row.fallback_text().is_empty());
        }
        assert!(START_KEYS.iter().all(|key| parameter(key).is_some()));
        let said =
            |key, number: f64| parameter(key).unwrap().fallback_text().starts_with(&format!("{number} x"));
        assert!(said(START_KEYS[0], START_OVER_CURVATURE) && said("path.end_contact_radius", END_OVER_START));
        assert_eq!(
            tables().collect::<Vec<_>>(),
            ["material", "gap", "basis", "path", "path.control", "display", "gap.parameters", "gap.waves"]
        );
    }
}
