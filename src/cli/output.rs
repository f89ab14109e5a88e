//! Where a result goes: a file, whole or not at all, or straight into standard output, a pipe or a device.

use super::Failure;
use crate::store::atomic::explained;
use crate::store::{Loaded, Overwrite, Source, WriteError, stream, write_atomically};
use clap::ValueEnum;
use pulloff_engine::gap::Shape;
use pulloff_engine::text::sanitize;
use std::fs;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Writes `text` to `file`, or to standard output when there is none or it is `-`.
pub fn write(text: &str, file: Option<&Path>) -> Result<(), Failure> {
    write_bytes(text.as_bytes(), file)
}

/// The same for what need not be text.
pub fn write_bytes(bytes: &[u8], file: Option<&Path>) -> Result<(), Failure> {
    let path = file.unwrap_or(Path::new(stream::STANDARD));
    if !stream::is_stream(path) {
        write_atomically(path, bytes, Overwrite::Always)?;
        return Ok(());
    }
    let written = stream::open(path).and_then(|mut end| end.write_all(bytes));
    written.map_err(|cause| match cause.kind() {
        ErrorKind::BrokenPipe => Failure::Closed,
        _ => WriteError::Io { path: stream::shown(path), doing: "write", cause: explained(cause) }.into(),
    })
}

/// The format to write: the one asked for, the one that the ending of `file` names, or the usual one. The ending and what
/// is asked for must not contradict each other.
pub fn format<F: ValueEnum + PartialEq>(
    asked: Option<F>,
    file: Option<&Path>,
    usual: F,
) -> Result<F, Failure> {
    let name = |format: &F| {
        let value = format.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    };
    let ending = file.and_then(ending);
    let named = F::value_variants().iter().find(|format| Some(name(format)) == ending);
    match (asked, named, file) {
        (Some(asked), Some(named), Some(file)) if asked != *named => Err(Failure::Usage(format!(
            "-o {}: its ending says {}, --format says {}",
            shown(file),
            name(named),
            name(&asked)
        ))),
        (Some(asked), ..) => Ok(asked),
        (None, Some(named), _) => Ok(named.clone()),
        (None, None, _) => Ok(usual),
    }
}

/// Refuses a file of JSON from a command that writes nothing but CSV.
pub fn csv_only(file: &Path) -> Result<(), Failure> {
    match ending(file) {
        Some(ending) if ending == "json" => {
            Err(Failure::Usage(format!("-o {}: the results of a sweep are CSV", shown(file))))
        }
        _ => Ok(()),
    }
}

fn ending(file: &Path) -> Option<String> {
    file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase())
}

/// Refuses a file, given or implied by `option`, that the result is computed from: a preset must not become its own
/// result.
pub fn spares(file: Option<&Path>, option: &str, loaded: &Loaded) -> Result<(), Failure> {
    let Some(Ok(file)) = file.map(fs::canonicalize) else { return Ok(()) };
    let preset = match &loaded.source {
        Source::User { path, .. } | Source::File(path) => Some(path.clone()),
        Source::Shipped(_) | Source::Piped { .. } => None,
    };
    let data = match &loaded.preset.gap {
        Shape::Profile(measured) => Some(measured.rows().path()),
        _ => None,
    };
    let curve = loaded.preset.data.source.as_ref().map(|source| source.path());
    for (read, what) in [(preset, "the preset"), (data, "the profile"), (curve, "the measured curve")] {
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
