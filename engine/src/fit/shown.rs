//! Noise that the rows in contact show: that of an x of which nothing is known, and that of a force whose noise grows with
//! the force, as that of a sensor whose gain is not steady, with a variance that is that of a force of 0 and (b P)².
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
use crate::measured::noise::{CLIPPED, FLOOR, LEFT, median};
use crate::measured::{Abscissa, Origin};
use crate::progress::Progress;
use crate::units::Quantity;
use crate::units::number::{said, short};

/// Fewer differences do not tell one kind of noise from another.
const FEWEST: usize = 40;
/// A logarithm of the ratio of the likelihoods, twice, that is not chance: that of one value beyond 4 deviations.
const NO_CHANCE: f64 = 16.0;
/// The same for more noise of x than was assumed, which only makes errors larger.
const LIKELY: f64 = 4.0;
/// The squares of neighbouring second differences of white noise are correlated by 4/9 and 1/36: this many count as one.
const CORRELATED: f64 = 1.0 + 2.0 * (4.0 / 9.0 + 1.0 / 36.0);

/// The noise that rows show.
struct ShownNoise {
    /// b, where the noise of the force clearly grows with it.
    share: Option<f64>,
    /// The variance of x in `σ_x`², where it is clearly larger.
    way: Option<f64>,
    /// The variance of P at P = 0, in `σ_P`².
    level: f64,
}

impl FitProblem {
    /// What the noise is, where there are enough rows.
    fn shown_noise(&self, solved: &SolvedFit, feet: &[Option<Nearest>]) -> Option<ShownNoise> {
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
        let is_clear = |more: f64, less: f64| 2.0 * (more - less) > NO_CHANCE * CORRELATED;
        let even = variances(&rows, [middle, middle, 0.0], true);
        let growing = variances(&rows, [middle; 3], true);
        let share = growing.0[2].sqrt() * self.sigma[1] / most;
        let grows = is_clear(growing.1, even.1) && share.is_finite();
        let ([way, level, last], likelihood) = if grows { growing } else { even };
        let as_assumed = variances(&rows, [1.0, middle, last], false);
        let is_wider = way > 1.0 && 2.0 * (likelihood - as_assumed.1) > LIKELY * CORRELATED;
        Some(ShownNoise { share: grows.then_some(share), way: is_wider.then_some(way), level })
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

/// The variances that make the squares most likely, and the logarithm of their likelihood; one that starts at 0 stays 0,
/// and so does the first unless it `is_free`.
fn variances(rows: &[([f64; 3], f64)], start: [f64; 3], is_free: bool) -> ([f64; 3], f64) {
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
        for k in usize::from(!is_free)..3 {
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

/// What is known of the noise before a fit.
#[derive(Clone, Copy)]
pub(super) struct KnownNoise {
    /// b, where it is given.
    pub(super) share: Option<f64>,
    /// Where σ of x and of P are from.
    pub(super) from: [Origin; 2],
    /// The range of the force.
    pub(super) range: f64,
    pub(super) abscissa: Abscissa,
}

/// Fits again where the noise of the force grows with it, by the share that is given or by that which the rows show
/// unless σ of the force is given, and where x has more noise than was assumed.
pub(super) fn of_shown_noise(
    problem: &mut FitProblem,
    mut solved: SolvedFit,
    robust: bool,
    known: KnownNoise,
    (notes, progress): (&mut Vec<String>, &dyn Progress),
) -> SolvedFit {
    /// The number of fits after which the weights have settled.
    const TIMES: usize = 3;
    /// Beyond this share the nearest point of a bent curve is no longer that of the same x.
    const LARGE: f64 = 0.05;
    let KnownNoise { share: given, from: [of_way, of_force], range, abscissa } = known;
    let is_assumed = of_way == Origin::Assumed && abscissa != Abscissa::Radius && !problem.space;
    for _ in 0..TIMES {
        let u = solved.minimum.parameters.clone();
        let feet = |problem: &FitProblem| problem.feet(&problem.paths(&u)?, &problem.instrument_at(&u));
        let Some(of_solved) = feet(problem) else { break };
        let shown = problem.shown_noise(&solved, &of_solved);
        let way = shown.as_ref().and_then(|shown| shown.way).filter(|_| is_assumed);
        let found = shown.as_ref().and_then(|shown| shown.share).filter(|_| of_force != Origin::Given);
        let share = given.or(found).filter(|share| *share > 0.0);
        if share.is_none() && way.is_none() {
            break;
        }
        problem.sigma[0] *= way.unwrap_or(1.0).sqrt();
        // σ of neighbours was that of small and large forces, and of x, together.
        let parts = shown.filter(|_| of_force == Origin::Neighbours && (given.is_none() || way.is_some()));
        if let Some(ShownNoise { level, .. }) = parts {
            problem.sigma[1] = (problem.sigma[1] * level.sqrt()).max(FLOOR * range);
        }
        if let (Some(share), Some(feet)) = (share, feet(problem)) {
            problem.grows(share, &feet);
        }
        match solve(problem, &u, robust, ROUNDS, progress) {
            Some(found) => solved = found,
            None => break,
        }
    }
    if problem.share > 0.0 {
        let by = if given.is_some() { "as given" } else { "as neighbouring rows show" };
        let unless = if problem.share > LARGE {
            "; with so much noise a value may be off by one more of its errors, and doubts about the gap may be false"
        } else {
            ""
        };
        notes.push(format!(
            "the noise of the force grows with it, {by}: sigma of P is the root of ({})^2 + ({} % of P)^2{unless}",
            said(&problem.preset.units, Quantity::Force, problem.sigma[1]),
            short(100.0 * problem.share, 3)
        ));
    }
    solved
}
