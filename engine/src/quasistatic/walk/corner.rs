//! Steps past places where the slope or the curvature of the gap jumps.
//!
//! Where a contact covers a corner κ goes like the root of the distance from it, and arc length is no measure there: the edge itself is.

use super::arrival::WalkFailure;
use super::edges::{self, Edges};
use super::walker::Walk;
use crate::annuli::{Contacts, Ground};
use crate::problem::Control;
use crate::quasistatic::Point;
use crate::quasistatic::path::point;
use nalgebra::DVector;

/// An edge this near to a corner, in waves, stands on it.
const ON: f64 = 1e-7;

/// How far beyond a corner the first state lies, in waves.
const BEYOND: f64 = 1e-3;

/// A step is led to a corner that lies less than this many times as far as it goes, or this many waves.
const AHEAD: f64 = 1.2;
const NEAREST: f64 = 2e-3;

/// How often a step to a corner is halved.
const HALVINGS: usize = 20;

/// Whether an edge of `contacts` stands on a corner.
pub(super) fn on_corner(ground: &Ground, contacts: &Contacts) -> bool {
    let on = |radius: f64| ground.stops().iter().any(|stop| (stop - radius).abs() <= ON * ground.wave);
    contacts.edges().iter().any(|edge| on(edge.radius))
}

/// An edge that meets a corner: its number, and its way in waves.
struct Meets {
    edge: usize,
    way: f64,
}

impl Walk<'_> {
    /// The point on a corner that an edge meets within a step of this length, or the first one beyond it; `None` where none does.
    pub(super) fn past_corner(
        &self,
        edges: &Edges<'_>,
        here: &Point,
        length: f64,
    ) -> Result<Option<Point>, WalkFailure> {
        let ground = edges.ground;
        if ground.stops().is_empty() {
            return Ok(None);
        }
        let contacts = edges::contacts(&self.equilibrium().scales, here);
        let balance = self.balance(ground, Control::Displacement);
        let scales = balance.scales(&contacts);
        let radius = self.equilibrium().scales.contact_radius;
        let speed = |i: usize| here.tangent()[2 + i] * radius / scales.edges[i];
        let signs = contacts.edges();
        let meets = signs.iter().enumerate().filter_map(|(edge, at)| {
            let outward = speed(edge) > 0.0;
            let away = |stop: &f64| (stop - at.radius) / scales.edges[edge];
            if ground.stops().iter().any(|stop| away(stop).abs() <= ON) {
                return Some(Meets { edge, way: BEYOND });
            }
            let stops = ground.stops().iter().map(away).filter(|way| (*way > 0.0) == outward);
            let way = stops.map(f64::abs).min_by(f64::total_cmp)?;
            (way <= AHEAD * (speed(edge).abs() * length).max(NEAREST)).then_some(Meets { edge, way })
        });
        let time = |meets: &Meets| meets.way / speed(meets.edge).abs();
        let Some(first) = meets.min_by(|a, b| time(a).total_cmp(&time(b))) else { return Ok(None) };
        let lost = || WalkFailure::Edges("a corner of the gap could not be passed".to_owned());
        let held = edges.held(here, Control::Displacement).ok_or_else(lost)?;
        let n = signs.len();
        let tangent = DVector::from_fn(n + 1, |i, _| match signs.get(i) {
            Some(edge) => edge.sign * speed(i),
            None => here.tangent()[0] * self.equilibrium().scales.approach / scales.control,
        });
        let from = point::Point { held, tangent: tangent.normalize(), scales };
        let step = point::Step::of_edge(&balance, &from, first.edge);
        let mut way = first.way;
        for _ in 0..HALVINGS {
            if let Some((led, _)) = step.to(way, &step.line(way).map(|x| x.clamp(-0.2, 0.2))) {
                let near = Edges::near(ground, self.equilibrium(), led.held.state.contacts.clone());
                let led = near.point(&led.held).ok_or_else(lost)?;
                let led = if self.inward { led } else { led.reversed() };
                return Ok(Some(led.after(here)));
            }
            way *= 0.5;
        }
        Err(lost())
    }
}
