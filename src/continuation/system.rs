//! The equations whose solutions form the curve.

use nalgebra::{DMatrix, DVector};

/// A column of n or n + 1 numbers.
pub type Vector = DVector<f64>;
/// A dense matrix.
pub type Matrix = DMatrix<f64>;

/// The equations and their exact derivatives at one point.
#[derive(Debug, Clone)]
pub struct Linearization {
    /// g(y), n numbers.
    pub residual: Vector,
    /// The size against which each equation is judged, n positive numbers.
    pub scale: Vector,
    /// ∂g/∂y, n × (n+1).
    pub jacobian: Matrix,
    /// `∂²g_i/∂y²`, n symmetric matrices (n+1) × (n+1).
    pub second: Vec<Matrix>,
}

impl Linearization {
    /// The largest residual relative to its scale; infinite when any is not a number.
    pub fn relative_residual(&self) -> f64 {
        let mut worst = 0.0_f64;
        for (g, scale) in self.residual.iter().zip(self.scale.iter()) {
            let relative = (g / scale).abs();
            if !relative.is_finite() {
                return f64::INFINITY;
            }
            worst = worst.max(relative);
        }
        worst
    }

    /// The second derivative along two directions, `g_yy[a, b]`, n numbers.
    pub fn along(&self, a: &Vector, b: &Vector) -> Vector {
        Vector::from_iterator(self.second.len(), self.second.iter().map(|hessian| a.dot(&(hessian * b))))
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.residual.iter().chain(self.jacobian.iter()).all(|x| x.is_finite())
    }

    /// The Jacobian with `row` below it, (n+1) × (n+1).
    pub fn bordered(&self, row: &Vector) -> Matrix {
        let n = self.jacobian.nrows();
        let mut matrix = self.jacobian.clone().insert_row(n, 0.0);
        matrix.row_mut(n).copy_from(&row.transpose());
        matrix
    }
}

/// n equations in n + 1 unknowns with exact first and second derivatives.
pub trait System {
    /// n + 1.
    fn unknowns(&self) -> usize;

    /// The equations at `y` (n + 1 numbers), or `None` where they are not defined.
    fn linearize(&self, y: &Vector) -> Option<Linearization>;
}
