//! pulloff.

pub mod contact;
