//! Noise of the force that grows with the force, as that of a sensor whose gain is not steady: its variance is that of a force of 0
//! and (b P)².
//!
//! ```text
//! d_i = (r_{i−1} − 2 r_i + r_{i+1})/√6 of residuals in contact,     var d_i = a X_i + p Y_i + q Z_i
//! X, Y, Z: means of n_x² + n_s², n_P² and n_P² (P/P_max)² of the three rows, n the normals of the curve in σ
//! a_k ← a_k √(Σ X_ki d_i²/var_i² / Σ X_ki/var_i)
//! ```
//!
//! Each round raises the likelihood and leaves no variance below 0: H. Zhou, L. Hu, J. Zhou and K. Lange, J. Comput.
//! Graph. Stat. 28, 350 (2019). P is that of the curve: weights by the measured force would favour rows whose noise
//! makes them small.

use super::distance::Nearest;
use super::problem::FitProblem;
use super::settled::ROUNDS;
use super::solve::{SolvedFit, solve};
use crate::elementary::ln;
use crate::measured::Origin;
use crate::measured::noise::{CLIPPED, FLOOR, LEFT, median};
use crate::progress::Progress;
use crate::units::Quantity;
use crate::units::number::{said, short};

/// Fewer differences do not tell one kind of noise from another.
const FEWEST: usize = 40;
/// A logarithm of the ratio of the likelihoods, twice, that is not chance: that of one value beyond 4 deviations.
const NO_CHANCE: f64 = 16.0;
/// The squares of neighbouring second differences of white noise are correlated by 4/9 and 1/36: this many count as one.
const CORRELATED: f64 = 1.0 + 2.0 * (4.0 / 9.0 + 1.0 / 36.0);

/// How the noise of the force grows.
struct Growth {
    /// b.
    share: f64,
    /// The variance of P at P = 0, in `σ_P`².
    level: f64,
}

impl FitProblem {
    /// What the noise of the force is, where it clearly grows with the force.
    fn growth(&self, solved: &SolvedFit, feet: &[Option<Nearest>]) -> Option<Growth> {
        let force = |i: usize| feet[i].as_ref().map_or(0.0, |foot| foot.at[1].abs());
        let most = (0..feet.len()).map(force).fold(0.0, f64::max);
        let of_row = |i: usize, part: usize| {
            let [x, p, s] = feet[i].as_ref().map_or([0.0, 1.0, 0.0], |foot| foot.normals[part]);
            [x * x + s * s, p * p, (p * force(i) / most).powi(2)]
        };
        let mut rows: Vec<([f64; 3], f64)> = Vec::new();
        for branch in 0..self.branches() {
            for part in 0..self.per_point() {
                for three in self.in_order(solved, branch, false, part).windows(3) {
                    let [a, b, c] = [0, 1, 2].map(|i| of_row(three[i].index, part));
                    let raw = |i: usize| three[i].residual * self.data[three[i].index].noise[part];
                    let d = raw(0) - 2.0 * raw(1) + raw(2);
                    rows.push(([0, 1, 2].map(|k| (a[k] + 4.0 * b[k] + c[k]) / 6.0), d * d / 6.0));
                }
            }
        }
        if rows.len() < FEWEST {
            return None;
        }
        let middle = (median(rows.iter().map(|(_, square)| square.sqrt()).collect())? / 0.6745).powi(2);
        let (_, even) = variances(&rows, [middle, middle, 0.0]);
        let ([_, level, growing], likelihood) = variances(&rows, [middle; 3]);
        let share = growing.sqrt() * self.sigma[1] / most;
        let is_clear = 2.0 * (likelihood - even) > NO_CHANCE * CORRELATED && share.is_finite();
        is_clear.then_some(Growth { share, level })
    }

    /// Gives each row the noise of a force that grows by the share `share` of it.
    fn grows(&mut self, share: f64, feet: &[Option<Nearest>]) {
        self.share = share;
        let per = self.per_point();
        let unit = share / self.sigma[1];
        for (datum, foot) in self.data.iter_mut().zip(feet) {
            let Some(foot) = foot else { continue };
            let more = (unit * foot.at[1]).powi(2);
            for (noise, normal) in datum.noise.iter_mut().zip(&foot.normals).take(per) {
                *noise = (1.0 + more * normal[1] * normal[1]).sqrt();
            }
        }
    }
}

/// The variances that make the squares most likely, and the logarithm of their likelihood; one that starts at 0 stays 0.
fn variances(rows: &[([f64; 3], f64)], start: [f64; 3]) -> ([f64; 3], f64) {
    const TIMES: usize = 200;
    let mut found = start;
    let of = |found: &[f64; 3], parts: &[f64; 3]| -> f64 { (0..3).map(|k| found[k] * parts[k]).sum() };
    for _ in 0..TIMES {
        let [mut above, mut below] = [[0.0; 3]; 2];
        for (parts, square) in rows {
            let variance = of(&found, parts);
            let square = square.min(CLIPPED * CLIPPED * variance) / LEFT;
            for k in 0..3 {
                above[k] += parts[k] * square / (variance * variance);
                below[k] += parts[k] / variance;
            }
        }
        for k in 0..3 {
            if below[k] > 0.0 {
                found[k] *= (above[k] / below[k]).sqrt();
            }
        }
    }
    let likelihood = rows.iter().map(|(parts, square)| {
        let variance = of(&found, parts);
        -0.5 * (ln(variance) + (square / variance).min(CLIPPED * CLIPPED) / LEFT)
    });
    (found, likelihood.sum())
}

/// Fits again where the noise of the force grows with it: by the share that is `asked` for, or by that which the rows
/// show unless σ of the force is given.
pub(super) fn of_growing(
    problem: &mut FitProblem,
    mut solved: SolvedFit,
    robust: bool,
    (asked, from, range): (Option<f64>, Origin, f64),
    (notes, progress): (&mut Vec<String>, &dyn Progress),
) -> SolvedFit {
    /// The number of fits after which the weights have settled.
    const TIMES: usize = 2;
    for _ in 0..TIMES {
        let u = &solved.minimum.parameters;
        let feet = problem.paths(u).and_then(|paths| problem.feet(&paths, &problem.instrument_at(u)));
        let Some(feet) = feet else { break };
        let share = match asked {
            Some(share) => share,
            None if from == Origin::Given => break,
            None => {
                let Some(Growth { share, level }) = problem.growth(&solved, &feet) else { break };
                // σ of neighbours was that of small and large forces together.
                if from == Origin::Neighbours {
                    problem.sigma[1] = (problem.sigma[1] * level.sqrt()).max(FLOOR * range);
                }
                share
            }
        };
        if share <= 0.0 {
            break;
        }
        problem.grows(share, &feet);
        match solve(problem, u, robust, ROUNDS, progress) {
            Some(found) => solved = found,
            None => break,
        }
    }
    if problem.share > 0.0 {
        let by = if asked.is_some() { "as given" } else { "as neighbouring rows show" };
        notes.push(format!(
            "the noise of the force grows with it, {by}: sigma of P is the root of ({})^2 + ({} % of P)^2",
            said(&problem.preset.units, Quantity::Force, problem.sigma[1]),
            short(100.0 * problem.share, 3)
        ));
    }
    solved
}
