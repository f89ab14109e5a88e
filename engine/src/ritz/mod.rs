//! Kalker's functional in a basis of trial pressures.
//!
//! | file | what lives there |
//! |---|---|
//! | [`cholesky`] | the factor of the rings' matrix, by blocks |
//! | [`caution`] | warnings about a basis' answers |
//! | [`functional`] | the functional (16) with the pressure eliminated, its derivatives, the residual |
//! | [`kernel`] | the closed-form interaction of two uniformly loaded discs |
//! | [`mesh`] | how the rings are spaced |
//! | [`outside`] | the displacement of the surface outside the contact |
//! | [`newton`] | one equilibrium state at a prescribed approach, force or device position |
//! | [`parallel`] | work on every core |
//! | [`rings`] | the paper's ring elements (13)-(18) |
//!
//! [`Rings`] are a [`Basis`](crate::disc::Basis), and the rest of the program knows them only as such. Everything here
//! is in reduced units (E* = 1).

pub mod caution;
pub mod cholesky;
pub mod functional;
pub mod kernel;
pub mod mesh;
pub mod newton;
pub mod outside;
pub mod parallel;
pub mod rings;

#[cfg(test)]
pub(crate) mod fixtures;

pub use caution::Caution;
pub use functional::Forms;
pub use mesh::Grading;
pub use newton::{NewtonSettings, SolveFailure, SolvedState, solve};
pub use rings::{Rings, RingsError};
