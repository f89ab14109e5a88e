//! Chebyshev series on −1 ≤ x ≤ 1: sampling, sums, integrals, products, and roots that cannot be missed.
//!
//! ```text
//! f(x) = Σ c_k T_k(x),   nodes x_j = cos(π(j + ½)/n),   c_k = (2/n) Σ_j f(x_j) cos(πk(j + ½)/n),  c_0 half of that
//! ```
//!
//! Coefficients are slices, lowest first. L. N. Trefethen, *Approximation Theory and Approximation Practice* (SIAM 2013).

use crate::elementary::cos;
use std::f64::consts::PI;
use std::sync::OnceLock;
use wide::f64x4;

/// The most nodes of a rule that is kept.
const MOST: usize = 64;

/// Nodes that resolve √a and any power of a gap on every panel but the innermost.
pub const ROOT_NODES: usize = 40;

/// The n nodes with the matrix from samples to coefficients.
#[derive(Debug)]
pub struct ChebyshevRule {
    /// Descending.
    pub nodes: Vec<f64>,
    /// By columns: what the sample at node j adds to every coefficient.
    columns: Vec<f64>,
}

impl ChebyshevRule {
    /// The rule of `n` nodes, 2 to 64; made once.
    pub fn of(n: usize) -> &'static Self {
        static RULES: [OnceLock<ChebyshevRule>; MOST + 1] = [const { OnceLock::new() }; MOST + 1];
        RULES[n.clamp(2, MOST)].get_or_init(|| Self::new(n.clamp(2, MOST)))
    }

    fn new(n: usize) -> Self {
        let angle = |k: usize, j: usize| {
            // Reduced exactly, so that symmetric nodes are symmetric to the last bit.
            let turns = (k * (2 * j + 1)) % (4 * n);
            let eighth = |t: usize| cos(PI * t as f64 / (2 * n) as f64);
            match turns {
                t if t == n || t == 3 * n => 0.0,
                t if t < n => eighth(t),
                t if t < 2 * n => -eighth(2 * n - t),
                t if t < 3 * n => -eighth(t - 2 * n),
                t => eighth(4 * n - t),
            }
        };
        let nodes = (0..n).map(|j| angle(1, j)).collect();
        let weight = |k: usize| if k == 0 { 1.0 } else { 2.0 } / n as f64;
        let columns = (0..n).flat_map(|j| (0..n).map(move |k| weight(k) * angle(k, j))).collect();
        Self { nodes, columns }
    }

    /// The coefficients of the function with these `samples` at the nodes, into a slice of the same length.
    pub fn coefficients(&self, samples: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for (sample, column) in samples.iter().zip(self.columns.chunks_exact(self.nodes.len())) {
            for (out, weight) in out.iter_mut().zip(column) {
                *out += sample * weight;
            }
        }
    }

    /// The weight of node `j` in a sum over the nodes that is exact for every polynomial they resolve. `moments` are
    /// the values of the exact sum for the Chebyshev polynomials, the constant first.
    pub fn weight(&self, j: usize, moments: &[f64]) -> f64 {
        let n = self.nodes.len();
        self.columns[j * n..(j + 1) * n].iter().zip(moments).map(|(c, moment)| c * moment).sum()
    }

    /// The series of `f` sampled at the nodes.
    pub fn series(&self, f: impl FnMut(f64) -> f64) -> Vec<f64> {
        let samples: Vec<f64> = self.nodes.iter().copied().map(f).collect();
        let mut out = vec![0.0; samples.len()];
        self.coefficients(&samples, &mut out);
        out
    }
}

/// f(x), by Clenshaw's recurrence, grouped so that a term waits for the previous one with one product and one sum only.
pub fn sum(series: &[f64], x: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    let twice = 2.0 * x;
    for c in series.iter().skip(1).rev() {
        (b1, b2) = (twice * b1 + (c - b2), b1);
    }
    series.first().map_or(0.0, |c| x * b1 - b2 + c)
}

/// f at four places.
pub fn sum4(series: &[f64], x: f64x4) -> f64x4 {
    let (mut b1, mut b2) = (f64x4::ZERO, f64x4::ZERO);
    let twice = x + x;
    for c in series.iter().skip(1).rev() {
        (b1, b2) = (twice * b1 + (f64x4::splat(*c) - b2), b1);
    }
    series.first().map_or(f64x4::ZERO, |c| x * b1 - b2 + f64x4::splat(*c))
}

/// Several functions at some places, all side by side: one alone would wait for each of its terms.
pub fn sums<const M: usize, const N: usize>(series: [&[f64]; M], x: &[f64; N]) -> [[f64; N]; M] {
    let (mut b1, mut b2) = ([[0.0; N]; M], [[0.0; N]; M]);
    let longest = series.iter().map(|series| series.len()).max().unwrap_or(0);
    for k in (1..longest).rev() {
        for (j, series) in series.iter().enumerate() {
            let c = series.get(k).copied().unwrap_or(0.0);
            for i in 0..N {
                let b = 2.0 * x[i] * b1[j][i] + (c - b2[j][i]);
                b2[j][i] = b1[j][i];
                b1[j][i] = b;
            }
        }
    }
    std::array::from_fn(|j| {
        let first = series[j].first().copied().unwrap_or(0.0);
        std::array::from_fn(|i| x[i] * b1[j][i] - b2[j][i] + first)
    })
}

/// f(x) and f'(x).
pub fn sum_and_slope(series: &[f64], x: f64) -> [f64; 2] {
    let (mut b1, mut b2, mut d1, mut d2) = (0.0, 0.0, 0.0, 0.0);
    let twice = 2.0 * x;
    for c in series.iter().skip(1).rev() {
        // The derivative of the recurrence, with the value it has before this step.
        (d1, d2) = (twice * d1 + (2.0 * b1 - d2), d1);
        (b1, b2) = (twice * b1 + (c - b2), b1);
    }
    let first = series.first().copied().unwrap_or(0.0);
    [x * b1 - b2 + first, x * d1 - d2 + b1]
}

/// f(x), f'(x) and f''(x).
pub fn sum_and_slopes(series: &[f64], x: f64) -> [f64; 3] {
    let [mut b1, mut b2, mut d1, mut d2, mut e1, mut e2] = [0.0; 6];
    let twice = 2.0 * x;
    for c in series.iter().skip(1).rev() {
        // The derivatives of the recurrence, each with the value that the previous one has before this step.
        (e1, e2) = (twice * e1 - e2 + 4.0 * d1, e1);
        (d1, d2) = (twice * d1 + (2.0 * b1 - d2), d1);
        (b1, b2) = (twice * b1 + (c - b2), b1);
    }
    let first = series.first().copied().unwrap_or(0.0);
    [x * b1 - b2 + first, x * d1 - d2 + b1, x * e1 - e2 + 2.0 * d1]
}

/// The series of f'.
pub fn derivative(series: &[f64]) -> Vec<f64> {
    let n = series.len();
    let mut out = vec![0.0; n.saturating_sub(1).max(1)];
    let mut above = [0.0, 0.0];
    for k in (1..n).rev() {
        let here = above[1] + 2.0 * k as f64 * series[k];
        out[k - 1] = here;
        above = [here, above[0]];
    }
    out[0] *= 0.5;
    out
}

/// The series of ∫₋₁ˣ f dx.
pub fn integral(series: &[f64]) -> Vec<f64> {
    let n = series.len();
    let at = |k: usize| series.get(k).copied().unwrap_or(0.0);
    let mut out = vec![0.0; n + 1];
    for (k, out) in out.iter_mut().enumerate().skip(1) {
        let below = if k == 1 { 2.0 * at(0) } else { at(k - 1) };
        *out = (below - at(k + 1)) / (2.0 * k as f64);
    }
    // Zero at x = −1, where T_k is (−1)ᵏ.
    out[0] = out.iter().enumerate().skip(1).map(|(k, c)| if k % 2 == 1 { *c } else { -c }).sum();
    out
}

/// The series of (p + q x) f.
pub fn times_line(series: &[f64], p: f64, q: f64) -> Vec<f64> {
    let mut out = vec![0.0; series.len() + 1];
    for (k, c) in series.iter().enumerate() {
        out[k] += p * c;
        if k == 0 {
            out[1] += q * c;
        } else {
            out[k + 1] += 0.5 * q * c;
            out[k - 1] += 0.5 * q * c;
        }
    }
    out
}

/// The series of f².
pub fn square(series: &[f64]) -> Vec<f64> {
    let n = series.len();
    let mut out = vec![0.0; 2 * n];
    // T_i T_j = (T_{i+j} + T_{|i−j|})/2, and every unequal pair counts twice.
    for (i, a) in series.iter().enumerate() {
        out[2 * i] += 0.5 * a * a;
        out[0] += 0.5 * a * a;
        for (b, sum) in series[i + 1..].iter().zip(&mut out[2 * i + 1..]) {
            *sum += a * b;
        }
        for (b, difference) in series[i + 1..].iter().zip(&mut out[1..]) {
            *difference += a * b;
        }
    }
    out
}

/// `series` without the last coefficients that are below `share` of the largest.
pub fn chop(mut series: Vec<f64>, share: f64) -> Vec<f64> {
    let largest = series.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    let keep = series.iter().rposition(|c| c.abs() > share * largest).map_or(1, |k| k + 1);
    series.truncate(keep);
    series
}

/// Where a smooth function is least between two places, and its value there, by its series of `nodes` samples.
pub fn least(nodes: usize, [lo, hi]: [f64; 2], f: impl Fn(f64) -> f64) -> [f64; 2] {
    let (middle, half) = (0.5 * (lo + hi), 0.5 * (hi - lo));
    let series = ChebyshevRule::of(nodes).series(|x| f(middle + half * x));
    let value = |x: f64| sum(&series, x);
    let places = roots(&derivative(&series), 0.0).into_iter().chain([-1.0, 1.0]);
    let x = places.min_by(|a, b| value(*a).total_cmp(&value(*b))).unwrap_or(0.0);
    [middle + half * x, value(x)]
}

/// Parts into which an interval is divided until each has no root or is monotone: their four borders are evaluated side
/// by side.
const PARTS: usize = 5;

/// Trailing coefficients that add up to less than this share of the rounding are ignored.
const NEGLIGIBLE: f64 = 0.01;

/// f and f' at four places.
fn sums_and_slopes(series: &[f64], x: f64x4) -> [f64x4; 2] {
    let [mut b1, mut b2, mut d1, mut d2] = [f64x4::ZERO; 4];
    let twice = x + x;
    for c in series.iter().skip(1).rev() {
        // The derivative of the recurrence, with the value it has before this step.
        (d1, d2) = (twice * d1 + (b1 + b1 - d2), d1);
        (b1, b2) = (twice * b1 + (f64x4::splat(*c) - b2), b1);
    }
    let first = series.first().copied().unwrap_or(0.0);
    [x * b1 - b2 + f64x4::splat(first), x * d1 - d2 + b1]
}

/// An end of an interval in which roots are looked for.
#[derive(Debug, Clone, Copy)]
struct IntervalEnd {
    x: f64,
    value: f64,
    slope: f64,
}

/// On an interval at most this wide, a series that is rounding at the ends and at the borders of the parts is rounding throughout.
const NARROW: f64 = 1e-2;

/// The search for the roots of a series.
struct RootSearch<'a> {
    series: &'a [f64],
    /// A bound of |f''|, by `|T_k''| ≤ k²(k² − 1)/3`.
    bend: f64,
    rounding: f64,
    /// That of the sum itself: where the terms cancel to less, signs are chance.
    own: f64,
    roots: Vec<f64>,
}

/// The roots of the function, ascending; a double root counts as none, or two.
///
/// Where all values are below `rounding` there are none. With |f''| ≤ M, an interval of width w has no root where f has
/// one sign at its ends and is larger there than M w²/8. It is monotone, so that its ends decide, where the mean of f'
/// at its ends is larger than M w/2. Any other interval is divided.
pub fn roots(series: &[f64], rounding: f64) -> Vec<f64> {
    // A function that is not a number has no roots, and would be divided for ever.
    if series.iter().any(|c| !c.is_finite()) {
        return Vec::new();
    }
    let mut tail = 0.0;
    let counts = |c: &f64| {
        tail += c.abs();
        tail > NEGLIGIBLE * rounding
    };
    let last = series.iter().rposition(counts).map_or(0, |k| k + 1);
    let series = &series[..last];
    let square = |k: usize| (k * k) as f64;
    let bend = series.iter().enumerate().skip(2).map(|(k, c)| c.abs() * square(k) * (square(k) - 1.0) / 3.0);
    let bend = bend.sum::<f64>();
    // Nor has one whose bounds are beyond all numbers.
    if !bend.is_finite() {
        return Vec::new();
    }
    let own = 4.0 * f64::EPSILON * series.iter().map(|c| c.abs()).sum::<f64>();
    let mut search =
        RootSearch { series, bend, rounding, own: own.max(f64::MIN_POSITIVE), roots: Vec::new() };
    let [lo, hi] = [-1.0, 1.0].map(|x| {
        let [value, slope] = sum_and_slope(series, x);
        IntervalEnd { x, value, slope }
    });
    search.within(lo, hi);
    search.roots
}

impl RootSearch<'_> {
    /// Adds the roots between two ends. Neighbours share the sign at their border, so that rounding there neither makes
    /// nor loses roots.
    fn within(&mut self, lo: IntervalEnd, hi: IntervalEnd) {
        let width = hi.x - lo.x;
        let changes = (lo.value > 0.0) != (hi.value > 0.0);
        let bulge = 0.125 * self.bend * width * width;
        let smallest = lo.value.abs().min(hi.value.abs());
        let largest = lo.value.abs().max(hi.value.abs());
        let is_monotone = (lo.slope + hi.slope).abs() > self.bend * width;
        if is_monotone || smallest > bulge || largest + bulge <= self.rounding || width <= 4.0 * f64::EPSILON
        {
            if changes {
                self.roots.push(bracketed(self.series, [lo.x, hi.x], hi.value > 0.0));
            }
            return;
        }
        let x: [f64; PARTS - 1] = std::array::from_fn(|i| lo.x + width * (i + 1) as f64 / PARTS as f64);
        let [values, slopes] = sums_and_slopes(self.series, f64x4::new(x)).map(f64x4::to_array);
        // At a zero of high order the bound of f'' is far too large, and would lead down to single doubles.
        let largest =
            values.iter().chain(&[lo.value, hi.value]).fold(0.0, |most: f64, value| most.max(value.abs()));
        if width <= NARROW && largest <= self.own {
            if changes {
                self.roots.push(bracketed(self.series, [lo.x, hi.x], hi.value > 0.0));
            }
            return;
        }
        let mut before = lo;
        for i in 0..PARTS {
            let end =
                if i + 1 == PARTS { hi } else { IntervalEnd { x: x[i], value: values[i], slope: slopes[i] } };
            self.within(before, end);
            before = end;
        }
    }
}

/// The root between `lo` and `hi` of a function that is positive only at the upper end, if `rising`, or only at the
/// lower: Newton kept in its bracket.
fn bracketed(series: &[f64], [mut lo, mut hi]: [f64; 2], rising: bool) -> f64 {
    let mut x = 0.5 * (lo + hi);
    for _ in 0..100 {
        let [value, slope] = sum_and_slope(series, x);
        if (value > 0.0) == rising {
            hi = x;
        } else {
            lo = x;
        }
        let mut next = x - value / slope;
        if !(next > lo && next < hi) {
            next = 0.5 * (lo + hi);
        }
        if (next - x).abs() <= 2.0 * f64::EPSILON || next <= lo || next >= hi {
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-14 * (1.0 + b.abs())
    }

    /// Over much of such a series the terms cancel to rounding.
    #[test]
    fn a_zero_of_high_order_is_searched_in_no_time() {
        let series = ChebyshevRule::of(24).series(|x| (1.0 + x).powi(16) * (x - 0.5));
        let found = roots(&series, 0.0);
        for size in [1e-320, 1e-310, 1e303, 1e306] {
            let scaled: Vec<f64> = series.iter().map(|c| size * c).collect();
            assert!(roots(&scaled, 0.0).len() < 100);
        }
        assert!(found.iter().any(|x| (x - 0.5).abs() < 1e-9) && found.len() < 100, "{found:?}");
    }

    #[test]
    fn a_series_is_its_function_with_its_derivative_and_integrals() {
        let f = |x: f64| (1.3 * x).exp() + (2.0 * x).sin();
        let series = ChebyshevRule::of(24).series(f);
        let twice = times_line(&series, 0.3, -1.7);
        let (slope, area, square) = (derivative(&series), integral(&series), square(&series));
        for i in -10..=10 {
            let x = f64::from(i) / 10.0;
            let exact = 1.3 * (1.3 * x).exp() + 2.0 * (2.0 * x).cos();
            assert!(
                close(sum(&series, x), f(x)) && close(sum4(&series, f64x4::splat(x)).to_array()[2], f(x))
            );
            let [both, shorter] = sums([&series, &slope], &[x; 8]);
            assert!(close(both[5], f(x)) && (shorter[7] - exact).abs() < 1e-12);
            assert!(
                (sum(&slope, x) - exact).abs() < 1e-12
                    && (sum_and_slope(&series, x)[1] - exact).abs() < 1e-12
            );
            assert!(close(sum_and_slope(&series, x)[0], f(x)));
            let [value, first, second] = sum_and_slopes(&series, x);
            let bend = 1.69 * (1.3 * x).exp() - 4.0 * (2.0 * x).sin();
            assert!(close(value, f(x)) && (first - exact).abs() < 1e-12 && (second - bend).abs() < 1e-10);
            let primitive = |x: f64| (1.3 * x).exp() / 1.3 - 0.5 * (2.0 * x).cos();
            assert!(close(sum(&area, x), primitive(x) - primitive(-1.0)), "{x}");
            assert!(close(sum(&twice, x), (0.3 - 1.7 * x) * f(x)));
            assert!(close(sum(&square, x), f(x) * f(x)), "{x}");
        }
        assert!(chop(series.clone(), 1e-6).len() < series.len());
    }

    #[test]
    fn roots_are_all_found() {
        let series = |f: &dyn Fn(f64) -> f64| ChebyshevRule::of(ROOT_NODES).series(f);
        for (f, expected) in [
            (&(|x: f64| x - 0.3) as &dyn Fn(f64) -> f64, &[0.3][..]),
            (&|x| (x - 0.3) * (x - 0.300_01) * (x + 0.9), &[-0.9, 0.3, 0.300_01]),
            (&|x| x * x + 1e-9, &[]),
            (&|x| (4.0 * x).sin(), &[-std::f64::consts::FRAC_PI_4, 0.0, std::f64::consts::FRAC_PI_4]),
            (&|x| x * x * x, &[0.0]),
            (&|_| 1e-15, &[]),
        ] {
            let found = roots(&series(f), 1e-15);
            assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-4
                        || expected.abs() < 0.31 && (found - expected).abs() < 1e-5,
                    "{found} {expected}"
                );
            }
        }
        assert!(roots(&[0.0, f64::NAN], 0.0).is_empty());
    }
}
