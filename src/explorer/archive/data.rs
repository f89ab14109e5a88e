//! The rows of measured profiles, and measured curves, in files beside the sessions that use them.
//!
//! A session is written every few seconds, but the rows of its profile stay the same, so they are written once, to
//! `data/HASH.csv` in the folder of sessions, where HASH is the SHA-256 of that file. Sessions with the same rows share
//! it. A measured curve is kept exactly as its own file is.
//! The lock of the folder `data` is held from the check of the file until the session that refers to it is written, and
//! whenever files that no session refers to are removed.

use super::error::{ArchiveError, LARGEST, failed};
use crate::explorer::session::{Aside, SavedFile};
use crate::store::file::{FileError, read_bytes};
use crate::store::hash::{DIGITS, sha256};
use crate::store::lock::{FolderLock, PATIENCE};
use crate::store::{Overwrite, make_folder, write_atomically};
use pulloff_engine::text::{quote, show_path};
use std::collections::{HashMap, HashSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The folder of the data, inside the folder of sessions.
const FOLDER: &str = "data";
/// The extension of a data file.
const ENDING: &str = "csv";

/// The data of one session, or of all sessions.
#[derive(Debug)]
pub(super) struct Data {
    folder: PathBuf,
    /// What is already in files, with its hash: rows are written out and hashed once, not at every write.
    known: Vec<(Aside, String)>,
}

impl Data {
    /// The data beside the sessions in the folder `sessions`.
    pub(super) fn beside(sessions: &Path) -> Self {
        Self { folder: sessions.join(FOLDER), known: Vec::new() }
    }

    fn path(&self, hash: &str) -> PathBuf {
        self.folder.join(format!("{hash}.{ENDING}"))
    }

    /// Keeps anyone from removing data, until it is dropped.
    pub(super) fn hold(&self) -> Result<Option<FolderLock>, ArchiveError> {
        make_folder(&self.folder).map_err(failed(&self.folder, "make the folder"))?;
        // If the wait is in vain, go on: better a session whose data may be removed than none at all.
        FolderLock::acquire(&self.folder, PATIENCE).map_err(failed(&self.folder, "lock it"))
    }

    /// Makes sure that `kept` is in a file, and returns the hash that names it.
    pub(super) fn keep(&mut self, kept: &Aside) -> Result<String, ArchiveError> {
        let known = self.known.iter().find(|(known, _)| known.is_same(kept));
        let known = known.map(|(_, hash)| hash.clone());
        if let Some(hash) = &known
            && self.path(hash).symlink_metadata().is_ok_and(|there| there.is_file())
        {
            return Ok(hash.clone());
        }
        let bytes = kept.bytes();
        let hash = known.unwrap_or_else(|| {
            let hash = sha256(&bytes);
            self.known.push((kept.clone(), hash.clone()));
            hash
        });
        let path = self.path(&hash);
        // A file that was altered is restored.
        if !read_bytes(&path, LARGEST).is_ok_and(|(there, _)| *there == *bytes) {
            write_atomically(&path, &bytes, Overwrite::Always)?;
        }
        Ok(hash)
    }

    /// The content of a file of the session in the file `session`.
    pub(super) fn take_back(
        &self,
        session: &Path,
        file: &SavedFile,
        hash: &str,
    ) -> Result<Aside, ArchiveError> {
        let bytes = self.bytes(session, hash, &file.name)?;
        file.with(&bytes).ok_or_else(|| ArchiveError::Data {
            path: show_path(session),
            name: quote(&file.name),
            why: format!("{} holds no rows r,h", show_path(&self.path(hash))),
        })
    }

    /// The data with this hash, for the file `name` of the session in the file `session`.
    fn bytes(&self, session: &Path, hash: &str, name: &str) -> Result<Vec<u8>, ArchiveError> {
        let lost = |why: String| ArchiveError::Data { path: show_path(session), name: quote(name), why };
        if !is_hash(hash) {
            return Err(lost(format!("\"{}\" is not a SHA-256", quote(hash))));
        }
        let path = self.path(hash);
        let bytes = match read_bytes(&path, LARGEST) {
            Ok((bytes, _)) => bytes,
            Err(FileError::Io { path, cause }) if cause.kind() == io::ErrorKind::NotFound => {
                return Err(lost(format!("{path} is gone")));
            }
            Err(error) => return Err(error.into()),
        };
        if sha256(&bytes) != hash {
            return Err(lost(format!(
                "{} was changed: its SHA-256 does not match its name",
                show_path(&path)
            )));
        }
        Ok(bytes)
    }

    /// The size of each data file in bytes, by its hash.
    pub(super) fn sizes(&self) -> HashMap<String, u64> {
        let files = fs::read_dir(&self.folder).into_iter().flatten().filter_map(Result::ok);
        let sizes = files.filter_map(|file| {
            let path = PathBuf::from(file.file_name());
            let hash = path.file_stem()?.to_str().filter(|stem| is_hash(stem))?.to_owned();
            let metadata = file.metadata().ok().filter(fs::Metadata::is_file)?;
            (path.extension()? == ENDING).then_some((hash, metadata.len()))
        });
        sizes.collect()
    }

    /// Removes the data that no file of the folder `sessions` names. While a session is being written, or when one
    /// cannot be read, all data stay.
    pub(super) fn sweep(&self, sessions: &Path) {
        if self.sizes().is_empty() {
            return;
        }
        let Ok(Some(_lock)) = FolderLock::acquire(&self.folder, Duration::ZERO) else { return };
        let Ok(files) = fs::read_dir(sessions) else { return };
        let mut named = HashSet::new();
        for file in files {
            // Sessions kept aside as damaged count too, and so does anything else a person has put there.
            let Ok(file) = file else { return };
            if file.file_type().is_ok_and(|kind| kind.is_file()) {
                match read_bytes(&file.path(), LARGEST) {
                    Ok((bytes, _)) => named.extend(named_in(&bytes).map(str::to_owned)),
                    Err(FileError::Io { cause, .. }) if cause.kind() == io::ErrorKind::NotFound => {}
                    Err(_) => return,
                }
            }
        }
        for hash in self.sizes().keys().filter(|hash| !named.contains(*hash)) {
            let _ = fs::remove_file(self.path(hash));
        }
    }
}

/// The hashes in the bytes of a session, even if the rest of it cannot be read.
pub(super) fn named_in(bytes: &[u8]) -> impl Iterator<Item = &str> {
    let words = bytes.split(|byte| !byte.is_ascii_alphanumeric());
    words.filter_map(|word| std::str::from_utf8(word).ok().filter(|word| is_hash(word)))
}

fn is_hash(text: &str) -> bool {
    text.len() == DIGITS && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hash_is_found_in_whatever_is_left_of_a_session() {
        let hash = sha256(b"rows");
        let torn = format!("{{\"data\":\"{hash}\",\"text\":\"{hash}0 {}\",\"no", hash.to_uppercase());
        assert_eq!(named_in(torn.as_bytes()).collect::<Vec<_>>(), [hash]);
    }
}
