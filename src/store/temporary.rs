//! The temporary file of a save: beside its target, locked while its writer lives, removed once the writer has died.
//!
//! A writer that is killed leaves its temporary behind. Nobody mistakes it for anything else, since its name begins
//! with a dot and ends in `.tmp`, and the next save in the folder removes it: by then the kernel has released the lock.

use super::lock::is_granted;
use rustix::fs::{Gid, OFlags, Uid, fchown};
use std::fs::{self, File, Metadata, OpenOptions, Permissions, TryLockError};
use std::io;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::Path;
use std::sync::{PoisonError, RwLock, RwLockReadGuard};
use std::thread;
use std::time::{Duration, Instant};
use tempfile::NamedTempFile;

const PREFIX: &str = ".pulloff-";
const SUFFIX: &str = ".tmp";
/// The mode of a new file, before the umask.
const NEW: u32 = 0o666;
/// How often [`finish`] checks.
const PAUSE: Duration = Duration::from_millis(2);

/// Held for reading while a temporary of this process exists.
static WRITING: RwLock<()> = RwLock::new(());

/// [`finish`] waits while the returned guard lives.
pub(super) fn begin() -> RwLockReadGuard<'static, ()> {
    WRITING.read().unwrap_or_else(PoisonError::into_inner)
}

/// Waits at most `patience` until no file of this process is half written, and prevents any further write.
///
/// Called at the end of the process, which would otherwise cut off the writing thread and leave its temporary behind.
pub fn finish(patience: Duration) {
    let until = Instant::now() + patience;
    loop {
        if let Ok(nobody) = WRITING.try_write() {
            // Never dropped: a write that started now would be cut off.
            std::mem::forget(nobody);
            return;
        }
        if Instant::now() > until {
            return;
        }
        thread::sleep(PAUSE);
    }
}

/// A new, exclusive, locked file beside the target in `folder`, with the owner and permissions of `old`.
pub(super) fn beside(folder: &Path, old: Option<&Metadata>) -> io::Result<NamedTempFile> {
    sweep(folder);
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    let temporary = loop {
        let temporary = match old {
            None => builder.permissions(Permissions::from_mode(NEW)).tempfile_in(folder)?,
            Some(_) => builder.tempfile_in(folder)?,
        };
        // Where there are no locks, nobody can sweep either.
        while !is_granted(temporary.as_file().lock().map_err(TryLockError::Error))? {}
        // Another process's sweep may have run between the two steps.
        if temporary.as_file().metadata()?.nlink() > 0 {
            break temporary;
        }
    };
    if let Some(old) = old {
        give_to(temporary.as_file(), old)?;
    }
    Ok(temporary)
}

/// Gives the file the owner and permissions of another.
fn give_to(file: &File, old: &Metadata) -> io::Result<()> {
    let new = file.metadata()?;
    let mut mode = old.mode() & 0o777;
    if (new.uid(), new.gid()) != (old.uid(), old.gid()) {
        let owner = fchown(file, Some(Uid::from_raw(old.uid())), Some(Gid::from_raw(old.gid())));
        // Only root can give files away. Otherwise the file becomes ours, and if its group is not the old one, that
        // group gets no more rights than everybody.
        if owner.is_err() && fchown(file, None, Some(Gid::from_raw(old.gid()))).is_err() {
            mode = (mode & 0o707) | ((mode & 0o007) << 3 & mode);
        }
    }
    file.set_permissions(Permissions::from_mode(mode))
}

/// Removes what killed writers left in `folder`. What cannot be removed stays.
fn sweep(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.filter_map(Result::ok) {
        let name = entry.file_name();
        let name = name.as_encoded_bytes();
        if name.starts_with(PREFIX.as_bytes()) && name.ends_with(SUFFIX.as_bytes()) {
            sweep_one(&entry.path());
        }
    }
}

fn sweep_one(path: &Path) {
    let flags = OFlags::NOFOLLOW | OFlags::NONBLOCK;
    let Ok(flags) = i32::try_from(flags.bits()) else { return };
    let Ok(file) = OpenOptions::new().read(true).custom_flags(flags).open(path) else { return };
    let is_file = file.metadata().is_ok_and(|metadata| metadata.is_file());
    if is_file && file.try_lock().is_ok() {
        let _ = fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_dead_writer_left_is_swept_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for name in [".pulloff-dead.tmp", ".pulloff-notes", "mine.tmp", "mine.toml"] {
            fs::write(at(name), "torn").unwrap();
        }
        fs::create_dir(at(".pulloff-folder.tmp")).unwrap();
        std::os::unix::fs::symlink("mine.toml", at(".pulloff-link.tmp")).unwrap();
        // One whose writer lives, as in another process: flock belongs to the open file.
        let alive = beside(folder.path(), None).unwrap();
        assert!(!at(".pulloff-dead.tmp").exists());
        let second = beside(folder.path(), None).unwrap();
        assert!(alive.path().exists() && second.path().exists());
        for name in [".pulloff-notes", "mine.tmp", "mine.toml", ".pulloff-folder.tmp", ".pulloff-link.tmp"] {
            assert!(at(name).symlink_metadata().is_ok(), "{name} was removed");
        }
    }
}
