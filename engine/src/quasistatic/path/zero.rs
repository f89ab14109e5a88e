//! The loop without adhesion: one solution for every approach, no jumps, no losses; unloading is loading reversed.
//!
//! κ = 0 at every edge, with J diagonal and positive. Events are continuous: a crest touches and its contact grows
//! from nothing; a gap narrows until two contacts become one. The second kind is found on the merged contact: it
//! happens where the pressure at the closing point is 0; before that, the merged contact pulls there. All controls
//! rise together, so steps are taken in the approach.

use super::balance::HeldEdges;
use super::course::Course;
use super::error::PathError;
use super::event::{Direction, Event, EventKind, PathState};
use super::follow::{FIRST, next_length};
use super::jump::with_seed;
use super::setting::{Path, PathStop, TurnReached};
use crate::annuli::{Around, Contacts, GapMinimum};
use crate::disc::chebyshev;
use crate::problem::{Control, Turn};
use crate::root::RootBracket;

/// A gap narrower than this many waves may be about to close.
const CLOSING: f64 = 0.02;

/// A new contact begins at an approach that is larger by this share of λ²/ρ.
const LIFT: f64 = 1e-3;

/// How often the way to the beginning of a new contact is halved.
const HALVINGS: usize = 20;

/// Points from which a least pressure is found.
const POINTS: usize = 15;

impl Course<'_, '_> {
    fn lift(&self) -> f64 {
        LIFT * self.balance.ground.wave.powi(2) / self.balance.ground.crest
    }

    /// The loop of bodies that do not adhere, from the first touch of `crest`; the balance is that of a held approach.
    pub(super) fn without_adhesion(mut self, crest: GapMinimum, turn: Turn) -> Result<Path, PathError> {
        let apart = PathState {
            contact_radius: crest.radius,
            zone: None,
            approach: crest.gap,
            force: 0.0,
            energy: 0.0,
            contacts: Vec::new(),
            contact_area: 0.0,
            held_stiffness: 0.0,
            stable: true,
            slopes: None,
            control_value: self.setting.control.value(crest.gap, 0.0),
            direction: Direction::Loading,
            piece: 0,
        };
        self.record.continuous(EventKind::FirstTouch, Some(crest.radius), [None, Some(apart)]);
        let mut held = self.begun(&Contacts::default(), crest.radius, crest.gap)?;
        while !self.has_turned(&held) {
            held = self.risen(&held)?;
        }
        let reached = self.measure(&held);
        let at_turn = self.state(&held);
        let work = match self.setting.control {
            Control::Force => at_turn.energy,
            control => at_turn.potential(control),
        };
        let up = self.record.events.clone();
        self.record.continuous(EventKind::Turn, None, [Some(at_turn.clone()), Some(at_turn)]);
        self.reversed(&up);
        let turn = TurnReached { asked: turn, reached };
        Ok(self.record.finished(None, Some(turn), Some(work), PathStop::Apart))
    }

    /// The way back: what happened on the way up, in reverse.
    fn reversed(&mut self, up: &[Event]) {
        let record = &mut self.record;
        let last_piece = record.piece;
        let turned = |state: &PathState| PathState {
            direction: Direction::Unloading,
            piece: 2 * last_piece + 1 - state.piece,
            ..state.clone()
        };
        let back: Vec<PathState> = record.states.iter().rev().map(turned).collect();
        record.states.extend(back);
        for event in up.iter().rev() {
            let kind = match event.kind {
                EventKind::FirstTouch => EventKind::LastContact,
                EventKind::Touch => EventKind::Vanish,
                EventKind::Merge => EventKind::Split,
                other => other,
            };
            let (before, after) = (event.after.as_ref().map(turned), event.before.as_ref().map(turned));
            record.events.push(Event {
                kind,
                direction: Direction::Unloading,
                before,
                after,
                ..event.clone()
            });
        }
        record.direction = Direction::Unloading;
    }

    /// The contacts with one more that has begun at a crest, a little beyond the approach `touch`.
    pub fn begun(&mut self, contacts: &Contacts, crest: f64, touch: f64) -> Result<HeldEdges, PathError> {
        let mut delta = touch + self.lift();
        let seeded = |delta: f64| {
            let beyond = |error| super::course::beyond(error, delta, 0.0);
            let start = self.balance.seeded(contacts, crest, delta).map_err(beyond)?;
            let held = self.balance.run(start, delta, 1.0, self.setting.mobility, &mut Vec::new());
            held.map_err(beyond)?.ok_or(PathError::Lost { control_value: delta })
        };
        let mut held = seeded(delta);
        // The turn may lie on the way, or at the touch itself, where the outermost edge leaps; and a contact that begins
        // beside another may be one with it before.
        let count = contacts.intervals().len() + 1;
        let is_apart = |held: &HeldEdges| held.state.contacts.intervals().len() >= count;
        for _ in 0..HALVINGS {
            if held.as_ref().is_ok_and(|held| is_apart(held) && !self.has_turned(held)) {
                break;
            }
            delta = 0.5 * (touch + delta);
            held = seeded(delta).or(held);
        }
        // The two may be one before edges can be told apart.
        if !held.as_ref().is_ok_and(is_apart) {
            let beside = with_seed(contacts, crest, 0.5 * self.balance.narrow());
            let closed = self.closing(&beside, touch, None, f64::INFINITY);
            if let Some(merged) = closed.and_then(|closed| self.merged(closed)) {
                return Ok(merged);
            }
        }
        let held = held?;
        self.record(&held);
        Ok(held)
    }

    /// Follows the contacts up to the next event and past it.
    fn risen(&mut self, from: &HeldEdges) -> Result<HeldEdges, PathError> {
        let mut point = self.balance.point(from.clone(), 1.0).ok_or_else(|| self.lost(from))?;
        let (mut length, mut past) = (FIRST, Vec::new());
        loop {
            self.counted(&point.held)?;
            let taken = self.balance.step(&point, length, &past, &|_| true);
            let mut taken = taken.ok_or_else(|| self.stopped(&point.held))?;
            let side = taken.side;
            length = taken.length;
            let crest = taken.to_touch(false).map_err(|error| match error {
                PathError::Lost { .. } => self.lost(&point.held),
                other => other,
            })?;
            let next = taken.end;
            // Where the edge of a contact passes a place at which the gap hardly opens, that place is no crest.
            let is_inside = |r: f64| next.contacts().intervals().iter().any(|[lo, hi]| *lo <= r && r <= *hi);
            let crest = crest.filter(|crest| !is_inside(crest.radius));
            // A gap that closes does so before that touch, or is examined again after it.
            let before = crest.as_ref().map(|_| next.held.approach);
            let narrow = CLOSING * self.balance.ground.wave;
            let closed = self.closing(&next.held.state.contacts, next.held.approach, before, narrow);
            if let Some(merged) = closed.and_then(|closed| self.merged(closed)) {
                return Ok(merged);
            }
            if let Some(turn) = self.turn.filter(|_| self.has_turned(&next.held)) {
                let mut left =
                    |point: &super::point::PathPoint| Some(self.measure(&point.held) - turn.value());
                let at_start = self.measure(&point.held) - turn.value();
                let (_, end) = (taken.step)
                    .located((taken.length, &next), at_start, &mut left)
                    .ok_or_else(|| self.lost(&point.held))?;
                self.record(&end.held);
                // The turn is reached to rounding, whatever its last digit.
                return Ok(end.held);
            }
            self.record(&next.held);
            if let Some(crest) = crest {
                let at = self.state(&next.held);
                self.record.continuous(EventKind::Touch, Some(crest.radius), [Some(at.clone()), Some(at)]);
                self.record.piece += 1;
                let (contacts, delta) = (next.contacts().clone(), next.held.approach);
                return self.begun(&contacts, crest.radius, delta);
            }
            let before = std::mem::replace(&mut point, next.rescaled(self.balance));
            length = next_length(&mut past, before, length, side);
        }
    }

    /// Records the merged contact of [`Self::closing`], if it comes before the turn.
    fn merged(&mut self, (gap, merged): (f64, HeldEdges)) -> Option<HeldEdges> {
        if self.has_turned(&merged) {
            return None;
        }
        let after = self.state(&merged);
        let mut before = after.clone();
        split_at(&mut before.contacts, gap);
        self.record.piece += 1;
        self.record.continuous(EventKind::Merge, Some(gap), [Some(before), Some(after)]);
        self.record(&merged);
        Some(merged)
    }

    /// Where the narrowest gap between these contacts closes, from the approach `at` upward, and the merged contact then, if
    /// nothing touches before; up to the approach `before`. A gap wider than `narrow` does not close yet.
    fn closing(
        &self,
        contacts: &Contacts,
        at: f64,
        before: Option<f64>,
        narrow: f64,
    ) -> Option<(f64, HeldEdges)> {
        // A dimple with a corner at the axis never closes: its pressure there would have no bound.
        let never = self.balance.ground.is_dimpled();
        let gaps = contacts.gaps().into_iter().enumerate().filter(|(_, [lo, _])| !(never && *lo <= 0.0));
        let (k, [lo, hi]) = gaps.min_by(|a, b| (a.1[1] - a.1[0]).total_cmp(&(b.1[1] - b.1[0])))?;
        let wave = self.balance.ground.wave;
        if hi - lo > narrow {
            return None;
        }
        let mut merged = contacts.clone();
        let [_, outer] = merged.rings.remove(k);
        match k.checked_sub(1) {
            Some(before) => merged.rings[before][1] = outer,
            None => merged.disc = outer,
        }
        let width = hi - lo;
        let range = [(lo - width).max(0.0), hi + width];
        let least = |delta: f64, from: &Contacts| -> Option<(HeldEdges, [f64; 2])> {
            let held = self.balance.solve(from, delta).ok()?;
            let around = Around::new(self.balance.ground, &held.state, delta);
            let least = chebyshev::least(POINTS, range, |r| around.pressure(r));
            Some((held, least))
        };
        let (start, [radius, first]) = least(at, &merged)?;
        if first >= 0.0 {
            return Some((radius, start));
        }
        // Go up until it presses there.
        let (mut lo, mut f_lo) = (at, first);
        let mut step = 1e-4 * wave;
        let mut high = None;
        for _ in 0..40 {
            let (next, [radius, p]) = least(lo + step, &merged)?;
            if p >= 0.0 {
                high = Some((lo + step, p, next, radius));
                break;
            }
            (lo, f_lo) = (lo + step, p);
            merged = next.state.contacts;
            step *= 1.5;
            if step > wave || before.is_some_and(|before| lo > before) {
                return None;
            }
        }
        let (hi, f_hi, mut best, mut radius) = high?;
        // If the pressure there vanishes to the last digit, this is the place.
        if let Some(mut bracket) = RootBracket::new([lo, f_lo], [hi, f_hi]) {
            bracket.find(1e-15 * hi.abs().max(wave), |delta| {
                let (next, [at, pressure]) = least(delta, &best.state.contacts)?;
                (best, radius) = (next, at);
                Some(pressure)
            })?;
        }
        let touches = self.balance.least_gap(&best).ok()?.is_some_and(|crest| crest.gap < 0.0);
        (!touches && before.is_none_or(|before| best.approach <= before)).then_some((radius, best))
    }
}

/// Divides the contact that holds a radius at that radius.
fn split_at(contacts: &mut Vec<[f64; 2]>, radius: f64) {
    if let Some(at) = contacts.iter().position(|[lo, hi]| *lo <= radius && radius < *hi) {
        let [lo, hi] = contacts[at];
        // A hole that closes on the axis leaves a ring, however thin the hole.
        contacts[at] = [radius.max(1e-9 * hi), hi];
        if radius > lo {
            contacts.insert(at, [lo, radius]);
        }
    }
}
