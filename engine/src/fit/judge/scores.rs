//! Whether another law would fit better: adhesion that grows with the speed of the edge, a gap that is no paraboloid.
//!
//! ```text
//! r(n) = r + z n,     n = −z⊥ᵀr/|z⊥|²,     t = n |z⊥|/s,     |z⊥|² = zᵀz − (Jᵀz)ᵀ (JᵀJ)⁻¹ Jᵀz
//! ```
//!
//! n is what the law has more than the model, 0 where the model holds; z is how the residuals change with it. What the free values take
//! of it is left out by z⊥, so the test sees what a trend in fitted values does not. s is the noise of neighbours. C. R. Rao, Proc.
//! Camb. Phil. Soc. 44, 50 (1948). False alarms: each 1 in 1000.

use super::super::chance::beyond_t;
use super::super::least_squares::LeastSquares;
use super::super::problem::{ADHESION, Problem, Target};
use super::super::scatter::Scatter;
use super::super::solve::Solved;
use super::super::verdict::Reason;
use super::ROUNDING;
use crate::elementary::{ln, pow};
use crate::gap::Shape;
use crate::gap::shapes::PowerLaw;
use crate::measured::{Abscissa, Segment};
use crate::units::number::short;
use nalgebra::{DMatrix, DVector};

/// The share of right fits that each test flags.
const FALSE_ALARM: f64 = 1e-3;
/// Residuals count as so many s at most.
const MOST: f64 = 3.0;

/// n and t of the residuals that change by `z`.
fn score(solved: &Solved, scatter: &Scatter, inner: &DMatrix<f64>, z: &DVector<f64>) -> Option<[f64; 2]> {
    let s = scatter.contact?.max(ROUNDING);
    let at = &solved.minimum.at;
    let along = at.jacobian.tr_mul(z);
    let left = z.norm_squared() - along.dot(&(inner * &along));
    let most = MOST * f64::max(s, solved.scale);
    let clipped = at.residuals.map(|r| r.clamp(-most, most));
    // A robust fit leaves other residuals orthogonal to J than these.
    let across = z.dot(&clipped) - along.dot(&(inner * at.jacobian.tr_mul(&clipped)));
    let n = -across / left;
    let t = n * left.sqrt() / (s * scatter.correlation.rows().sqrt());
    (left > 1e-9 * z.norm_squared() && t.is_finite()).then_some([n, t])
}

/// Adhesion that grows with the speed of the edge, where the contact radius is measured: γ goes with v^n. Rows are taken as even in
/// time.
pub(super) fn of_rate(
    problem: &Problem,
    solved: &Solved,
    scatter: &Scatter,
    inner: Option<&DMatrix<f64>>,
) -> Option<Reason> {
    /// Rows over which a speed is taken, on either side, as a share of all, and rows at least.
    const SHARE: usize = 12;
    const FEWEST: usize = 10;
    let of_radius = problem.abscissa == Abscissa::Radius;
    let is_adhesion = |target: &Target| {
        matches!(target, Target::Adhesion(Segment::Retraction)) || *target == Target::Key(ADHESION.to_owned())
    };
    let j = problem.parameters.iter().position(|parameter| is_adhesion(&parameter.target))?;
    if !(of_radius || problem.space) {
        return None;
    }
    let per = problem.per_point();
    let jacobian = &solved.minimum.at.jacobian;
    let mut z = DVector::zeros(jacobian.nrows());
    let mut speeds: Vec<(usize, f64)> = Vec::new();
    for branch in 0..problem.branches() {
        let mut rows = problem.rows(solved, branch, false, 0);
        rows.sort_by_key(|row| problem.data[row.index].point.row);
        let is_out = rows.first().is_some_and(|row| problem.data[row.index].segment == Segment::Retraction);
        if !is_out || rows.len() < FEWEST {
            continue;
        }
        let radius = |at: usize| {
            let point = problem.data[rows[at].index].point;
            if of_radius { point.x } else { point.radius }
        };
        let half = (rows.len() / SHARE).max(2);
        for at in 0..rows.len() {
            let (from, to) = (at.saturating_sub(half), (at + half).min(rows.len() - 1));
            let row = |at: usize| problem.data[rows[at].index].point.row as f64;
            let speed = (radius(from) - radius(to)) / (row(to) - row(from));
            if speed > 0.0 {
                speeds.push((rows[at].index, ln(speed)));
            }
        }
    }
    let mean = speeds.iter().map(|(_, speed)| speed).sum::<f64>() / speeds.len().max(1) as f64;
    for (index, speed) in speeds {
        for part in 0..per {
            z[per * index + part] = jacobian[(per * index + part, j)] * (speed - mean);
        }
    }
    let [n, t] = score(solved, scatter, inner?, &z)?;
    (n > 0.0 && beyond_t(t, scatter.degrees) < FALSE_ALARM).then(|| {
        let sentence = format!(
            "the work of adhesion grows with the speed of the edge, about as v^{} ({} standard errors): speeds tell of it",
            short(n, 2),
            short(t, 2)
        );
        Reason::new("rate", n, sentence)
    })
}

/// A gap that is no paraboloid: h goes with r^(2 + n).
pub(super) fn of_shape(
    problem: &Problem,
    solved: &Solved,
    scatter: &Scatter,
    inner: Option<&DMatrix<f64>>,
) -> Option<Reason> {
    /// The change of the exponent by which the derivative is taken.
    const STEP: f64 = 0.02;
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
    let [n, t] = score(solved, scatter, inner?, &z)?;
    (beyond_t(t, scatter.degrees) < FALSE_ALARM).then(|| {
        let sentence = format!(
            "a gap that grows as r^n describes the points better than r^2: n near {} ({} standard errors from 2). The gap is no \
             sphere, or something else goes with the radius",
            short((2.0 + n).clamp(1.0, 8.0), 3),
            short(t.abs(), 2)
        );
        Reason::new("gap", 2.0 + n, sentence)
    })
}
