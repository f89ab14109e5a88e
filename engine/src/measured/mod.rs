//! Measured curves: force over approach, position or contact radius, as an instrument exports them.
//!
//! | file | what lives there |
//! |---|---|
//! | [`role`] | what a column is: its unit, what the user says about columns |
//! | `names` | the names that headers use for it |
//! | [`read`](mod@read) | the text of a file → columns; every fault with its line and column |
//! | `words` | what a line says besides its numbers, and what a cell is |
//! | `lines` | the lines of a file → tables of rows, and the words above them |
//! | `header` | the names, units and branches given by the words above a table |
//! | `choice` | which columns are used, as a header or the user specifies |
//! | `rows` | rows of cells → columns of numbers |
//! | [`stated`] | the stiffness and the tip radius that a file states |
//! | [`error`] | what is wrong with a text |
//! | [`points`] | columns → points (x, P, s) in SI or reduced units |
//! | [`source`] | a file held by a preset, parsed once |
//! | [`asked`] | what the user specifies about the rows |
//! | [`branches`] | points → approach and retraction, with their parts and their noise |
//! | `free` | a branch → the rows in contact, within the jump, and apart |
//! | `sigma` | how well the columns are known |
//! | `ends` | where the force stays constant |
//! | `signs` | the signs of x and P |
//! | `apart` | the jump behind which the bodies are apart |
//! | `turns` | where x reverses |
//! | [`converter`] | steps and ends of the range of a converter, rows that are recorded twice |
//! | `noise` | medians, ranges, scatter |
//! | [`speed`] | how fast the contact radius changes, row by row |
//!
//! Nothing here reads from disk: the caller supplies the bytes.

mod apart;
pub mod asked;
pub mod branches;
mod choice;
pub mod converter;
mod ends;
pub mod error;
mod free;
mod header;
mod lines;
mod names;
pub(crate) mod noise;
pub mod points;
pub mod read;
pub mod role;
mod rows;
mod sigma;
mod signs;
pub mod source;
pub mod speed;
pub mod stated;
mod turns;
mod words;

pub(crate) use apart::SPARSE;
pub use asked::{Asked, FreePart, ValueRange};
pub use branches::{BranchError, Branches, MeasuredBranch, Noise, Origin};
pub(crate) use ends::is_hidden;
pub use error::CurveReadError;
pub use points::{Abscissa, Instrument, Points, PointsError};
pub use read::{Column, Measured, SeenColumn, columns, parse};
pub use role::{ColumnRole, ColumnSpec, ColumnSpecError, Segment};
pub use source::PointsFile;

#[cfg(test)]
mod tests;
