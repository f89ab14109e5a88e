//! How well each error is known: the degrees of freedom of the variance of each value, which its Student's t interval
//! needs.
//!
//! ```text
//! V_j = Σ_i w_ij² (a n_xi² + b n_Pi²) + what is known before,     w = H⁻¹Jᵀ,  a and b of `spread`
//! ν_j = 2 V_j²/var V_j,     var V_j = V'² (uᵀ C u τ₂ + (∂ ln V'/∂ρ)² var ρ),    u_k = ∂ ln V'/∂v_k,  V' the part that the points give
//! C = 2e n/(n − p) (Σ_i n_ik² n_il²/var_i²)⁻¹,     τ₂ = 1 + 2a²ρ²/(1 − ρ²)
//! ```
//!
//! ν is twice the square of a variance over the variance with which it is known: F. E. Satterthwaite, Biom. Bull. 2,
//! 110 (1946); B. L. Welch, Biometrika 34, 28 (1947). C is the inverse of Fisher's information of the two variances in
//! normal residuals; where all rows have one variance this is ν = (n − p)/e. e is 1 for squares. For squares that count
//! up to c = 2.5 deviations it is ½ var min(z², c²)/(mean of z² up to c)² = ½ · 1.6815/0.8999² = 1.04. Where noise is
//! correlated as a ρᵏ, its squares are correlated as the square of that. ρ itself is known to var ρ = (1 − ρ²)/m from
//! the m rows apart: M. S. Bartlett, J. R. Stat. Soc. Suppl. 8, 27 (1946).

use super::problem::FitProblem;
use super::scatter::{Correlation, Scatter, together};
use super::spread::Spread;
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

/// The factor by which squares that count up to 2.5 deviations reduce the degrees of freedom.
pub(super) const LOST: f64 = 1.04;
/// The change of ρ by which a derivative is taken is at most this share of 1 − ρ.
const SHARE: f64 = 0.3;

/// What the variances of the values come from.
pub(super) struct VarianceSources<'a> {
    /// H⁻¹.
    pub bread: &'a DMatrix<f64>,
    /// The Jacobian, each row times the root of its variance.
    pub noisy: &'a DMatrix<f64>,
    /// The Jacobian.
    pub jacobian: &'a DMatrix<f64>,
    /// The part of the variances that the points give, and all of them.
    pub points: &'a DVector<f64>,
    pub whole: &'a DVector<f64>,
    /// The number of rows.
    pub rows: usize,
}

/// With this many degrees of freedom Student's t is the normal distribution to eight digits: a value that is known
/// beforehand has more.
const NORMAL: f64 = 1e8;

/// The degrees of freedom of the variance of each value.
pub(super) fn degrees(
    problem: &FitProblem,
    made: &VarianceSources,
    spread: &Spread,
    scatter: &Scatter,
    robust: bool,
) -> DVector<f64> {
    let p = made.whole.len();
    let lost = if robust { LOST } else { 1.0 };
    let n = made.rows as f64;
    let left = (n - problem.taken() as f64).max(1.0);
    let correlation = &scatter.correlation;
    let of_squares = {
        let square = correlation.share * correlation.share * correlation.decay * correlation.decay;
        1.0 + 2.0 * square / (1.0 - correlation.decay * correlation.decay)
    };
    let weights = made.jacobian * made.bread;
    let components = spread.components.as_ref().and_then(|normals| {
        let mut information = Matrix2::zeros();
        for (normal, s) in normals.iter().zip(&spread.of_rows) {
            let of = Vector2::from(*normal) / (s * s);
            information += of * of.transpose();
        }
        information.try_inverse().map(|inverse| (normals, inverse * (2.0 * lost * n / left)))
    });
    let slopes = of_decay(problem, made, scatter);
    let of_value = |j: usize| {
        let of_level = match &components {
            None => 2.0 * lost / left,
            Some((normals, covariance)) => {
                let mut slope = Vector2::zeros();
                let mut whole = 0.0;
                for ((normal, s), w) in normals.iter().zip(&spread.of_rows).zip(weights.column(j).iter()) {
                    slope += Vector2::from(*normal) * (w * w);
                    whole += w * w * s * s;
                }
                let slope = slope / whole;
                (slope.transpose() * covariance * slope)[(0, 0)]
            }
        };
        let of_points = of_level * of_squares + slopes[j];
        let share = made.points[j] / made.whole[j];
        (2.0 / (share * share * of_points)).clamp(1.0, NORMAL)
    };
    DVector::from_iterator(p, (0..p).map(of_value))
}

/// (∂ ln V'/∂ρ)² var ρ of each value; zero for white noise.
fn of_decay(problem: &FitProblem, made: &VarianceSources, scatter: &Scatter) -> DVector<f64> {
    let none = DVector::zeros(made.whole.len());
    let Correlation { share, decay } = scatter.correlation;
    if share <= 0.0 || scatter.apart == 0 {
        return none;
    }
    let variance = (1.0 - decay * decay) / scatter.apart as f64;
    let step = variance.sqrt().min(SHARE * (1.0 - decay)).min(SHARE * decay);
    let at = |decay: f64| {
        let points = together(problem, made.noisy, &Correlation { share, decay });
        (made.bread * points * made.bread).diagonal()
    };
    let (above, below) = (at(decay + step), at(decay - step));
    let slope = |(above, below): (&f64, &f64)| {
        let slope = (above - below) / (0.5 * (above + below)) / (2.0 * step);
        slope * slope * variance
    };
    DVector::from_iterator(none.len(), above.iter().zip(below.iter()).map(slope))
}
