//! Presets and profiles from the disk: regular files of bounded size, and the data that come with the package.

use pulloff_engine::gap::shapes::Rows;
use pulloff_engine::preset::Files;
use pulloff_engine::preset::measured::{SHIPPED_DATA, rows, words};
use pulloff_engine::preset::profile::{LARGEST, parse};
use pulloff_engine::text::{is_unsafe, quote, show_path};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// The files of presets.
pub const FILES: Files = Files { rows: profile, points };

/// The largest preset or spec, in bytes.
const LARGEST_TEXT: u64 = 1 << 20;

/// Reads a regular file of at most `most` bytes, or says why not.
fn bytes(path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", show_path(path));
    // Opening a pipe without a writer would wait for ever.
    if !std::fs::metadata(path).map_err(failed)?.is_file() {
        return Err(format!("{}: is not a regular file", show_path(path)));
    }
    let mut bytes = Vec::new();
    File::open(path).map_err(failed)?.take(most + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > most {
        return Err(format!("{}: has more than {most} bytes", show_path(path)));
    }
    Ok(bytes)
}

/// The text of a preset or a spec.
pub fn text(path: &Path) -> Result<String, String> {
    String::from_utf8(bytes(path, LARGEST_TEXT)?).map_err(|_| format!("{}: is not UTF-8", show_path(path)))
}

fn place(folder: Option<&Path>, name: &str) -> Result<PathBuf, String> {
    if name.is_empty() || name.chars().any(is_unsafe) {
        return Err(format!("\"{}\" is no name of a file", quote(name)));
    }
    Ok(folder.map_or_else(|| Path::new(name).to_path_buf(), |folder| folder.join(name)))
}

fn points(folder: Option<&Path>, name: &str) -> Result<Vec<u8>, String> {
    if name.starts_with(SHIPPED_DATA) {
        return (Files::SHIPPED.points)(folder, name);
    }
    bytes(&place(folder, name)?, LARGEST)
}

fn profile(folder: Option<&Path>, name: &str) -> Result<Rows, String> {
    if name.starts_with(SHIPPED_DATA) {
        return (Files::SHIPPED.rows)(folder, name);
    }
    let path = place(folder, name)?;
    let columns = parse(&bytes(&path, LARGEST)?);
    rows(folder, name, columns.map_err(|error| words(&format!("{}: {error}", show_path(&path))))?)
}
