//! The way up a solution at a slowly rising control: from the first touch to where the edge lands, along the curve to the next
//! maximum of the control, from there outward to where the edge lands, and on.
//!
//! One disc alone: where a crest outside touches on the way, rings of contact take another one, see [`path`](super::path).

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

/// The stable pieces of the way up of bodies that touch where the weighted control is `touch`, as far as the first whose outer end
/// `enough` says is far enough, or as the solution goes. Empty where nothing is stable after the touch.
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
