//! Tangent, curvature and orientation of the curve at a solution.
//!
//! ```text
//! tangent    J t = 0,              |t| = 1
//! curvature  J k = −g_yy[t, t],    t·k = 0        (k = dt/dℓ, ℓ the arc length)
//! ```
//!
//! The sign of det(J; tᵀ) is constant along a regular branch and is free from the factorization: a flip
//! tells that a step has passed a hairpin or jumped to another piece, which a dot product cannot.

use super::closed::Closed;
use super::system::{Linearization, Vector};

/// The local frame of the curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame<const N: usize> {
    /// t, of unit length.
    pub tangent: Vector<N>,
    /// k = dt/dℓ.
    pub curvature: Vector<N>,
    /// Whether det(J; tᵀ) is positive.
    pub positive: bool,
}

/// The frame at a solution; the tangent is turned so that its product with `forward` is positive.
///
/// `None` when the Jacobian is singular there (a branch point) or orthogonal to `forward`.
pub fn frame<const N: usize>(lin: &Linearization<N>, forward: &Vector<N>) -> Option<Frame<N>> {
    let tangent = Closed::new(&lin.jacobian, forward)?.null_vector().normalize();
    let closed = Closed::new(&lin.jacobian, &tangent)?;
    let curvature = closed.solve(&-lin.along(&tangent, &tangent));
    let finite = tangent.iter().chain(curvature.iter()).all(|x| x.is_finite());
    finite.then_some(Frame { tangent, curvature, positive: closed.determinant > 0.0 })
}
