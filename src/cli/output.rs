//! Where a result goes, and the one rule for every file that a command writes.
//!
//! What exists is replaced only with `--overwrite`. No command writes over what it reads, and two outputs of a command are two
//! files, whatever links lead to them, with `--overwrite` too. All this is asked before anything is computed: the inputs are
//! gathered in [`Inputs`], each output is announced to [`Outputs`], which gives back the [`OutputSink`] to write to.
//!
//! A file is written whole or not at all; standard output, a pipe or a device straight.

use super::Failure;
use crate::store::atomic::{check, explained};
use crate::store::place::FilePlace;
use crate::store::{Loaded, Overwrite, Source, WriteError, stream, write_atomically};
use crate::sweep::sidecar;
use clap::Args;
use pulloff_engine::gap::Shape;
use pulloff_engine::preset::Preset;
use pulloff_engine::text::sanitize;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Whether files that are there are replaced.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct Replacing {
    /// Replace files that are there; never one that the command reads
    #[arg(long)]
    pub overwrite: bool,
}

/// Where a result goes.
#[derive(Debug, Clone, Default, Args)]
pub struct Destination {
    /// Write to this file, in the format that its ending names, instead of standard output, which is -
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub replacing: Replacing,
}

impl Destination {
    /// The file that is named; standard output where there is none.
    pub fn path(&self) -> &Path {
        self.output.as_deref().unwrap_or(Path::new(stream::STANDARD))
    }

    /// The one output of a command that reads `inputs`.
    pub fn sink(&self, inputs: Inputs) -> Result<OutputSink, Failure> {
        Outputs::beside(inputs, self.replacing).file(OUTPUT, self.path())
    }
}

/// How messages call the option of the usual output.
pub const OUTPUT: &str = "-o";

/// The files that a command reads, each with what it is.
#[derive(Debug, Clone, Default)]
pub struct Inputs(Vec<(String, PathBuf)>);

impl Inputs {
    /// A file that is read; `-` is standard input.
    #[must_use]
    pub fn with(mut self, what: &str, path: &Path) -> Self {
        self.0.push((what.to_owned(), path.to_owned()));
        self
    }

    /// The file of a preset and those that it names; `argument` is what the person typed.
    #[must_use]
    pub fn with_problem(self, argument: Option<&Path>, loaded: &Loaded) -> Self {
        let file = match &loaded.source {
            Source::User { path, .. } | Source::File(path) => Some(&**path),
            Source::Piped { .. } => argument,
            Source::Shipped(_) => None,
        };
        let all = file.into_iter().fold(self, |all, file| all.with("the preset", file));
        all.with_data(&loaded.preset)
    }

    /// The data that a preset names.
    #[must_use]
    pub fn with_data(mut self, preset: &Preset) -> Self {
        if let Shape::Profile(measured) = &preset.gap {
            self = self.with("the profile", &measured.rows().path());
        }
        match &preset.data.source {
            Some(source) => self.with("the measured curve", &source.path()),
            None => self,
        }
    }

    /// Results of a sweep, with the file beside them.
    #[must_use]
    pub fn with_results(self, path: &Path) -> Self {
        self.with("the results", path).with("the description of the results", &sidecar::path(path))
    }
}

/// The outputs of a command, each looked at when it is announced.
#[derive(Debug)]
pub struct Outputs {
    inputs: Vec<(String, FilePlace)>,
    /// The option, and the place.
    announced: Vec<(String, FilePlace)>,
    overwrite: Overwrite,
}

impl Outputs {
    /// None yet, of a command that reads `inputs`.
    pub fn beside(inputs: Inputs, replacing: Replacing) -> Self {
        let place = |(what, path): (String, PathBuf)| FilePlace::read(&path).map(|place| (what, place));
        Self {
            inputs: inputs.0.into_iter().filter_map(place).collect(),
            announced: Vec::new(),
            overwrite: if replacing.overwrite { Overwrite::Always } else { Overwrite::Never },
        }
    }

    /// An output named by `option`.
    /// Errors: It is there already, without `--overwrite`; it is what [`kept`](Self::kept) refuses.
    pub fn file(&mut self, option: &str, path: &Path) -> Result<OutputSink, Failure> {
        self.announce(option, path, self.overwrite)?.checked()
    }

    /// An output that goes on with what is there, once its owner has looked at it.
    /// Errors: It is a file that is read, or another output; it cannot be written.
    pub fn kept(&mut self, option: &str, path: &Path) -> Result<OutputSink, Failure> {
        self.announce(option, path, Overwrite::Always)?.checked()
    }

    /// An output that may fail.
    /// Errors: It is a file that is read, or another output.
    pub fn tried(&mut self, option: &str, path: &Path) -> Result<(), Failure> {
        self.announce(option, path, Overwrite::Never).map(drop)
    }

    fn announce(&mut self, option: &str, path: &Path, overwrite: Overwrite) -> Result<OutputSink, Failure> {
        let sink = OutputSink { option: option.to_owned(), path: path.to_owned(), overwrite };
        let refused = |what: &str| Failure::Usage(format!("{} {what}", sink.name()));
        if let Some(place) = FilePlace::written(path) {
            if let Some((what, _)) = self.inputs.iter().find(|(_, input)| *input == place) {
                return Err(refused(&format!("is the file of {what} that is read; write to another")));
            }
            // What is thrown away may be thrown away twice.
            let is_null = FilePlace::written(Path::new("/dev/null")).as_ref() == Some(&place);
            match self.announced.iter().find(|(_, other)| *other == place && !is_null) {
                Some((other, _)) if other == option => {
                    return Err(refused("is written twice; name two files"));
                }
                Some((other, _)) => {
                    return Err(refused(&format!("is where the output of {other} goes; name another file")));
                }
                None => self.announced.push((option.to_owned(), place)),
            }
        }
        Ok(sink)
    }
}

/// Where one output goes.
#[derive(Debug, Clone)]
pub struct OutputSink {
    option: String,
    path: PathBuf,
    overwrite: Overwrite,
}

impl OutputSink {
    /// The same, once it was looked at.
    fn checked(self) -> Result<Self, Failure> {
        if !stream::is_stream(&self.path) {
            check(&self.path, self.overwrite).map_err(|error| self.failure(error))?;
        }
        Ok(self)
    }

    /// Writes the whole output.
    pub fn write(&self, bytes: impl AsRef<[u8]>) -> Result<(), Failure> {
        let (path, bytes) = (&*self.path, bytes.as_ref());
        if !stream::is_stream(path) {
            return write_atomically(path, bytes, self.overwrite)
                .map(drop)
                .map_err(|error| self.failure(error));
        }
        let written = stream::open(path).and_then(|mut end| end.write_all(bytes));
        written.map_err(|cause| match cause.kind() {
            ErrorKind::BrokenPipe => Failure::Closed,
            _ => WriteError::Io { path: stream::shown(path), doing: "write", cause: explained(cause) }.into(),
        })
    }

    /// The option with its file, as messages begin.
    fn name(&self) -> String {
        format!("{} {}:", self.option, shown(&self.path))
    }

    fn failure(&self, error: WriteError) -> Failure {
        match error {
            WriteError::Exists { .. } => {
                Failure::Usage(format!("{} exists already; --overwrite replaces it", self.name()))
            }
            error => error.into(),
        }
    }
}

/// Writes `text`, which no option can send elsewhere, to standard output.
pub fn print(text: impl AsRef<[u8]>) -> Result<(), Failure> {
    let path = PathBuf::from(stream::STANDARD);
    OutputSink { option: OUTPUT.to_owned(), path, overwrite: Overwrite::Never }.write(text)
}

/// A path as it can be shown.
pub fn shown(path: &Path) -> String {
    sanitize(&path.to_string_lossy(), 200)
}
