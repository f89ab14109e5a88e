//! Where a formula is not smooth: its corners, and what it is at the axis.
//!
//! A corner comes from `abs`, `sign`, `step`, `min` or `max` and lies where the argument, or the difference of the two,
//! changes its sign. What the formula is at the axis follows from the first power of r in
//!
//! ```text
//! D = h'/r − h''  ∝  rᵐ      m = 2, 4, …: even,   m = −1, 1, …: odd,   otherwise a broken power
//! ```
//!
//! which the paraboloid leaves out.

use super::bound::Bound;
use super::fold::Corner;
use super::survey::{bisect, grid};
use crate::contact::Axis;

/// How near to a whole number m is found: what follows the first power is smaller than that at the radius looked at.
const NEAR_WHOLE: f64 = 0.05;

/// The radius looked at, as a share of the first length of the formula.
const NEAR_AXIS: f64 = 1e-2;

/// D below this share of its terms is rounding.
const ROUNDING: f64 = 1e-11;

impl Bound {
    /// The radii below `largest` where the formula has a corner, ascending.
    pub fn corners(&self, largest: f64) -> Vec<f64> {
        let radii = grid(largest);
        let mut found: Vec<f64> =
            self.steps.corners.iter().flat_map(|corner| self.crossings(corner, &radii)).collect();
        found.sort_by(f64::total_cmp);
        found.dedup();
        found
    }

    fn crossings(&self, corner: &Corner, radii: &[f64]) -> Vec<f64> {
        let values = |radii: &[f64]| -> Vec<f64> {
            let mut values: Vec<f64> =
                self.operand(&corner.argument, radii).into_iter().map(|[value]: [f64; 1]| value).collect();
            if let Some(other) = &corner.other {
                for (value, [other]) in values.iter_mut().zip(self.operand(other, radii)) {
                    *value -= other;
                }
            }
            values
        };
        let found = values(radii);
        // A zero on the grid belongs to the side it comes from; one that begins or ends there is no change of sign.
        let crosses = |i: &usize| (found[*i] > 0.0) != (found[*i + 1] > 0.0);
        (0..radii.len() - 1)
            .filter(crosses)
            .map(|i| bisect(radii[i], radii[i + 1], |r| (values(&[r])[0] > 0.0) == (found[i] > 0.0)))
            .collect()
    }

    /// What the formula is at the axis, where `length` is the first length of it.
    pub fn axis(&self, length: f64) -> Axis {
        let r = NEAR_AXIS * length;
        let [near, far] = [r, 2.0 * r].map(|r| {
            let jet = self.jet(r);
            let (a, b) = (jet.first / r, jet.second);
            if (a - b).abs() <= ROUNDING * (a.abs() + b.abs()) { 0.0 } else { a - b }
        });
        if near == 0.0 || far == 0.0 {
            return Axis::Even;
        }
        let power = (far / near).abs().log2();
        let whole = power.round();
        if (power - whole).abs() > NEAR_WHOLE {
            return Axis::Broken;
        }
        // 0 belongs to r² log r.
        if whole == 0.0 {
            Axis::Broken
        } else if whole % 2.0 == 0.0 {
            Axis::Even
        } else {
            Axis::Odd
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::contact::Axis;
    use crate::contact::formula::{Bound, Formula};

    fn bound(text: &str) -> Bound {
        Formula::parse(text).unwrap().bind(&[]).unwrap()
    }

    #[test]
    fn corners_are_found_to_rounding() {
        for (text, expected) in [
            ("r^2 + abs(r - 0.3)", &[0.3][..]),
            ("max(r - 0.25, 0)^2", &[0.25]),
            ("min(r, 1 - r) + abs(r - 0.2)", &[0.2, 0.5]),
            ("r^2*step(r - 0.7)", &[0.7]),
            ("abs(sin(pi*r/0.4))", &[0.4, 0.8, 1.2, 1.6]),
            ("r^2 + abs(r)", &[]),
            ("0*abs(r - 0.3) + r", &[]),
        ] {
            let found = bound(text).corners(1.7);
            assert_eq!(found.len(), expected.len(), "{text}: {found:?}");
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-14, "{text}: {found}");
            }
        }
    }

    #[test]
    fn the_axis_is_known_by_its_first_power() {
        for (text, axis) in [
            ("r^2/2", Axis::Even),
            ("3", Axis::Even),
            ("r^4", Axis::Even),
            ("r^2/2 + 0.001*(1 - cos(100*r))", Axis::Even),
            ("1 - sqrt(1 - r^2)", Axis::Even),
            ("0.2*r", Axis::Odd),
            ("r^2 + 0.01*r^3", Axis::Odd),
            ("r^2 + 0.01*sin(30*r)", Axis::Odd),
            ("r^1.5", Axis::Broken),
            ("r^2 + 0.1*r^2.5", Axis::Broken),
            ("r^3.3", Axis::Broken),
        ] {
            let length = bound(text).feature_length(1.0).unwrap_or(1.0);
            assert_eq!(bound(text).axis(length), axis, "{text}");
        }
    }
}
