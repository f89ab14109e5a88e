//! Lines over two parameters at which snaps begin or end, and limit points over one, on paper.

use crate::figure::map::laid;
use crate::figure::places::Places;
use crate::figure::{Axis, AxisScale, Figure};
use pulloff_engine::preset::Preset;
use pulloff_engine::report::MapReport;
use pulloff_engine::report::map::AxisReport;
use pulloff_engine::text::headline;

/// The figure of `report`, with `preset` at its position.
pub fn figure(report: &MapReport, preset: &Preset) -> Figure {
    let places = |axis: &AxisReport| Places::of(axis, preset, report.control, false);
    let (x, y) = (places(&report.x), places(&report.y));
    let (lines, marks, bounds) = laid(report, preset, &x, &y);
    let run = |of: &AxisReport| if of.logarithmic { AxisScale::Logarithmic } else { AxisScale::Linear };
    let titled = |places: Places, of: &AxisReport| {
        let words = preset.row(&of.key).map(|row| headline(&row.meaning).to_owned());
        let symbol = words.map(|words| format!("{words}, {}", places.axis.symbol));
        Axis { symbol: symbol.unwrap_or(places.axis.symbol), ..places.axis }.running(run(of))
    };
    let (x, y) = (titled(x, &report.x), titled(y, &report.y));
    let missing = lines.is_empty().then(|| "no limit point is born or lost here".to_owned());
    Figure { marks, bounds, missing, ..Figure::of(x, y, lines) }
}
