//! pulloff: a terminal explorer for adhesive contact.
//!
//! This is the program. What computes is the package `pulloff-engine`; use that from code. The modules here are reached by
//! the program's own tests, benches and fuzz targets alone, and change freely. `ARCHITECTURE.md` draws the house.

#[doc(hidden)]
pub mod cli;
#[doc(hidden)]
pub mod config;
#[doc(hidden)]
pub mod explorer;
mod fault;
#[doc(hidden)]
pub mod figure;
#[doc(hidden)]
pub mod mend;
#[doc(hidden)]
pub mod plot;
#[doc(hidden)]
pub mod print;
#[doc(hidden)]
pub mod store;
#[doc(hidden)]
pub mod sweep;
#[doc(hidden)]
pub mod tui;
