//! Lines of cusps without continuation: each radius s gives the pair of numbers at which a pair of limit points is born
//! there.
//!
//! ```text
//! a number A that enters linearly, F = F₀ + t F₁:    F' = 0  at  t = −F₀'/F₁',    γ = (2E*/π) F²
//! the device:  F' = 0  where  g'' + L g' = 0,   M = −2s g''/g' = (1 + 3x²)/((1 + x)(1 + 3x)),
//!              3(1 − M)x² − 4M x + (1 − M) = 0,   k = 2E*s/x
//! ```
//!
//! The tip of a line, where two lines are born, is where F'' = 0 as well: a swallowtail.

use super::family::{Family, FamilyError, LocalLaw};
use super::law::{EdgeJet, adhesion_of};
use crate::elementary::hypot;
use crate::problem::Control;
use crate::progress::Progress;
use crate::root;

/// Radii at which a line is sampled: this many per half wave.
const PER_HALF_WAVE: f64 = 24.0;
/// The most samples in all.
const MOST: f64 = 40_000.0;
/// Neighbours on a line are nearer to each other than this, in shares of the axes, unless this many halvings are not
/// enough.
const CLOSE: f64 = 0.02;
const DEPTH: usize = 20;
/// Halvings of a step in which a line is looked for although neither end is on it. The first ones look everywhere, the
/// others only where the ends allow a line.
const SOUGHT: usize = 40;
const BLIND: usize = 3;
/// Halvings that locate the border of the map on the last step, and a swallowtail.
const HALVINGS: usize = 48;

/// A point of a line of cusps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Born {
    /// s, reduced.
    pub contact_radius: f64,
    /// The shares of both axes.
    pub at: [f64; 2],
    /// F''.
    pub bend: f64,
}

impl Born {
    fn is_inside(&self) -> bool {
        self.at.iter().all(|share| (0.0..=1.0).contains(share))
    }
}

/// A line, its points in order, and the swallowtails on it.
pub type ExplicitLine = (Vec<Born>, Vec<Born>);

impl Family {
    /// The lines of cusps, if both numbers follow from s; otherwise `None`.
    ///
    /// # Errors
    /// A gap cannot be tabulated.
    pub fn explicit_cusps(&self, progress: &dyn Progress) -> Result<Option<Vec<ExplicitLine>>, FamilyError> {
        let (Some(adhesion), Some(factor), 2) = (self.adhesion(), self.adhesion_factor(), self.axes.len())
        else {
            return Ok(None);
        };
        let other = 1 - adhesion;
        let place = |share: f64, value: f64| {
            let mut at = [0.0; 2];
            at[other] = share;
            at[adhesion] = self.axes[adhesion].share(adhesion_of(value) / factor);
            at
        };
        if self.linear() == Some(other) {
            let member = |share: f64| {
                let mut at = [0.0; 2];
                at[other] = share;
                self.member(&at)
            };
            // From the ends of the axis, whatever its spacing.
            let (lo, hi) = (member(0.0)?, member(1.0)?);
            let [from, to] = self.axes[other].range;
            let born = |s: f64| {
                let (a, b) = (lo.local(s)?.edge, hi.local(s)?.edge);
                let t = -a.slope / (b.slope - a.slope);
                let value = a.value + t * (b.value - a.value);
                let share = self.axes[other].share(from + t * (to - from));
                (value > 0.0 && t >= 0.0).then(|| Born {
                    contact_radius: s,
                    at: place(share, value),
                    bend: a.bend + t * (b.bend - a.bend),
                })
            };
            return Ok(Some(self.sampled(progress, &born)));
        }
        if self.compliance() == Some(other) {
            let mut at = [0.0; 2];
            at[other] = 0.0;
            let grips = self.member(&at)?;
            let stiffness = self.preset.problem().reduced_by(self.length).units.stiffness;
            let mut lines = Vec::new();
            for soft in [false, true] {
                let born = |s: f64| {
                    let local = grips.local(s)?;
                    let x = relative_compliance(s, &local, soft)?;
                    let control = Control::Stiffness(2.0 * s / x);
                    // F under this device, from g alone.
                    let edge = edge_under(&local, grips.control, control, s);
                    let compliance = x / (2.0 * s) / stiffness;
                    let share = self.axes[other].share(compliance);
                    (edge.value > 0.0).then(|| Born {
                        contact_radius: s,
                        at: place(share, edge.value),
                        bend: edge.bend,
                    })
                };
                lines.extend(self.sampled(progress, &born));
            }
            return Ok(Some(lines));
        }
        Ok(None)
    }

    /// The cusps along the only axis, if its number enters linearly: s and the share of each, ascending by share. Empty
    /// for any other axis.
    ///
    /// # Errors
    /// A gap cannot be tabulated.
    pub fn births(&self) -> Result<Vec<[f64; 2]>, FamilyError> {
        if self.linear() != Some(0) || self.axes.len() != 1 {
            return Ok(Vec::new());
        }
        let (lo, hi) = (self.member(&[0.0])?, self.member(&[1.0])?);
        let [from, to] = self.axes[0].range;
        // How far F at its turning point lies above √(πγ/2), and the share at which F turns at this radius.
        let born = |s: f64| {
            let (a, b) = (lo.local(s)?.edge, hi.local(s)?.edge);
            let t = -a.slope / (b.slope - a.slope);
            (t >= 0.0).then(|| {
                (a.value + t * (b.value - a.value) - lo.root, self.axes[0].share(from + t * (to - from)))
            })
        };
        let mut found = Vec::new();
        for pair in self.sampled_radii().windows(2) {
            // If only one end has a value, go as far as there is one.
            let [mut a, mut b] = match (born(pair[0]), born(pair[1])) {
                (Some(_), Some(_)) => [pair[0], pair[1]],
                (Some(_), None) => [pair[0], last(&born, pair[1], pair[0])],
                (None, Some(_)) => [last(&born, pair[0], pair[1]), pair[1]],
                (None, None) => continue,
            };
            let (Some((f, _)), Some((g, _))) = (born(a), born(b)) else { continue };
            if (f > 0.0) == (g > 0.0) {
                continue;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (a + b);
                match born(middle) {
                    Some((off, _)) if (off > 0.0) == (f > 0.0) => a = middle,
                    Some(_) => b = middle,
                    None => break,
                }
            }
            // Only if it is no pole, and on the axis.
            let on_axis =
                |(off, share): &(f64, f64)| off.abs() <= f.abs().max(g.abs()) && (0.0..=1.0).contains(share);
            found.extend(born(a).filter(on_axis).map(|(_, share)| [a, share]));
        }
        found.sort_by(|a, b| a[1].total_cmp(&b[1]));
        Ok(found)
    }

    /// The lines of a function of s, split where it leaves the map, with their swallowtails.
    pub(super) fn sampled(
        &self,
        progress: &dyn Progress,
        born: &dyn Fn(f64) -> Option<Born>,
    ) -> Vec<ExplicitLine> {
        let mut lines: Vec<ExplicitLine> = vec![ExplicitLine::default()];
        let mut before: Option<(f64, Option<Born>)> = None;
        let good = |s: f64| born(s).filter(Born::is_inside);
        for s in self.sampled_radii() {
            if progress.stop() {
                break;
            }
            let here = good(s);
            if let Some((from, old)) = before {
                // Where the line enters or leaves the map, the part of the step that is on the map.
                let ends = match (old, here) {
                    (Some(old), Some(here)) => Some((old, here)),
                    (None, Some(here)) => good(last(&good, from, s)).map(|edge| (edge, here)),
                    (Some(old), None) => good(last(&good, s, from)).map(|edge| (old, edge)),
                    // Where F is steep, a whole line may lie between.
                    (None, None) => {
                        let ends = [(from, born(from)), (s, born(s))];
                        within(born, ends, SOUGHT).and_then(|middle| {
                            Some((good(last(&good, from, middle))?, good(last(&good, s, middle))?))
                        })
                    }
                };
                if let Some((a, b)) = ends {
                    refine(&good, a, b, DEPTH, &mut lines);
                }
                if here.is_none() {
                    lines.push(ExplicitLine::default());
                }
            }
            before = Some((s, here));
        }
        lines.retain(|(points, _)| points.len() > 1);
        lines
    }

    /// Radii that resolve g, from the end of the path to its start.
    pub fn sampled_radii(&self) -> Vec<f64> {
        let [from, to] = self.radii;
        let wave = self.wave().unwrap_or(0.1 * to);
        let step = (0.5 * wave / PER_HALF_WAVE).max((to - from) / MOST);
        let mut radii = Vec::new();
        let mut s = from;
        while s < to {
            radii.push(s);
            s += step.min(0.02 * s);
        }
        radii.push(to);
        radii
    }

    /// The length over which the gap changes, reduced, where it has one.
    pub fn wave(&self) -> Option<f64> {
        use crate::gap::Gap;
        self.preset.gap.feature_length().map(|wave| wave / self.length)
    }
}

/// 2s/k of a device for which s is a cusp; there are two such devices, the stiffer and the softer.
fn relative_compliance(s: f64, grips: &LocalLaw, soft: bool) -> Option<f64> {
    let [first, second, _] = third_of(grips, grips.control, s);
    let m = -2.0 * s * second / first;
    let square = 4.0 * m * m - 3.0 * (1.0 - m) * (1.0 - m);
    if !(m < 1.0 && m > 0.0 && square >= 0.0) {
        return None;
    }
    // The product of the two is 1/3.
    let larger = (2.0 * m + square.sqrt()) / (3.0 * (1.0 - m));
    Some(if soft { larger } else { 1.0 / (3.0 * larger) })
}

/// F under the device `to`, from F under `from`.
pub(super) fn edge_under(local: &LocalLaw, from: Control, to: Control, s: f64) -> EdgeJet {
    EdgeJet::of(to, s, third_of(local, from, s))
}

/// g', g'' and g''' from F and its derivatives under a device.
fn third_of(local: &LocalLaw, control: Control, s: f64) -> [f64; 3] {
    let weight = super::weight::Weight::of(control, s);
    let [f, df, ddf] = [local.edge.value, local.edge.slope, local.edge.bend].map(|x| x / weight.value);
    let second = df - weight.slope * f;
    [f, second, ddf - (weight.slope * weight.slope + weight.bend) * f - 2.0 * weight.slope * second]
}

/// The last radius at which `good` has an answer, on the way from `inside`, where it has one, to `outside`, where it
/// has none.
fn last<T>(good: &dyn Fn(f64) -> Option<T>, outside: f64, inside: f64) -> f64 {
    root::halved(inside, outside, |s| good(s).is_some())[0]
}

/// A radius at which the line is on the map, between two radii at which it is not. A line may cross the whole map in a
/// small part of a step, where F is steep.
fn within(
    born: &dyn Fn(f64) -> Option<Born>,
    [a, b]: [(f64, Option<Born>); 2],
    halvings: usize,
) -> Option<f64> {
    let is_sought = match (a.1, b.1) {
        // If both ends are beyond the same border, so is everything between them in so small a part.
        (Some(a), Some(b)) => (0..2).all(|k| a.at[k].max(b.at[k]) >= 0.0 && a.at[k].min(b.at[k]) <= 1.0),
        (None, None) => false,
        _ => true,
    };
    if halvings == 0 || !(is_sought || halvings > SOUGHT - BLIND) {
        return None;
    }
    let middle = 0.5 * (a.0 + b.0);
    let here = born(middle);
    if here.is_some_and(|here| here.is_inside()) {
        return Some(middle);
    }
    let parts = [[a, (middle, here)], [(middle, here), b]];
    parts.into_iter().find_map(|ends| within(born, ends, halvings - 1))
}

/// Appends the line from `a` to `b` to the last one, with points closer to each other than [`CLOSE`] and the
/// swallowtails between them. Where it leaves the map on the way, or jumps, a new line begins.
fn refine(good: &dyn Fn(f64) -> Option<Born>, a: Born, b: Born, depth: usize, lines: &mut Vec<ExplicitLine>) {
    let apart = hypot(a.at[0] - b.at[0], a.at[1] - b.at[1]);
    if apart > CLOSE {
        let [from, to] = [a.contact_radius, b.contact_radius];
        let middle = 0.5 * (from + to);
        if depth == 0 {
            return lines.push((vec![b], Vec::new()));
        }
        if let Some(middle) = good(middle) {
            refine(good, a, middle, depth - 1, lines);
            return refine(good, middle, b, depth - 1, lines);
        }
        if let Some(edge) = good(last(good, middle, from)) {
            refine(good, a, edge, depth - 1, lines);
        }
        lines.push(ExplicitLine::default());
        if let Some(edge) = good(last(good, middle, to)) {
            refine(good, edge, b, depth - 1, lines);
        }
        return;
    }
    let Some(line) = lines.last_mut() else { return };
    if line.0.is_empty() {
        line.0.push(a);
    }
    if (a.bend > 0.0) != (b.bend > 0.0)
        && let Some(tip) = tip(good, a, b)
    {
        line.0.push(tip);
        line.1.push(tip);
    }
    line.0.push(b);
}

/// The swallowtail between two points, where F'' passes through zero; `None` if it passes a pole.
fn tip(good: &dyn Fn(f64) -> Option<Born>, mut a: Born, mut b: Born) -> Option<Born> {
    let largest = a.bend.abs().max(b.bend.abs());
    for _ in 0..HALVINGS {
        let middle = good(0.5 * (a.contact_radius + b.contact_radius))?;
        if (middle.bend > 0.0) == (a.bend > 0.0) { a = middle } else { b = middle }
    }
    (a.bend.abs() <= largest).then_some(a)
}
