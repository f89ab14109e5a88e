//! The whole unloading: from the start state inward, through every snap, to the pull-off.

use super::curve::{Curve, CurveStop};
use super::energy;
use super::equilibrium::{Equilibrium, Point, State};
use super::jump::{Landing, Nodes, Run};
use super::landscape;
use crate::contact::{Control, Units};
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
    /// The event of a jump at the control value `value` from `before` to `landing`, with its losses; a pull-off
    /// where there is no landing.
    #[must_use]
    pub fn new(
        equilibrium: &Equilibrium,
        control: Control,
        value: f64,
        before: State,
        landing: Option<&Point>,
        losses: Losses,
    ) -> Self {
        let after = landing.map(|point| equilibrium.state(point));
        let radii = (before.contact_radius, after.map(|a| a.contact_radius));
        Self {
            kind: if after.is_some() { EventKind::Snap } else { EventKind::PullOff },
            control_value: value,
            before,
            after,
            dissipated: energy::loss(control, value, &before, after.as_ref()),
            dissipated_by_area: match losses {
                Losses::Once => None,
                Losses::Twice => energy::area(equilibrium, control, value, radii.0, radii.1),
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
/// How far inward a landing is looked for, as a share of the radius of the last limit point: the curve
/// is smooth and monotone towards s = 0 long before.
pub const INWARD_REACH: f64 = 1e-4;

impl Unloading {
    /// The sum of the losses that are defined.
    pub fn total_dissipated(&self) -> f64 {
        self.events.iter().filter_map(|event| event.dissipated).fold(0.0, |sum, loss| sum + loss)
    }
}

/// Unloads under `control` along `curve`, from its outermost point down to its innermost.
///
/// The curve is extended where a landing lies beyond it: `curve` keeps the longer branch.
///
/// # Errors
/// [`UnloadError`] when the start is unstable and no stable state lies outward.
pub fn unload(curve: &mut Curve, control: Control) -> Result<Unloading, UnloadError> {
    unload_while(curve, control, Losses::Twice, || true)
}

/// As [`unload`], with these losses; `go_on` is asked before each event.
///
/// # Errors
/// [`UnloadError::Cancelled`] when `go_on` said no, and as [`unload`].
pub fn unload_while(
    curve: &mut Curve,
    control: Control,
    losses: Losses,
    mut go_on: impl FnMut() -> bool,
) -> Result<Unloading, UnloadError> {
    let asked_radius = curve.outermost();
    let end_radius = curve.innermost();
    let asked_state = curve.branch.points.first().map(|p| curve.equilibrium.state(p));
    let stable = |curve: &Curve, point: &Point| curve.equilibrium.stability(point).under(control);

    // Its own limit points make the events, the others' may be the smallest force or approach of the path.
    for control in [control, Control::Force, Control::Displacement] {
        curve.hold(control);
    }
    let unstable_start = curve.branch.points.first().is_some_and(|p| !stable(curve, p));
    if unstable_start {
        run_outward(curve, control, asked_radius)?;
    }
    let Descent { path, events, pieces, stop } = descend(curve, control, losses, end_radius, &mut go_on)?;
    let start = curve.equilibrium.state(&path[0]);
    let least = |of| least(curve, &path, &events, of).map_or(start, |point| curve.equilibrium.state(&point));
    let (min_force, min_approach) = (least(Control::Force), least(Control::Displacement));
    let asked = asked_state.filter(|_| unstable_start).map(|state| {
        let value = control.value(state.approach, state.force);
        let falls = landscape::falls(&curve.equilibrium, control, value, asked_radius, start.contact_radius);
        Asked { state, falls }
    });
    Ok(Unloading { control, start, asked, events, pieces, stop, min_force, min_approach })
}

/// The way down a curve.
struct Descent {
    /// Its states, the first one and the landings among them.
    path: Vec<Point>,
    events: Vec<Event>,
    pieces: Vec<[f64; 2]>,
    stop: PathStop,
}

/// From the first point of `curve`, stable, down to `end_radius`: along the curve to the next minimum of the control,
/// from there to where the edge lands, and on.
fn descend(
    curve: &mut Curve,
    control: Control,
    losses: Losses,
    end_radius: f64,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Descent, UnloadError> {
    let mut nodes = Nodes::new(curve, control, &curve.limit_points(control));
    let mut here = Landing { point: nodes.points()[0].clone(), node: 0 };

    let mut path = Vec::new();
    let mut events = Vec::new();
    let mut pieces = Vec::new();
    let stop = loop {
        let minimum = nodes.next_minimum(here.node + 1);
        let last = minimum.unwrap_or(nodes.points().len() - 1);
        path.push(here.point.clone());
        path.extend(
            nodes.points()[here.node + 1..=last.max(here.node)]
                .iter()
                .take_while(|p| curve.equilibrium.contact_radius(p) >= end_radius * (1.0 - 1e-12))
                .cloned(),
        );
        let radius = |point: &Point| curve.equilibrium.contact_radius(point);
        pieces.push([radius(&here.point), path.last().map_or(0.0, radius)]);
        let Some(limit) =
            minimum.filter(|&at| curve.equilibrium.contact_radius(&nodes.points()[at]) >= end_radius)
        else {
            break match curve.stop {
                CurveStop::End => PathStop::End,
                stop => PathStop::Curve(stop),
            };
        };
        if !go_on() {
            return Err(UnloadError::Cancelled);
        }
        let value = nodes.value(limit);
        let before_point = nodes.points()[limit].clone();
        let landing = landing_inward(curve, &mut nodes, limit);
        let before = curve.equilibrium.state(&before_point);
        if landing.is_none() && curve.innermost() > INWARD_REACH * before.contact_radius * (1.0 + 1e-9) {
            // The basis has no equilibrium further in: where the edge would land is not known, so this is no pull-off.
            break PathStop::Curve(CurveStop::NoEquilibrium(curve.innermost()));
        }
        events.push(Event::new(
            &curve.equilibrium,
            control,
            value,
            before,
            landing.as_ref().map(|l| &l.point),
            losses,
        ));
        match landing {
            None => break PathStop::PullOff,
            Some(landing) if curve.equilibrium.contact_radius(&landing.point) < end_radius => {
                let s = curve.equilibrium.contact_radius(&landing.point);
                pieces.push([s, s]);
                path.push(landing.point);
                break PathStop::End;
            }
            Some(landing) => here = landing,
        }
    };
    Ok(Descent { path, events, pieces, stop })
}

/// Where the edge lands when it runs inward from the limit point at node `limit`; the curve is extended, and the
/// nodes with it, where nothing is found on it.
fn landing_inward(curve: &mut Curve, nodes: &mut Nodes, limit: usize) -> Option<Landing> {
    let value = nodes.value(limit);
    let landing = nodes.run(curve, limit, value, Run::Inward);
    let reach = INWARD_REACH * curve.equilibrium.contact_radius(&nodes.points()[limit]);
    if landing.is_some() || reach >= curve.innermost() || !curve.extend(reach) {
        return landing;
    }
    // Indices before the extension stay true: it only adds points at the end.
    *nodes = Nodes::new(curve, nodes.control, &curve.limit_points(nodes.control));
    nodes.run(curve, limit, value, Run::Inward)
}

/// The point of a path at which the quantity that `of` controls is smallest: one of its own, or a limit point of
/// that quantity between them.
fn least(curve: &Curve, path: &[Point], events: &[Event], of: Control) -> Option<Point> {
    let row = curve.equilibrium.control_row(of);
    let limits = curve.limit_points(of);
    let between = limits.iter().map(|l| &l.point).filter(|p| is_on(&curve.equilibrium, path, events, p));
    path.iter().chain(between).min_by(|a, b| row.dot(&a.y).total_cmp(&row.dot(&b.y))).cloned()
}

/// Whether `point` lies on the stable pieces of a path: between its outermost and innermost point, and not
/// inside a jump.
fn is_on(equilibrium: &Equilibrium, path: &[Point], events: &[Event], point: &Point) -> bool {
    let s = equilibrium.contact_radius(point);
    let radius = |p: Option<&Point>| p.map_or(0.0, |p| equilibrium.contact_radius(p));
    let inside = s <= radius(path.first()) && s >= radius(path.last());
    inside
        && events.iter().all(|event| {
            let after = event.after.map_or(0.0, |a| a.contact_radius);
            s >= event.before.contact_radius || s <= after
        })
}

/// From an unstable start outward, at constant control, to the next stable state, which becomes the first
/// point of the curve.
fn run_outward(curve: &mut Curve, control: Control, from: f64) -> Result<(), UnloadError> {
    let row = curve.equilibrium.control_row(control);
    let value = curve.branch.points.first().map_or(0.0, |p| row.dot(&p.y));
    let limit = (OUTWARD_REACH * from).min(curve.equilibrium.problem.largest_contact().max(from));
    let mut reach = from;
    loop {
        reach = (1.5 * reach).min(limit);
        let grew = curve.extend(reach);
        let nodes = Nodes::new(curve, control, &curve.limit_points(control));
        let start = nodes
            .points()
            .iter()
            .position(|p| curve.equilibrium.contact_radius(p) <= from * (1.0 + 1e-12))
            .unwrap_or(0);
        if let Some(landing) = nodes.run(curve, start, value, Run::Outward) {
            // The path starts at the landing: what lies outward of it is not on it.
            curve.begin_at(landing.point);
            return Ok(());
        }
        if !grew || reach >= limit {
            return Err(UnloadError::UnstableStart { contact_radius: from, control, searched: reach });
        }
    }
}
