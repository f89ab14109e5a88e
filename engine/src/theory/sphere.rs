//! The sphere itself, h = R − √(R² − r²), in closed form.
//!
//! With x = a/R, and M₁ from its definition by parts,
//!
//! ```text
//! g  = a artanh x = (a/2) ln((R + a)/(R − a))
//! g' = artanh x + x/(1 − x²)
//! M₁ = ½ [(R² + a²) artanh x − aR] = R² Σ 2k x²ᵏ⁺¹/(4k² − 1),   k ≥ 1
//! ```
//!
//! The sum serves for small x, where the bracket cancels. I. N. Sneddon, Int. J. Eng. Sci. 3, 47 (1965),
//! doi:10.1016/0020-7225(65)90019-4; with adhesion D. Maugis, Langmuir 11, 679 (1995).

use super::disc::{Disc, Transform};
use crate::elementary::atanh;

/// Where the sum gives way to the closed form: below, 26 terms suffice; above, one digit is lost.
const SUM_BELOW: f64 = 0.4;

/// Terms of the sum: 0.4⁵⁰ is below 1e-19.
const TERMS: u8 = 26;

/// An adhesive sphere. Radii of contact below R.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// E*.
    pub effective_modulus: f64,
    /// γ.
    pub work_of_adhesion: f64,
    /// R.
    pub radius: f64,
}

impl Disc for Sphere {
    fn name(&self) -> &'static str {
        if self.work_of_adhesion > 0.0 { "Maugis 1995" } else { "Sneddon 1965" }
    }

    fn material(&self) -> [f64; 2] {
        [self.effective_modulus, self.work_of_adhesion]
    }

    /// NaN from a = R on.
    fn transform(&self, a: f64) -> Transform {
        let radius = self.radius;
        let x = a / radius;
        if x >= 1.0 {
            return Transform { value: f64::NAN, slope: f64::NAN, moment: f64::NAN, resolved: true };
        }
        let artanh = atanh(x);
        let moment = if x < SUM_BELOW {
            let square = x * x;
            // Horner, from the smallest term.
            let sum = (1..=TERMS)
                .rev()
                .map(f64::from)
                .fold(0.0, |sum, k| square * (2.0 * k / (4.0 * k * k - 1.0) + sum));
            radius * radius * x * sum
        } else {
            0.5 * ((radius * radius + a * a) * artanh - a * radius)
        };
        Transform { value: a * artanh, slope: artanh + x / ((1.0 - x) * (1.0 + x)), moment, resolved: true }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_and_the_closed_form_meet() {
        let sphere = Sphere { effective_modulus: 1.0, work_of_adhesion: 0.0, radius: 2.5 };
        let moment = |x: f64| sphere.transform(2.5 * x).moment;
        let (below, above) = (moment(SUM_BELOW * (1.0 - 1e-15)), moment(SUM_BELOW));
        assert!((below / above - 1.0).abs() < 2e-14, "{below} {above}");
        // The paraboloid's 2a³/(3R).
        assert!((moment(1e-6) / (2.0 / 3.0 * 6.25e-18) - 1.0).abs() < 1e-11);
        assert!(sphere.transform(2.5).value.is_nan());
    }
}
