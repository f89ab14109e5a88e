//! Writes a file as a whole or not at all.
//!
//! Links are followed. A temporary file is made beside the target with its permissions, written, synced and read back;
//! then the target is checked once more, the file is renamed, and the folder is synced. At every moment the name holds
//! the complete old content or the complete new content. After an error the temporary is gone and the old file
//! untouched. A temporary left by a kill is removed by the next save in the folder.

use super::file::{Fingerprint, kind_of, read_bytes};
use super::lock::FileLock;
use super::temporary;
use crate::mend::mend;
use pulloff_engine::text::show_path;
use rustix::fs::{Access, access};
use rustix::io::Errno;
use std::fs::{File, Metadata};
use std::io::{self, Read, Seek, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::RwLockReadGuard;
use tempfile::NamedTempFile;
use thiserror::Error;

/// The largest number of successive links that are followed; the kernel's own limit.
const LINKS: usize = 40;

/// What to do about an existing file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Overwrite {
    Never,
    /// Replace it only if it is still the file that was loaded.
    IfUnchanged(Fingerprint),
    Always,
}

/// Why a file was not written. Paths in the error are already safe to show.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The file exists and must not be replaced.
    #[error("{path}: already exists")]
    Exists { path: String },
    /// The file is no longer the one that was loaded.
    #[error("{path}: was changed by someone else since it was read")]
    Changed { path: String },
    /// The file is read-only: its owner does not want it changed, or we may not change it.
    #[error("{path}: is read-only and is not replaced")]
    ReadOnly { path: String },
    /// A folder, a pipe, a device.
    #[error("{path}: is {what}, not a regular file")]
    NotRegular { path: String, what: &'static str },
    /// The content read back differs from what was written.
    #[error("{path}: what was written does not read back: {why}")]
    NotReadBack { path: String, why: String },
    #[error("{path}: another pulloff is writing it")]
    Busy { path: String },
    #[error("{path}: another pulloff is saving in this folder; try again")]
    Locked { path: String },
    #[error("{path}: cannot {doing}: {cause}")]
    Io { path: String, doing: &'static str, cause: io::Error },
}

mend!(
    WriteError, as cause of Io, never NotReadBack,
    always Exists | Changed | ReadOnly | NotRegular | Busy | Locked
);

/// The system's message about a failed write, completed where it is too brief.
pub fn explained(cause: io::Error) -> io::Error {
    match cause.kind() {
        kind @ io::ErrorKind::FileTooLarge => {
            io::Error::new(kind, "over the limit on the size of files (ulimit -f)")
        }
        _ => cause,
    }
}

/// Writes `bytes` to `path` as a whole or not at all, and returns the fingerprint of the written file.
/// Errors: The file must not be replaced, or cannot be written; nothing has changed then. Only if the last step fails,
/// syncing the folder, is the new file in its place, and it may be lost in a power failure.
pub fn write_atomically(path: &Path, bytes: &[u8], overwrite: Overwrite) -> Result<Fingerprint, WriteError> {
    write_verified(path, bytes, overwrite, |_| Ok(()))
}

/// As [`write_atomically`], once `verify` has approved what was read back from the disk.
pub fn write_verified(
    path: &Path,
    bytes: &[u8],
    overwrite: Overwrite,
    verify: impl FnOnce(&[u8]) -> Result<(), String>,
) -> Result<Fingerprint, WriteError> {
    let failed =
        |doing| move |cause| WriteError::Io { path: show_path(path), doing, cause: explained(cause) };
    let mut begun = Begun::new(path, overwrite)?;
    let temporary = begun.temporary.as_file_mut();
    temporary.write_all(bytes).map_err(failed("write"))?;
    temporary.flush().map_err(failed("write"))?;
    temporary.sync_all().map_err(failed("write"))?;
    temporary.rewind().map_err(failed("read back"))?;
    let mut back = Vec::with_capacity(bytes.len());
    temporary.read_to_end(&mut back).map_err(failed("read back"))?;
    let refused = |why| WriteError::NotReadBack { path: show_path(path), why };
    if back != bytes {
        return Err(refused("the disk returns different bytes".to_owned()));
    }
    verify(&back).map_err(refused)?;
    let file = begun.put()?;
    let metadata = file.metadata().map_err(failed("examine what was written"))?;
    Ok(Fingerprint::new(&metadata, bytes))
}

/// As [`write_atomically`] for a file that is not held in memory: `fill` writes it. It is not read back.
pub fn write_filled<E: From<WriteError>>(
    path: &Path,
    overwrite: Overwrite,
    fill: impl FnOnce(&mut File) -> Result<(), E>,
) -> Result<(), E> {
    let failed =
        |doing| move |cause| WriteError::Io { path: show_path(path), doing, cause: explained(cause) };
    let mut begun = Begun::new(path, overwrite)?;
    fill(begun.temporary.as_file_mut())?;
    begun.temporary.as_file().sync_all().map_err(failed("write"))?;
    begun.put()?;
    Ok(())
}

/// A temporary file beside the file that it will replace.
struct Begun<'a> {
    path: &'a Path,
    target: PathBuf,
    overwrite: Overwrite,
    folder: File,
    temporary: NamedTempFile,
    /// Dropped last: the end of the process waits until the temporary is gone.
    writing: RwLockReadGuard<'static, ()>,
}

impl<'a> Begun<'a> {
    fn new(path: &'a Path, overwrite: Overwrite) -> Result<Self, WriteError> {
        let target = follow(path)?;
        let failed = |doing| move |cause| WriteError::Io { path: show_path(path), doing, cause };
        let old = guard(path, &target, overwrite)?;
        free(path, &target)?;
        // Opened while an error still leaves everything as it was.
        let folder = File::open(folder_of(&target)).map_err(failed("open its folder"))?;
        let writing = temporary::begin();
        let temporary = temporary::beside(folder_of(&target), old.as_ref())
            .map_err(failed("make a file in its folder"))?;
        Ok(Self { path, target, overwrite, folder, temporary, writing })
    }

    fn put(self) -> Result<File, WriteError> {
        // The first binding is dropped last.
        let Self { writing: _writing, path, target, overwrite, folder, temporary } = self;
        let failed = |doing| move |cause| WriteError::Io { path: show_path(path), doing, cause };
        // Another process may have written in between; from here to the rename, the time is as short as it can be.
        let old = guard(path, &target, overwrite)?;
        free(path, &target)?;
        let file = if old.is_none() {
            // Nothing was there, so nothing is replaced, even if something appears now.
            temporary.persist_noclobber(&target)
        } else {
            temporary.persist(&target)
        }
        .map_err(|error| match error.error.kind() {
            io::ErrorKind::AlreadyExists => WriteError::Exists { path: show_path(path) },
            _ => failed("put it in its place")(error.error),
        })?;
        sync_folder(&folder).map_err(failed("make sure that its folder keeps it"))?;
        Ok(file)
    }
}

/// The file that a path names after following all links, whether or not it exists.
pub fn follow(path: &Path) -> Result<PathBuf, WriteError> {
    let failed = |cause| WriteError::Io { path: show_path(path), doing: "follow its links", cause };
    let mut target = path.to_owned();
    for _ in 0..LINKS {
        match target.symlink_metadata() {
            Ok(metadata) if metadata.is_symlink() => {
                let next = target.read_link().map_err(failed)?;
                // An absolute link replaces the path; a relative one starts at the link's folder.
                target = folder_of(&target).join(next);
            }
            Ok(_) => return Ok(target),
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(target),
            Err(error) => return Err(failed(error)),
        }
    }
    Err(failed(io::Error::from(io::ErrorKind::TooManyLinks)))
}

/// The folder that contains a file.
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Checks what is there, and refuses what must not be replaced.
fn guard(path: &Path, target: &Path, overwrite: Overwrite) -> Result<Option<Metadata>, WriteError> {
    let shown = || show_path(path);
    let metadata = match target.symlink_metadata() {
        Ok(metadata) => metadata,
        // Writing a file that is gone again overwrites nothing.
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(cause) => return Err(WriteError::Io { path: shown(), doing: "examine it", cause }),
    };
    if !metadata.is_file() {
        return Err(WriteError::NotRegular { path: shown(), what: kind_of(&metadata) });
    }
    match overwrite {
        Overwrite::Never => return Err(WriteError::Exists { path: shown() }),
        Overwrite::IfUnchanged(known) => {
            let same = read_bytes(target, metadata.len()).is_ok_and(|(_, now)| now == known);
            if !same {
                return Err(WriteError::Changed { path: shown() });
            }
        }
        Overwrite::Always => {}
    }
    writable(path, target, &metadata)?;
    Ok(Some(metadata))
}

/// Refuses a file that another process holds: what it goes on to write would be lost.
fn free(path: &Path, target: &Path) -> Result<(), WriteError> {
    if FileLock::is_held(target) { Err(WriteError::Busy { path: show_path(path) }) } else { Ok(()) }
}

/// Refuses a read-only file: a rename would succeed anyway, against its owner's wishes.
fn writable(path: &Path, target: &Path, metadata: &Metadata) -> Result<(), WriteError> {
    // Nothing is forbidden to root, but the owner may still want the file unchanged.
    let is_marked = metadata.mode() & 0o222 == 0;
    if is_marked || access(target, Access::WRITE_OK) == Err(Errno::ACCESS) {
        return Err(WriteError::ReadOnly { path: show_path(path) });
    }
    Ok(())
}

/// Checks, before anything is computed, whether `path` could be written: that nothing is there that must not be
/// replaced, and that its folder accepts a file.
/// Errors: As [`write_atomically`], which may still fail for other reasons.
pub fn check(path: &Path, overwrite: Overwrite) -> Result<(), WriteError> {
    let target = follow(path)?;
    guard(path, &target, overwrite)?;
    let failed = |cause: io::Error| WriteError::Io {
        path: show_path(path),
        doing: "make a file in its folder",
        cause,
    };
    let folder = folder_of(&target);
    let is_name = target.file_name().is_some() && !target.as_os_str().as_encoded_bytes().ends_with(b"/");
    if !is_name || !folder.metadata().map_err(failed)?.is_dir() {
        return Err(failed(io::ErrorKind::NotADirectory.into()));
    }
    access(folder, Access::WRITE_OK | Access::EXEC_OK).map_err(|errno| failed(errno.into()))
}

/// Makes the rename durable. Not every file system can sync a folder; that is no error.
fn sync_folder(folder: &File) -> io::Result<()> {
    match folder.sync_all() {
        Err(error) if matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => {
            Ok(())
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustix::fs::{CWD, FileType, Mode, mknodat};
    use std::fs::{self, Permissions};
    use std::os::unix::fs::{PermissionsExt, symlink};

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn mode(path: &Path) -> u32 {
        path.metadata().unwrap().mode() & 0o7777
    }

    #[test]
    fn a_file_that_another_writes_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.csv");
        write_atomically(&path, b"old", Overwrite::Never).unwrap();
        let written = File::open(&path).unwrap();
        written.lock().unwrap();
        let refused = write_atomically(&path, b"new", Overwrite::Always).unwrap_err();
        assert!(matches!(refused, WriteError::Busy { .. }), "{refused}");
        drop(written);
        write_atomically(&path, b"new", Overwrite::Always).unwrap();
        assert_eq!((fs::read(&path).unwrap(), names(folder.path()).len()), (b"new".to_vec(), 1));
    }

    #[test]
    fn a_new_file_has_the_permissions_of_any_new_file() {
        let folder = tempfile::tempdir().unwrap();
        let (ours, theirs) = (folder.path().join("ours.csv"), folder.path().join("theirs.csv"));
        write_atomically(&ours, b"a,b\n", Overwrite::Never).unwrap();
        fs::write(&theirs, b"").unwrap();
        assert_eq!(fs::read(&ours).unwrap(), b"a,b\n");
        assert_eq!(mode(&ours), mode(&theirs));
        assert_eq!(names(folder.path()), ["ours.csv", "theirs.csv"]);
    }

    #[test]
    fn a_replaced_file_keeps_its_permissions() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        for old in [0o644, 0o600, 0o664, 0o755] {
            fs::write(&path, "old").unwrap();
            fs::set_permissions(&path, Permissions::from_mode(old)).unwrap();
            write_atomically(&path, b"new", Overwrite::Always).unwrap();
            assert_eq!((mode(&path), fs::read(&path).unwrap()), (old, b"new".to_vec()));
        }
    }

    #[test]
    fn links_are_followed_and_stay_links() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("dotfiles")).unwrap();
        fs::write(at("dotfiles/real"), "old").unwrap();
        symlink("dotfiles/real", at("relative")).unwrap();
        symlink(at("relative"), at("absolute")).unwrap();
        symlink("dotfiles/later", at("dangling")).unwrap();
        write_atomically(&at("absolute"), b"new", Overwrite::Always).unwrap();
        write_atomically(&at("dangling"), b"born", Overwrite::Never).unwrap();
        assert_eq!(fs::read(at("dotfiles/real")).unwrap(), b"new");
        assert_eq!(fs::read(at("dotfiles/later")).unwrap(), b"born");
        assert!(at("absolute").symlink_metadata().unwrap().is_symlink());
        assert!(at("dangling").symlink_metadata().unwrap().is_symlink());
        symlink("circle", at("circle")).unwrap();
        let error = write_atomically(&at("circle"), b"", Overwrite::Always).unwrap_err();
        assert!(error.to_string().contains("cannot follow its links"), "{error}");
    }

    #[test]
    fn what_must_not_be_replaced_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let first = write_atomically(&path, b"one", Overwrite::Never).unwrap();
        let never = write_atomically(&path, b"two", Overwrite::Never).unwrap_err();
        assert!(matches!(never, WriteError::Exists { .. }), "{never}");
        // The fingerprint of a write is valid for the next one.
        let second = write_atomically(&path, b"two", Overwrite::IfUnchanged(first)).unwrap();
        let stale = write_atomically(&path, b"three", Overwrite::IfUnchanged(first)).unwrap_err();
        assert!(matches!(stale, WriteError::Changed { .. }), "{stale}");
        fs::write(&path, "someone else's longer text").unwrap();
        let changed = write_atomically(&path, b"three", Overwrite::IfUnchanged(second)).unwrap_err();
        assert!(matches!(changed, WriteError::Changed { .. }), "{changed}");
        assert_eq!(fs::read(&path).unwrap(), b"someone else's longer text");
        write_atomically(&path, b"four", Overwrite::Always).unwrap();
        // A file that is gone is written again.
        fs::remove_file(&path).unwrap();
        write_atomically(&path, b"five", Overwrite::IfUnchanged(second)).unwrap();
        fs::set_permissions(&path, Permissions::from_mode(0o444)).unwrap();
        let print = read_bytes(&path, 100).unwrap().1;
        let marked = write_atomically(&path, b"six", Overwrite::IfUnchanged(print)).unwrap_err();
        assert!(matches!(marked, WriteError::ReadOnly { .. }), "{marked}");
        let asked = write_atomically(&path, b"six", Overwrite::Always).unwrap_err();
        assert_eq!(asked.to_string(), format!("{}: is read-only and is not replaced", show_path(&path)));
        assert_eq!(
            (fs::read(&path).unwrap(), names(folder.path())),
            (b"five".to_vec(), vec!["a".to_owned()])
        );
    }

    #[test]
    fn only_regular_files_are_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        mknodat(CWD, &pipe, FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
        for path in [pipe.as_path(), folder.path(), Path::new("/dev/null"), Path::new("/")] {
            let error = write_atomically(path, b"x", Overwrite::Always).unwrap_err();
            assert!(matches!(error, WriteError::NotRegular { .. }), "{error}");
        }
        assert_eq!(names(folder.path()), ["pipe"]);
    }

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, "old").unwrap();
        let refused = write_verified(&path, b"torn", Overwrite::Always, |_| Err("no preset".to_owned()));
        assert!(refused.unwrap_err().to_string().ends_with("does not read back: no preset"));
        // Another process writes between our writing and our rename.
        let fingerprint = read_bytes(&path, 100).unwrap().1;
        let raced = write_verified(&path, b"ours", Overwrite::IfUnchanged(fingerprint), |_| {
            fs::write(&path, "theirs").map_err(|e| e.to_string())
        });
        assert!(matches!(raced, Err(WriteError::Changed { .. })));
        assert_eq!(fs::read(&path).unwrap(), b"theirs");
        let appeared = folder.path().join("b");
        let raced = write_verified(&appeared, b"ours", Overwrite::Never, |_| {
            fs::write(&appeared, "theirs").map_err(|e| e.to_string())
        });
        assert!(matches!(raced, Err(WriteError::Exists { .. })));
        assert_eq!(fs::read(&appeared).unwrap(), b"theirs");
        for path in ["missing/a", "a/b", ""] {
            let error = write_atomically(&folder.path().join(path), b"x", Overwrite::Always).unwrap_err();
            assert!(!error.to_string().contains('\n'), "{error}");
        }
        assert!(write_atomically(Path::new(""), b"x", Overwrite::Always).is_err());
        assert_eq!(names(folder.path()), ["a", "b"]);
    }

    #[test]
    fn a_read_only_folder_leaves_the_old_file() {
        if rustix::process::geteuid().is_root() {
            return; // Root ignores permissions.
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, "old").unwrap();
        fs::set_permissions(folder.path(), Permissions::from_mode(0o555)).unwrap();
        let error = write_atomically(&path, b"new", Overwrite::Always).unwrap_err();
        fs::set_permissions(folder.path(), Permissions::from_mode(0o755)).unwrap();
        assert!(error.to_string().contains("cannot make a file in its folder: Permission denied"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
    }
}
