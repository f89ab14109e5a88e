//! The weight `W_k` of a loading device in the law of stability.
//!
//! ```text
//! W_k = √s (1 + x)/(1 + 3x),    x = 2s/k        (x = 0 for displacement, x → ∞ for force)
//! L = W'/W = m/s,    m = ½ − u,    u = 2x/((1 + x)(1 + 3x))
//! L' = −(m + x du/dx)/s²,    x du/dx = u (1 − 3x²)/((1 + x)(1 + 3x))
//! ```

use crate::problem::Control;

/// `W_k` and its logarithmic derivatives at one radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weight {
    /// `W_k`.
    pub value: f64,
    /// L = W'/W.
    pub slope: f64,
    /// L'.
    pub bend: f64,
}

impl Weight {
    /// The weight of `control` at the contact radius `s`, reduced.
    pub fn of(control: Control, s: f64) -> Self {
        let root = s.sqrt();
        // The share (1 + x)/(1 + 3x), u, and x du/dx.
        let [share, u, du] = match control {
            Control::Displacement => [1.0, 0.0, 0.0],
            Control::Force => [1.0 / 3.0, 0.0, 0.0],
            Control::Stiffness(k) => {
                // Both x and 1/x are used, each where it does not overflow.
                let (x, y) = (2.0 * s / k, k / (2.0 * s));
                let u = 2.0 / ((1.0 + x) * (y + 3.0));
                let bend = if x < 1.0 {
                    (1.0 - 3.0 * x * x) / ((1.0 + x) * (1.0 + 3.0 * x))
                } else {
                    (y * y - 3.0) / ((y + 1.0) * (y + 3.0))
                };
                [(k + 2.0 * s) / (k + 6.0 * s), u, u * bend]
            }
        };
        let m = 0.5 - u;
        Self { value: root * share, slope: m / s, bend: -(m + du) / (s * s) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_differences_and_the_ends_are_grips_and_dead_load() {
        for control in
            [Control::Displacement, Control::Force, Control::Stiffness(0.15), Control::Stiffness(3.0)]
        {
            for s in [0.01, 0.2, 1.7] {
                let h = 1e-4 * s;
                let [lo, here, hi] = [s - h, s, s + h].map(|s| Weight::of(control, s));
                let slope = (hi.value - lo.value) / (2.0 * h) / here.value;
                let bend = (hi.slope - lo.slope) / (2.0 * h);
                assert!((here.slope - slope).abs() < 1e-7 * slope.abs(), "{control} {s}");
                assert!((here.bend - bend).abs() < 1e-6 * bend.abs(), "{control} {s}");
            }
        }
        for (k, end) in [(1e300, Control::Displacement), (1e-300, Control::Force)] {
            let (soft, end) = (Weight::of(Control::Stiffness(k), 0.3), Weight::of(end, 0.3));
            for (a, b) in [(soft.value, end.value), (soft.slope, end.slope), (soft.bend, end.bend)] {
                assert!((a - b).abs() <= 1e-15 * b.abs(), "{k}: {a} {b}");
            }
        }
    }
}
