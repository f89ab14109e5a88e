//! Complex numbers, for the tests of bounds on discs.

use std::f64::consts::{PI, TAU};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// x + iy, for formulas written out by hand.
#[derive(Debug, Clone, Copy)]
pub struct Complex(pub f64, pub f64);

impl Complex {
    pub fn size(self) -> f64 {
        self.0.hypot(self.1)
    }

    pub fn exp(self) -> Self {
        let size = self.0.exp();
        Self(size * self.1.cos(), size * self.1.sin())
    }

    pub fn ln(self) -> Self {
        Self(self.size().ln(), self.1.atan2(self.0))
    }

    pub fn power(self, p: f64) -> Self {
        (self.ln() * p).exp()
    }

    pub fn sin(self) -> Self {
        Self(self.0.sin() * self.1.cosh(), self.0.cos() * self.1.sinh())
    }

    pub fn cos(self) -> Self {
        (self + 0.5 * PI).sin()
    }

    /// −i sin(iz).
    pub fn sinh(self) -> Self {
        let turned = Self(-self.1, self.0).sin();
        Self(turned.1, -turned.0)
    }

    pub fn cosh(self) -> Self {
        Self(-self.1, self.0).cos()
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Complex {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }
}

impl Div for Complex {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let square = other.0 * other.0 + other.1 * other.1;
        self * Self(other.0 / square, -other.1 / square)
    }
}

impl Add<f64> for Complex {
    type Output = Self;
    fn add(self, other: f64) -> Self {
        Self(self.0 + other, self.1)
    }
}

impl Mul<f64> for Complex {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        Self(self.0 * other, self.1 * other)
    }
}

/// The largest |f| at many points of the disc, most of them on its rim, where an analytic function is largest.
pub fn largest_on(centre: f64, radius: f64, f: impl Fn(Complex) -> Complex) -> f64 {
    (0..240)
        .map(|k| {
            let (angle, share) =
                (TAU * f64::from(k) / 200.0, if k < 200 { 1.0 } else { 0.02 * f64::from(k - 200) });
            let z = Complex(centre + share * radius * angle.cos(), share * radius * angle.sin());
            f(z).size()
        })
        .fold(0.0, f64::max)
}
