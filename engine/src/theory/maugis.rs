//! A sphere with a constant tension over a finite range, in closed form (Maugis): the reference for adhesion with a
//! range.
//!
//! With s = c cos ψ the gap at the edge c of the zone is `h_c` where a quadratic in c vanishes:
//!
//! ```text
//! (c²/πR)[ψ + sin ψ cos ψ − 2ψ cos²ψ] + (4σ₀c/πE*)[ψ sin ψ − (1 − cos ψ)] = γ/σ₀
//! δ = s²/R − (2σ₀/E*) c sin ψ,      P = 4E*s³/3R − 4σ₀ s c sin ψ − 2σ₀c²(ψ − sin ψ cos ψ)
//! ```
//!
//! D. Maugis, J. Colloid Interface Sci. 150, 243 (1992), doi:10.1016/0021-9797(92)90285-T, eqs. (6.17)-(6.22) with m = 1/cos ψ.

use crate::elementary::{cbrt, sin_cos};
use crate::root;
use std::f64::consts::{FRAC_PI_2, PI};

/// Angles at which the largest pull is looked for, and steps of its golden-section search.
const ANGLES: u32 = 200;

/// A sphere of R = E* = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Maugis {
    /// γ/E*R.
    pub work_of_adhesion: f64,
    /// σ₀/E*.
    pub strength: f64,
}

impl Maugis {
    /// The sphere with this `λ_M` and γ/E*R.
    #[must_use]
    pub fn of(parameter: f64, work_of_adhesion: f64) -> Self {
        Self { work_of_adhesion, strength: parameter / cbrt(9.0 / (2.0 * PI * work_of_adhesion)) }
    }

    /// c of the zone with s/c = cos ψ, 0 < ψ ≤ π/2.
    pub fn edge(&self, angle: f64) -> f64 {
        let (sine, cosine) = sin_cos(angle);
        let square = (angle + sine * cosine - 2.0 * angle * cosine * cosine) / PI;
        let half = 2.0 * self.strength / PI * (angle * sine - sine * sine / (1.0 + cosine));
        let range = self.work_of_adhesion / self.strength;
        range / (half + (half * half + square * range).sqrt())
    }

    /// s, δ and P of that zone.
    pub fn state(&self, angle: f64) -> [f64; 3] {
        let (sine, cosine) = sin_cos(angle);
        let c = self.edge(angle);
        let (s, pull) = (c * cosine, 2.0 * self.strength * c * sine);
        let ring = 2.0 * self.strength * c * c * (angle - sine * cosine);
        [s, s * s - pull, 4.0 / 3.0 * s.powi(3) - 2.0 * s * pull - ring]
    }

    /// −P/πγR of the largest pull: 3/2 where the range is short, 2 where it is long.
    pub fn largest_pull(&self) -> f64 {
        let force = |angle: f64| self.state(angle)[2];
        let at = |k: u32| FRAC_PI_2 * f64::from(k) / f64::from(ANGLES);
        let least = (1..=ANGLES).min_by(|a, b| force(at(*a)).total_cmp(&force(at(*b)))).unwrap_or(ANGLES);
        let angle = root::least(at(least - 1).max(1e-6), at((least + 1).min(ANGLES)), force);
        -force(angle) / (PI * self.work_of_adhesion)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_pull_is_that_of_the_two_limits_and_of_the_table() {
        for (parameter, expected) in
            [(0.05, 1.98144), (0.1, 1.95059), (0.5, 1.71825), (1.0, 1.60073), (5.0, 1.50635), (20.0, 1.50041)]
        {
            for gamma in [1e-6, 1e-2] {
                let pull = Maugis::of(parameter, gamma).largest_pull();
                assert!((pull - expected).abs() < 6e-6, "{parameter}: {pull}");
            }
        }
    }
}
