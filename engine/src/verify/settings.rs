//! The bases that are verified, and the bounds each must meet.
//!
//! The bounds for rings are for 200 of them, the default number: what a user may expect, up to twice the measured
//! error. The bounds for the exact basis leave some room for rounding.

use super::cases::PaperFigure;
use crate::disc::{Basis, ExactBasis, TableError};
use crate::problem::Problem;
use crate::ritz::{Rings, RingsError};
use std::sync::Arc;

/// Why a basis could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum VerifyError {
    /// Ring elements.
    #[error(transparent)]
    Rings(#[from] RingsError),
    /// The table of a gap.
    #[error(transparent)]
    Table(#[from] TableError),
}

/// What is verified.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VerifySettings {
    /// N of the ring elements; the bounds are for the default of 200. Orders of convergence are observed starting from
    /// a quarter of it.
    pub rings: usize,
}

impl Default for VerifySettings {
    fn default() -> Self {
        Self { rings: 200 }
    }
}

/// The largest differences that pass on the wavy spheres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// For δ, P and s at limit points and landings, relative to their ranges on the curve.
    pub state: f64,
    /// For the smallest force and approach and their contact radii, relative.
    pub extreme: f64,
    /// For a loss, relative.
    pub loss: f64,
}

/// For N = 200. Measured: 0.06 % of the range, 0.1 % of the extreme values, 0.8 % of the losses.
const RINGS: Tolerances = Tolerances { state: 1e-3, extreme: 2e-3, loss: 1e-2 };

/// Rounding; losses are small differences of energies.
const EXACT: Tolerances = Tolerances { state: 1e-10, extreme: 1e-10, loss: 1e-8 };

/// A basis to be verified.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// Its name; for rings, with their number.
    pub name: String,
    /// The basis.
    pub basis: Arc<dyn Basis>,
    /// The bounds it must meet.
    pub bounds: Tolerances,
}

/// The exact basis for `problem`, for contacts of radius up to `s`.
///
/// # Errors
/// [`VerifyError::Table`].
pub fn exact(problem: &Problem, s: f64) -> Result<Arc<dyn Basis>, VerifyError> {
    Ok(Arc::new(ExactBasis::of(&problem.reduced(), s)?))
}

impl VerifySettings {
    /// Both bases for the paths of `figure`.
    ///
    /// # Errors
    /// [`VerifyError`] if one cannot be made.
    pub fn candidates(&self, figure: &PaperFigure) -> Result<Vec<Candidate>, VerifyError> {
        let exact = exact(&figure.problem, figure.start)?;
        Ok(vec![
            Candidate { name: "exact basis".to_owned(), basis: exact, bounds: EXACT },
            Candidate {
                name: format!("{} rings", self.rings),
                basis: Rings::shared(self.rings).map_err(VerifyError::Rings)?,
                bounds: RINGS,
            },
        ])
    }
}
