//! A parsed expression: its operations in the order in which they are carried out.

use super::function::{Binary, Unary};

/// One operation of a postfix program: it takes its operands from a stack and leaves its value there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Op {
    /// A number.
    Number(f64),
    /// The radius r.
    Radius,
    /// The parameter of this index.
    Parameter(usize),
    /// An operation on the value on top.
    Unary(Unary),
    /// An operation on the two values on top, the second operand uppermost.
    Binary(Binary),
}

/// An expression in r and named parameters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Program {
    /// The operations; each finds its operands on the stack.
    pub ops: Vec<Op>,
    /// The names of the parameters, in order of first appearance.
    pub parameters: Vec<String>,
}

impl Program {
    /// The value of an expression without names; with names it is not a number.
    pub fn value(&self) -> f64 {
        let mut stack = Vec::new();
        // The grammar gives every operation its operands.
        let operand = |stack: &mut Vec<f64>| stack.pop().unwrap_or(f64::NAN);
        for op in &self.ops {
            let value = match *op {
                Op::Number(number) => number,
                Op::Radius | Op::Parameter(_) => f64::NAN,
                Op::Unary(unary) => unary.value(operand(&mut stack)),
                Op::Binary(binary) => {
                    let b = operand(&mut stack);
                    binary.value(operand(&mut stack), b)
                }
            };
            stack.push(value);
        }
        operand(&mut stack)
    }
}
