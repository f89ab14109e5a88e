//! The equilibria of one disc in one zone over all outer edges, in panels that are grown outward on demand.
//!
//! Panels end where contact in the zone begins or ends, at the corners of the gap, and where the edge of contact passes
//! a corner. Beyond the first touch s grows like √(c − c₀), and that is the variable of the panels.

use super::around::ZoneAt;
use super::state::{Zone, ZoneState};
use crate::annuli::Ground;
use crate::disc::chebyshev::{self, ChebyshevRule};
use crate::disc::sampled::{Fineness, Sampled, SampledPanel, SampledState, resolve};
use crate::disc::{Solution, Table, TableError};
use crate::elementary::cbrt;
use crate::gap::panels::{Span, Variable};
use crate::problem::Cohesion;
use crate::progress::Progress;
use std::sync::Arc;

/// For series that are read to eleven digits; where δ(c) jumps from one root to another, no state of one disc in one
/// zone lies between them.
const FINENESS: Fineness = Fineness { tail: 1e-11, halvings: 13, of_holes: 14, loose: 1e-5 };

/// The largest ratio of a panel's outer end to its inner end.
const RATIO: f64 = 3.0;

/// The width of a panel before it is halved, as a share of the length over which the gap changes there.
const SHARE_OF_LENGTH: f64 = 0.25;

/// How many times as wide as the last panel a new one may be before it is halved.
const WIDER: f64 = 2.0;

/// Nodes at which the touch is looked for on a panel.
const NODES: usize = 32;

/// A root within this share of a radius from a border is the root of that border.
const AT_BORDER: f64 = 1e-9;

/// Halvings of an edge.
const HALVINGS: usize = 60;

/// Most panels.
const MOST: usize = 20_000;

/// How far beyond the zone the table reaches at first.
const BEYOND: f64 = 1.3;

/// The equilibria of one gap and tension, as far out as they have been asked for.
#[derive(Debug)]
pub struct Equilibria {
    /// The gap with its table.
    pub ground: Ground,
    /// The zone problem that is solved.
    pub zone: Zone,
    panels: Vec<Arc<SampledPanel>>,
    touches: Vec<f64>,
    /// The panels reach out to here, a length.
    at: f64,
    /// Where the present contact began.
    base: Option<f64>,
}

impl Equilibria {
    /// No equilibria yet.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn new(
        table: &Arc<Table>,
        cohesion: Cohesion,
        reach: f64,
        progress: &dyn Progress,
    ) -> Result<Self, TableError> {
        let ground = Ground::new(Arc::clone(table), BEYOND * reach, progress)?;
        let zone = Zone::new(Arc::clone(&ground.gap), Arc::clone(&ground.panels), cohesion);
        Ok(Self { ground, zone, panels: Vec::new(), touches: Vec::new(), at: 0.0, base: None })
    }

    /// What has been found so far.
    pub fn solution(&self) -> Arc<dyn Solution> {
        Arc::new(Sampled::of_zones(self.panels.clone(), &self.touches))
    }

    /// The outer edges of the zone at which contact in it begins or ends, lengths.
    pub fn touches(&self) -> &[f64] {
        &self.touches
    }

    /// How far out equilibria have been looked for, a length.
    pub fn reach(&self) -> f64 {
        self.at
    }

    /// Whether there is nothing further out: the gap is not known there, or it would take too many panels.
    pub fn is_whole(&self) -> bool {
        self.at >= self.end() || self.panels.len() > MOST
    }

    /// The largest edge there can be.
    fn end(&self) -> f64 {
        0.995 * self.ground.table.end()
    }

    /// Extends the table of the gap to `radius`, or to where the gap ends; returns whether it reaches further than
    /// before.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn look(&mut self, radius: f64, progress: &dyn Progress) -> Result<bool, TableError> {
        let known = self.ground.reach();
        if radius <= known || known >= self.ground.table.end() * (1.0 - 1e-9) {
            return Ok(false);
        }
        self.ground = Ground::new(Arc::clone(&self.ground.table), radius.max(1.5 * known), progress)?;
        self.zone =
            Zone::new(Arc::clone(&self.ground.gap), Arc::clone(&self.ground.panels), self.zone.cohesion);
        Ok(true)
    }

    /// Adds panels until `enough` accepts the last state as far enough out, or the gap ends.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn grow(
        &mut self,
        enough: &dyn Fn(&ZoneState) -> bool,
        progress: &dyn Progress,
    ) -> Result<(), TableError> {
        while !self.is_whole() {
            self.next(progress)?;
            if self.zone.state(self.at, None).is_some_and(|state| enough(&state)) {
                break;
            }
        }
        Ok(())
    }

    /// Where the first panel ends: well inside the first touch.
    fn first(&self) -> f64 {
        /// The share of the first touch.
        const SHARE: f64 = 0.25;
        let mut c = self.ground.reach();
        let mut found = c;
        for _ in 0..4 * HALVINGS {
            c *= 0.7;
            if self.zone.excess(c) > 0.0 {
                found = c;
            }
        }
        SHARE * found
    }

    /// One step outward.
    fn next(&mut self, progress: &dyn Progress) -> Result<(), TableError> {
        let lo = self.at;
        let mut hi = if lo > 0.0 {
            // About as wide as the last panel that was fine enough.
            let widest = SHARE_OF_LENGTH * self.ground.length_at(lo);
            let last = self.panels.last().map_or(widest, |panel| panel.width());
            (RATIO * lo).min(lo + widest.min(WIDER * last))
        } else {
            self.first()
        };
        let end = self.end();
        if hi > end * (1.0 - AT_BORDER) {
            hi = end;
        }
        self.look(BEYOND * hi, progress)?;
        if let Some(stop) = self.ground.stops().iter().find(|stop| **stop > lo * (1.0 + AT_BORDER)) {
            hi = hi.min(*stop);
        }
        // The slope by c itself has a sign at the axis.
        let variable = self.base.map_or(Variable::Radius, |base| Variable::Root { base });
        let span = Span { lo, hi, variable };
        // Where contact begins or ends.
        let excess = ChebyshevRule::of(NODES).series(|x| self.zone.excess(span.radius(x)));
        let size: f64 = excess.iter().map(|c| c.abs()).sum();
        let roots = chebyshev::roots(&excess, f64::EPSILON * size);
        let inside = (lo + AT_BORDER * hi)..(hi - AT_BORDER * hi);
        let cut = roots.into_iter().map(|x| span.radius(x)).find(|c| inside.contains(c));
        let touch = cut.map(|c| self.touch(c, [lo, hi]));
        let mut hi = touch.unwrap_or(hi);
        let contact = self.zone.excess(Span { hi, ..span }.radius(0.0)) > 0.0;
        if contact && let Some(corner) = self.corner([lo, hi]) {
            hi = corner;
        }
        let span = Span { hi, ..span };
        let zone = &self.zone;
        let source = |radii: &[f64]| samples(zone, radii, progress);
        resolve(&source, span, FINENESS, progress, &mut self.panels)?;
        self.at = hi;
        if touch == Some(hi) {
            self.touches.push(hi);
            self.base = (!contact).then_some(hi);
        }
        Ok(())
    }

    /// The root of the excess near `c`, to rounding.
    fn touch(&self, mut c: f64, [lo, hi]: [f64; 2]) -> f64 {
        for _ in 0..4 {
            let step = 1e-6 * (hi - lo);
            let slope = (self.zone.excess(c + step) - self.zone.excess(c - step)) / (2.0 * step);
            let next = c - self.zone.excess(c) / slope;
            if !(next > lo && next < hi) {
                break;
            }
            c = next;
        }
        c
    }

    /// The first edge between two at which the contact ends on a corner of the gap.
    fn corner(&self, [lo, hi]: [f64; 2]) -> Option<f64> {
        let radius = |c: f64| self.zone.state(c, None).map(|state| state.contact_radius);
        let begin = self.base.filter(|base| *base >= lo).map_or_else(|| radius(lo), |_| Some(0.0))?;
        let end = radius(hi)?;
        let (least, most) = (begin.min(end), begin.max(end));
        let margin = 1e-7 * self.ground.wave;
        let mut between = self
            .ground
            .stops()
            .iter()
            .copied()
            .filter(|stop| *stop > least + margin && *stop < most - margin);
        let corner = if end > begin { between.next() } else { between.next_back() }?;
        let (mut near, mut far) = (lo, hi);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            let passed = (radius(middle)? > corner) == (end > begin);
            if passed { far = middle } else { near = middle }
        }
        (far < hi).then_some(far)
    }
}

/// The states at edges, up to the first edge without a state.
fn samples(zone: &Zone, edges: &[f64], progress: &dyn Progress) -> Vec<SampledState> {
    let mut near = None;
    let mut found = Vec::with_capacity(edges.len());
    for edge in edges {
        let state = if progress.stop() { None } else { zone.state(*edge, near) };
        let Some(ZoneState { approach, force, slopes, energy, share, .. }) = state else { break };
        near = (share > 0.0).then_some(share);
        found.push(SampledState { approach, force, slopes, energy, share });
    }
    found
}

impl From<ZoneState> for ZoneAt {
    fn from(state: ZoneState) -> Self {
        Self { edge: state.edge, contact_radius: state.contact_radius, approach: state.approach }
    }
}

/// Roughly how far a zone with contact of radius `s` reaches, for R = 1: where a path starts to look.
pub fn about(cohesion: Cohesion, s: f64) -> f64 {
    let wide = (2.0 * cohesion.range).sqrt().min(cbrt(cohesion.work()) + cohesion.range / cohesion.strength);
    s + wide
}
