//! The files of profiles: the engine does not read the disk, and gets the rows that a preset names from here.

use super::file::{FileError, read_bytes};
use crate::mend::mend;
use pulloff_engine::gap::shapes::ProfileRows;
use pulloff_engine::measured::PointsFile;
use pulloff_engine::preset::measured::{SHIPPED_DATA, rows, words};
use pulloff_engine::preset::profile::{LARGEST, ProfileColumns, TextError, parse};
use pulloff_engine::preset::read::{self, ReadError};
use pulloff_engine::preset::shipped::curve;
use pulloff_engine::preset::{Files, Preset};
use pulloff_engine::text::{is_unsafe, quote, show_path};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The sources of the presets' files: the program's own data, and the disk.
pub const FILES: Files = Files { rows: load, points };

/// Why a file yields no profile. Names and paths in the error are safe to show.
#[derive(Debug, Error)]
pub enum ProfileError {
    #[error(transparent)]
    File(#[from] FileError),
    #[error("{path}: {cause}")]
    Text { path: String, cause: TextError },
}

/// Why there is no file with a measured curve. Names and paths in the error are safe to show.
#[derive(Debug, Error)]
pub enum PointsFileError {
    #[error(transparent)]
    File(#[from] FileError),
    /// It is not among those that come with the program; the reason in words.
    #[error("{0}")]
    Shipped(String),
}

mend!(PointsFileError, as 0 of File, always Shipped);

/// Reads the profile in the file `path`.
pub fn read_profile(path: &Path) -> Result<ProfileColumns, ProfileError> {
    let (bytes, _) = read_bytes(path, LARGEST)?;
    parse(&bytes).map_err(|cause| ProfileError::Text { path: show_path(path), cause })
}

/// The file `path` with a measured curve, or the shipped one of that name; it is not parsed yet.
pub fn read_points(path: &Path) -> Result<PointsFile, PointsFileError> {
    let bytes = match path.to_str().and_then(curve) {
        Some(text) => text.map_err(PointsFileError::Shipped)?.as_bytes().to_vec(),
        None => read_bytes(path, LARGEST)?.0,
    };
    Ok(PointsFile::new(path.to_string_lossy().into_owned(), None, bytes.into()))
}

/// The bytes of the measured curve `name`, relative to `folder` or to the current folder.
/// Errors: Why there are none, in words that are safe to show.
fn points(folder: Option<&Path>, name: &str) -> Result<Vec<u8>, String> {
    if name.starts_with(SHIPPED_DATA) {
        return (Files::SHIPPED.points)(folder, name);
    }
    Ok(read_bytes(&place(folder, name)?, LARGEST).map_err(|error| words(&error))?.0)
}

/// The path of the file `name`.
fn place(folder: Option<&Path>, name: &str) -> Result<PathBuf, String> {
    if name.is_empty() || name.chars().any(is_unsafe) {
        return Err(format!("\"{}\" is not a file name", quote(name)));
    }
    Ok(folder.map_or_else(|| PathBuf::from(name), |folder| folder.join(name)))
}

/// Reads the file `name`, relative to `folder` or to the current folder; a name that begins with [`SHIPPED_DATA`] means
/// data that come with the program.
/// Errors: Why there are no rows, in words that are safe to show.
pub fn load(folder: Option<&Path>, name: &str) -> Result<ProfileRows, String> {
    if name.starts_with(SHIPPED_DATA) {
        return (Files::SHIPPED.rows)(folder, name);
    }
    let columns = read_profile(&place(folder, name)?).map_err(|error| words(&error))?;
    rows(folder, name, columns)
}

/// Reads a preset whose files are relative to the current folder; `name` is what messages call the text.
pub fn read(name: &str, text: &str) -> Result<Preset, ReadError> {
    read_with(name, text, &[] as &[&str])
}

/// Reads a preset and applies `KEY=VALUE` assignments to it, in order.
pub fn read_with<S: AsRef<str>>(name: &str, text: &str, assignments: &[S]) -> Result<Preset, ReadError> {
    read_in(None, name, text, assignments)
}

/// Reads a preset whose files are relative to `folder`; files named in assignments are relative to the current folder.
pub fn read_in<S: AsRef<str>>(
    folder: Option<&Path>,
    name: &str,
    text: &str,
    assignments: &[S],
) -> Result<Preset, ReadError> {
    read::read_in(FILES, folder, name, text, assignments)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulloff_engine::preset::write;

    #[test]
    fn a_profile_is_read_from_beside_its_preset() {
        let folder = tempfile::tempdir().unwrap();
        let rows: Vec<String> =
            (0..20).map(f64::from).map(|i| format!("{i}, {}\n", i * i / 1000.0)).collect();
        let rows = rows.concat();
        std::fs::write(folder.path().join("scan.csv"), format!("r, h\n{rows}")).unwrap();
        std::fs::write(folder.path().join("units.csv"), format!("# mine\nr [um], h [nm]\n{rows}")).unwrap();
        let text = "[material]\neffective_modulus=1\nwork_of_adhesion=0.1\n[gap]\nshape='profile'\nfile='scan.csv'\n                    [path]\nstart_contact_radius=5\n";
        let read =
            |text: &str, assignments: &[&str]| read_in(Some(folder.path()), "p.toml", text, assignments);
        let preset = read(text, &[]).unwrap();
        // h = r²/1000.
        assert!((preset.gap.radius_of_curvature().unwrap() - 500.0).abs() < 1e-6);
        assert_eq!(preset.get("gap.smoothing"), Some("none".into()));
        assert_eq!(read(text, &["gap.smoothing=4"]).unwrap().get("gap.smoothing"), Some(4.0.into()));
        for (old, new, expected) in [
            ("scan.csv", "none.csv", "p.toml:6: gap.file: "),
            ("scan.csv", ".", "p.toml:6: gap.file: "),
            ("scan.csv", "shipped:x", "p.toml:6: gap.file: \"shipped:x\" does not come with the program"),
            (
                "radius=5",
                "radius=19",
                "p.toml:8: path.start_contact_radius = 19.0 is out of range: it must be less than",
            ),
            ("[path]\nstart_contact_radius=5\n", "", "p.toml: path.start_contact_radius = 250.0"),
        ] {
            let message = read(&text.replace(old, new), &[]).unwrap_err().to_string();
            assert!(message.starts_with(expected), "{message}");
        }
        // In reduced units the unit of the radii is that of all lengths, and a message says so.
        let reduced = read(&text.replace("scan.csv", "units.csv"), &[]).unwrap();
        assert!((reduced.gap.radius_of_curvature().unwrap() - 5e5).abs() < 1.0);
        let notes = reduced.gap.notes(&reduced.units);
        assert!(
            notes.len() == 1 && notes[0].starts_with("units.csv: names um as the unit of its radii"),
            "{notes:?}"
        );
        assert!(preset.gap.notes(&preset.units).is_empty());
        let si = "units='SI'\n".to_owned() + &text.replace("scan.csv", "units.csv").replace("=5", "='5 um'");
        let si = read(&si, &[]).unwrap();
        assert!(
            (si.gap.radius_of_curvature().unwrap() - 0.5).abs() < 1e-9,
            "{:?}",
            si.gap.radius_of_curvature()
        );
        let message = read(text, &["gap.smoothing=20"]).unwrap_err().to_string();
        assert!(
            message.contains("gap.smoothing: ") && message.contains("at most 19, the last radius"),
            "{message}"
        );
        // A copy elsewhere still finds its rows.
        let other = tempfile::tempdir().unwrap();
        let moved = preset.placed_in(other.path());
        let back = read_in(Some(other.path()), "q.toml", &write(&moved), &[] as &[&str]).unwrap();
        assert_eq!(back.gap.radius_of_curvature(), preset.gap.radius_of_curvature());
        assert_eq!(preset.placed_in(folder.path()), preset);
    }

    #[test]
    fn files_are_regular_and_named_in_errors() {
        let folder = tempfile::tempdir().unwrap();
        let rows: Vec<_> = (0..20).map(|i| format!("{i},{}", i * i)).collect();
        let rows = rows.join("\n");
        let path = folder.path().join("profile.csv");
        std::fs::write(&path, &rows).unwrap();
        assert_eq!(read_profile(&path).unwrap(), parse(rows.as_bytes()).unwrap());
        std::fs::write(&path, "0,0\n").unwrap();
        assert!(
            read_profile(&path)
                .unwrap_err()
                .to_string()
                .ends_with("profile.csv: has 1 rows, and a profile has 8 to 1000000")
        );
        assert!(
            read_profile(folder.path()).unwrap_err().to_string().ends_with("is a folder, not a regular file")
        );
    }
}
