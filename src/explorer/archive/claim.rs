//! The right to write one session.

use super::data::Data;
use super::error::{ArchiveError, failed};
use super::{ENDING, lock_of};
use crate::explorer::session::Document;
use crate::store::lock::FileLock;
use crate::store::{Overwrite, write_atomically};
use std::path::{Path, PathBuf};

/// The right to write one session; dropping it lets another program have it.
#[derive(Debug)]
pub struct Claim {
    name: String,
    path: PathBuf,
    data: Data,
    _lock: FileLock,
}

impl Claim {
    /// The right to write the session `name` in `folder`.
    pub(super) fn of(folder: &Path, name: &str) -> Result<Self, ArchiveError> {
        let lock = lock_of(folder, name);
        let held = FileLock::acquire(&lock).map_err(failed(&lock, "lock the session"))?;
        let lock = held.ok_or_else(|| ArchiveError::Running { name: name.to_owned() })?;
        Ok(Self {
            name: name.to_owned(),
            path: folder.join(format!("{name}.{ENDING}")),
            data: Data::beside(folder),
            _lock: lock,
        })
    }

    /// The session's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Writes `document` whole or not at all; first writes the rows of its profiles that are in no file yet.
    pub fn save(&mut self, mut document: Document) -> Result<(), ArchiveError> {
        let mut held = None;
        document.lay_aside(|rows| {
            if held.is_none() {
                held = Some(self.data.hold()?);
            }
            self.data.keep(rows)
        })?;
        self.write(&document.json().map_err(ArchiveError::Document)?)
    }

    /// Writes the session whole or not at all.
    pub fn write(&self, bytes: &[u8]) -> Result<(), ArchiveError> {
        write_atomically(&self.path, bytes, Overwrite::Always)?;
        Ok(())
    }
}
