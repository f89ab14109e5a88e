//! One step along the curve: predict, correct on the sphere, judge, and try again shorter.

use super::branch::Point;
use super::convergence::NewtonFailure;
use super::corrector::Constraint;
use super::settings::Settings;
use super::step_size;
use super::system::{ColumnView, SizeError};
use super::tracer::Tracer;

/// Why no acceptable step was found.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum StepFailure {
    /// The corrector failed at every length.
    #[error("no step of at least {shortest:.1e} converged: {cause}")]
    Corrector {
        /// The shortest length allowed.
        shortest: f64,
        /// The last failure.
        cause: NewtonFailure,
    },
    /// The orientation flips however short the step: the curve branches or ends here.
    #[error("the curve changes orientation within {shortest:.1e}: it branches or ends here")]
    Orientation {
        /// The shortest length allowed.
        shortest: f64,
    },
    /// There is no curve to step along.
    #[error(transparent)]
    Sizes(#[from] SizeError),
}

/// A step judged unfit, and by how much to cut it.
enum Rejected {
    Corrector(NewtonFailure),
    Backwards,
    Orientation,
    Turning(f64),
    Increment,
}

impl Tracer<'_> {
    /// The next point after `from`; the step length adapts itself for the following one.
    ///
    /// # Errors
    /// [`StepFailure`] when even the shortest step is not accepted.
    pub fn step(&mut self, from: &Point) -> Result<Point, StepFailure> {
        self.check(&[from], None)?;
        let shortest = self.settings.shortest;
        let mut rejected = false;
        let mut length = self.length.min(step_size::longest(from, &self.settings)).max(shortest);
        loop {
            let cause = match self.attempt(from, length) {
                Ok(point) => {
                    let mut factor = step_size::factor(point.turning, &self.settings);
                    if point.rounds >= self.settings.brake_rounds {
                        factor = factor.min(0.5);
                    }
                    if rejected {
                        factor = factor.min(1.0);
                    }
                    self.length = (length * factor).clamp(shortest, self.settings.longest);
                    return Ok(point);
                }
                Err(cause) => cause,
            };
            self.work.rejections += 1;
            rejected = true;
            let cut = match cause {
                Rejected::Corrector(NewtonFailure::Sizes(sizes)) => return Err(sizes.into()),
                Rejected::Corrector(cause) if length <= shortest => {
                    return Err(StepFailure::Corrector { shortest, cause });
                }
                _ if length <= shortest => return Err(StepFailure::Orientation { shortest }),
                Rejected::Turning(turning) => step_size::factor(turning, &self.settings).min(0.9),
                Rejected::Increment => 0.7,
                _ => self.settings.cut,
            };
            length = (length * cut).max(shortest);
        }
    }

    /// Corrects the prediction at `length` and judges it.
    fn attempt(&mut self, from: &Point, length: f64) -> Result<Point, Rejected> {
        let tangent = from.tangent();
        self.predict(from, length);
        let sphere = Constraint::Sphere { centre: from.y(), radius: length };
        let mut rounds = self.correct(sphere).map_err(Rejected::Corrector)?;
        if self.ahead_of(from, tangent) <= 0.0 {
            // The sphere cuts the curve behind us as well; the plane across the tangent does not.
            self.predict(from, length);
            let plane = Constraint::Plane { row: tangent, value: tangent.dot(&self.y) };
            rounds = self.correct(plane).map_err(Rejected::Corrector)?;
            if self.ahead_of(from, tangent) <= 0.0 {
                return Err(Rejected::Backwards);
            }
        }
        let mut point = self.point(rounds, tangent).ok_or(Rejected::Orientation)?;
        // The determinant decides which way is forward; the old tangent only starts the guess.
        if point.positive != from.positive {
            point = point.reversed();
        }
        if self.ahead_of(from, point.tangent()) <= 0.0 {
            return Err(Rejected::Orientation);
        }
        let point = point.after(from);
        let Settings { shortest, turning, turning_excess, .. } = self.settings;
        if point.turning > turning_excess * turning && point.length > shortest {
            return Err(Rejected::Turning(point.turning));
        }
        if step_size::exceeds_increment(from, &point, &self.settings) && point.length > shortest {
            return Err(Rejected::Increment);
        }
        Ok(point)
    }

    /// Puts the iterate on the tangent of `from`, at this distance.
    fn predict(&mut self, from: &Point, length: f64) {
        self.y.copy_from(&from.y());
        self.y.axpy(length, &from.tangent(), 1.0);
    }

    /// How far the iterate is from `from` along `direction`.
    fn ahead_of(&self, from: &Point, direction: ColumnView<'_>) -> f64 {
        let ends = [self.y.column(0), from.y(), direction];
        let [y, from, direction] = ends.each_ref().map(ColumnView::as_slice);
        y.iter().zip(from).zip(direction).map(|((y, from), d)| (y - from) * d).sum()
    }
}
