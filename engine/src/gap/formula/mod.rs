//! Gap formulas: h(r) as a user writes it, such as `r^2/(2*R) + A*(1 - cos(2*pi*r/lambda))`.
//!
//! The text is an expression of [`expression`](crate::expression) in the radius `r` and named parameters. With its
//! parameters given, it becomes a straight-line program over blocks of radii that carries h, h', h'', h''' together
//! (forward differentiation), so the derivatives are exact to rounding. The gap is measured from its value on the axis:
//! h(0) is subtracted.
//!
//! On the axis only h must be finite. The derivatives of formulas such as `sqrt(r^2)` or `r^1.5` are not numbers there;
//! no quadrature has a node on the axis.
//!
//! | file | what lives there |
//! |---|---|
//! | [`fold`] | parameters inserted, constants folded: text order → steps |
//! | [`jets`] | the rules of differentiation, on a block of radii |
//! | [`bound`] | the formula with its parameters given: h and its derivatives anywhere |
//! | `ball` | functions on complex discs: a value and how far it can change |
//! | `discs` | the formula and its slope on discs and on intervals |
//! | [`corners`] | where it is not smooth |
//! | [`survey`] | is it finite and continuous up to a radius, and how short are its waves? |
//! | [`gap`] | the formula as the gap of a problem |
//! | [`typed`] | its text and its parameters, with the lengths that follow |

mod ball;
pub mod bound;
pub mod corners;
mod discs;
pub mod fold;
pub mod gap;
pub mod jets;
pub mod survey;
pub mod typed;

pub use crate::expression::{FormulaError, SyntaxProblem, TextPlace};
pub use bound::Bound;
pub use gap::FormulaGap;
pub use survey::NoGap;
pub use typed::{FormulaParameter, TypedError, TypedGap};

use crate::expression::Program;
use crate::expression::error::NAME;
use crate::expression::grammar;
use crate::expression::program::Op;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A gap formula whose parameters are still open.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    text: String,
    program: Program,
}

/// Why parameters do not fit a formula.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum BindError {
    /// A parameter without a value.
    #[error("the parameter {name} of the formula has no value")]
    Missing {
        /// The parameter.
        name: String,
    },
    /// A value for a parameter that the formula does not have.
    #[error("the formula has no parameter {name}; it has: {known}")]
    Unknown {
        /// The name given, short and safe to show.
        name: String,
        /// The parameters it has.
        known: String,
    },
    /// Two values for one parameter.
    #[error("the parameter {name} of the formula has two values")]
    Twice {
        /// The parameter.
        name: String,
    },
    /// A value that is not a finite number.
    #[error("the parameter {name} = {value} of the formula must be a finite number")]
    NotFinite {
        /// The parameter.
        name: String,
        /// Its value.
        value: f64,
    },
}

impl Formula {
    /// The formula of this text.
    ///
    /// # Errors
    /// What is wrong with the text, and at which column.
    pub fn parse(text: &str) -> Result<Self, FormulaError> {
        Ok(Self { text: text.to_owned(), program: grammar::formula(text)? })
    }

    /// The names of the parameters, in order of first appearance.
    pub fn parameters(&self) -> &[String] {
        &self.program.parameters
    }

    /// Whether r occurs in it.
    pub fn has_radius(&self) -> bool {
        self.program.ops.contains(&Op::Radius)
    }

    /// The formula with these values for its parameters, in any order and any consistent units.
    ///
    /// # Errors
    /// A parameter without a value, with two values, or with one that is not finite; a value for an unknown parameter.
    pub fn bind(&self, values: &[(&str, f64)]) -> Result<Bound, BindError> {
        let names = self.parameters();
        let mut given = vec![None; names.len()];
        for &(name, value) in values {
            let Some(index) = names.iter().position(|known| known == name) else {
                let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
                let name = name.chars().take(NAME).flat_map(char::escape_debug).collect();
                return Err(BindError::Unknown { name, known });
            };
            let name = || name.to_owned();
            if !value.is_finite() {
                return Err(BindError::NotFinite { name: name(), value });
            }
            if given[index].replace(value).is_some() {
                return Err(BindError::Twice { name: name() });
            }
        }
        let missing = |(name, value): (&String, Option<f64>)| {
            value.ok_or_else(|| BindError::Missing { name: name.clone() })
        };
        let values: Vec<f64> = names.iter().zip(given).map(missing).collect::<Result<_, _>>()?;
        Ok(Bound::new(fold::fold(&self.program, &values)))
    }
}

impl FromStr for Formula {
    type Err = FormulaError;

    fn from_str(text: &str) -> Result<Self, FormulaError> {
        Self::parse(text)
    }
}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_must_fit() {
        let formula = Formula::parse("r^2/(2*R) + A").unwrap();
        assert_eq!(formula.parameters(), ["R", "A"]);
        assert_eq!(formula.to_string().parse(), Ok(formula.clone()));
        for (values, message) in [
            (&[("R", 1.0)][..], "the parameter A of the formula has no value"),
            (&[("R", 1.0), ("R", 2.0)], "the parameter R of the formula has two values"),
            (&[("R", f64::NAN)], "the parameter R = NaN of the formula must be a finite number"),
            (&[("r", 1.0)], "the formula has no parameter r; it has: R, A"),
        ] {
            assert_eq!(formula.bind(values).unwrap_err().to_string(), message);
        }
        assert!(formula.bind(&[("A", 1.0), ("R", 1.0)]).is_ok());
    }
}
