//! A paraboloid with waves drawn from a power law: a self-affine rough sphere, the same for the same seed.
//!
//! A profile is self-affine with the Hurst exponent H when ⟨(h(r+x) − h(r))²⟩ ∝ x^(2H). If C(q) dq is the variance
//! carried by the waves between q and q + dq, the left side is 2∫C(q)(1 − cos qx)dq. The substitution u = qx shows that
//! in one dimension this is met by
//!
//! ```text
//! C(q) ∝ q^(−2H−1),   q_long = 2π/λ_long ≤ q ≤ q_short = 2π/λ_short
//! ```
//!
//! for 0 < H < 1; H = 1 is the limit. ln q is cut into m equal bands. Each band gets one wave with all the variance of
//! the band, at a wavenumber drawn uniformly in ln q within it (fixed wavenumbers in equal ratios would repeat
//! themselves) and with a phase drawn uniformly in 0 ≤ φ < 2π:
//!
//! ```text
//! Aᵢ²/2 ∝ ∫_band C dq ∝ q₋^(−2H) − q₊^(−2H),   Σ Aᵢ²/2 = rms²
//! ```
//!
//! so rms is the root mean square of the sum of waves over a radius long compared to `λ_long`. The numbers are drawn in
//! the order wavenumber, phase, from the longest band to the shortest, from [`SplitMix64`] with the seed: bit for bit
//! the same everywhere. The lengths and the exponent only stretch the result, so changing one of them keeps the surface
//! and its character.
//!
//! M. V. Berry and Z. V. Lewis, Proc. R. Soc. A 370, 459 (1980), doi:10.1098/rspa.1980.0044, for the sum of cosines; B.
//! N. J. Persson et al., J. Phys.: Condens. Matter 17, R1 (2005), doi:10.1088/0953-8984/17/1/R01, for the power law.

use super::harmonics::{Harmonic, Harmonics, MOST_WAVES};
use super::split_mix::SplitMix64;
use crate::elementary::{exp, ln};
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};
use std::f64::consts::TAU;

/// What the waves are drawn from. Lengths in one unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RandomWaves {
    /// R of the paraboloid, positive.
    pub radius_of_curvature: f64,
    /// Root mean square of the waves, at least 0.
    pub rms: f64,
    /// `λ_long`, the upper end of the wavelengths.
    pub longest: f64,
    /// `λ_short`, their lower end, below `longest`.
    pub shortest: f64,
    /// H, 0 < H ≤ 1.
    pub hurst: f64,
    /// m, from 1 to [`MOST_WAVES`].
    pub count: usize,
    /// Selects one of all such surfaces.
    pub seed: u64,
}

/// Why no waves can be drawn.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum RandomWavesError {
    /// A number is out of its range.
    #[error("{what} = {value:e} is out of range: it must be {allowed}")]
    OutOfRange {
        /// What it is.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The values it takes.
        allowed: &'static str,
    },
    /// The wavelengths are in the wrong order.
    #[error("{}", order(&UnitSystem::Reduced, [*.shortest, *.longest]))]
    Order {
        /// The shortest wavelength.
        shortest: f64,
        /// The longest.
        longest: f64,
    },
    /// The number of waves is out of range.
    #[error("{0} waves are out of range: 1 to {MOST_WAVES} are allowed")]
    Count(usize),
}

/// The error for a shortest and a longest wavelength in the wrong order, in words.
fn order(units: &UnitSystem, wavelengths: [f64; 2]) -> String {
    let [shortest, longest] = wavelengths.map(|x| said(units, Quantity::Length, x));
    format!("the shortest wavelength {shortest} must be below the longest, {longest}")
}

impl RandomWavesError {
    /// What is wrong, with the wavelengths as `units` show them.
    pub fn words(&self, units: &UnitSystem) -> String {
        match *self {
            Self::Order { shortest, longest } => order(units, [shortest, longest]),
            other => other.to_string(),
        }
    }
}

impl RandomWaves {
    /// The gap: the waves drawn, from the longest to the shortest.
    ///
    /// # Errors
    /// [`RandomWavesError`], naming the number that is out of range.
    pub fn harmonics(&self) -> Result<Harmonics, RandomWavesError> {
        let waves = self.waves()?;
        Harmonics::new(self.radius_of_curvature, waves).map_err(|e| RandomWavesError::Count(e.0))
    }

    fn check(&self) -> Result<(), RandomWavesError> {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        for (what, value, good, allowed) in [
            (
                "the radius of curvature",
                self.radius_of_curvature,
                positive(self.radius_of_curvature),
                "positive",
            ),
            ("the rms amplitude", self.rms, self.rms.is_finite() && self.rms >= 0.0, "0 or positive"),
            ("the longest wavelength", self.longest, positive(self.longest), "positive"),
            ("the shortest wavelength", self.shortest, positive(self.shortest), "positive"),
            (
                "the Hurst exponent",
                self.hurst,
                self.hurst > 0.0 && self.hurst <= 1.0,
                "above 0 and at most 1",
            ),
        ] {
            if !good {
                return Err(RandomWavesError::OutOfRange { what, value, allowed });
            }
        }
        if self.shortest >= self.longest {
            return Err(RandomWavesError::Order { shortest: self.shortest, longest: self.longest });
        }
        if !(1..=MOST_WAVES).contains(&self.count) {
            return Err(RandomWavesError::Count(self.count));
        }
        Ok(())
    }

    fn waves(&self) -> Result<Vec<Harmonic>, RandomWavesError> {
        self.check()?;
        let band = ln(self.longest / self.shortest) / self.count as f64;
        // The logarithm of the variance changes by this from band to band; the first band has the variance 1.
        let fall = -2.0 * self.hurst * band;
        let variance = |i: usize| exp(fall * i as f64);
        let total: f64 = (0..self.count).map(variance).sum();
        let mut random = SplitMix64::new(self.seed);
        let draw = |i: usize| {
            let place = i as f64 + random.unit();
            let phase = TAU * random.unit();
            let wavelength = self.longest * exp(-band * place);
            let amplitude = self.rms * (2.0 * variance(i) / total).sqrt();
            Harmonic { amplitude, wavelength, phase }
        };
        Ok((0..self.count).map(draw).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::Gap;

    const ROUGH: RandomWaves = RandomWaves {
        radius_of_curvature: 1.0,
        rms: 2e-3,
        longest: 0.5,
        shortest: 0.01,
        hurst: 0.8,
        count: 40,
        seed: 42,
    };

    #[test]
    fn the_same_seed_is_the_same_surface() {
        // The first and the last wave, computed by another program from the stream and the formulas above.
        let drawn = ROUGH.harmonics().unwrap();
        let waves = drawn.waves();
        for (wave, [amplitude, wavelength, phase]) in [
            (waves[0], [1.077_514_758_429_702_2e-3, 0.465_021_028_329_047_9, 1.004_746_630_989_579_6]),
            (waves[39], [5.095_967_198_706_604e-5, 0.010_690_113_807_173_642, 3.119_045_197_017_591]),
        ] {
            assert!((wave.amplitude / amplitude - 1.0).abs() < 1e-14, "{wave:?}");
            assert!((wave.wavelength / wavelength - 1.0).abs() < 1e-14, "{wave:?}");
            assert!((wave.phase / phase - 1.0).abs() < 1e-14, "{wave:?}");
        }
        assert_eq!(drawn, ROUGH.harmonics().unwrap());
        assert_ne!(drawn, RandomWaves { seed: 43, ..ROUGH }.harmonics().unwrap());
    }

    #[test]
    fn a_knob_keeps_the_surface() {
        let stretched = RandomWaves { rms: 4e-3, longest: 5.0, shortest: 0.1, ..ROUGH }.harmonics().unwrap();
        for (a, b) in ROUGH.harmonics().unwrap().waves().iter().zip(stretched.waves()) {
            assert!((b.phase - a.phase).abs() < 1e-15);
            assert!((b.amplitude / a.amplitude - 2.0).abs() < 1e-12);
            assert!((b.wavelength / a.wavelength - 10.0).abs() < 1e-12);
        }
    }

    #[test]
    fn wavelengths_lie_in_their_bands_and_the_rms_is_the_given_one() {
        for count in [1, 7, 1000] {
            let drawn = RandomWaves { count, ..ROUGH }.harmonics().unwrap();
            let ratio = (0.01_f64 / 0.5).powf(1.0 / count as f64);
            for (i, wave) in drawn.waves().iter().enumerate() {
                let upper = 0.5 * ratio.powi(i32::try_from(i).unwrap());
                let relative = wave.wavelength / upper;
                assert!((ratio - 1e-12..=1.0 + 1e-12).contains(&relative), "{i}: {wave:?}");
                assert!((0.0..TAU).contains(&wave.phase));
            }
            let variance: f64 = drawn.waves().iter().map(|w| 0.5 * w.amplitude * w.amplitude).sum();
            assert!((variance.sqrt() / 2e-3 - 1.0).abs() < 1e-13);
            assert!(drawn.feature_length().unwrap() >= 0.01);
        }
        // The sum itself, over many times its longest wave.
        let drawn = ROUGH.harmonics().unwrap();
        let waves: Vec<f64> = (0..400_000)
            .map(|i| {
                let r = 5e-3 * f64::from(i);
                drawn.jet(r).value - 0.5 * r * r
            })
            .collect();
        let n = waves.len() as f64;
        let mean = waves.iter().sum::<f64>() / n;
        let rms = (waves.iter().map(|h| (h - mean).powi(2)).sum::<f64>() / n).sqrt();
        assert!((rms / 2e-3 - 1.0).abs() < 1e-2, "{rms}");
    }

    #[test]
    fn the_structure_function_has_the_hurst_exponent() {
        // ⟨(h(r+x) − h(r))²⟩ = Σ A²(1 − cos qx), between the ends of the wavelengths; averaged over seeds.
        for hurst in [0.3, 0.5, 0.8] {
            let structure = |x: f64| -> f64 {
                (0..50)
                    .map(|seed| {
                        let spec =
                            RandomWaves { longest: 100.0, shortest: 1e-4, count: 300, hurst, seed, ..ROUGH };
                        let drawn = spec.harmonics().unwrap();
                        let term =
                            |w: &Harmonic| w.amplitude.powi(2) * (1.0 - (TAU * x / w.wavelength).cos());
                        drawn.waves().iter().map(term).sum::<f64>()
                    })
                    .sum()
            };
            let slope = (structure(0.03) / structure(0.01)).ln() / 3.0_f64.ln();
            assert!((slope - 2.0 * hurst).abs() < 0.05, "H = {hurst}: {slope}");
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        let refused = |spec: RandomWaves| spec.harmonics().unwrap_err().to_string();
        assert!(refused(RandomWaves { hurst: 1.5, ..ROUGH }).contains("Hurst exponent = 1.5e0"));
        assert!(refused(RandomWaves { rms: f64::NAN, ..ROUGH }).contains("rms amplitude"));
        assert!(refused(RandomWaves { shortest: 0.5, ..ROUGH }).contains("must be below the longest"));
        for count in [0, 1001] {
            assert!(refused(RandomWaves { count, ..ROUGH }).contains("1 to 1000 are allowed"));
        }
    }
}
