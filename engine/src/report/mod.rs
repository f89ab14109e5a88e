//! What is reported: the one serializable form of what is computed.
//!
//! | file | what lives there |
//! |---|---|
//! | [`number`] | how numbers are written for people, from [`units`](crate::units) |
//! | [`problem`] | what documents begin with |
//! | [`overlap`] | the states that are not admissible, as part of a document |
//! | [`trace`] | the equilibrium curve as a document |
//! | [`path`] | an unloading, or a loop of loading and unloading, as a document |
//! | [`pull`] | pulls at a rate, and times to failure, as a document |
//! | [`slow`] | the largest pull of slow pulls as a function of their rate, in closed form |
//! | [`speeds`] | G of measured rows beside the speed of the edge as a document |
//! | [`map`] | maps of two numbers, and limit points over one, as a document |
//! | [`stability`] | the law of stability over the contact radius as a document |
//! | [`fit`] | a fit to a measured curve as a document, a table and text |
//! | [`residuals`] | the points of a fit, row by row |
//! | [`verify`] | our numbers against theory as a document |
//! | [`walk`] | the states of a walk by hand as a document |
//! | `schema` | the JSON schemas of all documents, written and checked by its test |
//! | [`rows`] | nested rows as CSV |
//! | [`path_table`] | a path as text for a terminal |
//! | [`table`] | cells in columns, a verification as text for a terminal |
//!
//! All numbers are in the user's units, in full precision. The command line, the explorer's export and tests
//! read the same documents.

pub mod columns;
pub mod fit;
pub mod map;
pub mod overlap;
pub mod path;
pub mod path_table;
pub mod problem;
pub mod pull;
pub mod residuals;
pub mod rows;
#[cfg(test)]
mod schema_tests;
pub mod slow;
pub mod speeds;
pub mod stability;
pub mod table;
pub mod trace;
pub mod verify;
pub mod walk;

pub use crate::units::number;
pub use fit::{FitReport, ModelsReport, TogetherReport};
pub use map::MapReport;
pub use overlap::OverlapReport;
pub use path::PathReport;
pub use problem::{Head, ProblemReport};
pub use pull::PullReport;
pub use speeds::SpeedsReport;
pub use stability::StabilityReport;
pub use trace::TraceReport;
pub use verify::VerifyReport;

/// The version of all documents.
pub const SCHEMA: u32 = 1;

/// A document as indented JSON with a line end.
///
/// # Errors
/// Only if a value cannot be written as JSON, which the documents' types exclude.
pub fn json(document: &impl serde::Serialize) -> Result<String, serde_json::Error> {
    let mut text = serde_json::to_string_pretty(document)?;
    text.push('\n');
    Ok(text)
}
