//! `pulloff plot`: a view of the explorer as a figure for print.

use super::{Failure, Problem, output, warn};
use crate::explorer::profile::{Ask, Inside};
use crate::explorer::{Axes, CurveData, Overlays, View, Window};
use crate::figure::Subject;
use crate::plot::map::{Map, MapError};
use crate::plot::{Chart, Width, svg, table};
use crate::preset::{Overwrite, Preset, write_atomically};
use crate::print::Format;
use crate::quasistatic::jump::Run;
use crate::sweep::Results;
use crate::units::Quantity;
use crate::units::number::said;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

/// The arguments of `pulloff plot`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    problem: Problem,
    /// Draw a map of the results of a sweep over its two axes instead of a view of a preset
    #[arg(long, value_name = "RESULTS.csv", conflicts_with_all = ["preset", "assignments", "view", "theory", "raw", "contact_radius", "data"])]
    sweep: Option<PathBuf>,
    /// The column of the results that the map shows
    #[arg(long, value_name = "COLUMN", requires = "sweep", default_value = "enhancement")]
    quantity: String,
    /// What is drawn
    #[arg(long, value_enum, default_value = "force-approach")]
    view: Shown,
    /// Draw the exact solution and the envelope of Kesari and Lew as well, where they exist
    #[arg(long)]
    theory: bool,
    /// Axes in the preset's own units instead of P/Pc and s/lambda
    #[arg(long)]
    raw: bool,
    /// The state whose pressure, gap or energy is drawn, by its contact radius: a number, in an SI preset in metres or with its unit, as 1.2mm; the start when left out
    #[arg(long, value_name = "RADIUS")]
    contact_radius: Option<String>,
    /// Its width on paper in millimetres, or one or two columns of a journal (86 and 178 mm)
    #[arg(long, value_name = "WIDTH", default_value = "one-column", value_parser = width)]
    width: Width,
    /// Write the data beside the figure too, to FILE.csv
    #[arg(long, requires = "output")]
    data: bool,
    /// Write to this file, as SVG, PNG or PDF by its ending, instead of SVG to standard output
    #[arg(short, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// A view by the name the explorer gives it.
#[derive(Debug, Clone, Copy)]
struct Shown(View);

impl ValueEnum for Shown {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [Shown; View::ALL.len()] = {
            let mut all = [Shown(View::ForceApproach); View::ALL.len()];
            let mut i = 0;
            while i < all.len() {
                all[i] = Shown(View::ALL[i]);
                i += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        Some(clap::builder::PossibleValue::new(self.0.name()))
    }
}

fn width(text: &str) -> Result<Width, String> {
    let (lo, hi) = (Width::RANGE.start(), Width::RANGE.end());
    match text {
        "one-column" => Some(Width::ONE_COLUMN),
        "two-columns" => Some(Width::TWO_COLUMNS),
        text => text.trim_end_matches("mm").trim().parse().ok().and_then(Width::millimetres),
    }
    .ok_or_else(|| format!("expected one-column, two-columns, or a width from {lo} to {hi} mm"))
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let format = format(arguments.output.as_deref())?;
    if let Some(path) = &arguments.sweep {
        let results = Results::open(path).map_err(MapError::from)?;
        let map = Map::of(&results, &results.axes, &arguments.quantity)?;
        write(&map.svg(arguments.width), format, arguments.output.as_deref())?;
        return Ok(ExitCode::SUCCESS);
    }
    let preset = arguments.problem.load()?.preset;
    let curve = CurveData::compute(&preset, |_| true)?;
    let curve = Arc::new(curve.checked(&mut || true).unwrap_or(curve));
    warn(&curve.sweep.warnings);
    let view = arguments.view.0;
    let inside = if view.is_state() {
        Some(inside(&curve, arguments.contact_radius.as_deref(), arguments.theory)?)
    } else if arguments.contact_radius.is_some() {
        return Err(Failure::Usage(format!(
            "--contact-radius: {} shows the whole curve; pressure, gap and energy show a state",
            view.name()
        )));
    } else {
        None
    };
    let overlays = Overlays { smooth: true, exact: arguments.theory, envelope: arguments.theory };
    let axes = if arguments.raw { Axes::Raw } else { Axes::Reduced };
    let subject = Subject { inside: inside.as_ref(), axes, ..Subject::alone(&curve, overlays) };
    let chart = Chart::of(&subject.figure(view), &Window::WHOLE);
    write(&svg::svg(&chart, arguments.width), format, arguments.output.as_deref())?;
    if let (Some(path), true) = (&arguments.output, arguments.data) {
        let text = table::csv(&chart)?;
        write_atomically(&path.with_extension("csv"), text.as_bytes(), Overwrite::Always)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The inside of the state of this contact radius, or of the start.
fn inside(curve: &Arc<CurveData>, radius: Option<&str>, exact: bool) -> Result<Inside, Failure> {
    let (case, equilibrium) = (&curve.case, &curve.sweep.curve.equilibrium);
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
    let point = equilibrium.explicit(s).ok_or_else(|| {
        Failure::Usage(format!("there is no equilibrium at the contact radius {}", shown(s)))
    })?;
    let state = equilibrium.state(&point);
    let curve = Arc::clone(curve);
    Ok(Inside::compute(&Ask { id: 0, curve, state, exact, barrier: Some(Run::Inward) }))
}

/// A contact radius as typed, in SI or reduced units.
fn length(preset: &Preset, text: &str) -> Result<f64, Failure> {
    let wrong = |cause: &dyn std::fmt::Display| Failure::Usage(format!("--contact-radius: {cause}"));
    let row = preset
        .row("path.start_contact_radius")
        .ok_or_else(|| wrong(&format!("expected {}", Quantity::Length.name())))?;
    // The row is that of another key, which the message must not blame.
    let words = |invalid: crate::preset::Invalid| {
        let text = invalid.to_string();
        wrong(&text.strip_prefix(&*row.key).map_or(&*text, |rest| rest.trim_start_matches([':', ' '])))
    };
    preset.number(&row, text).map_err(words)
}

/// The format that is asked for: standard output has no ending.
fn format(path: Option<&Path>) -> Result<Format, Failure> {
    Ok(path.filter(|path| *path != Path::new("-")).map_or(Ok(Format::Svg), Format::of)?)
}

fn write(text: &str, format: Format, path: Option<&Path>) -> Result<(), Failure> {
    match (format, path) {
        (Format::Png | Format::Pdf, Some(path)) => {
            write_atomically(path, &format.bytes(text)?, Overwrite::Always)?;
            Ok(())
        }
        (_, path) => output::write(text, path),
    }
}
