//! Where edges land when they run at held control.
//!
//! ```text
//! dα_i/dt = m_i (γ − G_i),  any mobilities m_i > 0;      step (J + μ D⁻¹) Δα = √γ − κ,  D = diag m
//! ```
//!
//! An edge that advances eases every other (the derivative of their κ with respect to it is negative), so this flow
//! keeps order. Started where all G ≤ γ, it only grows, and ends in the least equilibrium that contains its start,
//! whatever the mobilities. Started where all G ≥ γ, it only shrinks, to the greatest equilibrium inside its start. On
//! the way contacts merge, touch and vanish. Only a seed may be wider than the contact it becomes: its edges come back.

use super::balance::{Balance, CONVERGED, HeldEdges, LEFT, keeps_widths, moved, part_way};
use super::error::PathError;
use super::event::{Passed, PassedKind};
use super::lane::Lane;
use crate::annuli::{Contacts, points, points_on_the_way};
use crate::elementary::cbrt;
use crate::quasistatic::jump::EdgeDirection;
use nalgebra::DVector;
use std::ops::ControlFlow::{self, Break, Continue};

/// The most steps of one run.
const STEPS: usize = 4000;

/// The longest step, and the longest Newton step that may go back, in waves.
const LONGEST: f64 = 0.03;
const BACK: f64 = 0.02;

/// The kick at a limit point in waves, and as a share of the narrowest width.
const KICK: f64 = 2e-3;
const KICK_OF_WIDTH: f64 = 0.1;

/// Widths at which gaps close and contacts vanish: in waves, and in (γρ²)^{1/3}.
const NARROW: f64 = 0.004;
const NARROW_BY_ADHESION: f64 = 0.05;

/// An adhesive gap narrower than this many of these widths closes. In a valley G falls with the width of the gap, so
/// no gap this narrow is stable, and following one to nothing would take the most points of all.
const CLOSES: f64 = 5.0;

/// How fast edges move at a radius; no landing depends on it.
pub type Mobility<'a> = &'a (dyn Fn(f64) -> f64 + Sync);

/// The same mobility for all edges.
pub const EVEN: Mobility<'static> = &|_| 1.0;

impl Balance<'_> {
    /// The width below which a gap closes and a contact vanishes on the way.
    pub fn narrow(&self) -> f64 {
        let by_adhesion = cbrt(self.work_of_adhesion * self.ground.crest * self.ground.crest);
        let most = NARROW * self.ground.wave;
        if by_adhesion > 0.0 { most.min(NARROW_BY_ADHESION * by_adhesion) } else { most }
    }

    /// The contacts at a limit point, kicked along the null vector outward (`sense` 1) or inward (−1).
    pub fn kicked(&self, contacts: &Contacts, null: &DVector<f64>, sense: f64) -> Contacts {
        let narrowest = contacts.widths().into_iter().fold(f64::INFINITY, f64::min);
        let kick = (KICK * self.ground.wave).min(KICK_OF_WIDTH * narrowest);
        let sign = if null.sum() < 0.0 { -sense } else { sense };
        moved(contacts, &(null * (sign * kick / null.amax())))
    }

    /// The contacts with a small new one at a crest, whose edges advance.
    ///
    /// # Errors
    /// [`PathError`] where there is no state.
    pub fn seeded(&self, contacts: &Contacts, crest: f64, value: f64) -> Result<Contacts, PathError> {
        let root = self.work_of_adhesion.sqrt();
        let mut half = 0.5 * self.narrow();
        let mut found = contacts.clone();
        for _ in 0..30 {
            found = with_seed(contacts, crest, half);
            let held = self.held(&found, &points(self.ground, &found), value)?;
            let own = |edge: f64| (edge - crest).abs() <= 1.5 * half;
            let advances = found
                .edges()
                .iter()
                .zip(held.excess.iter())
                .all(|(edge, excess)| !own(edge.radius) || excess + root < root);
            if advances || self.work_of_adhesion == 0.0 {
                break;
            }
            half *= 0.5;
        }
        Ok(found)
    }

    /// Lets the edges of `start` run at the held control value, outward (`sense` 1) or inward (−1), to where they land; `None` where
    /// nothing is left. What happens on the way is added to `passed`.
    ///
    /// # Errors
    /// [`PathError`].
    pub fn run(
        &self,
        start: Contacts,
        value: f64,
        sense: f64,
        mobility: Mobility<'_>,
        passed: &mut Vec<Passed>,
    ) -> Result<Option<HeldEdges>, PathError> {
        // A seed may be wider than the contact it becomes; all else only grows while the control goes up.
        let kept = start.intervals().into_iter().filter(|[a, b]| b - a > 2.0 * self.narrow()).collect();
        let last = f64::INFINITY;
        let mut run = EdgeRun { balance: self, value, sense, mobility, kept, contacts: start, last, passed };
        for _ in 0..STEPS {
            self.progress.go_on()?;
            if let Break(landed) = run.step()? {
                return Ok(landed);
            }
        }
        Err(PathError::NoLanding { control_value: value, steps: STEPS })
    }

    /// A step of Newton's method, changed where an edge that covers a corner of the gap goes back towards it. κ varies
    /// there as the square root of the distance, in which the step is Newton's then; in the distance itself it would
    /// end on the other side, where nothing holds the edge.
    fn beside_corners(&self, contacts: &Contacts, mut step: DVector<f64>) -> DVector<f64> {
        /// The least share of the root that is left.
        const LEAST: f64 = 0.25;
        /// Nearer than this, in waves, an edge may cross the corner.
        const ON: f64 = 1e-9;
        let corners = self.ground.stops();
        for (edge, way) in contacts.edges().iter().zip(step.iter_mut()).filter(|(_, way)| **way < 0.0) {
            let covered = |corner: &f64| edge.sign * (edge.radius - corner);
            let behind =
                corners.iter().map(covered).filter(|distance| *distance > 0.0).min_by(f64::total_cmp);
            if let Some(distance) = behind.filter(|distance| *distance > ON * self.ground.wave) {
                let root = distance.sqrt();
                let left = (root + 0.5 * *way / root).max(LEAST * root);
                *way = way.max(left * left - distance);
            }
        }
        step
    }

    /// A step of the flow.
    fn damped(
        &self,
        held: &HeldEdges,
        lowest: f64,
        sense: f64,
        mobility: Mobility<'_>,
    ) -> Result<DVector<f64>, PathError> {
        let contacts = &held.state.contacts;
        let scales = self.scales(contacts).edges;
        let slow: Vec<f64> = contacts.edges().iter().map(|edge| mobility(edge.radius).recip()).collect();
        let size = held.jacobian.amax();
        let fastest = slow.iter().copied().fold(f64::INFINITY, f64::min);
        let mut mu = if lowest > 0.0 { 0.0 } else { 1.3 * lowest.abs() / fastest };
        // An edge slightly beyond its place stands still until the others ease it; what is left is corrected at the
        // end.
        let push = held.excess.map(|excess| if -excess * sense < 0.0 { 0.0 } else { -excess });
        let stands: Vec<bool> = push.iter().map(|push| *push == 0.0).collect();
        for _ in 0..200 {
            let mut matrix = held.jacobian.clone();
            for (i, slow) in slow.iter().enumerate() {
                matrix[(i, i)] += mu * slow;
                if stands[i] {
                    matrix.row_mut(i).fill(0.0);
                    matrix[(i, i)] = 1.0;
                }
            }
            if let Some(step) = matrix.lu().solve(&push) {
                let right = step.iter().all(|x| x * sense >= 0.0 && x.is_finite());
                let next = moved(contacts, &step);
                let longest = step.component_div(&scales).amax();
                if right && longest <= LONGEST && keeps_widths(contacts, &next, LEFT) {
                    return Ok(step);
                }
            }
            mu = if mu > 0.0 { 2.0 * mu } else { 0.05 * size / fastest };
        }
        Err(PathError::NoLanding { control_value: held.control_value, steps: 200 })
    }

    /// The contacts with a seed where the gap is negative.
    pub(super) fn touched(
        &self,
        held: &HeldEdges,
        value: f64,
        passed: &mut Vec<Passed>,
    ) -> Result<Option<Contacts>, PathError> {
        let Some(crest) = self.least_gap(held)?.filter(|crest| crest.gap < 0.0) else { return Ok(None) };
        passed.push(Passed { kind: PassedKind::Touch, radius: crest.radius });
        self.seeded(&held.state.contacts, crest.radius, value).map(Some)
    }

    /// The contacts without the gaps that are too narrow and, when they shrink, without the contacts that are too
    /// narrow.
    fn tidied(&self, mut contacts: Contacts, sense: f64, passed: &mut Vec<Passed>) -> Contacts {
        let narrow = self.narrow();
        let mut k = 0;
        while k < contacts.rings.len() {
            let inner = if k > 0 { contacts.rings[k - 1][1] } else { contacts.disc };
            let [a, b] = contacts.rings[k];
            let width = if inner > 0.0 { a - inner } else { 0.5 * a };
            let closes = if inner > 0.0 && self.work_of_adhesion > 0.0 { CLOSES * narrow } else { narrow };
            // Without adhesion a dimple at the axis stays open.
            let dimple = inner <= 0.0 && self.work_of_adhesion == 0.0 && self.ground.is_dimpled();
            if width >= closes || dimple {
                k += 1;
                continue;
            }
            passed.push(Passed { kind: PassedKind::Merge, radius: 0.5 * (inner + a) });
            contacts.rings.remove(k);
            match k.checked_sub(1) {
                Some(before) => contacts.rings[before][1] = b,
                None => contacts.disc = b,
            }
        }
        if sense < 0.0 {
            contacts.rings.retain(|[a, b]| {
                let stays = b - a >= narrow;
                if !stays {
                    passed.push(Passed { kind: PassedKind::Vanish, radius: 0.5 * (a + b) });
                }
                stays
            });
            if contacts.has_disc() && contacts.disc < narrow {
                passed.push(Passed { kind: PassedKind::Vanish, radius: 0.0 });
                contacts.disc = 0.0;
            }
        }
        contacts
    }
}

/// Whether a run goes on, or is over with the edges where they land or with none.
type RunStep = ControlFlow<Option<HeldEdges>>;

/// Edges that run at a held control value.
struct EdgeRun<'r, 'b> {
    balance: &'r Balance<'b>,
    value: f64,
    sense: f64,
    mobility: Mobility<'r>,
    /// The contacts that may not open on the way up.
    kept: Vec<[f64; 2]>,
    contacts: Contacts,
    /// The size of the previous step if it was one of Newton's method, and infinite if not.
    last: f64,
    passed: &'r mut Vec<Passed>,
}

impl EdgeRun<'_, '_> {
    /// One step; where the edges land or nothing is left, the run is over.
    fn step(&mut self) -> Result<RunStep, PathError> {
        let Self { balance, value, sense, .. } = *self;
        self.contacts = balance.tidied(std::mem::take(&mut self.contacts), sense, self.passed);
        if self.contacts.is_empty() {
            return Ok(Break(None));
        }
        if let Some(lane) = balance.lane_of(&self.contacts) {
            return self.on_lane(lane);
        }
        // Only the end of the run, which Newton's method finds, needs all digits.
        let resolution = if self.last.is_finite() { points } else { points_on_the_way };
        let held = balance.held(&self.contacts, &resolution(balance.ground, &self.contacts), value)?;
        if sense < 0.0 && balance.lets_go(&held) {
            return Ok(Continue(()));
        }
        let lowest = Balance::least_eigenvalue(&held);
        let newton = (lowest > 0.0).then(|| held.jacobian.clone().lu().solve(&-&held.excess)).flatten();
        let newton = newton.filter(|step| step.iter().all(|x| x.is_finite()));
        let newton = newton.map(|step| balance.beside_corners(&self.contacts, step));
        let scales = balance.scales(&self.contacts).edges;
        let size_of = |step: &DVector<f64>| step.component_div(&scales).amax();
        if let Some(step) = &newton {
            let size = size_of(step);
            if self.last.is_finite() && size <= CONVERGED || (size <= 1e-10 && size > 0.3 * self.last) {
                return self.arrived(held);
            }
            let next = moved(&self.contacts, step);
            if size <= BACK && keeps_widths(&self.contacts, &next, LEFT) {
                (self.contacts, self.last) = (next, size);
                return Ok(Continue(()));
            }
        }
        self.last = f64::INFINITY;
        if sense > 0.0 && balance.least_gap(&held)?.is_some_and(|crest| crest.gap < 0.0) {
            // Checked with all digits: beside an edge the gap is as small as the error.
            let held = balance.held(&self.contacts, &points(balance.ground, &self.contacts), value)?;
            if let Some(touched) = balance.touched(&held, value, self.passed)? {
                self.contacts = touched;
                return Ok(Continue(()));
            }
        }
        let step = balance.damped(&held, lowest, sense, self.mobility)?;
        // Where no edge is driven on, the last step went beyond the equilibrium.
        let is_beyond = sense > 0.0 && size_of(&step) <= CONVERGED;
        let back = newton.filter(|_| is_beyond).and_then(|step| back(&self.contacts, &step, &self.kept));
        self.contacts = back.unwrap_or_else(|| moved(&self.contacts, &step));
        Ok(Continue(()))
    }

    /// A disc that runs on its known equilibria.
    fn on_lane(&mut self, lane: &Lane) -> Result<RunStep, PathError> {
        let Self { balance, value, sense, .. } = *self;
        let run = if sense > 0.0 { EdgeDirection::Outward } else { EdgeDirection::Inward };
        if balance.is_pinned(self.contacts.disc) {
            let held = balance.held(&self.contacts, &points(balance.ground, &self.contacts), value)?;
            if !balance.lets_go(&held) {
                return Ok(Break(Some(held)));
            }
        }
        match balance.disc_run(lane, &self.contacts, value, run)? {
            Some(held) => self.arrived(held),
            None => Ok(Break(None)),
        }
    }

    /// Edges at an equilibrium: the run is over, unless a crest touches there.
    fn arrived(&mut self, held: HeldEdges) -> Result<RunStep, PathError> {
        let touches = self.sense > 0.0;
        let touched = if touches { self.balance.touched(&held, self.value, self.passed)? } else { None };
        let Some(touched) = touched else { return Ok(Break(Some(held))) };
        (self.contacts, self.last) = (touched, f64::INFINITY);
        Ok(Continue(()))
    }
}

/// The contacts on the way back to an equilibrium that a step overran; `None` where something `kept` would open.
fn back(contacts: &Contacts, newton: &DVector<f64>, kept: &[[f64; 2]]) -> Option<Contacts> {
    let found = part_way(contacts, newton, 1.0)?;
    let contains = |[from, to]: [f64; 2]| found.intervals().iter().any(|[a, b]| *a <= from && to <= *b);
    kept.iter().all(|kept| contains(*kept)).then_some(found)
}

/// The contacts with one more from `crest` − `half` to `crest` + `half`, a disc at the axis.
pub(super) fn with_seed(contacts: &Contacts, crest: f64, half: f64) -> Contacts {
    let mut found = contacts.clone();
    if crest <= half {
        found.disc = found.disc.max(half);
    } else {
        found.rings.push([crest - half, crest + half]);
        found.rings.sort_by(|a, b| a[0].total_cmp(&b[0]));
    }
    found
}
