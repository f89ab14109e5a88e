//! Where a record that ends in contact may lie along a path with snaps: its smallest force is not that of the path, and its
//! forces alone do not tell on which wave its rows are.

use super::path::FitPath;
use super::problem::{Datum, FitProblem, Target};
use super::pulled::is_pulled;
use crate::gap::Gap;
use crate::measured::{Abscissa, Segment};
use crate::preset::Preset;
use crate::problem::Control;

/// How far outside the end of the path the last row is sought, in ranges of x, and at how many offsets.
const SPAN: f64 = 6.0;
const OFFSETS: usize = 288;
/// How often the step between two offsets is halved around the best one.
const HALVINGS: usize = 3;

/// Whether a record in which no rows are apart may end anywhere on the curve of `preset`. Paths at a rate, and of adhesion with a
/// range, begin from the fit of one without: so many candidates of theirs would take too long.
pub(super) fn may_end_early(preset: &Preset, data: &[Datum]) -> bool {
    let is_quick = preset.cohesion().is_none() && !is_pulled(preset);
    is_quick && preset.gap.feature_length().is_some() && data.iter().all(|datum| !datum.free)
}

impl FitProblem {
    /// `u` with the offsets, its value `j`, at which the forces of the rows differ less from those of the path than at neighbouring
    /// ones, by their mean distance at the same x: the best one first, at most `most`. None where x does not tell the force.
    pub(super) fn aligned(&self, u: &[f64], j: usize, most: usize) -> Vec<Vec<f64>> {
        if self.abscissa == Abscissa::Radius || self.preset.path.control == Control::Force {
            return Vec::new();
        }
        let at = self.instrument_at(u);
        let with = |offset: f64| {
            let mut u = u.to_vec();
            u[j] = self.parameters[j].inner(Target::Offset.sign(self.turned) * offset);
            self.begun(&mut u);
            u
        };
        let rows = || self.data.iter().filter(|datum| !datum.free);
        let ends = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], x| [lo.min(x), hi.max(x)])
        };
        let [last, first] = ends(&mut rows().map(|datum| datum.point.x));
        let [low, high] = ends(&mut rows().map(|datum| datum.point.force));
        let innermost =
            self.paths(u).and_then(|paths| Some(falling(paths.of(Segment::Retraction)).last()?[0]));
        let Some(innermost) = innermost else { return Vec::new() };
        let inner = last - innermost;
        let step = SPAN * (first - last) / OFFSETS as f64;
        // Such a path holds the rows at all of these offsets.
        let Some(paths) = self.paths(&with(inner - step * OFFSETS as f64)) else { return Vec::new() };
        let [approach, retraction] =
            [Segment::Approach, Segment::Retraction].map(|segment| falling(paths.of(segment)));
        let off = |offset: f64| {
            let of = |datum: &Datum| {
                let line = if datum.segment == Segment::Approach { &approach } else { &retraction };
                let force = datum.point.force - at.baseline - at.tilt * datum.point.x;
                force_at(line, datum.point.x - offset).map_or(high - low, |model| (force - model).abs())
            };
            rows().map(of).sum::<f64>()
        };
        let list: Vec<[f64; 2]> =
            (0..=OFFSETS).map(|i| inner - step * i as f64).map(|x| [x, off(x)]).collect();
        let far = [f64::NAN, f64::INFINITY];
        let around =
            |i: usize| [i.checked_sub(1).map_or(far, |i| list[i]), list.get(i + 1).copied().unwrap_or(far)];
        let is_least = |i: &usize| around(*i).iter().all(|other| other[1] > list[*i][1]);
        let mut least: Vec<[f64; 2]> = (0..list.len()).filter(is_least).map(|i| list[i]).collect();
        least.sort_by(|a, b| a[1].total_cmp(&b[1]));
        least.truncate(most);
        let closer = |[mut offset, mut least]: [f64; 2]| {
            let mut step = step;
            for _ in 0..HALVINGS {
                step *= 0.5;
                for other in [offset - step, offset + step] {
                    let found = off(other);
                    if found < least {
                        (offset, least) = (other, found);
                    }
                }
            }
            with(offset)
        };
        least.into_iter().map(closer).collect()
    }
}

/// x and P along a path, as far as x falls.
fn falling(path: &FitPath) -> Vec<[f64; 2]> {
    let mut line: Vec<[f64; 2]> = Vec::new();
    for vertex in &path.vertices {
        let [x, force, _] = vertex.at;
        if line.last().is_none_or(|last| x < last[0]) {
            line.push([x, force]);
        }
    }
    line
}

/// The force at x; `None` beyond the ends.
fn force_at(line: &[[f64; 2]], x: f64) -> Option<f64> {
    let i = line.partition_point(|at| at[0] >= x);
    let [[x0, f0], [x1, f1]] = [line.get(i.checked_sub(1)?)?, line.get(i)?].map(|at| *at);
    Some(f0 + (x - x0) / (x1 - x0) * (f1 - f0))
}
