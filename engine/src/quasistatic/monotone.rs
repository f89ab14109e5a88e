//! The stretches of the curve on which a control is monotone, and the limit points between them.
//!
//! Along the contact radius s the controlled quantity C rises where the state is stable and falls where it is not. Limit
//! points are the roots of its slope, found on every panel so that none is missed, and the breaks of the gap at which the
//! slope changes its sign without passing through zero. Between two of them C takes each value once: starts, landings and
//! crossings are single roots in brackets.

use super::equilibrium::Stability;
use crate::disc::{Local, Place, Solution, chebyshev};
use crate::problem::Control;
use std::ops::Range;

/// Values of the slope below this share of its terms are rounding.
const ROUNDING: f64 = 1e-14;

/// A root this near to an end of a panel, which is 2 long, is at the end.
const AT_END: f64 = 1e-13;

/// Limit points nearer to each other than this share of their radius are rounding.
const SAME: f64 = 1e-13;

/// Whether the control is smallest or largest at a limit point, along the contact radius.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extremum {
    /// A minimum over s: the edge runs inward from here (unloading).
    Minimum,
    /// A maximum over s: the edge runs outward from here (loading).
    Maximum,
}

/// A limit point of a control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// The control that turns here.
    pub control: Control,
    /// Which way it turns.
    pub turn: Extremum,
    /// Where it is.
    pub place: Place,
    /// s.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// Whether it sits on a break of the gap, where the curve has a corner.
    pub corner: bool,
}

/// A stretch on which the control is monotone, running outward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Its inner end.
    pub inner: Place,
    /// Its outer end.
    pub outer: Place,
    /// s at both.
    pub radii: [f64; 2],
    /// The weighted control at both, see [`Monotone::value`].
    pub values: [f64; 2],
    /// Whether it grows with s: stable.
    pub rising: bool,
    /// Whether another stretch ends where this one begins; otherwise the curve does.
    pub joined: bool,
}

impl Stretch {
    /// Whether the control takes `value` on it.
    pub fn takes(&self, value: f64) -> bool {
        let [a, b] = self.values;
        a.min(b) <= value && value <= a.max(b)
    }
}

/// The stretches of one control over a whole solution, from the axis outward.
#[derive(Debug, Clone, PartialEq)]
pub struct Monotone {
    /// The control.
    pub control: Control,
    /// The stretches.
    pub stretches: Vec<Stretch>,
    /// The limit points, ascending.
    pub limits: Vec<Limit>,
}

/// Where the slope changes its sign: the places on both sides, identical except at a corner.
struct Cut {
    before: Place,
    after: Place,
    joined: bool,
}

impl Monotone {
    /// The stretches of `control` on `solution`.
    pub fn of(solution: &dyn Solution, control: Control) -> Self {
        Self::on(solution, control, 0..solution.len())
    }

    /// The stretches on some panels of the solution.
    pub fn on(solution: &dyn Solution, control: Control, panels: Range<usize>) -> Self {
        let mut cuts: Vec<Cut> = Vec::new();
        let mut signs = Vec::new();
        let mut before: Option<(Place, bool)> = None;
        let first = panels.start;
        for panel in panels {
            let (series, size) = solution.tendency(panel, control);
            // At an end of a panel the slope may be nothing but rounding: its sign is that between the roots inside.
            let mut roots = chebyshev::roots(&series, ROUNDING * size);
            roots.retain(|x| x.abs() < 1.0 - AT_END);
            let first_root = roots.first().copied().unwrap_or(1.0);
            let starts = chebyshev::sum(&series, 0.5 * (first_root - 1.0)) > 0.0;
            let begin = Place { panel, x: -1.0 };
            if let Some((end, ended)) = before {
                let joined = solution.is_joined(end.panel);
                if !joined || ended != starts {
                    cuts.push(Cut { before: end, after: begin, joined });
                    signs.push(starts);
                }
            } else {
                signs.push(starts);
            }
            let mut sign = starts;
            for x in roots {
                sign = !sign;
                let at = Place { panel, x };
                cuts.push(Cut { before: at, after: at, joined: true });
                signs.push(sign);
            }
            before = Some((Place { panel, x: 1.0 }, sign));
        }
        let mut found = Self { control, stretches: Vec::new(), limits: Vec::new() };
        let Some((last, _)) = before else { return found };
        forget_rounding(solution, &mut cuts, &mut signs);
        let mut inner = solution.at(Place { panel: first, x: -1.0 });
        let mut begin = Place { panel: first, x: -1.0 };
        let mut joined = false;
        let outer_ends = cuts.iter().map(|cut| cut.before).chain([last]);
        for (k, outer) in outer_ends.enumerate() {
            let at = solution.at(outer);
            found.stretches.push(Stretch {
                inner: begin,
                outer,
                radii: [inner.contact_radius, at.contact_radius],
                values: [found.value(&inner), found.value(&at)],
                rising: signs[k],
                joined,
            });
            if let Some(cut) = cuts.get(k) {
                if cut.joined {
                    found.limits.push(Limit {
                        control,
                        turn: if signs[k + 1] { Extremum::Minimum } else { Extremum::Maximum },
                        place: cut.before,
                        contact_radius: at.contact_radius,
                        approach: at.approach,
                        force: at.force,
                        corner: cut.before != cut.after,
                    });
                }
                inner = if cut.after == outer { at } else { solution.at(cut.after) };
                begin = cut.after;
                joined = cut.joined;
            }
        }
        found
    }

    /// A positive multiple of the controlled quantity, the same for all states, which does not overflow however soft or stiff
    /// the device is.
    pub fn value(&self, at: &Local) -> f64 {
        weighted(self.control, at.approach, at.force)
    }

    /// The number of the stretch that holds the radius `s`; at a limit point, that of the stretch whose inner end it
    /// is.
    pub fn stretch_of(&self, s: f64) -> usize {
        let beyond = self.stretches.partition_point(|stretch| stretch.radii[1] <= s);
        beyond.min(self.stretches.len().saturating_sub(1))
    }

    /// The place on a stretch at which the weighted control takes `value`, or the end nearest to it.
    pub fn solve(&self, solution: &dyn Solution, stretch: &Stretch, value: f64) -> Place {
        let miss = |place: Place| self.value(&solution.at(place)) - value;
        let beyond = |miss: f64| (miss > 0.0) == stretch.rising;
        let (mut lo, mut hi) = (stretch.inner.panel, stretch.outer.panel);
        // The first panel at whose outer end the control is beyond the value.
        while lo < hi {
            let middle = usize::midpoint(lo, hi);
            if beyond(miss(Place { panel: middle, x: 1.0 })) {
                hi = middle;
            } else {
                lo = middle + 1;
            }
        }
        let panel = lo;
        let from = if panel == stretch.inner.panel { stretch.inner.x } else { -1.0 };
        let to = if panel == stretch.outer.panel { stretch.outer.x } else { 1.0 };
        let at = |x: f64| Place { panel, x };
        let [_, half] = solution.span(panel).line();
        let (of_approach, of_force) = self.control.weights();
        let (mut a, mut b) = (from, to);
        if beyond(miss(at(a))) {
            return at(a);
        }
        if !beyond(miss(at(b))) {
            return at(b);
        }
        let mut x = 0.5 * (a + b);
        for _ in 0..200 {
            let local = solution.at(at(x));
            let off = self.value(&local) - value;
            if beyond(off) {
                b = x;
            } else {
                a = x;
            }
            let slope = half * (of_approach * local.slopes[0] + of_force * local.slopes[1]);
            let mut next = x - off / slope;
            if !(next > a && next < b) {
                next = 0.5 * (a + b);
            }
            if (next - x).abs() <= f64::EPSILON || next <= a || next >= b {
                return at(next.clamp(a, b));
            }
            x = next;
        }
        at(x)
    }

    /// All places at which the weighted control takes `value`, ascending.
    pub fn crossings(&self, solution: &dyn Solution, value: f64) -> Vec<(Place, bool)> {
        let taken = self.stretches.iter().filter(|stretch| stretch.takes(value));
        taken.map(|stretch| (self.solve(solution, stretch, value), stretch.rising)).collect()
    }
}

/// The weighted control of δ and P, as in [`Monotone::value`].
pub fn weighted(control: Control, approach: f64, force: f64) -> f64 {
    let (of_approach, of_force) = control.weights();
    // Zero times any number, even an infinite one, counts as zero.
    let part = |weight: f64, x: f64| if weight == 0.0 { 0.0 } else { weight * x };
    part(of_approach, approach) + part(of_force, force)
}

/// Removes pairs of cuts that rounding made.
fn forget_rounding(solution: &dyn Solution, cuts: &mut Vec<Cut>, signs: &mut Vec<bool>) {
    let radius = |cut: &Cut| solution.span(cut.before.panel).radius(cut.before.x);
    let mut k = 0;
    while k + 1 < cuts.len() {
        let (a, b) = (radius(&cuts[k]), radius(&cuts[k + 1]));
        if cuts[k].joined && cuts[k + 1].joined && b - a <= SAME * b {
            cuts.drain(k..k + 2);
            signs.drain(k + 1..k + 3);
            k = k.saturating_sub(1);
        } else {
            k += 1;
        }
    }
}

impl Local {
    /// dδ/ds and dP/ds; infinite right of a break at which the slope of the gap jumps.
    pub fn stability(&self) -> Stability {
        let [approach, force] = self.slopes.map(|slope| slope / self.stretch);
        Stability { approach, force }
    }
}
