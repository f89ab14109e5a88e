//! Whether contacts larger than that at a start have a smaller force, or a smaller approach, than all up to it.

use super::monotone::{Monotone, weighted};
use crate::disc::{ExactSolution, Solution, Table};
use crate::problem::{Control, Reduced};

/// Smaller values are looked for up to this many start radii, and waves, further out.
const REACH: f64 = 1.5;
const WAVES: f64 = 2.0;

/// Relative differences below this do not count.
const SMALLER: f64 = 1e-3;

/// Whether a contact larger than `start` has a smaller value of what `of` prescribes than that of radius `here`, both
/// lengths, by the exact solution; under the device `held`, only where it is stable.
pub fn is_smaller_beyond(
    table: &Table,
    problem: &Reduced,
    [start, here]: [f64; 2],
    of: Control,
    held: Option<Control>,
) -> bool {
    let waves = problem.gap.feature_length().map_or(0.0, |wave| WAVES * wave);
    let far = (REACH * start + waves).min(problem.largest_contact());
    let Ok(panels) = table.up_to(far) else { return false };
    let exact = ExactSolution::new(panels, problem.work_of_adhesion);
    let at = |s: f64| exact.place(s).map(|place| exact.at(place));
    let Some(here) = at(here).map(|here| weighted(of, here.approach, here.force)) else { return false };
    let [Some(first), Some(last)] = [start, far].map(|s| exact.place(s)) else { return false };
    // Where what is held has its own limit, the states beside it are stable.
    let is_stable = |s: f64| {
        let device = held.filter(|device| *device != of);
        device.is_none_or(|device| at(s).is_some_and(|at| weighted(device, at.slopes[0], at.slopes[1]) > 0.0))
    };
    // The smallest value of a stable state lies at a limit of what is looked at, or at one of the device.
    let panels = first.panel..last.panel + 1;
    let ends = |control: Control| {
        let stretches = Monotone::on(&exact, control, panels.clone()).stretches;
        stretches.into_iter().flat_map(|stretch| stretch.radii)
    };
    let own = ends(of).filter(|s| is_stable(*s));
    let of_device = held.filter(|device| *device != of).into_iter().flat_map(ends).filter(|s| *s < far);
    let value = |s: f64| at(s).map_or(f64::INFINITY, |at| weighted(of, at.approach, at.force));
    let least = here - SMALLER * here.abs();
    start < far && own.chain(of_device).any(|s| s > start && s <= far && value(s) < least)
}
