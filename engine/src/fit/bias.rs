//! The bias of a distance where the curve bends within the noise: rows lie on the hollow side of a curve on average, by
//! half its curvature where that is small.
//!
//! ```text
//! b_i = Σ_jk w_j w_k r(c_i + σ̂ (z_j, z_k)),     z = 0, ±√3,  w = 2/3, 1/6, 1/6,     c_i: the foot of the row, in σ
//! ```
//!
//! The residual is r − b. The points of Gauss and Hermite are exact for polynomials of the fifth degree; the feet stand
//! for the true states, and σ̂ is the scale of the residuals, but at most 1. W. A. Fuller, *Measurement Error Models* (1987), section 3.2, gives the term of the curvature.

use super::distance::Nearest;
use super::problem::FitProblem;
use super::settled::ROUNDS;
use super::solve::{SolvedFit, solve};
use crate::measured::Segment;
use crate::progress::Progress;

/// What is less than this share of an error in all values together is left as it is.
const LEAST: f64 = 0.3;

impl FitProblem {
    /// b of each row at the end of a fit; 0 for rows apart.
    fn biases(&self, solved: &SolvedFit) -> Option<Vec<f64>> {
        const PLACES: [(f64, f64); 3] =
            [(-1.732_050_807_568_877_2, 1.0 / 6.0), (0.0, 2.0 / 3.0), (1.732_050_807_568_877_2, 1.0 / 6.0)];
        let u = &solved.minimum.parameters;
        let paths = self.paths(u)?;
        let feet = self.feet(&paths, &self.instrument_at(u))?;
        let (weights, scale) = (self.weights(), solved.scale.min(1.0));
        let scaled = paths.scaled(weights);
        let mut boxes = [0; 2];
        let mut of_row = |foot: &Nearest, of: usize| {
            let at = |z: [f64; 2]| {
                [foot.at[0] * weights[0] + scale * z[0], foot.at[1] * weights[1] + scale * z[1], 0.0]
            };
            let mut sum = 0.0;
            for (x, of_x) in PLACES {
                for (force, of_force) in PLACES {
                    let beside = scaled[of].nearest(at([x, force]), &mut boxes[of])?;
                    sum += of_x * of_force * beside.residuals[0];
                }
            }
            Some(sum)
        };
        let rows = self.data.iter().zip(&feet).map(|(datum, foot)| match foot {
            Some(foot) => of_row(foot, usize::from(datum.segment == Segment::Retraction)),
            None => Some(0.0),
        });
        rows.collect()
    }
}

/// Fits again where the curve bends within the noise, without the bias of the distances.
pub(super) fn of_bias(
    problem: &mut FitProblem,
    mut solved: SolvedFit,
    robust: bool,
    (notes, progress): (&mut Vec<String>, &dyn Progress),
) -> SolvedFit {
    /// The number of fits after which b has settled.
    const TIMES: usize = 3;
    /// So many rows tell whether it matters.
    const ROWS: usize = 2000;
    let some = problem.thinned(ROWS);
    let mean = |biases: &[f64]| biases.iter().map(|b| b * b).sum::<f64>() / biases.len() as f64;
    let all = problem.data.len() as f64;
    if problem.space || some.biases(&solved).is_none_or(|biases| (all * mean(&biases)).sqrt() < LEAST) {
        return solved;
    }
    for i in 0..TIMES {
        let Some(biases) = problem.biases(&solved) else { break };
        for (datum, b) in problem.data.iter_mut().zip(biases) {
            datum.bias = b;
        }
        match solve(problem, &solved.minimum.parameters, robust, ROUNDS, progress) {
            Some(found) => solved = found,
            None => break,
        }
        if i == 0 {
            notes.push(
                "the curve bends within the noise, which biases the distances of the rows: the bias is taken off, but \
                 values may still be off by one or two more of their errors"
                    .to_owned(),
            );
        }
    }
    solved
}
