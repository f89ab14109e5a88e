//! The points compared with a curve.

use super::approached::Approached;
use super::least_squares::LeastSquares;
use super::options::{FitError, Options};
use super::pose::posed;
use super::problem::{Datum, FitProblem};
use super::solve::SolvedFit;
use crate::measured::Abscissa;
use crate::preset::Preset;
use nalgebra::DVector;

/// Residuals beyond this many times their scale are outliers.
const OUTLIER: f64 = 4.0;

/// One point compared with the fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// The point.
    pub datum: Datum,
    /// Its distance, in σ.
    pub residual: f64,
    /// Whether it counts as an outlier.
    pub outlier: bool,
}

/// What x is, and the distances of the points of a preset's own measured curve from its curve as it stands.
///
/// # Errors
/// [`FitError`].
pub fn residuals_own(preset: &Preset) -> Result<(Abscissa, Vec<Residual>), FitError> {
    let source = preset.data.source.as_ref().ok_or(FitError::NoData)?;
    let branches = source.branches(&preset.reading()).map_err(FitError::Data)?;
    // A baseline that is not given is the median of the free part, where a fit begins.
    let problem = posed(preset, &branches, &Options::default(), &mut Vec::new())?;
    let at_start = |problem: &FitProblem| -> Vec<f64> {
        problem.parameters.iter().map(|parameter| parameter.inner(parameter.start)).collect()
    };
    let problem = match problem.overlapping(&at_start(&problem)) {
        Some(why) => problem.without_loading(why, &mut Vec::new())?,
        None => problem,
    };
    let u = at_start(&problem);
    let approached = Approached::of(&problem, &branches, None);
    let problem = approached.and_then(|approached| approached.seen(&problem, &u, 1.0)).unwrap_or(problem);
    let residuals = LeastSquares::residuals(&problem, &u).ok_or_else(|| FitError::no_start(preset))?;
    let scale = problem.scale(&residuals);
    Ok((branches.abscissa, beside(&problem, &residuals, scale)))
}

/// The points with their distances.
pub(super) fn beside(problem: &FitProblem, residuals: &DVector<f64>, scale: f64) -> Vec<Residual> {
    let per = problem.per_point();
    let of = |(i, datum): (usize, &Datum)| {
        let largest = (0..per).map(|k| residuals[per * i + k].abs()).fold(0.0, f64::max);
        let outlier = largest > OUTLIER * scale;
        Residual { datum: *datum, residual: residuals[per * i], outlier }
    };
    problem.data.iter().enumerate().map(of).collect()
}

/// Σr²/(n − p) without the rows that are outliers; `None` where there are none.
pub(super) fn without_outliers(problem: &FitProblem, solved: &SolvedFit, all: &[Residual]) -> Option<f64> {
    let per = problem.per_point();
    let mut kept = solved.minimum.at.residuals.clone();
    for (i, _) in all.iter().enumerate().filter(|(_, row)| row.outlier) {
        kept.rows_mut(per * i, per).fill(f64::NAN);
    }
    let kept: Vec<f64> = problem.real(&kept).into_iter().filter(|r| !r.is_nan()).collect();
    let left = kept.len().saturating_sub(problem.taken()).max(1) as f64;
    all.iter().any(|row| row.outlier).then(|| kept.iter().map(|r| r * r).sum::<f64>() / left)
}

/// Σr²/n of the points in contact or apart.
pub(super) fn of_part(problem: &FitProblem, solved: &SolvedFit, free: bool) -> Option<f64> {
    let per = problem.per_point();
    let of = solved.minimum.at.residuals.iter().enumerate();
    let of = of.filter(|(i, _)| problem.data[i / per].free == free && (!free || i.is_multiple_of(per)));
    let [sum, count] = of.fold([0.0; 2], |[sum, count], (_, r)| [sum + r * r, count + 1.0]);
    (count > 0.0).then(|| sum / count)
}
