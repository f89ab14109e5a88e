//! A branch divided into its parts: the rows in contact, those within the jump, and those apart.

use super::apart::{BEHIND, SPARSE, fallen, jump, may_be_behind};
use super::asked::{FreePart, ValueRange};
use super::ends::{filtered, free_end, stands_still};
use super::noise::{BEYOND, END_ROWS, END_SHARE, FLOOR, Noise, median, noise_of, range};
use super::points::MeasuredPoint;
use super::role::Segment;

/// One branch, from the contact to the free end.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredBranch {
    /// Which branch it is.
    pub segment: Segment,
    /// The points in contact.
    pub attached: Vec<MeasuredPoint>,
    /// The points apart.
    pub free: Vec<MeasuredPoint>,
    /// How many rows lie within the jump, or where none can tell whether the bodies touch already, and belong to neither
    /// part.
    pub jump: usize,
}

/// A branch, and all its points in the order of measurement.
pub(super) type OrderedBranch = (MeasuredBranch, Vec<MeasuredPoint>);

impl MeasuredBranch {
    /// Drops the last row or two in contact if they may lie behind a jump, and returns their numbers. So few rows do not tell
    /// rows apart from outliers, from another contact behind a snap, or from a record that ends at its last contact.
    pub(super) fn drops_last(&mut self) -> Vec<usize> {
        let (x, force): (Vec<f64>, Vec<f64>) =
            self.attached.iter().map(|point| (point.x, point.force)).unzip();
        let behind = (1..=BEHIND).rev().find(|rows| self.free.is_empty() && may_be_behind(&x, &force, *rows));
        let dropped = self.attached.split_off(self.attached.len() - behind.unwrap_or(0));
        self.jump += dropped.len();
        dropped.iter().map(|point| point.row).collect()
    }

    /// Drops the rows around the jump that noise in x may have put on the wrong side.
    fn clears_jump(&mut self, noise: &Noise) {
        /// Rows within this many σ of x from the jump may lie on either side.
        const NEAR: f64 = 5.0;
        let [Some(last), Some(first)] = [self.attached.last(), self.free.first()] else { return };
        let ends = [first.x - NEAR * noise.sigma[0], last.x + NEAR * noise.sigma[0]];
        let line = FreeLine::of(&self.free);
        let limit = BEYOND * noise.sigma[1];
        let pulled = |point: &MeasuredPoint| point.force < line.at(point.x) - limit;
        let near = |point: &MeasuredPoint| (ends[0]..=ends[1]).contains(&point.x);
        // Without a jump, nothing can have been mixed.
        let attached: Vec<&MeasuredPoint> = self.attached.iter().filter(|point| near(point)).collect();
        if attached.iter().filter(|point| pulled(point)).count() * 2 < attached.len() {
            return;
        }
        let before = self.attached.len() + self.free.len();
        self.attached.retain(|point| !near(point) || pulled(point));
        self.free.retain(|point| !near(point) || !pulled(point));
        self.jump += before - self.attached.len() - self.free.len();
    }

    /// Drops the last rows of the free part where the bodies may have touched already: without a jump the force grows from
    /// nothing, and is seen only where it exceeds the noise.
    fn clears_onset(&mut self, noise: &Noise) {
        /// The first rows in contact, whose mean tells the force that is seen.
        const FIRST: usize = 3;
        /// Fewer rows apart are all kept.
        const FEWEST: usize = 9;
        /// A force this many times as large is well seen.
        const TIMES: f64 = 5.0;
        /// How far back the force of a cone begins, in distances from the one force to the other: 1/(√5 − 1). The forces of
        /// blunter bodies begin nearer.
        const BACK: f64 = 0.81;
        let Some(first) = self.attached.len().checked_sub(FIRST).map(|from| &self.attached[from..]) else {
            return;
        };
        if self.free.len() < FEWEST {
            return;
        }
        let line = FreeLine::of(&self.free);
        let pressed = |point: &MeasuredPoint| point.force - line.at(point.x);
        let mean = |of: &dyn Fn(&MeasuredPoint) -> f64| first.iter().map(of).sum::<f64>() / FIRST as f64;
        let (x, seen) = (mean(&|point| point.x), mean(&pressed));
        if seen <= noise.sigma[1] {
            return;
        }
        let Some(well) = self.attached.iter().rev().find(|point| pressed(point) >= TIMES * seen) else {
            return;
        };
        let onset = x - BACK * (well.x - x);
        let before = self.free.iter().filter(|point| point.x < onset).count();
        if before >= FEWEST {
            self.jump += self.free.len() - before;
            self.free.retain(|point| point.x < onset);
        }
    }
}

/// A branch divided into its parts; `asked` has the signs of the points.
pub(super) fn branch(
    segment: Segment,
    in_order: &[MeasuredPoint],
    of_radius: bool,
    asked: FreePart,
) -> MeasuredBranch {
    let mut points = in_order.to_vec();
    // This does not depend on the order of the file.
    points.sort_by(|a, b| b.x.total_cmp(&a.x).then(b.force.total_cmp(&a.force)));
    if of_radius {
        let (mut free, attached): (Vec<MeasuredPoint>, _) =
            points.into_iter().partition(|point| point.x <= 0.0);
        if asked == FreePart::None {
            free.clear();
        }
        return MeasuredBranch { segment, attached, free, jump: 0 };
    }
    match asked {
        FreePart::None => return MeasuredBranch { segment, attached: points, free: Vec::new(), jump: 0 },
        FreePart::Within(span) => return apart_within(segment, points, span),
        FreePart::Found => {}
    }
    let (x, force): (Vec<f64>, Vec<f64>) = points.iter().map(|point| (point.x, point.force)).unzip();
    if let Some(jump) = jump(&x, &force) {
        let rest = points.split_off(jump.at);
        let within = within_jump(&rest, &rest, &force);
        return MeasuredBranch { segment, attached: points, free: rest[within..].to_vec(), jump: within };
    }
    let is_apart = points.len() >= 2 * END_ROWS
        && free_end(&x, &force)[0]
        && stands_still(&force)
        && !(segment == Segment::Retraction && fallen(&x, &force) > 0);
    if !is_apart {
        return MeasuredBranch { segment, attached: points, free: Vec::new(), jump: 0 };
    }
    let count = (points.len() / END_SHARE).max(END_ROWS);
    let end = &force[force.len() - count..];
    let whole = range(force.iter().copied());
    let limit = BEYOND * noise_of(&force).max(FLOOR * whole);
    // Outliers of single rows are removed: a median keeps the place of a step.
    let force = filtered(&force);
    // Without a jump, the free part ends where three successive rows are off.
    let base = median(end.to_vec()).unwrap_or(0.0);
    let mut off = 0;
    let mut at = force.len();
    while at > 0 && off < 3 {
        at -= 1;
        off = if (force[at] - base).abs() > limit { off + 1 } else { 0 };
    }
    let free = points.split_off((at + off).min(points.len()));
    MeasuredBranch { segment, attached: points, free, jump: 0 }
}

/// How many rows at the beginning of `rest`, which follows a jump, have not yet reached the force of the rows `free`.
fn within_jump(rest: &[MeasuredPoint], free: &[MeasuredPoint], force: &[f64]) -> usize {
    let line = FreeLine::of(free);
    let limit = BEYOND * noise_of(force).max(FLOOR * range(force.iter().copied()));
    rest.iter().position(|point| point.force >= line.at(point.x) - limit).unwrap_or(0)
}

/// A branch whose rows with x in `span` are apart, as the user specifies; rows beyond the span are left out.
fn apart_within(segment: Segment, mut points: Vec<MeasuredPoint>, span: ValueRange) -> MeasuredBranch {
    let holds = |point: &MeasuredPoint| span.holds(point.x);
    let Some(first) = points.iter().position(holds) else {
        return MeasuredBranch { segment, attached: points, free: Vec::new(), jump: 0 };
    };
    points.retain(|point| point.x >= span.lo);
    let (x, force): (Vec<f64>, Vec<f64>) = points.iter().map(|point| (point.x, point.force)).unzip();
    let free = points.split_off(first);
    let mut within = 0;
    if let Some(jump) = jump(&x, &force).filter(|jump| jump.at < first) {
        // Rows behind the jump are not in contact, whether or not they have reached the force of the others.
        let rest = points.split_off(jump.at);
        let behind = [&rest[..], &free[..]].concat();
        within = within_jump(&behind, &behind, &force).min(rest.len());
    }
    MeasuredBranch { segment, attached: points, free, jump: within }
}

/// The line through a free part, from the medians of its halves.
struct FreeLine {
    base: f64,
    slope: f64,
}

impl FreeLine {
    fn of(points: &[MeasuredPoint]) -> Self {
        let half = points.len() / 2;
        let of =
            |part: &[MeasuredPoint], get: fn(&MeasuredPoint) -> f64| median(part.iter().map(get).collect());
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

/// Settles which rows of all branches are apart, and drops those that may lie on either side of the jump or of the onset.
pub(super) fn clear(list: &mut [OrderedBranch], asked: FreePart, noise: &Noise, notes: &mut Vec<String>) {
    if asked == FreePart::Found {
        same_free_force(list, noise, notes);
    }
    for (branch, _) in list {
        branch.clears_jump(noise);
        // What a user says is apart is apart.
        if asked == FreePart::Found {
            branch.clears_onset(noise);
        }
    }
}

/// Returns rows to the contact if they are constant at a force other than that of the branch with most rows apart: a
/// record that ends near its smallest force looks like that.
fn same_free_force(list: &mut [OrderedBranch], noise: &Noise, notes: &mut Vec<String>) {
    /// Levels are equal within this many of their errors, or within this share of the range of the branch.
    const SAME: f64 = 6.0;
    const SHARE: f64 = 0.1;
    let middle =
        |branch: &MeasuredBranch, of: fn(&MeasuredPoint) -> f64| median(branch.free.iter().map(of).collect());
    let level = |branch: &MeasuredBranch| middle(branch, |point| point.force);
    let most = list.iter().map(|(branch, _)| branch).max_by_key(|branch| branch.free.len());
    let Some((rows, at)) = most.and_then(|most| Some((&most.free, level(most)?))) else { return };
    let (most, line) = (rows.len(), FreeLine::of(rows));
    for (branch, _) in list {
        let Some((found, x)) = level(branch).zip(middle(branch, |point| point.x)) else { continue };
        let error = noise.sigma[1] * (1.0 / most as f64 + 1.0 / branch.free.len() as f64).sqrt();
        // On a tilted baseline the levels differ, and lie on one line.
        let off = (found - at).abs().min((found - line.at(x)).abs());
        let whole = range(branch.attached.iter().map(|point| point.force));
        if off > SAME * error && off > SHARE * whole && 2 * branch.free.len() < most {
            notes.push(format!(
                "the last {} rows of the {} are taken to be in contact: their force is not that of the rows apart",
                branch.free.len(),
                branch.segment.name()
            ));
            let rest = std::mem::take(&mut branch.free);
            branch.attached.extend(rest);
        }
    }
}

/// Takes the last rows of a branch as apart if another branch has rows apart and these have the same force: with few rows
/// the force may go from contact to zero without a visible jump. This is done for short branches, for approaches that
/// begin where a retraction is well apart, since bodies that close touch further in than bodies that open, and for
/// retractions that end with a jump to that force, even if it is in the last row.
pub(super) fn as_elsewhere(list: &mut [OrderedBranch]) {
    /// Forces are equal within this many times the range of those apart, or within this share of the range of the
    /// branch; and the fewest such rows.
    const SAME: f64 = 3.0;
    const SHARE: f64 = 0.02;
    const FEWEST: usize = 2;
    /// The fewest rows of an approach that lie where a retraction is well apart, and how many of them must have its force.
    const FEWEST_THERE: usize = 3;
    const MOST_THERE: f64 = 0.9;
    /// A jump begins this many times the range of those apart below their force; another row may lie out of the range of n rows by
    /// this share over √n.
    const JUMPS: f64 = 5.0;
    const BESIDE: f64 = 3.0;
    let forces: Vec<f64> = list.iter().flat_map(|(branch, _)| branch.free.iter().map(|p| p.force)).collect();
    let Some(level) = median(forces.clone()) else { return };
    let apart_rows = forces.len() as f64;
    let spread = range(forces.into_iter());
    // The middle of the rows apart: without a jump, the first of them may still be in contact.
    let of_middle = |branch: &MeasuredBranch| median(branch.free.iter().map(|point| point.x).collect());
    let opened = list.iter().map(|(branch, _)| branch).filter(|branch| branch.segment == Segment::Retraction);
    let apart = opened.filter_map(of_middle).reduce(f64::min);
    for (branch, _) in list {
        if !branch.free.is_empty() {
            continue;
        }
        let whole = range(branch.attached.iter().map(|point| point.force));
        let is_short = branch.attached.len() < SPARSE;
        let limit = if is_short { (SAME * spread).max(SHARE * whole) } else { spread };
        let same = |point: &&MeasuredPoint| (point.force - level).abs() <= limit;
        let there = || branch.attached.iter().filter(|point| apart.is_some_and(|x| point.x <= x));
        let (of_all, of_same) = (there().count(), there().filter(same).count());
        let begins_apart = branch.segment == Segment::Approach
            && of_all >= FEWEST_THERE
            && of_same as f64 >= MOST_THERE * of_all as f64;
        let mut count = branch.attached.iter().rev().take_while(same).count();
        if !(count >= FEWEST && (is_short || begins_apart)) {
            let limit = spread * (1.0 + BESIDE / apart_rows.sqrt());
            let back = |point: &&MeasuredPoint| (point.force - level).abs() <= limit;
            count = branch.attached.iter().rev().take_while(back).count();
            let before = branch.attached.iter().rev().nth(count);
            let comes_off = branch.segment == Segment::Retraction
                && before.is_some_and(|point| point.force < level - JUMPS * limit);
            if !comes_off {
                continue;
            }
        }
        branch.free = branch.attached.split_off(branch.attached.len() - count);
    }
}

/// Notes where one branch has rows apart and another has none.
pub(super) fn one_sided(list: &[MeasuredBranch], notes: &mut Vec<String>) {
    let without: Vec<&str> =
        list.iter().filter(|branch| branch.free.is_empty()).map(|branch| branch.segment.name()).collect();
    if let (Some(name), true) = (without.first(), without.len() < list.len()) {
        notes.push(format!("no rows of the {name} look apart: all are taken to be in contact, unless --free-part says otherwise"));
    }
}

/// A sentence on rows that are apart at the smallest force of all, with no jump before them: a record that ends in
/// contact near its largest pull looks the same.
pub(super) fn never_pulls(list: &[MeasuredBranch], noise: &Noise) -> Option<String> {
    let branch = list.iter().max_by_key(|branch| branch.free.len())?;
    // Radii of 0 show that they are apart.
    if branch.free.iter().any(|point| point.radius == 0.0) {
        return None;
    }
    let level = median(branch.free.iter().map(|point| point.force).collect())?;
    let whole = range(list.iter().flat_map(|branch| &branch.attached).map(|point| point.force));
    let limit = level - BEYOND * noise.sigma[1].max(FLOOR * whole);
    let pulled =
        |branch: &MeasuredBranch| branch.jump > 0 || branch.attached.iter().any(|point| point.force < limit);
    (!list.iter().any(pulled)).then(|| {
        format!(
            "the last {} rows of the {} are taken to be apart, although none before them pulls more. \
             If they are still in contact, set --free-part none or data.free_part=none",
            branch.free.len(),
            branch.segment.name()
        )
    })
}
