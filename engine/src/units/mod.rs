//! Values with units, as people type and read them: `30 mJ/m^2`, `3*pi/2 um`, `2.5 MPa`.
//!
//! A value is an expression of numbers ([`expression`](crate::expression), the grammar of gap formulas), optionally
//! followed by a product of units. Dimensions are the exponents of metre, kilogram and second; an angle has none.
//! Factors are kept as decimal powers, so `12.5 um` is the double nearest to 12.5·10⁻⁶.
//!
//! | file | what lives there |
//! |---|---|
//! | [`dimension`] | exponent vectors, and the quantities of contact mechanics |
//! | [`table`] | unit names and SI prefixes |
//! | [`mod@unit`] | a product of units, read and written |
//! | [`value`] | reads a number with its unit |
//! | [`number`] | how numbers are written for people |
//! | [`system`] | reduced or SI: how a quantity is typed and shown |

pub mod dimension;
pub mod number;
pub mod system;
pub mod table;
pub mod unit;
pub mod value;

pub use dimension::{Dimension, Quantity};
pub use system::{DisplayUnits, Shown, UnitSystem};
pub use unit::{Unit, UnitError};
pub use value::{TypedValue, ValueError, parse_quantity, range_ends};
