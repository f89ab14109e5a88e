//! The formula with its parameters inserted and its constants folded; the rest becomes steps over a block of radii.

use crate::expression::function::{Binary, Unary};
use crate::expression::{Op, Program};
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// The largest integer power done by repeated multiplication.
const LARGEST_POWER: f64 = 1024.0;

/// One step on a stack of blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FormulaStep {
    /// Pushes a number.
    Number(f64),
    /// Pushes the radii.
    Radius,
    /// x → f(x).
    Unary(Unary),
    /// (a, b) → f(a, b).
    Binary(Binary),
    /// x → x + c.
    Shift(f64),
    /// x → c x.
    Scale(f64),
    /// x → x/c.
    Divide(f64),
    /// x → c/x.
    Over(f64),
    /// x → xⁿ.
    IntegerPower(u32),
    /// x → xᵖ.
    RealPower(f64),
    /// x → cˣ.
    Exponential(f64),
}

/// A periodic function and the steps of its argument.
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaWave {
    /// The steps of the argument.
    pub argument: Range<usize>,
    /// The period of the function in its argument.
    pub period: f64,
}

/// The quantity that is zero where the formula may not be smooth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Zero {
    /// x, or x − y: the argument of abs, sign, step, of a root, a broken power or a logarithm, or what min and max
    /// compare.
    Difference,
    /// x² + y², the radicand of hypot.
    Squares,
    /// 1 − x², the radicand of the slopes of arcsin and arccos.
    Unit,
}

/// Steps whose values decide where the formula may not be smooth.
#[derive(Debug, Clone, PartialEq)]
pub struct Switch {
    /// The steps of x.
    pub argument: Range<usize>,
    /// The steps of y, where there are two.
    pub other: Option<Range<usize>>,
    /// Which quantity made from them is zero there.
    pub zero: Zero,
}

/// The formula as steps.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Steps {
    /// The steps; they leave one block.
    pub steps: Vec<FormulaStep>,
    /// The largest number of blocks on the stack.
    pub depth: usize,
    /// Its periodic functions.
    pub waves: Vec<FormulaWave>,
    /// Where it may not be smooth.
    pub switches: Vec<Switch>,
}

/// A value on the stack while the steps are written.
#[derive(Debug, Clone, Copy)]
enum StackSlot {
    /// Known now; no step has been written for it.
    Constant(f64),
    /// Computed by the steps from here on.
    From(usize),
}

/// The steps of `program` with these values for its parameters.
pub fn fold(program: &Program, parameters: &[f64]) -> Steps {
    let mut folder = ConstantFolding::default();
    for op in &program.ops {
        match *op {
            Op::Number(number) => folder.slots.push(StackSlot::Constant(number)),
            Op::Parameter(index) => folder.slots.push(StackSlot::Constant(parameters[index])),
            Op::Radius => {
                folder.slots.push(StackSlot::From(folder.out.steps.len()));
                folder.out.steps.push(FormulaStep::Radius);
            }
            Op::Unary(unary) => folder.unary(unary),
            Op::Binary(binary) => folder.binary(binary),
        }
    }
    if let StackSlot::Constant(number) = folder.pop() {
        folder.out.steps.push(FormulaStep::Number(number));
    }
    folder.out.depth = depth(&folder.out.steps);
    folder.out
}

#[derive(Default)]
struct ConstantFolding {
    out: Steps,
    slots: Vec<StackSlot>,
}

impl ConstantFolding {
    fn pop(&mut self) -> StackSlot {
        // The grammar ensures that every operation has its operands.
        self.slots.pop().unwrap_or(StackSlot::Constant(f64::NAN))
    }

    fn unary(&mut self, unary: Unary) {
        let slot = self.pop();
        match slot {
            StackSlot::Constant(x) => self.slots.push(StackSlot::Constant(unary.value(x))),
            StackSlot::From(start) => self.step(start, FormulaStep::Unary(unary)),
        }
    }

    /// Adds a step on the value computed by the steps from `start` on.
    fn step(&mut self, start: usize, step: FormulaStep) {
        let argument = start..self.out.steps.len();
        let wave = |period| FormulaWave { argument: argument.clone(), period };
        let switch = |zero| Switch { argument: argument.clone(), other: None, zero };
        match step {
            FormulaStep::Unary(Unary::Sin | Unary::Cos) => self.out.waves.push(wave(TAU)),
            FormulaStep::Unary(Unary::Tan) => self.out.waves.push(wave(PI)),
            FormulaStep::Unary(
                Unary::Abs | Unary::Sign | Unary::Step | Unary::Sqrt | Unary::Log | Unary::Log10,
            ) => {
                self.out.switches.push(switch(Zero::Difference));
            }
            FormulaStep::RealPower(p) if p.fract() != 0.0 => self.out.switches.push(switch(Zero::Difference)),
            FormulaStep::Unary(Unary::Asin | Unary::Acos) => self.out.switches.push(switch(Zero::Unit)),
            _ => {}
        }
        self.out.steps.push(step);
        self.slots.push(StackSlot::From(start));
    }

    /// Replaces the steps from `start` on by the number that they amount to.
    fn replace(&mut self, start: usize, number: f64) {
        self.out.steps.truncate(start);
        self.out.waves.retain(|wave| wave.argument.end <= start);
        self.out.switches.retain(|switch| switch.argument.end <= start);
        self.slots.push(StackSlot::Constant(number));
    }

    fn binary(&mut self, binary: Binary) {
        let (b, a) = (self.pop(), self.pop());
        match (a, b) {
            (StackSlot::Constant(a), StackSlot::Constant(b)) => {
                self.slots.push(StackSlot::Constant(binary.value(a, b)));
            }
            (StackSlot::From(start), StackSlot::From(second)) => {
                self.compared(binary, start, second);
                self.step(start, FormulaStep::Binary(binary));
            }
            (StackSlot::From(start), StackSlot::Constant(c)) => self.with_second(binary, start, c),
            (StackSlot::Constant(c), StackSlot::From(start)) => match binary {
                Binary::Subtract => {
                    self.out.steps.push(FormulaStep::Unary(Unary::Negate));
                    self.step(start, FormulaStep::Shift(c));
                }
                Binary::Divide if c == 0.0 => self.replace(start, 0.0),
                Binary::Divide => self.step(start, FormulaStep::Over(c)),
                Binary::Power => self.step(start, FormulaStep::Exponential(c)),
                symmetric => self.with_second(symmetric, start, c),
            },
        }
    }

    /// Records where an operation may not be smooth whose operands are computed by the steps from `start` on and from
    /// `second` on.
    fn compared(&mut self, binary: Binary, start: usize, second: usize) {
        let other = Some(second..self.out.steps.len());
        let (other, zero) = match binary {
            Binary::Min | Binary::Max => (other, Zero::Difference),
            Binary::Hypot => (other, Zero::Squares),
            Binary::Power => (None, Zero::Difference),
            _ => return,
        };
        self.out.switches.push(Switch { argument: start..second, other, zero });
    }

    /// An operation whose second operand is a number.
    fn with_second(&mut self, binary: Binary, start: usize, c: f64) {
        match binary {
            Binary::Add => self.step(start, FormulaStep::Shift(c)),
            Binary::Subtract => self.step(start, FormulaStep::Shift(-c)),
            // A wave without amplitude is no feature: no trace of it may remain.
            Binary::Multiply if c == 0.0 => self.replace(start, 0.0),
            Binary::Multiply => self.step(start, FormulaStep::Scale(c)),
            Binary::Divide => self.step(start, FormulaStep::Divide(c)),
            Binary::Power => self.power(start, c),
            Binary::Min | Binary::Max | Binary::Hypot => {
                let second = self.out.steps.len();
                self.out.steps.push(FormulaStep::Number(c));
                self.compared(binary, start, second);
                self.step(start, FormulaStep::Binary(binary));
            }
        }
    }

    fn power(&mut self, start: usize, p: f64) {
        if p == 0.0 {
            return self.replace(start, 1.0);
        }
        if p.fract() != 0.0 || p.abs() > LARGEST_POWER {
            return self.step(start, FormulaStep::RealPower(p));
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small integer by now")]
        let n = p.abs() as u32;
        if p < 0.0 {
            self.step(start, FormulaStep::Over(1.0));
            self.slots.pop();
        }
        if n > 1 {
            self.step(start, FormulaStep::IntegerPower(n));
        } else {
            self.slots.push(StackSlot::From(start));
        }
    }
}

fn depth(steps: &[FormulaStep]) -> usize {
    let (mut depth, mut deepest) = (0, 0);
    for step in steps {
        match step {
            FormulaStep::Number(_) | FormulaStep::Radius => depth += 1,
            FormulaStep::Binary(_) => depth -= 1,
            _ => {}
        }
        deepest = deepest.max(depth);
    }
    deepest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::grammar::formula;

    fn steps(text: &str) -> Steps {
        fold(&formula(text).unwrap(), &[])
    }

    #[test]
    fn constants_are_folded() {
        assert_eq!(steps("2*pi/4").steps, [FormulaStep::Number(PI / 2.0)]);
        assert_eq!(
            steps("3 - r").steps,
            [FormulaStep::Radius, FormulaStep::Unary(Unary::Negate), FormulaStep::Shift(3.0)]
        );
        assert_eq!(
            steps("r^2/(2*3)").steps,
            [FormulaStep::Radius, FormulaStep::IntegerPower(2), FormulaStep::Divide(6.0)]
        );
        assert_eq!(steps("2^r").steps, [FormulaStep::Radius, FormulaStep::Exponential(2.0)]);
        assert_eq!(
            steps("r^-2").steps,
            [FormulaStep::Radius, FormulaStep::Over(1.0), FormulaStep::IntegerPower(2)]
        );
        assert_eq!(steps("r^1 + r^0").steps, [FormulaStep::Radius, FormulaStep::Shift(1.0)]);
        assert_eq!(steps("r + (r + (r + r))").depth, 4);
    }

    #[test]
    fn what_is_multiplied_by_zero_leaves_no_wave_and_no_switch() {
        let wavy = steps("r^2 + sin(3*r)*tan(r)/sqrt(r)");
        assert_eq!((wavy.waves.len(), wavy.switches.len()), (2, 1));
        assert_eq!(wavy.waves[0].argument, 2..4);
        let flat = steps("cos(r) + 0*(sin(3*r)*tan(r)/sqrt(r))");
        assert_eq!((flat.waves.len(), flat.switches.len()), (1, 0));
    }
}
