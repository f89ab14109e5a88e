//! Integrals to rounding: Gauss-Legendre panels that halve where they must.
//!
//! A panel is accepted when the last two Legendre coefficients of its integrand, which the nodes give without another
//! evaluation, are below [`TOLERANCE`] of the integral of |f|. For a smooth integrand the error of the rule is then
//! much smaller still; at a kink the coefficients fall slowly and the panels cluster there.

use crate::gap::Breaks;
use crate::gap::breaks::SmoothStretch;
use gauss_quad::GaussLegendre;
use std::num::NonZeroUsize;
use std::ops::AddAssign;
use std::sync::LazyLock;

/// Nodes of one panel: a panel that spans one wave then needs no halving.
const NODES: NonZeroUsize = NonZeroUsize::new(24).unwrap();

/// The largest share of the integral of |f| that the last coefficients of a panel may have.
pub const TOLERANCE: f64 = 2e-14;

/// Most panels to start with; a wave so short that it would need more is left to the halving.
const STARTED: f64 = 4096.0;

/// Most panels of one integral: whatever is not resolved by then stays as it is and is reported.
const PANELS: usize = 1 << 15;

/// Nodes of a stretch between two knots of a cubic gap. A singularity one stretch further in then contributes 4.1⁻²⁴ of
/// itself, and is itself small.
const STRETCH_NODES: NonZeroUsize = NonZeroUsize::new(12).unwrap();

/// Its nodes and weights on (−1, 1).
pub(super) static STRETCH: LazyLock<Vec<(f64, f64)>> =
    LazyLock::new(|| GaussLegendre::new(STRETCH_NODES).as_node_weight_pairs().to_vec());

/// A node on (−1, 1), its weight, and its weights in the last two Legendre coefficients.
struct GaussNode {
    x: f64,
    weight: f64,
    tail: [f64; 2],
}

static RULE: LazyLock<Vec<GaussNode>> = LazyLock::new(|| {
    let rule = GaussLegendre::new(NODES);
    let last = NODES.get() - 1;
    let node = |&(x, weight): &(f64, f64)| {
        let (mut before, mut here) = (1.0, x);
        for n in 1..last {
            let n = n as f64;
            (before, here) = (here, ((2.0 * n + 1.0) * x * here - n * before) / (n + 1.0));
        }
        // cₙ = (2n+1)/2 Σ w f Pₙ.
        let order = last as f64;
        GaussNode { x, weight, tail: [(order + 0.5) * weight * here, (order - 0.5) * weight * before] }
    };
    rule.as_node_weight_pairs().iter().map(node).collect()
});

/// One panel: its integrals, those of |f|, and its last coefficients times its width.
#[derive(Clone, Copy)]
struct QuadraturePanel<const K: usize> {
    from: f64,
    to: f64,
    integral: [f64; K],
    absolute: [f64; K],
    tail: [f64; K],
}

impl<const K: usize> QuadraturePanel<K> {
    fn new(from: f64, to: f64, f: &mut impl FnMut(f64) -> [f64; K]) -> Self {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let mut panel = Self { from, to, integral: [0.0; K], absolute: [0.0; K], tail: [0.0; K] };
        let mut tails = [[0.0; 2]; K];
        for node in RULE.iter() {
            for (k, value) in f(middle + half * node.x).into_iter().enumerate() {
                panel.integral[k] += half * node.weight * value;
                panel.absolute[k] += half.abs() * node.weight * value.abs();
                tails[k][0] += node.tail[0] * value;
                tails[k][1] += node.tail[1] * value;
            }
        }
        panel.tail = tails.map(|[a, b]| (a.abs() + b.abs()) * half.abs());
        panel
    }
}

/// `K` integrals over one interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Integral<const K: usize> {
    /// The integrals.
    pub values: [f64; K],
    /// Whether every panel met [`TOLERANCE`]. If not, the integrand has structure too fine for the panels, or is NaN,
    /// and the values are only as good as the last panels.
    pub resolved: bool,
}

impl<const K: usize> AddAssign for Integral<K> {
    fn add_assign(&mut self, part: Self) {
        for (sum, part) in self.values.iter_mut().zip(part.values) {
            *sum += part;
        }
        self.resolved &= part.resolved;
    }
}

/// The integrals from `from` to `to ≥ from` of something derived from transforms of a gap with these breaks: powers of
/// √(a − c) beyond each knot c, elsewhere as in [`integrate`].
pub fn integrate_broken<const K: usize>(
    breaks: Breaks<'_>,
    from: f64,
    to: f64,
    wave: Option<f64>,
    mut f: impl FnMut(f64) -> [f64; K],
) -> Integral<K> {
    if breaks.knots.is_empty() {
        return integrate(from, to, wave, f);
    }
    let mut sum = Integral { values: [0.0; K], resolved: true };
    for SmoothStretch { from, to, base } in breaks.stretches(from, to) {
        let (x_from, x_to) = ((from - base).sqrt(), (to - base).sqrt());
        let mut rooted = |x: f64| f(base + x * x).map(|value| 2.0 * x * value);
        sum += if breaks.cubic {
            let (middle, half) = (0.5 * (x_from + x_to), 0.5 * (x_to - x_from));
            let mut values = [0.0; K];
            for (x, weight) in STRETCH.iter() {
                for (sum, value) in values.iter_mut().zip(rooted(middle + half * x)) {
                    *sum += half * weight * value;
                }
            }
            Integral { values, resolved: values.iter().all(|value| value.is_finite()) }
        } else {
            // a = base + x²: in x a wave is shortest at the far end.
            integrate(x_from, x_to, wave.map(|wave| 0.5 * wave / x_to), rooted)
        };
    }
    sum
}

/// The integrals from `from` to `to` of the `K` values of `f`, which has waves of the length `wave` there.
///
/// The error is about 1e-14 of the integrals of |f| if they are [resolved](Integral::resolved). An integrand with
/// endlessly fine structure is abandoned at a fixed number of panels.
pub fn integrate<const K: usize>(
    from: f64,
    to: f64,
    wave: Option<f64>,
    mut f: impl FnMut(f64) -> [f64; K],
) -> Integral<K> {
    let waves = wave.map_or(1.0, |wave| ((to - from).abs() / wave).clamp(1.0, STARTED)).ceil();
    let width = (to - from) / waves;
    let mut panels: Vec<QuadraturePanel<K>> = Vec::new();
    let mut index = 0.0;
    while index < waves {
        let end = if index + 1.0 < waves { from + width * (index + 1.0) } else { to };
        panels.push(QuadraturePanel::new(from + width * index, end, &mut f));
        index += 1.0;
    }
    let scale: [f64; K] = std::array::from_fn(|k| panels.iter().map(|p| p.absolute[k]).sum());
    let mut integral = Integral { values: [0.0; K], resolved: true };
    let mut made = panels.len();
    while let Some(panel) = panels.pop() {
        let resolved = (0..K).all(|k| panel.tail[k] <= TOLERANCE * scale[k]);
        let middle = 0.5 * (panel.from + panel.to);
        let halves = panel.from.min(panel.to) < middle && middle < panel.from.max(panel.to);
        if resolved || made >= PANELS || !halves {
            integral.resolved &= resolved;
            for (sum, part) in integral.values.iter_mut().zip(panel.integral) {
                *sum += part;
            }
            continue;
        }
        made += 2;
        panels.push(QuadraturePanel::new(panel.from, middle, &mut f));
        panels.push(QuadraturePanel::new(middle, panel.to, &mut f));
    }
    integral
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An integral that must be resolved.
    fn resolved(from: f64, to: f64, wave: Option<f64>, f: impl Fn(f64) -> f64) -> f64 {
        let Integral { values: [value], resolved } = integrate(from, to, wave, |x| [f(x)]);
        assert!(resolved);
        value
    }

    #[test]
    fn smooth_wavy_and_kinked_integrands() {
        assert!((resolved(0.0, 1.0, None, f64::exp) - 1f64.exp_m1()).abs() < 4e-15);
        assert!((resolved(0.0, 1.0, None, |_| 1.0) - 1.0).abs() < 4e-15);
        for wave in [Some(0.01), None] {
            let square = resolved(0.0, 1.0, wave, |x| (std::f64::consts::TAU * 100.0 * x).sin().powi(2));
            assert!((square - 0.5).abs() < 1e-14, "{square}");
        }
        let kink = resolved(0.0, 1.0, None, |x| (x - 0.3).abs());
        assert!((kink - 0.29).abs() < 1e-13, "{kink}");
        assert!((resolved(1.0, 0.0, Some(0.1), |x| x * x) + 1.0 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn noise_and_nan_end_and_say_so() {
        let noise = integrate(0.0, 1.0, None, |x: f64| [(1e9 * x).sin()]);
        assert!(noise.values[0].is_finite() && !noise.resolved);
        let nan = integrate(0.0, 1.0, Some(1e-300), |_| [f64::NAN]);
        assert!(nan.values[0].is_nan() && !nan.resolved);
        // The jump of a step cannot be halved away, but its panel becomes negligible.
        let step = resolved(0.0, 1.0, None, |x| if x < 0.3 { 0.0 } else { 1.0 });
        assert!((step - 0.7).abs() < 1e-13);
    }
}
