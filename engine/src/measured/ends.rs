//! Where the force stays constant at an end of a branch, as it does where the bodies are apart.

use super::noise::{BEYOND, END_ROWS, END_SHARE, FLOOR, median, noise_of, range, scatter_over};
use super::points::MeasuredPoint;

/// A free end varies by less than these shares of the whole range, and of the range at the other end.
const FLAT: [f64; 2] = [0.1, 0.3];
/// Rows are at rest in x if they cover less than this share of what the same number of rows covers on average.
const PAUSE: f64 = 0.1;
/// The shares of the range of x over which the force is examined if it is very noisy.
const SHARES: [f64; 2] = [0.08, 0.16];

/// From this number of rows on, they show whether the force stands still.
const MANY: usize = 100;

/// Whether some of the rows, by their x, are at rest.
pub(super) fn rests(some: &[f64], x: &[f64]) -> bool {
    let [covered, way] = [some, x].map(|of| range(of.iter().copied()));
    covered < PAUSE * way * some.len() as f64 / x.len() as f64
}

/// Whether the curve is free at its low end and at its high end: where y stays constant while x changes.
pub(super) fn free_end(x: &[f64], y: &[f64]) -> [bool; 2] {
    let mut order: Vec<usize> = (0..x.len()).collect();
    order.sort_by(|&a, &b| x[a].total_cmp(&x[b]).then(y[a].total_cmp(&y[b])));
    let spread = |ends: &[usize]| {
        let mut y: Vec<f64> = ends.iter().map(|&i| y[i]).collect();
        y.sort_by(f64::total_cmp);
        // A few outliers among few rows must hide nothing.
        let fifth = y.len() / 5;
        y[y.len() - 1 - fifth] - y[fifth]
    };
    let whole = range(y.iter().copied());
    let flat = |here: f64, there: f64| here <= FLAT[0] * whole && here <= FLAT[1] * there;
    // Many rows tell noise from a slope; few rows tell a short free part from the contact.
    for share in [END_SHARE / 4, END_SHARE] {
        let count = (x.len() / share).max(END_ROWS).min(x.len());
        let ends = [&order[..count], &order[order.len() - count..]];
        // Rows of a pause show nothing.
        let of = |end: &[usize]| -> Vec<f64> { end.iter().map(|&i| x[i]).collect() };
        if ends.iter().any(|end| rests(&of(end), x)) {
            continue;
        }
        let [low, high] = ends.map(spread);
        let found = [flat(low, high), flat(high, low)];
        if found != [false; 2] {
            return found;
        }
    }
    // With much noise, or with rows at rest in x, the medians of parts of either end are used.
    for share in SHARES {
        let found = trends(x, y, &order, share).map(|[low, high]| [flat(low, high), flat(high, low)]);
        if let Some(found) = found.filter(|found| *found != [false; 2]) {
            return found;
        }
    }
    [false; 2]
}

/// By how much the force changes over the outer parts of the range of x, of this share of it, low and high, from the
/// medians of bins; `None` if there are few rows.
fn trends(x: &[f64], y: &[f64], order: &[usize], share: f64) -> Option<[f64; 2]> {
    /// The bins, and the rows in each.
    const BINS: usize = 4;
    const ROWS: usize = 4;
    let (first, last) = (x[*order.first()?], x[*order.last()?]);
    let bin = share * (last - first) / BINS as f64;
    let trend = |from: f64| {
        let of_bin = |k: usize| {
            let lo = from + k as f64 * bin;
            let inside = order.iter().filter(|&&i| x[i] >= lo && x[i] <= lo + bin).map(|&i| y[i]);
            Some(inside.collect::<Vec<f64>>()).filter(|rows| rows.len() >= ROWS).and_then(median)
        };
        let medians: Option<Vec<f64>> = (0..BINS).map(of_bin).collect();
        medians.map(|medians| range(medians.into_iter()))
    };
    Some([trend(first)?, trend(last - BINS as f64 * bin)?])
}

/// The ends of x, low and high, at which the force stays constant as the rows show it, and does not only change little.
pub(super) fn still_end(points: &[MeasuredPoint]) -> [bool; 2] {
    let (x, force): (Vec<f64>, Vec<f64>) = points.iter().map(|point| (point.x, point.force)).unzip();
    let end = free_end(&x, &force);
    // Few rows do not show it.
    if x.len() < MANY {
        return end;
    }
    let mut in_order = points.to_vec();
    in_order.sort_by(|a, b| b.x.total_cmp(&a.x));
    let mut force: Vec<f64> = in_order.iter().map(|point| point.force).collect();
    let low = end[0] && is_level(&force);
    force.reverse();
    [low, end[1] && is_level(&force)]
}

/// Whether the last rows are level within their noise, or a line that hardly rises, as where a baseline is tilted. A
/// force that goes through its largest pull there bends; one that goes on in contact rises.
fn is_level(force: &[f64]) -> bool {
    /// Three medians of the same force differ by less than this many of their errors.
    const ERRORS: f64 = 5.0;
    /// A tilted baseline rises by less than this share of the mean slope.
    const TILT: f64 = 0.05;
    /// Its two halves rise alike, to this share.
    const STRAIGHT: f64 = 0.2;
    /// Without noise, medians that differ by less than this share of the whole range are level,
    const LEVEL: f64 = 3.0 * FLOOR;
    /// if the rows before them are off by this many times as much.
    const BENDS: f64 = 6.0;
    let count = (force.len() / END_SHARE).max(2 * END_ROWS);
    let (end, whole) = (&force[force.len() - count..], range(force.iter().copied()));
    let third = count / 3;
    let middles = [&end[..third], &end[third..count - third], &end[count - third..]];
    let [a, b, c] = middles.map(|part| median(part.to_vec()).unwrap_or(0.0));
    let off = range([a, b, c].into_iter());
    let error = 1.25 * noise_of(force) / (third as f64).sqrt();
    let mean = whole * (count - third) as f64 / force.len() as f64;
    let is_straight = ((b - a) - (c - b)).abs() <= STRAIGHT * (c - a).abs() + ERRORS * error;
    if off <= ERRORS * error || is_straight && (c - a).abs() <= TILT * mean {
        return true;
    }
    // Where a force bends through its largest pull, the rows before are three times as far off as these among themselves.
    let before = &force[force.len().saturating_sub(2 * count)..force.len() - count];
    let next = (median(before.to_vec()).unwrap_or(b) - b).abs();
    off <= LEVEL * whole && next >= BENDS * off
}

/// Whether the force stays constant at the end without a jump before it, as it does where bodies without adhesion come
/// apart. Over the last eighth of the rows it must not change, nor be the smallest of all, as in a record that ends at
/// its smallest force.
pub(super) fn stands_still(force: &[f64]) -> bool {
    const SHARE: usize = 8;
    const FEWEST: usize = 10;
    let count = (force.len() / SHARE).max(FEWEST);
    if force.len() < 2 * count {
        return false;
    }
    let (before, end) = force.split_at(force.len() - count);
    let noise = noise_of(force);
    let floor = FLOOR * range(force.iter().copied());
    let error = median_error(noise, count);
    let level = median(end.to_vec()).unwrap_or(0.0);
    let next = median(before[before.len() - count..].to_vec()).unwrap_or(0.0);
    // The same level again before it: a smallest force is rounder than that.
    !goes_on(end, noise, floor)
        && ((next - level).abs() <= 2.0 * error + floor
            || filtered(before).iter().any(|p| *p < level - BEYOND * noise - floor))
}

/// The error of the median of a third of `count` rows: that of m rows is known to 1.25 σ/√m.
fn median_error(noise: f64, count: usize) -> f64 {
    1.25 * noise / (count as f64 / 3.0).sqrt()
}

/// Whether values with this noise change from third to third: the range of three such medians is below 3.3 of their errors
/// in 95 of 100 cases, and below 5 in all but a few of 1000.
fn goes_on(values: &[f64], noise: f64, floor: f64) -> bool {
    let thirds = values.chunks((values.len() / 3).max(1)).take(3);
    let medians = thirds.filter_map(|part| median(part.to_vec()));
    range(medians) > 5.0 * median_error(noise, values.len()) + floor
}

/// Whether noise hides how the force changes over the outermost quarter of these rows, which run from the contact to the free
/// end.
pub(crate) fn is_hidden(points: &[MeasuredPoint]) -> bool {
    const SHARE: usize = 4;
    let end = &points[points.len() - points.len() / SHARE..];
    let (x, force): (Vec<f64>, Vec<f64>) = end.iter().map(|point| (point.x, point.force)).unzip();
    let floor = FLOOR * range(points.iter().map(|point| point.force));
    // Neighbours differ by the slope too.
    scatter_over(&x, &force).is_some_and(|noise| end.len() >= END_ROWS && !goes_on(&force, noise, floor))
}

/// The running median of five rows, of fewer at the ends.
pub(super) fn filtered(values: &[f64]) -> Vec<f64> {
    let around = |i: usize| &values[i.saturating_sub(2)..(i + 3).min(values.len())];
    (0..values.len()).map(|i| median(around(i).to_vec()).unwrap_or(values[i])).collect()
}
