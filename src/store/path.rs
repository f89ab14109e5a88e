//! Paths in a document, where they need not be text.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::ffi::OsString;
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::path::{Path, PathBuf};

/// A path: its text, or its bytes if they are not text.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SavedPath {
    Text(String),
    Bytes(Vec<u8>),
}

impl SavedPath {
    /// The written form of `path`.
    pub fn of(path: &Path) -> Self {
        path.to_str().map_or_else(
            || Self::Bytes(path.as_os_str().as_bytes().to_vec()),
            |text| Self::Text(text.to_owned()),
        )
    }

    /// The inverse.
    pub fn path(self) -> PathBuf {
        match self {
            Self::Text(text) => text.into(),
            Self::Bytes(bytes) => OsString::from_vec(bytes).into(),
        }
    }
}

/// For `#[serde(with = "path")]`.
pub(super) fn serialize<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    SavedPath::of(path).serialize(serializer)
}

/// For `#[serde(with = "path")]`.
pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<PathBuf, D::Error> {
    SavedPath::deserialize(deserializer).map(SavedPath::path)
}
