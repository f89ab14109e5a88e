//! pulloff: a terminal explorer for adhesive contact.
//!
//! This is the program. The computing part is the package `pulloff-engine`; use that from code. The modules here are
//! for the program's own tests, benches and fuzz targets and for the Python package only, and may change at any time.
//! `ARCHITECTURE.md` describes the structure.

#![allow(
    missing_docs,
    clippy::missing_errors_doc,
    reason = "only code in this repository uses these modules"
)]

#[cfg(feature = "program")]
pub mod cli;
#[cfg(feature = "program")]
pub mod explorer;
#[cfg(feature = "program")]
mod fault;
#[cfg(feature = "program")]
pub mod figure;
pub mod mend;
#[cfg(feature = "program")]
pub mod plot;
#[cfg(feature = "program")]
pub mod print;
pub mod store;
pub mod sweep;
#[cfg(feature = "program")]
pub mod tui;
