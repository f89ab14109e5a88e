//! The range of both axes: always finite, always ascending.

use crate::explorer::Window;

/// The range of both axes, ascending and finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    pub x: [f64; 2],
    pub y: [f64; 2],
}

/// The margin around the points, as a share of their range.
const ROOM: f64 = 0.04;

/// At least this many doubles must be distinguishable across a range; on a narrower one there is nothing to see.
const PLACES: f64 = 1e3;

/// Values that differ by no more than this share of the largest are equal: what they differ by is rounding.
const EQUAL: f64 = 1e-9;

/// How much further a range reaches above its only value than below.
const OFF_MIDDLE: f64 = 1.05;

impl Bounds {
    /// The range of `points` with a small margin; finite and ascending whatever the points are.
    pub fn of(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let empty = [f64::INFINITY, f64::NEG_INFINITY];
        let (mut x, mut y) = (empty, empty);
        for (px, py) in points {
            if px.is_finite() && py.is_finite() {
                x = [x[0].min(px), x[1].max(px)];
                y = [y[0].min(py), y[1].max(py)];
            }
        }
        Self { x: roomy(x), y: roomy(y) }
    }

    /// The part of these bounds inside `window`.
    #[must_use]
    pub fn part(&self, window: &Window) -> Self {
        if window.is_whole() {
            return *self;
        }
        let part = |[lo, hi]: [f64; 2], [from, to]: [f64; 2]| {
            let range = hi - lo;
            let middle = lo + range * (0.5 * from + 0.5 * to);
            let least = PLACES * f64::EPSILON * lo.abs().max(hi.abs()).max(middle.abs());
            let half = 0.5 * (range * (to - from)).max(least).max(f64::MIN_POSITIVE);
            let part = [middle - half, middle + half];
            if part[0].is_finite() && part[1].is_finite() && part[0] < part[1] { part } else { [lo, hi] }
        };
        Self { x: part(self.x, window.x), y: part(self.y, window.y) }
    }

    /// The position of a point as shares of the range, 0 and 1 at the ends; `None` outside.
    pub fn share(&self, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        let share = |[lo, hi]: [f64; 2], value: f64| {
            let share = (value - lo) / (hi - lo);
            (0.0..=1.0).contains(&share).then_some(share)
        };
        Some((share(self.x, x)?, share(self.y, y)?))
    }

    /// The point at a position given as shares of the range.
    pub fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let at = |[lo, hi]: [f64; 2], share: f64| lo + (hi - lo) * share;
        (at(self.x, x), at(self.y, y))
    }
}

/// Whether a range is that of one value, to rounding.
pub fn is_level([lo, hi]: [f64; 2]) -> bool {
    hi - lo <= EQUAL * lo.abs().max(hi.abs())
}

fn roomy([lo, hi]: [f64; 2]) -> [f64; 2] {
    if !(lo.is_finite() && hi.is_finite()) {
        return [0.0, 1.0];
    }
    let range = hi - lo;
    if !range.is_finite() || is_level([lo, hi]) {
        let half = (0.5 * lo.abs()).max(0.5 * hi.abs());
        let half = if half > 0.0 && half.is_finite() { half } else { 0.5 };
        // Not in the middle: there the least rounding would move a level line from one row of dots to the next.
        return [0.5 * lo + 0.5 * hi - half, 0.5 * lo + 0.5 * hi + OFF_MIDDLE * half];
    }
    [lo - ROOM * range, hi + ROOM * range]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_finite_and_ascending_for_any_points_and_window() {
        let mut deepest = Window::WHOLE;
        while let Some(closer) = deepest.zoomed(2.0, (1.0, 0.0)) {
            deepest = closer;
        }
        let mut widest = Window::WHOLE;
        while let Some(wider) = widest.zoomed(0.5, (0.1, 0.6)) {
            widest = wider.moved(1.0, -1.0);
        }
        for points in [
            vec![],
            vec![(f64::NAN, 1.0)],
            vec![(1.0, 2.0)],
            vec![(0.0, 0.0), (0.0, 0.0)],
            vec![(-1e300, 1e300), (1e300, -1e300)],
            vec![(1.0, f64::INFINITY), (2.0, 3.0)],
            vec![(1.0, 1e-300), (1.0 + 1e-15, 2e-300)],
            // A constant, to rounding.
            vec![(0.0, -1.0), (1.0, -1.0 - 1e-12)],
        ] {
            let whole = Bounds::of(points.clone());
            for Bounds { x, y } in [whole, whole.part(&deepest), whole.part(&widest)] {
                for [lo, hi] in [x, y] {
                    assert!(lo.is_finite() && hi.is_finite() && lo < hi, "{points:?}: {lo} {hi}");
                }
            }
            let of_rounding = points.contains(&(1.0, -1.0 - 1e-12));
            assert!(!of_rounding || whole.y[1] - whole.y[0] > 0.1, "{whole:?}");
        }
    }

    #[test]
    fn a_place_and_its_shares_belong_together() {
        let bounds = Bounds { x: [-1.0, 3.0], y: [2.0, 4.0] };
        assert_eq!(bounds.at((0.25, 0.5)), (0.0, 3.0));
        assert_eq!(bounds.share((0.0, 3.0)), Some((0.25, 0.5)));
        assert_eq!(bounds.share((0.0, 5.0)), None);
        let window = Window { x: [0.5, 1.0], y: [0.0, 0.5] };
        assert_eq!(bounds.part(&window), Bounds { x: [1.0, 3.0], y: [2.0, 3.0] });
    }
}
