//! `pulloff map`: where snaps begin, as lines over two parameters, or the limit points over one.

use super::Failure;
use super::console::{Console, Messages};
use super::format::{Format, FormatArgument};
use super::output::{Destination, shown};
use super::problem::ProblemArguments;
use super::watch::StopSignal;
use crate::explorer::map_axes::typed;
use crate::plot::map::{MapChart, MapChartError};
use crate::plot::{Width, lines, svg};
use crate::print::PictureFormat;
use crate::store::stream;
use crate::sweep::SweepResults;
use clap::Args;
use pulloff_engine::preset::changes::differences;
use pulloff_engine::preset::{Preset, groups, read};
use pulloff_engine::report::map::Ordinate;
use pulloff_engine::report::{MapReport, json, table};
use pulloff_engine::stability::MapAxis;
use pulloff_engine::text::quote;
use std::path::PathBuf;
use std::process::ExitCode;

/// The arguments of `pulloff map`.
#[derive(Debug, Args)]
pub struct MapArguments {
    #[command(flatten)]
    problem: ProblemArguments,
    /// The parameter on the x axis and its range: a key of the preset, a group, or compliance, which is 1/k from 0
    /// (displacement) to inf (a dead load); log:FROM..TO for a logarithmic axis
    #[arg(long, value_name = "KEY=FROM..TO", allow_hyphen_values = true)]
    x_key: String,
    /// A second parameter on the y axis: draw the lines of cusps and landings, and count the snaps in every cell
    #[arg(long, value_name = "KEY=FROM..TO", allow_hyphen_values = true)]
    y_key: Option<String>,
    /// Instead of a second parameter, plot the limit points over the x axis: their control, approach or force
    #[arg(long, value_enum, conflicts_with = "y_key")]
    y: Option<MapOrdinate>,
    /// Draw the lines over the map of a sweep over the same two keys
    #[arg(long, value_name = "RESULTS.csv", requires = "y_key")]
    over: Option<PathBuf>,
    /// The column of these results to draw
    #[arg(long, value_name = "COLUMN", default_value = "snaps", requires = "over")]
    quantity: String,
    /// The width of a figure on paper in millimetres, or one or two columns of a journal (86 and 178 mm)
    #[arg(long, value_name = "WIDTH", default_value = "one-column", value_parser = super::plot::width)]
    width: Width,
    #[command(flatten)]
    format: FormatArgument,
    #[command(flatten)]
    destination: Destination,
    #[command(flatten)]
    messages: Messages,
}

/// The quantity plotted over a single parameter.
#[derive(Debug, Clone, Copy, PartialEq, clap::ValueEnum)]
enum MapOrdinate {
    Control,
    Approach,
    Force,
}

/// The columns and rows of cells in which snaps are counted.
const CELLS: [u32; 2] = [48, 36];

/// The kind of output.
#[derive(Debug, Clone, Copy, PartialEq)]
enum MapOutput {
    Rows(Format),
    Figure(PictureFormat),
}

pub fn run(arguments: &MapArguments) -> Result<ExitCode, Failure> {
    let console = arguments.messages.open();
    let written = arguments.written()?;
    let loaded = arguments.problem.load_for(true, &console)?;
    let inputs = arguments.problem.inputs(&loaded);
    let inputs = arguments.over.iter().fold(inputs, |inputs, path| inputs.with_results(path));
    let sink = arguments.destination.sink(inputs)?;
    let preset = loaded.preset;
    let x = axis("--x-key", &arguments.x_key, &preset)?;
    let y = match (&arguments.y_key, arguments.y) {
        (Some(key), _) => Ordinate::Key(axis("--y-key", key, &preset)?),
        (None, Some(MapOrdinate::Approach)) => Ordinate::Approach,
        (None, Some(MapOrdinate::Force)) => Ordinate::Force,
        (None, Some(MapOrdinate::Control)) => Ordinate::Control,
        (None, None) => {
            let what = "map needs a y axis: --y-key KEY=FROM..TO, or --y control, approach or force";
            return Err(Failure::Usage(what.to_owned()));
        }
    };
    let axes = [Some(&x), if let Ordinate::Key(y) = &y { Some(y) } else { None }];
    arguments.problem.changes.beside(&preset, axes.into_iter().flatten().map(|axis| &*axis.key))?;
    let over = arguments.over(&preset, &x, &y, &console)?;
    let stop = StopSignal::catch()?;
    let report = MapReport::compute(&preset, x, &y, CELLS, &console.bar(Some(&stop)))?;
    console.warn(&report.notes);
    if let Some(onset) = &report.onset {
        let smallest = onset.amplitude_over_wavelength;
        console.note(Some(&format!(
            "under {} control the smallest A/lambda at which this preset snaps is {smallest:.6}",
            onset.control
        )));
    }
    sink.write(match written {
        MapOutput::Rows(Format::Table) => table::rows(&report.table()?).into_bytes(),
        MapOutput::Rows(Format::Csv) => report.csv()?.into_bytes(),
        MapOutput::Rows(Format::Json) => json(&report)?.into_bytes(),
        MapOutput::Figure(print) => {
            let figure = lines::figure(&report, &preset);
            let picture = match over {
                Some(map) => MapChart { lines: figure.lines, ..map }.svg(arguments.width),
                None => svg::svg(&figure, arguments.width),
            };
            print.bytes(&picture)?
        }
    })?;
    console.end()
}

impl MapArguments {
    /// Chosen by the extension of the file; a figure where results are drawn under the lines.
    fn written(&self) -> Result<MapOutput, Failure> {
        let file = self.destination.path();
        let figure = self.format.of_figure(file)?;
        let is_drawn = self.over.is_some() && self.format.format.is_none() && stream::is_stream(file);
        if let Some(print) = figure.or(is_drawn.then_some(PictureFormat::Svg)) {
            return Ok(MapOutput::Figure(print));
        }
        if self.over.is_some() {
            let what =
                "--over: results of a sweep are drawn under the lines of a figure: -o FILE.svg, .png or .pdf";
            return Err(Failure::Usage(what.to_owned()));
        }
        Ok(MapOutput::Rows(self.format.beside_figures(file, Format::Csv)?))
    }

    /// The map of a sweep, whose axes must be those of the lines.
    fn over(
        &self,
        preset: &Preset,
        x: &MapAxis,
        y: &Ordinate,
        console: &Console,
    ) -> Result<Option<MapChart>, Failure> {
        let Some(path) = &self.over else { return Ok(None) };
        let mut results = SweepResults::open(path).map_err(MapChartError::from)?;
        // The lines are in the units of this preset; the sweep may be shown in others.
        for column in &mut results.columns {
            let row = preset.row(&column.name);
            column.shown = row
                .and_then(|row| row.unit_in(&preset.units).map(ToString::to_string))
                .or(column.shown.take());
        }
        if results.axes != [x.key.as_str(), y.name()] {
            return Err(Failure::Usage(format!(
                "--over {}: is a sweep over {}, not over {} and {}",
                shown(path),
                results.axes.join(" and "),
                x.key,
                y.name()
            )));
        }
        let Ok(swept) = read("the swept preset", &results.preset) else {
            let why = "a file of its preset is not found from here: whether it is a sweep of the same problem is not checked";
            console.warn(&[format!("--over {}: {why}", shown(path))]);
            return Ok(Some(MapChart::of(&results, &results.axes, &self.quantity)?));
        };
        if let Some(other) = other_problem(&swept, preset, x, y) {
            let what = format!("--over {}: is a sweep of another problem: {other}", shown(path));
            return Err(Failure::Usage(what));
        }
        Ok(Some(MapChart::of(&results, &results.axes, &self.quantity)?))
    }
}

/// In which value of the problem the swept preset differs from the present one; `None` if they differ in
/// the values of the axes at most. How the pressure is found, and where a path begins and ends, may differ.
fn other_problem(swept: &Preset, preset: &Preset, x: &MapAxis, y: &Ordinate) -> Option<String> {
    let at_start = |preset: &Preset| {
        let mut preset = preset.clone();
        let axes = [Some(x), if let Ordinate::Key(y) = y { Some(y) } else { None }];
        for axis in axes.into_iter().flatten() {
            // The compliance is no key.
            let _ = preset.set(&axis.key, axis.range[0].into());
        }
        preset
    };
    let [swept, own] = [swept, preset].map(at_start);
    let is_device = |key: &str| key == "path.control" && [x.key.as_str(), y.name()].contains(&"compliance");
    let follows =
        |key: &str| [x.key.as_str(), y.name()].iter().any(|axis| groups::changed(axis).contains(&key));
    let problem = |key: &str| {
        let parts = ["gap.", "material.", "path.control", "units"];
        parts.iter().any(|part| key.starts_with(part)) && !is_device(key) && !follows(key)
    };
    let (key, here) = differences(&swept, &own).into_iter().find(|(key, _)| problem(key))?;
    let there = swept.get(&key).map_or_else(|| "not given".to_owned(), |value| value.to_string());
    Some(format!("{key} is {there} there, and {here} here"))
}

/// An axis, as typed after an option.
fn axis(flag: &str, text: &str, preset: &Preset) -> Result<MapAxis, Failure> {
    typed(preset, text).map_err(|why| Failure::Usage(format!("{flag} {}: {why}", quote(text))))
}
