//! What follows a curve: a system, the settings, and work space.

use super::branch::{Point, Work};
use super::convergence::NewtonFailure;
use super::settings::Settings;
use super::system::{ColumnView, Linearization, SizeError, System, Vector};
use super::tangent::Algebra;

/// Follows the curve of a system; failures leave its caller's points untouched.
///
/// Its verbs are `correct`, `step`, `trace`, `brackets`, `limit_point` and `control_value`, each in a file of its own.
pub struct Tracer<'a> {
    /// The numbers it goes by.
    pub settings: Settings,
    /// The next step length.
    pub length: f64,
    /// What it has cost so far.
    pub work: Work,
    pub(super) system: &'a dyn System,
    /// The iterate, n numbers, and the equations there.
    pub(super) y: Vector,
    pub(super) at: Linearization,
    /// The row that closes the equations, and the correction that follows from it.
    pub(super) row: Vector,
    pub(super) correction: Vector,
    pub(super) algebra: Algebra,
}

impl<'a> Tracer<'a> {
    /// A tracer with its first step length. Its work space is allocated here; a step allocates only its point.
    pub fn new(system: &'a dyn System, settings: Settings) -> Self {
        let n = system.unknowns();
        let zeros = || Vector::zeros(n);
        Self {
            length: settings.first,
            settings,
            work: Work::default(),
            system,
            y: zeros(),
            at: Linearization::new(n),
            row: zeros(),
            correction: zeros(),
            algebra: Algebra::new(n),
        }
    }

    /// Checks that settings, points and rows have the system's size.
    pub(super) fn check(&self, points: &[&Point], row: Option<&Vector>) -> Result<(), SizeError> {
        let n = self.y.len();
        if n < 2 {
            return Err(SizeError::TooFew(n));
        }
        SizeError::check("the largest increments", self.settings.largest_increment.len(), n)?;
        SizeError::check("the row of the control", row.map_or(n, Vector::len), n)?;
        points.iter().try_for_each(|point| point.has_size_of(n))
    }

    /// Linearizes the equations at the iterate.
    pub(super) fn linearize(&mut self, round: usize) -> Result<(), NewtonFailure> {
        self.work.evaluations += 1;
        self.system.linearize(&self.y, &mut self.at).ok_or(NewtonFailure::Undefined { round })?;
        self.at.has_sizes_of(self.y.len())?;
        if self.at.is_finite() { Ok(()) } else { Err(NewtonFailure::Undefined { round }) }
    }

    /// The Newton correction of the equations closed by the row, whose equation has this value; its length.
    pub(super) fn newton(&mut self, value: f64) -> Option<f64> {
        let Self { at, row, correction, algebra, .. } = self;
        algebra.closed.factor(&at.jacobian, row.column(0))?;
        let right = algebra.right.as_mut_slice();
        for (right, g) in right.iter_mut().zip(at.residual.as_slice().iter().chain([&value])) {
            *right = -g;
        }
        algebra.closed.solve(&algebra.right, correction);
        Some(correction.norm())
    }

    /// The point of the iterate, its tangent along `forward`.
    pub(super) fn point(&mut self, rounds: usize, forward: ColumnView<'_>) -> Option<Point> {
        let Self { system, y, at, algebra, work, .. } = self;
        let (columns, positive) = algebra.frame(*system, y, at, forward, &mut work.evaluations)?;
        let mut point = Point::of(columns, positive);
        point.rounds = rounds;
        Some(point)
    }
}
