//! The last fit, and again where its residuals show another noise than was assumed.

use super::least_squares::{Ending, LeastSquares};
use super::options::FitError;
use super::prior::Prior;
use super::problem::{FitProblem, FreeParameter, START, Target};
use super::pulled::is_pulled;
use super::solve::{HUBER, SolvedFit, solve};
use super::track::{END_MAUGIS, maugis};
use crate::elementary::ln;
use crate::measured::Segment;
use crate::preset::schema::RANGE_KEYS;
use crate::progress::Progress;
use crate::units::{Quantity, number::said};

/// Rounds of the last fit.
pub(super) const ROUNDS: usize = 200;

/// The last fit, from `u`. Where `least` is given, σ of P is that of neighbours, but not below the second number; so is
/// σ of x, not below the first, where that is finite, nor above a tenth of the range of x: to a larger one all curves would
/// be the same.
pub(super) fn last(
    problem: &mut FitProblem,
    u: &[f64],
    robust: bool,
    least: Option<[f64; 2]>,
    progress: &dyn Progress,
) -> Result<SolvedFit, FitError> {
    /// The number of fits after which σ has settled.
    const TIMES: usize = 2;
    let mut solved = solve(problem, u, robust, ROUNDS, progress).ok_or(FitError::NoStart)?;
    let Some([least_x, least_force]) = least else { return Ok(solved) };
    let most_x = 0.1 * problem.extent(|point| point.x);
    for _ in 0..TIMES {
        let off = if least_x.is_finite() { problem.off(&solved) } else { None };
        let of_force = || problem.scatter(&solved).contact.map(|scale| [1.0, scale]);
        let Some([x, force]) = off.or_else(of_force) else { break };
        if off.is_some() {
            problem.sigma[0] = (problem.sigma[0] * x).min(most_x).max(least_x);
        }
        problem.sigma[1] = (problem.sigma[1] * force).max(least_force);
        let u = &solved.minimum.parameters;
        solved = solve(problem, u, robust, ROUNDS, progress).ok_or(FitError::NoStart)?;
    }
    Ok(solved)
}

/// The nearest of the minima from `solved` and from `others`, which some of the rows did not tell apart; and those that all rows do
/// not tell from it.
pub(super) fn nearest(
    problem: &FitProblem,
    solved: SolvedFit,
    others: &[Vec<f64>],
    robust: bool,
    progress: &dyn Progress,
) -> (SolvedFit, Vec<Vec<f64>>) {
    /// By how much χ² may be larger, in squares of the scale: one in seventy right values of one quantity is farther off.
    const ALIKE: f64 = 6.0;
    let huber = HUBER * solved.scale;
    let cost =
        |solved: &SolvedFit| problem.cost_at(&solved.minimum.parameters, huber).unwrap_or(f64::INFINITY);
    let is_late = |solved: &SolvedFit| problem.is_late(&solved.minimum.parameters, solved.scale);
    let led = others.iter().filter_map(|u| solve(problem, u, robust, ROUNDS, progress));
    let mut ends: Vec<SolvedFit> = std::iter::once(solved).chain(led).collect();
    let first_is_late = is_late(&ends[0]);
    let mut best = 0;
    for i in 1..ends.len() {
        if cost(&ends[i]) < cost(&ends[best]) && (first_is_late || !is_late(&ends[i])) {
            best = i;
        }
    }
    let solved = ends.swap_remove(best);
    // The cost is half of χ².
    let most = cost(&solved) + 0.5 * ALIKE * solved.scale.powi(2);
    let alike = ends.into_iter().filter(|end| cost(end) < most && (first_is_late || !is_late(end)));
    (solved, alike.map(|end| end.minimum.parameters).collect())
}

/// The minimum where a range ended at the smallest one for which there is a path: there the other values did not follow. It is
/// then held at a larger one, where they are best, unless that is farther from the points.
pub(super) fn within_range(
    problem: &FitProblem,
    solved: SolvedFit,
    robust: bool,
    progress: &dyn Progress,
) -> SolvedFit {
    /// By how much the range is larger.
    const FURTHER: f64 = 2.5;
    let is_at_end = |_: &usize| {
        let preset = problem.preset_at(&solved.minimum.parameters, Segment::Retraction);
        preset.and_then(|preset| maugis(&preset)).is_some_and(|maugis| maugis > END_MAUGIS)
    };
    let within = |j: usize| {
        let mut u = solved.minimum.parameters.clone();
        let is_strength = problem.parameters[j].key() == RANGE_KEYS[0];
        let range = u.remove(j) + if is_strength { -ln(FURTHER) } else { ln(FURTHER) };
        let SolvedFit { mut minimum, scale } =
            solve(&problem.holding(j, range)?, &u, robust, ROUNDS, progress)?;
        minimum.parameters.insert(j, range);
        // Over the range it is no minimum.
        minimum.ending = Ending::Rounds;
        minimum.at = problem.evaluate(&minimum.parameters)?;
        let cost = |u: &[f64]| problem.cost_at(u, HUBER * solved.scale);
        let is_nearer = cost(&minimum.parameters)? < cost(&solved.minimum.parameters)?;
        is_nearer.then_some(SolvedFit { minimum, scale })
    };
    problem.free_range().filter(is_at_end).and_then(within).unwrap_or(solved)
}

/// The number of the contact radius at which an edge is pinned, where the points determine it worse than to a tenth, or
/// allow one that is larger by as much: there is no line between the works of adhesion of both branches then.
pub(super) fn unpinned(problem: &FitProblem, solved: &SolvedFit) -> Option<usize> {
    /// ln of the radius, further out.
    const FURTHER: f64 = 0.1;
    /// A larger cost than this, in squares of the scale of the residuals, shows a line.
    const SHOWN: f64 = 5.0;
    if !problem.pins() {
        return None;
    }
    let cost = |u: &[f64]| problem.cost_at(u, HUBER * solved.scale);
    let allows = |j: &usize| {
        let mut u = solved.minimum.parameters.clone();
        let least = cost(&u);
        u[*j] += FURTHER;
        cost(&u).zip(least).is_some_and(|(cost, least)| cost < least + SHOWN * solved.scale.powi(2))
    };
    start_of(problem, solved).or_else(|| start_index(problem).filter(allows))
}

/// The number of the contact radius at which a pull begins, where the points determine it worse than to a tenth: a slow
/// edge is at its equilibrium before the first of them.
pub(super) fn unseen_start(problem: &FitProblem, solved: &SolvedFit) -> Option<usize> {
    start_of(problem, solved).filter(|_| is_pulled(&problem.preset))
}

/// The number of the contact radius at which an edge starts, where the points determine it worse than to a tenth.
fn start_of(problem: &FitProblem, solved: &SolvedFit) -> Option<usize> {
    const LEAST: f64 = 10.0;
    let column = |j: &usize| solved.minimum.at.jacobian.column(*j).norm();
    start_index(problem).filter(|j| column(j) < LEAST * solved.scale)
}

/// The number of the contact radius at which an edge starts, where that is free.
fn start_index(problem: &FitProblem) -> Option<usize> {
    problem.parameters.iter().position(|parameter| parameter.target == Target::Key(START.to_owned()))
}

/// The nearest minimum where an edge is pinned between approach and retraction: a fit may have moved the radius of that
/// edge, or what closing gains, to where no row tells them, or to another wave. `solve` begins again from the radius to
/// which the values lead.
pub(super) fn pinned_again(
    mut problem: FitProblem,
    mut solved: SolvedFit,
    solve: impl Fn(&mut FitProblem, &[f64]) -> Result<SolvedFit, FitError>,
) -> (FitProblem, SolvedFit) {
    /// The work of adhesion of closing edges, over that of the minimum.
    const FACTORS: [f64; 3] = [1.0, 0.6, 1.6];
    /// Residuals of this size, in σ, may be those of another minimum than the nearest.
    const FAR: f64 = 1.05;
    /// A radius less than so many errors away, with all else held, is the same.
    const SAME: f64 = 5.0;
    let is_closing = |of: &FreeParameter| of.target == Target::Adhesion(Segment::Approach);
    let closing = problem.parameters.iter().position(is_closing);
    let pinned = start_index(&problem);
    let is_there = |u: &[f64]| {
        pinned.is_some_and(|j| {
            let SolvedFit { minimum, scale } = &solved;
            (u[j] - minimum.parameters[j]).abs() * minimum.at.jacobian.column(j).norm() < SAME * scale
        })
    };
    let unseen = unpinned(&problem, &solved).is_some();
    let (judge, from, huber) = (problem.clone(), solved.minimum.parameters.clone(), HUBER * solved.scale);
    let cost = |u: &[f64]| judge.cost_at(u, huber);
    let mut least = cost(&from).unwrap_or(f64::INFINITY);
    let tried = if solved.scale > FAR && closing.is_some() { FACTORS.len() } else { 1 };
    let begun = |(at, factor): (usize, &f64)| {
        let mut u = from.clone();
        if let Some(j) = closing {
            u[j] += ln(*factor);
        }
        problem.begun(&mut u);
        (at > 0 || unseen || !is_there(&u)).then_some(u)
    };
    let starts: Vec<Vec<f64>> = FACTORS[..tried].iter().enumerate().filter_map(begun).collect();
    for u in starts {
        let mut other = problem.clone();
        let Ok(again) = solve(&mut other, &u) else { continue };
        if let Some(found) = cost(&again.minimum.parameters).filter(|found| *found < least) {
            (problem, solved, least) = (other, again, found);
        }
    }
    (problem, solved)
}

/// The nearest minimum where snaps lie among the points: each row that changes its side of a snap has a minimum of its
/// own. Each value in turn is moved by several errors, and then all are fitted again.
pub(super) fn beyond_snaps(
    problem: &FitProblem,
    mut solved: SolvedFit,
    robust: bool,
    progress: &dyn Progress,
) -> SolvedFit {
    /// By how many errors.
    const AWAY: [f64; 2] = [-8.0, 8.0];
    let huber = HUBER * solved.scale;
    let cost = |u: &[f64]| problem.cost_at(u, huber);
    let from = solved.minimum.parameters.clone();
    let Some((errors, mut least)) = solved.errors().zip(cost(&from)) else { return solved };
    for (j, away) in (0..from.len()).flat_map(|j| AWAY.map(|away| (j, away))) {
        let mut u = from.clone();
        u[j] += away * errors[j];
        if progress.stop() || !u[j].is_finite() {
            continue;
        }
        let Some(again) = solve(problem, &u, robust, ROUNDS, progress) else { continue };
        if let Some(found) = cost(&again.minimum.parameters).filter(|found| *found < least) {
            (solved, least) = (again, found);
        }
    }
    solved
}

/// Fits again where the noise is correlated from row to row: σ is then larger than differences of neighbours tell, by
/// 1/√(1 − r), with r the correlation of neighbours.
pub(super) fn of_correlated(
    problem: &mut FitProblem,
    solved: SolvedFit,
    robust: bool,
    progress: &dyn Progress,
) -> SolvedFit {
    let correlation = problem.scatter(&solved).correlation;
    if correlation.share <= 0.0 {
        return solved;
    }
    problem.sigma[1] /= (1.0 - correlation.at(1.0)).sqrt();
    solve(problem, &solved.minimum.parameters, robust, ROUNDS, progress).unwrap_or(solved)
}

/// The points contradict an assumed value beyond so many standard deviations.
const CONTRADICTION: f64 = 2.0;

/// Fits again where the points contradict the assumed tare of the force, 0 ± σ: with the σ of the largest likelihood,
/// σ² = b² − v, where b is the tare that the points alone give, with the variance v; J. O. Berger, *Statistical
/// Decision Theory and Bayesian Analysis* (1985), section 3.5.4.
pub(super) fn of_tare(
    problem: &mut FitProblem,
    solved: SolvedFit,
    robust: bool,
    (notes, progress): (&mut Vec<String>, &dyn Progress),
) -> SolvedFit {
    let is_of = |prior: &&mut Prior| problem.parameters[prior.parameter].target == Target::Baseline;
    let jacobian = &solved.minimum.at.jacobian;
    let Some(prior) = problem.priors.iter_mut().find(is_of) else { return solved };
    let j = prior.parameter;
    let mut weights = jacobian.tr_mul(jacobian);
    let Some(alone) = weights.clone().try_inverse() else { return solved };
    weights[(j, j)] += prior.sigma.powi(-2);
    let Some(both) = weights.try_inverse() else { return solved };
    let off = (solved.minimum.parameters[j] - prior.mean) / (1.0 - both[(j, j)] / prior.sigma.powi(2));
    let variance = solved.scale.powi(2) * alone[(j, j)];
    let found = off * off - variance;
    let expected = prior.sigma * prior.sigma + variance;
    if found.is_nan() || off * off < CONTRADICTION * CONTRADICTION * expected {
        return solved;
    }
    prior.sigma = found.sqrt();
    let [_, wider] = problem.parameters[j].given(prior);
    notes.push(format!(
        "the points contradict so small a tare: {} is taken instead",
        said(&problem.preset.units, Quantity::Force, wider)
    ));
    solve(problem, &solved.minimum.parameters, robust, ROUNDS, progress).unwrap_or(solved)
}
