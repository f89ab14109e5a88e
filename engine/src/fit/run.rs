//! A whole fit: branches, start, minimum, errors, doubts.

use super::determined::determined;
use super::fitted::Fitted;
use super::intervals::{block, bootstrap, profile};
use super::judge::{doubts, of_spring};
use super::least_squares::{Ending, LeastSquares};
use super::options::{FitError, Options};
use super::pose::posed;
use super::problem::{ADHESION, Datum, Instrument, Parameter, Problem, Target};
use super::solve::{Solved, solve};
use super::start::{Tried, start};
use crate::measured::branches::FLOOR;
use crate::measured::{Abscissa, Asked, Noise, Points, Segment};
use crate::preset::Preset;
use crate::preset::data::{BASELINE, OFFSET, TILT};
use crate::progress::{Part, Progress};
use nalgebra::DVector;

/// Rounds of the last fit.
const ROUNDS: usize = 200;
/// Residuals beyond so many times their scale are outliers.
const OUTLIER: f64 = 4.0;

/// One point beside the fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// The point.
    pub datum: Datum,
    /// Its distance, in σ.
    pub residual: f64,
    /// Whether it counts as an outlier.
    pub outlier: bool,
}

/// A fit.
#[derive(Debug, Clone)]
pub struct Fit {
    /// What x of the points is.
    pub abscissa: Abscissa,
    /// The values.
    pub parameters: Vec<Fitted>,
    /// Their correlations; `None` where they are not determined.
    pub correlations: Option<Vec<Vec<f64>>>,
    /// Σr²/(n − p), r in σ; in units of the residuals' own scale where σ comes from them.
    pub chi_squared: f64,
    /// Points in contact, and apart.
    pub points: [usize; 2],
    /// How many are outliers.
    pub outliers: usize,
    /// Samples within jumps, and rows left out otherwise.
    pub dropped: [usize; 2],
    /// The condition of the whitened Jacobian.
    pub condition: f64,
    /// What cannot be told, in words; `None` where all is determined.
    pub direction: Option<String>,
    /// How it ended.
    pub ending: Ending,
    /// The starts that were run, the best first, by their ends.
    pub starts: Vec<Tried>,
    /// The snaps of the fitted path.
    pub snaps: usize,
    /// σ of x, P and s, and whether each was assumed.
    pub noise: Noise,
    /// Whether σ of P comes from the residuals.
    pub noise_from_residuals: bool,
    /// How many fits of the bootstrap there were, and the rows of its blocks.
    pub bootstrapped: Option<[usize; 2]>,
    /// What was found, assumed and held, in words.
    pub notes: Vec<String>,
    /// What is to be doubted, in words.
    pub warnings: Vec<String>,
    /// The preset with the fitted values.
    pub preset: Preset,
    /// The values between model and instrument.
    pub instrument: Instrument,
    /// The points beside the fit.
    pub residuals: Vec<Residual>,
}

/// Fits the free keys of `preset` to its own measured curve, as [`fit`] does.
///
/// # Errors
/// [`FitError`].
pub fn fit_own(preset: &Preset, options: &Options, progress: &dyn Progress) -> Result<Fit, FitError> {
    let (source, reading) = (preset.data.source.as_ref().ok_or(FitError::NoData)?, preset.reading());
    let points = source.points(&reading).map_err(FitError::Data)?;
    let asked = Asked { segment: preset.data.segment, ..options.asked };
    let mut found = fit(preset, &points, &Options { asked, ..options.clone() }, progress)?;
    let read = source.measured(&reading.columns).map_err(FitError::Data)?;
    found.notes.splice(0..0, read.notes.iter().cloned());
    Ok(found)
}

/// What x is, and the distances of the points of a preset's own measured curve from its curve as it is.
///
/// # Errors
/// [`FitError`].
pub fn residuals_own(preset: &Preset) -> Result<(Abscissa, Vec<Residual>), FitError> {
    let source = preset.data.source.as_ref().ok_or(FitError::NoData)?;
    let branches = source.branches(&preset.reading()).map_err(FitError::Data)?;
    // A baseline that nobody says is the median of the free part, where a fit begins.
    let problem = posed(preset, &branches, &Options::default(), &mut Vec::new())?;
    let at_start = |problem: &Problem| -> Vec<f64> {
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

/// Fits the free keys of `preset`, its device and what lies between the instrument and it among them, to `points`. Where
/// `progress` says stop, the best so far is what there is.
///
/// # Errors
/// [`FitError`].
pub fn fit(
    preset: &Preset,
    points: &Points,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Fit, FitError> {
    if options.free.is_empty() {
        return Err(FitError::NothingFree);
    }
    let branches = points.branches(&options.asked)?;
    let mut notes = branches.notes.clone();
    let mut problem = posed(preset, &branches, options, &mut notes)?;
    // Without a free part the residuals say how well the force is known.
    let from_residuals = branches.baseline.is_none() && options.asked.sigma[1].is_none();
    let least = from_residuals.then_some(FLOOR * branches.ranges[1]);
    let found = |problem: &mut Problem| -> Result<_, FitError> {
        let (u, starts) = start(problem, options.scan, options.robust, &Part::new(progress, [0.0, 0.8]))
            .ok_or(FitError::NoStart)?;
        Ok((starts, last(problem, &u, options.robust, least, &Part::new(progress, [0.8, 0.85]))?))
    };
    let (mut starts, mut solved) = found(&mut problem)?;
    if let Some(why) = problem.overlapping(&solved.minimum.parameters) {
        problem = problem.without_loading(why, &mut notes)?;
        (starts, solved) = found(&mut problem)?;
    }
    if from_residuals {
        notes.push(
            "there is no free part: sigma of the force is that of the residuals, and the baseline is held"
                .to_owned(),
        );
    }
    let u = &solved.minimum.parameters;
    let what = determined(&problem, &solved.minimum.at, u, solved.scale, options.robust);
    let mut fitted = values(&problem, u, what.errors.as_ref());
    let bootstrapped = match &what.errors {
        Some(errors) => {
            intervals(&problem, &solved, options, errors, &mut fitted, &Part::new(progress, [0.85, 0.95]))
        }
        None => None,
    };
    notes.extend(of_spring(&problem, &solved, options.robust, &Part::new(progress, [0.95, 1.0])));
    let found = problem.preset_at(u, Segment::Retraction).ok_or(FitError::NoStart)?;
    let real = problem.real(&solved.minimum.at.residuals);
    let scale = if from_residuals { solved.scale } else { 1.0 };
    let degrees = (real.len() - u.len().min(real.len())).max(1) as f64;
    let known_noise = !from_residuals && !branches.noise.assumed[1];
    let residuals = beside(&problem, &solved.minimum.at.residuals, solved.scale);
    let count = |free: bool| problem.data.iter().filter(|datum| datum.free == free).count();
    let fitted_preset = laid(preset, &problem, (&found, &problem.instrument_at(u)), &mut notes);
    let rows = |c: nalgebra::DMatrix<f64>| c.row_iter().map(|row| row.iter().copied().collect()).collect();
    Ok(Fit {
        abscissa: points.abscissa,
        correlations: what.correlations.map(rows),
        chi_squared: real.iter().map(|r| (r / scale).powi(2)).sum::<f64>() / degrees,
        points: [count(false), count(true)],
        outliers: residuals.iter().filter(|residual| residual.outlier).count(),
        dropped: [branches.list.iter().map(|branch| branch.dropped).sum(), branches.left_out],
        condition: what.condition,
        direction: what.direction,
        ending: if progress.stop() { Ending::Cancelled } else { solved.minimum.ending },
        starts,
        snaps: problem.paths(u).map_or(0, |paths| paths.of(Segment::Retraction).snaps),
        noise: Noise { sigma: problem.sigma, ..branches.noise },
        noise_from_residuals: from_residuals,
        bootstrapped,
        notes,
        warnings: doubts(&problem, &solved, &found, &fitted, known_noise),
        preset: fitted_preset,
        instrument: problem.instrument_at(u),
        residuals,
        parameters: fitted,
    })
}

/// The last fit, from `u`. Where `least` is given, σ of P is that of the residuals, not below it.
fn last(
    problem: &mut Problem,
    u: &[f64],
    robust: bool,
    least: Option<f64>,
    progress: &dyn Progress,
) -> Result<Solved, FitError> {
    /// Fits by which σ of the residuals has settled.
    const TIMES: usize = 2;
    let mut solved = solve(problem, u, robust, ROUNDS, progress).ok_or(FitError::NoStart)?;
    for _ in 0..if least.is_some() { TIMES } else { 0 } {
        problem.sigma[1] = (problem.sigma[1] * solved.scale).max(least.unwrap_or(0.0));
        let u = &solved.minimum.parameters;
        solved = solve(problem, u, robust, ROUNDS, progress).ok_or(FitError::NoStart)?;
    }
    Ok(solved)
}

/// Puts the intervals that are asked for into `fitted`; how many fits of the bootstrap there were, and the rows of its blocks.
fn intervals(
    problem: &Problem,
    solved: &Solved,
    options: &Options,
    errors: &DVector<f64>,
    fitted: &mut [Fitted],
    progress: &dyn Progress,
) -> Option<[usize; 2]> {
    if options.profile {
        for (j, fitted) in fitted.iter_mut().enumerate() {
            fitted.profile = profile(problem, solved, errors[j], j, options.robust, progress);
        }
    }
    let (count, found) = bootstrap(problem, solved, options.robust, options.bootstrap?, progress)?;
    for (fitted, found) in fitted.iter_mut().zip(found) {
        fitted.bootstrap = Some(found);
    }
    let first: Vec<f64> = solved.minimum.at.residuals.iter().step_by(problem.per_point()).copied().collect();
    Some([count, block(&first)])
}

/// The values with their errors.
fn values(problem: &Problem, u: &[f64], errors: Option<&DVector<f64>>) -> Vec<Fitted> {
    let of = |(j, parameter): (usize, &Parameter)| {
        let value = parameter.value(u[j]);
        let standard_error = errors.map(|errors| errors[j] * parameter.slope(value).abs());
        let (key, start) = (parameter.key(), parameter.start);
        Fitted { key, value, standard_error, start, profile: None, bootstrap: None }
    };
    problem.parameters.iter().enumerate().map(of).collect()
}

/// `preset` with the values of `found`; its path stays its own.
fn laid(
    preset: &Preset,
    problem: &Problem,
    (found, instrument): (&Preset, &Instrument),
    notes: &mut Vec<String>,
) -> Preset {
    let mut laid = preset.clone();
    for parameter in &problem.parameters {
        let (key, value) = match &parameter.target {
            Target::Key(key) => (key.as_str(), found.get(key)),
            Target::Adhesion(Segment::Retraction) => (ADHESION, found.get(ADHESION)),
            Target::Adhesion(_) => continue,
            Target::Offset => (OFFSET, Some(instrument.offset.into())),
            Target::Baseline => (BASELINE, Some(instrument.baseline.into())),
            Target::Tilt => (TILT, Some(instrument.tilt.into())),
        };
        if let Some(Err(invalid)) = value.map(|value| laid.set(key, value)) {
            notes.push(format!("{key} could not be laid over the preset: {invalid}"));
        }
    }
    laid
}

/// The points with their distances.
fn beside(problem: &Problem, residuals: &DVector<f64>, scale: f64) -> Vec<Residual> {
    let per = problem.per_point();
    let of = |(i, datum): (usize, &Datum)| {
        let largest = (0..per).map(|k| residuals[per * i + k].abs()).fold(0.0, f64::max);
        let outlier = largest > OUTLIER * scale;
        Residual { datum: *datum, residual: residuals[per * i], outlier }
    };
    problem.data.iter().enumerate().map(of).collect()
}
