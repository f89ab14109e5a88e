//! The points of one ring.

use super::rule::RingRule;

/// The points of one ring.
#[derive(Debug, Clone)]
pub struct Nodes {
    /// [a, b].
    pub ends: [f64; 2],
    /// Their number and what depends on it alone.
    pub rule: &'static RingRule,
    /// r, outward.
    pub radii: Vec<f64>,
    /// r − a.
    pub from_inner: Vec<f64>,
    /// How fast each point moves when a does, and when b does.
    pub speeds: [Vec<f64>; 2],
    /// dv/dr at [a, b], when a moves and when b does.
    pub slopes: [[f64; 2]; 2],
    /// dθ/dt at both edges.
    pub stretch: [f64; 2],
    /// The angle graded towards breaks inside.
    pub graded: Option<Graded>,
}

/// A graded angle.
#[derive(Debug, Clone)]
pub struct Graded {
    pub(super) n: usize,
    /// θ at the edges and breaks, and the points on each piece between.
    pub(super) borders: Vec<f64>,
    pub(super) pieces: Vec<usize>,
    /// |r − r'| of all pairs.
    pub(super) apart: Vec<f64>,
    /// |cos θ − cos θ'| over |cos t − cos t'|.
    pub(super) lift: Vec<f64>,
    /// (v − v')/(r − r') for both edges, dv/dr on the diagonal.
    pub speeds: [Vec<f64>; 2],
}

impl Nodes {
    /// `n` points of the ring, rounded up.
    pub fn plain(ends: [f64; 2], n: usize) -> Self {
        let rule = RingRule::of(n);
        let [a, b] = ends;
        let width = b - a;
        let from_inner: Vec<f64> = rule.halves[1].iter().map(|x| width * x).collect();
        let radii = from_inner.iter().map(|x| a + x).collect();
        let slope = width.recip();
        Self {
            ends,
            rule,
            radii,
            from_inner,
            speeds: [rule.halves[0].clone(), rule.halves[1].clone()],
            slopes: [[-slope; 2], [slope; 2]],
            stretch: [1.0; 2],
            graded: None,
        }
    }

    /// d.
    pub fn half(&self) -> f64 {
        0.5 * (self.ends[1] - self.ends[0])
    }

    /// c.
    pub fn middle(&self) -> f64 {
        0.5 * (self.ends[0] + self.ends[1])
    }
}
