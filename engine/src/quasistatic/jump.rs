//! Where the edge lands when it runs at constant control.
//!
//! When the edge runs inward from a minimum, the control first rises above its value, and the edge lands on the first
//! stretch further in on which the control falls back to it. When it runs outward, it lands on the first stretch on
//! which the control rises back. Either way the control grows with s there, which is stability. The edge also lands on
//! a stretch whose own minimum equals the value to rounding. A narrow hole is passed where the control drives the edge
//! on both sides of it.

use super::monotone::Monotone;
use crate::disc::{Place, Solution};

/// Which way the edge runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EdgeDirection {
    /// The contact shrinks.
    Inward,
    /// The contact grows.
    Outward,
}

/// A landing: the state, and the number of the stretch it is on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landing {
    /// The stable state.
    pub place: Place,
    /// The stretch.
    pub stretch: usize,
}

/// Values this near to each other, relative to their size, count as equal.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Runs from the stretch `from` at the weighted control `value` to the next stable state; `None` when the curve has none in
/// that direction.
///
/// # Errors
/// The radius at which the curve ends before the landing is known.
pub fn run(
    solution: &dyn Solution,
    monotone: &Monotone,
    from: usize,
    value: f64,
    run: EdgeDirection,
) -> Result<Option<Landing>, f64> {
    let stretches = &monotone.stretches;
    let slack = ROUNDING * value.abs();
    let land = |at: usize| {
        let place = monotone.solve(solution, &stretches[at], value);
        Landing { place, stretch: at }
    };
    match run {
        EdgeDirection::Inward => {
            for at in (0..from).rev() {
                let [next, here] = [&stretches[at], &stretches[at + 1]];
                let passes = here.joined
                    || solution.is_passed(next.outer.panel) && next.values[1].min(here.values[0]) > value;
                if !passes {
                    return Err(here.radii[0]);
                }
                if stretches[at].rising && stretches[at].values[0] <= value + slack {
                    return Ok(Some(land(at)));
                }
            }
            Ok(None)
        }
        EdgeDirection::Outward => {
            for (at, stretch) in stretches.iter().enumerate().skip(from + 1) {
                let before = &stretches[at - 1];
                let passes = stretch.joined
                    || solution.is_passed(before.outer.panel)
                        && before.values[1].max(stretch.values[0]) < value;
                if !passes {
                    return Err(stretch.radii[0]);
                }
                if stretch.rising && stretch.values[1] >= value - slack {
                    return Ok(Some(land(at)));
                }
            }
            Ok(None)
        }
    }
}
