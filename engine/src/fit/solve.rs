//! One fit from one start, its noise measured by its own residuals.

use super::least_squares::{Ending, LeastSquares, MinimizationSettings, Minimum, minimize_from};
use super::problem::FitProblem;
use super::pulled::is_pulled;
use crate::measured::branches::median;
use crate::progress::Progress;
use nalgebra::DVector;

/// Residuals beyond this many times their scale count linearly.
pub const HUBER: f64 = 1.5;
/// The smallest scale, in σ: below it everything is rounding.
pub const LEAST_SCALE: f64 = 1e-3;

/// A step of less than this many standard errors along the best determined direction counts as none.
pub(super) const NOTHING: f64 = 1e-3;

/// A fit.
#[derive(Debug, Clone)]
pub struct SolvedFit {
    /// The minimum.
    pub minimum: Minimum,
    /// The scale of the residuals, in σ.
    pub scale: f64,
}

impl SolvedFit {
    /// The errors of u, linearized; `None` where the points do not determine all values.
    pub(super) fn errors(&self) -> Option<Vec<f64>> {
        let jacobian = &self.minimum.at.jacobian;
        let covariance = jacobian.tr_mul(jacobian).try_inverse()?;
        Some(covariance.diagonal().iter().map(|variance| self.scale * variance.sqrt()).collect())
    }
}

impl FitProblem {
    /// The same problem with at most `most` points, evenly taken from those in contact and those apart.
    pub(super) fn thinned(&self, most: usize) -> Self {
        let mut thinned = self.clone();
        let step = self.data.len().div_ceil(most).max(1);
        let keep =
            |free: bool| self.data.iter().filter(move |datum| datum.free == free).step_by(step).copied();
        thinned.data = keep(false).chain(keep(true)).collect();
        thinned
    }

    /// The residuals that exist: in space those of free points have no second part.
    pub(super) fn real(&self, residuals: &DVector<f64>) -> Vec<f64> {
        let per = self.per_point();
        let is_real = |i: usize| per == 1 || i.is_multiple_of(per) || !self.data[i / per].free;
        residuals.iter().enumerate().filter(|(i, _)| is_real(*i)).map(|(_, r)| *r).collect()
    }

    /// The scale of normal residuals, whatever their outliers: of the points in contact, which alone tell how near the
    /// curve is.
    pub(super) fn scale(&self, residuals: &DVector<f64>) -> f64 {
        let per = self.per_point();
        let sizes = residuals.iter().enumerate().filter(|(i, _)| !self.data[i / per].free);
        let sizes = sizes.map(|(_, r)| r.abs()).collect();
        (1.4826 * median(sizes).unwrap_or(0.0)).max(LEAST_SCALE)
    }
}

/// With more rows than this a part is fitted first.
const MANY: usize = 4000;

/// Fits from `start`: rounds of a minimization and a new scale, until the scale stays the same. Where there are many
/// rows, an evenly taken part leads close to the end first.
pub fn solve(
    problem: &FitProblem,
    start: &[f64],
    robust: bool,
    rounds: usize,
    progress: &dyn Progress,
) -> Option<SolvedFit> {
    if problem.data.len() > MANY && problem.counts.is_none() {
        let led = solve(&problem.thinned(MANY), start, robust, rounds, progress);
        let led = led.map_or_else(|| start.to_vec(), |led| led.minimum.parameters);
        return solve_all(problem, &led, robust, rounds, progress);
    }
    solve_all(problem, start, robust, rounds, progress)
}

/// The same on all rows from the beginning.
fn solve_all(
    problem: &FitProblem,
    start: &[f64],
    robust: bool,
    rounds: usize,
    progress: &dyn Progress,
) -> Option<SolvedFit> {
    /// A scale changed by less than this share is the same.
    const SAME: f64 = 1e-3;
    const SCALES: usize = 12;
    /// The tolerance until then, and also at the end where there are many rows, or where a pull is known only to a
    /// share of the noise: a ten-thousandth of an error.
    const ROUGH: f64 = 1e-4;
    const FINE_OF_MANY: f64 = 1e-7;
    /// Standard errors that do not count over many rounds.
    const SMALL: f64 = 0.1;
    let mut at = problem.evaluate(start)?;
    let mut scale = problem.scale(&at.residuals);
    let mut u = start.to_vec();
    let mut left = rounds;
    // Nothing is known better than the scale: only once that has settled is the end found to all digits.
    let is_rough = problem.data.len() > MANY || is_pulled(&problem.preset);
    let fine = if is_rough { FINE_OF_MANY } else { MinimizationSettings::default().tolerance };
    let mut tolerance = if robust { ROUGH } else { fine };
    for turn in 0..SCALES {
        let huber = if robust { HUBER * scale } else { f64::INFINITY };
        let settings = MinimizationSettings {
            rounds: left.max(1),
            tolerance,
            huber,
            nothing: 0.5 * (NOTHING * scale).powi(2),
            // The valleys of a pull are long.
            small: if is_pulled(&problem.preset) { 0.0 } else { 0.5 * (SMALL * scale).powi(2) },
            ..MinimizationSettings::default()
        };
        let minimum = minimize_from(problem, &u, at, &settings, progress)?;
        left = left.saturating_sub(minimum.rounds);
        let next = problem.scale(&minimum.at.residuals);
        let same = (next / scale - 1.0).abs() <= SAME;
        let is_last = same && tolerance < ROUGH;
        if !robust || is_last || left == 0 || turn + 1 == SCALES || minimum.ending != Ending::Converged {
            return Some(SolvedFit { minimum, scale: next });
        }
        if same || turn + 2 == SCALES {
            tolerance = fine;
        }
        scale = next;
        u = minimum.parameters;
        at = minimum.at;
    }
    None
}
