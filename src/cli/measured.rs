//! What the commands that read measured curves share.

use super::{Failure, problem};
use crate::store::data::read_points;
use crate::store::stream;
use clap::{Args, ValueEnum};
use pulloff_engine::measured::ColumnSpec;
use pulloff_engine::preset::invalid::Invalid;
use pulloff_engine::preset::{Preset, Value, data};
use pulloff_engine::text::show_path;
use pulloff_engine::units::Quantity;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Gives the preset the measured curve in the file `path` (`None` keeps its own curve), the spring that the curve
/// states where the preset has none, and the values in `said`. All are set at once, because `said` does not describe
/// the previous curve.
pub(super) fn attach(
    preset: &mut Preset,
    path: Option<&Path>,
    said: &[(&'static str, Value)],
) -> Result<(), Failure> {
    let file = path.map(|path| Ok::<_, Failure>(Value::Points(Arc::new(read_points(path)?)))).transpose()?;
    let file = file.map(|points| (data::FILE, points));
    preset.set_all(file.into_iter().chain(said.iter().cloned())).map_err(|invalid| match invalid {
        Invalid::Made { key, cause } if said.iter().any(|(of, _)| *of == key) => {
            Failure::Usage(format!("{}: {cause}", option(&key)))
        }
        Invalid::Made { cause, .. } => Failure::Usage(cause),
        invalid => Failure::Usage(invalid.to_string()),
    })
}

/// What the user says about the columns and rows of a measured curve.
#[derive(Debug, Clone, Args)]
pub(super) struct ReadingArguments {
    /// What the columns are, by number or name, where the header does not say: approach=1,force=2 or position=Z [nm],force=F [nN]
    #[arg(long, value_name = "ROLE=COLUMN,...")]
    columns: Option<String>,
    /// Use only one branch of the curve
    #[arg(long, value_enum)]
    segment: Option<BranchChoice>,
    /// Which rows are out of contact, as a range of x with the sign and zero of the file: x=LO..HI, or none where all are in
    /// contact. A number without a unit is in base units
    #[arg(long, value_name = "x=LO..HI", allow_hyphen_values = true)]
    free_part: Option<String>,
    /// The direction of the columns, where the points do not show it: x=-,force=+ reverses the sign of x only
    #[arg(long, value_name = "x=-,force=+", allow_hyphen_values = true)]
    signs: Option<String>,
    /// Leave out this many rows at the start
    #[arg(long, value_name = "N")]
    skip: Option<u32>,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum BranchChoice {
    Approach,
    Retraction,
}

impl BranchChoice {
    /// The value of `data.segment`.
    fn word(self) -> &'static str {
        match self {
            Self::Approach => data::SEGMENTS[0],
            Self::Retraction => data::SEGMENTS[1],
        }
    }
}

impl ReadingArguments {
    /// What the options say, with the keys, if it can apply to any file.
    pub(super) fn said(&self) -> Result<Vec<(&'static str, Value)>, Failure> {
        if let Some(text) = &self.columns {
            ColumnSpec::parse(text).map_err(|error| Failure::Usage(format!("--columns: {error}")))?;
        }
        let texts = [
            (data::COLUMNS, self.columns.clone()),
            (data::SEGMENT, self.segment.map(|branch| branch.word().to_owned())),
            (data::FREE_PART, self.free_part.clone()),
            (data::SIGNS, self.signs.clone()),
        ];
        let texts = texts.into_iter().filter_map(|(key, text)| Some((key, Value::Text(text?))));
        let skip = self.skip.map(|skip| (data::SKIP, Value::Integer(skip.into())));
        Ok(texts.chain(skip).collect())
    }
}

/// The option that sets `key`, as messages name it.
fn option(key: &str) -> String {
    format!("--{}", key.trim_start_matches("data.").replace('_', "-"))
}

/// Parses the number given to `flag`, in SI or reduced units, as a value of the quantity that `key` measures.
pub(super) fn typed(preset: &Preset, flag: &str, key: &str, text: &str) -> Result<f64, Failure> {
    let wrong = |cause: &dyn std::fmt::Display| Failure::Usage(format!("{flag}: {cause}"));
    let row = preset.row(key).ok_or_else(|| wrong(&format!("expected {}", Quantity::Length.name())))?;
    // The row belongs to another key, which the message must not name.
    let words = |invalid: pulloff_engine::preset::Invalid| {
        let text = invalid.to_string();
        wrong(&text.strip_prefix(&*row.key).map_or(&*text, |rest| rest.trim_start_matches([':', '=', ' '])))
    };
    preset.number(&row, text).map_err(words)
}

/// The file of the preset's own curve; the name of one that comes with the program.
pub(super) fn own(preset: &Preset) -> Option<PathBuf> {
    preset.data.source.as_ref().map(|source| source.path())
}

/// Separates files with points from the preset, wherever it is named.
///
/// # Errors
/// Two presets are named, or a name is that of neither a file nor a preset.
pub(super) fn apart(paths: &[OsString]) -> Result<(Option<OsString>, Vec<PathBuf>), Failure> {
    let (presets, files): (Vec<&OsString>, Vec<&OsString>) = paths.iter().partition(|path| is_preset(path));
    if let [one, other, ..] = presets[..] {
        let [one, other] = [one, other].map(|path| show_path(Path::new(path)));
        return Err(Failure::Usage(format!("{one} and {other} are presets: files with points go with one")));
    }
    // A file of points has an ending or a folder: a bare name that is not there is that of a preset, misspelt.
    let is_bare = |path: &&OsString| !Path::new(path).exists() && Path::new(path).extension().is_none();
    let bare = files.iter().copied().find(|path| is_bare(path) && Path::new(path).components().count() == 1);
    if let Some(name) = bare.filter(|name| presets.is_empty() && !name.to_string_lossy().contains(':'))
        && let Err(error) = problem::store().resolve(name)
    {
        let name = show_path(Path::new(name));
        return Err(Failure::Usage(format!("{name}: there is no such file, and {error}")));
    }
    Ok((presets.first().map(|preset| (*preset).clone()), files.into_iter().map(PathBuf::from).collect()))
}

/// Whether the argument names a preset and not a file of points.
fn is_preset(path: &OsString) -> bool {
    let shown = Path::new(path);
    let is_file = shown.is_file() && shown.extension().is_none_or(|ending| ending != "toml");
    let ends = shown.extension().is_some_and(|ending| ending == "toml") || path == stream::STANDARD;
    ends || (!is_file && problem::store().resolve(path).is_ok())
}
