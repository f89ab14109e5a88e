//! The equations whose solutions form the curve.
//!
//! N − 1 equations in N unknowns. Everything of them has room for one more: a last row, zero here, that the equation
//! closing the system takes ([`super::closed`]). So one number N gives every size, and nothing is allocated.

use nalgebra::{SMatrix, SVector};

/// A column of N numbers.
pub type Vector<const N: usize> = SVector<f64, N>;
/// A square matrix.
pub type Matrix<const N: usize> = SMatrix<f64, N, N>;

/// The equations and their exact derivatives at one point; the last of each is zero.
#[derive(Debug, Clone)]
pub struct Linearization<const N: usize> {
    /// g(y).
    pub residual: Vector<N>,
    /// The size against which each equation is judged, positive numbers but for the last.
    pub scale: Vector<N>,
    /// J = ∂g/∂y.
    pub jacobian: Matrix<N>,
    /// `∂²g_i/∂y²`, symmetric.
    pub second: [Matrix<N>; N],
}

impl<const N: usize> Linearization<N> {
    /// The largest residual relative to its scale; infinite when any is not a number.
    pub fn relative_residual(&self) -> f64 {
        let mut worst = 0.0_f64;
        for (g, scale) in self.residual.iter().zip(self.scale.iter()).take(N - 1) {
            let relative = (g / scale).abs();
            if !relative.is_finite() {
                return f64::INFINITY;
            }
            worst = worst.max(relative);
        }
        worst
    }

    /// The second derivative along two directions, `g_yy[a, b]`.
    pub fn along(&self, a: &Vector<N>, b: &Vector<N>) -> Vector<N> {
        Vector::from_fn(|i, _| a.dot(&(self.second[i] * b)))
    }

    /// The row `wᵀg_yy[a, ·]`, as a column.
    pub fn contracted(&self, w: &Vector<N>, a: &Vector<N>) -> Vector<N> {
        self.second.iter().zip(w.iter()).map(|(hessian, w)| hessian * a * *w).sum()
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.residual.iter().chain(self.jacobian.iter()).all(|x| x.is_finite())
    }
}

/// N − 1 equations in N unknowns with exact first and second derivatives.
pub trait System<const N: usize> {
    /// The equations at `y`, or `None` where they are not defined.
    fn linearize(&self, y: &Vector<N>) -> Option<Linearization<N>>;
}
