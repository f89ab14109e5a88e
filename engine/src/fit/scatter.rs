//! The noise of the rows as neighbours show it; it says nothing about the model and so can judge it.
//!
//! ```text
//! d_i = (r_{i−1} − 2 r_i + r_{i+1})/√6         of the residuals of one branch in contact, along the path; s² their robust variance
//! a ρ^k                                         the correlation of the noise of two rows that are k rows apart, k ≥ 1
//! τ = 1 + 2 a ρ/(1 − ρ)                         how many rows count as one: the variance of a mean is s² τ/n
//! ```
//!
//! Second differences leave out what varies slowly along the path: s is the noise of the rows whatever the model is.
//! Noise that is correlated from row to row varies slowly too. How much it does so is known only from the rows apart,
//! where the model is a constant: in contact this noise cannot be told from what a wrong model leaves.
//! J. von Neumann, Ann. Math. Stat. 12, 367 (1941), does the same with first differences.

use super::problem::{Datum, FitProblem};
use super::solve::SolvedFit;
use crate::elementary::{exp, ln};
use crate::measured::Segment;
use crate::measured::branches::median;
pub(super) use crate::measured::noise::{CLIPPED, LEFT, variance};
use nalgebra::{DMatrix, DVector};

/// Rows farther off than this many times the scale of all are outliers, and left out.
const OUTLIER: f64 = 4.0;
/// Fewer rows on a branch say nothing about neighbours.
const FEWEST: usize = 5;
/// The fewest rows apart in which a correlation is sought.
pub(super) const FEWEST_APART: usize = 20;
/// One in this many rows apart belongs to the farthest, in which a correlation must be seen too.
const OUTER: usize = 2;
/// Rows apart that scatter by less than this share of σ are rounding, in which there is always some order.
const ROUNDING: f64 = 0.1;
/// A correlation of neighbours beyond this many times 1/√n counts: one in six series of white noise has such a one, which makes its
/// errors somewhat larger, and a correlation that is not seen makes them too small.
const CORRELATED: f64 = 1.0;

/// One row, with its residual in σ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScatterRow {
    /// Its place among the data.
    pub index: usize,
    /// Its residual.
    pub residual: f64,
}

/// How the noise of neighbours is correlated.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Correlation {
    /// a.
    pub share: f64,
    /// ρ.
    pub decay: f64,
}

impl Correlation {
    /// The correlation of rows that are `k` rows apart.
    pub fn at(&self, k: f64) -> f64 {
        if self.share > 0.0 { self.share * exp(k * ln(self.decay)) } else { 0.0 }
    }

    /// τ.
    pub fn rows(&self) -> f64 {
        1.0 + 2.0 * self.share * self.decay / (1.0 - self.decay)
    }

    /// The variance of the mean of `n` rows, in units of that of one.
    pub fn of_mean(&self, n: usize) -> f64 {
        let count = n as f64;
        if self.share <= 0.0 {
            return 1.0 / count;
        }
        let sum: f64 = (1..n).map(|k| (1.0 - k as f64 / count) * self.at(k as f64)).sum();
        (1.0 + 2.0 * sum) / count
    }

    /// By how much the variance of second differences is off, as a share, where the decay is found from this many rows:
    /// var ρ = (1 − ρ²)/n; M. S. Bartlett, J. R. Stat. Soc. Suppl. 8, 27 (1946). Returns the variance of that share.
    fn of_few(&self, rows: usize) -> f64 {
        if self.share <= 0.0 {
            return 0.0;
        }
        let slope = self.share * (8.0 - 4.0 * self.decay) / 6.0;
        slope * slope * (1.0 - self.decay * self.decay) / rows as f64 / self.of_differences().powi(2)
    }

    /// The variance of second differences, in units of that of white noise.
    pub(super) fn of_differences(&self) -> f64 {
        1.0 - (8.0 * self.at(1.0) - 2.0 * self.at(2.0)) / 6.0
    }
}

/// The noise of the rows, in σ of the problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Scatter {
    /// s of the rows in contact; `None` where they are too few.
    pub contact: Option<f64>,
    /// The degrees of freedom of s².
    pub degrees: f64,
    /// The part of the variance of s², as a share of its square, that comes from the correlation: this is known from
    /// the rows apart alone.
    pub of_correlation: f64,
    /// The scale of the residuals of the same rows, which includes what the model leaves.
    pub residuals: f64,
    /// Their number.
    pub rows: usize,
    /// How neighbours are correlated.
    pub correlation: Correlation,
    /// The rows apart in which the correlation was sought.
    pub apart: usize,
}

/// The size beyond which a residual among these is an outlier.
pub(super) fn outlier(rows: &[ScatterRow]) -> f64 {
    let sizes = rows.iter().map(|row| row.residual.abs()).collect();
    OUTLIER * 1.4826 * median(sizes).unwrap_or(0.0)
}

impl FitProblem {
    /// The residuals of one branch, in contact along the path or apart in the order of measurement, without outliers.
    /// Rows in contact that go one way in that order are kept in it: sorted by an x with noise, or by their forces where x
    /// rests, neighbours would have what is in their residuals.
    pub(super) fn rows(&self, solved: &SolvedFit, branch: usize, free: bool, part: usize) -> Vec<ScatterRow> {
        let mut rows = self.in_order(solved, branch, free, part);
        let limit = outlier(&rows);
        rows.retain(|row| row.residual.abs() <= limit);
        rows
    }

    /// The same with outliers.
    pub(super) fn in_order(
        &self,
        solved: &SolvedFit,
        branch: usize,
        free: bool,
        part: usize,
    ) -> Vec<ScatterRow> {
        let per = self.per_point();
        let residuals = &solved.minimum.at.residuals;
        let is_wanted = |datum: &Datum| datum.branch == branch && datum.free == free;
        let of = self.data.iter().enumerate().filter(|(_, datum)| is_wanted(datum));
        let mut rows: Vec<ScatterRow> =
            of.map(|(index, _)| ScatterRow { index, residual: residuals[per * index + part] }).collect();
        let by_file = |row: &ScatterRow| self.data[row.index].point.at;
        if free {
            rows.sort_by_key(by_file);
        } else {
            let mut in_file = rows.clone();
            in_file.sort_by_key(by_file);
            let x = |row: &ScatterRow| self.data[row.index].point.x;
            if goes_on(&in_file.iter().map(x).collect::<Vec<_>>()) {
                let falls = |rows: &[ScatterRow]| rows.first().map(x) > rows.last().map(x);
                if falls(&in_file) != falls(&rows) {
                    in_file.reverse();
                }
                rows = in_file;
            }
        }
        rows
    }

    /// The residuals of the rows apart of one branch, the farthest from the contact first.
    fn apart(&self, solved: &SolvedFit, branch: usize) -> Vec<f64> {
        let rows = self.rows(solved, branch, true, 0);
        let leaves = rows.first().is_some_and(|row| self.data[row.index].segment == Segment::Retraction);
        let residuals = rows.iter().map(|row| row.residual);
        if leaves { residuals.rev().collect() } else { residuals.collect() }
    }

    /// How many branches there are.
    pub(super) fn branches(&self) -> usize {
        self.data.iter().map(|datum| datum.branch + 1).max().unwrap_or(0)
    }

    /// The noise of the rows, by the residuals of `solved`.
    pub(super) fn scatter(&self, solved: &SolvedFit) -> Scatter {
        let apart: Vec<Vec<f64>> = (0..self.branches()).map(|branch| self.apart(solved, branch)).collect();
        let of = |parts: usize| {
            let outer = |rows: &Vec<f64>| detrended(&rows[..rows.len().div_ceil(parts)]);
            apart.iter().map(outer).filter(|rows| rows.len() >= FEWEST).collect::<Vec<_>>()
        };
        let (apart, outer) = (of(1), of(OUTER));
        // Noise is correlated everywhere. What only the rows near the contact have in common is the contact, which
        // begins before it is seen.
        let is_told = outer.iter().map(Vec::len).sum::<usize>() >= FEWEST_APART;
        let is_noise = !is_told || correlation(&outer).share > 0.0;
        let correlation = if is_noise { correlation(&apart) } else { Correlation::default() };
        let (mut differences, mut residuals, mut degrees) = (Vec::new(), Vec::new(), 0.0);
        for branch in 0..self.branches() {
            for part in 0..self.per_point() {
                let rows = self.rows(solved, branch, false, part);
                if rows.len() < FEWEST {
                    continue;
                }
                differences.extend(rows.windows(3).map(|three| {
                    (three[0].residual - 2.0 * three[1].residual + three[2].residual) / 6.0_f64.sqrt()
                }));
                residuals.extend(rows.iter().map(|row| row.residual));
                degrees += 0.5 * rows.len() as f64 - 1.0;
            }
        }
        let contact = variance(&differences).map(|found| (found / correlation.of_differences()).sqrt());
        let rows_apart = apart.iter().map(Vec::len).sum();
        let of_correlation = correlation.of_few(rows_apart);
        // For two independent variances; F. E. Satterthwaite, Biom. Bull. 2, 110 (1946).
        let degrees = 1.0 / (correlation.rows() / degrees.max(1.0) + 0.5 * of_correlation);
        Scatter {
            contact: contact.filter(|s| *s > 0.0),
            degrees: degrees.max(1.0),
            of_correlation,
            residuals: variance(&residuals).unwrap_or(0.0).sqrt(),
            rows: residuals.len(),
            correlation,
            apart: rows_apart,
        }
    }
}

/// Whether values go on from row to row, except for some noise: by the squares of their steps over those around their
/// mean, 2 for values without an order; J. von Neumann, Ann. Math. Stat. 12, 367 (1941).
fn goes_on(values: &[f64]) -> bool {
    const MOST: f64 = 0.5;
    steps_over_squares(values) < MOST
}

/// The sum of the squared steps from value to value over that of the squared distances from their mean.
pub(super) fn steps_over_squares(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let around: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
    values.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum::<f64>() / around
}

/// The values without their mean and without their slope over the order.
pub(super) fn detrended(values: &[f64]) -> Vec<f64> {
    let n = values.len() as f64;
    let (mean, middle) = (values.iter().sum::<f64>() / n, 0.5 * (n - 1.0));
    let [xx, xy] = values.iter().enumerate().fold([0.0; 2], |[xx, xy], (i, y)| {
        let x = i as f64 - middle;
        [xx + x * x, xy + x * (y - mean)]
    });
    let slope = if xx > 0.0 { xy / xx } else { 0.0 };
    values.iter().enumerate().map(|(i, y)| y - mean - slope * (i as f64 - middle)).collect()
}

/// The correlation of neighbours in series without mean and slope; none where it may be by chance.
fn correlation(series: &[Vec<f64>]) -> Correlation {
    /// Correlations below this share of that of neighbours, or which may be by chance, say nothing about the decay.
    const TOLD: f64 = 0.3;
    /// The slowest decay that is told from a drift, in the number of rows.
    const SLOWEST: f64 = 3.0;
    let none = Correlation::default();
    let rows: usize = series.iter().map(Vec::len).sum();
    let n = rows as f64;
    if rows < FEWEST_APART {
        return none;
    }
    let lagged = |lag: usize| {
        let pairs: usize = series.iter().map(|of| of.len().saturating_sub(lag)).sum();
        let sum: f64 =
            series.iter().flat_map(|of| of.iter().zip(of.iter().skip(lag))).map(|(a, b)| a * b).sum();
        sum / pairs.max(1) as f64
    };
    let longest = series.iter().map(Vec::len).max().unwrap_or(0) / 3;
    let whole = lagged(0);
    if whole <= ROUNDING * ROUNDING || lagged(1) <= CORRELATED / n.sqrt() * whole {
        return none;
    }
    let mut found = Correlation { share: 1.0, decay: lagged(1) / whole };
    // Without their mean and slope the series have lost 2 τ/n of each covariance.
    for _ in 0..3 {
        let lost = (2.0 * series.len() as f64 * found.rows() / n).min(1.0) * whole;
        let at = |lag: usize| (lagged(lag) + lost) / (whole + lost);
        let first = at(1);
        let enough = f64::max(TOLD * first, 2.0 / n.sqrt());
        let told: Vec<(f64, f64)> =
            (1..=longest.max(1)).map(|lag| (lag as f64, at(lag))).take_while(|(_, r)| *r > enough).collect();
        let least = exp(-SLOWEST / n);
        found = if told.len() < 2 {
            Correlation { share: 1.0, decay: first.clamp(0.0, least) }
        } else {
            // The correlation of rows farther apart is known less well.
            let count: f64 = told.iter().map(|(lag, _)| 1.0 / lag).sum();
            let [mean_x, mean_y] =
                told.iter().fold([0.0; 2], |[x, y], (lag, r)| [x + 1.0 / count, y + ln(*r) / lag / count]);
            let [xx, xy] = told.iter().fold([0.0; 2], |[xx, xy], (lag, r)| {
                let off = lag - mean_x;
                [xx + off * off / lag, xy + off * (ln(*r) - mean_y) / lag]
            });
            let decay = exp((xy / xx).min(0.0)).min(least);
            // At most all of the noise is correlated: then its decay is the correlation of neighbours.
            if first < decay {
                Correlation { share: first / decay, decay }
            } else {
                Correlation { share: 1.0, decay: first.min(least) }
            }
        };
    }
    if found.decay > 0.0 { found } else { none }
}

/// `JᵀRJ`: the rows of a branch in the order of measurement, those in contact and those apart.
pub(super) fn together(
    problem: &FitProblem,
    jacobian: &DMatrix<f64>,
    correlation: &Correlation,
) -> DMatrix<f64> {
    let (per, p) = (problem.per_point(), jacobian.ncols());
    let mut crossed = DMatrix::zeros(p, p);
    for branch in 0..problem.branches() {
        let of = problem.data.iter().enumerate().filter(|(_, datum)| datum.branch == branch);
        let mut rows: Vec<(usize, usize)> = of.map(|(index, datum)| (datum.point.at, index)).collect();
        rows.sort_unstable();
        for part in 0..per {
            // Σ ρ^(i − k) J_k over the rows before.
            let mut before = DVector::<f64>::zeros(p);
            let mut last = None;
            for (row, index) in &rows {
                let way = last.map_or(0, |last: usize| row - last);
                last = Some(*row);
                before *= exp(way as f64 * ln(correlation.decay));
                let of_row = jacobian.row(per * index + part).transpose();
                crossed += &of_row * before.transpose();
                before += of_row;
            }
        }
    }
    jacobian.tr_mul(jacobian) + correlation.share * (&crossed + crossed.transpose())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::tests::Normal;

    #[test]
    fn a_correlation_is_found_and_white_noise_seldom_has_one() {
        let mut found = 0;
        for seed in 0..200 {
            let mut normal = Normal::new(seed);
            let white: Vec<f64> = (0..100).map(|_| normal.next()).collect();
            found += usize::from(correlation(&[detrended(&white)]).share > 0.0);
        }
        // Beyond one deviation on one side.
        assert!(found <= 45, "{found} of 200");
        let mut mean = 0.0;
        for seed in 0..50 {
            let mut normal = Normal::new(seed);
            let mut last = 0.0;
            let series = |normal: &mut Normal, last: &mut f64| {
                let step = |_| {
                    *last = 0.9 * *last + normal.next();
                    *last
                };
                detrended(&(0..200).map(step).collect::<Vec<f64>>())
            };
            let both = [series(&mut normal, &mut last), series(&mut normal, &mut last)];
            mean += correlation(&both).rows() / 50.0;
        }
        // (1 + 0.9)/(1 - 0.9)
        assert!((14.0..25.0).contains(&mean), "{mean}");
    }

    #[test]
    fn neighbours_show_the_noise_whatever_varies_slowly() {
        let mut normal = Normal::new(3);
        let values: Vec<f64> =
            (0..2000).map(|i| normal.next() + 5.0 * (f64::from(i) / 200.0).sin()).collect();
        let differences: Vec<f64> =
            values.windows(3).map(|v| (v[0] - 2.0 * v[1] + v[2]) / 6.0_f64.sqrt()).collect();
        let found = variance(&differences).unwrap();
        assert!((found - 1.0).abs() < 0.12, "{found}");
    }
}
