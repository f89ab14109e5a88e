//! Newton-Raphson back to the curve.
//!
//! One more equation makes the system square:
//!
//! ```text
//! sphere   (|y − y₀|² − h²)/(2h) = 0     row (y − y₀)ᵀ/h     the spherical arc length, every unknown in it
//! plane    c·y − v = 0                   row cᵀ              the fallback, an end value, a control value
//! ```

use super::convergence::{Convergence, NewtonFailure};
use super::system::{ColumnView, Vector};
use super::tracer::Tracer;

/// The equation that closes the system.
#[derive(Debug, Clone, Copy)]
pub enum Constraint<'a> {
    /// At distance `radius` from `centre`.
    Sphere {
        /// The point stepped from.
        centre: ColumnView<'a>,
        /// The step length.
        radius: f64,
    },
    /// On the plane `row`·y = `value`.
    Plane {
        /// c.
        row: ColumnView<'a>,
        /// v.
        value: f64,
    },
}

impl Constraint<'_> {
    /// Value and scale at `y`; its row is written to `derivative`.
    fn at(self, y: &Vector, derivative: &mut Vector) -> (f64, f64) {
        match self {
            Self::Sphere { centre, radius } => {
                y.sub_to(&centre, derivative);
                let value = (derivative.norm_squared() - radius * radius) / (2.0 * radius);
                *derivative /= radius;
                (value, radius)
            }
            Self::Plane { row, value } => {
                derivative.copy_from(&row);
                // The parts that cancel in c·y − v set its rounding level.
                let size = row.as_slice().iter().zip(y.as_slice()).map(|(c, y)| (c * y).abs()).sum::<f64>()
                    + value.abs();
                (row.dot(y) - value, size.max(f64::MIN_POSITIVE))
            }
        }
    }
}

impl Tracer<'_> {
    /// Newton-Raphson from the iterate to the curve under `constraint`, and how many rounds it took.
    ///
    /// # Errors
    /// A [`NewtonFailure`] with the round and the numbers; nothing is clamped on the way.
    pub(super) fn correct(&mut self, constraint: Constraint<'_>) -> Result<usize, NewtonFailure> {
        let mut convergence = Convergence::new(self.settings.corrector());
        loop {
            let round = convergence.round();
            self.linearize(round)?;
            let (value, scale) = constraint.at(&self.y, &mut self.row);
            if convergence.is_reached(self.at.relative_residual().max((value / scale).abs()))? {
                return Ok(round);
            }
            let length = self.newton(value).ok_or(NewtonFailure::Singular { round })?;
            convergence.corrected(length)?;
            self.y += &self.correction;
        }
    }

    /// One more round for a corrected point: quadratic convergence takes it from the tolerance to rounding.
    ///
    /// For landings and end states, whose small differences matter; a path's own points need none.
    pub(super) fn polish(&mut self, constraint: Constraint<'_>) {
        let (y, at) = (self.y.clone(), self.at.clone());
        let (value, _) = constraint.at(&self.y, &mut self.row);
        let corrected = self.newton(value).is_some();
        self.y += &self.correction;
        let better =
            corrected && self.linearize(0).is_ok() && self.at.relative_residual() <= at.relative_residual();
        if !better {
            (self.y, self.at) = (y, at);
        }
    }
}
