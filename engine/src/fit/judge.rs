//! What is to be doubted about a fit.

use super::fitted::Fitted;
use super::path::Foot;
use super::problem::{ADHESION, Problem, Target};
use super::solve::{Solved, solve};
use crate::elementary::{exp_m1, hypot};
use crate::measured::branches::median;
use crate::measured::{Abscissa, Segment};
use crate::preset::{Preset, Value};
use crate::problem::groups::LARGE_TABOR;
use crate::problem::{Control, Groups};
use crate::progress::Progress;
use crate::units::number::significant;
use crate::units::{UnitSystem, number::short};

/// A contact so wide, or an approach so deep, in units of R, is none of a soft ball.
const WIDE: f64 = 0.5;
const DEEP: f64 = 1.0;
/// Moduli of everything people press, in Pa.
const MODULI: [f64; 2] = [10.0, 1e12];
/// Deviations of the number of runs beyond so many of its own are no chance.
const RUNS: f64 = -5.0;
/// A slope of so many standard deviations is a tilt.
const SLOPED: f64 = 4.5;
/// Runs are counted in so many points at least.
const RUNS_OF: usize = 40;
/// Residuals below this share of the noise are rounding, in which there is always some order.
const ROUNDING: f64 = 0.1;
/// Works of adhesion that differ by less than this share are one, whatever their errors: points without noise have none.
const DIFFERENT: f64 = 1e-3;
/// Residuals so many times the noise of the free part, outliers apart, are more than noise; and how much more where that noise is known
/// from few points, times 1/√n: three of its deviations.
const LARGE_SCALE: f64 = 1.3;
const OF_FEW: f64 = 3.5;

/// The deviation of the number of runs of signs from that of chance, in its own; A. Wald and J. Wolfowitz, Ann. Math. Stat. 11,
/// 147 (1940).
#[must_use]
pub fn runs(residuals: &[f64]) -> f64 {
    let plus = residuals.iter().filter(|r| **r > 0.0).count() as f64;
    let n = residuals.len() as f64;
    let minus = n - plus;
    let runs = 1.0 + residuals.windows(2).filter(|pair| (pair[0] > 0.0) != (pair[1] > 0.0)).count() as f64;
    let mean = 2.0 * plus * minus / n + 1.0;
    let variance = (mean - 1.0) * (mean - 2.0) / (n - 1.0);
    if variance > 0.0 { (runs - mean) / variance.sqrt() } else { f64::NEG_INFINITY }
}

/// The doubts about the fit `solved`, whose fitted preset is `preset`.
pub fn doubts(
    problem: &Problem,
    solved: &Solved,
    preset: &Preset,
    fitted: &[Fitted],
    known_noise: bool,
) -> Vec<String> {
    let mut doubts = Vec::new();
    let u = &solved.minimum.parameters;
    let mut unit = |what: String| doubts.push(format!("{what}: check the unit of x"));
    let radius = preset.gap.radius_of_curvature();
    if let (Some(radius), Some(paths)) = (radius, problem.paths(u)) {
        let (widest, deepest) = extent(problem, u, &paths);
        if widest > WIDE * radius {
            unit(format!("the contact radius reaches {} R", short(widest / radius, 3)));
        }
        if deepest > DEEP * radius {
            unit(format!("the approach reaches {} R", short(deepest / radius, 3)));
        }
    }
    let modulus = preset.material.effective_modulus;
    if matches!(preset.units, UnitSystem::Si(_)) && !(MODULI[0]..=MODULI[1]).contains(&modulus) {
        doubts.push(format!(
            "E* = {} Pa is that of nothing people press: check the unit of x",
            significant(modulus, 3)
        ));
    }
    if let Some(tabor) =
        Groups::of(&preset.problem(), preset.range_of_action()).tabor.filter(|mu| *mu < LARGE_TABOR)
    {
        doubts.push(format!(
            "Tabor's mu = {tabor:.2} is below {LARGE_TABOR}: the adhesion reaches beyond the edge, and the JKR limit of this \
             method does not hold"
        ));
    }
    let adhesions: Vec<&Fitted> = fitted.iter().filter(|fitted| fitted.key.starts_with(ADHESION)).collect();
    if let [approach, retraction] = adhesions[..]
        && let (Some(a), Some(b)) = (approach.standard_error, retraction.standard_error)
        && (approach.value - retraction.value).abs()
            > f64::max(2.0 * hypot(a, b), DIFFERENT * retraction.value)
    {
        doubts.push(
            "the works of adhesion of approach and retraction differ by more than their errors: not a quasi-static loop, but \
             rate or ageing"
                .to_owned(),
        );
    }
    if solved.scale > ROUNDING {
        doubts.extend(of_runs(problem, solved));
    }
    let free = problem.data.iter().filter(|datum| datum.free).count().max(1) as f64;
    if known_noise && solved.scale > LARGE_SCALE + OF_FEW / free.sqrt() {
        doubts.push(format!(
            "the residuals are {} times the noise of the points: a value that is held may be wrong (the stiffness of the \
             device above all), or the model",
            short(solved.scale, 2)
        ));
    }
    doubts
}

/// The slope of the residuals of free points over x, in its own standard deviations; `None` where the tilt is free, or of few points.
fn slope(problem: &Problem, solved: &Solved) -> Option<f64> {
    /// Outliers count as so many σ.
    const MOST: f64 = 3.0;
    if problem.abscissa == Abscissa::Radius || problem.parameters.iter().any(|p| p.target == Target::Tilt) {
        return None;
    }
    let of = problem.data.iter().zip(solved.minimum.at.residuals.iter().step_by(problem.per_point()));
    let of = of.filter(|(datum, _)| datum.free).map(|(datum, r)| (datum.point.x, r.clamp(-MOST, MOST)));
    let (x, r): (Vec<f64>, Vec<f64>) = of.unzip();
    let n = x.len() as f64;
    if x.len() < RUNS_OF {
        return None;
    }
    let (mean_x, mean_r) = (x.iter().sum::<f64>() / n, r.iter().sum::<f64>() / n);
    let [xx, xr, rr] = x.iter().zip(&r).fold([0.0; 3], |[xx, xr, rr], (x, r)| {
        let (x, r) = (x - mean_x, r - mean_r);
        [xx + x * x, xr + x * r, rr + r * r]
    });
    let correlation = xr / (xx * rr).sqrt();
    let deviations = correlation.abs() * n.sqrt();
    deviations.is_finite().then_some(deviations)
}

/// Residuals that keep their sign: of the points in contact, and of those apart.
fn of_runs(problem: &Problem, solved: &Solved) -> Vec<String> {
    let per = problem.per_point();
    let mut doubts = Vec::new();
    let mut signs = Vec::new();
    for (segment, free) in [
        (Segment::Approach, false),
        (Segment::Retraction, false),
        (Segment::Approach, true),
        (Segment::Retraction, true),
    ] {
        let of = problem.data.iter().zip(solved.minimum.at.residuals.iter().step_by(per));
        let of = of.filter(|(datum, _)| datum.free == free && datum.segment == segment);
        let mut of: Vec<(usize, f64)> = of.map(|(datum, r)| (datum.point.row, *r)).collect();
        if free {
            // Of a radius all are at 0 there, and their order is that of the file.
            of.sort_by_key(|(row, _)| *row);
        }
        let of: Vec<f64> = of.into_iter().map(|(_, r)| r).collect();
        let runs = if of.len() < RUNS_OF { 0.0 } else { runs(&of) };
        if runs >= RUNS {
            continue;
        }
        let fewer = if runs.is_finite() {
            format!(
                "keep their sign for long runs ({} standard deviations fewer than by chance)",
                short(-runs, 2)
            )
        } else {
            "have all one sign".to_owned()
        };
        let name = segment.name();
        if free {
            doubts.push(format!(
                "the force is no constant where the bodies are apart: the residuals of the {name} {fewer} there. It drifts, or \
                 has a tilt: free data.tilt"
            ));
        } else {
            signs.push(median(of).is_some_and(|middle| middle > 0.0));
            doubts.push(format!("the model does not describe this: the residuals of the {name} {fewer}"));
        }
    }
    if doubts.iter().all(|doubt| !doubt.contains("data.tilt"))
        && let Some(deviations) = slope(problem, solved).filter(|t| *t > SLOPED)
    {
        doubts.push(format!(
            "the force has a slope over x where the bodies are apart ({} standard deviations): free data.tilt",
            short(deviations, 2)
        ));
    }
    let one = problem.parameters.iter().any(|p| p.target == Target::Key(ADHESION.to_owned()));
    if let ([a, b], true) = (signs.as_slice(), one)
        && a != b
    {
        doubts.push(
            "approach and retraction lie on different sides of the curve: they may differ in their works of adhesion, which \
             --separate work_of_adhesion tells"
                .to_owned(),
        );
    }
    doubts
}

/// The largest contact radius and approach of the feet.
fn extent(problem: &Problem, u: &[f64], paths: &super::problem::Paths) -> (f64, f64) {
    let feet = problem.feet(paths, &problem.instrument_at(u)).unwrap_or_default();
    let (mut widest, mut deepest) = (0.0, f64::NEG_INFINITY);
    for (datum, foot) in problem.data.iter().zip(&feet) {
        let Some(foot) = foot else { continue };
        let path = paths.of(datum.segment);
        if let Foot::Radius(s) = foot.foot {
            widest = f64::max(widest, s);
            deepest = f64::max(deepest, path.approach(s).unwrap_or(deepest));
        }
    }
    (widest, deepest)
}

/// `k 10 % larger: E* -8.0 %, γ +7.1 %; …`: what the fit would be with another spring; `None` where there is none, or it is free.
pub fn of_spring(
    problem: &Problem,
    solved: &Solved,
    robust: bool,
    progress: &dyn Progress,
) -> Option<String> {
    const KEY: &str = "path.control.stiffness";
    let Control::Stiffness(k) = problem.preset.path.control else { return None };
    if problem.parameters.iter().any(|p| p.target == Target::Key(KEY.to_owned())) {
        return None;
    }
    let mut told = Vec::new();
    for (factor, words) in [(1.1, "10 % larger"), (0.9, "10 % smaller")] {
        let mut other = problem.clone();
        other.preset.set(KEY, Value::Number(factor * k)).ok()?;
        let found = solve(&other, &solved.minimum.parameters, robust, 40, progress);
        let words = match found {
            None => format!("{words}: no fit"),
            Some(found) => {
                let changes: Vec<String> = problem
                    .parameters
                    .iter()
                    .enumerate()
                    .filter(|(_, parameter)| parameter.scale.is_none())
                    .map(|(j, parameter)| {
                        let change = found.minimum.parameters[j] - solved.minimum.parameters[j];
                        let name = super::options::letter(&problem.preset, &parameter.key());
                        format!("{name} {:+.1} %", 100.0 * exp_m1(change)).replace('-', "−")
                    })
                    .collect();
                format!("{words}: {}", changes.join(", "))
            }
        };
        told.push(words);
    }
    Some(format!("with k {}", told.join("; with k ")))
}
