//! Intervals that do not assume a linear model: by the profile of χ², and by a block bootstrap.

use super::fitted::{Bootstrapped, Fitted};
use super::least_squares::{MinimizationSettings, minimize};
use super::options::Options;
use super::problem::{FitProblem, FreeParameter, Paths, Target};
use super::solve::{HUBER, SolvedFit};
use crate::gap::shapes::split_mix::SplitMix64;
use crate::measured::Segment;
use crate::preset::Value;
use crate::progress::Progress;
use nalgebra::DVector;

/// The rise of χ² at the ends of a 95 % interval of one value: the square of 1.96.
const RISE: f64 = 3.841_458_820_694_124;

/// The rounds and the tolerance of a fit that begins next to its end.
const WARM: MinimizationSettings = MinimizationSettings {
    rounds: 40,
    tolerance: 1e-6,
    resolution: 1.0,
    huber: f64::INFINITY,
    nothing: 0.0,
    small: 0.0,
};

/// Below this many degrees of freedom an interval is much wider than 1.96 errors.
pub const FEW_DEGREES: f64 = 40.0;

impl FitProblem {
    /// The same problem with the parameter `j` held at `u`.
    pub(super) fn holding(&self, j: usize, u: f64) -> Option<Self> {
        let mut held = self.clone();
        let FreeParameter { target, .. } = held.parameters.remove(j);
        let value = self.parameters[j].value(u);
        let in_points = target.sign(self.turned) * value;
        held.priors.retain(|prior| prior.parameter != j);
        for prior in &mut held.priors {
            prior.parameter -= usize::from(prior.parameter > j);
        }
        match target {
            Target::Offset => held.instrument.offset = in_points,
            Target::Baseline => held.instrument.baseline = in_points,
            Target::Tilt => held.instrument.tilt = in_points,
            Target::Key(key) => held.preset.set(&key, Value::Number(value)).ok()?,
            Target::Adhesion(Segment::Approach) => held.closing = Some(value),
            Target::Adhesion(_) => held.preset.material.work_of_adhesion = value,
        }
        Some(held)
    }
}

fn without(u: &[f64], j: usize) -> Vec<f64> {
    u.iter().enumerate().filter(|(i, _)| *i != j).map(|(_, u)| *u).collect()
}

/// The ends of the 95 % interval of the parameter `j`, in base units, where χ² has risen by 3.84 with all others fitted
/// again.
pub fn profile(
    problem: &FitProblem,
    solved: &SolvedFit,
    error: f64,
    j: usize,
    robust: bool,
    progress: &dyn Progress,
) -> Option<[f64; 2]> {
    const TIMES: usize = 12;
    let u = &solved.minimum.parameters;
    let settings =
        MinimizationSettings { huber: if robust { HUBER * solved.scale } else { f64::INFINITY }, ..WARM };
    let scale = noise(problem, solved, robust);
    let end = |side: f64| {
        let mut others = without(u, j);
        // √Δχ² is nearly proportional to the distance.
        let root = |distance: f64, others: &mut Vec<f64>| {
            let held = problem.holding(j, u[j] + side * distance)?;
            let found = minimize(&held, others, &settings, progress)?;
            others.clone_from(&found.parameters);
            Some((2.0 * (found.cost - solved.minimum.cost)).max(0.0).sqrt() / scale)
        };
        let mut distance = RISE.sqrt() * error;
        for _ in 0..TIMES {
            let found = root(distance, &mut others)?;
            let ratio = RISE.sqrt() / found;
            if !(ratio.is_finite() && ratio > 0.0) {
                return None;
            }
            if (ratio - 1.0).abs() < 1e-3 {
                return Some(problem.parameters[j].value(u[j] + side * distance));
            }
            distance *= ratio.clamp(0.3, 3.0);
        }
        None
    };
    Some([end(-1.0)?, end(1.0)?])
}

/// The noise of the residuals in σ by which a rise of the cost is judged.
pub(super) fn noise(problem: &FitProblem, solved: &SolvedFit, robust: bool) -> f64 {
    if robust { solved.scale * stretch(problem, solved) } else { rms(problem, solved) }
}

/// How much more the loss rises than that of normal residuals: the root of mean ψ² over mean ψ'.
fn stretch(problem: &FitProblem, solved: &SolvedFit) -> f64 {
    let real = problem.real(&solved.minimum.at.residuals);
    let psi: f64 = real.iter().map(|r| (r / solved.scale).clamp(-HUBER, HUBER).powi(2)).sum();
    let inside = real.iter().filter(|r| r.abs() <= HUBER * solved.scale).count().max(1);
    (psi / inside as f64).sqrt()
}

/// The root of the mean square of the residuals.
fn rms(problem: &FitProblem, solved: &SolvedFit) -> f64 {
    let real = problem.real(&solved.minimum.at.residuals);
    (real.iter().map(|r| r * r).sum::<f64>() / real.len() as f64).sqrt()
}

/// How many rows belong together: the lag at which the correlation of the residuals has fallen to one over e.
pub fn block(residuals: &[f64]) -> usize {
    let n = residuals.len();
    let mean = residuals.iter().sum::<f64>() / n.max(1) as f64;
    let covariance = |lag: usize| {
        residuals.iter().zip(&residuals[lag..]).map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>()
    };
    let whole = covariance(0);
    (1..n / 10).find(|lag| covariance(*lag) < whole / std::f64::consts::E).unwrap_or(1)
}

/// `count` fits to blocks of rows drawn at random with the seed `seed`, each starting from the fit; how many came to an
/// end, and what they found.
pub fn bootstrap(
    problem: &FitProblem,
    solved: &SolvedFit,
    robust: bool,
    (count, seed): (usize, u64),
    progress: &dyn Progress,
) -> Option<(usize, Vec<Bootstrapped>)> {
    let per = problem.per_point();
    let first: Vec<f64> = solved.minimum.at.residuals.iter().step_by(per).copied().collect();
    let (n, block) = (first.len(), block(&first));
    let mut random = SplitMix64::new(seed);
    let settings =
        MinimizationSettings { huber: if robust { HUBER * solved.scale } else { f64::INFINITY }, ..WARM };
    let mut drawn = problem.clone();
    let mut found: Vec<Vec<f64>> = Vec::new();
    for i in 0..count {
        progress.report(i as f64 / count as f64);
        if progress.stop() {
            break;
        }
        let mut counts = vec![0.0; per * n];
        let mut rows = 0;
        while rows < n {
            let begin = usize::try_from(random.bits() % n as u64).unwrap_or(0);
            for row in (begin..begin + block).map(|row| row % n).take(n - rows) {
                (0..per).for_each(|k| counts[per * row + k] += 1.0);
                rows += 1;
            }
        }
        drawn.counts = Some(counts);
        let fit = minimize(&drawn, &solved.minimum.parameters, &settings, progress);
        if progress.stop() {
            break;
        }
        found.extend(fit.map(|fit| fit.parameters));
    }
    if found.len() < 10 {
        return None;
    }
    let of = |(j, parameter): (usize, &FreeParameter)| {
        let mut values: Vec<f64> = found.iter().map(|u| parameter.value(u[j])).collect();
        values.sort_by(f64::total_cmp);
        let many = values.len() as f64;
        let mean = values.iter().sum::<f64>() / many;
        let error = (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (many - 1.0)).sqrt();
        // A few hundred.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let at = |share: f64| values[(share * (many - 1.0)).round() as usize];
        Bootstrapped { error, interval: [at(0.025), at(0.975)] }
    };
    Some((found.len(), problem.parameters.iter().enumerate().map(of).collect()))
}

/// Puts the intervals that are requested or needed into `fitted`; returns how many fits of the bootstrap there were, and the rows of its
/// blocks.
pub(super) fn intervals(
    problem: &FitProblem,
    solved: &SolvedFit,
    options: &Options,
    (errors, degrees): (&DVector<f64>, f64),
    fitted: &mut [Fitted],
    progress: &dyn Progress,
) -> Option<[usize; 2]> {
    if options.profile {
        for (j, fitted) in fitted.iter_mut().enumerate() {
            fitted.profile = profile(problem, solved, errors[j], j, options.robust, progress);
        }
    }
    let drawn = options.bootstrap.or_else(|| unasked(problem, &solved.minimum.parameters, degrees))?;
    let (count, found) = bootstrap(problem, solved, options.robust, drawn, progress)?;
    for (fitted, found) in fitted.iter_mut().zip(found) {
        fitted.bootstrap = Some(found);
    }
    let first: Vec<f64> = solved.minimum.at.residuals.iter().step_by(problem.per_point()).copied().collect();
    Some([count, block(&first)])
}

/// The bootstrap that is run unasked: with few degrees of freedom, or through snaps, where the curve has a corner beside
/// each point, a linear model says too little about the intervals.
fn unasked(problem: &FitProblem, u: &[f64], degrees: f64) -> Option<(usize, u64)> {
    /// The number of fits, and the seed of their random numbers.
    const FITS: usize = 200;
    const THROUGH_SNAPS: usize = 100;
    const SEED: u64 = 1;
    if degrees < FEW_DEGREES {
        return Some((FITS, SEED));
    }
    let has_snaps =
        |paths: Paths| [Segment::Approach, Segment::Retraction].iter().any(|way| paths.of(*way).snaps > 0);
    problem.paths(u).is_some_and(has_snaps).then_some((THROUGH_SNAPS, SEED))
}
