//! A quantity of a sweep over its one axis: a mark for every row, joined where neighbours have a value.

use super::map::{MapError, distinct, is_logarithmic};
use crate::figure::{Axis, Figure, Line, Mark, Role, Run, Sign};
use crate::sweep::Results;

/// The figure of `quantity` in `results` over the column `axis`; a row without a value is a gap.
/// Errors: [`MapError`] when there is no such column, one is not of numbers, or no row has a value.
pub fn figure(results: &Results, axis: &str, quantity: &str) -> Result<Figure, MapError> {
    let mut columns = results.numbers(&[axis, quantity])?.into_iter();
    let mut next = || columns.next().unwrap_or_default();
    let (along, found) = (next(), next());
    let mut points: Vec<(f64, f64)> =
        along.iter().zip(&found).filter_map(|(x, y)| Some(((*x)?, y.unwrap_or(f64::NAN)))).collect();
    // A spec may name its values in any order, and drawn ones have none.
    points.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let is_known = |(x, y): &(f64, f64)| x.is_finite() && y.is_finite();
    if !points.iter().any(is_known) {
        return Err(MapError::empty(quantity));
    }
    let values = distinct(&along);
    let run = if is_logarithmic(&values) { Run::Logarithmic } else { Run::Linear };
    let marks = points.iter().copied().filter(is_known).map(|at| Mark { sign: Sign::Value, at }).collect();
    let is_count = |(_, y): &(f64, f64)| !y.is_finite() || (*y >= 0.0 && y.fract() == 0.0);
    let counted = if points.iter().all(is_count) { Run::Counted } else { Run::Linear };
    let [x, y] =
        [(axis, run), (quantity, counted)].map(|(name, run)| Axis::pure(results.title(name)).running(run));
    let mut figure = Figure { marks, ..Figure::of(x, y, vec![Line::new(Role::Body, "", points)]) };
    if results.is_random {
        // Neighbours drawn at random differ in whatever else was drawn: no line joins them.
        figure.lines.clear();
    }
    Ok(figure)
}
