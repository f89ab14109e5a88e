//! The operations of an expression and what they give for plain numbers.

use crate::elementary::{acos, asin, atan, cos, cosh, exp, hypot, ln, log10, pow, sin, sinh, tan, tanh};
use std::f64::consts::{E, PI};

/// The variable of a gap formula.
pub const RADIUS: &str = "r";

/// The constants and their values.
pub const CONSTANTS: [(&str, f64); 2] = [("pi", PI), ("e", E)];

/// An operation on one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unary {
    /// −x.
    Negate,
    /// sin x, in radians like all angles.
    Sin,
    /// cos x.
    Cos,
    /// tan x.
    Tan,
    /// arcsin x, not a number beyond ±1.
    Asin,
    /// arccos x, not a number beyond ±1.
    Acos,
    /// arctan x.
    Atan,
    /// sinh x.
    Sinh,
    /// cosh x.
    Cosh,
    /// tanh x.
    Tanh,
    /// eˣ.
    Exp,
    /// The natural logarithm, `log` or `ln`.
    Log,
    /// The logarithm to base 10.
    Log10,
    /// √x.
    Sqrt,
    /// |x|.
    Abs,
    /// −1, 0 or 1.
    Sign,
    /// 0 below zero, 1 from zero on.
    Step,
}

/// An operation on two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Binary {
    /// a + b.
    Add,
    /// a − b.
    Subtract,
    /// a b.
    Multiply,
    /// a/b.
    Divide,
    /// aᵇ, `a^b` or `pow(a, b)`.
    Power,
    /// The smaller.
    Min,
    /// The larger.
    Max,
    /// √(a² + b²) without overflow.
    Hypot,
}

/// What a function's name stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Function {
    /// A function of one argument.
    One(Unary),
    /// A function of two arguments.
    Two(Binary),
}

/// The functions by name.
pub const FUNCTIONS: [(&str, Function); 21] = [
    ("sin", Function::One(Unary::Sin)),
    ("cos", Function::One(Unary::Cos)),
    ("tan", Function::One(Unary::Tan)),
    ("asin", Function::One(Unary::Asin)),
    ("acos", Function::One(Unary::Acos)),
    ("atan", Function::One(Unary::Atan)),
    ("sinh", Function::One(Unary::Sinh)),
    ("cosh", Function::One(Unary::Cosh)),
    ("tanh", Function::One(Unary::Tanh)),
    ("exp", Function::One(Unary::Exp)),
    ("log", Function::One(Unary::Log)),
    ("ln", Function::One(Unary::Log)),
    ("log10", Function::One(Unary::Log10)),
    ("sqrt", Function::One(Unary::Sqrt)),
    ("abs", Function::One(Unary::Abs)),
    ("sign", Function::One(Unary::Sign)),
    ("step", Function::One(Unary::Step)),
    ("min", Function::Two(Binary::Min)),
    ("max", Function::Two(Binary::Max)),
    ("pow", Function::Two(Binary::Power)),
    ("hypot", Function::Two(Binary::Hypot)),
];

impl Function {
    /// The function of this name.
    pub fn named(name: &str) -> Option<Self> {
        FUNCTIONS.iter().find(|(known, _)| *known == name).map(|&(_, function)| function)
    }

    /// The number of its arguments.
    pub fn arguments(self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Two(_) => 2,
        }
    }
}

/// The value of the constant of this name.
pub fn constant(name: &str) -> Option<f64> {
    CONSTANTS.iter().find(|(known, _)| *known == name).map(|&(_, value)| value)
}

impl Unary {
    /// The value at `x`: infinite or not a number where it is not defined.
    pub fn value(self, x: f64) -> f64 {
        match self {
            Self::Negate => -x,
            Self::Sin => sin(x),
            Self::Cos => cos(x),
            Self::Tan => tan(x),
            Self::Asin => asin(x),
            Self::Acos => acos(x),
            Self::Atan => atan(x),
            Self::Sinh => sinh(x),
            Self::Cosh => cosh(x),
            Self::Tanh => tanh(x),
            Self::Exp => exp(x),
            Self::Log => ln(x),
            Self::Log10 => log10(x),
            Self::Sqrt => x.sqrt(),
            Self::Abs => x.abs(),
            // `signum` would call the sign of zero 1.
            Self::Sign if x == 0.0 => 0.0,
            Self::Sign => x.signum(),
            Self::Step if x.is_nan() => x,
            Self::Step => f64::from(u8::from(x >= 0.0)),
        }
    }
}

impl Binary {
    /// The value at (`a`, `b`): infinite or not a number where it is not defined.
    pub fn value(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Power => pow(a, b),
            // `f64::min` would hide a value that is not a number.
            Self::Min | Self::Max if a.is_nan() || b.is_nan() => f64::NAN,
            Self::Min => a.min(b),
            Self::Max => a.max(b),
            Self::Hypot => hypot(a, b),
        }
    }
}
