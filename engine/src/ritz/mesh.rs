//! The edges of the rings on the unit disc, eq. (13): evenly spaced, or crowded towards the edge of the contact.
//!
//! ```text
//! uniform   r̃_j = j/N              edge   r̃_j = sin(πj/2N)
//! ```
//!
//! With adhesion the pressure has the singularity 1/√(1 − r̃²) at the edge, which uniform rings resolve to first order
//! in 1/N. The graded rings are even in the angle asin r̃, in which the pressure is smooth, and reach second order.

use crate::elementary::sin;
use std::f64::consts::FRAC_PI_2;
use std::ops::RangeInclusive;

/// How the rings are spaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Grading {
    /// Evenly, as in the paper.
    #[default]
    Uniform,
    /// Crowded towards the edge of the contact.
    Edge,
}

impl Grading {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Uniform, Self::Edge];

    /// Its word in a preset.
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Edge => "edge",
        }
    }

    /// The allowed number of rings: fewer than 4 resolve nothing. More than 2000 uniform rings cost seconds and add no
    /// digits. With more than 400 graded rings the outermost are so thin that the second difference of the interaction
    /// loses the digits that the grading gains.
    pub fn ring_range(self) -> RangeInclusive<usize> {
        match self {
            Self::Uniform => 4..=2000,
            Self::Edge => 4..=400,
        }
    }

    /// The N + 1 edges in a unit of their own, and the radius of the disc in that unit.
    ///
    /// Uniform edges are counted in ring widths: exact integers, whose differences lose least.
    pub(super) fn edges(self, rings: usize) -> (Vec<f64>, f64) {
        let n = rings as f64;
        match self {
            Self::Uniform => ((0..=rings).map(|j| j as f64).collect(), n),
            Self::Edge => ((0..=rings).map(|j| sin(FRAC_PI_2 * (j as f64 / n))).collect(), 1.0),
        }
    }

    /// The width of the widest ring over the radius of the disc.
    pub fn widest(self, rings: usize) -> f64 {
        let n = rings as f64;
        match self {
            Self::Uniform => 1.0 / n,
            Self::Edge => sin(FRAC_PI_2 / n),
        }
    }
}
