//! Unit names and SI prefixes.

use super::dimension::Dimension;
use std::f64::consts::PI;

/// A unit with a name: `mantissa` × 10^`exponent` of its dimension in SI.
#[derive(Debug, PartialEq)]
pub struct NamedUnit {
    /// How it is shown.
    pub symbol: &'static str,
    /// How it is shown if only ASCII is possible.
    pub ascii: &'static str,
    /// What else is read as this unit.
    pub alias: &'static str,
    /// Its dimension.
    pub dimension: Dimension,
    /// Its value in SI without the power of ten.
    pub mantissa: f64,
    /// The power of ten.
    pub exponent: i32,
    /// Whether it takes SI prefixes.
    pub prefixed: bool,
}

/// A decimal prefix.
#[derive(Debug, PartialEq)]
pub struct Prefix {
    /// How it is shown.
    pub symbol: &'static str,
    /// How it is shown if only ASCII is possible.
    pub ascii: &'static str,
    /// What else is read as this prefix.
    pub alias: &'static str,
    /// Its power of ten.
    pub exponent: i32,
}

const fn named(symbol: &'static str, dimension: Dimension, exponent: i32) -> NamedUnit {
    NamedUnit { symbol, ascii: symbol, alias: symbol, dimension, mantissa: 1.0, exponent, prefixed: true }
}

const fn prefix(symbol: &'static str, exponent: i32) -> Prefix {
    Prefix { symbol, ascii: symbol, alias: symbol, exponent }
}

const LENGTH: Dimension = Dimension::new(1, 0, 0);
const FORCE: Dimension = Dimension::new(1, 1, -2);
const STRESS: Dimension = Dimension::new(-1, 1, -2);
const ENERGY: Dimension = Dimension::new(2, 1, -2);

/// The metre.
pub static METRE: NamedUnit = named("m", LENGTH, 0);
/// The newton.
pub static NEWTON: NamedUnit = named("N", FORCE, 0);
/// The pascal.
pub static PASCAL: NamedUnit = named("Pa", STRESS, 0);
/// The joule.
pub static JOULE: NamedUnit = named("J", ENERGY, 0);

static GRAM: NamedUnit = named("g", Dimension::new(0, 1, 0), -3);
/// The second.
pub static SECOND: NamedUnit = named("s", Dimension::new(0, 0, 1), 0);
static MINUTE: NamedUnit =
    NamedUnit { mantissa: 6.0, prefixed: false, ..named("min", Dimension::new(0, 0, 1), 1) };
// Not h, which is what heights and gaps are called.
static HOUR: NamedUnit =
    NamedUnit { alias: "hour", mantissa: 3.6, prefixed: false, ..named("hr", Dimension::new(0, 0, 1), 3) };
static ELECTRONVOLT: NamedUnit = NamedUnit { mantissa: 1.602_176_634, ..named("eV", ENERGY, -19) };
// The second character is the ångström sign, which looks the same.
static ANGSTROM: NamedUnit =
    NamedUnit { ascii: "angstrom", alias: "\u{212b}", prefixed: false, ..named("Å", LENGTH, -10) };
static MICRON: NamedUnit = NamedUnit { prefixed: false, ..named("micron", LENGTH, -6) };
static INCH: NamedUnit = NamedUnit { mantissa: 2.54, prefixed: false, ..named("in", LENGTH, -2) };
static BAR: NamedUnit = named("bar", STRESS, 5);
static DYNE: NamedUnit = NamedUnit { prefixed: false, ..named("dyn", FORCE, -5) };
// The weights of a gram and of a pound under standard gravity, exact by definition: NIST SP 811, appendix B.
static GRAM_FORCE: NamedUnit = NamedUnit { mantissa: 9.806_65, ..named("gf", FORCE, -3) };
static POUND_FORCE: NamedUnit =
    NamedUnit { mantissa: 4.448_221_615_260_5, prefixed: false, ..named("lbf", FORCE, 0) };
static ERG: NamedUnit = NamedUnit { prefixed: false, ..named("erg", ENERGY, -7) };
static RADIAN: NamedUnit = named("rad", Dimension::NONE, 0);
static DEGREE: NamedUnit = NamedUnit {
    ascii: "deg",
    alias: "deg",
    mantissa: PI / 180.0,
    prefixed: false,
    ..named("°", Dimension::NONE, 0)
};

/// The units by name.
pub static UNITS: [&NamedUnit; 19] = [
    &METRE,
    &NEWTON,
    &PASCAL,
    &JOULE,
    &GRAM,
    &SECOND,
    &MINUTE,
    &HOUR,
    &ELECTRONVOLT,
    &ANGSTROM,
    &MICRON,
    &INCH,
    &BAR,
    &DYNE,
    &GRAM_FORCE,
    &POUND_FORCE,
    &ERG,
    &RADIAN,
    &DEGREE,
];

/// No prefix.
pub static NONE: Prefix = prefix("", 0);
/// 10³.
pub static KILO: Prefix = prefix("k", 3);
/// 10⁻³.
pub static MILLI: Prefix = prefix("m", -3);
/// 10⁻⁶: the micro sign, `u`, or the Greek letter.
pub static MICRO: Prefix = Prefix { ascii: "u", alias: "\u{3bc}", ..prefix("µ", -6) };
/// 10⁻¹².
pub static PICO: Prefix = prefix("p", -12);

static OTHERS: [Prefix; 16] = [
    prefix("n", -9),
    prefix("M", 6),
    prefix("G", 9),
    prefix("c", -2),
    prefix("d", -1),
    prefix("da", 1),
    prefix("h", 2),
    prefix("T", 12),
    prefix("P", 15),
    prefix("E", 18),
    prefix("Z", 21),
    prefix("Y", 24),
    prefix("f", -15),
    prefix("a", -18),
    prefix("z", -21),
    prefix("y", -24),
];

/// The prefix and the unit with this name.
pub fn lookup(word: &str) -> Option<(&'static Prefix, &'static NamedUnit)> {
    let prefixes = || [&NONE, &KILO, &MILLI, &MICRO, &PICO].into_iter().chain(&OTHERS);
    UNITS.iter().find_map(|&unit| {
        let names = [unit.symbol, unit.ascii, unit.alias];
        let mut before = names.into_iter().filter_map(|name| word.strip_suffix(name));
        before.find_map(|before| {
            let named = |prefix: &&Prefix| [prefix.symbol, prefix.ascii, prefix.alias].contains(&before);
            prefixes()
                .find(named)
                .filter(|prefix| unit.prefixed || prefix.exponent == 0)
                .map(|found| (found, unit))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_word_has_two_meanings() {
        let prefixes: Vec<&Prefix> =
            [&NONE, &KILO, &MILLI, &MICRO, &PICO].into_iter().chain(&OTHERS).collect();
        for unit in UNITS {
            for prefix in &prefixes {
                if !unit.prefixed && prefix.exponent != 0 {
                    continue;
                }
                for (prefix_name, unit_name) in
                    [(prefix.symbol, unit.symbol), (prefix.ascii, unit.ascii), (prefix.alias, unit.alias)]
                {
                    let word = format!("{prefix_name}{unit_name}");
                    let (p, u) = lookup(&word).unwrap();
                    assert_eq!((p.symbol, u.symbol), (prefix.symbol, unit.symbol), "{word}");
                }
            }
        }
        for word in ["", "k", "mkm", "kdeg", "um2", "PA", "n m", "metre", "kmin", "kmicron"] {
            assert_eq!(lookup(word), None, "{word}");
        }
    }
}
