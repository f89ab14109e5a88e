//! What the commands that compute one document from one preset have in common.

use super::Failure;
use super::console::{Console, Messages};
use super::format::{Format, FormatArgument};
use super::output::{Destination, OutputSink};
use super::problem::ProblemArguments;
use clap::Args;
use pulloff_engine::preset::Preset;

/// The problem, and where and in which format the document is written.
#[derive(Debug, Args)]
pub struct Computed {
    #[command(flatten)]
    problem: ProblemArguments,
    #[command(flatten)]
    format: FormatArgument,
    #[command(flatten)]
    destination: Destination,
    #[command(flatten)]
    messages: Messages,
}

/// The same, with the preset read and the output opened.
pub struct Opened {
    pub console: Console,
    pub format: Format,
    pub preset: Preset,
    pub sink: OutputSink,
}

impl Computed {
    /// Reads the preset and makes sure that the document can be written, in the `usual` format where none is asked for.
    pub fn open(&self, usual: Format) -> Result<Opened, Failure> {
        let console = self.messages.open();
        let format = self.format.of(self.destination.path(), usual)?;
        let loaded = self.problem.load_for(true, &console)?;
        let sink = self.destination.sink(self.problem.inputs(&loaded))?;
        Ok(Opened { console, format, preset: loaded.preset, sink })
    }
}
