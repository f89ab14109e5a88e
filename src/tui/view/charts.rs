//! The views: figures given their strokes, letters and colours.

use super::legend::legend;
use super::marks::{letter, look};
use super::parts::is_selected;
use crate::explorer::{Id, Panel, View, Window};
use crate::figure::{Area, Bounds, Figure, Mark as Placed, Meaning, Sign, Subject, nearest};
use crate::tui::app::App;
use crate::tui::chart::{Chart, Mark, Region, Series};
use crate::tui::hatch::Texture;
use crate::tui::theme::{Styles, Theme};
use pulloff_engine::report::number::short;
use ratatui::Frame;
use ratatui::layout::Rect;

/// Draws one view; the first one has the cross-hair and the keys.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App, view: View, first: bool) {
    let selected = first && is_selected(app, Panel::Charts);
    let chart = Subject::of(&app.model).map_or_else(
        || without_curve(app),
        |subject| {
            let figure = subject.figure(view);
            let mut chart = chart(&figure, &app.model.window(view), app.theme);
            if view == View::Contact {
                chart.make_even(area);
            }
            if first {
                let hint = format!("  ({}: {})", app.keymap.first(Id::NextView), view.further(1).name());
                let taken = [&chart.title, &chart.note, &hint].map(|text| text.chars().count());
                if taken.iter().sum::<usize>() + 3 <= usize::from(area.width) {
                    chart.title.push_str(&hint);
                }
                cross_hair(&subject, view, app, &mut chart);
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
    Chart {
        title: format!("{}{zoom}", figure.title),
        note: figure.notes.join(", "),
        x_title: figure.x.title(),
        areas: figure.areas.iter().map(|area| region(area, theme.styles())).collect(),
        series: figure
            .lines
            .iter()
            .map(|line| {
                let (stroke, style) = look(line.role, theme.styles());
                Series { points: line.points.clone(), style, stroke }
            })
            .collect(),
        marks: figure.marks.iter().map(|placed| mark(placed, theme.styles())).collect(),
        cross: None,
        bounds: figure.bounds.part(window),
        legend: legend(figure, theme),
        missing: figure.missing.clone(),
    }
}

fn region(area: &Area, styles: &Styles) -> Region {
    let (style, texture) = match area.meaning {
        Meaning::Lost => (styles.lost, Texture::Slanting),
        Meaning::Contact => (styles.stable, Texture::Dotted),
    };
    Region { outline: area.outline.clone(), style, texture }
}

/// The cross-hair, and the state of the curve nearest to it.
fn cross_hair(subject: &Subject<'_>, view: View, app: &App, chart: &mut Chart) {
    chart.cross = app.model.cross.map(|share| chart.bounds.at(share));
    if let Some(nearest) = chart.cross.and_then(|at| nearest(subject, view, &chart.bounds, at)) {
        chart.marks.push(Mark { at: nearest.at, letter: "*", style: app.theme.styles().nearest });
    }
}

fn mark(mark: &Placed, styles: &Styles) -> Mark {
    let style = match mark.sign {
        Sign::OtherLimit(_) => styles.aid,
        Sign::Landing => styles.landing,
        Sign::Crest | Sign::Edge | Sign::Snaps(_) | Sign::Measured { .. } => styles.smooth,
        Sign::Touch
        | Sign::Turn
        | Sign::Limit
        | Sign::PullOff
        | Sign::Minimum
        | Sign::Maximum
        | Sign::Barrier
        | Sign::Cusp
        | Sign::Swallowtail
        | Sign::Value => styles.mark,
        Sign::Stray => styles.stray,
        Sign::Walker | Sign::Preset => styles.walker,
    };
    Mark { at: mark.at, letter: letter(mark.sign), style }
}
