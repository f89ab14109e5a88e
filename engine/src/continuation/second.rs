//! Second derivatives along a direction: from the system, or by differences of its Jacobian.
//!
//! ```text
//! J_v = (J(y + ηv) − J(y − ηv)) / 2η + O(η²),     η|v| = ε^⅓ max(1, max|y|)
//! ```
//!
//! This gives about ten digits. Next to the border of the region in which the equations are defined, one of the two
//! sides is y itself.

use super::system::{Linearization, Matrix, System, Vector};
use crate::elementary::cbrt;

/// Room for `J_v`.
#[derive(Debug, Clone)]
pub struct Second {
    /// `J_v`, (n − 1) × n.
    pub along: Matrix,
    y: Vector,
    at: Linearization,
}

impl Second {
    /// Room for a system with this many unknowns.
    pub fn new(unknowns: usize) -> Self {
        let at = Linearization::new(unknowns);
        Self { along: at.jacobian.clone(), y: Vector::zeros(unknowns), at }
    }

    /// Finds `J_v` at `y`, linearized there, and counts the evaluations that this takes; `None` where the equations are
    /// defined on neither side of `y`.
    pub fn find(
        &mut self,
        system: &dyn System,
        y: &Vector,
        at: &Linearization,
        v: &Vector,
        evaluations: &mut usize,
    ) -> Option<()> {
        if system.second(at, v, self.along.as_view_mut()).is_some() {
            return Some(());
        }
        let step = cbrt(f64::EPSILON) * y.amax().max(1.0) / v.norm();
        let mut distance = 0.0;
        self.along.fill(0.0);
        for side in [1.0, -1.0] {
            self.y.copy_from(y);
            self.y.axpy(side * step, v, 1.0);
            *evaluations += 1;
            let defined = system.linearize(&self.y, &mut self.at).is_some()
                && self.at.has_sizes_of(y.len()).is_ok()
                && self.at.is_finite();
            distance += if defined { step } else { 0.0 };
            let jacobian = if defined { &self.at.jacobian } else { &at.jacobian };
            self.along.zip_apply(jacobian, |sum, j| *sum += side * j);
        }
        self.along /= distance;
        (distance > 0.0).then_some(())
    }
}
