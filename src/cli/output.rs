//! Where a result goes: a file, whole or not at all, or standard output.

use super::Failure;
use crate::preset::text::sanitize;
use crate::preset::{Overwrite, write_atomically};
use std::io::{self, ErrorKind, Write};
use std::path::Path;

/// Writes `text` to `file`, or to standard output when there is none or it is `-`.
pub fn write(text: &str, file: Option<&Path>) -> Result<(), Failure> {
    if let Some(path) = file.filter(|path| *path != Path::new("-")) {
        write_atomically(path, text.as_bytes(), Overwrite::Always)?;
        return Ok(());
    }
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|error| match error.kind() {
        ErrorKind::BrokenPipe => Failure::Closed,
        _ => Failure::Output(error),
    })
}

/// A path as it can be shown.
pub fn shown(path: &Path) -> String {
    sanitize(&path.to_string_lossy(), 200)
}
