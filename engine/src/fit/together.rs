//! One law fitted to several curves: the values of material, gap, edge and device are shared by all; what lies between
//! instrument and model is each curve's own.
//!
//! ```text
//! D = Σ_i (C_i − C_i⁰) 2/(τ_i κ_i²)     F = D/q     q = Σ p_i⁰ − p     ν = Σ n_i/τ_i − p
//! ```
//!
//! with `C_i` the cost of the rows of curve i under one law and `C_i⁰` under its own, τ the rows that count as one, κ
//! the noise of its residuals about its own law, by what they count, and p⁰ the number of values that a curve
//! can adapt alone. Runs that do not collapse on one law have a D that chance hardly gives: F is beyond its quantile.
//! The covariance is that of `determined`, with its sums taken over all curves.

use super::chance::beyond_f;
use super::degrees::LOST;
use super::determined::{Determined, White, determined, sandwich, words};
use super::directed::{branches_of, with_contact};
use super::fitted::Fitted;
use super::intervals::noise;
use super::least_squares::{Ending, Evaluated, LeastSquares, MinimizationSettings, Minimum, cost, minimize};
use super::options::{FitError, Options};
use super::outcome::Fit;
use super::prior::{Prior, with_derivatives, with_terms};
use super::problem::{FitProblem, FreeParameter, START, Target};
use super::run::Posed;
use super::scatter::Scatter;
use super::settled;
use super::solve::{HUBER, NOTHING, SolvedFit, solve};
use super::verdict::{Reason, Verdict};
use crate::measured::{Branches, PointsFile};
use crate::preset::Preset;
use crate::progress::{Progress, ProgressPart};
use crate::units::UnitSystem;
use crate::units::number::short;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;
use std::ops::Range;

/// The chance below which runs do not follow one law.
const CHANCE: f64 = 1e-3;

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
    /// The fit of each curve under the one law, with the errors from all curves.
    pub runs: Vec<CurveFits>,
    /// The preset of the first with the law.
    pub preset: Preset,
}

/// One curve.
#[derive(Debug, Clone)]
pub struct CurveFits {
    /// Under the one law.
    pub fit: Fit,
    /// Under the law that this curve alone would have.
    pub alone: Fit,
}

/// Whether runs follow one law.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Collapse {
    /// By how much χ² is larger under one law than with one of each run.
    pub chi_squared: f64,
    /// How many more values the laws of all runs have.
    pub values: usize,
    /// How likely such an increase is by chance if there is one law.
    pub chance: f64,
    /// Whether there is one law; null where a fit has not come to its end.
    pub collapses: Option<bool>,
    /// The same in words.
    pub sentence: String,
}

/// The curves as one problem, with the residuals of each in units of its noise about its own law.
struct Joint<'a> {
    curves: Vec<JoinedCurve<'a>>,
    count: usize,
    /// What is known before of the values, each once; of a shared value, as the first curve has it.
    priors: Vec<Prior>,
    robust: bool,
}

struct JoinedCurve<'a> {
    problem: &'a FitProblem,
    /// Its minimum under its own law.
    alone: &'a SolvedFit,
    /// The places of its values among those of all.
    places: Vec<usize>,
}

impl JoinedCurve<'_> {
    /// One over its noise, in σ.
    fn weight(&self) -> f64 {
        1.0 / self.alone.scale
    }

    /// The rows and columns of its values.
    fn part(&self, of: &DMatrix<f64>) -> DMatrix<f64> {
        let places = &self.places;
        DMatrix::from_fn(places.len(), places.len(), |i, j| of[(places[i], places[j])])
    }

    /// Its values, out of those of all curves.
    fn own(&self, u: &[f64]) -> Vec<f64> {
        self.places.iter().map(|place| u[*place]).collect()
    }
}

/// Whether a value is shared by all curves.
fn is_of_law(key: &str) -> bool {
    !key.starts_with("data.") && key != START
}

impl<'a> Joint<'a> {
    fn of(posed: &'a [Posed<'_>], robust: bool) -> Self {
        let parameters = posed.iter().flat_map(|posed| &posed.problem.parameters);
        let mut law: Vec<&Target> = Vec::new();
        for FreeParameter { target, .. } in parameters {
            if is_of_law(&target.key()) && !law.contains(&target) {
                law.push(target);
            }
        }
        let mut count = law.len();
        let mut place = |target: &Target| {
            law.iter().position(|own| *own == target).unwrap_or_else(|| {
                count += 1;
                count - 1
            })
        };
        let of = |posed: &'a Posed<'_>| JoinedCurve {
            problem: &posed.problem,
            alone: &posed.solved,
            places: posed.problem.parameters.iter().map(|parameter| place(&parameter.target)).collect(),
        };
        let curves: Vec<_> = posed.iter().map(of).collect();
        let mut priors: Vec<Prior> = Vec::new();
        for JoinedCurve { problem, places, .. } in &curves {
            for prior in &problem.priors {
                let parameter = places[prior.parameter];
                if priors.iter().all(|known| known.parameter != parameter) {
                    priors.push(Prior { parameter, ..*prior });
                }
            }
        }
        Self { curves, count, priors, robust }
    }

    /// Residuals beyond it count linearly.
    fn huber(&self) -> f64 {
        if self.robust { HUBER } else { f64::INFINITY }
    }

    /// The values, each as in the first curve that has it.
    fn parameters(&self) -> Vec<FreeParameter> {
        let of_place = |place: usize| {
            let has = |curve: &JoinedCurve| {
                let j = curve.places.iter().position(|own| *own == place)?;
                Some(curve.problem.parameters[j].clone())
            };
            self.curves.iter().find_map(has)
        };
        (0..self.count).filter_map(of_place).collect()
    }

    /// Rows of each curve among all.
    fn blocks(&self) -> Vec<Range<usize>> {
        let mut from = 0;
        let block = |curve: &JoinedCurve| {
            let block = from..from + curve.problem.data.len() * curve.problem.per_point();
            from = block.end;
            block
        };
        self.curves.iter().map(block).collect()
    }

    /// One curve at the minimum of all, its residuals in σ again.
    fn solved(&self, (curve, block): (&JoinedCurve, &Range<usize>), minimum: &Minimum) -> SolvedFit {
        let scale = curve.alone.scale;
        let residuals = minimum.at.residuals.rows(block.start, block.len()) * scale;
        let jacobian = DMatrix::from_fn(block.len(), curve.places.len(), |i, j| {
            minimum.at.jacobian[(block.start + i, curve.places[j])] * scale
        });
        let cost = cost(&residuals, None, self.huber() * scale);
        let parameters = curve.own(&minimum.parameters);
        let at = Evaluated { residuals, jacobian };
        SolvedFit { minimum: Minimum { parameters, at, cost, ..minimum.clone() }, scale }
    }

    /// Each curve at the minimum of all.
    fn all_solved(&self, minimum: &Minimum) -> Vec<SolvedFit> {
        let blocks = self.blocks();
        self.curves.iter().zip(&blocks).map(|of| self.solved(of, minimum)).collect()
    }

    /// Half the sum of squares of the points of a curve.
    fn cost(&self, curve: &JoinedCurve, solved: &SolvedFit) -> f64 {
        let residuals = DVector::from_vec(curve.problem.real(&solved.minimum.at.residuals));
        cost(&residuals, None, self.huber() * curve.alone.scale)
    }

    /// Fits of single curves from where the law of all left them, for those that it fits better than their own fits do:
    /// these ended in other minima.
    fn nearer(&self, minimum: &Minimum, progress: &dyn Progress) -> Vec<(usize, SolvedFit)> {
        let blocks = self.blocks();
        let each = self.curves.iter().zip(&blocks).enumerate();
        each.filter_map(|(run, (curve, block))| {
            let under_law = self.solved((curve, block), minimum);
            if self.cost(curve, &under_law) >= self.cost(curve, curve.alone) {
                return None;
            }
            let from = &under_law.minimum.parameters;
            Some((run, solve(curve.problem, from, self.robust, settled::ROUNDS, progress)?))
        })
        .collect()
    }
}

impl LeastSquares for Joint<'_> {
    type Look = Vec<<FitProblem as LeastSquares>::Look>;

    fn look(&self, u: &[f64]) -> Option<(DVector<f64>, Self::Look)> {
        let mut all: Vec<f64> = Vec::new();
        let mut looks = Vec::new();
        for curve in &self.curves {
            let (residuals, look) = curve.problem.look(&curve.own(u))?;
            all.extend(residuals.iter().map(|r| r * curve.weight()));
            looks.push(look);
        }
        Some((DVector::from_vec(all), looks))
    }

    fn derivatives(&self, u: &[f64], looks: &Self::Look) -> Option<DMatrix<f64>> {
        let blocks = self.blocks();
        let mut jacobian = DMatrix::zeros(blocks.last().map_or(0, |block| block.end), self.count);
        for ((curve, block), look) in self.curves.iter().zip(&blocks).zip(looks) {
            let own = curve.problem.derivatives(&curve.own(u), look)? * curve.weight();
            for (j, place) in curve.places.iter().enumerate() {
                jacobian.view_mut((block.start, *place), (own.nrows(), 1)).copy_from(&own.column(j));
            }
        }
        Some(jacobian)
    }

    fn priors(&self) -> &[Prior] {
        &self.priors
    }
}

/// Fits the free keys of `presets`, each with its own measured curve, device and rate, to all curves at once.
///
/// # Errors
/// The number of the curve, and its [`FitError`]; [`FitError::NoStart`] for the first where no law reaches all points.
pub fn fit_together(
    presets: &[Preset],
    options: &Options,
    progress: &dyn Progress,
) -> Result<Together, (usize, FitError)> {
    if options.free.is_empty() {
        return Err((0, FitError::NothingFree));
    }
    let numbered = |run: usize| move |error| (run, error);
    for run in 0..presets.len() {
        belongs(presets, run).map_err(numbered(run))?;
    }
    // Options for the errors of one curve do not apply to those of all.
    let options = &Options { profile: false, bootstrap: None, ..options.clone() };
    let presets: Vec<Preset> = presets
        .iter()
        .map(|preset| with_contact(preset, options, &ProgressPart::new(progress, [0.0, 0.0])))
        .collect();
    let branches = |(run, preset)| branches_of(preset, options).map_err(numbered(run));
    let branches: Vec<Branches> = presets.iter().enumerate().map(branches).collect::<Result<_, _>>()?;
    let mut posed = Vec::new();
    for (run, (preset, branches)) in presets.iter().zip(&branches).enumerate() {
        let share = |run: usize| 0.9 * run as f64 / presets.len() as f64;
        let part = ProgressPart::new(progress, [share(run), share(run + 1)]);
        posed.push(Posed::new(preset, branches, options, &part).map_err(numbered(run))?);
    }
    let least_of = |posed: &[Posed<'_>]| {
        least(&Joint::of(posed, options.robust), progress).ok_or((0, FitError::NoStart))
    };
    let mut minimum = least_of(&posed)?;
    let under_law = Joint::of(&posed, options.robust).all_solved(&minimum);
    let mut has_left_out = false;
    for (posed, under) in posed.iter_mut().zip(&under_law) {
        has_left_out |= posed.leaves_out_closing(under, progress);
    }
    if has_left_out {
        minimum = least_of(&posed)?;
    }
    let nearer = Joint::of(&posed, options.robust).nearer(&minimum, progress);
    if !nearer.is_empty() {
        for (run, solved) in nearer {
            posed[run].solved = solved;
        }
        minimum = least_of(&posed)?;
    }
    let joint = Joint::of(&posed, options.robust);
    let solved = joint.all_solved(&minimum);
    let scatters: Vec<Scatter> =
        joint.curves.iter().zip(&solved).map(|(curve, solved)| curve.problem.scatter(solved)).collect();
    let known = known(&joint, (&solved, &scatters), &minimum);
    let collapse = collapse(&joint, &solved, &scatters);
    let mut runs = Vec::new();
    for (run, (solved, scatter)) in solved.into_iter().zip(scatters).enumerate() {
        let alone = posed[run].clone();
        let own = alone.problem.scatter(&alone.solved);
        let what = determined(&alone.problem, &alone.solved, &own, options.robust);
        let alone = alone.fit(what, own, false, progress).map_err(numbered(run))?;
        let what = known.of(&joint.curves[run]);
        let mut under_law = posed[run].clone();
        under_law.solved = solved;
        let mut fit = under_law.fit(what, scatter, false, progress).map_err(numbered(run))?;
        if collapse.collapses == Some(false) {
            fit.reasons.push(Reason::new("collapse", collapse.chi_squared, collapse.sentence.clone()));
            fit.verdict = fit.verdict.max(Verdict::DoesNotDescribe);
        }
        runs.push(CurveFits { fit, alone });
    }
    let law = law(&runs);
    let verdict = runs.iter().map(|run| run.fit.verdict).max().unwrap_or(Verdict::NotConverged);
    let preset = runs.first().map(|run| run.fit.preset.clone()).ok_or((0, FitError::NoData))?;
    Ok(Together { verdict, law, direction: known.direction, collapse, runs, preset })
}

/// The values of the law, each as in the first curve that has it.
fn law(runs: &[CurveFits]) -> Vec<Fitted> {
    let mut law: Vec<Fitted> = Vec::new();
    for fitted in runs.iter().flat_map(|run| run.fit.parameters.iter()) {
        if is_of_law(&fitted.key) && law.iter().all(|known| known.key != fitted.key) {
            law.push(fitted.clone());
        }
    }
    law
}

/// Whether a curve can be fitted with those before it: their numbers are in the same units, and none of them has the same points.
fn belongs(presets: &[Preset], run: usize) -> Result<(), FitError> {
    let (before, preset) = (&presets[..run], &presets[run]);
    let is_si = |preset: &Preset| matches!(preset.units, UnitSystem::Si(_));
    if before.iter().any(|other| is_si(other) != is_si(preset)) {
        return Err(FitError::Data("one problem is in SI and another in reduced units".to_owned()));
    }
    let has_same = |other: &Preset| {
        let is_same = |of: &PointsFile| other.data.source.as_deref().is_some_and(|own| own.has_bytes_of(of));
        preset.data.source.as_deref().is_some_and(is_same) && other.reading() == preset.reading()
    };
    if before.iter().any(has_same) {
        return Err(FitError::Data("the same points are given twice, and would count twice".to_owned()));
    }
    Ok(())
}

/// The minimum of all curves, starting from the law of each and the own values that each has alone; the two best starts
/// are run to their ends.
fn least(joint: &Joint, progress: &dyn Progress) -> Option<Minimum> {
    const STARTS: usize = 2;
    const ROUNDS: usize = 100;
    const TOLERANCE: f64 = 1e-7;
    let lay = |curve: &JoinedCurve, u: &mut [f64], law_alone: bool| {
        for (j, place) in curve.places.iter().enumerate() {
            if !law_alone || is_of_law(&curve.problem.parameters[j].key()) {
                u[*place] = curve.alone.minimum.parameters[j];
            }
        }
    };
    let mut start = vec![f64::NAN; joint.count];
    joint.curves.iter().for_each(|curve| lay(curve, &mut start, false));
    let with_law_of = |curve: &JoinedCurve| {
        let mut u = start.clone();
        lay(curve, &mut u, true);
        let residuals = with_terms(joint.residuals(&u)?, &joint.priors, &u);
        Some((cost(&residuals, None, joint.huber()), u))
    };
    let mut starts: Vec<(f64, Vec<f64>)> = joint.curves.iter().filter_map(with_law_of).collect();
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    starts.truncate(STARTS);
    let settings = MinimizationSettings {
        rounds: ROUNDS,
        tolerance: TOLERANCE,
        huber: joint.huber(),
        nothing: 0.5 * NOTHING * NOTHING,
        ..MinimizationSettings::default()
    };
    let found = starts.iter().filter_map(|(_, u)| minimize(joint, u, &settings, progress));
    found.min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// What all curves determine together.
struct JointUncertainty {
    condition: f64,
    direction: Option<String>,
    /// The covariance of all values, and (JᵀJ)⁻¹, where they are determined.
    covariance: Option<[DMatrix<f64>; 2]>,
    degrees: f64,
}

fn known(
    joint: &Joint,
    (solved, scatters): (&[SolvedFit], &[Scatter]),
    minimum: &Minimum,
) -> JointUncertainty {
    let p = joint.count;
    let all = || joint.curves.iter().zip(solved.iter().zip(scatters));
    let of_rows = |(curve, (solved, scatter)): (&JoinedCurve, (&SolvedFit, &Scatter))| {
        curve.problem.real(&solved.minimum.at.residuals).len() as f64 / scatter.correlation.rows()
    };
    let lost = if joint.robust { LOST } else { 1.0 };
    let degrees = ((all().map(of_rows).sum::<f64>() - p as f64) / lost).max(1.0);
    let none = |condition, direction| JointUncertainty { condition, direction, covariance: None, degrees };
    let jacobian = with_derivatives(minimum.at.jacobian.clone(), &joint.priors, 1.0);
    let white = White::of(jacobian, joint.priors.len());
    let Some(White { condition, inner, weakest, .. }) = white else {
        return none(f64::INFINITY, None);
    };
    let Some(inner) = inner else {
        let preset = &joint.curves[0].problem.preset;
        // The sentence is about the noise of points, not about values given with an error.
        let of_points = &minimum.at.jacobian;
        let words = words(preset, &joint.parameters(), of_points, &minimum.parameters, &weakest);
        return none(condition, Some(words));
    };
    let [mut points, mut bread] = [DMatrix::<f64>::zeros(p, p), DMatrix::zeros(p, p)];
    for (curve, (solved, scatter)) in all() {
        let own = curve.part(&inner) * curve.weight().powi(2);
        let beside = curve.problem.beside_folds(solved);
        let solved = beside.as_ref().unwrap_or(solved);
        let sandwich = sandwich(curve.problem, solved, &own, &scatter.correlation, joint.robust);
        // Rows and columns are each smaller by this factor, and so is the noise of the points.
        let (of_points, of_bread) = (curve.weight().powi(4), curve.weight().powi(2));
        for (i, a) in curve.places.iter().enumerate() {
            for (j, b) in curve.places.iter().enumerate() {
                points[(*a, *b)] += of_points * sandwich.points[(i, j)];
                bread[(*a, *b)] += of_bread * sandwich.bread[(i, j)];
            }
        }
    }
    for Prior { parameter, sigma, .. } in &joint.priors {
        points[(*parameter, *parameter)] += sigma.powi(-2);
        bread[(*parameter, *parameter)] += sigma.powi(-2);
    }
    let Some(bread) = bread.try_inverse() else { return none(condition, None) };
    let covariance = &bread * points * &bread;
    JointUncertainty { condition, direction: None, covariance: Some([covariance, inner]), degrees }
}

impl JointUncertainty {
    /// The same for one curve.
    fn of(&self, curve: &JoinedCurve) -> Determined {
        let [covariance, inner] = match &self.covariance {
            Some(both) => both.each_ref().map(|of| Some(curve.part(of))),
            None => [None, None],
        };
        let inner = inner.map(|inner| inner * curve.weight().powi(2));
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

/// How many directions of the values take a degree of freedom each from χ², where the residuals scatter by `noise`: a direction
/// that is known too poorly for an error takes one too, as long as the values in it have room to adapt.
fn adapting(jacobian: &DMatrix<f64>, noise: f64) -> usize {
    /// Logarithms of values have room for a few units: a change by 1 shows by this many σ.
    const SHOWS: f64 = 0.2;
    jacobian.singular_values().iter().filter(|value| **value > SHOWS * noise).count()
}

/// Whether the curves follow one law, under which they are `together`.
fn collapse(joint: &Joint, together: &[SolvedFit], scatters: &[Scatter]) -> Collapse {
    let (mut sum, mut rows, mut own) = (0.0, 0.0, 0);
    for ((curve, together), scatter) in joint.curves.iter().zip(together).zip(scatters) {
        let JoinedCurve { problem, alone, .. } = curve;
        let [one, other] = [together, alone].map(|solved| joint.cost(curve, solved));
        let as_one = scatter.correlation.rows();
        sum += 2.0 * (one - other) / (as_one * noise(problem, alone, joint.robust).powi(2));
        rows += problem.real(&alone.minimum.at.residuals).len() as f64 / as_one;
        own += adapting(&alone.minimum.at.jacobian, noise(problem, alone, joint.robust) * as_one.sqrt());
    }
    let chi_squared = sum.max(0.0);
    let values = own.saturating_sub(joint.count);
    let below = (rows - own as f64).max(1.0);
    let chance = if values > 0 { beyond_f(chi_squared / values as f64, values as f64, below) } else { 1.0 };
    let ended = |solved: &SolvedFit| solved.minimum.ending == Ending::Converged;
    let all_ended = together.iter().all(ended) && joint.curves.iter().all(|curve| ended(curve.alone));
    let collapses = all_ended.then_some(chance >= CHANCE);
    let much = format!(
        "one law for each of {} runs, with {values} more values, lowers chi squared by {}",
        joint.curves.len(),
        short(chi_squared, 3)
    );
    let p = short(chance, 2);
    let sentence = match collapses {
        Some(true) => format!("the runs follow one law: {much}, as chance would (p = {p})"),
        Some(false) => {
            format!("the runs do NOT follow one law: {much}, which chance hardly would (p = {p})")
        }
        None => "whether the runs follow one law is not known, as a fit has not come to its end".to_owned(),
    };
    Collapse { chi_squared, values, chance, collapses, sentence }
}
