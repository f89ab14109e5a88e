//! pulloff.

pub mod contact;
pub mod continuation;
pub mod quasistatic;
pub mod ritz;
pub mod theory;
