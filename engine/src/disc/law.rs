//! The transform of h = c rⁿ in closed form: it spans more digits than a series has.
//!
//! ```text
//! g = κ aⁿ,    κ = c n (√π/2) Γ(n/2)/Γ((n + 1)/2)        (a paraboloid: a²/R; a cone of slope c: πca/2)
//! ∫g = κ aⁿ⁺¹/(n + 1),    ∫g² = κ² a²ⁿ⁺¹/(2n + 1)
//! ```

use crate::elementary::pow;
use crate::gap::{panels::Span, panels::Variable};
use std::f64::consts::PI;

/// g varies by at most this factor on a panel, so that it has relative digits all over the panel.
const VARIATION: f64 = 1e3;

/// The outer end of a panel is at most this many times as far out as its inner end.
const RATIO: f64 = 4.0;

/// g = κ aⁿ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerTransform {
    factor: f64,
    exponent: f64,
}

impl PowerTransform {
    /// The transform of h = c rⁿ, 1 ≤ n ≤ 100.
    pub fn new(c: f64, n: f64) -> Self {
        // The two well-known ones, without the rounding of a logarithm.
        let shape = if n <= 1.0 {
            0.5 * PI
        } else if (n - 2.0).abs() < f64::EPSILON {
            2.0
        } else {
            0.5 * n * PI.sqrt() * libm::tgamma(0.5 * n) / libm::tgamma(0.5 * (n + 1.0))
        };
        Self { factor: c * shape, exponent: n }
    }

    /// aᵐ.
    fn power(a: f64, m: f64) -> f64 {
        // Whole powers by multiplication: exact where the product is.
        #[expect(clippy::cast_possible_truncation, reason = "whole and at most some hundred")]
        if m.fract() == 0.0 { a.powi(m as i32) } else { pow(a, m) }
    }

    /// g.
    pub fn value(&self, a: f64) -> f64 {
        self.factor * Self::power(a, self.exponent)
    }

    /// g'.
    pub fn slope(&self, a: f64) -> f64 {
        self.factor * self.exponent * Self::power(a, self.exponent - 1.0)
    }

    /// g''.
    pub fn bend(&self, a: f64) -> f64 {
        let n = self.exponent;
        if n <= 1.0 { 0.0 } else { self.factor * n * (n - 1.0) * Self::power(a, n - 2.0) }
    }

    /// g'''.
    pub fn third(&self, a: f64) -> f64 {
        let n = self.exponent;
        let vanishes = n <= 1.0 || (n - 2.0).abs() < f64::EPSILON;
        if vanishes { 0.0 } else { self.factor * n * (n - 1.0) * (n - 2.0) * Self::power(a, n - 3.0) }
    }

    /// ∫g.
    pub fn area(&self, a: f64) -> f64 {
        self.value(a) * a / (self.exponent + 1.0)
    }

    /// ∫g².
    pub fn square(&self, a: f64) -> f64 {
        let value = self.value(a);
        value * value * a / (2.0 * self.exponent + 1.0)
    }

    /// Panels from the axis to `to`; the first ends at `smallest` or below.
    pub fn spans(exponent: f64, to: f64, smallest: f64) -> Vec<Span> {
        let ratio = pow(VARIATION, exponent.recip()).min(RATIO);
        let mut borders = vec![to];
        while let Some(hi) = borders.last().copied().filter(|hi| *hi > smallest && hi.is_normal()) {
            borders.push(hi / ratio);
        }
        borders.push(0.0);
        borders.reverse();
        let span = |ends: &[f64]| Span { lo: ends[0], hi: ends[1], variable: Variable::Radius };
        borders.windows(2).map(span).collect()
    }
}
