//! Sweeps: one preset over many values of its keys, on all cores, into one CSV file.
//!
//! A spec names the preset, the axes and the quantities wanted. Row n of the results is a pure function of the spec and n:
//! in a grid the last axis runs fastest, at random each row has its own random numbers. So any part of the rows can be
//! computed anywhere, a stopped sweep goes on where it stopped, and shards join to the very file of a single run.
//!
//! | file | what lives there |
//! |---|---|
//! | [`spec`] | the spec read, and the values of each row |
//! | [`axis`] | one axis: its values, or what they are drawn from |
//! | `document` | TOML entry by entry, each mistake with its line |
//! | [`quantity`] | the table of quantities |
//! | `stage` | what quantities are computed from |
//! | [`measure`](mod@measure) | the wanted quantities of one preset |
//! | [`fault`] | why a row has no result |
//! | [`record`] | a row as a line of CSV |
//! | [`run`](mod@run) | rows on every core, written in order |
//! | [`sidecar`] | the file beside the results that says what they are of |
//! | [`output`] | the file of the results: begun, gone on with, appended to |
//! | [`shard`] | a part of the rows |
//! | [`merge`](mod@merge) | parts joined |
//! | [`results`] | the results read by the name of a column |

pub mod axis;
mod document;
pub mod fault;
pub mod measure;
pub mod merge;
pub mod output;
pub mod quantity;
pub mod record;
pub mod results;
pub mod run;
pub mod shard;
pub mod sidecar;
pub mod spec;
mod stage;

pub use document::SpecError;
pub use fault::Fault;
pub use merge::merge;
pub use output::{Existing, Output, OutputError};
pub use quantity::{Column, QUANTITIES, Quantity};
pub use results::Results;
pub use run::{Summary, run};
pub use shard::Shard;
pub use spec::Spec;

/// The most rows of a sweep.
pub const MOST_ROWS: u64 = 10_000_000;
