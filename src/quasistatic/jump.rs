//! Where the edge lands when it runs at constant control.
//!
//! Between two neighbouring limit points the control is monotone along the curve, so a curve with its limit
//! points put in as nodes answers with plain comparisons: running inward, the control first rises above its
//! value and the landing is where it falls back through it; running outward, where it rises back. Either way
//! the control grows with s there, which is stability.

use super::curve::{Curve, Limit, Turn};
use super::equilibrium::{Point, Unknowns};
use crate::contact::Control;
use crate::continuation::Work;
use crate::continuation::locate::control_value;

/// Which way the edge runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Run {
    /// The contact shrinks.
    Inward,
    /// The contact grows.
    Outward,
}

/// The points of a curve with the limit points of one control among them, running inward.
#[derive(Debug, Clone)]
pub struct Nodes {
    /// The control whose limit points are nodes.
    pub control: Control,
    row: Unknowns,
    points: Vec<Point>,
    /// The limit points among the nodes: their index and which way the control turns.
    limits: Vec<(usize, Turn)>,
}

/// A landing: the state and the node before it.
#[derive(Debug, Clone, PartialEq)]
pub struct Landing {
    /// The stable state.
    pub point: Point,
    /// The last node the edge has passed or reached on its way.
    pub node: usize,
}

impl Nodes {
    /// The nodes of `curve` for the control of `limits`, which are its limit points.
    pub fn new(curve: &Curve, control: Control, limits: &[Limit]) -> Self {
        let mut points = Vec::with_capacity(curve.branch.points.len() + limits.len());
        let mut indices = Vec::with_capacity(limits.len());
        let mut limits = limits.iter().peekable();
        for (index, point) in curve.branch.points.iter().enumerate() {
            points.push(point.clone());
            while let Some(limit) = limits.next_if(|limit| limit.index == index) {
                indices.push((points.len(), limit.turn));
                points.push(limit.point.clone());
            }
        }
        Self { control, row: curve.equilibrium.control_row(control), points, limits: indices }
    }

    /// The controlled quantity at a node.
    pub fn value(&self, node: usize) -> f64 {
        self.row.dot(&self.points[node].y)
    }

    /// The nodes.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// The outermost state at which the control takes `value` while it grows with s; `None` when there is none.
    pub fn outermost(&self, curve: &Curve, value: f64) -> Option<Point> {
        // The outermost node that is not above the value ends the search; a limit point may be that node alone.
        let inside = (1..self.points.len()).find(|&k| self.value(k) <= value && self.value(k - 1) > value)?;
        self.land(curve, inside - 1, inside, value, &mut Work::default())
    }

    /// All states at which the control takes `value`, from the outermost inward.
    pub fn crossings(&self, curve: &Curve, value: f64) -> Vec<Point> {
        let above = |k: usize| self.value(k) > value;
        (1..self.points.len())
            .filter(|&k| above(k - 1) != above(k))
            .filter_map(|k| self.land(curve, k - 1, k, value, &mut Work::default()))
            .collect()
    }

    /// The state between two nodes at which the control takes `value`.
    fn land(&self, curve: &Curve, from: usize, to: usize, value: f64, work: &mut Work) -> Option<Point> {
        let settings = super::curve::settings(&curve.equilibrium);
        let (a, b) = (&self.points[from], &self.points[to]);
        control_value(&curve.equilibrium, a, b, &self.row, value, &settings, work)
            .or_else(|| curve.equilibrium.bisect(a, b, |p| self.row.dot(&p.y) - value))
    }

    /// The first limit point at or after node `node` at which the control is smallest.
    pub fn next_minimum(&self, node: usize) -> Option<usize> {
        self.limits.iter().find(|&&(at, turn)| at >= node && turn == Turn::Minimum).map(|&(at, _)| at)
    }

    /// Runs from node `node` at the control value `value` to the next stable state.
    ///
    /// `None` when the curve has none in that direction.
    pub fn run(&self, curve: &Curve, node: usize, value: f64, run: Run) -> Option<Landing> {
        let mut work = Work::default();
        let miss = |at: usize| self.value(at) - value;
        match run {
            Run::Inward => {
                let at = (node + 1..self.points.len()).find(|&k| miss(k) <= 0.0 && miss(k - 1) > 0.0)?;
                Some(Landing { point: self.land(curve, at - 1, at, value, &mut work)?, node: at - 1 })
            }
            Run::Outward => {
                let at = (0..node).rev().find(|&k| miss(k) >= 0.0 && miss(k + 1) < 0.0)?;
                Some(Landing { point: self.land(curve, at, at + 1, value, &mut work)?, node: at })
            }
        }
    }
}
