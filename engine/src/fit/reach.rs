//! How far a path must go, and how its states are seen in the columns of the points.

use crate::measured::Abscissa;
use crate::problem::Units;

/// What a path must reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// The largest x, P and s of the points; minus infinity where there are none.
    pub most: [f64; 3],
    /// x and P where the retraction begins.
    pub turn: [f64; 2],
    /// Where the path begins, whatever the points are: two neighbouring paths then have the same pieces.
    pub radius: Option<f64>,
    /// The length by which a gap without one of its own is reduced.
    pub length: f64,
    /// The noise of the points as a share of their range: a path that is off by much less than this is good enough.
    pub noise: f64,
}

/// How δ and P are seen.
#[derive(Debug, Clone, Copy)]
pub(super) struct Eye {
    pub(super) units: Units,
    pub(super) abscissa: Abscissa,
    /// 1/k; 0 where x is not the way of a spring.
    pub(super) compliance: f64,
}

impl Eye {
    /// x of a reduced state.
    pub(super) fn x(&self, [s, delta, force]: [f64; 3]) -> f64 {
        let (delta, force) = (delta * self.units.length, force * self.units.force);
        if self.abscissa == Abscissa::Radius {
            s * self.units.length
        } else {
            delta + self.compliance * force
        }
    }

    /// Whether a state reaches as far as the points.
    pub(super) fn is_enough(&self, state: [f64; 3], reach: &Reach) -> bool {
        let force = state[2] * self.units.force;
        let far = self.x(state) >= reach.most[0] && force >= reach.most[1];
        far && state[0] * self.units.length >= reach.most[2]
    }
}
