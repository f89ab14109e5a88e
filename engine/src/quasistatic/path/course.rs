//! The loop itself.

use super::balance::{Balance, Held};
use super::error::{PathError, Warning};
use super::event::{Direction, Event, EventKind, Passed, PassedKind, PathState};
use super::lane::Lane;
use super::setting::{Areas, Path, Setting, Totals, TurnReached, measure};
use crate::annuli::{AnnuliError, Contacts, ContactsError, Crest, Ground};
use crate::disc::Table;
use crate::gap::Form;
use crate::problem::Control;
use crate::problem::Turn;
use crate::progress::Progress;
use nalgebra::DVector;
use std::sync::Arc;

/// What the balance of a loop may leave of its losses.
const BALANCED: f64 = 1e-6;

/// The share of a loss by which energy and area may differ.
const AGREE: f64 = 1e-6;

/// Digits below which a loop warns.
const DIGITS: f64 = 9.0;

/// What ends a stretch of stable states.
#[derive(Debug)]
pub(super) enum End {
    Limit(DVector<f64>),
    /// The outer end of this stretch of one disc.
    Fold(usize),
    Touch(Crest),
    Turn,
}

/// A loop while it runs.
pub(super) struct Course<'a, 'b> {
    pub balance: &'a Balance<'b>,
    pub setting: &'a Setting<'a>,
    pub progress: &'a dyn Progress,
    pub events: Vec<Event>,
    pub states: Vec<PathState>,
    pub piece: usize,
    pub direction: Direction,
    pub steps: usize,
    /// Σ ∫ (dΠ/dc) dc.
    pub area: f64,
    /// The fewest digits, and where.
    pub digits: (f64, f64),
}

/// How far beyond what may touch a table goes.
const BEYOND: f64 = 1.3;

/// A formula is looked at up to so many of its lengths.
const LENGTHS: f64 = 10.0;

/// The loop of the gap of `table` with the work of adhesion `gamma` (E* = 1): as [`cycle_on`], as far out as the loop goes.
///
/// # Errors
/// [`PathError`].
pub fn cycle(
    table: &Arc<Table>,
    gamma: f64,
    setting: &Setting<'_>,
    progress: &dyn Progress,
) -> Result<Path, PathError> {
    let mut reach = match setting.turn {
        Turn::Radius(radius) => BEYOND * radius,
        Turn::Approach(approach) => 2.0 * approach.abs().sqrt(),
        Turn::Force(_) | Turn::Control(_) => 0.5,
    };
    reach = reach.max(2.0 * table.gap().feature_length().unwrap_or(0.0)).max(0.05);
    if matches!(table.gap().form(), Form::Any) {
        reach = reach.max(LENGTHS);
    }
    for _ in 0..40 {
        if !reach.is_finite() {
            return Err(PathError::BadTurn(setting.turn.value()));
        }
        let ground = Ground::new(Arc::clone(table), reach, progress)?;
        let whole = ground.reach() >= table.end() * (1.0 - 1e-9);
        let far_enough = match setting.turn {
            Turn::Approach(approach) => BEYOND * ground.can_touch_up_to(approach) <= ground.reach(),
            _ => true,
        };
        if !far_enough && !whole {
            reach = 1.5 * ground.reach();
            continue;
        }
        match cycle_on(&ground, gamma, setting, progress) {
            Err(
                PathError::BeyondGap { .. }
                | PathError::RadiusBeyondGap { .. }
                | PathError::State(AnnuliError::BeyondGap { .. }),
            ) if !whole => {
                reach = 2.0 * ground.reach();
            }
            // A crest further out would have touched unseen.
            Ok(cycle) if !whole && BEYOND * ground.can_touch_up_to(highest(&cycle)) > ground.reach() => {
                reach = 1.5 * ground.reach();
            }
            other => return other,
        }
    }
    Err(PathError::NeverTouches { searched: reach })
}

/// The largest approach of a loop.
fn highest(cycle: &Path) -> f64 {
    cycle.states.iter().map(|state| state.approach).fold(f64::NEG_INFINITY, f64::max)
}

/// The loop of a gap with the work of adhesion `gamma` (E* = 1), as far out as `ground` goes: a loop that comes to its end is an error.
///
/// `progress` is asked before each step with the share of the way that is done, 0 to 1, roughly.
///
/// # Errors
/// [`PathError`].
pub fn cycle_on(
    ground: &Ground,
    gamma: f64,
    setting: &Setting<'_>,
    progress: &dyn Progress,
) -> Result<Path, PathError> {
    // Without adhesion all controls rise together, and the approach is the one that is stepped.
    let stepped = if gamma > 0.0 { setting.control } else { Control::Displacement };
    let lane = (gamma > 0.0).then(|| Lane::new(ground, gamma, stepped));
    let balance =
        Balance { ground, work_of_adhesion: gamma, control: stepped, progress, lane: lane.as_ref() };
    let path = Course {
        balance: &balance,
        setting,
        progress,
        events: Vec::new(),
        states: Vec::new(),
        piece: 0,
        direction: Direction::Loading,
        steps: 0,
        area: 0.0,
        digits: (f64::INFINITY, f64::NAN),
    };
    path.whole()
}

/// The place of the least gap; the axis where it is one of several. `None` where there is none, or `progress` said stop.
pub fn first_crest(ground: &Ground, progress: &dyn Progress) -> Option<Crest> {
    /// Radii at which the gap is looked at between two questions.
    const TOGETHER: usize = 64;
    let reach = ground.reach();
    let value = |r: f64| ground.gap.jet(r).value;
    let mut radii: Vec<f64> = ground.samples();
    radii.extend(ground.breaks.iter().copied().chain([0.0, reach]));
    radii.sort_by(f64::total_cmp);
    let mut least: Option<(f64, f64)> = None;
    for some in radii.chunks(TOGETHER) {
        if progress.stop() {
            return None;
        }
        let found = some.iter().map(|r| (*r, value(*r))).filter(|(_, h)| h.is_finite());
        least = least.into_iter().chain(found).min_by(|a, b| a.1.total_cmp(&b.1));
    }
    let (best, _) = least?;
    if best <= 0.0 && !ground.is_dimpled() {
        return Some(Crest { radius: 0.0, gap: value(0.0) });
    }
    // h' changes its sign at a smooth minimum; at a corner the bisection ends on it.
    let at = radii.partition_point(|r| *r < best);
    let (mut lo, mut hi) = (radii[at.saturating_sub(1)], *radii.get(at + 1)?);
    for _ in 0..100 {
        let middle = 0.5 * (lo + hi);
        if ground.gap.jet(middle).first > 0.0 { hi = middle } else { lo = middle }
    }
    let radius = if value(best) < value(hi) { best } else { hi };
    Some(Crest { radius, gap: value(radius) })
}

/// The error with what was reached, where an edge ran beyond what is known of the gap, or a state has too many contacts.
pub(super) fn beyond(error: PathError, approach: f64, force: f64) -> PathError {
    match error {
        PathError::State(AnnuliError::BeyondGap { known, .. }) => {
            PathError::BeyondGap { radius: known, approach, force }
        }
        PathError::State(
            error
            @ (AnnuliError::Contacts(ContactsError::TooMany { .. }) | AnnuliError::TooManyPoints { .. }),
        ) => PathError::TooMany { error, approach },
        other => other,
    }
}

impl Course<'_, '_> {
    pub(super) fn state(&self, held: &Held) -> PathState {
        let state = PathState::new(held, self.balance.work_of_adhesion, self.direction, self.piece);
        if self.balance.control == self.setting.control {
            return state;
        }
        PathState { control_value: self.setting.control.value(held.approach, held.force), ..state }
    }

    /// What the turn is measured by.
    pub(super) fn measure(&self, held: &Held) -> f64 {
        if self.balance.control == self.setting.control && matches!(self.setting.turn, Turn::Control(_)) {
            return held.control_value;
        }
        measure(self.setting.turn, held, self.setting.control)
    }

    pub(super) fn record(&mut self, held: &Held) {
        if held.state.digits < self.digits.0 {
            self.digits = (held.state.digits, held.control_value);
        }
        let state = self.state(held);
        self.states.push(state);
    }

    fn whole(mut self) -> Result<Path, PathError> {
        let (balance, setting) = (self.balance, self.setting);
        let ground = balance.ground;
        let turn = setting.turn;
        if !turn.value().is_finite() {
            return Err(PathError::BadTurn(turn.value()));
        }
        if let Turn::Radius(radius) = turn
            && radius > ground.reach()
        {
            return Err(PathError::RadiusBeyondGap { radius, known: ground.reach() });
        }
        let Some(crest) = first_crest(ground, self.progress) else {
            let searched = ground.reach();
            let stopped = self.progress.stop();
            return Err(if stopped { PathError::Cancelled } else { PathError::NeverTouches { searched } });
        };
        let first = match setting.control {
            Control::Force => 0.0,
            Control::Displacement | Control::Stiffness(_) => crest.gap,
        };
        let least = match turn {
            Turn::Control(_) => first,
            Turn::Approach(_) if setting.control == Control::Displacement => first,
            Turn::Force(_) if setting.control == Control::Force => first,
            _ => f64::NEG_INFINITY,
        };
        if turn.value() < least {
            return Err(if setting.control == Control::Force && balance.work_of_adhesion == 0.0 {
                PathError::NoTension { load: turn.value() }
            } else {
                PathError::TurnBeforeTouch { turn: turn.value(), touch: least }
            });
        }
        if balance.work_of_adhesion == 0.0 {
            return self.without_adhesion(crest);
        }
        let held = self.loaded(crest, first)?;
        let reached = self.measure(&held);
        let losses_up: f64 = self.events.iter().filter_map(|event| event.dissipated).sum();
        let at_turn = self.state(&held);
        let potential = match setting.control {
            Control::Force => at_turn.energy,
            _ => at_turn.potential(setting.control),
        };
        let work_of_loading = potential + losses_up;
        self.events.push(Event {
            kind: EventKind::Turn,
            direction: Direction::Loading,
            control_value: held.control_value,
            radius: None,
            before: Some(at_turn.clone()),
            after: Some(at_turn),
            dissipated: Some(0.0),
            dissipated_by_area: (setting.areas == Areas::Yes).then_some(0.0),
            passed: Vec::new(),
        });
        self.direction = Direction::Unloading;
        self.piece += 1;
        self.record(&held);
        self.unloaded(held)?;
        Ok(self.finished(TurnReached { asked: turn, reached }, work_of_loading))
    }

    /// From the first touch at a crest to the turn.
    fn loaded(&mut self, crest: Crest, value: f64) -> Result<Held, PathError> {
        let mut held = self.first_touch(crest, value)?;
        self.record(&held);
        while self.measure(&held) < self.setting.turn.value() {
            let (end, next) = self.way_up(&held)?;
            held = match end {
                End::Turn => {
                    held = next;
                    break;
                }
                End::Limit(null) => {
                    let start = self.balance.kicked(&next.state.contacts, &null, 1.0);
                    self.jump(EventKind::Advance, &next, start, None)?
                }
                End::Fold(stretch) => {
                    self.balance.lane.map(|lane| self.advance(lane, &next, stretch)).transpose()?
                }
                End::Touch(crest) => {
                    let start = self
                        .balance
                        .seeded(&next.state.contacts, crest.radius, next.control_value)
                        .map_err(|error| beyond(error, next.approach, next.force))?;
                    self.jump(EventKind::Touch, &next, start, Some(crest.radius))?
                }
            }
            .ok_or(PathError::Lost { control_value: next.control_value })?;
        }
        Ok(held)
    }

    /// From the turn until the bodies are apart.
    fn unloaded(&mut self, mut held: Held) -> Result<(), PathError> {
        let balance = self.balance;
        loop {
            if let Some(lane) = balance.lane_of(&held.state.contacts)
                && self.descend(lane, &held)?
            {
                return Ok(());
            }
            let (end, next) = self.stretch(&held)?;
            let End::Limit(null) = end else {
                return Err(PathError::Lost { control_value: next.control_value });
            };
            let start = balance.kicked(&next.state.contacts, &null, -1.0);
            match self.jump(EventKind::Recede, &next, start, None)? {
                Some(landed) => held = landed,
                None => return Ok(()),
            }
        }
    }

    /// The sums of what has happened.
    fn finished(self, turn: TurnReached, work_of_loading: f64) -> Path {
        let control = self.setting.control;
        let losses =
            |events: &[Event]| events.iter().try_fold(0.0, |sum, event| Some(sum + event.dissipated?));
        let areas = |events: &[Event]| {
            events.iter().try_fold(0.0, |sum, event| Some(sum + event.dissipated_by_area?))
        };
        let (before, all) = (&self.events[..self.events.len() - 1], &self.events[..]);
        let before_pull_off: f64 = losses(before).unwrap_or(f64::NAN);
        let last = self.events.last().and_then(|event| event.before.as_ref());
        let balance = last.filter(|_| self.setting.areas == Areas::Yes).map(|last| {
            let total = losses(all).unwrap_or(before_pull_off);
            let error = last.potential(control) - self.area + before_pull_off;
            error.abs() / f64::max(total.abs(), work_of_loading.abs())
        });
        let warnings = self.warnings(balance);
        let total = losses(all);
        let totals = Totals {
            dissipated: total,
            dissipated_by_area: areas(all),
            dissipated_before_pull_off: before_pull_off,
            work_of_loading,
            work_of_unloading: total.map(|total| total - work_of_loading),
            balance,
        };
        Path { control, turn, events: self.events, states: self.states, totals, warnings }
    }

    /// What is to be known about it.
    pub(super) fn warnings(&self, balance: Option<f64>) -> Vec<Warning> {
        let mut warnings = Vec::new();
        // Written so that what is no number warns.
        if let Some(share) =
            balance.filter(|share| !matches!(share.total_cmp(&BALANCED), std::cmp::Ordering::Less))
        {
            warnings.push(Warning::Balance { share });
        }
        if self.digits.0 < DIGITS {
            warnings.push(Warning::Digits { digits: self.digits.0, control_value: self.digits.1 });
        }
        for (event, of) in self.events.iter().enumerate() {
            if let (Some(energy), Some(area)) = (of.dissipated, of.dissipated_by_area) {
                let share = (energy - area).abs() / energy.abs().max(f64::MIN_POSITIVE.sqrt());
                if share > AGREE {
                    warnings.push(Warning::Area { event: event + 1, share });
                }
            }
        }
        warnings
    }

    /// The loss of a jump by area, where it is asked for.
    fn by_area(
        &self,
        before: Option<&PathState>,
        after: Option<&PathState>,
        value: f64,
        passed: &[Passed],
    ) -> Option<f64> {
        if self.setting.areas == Areas::No {
            return None;
        }
        // Bodies apart hold nothing; a dead load has no bound.
        if after.is_none() && self.setting.control == Control::Force {
            return None;
        }
        if let Some(area) =
            self.balance.lane.zip(before).and_then(|(lane, before)| {
                lane.area(&before.contacts, after.map(|after| &after.contacts[..]))
            })
        {
            return Some(area);
        }
        let touches = passed.iter().filter(|passed| passed.kind == PassedKind::Touch);
        let crests: Vec<f64> = touches.map(|passed| passed.radius).collect();
        self.balance.area_between(before, after, value, &crests)
    }

    /// The loss of a first touch by area, where it is asked for.
    fn by_area_of_touch(&self, after: &PathState, value: f64, passed: &[Passed]) -> Option<f64> {
        if self.setting.areas == Areas::No {
            return None;
        }
        // What it took to come from apart to there is what it takes to come back, with another sign.
        let on_lane = self.balance.lane.and_then(|lane| lane.area(&after.contacts, None));
        on_lane.map(|area| -area).or_else(|| self.by_area(None, Some(after), value, passed))
    }

    /// Follows stable states while the control goes up, to what ends them.
    fn way_up(&mut self, held: &Held) -> Result<(End, Held), PathError> {
        let lane = self.balance.lane_of(&held.state.contacts);
        match lane.map(|lane| self.rise(lane, held)).transpose()?.flatten() {
            Some(found) => Ok(found),
            None => self.stretch(held),
        }
    }

    /// The first touch and what it jumps to.
    fn first_touch(&mut self, crest: Crest, value: f64) -> Result<Held, PathError> {
        let start = self.balance.seeded(&Contacts::default(), crest.radius, value)?;
        let mut passed = vec![Passed { kind: PassedKind::Touch, radius: crest.radius }];
        let held = self
            .balance
            .run(start, value, 1.0, self.setting.mobility, &mut passed)
            .map_err(|error| beyond(error, crest.gap, 0.0))?
            .ok_or(PathError::Lost { control_value: value })?;
        let after = self.state(&held);
        let loss = match self.setting.control {
            // The bodies apart hold nothing at P = 0.
            Control::Force => -after.energy,
            control => -after.potential(control),
        };
        self.events.push(Event {
            kind: EventKind::FirstTouch,
            direction: Direction::Loading,
            control_value: value,
            radius: Some(crest.radius),
            before: None,
            dissipated: Some(loss),
            dissipated_by_area: self.by_area_of_touch(&after, value, &passed),
            after: Some(after),
            passed,
        });
        Ok(held)
    }

    /// A jump and its event; `None` where the bodies came apart.
    fn jump(
        &mut self,
        kind: EventKind,
        before: &Held,
        start: Contacts,
        radius: Option<f64>,
    ) -> Result<Option<Held>, PathError> {
        let mut passed: Vec<Passed> =
            radius.iter().map(|radius| Passed { kind: PassedKind::Touch, radius: *radius }).collect();
        let value = before.control_value;
        let sense = self.direction.sense();
        let landed = self.balance.run(start, value, sense, self.setting.mobility, &mut passed);
        let landed = landed.map_err(|error| beyond(error, before.approach, before.force))?;
        self.jumped(kind, before, landed.as_ref(), radius, passed);
        Ok(landed)
    }

    /// The event of a jump that has landed, or of the bodies come apart, with the state after it.
    pub(super) fn jumped(
        &mut self,
        kind: EventKind,
        before: &Held,
        landed: Option<&Held>,
        radius: Option<f64>,
        passed: Vec<Passed>,
    ) {
        let old = self.state(before);
        self.piece += 1;
        let after = landed.map(|held| self.state(held));
        self.events.push(Event {
            kind: if after.is_some() { kind } else { EventKind::PullOff },
            direction: self.direction,
            control_value: before.control_value,
            radius,
            dissipated: old.loss(self.setting.control, after.as_ref()),
            dissipated_by_area: self.by_area(Some(&old), after.as_ref(), before.control_value, &passed),
            before: Some(old),
            after,
            passed,
        });
        if let Some(held) = landed {
            self.record(held);
        }
    }
}
