//! A path with any contacts while it runs: the loop from bodies apart to a turn and back.

use super::balance::{Balance, HeldEdges};
use super::error::PathError;
use super::event::{Direction, EventKind, Passed, PassedKind, PathState};
use super::lane::Lane;
use super::record::Record;
use super::setting::{Path, PathSetting, PathStop, TurnReached, measure};
use crate::annuli::{AnnuliError, Contacts, ContactsError, GapMinimum, Ground, points};
use crate::disc::{Table, TableError};
use crate::gap::Form;
use crate::problem::{ContactKind, Control, Turn};
use crate::progress::{Progress, Stopped};
use crate::quasistatic::energy::Losses;
use crate::root;
use nalgebra::DVector;
use std::cell::RefCell;
use std::sync::Arc;

/// What ends a stretch of stable states.
#[derive(Debug)]
pub(super) enum CourseEnd {
    Limit(DVector<f64>),
    /// The outer end of this stretch of one disc.
    Fold(usize),
    Touch(GapMinimum),
    Turn,
    /// G of a held edge has reached γ.
    Free,
}

/// A path with any contacts while it runs.
pub(in crate::quasistatic) struct Course<'a, 'b> {
    pub balance: &'a Balance<'b>,
    pub setting: &'a PathSetting<'a>,
    /// Where the control turns round; `None` for the way down alone.
    pub turn: Option<Turn>,
    /// The radius below which a disc is not followed, a length.
    pub end: f64,
    pub record: Record<'a>,
    pub steps: usize,
}

/// How far a table reaches beyond what may touch.
const BEYOND: f64 = 1.3;

/// A formula is examined up to this many of its lengths.
const LENGTHS: f64 = 10.0;

/// The loop of the gap of `table` with the work of adhesion `gamma` (E* = 1): as [`cycle_on`], but as far out as the
/// loop needs.
///
/// # Errors
/// [`PathError`].
pub fn cycle(
    table: &Arc<Table>,
    gamma: f64,
    turn: Turn,
    setting: &PathSetting<'_>,
    progress: &dyn Progress,
) -> Result<Path, PathError> {
    let reach = match turn {
        Turn::Radius(radius) => BEYOND * radius,
        Turn::Approach(approach) => 2.0 * approach.abs().sqrt(),
        Turn::Force(_) | Turn::Control(_) => 0.5,
    };
    let far_enough = |ground: &Ground| match turn {
        Turn::Approach(approach) => BEYOND * ground.can_touch_up_to(approach) <= ground.reach(),
        _ => true,
    };
    let path = |ground: &Ground| cycle_on(ground, gamma, turn, setting, progress);
    on_ground(table, at_least(table, reach), &far_enough, progress, &path, &highest)
}

/// How far out a gap is examined where `reach` is wanted.
pub(super) fn at_least(table: &Table, reach: f64) -> f64 {
    let reach = reach.max(2.0 * table.gap().feature_length().unwrap_or(0.0)).max(0.05);
    if matches!(table.gap().form(), Form::Any) { reach.max(LENGTHS) } else { reach }
}

/// What `find` finds on as much of the gap as it needs: `reach` at first, and more where that is not `far_enough` or
/// where it comes to the end of it. `highest` gives the largest approach of what is found.
///
/// # Errors
/// [`PathError`].
pub(in crate::quasistatic) fn on_ground<T>(
    table: &Arc<Table>,
    mut reach: f64,
    far_enough: &dyn Fn(&Ground) -> bool,
    progress: &dyn Progress,
    find: &dyn Fn(&Ground) -> Result<T, PathError>,
    highest: &dyn Fn(&T) -> f64,
) -> Result<T, PathError> {
    /// How many times the gap may be searched further out for its least value.
    const FURTHER: usize = 6;
    let mut last = PathError::NeverTouches { searched: reach };
    for round in 0..40 {
        let ground = Ground::new(Arc::clone(table), reach, progress)?;
        let whole = ground.reach() >= table.end() * (1.0 - 1e-9);
        if !far_enough(&ground) && !whole {
            reach = 1.5 * ground.reach();
            continue;
        }
        match find(&ground) {
            Err(
                error @ (PathError::BeyondGap { .. }
                | PathError::RadiusBeyondGap { .. }
                | PathError::State(AnnuliError::BeyondGap { .. })),
            ) if !whole => {
                (reach, last) = (2.0 * ground.reach(), error);
            }
            Err(error @ PathError::NeverTouches { .. }) if !whole && round < FURTHER => {
                (reach, last) = (2.0 * ground.reach(), error);
            }
            // A crest further out would have touched unseen.
            Ok(found) if !whole && BEYOND * ground.can_touch_up_to(highest(&found)) > ground.reach() => {
                reach = 1.5 * ground.reach();
            }
            other => return other,
        }
    }
    Err(last)
}

/// The largest approach of a path.
pub(super) fn highest(path: &Path) -> f64 {
    path.states.iter().map(|state| state.approach).fold(f64::NEG_INFINITY, f64::max)
}

/// The loop of a gap with the work of adhesion `gamma` (E* = 1), as far out as `ground` goes: a loop that reaches the
/// end of `ground` is an error.
///
/// Before each step `progress` is told roughly what share of the way is done, 0 to 1, and is asked whether to go on.
///
/// # Errors
/// [`PathError`].
pub fn cycle_on(
    ground: &Ground,
    gamma: f64,
    turn: Turn,
    setting: &PathSetting<'_>,
    progress: &dyn Progress,
) -> Result<Path, PathError> {
    if !turn.value().is_finite() {
        return Err(PathError::BadTurn(turn.value()));
    }
    let growing = setting.closing_below(gamma).unwrap_or(gamma);
    let lane = lane(ground, growing, setting.control, progress)?;
    let balance = balance(ground, growing, setting, lane.as_ref(), progress);
    Course { turn: Some(turn), ..Course::new(&balance, setting, Direction::Loading) }.whole(turn, gamma)
}

/// The equilibria of one disc that adheres.
pub(super) fn lane(
    ground: &Ground,
    gamma: f64,
    control: Control,
    progress: &dyn Progress,
) -> Result<Option<Lane>, TableError> {
    (gamma > 0.0).then(|| Lane::new(ground, gamma, control, progress)).transpose()
}

/// The balance that holds contacts on a path.
pub(super) fn balance<'a>(
    ground: &'a Ground,
    gamma: f64,
    setting: &PathSetting<'_>,
    lane: Option<&'a Lane>,
    progress: &'a dyn Progress,
) -> Balance<'a> {
    // Without adhesion all controls rise together, and steps are taken in the approach.
    let control = if gamma > 0.0 { setting.control } else { Control::Displacement };
    let (contact, pinned) = (setting.contact, None);
    Balance { ground, work_of_adhesion: gamma, control, contact, progress, lane, pinned }
}

/// The place of the least gap; the axis if it is one of several such places. `None` where there is none, or `progress`
/// said stop.
fn first_crest(ground: &Ground, progress: &dyn Progress) -> Option<GapMinimum> {
    /// Radii at which the gap is evaluated between two calls of `progress`.
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
        return Some(GapMinimum { radius: 0.0, gap: value(0.0) });
    }
    // h' changes its sign at a smooth minimum; at a corner the bisection ends on it.
    let at = radii.partition_point(|r| *r < best);
    let falls = |r: f64| ground.gap.jet(r).first <= 0.0;
    let [_, found] = root::halved(radii[at.saturating_sub(1)], *radii.get(at + 1)?, falls);
    let radius = if value(best) < value(found) { best } else { found };
    Some(GapMinimum { radius, gap: value(radius) })
}

/// The error, with the state that was reached, where an edge ran beyond the known gap or a state has too many
/// contacts.
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

impl<'a, 'b> Course<'a, 'b> {
    /// A course that has not begun, without a turn or an end.
    pub fn new(balance: &'a Balance<'b>, setting: &'a PathSetting<'a>, direction: Direction) -> Self {
        let record = Record::new(setting, direction, balance.progress);
        Self { balance, setting, turn: None, end: 0.0, record, steps: 0 }
    }
}

impl Course<'_, '_> {
    pub(super) fn state(&self, held: &HeldEdges) -> PathState {
        let Record { direction, piece, .. } = self.record;
        let state = PathState::new(held, self.balance.work_of_adhesion, direction, piece);
        PathState { control_value: self.control_value(held), ..state }
    }

    /// The control value under the device of the path: without adhesion, edges are held by the approach.
    fn control_value(&self, held: &HeldEdges) -> f64 {
        let Record { control, .. } = self.record;
        if self.balance.control == control {
            held.control_value
        } else {
            control.value(held.approach, held.force)
        }
    }

    /// The refusal of a path that cannot be followed beyond these edges.
    pub(super) fn lost(&self, held: &HeldEdges) -> PathError {
        PathError::Lost { control_value: self.control_value(held) }
    }

    /// The value by which the turn is measured.
    pub(super) fn measure(&self, held: &HeldEdges) -> f64 {
        match self.turn {
            Some(Turn::Control(_)) => self.control_value(held),
            Some(turn) => measure(turn, held, self.setting.control),
            None => f64::NEG_INFINITY,
        }
    }

    /// Whether the turn is reached.
    pub(super) fn has_turned(&self, held: &HeldEdges) -> bool {
        self.turn.is_some_and(|turn| self.measure(held) >= turn.value())
    }

    pub(super) fn record(&mut self, held: &HeldEdges) {
        if held.state.digits < self.record.digits.0 {
            self.record.digits = (held.state.digits, self.control_value(held));
        }
        let state = self.state(held);
        self.record.states.push(state);
    }

    /// The crest that touches first, and the control value at which it does.
    ///
    /// # Errors
    /// [`PathError`] where the bodies do not touch, or not before the turn.
    pub fn first_crest(&self) -> Result<(GapMinimum, f64), PathError> {
        let (balance, setting) = (self.balance, self.setting);
        let ground = balance.ground;
        if let Some(Turn::Radius(radius)) = self.turn
            && radius > ground.reach()
        {
            return Err(PathError::RadiusBeyondGap { radius, known: ground.reach() });
        }
        let progress = balance.progress;
        let crest = match setting.contact {
            ContactKind::Rings => first_crest(ground, progress),
            ContactKind::OneDisc => Some(GapMinimum { radius: 0.0, gap: ground.gap.jet(0.0).value }),
        };
        let Some(crest) = crest else {
            let searched = ground.reach();
            return Err(if progress.stop() {
                PathError::Stopped(Stopped)
            } else {
                PathError::NeverTouches { searched }
            });
        };
        let first = match setting.control {
            Control::Force => 0.0,
            Control::Displacement | Control::Stiffness(_) => crest.gap,
        };
        let Some(turn) = self.turn else { return Ok((crest, first)) };
        if turn.is_prescribed(setting.control) && turn.value() < first {
            return Err(if setting.control == Control::Force && balance.work_of_adhesion == 0.0 {
                PathError::NoTension { load: turn.value() }
            } else {
                PathError::TurnBeforeTouch { turn: turn.value(), touch: first }
            });
        }
        Ok((crest, first))
    }

    fn whole(mut self, turn: Turn, gamma: f64) -> Result<Path, PathError> {
        let balance = self.balance;
        let (crest, first) = self.first_crest()?;
        if balance.work_of_adhesion == 0.0 {
            return self.without_adhesion(crest, turn);
        }
        let held = self.loaded(crest, first).map_err(|error| match self.record.states.last() {
            Some(last) => beyond(error, last.approach, last.force),
            None => error,
        })?;
        let reached = self.measure(&held);
        let at_turn = self.state(&held);
        let more = gamma - balance.work_of_adhesion;
        let work_of_loading = self.record.turned(at_turn, (more > 0.0).then_some(more));
        let turn = Some(TurnReached { asked: turn, reached });
        self.down(held, gamma, &|record, stop| record.finished(None, turn, work_of_loading, stop))
    }

    /// The way down, at the work of adhesion `gamma`, of contacts that are already recorded. Edges that gained less in
    /// closing are held until their G has reached γ.
    pub(super) fn down(
        mut self,
        held: HeldEdges,
        gamma: f64,
        finished: &dyn Fn(Record<'_>, PathStop) -> Path,
    ) -> Result<Path, PathError> {
        if gamma <= self.balance.work_of_adhesion {
            let stop = self.unloaded(held)?;
            return Ok(finished(self.record, stop));
        }
        let Balance { ground, progress, .. } = *self.balance;
        let lane = lane(ground, gamma, self.setting.control, progress)?;
        let edges = held.state.contacts.edges().iter().map(|edge| edge.radius).collect();
        let pinned = RefCell::new(edges);
        let balance = Balance {
            pinned: Some(&pinned),
            ..balance(ground, gamma, self.setting, lane.as_ref(), progress)
        };
        let contacts = held.state.contacts;
        let held = balance.held(&contacts, &points(ground, &contacts), held.control_value)?;
        let mut course = Course { balance: &balance, ..self };
        let stop = course.unloaded(held)?;
        Ok(finished(course.record, stop))
    }

    /// From the first touch at a crest to the turn.
    pub(super) fn loaded(&mut self, crest: GapMinimum, value: f64) -> Result<HeldEdges, PathError> {
        let mut held = self.first_touch(crest, value)?;
        while !self.has_turned(&held) {
            let (end, next) = self.way_up(&held)?;
            held = match end {
                CourseEnd::Turn => return Ok(next),
                CourseEnd::Free => None,
                CourseEnd::Limit(null) => {
                    let start = self.balance.kicked(&next.state.contacts, &null, 1.0);
                    self.jump(EventKind::SnapIn, &next, start, None)?
                }
                CourseEnd::Fold(stretch) => {
                    self.balance.lane.map(|lane| self.advance(lane, &next, stretch)).transpose()?
                }
                CourseEnd::Touch(crest) => {
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

    /// The way down of contacts that are already recorded, until the bodies are apart.
    pub(super) fn unloaded(&mut self, mut held: HeldEdges) -> Result<PathStop, PathError> {
        let balance = self.balance;
        loop {
            let contacts = &held.state.contacts;
            if let Some(lane) = balance.lane_of(contacts) {
                if balance.is_pinned(contacts.disc) {
                    return self.record.released(lane, contacts.disc, self.end);
                }
                if let Some(stop) = self.descend(lane, &held)? {
                    return Ok(stop);
                }
            }
            let (end, mut next) = self.stretch(&held)?;
            let null = match end {
                CourseEnd::Limit(null) => null,
                CourseEnd::Free => {
                    next = self.let_go(&next)?;
                    if Balance::least_eigenvalue(&next) > 0.0 {
                        held = next;
                        continue;
                    }
                    Balance::softest(&next)
                }
                _ => return Err(PathError::Lost { control_value: next.control_value }),
            };
            let start = balance.kicked(&next.state.contacts, &null, -1.0);
            match self.jump(EventKind::Snap, &next, start, None)? {
                Some(landed) => held = landed,
                None => return Ok(PathStop::Apart),
            }
        }
    }

    /// The edges where a held one begins to move; from here on it may.
    fn let_go(&mut self, at: &HeldEdges) -> Result<HeldEdges, PathError> {
        let balance = self.balance;
        let lost = PathError::Lost { control_value: at.control_value };
        let (radius, _) = balance.nearest_to_moving(at).ok_or(lost)?;
        let state = self.state(at);
        self.record.depinned(radius, &state);
        balance.let_go(radius);
        let contacts = &at.state.contacts;
        Ok(balance.held(contacts, &points(balance.ground, contacts), at.control_value)?)
    }

    /// The loss of a jump by area, where it is asked for.
    fn by_area(
        &self,
        [before, after]: [Option<&PathState>; 2],
        value: f64,
        passed: &[Passed],
    ) -> Option<f64> {
        // Bodies apart hold nothing; under a dead load the loss has no bound.
        if self.setting.losses == Losses::Once || (after.is_none() && self.setting.control == Control::Force)
        {
            return None;
        }
        let on_lane = self.balance.lane.and_then(|lane| match (before, after) {
            (Some(before), after) => lane.area(&before.contacts, after.map(|after| &after.contacts[..])),
            // The work from bodies apart to this state is that of the way back with the other sign.
            (None, Some(after)) => lane.area(&after.contacts, None).map(|area| -area),
            (None, None) => None,
        });
        on_lane.or_else(|| {
            let touches = passed.iter().filter(|passed| passed.kind == PassedKind::Touch);
            let crests: Vec<f64> = touches.map(|passed| passed.radius).collect();
            self.balance.area_between(before, after, value, &crests)
        })
    }

    /// Follows stable states while the control goes up, to what ends them.
    fn way_up(&mut self, held: &HeldEdges) -> Result<(CourseEnd, HeldEdges), PathError> {
        let lane = self.balance.lane_of(&held.state.contacts);
        match lane.map(|lane| self.rise(lane, held)).transpose()?.flatten() {
            Some(found) => Ok(found),
            None => self.stretch(held),
        }
    }

    /// The first touch, and the state it jumps to.
    pub fn first_touch(&mut self, crest: GapMinimum, value: f64) -> Result<HeldEdges, PathError> {
        let start = self.balance.seeded(&Contacts::default(), crest.radius, value)?;
        let mut passed = vec![Passed { kind: PassedKind::Touch, radius: crest.radius }];
        let held = self
            .balance
            .run(start, value, 1.0, self.setting.mobility, &mut passed)
            .map_err(|error| beyond(error, crest.gap, 0.0))?
            .ok_or(PathError::Lost { control_value: value })?;
        self.jumped(EventKind::FirstTouch, None, Some(&held), Some(crest.radius), passed);
        Ok(held)
    }

    /// A jump and its event; `None` where the bodies came apart.
    pub fn jump(
        &mut self,
        kind: EventKind,
        before: &HeldEdges,
        start: Contacts,
        radius: Option<f64>,
    ) -> Result<Option<HeldEdges>, PathError> {
        let mut passed: Vec<Passed> =
            radius.iter().map(|radius| Passed { kind: PassedKind::Touch, radius: *radius }).collect();
        let value = before.control_value;
        let sense = self.record.direction.sense();
        let landed = self.balance.run(start, value, sense, self.setting.mobility, &mut passed);
        let landed = landed.map_err(|error| beyond(error, before.approach, before.force))?;
        self.jumped(kind, Some(before), landed.as_ref(), radius, passed);
        Ok(landed)
    }

    /// Adds the event of a jump that has landed, or of bodies that came apart, with the state after it.
    pub(super) fn jumped(
        &mut self,
        kind: EventKind,
        before: Option<&HeldEdges>,
        landed: Option<&HeldEdges>,
        radius: Option<f64>,
        passed: Vec<Passed>,
    ) {
        let [old, new] = [before, landed].map(|held| held.map(|held| self.state(held)));
        let value = before.or(landed).map_or(f64::NAN, |held| held.control_value);
        let by_area = self.by_area([old.as_ref(), new.as_ref()], value, &passed);
        if let Some(held) = landed.filter(|held| held.state.digits < self.record.digits.0) {
            self.record.digits = (held.state.digits, self.control_value(held));
        }
        self.record.jump(kind, [old, new], radius, by_area, passed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::Gap;
    use crate::gap::shapes::{Harmonic, Harmonics};
    use crate::progress::Unwatched;

    /// The loop of a gap, with discs on the exact panels or followed step by step like any contact.
    fn looped(ground: &Ground, gamma: f64, control: Control, turn: Turn, on_lane: bool) -> Path {
        let setting = PathSetting::new(control);
        let lane = on_lane.then(|| Lane::new(ground, gamma, control, &Unwatched).unwrap());
        let balance = balance(ground, gamma, &setting, lane.as_ref(), &Unwatched);
        let course = Course { turn: Some(turn), ..Course::new(&balance, &setting, Direction::Loading) };
        course.whole(turn, gamma).unwrap()
    }

    fn agree(numbers: std::ops::Range<u64>) {
        for number in numbers {
            let mut random = fastrand::Rng::with_seed(number);
            let mut even = |lo: f64, hi: f64| lo + (hi - lo) * random.f64();
            let wavelength = even(0.05, 0.15);
            let amplitude = wavelength * wavelength / even(1.0, 9.0);
            let phase = even(-0.5, 0.5);
            let gamma = 1e-4 * 30.0_f64.powf(even(0.0, 1.0));
            let control = [Control::Displacement, Control::Force, Control::Stiffness(0.3)]
                [usize::try_from(number % 3).unwrap()];
            let turn = Turn::Approach(even(0.01, 0.06));
            let gap: Arc<dyn Gap> =
                Arc::new(Harmonics::new(1.0, vec![Harmonic { amplitude, wavelength, phase }]).unwrap());
            let ground = Ground::of(gap, 1.0).unwrap();
            let [on, off] = [true, false].map(|lane| looped(&ground, gamma, control, turn, lane));
            let kinds = |path: &Path| path.events.iter().map(|event| event.kind).collect::<Vec<_>>();
            assert_eq!(kinds(&on), kinds(&off), "{number}");
            for (a, b) in on.events.iter().zip(&off.events) {
                let edges = |state: &Option<PathState>| state.as_ref().map(|state| state.contacts.concat());
                for (x, y) in [(&a.before, &b.before), (&a.after, &b.after)] {
                    let (x, y) = (edges(x).unwrap_or_default(), edges(y).unwrap_or_default());
                    let near = |(x, y): (&f64, &f64)| (x - y).abs() < 1e-6 * wavelength;
                    assert!(x.len() == y.len() && x.iter().zip(&y).all(near), "{number}: {a:?} {b:?}");
                }
                let [x, y] = [a, b].map(|event| event.dissipated.unwrap_or(0.0));
                assert!((x - y).abs() <= 1e-7 * x.abs() + 1e-16, "{number}: {a:?} {b:?}");
            }
        }
    }

    #[test]
    fn a_disc_step_by_step_does_what_it_does_on_its_panels() {
        agree(0..12);
    }

    #[test]
    #[ignore = "a minute"]
    fn a_hundred_and_twenty_discs_step_by_step_do_what_they_do_on_their_panels() {
        agree(0..120);
    }
}
