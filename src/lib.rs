//! pulloff: a terminal explorer for adhesive contact.
//!
//! This is the program. What computes is the package `pulloff-engine`; use that from code. The modules here are reached by
//! the program's own tests, benches and fuzz targets and by the Python package alone, and change freely. `ARCHITECTURE.md` draws
//! the house.

#![allow(
    missing_docs,
    clippy::missing_errors_doc,
    reason = "nobody builds on these rooms but what stands in this repository"
)]

#[cfg(feature = "program")]
pub mod cli;
#[cfg(feature = "program")]
pub mod config;
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
