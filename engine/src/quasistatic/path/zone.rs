//! A path of adhesion with a range: from bodies apart over the jump into a zone to the turn and back, along one disc in one zone.
//!
//! Every stable stretch is held to what one disc in one zone is ([`Zone::fault`](crate::zone::Zone::fault)), and every jump at places between its ends: a path
//! that comes to a state with more ends there in an error that names it.

use super::error::PathError;
use super::event::{Direction, Event, EventKind, Passed, PassedKind, PathState};
use super::lane::Lane;
use super::record::Record;
use super::setting::{Asked, Path, PathStop, Setting, TurnReached, WhyNot};
use crate::disc::{Place, Solution, Table};
use crate::problem::{Cohesion, Control, Start, Turn};
use crate::progress::Progress;
use crate::quasistatic::descent::{descend, stable_start};
use crate::quasistatic::energy::{self, Losses};
use crate::quasistatic::equilibrium::State;
use crate::quasistatic::jump::{self, Landing, Run};
use crate::quasistatic::monotone::{Monotone, weighted};
use crate::zone::{Ends, Equilibria, Fault, FaultKind, ZoneAt, ZoneState, equilibria};
use std::sync::Arc;

/// Times that the equilibria are grown for a path.
const TIMES: usize = 40;

/// How much further each time.
const FURTHER: f64 = 1.3;

/// Places between the ends of a jump that are looked at.
const PASSED: u32 = 6;

/// Halvings by which the first state with a fault is found.
const HALVINGS: usize = 24;

/// Halvings of a place with a given contact radius.
const OF_RADIUS: usize = 80;

/// The loop of the gap of `table` with adhesion that has a range (E* = 1): from apart to the turn and back until the bodies are apart.
///
/// # Errors
/// [`PathError`]; [`PathError::BeyondZone`] where one disc in one zone is not all of a state.
pub fn cycle_in_zone(
    table: &Arc<Table>,
    cohesion: Cohesion,
    turn: Turn,
    setting: &Setting<'_>,
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
    let measured_by_control = matches!(
        (turn, setting.control),
        (Turn::Control(_), _) | (Turn::Approach(_), Control::Displacement) | (Turn::Force(_), Control::Force)
    );
    if measured_by_control && turn.value() < apart {
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
    on_equilibria(&mut found, setting, progress, &|course| course.whole(turn))
}

/// The way down from the state with contact of the radius `start`, until the bodies are apart.
///
/// # Errors
/// As [`cycle_in_zone`], [`PathError::UnstableStart`] where nothing outward is stable.
pub fn unload_in_zone(
    table: &Arc<Table>,
    cohesion: Cohesion,
    start: f64,
    setting: &Setting<'_>,
    progress: &dyn Progress,
) -> Result<Path, PathError> {
    let mut found = Equilibria::new(table, cohesion, equilibria::about(cohesion, start), progress)?;
    found.grow(&|state| state.contact_radius >= start, progress)?;
    on_equilibria(&mut found, setting, progress, &|course| course.down(start))
}

/// The contact radius of the largest state in equilibrium at an approach or a force; that of a start by radius itself.
///
/// # Errors
/// [`PathError`] where there is none.
pub fn start_in_zone(
    table: &Arc<Table>,
    cohesion: Cohesion,
    start: Start,
    progress: &dyn Progress,
) -> Result<f64, PathError> {
    let (control, value) = match start {
        Start::ContactRadius(radius) => return Ok(radius),
        Start::Approach(approach) => (Control::Displacement, approach),
        Start::Force(force) => (Control::Force, force),
    };
    let mut found = Equilibria::new(table, cohesion, equilibria::about(cohesion, 0.1), progress)?;
    let of = |state: &ZoneState| control.value(state.approach, state.force);
    found.grow(&|state| state.contact_radius > 0.0 && of(state) >= value, progress)?;
    let solution = found.solution();
    let monotone = Monotone::of(&*solution, control);
    let crossings = monotone.crossings(&*solution, weighted(control, value, value));
    let last = crossings.last().map(|(place, _)| solution.edges(*place).contact_radius);
    last.filter(|radius| *radius > 0.0).ok_or(PathError::Lost { control_value: value })
}

/// A path on as much of the equilibria as it needs.
fn on_equilibria(
    found: &mut Equilibria,
    setting: &Setting<'_>,
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
            // What lies beyond is to be seen too.
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

/// Equilibria of one disc in one zone as far out as they are known, and what may lie beside them.
#[derive(Debug)]
pub struct Zones {
    equilibria: Equilibria,
    /// The equilibria over the outer edge of the zone.
    pub solution: Arc<dyn Solution>,
    /// The outermost place with contact of the radius that was asked for.
    pub start: Place,
}

impl Zones {
    /// Those up to contact of the radius `s`.
    ///
    /// # Errors
    /// [`PathError`] where there is no such contact.
    pub fn up_to(
        table: &Arc<Table>,
        cohesion: Cohesion,
        s: f64,
        progress: &dyn Progress,
    ) -> Result<Self, PathError> {
        let mut equilibria = Equilibria::new(table, cohesion, equilibria::about(cohesion, s), progress)?;
        equilibria.grow(&|state| state.contact_radius >= s, progress)?;
        let solution = equilibria.solution();
        let radius = equilibria.reach();
        let beyond = PathError::BeyondGap { radius, approach: f64::NAN, force: f64::NAN };
        let start = place_of(&*solution, s).ok_or(beyond)?;
        Ok(Self { equilibria, solution, start })
    }

    /// The error of the state at a place that is not one disc in one zone; `None` where it is.
    ///
    /// # Errors
    /// [`PathError`] where that cannot be known.
    pub fn fault(&self, place: Place, progress: &dyn Progress) -> Result<Option<PathError>, PathError> {
        let found = fault(&self.equilibria, &*self.solution, place, Ends::Both, progress)?;
        Ok(found.map(|found| beyond(&*self.solution, place, Some(found))))
    }

    /// ds/dc at a place: the edge of the disc follows that of its zone as ω does, which vanishes there.
    #[must_use]
    pub fn contact_slope(&self, place: Place) -> f64 {
        let ZoneAt { edge, contact_radius, .. } = zone_at(&*self.solution, place);
        let zone = &self.equilibria.zone;
        let pull = 2.0 * zone.cohesion.strength / ((edge - contact_radius) * (edge + contact_radius)).sqrt();
        let slope = self.solution.at(place).stability().approach;
        let rise = zone.panels.values(zone.panels.place(contact_radius)).slope;
        (slope + pull * edge) / (rise + pull * contact_radius)
    }
}

/// The state at a place.
fn zone_at(solution: &dyn Solution, place: Place) -> ZoneAt {
    let (state, edges) = (solution.at(place), solution.edges(place));
    ZoneAt {
        edge: edges.zone.unwrap_or(edges.contact_radius),
        contact_radius: edges.contact_radius,
        approach: state.approach,
    }
}

/// What a state is beside one disc in one zone, where it is more.
fn fault(
    Equilibria { zone, ground, .. }: &Equilibria,
    solution: &dyn Solution,
    place: Place,
    ends: Ends,
    progress: &dyn Progress,
) -> Result<Option<Fault>, PathError> {
    if progress.stop() {
        return Err(PathError::Cancelled);
    }
    let at = zone_at(solution, place);
    if at.edge <= 0.0 {
        return Ok(None);
    }
    let radius = zone.sees(ground, at);
    if radius >= ground.reach() && ground.reach() < ground.table.end() * (1.0 - 1e-9) {
        return Err(PathError::Unseen { radius: FURTHER * radius });
    }
    Ok(zone.fault(ground, at, ends))
}

/// The error of a state that is not one disc in one zone.
fn beyond(solution: &dyn Solution, place: Place, fault: Option<Fault>) -> PathError {
    let at = solution.at(place);
    let radius = fault.map_or(at.contact_radius, |fault| fault.radius);
    let kind = fault.map(|fault| fault.kind);
    PathError::BeyondZone { kind, radius, approach: at.approach, force: at.force }
}

/// The place of the outermost zone with contact of the radius `s`.
fn place_of(solution: &dyn Solution, s: f64) -> Option<Place> {
    let contact = |c: f64| solution.place(c).map(|place| solution.edges(place).contact_radius);
    let (mut lo, mut hi) = (s, solution.reach());
    if contact(hi)? < s {
        return None;
    }
    for _ in 0..OF_RADIUS {
        let middle = 0.5 * (lo + hi);
        if contact(middle).is_some_and(|found| found >= s) { hi = middle } else { lo = middle }
    }
    solution.place(hi)
}

/// A path in a zone while it runs.
struct Course<'a> {
    equilibria: &'a Equilibria,
    lane: Lane,
    setting: &'a Setting<'a>,
    record: Record<'a>,
    progress: &'a dyn Progress,
}

impl Course<'_> {
    fn solution(&self) -> &dyn Solution {
        &*self.lane.solution
    }

    fn fault(&self, place: Place, ends: Ends) -> Result<Option<Fault>, PathError> {
        fault(self.equilibria, self.solution(), place, ends, self.progress)
    }

    fn beyond(&self, place: Place, fault: Option<Fault>) -> PathError {
        beyond(self.solution(), place, fault)
    }

    /// Holds a stable stretch between two places, `to` further out, to what one disc in one zone is.
    fn whole_between(&self, [from, to]: [Place; 2]) -> Result<(), PathError> {
        for (end, other, ends) in [(to, from, Ends::Outer), (from, to, Ends::Inner)] {
            if self.fault(end, ends)?.is_some() {
                // The fault appears once on the way from the other end.
                let radius = |place| self.solution().at(place).contact_radius;
                let (mut good, mut bad) = (radius(other), radius(end));
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (good + bad);
                    let Some(place) = self.solution().place(middle) else { break };
                    if self.fault(place, ends)?.is_some() { bad = middle } else { good = middle }
                }
                let place = self.solution().place(bad).unwrap_or(end);
                return Err(self.beyond(place, self.fault(place, ends)?));
            }
        }
        Ok(())
    }

    /// The same of what a jump passes.
    fn passes(&self, before: Place, after: Option<Place>) -> Result<(), PathError> {
        let radius = |place| self.solution().at(place).contact_radius;
        let (from, to) = (radius(before), after.map_or(0.0, radius));
        for k in 1..=PASSED {
            let edge = from + (to - from) * f64::from(k) / f64::from(PASSED + 1);
            let Some(place) = self.solution().place(edge) else { return Err(self.beyond(before, None)) };
            if let Some(fault) = self.fault(place, Ends::Both)? {
                return Err(self.beyond(place, Some(fault)));
            }
        }
        Ok(())
    }

    /// Where edges run from the outer end of a stretch at its value, or from bodies apart.
    fn outward(&self, stretch: usize, value: f64) -> Result<Landing, PathError> {
        let Lane { solution, monotone, .. } = &self.lane;
        let from = monotone.stretches[stretch].outer;
        let last = solution.at(from);
        match jump::run(&**solution, monotone, stretch, value, Run::Outward) {
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

    /// From apart into the first zone.
    fn jumped_in(&mut self) -> Result<Landing, PathError> {
        let begin = Place { panel: 0, x: -1.0 };
        let first =
            self.lane.monotone.stretches.first().ok_or(PathError::Lost { control_value: f64::NAN })?;
        if first.rising {
            // The gap opens faster than the tension closes it: the zone grows from nothing.
            let after = self.state(begin);
            self.record.states.push(after.clone());
            self.record.continuous(EventKind::JumpIn, None, [None, Some(after)]);
            return Ok(Landing { place: begin, stretch: 0 });
        }
        let value = first.values[0];
        let landing = self.outward(0, value)?;
        self.passes(begin, Some(landing.place))?;
        let after = self.state(landing.place);
        let touched = (after.contact_radius > 0.0).then_some(Passed { kind: PassedKind::Touch, radius: 0.0 });
        // A dead load of nothing does no work.
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

    fn whole(mut self, turn: Turn) -> Result<Path, PathError> {
        let mut here = self.jumped_in()?;
        let at_turn = loop {
            let stretch = self.lane.monotone.stretches[here.stretch];
            let turned = self.lane.turns(turn, [here.place, stretch.outer]);
            let to = turned.unwrap_or(stretch.outer);
            self.whole_between([here.place, to])?;
            self.record.along(&self.lane, [here.place, to])?;
            if turned.is_some() {
                break Landing { place: to, stretch: here.stretch };
            }
            let landing = self.outward(here.stretch, stretch.values[1])?;
            self.passes(to, Some(landing.place))?;
            let event = Event::of_disc(
                self.solution(),
                self.setting.control,
                to,
                Some(landing.place),
                self.setting.losses,
            );
            self.record.jumped(event);
            here = landing;
        };
        let state = self.state(at_turn.place);
        let reached = match turn {
            Turn::Approach(_) => state.approach,
            Turn::Force(_) => state.force,
            Turn::Radius(_) => state.contact_radius,
            Turn::Control(_) => state.control_value,
        };
        let potential = match self.setting.control {
            Control::Force => state.energy,
            control => state.potential(control),
        };
        let work_of_loading = self.record.lost().map(|lost| potential + lost);
        self.record.turned(state, None);
        let stop = self.descend(at_turn)?;
        Ok(self.record.finished(None, Some(TurnReached { asked: turn, reached }), work_of_loading, stop))
    }

    /// The way down of a stable state that is recorded, until the bodies are apart.
    fn descend(&mut self, from: Landing) -> Result<PathStop, PathError> {
        let Lane { solution, monotone, .. } = &self.lane;
        let way = descend(&**solution, monotone, from, 0.0);
        let mut jumps = way.jumps.iter();
        for piece in &way.pieces {
            self.whole_between([piece[1], piece[0]])?;
            if let Some(jump) = jumps.next() {
                self.passes(jump.before, jump.landing.map(|landing| landing.place))?;
            }
        }
        if way.hole.is_some() {
            let last = way.pieces.last().map_or(from.place, |piece| piece[1]);
            return Err(self.beyond(last, None));
        }
        let pulls_off = way.pulls_off();
        self.record.descend(&self.lane, from, 0.0)?;
        let Some(last) = self.record.states.last().cloned() else { return Ok(PathStop::End) };
        if pulls_off {
            return Ok(PathStop::Apart);
        }
        // The zone shrinks to nothing.
        self.record.continuous(EventKind::SnapOff, None, [Some(last), None]);
        Ok(PathStop::Apart)
    }

    fn down(mut self, start: f64) -> Result<Path, PathError> {
        let solution = Arc::clone(&self.lane.solution);
        let beyond = PathError::BeyondGap { radius: solution.reach(), approach: f64::NAN, force: f64::NAN };
        let asked_at = place_of(&*solution, start).ok_or(beyond)?;
        let edge = solution.at(asked_at).contact_radius;
        let mut asked = None;
        let here = if let Some(here) = stable_start(&*solution, &self.lane.monotone, edge) {
            here
        } else {
            let at = solution.at(asked_at);
            let stretch = self.lane.monotone.stretch_of(edge);
            let landing = self.outward(stretch, self.lane.monotone.value(&at))?;
            self.passes(asked_at, Some(landing.place))?;
            let state = State {
                contact_radius: start,
                approach: at.approach,
                force: at.force,
                energy: solution.energy(asked_at),
            };
            // From a falling stretch outward the first crossing is the landing.
            asked = Some(Asked { state, why: WhyNot::Unstable { falls: true } });
            landing
        };
        self.record.direction = Direction::Unloading;
        let first = self.state(here.place);
        self.record.begun(first);
        let stop = self.descend(here)?;
        Ok(self.record.finished(asked, None, None, stop))
    }
}

impl FaultKind {
    /// What is wrong, with the radius as it is shown.
    pub(super) fn words(self, radius: &str) -> String {
        match self {
            Self::SecondZone => format!("a second zone forms at r = {radius}"),
            Self::Touches => format!("the bodies touch in the zone at r = {radius}"),
            Self::Opens => format!("the zone opens inside at r = {radius}"),
            Self::Torn => format!("the contact is torn inside at r = {radius}"),
        }
    }
}
