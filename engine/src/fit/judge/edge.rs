//! The edge of the points in contact: how fast it goes at each.

use super::super::problem::Problem;
use crate::elementary::hypot;
use crate::measured::speed::{Speed, noise, speeds};
use crate::measured::{Abscissa, Segment};

/// What is known of the edge at the points of a problem.
pub(super) struct Edge {
    /// −ds/dt, by the number of the point; nothing but for retractions in contact.
    pub(super) speeds: Vec<Option<Speed>>,
    /// The number of the row in its retraction, over their number.
    pub(super) order: Vec<f64>,
    /// Whether a column has the times.
    pub(super) is_timed: bool,
}

impl Edge {
    /// Of the retractions of `problem`; nothing where radii are not measured.
    pub(super) fn of(problem: &Problem) -> Option<Self> {
        if problem.abscissa != Abscissa::Radius && !problem.space {
            return None;
        }
        let count = problem.data.len();
        let mut edge = Self { speeds: vec![None; count], order: vec![0.0; count], is_timed: true };
        for rows in retractions(problem) {
            edge.is_timed &= rows.iter().all(|i| problem.data[*i].point.time.is_finite());
            let share = 1.0 / rows.len() as f64;
            for (number, (i, speed)) in rows.iter().zip(of_rows(problem, &rows)).enumerate() {
                edge.speeds[*i] = speed;
                edge.order[*i] = number as f64 * share;
            }
        }
        Some(edge)
    }

    /// The speed at a point; one within its error is that: nothing says how much slower the edge is.
    pub(super) fn speed(&self, i: usize) -> Option<f64> {
        self.speeds[i].map(|speed| hypot(speed.value.max(0.0), speed.error))
    }
}

/// The rows of each retraction in contact, in the order of measurement.
pub(super) fn retractions(problem: &Problem) -> Vec<Vec<usize>> {
    let of_branch = |branch: usize| {
        let is_wanted = |i: &usize| {
            let datum = &problem.data[*i];
            datum.branch == branch && !datum.free && datum.segment == Segment::Retraction
        };
        let mut rows: Vec<usize> = (0..problem.data.len()).filter(is_wanted).collect();
        rows.sort_by_key(|i| problem.data[*i].point.at);
        rows
    };
    (0..problem.branches()).map(of_branch).filter(|rows| !rows.is_empty()).collect()
}

/// −ds/dt at each of the rows, in the order of measurement; a unit of time is that from row to row where nothing else says it.
fn of_rows(problem: &Problem, rows: &[usize]) -> Vec<Option<Speed>> {
    let is_timed = rows.iter().all(|i| problem.data[*i].point.time.is_finite());
    let of = |i: &usize| {
        let point = problem.data[*i].point;
        (if is_timed { point.time } else { point.at as f64 }, problem.radius(*i))
    };
    let (times, radii): (Vec<f64>, Vec<f64>) = rows.iter().map(of).unzip();
    let found = speeds(&times, &radii, noise(&times, &radii));
    found.into_iter().map(|speed| speed.map(|speed| Speed { value: -speed.value, ..speed })).collect()
}
