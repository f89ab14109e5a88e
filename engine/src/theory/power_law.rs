//! The power law h = c rⁿ, n ≥ 1, the cone n = 1 included, in closed form.
//!
//! ```text
//! g  = c n aⁿ ∫₀^{π/2} sinⁿ⁻¹θ dθ = B aⁿ,   B = c n (√π/2) Γ(n/2)/Γ((n+1)/2)
//! g' = n g/a,   M₁ = n a g/(n + 1),   M₂ = 2n² s g²/((n + 1)(2n + 1))
//! ```
//!
//! by Wallis' integral. n = 2 is Hertz and JKR, n = 1 gives δ = πcs/2 and P = E*πcs²/2 without adhesion. I. N. Sneddon,
//! Int. J. Eng. Sci. 3, 47 (1965), doi:10.1016/0020-7225(65)90019-4.

use super::disc::{Disc, Transform};
use super::quadrature::Integral;
use crate::elementary::pow;
use crate::gap::shapes::PowerLaw;
use std::f64::consts::PI;

/// An adhesive axisymmetric body of a power-law shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerLawDisc {
    effective_modulus: f64,
    work_of_adhesion: f64,
    exponent: f64,
    /// B.
    transformed: f64,
}

impl PowerLawDisc {
    /// The body of the gap `gap`, with E* and γ.
    #[must_use]
    pub fn new(effective_modulus: f64, work_of_adhesion: f64, gap: &PowerLaw) -> Self {
        let n = gap.exponent;
        let wallis = 0.5 * PI.sqrt() * libm::tgamma(0.5 * n) / libm::tgamma(0.5 * (n + 1.0));
        let transformed = gap.factor * n * wallis;
        Self { effective_modulus, work_of_adhesion, exponent: n, transformed }
    }
}

impl Disc for PowerLawDisc {
    fn name(&self) -> &'static str {
        "Sneddon 1965"
    }

    fn material(&self) -> [f64; 2] {
        [self.effective_modulus, self.work_of_adhesion]
    }

    fn transform(&self, a: f64) -> Transform {
        let n = self.exponent;
        // aⁿ⁻¹, so that the cone keeps its slope on the axis.
        let lowered = self.transformed * pow(a, n - 1.0);
        let value = a * lowered;
        Transform { value, slope: n * lowered, moment: n / (n + 1.0) * a * value, resolved: true }
    }

    fn rise(&self, from: f64, to: f64) -> Integral<1> {
        let n = self.exponent;
        let square = |s: f64| s * self.transform(s).value.powi(2);
        let rise = 2.0 * n * n / ((n + 1.0) * (2.0 * n + 1.0)) * (square(to) - square(from));
        Integral { values: [rise], resolved: true }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::jkr::Jkr;

    #[test]
    fn the_paraboloid_is_jkr() {
        let law = PowerLawDisc::new(2.0, 0.01, &PowerLaw { factor: 1.0 / 6.0, exponent: 2.0 });
        let jkr = Jkr { effective_modulus: 2.0, work_of_adhesion: 0.01, radius_of_curvature: 3.0 };
        for s in [0.01, 0.2, 1.7] {
            let (a, b) = (law.curve(&[s])[0], jkr.curve(&[s])[0]);
            assert!((a.approach - b.approach).abs() <= 1e-15 * (s * s + law.edge(s)));
            assert!((a.force - b.force).abs() <= 1e-14 * b.force_scale);
            assert!((a.energy - b.energy).abs() <= 1e-14 * (b.energy.abs() + PI * 0.01 * s * s));
        }
    }

    #[test]
    fn the_cone_without_adhesion_is_sneddons() {
        let cone = PowerLawDisc::new(3.0, 0.0, &PowerLaw::cone(0.2));
        assert!((cone.approach(0.5) - 0.05 * PI).abs() < 1e-15);
        assert!((cone.force(0.5) - 3.0 * PI * 0.2 * 0.125).abs() < 1e-15);
        // The mean pressure under a cone is E*c/2, whatever the radius.
        assert!((cone.force(7.0) / (PI * 49.0) - 0.3).abs() < 1e-15);
    }
}
