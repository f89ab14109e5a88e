//! A whole fit: branches, start, minimum, errors, doubts.

use super::determined::determined;
use super::fitted::Fitted;
use super::intervals::{bootstrap, profile};
use super::judge::{doubts, of_spring};
use super::least_squares::Ending;
use super::options::{FitError, Options, target};
use super::path::Reach;
use super::problem::{ADHESION, BASELINE, Datum, Instrument, Parameter, Problem, Target};
use super::solve::{Solved, solve};
use super::start::{Tried, start};
use crate::gap::Gap;
use crate::measured::{Abscissa, Branches, Points, Segment};
use crate::preset::{BasisSpec, Preset, Value};
use crate::problem::Start;
use nalgebra::DVector;

/// Points in contact for each free parameter, at least.
const PER_PARAMETER: usize = 3;
/// Rounds of the last fit.
const ROUNDS: usize = 200;
/// Residuals beyond so many times their scale are outliers.
const OUTLIER: f64 = 4.0;
/// δ₀ and P₀ begin with a unit of their ranges.
const LEAST_UNIT: f64 = f64::MIN_POSITIVE;

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
    pub noise: crate::measured::Noise,
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

/// Fits the free keys of `preset`, its device among it, to `points`; `go_on` is told the share that is done, and stops it by
/// answering no: the best so far is what there is then.
///
/// # Errors
/// [`FitError`].
pub fn fit(
    preset: &Preset,
    points: &Points,
    options: &Options,
    go_on: &mut dyn FnMut(f64) -> bool,
) -> Result<Fit, FitError> {
    if options.free.is_empty() {
        return Err(FitError::NothingFree);
    }
    let branches = points.branches(&options.asked)?;
    let mut notes = branches.notes.clone();
    let mut problem = problem(preset, &branches, options, &mut notes)?;
    let mut wanted = true;
    let mut told = |share: f64| {
        wanted = wanted && go_on(share);
        wanted
    };
    let (u, starts) = start(&problem, options.scan, options.robust, &mut told).ok_or(FitError::NoStart)?;
    let mut last =
        |problem: &Problem, u: &[f64]| solve(problem, u, options.robust, ROUNDS, &mut || told(0.85));
    let mut solved = last(&problem, &u).ok_or(FitError::NoStart)?;
    // Without a free part the residuals say how well the force is known.
    let from_residuals = branches.baseline.is_none() && options.asked.sigma[1].is_none();
    if from_residuals {
        for _ in 0..2 {
            problem.sigma[1] =
                (problem.sigma[1] * solved.scale).max(crate::measured::branches::FLOOR * branches.ranges[1]);
            solved = last(&problem, &solved.minimum.parameters).ok_or(FitError::NoStart)?;
        }
        notes.push(
            "there is no free part: sigma of the force is that of the residuals, and the baseline is held"
                .to_owned(),
        );
    }
    let at = &solved.minimum.at;
    let u = solved.minimum.parameters.clone();
    let what = determined(&problem, at, &u, solved.scale, options.robust);
    let mut fitted = values(&problem, &u, what.errors.as_ref());
    let mut bootstrapped = None;
    if let Some(errors) = &what.errors {
        if options.profile {
            for (j, fitted) in fitted.iter_mut().enumerate() {
                fitted.profile = profile(&problem, &solved, errors[j], j, options.robust, &mut || told(0.9));
            }
        }
        if let Some(asked) = options.bootstrap {
            let found =
                bootstrap(&problem, &solved, options.robust, asked, &mut |share| told(0.9 + 0.1 * share));
            if let Some((count, found)) = found {
                let per = problem.per_point();
                let first: Vec<f64> = at.residuals.iter().step_by(per).copied().collect();
                bootstrapped = Some([count, super::intervals::block(&first)]);
                for (fitted, found) in fitted.iter_mut().zip(found) {
                    fitted.bootstrap = Some(found);
                }
            }
        }
    }
    notes.extend(of_spring(&problem, &solved, options.robust, &mut || told(0.95)));
    let found = problem.preset_at(&u, Segment::Retraction).ok_or(FitError::NoStart)?;
    let real = problem.real(&at.residuals);
    let scale = if from_residuals { solved.scale } else { 1.0 };
    let free = (real.len() - u.len().min(real.len())).max(1) as f64;
    let chi_squared = real.iter().map(|r| (r / scale).powi(2)).sum::<f64>() / free;
    let known_noise = !from_residuals && !branches.noise.assumed[1];
    let warnings = doubts(&problem, &solved, &found, &fitted, known_noise);
    let residuals = beside(&problem, &solved);
    let snaps = problem.paths(&u, None).map_or(0, |paths| paths.of(Segment::Retraction).snaps);
    let count = |free: bool| problem.data.iter().filter(|datum| datum.free == free).count();
    let mut noise = branches.noise;
    noise.sigma = problem.sigma;
    let fitted_preset = laid(preset, &problem, &found, &mut notes);
    Ok(Fit {
        correlations: what
            .correlations
            .map(|c| c.row_iter().map(|row| row.iter().copied().collect()).collect()),
        chi_squared,
        points: [count(false), count(true)],
        outliers: residuals.iter().filter(|residual| residual.outlier).count(),
        dropped: [branches.list.iter().map(|branch| branch.dropped).sum(), branches.left_out],
        condition: what.condition,
        direction: what.direction,
        ending: if wanted { solved.minimum.ending } else { Ending::Cancelled },
        starts,
        snaps,
        noise,
        noise_from_residuals: from_residuals,
        bootstrapped,
        notes,
        warnings,
        preset: fitted_preset,
        instrument: problem.instrument_at(&u),
        residuals,
        parameters: fitted,
    })
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
fn laid(preset: &Preset, problem: &Problem, found: &Preset, notes: &mut Vec<String>) -> Preset {
    let mut laid = preset.clone();
    for parameter in &problem.parameters {
        let key = match &parameter.target {
            Target::Key(key) => key.as_str(),
            Target::Adhesion(Segment::Retraction) => ADHESION,
            _ => continue,
        };
        if found.get(key).is_some_and(|value| laid.set(key, value).is_err()) {
            notes.push(format!("{key} could not be laid over the preset, whose path it forbids"));
        }
    }
    laid
}

/// The points with their distances.
fn beside(problem: &Problem, solved: &Solved) -> Vec<Residual> {
    let per = problem.per_point();
    let residuals = &solved.minimum.at.residuals;
    let of = |(i, datum): (usize, &Datum)| {
        let largest = (0..per).map(|k| residuals[per * i + k].abs()).fold(0.0, f64::max);
        let outlier = largest > OUTLIER * solved.scale;
        Residual { datum: *datum, residual: residuals[per * i], outlier }
    };
    problem.data.iter().enumerate().map(of).collect()
}

/// What is fitted to these branches.
fn problem(
    preset: &Preset,
    branches: &Branches,
    options: &Options,
    notes: &mut Vec<String>,
) -> Result<Problem, FitError> {
    let mut bare = preset.clone();
    // Values far off would be refused for where the path of the preset starts, which means nothing here.
    (bare.path.start, bare.path.end_contact_radius, bare.path.turn) = (Start::Force(0.0), None, None);
    let has_waves = preset.gap.feature_length().is_some();
    if preset.basis != BasisSpec::Exact {
        notes.push("the fit is made in the exact basis, whatever basis.kind says".to_owned());
    }
    let mut data = Vec::new();
    for branch in &branches.list {
        let loading = branch.segment == Segment::Approach;
        if loading && has_waves {
            if branches.list.len() == 1 {
                return Err(FitError::Loading);
            }
            notes.push(format!(
                "the {} points of the approach are left out: on a gap with waves loading takes another path, with rings of contact",
                branch.attached.len() + branch.free.len()
            ));
            continue;
        }
        for (free, points) in [(false, &branch.attached), (true, &branch.free)] {
            data.extend(points.iter().map(|&point| Datum { point, segment: branch.segment, free }));
        }
    }
    let mut targets: Vec<Target> = Vec::new();
    for name in &options.free {
        let target = target(preset, branches.abscissa, name)?;
        if !targets.contains(&target) {
            targets.push(target);
        }
    }
    let segments = branches.list.len();
    if options.separate {
        let Some(at) = targets.iter().position(|target| *target == Target::Key(ADHESION.to_owned())) else {
            return Err(FitError::Key {
                key: ADHESION.to_owned(),
                why: "--separate splits it, so it must be free".to_owned(),
            });
        };
        if segments < 2 || data.iter().all(|datum| datum.segment == Segment::Retraction) {
            return Err(FitError::Key {
                key: ADHESION.to_owned(),
                why: "--separate needs both an approach and a retraction that are fitted".to_owned(),
            });
        }
        targets.splice(at..=at, [Target::Adhesion(Segment::Approach), Target::Adhesion(Segment::Retraction)]);
    }
    let mut instrument = Instrument {
        offset: options.offset.unwrap_or(0.0),
        baseline: options.baseline.unwrap_or(0.0),
        tilt: options.tilt.unwrap_or(0.0),
    };
    match branches.baseline {
        Some(found) if options.baseline.is_none() => {
            if !targets.contains(&Target::Baseline) {
                targets.push(Target::Baseline);
                notes.push("data.baseline is fitted too, since there is a free part".to_owned());
            }
            instrument.baseline = found;
        }
        None if targets.contains(&Target::Baseline) => {
            return Err(FitError::Key {
                key: BASELINE.to_owned(),
                why: "there is no free part, which alone says where the baseline is".to_owned(),
            });
        }
        _ => {}
    }
    let parameters = targets.into_iter().map(|target| parameter(preset, branches, &instrument, target));
    let parameters: Vec<Parameter> = parameters.collect();
    let attached = data.iter().filter(|datum| !datum.free).count();
    let needed = PER_PARAMETER * parameters.len().max(2);
    if attached < needed {
        return Err(FitError::Few { points: attached, parameters: parameters.len(), needed });
    }
    let most = |of: fn(&Datum) -> f64| {
        data.iter().map(of).filter(|x| x.is_finite()).fold(f64::NEG_INFINITY, f64::max)
    };
    let of_radius = branches.abscissa == Abscissa::Radius;
    let radius = if of_radius { most(|datum| datum.point.x) } else { most(|datum| datum.point.radius) };
    let reach = Reach {
        most: [most(|datum| datum.point.x), most(|datum| datum.point.force), radius],
        radius: None,
        length: branches.ranges[0],
    };
    let sigma = branches.noise.sigma;
    let space = sigma[2] > 0.0 && !of_radius;
    let abscissa = branches.abscissa;
    Ok(Problem { preset: bare, abscissa, parameters, instrument, data, sigma, space, reach, counts: None })
}

/// A parameter at its start.
fn parameter(preset: &Preset, branches: &Branches, instrument: &Instrument, target: Target) -> Parameter {
    let value = |key: &str| match preset.get(key) {
        Some(Value::Number(value)) => value,
        _ => f64::NAN,
    };
    let [x, force, _] = branches.ranges.map(|range| range.max(LEAST_UNIT));
    let (start, scale) = match &target {
        Target::Key(key) => (value(key), None),
        Target::Adhesion(_) => (value(ADHESION), None),
        Target::Offset => (instrument.offset, Some(x)),
        Target::Baseline => (instrument.baseline, Some(force)),
        Target::Tilt => (instrument.tilt, Some(force / x)),
    };
    Parameter { target, start, scale }
}
