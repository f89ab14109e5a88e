//! Whether another law would fit better: a work of adhesion for each branch, a baseline with a slope, a gap that is not
//! a paraboloid, an adhesion with a range.
//!
//! ```text
//! r(n) = r + z n,     n = −z⊥ᵀr/|z⊥|²,     t = n |z⊥|/s,     |z⊥|² = zᵀz − (Jᵀz)ᵀ (JᵀJ)⁻¹ Jᵀz
//! ```
//!
//! n is what the law has beyond the model, 0 where the model holds; z is how the residuals change with it. z⊥ leaves
//! out what the free values take up of z, so the test sees what a trend in fitted values does not. s is the noise of
//! neighbours, or that of the rows that determine z, whichever is larger. C. R. Rao, Proc. Camb. Phil. Soc. 44, 50
//! (1948). False alarms: 1 in 1000, for slopes 3.

use super::super::chance::beyond_t;
use super::super::least_squares::LeastSquares;
use super::super::problem::{ADHESION, Target};
use super::super::track::Mover;
use super::super::verdict::Reason;
use super::{Evidence, ROUNDING};
use crate::elementary::pow;
use crate::gap::Shape;
use crate::gap::shapes::PowerLaw;
use crate::measured::branches::median;
use crate::measured::{Abscissa, Segment};
use crate::preset::edge::CLOSING_ADHESION;
use crate::problem::Groups;
use crate::problem::groups::LARGE_TABOR;
use crate::units::Quantity;
use crate::units::number::{said, short};
use nalgebra::DVector;

/// The share of right fits that each test flags.
const FALSE_ALARM: f64 = 1e-3;
/// The same for slopes, which move the work of adhesion by more of its errors than of their own.
const FALSE_SLOPES: f64 = 3e-3;
/// The kind of the reason that branches differ.
pub(in crate::fit) const BRANCHES: &str = "branches";
/// Residuals count as at most this many s.
const MOST: f64 = 3.0;
pub(super) const MOST_OF_NEIGHBOURS: f64 = 4.0;

/// What the free values take up of `z`, as their change, and z⊥.
fn parted(
    Evidence { solved, inner, .. }: Evidence,
    z: &DVector<f64>,
) -> Option<(DVector<f64>, DVector<f64>)> {
    let jacobian = &solved.minimum.at.jacobian;
    let along = inner? * jacobian.tr_mul(z);
    let across = z - jacobian * &along;
    Some((along, across))
}

/// The typical size of the residuals that change by `z` after a change by n, in units of the noise of neighbours.
pub(super) fn rest(evidence: Evidence, z: &DVector<f64>, n: f64) -> Option<f64> {
    let (_, across) = parted(evidence, z)?;
    let left = &evidence.solved.minimum.at.residuals + across * n;
    let sizes = left.iter().zip(z).filter(|(_, z)| **z != 0.0).map(|(left, _)| left.abs());
    Some(1.4826 * median(sizes.collect())? / evidence.scatter.contact?.max(ROUNDING))
}

/// n and t of residuals that change by `z`. Rows that `alone` marks as off alone say nothing, and the noise of
/// neighbours is then taken for all others: what these differ by apart from z is not noise.
pub(super) fn score(evidence: Evidence, z: &DVector<f64>, alone: Option<&[bool]>) -> Option<[f64; 2]> {
    let Evidence { problem, solved, scatter, .. } = evidence;
    let s = scatter.contact?.max(ROUNDING);
    let at = &solved.minimum.at;
    let (along, across) = parted(evidence, z)?;
    let left = z.dot(&across);
    let most = if alone.is_some() { MOST_OF_NEIGHBOURS * s } else { MOST * f64::max(s, solved.scale) };
    let mut clipped = at.residuals.map(|r| r.clamp(-most, most));
    for (i, _) in alone.unwrap_or_default().iter().enumerate().filter(|(_, alone)| **alone) {
        clipped[i] = 0.0;
    }
    // A robust fit leaves other residuals than these orthogonal to J, and one with priors leaves none.
    let mut slope = at.jacobian.tr_mul(&clipped);
    for prior in &problem.priors {
        slope[prior.parameter] +=
            (solved.minimum.parameters[prior.parameter] - prior.mean) / prior.sigma.powi(2);
    }
    let n = -(z.dot(&clipped) - along.dot(&slope)) / left;
    // For noise that differs from row to row; H. White, Econometrica 48, 817 (1980).
    let used = z.iter().filter(|z| **z != 0.0).count() as f64;
    let own: f64 = across.iter().zip(&clipped).map(|(z, r)| (z * (r + z * n)).powi(2)).sum();
    let own = own * used / (used - along.len() as f64 - 1.0).max(1.0);
    let variance = if alone.is_some() { s * s * left } else { f64::max(s * s * left, own) };
    let variance = variance * scatter.correlation.rows();
    let t = n * left / variance.sqrt();
    (left > 1e-9 * z.norm_squared() && t.is_finite()).then_some([n, t])
}

/// A force with a slope over x. Rows apart alone would determine it by a short lever.
pub(super) fn of_tilt(evidence: Evidence) -> Option<Reason> {
    let Evidence { problem, solved, scatter, .. } = evidence;
    let is_free = problem.parameters.iter().any(|parameter| parameter.target == Target::Tilt);
    if problem.abscissa == Abscissa::Radius || is_free || !problem.data.iter().any(|datum| datum.free) {
        return None;
    }
    let z = problem.tilted(&solved.minimum.parameters)?;
    let [_, t] = score(evidence, &z, None)?;
    (beyond_t(t, scatter.degrees) < FALSE_SLOPES).then(|| {
        let sentence = format!(
            "a force with a slope over x, in contact and apart, describes the points better ({} standard errors): free data.tilt",
            short(t.abs(), 2)
        );
        Reason::new("tilt", t, sentence)
    })
}

/// A work of adhesion for each branch, where both share one that is free.
pub(super) fn of_branches(evidence: Evidence) -> Option<Reason> {
    let Evidence { problem, solved, scatter, .. } = evidence;
    let is_shared =
        problem.parameters.iter().any(|parameter| parameter.target == Target::Key(ADHESION.to_owned()));
    let has = |segment| problem.data.iter().any(|datum| datum.segment == segment && !datum.free);
    if !is_shared || !has(Segment::Approach) || !has(Segment::Retraction) {
        return None;
    }
    let of_approach = |i: usize| f64::from(u8::from(problem.data[i].segment == Segment::Approach));
    let z = problem.changed(&solved.minimum.parameters, Mover::Adhesion, of_approach)?;
    let [n, t] = score(evidence, &z, None)?;
    (beyond_t(t, scatter.degrees) < FALSE_ALARM).then(|| {
        let sentence = format!(
            "a work of adhesion for approach and one for retraction describe the points better ({} standard errors): \
             free {CLOSING_ADHESION}",
            short(t.abs(), 2)
        );
        Reason::new(BRANCHES, n, sentence)
    })
}

/// A gap that is not a paraboloid: h goes as r^(2 + n).
pub(super) fn of_shape(evidence: Evidence) -> Option<Reason> {
    /// The change of the exponent by which the derivative is taken.
    const STEP: f64 = 0.02;
    let Evidence { problem, solved, scatter, .. } = evidence;
    let Shape::Sphere { radius_of_curvature } = problem.preset.gap else { return None };
    let is_of_gap = |target: &Target| matches!(target, Target::Key(key) if key.starts_with("gap."));
    if problem.parameters.iter().any(|parameter| is_of_gap(&parameter.target)) {
        return None;
    }
    let u = &solved.minimum.parameters;
    let pivot = problem.paths(u)?.of(Segment::Retraction).outermost;
    let with = |n: f64| {
        let mut other = problem.clone();
        let factor = pow(pivot, -n) / (2.0 * radius_of_curvature);
        other.preset.gap = Shape::PowerLaw(PowerLaw { factor, exponent: 2.0 + n });
        LeastSquares::residuals(&other, u)
    };
    let z = (with(STEP)? - with(-STEP)?) / (2.0 * STEP);
    let [n, t] = score(evidence, &z, None)?;
    (beyond_t(t, scatter.degrees) < FALSE_ALARM).then(|| {
        let sentence = format!(
            "a gap that grows as r^n describes the points better than r^2: n is about {} ({} standard errors \
             from 2). The gap is not a sphere, or something else depends on the radius",
            short((2.0 + n).clamp(1.0, 8.0), 3),
            short(t.abs(), 2)
        );
        Reason::new("gap", 2.0 + n, sentence)
    })
}

/// An adhesion with a range: the edge is no longer sharp, to first order in the range.
pub(super) fn of_range(evidence: Evidence) -> Option<Reason> {
    /// The separation to which the tension reaches, over the z₀ of Tabor's number, by the usual match.
    const OF_EQUILIBRIUM: f64 = 0.97;
    /// A law that leaves more than this many times the noise does not describe the points.
    const WELL: f64 = 2.0;
    let Evidence { problem, solved, scatter, .. } = evidence;
    let u = &solved.minimum.parameters;
    let z = problem.changed(u, Mover::Range, |_| 1.0)?;
    let [n, t] = score(evidence, &z, None)?;
    let preset = problem.preset_at(u, Segment::Retraction)?;
    let reach = preset.material.work_of_adhesion * n.max(0.0).sqrt();
    let tabor = Groups::of(&preset.problem(), Some(reach / OF_EQUILIBRIUM), None).tabor?;
    (n > 0.0 && 0.5 * beyond_t(t, scatter.degrees) < FALSE_ALARM).then(|| {
        // Waves that the preset leaves out look like a range too, but most of the misfit stays.
        let consequence = match rest(evidence, &z, n).filter(|rest| *rest > WELL) {
            Some(rest) => format!(
                "But {} times the noise would be left. A gap with waves that the preset does not have looks the same",
                short(rest, 2)
            ),
            None if tabor >= LARGE_TABOR => format!(
                "So short a range (mu above {LARGE_TABOR}) changes little: more likely something else depends on the radius or the speed \
                 of the edge"
            ),
            None => "The JKR limit of this method does not hold".to_owned(),
        };
        let sentence = format!(
            "adhesion with a range describes the points better than adhesion at the edge alone: it acts up \
             to a separation of about {}, with Tabor's mu about {} ({} standard errors). {consequence}",
            said(&preset.units, Quantity::Length, reach),
            short(tabor, 2),
            short(t, 2)
        );
        Reason::new("range", tabor, sentence)
    })
}
