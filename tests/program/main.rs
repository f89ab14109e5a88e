//! The tests of the program and of the parts that users see. They form one binary, because each binary is linked with
//! the whole program.

#[path = "../support/mod.rs"]
mod support;

mod book;
mod cli;
mod cli_input;
mod cli_output;
mod completions;
mod corners;
mod cycle;
mod device;
mod explorer;
mod explorer_along;
mod explorer_data;
mod explorer_fit;
mod explorer_gap;
mod explorer_knobs;
mod explorer_log;
mod explorer_map;
mod explorer_rings;
mod explorer_screen;
mod fit;
mod fit_rates;
mod fit_table;
mod gallery;
mod hostile_outputs;
mod hostile_values;
mod journal;
mod jumps;
mod manual;
mod map;
mod messages;
mod output_rule;
mod outputs;
mod plot;
mod pull;
mod recording;
mod release;
mod rooms;
mod run;
mod session;
mod speeds;
mod ssh;
mod statuses;
mod sweep;
mod sweep_cluster;
mod sweep_ensemble;
mod sweep_fit;
mod sweep_numbers;
mod terminal;
mod undo;
mod verify;
