//! What a column is, from its name or as the user says.

use crate::text::{closest, quote};
use crate::units::{Dimension, Quantity, Unit};
use thiserror::Error;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnRole {
    /// δ, a length.
    Approach,
    /// The position of the device's far end, a length: Δ apart from its sign and its zero.
    Position,
    /// The deflection of the device's spring, a length.
    Deflection,
    /// P, a force.
    Force,
    /// s, a length.
    Radius,
    /// 2s, a length.
    Diameter,
    /// πs², an area.
    Area,
    /// Which branch a row belongs to.
    Segment,
    /// When a row was measured, a time; its zero is arbitrary.
    Time,
}

/// Which branch a row belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Segment {
    /// The bodies come together.
    Approach,
    /// They move apart.
    Retraction,
    /// Neither: a pause.
    Other,
}

impl Segment {
    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Approach => "approach",
            Self::Retraction => "retraction",
            Self::Other => "pause",
        }
    }

    /// What a cell says; `None` for an unknown word.
    pub fn of(text: &str) -> Option<Self> {
        let word = text.to_lowercase();
        let is = |words: &str| words.split(' ').any(|known| known == word);
        let number = text.parse::<f64>().ok();
        let is_number = |wanted: f64| number.is_some_and(|number| number.total_cmp(&wanted).is_eq());
        if is_number(0.0)
            || is("false approach approaching extend extending ext ex advance loading load trace in \
            forward push")
        {
            Some(Self::Approach)
        } else if is_number(1.0)
            || is("true retract retracting retraction ret rt withdraw withdrawal unloading unload \
            retrace out backward pull")
        {
            Some(Self::Retraction)
        } else if is_number(2.0) || is("pause hold holding dwell intermediate") {
            Some(Self::Other)
        } else {
            None
        }
    }
}

impl ColumnRole {
    /// All roles, in the order in which messages name them.
    pub const ALL: [Self; 9] = [
        Self::Approach,
        Self::Position,
        Self::Deflection,
        Self::Force,
        Self::Radius,
        Self::Diameter,
        Self::Area,
        Self::Segment,
        Self::Time,
    ];

    /// The word for it in `--columns`; `x` also stands for [`ColumnRole::Approach`].
    pub fn word(self) -> &'static str {
        match self {
            Self::Approach => "approach",
            Self::Position => "position",
            Self::Deflection => "deflection",
            Self::Force => "force",
            Self::Radius => "radius",
            Self::Diameter => "diameter",
            Self::Area => "area",
            Self::Segment => "segment",
            Self::Time => "time",
        }
    }

    /// Whether it says how large the contact is.
    pub(super) fn is_contact(self) -> bool {
        matches!(self, Self::Radius | Self::Diameter | Self::Area)
    }

    /// Whether it says how much the bodies are pressed together.
    pub(super) fn is_force(self) -> bool {
        matches!(self, Self::Force | Self::Deflection)
    }

    /// Whether it says how far the bodies have approached.
    pub(super) fn is_approach(self) -> bool {
        matches!(self, Self::Approach | Self::Position)
    }

    /// Whether it may be x.
    pub(super) fn is_way(self) -> bool {
        self.is_approach() || self.is_contact()
    }

    /// Its dimension; none for a segment.
    pub fn dimension(self) -> Option<Dimension> {
        match self {
            Self::Force => Some(Quantity::Force.dimension()),
            Self::Area => Some(Quantity::Length.dimension() * 2),
            Self::Segment => None,
            Self::Time => Some(TIME),
            _ => Some(Quantity::Length.dimension()),
        }
    }

    /// Its unit in SI; none for a segment.
    pub fn si(self) -> Option<&'static str> {
        match self {
            Self::Force => Quantity::Force.si(),
            Self::Area => Some("m^2"),
            Self::Segment => None,
            Self::Time => Some("s"),
            _ => Quantity::Length.si(),
        }
    }
}

/// The dimension of a time.
const TIME: Dimension = Dimension::new(0, 0, 1);

/// The dimensions that the units in a header can have.
pub(super) fn dimensions() -> [Dimension; 4] {
    [Quantity::Length.dimension(), Quantity::Force.dimension(), Quantity::Length.dimension() * 2, TIME]
}

/// Where a column is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ColumnPlace {
    /// Its number, from 1.
    Number(usize),
    /// Its name in the header.
    Name(String),
}

/// One column as the user specifies it.
#[derive(Debug, Clone, PartialEq)]
pub struct Said {
    /// What it is.
    pub role: ColumnRole,
    /// Where it is.
    pub place: ColumnPlace,
    /// Its unit, if given.
    pub unit: Option<Unit>,
}

/// What the user says about the columns of a file; empty leaves it to the header.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ColumnSpec(pub Vec<Said>);

/// Why a text does not specify columns.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ColumnSpecError {
    /// It is not of the form `ROLE=COLUMN`.
    #[error(
        "\"{0}\" is not of the form ROLE=COLUMN, as in approach=1,force=2 or position=Z [nm],force=F [nN]"
    )]
    Form(String),
    /// An unknown role.
    #[error(
        "\"{text}\" is not a column role: expected x, approach, position, deflection, force, radius, diameter, area, \
         segment or time{}",
        meant.map_or_else(String::new, |word| format!("; did you mean {word}?"))
    )]
    Role {
        /// The text given, safe to show.
        text: String,
        /// The word it resembles.
        meant: Option<&'static str>,
    },
    /// A column number of zero.
    #[error("column 0: columns are counted from 1")]
    Zero,
    /// A role given twice.
    #[error("{0} is given twice")]
    Twice(&'static str),
    /// A unit that does not fit its quantity.
    #[error("the unit \"{unit}\" of {role} is not {expected}")]
    Unit {
        /// The role.
        role: &'static str,
        /// The text given, safe to show.
        unit: String,
        /// What is expected, in words.
        expected: &'static str,
    },
}

impl ColumnSpec {
    /// The columns that a text such as `x=1,force=Load [mN]` specifies.
    ///
    /// # Errors
    /// [`ColumnSpecError`].
    pub fn parse(text: &str) -> Result<Self, ColumnSpecError> {
        let mut said: Vec<Said> = Vec::new();
        for part in text.split(',').map(str::trim).filter(|part| !part.is_empty()) {
            let (word, place) = part.split_once('=').ok_or_else(|| ColumnSpecError::Form(quote(part)))?;
            let (word, place) = (word.trim().to_lowercase(), place.trim());
            let known = ColumnRole::ALL.into_iter().find(|role| role.word() == word);
            let role = known.or((word == "x").then_some(ColumnRole::Approach)).ok_or_else(|| {
                ColumnSpecError::Role {
                    text: quote(&word),
                    meant: closest(&word, ColumnRole::ALL.into_iter().map(ColumnRole::word)),
                }
            })?;
            if said.iter().any(|other| other.role == role) {
                return Err(ColumnSpecError::Twice(role.word()));
            }
            let (name, unit) = match place.strip_suffix(']').and_then(|place| place.rsplit_once('[')) {
                Some((name, unit)) => (name.trim(), Some(unit_of(role, unit.trim())?)),
                None => (place, None),
            };
            if name.is_empty() {
                return Err(ColumnSpecError::Form(quote(part)));
            }
            let place = match name.parse::<usize>() {
                Ok(0) => return Err(ColumnSpecError::Zero),
                Ok(number) => ColumnPlace::Number(number),
                Err(_) => ColumnPlace::Name(name.to_owned()),
            };
            said.push(Said { role, place, unit });
        }
        Ok(Self(said))
    }
}

/// The unit `text` of a column of this role.
pub(super) fn unit_of(role: ColumnRole, text: &str) -> Result<Unit, ColumnSpecError> {
    let expected = match role {
        ColumnRole::Force => "a unit of force",
        ColumnRole::Area => "a unit of area",
        ColumnRole::Segment => "known: a segment has no unit",
        ColumnRole::Time => "a unit of time",
        _ => "a unit of length",
    };
    let unit = unit_named(text, role == ColumnRole::Force);
    unit.filter(|unit| role.dimension() == Some(unit.dimension())).ok_or_else(|| ColumnSpecError::Unit {
        role: role.word(),
        unit: quote(text),
        expected,
    })
}

/// The unit that `text` names, possibly spelt out; the grams of a balance are forces if `is_force`.
pub(super) fn unit_named(text: &str, is_force: bool) -> Option<Unit> {
    const SPELT: [(&str, &str); 8] = [
        ("newton", "N"),
        ("meter", "m"),
        ("metre", "m"),
        ("gramforce", "gf"),
        ("gramm", "g"),
        ("gram", "g"),
        ("second", "s"),
        ("sec", "s"),
    ];
    const PREFIXES: [(&str, &str); 6] =
        [("nano", "n"), ("micro", "u"), ("milli", "m"), ("centi", "c"), ("kilo", "k"), ("pico", "p")];
    let text = text.trim();
    let word = text.to_lowercase().replace(['-', ' '], "");
    let word = word.strip_suffix('s').filter(|word| word.len() > 2).unwrap_or(&word).to_owned();
    let (prefix, rest) = PREFIXES
        .iter()
        .find_map(|(long, short)| Some((*short, word.strip_prefix(long)?)))
        .unwrap_or(("", &word));
    let spelt = match SPELT.iter().find(|(long, _)| *long == rest) {
        Some((_, short)) => format!("{prefix}{short}"),
        None if prefix == "u" && rest == "n" => "micron".to_owned(),
        None if word == "micron" => "micron".to_owned(),
        None => text.to_owned(),
    };
    let weighed = |text: &str| is_force && ["g", "mg", "kg", "ug", "µg", "\u{3bc}g"].contains(&text);
    let spelt = if weighed(&spelt) { format!("{spelt}f") } else { spelt };
    Unit::parse(&spelt, 0).ok()
}
