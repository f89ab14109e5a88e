//! Newton-Raphson back to the curve.
//!
//! One more equation makes the system square:
//!
//! ```text
//! sphere   (|y − y₀|² − h²)/(2h) = 0     row (y − y₀)ᵀ/h     the spherical arc length, every unknown in it
//! plane    c·y − v = 0                   row cᵀ              the fallback, an end value, a control value
//! ```

use super::closed::Closed;
use super::settings::Settings;
use super::system::{Linearization, System, Vector};

/// The equation that closes the system.
#[derive(Debug, Clone)]
pub enum Constraint<const N: usize> {
    /// At distance `radius` from `centre`.
    Sphere {
        /// The point stepped from.
        centre: Vector<N>,
        /// The step length.
        radius: f64,
    },
    /// On the plane `row`·y = `value`.
    Plane {
        /// c.
        row: Vector<N>,
        /// v.
        value: f64,
    },
}

impl<const N: usize> Constraint<N> {
    /// Value, scale and row at `y`.
    fn at(&self, y: &Vector<N>) -> (f64, f64, Vector<N>) {
        match self {
            Self::Sphere { centre, radius } => {
                let away = y - centre;
                let value = (away.norm_squared() - radius * radius) / (2.0 * radius);
                (value, *radius, away / *radius)
            }
            Self::Plane { row, value } => {
                // The parts that cancel in c·y − v set its rounding level.
                let size = row.iter().zip(y.iter()).map(|(c, y)| (c * y).abs()).sum::<f64>() + value.abs();
                (row.dot(y) - value, size.max(f64::MIN_POSITIVE), *row)
            }
        }
    }
}

/// A corrected point.
#[derive(Debug, Clone)]
pub struct Corrected<const N: usize> {
    /// The solution.
    pub y: Vector<N>,
    /// The equations there.
    pub linearization: Linearization<N>,
    /// Newton rounds used.
    pub rounds: usize,
    /// Length of the last correction.
    pub correction: f64,
}

/// Why a correction failed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum CorrectorFailure {
    /// The equations are not defined at an iterate.
    #[error("the equations are not defined at round {round}")]
    Undefined {
        /// The round.
        round: usize,
    },
    /// The matrix of a round is singular.
    #[error("the Newton matrix is singular at round {round}")]
    Singular {
        /// The round.
        round: usize,
    },
    /// The corrections do not shrink.
    #[error("corrections do not shrink (ratio {ratio:.2} at round {round})")]
    Diverging {
        /// The round.
        round: usize,
        /// Last correction over the one before.
        ratio: f64,
    },
    /// The rounds ran out.
    #[error("{rounds} Newton rounds were not enough, relative residual {residual:.1e}")]
    RoundsExhausted {
        /// The rounds.
        rounds: usize,
        /// The relative residual reached.
        residual: f64,
    },
}

/// Newton-Raphson from `start` to the curve under `constraint`.
///
/// # Errors
/// A [`CorrectorFailure`] with the round and the numbers; nothing is clamped on the way.
pub fn correct<const N: usize>(
    system: &dyn System<N>,
    start: Vector<N>,
    constraint: &Constraint<N>,
    settings: &Settings,
) -> Result<Corrected<N>, CorrectorFailure> {
    let mut y = start;
    let mut correction = f64::INFINITY;
    let mut residual = f64::INFINITY;
    for round in 0..=settings.rounds {
        let linearization = system
            .linearize(&y)
            .filter(Linearization::is_finite)
            .ok_or(CorrectorFailure::Undefined { round })?;
        let (value, scale, row) = constraint.at(&y);
        residual = linearization.relative_residual().max((value / scale).abs());
        if residual <= settings.tolerance {
            return Ok(Corrected { y, linearization, rounds: round, correction });
        }
        if round == settings.rounds {
            break;
        }
        let delta = newton(&linearization, value, &row).ok_or(CorrectorFailure::Singular { round })?;
        let length = delta.norm();
        if !length.is_finite() {
            return Err(CorrectorFailure::Singular { round });
        }
        if round >= 2 && length > settings.contraction * correction {
            return Err(CorrectorFailure::Diverging { round, ratio: length / correction });
        }
        correction = length;
        y += delta;
    }
    Err(CorrectorFailure::RoundsExhausted { rounds: settings.rounds, residual })
}

/// The Newton correction of the equations closed by a constraint of this value and row.
fn newton<const N: usize>(
    linearization: &Linearization<N>,
    value: f64,
    row: &Vector<N>,
) -> Option<Vector<N>> {
    let mut right = -linearization.residual;
    right[N - 1] = -value;
    Some(Closed::new(&linearization.jacobian, row)?.solve(&right))
}

/// One more round for a corrected point: quadratic convergence takes it from the tolerance to rounding.
///
/// For landings and end states, whose small differences matter; a path's own points need none.
pub fn polish<const N: usize>(
    system: &dyn System<N>,
    corrected: Corrected<N>,
    constraint: &Constraint<N>,
) -> Corrected<N> {
    let (value, _, row) = constraint.at(&corrected.y);
    let polished = newton(&corrected.linearization, value, &row).and_then(|delta| {
        let y = corrected.y + delta;
        let linearization = system.linearize(&y).filter(Linearization::is_finite)?;
        let better = linearization.relative_residual() <= corrected.linearization.relative_residual();
        better.then(|| Corrected { y, linearization, correction: delta.norm(), ..corrected.clone() })
    });
    polished.unwrap_or(corrected)
}
