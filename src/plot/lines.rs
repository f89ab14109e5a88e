//! Lines in two numbers at which snaps begin or end, and limit points over one, on paper.

use super::chart::{Chart, ChartAxis, Run};
use crate::figure::map::{Places, laid};
use pulloff_engine::preset::Preset;
use pulloff_engine::report::MapReport;
use pulloff_engine::report::map::AxisReport;

/// The chart of `report`, with `preset` at its place.
pub fn chart(report: &MapReport, preset: &Preset) -> Chart {
    let places = |axis: &AxisReport| Places::of(axis, preset, report.control, false);
    let (x, y) = (places(&report.x), places(&report.y));
    let (lines, marks, bounds) = laid(report, preset, &x, &y);
    let axis = |places: &Places, of: &AxisReport| ChartAxis {
        title: places.axis.title(),
        run: if of.logarithmic { Run::Logarithmic } else { Run::Linear },
    };
    let (x, y) = (axis(&x, &report.x), axis(&y, &report.y));
    let missing = lines.is_empty().then(|| "no limit point is born or lost here".to_owned());
    Chart { bounds, marks, missing, ..Chart::new(x, y, lines) }
}
