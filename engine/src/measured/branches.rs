//! Points → branches: approach and retraction, the free part, the jump between them; signs and noise.
//!
//! The free end of a curve is where the force stays constant while x changes. At the other end, in contact, the force
//! rises with x. Together they fix the signs: δ grows as the bodies are pressed together, and P is positive in
//! compression.
//!
//! On a branch, from the contact to the free end, the pull-off is the largest rise from one sample to the next behind
//! the minimum. Before it the bodies are attached, behind it they are free; samples within the jump are dropped and
//! counted.
//!
//! `sigma` finds how well the columns are known.

use super::asked::{Asked, FreePart, ValueRange, signs_text};
use super::converter::{Clipped, clipped, quantum, without_copied_parts, without_copies, without_repeats};
pub use super::free::MeasuredBranch;
use super::free::{OrderedBranch, as_elsewhere, branch, clear, never_pulls, one_sided};
pub(crate) use super::noise::median;
use super::noise::{END_ROWS, range, scatter_over};
pub use super::noise::{FLOOR, Noise, Origin};
pub use super::points::MeasuredPoint;
use super::points::{Abscissa, Points, Turned, turn};
use super::role::Segment;
use super::sigma::noise;
use super::signs::{Orientation, UnsignedPoints, is_swapped};
use super::turns::{by_time, one_way, rises, runs, without_pause};
use crate::text::counted;
use thiserror::Error;

/// If the median step of x from row to row exceeds this share of its range, the rows are in no order.
const UNORDERED: f64 = 0.1;
/// Branches with fewer rows are ignored.
const FEWEST: usize = 5;

/// The branches of a file and what is known about them.
#[derive(Debug, Clone, PartialEq)]
pub struct Branches {
    /// What x is.
    pub abscissa: Abscissa,
    /// The branches, approach first.
    pub list: Vec<MeasuredBranch>,
    /// How well the columns are known.
    pub noise: Noise,
    /// The median of the free force; `None` without a free part.
    pub baseline: Option<f64>,
    /// Whether the signs of x and P were reversed.
    pub turned: Turned,
    /// Other signs with comparable evidence.
    pub or: Option<Turned>,
    /// Whether x and P look swapped; the user says that they are not.
    pub looks_swapped: bool,
    /// Whether nothing but the file itself speaks for the sign of x as it is there.
    pub is_as_in_file: bool,
    /// The ranges of x, P and s over the points that are used.
    pub ranges: [f64; 3],
    /// What was found or assumed, in words.
    pub notes: Vec<String>,
    /// How many rows of the approach and of the retraction the file has, used or not.
    pub rows: [usize; 2],
    /// How many more the file has, without a number in a column that is used.
    pub skipped: usize,
    /// How many rows belong to pauses.
    pub pauses: usize,
    /// The end of a converter's range at which rows in contact lie.
    pub clipped: Option<Clipped>,
}

impl Branches {
    /// By how much a force without rows apart may be off.
    pub fn tare(&self) -> f64 {
        const SHARE: f64 = 0.02;
        let forces = self.list.iter().flat_map(|branch| &branch.attached).map(|point| point.force.abs());
        SHARE * forces.fold(0.0, f64::max)
    }

    /// σ of x and P in contact by the order of the rows, which is a clock if they were taken at even times: at least the noise of
    /// each column. At most their scatter over each other, which has both. `None` of few rows, whose bend would count as noise, and of
    /// rows that may be sorted, whose order is none.
    pub fn noise_in_order(&self) -> Option<[f64; 2]> {
        const FEWEST: usize = 40;
        let of = |branch: &MeasuredBranch| {
            let mut points: Vec<&MeasuredPoint> = branch.attached.iter().collect();
            let columns = |points: &[&MeasuredPoint]| -> [Vec<f64>; 2] {
                [|point: &MeasuredPoint| point.x, |point: &MeasuredPoint| point.force]
                    .map(|of| points.iter().map(|point| of(point)).collect())
            };
            let [x, force] = columns(&points);
            let of_both = [scatter_over(&force, &x), scatter_over(&x, &force)];
            points.sort_by_key(|point| point.at);
            let is_sorted = |column: &Vec<f64>| column.is_sorted() || column.is_sorted_by(|a, b| a >= b);
            if points.len() < FEWEST || columns(&points).iter().any(is_sorted) {
                return None;
            }
            let count: Vec<f64> = (0..points.len()).map(|i| i as f64).collect();
            let in_order = columns(&points).map(|column| scatter_over(&count, &column));
            let least = |axis: usize| Some(in_order[axis]?.min(of_both[axis].unwrap_or(f64::INFINITY)));
            Some([least(0)?, least(1)?])
        };
        self.list.iter().filter_map(of).reduce(|a, b| [a[0].min(b[0]), a[1].min(b[1])])
    }

    /// The branches without a last row or two that may lie behind a jump, where no rows are apart; a note says which.
    pub fn without_last(&self) -> Option<Self> {
        if self.baseline.is_some() || self.abscissa == Abscissa::Radius {
            return None;
        }
        let mut fewer = self.clone();
        for branch in &mut fewer.list {
            let rows: Vec<String> = branch.drops_last().iter().map(ToString::to_string).collect();
            let name = branch.segment.name();
            fewer.notes.extend((!rows.is_empty()).then(|| {
                format!(
                    "left out: {} {} at the end of the {name}, behind a jump that the model does not make there. If the bodies are \
                     apart by then, --free-part gives the fit the zero of the force",
                    if rows.len() > 1 { "rows" } else { "row" },
                    rows.join(" and ")
                )
            }));
        }
        (fewer.notes.len() > self.notes.len()).then_some(fewer)
    }

    /// A sentence on signs that were assumed although the points leave them open.
    pub fn doubt(&self) -> Option<String> {
        self.or.map(|_| {
            format!(
                "the points leave it open which way their columns run: {} is assumed. Set --signs or data.signs",
                signs_text(self.turned)
            )
        })
    }

    /// A sentence on rows without numbers, if they are many.
    pub fn unread(&self) -> Option<String> {
        const SHARE: usize = 4;
        let all = self.skipped + self.rows[0] + self.rows[1];
        (SHARE * self.skipped >= all).then(|| {
            format!(
                "{} of {all} rows have no number in a column that is used, and are left out: look whether a part of the \
                 curve is missing",
                self.skipped
            )
        })
    }

    /// A sentence on columns that look swapped.
    pub fn swapped(&self) -> Option<String> {
        self.looks_swapped.then(|| format!("{SWAPPED}; they are read as specified"))
    }
}

const SWAPPED: &str = "the force column keeps changing where x stands still at one end, as the position does where bodies are \
    apart: the columns of x and force look swapped";

/// Why points yield no branches.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum BranchError {
    /// Too few rows are left.
    #[error(
        "only {0} rows are left after the range, the segment and the rows to skip; at least {END_ROWS} are needed"
    )]
    Few(usize),
    /// The rows have no order.
    #[error(
        "the rows are not in order: x jumps back and forth by {share:.0} % of its range from row to row. \
         Sort them, or name a segment column, the range and the sigmas"
    )]
    Unordered {
        /// The median step of x, in per cent of its range.
        share: f64,
    },
    /// x and P are swapped.
    #[error("{SWAPPED}; if they are not, name them, as in data.columns = \"approach=1,force=2\"")]
    Swapped,
    /// A contact radius among the rows used is negative.
    #[error("row {row}: the contact radius {radius:?} is negative: are the columns swapped?")]
    NegativeRadius {
        /// The row, from 1.
        row: usize,
        /// The radius.
        radius: f64,
    },
    /// A contact radius cannot change sign.
    #[error("a contact radius cannot be negative: leave x as it is, x=+")]
    TurnedRadius,
    /// A free part of contact radii cannot be chosen.
    #[error(
        "rows are apart where the contact radius is 0, and no other part can be named: none leaves these rows out"
    )]
    FreeRadius,
    /// No row lies in the free part requested.
    #[error("no row lies in the requested free part: x is as in the file, with its sign")]
    NothingFree,
    /// The branch requested is not there.
    #[error("there is no {0} in the file")]
    NoSegment(&'static str),
}

/// Leaves out times that go back within a branch, and returns the row at which they do. Steps back by no more than rounding are
/// none.
fn without_restarts(part: &mut [MeasuredPoint]) -> Option<usize> {
    /// The rounding of the times, as a share of their range.
    const ROUNDING: f64 = 1e-9;
    let rounding = ROUNDING * range(part.iter().map(|point| point.time));
    for i in 1..part.len() {
        let before = part[i - 1].time;
        if part[i].time < before && part[i].time >= before - rounding {
            part[i].time = before;
        }
    }
    let back = part.windows(2).find(|pair| pair[1].time < pair[0].time)?[1].row;
    for point in part {
        point.time = f64::NAN;
    }
    Some(back)
}

/// How many rows were left out as copies, if any.
fn of_copies(rows: usize) -> Option<String> {
    (rows > 0).then(|| format!("left out: {} that are an exact copy of those before", counted(rows, "row")))
}

/// Leaves out rows in contact without a contact radius where others have one.
fn without_radius(list: &mut [OrderedBranch], of_radius: bool, notes: &mut Vec<String>) {
    let attached = || list.iter().flat_map(|(branch, _)| &branch.attached);
    let seen = attached().filter(|point| !point.radius.is_nan()).count();
    let unseen = attached().count() - seen;
    if of_radius || seen == 0 || unseen == 0 {
        return;
    }
    for (branch, _) in list {
        branch.attached.retain(|point| !point.radius.is_nan());
    }
    notes.push(format!("rows in contact without a contact radius are left out: {unseen}"));
}

impl Points {
    /// The branches of these points.
    ///
    /// # Errors
    /// [`BranchError`].
    pub fn branches(&self, asked: &Asked) -> Result<Branches, BranchError> {
        let mut notes = Vec::new();
        let mut points = self.used(asked, &mut notes)?;
        let step = quantum(&points.iter().map(|point| point.force).collect::<Vec<_>>());
        let copied = without_copies(&mut points);
        notes.extend(of_copies(copied));
        let repeated = without_repeats(&mut points);
        if repeated > 0 {
            notes.push(format!("left out: {} equal to the row before", counted(repeated, "row")));
        }
        let of_radius = self.abscissa == Abscissa::Radius;
        let looks_swapped = self.looks_swapped(&points, asked);
        if looks_swapped && !self.is_said {
            return Err(BranchError::Swapped);
        }
        let Orientation { turned, or, unless_apart } = self.directed(&mut points, asked, &mut notes)?;
        let free = self.free_part(&points, asked.free, turned)?;
        let (mut list, rows, pauses) = self.listed(&points, asked, free, &mut notes)?;
        let used: Vec<&MeasuredPoint> =
            list.iter().flat_map(|(branch, _)| branch.attached.iter().chain(&branch.free)).collect();
        if used.len() < END_ROWS {
            return Err(BranchError::Few(used.len()));
        }
        let ranges = [
            range(used.iter().map(|p| p.x)),
            range(used.iter().map(|p| p.force)),
            range(used.iter().map(|p| p.radius)),
        ];
        let noise = noise(&list, asked.sigma, (self.steps, step), ranges, of_radius);
        clear(&mut list, asked.free, &noise, &mut notes);
        without_radius(&mut list, of_radius, &mut notes);
        let forces = list.iter().flat_map(|(branch, _)| branch.free.iter().map(|p| p.force));
        let baseline = median(forces.collect());
        let clipped = at_an_end(&list, step);
        let list: Vec<MeasuredBranch> = list.into_iter().map(|(branch, _)| branch).collect();
        one_sided(&list, &mut notes);
        let abscissa = self.abscissa;
        if asked.free == FreePart::Found && !of_radius {
            notes.extend(never_pulls(&list, &noise));
        }
        let is_apart = list.iter().any(|branch| !branch.free.is_empty());
        let unless_apart = unless_apart.filter(|_| !is_apart);
        let is_as_in_file = or.is_none() && unless_apart.is_some() && !turned[0];
        let or = or.or(unless_apart);
        Ok(Branches {
            abscissa,
            skipped: self.skipped,
            list,
            noise,
            baseline,
            turned,
            or,
            looks_swapped,
            is_as_in_file,
            ranges,
            notes,
            rows,
            pauses,
            clipped,
        })
    }

    /// The branches that are wanted, the approach first, each with its points in order, before what noise hides is cleared; and
    /// how many rows there are by branch and in pauses.
    fn listed(
        &self,
        points: &[MeasuredPoint],
        asked: &Asked,
        free: FreePart,
        notes: &mut Vec<String>,
    ) -> Result<(Vec<OrderedBranch>, [usize; 2], usize), BranchError> {
        let of_radius = self.abscissa == Abscissa::Radius;
        // Contact radii, which are zero while apart, are never turned.
        let ordered = asked.sigma[0].is_some() || of_radius;
        let mut parts = self.parts(points, ordered, notes)?;
        notes.extend(of_copies(without_copied_parts(&mut parts)));
        for (segment, part) in &mut parts {
            let back = without_restarts(part).filter(|_| *segment != Segment::Other);
            notes.extend(back.map(|row| {
                format!("the times of the {} go back at row {row} and are not used", segment.name())
            }));
        }
        let (rows, pauses) = self.counted(&parts);
        parts.retain(|(segment, _)| *segment != Segment::Other);
        let is_wanted = |segment| asked.segment.is_none_or(|wanted| wanted == segment);
        let mut list: Vec<OrderedBranch> = parts
            .into_iter()
            .filter(|(segment, _)| is_wanted(*segment))
            .map(|(segment, in_order)| (branch(segment, &in_order, of_radius, free), in_order))
            .collect();
        if list.is_empty() {
            return Err(BranchError::NoSegment(asked.segment.map_or("branch", Segment::name)));
        }
        list.sort_by_key(|(branch, _)| branch.segment == Segment::Retraction);
        if asked.free == FreePart::Found {
            as_elsewhere(&mut list);
        }
        Ok((list, rows, pauses))
    }

    /// The points requested, in the order in which they were measured, with the signs of the file.
    fn used(&self, asked: &Asked, notes: &mut Vec<String>) -> Result<Vec<MeasuredPoint>, BranchError> {
        let point = |(at, i): (usize, usize)| MeasuredPoint {
            x: self.x[i],
            force: self.force[i],
            radius: self.radius.as_ref().map_or(f64::NAN, |s| s[i]),
            time: self.time.as_ref().map_or(f64::NAN, |time| time[i]),
            row: i + 1,
            at: at + 1,
        };
        let by_time = self.time.as_deref().and_then(|times| by_time(times, &self.x));
        if by_time.is_some() {
            notes.push("the rows are not in the order of their times: they are sorted by time".to_owned());
        }
        let in_order = by_time.unwrap_or_else(|| (0..self.x.len()).collect());
        let numbered = in_order.into_iter().enumerate();
        let points: Vec<MeasuredPoint> = numbered
            .filter(|&(_, i)| i >= asked.skip)
            .filter(|&(_, i)| asked.x.is_none_or(|span| span.holds(self.x[i])))
            .filter(|&(_, i)| asked.force.is_none_or(|span| span.holds(self.force[i])))
            .filter(|&(_, i)| self.segments.as_ref().is_none_or(|of| of[i] != Segment::Other))
            .map(point)
            .collect();
        let radius =
            |point: &MeasuredPoint| if self.abscissa == Abscissa::Radius { point.x } else { point.radius };
        if points.len() < END_ROWS {
            return Err(BranchError::Few(points.len()));
        }
        match points.iter().find(|point| radius(point) < 0.0) {
            Some(point) => Err(BranchError::NegativeRadius { row: point.row, radius: radius(point) }),
            None => Ok(points),
        }
    }

    /// Sets the signs as the user specifies, or as the points show.
    fn directed(
        &self,
        points: &mut [MeasuredPoint],
        asked: &Asked,
        notes: &mut Vec<String>,
    ) -> Result<Orientation, BranchError> {
        let segments = self.segments.as_deref();
        match asked.turned {
            Some([true, _]) if self.abscissa == Abscissa::Radius => Err(BranchError::TurnedRadius),
            Some(turned) => {
                turn(points, turned);
                Ok(Orientation { turned, or: None, unless_apart: None })
            }
            None => {
                let seen = UnsignedPoints { abscissa: self.abscissa, segments, free: asked.free };
                Ok(seen.signs(points, notes))
            }
        }
    }

    /// Whether x stands still while P changes, as in columns that are swapped. This shows only if the rows are in order,
    /// and does not matter where the signs are given.
    fn looks_swapped(&self, points: &[MeasuredPoint], asked: &Asked) -> bool {
        asked.turned.is_none()
            && self.abscissa != Abscissa::Radius
            && disorder(points, self.segments.as_deref()) <= UNORDERED
            && is_swapped(points)
    }

    /// Which rows are apart, if the user specifies it: converted from the signs of the file to those of `points`.
    fn free_part(
        &self,
        points: &[MeasuredPoint],
        asked: FreePart,
        turned: Turned,
    ) -> Result<FreePart, BranchError> {
        let FreePart::Within(ValueRange { lo, hi }) = asked else { return Ok(asked) };
        if self.abscissa == Abscissa::Radius {
            return Err(BranchError::FreeRadius);
        }
        let span = if turned[0] { ValueRange { lo: -hi, hi: -lo } } else { ValueRange { lo, hi } };
        let count = points.iter().filter(|point| span.holds(point.x)).count();
        if count == 0 {
            return Err(BranchError::NothingFree);
        }
        Ok(FreePart::Within(span))
    }

    /// How many rows there are of the approach, of the retraction, and of pauses. A row that is not used counts to the
    /// branch of the last used row before it.
    fn counted(&self, parts: &[(Segment, Vec<MeasuredPoint>)]) -> ([usize; 2], usize) {
        let mut of: Vec<Option<Segment>> = match &self.segments {
            Some(segments) => segments.iter().copied().map(Some).collect(),
            None => vec![None; self.x.len()],
        };
        for (segment, points) in parts {
            for point in points {
                of[point.row - 1] = Some(*segment);
            }
        }
        let mut last = of.iter().copied().flatten().next();
        let mut rows = [0; 2];
        let mut pauses = 0;
        for segment in of {
            last = segment.or(last);
            match last {
                Some(Segment::Approach) => rows[0] += 1,
                Some(Segment::Retraction) => rows[1] += 1,
                _ => pauses += 1,
            }
        }
        (rows, pauses)
    }

    /// The branches as the file names them, or split where x reverses.
    fn parts(
        &self,
        points: &[MeasuredPoint],
        ordered: bool,
        notes: &mut Vec<String>,
    ) -> Result<Vec<(Segment, Vec<MeasuredPoint>)>, BranchError> {
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
        let held = |(segment, part): &mut (Segment, Vec<MeasuredPoint>)| {
            without_pause(part, *segment == Segment::Retraction)
        };
        // A contact radius stands still while the edge is pinned, which is no pause.
        let moves = self.abscissa != Abscissa::Radius;
        let pause: Vec<MeasuredPoint> = parts.iter_mut().filter(|_| moves).flat_map(held).collect();
        if !pause.is_empty() {
            notes.push(format!(
                "{} in which x stands still at the turn are left out as a pause",
                counted(pause.len(), "row")
            ));
            parts.push((Segment::Other, pause));
        }
        Ok(parts)
    }

    /// How the branches were determined, in words.
    fn order(&self, parts: &[(Segment, Vec<MeasuredPoint>)]) -> Option<String> {
        let count = |segment| parts.iter().filter(|(of, _)| *of == segment).count();
        let counts = [count(Segment::Approach), count(Segment::Retraction)];
        let first = |at: usize| parts[at].1.first().map_or(0, |point| point.row);
        match (&self.segments, counts) {
            (Some(_), [0 | 1, 0 | 1]) => None,
            (None, [1, 0]) => {
                Some("no column names the branches: from the order of x, this is an approach".to_owned())
            }
            (None, [0, 1]) => {
                Some("no column names the branches: from the order of x, this is a retraction".to_owned())
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
                "the rows form several loops: {approaches} approaches and {retractions} retractions are \
                 fitted together"
            )),
        }
    }
}

/// The end of a converter's range at which rows in contact lie.
fn at_an_end(list: &[OrderedBranch], step: Option<f64>) -> Option<Clipped> {
    let mut rows: Vec<MeasuredPoint> =
        list.iter().flat_map(|(_, in_order)| in_order.iter().copied()).collect();
    rows.sort_by_key(|point| point.at);
    let attached = list.iter().flat_map(|(branch, _)| branch.attached.iter().map(|point| point.row));
    let mut attached: Vec<usize> = attached.collect();
    attached.sort_unstable();
    clipped(&rows, &|point| attached.binary_search(&point.row).is_ok(), step)
}

/// The median step of x from row to row of a branch, as a share of its range; 0 if there are few rows.
fn disorder(points: &[MeasuredPoint], segments: Option<&[Segment]>) -> f64 {
    let whole = range(points.iter().map(|point| point.x));
    let branch = |point: &MeasuredPoint| segments.map(|of| of[point.row - 1]);
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

/// Rejects points whose x has no order, unless nothing depends on it.
fn in_order(points: &[MeasuredPoint], indifferent: bool) -> Result<(), BranchError> {
    let share = disorder(points, None);
    if share > UNORDERED && !indifferent {
        Err(BranchError::Unordered { share: 100.0 * share })
    } else {
        Ok(())
    }
}
