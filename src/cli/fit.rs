//! `pulloff fit`: the values of a problem that a measured curve gives, with their errors.

use super::console::{note, warn};
use super::measured::{fill, typed};
use super::{Failure, output, problem};
use crate::store::data::read_measured;
use crate::store::hash::sha256;
use crate::store::{Loaded, stream};
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pulloff_engine::fit::{Fit, FitError, Options, fit};
use pulloff_engine::measured::branches::{Asked, Span};
use pulloff_engine::measured::{Segment, Spec};
use pulloff_engine::preset::{Preset, write};
use pulloff_engine::report::fit::{FitReport, residuals};
use pulloff_engine::report::json;
use pulloff_engine::text::{quote, show_path};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// The arguments of `pulloff fit`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Files with measured curves, and behind them a preset's name or file (ending in .toml); the wavy sphere when left out
    #[arg(required = true, value_name = "FILE... [PRESET]")]
    paths: Vec<OsString>,
    /// The keys to fit, dotted or by their letters: `material.effective_modulus,material.work_of_adhesion` or E*,gamma; also
    /// data.offset (where x is zero), data.baseline (where P is; fitted anyway where there is a free part) and data.tilt
    #[arg(long, value_name = "KEY,...", required = true, value_delimiter = ',')]
    free: Vec<String>,
    /// Give a key of the preset another value before (repeatable); data.offset, data.baseline and data.tilt are held so
    #[arg(long = "set", value_name = "KEY=VALUE", allow_hyphen_values = true)]
    assignments: Vec<String>,
    /// Fit this key for approach and retraction apart
    #[arg(long, value_name = "KEY", value_parser = ["material.work_of_adhesion", "work_of_adhesion", "gamma"])]
    separate: Option<String>,
    /// What the columns are, by number or name, where the header does not say it: x=1,force=2 or position=Z [nm],force=F [nN]
    #[arg(long, value_name = "ROLE=COLUMN,...")]
    columns: Option<String>,
    /// Use rows in this range alone, as they are in the file: x=LO..HI or force=LO..HI (repeatable)
    #[arg(long, value_name = "x=LO..HI", allow_hyphen_values = true)]
    range: Vec<String>,
    /// Use one branch alone
    #[arg(long, value_enum)]
    segment: Option<Branch>,
    /// Standard deviation of x; that of the free part, or the last digit, when left out
    #[arg(long, value_name = "LENGTH")]
    sigma_x: Option<String>,
    /// Standard deviation of the force; that of the free part when left out
    #[arg(long, value_name = "FORCE")]
    sigma_force: Option<String>,
    /// How far points count: huber lets those beyond 1.5 deviations count linearly, none squares all
    #[arg(long, value_enum, default_value = "huber")]
    robust: Robust,
    /// Start from the preset's values alone
    #[arg(long)]
    no_scan: bool,
    /// Poisson's ratio of the soft body: tells its E beside E*
    #[arg(long, value_name = "NU", allow_hyphen_values = true)]
    poisson: Option<f64>,
    /// Find 95 % intervals by the profile of chi squared
    #[arg(long)]
    profile: bool,
    /// Fit so many sets of blocks of rows drawn at random, 10 to 100000
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(10..=100_000))]
    bootstrap: Option<u32>,
    /// Which random numbers the bootstrap draws
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// Write JSON instead of text
    #[arg(long)]
    json: bool,
    /// Write the preset with the fitted values to this file; of one file of points alone
    #[arg(short, value_name = "FITTED.toml")]
    output: Option<PathBuf>,
    /// Write the points with their residuals to this file; of one file of points alone
    #[arg(long, value_name = "FILE")]
    residuals: Option<PathBuf>,
    /// Write one row for each file to this table; a rerun goes on where it ended
    #[arg(long, value_name = "RESULTS.csv")]
    table: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Branch {
    Approach,
    Retraction,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Robust {
    Huber,
    None,
}

/// The keys of the instrument that a preset does not have.
const INSTRUMENT: [&str; 3] = ["data.offset", "data.baseline", "data.tilt"];

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let (files, loaded, options) = arguments.read()?;
    let spec = arguments.columns.as_deref().map_or(Ok(Spec::default()), Spec::parse);
    let spec = spec.map_err(|error| Failure::Usage(format!("--columns: {error}")))?;
    let signal = Arc::new(AtomicUsize::new(0));
    for number in [SIGINT, SIGTERM] {
        // The second ends at once, as ever.
        let caught = flag::register_conditional_shutdown(number, 1, Arc::default()).and_then(|_| {
            flag::register_usize(number, Arc::clone(&signal), usize::try_from(number).unwrap_or(2))
        });
        caught.map_err(|cause| Failure::System { what: "cannot catch signals".to_owned(), cause })?;
    }
    let mut table = match &arguments.table {
        Some(path) => Some(Table::open(path, &arguments.fingerprint(&loaded.preset))?),
        None => None,
    };
    let mut reports = Vec::new();
    let mut worst = None;
    for path in &files {
        let shown = show_path(path);
        if table.as_ref().is_some_and(|table| table.has(path)) {
            note(Some(&format!("{shown}: is in the table already")));
            continue;
        }
        let done = one(path, &spec, &loaded.preset, &options, &signal);
        let (found, preset) = match done {
            Ok(done) => done,
            // One bad file among many is told, and the others are fitted.
            Err(failure) if files.len() > 1 => {
                warn(&[failure.to_string()]);
                worst = worst.max(Some(1));
                if let Some(table) = &mut table {
                    table.add(path, None, &failed(shown, &failure))?;
                }
                continue;
            }
            Err(failure) => return Err(failure),
        };
        let report = FitReport::new(&shown, &found.0, found.1, arguments.poisson);
        warn(&report.warnings);
        if let Some(table) = &mut table {
            table.add(path, Some(table.fingerprint(path)), &report.row())?;
        }
        if let Some(file) = &arguments.residuals {
            output::write(&residuals(&found.0.residuals), Some(file))?;
        }
        if let Some(file) = &arguments.output {
            let folder = file.parent().unwrap_or(Path::new("."));
            output::write(&write(&preset.placed_in(folder)), Some(file))?;
        }
        worst = worst.max(status(&report));
        reports.push(report);
        if signal.load(Ordering::Relaxed) != 0 {
            break;
        }
    }
    let text = match (arguments.json, reports.as_slice()) {
        (true, [report]) if files.len() == 1 => json(report)?,
        (true, reports) => json(&serde_json::json!({ "schema": 1, "fits": reports }))?,
        (false, reports) => reports.iter().map(FitReport::text).collect::<Vec<_>>().join("\n"),
    };
    output::write(&text, None)?;
    match (signal.load(Ordering::Relaxed), worst) {
        (0, None | Some(0)) => Ok(ExitCode::SUCCESS),
        (0, Some(3)) => Err(Failure::Inadmissible(
            "the points do not determine all values; the result says which".to_owned(),
        )),
        (0, Some(_)) => Err(Failure::Incomplete(
            "not every fit came to its end; the result has the best values so far".to_owned(),
        )),
        (signal, _) => Err(Failure::Interrupted {
            signal: u8::try_from(signal).unwrap_or(2),
            text: "stopped: the result has the best values so far".to_owned(),
        }),
    }
}

/// The header and the row of a file that could not be fitted.
fn failed(file: String, failure: &Failure) -> [Vec<String>; 2] {
    let text = failure.to_string().replace('\n', "; ");
    [["file", "state"].map(str::to_owned).to_vec(), vec![file, text]]
}

/// 1 where a fit did not converge, else 3 where it is not determined.
fn status(report: &FitReport) -> Option<u8> {
    match (report.ended, report.determined) {
        ("converged", true) => None,
        ("converged", false) => Some(3),
        // Above 3, so that it is what many files end with.
        _ => Some(4),
    }
}

/// The fit to one file, with what its x is, and the fitted preset.
type Done = ((Fit, pulloff_engine::measured::Abscissa), Preset);

fn one(
    path: &Path,
    spec: &Spec,
    preset: &Preset,
    options: &Options,
    signal: &AtomicUsize,
) -> Result<Done, Failure> {
    let named = |error: &dyn std::fmt::Display| format!("{}: {error}", show_path(path));
    let usage = |error: &dyn std::fmt::Display| Failure::Usage(named(error));
    let measured = read_measured(path, spec)?;
    let mut preset = preset.clone();
    let spring = fill(&mut preset, &measured).map_err(|error| usage(&error))?;
    let points = measured.points(&preset.units, spring).map_err(|error| usage(&error))?;
    let bar = bar();
    let fitted = fit(&preset, &points, options, &mut |share| {
        // A share of a hundred.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        bar.set_position((share.clamp(0.0, 1.0) * 100.0) as u64);
        signal.load(Ordering::Relaxed) == 0
    });
    bar.finish_and_clear();
    let mut fitted = fitted.map_err(|error| match error {
        FitError::NoStart | FitError::Cancelled => Failure::Incomplete(named(&error)),
        error => usage(&error),
    })?;
    let notes = measured.notes.into_iter().chain(std::mem::take(&mut fitted.notes)).collect();
    fitted.notes = notes;
    let found = fitted.preset.clone();
    Ok(((fitted, points.abscissa), found))
}

/// Shown on a terminal, once it takes longer than a moment.
fn bar() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(100), ProgressDrawTarget::stderr_with_hz(5));
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {percent} %") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_secs(1));
    bar
}

impl Arguments {
    /// The files, the preset and what is asked for.
    fn read(&self) -> Result<(Vec<PathBuf>, Loaded, Options), Failure> {
        let (preset, files) = match self.paths.split_last() {
            Some((last, files)) if is_preset(last, files.is_empty()) => (Some(last.clone()), files),
            _ => (None, &self.paths[..]),
        };
        if files.is_empty() {
            return Err(Failure::Usage(
                "fit needs a file with a measured curve before the preset".to_owned(),
            ));
        }
        let files: Vec<PathBuf> = files.iter().map(PathBuf::from).collect();
        let of_instrument = |text: &String| {
            let key = text.split_once('=').map_or("", |(key, _)| key.trim());
            INSTRUMENT.contains(&key)
        };
        let (instrument, assignments): (Vec<String>, Vec<String>) =
            self.assignments.iter().cloned().partition(of_instrument);
        let loaded = problem::Problem { preset, assignments }.load()?;
        for (file, option) in
            [(&self.output, "-o"), (&self.residuals, "--residuals"), (&self.table, "--table")]
        {
            if file.is_some() && option != "--table" && files.len() > 1 {
                return Err(Failure::Usage(format!(
                    "{option}: is of one file of points, and {} are given",
                    files.len()
                )));
            }
            output::spares(file.as_deref(), option, &loaded)?;
            let same = |path: &PathBuf| {
                let [a, b] =
                    [Some(path), file.as_ref()].map(|path| path.and_then(|path| path.canonicalize().ok()));
                a.is_some() && a == b
            };
            if files.iter().any(same) {
                return Err(Failure::Usage(format!("{option}: is the file of the points; write to another")));
            }
        }
        if let Some(nu) = self.poisson.filter(|nu| !(-1.0..=0.5).contains(nu)) {
            return Err(Failure::Usage(format!("--poisson {nu}: Poisson's ratio is from -1 to 0.5")));
        }
        let options = self.options(&loaded.preset, &instrument)?;
        Ok((files, loaded, options))
    }

    fn options(&self, preset: &Preset, instrument: &[String]) -> Result<Options, Failure> {
        // Lengths and forces are typed as those of a start are.
        let number = |what: &str, key: &str, text: &str| typed(preset, what, key, text);
        let (length, force) = ("path.start_approach", "path.start_force");
        let mut asked = Asked {
            segment: self.segment.map(|branch| match branch {
                Branch::Approach => Segment::Approach,
                Branch::Retraction => Segment::Retraction,
            }),
            ..Asked::default()
        };
        for (slot, text, key, what) in
            [(0, &self.sigma_x, length, "--sigma-x"), (1, &self.sigma_force, force, "--sigma-force")]
        {
            let Some(text) = text else { continue };
            let sigma = number(what, key, text)?;
            if sigma.is_nan() || sigma <= 0.0 {
                return Err(Failure::Usage(format!(
                    "{what} {}: a standard deviation is above 0",
                    quote(text)
                )));
            }
            asked.sigma[slot] = Some(sigma);
        }
        for text in &self.range {
            let form =
                || Failure::Usage(format!("--range \"{}\": expected x=LO..HI or force=LO..HI", quote(text)));
            let (axis, span) = text.split_once('=').ok_or_else(form)?;
            let (lo, hi) = span.split_once("..").ok_or_else(form)?;
            let (key, slot) = match axis.trim() {
                "x" => (length, &mut asked.x),
                "force" | "P" => (force, &mut asked.force),
                _ => return Err(form()),
            };
            let end = |text: &str, open: f64| {
                if text.trim().is_empty() { Ok(open) } else { number("--range", key, text.trim()) }
            };
            let span = Span { lo: end(lo, f64::NEG_INFINITY)?, hi: end(hi, f64::INFINITY)? };
            if span.lo >= span.hi {
                return Err(Failure::Usage(format!("--range \"{}\": is empty", quote(text))));
            }
            *slot = Some(span);
        }
        let mut options = Options {
            free: self.free.iter().map(|key| key.trim().to_owned()).filter(|key| !key.is_empty()).collect(),
            separate: self.separate.is_some(),
            robust: self.robust == Robust::Huber,
            asked,
            scan: !self.no_scan,
            profile: self.profile,
            bootstrap: self.bootstrap.map(|count| (usize::try_from(count).unwrap_or(usize::MAX), self.seed)),
            ..Options::default()
        };
        for text in instrument {
            let (key, value) = text.split_once('=').unwrap_or((text, ""));
            match key.trim() {
                "data.offset" => options.offset = Some(number("data.offset", length, value)?),
                "data.baseline" => options.baseline = Some(number("data.baseline", force, value)?),
                _ => {
                    let tilt = value.trim().parse().map_err(|_| {
                        Failure::Usage(format!(
                            "data.tilt: \"{}\" is no number (force per length, in base units)",
                            quote(value)
                        ))
                    })?;
                    options.tilt = Some(tilt);
                }
            }
        }
        Ok(options)
    }

    /// What decides the rows of a table, but for the files themselves.
    fn fingerprint(&self, preset: &Preset) -> String {
        let Self { free, assignments, separate, columns, range, segment, sigma_x, sigma_force, .. } = self;
        let Self { robust, no_scan, .. } = self;
        let said = format!(
            "{free:?} {assignments:?} {separate:?} {columns:?} {range:?} {segment:?} {sigma_x:?} {sigma_force:?} {robust:?} {no_scan}"
        );
        sha256(format!("{said}\n{}", write(preset)).as_bytes())
    }
}

/// Whether the last argument names a preset and no points.
fn is_preset(path: &OsString, alone: bool) -> bool {
    let shown = Path::new(path);
    let is_file = shown.is_file() && shown.extension().is_none_or(|ending| ending != "toml");
    let ends = shown.extension().is_some_and(|ending| ending == "toml") || path == stream::STANDARD;
    ends || (!alone && !is_file && problem::store().resolve(path).is_ok())
}

/// The table of many files: whole after each.
struct Table {
    path: PathBuf,
    settings: String,
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// The last column: what a row was computed from.
const FINGERPRINT: &str = "fingerprint";

impl Table {
    /// The table in `path`, or a new one.
    fn open(path: &Path, settings: &str) -> Result<Self, Failure> {
        output::csv_only(path)?;
        let mut table = Self {
            path: path.to_owned(),
            settings: settings.to_owned(),
            header: Vec::new(),
            rows: Vec::new(),
        };
        if !path.exists() {
            return Ok(table);
        }
        let (text, _) = crate::store::file::read_text(path, pulloff_engine::cells::LARGEST)?;
        let mut reader =
            csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(text.as_bytes());
        for record in reader.records() {
            table.rows.push(record?.iter().map(str::to_owned).collect());
        }
        if table.rows.is_empty() {
            return Ok(table);
        }
        table.header = table.rows.remove(0);
        if table.header.first().map(String::as_str) != Some("file")
            || table.header.last().map(String::as_str) != Some(FINGERPRINT)
        {
            return Err(Failure::Usage(format!(
                "--table {}: holds something else than fits; name another",
                output::shown(path)
            )));
        }
        Ok(table)
    }

    /// What a row of `path` is computed from.
    fn fingerprint(&self, path: &Path) -> String {
        let bytes = std::fs::read(path).unwrap_or_default();
        let mut whole = sha256(&bytes);
        whole.push_str(&self.settings);
        sha256(whole.as_bytes())[..16].to_owned()
    }

    /// Whether the file was fitted before, in the same way.
    fn has(&self, path: &Path) -> bool {
        let (shown, fingerprint) = (show_path(path), self.fingerprint(path));
        self.rows.iter().any(|row| row.first() == Some(&shown) && row.last() == Some(&fingerprint))
    }

    /// Puts a row in, in place of an older one of the same file; one without a fingerprint is tried again by a rerun.
    fn add(
        &mut self,
        path: &Path,
        fingerprint: Option<String>,
        [header, row]: &[Vec<String>; 2],
    ) -> Result<(), Failure> {
        let shown = show_path(path);
        self.rows.retain(|row| row.first() != Some(&shown));
        let mut header = header.clone();
        header.push(FINGERPRINT.to_owned());
        if header.len() > self.header.len() || self.header.is_empty() {
            self.header = header;
        }
        let mut row = row.clone();
        // A file that could not be fitted has its reason, and nothing else.
        row.resize(self.header.len().max(row.len() + 1) - 1, String::new());
        row.push(fingerprint.unwrap_or_default());
        self.rows.push(row);
        let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(Vec::new());
        writer.write_record(&self.header)?;
        for row in &mut self.rows {
            let last = row.pop().unwrap_or_default();
            row.resize(self.header.len() - 1, String::new());
            row.push(last);
            writer.write_record(&*row)?;
        }
        let bytes = writer.into_inner().map_err(|error| Failure::Usage(error.to_string()))?;
        output::write_bytes(&bytes, Some(&self.path))
    }
}
