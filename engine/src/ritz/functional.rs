//! The functional (16) with the pressure eliminated.
//!
//! For a fixed disc the pressure is linear in the data, p = −(1/s) B̃⁻¹W̃ (h − δ). With K = W̃ᵀB̃⁻¹W̃,
//! `w_j = h(s r̃_j) − δ` and, at the nodes, h1 = r̃h', h2 = r̃²h'', h3 = r̃³h''' (E* = 1):
//!
//! ```text
//! Φ   = −½ s wᵀKw + πγs²,          U = −Φ,          P = −∂Φ/∂δ = −s 1ᵀKw
//! F   = ∂Φ/∂s = −½ wᵀKw − s h1ᵀKw + 2πγs                     (second line of (19))
//! G   = (½ wᵀKw + s h1ᵀKw)/(2πs)                             (energy release rate; F = 0 ⇔ G = γ)
//! ```
//!
//! The residual that Newton and the continuation on rings drive to zero is ρ = √(G/γ) − 1 for γ > 0, which is nearly
//! linear in s and converges in a handful of rounds from a threefold radius. At γ = 0, where the root form is
//! degenerate, it is F.

use crate::disc::Evaluation;
use std::f64::consts::PI;

/// The bilinear forms uᵀKv of the sampled gap at one contact radius.
///
/// Indices: `c` the constant 1, `h` the gap, `1`, `2`, `3` the vectors h1, h2, h3 of the module header.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Forms {
    /// 1ᵀK1.
    pub cc: f64,
    /// 1ᵀKh.
    pub ch: f64,
    /// 1ᵀKh1.
    pub c1: f64,
    /// 1ᵀKh2.
    pub c2: f64,
    /// 1ᵀKh3.
    pub c3: f64,
    /// hᵀKh.
    pub hh: f64,
    /// hᵀKh1.
    pub h1: f64,
    /// hᵀKh2.
    pub h2: f64,
    /// hᵀKh3.
    pub h3: f64,
    /// h1ᵀKh1.
    pub f11: f64,
    /// h1ᵀKh2.
    pub f12: f64,
}

/// Rounding of the forms, relative to their size, with a margin for sums over some thousand nodes.
const FORM_ROUNDING: f64 = 1e-4;

impl Forms {
    /// The smaller root δ of F = 0 at radius `s`: tension at the edge.
    pub fn equilibrium_approach(&self, s: f64, gamma: f64) -> Option<f64> {
        // ½cc δ² − b δ + c = 0.
        let b = self.ch + s * self.c1;
        let c = 0.5 * self.hh + s * self.h1 - 2.0 * PI * s * gamma;
        let discriminant = b * b - 2.0 * self.cc * c;
        if !(discriminant >= 0.0 && self.cc > 0.0) {
            return None;
        }
        let root = discriminant.sqrt();
        // The form without cancellation, whichever the sign of b.
        Some(if b > 0.0 && root > 0.0 { 2.0 * c / (b + root) } else { (b - root) / self.cc })
    }

    /// wᵀKw.
    fn ww(&self, delta: f64) -> f64 {
        self.hh - 2.0 * delta * self.ch + delta * delta * self.cc
    }

    /// Residual and force with their derivatives at (s, δ), for the work of adhesion `gamma`.
    pub fn evaluate(&self, s: f64, delta: f64, gamma: f64) -> Evaluation {
        let ww = self.ww(delta);
        let cw = self.ch - delta * self.cc;
        let w1 = self.h1 - delta * self.c1;
        let w2 = self.h2 - delta * self.c2;
        let w3 = self.h3 - delta * self.c3;

        // 2πsG and its derivatives; F = 2πγs − release.
        let release = 0.5 * ww + s * w1;
        let release_d = -cw - s * self.c1;
        let release_s = 2.0 * w1 + s * w2 + s * self.f11;
        let release_dd = self.cc;
        let release_ds = -2.0 * self.c1 - s * self.c2;
        let release_ss = 3.0 * w2 + 3.0 * self.f11 + 3.0 * s * self.f12 + s * w3;

        let perimeter = 2.0 * PI * s;
        let size =
            0.5 * self.hh.abs() + 0.5 * delta * delta * self.cc + s * (self.h1 - delta * self.c1).abs();
        let (residual, residual_scale, residual_gradient, residual_second) = if gamma > 0.0 {
            let g = release / perimeter;
            let g_d = release_d / perimeter;
            let g_dd = release_dd / perimeter;
            let g_s = (release_s - release / s) / perimeter;
            let g_ds = (release_ds - release_d / s) / perimeter;
            let g_ss = (release_ss - 2.0 * release_s / s + 2.0 * release / (s * s)) / perimeter;
            let root = (g * gamma).sqrt();
            let first = 0.5 / root;
            let second = 0.25 / (root * g);
            (
                (g / gamma).sqrt() - 1.0,
                (FORM_ROUNDING * size / (perimeter * gamma)).max(1.0),
                [first * g_d, first * g_s],
                [
                    first * g_dd - second * g_d * g_d,
                    first * g_ds - second * g_d * g_s,
                    first * g_ss - second * g_s * g_s,
                ],
            )
        } else {
            (-release, size, [-release_d, -release_s], [-release_dd, -release_ds, -release_ss])
        };

        Evaluation {
            contact_radius: s,
            approach: delta,
            residual,
            residual_scale,
            residual_gradient,
            residual_second,
            force: -s * cw,
            force_scale: s * (self.ch.abs() + (delta * self.cc).abs()),
            force_gradient: [s * self.cc, -cw - s * self.c1],
            force_second: [0.0, self.cc, -2.0 * self.c1 - s * self.c2],
            energy: 0.5 * s * ww - PI * gamma * s * s,
        }
    }
}
