//! Tangent, curvature and orientation of the curve at a solution.
//!
//! ```text
//! tangent    J t = 0,              |t| = 1
//! curvature  J k = −J_t t,         t·k = 0        (k = dt/dℓ, ℓ the arc length)
//! ```
//!
//! The sign of det(J; tᵀ) is constant along a regular branch and comes free with the factorization: a flip shows that a
//! step has passed a hairpin or jumped to another piece, which a dot product cannot show.

use super::closed::Closed;
use super::second::Second;
use super::system::{ColumnView, Columns, Linearization, System, Vector};

/// Room for the algebra at one point of a system.
#[derive(Debug, Clone)]
pub struct Algebra {
    /// The equations closed by a row.
    pub closed: Closed,
    /// Their second derivatives along a direction.
    pub second: Second,
    /// A right-hand side, n numbers.
    pub right: Vector,
    tangent: Vector,
    curvature: Vector,
}

impl Algebra {
    /// Room for a system with this many unknowns.
    pub fn new(unknowns: usize) -> Self {
        Self {
            closed: Closed::new(unknowns),
            second: Second::new(unknowns),
            right: Vector::zeros(unknowns),
            tangent: Vector::zeros(unknowns),
            curvature: Vector::zeros(unknowns),
        }
    }

    /// The solution `y`, linearized there, with its tangent and curvature (n × 3), and whether det(J; tᵀ) is positive.
    /// The tangent is turned so that its product with `forward` is positive.
    ///
    /// `None` when the Jacobian is singular there (a branch point) or orthogonal to `forward`.
    pub fn frame(
        &mut self,
        system: &dyn System,
        y: &Vector,
        at: &Linearization,
        forward: ColumnView<'_>,
        evaluations: &mut usize,
    ) -> Option<(Columns, bool)> {
        let Self { closed, second, right, tangent, curvature } = self;
        closed.factor(&at.jacobian, forward)?;
        closed.null_vector(right, tangent);
        tangent.normalize_mut();
        closed.factor(&at.jacobian, tangent.column(0))?;
        second.find(system, y, at, tangent, evaluations)?;
        right.fill(0.0);
        let columns = second.along.as_slice().chunks_exact(y.len() - 1);
        for (column, t) in columns.zip(tangent.as_slice()) {
            for (right, x) in right.as_mut_slice().iter_mut().zip(column) {
                *right -= x * t;
            }
        }
        closed.solve(right, curvature);
        let parts = [y.as_slice(), tangent.as_slice(), curvature.as_slice()];
        let columns = Columns::from_iterator(y.len(), parts.into_iter().flatten().copied());
        let finite = columns.as_slice().iter().all(|x| x.is_finite());
        finite.then_some((columns, closed.determinant > 0.0))
    }
}
