//! Copies the data of a profile and a measured curve beside a preset, so that they can be passed on together.

use super::atomic::{Overwrite, WriteError, write_atomically};
use super::data::load;
use super::file::{FileError, read_bytes};
use crate::mend::mend;
use pulloff_engine::gap::Shape;
use pulloff_engine::gap::shapes::MeasuredGap;
use pulloff_engine::preset::measured::SHIPPED_DATA;
use pulloff_engine::preset::model::Preset;
use pulloff_engine::preset::profile::LARGEST;
use pulloff_engine::text::show_path;
use std::path::Path;
use std::sync::Arc;
use thiserror::Error;

/// Why the data cannot be copied.
#[derive(Debug, Error)]
pub enum DataError {
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Write(#[from] WriteError),
    /// They are gone, or differ from those in the preset; the reason in words.
    #[error("{0}")]
    Other(String),
}

mend!(DataError, as 0 of File | Write, always Other);

impl From<String> for DataError {
    fn from(words: String) -> Self {
        Self::Other(words)
    }
}

/// `preset` with its data in `folder`, where they are copied under their own names. Data already there are kept if they
/// are the same; another file is never replaced. Presets without a file of their own are unchanged.
/// Errors: The data are gone, differ from those in the preset, or another file has their name.
pub fn copy_beside(folder: &Path, preset: &Preset) -> Result<Preset, DataError> {
    let mut copy = preset.clone();
    if let Shape::Profile(measured) = &preset.gap
        && !measured.rows().name.starts_with(SHIPPED_DATA)
    {
        let rows = measured.rows();
        let from = rows.path();
        let now = Arc::new(load(rows.folder.as_deref(), &rows.name)?).held_in(&preset.units);
        if (&now.radii, &now.gaps) != (&rows.radii, &rows.gaps) {
            return Err(others(&from));
        }
        let name = copied(folder, &from, &read_bytes(&from, LARGEST)?.0)?;
        let copied = Arc::new(load(Some(folder), &name)?).held_in(&preset.units);
        let measured = MeasuredGap::new(copied, measured.smoothing()).map_err(|error| error.to_string())?;
        copy.gap = Shape::Profile(Arc::new(measured));
    }
    if let Some(source) = preset.data.source.as_ref().filter(|source| !source.name.starts_with(SHIPPED_DATA))
    {
        let from = source.path();
        if *read_bytes(&from, LARGEST)?.0 != *source.bytes {
            return Err(others(&from));
        }
        let name = copied(folder, &from, &source.bytes)?;
        copy.data.source = Some(Arc::new(source.named(name, Some(folder.to_path_buf()))));
    }
    Ok(copy)
}

fn others(path: &Path) -> DataError {
    format!("{}: holds other rows than those read; choose the file again first", show_path(path)).into()
}

/// Copies `bytes`, the content of `from`, into `folder` under the name of `from`, which is returned.
fn copied(folder: &Path, from: &Path, bytes: &[u8]) -> Result<String, DataError> {
    let Some(name) = from.file_name().and_then(|name| name.to_str()) else {
        return Err(format!("{}: is not a file name", show_path(from)).into());
    };
    let to = folder.join(name);
    match write_atomically(&to, bytes, Overwrite::Never) {
        Ok(_) => {}
        Err(WriteError::Exists { .. }) if read_bytes(&to, LARGEST).is_ok_and(|(there, _)| there == bytes) => {
        }
        Err(error) => return Err(error.into()),
    }
    Ok(name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::Store;
    use std::fs;

    #[test]
    fn data_are_copied_once_and_replace_nothing() {
        let home = tempfile::tempdir().unwrap();
        let at = |name: &str| home.path().join(name);
        fs::create_dir(at("data")).unwrap();
        let radii = (0..100).map(|i| f64::from(4 * i));
        let rows = radii.map(|r| format!("{r} {}\n", r * r / 2000.0)).collect::<Vec<_>>().concat();
        fs::write(at("data/scan.dat"), &rows).unwrap();
        let store = Store::at(at("presets"), &[]);
        let source = store.resolve("profile").unwrap();
        let shipped = store.load(&source, &[] as &[&str]).unwrap().preset;
        let mut preset = shipped.clone();
        preset.set("gap.file", at("data/scan.dat").to_str().unwrap().into()).unwrap();
        let (source, _, saved) = store.save_with_data("mine", &preset, None, Overwrite::Never).unwrap();
        assert_eq!(fs::read_to_string(at("presets/scan.dat")).unwrap(), rows);
        assert_eq!(saved.get("gap.file").unwrap().to_string(), "scan.dat");
        // It is the same preset without the data that it came from.
        fs::rename(at("data"), at("gone")).unwrap();
        assert_eq!(store.load(&source, &[] as &[&str]).unwrap().preset, saved);
        let error = store.save_with_data("other", &preset, None, Overwrite::Never).unwrap_err().to_string();
        assert!(error.contains("cannot read"), "{error}");
        // The same data may already be there; other data may not, and they must not have changed meanwhile.
        fs::rename(at("gone"), at("data")).unwrap();
        store.save_with_data("other", &preset, None, Overwrite::Never).unwrap();
        let taken = store.save_with_data("mine", &preset, None, Overwrite::Never).unwrap_err().to_string();
        assert!(taken.contains("exists"), "{taken}");
        fs::write(at("presets/scan.dat"), "mine").unwrap();
        let error = store.save_with_data("third", &preset, None, Overwrite::Always).unwrap_err().to_string();
        assert!(error.contains("scan.dat"), "{error}");
        assert_eq!(fs::read_to_string(at("presets/scan.dat")).unwrap(), "mine");
        assert!(!at("presets/third.toml").exists());
        fs::write(at("data/scan.dat"), rows.replace("8 0.032", "8 0.033")).unwrap();
        let error = store.save_with_data("third", &preset, None, Overwrite::Never).unwrap_err().to_string();
        assert!(error.contains("other rows"), "{error}");
        // Data that come with the program need no copy.
        let (_, _, saved) = store.save_with_data("fourth", &shipped, None, Overwrite::Never).unwrap();
        assert_eq!(saved, shipped);
    }

    #[test]
    fn data_in_micrometres_are_the_same_beside_a_preset_in_si() {
        let home = tempfile::tempdir().unwrap();
        let at = |name: &str| home.path().join(name);
        let rows = (0..100).map(f64::from).map(|r| format!("{r} {}\n", r * r / 2000.0));
        let rows = rows.collect::<Vec<_>>().concat();
        fs::write(at("scan.dat"), format!("r [um] h [um]\n{rows}")).unwrap();
        fs::write(
            at("si.toml"),
            "units = \"SI\"\n[material]\neffective_modulus = \"1 MPa\"\nwork_of_adhesion = 0.03\n[gap]\n\
             shape = \"profile\"\nfile = \"scan.dat\"\n[path]\nstart_contact_radius = \"50 um\"\n",
        )
        .unwrap();
        let store = Store::at(at("presets"), &[]);
        let source = store.resolve(at("si.toml").as_os_str()).unwrap();
        let preset = store.load(&source, &[] as &[&str]).unwrap().preset;
        let (source, _, saved) = store.save_with_data("mine", &preset, None, Overwrite::Never).unwrap();
        let radius = |preset: &Preset| preset.gap.radius_of_curvature().unwrap();
        assert!((radius(&preset) / 1e-3 - 1.0).abs() < 1e-2, "{}", radius(&preset));
        assert_eq!(radius(&saved).to_bits(), radius(&preset).to_bits());
        assert_eq!(store.load(&source, &[] as &[&str]).unwrap().preset, saved);
    }
}
