//! Whether the work of adhesion grows with the speed of the edge, as that of polymers does: A. N. Gent and J. Schultz, J. Adhesion 3, 281
//! (1972); D. Maugis and M. Barquins, J. Phys. D 11, 1989 (1978).
//!
//! ```text
//! G = γ (v/v_max)ⁿ       v = −ds/dt of a retraction, whose rows are even in time where no column says it
//! ```
//!
//! v is the slope of a line through a window of rows. The noise of a row's own radius has no weight in that of a window around it, so
//! it does not enter the row's residual and its speed at once; the window is as wide as the noise of the radii asks for. An edge that rests
//! has a work of adhesion too: below a share of the largest speed all speeds are one.
//!
//! A fit takes most of what a speed does: what is left shows in few rows. So here the false alarm is one in two hundred.

use super::super::chance::beyond_t;
use super::super::path::Mover;
use super::super::problem::Problem;
use super::super::scatter::{Scatter, variance};
use super::super::solve::Solved;
use super::super::verdict::Reason;
use super::scores::{MOST_OF_NEIGHBOURS, score};
use crate::elementary::{ln, pow};
use crate::measured::{Abscissa, Segment};
use crate::units::number::short;
use nalgebra::DMatrix;

/// The share of right fits that the test flags.
const FALSE_ALARM: f64 = 5e-3;
/// Rows of a retraction in contact by which a speed is told, at least.
const FEWEST: usize = 8;
/// The error of a speed in the mean speed.
const KNOWN: f64 = 0.1;
/// Speeds below this share of the largest are this share.
const SLOWEST: f64 = 1.0 / 400.0;

/// A work of adhesion that grows with the speed of the edge.
pub(super) fn of_rate(
    problem: &Problem,
    solved: &Solved,
    scatter: &Scatter,
    inner: Option<&DMatrix<f64>>,
) -> Option<Reason> {
    if problem.abscissa != Abscissa::Radius && !problem.space {
        return None;
    }
    let mut speeds: Vec<Option<f64>> = vec![None; problem.data.len()];
    let mut alone = vec![false; problem.per_point() * problem.data.len()];
    for branch in 0..problem.branches() {
        let is_wanted = |i: &usize| {
            let datum = &problem.data[*i];
            datum.branch == branch && !datum.free && datum.segment == Segment::Retraction
        };
        let mut rows: Vec<usize> = (0..problem.data.len()).filter(is_wanted).collect();
        rows.sort_by_key(|i| problem.data[*i].point.at);
        for (i, speed) in rows.iter().zip(of_edge(problem, &rows)) {
            speeds[*i] = Some(speed);
        }
        off_alone(problem, solved, MOST_OF_NEIGHBOURS * scatter.contact?, &rows, &mut alone);
    }
    let most = speeds.iter().flatten().copied().fold(0.0, f64::max);
    if most <= 0.0 {
        return None;
    }
    let share = |speed: f64| (speed / most).max(SLOWEST);
    let u = &solved.minimum.parameters;
    let z = problem.changed(u, Mover::Adhesion, |i| speeds[i].map_or(0.0, |speed| ln(share(speed))))?;
    let [n, t] = score(problem, solved, scatter, inner?, &z, Some(&alone))?;
    (n > 0.0 && 0.5 * beyond_t(t, scatter.degrees) < FALSE_ALARM).then(|| {
        let least = speeds.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        let sentence = format!(
            "a work of adhesion that grows with the speed of the edge describes the points better: that of the fastest rows is near {} times \
             that of the slowest ({} standard errors). No quasi-static curve has such an edge",
            short(pow(share(least), -n.min(1.0)), 2),
            short(t, 2)
        );
        Reason::new("rate", n, sentence)
    })
}

/// Marks the rows, in the order of measurement, which are off by more than `limit` to a side where neither of the rows beside them is. The
/// first and the last have one such row: nothing says that they are off alone.
fn off_alone(problem: &Problem, solved: &Solved, limit: f64, rows: &[usize], alone: &mut [bool]) {
    let per = problem.per_point();
    for part in 0..per {
        let side = |i: usize| {
            let r = solved.minimum.at.residuals[per * i + part];
            i8::from(r > limit) - i8::from(r < -limit)
        };
        for three in rows.windows(3) {
            let [before, here, after] = [0, 1, 2].map(|k| side(three[k]));
            alone[per * three[1] + part] = here != 0 && before != here && after != here;
        }
    }
}

/// −ds/dt at each of the rows, in the order of measurement, by lines through windows of rows; a unit of time is that from row to row where
/// nothing else says it.
fn of_edge(problem: &Problem, rows: &[usize]) -> Vec<f64> {
    let is_timed = rows.iter().all(|i| problem.data[*i].point.time.is_finite());
    let of = |i: &usize| {
        let point = problem.data[*i].point;
        let radius = if problem.abscissa == Abscissa::Radius { point.x } else { point.radius };
        [if is_timed { point.time } else { point.at as f64 }, radius]
    };
    let rows: Vec<[f64; 2]> = rows.iter().map(of).collect();
    let n = rows.len();
    if n < FEWEST {
        return vec![0.0; n];
    }
    let way = (rows[0][1] - rows[n - 1][1]).abs() / (n - 1) as f64;
    let differences: Vec<f64> = rows
        .windows(3)
        .map(|three| (three[0][1] - 2.0 * three[1][1] + three[2][1]) / 6.0_f64.sqrt())
        .collect();
    let noise = variance(&differences).unwrap_or(0.0).sqrt();
    // The slope of w even rows has the error σ √(12/w³).
    let error = |half: usize| noise * (12.0 / (2.0 * half as f64 + 1.0).powi(3)).sqrt();
    let half = (1..n / 6).find(|half| error(*half) <= KNOWN * way).unwrap_or((n / 6).max(1));
    let slope = |at: usize| {
        let of = &rows[at.saturating_sub(half)..(at + half + 1).min(n)];
        let count = of.len() as f64;
        let [t, s] = [0, 1].map(|k| of.iter().map(|row| row[k]).sum::<f64>() / count);
        let [tt, ts] = of
            .iter()
            .fold([0.0; 2], |[tt, ts], row| [tt + (row[0] - t).powi(2), ts + (row[0] - t) * (row[1] - s)]);
        if tt > 0.0 { -ts / tt } else { 0.0 }
    };
    (0..n).map(slope).collect()
}
