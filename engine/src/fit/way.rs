//! The ways of a device along a curve with snaps, leg by leg: up from the first touch, or down from where it turned round.

use super::track::Track;
use crate::disc::{Local, Place, Solution};
use crate::problem::Control;
use crate::quasistatic::Monotone;
use crate::quasistatic::ascent::{Rise, ascend};
use crate::quasistatic::descent::{descend, stable_start};
use crate::quasistatic::jump::{self, EdgeDirection, Landing};

/// Which way the device goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// Up from the first touch until the points are reached.
    Up,
    /// Down from the state in which the points begin: several states can have one way of the device.
    Down,
    /// Up to the end of the track, where the edge is then pinned.
    UpToPinned,
    /// Down from the end of the track, where the edge was pinned.
    DownFromPinned,
}

/// What the points say about a way.
pub struct WayEvidence<'a> {
    /// x of a state.
    pub x_of: &'a dyn Fn(&Local) -> f64,
    /// The largest x.
    pub most: f64,
    /// x and the reduced force where the way down begins.
    pub turn: [f64; 2],
}

/// A part of a way, by its ends, the outer first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Leg {
    /// Along equilibria.
    Along([Place; 2]),
    /// A jump between them.
    Jump([Place; 2]),
}

/// A curve that does not reach far enough is made longer by this factor, this many times at most.
const LONGER: f64 = 1.1;
const TIMES: usize = 8;

/// The legs of the way under `control`, running inward. `track` is made longer where its end is not stable. Empty where there is no
/// such way.
///
/// The stable legs are followed by the unstable stretch at the end nearer to the axis, so that a point just beyond a
/// pull-off or a first touch has a curve on both sides.
pub(super) fn legs(track: &mut Track, control: Control, way: Way, seen: &WayEvidence<'_>) -> Vec<Leg> {
    for _ in 0..TIMES {
        let (Some(solution), Some(monotone)) = (track.solution(), track.monotone(control)) else { break };
        let found = match way {
            Way::Up => up(seen, solution, &monotone),
            Way::UpToPinned => return up_to(track.ends()[0], solution, &monotone).unwrap_or_default(),
            Way::DownFromPinned => return down_from(track.ends(), solution, &monotone).unwrap_or_default(),
            Way::Down => turned(seen, solution, &monotone)
                .or_else(|| stable_start(solution, &monotone, solution.reach()))
                .map(|start| down(solution, &monotone, start, track.ends()[1])),
        };
        if let Some(found) = found {
            return found;
        }
        if !track.longer(LONGER) {
            break;
        }
    }
    Vec::new()
}

/// The outer end of the stable stretch on which the points begin: of those with a state at their x, the one whose force
/// is nearest.
fn turned(seen: &WayEvidence<'_>, solution: &dyn Solution, monotone: &Monotone) -> Option<Landing> {
    const HALVINGS: usize = 50;
    let [x, force] = seen.turn;
    let mut best: Option<(f64, Landing)> = None;
    for (number, stretch) in monotone.stretches.iter().enumerate() {
        let ends = [stretch.inner, stretch.outer].map(|place| (seen.x_of)(&solution.at(place)));
        if !(stretch.rising && (ends[0]..=ends[1]).contains(&x)) {
            continue;
        }
        let [mut lo, mut hi] = stretch.radii;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (lo + hi);
            if (seen.x_of)(&solution.at(solution.place(middle)?)) > x { hi = middle } else { lo = middle }
        }
        let off = (solution.at(solution.place(lo)?).force - force).abs();
        if best.is_none_or(|best| off < best.0) {
            best = Some((off, Landing { place: stretch.outer, stretch: number }));
        }
    }
    best.map(|(_, landing)| landing)
}

/// The way up, where it goes far enough.
fn up(seen: &WayEvidence<'_>, solution: &dyn Solution, monotone: &Monotone) -> Option<Vec<Leg>> {
    let enough = |at: &Local| (seen.x_of)(at) >= seen.most;
    let rises = ascend(solution, monotone, 0.0, &enough);
    rises.last().filter(|last| enough(&solution.at(last.end)))?;
    Some(legs_of(&rises, monotone))
}

/// The way up to where the track ends, if it gets there.
fn up_to(end: f64, solution: &dyn Solution, monotone: &Monotone) -> Option<Vec<Leg>> {
    let last = monotone.stretch_of(end);
    let mut rises = ascend(solution, monotone, 0.0, &|at| at.contact_radius >= end);
    let reached = rises.last_mut().filter(|rise| rise.landing.stretch == last)?;
    reached.end = solution.place(end).filter(|_| solution.radius(reached.landing.place) < end)?;
    Some(legs_of(&rises, monotone))
}

/// The way down from where the track ends; if no state there is stable, the edge runs as soon as it is not pinned.
fn down_from([end, innermost]: [f64; 2], solution: &dyn Solution, monotone: &Monotone) -> Option<Vec<Leg>> {
    let (stretch, place) = (monotone.stretch_of(end), solution.place(end)?);
    if monotone.stretches.get(stretch)?.rising {
        return Some(down(solution, monotone, Landing { place, stretch }, innermost));
    }
    let value = monotone.value(&solution.at(place));
    let landing = jump::run(solution, monotone, stretch, value, EdgeDirection::Inward).ok().flatten()?;
    let mut legs = vec![Leg::Jump([place, landing.place])];
    legs.extend(down(solution, monotone, landing, innermost));
    Some(legs)
}

/// The legs of these stable pieces and of the jumps between them.
fn legs_of(rises: &[Rise], monotone: &Monotone) -> Vec<Leg> {
    let stretches = &monotone.stretches;
    let mut legs = Vec::new();
    for (i, Rise { landing, end }) in rises.iter().enumerate().rev() {
        if let Some(before) = i.checked_sub(1).and_then(|before| rises.get(before)) {
            legs.push(Leg::Along([*end, landing.place]));
            legs.push(Leg::Jump([landing.place, before.end]));
        } else {
            legs.push(Leg::Along([*end, stretches[landing.stretch].inner]));
            let unstable = landing.stretch.checked_sub(1).map(|inner| stretches[inner]);
            legs.extend(unstable.map(|stretch| Leg::Along([stretch.outer, stretch.inner])));
        }
    }
    legs
}

fn down(solution: &dyn Solution, monotone: &Monotone, from: Landing, innermost: f64) -> Vec<Leg> {
    let stretches = &monotone.stretches;
    let descent = descend(solution, monotone, from, innermost);
    let mut legs = Vec::new();
    for (i, piece) in descent.pieces.iter().enumerate() {
        legs.push(Leg::Along(*piece));
        match descent.jumps.get(i) {
            Some(jump) => match (jump.landing, jump.stretch.checked_sub(1)) {
                (Some(landing), _) => legs.push(Leg::Jump([jump.before, landing.place])),
                (None, Some(inner)) => legs.push(Leg::Along([jump.before, stretches[inner].inner])),
                (None, None) => {}
            },
            None => break,
        }
    }
    legs
}
