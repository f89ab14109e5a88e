//! Points → branches: approach and retraction, the free part, the jump between them; signs and noise.
//!
//! The free end of a curve is where the force stands still while x goes on. At the other end, in contact, the force rises with
//! x: both together give the signs, δ growing as the bodies are pressed together and P being positive in compression.
//!
//! On a branch, from the contact to the free end, the pull-off is the largest rise from one sample to the next behind the
//! minimum; before it the bodies are attached, behind it free, and samples within the jump are dropped and counted.
//!
//! ```text
//! σ_P = median |P_i − P_{i+1}| / 0.954                 of the free part, for normal noise
//! σ_x = max(last digit, median |x_{i−1} − 2x_i + x_{i+1}| / 1.652)    both at least 1e-4 of their range
//! ```

use super::points::{Abscissa, Points};
use super::role::Segment;
use thiserror::Error;

/// The least noise, as a share of the range: a distance to a curve needs both axes.
pub const FLOOR: f64 = 1e-4;
/// Deviations of the free part beyond so many σ belong to the contact.
const BEYOND: f64 = 6.0;
/// The share of the rows, and the fewest, by which the ends are judged.
const END_SHARE: usize = 40;
const END_ROWS: usize = 5;
/// A free end varies by less than this share of the range, and of the other end.
const FLAT: [f64; 2] = [0.1, 0.3];
/// Steps of x from row to row beyond this share of its range, in the median, are no order.
const UNORDERED: f64 = 0.1;
/// Branches with fewer rows are none.
const FEWEST: usize = 5;

/// Limits of what is used, in the file's own values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// The smallest.
    pub lo: f64,
    /// The largest.
    pub hi: f64,
}

impl Span {
    /// Whether it holds a value.
    pub fn holds(&self, value: f64) -> bool {
        self.lo <= value && value <= self.hi
    }
}

/// What is asked of a file's points.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Asked {
    /// The branch that is used alone.
    pub segment: Option<Segment>,
    /// The range of x, in base units and with the signs of the file.
    pub x: Option<Span>,
    /// The range of P, likewise.
    pub force: Option<Span>,
    /// σ of x, P and s, where they are known.
    pub sigma: [Option<f64>; 3],
}

/// One point, its signs put right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// x.
    pub x: f64,
    /// P.
    pub force: f64,
    /// s, where it is measured beside x; not a number elsewhere.
    pub radius: f64,
    /// The row of the file, from 1, header not counted.
    pub row: usize,
}

/// One branch, from the contact to the free end.
#[derive(Debug, Clone, PartialEq)]
pub struct Branch {
    /// Which.
    pub segment: Segment,
    /// The points in contact.
    pub attached: Vec<Point>,
    /// The points apart.
    pub free: Vec<Point>,
    /// How many samples within the jump were dropped.
    pub dropped: usize,
}

/// How well the columns are known, one standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Of x, P and s.
    pub sigma: [f64; 3],
    /// Whether it was assumed, and neither given nor found in the free part.
    pub assumed: [bool; 3],
}

/// What a file has.
#[derive(Debug, Clone, PartialEq)]
pub struct Branches {
    /// What x is.
    pub abscissa: Abscissa,
    /// The branches, approach first.
    pub list: Vec<Branch>,
    /// How well the columns are known.
    pub noise: Noise,
    /// The median of the free force; `None` without a free part.
    pub baseline: Option<f64>,
    /// Whether the signs of x and P were turned.
    pub turned: [bool; 2],
    /// The ranges of x, P and s over the points that are used.
    pub ranges: [f64; 3],
    /// What was found or assumed, in words.
    pub notes: Vec<String>,
    /// Rows left out: outside the ranges, of pauses or of the other branch.
    pub left_out: usize,
}

/// Why points give no branches.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum BranchError {
    /// Nothing is left.
    #[error(
        "only {0} rows are left after the range and the segment that are asked for; {END_ROWS} are the fewest"
    )]
    Few(usize),
    /// Rows without an order.
    #[error(
        "the rows are in no order: x goes to and fro by {share:.0} % of its range from row to row. Sort them, or name a \
         segment column, the range and the sigmas"
    )]
    Unordered {
        /// The median step of x, in per cent of its range.
        share: f64,
    },
    /// x and P the other way round.
    #[error(
        "the column of the force goes on where x stands still at one end, as the way does where bodies are apart: the columns \
         of x and force look swapped"
    )]
    Swapped,
    /// The branch that is asked for is not there.
    #[error("there is no {0} in the file")]
    NoSegment(&'static str),
}

impl Points {
    /// The branches of these points.
    ///
    /// # Errors
    /// [`BranchError`].
    pub fn branches(&self, asked: &Asked) -> Result<Branches, BranchError> {
        let used: Vec<usize> = (0..self.x.len())
            .filter(|&i| asked.x.is_none_or(|span| span.holds(self.x[i])))
            .filter(|&i| asked.force.is_none_or(|span| span.holds(self.force[i])))
            .filter(|&i| self.segments.as_ref().is_none_or(|of| of[i] != Segment::Other))
            .collect();
        if used.len() < END_ROWS {
            return Err(BranchError::Few(used.len()));
        }
        let mut points: Vec<Point> = used
            .iter()
            .map(|&i| Point {
                x: self.x[i],
                force: self.force[i],
                radius: self.radius.as_ref().map_or(f64::NAN, |s| s[i]),
                row: i + 1,
            })
            .collect();
        let mut notes = Vec::new();
        let of_radius = self.abscissa == Abscissa::Radius;
        let turned = signs(&mut points, self.abscissa, self.segments.as_deref(), &mut notes)?;
        // Of radii, which are zero while apart, none are turned.
        let ordered = asked.sigma[0].is_some() || of_radius;
        let parts = self.parts(points, ordered, &mut notes)?;
        let mut list: Vec<(Branch, Vec<Point>)> = Vec::new();
        let mut left_out = self.x.len() - used.len();
        for (segment, in_order) in parts {
            if asked.segment.is_some_and(|wanted| wanted != segment) {
                left_out += in_order.len();
                continue;
            }
            let branch = branch(segment, &in_order, of_radius);
            list.push((branch, in_order));
        }
        if list.is_empty() {
            return Err(BranchError::NoSegment(asked.segment.map_or("branch", Segment::name)));
        }
        list.sort_by_key(|(branch, _)| branch.segment == Segment::Retraction);
        let used: Vec<&Point> =
            list.iter().flat_map(|(branch, _)| branch.attached.iter().chain(&branch.free)).collect();
        if used.len() < END_ROWS {
            return Err(BranchError::Few(used.len()));
        }
        let ranges = [
            range(used.iter().map(|p| p.x)),
            range(used.iter().map(|p| p.force)),
            range(used.iter().map(|p| p.radius)),
        ];
        let noise = noise(&list, asked, self.steps, ranges);
        let free: Vec<f64> =
            list.iter().flat_map(|(branch, _)| branch.free.iter().map(|p| p.force)).collect();
        let baseline = median(free);
        let list = list.into_iter().map(|(branch, _)| branch).collect();
        Ok(Branches { abscissa: self.abscissa, list, noise, baseline, turned, ranges, notes, left_out })
    }

    /// The branches by the file's word, or by the largest x.
    fn parts(
        &self,
        points: Vec<Point>,
        ordered: bool,
        notes: &mut Vec<String>,
    ) -> Result<Vec<(Segment, Vec<Point>)>, BranchError> {
        if let Some(segments) = &self.segments {
            let mut parts = Vec::new();
            for segment in [Segment::Approach, Segment::Retraction] {
                let part: Vec<Point> =
                    points.iter().filter(|point| segments[point.row - 1] == segment).copied().collect();
                if part.len() >= FEWEST {
                    in_order(&part, ordered)?;
                    parts.push((segment, part));
                }
            }
            return Ok(parts);
        }
        in_order(&points, false)?;
        let most = points.iter().map(|point| point.x).fold(f64::NEG_INFINITY, f64::max);
        let at = points.iter().position(|point| point.x >= most).unwrap_or(0);
        let (before, after) = points.split_at(at);
        let word = |segment: Segment| {
            format!(
                "no column names the branches: by the order of x it is {}",
                match segment {
                    Segment::Approach => "an approach",
                    _ => "a retraction",
                }
            )
        };
        Ok(if before.len() < FEWEST {
            notes.push(word(Segment::Retraction));
            vec![(Segment::Retraction, points)]
        } else if after.len() < FEWEST + 1 {
            notes.push(word(Segment::Approach));
            vec![(Segment::Approach, points)]
        } else {
            notes.push(format!(
                "no column names the branches: approach up to the largest x in row {}, retraction from there",
                points[at].row
            ));
            vec![(Segment::Approach, before.to_vec()), (Segment::Retraction, after.to_vec())]
        })
    }
}

/// Refuses points whose x has no order, unless nothing depends on it.
fn in_order(points: &[Point], indifferent: bool) -> Result<(), BranchError> {
    let whole = range(points.iter().map(|point| point.x));
    let steps: Vec<f64> = points.windows(2).map(|pair| (pair[1].x - pair[0].x).abs() / whole).collect();
    let share = if steps.len() < 20 { 0.0 } else { median(steps).unwrap_or(0.0) };
    if share > UNORDERED && !indifferent {
        Err(BranchError::Unordered { share: 100.0 * share })
    } else {
        Ok(())
    }
}

/// Whether the curve is free at its low end, at its high end: where y stands still while x goes on.
fn free_end(x: &[f64], y: &[f64]) -> [bool; 2] {
    let mut order: Vec<usize> = (0..x.len()).collect();
    order.sort_by(|&a, &b| x[a].total_cmp(&x[b]).then(y[a].total_cmp(&y[b])));
    let spread = |ends: &[usize]| {
        let mut y: Vec<f64> = ends.iter().map(|&i| y[i]).collect();
        y.sort_by(f64::total_cmp);
        let tenth = y.len() / 10;
        y[y.len() - 1 - tenth] - y[tenth]
    };
    let whole = range(y.iter().copied());
    let flat = |here: f64, there: f64| here <= FLAT[0] * whole && here <= FLAT[1] * there;
    // Over many rows noise is told from a slope, over few a short free part from the contact.
    for share in [END_SHARE / 4, END_SHARE] {
        let count = (x.len() / share).max(END_ROWS).min(x.len());
        let (low, high) = (spread(&order[..count]), spread(&order[order.len() - count..]));
        let found = [flat(low, high), flat(high, low)];
        if found != [false; 2] {
            return found;
        }
    }
    [false; 2]
}

/// Turns the signs where the free end and the rise in contact say so; whether x and P were turned.
fn signs(
    points: &mut [Point],
    abscissa: Abscissa,
    segments: Option<&[Segment]>,
    notes: &mut Vec<String>,
) -> Result<[bool; 2], BranchError> {
    let x: Vec<f64> = points.iter().map(|point| point.x).collect();
    let force: Vec<f64> = points.iter().map(|point| point.force).collect();
    let mut turned = [false; 2];
    if abscissa != Abscissa::Radius {
        if stands_still(&x, &force) {
            return Err(BranchError::Swapped);
        }
        match free_end(&x, &force) {
            [true, _] => {}
            [_, true] => turned[0] = true,
            _ => {
                // Without a free end the sense of a way is a matter of the instrument, that of a force is not.
                turned[0] = abscissa == Abscissa::Position && rises(&x, &force) == Some(false);
                notes.push("there is no free part: the signs are taken as they are in the file".to_owned());
            }
        }
        if turned[0] {
            for point in &mut *points {
                point.x = -point.x;
            }
            notes.push(format!("the {} grows as the bodies go apart: its sign is turned", abscissa.name()));
        }
    }
    let x: Vec<f64> = points.iter().map(|point| point.x).collect();
    let (compression, words) = match pulls(points, segments) {
        Some(pulls) => (pulls, "the force is positive before the jump to the free part, where bodies pull"),
        None => (rises(&x, &force) != Some(false), "the force falls as the bodies are pressed together"),
    };
    if !compression {
        turned[1] = true;
        for point in points {
            point.force = -point.force;
        }
        notes.push(format!("{words}: its sign is turned"));
    }
    Ok(turned)
}

/// Whether the force before the jump to the free part is below that of the free part, as it is where bodies pull; `None` without
/// a free part, or where the jump is so small that the rise in contact says more.
fn pulls(points: &[Point], segments: Option<&[Segment]>) -> Option<bool> {
    /// A jump is trusted from this share of the largest force.
    const LARGE: f64 = 0.3;
    /// Rows behind the jump whose median is taken.
    const ROWS: usize = 3;
    let groups: Vec<Vec<Point>> = match segments {
        None => vec![points.to_vec()],
        Some(of) => [Segment::Approach, Segment::Retraction]
            .map(|segment| points.iter().filter(|point| of[point.row - 1] == segment).copied().collect())
            .to_vec(),
    };
    let mut found: Option<f64> = None;
    for mut group in groups {
        group.sort_by(|a, b| b.x.total_cmp(&a.x).then(b.force.total_cmp(&a.force)));
        let (x, force): (Vec<f64>, Vec<f64>) = group.iter().map(|point| (point.x, point.force)).unzip();
        if group.len() < 2 * END_ROWS || !free_end(&x, &force)[0] {
            continue;
        }
        let end = &force[force.len() - (force.len() / END_SHARE).max(END_ROWS)..];
        let limit = BEYOND * noise_of(&force).max(FLOOR * range(force.iter().copied()));
        let base = median(end.to_vec())?;
        let most = force.iter().map(|p| (p - base).abs()).fold(0.0, f64::max);
        let Some(last) = force.iter().rposition(|p| (p - base).abs() > limit) else { continue };
        let behind =
            median(force[(last + 1).saturating_sub(ROWS)..=last].iter().map(|p| p - base).collect())?;
        if behind.abs() > LARGE * most && found.is_none_or(|found| behind.abs() > found.abs()) {
            found = Some(behind);
        }
    }
    found.map(|behind| behind < 0.0)
}

/// Whether x stands still at the beginning or the end of the file while P goes on: a way never does, the force of bodies apart
/// does, but for its noise.
fn stands_still(x: &[f64], force: &[f64]) -> bool {
    /// The share of the rows at either end, and the shares of both ranges there.
    const ROWS: usize = 20;
    const STILL: f64 = 0.015;
    const GOES_ON: f64 = 0.02;
    let count = (x.len() / ROWS).max(END_ROWS).min(x.len());
    let share = |of: &[f64], rows: std::ops::Range<usize>| {
        let (first, last) = of[rows].split_at(count / 2);
        let middles = [first, last].map(|half| median(half.to_vec()).unwrap_or(0.0));
        (middles[0] - middles[1]).abs() / range(of.iter().copied())
    };
    [0..count, x.len() - count..x.len()]
        .into_iter()
        .any(|rows| share(x, rows.clone()) < STILL && share(force, rows) > GOES_ON)
}

/// Whether P rises with x in the outer fifth of x; `None` where it does neither.
fn rises(x: &[f64], force: &[f64]) -> Option<bool> {
    let most = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let whole = range(x.iter().copied());
    let near: Vec<usize> = (0..x.len()).filter(|&i| x[i] >= most - 0.2 * whole).collect();
    let count = near.len().max(1) as f64;
    let [mean_x, mean_p] = [x, force].map(|of| near.iter().map(|&i| of[i]).sum::<f64>() / count);
    let product: f64 = near.iter().map(|&i| (x[i] - mean_x) * (force[i] - mean_p)).sum();
    (product != 0.0).then_some(product > 0.0)
}

/// A branch cut into its parts.
fn branch(segment: Segment, in_order: &[Point], of_radius: bool) -> Branch {
    let mut points = in_order.to_vec();
    // Whatever the order of the file.
    points.sort_by(|a, b| b.x.total_cmp(&a.x).then(b.force.total_cmp(&a.force)));
    if of_radius {
        let (free, attached) = points.into_iter().partition(|point| point.x <= 0.0);
        return Branch { segment, attached, free, dropped: 0 };
    }
    let (x, force): (Vec<f64>, Vec<f64>) = points.iter().map(|point| (point.x, point.force)).unzip();
    if points.len() < 2 * END_ROWS || !free_end(&x, &force)[0] {
        return Branch { segment, attached: points, free: Vec::new(), dropped: 0 };
    }
    let count = (points.len() / END_SHARE).max(END_ROWS);
    let end = &force[force.len() - count..];
    let whole = range(force.iter().copied());
    let limit = BEYOND * noise_of(&force).max(FLOOR * whole);
    let goes_on = trends(&force);
    // Without single rows that are off: a median keeps the place of a step.
    let force = filtered(&force);
    let least = (0..force.len()).min_by(|&a, &b| force[a].total_cmp(&force[b])).unwrap_or(0);
    let rise = |i: usize| force[i + 1] - force[i];
    let jump = (least..force.len() - 1).max_by(|&a, &b| rise(a).total_cmp(&rise(b)).then(b.cmp(&a)));
    if let Some(jump) = jump.filter(|&jump| rise(jump) > limit) {
        let rest = points.split_off(jump + 1);
        let line = Line::of(&rest);
        let within = rest.iter().position(|point| point.force >= line.at(point.x) - limit);
        let dropped = within.unwrap_or(0);
        return Branch { segment, attached: points, free: rest[dropped..].to_vec(), dropped };
    }
    if goes_on {
        return Branch { segment, attached: points, free: Vec::new(), dropped: 0 };
    }
    // Without a jump the free part ends where three rows in a row are off.
    let base = median(end.to_vec()).unwrap_or(0.0);
    let mut off = 0;
    let mut at = force.len();
    while at > 0 && off < 3 {
        at -= 1;
        off = if (force[at] - base).abs() > limit { off + 1 } else { 0 };
    }
    let free = points.split_off((at + off).min(points.len()));
    Branch { segment, attached: points, free, dropped: 0 }
}

/// The running median of five, of fewer at the ends.
fn filtered(values: &[f64]) -> Vec<f64> {
    let around = |i: usize| &values[i.saturating_sub(2)..(i + 3).min(values.len())];
    (0..values.len()).map(|i| median(around(i).to_vec()).unwrap_or(values[i])).collect()
}

/// The last tenth of the rows.
fn tenth(force: &[f64]) -> &[f64] {
    &force[force.len() - (force.len() / 10).max(6).min(force.len())..]
}

/// Whether the force still goes on at the end, as it does where a file ends before the pull-off: the medians of the thirds of the
/// last tenth differ by more than noise.
fn trends(force: &[f64]) -> bool {
    let end = tenth(force);
    let thirds: Vec<f64> =
        end.chunks((end.len() / 3).max(1)).take(3).filter_map(|part| median(part.to_vec())).collect();
    range(thirds.iter().copied()) > 2.0 * noise_of(force) + FLOOR * range(force.iter().copied())
}

/// The line through a free part, by the medians of its halves.
struct Line {
    base: f64,
    slope: f64,
}

impl Line {
    fn of(points: &[Point]) -> Self {
        let half = points.len() / 2;
        let of = |part: &[Point], get: fn(&Point) -> f64| median(part.iter().map(get).collect());
        let (near, far) = points.split_at(half);
        let ends = [near, far].map(|part| Some([of(part, |p| p.x)?, of(part, |p| p.force)?]));
        let whole = of(points, |p| p.force).unwrap_or(0.0);
        match ends {
            [Some([x0, p0]), Some([x1, p1])] if points.len() >= 4 * END_ROWS && x0 > x1 => {
                let slope = (p1 - p0) / (x1 - x0);
                Self { base: p0 - slope * x0, slope }
            }
            _ => Self { base: whole, slope: 0.0 },
        }
    }

    fn at(&self, x: f64) -> f64 {
        self.base + self.slope * x
    }
}

/// σ of normal noise at the free end of a branch. Of few rows there it is known badly, of all rows never too low.
fn noise_of(force: &[f64]) -> f64 {
    scatter(tenth(force)).min(scatter(force))
}

/// σ of normal noise on what varies slowly from row to row.
fn scatter(values: &[f64]) -> f64 {
    median(values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect()).unwrap_or(0.0) / 0.954
}

/// σ of x, P and s, the rows in the order of the file.
fn noise(list: &[(Branch, Vec<Point>)], asked: &Asked, steps: [f64; 3], ranges: [f64; 3]) -> Noise {
    let (mut forces, mut ways) = (Vec::new(), Vec::new());
    for (branch, in_order) in list {
        let mut rows: Vec<usize> = branch.free.iter().map(|point| point.row).collect();
        rows.sort_unstable();
        let free: Vec<&Point> =
            in_order.iter().filter(|point| rows.binary_search(&point.row).is_ok()).collect();
        forces.extend(free.windows(2).map(|pair| (pair[1].force - pair[0].force).abs()));
        ways.extend(free.windows(3).map(|three| (three[0].x - 2.0 * three[1].x + three[2].x).abs()));
    }
    let found = [median(ways).map(|way| way / 1.652), median(forces).map(|step| step / 0.954), None];
    let mut noise = Noise { sigma: [0.0; 3], assumed: [false; 3] };
    for axis in 0..3 {
        let floor = FLOOR * ranges[axis];
        if axis == 2 && floor == 0.0 {
            // There is no such column.
            continue;
        }
        let digits = Some(steps[axis]).filter(|step| step.is_finite()).unwrap_or(0.0);
        let of_data = found[axis].unwrap_or(0.0).max(digits);
        (noise.sigma[axis], noise.assumed[axis]) = match asked.sigma[axis] {
            Some(given) => (given, false),
            None => (of_data.max(floor), of_data < floor || found[axis].is_none()),
        };
    }
    noise
}

/// The median; `None` of nothing.
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

/// The range of what is a number.
fn range(values: impl Iterator<Item = f64>) -> f64 {
    let [lo, hi] = values
        .filter(|x| x.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], x| [lo.min(x), hi.max(x)]);
    (hi - lo).max(0.0)
}
