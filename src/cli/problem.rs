//! The problem that a command line names: a preset, and other values for some of its keys.

use super::{Failure, assigned};
use crate::store::file::LARGEST;
use crate::store::stream::{self, STANDARD};
use crate::store::{Loaded, Source, Store, StoreError};
use clap::Args;
use std::ffi::{OsStr, OsString};
use std::path::Path;

/// The names of the subcommands, which no preset can have.
pub(super) const SUBCOMMANDS: [&str; 15] = [
    "trace",
    "unload",
    "cycle",
    "map",
    "fit",
    "plot",
    "figures",
    "sweep",
    "verify",
    "run",
    "presets",
    "sessions",
    "completions",
    "man",
    "help",
];

/// Which problem, as the explorer and every computing command take it.
#[derive(Debug, Args)]
pub struct Problem {
    /// A preset's name, or a preset file (with a '/' or ending in .toml; - is standard input); the wavy sphere when left out
    #[arg(value_name = "PRESET|FILE.toml")]
    pub preset: Option<OsString>,
    /// Give a key of the preset another value, such as gap.amplitude=0.003 (repeatable; the last of one key holds)
    ///
    /// In an SI preset a bare number is SI, and a value may have its unit: "gap.amplitude=2 um". A dimensionless group
    /// changes what it follows from: `groups.amplitude_over_wavelength`, `groups.wavelength_over_radius`, `groups.adhesion`.
    /// An SI preset is shown in the units of its display keys: display.force=mN.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub assignments: Vec<String>,
}

impl Problem {
    pub fn load(&self) -> Result<Loaded, Failure> {
        load(self.preset.as_ref(), &self.assignments)
    }
}

/// The store of presets; a preset cannot have the name of a subcommand.
pub(super) fn store() -> Store {
    Store::open(&SUBCOMMANDS)
}

/// What the argument `preset` names: the text itself where it comes through a pipe, which can be read but once.
pub(super) fn source(store: &Store, preset: &OsStr) -> Result<Source, Failure> {
    let path = Path::new(preset);
    if preset != STANDARD {
        match store.resolve(preset)? {
            Source::File(path) if stream::is_stream(&path) => {}
            source => return Ok(source),
        }
    }
    let (name, text) = stream::read_text(path, LARGEST).map_err(StoreError::from)?;
    Ok(Source::Piped { name, text: text.into() })
}

fn load(preset: Option<&OsString>, assignments: &[String]) -> Result<Loaded, Failure> {
    let store = store();
    let source = match preset {
        Some(argument) => source(&store, argument)?,
        None => store.resolve(crate::store::shipped::DEFAULT)?,
    };
    let loaded = store.load(&source, assignments)?;
    assigned::report(&store, &source, assignments, &loaded.preset);
    Ok(loaded)
}
