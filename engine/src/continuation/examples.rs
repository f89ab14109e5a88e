//! Small systems with known answers, for the tests of this module.

use super::branch::Point;
use super::system::{Linearization, Matrix, System, Vector};

/// p = u³ − 3u with unknowns (u, p): folds of p at u = ∓1, p = ±2.
#[derive(Debug)]
pub struct Cubic;

impl Cubic {
    pub fn p(u: f64) -> f64 {
        u * u * u - 3.0 * u
    }

    pub fn point(&self, u: f64) -> Point<2> {
        let y = Vector::from([u, Self::p(u)]);
        Point::new(y, &self.linearize(&y).unwrap(), &Vector::from([1.0, 0.0])).unwrap()
    }
}

impl System<2> for Cubic {
    fn linearize(&self, y: &Vector<2>) -> Option<Linearization<2>> {
        let (u, p) = (y[0], y[1]);
        Some(Linearization {
            residual: Vector::from([Self::p(u) - p, 0.0]),
            scale: Vector::from([1.0, 0.0]),
            jacobian: Matrix::<2>::new(3.0 * u * u - 3.0, -1.0, 0.0, 0.0),
            second: [Matrix::<2>::new(6.0 * u, 0.0, 0.0, 0.0), Matrix::zeros()],
        })
    }
}

/// The unit circle.
#[derive(Debug)]
pub struct Circle;

impl Circle {
    pub fn point(&self, angle: f64) -> Point<2> {
        let y = Vector::from([angle.cos(), angle.sin()]);
        let on = Vector::from([-angle.sin(), angle.cos()]);
        Point::new(y, &self.linearize(&y).unwrap(), &on).unwrap()
    }
}

impl System<2> for Circle {
    fn linearize(&self, y: &Vector<2>) -> Option<Linearization<2>> {
        Some(Linearization {
            residual: Vector::from([y.norm_squared() - 1.0, 0.0]),
            scale: Vector::from([1.0, 0.0]),
            jacobian: Matrix::<2>::new(2.0 * y[0], 2.0 * y[1], 0.0, 0.0),
            second: [Matrix::identity() * 2.0, Matrix::zeros()],
        })
    }
}
