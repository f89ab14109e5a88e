//! One saver at a time per folder, and one program at a time per file.
//!
//! The locks are advisory, and the kernel releases them when the process ends, so they cannot be stale. The lock of a
//! folder is on the folder itself and leaves no file behind. The lock of a file that is replaced as a whole needs a
//! separate file beside it, which is removed with the lock; a killed process leaves that file behind, empty and
//! unlocked.

use rustix::io::Errno;
use std::fs::{File, OpenOptions, TryLockError};
use std::io;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How long a saver waits for another; a save takes milliseconds.
pub const PATIENCE: Duration = Duration::from_secs(3);
/// How often it checks.
const PAUSE: Duration = Duration::from_millis(5);

/// A held lock; dropping it lets the next saver in.
#[derive(Debug)]
pub struct FolderLock {
    _folder: File,
}

impl FolderLock {
    /// Waits up to `patience` for the lock; `None` if another process still holds it.
    /// Errors: The folder cannot be opened or locked. It is no error if the file system does not support locks; then
    /// the check of the file itself, just before it is replaced, is the only protection.
    pub fn acquire(folder: &Path, patience: Duration) -> io::Result<Option<Self>> {
        let file = File::open(folder)?;
        Ok(lock_file(&file, patience)?.then_some(Self { _folder: file }))
    }
}

/// Waits up to `patience` for the lock of an open file, which lasts until the file is closed; returns whether it was
/// granted.
/// Errors: The file cannot be locked. A file system without locks grants every one.
pub fn lock_file(file: &File, patience: Duration) -> io::Result<bool> {
    let deadline = Instant::now() + patience;
    while !is_granted(file.try_lock())? {
        if Instant::now() >= deadline {
            return Ok(false);
        }
        std::thread::sleep(PAUSE);
    }
    Ok(true)
}

/// Whether a lock was granted: not if another process holds it, or if a signal came before. A file system without locks
/// grants every one.
pub(super) fn is_granted(outcome: Result<(), TryLockError>) -> io::Result<bool> {
    match outcome {
        Ok(()) => Ok(true),
        Err(TryLockError::WouldBlock) => Ok(false),
        Err(TryLockError::Error(error)) => match Errno::from_io_error(&error) {
            Some(Errno::NOTSUP | Errno::NOLCK | Errno::INVAL | Errno::BADF | Errno::NOSYS) => Ok(true),
            Some(Errno::INTR) => Ok(false),
            _ => Err(error),
        },
    }
}

/// A lock held through a separate file, which is removed with it.
#[derive(Debug)]
pub struct FileLock {
    path: PathBuf,
    _file: File,
}

impl FileLock {
    /// How long to wait for a process that only checks whether the lock is held.
    const PATIENCE: Duration = Duration::from_millis(50);

    /// Takes the lock of the file `path`, which is created; `None` if another process holds it.
    pub fn acquire(path: &Path) -> io::Result<Option<Self>> {
        let deadline = Instant::now() + Self::PATIENCE;
        loop {
            let flags = rustix::fs::OFlags::NOFOLLOW | rustix::fs::OFlags::NONBLOCK;
            let mut options = OpenOptions::new();
            options.write(true).create(true).truncate(false).mode(0o600);
            let file = options.custom_flags(flags.bits().cast_signed()).open(path)?;
            if is_granted(file.try_lock())? {
                let ours = file.metadata()?;
                // The previous holder removes the file; a lock on a file that no longer has a name is worthless.
                let named = path.symlink_metadata();
                if named.is_ok_and(|named| (named.dev(), named.ino()) == (ours.dev(), ours.ino())) {
                    return Ok(Some(Self { path: path.to_owned(), _file: file }));
                }
            } else if Instant::now() >= deadline {
                return Ok(None);
            }
            std::thread::sleep(PAUSE);
        }
    }

    /// Whether any process holds the lock of the file `path`.
    pub fn is_held(path: &Path) -> bool {
        File::open(path).is_ok_and(|file| matches!(is_granted(file.try_lock()), Ok(false)))
    }
}

impl Drop for FileLock {
    fn drop(&mut self) {
        // Removed while it is still locked, so that nobody else's file is removed.
        let _ = std::fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let lock = |wait| FolderLock::acquire(folder.path(), Duration::from_millis(wait)).unwrap();
        let first = lock(0);
        assert!(first.is_some() && lock(10).is_none());
        drop(first);
        assert!(lock(0).is_some());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "no lock file is left");
    }

    #[test]
    fn a_file_is_held_by_one_and_left_by_none() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(".a.lock");
        assert!(!FileLock::is_held(&path));
        let first = FileLock::acquire(&path).unwrap();
        assert!(first.is_some() && FileLock::is_held(&path));
        assert!(FileLock::acquire(&path).unwrap().is_none());
        drop(first);
        assert!(!FileLock::is_held(&path) && !path.exists());
        // A file left by a killed process is not a lock.
        std::fs::write(&path, "").unwrap();
        assert!(!FileLock::is_held(&path) && FileLock::acquire(&path).unwrap().is_some());
    }

    #[test]
    fn a_lock_changes_hands_whole() {
        let folder = tempfile::tempdir().unwrap();
        let (path, inside) = (folder.path().join(".a.lock"), std::sync::atomic::AtomicUsize::new(0));
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..50 {
                        if let Some(_held) = FileLock::acquire(&path).unwrap() {
                            use std::sync::atomic::Ordering::SeqCst;
                            assert_eq!(inside.fetch_add(1, SeqCst), 0, "two hold it");
                            inside.fetch_sub(1, SeqCst);
                        }
                    }
                });
            }
        });
    }
}
