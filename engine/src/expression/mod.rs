//! Expressions people type: the one grammar of gap formulas and of values.
//!
//! ```text
//! sum      = product (("+" | "-") product)*
//! product  = unary (("*" | "/") unary)*
//! unary    = ("-" | "+")* power                    -r^2 = -(r^2)
//! power    = operand ("^" unary)?                  2^3^2 = 2^(3^2), 2^-3
//! operand  = number | constant | name | function "(" sum ("," sum)? ")" | "(" sum ")"
//! ```
//!
//! A product always has its `*`, so that a name is never read as two. The result is a postfix program, evaluated by the
//! code that knows what r is: `gap::formula` with derivatives, `units` for plain numbers.
//!
//! | file | what lives there |
//! |---|---|
//! | [`grammar`] | text → program, with the limits that keep hostile text harmless |
//! | [`function`] | operations, functions, constants |
//! | [`program`] | the postfix program and its value without variables |
//! | [`error`] | what can be wrong, and where |

pub mod error;
pub mod function;
pub mod grammar;
pub mod program;

pub use error::{FormulaError, SyntaxProblem, TextPlace};
pub use program::{Op, Program};
