//! Any gap with a connected contact disc: its Abel transform by quadrature.
//!
//! With r = a sin θ, and with M₁ after one exchange of the integrals,
//!
//! ```text
//! g  = a ∫₀^{π/2} h'(r) dθ,   g' = ∫₀^{π/2} [h'(r) + r h''(r)] dθ,   M₁ = a² ∫₀^{π/2} h'(r) sin²θ dθ
//! ```
//!
//! so that δ, P and their slopes cost one pass over the gap, in pieces between its knots. There a measured profile is a
//! cubic, a polynomial in sin θ, for which a rule of known size is exact to rounding. I. N. Sneddon, Int. J. Eng. Sci.
//! 3, 47 (1965), doi:10.1016/0020-7225(65)90019-4.

use super::disc::{self, Disc, Transform};
use super::quadrature::{Integral, STRETCH, integrate};
use crate::elementary::{asin, sin};
use crate::gap::Gap;
use crate::gap::{breaks::Angles, breaks::Breaks, breaks::CUBIC_FREQUENCY, breaks::SmoothStretch};
use std::f64::consts::{FRAC_PI_2, PI};
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

    fn material(&self) -> [f64; 2] {
        [self.effective_modulus, self.work_of_adhesion]
    }

    fn wave(&self) -> Option<f64> {
        self.gap.feature_length()
    }

    fn breaks(&self) -> Breaks<'_> {
        self.gap.breaks()
    }

    fn pressure(&self, s: f64, r: f64) -> f64 {
        self.pressures(s, &[r])[0]
    }

    fn pressures(&self, s: f64, radii: &[f64]) -> Vec<f64> {
        let table = self.breaks().cubic.then(|| SlopeTable::new(self, s));
        let pressure = |&r: &f64| {
            let depth = ((s - r) * (s + r)).sqrt();
            let pressed = table.as_ref().map_or_else(|| disc::pressed(self, s, r), |table| table.pressed(r));
            self.effective_modulus / PI * (pressed - self.edge(s) / depth)
        };
        radii.iter().map(pressure).collect()
    }

    fn transform(&self, a: f64) -> Transform {
        let Integral { values: [value, slope, moment], resolved } =
            if self.breaks().cubic { self.cubic_sums(a) } else { self.sums(a) };
        Transform { value: a * value, slope, moment: a * a * moment, resolved }
    }
}

impl Sneddon {
    /// ∫h', ∫(h' + rh'') and ∫h' sin²θ over θ.
    fn sums(&self, a: f64) -> Integral<3> {
        // Near θ = 0 a wave spans λ/a in θ.
        let wave = self.wave().map(|wave| wave / a);
        let mut sums = Integral { values: [0.0; 3], resolved: true };
        let mut from = 0.0;
        let knots = self.breaks().between(0.0, a).iter().map(|knot| asin(knot / a));
        for to in knots.chain([FRAC_PI_2]) {
            sums += integrate(from, to, wave, |theta| {
                let sin = sin(theta);
                let r = a * sin;
                let h = self.gap.jet(r);
                [h.first, h.first + r * h.second, h.first * sin * sin]
            });
            from = to;
        }
        sums.values[1] += self.jumps(a);
        sums
    }

    /// The contribution to g' of the jumps J of h' at knots q < a: Σ J q/√(a² − q²).
    fn jumps(&self, a: f64) -> f64 {
        let knots = self.breaks().between(0.0, a).iter();
        knots
            .map(|&q| {
                let [outer, inner] =
                    [1.0, -1.0].map(|side| self.gap.jet(q * (1.0 + 4.0 * side * f64::EPSILON)).first);
                // For a slope that does not jump, the difference is rounding.
                let jump = if (outer - inner).abs() > 1e-10 * (outer.abs() + inner.abs()) {
                    outer - inner
                } else {
                    0.0
                };
                if jump == 0.0 { 0.0 } else { jump * q / ((a - q) * (a + q)).sqrt() }
            })
            .sum()
    }

    /// The same sums for a gap that is a cubic between its knots.
    fn cubic_sums(&self, a: f64) -> Integral<3> {
        let Angles { sines, weights, .. } = Angles::new(self.breaks(), a, CUBIC_FREQUENCY);
        let [mut first, mut second, mut third] = [(); 3].map(|()| vec![0.0; sines.len()]);
        self.gap.derivatives(a, &sines, [&mut first, &mut second, &mut third]);
        let mut values = [0.0; 3];
        for (((sin, weight), first), second) in sines.iter().zip(&weights).zip(&first).zip(&second) {
            values[0] += weight * first;
            values[1] += weight * (first + a * sin * second);
            values[2] += weight * first * sin * sin;
        }
        Integral { values, resolved: values.iter().all(|value| value.is_finite()) }
    }
}

/// g' of a gap with many knots, at Gauss nodes between them; shared by the pressures at many radii.
struct SlopeTable<'a> {
    disc: &'a Sneddon,
    /// Each stretch with its nodes a and the weights of ∫ g' da there.
    stretches: Vec<(SmoothStretch, Vec<(f64, f64)>)>,
}

impl<'a> SlopeTable<'a> {
    fn new(disc: &'a Sneddon, s: f64) -> Self {
        let nodes = |stretch: SmoothStretch| {
            let SmoothStretch { from, to, base } = stretch;
            let nodes = STRETCH.iter().map(|(x, weight)| {
                let (half, middle) = (0.5 * (to - base).sqrt(), 0.5 * (from - base).sqrt());
                // In √(a − base), in which g' is smooth.
                let root = (middle + half) + (half - middle) * x;
                let a = base + root * root;
                (a, 2.0 * root * (half - middle) * weight * disc.transform(a).slope)
            });
            (stretch, nodes.collect())
        };
        Self { disc, stretches: disc.breaks().stretches(0.0, s).map(nodes).collect() }
    }

    /// ∫_r^s g'(a)/√(a² − r²) da.
    fn pressed(&self, r: f64) -> f64 {
        let first = self.stretches.partition_point(|(stretch, _)| stretch.to <= r);
        let part = |(stretch, nodes): &(SmoothStretch, Vec<(f64, f64)>)| -> f64 {
            let &SmoothStretch { from, to, .. } = stretch;
            if from - r >= to - from {
                return nodes.iter().map(|(a, weight)| weight / ((a - r) * (a + r)).sqrt()).sum();
            }
            // This near to the singularity it gets nodes of its own, in √(a − r).
            let (near, far) = ((from - r).max(0.0).sqrt(), (to - r).sqrt());
            let (middle, half) = (0.5 * (far + near), 0.5 * (far - near));
            STRETCH
                .iter()
                .map(|(x, weight)| {
                    let a = r + (middle + half * x).powi(2);
                    2.0 * half * weight * self.disc.transform(a).slope / (a + r).sqrt()
                })
                .sum()
        };
        self.stretches[first..].iter().map(part).sum()
    }
}
