//! How the noise of a residual varies with the slope of the curve: that of x matters where the curve is steep, that of
//! P where it is level.
//!
//! ```text
//! var r_i = (1 − h_i) (a n_x² + b n_P²),     n the normal of the curve in σ,     (a, b) by the largest likelihood
//! h_i = J_i (JᵀJ + K)⁻¹ J_iᵀ                 what the fit takes of a row
//! ```
//!
//! Where few rows decide a value the fit takes up most of them: J. G. `MacKinnon` and H. White, J. Econometrics 29, 305
//! (1985). a and b are 1 where σ of x and of P are what they are said to be. The smallest σ of x is not noise: a is 0
//! there, and the residuals of a steep curve are smaller than those of rows apart.

use super::distance::Nearest;
use super::problem::{Datum, FitProblem};
use super::scatter::{CLIPPED, LEFT, ScatterRow, variance};
use super::solve::{LEAST_SCALE, SolvedFit};
use crate::measured::branches::median;
use nalgebra::DVector;

/// A fit leaves at least this share of the variance of a row: less would say nothing about it.
pub(super) const LEAST_LEFT: f64 = 0.1;
/// Fewer rows say nothing about two variances.
const FEWEST: usize = 20;

/// The shares of x and of P in the variance of a residual: `n_x²` and `n_P²` of its foot, in the noise of the row; for a
/// row apart, whose residual is that of P, 0 and 1.
fn normal(foot: Option<&Nearest>, datum: &Datum) -> [f64; 2] {
    foot.map_or([0.0, 1.0], |foot| {
        let [x, p] = [0, 1].map(|k| foot.normals[0][k].powi(2));
        let whole = datum.noise[0].powi(2);
        [x / whole, p + x - x / whole]
    })
}

/// How the noise of the residuals is spread over the rows.
pub(super) struct Spread {
    /// The standard deviation of each residual in σ.
    pub of_rows: DVector<f64>,
    /// `n_x²` and `n_P²` of each, where the residuals tell the variances of x and of P.
    pub components: Option<Vec<[f64; 2]>>,
}

impl FitProblem {
    /// `n_x²` and `n_P²` of the rows.
    fn normals(&self, solved: &SolvedFit) -> Option<Vec<[f64; 2]>> {
        let u = &solved.minimum.parameters;
        let feet = self.feet(&self.paths(u)?, &self.instrument_at(u))?;
        Some(feet.iter().zip(&self.data).map(|(foot, datum)| normal(foot.as_ref(), datum)).collect())
    }

    /// By how much σ of x and of P are off where neither was known, (√a, √b) from second differences of the rows in
    /// contact. `None` where there are too few rows.
    pub(super) fn off(&self, solved: &SolvedFit) -> Option<[f64; 2]> {
        let normals = self.normals(solved)?;
        let normal = |row: &ScatterRow| normals[row.index];
        let mut rows: Vec<([f64; 2], f64)> = Vec::new();
        for branch in 0..self.branches() {
            for three in self.rows(solved, branch, false, 0).windows(3) {
                let [a, b, c] = [0, 1, 2].map(|i| normal(&three[i]));
                let d = three[0].residual - 2.0 * three[1].residual + three[2].residual;
                rows.push(([0, 1].map(|k| (a[k] + 4.0 * b[k] + c[k]) / 6.0), d * d / 6.0));
            }
        }
        components(&rows).map(|found| found.map(f64::sqrt))
    }

    /// The spread of the residuals, of which the fit has taken up the shares `leverage`: the same for all rows where
    /// there are too few, or where each has two residuals.
    pub(super) fn spread(&self, solved: &SolvedFit, leverage: &DVector<f64>) -> Spread {
        let residuals = &solved.minimum.at.residuals;
        let whole = residuals.zip_map(leverage, |r, h| r / (1.0 - h).max(LEAST_LEFT).sqrt());
        let of = || {
            let normals = self.normals(solved).filter(|_| self.per_point() == 1)?;
            let rows: Vec<([f64; 2], f64)> =
                normals.iter().zip(&whole).map(|(normal, r)| (*normal, r * r)).collect();
            let [of_x, of_p] = components(&rows)?;
            let variances = normals.iter().map(|normal| of_x * normal[0] + of_p * normal[1]);
            let spread = DVector::from_iterator(residuals.len(), variances.map(f64::sqrt));
            let is_known = spread.iter().all(|s| *s > LEAST_SCALE);
            is_known.then_some(Spread { of_rows: spread, components: Some(normals) })
        };
        of().unwrap_or_else(|| {
            let of_all = variance(&self.real(&whole)).unwrap_or(1.0).sqrt().max(LEAST_SCALE);
            Spread { of_rows: DVector::repeat(residuals.len(), of_all), components: None }
        })
    }
}

/// a and b from squares, each beside `n_x²` and `n_P²` of its row. `None` where there are too few rows.
fn components(rows: &[([f64; 2], f64)]) -> Option<[f64; 2]> {
    const TIMES: usize = 50;
    const SAME: f64 = 1e-4;
    if rows.len() < FEWEST {
        return None;
    }
    let middle = median(rows.iter().map(|(_, square)| square.sqrt()).collect())? / 0.6745;
    let mut found = [middle * middle; 2];
    for _ in 0..TIMES {
        // Normal equations of the squares, weighted by what they vary by.
        let [mut xx, mut xp, mut pp, mut x, mut p] = [0.0; 5];
        for ([of_x, of_p], square) in rows {
            let variance = found[0] * of_x + found[1] * of_p;
            let square = square.min(CLIPPED * CLIPPED * variance) / LEFT;
            let weight = 1.0 / (variance * variance);
            xx += weight * of_x * of_x;
            xp += weight * of_x * of_p;
            pp += weight * of_p * of_p;
            x += weight * of_x * square;
            p += weight * of_p * square;
        }
        let whole = xx * pp - xp * xp;
        let both = [(x * pp - p * xp) / whole, (p * xx - x * xp) / whole];
        // Neither is below 0: the other then has it all.
        let next = if both[0] <= 0.0 {
            [0.0, p / pp]
        } else if both[1] <= 0.0 {
            [x / xx, 0.0]
        } else {
            both
        };
        if next.iter().any(|next| !next.is_finite()) {
            return None;
        }
        let is_same = (0..2).all(|k| (next[k] - found[k]).abs() <= SAME * found[k]);
        found = next;
        if is_same {
            break;
        }
    }
    Some(found)
}
