//! Is a formula finite up to a radius, and how short are its waves there?
//!
//! Both questions are answered by bounds on intervals (`discs`). An interval on which h and h' have a bound is done;
//! any other is halved. Where there is still no bound at a width of a few units in the last place, h and h' beside the
//! place decide: either they are not finite, or they grow without limit towards it, or it is a corner or a branch point
//! that they pass. A curvature that overflows before the slope does is noticed in the middles of the intervals, and its
//! edge is found by bisection.

use super::bound::Bound;
use super::fold::{FormulaStep, FormulaWave};
use crate::expression::function::Unary;
use crate::root;
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};
use std::ops::Range;
use thiserror::Error;

/// The width at which an interval is no longer halved, as a share of the largest radius.
pub(super) const NARROW: f64 = 2e-15;

/// The largest number of intervals open at a time: with more, rounding hides what the formula is.
const MOST_OPEN: usize = 1 << 15;

/// How far beside a place without a bound the slope is examined, as shares of the largest radius, from near to far.
const BESIDE: [f64; 3] = [1e-13, 1e-11, 1e-9];

/// The same beside the axis, where the radius has no rounding.
const BESIDE_AXIS: [f64; 3] = [1e-12, 1e-8, 1e-4];

/// A slope that grows without limit grows at each step by at least nearly as much as before: a logarithm by as much,
/// while the growth of a bounded power r^q falls.
const ENDLESS: f64 = 0.95;

/// Growth below this share of the slope is rounding.
const ROUNDING: f64 = 1e-10;

/// The steepest phase is found to this factor; where it varies more, down to intervals of this share of the largest
/// radius.
const STEEP: f64 = 1.2;
const FINEST: f64 = 1.0 / 4096.0;

/// Across a jump the values differ by as much over the smaller of these shares of the largest radius as over the larger one, to
/// this share.
const ACROSS: [f64; 2] = [1e-10, 1e-12];
const AS_MUCH: f64 = 0.5;

/// Where a formula is no gap.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{}", self.words(&UnitSystem::Reduced))]
pub struct NoGap {
    /// The smallest radius found where h, h' or h'' is not finite, or h jumps: 0 if h(0) is not finite.
    pub radius: f64,
    /// The largest radius asked for.
    pub largest: f64,
    /// Whether h jumps there. Pressed over a ledge, a body would store an energy without bound.
    pub jumps: bool,
}

impl NoGap {
    /// What is wrong, with the radii as `units` show them.
    pub fn words(&self, units: &UnitSystem) -> String {
        let [radius, largest] = [self.radius, self.largest].map(|r| said(units, Quantity::Length, r));
        if self.jumps && self.radius <= ACROSS[1] * self.largest {
            return "the formula jumps at the axis, where the gap must be continuous".to_owned();
        }
        if self.jumps {
            return format!(
                "the formula jumps at r = {radius} (it must be continuous up to r = {largest}): give a ledge a width, as \
                 tanh((r - {radius})/width) does"
            );
        }
        format!(
            "the formula is not finite at r = {radius} (it must be up to r = {largest}, with its slope and curvature)"
        )
    }
}

impl Bound {
    /// Whether h(0) and, for 0 < r ≤ `largest`, h, h' and h'' are finite, apart from places that h and h' pass, and h does not
    /// jump.
    ///
    /// # Errors
    /// The smallest radius found where they are not, or it does.
    pub fn check(&self, largest: f64) -> Result<(), NoGap> {
        let error = |radius| NoGap { radius, largest, jumps: false };
        if !self.offset().is_finite() {
            return Err(error(0.0));
        }
        let Survey { mut sound, narrow, blank } = self.survey(largest);
        let pole = narrow.iter().find_map(|&place| self.pole(place, largest)).or(blank);
        sound.retain(|[lo, _]| pole.is_none_or(|pole| *lo < pole));
        sound.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let not_finite = self.bends(&sound).or(pole);
        let places = narrow.iter().map(|[lo, hi]| 0.5 * (lo + hi));
        let jump = places.chain(self.ledges(largest)).filter(|&r| self.jumps(r, largest)).reduce(f64::min);
        if let Some(radius) = jump.filter(|jump| not_finite.is_none_or(|radius| *jump < radius)) {
            return Err(NoGap { radius, largest, jumps: true });
        }
        not_finite.map_or(Ok(()), |radius| Err(error(radius)))
    }

    /// Where a part of the formula jumps: the breaks, if it has such a part.
    fn ledges(&self, largest: f64) -> Vec<f64> {
        let jumps = |step: &FormulaStep| matches!(step, FormulaStep::Unary(Unary::Sign | Unary::Step));
        if self.steps.steps.iter().any(jumps) { self.breaks(largest) } else { Vec::new() }
    }

    /// Whether h jumps at the radius `r`.
    fn jumps(&self, r: f64, largest: f64) -> bool {
        let [far, near] = ACROSS
            .map(|share| [r - share * largest, r + share * largest].map(|r| self.whole::<1>(r.max(0.0))[0]));
        let by = |[before, after]: [f64; 2]| (after - before).abs();
        let size = near[0].abs() + near[1].abs() + self.offset().abs();
        by(near) > AS_MUCH * by(far) && by(near) > ROUNDING * size
    }

    /// Divides the radii up to `largest`, as far as the formula may be finite, into intervals with a bound and places
    /// without one.
    fn survey(&self, largest: f64) -> Survey {
        let mut survey = Survey::default();
        let mut open = vec![[0.0, largest]];
        while !open.is_empty() {
            let mut halves = Vec::new();
            for interval in open {
                let [lo, hi] = interval;
                if survey.blank.is_some_and(|blank| lo >= blank) {
                    break;
                }
                if self.on(interval).is_bounded() {
                    survey.sound.push(interval);
                } else if hi - lo > NARROW * largest {
                    let blank = self.blank::<2>(interval);
                    survey.blank = [survey.blank, blank].into_iter().flatten().min_by(f64::total_cmp);
                    let middle = 0.5 * (lo + hi);
                    halves.extend([[lo, middle], [middle, hi]]);
                } else {
                    match survey.narrow.last_mut() {
                        Some(last) if lo - last[1] <= NARROW * largest => last[1] = hi,
                        _ => survey.narrow.push(interval),
                    }
                }
            }
            // There is nearly nowhere a bound, but the formula is finite wherever it was examined.
            open = if halves.len() > MOST_OPEN { Vec::new() } else { halves };
        }
        survey
    }

    /// The first radius examined in the middle of the interval, if N − 1 derivatives are finite at none of those radii.
    /// One point alone would not do: h and h' may pass it.
    fn blank<const N: usize>(&self, [lo, hi]: [f64; 2]) -> Option<f64> {
        let (middle, step) = (0.5 * (lo + hi), 0.125 * (hi - lo));
        let looked_at = [middle - step, middle, middle + step];
        looked_at.iter().all(|&r| !self.is_finite::<N>(r)).then_some(looked_at[0])
    }

    fn is_finite<const N: usize>(&self, r: f64) -> bool {
        self.whole::<N>(r).iter().all(|x| x.is_finite())
    }

    fn whole<const N: usize>(&self, r: f64) -> [f64; N] {
        self.operand(&(0..self.steps.steps.len()), &[r])[0]
    }

    /// Where, in a place without a bound, the formula stops being finite, if h or h' does.
    fn pole(&self, [lo, hi]: [f64; 2], largest: f64) -> Option<f64> {
        let axis = lo <= 0.0;
        let beside = if axis { BESIDE_AXIS } else { BESIDE }.map(|share| share * largest);
        let reach = beside[2];
        let left = (lo >= reach).then(|| beside.map(|step| lo - step));
        let right = (hi + reach <= largest).then(|| beside.map(|step| hi + step));
        let bad = |radii: &[f64; 3]| radii.iter().copied().find(|&r| !self.is_finite::<2>(r));
        if let Some(radius) = left.as_ref().and_then(bad) {
            return Some(radius);
        }
        if let Some(radius) = right.as_ref().and_then(bad) {
            let from = if axis { return Some(0.0) } else { (lo - beside[0]).max(0.0) };
            return Some(root::halved(from, radius, |r| self.is_finite::<3>(r))[1]);
        }
        let endless = |radii: [f64; 3]| {
            let [near, between, far] = radii.map(|r| self.whole::<2>(r)[1]);
            let (last, before) = ((near - between).abs(), (between - far).abs());
            near.abs() > between.abs()
                && between.abs() > far.abs()
                && last >= ENDLESS * before
                && last > ROUNDING * near.abs()
        };
        let middle = if axis { 0.0 } else { 0.5 * (lo + hi) };
        [left, right].into_iter().flatten().any(endless).then_some(middle)
    }

    /// Where h'' stops being finite, judged by the middles of these intervals.
    fn bends(&self, intervals: &[[f64; 2]]) -> Option<f64> {
        let mut good = 0.0;
        for &interval in intervals {
            let [lo, hi] = interval;
            let middle = 0.5 * (lo + hi);
            if self.is_finite::<3>(middle) {
                good = middle;
            } else if let Some(bad) = self.blank::<3>(interval) {
                return Some(root::halved(good, bad, |r| self.is_finite::<3>(r))[1]);
            }
        }
        None
    }

    /// The shortest wave on (0, `largest`], a length: the smallest 2π/|dφ/dr| of the sines and cosines of φ(r).
    ///
    /// A tangent counts with its period π. A function whose argument runs through less than half a period there is not
    /// counted as a wave.
    pub fn feature_length(&self, largest: f64) -> Option<f64> {
        self.steps.waves.iter().filter_map(|wave| self.wave_length(wave, largest)).min_by(f64::total_cmp)
    }

    fn wave_length(&self, wave: &FormulaWave, largest: f64) -> Option<f64> {
        let (mut lowest, mut highest, mut steepest) = (f64::INFINITY, f64::NEG_INFINITY, 0f64);
        let mut open = vec![[0.0, largest]];
        while !open.is_empty() {
            let radii: Vec<f64> = open.iter().flat_map(|[lo, hi]| [0.5 * (lo + hi), *hi]).collect();
            for [phase, slope] in self.operand(&wave.argument, &radii) {
                lowest = lowest.min(phase);
                highest = highest.max(phase);
                steepest = steepest.max(slope.abs());
            }
            let halves = |[lo, hi]: [f64; 2]| {
                let middle = 0.5 * (lo + hi);
                [[lo, middle], [middle, hi]]
            };
            let steeper = |interval: &[f64; 2]| {
                interval[1] - interval[0] > FINEST * largest
                    && self.operand_on(&wave.argument, *interval).slope.bound() > STEEP * steepest
            };
            open = open.into_iter().filter(steeper).flat_map(halves).collect();
        }
        let length = wave.period / steepest;
        (highest - lowest >= 0.5 * wave.period && length > 0.0).then_some(length)
    }

    /// The operand computed by these steps, with N − 1 derivatives, at each of `radii`.
    pub(super) fn operand<const N: usize>(&self, steps: &Range<usize>, radii: &[f64]) -> Vec<[f64; N]> {
        let mut operand = Vec::with_capacity(radii.len());
        self.each(&self.steps.steps[steps.clone()], 1.0, radii, |_, jet| operand.push(jet));
        operand
    }
}

/// What is known about a formula up to a radius.
#[derive(Debug, Default)]
struct Survey {
    /// The intervals on which h and h' have a bound.
    sound: Vec<[f64; 2]>,
    /// Places a few units in the last place wide, ascending, where they have none.
    narrow: Vec<[f64; 2]>,
    /// The smallest radius at and around which they are not finite.
    blank: Option<f64>,
}

#[cfg(test)]
mod tests {
    use crate::gap::{formula::Bound, formula::Formula};

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
            // Between the nodes of any grid.
            ("1e-9/((r-0.30001)^2)", 0.30001),
            ("1e-25/(r-0.30001)", 0.30001),
            ("1/(r-0.300013)", 0.300_013),
            ("log(abs(r-0.300013))", 0.300_013),
            ("r^2 + (r-0.300013)*log(abs(r-0.300013))", 0.300_013),
            ("sqrt(abs(r-0.300013))", 0.300_013),
            ("sqrt(r)", 0.0),
            ("r^2 + 1/abs(cos(pi*r/2.600026))^0.1", 1.300_013),
            ("r^2/max(abs(r - 1.1) - 1e-7, 0)", 1.1 - 1e-7),
            ("sqrt(abs(r - 1.1) - 1e-7)", 1.1 - 1e-7),
            ("max(r - 0.3, 0)^0.9", 0.3),
            // Where 1 - sin² is zero it is only rounding, and its root has no slope there.
            ("asin(sin(10*r))", std::f64::consts::PI / 20.0),
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
            "1/(1e-12 + (r-0.3)^2)",
            "1/(1e-20 + (r-0.3)^2)",
            "abs(r - 0.300013)^1.02",
            "(r - 0.300013)^2*log(abs(r - 0.300013))",
            "r^1.001 + r^2",
            "hypot(r - 0.3, 0) + sqrt((r - 0.5)^4)",
            "sqrt(r*r - r^2)",
            "abs(tan(r/2)) + sign(r - 1)*(r - 1)",
            "1/(2 + max(sign(r - 0.3001), -1)*(r - 0.3001))",
            "r^2 + (r - 0.3)^2*step(r - 0.3)",
            "r^2 + 0.01*tanh((r - 0.3)/1e-7)",
            "tan(r/2)",
            "7",
        ] {
            assert_eq!(bound(text).check(2.0), Ok(()), "{text}");
        }
        assert!(bound("sqrt(1 - r^2)").check(0.99).is_ok());
    }

    #[test]
    fn a_formula_that_jumps_is_no_gap() {
        for (text, radius) in [
            ("r^2/2 + 0.01*step(r - 0.15)", 0.15),
            ("r^2/2 - 1e-6*sign(r - 0.3001)", 0.3001),
            ("r^2/2 + 1e-9*step(r - 0.3)", 0.3),
            ("r^2/2 + 0.01*sign(r)", 0.0),
            ("sign(r - 1)*r", 1.0),
            ("1/(2*step(r - 0.3001) - 1)", 0.3001),
            ("r^2 + 0.01*atan(1/(r - 0.7))", 0.7),
            // A narrow ledge, and one before a pole.
            ("r^2 + 0.01*(step(r - 0.3) - step(r - 0.3 - 1e-9))", 0.3),
            ("r^2 + 0.01*step(r - 0.3) + 1/(r - 0.4)", 0.3),
        ] {
            let error = bound(text).check(2.0).unwrap_err();
            assert!(error.jumps && (error.radius - radius).abs() < 1e-6, "{text}: {error}");
        }
        let error = bound("r^2 + 0.01*step(r - 0.5) + 1/(r - 0.4)").check(2.0).unwrap_err();
        assert!(!error.jumps, "{error}");
        assert!(bound("r^2 + step(r - 3)").check(2.0).is_ok());
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
