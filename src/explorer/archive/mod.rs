//! The sessions kept on disk: one file each, in `pulloff/sessions` below the XDG state folder.
//!
//! A session belongs to one program at a time. Its lock is held as long as the program lives, and the kernel releases
//! it with the process; a second program starts a session of its own. Only the first session worth keeping creates
//! the folder, and only the program that holds a file's lock ever replaces that file.
//!
//! | file | what lives there |
//! |---|---|
//! | `mod.rs` | the folder: list, load, delete, and room for new ones |
//! | `data` | the rows of measured profiles, beside the sessions that use them |
//! | `error` | why a session cannot be found, read or written |
//! | [`claim`] | the right to write one session |
//! | [`autosave`] | writes the newest state of a session every few seconds and at its end |

pub mod autosave;
pub mod claim;
mod data;
mod error;

pub use autosave::Autosave;
pub use claim::Claim;
pub use error::ArchiveError;

use self::data::{Data, named_in};
use self::error::{LARGEST, failed};
use super::session::{Document, Ended, SessionSummary, Snapshot, Unreadable, summary};
use crate::store::file::read_bytes;
use crate::store::lock::FileLock;
use crate::store::name::is_well_formed;
use etcetera::BaseStrategy;
use pulloff_engine::text::{closest, quote, show_path};
use std::cmp::Reverse;
use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// The most sessions kept,
const MOST: usize = 50;
/// and the most bytes they take together; older sessions make room for newer ones.
const MOST_BYTES: u64 = 256 << 20;
/// The age at which the remains of a killed write are removed.
const STALE: Duration = Duration::from_secs(3600);
/// The extension of a session's file.
const ENDING: &str = "json";
/// The extension of a session that could not be read and was kept aside.
const ASIDE: &str = "damaged";

/// One line of the list of sessions.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionFile {
    pub name: String,
    pub written: SystemTime,
    pub bytes: u64,
}

/// A session that was read, and is held until it is written or dropped.
#[derive(Debug)]
pub struct HeldSession {
    pub claim: Claim,
    pub summary: SessionSummary,
    pub snapshot: Snapshot,
}

/// The folder of sessions.
#[derive(Debug, Clone)]
pub struct Archive {
    folder: Option<PathBuf>,
}

impl Archive {
    /// The archive below the XDG state folder.
    #[must_use]
    pub fn open() -> Self {
        let state = etcetera::base_strategy::Xdg::new().ok().and_then(|xdg| xdg.state_dir());
        Self { folder: state.map(|state| state.join("pulloff/sessions")) }
    }

    /// The archive in another folder.
    #[must_use]
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Self { folder: Some(folder.into()) }
    }

    /// The folder, which need not exist; `None` if the person has no home.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    fn folder_or(&self) -> Result<&Path, ArchiveError> {
        self.folder.as_deref().ok_or(ArchiveError::NoFolder)
    }

    /// The sessions, the newest first.
    pub fn list(&self) -> Result<Vec<SessionFile>, ArchiveError> {
        let Some(folder) = &self.folder else { return Ok(Vec::new()) };
        let files = match fs::read_dir(folder) {
            Ok(files) => files,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            Err(error) => return Err(failed(folder, "list the sessions")(error)),
        };
        let mut entries: Vec<SessionFile> = files
            .filter_map(Result::ok)
            .filter_map(|file| {
                let path = PathBuf::from(file.file_name());
                let name = path.file_stem()?.to_str().filter(|name| is_well_formed(name))?.to_owned();
                let metadata = file.metadata().ok().filter(fs::Metadata::is_file)?;
                (path.extension()? == ENDING).then_some(())?;
                Some(SessionFile { name, written: metadata.modified().ok()?, bytes: metadata.len() })
            })
            .collect();
        // Of two sessions of the same moment, the one with the higher number is newer.
        entries.sort_by_key(|entry| Reverse((entry.written, number(&entry.name))));
        Ok(entries)
    }

    fn path(&self, name: &str) -> Result<PathBuf, ArchiveError> {
        let path = self.folder_or()?.join(format!("{name}.{ENDING}"));
        if is_well_formed(name) && path.symlink_metadata().is_ok() {
            return Ok(path);
        }
        let known = self.list()?;
        let meant = closest(name, known.iter().map(|entry| &*entry.name));
        // A session is named after the preset with which it began, not after the one it was saved as.
        let newest = || known.first().map(|newest| format!("; the newest is {}", newest.name));
        let hint = meant.map(|meant| format!("; did you mean {meant}?")).or_else(newest).unwrap_or_default();
        Err(ArchiveError::NotFound { name: quote(name), hint })
    }

    /// The bytes of a session, as they are.
    pub fn bytes(&self, name: &str) -> Result<Vec<u8>, ArchiveError> {
        Ok(read_bytes(&self.path(name)?, LARGEST)?.0)
    }

    /// What a list shows of a session.
    pub fn summary(&self, name: &str) -> Result<SessionSummary, ArchiveError> {
        let path = self.path(name)?;
        let unreadable = |cause| ArchiveError::Unreadable { path: show_path(&path), cause };
        let mut found = summary(&self.bytes(name)?).map_err(unreadable)?;
        found.ended = match (found.ended, self.is_running(name)) {
            (_, true) => Ended::Running,
            // Its program was killed and could not record how it ended.
            (Ended::Running, false) => Ended::Dropped,
            (ended, false) => ended,
        };
        Ok(found)
    }

    /// Whether a program is writing this session.
    pub fn is_running(&self, name: &str) -> bool {
        self.folder.as_deref().is_some_and(|folder| FileLock::is_held(&lock_of(folder, name)))
    }

    /// The name of the newest session that no program is writing.
    pub fn newest(&self) -> Result<Option<String>, ArchiveError> {
        Ok(self.list()?.into_iter().map(|entry| entry.name).find(|name| !self.is_running(name)))
    }

    /// The name of the session to resume: the newest one that no program is writing.
    /// Errors: There is none, or all are running.
    pub fn to_resume(&self) -> Result<String, ArchiveError> {
        let of_running = || {
            let newest = self.list()?.into_iter().next();
            Err(newest.map_or(ArchiveError::Empty, |entry| ArchiveError::Running { name: entry.name }))
        };
        self.newest()?.map_or_else(of_running, Ok)
    }

    /// Reads a session and holds it: nobody else can hold it meanwhile.
    /// Errors: It is not there, another program holds it, or it cannot be read; its file is unchanged.
    pub fn load(&self, name: &str) -> Result<HeldSession, ArchiveError> {
        let path = self.path(name)?;
        let claim = Claim::of(self.folder_or()?, name)?;
        let (bytes, _) = read_bytes(&path, LARGEST)?;
        let unreadable = |cause| ArchiveError::Unreadable { path: show_path(&path), cause };
        let mut document = Document::read(&bytes).map_err(unreadable)?;
        let data = Data::beside(self.folder_or()?);
        document.take_back(|file, hash| data.take_back(&path, file, hash))?;
        let summary = document.summary.clone();
        let snapshot = document.snapshot().map_err(unreadable)?;
        Ok(HeldSession { claim, summary, snapshot })
    }

    /// The newest session, if it was cut off: its program did not end as its person wanted. A damaged session is
    /// kept aside under another name.
    pub fn cut_off(&self) -> Result<Option<HeldSession>, String> {
        // A folder that cannot be read is reported once there is something to write.
        let Ok(Some(name)) = self.newest() else { return Ok(None) };
        let damaged = |cause: &Unreadable| {
            let (Ok(path), Ok(folder)) = (self.path(&name), self.folder_or()) else { return String::new() };
            let aside = folder.join(format!("{name}.{ASIDE}"));
            match fs::rename(&path, &aside) {
                Ok(()) => format!("{name} is kept as {}: {cause}", show_path(&aside)),
                Err(_) => format!("{}: {cause}", show_path(&path)),
            }
        };
        match self.summary(&name) {
            Ok(summary) if summary.ended == Ended::Dropped => {}
            Ok(_) => return Ok(None),
            Err(ArchiveError::Unreadable { cause: cause @ Unreadable::Damaged(_), .. }) => {
                return Err(damaged(&cause));
            }
            Err(error) => return Err(error.to_string()),
        }
        match self.load(&name) {
            Ok(held) => Ok(Some(held)),
            // Another program was faster.
            Err(ArchiveError::Running { .. }) => Ok(None),
            Err(ArchiveError::Unreadable { cause: cause @ Unreadable::Damaged(_), .. }) => {
                Err(damaged(&cause))
            }
            Err(error) => Err(error.to_string()),
        }
    }

    /// Removes a session, and the data that no other session uses.
    pub fn delete(&self, name: &str) -> Result<(), ArchiveError> {
        self.remove(name)?;
        let folder = self.folder_or()?;
        Data::beside(folder).sweep(folder);
        Ok(())
    }

    fn remove(&self, name: &str) -> Result<(), ArchiveError> {
        let path = self.path(name)?;
        let _claim = Claim::of(self.folder_or()?, name)?;
        fs::remove_file(&path).map_err(failed(&path, "remove it"))
    }

    /// The size of the data that this session uses and none before it did; they are taken out of `sizes`.
    fn bytes_of_data(&self, name: &str, sizes: &mut HashMap<String, u64>) -> u64 {
        if sizes.is_empty() {
            return 0;
        }
        let bytes = self.bytes(name).unwrap_or_default();
        named_in(&bytes).filter_map(|hash| sizes.remove(hash)).sum()
    }

    /// The right to write a new session, named after `base` and the next number.
    pub fn begin(&self, base: &str) -> Result<Claim, ArchiveError> {
        let folder = self.folder_or()?;
        crate::store::make_folder(folder).map_err(failed(folder, "make the folder"))?;
        let base = base_name(base);
        let taken = fs::read_dir(folder).map_err(failed(folder, "list the sessions"))?;
        // Damaged sessions and those with only a lock left count too: a name is not reused while any file carries it.
        let last = taken.filter_map(Result::ok).filter_map(|file| {
            let name = PathBuf::from(file.file_name());
            let (stem, number) = name.file_stem()?.to_str()?.trim_start_matches('.').rsplit_once('-')?;
            number.parse::<u32>().ok().filter(|_| stem == base)
        });
        let mut next = last.max().unwrap_or(0);
        loop {
            next = next.saturating_add(1);
            match Claim::of(folder, &format!("{base}-{next}")) {
                // Another program begins a session at the same moment.
                Err(ArchiveError::Running { .. }) if next < u32::MAX => {}
                claim => return claim,
            }
        }
    }

    /// Makes room: removes the oldest sessions beyond the limits, the data that no session uses, and what killed
    /// programs have left behind.
    pub fn make_room(&self, keep: &str) {
        let (Some(folder), Ok(entries)) = (&self.folder, self.list()) else { return };
        let data = Data::beside(folder);
        let mut sizes = data.sizes();
        let (mut count, mut bytes) = (0, 0);
        for entry in entries {
            (count, bytes) = (count + 1, bytes + entry.bytes + self.bytes_of_data(&entry.name, &mut sizes));
            if (count > MOST || bytes > MOST_BYTES) && entry.name != keep {
                // A running session stays, and so does one that cannot be removed.
                let _ = self.remove(&entry.name);
            }
        }
        data.sweep(folder);
        let left = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok).filter(|file| {
            let age = file.metadata().and_then(|metadata| metadata.modified()).map(|at| at.elapsed());
            let is_old = matches!(age, Ok(Ok(age)) if age > STALE);
            is_old && file.file_name().to_str().is_some_and(|name| is_left_behind(folder, name))
        });
        for file in left {
            let _ = fs::remove_file(file.path());
        }
    }
}

/// Whether a file is a lock without a session. What a killed write leaves is swept by the next write.
fn is_left_behind(folder: &Path, name: &str) -> bool {
    let lock = name.strip_prefix('.').and_then(|name| name.strip_suffix(".lock"));
    let session = lock.map(|name| folder.join(format!("{name}.{ENDING}")));
    session.is_some_and(|session| !session.exists()) && !FileLock::is_held(&folder.join(name))
}

fn lock_of(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!(".{name}.lock"))
}

fn number(name: &str) -> u32 {
    name.rsplit_once('-').and_then(|(_, number)| number.parse().ok()).unwrap_or(0)
}

/// The name of a preset's sessions, before the number.
fn base_name(preset: &str) -> String {
    let stem =
        Path::new(preset).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().to_lowercase());
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || matches!(c, '-' | '_');
    let name: String = stem.chars().filter(|c| plain(*c)).take(50).collect();
    if is_well_formed(&name) { name } else { "session".to_owned() }
}

/// How long ago a moment was, in words.
pub fn ago(seconds: u64) -> String {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    match now.saturating_sub(seconds) {
        0..60 => "less than a minute ago".to_owned(),
        age @ 60..3600 => format!("{} min ago", age / 60),
        age @ 3600..172_800 => format!("{} h ago", age / 3600),
        age => format!("{} days ago", age / 86_400),
    }
}

#[cfg(test)]
mod tests;
