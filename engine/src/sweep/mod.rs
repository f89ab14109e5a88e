//! Sweeps: one preset over many values of its keys, row by row.
//!
//! A spec names the preset, the axes and the quantities wanted. Row n of the results is a pure function of the spec and n:
//! in a grid the last axis runs fastest, at random each row has its own random numbers, and so has each member of an ensemble. So
//! any part of the rows can be computed anywhere, in any order.
//!
//! | file | what lives there |
//! |---|---|
//! | [`spec`] | the spec read, and the values of each row |
//! | [`axis`] | one axis: its values, or what they are drawn from |
//! | [`document`] | TOML entry by entry, each mistake with its line |
//! | [`quantity`] | the table of quantities |
//! | [`stage`] | what quantities are computed from |
//! | [`measure`](mod@measure) | the wanted quantities of one preset |
//! | [`ensemble`] | what many members say of a quantity |
//! | [`fault`] | why a row has no result |

pub mod axis;
pub mod document;
pub mod ensemble;
pub mod fault;
pub mod measure;
pub mod quantity;
pub mod spec;
pub mod stage;

pub use document::SpecError;
pub use fault::Fault;
pub use measure::MeasuredQuantities;
pub use quantity::{QUANTITIES, QuantityColumn, SweepQuantity};
pub use spec::Spec;
pub use stage::Cell;

/// The most rows of a sweep.
pub const MOST_ROWS: u64 = 10_000_000;
