//! Is a formula finite up to a radius, and how short are its waves there?
//!
//! Both are looked for on a grid, uniform and near the axis geometric. A stretch where h, h' or h'' is not finite is
//! followed to its edge by bisection. A pole between two nodes of the grid is found from what causes it: a denominator,
//! the argument of a logarithm, the cosine below a tangent, where it changes its sign or touches zero.

use super::bound::Bound;
use super::fold::{Pole, Wave};
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};
use std::ops::Range;
use thiserror::Error;

/// Uniform nodes of the grid, a multiple of the block.
const NODES: usize = 4096;

/// Halvings of the first uniform interval towards the axis, a multiple of the block.
const HALVINGS: usize = 24;

/// Halvings of an interval until its ends are neighbours, or nearly.
const BISECTIONS: usize = 60;

/// What counts as zero, measured by the values at the neighbouring nodes: a parabola that touches zero is found to
/// the square of half the digits.
const ZERO: f64 = 1e-12;

/// The share of an interval that golden sections keep.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Where a formula is no gap.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{}", self.words(&UnitSystem::Reduced))]
pub struct NotFinite {
    /// The smallest radius found where h, h' or h'' is not finite: 0 if h(0) is not.
    pub radius: f64,
    /// The largest radius asked for.
    pub largest: f64,
}

impl NotFinite {
    /// What is wrong, with the radii as `units` show them.
    pub fn words(&self, units: &UnitSystem) -> String {
        let [radius, largest] = [self.radius, self.largest].map(|r| said(units, Quantity::Length, r));
        format!(
            "the formula is not finite at r = {radius} (up to r = {largest} it must be, with its slope and curvature)"
        )
    }
}

/// The grid on (0, `largest`], ascending.
pub(super) fn grid(largest: f64) -> Vec<f64> {
    let step = largest / NODES as f64;
    let halved = (1..=HALVINGS).rev().map(|k| step * 0.5f64.powi(i32::try_from(k).unwrap_or(i32::MAX)));
    halved.chain((1..=NODES).map(|k| if k == NODES { largest } else { step * k as f64 })).collect()
}

impl Bound {
    /// Whether h(0) and, for 0 < r ≤ `largest`, h, h' and h'' are finite.
    ///
    /// # Errors
    /// The smallest radius found where they are not.
    pub fn check(&self, largest: f64) -> Result<(), NotFinite> {
        let error = |radius| NotFinite { radius, largest };
        if !self.offset().is_finite() {
            return Err(error(0.0));
        }
        let radii = grid(largest);
        let whole = 0..self.steps.steps.len();
        let is_finite = |jet: &[f64; 3]| jet.iter().all(|x| x.is_finite());
        let mut first = self.operand(&whole, &radii).iter().position(|jet| !is_finite(jet)).map(|bad| {
            let good = if bad == 0 { 0.0 } else { radii[bad - 1] };
            bisect(good, radii[bad], |r| is_finite(&self.operand(&whole, &[r])[0]))
        });
        for pole in &self.steps.poles {
            if let Some(radius) = self.pole(pole, &radii) {
                first = Some(first.map_or(radius, |known| known.min(radius)));
            }
        }
        first.map_or(Ok(()), |radius| Err(error(radius)))
    }

    /// The shortest wave on (0, `largest`], a length: the smallest 2π/|dφ/dr| of the sines and cosines of φ(r).
    ///
    /// A tangent counts with its period π. A function whose argument runs through less than half a period there is
    /// no wave.
    pub fn feature_length(&self, largest: f64) -> Option<f64> {
        let radii = grid(largest);
        self.steps.waves.iter().filter_map(|wave| self.wave_length(wave, &radii)).min_by(f64::total_cmp)
    }

    fn wave_length(&self, wave: &Wave, radii: &[f64]) -> Option<f64> {
        let (mut lowest, mut highest, mut steepest) = (f64::INFINITY, f64::NEG_INFINITY, 0f64);
        for [phase, slope] in self.operand(&wave.argument, radii) {
            lowest = lowest.min(phase);
            highest = highest.max(phase);
            steepest = steepest.max(slope.abs());
        }
        let length = wave.period / steepest;
        (highest - lowest >= 0.5 * wave.period && length > 0.0).then_some(length)
    }

    /// The first pole of this kind.
    fn pole(&self, pole: &Pole, radii: &[f64]) -> Option<f64> {
        let found = |value: f64| if pole.tangent { value.cos() } else { value };
        let values = |radii: &[f64]| -> Vec<f64> {
            self.operand(&pole.argument, radii).into_iter().map(|[value]| found(value)).collect()
        };
        let at = |r: f64| values(&[r])[0];
        let values = values(radii);
        for i in 1..values.len() {
            let (before, here) = (values[i - 1], values[i]);
            let near = before.abs().max(here.abs());
            let root = if here == 0.0 {
                Some(radii[i])
            } else if before * here < 0.0 {
                Some(bisect(radii[i - 1], radii[i], |r| at(r) * before > 0.0))
            } else if i + 1 < values.len() && here.abs() <= before.abs() && here.abs() < values[i + 1].abs() {
                Some(lowest(radii[i - 1], radii[i + 1], |r| at(r).abs()))
            } else {
                None
            };
            // A jump over zero is no zero.
            if let Some(radius) = root.filter(|&r| at(r).abs() <= ZERO * near) {
                return Some(radius);
            }
        }
        None
    }

    /// The operand made by these steps, with N − 1 derivatives, at each of `radii`.
    pub(super) fn operand<const N: usize>(&self, steps: &Range<usize>, radii: &[f64]) -> Vec<[f64; N]> {
        let mut operand = Vec::with_capacity(radii.len());
        self.each(&self.steps.steps[steps.clone()], 1.0, radii, |_, jet| operand.push(jet));
        operand
    }
}

/// The first radius found where `good` no longer holds; it holds at `from` and not at `to`.
pub(super) fn bisect(mut from: f64, mut to: f64, good: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (from + to);
        if good(middle) {
            from = middle;
        } else {
            to = middle;
        }
    }
    to
}

/// Where `f`, with one minimum between the two radii, is smallest: golden sections.
fn lowest(mut from: f64, mut to: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..BISECTIONS {
        let width = GOLDEN * (to - from);
        let (left, right) = (to - width, from + width);
        if f(left) < f(right) { to = right } else { from = left }
    }
    0.5 * (from + to)
}

#[cfg(test)]
mod tests {
    use crate::contact::formula::{Bound, Formula};

    fn bound(text: &str) -> Bound {
        Formula::parse(text).unwrap().bind(&[]).unwrap()
    }

    #[test]
    fn where_a_formula_stops_being_finite() {
        for (text, radius) in [
            ("sqrt(1 - r^2)", 1.0),
            ("asin(r/0.3)", 0.3),
            ("log(0.7 - r)", 0.7),
            ("1/(r - 0.3)", 0.3),
            ("r/(r^2 - 0.09)", 0.3),
            ("1/(r - 0.3)^2", 0.3),
            ("(r - 0.3)^-2", 0.3),
            ("abs(r - 0.3)^-0.5", 0.3),
            ("log(abs(r - 0.3))", 0.3),
            ("tan(r)", std::f64::consts::FRAC_PI_2),
            ("1/(1 + cos(10*r))", std::f64::consts::PI / 10.0),
            ("1/(r - 0.3)/(r - 0.2)", 0.2),
            // There the curvature overflows, before the value does.
            ("exp(1000*r)", 0.695_967_2),
            ("1/r", 0.0),
            ("log(r)", 0.0),
            ("sin(r)/r", 0.0),
            ("0/0", 0.0),
        ] {
            let error = bound(text).check(2.0).unwrap_err();
            assert!((error.radius - radius).abs() < 1e-6, "{text}: {error}");
        }
        for text in [
            "r^2",
            "sqrt(r^2)",
            "r^1.5",
            "max(r - 0.3, 0)^1.5",
            "1/(1e-3 + (r - 0.3)^2)",
            "1/(2*step(r - 0.3001) - 1)",
            "tan(r/2)",
            "7",
        ] {
            assert_eq!(bound(text).check(2.0), Ok(()), "{text}");
        }
        assert!(bound("sqrt(1 - r^2)").check(0.99).is_ok());
    }

    #[test]
    fn the_shortest_wave() {
        for (text, expected) in [
            ("r^2", None),
            ("sin(r)", None),
            ("cos(2*pi*r/0.1)", Some(0.1)),
            ("cos(2*pi*r/0.1) + sin(2*pi*r/0.03)", Some(0.03)),
            ("sin(100*r^2)", Some(std::f64::consts::TAU / 400.0)),
            ("tan(pi*r/8)", None),
            ("1/(2 + tan(10*r)^2)", Some(std::f64::consts::PI / 10.0)),
            ("exp(-r)*cos(cos(30*r))", Some(std::f64::consts::TAU / 30.0)),
        ] {
            let found = bound(text).feature_length(2.0);
            match (found, expected) {
                (Some(found), Some(expected)) => {
                    assert!((found - expected).abs() <= 1e-3 * expected, "{text}: {found}");
                }
                _ => assert_eq!(found, expected, "{text}"),
            }
        }
    }
}
