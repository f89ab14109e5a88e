//! The spec of a sweep from the disk, and the canonical form by which results are recognised.

use crate::mend::mend;
use crate::store::file::{self, FileError};
use crate::store::hash::{hex, sha256};
use crate::store::{Store, atomic, stream};
use pulloff_engine::gap::Shape;
use pulloff_engine::preset::data::FILE;
use pulloff_engine::preset::{Preset, write};
use pulloff_engine::sweep::SpecError;
use pulloff_engine::sweep::spec::{Design, Spec};
use sha2::{Digest, Sha256};
use std::cell::RefCell;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The keys that name files of data.
const FILES: [&str; 2] = ["gap.file", FILE];

/// Why a spec cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Spec(#[from] SpecError),
}

mend!(LoadError, as 0 of File, always Spec);

/// A spec from a file, and what else was read for it.
#[derive(Debug)]
pub struct LoadedSpec {
    pub spec: Spec,
    /// The file of the preset; `None` for one that comes with the program.
    pub preset: Option<PathBuf>,
}

/// Reads the spec in a file. Its preset is a name in `store`, or a path relative to the folder of the spec, or to the
/// current folder where the spec comes through a pipe. `changes` are applied to the preset after those of the spec.
pub fn load(store: &Store, path: &Path, changes: &[String]) -> Result<LoadedSpec, LoadError> {
    let (name, text) = stream::read_given(path, file::LARGEST)?;
    let folder = if stream::is_stream(path) { Path::new(".") } else { atomic::folder_of(path) };
    Ok(read_changed(store, folder, &name, &text, changes)?)
}

/// Reads a spec from text that messages call `name`; the path of its preset is relative to `folder`.
pub fn read(store: &Store, folder: &Path, name: &str, text: &str) -> Result<Spec, SpecError> {
    read_changed(store, folder, name, text, &[]).map(|loaded| loaded.spec)
}

fn read_changed(
    store: &Store,
    folder: &Path,
    name: &str,
    text: &str,
    changes: &[String],
) -> Result<LoadedSpec, SpecError> {
    let file = RefCell::new(None);
    let preset = |name: &str, set: &[&str]| {
        let is_path = name.contains('/') || Path::new(name).extension().is_some_and(|end| end == "toml");
        let source = if is_path {
            store.resolve(folder.join(name.strip_prefix("./").unwrap_or(name)))
        } else {
            store.resolve(name)
        };
        let source = source.map_err(|error| error.to_string())?;
        file.replace(source.path().map(Path::to_path_buf));
        let preset = store.load(&source, set).map_err(|error| error.to_string())?.preset;
        if changes.is_empty() {
            return Ok(preset);
        }
        let all: Vec<&str> = set.iter().copied().chain(changes.iter().map(String::as_str)).collect();
        // Faults without the changes were reported above.
        let changed = store.load(&source, &all).map_err(|error| format!("--set: {error}"))?;
        Ok(changed.preset)
    };
    let spec = Spec::read(&preset, name, text)?;
    Ok(LoadedSpec { spec, preset: file.into_inner() })
}

/// Everything that determines the results, in one form: two specs that differ in it are different sweeps.
pub fn canonical(spec: &Spec) -> String {
    let mut text = format!("[sweep]\nprogram_version = \"{}\"\n", env!("CARGO_PKG_VERSION"));
    // Writing to a String cannot fail.
    let _ = match spec.design {
        Design::Grid => writeln!(text, "combine = \"grid\""),
        Design::Pairs => writeln!(text, "combine = \"pairs\""),
        Design::Ensemble { members, seed, in_pairs } => {
            let combine = if in_pairs { "pairs" } else { "grid" };
            writeln!(text, "combine = \"{combine}\"\nensemble = {{ members = {members}, seed = {seed} }}")
        }
        Design::Random { draws, seed } => writeln!(text, "random = {{ draws = {draws}, seed = {seed} }}"),
    };
    let names: Vec<String> = spec.columns.iter().map(|column| format!("\"{}\"", column.name())).collect();
    let _ = writeln!(text, "quantities = [{}]", names.join(", "));
    // The title does not affect the numbers.
    let untitled = Preset { title: String::new(), ..spec.preset.clone() };
    let _ = writeln!(text, "preset = {}", toml::Value::String(write(&untitled)));
    let data: Vec<String> = data(spec).iter().map(|digest| format!("\"{digest}\"")).collect();
    if !data.is_empty() {
        let _ = writeln!(text, "data = [{}]", data.join(", "));
    }
    for axis in &spec.axes {
        let _ = writeln!(text, "\n[[sweep.axis]]\nkey = \"{}\"\n{}", axis.key, axis.canonical());
    }
    text
}

/// The hash of the canonical form.
pub fn identity(spec: &Spec) -> String {
    sha256(canonical(spec).as_bytes())
}

/// Hashes of the measured profiles and curves that the spec reads, that of the preset first, because file names say
/// nothing about content.
fn data(spec: &Spec) -> Vec<String> {
    presets(spec).flat_map(|preset| digests(&preset)).collect()
}

/// The preset, and the preset with each data file that an axis names.
pub fn presets(spec: &Spec) -> impl Iterator<Item = Preset> {
    let named = spec.axes.iter().filter(|axis| FILES.contains(&&*axis.key)).flat_map(|axis| {
        let preset = |value| {
            let mut preset = spec.preset.clone();
            preset.set(&axis.key, value).ok().map(|()| preset)
        };
        (0..axis.count().unwrap_or(0)).filter_map(|at| axis.value(at)).filter_map(preset).collect::<Vec<_>>()
    });
    std::iter::once(spec.preset.clone()).chain(named)
}

/// Hashes of the rows of a measured profile and of the file of a measured curve.
fn digests(preset: &Preset) -> Vec<String> {
    let mut digests = Vec::new();
    if let Shape::Profile(measured) = &preset.gap {
        let mut hash = Sha256::new();
        for x in measured.rows().radii.iter().chain(&measured.rows().gaps) {
            hash.update(x.to_bits().to_le_bytes());
        }
        digests.push(hex(hash.finalize().as_slice()));
    }
    digests.extend(preset.data.source.iter().map(|source| sha256(&source.bytes)));
    digests
}
