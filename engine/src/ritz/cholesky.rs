//! The Cholesky factor of a symmetric positive definite matrix, by blocks of columns.
//!
//! `A = LLᵀ`. Block k of L follows from the blocks before it ("left-looking"):
//!
//! ```text
//! C   = A[k.., k] − L[k.., ..k] L[k, ..k]ᵀ         one matrix product
//! L_kk = Cholesky of C's first block,  L[k+1.., k] = C[k+1..] L_kk⁻ᵀ
//! ```
//!
//! and L x = b is solved the same way, `x_k = L_kk⁻¹ (b_k − L[k, ..k] x[..k])`, for many b at once. Nearly all the work
//! is matrix products, and the factorization can be stopped between blocks.

use crate::progress::{Progress, Stopped};
use nalgebra::{Cholesky, DMatrix, DVector};
use std::array;
use wide::f64x4;

/// Columns of a block: wide enough for fast products, few enough that a stop takes effect within milliseconds.
pub const BLOCK: usize = 64;

/// With fewer right-hand sides than this, products of blocks are slower than plain substitution.
const MANY: usize = 6;

/// Rows of L that plain substitution takes together: their sums do not depend on each other.
const PANEL: usize = 4;

/// Why there is no factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoFactor {
    /// The matrix is not positive definite.
    #[error("not positive definite")]
    NotPositiveDefinite,
    /// The factor was no longer wanted.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// L of `A = LLᵀ`.
#[derive(Debug)]
pub struct CholeskyFactor {
    /// L below the diagonal, and Lᵀ above it, where each row of L is contiguous in memory.
    lower: DMatrix<f64>,
    /// `L_kk⁻¹` of every block.
    inverses: Vec<DMatrix<f64>>,
}

impl CholeskyFactor {
    /// The factor of `a` (n × n; only its lower triangle is read); `progress` is told the share of the blocks done.
    ///
    /// # Errors
    /// [`NoFactor`].
    pub fn new(mut a: DMatrix<f64>, progress: &dyn Progress) -> Result<Self, NoFactor> {
        let n = a.nrows();
        let mut inverses = Vec::with_capacity(n.div_ceil(BLOCK));
        for begin in (0..n).step_by(BLOCK) {
            progress.report(begin as f64 / n as f64);
            progress.go_on()?;
            let end = (begin + BLOCK).min(n);
            let width = end - begin;
            let (done, mut panel) = a.columns_range_pair_mut(..begin, begin..end);
            panel.rows_mut(0, begin).fill(0.0);
            let mut panel = panel.rows_mut(begin, n - begin);
            if begin > 0 {
                let across = done.rows(begin, width).transpose();
                panel.gemm(-1.0, &done.rows(begin, n - begin), &across, 1.0);
            }
            let diagonal = Cholesky::new(panel.rows(0, width).into_owned())
                .ok_or(NoFactor::NotPositiveDefinite)?
                .unpack();
            let mut inverse = DMatrix::identity(width, width);
            // The diagonal of a Cholesky factor is positive, so a solve cannot meet a zero pivot.
            diagonal.solve_lower_triangular_unchecked_mut(&mut inverse);
            let below = panel.rows(width, n - end) * inverse.transpose();
            panel.rows_mut(0, width).copy_from(&diagonal);
            panel.rows_mut(width, n - end).copy_from(&below);
            inverses.push(inverse);
        }
        a.fill_upper_triangle_with_lower_triangle();
        Ok(Self { lower: a, inverses })
    }

    /// Columns ← L⁻¹ columns, n rows each.
    pub fn forward(&self, columns: &mut DMatrix<f64>) {
        if columns.ncols() < MANY {
            return self.substitute(columns);
        }
        let mut begin = 0;
        for inverse in &self.inverses {
            let width = inverse.nrows();
            let (done, mut here) = columns.rows_range_pair_mut(..begin, begin..begin + width);
            if begin > 0 {
                here.gemm(-1.0, &self.lower.view((begin, 0), (width, begin)), &done, 1.0);
            }
            let solved = inverse * &here;
            here.copy_from(&solved);
            begin += width;
        }
    }

    /// As [`CholeskyFactor::forward`], row by row, up to four columns at once.
    fn substitute(&self, columns: &mut DMatrix<f64>) {
        let n = columns.nrows();
        let lower = self.lower.as_slice();
        let mut rows = vec![f64x4::ZERO; n];
        for group in columns.as_mut_slice().chunks_mut(4 * n) {
            for (i, row) in rows.iter_mut().enumerate() {
                let mut four = [0.0; 4];
                for (x, column) in four.iter_mut().zip(group.chunks(n)) {
                    *x = column[i];
                }
                *row = f64x4::new(four);
            }
            for begin in (0..n).step_by(PANEL) {
                let (known, rest) = rows.split_at_mut(begin);
                // Rows past the end repeat the last one; their sums are not read.
                let across = array::from_fn(|r| &lower[(begin + r).min(n - 1) * n..][..n]);
                let sums = sums(across.map(|row| &row[..begin]), known);
                for i in 0..PANEL.min(n - begin) {
                    let row = &across[i][begin..];
                    let sum = (0..i).fold(sums[i], |sum, j| sum + f64x4::splat(row[j]) * rest[j]);
                    rest[i] = (rest[i] - sum) / f64x4::splat(row[i]);
                }
            }
            for (i, row) in rows.iter().enumerate() {
                for (x, column) in row.to_array().into_iter().zip(group.chunks_mut(n)) {
                    column[i] = x;
                }
            }
        }
    }

    /// x ← A⁻¹ x.
    pub fn solve(&self, x: &mut DVector<f64>) {
        self.lower.solve_lower_triangular_unchecked_mut(x);
        self.lower.tr_solve_lower_triangular_unchecked_mut(x);
    }
}

/// The products of these rows with `known`.
fn sums(rows: [&[f64]; PANEL], known: &[f64x4]) -> [f64x4; PANEL] {
    let [a, b, c, d] = rows;
    let mut sums = [f64x4::ZERO; PANEL];
    for ((((a, b), c), d), x) in a.iter().zip(b).zip(c).zip(d).zip(known) {
        for (sum, l) in sums.iter_mut().zip([a, b, c, d]) {
            *sum += f64x4::splat(*l) * *x;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::{Heard, Unwatched};

    /// A matrix of this size with condition about 1e3.
    fn example(n: usize) -> DMatrix<f64> {
        DMatrix::from_fn(n, n, |i, j| (-(i.abs_diff(j) as f64) / 20.0).exp())
    }

    #[test]
    fn factor_and_solutions_are_those_of_the_matrix() {
        for n in [1, 5, BLOCK, BLOCK + 1, 200] {
            let a = example(n);
            let factor = CholeskyFactor::new(a.clone(), &Unwatched).unwrap();
            let lower = factor.lower.lower_triangle();
            let back = &lower * lower.transpose();
            assert!((back - &a).amax() < 1e-14, "{n}");
            let wanted = DMatrix::from_fn(n, 9, |i, j| ((i * 7 + j * 3) as f64).sin());
            for columns in [1, 4, 5, 9] {
                let mut x = &lower * wanted.columns(0, columns);
                factor.forward(&mut x);
                assert!((x - wanted.columns(0, columns)).amax() < 1e-12, "{n} {columns}");
            }
            let mut x = &a * wanted.column(0);
            factor.solve(&mut x);
            assert!((x - wanted.column(0)).amax() < 1e-11, "{n}");
        }
    }

    #[test]
    fn it_stops_when_asked_and_refuses_what_is_not_positive_definite() {
        let heard = Heard::until(0.5);
        let stopped = CholeskyFactor::new(example(4 * BLOCK), &heard);
        assert_eq!(stopped.unwrap_err(), NoFactor::Stopped(Stopped));
        let told = heard.told.into_inner();
        assert_eq!(told, [0.0, 0.25, 0.5]);
        for bad in [-1.0, f64::NAN] {
            let mut a = example(100);
            a[(90, 90)] = bad;
            assert_eq!(CholeskyFactor::new(a, &Unwatched).unwrap_err(), NoFactor::NotPositiveDefinite);
        }
    }
}
