//! The equilibria of a basis that is asked radius by radius, as series on panels.
//!
//! With u = √s as the variable, in which δ and P of an adhesive disc are smooth down to the axis. Each panel takes
//! `NODES` equilibria and is halved while its series do not end. A stretch without equilibria, as rings have where they
//! are too coarse for the gap, is a hole.

use super::basis::{Basis, Order};
use super::chebyshev::{self, Rule};
use super::solution::{Local, Solution};
use super::span::Place;
use crate::gap::Gap;
use crate::gap::{panels::Span, panels::Variable};
use crate::problem::{Control, Reduced};
use crate::progress::Progress;

/// Equilibria on a panel.
const NODES: usize = 20;

/// The last coefficients of δ and P, relative to the largest, at which a panel is fine enough: below what rings are good for
/// by many digits.
const TAIL: f64 = 1e-9;

/// Halvings of a panel, and so the ends of a hole to a thousandth of half a wave.
const HALVINGS: usize = 9;

/// Halvings of a panel without a hole: where the gap is not smooth a series ends no sooner on a narrower one, for each ring that
/// passes a corner leaves one in δ(s).
const FOR_SERIES: usize = 4;

/// A panel is at most so many times as far out at its outer end as at its inner.
const RATIO: f64 = 4.0;

/// Panels at the start at most.
const PANELS: f64 = 2000.0;

/// One panel: the series of δ, P, dδ/du, dP/du and U.
#[derive(Debug)]
struct Panel {
    span: Span,
    series: [Vec<f64>; 5],
}

/// The equilibria of a basis, in panels.
#[derive(Debug)]
pub struct Sampled {
    panels: Vec<Panel>,
}

impl Sampled {
    /// The equilibria of `basis` from the radius `from` to `to`; `progress` is asked between radii.
    pub fn new(
        basis: &dyn Basis,
        problem: &Reduced,
        [from, to]: [f64; 2],
        progress: &dyn Progress,
    ) -> Option<Self> {
        let wave = problem.gap.feature_length().map_or(f64::INFINITY, |wave| 0.5 * wave);
        let width = wave.max((to - from) / PANELS);
        let mut borders = vec![to];
        let mut hi = to;
        while hi > from {
            hi = (hi / RATIO).max(hi - width).max(from);
            // What is left over is no panel of its own.
            if hi < from * (1.0 + 1e-9) {
                hi = from;
            }
            borders.push(hi);
        }
        borders.reverse();
        let mut panels = Vec::new();
        for pair in borders.windows(2) {
            panel(basis, problem, [pair[0], pair[1]], HALVINGS, progress, &mut panels)?;
        }
        (!panels.is_empty()).then_some(Self { panels })
    }
}

/// Adds the panels from `lo` to `hi`; `None` when `progress` said stop.
fn panel(
    basis: &dyn Basis,
    problem: &Reduced,
    [lo, hi]: [f64; 2],
    depth: usize,
    progress: &dyn Progress,
    panels: &mut Vec<Panel>,
) -> Option<()> {
    let span = Span { lo, hi, variable: Variable::Root { base: 0.0 } };
    let rule = Rule::of(NODES);
    let radii: Vec<f64> = rule.nodes.iter().map(|x| span.radius(*x)).collect();
    let found = basis.equilibria(problem, &radii, Order::Slopes, progress);
    if found.len() < NODES && progress.stop() {
        return None;
    }
    let whole = found.len() == NODES && found.iter().all(|e| e.approach.is_finite() && e.force.is_finite());
    if whole {
        let series = |of: &dyn Fn(usize) -> f64| {
            let samples: Vec<f64> = (0..NODES).map(of).collect();
            let mut out = vec![0.0; NODES];
            rule.coefficients(&samples, &mut out);
            out
        };
        let stretch = |j: usize| span.stretch(rule.nodes[j]);
        let made = Panel {
            span,
            series: [
                series(&|j| found[j].approach),
                series(&|j| found[j].force),
                series(&|j| found[j].slopes()[0] * stretch(j)),
                series(&|j| found[j].slopes()[1] * stretch(j)),
                series(&|j| found[j].energy),
            ],
        };
        let ends = made.series[..4].iter().all(|series| {
            let largest = |part: &[f64]| part.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
            largest(&series[NODES - 3..]) <= TAIL * largest(series)
        });
        if ends || depth <= HALVINGS - FOR_SERIES {
            panels.push(made);
            return Some(());
        }
    }
    if depth == 0 {
        return Some(());
    }
    let middle = 0.25 * (lo.sqrt() + hi.sqrt()).powi(2);
    panel(basis, problem, [lo, middle], depth - 1, progress, panels)?;
    panel(basis, problem, [middle, hi], depth - 1, progress, panels)
}

impl Solution for Sampled {
    fn len(&self) -> usize {
        self.panels.len()
    }

    fn span(&self, panel: usize) -> &Span {
        &self.panels[panel].span
    }

    fn place(&self, s: f64) -> Option<Place> {
        let panel = self.panels.partition_point(|panel| panel.span.hi < s);
        let span = self.panels.get(panel)?.span;
        (s >= span.lo).then(|| Place { panel, x: span.place(s) })
    }

    fn at(&self, place: Place) -> Local {
        let Panel { span, series } = &self.panels[place.panel];
        let sum = |k: usize| chebyshev::sum(&series[k], place.x);
        Local {
            contact_radius: span.radius(place.x),
            approach: sum(0),
            force: sum(1),
            slopes: [sum(2), sum(3)],
            stretch: span.stretch(place.x),
        }
    }

    fn energy(&self, place: Place) -> f64 {
        chebyshev::sum(&self.panels[place.panel].series[4], place.x)
    }

    fn tendency(&self, panel: usize, control: Control) -> (Vec<f64>, f64) {
        let [.., delta, force, _] = &self.panels[panel].series;
        let (of_delta, of_force) = control.weights();
        let series: Vec<f64> =
            delta.iter().zip(force).map(|(delta, force)| of_delta * delta + of_force * force).collect();
        let size = series.iter().map(|c| c.abs()).sum();
        (series, size)
    }
}
