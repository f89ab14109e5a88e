//! The views: figures given their strokes, letters and colours.

use super::legend::legend;
use super::marks::{letter, look, style};
use super::parts::is_selected;
use super::states;
use crate::explorer::{EventSource, Id, Panel, View, Window, reach};
use crate::figure::{Area, Bounds, Figure, Mark as Placed, Meaning, Role, Sign, Subject, nearest};
use crate::tui::app::App;
use crate::tui::chart::{Chart, Entry, Mark, Region, Series};
use crate::tui::raster::Meets;
use crate::tui::theme::Theme;
use pulloff_engine::gap::Gap;
use pulloff_engine::report::number::short;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Modifier;

/// Draws one view; the first one has the cross-hair and the keys.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App, view: View, first: bool) {
    let selected = first && is_selected(app, Panel::Charts);
    if view.is_table() {
        return states::draw(frame, area, app, selected);
    }
    let chart = Subject::of(&app.model).map_or_else(
        || without_curve(app),
        |subject| {
            let figure = subject.figure(view);
            let mut chart = chart(&figure, &app.model.window(view), app.theme);
            if view == View::Contact {
                chart.make_even(area);
                leave_out_thin(&subject, &figure, area, &mut chart);
            }
            if first {
                let hint = format!(
                    "  ({}: {})",
                    app.keymap.first(Id::NextView),
                    reach::next(&app.model, true).name()
                );
                let taken = [&chart.title, &chart.note, &hint].map(|text| text.chars().count());
                if taken.iter().sum::<usize>() + 3 <= usize::from(area.width) {
                    chart.title.push_str(&hint);
                }
                cross_hair(&subject, view, app, &mut chart);
            }
            if view.is_curve() || view == View::Unloading {
                select_event(app, &figure, &mut chart);
            }
            chart
        },
    );
    chart.draw(frame, area, app.theme, selected);
}

/// The chart while there is no curve: on its way, or given up or failed, which the status line explains.
fn without_curve(app: &App) -> Chart {
    let missing = if app.model.is_computing() {
        "computing".to_owned()
    } else {
        let key = app.keymap.first(Id::Restart);
        format!("no curve: {key} computes it again, and so does another value")
    };
    Chart {
        title: "Curve".to_owned(),
        note: String::new(),
        x_title: String::new(),
        areas: Vec::new(),
        series: Vec::new(),
        marks: Vec::new(),
        cross: None,
        bounds: Bounds::of([]),
        legend: Vec::new(),
        missing: Some(missing),
    }
}

/// A figure as a chart.
pub fn chart(figure: &Figure, window: &Window, theme: Theme) -> Chart {
    let zoom = if window.is_whole() {
        String::new()
    } else {
        format!(", zoom {}x", short(window.magnification(), 3))
    };
    let bounds = figure.bounds.part(window);
    Chart {
        title: format!("{}{zoom}", figure.title),
        note: figure.notes.join(", "),
        x_title: figure.x.title(),
        areas: figure.areas.iter().enumerate().map(|(at, area)| region(at, area, theme)).collect(),
        series: series(figure, theme),
        marks: figure.marks.iter().map(|placed| mark(placed, theme)).collect(),
        cross: None,
        bounds,
        legend: legend(figure, &bounds, theme),
        missing: figure.missing.clone(),
    }
}

/// The curve that a line is a part of: its stable and unstable parts are one.
fn curve_of(role: Role) -> Role {
    if role == Role::Unstable { Role::Stable } else { role }
}

/// The curves, each with all its parts, the curve of the problem last of those that share cells.
fn series(figure: &Figure, theme: Theme) -> Vec<Series> {
    let mut all: Vec<(Role, Series)> = Vec::new();
    for line in &figure.lines {
        let (curve, stroke) = (curve_of(line.role), look(line.role, theme));
        let part = (line.points.clone(), line.is_broken || stroke.is_broken);
        match all.iter_mut().find(|(other, _)| *other == curve) {
            Some((_, series)) => series.parts.push(part),
            None => all.push((curve, Series { parts: vec![part], stroke: look(curve, theme) })),
        }
    }
    all.sort_by_key(|(role, _)| (*role == Role::Stable, *role));
    if !figure.view.is_curve() {
        // Curves of states are not compared: the computed one is seen where others agree with it.
        for (role, series) in &mut all {
            if !matches!(role, Role::Stable | Role::Body | Role::Edges)
                && series.stroke.meets == Meets::Shares
            {
                series.stroke.meets = Meets::Beneath;
            }
        }
    }
    all.into_iter().map(|(_, series)| series).collect()
}

fn region(at: usize, area: &Area, theme: Theme) -> Region {
    let styles = theme.styles();
    let (style, shade) = match area.meaning {
        // Neighbours differ.
        Meaning::Lost if at.is_multiple_of(2) => (styles.lost, theme.shade("░", "/")),
        Meaning::Lost => (styles.lost, theme.shade("▒", "\\")),
        Meaning::Contact => (styles.curve, theme.shade("▒", "#")),
        Meaning::Tension => (styles.curve, theme.shade("░", "-")),
    };
    Region { outline: area.outline.clone(), style, shade }
}

/// Half a wave of fewer cells than these would make compression and tension a moiré of two shades.
const THIN: f64 = 3.0;

/// Leaves out where the bodies pull, if half a wave (of a gap without waves, the ring itself) is too thin for it.
fn leave_out_thin(subject: &Subject<'_>, figure: &Figure, area: Rect, chart: &mut Chart) {
    let Some(plot) = chart.plot(area) else { return };
    let cell = (chart.bounds.x[1] - chart.bounds.x[0]) / f64::from(plot.width);
    let wave = subject.curve.case.problem.shape.wavelength();
    let half_wave = wave.map(|wave| 0.5 * subject.scale().radius(wave));
    let is_thick = |area: &Area| {
        let radius = |at: Option<&(f64, f64)>| at.map_or(0.0, |(x, y)| x.hypot(*y));
        // From the outer half circle to the inner one.
        let width = radius(area.outline.first()) - radius(area.outline.last());
        area.meaning != Meaning::Tension || half_wave.unwrap_or(width) >= THIN * cell
    };
    let mut kept = figure.areas.iter().map(is_thick);
    chart.areas.retain(|_| kept.next().unwrap_or(true));
}

/// The cross-hair, and the state of the curve nearest to it.
fn cross_hair(subject: &Subject<'_>, view: View, app: &App, chart: &mut Chart) {
    chart.cross = app.model.cross.map(|share| chart.bounds.at(share));
    if let Some(nearest) = chart.cross.and_then(|at| nearest(subject, view, &chart.bounds, at)) {
        let style = app.theme.styles().nearest;
        chart.marks.push(Mark { at: nearest.at, letter: "*".to_owned(), style, is_beside: false });
    }
}

fn mark(mark: &Placed, theme: Theme) -> Mark {
    let is_beside = matches!(mark.sign, Sign::OtherLimit(_) | Sign::Limit | Sign::Event(_));
    Mark { at: mark.at, letter: letter(mark.sign, theme), style: style(mark.sign, theme), is_beside }
}

/// The mark of the selected event stands out, and has its number where the letter has none.
fn select_event(app: &App, figure: &Figure, chart: &mut Chart) {
    let model = &app.model;
    if model.events != EventSource::Curve {
        return;
    }
    let number = model.event + 1;
    let count = model.shown_events().len();
    for (placed, mark) in figure.marks.iter().zip(&mut chart.marks) {
        let is_it = match placed.sign {
            Sign::Event(other) => other == number,
            Sign::PullOff => number == count,
            _ => false,
        };
        if is_it {
            mark.style = mark.style.add_modifier(Modifier::REVERSED);
            if number > 9 && placed.sign != Sign::PullOff {
                let entry =
                    Entry { glyph: "v".to_owned(), style: mark.style, meaning: format!("event {number}") };
                chart.legend.insert(0, entry);
            }
        }
    }
}
