//! Forward differentiation to the third order, on a block of radii at once.
//!
//! ```text
//! (a b)'''  = a'''b + 3a''b' + 3a'b'' + ab'''                              Leibniz
//! f(x)'     = f₁x'
//! f(x)''    = f₂x'² + f₁x''                                                fₙ the n-th derivative of f at x
//! f(x)'''   = f₃x'³ + 3f₂x'x'' + f₁x'''                                    Faà di Bruno
//! ```
//!
//! Sine, cosine, exponential and root are computed on the whole block, the rest number by number.

use crate::elementary::{self, acos, asin, atan, cosh, hypot, ln, log10, pow, sinh, tan, tanh};
use crate::expression::function::{Binary, Unary};
use std::array::from_fn;
use std::f64::consts::LN_10;
use std::ops::{Add, Mul, Neg, Sub};
use wide::f64x4;

/// The number of radii in a block.
pub const LANES: usize = 4;

/// One number for each radius of a block.
pub type Block = f64x4;

/// Beyond this, the reduction of an angle on the block loses digits.
const LARGEST_ANGLE: f64 = 1e5;

/// A value and its first N − 1 derivatives with respect to r, for each radius of a block; `N` from 1 to 4.
///
/// Sums over the gap often need h alone: with `N` = 1 nothing else is computed.
#[derive(Debug, Clone, Copy)]
#[must_use]
pub struct Jets<const N: usize>(pub [Block; N]);

fn all(number: f64) -> Block {
    Block::splat(number)
}

fn map(block: Block, f: impl Fn(f64) -> f64) -> Block {
    Block::from(block.to_array().map(f))
}

/// sin x and cos x; the result for one radius does not depend on the others in its block.
fn sin_cos(x: Block) -> (Block, Block) {
    let (sin, cos) = x.sin_cos();
    // NaN is not small either.
    let small = x.abs().simd_le(all(LARGEST_ANGLE));
    if small.all() {
        return (sin, cos);
    }
    (small.select(sin, map(x, elementary::sin)), small.select(cos, map(x, elementary::cos)))
}

impl<const N: usize> Jets<N> {
    /// A number: its derivatives are zero.
    pub fn number(number: f64) -> Self {
        Self::flat(all(number))
    }

    /// Numbers that do not change with r.
    fn flat(value: Block) -> Self {
        Self(from_fn(|n| if n == 0 { value } else { all(0.0) }))
    }

    /// The radii themselves.
    pub fn radii(radii: Block) -> Self {
        Self(from_fn(|n| match n {
            0 => radii,
            1 => all(1.0),
            _ => all(0.0),
        }))
    }

    /// x + c.
    pub fn shift(mut self, c: f64) -> Self {
        self.0[0] += all(c);
        self
    }

    /// c x.
    pub fn scale(self, c: f64) -> Self {
        Self(self.0.map(|x| x * all(c)))
    }

    /// x/c.
    pub fn divide(self, c: f64) -> Self {
        Self(self.0.map(|x| x / all(c)))
    }

    /// c/x.
    pub fn over(self, c: f64) -> Self {
        let x = self.0[0];
        let f = all(c) / x;
        let f1 = -f / x;
        let f2 = all(-2.0) * f1 / x;
        self.chain([f, f1, f2, all(-3.0) * f2 / x])
    }

    /// xⁿ by repeated multiplication, so that the derivatives exist at x = 0 too; `n` ≥ 2.
    pub fn integer_power(self, n: u32) -> Self {
        let (x, p) = (self.0[0], f64::from(n));
        if n == 2 {
            return self.chain([x * x, x + x, all(2.0), all(0.0)]);
        }
        let (mut low, mut square, mut left) = (all(1.0), x, n - 3);
        while left > 0 {
            if left % 2 == 1 {
                low *= square;
            }
            square *= square;
            left /= 2;
        }
        self.power_above(low * x * x * x, low, p)
    }

    /// xᵖ for any p.
    pub fn real_power(self, p: f64) -> Self {
        let x = self.0[0];
        let power = |p: f64| map(x, |x| pow(x, p));
        let value = power(p);
        let away = self.power_above(value, power(p - 3.0), p);
        let zero = x.simd_eq(all(0.0));
        if !zero.any() {
            return away;
        }
        // Where x = 0, xᵖ⁻³ may be infinite although the lower derivatives are not.
        let (c1, c2) = (p, p * (p - 1.0));
        let third = all(c2 * (p - 2.0)) * power(p - 3.0);
        self.chain([value, all(c1) * power(p - 1.0), all(c2) * power(p - 2.0), third]).or(away, zero)
    }

    /// xᵖ from its value and `low` = xᵖ⁻³.
    fn power_above(self, value: Block, low: Block, p: f64) -> Self {
        let x = self.0[0];
        let (c1, c2) = (p, p * (p - 1.0));
        let c3 = c2 * (p - 2.0);
        self.chain([value, all(c1) * low * x * x, all(c2) * low * x, all(c3) * low])
    }

    /// cˣ.
    pub fn exponential(self, c: f64) -> Self {
        let value = map(self.0[0], |x| pow(c, x));
        self.scale(ln(c)).chain([value; 4])
    }

    /// f(x) from f and its derivatives at x.
    fn chain(self, f: [Block; 4]) -> Self {
        let x = self.0;
        // Where x does not change, neither does f, not even where its slope is infinite: max(r - a, 0)^1.5.
        let rests = x[1..].iter().fold(all(0.0).simd_eq(all(0.0)), |rests, x| rests & x.simd_eq(all(0.0)));
        Self(from_fn(|n| match n {
            0 => f[0],
            1 => rests.select(all(0.0), f[1] * x[1]),
            2 => rests.select(all(0.0), f[2] * x[1] * x[1] + f[1] * x[2]),
            _ => {
                let third = f[3] * x[1] * x[1] * x[1] + all(3.0) * f[2] * x[1] * x[2] + f[1] * x[3];
                rests.select(all(0.0), third)
            }
        }))
    }

    /// These values where `mask` is set, `others` elsewhere.
    fn or(self, others: Self, mask: Block) -> Self {
        Self(from_fn(|n| mask.select(self.0[n], others.0[n])))
    }

    /// A function of one value.
    pub fn unary(self, unary: Unary) -> Self {
        let x = self.0[0];
        let one = all(1.0);
        match unary {
            Unary::Negate => -self,
            Unary::Sin => {
                let (sin, cos) = sin_cos(x);
                self.chain([sin, cos, -sin, -cos])
            }
            Unary::Cos => {
                let (sin, cos) = sin_cos(x);
                self.chain([cos, -sin, -cos, sin])
            }
            Unary::Tan => {
                let t = map(x, tan);
                let u = one + t * t;
                self.chain([t, u, all(2.0) * t * u, u * (all(2.0) + all(6.0) * t * t)])
            }
            Unary::Asin => self.arc_sine(map(x, asin), 1.0),
            Unary::Acos => self.arc_sine(map(x, acos), -1.0),
            Unary::Atan => {
                let u = one / (one + x * x);
                let f2 = all(-2.0) * x * u * u;
                self.chain([map(x, atan), u, f2, all(2.0) * u * u * (all(4.0) * x * x * u - one)])
            }
            Unary::Sinh => {
                let (sinh, cosh) = (map(x, sinh), map(x, cosh));
                self.chain([sinh, cosh, sinh, cosh])
            }
            Unary::Cosh => {
                let (sinh, cosh) = (map(x, sinh), map(x, cosh));
                self.chain([cosh, sinh, cosh, sinh])
            }
            Unary::Tanh => {
                // 1/cosh² instead of 1 - tanh²: it keeps its digits.
                let (t, u) = (map(x, tanh), map(x, |x| cosh(x).powi(-2)));
                self.chain([t, u, all(-2.0) * t * u, u * (all(4.0) * t * t - all(2.0) * u)])
            }
            Unary::Exp => self.chain([x.exp(); 4]),
            Unary::Log => self.logarithm(map(x, ln), 1.0),
            Unary::Log10 => self.logarithm(map(x, log10), LN_10),
            Unary::Sqrt => {
                let root = x.sqrt();
                let f1 = all(0.5) / root;
                let f2 = all(-0.5) * f1 / x;
                self.chain([root, f1, f2, all(-1.5) * f2 / x])
            }
            Unary::Abs => (-self).or(self, x.simd_lt(all(0.0))),
            Unary::Sign | Unary::Step => Self::flat(map(x, |x| unary.value(x))),
        }
    }

    /// arcsin x (`sign` 1) or arccos x (`sign` −1) from its value.
    fn arc_sine(self, value: Block, sign: f64) -> Self {
        let x = self.0[0];
        let u = all(1.0) / (all(1.0) - x * x);
        let f1 = all(sign) * u.sqrt();
        self.chain([value, f1, f1 * x * u, f1 * u * (all(1.0) + all(3.0) * x * x * u)])
    }

    /// ln x/`base` from its value; `base` is the natural logarithm of the base.
    fn logarithm(self, value: Block, base: f64) -> Self {
        let x = self.0[0];
        let f1 = all(1.0 / base) / x;
        let f2 = -f1 / x;
        self.chain([value, f1, f2, all(-2.0) * f2 / x])
    }

    /// A function of two values.
    pub fn binary(self, other: Self, binary: Binary) -> Self {
        let (a, b) = (self.0[0], other.0[0]);
        match binary {
            Binary::Add => self + other,
            Binary::Subtract => self - other,
            Binary::Multiply => self * other,
            Binary::Divide => self.quotient(other),
            Binary::Power => {
                let power = map_two(a, b, pow);
                (self.unary(Unary::Log) * other).chain([power; 4])
            }
            // NaN stays NaN.
            Binary::Min => self.or(other, a.simd_lt(b) | a.is_nan()),
            Binary::Max => self.or(other, a.simd_gt(b) | a.is_nan()),
            Binary::Hypot => {
                let mut root = (self * self + other * other).unary(Unary::Sqrt);
                root.0[0] = map_two(a, b, hypot);
                root
            }
        }
    }

    /// a/b from (a/b) b = a, order by order.
    fn quotient(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        let mut q = [all(0.0); N];
        for n in 0..N {
            let known = match n {
                0 => all(0.0),
                1 => q[0] * b[1],
                2 => all(2.0) * q[1] * b[1] + q[0] * b[2],
                _ => all(3.0) * (q[2] * b[1] + q[1] * b[2]) + q[0] * b[3],
            };
            q[n] = (a[n] - known) / b[0];
        }
        Self(q)
    }
}

fn map_two(a: Block, b: Block, f: impl Fn(f64, f64) -> f64) -> Block {
    let (a, b) = (a.to_array(), b.to_array());
    Block::from(from_fn(|lane| f(a[lane], b[lane])))
}

impl<const N: usize> Add for Jets<N> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(from_fn(|n| self.0[n] + other.0[n]))
    }
}

impl<const N: usize> Sub for Jets<N> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(from_fn(|n| self.0[n] - other.0[n]))
    }
}

impl<const N: usize> Neg for Jets<N> {
    type Output = Self;

    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl<const N: usize> Mul for Jets<N> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self(from_fn(|n| match n {
            0 => a[0] * b[0],
            1 => a[1] * b[0] + a[0] * b[1],
            2 => a[2] * b[0] + all(2.0) * a[1] * b[1] + a[0] * b[2],
            _ => a[3] * b[0] + all(3.0) * (a[2] * b[1] + a[1] * b[2]) + a[0] * b[3],
        }))
    }
}
