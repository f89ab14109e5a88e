//! The even cubic spline through given rows, or near them.
//!
//! Of all even functions f, known at the radii 0 ≤ r₀ < … < rₙ, the one for which
//!
//! ```text
//! Σ wᵢ (yᵢ − f(rᵢ))² + (Λ/2π)⁴ ∫₀^{rₙ} f''² dr      is smallest,
//! ```
//!
//! Here wᵢ is the [width](widths) of the cell of rᵢ: the sum is an integral, so the result does not depend on how
//! densely the rows were measured. The spline passes a wave of length λ with the share 1/(1 + (Λ/λ)⁴), half of it at
//! the cutoff λ = Λ; this is the spline filter of ISO 16610-22. Λ = 0 interpolates.
//!
//! f is a cubic between neighbours, has two continuous derivatives, and f'' = 0 at the last radius. With dᵢ = rᵢ₊₁ − rᵢ
//! and p = (Λ/2π)⁴, its second derivatives mᵢ and values gᵢ obey
//!
//! ```text
//! (R + p QᵀW⁻¹Q) m = Qᵀy,   g = y − p W⁻¹Q m                              C. H. Reinsch, Numer. Math. 10, 177 (1967)
//! (Qᵀy)ᵢ = (yᵢ₊₁ − yᵢ)/dᵢ − (yᵢ − yᵢ₋₁)/dᵢ₋₁,   Rᵢᵢ = (dᵢ₋₁ + dᵢ)/3,   Rᵢ,ᵢ₊₁ = dᵢ/6
//! ```
//!
//! Because of the mirror image at −r, half of the equations remain: row 0 has (y₁ − y₀)/d₀ and R₀₀ = r₀ + d₀/3, whether
//! r₀ = 0 or not. The matrix has five diagonals and is positive definite; factoring it as `LDLᵀ` takes time in
//! proportion to the number of rows.
//!
//! How much to smooth, if not specified: for white noise of unknown size, Λ is where the score of generalized
//! cross-validation, N Σ w(y − g)²/tr(I − A)², g = Ay, is smallest. The trace needs only the five diagonals of the
//! inverse. P. Craven and G. Wahba, Numer. Math. 31, 377 (1979), doi:10.1007/BF01404567; M. F. Hutchinson and F. R. de
//! Hoog, Numer. Math. 47, 99 (1985), doi:10.1007/BF01389878.
//!
//! No crate is used: those found offer neither a symmetry condition nor a third derivative, and those that smooth bring
//! in general sparse matrices.

use crate::elementary::pow;
use crate::gap::Jet;
use std::f64::consts::TAU;

/// The number of cutoffs tried between the smallest and the largest before the best is refined.
const TRIED: u8 = 16;

/// Golden-section steps on the interval around the best, to a few percent of the cutoff; a finer cutoff makes no
/// difference.
const REFINED: u8 = 8;

/// Five diagonals of a symmetric matrix: the entries (i, i), (i, i + 1), (i, i + 2).
type Bands = Vec<[f64; 3]>;

/// The rows as the spline sees them.
#[derive(Debug)]
pub struct SplineRows<'a> {
    radii: &'a [f64],
    values: &'a [f64],
    /// wᵢ, one for each row.
    weights: &'a [f64],
    /// The entries (i, i−1), (i, i), (i, i+1) of Qᵀ; there is one row fewer than there are radii.
    second_difference: Vec<[f64; 3]>,
    /// R.
    stiffness: Bands,
    /// QᵀW⁻¹Q.
    filter: Bands,
}

/// A fitted spline.
#[derive(Debug)]
pub struct SplineFit {
    /// m, its second derivative at every radius.
    pub second: Vec<f64>,
    /// g, its value at every radius.
    pub values: Vec<f64>,
    /// The score of generalized cross-validation; NaN when it interpolates.
    score: f64,
}

impl<'a> SplineRows<'a> {
    /// The rows `values` at `radii`, which ascend from 0 or above, with their weights; there must be at least three.
    pub fn new(radii: &'a [f64], values: &'a [f64], weights: &'a [f64]) -> Self {
        let n = radii.len() - 1;
        let d: Vec<f64> = radii.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let second_difference: Vec<[f64; 3]> = (0..n)
            .map(|i| {
                let (left, right) = (if i == 0 { 0.0 } else { d[i - 1].recip() }, d[i].recip());
                [left, -(left + right), right]
            })
            .collect();
        let band = |bands: &mut dyn FnMut(usize) -> [f64; 3]| (0..n).map(bands).collect();
        let stiffness = band(&mut |i| {
            let inner = if i == 0 { 3.0 * radii[0] } else { d[i - 1] };
            [(inner + d[i]) / 3.0, if i + 1 < n { d[i] / 6.0 } else { 0.0 }, 0.0]
        });
        let (q, w) = (&second_difference, weights);
        let filter = band(&mut |i| {
            let [left, middle, right] = q[i];
            let inner = if i == 0 { 0.0 } else { left * left / w[i - 1] };
            let next = q.get(i + 1).map_or(0.0, |n| middle * n[0] / w[i] + right * n[1] / w[i + 1]);
            let second = q.get(i + 2).map_or(0.0, |n| right * n[0] / w[i + 1]);
            [inner + middle * middle / w[i] + right * right / w[i + 1], next, second]
        });
        Self { radii, values, weights, second_difference, stiffness, filter }
    }

    /// wᵢ.
    pub fn weights(&self) -> &[f64] {
        self.weights
    }

    /// The spline of cutoff Λ; `None` when the equations cannot be solved in floating point.
    pub fn fit(&self, cutoff: f64) -> Option<SplineFit> {
        let penalty = (cutoff / TAU).powi(4);
        let matrix = self.stiffness.iter().zip(&self.filter);
        let matrix: Bands = matrix.map(|(r, s)| std::array::from_fn(|k| r[k] + penalty * s[k])).collect();
        let factor = factor(&matrix)?;
        let y = self.values;
        let load = |i: usize| {
            let outer = (y[i + 1] - y[i]) * self.second_difference[i][2];
            if i == 0 { outer } else { outer - (y[i] - y[i - 1]) * self.second_difference[i][0] }
        };
        let mut second = solve(&factor, (0..self.second_difference.len()).map(load).collect());
        let mut moved = vec![0.0; y.len()];
        for (i, (m, [left, middle, right])) in second.iter().zip(&self.second_difference).enumerate() {
            if i > 0 {
                moved[i - 1] += left * m;
            }
            moved[i] += middle * m;
            moved[i + 1] += right * m;
        }
        for (moved, weight) in moved.iter_mut().zip(self.weights) {
            *moved *= penalty / weight;
        }
        let values = y.iter().zip(&moved).map(|(y, moved)| y - moved).collect();
        let removed: f64 = moved.iter().zip(self.weights).map(|(x, w)| w * x * x).sum();
        let trace = penalty * trace_of_product(&factor, &self.filter);
        // The last one is f'' = 0.
        second.push(0.0);
        Some(SplineFit { second, values, score: y.len() as f64 * removed / (trace * trace) })
    }

    /// The cutoff between `least` and `most` with the smallest score.
    pub fn cutoff(&self, least: f64, most: f64) -> f64 {
        let score = |place: f64| {
            let score = self.fit(least * pow(most / least, place)).map_or(f64::INFINITY, |fit| fit.score);
            if score.is_nan() { f64::INFINITY } else { score }
        };
        let step = 1.0 / f64::from(TRIED);
        let best = (0..=TRIED)
            .map(|i| f64::from(i) * step)
            .map(|place| (place, score(place)))
            .fold((0.0, f64::INFINITY), |best, here| if here.1 < best.1 { here } else { best })
            .0;
        let (mut from, mut to) = ((best - step).max(0.0), (best + step).min(1.0));
        let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
        let places = |from: f64, to: f64| (to - ratio * (to - from), from + ratio * (to - from));
        let (mut a, mut b) = places(from, to);
        let (mut at_a, mut at_b) = (score(a), score(b));
        for _ in 0..REFINED {
            if at_a <= at_b {
                to = b;
                (b, at_b) = (a, at_a);
                a = places(from, to).0;
                at_a = score(a);
            } else {
                from = a;
                (a, at_a) = (b, at_b);
                b = places(from, to).1;
                at_b = score(b);
            }
        }
        least * pow(most / least, 0.5 * (from + to))
    }

    /// The cubic from each radius to the next, as its jet at the first of the two.
    pub fn pieces(&self, fit: &SplineFit) -> Vec<Jet> {
        let (g, m) = (&fit.values, &fit.second);
        self.radii
            .windows(2)
            .enumerate()
            .map(|(i, pair)| {
                let d = pair[1] - pair[0];
                let first = (g[i + 1] - g[i]) / d - d * (2.0 * m[i] + m[i + 1]) / 6.0;
                Jet { value: g[i], first, second: m[i], third: (m[i + 1] - m[i]) / d }
            })
            .collect()
    }
}

/// The width of the cell of each radius: from the middle between it and one neighbour to the middle on the other side.
/// The cell of the first radius reaches to the axis.
pub fn widths(radii: &[f64]) -> Vec<f64> {
    let half = |i: usize| 0.5 * (radii[i + 1] - radii[i]);
    let inner = |i: usize| if i == 0 { radii[0] } else { half(i - 1) };
    (0..radii.len()).map(|i| inner(i) + if i + 1 < radii.len() { half(i) } else { 0.0 }).collect()
}

/// L and D of `LDLᵀ` as (Dᵢ, Lᵢ₊₁,ᵢ, Lᵢ₊₂,ᵢ).
fn factor(matrix: &Bands) -> Option<Bands> {
    let mut factor: Bands = Vec::with_capacity(matrix.len());
    for (i, &[diagonal, next, second]) in matrix.iter().enumerate() {
        let before = |k: usize| i.checked_sub(k).map_or([0.0; 3], |i| factor[i]);
        let ([d1, e1, f1], [d2, _, f2]) = (before(1), before(2));
        let d = diagonal - d1 * e1 * e1 - d2 * f2 * f2;
        if !(d > 0.0 && d.is_finite()) {
            return None;
        }
        factor.push([d, (next - d1 * e1 * f1) / d, second / d]);
    }
    Some(factor)
}

/// The solution of `LDLᵀx = load`.
fn solve(factor: &Bands, load: Vec<f64>) -> Vec<f64> {
    let mut x = load;
    for i in 0..x.len() {
        if i > 0 {
            x[i] -= factor[i - 1][1] * x[i - 1];
        }
        if i > 1 {
            x[i] -= factor[i - 2][2] * x[i - 2];
        }
    }
    for i in (0..x.len()).rev() {
        let [d, e, f] = factor[i];
        let beyond = |k: usize| x.get(i + k).copied().unwrap_or(0.0);
        x[i] = x[i] / d - e * beyond(1) - f * beyond(2);
    }
    x
}

/// tr(Z·S) for Z the inverse of `LDLᵀ` and the banded symmetric S.
fn trace_of_product(factor: &Bands, matrix: &Bands) -> f64 {
    let mut trace = 0.0;
    // Rows i + 1 and i + 2 of Z: (diagonal, next), diagonal.
    let (mut z1, mut z2) = ([0.0; 2], 0.0);
    for ([d, e, f], [diagonal, next, second]) in factor.iter().zip(matrix).rev() {
        let to_second = -e * z1[1] - f * z2;
        let to_next = -e * z1[0] - f * z1[1];
        let here = d.recip() - e * to_next - f * to_second;
        trace += here * diagonal + 2.0 * (to_next * next + to_second * second);
        z2 = z1[0];
        z1 = [here, to_next];
    }
    trace
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::shapes::split_mix::SplitMix64;

    fn uneven(n: usize, first: f64) -> Vec<f64> {
        let mut random = SplitMix64::new(3);
        let mut r = first;
        (0..n)
            .map(|_| {
                let here = r;
                r += (0.3 + random.unit()) / n as f64;
                here
            })
            .collect()
    }

    /// The jumps of the value and of two derivatives at the inner radii, relative to their sizes.
    fn jumps(radii: &[f64], pieces: &[Jet]) -> f64 {
        let sizes = pieces.iter().fold([0.0_f64; 3], |s, p| {
            [s[0].max(p.value.abs()), s[1].max(p.first.abs()), s[2].max(p.second.abs())]
        });
        let mut worst = 0.0_f64;
        for i in 0..pieces.len() - 1 {
            let (p, n) = (pieces[i], pieces[i + 1]);
            let x = radii[i + 1] - radii[i];
            let value = p.value + x * (p.first + x * (p.second / 2.0 + x * p.third / 6.0));
            let first = p.first + x * (p.second + x * p.third / 2.0);
            let second = p.second + x * p.third;
            worst = worst
                .max((value - n.value).abs() / sizes[0])
                .max((first - n.first).abs() / sizes[1])
                .max((second - n.second).abs() / sizes[2]);
        }
        worst
    }

    #[test]
    fn it_interpolates_with_two_continuous_derivatives_and_an_even_axis() {
        for first in [0.0, 0.004] {
            let radii = uneven(200, first);
            let values: Vec<f64> = radii.iter().map(|r| (9.0 * r).cos()).collect();
            let weights = widths(&radii);
            let rows = SplineRows::new(&radii, &values, &weights);
            let fit = rows.fit(0.0).unwrap();
            assert_eq!(fit.values, values);
            let pieces = rows.pieces(&fit);
            assert!(jumps(&radii, &pieces) < 1e-11);
            // Even: the first radius has the slope of the parabola at the axis.
            let axis = pieces[0].first - fit.second[0] * radii[0];
            assert!(axis.abs() < 1e-11, "{axis}");
            // Fourth order in the interior.
            let d = 1.0 / 200.0;
            for (s, r) in fit.second.iter().zip(&radii).take(150).skip(10) {
                assert!((s + 81.0 * (9.0 * r).cos()).abs() < 9.0_f64.powi(4) * d * d, "{r}");
            }
        }
    }

    #[test]
    fn the_cutoff_passes_one_half() {
        let n = 4000;
        let radii: Vec<f64> = (0..=n).map(|i| f64::from(i) / f64::from(n)).collect();
        for (wavelength, cutoff) in [(0.05, 0.05), (0.05, 0.025), (0.02, 0.04), (0.25, 0.25)] {
            let wave = |r: f64| (TAU * r / wavelength).cos();
            let values: Vec<f64> = radii.iter().map(|&r| wave(r)).collect();
            let fit = SplineRows::new(&radii, &values, &widths(&radii)).fit(cutoff).unwrap();
            let share = 1.0 / (1.0 + (cutoff / wavelength).powi(4));
            for i in (0..2000).step_by(7) {
                let (ours, exact) = (fit.values[i], share * wave(radii[i]));
                assert!((ours - exact).abs() < 2e-4, "{wavelength} {cutoff} {i}: {ours} {exact}");
            }
        }
    }

    #[test]
    fn the_trace_is_that_of_the_whole_matrix() {
        let radii = uneven(12, 0.01);
        let (zeros, weights) = (vec![0.0; 12], widths(&radii));
        let rows = SplineRows::new(&radii, &zeros, &weights);
        let cutoff = 0.4;
        let penalty = (cutoff / TAU).powi(4);
        let matrix: Bands = rows
            .stiffness
            .iter()
            .zip(&rows.filter)
            .map(|(r, s)| std::array::from_fn(|k| r[k] + penalty * s[k]))
            .collect();
        let trace = penalty * trace_of_product(&factor(&matrix).unwrap(), &rows.filter);
        // tr(I − A), column by column: what the fit takes away from a unit at one row.
        let whole: f64 = (0..12)
            .map(|i| {
                let mut unit = zeros.clone();
                unit[i] = 1.0;
                1.0 - SplineRows::new(&radii, &unit, &weights).fit(cutoff).unwrap().values[i]
            })
            .sum();
        assert!((trace / whole - 1.0).abs() < 1e-12, "{trace} {whole}");
    }

    #[test]
    fn cross_validation_finds_the_wave_under_the_noise() {
        let radii = uneven(2000, 0.0);
        let mut random = SplitMix64::new(11);
        let wave = |r: f64| (TAU * r / 0.2).cos();
        // Triangular noise of standard deviation 0.1.
        let noise = 0.1 * 6.0_f64.sqrt();
        let values: Vec<f64> =
            radii.iter().map(|&r| wave(r) + noise * (random.unit() + random.unit() - 1.0)).collect();
        let weights = widths(&radii);
        let rows = SplineRows::new(&radii, &values, &weights);
        let cutoff = rows.cutoff(1e-3, 0.5);
        let fit = rows.fit(cutoff).unwrap();
        let error = radii.iter().zip(&fit.values).map(|(&r, g)| (g - wave(r)).powi(2)).sum::<f64>() / 2000.0;
        println!("cutoff {cutoff}, rms error {}", error.sqrt());
        // A tenth of the noise is left, and no more than that of the wave is lost.
        assert!(error.sqrt() < 0.02, "{cutoff} {}", error.sqrt());
    }
}
