//! One fit from one start, its noise measured by its own residuals.

use super::least_squares::{Ending, Minimum, Settings, minimize};
use super::problem::Problem;
use crate::measured::branches::median;
use crate::progress::Progress;
use nalgebra::DVector;

/// Residuals beyond so many times their scale count linearly.
pub const HUBER: f64 = 1.5;
/// The least scale, in σ: below it everything is rounding.
pub const LEAST_SCALE: f64 = 1e-3;

/// A fit.
#[derive(Debug, Clone)]
pub struct Solved {
    /// The minimum.
    pub minimum: Minimum,
    /// The scale of the residuals, in σ.
    pub scale: f64,
}

impl Problem {
    /// The residuals that are there: in space those of free points have no second part.
    pub(super) fn real(&self, residuals: &DVector<f64>) -> Vec<f64> {
        let per = self.per_point();
        let is_real = |i: usize| per == 1 || i.is_multiple_of(per) || !self.data[i / per].free;
        residuals.iter().enumerate().filter(|(i, _)| is_real(*i)).map(|(_, r)| *r).collect()
    }

    /// The scale of normal residuals, whatever their outliers: of the points in contact, which alone say how near the curve is.
    pub(super) fn scale(&self, residuals: &DVector<f64>) -> f64 {
        let per = self.per_point();
        let sizes = residuals.iter().enumerate().filter(|(i, _)| !self.data[i / per].free);
        let sizes = sizes.map(|(_, r)| r.abs()).collect();
        (1.4826 * median(sizes).unwrap_or(0.0)).max(LEAST_SCALE)
    }
}

/// Fits from `start`: rounds of a minimization and a new scale, until the scale stays.
pub fn solve(
    problem: &Problem,
    start: &[f64],
    robust: bool,
    rounds: usize,
    progress: &dyn Progress,
) -> Option<Solved> {
    /// A scale changed by less than this share is the same.
    const SAME: f64 = 1e-3;
    const SCALES: usize = 12;
    /// A way of so many standard errors along the best direction is none.
    const NOTHING: f64 = 1e-3;
    let residuals = super::least_squares::LeastSquares::residuals(problem, start)?;
    let mut scale = problem.scale(&residuals);
    let mut u = start.to_vec();
    let mut left = rounds;
    for turn in 0..SCALES {
        let huber = if robust { HUBER * scale } else { f64::INFINITY };
        let settings = Settings {
            rounds: left.max(1),
            huber,
            nothing: 0.5 * (NOTHING * scale).powi(2),
            ..Settings::default()
        };
        let minimum = minimize(problem, &u, &settings, progress)?;
        left = left.saturating_sub(minimum.rounds);
        let next = problem.scale(&minimum.at.residuals);
        let same = (next / scale - 1.0).abs() <= SAME;
        if !robust || same || left == 0 || turn + 1 == SCALES || minimum.ending != Ending::Converged {
            return Some(Solved { minimum, scale: next });
        }
        scale = next;
        u.clone_from(&minimum.parameters);
    }
    None
}
