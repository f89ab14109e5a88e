//! A quantity of a sweep over its one axis: a mark for every row, joined where neighbours have a value. For an
//! ensemble, the median and the ranges of half and of nine tenths of the members.

use super::map::{MapChartError, distinct};
use crate::figure::{Area, Axis, AxisScale, Figure, Line, Mark, Meaning, Role, Sign};
use crate::sweep::SweepResults;
use crate::sweep::record::statistic;

/// The quantiles that bound the areas, with the median between them.
const QUANTILES: [&str; 5] = ["q05", "q25", "q50", "q75", "q95"];

/// The figure of the statistics of `quantity` in `results` over the column `axis`.
/// Errors: As [`figure`].
fn bands(results: &SweepResults, axis: &str, quantity: &str) -> Result<Figure, MapChartError> {
    let names = QUANTILES.map(|of| statistic(quantity, of));
    let [along, found @ ..] =
        &results.numbers(&[axis, &names[0], &names[1], &names[2], &names[3], &names[4]])?[..]
    else {
        return Err(MapChartError::empty(quantity));
    };
    let mut points: Vec<[f64; 6]> = (0..along.len())
        .filter_map(|row| {
            let at = |of: usize| found[of][row].unwrap_or(f64::NAN);
            Some([along[row]?, at(0), at(1), at(2), at(3), at(4)])
        })
        .collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    if !points.iter().flatten().any(|x| x.is_finite()) {
        return Err(MapChartError::empty(quantity));
    }
    let run = AxisScale::of(&distinct(along));
    let (x, y) =
        (Axis::pure(results.title(axis)).running(run), Axis::pure(results.title_of(quantity, &names[2])));
    let line = |of: usize| points.iter().map(|point| (point[0], point[of])).collect::<Vec<_>>();
    let lines = (1..=5).map(|of| Line::new(Role::Body, "median", line(of))).collect();
    let mut figure = Figure::of(x, y, lines);
    figure.lines = figure.lines.drain(2..3).collect();
    // A point without members splits the areas, as it splits the line.
    for part in points.split(|point| !point[3].is_finite()).filter(|part| part.len() > 1) {
        for (meaning, [lower, upper]) in [(Meaning::Most, [1, 5]), (Meaning::Half, [2, 4])] {
            let there = part.iter().map(|point| (point[0], point[lower]));
            let back = part.iter().rev().map(|point| (point[0], point[upper]));
            figure.areas.push(Area { meaning, outline: there.chain(back).collect(), lost: None });
        }
    }
    let known = figure.lines[0].points.iter().filter(|(_, y)| y.is_finite());
    figure.marks = known.map(|at| Mark { sign: Sign::Value, at: *at }).collect();
    Ok(figure)
}

/// The figure of `quantity` in `results` over the column `axis`; a row without a value is a gap.
/// Errors: [`MapChartError`] when there is no such column, a column is not numeric, or no row has a value.
pub fn figure(results: &SweepResults, axis: &str, quantity: &str) -> Result<Figure, MapChartError> {
    if results.has_statistics_of(quantity) {
        return bands(results, axis, quantity);
    }
    let mut columns = results.numbers(&[axis, quantity])?.into_iter();
    let mut next = || columns.next().unwrap_or_default();
    let (along, found) = (next(), next());
    let mut points: Vec<(f64, f64)> =
        along.iter().zip(&found).filter_map(|(x, y)| Some(((*x)?, y.unwrap_or(f64::NAN)))).collect();
    // A spec may list its values in any order, and drawn values have none.
    points.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let is_known = |(x, y): &(f64, f64)| x.is_finite() && y.is_finite();
    if !points.iter().any(is_known) {
        return Err(MapChartError::empty(quantity));
    }
    let run = AxisScale::of(&distinct(&along));
    let marks = points.iter().copied().filter(is_known).map(|at| Mark { sign: Sign::Value, at }).collect();
    let is_count = |(_, y): &(f64, f64)| !y.is_finite() || (*y >= 0.0 && y.fract() == 0.0);
    let counted = if points.iter().all(is_count) { AxisScale::Counted } else { AxisScale::Linear };
    let [x, y] =
        [(axis, run), (quantity, counted)].map(|(name, run)| Axis::pure(results.title(name)).running(run));
    let mut figure = Figure { marks, ..Figure::of(x, y, vec![Line::new(Role::Body, "", points)]) };
    if results.is_random {
        // Neighbours drawn at random also differ in whatever else was drawn, so no line joins them.
        figure.lines.clear();
    }
    Ok(figure)
}
