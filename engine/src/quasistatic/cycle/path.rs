//! The loop itself.

use super::balance::{Balance, Held};
use super::error::{CycleError, Warning};
use super::event::{CycleState, Direction, Event, EventKind, Passed, PassedKind};
use super::jump::Mobility;
use super::point::{Point, Step};
use crate::annuli::ground::gauss;
use crate::annuli::{AnnuliError, Around, Contacts, Crest, Ground};
use crate::disc::Table;
use crate::gap::Form;
use crate::problem::Control;
use nalgebra::DVector;
use std::sync::Arc;

/// Steps of a loop at most.
const STEPS: usize = 200_000;

/// The first step of a stretch, the longest and the shortest, in the units of the arc length.
const FIRST: f64 = 0.02;
const LONGEST: f64 = 0.15;
const SHORTEST: f64 = 1e-9;

/// Nodes of an area on a step.
const NODES: usize = 9;

/// A gap that is nothing, in waves.
const ROUNDING: f64 = 1e-11;

/// What the balance of a loop may leave of its losses.
const BALANCED: f64 = 1e-6;

/// The share of a loss by which energy and area may differ.
const AGREE: f64 = 1e-6;

/// Digits below which a loop warns.
const DIGITS: f64 = 9.0;

/// Where the control turns round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Turn {
    /// At the first stable state with at least this approach, a length.
    Approach(f64),
    /// With at least this force.
    Force(f64),
    /// With an outermost edge of at least this radius, a length.
    Radius(f64),
    /// At this control value: an approach, a force, or the way of the device.
    Control(f64),
}

impl Turn {
    /// Its number.
    pub fn value(self) -> f64 {
        match self {
            Self::Approach(x) | Self::Force(x) | Self::Radius(x) | Self::Control(x) => x,
        }
    }

    fn measure(self, held: &Held, control: Control) -> f64 {
        match self {
            Self::Approach(_) => held.approach,
            Self::Force(_) => held.force,
            Self::Radius(_) => held.state.contacts.outermost(),
            Self::Control(_) => control.value(held.approach, held.force),
        }
    }
}

/// Whether losses are computed by area as well.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Areas {
    /// By energy alone.
    No,
    /// Twice; the balance is checked.
    Yes,
}

/// What a loop is asked for.
#[derive(Clone, Copy)]
pub struct Setting<'a> {
    /// The device.
    pub control: Control,
    /// Where it turns round.
    pub turn: Turn,
    /// Whether losses are computed twice.
    pub areas: Areas,
    /// How fast edges move at a radius: nothing that lasts depends on it.
    pub mobility: Mobility<'a>,
}

/// Where the control turned round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurnReached {
    /// What was asked for.
    pub asked: Turn,
    /// What the state there has of it: more than asked for where loading jumped over it.
    pub reached: f64,
}

/// The sums of a loop; `None` where a dead load leaves no bound, or what was not asked for.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Totals {
    /// All losses.
    pub dissipated: Option<f64>,
    /// The same by area.
    pub dissipated_by_area: Option<f64>,
    /// The losses up to the pull-off, without it.
    pub dissipated_before_pull_off: f64,
    /// The work done by the device on the way up, its own elastic energy counted with the bodies.
    pub work_of_loading: f64,
    /// The same on the way down.
    pub work_of_unloading: Option<f64>,
    /// |Π(last) − Σ areas + Σ losses| over the losses, from the first touch to before the pull-off.
    pub balance: Option<f64>,
}

/// A whole loop, in reduced units.
#[derive(Debug, Clone, PartialEq)]
pub struct Cycle {
    /// What was controlled.
    pub control: Control,
    /// Where it turned.
    pub turn: TurnReached,
    /// The events in order.
    pub events: Vec<Event>,
    /// Stable states in order, dense enough to be drawn: those before and after events among them.
    pub states: Vec<CycleState>,
    /// The sums.
    pub totals: Totals,
    /// What is to be known about it.
    pub warnings: Vec<Warning>,
}

/// What ends a stretch of stable states.
#[derive(Debug)]
enum End {
    Limit(DVector<f64>),
    Touch(Crest),
    Turn,
}

/// A loop while it runs.
pub(super) struct Path<'a, 'b> {
    pub balance: &'a Balance<'b>,
    pub setting: &'a Setting<'a>,
    pub go_on: &'a dyn Fn(f64) -> bool,
    pub events: Vec<Event>,
    pub states: Vec<CycleState>,
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
/// [`CycleError`].
pub fn cycle(
    table: &Arc<Table>,
    gamma: f64,
    setting: &Setting<'_>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Cycle, CycleError> {
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
            return Err(CycleError::BadTurn(setting.turn.value()));
        }
        let ground = Ground::new(Arc::clone(table), reach, &mut || go_on(0.0))?;
        let whole = ground.reach() >= table.end() * (1.0 - 1e-9);
        let far_enough = match setting.turn {
            Turn::Approach(approach) => BEYOND * ground.can_touch_up_to(approach) <= ground.reach(),
            _ => true,
        };
        if !far_enough && !whole {
            reach = 1.5 * ground.reach();
            continue;
        }
        match cycle_on(&ground, gamma, setting, go_on) {
            Err(CycleError::BeyondGap { .. } | CycleError::RadiusBeyondGap { .. }) if !whole => {
                reach = 2.0 * ground.reach();
            }
            // A crest further out would have touched unseen.
            Ok(cycle)
                if !whole
                    && cycle
                        .states
                        .iter()
                        .any(|state| BEYOND * ground.can_touch_up_to(state.approach) > ground.reach()) =>
            {
                reach = 1.5 * ground.reach();
            }
            other => return other,
        }
    }
    Err(CycleError::NeverTouches { searched: reach })
}

/// The loop of a gap with the work of adhesion `gamma` (E* = 1), as far out as `ground` goes: a loop that comes to its end is an error.
///
/// `go_on` is asked before each step with the share of the way that is done, 0 to 1, roughly.
///
/// # Errors
/// [`CycleError`].
pub fn cycle_on(
    ground: &Ground,
    gamma: f64,
    setting: &Setting<'_>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Cycle, CycleError> {
    // Without adhesion all controls rise together, and the approach is the one that is stepped.
    let stepped = if gamma > 0.0 { setting.control } else { Control::Displacement };
    let balance = Balance { ground, work_of_adhesion: gamma, control: stepped };
    let path = Path {
        balance: &balance,
        setting,
        go_on,
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

/// The place of the least gap; the axis where it is one of several.
pub fn first_crest(ground: &Ground) -> Option<Crest> {
    const PER_WAVE: f64 = 40.0;
    let reach = ground.reach();
    let steps = (reach * PER_WAVE / ground.wave).ceil().clamp(400.0, 100_000.0);
    let value = |r: f64| ground.gap.jet(r).value;
    // A hundred thousand at most.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let count = steps as usize;
    let grid = (0..=count).map(|k| reach * k as f64 / steps);
    let radii = grid.chain(ground.breaks.iter().copied());
    let (best, _) =
        radii.map(|r| (r, value(r))).filter(|(_, h)| h.is_finite()).min_by(|a, b| a.1.total_cmp(&b.1))?;
    if best <= 0.0 {
        return Some(Crest { radius: 0.0, gap: value(0.0) });
    }
    // h' changes its sign at a smooth minimum; at a corner the bisection ends on it.
    let step = reach / steps;
    let (mut lo, mut hi) = ((best - step).max(0.0), best + step);
    if hi > reach {
        return None;
    }
    for _ in 0..100 {
        let middle = 0.5 * (lo + hi);
        if ground.gap.jet(middle).first > 0.0 { hi = middle } else { lo = middle }
    }
    let radius = if value(best) < value(hi) { best } else { hi };
    Some(Crest { radius, gap: value(radius) })
}

/// The error with what was reached, where an edge ran beyond what is known of the gap.
pub(super) fn beyond(error: CycleError, approach: f64, force: f64) -> CycleError {
    match error {
        CycleError::State(AnnuliError::BeyondGap { known, .. }) => {
            CycleError::BeyondGap { radius: known, approach, force }
        }
        other => other,
    }
}

impl Path<'_, '_> {
    pub(super) fn state(&self, held: &Held) -> CycleState {
        let state = CycleState::new(held, self.balance.work_of_adhesion, self.direction, self.piece);
        if self.balance.control == self.setting.control {
            return state;
        }
        CycleState { control_value: self.setting.control.value(held.approach, held.force), ..state }
    }

    /// What the turn is measured by.
    pub(super) fn measure(&self, held: &Held) -> f64 {
        if self.balance.control == self.setting.control && matches!(self.setting.turn, Turn::Control(_)) {
            return held.control_value;
        }
        self.setting.turn.measure(held, self.setting.control)
    }

    pub(super) fn record(&mut self, held: &Held) {
        if held.state.digits < self.digits.0 {
            self.digits = (held.state.digits, held.control_value);
        }
        let state = self.state(held);
        self.states.push(state);
    }

    fn whole(mut self) -> Result<Cycle, CycleError> {
        let (balance, setting) = (self.balance, self.setting);
        let ground = balance.ground;
        let turn = setting.turn;
        if !turn.value().is_finite() {
            return Err(CycleError::BadTurn(turn.value()));
        }
        if let Turn::Radius(radius) = turn
            && radius > ground.reach()
        {
            return Err(CycleError::RadiusBeyondGap { radius, known: ground.reach() });
        }
        let crest = first_crest(ground).ok_or(CycleError::NeverTouches { searched: ground.reach() })?;
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
                CycleError::NoTension { load: turn.value() }
            } else {
                CycleError::TurnBeforeTouch { turn: turn.value(), touch: least }
            });
        }
        if balance.work_of_adhesion == 0.0 {
            return self.without_adhesion(crest);
        }
        let mut held = self.first_touch(crest, first)?;
        self.record(&held);
        while self.measure(&held) < turn.value() {
            let (end, next) = self.stretch(&held)?;
            held = match end {
                End::Turn => {
                    held = next;
                    break;
                }
                End::Limit(null) => {
                    let start = balance.kicked(&next.state.contacts, &null, 1.0);
                    self.jump(EventKind::Advance, &next, start, None)?
                }
                End::Touch(crest) => {
                    let start = balance.seeded(&next.state.contacts, crest.radius, next.control_value)?;
                    self.jump(EventKind::Touch, &next, start, Some(crest.radius))?
                }
            }
            .ok_or(CycleError::Lost { control_value: next.control_value })?;
        }
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
        loop {
            let (end, next) = self.stretch(&held)?;
            let End::Limit(null) = end else {
                return Err(CycleError::Lost { control_value: next.control_value });
            };
            let start = balance.kicked(&next.state.contacts, &null, -1.0);
            match self.jump(EventKind::Recede, &next, start, None)? {
                Some(landed) => held = landed,
                None => break,
            }
        }
        Ok(self.finished(TurnReached { asked: turn, reached }, work_of_loading))
    }

    /// The sums of what has happened.
    fn finished(self, turn: TurnReached, work_of_loading: f64) -> Cycle {
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
            error.abs() / total.abs()
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
        Cycle { control, turn, events: self.events, states: self.states, totals, warnings }
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
                    warnings.push(Warning::Area { event, share });
                }
            }
        }
        warnings
    }

    /// The loss of a jump by area, where it is asked for.
    fn by_area(
        &self,
        before: Option<&CycleState>,
        after: Option<&CycleState>,
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
        let touches = passed.iter().filter(|passed| passed.kind == PassedKind::Touch);
        let crests: Vec<f64> = touches.map(|passed| passed.radius).collect();
        self.balance.area_between(before, after, value, &crests)
    }

    /// The first touch and what it jumps to.
    fn first_touch(&mut self, crest: Crest, value: f64) -> Result<Held, CycleError> {
        let start = self.balance.seeded(&Contacts::default(), crest.radius, value)?;
        let mut passed = vec![Passed { kind: PassedKind::Touch, radius: crest.radius }];
        let held = self
            .balance
            .run(start, value, 1.0, self.setting.mobility, &mut passed)
            .map_err(|error| beyond(error, crest.gap, 0.0))?
            .ok_or(CycleError::Lost { control_value: value })?;
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
            dissipated_by_area: self.by_area(None, Some(&after), value, &passed),
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
    ) -> Result<Option<Held>, CycleError> {
        let control = self.setting.control;
        let mut passed: Vec<Passed> =
            radius.iter().map(|radius| Passed { kind: PassedKind::Touch, radius: *radius }).collect();
        let value = before.control_value;
        let sense = self.direction.sense();
        let landed = self.balance.run(start, value, sense, self.setting.mobility, &mut passed);
        let landed = landed.map_err(|error| beyond(error, before.approach, before.force))?;
        let old = self.state(before);
        self.piece += 1;
        let after = landed.as_ref().map(|held| self.state(held));
        self.events.push(Event {
            kind: if after.is_some() { kind } else { EventKind::PullOff },
            direction: self.direction,
            control_value: value,
            radius,
            dissipated: old.loss(control, after.as_ref()),
            dissipated_by_area: self.by_area(Some(&old), after.as_ref(), value, &passed),
            before: Some(old),
            after,
            passed,
        });
        if let Some(held) = &landed {
            self.record(held);
        }
        Ok(landed)
    }

    /// Follows stable states from `held` to what ends them.
    fn stretch(&mut self, held: &Held) -> Result<(End, Held), CycleError> {
        let sense = self.direction.sense();
        let lost = CycleError::Lost { control_value: held.control_value };
        let mut point = self.balance.point(held.clone(), sense).ok_or(lost)?;
        let mut length = FIRST;
        loop {
            self.counted(&point.held)?;
            let step = Step::new(self.balance, &point);
            let Some(next) = step.taken(length) else {
                length *= 0.5;
                if length < SHORTEST {
                    return Err(self.stopped(&point.held));
                }
                continue;
            };
            let (length_taken, next, end) = self.ended(&step, &point, length, next)?;
            if self.setting.areas == Areas::Yes {
                self.area += self.area_of(&step, length_taken, &next);
            }
            self.record(&next.held);
            if let Some(end) = end {
                return Ok((end, next.held));
            }
            point = next;
            length = (1.5 * length).min(LONGEST);
        }
    }

    /// Counts a step, and asks whether to go on.
    pub(super) fn counted(&mut self, held: &Held) -> Result<(), CycleError> {
        self.steps += 1;
        if self.steps > STEPS {
            return Err(CycleError::TooLong { steps: STEPS, control_value: held.control_value });
        }
        // What could touch may lie beyond the table, where the gap goes on.
        let ground = self.balance.ground;
        if ground.reach() < ground.table.end() * (1.0 - 1e-9)
            && ground.can_touch_up_to(held.approach) >= ground.reach()
        {
            return Err(CycleError::BeyondGap {
                radius: ground.reach(),
                approach: held.approach,
                force: held.force,
            });
        }
        if (self.go_on)(self.progress(held)) { Ok(()) } else { Err(CycleError::Cancelled) }
    }

    /// Why no further step could be taken.
    pub(super) fn stopped(&self, held: &Held) -> CycleError {
        let (radius, known) = (held.state.contacts.outermost(), self.balance.ground.reach());
        if known - radius < 1e-3 * self.balance.ground.wave {
            CycleError::BeyondGap { radius: known, approach: held.approach, force: held.force }
        } else {
            CycleError::Lost { control_value: held.control_value }
        }
    }

    /// How much of the loop is done, roughly.
    fn progress(&self, held: &Held) -> f64 {
        let turn = self.setting.turn;
        let share = self.measure(held) / turn.value();
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 };
        match self.direction {
            Direction::Loading => 0.5 * share,
            Direction::Unloading => 1.0 - 0.5 * share,
        }
    }

    /// The first event on a step, which then ends there.
    fn ended(
        &self,
        step: &Step<'_, '_>,
        from: &Point,
        mut length: f64,
        mut next: Point,
    ) -> Result<(f64, Point, Option<End>), CycleError> {
        let sense = self.direction.sense();
        let lost = || CycleError::Lost { control_value: from.held.control_value };
        let mut end = None;
        if next.along_control() * sense <= 0.0 {
            let mut slope = |point: &Point| Some(point.along_control() * sense);
            (length, next) =
                step.located((length, &next), from.along_control() * sense, &mut slope).ok_or_else(lost)?;
            let edges = next.held.excess.len();
            end = Some(End::Limit(next.tangent.rows(0, edges).into_owned()));
        }
        if self.direction == Direction::Unloading {
            return Ok((length, next, end));
        }
        let crest;
        (length, next, crest) = self.touching(step, from, length, next)?;
        end = crest.map(End::Touch).or(end);
        let turn = self.setting.turn;
        if self.measure(&next.held) >= turn.value() {
            let mut left = |point: &Point| Some(self.measure(&point.held) - turn.value());
            let at_start = self.measure(&from.held) - turn.value();
            (length, next) = step.located((length, &next), at_start, &mut left).ok_or_else(lost)?;
            end = Some(End::Turn);
        }
        Ok((length, next, end))
    }

    /// The first crest that touches on a step, which then ends there.
    pub(super) fn touching(
        &self,
        step: &Step<'_, '_>,
        from: &Point,
        mut length: f64,
        mut next: Point,
    ) -> Result<(f64, Point, Option<Crest>), CycleError> {
        let lost = || CycleError::Lost { control_value: from.held.control_value };
        let mut touched = None;
        let ground = self.balance.ground;
        // The crest that touches first: each is brought to its own touch. What is left there of the one before is rounding.
        let mut overlap = 0.0;
        for _ in 0..8 {
            let crest = self.balance.least_gap(&next.held).filter(|crest| crest.gap < overlap);
            let Some(crest) = crest else { break };
            overlap = -ROUNDING * ground.wave;
            let mut at = crest;
            let mut reach = ground.wave / 14.0;
            let mut gap = |point: &Point| {
                let around = Around::new(ground, &point.held.state, point.held.approach);
                at = if crest.radius > 0.0 {
                    around.minimum([(at.radius - reach).max(0.0), at.radius + reach])
                } else {
                    Crest { radius: 0.0, gap: around.gap(0.0) }
                };
                reach = ground.wave / 28.0;
                Some(at.gap)
            };
            let at_start = gap(from).unwrap_or(f64::NAN);
            if at_start.is_nan() || at_start <= 0.0 {
                // Rounding: the start of the step touches.
                return Ok((0.0, from.clone(), Some(at)));
            }
            (length, next) = step.located((length, &next), at_start, &mut gap).ok_or_else(lost)?;
            touched = Some(at);
        }
        Ok((length, next, touched))
    }

    /// ∫ (dΠ/dc) dc over a step.
    fn area_of(&self, step: &Step<'_, '_>, length: f64, next: &Point) -> f64 {
        if length <= 0.0 {
            return 0.0;
        }
        let offset = step.offset(next);
        let line = step.tangent() * length;
        let curve = &offset - &line;
        let n = offset.len() - 1;
        let mut sum = 0.0;
        for [x, weight] in gauss(NODES) {
            let share = 0.5 * (1.0 + x);
            let guess = &line * share + &curve * (share * share);
            let Some((point, rate)) = step.to(length * share, &guess) else { return f64::NAN };
            let slope = match self.setting.control {
                Control::Force => -point.held.approach,
                Control::Displacement | Control::Stiffness(_) => point.held.force,
            };
            sum += 0.5 * length * weight * slope * rate[n] * self.balance.unit();
        }
        sum
    }
}
