//! Sums over the gap that give force and edge coefficient of a disc, with their derivatives.
//!
//! With h(0) = 0, integration by parts leaves the slope of the gap alone, r = s sin θ:
//!
//! ```text
//! g   = s ∫ h' dθ                     H  = ∫ h sin θ dθ = s ∫ h' cos²θ dθ         0 ≤ θ ≤ π/2
//! g'  = ∫ h' dθ + s ∫ h'' sin θ dθ    (sH)' = g
//! g'' = 2 ∫ h'' sin θ dθ + s ∫ h''' sin²θ dθ
//! ```
//!
//! so one slope a node gives a point (δ, P) of the curve, and two more derivatives its tangent and curvature. The sums are
//! Gauss's in θ, whose weights are positive and lose no digits. The integrands are symmetric about θ = π/2: of a
//! rule on (0, π) one half is enough, and its nodes crowd where the phase q sin θ of a wave runs fastest. Two nodes for each
//! wave inside the disc and a dozen more then reach rounding, so small discs take small rules. Where the gap is not smooth the
//! rule is broken (see [`breaks`](crate::contact::breaks)).

use crate::contact::Gap;
use crate::contact::breaks::{Angles, CUBIC_FREQUENCY};
use gauss_quad::GaussLegendre;
use std::borrow::Cow;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3};
use std::num::NonZeroUsize;
use wide::f64x4;

/// Nodes for each wave between the axis and the edge: q/3 for the phase q = 2πs/λ. Beyond [`MORE_NODES`], rounding
/// is reached with 0.38 q at q = 16, 0.32 q at 63 and 0.28 q at 800.
const NODES_PER_WAVE: f64 = 2.0 * FRAC_PI_3;

/// Nodes for a disc without waves: 8 bring a smooth gap to rounding, 14 leave room for the first waves.
const MORE_NODES: f64 = 14.0;

/// The smallest rule.
const FEWEST_NODES: usize = 16;

/// Factor from one rule to the next: no disc has more than a quarter too many nodes.
const GROWTH: f64 = 1.25;

/// Nodes sampled at once: their derivatives stay in the nearest cache.
const BLOCK: usize = 64;

/// The sums at one contact radius.
#[derive(Debug, Clone, Copy, Default)]
pub struct Moments {
    /// H, a length.
    pub mean: f64,
    /// g, g' and g''; g a length.
    pub edge: [f64; 3],
    /// The size of the terms of g: where they cancel, its rounding level.
    pub size: f64,
}

/// Gauss nodes in θ on (0, π/2), a multiple of four.
#[derive(Debug, Clone)]
struct Rule {
    /// sin θ.
    sines: Vec<f64>,
    /// The weights of ∫ dθ.
    weights: Vec<f64>,
}

impl Rule {
    fn new(nodes: usize) -> Self {
        let rule = GaussLegendre::new(NonZeroUsize::new(2 * nodes).unwrap_or(NonZeroUsize::MIN));
        let half = || rule.iter().take(nodes);
        Self {
            sines: half().map(|(x, _)| (FRAC_PI_2 * (1.0 + x)).sin()).collect(),
            weights: half().map(|(_, weight)| FRAC_PI_2 * weight).collect(),
        }
    }
}

impl From<Angles> for Rule {
    fn from(Angles { mut sines, mut weights, .. }: Angles) -> Self {
        // To a multiple of four with nodes that do not count.
        let last = sines.last().copied().unwrap_or(0.0);
        let size = sines.len().next_multiple_of(4);
        sines.resize(size, last);
        weights.resize(size, 0.0);
        Self { sines, weights }
    }
}

/// The rules from the smallest to the largest.
#[derive(Debug, Clone)]
pub struct EdgeRules(Vec<Rule>);

impl EdgeRules {
    /// Rules up to `most` nodes, at least the smallest.
    pub fn new(most: usize) -> Self {
        let sizes = std::iter::successors(Some(FEWEST_NODES), |&size| {
            // Positive and a few thousand at most.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let next = (GROWTH * size as f64) as usize;
            (size < most).then(|| next.min(most).next_multiple_of(4))
        });
        Self(sizes.map(Rule::new).collect())
    }

    /// The smallest rule that resolves the waves of `gap` in a disc of radius `s`; the largest where none does, or the
    /// gap promises nothing; one broken where the gap is not smooth.
    fn resolving(&self, gap: &dyn Gap, s: f64) -> Cow<'_, Rule> {
        let breaks = gap.breaks();
        if breaks.matter(s) {
            // The largest rule has a node for each unit of the phase between axis and edge, and some more.
            let most = self.0[self.0.len() - 1].weights.len() as f64;
            let frequency = if breaks.cubic { CUBIC_FREQUENCY } else { 2.0 * most };
            return Cow::Owned(Rule::from(Angles::new(breaks, s, frequency)));
        }
        let wanted = gap.band_limit().map_or(f64::INFINITY, |wave| MORE_NODES + NODES_PER_WAVE * s / wave);
        let at = self.0.partition_point(|rule| (rule.weights.len() as f64) < wanted);
        Cow::Borrowed(&self.0[at.min(self.0.len() - 1)])
    }

    /// sin θ at the nodes that [`EdgeRules::moments`] samples `gap` at on a disc of radius `s`.
    pub fn nodes(&self, gap: &dyn Gap, s: f64) -> Cow<'_, [f64]> {
        match self.resolving(gap, s) {
            Cow::Borrowed(rule) => Cow::Borrowed(&rule.sines),
            Cow::Owned(rule) => Cow::Owned(rule.sines),
        }
    }

    /// The sums over `gap` on a disc of radius `s`.
    pub fn moments(&self, gap: &dyn Gap, s: f64) -> Moments {
        let rule = self.resolving(gap, s);
        let [mut slope, mut across, mut second, mut third, mut size] = [f64x4::ZERO; 5];
        let mut derivatives = [[0.0; BLOCK]; 3];
        for (sines, weights) in rule.sines.chunks(BLOCK).zip(rule.weights.chunks(BLOCK)) {
            let mut slices = derivatives.each_mut().map(|values| &mut values[..sines.len()]);
            gap.derivatives(s, sines, slices.each_mut().map(|slice| &mut **slice));
            let [h1, h2, h3] = slices.map(|slice| slice.as_chunks::<4>().0);
            let nodes = sines.as_chunks::<4>().0.iter().zip(weights.as_chunks::<4>().0);
            for ((((sin, weight), h1), h2), h3) in nodes.zip(h1).zip(h2).zip(h3) {
                let [sin, weight, h1, h2, h3] = [sin, weight, h1, h2, h3].map(|four| f64x4::new(*four));
                let (dh, once) = (weight * h1, weight * sin);
                slope += dh;
                size += dh.abs();
                across += dh * (f64x4::ONE - sin * sin);
                second += once * h2;
                third += once * sin * h3;
            }
        }
        let [slope, across, second, third, size] =
            [slope, across, second, third, size].map(f64x4::reduce_add);
        Moments {
            mean: s * across,
            edge: [s * slope, slope + s * second, 2.0 * second + s * third],
            size: s * size,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Shape;
    use crate::theory::disc::Disc;
    use crate::theory::guduru::Guduru;

    #[test]
    fn rules_for_the_waves_inside_reach_rounding() {
        let rules = EdgeRules::new(4112);
        for wavelength in [0.7, 0.05, 0.002, 0.0006] {
            let amplitude = 0.05 * wavelength;
            let gap = Shape::WavySphere { radius_of_curvature: 1.0, amplitude, wavelength };
            let exact = Guduru {
                effective_modulus: 1.0,
                work_of_adhesion: 0.0,
                radius_of_curvature: 1.0,
                amplitude,
                wavelength,
            };
            for i in 1..=60 {
                let s = 0.01 * f64::from(i);
                let ours = rules.moments(&gap, s);
                let exact = exact.transform(s);
                // The phase of so many waves has lost as many bits of its argument.
                let bound = 1e-14 * (1.0 + s / wavelength);
                assert!((ours.edge[0] - exact.value).abs() <= bound * ours.size, "λ={wavelength} s={s}");
                // M₁ = ∫ a g' da = s g − ∫ g da.
                let moment = s * (ours.edge[0] - ours.mean);
                assert!((moment - exact.moment).abs() <= bound * s * ours.size, "λ={wavelength} s={s}");
                let slope = bound * (ours.size / s + (s / wavelength).sqrt());
                let off = (ours.edge[1] - exact.slope).abs();
                assert!(off <= slope, "λ={wavelength} s={s}: slope off by {off:e}");
            }
        }
    }

    #[test]
    fn rules_grow_to_the_largest() {
        for most in [20, 64, 4112] {
            let sizes: Vec<usize> = EdgeRules::new(most).0.iter().map(|rule| rule.weights.len()).collect();
            assert!(sizes.windows(2).all(|pair| pair[0] < pair[1]), "{sizes:?}");
            assert!(sizes.iter().all(|size| size % 4 == 0), "{sizes:?}");
            assert_eq!(sizes.last(), Some(&most));
        }
    }
}
