//! A branch: solutions in order, each with its local frame.

use super::corrector::Corrected;
use super::system::{Linearization, Vector};
use super::tangent::{Frame, frame};
use serde::Serialize;

/// One solution on a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct Point<const N: usize> {
    /// The unknowns, scaled.
    pub y: Vector<N>,
    /// Tangent, curvature and orientation.
    pub frame: Frame<N>,
    /// Distance from the previous point (0 for the first).
    pub length: f64,
    /// Newton rounds spent on it.
    pub rounds: usize,
    /// Turning of the step that reached it, radians.
    pub turning: f64,
}

impl<const N: usize> Point<N> {
    /// A point from a linearized solution, its tangent along `forward`; `None` where the curve is singular.
    pub fn new(y: Vector<N>, linearization: &Linearization<N>, forward: &Vector<N>) -> Option<Self> {
        let frame = frame(linearization, forward)?;
        Some(Self { y, frame, length: 0.0, rounds: 0, turning: 0.0 })
    }

    /// A point from a correction.
    pub fn corrected(corrected: &Corrected<N>, forward: &Vector<N>) -> Option<Self> {
        let mut point = Self::new(corrected.y, &corrected.linearization, forward)?;
        point.rounds = corrected.rounds;
        Some(point)
    }

    /// The slope of the control `row` along the branch, c·t: zero at its limit points.
    pub fn slope(&self, row: &Vector<N>) -> f64 {
        row.dot(&self.frame.tangent)
    }

    /// The same point walked the other way.
    #[must_use]
    pub fn reversed(mut self) -> Self {
        // k = d²y/dℓ² keeps its sign when ℓ changes it; the determinant changes with its last row.
        self.frame.tangent.neg_mut();
        self.frame.positive = !self.frame.positive;
        self
    }
}

/// What a branch has cost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Work {
    /// Evaluations of the equations.
    pub evaluations: usize,
    /// Steps rejected.
    pub rejections: usize,
}

impl std::ops::AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.evaluations += other.evaluations;
        self.rejections += other.rejections;
    }
}

/// Solutions in order along a curve.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Branch<const N: usize> {
    /// The points.
    pub points: Vec<Point<N>>,
    /// What they have cost.
    pub work: Work,
}

/// The cubic Hermite interpolation of the curve between two points at `x` in 0..=1.
pub fn hermite<const N: usize>(from: &Point<N>, to: &Point<N>, x: f64) -> Vector<N> {
    let h = (to.y - from.y).norm();
    let (a, b) = (1.0 - x, x);
    from.y * (a * a * (1.0 + 2.0 * b))
        + from.frame.tangent * (h * a * a * b)
        + to.y * (b * b * (1.0 + 2.0 * a))
        - to.frame.tangent * (h * a * b * b)
}
