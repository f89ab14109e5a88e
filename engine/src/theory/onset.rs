//! The envelope of snaps on small waves: below it no snap is possible on a crest, whatever the adhesion.
//!
//! On a paraboloid of radius R with a wave of length λ ≪ s, g' is 2s/R plus a wave of slowly growing height. The tip at
//! which the first pair of limit points is born on the crest at s has
//!
//! ```text
//! A*/λ = (3/(4π³)) (λ/R)^{3/2} √(R/s),       γ' = 16 (s/R)³     (under force a ninth of it)
//! ```
//!
//! to leading order in λ/s. The error is 0.3 % in A* and 1 % in γ' at s = 3.4 λ, and 15 % and 40 % at the innermost
//! crest. It is an envelope: at a given adhesion a preset snaps only from amplitudes 1.5 to 4 times larger.

use crate::elementary::pow;
use std::f64::consts::PI;

/// A*/λ of the crest at the contact radius `s`, a length, for waves of length `wavelength` on a sphere of radius
/// `radius_of_curvature`.
pub fn amplitude_over_wavelength(wavelength: f64, radius_of_curvature: f64, s: f64) -> f64 {
    3.0 / (4.0 * PI.powi(3)) * pow(wavelength / radius_of_curvature, 1.5) * (radius_of_curvature / s).sqrt()
}

/// γ' at which that pair is born under displacement.
pub fn adhesion(radius_of_curvature: f64, s: f64) -> f64 {
    16.0 * (s / radius_of_curvature).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_two_forms_are_one() {
        // A*/λ = 0.02419 (λ/R)^{3/2} (16/γ')^{1/6}.
        for s in [0.1, 0.3] {
            let by_adhesion = 0.02419 * 0.05f64.powf(1.5) * (16.0 / adhesion(1.0, s)).powf(1.0 / 6.0);
            assert!((amplitude_over_wavelength(0.05, 1.0, s) / by_adhesion - 1.0).abs() < 1e-4);
        }
    }
}
