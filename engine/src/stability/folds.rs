//! Fold curves: where each limit point lies, as a function of one number.
//!
//! ```text
//! γ = γ_k(s)      A: t = (√(πγ/2) − F₀)/F₁      k: x = (1 − q)/(3q − 1),  q = √(πγ/2)/(√s g')
//! ```
//!
//! Each radius gives the value of the number at which it is a limit point, and with it δ and P. For any other number
//! the curve is traced.

use super::count::{Cause, EXACTLY, even};
use super::equations::{Equations, Sort};
use super::explicit::Born;
use super::family::{Family, FamilyError};
use super::law::adhesion_of;
use super::lines::Traced;
use super::map::MapPoint;
use super::weight::Weight;
use crate::problem::Control;
use crate::progress::Progress;

/// Values of the number at which limit points are looked for if no curve follows from s.
const COLUMNS: u32 = 24;
/// Values between which landings are looked for; also just before and after each cusp, by this share of the axis.
const SAMPLES: u32 = 100;
const BESIDE: f64 = 1e-7;

/// One limit point as a function of the number.
#[derive(Debug, Clone, PartialEq)]
pub struct FoldLine {
    /// The crest it lies at, numbered from the axis; none without a wave.
    pub crest: Option<u32>,
    /// Whether the control has a minimum there: the edge runs inward from it, and stable states lie outward. Otherwise
    /// the edge runs outward, and they lie inward.
    pub is_minimum: bool,
    /// The points of the curve in order.
    pub points: Vec<MapPoint>,
}

/// All fold curves with their cusps and landings.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Folds {
    /// The curves, cut at the cusps.
    pub lines: Vec<FoldLine>,
    /// The cusps.
    pub cusps: Vec<MapPoint>,
    /// Where a jump just reaches, or just passes over, a crest: the limit points from which the jump begins.
    pub landings: Vec<MapPoint>,
}

impl Family {
    /// The fold curves over the only axis. `progress` is asked now and then; on a stop, what was found until then is
    /// returned.
    ///
    /// # Errors
    /// A gap cannot be tabulated, or a value is out of its range.
    pub fn folds(&self, progress: &dyn Progress) -> Result<Folds, FamilyError> {
        let mut folds = Folds::default();
        if let Some(lines) = self.explicit_folds(progress)? {
            for (points, cusps) in lines {
                let point = |born: &Born| self.point_at(&born.at[..1], born.contact_radius);
                folds.cusps.extend(cusps.iter().filter_map(point));
                // The sign of F' tells minima from maxima; a cusp belongs to both sides.
                for part in cut(&points, |born| born.bend) {
                    folds.lines.extend(
                        self.fold_line(part.iter().filter_map(point).collect(), sign(part, |b| b.bend)),
                    );
                }
            }
        } else {
            let of = Equations::new(self, Sort::Fold);
            let mut known: Vec<Traced> = Vec::new();
            for y in self.fold_starts(&of, progress) {
                if progress.stop() {
                    break;
                }
                if known.iter().any(|line| line.has(&y)) {
                    continue;
                }
                let Some(line) = of.line(&y, progress) else { continue };
                let slope = |y: &Vec<f64>| {
                    of.locals(y)
                        .and_then(|locals| locals.first().map(|local| local.edge.slope))
                        .unwrap_or(0.0)
                };
                let point = |y: &Vec<f64>| self.point_at(&y[1..], y[0] * of.unit);
                for part in cut(&line.points, slope) {
                    folds
                        .lines
                        .extend(self.fold_line(part.iter().filter_map(point).collect(), sign(part, slope)));
                }
                folds.cusps.extend(line.tips.iter().filter_map(point));
                known.push(line);
            }
        }
        // On both sides of every cusp too: a snap gained there may be lost again before the next sample.
        let beside = folds.cusps.iter().flat_map(|cusp| [cusp.at[0] - BESIDE, cusp.at[0] + BESIDE]);
        let mut samples: Vec<f64> = even(SAMPLES).into_iter().chain(beside).collect();
        samples.retain(|share| (0.0..=1.0).contains(share));
        samples.sort_by(f64::total_cmp);
        for change in self.changes(0, &[0.0], &samples, EXACTLY, progress) {
            if let Cause::Landing([outer, _]) = change.cause {
                folds.landings.extend(self.point_at(&[change.share], outer));
            }
        }
        Ok(folds)
    }

    fn fold_line(&self, points: Vec<MapPoint>, is_minimum: bool) -> Option<FoldLine> {
        let middle = points.get(points.len() / 2).filter(|_| points.len() > 1)?;
        Some(FoldLine { crest: self.crest(middle.contact_radius), is_minimum, points })
    }

    /// The curves that follow from s; their tips are the cusps.
    fn explicit_folds(
        &self,
        progress: &dyn Progress,
    ) -> Result<Option<Vec<super::explicit::ExplicitLine>>, FamilyError> {
        let axis = &self.axes[0];
        let [end, start] = self.radii;
        let born = |s: f64, share: f64, slope: f64| Born {
            contact_radius: s,
            at: [share, (s - end) / (start - end)],
            bend: slope,
        };
        if let Some(factor) = self.adhesion_factor() {
            let member = self.member(&[0.5])?;
            return Ok(Some(self.sampled(progress, &|s| {
                let edge = member.local(s)?.edge;
                (edge.value > 0.0).then(|| born(s, axis.share(adhesion_of(edge.value) / factor), edge.slope))
            })));
        }
        if self.linear() == Some(0) {
            let (lo, hi) = (self.member(&[0.0])?, self.member(&[1.0])?);
            let [from, to] = axis.range;
            return Ok(Some(self.sampled(progress, &|s| {
                let (a, b) = (lo.local(s)?, hi.local(s)?);
                let t = (a.root - a.edge.value) / (b.edge.value - a.edge.value);
                let slope = a.edge.slope + t * (b.edge.slope - a.edge.slope);
                (t >= 0.0).then(|| born(s, axis.share(from + t * (to - from)), slope))
            })));
        }
        if self.compliance() == Some(0) {
            let grips = self.member(&[0.0])?;
            let stiffness = self.preset.problem().reduced_by(self.length).units.stiffness;
            return Ok(Some(self.sampled(progress, &|s| {
                let local = grips.local(s)?;
                let first = local.edge.value / Weight::of(grips.control, s).value;
                let q = local.root / (s.sqrt() * first);
                let x = (1.0 - q) / (3.0 * q - 1.0);
                if !(x > 0.0 && first > 0.0) {
                    return None;
                }
                let soft =
                    super::explicit::edge_under(&local, grips.control, Control::Stiffness(2.0 * s / x), s);
                Some(born(s, axis.share(x / (2.0 * s) / stiffness), soft.slope))
            })));
        }
        Ok(None)
    }

    /// Limit points at evenly spaced values of the number.
    fn fold_starts(&self, of: &Equations<'_>, progress: &dyn Progress) -> Vec<Vec<f64>> {
        let radii = self.sampled_radii();
        let mut starts = Vec::new();
        for share in even(COLUMNS) {
            let Ok(member) = self.member(&[share]) else { continue };
            if progress.stop() {
                break;
            }
            let off: Vec<Option<f64>> =
                radii.iter().map(|s| member.local(*s).map(|local| local.edge.value - local.root)).collect();
            for (s, off) in radii.windows(2).zip(off.windows(2)) {
                let (Some(a), Some(b)) = (off[0], off[1]) else { continue };
                if (a > 0.0) != (b > 0.0) {
                    let root = s[0] + (s[1] - s[0]) * a / (a - b);
                    starts.extend(of.polished(&[root / of.unit, share], 1));
                }
            }
        }
        starts
    }
}

/// The parts of a line between sign changes of F'; the point nearest to a change, which may be its cusp, belongs to both.
fn cut<T>(points: &[T], slope: impl Fn(&T) -> f64) -> Vec<&[T]> {
    let mut parts = Vec::new();
    let mut from = 0;
    for k in 1..points.len() {
        let [before, after] = [&points[k - 1], &points[k]].map(&slope);
        if (after > 0.0) != (before > 0.0) {
            let at = if before.abs() < after.abs() { k - 1 } else { k };
            parts.push(&points[from..=at]);
            from = at;
        }
    }
    parts.push(&points[from..]);
    parts
}

/// Whether F grows at the limit points of a part, judged by the majority of its points.
fn sign<T>(part: &[T], slope: impl Fn(&T) -> f64) -> bool {
    2 * part.iter().filter(|point| slope(point) > 0.0).count() > part.len()
}

#[cfg(test)]
mod tests {
    use super::cut;

    #[test]
    fn a_cusp_is_the_end_of_both_its_lines() {
        for cusp in [1e-17, -1e-17] {
            let slopes = [3.0, 2.0, 1.0, cusp, -1.0, -2.0];
            assert_eq!(cut(&slopes, |slope| *slope), [&slopes[..4], &slopes[3..]]);
        }
        // Without one, the nearest point.
        assert_eq!(cut(&[2.0, 0.1, -1.0], |slope| *slope), [&[2.0, 0.1][..], &[0.1, -1.0]]);
    }
}
