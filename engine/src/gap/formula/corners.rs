//! Where a formula is not smooth: its breaks, and what it is at the axis.
//!
//! A formula may not be smooth where one of these is zero: the argument of `abs`, `sign` or `step`, the difference that
//! `min` and `max` compare, or the radicand of a root, a broken power or a logarithm. Let u be such a quantity, bounded
//! together with its slope on intervals of the radius, from their middles (`discs`):
//!
//! - if u is not zero on the interval, or does not change, there is no break;
//! - if u' is not zero, there is at most one, found by bisection to the last bit;
//! - otherwise the interval is halved. What is still open at 2e-15 of the largest radius is taken for a break.
//!
//! So none is missed, however close it is to another. The parity of the formula at the axis follows from the first
//! power of r in
//!
//! ```text
//! D = h'/r − h''  ∝  rᵐ      m = 2, 4, …: even,   m = −1, 1, …: odd,   otherwise a broken power
//! ```
//!
//! which does not depend on the paraboloid.

use super::bound::Bound;
use super::fold::{Switch, Zero};
use super::survey::NARROW;
use crate::elementary::log2;
use crate::gap::Parity;
use crate::gap::function::MOST_BREAKS;
use crate::root;

/// The number of intervals to begin with.
const FIRST: usize = 16;

/// The largest number of intervals open at a time: with more, u is zero nearly everywhere.
const MOST_OPEN: usize = 1 << 17;

/// The number of Newton steps that lead from an interval on which u is nearly straight to rounding, and the error left
/// then, as a share of the radius.
const NEWTON_STEPS: usize = 6;
const MARGIN: f64 = 8.0 * f64::EPSILON;

/// Breaks closer than this to each other or to the axis, as a share of the largest radius, count as one.
const ONE: f64 = 1e-13;

/// How close m must be to a whole number: what follows the first power is smaller than that at the radius used.
const NEAR_WHOLE: f64 = 0.05;

/// The radius used, as a share of the first length of the formula.
const NEAR_AXIS: f64 = 1e-2;

/// D below this share of its terms is rounding.
const ROUNDING: f64 = 1e-11;

/// A radius where the formula may not be smooth.
#[derive(Debug, Clone, Copy)]
struct Break {
    radius: f64,
    /// Whether it is known to the last bit.
    exact: bool,
}

impl Bound {
    /// The radii below `to` where the formula may not be smooth, ascending: at each, the formula is for the first time
    /// no longer what it was before. Superfluous ones are possible.
    ///
    /// If there are more than [`MOST_BREAKS`], or if u is zero nearly everywhere, the list holds what was found until
    /// then.
    pub fn breaks(&self, to: f64) -> Vec<f64> {
        let mut found: Vec<Break> =
            self.steps.switches.iter().flat_map(|switch| self.isolate(switch, to)).collect();
        found.retain(|b| b.radius > ONE * to && b.radius < to);
        found.sort_by(|a, b| a.radius.total_cmp(&b.radius));
        let mut breaks: Vec<Break> = Vec::new();
        for next in found {
            match breaks.last_mut() {
                Some(last) if next.radius - last.radius <= ONE * to => {
                    if next.exact && !last.exact {
                        *last = next;
                    }
                }
                _ => breaks.push(next),
            }
        }
        breaks.truncate(MOST_BREAKS);
        breaks.into_iter().map(|b| b.radius).collect()
    }

    fn isolate(&self, switch: &Switch, to: f64) -> Vec<Break> {
        let border = |i: usize| to * (i as f64 / FIRST as f64);
        let mut open: Vec<[f64; 2]> = (0..FIRST).map(|i| [border(i), border(i + 1)]).collect();
        let (mut found, mut narrow) = (Vec::new(), Vec::<[f64; 2]>::new());
        while !open.is_empty() && open.len() <= MOST_OPEN && found.len() <= MOST_BREAKS {
            let mut halves = Vec::new();
            for [lo, hi] in open {
                let u = self.switch_on(switch, [lo, hi]);
                if u.value.excludes_zero() || u.does_not_change() {
                    continue;
                }
                if u.slope.excludes_zero() {
                    found.extend(self.crossing(switch, [lo, hi]));
                } else if hi - lo > NARROW * to {
                    let middle = 0.5 * (lo + hi);
                    halves.extend([[lo, middle], [middle, hi]]);
                } else {
                    match narrow.last_mut() {
                        Some(last) if lo - last[1] <= NARROW * to => last[1] = hi,
                        _ => narrow.push([lo, hi]),
                    }
                }
            }
            open = halves;
        }
        found.extend(narrow.into_iter().map(|[lo, hi]| {
            let margin = NARROW * to;
            self.place(switch, [(lo - margin).max(0.0), (hi + margin).min(to)])
        }));
        found
    }

    /// The zero of u, if it has one, on an interval on which it rises or falls throughout.
    fn crossing(&self, switch: &Switch, [lo, hi]: [f64; 2]) -> Option<Break> {
        let u = |r: f64| self.zero(switch, r)[0];
        let [before, after] = [lo, hi].map(u);
        let (exact, width) = (|radius| Break { radius, exact: true }, hi - lo);
        // A zero at an end may be rounding beside a place where u only touches zero; whether u changes sign there
        // decides. Of the two intervals that meet at that end, the shorter one sees no other zero.
        for (end, value) in [(lo, before), (hi, after)] {
            if value == 0.0 {
                return (end >= width && u(end - width) * u(end + width).signum() < 0.0).then(|| exact(end));
            }
        }
        let sign = before.signum();
        if sign * after >= 0.0 || before.is_nan() || after.is_nan() {
            return None;
        }
        let is_before = |r: f64| u(r) * sign > 0.0;
        // Newton's steps come close and bisection finishes. Where they do not come close, it starts from the whole
        // interval.
        let mut near = 0.5 * (lo + hi);
        for _ in 0..NEWTON_STEPS {
            let [value, slope] = self.zero(switch, near);
            near = (near - value / slope).clamp(lo, hi);
        }
        let around = [(near - MARGIN * near).max(lo), (near + MARGIN * near).min(hi)];
        let [from, to] = if is_before(around[0]) && !is_before(around[1]) { around } else { [lo, hi] };
        Some(exact(root::halved(from, to, is_before)[1]))
    }

    /// The break in an interval a few units in the last place wide.
    fn place(&self, switch: &Switch, [lo, hi]: [f64; 2]) -> Break {
        let (before, after) = (self.zero(switch, lo), self.zero(switch, hi));
        // u jumps, or touches zero where its slope changes sign.
        for n in 0..2 {
            let sign = before[n].signum();
            if before[n] != 0.0 && sign * after[n] < 0.0 {
                let radius = root::halved(lo, hi, |r| self.zero(switch, r)[n] * sign > 0.0)[1];
                return Break { radius, exact: true };
            }
        }
        Break { radius: 0.5 * (lo + hi), exact: false }
    }

    /// u and u'.
    fn zero(&self, switch: &Switch, r: f64) -> [f64; 2] {
        let at = |steps| self.operand::<2>(steps, &[r])[0];
        let [x, x1] = at(&switch.argument);
        let [y, y1] = switch.other.as_ref().map_or([0.0; 2], at);
        match switch.zero {
            Zero::Difference => [x - y, x1 - y1],
            Zero::Squares => [x * x + y * y, 2.0 * (x * x1 + y * y1)],
            Zero::Unit => [1.0 - x * x, -2.0 * x * x1],
        }
    }

    /// The parity of the formula at the axis; `length` is the first length of the formula.
    pub fn axis(&self, length: f64) -> Parity {
        let r = NEAR_AXIS * length;
        let [near, far] = [r, 2.0 * r].map(|r| {
            let jet = self.jet(r);
            let (a, b) = (jet.first / r, jet.second);
            if (a - b).abs() <= ROUNDING * (a.abs() + b.abs()) { 0.0 } else { a - b }
        });
        if near == 0.0 || far == 0.0 {
            return Parity::Even;
        }
        let power = log2((far / near).abs());
        let whole = power.round();
        if (power - whole).abs() > NEAR_WHOLE {
            return Parity::Broken;
        }
        // 0 belongs to r² log r.
        if whole == 0.0 {
            Parity::Broken
        } else if whole % 2.0 == 0.0 {
            Parity::Even
        } else {
            Parity::Odd
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::gap::Parity;
    use crate::gap::{formula::Bound, formula::Formula};

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
            let found = bound(text).breaks(1.7);
            assert_eq!(found.len(), expected.len(), "{text}: {found:?}");
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-14, "{text}: {found}");
            }
        }
    }

    #[test]
    fn breaks_are_found_to_the_last_bit() {
        for (text, expected) in [
            ("r^2 + abs(r - 0.3)", &[0.3][..]),
            ("r^2/2 + 0.07*abs(r-0.12)", &[0.12]),
            ("max(r - 0.3, 0)^1.5", &[0.3]),
            ("abs(r - 0.3)^1.5", &[0.3]),
            ("sqrt((r - 0.3)^2)", &[0.3]),
            ("sqrt(abs(r - 0.3))", &[0.3]),
            ("hypot(r - 0.3, 0)", &[0.3]),
            ("sign(r - 0.3)*(r - 0.3)^2", &[0.3]),
            ("(r - 0.3)^2*log(abs(r - 0.3))", &[0.3]),
            ("step(sign(r - 0.3))", &[0.3]),
            // Closer together than the nodes of a grid of 4096, and between them.
            ("abs(r - 0.3) + abs(r - 0.30001)", &[0.3, 0.30001]),
            ("max(1e-9 - abs(r - 0.3), 0)", &[0.3 - 1e-9, 0.3, 0.3 + 1e-9]),
            ("0.5*max(0.0008 - abs(r-0.3), 0)", &[0.2992, 0.3, 0.3008]),
            ("max(abs(r - 0.7) - 0.1, 0) + min(r, 0.2)", &[0.2, 0.6, 0.7, 0.8]),
            ("abs(abs(abs(r - 0.5) - 0.25) - 0.125)", &[0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875]),
            // Touching zero, with rounding beside it.
            ("abs(1 - cos(2*pi*(r - 0.75)))", &[0.75]),
            ("abs(1 - cos(r))", &[]),
            ("sqrt(r^2) + abs(r) + r^1.5", &[]),
            ("r^2 + abs(1 + r^2) + sqrt(1 + r) + max(r, -1)", &[]),
        ] {
            let found = bound(text).breaks(1.7);
            assert_eq!(found.len(), expected.len(), "{text}: {found:?}");
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() <= 1.2e-16, "{text}: {found} {expected}");
            }
        }
    }

    #[test]
    fn breaks_are_the_first_radius_on_the_other_side() {
        for (text, u) in [
            ("abs(sin(pi*r/0.0137))", "sin(pi*r/0.0137)"),
            ("abs(r^3 - 0.2)", "r^3 - 0.2"),
            ("max(exp(-r), r)", "exp(-r) - r"),
        ] {
            let (found, u) = (bound(text).breaks(1.7), bound(u));
            assert!(!found.is_empty());
            for r in found {
                let [before, here] = [r.next_down(), r].map(|r| u.jet(r).value + u.offset());
                assert!(before != 0.0 && before.signum() * here <= 0.0, "{text} at {r}: {before} {here}");
            }
        }
        assert_eq!(bound("abs(sin(pi*r/0.0137))").breaks(1.7).len(), 124);
    }

    #[test]
    fn endless_corners_come_to_an_end() {
        // Corners gather at 0.5 without end; two equal operands are compared everywhere.
        let found = bound("abs(sin(1/abs(r - 0.5)))").breaks(1.0);
        assert!(found.len() > 1000 && found.windows(2).all(|pair| pair[0] < pair[1]), "{}", found.len());
        bound("max(r^2, r*r)").breaks(1.0);
    }

    #[test]
    fn the_axis_is_known_by_its_first_power() {
        for (text, axis) in [
            ("r^2/2", Parity::Even),
            ("3", Parity::Even),
            ("r^4", Parity::Even),
            ("r^2/2 + 0.001*(1 - cos(100*r))", Parity::Even),
            ("1 - sqrt(1 - r^2)", Parity::Even),
            ("0.2*r", Parity::Odd),
            ("r^2 + 0.01*r^3", Parity::Odd),
            ("r^2 + 0.01*sin(30*r)", Parity::Odd),
            ("r^1.5", Parity::Broken),
            ("r^2 + 0.1*r^2.5", Parity::Broken),
            ("r^3.3", Parity::Broken),
        ] {
            let length = bound(text).feature_length(1.0).unwrap_or(1.0);
            assert_eq!(bound(text).axis(length), axis, "{text}");
        }
    }
}
