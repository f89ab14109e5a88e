//! One saver at a time in a folder.
//!
//! The lock is an advisory one on the folder itself: it leaves no file behind, and the kernel drops it with the
//! process, so it cannot be stale.

use rustix::fs::{FlockOperation, flock};
use rustix::io::Errno;
use std::fs::File;
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

/// How long a saver waits for another; a save takes milliseconds.
pub const PATIENCE: Duration = Duration::from_secs(3);
/// How often it looks.
const PAUSE: Duration = Duration::from_millis(5);

/// A held lock; dropping it lets the next saver in.
#[derive(Debug)]
pub struct FolderLock {
    _folder: File,
}

impl FolderLock {
    /// Waits up to `patience` for the lock; `None` if another still holds it.
    ///
    /// # Errors
    /// The folder cannot be opened or locked. A file system that knows no locks is none: there the check of
    /// the file itself, just before it is replaced, is all there is.
    pub fn acquire(folder: &Path, patience: Duration) -> io::Result<Option<Self>> {
        let file = File::open(folder)?;
        Ok(lock_file(&file, patience)?.then_some(Self { _folder: file }))
    }
}

/// Waits up to `patience` for the lock of an open file, which lasts until it is closed; whether it was given.
///
/// # Errors
/// The file cannot be locked. A file system that knows no locks gives every one.
pub fn lock_file(file: &File, patience: Duration) -> io::Result<bool> {
    let deadline = Instant::now() + patience;
    loop {
        match flock(file, FlockOperation::NonBlockingLockExclusive) {
            Ok(()) | Err(Errno::NOTSUP | Errno::NOLCK | Errno::INVAL | Errno::BADF | Errno::NOSYS) => {
                return Ok(true);
            }
            Err(Errno::WOULDBLOCK | Errno::INTR) if Instant::now() < deadline => {
                std::thread::sleep(PAUSE);
            }
            Err(Errno::WOULDBLOCK | Errno::INTR) => return Ok(false),
            Err(other) => return Err(other.into()),
        }
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
}
