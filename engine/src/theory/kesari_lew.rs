//! Kesari and Lew: the wavy sphere with small waves, as two smooth envelopes.
//!
//! For q = 2πs/λ ≫ 1 the Struve functions of [`guduru`](super::guduru) are a wave plus a mean. With Johnson's α =
//! √(2γλ/(π²E*A²)), the wave is 1/(√π α) of the adhesive edge T = √(2πγs/E*):
//!
//! ```text
//! δ ≈ s²/R + A − T [1 − sin(q − π/4)/(√π α)],   P ≈ 4E*s³/(3R) − 2E*s T [1 − sin(q − π/4)/(√π α)]
//! ```
//!
//! So the curve winds between two JKR curves, shifted by A, whose works of adhesion are γ(1 ± 1/(√π α))². The edge lets
//! go near the curve that pulls more, and
//!
//! ```text
//! P_off/P_c ≈ (1 + 1/(√π α))²,   at s = s_c (1 + 1/(√π α))^{2/3}
//! ```
//!
//! The formulas need many waves in the disc; the measure is n = s/λ at pull-off, [`KesariLew::waves`].
//!
//! H. Kesari and A. J. Lew, J. Mech. Phys. Solids 59, 2488 (2011), for the envelopes; that the pull-off depends on α
//! alone was pointed out by M. Ciavarella, *On roughness-induced adhesion enhancement*. The mean A of the approach
//! follows from the same asymptotic forms, H₀ → Y₀ + 2/(πq).

use super::guduru::Guduru;
use super::jkr::Jkr;
use std::f64::consts::PI;

/// Which of the two envelopes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EnvelopeSide {
    /// The one with the larger pull, along which a disc peels.
    Unloading,
    /// The one with the smaller pull, along which a disc grows.
    Loading,
}

/// The envelopes of a wavy sphere with `amplitude` A > 0 and `work_of_adhesion` γ > 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KesariLew {
    /// The wavy sphere.
    pub sphere: Guduru,
}

impl KesariLew {
    /// 1/(√π α) = A√(πE*/(2γλ)): the wave's share of the adhesive edge; infinite at γ = 0.
    pub fn share(&self) -> f64 {
        let Guduru { effective_modulus, work_of_adhesion, amplitude, wavelength, .. } = self.sphere;
        amplitude * (PI * effective_modulus / (2.0 * work_of_adhesion * wavelength)).sqrt()
    }

    /// δ and P of an envelope at the contact radius `s`.
    pub fn envelope(&self, side: EnvelopeSide, s: f64) -> (f64, f64) {
        let Guduru { effective_modulus: e, work_of_adhesion, radius_of_curvature, amplitude, .. } =
            self.sphere;
        let factor = match side {
            EnvelopeSide::Unloading => 1.0 + self.share(),
            // Negative where the wave is stronger than the adhesion: the edge then presses.
            EnvelopeSide::Loading => 1.0 - self.share(),
        };
        let edge = factor * (2.0 * PI * work_of_adhesion * s / e).sqrt();
        let approach = s * s / radius_of_curvature + amplitude - edge;
        (approach, 4.0 * e * s.powi(3) / (3.0 * radius_of_curvature) - 2.0 * e * s * edge)
    }

    /// `P_off/P_c`, the pull-off force under a dead load divided by that of the smooth sphere.
    pub fn pull_off_ratio(&self) -> f64 {
        (1.0 + self.share()).powi(2)
    }

    /// The smooth sphere with the pull-off of the envelope: its work of adhesion is γ(1 + 1/(√π α))².
    pub fn effective(&self) -> Jkr {
        let Guduru { effective_modulus, work_of_adhesion, radius_of_curvature, .. } = self.sphere;
        let work_of_adhesion = work_of_adhesion * self.pull_off_ratio();
        Jkr { effective_modulus, work_of_adhesion, radius_of_curvature }
    }

    /// n = s/λ, the waves in the disc at pull-off under a dead load. The formulas hold better the larger it is: with n
    /// ≥ 5 the ratio is within 2 % of the exact one, with n ≥ 20 within 0.2 %.
    pub fn waves(&self) -> f64 {
        self.effective().pull_off_radius() / self.sphere.wavelength
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::Disc;

    /// The exact peak pull-off divided by `P_c`, by a scan finer than the waves.
    fn exact_ratio(sphere: &Guduru) -> f64 {
        let smooth = Jkr {
            effective_modulus: sphere.effective_modulus,
            work_of_adhesion: sphere.work_of_adhesion,
            radius_of_curvature: sphere.radius_of_curvature,
        };
        let end = 4.0 * KesariLew { sphere: *sphere }.effective().pull_off_radius();
        let steps = (200.0 * end / sphere.wavelength).ceil();
        let mut least = 0.0_f64;
        let mut i = 1.0;
        while i <= steps {
            least = least.min(sphere.force(end * i / steps));
            i += 1.0;
        }
        -least / smooth.pull_off_force()
    }

    fn sphere(wavelength: f64, alpha: f64) -> Guduru {
        let (e, gamma) = (1.0, 0.004);
        let amplitude = (2.0 * gamma * wavelength / (PI * PI * e * alpha * alpha)).sqrt();
        Guduru {
            effective_modulus: e,
            work_of_adhesion: gamma,
            radius_of_curvature: 1.0,
            amplitude,
            wavelength,
        }
    }

    #[test]
    fn the_pull_off_tends_to_the_formula() {
        for alpha in [0.7, 1.5, 4.0] {
            for wavelength in [0.1, 0.05, 0.02, 0.01, 0.005, 0.002] {
                let kl = KesariLew { sphere: sphere(wavelength, alpha) };
                let (n, off) = (kl.waves(), exact_ratio(&kl.sphere) / kl.pull_off_ratio() - 1.0);
                let bound = if n >= 20.0 {
                    2e-3
                } else if n >= 5.0 {
                    2e-2
                } else {
                    0.1
                };
                assert!(off.abs() < bound, "alpha {alpha}, n {n}: {off}");
            }
        }
    }

    #[test]
    fn the_curve_winds_between_the_envelopes_and_touches_both() {
        let kl = KesariLew { sphere: sphere(0.002, 1.5) };
        let [mut nearest_low, mut nearest_high] = [f64::INFINITY; 2];
        for i in 0..4000 {
            let s = 0.3 + 1e-6 * f64::from(i);
            let (low, high) =
                (kl.envelope(EnvelopeSide::Unloading, s), kl.envelope(EnvelopeSide::Loading, s));
            // At equal radius both δ and P lie between, within what the next order adds.
            for (exact, low, high) in
                [(kl.sphere.approach(s), low.0, high.0), (kl.sphere.force(s), low.1, high.1)]
            {
                let place = (exact - low) / (high - low);
                assert!((-0.01..1.01).contains(&place), "{s}: {place}");
                nearest_low = nearest_low.min(place.abs());
                nearest_high = nearest_high.min((1.0 - place).abs());
            }
        }
        assert!(nearest_low < 1e-3 && nearest_high < 1e-3, "{nearest_low} {nearest_high}");
    }
}
