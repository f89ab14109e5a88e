//! What a converter does to the force: steps and an end of its range; and rows that are recorded more than once.

use super::points::MeasuredPoint;
use super::role::Segment;
use std::collections::HashSet;

/// Rows that repeat the row before are dropped if they make up this share of all rows.
const REPEATED: f64 = 0.3;
/// The same extreme force this many times in a row, or in this share of the rows, is an end of the range.
const IN_A_ROW: usize = 3;
const AT_AN_END: f64 = 0.02;
/// If the force has steps, the extreme step has some rows anyway, but not this many times the rows of the next step.
const CROWDED: usize = 4;

/// The step of which all differences of the force are multiples, or `None`.
pub(super) fn quantum(force: &[f64]) -> Option<f64> {
    /// Fewer values show no step.
    const VALUES: usize = 8;
    /// No converter has a range of more steps than this.
    const STEPS: f64 = 1e6;
    /// Differences are multiples of the step to within this share of a step.
    const NEAR: f64 = 0.03;
    /// The smallest difference may be up to this many steps.
    const MOST: u32 = 4;
    let mut values = force.to_vec();
    values.sort_by(f64::total_cmp);
    let (first, whole) = (*values.first()?, values.last()? - values.first()?);
    values.dedup_by(|a, b| (*a - *b).abs() <= whole / STEPS);
    let gaps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let least = gaps.fold(f64::INFINITY, f64::min);
    if values.len() < VALUES || least < 10.0 * whole / STEPS {
        return None;
    }
    (1..=MOST).map(|count| least / f64::from(count)).find(|step| {
        let off = |value: &f64| {
            let steps = (value - first) / step;
            (steps - steps.round()).abs() <= NEAR
        };
        values.iter().all(off)
    })
}

/// An end of a converter's range at which rows lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clipped {
    /// How many rows.
    pub rows: usize,
    /// The force.
    pub force: f64,
    /// Whether it is the smallest force, once the signs are corrected.
    pub is_low: bool,
}

/// The end of the range at which rows in contact lie; `points` are in the order of the file, and all belong to
/// branches.
pub(super) fn clipped(
    points: &[MeasuredPoint],
    is_attached: &dyn Fn(&MeasuredPoint) -> bool,
    step: Option<f64>,
) -> Option<Clipped> {
    let force = |end: fn(f64, f64) -> f64, from: f64| points.iter().map(|point| point.force).fold(from, end);
    let (lo, hi) = (force(f64::min, f64::INFINITY), force(f64::max, f64::NEG_INFINITY));
    let same = 1e-9 * (hi - lo);
    let at = |end: f64, off: f64| points.iter().filter(move |p| (p.force - end).abs() <= same.max(off));
    let look = |end: f64, is_low: bool| {
        let rows = at(end, 0.0).filter(|point| is_attached(point)).count();
        let (mut run, mut longest) = (0, 0);
        for point in points {
            run = if (point.force - end).abs() <= same && is_attached(point) { run + 1 } else { 0 };
            longest = longest.max(run);
        }
        let many = longest >= IN_A_ROW || (rows >= IN_A_ROW && rows as f64 > AT_AN_END * points.len() as f64);
        let crowded = step.is_none_or(|step| {
            let next = at(end, 1.5 * step).count() - at(end, 0.0).count();
            rows > CROWDED * next.max(1)
        });
        (many && crowded).then_some(Clipped { rows, force: end, is_low })
    };
    look(lo, true).or_else(|| look(hi, false))
}

/// Fewer rows may be equal by chance.
const FEWEST: usize = 10;

/// Whether two points are the same, but for their times and rows.
fn same(a: &MeasuredPoint, b: &MeasuredPoint) -> bool {
    bits(a) == bits(b)
}

fn bits(point: &MeasuredPoint) -> [u64; 3] {
    [point.x, point.force, point.radius].map(f64::to_bits)
}

/// Removes what repeats the rows before it as a whole, as of a record that is pasted twice; returns how many rows that were. No
/// second measurement has the same noise.
pub(super) fn without_copies(points: &mut Vec<MeasuredPoint>) -> usize {
    let count = points.len();
    // How many points before and including each are also the first ones: by these the shortest period is found in one pass.
    let mut borders = vec![0; count];
    for i in 1..count {
        let mut length: usize = borders[i - 1];
        while length > 0 && !same(&points[i], &points[length]) {
            length = borders[length - 1];
        }
        borders[i] = length + usize::from(same(&points[i], &points[length]));
    }
    let period = count - borders.last().copied().unwrap_or(0);
    // Rows that stand still, or go to and fro between two steps of a converter, are no copies.
    let distinct = |of: &[MeasuredPoint]| of.iter().map(bits).collect::<HashSet<_>>().len();
    if 2 * period > count || period < FEWEST || distinct(&points[..period]) < FEWEST {
        return 0;
    }
    points.truncate(period);
    count - period
}

/// The same of the parts of a record in each direction, and of rows within one; returns how many rows that were.
pub(super) fn without_copied_parts(parts: &mut Vec<(Segment, Vec<MeasuredPoint>)>) -> usize {
    let all =
        |parts: &[(Segment, Vec<MeasuredPoint>)]| parts.iter().map(|(_, part)| part.len()).sum::<usize>();
    let before = all(parts);
    for (_, part) in parts.iter_mut() {
        without_copies(part);
    }
    let is_copy = |a: &[MeasuredPoint], b: &[MeasuredPoint]| {
        a.len() >= FEWEST && a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b))
    };
    let mut kept: Vec<(Segment, Vec<MeasuredPoint>)> = Vec::new();
    for (segment, part) in parts.drain(..) {
        if !kept.iter().any(|(of, other)| *of == segment && is_copy(other, &part)) {
            kept.push((segment, part));
        }
    }
    *parts = kept;
    before - all(parts)
}

/// Removes the points that repeat the one before, if there are many of them; returns how many there were.
pub(super) fn without_repeats(points: &mut Vec<MeasuredPoint>) -> usize {
    let repeated = points.windows(2).filter(|pair| same(&pair[0], &pair[1])).count();
    if (repeated as f64) < REPEATED * points.len() as f64 {
        return 0;
    }
    points.dedup_by(|b, a| same(a, b));
    repeated
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_that_is_pasted_several_times_counts_once() {
        let one = |i: usize| MeasuredPoint {
            x: i as f64,
            force: (i * i % 7) as f64,
            radius: f64::NAN,
            time: f64::NAN,
            row: i + 1,
            at: i + 1,
        };
        let record = |rows: std::ops::Range<usize>| -> Vec<MeasuredPoint> { rows.map(one).collect() };
        for times in [1, 2, 3] {
            let mut points = record(0..30).repeat(times);
            assert_eq!((without_copies(&mut points), points.len()), (30 * (times - 1), 30));
        }
        // One row differs, and nothing but the force is the same.
        let mut points = record(0..30).repeat(2);
        points[40].force += 1e-9;
        assert_eq!(without_copies(&mut points), 0);
        let mut still = vec![one(3); 40];
        assert_eq!(without_copies(&mut still), 0);
    }

    #[test]
    fn steps_ends_of_the_range_and_repeated_rows_are_seen() {
        let steps: Vec<f64> = (0..50_u32).map(|i| 0.25 + 0.03 * f64::from(i * i % 37)).collect();
        assert!((quantum(&steps).unwrap() - 0.03).abs() < 1e-9);
        let smooth: Vec<f64> = (0..50_u32).map(|i| f64::from(i).sqrt()).collect();
        assert_eq!(quantum(&smooth), None);
        let point = |(i, force): (usize, f64)| MeasuredPoint {
            x: i as f64,
            force,
            radius: 0.0,
            time: f64::NAN,
            row: i + 1,
            at: i + 1,
        };
        let rows = |least: f64| -> Vec<MeasuredPoint> {
            let force = (0..60_u32).map(|i| (f64::from(i) - 30.3).powi(2));
            force.map(|force| force.max(least)).enumerate().map(point).collect()
        };
        assert_eq!(clipped(&rows(-1.0), &|_| true, None), None);
        let found = clipped(&rows(20.0), &|_| true, None).unwrap();
        assert_eq!((found.rows, found.is_low), (9, true));
        // All rows apart have one force, but that is no end of the range.
        assert_eq!(clipped(&rows(20.0), &|point| point.force > 20.0, None), None);
        let mut twice: Vec<MeasuredPoint> = rows(-1.0).into_iter().flat_map(|point| [point, point]).collect();
        assert_eq!((without_repeats(&mut twice), twice.len()), (60, 60));
        assert_eq!(without_repeats(&mut twice), 0);
    }
}
