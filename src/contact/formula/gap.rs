//! A formula as the gap of a problem.

use super::bound::Bound;
use super::survey::NotFinite;
use crate::contact::{Gap, Jet};

/// A formula with its parameters, known to be finite up to a radius.
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaGap {
    bound: Bound,
    largest: f64,
    feature_length: Option<f64>,
}

impl Bound {
    /// The formula as a gap on 0 ≤ r ≤ `largest`, which must be positive and hold every radius of contact.
    ///
    /// # Errors
    /// Where h, h' or h'' is not finite.
    pub fn over(self, largest: f64) -> Result<FormulaGap, NotFinite> {
        self.check(largest)?;
        Ok(FormulaGap { feature_length: self.feature_length(largest), bound: self, largest })
    }
}

impl FormulaGap {
    /// The formula with its parameters.
    pub fn bound(&self) -> &Bound {
        &self.bound
    }
}

impl Gap for FormulaGap {
    fn jet(&self, r: f64) -> Jet {
        self.bound.jet(r)
    }

    fn feature_length(&self) -> Option<f64> {
        self.feature_length
    }

    /// The largest radius: a formula need not have a radius of curvature.
    fn reference_length(&self) -> f64 {
        self.largest
    }
}
