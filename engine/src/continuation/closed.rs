//! The equations closed by one more row: a square system, factored once for all its right-hand sides.
//!
//! ```text
//! M = (J; rᵀ),   P M = L U        elimination with exchange of rows
//! ```
//!
//! A matrix crate's factorization of a size known at compile time asks every caller to prove that the size is small; for a
//! handful of unknowns elimination is short enough to be written down.

use super::system::{Matrix, Vector};
use std::array;

/// M factored.
#[derive(Debug, Clone)]
pub struct Closed<const N: usize> {
    /// Row by row: U from the diagonal on, L left of it without its diagonal of ones.
    factors: [[f64; N]; N],
    /// The row of M that each row came from.
    order: [usize; N],
    /// det M.
    pub determinant: f64,
}

impl<const N: usize> Closed<N> {
    /// The Jacobian (its last row free) closed by `row`; `None` when the two are singular or not finite.
    pub fn new(jacobian: &Matrix<N>, row: &Vector<N>) -> Option<Self> {
        let mut factors: [[f64; N]; N] =
            array::from_fn(|i| array::from_fn(|j| if i + 1 < N { jacobian[(i, j)] } else { row[j] }));
        let mut order = array::from_fn(|i| i);
        let mut determinant = 1.0;
        for k in 0..N {
            let largest =
                |best: usize, i: usize| if factors[i][k].abs() > factors[best][k].abs() { i } else { best };
            let pivot = (k + 1..N).fold(k, largest);
            if pivot != k {
                factors.swap(k, pivot);
                order.swap(k, pivot);
                determinant = -determinant;
            }
            let diagonal = factors[k][k];
            if diagonal == 0.0 || !diagonal.is_finite() {
                return None;
            }
            determinant *= diagonal;
            let above = factors[k];
            for row in &mut factors[k + 1..] {
                row[k] /= diagonal;
                for j in k + 1..N {
                    row[j] -= row[k] * above[j];
                }
            }
        }
        Some(Self { factors, order, determinant })
    }

    /// x with M x = `right`.
    pub fn solve(&self, right: &Vector<N>) -> Vector<N> {
        let mut x = Vector::zeros();
        for i in 0..N {
            x[i] = (0..i).fold(right[self.order[i]], |sum, j| sum - self.factors[i][j] * x[j]);
        }
        for i in (0..N).rev() {
            x[i] = (i + 1..N).fold(x[i], |sum, j| sum - self.factors[i][j] * x[j]) / self.factors[i][i];
        }
        x
    }

    /// x with `Mᵀ x = right`.
    pub fn solve_transposed(&self, right: &Vector<N>) -> Vector<N> {
        let mut z = *right;
        for i in 0..N {
            z[i] = (0..i).fold(z[i], |sum, j| sum - self.factors[j][i] * z[j]) / self.factors[i][i];
        }
        for i in (0..N).rev() {
            z[i] = (i + 1..N).fold(z[i], |sum, j| sum - self.factors[j][i] * z[j]);
        }
        let mut x = Vector::zeros();
        for (&from, z) in self.order.iter().zip(z.iter()) {
            x[from] = *z;
        }
        x
    }

    /// v with J v = 0 and r·v = 1: along the curve at a solution.
    pub fn null_vector(&self) -> Vector<N> {
        let mut last = Vector::zeros();
        last[N - 1] = 1.0;
        self.solve(&last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_and_determinant_are_those_of_the_matrix() {
        let mut random = fastrand::Rng::with_seed(5);
        for _ in 0..200 {
            let m = Matrix::<4>::from_fn(|_, _| random.f64() - 0.5);
            let wanted = Vector::<4>::from_fn(|_, _| random.f64() - 0.5);
            let closed = Closed::new(&m, &m.row(3).transpose()).unwrap();
            let off = [closed.solve(&(m * wanted)), closed.solve_transposed(&(m.transpose() * wanted))]
                .map(|x| (x - wanted).norm());
            let condition = m.norm() * m.try_inverse().unwrap().norm();
            assert!(off.iter().all(|off| *off <= 1e-15 * condition), "{off:?} {condition}");
            assert!((closed.determinant / m.determinant() - 1.0).abs() <= 1e-14 * condition);
            let along = closed.null_vector();
            assert!((m * along - Vector::ith(3, 1.0)).norm() <= 1e-15 * condition);
        }
    }

    #[test]
    fn a_singular_matrix_and_one_that_is_not_finite_have_no_factor() {
        let jacobian = Matrix::<2>::new(1.0, 2.0, 0.0, 0.0);
        assert!(Closed::new(&jacobian, &Vector::<2>::new(2.0, 4.0)).is_none());
        assert!(Closed::new(&jacobian, &Vector::<2>::new(f64::NAN, 1.0)).is_none());
    }
}
