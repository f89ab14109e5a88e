//! Steps, runs and jumps of one disc along its curve.

use super::arrival::{Ahead, Arrival, Emit, WalkEnd, WalkFailure, Walked};
use super::land::Jumped;
use super::walker::{At, ROOM, Walk};
use crate::continuation::Tracer;
use crate::disc::Place;
use crate::problem::Control;
use crate::progress::Unwatched;
use crate::quasistatic::curve::{Curve, settings};
use crate::quasistatic::jump::{self, EdgeDirection};
use crate::quasistatic::monotone::{Extremum, Limit, Monotone};
use crate::quasistatic::path::stepped::ROUNDING;
use crate::quasistatic::path::{Event, Losses};
use crate::quasistatic::{StatePoint, energy, landscape};
use crate::ritz::{self, NewtonSettings};
use crate::root::RootBracket;

/// A landing outward is looked for further out by this factor each time, and up to this multiple of the radius.
const OUTWARD_STEP: f64 = 1.5;
const OUTWARD_REACH: f64 = 1000.0;

/// A state solved again lies within this share of a wave, or of its radius, of the old one.
const NEAR: f64 = 0.5;

/// Within this share of its radius the walker stands on a stop.
const LEFT: f64 = 1e-12;

/// A place at which a step ends: a limit point of the control, or a corner of the curve.
#[derive(Debug, Clone, Copy)]
struct StepStop {
    contact_radius: f64,
    is_limit: bool,
    is_corner: bool,
}

/// A limit point, like a touch, is known only to the square root of rounding: the digits beyond differ from table to
/// table, and so would a replay.
fn rounded(radius: f64) -> f64 {
    const KNOWN: u64 = 1 << 8;
    f64::from_bits((radius.to_bits() + KNOWN / 2) & !(KNOWN - 1))
}

/// The first of `stops`, which ascend, on the way from one radius to another, the latter included.
fn first_between(stops: &[StepStop], from: f64, to: f64) -> Option<StepStop> {
    if to < from {
        let from = from * (1.0 - LEFT);
        stops.iter().rev().find(|stop| to <= stop.contact_radius && stop.contact_radius < from).copied()
    } else {
        let from = from * (1.0 + LEFT);
        stops.iter().find(|stop| from < stop.contact_radius && stop.contact_radius <= to).copied()
    }
}

impl Walk<'_> {
    /// Goes to the state of this contact radius.
    ///
    /// # Errors
    /// [`WalkFailure`] where there is none.
    pub fn move_to(&self, s: f64, emit: &mut Emit<'_>) -> Walked {
        let point = self.equilibrium().explicit(s);
        let point = point.ok_or(WalkFailure::NoEquilibrium("at that contact radius"))?;
        emit(self.of_disc(Arrival::Moved, point));
        Ok(WalkEnd::Done)
    }

    /// Goes to the limit point at this contact radius.
    ///
    /// # Errors
    /// [`WalkFailure`] where there is no state.
    pub fn move_to_limit(&self, s: f64, emit: &mut Emit<'_>) -> Walked {
        let point = self.equilibrium().explicit(s).ok_or(WalkFailure::NoEquilibrium("at the limit point"))?;
        emit(self.of_disc(Arrival::Limit(self.ahead(&point)), point));
        Ok(WalkEnd::AtLimit)
    }

    /// Goes to the state at this value of the control, nearest to the contact radius `s` before the problem changed.
    /// From a stable state it goes to the nearest stable one, where there is one: bodies would not stay in an unstable
    /// one.
    ///
    /// # Errors
    /// [`WalkFailure::NotSolved`] where there is none near.
    pub fn solve(&self, value: f64, s: f64, was_stable: bool, emit: &mut Emit<'_>) -> Walked {
        let equilibrium = self.equilibrium();
        let problem = &equilibrium.problem;
        // On a wavy gap Newton's method may find another state far away; the branch of the old radius is wanted.
        let near = |found: f64| {
            let feature = problem.gap.feature_length().unwrap_or(s);
            (found - s).abs() <= NEAR * feature.min(s)
        };
        let settings = NewtonSettings::default();
        let newton = ritz::solve(equilibrium.basis.as_ref(), problem, self.control, value, s, settings)
            .ok()
            .filter(|solved| near(solved.evaluation.contact_radius))
            .and_then(|solved| {
                let mut point = equilibrium.point(&solved.evaluation)?;
                point.rounds = solved.rounds;
                Some(point)
            });
        let is_stable = |point: &StatePoint| equilibrium.stability(point).under(self.control);
        let stable = |found: Option<StatePoint>| match found {
            Some(point) if !was_stable || is_stable(&point) => Some(point),
            found => self.nearest_crossing(value, s, &is_stable).filter(|_| was_stable).or(found),
        };
        let found = newton.or_else(|| self.nearest_crossing(value, s, &|_| true));
        let point = stable(found).ok_or(WalkFailure::NotSolved)?;
        // If the control is at its limit, as after a change that leaves the curve as it was, the state is at the limit
        // point itself.
        if let Some(limit) = self.limit_at(value, equilibrium.contact_radius(&point)) {
            return self.move_to_limit(limit, emit);
        }
        emit(self.of_disc(Arrival::Solved, point));
        Ok(WalkEnd::Done)
    }

    /// The radius of the limit point beside the state of radius `s` at which the control takes this value; `None` where none does.
    fn limit_at(&self, value: f64, s: f64) -> Option<f64> {
        /// How far the value may be off, over the scale of the control; beside a limit point, that is a millionth of
        /// the way.
        const AT_LIMIT: f64 = 1e-12;
        let equilibrium = self.equilibrium();
        let mut curve = self.curve.clone();
        curve.reach(s);
        let (_, limit) = nearest_limit(&curve.monotone(self.control), s)?;
        let near = NEAR * equilibrium.problem.gap.feature_length().unwrap_or(s).min(s);
        if (limit.contact_radius - s).abs() > near {
            return None;
        }
        let stop = StepStop { contact_radius: limit.contact_radius, is_limit: true, is_corner: limit.corner };
        let radius = self.located(stop).contact_radius;
        let state = equilibrium.state(&equilibrium.explicit(radius)?);
        let off = self.control.value(state.approach, state.force) - value;
        let scale = self.control.value(equilibrium.scales.approach, equilibrium.scales.force);
        (off.abs() <= AT_LIMIT * scale).then_some(radius)
    }

    /// The stops on the curve up to the radius `reach`, ascending.
    fn stops(&self, reach: f64) -> Vec<StepStop> {
        let mut curve = self.curve.clone();
        curve.reach(reach);
        let monotone = curve.monotone(self.control);
        let limits = monotone.limits.iter().map(|at| StepStop {
            contact_radius: at.contact_radius,
            is_limit: true,
            is_corner: at.corner,
        });
        let mut stops: Vec<StepStop> = limits.collect();
        for contact_radius in curve.corners() {
            if stops.iter().all(|stop| stop.contact_radius.to_bits() != contact_radius.to_bits()) {
                stops.push(StepStop { contact_radius, is_limit: false, is_corner: true });
            }
        }
        stops.sort_by(|a, b| a.contact_radius.total_cmp(&b.contact_radius));
        stops
    }

    /// The stop computed with the smallest sufficient table, so that its bits do not depend on how far the walk has been.
    fn located(&self, stop: StepStop) -> StepStop {
        const SPARE: f64 = 1.05;
        let away = |other: &StepStop| (other.contact_radius - stop.contact_radius).abs();
        let found = self.stops(SPARE * stop.contact_radius).into_iter();
        let mut found = found.min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(stop);
        if !found.is_corner {
            found.contact_radius = rounded(found.contact_radius);
        }
        found
    }

    pub(super) fn disc_steps(&self, count: usize, run: bool, emit: &mut Emit<'_>) -> Walked {
        let equilibrium = self.equilibrium();
        let from = self.begun("walk")?;
        let [start, end] = self.range;
        let mut settings = settings(equilibrium);
        if !run {
            settings.longest = self.length;
        }
        let mut tracer = Tracer::new(equilibrium, settings);
        tracer.length = self.length;
        let turned = |point: StatePoint| {
            let shrinking = point.tangent()[2] < 0.0;
            if shrinking == self.inward { point } else { point.reversed() }
        };
        let mut here = turned(from.clone());
        let outermost = equilibrium.contact_radius(&here).max(start);
        let mut stops = self.stops(outermost);
        let mut known = outermost.max(self.curve.solution.reach());
        let mut touching = matches!(self.at, At::Touch(_));
        for _ in 0..count {
            if !run {
                // In steps by hand the length asked for counts, not the one the last step would allow.
                tracer.length = self.length;
            }
            let before = equilibrium.contact_radius(&here);
            let next = turned(self.next(&stops, &mut tracer, &here)?);
            let s = equilibrium.contact_radius(&next);
            if s > known {
                known = 1.2 * s;
                stops = self.stops(known);
            }
            let stop = first_between(&stops, before, s).map(|stop| self.located(stop));
            let to = stop.map_or(s, |stop| stop.contact_radius);
            // A touch on which the walker stands is left behind.
            let touch = if touching { None } else { self.touch_between(before, to) };
            touching = false;
            if let Some((radius, crest)) = touch {
                let point = equilibrium.explicit(radius).map(turned);
                let point = point.ok_or(WalkFailure::NoEquilibrium("at the touch"))?;
                let mut point = point.after(&here);
                point.rounds = next.rounds;
                emit(self.of_disc(Arrival::Touch(crest), point));
                return Ok(WalkEnd::AtTouch);
            }
            if let Some(stop) = stop {
                let point = equilibrium.explicit(stop.contact_radius).map(turned);
                let point = point.ok_or(WalkFailure::NoEquilibrium("at the next limit point"))?;
                let mut point = point.after(&here);
                point.rounds = next.rounds;
                here = point.clone();
                if stop.is_limit {
                    emit(self.of_disc(Arrival::Limit(self.ahead(&point)), point));
                    return Ok(WalkEnd::AtLimit);
                }
                if !emit(self.of_disc(Arrival::Step, point)) {
                    return Ok(WalkEnd::Paused);
                }
                continue;
            }
            here = next.clone();
            if !emit(self.of_disc(Arrival::Step, next)) {
                return Ok(WalkEnd::Paused);
            }
            if self.inward && s < end {
                return Ok(WalkEnd::AtEnd);
            }
            if !self.inward && s > ROOM * start {
                return Ok(WalkEnd::OutOfRange);
            }
        }
        Ok(WalkEnd::Done)
    }

    /// Where the next crest touches on the way from one contact radius to another, and its radius. A crest that
    /// touches or overlaps at the start does not count.
    fn touch_between(&self, from: f64, to: f64) -> Option<(f64, f64)> {
        let equilibrium = self.equilibrium();
        let judge = equilibrium.judge();
        let crest = |s: f64| {
            let delta = equilibrium.basis.equilibrium(&equilibrium.problem, s)?.approach;
            judge.judge(s, delta, &Unwatched).nearest
        };
        let wave = equilibrium.problem.gap.feature_length().unwrap_or(from);
        let [start, end] = [from, to].map(crest);
        let ([near, far], mut at) = ([start?.gap, end?.gap], end?.radius);
        if near <= ROUNDING * wave || far >= 0.0 || near.is_nan() {
            return None;
        }
        let mut bracket = RootBracket::new([from, near], [to, far])?;
        bracket.close(4.0 * f64::EPSILON * from.max(to), |s| {
            let found = crest(s)?;
            at = found.radius;
            Some(found.gap)
        })?;
        Some((rounded(bracket.end(false)), at))
    }

    /// An outward jump in which a crest touches on the way, so that rings take part in it; `None` where the disc alone
    /// runs.
    pub(super) fn runs_into_crests(&self) -> Option<Jumped> {
        let from = self.from.filter(|_| self.equilibrium().problem.work_of_adhesion > 0.0)?;
        let outward = match self.at {
            At::Limit => self.bend(from) < 0.0,
            At::Nothing | At::Touch(_) => !self.inward,
        };
        if !outward {
            return None;
        }
        self.try_rings().ok().filter(Jumped::has_touched)
    }

    /// The second derivative of the control along the curve: below zero at its maximum.
    fn bend(&self, point: &StatePoint) -> f64 {
        self.equilibrium().control_row(self.control).dot(&point.curvature())
    }

    /// The next point by arc length. A corner of the curve is left and reached without a tangent, because it has none.
    fn next(
        &self,
        stops: &[StepStop],
        tracer: &mut Tracer<'_>,
        here: &StatePoint,
    ) -> Result<StatePoint, WalkFailure> {
        let equilibrium = self.equilibrium();
        let s = equilibrium.contact_radius(here);
        let towards = if self.inward { 0.0 } else { f64::INFINITY };
        let is_here = |stop: &StepStop| (stop.contact_radius / s - 1.0).abs() <= LEFT;
        if stops.iter().any(|stop| stop.is_corner && is_here(stop)) && !self.inward {
            let mut curve = self.curve.clone();
            curve.reach(1.1 * s);
            let left = curve.beyond_corner(s, tracer.length);
            return left.ok_or(WalkFailure::NoEquilibrium("beyond the corner"));
        }
        let ahead = first_between(stops, s, towards).filter(|stop| stop.is_corner);
        let corner = ahead.and_then(|stop| equilibrium.explicit(stop.contact_radius));
        if let Some(corner) = corner.filter(|corner| (corner.y() - here.y()).norm() <= tracer.length) {
            return Ok(corner);
        }
        Ok(tracer.step(here)?)
    }

    pub(super) fn disc_jump(&self, emit: &mut Emit<'_>) -> Walked {
        let from = self.begun("jump")?;
        let (curve, leaves, landing) = self.landing(from)?;
        let event = Event::of_disc(&*curve.solution, self.control, leaves, landing, Losses::Twice);
        let point = match landing {
            Some(place) => self.equilibrium().explicit(curve.solution.radius(place)),
            None => Some(from.clone()),
        };
        let point = point.ok_or(WalkFailure::NoEquilibrium("at the landing"))?;
        emit(self.of_disc(Arrival::Jump(Box::new(event)), point));
        Ok(WalkEnd::Done)
    }

    /// The place that the edge leaves at constant control from `from`, and where it comes to rest, `None` where the bodies
    /// come apart; with a curve that reaches there.
    fn landing(&self, from: &StatePoint) -> Result<(Curve, Place, Option<Place>), WalkFailure> {
        let s = self.equilibrium().contact_radius(from);
        let mut curve = self.curve.clone();
        curve.reach(s * (1.0 + 1e-9));
        let mut reach = s;
        loop {
            let monotone = curve.monotone(self.control);
            let place = curve.solution.place(s.min(curve.solution.reach())).ok_or(WalkFailure::NoBasis)?;
            // From a limit point, away from its stable side; from any other state, in the direction of the walk.
            let limit = if self.at == At::Limit { nearest_limit(&monotone, s) } else { None };
            let (place, stretch, run) = match limit {
                Some((index, limit)) => match limit.turn {
                    Extremum::Minimum => (limit.place, index + 1, EdgeDirection::Inward),
                    Extremum::Maximum => (limit.place, index, EdgeDirection::Outward),
                },
                None if self.inward => (place, monotone.stretch_of(s), EdgeDirection::Inward),
                None => (place, monotone.stretch_of(s), EdgeDirection::Outward),
            };
            let value = monotone.value(&curve.solution.at(place));
            match jump::run(&*curve.solution, &monotone, stretch, value, run) {
                Ok(Some(landing)) => {
                    let to = curve.solution.radius(landing.place);
                    let held = curve.solution.at(place);
                    let held = self.control.value(held.approach, held.force);
                    if !landscape::falls(&curve, self.control, held, s, to) {
                        return Err(WalkFailure::Rises);
                    }
                    return Ok((curve, place, Some(landing.place)));
                }
                Ok(None) if run == EdgeDirection::Inward => return Ok((curve, place, None)),
                Ok(None) => {
                    reach *= OUTWARD_STEP;
                    if reach > OUTWARD_REACH * s || !curve.reach(reach) {
                        return Err(WalkFailure::NothingOutward);
                    }
                }
                Err(_) => return Err(WalkFailure::NothingInward),
            }
        }
    }

    /// Where the edge runs from the limit point `from`, and what that costs; `None` where it is not known.
    fn ahead(&self, from: &StatePoint) -> Option<Ahead> {
        let on_limit = self.standing(from, At::Limit);
        if let Some(jumped) = on_limit.runs_into_crests() {
            return Some(jumped.ahead());
        }
        let (curve, leaves, landing) = on_limit.landing(from).ok()?;
        let after = landing.map(|place| curve.state(place));
        let dissipated = energy::loss(self.control, &curve.state(leaves), after.as_ref());
        Some(Ahead { after, dissipated })
    }

    /// The state that is `wanted`, nearest to the radius `s`, at which the curve takes the control value.
    fn nearest_crossing(
        &self,
        value: f64,
        s: f64,
        wanted: &dyn Fn(&StatePoint) -> bool,
    ) -> Option<StatePoint> {
        let curve = self.curve;
        let solution = &*curve.solution;
        let monotone = curve.monotone(self.control);
        let value = match self.control {
            Control::Displacement | Control::Force => value,
            // The stretches hold the value scaled like this.
            Control::Stiffness(k) => value * (k / (1.0 + k)),
        };
        let radius = |place: Place| solution.radius(place);
        let on_curve = |s: &f64| curve.innermost() <= *s && *s <= curve.outermost();
        let mut radii: Vec<f64> =
            monotone.crossings(solution, value).into_iter().map(|(place, _)| radius(place)).collect();
        radii.retain(on_curve);
        radii.sort_by(|a, b| (a - s).abs().total_cmp(&(b - s).abs()));
        radii.into_iter().filter_map(|s| self.equilibrium().explicit(s)).find(|point| wanted(point))
    }
}

/// The limit point nearest to the radius `s`, with the number of the stretch that ends there.
fn nearest_limit(monotone: &Monotone, s: f64) -> Option<(usize, Limit)> {
    let limits = monotone.limits.iter().copied();
    let away = |limit: &Limit| (limit.contact_radius - s).abs();
    let limit = limits.min_by(|a, b| away(a).total_cmp(&away(b)))?;
    let inner = monotone.stretches.iter().position(|stretch| stretch.outer == limit.place)?;
    Some((inner, limit))
}
