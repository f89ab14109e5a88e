//! pulloff.

pub mod case;
pub mod cli;
pub mod contact;
pub mod continuation;
pub mod explorer;
pub mod preset;
pub mod quasistatic;
pub mod report;
pub mod ritz;
pub mod theory;
#[cfg(feature = "tui")]
pub mod tui;
