//! The bodies around the edge of one disc, from the table: the gap outside and the pressure inside (E* = 1).
//!
//! ```text
//! r > s    gap(r) = (2/π) ∫_s^r (g(a) − δ)/√(r² − a²) da
//!          gap(r) = h(r) − δ − (2/π) ∫₀^s (g(a) − δ)/√(r² − a²) da
//! r < s    p(r)   = (1/π) [(δ − g(s))/√(s² − r²) + ∫_r^s g'(a)/√(a² − r²) da]
//! ```
//!
//! The first follows from h(r) = (2/π) ∫₀ʳ g/√(r² − a²) da, Abel's inversion of g, and the displacement that the
//! pressure causes outside. The second is the first with the whole integral replaced by h(r): near the edge it loses
//! digits, far out it needs no table there. All hold for any δ, not only in equilibrium. On every panel a substitution
//! removes the singularity: a = b + (r − b) sin²ψ right of a break b, a = r sin ψ elsewhere.
//!
//! **What must be searched.** If the gap is not negative on [s, q], the contribution of those radii at r > q is
//! (2/π)√(r² − q²) ∫_s^q t gap(t)/((r² − t²)√(q² − t²)) dt ≥ 0, so beyond the edge the gap can first become negative
//! only where g < δ. Where g stays above δ the bodies stay apart, and no gap needs to be computed.

use super::chebyshev::{self, ChebyshevRule};
use super::clusters::SumPart;
use super::panels::Panels;
use super::span::Place;
use crate::elementary::{acosh, asin, asinh, cosh, pow, sin, sinh};
use crate::gap::panels::Variable;
use crate::progress::Progress;
use gauss_quad::GaussLegendre;
use std::f64::consts::{FRAC_1_PI, FRAC_2_PI, FRAC_PI_2};
use std::num::NonZeroUsize;
use std::sync::LazyLock;
use wide::f64x4;

/// Nodes on a panel near r, on one at least its own width away, and on one at least [`VERY_FAR`] widths away.
const NODES: [usize; 3] = [32, 14, 8];
const VERY_FAR: f64 = 6.0;

/// A part of at most this share of a panel takes the nodes of a far panel.
const SMALL: f64 = 0.2;

/// The most stretches of panels integrated over in one search: those of fifty crests and more, a few hundredths of a
/// second.
const MOST_WORK: usize = 1000;

/// Crests examined from the first that overlaps onward.
const CRESTS: usize = 8;

/// Among more neighbouring panels than this, the smallest gap is sought at three places on each, and then nearby.
const MANY: usize = 8;

/// Halvings of an interval in which the gap is searched, until its series ends.
const HALVINGS: usize = 8;

/// Places on a piece at which the gap is computed, and the limit of its last coefficients there relative to the
/// largest: its minimum is then found to four digits of the piece, and its value to seven.
const SEARCHED: usize = 12;
const TAIL: f64 = 1e-7;

/// Values of g − δ below this share of g's size on a panel are rounding.
const ROUNDING: f64 = 1e-14;

/// A ring of at most this share of the way to the next border of the table inward is thin.
const THIN: f64 = 1e-3;

fn gauss(nodes: usize) -> Vec<[f64; 2]> {
    let rule = GaussLegendre::new(NonZeroUsize::new(nodes).unwrap_or(NonZeroUsize::MIN));
    rule.iter().map(|(x, weight)| [*x, *weight]).collect()
}

static RULES: LazyLock<[Vec<[f64; 2]>; 3]> = LazyLock::new(|| NODES.map(gauss));

/// The rule for a panel of this width at this distance.
fn rule(distance: f64, width: f64) -> &'static [[f64; 2]] {
    let far = usize::from(distance >= width) + usize::from(distance >= VERY_FAR * width);
    &RULES[far]
}

/// The deformed gap at `r ≥ s` around a disc of radius `s` at the approach `delta`; the panels must reach to `r`.
pub fn gap_from(panels: &Panels, s: f64, delta: f64, r: f64) -> f64 {
    gap_by(panels, s, r, |i, ends| stretch_outside(panels, i, delta, r, ends))
}

/// The sum over the panels between s and r of what `stretch` gives for each, and for its ends there, times 2/π.
fn gap_by(panels: &Panels, s: f64, r: f64, stretch: impl Fn(usize, [f64; 2]) -> f64) -> f64 {
    FRAC_2_PI * over_panels(panels, s, r, stretch)
}

/// The sum over the panels between s and r of what `stretch` gives for each, and for its ends there.
fn over_panels(panels: &Panels, s: f64, r: f64, stretch: impl Fn(usize, [f64; 2]) -> f64) -> f64 {
    if r <= s {
        return 0.0;
    }
    let (first, last) = (panels.place(s).panel, panels.place(r).panel);
    let part = |i: usize| {
        let span = panels.list()[i].span;
        stretch(i, [span.lo.max(s), span.hi.min(r)])
    };
    (first..=last).map(part).sum::<f64>()
}

/// ∫_s^r f/√(r² − a²) da, f a function of the radius a and of g there; the panels must reach to `r`. All digits of the table are kept
/// where f is as smooth on every panel as g is.
pub fn sum_from(panels: &Panels, s: f64, r: f64, f: OfRadii<'_>) -> f64 {
    over_panels(panels, s, r, |i, ends| {
        let span = panels.list()[i].span;
        // A small part of a panel is nearly a line.
        let small = ends[1] - ends[0] <= SMALL * (span.hi - span.lo) && span.variable != Variable::Fifth;
        sum_by(panels, i, r, ends, &RULES[usize::from(small)], f)
    })
}

/// ∫_s^r g' (a/r)/√(r² − a²) da; the panels must reach to `r`. `angle` is the angle whose cosine is s/r: for a thin
/// ring it has more digits than the difference of `s` and `r`.
pub fn rise_from(panels: &Panels, s: f64, r: f64, angle: f64) -> f64 {
    let (inner, outer) = (panels.place(s), panels.place(r));
    let from_border = s - panels.list()[inner.panel].span.lo;
    if inner.panel == outer.panel && r - s <= THIN * from_border {
        // a = r cos t, on a stretch on which g' is nearly a line.
        let rule = &RULES[2];
        let at = |x: f64| {
            let cosine = sin(FRAC_PI_2 - 0.5 * angle * (1.0 + x));
            panels.values(panels.place((r * cosine).clamp(s, r))).slope * cosine
        };
        return 0.5 * angle * rule.iter().map(|[x, weight]| weight * at(*x)).sum::<f64>();
    }
    over_panels(panels, s, r, |i, ends| slope_outside(panels, i, r, ends))
}

/// The same far from the edge, where `gap` is h(r); the panels need to reach only to `s`.
pub fn gap_far(panels: &Panels, gap: f64, s: f64, delta: f64, r: f64) -> f64 {
    let last = panels.place(s).panel;
    let part = |i: usize| {
        let span = panels.list()[i].span;
        stretch_outside(panels, i, delta, r, [span.lo, span.hi.min(s)])
    };
    gap - delta - FRAC_2_PI * (0..=last).map(part).sum::<f64>()
}

/// ∫ (g − δ)/√(r² − a²) da from `lo` to `hi` on one panel.
fn stretch_outside(panels: &Panels, index: usize, delta: f64, r: f64, [lo, hi]: [f64; 2]) -> f64 {
    if hi <= lo {
        return 0.0;
    }
    let rule = rule(r - hi, hi - lo);
    sum_by(panels, index, r, [lo, hi], rule, &|_, g| g - delta)
}

/// Four numbers at four places of a panel.
type Fours<'a> = &'a dyn Fn(f64x4) -> f64x4;

/// A function of four radii and of g at them.
pub type OfRadii<'a> = &'a dyn Fn(f64x4, f64x4) -> f64x4;

/// A function of four numbers one by one.
fn each(of: f64x4, f: impl FnMut(f64) -> f64) -> f64x4 {
    f64x4::new(of.to_array().map(f))
}

/// ∫ f dv by a rule. `node` gives the place of v on a panel and a number of its own, `of` the values of the panel
/// there, and `f` takes all three.
fn by_fours(
    rule: &[[f64; 2]],
    [from, to]: [f64; 2],
    node: &dyn Fn(f64x4) -> [f64x4; 2],
    of: Fours<'_>,
    f: &dyn Fn([f64x4; 2], f64x4) -> f64x4,
) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut sum = f64x4::ZERO;
    for four in rule.chunks(4) {
        // A short last group is filled with its first node, with zero weight.
        let at: [f64; 4] = std::array::from_fn(|i| four.get(i).unwrap_or(&four[0])[0]);
        let weights: [f64; 4] = std::array::from_fn(|i| four.get(i).map_or(0.0, |[_, weight]| *weight));
        let node = node(f64x4::new(at) * half + middle);
        sum += f64x4::new(weights) * f(node, of(node[0]));
    }
    half * sum.reduce_add()
}

/// ∫ f/√(r² − a²) da from `lo` to `hi` on one panel by a rule.
fn sum_by(
    panels: &Panels,
    index: usize,
    r: f64,
    [lo, hi]: [f64; 2],
    rule: &[[f64; 2]],
    f: OfRadii<'_>,
) -> f64 {
    if hi <= lo {
        return 0.0;
    }
    let span = panels.list()[index].span;
    let [centre, half] = span.line();
    let x = |v: f64x4| ((v - centre) / half).max(-f64x4::ONE).min(f64x4::ONE);
    let g: Fours<'_> = &|x| panels.four_values(index, x);
    let angles = || [asin(lo / r), asin((hi / r).min(1.0))];
    match span.variable {
        Variable::Fifth if r - hi >= hi => {
            let end = span.hi;
            let at = |a: f64| pow(a / end, 0.2);
            by_fours(rule, [at(lo), at(hi)], &|u| [x(u), u], g, &|[_, u], g| {
                let fourth = u * u * u * u;
                let a = fourth * u * end;
                f(a, g) * fourth * (5.0 * end) / ((a + r) * (f64x4::splat(r) - a)).sqrt()
            })
        }
        Variable::Fifth => {
            let node = |psi: f64x4| {
                let a = psi.sin() * r;
                [x(each(a, |a| pow(a / span.hi, 0.2))), a]
            };
            by_fours(rule, angles(), &node, g, &|[_, a], g| f(a, g))
        }
        Variable::Radius => {
            let node = |psi: f64x4| {
                let a = psi.sin() * r;
                [x(a), a]
            };
            by_fours(rule, angles(), &node, g, &|[_, a], g| f(a, g))
        }
        Variable::Root { base } => {
            let height = (r - base).sqrt();
            let angle = |a: f64| asin(((a - base).max(0.0).sqrt() / height).min(1.0));
            let node = |psi: f64x4| {
                let y = psi.sin() * height;
                [x(y), y]
            };
            by_fours(rule, [angle(lo), angle(hi)], &node, g, &|[_, y], g| {
                let a = y * y + base;
                f(a, g) * 2.0 * y / (a + r).sqrt()
            })
        }
    }
}

/// The terms of a sum over the disc of the radius `s`, seen from any r ≥ `edge` > s:
///
/// ```text
/// ∫₀^s g/√(r² − a²) da = Σ w/√((r² − edge²) + below),   below = edge² − a²
/// ```
///
/// as [below, w]. Whole panels far from the edge are grouped; towards it, parts of panels are as wide as they are far
/// from it.
pub fn sum_below(panels: &Panels, s: f64, edge: f64) -> Vec<[f64; 2]> {
    let mut nodes = Vec::new();
    let mut add = |a: f64, weight: f64| nodes.push([(edge - a) * (edge + a), weight]);
    let at = panels.place(s);
    let moments = panels.moments();
    moments.visit(at.panel, &|hi| edge - hi, &mut |part| match part {
        SumPart::Far(cluster) => {
            cluster.radii.iter().zip(&cluster.weights[0]).for_each(|(a, weight)| add(*a, *weight));
        }
        SumPart::Panel(index) => parts_below(panels, Place { panel: index, x: 1.0 }, edge, &mut add),
    });
    parts_below(panels, at, edge, &mut add);
    nodes
}

/// ∫ g' (a/r)/√(r² − a²) da from `lo` to `hi` on one panel.
fn slope_outside(panels: &Panels, index: usize, r: f64, [lo, hi]: [f64; 2]) -> f64 {
    if hi <= lo {
        return 0.0;
    }
    let panel = &*panels.list()[index];
    let (span, rule) = (panel.span, &RULES[0]);
    let slope: Fours<'_> = &|x| panels.four_weighted_slopes(index, x);
    match span.variable {
        Variable::Fifth | Variable::Radius => {
            let node = |psi: f64x4| {
                let sine = psi.sin();
                [each(sine * r, |a| span.place(a)), sine]
            };
            by_fours(rule, [asin(lo / r), asin((hi / r).min(1.0))], &node, slope, &|[x, sine], slope| {
                slope / each(x, |x| panel.weight(x)) * sine
            })
        }
        Variable::Root { base } => {
            let height = (r - base).sqrt();
            let [centre, half] = span.line();
            let angle = |a: f64| asin(((a - base).max(0.0).sqrt() / height).min(1.0));
            let node = |psi: f64x4| {
                let y = psi.sin() * height;
                [((y - centre) / half).max(-f64x4::ONE).min(f64x4::ONE), y]
            };
            by_fours(rule, [angle(lo), angle(hi)], &node, slope, &|[x, y], slope| {
                let a = y * y + base;
                let by_variable = if panel.is_steep() { slope } else { slope * each(x, |x| span.stretch(x)) };
                by_variable * (a / r) / (a + r).sqrt()
            })
        }
    }
}

/// The sources of a panel up to a place on it.
fn parts_below(panels: &Panels, end: Place, edge: f64, add: &mut dyn FnMut(f64, f64)) {
    /// Parts, each half as wide as the previous one.
    const PARTS: usize = 60;
    let span = panels.list()[end.panel].span;
    let [centre, half] = span.line();
    let singular = match span.variable {
        Variable::Radius => edge,
        Variable::Root { base } => (edge - base).sqrt(),
        Variable::Fifth => pow(edge / span.hi, 0.2),
    };
    let singular = (singular - centre) / half;
    let mut lo = -1.0;
    for _ in 0..PARTS {
        let hi = end.x.min(0.5 * (lo + singular));
        if hi <= lo {
            break;
        }
        let sources = panels.sources(end.panel, [lo, hi]);
        sources.radii.iter().zip(&sources.weights[0]).for_each(|(a, weight)| add(*a, *weight));
        lo = hi;
    }
}

/// The pressure at `r < s` in a disc of radius `s` at the approach `delta`, compression positive.
pub fn pressure(panels: &Panels, s: f64, delta: f64, r: f64) -> f64 {
    let at = panels.place(s);
    let first = panels.place(r).panel;
    let inner: f64 = (first..=at.panel)
        .map(|i| {
            let span = panels.list()[i].span;
            stretch_inside(panels, i, r, [span.lo.max(r), span.hi.min(s)])
        })
        .sum();
    FRAC_1_PI * ((delta - panels.value(at)) / ((s - r) * (s + r)).sqrt() + inner)
}

/// ∫ g'/√(a² − r²) da from `lo ≥ r` to `hi` on one panel.
fn stretch_inside(panels: &Panels, index: usize, r: f64, [lo, hi]: [f64; 2]) -> f64 {
    if hi <= lo {
        return 0.0;
    }
    let panel = &*panels.list()[index];
    let span = panel.span;
    let far = lo - r >= hi - lo;
    let rule = rule(lo - r, hi - lo);
    let [centre, half] = span.line();
    let place = |v: f64| Place { panel: index, x: ((v - centre) / half).clamp(-1.0, 1.0) };
    let over = |from: f64, to: f64, f: &dyn Fn(f64) -> f64| -> f64 {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        half * rule.iter().map(|[x, weight]| weight * f(middle + half * x)).sum::<f64>()
    };
    let variable = |a: f64| match span.variable {
        Variable::Radius => a,
        Variable::Root { base } => (a - base).max(0.0).sqrt(),
        Variable::Fifth => pow(a / span.hi, 0.2),
    };
    let by_variable = |v: f64| panels.slope_by_variable(place(v));
    let radius = |v: f64| span.radius(place(v).x);
    match span.variable {
        _ if far => over(variable(lo), variable(hi), &|v| {
            let a = radius(v);
            by_variable(v) / ((a - r) * (a + r)).sqrt()
        }),
        // y² = a − b around a − r: y = √(b − r) sinh t, or √(r − b) cosh t, leaves dt.
        Variable::Root { base } if (base - r).abs() > 0.0 => {
            let unit = (base - r).abs().sqrt();
            let angle = |a: f64| {
                let ratio = variable(a) / unit;
                if base > r { asinh(ratio) } else { acosh(ratio.max(1.0)) }
            };
            over(angle(lo), angle(hi), &|t| {
                let y = unit * if base > r { sinh(t) } else { cosh(t) };
                by_variable(y) / (base + y * y + r).sqrt()
            })
        }
        // z² = a − r.
        _ => over((lo - r).sqrt(), (hi - r).sqrt(), &|z| {
            let a = r + z * z;
            let at = place(variable(a));
            let slope = panels.weighted_slope(at) / if panel.is_steep() { span.stretch(at.x) } else { 1.0 };
            2.0 * slope / (a + r).sqrt()
        }),
    }
}

/// The intervals of radii beyond `s` in which g < δ, ascending, as far as the panels reach; panel by panel.
pub fn below(panels: &Panels, s: f64, delta: f64, end: f64) -> Vec<(usize, [f64; 2])> {
    let mut found = Vec::new();
    let from = panels.place(s);
    for (index, panel) in panels.list().iter().enumerate().skip(from.panel) {
        if panel.span.lo >= end {
            break;
        }
        let start = if index == from.panel { from.x } else { -1.0 };
        let mut series = panels.value_series(index);
        let size: f64 = series.iter().map(|c| c.abs()).sum();
        series[0] -= delta;
        let mut edges = vec![start];
        edges.extend(
            chebyshev::roots(&series, ROUNDING * size).into_iter().filter(|x| *x > start && *x < 1.0),
        );
        edges.push(1.0);
        for pair in edges.windows(2) {
            if pair[1] > pair[0] && chebyshev::sum(&series, 0.5 * (pair[0] + pair[1])) < -ROUNDING * size {
                found.push((index, [pair[0], pair[1]]));
            }
        }
    }
    found
}

/// A place `[r, gap]` where the gap around the disc is below `overlap`. Where the gap may be negative on very many panels,
/// a few of them are looked at. `None` proves nothing: then only [`least_gap`] tells.
pub fn overlap_on_many(panels: &Panels, s: f64, delta: f64, end: f64, overlap: f64) -> Option<[f64; 2]> {
    /// More panels than this are many, of which about so many are looked at.
    const MANY: usize = 64;
    const LOOKED_AT: usize = 16;
    let pieces = below(panels, s, delta, end);
    let in_middle = |(index, [lo, hi]): &(usize, [f64; 2])| {
        let radius = panels.radius(Place { panel: *index, x: 0.5 * (lo + hi) });
        [radius, gap_from(panels, s, delta, radius)]
    };
    let step = (pieces.len() / LOOKED_AT).max(1);
    let looked = pieces.iter().rev().step_by(step).filter(|_| pieces.len() > MANY).map(in_middle);
    looked.min_by(|a, b| a[1].total_cmp(&b[1])).filter(|[_, gap]| *gap < overlap)
}

/// What a search for the smallest gap has found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastGap {
    /// Where the gap is smallest and how large it is there, `[r, gap]`; `None` where g stays above δ: the bodies stay apart.
    pub at: Option<[f64; 2]>,
    /// The radius at which the search was given up, if it was.
    pub given_up: Option<f64>,
}

/// The smallest gap around the disc among the radii at which it can first become negative.
///
/// Once the gap is below `overlap`, only a few more crests are examined; otherwise no more than about a hundred. The
/// panels must reach to `end`. Where `progress` says stop, the search is given up.
pub fn least_gap(
    panels: &Panels,
    s: f64,
    delta: f64,
    end: f64,
    overlap: f64,
    progress: &dyn Progress,
) -> LeastGap {
    let first = panels.place(s).panel;
    let mut work = 0;
    let pieces = below(panels, s, delta, end);
    let on = |piece: &(usize, [f64; 2])| least_on(panels, s, delta, piece.0, piece.1, HALVINGS);
    let smallest = |a: &[f64; 2], b: &[f64; 2]| a[1].total_cmp(&b[1]);
    let mut least: Option<[f64; 2]> = None;
    let mut left = CRESTS;
    for run in pieces.chunk_by(|(a, before), (b, after)| b - a <= 1 && before[1] >= 1.0 && after[0] <= -1.0) {
        if progress.stop() {
            return LeastGap { at: least, given_up: Some(s) };
        }
        let here = if run.len() <= MANY {
            run.iter().map(on).min_by(smallest)
        } else {
            let sampled = |(index, [lo, hi]): &(usize, [f64; 2])| {
                let places = [*lo, 0.5 * (lo + hi), *hi];
                let gaps =
                    places.map(|x| gap_from(panels, s, delta, panels.radius(Place { panel: *index, x })));
                gaps.into_iter().fold(f64::INFINITY, f64::min)
            };
            let samples: Vec<f64> = run.iter().map(sampled).collect();
            let at = (0..run.len()).min_by(|a, b| samples[*a].total_cmp(&samples[*b])).unwrap_or(0);
            run[at.saturating_sub(1)..(at + 2).min(run.len())].iter().map(on).min_by(smallest)
        };
        least = least.into_iter().chain(here).min_by(smallest);
        if least.is_some_and(|[_, gap]| gap < overlap) {
            left -= 1;
            if left == 0 {
                break;
            }
        }
        let Some((last, [_, x])) = run.last() else { continue };
        work += run.len().min(MANY) * (last + 1 - first);
        if work > MOST_WORK && left == CRESTS {
            return LeastGap { at: least, given_up: Some(panels.radius(Place { panel: *last, x: *x })) };
        }
    }
    LeastGap { at: least, given_up: None }
}

/// The smallest gap on a piece of a panel: `[r, gap]`.
fn least_on(panels: &Panels, s: f64, delta: f64, index: usize, [lo, hi]: [f64; 2], depth: usize) -> [f64; 2] {
    let span = panels.list()[index].span;
    let radius = |x: f64| span.radius(0.5 * (lo + hi) + 0.5 * (hi - lo) * x);
    let gap = |x: f64| gap_from(panels, s, delta, radius(x));
    let least = |a: [f64; 2], b: [f64; 2]| if b[1] < a[1] { b } else { a };
    let series = ChebyshevRule::of(SEARCHED).series(gap);
    let largest = series.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    let tail: f64 = series.iter().rev().take(3).map(|c| c.abs()).sum();
    if tail > TAIL * largest && depth > 0 {
        let middle = 0.5 * (lo + hi);
        let [left, right] =
            [[lo, middle], [middle, hi]].map(|piece| least_on(panels, s, delta, index, piece, depth - 1));
        return least(left, right);
    }
    let slope = chebyshev::derivative(&series);
    // The series tells where the minima are; the gap itself is computed only at the smallest.
    let inner = chebyshev::roots(&slope, 0.0);
    let by_series = |x: &f64| chebyshev::sum(&series, *x);
    let places = [-1.0, 1.0].into_iter().chain(inner);
    let x = places.min_by(|a, b| by_series(a).total_cmp(&by_series(b))).unwrap_or(0.0);
    [radius(x), gap(x)]
}
