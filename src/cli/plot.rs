//! `pulloff plot`: a view of the explorer as a figure for print.

use super::Failure;
use super::console::{Console, Messages};
use super::measured::{ReadingArguments, attach, typed};
use super::output::{Destination, Inputs, OUTPUT, OutputSink, Outputs, shown as shown_path};
use super::problem::ProblemArguments;
use crate::explorer::fitting::Distances;
use crate::explorer::map_axes::MapAxes;
use crate::explorer::maps::MapData;
use crate::explorer::profile::{Ask, StateInside};
use crate::explorer::pulls::PullData;
use crate::explorer::reach::no_spring;
use crate::explorer::speeds::{SpeedsData, untimed};
use crate::explorer::{Axes, CurveData, Overlays, Staged, View};
use crate::figure::measured::MeasuredMarks;
use crate::figure::range::RangeError;
use crate::figure::{Figure, Range, Sign, Subject};
use crate::plot::map::{MapChart, MapChartError};
use crate::plot::{Width, series, svg, table};
use crate::print::{FormatError, PictureFormat};
use crate::store::stream;
use crate::sweep::SweepResults;
use crate::sweep::record::{ROW, statistic};
use clap::{Args, ValueEnum};
use pulloff_engine::case::Case;
use pulloff_engine::fit::doubt_of_wave;
use pulloff_engine::preset::{Preset, data};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::jump::EdgeDirection;
use pulloff_engine::quasistatic::{Losses, State};
use pulloff_engine::report::PathReport;
use pulloff_engine::report::path::Extent;
use pulloff_engine::report::pull::missing;
use pulloff_engine::units::Quantity;
use pulloff_engine::units::number::said;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Arc, LazyLock};

/// The arguments of `pulloff plot`.
#[derive(Debug, Args)]
pub struct PlotArguments {
    #[command(flatten)]
    problem: ProblemArguments,
    /// Draw the results of a sweep instead of a view of a preset: a curve over its one axis, or a map over its two
    #[arg(long, value_name = "RESULTS.csv", conflicts_with_all = ["preset", "assignments", "control", "view", "theory", "raw", "contact_radius", "columns", "segment", "free_part", "signs", "skip"])]
    sweep: Option<PathBuf>,
    /// The column of the results to draw [default: enhancement, or the only quantity]
    #[arg(long, value_name = "COLUMN")]
    quantity: Option<String>,
    /// What to draw
    #[arg(long, value_enum, default_value = "force-approach")]
    view: ViewName,
    /// Also draw the exact solution and the envelope of Kesari and Lew, where they exist
    #[arg(long)]
    theory: bool,
    /// Axes in the preset's own units instead of P/Pc and s/lambda
    #[arg(long)]
    raw: bool,
    /// The state whose pressure, gap or energy is drawn, by its contact radius: a number, in metres in an SI preset, or
    /// with a unit, such as 1.2mm; the start when left out
    #[arg(long, value_name = "RADIUS")]
    contact_radius: Option<String>,
    /// The part of the x axis to show, in its units as drawn; one end may be left out: --x ..0.1
    #[arg(long, value_name = "LO..HI", allow_hyphen_values = true)]
    x: Option<Range>,
    /// The part of the y axis to show, in its units as drawn; one end may be left out: --y -1..
    #[arg(long, value_name = "LO..HI", allow_hyphen_values = true)]
    y: Option<Range>,
    /// Draw the points of a measured curve behind the view
    #[arg(long, value_name = "FILE", conflicts_with = "sweep")]
    measured: Option<PathBuf>,
    #[command(flatten)]
    reading: ReadingArguments,
    /// The x of the measured curve at which the approach is zero
    #[arg(long, value_name = "LENGTH", conflicts_with = "sweep", allow_hyphen_values = true)]
    offset: Option<String>,
    /// The reading of the measured curve at zero force [default: the median of its free part]
    #[arg(long, value_name = "FORCE", conflicts_with = "sweep", allow_hyphen_values = true)]
    baseline: Option<String>,
    /// The width of the figure on paper in millimetres, or one-column or two-columns of a journal (86 and 178 mm)
    #[arg(long, value_name = "WIDTH", default_value = "one-column", value_parser = width)]
    width: Width,
    /// Also write the data, to FILE.csv
    #[arg(long, requires = "output")]
    data: bool,
    #[command(flatten)]
    destination: Destination,
    #[command(flatten)]
    messages: Messages,
}

/// Where the figure and its data go.
struct PlotSinks {
    figure: OutputSink,
    data: Option<OutputSink>,
}

/// The column of the results that is drawn by default.
const QUANTITY: &str = "enhancement";

/// A view by its name in the explorer.
#[derive(Debug, Clone, Copy)]
struct ViewName(View);

impl ValueEnum for ViewName {
    fn value_variants<'a>() -> &'a [Self] {
        // The walk and study views need a walk or a selection, which do not exist here; sweeps serve instead.
        static ALL: LazyLock<Vec<ViewName>> = LazyLock::new(|| {
            let all = View::ALL.into_iter().filter(|view| !matches!(view, View::Walk | View::Study));
            all.map(ViewName).collect()
        });
        &ALL
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        Some(clap::builder::PossibleValue::new(self.0.name()))
    }
}

pub(super) fn width(text: &str) -> Result<Width, String> {
    let (lo, hi) = (Width::RANGE.start(), Width::RANGE.end());
    match text {
        "one-column" => Some(Width::ONE_COLUMN),
        "two-columns" => Some(Width::TWO_COLUMNS),
        text => text.trim_end_matches("mm").trim().parse().ok().and_then(Width::millimetres),
    }
    .ok_or_else(|| format!("expected one-column, two-columns, or a width from {lo} to {hi} mm"))
}

pub fn run(arguments: &PlotArguments) -> Result<ExitCode, Failure> {
    let console = arguments.messages.open();
    let format = format(arguments.destination.path())?;
    if let Some(path) = &arguments.sweep {
        arguments.draw_sweep(path, format, &console)?;
        return console.end();
    }
    if arguments.quantity.is_some() {
        let what = "--quantity: is a column of a sweep's results; give them with --sweep RESULTS.csv";
        return Err(Failure::Usage(what.to_owned()));
    }
    let loaded = arguments.problem.load_for(arguments.measured.is_some(), &console)?;
    let inputs = arguments.problem.inputs(&loaded);
    let measured = arguments.measured.iter();
    let sinks =
        arguments.sinks(measured.fold(inputs, |inputs, path| inputs.with("the measured curve", path)))?;
    let mut preset = loaded.preset;
    arguments.lay_points(&console, &mut preset)?;
    arguments.fits(&preset)?;
    let curve = CurveData::compute(&preset, &Staged::unwatched())?;
    let curve = Arc::new(curve.checked(&Unwatched).unwrap_or(curve));
    console.warn(&curve.base.warnings);
    let figure = arguments.part(arguments.figure(&curve, &preset, &console)?)?;
    let picture = svg::svg(&figure, arguments.width);
    sinks.figure.write(format.bytes(&picture)?)?;
    if let Some(sink) = sinks.data {
        sink.write(table::csv(&figure)?)?;
    }
    console.end()
}

impl PlotArguments {
    /// Draws the results of a sweep, and writes them as they are drawn where they are wanted.
    fn draw_sweep(&self, path: &Path, format: PictureFormat, console: &Console) -> Result<(), Failure> {
        let sinks = self.sinks(Inputs::default().with_results(path))?;
        let (picture, data) = self.of_sweep(path, console)?;
        sinks.figure.write(format.bytes(&picture)?)?;
        if let Some((sink, data)) = sinks.data.zip(data) {
            sink.write(data)?;
        }
        Ok(())
    }

    /// The view of a curve as a figure, with what the view needs besides.
    fn figure(&self, curve: &Arc<CurveData>, preset: &Preset, console: &Console) -> Result<Figure, Failure> {
        let view = self.view.0;
        if view.is_state() || view == View::Stability {
            console.warn(&curve.case.warning_of_dead_band().into_iter().collect::<Vec<_>>());
        }
        let inside = if view.is_state() {
            Some(inside(curve, self.contact_radius.as_deref(), self.theory)?)
        } else if self.contact_radius.is_some() {
            return Err(Failure::Usage(format!(
                "--contact-radius: {} shows the whole curve; pressure, gap and energy show a state",
                view.name()
            )));
        } else {
            None
        };
        let cycle = if view.is_cycle() {
            Some(PathReport::cycle(
                preset,
                None,
                Extent { losses: Losses::Once, admissibility: true },
                &Unwatched,
            )?)
        } else {
            None
        };
        console.warn(cycle.as_ref().map_or(&[][..], |cycle| &cycle.warnings));
        let map = || MapData::of(preset, &MapAxes::usual(preset), &Unwatched);
        let found = (view == View::Map).then(map).flatten();
        let map = found.as_ref().map(MapData::report);
        let shows_pull = view.is_curve() || view == View::ForceTime;
        let pull =
            (shows_pull && missing(preset).is_none()).then(|| PullData::of(preset, &Unwatched)).flatten();
        let overlays = Overlays { smooth: true, exact: self.theory, envelope: self.theory };
        let axes = if self.raw { Axes::Raw } else { Axes::Reduced };
        let measured = MeasuredMarks::of(preset).and_then(Result::ok);
        let distances =
            (view == View::Residuals && preset.data.source.is_some()).then(|| Distances::of(preset).found);
        let speeds = (view == View::Speeds).then(|| SpeedsData::of(preset, &Unwatched)).flatten();
        let subject = Subject {
            measured,
            distances: distances.as_ref(),
            speeds: speeds.as_ref(),
            inside: inside.as_ref(),
            cycle: cycle.as_ref(),
            pull: pull.as_ref(),
            map,
            axes,
            ..Subject::alone(curve, overlays)
        };
        let figure = subject.figure(view);
        if let Some(why) = &figure.missing {
            return Err(Failure::Usage(format!("--view {}: {why}", view.name())));
        }
        let is_drawn = figure.marks.iter().any(|mark| matches!(mark.sign, Sign::Measured { .. }));
        if self.measured.is_some() && !is_drawn {
            return Err(Failure::Usage(format!(
                "--measured: the file does not have the columns of {}",
                view.name()
            )));
        }
        Ok(figure)
    }

    /// Gives the preset the requested measured curve, and reports what was found in its own.
    fn lay_points(&self, console: &Console, preset: &mut Preset) -> Result<(), Failure> {
        attach(preset, self.measured.as_deref(), &self.reading.said()?)?;
        for (flag, key, text) in
            [("--offset", data::OFFSET, &self.offset), ("--baseline", data::BASELINE, &self.baseline)]
        {
            let Some(text) = text else { continue };
            let number = typed(preset, flag, key, text)?;
            preset.set(key, number.into()).map_err(|invalid| Failure::Usage(format!("{flag}: {invalid}")))?;
        }
        let Some(source) = &preset.data.source else { return Ok(()) };
        let wrong = |error: String| Failure::Usage(format!("{}: {error}", shown_path(&source.path())));
        let notes = preset.notes_of_reading().map_err(wrong)?;
        let branches = source.branches(&preset.reading()).map_err(wrong)?;
        for text in notes.iter().chain(&branches.notes) {
            console.note(Some(text));
        }
        console.warn(branches.swapped().as_slice());
        console.warn(branches.doubt().as_slice());
        console.note(doubt_of_wave(preset, &branches).as_deref());
        Ok(())
    }

    /// The picture of the results of a sweep, with its data where they are wanted.
    fn of_sweep(&self, path: &Path, console: &Console) -> Result<(String, Option<String>), Failure> {
        let results = SweepResults::open(path).map_err(MapChartError::from)?;
        let quantity = self.quantity_of(&results)?;
        let partial = results.partial().map_err(MapChartError::from)?;
        let partial = partial.map(|has| format!("--sweep {has}: the figure shows no others"));
        let without = results.without(quantity).map_err(MapChartError::from)?;
        let warn = || {
            console.warn(partial.as_slice());
            console.warn(without.as_ref().map(|rows| format!("--sweep {rows}")).as_slice());
        };
        let axis = match &results.axes[..] {
            [] => {
                let what = "--sweep: an ensemble without an axis has one row of statistics and nothing to draw it over";
                return Err(Failure::Usage(what.to_owned()));
            }
            [axis] => axis,
            // Values drawn at random form no grid.
            [axis, ..] if results.is_random => axis,
            axes => {
                let refused = [("--x", self.x.is_some()), ("--y", self.y.is_some()), ("--data", self.data)];
                if let Some((flag, _)) = refused.into_iter().find(|(_, is_given)| *is_given) {
                    let what =
                        "is for a sweep over one axis: a map has the whole grid, which the results hold";
                    return Err(Failure::Usage(format!("{flag}: {what}")));
                }
                let median = statistic(quantity, "q50");
                let column = if results.has_statistics_of(quantity) { &median } else { quantity };
                let chart = MapChart::of(&results, axes, column)?;
                warn();
                return Ok((chart.svg(self.width), None));
            }
        };
        let figure = self.part(series::figure(&results, axis, quantity)?)?;
        warn();
        let data = if self.data { Some(table::csv(&figure)?) } else { None };
        Ok((svg::svg(&figure, self.width), data))
    }

    /// The quantity to draw: the requested one, the usual one, or the only one.
    fn quantity_of<'a>(&'a self, results: &'a SweepResults) -> Result<&'a str, Failure> {
        let all = results.quantities();
        match (self.quantity.as_deref(), &all[..]) {
            (Some(quantity), all) if quantity == ROW || results.axes.iter().any(|axis| axis == quantity) => {
                let what = if quantity == ROW { "numbers the rows" } else { "is an axis of the sweep" };
                let others = all.join(", ");
                Err(Failure::Usage(format!("--quantity {quantity}: {what}; choose one of {others}")))
            }
            (Some(quantity), _) => Ok(quantity),
            (None, [only]) => Ok(only),
            (None, all) if all.contains(&QUANTITY) => Ok(QUANTITY),
            (None, all) => Err(Failure::Usage(format!(
                "--sweep: the results have no {QUANTITY}, which is drawn by default; choose with --quantity one of {}",
                all.join(", ")
            ))),
        }
    }

    /// The requested part of the figure.
    fn part(&self, mut figure: Figure) -> Result<Figure, Failure> {
        let refused = |axis: &'static str, range: Range| {
            move |error: RangeError| Failure::Usage(format!("--{axis} {range}: {error}"))
        };
        if let Some(range) = self.x {
            figure = figure.across(range).map_err(refused("x", range))?;
        }
        if let Some(range) = self.y {
            figure = figure.upwards(range).map_err(refused("y", range))?;
        }
        Ok(figure)
    }

    /// Refuses a view for which this preset has no data.
    fn fits(&self, preset: &Preset) -> Result<(), Failure> {
        let view = self.view.0;
        let why = match view {
            View::ForcePosition => no_spring(preset),
            View::ForceTime => missing(preset).map(|why| why.to_string()),
            View::Residuals | View::Speeds if preset.data.source.is_none() => Some(
                "there are no measured points: --measured FILE or data.file of the preset names them"
                    .to_owned(),
            ),
            View::Speeds => untimed(preset),
            _ => None,
        };
        why.map_or(Ok(()), |why| Err(Failure::Usage(format!("--view {}: {why}", view.name()))))
    }

    /// The outputs of the command.
    fn sinks(&self, inputs: Inputs) -> Result<PlotSinks, Failure> {
        let mut outputs = Outputs::beside(inputs, self.destination.replacing);
        let path = self.destination.path();
        let figure = outputs.file(OUTPUT, path)?;
        if self.data && stream::is_stream(path) {
            let what = "--data: the data go beside the figure's file; name it with -o FILE";
            return Err(Failure::Usage(what.to_owned()));
        }
        let beside = self.data.then(|| outputs.file("--data", &path.with_extension("csv")));
        Ok(PlotSinks { figure, data: beside.transpose()? })
    }
}

/// The interior of the state with this contact radius, or of the start.
fn inside(curve: &Arc<CurveData>, radius: Option<&str>, exact: bool) -> Result<StateInside, Failure> {
    let (case, equilibrium) = (&curve.case, &curve.base.curve.equilibrium);
    let unit = case.units().length;
    let shown = |s: f64| said(&curve.setting.preset.units, Quantity::Length, s * unit);
    let s = match radius {
        Some(text) => length(&curve.setting.preset, text)? / unit,
        None => case.start,
    };
    if !(case.end..=case.start).contains(&s) {
        return Err(Failure::Usage(format!(
            "--contact-radius = {} is outside the curve, which goes from {} to {}",
            shown(s),
            shown(case.end),
            shown(case.start)
        )));
    }
    let (state, zone) = if case.cohesion.is_some() {
        let zones = Case { start: s, ..case.clone() }.zones(&Unwatched)?;
        if let Some(fault) =
            zones.fault(zones.start, &Unwatched).map_err(|error| case.no_path(error, case.control))?
        {
            return Err(case.no_path(fault, case.control).into());
        }
        let (at, edges) = (zones.solution.at(zones.start), zones.solution.edges(zones.start));
        let energy = zones.solution.energy(zones.start);
        (State { contact_radius: s, approach: at.approach, force: at.force, energy }, edges.zone)
    } else {
        let point = equilibrium.explicit(s).ok_or_else(|| {
            Failure::Usage(format!("there is no equilibrium at the contact radius {}", shown(s)))
        })?;
        (equilibrium.state(&point), None)
    };
    let curve = Arc::clone(curve);
    Ok(StateInside::of(&Ask { curve, state, rings: None, zone, exact, barrier: Some(EdgeDirection::Inward) }))
}

/// A contact radius as typed, in SI or reduced units.
fn length(preset: &Preset, text: &str) -> Result<f64, Failure> {
    typed(preset, "--contact-radius", "path.start_contact_radius", text)
}

/// The requested format; standard output and descriptors have no extension.
fn format(path: &Path) -> Result<PictureFormat, Failure> {
    match PictureFormat::of(path) {
        Err(FormatError::Ending { .. }) if stream::is_stream(path) => Ok(PictureFormat::Svg),
        format => Ok(format?),
    }
}
