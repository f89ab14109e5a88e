//! The arguments of `pulloff fit`, and what is read and opened for them.

use super::files;
use super::table::FitTable;
use crate::cli::console::{Console, Messages};
use crate::cli::format::{self, Format, FormatArgument};
use crate::cli::jobs::Jobs;
use crate::cli::measured::{ReadingArguments, attach, own, typed};
use crate::cli::output::{Destination, Inputs, OUTPUT, OutputSink, Outputs, shown};
use crate::cli::problem::Changes;
use crate::cli::{Failure, measured, problem};
use crate::store::atomic::folder_of;
use crate::store::hash::sha256;
use crate::store::{Loaded, stream};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use pulloff_engine::fit::{AdhesionModel, FitError, Options};
use pulloff_engine::measured::asked::AskedError;
use pulloff_engine::measured::{Asked, ValueRange};
use pulloff_engine::preset::edge::RATE;
use pulloff_engine::preset::{Preset, Value, data, write};
use pulloff_engine::progress::Stopped;
use pulloff_engine::text::{quote, show_path};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The arguments of `pulloff fit`.
#[derive(Debug, Args)]
pub struct FitArguments {
    /// Files with measured curves, and a preset's name or file (ending in .toml), the wavy sphere when left
    /// out; or only a preset that names its curve in data.file
    #[arg(required = true, value_name = "FILE... [PRESET]")]
    pub(super) paths: Vec<OsString>,
    /// The keys to fit, dotted or by their letters: `material.effective_modulus,material.work_of_adhesion` or E*,gamma;
    /// also data.offset (where x is zero), data.baseline (where P is) and data.tilt; those of the preset's data.free when
    /// left out. Offset and tilt are held at the values of the preset or of --set unless they are free. The baseline is
    /// always fitted where there is a free part; without one, it is held if it is given, and fitted within 2 % of
    /// the largest force if not
    #[arg(long, value_name = "KEY,...", value_delimiter = ',')]
    pub(super) free: Option<Vec<String>>,
    #[command(flatten)]
    pub(super) changes: Changes,
    /// Values known with an error, which may change within it: path.control.stiffness=10%,R=1um; those of the
    /// preset's data.uncertain when left out
    #[arg(long, value_name = "KEY=ERROR,...", value_delimiter = ',', allow_hyphen_values = true)]
    pub(super) uncertain: Option<Vec<String>>,
    /// Fit this model instead of material.adhesion: short-range, at the edge of contact only; dugdale, with a range,
    /// where `material.cohesive_strength` is free; or rate, by which adhesion grows with the speed of the edge, where
    /// the keys of edge are free. Given several models and one file of points, the report says which one the points
    /// favour
    #[arg(long, value_name = "MODEL,...", value_delimiter = ',', value_parser = models())]
    pub(super) model: Vec<AdhesionModel>,
    #[command(flatten)]
    pub(super) several: Several,
    #[command(flatten)]
    pub(super) reading: ReadingArguments,
    /// Use only rows in this range, with the signs and zeros of the file: x=LO..HI or force=LO..HI (repeatable). A number
    /// without a unit is in base units
    #[arg(long, value_name = "x=LO..HI", allow_hyphen_values = true)]
    pub(super) range: Vec<String>,
    /// Standard deviation of x; when left out that of the free part, or the last digit, at least 1e-4 of the range
    #[arg(long, value_name = "LENGTH")]
    pub(super) sigma_x: Option<String>,
    /// Standard deviation of the force, a share of it in per cent, or both: 2uN, 3%, 2uN+3%; when left out that of
    /// the free part, and the share that neighbouring rows show
    #[arg(long, value_name = "FORCE", allow_hyphen_values = true)]
    pub(super) sigma_force: Option<String>,
    /// How much points count: huber lets those beyond 1.5 deviations count linearly, none squares all of them
    #[arg(long, value_enum, default_value = "huber")]
    pub(super) robust: Robust,
    /// Start only from the preset's values
    #[arg(long)]
    pub(super) no_scan: bool,
    /// Poisson's ratio of the soft body; the report then gives its E as well as E*
    #[arg(long, value_name = "NU", allow_hyphen_values = true)]
    pub(super) poisson: Option<f64>,
    /// Find 95 % intervals by the profile of chi squared
    #[arg(long)]
    pub(super) profile: bool,
    /// Fit this many resampled sets, drawn at random by blocks of rows, 10 to 100000; when left out, 200 below 40
    /// degrees of freedom, 100 where the curve runs through snaps, and none otherwise
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(10..=100_000))]
    pub(super) bootstrap: Option<u32>,
    /// The seed of the bootstrap's random numbers
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub(super) seed: u64,
    /// Exit with 0, not 4, where the model does not describe the points; the verdict stays
    #[arg(long)]
    pub(super) accept: bool,
    #[command(flatten)]
    pub(super) jobs: Jobs,
    /// Write the points with their residuals to this file; for one file of points only
    #[arg(long, value_name = "FILE")]
    pub(super) residuals: Option<PathBuf>,
    /// Write one row per file to this table; a rerun continues where it stopped, or starts again with --overwrite
    #[arg(long, value_name = "RESULTS.csv")]
    pub(super) table: Option<PathBuf>,
    #[command(flatten)]
    pub(super) format: FormatArgument,
    #[command(flatten)]
    pub(super) destination: Destination,
    #[command(flatten)]
    pub(super) messages: Messages,
}

/// The outputs of the command.
pub(super) struct FitSinks {
    pub(super) report: OutputSink,
    pub(super) format: Format,
    pub(super) fitted: Option<OutputSink>,
    pub(super) residuals: Option<OutputSink>,
    pub(super) table: Option<FitTable>,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum Robust {
    Huber,
    None,
}

/// The names of the models.
fn models() -> impl TypedValueParser<Value = AdhesionModel> {
    PossibleValuesParser::new(AdhesionModel::ALL.map(AdhesionModel::name))
        .try_map(|word| AdhesionModel::of(&word).ok_or("no model"))
}

/// The options for fitting several files at once.
#[derive(Debug, Args)]
pub(super) struct Several {
    /// Fit one law to all files: the free values of material, gap, edge and path are shared, those of data.* are each
    /// file's own; the report says whether the files follow one law
    #[arg(long, conflicts_with_all = ["residuals", "table", "profile", "bootstrap", "poisson"])]
    pub(super) together: bool,
    /// The rate of the device in each file, in order, or one for all; when left out that of the times of a file, or
    /// path.rate. A rate that the times of a file contradict is refused; without a law of the edge, rates play no part
    #[arg(long, value_name = "RATE,...", value_delimiter = ',')]
    pub(super) rate: Vec<String>,
}

impl Several {
    /// The rates of the files.
    pub(super) fn rates(&self, files: &[PathBuf], preset: &Preset) -> Result<Vec<f64>, Failure> {
        if self.rate.len() > 1 && self.rate.len() != files.len() {
            return Err(Failure::Usage(format!(
                "--rate: {} rates are given for {} files: give one for each, or one for all",
                self.rate.len(),
                files.len()
            )));
        }
        self.rate.iter().map(|text| typed(preset, "--rate", RATE, text)).collect()
    }
}

/// What is said of one file, with its rate.
pub(super) fn of_file(
    said: &[(&'static str, Value)],
    number: Option<usize>,
    rates: &[f64],
) -> Vec<(&'static str, Value)> {
    let rate = rates.get(number.unwrap_or(0)).or(rates.first().filter(|_| rates.len() == 1));
    said.iter().cloned().chain(rate.map(|rate| (RATE, Value::Number(*rate)))).collect()
}

/// The preset with the points of a file, or with its own points.
pub(super) fn with_points(
    path: &Path,
    loaded: &Loaded,
    said: &[(&'static str, Value)],
) -> Result<Preset, Failure> {
    let mut preset = loaded.preset.clone();
    let other = Some(path).filter(|path| own(&preset).as_deref() != Some(path));
    attach(&mut preset, other, said)?;
    Ok(preset)
}

/// Why a file could not be fitted; where no values reach its points, also how columns without a unit are read.
pub(super) fn refused(path: &Path, preset: &Preset, error: &FitError) -> Failure {
    let units = preset.note_of_units().filter(|_| matches!(error, FitError::NoStart));
    let units = units.map_or_else(String::new, |units| format!("; {units}"));
    let named = format!("{}: {error}{units}", show_path(path));
    match error {
        // These do not come from the file of points.
        FitError::Key { .. } | FitError::Uncertain { .. } => Failure::Usage(error.to_string()),
        FitError::NoStart | FitError::Stopped(Stopped) => Failure::Incomplete(named),
        _ => Failure::Usage(named),
    }
}

impl FitArguments {
    /// The text of a fitted preset, placed beside its output, with the keys that were free: it can be fitted again as it is.
    pub(super) fn fitted(&self, found: &Preset, free: &[String]) -> Result<String, Failure> {
        let mut preset = found.placed_in(folder_of(self.destination.path()));
        let free = Value::Text(free.join(","));
        preset.set(data::FREE, free).map_err(|invalid| Failure::Usage(invalid.to_string()))?;
        Ok(write(&preset))
    }

    /// Reads the files, the preset and the options.
    pub(super) fn read(&self, console: &Console) -> Result<(Vec<PathBuf>, Loaded, Options), Failure> {
        let (preset, mut files) = measured::apart(&self.paths)?;
        let problem = problem::ProblemArguments { preset, changes: self.changes.clone() };
        let loaded = problem.load_for(!files.is_empty(), console)?;
        files = files::measured(files, console)?;
        if files.is_empty() {
            files.extend(own(&loaded.preset));
        }
        if files.len() > 1 && self.model.len() > 1 {
            return Err(Failure::Usage(format!(
                "--model: several models are compared on one file of points, but {} are given",
                files.len()
            )));
        }
        if self.several.together && (files.len() < 2 || self.model.len() > 1) {
            return Err(Failure::Usage(format!(
                "--together: one law and one model are fitted to two or more files, but {} files and {} models are given",
                files.len(),
                self.model.len().max(1)
            )));
        }
        if files.is_empty() {
            return Err(Failure::Usage(
                "fit needs a file with a measured curve before the preset, or a preset that names one in data.file"
                    .to_owned(),
            ));
        }
        if let Some(nu) = self.poisson.filter(|nu| !(-1.0..=0.5).contains(nu)) {
            return Err(Failure::Usage(format!("--poisson {nu}: Poisson's ratio must be from -1 to 0.5")));
        }
        let options = self.options(&loaded.preset)?;
        Ok((files, loaded, options))
    }

    /// What the command line says about the files, with the keys.
    pub(super) fn said(&self) -> Result<Vec<(&'static str, Value)>, Failure> {
        let uncertain = self.uncertain.as_ref().map(|given| (data::UNCERTAIN, Value::Text(given.join(","))));
        Ok(self.reading.said()?.into_iter().chain(uncertain).collect())
    }

    /// Checks all outputs. An output ending in .toml is the preset with the fitted values; the report then goes to
    /// standard output.
    pub(super) fn sinks(&self, files: &[PathBuf], loaded: &Loaded) -> Result<FitSinks, Failure> {
        let preset = self.paths.last().map(Path::new);
        let inputs = Inputs::default().with_problem(preset, loaded);
        let inputs = files.iter().fold(inputs, |inputs, file| inputs.with("the points", file));
        let output = self.destination.path();
        let is_fitted = format::ending(output).is_some_and(|ending| ending == "toml");
        let of_one =
            [(OUTPUT, is_fitted && !self.several.together), ("--residuals", self.residuals.is_some())];
        if let Some((option, _)) = of_one.into_iter().find(|(_, is_given)| *is_given && files.len() > 1) {
            return Err(Failure::Usage(format!(
                "{option}: is for one file of points, but {} are given",
                files.len()
            )));
        }
        let report = if is_fitted { Path::new(stream::STANDARD) } else { output };
        let format = self.format.of(report, Format::Table)?;
        for (option, file) in [("--residuals", &self.residuals), ("--table", &self.table)] {
            file.as_ref().map_or(Ok(()), |file| format::only(option, file, Format::Csv))?;
        }
        let mut outputs = Outputs::beside(inputs, self.destination.replacing);
        let report = outputs.file(OUTPUT, report)?;
        let fitted = is_fitted.then(|| outputs.file(OUTPUT, output)).transpose()?;
        let residuals = self.residuals.as_ref().map(|file| outputs.file("--residuals", file)).transpose()?;
        let table = match &self.table {
            Some(file) if stream::is_stream(file) => {
                let what = "is rewritten after each fit; name a file";
                return Err(Failure::Usage(format!("--table {}: {what}", shown(file))));
            }
            Some(file) => {
                let sink = outputs.kept("--table", file)?;
                Some(FitTable::open(
                    file,
                    sink,
                    self.destination.replacing,
                    &self.fingerprint(&loaded.preset),
                )?)
            }
            None => None,
        };
        Ok(FitSinks { report, format, fitted, residuals, table })
    }

    pub(super) fn options(&self, preset: &Preset) -> Result<Options, Failure> {
        // Lengths and forces are typed in the same way as those of a start.
        let number = |what: &str, key: &str, text: &str| typed(preset, what, key, text);
        let (length, force) = ("path.start_approach", "path.start_force");
        let mut asked = Asked::default();
        let positive = |what: &str, text: &str, sigma: f64| {
            let why = || format!("{what} {}: a standard deviation must be a number above 0", quote(text));
            if sigma > 0.0 && sigma.is_finite() { Ok(Some(sigma)) } else { Err(Failure::Usage(why())) }
        };
        if let Some(text) = &self.sigma_x {
            asked.sigma[0] = positive("--sigma-x", text, number("--sigma-x", length, text)?)?;
        }
        if let Some(text) = &self.sigma_force {
            const WHAT: &str = "--sigma-force";
            let (level, share) = match text.trim().strip_suffix('%') {
                Some(both) => both
                    .rsplit_once('+')
                    .map_or((None, Some(both)), |(level, share)| (Some(level), Some(share))),
                None => (Some(text.as_str()), None),
            };
            if let Some(level) = level {
                asked.sigma[1] = positive(WHAT, text, number(WHAT, force, level)?)?;
            }
            if let Some(share) = share {
                let wrong = |_| Failure::Usage(format!("{WHAT} {}: expected a number before %", quote(text)));
                asked.share = positive(WHAT, text, 0.01 * share.trim().parse::<f64>().map_err(wrong)?)?;
            }
        }
        for text in &self.range {
            const EXPECTED: &str = "x=LO..HI or force=LO..HI";
            let (axis, range) = text.split_once('=').unwrap_or_default();
            let (key, slot) = match axis.trim() {
                "force" | "P" => (force, &mut asked.force),
                "x" => (length, &mut asked.x),
                _ => {
                    return Err(Failure::Usage(format!("--range: \"{}\": expected {EXPECTED}", quote(text))));
                }
            };
            let number = |text: &str| number("--range", key, text).map_err(|failure| failure.to_string());
            let span = ValueRange::parse(text, range, EXPECTED, &number).map_err(|error| match error {
                AskedError::Number(text) => Failure::Usage(text),
                error => Failure::Usage(format!("--range: {error}")),
            });
            *slot = Some(span?);
        }
        let options = Options {
            free: match &self.free {
                Some(free) => {
                    free.iter().map(|key| key.trim().to_owned()).filter(|key| !key.is_empty()).collect()
                }
                None => preset.data.free().map(str::to_owned).collect(),
            },
            robust: self.robust == Robust::Huber,
            asked,
            is_rate_said: !self.several.rate.is_empty(),
            scan: !self.no_scan,
            profile: self.profile,
            bootstrap: self.bootstrap.map(|count| (usize::try_from(count).unwrap_or(usize::MAX), self.seed)),
        };
        if options.free.is_empty() {
            return Err(Failure::Usage(FitError::NothingFree.to_string()));
        }
        Ok(options)
    }

    /// What the rows of a table depend on, apart from the files themselves.
    pub(super) fn fingerprint(&self, preset: &Preset) -> String {
        let Self { free, uncertain, changes, model, reading, range, sigma_x, sigma_force, .. } = self;
        let Self { robust, no_scan, several: Several { rate, .. }, .. } = self;
        let said = format!(
            "{free:?} {uncertain:?} {changes:?} {model:?} {reading:?} {range:?} {sigma_x:?} {sigma_force:?} {robust:?} {no_scan} {rate:?}"
        );
        sha256(format!("{said}\n{}", write(preset)).as_bytes())
    }
}
