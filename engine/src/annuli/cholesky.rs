//! Symmetric positive definite systems, A = `UᵀU` by rows, four pivots at a time.

use nalgebra::{DMatrix, Dyn, LU};
use wide::f64x4;

/// A matrix factored and ready for right-hand sides.
#[derive(Debug, Clone)]
pub enum Factorization {
    /// `UᵀU`.
    Cholesky(Vec<f64>),
    /// With pivoting: between breaks of a gap the sums need not be positive definite.
    Pivoted(Box<LU<f64, Dyn, Dyn>>),
}

impl Factorization {
    /// Factors the `n`×`n` matrix with this upper triangle, by rows; `definite` where it must be positive definite.
    /// `None` where it is singular.
    pub fn of(mut matrix: Vec<f64>, n: usize, definite: bool) -> Option<Self> {
        if definite {
            return factorize(&mut matrix, n).then_some(Self::Cholesky(matrix));
        }
        let full = DMatrix::from_fn(n, n, |i, k| matrix[i.min(k) * n + i.max(k)]);
        let lu = full.lu();
        (lu.is_invertible() && matrix.iter().all(|x| x.is_finite())).then(|| Self::Pivoted(Box::new(lu)))
    }

    /// Solves for four right-hand sides at once, in place.
    pub fn solve(&self, x: &mut [f64x4]) {
        match self {
            Self::Cholesky(u) => solve(u, x.len(), x),
            Self::Pivoted(lu) => {
                let mut columns = DMatrix::from_fn(x.len(), 4, |i, k| x[i].as_array()[k]);
                lu.solve_mut(&mut columns);
                for (i, x) in x.iter_mut().enumerate() {
                    *x = f64x4::new(std::array::from_fn(|k| columns[(i, k)]));
                }
            }
        }
    }
}

/// Pivots eliminated together.
const BLOCK: usize = 4;

/// Replaces the upper triangle of the `n`×`n` matrix, stored by rows, by U with the reciprocals of its diagonal; `n` is a multiple of
/// four. False where it is not positive definite.
fn factorize(a: &mut [f64], n: usize) -> bool {
    for j in (0..n).step_by(BLOCK) {
        let (done, rest) = a.split_at_mut((j + BLOCK) * n);
        let rows = &mut done[j * n..];
        for p in 0..BLOCK {
            let (above, row) = rows.split_at_mut(p * n);
            let row = &mut row[..n];
            for above in above.chunks_exact(n) {
                let factor = above[j + p];
                for (x, u) in row[j + p..].iter_mut().zip(&above[j + p..]) {
                    *x -= factor * u;
                }
            }
            let pivot = row[j + p];
            // Written so that NaN fails.
            if !(pivot > 0.0 && pivot.is_finite()) {
                return false;
            }
            let scale = pivot.sqrt().recip();
            for x in &mut row[j + p..] {
                *x *= scale;
            }
            row[j + p] = scale;
        }
        let (r0, tail) = rows.split_at(n);
        let (r1, tail) = tail.split_at(n);
        let (r2, r3) = tail.split_at(n);
        for (i, row) in rest.chunks_exact_mut(n).enumerate() {
            let i = j + BLOCK + i;
            // Starts at the last multiple of four up to the diagonal: entries below the diagonal are never read.
            let from = i & !3;
            let u = [r0[i], r1[i], r2[i], r3[i]].map(f64x4::splat);
            let fours = row[from..].as_chunks_mut::<4>().0.iter_mut();
            let [p0, p1, p2, p3] = [r0, r1, r2, r3].map(|r| r[from..].as_chunks::<4>().0.iter());
            for ((((x, a), b), c), d) in fours.zip(p0).zip(p1).zip(p2).zip(p3) {
                let sum = (u[0] * f64x4::new(*a) + u[1] * f64x4::new(*b))
                    + (u[2] * f64x4::new(*c) + u[3] * f64x4::new(*d));
                *x = (f64x4::new(*x) - sum).to_array();
            }
        }
    }
    true
}

/// Solves for four right-hand sides at once, in place, as many unknowns at a time as pivots are eliminated together; `n` is a
/// multiple of four.
fn solve(u: &[f64], n: usize, x: &mut [f64x4]) {
    let rows = |j: usize| -> [&[f64]; BLOCK] { std::array::from_fn(|p| &u[(j + p) * n..(j + p + 1) * n]) };
    for j in (0..n).step_by(BLOCK) {
        let rows = rows(j);
        let (head, tail) = x.split_at_mut(j + BLOCK);
        let head = &mut head[j..];
        for p in 0..BLOCK {
            let above = (0..p).fold(head[p], |left, q| left - head[q] * f64x4::splat(rows[q][j + p]));
            head[p] = above * f64x4::splat(rows[p][j + p]);
        }
        let [a, b, c, d] = rows.map(|row| &row[j + BLOCK..]);
        for (x, (((a, b), c), d)) in tail.iter_mut().zip(a.iter().zip(b).zip(c).zip(d)) {
            let [a, b, c, d] = [a, b, c, d].map(|u| f64x4::splat(*u));
            *x -= (head[0] * a + head[1] * b) + (head[2] * c + head[3] * d);
        }
    }
    for j in (0..n).step_by(BLOCK).rev() {
        let rows = rows(j);
        let (head, tail) = x.split_at_mut(j + BLOCK);
        let head = &mut head[j..];
        let [a, b, c, d] = rows.map(|row| &row[j + BLOCK..]);
        for (x, (((a, b), c), d)) in tail.iter().zip(a.iter().zip(b).zip(c).zip(d)) {
            for (head, u) in head.iter_mut().zip([a, b, c, d]) {
                *head -= *x * f64x4::splat(*u);
            }
        }
        for p in (0..BLOCK).rev() {
            let below = (p + 1..BLOCK).fold(head[p], |left, q| left - head[q] * f64x4::splat(rows[p][j + q]));
            head[p] = below * f64x4::splat(rows[p][j + p]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_positive_definite_system_is_solved_and_another_refused() {
        for n in [4, 12, 28] {
            let entry =
                |i: usize, j: usize| 1.0 / (1.0 + i.abs_diff(j) as f64) + if i == j { 2.0 } else { 0.0 };
            let mut a: Vec<f64> = (0..n * n).map(|k| entry(k / n, k % n)).collect();
            let exact: Vec<f64x4> = (0..n).map(|k| f64x4::new([k as f64, 1.0, -(k as f64), 0.5])).collect();
            let mut x: Vec<f64x4> = (0..n)
                .map(|i| (0..n).fold(f64x4::ZERO, |sum, j| sum + exact[j] * f64x4::splat(entry(i, j))))
                .collect();
            assert!(factorize(&mut a, n));
            solve(&a, n, &mut x);
            for (x, exact) in x.iter().zip(&exact) {
                for (x, exact) in x.to_array().iter().zip(exact.to_array()) {
                    assert!((x - exact).abs() < 1e-12, "{n}");
                }
            }
        }
        let mut indefinite: Vec<f64> = (0..16).map(|k| if k % 5 == 0 { 1.0 } else { 2.0 }).collect();
        assert!(!factorize(&mut indefinite, 4));
    }
}
