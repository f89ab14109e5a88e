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

    pub fn point(&self, u: f64) -> Point {
        let y = Vector::from_vec(vec![u, Self::p(u)]);
        Point::new(y.clone(), &self.linearize(&y).unwrap(), &Vector::from_vec(vec![1.0, 0.0])).unwrap()
    }
}

impl System for Cubic {
    fn unknowns(&self) -> usize {
        2
    }

    fn linearize(&self, y: &Vector) -> Option<Linearization> {
        let (u, p) = (y[0], y[1]);
        Some(Linearization {
            residual: Vector::from_element(1, Self::p(u) - p),
            scale: Vector::from_element(1, 1.0),
            jacobian: Matrix::from_row_slice(1, 2, &[3.0 * u * u - 3.0, -1.0]),
            second: vec![Matrix::from_row_slice(2, 2, &[6.0 * u, 0.0, 0.0, 0.0])],
        })
    }
}

/// The unit circle.
#[derive(Debug)]
pub struct Circle;

impl Circle {
    pub fn point(&self, angle: f64) -> Point {
        let y = Vector::from_vec(vec![angle.cos(), angle.sin()]);
        let on = Vector::from_vec(vec![-angle.sin(), angle.cos()]);
        Point::new(y.clone(), &self.linearize(&y).unwrap(), &on).unwrap()
    }
}

impl System for Circle {
    fn unknowns(&self) -> usize {
        2
    }

    fn linearize(&self, y: &Vector) -> Option<Linearization> {
        Some(Linearization {
            residual: Vector::from_element(1, y.norm_squared() - 1.0),
            scale: Vector::from_element(1, 1.0),
            jacobian: Matrix::from_row_slice(1, 2, &[2.0 * y[0], 2.0 * y[1]]),
            second: vec![Matrix::identity(2, 2) * 2.0],
        })
    }
}
