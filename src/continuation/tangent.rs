//! Tangent, curvature and orientation of the curve at a solution.
//!
//! ```text
//! tangent    J t = 0,              |t| = 1
//! curvature  J k = −g_yy[t, t],    t·k = 0        (k = dt/dℓ, ℓ the arc length)
//! ```
//!
//! The sign of det(J; tᵀ) is constant along a regular branch and is free from the factorization: a flip
//! tells that a step has passed a hairpin or jumped to another piece, which a dot product cannot.

use super::system::{Linearization, Vector};

/// The local frame of the curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// t, n + 1 numbers of unit length.
    pub tangent: Vector,
    /// k = dt/dℓ, n + 1 numbers.
    pub curvature: Vector,
    /// Whether det(J; tᵀ) is positive.
    pub positive: bool,
}

/// The frame at a solution; the tangent is turned so that its product with `forward` is positive.
///
/// `None` when the Jacobian is singular there (a branch point) or orthogonal to `forward`.
pub fn frame(lin: &Linearization, forward: &Vector) -> Option<Frame> {
    let n = lin.jacobian.nrows();
    let mut unit = Vector::zeros(n + 1);
    unit[n] = 1.0;
    let raw = lin.bordered(forward).lu().solve(&unit)?;
    let tangent = raw.clone() / raw.norm();
    let lu = lin.bordered(&tangent).lu();
    let bend = lin.along(&tangent, &tangent);
    let mut right = Vector::zeros(n + 1);
    right.rows_mut(0, n).copy_from(&-bend);
    let curvature = lu.solve(&right)?;
    let determinant = lu.determinant();
    let finite = tangent.iter().chain(curvature.iter()).all(|x| x.is_finite());
    (finite && determinant != 0.0).then_some(Frame { tangent, curvature, positive: determinant > 0.0 })
}
