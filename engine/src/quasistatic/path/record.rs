//! What has happened on a path so far.

use super::error::{PathError, Warning};
use super::event::{Direction, Event, EventKind, Passed, PathState};
use super::lane::Lane;
use super::setting::{AskedState, DeadBand, Path, PathSetting, PathStop, Totals, TurnReached};
use crate::disc::Place;
use crate::problem::{ContactKind, Control};
use crate::progress::Progress;
use crate::quasistatic::curve::CurveStop;
use crate::quasistatic::descent::{AT_END, Descent, descend, stable_start};
use crate::quasistatic::energy::{self, Losses};
use crate::quasistatic::jump::{self, EdgeDirection, Landing};
use crate::quasistatic::places::{Detail, places};

/// The share of its losses to which the balance of a path may stay open.
const BALANCED: f64 = 1e-6;

/// The share of a loss by which energy and area may differ.
const AGREE: f64 = 1e-6;

/// The number of digits below which a path has a warning.
const DIGITS: f64 = 9.0;

/// The smallest radius of a state that is not asked for, as a share of the largest.
const SMALLEST: f64 = 1e-6;

/// States of one disc between two calls of `progress`.
const TOGETHER: usize = 256;

/// A path while it runs.
pub(in crate::quasistatic) struct Record<'a> {
    pub control: Control,
    pub contact: ContactKind,
    pub losses: Losses,
    pub detail: Detail,
    pub progress: &'a dyn Progress,
    pub events: Vec<Event>,
    pub states: Vec<PathState>,
    pub piece: usize,
    pub direction: Direction,
    /// Σ ∫ (dΠ/dc) dc.
    pub area: f64,
    /// The fewest digits, and where.
    pub digits: (f64, f64),
    /// Π where the path begins.
    pub begin: f64,
    /// What the area that closed loses when it opens.
    pub dead_band: Option<DeadBand>,
}

impl<'a> Record<'a> {
    /// An empty record.
    pub fn new(setting: &PathSetting<'_>, direction: Direction, progress: &'a dyn Progress) -> Self {
        Self {
            control: setting.control,
            contact: setting.contact,
            losses: setting.losses,
            detail: setting.detail,
            progress,
            events: Vec::new(),
            states: Vec::new(),
            piece: 0,
            direction,
            area: 0.0,
            digits: (f64::INFINITY, f64::NAN),
            begin: 0.0,
            dead_band: None,
        }
    }

    /// The state of one disc at a place.
    pub fn disc(&self, lane: &Lane, place: Place) -> PathState {
        let state = PathState::of_disc(&*lane.solution, place, self.control, self.direction);
        PathState { piece: self.piece, ..state }
    }

    /// The first state of a path that begins in contact.
    pub fn begun(&mut self, state: PathState) {
        self.begin = state.potential(self.control);
        self.states.push(state);
    }

    /// Adds the stable states of one disc between two places, in the order of the way and without the first, with
    /// their area.
    ///
    /// # Errors
    /// [`PathError::Stopped`].
    pub fn along(&mut self, lane: &Lane, [mut from, to]: [Place; 2]) -> Result<(), PathError> {
        let radius = |place: Place| lane.solution.radius(place);
        let is_inward = radius(to) < radius(from);
        let (lo, hi) = (radius(from).min(radius(to)), radius(from).max(radius(to)));
        let mut touches = lane.solution.touches().to_vec();
        touches.retain(|place| lo < radius(*place) && radius(*place) < hi);
        if is_inward {
            touches.reverse();
        }
        for at in touches {
            self.along_smooth(lane, [from, at])?;
            let state = self.disc(lane, at);
            let kind = if is_inward { EventKind::LastContact } else { EventKind::FirstTouch };
            self.continuous(kind, Some(0.0), [Some(state.clone()), Some(state)]);
            from = at;
        }
        self.along_smooth(lane, [from, to])
    }

    /// The same where contact neither begins nor ends in between.
    fn along_smooth(&mut self, lane: &Lane, [from, to]: [Place; 2]) -> Result<(), PathError> {
        let solution = &*lane.solution;
        let order = |place: Place| (place.panel, place.x);
        let is_inward = order(to) <= order(from);
        let (inner, outer) = if is_inward { (to, from) } else { (from, to) };
        let [lo, hi] = [inner, outer].map(|place| solution.radius(place));
        // Extremes are among them: the smallest force of a path is that of one of its states.
        let mut between: Vec<(f64, Place)> = places(solution, hi, lo.max(SMALLEST * hi), self.detail)
            .into_iter()
            .chain(lane.extremes.iter().copied())
            .map(|place| (solution.radius(place), place))
            .filter(|(s, _)| lo < *s && *s < hi)
            .collect();
        between.sort_by(|a, b| a.0.total_cmp(&b.0));
        if is_inward {
            between.reverse();
        }
        for some in between.chunks(TOGETHER) {
            self.progress.go_on()?;
            let states: Vec<PathState> = some.iter().map(|(_, place)| self.disc(lane, *place)).collect();
            self.states.extend(states);
        }
        if self.losses == Losses::Twice {
            self.area += energy::work(solution, self.control, from, to).unwrap_or(f64::NAN);
        }
        self.states.push(self.disc(lane, to));
        Ok(())
    }

    /// The way of one disc down to the radius `to`, jump by jump, from a stable state that is already recorded.
    ///
    /// # Errors
    /// [`PathError::Stopped`].
    pub fn descend(&mut self, lane: &Lane, from: Landing, to: f64) -> Result<Descent, PathError> {
        let descent = descend(&*lane.solution, &lane.monotone, from, to);
        let mut jumps = descent.jumps.iter();
        for piece in &descent.pieces {
            self.along(lane, *piece)?;
            if let Some(jump) = jumps.next() {
                self.ran(lane, jump.before, jump.landing);
            }
        }
        Ok(descent)
    }

    /// Adds a jump of one disc.
    pub fn ran(&mut self, lane: &Lane, before: Place, landing: Option<Landing>) {
        let landing = landing.map(|landing| landing.place);
        self.jumped(Event::of_disc(&*lane.solution, self.control, before, landing, self.losses));
    }

    /// Adds a jump, and the state after it as the first of the next stretch.
    pub fn jumped(&mut self, mut event: Event) {
        if let Some(before) = &mut event.before {
            before.piece = self.piece;
            before.direction = self.direction;
        }
        event.direction = self.direction;
        self.piece += 1;
        if let Some(after) = &mut event.after {
            (after.piece, after.direction) = (self.piece, self.direction);
            self.states.push(after.clone());
        }
        self.events.push(event);
    }

    /// Adds a jump of edges that run at a held control value, with its loss by area.
    pub fn jump(
        &mut self,
        kind: EventKind,
        [before, after]: [Option<PathState>; 2],
        radius: Option<f64>,
        by_area: Option<f64>,
        passed: Vec<Passed>,
    ) {
        let kind = if after.is_some() { kind } else { EventKind::LastContact };
        let before = before.map(|state| PathState { stable: !kind.begins_at_limit(), ..state });
        let value = before.as_ref().or(after.as_ref()).map_or(f64::NAN, |state| state.control_value);
        let dissipated = match (&before, &after, self.control) {
            (Some(before), after, control) => before.loss(control, after.as_ref()),
            // The bodies apart hold nothing at P = 0.
            (None, Some(after), Control::Force) => Some(-after.energy),
            (None, Some(after), control) => Some(-after.potential(control)),
            (None, None, _) => None,
        };
        self.jumped(Event {
            kind,
            direction: self.direction,
            control_value: value,
            radius,
            before,
            after,
            dissipated,
            dissipated_by_area: by_area,
            passed,
        });
    }

    /// Adds an event at which nothing runs and nothing is lost.
    pub fn continuous(
        &mut self,
        kind: EventKind,
        radius: Option<f64>,
        [before, after]: [Option<PathState>; 2],
    ) {
        let control_value = after.as_ref().or(before.as_ref()).map_or(f64::NAN, |state| state.control_value);
        self.events.push(Event {
            kind,
            direction: self.direction,
            control_value,
            radius,
            before,
            after,
            dissipated: Some(0.0),
            dissipated_by_area: (self.losses == Losses::Twice).then_some(0.0),
            passed: Vec::new(),
        });
    }

    /// Turns the control round and returns the work done on the way up. With `more`, a unit of area costs that much
    /// more to open than it gained in closing.
    pub fn turned(&mut self, at: PathState, more: Option<f64>) -> Option<f64> {
        let potential = match self.control {
            Control::Force => at.energy,
            control => at.potential(control),
        };
        let work = self.lost().map(|lost| potential + lost);
        self.continuous(EventKind::Turn, None, [Some(at.clone()), Some(at.clone())]);
        self.direction = Direction::Unloading;
        self.piece += 1;
        let area = at.contact_area;
        self.dead_band = more.map(|more| DeadBand { area, lost: more * area });
        let energy = at.energy - self.dead_band.map_or(0.0, |band| band.lost);
        self.states.push(PathState { energy, direction: self.direction, piece: self.piece, ..at });
        work
    }

    /// The way of held edges from the last state to another, along a straight line in δ and P.
    pub fn pinned(&mut self, to: PathState) {
        if let Some(from) = self.states.last().filter(|_| self.losses == Losses::Twice) {
            let [approach, force] = [to.approach - from.approach, to.force - from.force];
            let [mean_approach, mean_force] =
                [0.5 * (to.approach + from.approach), 0.5 * (to.force + from.force)];
            self.area += match self.control {
                Control::Displacement => mean_force * approach,
                Control::Force => -mean_approach * force,
                Control::Stiffness(k) => mean_force * (approach + force / k),
            };
        }
        self.states.push(to);
    }

    /// Adds the event at which an edge begins to move.
    pub fn depinned(&mut self, radius: f64, at: &PathState) {
        self.continuous(EventKind::Depin, Some(radius), [Some(at.clone()), Some(at.clone())]);
    }

    /// The way of one disc down to the radius `to` from a recorded state in which its edge is held at the radius `s`:
    /// along a straight line to where G is γ, and from there as [`descend`](Self::descend), or inward at once where no
    /// device holds the edge.
    ///
    /// # Errors
    /// [`PathError`].
    pub fn released(&mut self, lane: &Lane, s: f64, to: f64) -> Result<PathStop, PathError> {
        let (solution, monotone) = (&*lane.solution, &*lane.monotone);
        let place = solution.place(s).ok_or(PathError::Lost { control_value: f64::NAN })?;
        let free = self.disc(lane, place);
        self.pinned(free.clone());
        self.depinned(s, &free);
        let here = if let Some(here) = stable_start(solution, monotone, s) {
            here
        } else {
            let value = monotone.value(&solution.at(place));
            let landing = jump::run(solution, monotone, monotone.stretch_of(s), value, EdgeDirection::Inward);
            let landing = match landing {
                Ok(landing) => landing,
                Err(hole) => return Ok(PathStop::Curve(CurveStop::NoEquilibrium(hole))),
            };
            let after = landing.map(|landing| landing.place);
            self.jumped(Event::of_disc(solution, self.control, place, after, self.losses));
            let Some(landing) = landing else { return Ok(PathStop::Apart) };
            if solution.radius(landing.place) < to * (1.0 - AT_END) {
                return Ok(PathStop::End);
            }
            landing
        };
        self.descend(lane, here, to).map(|descent| stop_of(&descent))
    }

    /// The losses so far; `None` where one has no bound.
    pub fn lost(&self) -> Option<f64> {
        self.events.iter().try_fold(0.0, |sum, event| Some(sum + event.dissipated?))
    }

    /// The path with its sums.
    pub fn finished(
        self,
        asked: Option<AskedState>,
        turn: Option<TurnReached>,
        work_of_loading: Option<f64>,
        stop: PathStop,
    ) -> Path {
        let control = self.control;
        let ends_apart = self.events.last().is_some_and(Event::separates);
        let before = &self.events[..self.events.len() - usize::from(ends_apart)];
        let before_last: f64 = before.iter().filter_map(|event| event.dissipated).fold(0.0, |a, b| a + b);
        let is_whole = !matches!(stop, PathStop::BeyondZone { .. });
        let total = self.lost().filter(|_| is_whole);
        let last = self.states.last().map(|state| state.potential(control));
        let is_twice = self.losses == Losses::Twice;
        let balance = last.filter(|_| is_twice && self.area != 0.0).map(|last| {
            let band = self.dead_band.map_or(0.0, |band| band.lost);
            let error = last - self.begin - self.area + before_last + band;
            let whole = self.lost().unwrap_or(before_last).abs();
            // An unloading from a start in contact is measured by what it stored there; a path that ends before its
            // turn, by what it stores at its end.
            let stored = self.begin.abs().max(last.abs());
            error.abs() / whole.max(work_of_loading.map_or(stored, f64::abs))
        });
        let by_area = self.events.iter().try_fold(0.0, |sum, event| Some(sum + event.dissipated_by_area?));
        let at_turn = work_of_loading.map_or(Some(self.begin), |work| {
            let up = self.events.iter().filter(|event| event.direction == Direction::Loading);
            let band = self.dead_band.map_or(0.0, |band| band.lost);
            Some(work - band - up.filter_map(|event| event.dissipated).fold(0.0, |a, b| a + b))
        });
        let down = self.events.iter().filter(|event| event.direction == Direction::Unloading);
        let lost_down = down.into_iter().try_fold(0.0, |sum, event| Some(sum + event.dissipated?));
        let totals = Totals {
            dissipated: total,
            dissipated_by_area: by_area.filter(|_| is_whole),
            dissipated_before_last_contact: before_last,
            work_of_loading,
            work_of_unloading: lost_down.zip(at_turn).filter(|_| ends_apart).map(|(lost, at)| lost - at),
            dead_band: self.dead_band,
            balance,
        };
        let warnings = self.warnings(balance);
        Path {
            control,
            contact: self.contact,
            asked,
            turn,
            events: self.events,
            states: self.states,
            stop,
            totals,
            warnings,
        }
    }

    /// The warnings about it.
    fn warnings(&self, balance: Option<f64>) -> Vec<Warning> {
        let mut warnings = Vec::new();
        // Written so that NaN warns too.
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
}

/// Why a way down ended.
pub(super) fn stop_of(descent: &Descent) -> PathStop {
    match descent.hole {
        Some(hole) => PathStop::Curve(CurveStop::NoEquilibrium(hole)),
        None if descent.pulls_off() => PathStop::Apart,
        None => PathStop::End,
    }
}
