//! Where a gap is not smooth, and Gauss's rule split at those radii.
//!
//! Every sum over a disc of radius s is an integral in θ, r = s sin θ, 0 ≤ θ ≤ π/2. Between the knots of a gap its
//! integrand is smooth, so a separate rule for each piece reaches rounding. One rule across all of them would converge
//! only as a power of the number of nodes. A piece of width w, whose integrand has frequencies up to f in θ, has the
//! half phase z = fw/2 and takes
//!
//! ```text
//! n = z/2 + 5 z^{1/3} + 2      from  π (z/2)²ⁿ/(2n)! ≲ 1e-15,  the error of Gauss's rule for cos(zx) on (−1, 1)
//! ```
//!
//! nodes. Where h behaves like a broken power of r near the axis, the first piece is taken in u, θ ∝ u⁵, which makes
//! the integrand smooth enough. Each later piece is as wide as its distance from the axis.

use crate::elementary::{asin, cbrt, pow, sin, sin_cos};
use gauss_quad::GaussLegendre;
use std::f64::consts::FRAC_PI_2;
use std::num::NonZeroUsize;
use std::sync::LazyLock;

/// What the gap is at the axis, as a function of r.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Parity {
    /// Even and smooth: a body that is smooth at its tip.
    #[default]
    Even,
    /// Smooth for r ≥ 0 but not even: a tip like that of a cone, or r³.
    Odd,
    /// A broken power of r.
    Broken,
}

/// Where a gap is not smooth. The default is nowhere.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Breaks<'a> {
    /// The positive radii where h or one of its first three derivatives jumps, ascending.
    pub knots: &'a [f64],
    /// What the gap is at the axis.
    pub axis: Parity,
    /// Whether the gap is a cubic in r between its knots.
    pub cubic: bool,
}

/// A stretch of radii without a knot inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmoothStretch {
    /// The smaller end.
    pub from: f64,
    /// The larger end.
    pub to: f64,
    /// The knot at or below `from`, or 0 if there is none: transforms of the gap are smooth in √(a − base) there.
    pub base: f64,
}

impl<'a> Breaks<'a> {
    /// The knots above `from` and below `to`.
    pub fn between(&self, from: f64, to: f64) -> &'a [f64] {
        let first = self.knots.partition_point(|knot| *knot <= from);
        let last = self.knots.partition_point(|knot| *knot < to);
        &self.knots[first..last.max(first)]
    }

    /// The stretches between the radii `from` and `to > from`, ascending.
    ///
    /// What a disc of radius a feels of a knot at c < a is singular there, as a power of √(a − c). A disc that does not
    /// reach the knot feels nothing of it.
    pub fn stretches(&self, from: f64, to: f64) -> impl DoubleEndedIterator<Item = SmoothStretch> + use<'a> {
        let inside = self.between(from, to);
        let below = self.knots.partition_point(|knot| *knot <= from);
        let base = below.checked_sub(1).map_or(0.0, |at| self.knots[at]);
        (0..=inside.len()).map(move |i| SmoothStretch {
            from: if i == 0 { from } else { inside[i - 1] },
            to: inside.get(i).copied().unwrap_or(to),
            base: if i == 0 { base } else { inside[i - 1] },
        })
    }
}

/// The highest frequency in θ of the sums over a cubic gap: h' cos²θ is of fourth degree.
pub const CUBIC_FREQUENCY: f64 = 4.0;

/// The power of u in θ where the gap is a broken power of r at the axis.
const GRADING: f64 = 5.0;

/// The phase of the piece that is taken in u, and its number of nodes.
const GRADED_PHASE: f64 = 4.0;
const GRADED_NODES: usize = 28;

/// Extra nodes on a piece that begins as far from the axis as it is wide: there the broken power has a ρ of 5.8.
const NEAR_NODES: usize = 8;

/// Rules up to this number of nodes are kept.
const KEPT: usize = 48;

static RULES: LazyLock<Vec<Vec<(f64, f64)>>> = LazyLock::new(|| (1..=KEPT).map(rule).collect());

/// Nodes and weights on (−1, 1).
fn rule(nodes: usize) -> Vec<(f64, f64)> {
    GaussLegendre::new(NonZeroUsize::new(nodes).unwrap_or(NonZeroUsize::MIN)).as_node_weight_pairs().to_vec()
}

/// The number of nodes that a piece of this half phase takes.
fn nodes(z: f64) -> usize {
    // Positive, and a few thousand at most.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let nodes = (0.5 * z + 5.0 * cbrt(z) + 2.0).ceil() as usize;
    nodes
}

/// Gauss's nodes in θ on (0, π/2), split at the knots of a gap.
#[derive(Debug, Clone, Default)]
pub struct Angles {
    /// sin θ, ascending.
    pub sines: Vec<f64>,
    /// cos θ.
    pub cosines: Vec<f64>,
    /// The weights of ∫ dθ.
    pub weights: Vec<f64>,
}

impl Angles {
    /// The nodes for a disc of radius `s`, for integrands that have frequencies up to `frequency` in θ between the knots.
    pub fn new(breaks: Breaks<'_>, s: f64, frequency: f64) -> Self {
        let mut angles = Self::default();
        let mut from = 0.0;
        if breaks.axis == Parity::Broken && !breaks.cubic {
            from = asin(breaks.knots.first().map_or(1.0, |knot| knot / s).min(1.0));
            angles.graded(from, frequency);
        }
        for knot in breaks.between(s * sin(from), s) {
            let to = asin(knot / s);
            angles.piece(from, to, frequency, 0);
            from = to;
        }
        angles.piece(from, FRAC_PI_2, frequency, 0);
        angles
    }

    /// Adds the rule from `from` to `to`, with `more` nodes beyond what its phase takes.
    fn piece(&mut self, from: f64, to: f64, frequency: f64, more: usize) {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        if half > 0.0 {
            self.add(nodes(frequency * half) + more, |x| (middle + half * x, half));
        }
    }

    /// Adds the rules from the axis to `to`, graded towards the axis for broken powers.
    fn graded(&mut self, to: f64, frequency: f64) {
        let inner = to.min(GRADED_PHASE / frequency);
        self.add(GRADED_NODES, |x| {
            let u = 0.5 * (1.0 + x);
            (inner * pow(u, GRADING), 0.5 * inner * GRADING * pow(u, GRADING - 1.0))
        });
        let mut from = inner;
        while from < to {
            let next = to.min(2.0 * from);
            self.piece(from, next, frequency, NEAR_NODES);
            from = next;
        }
    }

    /// Adds nodes at the θ that `at` maps those on (−1, 1) to, with dθ/dx.
    fn add(&mut self, nodes: usize, at: impl Fn(f64) -> (f64, f64)) {
        let fresh;
        let rule = if let Some(rule) = RULES.get(nodes - 1) {
            rule
        } else {
            fresh = rule(nodes);
            &fresh
        };
        for &(x, weight) in rule {
            let (theta, stretch) = at(x);
            let (sin, cos) = sin_cos(theta);
            self.sines.push(sin);
            self.cosines.push(cos);
            self.weights.push(weight * stretch);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_of_any_width_reach_rounding() {
        // ∫ cos fθ dθ over many pieces, some of them narrow.
        let knots: Vec<f64> = (1..200).map(|i| 0.9 * (f64::from(i) / 200.0).powi(3)).collect();
        for (frequency, s) in [(4.0, 1.0), (4.0, 0.3), (60.0, 0.7), (900.0, 1.0)] {
            let angles = Angles::new(Breaks { knots: &knots, ..Breaks::default() }, s, frequency);
            let sum = |f: &dyn Fn(f64) -> f64| -> f64 {
                let thetas = angles.sines.iter().zip(&angles.cosines).map(|(sin, cos)| sin.atan2(*cos));
                thetas.zip(&angles.weights).map(|(theta, weight)| weight * f(theta)).sum()
            };
            let exact = (frequency * FRAC_PI_2).sin() / frequency;
            assert!((sum(&|theta| (frequency * theta).cos()) - exact).abs() < 2e-14, "{frequency} {s}");
            assert!((sum(&|_| 1.0) - FRAC_PI_2).abs() < 2e-14);
            // A jump of the third derivative at each knot.
            let bends = |theta: f64| {
                let r = s * theta.sin();
                knots.iter().map(|knot| (r - knot).max(0.0).powi(2)).sum::<f64>()
            };
            let by_pieces: f64 = knots
                .iter()
                .filter(|knot| **knot < s)
                .map(|c| {
                    // ∫ (s sin θ − c)² from asin(c/s) to π/2.
                    let (sin, cos) = (c / s, (1.0 - (c / s).powi(2)).sqrt());
                    let width = cos.atan2(sin);
                    s * s * 0.5 * (width + sin * cos) - 2.0 * s * c * cos + c * c * width
                })
                .sum();
            assert!((sum(&bends) / by_pieces - 1.0).abs() < 1e-12, "{frequency} {s}");
        }
    }

    #[test]
    fn broken_powers_reach_rounding() {
        for frequency in [4.0, 300.0] {
            let angles = Angles::new(Breaks { axis: Parity::Broken, ..Breaks::default() }, 1.0, frequency);
            for n in [1.0_f64, 1.1, 1.5, 1.9, 2.7] {
                // Wallis: ∫ sinⁿ⁻¹θ dθ.
                let exact =
                    0.5 * std::f64::consts::PI.sqrt() * libm::tgamma(0.5 * n) / libm::tgamma(0.5 * (n + 1.0));
                let sum: f64 =
                    angles.sines.iter().zip(&angles.weights).map(|(sin, w)| w * sin.powf(n - 1.0)).sum();
                assert!((sum / exact - 1.0).abs() < 1e-13, "{n} {frequency}: {}", sum / exact - 1.0);
            }
        }
    }

    #[test]
    fn stretches_cover_the_way() {
        let breaks = Breaks { knots: &[0.1, 0.2, 0.5], ..Breaks::default() };
        let found: Vec<[f64; 3]> = breaks.stretches(0.15, 0.5).map(|s| [s.from, s.to, s.base]).collect();
        assert_eq!(found, [[0.15, 0.2, 0.1], [0.2, 0.5, 0.2]]);
        let found: Vec<[f64; 3]> = breaks.stretches(0.0, 0.05).map(|s| [s.from, s.to, s.base]).collect();
        assert_eq!(found, [[0.0, 0.05, 0.0]]);
    }
}
