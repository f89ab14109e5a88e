//! Guduru: the wavy sphere h = r²/(2R) + A(1 − cos(2πr/λ)), eq. (23), in closed form.
//!
//! With q = 2πs/λ and the Struve functions H₀, H₁,
//!
//! ```text
//! g(s)  = s²/R + (π²A s/λ) H₀(q)
//! g'(s) = 2s/R + (π²A/λ) [H₀(q) + q(2/π − H₁(q))]
//! M₁(s) = 2s³/(3R) + (π²A s²/λ) [H₀(q) − H₁(q)/q]
//! δ(s)  = g − √(2πγs/E*)
//! P(s)  = 4E*s³/(3R) + (2π²AE*s²/λ) [H₀(q) − H₁(q)/q] − √(8πγE*s³)
//! ```
//!
//! The energy has no such form: it is the integral in the module [`disc`](super::disc). P. R. Guduru, J. Mech. Phys.
//! Solids 55, 445 (2007), doi:10.1016/j.jmps.2006.09.004.

use super::disc::{Disc, Transform};
use super::struve::struve;
use std::f64::consts::{FRAC_2_PI, PI, TAU};

/// An adhesive wavy sphere whose contact is one connected disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guduru {
    /// E*.
    pub effective_modulus: f64,
    /// γ.
    pub work_of_adhesion: f64,
    /// R.
    pub radius_of_curvature: f64,
    /// A.
    pub amplitude: f64,
    /// λ.
    pub wavelength: f64,
}

impl Disc for Guduru {
    fn name(&self) -> &'static str {
        "Guduru 2007"
    }

    fn material(&self) -> [f64; 2] {
        [self.effective_modulus, self.work_of_adhesion]
    }

    fn wave(&self) -> Option<f64> {
        (self.amplitude > 0.0).then_some(self.wavelength)
    }

    fn transform(&self, a: f64) -> Transform {
        let radius = self.radius_of_curvature;
        let q = TAU * a / self.wavelength;
        let (h0, h1) = struve(q);
        // π²A/λ: the steepness of the wave as the transform sees it.
        let wave = PI * PI * self.amplitude / self.wavelength;
        // H₁ starts with q², so the ratio vanishes on the axis.
        let ratio = if q > 0.0 { h1 / q } else { 0.0 };
        Transform {
            value: a * a / radius + wave * a * h0,
            slope: 2.0 * a / radius + wave * (h0 + q * (FRAC_2_PI - h1)),
            moment: 2.0 * a.powi(3) / (3.0 * radius) + wave * a * a * (h0 - ratio),
            resolved: true,
        }
    }
}
