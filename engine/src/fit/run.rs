//! A whole fit: branches, start, minimum, errors, doubts.

use super::chance::t_of;
use super::determined::{Determined, determined};
use super::fitted::Fitted;
use super::intervals::{FEW_DEGREES, block, bootstrap, profile};
use super::judge::{Evidence, doubts, of_sparse, of_spring, reasons, unseen};
use super::least_squares::{Ending, LeastSquares};
use super::options::{FitError, Options, letter};
use super::pose::posed;
use super::prior::Prior;
use super::problem::{ADHESION, Datum, FitProblem, FreeParameter, Instrument, Paths, START, Target};
use super::pulled::is_pulled;
use super::rows::Rows;
use super::scatter::Scatter;
use super::solve::{SolvedFit, solve};
use super::start::{Tried, start};
use super::uncertain::{uncertain, written};
use super::verdict::{Reason, Verdict};
use crate::elementary::{ln, pow};
use crate::gap::Gap;
use crate::measured::branches::FLOOR;
use crate::measured::{Abscissa, Branches, Noise, Origin, Segment};
use crate::preset::data::{BASELINE, OFFSET, TILT};
use crate::preset::{Preset, Value, edge};
use crate::progress::{Progress, ProgressPart};
use crate::units::number::short;
use crate::units::{
    Quantity,
    number::{said, significant},
};
use nalgebra::DVector;
use serde::Serialize;

/// Rounds of the last fit.
const ROUNDS: usize = 200;
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

/// What was known of a value before, with an error.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Given {
    /// Its dotted key.
    pub key: String,
    /// The value, in base units.
    pub value: f64,
    /// Its standard deviation, likewise.
    pub standard_error: f64,
    /// Its share of the variance of each fitted value, in their order.
    pub shares: Vec<f64>,
}

/// A fit.
#[derive(Debug, Clone)]
pub struct Fit {
    /// What it comes to.
    pub verdict: Verdict,
    /// What speaks against it; empty where the model describes the points.
    pub reasons: Vec<Reason>,
    /// What x of the points is.
    pub abscissa: Abscissa,
    /// The values.
    pub parameters: Vec<Fitted>,
    /// What was known of them before, with an error.
    pub priors: Vec<Given>,
    /// The correlations of the values; `None` where they are not determined.
    pub correlations: Option<Vec<Vec<f64>>>,
    /// Σr²/(n − p), r in σ.
    pub chi_squared: f64,
    /// Σr²/n of the points in contact, and of those apart.
    pub chi_squared_of: [Option<f64>; 2],
    /// The degrees of freedom of the error that is known least well.
    pub degrees: f64,
    /// The noise of the rows as neighbours show it.
    pub scatter: Scatter,
    /// The rows of the file by branch and part.
    pub rows: Rows,
    /// How many rows are outliers.
    pub outliers: usize,
    /// The condition of the whitened Jacobian.
    pub condition: f64,
    /// What the points cannot tell, in words; `None` where everything is determined.
    pub direction: Option<String>,
    /// How it ended.
    pub ending: Ending,
    /// The starts that were run, by their ends, the best first.
    pub starts: Vec<Tried>,
    /// The snaps of the fitted path.
    pub snaps: usize,
    /// σ of x, P and s, and where each comes from.
    pub noise: Noise,
    /// How many fits of the bootstrap there were, and the rows of its blocks.
    pub bootstrapped: Option<[usize; 2]>,
    /// What was found, assumed and held, in words.
    pub notes: Vec<String>,
    /// What is doubtful, in words.
    pub warnings: Vec<String>,
    /// The preset with the fitted values.
    pub preset: Preset,
    /// The values between model and instrument.
    pub instrument: Instrument,
    /// The points compared with the fit.
    pub residuals: Vec<Residual>,
}

impl Fit {
    /// The values of which a combination is known far better than each alone, in words: pairs, and what depends on a
    /// radius of curvature that the points do not show.
    pub fn known_together(&self) -> Vec<String> {
        /// Beyond this correlation the errors of two values say little about both together.
        const TOGETHER: f64 = 0.98;
        let rows = self.correlations.iter().flatten().enumerate();
        let pairs = rows.flat_map(|(i, row)| row.iter().take(i).enumerate().map(move |(j, r)| ([j, i], *r)));
        let together = pairs.filter(|(_, r)| r.abs() > TOGETHER);
        let sentence = |([j, i], r): ([usize; 2], f64)| {
            let [a, b] = [j, i].map(|k| letter(&self.preset, &self.parameters[k].key));
            format!("{a} and {b} are known together far better than alone (correlation {r:+.4})")
        };
        self.of_radius().into_iter().chain(together.map(sentence)).collect()
    }

    /// A sentence on a radius of curvature that is held: (R, E*, γ) → (a²R, E*/a, γ/a²) leaves P(δ) of a sphere as it is.
    fn of_radius(&self) -> Option<String> {
        let gap = &self.preset.gap;
        let radius = gap.radius_of_curvature().filter(|_| gap.feature_length().is_none())?;
        let is_free = |key: &str| self.parameters.iter().any(|fitted| fitted.key.starts_with(key));
        let has_radii = self.abscissa == Abscissa::Radius || self.noise.sigma[2] > 0.0;
        let depends = is_free(ADHESION) || is_free("material.effective_modulus");
        if has_radii || !depends || is_free("gap.radius_of_curvature") {
            return None;
        }
        let radius = said(&self.preset.units, Quantity::Length, radius);
        Some(format!(
            "E* and γ hold for R = {radius}, which is not fitted: without contact radii the points show E*√R and γR"
        ))
    }

    /// Whether what was found holds for `preset`: it has the same points, taken in the same way, and all the fitted and
    /// all the held values of the fit. Its path, which a fit does not see, may differ.
    pub fn holds_for(&self, preset: &Preset) -> bool {
        let found = &self.preset;
        let mut same = preset.clone();
        same.title.clone_from(&found.title);
        same.data.free.clone_from(&found.data.free);
        same.data.uncertain.clone_from(&found.data.uncertain);
        same.basis.clone_from(&found.basis);
        let has_same_device = preset.path.control == found.path.control;
        same.path = found.path;
        has_same_device && same == *found
    }
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
    let residuals = LeastSquares::residuals(&problem, &u).ok_or(FitError::NoStart)?;
    let scale = problem.scale(&residuals);
    Ok((branches.abscissa, beside(&problem, &residuals, scale)))
}

/// What is fitted to the branches of one file, where its starts ended, and its minimum.
#[derive(Clone)]
pub(super) struct Posed<'a> {
    preset: &'a Preset,
    branches: &'a Branches,
    options: &'a Options,
    pub(super) problem: FitProblem,
    starts: Vec<Tried>,
    pub(super) solved: SolvedFit,
    notes: Vec<String>,
}

impl<'a> Posed<'a> {
    /// Poses and solves the fit of the free keys of `preset` to `branches`.
    pub(super) fn new(
        preset: &'a Preset,
        branches: &'a Branches,
        options: &'a Options,
        progress: &dyn Progress,
    ) -> Result<Self, FitError> {
        let mut notes = branches.notes.clone();
        let mut problem = posed(preset, branches, options, &mut notes)?;
        // Without rows apart, neighbours tell how well the force is known, never the residuals themselves.
        let of_neighbours = branches.noise.from[1] == Origin::Neighbours;
        // For radii, only the slope of the curve tells the noise of x and of P apart.
        let of_both = branches.abscissa == Abscissa::Radius && branches.noise.from[0] == Origin::Assumed;
        let least = of_neighbours
            .then_some([if of_both { problem.sigma[0] } else { f64::INFINITY }, FLOOR * branches.ranges[1]]);
        let found = |problem: &mut FitProblem| -> Result<_, FitError> {
            let (u, starts) =
                start(problem, options.scan, options.robust, &ProgressPart::new(progress, [0.0, 0.8]))
                    .ok_or(FitError::NoStart)?;
            Ok((starts, last(problem, &u, options.robust, least, &ProgressPart::new(progress, [0.8, 0.85]))?))
        };
        let (mut starts, mut solved) = found(&mut problem)?;
        if let Some(why) = problem.overlapping(&solved.minimum.parameters) {
            problem = problem.without_loading(why, &mut notes)?;
            (starts, solved) = found(&mut problem)?;
        }
        if let Some(j) = unpinned(&problem, &solved) {
            let mut u = solved.minimum.parameters;
            problem = problem.holding(j, u.remove(j)).ok_or(FitError::NoStart)?;
            solved =
                last(&mut problem, &u, options.robust, least, &ProgressPart::new(progress, [0.8, 0.85]))?;
            notes.push("no rows show that the edge is pinned between approach and retraction".to_owned());
        }
        if branches.noise.from[1] == Origin::Apart {
            solved = of_correlated(&mut problem, solved, options.robust, progress);
        }
        if preset.data.uncertain.is_empty() {
            solved = of_tare(&mut problem, solved, options.robust, (&mut notes, progress));
        }
        if branches.baseline.is_none() {
            notes.push(
                "there is no free part: the baseline is held, and its error is not in those of the values (measure until \
                 the bodies are apart, or give data.baseline); sigma of the force is taken from neighbouring rows"
                    .to_owned(),
            );
        }
        Ok(Self { preset, branches, options, problem, starts, solved, notes })
    }

    /// The fit, where `what` is determined by its points `alone` or by others too.
    pub(super) fn fit(
        self,
        mut what: Determined,
        scatter: Scatter,
        alone: bool,
        progress: &dyn Progress,
    ) -> Result<Fit, FitError> {
        let Self { preset, branches, options, problem, starts, solved, mut notes } = self;
        let u = &solved.minimum.parameters;
        notes.extend(growth(&problem, u, &what));
        let unseen = unseen(&problem, &solved, (&what, &scatter), options.robust, progress);
        let is_unseen = unseen.is_some();
        if let Some(direction) = unseen {
            what = what.without_errors(direction);
        }
        let priors = given(&problem, &what.shares, &mut notes);
        let real = problem.real(&solved.minimum.at.residuals);
        let rows = real.len() as f64 / scatter.correlation.rows();
        let degrees = match &what.degrees {
            Some(degrees) => degrees.min(),
            None => (rows - problem.taken() as f64).max(1.0),
        };
        let mut fitted = values(&problem, u, what.errors.as_ref().zip(what.degrees.as_ref()));
        let bootstrapped = match &what.errors {
            Some(errors) if alone => {
                let progress = ProgressPart::new(progress, [0.85, 0.95]);
                intervals(&problem, &solved, options, (errors, degrees), &mut fitted, &progress)
            }
            _ => None,
        };
        let found = problem.preset_at(u, Segment::Retraction).ok_or(FitError::NoStart)?;
        let ending = match solved.minimum.ending {
            _ if progress.stop() => Ending::Cancelled,
            // A range that shrinks without end has no minimum.
            Ending::Rounds if is_unseen => Ending::Converged,
            ending => ending,
        };
        let evidence =
            Evidence { problem: &problem, solved: &solved, scatter: &scatter, inner: what.inner.as_ref() };
        let mut reasons = reasons(evidence, &found, branches.clipped);
        reasons.extend(of_sparse(branches, preset));
        let is_known = [Origin::Given, Origin::Apart].contains(&branches.noise.from[1]);
        let residuals = beside(&problem, &solved.minimum.at.residuals, solved.scale);
        let mut warnings = doubts(evidence, &fitted, (&reasons, is_known));
        warnings.extend(too_small(&fitted));
        let closing = problem.preset_at(u, Segment::Approach).map(|preset| preset.material.work_of_adhesion);
        let fitted_preset = laid(preset, &problem, (&found, closing, &problem.instrument_at(u)), &mut notes);
        let lists =
            |c: nalgebra::DMatrix<f64>| c.row_iter().map(|row| row.iter().copied().collect()).collect();
        let left = real.len().saturating_sub(problem.taken()).max(1) as f64;
        Ok(Fit {
            verdict: verdict(ending, what.errors.is_some(), &reasons),
            reasons,
            abscissa: branches.abscissa,
            correlations: what.correlations.map(lists),
            chi_squared: real.iter().map(|r| r * r).sum::<f64>() / left,
            chi_squared_of: [false, true].map(|free| of_part(&problem, &solved, free)),
            degrees,
            priors,
            rows: Rows::of(&problem, branches),
            outliers: residuals.iter().filter(|residual| residual.outlier).count(),
            condition: what.condition,
            direction: what.direction,
            ending,
            starts,
            snaps: problem.paths(u).map_or(0, |paths| paths.of(Segment::Retraction).snaps),
            noise: Noise { sigma: problem.sigma, ..branches.noise },
            bootstrapped,
            notes,
            warnings,
            scatter,
            preset: fitted_preset,
            instrument: problem.instrument_at(u),
            residuals,
            parameters: fitted,
        })
    }
}

/// The number of the contact radius at which an edge is pinned, where the points determine it worse than to a tenth:
/// then the works of adhesion of both branches are the same, and there is no line between them.
fn unpinned(problem: &FitProblem, solved: &SolvedFit) -> Option<usize> {
    const LEAST: f64 = 10.0;
    let j = problem.parameters.iter().position(|parameter| parameter.target == Target::Key(START.to_owned()));
    j.filter(|j| problem.pins() && solved.minimum.at.jacobian.column(*j).norm() < LEAST * solved.scale)
}

/// Fits the free keys of `preset` to `branches`.
pub(super) fn fit_branches(
    preset: &Preset,
    branches: &Branches,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Fit, FitError> {
    let mut posed = Posed::new(preset, branches, options, progress)?;
    let Posed { problem, solved, .. } = &posed;
    let scatter = problem.scatter(solved);
    let what = determined(problem, solved, &scatter, options.robust);
    if what.errors.is_some() {
        let of_spring = of_spring(problem, solved, options.robust, &ProgressPart::new(progress, [0.95, 1.0]));
        posed.notes.extend(of_spring);
    }
    posed.fit(what, scatter, true, progress)
}

/// What was known before, and a sentence where it decides how well a value is known.
fn given(problem: &FitProblem, shares: &[Vec<f64>], notes: &mut Vec<String>) -> Vec<Given> {
    /// Above this share of the variance the points matter less.
    const MOST: f64 = 0.5;
    let none = Vec::new();
    let of = |(i, prior): (usize, &Prior)| {
        let parameter = &problem.parameters[prior.parameter];
        let value = parameter.value(prior.mean);
        let shares = shares.get(i).unwrap_or(&none).clone();
        let standard_error = prior.sigma * parameter.slope(value).abs();
        Given { key: parameter.key(), value, standard_error, shares }
    };
    let given: Vec<Given> = problem.priors.iter().enumerate().map(of).collect();
    for Given { key, shares, .. } in &given {
        let of = problem.parameters.iter().zip(shares).filter(|(_, share)| **share > MOST);
        let told: Vec<String> = of
            .map(|(parameter, share)| {
                format!("{:.0} % of that of {}", 100.0 * share, letter(&problem.preset, &parameter.key()))
            })
            .collect();
        if !told.is_empty() {
            notes.push(format!("the given error of {key} makes up {} (variance)", told.join(", ")));
        }
    }
    given
}

/// How much G of a fast edge grows, G − γ = K vⁿ with K = γ/v₀ⁿ, where its law is fitted. K is known better than γ and
/// v₀, about which a fast pull alone tells nothing more.
fn growth(problem: &FitProblem, u: &[f64], what: &Determined) -> Option<String> {
    if !is_pulled(&problem.preset) {
        return None;
    }
    let preset = problem.preset_at(u, Segment::Retraction)?;
    let (n, speed) = (preset.edge.exponent?, preset.edge.reference_speed?);
    let value = preset.material.work_of_adhesion / pow(speed, n);
    // d ln K with respect to the logarithms of the values.
    let slope = |parameter: &FreeParameter| match &*parameter.key() {
        ADHESION => 1.0,
        edge::REFERENCE_SPEED => -n,
        edge::EXPONENT => -n * ln(speed),
        _ => 0.0,
    };
    let slopes: Vec<f64> = problem.parameters.iter().map(slope).collect();
    let error = what.errors.as_ref().zip(what.correlations.as_ref()).map(|(errors, correlations)| {
        let along = DVector::from_fn(slopes.len(), |j, _| slopes[j] * errors[j]);
        (correlations * &along).dot(&along).max(0.0).sqrt() * value
    });
    let error = error.map_or_else(String::new, |error| format!(" +- {}", significant(error, 2)));
    Some(format!(
        "a fast edge costs K v^n more than gamma, with K = gamma/v0^n = {}{error} in base units",
        significant(value, 4)
    ))
}

/// What a fit comes to.
fn verdict(ending: Ending, is_determined: bool, reasons: &[Reason]) -> Verdict {
    match (ending, is_determined) {
        (Ending::Converged, true) if reasons.is_empty() => Verdict::Describes,
        (Ending::Converged, true) => Verdict::DoesNotDescribe,
        (Ending::Converged, false) => Verdict::NotDetermined,
        _ => Verdict::NotConverged,
    }
}

/// Σr²/n of the points in contact or apart.
fn of_part(problem: &FitProblem, solved: &SolvedFit, free: bool) -> Option<f64> {
    let per = problem.per_point();
    let of = solved.minimum.at.residuals.iter().enumerate();
    let of = of.filter(|(i, _)| problem.data[i / per].free == free && (!free || i.is_multiple_of(per)));
    let [sum, count] = of.fold([0.0; 2], |[sum, count], (_, r)| [sum + r * r, count + 1.0]);
    (count > 0.0).then(|| sum / count)
}

/// The last fit, from `u`. Where `least` is given, σ of P is that of neighbours, but not below the second number; so is
/// σ of x, not below the first, where that is finite.
fn last(
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
    for _ in 0..TIMES {
        let off = if least_x.is_finite() { problem.off(&solved) } else { None };
        let of_force = || problem.scatter(&solved).contact.map(|scale| [1.0, scale]);
        let Some([x, force]) = off.or_else(of_force) else { break };
        if off.is_some() {
            problem.sigma[0] = (problem.sigma[0] * x).max(least_x);
        }
        problem.sigma[1] = (problem.sigma[1] * force).max(least_force);
        let u = &solved.minimum.parameters;
        solved = solve(problem, u, robust, ROUNDS, progress).ok_or(FitError::NoStart)?;
    }
    Ok(solved)
}

/// Fits again where the noise is correlated from row to row: σ is then larger than differences of neighbours tell, by
/// 1/√(1 − r), with r the correlation of neighbours.
fn of_correlated(
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

/// Fits again where the points contradict the assumed tare of the force, 0 ± σ: with the σ of the largest likelihood,
/// σ² = b² − v, where b is the tare that the points alone give, with the variance v; J. O. Berger, *Statistical
/// Decision Theory and Bayesian Analysis* (1985), section 3.5.4.
fn of_tare(
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
    let found = off * off - solved.scale.powi(2) * alone[(j, j)];
    if found.is_nan() || found <= prior.sigma * prior.sigma {
        return solved;
    }
    prior.sigma = found.sqrt();
    let parameter = &problem.parameters[j];
    let wider = parameter.slope(parameter.value(prior.mean)).abs() * prior.sigma;
    notes.push(format!(
        "the points contradict that: the tare is assumed to be off by {}",
        said(&problem.preset.units, Quantity::Force, wider)
    ));
    solve(problem, &solved.minimum.parameters, robust, ROUNDS, progress).unwrap_or(solved)
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

/// A sentence on the standard error that the bootstrap finds to be too small by most.
fn too_small(fitted: &[Fitted]) -> Option<String> {
    let all = fitted.iter().filter_map(|of| Some((of.too_small()?, of)));
    all.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(times, of)| {
        format!(
            "the standard error of {} is {} times too small, as the model is not linear there: use the interval of \
             the bootstrap",
            of.key,
            short(times, 2)
        )
    })
}

/// Puts the intervals that are requested or needed into `fitted`; returns how many fits of the bootstrap there were, and the rows of its
/// blocks.
fn intervals(
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

/// The values with their errors, and the degrees of freedom of these.
pub(super) fn values(
    problem: &FitProblem,
    u: &[f64],
    known: Option<(&DVector<f64>, &DVector<f64>)>,
) -> Vec<Fitted> {
    /// The share of truths outside an interval.
    const OUTSIDE: f64 = 0.05;
    let of = |(j, parameter): (usize, &FreeParameter)| {
        let value = parameter.value(u[j]);
        let standard_error = known.map(|(errors, _)| errors[j] * parameter.slope(value).abs());
        let degrees = known.map(|(_, degrees)| degrees[j]);
        let interval = known.map(|(errors, degrees)| {
            let t = t_of(OUTSIDE, degrees[j]);
            [-t, t].map(|t| parameter.value(u[j] + t * errors[j]))
        });
        let (key, start) = (parameter.key(), parameter.start);
        Fitted { key, value, standard_error, degrees, interval, start, profile: None, bootstrap: None }
    };
    problem.parameters.iter().enumerate().map(of).collect()
}

/// `preset` with the values of `found`; its path stays its own.
fn laid(
    preset: &Preset,
    problem: &FitProblem,
    (found, closing, instrument): (&Preset, Option<f64>, &Instrument),
    notes: &mut Vec<String>,
) -> Preset {
    let mut laid = preset.clone();
    // What was known before stays so: the next fit has the same points, which must count once.
    let known = uncertain(preset, problem.abscissa, &preset.data.uncertain).unwrap_or_default();
    let known: Vec<String> = problem
        .priors
        .iter()
        .map(|prior| (&problem.parameters[prior.parameter], prior))
        .filter(|(parameter, _)| known.iter().any(|known| known.target == parameter.target))
        .map(|(parameter, prior)| written(parameter, prior))
        .collect();
    laid.data.uncertain = known.join(",");
    let opening = found.material.work_of_adhesion;
    // A closing edge gains at most what an opening one costs, so the opening value must be set first.
    let is_closing = |of: &&FreeParameter| of.target == Target::Adhesion(Segment::Approach);
    let all = || problem.parameters.iter();
    for parameter in all().filter(|of| !is_closing(of)).chain(all().filter(is_closing)) {
        let (key, value) = match &parameter.target {
            Target::Key(key) => (key.as_str(), found.get(key)),
            Target::Adhesion(Segment::Retraction) => (ADHESION, found.get(ADHESION)),
            Target::Adhesion(_) => {
                (edge::CLOSING_ADHESION, closing.filter(|closing| *closing <= opening).map(Value::from))
            }
            Target::Offset => (OFFSET, Some(instrument.offset.into())),
            // A baseline that no rows show is known no better by the next fit: it stays as it was given.
            Target::Baseline if !problem.data.iter().any(|datum| datum.free) => continue,
            Target::Baseline => (BASELINE, Some(instrument.baseline.into())),
            Target::Tilt => (TILT, Some(instrument.tilt.into())),
        };
        if let Some(Err(invalid)) = value.map(|value| laid.set(key, value)) {
            notes.push(format!("{key} could not be set in the preset: {invalid}"));
        }
    }
    laid
}

/// The points with their distances.
fn beside(problem: &FitProblem, residuals: &DVector<f64>, scale: f64) -> Vec<Residual> {
    let per = problem.per_point();
    let of = |(i, datum): (usize, &Datum)| {
        let largest = (0..per).map(|k| residuals[per * i + k].abs()).fold(0.0, f64::max);
        let outlier = largest > OUTLIER * scale;
        Residual { datum: *datum, residual: residuals[per * i], outlier }
    };
    problem.data.iter().enumerate().map(of).collect()
}
