//! Lines of a map of two numbers, and limit points over one.
//!
//! On a screen, whose axes are even, the places on a logarithmic axis are decimal logarithms; a compliance that goes on to
//! infinity stands at c/(c + c₀).

use super::bounds::Bounds;
use super::parts::{Axis, Figure, Line, Mark, Role, Sign};
use pulloff_engine::preset::{Key, Preset};
use pulloff_engine::problem::Control;
use pulloff_engine::report::MapReport;
use pulloff_engine::report::map::{AxisReport, RowReport};
use pulloff_engine::report::number::significant;
use pulloff_engine::stability::COMPLIANCE;
use pulloff_engine::text::greek;
use pulloff_engine::units::Quantity;
use std::collections::VecDeque;

/// Where the numbers of an axis stand on it.
#[derive(Debug, Clone)]
pub struct Places {
    /// What stands beside it.
    pub axis: Axis,
    factor: f64,
    logarithmic: bool,
    middle: Option<f64>,
    ends: Option<[f64; 2]>,
}

impl Places {
    /// The places of an axis of a map of `preset`; with `even` those of a logarithmic axis are logarithms.
    pub fn of(axis: &AxisReport, preset: &Preset, control: Control, even: bool) -> Self {
        let quantity = match axis.key.as_str() {
            "control" if control == Control::Force => Quantity::Force,
            "force" => Quantity::Force,
            "control" | "approach" => Quantity::Length,
            key => preset.row(key).map_or(Quantity::Number, |row| row.quantity),
        };
        let symbol = match axis.key.as_str() {
            "control" if control == Control::Force => "P".to_owned(),
            "control" if matches!(control, Control::Stiffness(_)) => "Δ".to_owned(),
            "control" | "approach" => "δ".to_owned(),
            "force" => "P".to_owned(),
            COMPLIANCE => "1/k".to_owned(),
            key => preset.row(key).map_or_else(|| key.to_owned(), |row| greek(&row.label)),
        };
        let row = preset.row(&axis.key);
        let own = row.as_ref().and_then(|row| row.unit_in(&preset.units));
        let unit = own.or_else(|| preset.units.unit(quantity));
        let shown = unit.map_or_else(String::new, ToString::to_string);
        let factor = unit.map_or(1.0, |unit| unit.from_si(1.0));
        let logarithmic = axis.logarithmic && even;
        let symbol = match axis.middle {
            Some(middle) => format!("c/(c + c0), c = 1/k, c0 = {}", significant(middle, 3)),
            None if logarithmic => format!("log {symbol}"),
            None => symbol,
        };
        let axis_of = Axis { shown, ..Axis::pure(symbol) };
        let mut places = Self { axis: axis_of, factor, logarithmic, middle: axis.middle, ends: None };
        places.ends = axis.from.map(|from| [places.at(Some(from)), places.at(axis.to)]);
        places
    }

    /// The place of a number, in SI or reduced units; `None` is infinity.
    pub fn at(&self, value: Option<f64>) -> f64 {
        match (self.middle, value) {
            (Some(_), None) => 1.0,
            (Some(middle), Some(value)) => value / (value + middle),
            (None, Some(value)) if self.logarithmic => (value * self.factor).log10(),
            (None, Some(value)) => value * self.factor,
            (None, None) => f64::NAN,
        }
    }

    /// The number at a place; `None` is infinity.
    pub fn value(&self, place: f64) -> Option<f64> {
        match self.middle {
            Some(_) if place >= 1.0 => None,
            Some(middle) => Some(middle * place.max(0.0) / (1.0 - place)),
            None if self.logarithmic => Some(10f64.powf(place) / self.factor),
            None => Some(place / self.factor),
        }
    }
}

/// What a row is drawn as.
fn role(row: &RowReport) -> (Role, &'static str) {
    match (row.kind, row.stable) {
        ("fold", Some("inward")) => (Role::Unstable, "maximum, jumps outward"),
        ("fold", _) => (Role::Stable, "minimum, jumps inward"),
        ("cusp" | "landing", _) if row.changes == Some(false) => (Role::Unchanged, "the count stays"),
        ("landing", _) => (Role::Landings, "line of landings"),
        ("start", _) => (Role::Starts, "limit point at the start"),
        _ => (Role::Cusps, "line of cusps"),
    }
}

/// The lines and marks of `report` at these places.
fn drawn(report: &MapReport, x: &Places, y: &Places) -> (Vec<Line>, Vec<Mark>) {
    let place = |row: &RowReport| (x.at(row.x), y.at(row.y));
    let is_map = report.counts.is_some();
    let (mut lines, mut marks): (Vec<Line>, Vec<Mark>) = (Vec::new(), Vec::new());
    let of_line = |row: &RowReport| (row.line, row.kind == "swallowtail");
    for rows in report.rows.chunk_by(|a, b| of_line(a) == of_line(b) && a.kind == b.kind) {
        let sign = match rows[0].kind {
            "swallowtail" => Some(Sign::Swallowtail),
            "cusp" if !is_map => Some(Sign::Cusp),
            "landing" if !is_map => Some(Sign::Landing),
            _ => None,
        };
        if let Some(sign) = sign {
            marks.extend(rows.iter().map(|row| Mark { sign, at: place(row) }));
            continue;
        }
        // Each stretch of one role, joined to the one before.
        let mut from = 0;
        for stretch in rows.chunk_by(|a, b| role(a) == role(b)) {
            let (role, name) = role(&stretch[0]);
            let joint = from.max(1) - 1;
            let points = rows[joint..from + stretch.len()].iter().map(place).collect();
            lines.push(Line::new(role, name, points));
            from += stretch.len();
        }
    }
    // What counts above what does not.
    lines.sort_by_key(|line| line.role);
    (lines, marks)
}

/// The number of snaps in each region of the map, where it is widest.
///
/// A region is cells next to each other with one count; its label stands on the cell that is farthest from all others.
fn counts(report: &MapReport, x: &Places, y: &Places) -> Vec<Mark> {
    /// Nearer to its border than so many cells a region has no room for a number.
    const ROOM: usize = 2;
    let Some(counts) = &report.counts else { return Vec::new() };
    let cells = &counts.snaps;
    let [width, height] = [counts.x.len(), counts.y.len()];
    let next = |(i, j): (usize, usize)| {
        let near = [(i.wrapping_sub(1), j), (i + 1, j), (i, j.wrapping_sub(1)), (i, j + 1)];
        near.into_iter().filter(move |(i, j)| *i < width && *j < height)
    };
    let places = || (0..height).flat_map(|j| (0..width).map(move |i| (i, j)));
    // How many steps it is from each cell to another count, or out of the map.
    let mut depth = vec![vec![0_usize; width]; height];
    let on_border = |(i, j): (usize, usize)| {
        next((i, j)).count() < 4 || next((i, j)).any(|(a, b)| cells[b][a] != cells[j][i])
    };
    let mut edge: VecDeque<(usize, usize)> = places().filter(|place| on_border(*place)).collect();
    for (i, j) in &edge {
        depth[*j][*i] = 1;
    }
    while let Some((i, j)) = edge.pop_front() {
        for (a, b) in next((i, j)) {
            if depth[b][a] == 0 {
                depth[b][a] = depth[j][i] + 1;
                edge.push_back((a, b));
            }
        }
    }
    let mut seen = vec![vec![false; width]; height];
    let mut marks = Vec::new();
    for place in places() {
        let Some(count) = cells[place.1][place.0].filter(|_| !seen[place.1][place.0]) else { continue };
        let mut deepest = place;
        let mut region = vec![place];
        seen[place.1][place.0] = true;
        while let Some((i, j)) = region.pop() {
            if depth[j][i] > depth[deepest.1][deepest.0] {
                deepest = (i, j);
            }
            for (a, b) in next((i, j)) {
                if !seen[b][a] && cells[b][a] == Some(count) {
                    seen[b][a] = true;
                    region.push((a, b));
                }
            }
        }
        if depth[deepest.1][deepest.0] >= ROOM {
            let at = (x.at(counts.x[deepest.0]), y.at(counts.y[deepest.1]));
            marks.push(Mark { sign: Sign::Snaps(count), at });
        }
    }
    marks
}

/// All that is drawn of `report` over these axes, with `preset` at its place.
pub fn laid(report: &MapReport, preset: &Preset, x: &Places, y: &Places) -> (Vec<Line>, Vec<Mark>, Bounds) {
    let (lines, mut marks) = drawn(report, x, y);
    marks.extend(counts(report, x, y));
    let number = |key: &str| preset.get(key).and_then(|value| value.as_number());
    if let (Some(a), Some(b)) = (number(&report.x.key), number(&report.y.key)) {
        marks.push(Mark { sign: Sign::Preset, at: (x.at(Some(a)), y.at(Some(b))) });
    }
    let bounds = bounds(x, y, &lines);
    (lines, marks, bounds)
}

/// Bounds of the axes, or of what is drawn where an axis follows from it.
fn bounds(x: &Places, y: &Places, lines: &[Line]) -> Bounds {
    let found = Bounds::of(lines.iter().flat_map(|line| line.points.iter().copied()));
    Bounds { x: x.ends.unwrap_or(found.x), y: y.ends.unwrap_or(found.y) }
}

/// The figure of `report` on a screen, with `preset` at its place.
pub fn figure(report: &MapReport, preset: &Preset) -> Figure {
    let places = |axis| Places::of(axis, preset, report.control, true);
    let (x, y) = (places(&report.x), places(&report.y));
    let (lines, marks, bounds) = laid(report, preset, &x, &y);
    let title = match &report.onset {
        Some(onset) => {
            let smallest = significant(onset.amplitude_over_wavelength, 4);
            format!("where snaps begin; under {} at A/λ = {smallest}", report.control)
        }
        None => "where snaps begin".to_owned(),
    };
    let mut figure = Figure::empty(title, x.axis, y.axis);
    figure.lines = lines;
    figure.marks = marks;
    figure.bounds = bounds;
    figure.notes.clone_from(&report.notes);
    figure
}

/// What a preset becomes at a point of the figure, as assignments of its keys.
pub fn taken(report: &MapReport, preset: &Preset, (x, y): (f64, f64)) -> Vec<(Key, String)> {
    let assignment = |axis: &AxisReport, place: f64| {
        let value = Places::of(axis, preset, report.control, true).value(place);
        // Of the number alone no more is meant than a few digits.
        let text = value.map(|value| format!("{:e}", rounded(value)));
        if axis.key != COMPLIANCE {
            return Some((Key::Owned(axis.key.clone()), text?));
        }
        let control = match value {
            None => Control::Force,
            Some(c) if c <= 0.0 => Control::Displacement,
            Some(c) => Control::Stiffness(rounded(1.0 / c)),
        };
        Some((Key::Borrowed("path.control"), control.to_string()))
    };
    assignment(&report.x, x).into_iter().chain(assignment(&report.y, y)).collect()
}

/// A number to four digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}
