//! Reads regular files of bounded size, and recognises them later.

use crate::mend::mend;
use pulloff_engine::text::show_path;
use serde::{Deserialize, Serialize};
use std::fs::{File, Metadata, OpenOptions};
use std::hash::{DefaultHasher, Hasher};
use std::io::{self, BufRead, BufReader, Read};
use std::os::unix::fs::{FileTypeExt, MetadataExt, OpenOptionsExt};
use std::path::Path;
use thiserror::Error;

/// The largest preset file, in bytes.
pub const LARGEST: u64 = 1 << 20;

/// A file as it was at one moment: size, time, inode, content. Equal only if nothing has changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fingerprint {
    length: u64,
    seconds: i64,
    nanoseconds: i64,
    device: u64,
    inode: u64,
    content: u64,
}

impl Fingerprint {
    /// The fingerprint of a file with this metadata and content.
    #[must_use]
    pub fn new(metadata: &Metadata, content: &[u8]) -> Self {
        // Saved with sessions: if another build of the program hashes differently, the file counts as changed, and the
        // user is asked before it is replaced.
        let mut hasher = DefaultHasher::new();
        hasher.write(content);
        Self {
            length: metadata.len(),
            seconds: metadata.mtime(),
            nanoseconds: metadata.mtime_nsec(),
            device: metadata.dev(),
            inode: metadata.ino(),
            content: hasher.finish(),
        }
    }
}

/// Why a file cannot be read. Names and paths in the error are safe to show.
#[derive(Debug, Error)]
pub enum FileError {
    #[error("{}: cannot read: {cause}", .path)]
    Io { path: String, cause: io::Error },
    #[error("{path}: is {what}, not a regular file")]
    NotRegular { path: String, what: &'static str },
    #[error("{path}: has {bytes} bytes, more than the {limit} that are read")]
    TooLarge { path: String, bytes: u64, limit: u64 },
    /// A pipe or device that yields more than any preset could.
    #[error("{path}: has more than the {limit} bytes that are read")]
    Endless { path: String, limit: u64 },
    #[error("{path}: is not UTF-8 text (from byte {at})")]
    NotText {
        path: String,
        /// The first invalid byte, counted from 0.
        at: usize,
    },
}

mend!(FileError, as cause of Io, always NotRegular | TooLarge | Endless | NotText);

/// The kind of a file that is not regular.
pub fn kind_of(metadata: &Metadata) -> &'static str {
    let kind = metadata.file_type();
    if kind.is_dir() {
        "a folder"
    } else if kind.is_fifo() {
        "a pipe"
    } else if kind.is_socket() {
        "a socket"
    } else if kind.is_char_device() || kind.is_block_device() {
        "a device"
    } else {
        "a special file"
    }
}

/// The first line of a regular file, up to the length that a header may have.
pub fn first_line(path: &Path) -> io::Result<String> {
    /// Far longer than the header of a table.
    const LONGEST: u64 = 4096;
    let mut line = Vec::new();
    BufReader::new(File::open(path)?.take(LONGEST)).read_until(b'\n', &mut line)?;
    Ok(String::from_utf8_lossy(&line).into_owned())
}

/// The text of a regular file of at most `limit` bytes.
pub fn read_text(path: &Path, limit: u64) -> Result<(String, Fingerprint), FileError> {
    let (bytes, fingerprint) = read_bytes(path, limit)?;
    Ok((text(&show_path(path), bytes)?, fingerprint))
}

/// The bytes as text; messages call it `name`.
pub(super) fn text(name: &str, bytes: Vec<u8>) -> Result<String, FileError> {
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        FileError::NotText { path: name.to_owned(), at }
    })
}

/// The content of a regular file of at most `limit` bytes.
pub fn read_bytes(path: &Path, limit: u64) -> Result<(Vec<u8>, Fingerprint), FileError> {
    let io = |cause| FileError::Io { path: show_path(path), cause };
    // Checked before opening, because opening a device can have effects, and again afterwards, because the name may
    // meanwhile refer to another file.
    check_regular(path, &path.metadata().map_err(io)?)?;
    let file = open(path).map_err(io)?;
    let metadata = file.metadata().map_err(io)?;
    check_regular(path, &metadata)?;
    let too_large = |bytes| FileError::TooLarge { path: show_path(path), bytes, limit };
    if metadata.len() > limit {
        return Err(too_large(metadata.len()));
    }
    let mut bytes = Vec::new();
    (&file).take(limit + 1).read_to_end(&mut bytes).map_err(io)?;
    if bytes.len() as u64 > limit {
        return Err(too_large(bytes.len() as u64));
    }
    let fingerprint = Fingerprint::new(&metadata, &bytes);
    Ok((bytes, fingerprint))
}

fn check_regular(path: &Path, metadata: &Metadata) -> Result<(), FileError> {
    if metadata.is_file() {
        Ok(())
    } else {
        Err(FileError::NotRegular { path: show_path(path), what: kind_of(metadata) })
    }
}

/// Opens without waiting for the other end of a pipe that may have taken the file's place.
fn open(path: &Path) -> io::Result<File> {
    let flags = rustix::fs::OFlags::NONBLOCK | rustix::fs::OFlags::NOCTTY;
    OpenOptions::new().read(true).custom_flags(flags.bits().cast_signed()).open(path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustix::fs::{CWD, FileType, Mode, mknodat};

    #[test]
    fn only_regular_bounded_text_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("good"), "héllo").unwrap();
        std::fs::write(at("bytes"), b"ab\xff").unwrap();
        std::fs::write(at("large"), vec![b' '; 101]).unwrap();
        mknodat(CWD, at("pipe"), FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
        std::os::unix::fs::symlink(at("good"), at("link")).unwrap();
        std::os::unix::fs::symlink(at("pipe"), at("link-to-pipe")).unwrap();
        let error = |path: &Path| read_text(path, 100).unwrap_err().to_string();
        assert_eq!(read_text(&at("good"), 100).unwrap().0, "héllo");
        assert_eq!(read_text(&at("link"), 100).unwrap().0, "héllo");
        assert!(error(&at("bytes")).ends_with("is not UTF-8 text (from byte 2)"));
        assert!(error(&at("large")).ends_with("has 101 bytes, more than the 100 that are read"));
        assert!(error(&at("pipe")).ends_with("is a pipe, not a regular file"));
        assert!(error(&at("link-to-pipe")).ends_with("is a pipe, not a regular file"));
        assert!(error(folder.path()).ends_with("is a folder, not a regular file"));
        assert!(error(Path::new("/dev/null")).ends_with("is a device, not a regular file"));
        assert!(error(&at("missing")).contains("cannot read: No such file"));
    }

    #[test]
    fn a_fingerprint_sees_every_change() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        std::fs::write(&path, "one").unwrap();
        let print = || read_bytes(&path, 100).unwrap().1;
        let first = print();
        assert_eq!(first, print());
        let metadata = path.metadata().unwrap();
        assert_ne!(Fingerprint::new(&metadata, b"one"), Fingerprint::new(&metadata, b"two"));
        // Same content and size in another file.
        std::fs::write(folder.path().join("b"), "one").unwrap();
        std::fs::rename(folder.path().join("b"), &path).unwrap();
        assert_ne!(first, print());
    }
}
