//! The numerical tests, through the program's library: against closed forms, tables, and each other.

#[path = "../support/mod.rs"]
mod support;

mod campaign;
mod convergence;
mod every_shape;
mod exact_basis;
mod exact_unloading;
mod formula;
mod preset_gaps;
mod properties;
mod pulls;
mod random_waves;
mod reference;
mod shapes;
mod sweep_spec;
mod theory;
mod truths;
mod units;
mod work_counters;
