//! One law fitted to several curves: the values of material, gap, edge and device are those of all, what lies between instrument and model is each
//! curve's own.
//!
//! ```text
//! D = Σ_i (C_i − C_i⁰) 2/(τ_i κ_i²)     F = D/q     q = Σ p_i⁰ − p     ν = Σ n_i/τ_i − p
//! ```
//!
//! with `C_i` the cost of the rows of curve i under one law and `C_i⁰` under its own, both in units of its noise, τ rows that count as one, κ² by how much
//! Huber's loss rises less than squares do, and p⁰ the values that a curve alone determines. Runs that do not collapse on one law have a D that
//! chance hardly has: F beyond its quantile. The covariance is that of `determined`, its sums taken over all curves.

use super::chance::beyond_f;
use super::determined::{Determined, Sandwich, White, determined, sandwich, words};
use super::directed::branches_of;
use super::fitted::Fitted;
use super::intervals::stretch;
use super::least_squares::{Evaluated, LeastSquares, Minimum, Settings, minimize};
use super::options::{FitError, Options};
use super::problem::{Parameter, Problem, START, Target};
use super::run::{Fit, Posed, values};
use super::scatter::Scatter;
use super::solve::{HUBER, Solved};
use super::verdict::{Reason, Verdict};
use crate::measured::Branches;
use crate::preset::Preset;
use crate::progress::{Part, Progress};
use crate::units::number::short;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// The chance below which runs do not follow one law.
const CHANCE: f64 = 1e-3;
/// What Huber's squares lose of the degrees of freedom; see `degrees`.
const LOST: f64 = 1.04;

/// Several curves under one law.
#[derive(Debug, Clone)]
pub struct Together {
    /// What it comes to: the worst of all curves, and whether they follow one law.
    pub verdict: Verdict,
    /// The values of the law.
    pub law: Vec<Fitted>,
    /// What the curves do not determine together, in words.
    pub direction: Option<String>,
    /// Whether they follow one law.
    pub collapse: Collapse,
    /// The fit of each curve under the one law, its errors those of all curves.
    pub runs: Vec<Run>,
    /// The preset of the first with the law.
    pub preset: Preset,
}

/// One curve.
#[derive(Debug, Clone)]
pub struct Run {
    /// Under the one law.
    pub fit: Fit,
    /// The law that this curve alone would have.
    pub alone: Vec<Fitted>,
}

/// Whether runs follow one law.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Collapse {
    /// By how much χ² is larger under one law than with one of each run.
    pub chi_squared: f64,
    /// The values that the laws of all runs have more.
    pub values: usize,
    /// How likely so much is by chance where there is one law.
    pub chance: f64,
    /// Whether there is one.
    pub collapses: bool,
    /// The same in words.
    pub sentence: String,
}

/// The curves as one problem: the places of each one's values in those of all.
struct Joint<'a> {
    runs: Vec<(&'a Problem, Vec<usize>)>,
    count: usize,
}

/// Whether a value is that of all curves.
fn is_shared(target: &Target) -> bool {
    matches!(target, Target::Key(key) if key != START) || matches!(target, Target::Adhesion(_))
}

/// The same of a fitted one.
fn is_of_law(fitted: &Fitted) -> bool {
    !fitted.key.starts_with("data.") && fitted.key != START
}

impl<'a> Joint<'a> {
    fn of(problems: &[&'a Problem]) -> Self {
        let mut shared: Vec<&Target> = Vec::new();
        for Parameter { target, .. } in problems.iter().flat_map(|problem| &problem.parameters) {
            if is_shared(target) && !shared.contains(&target) {
                shared.push(target);
            }
        }
        let mut count = shared.len();
        let mut place = |target: &Target| {
            shared.iter().position(|own| *own == target).unwrap_or_else(|| {
                count += 1;
                count - 1
            })
        };
        let places = |problem: &&'a Problem| {
            (*problem, problem.parameters.iter().map(|parameter| place(&parameter.target)).collect())
        };
        let runs: Vec<_> = problems.iter().map(places).collect();
        Self { runs, count }
    }

    /// The values of one curve.
    fn own(&self, run: usize, u: &[f64]) -> Vec<f64> {
        self.runs[run].1.iter().map(|place| u[*place]).collect()
    }

    /// The values, each as the first curve that has it does.
    fn parameters(&self) -> Vec<Parameter> {
        let of_place = |place: usize| {
            let has = |(problem, places): &(&Problem, Vec<usize>)| {
                let j = places.iter().position(|own| *own == place)?;
                Some(problem.parameters[j].clone())
            };
            self.runs.iter().find_map(has)
        };
        (0..self.count).filter_map(of_place).collect()
    }

    /// What is known before of the values, each once: of a value of all, as the first curve has it.
    fn priors(&self) -> Vec<(usize, f64, f64)> {
        let mut priors: Vec<(usize, f64, f64)> = Vec::new();
        for (problem, places) in &self.runs {
            for prior in &problem.priors {
                let place = places[prior.parameter];
                if priors.iter().all(|(known, ..)| *known != place) {
                    priors.push((place, prior.mean, prior.sigma));
                }
            }
        }
        priors
    }

    /// Rows of each curve among all.
    fn blocks(&self) -> Vec<std::ops::Range<usize>> {
        let mut from = 0;
        let block = |(problem, _): &(&Problem, Vec<usize>)| {
            let block = from..from + problem.data.len() * problem.per_point();
            from = block.end;
            block
        };
        self.runs.iter().map(block).collect()
    }

    /// One curve at the minimum of all.
    fn solved(&self, run: usize, minimum: &Minimum) -> Solved {
        let (problem, places) = &self.runs[run];
        let block = self.blocks()[run].clone();
        let residuals = minimum.at.residuals.rows(block.start, block.len()).into_owned();
        let jacobian = DMatrix::from_fn(block.len(), places.len(), |i, j| {
            minimum.at.jacobian[(block.start + i, places[j])]
        });
        let scale = problem.scale(&residuals);
        let cost = cost(&problem.real(&residuals));
        let parameters = self.own(run, &minimum.parameters);
        let at = Evaluated { residuals, jacobian };
        Solved { minimum: Minimum { parameters, at, cost, ..minimum.clone() }, scale }
    }
}

/// Σ of Huber's loss, in units of the noise.
fn cost(residuals: &[f64]) -> f64 {
    let of = |r: &f64| if r.abs() <= HUBER { 0.5 * r * r } else { HUBER * r.abs() - 0.5 * HUBER * HUBER };
    residuals.iter().map(of).sum()
}

impl LeastSquares for Joint<'_> {
    type Look = Vec<<Problem as LeastSquares>::Look>;

    fn look(&self, u: &[f64]) -> Option<(DVector<f64>, Self::Look)> {
        let mut all: Vec<f64> = Vec::new();
        let mut looks = Vec::new();
        for (run, (problem, _)) in self.runs.iter().enumerate() {
            let (residuals, look) = problem.look(&self.own(run, u))?;
            all.extend(residuals.iter());
            looks.push(look);
        }
        all.extend(self.priors().iter().map(|(place, mean, sigma)| (u[*place] - mean) / sigma));
        Some((DVector::from_vec(all), looks))
    }

    fn derivatives(&self, u: &[f64], looks: &Self::Look) -> Option<DMatrix<f64>> {
        let (blocks, priors) = (self.blocks(), self.priors());
        let rows = blocks.last().map_or(0, |block| block.end);
        let mut jacobian = DMatrix::zeros(rows + priors.len(), self.count);
        for (run, (problem, places)) in self.runs.iter().enumerate() {
            let own = problem.derivatives(&self.own(run, u), &looks[run])?;
            for (j, place) in places.iter().enumerate() {
                jacobian.view_mut((blocks[run].start, *place), (own.nrows(), 1)).copy_from(&own.column(j));
            }
        }
        for (i, (place, _, sigma)) in priors.iter().enumerate() {
            jacobian[(rows + i, *place)] = 1.0 / sigma;
        }
        Some(jacobian)
    }
}

/// Fits the free keys of `presets`, each with its own measured curve, device and rate, to all curves at once.
///
/// # Errors
/// The number of the curve, and its [`FitError`]; [`FitError::NoStart`] of the first where no law reaches all points.
pub fn fit_together(
    presets: &[Preset],
    options: &Options,
    progress: &dyn Progress,
) -> Result<Together, (usize, FitError)> {
    if options.free.is_empty() {
        return Err((0, FitError::NothingFree));
    }
    let Some(first) = presets.first() else { return Err((0, FitError::NoData)) };
    let numbered = |run: usize| move |error| (run, error);
    let branches: Vec<Branches> = presets
        .iter()
        .enumerate()
        .map(|(run, preset)| branches_of(preset, options).map_err(numbered(run)))
        .collect::<Result<_, _>>()?;
    let mut posed = Vec::new();
    for (run, (preset, branches)) in presets.iter().zip(&branches).enumerate() {
        let share = |run: usize| 0.9 * run as f64 / presets.len() as f64;
        let part = Part::new(progress, [share(run), share(run + 1)]);
        posed.push(Posed::new(preset, branches, options, &part).map_err(numbered(run))?);
    }
    // The noise of each curve is what it has beside its own law.
    for posed in &mut posed {
        posed.in_own_noise();
    }
    let problems: Vec<&Problem> = posed.iter().map(|posed| &posed.problem).collect();
    let joint = Joint::of(&problems);
    let alone: Vec<&Solved> = posed.iter().map(|posed| &posed.solved).collect();
    let minimum = least(&joint, &alone, progress).ok_or((0, FitError::NoStart))?;
    let solved: Vec<Solved> = (0..problems.len()).map(|run| joint.solved(run, &minimum)).collect();
    let scatters: Vec<Scatter> =
        problems.iter().zip(&alone).map(|(problem, alone)| problem.scatter(alone)).collect();
    let known = known(&joint, (&solved, &scatters), &minimum, options.robust);
    let collapse = collapse(&joint, (&alone, &solved), &scatters);
    let of_run = |run: usize| known.of(&joint.runs[run].1);
    let told: Vec<Determined> = (0..problems.len()).map(of_run).collect();
    let own = |run: usize| {
        let what = determined(problems[run], alone[run], &scatters[run], options.robust);
        let known = what.errors.as_ref().zip(what.degrees.as_ref());
        let mut own = values(problems[run], &alone[run].minimum.parameters, known);
        own.retain(is_of_law);
        own
    };
    let own: Vec<Vec<Fitted>> = (0..problems.len()).map(own).collect();
    let mut runs = Vec::new();
    for (run, ((mut posed, solved), (what, (scatter, alone)))) in
        posed.into_iter().zip(solved).zip(told.into_iter().zip(scatters.into_iter().zip(own))).enumerate()
    {
        posed.solved = solved;
        let fit = posed.fit(what, scatter, false, progress).map_err(numbered(run))?;
        runs.push(Run { fit, alone });
    }
    let worst = runs.iter().map(|run| run.fit.verdict).max().unwrap_or(Verdict::NotConverged);
    let verdict = if collapse.collapses { worst } else { worst.max(Verdict::DoesNotDescribe) };
    if !collapse.collapses {
        for run in &mut runs {
            let reason = Reason::new("collapse", collapse.chi_squared, collapse.sentence.clone());
            run.fit.reasons.push(reason);
            run.fit.verdict = run.fit.verdict.max(Verdict::DoesNotDescribe);
        }
    }
    let mut law: Vec<Fitted> = Vec::new();
    for fitted in runs.iter().flat_map(|run| &run.fit.parameters) {
        if is_of_law(fitted) && law.iter().all(|known| known.key != fitted.key) {
            law.push(fitted.clone());
        }
    }
    let preset = runs.first().map_or_else(|| first.clone(), |run| run.fit.preset.clone());
    Ok(Together { verdict, law, direction: known.direction, collapse, runs, preset })
}

/// The minimum of all curves, from the law of each and the own values that each has alone: the two best are run to their ends.
fn least(joint: &Joint, alone: &[&Solved], progress: &dyn Progress) -> Option<Minimum> {
    const STARTS: usize = 2;
    const ROUNDS: usize = 100;
    const TOLERANCE: f64 = 1e-7;
    let mut start = vec![f64::NAN; joint.count];
    for ((_, places), alone) in joint.runs.iter().zip(alone) {
        for (place, u) in places.iter().zip(&alone.minimum.parameters) {
            start[*place] = *u;
        }
    }
    let with_law_of = |run: usize| {
        let ((problem, places), mut u) = (&joint.runs[run], start.clone());
        for (j, place) in places.iter().enumerate() {
            if is_shared(&problem.parameters[j].target) {
                u[*place] = alone[run].minimum.parameters[j];
            }
        }
        let residuals = joint.residuals(&u)?;
        Some((cost(residuals.as_slice()), u))
    };
    let mut starts: Vec<(f64, Vec<f64>)> = (0..alone.len()).filter_map(with_law_of).collect();
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    starts.truncate(STARTS);
    let settings =
        Settings { rounds: ROUNDS, tolerance: TOLERANCE, huber: HUBER, nothing: 5e-7, ..Settings::default() };
    let found = starts.iter().filter_map(|(_, u)| minimize(joint, u, &settings, progress));
    found.min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// What all curves determine together.
struct Known {
    condition: f64,
    direction: Option<String>,
    /// The covariance of all values, and (JᵀJ)⁻¹, where they are determined.
    covariance: Option<[DMatrix<f64>; 2]>,
    degrees: f64,
}

fn known(
    joint: &Joint,
    (solved, scatters): (&[Solved], &[Scatter]),
    minimum: &Minimum,
    robust: bool,
) -> Known {
    let p = joint.count;
    let of_rows = |((problem, _), (solved, scatter)): (&(&Problem, _), (&Solved, &Scatter))| {
        problem.real(&solved.minimum.at.residuals).len() as f64 / scatter.correlation.rows()
    };
    let rows: f64 = joint.runs.iter().zip(solved.iter().zip(scatters)).map(of_rows).sum();
    let degrees = ((rows - p as f64) / LOST).max(1.0);
    let none = |condition, direction| Known { condition, direction, covariance: None, degrees };
    let jacobian = minimum.at.jacobian.clone();
    let Some(White { condition, inner, weakest, .. }) = White::of(jacobian, joint.priors().len()) else {
        return none(f64::INFINITY, None);
    };
    let Some(inner) = inner else {
        let (first, _) = &joint.runs[0];
        let words = words(&first.preset, &joint.parameters(), &minimum.at, &minimum.parameters, &weakest);
        return none(condition, Some(words));
    };
    let [mut points, mut bread] = [DMatrix::<f64>::zeros(p, p), DMatrix::zeros(p, p)];
    for ((problem, places), (solved, scatter)) in joint.runs.iter().zip(solved.iter().zip(scatters)) {
        let Sandwich { points: of_points, bread: of_bread, .. } =
            sandwich(problem, solved, &part(&inner, places), &scatter.correlation, robust);
        for (i, a) in places.iter().enumerate() {
            for (j, b) in places.iter().enumerate() {
                points[(*a, *b)] += of_points[(i, j)];
                bread[(*a, *b)] += of_bread[(i, j)];
            }
        }
    }
    for (place, _, sigma) in joint.priors() {
        points[(place, place)] += sigma.powi(-2);
        bread[(place, place)] += sigma.powi(-2);
    }
    let Some(bread) = bread.try_inverse() else { return none(condition, None) };
    let covariance = &bread * points * &bread;
    Known { condition, direction: None, covariance: Some([covariance, inner]), degrees }
}

/// The rows and columns of `places`.
fn part(of: &DMatrix<f64>, places: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(places.len(), places.len(), |i, j| of[(places[i], places[j])])
}

impl Known {
    /// As one curve has it, its values at `places`.
    fn of(&self, places: &[usize]) -> Determined {
        let [covariance, inner] = match &self.covariance {
            Some(both) => both.each_ref().map(|of| Some(part(of, places))),
            None => [None, None],
        };
        let errors = covariance.as_ref().map(|covariance| covariance.diagonal().map(f64::sqrt));
        let correlations = covariance.as_ref().zip(errors.as_ref()).map(|(covariance, errors)| {
            DMatrix::from_fn(errors.len(), errors.len(), |i, j| covariance[(i, j)] / (errors[i] * errors[j]))
        });
        Determined {
            condition: self.condition,
            degrees: errors.as_ref().map(|errors| DVector::repeat(errors.len(), self.degrees)),
            errors,
            correlations,
            inner,
            shares: Vec::new(),
            direction: self.direction.clone(),
        }
    }
}

/// Whether the curves, each fitted `alone` and all of them together, follow one law.
fn collapse(joint: &Joint, (alone, together): (&[&Solved], &[Solved]), scatters: &[Scatter]) -> Collapse {
    let (mut sum, mut rows, mut own) = (0.0, 0.0, 0);
    for (run, (problem, _)) in joint.runs.iter().enumerate() {
        let real = |solved: &Solved| problem.real(&solved.minimum.at.residuals);
        let [one, other] = [&together[run], alone[run]].map(|solved| cost(&real(solved)));
        let as_one = scatters[run].correlation.rows();
        sum += 2.0 * (one - other) / (as_one * stretch(problem, alone[run]).powi(2));
        rows += real(alone[run]).len() as f64 / as_one;
        own += White::of(alone[run].minimum.at.jacobian.clone(), 0).map_or(0, |white| white.rank);
    }
    let chi_squared = sum.max(0.0);
    let values = own.saturating_sub(joint.count);
    let below = (rows - own as f64).max(1.0);
    let chance = if values > 0 { beyond_f(chi_squared / values as f64, values as f64, below) } else { 1.0 };
    let collapses = chance >= CHANCE;
    let much = format!(
        "one law for each of {} runs, {values} values more, makes chi squared smaller by {}",
        joint.runs.len(),
        short(chi_squared, 3)
    );
    let sentence = if collapses {
        format!("the runs follow one law: {much}, as chance does (p = {})", short(chance, 2))
    } else {
        format!("the runs do NOT follow one law: {much}, which chance hardly does (p = {})", short(chance, 2))
    };
    Collapse { chi_squared, values, chance, collapses, sentence }
}
