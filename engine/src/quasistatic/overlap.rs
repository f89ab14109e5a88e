//! Where a curve or a path passes states that are not admissible, and at which crest.
//!
//! Where the state is stable under displacement control the gap at every radius outside falls as the disc grows,
//!
//! ```text
//! d gap(r)/ds = −(2/π)[√(2πγs)/√(r² − s²) + (dδ/ds) arccos(s/r)] < 0   where dδ/ds ≥ 0,
//! ```
//!
//! so on such a stretch the verdict can change only once: its two ends, and one root in between, settle it. Elsewhere,
//! and without adhesion, where the pressure has a say, every state of the curve is examined.

use super::admissible::{Admissibility, Crest, Judge};
use super::curve::Curve;
use super::monotone::Monotone;
use crate::problem::Control;
use crate::progress::{Progress, Stopped};
use std::sync::Arc;

/// An end is located when its bracket is this small relative to it.
const LOCATED: f64 = 1e-9;

/// Neighbouring states of a curve that are not admissible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// The largest contact radius.
    pub from: f64,
    /// The smallest contact radius.
    pub to: f64,
    /// The crest that overlaps most among the states looked at; `None` where only the pressure is at fault.
    pub crest: Option<Crest>,
}

impl Overlap {
    /// Whether the state of contact radius `s` is one of them.
    pub fn contains(&self, s: f64) -> bool {
        self.to <= s && s <= self.from
    }
}

/// The states of `curve` that are not admissible, from its start inward; `progress` is asked before each.
///
/// # Errors
/// [`Stopped`].
pub fn overlaps(curve: &Curve, progress: &dyn Progress) -> Result<Vec<Overlap>, Stopped> {
    passed(curve, &[[curve.outermost(), curve.innermost()]], progress)
}

/// The states that are not admissible on pieces of the curve, each from one contact radius inward to another, both
/// included: what a path passes, see [`Path::pieces`](super::Path::pieces).
///
/// `progress` is asked before each state.
///
/// # Errors
/// [`Stopped`].
pub fn passed(curve: &Curve, pieces: &[[f64; 2]], progress: &dyn Progress) -> Result<Vec<Overlap>, Stopped> {
    let mut curve = curve.clone();
    curve.reach(pieces.iter().map(|[from, _]| *from).fold(0.0, f64::max));
    let mut search = OverlapSearch {
        judge: curve.equilibrium.judge(),
        stretches: curve.monotone(Control::Displacement),
        curve: &curve,
        progress,
        found: Vec::new(),
        open: None,
    };
    for &[from, to] in pieces {
        search.piece(from, to)?;
        search.open = None;
    }
    Ok(search.found)
}

/// Why a state is not admissible.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Violation {
    /// A crest overlaps; its number, where it has one.
    Crest(Option<u64>),
    /// The disc would have to pull.
    Pressure,
}

struct OverlapSearch<'a> {
    curve: &'a Curve,
    judge: Judge,
    stretches: Arc<Monotone>,
    progress: &'a dyn Progress,
    found: Vec<Overlap>,
    /// The fault of the interval that is still open.
    open: Option<Violation>,
}

impl OverlapSearch<'_> {
    /// The state of radius `s`.
    fn state(&mut self, s: f64) -> Result<Admissibility, Stopped> {
        self.progress.go_on()?;
        let place = self.curve.solution.place(s).ok_or(Stopped)?;
        let verdict = self.judge.verdict(s, self.curve.solution.at(place).approach, self.progress);
        // The first state needs the table far out, which may take long.
        self.progress.go_on().map(|()| verdict)
    }

    /// One piece, from `from` inward to `to`.
    fn piece(&mut self, from: f64, to: f64) -> Result<(), Stopped> {
        let monotone = Arc::clone(&self.stretches);
        let adhesive = self.curve.equilibrium.problem.work_of_adhesion > 0.0;
        for stretch in monotone.stretches.iter().rev() {
            let (outer, inner) = (stretch.radii[1].min(from), stretch.radii[0].max(to));
            if inner > outer || (inner >= outer && from > to) {
                continue;
            }
            if stretch.rising && adhesive {
                self.once(outer, inner)?;
            } else {
                self.each(outer, inner)?;
            }
        }
        Ok(())
    }

    /// A stretch on which the verdict can change once, from inadmissible outside to admissible inside.
    fn once(&mut self, outer: f64, inner: f64) -> Result<(), Stopped> {
        let outside = self.state(outer)?;
        if outside.holds {
            self.open = None;
            return Ok(());
        }
        let inside = self.state(inner)?;
        let end = if inside.holds { self.end(outer, inner)? } else { inner };
        self.add(outer, end, &outside);
        if inside.holds {
            self.open = None;
        }
        Ok(())
    }

    /// A stretch whose states are examined one by one.
    fn each(&mut self, outer: f64, inner: f64) -> Result<(), Stopped> {
        let curve = self.curve;
        let between = curve.samples.iter().map(|at| at.contact_radius).filter(|s| inner < *s && *s < outer);
        let mut last: Option<(f64, bool)> = None;
        for s in std::iter::once(outer).chain(between).chain([inner]) {
            let here = self.state(s)?;
            match last {
                Some((good, true)) if !here.holds => {
                    let from = self.end(s, good)?;
                    self.add(from, s, &here);
                }
                Some((bad, false)) if here.holds => {
                    let to = self.end(bad, s)?;
                    if let Some(overlap) = self.found.last_mut() {
                        overlap.to = to;
                    }
                    self.open = None;
                }
                _ if !here.holds => self.add(s, s, &here),
                _ => self.open = None,
            }
            last = Some((s, here.holds));
        }
        Ok(())
    }

    /// Adds the states from `from` inward to `to`, which fail as `state` does, to the open interval, or begins a new
    /// one: each crest, and the pressure, has an interval of its own.
    fn add(&mut self, from: f64, to: f64, state: &Admissibility) {
        let crest = state.overlapping();
        let cause = crest.map_or(Violation::Pressure, |crest| Violation::Crest(crest.wave));
        match self.found.last_mut() {
            Some(overlap) if self.open == Some(cause) => {
                overlap.to = to;
                let gap = |crest: Option<Crest>| crest.map_or(f64::INFINITY, |crest| crest.gap);
                if gap(crest) < gap(overlap.crest) {
                    overlap.crest = crest;
                }
            }
            _ => self.found.push(Overlap { from, to, crest }),
        }
        self.open = Some(cause);
    }

    /// The last radius that is not admissible between one that is not and one that is, by halving.
    fn end(&mut self, mut bad: f64, mut good: f64) -> Result<f64, Stopped> {
        while (good - bad).abs() > LOCATED * bad {
            let middle = 0.5 * (good + bad);
            if self.state(middle)?.holds { good = middle } else { bad = middle }
        }
        Ok(bad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disc::{ExactBasis, Table};
    use crate::gap::Shape;
    use crate::problem::{Problem, Reduced};
    use crate::progress::{Unwatched, until};
    use crate::quasistatic::Detail;
    use crate::quasistatic::path::{PathSetting, unload};
    use std::f64::consts::TAU;
    use std::sync::Arc;

    fn wavy(amplitude: f64, wavelength: f64, gamma: f64) -> Reduced {
        let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude, wavelength };
        Problem { effective_modulus: 1.0, work_of_adhesion: gamma, shape }.reduced()
    }

    fn curve(problem: &Reduced, to: f64) -> Curve {
        let table = Arc::new(Table::new(Arc::clone(&problem.gap), 0.5, &Unwatched).unwrap());
        let basis = Arc::new(ExactBasis::new(Arc::clone(&table), 0.5));
        Curve::new(problem.clone(), basis, table, [0.5, to], Detail::Drawn, &Unwatched).unwrap().unwrap()
    }

    fn holds(curve: &Curve, s: f64) -> bool {
        let equilibrium = &curve.equilibrium;
        let at = equilibrium.basis.equilibrium(&equilibrium.problem, s).unwrap();
        equilibrium.judge().judge(s, at.approach, &Unwatched).holds
    }

    #[test]
    fn a_curve_says_where_it_is_inadmissible_and_at_which_crest() {
        let problem = wavy(0.0025, 0.05, 1e-4);
        let curve = curve(&problem, 0.04);
        let found = overlaps(&curve, &Unwatched).unwrap();
        // One below each crest from the tenth to the second: the edge is between it and the last trough.
        let crests: Vec<u64> = found.iter().filter_map(|overlap| overlap.crest?.wave).collect();
        assert_eq!(crests, [10, 9, 8, 7, 6, 5, 4, 3, 2]);
        for overlap in &found {
            let holds = |s: f64| holds(&curve, s);
            let (out, inward) = (1.0 + 2e-6, 1.0 - 2e-6);
            assert!(holds(overlap.from * out) && !holds(overlap.from * inward), "{overlap:?}");
            assert!(!holds(overlap.to * out) && holds(overlap.to * inward), "{overlap:?}");
        }
        // Every state of the figures of the paper is possible.
        let problem = wavy(0.0025, 0.05, 0.025 / TAU);
        assert_eq!(overlaps(&super::tests::curve(&problem, 0.02), &Unwatched).unwrap(), []);
    }

    #[test]
    fn a_path_passes_what_is_on_its_stable_pieces_alone() {
        let problem = wavy(0.0025, 0.05, 1e-4);
        let whole = curve(&problem, 0.04);
        let on_curve = overlaps(&whole, &Unwatched).unwrap();
        for control in [Control::Displacement, Control::Force] {
            let setting = PathSetting::one_disc(control);
            let pieces = unload(&whole, &setting, &Unwatched).unwrap().pieces();
            let met = passed(&whole, &pieces, &Unwatched).unwrap();
            let on_path = |s: f64| pieces.iter().any(|[outer, inner]| *inner <= s && s <= *outer);
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * b;
            for overlap in &met {
                assert!(on_path(overlap.from) && on_path(overlap.to), "{overlap:?}");
                // An end is one of the curve's, or that of a piece: a limit point or a landing.
                for s in [overlap.from, overlap.to] {
                    let of_curve = on_curve.iter().any(|o| near(o.from, s) || near(o.to, s));
                    assert!(of_curve || pieces.as_flattened().contains(&s), "{s} {pieces:?}");
                }
            }
            let unseen = on_curve.iter().filter(|o| on_path(0.5 * (o.from + o.to)));
            assert!(unseen.clone().all(|o| met.iter().any(|p| p.contains(0.5 * (o.from + o.to)))));
            // No more than asked for is looked at.
            assert_eq!(passed(&whole, &pieces, &until(3)), Err(Stopped));
        }
        assert_eq!(overlaps(&whole, &|| true), Err(Stopped));
    }
}
