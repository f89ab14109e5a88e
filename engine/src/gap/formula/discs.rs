//! A formula and its slope on discs of the complex plane, and on intervals of the radius.
//!
//! The steps of the formula are run on a value and a slope, each a [`Ball`]. On a disc, a function that switches (abs,
//! sign, step, min, max) is taken as the branch that holds at one radius, continued: this bounds the smooth pieces. On
//! an interval of real radii the bound holds for whichever branch applies, which finds the places where the function
//! switches.

use super::ball::{Ball, BallPair};
use super::bound::Bound;
use super::fold::{FormulaStep, Switch, Zero};
use crate::elementary::{acos, asin, ln, pow};
use crate::expression::function::{Binary, Unary};
use crate::gap::ComplexDisc;
use std::f64::consts::LN_10;
use std::ops::{Neg, Range};

/// By how much an interval is widened before it is bounded, as a share of its larger end: rounding must not lose its
/// ends.
const MARGIN: f64 = 4.0 * f64::EPSILON;

/// A value and its slope on a disc.
#[derive(Debug, Clone, Copy)]
#[must_use]
pub struct Image {
    pub value: Ball,
    pub slope: Ball,
    /// The value at the radius that selects the branches; NaN on an interval, where all of them count.
    at: f64,
}

impl Image {
    /// Whether it does not depend on the radius at all.
    pub fn does_not_change(self) -> bool {
        self.slope == Ball::ZERO
    }

    pub fn is_bounded(self) -> bool {
        self.value.is_bounded() && self.slope.is_bounded()
    }

    fn number(number: f64) -> Self {
        Self { value: Ball::number(number), slope: Ball::ZERO, at: number }
    }

    /// f of the value, where f is given together with its derivative.
    fn chain(self, (value, derivative): BallPair, at: f64) -> Self {
        // What does not change has no slope, not even where the slope of f is infinite: max(r - a, 0)^1.5.
        let slope = if self.slope == Ball::ZERO { Ball::ZERO } else { derivative * self.slope };
        Self { value, slope, at }
    }

    fn undefined() -> Self {
        Self { value: Ball::OPEN, slope: Ball::OPEN, at: f64::NAN }
    }

    fn map(self, f: impl Fn(Ball) -> Ball, at: f64) -> Self {
        Self { value: f(self.value), slope: f(self.slope), at }
    }

    fn negate(self) -> Self {
        self.map(Ball::neg, -self.at)
    }

    fn unary(self, unary: Unary, on_disc: bool) -> Self {
        let x = self.value;
        let functions = match unary {
            Unary::Negate => return self.negate(),
            Unary::Abs => return self.absolute(on_disc),
            Unary::Sign | Unary::Step => return self.sign(unary, on_disc),
            Unary::Sin => (x.sin(), x.cos()),
            Unary::Cos => (x.cos(), -x.sin()),
            Unary::Tan => x.tan(),
            Unary::Asin => x.arc_sine(asin(x.middle), 1.0),
            Unary::Acos => x.arc_sine(acos(x.middle), -1.0),
            Unary::Atan => x.atan(),
            Unary::Sinh => (x.sinh(), x.cosh()),
            Unary::Cosh => (x.cosh(), x.sinh()),
            Unary::Tanh => x.tanh(),
            Unary::Exp => (x.exp(), x.exp()),
            Unary::Log => x.ln(),
            Unary::Log10 => {
                let (value, derivative) = x.ln();
                (value.scale(LN_10.recip()), derivative.scale(LN_10.recip()))
            }
            Unary::Sqrt => (x.power(0.5), x.power(-0.5).scale(0.5)),
        };
        self.chain(functions, unary.value(self.at))
    }

    fn absolute(self, on_disc: bool) -> Self {
        let Ball { middle, radius } = self.value;
        let sign = if on_disc { self.at } else { middle };
        if sign.is_nan() {
            Self::undefined()
        } else if on_disc || middle.abs() > radius {
            if sign < 0.0 { self.negate() } else { self }
        } else {
            Self {
                value: Ball { middle: middle.abs(), radius },
                slope: self.slope.hull(-self.slope),
                at: f64::NAN,
            }
        }
    }

    /// The sign or the step.
    fn sign(self, unary: Unary, on_disc: bool) -> Self {
        let Ball { middle, radius } = self.value;
        let value = unary.value(if on_disc { self.at } else { middle });
        if value.is_nan() {
            Self::undefined()
        } else if on_disc || middle.abs() > radius || radius <= 0.0 {
            Self::number(value)
        } else {
            let [low, high] = [-1.0, 1.0].map(|x| Ball::number(unary.value(x)));
            // A jump has no slope; without a bound on it, the interval is examined more closely.
            Self { value: low.hull(high), slope: Ball::OPEN, at: f64::NAN }
        }
    }

    fn binary(self, other: Self, binary: Binary, on_disc: bool) -> Self {
        let (a, b) = (self, other);
        let at = binary.value(a.at, b.at);
        match binary {
            Binary::Add => Self { value: a.value + b.value, slope: a.slope + b.slope, at },
            Binary::Subtract => Self { value: a.value - b.value, slope: a.slope - b.slope, at },
            Binary::Multiply => a.times(b, at),
            Binary::Divide => {
                let over = b.value.recip();
                let value = a.value * over;
                Self { value, slope: (a.slope - value * b.slope) * over, at }
            }
            Binary::Power => {
                let exponent = b.times(a.unary(Unary::Log, on_disc), f64::NAN);
                exponent.chain((exponent.value.exp(), exponent.value.exp()), at)
            }
            Binary::Min | Binary::Max => a.larger(b, binary, on_disc),
            Binary::Hypot => a.squares(b).chain_root(at),
        }
    }

    fn times(self, other: Self, at: f64) -> Self {
        let slope = self.slope * other.value + self.value * other.slope;
        Self { value: self.value * other.value, slope, at }
    }

    /// a² + b².
    fn squares(self, other: Self) -> Self {
        let [a, b] = [self, other].map(|x| x.chain((x.value.whole_power(2.0), x.value.scale(2.0)), f64::NAN));
        Self { value: a.value + b.value, slope: a.slope + b.slope, at: f64::NAN }
    }

    fn chain_root(self, at: f64) -> Self {
        self.chain((self.value.power(0.5), self.value.power(-0.5).scale(0.5)), at)
    }

    /// The smaller or the larger of two.
    fn larger(self, other: Self, binary: Binary, on_disc: bool) -> Self {
        let difference = self.value - other.value;
        let ahead = if on_disc { self.at - other.at } else { difference.middle };
        let ahead = if binary == Binary::Max { ahead } else { -ahead };
        if ahead.is_nan() {
            Self::undefined()
        } else if on_disc || difference.excludes_zero() {
            if ahead > 0.0 { self } else { other }
        } else {
            let middle = binary.value(self.value.middle, other.value.middle);
            let value = Ball::new(middle, self.value.radius.max(other.value.radius));
            Self { value, slope: self.slope.hull(other.slope), at: f64::NAN }
        }
    }
}

impl Bound {
    /// An upper bound of |h'| on `disc`, infinite where there is none.
    pub fn slope_bound(&self, disc: ComplexDisc) -> f64 {
        let ComplexDisc { centre, radius, branch } = disc;
        run(&self.steps.steps, Ball::new(centre, radius), Some(branch)).slope.bound()
    }

    /// The formula and its slope on the real interval.
    pub(super) fn on(&self, interval: [f64; 2]) -> Image {
        self.operand_on(&(0..self.steps.steps.len()), interval)
    }

    /// The operand that these steps compute, and its slope, on the real interval.
    pub(super) fn operand_on(&self, steps: &Range<usize>, [lo, hi]: [f64; 2]) -> Image {
        let radii = Ball::new(0.5 * (lo + hi), 0.5 * (hi - lo) + MARGIN * hi);
        run(&self.steps.steps[steps.clone()], radii, None)
    }

    /// The quantity that is zero where the formula switches, on the real interval.
    pub(super) fn switch_on(&self, switch: &Switch, interval: [f64; 2]) -> Image {
        let a = self.operand_on(&switch.argument, interval);
        let b = switch.other.as_ref().map(|other| self.operand_on(other, interval));
        let b = b.unwrap_or(Image::number(0.0));
        match switch.zero {
            Zero::Difference => a.binary(b, Binary::Subtract, false),
            Zero::Squares => a.squares(b),
            Zero::Unit => {
                let square = a.squares(b).negate();
                Image { value: square.value.shift(1.0), ..square }
            }
        }
    }
}

/// Runs the steps on these radii: on a disc with the branches that hold at `branch`, or on an interval without one.
fn run(steps: &[FormulaStep], radii: Ball, branch: Option<f64>) -> Image {
    let on_disc = branch.is_some();
    let mut stack: Vec<Image> = Vec::new();
    for step in steps {
        // The folder gives every step its operands.
        let pop = |stack: &mut Vec<Image>| stack.pop().unwrap_or(Image::undefined());
        let made = match *step {
            FormulaStep::Number(number) => Image::number(number),
            FormulaStep::Radius => {
                Image { value: radii, slope: Ball::number(1.0), at: branch.unwrap_or(f64::NAN) }
            }
            FormulaStep::Binary(binary) => {
                let b = pop(&mut stack);
                pop(&mut stack).binary(b, binary, on_disc)
            }
            FormulaStep::Unary(unary) => pop(&mut stack).unary(unary, on_disc),
            FormulaStep::Shift(c) => {
                let x = pop(&mut stack);
                Image { value: x.value.shift(c), at: x.at + c, ..x }
            }
            FormulaStep::Scale(c) => {
                let x = pop(&mut stack);
                x.map(|ball| ball.scale(c), c * x.at)
            }
            FormulaStep::Divide(c) => {
                let x = pop(&mut stack);
                x.map(|ball| Ball::new(ball.middle / c, ball.radius / c.abs()), x.at / c)
            }
            FormulaStep::Over(c) => {
                let x = pop(&mut stack);
                let over = x.value.recip();
                x.chain((over.scale(c), (over * over).scale(-c)), c / x.at)
            }
            FormulaStep::IntegerPower(n) => pop(&mut stack).real_power(f64::from(n)),
            FormulaStep::RealPower(p) => pop(&mut stack).real_power(p),
            FormulaStep::Exponential(c) => {
                let x = pop(&mut stack);
                let value = x.value.scale(ln(c)).exp();
                x.chain((value, value.scale(ln(c))), pow(c, x.at))
            }
        };
        stack.push(made);
    }
    stack.pop().unwrap_or(Image::undefined())
}

impl Image {
    fn real_power(self, p: f64) -> Self {
        self.chain((self.value.power(p), self.value.power(p - 1.0).scale(p)), pow(self.at, p))
    }
}

#[cfg(test)]
mod tests {
    use crate::gap::ComplexDisc;
    use crate::gap::fixtures::{Complex, largest_on};
    use crate::gap::{formula::Bound, formula::Formula};
    use std::f64::consts::TAU;

    fn bound(text: &str) -> Bound {
        Formula::parse(text).unwrap().bind(&[]).unwrap()
    }

    const ONE: Complex = Complex(1.0, 0.0);

    /// A formula, and its slope written by hand at a complex radius, on the branch that holds at a real one.
    type Example = (&'static str, fn(Complex, f64) -> Complex);

    fn side(branch: f64, at: f64) -> f64 {
        (branch - at).signum()
    }

    const EXAMPLES: [Example; 21] = [
        ("r^2/2 + 0.0025*exp(-((r-0.3)/0.01)^2)", |z, _| {
            let x = (z + -0.3) * 100.0;
            z - (-(x * x)).exp() * x * 0.5
        }),
        ("r^2/2 + 0.0025*(1 - cos(2*pi*r/0.1))", |z, _| z + (z * (TAU / 0.1)).sin() * (0.0025 * TAU / 0.1)),
        ("r^2/2 + 1e-5/(1 + ((r-0.18)/0.006)^2)", |z, _| {
            let x = (z + -0.18) * (1.0 / 0.006);
            let y = x * x + 1.0;
            z - x / (y * y) * (2e-5 / 0.006)
        }),
        ("1 - sqrt(1 - r^2)", |z, _| z / (ONE - z * z).power(0.5)),
        ("0.01*tanh((r-0.4)/0.05)", |z, _| {
            let cosh = ((z + -0.4) * 20.0).cosh();
            Complex(0.2, 0.0) / (cosh * cosh)
        }),
        ("r^2/2 + 0.07*abs(r-0.12)", |z, branch| z + 0.07 * side(branch, 0.12)),
        ("abs(r-0.3)^1.5 + r^2.7", |z, branch| {
            let side = side(branch, 0.3);
            ((z + -0.3) * side).power(0.5) * (1.5 * side) + z.power(1.7) * 2.7
        }),
        ("r^2/2 + 0.0005*exp(-2000*(1-cos(2*pi*r/0.1)))", |z, _| {
            let phase = z * (TAU / 0.1);
            z - ((phase.cos() + -1.0) * 2000.0).exp() * phase.sin() * (TAU / 0.1)
        }),
        ("log(1 + 3*r) + log10(r)", |z, _| {
            Complex(3.0, 0.0) / (z * 3.0 + 1.0) + ONE / (z * std::f64::consts::LN_10)
        }),
        ("sinh(2*r)*cosh(3*r)", |z, _| {
            (z * 2.0).cosh() * (z * 3.0).cosh() * 2.0 + (z * 2.0).sinh() * (z * 3.0).sinh() * 3.0
        }),
        ("tan(r) - 1/r^3", |z, _| ONE / (z.cos() * z.cos()) + Complex(3.0, 0.0) / (z * z * z * z)),
        ("atan(5*(r - 0.5))", |z, _| {
            let x = (z + -0.5) * 5.0;
            Complex(5.0, 0.0) / (x * x + 1.0)
        }),
        ("asin(r^2/2) + acos(r/3)", |z, _| {
            z / (ONE - z * z * z * z * 0.25).power(0.5)
                - Complex(1.0 / 3.0, 0.0) / (ONE - z * z * (1.0 / 9.0)).power(0.5)
        }),
        ("r^r + 2^(r^2)", |z, _| {
            (z * z.ln()).exp() * (z.ln() + 1.0)
                + (z * z * std::f64::consts::LN_2).exp() * z * (2.0 * std::f64::consts::LN_2)
        }),
        ("hypot(r - 0.3, 0.05)", |z, _| {
            let x = z + -0.3;
            x / (x * x + 0.0025).power(0.5)
        }),
        ("r^7 - (r - 0.5)^-2", |z, _| {
            let x = z + -0.5;
            z.power(6.0) * 7.0 + Complex(2.0, 0.0) / (x * x * x)
        }),
        ("sin(r)^2/cos(r/3)", |z, _| {
            let third = z * (1.0 / 3.0);
            z.sin() * z.cos() * 2.0 / third.cos()
                + z.sin() * z.sin() * third.sin() * (1.0 / 3.0) / (third.cos() * third.cos())
        }),
        ("min(r^2, 0.5*r) + step(r - 0.7)*r^3", |z, branch| {
            let inner = if branch < 0.5 { z * 2.0 } else { Complex(0.5, 0.0) };
            inner + z * z * if branch < 0.7 { 0.0 } else { 3.0 }
        }),
        ("sign(0.4 - r)*max(r - 0.2, 0)^1.5", |z, branch| {
            let size = if branch > 0.2 { 1.5 } else { 0.0 };
            (z + -0.2).power(0.5) * (size * side(0.4, branch))
        }),
        ("(1 - r*r)*(2 + r)/(3 - r)", |z, _| {
            let (a, b, c) = (ONE - z * z, z + 2.0, -z + 3.0);
            (a - z * b * 2.0) / c + a * b / (c * c)
        }),
        ("exp(r)*sqrt(r) - cosh(r)", |z, _| z.exp() * (z.power(0.5) + ONE / (z.power(0.5) * 2.0)) - z.sinh()),
    ];

    #[test]
    fn no_sample_of_a_disc_exceeds_its_bound() {
        let mut random = fastrand::Rng::with_seed(5);
        for (text, slope) in EXAMPLES {
            let formula = bound(text);
            let (mut looked_at, mut tightness) = (0, Vec::new());
            for _ in 0..400 {
                let centre = 1.2 * random.f64();
                let radius = 10f64.powf(-4.0 + 3.5 * random.f64());
                let branch = if random.bool() { centre } else { 1.2 * random.f64() };
                let most = formula.slope_bound(ComplexDisc { centre, radius, branch });
                assert!(most >= 0.0, "{text}: {most}");
                if !most.is_finite() {
                    continue;
                }
                looked_at += 1;
                let largest = largest_on(centre, radius, |z| slope(z, branch));
                assert!(
                    largest <= most * (1.0 + 1e-12) + 1e-13,
                    "{text} at {centre} ± {radius}, branch {branch}: {largest} > {most}"
                );
                if radius < 1e-3 && largest > 0.0 {
                    tightness.push(most / largest);
                }
            }
            assert!(looked_at > 100, "{text}: {looked_at} discs with a bound");
            tightness.sort_by(f64::total_cmp);
            let median = tightness[tightness.len() / 2];
            assert!(median < 1.1, "{text}: small discs are bounded {median} times too far");
        }
    }

    #[test]
    fn what_is_not_defined_has_no_bound() {
        for (text, centre, radius) in [
            ("1/(r - 0.3)", 0.31, 0.011),
            ("sqrt(r)", 0.1, 0.11),
            ("log(abs(r - 0.3))", 0.3, 0.01),
            ("tan(r)", 1.5, 0.08),
            ("asin(r)", 0.9, 0.11),
            ("atan(r)", 0.0, 1.0),
            ("exp(1000*r)", 0.8, 0.1),
            ("r^1.5", 0.1, 0.2),
            ("r^r", 0.1, 0.2),
            ("0*r^2 + (0 - 1)^0.5*r", 0.5, 0.1),
        ] {
            let most = bound(text).slope_bound(ComplexDisc { centre, radius, branch: centre });
            assert!(most.is_infinite(), "{text}: {most}");
        }
        // No overflow times zero, and no contribution from what is identically zero.
        for (text, most) in [("exp(-1e6*(r - 0.3)^2)", 1e-300), ("max(r - 0.9, 0)^1.5", 1e-300)] {
            let found = bound(text).slope_bound(ComplexDisc { centre: 0.7, radius: 0.1, branch: 0.7 });
            assert!(found <= most, "{text}: {found}");
        }
    }

    #[test]
    fn intervals_hold_all_that_real_radii_give() {
        let mut random = fastrand::Rng::with_seed(8);
        for text in [
            "max(0.0008 - abs(r-0.3), 0)",
            "abs(abs(r - 0.4) - 0.1)*(1 + min(r, 0.5)^2)",
            "min(abs(sin(20*r)), 0.3) - max(r, 0.7)",
            "sign(r - 0.5)*r^2 + step(r - 0.2)",
        ] {
            let formula = bound(text);
            for _ in 0..300 {
                let [a, b] = [(); 2].map(|()| random.f64());
                let (lo, hi) = (a.min(b), a.max(b));
                let found = formula.on([lo, hi]);
                for _ in 0..30 {
                    let r = lo + random.f64() * (hi - lo);
                    let [value, slope] = formula.operand::<2>(&(0..formula.steps.steps.len()), &[r])[0];
                    for (x, ball) in [(value, found.value), (slope, found.slope)] {
                        assert!(
                            (x - ball.middle).abs() <= ball.radius * (1.0 + 1e-12) + 1e-13,
                            "{text} at {r} in {lo} … {hi}: {x} {ball:?}"
                        );
                    }
                }
            }
        }
    }
}
