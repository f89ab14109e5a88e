//! Where a crest touches between two points of a curve.

use super::edges::Edges;
use crate::annuli::{Around, Crest};
use crate::continuation::{Tracer, Vector};
use crate::problem::Control;
use crate::quasistatic::Point;
use crate::quasistatic::path::Held;

/// A gap that is nothing, in waves.
pub(super) const ROUNDING: f64 = 1e-11;

/// Half the width in which a crest is followed, in waves.
const NEAR: f64 = 1.0 / 14.0;

/// A place between two points, as the share of the way.
pub(super) struct Between {
    pub share: f64,
    pub point: Point,
}

/// The point between two where `measure` vanishes, which has other signs there; `None` where it is lost.
pub(super) fn root(
    tracer: &mut Tracer<'_>,
    [from, to]: [&Point; 2],
    ends: [f64; 2],
    measure: &mut dyn FnMut(&Point) -> Option<f64>,
) -> Option<Between> {
    const ROUNDS: usize = 80;
    const NARROW: f64 = 1e-14;
    let chord: Vector = to.y() - from.y();
    let (base, square) = (chord.dot(&from.y()), chord.norm_squared());
    let (mut lo, mut f_lo, mut hi, mut f_hi) = (0.0, ends[0], 1.0, ends[1]);
    let mut best = Between { share: 1.0, point: to.clone() };
    let mut side = 0;
    for _ in 0..ROUNDS {
        // The Illinois rule, kept off the ends of its bracket.
        let mut share = (lo * f_hi - hi * f_lo) / (f_hi - f_lo);
        if !(share > lo && share < hi) {
            share = 0.5 * (lo + hi);
        }
        let moved = (share - best.share).abs();
        let point = tracer.control_value([from, to], &chord, base + share * square).ok()?;
        let f = measure(&point)?;
        best = Between { share, point };
        if f == 0.0 || moved <= NARROW || hi - lo <= NARROW {
            break;
        }
        if (f > 0.0) == (f_hi > 0.0) {
            (hi, f_hi) = (share, f);
            if side == 1 {
                f_lo *= 0.5;
            }
            side = 1;
        } else {
            (lo, f_lo) = (share, f);
            if side == -1 {
                f_hi *= 0.5;
            }
            side = -1;
        }
    }
    Some(best)
}

/// The gap near a radius, least there.
fn near(edges: &Edges<'_>, held: &Held, radius: f64) -> Crest {
    let around = Around::new(edges.ground, &held.state, held.approach);
    if radius <= 0.0 {
        return Crest { radius, gap: around.gap(0.0) };
    }
    let half = NEAR * edges.ground.wave;
    around.minimum([(radius - half).max(0.0), radius + half])
}

/// The first crest that touches on the way from one point to the next, and where; one that touches or overlaps at the start does not.
pub(super) fn first_touch(
    edges: &Edges<'_>,
    tracer: &mut Tracer<'_>,
    ends: [&Point; 2],
) -> Option<(Between, f64)> {
    let held = |point: &Point| edges.held(point, Control::Displacement);
    let [start, end] = ends.map(held);
    let (start, end) = (start?, end?);
    let around = Around::new(edges.ground, &end.state, end.approach);
    let crests = around.crests(edges.ground.can_touch_up_to(end.approach));
    let mut first: Option<(Between, f64)> = None;
    for crest in crests.into_iter().filter(|crest| crest.gap < 0.0) {
        let before = near(edges, &start, crest.radius).gap;
        if before <= ROUNDING * edges.ground.wave || before.is_nan() {
            continue;
        }
        let mut at = crest.radius;
        let mut gap = |point: &Point| {
            let crest = near(edges, &held(point)?, at);
            at = crest.radius;
            Some(crest.gap)
        };
        let Some(found) = root(tracer, ends, [before, crest.gap], &mut gap) else { continue };
        if first.as_ref().is_none_or(|(other, _)| found.share < other.share) {
            first = Some((found, at));
        }
    }
    first
}
