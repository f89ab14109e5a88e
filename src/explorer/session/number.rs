//! Numbers that come back bit for bit, including those that JSON cannot write.

use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// A number of a session: written as a JSON number if finite, otherwise as a word.
#[derive(Debug, Clone, Copy)]
pub(super) struct Real(pub f64);

/// The words for numbers that are not finite.
const INFINITY: &str = "inf";
const NEGATIVE_INFINITY: &str = "-inf";
/// Followed by the bits, since there is more than one NaN.
const NAN: &str = "nan:";

impl Serialize for Real {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(x) = *self;
        if x.is_finite() {
            serializer.serialize_f64(x)
        } else if x.is_nan() {
            serializer.serialize_str(&format!("{NAN}{:016x}", x.to_bits()))
        } else {
            serializer.serialize_str(if x > 0.0 { INFINITY } else { NEGATIVE_INFINITY })
        }
    }
}

struct NumberReader;

impl Visitor<'_> for NumberReader {
    type Value = Real;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, \"inf\", \"-inf\" or \"nan:BITS\"")
    }

    fn visit_f64<E: Error>(self, x: f64) -> Result<Real, E> {
        Ok(Real(x))
    }

    // Whole numbers are written with a point, but another program may leave it out.
    fn visit_i64<E: Error>(self, n: i64) -> Result<Real, E> {
        Ok(Real(n as f64))
    }

    fn visit_u64<E: Error>(self, n: u64) -> Result<Real, E> {
        Ok(Real(n as f64))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Real, E> {
        let nan = || Some(f64::from_bits(u64::from_str_radix(text.strip_prefix(NAN)?, 16).ok()?));
        let x = match text {
            INFINITY => Some(f64::INFINITY),
            NEGATIVE_INFINITY => Some(f64::NEG_INFINITY),
            _ => nan().filter(|x: &f64| x.is_nan()),
        };
        x.map(Real).ok_or_else(|| E::custom("not a number"))
    }
}

impl<'de> Deserialize<'de> for Real {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberReader)
    }
}

pub(super) fn reals<const N: usize>(numbers: [f64; N]) -> [Real; N] {
    numbers.map(Real)
}

pub(super) fn floats<const N: usize>(numbers: [Real; N]) -> [f64; N] {
    numbers.map(|real| real.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    fn back(x: f64) -> f64 {
        let text = serde_json::to_string(&Real(x)).unwrap();
        serde_json::from_str::<Real>(&text).unwrap().0
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 2000, rng_seed: RngSeed::Fixed(5), failure_persistence: None, ..ProptestConfig::default()
        })]

        #[test]
        fn every_bit_comes_back(bits in any::<u64>()) {
            prop_assert_eq!(back(f64::from_bits(bits)).to_bits(), bits);
        }
    }

    #[test]
    fn the_odd_ones_come_back_too() {
        for x in [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, -f64::NAN, 5e-324, f64::MAX, 1e15] {
            assert_eq!(back(x).to_bits(), x.to_bits(), "{x}");
        }
        for text in ["\"\"", "\"infinity\"", "\"nan:0\"", "\"nan:zz\"", "null", "true", "[1]"] {
            assert!(serde_json::from_str::<Real>(text).is_err(), "{text}");
        }
    }
}
