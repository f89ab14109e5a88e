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
use crate::mend::Mend;
use crate::store::read_in;
use etcetera::BaseStrategy;
use pulloff_engine::preset::edit::onto;
use pulloff_engine::preset::invalid::Invalid;
use pulloff_engine::preset::model::Preset;
use pulloff_engine::preset::read::ReadError;
use pulloff_engine::preset::write::write;
use pulloff_engine::text::{closest, quote, sanitize, show_path};
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
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Source {
    Shipped(&'static Shipped),
    User {
        name: String,
        path: PathBuf,
    },
    File(PathBuf),
    /// A text that came through a pipe and cannot be read again.
    Piped {
        /// What messages call its source.
        name: String,
        text: Arc<str>,
    },
}

impl Source {
    /// What messages call it: a name, or a path safe to show.
    #[must_use]
    pub fn shown(&self) -> String {
        match self {
            Self::Shipped(shipped) => shipped.name.to_owned(),
            Self::User { name, .. } | Self::Piped { name, .. } => name.clone(),
            Self::File(path) => show_path(path),
        }
    }

    /// Its file; `None` for a shipped preset and for one that came through a pipe.
    #[must_use]
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
    /// The comment at the start of its text, safe to show.
    #[must_use]
    pub fn comment(&self) -> String {
        let text = match &self.source {
            Source::Shipped(shipped) => shipped.text,
            Source::Piped { text, .. } => text,
            Source::User { .. } | Source::File(_) => &self.text,
        };
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

impl Mend for StoreError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::File(error) => error.can_be_mended(),
            Self::Write(error) => error.can_be_mended(),
            Self::Data(error) => error.can_be_mended(),
            Self::Folder { cause, .. } | Self::Delete { cause, .. } => cause.can_be_mended(),
            Self::NotFound { .. }
            | Self::Name(_)
            | Self::Read(_)
            | Self::Invalid(_)
            | Self::NoFolder
            | Self::Shipped(_) => true,
        }
    }
}

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
    #[must_use]
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
                    closest(&name, known.iter().map(String::as_str)).map(str::to_owned)
                };
                Err(StoreError::NotFound { name: quote(&name), meant })
            }
        }
    }

    /// The names of all presets, the shipped ones first, without checking that their files are valid.
    #[must_use]
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
    #[must_use]
    pub fn list(&self) -> Listing {
        let entry = |name: String, source: Source| {
            let (title, comment) = match self.load(&source, &[] as &[&str]) {
                Ok(loaded) => {
                    let comment = loaded.comment().lines().next().unwrap_or_default().to_owned();
                    (Ok(loaded.preset.title), comment)
                }
                Err(error) => (Err(error.to_string()), String::new()),
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
mod tests {
    use super::*;
    use pulloff_engine::preset::model::BasisSpec;
    use pulloff_engine::ritz::Grading;
    use rustix::fs::{CWD, FileType, Mode, mknodat};
    use std::os::unix::fs::{PermissionsExt, symlink};

    fn wavy() -> Preset {
        crate::store::read("wavy", shipped::find("fig-9").unwrap().text).unwrap()
    }

    const COMMANDS: &[&str] = &["trace", "unload", "presets"];
    const NONE: &[&str] = &[];

    fn store() -> (tempfile::TempDir, Store) {
        let home = tempfile::tempdir().unwrap();
        let store = Store::at(home.path().join("config/pulloff/presets"), COMMANDS);
        (home, store)
    }

    fn with_rings(rings: usize) -> Preset {
        Preset { basis: BasisSpec::Rings { rings, grading: Grading::Uniform }, ..wavy() }
    }

    #[test]
    fn a_saved_preset_is_found_loaded_and_listed() {
        let (_home, store) = store();
        assert!(store.list().presets.len() == SHIPPED.len() && store.list().notice.is_none());
        assert!(!store.folder().unwrap().exists(), "listing makes no folder");
        let (source, print) = store.save("mine", &wavy(), None, Overwrite::Never).unwrap();
        assert_eq!(store.resolve("mine").unwrap(), source);
        let loaded = store.load(&source, NONE).unwrap();
        assert_eq!((&loaded.preset, loaded.fingerprint), (&wavy(), Some(print)));
        let rings = store.load(&source, &["basis.rings=50"]).unwrap().preset;
        assert_eq!(rings, with_rings(50));
        let listing = store.list();
        let last = listing.presets.last().unwrap();
        assert_eq!((last.name.as_str(), last.title.as_deref()), ("mine", Ok(&*wavy().title)));
        assert_eq!(store.folder().unwrap().metadata().unwrap().permissions().mode() & 0o777, 0o700);
    }

    #[test]
    fn the_folder_is_below_xdg_config_home() {
        // All tests share the environment of this process, so another process does the check.
        let marker = "/nowhere/config";
        if std::env::var_os("XDG_CONFIG_HOME").is_some_and(|value| value == marker) {
            let folder = Store::open(COMMANDS).folder().map(Path::to_owned);
            assert_eq!(folder, Some(PathBuf::from("/nowhere/config/pulloff/presets")));
            return;
        }
        let child = std::process::Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "store::presets::tests::the_folder_is_below_xdg_config_home"])
            .env("XDG_CONFIG_HOME", marker)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&child.stdout);
        assert!(child.status.success() && said.contains("1 passed"), "{said}");
    }

    #[test]
    fn an_argument_is_a_name_or_a_path() {
        let (_home, store) = store();
        assert!(matches!(store.resolve("fig-9").unwrap(), Source::Shipped(s) if s.name == "fig-9"));
        for path in ["./fig-9", "fig-9.toml", "/dev/stdin", ".toml"] {
            assert_eq!(store.resolve(path).unwrap(), Source::File(PathBuf::from(path)));
        }
        let message = |argument: &str| store.resolve(argument).unwrap_err().to_string();
        assert_eq!(message("fig9"), "no preset is called \"fig9\"; did you mean fig-9?");
        assert_eq!(message("zzz"), "no preset is called \"zzz\"");
        assert!(message("trace").contains("is a command"));
        assert!(message("Fig-9\u{1b}").contains("is not a preset name"));
        assert!(message("").contains("is not a preset name"));
    }

    #[test]
    fn names_that_are_taken_cannot_be_saved() {
        let (_home, store) = store();
        for name in ["fig-9", "trace", "../up", "a/b", "", "UP"] {
            let error = store.save(name, &wavy(), None, Overwrite::Always).unwrap_err();
            assert!(matches!(error, StoreError::Name(_)), "{error}");
        }
        assert!(!store.folder().unwrap().exists());
    }

    #[test]
    fn only_ones_own_presets_are_deleted() {
        let (home, store) = store();
        let message = |name: &str| store.delete(name).unwrap_err().to_string();
        assert_eq!(message("mine"), "no preset is called \"mine\"");
        assert_eq!(message("fig-9"), "fig-9 comes with the program and cannot be deleted");
        store.save("mine", &wavy(), None, Overwrite::Never).unwrap();
        store.save("other", &wavy(), None, Overwrite::Never).unwrap();
        let (outside, linked) = (home.path().join("outside.toml"), store.folder().unwrap().join("link.toml"));
        fs::write(&outside, "x").unwrap();
        symlink(&outside, &linked).unwrap();
        for path in [outside.to_str().unwrap(), "../outside", "./mine.toml", "mine.toml"] {
            assert!(matches!(store.delete(path), Err(StoreError::Name(_))), "{path}");
        }
        assert_eq!(store.delete("mine").unwrap(), store.path_of("mine").unwrap());
        store.delete("link").unwrap();
        assert!(outside.exists() && linked.symlink_metadata().is_err());
        assert_eq!(store.names().0, ["other"]);
        // While another saver holds the folder, nothing is deleted.
        let lock = FolderLock::acquire(store.folder().unwrap(), PATIENCE).unwrap();
        let waiting = std::thread::spawn({
            let store = store.clone();
            move || store.delete("other").map(drop)
        });
        assert!(lock.is_some() && store.names().0 == ["other"]);
        drop(lock);
        waiting.join().unwrap().unwrap();
        assert!(store.names().0.is_empty());
    }

    #[test]
    fn an_invalid_preset_is_not_saved() {
        let (_home, store) = store();
        let error = store.save("mine", &with_rings(2), None, Overwrite::Always).unwrap_err();
        assert!(matches!(error, StoreError::Invalid(_)), "{error}");
    }

    #[test]
    fn a_save_keeps_what_a_person_wrote_around_the_values() {
        let (home, store) = store();
        let mine = "# notes\n[gap] # first\nshape = 'wavy-sphere'\namplitude = 0.0025   # A\nwavelength = 0.05\n\
                    radius_of_curvature = 1\n\n[material]\nwork_of_adhesion = 4e-3\neffective_modulus = 1 # E*\n";
        let path = home.path().join("mine.toml");
        fs::write(&path, mine).unwrap();
        let file = store.resolve(&path).unwrap();
        let loaded = store.load(&file, &["gap.amplitude=0.003"]).unwrap();
        // The comment stays in its column.
        let changed = mine.replace("0.0025 ", "0.003  ");
        let text = |source: &Source| fs::read_to_string(source.path().unwrap()).unwrap();
        // Back to the file, then under a name, and from there again.
        let known = Overwrite::IfUnchanged(loaded.fingerprint.unwrap());
        save_file(&path, &loaded.preset, Some(&file), known).unwrap();
        assert_eq!(text(&file), changed);
        let (named, print) = store.save("mine", &loaded.preset, Some(&file), Overwrite::Never).unwrap();
        assert_eq!(text(&named), changed);
        let mut turned = loaded.preset.clone();
        turned.assign("material.effective_modulus", "2").unwrap();
        store.save("mine", &turned, Some(&named), Overwrite::IfUnchanged(print)).unwrap();
        assert_eq!(text(&named), changed.replace("= 1 # E*", "= 2.0 # E*"));
        // Over another preset, the text is that of the saved one; a text through a pipe is the user's too.
        let piped = Source::Piped { name: "standard input".to_owned(), text: mine.into() };
        store.save("mine", &loaded.preset, Some(&piped), Overwrite::Always).unwrap();
        assert_eq!(text(&named), changed);
        // A shipped preset, one without a source, and one whose file is gone are written afresh.
        let shipped = store.resolve("wavy-sphere").unwrap();
        let gone = Source::File(home.path().join("gone.toml"));
        for from in [Some(&shipped), Some(&gone), None] {
            store.save("mine", &loaded.preset, from, Overwrite::Always).unwrap();
            assert_eq!(text(&named), write(&loaded.preset));
        }
    }

    #[test]
    fn the_name_of_a_profile_follows_the_preset_and_its_comment_stays() {
        let (home, store) = store();
        let rows = (0..100).map(f64::from).map(|r| format!("{r} {}\n", r * r / 2000.0)).collect::<Vec<_>>();
        fs::write(home.path().join("scan.dat"), rows.concat()).unwrap();
        let text = "[material]\neffective_modulus = 1\nwork_of_adhesion = 0.003\n[gap]\nshape = \"profile\"\n\
                    file = \"scan.dat\" # of May\n[path]\nstart_contact_radius = 50\n";
        let path = home.path().join("p.toml");
        fs::write(&path, text).unwrap();
        let file = store.resolve(&path).unwrap();
        let loaded = store.load(&file, NONE).unwrap();
        save_file(&path, &loaded.preset, Some(&file), Overwrite::Always).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
        let (named, _) = store.save("mine", &loaded.preset, Some(&file), Overwrite::Never).unwrap();
        let saved = fs::read_to_string(named.path().unwrap()).unwrap();
        assert!(saved.contains("scan.dat\" # of May") && !saved.contains("\"scan.dat\""), "{saved}");
        let radius = |preset: &Preset| preset.gap.radius_of_curvature().unwrap().to_bits();
        assert_eq!(radius(&store.load(&named, NONE).unwrap().preset), radius(&loaded.preset));
    }

    #[test]
    fn what_changed_on_disk_is_not_overwritten() {
        let (_home, store) = store();
        let (source, first) = store.save("mine", &wavy(), None, Overwrite::Never).unwrap();
        let taken = store.save("mine", &wavy(), None, Overwrite::Never).unwrap_err();
        assert!(matches!(taken, StoreError::Write(WriteError::Exists { .. })), "{taken}");
        let (_, second) = store.save("mine", &with_rings(10), None, Overwrite::IfUnchanged(first)).unwrap();
        // Another editor changes the file.
        let path = source.path().unwrap();
        fs::write(path, write(&with_rings(20))).unwrap();
        let error = store.save("mine", &with_rings(30), None, Overwrite::IfUnchanged(second)).unwrap_err();
        assert!(matches!(error, StoreError::Write(WriteError::Changed { .. })), "{error}");
        assert_eq!(store.load(&source, NONE).unwrap().preset, with_rings(20));
        store.save("mine", &with_rings(30), None, Overwrite::Always).unwrap();
        assert_eq!(store.load(&source, NONE).unwrap().preset, with_rings(30));
    }

    #[test]
    fn unreadable_presets_are_listed_with_the_reason_and_left_alone() {
        let (_home, store) = store();
        store.save("good", &wavy(), None, Overwrite::Never).unwrap();
        let at = |name: &str| store.folder().unwrap().join(name);
        fs::write(at("bad.toml"), "rings = ").unwrap();
        fs::write(at("Odd Name.toml"), write(&wavy())).unwrap();
        fs::write(at("fig-9.toml"), write(&wavy())).unwrap();
        fs::write(at(".hidden.toml"), "").unwrap();
        fs::write(at("notes.txt"), "").unwrap();
        mknodat(CWD, at("pipe.toml"), FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
        symlink("nowhere", at("dangling.toml")).unwrap();
        let listing = store.list();
        let reason = |name: &str| {
            let row = listing.presets[SHIPPED.len()..].iter().find(|row| row.name.ends_with(name));
            row.unwrap_or_else(|| panic!("{name}")).title.clone().unwrap_err()
        };
        assert_eq!(listing.presets.len(), SHIPPED.len() + 6);
        assert!(reason("bad").contains("bad.toml:1:"), "{}", reason("bad"));
        assert!(reason("Odd Name.toml").contains("is not a preset name"));
        assert!(reason("fig-9.toml").contains("comes with the program"));
        assert!(reason("pipe").contains("is a pipe"));
        assert!(reason("dangling").contains("No such file"));
        assert!(store.load(&store.resolve("bad").unwrap(), NONE).is_err());
        assert_eq!(fs::read_to_string(at("bad.toml")).unwrap(), "rings = ");
        let error = store.save("bad", &wavy(), None, Overwrite::Never).unwrap_err();
        assert!(matches!(error, StoreError::Write(WriteError::Exists { .. })), "{error}");
    }

    #[test]
    fn messages_name_the_file_and_the_line() {
        let (home, store) = store();
        let path = home.path().join("w.toml");
        fs::write(&path, write(&wavy()).replace("rings = 200", "rings = 2")).unwrap();
        let error = store.load(&store.resolve(&path).unwrap(), NONE).unwrap_err().to_string();
        assert!(error.contains("w.toml:17: basis.rings = 2 is out of range"), "{error}");
        fs::write(&path, vec![b'#'; 1 << 20 | 1]).unwrap();
        let error = store.load(&Source::File(path), NONE).unwrap_err().to_string();
        assert!(error.contains("has 1048577 bytes, more than the 1048576"), "{error}");
    }

    #[test]
    fn without_a_home_there_are_the_shipped_presets_and_a_notice() {
        let store = Store { folder: None, commands: Vec::new() };
        assert!(store.list().notice.is_some() && store.resolve("fig-8").is_ok());
        assert!(matches!(store.save("mine", &wavy(), None, Overwrite::Never), Err(StoreError::NoFolder)));
        assert!(matches!(store.resolve("mine"), Err(StoreError::NotFound { .. })));
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let home = tempfile::tempdir().unwrap();
        fs::write(home.path().join("file"), "").unwrap();
        let store = Store::at(home.path().join("file/presets"), COMMANDS);
        let error = store.save("mine", &wavy(), None, Overwrite::Never).unwrap_err();
        assert!(matches!(error, StoreError::Folder { .. }), "{error}");
        assert!(store.list().notice.is_some());
    }

    #[test]
    fn savers_at_the_same_time_lose_nothing() {
        let (_home, store) = store();
        let (source, first) = store.save("mine", &wavy(), None, Overwrite::Never).unwrap();
        let savers: Vec<_> = (0..8)
            .map(|i| {
                let store = store.clone();
                std::thread::spawn(move || {
                    store.save("mine", &with_rings(10 + i), None, Overwrite::IfUnchanged(first))
                })
            })
            .collect();
        let results: Vec<_> = savers.into_iter().map(|saver| saver.join().unwrap()).collect();
        let winners: Vec<_> = (0..8).filter(|i| results[*i].is_ok()).collect();
        assert_eq!(winners.len(), 1, "all loaded the same file, so one save only may replace it");
        for result in results.iter().filter_map(|result| result.as_ref().err()) {
            assert!(matches!(result, StoreError::Write(WriteError::Changed { .. })), "{result}");
        }
        assert_eq!(store.load(&source, NONE).unwrap().preset, with_rings(10 + winners[0]));
        assert_eq!(fs::read_dir(store.folder().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_in_use_is_waited_for() {
        let (_home, store) = store();
        store.save("mine", &wavy(), None, Overwrite::Never).unwrap();
        let held = FolderLock::acquire(store.folder().unwrap(), PATIENCE).unwrap();
        let other = store.clone();
        let saver = std::thread::spawn(move || other.save("mine", &with_rings(9), None, Overwrite::Always));
        drop(held);
        assert!(saver.join().unwrap().is_ok());
    }
}
