//! The number of threads that a command works on.

use clap::Args;
use std::num::NonZeroUsize;
use std::thread::available_parallelism;

/// The option.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct Jobs {
    /// Threads, at most 1024 [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
}

impl Jobs {
    /// The number of threads.
    pub fn count(self) -> usize {
        let cores = || available_parallelism().map_or(1, NonZeroUsize::get);
        self.jobs.map_or_else(cores, usize::from)
    }
}
