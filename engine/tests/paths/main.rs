//! Curves, paths, maps and the law of stability, held to tables of another program and to invariants.

#[path = "../support/mod.rs"]
mod support;

mod campaign;
mod cycle;
mod dead_band;
mod elements;
mod maps;
mod pulls;
mod range;
mod stability;
mod walk;
mod walks;
mod zones;
