//! When the rounds of a Newton iteration have converged, and when they are given up.
//!
//! ```text
//! ρ = max |g_i| / scale_i       the relative residual of a round
//! |Δ|                           the length of the correction that it leads to
//! |Δ| / |Δ_before|              the rate, which for Newton's method falls to nothing
//! ```
//!
//! Both are relative: the residual to the scale of its equation, the correction to unknowns that the caller has scaled.
//! Neither has an absolute floor.

use super::system::SizeError;

/// What is required of an iteration; an infinite limit requires nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Criteria {
    /// Largest relative residual of a solution.
    pub residual: f64,
    /// Largest length of the correction that led to it.
    pub correction: f64,
    /// Rounds before it is given up.
    pub rounds: usize,
    /// Largest rate after the second round: an iteration that shrinks its corrections less has failed.
    pub contraction: f64,
    /// Longest correction: one that leads further has lost its way.
    pub longest: f64,
}

impl Criteria {
    /// A relative residual of at most `residual` within this many rounds, and nothing else.
    pub const fn new(residual: f64, rounds: usize) -> Self {
        let none = f64::INFINITY;
        Self { residual, correction: none, rounds, contraction: none, longest: none }
    }
}

/// Why an iteration failed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NewtonFailure {
    /// The equations are not defined at an iterate.
    #[error("the equations are not defined at round {round}")]
    Undefined {
        /// The round.
        round: usize,
    },
    /// The matrix of a round is singular.
    #[error("the Newton matrix is singular at round {round}")]
    Singular {
        /// The round.
        round: usize,
    },
    /// The corrections do not shrink.
    #[error("corrections do not shrink (ratio {ratio:.2} at round {round})")]
    Diverging {
        /// The round.
        round: usize,
        /// Last correction over the previous one.
        ratio: f64,
    },
    /// An iterate left the region in which the solution is looked for.
    #[error("a correction of {correction:.1e} at round {round} leads out of the region searched")]
    Left {
        /// The round.
        round: usize,
        /// The length of its correction.
        correction: f64,
    },
    /// The rounds ran out.
    #[error("{rounds} Newton rounds were not enough: relative residual {residual:.1e}, last rate {rate:.1e}")]
    RoundsExhausted {
        /// The rounds.
        rounds: usize,
        /// The relative residual reached.
        residual: f64,
        /// Last correction over the previous one.
        rate: f64,
    },
    /// There is nothing to iterate.
    #[error(transparent)]
    Sizes(#[from] SizeError),
}

/// The course of one iteration.
#[derive(Debug, Clone, Copy)]
pub struct Convergence {
    criteria: Criteria,
    round: usize,
    correction: f64,
    rate: f64,
}

impl Convergence {
    /// An iteration before its first round.
    pub fn new(criteria: Criteria) -> Self {
        Self { criteria, round: 0, correction: f64::INFINITY, rate: f64::INFINITY }
    }

    /// Corrections made.
    pub fn round(&self) -> usize {
        self.round
    }

    /// Length of the last correction, infinite before the first.
    pub fn correction(&self) -> f64 {
        self.correction
    }

    /// Whether the iterate with this relative residual is the solution.
    ///
    /// # Errors
    /// When it is not and no round is left.
    pub fn is_reached(&self, residual: f64) -> Result<bool, NewtonFailure> {
        let Self { criteria, round, correction, rate } = *self;
        if residual <= criteria.residual && correction <= criteria.correction {
            return Ok(true);
        }
        if round >= criteria.rounds {
            return Err(NewtonFailure::RoundsExhausted { rounds: round, residual, rate });
        }
        Ok(false)
    }

    /// Takes the length of the next correction.
    ///
    /// # Errors
    /// When it is not a number, too long, or not enough shorter than the previous one.
    pub fn corrected(&mut self, length: f64) -> Result<(), NewtonFailure> {
        let round = self.round;
        self.rate = length / self.correction;
        if !length.is_finite() {
            return Err(NewtonFailure::Singular { round });
        }
        if length > self.criteria.longest {
            return Err(NewtonFailure::Left { round, correction: length });
        }
        if round >= 2 && length > self.criteria.contraction * self.correction {
            return Err(NewtonFailure::Diverging { round, ratio: self.rate });
        }
        self.correction = length;
        self.round += 1;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Newton's method for x² = 2, from `x`.
    fn root(mut x: f64, criteria: Criteria) -> Result<(f64, Convergence), NewtonFailure> {
        let mut convergence = Convergence::new(criteria);
        while !convergence.is_reached((x * x - 2.0).abs() / 2.0)? {
            let step = (2.0 - x * x) / (2.0 * x);
            convergence.corrected(step.abs())?;
            x += step;
        }
        Ok((x, convergence))
    }

    #[test]
    fn it_ends_at_the_first_criterion_that_is_met() {
        let (x, course) = root(1.5, Criteria::new(1e-10, 9)).unwrap();
        assert!((x - 2f64.sqrt()).abs() < 1e-11 && course.round() == 3, "{course:?}");
        // Judged by its residual, a good enough start needs no correction; judged by the correction, it needs one.
        assert_eq!(root(2f64.sqrt(), Criteria::new(1e-10, 9)).unwrap().1.round(), 0);
        let small = Criteria { correction: 1e-8, ..Criteria::new(1e-10, 9) };
        assert_eq!(root(2f64.sqrt(), small).unwrap().1.round(), 1);
    }

    #[test]
    fn it_fails_with_the_numbers() {
        let criteria = Criteria::new(1e-10, 3);
        let failure = root(1e3, criteria).unwrap_err();
        assert!(matches!(failure, NewtonFailure::RoundsExhausted { rounds: 3, residual, rate }
            if residual > 1e3 && (rate - 0.5).abs() < 1e-3));
        let narrow = Criteria { longest: 1.0, ..criteria };
        assert!(
            matches!(root(1e3, narrow), Err(NewtonFailure::Left { round: 0, correction }) if correction > 499.0)
        );
        assert_eq!(root(0.0, criteria).unwrap_err(), NewtonFailure::Singular { round: 0 });
        let fast = Criteria { contraction: 0.4, rounds: 9, ..criteria };
        assert!(matches!(root(1e3, fast), Err(NewtonFailure::Diverging { round: 2, .. })));
    }
}
