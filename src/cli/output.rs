//! Where a result goes, and the one rule for every file that a command writes.
//!
//! An existing file is replaced only with `--overwrite`. Even then, no command overwrites what it reads, and two
//! outputs of a command are two distinct files, whatever links lead to them. All this is checked before anything is
//! computed: the inputs are gathered in [`Inputs`], and each output is announced to [`Outputs`], which returns the
//! [`OutputSink`] to write to.
//!
//! A file is written as a whole or not at all; standard output, a pipe or a device is written to directly.

use super::Failure;
use crate::store::atomic::{check, explained};
use crate::store::place::FilePlace;
use crate::store::{Loaded, Overwrite, Source, WriteError, stream, write_atomically};
use crate::sweep::sidecar;
use clap::Args;
use pulloff_engine::gap::Shape;
use pulloff_engine::preset::Preset;
use pulloff_engine::text::sanitize;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// Whether existing files are replaced.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct Replacing {
    /// Replace existing files; never one that the command reads
    #[arg(long)]
    pub overwrite: bool,
}

/// Where a result goes.
#[derive(Debug, Clone, Default, Args)]
pub struct Destination {
    /// Write to this file, in the format of its extension, instead of to standard output, which is -
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub replacing: Replacing,
}

impl Destination {
    /// The named file, or standard output where there is none.
    pub fn path(&self) -> &Path {
        self.output.as_deref().unwrap_or(Path::new(stream::STANDARD))
    }

    /// Whether what goes there is read where messages are.
    pub fn is_terminal(&self) -> bool {
        self.path() == Path::new(stream::STANDARD) && io::stdout().is_terminal() && io::stderr().is_terminal()
    }

    /// The only output of a command that reads `inputs`.
    pub fn sink(&self, inputs: Inputs) -> Result<OutputSink, Failure> {
        Outputs::beside(inputs, self.replacing).file(OUTPUT, self.path())
    }
}

/// How messages name the option for the usual output.
pub const OUTPUT: &str = "-o";

/// The files that a command reads, each with a description.
#[derive(Debug, Clone, Default)]
pub struct Inputs(Vec<(String, PathBuf)>);

impl Inputs {
    /// Adds a file that is read; `-` is standard input.
    #[must_use]
    pub fn with(mut self, what: &str, path: &Path) -> Self {
        self.0.push((what.to_owned(), path.to_owned()));
        self
    }

    /// Adds the file of a preset and the files that it names; `argument` is what the user typed.
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

    /// Adds the data files that a preset names.
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

    /// Adds the results of a sweep, with the file beside them.
    #[must_use]
    pub fn with_results(self, path: &Path) -> Self {
        self.with("the results", path).with("the description of the results", &sidecar::path(path))
    }
}

/// The outputs of a command, each checked when it is announced.
#[derive(Debug)]
pub struct Outputs {
    inputs: Vec<(String, FilePlace)>,
    /// The option and the place.
    announced: Vec<(String, FilePlace)>,
    overwrite: Overwrite,
}

impl Outputs {
    /// No outputs yet, for a command that reads `inputs`.
    pub fn beside(inputs: Inputs, replacing: Replacing) -> Self {
        let place = |(what, path): (String, PathBuf)| FilePlace::read(&path).map(|place| (what, place));
        Self {
            inputs: inputs.0.into_iter().filter_map(place).collect(),
            announced: Vec::new(),
            overwrite: if replacing.overwrite { Overwrite::Always } else { Overwrite::Never },
        }
    }

    /// Announces the output named by `option`.
    /// Errors: The file exists and `--overwrite` is not given, or [`kept`](Self::kept) refuses it.
    pub fn file(&mut self, option: &str, path: &Path) -> Result<OutputSink, Failure> {
        self.announce(option, path, self.overwrite)?.checked()
    }

    /// Announces an output that continues an existing file, once its owner has checked it.
    /// Errors: It is a file that is read, or another output, or it cannot be written.
    pub fn kept(&mut self, option: &str, path: &Path) -> Result<OutputSink, Failure> {
        self.announce(option, path, Overwrite::Always)?.checked()
    }

    /// Announces an output whose writing may fail.
    /// Errors: It is a file that is read, or another output.
    pub fn tried(&mut self, option: &str, path: &Path) -> Result<(), Failure> {
        self.announce(option, path, Overwrite::Never).map(drop)
    }

    fn announce(&mut self, option: &str, path: &Path, overwrite: Overwrite) -> Result<OutputSink, Failure> {
        let sink = OutputSink { option: option.to_owned(), path: path.to_owned(), overwrite };
        let refused = |what: &str| Failure::Usage(format!("{} {what}", sink.name()));
        if let Some(place) = FilePlace::written(path) {
            if let Some((what, _)) = self.inputs.iter().find(|(_, input)| *input == place) {
                return Err(refused(&format!("is also read, as {what}; write to another file")));
            }
            // What is discarded may be discarded twice.
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
    /// The same sink, after the check.
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

    /// The option and its file, as messages begin.
    fn name(&self) -> String {
        format!("{} {}:", self.option, shown(&self.path))
    }

    fn failure(&self, error: WriteError) -> Failure {
        match error {
            WriteError::Exists { .. } => {
                Failure::Usage(format!("{} already exists; --overwrite replaces it", self.name()))
            }
            error => error.into(),
        }
    }
}

/// Writes `text`, which no option can redirect, to standard output.
pub fn print(text: impl AsRef<[u8]>) -> Result<(), Failure> {
    let path = PathBuf::from(stream::STANDARD);
    OutputSink { option: OUTPUT.to_owned(), path, overwrite: Overwrite::Never }.write(text)
}

/// A path made safe to show.
pub fn shown(path: &Path) -> String {
    sanitize(&path.to_string_lossy(), 200)
}
