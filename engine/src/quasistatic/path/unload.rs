//! The way down: from a disc inward, through every snap, until the bodies are apart.
//!
//! On the way down gaps open: contact that shrinks anywhere takes load off what lies outside. So a path that starts
//! with one disc without overlap stays one disc. Where a crest outside would overlap at the start, the contact first
//! grows at the held control to the least equilibrium that contains it, as a loading path does at a touch, and unloads
//! from there. Deep inside an overlap no equilibrium contains it, because the contact that presses outside opens the
//! disc. The path then starts from the contact that loading from bodies apart reaches at this control; where both
//! contacts are found, they are the same. Without adhesion contact has no memory: the way down is that of the loop.

use super::balance::{Balance, HeldEdges};
use super::course::{Course, at_least, balance, cycle_on, highest, lane, on_ground};
use super::error::PathError;
use super::event::{Direction, EventKind, PathState};
use super::lane::Lane;
use super::record::{Record, stop_of};
use super::setting::{AskedState, Path, PathSetting, WhyNot};
use crate::annuli::{Contacts, Ground, points};
use crate::problem::{ContactKind, Control, Turn};
use crate::progress::Progress;
use crate::quasistatic::admissible::falls;
use crate::quasistatic::curve::Curve;
use crate::quasistatic::descent::stable_start;
use crate::quasistatic::equilibrium::State;
use crate::quasistatic::jump::{self, EdgeDirection, Landing};
use crate::quasistatic::landscape;

/// How far outward a stable state is looked for, as a multiple of the start radius.
const OUTWARD_REACH: f64 = 1000.0;

/// How far beyond the start the table for rings reaches at first.
const BEYOND: f64 = 1.3;
/// A start that differs by no more than this share is the one asked for.
const SAME: f64 = 1e-9;

/// Unloads along `curve`, from its outermost state down to its innermost.
///
/// # Errors
/// [`PathError::UnstableStart`] when the start is unstable and no stable state lies outward, [`PathError::Stopped`] when `progress`
/// said stop, others where contact in rings cannot be followed.
pub fn unload(curve: &Curve, setting: &PathSetting<'_>, progress: &dyn Progress) -> Result<Path, PathError> {
    let control = setting.control;
    let (from, to) = (curve.outermost(), curve.innermost());
    let receding = curve;
    let gamma = curve.equilibrium.problem.work_of_adhesion;
    let growing = match setting.closing_below(gamma) {
        Some(closing) => {
            let none = PathError::UnstableStart { contact_radius: from, searched: from, falls: false };
            Some(curve.under(closing, progress)?.ok_or(none)?)
        }
        None => None,
    };
    // The contact at the start got there by growing.
    let curve = growing.as_ref().unwrap_or(curve);
    let mut longer = None;
    let asked = curve.solution.place(from).map(|place| curve.state(place));
    let here = if let Some(start) = stable_start(&*curve.solution, &curve.monotone(control), from) {
        start
    } else {
        run_outward(longer.insert(curve.clone()), control, from, progress)?
    };
    let curve = longer.as_ref().unwrap_or(curve);
    let start = curve.state(here.place);
    let asked = asked.filter(|_| start.contact_radius > from * (1.0 + SAME)).map(|state| {
        let value = control.value(state.approach, state.force);
        let falls = landscape::falls(curve, control, value, from, start.contact_radius);
        AskedState { state, why: WhyNot::Unstable { falls } }
    });
    if setting.contact == ContactKind::Rings {
        let fault = fault(curve, start.contact_radius, progress);
        let problem = &curve.equilibrium.problem;
        let splits = problem.work_of_adhesion == 0.0 && falls(&*problem.gap, start.contact_radius);
        if fault.is_some() || splits {
            let asked = asked.or(fault.map(|why| AskedState { state: start, why }));
            return with_rings(curve, gamma, setting, &start, asked, progress);
        }
    }
    let lane = Lane::of(curve, control);
    let mut record = Record::new(setting, Direction::Unloading, progress);
    let first = record.disc(&lane, here.place);
    if growing.is_some() {
        let mut receding = receding.clone();
        receding.reach(start.contact_radius);
        let lane = Lane::of(&receding, control);
        record.begun(opening(first, gamma - curve.equilibrium.problem.work_of_adhesion));
        let stop = record.released(&lane, start.contact_radius, to)?;
        return Ok(record.finished(asked, None, None, stop));
    }
    record.begun(first);
    let descent = record.descend(&lane, here, to)?;
    progress.go_on()?;
    Ok(record.finished(asked, None, None, stop_of(&descent)))
}

/// A state as it opens, where opening costs `more` than closing gained.
fn opening(state: PathState, more: f64) -> PathState {
    PathState { energy: state.energy - more * state.contact_area, ..state }
}

/// Why a disc in equilibrium is not the whole contact; `None` where it is.
fn fault(curve: &Curve, s: f64, progress: &dyn Progress) -> Option<WhyNot> {
    let point = curve.equilibrium.explicit(s)?;
    let [delta, _, s] = curve.equilibrium.quantities(point.y());
    let judge = curve.equilibrium.judge();
    // A verdict is fast, but names any crest that overlaps, not the nearest one.
    if judge.verdict(s, delta, progress).holds {
        return None;
    }
    let found = judge.judge(s, delta, progress);
    let overlap = found.nearest.filter(|crest| crest.gap < 0.0).map(|crest| WhyNot::Overlaps(crest.radius));
    overlap.or(found.least_pressure.map(|(radius, _)| WhyNot::Pulls(radius)))
}

/// The way down, at the work of adhesion `to_open`, from a disc beside which there is more contact.
fn with_rings(
    curve: &Curve,
    to_open: f64,
    setting: &PathSetting<'_>,
    start: &State,
    asked: Option<AskedState>,
    progress: &dyn Progress,
) -> Result<Path, PathError> {
    let (control, to) = (setting.control, curve.innermost());
    let value = control.value(start.approach, start.force);
    let equilibrium = &curve.equilibrium;
    let gamma = equilibrium.problem.work_of_adhesion;
    let far_enough = |ground: &Ground| BEYOND * ground.can_touch_up_to(start.approach) <= ground.reach();
    let down = |ground: &Ground| {
        if gamma == 0.0 {
            let whole = cycle_on(ground, gamma, Turn::Control(value), setting, progress)?;
            return Ok(Path { asked, ..way_back(whole) });
        }
        let lane = lane(ground, gamma, control, progress)?;
        let balance = balance(ground, gamma, setting, lane.as_ref(), progress);
        let held = match grown(&balance, setting, start.contact_radius, value) {
            // The bodies press at the crest and open the disc, so no equilibrium contains it. Loading from bodies
            // apart finds the one there is.
            Err(lost @ PathError::NoLanding { .. }) => {
                let turn = Some(Turn::Control(value));
                let mut up = Course { turn, ..Course::new(&balance, setting, Direction::Loading) };
                match up.first_crest() {
                    Ok((crest, first)) => up.loaded(crest, first)?,
                    Err(PathError::TurnBeforeTouch { .. }) => return Err(lost),
                    Err(error) => return Err(error),
                }
            }
            found => found?,
        };
        let mut course = Course { end: to, ..Course::new(&balance, setting, Direction::Unloading) };
        let first = course.state(&held);
        course.record.begun(opening(first, to_open - gamma));
        course.down(held, to_open, &|record, stop| record.finished(asked, None, None, stop))
    };
    let reach = at_least(&equilibrium.table, BEYOND * start.contact_radius);
    on_ground(&equilibrium.table, reach, &far_enough, progress, &down, &highest)
}

/// The contact that grows at the held control from a disc beside which bodies overlap.
fn grown(
    balance: &Balance<'_>,
    setting: &PathSetting<'_>,
    s: f64,
    value: f64,
) -> Result<HeldEdges, PathError> {
    let disc = Contacts::of_disc(s);
    let held = balance.held(&disc, &points(balance.ground, &disc), value)?;
    let mut passed = Vec::new();
    let Some(seeded) = balance.touched(&held, value, &mut passed)? else { return Ok(held) };
    let landed = balance.run(seeded, value, 1.0, setting.mobility, &mut passed)?;
    landed.ok_or(PathError::Lost { control_value: value })
}

/// The way down of a loop in which nothing is lost.
fn way_back(mut whole: Path) -> Path {
    let turn = whole.events.iter().position(|event| event.kind == EventKind::Turn);
    whole.events.drain(..turn.map_or(0, |at| at + 1));
    whole.states.retain(|state| state.direction == Direction::Unloading);
    let first = whole.states.first().map_or(0, |state| state.piece);
    let counted = |state: &mut PathState| state.piece -= first;
    whole.states.iter_mut().for_each(counted);
    let ends =
        |event: &mut super::event::Event| event.before.iter_mut().chain(&mut event.after).for_each(counted);
    whole.events.iter_mut().for_each(ends);
    (whole.turn, whole.totals.work_of_loading) = (None, None);
    whole
}

/// Runs from an unstable start outward, at constant control, to the next stable state; `curve` then reaches that far.
fn run_outward(
    curve: &mut Curve,
    control: Control,
    from: f64,
    progress: &dyn Progress,
) -> Result<Landing, PathError> {
    let limit = (OUTWARD_REACH * from).min(curve.equilibrium.problem.largest_contact().max(from));
    let mut reach = from;
    loop {
        reach = (1.5 * reach).min(limit);
        curve.reach_while(reach, progress)?;
        // The start may be at a limit point that lay beyond the curve before.
        let monotone = curve.monotone(control);
        if let Some(start) = stable_start(&*curve.solution, &monotone, from) {
            return Ok(start);
        }
        let stretch = monotone.stretch_of(from);
        let value =
            curve.solution.place(from).map_or(f64::NAN, |place| monotone.value(&curve.solution.at(place)));
        if let Ok(Some(landing)) =
            jump::run(&*curve.solution, &monotone, stretch, value, EdgeDirection::Outward)
        {
            return Ok(landing);
        }
        if reach >= limit {
            let gap = &curve.equilibrium.problem.gap;
            let falls = gap.jet(reach).value < gap.jet(0.0).value;
            return Err(PathError::UnstableStart { contact_radius: from, searched: reach, falls });
        }
    }
}
