//! Why a session cannot be found, read or written.

use crate::explorer::session::Unreadable;
use crate::mend::mend;
use crate::store::WriteError;
use crate::store::file::FileError;
use pulloff_engine::text::show_path;
use std::io;
use std::path::Path;
use thiserror::Error;

/// The size of the largest session that is read, in bytes.
pub(super) const LARGEST: u64 = 256 << 20;

/// Why a session cannot be found, read or written, in one line. Names and paths in it are safe to show.
#[derive(Debug, Error)]
pub enum ArchiveError {
    /// Neither a state folder nor a home folder is known.
    #[error("no folder for sessions: neither XDG_STATE_HOME nor HOME is set")]
    NoFolder,
    /// `hint` says which one may be meant, after a semicolon, or is empty.
    #[error("no session is called \"{name}\"{hint}")]
    NotFound { name: String, hint: String },
    #[error("there is no session to resume")]
    Empty,
    #[error("the session {name} is running in another pulloff")]
    Running { name: String },
    #[error("{path}: {cause}")]
    Unreadable { path: String, cause: Unreadable },
    /// The rows of a profile are not as they were written.
    #[error("{path}: the rows of its profile \"{name}\" are lost: {why}")]
    Data { path: String, name: String, why: String },
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error("the session cannot be written: {0}")]
    Document(serde_json::Error),
    #[error("{path}: cannot {doing}: {cause}")]
    Io { path: String, doing: &'static str, cause: io::Error },
}

mend!(
    ArchiveError, as 0 of File | Write, as cause of Io, never Document,
    always NoFolder | NotFound | Empty | Running | Unreadable | Data
);

impl ArchiveError {
    /// The reason without the path, for a line that is cut off at the edge of the screen.
    pub(super) fn brief(&self) -> String {
        match self {
            Self::Write(WriteError::Io { doing, cause, .. }) | Self::Io { doing, cause, .. } => {
                format!("cannot {doing}: {cause}")
            }
            other => other.to_string(),
        }
    }
}

/// Why something could not be done with the file or folder `path`.
pub(super) fn failed(path: &Path, doing: &'static str) -> impl FnOnce(io::Error) -> ArchiveError {
    let path = show_path(path);
    move |cause| ArchiveError::Io { path, doing, cause }
}
