//! The rows of one branch: G of each, of several contacts with its force and approach the one among its neighbours, and
//! the speed of the edge.

use super::reading::{MeasuredPair, Released, RowReading};
use crate::elementary::hypot;
use crate::measured::branches::MeasuredPoint;
use crate::measured::speed::{Speed, noise, speeds};
use crate::measured::{MeasuredBranch, Segment};
use serde::Serialize;

/// One row in contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct SpeedRow {
    /// When it was taken, in seconds, or in reduced units; null where the file does not say.
    pub time: Option<f64>,
    /// s, measured, or from force and approach.
    pub contact_radius: f64,
    /// −ds/dt: positive where the contact recedes; null without times.
    pub speed: Option<f64>,
    /// G; negative where the edge is pressed, K < 0.
    pub energy_release_rate: f64,
    /// The standard deviation of G, from the noise of the columns.
    pub error: f64,
    /// The standard deviation of the speed, from the noise of the contact radius.
    pub speed_error: Option<f64>,
    /// The number of rows in the window from which the speed is found.
    pub window: Option<usize>,
    /// `approach` or `retraction`.
    pub segment: &'static str,
    /// Its number among the rows that are read, from 1.
    pub row: usize,
}

/// The rows of one branch with their G, in the order of measurement.
pub(super) struct BranchReading {
    found: Vec<(MeasuredPoint, Released)>,
    segment: Segment,
    /// How many of them could be in another contact.
    pub(super) ambiguous: usize,
    /// How many are left out, as the contact among their neighbours is not one of theirs.
    pub(super) hidden: usize,
    /// How often the radius jumps against the direction of the branch.
    pub(super) contrary: usize,
}

impl BranchReading {
    /// Of several contacts of a row, those are taken between which the radius jumps least over the branch.
    pub(super) fn of(reading: &RowReading, branch: &MeasuredBranch) -> Self {
        let mut points = branch.attached.clone();
        points.sort_by_key(|point| point.at);
        if reading.pair != MeasuredPair::ForceApproach {
            let found = points.into_iter().filter_map(|point| Some((point, reading.released(&point)?)));
            let found = found.collect();
            return Self { found, segment: branch.segment, ambiguous: 0, hidden: 0, contrary: 0 };
        }
        let mut rows: Vec<(MeasuredPoint, Vec<Released>)> =
            points.into_iter().map(|point| (point, reading.all_released(&point))).collect();
        rows.retain(|(_, released)| !released.is_empty());
        let candidates = |(point, all): &(MeasuredPoint, Vec<Released>)| {
            let holds = |released: &Released| all.len() < 2 || reading.stays_apart(point, released);
            let one = |of: &Released| PossibleContact {
                radius: of.contact_radius,
                spread: of.spread,
                holds: holds(of),
            };
            all.iter().map(one).collect()
        };
        let all: Vec<Vec<PossibleContact>> = rows.iter().map(candidates).collect();
        let taken = steadiest(&all);
        // Where another contact could be, only the neighbours tell.
        let is_open = |(row, taken): &&(usize, usize)| {
            all[*row].iter().enumerate().any(|(at, candidate)| at != *taken && candidate.holds)
        };
        let released = |(row, taken): &(usize, usize)| {
            let (point, released) = &rows[*row];
            (*point, released[*taken])
        };
        Self {
            found: taken.iter().map(released).collect(),
            segment: branch.segment,
            ambiguous: taken.iter().filter(is_open).count(),
            hidden: rows.len() - taken.len(),
            contrary: contrary(&all, &taken, branch.segment),
        }
    }

    /// The rows with their speeds, and the noise of their contact radii.
    pub(super) fn rows(self) -> (Vec<SpeedRow>, Option<f64>) {
        let Self { found, segment, .. } = self;
        let is_timed = found.iter().all(|(point, _)| point.time.is_finite());
        let radii: Vec<f64> = found.iter().map(|(_, released)| released.contact_radius).collect();
        let numbers: Vec<f64> = (0..found.len()).map(|i| i as f64).collect();
        let times: Vec<f64> =
            if is_timed { found.iter().map(|(point, _)| point.time).collect() } else { numbers };
        let sigma = noise(&times, &radii);
        let speeds = if is_timed { speeds(&times, &radii, sigma) } else { vec![None; found.len()] };
        let row = |((point, released), speed): (&(MeasuredPoint, Released), Option<Speed>)| SpeedRow {
            time: is_timed.then_some(point.time),
            contact_radius: released.contact_radius,
            speed: speed.map(|speed| -speed.value),
            energy_release_rate: released.energy,
            error: hypot(released.error, released.by_radius * sigma),
            speed_error: speed.map(|speed| speed.error),
            window: speed.map(|speed| speed.rows),
            segment: segment.name(),
            row: point.row,
        };
        let rows = found.iter().zip(speeds).map(row).collect();
        (rows, Some(sigma).filter(|_| !found.is_empty()))
    }
}

/// A contact that a row may have.
struct PossibleContact {
    radius: f64,
    /// The standard deviation of the radius.
    spread: f64,
    /// Whether the bodies stay apart around it.
    holds: bool,
}

/// The least way of the jumps up to a candidate, and the row and its candidate that it comes from.
type WayTo = (f64, Option<(usize, usize)>);

/// The largest step between two contacts that may be noise.
fn noise_of(a: &PossibleContact, b: &PossibleContact) -> f64 {
    /// In standard deviations.
    const NOISE: f64 = 4.0;
    NOISE * hypot(a.spread, b.spread)
}

/// The distance of a candidate from the nearest other one of its row; infinite where it is the only one.
fn alone(of_row: &[PossibleContact], at: usize) -> f64 {
    let others = of_row.iter().enumerate().filter(|(other, _)| *other != at);
    others.map(|(_, other)| (other.radius - of_row[at].radius).abs()).fold(f64::INFINITY, f64::min)
}

/// The least distance between two contacts of a row; infinite where no row has several.
fn least_distance(rows: &[Vec<PossibleContact>]) -> f64 {
    rows.iter().map(|of_row| alone(of_row, 0)).fold(f64::INFINITY, f64::min)
}

/// How often the radius jumps outward on a retraction, or inward on an approach, by at least half the least distance
/// between two contacts of a row: an edge does not, so noise has taken the contact of some rows away.
fn contrary(rows: &[Vec<PossibleContact>], taken: &[(usize, usize)], segment: Segment) -> usize {
    let least = least_distance(rows);
    let found: Vec<&PossibleContact> = taken.iter().map(|(row, at)| &rows[*row][*at]).collect();
    let jumps = |pair: &&[&PossibleContact]| {
        let outward = pair[1].radius - pair[0].radius;
        let contrary = if segment == Segment::Retraction { outward } else { -outward };
        // Where the edge hardly pulls, the radius is known so badly that any jump would be noise.
        let surer = if pair[0].spread < pair[1].spread { pair[0] } else { pair[1] };
        contrary > (0.5 * least).max(noise_of(surer, surer))
    };
    found.windows(2).filter(jumps).count()
}

/// The numbers of rows, and for each that of the candidate with which the radius jumps least over all rows; of equals the
/// largest.
///
/// A radius does not jump by less than half its distance from the others of both rows, or than its noise: a sum of all
/// steps would only find the one that depends least on the noise. One that overlaps in all rows where another does not costs a
/// jump of its own size: a state that cannot last may still be passed through. A row is left out where that is cheaper than
/// a jump away and back: noise has taken its contact.
fn steadiest(rows: &[Vec<PossibleContact>]) -> Vec<(usize, usize)> {
    /// The most neighbouring rows that are left out; half of all have lost their contact where noise is largest.
    const MOST: usize = 20;
    // To leave all rows out would cost one jump. One that stays is not avoided by that at any price.
    let price = least_distance(rows) / rows.len() as f64;
    // To each candidate of a row.
    let mut ways: Vec<Vec<WayTo>> = Vec::new();
    for (i, of_row) in rows.iter().enumerate() {
        let any_holds = of_row.iter().any(|candidate| candidate.holds);
        let way = |to: usize| {
            let b = &of_row[to];
            let from = |row: usize, at: usize| {
                let a = &rows[row][at];
                let step = (b.radius - a.radius).abs();
                let is_near = step < 0.5 * alone(&rows[row], at).min(alone(of_row, to));
                let jump = if is_near { 0.0 } else { (step - noise_of(a, b)).max(0.0) };
                let skipped = i - row - 1;
                let left_out = if skipped == 0 { 0.0 } else { price * skipped as f64 };
                (ways[row][at].0 + jump + left_out, Some((row, at)))
            };
            let earlier = (i.saturating_sub(MOST + 1)..i).rev();
            let ways = earlier.flat_map(|row| (0..rows[row].len()).rev().map(move |at| (row, at)));
            let least = ways.map(|(row, at)| from(row, at)).min_by(|a, b| a.0.total_cmp(&b.0));
            let (way, from) = least.unwrap_or((0.0, None));
            let overlaps = any_holds && !b.holds;
            (way + if overlaps { b.radius / rows.len() as f64 } else { 0.0 }, from)
        };
        let ways_of_row = (0..of_row.len()).map(way).collect();
        ways.push(ways_of_row);
    }
    let least = |ways: &Vec<WayTo>| (0..ways.len()).rev().min_by(|a, b| ways[*a].0.total_cmp(&ways[*b].0));
    let last = ways.last().and_then(least).map(|at| (ways.len() - 1, at));
    let mut taken: Vec<_> = std::iter::successors(last, |(row, at)| ways[*row][*at].1).collect();
    taken.reverse();
    taken
}

#[cfg(test)]
mod tests {
    use super::{PossibleContact, Segment, contrary, steadiest};

    /// Rows of candidates with these radii, all admissible and with the noise 0.01.
    fn all_taken(rows: &[Vec<f64>]) -> Vec<(usize, usize)> {
        let candidate = |radius: &f64| PossibleContact { radius: *radius, spread: 0.01, holds: true };
        steadiest(&rows.iter().map(|row| row.iter().map(candidate).collect()).collect::<Vec<_>>())
    }

    /// As [`all_taken`], where no row is left out.
    fn taken(rows: &[Vec<f64>]) -> Vec<usize> {
        let found = all_taken(rows);
        assert!(found.iter().map(|(row, _)| *row).eq(0..rows.len()));
        found.into_iter().map(|(_, at)| at).collect()
    }

    #[test]
    fn a_row_whose_contact_noise_takes_away_is_left_out() {
        let row = |i: usize| match i {
            0 | 99 => vec![2.0],
            40..45 | 60 => vec![1.0],
            _ => vec![1.0, 2.0],
        };
        let rows: Vec<_> = (0..100).map(row).collect();
        let left: Vec<usize> = (0..100).filter(|i| !(40..45).contains(i) && *i != 60).collect();
        assert_eq!(all_taken(&rows), left.into_iter().map(|i| (i, rows[i].len() - 1)).collect::<Vec<_>>());
        // A jump that stays is one, even if soon another one follows, and at the last row.
        let wide = |i: usize| 5.0 - [2, 4, 99].iter().filter(|from| i >= **from).count() as f64;
        let snaps = |i: usize| if i == 0 { vec![5.0] } else { vec![wide(i), 0.5] };
        assert_eq!(taken(&(0..100).map(snaps).collect::<Vec<_>>()), [0; 100]);
    }

    #[test]
    fn the_radius_jumps_least_over_all_rows() {
        // Step by step the radius would go from 3 to 3.2, and back.
        assert_eq!(taken(&[vec![3.0], vec![2.9, 3.2], vec![2.8], vec![1.0, 2.7]]), [0, 0, 0, 1]);
        assert_eq!(taken(&[vec![5.0], vec![1.0, 4.0, 9.0]]), [0, 1]);
        // Nothing tells these apart.
        assert_eq!(taken(&[vec![1.0, 2.0], vec![1.1, 2.1]]), [1, 1]);
        assert!(taken(&[]).is_empty());
    }

    #[test]
    fn a_radius_that_hardly_depends_on_the_noise_is_not_taken_for_that() {
        // Both ends of the branch are at 2, and 1 lies in between as well.
        let noise = |i: usize| if i.is_multiple_of(2) { 0.1 } else { -0.1 };
        let row = |i: usize| {
            let wide = 2.0 + noise(i);
            if (20..4000).contains(&i) { vec![1.0 + 0.01 * noise(i), wide] } else { vec![wide] }
        };
        let rows: Vec<_> = (0..4200).map(row).collect();
        assert!(taken(&rows).iter().zip(&rows).all(|(taken, row)| *taken + 1 == row.len()));
    }

    #[test]
    fn a_jump_against_the_direction_of_the_branch_is_counted() {
        let one = |radius| PossibleContact { radius, spread: 0.01, holds: true };
        let rows = |radii: &[&[f64]]| -> Vec<Vec<PossibleContact>> {
            radii.iter().map(|row| row.iter().copied().map(one).collect()).collect()
        };
        let at = |taken: &[usize]| taken.iter().copied().enumerate().collect::<Vec<_>>();
        // The third row has lost the contact at 2.
        let all = rows(&[&[1.0, 2.0], &[1.0, 2.0], &[1.0], &[1.0, 2.0], &[1.9]]);
        assert_eq!(contrary(&all, &at(&[1, 1, 0, 1, 0]), Segment::Retraction), 1);
        // A snap inward, and the same on an approach.
        assert_eq!(contrary(&all, &at(&[1, 0, 0, 0, 0]), Segment::Retraction), 1);
        assert_eq!(contrary(&all[..4], &at(&[1, 0, 0, 0]), Segment::Retraction), 0);
        assert_eq!(contrary(&all[..4], &at(&[1, 0, 0, 0]), Segment::Approach), 1);
        // With one contact at every row there is nothing to mistake.
        assert_eq!(contrary(&rows(&[&[2.0], &[1.0], &[2.0]]), &at(&[0, 0, 0]), Segment::Retraction), 0);
    }

    #[test]
    fn an_overlap_is_passed_through_but_does_not_last() {
        let with = |overlapping: usize| {
            let row = |i: usize| {
                let one = |radius, holds| PossibleContact { radius, spread: 0.01, holds };
                if i < overlapping { vec![one(1.0, true), one(2.0, false)] } else { vec![one(2.0, true)] }
            };
            steadiest(&(0..100).map(row).collect::<Vec<_>>())[0].1
        };
        assert_eq!([with(10), with(90)], [1, 0]);
    }
}
