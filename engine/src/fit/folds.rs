//! What a row beside a fold of the curve tells: that the fold lies between this row and one of its neighbours, and no more.
//!
//! ```text
//! ∂r/∂u = −(f n_x ∂x/∂u + n_P ∂P/∂u),     f = 1/√(1 + Δ²/(3 σ_x²)),     Δ the distance to the further neighbour
//! ```
//!
//! Where the curve turns within the noise of the force, a row beyond the fold lies at its distance in x from it, and one
//! within lies on the curve. So one row holds the fold as if it were known to `σ_x`, while the fold may be anywhere as far as
//! the neighbour, with a variance of Δ²/3 about that row. Only the covariance takes this into account: the values stay, and so
//! does what is said for or against the fit.

use super::derivatives::FootedPaths;
use super::distance::Nearest;
use super::least_squares::LeastSquares;
use super::problem::FitProblem;
use super::solve::SolvedFit;
use crate::measured::Segment;

/// The curve turns within the noise where its normals at one σ of the force apart make a larger angle, by its cosine.
const TURNED: f64 = std::f64::consts::FRAC_1_SQRT_2;

impl FitProblem {
    /// The end of a fit with derivatives that tell of each fold what the rows beside it do; `None` where no row lies beside
    /// one, or where radii tell the branches apart.
    pub(super) fn beside_folds(&self, solved: &SolvedFit) -> Option<SolvedFit> {
        if self.space {
            return None;
        }
        let u = &solved.minimum.parameters;
        let (_, mut look) = self.look(u)?;
        let shares = self.shares_of_x(&look, solved.scale.min(1.0));
        if shares.iter().all(|share| *share >= 1.0) {
            return None;
        }
        for (foot, share) in look.feet.iter_mut().zip(shares) {
            if let Some(foot) = foot {
                foot.normals[0][0] *= share;
            }
        }
        let jacobian = self.derivatives(u, &look)?;
        let mut beside = solved.clone();
        beside.minimum.at.jacobian = jacobian;
        Some(beside)
    }

    /// f of each row; 1 away from folds.
    fn shares_of_x(&self, look: &FootedPaths, noise: f64) -> Vec<f64> {
        let weights = self.weights();
        let scaled = look.paths.scaled(weights);
        let mut boxes = [0; 2];
        let mut turns = |foot: &Nearest, of: usize| {
            let beside = |by: f64| [foot.at[0] * weights[0], foot.at[1] * weights[1] + by, 0.0];
            [-noise, noise].into_iter().any(|by| {
                let other = scaled[of].nearest(beside(by), &mut boxes[of]);
                let [a, b] = [foot.normals[0], other.map_or(foot.normals[0], |other| other.normals[0])];
                (a[0] * b[0] + a[1] * b[1]).abs() < TURNED
            })
        };
        let share = |(i, foot): (usize, &Option<Nearest>)| match foot {
            Some(foot) if turns(foot, usize::from(self.data[i].segment == Segment::Retraction)) => {
                let way = self.way_to_neighbour(i) * weights[0];
                1.0 / (1.0 + way * way / 3.0).sqrt()
            }
            _ => 1.0,
        };
        look.feet.iter().enumerate().map(share).collect()
    }

    /// The distance in x from a row to that of its two neighbours on its branch that is further off; infinite where one
    /// is missing.
    fn way_to_neighbour(&self, i: usize) -> f64 {
        let datum = &self.data[i];
        let to = |j: Option<usize>| {
            let other = j.and_then(|j| self.data.get(j)).filter(|other| other.branch == datum.branch);
            other.map_or(f64::INFINITY, |other| (other.point.x - datum.point.x).abs())
        };
        to(i.checked_sub(1)).max(to(i.checked_add(1)))
    }
}
