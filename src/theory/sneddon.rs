//! Any gap with a connected contact disc: its Abel transform by quadrature.
//!
//! With r = a sin θ, and M₁ after one exchange of the integrals,
//!
//! ```text
//! g  = a ∫₀^{π/2} h'(r) dθ,   g' = ∫₀^{π/2} [h'(r) + r h''(r)] dθ,   M₁ = a² ∫₀^{π/2} h'(r) sin²θ dθ
//! ```
//!
//! so that δ, P and their slopes cost one pass over the gap. I. N. Sneddon, Int. J. Eng. Sci. 3, 47 (1965),
//! doi:10.1016/0020-7225(65)90019-4.

use super::disc::{Disc, Transform};
use super::quadrature::{Integral, integrate};
use crate::contact::Gap;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// A connected disc on any gap.
#[derive(Debug, Clone)]
pub struct Sneddon {
    /// E*.
    pub effective_modulus: f64,
    /// γ.
    pub work_of_adhesion: f64,
    /// h(r).
    pub gap: Arc<dyn Gap>,
}

impl Disc for Sneddon {
    fn name(&self) -> &'static str {
        "Sneddon 1965"
    }

    fn effective_modulus(&self) -> f64 {
        self.effective_modulus
    }

    fn work_of_adhesion(&self) -> f64 {
        self.work_of_adhesion
    }

    fn wave(&self) -> Option<f64> {
        self.gap.feature_length()
    }

    fn transform(&self, a: f64) -> Transform {
        // Near θ = 0 a wave spans λ/a of θ.
        let wave = self.wave().map(|wave| wave / a);
        let Integral { values: [value, slope, moment], resolved } =
            integrate(0.0, FRAC_PI_2, wave, |theta| {
                let sin = theta.sin();
                let r = a * sin;
                let h = self.gap.jet(r);
                [h.first, h.first + r * h.second, h.first * sin * sin]
            });
        Transform { value: a * value, slope, moment: a * a * moment, resolved }
    }
}
