//! Whether contacts larger than that at a start have a smaller force, or a smaller approach, than all up to it.

use super::monotone::{Monotone, weighted};
use super::path::{Zones, place_of};
use crate::disc::{ExactSolution, Solution, Table};
use crate::problem::{Cohesion, Control, Reduced};
use crate::progress::Unwatched;
use std::sync::Arc;

/// Smaller values are looked for up to this many start radii, and waves, further out.
const REACH: f64 = 1.5;
const WAVES: f64 = 2.0;

/// Relative differences below this do not count.
const SMALLER: f64 = 1e-3;

/// The radius up to which smaller values are looked for.
fn far(problem: &Reduced, start: f64) -> f64 {
    let waves = problem.gap.feature_length().map_or(0.0, |wave| WAVES * wave);
    (REACH * start + waves).min(problem.largest_contact())
}

/// Whether a contact larger than `start` has a smaller value of what `of` prescribes than that of radius `here`, both
/// lengths, by the exact solution; under the device `held`, only where it is stable.
pub fn is_smaller_beyond(
    table: &Table,
    problem: &Reduced,
    [start, here]: [f64; 2],
    of: Control,
    held: Option<Control>,
) -> bool {
    let far = far(problem, start);
    let Ok(panels) = table.up_to(far) else { return false };
    let exact = ExactSolution::new(panels, problem.work_of_adhesion);
    let Some(here) = exact.place(here).map(|place| exact.at(place)) else { return false };
    is_smaller(&exact, [start, far], weighted(of, here.approach, here.force), (of, held))
}

/// The same for contacts smaller than `end`, a length, and the value `here` itself.
pub fn is_smaller_within(
    table: &Table,
    problem: &Reduced,
    (end, here): (f64, f64),
    of: Control,
    held: Option<Control>,
) -> bool {
    /// Of the end: smaller contacts are looked at no more.
    const SMALLEST: f64 = 1e-9;
    let Ok(panels) = table.up_to(end) else { return false };
    let exact = ExactSolution::new(panels, problem.work_of_adhesion);
    is_smaller(&exact, [SMALLEST * end, end], here, (of, held))
}

/// The same as for larger contacts where adhesion has a range, with the value `here` itself.
pub fn is_smaller_beyond_zone(
    (table, problem, law): (&Arc<Table>, &Reduced, Cohesion),
    (start, here): (f64, f64),
    of: Control,
    held: Option<Control>,
) -> bool {
    let Ok(zones) = Zones::up_to(table, law, far(problem, start), &Unwatched) else { return false };
    let solution = &*zones.solution;
    place_of(solution, start).is_some_and(|first| {
        is_smaller(solution, [solution.radius(first), solution.reach()], here, (of, held))
    })
}

/// Whether a value of what `of` prescribes is smaller than `here` somewhere between two radii.
fn is_smaller(
    solution: &dyn Solution,
    [start, far]: [f64; 2],
    here: f64,
    (of, held): (Control, Option<Control>),
) -> bool {
    let at = |along: f64| solution.place(along).map(|place| solution.at(place));
    let [Some(first), Some(last)] = [start, far].map(|along| solution.place(along)) else { return false };
    // Where what is held has its own limit, the states beside it are stable.
    let is_stable = |along: f64| {
        let device = held.filter(|device| *device != of);
        device.is_none_or(|device| {
            at(along).is_some_and(|at| weighted(device, at.slopes[0], at.slopes[1]) > 0.0)
        })
    };
    // The smallest value of a stable state lies at a limit of what is looked at, or at one of the device.
    let panels = first.panel..last.panel + 1;
    let ends = |control: Control| {
        let stretches = Monotone::on(solution, control, panels.clone()).stretches;
        stretches.into_iter().flat_map(|stretch| stretch.radii)
    };
    let own = ends(of).filter(|along| is_stable(*along));
    let of_device =
        held.filter(|device| *device != of).into_iter().flat_map(ends).filter(|along| *along < far);
    let value = |along: f64| at(along).map_or(f64::INFINITY, |at| weighted(of, at.approach, at.force));
    let least = here - SMALLER * here.abs();
    start < far && own.chain(of_device).any(|along| along > start && along <= far && value(along) < least)
}
