//! A paraboloid with any sum of waves, h = r²/(2R) + Σ Aᵢ [cos φᵢ − cos(qᵢr + φᵢ)], in closed form.
//!
//! The transform of a wave with phase needs, with x = qa,
//!
//! ```text
//! ∫₀^{π/2} sin(x sin θ) dθ = (π/2) H₀(x),   ∫₀^{π/2} cos(x sin θ) dθ = (π/2) J₀(x)
//! ```
//!
//! (Abramowitz and Stegun 12.1.7, 9.1.18), so that sine and cosine follow one pattern. With F = H₀ cos φ + J₀ sin φ,
//! G = H₁ cos φ + J₁ sin φ and, because H₀' = 2/π − H₁, J₀' = −J₁, (xH₁)' = xH₀, (xJ₁)' = xJ₀,
//!
//! ```text
//! g  = a²/R     + Σ (π/2) Aᵢ x F
//! g' = 2a/R     + Σ (π/2) Aᵢqᵢ [F + x((2/π) cos φᵢ − G)]
//! M₁ = 2a³/(3R) + Σ (π/2) (Aᵢ/qᵢ) x [x F − G]
//! ```
//!
//! One wave of phase 0 is [`guduru`](super::guduru): P. R. Guduru, J. Mech. Phys. Solids 55, 445 (2007),
//! doi:10.1016/j.jmps.2006.09.004.

use super::disc::{Disc, Transform};
use super::struve::struve;
use crate::elementary::sin_cos;
use crate::gap::Gap;
use crate::gap::shapes::Harmonics;
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, TAU};

/// An adhesive paraboloid with waves whose contact is one connected disc.
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicDisc {
    /// E*.
    pub effective_modulus: f64,
    /// γ.
    pub work_of_adhesion: f64,
    /// h(r).
    pub gap: Harmonics,
}

impl Disc for HarmonicDisc {
    fn name(&self) -> &'static str {
        "Guduru 2007, summed"
    }

    fn material(&self) -> [f64; 2] {
        [self.effective_modulus, self.work_of_adhesion]
    }

    fn wave(&self) -> Option<f64> {
        self.gap.feature_length()
    }

    fn transform(&self, a: f64) -> Transform {
        let radius = self.gap.radius_of_curvature();
        let mut sum = Transform {
            value: a * a / radius,
            slope: 2.0 * a / radius,
            moment: 2.0 * a.powi(3) / (3.0 * radius),
            resolved: true,
        };
        for wave in self.gap.waves().iter().filter(|wave| wave.amplitude != 0.0) {
            let q = TAU / wave.wavelength;
            let x = q * a;
            let (sin, cos) = sin_cos(wave.phase);
            let (h0, h1) = struve(x);
            let (mut f, mut g) = (h0 * cos, h1 * cos);
            // A wave of phase 0 needs no Bessel functions.
            if sin != 0.0 {
                f += libm::j0(x) * sin;
                g += libm::j1(x) * sin;
            }
            let amplitude = FRAC_PI_2 * wave.amplitude;
            sum.value += amplitude * x * f;
            sum.slope += amplitude * q * (f + x * (FRAC_2_PI * cos - g));
            sum.moment += amplitude / q * x * (x * f - g);
        }
        sum
    }
}
