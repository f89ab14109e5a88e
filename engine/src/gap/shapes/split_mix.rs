//! Random numbers that are the same on every machine and in every version, for ever.
//!
//! ```text
//! s ← s + 9e3779b97f4a7c15
//! z = s;   z ← (z ⊕ z≫30) · bf58476d1ce4e5b9;   z ← (z ⊕ z≫27) · 94d049bb133111eb;   z ⊕ z≫31
//! ```
//!
//! modulo 2⁶⁴: the `SplitMix64` of G. L. Steele, D. Lea and C. H. Flood, *Fast splittable pseudorandom number generators*,
//! OOPSLA 2014, doi:10.1145/2660193.2660195, with the mixing constants of Stafford's variant 13.
//!
//! A preset names a surface by its seed, so the stream is part of the file format. The three lines above define this
//! generator. It needs no crate, whose seeding and conversions might change from one version to the next. Every seed is
//! as good as any other, including 0.

/// The generator.
#[derive(Debug, Clone)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// The stream of `seed`.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The stream of row `row` of the table that `seed` defines. A row can be drawn without the rows before it, because
    /// each starts at its own bits of the stream of `seed`.
    #[must_use]
    pub fn row(seed: u64, row: u64) -> Self {
        // The state is a counter, so the n-th output needs no others.
        let mut at = Self(seed.wrapping_add(row.wrapping_mul(0x9e37_79b9_7f4a_7c15)));
        Self(at.bits())
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// The next number in 0 ≤ u < 1: the upper 53 bits, exact.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_is_the_published_one() {
        // The outputs of other implementations for these seeds.
        let mut random = SplitMix64::new(1_234_567);
        let first = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
            4_593_380_528_125_082_431,
            16_408_922_859_458_223_821,
        ];
        assert_eq!([(); 5].map(|()| random.bits()), first);
        assert_eq!(SplitMix64::new(0).bits(), 0xe220_a839_7b1d_cdaf);
    }

    #[test]
    fn a_row_is_the_stream_of_its_bits() {
        let mut all = SplitMix64::new(7);
        for row in 0..5 {
            let (mut row, mut own) = (SplitMix64::row(7, row), SplitMix64::new(all.bits()));
            assert_eq!([row.bits(), row.bits()], [own.bits(), own.bits()]);
        }
    }

    #[test]
    fn units_are_uniform_and_below_one() {
        let mut random = SplitMix64::new(7);
        let draws: Vec<f64> = (0..10_000).map(|_| random.unit()).collect();
        assert!(draws.iter().all(|u| (0.0..1.0).contains(u)));
        let mean = draws.iter().sum::<f64>() / 1e4;
        // Five standard deviations of the mean.
        assert!((mean - 0.5).abs() < 5.0 * (1.0_f64 / 12e4).sqrt(), "{mean}");
    }
}
