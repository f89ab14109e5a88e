//! What is known of values before a fit: a term of χ² for each.
//!
//! ```text
//! χ² = Σ r_i² + Σ ((u_j − m_j)/σ_j)²
//! ```
//!
//! A value that is given with an error is no longer held: it is free, and the points may move it. Its error then enters
//! those of all others.

use super::least_squares::{Evaluated, LeastSquares, MinimizationSettings, Minimum, minimize_from};
use super::problem::FitProblem;
use crate::progress::Progress;
use nalgebra::{DMatrix, DVector};

impl FitProblem {
    /// The derivatives of the terms with respect to u, a row for each.
    pub(super) fn of_priors(&self) -> DMatrix<f64> {
        let mut rows = DMatrix::zeros(self.priors.len(), self.parameters.len());
        for (i, prior) in self.priors.iter().enumerate() {
            rows[(i, prior.parameter)] = 1.0 / prior.sigma;
        }
        rows
    }

    /// Minimizes with the terms of what is known; the result has the residuals of the points alone.
    pub(super) fn minimize(
        &self,
        u: &[f64],
        settings: &MinimizationSettings,
        progress: &dyn Progress,
    ) -> Option<Minimum> {
        self.minimize_from(u, self.evaluate(u)?, settings, progress)
    }

    /// The same where the residuals and derivatives of the points at `u`, `at`, are known.
    pub(super) fn minimize_from(
        &self,
        u: &[f64],
        at: Evaluated,
        settings: &MinimizationSettings,
        progress: &dyn Progress,
    ) -> Option<Minimum> {
        if self.priors.is_empty() {
            return minimize_from(self, u, at, settings, progress);
        }
        let counts = self.counts.as_ref().map(|counts| {
            let once = std::iter::repeat_n(1.0, self.priors.len());
            counts.iter().copied().chain(once).collect()
        });
        let known = InformedProblem { problem: self, counts };
        let residuals = known.with_terms(&at.residuals, u);
        let at = Evaluated { residuals, jacobian: known.below(&at.jacobian) };
        let mut found = minimize_from(&known, u, at, settings, progress)?;
        let rows = found.at.residuals.len() - self.priors.len();
        found.at.residuals = found.at.residuals.rows(0, rows).into_owned();
        found.at.jacobian = found.at.jacobian.rows(0, rows).into_owned();
        Some(found)
    }
}

/// A problem with the terms of what is known after its residuals.
struct InformedProblem<'a> {
    problem: &'a FitProblem,
    counts: Option<Vec<f64>>,
}

impl InformedProblem<'_> {
    fn with_terms(&self, residuals: &DVector<f64>, u: &[f64]) -> DVector<f64> {
        let terms = self.problem.priors.iter().map(|prior| (u[prior.parameter] - prior.mean) / prior.sigma);
        let all: Vec<f64> = residuals.iter().copied().chain(terms).collect();
        DVector::from_vec(all)
    }
}

impl InformedProblem<'_> {
    /// The derivatives of the points, with those of the terms below them.
    fn below(&self, jacobian: &DMatrix<f64>) -> DMatrix<f64> {
        let (rows, columns) = jacobian.shape();
        let of_priors = self.problem.of_priors();
        let mut whole = jacobian.clone().resize_vertically(rows + of_priors.nrows(), 0.0);
        whole.view_mut((rows, 0), (of_priors.nrows(), columns)).copy_from(&of_priors);
        whole
    }
}

impl LeastSquares for InformedProblem<'_> {
    type Look = <FitProblem as LeastSquares>::Look;

    fn look(&self, u: &[f64]) -> Option<(DVector<f64>, Self::Look)> {
        let (residuals, look) = self.problem.look(u)?;
        Some((self.with_terms(&residuals, u), look))
    }

    fn derivatives(&self, u: &[f64], look: &Self::Look) -> Option<DMatrix<f64>> {
        Some(self.below(&self.problem.derivatives(u, look)?))
    }

    fn counts(&self) -> Option<&[f64]> {
        self.counts.as_deref()
    }
}
