//! Where the bodies are apart, and the signs of x and P that follow from it.

use super::apart::jump;
use super::asked::{FreePart, ValueRange};
use super::noise::{BEYOND, END_ROWS, END_SHARE, FLOOR, median, noise_of, range};
use super::points::{Abscissa, MeasuredPoint, Turned, turn};
use super::role::Segment;
use super::turns::{one_way, runs};

/// A free end varies by less than these shares of the whole range, and of the range at the other end.
const FLAT: [f64; 2] = [0.1, 0.3];
/// Rows at an end are at rest in x if they cover less than this share of what the same number of rows covers on
/// average.
const PAUSE: f64 = 0.1;
/// The shares of the range of x over which the force is examined if it is very noisy.
const SHARES: [f64; 2] = [0.08, 0.16];

/// Jumps of this share of the clearest one are as likely.
const LIKELY: f64 = 0.5;
/// The notes for a reversed sign of the force.
const PULLED: &str =
    "the force is positive before the jump to the free part, where bodies attract: its sign is reversed";
const FALLS: &str = "the force falls as the bodies are pressed together: its sign is reversed";

/// Whether the curve is free at its low end and at its high end: where y stays constant while x changes.
pub(super) fn free_end(x: &[f64], y: &[f64]) -> [bool; 2] {
    let mut order: Vec<usize> = (0..x.len()).collect();
    order.sort_by(|&a, &b| x[a].total_cmp(&x[b]).then(y[a].total_cmp(&y[b])));
    let spread = |ends: &[usize]| {
        let mut y: Vec<f64> = ends.iter().map(|&i| y[i]).collect();
        y.sort_by(f64::total_cmp);
        // A few outliers among few rows must hide nothing.
        let fifth = y.len() / 5;
        y[y.len() - 1 - fifth] - y[fifth]
    };
    // Rows of a pause show nothing.
    let way = range(x.iter().copied());
    let stays = |end: &[usize], count: usize| {
        range(end.iter().map(|&i| x[i])) < PAUSE * way * count as f64 / x.len() as f64
    };
    let whole = range(y.iter().copied());
    let flat = |here: f64, there: f64| here <= FLAT[0] * whole && here <= FLAT[1] * there;
    // Many rows tell noise from a slope; few rows tell a short free part from the contact.
    for share in [END_SHARE / 4, END_SHARE] {
        let count = (x.len() / share).max(END_ROWS).min(x.len());
        let ends = [&order[..count], &order[order.len() - count..]];
        if ends.iter().any(|end| stays(end, count)) {
            continue;
        }
        let [low, high] = ends.map(spread);
        let found = [flat(low, high), flat(high, low)];
        if found != [false; 2] {
            return found;
        }
    }
    // With much noise, or with rows at rest in x, the medians of parts of either end are used.
    for share in SHARES {
        let found = trends(x, y, &order, share).map(|[low, high]| [flat(low, high), flat(high, low)]);
        if let Some(found) = found.filter(|found| *found != [false; 2]) {
            return found;
        }
    }
    [false; 2]
}

/// By how much the force changes over the outer parts of the range of x, of this share of it, low and high, from the
/// medians of bins; `None` if there are few rows.
fn trends(x: &[f64], y: &[f64], order: &[usize], share: f64) -> Option<[f64; 2]> {
    /// The bins, and the rows in each.
    const BINS: usize = 4;
    const ROWS: usize = 4;
    let (first, last) = (x[*order.first()?], x[*order.last()?]);
    let bin = share * (last - first) / BINS as f64;
    let trend = |from: f64| {
        let of_bin = |k: usize| {
            let lo = from + k as f64 * bin;
            let inside = order.iter().filter(|&&i| x[i] >= lo && x[i] <= lo + bin).map(|&i| y[i]);
            Some(inside.collect::<Vec<f64>>()).filter(|rows| rows.len() >= ROWS).and_then(median)
        };
        let medians: Option<Vec<f64>> = (0..BINS).map(of_bin).collect();
        medians.map(|medians| range(medians.into_iter()))
    };
    Some([trend(first)?, trend(last - BINS as f64 * bin)?])
}

/// Whether the signs of x and P are reversed, and which other signs have comparable evidence.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Orientation {
    pub(super) turned: Turned,
    pub(super) or: Option<Turned>,
}

/// What is known about points whose signs are not yet known.
pub(super) struct UnsignedPoints<'a> {
    pub(super) abscissa: Abscissa,
    pub(super) segments: Option<&'a [Segment]>,
    /// Whether the rows are in order.
    pub(super) is_in_order: bool,
    /// Which rows are apart, as the user specifies.
    pub(super) free: FreePart,
}

impl UnsignedPoints<'_> {
    /// Sets the signs that the free end and the rise in contact indicate. `None` where x stands still while P changes,
    /// as in columns that are swapped; this shows only if the rows are in order.
    pub(super) fn signs(&self, points: &mut [MeasuredPoint], notes: &mut Vec<String>) -> Option<Orientation> {
        if self.abscissa == Abscissa::Radius {
            return Some(self.of_force(points, [false; 2], notes));
        }
        let x: Vec<f64> = points.iter().map(|point| point.x).collect();
        let force: Vec<f64> = points.iter().map(|point| point.force).collect();
        if self.is_in_order && stands_still(&x, &force) {
            return None;
        }
        let end = match self.free {
            FreePart::Found => {
                if let Some(found) = by_jumps(points, self.segments) {
                    turn(points, found.turned);
                    let [x, force] = found.turned;
                    notes.extend(x.then(|| self.turned_x()));
                    notes.extend(force.then(|| PULLED.to_owned()));
                    return Some(found);
                }
                free_end(&x, &force)
            }
            FreePart::None => [false; 2],
            FreePart::Within(span) => end_of(&x, span),
        };
        let mut turned = [false; 2];
        match end {
            [true, _] => {}
            [_, true] => turned[0] = true,
            _ => {
                // Without a free end, the direction of a position depends on the instrument, but the sign of a force
                // does not.
                turned[0] = self.abscissa == Abscissa::Position && rises(&x, &force) == Some(false);
                notes.push("there is no free part: the signs are taken as in the file".to_owned());
            }
        }
        if turned[0] {
            turn(points, [true, false]);
            notes.push(self.turned_x());
        }
        Some(self.of_force(points, turned, notes))
    }

    fn turned_x(&self) -> String {
        format!("the {} grows as the bodies move apart: its sign is reversed", self.abscissa.name())
    }

    /// Sets the sign of the force once that of x is right. The force rises where the bodies are pressed together; its
    /// sign before the jump to the free part may contradict that.
    fn of_force(&self, points: &mut [MeasuredPoint], [x, _]: Turned, notes: &mut Vec<String>) -> Orientation {
        let pulls = if self.free == FreePart::None { None } else { pulls(points, self.segments) };
        let (ways, force): (Vec<f64>, Vec<f64>) = points.iter().map(|point| (point.x, point.force)).unzip();
        let rises = rises(&ways, &force);
        let turned = rises.or(pulls) == Some(false);
        if turned {
            turn(points, [false, true]);
            notes.push(if rises == Some(false) { FALLS } else { PULLED }.to_owned());
        }
        let is_doubtful = pulls.is_some_and(|pulls| rises.is_some_and(|rises| rises != pulls));
        Orientation { turned: [x, turned], or: is_doubtful.then_some([x, !turned]) }
    }
}

/// The end of x at which `span` lies, as (low, high).
fn end_of(x: &[f64], span: ValueRange) -> [bool; 2] {
    let middle = |of: Vec<f64>| median(of).unwrap_or(f64::NAN);
    let (within, rest): (Vec<f64>, Vec<f64>) = x.iter().partition(|x| span.holds(**x));
    let (within, rest) = (middle(within), middle(rest));
    [within < rest, within > rest]
}

/// The signs for which the force jumps up from the contact to rows apart, and rises with x where the bodies are pressed
/// together most.
fn by_jumps(points: &[MeasuredPoint], segments: Option<&[Segment]>) -> Option<Orientation> {
    let pieces = match segments {
        None => one_way(points),
        Some(of) => {
            [Segment::Approach, Segment::Retraction].map(|segment| runs(points, of, segment)).concat()
        }
    };
    let sum = |turned: Turned| -> f64 {
        let mut sum = 0.0;
        for piece in &pieces {
            let mut piece = piece.clone();
            turn(&mut piece, turned);
            piece.sort_by(|a, b| b.x.total_cmp(&a.x).then(b.force.total_cmp(&a.force)));
            let (x, force): (Vec<f64>, Vec<f64>) = piece.iter().map(|point| (point.x, point.force)).unzip();
            if rises(&x, &force) == Some(true) {
                sum += jump(&x, &force).map_or(0.0, |jump| jump.deviations);
            }
        }
        sum
    };
    let all = [[false, false], [true, false], [false, true], [true, true]];
    let mut found: Vec<(f64, Turned)> = all.map(|turned| (sum(turned), turned)).to_vec();
    // Of equals, the first: signs as in the file.
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (best, turned) = *found.first().filter(|(sum, _)| *sum > 0.0)?;
    let or = found.get(1).filter(|(sum, _)| *sum > LIKELY * best).map(|(_, turned)| *turned);
    Some(Orientation { turned, or })
}

/// Whether the force before the jump to the free part is below that of the free part, as it is where bodies attract;
/// `None` without a free part, or where the jump is so small that the rise in contact says more.
fn pulls(points: &[MeasuredPoint], segments: Option<&[Segment]>) -> Option<bool> {
    /// A jump is trusted from this share of the largest force on.
    const LARGE: f64 = 0.3;
    /// The median is taken over at most this many rows before the jump, and at most one in this many of all rows.
    const ROWS: usize = 3;
    const SHARE: usize = 20;
    let groups: Vec<Vec<MeasuredPoint>> = match segments {
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
        let rows = (force.len() / SHARE).clamp(1, ROWS);
        // Among few rows, adhesion may be smaller than what is taken for noise.
        if limit > LARGE * most {
            continue;
        }
        let Some(last) = force.iter().rposition(|p| (p - base).abs() > limit) else { continue };
        let behind =
            median(force[(last + 1).saturating_sub(rows)..=last].iter().map(|p| p - base).collect())?;
        if behind.abs() > LARGE * most && found.is_none_or(|found| behind.abs() > found.abs()) {
            found = Some(behind);
        }
    }
    found.map(|behind| behind < 0.0)
}

/// Whether x stands still at the beginning or the end of the file while P changes. A position never does this, but the
/// force of bodies apart does, apart from its noise.
fn stands_still(x: &[f64], force: &[f64]) -> bool {
    /// The rows at either end, one in this many of all, and the shares of both ranges there.
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

/// Whether P rises with x in the outer fifth of x; `None` if it neither rises nor falls.
fn rises(x: &[f64], force: &[f64]) -> Option<bool> {
    let most = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let whole = range(x.iter().copied());
    let near: Vec<usize> = (0..x.len()).filter(|&i| x[i] >= most - 0.2 * whole).collect();
    let count = near.len().max(1) as f64;
    let [mean_x, mean_p] = [x, force].map(|of| near.iter().map(|&i| of[i]).sum::<f64>() / count);
    let product: f64 = near.iter().map(|&i| (x[i] - mean_x) * (force[i] - mean_p)).sum();
    (product != 0.0).then_some(product > 0.0)
}
