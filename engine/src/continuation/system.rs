//! The equations whose solutions form the curve.
//!
//! n − 1 equations g(y) = 0 in n unknowns, with
//!
//! ```text
//! J = ∂g/∂y           (n − 1) × n
//! J_v = ∂J/∂y · v     (n − 1) × n, the second derivatives along a direction v:   g_yy[v, z] = J_v z
//! ```
//!
//! n is known at run time: 2 to a few hundred, since the algebra is dense.

use nalgebra::{DMatrix, DMatrixViewMut, DVector, DVectorView, MatrixXx3};

/// A column of numbers.
pub type Vector = DVector<f64>;
/// Three columns.
pub type Columns = MatrixXx3<f64>;
/// A column of a matrix, to read.
pub type ColumnView<'a> = DVectorView<'a, f64>;
/// A matrix.
pub type Matrix = DMatrix<f64>;
/// A matrix to write to, whose size is given.
pub type MatrixMut<'a> = DMatrixViewMut<'a, f64>;

/// The equations and their derivatives at one point.
#[derive(Debug, Clone, PartialEq)]
pub struct Linearization {
    /// g(y), n − 1 numbers.
    pub residual: Vector,
    /// The size against which each equation is judged, n − 1 positive numbers.
    pub scale: Vector,
    /// J, (n − 1) × n.
    pub jacobian: Matrix,
    /// What the system keeps for when it is asked for its second derivatives here.
    pub kept: Vec<f64>,
}

impl Linearization {
    /// Room for the equations of a system with this many unknowns.
    pub fn new(unknowns: usize) -> Self {
        let equations = unknowns.saturating_sub(1);
        Self {
            residual: Vector::zeros(equations),
            scale: Vector::zeros(equations),
            jacobian: Matrix::zeros(equations, unknowns),
            kept: Vec::new(),
        }
    }

    /// The largest residual relative to its scale; infinite when any is not a number.
    pub fn relative_residual(&self) -> f64 {
        let mut worst = 0.0_f64;
        for (g, scale) in self.residual.as_slice().iter().zip(self.scale.as_slice()) {
            let relative = (g / scale).abs();
            if !relative.is_finite() {
                return f64::INFINITY;
            }
            worst = worst.max(relative);
        }
        worst
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        [self.residual.as_slice(), self.jacobian.as_slice()]
            .iter()
            .all(|part| part.iter().all(|x| x.is_finite()))
    }

    /// Checks that it belongs to a system with this many unknowns.
    ///
    /// # Errors
    /// Names the first part of another size.
    pub fn has_sizes_of(&self, unknowns: usize) -> Result<(), SizeError> {
        let equations = unknowns.saturating_sub(1);
        SizeError::check("the residual", self.residual.len(), equations)?;
        SizeError::check("the scale of the residual", self.scale.len(), equations)?;
        SizeError::check("a column of the Jacobian", self.jacobian.nrows(), equations)?;
        SizeError::check("a row of the Jacobian", self.jacobian.ncols(), unknowns)
    }
}

/// Sizes that do not agree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SizeError {
    /// There is no curve in fewer than two unknowns.
    #[error("a curve needs 2 unknowns, the system has {0}")]
    TooFew(usize),
    /// There is no unknown of this index.
    #[error("there is no unknown {unknown} (counted from 0) among {unknowns}")]
    NoUnknown {
        /// The index.
        unknown: usize,
        /// How many there are.
        unknowns: usize,
    },
    /// A vector or matrix is not of the system's size.
    #[error("{part} has {found} entries, the system needs {expected}")]
    Mismatch {
        /// Which one.
        part: &'static str,
        /// Its size.
        found: usize,
        /// The size that the number of unknowns asks for.
        expected: usize,
    },
}

impl SizeError {
    /// Checks that `part` has the expected size.
    pub(super) fn check(part: &'static str, found: usize, expected: usize) -> Result<(), Self> {
        if found == expected { Ok(()) } else { Err(Self::Mismatch { part, found, expected }) }
    }
}

/// n − 1 equations in n unknowns with an exact Jacobian, and with second derivatives where it has them.
pub trait System {
    /// n, at least 2.
    fn unknowns(&self) -> usize;

    /// Writes the equations at `y` (n numbers) to `at`, which still holds the numbers of another point; `None` where
    /// they are not defined.
    fn linearize(&self, y: &Vector, at: &mut Linearization) -> Option<()>;

    /// Writes `J_v` ((n − 1) × n) at the point of `at` to `second`; `None` where the system leaves it to differences of J.
    fn second(&self, at: &Linearization, v: &Vector, second: MatrixMut<'_>) -> Option<()> {
        let _ = (at, v, second);
        None
    }
}
