//! Curves, paths, maps and the law of stability, checked against tables of another program and against invariants.

#[path = "../support/mod.rs"]
mod support;

mod campaign;
mod cycle;
mod dead_band;
mod elements;
mod maps;
mod no_adhesion;
mod pulls;
mod range;
mod stability;
mod walk;
mod walks;
mod zones;
