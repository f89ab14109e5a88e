//! The jump behind which the bodies are apart, searched for over as many rows as the noise requires.
//!
//! ```text
//! D_w(j) = mean of w rows from j on − mean of the w rows before,     z = D_w/(σ √(2/w)),     w = 1, 2, 4, …
//! ```
//!
//! The rows run from the contact to the free end. σ is estimated from neighbouring rows. Behind a jump the force is a
//! line that hardly rises. A record that ends at its last contact has no such rows, because the force there rises ever
//! faster.

use super::noise::{FLOOR, median, range, scatter_over};

/// A jump is at least this many deviations of its own noise.
const SURE: f64 = 6.0;
/// The fewest rows on either side, and the fewest behind the jump when there are few rows in all.
pub(super) const FEWEST: usize = 3;
pub(super) const BEHIND: usize = 2;
pub(super) const FEW: usize = 40;
/// A jump is at least this many times the scatter behind it, and the force behind it changes by at most this share of
/// the jump.
const CLEAR: f64 = 3.0;
const GOES_ON: f64 = 0.5;
/// Changes below this share of a jump do not tell which side of it is in contact.
const ALIKE: f64 = 0.1;
/// Rows that are off by this many σ from the median of five, and by this many times the range of the other four, are
/// set to that median. A force that falls and jumps within a few rows has no outliers.
const OFF: f64 = 5.0;
const ALONE: f64 = 2.0;
/// Of the rises that are larger than their neighbours, this many are examined, the largest first.
const TRIED: usize = 8;
/// With fewer rows than this, neighbours do not distinguish noise from a changing force. A jump is then a rise by this
/// many times the range of the rows behind it, and by this share of the whole range.
pub(crate) const SPARSE: usize = 20;
const OF_FEW: f64 = 4.0;
const OF_RANGE: f64 = 0.05;
/// The number of rows behind the jump from which a slope can be told from their scatter.
const MANY: usize = 20;

/// A jump.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RowJump {
    /// The first row behind the jump.
    pub(super) at: usize,
    /// Its height in deviations of its noise.
    pub(super) deviations: f64,
}

/// The jump in `force` over `x`, from the contact to the free end; `None` where there is none.
pub(super) fn jump(x: &[f64], force: &[f64]) -> Option<RowJump> {
    let n = force.len();
    if n < 2 * FEWEST {
        return None;
    }
    // The rows of a load that came off would lift the mean of the last rows in contact.
    let kept = n - Some(fallen(x, force)).filter(|rows| n >= FEW || *rows < BEHIND).unwrap_or(0);
    let Some(mut found) = of_many(&x[..kept], &force[..kept]) else {
        return if n < SPARSE { of_few(force) } else { None };
    };
    // On waves the highest jump may not be the last one: the bodies are apart behind that.
    while kept - found.at >= SPARSE {
        let next = of_many(&x[found.at..kept], &force[found.at..kept])
            .map(|next| RowJump { at: found.at + next.at, ..next });
        let Some(next) = next.filter(|next| is_contact(x, force, [found.at, next.at])) else { break };
        found = next;
    }
    Some(found)
}

/// Whether the last `rows` may lie behind a jump, though they are too few to show one in noise: it is higher than the rise before
/// it and than the change behind it. Where a record ends at its last contact, the force rises as a square root: its last
/// two rises are as 0.41 to 1.
pub(super) fn may_be_behind(x: &[f64], force: &[f64], rows: usize) -> bool {
    /// A jump is this share of how far the force was below the rows behind it. The rise before it, for one row and for more, and the
    /// change behind it are at most these shares of the jump: behind a rise as high as that before it a contact goes on rising.
    const OF_PULL: f64 = 0.25;
    const BEFORE: [f64; 2] = [0.9, 1.25];
    const AFTER: f64 = 0.25;
    let Some(at) = force.len().checked_sub(rows).filter(|at| *at >= SPARSE) else { return false };
    let (before, behind) = force.split_at(at);
    let sigma = scatter_over(x, force).unwrap_or(0.0).max(FLOOR * range(force.iter().copied()));
    let level = behind.iter().sum::<f64>() / rows as f64;
    let lowest = before.iter().copied().fold(f64::INFINITY, f64::min);
    let height = level - before[at - 1];
    height > SURE * sigma * (1.0 + 1.0 / rows as f64).sqrt()
        && height > OF_PULL * (level - lowest)
        && before[at - 1] - before[at - 2] < BEFORE[usize::from(rows > 1)] * height
        && range(behind.iter().copied()) < AFTER * height
}

/// How many of the last rows, at most two, are behind a jump of both force and x: where a dead load comes off, the force is all but
/// constant before it.
pub(super) fn fallen(x: &[f64], force: &[f64]) -> usize {
    /// A jump in x, in steps of the rows before it, and how many of these count.
    const STEPS: f64 = 5.0;
    const BEFORE: usize = 8;
    let is_fallen = |rows: &usize| {
        may_be_behind(x, force, *rows) && {
            let at = x.len() - rows;
            let step = range(x[at - BEFORE..at].iter().copied()) / (BEFORE - 1) as f64;
            x[at - 1] - x[at] > STEPS * step
        }
    };
    (1..=BEHIND).rev().find(is_fallen).unwrap_or(0)
}

/// Whether the bodies are in contact between two jumps: the force has a slope as before the first of them. Bridges between
/// the bodies and steps of the instrument have none.
fn is_contact(x: &[f64], force: &[f64], [from, to]: [usize; 2]) -> bool {
    /// The fewest rows in between, and the share of the slope.
    const BETWEEN: usize = 8;
    const OF_SLOPE: f64 = 0.4;
    let slope = |from: usize, to: usize| {
        let half = usize::midpoint(from, to);
        let of = |values: &[f64], from: usize, to: usize| median(values[from..to].to_vec()).unwrap_or(0.0);
        (of(force, from, half) - of(force, half, to)) / (of(x, from, half) - of(x, half, to))
    };
    let before = slope(0, from);
    to - from >= BETWEEN && before > 0.0 && slope(from, to) > OF_SLOPE * before
}

/// The jump among so few rows that a single one is as high as their noise seems to be.
fn of_few(force: &[f64]) -> Option<RowJump> {
    let n = force.len();
    let whole = range(force.iter().copied());
    let found = (FEWEST..=n - BEHIND).filter_map(|at| {
        let height = force[at] - force[at - 1];
        let behind = range(force[at..].iter().copied()).max(FLOOR * whole);
        let was_rising = force[at - 1] - force[at - 2] > GOES_ON * height;
        let is_jump = height > OF_RANGE * whole && height > OF_FEW * behind && !was_rising;
        is_jump.then_some(RowJump { at, deviations: height / behind })
    });
    found.max_by(|a, b| (force[a.at] - force[a.at - 1]).total_cmp(&(force[b.at] - force[b.at - 1])))
}

/// The jump among enough rows.
fn of_many(x: &[f64], force: &[f64]) -> Option<RowJump> {
    let n = force.len();
    let sigma = scatter_over(x, force).unwrap_or(0.0).max(FLOOR * range(force.iter().copied()));
    if sigma <= 0.0 {
        return None;
    }
    let force = without_outliers(force, OFF * sigma);
    let mut sums = vec![0.0; n + 1];
    for (i, p) in force.iter().enumerate() {
        sums[i + 1] = sums[i] + p;
    }
    let mean = |from: usize, to: usize| (sums[to] - sums[from]) / (to - from) as f64;
    let behind = if n < FEW { BEHIND } else { FEWEST };
    let mut best: Option<RowJump> = None;
    let mut w = 1;
    while w <= (n / 8).max(1) {
        let scale = (w as f64 / 2.0).sqrt() / sigma;
        let rows = w.max(FEWEST)..=(n - w.max(behind));
        let height = |at: usize| mean(at, at + w) - mean(at - w, at);
        let is_peak = |at: &usize| {
            [at - 1, at + 1].iter().all(|beside| !rows.contains(beside) || height(*at) >= height(*beside))
        };
        let mut peaks: Vec<usize> =
            rows.clone().filter(|at| height(*at) * scale > SURE).filter(is_peak).collect();
        peaks.sort_by(|&a, &b| height(b).total_cmp(&height(a)));
        let found = peaks.into_iter().take(TRIED).find(|at| is_flat(x, &force, *at, height(*at), w));
        let found = found.map(|at| RowJump { at, deviations: height(at) * scale });
        best = best.into_iter().chain(found).max_by(|a, b| a.deviations.total_cmp(&b.deviations));
        w *= 2;
    }
    best.map(|found| RowJump { at: sharpened(&force, found.at, sigma, behind), ..found })
}

/// Whether the force behind `at` stays constant compared with a jump of this height, seen in `w` rows.
fn is_flat(x: &[f64], force: &[f64], at: usize, height: f64, w: usize) -> bool {
    let (before, (x, rest)) = (&force[..at], (&x[at..], &force[at..]));
    if rest.len() < 2 * FEWEST {
        let over_rows = w as f64 / rest.len().saturating_sub(1).max(1) as f64;
        return range(rest.iter().copied()) * over_rows.max(1.0) <= GOES_ON * height;
    }
    // A slope of the baseline is due to the instrument.
    let half = rest.len() / 2;
    let of = |part: &[f64]| median(part.to_vec()).unwrap_or(0.0);
    let (x0, x1, p0, p1) = (of(&x[..half]), of(&x[half..]), of(&rest[..half]), of(&rest[half..]));
    let slope = if rest.len() >= MANY && x0 > x1 { (p1 - p0) / (x1 - x0) } else { 0.0 };
    let off: Vec<f64> = x.iter().zip(rest).map(|(x, p)| p - slope * (x - x0)).collect();
    let middle = of(&off);
    let scatter = 1.4826 * of(&off.iter().map(|p| (p - middle).abs()).collect::<Vec<_>>());
    // A force that merely goes on rises as much behind as before; its rise over `w` rows is then the height.
    let over_rows = (p1 - p0).abs() * w as f64 / half as f64;
    // The force must change less than in contact, which begins at the larger x; otherwise the rows apart are the ones
    // before.
    let (near, far) = before.split_at(before.len() / 2);
    let [changes, changed] = [(p1 - p0).abs(), (of(near) - of(far)).abs()];
    // Near the pull-off of a dead load the force hardly changes in contact either. The side with the smaller force is then apart.
    let is_alike = changes.max(changed) <= ALIKE * height && of(rest).abs() < of(before).abs();
    (changes <= changed || is_alike)
        && (p1 - p0).abs().max(over_rows) <= GOES_ON * height
        && CLEAR * scatter <= height
}

/// The values, with rows that differ from their neighbours by more than `limit` replaced.
fn without_outliers(values: &[f64], limit: f64) -> Vec<f64> {
    let around = |i: usize| &values[i.saturating_sub(2)..(i + 3).min(values.len())];
    let cleaned = |(i, value): (usize, &f64)| {
        let middle = median(around(i).to_vec()).unwrap_or(*value);
        // At the ends and beside a jump, the median of so few rows is no better.
        let is_inside = i >= 2 && i + 2 < values.len();
        let off = (value - middle).abs();
        let is_alone = || {
            let others = around(i).iter().enumerate().filter(|(k, _)| *k != 2).map(|(_, other)| *other);
            off > ALONE * range(others)
        };
        if is_inside && off > limit && is_alone() { middle } else { *value }
    };
    values.iter().enumerate().map(cleaned).collect()
}

/// The place near `at` where the force rises most from row to row, if one rise stands out.
fn sharpened(force: &[f64], at: usize, sigma: f64, behind: usize) -> usize {
    const NEAR: usize = 4;
    const STANDS_OUT: f64 = 4.0;
    let rise = |i: usize| force[i] - force[i - 1];
    let near = at.saturating_sub(NEAR).max(FEWEST)..=(at + NEAR).min(force.len() - behind);
    let best = near.max_by(|&a, &b| rise(a).total_cmp(&rise(b)).then(b.cmp(&a)));
    best.filter(|&best| rise(best) > STANDS_OUT * sigma && rise(best) > rise(at)).unwrap_or(at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::shapes::split_mix::SplitMix64;

    #[test]
    fn a_jump_is_found_in_much_noise_and_none_at_a_last_contact() {
        // A force that falls to -1, rises ever faster to -0.5, and either ends there or jumps to 0.
        let contact: Vec<f64> = (0..100_u32)
            .map(|i| {
                let share = f64::from(i) / 99.0;
                if share < 0.8 {
                    3.0 - 5.0 * share
                } else {
                    -1.0 + 0.5 * (1.0 - (1.0 - 25.0 * (share - 0.8).powi(2)).sqrt())
                }
            })
            .collect();
        let whole: Vec<f64> = contact.iter().copied().chain([0.0; 40]).collect();
        let x: Vec<f64> = (0..140_u32).map(|i| -f64::from(i)).collect();
        for seed in 0..50 {
            let mut random = SplitMix64::new(seed);
            // Sums of twelve uniform numbers are nearly normal.
            let mut noise = || 0.08 * ((0..12).map(|_| random.unit()).sum::<f64>() - 6.0);
            let noisy: Vec<f64> = whole.iter().map(|p| p + noise()).collect();
            let found = jump(&x, &noisy).unwrap();
            assert!(found.at.abs_diff(100) <= 1, "seed {seed}: {found:?}");
            // Every fifth row: the force falls and jumps within a few rows.
            let few = |of: &[f64]| of.iter().skip(4).step_by(5).copied().collect::<Vec<f64>>();
            let quiet: Vec<f64> = whole.iter().map(|p| p + 0.1 * noise()).collect();
            assert_eq!(jump(&few(&x), &few(&quiet)).map(|jump| jump.at), Some(20), "seed {seed}");
            let cut: Vec<f64> = contact.iter().map(|p| p + 0.1 * noise()).collect();
            assert_eq!(jump(&x[..100], &cut), None, "seed {seed}");
            assert_eq!(jump(&few(&x[..100]), &few(&cut)), None, "seed {seed}");
        }
    }
}
