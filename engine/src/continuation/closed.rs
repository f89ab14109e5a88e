//! The equations closed by one more row: a square system, factored once for all its right-hand sides.
//!
//! ```text
//! M = (J; rᵀ)  n × n,   P M = L U        elimination with exchange of rows
//! ```
//!
//! A matrix crate's factorization needs a new matrix each time; this one is redone in the room it has.

use super::system::{ColumnView, Matrix, Vector};

/// M factored.
#[derive(Debug, Clone)]
pub struct Closed {
    /// Row by row: U from the diagonal on, L left of it without its diagonal of ones.
    factors: Vec<f64>,
    /// The row of M that each row came from.
    order: Vec<usize>,
    /// det M.
    pub determinant: f64,
}

impl Closed {
    /// Room for n × n numbers.
    pub fn new(unknowns: usize) -> Self {
        Self { factors: vec![0.0; unknowns * unknowns], order: vec![0; unknowns], determinant: 0.0 }
    }

    /// Factors the Jacobian ((n − 1) × n) closed by `row` (n); `None` when the two are singular or not finite.
    pub fn factor(&mut self, jacobian: &Matrix, row: ColumnView<'_>) -> Option<()> {
        let Self { factors, order, determinant } = self;
        let n = order.len();
        let columns = jacobian.as_slice().chunks_exact(n - 1).zip(row.as_slice());
        for (j, (column, last)) in columns.enumerate() {
            let entries = factors[j..].iter_mut().step_by(n);
            for (entry, x) in entries.zip(column.iter().chain([last])) {
                *entry = *x;
            }
        }
        // The same elimination, unrolled for the smallest systems.
        *determinant = match n {
            2 => eliminate(factors, order, 2),
            3 => eliminate(factors, order, 3),
            _ => eliminate(factors, order, n),
        }?;
        Some(())
    }

    /// Writes x with M x = `right` to `x`.
    pub fn solve(&self, right: &Vector, x: &mut Vector) {
        let (right, x) = (right.as_slice(), x.as_mut_slice());
        match self.order.len() {
            2 => substitute(&self.factors, &self.order, right, x, 2),
            3 => substitute(&self.factors, &self.order, right, x, 3),
            n => substitute(&self.factors, &self.order, right, x, n),
        }
    }

    /// Writes x with `Mᵀ x = right` to `x`; `z` is overwritten.
    pub fn solve_transposed(&self, right: &Vector, z: &mut Vector, x: &mut Vector) {
        let n = self.order.len();
        let column = |i: usize, from: usize| self.factors[from * n..].iter().skip(i).step_by(n);
        z.copy_from(right);
        for i in 0..n {
            let sum = column(i, 0).zip(z.iter()).take(i).fold(z[i], |sum, (a, z)| sum - a * z);
            z[i] = sum / self.factors[i * n + i];
        }
        for i in (0..n).rev() {
            z[i] = column(i, i + 1).zip(z.iter().skip(i + 1)).fold(z[i], |sum, (a, z)| sum - a * z);
        }
        for (from, z) in self.order.iter().zip(z.iter()) {
            x[*from] = *z;
        }
    }

    /// Writes v with J v = 0 and r·v = 1 to `v`: along the curve at a solution. `right` is overwritten.
    pub fn null_vector(&self, right: &mut Vector, v: &mut Vector) {
        right.fill(0.0);
        right[self.order.len() - 1] = 1.0;
        self.solve(right, v);
    }
}

/// Factors n rows of n numbers in place, and records which row came from where; returns the determinant.
#[expect(clippy::inline_always, reason = "a constant n unrolls its loops")]
#[inline(always)]
fn eliminate(factors: &mut [f64], order: &mut [usize], n: usize) -> Option<f64> {
    let mut determinant = 1.0;
    for (i, from) in order.iter_mut().enumerate() {
        *from = i;
    }
    for k in 0..n {
        let (above, below) = factors[..n * n].split_at_mut((k + 1) * n);
        let above = &mut above[k * n..];
        let mut pivot = None;
        let mut largest = above[k].abs();
        for (i, row) in below.chunks_exact(n).enumerate() {
            if row[k].abs() > largest {
                (pivot, largest) = (Some(i), row[k].abs());
            }
        }
        if let Some(i) = pivot {
            above.swap_with_slice(&mut below[i * n..(i + 1) * n]);
            order.swap(k, k + 1 + i);
            determinant = -determinant;
        }
        let diagonal = above[k];
        if diagonal == 0.0 || !diagonal.is_finite() {
            return None;
        }
        determinant *= diagonal;
        for row in below.chunks_exact_mut(n) {
            let factor = row[k] / diagonal;
            row[k] = factor;
            for (x, above) in row[k + 1..].iter_mut().zip(&above[k + 1..]) {
                *x -= factor * above;
            }
        }
    }
    Some(determinant)
}

/// Writes the solution of the factored equations to `x`.
#[expect(clippy::inline_always, reason = "a constant n unrolls its loops")]
#[inline(always)]
fn substitute(factors: &[f64], order: &[usize], right: &[f64], x: &mut [f64], n: usize) {
    let (factors, order, x) = (&factors[..n * n], &order[..n], &mut x[..n]);
    let less = |start: f64, a: &[f64], x: &[f64]| a.iter().zip(x).fold(start, |sum, (a, x)| sum - a * x);
    for i in 0..n {
        x[i] = less(right[order[i]], &factors[i * n..i * n + i], &x[..i]);
    }
    for i in (0..n).rev() {
        x[i] = less(x[i], &factors[i * n + i + 1..(i + 1) * n], &x[i + 1..]) / factors[i * n + i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_and_determinant_are_those_of_the_matrix() {
        let mut random = fastrand::Rng::with_seed(5);
        for n in [2, 3, 4, 40] {
            let mut closed = Closed::new(n);
            for _ in 0..50 {
                let m = Matrix::from_fn(n, n, |_, _| random.f64() - 0.5);
                let wanted = Vector::from_fn(n, |_, _| random.f64() - 0.5);
                let jacobian = m.rows(0, n - 1).into_owned();
                closed.factor(&jacobian, m.row(n - 1).transpose().column(0)).unwrap();
                let [mut x, mut z, mut along, mut last] = [(); 4].map(|()| Vector::zeros(n));
                closed.solve(&(&m * &wanted), &mut x);
                closed.solve_transposed(&(m.transpose() * &wanted), &mut last, &mut z);
                closed.null_vector(&mut last, &mut along);
                let condition = m.norm() * m.clone().try_inverse().unwrap().norm();
                for off in [x - &wanted, z - &wanted, &m * along - last] {
                    assert!(off.norm() <= 1e-15 * n as f64 * condition, "{} {condition}", off.norm());
                }
                assert!((closed.determinant / m.determinant() - 1.0).abs() <= 1e-14 * n as f64 * condition);
            }
        }
    }

    #[test]
    fn a_singular_matrix_and_one_that_is_not_finite_have_no_factor() {
        let jacobian = Matrix::from_row_slice(1, 2, &[1.0, 2.0]);
        let mut closed = Closed::new(2);
        assert!(closed.factor(&jacobian, Vector::from_vec(vec![2.0, 4.0]).column(0)).is_none());
        assert!(closed.factor(&jacobian, Vector::from_vec(vec![f64::NAN, 1.0]).column(0)).is_none());
        assert!(closed.factor(&jacobian, Vector::from_vec(vec![2.0, 1.0]).column(0)).is_some());
    }
}
