//! Steps along the equilibria of any number of contacts, by arc length in all edges, δ and P.

use super::arrival::{Arrival, Emit, WalkEnd, WalkFailure};
use super::corner::on_corner;
use super::edges::{self, Edges};
use super::touch::{self, Between};
use super::walker::{At, ROOM, Walk};
use crate::annuli::{Contacts, Ground};
use crate::continuation::{Settings, Tracer, Vector};
use crate::problem::Control;
use crate::quasistatic::Point;
use crate::quasistatic::path::NotFound;

/// The longest step of an edge, in waves.
const LONGEST: f64 = 0.2;

/// How often a step that begins at a limit point is halved until the control goes on.
const HALVINGS: usize = 20;

/// An event nearer to the start of a step than this share of it is the one that the walker stands on.
const START: f64 = 1e-9;

/// Where a step with rings ends.
struct Stepped {
    point: Point,
    arrival: Arrival,
    /// The length that the next step may have.
    length: f64,
}

impl Walk<'_> {
    pub(super) fn ring_steps(
        &self,
        count: usize,
        run: bool,
        emit: &mut Emit<'_>,
    ) -> Result<WalkEnd, WalkFailure> {
        let scales = &self.equilibrium().scales;
        let turned = |point: Point| if self.inward { point } else { point.reversed() };
        let mut here = turned(self.begun("walk")?.clone());
        let mut at = self.at;
        let mut length = self.length;
        let [start, end] = self.range;
        let outermost = edges::contacts(scales, &here).outermost();
        let mut ground = self.ground(outermost, edges::device(scales, &here)[0])?;
        for _ in 0..count {
            let contacts = edges::contacts(scales, &here);
            let [delta, _] = edges::device(scales, &here);
            let whole = ground.reach() >= self.equilibrium().table.end() * (1.0 - 1e-9);
            let needed = ground.can_touch_up_to(delta).max(contacts.outermost() + ground.wave);
            if !whole && needed >= ground.reach() {
                ground = self.ground(1.2 * needed, delta)?;
            }
            let narrow = self.balance(&ground, self.control).narrow();
            if let Some(end) = closing(&contacts, narrow) {
                return Ok(end);
            }
            let from = Length { length: if run { length } else { self.length }, run };
            let stepped = match self.ring_step(&ground, &here, at, from) {
                Ok(stepped) => stepped,
                // Near its end a branch is steep.
                Err(failure) => return closing(&contacts, 10.0 * narrow).ok_or(failure),
            };
            (here, length, at) = (stepped.point, stepped.length, At::Nothing);
            let ended = match stepped.arrival {
                Arrival::Limit(_) => Some(WalkEnd::AtLimit),
                Arrival::Touch(_) => Some(WalkEnd::AtTouch),
                _ => None,
            };
            let arrival = match stepped.arrival {
                Arrival::Limit(_) => {
                    let stored = turned(here.clone());
                    Arrival::Limit(
                        self.standing(&stored, At::Limit).try_rings().ok().map(|jumped| jumped.ahead()),
                    )
                }
                other => other,
            };
            let reached = self.of_rings(&ground, arrival, turned(here.clone()));
            let reached = reached.ok_or(WalkFailure::NoEquilibrium("after the step"))?;
            let s = reached.state.contact_radius;
            if !emit(reached) {
                return Ok(WalkEnd::Paused);
            }
            if let Some(ended) = ended {
                return Ok(ended);
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

    /// One step, which ends at the first limit point of the control or touch.
    fn ring_step(
        &self,
        ground: &Ground,
        here: &Point,
        at: At,
        wanted: Length,
    ) -> Result<Stepped, WalkFailure> {
        let equilibrium = self.equilibrium();
        let contacts = edges::contacts(&equilibrium.scales, here);
        let edges = Edges::near(ground, equilibrium, contacts.clone());
        let row = edges.control_row(self.control);
        let mut settings = Settings::new(here.y().len());
        let scale = equilibrium.scales.contact_radius;
        settings.largest_increment.iter_mut().skip(2).for_each(|most| *most = LONGEST * ground.wave / scale);
        if !wanted.run {
            settings.longest = wanted.length;
        }
        let mut tracer = Tracer::new(&edges, settings);
        tracer.length = wanted.length;
        let led = self.past_corner(&edges, here, tracer.length)?;
        let next = match &led {
            Some(led) => led.clone(),
            None => Self::smooth_step(&mut tracer, here, at, &row)?,
        };
        let chord: Vector = next.y() - here.y();
        let share = |point: &Point| chord.dot(&(point.y() - here.y())) / chord.norm_squared();
        let mut first: Option<(f64, Point, Arrival)> = None;
        if at != At::Limit {
            let found = tracer.brackets(&[here.clone(), next.clone()], &row).unwrap_or_default();
            if let Some(bracket) = found.first() {
                let located = tracer.limit_point(bracket, &row);
                let located = located.map_err(|failure| WalkFailure::Edges(failure.to_string()))?;
                let point = located.point.after(here);
                first = Some((share(&point), point, Arrival::Limit(None)));
            }
        }
        let touched = touch::first_touch(&edges, &mut tracer, [here, &next]);
        if let Some((Between { share, point }, radius)) = touched
            && share > START
            && first.as_ref().is_none_or(|(other, ..)| share < *other)
        {
            first = Some((share, point.after(here), Arrival::Touch(radius)));
        }
        let length = tracer.length;
        Ok(match first {
            Some((_, point, arrival)) => Stepped { point, arrival, length },
            None if led.is_some() && self.turns_at(ground, &next, &row) => {
                Stepped { point: next, arrival: Arrival::Limit(None), length }
            }
            None => Stepped { point: next, arrival: Arrival::Step, length },
        })
    }

    /// A step where the curve is smooth; from a limit point to the side on which its bend says that the control goes on, for a step that
    /// ends elsewhere passes another.
    fn smooth_step(
        tracer: &mut Tracer<'_>,
        here: &Point,
        at: At,
        row: &Vector,
    ) -> Result<Point, WalkFailure> {
        let mut next = tracer.step(here)?;
        if at == At::Limit {
            let bend = row.dot(&here.curvature());
            for _ in 0..HALVINGS {
                if next.slope(row) * bend > 0.0 {
                    break;
                }
                tracer.length = 0.5 * next.length;
                next = tracer.step(here)?;
            }
        }
        Ok(next)
    }

    /// Whether the control turns on the corner on which an edge of `point` stands.
    fn turns_at(&self, ground: &Ground, point: &Point, row: &Vector) -> bool {
        let base = edges::contacts(&self.equilibrium().scales, point);
        if !on_corner(ground, &base) {
            return false;
        }
        let edges = Edges::near(ground, self.equilibrium(), base);
        let beyond = self.past_corner(&edges, point, 0.0).ok().flatten();
        beyond.is_some_and(|beyond| beyond.slope(row) * point.slope(row) < 0.0)
    }

    /// Goes to the state at this value of the control with the same contacts, from the edges `from` of the problem before it changed.
    pub fn solve_rings(&self, value: f64, from: &Contacts, emit: &mut Emit<'_>) -> WalkEnd {
        match self.try_solve_rings(value, from) {
            Ok(reached) => {
                emit(reached);
                WalkEnd::Done
            }
            Err(failure) => WalkEnd::Failed(failure),
        }
    }

    fn try_solve_rings(&self, value: f64, from: &Contacts) -> Result<super::arrival::Reached, WalkFailure> {
        let delta = if self.control == Control::Displacement { value } else { 0.0 };
        let ground = self.ground(from.outermost(), delta)?;
        let held = self.balance(&ground, self.control).solve(from, value).map_err(|error| match error {
            NotFound::State(error) => WalkFailure::Edges(error.to_string()),
            NotFound::Singular | NotFound::Unfinished { .. } => WalkFailure::NotSolved,
        })?;
        self.landed(&ground, Arrival::Solved, &held)
    }
}

/// How long a step may be.
#[derive(Clone, Copy)]
struct Length {
    length: f64,
    run: bool,
}

/// The end of the branch, where a ring or a gap between contacts is narrower than `narrow`.
fn closing(contacts: &Contacts, narrow: f64) -> Option<WalkEnd> {
    let vanishing = contacts.rings.iter().find(|[a, b]| b - a < narrow);
    if let Some([a, b]) = vanishing {
        return Some(WalkEnd::Vanishes(0.5 * (a + b)));
    }
    let meets = contacts.gaps().into_iter().find(|[lo, hi]| hi - lo < narrow);
    if let Some([lo, hi]) = meets {
        return Some(WalkEnd::EdgesMeet(0.5 * (lo + hi)));
    }
    (contacts.has_disc() && contacts.disc < narrow).then_some(WalkEnd::Vanishes(0.0))
}
