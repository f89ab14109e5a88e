//! Steps along the equilibria of any number of contacts, as a path takes them.

use super::arrival::{Arrival, Emit, WalkEnd, WalkFailure, Walked};
use super::edges;
use super::walker::{At, ROOM, Walk};
use crate::annuli::{Contacts, Ground, points};
use crate::problem::Control;
use crate::quasistatic::StatePoint;
use crate::quasistatic::path::{self, GROWTH, LONGEST, NotFound, PathError, SingularSide};

/// Where a step with rings ends.
struct RingStep {
    point: StatePoint,
    arrival: Arrival,
    /// The length that the next step may have, in the units of a path.
    length: Option<f64>,
}

impl Walk<'_> {
    pub(super) fn ring_steps(&self, count: usize, run: bool, emit: &mut Emit<'_>) -> Walked {
        let scales = &self.equilibrium().scales;
        let turned = |point: StatePoint| if self.inward { point } else { point.reversed() };
        let mut here = turned(self.begun("walk")?.clone());
        let (mut at, mut length) = (self.at, None);
        let [start, end] = self.range;
        let outermost = edges::contacts(scales, &here).outermost();
        let mut ground = self.ground(outermost, edges::device(scales, &here)[0])?;
        for _ in 0..count {
            let contacts = edges::contacts(scales, &here);
            let [delta, _] = edges::device(scales, &here);
            let whole = ground.reach() >= self.equilibrium().table.end() * (1.0 - 1e-9);
            let needed = ground.can_touch_up_to(delta).max(contacts.outermost() + ground.wave);
            if !whole && needed >= ground.reach() {
                ground = self.ground(1.2 * needed, delta)?;
            }
            let narrow = self.balance(&ground, self.control).narrow();
            if let Some(end) = closing(&contacts, narrow) {
                return Ok(end);
            }
            let stepped = match self.ring_step(&ground, &here, at, length, run) {
                Ok(stepped) => stepped,
                // Near its end a branch is steep.
                Err(failure) => return closing(&contacts, 10.0 * narrow).ok_or(failure),
            };
            (here, length, at) = (stepped.point, stepped.length, At::Nothing);
            let ended = match stepped.arrival {
                Arrival::Limit(_) => Some(WalkEnd::AtLimit),
                Arrival::Touch(_) => Some(WalkEnd::AtTouch),
                _ => None,
            };
            let arrival = match stepped.arrival {
                Arrival::Limit(_) => {
                    let stored = turned(here.clone());
                    Arrival::Limit(
                        self.standing(&stored, At::Limit).try_rings().ok().map(|jumped| jumped.ahead()),
                    )
                }
                other => other,
            };
            let reached = self.of_rings(&ground, arrival, turned(here.clone()));
            let reached = reached.ok_or(WalkFailure::NoEquilibrium("after the step"))?;
            let s = reached.state.contact_radius;
            if !emit(reached) {
                return Ok(WalkEnd::Paused);
            }
            if let Some(ended) = ended {
                return Ok(ended);
            }
            if self.inward && s < end {
                return Ok(WalkEnd::AtEnd);
            }
            if !self.inward && s > ROOM * start {
                return Ok(WalkEnd::OutOfRange);
            }
        }
        Ok(WalkEnd::Done)
    }

    /// One step, which ends at the first limit point of the control or the first touch.
    fn ring_step(
        &self,
        ground: &Ground,
        here: &StatePoint,
        at: At,
        length: Option<f64>,
        run: bool,
    ) -> Result<RingStep, WalkFailure> {
        let scales = &self.equilibrium().scales;
        let balance = self.balance(ground, self.control);
        let lost = || WalkFailure::Edges("the equilibria could not be followed further".to_owned());
        let from = edges::resumed(&balance, scales, here).ok_or_else(lost)?;
        // A step asked for by hand has the length of a step of one disc.
        let asked = self.length / edges::direction(&balance, scales, &from).1;
        let wanted = if run { length.unwrap_or(asked).min(LONGEST) } else { asked };
        // A step from a limit point must go to the side on which, by its bend, the control goes on; one that ends
        // elsewhere has passed another limit point.
        let bend = edges::of_control(self.control, scales, &here.curvature());
        let goes_on = |end: &path::PathPoint| at != At::Limit || end.along_control() * bend > 0.0;
        let mut taken = balance.step(&from, wanted, &[], &goes_on).ok_or_else(lost)?;
        let whole = taken.length;
        let mut arrival = Arrival::Step;
        let said = |error: PathError| WalkFailure::Edges(error.to_string());
        if at != At::Limit && taken.to_limit().map_err(said)? {
            arrival = Arrival::Limit(None);
        }
        if let Some(crest) = taken.to_touch(true).map_err(said)? {
            arrival = Arrival::Touch(crest.radius);
        }
        if arrival == Arrival::Step && taken.side == SingularSide::Towards {
            let beyond = balance.beyond_corner(&taken.end);
            let turns = |end: &path::PathPoint| end.along_control() * taken.end.along_control() < 0.0;
            if beyond.is_some_and(|beyond| turns(&beyond.end)) {
                arrival = Arrival::Limit(None);
            }
        }
        let length = if taken.side == SingularSide::Smooth { Some(GROWTH * whole) } else { length };
        Ok(RingStep { point: edges::kept(&balance, scales, &taken.end).after(here), arrival, length })
    }

    /// Goes to the equilibrium with these contacts at this value of the control, where `at` waits, as at an event of a
    /// path.
    ///
    /// # Errors
    /// [`WalkFailure`] where there is none.
    pub fn move_to_contacts(&self, contacts: &Contacts, value: f64, at: At, emit: &mut Emit<'_>) -> Walked {
        let delta = if self.control == Control::Displacement { value } else { 0.0 };
        let ground = self.ground(contacts.outermost(), delta)?;
        let balance = self.balance(&ground, self.control);
        let held = balance.held(contacts, &points(&ground, contacts), value);
        let held = held.map_err(|error| WalkFailure::Edges(error.to_string()))?;
        let (arrival, end) = match at {
            At::Nothing => (Arrival::Moved, WalkEnd::Done),
            At::Limit => (Arrival::Limit(None), WalkEnd::AtLimit),
            At::Touch(radius) => (Arrival::Touch(radius), WalkEnd::AtTouch),
        };
        let mut reached = self.landed(&balance, arrival, held)?;
        if at == At::Limit {
            let ahead = self.standing(&reached.point, at).try_rings().ok().map(|jumped| jumped.ahead());
            reached.arrival = Arrival::Limit(ahead);
        }
        emit(reached);
        Ok(end)
    }

    /// Goes to the state at this value of the control with the same contacts, from the edges `from` of the problem before it changed.
    ///
    /// # Errors
    /// [`WalkFailure`] where there is none near.
    pub fn solve_rings(&self, value: f64, from: &Contacts, emit: &mut Emit<'_>) -> Walked {
        let delta = if self.control == Control::Displacement { value } else { 0.0 };
        let ground = self.ground(from.outermost(), delta)?;
        let balance = self.balance(&ground, self.control);
        let held = balance.solve(from, value).map_err(|error| match error {
            NotFound::State(error) => WalkFailure::Edges(error.to_string()),
            NotFound::Singular | NotFound::Unfinished { .. } => WalkFailure::NotSolved,
        })?;
        emit(self.landed(&balance, Arrival::Solved, held)?);
        Ok(WalkEnd::Done)
    }
}

/// The end of the branch, where a ring or a gap between contacts is narrower than `narrow`.
fn closing(contacts: &Contacts, narrow: f64) -> Option<WalkEnd> {
    let vanishing = contacts.rings.iter().find(|[a, b]| b - a < narrow);
    if let Some([a, b]) = vanishing {
        return Some(WalkEnd::Vanishes(0.5 * (a + b)));
    }
    let meets = contacts.gaps().into_iter().find(|[lo, hi]| hi - lo < narrow);
    if let Some([lo, hi]) = meets {
        return Some(WalkEnd::EdgesMeet(0.5 * (lo + hi)));
    }
    (contacts.has_disc() && contacts.disc < narrow).then_some(WalkEnd::Vanishes(0.0))
}
