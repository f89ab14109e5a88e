//! Medians, ranges and the noise of what varies slowly from row to row.

use serde::Serialize;

/// The least noise, as a share of the range: a distance to a curve needs both axes.
pub const FLOOR: f64 = 1e-4;
/// Values beyond this many standard deviations are clipped to it, and the share of the variance of normal values that
/// remains.
pub(crate) const CLIPPED: f64 = 2.5;
pub(crate) const LEFT: f64 = 0.977_56;
/// Deviations of the free part beyond this many σ belong to the contact.
pub(super) const BEYOND: f64 = 6.0;
/// The share of the rows by which the ends are judged, one in this many, and the fewest rows.
pub(super) const END_SHARE: usize = 40;
pub(super) const END_ROWS: usize = 5;

/// Where a standard deviation is from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// A person gave it.
    Given,
    /// The rows apart.
    Apart,
    /// What neighbouring rows in contact differ by.
    Neighbours,
    /// The last digit, or the least share of the range.
    #[default]
    Assumed,
}

/// How well the columns are known, one standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Of x, P and s.
    pub sigma: [f64; 3],
    /// How each was obtained.
    pub from: [Origin; 3],
    /// The share of P by which its σ grows with it, beside σ of P.
    pub share: f64,
    /// The step of the converter of the force; 0 if none is seen.
    pub step: f64,
}

/// The median; `None` of an empty list.
pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    let count = values.len();
    if count == 0 {
        return None;
    }
    let (below, at, _) = values.select_nth_unstable_by(count / 2, f64::total_cmp);
    let at = *at;
    let other =
        if count.is_multiple_of(2) { below.iter().copied().fold(f64::NEG_INFINITY, f64::max) } else { at };
    Some(0.5 * (other + at))
}

/// The variance around 0 of normal values, some of which may be outliers.
pub(crate) fn variance(values: &[f64]) -> Option<f64> {
    const TIMES: usize = 20;
    const SAME: f64 = 1e-6;
    let mut found = (median(values.iter().map(|x| x.abs()).collect())? / 0.6745).powi(2);
    if found == 0.0 {
        // Half of them are zero: differences of a force in steps.
        found = values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64;
    }
    for _ in 0..TIMES {
        let most = CLIPPED * CLIPPED * found;
        let next = values.iter().map(|x| (x * x).min(most)).sum::<f64>() / values.len() as f64 / LEFT;
        let is_same = (next - found).abs() <= SAME * found;
        found = next;
        if is_same {
            break;
        }
    }
    Some(found)
}

/// The range of the values that are numbers.
pub(crate) fn range(values: impl Iterator<Item = f64>) -> f64 {
    let [lo, hi] = values
        .filter(|x| x.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], x| [lo.min(x), hi.max(x)]);
    (hi - lo).max(0.0)
}

/// The last tenth of the rows.
pub(super) fn tenth(force: &[f64]) -> &[f64] {
    &force[force.len() - (force.len() / 10).max(6).min(force.len())..]
}

/// σ of normal noise at the free end of a branch. From few rows there it is poorly known; from all rows it is never too
/// low.
pub(super) fn noise_of(force: &[f64]) -> f64 {
    scatter(tenth(force)).min(scatter(force))
}

/// σ of normal noise on values that vary slowly from row to row.
pub(super) fn scatter(values: &[f64]) -> f64 {
    median(values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect()).unwrap_or(0.0) / 0.954
}

/// σ of normal noise on a y that varies slowly with x from row to row, however uneven the steps of x are: each row is
/// compared with the line through its neighbours.
pub(super) fn scatter_over(x: &[f64], y: &[f64]) -> Option<f64> {
    let off = |i: usize| {
        let share = (x[i] - x[i - 1]) / (x[i + 1] - x[i - 1]);
        let off = y[i] - y[i - 1] - share * (y[i + 1] - y[i - 1]);
        let factor = (1.0 + share * share + (1.0 - share).powi(2)).sqrt();
        (0.0..=1.0).contains(&share).then(|| off.abs() / factor)
    };
    let offs: Vec<f64> = (1..x.len().saturating_sub(1)).filter_map(off).collect();
    median(offs).map(|off| off / 0.6745)
}
