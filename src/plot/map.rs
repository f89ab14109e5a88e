//! A quantity of a sweep over its two axes: filled contours and the line at which snaps begin or, for a count, flat
//! regions with their whole numbers.

use super::Width;
use super::ink;
use super::svg::{cropped, entry, filled, finish, frame, hatched, hatches, line, outline, plain};
use crate::figure::bounds::is_level;
use crate::figure::{AxisScale, Line};
use crate::mend::mend;
use crate::sweep::SweepResults;
use crate::sweep::results::ResultsError;
use kuva::plot::colormap::ColorMap;
use kuva::plot::legend::{LegendEntry, LegendShape};
use kuva::plot::{ContourPlot, LinePlot};
use kuva::render::color::Color;
use kuva::render::layout::ComputedLayout;
use kuva::render::plots::Plot;
use kuva::render::render::{Primitive, render_multiple};
use pulloff_engine::report::number::short;
use pulloff_engine::text::quote;
use std::collections::VecDeque;
use std::sync::Arc;

/// The column that shows where snaps begin.
const SNAPS: &str = "snaps";
/// The level between no snap and one.
const ONE_SNAP: f64 = 0.5;
/// The number of levels between bands of one colour.
const LEVELS: usize = 12;
/// The largest number of colours for counts; more cannot be told apart.
const COUNTS: f64 = 12.0;

/// The colour of a value by its share of the range: one for each band, so that the scale beside a map shows the bands as they
/// are drawn.
fn color_of_band(share: f64) -> String {
    /// A level itself begins its band, however it is rounded.
    const ROUNDING: f64 = 1e-9;
    let levels = LEVELS as f64;
    let band = (share * (levels + 1.0) + ROUNDING).floor().clamp(0.0, levels);
    ColorMap::Viridis.map(band / levels)
}

/// A quantity over two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct MapChart {
    /// The titles of the axes, x and y.
    pub titles: [String; 2],
    pub quantity: String,
    /// The values of the axes, ascending.
    pub values: [Vec<f64>; 2],
    /// The quantity, one row for each y; NaN or infinite where the sweep has none.
    pub cells: Vec<Vec<f64>>,
    /// The snap counts in the same cells, where the sweep counted them.
    pub snaps: Option<Vec<Vec<f64>>>,
    /// Lines drawn over the map, in the values of its axes.
    pub lines: Vec<Line>,
}

/// Why results cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum MapChartError {
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// They are neither a grid over two axes of numbers nor rows over one.
    #[error("{0}")]
    Grid(String),
}

mend!(MapChartError, as 0 of Results, always Grid);

impl MapChartError {
    /// No row has a number in this column.
    pub(super) fn empty(column: &str) -> Self {
        Self::Grid(format!("the column {} is empty in every row", quote(column)))
    }
}

impl MapChart {
    /// The map of `quantity` in `results`, whose first two columns after the row number are the axes.
    /// Errors: [`MapChartError`] when there is no such column, or the rows do not form a complete grid of at least two
    /// by two.
    pub fn of(results: &SweepResults, axes: &[String], quantity: &str) -> Result<Self, MapChartError> {
        let [x, y] = axes else {
            let what =
                format!("the results of a sweep are drawn over one axis or two; it has {}", axes.len());
            return Err(MapChartError::Grid(what));
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
            return Err(MapChartError::Grid(format!(
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
            return Err(MapChartError::empty(quantity));
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
        let runs = [x, y].map(|values| AxisScale::of(values));
        let ranges = [range(x), range(y)];
        let counts = self.counts();
        let colors = counts.is_none().then(|| self.range());
        let layout = frame(width, self.titles.clone(), ranges, runs, colors, &legend);
        let mut plots = if counts.is_some() {
            // With nothing to draw, the library draws no axes either.
            vec![LinePlot::new().into()]
        } else {
            self.contours()
        };
        plots.extend(self.lines.iter().flat_map(line));
        let field = ComputedLayout::from_layout(&layout);
        let mut scene = render_multiple(plots, layout);
        for count in counts.iter().flatten() {
            let places = self.places(|cell| count.holds(cell));
            let area: String = places.iter().map(|place| outline(place, &field)).collect();
            let begin =
                scene.elements.iter().position(|element| matches!(element, Primitive::ClipStart { .. }));
            scene
                .elements
                .insert(begin.map_or(0, |begin| begin + 1), filled(area, Color::from(count.color.as_str())));
        }
        if !holes.is_empty() {
            // A single area, without seams.
            let area: String = holes.iter().map(|hole| outline(hole, &field)).collect();
            let paths = hatches(std::iter::once(area), "#ffffff", &mut scene);
            let end = scene.elements.iter().position(|element| matches!(element, Primitive::ClipEnd));
            let end = end.unwrap_or(scene.elements.len());
            scene.elements.splice(end..end, paths);
        }
        finish(&scene, cropped(&legend))
    }

    /// The filled contours, and the line at which snaps begin.
    fn contours(&self) -> Vec<Plot> {
        let [x, y] = &self.values;
        let filled = ContourPlot::new()
            .with_grid(self.filled(), x.clone(), y.clone())
            .with_n_levels(LEVELS)
            .with_colormap(ColorMap::Custom(Arc::new(color_of_band)))
            .with_filled()
            .with_line_color("none")
            .with_legend(plain(&self.quantity));
        let line = self.snaps.as_ref().map(|snaps| {
            ContourPlot::new()
                .with_grid(snapping(snaps), x.clone(), y.clone())
                .with_levels(&[ONE_SNAP])
                .with_line_color("black")
                .with_line_width(1.2)
        });
        std::iter::once(filled).chain(line).map(Plot::from).collect()
    }

    /// The smallest and the largest value.
    fn range(&self) -> [f64; 2] {
        let known = || self.cells.iter().flatten().copied().filter(|cell| cell.is_finite());
        [known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// The counts of a counted quantity with their colours, or ranges of counts where there are many, or the one value
    /// of any quantity; `None` where values are many.
    fn counts(&self) -> Option<Vec<Count>> {
        let [least, most] = self.range();
        // One colour for one value, whose last digits say nothing.
        if is_level([least, most]) {
            return Some(vec![Count { from: least, to: most, color: ColorMap::Viridis.map(0.0) }]);
        }
        let is_count = |cell: &f64| !cell.is_finite() || (*cell >= 0.0 && cell.fract() == 0.0);
        if !self.cells.iter().flatten().all(is_count) {
            return None;
        }
        let wide = ((most - least + 1.0) / COUNTS).ceil();
        let firsts = std::iter::successors(Some(least), |first| Some(first + wide));
        let all = firsts.take_while(|first| *first <= most).map(|from| {
            let share = if most > least { (from - least) / (most - least) } else { 0.0 };
            Count { from, to: (from + wide - 1.0).min(most), color: ColorMap::Viridis.map(share) }
        });
        Some(all.collect())
    }

    /// The legend of everything that is drawn besides the colours.
    fn legend(&self) -> Vec<LegendEntry> {
        let snaps =
            self.snaps.as_ref().map(|snaps| snapping(snaps).into_iter().flatten().collect::<Vec<f64>>());
        let begins =
            |snaps: &Vec<f64>| snaps.iter().any(|n| *n < ONE_SNAP) && snaps.iter().any(|n| *n > ONE_SNAP);
        let counts = self.counts();
        let named = |(at, count): (usize, &Count)| {
            let title = if at == 0 { format!("{} {}", self.quantity, count.name()) } else { count.name() };
            entry(&title, &count.color, LegendShape::Rect, "")
        };
        let regions: Vec<LegendEntry> = counts.iter().flatten().enumerate().map(named).collect();
        let line = snaps
            .filter(|snaps| counts.is_none() && begins(snaps))
            .map(|_| entry("snaps begin", "black", LegendShape::Line, ""));
        let has_holes = self.cells.iter().flatten().any(|cell| !cell.is_finite());
        let mut entries: Vec<LegendEntry> =
            regions.into_iter().chain(line).chain(has_holes.then(|| hatched("no value"))).collect();
        for line in self.lines.iter().filter(|line| !line.name.is_empty()) {
            let stroke = ink::stroke(line.role);
            if entries.iter().all(|entry| entry.label != line.name) {
                entries.push(entry(&line.name, stroke.color, LegendShape::Line, stroke.dashes));
            }
        }
        entries
    }

    /// The cells, with a nearby value where there is none, so that the contours run straight into the hatched areas.
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

    /// The outlines of the areas where the sweep has no value.
    fn holes(&self) -> Vec<[(f64, f64); 4]> {
        self.places(|cell| !cell.is_finite())
    }

    /// The outlines of the wanted cells; neighbours in a row are joined.
    fn places(&self, is_wanted: impl Fn(f64) -> bool) -> Vec<[(f64, f64); 4]> {
        let [along, up] = [&self.values[0], &self.values[1]].map(|axis| borders(axis));
        let mut places = Vec::new();
        for (row, y) in self.cells.iter().zip(up.windows(2)) {
            let mut at = 0;
            for run in row.chunk_by(|a, b| is_wanted(*a) == is_wanted(*b)) {
                let (from, to) = (along[at], along[at + run.len()]);
                at += run.len();
                if is_wanted(run[0]) {
                    places.push([(from, y[0]), (to, y[0]), (to, y[1]), (from, y[1])]);
                }
            }
        }
        places
    }
}

/// Neighbouring counts that share a colour.
struct Count {
    from: f64,
    to: f64,
    color: String,
}

impl Count {
    fn holds(&self, cell: f64) -> bool {
        (self.from..=self.to).contains(&cell)
    }

    fn name(&self) -> String {
        let (from, to) = (self.from, self.to);
        if is_level([from, to]) { short(from, 6) } else { format!("{from}-{to}") }
    }
}

/// Which cells snap, as 0 and 1, 0 where nothing is known: the line between them is then half a cell from either,
/// however many snaps there are beyond it.
fn snapping(snaps: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let snaps = snaps.iter().map(|row| row.iter().map(|n| f64::from(*n > ONE_SNAP)));
    snaps.map(Iterator::collect).collect()
}

/// The borders of the cells of an axis: its ends, and half-way between neighbours.
fn borders(axis: &[f64]) -> Vec<f64> {
    let run = AxisScale::of(axis);
    let half = |pair: &[f64]| run.value(0.5 * (run.place(pair[0]) + run.place(pair[1])));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_with_holes_is_a_valid_document() {
        let map = MapChart {
            titles: ["a".to_owned(), "b".to_owned()],
            quantity: "enhancement".to_owned(),
            values: [vec![0.0, 1.0, 2.0], vec![1.0, 10.0, 100.0]],
            cells: vec![vec![1.5, 2.0, 3.0], vec![2.0, f64::NAN, 4.0], vec![3.0, 4.0, 5.0]],
            snaps: Some(vec![vec![0.0, 0.0, 1.0], vec![0.0, 1.0, 2.0], vec![1.0, 2.0, 3.0]]),
            lines: Vec::new(),
        };
        let text = map.svg(Width::ONE_COLUMN);
        let document = roxmltree::Document::parse(&text).unwrap();
        assert!(document.descendants().any(|node| node.has_tag_name("path")), "{text}");
        assert!(!text.contains("NaN"));
        // The cell without a value differs from the smallest one, and both it and the line are named.
        assert!(text.contains("url(#") && text.contains("no value") && text.contains("snaps begin"));
        assert_eq!(map.holes().len(), 1);
        assert_eq!(map.filled()[1], [2.0, 2.0, 4.0]);
        // The scale has the colours of the bands and no others; the band of the largest value is drawn.
        let bands: Vec<String> =
            (0..=LEVELS).map(|band| color_of_band(band as f64 / (LEVELS as f64 + 1.0))).collect();
        let fills = document.descendants().filter_map(|node| node.attribute("fill"));
        let of_bands: Vec<&str> = fills.filter(|fill| bands.iter().any(|band| band == fill)).collect();
        for band in &bands {
            // Once on the scale at least, once on the map.
            assert!(of_bands.iter().filter(|fill| *fill == band).count() >= 2, "{band} {of_bands:?}");
        }
        let full = MapChart { cells: vec![vec![1.5, 2.0, 3.0]; 3], snaps: None, ..map };
        assert!(full.holes().is_empty() && full.legend().is_empty());
    }

    #[test]
    fn counts_are_flat_regions_with_whole_numbers() {
        let map = |cells: Vec<Vec<f64>>| MapChart {
            titles: ["a".to_owned(), "b".to_owned()],
            quantity: "snaps".to_owned(),
            values: [vec![0.0, 1.0, 2.0], vec![1.0, 2.0, 3.0]],
            snaps: Some(cells.clone()),
            cells,
            lines: Vec::new(),
        };
        let few = map(vec![vec![0.0, 0.0, 1.0], vec![0.0, f64::NAN, 2.0], vec![1.0, 2.0, 4.0]]);
        let names = |map: &MapChart| map.legend().into_iter().map(|entry| entry.label).collect::<Vec<_>>();
        assert_eq!(names(&few), ["snaps 0", "1", "2", "3", "4", "no value"]);
        let colors: Vec<String> = few.legend().into_iter().map(|entry| entry.color).collect();
        let text = few.svg(Width::ONE_COLUMN);
        // The drawing has the colours of the legend, and nothing lies between two counts: 3 is in no cell.
        let drawn = |color: &String| text.matches(color.as_str()).count();
        assert!(drawn(&colors[0]) >= 2 && drawn(&colors[4]) >= 2 && drawn(&colors[3]) <= drawn(&colors[0]));
        assert_eq!(few.places(|cell| few.counts().unwrap()[0].holds(cell)).len(), 2);
        let many = map(vec![vec![0.0, 10.0, 20.0]; 3]);
        assert_eq!(names(&many)[..2], ["snaps 0-1", "2-3"]);
        assert_eq!(names(&many).last().map(String::as_str), Some("20"));
        // One value, to rounding, has one colour.
        let level = map(vec![vec![-1.5, -1.5 - 1e-13, -1.5]; 3]);
        assert_eq!(names(&level), ["snaps -1.5"]);
    }
}
