//! Dimensions as exponent vectors, and the quantities of contact mechanics.

use std::fmt;
use std::ops::{Add, Mul};

/// The exponents of metre, kilogram and second; for a product they add up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Dimension {
    /// The exponent of the metre.
    pub metre: i32,
    /// The exponent of the kilogram.
    pub kilogram: i32,
    /// The exponent of the second.
    pub second: i32,
}

/// A quantity of contact mechanics.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Contact radius, approach, amplitude, wavelength: m.
    Length,
    /// A force: N.
    Force,
    /// Elastic moduli and pressures: Pa.
    Stress,
    /// The work of adhesion: J/m².
    EnergyPerArea,
    /// Losses: J.
    Energy,
    /// The stiffness of the device: N/m, which has the same dimension as J/m².
    ForcePerLength,
    /// A length to the power −k, with k from 1 to [`Quantity::DEEPEST`], such as the coefficient of a power law: m⁻ᵏ.
    InverseLength(u8),
    /// The speed of an edge, or the rate of an approach: m/s.
    Speed,
    /// The rate of a force: N/s.
    ForceRate,
    /// A time: s.
    Time,
    /// A ratio, an angle or a count.
    Number,
}

impl Dimension {
    /// No dimension.
    pub const NONE: Self = Self::new(0, 0, 0);

    /// The dimension with these exponents of metre, kilogram and second.
    pub const fn new(metre: i32, kilogram: i32, second: i32) -> Self {
        Self { metre, kilogram, second }
    }

    /// Its SI unit in base units, `m^-1 kg s^-2`; empty for a pure number.
    pub fn si(self) -> String {
        let factor = |(symbol, power): (&str, i32)| match power {
            0 => None,
            1 => Some(symbol.to_owned()),
            _ => Some(format!("{symbol}^{power}")),
        };
        let factors = [("m", self.metre), ("kg", self.kilogram), ("s", self.second)];
        factors.into_iter().filter_map(factor).collect::<Vec<_>>().join(" ")
    }

    /// Its name, with the article, if it has a name here.
    ///
    /// An energy per area and a force per length have the same dimension.
    pub fn name(self) -> Option<&'static str> {
        Some(match (self.metre, self.kilogram, self.second) {
            (0, 0, 0) => "a pure number",
            (1, 0, 0) => "a length",
            (2, 0, 0) => "an area",
            (3, 0, 0) => "a volume",
            (-1, 0, 0) => "an inverse length",
            (-2, 0, 0) => "an inverse area",
            (-3, 0, 0) => "an inverse volume",
            (0, 1, 0) => "a mass",
            (0, 0, 1) => "a time",
            (1, 0, -1) => "a speed",
            (1, 1, -3) => "a rate of a force",
            (1, 1, -2) => "a force",
            (-1, 1, -2) => "a stress",
            (2, 1, -2) => "an energy",
            (0, 1, -2) => "an energy per area or a force per length",
            _ => return None,
        })
    }
}

/// m⁻ᵏ at index k.
const INVERSE_METRES: [&str; 10] =
    ["", "m^-1", "m^-2", "m^-3", "m^-4", "m^-5", "m^-6", "m^-7", "m^-8", "m^-9"];

impl Add for Dimension {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.metre + other.metre, self.kilogram + other.kilogram, self.second + other.second)
    }
}

impl Mul<i32> for Dimension {
    type Output = Self;

    fn mul(self, power: i32) -> Self {
        Self::new(self.metre * power, self.kilogram * power, self.second * power)
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.name() {
            Some(name) => f.write_str(name),
            None => write!(f, "of dimension {}", self.si()),
        }
    }
}

impl Quantity {
    /// The largest k in a length to the power −k.
    pub const DEEPEST: u8 = 9;

    /// All of them.
    pub const ALL: [Self; 19] = [
        Self::Length,
        Self::Force,
        Self::Stress,
        Self::EnergyPerArea,
        Self::Energy,
        Self::ForcePerLength,
        Self::Speed,
        Self::ForceRate,
        Self::Time,
        Self::Number,
        Self::InverseLength(1),
        Self::InverseLength(2),
        Self::InverseLength(3),
        Self::InverseLength(4),
        Self::InverseLength(5),
        Self::InverseLength(6),
        Self::InverseLength(7),
        Self::InverseLength(8),
        Self::InverseLength(9),
    ];

    /// The quantity of a length to the power −`k`, where `k` is a whole number from 0 to [`Self::DEEPEST`].
    pub fn of_inverse_length(k: f64) -> Option<Self> {
        let whole = (0..=Self::DEEPEST).find(|whole| k - f64::from(*whole) == 0.0)?;
        Some(if whole == 0 { Self::Number } else { Self::InverseLength(whole) })
    }

    /// Its dimension.
    pub fn dimension(self) -> Dimension {
        match self {
            Self::Length => Dimension::new(1, 0, 0),
            Self::Force => Dimension::new(1, 1, -2),
            Self::Stress => Dimension::new(-1, 1, -2),
            Self::EnergyPerArea | Self::ForcePerLength => Dimension::new(0, 1, -2),
            Self::Energy => Dimension::new(2, 1, -2),
            Self::Speed => Dimension::new(1, 0, -1),
            Self::ForceRate => Dimension::new(1, 1, -3),
            Self::Time => Dimension::new(0, 0, 1),
            Self::InverseLength(k) => Dimension::new(-i32::from(k), 0, 0),
            Self::Number => Dimension::NONE,
        }
    }

    /// Its name, with the article.
    pub fn name(self) -> &'static str {
        match self {
            Self::Length => "a length",
            Self::Force => "a force",
            Self::Stress => "a stress",
            Self::EnergyPerArea => "an energy per area",
            Self::Energy => "an energy",
            Self::ForcePerLength => "a force per length",
            Self::Speed => "a speed",
            Self::ForceRate => "a rate of a force",
            Self::Time => "a time",
            Self::InverseLength(1) => "an inverse length",
            Self::InverseLength(2) => "an inverse area",
            Self::InverseLength(3) => "an inverse volume",
            Self::InverseLength(_) => "an inverse power of a length",
            Self::Number => "a pure number",
        }
    }

    /// Its SI unit; a pure number has none.
    pub fn si(self) -> Option<&'static str> {
        match self {
            Self::Length => Some("m"),
            Self::Force => Some("N"),
            Self::Stress => Some("Pa"),
            Self::EnergyPerArea => Some("J/m^2"),
            Self::Energy => Some("J"),
            Self::ForcePerLength => Some("N/m"),
            Self::Speed => Some("m/s"),
            Self::ForceRate => Some("N/s"),
            Self::Time => Some("s"),
            Self::InverseLength(k) => INVERSE_METRES.get(usize::from(k)).copied(),
            Self::Number => None,
        }
    }

    /// An example of its unit for messages; a pure number has none.
    pub fn example(self) -> Option<&'static str> {
        match self {
            Self::InverseLength(_) => self.si(),
            Self::Length => Some("um"),
            Self::Force => Some("mN"),
            Self::Stress => Some("kPa"),
            Self::EnergyPerArea => Some("mJ/m^2"),
            Self::Energy => Some("pJ"),
            Self::ForcePerLength => Some("N/m"),
            Self::Speed => Some("um/s"),
            Self::ForceRate => Some("uN/s"),
            Self::Time => Some("s"),
            Self::Number => None,
        }
    }
}
