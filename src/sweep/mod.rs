//! The command `sweep`: one preset over many values of its keys, on all cores, into one CSV file.
//!
//! A row, and what can be computed for it, is defined in [`pulloff_engine::sweep`]: a pure function of the spec and the
//! row number. So a stopped sweep continues where it stopped, and joined shards give exactly the file of a single run.
//!
//! | file | what lives there |
//! |---|---|
//! | [`spec`] | the spec from the disk; the form by which its results are recognised |
//! | [`record`] | a row as a line of CSV |
//! | [`in_order`](mod@in_order) | computations on every core, with their results in order |
//! | [`run`](mod@run) | rows on every core, written in order |
//! | [`sidecar`] | the file beside the results that says which sweep they belong to |
//! | [`output`] | the file of the results: started, continued, appended to |
//! | [`ensemble`] | the members of an ensemble, and their statistics |
//! | [`shard`] | a part of the rows |
//! | [`merge`](mod@merge) | parts joined |
//! | [`check`](mod@check) | results checked without computing |
//! | [`results`] | the results read by column name |

pub mod check;
pub mod ensemble;
pub mod in_order;
pub mod merge;
pub mod output;
pub mod record;
pub mod results;
mod rows;
pub mod run;
pub mod shard;
pub mod sidecar;
pub mod spec;

pub use check::check;
pub use in_order::in_order;
pub use merge::merge;
pub use output::{Existing, Output, OutputError};
pub use results::SweepResults;
pub use run::{Means, RunSummary, run};
pub use shard::Shard;
