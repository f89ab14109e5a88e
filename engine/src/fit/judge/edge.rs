//! The edge of the points in contact: how fast it moves at each.

use super::super::problem::FitProblem;
use crate::elementary::hypot;
use crate::measured::speed::{Speed, noise, speeds};
use crate::measured::{Abscissa, Segment};

/// How it is known when a row was measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Clock {
    /// A column of times.
    Times,
    /// The number of the row: rows that are evenly spaced in time.
    Rows,
    /// The approach that the measured force and radius have in the fitted model: bodies that are pulled apart at a constant rate.
    Approach,
}

impl Clock {
    /// What must hold for its speeds, as the end of a sentence.
    pub(super) fn condition(self) -> &'static str {
        match self {
            Self::Times => "",
            Self::Rows => ", if the rows are evenly spaced in time",
            Self::Approach => ", if the bodies are pulled apart at a constant rate",
        }
    }
}

/// What is known of the edge at the points of a problem.
pub(super) struct EdgeMotion {
    /// −ds/dt, by the number of the point; none except for retractions in contact.
    pub(super) speeds: Vec<Option<Speed>>,
    /// The number of the row in its retraction, divided by the number of rows there.
    pub(super) order: Vec<f64>,
    /// The clock that the speeds are taken by.
    pub(super) clock: Clock,
}

impl EdgeMotion {
    /// The edges in the retractions of `problem`, at the values `u`, by each clock available: the column of times or,
    /// without one, all the others. Empty where radii are not measured.
    pub(super) fn all(problem: &FitProblem, u: &[f64]) -> Vec<Self> {
        if problem.abscissa != Abscissa::Radius && !problem.space {
            return Vec::new();
        }
        let mut rows = retractions(problem).into_iter().flatten();
        if rows.all(|i| problem.data[i].point.time.is_finite()) {
            return vec![Self::of(problem, Clock::Times, &|i| problem.data[i].point.time)];
        }
        let by_rows = Self::of(problem, Clock::Rows, &|i| problem.data[i].point.at as f64);
        let by_approach = approach(problem, u)
            .map(|approach| Self::of(problem, Clock::Approach, &|i| -approach(i).unwrap_or(f64::NAN)));
        [Some(by_rows), by_approach].into_iter().flatten().collect()
    }

    fn of(problem: &FitProblem, clock: Clock, time: &dyn Fn(usize) -> f64) -> Self {
        let count = problem.data.len();
        let mut edge = Self { speeds: vec![None; count], order: vec![0.0; count], clock };
        for rows in retractions(problem) {
            let share = 1.0 / rows.len() as f64;
            let (times, radii): (Vec<f64>, Vec<f64>) =
                rows.iter().map(|i| (time(*i), problem.radius(*i))).unzip();
            let found = speeds(&times, &radii, noise(&times, &radii));
            for (number, (i, speed)) in rows.iter().zip(found).enumerate() {
                edge.speeds[*i] = speed.map(|speed| Speed { value: -speed.value, ..speed });
                edge.order[*i] = number as f64 * share;
            }
        }
        edge
    }

    /// Whether a column says when a row was measured.
    pub(super) fn is_timed(&self) -> bool {
        self.clock == Clock::Times
    }

    /// The speed at a point, never less than its error: nothing says how much slower the edge is.
    pub(super) fn speed(&self, i: usize) -> Option<f64> {
        self.speeds[i].map(|speed| hypot(speed.value.max(0.0), speed.error))
    }
}

/// The rows of each retraction in contact, in the order of measurement.
pub(super) fn retractions(problem: &FitProblem) -> Vec<Vec<usize>> {
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

/// δ of a row from its force and radius: at a held contact radius δ follows P as under a punch, with the stiffness
/// 2E*s.
fn approach<'a>(problem: &'a FitProblem, u: &[f64]) -> Option<impl Fn(usize) -> Option<f64> + 'a> {
    let paths = problem.paths(u)?;
    let modulus = problem.preset_at(u, Segment::Retraction)?.material.effective_modulus;
    let baseline = problem.instrument_at(u).baseline;
    Some(move |i: usize| {
        let (path, s) = (paths.of(Segment::Retraction), problem.radius(i));
        let more = problem.data[i].point.force - baseline - path.at(s)?.0[1];
        Some(path.approach(s)? + more / (2.0 * modulus * s))
    })
}
