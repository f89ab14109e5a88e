//! pulloff: a terminal explorer for adhesive contact.
//!
//! This is the program. What computes is the package `pulloff-engine`; use that from code. The modules here are reached by
//! the program's own tests, benches and fuzz targets and by the Python package alone, and change freely. `ARCHITECTURE.md` draws
//! the house.

#[cfg(feature = "program")]
#[doc(hidden)]
pub mod cli;
#[cfg(feature = "program")]
#[doc(hidden)]
pub mod config;
#[cfg(feature = "program")]
#[doc(hidden)]
pub mod explorer;
#[cfg(feature = "program")]
mod fault;
#[cfg(feature = "program")]
#[doc(hidden)]
pub mod figure;
#[doc(hidden)]
pub mod mend;
#[cfg(feature = "program")]
#[doc(hidden)]
pub mod plot;
#[cfg(feature = "program")]
#[doc(hidden)]
pub mod print;
#[doc(hidden)]
pub mod store;
#[doc(hidden)]
pub mod sweep;
#[cfg(feature = "program")]
#[doc(hidden)]
pub mod tui;
