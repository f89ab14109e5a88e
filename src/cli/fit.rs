//! `pulloff fit`: the values of a problem that fit a measured curve, with their errors.

mod done;
mod files;
mod summary;
mod table;
mod together;

use self::done::FinishedFits;
use self::table::FitTable;
use self::together::Several;
use super::console::{Console, Messages};
use super::format::{self, Format, FormatArgument};
use super::jobs::Jobs;
use super::measured::{ReadingArguments, attach, own, typed};
use super::output::{Destination, Inputs, OUTPUT, OutputSink, Outputs, shown};
use super::problem::Changes;
use super::watch::StopSignal;
use super::{Failure, measured, problem};
use crate::store::hash::sha256;
use crate::store::{Loaded, stream};
use crate::sweep::in_order;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use pulloff_engine::fit::{FitError, Model, Models, Options, fit_models};
use pulloff_engine::measured::asked::AskedError;
use pulloff_engine::measured::{Asked, ValueRange};
use pulloff_engine::preset::edge::RATE;
use pulloff_engine::preset::{Preset, Value, data, write};
use pulloff_engine::progress::{Progress, Stopped};
use pulloff_engine::text::{quote, show_path};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// How many fits may wait for an earlier one.
const WINDOW: u64 = 256;

/// The arguments of `pulloff fit`.
#[derive(Debug, Args)]
pub struct FitArguments {
    /// Files with measured curves, followed by a preset's name or file (ending in .toml), the wavy sphere when left
    /// out; or only a preset that names its curve in data.file
    #[arg(required = true, value_name = "FILE... [PRESET]")]
    paths: Vec<OsString>,
    /// The keys to fit, dotted or by their letters: `material.effective_modulus,material.work_of_adhesion` or E*,gamma;
    /// also data.offset (where x is zero), data.baseline (where P is; where there is a free part, it is always
    /// fitted) and data.tilt; those of the preset's data.free when left out. Offset, tilt and, without a free
    /// part, baseline are held at the values of the preset or of --set unless they are free
    #[arg(long, value_name = "KEY,...", value_delimiter = ',')]
    free: Option<Vec<String>>,
    #[command(flatten)]
    changes: Changes,
    /// Values known with an error, which may change within it: path.control.stiffness=10%,R=1um; those of the
    /// preset's data.uncertain when left out
    #[arg(long, value_name = "KEY=ERROR,...", value_delimiter = ',', allow_hyphen_values = true)]
    uncertain: Option<Vec<String>>,
    /// Fit this key separately for approach and retraction; between them the edge is pinned
    #[arg(long, value_name = "KEY", value_parser = ["material.work_of_adhesion", "work_of_adhesion", "gamma"])]
    separate: Option<String>,
    /// Fit this model instead of material.adhesion: short-range, at the edge of contact only; dugdale, with a range,
    /// where `material.cohesive_strength` is free; or rate, by which adhesion grows with the speed of the edge, where
    /// the keys of edge are free. Given several models and one file of points, the report says which one the points
    /// favour
    #[arg(long, value_name = "MODEL,...", value_delimiter = ',', value_parser = models())]
    model: Vec<Model>,
    #[command(flatten)]
    several: Several,
    #[command(flatten)]
    reading: ReadingArguments,
    /// Use only rows in this range, in the file's own numbers: x=LO..HI or force=LO..HI (repeatable)
    #[arg(long, value_name = "x=LO..HI", allow_hyphen_values = true)]
    range: Vec<String>,
    /// Standard deviation of x; that of the free part, or the last digit, when left out
    #[arg(long, value_name = "LENGTH")]
    sigma_x: Option<String>,
    /// Standard deviation of the force; that of the free part when left out
    #[arg(long, value_name = "FORCE")]
    sigma_force: Option<String>,
    /// How much points count: huber lets those beyond 1.5 deviations count linearly, none squares all of them
    #[arg(long, value_enum, default_value = "huber")]
    robust: Robust,
    /// Start only from the preset's values
    #[arg(long)]
    no_scan: bool,
    /// Poisson's ratio of the soft body; the report then gives its E as well as E*
    #[arg(long, value_name = "NU", allow_hyphen_values = true)]
    poisson: Option<f64>,
    /// Find 95 % intervals by the profile of chi squared
    #[arg(long)]
    profile: bool,
    /// Fit this many resampled sets, drawn at random by blocks of rows, 10 to 100000; when left out, 200 below 40
    /// degrees of freedom and none otherwise
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(10..=100_000))]
    bootstrap: Option<u32>,
    /// The seed of the bootstrap's random numbers
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// Exit with 0, not 4, where the model does not describe the points; the verdict stays
    #[arg(long)]
    accept: bool,
    #[command(flatten)]
    jobs: Jobs,
    /// Write the points with their residuals to this file; for one file of points only
    #[arg(long, value_name = "FILE")]
    residuals: Option<PathBuf>,
    /// Write one row per file to this table; a rerun continues where it stopped, or starts again with --overwrite
    #[arg(long, value_name = "RESULTS.csv")]
    table: Option<PathBuf>,
    #[command(flatten)]
    format: FormatArgument,
    #[command(flatten)]
    destination: Destination,
    #[command(flatten)]
    messages: Messages,
}

/// The outputs of the command.
struct FitSinks {
    report: OutputSink,
    format: Format,
    fitted: Option<OutputSink>,
    residuals: Option<OutputSink>,
    table: Option<FitTable>,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Robust {
    Huber,
    None,
}

/// The names of the models.
fn models() -> impl TypedValueParser<Value = Model> {
    PossibleValuesParser::new(Model::ALL.map(Model::name)).try_map(|word| Model::of(&word).ok_or("no model"))
}

pub fn run(arguments: &FitArguments) -> Result<ExitCode, Failure> {
    let messages = arguments.messages;
    let console = messages.open();
    let (files, loaded, options) = arguments.read(&console)?;
    let sinks = arguments.sinks(&files, &loaded)?;
    let stop = StopSignal::catch()?;
    let said = arguments.said()?;
    let rates = arguments.several.rates(&files, &loaded.preset)?;
    if arguments.several.together {
        return together::run(
            arguments,
            (&files, &loaded, &options),
            (&said, &rates),
            &console,
            &sinks,
            &stop,
        );
    }
    let mut done = FinishedFits::new(arguments, &console, sinks);
    let left = done.left(&files);
    let many = files.len() > 1;
    let compute = |index: u64| {
        let path = usize::try_from(index).ok().and_then(|index| left.get(index))?;
        // Each of many files is a small share of the whole and soon done.
        let bar = (!many).then(|| messages.bar(Some(&stop)));
        let progress = bar.as_ref().map_or(&stop as &dyn Progress, |bar| bar);
        let said = of_file(&said, files.iter().position(|file| file == path), &rates);
        Some(one(path, &loaded, &said, (&options, &arguments.model), progress))
    };
    let bar = console.bar(None);
    let (all, mut paths) = (left.len() as u64, left.iter());
    in_order(0..all, arguments.jobs.count(), WINDOW, &compute, &stop, |found| {
        let Some((found, path)) = found.and_then(|found| Some((found, paths.next()?))) else { return Ok(()) };
        if many {
            bar.report(1.0 - paths.len() as f64 / all as f64);
        }
        match found {
            Ok(found) => done.keep(path, &found, &stop),
            // It was stopped before there was any result.
            Err(_) if stop.signal().is_some() => Ok(()),
            Err(failure) if many => done.refuse(path, &failure),
            Err(failure) => Err(failure),
        }
    })?;
    drop(bar);
    done.end(many, &loaded, &stop)
}

/// What is said of one file, with its rate.
fn of_file(
    said: &[(&'static str, Value)],
    number: Option<usize>,
    rates: &[f64],
) -> Vec<(&'static str, Value)> {
    let rate = rates.get(number.unwrap_or(0)).or(rates.first().filter(|_| rates.len() == 1));
    said.iter().cloned().chain(rate.map(|rate| (RATE, Value::Number(*rate)))).collect()
}

/// The preset with the points of a file, or with its own points.
fn with_points(path: &Path, loaded: &Loaded, said: &[(&'static str, Value)]) -> Result<Preset, Failure> {
    let mut preset = loaded.preset.clone();
    let other = Some(path).filter(|path| own(&preset).as_deref() != Some(path));
    attach(&mut preset, other, said)?;
    Ok(preset)
}

/// Why a file could not be fitted.
fn refused(path: &Path, error: &FitError) -> Failure {
    let named = format!("{}: {error}", show_path(path));
    match error {
        FitError::NoStart | FitError::Stopped(Stopped) => Failure::Incomplete(named),
        _ => Failure::Usage(named),
    }
}

/// The fit to one file, or to the curve of the preset itself.
fn one(
    path: &Path,
    loaded: &Loaded,
    said: &[(&'static str, Value)],
    (options, models): (&Options, &[Model]),
    progress: &dyn Progress,
) -> Result<Models, Failure> {
    let preset = with_points(path, loaded, said)?;
    fit_models(&preset, models, options, progress).map_err(|error| refused(path, &error))
}

impl FitArguments {
    /// Reads the files, the preset and the options.
    fn read(&self, console: &Console) -> Result<(Vec<PathBuf>, Loaded, Options), Failure> {
        let (preset, mut files) = measured::apart(&self.paths);
        let loaded = problem::ProblemArguments { preset, changes: self.changes.clone() }.load(console)?;
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
    fn said(&self) -> Result<Vec<(&'static str, Value)>, Failure> {
        let uncertain = self.uncertain.as_ref().map(|given| (data::UNCERTAIN, Value::Text(given.join(","))));
        Ok(self.reading.said()?.into_iter().chain(uncertain).collect())
    }

    /// Checks all outputs. An output ending in .toml is the preset with the fitted values; the report then goes to
    /// standard output.
    fn sinks(&self, files: &[PathBuf], loaded: &Loaded) -> Result<FitSinks, Failure> {
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

    fn options(&self, preset: &Preset) -> Result<Options, Failure> {
        // Lengths and forces are typed in the same way as those of a start.
        let number = |what: &str, key: &str, text: &str| typed(preset, what, key, text);
        let (length, force) = ("path.start_approach", "path.start_force");
        let mut asked = Asked::default();
        for (slot, text, key, what) in
            [(0, &self.sigma_x, length, "--sigma-x"), (1, &self.sigma_force, force, "--sigma-force")]
        {
            let Some(text) = text else { continue };
            let sigma = number(what, key, text)?;
            if sigma.is_nan() || sigma <= 0.0 {
                return Err(Failure::Usage(format!(
                    "{what} {}: a standard deviation must be above 0",
                    quote(text)
                )));
            }
            asked.sigma[slot] = Some(sigma);
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
            separate: self.separate.is_some(),
            robust: self.robust == Robust::Huber,
            asked,
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
    fn fingerprint(&self, preset: &Preset) -> String {
        let Self { free, uncertain, changes, separate, model, reading, range, sigma_x, sigma_force, .. } =
            self;
        let Self { robust, no_scan, several: Several { rate, .. }, .. } = self;
        let said = format!(
            "{free:?} {uncertain:?} {changes:?} {separate:?} {model:?} {reading:?} {range:?} {sigma_x:?} {sigma_force:?} {robust:?} {no_scan} {rate:?}"
        );
        sha256(format!("{said}\n{}", write(preset)).as_bytes())
    }
}
