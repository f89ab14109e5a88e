//! A basis: what the rest of the program knows of a way to compute one disc.
//!
//! At a contact radius and an approach it gives the equilibrium residual, the force and the energy with their exact
//! derivatives; over all radii, the equilibria in panels ([`Solution`]). The exact basis reads the table of the gap
//! ([`ExactBasis`](super::ExactBasis)); ring elements are the paper's method ([`Rings`](crate::ritz::Rings)).

use super::solution::Solution;
use crate::problem::Reduced;
use crate::progress::{Progress, Stopped};
use std::fmt::Debug;
use std::sync::Arc;

/// What a basis gives at one (s, δ): value, gradient and second derivatives.
///
/// Gradients are `[∂/∂δ, ∂/∂s]`, second derivatives `[∂²/∂δ², ∂²/∂δ∂s, ∂²/∂s²]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation {
    /// s.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
    /// The equilibrium residual of the basis; not a number where it does not exist.
    pub residual: f64,
    /// The size against which the residual is judged: its unit, or its rounding level where that is larger.
    pub residual_scale: f64,
    /// Gradient of the residual.
    pub residual_gradient: [f64; 2],
    /// Second derivatives of the residual.
    pub residual_second: [f64; 3],
    /// P.
    pub force: f64,
    /// The size against which a force difference is judged.
    pub force_scale: f64,
    /// Gradient of the force.
    pub force_gradient: [f64; 2],
    /// Second derivatives of the force.
    pub force_second: [f64; 3],
    /// U: elastic energy less the adhesion gained.
    pub energy: f64,
}

impl Evaluation {
    /// dδ/ds and dP/ds along the equilibrium curve.
    pub fn slopes(&self) -> [f64; 2] {
        let approach = -self.residual_gradient[1] / self.residual_gradient[0];
        [approach, self.force_gradient[0] * approach + self.force_gradient[1]]
    }
}

/// How much of an equilibrium is wanted: each order includes the ones before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// δ and P, and what follows from P alone: its gradient, and those of its second derivatives that involve δ.
    State,
    /// Also the gradient of the residual, the slopes of the curve, and the energy.
    Slopes,
    /// Everything: the curvature of the curve.
    Curvature,
}

/// A way to compute one disc of one gap.
pub trait Basis: Debug + Send + Sync {
    /// The residual, the force and the energy at contact radius `s > 0` and approach `delta`.
    fn evaluate(&self, problem: &Reduced, s: f64, delta: f64) -> Evaluation;

    /// The same at each of `states`, (s, δ); fewer where `progress`, asked before each, says stop. Many at once are
    /// faster than one by one.
    fn evaluations(
        &self,
        problem: &Reduced,
        states: &[[f64; 2]],
        progress: &dyn Progress,
    ) -> Vec<Evaluation> {
        let wanted = states.iter().take_while(|_| !progress.stop());
        wanted.map(|[s, delta]| self.evaluate(problem, *s, *delta)).collect()
    }

    /// The approach at which a disc of radius `s` is in equilibrium with tension at its edge, evaluated there.
    ///
    /// `None` where there is none: rings too coarse for the gap, or a radius beyond the known part of the gap.
    fn equilibrium(&self, problem: &Reduced, s: f64) -> Option<Evaluation>;

    /// The equilibria at `radii`, one after the other, up to the first radius that has none.
    ///
    /// Values beyond `order` may be not a number. The result is shorter than `radii` if a radius has no equilibrium, or
    /// if `progress`, asked before one or several radii, says stop. Many radii at once are faster than one by one.
    fn equilibria(
        &self,
        problem: &Reduced,
        radii: &[f64],
        order: Order,
        progress: &dyn Progress,
    ) -> Vec<Evaluation>;

    /// The equilibria over all radii, from `from` or further in, to `to` or as far as the gap is known.
    ///
    /// `None` where there are none.
    ///
    /// # Errors
    /// [`Stopped`].
    fn solution(
        &self,
        problem: &Reduced,
        from: f64,
        to: f64,
        progress: &dyn Progress,
    ) -> Result<Option<Arc<dyn Solution>>, Stopped>;

    /// The contact pressure as (r, p) pairs from the axis outward, compression positive, at points suited to a picture:
    /// finite, and dense towards the edge.
    ///
    /// With rings the pressure is a step function, with one value for each ring: it is given at mid-ring.
    fn pressure(&self, problem: &Reduced, s: f64, delta: f64) -> Vec<(f64, f64)>;

    /// The deformed gap h(r) + u(r) − δ at `radii`, none of them below `s`, under the pressures at (s, δ).
    ///
    /// Not a number where the gap is not known.
    fn gap_outside(&self, problem: &Reduced, s: f64, delta: f64, radii: &[f64]) -> Vec<f64>;

    /// The number of unknown pressures, 0 where there are none.
    fn size(&self) -> usize;

    /// An estimate of the decimal digits of force and contact radius for which the basis can be trusted at radius `s`.
    fn trusted_digits(&self, problem: &Reduced, s: f64) -> f64;

    /// Warnings, in words, for a largest contact of radius `s`.
    fn cautions(&self, problem: &Reduced, s: f64) -> Vec<String>;
}
