//! A walk along a known path, for bodies whose states do not lie on a single curve.
//!
//! With two works of adhesion an edge grows on one curve, recedes on another and rests in between; adhesion with a range has states without
//! contact. A walker then goes from state to state of the path of the device, through its events.

use super::arrival::{Ahead, Arrival, Emit, Reached, WalkEnd, WalkFailure, Walked};
use crate::continuation::Columns;
use crate::quasistatic::path::{Direction, EventKind};
use crate::quasistatic::{Admissibility, Event, Path, PathState, Scales, Stability, StatePoint, Stiffness};
use std::f64::consts::TAU;

/// Control values closer than this share of their range count as equal.
const SAME: f64 = 1e-9;

/// Where a walker on a path stands, and how it goes.
#[derive(Debug, Clone, Copy)]
pub struct Along<'a> {
    /// The path.
    pub path: &'a Path,
    /// The units of the unknowns.
    pub scales: &'a Scales,
    /// Decimal digits of its states.
    pub digits: f64,
    /// The number of the state on which the walker stands, from 0; only moves need none.
    pub from: Option<usize>,
    /// The length of a step, in the scaled unknowns.
    pub length: f64,
}

/// An event of a path with the numbers of the states before and after it. The two numbers are the same where nothing
/// runs, and where one side has no state because the bodies are apart there.
#[derive(Debug, Clone, Copy)]
pub struct Passing<'a> {
    /// The event.
    pub event: &'a Event,
    /// The number of the state before it, from 0.
    pub before: usize,
    /// The number of the state after it.
    pub after: usize,
}

impl<'a> Passing<'a> {
    /// The events of a path, in order.
    pub fn all(path: &'a Path) -> Vec<Self> {
        let states = &path.states;
        let mut from = 0;
        let mut passing = |event: &'a Event| {
            let Some(before) = &event.before else { return Self { event, before: from, after: from } };
            let is_before = |state: &PathState| {
                let [a, b] = [state, before].map(|state| (state.approach, state.force));
                state.piece == before.piece && a == b
            };
            let last = || states.iter().rposition(|state| state.piece == before.piece);
            let at = (from..states.len()).find(|at| is_before(&states[*at])).or_else(last).unwrap_or(from);
            // The path may hold the same state twice: it goes on from the last of them.
            let same = (at..states.len()).take_while(|at| is_before(&states[*at])).last();
            let before = same.unwrap_or(at);
            let next = states.get(before + 1).filter(|next| next.piece != states[before].piece);
            let after = before + usize::from(event.after.is_some() && next.is_some());
            from = after;
            Self { event, before, after }
        };
        path.events.iter().map(&mut passing).collect()
    }

    /// Whether edges run in it, so that a walker waits before it.
    pub fn is_jump(&self) -> bool {
        let runs = self.after != self.before && self.event.kind != EventKind::Turn;
        runs || self.event.after.is_none()
    }

    /// How a walker comes to the state before the event, where edges run.
    fn arrival(&self) -> Arrival {
        match (self.event.kind, self.event.radius) {
            (EventKind::Touch, Some(radius)) => Arrival::Touch(radius),
            _ => Arrival::Limit(Some(Ahead {
                after: self.event.after.as_ref().map(PathState::state),
                dissipated: self.event.dissipated,
            })),
        }
    }
}

impl<'a> Along<'a> {
    /// The jump that waits in a state.
    fn waiting(&self, at: usize) -> Option<Passing<'a>> {
        Passing::all(self.path).into_iter().find(|passing| passing.is_jump() && passing.before == at)
    }

    /// Where the walker stands; `None` where the path has no such state.
    fn here(&self) -> Option<usize> {
        self.from.filter(|at| *at < self.path.states.len())
    }

    /// Takes `count` steps, single or of a run; stops where edges run, where the path turns, and where a held edge
    /// begins to move.
    ///
    /// # Errors
    /// [`WalkFailure::NoState`] where the walker stands on no state of the path.
    pub fn steps(&self, count: usize, emit: &mut Emit<'_>) -> Walked {
        let states = &self.path.states;
        let mut at = self.here().ok_or(WalkFailure::NoState("walk"))?;
        if let Some(passing) = self.waiting(at) {
            // Edges may run at once where a held one is let go. The path goes on only after the jump.
            emit(self.reached(at, passing.arrival()));
            return Ok(WalkEnd::AtLimit);
        }
        let is_ahead =
            |passing: &Passing<'_>| passing.before > at || passing.before == at && passing.after > at;
        let ahead = Passing::all(self.path).into_iter().find(is_ahead);
        let last = ahead.as_ref().map_or(states.len().saturating_sub(1), |passing| passing.before);
        for _ in 0..count {
            let mut gone = 0.0;
            while at < last && gone < self.length {
                gone += self.distance([at, at + 1]);
                at += 1;
            }
            match &ahead {
                Some(passing) if at == last && passing.is_jump() => {
                    emit(self.reached(at, passing.arrival()));
                    return Ok(WalkEnd::AtLimit);
                }
                Some(passing) if at == last => {
                    emit(self.reached(passing.after, Arrival::Jump(Box::new(passing.event.clone()))));
                    return Ok(WalkEnd::AtLimit);
                }
                None if at == last => {
                    if gone > 0.0 {
                        emit(self.reached(at, Arrival::Step));
                    }
                    return Ok(WalkEnd::PathEnds);
                }
                _ => {}
            }
            if !emit(self.reached(at, Arrival::Step)) {
                return Ok(WalkEnd::Paused);
            }
        }
        Ok(WalkEnd::Done)
    }

    /// Lets the waiting edges run.
    ///
    /// # Errors
    /// [`WalkFailure::Stable`] where none wait.
    pub fn jump(&self, emit: &mut Emit<'_>) -> Walked {
        let passing = self.here().and_then(|at| self.waiting(at)).ok_or(WalkFailure::Stable)?;
        emit(self.reached(passing.after, Arrival::Jump(Box::new(passing.event.clone()))));
        Ok(WalkEnd::Done)
    }

    /// Goes to the state of this number, from 0.
    ///
    /// # Errors
    /// [`WalkFailure::NoEquilibrium`] where the path has fewer states.
    pub fn move_to(&self, at: usize, emit: &mut Emit<'_>) -> Walked {
        if at >= self.path.states.len() {
            return Err(WalkFailure::NoEquilibrium("on the path"));
        }
        emit(self.reached(at, self.waiting(at).map_or(Arrival::Moved, |passing| passing.arrival())));
        Ok(WalkEnd::Done)
    }

    /// Goes to the state whose contact radius is nearest to `s`, on the way in `direction`.
    ///
    /// # Errors
    /// [`WalkFailure::NoEquilibrium`] where the path has no state.
    pub fn move_near(&self, s: f64, direction: Direction, emit: &mut Emit<'_>) -> Walked {
        let found = self.nearest(direction, &|state| [(state.contact_radius - s).abs(), 0.0]);
        self.move_to(found.unwrap_or(usize::MAX), emit)
    }

    /// Goes to the state at this value of the control on the way in `direction`; of several, as around a jump, to the
    /// one whose contact radius is nearest to `s`.
    ///
    /// # Errors
    /// [`WalkFailure::NotSolved`] where the path has no state.
    pub fn solve(&self, value: f64, s: f64, direction: Direction, emit: &mut Emit<'_>) -> Walked {
        let values = self.path.states.iter().map(|state| state.control_value);
        let range = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], c| [lo.min(c), hi.max(c)]);
        let apart = |state: &PathState| {
            let off = (state.control_value - value).abs();
            [if off <= SAME * (range[1] - range[0]) { 0.0 } else { off }, (state.contact_radius - s).abs()]
        };
        let at = self.nearest(direction, &apart).ok_or(WalkFailure::NotSolved)?;
        emit(self.reached(at, Arrival::Solved));
        Ok(WalkEnd::Done)
    }

    /// The state with the least `measure` on the way in `direction`, or on the whole path where there is none on that
    /// way.
    fn nearest(&self, direction: Direction, measure: &dyn Fn(&PathState) -> [f64; 2]) -> Option<usize> {
        let states = || self.path.states.iter().enumerate();
        let least = |a: &(usize, &PathState), b: &(usize, &PathState)| {
            let [[a, beside_a], [b, beside_b]] = [a.1, b.1].map(measure);
            a.total_cmp(&b).then(beside_a.total_cmp(&beside_b))
        };
        let there = states().filter(|(_, state)| state.direction == direction).min_by(least);
        there.or_else(|| states().min_by(least)).map(|(at, _)| at)
    }

    /// The distance from one state to another in the scaled unknowns.
    fn distance(&self, ends: [usize; 2]) -> f64 {
        let Scales { approach, force, contact_radius } = *self.scales;
        let [a, b] = ends.map(|at| &self.path.states[at]);
        let ways = [
            (a.approach - b.approach) / approach,
            (a.force - b.force) / force,
            (a.contact_radius - b.contact_radius) / contact_radius,
        ];
        ways.iter().map(|way| way * way).sum::<f64>().sqrt()
    }

    /// Whether the edge rests between a state and the next.
    fn rests(&self, at: usize) -> bool {
        let states = &self.path.states;
        states.get(at + 1).is_some_and(|next| {
            let here = &states[at];
            next.piece == here.piece
                && next.contacts == here.contacts
                && next.approach.total_cmp(&here.approach).is_ne()
                && next.zone.is_none()
        })
    }

    /// A state with what is known about it.
    fn reached(&self, at: usize, arrival: Arrival) -> Reached {
        let state = &self.path.states[at];
        let Scales { approach, force, contact_radius } = *self.scales;
        let (s, held) = (state.contact_radius, state.held_stiffness);
        // With a held edge, the response is that of the contact itself.
        let rests = self.rests(at).then_some(Stability { approach: 1.0, force: held });
        let slopes = rests.or(state.slopes);
        // A state on a path is stable under its device; for other devices its neighbours tell where the state itself
        // does not.
        let stability = slopes.unwrap_or(Stability { approach: 1.0, force: self.slope(at) });
        let tangent = slopes.map_or(f64::NAN, |slopes| slopes.force / slopes.approach);
        let area_slope = match (rests, slopes, state.zone) {
            (Some(_), ..) => 0.0,
            (None, Some(slopes), None) => TAU * s / slopes.approach,
            _ => f64::NAN,
        };
        let stiffness = Stiffness { contact: held, tangent, area_slope };
        let edges = state.contacts.concat();
        // The axis is not an edge.
        let mut radii: Vec<f64> = edges.into_iter().filter(|r| *r > 0.0).collect();
        if radii.is_empty() {
            radii.push(0.0);
        }
        let y = [state.approach / approach, state.force / force].into_iter();
        let y: Vec<f64> = y.chain(radii.iter().map(|r| r / contact_radius)).collect();
        let along = [stability.approach / approach, stability.force / force, 1.0 / contact_radius];
        let size = along.iter().map(|x| x * x).sum::<f64>().sqrt();
        let mut tangent = vec![0.0; y.len()];
        if y.len() == along.len() && size.is_finite() {
            tangent = along.iter().map(|x| -x / size).collect();
        }
        let bend = vec![0.0; y.len()];
        Reached {
            arrival,
            point: StatePoint::of(Columns::from_vec([y, tangent, bend].concat()), true),
            state: state.state(),
            stability,
            stiffness,
            // The states of a path have already been checked.
            admissibility: Admissibility { nearest: None, least_pressure: None, holds: true, known_to: None },
            digits: self.digits,
            on_path: Some(at),
        }
    }

    /// dP/dδ between neighbours on the path: only its sign is used.
    fn slope(&self, at: usize) -> f64 {
        let states = &self.path.states;
        let here = &states[at];
        let beside = [at + 1, at.wrapping_sub(1)].into_iter().filter_map(|at| states.get(at));
        let mut near = beside.filter(|other| other.piece == here.piece).map(|other| {
            let [approach, force] = [other.approach - here.approach, other.force - here.force];
            force / approach
        });
        near.find(|slope| slope.is_finite()).unwrap_or(f64::NAN)
    }
}
