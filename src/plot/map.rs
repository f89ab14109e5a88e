//! A quantity of a sweep over its two axes: filled contours, and the line from which the edge snaps.

use super::Width;
use super::svg::{finish, frame};
use crate::sweep::Results;
use crate::sweep::results::ResultsError;
use kuva::plot::scatter::MarkerShape;
use kuva::plot::{ContourPlot, ScatterPlot};
use kuva::prelude::Plot;
use kuva::render::render::render_multiple;

/// The column that tells where snaps begin.
const SNAPS: &str = "snaps";
/// Bands of colour.
const BANDS: usize = 12;
/// An axis of equal factors is logarithmic where it reaches over this factor at least.
const DECADE: f64 = 10.0;

/// A quantity over two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// The axes: x, then y, by their columns.
    pub axes: [String; 2],
    /// The quantity.
    pub quantity: String,
    /// The values of the axes, ascending.
    pub values: [Vec<f64>; 2],
    /// The quantity, a row for each y; not finite where the sweep has none.
    pub cells: Vec<Vec<f64>>,
    /// The snaps in the same places, where the sweep counted them.
    pub snaps: Option<Vec<Vec<f64>>>,
}

/// Why there is no map.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    /// The results cannot be read.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// They are no grid over two axes of numbers.
    #[error("{0}")]
    Grid(String),
}

impl Map {
    /// The map of `quantity` in `results`, whose first two columns behind the row are the axes.
    ///
    /// # Errors
    /// [`MapError`] when there is no such column, or the rows make no whole grid of at least two by two.
    pub fn of(results: &Results, axes: &[String], quantity: &str) -> Result<Self, MapError> {
        let [x, y] = axes else {
            return Err(MapError::Grid(format!("a map is over two axes; the sweep has {}", axes.len())));
        };
        let has_snaps = results.columns.iter().any(|column| column.name == SNAPS);
        let names: Vec<&str> =
            [x.as_str(), y, quantity].into_iter().chain(has_snaps.then_some(SNAPS)).collect();
        let mut columns = results.numbers(&names)?.into_iter();
        let mut next = || columns.next().unwrap_or_default();
        let (along, up, found) = (next(), next(), next());
        let snapped = has_snaps.then(next);
        let values = [distinct(&along), distinct(&up)];
        let [width, height] = [values[0].len(), values[1].len()];
        if width < 2 || height < 2 || width * height != found.len() {
            return Err(MapError::Grid(format!(
                "a map needs a whole grid: {} rows are not {width} times {height} values",
                found.len()
            )));
        }
        let grid = |column: &[Option<f64>]| {
            let mut cells = vec![vec![f64::NAN; width]; height];
            for ((x, y), value) in along.iter().zip(&up).zip(column) {
                let at = |axis: &[f64], value: &Option<f64>| {
                    value.and_then(|value| axis.iter().position(|other| other.total_cmp(&value).is_eq()))
                };
                if let (Some(i), Some(j), Some(value)) = (at(&values[0], x), at(&values[1], y), value) {
                    cells[j][i] = *value;
                }
            }
            cells
        };
        let (cells, snaps) = (grid(&found), snapped.map(|column| grid(&column)));
        if cells.iter().flatten().all(|cell| !cell.is_finite()) {
            return Err(MapError::Grid(format!("no row has a {quantity}")));
        }
        Ok(Self { axes: [x.clone(), y.clone()], quantity: quantity.to_owned(), values, cells, snaps })
    }

    /// The map as an SVG document of this width.
    pub fn svg(&self, width: Width) -> String {
        let [x, y] = &self.values;
        let range = |axis: &[f64]| [axis[0], axis[axis.len() - 1]];
        let layout = frame(
            width,
            [&self.axes[0], &self.axes[1]],
            [range(x), range(y)],
            [is_logarithmic(x), is_logarithmic(y)],
        );
        let filled = ContourPlot::new()
            .with_grid(self.filled(), x.clone(), y.clone())
            .with_n_levels(BANDS)
            .with_filled()
            .with_line_color("none")
            .with_legend(self.quantity.as_str());
        let mut plots = vec![filled.into()];
        if let Some(snaps) = &self.snaps {
            // Where nothing is known nothing snaps.
            let known =
                snaps.iter().map(|row| row.iter().map(|n| if n.is_finite() { *n } else { 0.0 }).collect());
            let line = ContourPlot::new()
                .with_grid(known.collect(), x.clone(), y.clone())
                .with_levels(&[0.5])
                .with_line_color("black")
                .with_line_width(1.2);
            plots.push(line.into());
        }
        plots.extend(self.holes());
        finish(&render_multiple(plots, layout), 0.0)
    }
}

impl Map {
    /// The cells with the least value where there is none: the places are crossed out.
    fn filled(&self) -> Vec<Vec<f64>> {
        let least = self
            .cells
            .iter()
            .flatten()
            .copied()
            .filter(|cell| cell.is_finite())
            .fold(f64::INFINITY, f64::min);
        let fill = |cell: &f64| if cell.is_finite() { *cell } else { least };
        self.cells.iter().map(|row| row.iter().map(fill).collect()).collect()
    }

    /// A cross where the sweep has no value.
    fn holes(&self) -> Option<Plot> {
        let [x, y] = &self.values;
        let missing: Vec<(f64, f64)> = self
            .cells
            .iter()
            .zip(y)
            .flat_map(|(row, y)| {
                row.iter().zip(x).filter(|(cell, _)| !cell.is_finite()).map(|(_, x)| (*x, *y))
            })
            .collect();
        let crosses =
            ScatterPlot::new().with_data(missing.iter().copied()).with_color("black").with_size(2.5);
        (!missing.is_empty()).then(|| crosses.with_marker(MarkerShape::Cross).into())
    }
}

/// The values of an axis, each once, ascending.
fn distinct(column: &[Option<f64>]) -> Vec<f64> {
    let mut values: Vec<f64> = column.iter().flatten().copied().filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    values.dedup_by(|a, b| a.total_cmp(b).is_eq());
    values
}

/// Whether the factors between neighbours are more alike than the steps.
fn is_logarithmic(axis: &[f64]) -> bool {
    let (first, last) = (axis[0], axis[axis.len() - 1]);
    let spread = |apart: fn(f64, f64) -> f64| {
        let all = axis.windows(2).map(|pair| apart(pair[0], pair[1]));
        let [least, most] = all.fold([f64::INFINITY, 0.0], |[least, most], x| [x.min(least), x.max(most)]);
        most / least
    };
    first > 0.0 && last / first >= DECADE && spread(|a, b| (b / a).ln()) < spread(|a, b| b - a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_of_equal_factors_is_logarithmic_and_one_of_equal_steps_is_not() {
        let factors: Vec<f64> = (0..9).map(|i| 10.0_f64.powf(0.25 * f64::from(i))).collect();
        let steps: Vec<f64> = (0..9).map(|i| 1.0 + 12.0 * f64::from(i)).collect();
        assert!(is_logarithmic(&factors) && !is_logarithmic(&steps) && !is_logarithmic(&[0.0, 1.0, 100.0]));
        // Few values, and two, of which nothing can be said.
        assert!(is_logarithmic(&[0.01, 0.1, 1.0]) && !is_logarithmic(&[0.01, 0.5, 1.0]));
        assert!(!is_logarithmic(&[0.01, 1.0]));
    }

    #[test]
    fn a_map_with_holes_is_a_valid_document() {
        let map = Map {
            axes: ["a".to_owned(), "b".to_owned()],
            quantity: "enhancement".to_owned(),
            values: [vec![0.0, 1.0, 2.0], vec![1.0, 10.0, 100.0]],
            cells: vec![vec![1.0, 2.0, 3.0], vec![2.0, f64::NAN, 4.0], vec![3.0, 4.0, 5.0]],
            snaps: Some(vec![vec![0.0, 0.0, 1.0], vec![0.0, 1.0, 2.0], vec![1.0, 2.0, 3.0]]),
        };
        let text = map.svg(Width::ONE_COLUMN);
        let document = roxmltree::Document::parse(&text).unwrap();
        assert!(document.descendants().any(|node| node.has_tag_name("path")), "{text}");
        assert!(!text.contains("NaN"));
    }
}
