//! `pulloff sweep`: many problems into one file, and shards of it joined.

use super::sweep_status::Reporter;
use super::watch::Stop;
use super::{Failure, output};
use crate::store::stream;
use crate::sweep::check::Checked;
use crate::sweep::{
    Existing, Means, Output, OutputError, Shard, Summary, check, merge, run as compute, spec,
};
use clap::{Args, Subcommand};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pulloff_engine::report::number::{short, significant};
use pulloff_engine::sweep::axis::SweepAxis;
use pulloff_engine::sweep::spec::Design;
use pulloff_engine::sweep::{QUANTITIES, Spec};
use pulloff_engine::text::{quote, show_name, show_path};
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::thread::{available_parallelism, sleep};
use std::time::{Duration, Instant};

/// The arguments of `pulloff sweep`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    sweep: Option<Sweep>,
}

/// The subcommands of `pulloff sweep`.
#[derive(Debug, Subcommand)]
enum Command {
    /// Join the results of all shards of a sweep
    Merge {
        /// The results of each shard, in any order
        #[arg(required = true, value_name = "PART.csv")]
        parts: Vec<PathBuf>,
        /// Write to this file; - is standard output
        #[arg(short, value_name = "RESULTS.csv")]
        output: PathBuf,
        /// Replace results that are there
        #[arg(long)]
        overwrite: bool,
    },
    /// Look at results without computing: whether they are whole and of the sweep beside them
    Check {
        /// The results, of a sweep or of a shard
        #[arg(value_name = "RESULTS.csv")]
        results: PathBuf,
    },
    /// List the quantities that a sweep can compute
    Quantities,
}

/// What is swept, and where to.
#[derive(Debug, Args)]
struct Sweep {
    /// The spec: a preset, axes, quantities; - is standard input
    #[arg(value_name = "SPEC.toml")]
    spec: PathBuf,
    /// Write to this file, where a rerun goes on; - is standard output, where it begins anew
    #[arg(short, value_name = "RESULTS.csv")]
    output: PathBuf,
    /// Threads, at most 1024 [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Compute the part i of n alone, such as 3/8
    #[arg(long, value_name = "I/N", default_value_t = Shard::WHOLE)]
    shard: Shard,
    /// Give a row up after this time, such as 10s or 2min; its error says so
    #[arg(long, value_name = "TIME", value_parser = time)]
    row_limit: Option<Duration>,
    /// Say in this file how far it is: JSON, replaced as a whole about every second
    #[arg(long, value_name = "FILE")]
    status: Option<PathBuf>,
    /// Replace results that are there
    #[arg(long)]
    overwrite: bool,
    /// Wait while another pulloff writes the results, instead of giving up
    #[arg(long)]
    wait: bool,
}

/// How often a sweep that waits for another looks whether it has ended.
const PAUSE: Duration = Duration::from_millis(200);

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    match (&arguments.command, &arguments.sweep) {
        (Some(Command::Quantities), _) => {
            output::write(&quantities(), None)?;
            Ok(ExitCode::SUCCESS)
        }
        (Some(Command::Merge { parts, output, overwrite }), _) => {
            output::csv_only(output)?;
            let merged = merge(parts, output, existing(*overwrite))?;
            let (rows, shards) = (merged.rows, parts.len());
            say(&format!("{rows} rows of {shards} shards in {}", stream::shown(output)));
            fruitful(merged.failures < rows)
        }
        (Some(Command::Check { results }), _) => {
            let found = check(results)?;
            output::write(&checked(results, &found), None)?;
            fruitful(!found.is_failure())
        }
        (None, Some(sweep)) => sweep.run(),
        // clap asks for the arguments first.
        (None, None) => Err(Failure::Usage("sweep needs SPEC.toml and -o RESULTS.csv".to_owned())),
    }
}

/// A time such as 10s, 500ms or 2min; a bare number counts seconds.
fn time(text: &str) -> Result<Duration, String> {
    let wrong = || format!("\"{}\" is no time above 0 such as 10s, 500ms or 2min", quote(text));
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

/// What results are, in words.
fn checked(results: &Path, found: &Checked) -> String {
    let shard =
        if found.shard == Shard::WHOLE { String::new() } else { format!(" of shard {}", found.shard) };
    let state = if found.rows == found.of { "complete" } else { "the same command goes on from there" };
    let mut text = format!("{}: {} of {} rows{shard}, {state}\n", show_path(results), found.rows, found.of);
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
    text
}

/// Success where some row has a quantity.
fn fruitful(is_fruitful: bool) -> Result<ExitCode, Failure> {
    if is_fruitful {
        return Ok(ExitCode::SUCCESS);
    }
    Err(Failure::Incomplete("every row failed; the column error says why".to_owned()))
}

fn existing(overwrite: bool) -> Existing {
    if overwrite { Existing::Overwrite } else { Existing::GoOn }
}

fn say(text: &str) {
    let _ = writeln!(io::stderr(), "pulloff: {text}");
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
        "\n* under path.control; with _displacement or _force behind the name, under that control\n\
         Units are those of SI presets.\n",
    );
    text
}

impl Sweep {
    fn run(&self) -> Result<ExitCode, Failure> {
        output::csv_only(&self.output)?;
        let spec = spec::load(&super::problem::store(), &self.spec)?;
        let results = self.open(&spec)?;
        let stop = Stop::catch()?;
        let cores = || available_parallelism().map_or(1, NonZeroUsize::get);
        let jobs = self.jobs.map_or_else(cores, usize::from);
        let [before, of] = [results.rows, self.shard.len(spec.rows)];
        let files = [&*self.spec, &*self.output];
        let mut status = Reporter::begin(self.status.as_deref(), files, self.shard, [before, of])?;
        let bar = bar(of, before);
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
            say(&format!("warning: the status is not that of the end: {trouble}"));
        }
        self.tell(&spec, &summary, jobs, begun.elapsed());
        match stop.signal().filter(|_| !summary.is_complete()) {
            // A shard of failures alone may be a part of a good sweep.
            None => fruitful(self.shard != Shard::WHOLE || !summary.is_failure()),
            Some(signal) => {
                let rows = summary.before + summary.now;
                let kept = if stream::is_stream(&self.output) {
                    ""
                } else {
                    ", all kept; the same command goes on from there"
                };
                let text = format!("stopped with {rows} of {} rows{kept}", summary.of);
                Err(Failure::Interrupted { signal, text })
            }
        }
    }

    /// The results, once nobody else writes them.
    fn open(&self, spec: &Spec) -> Result<Output, Failure> {
        let mut has_told = false;
        loop {
            match Output::open(&self.output, spec, self.shard, existing(self.overwrite)) {
                Err(OutputError::Busy { path }) if self.wait => {
                    if !has_told {
                        say(&format!("{path}: another pulloff is writing it; waiting for its end"));
                        has_told = true;
                    }
                    sleep(PAUSE);
                }
                opened => return Ok(opened?),
            }
        }
    }

    /// The summary on standard error.
    fn tell(&self, spec: &Spec, summary: &Summary, jobs: usize, took: Duration) {
        let rows = summary.before + summary.now;
        let kept =
            if summary.before > 0 { format!(" ({} from before)", summary.before) } else { String::new() };
        let mut text = format!("{rows} of {} rows in {}{kept}", summary.of, stream::shown(&self.output));
        let seconds = took.as_secs_f64();
        if summary.now > 0 && seconds > 0.0 {
            let rate = summary.now as f64 / seconds;
            let threads = if jobs == 1 { "1 thread".to_owned() } else { format!("{jobs} threads") };
            // Writing to a String cannot fail.
            let _ = write!(text, "; {} s, {} rows/s on {threads}", short(seconds, 3), significant(rate, 3));
        }
        say(&text);
        let faults = summary.faults.total();
        if faults > 0 {
            let reasons: Vec<String> =
                summary.faults.reasons.iter().map(|(reason, n)| format!("{n} {reason}")).collect();
            say(&format!("{faults} with an error: {}", reasons.join(", ")));
        }
        if summary.is_complete()
            && self.shard == Shard::WHOLE
            && !stream::is_stream(&self.output)
            && let Some(line) = how_to_plot(spec, &self.output)
        {
            say(&line);
        }
    }
}

/// How to draw it, where it is a curve or a map.
fn how_to_plot(spec: &Spec, results: &Path) -> Option<String> {
    let is_numeric = spec.axes.iter().all(SweepAxis::is_numeric);
    let picture = match &spec.axes[..] {
        [_] if is_numeric => "curve",
        axes @ [_, _] if is_numeric && spec.design == Design::Grid => {
            axes.iter().all(|axis| axis.count() > Some(1)).then_some("map")?
        }
        _ => return None,
    };
    let file = show_name(&results.to_string_lossy());
    let quantity = spec.columns[0].name();
    Some(format!("to plot it: pulloff plot --sweep '{file}' --quantity {quantity} -o {picture}.svg"))
}

/// The progress on standard error; none where that is no terminal.
fn bar(rows: u64, before: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(rows), ProgressDrawTarget::stderr_with_hz(5));
    let style = "{wide_bar} {pos}/{len} rows  {per_sec}  {eta} left  {msg}";
    let style = ProgressStyle::with_template(style).unwrap_or_else(|_| ProgressStyle::default_bar());
    bar.set_style(style.progress_chars("=> "));
    // What was there before says nothing of the rate.
    bar.set_position(before);
    bar.reset_eta();
    bar
}
