//! Equilibria that are computed radius by radius, as series on panels: those of a basis, or of a zone by its outer
//! edge.
//!
//! For a basis the variable is u = √s, in which δ and P of an adhesive disc are smooth down to the axis. Each panel
//! takes `NODES` equilibria and is halved while its series do not end. A stretch without equilibria, as rings have
//! where they are too coarse for the gap, is a hole.

use super::basis::{Basis, Evaluation, Order};
use super::chebyshev::{self, ChebyshevRule};
use super::solution::{Edges, Local, Solution};
use super::span::Place;
use crate::gap::{panels::Span, panels::Variable};
use crate::problem::{Control, Reduced};
use crate::progress::{Progress, Stopped};
use std::sync::Arc;

/// Equilibria on a panel.
const NODES: usize = 20;

/// A share of a zone in contact that counts as none, relative to what it is elsewhere on the panel.
const NO_CONTACT: f64 = 1e-13;

/// A hole of this share of its radius is narrow.
const NARROW: f64 = 1e-3;

/// The outer end of a panel is at most this many times as far out as its inner end.
const RATIO: f64 = 4.0;

/// Halvings of a panel that begins at the axis: on a gap like r^1.4 no series ends there, and a zone of any size may be
/// the one that is looked for.
const AT_AXIS: usize = 40;

/// This many panels on one span show that halving leads nowhere: the equilibria are noise to the digits asked for.
const MOST: usize = 400;

/// The most panels at the start.
const PANELS: f64 = 2000.0;

/// How fine panels are.
#[derive(Debug, Clone, Copy)]
pub struct Fineness {
    /// The last coefficients of δ and P, relative to the largest, at which a panel is fine enough.
    pub tail: f64,
    /// Halvings of a panel without a hole.
    pub halvings: usize,
    /// Halvings of any panel: they set how well the ends of a hole are known.
    pub of_holes: usize,
    /// The limit on these coefficients after all halvings: a panel that exceeds it is a hole, because the equilibria
    /// jump on it.
    pub loose: f64,
}

/// For ring elements: many digits below their accuracy. Where the gap is not smooth a series ends no sooner on a
/// narrower panel, because each ring that passes a corner leaves one in δ(s). The ends of a hole are known to a
/// thousandth of half a wave.
const OF_RINGS: Fineness = Fineness { tail: 1e-9, halvings: 4, of_holes: 9, loose: f64::INFINITY };

/// So far beyond the beginning of a panel, whose width is 2, slopes are free of rounding and the same as there.
const BESIDE: f64 = 1e-6;

/// One equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampledState {
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// dδ/da and dP/da, where a is the radius it was computed for.
    pub slopes: [f64; 2],
    /// U.
    pub energy: f64,
    /// For a zone that ends at that radius, the share (s/c)² of it that is in contact.
    pub share: f64,
}

/// One panel: the series of δ, P, dδ/dv, dP/dv, U, and of the share of a zone that is in contact.
#[derive(Debug)]
pub struct SampledPanel {
    span: Span,
    series: [Vec<f64>; 6],
}

impl SampledPanel {
    /// Its width, a length.
    pub fn width(&self) -> f64 {
        self.span.hi - self.span.lo
    }
}

/// Equilibria in panels.
#[derive(Debug, Default)]
pub struct Sampled {
    panels: Vec<Arc<SampledPanel>>,
    /// For zones: where contact in them begins or ends.
    touches: Option<Vec<Place>>,
}

impl Sampled {
    /// The equilibria of `basis` from the radius `from` to `to`, `None` where there are none; `progress` is asked between radii.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn new(
        basis: &dyn Basis,
        problem: &Reduced,
        [from, to]: [f64; 2],
        progress: &dyn Progress,
    ) -> Result<Option<Self>, Stopped> {
        let wave = problem.gap.feature_length().map_or(f64::INFINITY, |wave| 0.5 * wave);
        let width = wave.max((to - from) / PANELS);
        let mut borders = vec![to];
        let mut hi = to;
        while hi > from {
            hi = (hi / RATIO).max(hi - width).max(from);
            // What is left over gets no panel of its own.
            if hi < from * (1.0 + 1e-9) {
                hi = from;
            }
            borders.push(hi);
        }
        borders.reverse();
        let mut panels = Vec::new();
        let source = |radii: &[f64]| {
            let found = basis.equilibria(problem, radii, Order::Slopes, progress);
            let sample = |at: &Evaluation| SampledState {
                approach: at.approach,
                force: at.force,
                slopes: at.slopes(),
                energy: at.energy,
                share: 1.0,
            };
            found.iter().map(sample).collect()
        };
        for pair in borders.windows(2) {
            let span = Span { lo: pair[0], hi: pair[1], variable: Variable::Root { base: 0.0 } };
            resolve(&source, span, OF_RINGS, progress, &mut panels)?;
        }
        Ok((!panels.is_empty()).then_some(Self { panels, touches: None }))
    }

    /// Zones in ascending panels; contact in them begins or ends at the radii `touches`, which are borders of panels.
    pub fn of_zones(panels: Vec<Arc<SampledPanel>>, touches: &[f64]) -> Self {
        let mut zones = Self { panels, touches: None };
        zones.touches = Some(touches.iter().filter_map(|radius| zones.place(*radius)).collect());
        zones
    }
}

/// Gives the equilibria at radii, up to the first radius that has none.
type SampleSource<'a> = dyn Fn(&[f64]) -> Vec<SampledState> + 'a;

/// Adds panels that resolve what `source` gives on `span`.
///
/// # Errors
/// [`Stopped`].
pub fn resolve(
    source: &SampleSource<'_>,
    span: Span,
    fineness: Fineness,
    progress: &dyn Progress,
    panels: &mut Vec<Arc<SampledPanel>>,
) -> Result<(), Stopped> {
    let most = panels.len() + MOST;
    panel(source, span, fineness, (0, most), progress, panels)
}

/// Adds the panels of a span that has been halved `depth` times; beyond `most` panels no more digits are looked for.
fn panel(
    source: &SampleSource<'_>,
    span: Span,
    fineness: Fineness,
    (depth, most): (usize, usize),
    progress: &dyn Progress,
    panels: &mut Vec<Arc<SampledPanel>>,
) -> Result<(), Stopped> {
    let rule = ChebyshevRule::of(NODES);
    let radii: Vec<f64> = rule.nodes.iter().map(|x| span.radius(*x)).collect();
    let found = source(&radii);
    if found.len() < NODES {
        progress.go_on()?;
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
        let made = SampledPanel {
            span,
            series: [
                series(&|j| found[j].approach),
                series(&|j| found[j].force),
                series(&|j| found[j].slopes[0] * stretch(j)),
                series(&|j| found[j].slopes[1] * stretch(j)),
                series(&|j| found[j].energy),
                series(&|j| found[j].share),
            ],
        };
        let ends = |tail: f64| {
            made.series[..4].iter().all(|series| {
                let largest = |part: &[f64]| part.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
                tail.is_infinite() || largest(&series[NODES - 3..]) <= tail * largest(series)
            })
        };
        let is_last =
            panels.len() >= most || depth >= if span.lo > 0.0 { fineness.halvings } else { AT_AXIS };
        if ends(fineness.tail) || is_last && ends(fineness.loose) {
            panels.push(Arc::new(made));
            return Ok(());
        }
    }
    if depth >= if span.lo > 0.0 { fineness.of_holes } else { AT_AXIS } {
        return Ok(());
    }
    let middle = span.radius(0.0);
    panel(source, Span { hi: middle, ..span }, fineness, (depth + 1, most), progress, panels)?;
    panel(source, Span { lo: middle, ..span }, fineness, (depth + 1, most), progress, panels)
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
        let SampledPanel { span, series } = &*self.panels[place.panel];
        let sum = |k: usize, x: f64| chebyshev::sum(&series[k], x);
        // Where contact begins within a zone, v is 0 and so are all slopes with respect to it, though those with respect to the radius
        // are not: there they are taken a little further on.
        let begins = self.touches.is_some() && span.stretch(place.x) <= 0.0;
        let beside = if begins { place.x + BESIDE } else { place.x };
        Local {
            contact_radius: span.radius(place.x),
            approach: sum(0, place.x),
            force: sum(1, place.x),
            slopes: [sum(2, beside), sum(3, beside)],
            stretch: span.stretch(beside),
        }
    }

    fn energy(&self, place: Place) -> f64 {
        chebyshev::sum(&self.panels[place.panel].series[4], place.x)
    }

    fn edges(&self, place: Place) -> Edges {
        let SampledPanel { span, series } = &*self.panels[place.panel];
        let radius = span.radius(place.x);
        if self.touches.is_none() {
            return Edges { contact_radius: radius, zone: None };
        }
        let share = chebyshev::sum(&series[5], place.x);
        let size: f64 = series[5].iter().map(|c| c.abs()).sum();
        let contact_radius = if share > NO_CONTACT * size { radius * share.sqrt() } else { 0.0 };
        Edges { contact_radius, zone: Some(radius) }
    }

    fn is_passed(&self, panel: usize) -> bool {
        // Where zones jump from one root of D to another, a hole remains, as narrow as panels get by halving.
        let most = if self.touches.is_some() { NARROW } else { 0.0 };
        let next = self.panels.get(panel + 1).map(|next| next.span.lo);
        next.is_some_and(|lo| lo <= self.panels[panel].span.hi * (1.0 + most))
    }

    fn touches(&self) -> &[Place] {
        self.touches.as_deref().unwrap_or_default()
    }

    fn tendency(&self, panel: usize, control: Control) -> (Vec<f64>, f64) {
        let [_, _, delta, force, ..] = &self.panels[panel].series;
        let (of_delta, of_force) = control.weights();
        let series: Vec<f64> =
            delta.iter().zip(force).map(|(delta, force)| of_delta * delta + of_force * force).collect();
        let size = series.iter().map(|c| c.abs()).sum();
        (series, size)
    }
}
