//! Chebyshev points on a ring, and sums at them that depend on their number alone.
//!
//! ```text
//! r = c − d cos t,   t_k = (k + ½)π/n,   k = 0 … n−1                                      outward
//! ∫ ln|cos t − cos t'| f(t') dt' = −(π/n) Σ_k [ln 2 + C(i−k) + C(i+k+1)] f(t_k),  C(j) = Σ_{m=1}^{n−1} cos(mjπ/n)/m
//! f(t = 0) = (1/n) Σ (−1)^k cot(t_k/2) f(t_k),       f(t = π) = (1/n) Σ (−1)^{n−1−k} tan(t_k/2) f(t_k)
//! ```
//!
//! all exact for cosine series up to degree n − 1.

use crate::elementary::{cos, sin, tan};
use std::f64::consts::PI;
use std::sync::OnceLock;

/// The most points on one ring.
pub const MOST_POINTS: usize = 400;

/// Numbers of points are multiples of this.
pub const STEP: usize = 4;

/// The rule for n points.
#[derive(Debug)]
pub struct RingRule {
    /// cos²(t/2) and sin²(t/2): (b − r)/2d and (r − a)/2d.
    pub halves: [Vec<f64>; 2],
    /// t.
    pub angles: Vec<f64>,
    /// sin(jπ/2n), j = 0 … 2n.
    pub sines: Vec<f64>,
    /// 2 C(j) + ln 2, j = 0 … 2n.
    pub log_sums: Vec<f64>,
    /// Weights that turn the sums' terms (π/n) f into the values at t = 0 and t = π.
    pub ends: [Vec<f64>; 2],
}

impl RingRule {
    /// The rule of `n` points, rounded up to a multiple of [`STEP`], [`MOST_POINTS`] at most; made once.
    pub fn of(n: usize) -> &'static Self {
        static RULES: [OnceLock<RingRule>; MOST_POINTS / STEP + 1] =
            [const { OnceLock::new() }; MOST_POINTS / STEP + 1];
        let steps = n.div_ceil(STEP).clamp(1, MOST_POINTS / STEP);
        RULES[steps].get_or_init(|| Self::new(STEP * steps))
    }

    fn new(n: usize) -> Self {
        let size = n as f64;
        let angles: Vec<f64> = (0..n).map(|k| PI * (k as f64 + 0.5) / size).collect();
        let outward: Vec<f64> = angles.iter().map(|t| sin(0.5 * t).powi(2)).collect();
        let inward: Vec<f64> = angles.iter().map(|t| cos(0.5 * t).powi(2)).collect();
        // By symmetry about j = n, so that the ends are exact.
        let sines: Vec<f64> = (0..=2 * n).map(|j| sin(PI * j.min(2 * n - j) as f64 / (2.0 * size))).collect();
        let cosines: Vec<f64> = (0..2 * n).map(|j| cos(PI * j as f64 / size)).collect();
        let sum = |j: usize| -> f64 { (1..n).map(|m| cosines[(m * j) % (2 * n)] / m as f64).sum() };
        let log_sums = (0..=2 * n).map(|j| 2.0 * sum(j) + std::f64::consts::LN_2).collect();
        let alternating = |k: usize| if k.is_multiple_of(2) { 1.0 / PI } else { -1.0 / PI };
        let inner = angles.iter().enumerate().map(|(k, t)| alternating(k) / tan(0.5 * t)).collect();
        let outer = angles.iter().enumerate().map(|(k, t)| alternating(n - 1 - k) * tan(0.5 * t)).collect();
        Self { halves: [inward, outward], angles, sines, log_sums, ends: [inner, outer] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_exact_for_cosines() {
        let rule = RingRule::of(15);
        let n = rule.angles.len();
        assert_eq!(n, 16);
        for degree in 0..n {
            let f = |t: f64| (degree as f64 * t).cos();
            for i in [0_usize, 3, 11] {
                // ∫₀^π ln|cos t − cos t'| cos(mt') dt' = −(π/m) cos(mt), −π ln 2 for m = 0.
                let sum: f64 = (0..n)
                    .map(|k| {
                        0.5 * (rule.log_sums[i.abs_diff(k)] + rule.log_sums[i + k + 1]) * f(rule.angles[k])
                    })
                    .sum();
                let m = degree as f64;
                let exact = if degree == 0 { std::f64::consts::LN_2 } else { f(rule.angles[i]) / m };
                assert!((sum / n as f64 - exact).abs() < 1e-14, "{degree} {i}");
            }
            for (end, t) in rule.ends.iter().zip([0.0, PI]) {
                let sum: f64 = (0..n).map(|k| end[k] * PI / n as f64 * f(rule.angles[k])).sum();
                assert!((sum - f(t)).abs() < 1e-13, "{degree}");
            }
        }
    }
}
