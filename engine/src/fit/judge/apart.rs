//! Whether the force is constant, except for its noise, where the bodies are apart.
//!
//! The noise there may be correlated from row to row: n rows count as n/τ. False alarms: 1 in 1000.

use super::super::chance::beyond_t;
use super::super::problem::FitProblem;
use super::super::scatter::{FEWEST_APART, Scatter, detrended, steps_over_squares};
use super::super::solve::SolvedFit;
use super::super::verdict::Reason;
use super::ROUNDING;
use crate::measured::branches::median;
use crate::text::counted;
use crate::units::number::short;

/// The share of right fits that are flagged.
const FALSE_ALARM: f64 = 1e-3;
/// The fewest rows apart on a branch.
const FEWEST: usize = 8;
/// Rows apart that count as fewer than this are a drift, not noise: it is there in contact too, and nothing says how
/// large.
const COUNTED: f64 = 4.0;

/// What the rows apart say against the fit.
pub(super) fn of_apart(problem: &FitProblem, solved: &SolvedFit, scatter: &Scatter) -> Vec<Reason> {
    let mut reasons = Vec::new();
    let tau = scatter.correlation.rows();
    let independent = scatter.apart as f64 / tau;
    if scatter.correlation.share > 0.0 && independent < COUNTED {
        reasons.push(Reason::new(
            "drift",
            independent,
            format!(
                "the force is not constant where the bodies are apart: {} correlated rows count as only {}. \
                 It drifts",
                scatter.apart,
                short(independent, 2)
            ),
        ));
    }
    reasons.extend(order(problem, solved));
    reasons.extend(levels(problem, solved, tau));
    reasons
}

/// Rows apart that follow each other as noise seldom does: by a slope that makes up most of their variance; or, if they are too few to
/// show how their noise is correlated, by their steps, whose mean square over the variance is 2 ± 2 √((n − 2)/(n² − 1)) for noise;
/// J. von Neumann, Ann. Math. Stat. 12, 367 (1941).
fn order(problem: &FitProblem, solved: &SolvedFit) -> Option<Reason> {
    /// The fewest rows.
    const FEWEST: usize = 5;
    /// One in a thousand, for a normal deviate on one side.
    const BEYOND: f64 = 3.09;
    /// The share of the variance that a slope leaves.
    const LEFT: f64 = 0.25;
    (0..problem.branches()).find_map(|branch| {
        let rows = problem.rows(solved, branch, true, 0);
        let n = rows.len() as f64;
        let residuals: Vec<f64> = rows.iter().map(|row| row.residual).collect();
        let mean = residuals.iter().sum::<f64>() / n;
        let squares: f64 = residuals.iter().map(|residual| (residual - mean).powi(2)).sum();
        if rows.len() < FEWEST || squares <= ROUNDING * ROUNDING * n {
            return None;
        }
        let rest: f64 = detrended(&residuals).iter().map(|rest| rest * rest).sum();
        let left = (rest / squares).max(f64::EPSILON);
        let t = ((1.0 - left) / left * (n - 2.0)).sqrt();
        let has_slope = left < LEFT && beyond_t(t, n - 2.0) < FALSE_ALARM;
        let ratio = steps_over_squares(&residuals) * n / (n - 1.0);
        let off = (2.0 - ratio) / (2.0 * ((n - 2.0) / (n * n - 1.0)).sqrt());
        let (is_ordered, value, by) = if has_slope {
            (true, t, "standard errors of a slope")
        } else {
            (rows.len() < FEWEST_APART && off > BEYOND, off, "standard deviations")
        };
        is_ordered.then(|| {
            let sentence = format!(
                "the force is not constant where the bodies are apart: the {} there follow each other as noise seldom does \
                 ({} {by}). It drifts, or they are in contact",
                counted(rows.len(), "row"),
                short(value, 2)
            );
            Reason::new("drift", value, sentence)
        })
    })
}

/// Rows taken to be apart that do not have the force of bodies apart: a record that ends in contact, and is flat there,
/// looks as if it ended apart.
pub(super) fn of_contact(problem: &FitProblem, solved: &SolvedFit) -> Option<Reason> {
    /// The baseline goes through the rows apart, unless those in contact contradict them this far, in σ.
    const FAR: f64 = 10.0;
    (0..problem.branches()).find_map(|branch| {
        let rows = problem.rows(solved, branch, true, 0);
        let off = median(rows.iter().map(|row| row.residual.abs()).collect()).filter(|off| *off > FAR)?;
        let sentence = format!(
            "where the {} is taken to be apart ({}), the force is {} sigma off that of bodies apart: if they are still \
             in contact there, say so with --free-part none or data.free_part",
            problem.data[rows.first()?.index].segment.name(),
            counted(rows.len(), "row"),
            short(off, 2)
        );
        Some(Reason::new("not-apart", off, sentence))
    })
}

/// A sentence on rows at the ends of the contact or of the rows apart that are very far off. They may show a jump in the last row,
/// or that rows in contact are taken to be apart.
pub(super) fn of_ends(problem: &FitProblem, solved: &SolvedFit) -> Option<String> {
    /// How far, in σ, and how many rows are at an end.
    const FAR: f64 = 30.0;
    const AT_END: usize = 2;
    let far = FAR * solved.scale.max(1.0);
    let parts = (0..problem.branches()).flat_map(|branch| [false, true].map(|free| (branch, free)));
    let off: Vec<_> = parts
        .flat_map(|(branch, free)| {
            let rows = problem.in_order(solved, branch, free, 0);
            let inner = AT_END..rows.len().saturating_sub(AT_END);
            rows.into_iter().enumerate().filter(move |(i, _)| !inner.contains(i)).map(|(_, row)| row)
        })
        .filter(|row| row.residual.abs() > far)
        .collect();
    let most = short(off.iter().map(|row| row.residual.abs()).reduce(f64::max)?, 2);
    let mut numbers: Vec<usize> = off.iter().map(|row| problem.data[row.index].point.row).collect();
    numbers.sort_unstable();
    let what = match &numbers[..] {
        [row] => format!(
            "row {row}, where the contact or the free part begins or ends, lies {most} sigma off the model and hardly counts"
        ),
        rows => {
            let rows: Vec<String> = rows.iter().map(ToString::to_string).collect();
            format!(
                "rows {}, where the contact or the free part begins or ends, lie up to {most} sigma off the model and hardly count",
                rows.join(", ")
            )
        }
    };
    Some(format!("{what}: if that is no disturbance, the values are wrong"))
}

/// Forces that differ between the branches.
fn levels(problem: &FitProblem, solved: &SolvedFit, tau: f64) -> Option<Reason> {
    let mut means: Vec<[f64; 3]> = Vec::new();
    for branch in 0..problem.branches() {
        let rows = problem.rows(solved, branch, true, 0);
        let n = rows.len() as f64;
        if rows.len() < FEWEST {
            continue;
        }
        let mean = rows.iter().map(|row| row.residual).sum::<f64>() / n;
        let squares = rows.iter().map(|row| (row.residual - mean).powi(2)).sum::<f64>();
        means.push([mean, squares, n]);
    }
    let [first, .., last] = means.as_slice() else { return None };
    let degrees = (first[2] + last[2]) / tau - 2.0;
    let variance = (first[1] + last[1]) / (first[2] + last[2] - 2.0);
    if !(degrees >= 1.0 && variance > ROUNDING * ROUNDING) {
        return None;
    }
    let t = (last[0] - first[0]) / (variance * tau * (1.0 / first[2] + 1.0 / last[2])).sqrt();
    (beyond_t(t, degrees) < FALSE_ALARM).then(|| {
        let sentence = format!(
            "where the bodies are apart, the force of the first branch differs from that of the last by {} \
             standard errors: it drifts, or one of the two is in contact",
            short(t.abs(), 2)
        );
        Reason::new("levels", t, sentence)
    })
}
