//! The transform of any gap, from samples of its slope on panels that resolve it.
//!
//! ```text
//! g(a)  = a ∫₀ᵃ h'(r)/√(a² − r²) dr
//! g'(a) = ∫₀ᵃ h'/√(a² − r²) dr + ∫₀ᵃ r h''/√(a² − r²) dr + Σ_{q<a} J_q q/√(a² − q²)
//! ```
//!
//! `J_q` is the jump of h' at the break q. Panels that end well below a are **far**: Gauss's rule in r, with samples
//! that serve every a. The others, and the panel of a itself, are **near**: Gauss's rule in φ, r = a cos φ, in which
//! the singularity is gone; there h' is the polynomial through its samples. Where there are many panels, those far away
//! are grouped ([`clusters`](super::clusters)). Angles come from differences a − r that are exact on the panels right
//! of a break.

use super::chebyshev::ChebyshevRule;
use super::clusters::{Cluster, Clusters, NODES, SumPart};
use super::span::panel_of;
use crate::elementary::{atan2, cos};
use crate::gap::Gap;
use crate::gap::{panels::Span, panels::Variable};
use crate::progress::{Progress, Stopped};
use gauss_quad::GaussLegendre;
use std::num::NonZeroUsize;
use std::sync::LazyLock;

/// A panel is far from a when its distance is at least this share of its width: 24 nodes then leave an error of 2.1⁻⁴⁸.
const FAR: f64 = 0.15;

/// From this many panels on, those far away are grouped.
const MANY: usize = 64;

/// A jump of h' below this share of its size is rounding.
const NO_JUMP: f64 = 1e-10;

/// Gauss's nodes and weights on (−1, 1).
pub static GAUSS: LazyLock<[[f64; 2]; NODES]> = LazyLock::new(|| {
    let rule = GaussLegendre::new(NonZeroUsize::new(NODES).unwrap_or(NonZeroUsize::MIN));
    let mut pairs = [[0.0; 2]; NODES];
    for (pair, (x, weight)) in pairs.iter_mut().zip(rule.iter()) {
        *pair = [*x, *weight];
    }
    pairs
});

/// h' and h'' on one panel.
#[derive(Debug, Clone)]
struct PanelSource {
    span: Span,
    /// The series of h' and h'' over the radius, from `lo` to `hi`; nothing on the innermost panel.
    series: [[f64; NODES]; 2],
}

/// The samples of a gap on its panels.
#[derive(Debug, Clone)]
pub struct Sources {
    parts: Vec<PanelSource>,
    /// Gauss's nodes in r on each, with their weights times h' and times r h''.
    samples: Clusters<2>,
    /// The breaks at which h' jumps, with the jump.
    jumps: Vec<[f64; 2]>,
}

/// h' and h'' of `gap` at `radii`; what is not a number counts as zero, as h'' on a break.
fn slopes(gap: &dyn Gap, radii: &[f64; NODES]) -> [[f64; NODES]; 2] {
    let [mut first, mut second, mut third] = [[0.0; NODES]; 3];
    gap.derivatives(1.0, radii, [&mut first, &mut second, &mut third]);
    for value in first.iter_mut().chain(&mut second) {
        if !value.is_finite() {
            *value = 0.0;
        }
    }
    [first, second]
}

impl PanelSource {
    /// The panel, and its samples.
    fn new(gap: &dyn Gap, span: Span) -> (Self, Cluster<2>) {
        let (centre, half) = (0.5 * (span.lo + span.hi), 0.5 * (span.hi - span.lo));
        let innermost = span.variable == Variable::Fifth;
        let mut series = [[0.0; NODES]; 2];
        let (mut radii, mut weights) = ([0.0; NODES], [0.0; NODES]);
        for (i, [x, weight]) in GAUSS.iter().enumerate() {
            (radii[i], weights[i]) = if innermost {
                (span.radius(*x), 0.5 * weight * span.stretch(*x))
            } else {
                (centre + half * x, half * weight)
            };
        }
        let weighted = if innermost {
            slopes(gap, &radii)
        } else {
            let rule = ChebyshevRule::of(NODES);
            let nodes: [f64; NODES] = std::array::from_fn(|j| centre + half * rule.nodes[j]);
            for (samples, series) in slopes(gap, &nodes).iter().zip(&mut series) {
                rule.coefficients(samples, series);
            }
            let places: [f64; NODES] = std::array::from_fn(|i| GAUSS[i][0]);
            series.each_ref().map(|series| sums(series, &places))
        };
        let [first, second] = weighted;
        let weights = [
            std::array::from_fn(|i| weights[i] * first[i]),
            std::array::from_fn(|i| weights[i] * radii[i] * second[i]),
        ];
        (Self { span, series }, Cluster { ends: [span.lo, span.hi], radii, weights })
    }
}

/// A series, summed at as many places as it has terms.
fn sums(series: &[f64; NODES], places: &[f64; NODES]) -> [f64; NODES] {
    let (mut b1, mut b2) = ([0.0; NODES], [0.0; NODES]);
    for c in series.iter().skip(1).rev() {
        for i in 0..NODES {
            let b = 2.0 * places[i] * b1[i] - b2[i] + c;
            b2[i] = b1[i];
            b1[i] = b;
        }
    }
    std::array::from_fn(|i| places[i] * b1[i] - b2[i] + series[0])
}

/// A radius a at which the transform is wanted, with exact differences from the radii around it.
#[derive(Debug, Clone, Copy)]
pub struct TargetRadius {
    /// a.
    a: f64,
    /// The break below it and a less that break, exact; 0 and a where there is none.
    base: f64,
    above: f64,
}

impl TargetRadius {
    /// The radius at x of `span`.
    pub fn new(span: &Span, x: f64) -> Self {
        let a = span.radius(x);
        match span.variable {
            Variable::Root { base } => Self { a, base, above: span.variable_at(x).powi(2) },
            _ => Self { a, base: 0.0, above: a },
        }
    }

    /// a − q.
    fn minus(&self, q: f64) -> f64 {
        (self.above - (q - self.base)).max(0.0)
    }

    /// √(a² − q²).
    fn root(&self, q: f64) -> f64 {
        (self.minus(q) * (self.a + q)).sqrt()
    }

    /// arccos(q/a).
    fn angle(&self, q: f64) -> f64 {
        atan2(self.root(q), q)
    }
}

/// By how much h' jumps at the break `q`, from which the next one is at least twice as far as `free`; `None` where it does
/// not.
fn jump_at(gap: &dyn Gap, q: f64, free: f64) -> Option<f64> {
    /// A few units in the last place off: the break is known to the last bit, but not on which side it lies.
    const OFF: f64 = 4.0 * f64::EPSILON;
    /// Further off by this factor each time, and how well two jumps must agree.
    const FURTHER: f64 = 16.0;
    const TIMES: usize = 5;
    const AGREES: f64 = 0.01;
    let over = |off: f64| {
        let [outer, inner] = [q * (1.0 + off), q * (1.0 - off)].map(|r| gap.jet(r).first);
        let jump = outer - inner;
        (jump.is_finite() && jump.abs() > NO_JUMP * (outer.abs() + inner.abs())).then_some(jump)
    };
    // Where the two sides of `min` or `max` differ by less than rounding, one of them holds over more than a few units, and
    // no jump is seen there. Further off the jump of a corner stays the same, and anything else grows.
    let mut off = OFF;
    for _ in 0..TIMES {
        let further = FURTHER * off;
        if further * q >= free {
            break;
        }
        if let [Some(jump), Some(next)] = [over(off), over(further)]
            && (jump - next).abs() <= AGREES * next.abs()
        {
            return Some(jump);
        }
        off = further;
    }
    over(OFF)
}

impl Sources {
    /// The samples of `gap` on `spans`, panels from the axis outward, and its jumps at those of `breaks` that have one.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn new(
        gap: &dyn Gap,
        spans: &[Span],
        breaks: &[f64],
        progress: &dyn Progress,
    ) -> Result<Self, Stopped> {
        let part = |span: &Span| progress.go_on().map(|()| PanelSource::new(gap, *span));
        let (parts, samples) = spans.iter().map(part).collect::<Result<(Vec<_>, Vec<_>), _>>()?;
        let samples = Clusters::new(samples, MANY);
        let mut jumps = Vec::new();
        for (i, &q) in breaks.iter().enumerate() {
            let before = i.checked_sub(1).map_or(0.0, |i| breaks[i]);
            let after = breaks.get(i + 1).copied().unwrap_or(f64::INFINITY);
            jumps.extend(jump_at(gap, q, 0.5 * (q - before).min(after - q)).map(|jump| [q, jump]));
        }
        Ok(Self { parts, samples, jumps })
    }

    /// Whether h' jumps at `base`.
    pub fn jumps_at(&self, base: f64) -> bool {
        self.jumps.iter().any(|[q, _]| q.to_bits() == base.to_bits())
    }

    /// g and its derivative at x of `span`: with respect to the radius, or to the panel's variable where h' jumps at
    /// its base and on the innermost panel.
    pub fn transform(&self, gap: &dyn Gap, span: &Span, x: f64) -> [f64; 2] {
        let target = TargetRadius::new(span, x);
        let a = target.a;
        let last = panel_of(&self.parts, |part| &part.span, a);
        let [mut first, mut second] = [0.0; 2];
        let mut add = |part: SumPart<'_, 2>| {
            let [one, two] = match part {
                SumPart::Far(cluster) => cluster.sums(a),
                SumPart::Panel(i) => {
                    let Span { lo, hi, variable } = self.parts[i].span;
                    if i < last && target.minus(hi) >= FAR * (hi - lo) {
                        self.samples.panel(i).sums(a)
                    } else if variable == Variable::Fifth {
                        innermost(gap, &target, hi)
                    } else {
                        near(&self.parts[i], &target)
                    }
                }
            };
            first += one;
            second += two;
        };
        self.samples.visit(last, &|hi| target.minus(hi), &mut add);
        add(SumPart::Panel(last));
        let mut slope = first + second;
        let mut own = 0.0;
        let base = if let Variable::Root { base } = span.variable { base } else { f64::NAN };
        for [q, jump] in &self.jumps {
            if q.to_bits() == base.to_bits() {
                own = 2.0 * jump * q / (a + q).sqrt();
            } else if *q < a {
                slope += jump * q / target.root(*q);
            }
        }
        let per_radius = own == 0.0 && span.variable != Variable::Fifth;
        [a * first, if per_radius { slope } else { span.stretch(x) * slope + own }]
    }
}

/// ∫ h'/√(a² − r²) and ∫ r h''/√(a² − r²) over a near panel, as far as a, by angles.
fn near(part: &PanelSource, target: &TargetRadius) -> [f64; 2] {
    let Span { lo, hi, .. } = part.span;
    let from = if hi >= target.a { 0.0 } else { target.angle(hi) };
    let to = target.angle(lo);
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let scale = 2.0 / (hi - lo);
    let mut places = [0.0; NODES];
    let mut shares = [0.0; NODES];
    for i in 0..NODES {
        let share = cos(middle + half * GAUSS[i][0]);
        shares[i] = share;
        // Beside a break rounding would pick the wrong side.
        places[i] = ((target.a * share - lo) * scale - 1.0).clamp(-1.0, 1.0);
    }
    let first = sums(&part.series[0], &places);
    let second = sums(&part.series[1], &places);
    let mut total = [0.0; 2];
    for i in 0..NODES {
        let weight = half * GAUSS[i][1];
        total[0] += weight * first[i];
        total[1] += weight * target.a * shares[i] * second[i];
    }
    total
}

/// The same over the innermost panel, as far as a: near the axis in u, r ∝ u⁵, so that broken powers cost nothing, and the rest
/// by angles.
fn innermost(gap: &dyn Gap, target: &TargetRadius, hi: f64) -> [f64; 2] {
    let a = target.a;
    let end = a.min(hi);
    let inner = 0.5 * end;
    let (from, to) = (if hi >= a { 0.0 } else { target.angle(hi) }, target.angle(inner));
    let (mut radii, mut weights) = ([[0.0; NODES]; 2], [[0.0; NODES]; 2]);
    for (i, [x, weight]) in GAUSS.iter().enumerate() {
        let u = 0.5 * (1.0 + x);
        let r = inner * u.powi(5);
        radii[0][i] = r;
        weights[0][i] = 2.5 * inner * u.powi(4) * weight / ((a - r) * (a + r)).sqrt();
        radii[1][i] = (a * cos(0.5 * (from + to) + 0.5 * (to - from) * x)).clamp(inner, end);
        weights[1][i] = 0.5 * (to - from) * weight;
    }
    let mut total = [0.0; 2];
    for (radii, weights) in radii.iter().zip(&weights) {
        let [first, second] = slopes(gap, radii);
        for i in 0..NODES {
            total[0] += weights[i] * first[i];
            total[1] += weights[i] * radii[i] * second[i];
        }
    }
    total
}
