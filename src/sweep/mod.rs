//! The command `sweep`: one preset over many values of its keys, on all cores, into one CSV file.
//!
//! What a row is, and what can be computed of it, is in [`pulloff_engine::sweep`]: a pure function of the spec and the number
//! of the row. So a stopped sweep goes on where it stopped, and shards join to the very file of a single run.
//!
//! | file | what lives there |
//! |---|---|
//! | [`spec`] | the spec from the disk; the form by which its results are known again |
//! | [`record`] | a row as a line of CSV |
//! | [`in_order`](mod@in_order) | computations on every core, their results in order |
//! | [`run`](mod@run) | rows on every core, written in order |
//! | [`sidecar`] | the file beside the results that says what they are of |
//! | [`output`] | the file of the results: begun, gone on with, appended to |
//! | [`ensemble`] | the members of an ensemble, and what they say together |
//! | [`shard`] | a part of the rows |
//! | [`merge`](mod@merge) | parts joined |
//! | [`check`](mod@check) | results looked at without computing |
//! | [`results`] | the results read by the name of a column |

pub mod check;
pub mod ensemble;
pub mod in_order;
pub mod merge;
pub mod output;
pub mod record;
pub mod results;
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
