//! What has no place in a folder: standard input and output, pipes, terminals, descriptors of this process.
//!
//! A file is replaced as a whole, by a rename. None of these can be: a rename would put a file in the place of the pipe
//! or device, and whoever reads the other end would get nothing. They are read and written directly.

use super::atomic::folder_of;
use super::file::{self, FileError};
use pulloff_engine::text::show_path;
use std::ffi::OsStr;
use std::fs::{File, OpenOptions, canonicalize};
use std::io::{self, Read, stdin};
use std::os::unix::fs::FileTypeExt;
use std::path::{Path, PathBuf};

/// The name of standard input where something is read, and of standard output where something is written.
pub const STANDARD: &str = "-";
/// The folder in which the descriptors of this process have their names.
const DESCRIPTORS: &str = "/dev/fd";
/// The largest number of successive links that are followed; the kernel's own limit.
const LINKS: usize = 40;

/// Whether a path names neither a regular file nor one that could be created, but something that is read and written directly.
pub fn is_stream(path: &Path) -> bool {
    let is_open_ended = |kind: std::fs::FileType| kind.is_fifo() || kind.is_char_device();
    path == Path::new(STANDARD)
        || path.metadata().is_ok_and(|metadata| is_open_ended(metadata.file_type()))
        || descriptor(path).is_some()
}

/// What messages call the destination of such a write.
pub fn shown(path: &Path) -> String {
    if path == Path::new(STANDARD) { "standard output".to_owned() } else { show_path(path) }
}

/// Opens for writing what [`is_stream`] finds.
pub fn open(path: &Path) -> io::Result<File> {
    let descriptor = descriptor(path);
    if path == Path::new(STANDARD) || descriptor.as_deref().is_some_and(|name| name == "1") {
        // A duplicate of the descriptor keeps its position; opening by name would start a file behind it from the beginning.
        return Ok(File::from(rustix::io::dup(rustix::stdio::stdout())?));
    }
    // There may be a file behind a descriptor that others write too.
    OpenOptions::new().write(true).append(descriptor.is_some()).open(path)
}

/// Reads what [`is_stream`] finds to its end; returns the text and what messages call it.
pub fn read_text(path: &Path, limit: u64) -> Result<(String, String), FileError> {
    let (name, bytes) = if path == Path::new(STANDARD) {
        let name = "standard input".to_owned();
        let bytes = bounded(stdin().lock(), limit);
        (name, bytes)
    } else {
        (show_path(path), File::open(path).and_then(|file| bounded(file, limit)))
    };
    let bytes = bytes.map_err(|cause| FileError::Io { path: name.clone(), cause })?;
    if bytes.len() as u64 > limit {
        return Err(FileError::Endless { path: name, limit });
    }
    let text = file::text(&name, bytes)?;
    Ok((name, text))
}

/// Reads a file that the user named, whether or not it is a stream; returns the text and what messages call it.
pub fn read_given(path: &Path, limit: u64) -> Result<(String, String), FileError> {
    if is_stream(path) {
        return read_text(path, limit);
    }
    let (text, _) = file::read_text(path, limit)?;
    Ok((show_path(path), text))
}

fn bounded(source: impl Read, limit: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    source.take(limit + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The name of the open descriptor that a path leads to, such as `1` for `/dev/stdout`.
fn descriptor(path: &Path) -> Option<PathBuf> {
    let descriptors = canonicalize(DESCRIPTORS).ok()?;
    let mut path = path.to_owned();
    for _ in 0..LINKS {
        let folder = folder_of(&path);
        if canonicalize(folder).is_ok_and(|folder| folder == descriptors) {
            return path.file_name().map(OsStr::to_owned).map(PathBuf::from);
        }
        path = folder.join(path.read_link().ok()?);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustix::fs::{CWD, FileType, Mode, mknodat};
    use std::fs;
    use std::io::Write;
    use std::os::unix::fs::symlink;

    #[test]
    fn pipes_devices_and_descriptors_are_told_from_files() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("file"), "old").unwrap();
        mknodat(CWD, at("pipe"), FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
        symlink(at("pipe"), at("to-pipe")).unwrap();
        symlink("/dev/stdout", at("to-stdout")).unwrap();
        symlink("nowhere", at("dangling")).unwrap();
        for path in ["-", "/dev/null", "/dev/stdout", "/dev/fd/0", "/proc/self/fd/1"] {
            assert!(is_stream(Path::new(path)), "{path}");
        }
        assert!(is_stream(&at("pipe")) && is_stream(&at("to-pipe")) && is_stream(&at("to-stdout")));
        for path in [at("file"), at("missing"), at("dangling"), at("-"), folder.path().to_owned()] {
            assert!(!is_stream(&path), "{}", path.display());
        }
        assert_eq!(descriptor(&at("to-stdout")), Some("1".into()));
    }

    #[test]
    fn what_comes_through_a_pipe_is_bounded_text() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        mknodat(CWD, &pipe, FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
        let through = |bytes: &[u8]| {
            let (bytes, writer) = (bytes.to_vec(), pipe.clone());
            let writer = std::thread::spawn(move || open(&writer).and_then(|mut end| end.write_all(&bytes)));
            let read = read_text(&pipe, 100).map(|(_, text)| text);
            // If the text is larger than the limit, the writer may find nobody at the other end.
            let _ = writer.join().unwrap();
            read
        };
        assert_eq!(through("héllo".as_bytes()).unwrap(), "héllo");
        assert!(through(b"ab\xff").unwrap_err().to_string().ends_with("is not UTF-8 text (from byte 2)"));
        let error = through(&[b' '; 101]).unwrap_err().to_string();
        assert!(error.ends_with("has more than the 100 bytes that are read"), "{error}");
    }
}
