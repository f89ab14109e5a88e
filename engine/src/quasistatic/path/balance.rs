//! Equilibrium of any number of contacts under a device: κ = √γ at every edge.
//!
//! P = P⁰ + P¹δ and κ = κ⁰ + κ¹δ at held edges, so the control value c gives δ, and with f = 0, 1/P¹, 1/(P¹ + k)
//!
//! ```text
//! displacement δ = c       force δ = (c − P⁰)/P¹       spring δ = (kc − P⁰)/(P¹ + k)
//! J = ∂κ/∂α − f κ¹ (∂P/∂α)ᵀ,    ∂P/∂α_j = 4πe_j κ_j κ¹_j,    ∂κ/∂c = κ¹ (1, 1/P¹, k/(P¹ + k))
//! ```
//!
//! A state is stable where all eigenvalues of J are positive. J = S·diag(e κ) with S symmetric, so they are real where
//! κ > 0.

use super::lane::Lane;
use crate::annuli::{
    AnnuliError, AnnuliState, Around, Contacts, GapMinimum, Ground, Resolution, Wanted, points,
    points_on_the_way,
};
use crate::disc::outside;
use crate::problem::{ContactKind, Control};
use crate::progress::{Progress, Stopped};
use nalgebra::{DMatrix, DVector};
use std::cell::RefCell;
use std::f64::consts::{PI, TAU};

/// The most Newton steps, from edges that are near.
const ITERATIONS: usize = 30;

/// The size of a Newton step that ends the iteration, in waves; once steps no longer shrink, the second is enough.
pub const CONVERGED: f64 = 1e-12;
const STALLED: f64 = 1e-9;

/// A Newton step is cut to this many waves.
const LONGEST: f64 = 0.1;
/// A step leaves at least this share of every width.
pub const LEFT: f64 = 0.4;

/// A gap below zero by less than this share of |δ| + √(2πγs) is rounding.
const ROUNDING: f64 = 1e-12;

/// Contacts under a device.
#[derive(Clone)]
pub struct Balance<'a> {
    /// The gap.
    pub ground: &'a Ground,
    /// γ in reduced units.
    pub work_of_adhesion: f64,
    /// The device.
    pub control: Control,
    /// Whether crests outside may touch.
    pub contact: ContactKind,
    /// Asked while the edges run.
    pub progress: &'a dyn Progress,
    /// The equilibria of one disc alone, where they are known: edges run on them directly.
    pub lane: Option<&'a Lane>,
    /// The radii of edges that are held as long as their G is below γ, where closing edges gained less.
    pub pinned: Option<&'a RefCell<Vec<f64>>>,
}

/// Edges at a control value, in equilibrium or not.
#[derive(Debug, Clone)]
pub struct HeldEdges {
    /// The contacts with their pressures.
    pub state: AnnuliState,
    /// c.
    pub control_value: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// κ − √γ of every edge.
    pub excess: DVector<f64>,
    /// J = ∂κ/∂α at held control, edges × edges.
    pub jacobian: DMatrix<f64>,
    /// ∂κ/∂c.
    pub by_control: DVector<f64>,
}

/// Why Newton's method found no equilibrium.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotFound {
    /// There is no state on the way.
    #[error(transparent)]
    State(#[from] AnnuliError),
    /// J is singular.
    #[error("the edges are at a limit point")]
    Singular,
    /// The iteration did not end.
    #[error("Newton's method did not converge: its last step was {step} waves")]
    Unfinished {
        /// The largest part of the last step, in waves.
        step: f64,
    },
}

impl Balance<'_> {
    /// The edges of `contacts` at the control value, with the given points on the rings.
    ///
    /// # Errors
    /// [`AnnuliError`].
    pub fn held(
        &self,
        contacts: &Contacts,
        points: &Resolution,
        value: f64,
    ) -> Result<HeldEdges, AnnuliError> {
        let state = self.ground.state_with(contacts, points, Wanted::Rates)?;
        let [p0, p1] = state.force;
        let (delta, factor, by_value) = self.approach(&state, value);
        let mut jacobian = state.jacobian(delta, self.ground.slope(contacts.disc));
        let edges = contacts.edges();
        let kappa = state.intensities(delta);
        if factor != 0.0 {
            for (j, edge) in edges.iter().enumerate() {
                let force = 4.0 * PI * edge.radius * kappa[j] * state.intensity[j][1];
                for i in 0..edges.len() {
                    jacobian[(i, j)] -= factor * state.intensity[i][1] * force;
                }
            }
        }
        let root = self.work_of_adhesion.sqrt();
        let excess = DVector::from_iterator(edges.len(), kappa.iter().map(|kappa| kappa - root));
        let by_control =
            DVector::from_iterator(edges.len(), state.intensity.iter().map(|[_, slope]| slope * by_value));
        let force = p0 + p1 * delta;
        let mut held =
            HeldEdges { state, control_value: value, approach: delta, force, excess, jacobian, by_control };
        self.pin(&mut held);
        Ok(held)
    }

    /// Whether what is left of κ − √γ at every edge may be rounding: where a hole is narrow, solving for the pressures
    /// loses digits, and corrections stall at the error that this leaves in the edges.
    pub fn is_rounding(&self, held: &HeldEdges) -> bool {
        const SHARE: f64 = 1e-8;
        held.excess.amax() <= SHARE * self.work_of_adhesion.sqrt()
    }

    /// Whether an edge at this radius is held.
    pub fn is_pinned(&self, radius: f64) -> bool {
        self.pinned.is_some_and(|pinned| pinned.borrow().iter().any(|held| is_same(*held, radius)))
    }

    /// Held edges have no equation to satisfy, and nothing moves them.
    fn pin(&self, held: &mut HeldEdges) {
        if self.pinned.is_none() {
            return;
        }
        let size = held.jacobian.amax();
        for (i, edge) in held.state.contacts.edges().iter().enumerate() {
            if self.is_pinned(edge.radius) {
                held.jacobian.row_mut(i).fill(0.0);
                held.jacobian[(i, i)] = size;
                (held.excess[i], held.by_control[i]) = (0.0, 0.0);
            }
        }
    }

    /// The held edge that is nearest to moving: its radius, and κ − √γ there.
    pub fn nearest_to_moving(&self, held: &HeldEdges) -> Option<(f64, f64)> {
        self.pinned?;
        let root = self.work_of_adhesion.sqrt();
        let edges = held.state.contacts.edges().into_iter().zip(held.state.intensities(held.approach));
        let pinned = edges.filter(|(edge, _)| self.is_pinned(edge.radius));
        pinned.map(|(edge, kappa)| (edge.radius, kappa - root)).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Lets go of the edge at this radius.
    pub fn let_go(&self, radius: f64) {
        if let Some(pinned) = self.pinned {
            pinned.borrow_mut().retain(|held| !is_same(*held, radius));
        }
    }

    /// Lets go of the held edge nearest to moving if it would move; returns whether it did.
    pub fn lets_go(&self, held: &HeldEdges) -> bool {
        let before = self.nearest_to_moving(held).filter(|(_, excess)| *excess > 0.0);
        if let Some((radius, _)) = before {
            self.let_go(radius);
        }
        before.is_some()
    }

    /// How unstable edges begin to run: the eigenvector of the least eigenvalue of J, outward at every edge, by
    /// inverse iteration. Adhesive edges ease each other, so no component has the other sign.
    pub fn softest(held: &HeldEdges) -> DVector<f64> {
        /// The shift is below the eigenvalue by this share of J: the other eigenvalues are further away.
        const BELOW: f64 = 1e-10;
        const TIMES: usize = 6;
        let n = held.excess.len();
        let shift = Self::least_eigenvalue(held) - BELOW * held.jacobian.amax();
        let lu = (&held.jacobian - DMatrix::identity(n, n) * shift).lu();
        let mut way = DVector::from_element(n, 1.0);
        for _ in 0..TIMES {
            let Some(next) = lu.solve(&way).filter(|next| next.amax().is_normal()) else { break };
            way = &next / next.amax();
        }
        if way.sum() < 0.0 { -way } else { way }
    }

    /// δ at the control value, f and ∂δ/∂c.
    fn approach(&self, state: &AnnuliState, value: f64) -> (f64, f64, f64) {
        let [p0, p1] = state.force;
        match self.control {
            Control::Displacement => (value, 0.0, 1.0),
            Control::Force => ((value - p0) / p1, p1.recip(), p1.recip()),
            Control::Stiffness(k) => ((k * value - p0) / (p1 + k), (p1 + k).recip(), k / (p1 + k)),
        }
    }

    /// κ of every edge at the control value, to the nine digits that a way between states needs.
    ///
    /// # Errors
    /// [`AnnuliError`].
    pub fn intensities(&self, contacts: &Contacts, value: f64) -> Result<Vec<f64>, AnnuliError> {
        let points = points_on_the_way(self.ground, contacts);
        let state = self.ground.state_with(contacts, &points, Wanted::Values)?;
        let (delta, ..) = self.approach(&state, value);
        Ok(state.intensities(delta))
    }

    /// The equilibrium with the same contacts at the control value, by Newton's method from these edges. They need not
    /// be near an equilibrium, but nothing is known about the states in between: no landing is claimed.
    ///
    /// # Errors
    /// [`NotFound`].
    pub fn solve(&self, from: &Contacts, value: f64) -> Result<HeldEdges, NotFound> {
        let points = points(self.ground, from);
        let mut contacts = from.clone();
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let held = self.held(&contacts, &points, value)?;
            let step = held.jacobian.clone().lu().solve(&-&held.excess).ok_or(NotFound::Singular)?;
            let size = step.amax() / self.ground.wave;
            if !size.is_finite() {
                return Err(NotFound::Singular);
            }
            if size <= CONVERGED || (size <= STALLED && size > 0.3 * last) {
                return Ok(held);
            }
            last = size;
            contacts = part_way(&contacts, &step, (LONGEST / size).min(1.0))
                .ok_or(NotFound::Unfinished { step: size })?;
        }
        Err(NotFound::Unfinished { step: last })
    }

    /// Whether, or how nearly, edges are stable when the control is held: the least eigenvalue of J.
    pub fn least_eigenvalue(held: &HeldEdges) -> f64 {
        let j = &held.jacobian;
        let n = j.nrows();
        match n {
            0 => f64::NAN,
            1 => j[(0, 0)],
            _ => {
                // J_ij J_ji is a square where κ > 0; a pressed edge eases no other, and stands alone.
                let off = |i: usize, k: usize| {
                    let (a, b) = (j[(i, k)], j[(k, i)]);
                    if a < 0.0 && b < 0.0 { -(a * b).sqrt() } else { 0.0 }
                };
                let symmetric = DMatrix::from_fn(n, n, |i, k| if i == k { j[(i, i)] } else { off(i, k) });
                if symmetric.iter().all(|x| x.is_finite()) {
                    symmetric.symmetric_eigenvalues().min()
                } else {
                    f64::NAN
                }
            }
        }
    }

    /// The least gap outside the contacts and its radius, among crests only; `None` where nothing can come near, or
    /// where only one disc is followed.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn least_gap(&self, held: &HeldEdges) -> Result<Option<GapMinimum>, Stopped> {
        if self.contact == ContactKind::OneDisc {
            return Ok(None);
        }
        let to = self.ground.can_touch_up_to(held.approach);
        let contacts = &held.state.contacts;
        if contacts.is_disc() {
            // Searched with the table, which is as fine as the gap there.
            let end = to.min(self.ground.reach());
            let opening = (TAU * self.work_of_adhesion * contacts.disc).sqrt();
            let overlap = -ROUNDING * (held.approach.abs() + opening);
            if end <= contacts.disc {
                return Ok(None);
            }
            let (panels, s) = (&self.ground.panels, contacts.disc);
            let least = outside::least_gap(panels, s, held.approach, end, overlap, self.progress);
            let found = least.at.map(|[radius, gap]| GapMinimum {
                radius,
                gap: if gap < overlap { gap } else { gap.max(0.0) },
            });
            let overlaps = found.is_some_and(|crest| crest.gap < 0.0);
            // A search that gave up says nothing about what lies beyond: that is sampled, as it is around rings.
            if overlaps || least.given_up.is_none() {
                return Ok(found);
            }
        }
        Ok(self.crests(held)?.into_iter().min_by(|a, b| a.gap.total_cmp(&b.gap)))
    }

    /// The minima of the gap outside the contacts that could touch, from the axis outward.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn crests(&self, held: &HeldEdges) -> Result<Vec<GapMinimum>, Stopped> {
        let around = Around::new(self.ground, &held.state, held.approach);
        around.crests(self.ground.can_touch_up_to(held.approach), self.progress)
    }
}

/// Whether two numbers stand for one radius.
fn is_same(a: f64, b: f64) -> bool {
    const SHARE: f64 = 1e-10;
    (a - b).abs() <= SHARE * b
}

/// The contacts with every α changed.
pub fn moved(contacts: &Contacts, by: &DVector<f64>) -> Contacts {
    let radii: Vec<f64> =
        contacts.edges().iter().zip(by.iter()).map(|(edge, by)| edge.radius + edge.sign * by).collect();
    contacts.with_edges(&radii)
}

/// The contacts after at most the share `most` of a step, halved until no width falls below [`LEFT`] of itself.
pub fn part_way(contacts: &Contacts, step: &DVector<f64>, most: f64) -> Option<Contacts> {
    const HALVINGS: usize = 20;
    let shares = std::iter::successors(Some(most), |share| Some(0.5 * share)).take(HALVINGS);
    shares.map(|share| moved(contacts, &(step * share))).find(|next| keeps_widths(contacts, next, LEFT))
}

/// Whether every width of `next` is at least this share of what it was.
pub fn keeps_widths(before: &Contacts, next: &Contacts, share: f64) -> bool {
    // A disc that shrank through the axis has no edge left.
    before.edge_count() == next.edge_count()
        && next.check().is_ok()
        && before.widths().iter().zip(next.widths()).all(|(old, new)| new >= share * old)
}
