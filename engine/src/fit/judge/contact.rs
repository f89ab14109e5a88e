//! Whether the curve goes through the points in contact, judged by the noise that neighbours show.
//!
//! ```text
//! m_b = mean of r over bin b,    var m_b = s² (v_b − g_bᵀ (JᵀJ)⁻¹ g_b),    g_b = mean of J over the bin
//! F = Σ m_b² n_b / s² / Σ n_b var m_b,   and each m_b alone
//! ln(R²/s²) √n < 4.4 + 9/√n            R the scale of the residuals, s that of neighbours; in quadrature 3.1 deviations of the correlation
//! ```
//!
//! v is 1/n for white noise. The second term removes what a fit of the same points takes out of a mean. False alarms,
//! each for white noise on the right model: F 1 in 1000, the largest bin 1 in 1000, the scale 1 in 1000 (its limit from
//! 20 000 simulated series of 8 to 300 rows), runs 1 in 1000. All of these leave outliers out: many of them, or some side by
//! side, are rows that the curve misses.

use super::super::chance::{beyond_f, beyond_t};
use super::super::problem::{FitProblem, Target};
use super::super::scatter::{ScatterRow, outlier};
use super::super::verdict::Reason;
use super::edge::radii_of_curve;
use super::{Evidence, ROUNDING, runs};
use crate::elementary::{hypot, ln};
use crate::gap::Gap;
use crate::measured::branches::median;
use crate::measured::{Abscissa, Instrument, Segment};
use crate::preset::edge::CLOSING_ADHESION;
use crate::text::counted;
use crate::units::Quantity;
use crate::units::number::{said, short};
use nalgebra::DVector;
use std::ops::Range;

/// The share of right fits that each test flags.
const FALSE_ALARM: f64 = 1e-3;
/// A normal value lies beyond this many of its deviations, on one side, once in a thousand times.
const ONE_IN_THOUSAND: f64 = 3.1;
/// The fewest rows in a bin, and the most bins on a branch.
const ROWS: usize = 5;
const BINS: usize = 12;
/// Runs are counted in at least this many rows, and fewer runs by this many of their deviations are not chance.
const RUNS_OF: usize = 20;
const FEWER_RUNS: f64 = -3.3;
/// So many outliers side by side, all on one side of the curve, are not chance, even where one row in five is one.
const MISSED: usize = 8;
/// A mean must keep at least this share of its variance: a bin that decides a value alone says nothing.
const LEAST_LEFT: f64 = 0.05;

/// The mean of some neighbouring rows.
struct Bin {
    segment: Segment,
    /// The rows.
    count: usize,
    /// The ends of x.
    x: [f64; 2],
    /// The mean of their residuals.
    mean: f64,
    /// The variance of the mean in s².
    variance: f64,
}

/// What the points in contact say against the fit.
pub(super) fn of_contact(evidence: Evidence) -> Vec<Reason> {
    let scatter = evidence.scatter;
    let Some(s) = scatter.contact.map(|s| s.max(ROUNDING)) else { return Vec::new() };
    let mut reasons = of_bins(evidence, s);
    reasons.extend(of_missed(evidence));
    let count = scatter.rows as f64 / scatter.correlation.rows();
    let ratio = scatter.residuals / s;
    let limit =
        hypot((4.4 + 9.0 / count.sqrt()) / count.sqrt(), ONE_IN_THOUSAND * scatter.of_correlation.sqrt());
    if 2.0 * ln(ratio) > limit {
        reasons.push(Reason::new(
            "scatter",
            ratio,
            format!(
                "in contact the residuals are {} times the noise of neighbouring points: the model does not \
                 describe this{}",
                short(ratio, 3),
                held(evidence.problem)
            ),
        ));
    }
    if scatter.correlation.share <= 0.0 && scatter.residuals > ROUNDING {
        reasons.extend(of_runs(evidence));
    }
    if reasons.is_empty() {
        reasons.extend(of_ramps(evidence));
        reasons.extend(of_many(evidence).or_else(|| of_snaps(evidence)));
    }
    reasons
}

/// Outliers side by side on waves, next to a snap or at an end of the record, that make up most of χ²: that is what a snap at another
/// place looks like. Disturbances lie anywhere, and one row alone may have snapped early.
fn of_snaps(Evidence { problem, solved, scatter, .. }: Evidence) -> Option<Reason> {
    /// There is a snap between rows next to each other whose radii differ by this many times what they do as a rule.
    const SNAPS: f64 = 3.0;
    /// Outliers that leave χ² below this many times that of the noise may be chance.
    const LARGE: f64 = 2.0;
    /// The fewest rows.
    const FEWEST: usize = 2;
    problem.preset.gap.feature_length()?;
    let s = scatter.contact?.max(ROUNDING);
    let u = &solved.minimum.parameters;
    let paths = problem.paths(u)?;
    let radii = radii_of_curve(problem, u)?;
    (0..problem.branches()).find_map(|branch| {
        let rows = problem.in_order(solved, branch, false, 0);
        let segment = problem.data[rows.first()?.index].segment;
        if paths.of(segment).snaps == 0 {
            return None;
        }
        let limit = outlier(&rows);
        let step = |pair: [&ScatterRow; 2]| (radii[pair[0].index] - radii[pair[1].index]).abs();
        let steps = rows.windows(2).map(|pair| step([&pair[0], &pair[1]]));
        let usual = median(steps.filter(|step| step.is_finite()).collect())?;
        // Next to a row that has no radius there is a jump.
        let goes_on = |a: &ScatterRow, b: &ScatterRow| step([a, b]) < SNAPS * usual;
        let square = |rows: &[ScatterRow]| rows.iter().map(|row| row.residual.powi(2)).sum::<f64>();
        let all = square(&rows);
        // Outliers side by side, to one side, of which one lies next to a snap or at an end.
        let side = |row: &ScatterRow| i8::from(row.residual > limit) - i8::from(row.residual < -limit);
        let mut at = 0;
        let runs = rows.chunk_by(|a, b| side(a) == side(b)).map(|run| {
            at += run.len();
            at - run.len()..at
        });
        let is_beside = |run: &Range<usize>| {
            let (before, after) = (run.start.saturating_sub(1), (run.end + 1).min(rows.len()));
            let has_snap = rows[before..after].windows(2).any(|pair| !goes_on(&pair[0], &pair[1]));
            run.start == 0 || run.end == rows.len() || has_snap
        };
        let missed = runs.filter(|run| side(&rows[run.start]) != 0 && run.len() >= FEWEST && is_beside(run));
        let missed = missed.map(|run| &rows[run]).max_by(|a, b| square(a).total_cmp(&square(b)))?;
        let is_most = 2.0 * square(missed) > all && all > LARGE * s * s * rows.len() as f64;
        is_most.then(|| {
            let lines = missed.iter().map(|row| problem.data[row.index].point.row);
            let [lo, hi] = lines.fold([usize::MAX, 0], |[lo, hi], row| [lo.min(row), hi.max(row)]);
            let sentence = format!(
                "rows {lo} to {hi} of the {}, at an end or next to a snap, are far off the curve, to one side: on waves, a snap at \
                 another place looks like that. Other first guesses may lead to it (--set), and --range leaves rows out",
                segment.name()
            );
            Reason::new("outliers", missed.len() as f64, sentence)
        })
    })
}

/// Outliers that are too many for disturbances.
fn of_many(Evidence { problem, solved, .. }: Evidence) -> Option<Reason> {
    /// The fewest of them, and one row in how many may be one.
    const FEWEST: usize = 5;
    const ONE_IN: usize = 5;
    (0..problem.branches()).find_map(|branch| {
        let rows = problem.in_order(solved, branch, false, 0);
        let limit = outlier(&rows);
        let off = rows.iter().filter(|row| row.residual.abs() > limit).count();
        (off >= FEWEST && ONE_IN * off > rows.len()).then(|| {
            let name = problem.data[rows[0].index].segment.name();
            let sentence = format!(
                "{off} of {} in contact on the {name} are outliers: more than disturbances are",
                counted(rows.len(), "row")
            );
            Reason::new("outliers", off as f64, sentence)
        })
    })
}

/// Residuals that are smooth between jumps, as where the path jumps at other places than the points: with many jumps among few rows
/// all measures of the noise but medians take these for noise. A converter of the force or of x does the same within its steps.
fn of_ramps(Evidence { problem, solved, scatter, .. }: Evidence) -> Option<Reason> {
    /// The fewest rows, and the ratio of medians that white noise exceeds in one of ten thousand series of so many.
    const FEWEST: usize = 15;
    const RATIO: f64 = 6.0;
    /// One row in so many may have the x of the row before, unless x is known in coarse steps.
    const REPEATED: usize = 4;
    problem.preset.gap.feature_length()?;
    (0..problem.branches()).find_map(|branch| {
        let rows = problem.in_order(solved, branch, false, 0);
        let differences = rows.windows(3).map(|three| {
            (three[0].residual - 2.0 * three[1].residual + three[2].residual).abs() / 6.0_f64.sqrt()
        });
        let typical = median(rows.iter().map(|row| row.residual.abs()).collect())?;
        let noise = median(differences.collect())? / scatter.correlation.of_differences().sqrt();
        let ratio = typical / noise.max(ROUNDING);
        let x = |row: &ScatterRow| problem.data[row.index].point.x;
        let repeated = rows.windows(2).filter(|pair| x(&pair[0]).total_cmp(&x(&pair[1])).is_eq()).count();
        let is_of_converter = typical * problem.sigma[1] < problem.step || REPEATED * repeated > rows.len();
        (rows.len() >= FEWEST && ratio > RATIO && !is_of_converter).then(|| {
            let sentence = format!(
                "the model does not describe this: between jumps the residuals of the {} go on smoothly, and are {} times the \
                 noise of neighbouring points",
                problem.data[rows[0].index].segment.name(),
                short(ratio, 3)
            );
            Reason::new("ramps", ratio, sentence)
        })
    })
}

/// The held values that are wrong most often, as the end of a sentence.
fn held(problem: &FitProblem) -> String {
    let is_free = |wanted: &dyn Fn(&Target) -> bool| problem.parameters.iter().any(|p| wanted(&p.target));
    let offset = problem.abscissa != Abscissa::Radius && !is_free(&|target| *target == Target::Offset);
    let is_stiffness =
        |target: &Target| matches!(target, Target::Key(key) if key.starts_with("path.control"));
    // Without a free part a baseline is held as it is given.
    let is_apart = problem.data.iter().any(|datum| datum.free);
    let baseline = !is_apart && !is_free(&|target| *target == Target::Baseline);
    let likely = [
        offset.then_some("data.offset, where x is zero"),
        baseline.then_some("data.baseline"),
        problem.closing.map(|_| CLOSING_ADHESION),
        (!is_free(&is_stiffness)).then_some("the stiffness of the device"),
    ];
    let likely: Vec<&str> = likely.into_iter().flatten().collect();
    if likely.is_empty() {
        return String::new();
    }
    format!(", or a held value is wrong (most likely {})", likely.join(", or "))
}

/// Whether the means along the path are off the curve.
fn of_bins(evidence: Evidence, s: f64) -> Vec<Reason> {
    let scatter = evidence.scatter;
    let bins = bins(evidence);
    let mut reasons = Vec::new();
    let tests = bins.len() as f64;
    let off = |bin: &Bin| bin.mean / (s * bin.variance.sqrt());
    let chance = |bin: &Bin| (tests * beyond_t(off(bin), scatter.degrees)).min(1.0);
    let Some(worst) = bins.iter().max_by(|a, b| off(a).abs().total_cmp(&off(b).abs())) else {
        return reasons;
    };
    let scaled = |bin: &Bin| bin.variance * bin.count as f64;
    let left: f64 = bins.iter().map(scaled).sum::<f64>() / scatter.correlation.rows();
    let squares: f64 = bins.iter().map(|bin| off(bin).powi(2)).sum();
    let all = beyond_f(squares / tests, left.clamp(1.0, tests), scatter.degrees);
    if chance(worst) < FALSE_ALARM || all < FALSE_ALARM {
        reasons.push(Reason::new(
            "bins",
            off(worst),
            format!(
                "the curve misses the points: over {} of the {}, from {} to {}, the mean residual \
                 is {} standard errors",
                counted(worst.count, "row"),
                worst.segment.name(),
                shown(evidence.problem, worst.x[0]),
                shown(evidence.problem, worst.x[1]),
                short(off(worst), 2).replace('-', "−")
            ),
        ));
    }
    reasons
}

/// The most outliers side by side.
fn of_missed(Evidence { problem, solved, .. }: Evidence) -> Option<Reason> {
    let of_branch = |branch: usize| {
        let rows = problem.in_order(solved, branch, false, 0);
        let limit = outlier(&rows);
        let side = |row: &ScatterRow| (row.residual.abs() > limit).then_some(row.residual > 0.0);
        let runs: Vec<&[ScatterRow]> = rows.chunk_by(|a, b| side(a) == side(b)).collect();
        runs.into_iter().filter(|run| side(&run[0]).is_some()).max_by_key(|run| run.len()).map(<[_]>::to_vec)
    };
    let missed = (0..problem.branches()).filter_map(of_branch).max_by_key(Vec::len)?;
    let first = problem.data[missed.first()?.index];
    let mean = missed.iter().map(|row| row.residual).sum::<f64>() / missed.len() as f64;
    let x = missed.iter().map(|row| problem.data[row.index].point.x);
    let [lo, hi] = x.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], x| [lo.min(x), hi.max(x)]);
    (missed.len() >= MISSED).then(|| {
        let sentence = format!(
            "the curve misses {} side by side on the {}, from {} to {}, by {} sigma: they count as outliers, and one cause for all \
             of them is likely",
            counted(missed.len(), "row"),
            first.segment.name(),
            shown(problem, lo),
            shown(problem, hi),
            short(mean, 2).replace('-', "−")
        );
        Reason::new("missed", mean, sentence)
    })
}

/// An x as the file has it.
fn shown(problem: &FitProblem, x: f64) -> String {
    let [sign, ..] = Instrument::signs(problem.turned);
    let symbol = if problem.abscissa == Abscissa::Radius { "s" } else { "x" };
    format!("{symbol} = {}", said(&problem.preset.units, Quantity::Length, sign * x))
}

/// The bins of all branches.
fn bins(evidence: Evidence) -> Vec<Bin> {
    let Evidence { problem, solved, .. } = evidence;
    let per = problem.per_point();
    let mut bins = Vec::new();
    for branch in 0..problem.branches() {
        for part in 0..per {
            let rows = problem.rows(solved, branch, false, part);
            let most = (rows.len() / ROWS).clamp(1, BINS);
            let count = if rows.len() < ROWS { 0 } else { most };
            for b in 0..count {
                let of = &rows[b * rows.len() / count..(b + 1) * rows.len() / count];
                bins.extend(bin(evidence, of, part));
            }
        }
    }
    bins
}

fn bin(evidence: Evidence, rows: &[ScatterRow], part: usize) -> Option<Bin> {
    let Evidence { problem, solved, scatter, inner } = evidence;
    let (count, per) = (rows.len() as f64, problem.per_point());
    let jacobian = &solved.minimum.at.jacobian;
    let gradient = DVector::from_iterator(
        jacobian.ncols(),
        jacobian
            .column_iter()
            .map(|column| rows.iter().map(|row| column[per * row.index + part]).sum::<f64>() / count),
    );
    let taken = inner.map_or(0.0, |inner| gradient.dot(&(inner * &gradient)));
    let whole = scatter.correlation.of_mean(rows.len());
    let datum = |row: &ScatterRow| problem.data[row.index];
    Some(Bin {
        segment: datum(rows.first()?).segment,
        count: rows.len(),
        x: rows
            .iter()
            .map(|row| datum(row).point.x)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], x| [lo.min(x), hi.max(x)]),
        mean: rows.iter().map(|row| row.residual).sum::<f64>() / count,
        variance: (whole - taken).max(LEAST_LEFT * whole),
    })
}

/// Residuals that keep their sign.
fn of_runs(Evidence { problem, solved, .. }: Evidence) -> Vec<Reason> {
    let mut reasons = Vec::new();
    for branch in 0..problem.branches() {
        let rows = problem.rows(solved, branch, false, 0);
        let of: Vec<f64> = rows.iter().map(|row| row.residual).collect();
        let found = if of.len() < RUNS_OF { 0.0 } else { runs(&of) };
        if found > FEWER_RUNS {
            continue;
        }
        let name = rows.first().map_or("", |row| problem.data[row.index].segment.name());
        let fewer = if found.is_finite() {
            format!(
                "keep their sign over long runs (the number of runs is {} standard deviations below that of noise)",
                short(-found, 2)
            )
        } else {
            "all have one sign".to_owned()
        };
        reasons.push(Reason::new(
            "runs",
            found,
            format!("the model does not describe this: the residuals of the {name} {fewer}"),
        ));
    }
    reasons
}
