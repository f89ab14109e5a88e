//! Measured curves: force over approach, position or contact radius, as an instrument hands them over.
//!
//! | file | what lives there |
//! |---|---|
//! | [`role`] | what a column is: names, units, what a person says of columns |
//! | [`read`](mod@read) | the text of a file → columns, every fault with its line and column |
//! | `header` | what a header says of the columns |
//! | [`error`] | what is wrong with a text |
//! | [`points`] | columns → points (x, P, s) in SI or reduced units |
//! | [`source`] | a file held by a preset, taken apart once |
//! | [`branches`] | points → approach and retraction, the free part, the pull-off, noise |
//! | `signs` | where the bodies are apart, and the signs of x and P |
//! | `noise` | medians, ranges, scatter |
//!
//! Nothing here reads a disk: bytes come from the caller.

pub mod branches;
pub mod error;
mod header;
mod noise;
pub mod points;
pub mod read;
pub mod role;
mod signs;
pub mod source;

pub use branches::{Asked, Branch, BranchError, Branches, Noise, Origin, Span};
pub use error::ReadError;
pub use points::{Abscissa, Points, PointsError};
pub use read::{Column, Measured, parse};
pub use role::{Role, Segment, Spec, SpecError};
pub use source::Source;

#[cfg(test)]
mod tests;
