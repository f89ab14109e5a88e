//! Where a curve or a path passes states that are not admissible, and at which crest.
//!
//! Every state is looked at, the ends of an interval are located on the curve to about 1e-6 by halving and false
//! position on the gap at the crest. An interval that fits between two states is not seen.

use super::admissible::{Admissibility, Crest};
use super::curve::{Curve, SWEEP_STEPS_PER_WAVE, radii};
use super::equilibrium::Equilibrium;
use crate::contact::Gap;
use crate::ritz::Order;

/// Rounds for the ends of an interval, in which halving alone comes to 1e-6 of a step; false position needs a third.
const ROUNDS: usize = 20;
/// An end is located when its bracket is this small relative to it.
const LOCATED: f64 = 2e-7;

/// Neighbouring states of a curve that are not admissible, for one reason: a crest, or the pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// The largest contact radius.
    pub from: f64,
    /// The smallest contact radius.
    pub to: f64,
    /// The crest that overlaps most among the points of the curve; `None` where only the pressure is at fault.
    pub crest: Option<Crest>,
}

impl Overlap {
    /// Whether the state of contact radius `s` is one of them.
    pub fn contains(&self, s: f64) -> bool {
        self.to <= s && s <= self.from
    }
}

/// The states of `curve` that are not admissible, from its start inward.
pub fn overlaps(curve: &Curve) -> Vec<Overlap> {
    overlaps_while(curve, &mut || true).unwrap_or_default()
}

/// The same; `go_on` is asked before each state, `None` when it said no.
pub fn overlaps_while(curve: &Curve, go_on: &mut dyn FnMut() -> bool) -> Option<Vec<Overlap>> {
    let state = |point| {
        let [delta, _, s] = curve.equilibrium.quantities(point);
        (s, delta)
    };
    along(&curve.equilibrium, curve.branch.points.iter().map(|point| state(&point.y)), go_on)
}

/// The states that are not admissible on pieces of the curve from one contact radius inward to another, both included:
/// what a path passes, see [`Unloading::pieces`](super::Unloading::pieces).
///
/// `go_on` is asked before each state, `None` when it said no.
pub fn passed_while(
    equilibrium: &Equilibrium,
    pieces: &[[f64; 2]],
    go_on: &mut dyn FnMut() -> bool,
) -> Option<Vec<Overlap>> {
    let Equilibrium { problem, basis, .. } = equilibrium;
    let mut wanted = true;
    let mut go_on = || {
        wanted = wanted && go_on();
        wanted
    };
    let mut found = Vec::new();
    for &[outer, inner] in pieces {
        let steps = radii(outer, inner, problem.gap.feature_length(), SWEEP_STEPS_PER_WAVE);
        let states = basis.equilibria(problem, &steps, Order::State, &mut go_on);
        found.extend(along(equilibrium, states.iter().map(|e| (e.contact_radius, e.approach)), &mut go_on)?);
    }
    wanted.then_some(found)
}

/// The inadmissible ones of neighbouring states (s, δ), running inward.
fn along(
    equilibrium: &Equilibrium,
    states: impl Iterator<Item = (f64, f64)>,
    go_on: &mut dyn FnMut() -> bool,
) -> Option<Vec<Overlap>> {
    let (problem, basis) = (&equilibrium.problem, equilibrium.basis.as_ref());
    let mut found: Vec<Overlap> = Vec::new();
    let mut open = false;
    let mut last: Option<f64> = None;
    for (s, delta) in states {
        if !go_on() {
            return None;
        }
        let here = Admissibility::of(problem, basis, s, delta);
        let fault = |crest: Option<Crest>| crest.map(|crest| crest.wave);
        match (here.holds, found.last_mut().filter(|_| open)) {
            // At another crest, or for the pressure: an interval of its own, which begins where this one ends.
            (false, Some(overlap)) if fault(here.overlapping()) != fault(overlap.crest) => {
                overlap.to = s;
                found.push(Overlap { from: s, to: s, crest: here.overlapping() });
            }
            (true, Some(overlap)) => overlap.to = end(equilibrium, s, overlap.to),
            (false, Some(overlap)) => {
                overlap.to = s;
                let gap = |crest: Option<Crest>| crest.map_or(f64::INFINITY, |crest| crest.gap);
                if gap(here.overlapping()) < gap(overlap.crest) {
                    overlap.crest = here.overlapping();
                }
            }
            (false, None) => {
                let from = last.map_or(s, |good| end(equilibrium, good, s));
                found.push(Overlap { from, to: s, crest: here.overlapping() });
            }
            (true, None) => {}
        }
        open = !here.holds;
        last = Some(s);
    }
    Some(found)
}

/// The end of an interval between an admissible radius and one that is not: the last that is not.
fn end(equilibrium: &Equilibrium, mut good: f64, mut bad: f64) -> f64 {
    let Equilibrium { problem, basis, .. } = equilibrium;
    // The nearest gap by the straight line between its values on both sides, where it has them.
    let mut gaps = [None; 2];
    for round in 0..ROUNDS {
        if (good - bad).abs() <= LOCATED * bad {
            break;
        }
        let share = match gaps {
            // Every third round halves, so that neither side can stay.
            [Some(above), Some(below)] if round % 3 != 2 && above > below => {
                // A little beyond the zero closes the bracket from the other side.
                let zero: f64 = above / (above - below);
                (zero + if zero < 0.5 { 1e-4 } else { -1e-4 }).clamp(1e-4, 1.0 - 1e-4)
            }
            _ => 0.5,
        };
        let middle = good + share * (bad - good);
        let found = basis
            .equilibrium(problem, middle)
            .map(|e| Admissibility::of(problem, basis.as_ref(), middle, e.approach));
        let gap = found.and_then(|found| found.nearest).map(|crest| crest.gap);
        if found.is_some_and(|found| found.holds) {
            (good, gaps[0]) = (middle, gap);
        } else {
            (bad, gaps[1]) = (middle, gap);
        }
    }
    bad
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Control, Problem, Reduced, Shape};
    use crate::quasistatic::unload::unload;
    use crate::ritz::{Basis, Spectral};
    use std::f64::consts::TAU;
    use std::sync::Arc;

    fn wavy(amplitude: f64, wavelength: f64, gamma: f64) -> Reduced {
        let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude, wavelength };
        Problem { effective_modulus: 1.0, work_of_adhesion: gamma, shape }.reduced()
    }

    fn holds(problem: &Reduced, basis: &dyn Basis, s: f64) -> bool {
        Admissibility::of(problem, basis, s, basis.equilibrium(problem, s).unwrap().approach).holds
    }

    #[test]
    fn a_curve_says_where_it_is_inadmissible_and_at_which_crest() {
        let problem = wavy(0.0025, 0.05, 1e-4);
        let basis: Arc<dyn Basis> = Arc::new(Spectral::resolving(&problem, 0.5).unwrap());
        let curve = Curve::swept(problem.clone(), Arc::clone(&basis), 0.5, 0.04, || true).unwrap();
        let found = overlaps(&curve);
        // One below each crest from the tenth to the second: the edge is between it and the last trough.
        let crests: Vec<u64> = found.iter().filter_map(|overlap| overlap.crest?.wave).collect();
        assert_eq!(crests, [10, 9, 8, 7, 6, 5, 4, 3, 2]);
        for overlap in &found {
            let holds = |s: f64| holds(&problem, basis.as_ref(), s);
            let (out, inward) = (1.0 + 2e-6, 1.0 - 2e-6);
            assert!(holds(overlap.from * out) && !holds(overlap.from * inward), "{overlap:?}");
            assert!(!holds(overlap.to * out) && holds(overlap.to * inward), "{overlap:?}");
        }
        // Every state of the figures of the paper is possible.
        let problem = wavy(0.0025, 0.05, 0.025 / TAU);
        let curve = Curve::swept(problem, basis, 0.5, 0.02, || true).unwrap();
        assert_eq!(overlaps(&curve), []);
    }

    #[test]
    fn a_path_passes_what_is_on_its_stable_pieces_alone() {
        let problem = wavy(0.0025, 0.05, 1e-4);
        let basis: Arc<dyn Basis> = Arc::new(Spectral::resolving(&problem, 0.5).unwrap());
        let whole = Curve::swept(problem, basis, 0.5, 0.04, || true).unwrap();
        let on_curve = overlaps(&whole);
        for control in [Control::Displacement, Control::Force] {
            let path = unload(&mut whole.clone(), control).unwrap();
            let passed = passed_while(&whole.equilibrium, &path.pieces, &mut || true).unwrap();
            let on_path = |s: f64| path.pieces.iter().any(|[outer, inner]| *inner <= s && s <= *outer);
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * b;
            for overlap in &passed {
                assert!(on_path(overlap.from) && on_path(overlap.to), "{overlap:?}");
                // An end is one of the curve's, or that of a piece: a limit point or a landing.
                for s in [overlap.from, overlap.to] {
                    let of_curve = on_curve.iter().any(|o| near(o.from, s) || near(o.to, s));
                    assert!(of_curve || path.pieces.as_flattened().contains(&s), "{s} {path:?}");
                }
            }
            let unseen = on_curve.iter().filter(|o| on_path(0.5 * (o.from + o.to)));
            assert!(unseen.clone().all(|o| passed.iter().any(|p| p.contains(0.5 * (o.from + o.to)))));
            // No more than asked for is looked at.
            let mut left = 3;
            let mut go_on = || {
                left -= 1;
                left >= 0
            };
            assert_eq!(passed_while(&whole.equilibrium, &path.pieces, &mut go_on), None);
        }
        assert_eq!(overlaps_while(&whole, &mut || false), None);
    }
}
