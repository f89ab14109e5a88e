//! The places of the states with which a curve is drawn.

use crate::disc::{Place, Solution};

/// States drawn on each panel of the solution, which is half a wave wide.
const STATES_PER_PANEL: f64 = 20.0;
/// Largest step between states relative to the radius: the curve behaves like √s towards s = 0.
const RATIO: f64 = 0.025;
/// Most states of a curve.
pub const MOST_STATES: f64 = 20_000.0;

/// Radii from `from` inward to `to`, both included, in steps of at most `ratio` of themselves and `step`.
pub fn radii(from: f64, to: f64, ratio: f64, step: f64) -> Vec<f64> {
    // If there would be too many steps they grow, so that the last one is still at `to`.
    let step = step.max(2.0 * (from - to) / MOST_STATES);
    // A panel beside a corner may be a few units in the last place wide, and steps within it change nothing.
    let inner =
        std::iter::successors(Some(from), |s| Some(s - (ratio * s).min(step)).filter(|next| next < s));
    let mut radii: Vec<f64> = inner.take_while(|s| *s > to).collect();
    radii.push(to);
    radii
}

/// How many states a curve has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// Enough to be drawn.
    Drawn,
    /// Only those between panels, where only limit points and unloadings are wanted.
    Borders,
}

/// The places of a curve's states from the radius `from` inward to `to`: the same number on every panel of the
/// solution, and both sides of a border at which it has a corner.
pub fn places(solution: &dyn Solution, from: f64, to: f64, detail: Detail) -> Vec<Place> {
    let [first, last] = [from, to].map(|s| solution.place(s));
    let Some(first) = first else { return Vec::new() };
    let last = last.map_or(0, |place| place.panel);
    let per_panel = (MOST_STATES / (first.panel + 1 - last) as f64).clamp(1.0, STATES_PER_PANEL);
    let mut places = vec![first];
    for panel in (last..=first.panel).rev() {
        let span = solution.span(panel);
        let (outer, inner) = (span.hi.min(from), span.lo.max(to));
        let steps = match detail {
            Detail::Drawn => radii(outer, inner, RATIO, (span.hi - span.lo) / per_panel),
            Detail::Borders => Vec::new(),
        };
        let inside = steps.iter().skip(1).take(steps.len().saturating_sub(2));
        places.extend(inside.map(|s| Place { panel, x: span.place(*s) }));
        // The outer side of a border that is a corner, and then the border itself.
        let corner = solution.at(Place { panel, x: -1.0 }).stretch == 0.0;
        if inner > to && corner {
            places.push(Place { panel, x: -1.0 });
        }
        if inner > to && panel > last {
            places.push(Place { panel: panel - 1, x: 1.0 });
        } else if inner <= to {
            places.push(Place { panel, x: span.place(to) });
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::radii;

    #[test]
    fn steps_below_the_last_digit_end() {
        let outer = 0.1_f64.next_up();
        assert_eq!(radii(outer, 0.1, 0.025, 1e-18), [outer, 0.1]);
        let even = radii(2.0, 1.0, 1.0, 0.25);
        assert_eq!(even, [2.0, 1.75, 1.5, 1.25, 1.0]);
    }
}
