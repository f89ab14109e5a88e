//! The signs of x and P: from contact radii, the names of the branches, the jump behind which the bodies are apart, or
//! the end at which the force stays constant.

use super::apart::{FEW, FEWEST, jump};
use super::asked::{FreePart, ValueRange};
use super::ends::{free_end, rests, still_end};
use super::noise::{BEYOND, END_ROWS, END_SHARE, FLOOR, median, noise_of, range, scatter_over};
use super::points::{Abscissa, MeasuredPoint, Turned, turn};
use super::role::Segment;
use super::turns::{one_way, runs};

/// Jumps of this share of the clearest one are as likely.
const LIKELY: f64 = 0.5;
/// Of many rows, fewer than this in contact could not be fitted: they are rows apart, read backwards.
const IN_CONTACT: usize = 10;
/// Jumps to rows that go on count alone if they have this share of the clearest of all.
const CLEAR: f64 = 0.25;
/// The notes for a reversed sign of the force.
const PULLED: &str = "the force is positive before the jump to the free part, where the bodies attract each other: its sign is reversed \
    (data.baseline is in the numbers of the file)";
const FALLS: &str = "the force falls as the bodies are pressed together: its sign is reversed (data.baseline is in the \
    numbers of the file)";

/// Whether the signs of x and P are reversed, and which other signs have comparable evidence.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Orientation {
    pub(super) turned: Turned,
    pub(super) or: Option<Turned>,
    /// What else they may be if no row turns out to be apart: nothing but a level end, or the file, tells the sign of x.
    pub(super) unless_apart: Option<Turned>,
}

/// What is known about points whose signs are not yet known.
pub(super) struct UnsignedPoints<'a> {
    pub(super) abscissa: Abscissa,
    pub(super) segments: Option<&'a [Segment]>,
    /// Which rows are apart, as the user specifies.
    pub(super) free: FreePart,
}

impl UnsignedPoints<'_> {
    /// Sets the signs that the free end and the rise in contact indicate.
    pub(super) fn signs(&self, points: &mut [MeasuredPoint], notes: &mut Vec<String>) -> Orientation {
        if self.abscissa == Abscissa::Radius {
            return self.of_force(points, [false; 2], notes);
        }
        let x: Vec<f64> = points.iter().map(|point| point.x).collect();
        let force: Vec<f64> = points.iter().map(|point| point.force).collect();
        // What contact radii or the names of the branches say is no guess.
        let named = self.by_segments(points);
        let is_timed = points.iter().all(|point| point.time.is_finite());
        let known = by_radii(points).or(named.filter(|_| is_timed));
        let end = match self.free {
            FreePart::Found => {
                if let Some(found) = by_jumps(points, self.segments, known) {
                    let named = named.filter(|_| known.is_none());
                    let or = found.or.or_else(|| as_named(points, named, found.turned));
                    turn(points, found.turned);
                    let [x, force] = found.turned;
                    notes.extend(x.then(|| self.turned_x()));
                    notes.extend(force.then(|| PULLED.to_owned()));
                    return Orientation { or, ..found };
                }
                match known {
                    Some(is_turned) => [!is_turned, is_turned],
                    None => still_end(points),
                }
            }
            FreePart::None => known.map_or([false; 2], |is_turned| [!is_turned, is_turned]),
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
        // Without radii, branches, a jump or rows that the user names, the other sign is as good.
        let is_guess = known.is_none() && !matches!(self.free, FreePart::Within(_));
        let other = is_guess.then(|| {
            let mut other = points.to_vec();
            let turned = [!turned[0], false];
            turn(&mut other, turned);
            self.of_force(&mut other, turned, &mut Vec::new()).turned
        });
        if turned[0] {
            turn(points, [true, false]);
            notes.push(self.turned_x());
        }
        Orientation { unless_apart: other, ..self.of_force(points, turned, notes) }
    }

    /// Whether the sign of x is reversed, by the branches that a column names; `None` where they disagree, or x stands still.
    /// Without times, the file may have been written backwards.
    fn by_segments(&self, points: &[MeasuredPoint]) -> Option<bool> {
        let of = self.segments?;
        let ways = [Segment::Approach, Segment::Retraction].map(|segment| {
            let runs = runs(points, of, segment);
            let gained: f64 = runs.iter().filter_map(|run| gained(run.iter().map(|point| point.x))).sum();
            if segment == Segment::Approach { gained } else { -gained }
        });
        let [least, most] = [ways[0].min(ways[1]), ways[0].max(ways[1])];
        (least * most >= 0.0 && least + most != 0.0).then_some(least + most < 0.0)
    }

    fn turned_x(&self) -> String {
        format!(
            "the {} grows as the bodies move apart: its sign is reversed (data.offset is in the numbers of the file)",
            self.abscissa.name()
        )
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
        // A disc of which the force over the radius is measured may pull more as it grows: near the pull-off, and on waves.
        let may_fall = self.abscissa == Abscissa::Radius && rises == Some(false);
        let is_doubtful = may_fall || pulls.is_some_and(|pulls| rises.is_some_and(|rises| rises != pulls));
        Orientation { turned: [x, turned], or: is_doubtful.then_some([x, !turned]), unless_apart: None }
    }
}

/// The signs by which a column `named` the branches, where the jump that speaks for others, `found`, does not lead to a level
/// force: a snap between waves is one in both directions, if x and P are reversed together.
fn as_named(points: &[MeasuredPoint], named: Option<bool>, found: Turned) -> Option<Turned> {
    let mut points = points.to_vec();
    turn(&mut points, found);
    let (x, force): (Vec<f64>, Vec<f64>) = points.iter().map(|point| (point.x, point.force)).unzip();
    let is_level = free_end(&x, &force)[0];
    (named == Some(!found[0]) && !is_level).then(|| found.map(|is_turned| !is_turned))
}

/// Whether the force of the rows in `contact` falls towards the jump, or rises by no more than the jump. A record of
/// contact alone that is read backwards rises by more: its jump is one between waves.
fn comes_off((contact, behind): (&[f64], &[f64])) -> bool {
    let quarter = contact.len() / 4;
    // The last rows may be apart already.
    let parts = [&contact[..quarter], &contact[2 * quarter..3 * quarter], &contact[3 * quarter..], behind];
    match parts.map(|part| median(part.to_vec())) {
        [Some(first), Some(third), Some(last), Some(behind)] => {
            third <= first || last - first <= behind - last
        }
        _ => true,
    }
}

/// By how much the last third of some values lies above the first, by their medians; `None` of too few.
fn gained(values: impl Iterator<Item = f64>) -> Option<f64> {
    let values: Vec<f64> = values.collect();
    let third = values.len() / 3;
    Some(median(values[values.len() - third..].to_vec())? - median(values[..third].to_vec())?)
}

/// Whether the sign of x is reversed, by the contact radii beside it, which grow as the bodies approach; `None` without
/// them, and where they do not tell: radii that are constant, noisy, or held as the bodies part.
fn by_radii(points: &[MeasuredPoint]) -> Option<bool> {
    /// The least correlation of ranks.
    const SURE: f64 = 0.9;
    let known: Vec<&MeasuredPoint> = points.iter().filter(|point| point.radius > 0.0).collect();
    if known.len() < 2 * END_ROWS {
        return None;
    }
    let [x, radii] = [|point: &MeasuredPoint| point.x, |point: &MeasuredPoint| point.radius]
        .map(|of| ranks(&known.iter().map(|point| of(point)).collect::<Vec<f64>>()));
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let correlation = sum(&x, &radii) / (sum(&x, &x) * sum(&radii, &radii)).sqrt();
    (correlation.abs() >= SURE).then_some(correlation < 0.0)
}

/// The place of each value among all in ascending order, counted from the middle; equal ones share theirs.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    let middle = 0.5 * (values.len() as f64 - 1.0);
    let mut first = 0;
    for equal in order.chunk_by(|&a, &b| values[a].total_cmp(&values[b]).is_eq()) {
        let place = first as f64 + 0.5 * (equal.len() as f64 - 1.0) - middle;
        for at in equal {
            ranks[*at] = place;
        }
        first += equal.len();
    }
    ranks
}

/// The end of x at which `span` lies, as (low, high).
fn end_of(x: &[f64], span: ValueRange) -> [bool; 2] {
    let middle = |of: Vec<f64>| median(of).unwrap_or(f64::NAN);
    let (within, rest): (Vec<f64>, Vec<f64>) = x.iter().partition(|x| span.holds(**x));
    let (within, rest) = (middle(within), middle(rest));
    [within < rest, within > rest]
}

/// The signs for which the force jumps up from the contact to rows apart, and rises with x where the bodies are pressed
/// together most. On the way from there to the jump it must not rise by more than the jump, unless it is level behind. Only
/// signs with that of x that is `known`, if it is.
fn by_jumps(
    points: &[MeasuredPoint],
    segments: Option<&[Segment]>,
    known: Option<bool>,
) -> Option<Orientation> {
    let pieces = match segments {
        None => one_way(points),
        Some(of) => {
            [Segment::Approach, Segment::Retraction].map(|segment| runs(points, of, segment)).concat()
        }
    };
    // Most rows behind a jump to a load that is held are at rest: a free part goes on.
    let middle = |behind: &[f64]| behind[behind.len() / 4..behind.len() - behind.len() / 4].to_vec();
    let sum = |turned: Turned, may_rest: bool| -> f64 {
        let mut sum = 0.0;
        for piece in &pieces {
            let mut piece = piece.clone();
            turn(&mut piece, turned);
            piece.sort_by(|a, b| b.x.total_cmp(&a.x).then(b.force.total_cmp(&a.force)));
            let (x, force): (Vec<f64>, Vec<f64>) = piece.iter().map(|point| (point.x, point.force)).unzip();
            // Where most rows are apart, the outer fifth of all would hold more of them than of the contact.
            let found = jump(&x, &force)
                .filter(|jump| jump.at >= if force.len() < FEW { FEWEST } else { IN_CONTACT })
                .filter(|jump| rises(&x[..jump.at], &force[..jump.at]) == Some(true))
                .filter(|jump| comes_off(force.split_at(jump.at)) || still_end(&piece)[0])
                .filter(|jump| may_rest || !rests(&middle(&x[jump.at..]), &x));
            sum += found.map_or(0.0, |jump| jump.deviations);
        }
        sum
    };
    let signs = [[false, false], [true, false], [false, true], [true, true]];
    let signs = signs.into_iter().filter(|[x, _]| known.is_none_or(|known| known == *x));
    let sums = |may_rest| {
        let mut found: Vec<(f64, Turned)> =
            signs.clone().map(|turned| (sum(turned, may_rest), turned)).collect();
        // Of equals, the first: signs as in the file.
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.first().is_some_and(|(sum, _)| *sum > 0.0).then_some(found)
    };
    // Bodies rest apart, too: then hardly any jump leads to rows that go on.
    let all = sums(true)?;
    let (most, _) = *all.first()?;
    let found = sums(false).filter(|found| found.iter().any(|(sum, _)| *sum > CLEAR * most)).unwrap_or(all);
    let (best, turned) = *found.first()?;
    let or = found.get(1).filter(|(sum, _)| *sum > LIKELY * best).map(|(_, turned)| *turned);
    Some(Orientation { turned, or, unless_apart: None })
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
pub(super) fn is_swapped(points: &[MeasuredPoint]) -> bool {
    /// The rows at either end, one in this many of all, and the shares of both ranges there.
    const ROWS: usize = 20;
    const STILL: f64 = 0.015;
    const GOES_ON: f64 = 0.02;
    /// So many standard deviations of a row, over the root of the rows of a half.
    const CERTAIN: f64 = 8.0;
    /// In stiff contact the force changes by more of its range than x does, but not by so many times as much.
    const STEEPER: f64 = 4.0;
    /// However small the noise is, a change by less than this share of the range counts as none.
    const NONE: f64 = 0.002;
    let (x, force): (Vec<f64>, Vec<f64>) = points.iter().map(|point| (point.x, point.force)).unzip();
    let count = (x.len() / ROWS).max(END_ROWS).min(x.len());
    let share = |of: &[f64], rows: std::ops::Range<usize>| {
        let (first, last) = of[rows].split_at(count / 2);
        let middles = [first, last].map(|half| median(half.to_vec()).unwrap_or(0.0));
        (middles[0] - middles[1]).abs() / range(of.iter().copied())
    };
    // Among few rows two medians of noise may be as far apart.
    let rows: Vec<f64> = (0..x.len()).map(|row| row as f64).collect();
    let [still, goes_on] = [&x, &force].map(|of| {
        let noise = scatter_over(&rows, of).unwrap_or(0.0) / range(of.iter().copied());
        CERTAIN * noise / ((count / 2) as f64).sqrt()
    });
    // After a long jump, what x changes by in contact is a small share of its range, but it is more than noise.
    let (still, goes_on) = (still.clamp(NONE, STILL), goes_on.max(GOES_ON));
    [0..count, x.len() - count..x.len()].into_iter().any(|rows| {
        let [of_x, of_force] = [&x, &force].map(|of| share(of, rows.clone()));
        of_x < still && of_force > goes_on.max(STEEPER * of_x)
    })
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
