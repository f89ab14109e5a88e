//! Where a result goes: a file, whole or not at all, or standard output.

use super::Failure;
use crate::contact::Shape;
use crate::preset::text::sanitize;
use crate::preset::{Loaded, Overwrite, Source, write_atomically};
use std::fs;
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

/// Refuses a file, given or implied by `option`, that the result is computed from: a preset must not become its own
/// result.
pub fn spares(file: Option<&Path>, option: &str, loaded: &Loaded) -> Result<(), Failure> {
    let Some(Ok(file)) = file.map(fs::canonicalize) else { return Ok(()) };
    let preset = match &loaded.source {
        Source::User { path, .. } | Source::File(path) => Some(path.clone()),
        Source::Shipped(_) => None,
    };
    let data = match &loaded.preset.gap {
        Shape::Profile(measured) => Some(measured.rows().path()),
        _ => None,
    };
    for (read, what) in [(preset, "the preset"), (data, "the profile")] {
        if read.and_then(|path| fs::canonicalize(path).ok()).is_some_and(|path| path == file) {
            return Err(Failure::Usage(format!(
                "{option} {}: is the file of {what} that is read; write to another",
                shown(&file)
            )));
        }
    }
    Ok(())
}

/// A path as it can be shown.
pub fn shown(path: &Path) -> String {
    sanitize(&path.to_string_lossy(), 200)
}
