//! Lines over two parameters at which snaps begin or end, and limit points over one, on paper.

use crate::figure::map::laid;
use crate::figure::places::Places;
use crate::figure::{Axis, Figure};
use pulloff_engine::preset::Preset;
use pulloff_engine::report::MapReport;
use pulloff_engine::report::map::AxisReport;
use pulloff_engine::text::{greek, headline};

/// The figure of `report`, with `preset` at its position.
pub fn figure(report: &MapReport, preset: &Preset) -> Figure {
    let places = |axis: &AxisReport| Places::of(axis, preset, report.control);
    let (x, y) = (places(&report.x), places(&report.y));
    let figure = laid(report, preset, &x, &y);
    let titled = |axis: Axis, of: &AxisReport| {
        let words = preset.row(&of.key).map(|row| greek(headline(&row.meaning)).replace(" pi ", " π "));
        let symbol = words.map(|words| format!("{words}, {}", axis.symbol));
        Axis { symbol: symbol.unwrap_or(axis.symbol), ..axis }
    };
    let (x, y) = (titled(x.axis, &report.x), titled(y.axis, &report.y));
    let missing = figure.lines.is_empty().then(|| "no limit point is born or lost here".to_owned());
    Figure { x, y, missing, ..figure }
}
