//! One step along the curve: predict, correct on the sphere, judge, and try again shorter.

use super::branch::{Point, Work};
use super::corrector::{Constraint, Corrected, CorrectorFailure, correct};
use super::settings::Settings;
use super::step_size;
use super::system::{System, Vector};

/// Walks a curve step by step; failures leave its caller's points untouched.
#[derive(Debug, Clone)]
pub struct Stepper {
    /// The numbers it goes by.
    pub settings: Settings,
    /// The next step length.
    pub length: f64,
    /// What its steps have cost.
    pub work: Work,
}

/// Why no acceptable step was found.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum StepFailure {
    /// The corrector failed at every length.
    #[error("no step of at least {shortest:.1e} could be corrected: {cause}")]
    Corrector {
        /// The shortest length allowed.
        shortest: f64,
        /// The last failure.
        cause: CorrectorFailure,
    },
    /// The orientation flips however short the step: the curve branches or ends here.
    #[error("the curve changes its orientation within {shortest:.1e}: it branches or ends here")]
    Orientation {
        /// The shortest length allowed.
        shortest: f64,
    },
}

/// A step judged unfit, and by how much to cut it.
enum Rejected {
    Corrector(CorrectorFailure),
    Backwards,
    Orientation,
    Turning(f64),
    Increment,
}

impl Stepper {
    /// A stepper with its first length.
    pub fn new(settings: Settings) -> Self {
        Self { length: settings.first, settings, work: Work::default() }
    }

    /// The next point after `from`; the step length adapts itself for the one after.
    ///
    /// # Errors
    /// [`StepFailure`] when even the shortest step is not accepted.
    pub fn step<const N: usize>(
        &mut self,
        system: &dyn System<N>,
        from: &Point<N>,
    ) -> Result<Point<N>, StepFailure> {
        let shortest = self.settings.shortest;
        let mut rejected = false;
        let mut length = self.length.min(step_size::longest(from, &self.settings)).max(shortest);
        loop {
            match self.attempt(system, from, length) {
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
                Err(cause) => {
                    self.work.rejections += 1;
                    rejected = true;
                    if length <= shortest {
                        return Err(match cause {
                            Rejected::Corrector(cause) => StepFailure::Corrector { shortest, cause },
                            _ => StepFailure::Orientation { shortest },
                        });
                    }
                    let cut = match cause {
                        Rejected::Turning(turning) => step_size::factor(turning, &self.settings).min(0.9),
                        Rejected::Increment => 0.7,
                        _ => self.settings.cut,
                    };
                    length = (length * cut).max(shortest);
                }
            }
        }
    }

    /// Corrects the prediction at `length` and judges it.
    fn attempt<const N: usize>(
        &mut self,
        system: &dyn System<N>,
        from: &Point<N>,
        length: f64,
    ) -> Result<Point<N>, Rejected> {
        let tangent = &from.frame.tangent;
        let guess = from.y + tangent * length;
        let sphere = Constraint::Sphere { centre: from.y, radius: length };
        let ahead = |c: &Corrected<N>| (c.y - from.y).dot(tangent) > 0.0;
        let mut corrected = self.correct(system, guess, &sphere).map_err(Rejected::Corrector)?;
        if !ahead(&corrected) {
            // The sphere cuts the curve behind us as well; the plane across the tangent does not.
            let value = tangent.dot(&guess);
            let plane = Constraint::Plane { row: *tangent, value };
            corrected = self.correct(system, guess, &plane).map_err(Rejected::Corrector)?;
            if !ahead(&corrected) {
                return Err(Rejected::Backwards);
            }
        }
        let forward = corrected.y - from.y;
        let length = forward.norm();
        let point = Point::corrected(&corrected, tangent)
            .map(|mut point| {
                // The determinant decides which way is on; the old tangent only starts the guess.
                if point.frame.positive != from.frame.positive {
                    point = point.reversed();
                }
                point
            })
            .ok_or(Rejected::Orientation)?;
        if point.frame.tangent.dot(&forward) <= 0.0 {
            return Err(Rejected::Orientation);
        }
        let mut point = point;
        point.length = length;
        point.turning = step_size::turning(from, &point);
        let shortest = self.settings.shortest;
        if point.turning > self.settings.turning_excess * self.settings.turning && length > shortest {
            return Err(Rejected::Turning(point.turning));
        }
        if step_size::exceeds_increment(from, &point, &self.settings) && length > shortest {
            return Err(Rejected::Increment);
        }
        Ok(point)
    }

    fn correct<const N: usize>(
        &mut self,
        system: &dyn System<N>,
        guess: Vector<N>,
        constraint: &Constraint<N>,
    ) -> Result<Corrected<N>, CorrectorFailure> {
        let result = correct(system, guess, constraint, &self.settings);
        self.work.evaluations += match &result {
            Ok(corrected) => corrected.rounds + 1,
            Err(
                CorrectorFailure::Undefined { round }
                | CorrectorFailure::Singular { round }
                | CorrectorFailure::Diverging { round, .. },
            ) => round + 1,
            Err(CorrectorFailure::RoundsExhausted { rounds, .. }) => rounds + 1,
        };
        result
    }
}
