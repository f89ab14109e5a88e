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
//! σ_P = median |P_i − line through neighbours| / …      without one, of the rows in contact
//! σ_x = max(last digit, median |x_{i−1} − 2x_i + x_{i+1}| / 1.652)    both at least 1e-4 of their range
//! ```

use super::apart::jump;
use super::converter::{Clipped, clipped, quantum, without_repeats};
pub use super::noise::FLOOR;
pub(crate) use super::noise::median;
use super::noise::{BEYOND, END_ROWS, END_SHARE, noise_of, range, scatter_over};
pub use super::points::Point;
use super::points::{Abscissa, Points, Turned, turn};
use super::role::Segment;
use super::signs::{free_end, signs};
use super::turns::{one_way, rises, runs};
use crate::elementary::hypot;
use serde::Serialize;
use thiserror::Error;

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
    /// Whether the signs of x and P are turned, where a person says it.
    pub turned: Option<Turned>,
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

/// Where a standard deviation is from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// A person gave it.
    Given,
    /// The rows apart.
    Apart,
    /// What neighbouring rows in contact differ by.
    Neighbours,
    /// The last digit, or the least share of the range.
    #[default]
    Assumed,
}

/// How well the columns are known, one standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Of x, P and s.
    pub sigma: [f64; 3],
    /// Where each is from.
    pub from: [Origin; 3],
    /// The step of the converter of the force; 0 where none is seen.
    pub step: f64,
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
    /// Rows left out: outside the ranges, of pauses, of the other branch, or the row before again.
    pub left_out: usize,
    /// The end of the range of a converter at which rows in contact stand.
    pub clipped: Option<Clipped>,
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
        let repeated = without_repeats(&mut points);
        if repeated > 0 {
            notes.push(format!("{repeated} rows are the row before again, and are left out"));
        }
        let of_radius = self.abscissa == Abscissa::Radius;
        let segments = self.segments.as_deref();
        let is_in_order = disorder(&points, segments) <= UNORDERED;
        let turned = match asked.turned {
            Some(turned) => {
                turn(&mut points, turned);
                turned
            }
            None => signs(&mut points, self.abscissa, segments, is_in_order, &mut notes)
                .ok_or(BranchError::Swapped)?,
        };
        // Of radii, which are zero while apart, none are turned.
        let ordered = asked.sigma[0].is_some() || of_radius;
        let parts = self.parts(&points, ordered, &mut notes)?;
        let mut list: Vec<(Branch, Vec<Point>)> = Vec::new();
        let mut left_out = self.x.len() - used.len() + repeated;
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
        let step = quantum(&self.force);
        let noise = noise(&list, asked, (self.steps, step), ranges, of_radius);
        same_free_force(&mut list, &noise, &mut notes);
        for (branch, _) in &mut list {
            branch.clears_jump(&noise);
        }
        let free: Vec<f64> =
            list.iter().flat_map(|(branch, _)| branch.free.iter().map(|p| p.force)).collect();
        let baseline = median(free);
        let mut rows: Vec<Point> = list.iter().flat_map(|(_, in_order)| in_order.iter().copied()).collect();
        rows.sort_by_key(|point| point.row);
        let list: Vec<Branch> = list.into_iter().map(|(branch, _)| branch).collect();
        let mut attached: Vec<usize> = list.iter().flat_map(|b| b.attached.iter().map(|p| p.row)).collect();
        attached.sort_unstable();
        let clipped = clipped(&rows, &|point| attached.binary_search(&point.row).is_ok(), step);
        one_sided(&list, &mut notes);
        let abscissa = self.abscissa;
        Ok(Branches { abscissa, list, noise, baseline, turned, ranges, notes, left_out, clipped })
    }

    /// The branches by the file's word, or by the largest x.
    fn parts(
        &self,
        points: &[Point],
        ordered: bool,
        notes: &mut Vec<String>,
    ) -> Result<Vec<(Segment, Vec<Point>)>, BranchError> {
        let mut parts = Vec::new();
        if let Some(segments) = &self.segments {
            for segment in [Segment::Approach, Segment::Retraction] {
                for run in runs(points, segments, segment).into_iter().filter(|run| run.len() >= FEWEST) {
                    in_order(&run, ordered)?;
                    parts.push((segment, run));
                }
            }
        } else {
            in_order(points, false)?;
            let found = one_way(points).into_iter().filter(|part| part.len() >= FEWEST);
            parts.extend(
                found.map(|part| (if rises(&part) { Segment::Approach } else { Segment::Retraction }, part)),
            );
        }
        notes.extend(self.order(&parts));
        Ok(parts)
    }

    /// What the branches are taken from, in words.
    fn order(&self, parts: &[(Segment, Vec<Point>)]) -> Option<String> {
        let count = |segment| parts.iter().filter(|(of, _)| *of == segment).count();
        let counts = [count(Segment::Approach), count(Segment::Retraction)];
        let first = |at: usize| parts[at].1.first().map_or(0, |point| point.row);
        match (&self.segments, counts) {
            (Some(_), [0 | 1, 0 | 1]) => None,
            (None, [1, 0]) => {
                Some("no column names the branches: by the order of x it is an approach".to_owned())
            }
            (None, [0, 1]) => {
                Some("no column names the branches: by the order of x it is a retraction".to_owned())
            }
            (None, [1, 1]) if parts[0].0 == Segment::Approach => Some(format!(
                "no column names the branches: approach up to the largest x in row {}, retraction from there",
                first(1)
            )),
            (None, [1, 1]) => Some(format!(
                "no column names the branches: the retraction comes first, the approach begins at the smallest x in row {}",
                first(1)
            )),
            (_, [approaches, retractions]) => Some(format!(
                "the rows are of several loops: {approaches} approaches and {retractions} retractions are fitted together"
            )),
        }
    }
}

/// Takes rows for rows in contact whose force stands still, but not where it does on the branch that has most rows apart: a record that
/// ends near its smallest force looks like that.
fn same_free_force(list: &mut [(Branch, Vec<Point>)], noise: &Noise, notes: &mut Vec<String>) {
    /// Levels are one within so many of their errors, and this share of the range of the branch.
    const SAME: f64 = 6.0;
    const SHARE: f64 = 0.1;
    let level = |branch: &Branch| median(branch.free.iter().map(|point| point.force).collect());
    let most = list.iter().map(|(branch, _)| branch).max_by_key(|branch| branch.free.len());
    let Some((most, at)) = most.and_then(|most| Some((most.free.len(), level(most)?))) else { return };
    for (branch, _) in list {
        let Some(found) = level(branch) else { continue };
        let error = noise.sigma[1] * (1.0 / most as f64 + 1.0 / branch.free.len() as f64).sqrt();
        let off = (found - at).abs();
        let whole = range(branch.attached.iter().map(|point| point.force));
        if off > SAME * error && off > SHARE * whole && 2 * branch.free.len() < most {
            notes.push(format!(
                "the last {} rows of the {} are taken for rows in contact: their force is not that of the rows apart",
                branch.free.len(),
                branch.segment.name()
            ));
            let rest = std::mem::take(&mut branch.free);
            branch.attached.extend(rest);
        }
    }
}

/// Says where one branch has rows apart and another has none.
fn one_sided(list: &[Branch], notes: &mut Vec<String>) {
    let without: Vec<&str> =
        list.iter().filter(|branch| branch.free.is_empty()).map(|branch| branch.segment.name()).collect();
    if let (Some(name), true) = (without.first(), without.len() < list.len()) {
        notes.push(format!("the {name} has no rows apart: it ends in contact"));
    }
}

/// The median step of x from row to row of a branch, as a share of its range; 0 of few rows.
fn disorder(points: &[Point], segments: Option<&[Segment]>) -> f64 {
    let whole = range(points.iter().map(|point| point.x));
    let branch = |point: &Point| segments.map(|of| of[point.row - 1]);
    let mut last: [Option<f64>; 3] = [None; 3];
    let mut steps = Vec::new();
    for point in points {
        let slot = match branch(point) {
            None => 0,
            Some(Segment::Approach) => 1,
            Some(_) => 2,
        };
        steps.extend(last[slot].replace(point.x).map(|before| (point.x - before).abs() / whole));
    }
    if steps.len() < 20 { 0.0 } else { median(steps).unwrap_or(0.0) }
}

/// Refuses points whose x has no order, unless nothing depends on it.
fn in_order(points: &[Point], indifferent: bool) -> Result<(), BranchError> {
    let share = disorder(points, None);
    if share > UNORDERED && !indifferent {
        Err(BranchError::Unordered { share: 100.0 * share })
    } else {
        Ok(())
    }
}

impl Branch {
    /// Drops the rows around the jump that the noise of x has put on its other side.
    fn clears_jump(&mut self, noise: &Noise) {
        /// Rows within so many σ of x from the jump may be on either side.
        const NEAR: f64 = 5.0;
        let [Some(last), Some(first)] = [self.attached.last(), self.free.first()] else { return };
        let ends = [first.x - NEAR * noise.sigma[0], last.x + NEAR * noise.sigma[0]];
        let line = Line::of(&self.free);
        let limit = BEYOND * noise.sigma[1];
        let pulled = |point: &Point| point.force < line.at(point.x) - limit;
        let near = |point: &Point| (ends[0]..=ends[1]).contains(&point.x);
        // Without a jump there is nothing that was mixed.
        let attached: Vec<&Point> = self.attached.iter().filter(|point| near(point)).collect();
        if attached.iter().filter(|point| pulled(point)).count() * 2 < attached.len() {
            return;
        }
        let before = self.attached.len() + self.free.len();
        self.attached.retain(|point| !near(point) || pulled(point));
        self.free.retain(|point| !near(point) || !pulled(point));
        self.dropped += before - self.attached.len() - self.free.len();
    }
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
    if let Some(jump) = jump(&x, &force) {
        let rest = points.split_off(jump.at);
        let line = Line::of(&rest);
        let limit = BEYOND * noise_of(&force).max(FLOOR * range(force.iter().copied()));
        let within = rest.iter().position(|point| point.force >= line.at(point.x) - limit);
        let dropped = within.unwrap_or(0);
        return Branch { segment, attached: points, free: rest[dropped..].to_vec(), dropped };
    }
    if points.len() < 2 * END_ROWS || !free_end(&x, &force)[0] || !stands_still(&force) {
        return Branch { segment, attached: points, free: Vec::new(), dropped: 0 };
    }
    let count = (points.len() / END_SHARE).max(END_ROWS);
    let end = &force[force.len() - count..];
    let whole = range(force.iter().copied());
    let limit = BEYOND * noise_of(&force).max(FLOOR * whole);
    // Without single rows that are off: a median keeps the place of a step.
    let force = filtered(&force);
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

/// Whether the force stands still at the end without a jump before it, as it does where bodies come apart that do not adhere: over the
/// last eighth of the rows it neither goes on nor is it the least of all, as where a record ends at its smallest force.
fn stands_still(force: &[f64]) -> bool {
    const SHARE: usize = 8;
    const FEWEST: usize = 10;
    let count = (force.len() / SHARE).max(FEWEST);
    if force.len() < 2 * count {
        return false;
    }
    let (before, end) = force.split_at(force.len() - count);
    let thirds: Vec<f64> =
        end.chunks((count / 3).max(1)).take(3).filter_map(|part| median(part.to_vec())).collect();
    let noise = noise_of(force);
    let floor = FLOOR * range(force.iter().copied());
    // The median of m rows is known to 1.25 σ/√m; of three the range is below 4.4 of these 95 of 100 times.
    let error = 1.25 * noise / (count as f64 / 3.0).sqrt();
    let goes_on = range(thirds.iter().copied()) > 5.0 * error + floor;
    let level = median(end.to_vec()).unwrap_or(0.0);
    let next = median(before[before.len() - count..].to_vec()).unwrap_or(0.0);
    // The same again before it: a smallest force is rounder than that.
    !goes_on
        && ((next - level).abs() <= 2.0 * error + floor
            || filtered(before).iter().any(|p| *p < level - BEYOND * noise - floor))
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

/// σ of x, P and s, the rows in the order of the file.
fn noise(
    list: &[(Branch, Vec<Point>)],
    asked: &Asked,
    (steps, converter): ([f64; 3], Option<f64>),
    ranges: [f64; 3],
    of_radius: bool,
) -> Noise {
    let (mut forces, mut ways, mut radii) = (Vec::new(), Vec::new(), Vec::new());
    let mut in_contact = Vec::new();
    for (branch, in_order) in list {
        // Nothing is known of radii where the bodies are apart: in contact they vary slowly with what they are measured with.
        let touching =
            in_order.iter().filter(|point| if of_radius { point.x > 0.0 } else { point.radius > 0.0 });
        let with = |point: &Point| if of_radius { [point.force, point.x] } else { [point.x, point.radius] };
        let (x, s): (Vec<f64>, Vec<f64>) = touching.map(with).map(|[x, s]| (x, s)).unzip();
        radii.extend(scatter_over(&x, &s));
        let (x, force): (Vec<f64>, Vec<f64>) = branch.attached.iter().map(|p| (p.x, p.force)).unzip();
        in_contact.extend(scatter_over(&x, &force));
        let mut rows: Vec<usize> = branch.free.iter().map(|point| point.row).collect();
        rows.sort_unstable();
        let free: Vec<&Point> =
            in_order.iter().filter(|point| rows.binary_search(&point.row).is_ok()).collect();
        forces.extend(free.windows(2).map(|pair| (pair[1].force - pair[0].force).abs()));
        ways.extend(free.windows(3).map(|three| (three[0].x - 2.0 * three[1].x + three[2].x).abs()));
    }
    let radius = radii.into_iter().reduce(f64::min);
    let apart = median(forces).map(|step| step / 0.954);
    // Of radii alone the scatter has that of the force in it: both cannot be told where neither is known.
    let known = apart.is_some() || asked.sigma[1].is_some();
    let of_ways = || median(ways).map(|way| way / 1.652);
    let ways = if of_radius { radius.filter(|_| known) } else { of_ways() };
    let of = |found: Option<f64>, origin| found.map(|found| (found, origin));
    let neighbours = in_contact.into_iter().reduce(f64::min);
    let found = [
        of(ways, if of_radius { Origin::Neighbours } else { Origin::Apart }),
        of(apart, Origin::Apart).or(of(neighbours, Origin::Neighbours)),
        of(radius, Origin::Neighbours),
    ];
    let step = converter.unwrap_or(0.0);
    let mut noise = Noise { sigma: [0.0; 3], from: [Origin::Assumed; 3], step };
    for axis in 0..3 {
        let floor = FLOOR * ranges[axis];
        if axis == 2 && floor == 0.0 {
            // There is no such column.
            continue;
        }
        let digits = Some(steps[axis]).filter(|step| step.is_finite()).unwrap_or(0.0);
        let (mut of_data, origin) = found[axis].unwrap_or((0.0, Origin::Assumed));
        // Noise below a step of the converter is not seen in differences: the force is rounded then.
        if axis == 1 && of_data < step {
            of_data = hypot(of_data, step / 12.0_f64.sqrt());
        }
        let least = floor.max(digits);
        let found = (of_data.max(least), if of_data.max(digits) < floor { Origin::Assumed } else { origin });
        (noise.sigma[axis], noise.from[axis]) =
            asked.sigma[axis].map_or(found, |given| (given, Origin::Given));
    }
    noise
}
