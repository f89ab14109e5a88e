//! The way up a solution at a slowly rising control: from the first touch to where the edge lands, along the curve to
//! the next maximum of the control, from there outward to where the edge lands, and so on.
//!
//! This is for one disc alone. Where a crest outside touches on the way, rings of contact take a different way, see
//! [`path`](super::path).

use super::jump::{self, EdgeDirection, Landing};
use super::monotone::Monotone;
use crate::disc::{Local, Place, Solution};

/// A stable piece of the way up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rise {
    /// Where the edge lands.
    pub landing: Landing,
    /// The outer end: a maximum of the control, or where the solution ends.
    pub end: Place,
}

/// The stable pieces of the way up for bodies that touch where the weighted control is `touch`: up to the first piece
/// whose outer end is far enough according to `enough`, or to the end of the solution. Empty where nothing is stable
/// after the touch.
pub fn ascend(
    solution: &dyn Solution,
    monotone: &Monotone,
    touch: f64,
    enough: &dyn Fn(&Local) -> bool,
) -> Vec<Rise> {
    let mut rises = Vec::new();
    let run = |from, value| jump::run(solution, monotone, from, value, EdgeDirection::Outward).ok().flatten();
    let mut here = run(0, touch);
    while let Some(landing) = here {
        let stretch = &monotone.stretches[landing.stretch];
        rises.push(Rise { landing, end: stretch.outer });
        if enough(&solution.at(stretch.outer)) {
            break;
        }
        here = run(landing.stretch, stretch.values[1]);
    }
    rises
}
