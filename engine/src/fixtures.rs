//! The presets that come with the program, for tests.

use crate::gap::shapes::ProfileRows;
use crate::preset::measured::rows;
use crate::preset::profile::parse;
use crate::preset::read::read_in;
use crate::preset::{Files, Preset};
use std::path::{Path, PathBuf};

/// The text of a preset that comes with the program.
pub fn text(name: &str) -> String {
    std::fs::read_to_string(format!("{}/../presets/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// A preset that comes with the program.
pub fn preset(name: &str) -> Preset {
    read(name, &text(name)).unwrap()
}

/// Files as the program supplies them: its own data, and the disk.
pub const FILES: Files = Files { rows: load, points };

/// The bytes of a file.
fn points(folder: Option<&Path>, name: &str) -> Result<Vec<u8>, String> {
    let path = place(folder, name);
    std::fs::read(&path).map_err(|error| format!("{}: cannot read: {error}", path.display()))
}

fn place(folder: Option<&Path>, name: &str) -> PathBuf {
    match name.strip_prefix("shipped:") {
        Some(data) => Path::new(env!("CARGO_MANIFEST_DIR")).join("../presets/data").join(data),
        None => folder.map_or_else(|| name.into(), |folder| folder.join(name)),
    }
}

/// The rows of a file.
pub fn load(folder: Option<&Path>, name: &str) -> Result<ProfileRows, String> {
    rows(folder, name, parse(&points(folder, name)?).map_err(|error| error.to_string())?)
}

/// A preset whose text may name files.
pub fn read(name: &str, text: &str) -> Result<Preset, crate::preset::ReadError> {
    read_in(FILES, None, name, text, &[] as &[&str])
}
