//! `pulloff pull`: one disc pulled at a rate, and how long it bears dead loads.

use super::Failure;
use super::computed::{Computed, Opened};
use super::format::Format;
use super::watch::StopSignal;
use clap::{Args, ValueEnum};
use pulloff_engine::preset::Preset;
use pulloff_engine::preset::edge::RATE;
use pulloff_engine::report::pull::{AskedPulls, COLUMNS, FAILURE_COLUMNS, MOMENT_COLUMNS};
use pulloff_engine::report::{PullReport, columns, json, table};
use pulloff_engine::sweep::axis::{AxisValues, SweepAxis};
use pulloff_engine::text::quote;
use pulloff_engine::units::range_ends;
use std::process::ExitCode;

/// The key as whose value a dead load is read.
const FORCE: &str = "path.start_force";

/// The largest number of rates in one range.
const RATES: u64 = 10_000;

/// The arguments of `pulloff pull`.
#[derive(Debug, Args)]
pub struct PullArguments {
    /// Pull at this rate of what is controlled until the bodies are apart (repeatable; instead of path.rate and
    /// path.steps); log:FROM..TO:COUNT for logarithmically spaced rates
    #[arg(long, value_name = "RATE")]
    rate: Vec<String>,
    /// Find how long the contact bears this dead load, a negative force for a pull (repeatable)
    #[arg(long, value_name = "FORCE", allow_hyphen_values = true)]
    hold_force: Vec<String>,
    /// What the rows of a table or of CSV are; JSON has the runs
    #[arg(long, value_enum, default_value_t = PullRows::Runs)]
    rows: PullRows,
    #[command(flatten)]
    computed: Computed,
}

/// What one row describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum PullRows {
    /// The pulls, or the dead loads where nothing is pulled
    Runs,
    /// Every moment of every pull
    Moments,
}

pub fn run(arguments: &PullArguments) -> Result<ExitCode, Failure> {
    let Opened { console, format, preset, sink } = arguments.computed.open(Format::Table)?;
    let preset = &preset;
    let mut asked = AskedPulls::default();
    for text in &arguments.rate {
        asked.rates.extend(rates(preset, text)?);
    }
    for text in &arguments.hold_force {
        asked.loads.push(number(preset, "--hold-force", FORCE, text)?);
    }
    if arguments.rows == PullRows::Moments && asked.rates.is_empty() && !asked.loads.is_empty() {
        return Err(Failure::Usage("--rows moments: a dead load has no moments; give --rate too".to_owned()));
    }
    let stop = StopSignal::catch()?;
    let report = PullReport::compute(preset, &asked, &console.bar(Some(&stop)))?;
    console.warn(&report.warnings);
    if preset.edge.exponent.is_some() && preset.edge.reference_speed.is_none() {
        console.note(Some("edge.reference_speed is not set: v0 is 1"));
    }
    if format == Format::Csv {
        let columns = match (arguments.rows, report.runs.is_empty()) {
            (PullRows::Moments, _) => MOMENT_COLUMNS,
            (PullRows::Runs, true) => FAILURE_COLUMNS,
            (PullRows::Runs, false) => COLUMNS,
        };
        console.note(columns::units(columns, preset.path.control, &preset.units).as_deref());
        if !report.runs.is_empty() && !report.failures.is_empty() {
            console.note(Some(
                "the times to failure under --hold-force are not in this table: leave --rate out",
            ));
        }
    }
    let rows = || if arguments.rows == PullRows::Moments { report.moments() } else { report.table() };
    sink.write(match format {
        Format::Table if arguments.rows == PullRows::Runs => report.text(),
        Format::Table => table::rows(&rows()?),
        Format::Csv => rows()?.csv()?,
        Format::Json => json(&report)?,
    })?;
    console.end()
}

/// The rates given by one `--rate`.
fn rates(preset: &Preset, text: &str) -> Result<Vec<f64>, Failure> {
    let one = |text: &str| {
        let rate = number(preset, "--rate", RATE, text)?;
        let usable = rate > 0.0 && rate.is_finite();
        usable.then_some(rate).ok_or_else(|| wrong(text, "a rate must be above 0"))
    };
    let Some(range) = text.strip_prefix("log:") else { return Ok(vec![one(text)?]) };
    let expected = "expected log:FROM..TO:COUNT, as in log:1e-6..1e2:100";
    let (ends, count) = range.rsplit_once(':').ok_or_else(|| wrong(text, expected))?;
    let (from, to) = range_ends(ends).ok_or_else(|| wrong(text, expected))?;
    let count: u64 = count.trim().parse().map_err(|_| wrong(text, expected))?;
    if !(2..=RATES).contains(&count) {
        return Err(wrong(text, &format!("the count must be a whole number from 2 to {RATES}")));
    }
    let (from, to) = (one(&from)?, one(to)?);
    let axis = SweepAxis { key: RATE.to_owned(), points: AxisValues::Logarithmic { from, to, count } };
    Ok((0..count).filter_map(|k| axis.value(k)?.as_number()).collect())
}

/// Parses a number as a value of `key`.
fn number(preset: &Preset, option: &str, key: &str, text: &str) -> Result<f64, Failure> {
    let row = preset.row(key).ok_or_else(|| wrong(text, "the preset has no such number"))?;
    preset.number(&row, text).map_err(|invalid| Failure::Usage(format!("{option}: {invalid}")))
}

fn wrong(text: &str, why: &str) -> Failure {
    Failure::Usage(format!("--rate: {}: {why}", quote(text)))
}
