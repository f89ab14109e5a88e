//! Steps until the end value, and why it stopped.

use super::branch::{Branch, Point};
use super::corrector::Constraint;
use super::step::StepFailure;
use super::system::{SizeError, Vector};
use super::tracer::Tracer;

/// Where a trace ends: exactly where one unknown takes a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// Which unknown.
    pub unknown: usize,
    /// Its value.
    pub value: f64,
}

/// Why a trace stopped. Only the first is the wanted end; none of them loses points.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Stop {
    /// The end value was reached, exactly.
    #[error("the end value was reached")]
    End,
    /// The caller asked it to.
    #[error("stopped on request")]
    Cancelled,
    /// The point limit was reached.
    #[error("the limit of {0} points was reached before the end value")]
    PointLimit(usize),
    /// No further step was possible.
    #[error("{0}")]
    Failed(StepFailure),
}

impl Tracer<'_> {
    /// Traces the curve from `start` to `end`, at most `settings.points` points.
    ///
    /// `go_on` is asked between points; when it says no, what has been traced is kept.
    pub fn trace(
        &mut self,
        start: Point,
        end: End,
        mut go_on: impl FnMut(&Branch) -> bool,
    ) -> (Branch, Stop) {
        let unknowns = self.y.len();
        let mut branch = Branch { points: vec![start], ..Branch::default() };
        if end.unknown >= unknowns {
            let none = SizeError::NoUnknown { unknown: end.unknown, unknowns };
            return (branch, Stop::Failed(none.into()));
        }
        let before = std::mem::take(&mut self.work);
        let stop = loop {
            let Some(last) = branch.points.last() else { break Stop::End };
            if branch.points.len() >= self.settings.points {
                break Stop::PointLimit(self.settings.points);
            }
            if !go_on(&branch) {
                break Stop::Cancelled;
            }
            let next = self.step(last);
            branch.work = self.work;
            match next {
                Err(failure) => break Stop::Failed(failure),
                Ok(next) => {
                    let side = |p: &Point| p.y()[end.unknown] - end.value;
                    if side(last) * side(&next) <= 0.0 {
                        let landed = self.land(last, &next, end).unwrap_or(next);
                        branch.points.push(landed);
                        break Stop::End;
                    }
                    branch.points.push(next);
                }
            }
        };
        self.work += before;
        (branch, stop)
    }

    /// The point between two neighbours at which the end value is taken.
    fn land(&mut self, from: &Point, to: &Point, end: End) -> Option<Point> {
        let mut row = Vector::zeros(self.y.len());
        row[end.unknown] = 1.0;
        let (a, b) = (from.y()[end.unknown], to.y()[end.unknown]);
        // Where the unknown did not move, the quotient is not a number, and the far end is as good a guess as any.
        let share = Some((end.value - a) / (b - a)).filter(|share| share.is_finite()).unwrap_or(1.0);
        self.y = from.y() + (to.y() - from.y()) * share;
        let rounds = self.correct(Constraint::Plane { row: row.column(0), value: end.value }).ok()?;
        let mut point = self.point(rounds, from.tangent())?;
        // Newton meets the plane only to rounding; the caller asked for this very value.
        point.set(end.unknown, end.value);
        Some(point.after(from))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::continuation::Settings;
    use crate::continuation::fixtures::{Circle, Cubic};

    #[test]
    fn lands_exactly_on_the_end_value() {
        let start = Cubic.point(-3.0);
        let (branch, stop) =
            Tracer::new(&Cubic, Settings::new(2)).trace(start, End { unknown: 0, value: 2.5 }, |_| true);
        assert_eq!(stop, Stop::End);
        let last = branch.points.last().unwrap();
        assert_eq!(last.y()[0].to_bits(), 2.5f64.to_bits());
        assert!((last.y()[1] - Cubic::p(2.5)).abs() < 1e-12);
        assert!(branch.points.iter().all(|p| (p.y()[1] - Cubic::p(p.y()[0])).abs() < 1e-8));
    }

    #[test]
    fn keeps_its_points_at_the_point_limit_and_on_request() {
        let mut settings = Settings::new(2);
        settings.points = 7;
        let end = End { unknown: 0, value: 2.5 };
        let (branch, stop) = Tracer::new(&Cubic, settings).trace(Cubic.point(-3.0), end, |_| true);
        assert_eq!((branch.points.len(), stop), (7, Stop::PointLimit(7)));
        let (branch, stop) =
            Tracer::new(&Cubic, Settings::new(2)).trace(Cubic.point(-3.0), end, |b| b.points.len() < 4);
        assert_eq!((branch.points.len(), stop), (4, Stop::Cancelled));
    }

    #[test]
    fn goes_round_a_circle_without_turning_back() {
        let mut settings = Settings::new(2);
        settings.points = 200;
        let (branch, _) =
            Tracer::new(&Circle, settings).trace(Circle.point(0.0), End { unknown: 0, value: 9.0 }, |_| true);
        for pair in branch.points.windows(2) {
            let turn = pair[0].y()[0] * pair[1].y()[1] - pair[0].y()[1] * pair[1].y()[0];
            assert!(turn > 0.0);
        }
    }
}
