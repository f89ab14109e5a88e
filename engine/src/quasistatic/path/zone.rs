//! A path under adhesion with a range: from bodies apart, through the jump into a zone, to the turn and back, along
//! one disc in one zone.
//!
//! Every stable stretch and every landing is checked to be one disc in one zone
//! ([`Zone::fault`](crate::zone::Zone::fault)). A path that comes to a state with more ends before it and names it.

use super::error::PathError;
use super::event::{Direction, EventKind, Passed, PassedKind, PathState};
use super::lane::Lane;
use super::record::Record;
use super::setting::{AskedState, Path, PathSetting, PathStop, TurnReached, WhyNot};
use super::zones::{FURTHER, beyond, fault, place_of, zone_at};
use crate::disc::{Local, Place, Solution, Table};
use crate::elementary::cbrt;
use crate::problem::{Cohesion, Control, Start, Turn};
use crate::progress::Progress;
use crate::quasistatic::descent::{descend, stable_start};
use crate::quasistatic::energy::{self, Losses};
use crate::quasistatic::equilibrium::State;
use crate::quasistatic::jump::{self, EdgeDirection, Landing};
use crate::quasistatic::monotone::{Monotone, weighted};
use crate::quasistatic::start::StartError;
use crate::zone::{Ends, Equilibria, ZoneFault, ZoneState, equilibria};
use std::cell::Cell;
use std::sync::Arc;

/// How many times the equilibria may be grown for a path.
const TIMES: usize = 40;

/// Places between the ends of an outward jump that are examined, besides those where the control is largest.
const PASSED: u32 = 6;

/// Halvings with which the first state with a fault is located.
const HALVINGS: usize = 24;

/// A value is looked for at most this many times as far out as where it is first taken.
const FARTHER: f64 = 4.0;

/// How far beyond a corner the edge of a contact that passes it is examined, as a share of the radius.
const BEYOND_CORNER: f64 = 1e-3;

/// The loop of the gap of `table` with adhesion that has a range (E* = 1): from bodies apart to the turn and back
/// until they are apart.
///
/// # Errors
/// [`PathError`]; [`PathError::BeyondZone`] where the first state is more than one disc in one zone. Where a later
/// state is more, the path stops before it.
pub fn cycle_in_zone(
    table: &Arc<Table>,
    cohesion: Cohesion,
    turn: Turn,
    setting: &PathSetting<'_>,
    progress: &dyn Progress,
) -> Result<Path, PathError> {
    if !turn.value().is_finite() {
        return Err(PathError::BadTurn(turn.value()));
    }
    if let Turn::Radius(radius) = turn
        && radius > table.end()
    {
        return Err(PathError::RadiusBeyondGap { radius, known: table.end() });
    }
    let apart = setting.control.value(-cohesion.range, 0.0);
    if turn.is_prescribed(setting.control) && turn.value() < apart {
        return Err(PathError::TurnBeforeTouch { turn: turn.value(), touch: apart });
    }
    let reach = match turn {
        Turn::Radius(radius) => equilibria::about(cohesion, radius),
        _ => equilibria::about(cohesion, 0.1),
    };
    let control = setting.control;
    let enough = |state: &ZoneState| match turn {
        Turn::Approach(approach) => state.approach >= approach,
        Turn::Force(force) => state.force >= force,
        Turn::Radius(radius) => state.contact_radius >= radius,
        Turn::Control(c) => control.value(state.approach, state.force) >= c,
    };
    let mut found = Equilibria::new(table, cohesion, reach, progress)?;
    found.grow(&enough, progress)?;
    on_equilibria(&mut found, setting, progress, &|course| {
        course.path(|course, known| course.whole(turn, known))
    })
}

/// The way down from the state with contact of the radius `start`, until the bodies are apart.
///
/// # Errors
/// As [`cycle_in_zone`], [`PathError::UnstableStart`] where nothing outward is stable.
pub fn unload_in_zone(
    table: &Arc<Table>,
    cohesion: Cohesion,
    start: f64,
    setting: &PathSetting<'_>,
    progress: &dyn Progress,
) -> Result<Path, PathError> {
    let mut found = Equilibria::new(table, cohesion, equilibria::about(cohesion, start), progress)?;
    found.grow(&|state| state.contact_radius >= start, progress)?;
    on_equilibria(&mut found, setting, progress, &|course| {
        course.path(|course, known| course.down(start, known))
    })
}

/// Why a path in a zone does not start.
#[derive(Debug)]
pub enum ZoneStartError {
    /// No state is the one that was asked for.
    Start(StartError),
    /// The equilibria cannot be found.
    Path(PathError),
}

impl<E: Into<PathError>> From<E> for ZoneStartError {
    fn from(error: E) -> Self {
        Self::Path(error.into())
    }
}

/// The contact radius of the largest state with contact at an approach or a force; for a start by radius, that radius.
///
/// # Errors
/// [`ZoneStartError`].
pub fn start_in_zone(
    table: &Arc<Table>,
    cohesion: Cohesion,
    start: Start,
    progress: &dyn Progress,
) -> Result<f64, ZoneStartError> {
    let (control, value, name) = match start {
        Start::ContactRadius(radius) => return Ok(radius),
        Start::Approach(approach) => (Control::Displacement, approach, "approach"),
        Start::Force(force) => (Control::Force, force, "force"),
    };
    // Further out than where the value is first taken, as far as a paraboloid would take it.
    let elastic = if control == Control::Force { cbrt(value.abs()) } else { value.abs().sqrt() };
    let outer = elastic.max(cbrt(cohesion.work()));
    let first = Cell::new(f64::INFINITY);
    let far_enough = |state: &ZoneState| {
        let rises = control.value(state.slopes[0], state.slopes[1]) > 0.0;
        if state.contact_radius > 0.0 && rises && control.value(state.approach, state.force) >= value {
            first.set(first.get().min(state.edge));
            return state.edge >= outer.min(FARTHER * first.get());
        }
        false
    };
    let mut found = Equilibria::new(table, cohesion, equilibria::about(cohesion, 0.1), progress)?;
    found.grow(&far_enough, progress)?;
    let solution = found.solution();
    let monotone = Monotone::of(&*solution, control);
    let crossings = monotone.crossings(&*solution, weighted(control, value, value));
    let radii = crossings.iter().rev().map(|(place, _)| solution.edges(*place).contact_radius);
    radii.into_iter().find(|radius| *radius > 0.0).ok_or_else(|| {
        // Contact begins at a touch, and may pull more further out.
        let ends = monotone.stretches.iter().flat_map(|stretch| [stretch.inner, stretch.outer]);
        let in_contact = ends.filter(|place| solution.edges(*place).contact_radius > 0.0);
        let touches = found.touches().iter().filter_map(|edge| solution.place(*edge));
        let values = in_contact.chain(touches).map(|place| monotone.value(&solution.at(place)));
        let (smallest, searched) = (values.fold(f64::INFINITY, f64::min), found.reach());
        ZoneStartError::Start(match found.zone.gap.largest_radius() {
            _ if value < smallest && smallest.is_finite() => StartError::OutOfReach { name, value, smallest },
            Some(known) => StartError::NotKnown { name, value, searched, known },
            None => StartError::NotReached { name, value, largest: searched },
        })
    })
}

/// A path on as much of the equilibria as it needs.
fn on_equilibria(
    found: &mut Equilibria,
    setting: &PathSetting<'_>,
    progress: &dyn Progress,
    path: &dyn Fn(Course<'_>) -> Result<Path, PathError>,
) -> Result<Path, PathError> {
    for _ in 0..TIMES {
        let solution = found.solution();
        let lane = Lane::on(&solution, setting.control, &|of| Arc::new(Monotone::of(&*solution, of)));
        let record = Record::new(setting, Direction::Loading, progress);
        match path(Course { equilibria: found, lane, setting, record, progress }) {
            Err(PathError::BeyondGap { .. }) if !found.is_whole() => {
                let reach = FURTHER * found.reach();
                found.grow(&|state| state.edge >= reach, progress)?;
            }
            // What lies beyond must be seen too.
            Err(PathError::Unseen { radius }) if found.look(radius, progress)? => {}
            Err(PathError::Unseen { .. }) => break,
            other => return other,
        }
    }
    let at = found.zone.state(found.reach(), None);
    Err(PathError::BeyondGap {
        radius: found.reach(),
        approach: at.map_or(f64::NAN, |state| state.approach),
        force: at.map_or(f64::NAN, |state| state.force),
    })
}

/// What is known about a path besides its states.
#[derive(Default)]
struct PathFacts {
    asked: Option<AskedState>,
    turn: Option<TurnReached>,
    work_of_loading: Option<f64>,
}

/// A path in a zone while it runs.
struct Course<'a> {
    equilibria: &'a Equilibria,
    lane: Lane,
    setting: &'a PathSetting<'a>,
    record: Record<'a>,
    progress: &'a dyn Progress,
}

impl Course<'_> {
    fn solution(&self) -> &dyn Solution {
        &*self.lane.solution
    }

    fn fault(&self, place: Place, ends: Ends) -> Result<Option<ZoneFault>, PathError> {
        fault(self.equilibria, self.solution(), place, ends, self.progress)
    }

    fn beyond(&self, place: Place, fault: Option<ZoneFault>) -> PathError {
        beyond(self.solution(), place, fault)
    }

    /// Adds the stable states between two places, as far as each is one disc in one zone; the first is known to be.
    ///
    /// # Errors
    /// [`PathError::BeyondZone`] with the first state that is not.
    fn follow(&mut self, [from, to]: [Place; 2]) -> Result<(), PathError> {
        let radius = |place| self.solution().radius(place);
        let ends = if radius(to) >= radius(from) { Ends::Outer } else { Ends::Inner };
        let passed = self.passed([from, to]);
        let mut last = from;
        for to in passed.into_iter().chain([to]) {
            let Some(mut fault) = self.fault(to, ends)? else {
                last = to;
                continue;
            };
            let (mut beyond, mut good, mut bad) = (to, radius(last), radius(to));
            // The fault appears only once on the way.
            for _ in 0..HALVINGS {
                let Some(place) = self.solution().place(0.5 * (good + bad)) else { break };
                if let Some(found) = self.fault(place, ends)? {
                    (beyond, bad, fault) = (place, radius(place), found);
                } else {
                    (last, good) = (place, radius(place));
                }
            }
            self.record.along(&self.lane, [from, last])?;
            return Err(self.beyond(beyond, Some(fault)));
        }
        self.record.along(&self.lane, [from, to])
    }

    /// The places between two, in order, at which the contact ends just beyond a corner, where the pull is strongest.
    fn passed(&self, [from, to]: [Place; 2]) -> Vec<Place> {
        let [begin, end] = [from, to].map(|place| self.solution().edges(place).contact_radius);
        let corners = self.equilibria.zone.corners().map(|corner| corner * (1.0 + BEYOND_CORNER));
        let between = corners.filter(|s| begin.min(end) < *s && *s < begin.max(end));
        let mut places: Vec<Place> = between.filter_map(|s| place_of(self.solution(), s)).collect();
        if end < begin {
            places.reverse();
        }
        places
    }

    /// Checks that what a jump lands on is one disc in one zone.
    ///
    /// What is passed need not be. Edges that run outward end in the least state above, and those of one zone run no
    /// further than all edges there may be: where they pass, all do, and the landing, a state, holds all. Inward the
    /// same is true with the greatest state below. That they pass is certain inward, where δ and P of a zone with any
    /// contact are no less than those of a disc; outward they may be larger by
    /// [`Zone::slack`](crate::zone::Zone::slack).
    fn lands(&self, before: Place, landing: Option<Landing>) -> Result<(), PathError> {
        let Some(landing) = landing else { return Ok(()) };
        if let Some(fault) = self.fault(landing.place, Ends::Both)? {
            return Err(self.beyond(landing.place, Some(fault)));
        }
        let Lane { solution, monotone, .. } = &self.lane;
        let radius = |place| solution.radius(place);
        let (from, to) = (radius(before), radius(landing.place));
        if to < from {
            return Ok(());
        }
        let value = monotone.value(&solution.at(landing.place));
        let even = (1..=PASSED).map(|k| from + (to - from) * f64::from(k) / f64::from(PASSED + 1));
        let highest = monotone.stretches.iter().map(|stretch| stretch.radii[1]);
        for edge in even.chain(highest.filter(|edge| from < *edge && *edge < to)) {
            let Some(place) = solution.place(edge) else { continue };
            let at = solution.at(place);
            let Equilibria { zone, ground, .. } = self.equilibria;
            let [approach, force] = zone.slack(ground, zone_at(&**solution, place));
            let most = Local { approach: at.approach + approach, force: at.force + force, ..at };
            if approach > 0.0 && monotone.value(&most) >= value {
                return Err(self.beyond(place, self.fault(place, Ends::Both)?));
            }
        }
        Ok(())
    }

    /// Where edges land that run from the outer end of a stretch at its value, or from bodies apart.
    fn outward(&self, stretch: usize, value: f64) -> Result<Landing, PathError> {
        let Lane { solution, monotone, .. } = &self.lane;
        let from = monotone.stretches[stretch].outer;
        let last = solution.at(from);
        match jump::run(&**solution, monotone, stretch, value, EdgeDirection::Outward) {
            Ok(Some(landing)) => Ok(landing),
            Ok(None) => Err(PathError::BeyondGap {
                radius: solution.reach(),
                approach: last.approach,
                force: last.force,
            }),
            Err(_) => Err(self.beyond(from, None)),
        }
    }

    /// A state to be recorded.
    fn state(&self, place: Place) -> PathState {
        self.record.disc(&self.lane, place)
    }

    /// From bodies apart into the first zone.
    fn jumped_in(&mut self) -> Result<Landing, PathError> {
        let begin = Place { panel: 0, x: -1.0 };
        let first =
            self.lane.monotone.stretches.first().ok_or(PathError::Lost { control_value: f64::NAN })?;
        if let Some(fault) = self.fault(begin, Ends::Outer)? {
            // A crest elsewhere comes within range first.
            return Err(self.beyond(begin, Some(fault)));
        }
        if first.rising {
            // The gap opens faster than the tension closes it: the zone grows from nothing.
            let after = self.state(begin);
            self.record.states.push(after.clone());
            self.record.continuous(EventKind::JumpIn, None, [None, Some(after)]);
            return Ok(Landing { place: begin, stretch: 0 });
        }
        // The first panel may begin outside the axis, where δ has changed already.
        let Lane { solution, monotone, .. } = &self.lane;
        let apart =
            Local { approach: -self.equilibria.zone.cohesion.range, force: 0.0, ..solution.at(begin) };
        let landing = self.outward(0, monotone.value(&apart))?;
        self.lands(begin, Some(landing))?;
        let after = self.state(landing.place);
        let touched = (after.contact_radius > 0.0).then_some(Passed { kind: PassedKind::Touch, radius: 0.0 });
        // A dead load of zero does no work.
        let control = match self.setting.control {
            Control::Force => Control::Displacement,
            other => other,
        };
        let by_area = (self.setting.losses == Losses::Twice)
            .then(|| energy::area(self.solution(), control, landing.place, None))
            .flatten();
        self.record.jump(
            EventKind::JumpIn,
            [None, Some(after)],
            None,
            by_area.map(|area| -area),
            touched.into_iter().collect(),
        );
        Ok(landing)
    }

    /// The path that `way` follows; it ends where a state is not one disc in one zone.
    fn path(
        mut self,
        way: impl FnOnce(&mut Self, &mut PathFacts) -> Result<PathStop, PathError>,
    ) -> Result<Path, PathError> {
        let mut known = PathFacts::default();
        let stop = match way(&mut self, &mut known) {
            Err(PathError::BeyondZone { kind, radius, approach, force })
                if !self.record.states.is_empty() =>
            {
                PathStop::BeyondZone { kind, radius, approach, force }
            }
            other => other?,
        };
        Ok(self.record.finished(known.asked, known.turn, known.work_of_loading, stop))
    }

    fn whole(&mut self, turn: Turn, known: &mut PathFacts) -> Result<PathStop, PathError> {
        let mut here = self.jumped_in()?;
        let at_turn = loop {
            let stretch = self.lane.monotone.stretches[here.stretch];
            let turned = self.lane.turns(turn, [here.place, stretch.outer]);
            let to = turned.unwrap_or(stretch.outer);
            self.follow([here.place, to])?;
            if turned.is_some() {
                break Landing { place: to, stretch: here.stretch };
            }
            let landing = self.outward(here.stretch, stretch.values[1])?;
            self.lands(to, Some(landing))?;
            self.record.ran(&self.lane, to, Some(landing));
            here = landing;
        };
        let state = self.state(at_turn.place);
        let reached = match turn {
            Turn::Approach(_) => state.approach,
            Turn::Force(_) => state.force,
            Turn::Radius(_) => state.contact_radius,
            Turn::Control(_) => state.control_value,
        };
        known.turn = Some(TurnReached { asked: turn, reached });
        known.work_of_loading = self.record.turned(state, None);
        self.descend(at_turn)
    }

    /// The way down of a stable state that is already recorded, until the bodies are apart.
    fn descend(&mut self, from: Landing) -> Result<PathStop, PathError> {
        let Lane { solution, monotone, .. } = &self.lane;
        let way = descend(&**solution, monotone, from, 0.0);
        let mut jumps = way.jumps.iter();
        for piece in &way.pieces {
            self.follow(*piece)?;
            if let Some(jump) = jumps.next() {
                self.lands(jump.before, jump.landing)?;
                self.record.ran(&self.lane, jump.before, jump.landing);
            }
        }
        if way.hole.is_some() {
            let last = way.pieces.last().map_or(from.place, |piece| piece[1]);
            return Err(self.beyond(last, None));
        }
        let Some(last) = self.record.states.last().cloned() else { return Ok(PathStop::End) };
        if !way.pulls_off() {
            // The zone shrinks to nothing.
            self.record.continuous(EventKind::SnapOff, None, [Some(last), None]);
        }
        Ok(PathStop::Apart)
    }

    fn down(&mut self, start: f64, known: &mut PathFacts) -> Result<PathStop, PathError> {
        let solution = Arc::clone(&self.lane.solution);
        let beyond = PathError::BeyondGap { radius: solution.reach(), approach: f64::NAN, force: f64::NAN };
        let asked_at = place_of(&*solution, start).ok_or(beyond)?;
        let edge = solution.radius(asked_at);
        let here = if let Some(here) = stable_start(&*solution, &self.lane.monotone, edge) {
            here
        } else {
            let at = solution.at(asked_at);
            let stretch = self.lane.monotone.stretch_of(edge);
            let landing = self.outward(stretch, self.lane.monotone.value(&at))?;
            let state = State {
                contact_radius: start,
                approach: at.approach,
                force: at.force,
                energy: solution.energy(asked_at),
            };
            // Outward from a falling stretch, the first crossing is the landing.
            known.asked = Some(AskedState { state, why: WhyNot::Unstable { falls: true } });
            landing
        };
        self.lands(asked_at, Some(here))?;
        self.record.direction = Direction::Unloading;
        let first = self.state(here.place);
        self.record.begun(first);
        self.descend(here)
    }
}
