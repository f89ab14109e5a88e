//! Sweeps: one preset over many values of its keys, row by row.
//!
//! A spec names the preset, the axes and the quantities wanted. Row n of the results is a pure function of the spec and
//! n: in a grid the last axis runs fastest; in a random design each row has its own random numbers, and in an ensemble
//! so has each member. Any part of the rows can therefore be computed anywhere, in any order.
//!
//! | file | what lives there |
//! |---|---|
//! | [`spec`] | reads the spec, and gives the values of each row |
//! | [`axis`] | one axis: its values, or the distribution they are drawn from |
//! | [`document`] | TOML entry by entry, with the line of each mistake |
//! | [`quantity`] | the table of quantities |
//! | [`stage`] | what quantities are computed from |
//! | [`measure`](mod@measure) | the wanted quantities of one preset |
//! | [`ensemble`] | what the members say about a quantity |
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
