//! The user's presets: where they are, how a name on the command line finds one, loading and saving.
//!
//! They are in `pulloff/presets` below the XDG configuration folder. Only the first save creates the folder. Nothing
//! here overwrites a file that the caller did not load or ask to replace.

use super::atomic::{Overwrite, WriteError, folder_of, follow, write_verified};
use super::beside::{DataError, copy_beside};
use super::file::{self, FileError, Fingerprint, read_text};
use super::lock::{FolderLock, PATIENCE};
use super::name::{self, NameError};
use super::shipped::{self, SHIPPED, Shipped};
use crate::mend::mend;
use crate::store::read_in;
use etcetera::BaseStrategy;
use pulloff_engine::preset::edit::onto;
use pulloff_engine::preset::invalid::Invalid;
use pulloff_engine::preset::model::Preset;
use pulloff_engine::preset::read::ReadError;
use pulloff_engine::preset::write::{head, write};
use pulloff_engine::text::{closest, quote, sanitize, show_path};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use thiserror::Error;

/// The largest number of files in the folder that are listed.
const LISTED: usize = 1000;

/// Where a preset comes from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Source {
    Shipped(#[serde(serialize_with = "name_of", deserialize_with = "named")] &'static Shipped),
    User {
        name: String,
        #[serde(with = "super::path")]
        path: PathBuf,
    },
    File(#[serde(with = "super::path")] PathBuf),
    /// A text that came through a pipe and cannot be read again.
    Piped {
        /// What messages call its source.
        name: String,
        text: Arc<str>,
    },
}

fn name_of<S: Serializer>(shipped: &Shipped, serializer: S) -> Result<S::Ok, S::Error> {
    shipped.name.serialize(serializer)
}

/// The preset that comes with the program under a name; if none does any longer, the default: only the name is missing.
fn named<'de, D: Deserializer<'de>>(deserializer: D) -> Result<&'static Shipped, D::Error> {
    let name = String::deserialize(deserializer)?;
    let known = shipped::find(&name).or_else(|| shipped::find(shipped::DEFAULT));
    known.ok_or_else(|| D::Error::custom(format!("no preset {name}")))
}

impl Source {
    /// What messages call it: a name, or a path safe to show.
    pub fn shown(&self) -> String {
        match self {
            Self::Shipped(shipped) => shipped.name.to_owned(),
            Self::User { name, .. } | Self::Piped { name, .. } => name.clone(),
            Self::File(path) => show_path(path),
        }
    }

    /// Its file; `None` for a shipped preset and for one that came through a pipe.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Shipped(_) | Self::Piped { .. } => None,
            Self::User { path, .. } | Self::File(path) => Some(path),
        }
    }
}

/// A preset as loaded.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    pub source: Source,
    /// The preset, with the assignments applied.
    pub preset: Preset,
    pub text: String,
    /// The fingerprint for recognising the file when saving, where there is a file.
    pub fingerprint: Option<Fingerprint>,
}

/// One line of the list of presets.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Listed {
    /// What to type to open it: its name, or its path (safe to show) if the file has no valid name.
    pub name: String,
    pub source: Source,
    /// Its title, or why it cannot be opened, in one line.
    pub title: Result<String, String>,
    /// The first line of its comment; may be empty.
    pub comment: String,
}

impl Loaded {
    /// The comment at the start of its text, safe to show, without the line that every preset is written with.
    pub fn comment(&self) -> String {
        let text = match &self.source {
            Source::Shipped(shipped) => shipped.text,
            Source::Piped { text, .. } => text,
            Source::User { .. } | Source::File(_) => &self.text,
        };
        let text = text.strip_prefix(head(&self.preset.units)).unwrap_or(text);
        let lines = text.lines().map_while(|line| line.strip_prefix('#')).map(str::trim);
        lines.map(|line| sanitize(line, 200)).collect::<Vec<_>>().join("\n")
    }
}

/// The list of presets.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Listing {
    /// The shipped ones in their own order, then the user's by name.
    pub presets: Vec<Listed>,
    /// Why some of the user's presets may be missing, in one line.
    pub notice: Option<String>,
}

/// Why a preset was not found, loaded or saved, in one line. Names and paths in the error are safe to show.
#[derive(Debug, Error)]
pub enum StoreError {
    #[error("no preset is called \"{name}\"{}", .meant.as_deref().map_or_else(String::new, |meant| format!("; did you mean {meant}?")))]
    NotFound { name: String, meant: Option<String> },
    #[error(transparent)]
    Name(#[from] NameError),
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Read(#[from] ReadError),
    #[error("the preset is not valid: {0}")]
    Invalid(Invalid),
    /// Neither a configuration folder nor a home folder is known.
    #[error("no folder for presets: neither XDG_CONFIG_HOME nor HOME is set")]
    NoFolder,
    #[error("{path}: cannot make the folder: {cause}")]
    Folder { path: String, cause: io::Error },
    #[error(transparent)]
    Data(#[from] DataError),
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error("{0} comes with the program and cannot be deleted")]
    Shipped(&'static str),
    #[error("{path}: cannot delete it: {cause}")]
    Delete { path: String, cause: io::Error },
}

mend!(
    StoreError, as 0 of File | Write | Data, as cause of Folder | Delete,
    always NotFound | Name | Read | Invalid | NoFolder | Shipped
);

/// The folder of the user's presets.
#[derive(Debug, Clone)]
pub struct Store {
    folder: Option<PathBuf>,
    commands: Vec<String>,
}

impl Store {
    /// The store below the XDG configuration folder; `commands` are names that no preset may have.
    #[must_use]
    pub fn open(commands: &[&str]) -> Self {
        let folder =
            etcetera::base_strategy::Xdg::new().ok().map(|xdg| xdg.config_dir().join("pulloff/presets"));
        Self { folder, commands: commands.iter().map(ToString::to_string).collect() }
    }

    /// The store in another folder.
    #[must_use]
    pub fn at(folder: impl Into<PathBuf>, commands: &[&str]) -> Self {
        Self { folder: Some(folder.into()), commands: commands.iter().map(ToString::to_string).collect() }
    }

    /// The folder, which need not exist; `None` if the user has no home.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The path of the preset `name`.
    pub fn path_of(&self, name: &str) -> Result<PathBuf, StoreError> {
        name::check(name, &self.commands)?;
        Ok(self.folder.as_ref().ok_or(StoreError::NoFolder)?.join(format!("{name}.toml")))
    }

    /// What an argument names: a path if it has a `/` or ends in `.toml`, else a preset by name.
    pub fn resolve(&self, argument: impl AsRef<OsStr>) -> Result<Source, StoreError> {
        let argument = argument.as_ref();
        let bytes = argument.as_encoded_bytes();
        if bytes.contains(&b'/') || bytes.ends_with(b".toml") {
            return Ok(Source::File(PathBuf::from(argument)));
        }
        let name = argument.to_string_lossy();
        if let Some(shipped) = shipped::find(&name) {
            return Ok(Source::Shipped(shipped));
        }
        name::check(&name, &self.commands)?;
        match self.path_of(&name) {
            // A pipe or a dangling link of that name exists, and loading it reports what is wrong.
            Ok(path) if path.symlink_metadata().is_ok() => Ok(Source::User { name: name.into_owned(), path }),
            _ => {
                let known = self.known();
                // A file of that name in the current folder is a closer match than any other name.
                let file = format!("./{name}.toml");
                let meant = if Path::new(&file).is_file() {
                    Some(file)
                } else {
                    let all = known.iter().chain(&self.commands).map(String::as_str);
                    closest(&name, all).map(|meant| {
                        let is_command = self.commands.iter().any(|command| command == meant);
                        if is_command { format!("the command {meant}") } else { meant.to_owned() }
                    })
                };
                Err(StoreError::NotFound { name: quote(&name), meant })
            }
        }
    }

    /// The names of all presets, the shipped ones first, without checking that their files are valid.
    pub fn known(&self) -> Vec<String> {
        let (own, _) = self.names();
        SHIPPED.iter().map(|shipped| shipped.name.to_owned()).chain(own).collect()
    }

    /// Loads a preset and applies `KEY=VALUE` assignments to it.
    pub fn load<S: AsRef<str>>(&self, source: &Source, assignments: &[S]) -> Result<Loaded, StoreError> {
        let (text, fingerprint) = match source {
            Source::Shipped(shipped) => (shipped.text.to_owned(), None),
            Source::Piped { text, .. } => (text.to_string(), None),
            Source::User { path, .. } | Source::File(path) => {
                let (text, fingerprint) = read_text(path, file::LARGEST)?;
                (text, Some(fingerprint))
            }
        };
        let name = source.path().map_or_else(|| source.shown(), |path| path.to_string_lossy().into_owned());
        let preset = read_in(source.path().map(folder_of), &name, &text, assignments)?;
        Ok(Loaded { source: source.clone(), preset, text, fingerprint })
    }

    /// All presets. Those that cannot be read are listed with the reason.
    pub fn list(&self) -> Listing {
        let entry = |name: String, source: Source| {
            let (title, comment) = match self.load(&source, &[] as &[&str]) {
                Ok(loaded) => {
                    let comment = loaded.comment().lines().next().unwrap_or_default().to_owned();
                    (Ok(loaded.preset.title), comment)
                }
                // A list has one line for each preset.
                Err(error) => (Err(error.to_string().replace('\n', "; ")), String::new()),
            };
            Listed { name, source, title, comment }
        };
        let mut presets: Vec<_> =
            SHIPPED.iter().map(|shipped| entry(shipped.name.to_owned(), Source::Shipped(shipped))).collect();
        let (names, notice) = self.names();
        for name in names {
            let Some(path) = self.folder.as_ref().map(|folder| folder.join(format!("{name}.toml"))) else {
                break;
            };
            presets.push(match name::check(&name, &self.commands) {
                Ok(()) => entry(name.clone(), Source::User { name, path }),
                Err(error) => {
                    let shown = show_path(&path);
                    let (source, title) = (Source::File(path), Err(error.to_string()));
                    Listed { name: shown, source, title, comment: String::new() }
                }
            });
        }
        Listing { presets, notice }
    }

    /// The names in the folder, sorted, and why some of them could not be seen.
    fn names(&self) -> (Vec<String>, Option<String>) {
        let Some(folder) = &self.folder else { return (Vec::new(), Some(StoreError::NoFolder.to_string())) };
        let entries = match fs::read_dir(folder) {
            Ok(entries) => entries,
            // No preset has been saved yet: nothing to report.
            Err(error) if error.kind() == io::ErrorKind::NotFound => return (Vec::new(), None),
            Err(error) => {
                return (
                    Vec::new(),
                    Some(format!("{}: cannot list the presets: {error}", show_path(folder))),
                );
            }
        };
        let mut names: Vec<String> = entries
            .filter_map(Result::ok)
            .filter_map(|entry| entry.file_name().into_string().ok())
            .filter(|name| !name.starts_with('.'))
            .filter_map(|name| name.strip_suffix(".toml").map(str::to_owned))
            .take(LISTED + 1)
            .collect();
        let notice = (names.len() > LISTED)
            .then(|| format!("{}: only {LISTED} presets are listed", show_path(folder)));
        names.truncate(LISTED);
        names.sort();
        (names, notice)
    }

    /// Deletes the user's own preset of this name permanently, and returns the path of its file. Data copied beside it
    /// stay.
    /// Errors: The user has no preset of this name, another saver holds the folder, or the system refuses; nothing has
    /// changed then.
    pub fn delete(&self, name: &str) -> Result<PathBuf, StoreError> {
        let path = self.own(name)?;
        let _lock = locked(folder_of(&path), &path)?;
        // A link itself is deleted, not what it leads to.
        match fs::remove_file(&path) {
            Ok(()) => Ok(path),
            Err(cause) => Err(StoreError::Delete { path: show_path(&path), cause }),
        }
    }

    /// The path of the user's own preset of this name, which can be deleted.
    pub fn own(&self, name: &str) -> Result<PathBuf, StoreError> {
        match shipped::find(name) {
            Some(shipped) => Err(StoreError::Shipped(shipped.name)),
            // First, because a path is not a name.
            None => self.path_of(name).and_then(|path| self.resolve(name).map(|_| path)),
        }
    }

    /// Saves a preset by name, and returns its path and the fingerprint of the file. What the user has written around
    /// the values in the text that it was read `from` is kept.
    /// Errors: The name or the preset is not valid, or the file must not be replaced or cannot be written; nothing has
    /// changed then.
    pub fn save(
        &self,
        name: &str,
        preset: &Preset,
        from: Option<&Source>,
        overwrite: Overwrite,
    ) -> Result<(Source, Fingerprint), StoreError> {
        let path = self.path_of(name)?;
        make_own_folder(folder_of(&path))?;
        let fingerprint = save_file(&path, preset, from, overwrite)?;
        Ok((Source::User { name: name.to_owned(), path }, fingerprint))
    }

    /// The same with the data of a profile copied beside it; returns the preset as saved with them.
    /// Errors: As [`save`](Self::save), or the data cannot be copied; no preset has changed then.
    pub fn save_with_data(
        &self,
        name: &str,
        preset: &Preset,
        from: Option<&Source>,
        overwrite: Overwrite,
    ) -> Result<(Source, Fingerprint, Preset), StoreError> {
        let path = self.path_of(name)?;
        // Asked before anything is copied; the save itself checks again.
        if matches!(overwrite, Overwrite::Never) && path.exists() {
            return Err(WriteError::Exists { path: show_path(&path) }.into());
        }
        make_own_folder(folder_of(&path))?;
        let preset = copy_beside(folder_of(&path), preset)?;
        let (source, fingerprint) = self.save(name, &preset, from, overwrite)?;
        Ok((source, fingerprint, preset))
    }
}

fn make_own_folder(folder: &Path) -> Result<(), StoreError> {
    make_folder(folder).map_err(|cause| StoreError::Folder { path: show_path(folder), cause })
}

/// Creates a folder of the user's own, and those above it.
pub fn make_folder(folder: &Path) -> io::Result<()> {
    fs::DirBuilder::new().recursive(true).mode(0o700).create(folder)
}

/// The text of a preset as the user wrote it; the comments of a shipped preset describe only that preset.
fn own_text(source: &Source) -> Option<String> {
    match source {
        Source::Shipped(_) => None,
        Source::Piped { text, .. } => Some(text.to_string()),
        Source::User { path, .. } | Source::File(path) => {
            read_text(path, file::LARGEST).ok().map(|(text, _)| text)
        }
    }
}

/// The lock of a folder, taken for a file in it.
fn locked(folder: &Path, path: &Path) -> Result<FolderLock, WriteError> {
    let lock = FolderLock::acquire(folder, PATIENCE);
    let failed = |cause| WriteError::Io { path: show_path(path), doing: "lock its folder", cause };
    lock.map_err(failed)?.ok_or_else(|| WriteError::Locked { path: show_path(path) })
}

/// Saves a preset to a file by its path, and reads it back before it takes the file's place. It keeps what the user has
/// written around the values in the text that it was read `from`, or is written afresh.
/// Errors: The preset is not valid, or the file must not be replaced or cannot be written; nothing has changed then.
pub fn save_file(
    path: &Path,
    preset: &Preset,
    from: Option<&Source>,
    overwrite: Overwrite,
) -> Result<Fingerprint, StoreError> {
    preset.check().map_err(|mut all| StoreError::Invalid(all.swap_remove(0)))?;
    let preset = preset.placed_in(folder_of(path));
    // The folder in which the rename happens, so that two names for one file share a lock.
    let target = follow(path)?;
    let shown = || show_path(path);
    let _lock = locked(folder_of(&target), path)?;
    let text = from.and_then(|from| {
        let folder = from.path().map(folder_of);
        onto(folder, &own_text(from)?, &preset)
    });
    let text = text.unwrap_or_else(|| write(&preset));
    let fingerprint = write_verified(path, text.as_bytes(), overwrite, |bytes| {
        let text = std::str::from_utf8(bytes).map_err(|error| error.to_string())?;
        match read_in(Some(folder_of(path)), &shown(), text, &[] as &[&str]) {
            Ok(back) if back == preset => Ok(()),
            Ok(_) => Err("another preset came back".to_owned()),
            Err(error) => Err(error.to_string()),
        }
    })?;
    Ok(fingerprint)
}

#[cfg(test)]
mod tests;
