//! What is known of values before a fit: a term of χ² for each.
//!
//! ```text
//! χ² = Σ r_i² + Σ ((u_j − m_j)/σ_j)²
//! ```
//!
//! A value that is given with an error is no longer held: it is free, and the points may move it. Its error then enters
//! those of all others. While least squares run, the terms stand after the residuals of the points.

use nalgebra::{DMatrix, DVector};

/// What is known of one parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// Its number.
    pub parameter: usize,
    /// Its u.
    pub mean: f64,
    /// The standard deviation of u.
    pub sigma: f64,
}

/// The residuals of the points at `u`, with the terms of `priors` after them.
pub(super) fn with_terms(residuals: DVector<f64>, priors: &[Prior], u: &[f64]) -> DVector<f64> {
    let rows = residuals.len();
    let mut all = residuals.resize_vertically(rows + priors.len(), 0.0);
    for (i, prior) in priors.iter().enumerate() {
        all[rows + i] = (u[prior.parameter] - prior.mean) / prior.sigma;
    }
    all
}

/// The derivatives of the points, with those of the terms of `priors` below them, times `weight`.
pub(super) fn with_derivatives(jacobian: DMatrix<f64>, priors: &[Prior], weight: f64) -> DMatrix<f64> {
    let rows = jacobian.nrows();
    let mut all = jacobian.resize_vertically(rows + priors.len(), 0.0);
    for (i, prior) in priors.iter().enumerate() {
        all[(rows + i, prior.parameter)] = 1.0 / prior.sigma * weight;
    }
    all
}
