//! `pulloff sweep`: computes many problems into one file, and joins shards.

use super::Failure;
use super::console::{Console, Messages};
use super::format::{self, Format};
use super::jobs::Jobs;
use super::output::{self, Inputs, OUTPUT, OutputSink, Outputs, Replacing};
use super::problem::Changes;
use super::sweep_status::{Reporter, StatusSubject};
use super::watch::StopSignal;
use crate::store::stream;
use crate::sweep::output::FaultCounts;
use crate::sweep::{
    Existing, Means, Output, OutputError, RunSummary, Shard, check, ensemble, run as compute, sidecar, spec,
};
use clap::{Args, Subcommand};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pulloff_engine::report::number::{short, significant};
use pulloff_engine::sweep::axis::SweepAxis;
use pulloff_engine::sweep::spec::Design;
use pulloff_engine::sweep::{QUANTITIES, QuantityColumn, Spec};
use pulloff_engine::text::{counted, quote, show_name, show_path};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The arguments of `pulloff sweep`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true, after_help = EXAMPLE)]
pub struct SweepArguments {
    #[command(subcommand)]
    command: Option<SweepCommand>,
    #[command(flatten)]
    sweep: Option<Sweep>,
}

/// The subcommands of `pulloff sweep`.
#[derive(Debug, Subcommand)]
enum SweepCommand {
    /// Join the results of all shards of a sweep
    Merge {
        /// The results of each shard, in any order
        #[arg(required = true, value_name = "PART.csv")]
        parts: Vec<PathBuf>,
        #[command(flatten)]
        results: ResultsArguments,
        #[command(flatten)]
        messages: Messages,
    },
    /// Check results without computing: whether they are complete and belong to the sweep beside them
    Check {
        /// The results of a sweep or of a shard
        #[arg(value_name = "RESULTS.csv")]
        results: PathBuf,
        #[command(flatten)]
        messages: Messages,
    },
    /// List the quantities that a sweep can compute
    Quantities,
}

/// Where the rows go.
#[derive(Debug, Args)]
struct ResultsArguments {
    /// Write to this file; if it already holds some of the same rows, continue it; - is standard output
    #[arg(short, long, value_name = "RESULTS.csv")]
    output: PathBuf,
    #[command(flatten)]
    replacing: Replacing,
}

/// A spec, for the help.
const EXAMPLE: &str = "A spec:
  preset = \"wavy-sphere\"
  quantities = [\"largest_pull\", \"snaps\"]
  [[axis]]
  key = \"gap.amplitude\"
  linear = { from = 0, to = 0.005, count = 51 }
or logarithmic = { from, to, count }, values = [...], distribution = {...}; further axes follow in the same form.
`ensemble = { members = 400, seed = 7 }` gives the mean and the spread over random surfaces and distributions.
`pulloff sweep quantities` lists the quantities.";

/// What is swept, and where to.
// clap does not know the arguments of a struct with groups in it; this argument is always there.
#[derive(Debug, Args)]
#[group(args = ["spec"])]
struct Sweep {
    /// The spec: a preset, axes, quantities; - is standard input
    #[arg(value_name = "SPEC.toml")]
    spec: PathBuf,
    #[command(flatten)]
    changes: Changes,
    #[command(flatten)]
    results: ResultsArguments,
    #[command(flatten)]
    jobs: Jobs,
    /// Compute only part I of N, such as 3/8
    #[arg(long, value_name = "I/N", default_value_t = Shard::WHOLE)]
    shard: Shard,
    /// Give up on a row after this time, such as 10s or 2min; its error says so
    #[arg(long, value_name = "TIME", value_parser = time)]
    row_limit: Option<Duration>,
    /// Report the progress in this file: JSON, replaced as a whole about every second
    #[arg(long, value_name = "FILE")]
    status: Option<PathBuf>,
    /// Wait while another pulloff writes the results, instead of giving up
    #[arg(long)]
    wait: bool,
    #[command(flatten)]
    messages: Messages,
}

/// How often a sweep that waits for another checks whether that one has ended.
const PAUSE: Duration = Duration::from_millis(200);

pub fn run(arguments: &SweepArguments) -> Result<ExitCode, Failure> {
    match (&arguments.command, &arguments.sweep) {
        (Some(SweepCommand::Quantities), _) => {
            output::print(quantities())?;
            Ok(ExitCode::SUCCESS)
        }
        (Some(SweepCommand::Merge { parts, results, messages }), _) => {
            merged(parts, results, &messages.open())
        }
        (Some(SweepCommand::Check { results, messages }), _) => checked(results, &messages.open()),
        (None, Some(sweep)) => sweep.run(),
        // clap reports missing arguments first.
        (None, None) => Err(Failure::Usage("sweep needs SPEC.toml and -o RESULTS.csv".to_owned())),
    }
}

/// A time such as 10s, 500ms or 2min; a bare number counts seconds.
fn time(text: &str) -> Result<Duration, String> {
    let wrong = || format!("\"{}\" is not a time above 0, such as 10s, 500ms or 2min", quote(text));
    let end = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let (number, unit) = text.split_at(end);
    let factor = match unit {
        "s" | "" => 1.0,
        "ms" => 1e-3,
        "min" => 60.0,
        "h" => 3600.0,
        _ => return Err(wrong()),
    };
    let seconds = number.trim().parse::<f64>().map_err(|_| wrong())? * factor;
    Duration::try_from_secs_f64(seconds).ok().filter(|time| !time.is_zero()).ok_or_else(wrong)
}

/// Joins shards.
fn merged(parts: &[PathBuf], results: &ResultsArguments, console: &Console) -> Result<ExitCode, Failure> {
    let ResultsArguments { output, .. } = results;
    let parts: Vec<PathBuf> = parts.iter().map(|part| ensemble::found_rows(part)).collect();
    let rows = &ensemble::joined_rows(&parts, output);
    let inputs = parts.iter().fold(Inputs::default(), |inputs, part| inputs.with_results(part));
    let mut outputs = Outputs::beside(inputs, results.replacing);
    format::only(OUTPUT, output, Format::Csv)?;
    if rows != output {
        results.two_files()?;
        outputs.file(OUTPUT, output)?;
        outputs.file(OUTPUT, &sidecar::path(output))?;
    }
    outputs.file(OUTPUT, rows)?;
    if !stream::is_stream(rows) {
        outputs.file(OUTPUT, &sidecar::path(rows))?;
    }
    let merged = ensemble::join(&parts, output, results.existing())?;
    console.say(&format!(
        "{} of {} in {}",
        counted(merged.rows, "row"),
        counted(parts.len(), "shard"),
        stream::shown(rows)
    ));
    with_an_error(&merged.faults, console);
    fruitful(merged.faults.failures < merged.rows, console)
}

/// Warns of rows with an error.
fn with_an_error(faults: &FaultCounts, console: &Console) {
    if faults.total() > 0 {
        let reasons: Vec<String> = faults.reasons.iter().map(|(reason, n)| format!("{n} {reason}")).collect();
        let reasons = reasons.join(", ");
        console.warn(&[format!("{} with an error ({reasons}): the column error says why", faults.total())]);
    }
}

/// Success if some row has a quantity.
fn fruitful(is_fruitful: bool, console: &Console) -> Result<ExitCode, Failure> {
    if is_fruitful {
        return console.end();
    }
    Err(Failure::Incomplete("every row failed; the column error says why".to_owned()))
}

/// Reports the state of results.
fn checked(results: &Path, console: &Console) -> Result<ExitCode, Failure> {
    let results = &ensemble::found_rows(results);
    let found = check(results)?;
    let shard =
        if found.shard == Shard::WHOLE { String::new() } else { format!(" of shard {}", found.shard) };
    let state = if found.rows == found.of { "complete" } else { "the same command goes on from there" };
    let mut text =
        format!("{}: {} of {}{shard}, {state}\n", show_path(results), found.rows, counted(found.of, "row"));
    let faults: Vec<String> =
        found.faults.reasons.iter().map(|(reason, n)| format!("{n} {reason}")).collect();
    // Writing to a String cannot fail.
    let _ = write!(
        text,
        "hash     {}\ncolumns  {}\nerrors   {}\n",
        found.identity,
        found.columns.join(", "),
        if faults.is_empty() { "none".to_owned() } else { faults.join(", ") }
    );
    if found.is_torn {
        text.push_str("The last line is torn: the next run cuts it off.\n");
    }
    output::print(text)?;
    with_an_error(&found.faults, console);
    if found.rows < found.of {
        return Err(Failure::Incomplete(format!("{} of {} present", found.rows, counted(found.of, "row"))));
    }
    fruitful(!found.is_failure(), console)
}

impl ResultsArguments {
    fn existing(&self) -> Existing {
        if self.replacing.overwrite { Existing::Overwrite } else { Existing::GoOn }
    }

    /// Refuses an output that cannot hold the two files of an ensemble.
    fn two_files(&self) -> Result<(), Failure> {
        if stream::is_stream(&self.output) {
            let what = "an ensemble writes two files, the members and their statistics: name a file";
            return Err(Failure::Usage(format!("{OUTPUT} {}: {what}", stream::shown(&self.output))));
        }
        Ok(())
    }
}

/// The table of quantities as text.
fn quantities() -> String {
    let width = QUANTITIES.iter().map(|quantity| quantity.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for quantity in QUANTITIES {
        let control = if quantity.is_of_control() { "*" } else { " " };
        let (name, unit) = (quantity.name, quantity.unit.si().unwrap_or("1"));
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name:<width$} {control} {unit:<2} {}", quantity.meaning);
    }
    text.push_str(
        "\n* under path.control; with _displacement or _force after the name, under that control\n\
         Units are those of SI presets.\n",
    );
    text
}

/// The quantity that looks for inadmissible states.
const CHECK: &str = "inadmissible_share";

impl Sweep {
    fn run(&self) -> Result<ExitCode, Failure> {
        let console = self.messages.open();
        format::only(OUTPUT, &self.results.output, Format::Csv)?;
        let loaded = spec::load(&super::problem::store(), &self.spec, &self.changes.all())?;
        if loaded.spec.is_ensemble() {
            self.results.two_files()?;
        }
        let rows_in = ensemble::file_of_rows(&self.results.output, &loaded.spec);
        let subject = StatusSubject {
            results: output::shown(&rows_in),
            identity: spec::identity(&loaded.spec),
            shard: self.shard,
        };
        let status = self.look(&loaded, &subject, &rows_in)?;
        let spec = loaded.spec;
        let has_statistics = spec.is_ensemble() && self.shard == Shard::WHOLE;
        if has_statistics {
            ensemble::may_write(&self.results.output, &spec, self.results.existing())?;
        }
        let results = self.open(&rows_in, &spec, &console)?;
        console.warn(&spec.warnings());
        let stop = StopSignal::catch()?;
        let jobs = self.jobs.count();
        let [before, of] = [results.rows, self.shard.len(spec.rows)];
        let mut status = Reporter::begin(status, subject, [before, of])?;
        let bar = bar(of, before, console.is_quiet());
        let begun = Instant::now();
        let means = Means { jobs, row_limit: self.row_limit };
        let summary = compute(&spec, self.shard, results, means, &stop, |rows, faults| {
            status.tell(rows, faults);
            bar.set_position(rows);
            if faults > 0 {
                bar.set_message(format!("{faults} with an error"));
            }
        });
        bar.finish_and_clear();
        let summary = summary?;
        status.end(&summary);
        if let Some(trouble) = &status.trouble {
            console.warn(&[format!("the final status could not be written: {trouble}")]);
        }
        let took = begun.elapsed();
        if has_statistics {
            ensemble::summarize(&self.results.output)?;
        }
        self.tell(&spec, &summary, jobs, took, &console);
        match stop.signal().filter(|_| !summary.is_complete()) {
            // A shard in which every row fails may still be part of a good sweep.
            None => fruitful(self.shard != Shard::WHOLE || !summary.is_failure(), &console),
            Some(signal) => {
                let rows = summary.before + summary.now;
                let kept = if stream::is_stream(&self.results.output) {
                    ""
                } else {
                    ", all kept; the same command goes on from there"
                };
                let text = format!("stopped with {rows} of {}{kept}", counted(summary.of, "row"));
                Err(Failure::Interrupted { signal, text })
            }
        }
    }

    /// Checks all outputs; returns the status file where there is one.
    fn look(
        &self,
        loaded: &spec::LoadedSpec,
        subject: &StatusSubject,
        rows_in: &Path,
    ) -> Result<Option<OutputSink>, Failure> {
        let inputs = Inputs::default().with("the spec", &self.spec);
        let inputs = loaded.preset.iter().fold(inputs, |inputs, file| inputs.with("the preset", file));
        let inputs = spec::presets(&loaded.spec).fold(inputs, |inputs, preset| inputs.with_data(&preset));
        self.changes.beside(&loaded.spec.preset, loaded.spec.axes.iter().map(|axis| &*axis.key))?;
        let ResultsArguments { output, replacing } = &self.results;
        let mut outputs = Outputs::beside(inputs, *replacing);
        outputs.kept(OUTPUT, output)?;
        if !stream::is_stream(output) {
            outputs.kept(OUTPUT, &sidecar::path(output))?;
        }
        if rows_in != output {
            outputs.kept(OUTPUT, rows_in)?;
            outputs.kept(OUTPUT, &sidecar::path(rows_in))?;
        }
        self.status.as_ref().map(|file| subject.sink(file, &mut outputs, *replacing)).transpose()
    }

    /// Opens the results, once no other process writes them.
    fn open(&self, rows_in: &Path, spec: &Spec, console: &Console) -> Result<Output, Failure> {
        let mut has_told = false;
        loop {
            match Output::open(rows_in, spec, self.shard, self.results.existing()) {
                Err(OutputError::Busy { path }) if self.wait => {
                    if !has_told {
                        console.say(&format!("{path}: another pulloff is writing it; waiting for it to end"));
                        has_told = true;
                    }
                    sleep(PAUSE);
                }
                opened => return Ok(opened?),
            }
        }
    }

    /// The summary on standard error.
    fn tell(&self, spec: &Spec, summary: &RunSummary, jobs: usize, took: Duration, console: &Console) {
        let rows = summary.before + summary.now;
        let kept =
            if summary.before > 0 { format!(" ({} from before)", summary.before) } else { String::new() };
        let rows_in = ensemble::file_of_rows(&self.results.output, spec);
        let mut text =
            format!("{rows} of {} in {}{kept}", counted(summary.of, "row"), stream::shown(&rows_in));
        let seconds = took.as_secs_f64();
        if summary.now > 0 && seconds > 0.0 {
            let rate = summary.now as f64 / seconds;
            let threads = counted(jobs, "thread");
            // Writing to a String cannot fail.
            let _ = write!(text, "; {} s, {} rows/s on {threads}", short(seconds, 3), significant(rate, 3));
        }
        console.say(&text);
        console.note(sidecar::units(spec).as_deref());
        with_an_error(&summary.faults, console);
        let looks_for = |column: &QuantityColumn| column.quantity.name == CHECK;
        let is_unchecked = spec.columns.iter().any(|column| column.is_unchecked(&spec.preset));
        if is_unchecked && !spec.columns.iter().any(looks_for) {
            console.note(Some(&format!(
                "the rows follow one disc, and inadmissible states of it are not looked for: the quantity {CHECK} does"
            )));
        }
        if summary.is_complete()
            && self.shard == Shard::WHOLE
            && !stream::is_stream(&self.results.output)
            && let Some(line) = how_to_plot(spec, &self.results.output)
        {
            console.say(&line);
        }
    }
}

/// How to draw the results, if they form a curve or a map.
fn how_to_plot(spec: &Spec, results: &Path) -> Option<String> {
    let own = spec.axes.iter().filter(|axis| !spec.is_ensemble() || axis.count().is_some());
    let axes: Vec<&SweepAxis> = own.collect();
    let is_numeric = axes.iter().all(|axis| axis.is_numeric());
    let picture = match &axes[..] {
        [_] if is_numeric => "curve",
        axes @ [_, _] if is_numeric && spec.design.of_points() == Design::Grid => {
            axes.iter().all(|axis| axis.count() > Some(1)).then_some("map")?
        }
        _ => return None,
    };
    let file = show_name(&results.to_string_lossy());
    let quantity = spec.columns[0].name();
    Some(format!("to plot it: pulloff plot --sweep '{file}' --quantity {quantity} -o {picture}.svg"))
}

/// The progress bar on standard error; hidden where that is not a terminal.
fn bar(rows: u64, before: u64, hidden: bool) -> ProgressBar {
    let target = if hidden { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr_with_hz(5) };
    let bar = ProgressBar::with_draw_target(Some(rows), target);
    let style = "{wide_bar} {pos}/{len} rows  {per_sec}  {eta} left  {msg}";
    let style = ProgressStyle::with_template(style).unwrap_or_else(|_| ProgressStyle::default_bar());
    bar.set_style(style.progress_chars("=> "));
    // The rows that were there before say nothing about the rate.
    bar.set_position(before);
    bar.reset_eta();
    bar
}
