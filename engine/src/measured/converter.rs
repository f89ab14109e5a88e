//! What a converter does to the force: steps, an end of its range; and rows that stand there more than once.

use super::points::MeasuredPoint;

/// Rows that are the row before again are dropped where they are this share of all.
const REPEATED: f64 = 0.3;
/// The same extreme force so many times in a row, or at this share of the rows, is an end of the range.
const IN_A_ROW: usize = 3;
const AT_AN_END: f64 = 0.02;
/// Of a force in steps the extreme step has some rows by itself, but not so many times those of the next one.
const CROWDED: usize = 4;

/// The step of which all differences of the force are multiples; `None` where there is none.
pub(super) fn quantum(force: &[f64]) -> Option<f64> {
    /// Fewer values show no step.
    const VALUES: usize = 8;
    /// A range of more steps is none that a converter has.
    const STEPS: f64 = 1e6;
    /// Differences are multiples to this share of a step.
    const NEAR: f64 = 0.03;
    /// The smallest difference may be so many steps.
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

/// An end of the range of a converter that rows stand at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clipped {
    /// How many rows.
    pub rows: usize,
    /// The force.
    pub force: f64,
    /// Whether it is the smallest, as the signs are put right.
    pub is_low: bool,
}

/// The end of the range at which rows in contact stand; `points` in the order of the file, all of them of branches.
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

/// The points without those that are the one before again, where those are many; how many they were.
pub(super) fn without_repeats(points: &mut Vec<MeasuredPoint>) -> usize {
    let same = |a: &MeasuredPoint, b: &MeasuredPoint| {
        let bits = |p: &MeasuredPoint| [p.x.to_bits(), p.force.to_bits(), p.radius.to_bits()];
        bits(a) == bits(b)
    };
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
        // Rows apart all have one force, and that is no end.
        assert_eq!(clipped(&rows(20.0), &|point| point.force > 20.0, None), None);
        let mut twice: Vec<MeasuredPoint> = rows(-1.0).into_iter().flat_map(|point| [point, point]).collect();
        assert_eq!((without_repeats(&mut twice), twice.len()), (60, 60));
        assert_eq!(without_repeats(&mut twice), 0);
    }
}
