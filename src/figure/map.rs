//! Lines of a map of two parameters, and limit points over one.
//!
//! A compliance that extends to infinity is placed at c/(c + c₀).

use super::bounds::Bounds;
use super::labels;
use super::parts::{Figure, Line, Mark, Role, Sign};
use super::places::Places;
use super::subject::Subject;
use super::walk::sign_of;
use pulloff_engine::preset::{Key, Preset};
use pulloff_engine::problem::Control;
use pulloff_engine::report::MapReport;
use pulloff_engine::report::map::{AxisReport, MapRow};
use pulloff_engine::report::path::EventReport;
use pulloff_engine::stability::COMPLIANCE;

/// How a row is drawn.
fn role(row: &MapRow) -> (Role, &'static str) {
    match (row.kind, row.stable) {
        ("fold", Some("inward")) => (Role::Unstable, "maximum, stable inward"),
        ("fold", _) => (Role::Stable, "minimum, stable outward"),
        ("cusp" | "landing", _) if row.changes == Some(false) => {
            (Role::Unchanged, "number of snaps unchanged")
        }
        ("landing", _) => (Role::Landings, "line of landings"),
        ("start", _) => (Role::Starts, "limit point at the start"),
        ("change", _) => (Role::Starts, "number of snaps changes"),
        _ => (Role::Cusps, "line of cusps"),
    }
}

/// The lines and marks of `report` at these positions.
fn drawn(report: &MapReport, x: &Places, y: &Places) -> (Vec<Line>, Vec<Mark>) {
    let place = |row: &MapRow| (x.at(row.x), y.at(row.y));
    let is_map = report.counts.is_some();
    let (mut lines, mut marks): (Vec<Line>, Vec<Mark>) = (Vec::new(), Vec::new());
    let of_line = |row: &MapRow| (row.line, row.kind == "swallowtail");
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
        // Each stretch of one role, joined to the previous one.
        let mut from = 0;
        for stretch in rows.chunk_by(|a, b| role(a) == role(b)) {
            let (role, name) = role(&stretch[0]);
            let joint = from.max(1) - 1;
            let points = rows[joint..from + stretch.len()].iter().map(place).collect();
            lines.push(Line::new(role, name, points));
            from += stretch.len();
        }
    }
    // Lines that matter are drawn above those that do not.
    lines.sort_by_key(|line| line.role);
    (lines, marks)
}

/// Everything drawn of `report` over these axes, with `preset` at its position.
pub fn laid(report: &MapReport, preset: &Preset, x: &Places, y: &Places) -> Figure {
    let (lines, marks) = drawn(report, x, y);
    let mut figure = Figure::of(x.axis.clone(), y.axis.clone(), lines);
    figure.marks = marks;
    figure.marks.extend(labels::counts(report, x, y));
    if let (Some(x), Some(y)) = (standing(preset, &report.x, x), standing(preset, &report.y, y)) {
        figure.marks.push(Mark { sign: Sign::Preset, at: (x, y) });
    }
    // Where an axis follows from the lines, they bound it.
    let found = figure.bounds;
    figure.bounds = Bounds { x: x.ends.unwrap_or(found.x), y: y.ends.unwrap_or(found.y) };
    labels::crests(report, x, y, &mut figure);
    figure
}

/// The position of a preset on an axis.
fn standing(preset: &Preset, axis: &AxisReport, places: &Places) -> Option<f64> {
    if axis.key != COMPLIANCE {
        return Some(places.at(Some(preset.get(&axis.key)?.as_number()?)));
    }
    Some(places.at(match preset.path.control {
        Control::Displacement => Some(0.0),
        Control::Stiffness(k) => Some(1.0 / k),
        Control::Force => None,
    }))
}

/// The events of the path, each on its curve of limit points.
fn events(report: &MapReport, subject: &Subject<'_>, x: &Places, y: &Places) -> Vec<Mark> {
    let curve = subject.curve;
    let Some(x) = standing(&curve.setting.preset, &report.x, x) else { return Vec::new() };
    let events = curve.report.iter().flat_map(|report| &report.events);
    let place = |event: &EventReport| match report.y.key.as_str() {
        "approach" => event.before.as_ref().map(|before| before.approach),
        "force" => event.before.as_ref().map(|before| before.force),
        _ => Some(event.control),
    };
    events.map(|event| Mark { sign: sign_of(event), at: (x, y.at(place(event))) }).collect()
}

/// The curve of limit points that passes through the mark of an event.
fn through(figure: &Figure, at: (f64, f64)) -> Option<Vec<(f64, f64)>> {
    /// As a share of the axis.
    const NEAR: f64 = 0.01;
    let [from, to] = figure.places().y;
    let (x, y) = figure.place(at);
    let off = |line: &Line| {
        let points: Vec<(f64, f64)> = line.points.iter().map(|at| figure.place(*at)).collect();
        let pairs = points.windows(2).filter(|pair| (pair[0].0 - x) * (pair[1].0 - x) <= 0.0);
        let away = |pair: &[(f64, f64)]| {
            let [(a, from), (b, to)] = [pair[0], pair[1]];
            // On a vertical piece neither end is nearer.
            let share = ((x - a) / (b - a)).clamp(0.0, 1.0);
            let share = if share.is_nan() { 0.5 } else { share };
            (from + (to - from) * share - y).abs()
        };
        pairs.map(away).fold(f64::INFINITY, f64::min)
    };
    // An event begins where the control is smallest, whichever way the edge then runs.
    let lines = figure.lines.iter().filter(|line| matches!(line.role, Role::Stable | Role::Unstable));
    let (off, line) = lines.map(|line| (off(line), line)).min_by(|a, b| a.0.total_cmp(&b.0))?;
    (off <= NEAR * (to - from)).then(|| line.points.clone())
}

/// The figure of `report`, with the preset at its position.
pub fn figure(report: &MapReport, subject: &Subject<'_>) -> Figure {
    let preset = subject.preset;
    let places = |axis| Places::of(axis, preset, report.control);
    let (x, y) = (places(&report.x), places(&report.y));
    let mut figure = laid(report, preset, &x, &y);
    let is_map = report.counts.is_some();
    if !is_map {
        let events = events(report, subject, &x, &y);
        if let Some((number, mark)) = subject.event.and_then(|n| Some((n, events.get(n.checked_sub(1)?)?)))
            && let Some(points) = through(&figure, mark.at)
        {
            figure.lines.push(Line::new(Role::Chosen, format!("event {number}"), points));
        }
        figure.marks.extend(events);
    }
    let of = if subject.is_one_disc() { "" } else { ", of the exact equation of one disc" };
    let what = if is_map { "where snaps begin" } else { "each limit point" };
    figure.title = format!("{what}, {} over {}{of}", y.axis.symbol, x.axis.symbol);
    figure.notes.clone_from(&report.notes);
    figure
}

/// The assignments of keys that take a preset to a point of the figure.
pub fn taken(report: &MapReport, preset: &Preset, (x, y): (f64, f64)) -> Vec<(Key, String)> {
    let assignment = |axis: &AxisReport, place: f64| {
        // A value of limit points is not a parameter of the preset.
        if axis.key != COMPLIANCE && preset.row(&axis.key).is_none() {
            return None;
        }
        let value = Places::of(axis, preset, report.control).value(place);
        // Only a few digits of the number are meaningful.
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

/// The number of snaps at a point of the figure, in words: where the counts around it differ, from the least to the most of
/// them. `None` for limit points over one number.
pub fn count(report: &MapReport, preset: &Preset, (x, y): (f64, f64)) -> Option<String> {
    /// As a share of an axis.
    const ROUNDING: f64 = 1e-9;
    let counts = report.counts.as_ref()?;
    // The lines of the grid on either side.
    let around = |axis: &AxisReport, values: &[Option<f64>], place: f64| {
        let places = Places::of(axis, preset, report.control);
        let at: Vec<f64> = values.iter().map(|value| places.at(*value)).collect();
        // The borders belong to the map, whatever the rounding.
        let slack = ROUNDING * (at.last()? - at.first()?);
        let below = at.iter().rposition(|at| *at <= place + slack)?;
        let above = at.iter().position(|at| *at >= place - slack)?;
        Some([below, above])
    };
    let Some((columns, rows)) = around(&report.x, &counts.x, x).zip(around(&report.y, &counts.y, y)) else {
        return Some("outside the map".to_owned());
    };
    let cells = rows.into_iter().flat_map(|row| columns.map(|column| counts.snaps[row][column]));
    let cells: Vec<Option<usize>> = cells.collect();
    let found = || cells.iter().flatten();
    let said = match (found().min(), found().max()) {
        (Some(1), Some(1)) => "1 snap".to_owned(),
        (Some(least), Some(most)) if least == most => format!("{least} snaps"),
        (Some(least), Some(most)) => format!("{least} to {most} snaps"),
        _ => return Some("no path here".to_owned()),
    };
    Some(if cells.contains(&None) { format!("{said}, or no path") } else { said })
}

/// A number rounded to four digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}
