//! Bounds of functions on discs: arithmetic on all complex numbers near a real one.
//!
//! Suppose the image of an operand lies within ρ of its value m at the centre. Then the image of a function of it lies
//! within
//!
//! ```text
//! f + g   ρ₁ + ρ₂                          f g    |m₁|ρ₂ + |m₂|ρ₁ + ρ₁ρ₂
//! 1/f     ρ/(|m|(|m| − ρ)),  |m| > ρ       exp    −e^{m+ρ} (e^{−ρ} − 1)
//! sin     |sin m| 2 sinh²(ρ/2) + |cos m| sinh ρ,  and cos, sinh, cosh likewise
//! fⁿ      (|m| + ρ)ⁿ − |m|ⁿ                ln     −ln(1 − ρ/m),  m > ρ
//! fᵖ      mᵖ |(1 ± ρ/m)ᵖ − 1|,  m > ρ, with + from p = 1 on: |(1 + w)ᵖ⁻¹| = |1 + w|ᵖ⁻¹ integrated from 0 to ρ/m
//! tan     sinh ρ/(|cos m| sin(e − ρ)),  e > ρ the distance of m from the nearest pole
//! tanh    sinh ρ/(cosh m √(sinh²(|m| − ρ)₊ + cos²ρ)),  ρ < π/2, or 4/(e^{2(|m|−ρ)} − 1), |m| > ρ
//! ```
//!
//! of the function's own value at the centre. Where a function is not defined on all of the disc, the radius is
//! infinite; so it is where the numbers overflow to NaN. Radii are not rounded outward: they are used with a factor to
//! spare.

use crate::elementary::{
    asin, atan, cos, cosh, exp, exp_m1, hypot, ln, ln_1p, pow, sin, sin_cos, sinh, tan, tanh,
};
use crate::gap::shapes::harmonics::sine_change;
use std::f64::consts::FRAC_PI_2;
use std::ops::{Add, Mul, Neg, Sub};

/// All complex numbers within `radius` of the real `middle`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[must_use]
pub struct Ball {
    pub middle: f64,
    pub radius: f64,
}

/// A function and its derivative on a ball.
pub type BallPair = (Ball, Ball);

/// A sine or cosine, circular or hyperbolic, from its value and slope at the middle.
fn swing(along: f64, across: f64, radius: f64) -> Ball {
    Ball::new(along, sine_change(along, across, radius))
}

impl Ball {
    pub const ZERO: Self = Self { middle: 0.0, radius: 0.0 };
    /// No bound.
    pub const OPEN: Self = Self { middle: 0.0, radius: f64::INFINITY };

    /// A ball; it has no bound where `middle` is not finite or `radius` is NaN.
    pub fn new(middle: f64, radius: f64) -> Self {
        let known = middle.is_finite() && !radius.is_nan();
        Self { middle, radius: if known { radius } else { f64::INFINITY } }
    }

    pub fn number(number: f64) -> Self {
        Self::new(number, 0.0)
    }

    /// The largest absolute value.
    pub fn bound(self) -> f64 {
        if self.radius.is_finite() { self.middle.abs() + self.radius } else { f64::INFINITY }
    }

    pub fn is_bounded(self) -> bool {
        self.bound().is_finite()
    }

    pub fn excludes_zero(self) -> bool {
        self.middle.abs() > self.radius
    }

    /// The smallest ball around the real intervals of both.
    pub fn hull(self, other: Self) -> Self {
        let low = (self.middle - self.radius).min(other.middle - other.radius);
        let high = (self.middle + self.radius).max(other.middle + other.radius);
        if low.is_finite() && high.is_finite() && self.is_bounded() && other.is_bounded() {
            Self::new(0.5 * (low + high), 0.5 * (high - low))
        } else {
            Self::OPEN
        }
    }

    pub fn scale(self, c: f64) -> Self {
        Self::new(c * self.middle, c.abs() * self.radius)
    }

    pub fn shift(self, c: f64) -> Self {
        Self::new(self.middle + c, self.radius)
    }

    /// 1/x.
    pub fn recip(self) -> Self {
        let size = self.middle.abs();
        if size > self.radius {
            Self::new(self.middle.recip(), self.radius / size / (size - self.radius))
        } else {
            Self::OPEN
        }
    }

    /// xⁿ for a whole n ≥ 0.
    pub fn whole_power(self, n: f64) -> Self {
        let Self { middle, radius } = self;
        let size = middle.abs();
        let change = if radius <= 0.0 {
            0.0
        } else if radius > size {
            pow(size + radius, n) - pow(size, n)
        } else {
            // This keeps the digits of a small change.
            pow(size, n) * exp_m1(n * ln_1p(radius / size))
        };
        Self::new(pow(middle, n), change)
    }

    /// xᵖ.
    pub fn power(self, p: f64) -> Self {
        if p.fract() == 0.0 {
            return if p < 0.0 { self.recip().whole_power(-p) } else { self.whole_power(p) };
        }
        let Self { middle, radius } = self;
        let value = pow(middle, p);
        if radius <= 0.0 {
            return Self::number(value);
        }
        let x = radius / middle;
        // At x = 1 the branch point lies on the rim, where a positive power is still bounded.
        if !(middle > 0.0 && (x < 1.0 || x <= 1.0 && p > 0.0)) {
            return Self::OPEN;
        }
        let change = exp_m1(p * if p > 1.0 { ln_1p(x) } else { ln_1p(-x) });
        Self::new(value, value * change.abs())
    }

    pub fn exp(self) -> Self {
        let Self { middle, radius } = self;
        Self::new(exp(middle), -exp(middle + radius) * exp_m1(-radius))
    }

    pub fn sin(self) -> Self {
        let (sin, cos) = sin_cos(self.middle);
        swing(sin, cos, self.radius)
    }

    pub fn cos(self) -> Self {
        let (sin, cos) = sin_cos(self.middle);
        swing(cos, sin, self.radius)
    }

    pub fn sinh(self) -> Self {
        swing(sinh(self.middle), cosh(self.middle), self.radius)
    }

    pub fn cosh(self) -> Self {
        swing(cosh(self.middle), sinh(self.middle), self.radius)
    }

    /// tan x with 1 + tan²x.
    pub fn tan(self) -> BallPair {
        let Self { middle, radius } = self;
        let cos = cos(middle).abs();
        let clear = asin(cos) - radius;
        let tan =
            if clear > 0.0 { Self::new(tan(middle), sinh(radius) / (cos * sin(clear))) } else { Self::OPEN };
        (tan, (tan * tan).shift(1.0))
    }

    /// tanh x with 1 − tanh²x.
    pub fn tanh(self) -> BallPair {
        let Self { middle, radius } = self;
        let clear = middle.abs() - radius;
        let near = if radius < FRAC_PI_2 {
            let inside = sinh(clear.max(0.0));
            sinh(radius) / cosh(middle) / hypot(inside, cos(radius))
        } else {
            f64::INFINITY
        };
        let far = if clear > 0.0 { 4.0 / exp_m1(2.0 * clear) } else { f64::INFINITY };
        // The smaller of the two; NaN is an overflow of the first.
        let change = near.min(far);
        let tanh = tanh(middle);
        let slope = cosh(middle).powi(-2);
        (Self::new(tanh, change), Self::new(slope, change * (2.0 * tanh.abs() + change)))
    }

    /// ln x with 1/x.
    pub fn ln(self) -> BallPair {
        let Self { middle, radius } = self;
        let ln = if middle > radius { Self::new(ln(middle), -ln_1p(-radius / middle)) } else { Self::OPEN };
        (ln, if middle > 0.0 { self.recip() } else { Self::OPEN })
    }

    /// arctan x with 1/((x − i)(x + i)).
    pub fn atan(self) -> BallPair {
        let distance = hypot(self.middle, 1.0);
        if distance <= self.radius {
            return (Self::OPEN, Self::OPEN);
        }
        // 1/(x − i) and 1/(x + i) change as 1/x does at this distance from its pole.
        let change = self.radius / distance / (distance - self.radius);
        let slope = Self::new(distance.powi(-2), change * (2.0 / distance + change));
        (self.along(atan(self.middle), slope), slope)
    }

    /// arcsin x (`sign` 1) or arccos x (`sign` −1) from its value at the middle, with ±1/√((1 − x)(1 + x)).
    pub fn arc_sine(self, value: f64, sign: f64) -> BallPair {
        let factor = |sign: f64| self.scale(sign).shift(1.0).power(-0.5);
        let slope = (factor(-1.0) * factor(1.0)).scale(sign);
        (self.along(value, slope), slope)
    }

    /// A function with this value at the middle whose derivative is `slope`.
    fn along(self, value: f64, slope: Self) -> Self {
        if self.radius <= 0.0 { Self::number(value) } else { Self::new(value, self.radius * slope.bound()) }
    }
}

impl Add for Ball {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.middle + other.middle, self.radius + other.radius)
    }
}

impl Sub for Ball {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Ball {
    type Output = Self;

    fn neg(self) -> Self {
        Self { middle: -self.middle, radius: self.radius }
    }
}

impl Mul for Ball {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (a, b) = (self, other);
        let change = a.middle.abs() * b.radius + b.middle.abs() * a.radius + a.radius * b.radius;
        Self::new(a.middle * b.middle, change)
    }
}
