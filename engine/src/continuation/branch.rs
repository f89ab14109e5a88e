//! A branch: solutions in order, each with its local frame.

use super::system::{ColumnView, Columns, Linearization, SizeError, System, Vector};
use super::tangent::Algebra;
use crate::elementary::atan2;
use serde::Serialize;

/// One solution on a branch, with the local frame of the curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// y, t and k, n × 3, together, so that a point takes one allocation.
    columns: Columns,
    /// Whether det(J; tᵀ) is positive.
    pub positive: bool,
    /// Distance from the previous point (0 for the first).
    pub length: f64,
    /// Newton rounds spent on it.
    pub rounds: usize,
    /// Turning of the step that reached it, radians.
    pub turning: f64,
}

impl Point {
    /// A point from a solution (n numbers) and its linearization, with its tangent along `forward`; `None` where the
    /// curve is singular, or where the sizes do not agree.
    pub fn new(system: &dyn System, y: &Vector, at: &Linearization, forward: &Vector) -> Option<Self> {
        let n = system.unknowns();
        at.has_sizes_of(n).ok().filter(|()| n >= 2 && y.len() == n && forward.len() == n)?;
        let (columns, positive) = Algebra::new(n).frame(system, y, at, forward.column(0), &mut 0)?;
        Some(Self::of(columns, positive))
    }

    /// A point from its unknowns, tangent and curvature, n numbers each, and the sign of its determinant.
    pub fn of(columns: Columns, positive: bool) -> Self {
        Self { columns, positive, length: 0.0, rounds: 0, turning: 0.0 }
    }

    /// The unknowns, n scaled numbers.
    pub fn y(&self) -> ColumnView<'_> {
        self.columns.column(0)
    }

    /// The tangent t, n numbers of unit length.
    pub fn tangent(&self) -> ColumnView<'_> {
        self.columns.column(1)
    }

    /// The curvature k = dt/dℓ, n numbers.
    pub fn curvature(&self) -> ColumnView<'_> {
        self.columns.column(2)
    }

    /// Sets one unknown to the value that it has apart from rounding.
    pub(super) fn set(&mut self, unknown: usize, value: f64) {
        self.columns[(unknown, 0)] = value;
    }

    /// Checks that it belongs to a system with this many unknowns.
    pub(super) fn has_size_of(&self, unknowns: usize) -> Result<(), SizeError> {
        SizeError::check("a point", self.columns.nrows(), unknowns)
    }

    /// The same point as the next one after `before`, with the length and the turning of the step.
    #[must_use]
    pub fn after(self, before: &Self) -> Self {
        let (length, turning) = before.step_to(&self);
        Self { length, turning, ..self }
    }

    /// The length and the turning of the step to the next point.
    fn step_to(&self, next: &Self) -> (f64, f64) {
        let chord = next.numbers(0).zip(self.numbers(0)).map(|(to, from)| to - from);
        let length = norm(chord.clone());
        // The angles from the first tangent to the chord and from the chord to the second tangent, because end tangents
        // alone miss a whole S-bend; or the mean curvature times the length, because it warns before the bend.
        let bends = angle(&self.numbers(1), &chord) + angle(&chord, &next.numbers(1));
        let arc = 0.5 * (norm(self.numbers(2)) + norm(next.numbers(2))) * length;
        (length, bends.max(arc))
    }

    /// One of the three columns.
    fn numbers(&self, column: usize) -> impl Iterator<Item = f64> + Clone {
        let n = self.columns.nrows();
        self.columns.as_slice()[column * n..(column + 1) * n].iter().copied()
    }

    /// The slope of the control `row` (n numbers) along the branch, c·t: zero at its limit points.
    pub fn slope(&self, row: &Vector) -> f64 {
        row.dot(&self.tangent())
    }

    /// The same point, walked the other way.
    #[must_use]
    pub fn reversed(mut self) -> Self {
        // k = d²y/dℓ² keeps its sign when ℓ changes sign; the determinant changes sign with its last row.
        self.columns.column_mut(1).neg_mut();
        self.positive = !self.positive;
        self
    }
}

/// The length of a vector.
fn norm(x: impl Iterator<Item = f64>) -> f64 {
    x.map(|x| x * x).sum::<f64>().sqrt()
}

/// The angle between two directions, radians.
fn angle(a: &(impl Iterator<Item = f64> + Clone), b: &(impl Iterator<Item = f64> + Clone)) -> f64 {
    // atan2 of the difference and sum of the unit vectors: exact for small angles, where acos loses half the digits.
    let (of_a, of_b) = (norm(a.clone()), norm(b.clone()));
    let pairs = || a.clone().map(|a| a / of_a).zip(b.clone().map(|b| b / of_b));
    2.0 * atan2(norm(pairs().map(|(a, b)| a - b)), norm(pairs().map(|(a, b)| a + b)))
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
pub struct Branch {
    /// The points.
    pub points: Vec<Point>,
    /// What they have cost.
    pub work: Work,
}

/// The cubic Hermite interpolation of the curve between two points at `x` in 0..=1.
pub fn hermite(from: &Point, to: &Point, x: f64) -> Vector {
    let h = (to.y() - from.y()).norm();
    let (a, b) = (1.0 - x, x);
    from.y() * (a * a * (1.0 + 2.0 * b))
        + from.tangent() * (h * a * a * b)
        + to.y() * (b * b * (1.0 + 2.0 * a))
        - to.tangent() * (h * a * b * b)
}
