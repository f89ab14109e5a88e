//! Every number of the continuation, with its reason.

use super::convergence::Criteria;

/// Settings of the continuation; lengths are in the caller's scaled unknowns, angles in radians.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// A point is accepted when no equation exceeds this times its scale. Range 1e-14 to 1e-6.
    /// 1e-10: the exact derivatives reach it in the same round as 1e-6.
    pub tolerance: f64,
    /// Newton rounds before a correction is given up. Range 2 to 50. 8: quadratic convergence needs 3.
    pub rounds: usize,
    /// A round after the second that shrinks the correction by less than this has failed. Range 0 to 1.
    pub contraction: f64,
    /// Turning angle wanted per step. Range 0.02 to 0.5. 15°: every fold of 60 random wavy spheres is
    /// found, with fewer points than at 10°; at 20° the saving is small.
    pub turning: f64,
    /// A step that turned more than this times [`Settings::turning`] is done again, shorter.
    pub turning_excess: f64,
    /// Room left below the turning wanted, so that the next step is seldom rejected. Range 0.5 to 1.
    pub safety: f64,
    /// Largest growth of the step from one point to the next. Range 1.1 to 4.
    pub growth: f64,
    /// Largest cut of the step, and the cut after a hard failure. Range 0.05 to 0.9.
    pub cut: f64,
    /// Newton rounds from which the next step is halved. 6: the corrector is near its limit.
    pub brake_rounds: usize,
    /// Longest step. 0.1: a tenth of the range of every quantity.
    pub longest: f64,
    /// Shortest step before giving up. 1e-6: below it nothing on a screen changes.
    pub shortest: f64,
    /// First step.
    pub first: f64,
    /// Largest change per step of each unknown, infinite where there is none.
    pub largest_increment: Vec<f64>,
    /// Points of a trace before it stops. Range 2 to 1 000 000.
    pub points: usize,
    /// A control slope whose cubic comes nearer to zero than this share of its larger end is examined.
    pub grazing: f64,
    /// How often a grazing piece is halved.
    pub grazing_depth: usize,
    /// Shortest piece in which a grazing pair is looked for.
    pub grazing_shortest: f64,
    /// Halvings of a guarded location before it is given up.
    pub locate_rounds: usize,
    /// Largest last correction of a located point. Range 1e-12 to 1e-6. 1e-8: the next one would be about its square,
    /// which is rounding.
    pub locate_correction: f64,
}

impl Settings {
    /// The defaults for `unknowns` quantities without largest increments.
    pub fn new(unknowns: usize) -> Self {
        Self {
            tolerance: 1e-10,
            rounds: 8,
            contraction: 0.9,
            turning: 15f64.to_radians(),
            turning_excess: 1.5,
            safety: 0.9,
            growth: 2.0,
            cut: 0.25,
            brake_rounds: 6,
            longest: 0.1,
            shortest: 1e-6,
            first: 0.01,
            largest_increment: vec![f64::INFINITY; unknowns],
            points: 20_000,
            grazing: 0.05,
            grazing_depth: 3,
            grazing_shortest: 1e-6,
            locate_rounds: 60,
            locate_correction: 1e-8,
        }
    }

    /// When a correction back to the curve has converged.
    pub(super) fn corrector(&self) -> Criteria {
        Criteria { contraction: self.contraction, ..Criteria::new(self.tolerance, self.rounds) }
    }

    /// When the location of a point inside a piece of this length has converged.
    pub(super) fn location(&self, length: f64) -> Criteria {
        let to_rounding = Criteria::new(self.tolerance, self.rounds);
        Criteria { correction: self.locate_correction, longest: length, ..to_rounding }
    }
}
