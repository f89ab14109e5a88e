//! The files of a folder to choose from: its subfolders, and the files whose extensions are used for tables of numbers.
//! Also the columns of a measured curve whose header does not say what they are.

use super::command::Assignment;
use crate::store::FILES;
use pulloff_engine::measured::{ColumnSpec, CurveReadError, SeenColumn, columns, parse};
use pulloff_engine::preset::{Preset, data};
use pulloff_engine::text::{is_unsafe, show_name, show_path};
use std::fs;
use std::path::{Path, PathBuf};

/// The extensions of files that may hold a table.
pub const ENDINGS: [&str; 8] = ["csv", "txt", "dat", "tab", "tsv", "asc", "lvm", "itx"];
/// At most this many entries of a folder are read.
const MOST: usize = 10_000;

/// What there is to choose from in a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Folder {
    /// Its path, absolute.
    pub path: PathBuf,
    /// Whether file names in the preset are relative to this folder.
    pub is_own: bool,
    /// The names of the folders in it, sorted.
    pub folders: Vec<String>,
    /// The files in it that may hold a profile, sorted.
    pub files: Vec<String>,
}

/// A file of a measured curve whose columns the person must name.
#[derive(Debug, Clone, PartialEq)]
pub struct Foreign {
    /// The values that were requested, the file's name among them.
    pub assignments: Vec<Assignment>,
    /// Its name, safe to show.
    pub shown: String,
    /// Its columns.
    pub seen: Vec<SeenColumn>,
}

impl Foreign {
    /// The file that `assignments` give to `preset`, if only its columns are in the way.
    pub fn of(preset: &Preset, assignments: &[Assignment]) -> Option<Self> {
        let value = |key: &str| assignments.iter().rfind(|(of, _)| of == key).map(|(_, text)| &**text);
        let name = value(data::FILE)?;
        let folder = preset.data.source.as_ref().and_then(|source| source.folder.as_deref());
        let bytes = (FILES.points)(folder, name).ok()?;
        let said = value(data::COLUMNS).unwrap_or(&preset.data.columns);
        match parse(&bytes, &ColumnSpec::parse(said).ok()?) {
            Err(
                CurveReadError::Unknown { .. }
                | CurveReadError::Lacks { .. }
                | CurveReadError::NoColumn { .. }
                | CurveReadError::Signal { .. },
            ) => {}
            _ => return None,
        }
        let seen = columns(&bytes).ok().filter(|seen| seen.len() > 1)?;
        let shown = Path::new(name).file_name().map(|name| show_name(&name.to_string_lossy()))?;
        Some(Self { assignments: assignments.to_vec(), shown, seen })
    }
}

impl Folder {
    /// The name a preset uses for the file `name` of this folder.
    pub fn name_of(&self, name: &str) -> String {
        if self.is_own { name.to_owned() } else { self.path.join(name).to_string_lossy().into_owned() }
    }
}

/// Lists `folder`, or without one `own`, to which names are relative; without either, the current folder. Leaves out
/// hidden files and names that cannot be shown.
/// Errors: Why the folder cannot be listed, in words.
pub fn list(folder: Option<&Path>, own: Option<&Path>) -> Result<Folder, String> {
    let own = own.filter(|own| !own.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let shown =
        |path: &Path, cause: std::io::Error| format!("{}: cannot be listed: {cause}", show_path(path));
    let asked = folder.unwrap_or(own);
    let path = fs::canonicalize(asked).map_err(|cause| shown(asked, cause))?;
    if path.to_str().is_none_or(|path| path.chars().any(is_unsafe)) {
        return Err(format!("{}: its name cannot be shown", show_path(&path)));
    }
    let is_own = fs::canonicalize(own).is_ok_and(|own| own == path);
    let entries = fs::read_dir(&path).map_err(|cause| shown(&path, cause))?;
    let (mut folders, mut files) = (Vec::new(), Vec::new());
    for entry in entries.filter_map(Result::ok).take(MOST) {
        let Ok(name) = entry.file_name().into_string() else { continue };
        if name.starts_with('.') || name.chars().any(is_unsafe) {
            continue;
        }
        // Follows links.
        let Ok(metadata) = fs::metadata(entry.path()) else { continue };
        if metadata.is_dir() {
            folders.push(name);
        } else if metadata.is_file() && is_table(&name) {
            files.push(name);
        }
    }
    folders.sort();
    files.sort();
    Ok(Folder { path, is_own, folders, files })
}

fn is_table(name: &str) -> bool {
    let ending = Path::new(name).extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| ENDINGS.iter().any(|known| known.eq_ignore_ascii_case(ending)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn tables_and_folders_are_listed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for name in ["b.csv", "a.TXT", "c.dat", "notes.md", ".hidden.csv", "bad\u{1b}.csv", "csv"] {
            fs::write(at(name), "").unwrap();
        }
        fs::create_dir(at("sub")).unwrap();
        fs::create_dir(at("folder.csv")).unwrap();
        symlink(at("b.csv"), at("link.csv")).unwrap();
        symlink("nowhere", at("dangling.csv")).unwrap();
        let own = list(None, Some(folder.path())).unwrap();
        assert_eq!(own.files, ["a.TXT", "b.csv", "c.dat", "link.csv"]);
        assert_eq!(own.folders, ["folder.csv", "sub"]);
        assert_eq!(own.name_of("b.csv"), "b.csv");
        let below = list(Some(&at("sub")), Some(folder.path())).unwrap();
        assert!(!below.is_own && below.files.is_empty());
        assert_eq!(below.path.parent(), Some(&*own.path));
        assert!(Path::new(&below.name_of("x.csv")).is_absolute());
        let error = list(Some(&at("gone")), None).unwrap_err();
        assert!(error.contains("gone: cannot be listed: No such file"), "{error}");
    }
}
