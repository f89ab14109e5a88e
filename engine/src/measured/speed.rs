//! How fast a quantity goes, row by row, from its values and their times.
//!
//! ```text
//! y and t are quadratics of the number u of the row in a window of 2h + 1 rows,     dy/dt = y'/t'     σ = σ_y |c|/t'     c the weights of y'
//! ```
//!
//! Both are taken by the number of the row, so that noise of y enters linearly, and rows that are even in time, even in y or of any other
//! density have their speed alike: a speed that does not change is found exactly. The window of each row is the narrowest that knows the
//! speed well, and no wider than those windows agree with each other, by the intersection of their intervals: A. Goldenshluger and
//! A. Nemirovski, Math. Methods Stat. 6, 135 (1997). What the next wider window shows beyond its noise tells the error of the quadratic. Where a straight line would do, the quadratic has the same slope in the middle of a
//! window; at the ends of a branch it follows the bend.

use super::noise::scatter_over;

/// Rows by which a speed is told, at least.
pub const FEWEST: usize = 5;
/// A speed that is known so well, as a share of itself, needs no wider window.
const KNOWN: f64 = 0.05;
/// Estimates agree within so many of their errors.
const AGREE: f64 = 2.0;
/// The widest window is one part in so many of the rows, to either side, and no more than so many rows.
const SHARE: usize = 6;
const WIDEST: usize = 400;
/// Near an end a window that lies to one side of its row is no wider than this, to either side of its own middle.
const AT_ENDS: usize = 3;

/// A speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speed {
    /// dy/dt.
    pub value: f64,
    /// One standard deviation, by the noise of y and by what the window does not follow.
    pub error: f64,
    /// Half of what the speeds of the two halves of the window differ by: how far the speed may be another at the row itself. Infinite at the
    /// ends, where there is one half alone.
    pub bend: f64,
    /// The rows of the window.
    pub rows: usize,
}

/// dy/dt at each row of `values` at `times`, in the order of measurement; σ of y is `sigma`. Nothing where the times stand still or go back,
/// or of fewer than [`FEWEST`] rows.
pub fn speeds(times: &[f64], values: &[f64], sigma: f64) -> Vec<Option<Speed>> {
    let n = values.len().min(times.len());
    if n < FEWEST {
        return vec![None; n];
    }
    let widest = (n / SHARE).clamp(1, WIDEST);
    let widest = |at: usize| at.min(n - 1 - at).max(AT_ENDS).min(widest);
    (0..n).map(|at| of_row(times, values, sigma, at, widest(at))).collect()
}

/// σ of a quantity that goes on from row to row, by its neighbours: over the time, or over the number of the row, whichever tells less.
pub fn noise(times: &[f64], values: &[f64]) -> f64 {
    let numbers: Vec<f64> = (0..values.len()).map(|i| i as f64).collect();
    let of = |x: &[f64]| scatter_over(x, values).filter(|sigma| sigma.is_finite());
    of(times).into_iter().chain(of(&numbers)).reduce(f64::min).unwrap_or(0.0)
}

/// The speed at the row `at`.
fn of_row(times: &[f64], values: &[f64], sigma: f64, at: usize, widest: usize) -> Option<Speed> {
    let of = |half: usize| {
        // A window at an end is as wide as one in the middle.
        let begin = at.saturating_sub(half).min(values.len().saturating_sub(2 * half + 1));
        let window = begin..(begin + 2 * half + 1).min(values.len());
        slope(&times[window.clone()], &values[window], sigma, at - begin)
    };
    let wider = |half: usize| half + 1 + half / 4;
    let (mut found, mut half): (Option<(usize, Speed)>, usize) = (None, 1);
    let mut agreed = [f64::NEG_INFINITY, f64::INFINITY];
    loop {
        if let Some(next) = of(half) {
            let margin = AGREE * next.error;
            agreed = [agreed[0].max(next.value - margin), agreed[1].min(next.value + margin)];
            if agreed[0] > agreed[1] {
                break;
            }
            found = Some((half, next));
            if next.error <= KNOWN * next.value.abs() {
                break;
            }
        }
        if half >= widest {
            break;
        }
        half = wider(half).min(widest);
    }
    let (half, found) = found?;
    let beside = of(wider(half)).filter(|_| 2 * wider(half) < values.len());
    let is_inside = (wider(half)..values.len().saturating_sub(wider(half))).contains(&at);
    let bias = beside.map_or(0.0, |beside| {
        let beyond = beyond([&found, &beside]);
        let [own, other] = [half, wider(half)].map(|half| (half * half) as f64);
        // The third derivative bends a speed with the square of the width. At an end nothing shows how it goes on.
        if is_inside { beyond * own / (other - own) } else { beyond }
    });
    let bias = if is_inside { bias } else { bias.max(bent(times, values, sigma, at)) };
    Some(Speed { error: (found.error * found.error + bias * bias).sqrt(), ..found })
}

/// By how much the speed changes from before the row `at` to after it, or next to it at an end, beyond what the noise may explain:
/// the last rows before the bodies come apart have no wider window that shows it.
fn bent(times: &[f64], values: &[f64], sigma: f64, at: usize) -> f64 {
    let at = at.clamp(1, values.len() - 2);
    let ways = [times[at] - times[at - 1], times[at + 1] - times[at]];
    let bend = ((values[at + 1] - values[at]) / ways[1] - (values[at] - values[at - 1]) / ways[0]).abs();
    let noise =
        sigma * (ways[0].powi(-2) + ways[1].powi(-2) + (1.0 / ways[0] + 1.0 / ways[1]).powi(2)).sqrt();
    let beyond = (bend - AGREE * noise).max(0.0);
    if beyond.is_finite() { beyond } else { 0.0 }
}

/// By how much the speed in a wider window differs beyond what the noise may explain.
fn beyond([found, wider]: [&Speed; 2]) -> f64 {
    // The narrower window is a part of the wider.
    let noise = (found.error * found.error - wider.error * wider.error).max(0.0).sqrt();
    ((found.value - wider.value).abs() - AGREE * noise).max(0.0)
}

/// The speed at the row `at` of a window.
fn slope(times: &[f64], values: &[f64], sigma: f64, at: usize) -> Option<Speed> {
    let n = values.len() as f64;
    let middle = 0.5 * (n - 1.0);
    // Of x = u − middle: the sums of x² and of (x² − x̄²)².
    let squares = n * (n * n - 1.0) / 12.0;
    let mean = squares / n;
    let fourth = n * (n * n - 1.0) * (n * n - 4.0) / 180.0;
    let place = at as f64 - middle;
    let [mut of_time, mut of_value, mut norm] = [0.0; 3];
    for (i, (time, value)) in times.iter().zip(values).enumerate() {
        let x = i as f64 - middle;
        let weight = x / squares + 2.0 * place * (x * x - mean) / fourth;
        // Differences keep the digits of times that are far from 0.
        of_time += weight * (time - times[at]);
        of_value += weight * (value - values[at]);
        norm += weight * weight;
    }
    let value = of_value / of_time;
    let last = values.len() - 1;
    let half = |from: usize, to: usize| (values[to] - values[from]) / (times[to] - times[from]);
    let bend = if at == 0 || at == last { f64::INFINITY } else { 0.5 * (half(0, at) - half(at, last)).abs() };
    let bend = if bend.is_nan() { f64::INFINITY } else { bend };
    let error = sigma * norm.sqrt() / of_time;
    (of_time > 0.0 && value.is_finite()).then_some(Speed { value, error, bend, rows: values.len() })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of a linear congruence, summed up twelve times: of the standard deviation 1.
    fn normal(state: &mut u64) -> f64 {
        let mut sum = -6.0;
        for _ in 0..12 {
            *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            sum += (*state >> 11) as f64 / (1_u64 << 53) as f64;
        }
        sum
    }

    #[test]
    fn an_even_speed_is_found_at_any_density_of_rows() {
        let mut state = 5;
        let mut time = 1e6;
        let times: Vec<f64> = (0..60)
            .map(|_| {
                time += (2.0 * normal(&mut state)).exp();
                time
            })
            .collect();
        let values: Vec<f64> = times.iter().map(|t| 3.0 - 0.25 * (t - 1e6)).collect();
        for speed in speeds(&times, &values, 1e-9) {
            assert!((speed.unwrap().value + 0.25).abs() < 1e-9, "{speed:?}");
        }
    }

    #[test]
    fn errors_are_those_of_the_noise_and_a_bend_narrows_the_window() {
        // s = exp(−t), its rows even in s: they lie far apart in the end.
        let sigma = 2e-3;
        let mut state = 11;
        let (mut squares, mut count, mut narrow, mut wide) = (0.0, 0.0, 0, 0);
        for _ in 0..40 {
            let truth: Vec<f64> = (0..200).map(|i| 1.0 - f64::from(i) * 0.0049).collect();
            let times: Vec<f64> = truth.iter().map(|s| -s.ln()).collect();
            let values: Vec<f64> = truth.iter().map(|s| s + sigma * normal(&mut state)).collect();
            let of = noise(&times, &values);
            assert!((0.7..1.4).contains(&(of / sigma)), "{of}");
            for (speed, s) in speeds(&times, &values, sigma).iter().zip(&truth) {
                let speed = speed.unwrap();
                squares += ((speed.value + s) / speed.error).powi(2);
                count += 1.0;
            }
            let found = speeds(&times, &values, sigma);
            wide += found[100].unwrap().rows;
            let sharp: Vec<f64> =
                truth.iter().enumerate().map(|(i, s)| if i < 100 { 1.0 } else { *s }).collect();
            narrow += speeds(&times, &sharp, 1e-5)[100].unwrap().rows;
        }
        let off: f64 = squares / count;
        assert!((0.7..1.6).contains(&off), "{off}");
        assert!(narrow * 2 < wide, "{narrow} {wide}");
    }

    #[test]
    fn errors_hold_what_a_window_does_not_follow() {
        // As the contact radius goes at its last contact: ever faster, without noise.
        let times: Vec<f64> = (0..300).map(|i| f64::from(i) / 300.0).collect();
        let values: Vec<f64> = times.iter().map(|t| (1.0 - t).powf(0.4)).collect();
        let found = speeds(&times, &values, 1e-9);
        let off = found.iter().zip(&times).map(|(speed, t)| {
            let speed = speed.unwrap();
            (speed.value + 0.4 * (1.0 - t).powf(-0.6)).abs() / speed.error
        });
        let mut off: Vec<f64> = off.collect();
        off.sort_by(f64::total_cmp);
        assert!(off[270] < 2.0 && off[299] < 8.0, "{:?}", &off[290..]);
    }

    #[test]
    fn times_that_stand_still_have_no_speed() {
        assert!(speeds(&[1.0; 8], &[0.0; 8], 0.1).iter().all(Option::is_none));
        assert!(speeds(&[0.0, 1.0, 2.0], &[0.0; 3], 0.1).iter().all(Option::is_none));
    }
}
