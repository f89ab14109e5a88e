//! Faults on demand: places where a build with the feature `fault-injection` panics if `PULLOFF_PANIC` names them.
//!
//! With them, the tests can show what a panic in each thread leaves behind. Without the feature nothing is compiled in.

/// The drawing thread, at a key.
pub const UI: &str = "ui";
/// The lane that computes the curves, at a curve.
pub const WORKER: &str = "worker";
/// The thread that reads the terminal, at a key.
pub const INPUT: &str = "input";
/// The thread that handles signals, at a signal.
pub const SIGNAL: &str = "signal";

/// Panics if `PULLOFF_PANIC` is `place`.
#[cfg(feature = "fault-injection")]
pub fn point(place: &str) {
    let wanted = std::env::var_os("PULLOFF_PANIC").is_some_and(|wanted| wanted == place);
    assert!(!wanted, "PULLOFF_PANIC={place}");
}

/// Does nothing in this build.
#[cfg(not(feature = "fault-injection"))]
pub const fn point(_place: &str) {}
