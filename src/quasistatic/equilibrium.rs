//! The contact as a system of equations for the continuation.
//!
//! Unknowns y = (δ/δ₀, P/P₀, s/s₀), scaled by the ranges of the curve, and two equations
//!
//! ```text
//! ρ(s, δ) = 0            the equilibrium residual of the basis
//! P − P(s, δ) = 0        the force it goes with
//! ```
//!
//! Stability follows from the curve: with tension at the edge `P_s < 0`, and the condition
//! `−F_s (P_δ + k) − P_s² > 0` is the same as d(δ + P/k)/ds > 0 along the curve. Under displacement control
//! that is dδ/ds > 0, under force control dP/ds > 0.

use crate::contact::{Control, Gap, Reduced, Units};
use crate::continuation::system::Matrix;
use crate::continuation::{Linearization, Point, System, Vector};
use crate::ritz::{Basis, Evaluation};
use std::sync::Arc;

/// The unit of each unknown: the ranges of δ, P and s over the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// δ₀.
    pub approach: f64,
    /// P₀.
    pub force: f64,
    /// s₀.
    pub contact_radius: f64,
}

impl Scales {
    /// The ranges over `evaluations`, as powers of two; a quantity that does not vary is scaled by its size.
    ///
    /// Powers of two cost no digit: a state comes back from the unknowns as it went in.
    pub fn of<'a>(evaluations: impl IntoIterator<Item = &'a Evaluation>) -> Self {
        let empty = [f64::INFINITY, f64::NEG_INFINITY, 0.0];
        let mut ranges = [empty; 3];
        for e in evaluations {
            for (range, x) in ranges.iter_mut().zip([e.approach, e.force, e.contact_radius]) {
                *range = [range[0].min(x), range[1].max(x), range[2].max(x.abs())];
            }
        }
        let scale = |[lo, hi, size]: [f64; 3]| {
            let range = hi - lo;
            let found = [range, size].into_iter().find(|x| x.is_finite() && *x > 0.0).unwrap_or(1.0);
            found.log2().round().exp2()
        };
        let [approach, force, contact_radius] = ranges.map(scale);
        Self { approach, force, contact_radius }
    }
}

/// One equilibrium state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// s.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// U, the total energy of the bodies.
    pub energy: f64,
}

impl State {
    /// The same state in the user's units.
    #[must_use]
    pub fn in_units(&self, units: &Units) -> Self {
        Self {
            contact_radius: self.contact_radius * units.length,
            approach: self.approach * units.length,
            force: self.force * units.force,
            energy: self.energy * units.energy,
        }
    }
}

/// The slopes of the curve at a state, from which the stability under every control follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stability {
    /// dδ/ds.
    pub approach: f64,
    /// dP/ds.
    pub force: f64,
}

impl Stability {
    /// Whether the state is stable when `control` is held.
    pub fn under(&self, control: Control) -> bool {
        control.value(self.approach, self.force) > 0.0
    }
}

/// The crest at which an edge of radius `s` sits: floor(s/λ + ½); crests are at r = mλ.
pub fn wave_index(s: f64, feature_length: Option<f64>) -> Option<u64> {
    // s/λ is positive and far below 2^53.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    feature_length.map(|wave| (s / wave + 0.5).floor() as u64)
}

/// A reduced problem, its basis and the scales of its curve.
#[derive(Debug, Clone)]
pub struct Equilibrium {
    /// The problem.
    pub problem: Reduced,
    /// The discretization.
    pub basis: Arc<dyn Basis>,
    /// The unit of each unknown.
    pub scales: Scales,
}

/// Indices of the unknowns.
pub mod unknown {
    /// δ/δ₀.
    pub const APPROACH: usize = 0;
    /// P/P₀.
    pub const FORCE: usize = 1;
    /// s/s₀.
    pub const CONTACT_RADIUS: usize = 2;
}

impl Equilibrium {
    /// The unknowns of a state.
    pub fn unknowns_of(&self, e: &Evaluation) -> Vector {
        let Scales { approach, force, contact_radius } = self.scales;
        Vector::from_vec(vec![e.approach / approach, e.force / force, e.contact_radius / contact_radius])
    }

    /// δ, P and s of the unknowns.
    pub fn quantities(&self, y: &Vector) -> [f64; 3] {
        let Scales { approach, force, contact_radius } = self.scales;
        [y[0] * approach, y[1] * force, y[2] * contact_radius]
    }

    /// s of a point.
    pub fn contact_radius(&self, point: &Point) -> f64 {
        point.y[unknown::CONTACT_RADIUS] * self.scales.contact_radius
    }

    /// The row of a control: row · y is the controlled quantity.
    pub fn control_row(&self, control: Control) -> Vector {
        let Scales { approach, force, .. } = self.scales;
        Vector::from_vec(match control {
            Control::Displacement => vec![approach, 0.0, 0.0],
            Control::Force => vec![0.0, force, 0.0],
            Control::Stiffness(k) => vec![approach, force / k, 0.0],
        })
    }

    /// The state at a point, its energy evaluated there.
    pub fn state(&self, point: &Point) -> State {
        let [delta, force, s] = self.quantities(&point.y);
        let energy = self.basis.energy(&self.problem, s, delta);
        State { contact_radius: s, approach: delta, force, energy }
    }

    /// The slopes of the curve at a point.
    pub fn stability(&self, point: &Point) -> Stability {
        let [delta, force, s] = self.quantities(&point.frame.tangent);
        Stability { approach: delta / s, force: force / s }
    }

    /// The state of radius `s` from the explicit root, as a point whose tangent runs inward.
    pub fn explicit(&self, s: f64) -> Option<Point> {
        self.point(&self.basis.equilibrium(&self.problem, s)?)
    }

    /// The wave index of an edge.
    pub fn wave(&self, s: f64) -> Option<u64> {
        wave_index(s, self.problem.gap.feature_length())
    }

    /// Where `miss` changes its sign between two points of the curve, by halving in s through the explicit root.
    ///
    /// Slow and certain: for where a located Newton fails. `None` only where the basis has no equilibrium.
    pub fn bisect(&self, from: &Point, to: &Point, miss: impl Fn(&Point) -> f64) -> Option<Point> {
        let side = miss(from) > 0.0;
        let (mut a, mut b) = (self.contact_radius(from), self.contact_radius(to));
        loop {
            let middle = 0.5 * (a + b);
            let point = self.explicit(middle)?;
            if middle <= a.min(b) || middle >= a.max(b) {
                return Some(point);
            }
            if (miss(&point) > 0.0) == side {
                a = middle;
            } else {
                b = middle;
            }
        }
    }

    /// The point of an evaluated equilibrium, its tangent running inward; `None` where the curve is singular.
    pub fn point(&self, evaluation: &Evaluation) -> Option<Point> {
        let y = self.unknowns_of(evaluation);
        Point::new(y, &self.linearization(evaluation, evaluation.force), &inward())
    }

    /// The two equations and their derivatives at an evaluated (s, δ) and the force `p`.
    pub fn linearization(&self, e: &Evaluation, p: f64) -> Linearization {
        let Scales { approach: d0, force: p0, contact_radius: s0 } = self.scales;
        let [r_d, r_s] = e.residual_gradient;
        let [r_dd, r_ds, r_ss] = e.residual_second;
        let [p_d, p_s] = e.force_gradient;
        let [p_dd, p_ds, p_ss] = e.force_second;
        let hessian = |dd: f64, ds: f64, ss: f64| {
            let (dd, ds, ss) = (dd * d0 * d0, ds * d0 * s0, ss * s0 * s0);
            Matrix::from_row_slice(3, 3, &[dd, 0.0, ds, 0.0, 0.0, 0.0, ds, 0.0, ss])
        };
        Linearization {
            residual: Vector::from_vec(vec![e.residual, (p - e.force) / p0]),
            scale: Vector::from_vec(vec![e.residual_scale, e.force_scale.max(f64::MIN_POSITIVE) / p0]),
            jacobian: Matrix::from_row_slice(
                2,
                3,
                &[r_d * d0, 0.0, r_s * s0, -p_d * d0 / p0, 1.0, -p_s * s0 / p0],
            ),
            second: vec![hessian(r_dd, r_ds, r_ss), hessian(-p_dd / p0, -p_ds / p0, -p_ss / p0)],
        }
    }
}

/// The direction in which a detachment runs: the contact radius shrinks.
pub fn inward() -> Vector {
    Vector::from_vec(vec![0.0, 0.0, -1.0])
}

impl System for Equilibrium {
    fn unknowns(&self) -> usize {
        3
    }

    fn linearize(&self, y: &Vector) -> Option<Linearization> {
        let [delta, force, s] = self.quantities(y);
        if s.is_nan() || s <= 0.0 {
            return None;
        }
        Some(self.linearization(&self.basis.evaluate(&self.problem, s, delta), force))
    }
}
