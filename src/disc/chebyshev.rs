//! Chebyshev series on −1 ≤ x ≤ 1: sampling, sums, integrals, products, and roots that cannot be missed.
//!
//! ```text
//! f(x) = Σ c_k T_k(x),   nodes x_j = cos(π(j + ½)/n),   c_k = (2/n) Σ_j f(x_j) cos(πk(j + ½)/n),  c_0 half of that
//! ```
//!
//! Coefficients are slices, lowest first. L. N. Trefethen, *Approximation Theory and Approximation Practice* (SIAM 2013).

use std::f64::consts::PI;
use std::sync::OnceLock;
use wide::f64x4;

/// The most nodes of a rule that is kept.
const MOST: usize = 64;

/// Coefficients of a function whose roots are looked for.
pub const ROOT_NODES: usize = 40;

/// Halvings of an interval in which roots are looked for: below that its ends are neighbours.
const HALVINGS: usize = 52;

/// The n nodes with the matrix from samples to coefficients.
#[derive(Debug)]
pub struct Rule {
    /// Descending.
    pub nodes: Vec<f64>,
    /// By columns: what the sample at node j adds to every coefficient.
    columns: Vec<f64>,
}

impl Rule {
    /// The rule of `n` nodes, 2 to 64; made once.
    pub fn of(n: usize) -> &'static Self {
        static RULES: [OnceLock<Rule>; MOST + 1] = [const { OnceLock::new() }; MOST + 1];
        RULES[n.clamp(2, MOST)].get_or_init(|| Self::new(n.clamp(2, MOST)))
    }

    fn new(n: usize) -> Self {
        let angle = |k: usize, j: usize| {
            // Reduced exactly, so that symmetric nodes are symmetric to the last bit.
            let turns = (k * (2 * j + 1)) % (4 * n);
            let eighth = |t: usize| (PI * t as f64 / (2 * n) as f64).cos();
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

    /// The coefficients of the function with these `samples` at the nodes, into a slice as long.
    pub fn coefficients(&self, samples: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for (sample, column) in samples.iter().zip(self.columns.chunks_exact(self.nodes.len())) {
            for (out, weight) in out.iter_mut().zip(column) {
                *out += sample * weight;
            }
        }
    }

    /// The series of `f` sampled at the nodes.
    pub fn series(&self, f: impl FnMut(f64) -> f64) -> Vec<f64> {
        let samples: Vec<f64> = self.nodes.iter().copied().map(f).collect();
        let mut out = vec![0.0; samples.len()];
        self.coefficients(&samples, &mut out);
        out
    }
}

/// f(x), by Clenshaw's recurrence.
pub fn sum(series: &[f64], x: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    let twice = 2.0 * x;
    for c in series.iter().skip(1).rev() {
        (b1, b2) = (twice * b1 - b2 + c, b1);
    }
    series.first().map_or(0.0, |c| x * b1 - b2 + c)
}

/// f at four places.
pub fn sum4(series: &[f64], x: f64x4) -> f64x4 {
    let (mut b1, mut b2) = (f64x4::ZERO, f64x4::ZERO);
    let twice = x + x;
    for c in series.iter().skip(1).rev() {
        (b1, b2) = (twice * b1 - b2 + f64x4::splat(*c), b1);
    }
    series.first().map_or(f64x4::ZERO, |c| x * b1 - b2 + f64x4::splat(*c))
}

/// f at eight places.
pub fn sum8(series: &[f64], x: &[f64; 8]) -> [f64; 8] {
    let (mut b1, mut b2) = ([0.0; 8], [0.0; 8]);
    for c in series.iter().skip(1).rev() {
        for i in 0..8 {
            let b = 2.0 * x[i] * b1[i] - b2[i] + c;
            b2[i] = b1[i];
            b1[i] = b;
        }
    }
    let first = series.first().copied().unwrap_or(0.0);
    std::array::from_fn(|i| x[i] * b1[i] - b2[i] + first)
}

/// f(x) and f'(x).
pub fn sum_and_slope(series: &[f64], x: f64) -> [f64; 2] {
    let (mut b1, mut b2, mut d1, mut d2) = (0.0, 0.0, 0.0, 0.0);
    let twice = 2.0 * x;
    for c in series.iter().skip(1).rev() {
        // The derivative of the recurrence, with the value it has before this step.
        (d1, d2) = (twice * d1 - d2 + 2.0 * b1, d1);
        (b1, b2) = (twice * b1 - b2 + c, b1);
    }
    let first = series.first().copied().unwrap_or(0.0);
    [x * b1 - b2 + first, x * d1 - d2 + b1]
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

/// Coefficients below this share of the largest count for nothing in the search for roots.
const NEGLIGIBLE: f64 = 3e-17;

/// A series of at most [`ROOT_NODES`] coefficients.
#[derive(Debug, Clone, Copy)]
struct Short {
    coefficients: [f64; ROOT_NODES],
    len: usize,
}

impl Short {
    fn new(series: &[f64]) -> Self {
        let largest = series.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        let keep = series.iter().rposition(|c| c.abs() > NEGLIGIBLE * largest).map_or(1, |k| k + 1);
        let mut short = Self { coefficients: [0.0; ROOT_NODES], len: keep.min(ROOT_NODES) };
        short.coefficients[..short.len].copy_from_slice(&series[..short.len]);
        short
    }

    fn series(&self) -> &[f64] {
        &self.coefficients[..self.len]
    }

    /// Whether the constant outweighs the rest: no root.
    fn has_none(&self) -> bool {
        let rest: f64 = self.series()[1..].iter().map(|c| c.abs()).sum();
        self.coefficients[0].abs() > rest
    }

    /// Whether the derivative has no root: monotone.
    fn is_monotone(&self) -> bool {
        // The derivative's coefficients by the recurrence of `derivative`, without their storage.
        let (mut here, mut above, mut rest) = (0.0, 0.0, 0.0_f64);
        for k in (1..self.len).rev() {
            let below = above + 2.0 * k as f64 * self.coefficients[k];
            if k == 1 {
                return (0.5 * below).abs() > rest;
            }
            rest += below.abs();
            (above, here) = (here, below);
        }
        false
    }

    /// The series of the same function on the left and on the right half.
    fn halves(&self) -> [Self; 2] {
        static MATRICES: OnceLock<[Vec<[f64; ROOT_NODES]>; 2]> = OnceLock::new();
        let matrices = MATRICES.get_or_init(|| {
            let rule = Rule::of(ROOT_NODES);
            [-0.5, 0.5].map(|middle| {
                let column = |k: usize| {
                    let mut unit = vec![0.0; k + 1];
                    unit[k] = 1.0;
                    let series = rule.series(|x| sum(&unit, middle + 0.5 * x));
                    let mut column = [0.0; ROOT_NODES];
                    column.copy_from_slice(&series);
                    column
                };
                (0..ROOT_NODES).map(column).collect()
            })
        });
        // A polynomial has the same degree on a half.
        let len = self.len;
        matrices.each_ref().map(|columns| {
            let mut out = [0.0; ROOT_NODES];
            for (c, column) in self.series().iter().zip(columns) {
                for (out, weight) in out[..len].iter_mut().zip(column) {
                    *out += c * weight;
                }
            }
            Self::new(&out[..len])
        })
    }
}

/// The roots of the function of at most [`ROOT_NODES`] coefficients, ascending; a double root counts as none, or two.
///
/// Where all values are below `rounding` there are none. An interval on which the constant outweighs all other coefficients
/// has none; one on which that holds for the derivative is monotone, and its ends tell; any other is halved.
pub fn roots(series: &[f64], rounding: f64) -> Vec<f64> {
    let mut roots = Vec::new();
    // A function that is no number has no roots, and would be halved for ever.
    if series.iter().all(|c| c.is_finite()) {
        let short = Short::new(series);
        let ends = [-1.0, 1.0].map(|x| sum(short.series(), x) > 0.0);
        within(&short, [-1.0, 1.0], ends, 0, rounding, &mut roots);
    }
    roots
}

/// Adds the roots from `lo` to `hi`; `ends` says whether the function is positive there. Halves share the sign of their border,
/// so that rounding there makes no roots and loses none.
fn within(
    short: &Short,
    [lo, hi]: [f64; 2],
    ends: [bool; 2],
    depth: usize,
    rounding: f64,
    roots: &mut Vec<f64>,
) {
    if short.has_none() && ends[0] == ends[1] {
        return;
    }
    let series = short.series();
    let size: f64 = series.iter().map(|c| c.abs()).sum();
    let middle = 0.5 * (lo + hi);
    if depth >= HALVINGS || size <= rounding || short.is_monotone() || short.has_none() {
        if ends[0] != ends[1] {
            roots.push(middle + 0.5 * (hi - lo) * bracketed(series, ends[1]));
        }
        return;
    }
    let between = sum(series, 0.0) > 0.0;
    let [left, right] = short.halves();
    within(&left, [lo, middle], [ends[0], between], depth + 1, rounding, roots);
    within(&right, [middle, hi], [between, ends[1]], depth + 1, rounding, roots);
}

/// The root between −1 and 1 of a monotone function that is `rising`: Newton kept in its bracket.
fn bracketed(series: &[f64], rising: bool) -> f64 {
    let (mut lo, mut hi, mut x) = (-1.0, 1.0, 0.0);
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
        if (next - x).abs() <= 4.0 * f64::EPSILON || next <= lo || next >= hi {
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

    #[test]
    fn a_series_is_its_function_with_its_derivative_and_integrals() {
        let f = |x: f64| (1.3 * x).exp() + (2.0 * x).sin();
        let series = Rule::of(24).series(f);
        let twice = times_line(&series, 0.3, -1.7);
        let (slope, area, square) = (derivative(&series), integral(&series), square(&series));
        for i in -10..=10 {
            let x = f64::from(i) / 10.0;
            let exact = 1.3 * (1.3 * x).exp() + 2.0 * (2.0 * x).cos();
            assert!(
                close(sum(&series, x), f(x)) && close(sum4(&series, f64x4::splat(x)).to_array()[2], f(x))
            );
            assert!(close(sum8(&series, &[x; 8])[5], f(x)));
            assert!(
                (sum(&slope, x) - exact).abs() < 1e-12
                    && (sum_and_slope(&series, x)[1] - exact).abs() < 1e-12
            );
            assert!(close(sum_and_slope(&series, x)[0], f(x)));
            let primitive = |x: f64| (1.3 * x).exp() / 1.3 - 0.5 * (2.0 * x).cos();
            assert!(close(sum(&area, x), primitive(x) - primitive(-1.0)), "{x}");
            assert!(close(sum(&twice, x), (0.3 - 1.7 * x) * f(x)));
            assert!(close(sum(&square, x), f(x) * f(x)), "{x}");
        }
        assert!(chop(series.clone(), 1e-6).len() < series.len());
    }

    #[test]
    fn roots_are_all_found() {
        let series = |f: &dyn Fn(f64) -> f64| Rule::of(ROOT_NODES).series(f);
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
