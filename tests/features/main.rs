//! The tests of builds with other features: one that panics on demand (`fault-injection`), and one that draws PDF (`pdf`).

#[path = "../support/mod.rs"]
mod support;

mod faults;
#[cfg(feature = "pdf")]
mod pdf;
