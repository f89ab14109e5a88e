//! The same branch from an explicit curve, where the problem offers one.
//!
//! Points at given parameters need no correction; frames come from the same exact derivatives, so events,
//! location and everything after them do not know which tracer made the branch.

use super::branch::{Branch, Point, Work};
use super::step_size;
use super::system::{Linearization, Vector};

/// A branch through explicit points in the order given.
///
/// `forward` is the direction in which the branch runs at its first point. The sweep ends early,
/// keeping what it has, when `explicit` has no further point or `go_on` says no.
pub fn sweep<P, const N: usize>(
    parameters: impl IntoIterator<Item = P>,
    mut explicit: impl FnMut(P) -> Option<(Vector<N>, Linearization<N>)>,
    forward: &Vector<N>,
    mut go_on: impl FnMut(&Branch<N>) -> bool,
) -> Branch<N> {
    let mut branch = Branch { points: Vec::new(), work: Work::default() };
    for parameter in parameters {
        if !go_on(&branch) {
            break;
        }
        branch.work.evaluations += 1;
        let Some((y, linearization)) = explicit(parameter) else { break };
        let Some(mut point) = Point::new(y, &linearization, forward) else { break };
        if let Some(last) = branch.points.last() {
            if point.frame.positive != last.frame.positive {
                point = point.reversed();
            }
            point.length = (point.y - last.y).norm();
            point.turning = step_size::turning(last, &point);
        }
        branch.points.push(point);
    }
    branch
}
