//! What speaks against a fit, and what is doubtful about it.
//!
//! | file | what it asks |
//! |---|---|
//! | `contact` | does the curve go through the points in contact |
//! | `apart` | is the force a constant where the bodies are apart |
//! | `scores` | would a tilted baseline fit better, a gap of another exponent, an adhesion for each branch or with a range |
//! | `edge` | how fast the edge goes |
//! | `rate` | does the work of adhesion grow with the speed of the edge |
//! | `untold` | could the points tell that it does |
//! | `touch` | do the bodies pull before they touch, or are they apart after it |
//! | `spring` | what would another spring give |
//!
//! This file asks whether the values are physically plausible.

mod apart;
mod contact;
mod edge;
mod range;
mod rate;
mod scores;
mod spring;
mod touch;
mod untold;

pub(super) use range::{of_first_pull, unseen};
pub(super) use rate::untried;
pub(super) use scores::BRANCHES;
pub(super) use spring::{of_drift, of_spring};

use super::fitted::Fitted;
use super::fitted::NORMAL;
use super::path::Foot;
use super::problem::{ADHESION, FitProblem, FreeParameter, Paths};
use super::pulled::is_pulled;
use super::scatter::Scatter;
use super::solve::SolvedFit;
use super::verdict::Reason;
use crate::elementary::hypot;
use crate::measured::converter::Clipped;
use crate::measured::{Abscissa, Branches, SPARSE, is_hidden};
use crate::preset::Preset;
use crate::preset::edge::CLOSING_ADHESION;
use crate::problem::Groups;
use crate::problem::groups::LARGE_TABOR;
use crate::units::number::{said, short, significant};
use crate::units::{Quantity, UnitSystem};
use nalgebra::DMatrix;

/// No contact is wider, or approach deeper, than this in units of R, and beyond this width a contact is doubtful.
const LARGEST: f64 = 1.0;
const WIDE: f64 = 0.5;
/// The works of adhesion that surfaces have as a rule, in J/m².
const ADHESIONS: [f64; 2] = [1e-4, 10.0];
/// The range of moduli of everything people press, in Pa.
const MODULI: [f64; 2] = [10.0, 1e12];
/// Residuals below this share of the noise are rounding, in which there is always some order.
const ROUNDING: f64 = 0.1;
/// Works of adhesion that differ by less than this share count as one, whatever their errors: points without noise have
/// no errors.
const DIFFERENT: f64 = 1e-3;
/// A work of adhesion below this many of its errors is hardly one.
const FROM_NONE: f64 = 5.0;
/// Noise in contact beyond this many times that of the rows apart is another noise; and how much more is allowed where
/// the noise is known from few rows, times 1/√n: three of its deviations.
const NOISIER: f64 = 1.3;
const OF_FEW: f64 = 3.5;

/// The deviation of the number of runs of signs from the number expected by chance, in units of its standard deviation;
/// A. Wald and J. Wolfowitz, Ann. Math. Stat. 11, 147 (1940).
pub fn runs(residuals: &[f64]) -> f64 {
    let plus = residuals.iter().filter(|r| **r > 0.0).count() as f64;
    let n = residuals.len() as f64;
    let minus = n - plus;
    let runs = 1.0 + residuals.windows(2).filter(|pair| (pair[0] > 0.0) != (pair[1] > 0.0)).count() as f64;
    let mean = 2.0 * plus * minus / n + 1.0;
    let variance = (mean - 1.0) * (mean - 2.0) / (n - 1.0);
    if variance > 0.0 { (runs - mean) / variance.sqrt() } else { f64::NEG_INFINITY }
}

/// What a fit is judged by.
#[derive(Clone, Copy)]
pub(super) struct Evidence<'a> {
    /// The points and the model.
    pub(super) problem: &'a FitProblem,
    /// The fit itself.
    pub(super) solved: &'a SolvedFit,
    /// The noise of its rows as neighbours show it.
    pub(super) scatter: &'a Scatter,
    /// (JᵀJ)⁻¹, where the values are determined.
    pub(super) inner: Option<&'a DMatrix<f64>>,
}

/// What speaks against a fit whose fitted preset is `preset`.
pub(super) fn reasons(evidence: Evidence, preset: &Preset, clipped: Option<Clipped>) -> Vec<Reason> {
    let Evidence { problem, solved, scatter, .. } = evidence;
    let mut reasons: Vec<Reason> = clipped.map(|clipped| of_clipped(preset, clipped)).into_iter().collect();
    reasons.extend(contact::of_contact(evidence));
    reasons.extend(apart::of_apart(problem, solved, scatter));
    // Rows that are not apart can be mistaken for a tilt.
    let in_contact = apart::of_contact(problem, solved);
    let tilt = if in_contact.is_some() { None } else { scores::of_tilt(evidence) };
    reasons.extend(in_contact.into_iter().chain(tilt));
    reasons.extend(scores::of_shape(evidence));
    reasons.extend(scores::of_branches(evidence));
    reasons.extend(touch::of_late(evidence));
    if !is_pulled(&problem.preset) {
        reasons.extend(touch::of_touch(evidence));
    }
    if preset.cohesion().is_some() {
        reasons.extend(range::of_zone(problem, solved));
    } else if !is_pulled(&problem.preset) {
        // All of these start from what an adhesion at the edge alone does.
        reasons.extend(scores::of_range(evidence));
        reasons.extend(rate::of_rate(evidence));
        reasons.extend(of_range(preset));
    }
    reasons.extend(unlikely(problem, solved, preset));
    reasons
}

/// Whether the file shows no rows apart, and nothing else says that there are none or what their force is.
fn is_apart_unknown(branches: &Branches, preset: &Preset) -> bool {
    let is_said =
        branches.baseline.is_some() || preset.data.baseline.is_some() || !preset.data.free_part.is_empty();
    !is_said && branches.abscissa != Abscissa::Radius
}

/// Branches with so few rows that rows apart would not be seen.
pub(super) fn of_sparse(branches: &Branches, preset: &Preset) -> Option<Reason> {
    let most = branches.list.iter().map(|branch| branch.attached.len()).max()?;
    let sentence = format!(
        "branches of at most {most} rows do not show whether any rows are apart: give data.baseline, the \
         force of such rows, or --free-part"
    );
    let is_sparse = most < SPARSE && is_apart_unknown(branches, preset);
    is_sparse.then(|| Reason::new("sparse", most as f64, sentence))
}

/// A sentence on a branch whose rows would not show that they are apart, as their noise is too large.
pub(super) fn of_hidden(branches: &Branches, preset: &Preset) -> Option<String> {
    let hidden = branches.list.iter().find(|branch| is_hidden(&branch.attached))?;
    is_apart_unknown(branches, preset).then(|| {
        format!(
            "over the outermost quarter of the {} the force changes by less than its noise: if those rows are apart, the \
             values are wrong. Give --free-part, which may be none, or data.baseline",
            hidden.segment.name()
        )
    })
}

/// A sentence on rows that may belong to either part, if they are many and a work of adhesion is fitted: they lie about the
/// pull-off, which shows it.
pub(super) fn of_unclear(branches: &Branches, fitted: &[Fitted]) -> Option<String> {
    const SHARE: f64 = 0.1;
    let is_fitted = fitted.iter().any(|fitted| fitted.key.starts_with(ADHESION));
    let unclear: usize = branches.list.iter().map(|branch| branch.jump).sum();
    let all: usize = branches.list.iter().map(|of| of.attached.len() + of.free.len() + of.jump).sum();
    (is_fitted && unclear as f64 >= SHARE * all as f64).then(|| {
        format!(
            "{unclear} of {all} rows are left out, as they lie within a jump or where the noise hides whether the bodies are \
             apart: the work of adhesion and the offset may be off by several of their errors"
        )
    })
}

/// Rows at the end of the range of a converter.
fn of_clipped(preset: &Preset, clipped: Clipped) -> Reason {
    let sentence = format!(
        "{} rows in contact have exactly the {} force, {}: the instrument is saturated. Leave them out with \
         --range force=LO..HI",
        clipped.rows,
        if clipped.is_low { "smallest" } else { "largest" },
        said(&preset.units, Quantity::Force, clipped.force)
    );
    Reason::new("clipped", clipped.rows as f64, sentence)
}

/// Adhesion that reaches beyond the edge.
fn of_range(preset: &Preset) -> Option<Reason> {
    let tabor = Groups::of(&preset.problem(), preset.range_of_action(), preset.cohesion()).tabor?;
    let sentence = format!(
        "Tabor's mu = {tabor:.2} is below {LARGE_TABOR}: the adhesion reaches beyond the edge, and the JKR limit of this method \
         does not hold"
    );
    (tabor < LARGE_TABOR).then(|| Reason::new("tabor", tabor, sentence))
}

/// Values in SI that nothing real has. In reduced units all sizes are possible.
fn unlikely(problem: &FitProblem, solved: &SolvedFit, preset: &Preset) -> Vec<Reason> {
    let mut reasons = Vec::new();
    if !matches!(preset.units, UnitSystem::Si(_)) {
        return reasons;
    }
    let u = &solved.minimum.parameters;
    let mut unit = |value: f64, what: String| {
        reasons.push(Reason::new("unit", value, format!("{what}: check the unit of x")));
    };
    let radius = preset.gap.radius_of_curvature();
    if let (Some(radius), Some(paths)) = (radius, problem.paths(u)) {
        let [widest, deepest] = extent(problem, u, &paths);
        if widest > LARGEST * radius {
            unit(widest / radius, format!("the contact radius reaches {} R", short(widest / radius, 3)));
        }
        if deepest > LARGEST * radius {
            unit(deepest / radius, format!("the approach reaches {} R", short(deepest / radius, 3)));
        }
    }
    let modulus = preset.material.effective_modulus;
    if !(MODULI[0]..=MODULI[1]).contains(&modulus) {
        unit(modulus, format!("E* = {} Pa is that of no real material", significant(modulus, 3)));
    }
    reasons
}

/// What is doubtful about a fit but leaves its verdict as it is. `is_known` says whether the noise of the force was
/// given, or found in rows apart.
pub(super) fn doubts(
    evidence: Evidence,
    fitted: &[Fitted],
    (reasons, is_known): (&[Reason], bool),
) -> Vec<String> {
    let Evidence { problem, solved, scatter, .. } = evidence;
    let has_speed = reasons.iter().any(|reason| rate::KINDS.contains(&reason.kind));
    let of_edge = || rate::of_untimed(evidence);
    let is_sharp = problem.preset.cohesion().is_none() && !is_pulled(&problem.preset);
    let mut doubts: Vec<String> = if has_speed || !is_sharp { None } else { of_edge() }.into_iter().collect();
    // The larger of two: through snaps a standard error may be too small.
    let error = |fitted: &Fitted| {
        let drawn = fitted.bootstrap.map_or(0.0, |found| found.half() / NORMAL);
        fitted.standard_error.map(|error| error.max(drawn))
    };
    let of_key = |key: &str| fitted.iter().find(|fitted| fitted.key == key);
    let adhesions = [CLOSING_ADHESION, ADHESION].map(of_key);
    if let [Some(approach), Some(retraction)] = adhesions
        && let [Some(a), Some(b)] = [approach, retraction].map(error)
        && (approach.value - retraction.value).abs()
            > f64::max(2.0 * hypot(a, b), DIFFERENT * retraction.value)
    {
        let more = approach.value > retraction.value;
        doubts.push(
            if more {
                "the work of adhesion is larger on approach, by more than the errors: a closing edge gains \
                 at most what an opening one costs"
            } else {
                "the works of adhesion of approach and retraction differ by more than their errors: between \
                 them the edge is pinned, or its speed matters, or the \
                 bodies age"
            }
            .to_owned(),
        );
    }
    // The law of an edge shares the pull with the work of adhesion: a fast edge shows their sum alone.
    let shares = problem.parameters.iter().any(|of| of.key().starts_with("edge."));
    for fitted in adhesions.into_iter().flatten() {
        let error = fitted.standard_error.filter(|error| !shares && fitted.value < FROM_NONE * error);
        if let Some(error) = error {
            doubts.push(format!(
                "{} is only {} standard errors above 0: the points hardly distinguish it from no adhesion",
                fitted.key,
                short(fitted.value / error, 2)
            ));
        } else if matches!(problem.preset.units, UnitSystem::Si(_))
            && !(ADHESIONS[0]..=ADHESIONS[1]).contains(&fitted.value)
        {
            doubts.push(format!(
                "{} = {} J/m^2 is unusual, as surfaces have {:?} to {:?} J/m^2: check the unit of the force",
                fitted.key,
                significant(fitted.value, 3),
                ADHESIONS[0],
                ADHESIONS[1]
            ));
        }
    }
    doubts.extend(apart::of_ends(problem, solved));
    doubts.extend(unknown(problem, fitted));
    doubts.extend(wide(problem, &solved.minimum.parameters));
    let free = problem.data.iter().filter(|datum| datum.free).count().max(1) as f64;
    if let Some(s) = scatter.contact.filter(|s| is_known && *s > NOISIER + OF_FEW / free.sqrt()) {
        doubts.push(format!(
            "neighbouring points in contact differ by {} times the known noise of x and of the force: there \
             is more noise than that",
            short(s, 2)
        ));
    }
    doubts
}

/// A sentence on a contact that is wide for its ball, in SI.
fn wide(problem: &FitProblem, u: &[f64]) -> Option<String> {
    let radius = problem.preset.gap.radius_of_curvature()?;
    let [widest, _] = extent(problem, u, &problem.paths(u)?);
    let is_si = matches!(problem.preset.units, UnitSystem::Si(_));
    (is_si && (WIDE..LARGEST).contains(&(widest / radius))).then(|| {
        format!("the contact radius reaches {} R: check R and the unit of x", short(widest / radius, 3))
    })
}

/// A sentence on positive values whose errors are larger than they are. A work of adhesion has a sentence of its own.
fn unknown(problem: &FitProblem, fitted: &[Fitted]) -> Option<String> {
    let is_unknown = |(fitted, parameter): &(&Fitted, &FreeParameter)| {
        let is_positive = parameter.scale.is_none() && !fitted.key.starts_with(ADHESION);
        is_positive && fitted.standard_error.is_some_and(|error| error >= fitted.value)
    };
    let all = fitted.iter().zip(&problem.parameters).filter(is_unknown);
    let keys: Vec<&str> = all.map(|(fitted, _)| &*fitted.key).collect();
    (!keys.is_empty()).then(|| {
        format!(
            "the points show hardly more than the order of magnitude of {}: the error is larger than the value",
            keys.join(" and ")
        )
    })
}

/// The largest contact radius and approach of the feet.
pub(super) fn extent(problem: &FitProblem, u: &[f64], paths: &Paths) -> [f64; 2] {
    let feet = problem.feet(paths, &problem.instrument_at(u)).unwrap_or_default();
    let (mut widest, mut deepest) = (0.0, f64::NEG_INFINITY);
    for (datum, foot) in problem.data.iter().zip(&feet) {
        let Some(foot) = foot else { continue };
        let path = paths.of(datum.segment);
        if let Foot::Radius(along) = foot.foot {
            widest = f64::max(widest, path.radius(along).unwrap_or(widest));
            deepest = f64::max(deepest, path.approach(along).unwrap_or(deepest));
        }
    }
    [widest, deepest]
}
