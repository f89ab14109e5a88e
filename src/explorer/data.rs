//! The profiles of a folder, to choose from: files that end as tables of numbers do, and the folders beside them.

use pulloff_engine::text::{is_unsafe, show_path};
use std::fs;
use std::path::{Path, PathBuf};

/// The endings of files that may hold a profile.
pub const ENDINGS: [&str; 3] = ["csv", "txt", "dat"];
/// At most so many entries of a folder are read.
const MOST: usize = 10_000;

/// What there is to choose from in a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Folder {
    /// Its path, absolute.
    pub path: PathBuf,
    /// Whether file names in the preset are relative to this folder.
    pub is_own: bool,
    /// The folders in it by their names, sorted.
    pub folders: Vec<String>,
    /// The files in it that may hold a profile, sorted.
    pub files: Vec<String>,
}

impl Folder {
    /// How a preset calls the file `name` of this folder.
    #[must_use]
    pub fn name_of(&self, name: &str) -> String {
        if self.is_own { name.to_owned() } else { self.path.join(name).to_string_lossy().into_owned() }
    }
}

/// Lists `folder`, or without one `own`, to which names are relative; without that they are relative to the current
/// folder. Hidden files are left out, and names that cannot be shown.
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
