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

pub use super::noise::FLOOR;
pub(crate) use super::noise::median;
use super::noise::{BEYOND, END_ROWS, END_SHARE, noise_of, range, scatter_over, tenth};
pub use super::points::Point;
use super::points::{Abscissa, Points};
use super::role::Segment;
use super::signs::{free_end, signs};
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
        let segments = self.segments.as_deref();
        let is_in_order = disorder(&points, segments) <= UNORDERED;
        let turned = signs(&mut points, self.abscissa, segments, is_in_order, &mut notes)
            .ok_or(BranchError::Swapped)?;
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
        let noise = noise(&list, asked, self.steps, ranges, of_radius);
        for (branch, _) in &mut list {
            branch.clears_jump(&noise);
        }
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
    let jump = jump.filter(|&jump| rise(jump) > limit).or_else(|| blurred(&points, least, limit));
    if let Some(jump) = jump {
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

/// The last row before a jump that is spread over some rows, since the noise of x has put them on either side: the medians beside it
/// differ most there, by more than `limit`.
fn blurred(points: &[Point], from: usize, limit: f64) -> Option<usize> {
    const ROWS: usize = 7;
    let of = |rows: &[Point]| median(rows.iter().map(|point| point.force).collect());
    let rise = |at: usize| {
        let (before, after) = (&points[at + 1 - ROWS..=at], &points[at + 1..=at + ROWS]);
        Some((of(after)? - of(before)?, at))
    };
    let last = points.len().checked_sub(ROWS + 1)?;
    let rises = (from.max(ROWS)..=last).filter_map(rise).filter(|(rise, _)| *rise > limit);
    rises.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, at)| at)
}

/// The running median of five, of fewer at the ends.
fn filtered(values: &[f64]) -> Vec<f64> {
    let around = |i: usize| &values[i.saturating_sub(2)..(i + 3).min(values.len())];
    (0..values.len()).map(|i| median(around(i).to_vec()).unwrap_or(values[i])).collect()
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

/// σ of x, P and s, the rows in the order of the file.
fn noise(
    list: &[(Branch, Vec<Point>)],
    asked: &Asked,
    steps: [f64; 3],
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
    let mut noise = Noise { sigma: [0.0; 3], from: [Origin::Assumed; 3] };
    for axis in 0..3 {
        let floor = FLOOR * ranges[axis];
        if axis == 2 && floor == 0.0 {
            // There is no such column.
            continue;
        }
        let digits = Some(steps[axis]).filter(|step| step.is_finite()).unwrap_or(0.0);
        let (of_data, origin) = found[axis].unwrap_or((0.0, Origin::Assumed));
        let least = floor.max(digits);
        let found = (of_data.max(least), if of_data.max(digits) < floor { Origin::Assumed } else { origin });
        (noise.sigma[axis], noise.from[axis]) =
            asked.sigma[axis].map_or(found, |given| (given, Origin::Given));
    }
    noise
}
