//! Where x reverses: the branches of a file that names none, in any order and with any number of loops.

use super::noise::{median, range, scatter_over};
use super::points::MeasuredPoint;
use super::role::Segment;

/// x reverses where it comes back by more than this share of its range.
const TURN: f64 = 0.2;
/// Noise of x does not reach so many of its deviations from one row to another.
const NOISE: f64 = 10.0;
/// Runs of a named branch with fewer rows are ignored; if longer runs hold less than this share of the rows, the rows
/// are in no order.
const FEWEST: usize = 5;
const IN_RUNS: f64 = 0.9;

/// Takes the rows out of `part` in which x stands still at its largest value: those at its beginning if it is a retraction, at
/// its end if it is an approach. One of them stays.
pub(super) fn without_pause(part: &mut Vec<MeasuredPoint>, is_retraction: bool) -> Vec<MeasuredPoint> {
    /// x stands still where it changes by less than this share of the steps that follow.
    const STILL: f64 = 0.5;
    /// The number of steps that follow.
    const BESIDE: usize = 5;
    /// Behind a soft spring the approach hardly changes while the force does. During a pause that changes by at most this share
    /// of its range.
    const RELAXES: f64 = 0.3;
    /// Steps of a converter make x stand still everywhere: a pause has this many times as many rows.
    const LONGER: f64 = 4.0;
    let from_turn = |i: usize| part[if is_retraction { i } else { part.len() - 1 - i }].x;
    let Some(last) = part.len().checked_sub(BESIDE + FEWEST) else { return Vec::new() };
    let step = |i: usize| (from_turn(i + 1) - from_turn(i)).abs();
    let (turn, mut off, mut count) = (from_turn(0), 0.0_f64, 0);
    let longest = (0..part.len() - 1).map(step).fold(0.0, f64::max);
    for i in 1..last {
        off = off.max((from_turn(i) - turn).abs());
        if off > STILL * longest {
            break;
        }
        let beside = median((i..i + BESIDE).map(step).collect()).unwrap_or(0.0);
        if beside > 0.0 && off <= STILL * beside {
            count = i;
        }
    }
    let moving = (count..part.len() - 1).filter(|i| step(*i) > 0.0).count();
    let usual = (part.len() - count) as f64 / moving.max(1) as f64;
    let is_largest = part.iter().all(|point| point.x <= turn + STILL * step(count));
    if count < FEWEST || (count as f64) < LONGER * usual || !is_largest {
        return Vec::new();
    }
    let first = if is_retraction { 0 } else { part.len() - count };
    let forces = |rows: &[MeasuredPoint]| range(rows.iter().map(|point| point.force));
    if forces(&part[first..first + count]) > RELAXES * forces(part) {
        return Vec::new();
    }
    part.drain(first..first + count).collect()
}

/// The parts of `points` over which x moves in one direction.
pub(super) fn one_way(points: &[MeasuredPoint]) -> Vec<Vec<MeasuredPoint>> {
    let limit = TURN * range(points.iter().map(|point| point.x));
    let mut cuts = vec![0];
    // The farthest rows so far, and the direction of x once that is known.
    let (mut lowest, mut highest, mut rises) = (0, 0, None);
    for (i, point) in points.iter().enumerate() {
        if point.x < points[lowest].x {
            lowest = i;
        }
        if point.x > points[highest].x {
            highest = i;
        }
        let falls_now = points[highest].x - point.x > limit && rises != Some(false);
        let rises_now = point.x - points[lowest].x > limit && rises != Some(true);
        if falls_now || rises_now {
            let turn = if falls_now { highest } else { lowest };
            // The first part has no turn before it: it must be longer than what noise makes of rows that rest.
            let is_part = || {
                let (places, x): (Vec<f64>, Vec<f64>) =
                    points[..=turn].iter().enumerate().map(|(i, point)| (i as f64, point.x)).unzip();
                (points[turn].x - points[0].x).abs() > NOISE * scatter_over(&places, &x).unwrap_or(0.0)
            };
            if rises.is_some() || turn >= FEWEST && is_part() {
                cuts.push(turn);
            }
            rises = Some(rises_now);
            (lowest, highest) = (i, i);
        }
    }
    cuts.push(points.len());
    cuts.dedup();
    cuts.windows(2).map(|pair| points[pair[0]..pair[1]].to_vec()).filter(|part| !part.is_empty()).collect()
}

/// The runs of rows of one named branch; all of them together if the rows are in no order.
pub(super) fn runs(
    points: &[MeasuredPoint],
    segments: &[Segment],
    segment: Segment,
) -> Vec<Vec<MeasuredPoint>> {
    let mut runs: Vec<Vec<MeasuredPoint>> = Vec::new();
    let mut goes_on = false;
    for point in points {
        let is_of = segments[point.row - 1] == segment;
        match runs.last_mut() {
            Some(run) if is_of && goes_on => run.push(*point),
            _ if is_of => runs.push(vec![*point]),
            _ => {}
        }
        goes_on = is_of;
    }
    let all: usize = runs.iter().map(Vec::len).sum();
    let in_long: usize = runs.iter().map(Vec::len).filter(|count| *count >= FEWEST).sum();
    if (in_long as f64) < IN_RUNS * all as f64 {
        return vec![runs.concat()];
    }
    runs.retain(|run| run.len() >= FEWEST);
    runs
}

/// The order of the rows by their times, if it differs from that of the file. `None` if it does not, or if the times
/// begin again for each branch or table: x would go to and fro in the order of the times.
pub(super) fn by_time(times: &[f64], x: &[f64]) -> Option<Vec<usize>> {
    /// If times overlap, the path of x must be shorter by this factor in the order of the times.
    const SHORTER: f64 = 0.5;
    let mut pieces: Vec<[f64; 2]> = Vec::new();
    for (i, time) in times.iter().enumerate() {
        match pieces.last_mut() {
            Some(piece) if i > 0 && *time >= piece[1] => piece[1] = *time,
            _ => pieces.push([*time; 2]),
        }
    }
    if pieces.len() < 2 {
        return None;
    }
    pieces.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let are_apart = pieces.windows(2).all(|pair| pair[0][1] < pair[1][0]);
    let mut order: Vec<usize> = (0..times.len()).collect();
    order.sort_by(|a, b| times[*a].total_cmp(&times[*b]));
    let way: f64 = x.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
    let by_time: f64 = order.windows(2).map(|pair| (x[pair[1]] - x[pair[0]]).abs()).sum();
    (are_apart || by_time < SHORTER * way).then_some(order)
}

/// Whether x grows from the beginning of `points` to the end.
pub(super) fn rises(points: &[MeasuredPoint]) -> bool {
    let third = (points.len() / 3).max(1);
    let mean = |of: &[MeasuredPoint]| of.iter().map(|point| point.x).sum::<f64>() / of.len().max(1) as f64;
    mean(&points[points.len() - third..]) > mean(&points[..third])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_are_cut_where_x_turns_round() {
        // Three sweeps in and three back, with rows that go back a little.
        let way =
            |i: u32| f64::from(if i % 100 < 50 { i % 100 } else { 100 - i % 100 }) + 3.0 * f64::from(i % 2);
        let point = |i: u32| {
            let row = i as usize + 1;
            MeasuredPoint { x: way(i), force: 0.0, radius: 0.0, time: 0.0, row, at: row }
        };
        let points: Vec<MeasuredPoint> = (0..300).map(point).collect();
        let parts = one_way(&points);
        assert_eq!(
            parts.iter().map(|part| rises(part)).collect::<Vec<_>>(),
            [true, false, true, false, true, false]
        );
        assert_eq!(parts.concat(), points);
        assert!(
            parts.iter().all(|part| part.len().abs_diff(50) <= 3),
            "{:?}",
            parts.iter().map(Vec::len).collect::<Vec<_>>()
        );
        // Rows that rest before they go: the farthest of them is only noise.
        let at_rest = |i: u32| if i < 100 { (f64::from(i) * 2.4).sin() } else { 2.0 * f64::from(i - 100) };
        let points_of = |way: &dyn Fn(u32) -> f64| -> Vec<MeasuredPoint> {
            (0..300).map(|i| MeasuredPoint { x: way(i), ..point(i) }).collect()
        };
        assert_eq!(one_way(&points_of(&at_rest)).len(), 1);
        assert_eq!(one_way(&points_of(&|i| -at_rest(i))).len(), 1);
        // A single sweep has no turn.
        assert_eq!(one_way(&points[..50]).len(), 1);
    }
}
