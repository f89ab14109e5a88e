//! Kalker's functional in a basis of trial pressures.
//!
//! | file | what lives there |
//! |---|---|
//! | [`cholesky`] | the factor of the rings' matrix, by blocks |
//! | [`caution`] | what to be careful about in a basis' answers |
//! | [`functional`] | the functional (16) with the pressure eliminated, its derivatives, the residual |
//! | [`kernel`] | the closed-form interaction of two uniformly loaded discs |
//! | [`mesh`] | how the rings are spaced |
//! | [`moments`] | sums over the gap for force and edge coefficient |
//! | [`outside`] | the displacement of the surface outside the contact |
//! | [`newton`] | one equilibrium state at a prescribed approach, force or device position |
//! | [`parallel`] | work on every core, and how far it has come |
//! | [`rings`] | the paper's ring elements (13)-(18) |
//! | [`spectral`] | eigenfunctions of the half-space operator, exact to rounding |
//!
//! A [`Basis`] is all that the rest of the program knows of a discretization: at a contact radius and an
//! approach it answers with the equilibrium residual and the force and their exact derivatives, and with the energy.
//! Everything here is in reduced units (E* = 1).

pub mod caution;
pub mod cholesky;
pub mod functional;
pub mod kernel;
pub mod mesh;
pub mod moments;
pub mod newton;
pub mod outside;
pub mod parallel;
pub mod rings;
pub mod spectral;

#[cfg(test)]
pub(crate) mod examples;

pub use caution::Caution;
pub use functional::{Evaluation, Forms};
pub use mesh::Grading;
pub use newton::{NewtonFailure, NewtonSettings, Solved, solve};
pub use rings::{Rings, RingsError};
pub use spectral::{Spectral, SpectralError};

use crate::contact::Reduced;
use std::fmt::Debug;

/// Why a basis could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BasisError {
    /// Ring elements.
    #[error(transparent)]
    Rings(#[from] RingsError),
    /// Eigenfunctions.
    #[error(transparent)]
    Spectral(#[from] SpectralError),
}

/// How much is asked of an equilibrium: each answers what the ones before it do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// δ and P, and what follows from P alone: its gradient, and its second derivatives with a δ in them.
    State,
    /// The gradient of the residual as well: the slopes of the curve.
    Slopes,
    /// Everything: the curvature of the curve.
    Curvature,
}

/// A basis of trial pressures on a disc.
pub trait Basis: Debug + Send + Sync {
    /// The residual and the force at contact radius `s > 0` and approach `delta`.
    fn evaluate(&self, problem: &Reduced, s: f64, delta: f64) -> Evaluation;

    /// U at contact radius `s > 0` and approach `delta`: elastic energy minus the adhesion gained.
    ///
    /// Apart from [`Basis::evaluate`]: a curve needs it only at its events.
    fn energy(&self, problem: &Reduced, s: f64, delta: f64) -> f64;

    /// The approach at which a disc of radius `s` is in equilibrium, evaluated there.
    ///
    /// F is quadratic in δ at fixed s; the physical root is the smaller one, with tension at the edge.
    /// `None` when it has no real root, which rings too coarse for the gap can produce; the signed residual of
    /// [`Spectral`] always has one.
    fn equilibrium(&self, problem: &Reduced, s: f64) -> Option<Evaluation>;

    /// The equilibria at `radii`, one after the other, up to the first radius that has none.
    ///
    /// What is beyond `order` need not be there: it may be not a number. Shorter than `radii` there, and where `go_on`, asked before each radius, says no. A curve is made of these:
    /// a basis that samples the gap for many radii at once answers faster than one by one.
    fn equilibria(
        &self,
        problem: &Reduced,
        radii: &[f64],
        _order: Order,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Vec<Evaluation> {
        radii.iter().take_while(|_| go_on()).map_while(|&s| self.equilibrium(problem, s)).collect()
    }

    /// The contact pressure as (r, p) pairs from the axis outward, compression positive.
    fn pressure(&self, problem: &Reduced, s: f64, delta: f64) -> Vec<(f64, f64)>;

    /// The contact pressure as [`Basis::pressure`], at points that make a picture: finite, and dense towards the edge.
    ///
    /// Rings have one value each, the pressure being a step function: those at mid-ring are given.
    fn pressure_profile(&self, problem: &Reduced, s: f64, delta: f64) -> Vec<(f64, f64)> {
        self.pressure(problem, s, delta)
    }

    /// The displacement u of the surface at `radii`, none below `s`, by the pressures at (s, δ); positive as δ is.
    ///
    /// The deformed gap there is h(r) + u(r) − δ, see [`outside`].
    fn outside_displacement(&self, problem: &Reduced, s: f64, delta: f64, radii: &[f64]) -> Vec<f64>;

    /// The number of unknown pressures.
    fn size(&self) -> usize;

    /// Decimal digits of force and contact radius the basis can be trusted for at radius `s`, an estimate.
    fn trusted_digits(&self, problem: &Reduced, s: f64) -> f64;

    /// What to be careful about, in a largest contact of radius `s`: waves not resolved, adhesion too weak.
    fn cautions(&self, problem: &Reduced, s: f64) -> Vec<Caution>;
}
