//! The files to fit: those with measured curves, not those that a fit wrote.

use super::table;
use crate::cli::Failure;
use crate::cli::console::Console;
use crate::store::file::first_line;
use pulloff_engine::report::residuals;
use pulloff_engine::text::show_path;
use std::path::{Path, PathBuf};

/// What an earlier fit wrote into the file `path`, judged by its first line; `None` for anything else.
fn written_by_a_fit(path: &Path) -> Option<&'static str> {
    // Anything but a regular file can be read only once.
    let line = path.is_file().then(|| first_line(path).ok()).flatten()?;
    if table::is_header(&line) {
        Some("a table of fits")
    } else if line.trim_end() == residuals::HEADER {
        Some("the residuals of a fit")
    } else {
        None
    }
}

/// The measured curves among `files`. A pattern such as `*.csv` also matches what earlier fits wrote beside them; these
/// files are left out, with a note.
pub(super) fn measured(files: Vec<PathBuf>, console: &Console) -> Result<Vec<PathBuf>, Failure> {
    let mut kept = Vec::new();
    let mut left_out = Vec::new();
    for path in files {
        match written_by_a_fit(&path) {
            Some(what) => left_out.push(format!("{}: is {what}, not a measured curve", show_path(&path))),
            None => kept.push(path),
        }
    }
    if kept.is_empty() && !left_out.is_empty() {
        return Err(Failure::Usage(left_out.join("\n")));
    }
    for text in &left_out {
        console.note(Some(&format!("{text}; it is left out")));
    }
    Ok(kept)
}
