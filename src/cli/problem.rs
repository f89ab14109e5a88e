//! The problem that a command line names: a preset, with new values for some of its keys.

use super::console::Console;
use super::output::Inputs;
use super::{Failure, assigned};
use crate::store::file::LARGEST;
use crate::store::stream::{self, STANDARD};
use crate::store::{Loaded, Source, Store, StoreError};
use clap::Args;
use pulloff_engine::preset::called::key_called;
use pulloff_engine::preset::{Preset, data, edge};
use pulloff_engine::stability::axis::set_by;
use pulloff_engine::sweep::axis::overrides;
use pulloff_engine::text::quote;
use std::ffi::{OsStr, OsString};
use std::path::Path;

/// The names of the subcommands, which no preset may have.
pub(super) const SUBCOMMANDS: [&str; 17] = [
    "trace",
    "unload",
    "cycle",
    "pull",
    "map",
    "fit",
    "speeds",
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

/// Which problem to solve, as the explorer and every computing command take it.
#[derive(Debug, Args)]
pub struct ProblemArguments {
    /// A preset's name, or a preset file (with a '/' or ending in .toml; - is standard input); the wavy sphere when left out
    #[arg(value_name = "PRESET|FILE.toml")]
    pub preset: Option<OsString>,
    #[command(flatten)]
    pub changes: Changes,
}

/// Other values for keys of a preset.
#[derive(Debug, Clone, Default, Args)]
pub struct Changes {
    /// Give a key of the preset another value, such as gap.amplitude=0.003 (repeatable; for one key the last holds)
    ///
    /// A key may be given by its last part or its symbol, as in gamma=0.05, where only one key has that name. In an SI preset a bare number is SI, and a value may have a unit: "gap.amplitude=2 um". A dimensionless group
    /// changes the values that it is made from: `groups.amplitude_over_wavelength`, `groups.wavelength_over_radius`,
    /// `groups.adhesion`. An SI preset is shown in the units of its display keys: display.force=mN.
    #[arg(long = "set", value_name = "KEY=VALUE", allow_hyphen_values = true)]
    pub assignments: Vec<String>,
    /// What the loading device prescribes: displacement, force or stiffness=K, in an SI preset also as stiffness=5N/m
    /// (instead of the preset's)
    #[arg(long, value_name = "CONTROL")]
    pub control: Option<String>,
}

/// The key that `--control` sets.
const CONTROL: &str = "path.control";

impl Changes {
    /// Whether there are no changes.
    pub fn is_empty(&self) -> bool {
        self.assignments.is_empty() && self.control.is_none()
    }

    /// Refuses a change of what an axis over one of `axes` gives each point anew.
    ///
    /// # Errors
    /// The change, which would have no effect.
    pub fn beside<'a>(
        &self,
        preset: &Preset,
        axes: impl IntoIterator<Item = &'a str>,
    ) -> Result<(), Failure> {
        let axes: Vec<&str> = axes.into_iter().collect();
        for change in self.all() {
            let typed = change.split('=').next().unwrap_or_default().trim();
            let Ok(key) = key_called(preset, typed) else { continue };
            if let Some(axis) = axes.iter().copied().find(|axis| overrides(set_by(axis), &key)) {
                let is_set = self.assignments.contains(&change);
                let option = if is_set { format!("--set {}", quote(&key)) } else { "--control".to_owned() };
                let what = format!("{option}: the axis {axis} gives each point its own");
                return Err(Failure::Usage(what));
            }
        }
        Ok(())
    }

    /// All changes as assignments.
    pub fn all(&self) -> Vec<String> {
        let control = self.control.as_ref().map(|control| format!("{CONTROL}={control}"));
        self.assignments.iter().cloned().chain(control).collect()
    }
}

impl ProblemArguments {
    /// Loads the preset with the changes, and reports what they did beyond their text.
    pub fn load(&self, console: &Console) -> Result<Loaded, Failure> {
        let store = store();
        let source = match &self.preset {
            Some(argument) => source(&store, argument)?,
            None => store.resolve(crate::store::shipped::DEFAULT)?,
        };
        let Changes { assignments, control } = &self.changes;
        // A rate is read under the control that is given with it.
        let loaded = match (store.load(&source, &self.changes.all()), control) {
            (Ok(loaded), _) => loaded,
            (Err(error), None) => return Err(error.into()),
            (Err(error), Some(control)) => {
                let mut loaded = store.load(&source, assignments)?;
                let assigned = loaded.preset.assign(CONTROL, control);
                assigned.map_err(|invalid| Failure::Usage(format!("--control: {invalid}")))?;
                // A rate of the preset is dropped under another control. One given on the command line is wrong.
                let is_given = |text: &String| {
                    let key = text.split('=').next().unwrap_or_default();
                    key_called(&loaded.preset, key.trim())
                        .is_ok_and(|key| [edge::RATE, edge::STEPS].contains(&&*key))
                };
                if assignments.iter().any(is_given) {
                    return Err(error.into());
                }
                loaded
            }
        };
        assigned::report(console, &store, &source, assignments, &loaded.preset);
        Ok(loaded)
    }

    /// Loads the preset with the changes where its own measured curve is not used, if `is_unused`: its file is left out
    /// where its settings contradict the changes.
    pub fn load_for(&self, is_unused: bool, console: &Console) -> Result<Loaded, Failure> {
        self.load(console).or_else(|failure| {
            let mut alone = Self { preset: self.preset.clone(), changes: self.changes.clone() };
            alone.changes.assignments.insert(0, format!("{}=none", data::FILE));
            // A pipe can be read only once, and then the second failure would be another. Otherwise the second one does not blame
            // the file for what is wrong without it.
            let is_pipe = self.preset.as_deref().is_some_and(|name| stream::is_stream(Path::new(name)));
            if !is_unused {
                return Err(failure);
            }
            alone.load(console).map_err(|second| if is_pipe { failure } else { second })
        })
    }

    /// The files that the problem is read from.
    pub fn inputs(&self, loaded: &Loaded) -> Inputs {
        Inputs::default().with_problem(self.preset.as_deref().map(Path::new), loaded)
    }
}

/// The store of presets; no preset may have the name of a subcommand.
pub(super) fn store() -> Store {
    Store::open(&SUBCOMMANDS)
}

/// What the argument `preset` names: the text itself where it comes through a pipe, which can be read only once.
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
