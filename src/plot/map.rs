//! A quantity of a sweep over its two axes: filled contours, and the line from which the edge snaps.

use super::Width;
use super::ink;
use super::svg::{cropped, entry, finish, frame, hatched, hatches, line, outline, plain};
use crate::figure::Line;
use crate::mend::Mend;
use crate::sweep::Results;
use crate::sweep::results::ResultsError;
use kuva::plot::ContourPlot;
use kuva::plot::legend::{LegendEntry, LegendShape};
use kuva::render::layout::ComputedLayout;
use kuva::render::render::{Primitive, render_multiple};
use pulloff_engine::text::quote;
use std::collections::VecDeque;

/// The column that tells where snaps begin.
const SNAPS: &str = "snaps";
/// Between no snap and one.
const ONE_SNAP: f64 = 0.5;
/// Bands of colour.
const BANDS: usize = 12;
/// An axis of equal factors is logarithmic where it reaches over this factor at least.
const DECADE: f64 = 10.0;

/// A quantity over two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// What stands beside the axes, x and y.
    pub titles: [String; 2],
    pub quantity: String,
    /// The values of the axes, ascending.
    pub values: [Vec<f64>; 2],
    /// The quantity, a row for each y; not finite where the sweep has none.
    pub cells: Vec<Vec<f64>>,
    /// The snaps in the same places, where the sweep counted them.
    pub snaps: Option<Vec<Vec<f64>>>,
    /// Lines drawn over it, in the values of its axes.
    pub lines: Vec<Line>,
}

/// Why results are not drawn.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// They are neither a grid over two axes of numbers nor rows over one.
    #[error("{0}")]
    Grid(String),
}

impl Mend for MapError {
    fn can_be_mended(&self) -> bool {
        match self {
            Self::Results(error) => error.can_be_mended(),
            Self::Grid(_) => true,
        }
    }
}

impl MapError {
    /// No row has a number in this column.
    pub(super) fn empty(column: &str) -> Self {
        Self::Grid(format!("the column {} is empty in every row", quote(column)))
    }
}

impl Map {
    /// The map of `quantity` in `results`, whose first two columns behind the row are the axes.
    /// Errors: [`MapError`] when there is no such column, or the rows make no whole grid of at least two by two.
    pub fn of(results: &Results, axes: &[String], quantity: &str) -> Result<Self, MapError> {
        let [x, y] = axes else {
            let what =
                format!("the results of a sweep are drawn over one axis or two; it has {}", axes.len());
            return Err(MapError::Grid(what));
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
            return Err(MapError::empty(quantity));
        }
        let title = |name: &str| results.title(name);
        Ok(Self {
            titles: [title(x), title(y)],
            quantity: title(quantity),
            values,
            cells,
            snaps,
            lines: Vec::new(),
        })
    }

    /// The map as an SVG document of this width.
    pub fn svg(&self, width: Width) -> String {
        let [x, y] = &self.values;
        let range = |axis: &[f64]| [axis[0], axis[axis.len() - 1]];
        let (legend, holes) = (self.legend(), self.holes());
        let logarithmic = [is_logarithmic(x), is_logarithmic(y)];
        let known = || self.cells.iter().flatten().copied().filter(|cell| cell.is_finite());
        let values = [known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max)];
        let ranges = [range(x), range(y)];
        let layout = frame(width, self.titles.clone(), ranges, logarithmic, values, &legend);
        let filled = ContourPlot::new()
            .with_grid(self.filled(), x.clone(), y.clone())
            .with_n_levels(BANDS)
            .with_filled()
            .with_line_color("none")
            .with_legend(plain(&self.quantity));
        let mut plots = vec![filled.into()];
        if let Some(snaps) = &self.snaps {
            let line = ContourPlot::new()
                .with_grid(counts(snaps), x.clone(), y.clone())
                .with_levels(&[ONE_SNAP])
                .with_line_color("black")
                .with_line_width(1.2);
            plots.push(line.into());
        }
        plots.extend(self.lines.iter().flat_map(line));
        let field = ComputedLayout::from_layout(&layout);
        let mut scene = render_multiple(plots, layout);
        if !holes.is_empty() {
            // One area, without seams.
            let area: String = holes.iter().map(|hole| outline(hole, &field)).collect();
            let paths = hatches(std::iter::once(area), "#ffffff", &mut scene);
            let end = scene.elements.iter().position(|element| matches!(element, Primitive::ClipEnd));
            let end = end.unwrap_or(scene.elements.len());
            scene.elements.splice(end..end, paths);
        }
        finish(&scene, cropped(&legend))
    }

    /// What is drawn besides the colours.
    fn legend(&self) -> Vec<LegendEntry> {
        let snaps =
            self.snaps.as_ref().map(|snaps| counts(snaps).into_iter().flatten().collect::<Vec<f64>>());
        let begins =
            |snaps: &Vec<f64>| snaps.iter().any(|n| *n < ONE_SNAP) && snaps.iter().any(|n| *n > ONE_SNAP);
        let line = snaps.filter(begins).map(|_| entry("snaps begin", "black", LegendShape::Line, ""));
        let has_holes = self.cells.iter().flatten().any(|cell| !cell.is_finite());
        let mut entries: Vec<LegendEntry> =
            line.into_iter().chain(has_holes.then(|| hatched("no value"))).collect();
        for line in self.lines.iter().filter(|line| !line.name.is_empty()) {
            let stroke = ink::stroke(line.role);
            if entries.iter().all(|entry| entry.label != line.name) {
                entries.push(entry(&line.name, stroke.color, LegendShape::Line, stroke.dashes));
            }
        }
        entries
    }

    /// The cells, with the value of one nearby where there is none: the contours run straight into the hatched places.
    fn filled(&self) -> Vec<Vec<f64>> {
        let mut cells = self.cells.clone();
        let [width, height] = [self.values[0].len(), self.values[1].len()];
        let places = (0..height).flat_map(|j| (0..width).map(move |i| (i, j)));
        let mut edge: VecDeque<(usize, usize)> = places.filter(|(i, j)| cells[*j][*i].is_finite()).collect();
        while let Some((i, j)) = edge.pop_front() {
            let value = cells[j][i];
            for (i, j) in [(i.wrapping_sub(1), j), (i + 1, j), (i, j.wrapping_sub(1)), (i, j + 1)] {
                if i < width && j < height && !cells[j][i].is_finite() {
                    cells[j][i] = value;
                    edge.push_back((i, j));
                }
            }
        }
        cells
    }

    /// The outlines of the places where the sweep has no value: neighbours in a row are one.
    fn holes(&self) -> Vec<[(f64, f64); 4]> {
        let [along, up] = [&self.values[0], &self.values[1]].map(|axis| borders(axis));
        let mut holes = Vec::new();
        for (row, y) in self.cells.iter().zip(up.windows(2)) {
            let mut at = 0;
            for run in row.chunk_by(|a, b| a.is_finite() == b.is_finite()) {
                let (from, to) = (along[at], along[at + run.len()]);
                at += run.len();
                if run.iter().all(|cell| !cell.is_finite()) {
                    holes.push([(from, y[0]), (to, y[0]), (to, y[1]), (from, y[1])]);
                }
            }
        }
        holes
    }
}

/// Counts of snaps, none where nothing is known.
fn counts(snaps: &[Vec<f64>]) -> Vec<Vec<f64>> {
    snaps.iter().map(|row| row.iter().map(|n| if n.is_finite() { *n } else { 0.0 }).collect()).collect()
}

/// The borders of the cells of an axis: its ends, and half-way between neighbours.
fn borders(axis: &[f64]) -> Vec<f64> {
    let is_logarithmic = is_logarithmic(axis);
    let half = |pair: &[f64]| {
        if is_logarithmic { (pair[0] * pair[1]).sqrt() } else { 0.5 * (pair[0] + pair[1]) }
    };
    let [first, last] = [axis[0], axis[axis.len() - 1]];
    std::iter::once(first).chain(axis.windows(2).map(half)).chain([last]).collect()
}

/// The values of an axis, each once, ascending.
pub(super) fn distinct(column: &[Option<f64>]) -> Vec<f64> {
    let mut values: Vec<f64> = column.iter().flatten().copied().filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    values.dedup_by(|a, b| a.total_cmp(b).is_eq());
    values
}

/// Whether the factors between neighbours are more alike than the steps; of one value nothing can be said.
pub(super) fn is_logarithmic(axis: &[f64]) -> bool {
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
            titles: ["a".to_owned(), "b".to_owned()],
            quantity: "enhancement".to_owned(),
            values: [vec![0.0, 1.0, 2.0], vec![1.0, 10.0, 100.0]],
            cells: vec![vec![1.0, 2.0, 3.0], vec![2.0, f64::NAN, 4.0], vec![3.0, 4.0, 5.0]],
            snaps: Some(vec![vec![0.0, 0.0, 1.0], vec![0.0, 1.0, 2.0], vec![1.0, 2.0, 3.0]]),
            lines: Vec::new(),
        };
        let text = map.svg(Width::ONE_COLUMN);
        let document = roxmltree::Document::parse(&text).unwrap();
        assert!(document.descendants().any(|node| node.has_tag_name("path")), "{text}");
        assert!(!text.contains("NaN"));
        // The place without a value is told from the least one, and both it and the line are named.
        assert!(text.contains("url(#") && text.contains("no value") && text.contains("snaps begin"));
        assert_eq!(map.holes().len(), 1);
        assert_eq!(map.filled()[1], [2.0, 2.0, 4.0]);
        let full = Map { cells: vec![vec![1.0, 2.0, 3.0]; 3], snaps: None, ..map };
        assert!(full.holes().is_empty() && full.legend().is_empty());
    }
}
