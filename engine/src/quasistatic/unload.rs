//! The whole unloading: from the start state inward, through every snap, to the pull-off.

use super::curve::{Curve, CurveStop};
use super::descent::{descend, stable_start};
use super::energy;
use super::equilibrium::State;
use super::jump::{self, Landing, Run};
use super::landscape;
use super::monotone::weighted;
use crate::disc::{Local, Place};
use crate::problem::{Control, Units};
use crate::progress::{Progress, Unwatched};
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};
use std::fmt;

/// What happened at an instability.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// The edge ran to another stable state.
    Snap,
    /// The bodies came apart.
    PullOff,
}

/// How often the loss of a jump is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Losses {
    /// Once, by the drop of the potential.
    Once,
    /// By the area under the curve as well, which costs far more: two independent numbers that must agree.
    Twice,
}

/// One instability of a path.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// Snap or pull-off.
    pub kind: EventKind,
    /// The controlled quantity at which it happens.
    pub control_value: f64,
    /// The limit point.
    pub before: State,
    /// The landing; `None` after a pull-off.
    pub after: Option<State>,
    /// Energy lost, by the drop of the potential; `None` for a pull-off under a dead load.
    pub dissipated: Option<f64>,
    /// The same by the area between the curve and the control line; `None` too where it was not asked for.
    pub dissipated_by_area: Option<f64>,
}

impl Event {
    /// The event of a jump on `curve` from `before` to `landing`, with its losses; a pull-off where there is no landing.
    #[must_use]
    pub fn new(
        curve: &Curve,
        control: Control,
        before: Place,
        landing: Option<Place>,
        losses: Losses,
    ) -> Self {
        let after = landing.map(|place| curve.state(place));
        let state = curve.state(before);
        Self {
            kind: if after.is_some() { EventKind::Snap } else { EventKind::PullOff },
            control_value: control.value(state.approach, state.force),
            before: state,
            after,
            dissipated: energy::loss(control, &state, after.as_ref()),
            dissipated_by_area: match losses {
                Losses::Once => None,
                Losses::Twice => energy::area(&*curve.solution, control, before, landing),
            },
        }
    }
}

/// Why the path ended.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PathStop {
    /// The bodies came apart.
    PullOff,
    /// The end contact radius was reached in a stable state.
    End,
    /// The curve ends before.
    Curve(CurveStop),
}

impl fmt::Display for PathStop {
    /// Its numbers as they stand.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words(&UnitSystem::Reduced))
    }
}

impl PathStop {
    /// Why, with the numbers, which are in the user's units, as `shown` has them.
    pub fn words(&self, shown: &UnitSystem) -> String {
        match self {
            Self::PullOff => "the bodies came apart (pull-off)".to_owned(),
            Self::End => "the end contact radius was reached in a stable state".to_owned(),
            Self::Curve(stop) => format!("the curve ends: {}", stop.words(shown)),
        }
    }

    /// The same with its numbers in the user's units.
    #[must_use]
    pub fn in_units(self, units: &Units) -> Self {
        match self {
            Self::Curve(stop) => Self::Curve(stop.in_units(units)),
            other => other,
        }
    }
}

/// An unstable state asked for as the start of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asked {
    /// The state.
    pub state: State,
    /// Whether the potential falls all the way to the start of the path: if not, the edge does not run there by itself.
    pub falls: bool,
}

/// A quasi-static unloading.
#[derive(Debug, Clone, PartialEq)]
pub struct Unloading {
    /// What was controlled.
    pub control: Control,
    /// The first state on the physical path.
    pub start: State,
    /// The state asked for, when it was unstable and the path starts at the next stable state outward.
    pub asked: Option<Asked>,
    /// The instabilities in order.
    pub events: Vec<Event>,
    /// The stable pieces it follows, each from its largest contact radius to its smallest.
    pub pieces: Vec<[f64; 2]>,
    /// Why it ended.
    pub stop: PathStop,
    /// The state of smallest force on the path.
    pub min_force: State,
    /// The state of smallest approach on the path.
    pub min_approach: State,
}

/// Why an unloading could not start.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum UnloadError {
    /// The start is unstable and nothing outward is stable.
    UnstableStart {
        /// s of the start.
        contact_radius: f64,
        /// The control.
        control: Control,
        /// The largest radius searched.
        searched: f64,
    },
    /// It was no longer wanted.
    Cancelled,
}

impl fmt::Display for UnloadError {
    /// Its numbers as they stand.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words(&UnitSystem::Reduced))
    }
}

impl UnloadError {
    /// What is wrong, with the numbers, which are in the user's units, as `shown` has them.
    pub fn words(&self, shown: &UnitSystem) -> String {
        match *self {
            Self::UnstableStart { contact_radius, control, searched } => {
                let [s, searched] = [contact_radius, searched].map(|s| said(shown, Quantity::Length, s));
                let control = match control {
                    Control::Stiffness(k) => {
                        format!("stiffness={}", said(shown, Quantity::ForcePerLength, k))
                    }
                    other => other.to_string(),
                };
                format!(
                    "the start state (contact radius {s}) is unstable under {control} control and no stable state \
                     lies outward up to the contact radius {searched}"
                )
            }
            Self::Cancelled => "cancelled".to_owned(),
        }
    }

    /// The same error with its numbers in the user's units.
    #[must_use]
    pub fn in_units(self, units: &Units) -> Self {
        let Self::UnstableStart { contact_radius, control, searched } = self else { return self };
        Self::UnstableStart {
            contact_radius: contact_radius * units.length,
            control: control.in_units(1.0 / units.stiffness),
            searched: searched * units.length,
        }
    }
}

/// How far outward a stable state is looked for, as a multiple of the start radius.
const OUTWARD_REACH: f64 = 1000.0;

impl Unloading {
    /// The sum of the losses that are defined.
    pub fn total_dissipated(&self) -> f64 {
        self.events.iter().filter_map(|event| event.dissipated).fold(0.0, |sum, loss| sum + loss)
    }
}

/// Unloads under `control` along `curve`, from its outermost state down to its innermost.
///
/// # Errors
/// [`UnloadError`] when the start is unstable and no stable state lies outward.
pub fn unload(curve: &Curve, control: Control) -> Result<Unloading, UnloadError> {
    unload_while(curve, control, Losses::Twice, &Unwatched)
}

/// As [`unload`], with these losses; `progress` is asked before each event.
///
/// # Errors
/// [`UnloadError::Cancelled`] when `progress` said stop, and as [`unload`].
pub fn unload_while(
    curve: &Curve,
    control: Control,
    losses: Losses,
    progress: &dyn Progress,
) -> Result<Unloading, UnloadError> {
    let (from, to) = (curve.outermost(), curve.innermost());
    let mut longer = None;
    let asked = curve.solution.place(from).map(|place| curve.state(place));
    let here = if let Some(start) = stable_start(&*curve.solution, &curve.monotone(control), from) {
        start
    } else {
        run_outward(longer.insert(curve.clone()), control, from)?
    };
    let curve = longer.as_ref().unwrap_or(curve);
    let start = curve.state(here.place);
    let descent = descend(&*curve.solution, &curve.monotone(control), here, to);
    let mut events = Vec::with_capacity(descent.jumps.len());
    for jump in &descent.jumps {
        if progress.stop() {
            return Err(UnloadError::Cancelled);
        }
        let landing = jump.landing.map(|landing| landing.place);
        events.push(Event::new(curve, control, jump.before, landing, losses));
    }
    let stop = match descent.hole {
        Some(hole) => PathStop::Curve(CurveStop::NoEquilibrium(hole)),
        None if descent.pulls_off() => PathStop::PullOff,
        None => PathStop::End,
    };
    let pieces = descent.pieces;
    let least = |of| least(curve, &pieces, of).unwrap_or(start);
    let (min_force, min_approach) = (least(Control::Force), least(Control::Displacement));
    let asked = asked.filter(|_| start.contact_radius > from).map(|state| {
        let value = control.value(state.approach, state.force);
        let falls = landscape::falls(curve, control, value, from, start.contact_radius);
        Asked { state, falls }
    });
    let pieces =
        pieces.iter().map(|piece| piece.map(|place| curve.solution.at(place).contact_radius)).collect();
    Ok(Unloading { control, start, asked, events, pieces, stop, min_force, min_approach })
}

/// The state of smallest value of `of` on the stable pieces: at one of their ends, or at a limit point between them.
fn least(curve: &Curve, pieces: &[[Place; 2]], of: Control) -> Option<State> {
    let monotone = curve.monotone(of);
    let ends: Vec<[Local; 2]> =
        pieces.iter().map(|piece| piece.map(|place| curve.solution.at(place))).collect();
    let on_path =
        |s: f64| ends.iter().any(|[outer, inner]| inner.contact_radius <= s && s <= outer.contact_radius);
    let between = monotone.limits.iter().filter(|limit| on_path(limit.contact_radius));
    let between = between.map(|limit| (limit.place, weighted(of, limit.approach, limit.force)));
    let at_ends = pieces.iter().flatten().zip(ends.as_flattened());
    at_ends
        .map(|(place, at)| (*place, monotone.value(at)))
        .chain(between)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(place, _)| curve.state(place))
}

/// From an unstable start outward, at constant control, to the next stable state; `curve` reaches there then.
fn run_outward(curve: &mut Curve, control: Control, from: f64) -> Result<Landing, UnloadError> {
    let limit = (OUTWARD_REACH * from).min(curve.equilibrium.problem.largest_contact().max(from));
    let mut reach = from;
    loop {
        reach = (1.5 * reach).min(limit);
        curve.reach(reach);
        // A start at a limit point that lies beyond the curve as it was.
        let monotone = curve.monotone(control);
        if let Some(start) = stable_start(&*curve.solution, &monotone, from) {
            return Ok(start);
        }
        let stretch = monotone.stretch_of(from);
        let value =
            curve.solution.place(from).map_or(f64::NAN, |place| monotone.value(&curve.solution.at(place)));
        if let Ok(Some(landing)) = jump::run(&*curve.solution, &monotone, stretch, value, Run::Outward) {
            return Ok(landing);
        }
        if reach >= limit {
            return Err(UnloadError::UnstableStart { contact_radius: from, control, searched: reach });
        }
    }
}
