//! How well the columns are known: σ of x, P and s.
//!
//! ```text
//! σ_P = √(Σ (P_i − P_{i+1})² / 2n)                     of the free part, at least a step of the converter/√12
//! σ_P = median |P_i − line through neighbours| / …      without one, of the rows in contact, over x; of radii with times over these
//! σ_x = max(last digit, √(Σ (x_{i−1} − 2x_i + x_{i+1})² / 6n))        both at least 1e-4 of their range
//! ```
//!
//! The sums leave out what lies far beyond the median: outliers, jumps, ringing. Where x, P and s are all measured, each in contact shows its noise over
//! the number of the row, the time, and the other two: the least of these holds least of the noise of another column, and
//! of uneven steps.

use super::free::OrderedBranch;
use super::noise::{FLOOR, Noise, Origin, median, scatter_over};
use super::points::MeasuredPoint;
use super::speed::noise as noise_in_order;
use crate::elementary::hypot;

/// The fewest steps between rows apart that determine their noise.
const FEWEST_APART: usize = 5;

/// Rows in order whose scatter is larger than this part of that over another column lie unevenly.
const UNEVEN: f64 = 0.8;

/// One column.
type ColumnOf = fn(&MeasuredPoint) -> f64;

/// How much neighbouring rows differ.
#[derive(Default)]
struct Neighbours {
    /// The steps of the force between rows apart.
    forces: Vec<f64>,
    /// The second differences of x of rows apart.
    ways: Vec<f64>,
    /// The scatter of the radii of each branch.
    radii: Vec<f64>,
    /// The scatter of the force of each branch in contact.
    in_contact: Vec<f64>,
    /// That of x, where there are radii beside it.
    ways_in_contact: Vec<f64>,
}

impl Neighbours {
    /// Those of all branches. For radii with times, `has_clock`, the radius and the force each show their own noise over
    /// time, because a clock has none.
    fn of(list: &[OrderedBranch], of_radius: bool, has_clock: bool) -> Self {
        let mut found = Self::default();
        for (branch, in_order) in list {
            // Nothing is known about radii where the bodies are apart. In contact they vary slowly with the quantity
            // they are measured against.
            let touching =
                || in_order.iter().filter(|point| if of_radius { point.x > 0.0 } else { point.radius > 0.0 });
            let over = |x: ColumnOf, y: ColumnOf| {
                let (x, y): (Vec<f64>, Vec<f64>) = touching().map(|point| (x(point), y(point))).unzip();
                scatter_over(&x, &y)
            };
            if !of_radius && touching().next().is_some() {
                let [x, force, radii]: [ColumnOf; 3] =
                    [|point| point.x, |point| point.force, |point| point.radius];
                let least = |y: ColumnOf, others: [ColumnOf; 2]| {
                    let (times, values): (Vec<f64>, Vec<f64>) =
                        touching().map(|point| (point.time, y(point))).unzip();
                    let in_order = Some(noise_in_order(&times, &values)).filter(|_| values.len() > 2);
                    let of_others = others.into_iter().filter_map(|x| over(x, y)).reduce(f64::min);
                    // The least of several is a little too small: rows in order are enough unless they are uneven.
                    of_others.filter(|s| in_order.is_none_or(|own| *s < UNEVEN * own)).or(in_order)
                };
                found.ways_in_contact.extend(least(x, [force, radii]));
                found.in_contact.extend(least(force, [x, radii]));
                found.radii.extend(least(radii, [x, force]));
            } else if has_clock {
                found.radii.extend(over(|point| point.time, |point| point.x));
                found.in_contact.extend(over(|point| point.time, |point| point.force));
            } else {
                let radii = if of_radius { over(|p| p.force, |p| p.x) } else { over(|p| p.x, |p| p.radius) };
                found.radii.extend(radii);
                let (x, force): (Vec<f64>, Vec<f64>) = branch.attached.iter().map(|p| (p.x, p.force)).unzip();
                found.in_contact.extend(scatter_over(&x, &force));
            }
            let mut rows: Vec<usize> = branch.free.iter().map(|point| point.row).collect();
            rows.sort_unstable();
            let free: Vec<&MeasuredPoint> =
                in_order.iter().filter(|point| rows.binary_search(&point.row).is_ok()).collect();
            found.forces.extend(free.windows(2).map(|pair| (pair[1].force - pair[0].force).abs()));
            found
                .ways
                .extend(free.windows(3).map(|three| (three[0].x - 2.0 * three[1].x + three[2].x).abs()));
        }
        found
    }
}

/// The mean square of normal differences, without those far beyond their median, or beyond a few steps of a converter, where the
/// median may be 0; `None` of none.
fn mean_square(differences: &[f64], step: f64) -> Option<f64> {
    /// Standard deviations, beyond which one normal value in two thousand lies.
    const FAR: f64 = 3.5;
    let bound = FAR * (median(differences.iter().map(|x| x.abs()).collect())? / 0.6745).max(step);
    let kept: Vec<f64> = differences.iter().copied().filter(|x| x.abs() <= bound).collect();
    Some(kept.iter().map(|x| x * x).sum::<f64>() / kept.len() as f64)
}

/// σ of x, P and s, the rows in the order of the file.
pub(super) fn noise(
    list: &[OrderedBranch],
    given: [Option<f64>; 3],
    (steps, converter): ([f64; 3], Option<f64>),
    ranges: [f64; 3],
    of_radius: bool,
) -> Noise {
    let touches = |point: &&MeasuredPoint| point.x > 0.0;
    let mut in_touch = list.iter().flat_map(|(_, in_order)| in_order).filter(touches).peekable();
    let has_clock = of_radius && in_touch.peek().is_some() && in_touch.all(|point| point.time.is_finite());
    let Neighbours { forces, ways, radii, in_contact, ways_in_contact } =
        Neighbours::of(list, of_radius, has_clock);
    let radius = radii.into_iter().reduce(f64::min);
    let neighbours = in_contact.into_iter().reduce(f64::min);
    // Few rows apart show nothing: those in contact say more.
    let is_known = forces.len() >= FEWEST_APART || neighbours.is_none();
    let step = converter.unwrap_or(0.0);
    let apart = mean_square(&forces, step).map(|square| (square / 2.0).sqrt()).filter(|_| is_known);
    // The scatter of radii over forces includes that of the force: the two cannot be separated if neither is known.
    let known = apart.is_some() || given[1].is_some() || has_clock;
    let of_ways = || mean_square(&ways, 0.0).map(|square| (square / 6.0).sqrt());
    let ways = if of_radius { radius.filter(|_| known) } else { of_ways() };
    let ways_in_contact = ways_in_contact.into_iter().reduce(f64::min);
    let of = |found: Option<f64>, origin| found.map(|found| (found, origin));
    let found = [
        of(ways, if of_radius { Origin::Neighbours } else { Origin::Apart })
            .or(of(ways_in_contact, Origin::Neighbours)),
        of(apart, Origin::Apart).or(of(neighbours, Origin::Neighbours)),
        of(radius, Origin::Neighbours),
    ];
    let mut noise = Noise { sigma: [0.0; 3], from: [Origin::Assumed; 3], share: 0.0, step };
    for axis in 0..3 {
        let floor = FLOOR * ranges[axis];
        if axis == 2 && floor == 0.0 {
            // There is no such column.
            continue;
        }
        let digits = Some(steps[axis]).filter(|step| step.is_finite()).unwrap_or(0.0);
        let (mut of_data, origin) = found[axis].unwrap_or((0.0, Origin::Assumed));
        // Noise below a step of the converter does not show in differences, because the force is rounded. For rows
        // apart, the squared differences include what rounding adds, unless all rows stand at one step.
        let rounded = step / 12.0_f64.sqrt();
        if axis == 1 && origin == Origin::Apart {
            of_data = of_data.max(rounded);
        } else if axis == 1 && of_data < step {
            of_data = hypot(of_data, rounded);
        }
        let least = floor.max(digits);
        let found = (of_data.max(least), if of_data.max(digits) < floor { Origin::Assumed } else { origin });
        (noise.sigma[axis], noise.from[axis]) = given[axis].map_or(found, |given| (given, Origin::Given));
    }
    noise
}

#[cfg(test)]
mod tests {
    use super::mean_square;
    use crate::gap::shapes::split_mix::SplitMix64;

    #[test]
    fn what_lies_far_from_the_median_is_left_out() {
        let mut random = SplitMix64::new(3);
        // The sum of twelve even numbers is nearly normal, with a variance of 1.
        let mut normal = || (0..12).map(|_| random.unit()).sum::<f64>() - 6.0;
        let mut differences: Vec<f64> = (0..4000).map(|_| normal()).collect();
        let clean = mean_square(&differences, 0.0).unwrap();
        assert!((clean - 1.0).abs() < 0.08, "{clean}");
        for outlier in differences.iter_mut().step_by(30) {
            *outlier = 20.0;
        }
        let found = mean_square(&differences, 0.0).unwrap();
        assert!((found / clean - 1.0).abs() < 0.05, "{found} {clean}");
        // Rows at even steps with one gap among them have no noise.
        assert_eq!(mean_square(&[0.0, 0.0, 5.0, 0.0, 0.0], 0.0), Some(0.0));
        // Of a converter most differences are 0, and the others a step.
        assert_eq!(mean_square(&[0.0, 0.5, 0.0, 0.5, 0.0, 0.0, 0.0, 7.0, 0.0], 0.5), Some(0.0625));
        assert_eq!(mean_square(&[], 0.0), None);
    }
}
