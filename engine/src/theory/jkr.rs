//! Johnson, Kendall and Roberts: a smooth sphere with adhesion.
//!
//! With γ the work of adhesion, as in the functional (2),
//!
//! ```text
//! δ = s²/R − √(2πγs/E*),   P = 4E*s³/(3R) − √(8πγE*s³),   P_c = (3/2)πγR,   s_c = (9πγR²/(8E*))^{1/3}
//! ```
//!
//! The paper's (22) prints the force with the surface energy of one face and a plus sign; the forms above are correct.
//! Proc. R. Soc. A 324, 301 (1971), doi:10.1098/rspa.1971.0141.

use super::disc::{Disc, Transform};
use super::quadrature::Integral;
use crate::elementary::cbrt;
use std::f64::consts::PI;

/// A smooth adhesive sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jkr {
    /// E*.
    pub effective_modulus: f64,
    /// γ.
    pub work_of_adhesion: f64,
    /// R.
    pub radius_of_curvature: f64,
}

impl Jkr {
    /// δ(s).
    pub fn approach(&self, s: f64) -> f64 {
        s * s / self.radius_of_curvature
            - (2.0 * PI * self.work_of_adhesion * s / self.effective_modulus).sqrt()
    }

    /// P(s).
    pub fn force(&self, s: f64) -> f64 {
        let e = self.effective_modulus;
        4.0 * e * s.powi(3) / (3.0 * self.radius_of_curvature)
            - (8.0 * PI * self.work_of_adhesion * e * s.powi(3)).sqrt()
    }

    /// The pull-off force `P_c` under a dead load, positive.
    pub fn pull_off_force(&self) -> f64 {
        1.5 * PI * self.work_of_adhesion * self.radius_of_curvature
    }

    /// The contact radius `s_c` at pull-off under a dead load.
    pub fn pull_off_radius(&self) -> f64 {
        cbrt(
            9.0 * PI * self.work_of_adhesion * self.radius_of_curvature.powi(2)
                / (8.0 * self.effective_modulus),
        )
    }

    /// The contact radius `s_c/3^{2/3`} at pull-off under fixed grips, where `P = −5P_c/9`.
    pub fn fixed_grips_radius(&self) -> f64 {
        self.pull_off_radius() / cbrt(9f64)
    }
}

/// g = s²/R. At γ = 0 this is Hertz.
impl Disc for Jkr {
    fn name(&self) -> &'static str {
        if self.work_of_adhesion > 0.0 { "JKR 1971" } else { "Hertz 1881" }
    }

    fn material(&self) -> [f64; 2] {
        [self.effective_modulus, self.work_of_adhesion]
    }

    fn transform(&self, a: f64) -> Transform {
        let radius = self.radius_of_curvature;
        Transform {
            value: a * a / radius,
            slope: 2.0 * a / radius,
            moment: 2.0 * a.powi(3) / (3.0 * radius),
            resolved: true,
        }
    }

    /// M₂ = 8s⁵/(15R²).
    fn rise(&self, from: f64, to: f64) -> Integral<1> {
        let rise = 8.0 / 15.0 * (to.powi(5) - from.powi(5)) / self.radius_of_curvature.powi(2);
        Integral { values: [rise], resolved: true }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extreme_values_of_the_closed_form() {
        let jkr = Jkr { effective_modulus: 2.0, work_of_adhesion: 0.01, radius_of_curvature: 3.0 };
        assert!((jkr.force(jkr.pull_off_radius()) / jkr.pull_off_force() + 1.0).abs() < 1e-12);
        let grips = jkr.fixed_grips_radius();
        assert!((jkr.force(grips) / jkr.pull_off_force() + 5.0 / 9.0).abs() < 1e-12);
        let e = 1e-6;
        assert!((jkr.approach(grips * (1.0 + e)) - jkr.approach(grips * (1.0 - e))).abs() < 1e-12);
    }

    #[test]
    fn figure_8_reference_value() {
        // Smallest approach at γ' = 2πγ/(E*R) = 0.05.
        let jkr =
            Jkr { effective_modulus: 1.0, work_of_adhesion: 0.05 / (2.0 * PI), radius_of_curvature: 1.0 };
        assert!((jkr.approach(jkr.fixed_grips_radius()) + 0.064_124).abs() < 1e-6);
    }
}
