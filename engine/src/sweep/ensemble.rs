//! What the members of an ensemble say about one quantity: mean, spread, quantiles, and their uncertainty.
//!
//! ```text
//! sd² = Σ (xᵢ − mean)²/(n − 1),    q_p: linear between the order statistics, at the place (n − 1) p from the first
//! ```
//!
//! The error of the mean is sd/√n. That of the median is its standard deviation over [`RESAMPLES`] bootstrap samples, n
//! values drawn from the n with replacement, times √(n/(n − 1)), as that of the mean would need it. B. Efron, *Bootstrap methods: another look at the jackknife*, Ann. Statist. 7, 1
//! (1979), doi:10.1214/aos/1176344552. The quantiles are type 7 of R. J. Hyndman and Y. Fan, *Sample quantiles in
//! statistical packages*, Am. Stat. 50, 361 (1996), doi:10.2307/2684934, like those of `NumPy` and R.

use super::stage::Cell;
use crate::gap::shapes::split_mix::SplitMix64;

/// Bootstrap samples: with this many the errors themselves are known to 2 %.
pub const RESAMPLES: u32 = 1000;

/// The fewest and the most members.
pub const MEMBERS: std::ops::RangeInclusive<u64> = 2..=100_000;

/// The shares of the members that lie below the quantiles.
const SHARES: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];

/// The statistic that has no unit.
pub const COUNT: &str = "count";

/// The suffix to the name of a quantity, and its meaning, in the order of [`Statistics::cells`].
pub const STATISTICS: [(&str, &str); 10] = [
    ("mean", "mean"),
    ("sd", "standard deviation"),
    ("q05", "5 % quantile"),
    ("q25", "25 % quantile"),
    ("q50", "median"),
    ("q75", "75 % quantile"),
    ("q95", "95 % quantile"),
    ("mean.error", "standard error of the mean"),
    ("q50.error", "standard error of the median"),
    (COUNT, "members that have a value"),
];

/// The statistics of one quantity over the members that have it, at least one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// The mean.
    pub mean: f64,
    /// The standard deviation; `None`, like the errors, for a single member.
    pub deviation: Option<f64>,
    /// The quantiles at 5, 25, 50, 75 and 95 %.
    pub quantiles: [f64; 5],
    /// The standard error of the mean.
    pub mean_error: Option<f64>,
    /// The standard error of the median, by the bootstrap.
    pub median_error: Option<f64>,
    /// Members that have a value.
    pub count: usize,
}

impl Statistics {
    /// The statistics of the finite ones of `values`; `None` if there are none. The bootstrap draws from `random`.
    pub fn of(values: impl IntoIterator<Item = f64>, random: &mut SplitMix64) -> Option<Self> {
        let mut sorted: Vec<f64> = values.into_iter().filter(|x| x.is_finite()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let count = sorted.len();
        let mean = (count > 0).then(|| sorted.iter().sum::<f64>() / count as f64)?;
        let deviation = deviation(&sorted);
        let mean_error = deviation.map(|deviation| deviation / (count as f64).sqrt());
        let median_error = error_of_median(&sorted, random).filter(|_| count > 1);
        Some(Self { mean, deviation, quantiles: of_sorted(&sorted), mean_error, median_error, count })
    }

    /// The numbers of what was `found` of a quantity, in the order of [`STATISTICS`]; where no member has a value, their count alone.
    pub fn cells(found: Option<&Self>) -> [Option<Cell>; STATISTICS.len()] {
        let Some(found) = found else {
            return std::array::from_fn(|at| (STATISTICS[at].0 == COUNT).then_some(Cell::Count(0)));
        };
        let number = |x: Option<f64>| x.map(Cell::Number);
        let [q05, q25, q50, q75, q95] = found.quantiles.map(|x| number(Some(x)));
        let errors = [found.mean_error, found.median_error].map(number);
        let (mean, deviation) = (number(Some(found.mean)), number(found.deviation));
        [mean, deviation, q05, q25, q50, q75, q95, errors[0], errors[1], Some(Cell::Count(found.count))]
    }
}

/// The statistics of every point. `values` holds the members' values in the order of the rows: all points of the first
/// member, then all of the second, …; what is not finite does not count as a value.
pub fn at_points(values: &[f64], points: usize, seed: u64) -> Vec<Option<Statistics>> {
    // No row has this number, so the bootstrap shares no bits with what the members draw.
    let seed = SplitMix64::row(seed, u64::MAX).bits();
    let at = |point: usize| {
        let mut random = SplitMix64::row(seed, point as u64);
        Statistics::of(values.iter().copied().skip(point).step_by(points.max(1)), &mut random)
    };
    (0..points).map(at).collect()
}

/// The quantiles of the finite ones of `values` at 5, 25, 50, 75 and 95 %; `None` if there are none.
pub fn quantiles(values: &[f64]) -> Option<[f64; 5]> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    (!sorted.is_empty()).then(|| of_sorted(&sorted))
}

fn of_sorted(sorted: &[f64]) -> [f64; 5] {
    let counts = vec![1; sorted.len()];
    SHARES.map(|share| quantile(sorted, &counts, share))
}

/// √(Σ (x − mean)²/(n − 1)); `None` for fewer than two values.
fn deviation(values: &[f64]) -> Option<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    (values.len() > 1).then(|| (squares / (values.len() - 1) as f64).sqrt())
}

/// The quantile of a sample that contains each of `sorted` as often as `counts` says, and as many values in all as
/// `sorted`.
fn quantile(sorted: &[f64], counts: &[u32], share: f64) -> f64 {
    let place = (sorted.len() - 1) as f64 * share;
    let (mut below, mut lower) = (0.0, f64::NAN);
    for (x, count) in sorted.iter().zip(counts).filter(|(_, count)| **count > 0) {
        // The values before it end at `below`; this one occupies the places from `below` to `last`.
        let last = below + f64::from(*count) - 1.0;
        if place < below {
            return lower + (place - (below - 1.0)) * (x - lower);
        }
        if place <= last {
            return *x;
        }
        (below, lower) = (last + 1.0, *x);
    }
    lower
}

/// The standard error of the median by the bootstrap.
fn error_of_median(sorted: &[f64], random: &mut SplitMix64) -> Option<f64> {
    let mut found = Vec::with_capacity(RESAMPLES as usize);
    let mut counts = vec![0_u32; sorted.len()];
    for _ in 0..RESAMPLES {
        counts.fill(0);
        for _ in 0..sorted.len() {
            // The upper half of the product is uniformly distributed below the length.
            let at = (u128::from(random.bits()) * sorted.len() as u128) >> 64;
            counts[usize::try_from(at).unwrap_or_default()] += 1;
        }
        found.push(quantile(sorted, &counts, 0.5));
    }
    let count = sorted.len() as f64;
    deviation(&found).map(|error| error * (count / (count - 1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An exponential distribution: skewed, with mean 1 and median ln 2.
    fn skewed(random: &mut SplitMix64) -> f64 {
        -(1.0 - random.unit()).ln()
    }

    #[test]
    fn the_errors_hold_the_truth_as_often_as_they_say() {
        let mut held = [0; 2];
        for repetition in 0..1000 {
            let mut random = SplitMix64::row(1, repetition);
            let values: Vec<f64> = (0..400).map(|_| skewed(&mut random)).collect();
            let found = Statistics::of(values, &mut SplitMix64::row(2, repetition)).unwrap();
            let truths =
                [(found.mean, found.mean_error, 1.0), (found.quantiles[2], found.median_error, 2_f64.ln())];
            for (held, (value, error, truth)) in held.iter_mut().zip(truths) {
                *held += i32::from((value - truth).abs() <= 1.96 * error.unwrap());
            }
        }
        assert!(held.iter().all(|held| (930..=970).contains(held)), "{held:?}");
    }

    #[test]
    fn the_numbers_are_those_of_numpy() {
        // numpy.percentile([1, 2, 4, 8, 16, 32], [5, 25, 50, 75, 95]), numpy.std(…, ddof=1).
        let values = [4.0, f64::NAN, 32.0, 1.0, 8.0, 2.0, 16.0];
        let found = Statistics::of(values, &mut SplitMix64::new(1)).unwrap();
        let exact = (found.mean, found.count, found.quantiles);
        assert_eq!(exact, (10.5, 6, [1.25, 2.5, 6.0, 14.0, 28.0]));
        assert!((found.deviation.unwrap() - 11.861_703_081_766_97).abs() < 1e-13);
        // scipy.stats.sem(…).
        assert!((found.mean_error.unwrap() - 4.842_520_005_121_301).abs() < 1e-13);
    }

    #[test]
    fn what_is_not_there_is_not_made_up() {
        let random = || SplitMix64::new(1);
        assert_eq!(Statistics::of([f64::NAN], &mut random()), None);
        let one = Statistics::of([3.0], &mut random()).unwrap();
        let none = [one.deviation, one.mean_error, one.median_error];
        assert_eq!((one.mean, one.quantiles, none), (3.0, [3.0; 5], [None; 3]));
        let points = at_points(&[1.0, f64::NAN, 3.0, f64::NAN, 5.0], 2, 7);
        assert_eq!((points[0].unwrap().mean, points[0].unwrap().count, points[1]), (3.0, 3, None));
    }
}
