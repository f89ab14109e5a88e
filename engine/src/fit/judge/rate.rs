//! Whether the work of adhesion grows with the speed of the edge, as that of polymers does: A. N. Gent and J. Schultz, J. Adhesion 3, 281
//! (1972); D. Maugis and M. Barquins, J. Phys. D 11, 1989 (1978).
//!
//! ```text
//! G = γ (v/v_max)ⁿ          v = −ds/dt of a retraction
//! G = γ (v_max/v)ⁿ          v = ds/dt of an approach, which is looked at where there is no retraction
//! ```
//!
//! An edge at rest has a work of adhesion too: below a share of the largest speed, or within the error of a speed, all
//! speeds count as one. The noise of a row's own radius has no weight in the speed of that row except at the ends, so
//! it does not enter residual and speed at once.
//!
//! A fit takes up most of the effect of a speed: what is left shows in few rows. So here the false-alarm rate is one in
//! two hundred. Where no column has the times, two clocks stand in: rows that are evenly spaced in time, and bodies
//! that are pulled apart at a constant rate. A work of adhesion that grows from row to row, as √(number of the row), is
//! also tested for; the three share that false-alarm rate.

use super::super::chance::beyond_t;
use super::super::problem::FitProblem;
use super::super::pulled::is_pulled;
use super::super::solve::SolvedFit;
use super::super::track::Mover;
use super::super::verdict::{Reason, UNTOLD};
use super::Evidence;
use super::edge::{EdgeMotion, moving};
use super::scores::{MOST_OF_NEIGHBOURS, rest, score};
use super::untold::untold;
use crate::elementary::{ln, pow};
use crate::measured::Segment;
use crate::units::number::short;
use nalgebra::DVector;

/// The kinds of the reasons that are found here.
pub(super) const KINDS: [&str; 2] = ["rate", UNTOLD];
/// The share of right fits that the test flags.
const FALSE_ALARM: f64 = 5e-3;
/// The same where the radii are those of the curve.
const FALSE_ALARM_OF_CURVE: f64 = 1e-3;
/// Points lean to a work of adhesion that grows if they do so by this many standard errors, by any clock or by the
/// number of the row. Of a thousand pulls at a speed, those that are not detected lean by at least 1.6.
const LEANING: f64 = 1.4;
/// Speeds below this share of the largest count as this share.
const SLOWEST: f64 = 1.0 / 400.0;

/// What speaks for a work of adhesion that grows, or of a closing edge falls, or against telling it from one that does not.
pub(super) fn of_rate(evidence: Evidence) -> Option<Reason> {
    let Evidence { problem, solved, .. } = evidence;
    let edges = EdgeMotion::all(problem, &solved.minimum.parameters);
    let tested: Vec<(&EdgeMotion, TestedGrowth)> =
        edges.iter().filter_map(|edge| Some((edge, tested(evidence, edge)?))).collect();
    // The speed by each clock and, where none is a column of times, the number of the row.
    let tests = if edges.iter().any(EdgeMotion::is_timed) { 1.0 } else { 1.0 + edges.len() as f64 };
    let found = tested.iter().find_map(|(edge, tested)| grows(evidence, edge, (tested, tests)));
    // What a fit takes up of a law by one clock is left in the law by another, or by the number of the row. That rows are
    // listed from their end is told only where it is found: as a doubt it would hang over every approach.
    let tested: Vec<_> = tested.into_iter().filter(|(edge, _)| !edge.is_backward).collect();
    let all = tested.iter().flat_map(|(edge, TestedGrowth { by_speed, by_row, .. })| {
        [by_speed[1], if edge.tells_by_row() { by_row[1] } else { f64::NEG_INFINITY }]
    });
    let lean = all.fold(f64::NEG_INFINITY, f64::max);
    found.or_else(|| {
        tested.iter().find_map(|(edge, _)| {
            // Without times nothing says that the edge moves at all: where the points do not lean to it, that is a
            // doubt and not a reason.
            let may = edge.is_measured && (edge.is_timed() || lean >= LEANING);
            may.then(|| untold(evidence, edge, lean)).flatten()
        })
    })
}

/// What to try where the model does not describe a retraction with times, and no `reasons` name a speed: where the law is large, the
/// fit has taken up what one step from it would show.
pub fn untried(problem: &FitProblem, reasons: &[Reason]) -> Option<String> {
    let (segment, branches) = moving(problem);
    let is_timed = branches.iter().flatten().all(|i| problem.data[*i].point.time.is_finite());
    let is_static = !is_pulled(&problem.preset) && problem.preset.cohesion().is_none();
    let is_named = reasons.iter().any(|reason| KINDS.contains(&reason.kind));
    (segment == Segment::Retraction && is_timed && is_static && !is_named).then(|| {
        "the rows have times: a work of adhesion that grows with the speed of the edge, as that of soft matter does, may look \
         like this. --model rate fits it"
            .to_owned()
    })
}

/// What is doubtful where no column has the times and nothing else was found: the points do not say whether the edge is
/// at rest.
pub(super) fn of_untimed(evidence: Evidence) -> Option<String> {
    let edges = EdgeMotion::all(evidence.problem, &evidence.solved.minimum.parameters);
    let mut untimed = edges.iter().filter(|edge| !edge.is_timed() && !edge.is_backward);
    let reason = untimed.find_map(|edge| untold(evidence, edge, 0.0))?;
    Some(format!("there is no column of times: {}", reason.sentence))
}

/// n and t of the speed, and of the number of the row; and whether a law with that n of the speed comes near the points.
struct TestedGrowth {
    by_speed: [f64; 2],
    by_row: [f64; 2],
    is_near: bool,
}

/// The test of an edge; `None` where nothing moves, or where the values are not determined.
fn tested(evidence: Evidence, edge: &EdgeMotion) -> Option<TestedGrowth> {
    /// A law that leaves more than this many times the noise is not near the points.
    const WELL: f64 = 2.0;
    let Evidence { problem, solved, scatter, inner } = evidence;
    let mut alone = vec![false; problem.per_point() * problem.data.len()];
    for rows in moving(problem).1 {
        off_alone(problem, solved, MOST_OF_NEIGHBOURS * scatter.contact?, &rows, &mut alone);
    }
    let most = (0..problem.data.len()).filter_map(|i| edge.speed(i)).fold(0.0, f64::max);
    // Without (JᵀJ)⁻¹ no law has a score, which is not the same as one that says nothing.
    if most <= 0.0 || inner.is_none() {
        return None;
    }
    let u = &solved.minimum.parameters;
    // A law that the values take up completely says nothing.
    let of = |z: &DVector<f64>| score(evidence, z, Some(&alone)).unwrap_or([0.0; 2]);
    let by_speed =
        |i: usize| edge.speed(i).map_or(0.0, |speed| edge.sense() * ln((speed / most).max(SLOWEST)));
    let by_speed = problem.changed(u, Mover::Adhesion, by_speed)?;
    let by_row = problem.changed(u, Mover::Adhesion, |i| edge.sense() * edge.order[i].sqrt())?;
    let found = of(&by_speed);
    let is_near = rest(evidence, &by_speed, found[0]).is_some_and(|rest| rest <= WELL);
    Some(TestedGrowth { by_speed: found, by_row: of(&by_row), is_near })
}

/// A work of adhesion that grows with the speed of the edge or, where no column has the times, with the number of the
/// row.
fn grows(
    Evidence { problem, scatter, .. }: Evidence,
    edge: &EdgeMotion,
    (&TestedGrowth { by_speed, by_row, is_near }, tests): (&TestedGrowth, f64),
) -> Option<Reason> {
    let alarm = if edge.is_measured { FALSE_ALARM } else { FALSE_ALARM_OF_CURVE };
    let is_found = |[n, t]: [f64; 2]| n > 0.0 && tests * 0.5 * beyond_t(t, scatter.degrees) < alarm;
    if is_found(by_speed) {
        let [n, t] = by_speed;
        let [least, most] = (0..problem.data.len())
            .filter_map(|i| edge.speed(i))
            .fold([f64::INFINITY, 0.0], |[lo, hi], speed| [lo.min(speed), hi.max(speed)]);
        let from_end =
            if edge.is_backward { ", if the rows are those of a retraction from its end" } else { "" };
        let times = pow((least / most).max(SLOWEST), -edge.sense() * n.min(1.0));
        // Near 1 it is the part beyond 1 that counts.
        let times = if (times - 1.0).abs() < 0.1 { format!("{times:.3}") } else { short(times, 2) };
        // One step from values that are far off says nothing of how large the law is.
        let size = if is_near {
            format!(": that of the fastest rows is about {times} times that of the slowest")
        } else {
            String::new()
        };
        let how = if is_near || edge.segment == Segment::Approach {
            ""
        } else {
            ". --model rate tells how much it grows"
        };
        let sentence = format!(
            "a work of adhesion that {} with the speed of the {} describes the points better{}{from_end}{size} ({} standard errors). \
             No quasi-static curve has such an edge{how}",
            edge.verb(),
            edge.noun(),
            edge.clock.condition(),
            short(t, 2)
        );
        return Some(Reason::new("rate", n, sentence));
    }
    let verb = edge.verb();
    let [n, t] = Some(by_row).filter(|of| edge.tells_by_row() && is_found(*of))?;
    let sentence = format!(
        "a work of adhesion that {verb} along the {} describes the points better ({} standard \
         errors), and so does one that {verb} with the speed of the {}: a column of times would decide",
        edge.segment.name(),
        short(t, 2),
        edge.noun(),
    );
    Some(Reason::new("rate", n, sentence))
}

/// Marks the rows, in the order of measurement, that are off by more than `limit` to a side to which neither neighbour
/// is off. The first and the last row have one neighbour: nothing says that they are off alone.
fn off_alone(problem: &FitProblem, solved: &SolvedFit, limit: f64, rows: &[usize], alone: &mut [bool]) {
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
