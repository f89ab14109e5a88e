//! Numbers that come back bit for bit, including those that JSON cannot write: `#[serde(with = "crate::exact")]`.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// What consists of numbers.
pub trait Numbers {
    /// The same with numbers as they are written.
    type Written: Serialize + DeserializeOwned;
    /// Its written form.
    fn written(&self) -> Self::Written;
    /// The inverse.
    fn read(written: Self::Written) -> Self;
}

/// A number: a JSON number if finite, otherwise its 64 bits as hexadecimal digits, since there is more than one NaN.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(into = "WrittenReal", try_from = "WrittenReal")]
pub struct Real(f64);

#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "a number, or the 16 digits of one that is not finite")]
enum WrittenReal {
    Number(f64),
    Bits(String),
}

impl From<Real> for WrittenReal {
    fn from(Real(x): Real) -> Self {
        if x.is_finite() { Self::Number(x) } else { Self::Bits(format!("{:016x}", x.to_bits())) }
    }
}

impl TryFrom<WrittenReal> for Real {
    type Error = &'static str;

    fn try_from(form: WrittenReal) -> Result<Self, Self::Error> {
        match form {
            WrittenReal::Number(x) => Some(x),
            WrittenReal::Bits(digits) => {
                u64::from_str_radix(&digits, 16).ok().map(f64::from_bits).filter(|x| !x.is_finite())
            }
        }
        .map(Self)
        .ok_or("not a number")
    }
}

impl Numbers for f64 {
    type Written = Real;

    fn written(&self) -> Real {
        Real(*self)
    }

    fn read(written: Real) -> Self {
        written.0
    }
}

impl<T: Numbers> Numbers for Option<T> {
    type Written = Option<T::Written>;

    fn written(&self) -> Self::Written {
        self.as_ref().map(T::written)
    }

    fn read(written: Self::Written) -> Self {
        written.map(T::read)
    }
}

impl<T: Numbers> Numbers for Vec<T> {
    type Written = Vec<T::Written>;

    fn written(&self) -> Self::Written {
        self.iter().map(T::written).collect()
    }

    fn read(written: Self::Written) -> Self {
        written.into_iter().map(T::read).collect()
    }
}

impl<T: Numbers> Numbers for [T; 2] {
    type Written = [T::Written; 2];

    fn written(&self) -> Self::Written {
        self.each_ref().map(T::written)
    }

    fn read(written: Self::Written) -> Self {
        written.map(T::read)
    }
}

impl<A: Numbers, B: Numbers> Numbers for (A, B) {
    type Written = (A::Written, B::Written);

    fn written(&self) -> Self::Written {
        (self.0.written(), self.1.written())
    }

    fn read((a, b): Self::Written) -> Self {
        (A::read(a), B::read(b))
    }
}

/// Writes `numbers`.
///
/// # Errors
/// Those of `serializer`.
pub fn serialize<T: Numbers, S: Serializer>(numbers: &T, serializer: S) -> Result<S::Ok, S::Error> {
    numbers.written().serialize(serializer)
}

/// Reads numbers.
///
/// # Errors
/// Those of `deserializer`, or something is not a number.
pub fn deserialize<'de, T: Numbers, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    T::Written::deserialize(deserializer).map(T::read)
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
        for text in ["\"\"", "\"infinity\"", "\"nan:0\"", "\"nan:zz\"", "\"0\"", "null", "true", "[1]"] {
            assert!(serde_json::from_str::<Real>(text).is_err(), "{text}");
        }
        assert_eq!(serde_json::from_str::<Real>("-3").unwrap().0.to_bits(), (-3.0_f64).to_bits());
    }

    #[test]
    fn what_consists_of_numbers_comes_back() {
        #[derive(Debug, PartialEq, Serialize, Deserialize)]
        struct All(#[serde(with = "super")] Vec<(Option<f64>, [f64; 2])>);

        let all = All(vec![(None, [f64::INFINITY, -0.1]), (Some(2.5), [1.0, f64::NEG_INFINITY])]);
        let text = serde_json::to_string(&all).unwrap();
        assert_eq!(text, r#"[[null,["7ff0000000000000",-0.1]],[2.5,[1.0,"fff0000000000000"]]]"#);
        assert_eq!(serde_json::from_str::<All>(&text).unwrap(), all);
    }
}
