//! A product of units, read and written: `mJ/m^2`, `N m^-1`, `kPa`.
//!
//! ```text
//! product = ("1"? "/")? factor (("/" | "*" | "·" | blank) factor)*      the slash holds for the one factor after it
//! factor  = name ("^" integer | superscripts)?
//! ```

use super::dimension::Dimension;
use super::table::{JOULE, NONE, NamedUnit, Prefix, SECOND, lookup};
use crate::expression::TextPlace;
use crate::expression::error::NAME;
use crate::expression::error::{piece, piece_after_number};
use std::fmt;
use thiserror::Error;
use winnow::ascii::{digit1, multispace0};
use winnow::combinator::{alt, opt};
use winnow::error::EmptyError;
use winnow::prelude::*;
use winnow::stream::{LocatingSlice, Location};
use winnow::token::{one_of, take_while};

/// Most factors in a product.
const FACTORS: usize = 8;

/// The largest power of a factor.
const POWER: i32 = 9;

/// The characters of a superscript, in the order minus, 0, 1, ….
const SUPERSCRIPTS: [char; 11] = ['⁻', '⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// One factor of a product.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factor {
    /// Its prefix.
    pub prefix: &'static Prefix,
    /// Its unit.
    pub unit: &'static NamedUnit,
    /// Its power, not 0.
    pub power: i32,
}

/// A product of units.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    factors: Vec<Factor>,
}

/// Why a text is not a unit, and where.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum UnitError {
    /// Something else in the place of a unit.
    #[error("column {}: expected a unit such as um, mN, kPa or mJ/m^2, found {found}", place.column)]
    Expected {
        /// Where.
        place: TextPlace,
        /// What was found there.
        found: String,
    },
    /// The expression continues after its unit.
    #[error(
        "column {}: found {found} after a unit, which is written once after the whole expression, as in \
         (1+1/2) um",
        place.column
    )]
    Behind {
        /// Where.
        place: TextPlace,
        /// What was found there.
        found: String,
    },
    /// A name that is not a unit.
    #[error("column {}: unknown unit {name}{}", place.column, meant(.name))]
    Unknown {
        /// Where.
        place: TextPlace,
        /// The name.
        name: String,
    },
    /// A power that no unit has.
    #[error("column {}: the power of a unit must be an integer from -{POWER} to {POWER}, not 0", place.column)]
    Power {
        /// Where.
        place: TextPlace,
    },
    /// A product with too many factors.
    #[error("column {}: a unit has at most {FACTORS} factors", place.column)]
    TooLong {
        /// Where.
        place: TextPlace,
    },
}

/// The units that differ from `name` in upper and lower case alone, as the end of a sentence.
fn meant(name: &str) -> String {
    const LONGEST: usize = 5;
    let letters: Vec<char> = name.chars().collect();
    if letters.len() > LONGEST {
        return String::new();
    }
    let other = |letter: char, is_upper: bool| {
        if is_upper { letter.to_ascii_uppercase() } else { letter.to_ascii_lowercase() }
    };
    let spelt =
        |ways: usize| letters.iter().enumerate().map(|(i, c)| other(*c, ways >> i & 1 == 1)).collect();
    let mut found: Vec<String> =
        (0..1 << letters.len()).map(spelt).filter(|text: &String| lookup(text).is_some()).collect();
    found.dedup();
    if found.is_empty() { String::new() } else { format!("; did you mean {}?", found.join(" or ")) }
}

type UnitInput<'a> = LocatingSlice<&'a str>;

impl Unit {
    /// The unit written in `text` from byte `start` on.
    ///
    /// # Errors
    /// What is wrong, with its place in the whole text.
    pub fn parse(text: &str, start: usize) -> Result<Self, UnitError> {
        let place = |input: &UnitInput| TextPlace::of(text, start + input.current_token_start());
        let mut input = UnitInput::new(&text[start..]);
        let mut factors = Vec::new();
        blanks(&mut input);
        let below = taken(&mut input, (opt('1'), multispace0, '/').void()).is_some();
        let mut sign = if below { -1 } else { 1 };
        loop {
            blanks(&mut input);
            let at = place(&input);
            let Some(name) = word(&mut input) else {
                let goes_on = input.starts_with(|c: char| c.is_ascii_digit() || "+-(".contains(c));
                let found = if factors.is_empty() { piece_after_number(&input) } else { piece(&input) };
                return Err(if goes_on && !factors.is_empty() {
                    UnitError::Behind { place: at, found }
                } else {
                    UnitError::Expected { place: at, found }
                });
            };
            let Some((prefix, unit)) = lookup(name) else {
                return Err(UnitError::Unknown { place: at, name: name.chars().take(NAME).collect() });
            };
            if factors.len() == FACTORS {
                return Err(UnitError::TooLong { place: at });
            }
            let at = place(&input);
            let power = power(&mut input)
                .filter(|p| *p != 0 && p.abs() <= POWER)
                .ok_or(UnitError::Power { place: at })?;
            factors.push(Factor { prefix, unit, power: sign * power });
            blanks(&mut input);
            if input.is_empty() {
                return Ok(Self { factors });
            }
            sign = match separator(&mut input) {
                Some('/') => -1,
                _ => 1,
            };
        }
    }

    /// The product of these factors.
    pub(super) fn of(factors: Vec<Factor>) -> Self {
        Self { factors }
    }

    /// The unit to the power `power`, not 0.
    pub(super) fn to_power(&self, power: i32) -> Self {
        let raised = |factor: &Factor| Factor { power: factor.power * power, ..*factor };
        Self { factors: self.factors.iter().map(raised).collect() }
    }

    /// The unit per second.
    pub(super) fn per_second(&self) -> Self {
        let second = Factor { prefix: &NONE, unit: &SECOND, power: -1 };
        Self { factors: self.factors.iter().copied().chain([second]).collect() }
    }

    /// Its dimension.
    pub fn dimension(&self) -> Dimension {
        self.factors.iter().fold(Dimension::NONE, |sum, factor| sum + factor.unit.dimension * factor.power)
    }

    /// Whether a number means the same in both.
    pub fn is_same(&self, other: &Self) -> bool {
        self.dimension() == other.dimension() && self.to_si(1.0).to_bits() == other.to_si(1.0).to_bits()
    }

    /// Whether an angle is measured in it.
    pub fn is_angle(&self) -> bool {
        self.dimension() == Dimension::NONE
            && self.factors.iter().any(|factor| factor.unit.dimension == Dimension::NONE)
    }

    /// Whether it is one unit, and no power or product.
    pub fn is_single(&self) -> bool {
        matches!(&self.factors[..], [Factor { power: 1, .. }])
    }

    /// What is measured in it, with the article: 30 mJ/m² is an energy per area, 30 mN/m a force per length.
    pub fn measures(&self) -> String {
        let dimension = self.dimension();
        if self.is_angle() {
            return "an angle".to_owned();
        }
        if dimension != Dimension::new(0, 1, -2) {
            return dimension.to_string();
        }
        let energy = self.factors.iter().any(|factor| factor.unit.dimension == JOULE.dimension);
        if energy { "an energy per area" } else { "a force per length" }.to_owned()
    }

    /// `number` of this unit in SI; infinite on overflow.
    pub fn to_si(&self, number: f64) -> f64 {
        scaled(number * self.mantissa(), self.exponent())
    }

    /// `si`, a value in SI, in this unit.
    pub fn from_si(&self, si: f64) -> f64 {
        scaled(si, -self.exponent()) / self.mantissa()
    }

    fn mantissa(&self) -> f64 {
        self.factors.iter().map(|factor| factor.unit.mantissa.powi(factor.power)).product()
    }

    fn exponent(&self) -> i32 {
        self.factors.iter().map(|factor| (factor.prefix.exponent + factor.unit.exponent) * factor.power).sum()
    }

    /// As [`fmt::Display`] writes it, in ASCII.
    pub fn ascii(&self) -> String {
        self.written(
            |factor| format!("{}{}", factor.prefix.ascii, factor.unit.ascii),
            |power| format!("^{power}"),
        )
    }

    fn written(&self, name: impl Fn(&Factor) -> String, power: impl Fn(i32) -> String) -> String {
        let mut text = String::new();
        for (i, factor) in self.factors.iter().enumerate() {
            // A slash needs something in front of it.
            let below = factor.power < 0 && i > 0;
            if i > 0 {
                text.push(if below { '/' } else { ' ' });
            }
            text.push_str(&name(factor));
            let shown = if below { -factor.power } else { factor.power };
            if shown != 1 {
                text.push_str(&power(shown));
            }
        }
        text
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |factor: &Factor| format!("{}{}", factor.prefix.symbol, factor.unit.symbol);
        f.write_str(&self.written(name, superscript))
    }
}

/// x × 10^`exponent`, rounded only once as long as the power is a double.
fn scaled(x: f64, exponent: i32) -> f64 {
    let power = 10f64.powi(exponent.abs());
    if exponent < 0 { x / power } else { x * power }
}

/// A power as a superscript: ⁻⁴.
pub(super) fn superscript(power: i32) -> String {
    let digit = |c: char| SUPERSCRIPTS[c.to_digit(10).map_or(0, |digit| digit as usize + 1)];
    power.to_string().chars().map(digit).collect()
}

fn blanks(input: &mut UnitInput) {
    let _ = taken(input, multispace0.void());
}

fn word<'a>(input: &mut UnitInput<'a>) -> Option<&'a str> {
    taken(input, take_while(1.., |c: char| c.is_alphabetic() || c == '°'))
}

/// The power at this place: 1 if none is written, `None` if it is not an integer.
fn power(input: &mut UnitInput) -> Option<i32> {
    let caret = ('^', opt(one_of(['-', '+'])), digit1).take().map(|text: &str| text[1..].parse().ok());
    // Many people write m2 and m-2.
    let bare = (opt('-'), digit1).take().map(|text: &str| text.parse().ok());
    let raised = take_while(1.., SUPERSCRIPTS).map(|text: &str| plain(text).parse().ok());
    taken(input, alt((caret, bare, raised, '^'.value(None)))).unwrap_or(Some(1))
}

/// Superscripts as digits.
fn plain(text: &str) -> String {
    let place = |c: char| SUPERSCRIPTS.iter().position(|known| *known == c);
    text.chars()
        .filter_map(place)
        .map(|at| if at == 0 { "-".to_owned() } else { (at - 1).to_string() })
        .collect()
}

/// The sign between two factors; a blank counts as no sign.
fn separator(input: &mut UnitInput) -> Option<char> {
    taken(input, one_of(['/', '*', '·', '⋅']))
}

/// What the parser takes, if it matches here.
fn taken<'a, T>(input: &mut UnitInput<'a>, parser: impl Parser<UnitInput<'a>, T, EmptyError>) -> Option<T> {
    opt(parser).parse_next(input).ok().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_the_forms_people_write() {
        for (text, si, measures, shown, ascii) in [
            ("m", 1.0, "a length", "m", "m"),
            ("um", 1e-6, "a length", "µm", "um"),
            ("µm", 1e-6, "a length", "µm", "um"),
            ("\u{3bc}m", 1e-6, "a length", "µm", "um"),
            ("Å", 1e-10, "a length", "Å", "angstrom"),
            ("\u{212b}", 1e-10, "a length", "Å", "angstrom"),
            ("m^2", 1.0, "an area", "m²", "m^2"),
            ("mJ/m^2", 1e-3, "an energy per area", "mJ/m²", "mJ/m^2"),
            ("mJ/m²", 1e-3, "an energy per area", "mJ/m²", "mJ/m^2"),
            ("mJ/m2", 1e-3, "an energy per area", "mJ/m²", "mJ/m^2"),
            ("J m-2", 1.0, "an energy per area", "J/m²", "J/m^2"),
            ("J m⁻²", 1.0, "an energy per area", "J/m²", "J/m^2"),
            ("erg/cm^2", 1e-3, "an energy per area", "erg/cm²", "erg/cm^2"),
            ("N/m", 1.0, "a force per length", "N/m", "N/m"),
            (" N  m^-1 ", 1.0, "a force per length", "N/m", "N/m"),
            ("N*m", 1.0, "an energy", "N m", "N m"),
            ("kPa", 1e3, "a stress", "kPa", "kPa"),
            ("hr", 3600.0, "a time", "hr", "hr"),
            ("um/min", 1e-6 / 60.0, "a speed", "µm/min", "um/min"),
            ("N / mm^2", 1e6, "a stress", "N/mm²", "N/mm^2"),
            ("GPa", 1e9, "a stress", "GPa", "GPa"),
            ("pN", 1e-12, "a force", "pN", "pN"),
            ("kg m s^-2", 1.0, "a force", "kg m/s²", "kg m/s^2"),
            ("eV", 1.602_176_634 / 1e19, "an energy", "eV", "eV"),
            ("m^-1", 1.0, "an inverse length", "m⁻¹", "m^-1"),
            ("1/m", 1.0, "an inverse length", "m⁻¹", "m^-1"),
            (" 1 / mm^2", 1e6, "an inverse area", "mm⁻²", "mm^-2"),
            ("/um/mm", 1e9, "an inverse area", "µm⁻¹/mm", "um^-1/mm"),
            ("m/s", 1.0, "a speed", "m/s", "m/s"),
            ("m s^-2", 1.0, "of dimension m s^-2", "m/s²", "m/s^2"),
            ("deg", std::f64::consts::PI / 180.0, "an angle", "°", "deg"),
        ] {
            let unit = Unit::parse(text, 0).unwrap();
            assert_eq!(unit.to_si(1.0).to_bits(), f64::to_bits(si), "{text}: {}", unit.to_si(1.0));
            assert_eq!((unit.measures().as_str(), unit.to_string().as_str()), (measures, shown));
            assert_eq!(unit.ascii(), ascii);
            assert_eq!(Unit::parse(shown, 0), Unit::parse(ascii, 0));
        }
    }

    #[test]
    fn refusals_name_the_column_of_the_whole_text() {
        for (text, message) in [
            ("3 ", "column 3: expected a unit such as um, mN, kPa or mJ/m^2, found the end"),
            ("3 µm/", "column 6: expected a unit such as um, mN, kPa or mJ/m^2, found the end"),
            ("3 (m)", "column 3: expected a unit such as um, mN, kPa or mJ/m^2, found '('"),
            ("3 furlong", "column 3: unknown unit furlong"),
            ("3 Nm", "column 3: unknown unit Nm; did you mean nm?"),
            ("3 kpa", "column 3: unknown unit kpa; did you mean kPa?"),
            ("3 mpa", "column 3: unknown unit mpa; did you mean mPa or MPa?"),
            ("3 1/", "column 5: expected a unit such as um, mN, kPa or mJ/m^2, found the end"),
            (
                "3 um/75",
                "column 6: found 75 after a unit, which is written once after the whole expression, as in (1+1/2) um",
            ),
            (
                "3 um+1um",
                "column 5: found '+' after a unit, which is written once after the whole expression, as in \
                 (1+1/2) um",
            ),
            ("3 1 m", "column 3: expected a unit such as um, mN, kPa or mJ/m^2, found 1"),
            ("3 2/m", "column 3: expected a unit such as um, mN, kPa or mJ/m^2, found 2"),
            ("3 m^x", "column 4: the power of a unit must be an integer from -9 to 9, not 0"),
            ("3 m^0", "column 4: the power of a unit must be an integer from -9 to 9, not 0"),
            ("3 m^99999999999", "column 4: the power of a unit must be an integer from -9 to 9, not 0"),
            ("3 m⁻", "column 4: the power of a unit must be an integer from -9 to 9, not 0"),
            ("3 m m m m m m m m m", "column 19: a unit has at most 8 factors"),
        ] {
            assert_eq!(Unit::parse(text, 2).unwrap_err().to_string(), message, "{text}");
        }
    }
}
