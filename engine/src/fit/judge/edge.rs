//! The edge of the points in contact: how fast it moves at each.

use super::super::distance::Nearest;
use super::super::path::Foot;
use super::super::problem::FitProblem;
use crate::elementary::hypot;
use crate::gap::Gap;
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
            Self::Approach => ", if the bodies move at a constant rate",
        }
    }
}

/// What is known of the edge at the points of a problem.
pub(super) struct EdgeMotion {
    /// −ds/dt of an edge that opens and ds/dt of one that closes, by the number of the point; none for other branches.
    pub(super) speeds: Vec<Option<Speed>>,
    /// The number of the row in its branch, divided by the number of rows there.
    pub(super) order: Vec<f64>,
    /// How its branches are read: in a retraction the edge opens, in an approach it closes.
    pub(super) segment: Segment,
    /// The clock that the speeds are taken by.
    pub(super) clock: Clock,
    /// Whether its branches are read from their ends.
    pub(super) is_backward: bool,
    /// Whether its radii are measured; if not, they are those of the curve next to the points.
    pub(super) is_measured: bool,
}

impl EdgeMotion {
    /// The edges in the retractions of `problem`, or in its approaches where it has no others, at the values `u`, by each clock
    /// available: the column of times or, without one, all the others. Where radii are not measured, those of the curve take their
    /// place, if there are times and the radius has no jumps; otherwise there is nothing.
    pub(super) fn all(problem: &FitProblem, u: &[f64]) -> Vec<Self> {
        let (own, branches) = moving(problem);
        let is_timed = branches.iter().flatten().all(|i| problem.data[*i].point.time.is_finite());
        let by_time = |radii: &dyn Fn(usize) -> f64| {
            Self::of(problem, own, Clock::Times, (&|i| problem.data[i].point.time, radii))
        };
        let measured = |i: usize| problem.radius(i);
        if problem.abscissa != Abscissa::Radius && !problem.space {
            let may = is_timed && problem.preset.gap.feature_length().is_none();
            let radii = may.then(|| radii_of_curve(problem, u)).flatten();
            return radii.map(|radii| by_time(&|i| radii[i])).into_iter().collect();
        }
        if is_timed {
            return vec![by_time(&measured)];
        }
        // Rows without times may be listed by their radius: those of an approach may be a retraction, from its end.
        let segments: &[Segment] =
            if own == Segment::Retraction { &[own] } else { &[own, Segment::Retraction] };
        let way = approach(problem, u);
        let of = |segment: &Segment| {
            let (segment, back) = (*segment, if *segment == own { 1.0 } else { -1.0 });
            let by = |clock: Clock, time: &dyn Fn(usize) -> f64| {
                Self::of(problem, segment, clock, (time, &measured))
            };
            let by_rows = by(Clock::Rows, &|i| back * problem.data[i].point.at as f64);
            let by_way = way
                .as_ref()
                .map(|way| by(Clock::Approach, &|i| -sense(segment) * way(i).unwrap_or(f64::NAN)));
            [Some(by_rows), by_way].into_iter().flatten()
        };
        segments.iter().flat_map(of).collect()
    }

    /// The edge by a clock, with the time and the radius of each point, its branches read as `segment`: from their ends if they are
    /// others.
    fn of(
        problem: &FitProblem,
        segment: Segment,
        clock: Clock,
        (time, radius): (&dyn Fn(usize) -> f64, &dyn Fn(usize) -> f64),
    ) -> Self {
        let count = problem.data.len();
        let (own, mut branches) = moving(problem);
        if segment != own {
            for rows in &mut branches {
                rows.reverse();
            }
        }
        let mut edge = Self {
            speeds: vec![None; count],
            order: vec![0.0; count],
            segment,
            clock,
            is_backward: segment != own,
            is_measured: problem.abscissa == Abscissa::Radius || problem.space,
        };
        for rows in &mut branches {
            rows.retain(|i| radius(*i).is_finite());
            let share = 1.0 / rows.len() as f64;
            let (times, radii): (Vec<f64>, Vec<f64>) = rows.iter().map(|i| (time(*i), radius(*i))).unzip();
            let found = speeds(&times, &radii, noise(&times, &radii));
            for (number, (i, speed)) in rows.iter().zip(found).enumerate() {
                edge.speeds[*i] = speed.map(|speed| Speed { value: -sense(segment) * speed.value, ..speed });
                edge.order[*i] = number as f64 * share;
            }
        }
        edge
    }

    /// Whether a column says when a row was measured.
    pub(super) fn is_timed(&self) -> bool {
        self.clock == Clock::Times
    }

    /// Whether the number of the row stands for a time: along an approach the noise of a radius would look like a law by it.
    pub(super) fn tells_by_row(&self) -> bool {
        !self.is_timed() && !self.is_backward && self.segment == Segment::Retraction
    }

    /// The speed at a point, never less than its error: nothing says how much slower the edge is.
    pub(super) fn speed(&self, i: usize) -> Option<f64> {
        self.speeds[i].map(|speed| hypot(speed.value.max(0.0), speed.error))
    }

    /// 1 where the edge opens, −1 where it closes.
    pub(super) fn sense(&self) -> f64 {
        sense(self.segment)
    }

    /// What the work of adhesion does as the edge moves faster.
    pub(super) fn verb(&self) -> &'static str {
        if self.segment == Segment::Retraction { "grows" } else { "falls" }
    }

    /// The edge, in words.
    pub(super) fn noun(&self) -> &'static str {
        if self.segment == Segment::Retraction { "edge" } else { "closing edge" }
    }
}

fn sense(segment: Segment) -> f64 {
    if segment == Segment::Retraction { 1.0 } else { -1.0 }
}

/// The rows of each retraction in contact, in the order of measurement. Where there are none, those of each approach.
pub(super) fn moving(problem: &FitProblem) -> (Segment, Vec<Vec<usize>>) {
    let of = |segment: Segment| -> Vec<Vec<usize>> {
        let of_branch = |branch: usize| {
            let is_wanted = |i: &usize| {
                let datum = &problem.data[*i];
                datum.branch == branch && !datum.free && datum.segment == segment
            };
            let mut rows: Vec<usize> = (0..problem.data.len()).filter(is_wanted).collect();
            rows.sort_by_key(|i| problem.data[*i].point.at);
            rows
        };
        (0..problem.branches()).map(of_branch).filter(|rows| !rows.is_empty()).collect()
    };
    let retractions = of(Segment::Retraction);
    if retractions.is_empty() {
        (Segment::Approach, of(Segment::Approach))
    } else {
        (Segment::Retraction, retractions)
    }
}

/// The contact radius of the curve next to each point; not a number on jumps, on lines and beside free points.
pub(super) fn radii_of_curve(problem: &FitProblem, u: &[f64]) -> Option<Vec<f64>> {
    let paths = problem.paths(u)?;
    let feet = problem.feet(&paths, &problem.instrument_at(u))?;
    let radius = |foot: Option<Nearest>| match foot {
        Some(Nearest { foot: Foot::Radius(radius), .. }) => radius,
        _ => f64::NAN,
    };
    Some(feet.into_iter().map(radius).collect())
}

/// δ of a row from its force and radius: at a held contact radius δ follows P as under a punch, with the stiffness
/// 2E*s.
fn approach<'a>(problem: &'a FitProblem, u: &[f64]) -> Option<impl Fn(usize) -> Option<f64> + 'a> {
    let paths = problem.paths(u)?;
    let segment = moving(problem).0;
    let modulus = problem.preset_at(u, segment)?.material.effective_modulus;
    let baseline = problem.instrument_at(u).baseline;
    Some(move |i: usize| {
        let (path, s) = (paths.of(segment), problem.radius(i));
        let more = problem.data[i].point.force - baseline - path.at(s)?.0[1];
        Some(path.approach(s)? + more / (2.0 * modulus * s))
    })
}
