//! Measured curves: force over approach, position or contact radius, as an instrument hands them over.
//!
//! | file | what lives there |
//! |---|---|
//! | [`role`] | what a column is: names, units, what a person says of columns |
//! | [`read`](mod@read) | the text of a file → columns, every fault with its line and column |
//! | [`points`] | columns → points (x, P, s) in SI or reduced units |
//! | [`source`] | a file held by a preset, taken apart once |
//! | [`branches`] | points → approach and retraction, the free part, the pull-off; signs, noise |
//!
//! Nothing here reads a disk: bytes come from the caller.

pub mod branches;
pub mod points;
pub mod read;
pub mod role;
pub mod source;

pub use branches::{Asked, Branch, BranchError, Branches, Noise, Span};
pub use points::{Abscissa, Points, PointsError};
pub use read::{Column, Measured, ReadError, parse};
pub use role::{Role, Segment, Spec, SpecError};
pub use source::Source;

#[cfg(test)]
mod tests;
