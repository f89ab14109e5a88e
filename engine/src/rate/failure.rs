//! How long a disc bears a dead load: no equation of motion is needed, because the force is held.
//!
//! ```text
//! t = ∫₀^{s₀} ds/v(s)      v = v₀ (G/γ − 1)^{1/n}      G at the radius s under the force P
//! ```
//!
//! Where an equilibrium bears the load the edge stops there, and the bodies never come apart.

use super::caps::MotionFolds;
use super::equation::{HeldDisc, MovingEdge};
use super::error::RateError;
use super::law::Motion;
use crate::disc::Panels;
use crate::problem::Control;
use crate::quasistatic::monotone::Extremum;
use std::f64::consts::TAU;
use std::sync::Arc;

/// The relative error of the time.
const TOLERANCE: f64 = 1e-10;
/// The most halvings of an interval, and the most intervals in all: the nearer the load is to being borne, the
/// narrower the bottleneck.
const DEEPEST: u32 = 60;
const INTERVALS: usize = 200_000;
/// A load beyond one that is borne by no more than this share is borne: the two are the same but for rounding.
const ROUNDING: f64 = 1e-12;
/// The edge is gone at this share of the radius at which it starts; it passes the rest in no time.
const GONE: f64 = 1e-9;

/// The time, in units of the length over v₀, until the bodies are apart, from the radius `start` under the dead load
/// `force`, which is negative for a pull; `None` where an equilibrium bears it. Reduced units.
///
/// # Errors
/// [`RateError::NoAdhesion`]; [`RateError::Lost`] where the load is so nearly borne that the time cannot be resolved.
pub fn time_to_failure(
    panels: &Arc<Panels>,
    edge: &MovingEdge,
    start: f64,
    force: f64,
) -> Result<Option<f64>, RateError> {
    if edge.opening <= 0.0 {
        return Err(RateError::NoAdhesion);
    }
    let folds = MotionFolds::new(panels, edge, Motion::Opening, Control::Force);
    let inside = folds.list.iter().map(|fold| fold.limit).filter(|limit| limit.contact_radius < start);
    let least = inside.clone().filter(|limit| limit.turn == Extremum::Minimum).map(|limit| limit.force);
    let borne =
        least.fold(HeldDisc::equilibrium(panels, Control::Force, edge.opening, start).min(0.0), f64::min);
    if force >= borne * (1.0 + ROUNDING) {
        return Ok(None);
    }
    let branch = edge.law.of(Motion::Opening);
    let slowness = |s: f64| {
        let held = HeldDisc::new(panels, Control::Force, s, force);
        let root = (TAU * edge.opening * s).sqrt();
        1.0 / branch.speed((held.opening - root) * (held.opening + root) / (root * root))[0]
    };
    let mut borders: Vec<f64> =
        [GONE * start, start].into_iter().chain(inside.map(|limit| limit.contact_radius)).collect();
    borders.sort_by(f64::total_cmp);
    let mut sum = 0.0;
    for pair in borders.windows(2) {
        sum += integral(&slowness, [pair[0], pair[1]]).ok_or(RateError::Lost { contact_radius: pair[1] })?;
    }
    Ok(Some(sum))
}

/// ∫f over an interval by Simpson's rule, halved until it settles.
fn integral(f: &dyn Fn(f64) -> f64, [from, to]: [f64; 2]) -> Option<f64> {
    /// An interval: its ends and its middle with the values there, and how many times it was halved.
    struct Part([f64; 3], [f64; 3], u32);
    let part = |a: f64, b: f64, fa: f64, fb: f64, depth| {
        let middle = f64::midpoint(a, b);
        Part([a, middle, b], [fa, f(middle), fb], depth)
    };
    let simpson = |Part([a, _, b], [fa, fm, fb], _): &Part| (b - a) / 6.0 * (fa + 4.0 * fm + fb);
    let mut open = vec![part(from, to, f(from), f(to), 0)];
    let mut sum = 0.0;
    let mut seen = 0;
    // The sum so far and what is still open give the size of the whole.
    let mut size = simpson(&open[0]).abs();
    while let Some(whole) = open.pop() {
        seen += 1;
        let Part([a, middle, b], [fa, fm, fb], depth) = whole;
        let halves = [part(a, middle, fa, fm, depth + 1), part(middle, b, fm, fb, depth + 1)];
        let (coarse, fine) = (simpson(&whole), simpson(&halves[0]) + simpson(&halves[1]));
        if !fine.is_finite() || seen > INTERVALS {
            return None;
        }
        size = size.max(sum + fine.abs());
        let share = TOLERANCE * size * ((b - a) / (to - from)).sqrt();
        if depth > 4 && (fine - coarse).abs() <= 15.0 * share || depth >= DEEPEST {
            sum += fine + (fine - coarse) / 15.0;
        } else {
            open.extend(halves);
        }
    }
    Some(sum)
}
