//! Where edges land that run at held control, with the rings that they make on the way.

use super::arrival::{Ahead, Arrival, Reached, WalkEnd, WalkFailure};
use super::corner::on_corner;
use super::edges::{self, Edges};
use super::walker::{At, Walk};
use crate::annuli::{AnnuliError, Contacts, Ground};
use crate::continuation::Vector;
use crate::problem::Control;
use crate::progress::Unwatched;
use crate::quasistatic::path::course::first_crest;
use crate::quasistatic::path::{Balance, Direction, EVEN, Held, Passed, PassedKind, PathError, PathState};
use crate::quasistatic::{Event, EventKind, Point};

/// How often the table is made longer for one landing.
const LONGER: usize = 12;

/// A new contact without adhesion begins at an approach further by this share of λ²/ρ.
const LIFT: f64 = 1e-3;

/// A jump, and where it lands.
pub(super) struct Jumped {
    pub ground: Ground,
    /// None where the bodies come apart.
    pub held: Option<Held>,
    pub event: Event,
    pub passed: Vec<Passed>,
}

impl Jumped {
    /// Whether a crest touched on the way.
    pub fn has_touched(&self) -> bool {
        self.passed.iter().any(|passed| passed.kind == PassedKind::Touch)
    }

    /// What it costs.
    pub fn ahead(&self) -> Ahead {
        Ahead { after: self.event.after.as_ref().map(PathState::state), dissipated: self.event.dissipated }
    }
}

impl Walk<'_> {
    /// The state of a disc, with what is to be known of it.
    pub(super) fn of_disc(&self, arrival: Arrival, point: Point) -> Reached {
        let equilibrium = self.equilibrium();
        let (state, stiffness) = equilibrium.state_and_stiffness(&point);
        Reached {
            arrival,
            stability: equilibrium.stability(&point),
            stiffness,
            admissibility: equilibrium.admissibility(&point, &Unwatched),
            digits: equilibrium.basis.trusted_digits(&equilibrium.problem, state.contact_radius),
            state,
            point,
        }
    }

    /// The state of a point with rings, with what is to be known of it.
    pub(super) fn of_rings(&self, ground: &Ground, arrival: Arrival, point: Point) -> Option<Reached> {
        let equilibrium = self.equilibrium();
        let base = edges::contacts(&equilibrium.scales, &point);
        let held = Edges::near(ground, equilibrium, base).held(&point, Control::Displacement)?;
        let judged = edges::judged(equilibrium, ground, &point, &held);
        let edges::Judged { state, stability, stiffness, admissibility, digits } = judged;
        Some(Reached { arrival, point, state, stability, stiffness, admissibility, digits })
    }

    /// The landed edges as a state: one disc, or more.
    pub(super) fn landed(
        &self,
        ground: &Ground,
        arrival: Arrival,
        held: &Held,
    ) -> Result<Reached, WalkFailure> {
        let contacts = &held.state.contacts;
        let missing = WalkFailure::NoEquilibrium("at the landing");
        if contacts.rings.is_empty() {
            let point = self.equilibrium().explicit(contacts.disc).ok_or(missing)?;
            return Ok(self.of_disc(arrival, point));
        }
        let edges = Edges::near(ground, self.equilibrium(), contacts.clone());
        let point = edges.point(held).ok_or(missing.clone())?;
        self.of_rings(ground, arrival, point).ok_or(missing)
    }

    /// Lets the edges run: with a ring from a touch; from a limit point to the side on which the control cannot follow; from any other
    /// unstable state as walked.
    pub(super) fn try_rings(&self) -> Result<Jumped, WalkFailure> {
        let from = self.begun("jump")?;
        let scales = &self.equilibrium().scales;
        let [delta, _] = edges::device(scales, from);
        let mut radius = edges::contacts(scales, from).outermost();
        for _ in 0..LONGER {
            let ground = self.ground(radius, delta)?;
            let table = &self.equilibrium().table;
            let whole = ground.reach() >= table.end() * (1.0 - 1e-9);
            match self.jumped(ground.clone(), from) {
                Err(PathError::State(AnnuliError::BeyondGap { .. })) if !whole => {
                    radius = 1.5 * ground.reach();
                }
                Err(PathError::State(AnnuliError::BeyondGap { .. })) => {
                    return Err(WalkFailure::NothingOutward);
                }
                Err(error) => return Err(WalkFailure::Edges(error.to_string())),
                Ok(jumped) => return jumped.ok_or(WalkFailure::Stable),
            }
        }
        Err(WalkFailure::NothingOutward)
    }

    /// The same on a gap known so far; `None` where nothing runs.
    fn jumped(&self, ground: Ground, from: &Point) -> Result<Option<Jumped>, PathError> {
        let equilibrium = self.equilibrium();
        let scales = &equilibrium.scales;
        let lost = |control_value| PathError::Lost { control_value };
        let contacts = edges::contacts(scales, from);
        let [delta, force] = edges::device(scales, from);
        // Without adhesion a ring begins with no width, a little further on.
        let adheres = equilibrium.problem.work_of_adhesion > 0.0;
        let control = if adheres { self.control } else { Control::Displacement };
        let balance = self.balance(&ground, control);
        let mut value = control.value(delta, force);
        let edges = Edges::near(&ground, equilibrium, contacts.clone());
        let before = edges.held(from, control).ok_or(lost(value))?;
        let mut passed = Vec::new();
        let (start, sense) = match self.at {
            At::Touch(radius) => {
                if !adheres {
                    value += LIFT * ground.wave.powi(2) / ground.crest;
                }
                passed.push(Passed { kind: PassedKind::Touch, radius });
                (balance.seeded(&contacts, radius, value)?, 1.0)
            }
            At::Limit => {
                let row = edges.control_row(control);
                // Beyond a maximum of the control there is nothing near for a contact that is larger, beyond a minimum for one that
                // is smaller.
                // On a corner of the gap there is no bend, but a slope on the side towards the axis: stored tangents run inward.
                let bend = if on_corner(&ground, &contacts) { &from.tangent() } else { &from.curvature() };
                let sense = if row.dot(bend) < 0.0 { 1.0 } else { -1.0 };
                let signs = contacts.edges();
                let along = from.tangent();
                let null = Vector::from_iterator(
                    signs.len(),
                    signs.iter().zip(along.iter().skip(2)).map(|(edge, e)| edge.sign * e),
                );
                (balance.kicked(&contacts, &null, sense), sense)
            }
            At::Nothing => {
                let least = Balance::least_eigenvalue(&before);
                if least > 0.0 || least.is_nan() {
                    return Ok(None);
                }
                let null = Balance::softest(&before);
                let sense = if self.inward { -1.0 } else { 1.0 };
                (balance.kicked(&contacts, &null, sense), sense)
            }
        };
        let held = balance.run(start, value, sense, EVEN, &mut passed)?;
        let gamma = balance.work_of_adhesion;
        let direction = if sense > 0.0 { Direction::Loading } else { Direction::Unloading };
        let state = |held: &Held| PathState::new(held, gamma, direction, 0);
        let (old, new) = (state(&before), held.as_ref().map(state));
        let crests: Vec<f64> = passed
            .iter()
            .filter(|passed| passed.kind == PassedKind::Touch)
            .map(|passed| passed.radius)
            .collect();
        let bounded = new.is_some() || control != Control::Force;
        let by_area =
            bounded.then(|| balance.area_between(Some(&old), new.as_ref(), value, &crests)).flatten();
        let kind = match (&new, self.at, sense > 0.0) {
            (None, ..) => EventKind::LastContact,
            (Some(_), At::Touch(_), _) => EventKind::Touch,
            (Some(_), _, true) => EventKind::SnapIn,
            (Some(_), _, false) => EventKind::Snap,
        };
        let radius = if let At::Touch(radius) = self.at { Some(radius) } else { None };
        let event = Event {
            kind,
            direction,
            control_value: value,
            radius,
            dissipated: if adheres { old.loss(control, new.as_ref()) } else { Some(0.0) },
            dissipated_by_area: if adheres { by_area } else { None },
            before: Some(PathState { stable: !kind.begins_at_limit(), ..old }),
            after: new,
            passed: Vec::new(),
        };
        Ok(Some(Jumped { ground, held, event, passed }))
    }

    /// The first touch of bodies that were apart and what it jumps to: where a walk begins that begins apart.
    ///
    /// # Errors
    /// [`WalkFailure`] where the gap has no least value, or the edges do not land.
    pub fn first_touch(&self, emit: &mut super::arrival::Emit<'_>) -> WalkEnd {
        match self.touched() {
            Ok(reached) => {
                emit(reached);
                WalkEnd::Done
            }
            Err(failure) => WalkEnd::Failed(failure),
        }
    }

    fn touched(&self) -> Result<Reached, WalkFailure> {
        let said = |error: PathError| WalkFailure::Edges(error.to_string());
        let adheres = self.equilibrium().problem.work_of_adhesion > 0.0;
        let mut radius = self.range[0];
        for _ in 0..LONGER {
            let ground = self.ground(radius, 0.0)?;
            let whole = ground.reach() >= self.equilibrium().table.end() * (1.0 - 1e-9);
            let crest = first_crest(&ground, &Unwatched);
            let Some(crest) = crest else {
                if whole {
                    return Err(WalkFailure::NeverTouches);
                }
                radius = 1.5 * ground.reach();
                continue;
            };
            let control = if adheres { self.control } else { Control::Displacement };
            let value = match control {
                Control::Force => 0.0,
                _ if adheres => crest.gap,
                _ => crest.gap + LIFT * ground.wave.powi(2) / ground.crest,
            };
            let balance = self.balance(&ground, control);
            let none = Contacts::default();
            let mut passed = Vec::new();
            let landed = balance
                .seeded(&none, crest.radius, value)
                .and_then(|start| balance.run(start, value, 1.0, EVEN, &mut passed));
            let held = match landed {
                Err(PathError::State(AnnuliError::BeyondGap { .. })) if !whole => {
                    radius = 1.5 * ground.reach();
                    continue;
                }
                landed => landed.map_err(said)?.ok_or(WalkFailure::NoEquilibrium("after the first touch"))?,
            };
            return self.landed(&ground, Arrival::Touch(crest.radius), &held);
        }
        Err(WalkFailure::NothingOutward)
    }
}
