//! The views: figures given their strokes, letters and colours.

use super::is_selected;
use super::legend::legend;
use crate::contact::Control;
use crate::explorer::{Id, Panel, View, Window};
use crate::figure::{Bounds, Figure, Mark as Placed, Role, Sign, Subject, nearest};
use crate::report::number::short;
use crate::tui::app::App;
use crate::tui::chart::{Chart, Mark, Series};
use crate::tui::stroke::Stroke;
use crate::tui::theme::{Theme, ink};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};

/// The digits of the pinned curves, by number.
const DIGITS: [&str; 6] = ["1", "2", "3", "4", "5", "6"];

/// Draws one view; the first one has the cross-hair and the keys.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App, view: View, first: bool) {
    let selected = first && is_selected(app, Panel::Charts);
    let chart = Subject::of(&app.model).map_or_else(computing, |subject| {
        let figure = subject.figure(view);
        let mut chart = chart(&figure, &app.model.window(view), app.theme);
        if first {
            let hint = format!("  ({}: {})", app.keymap.first(Id::NextView), view.further(1).name());
            let taken = [&chart.title, &chart.note, &hint].map(|text| text.chars().count());
            if taken.iter().sum::<usize>() + 3 <= usize::from(area.width) {
                chart.title.push_str(&hint);
            }
            cross_hair(&subject, view, app.model.cross, &mut chart);
        }
        chart
    });
    chart.draw(frame, area, app.theme, selected);
}

/// The chart before there is a curve.
fn computing() -> Chart {
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
        missing: Some("computing".to_owned()),
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
        areas: figure.areas.iter().map(|area| area.outline.clone()).collect(),
        series: figure
            .lines
            .iter()
            .map(|line| {
                let (stroke, color) = look(line.role);
                Series { points: line.points.clone(), color, stroke }
            })
            .collect(),
        marks: figure.marks.iter().map(mark).collect(),
        cross: None,
        bounds: figure.bounds.part(window),
        legend: legend(figure, theme),
        missing: figure.missing.clone(),
    }
}

/// The cross-hair, and the state of the curve nearest to it.
fn cross_hair(subject: &Subject<'_>, view: View, cross: Option<(f64, f64)>, chart: &mut Chart) {
    chart.cross = cross.map(|share| chart.bounds.at(share));
    if let Some(nearest) = chart.cross.and_then(|at| nearest(subject, view, &chart.bounds, at)) {
        let style = Style::new().fg(ink::WALKER).add_modifier(Modifier::BOLD);
        chart.marks.push(Mark { at: nearest.at, letter: "*", style });
    }
}

/// The stroke and the colour of a line.
pub fn look(role: Role) -> (Stroke, Color) {
    match role {
        Role::Zero | Role::Undeformed | Role::Smooth => (Stroke::Sparse, ink::SMOOTH),
        Role::Envelope => (Stroke::LongDashed, ink::EXACT),
        Role::Exact => (Stroke::Dashed, ink::EXACT),
        Role::Pin(number) => {
            let at = number.saturating_sub(1) % DIGITS.len();
            (Stroke::Lettered(DIGITS[at]), ink::PINS[at])
        }
        Role::Unstable => (Stroke::Dotted, ink::UNSTABLE),
        Role::Stable => (Stroke::Solid, ink::STABLE),
        Role::Inadmissible => (Stroke::Repeated("!"), ink::MARK),
        Role::Body => (Stroke::Solid, ink::BODY),
        Role::Contact | Role::Walk => (Stroke::Solid, ink::WALK),
        Role::Barrier => (Stroke::Dashed, ink::MARK),
        Role::Device => (Stroke::ShortDashed, ink::MARK),
        Role::Jump => (Stroke::Solid, ink::JUMP),
    }
}

/// The letter of a sign.
pub fn letter(sign: Sign) -> &'static str {
    match sign {
        Sign::OtherLimit(Control::Force) => "p",
        Sign::OtherLimit(_) => "d",
        Sign::Limit => "v",
        Sign::PullOff => "X",
        Sign::Landing => "L",
        Sign::Crest => "^",
        Sign::Edge => "|",
        Sign::Minimum => "m",
        Sign::Maximum => "M",
        Sign::Barrier => "B",
        Sign::Stray | Sign::Walker => "@",
    }
}

fn mark(mark: &Placed) -> Mark {
    let style = match mark.sign {
        Sign::OtherLimit(_) => Style::new().fg(ink::MARK),
        Sign::Landing => Style::new().fg(ink::JUMP).add_modifier(Modifier::BOLD),
        Sign::Crest | Sign::Edge => Style::new().fg(ink::SMOOTH),
        Sign::Limit | Sign::PullOff | Sign::Minimum | Sign::Maximum | Sign::Barrier => {
            Style::new().fg(ink::MARK).add_modifier(Modifier::BOLD)
        }
        Sign::Stray => Style::new().fg(ink::SMOOTH).add_modifier(Modifier::REVERSED),
        Sign::Walker => Style::new().fg(ink::WALKER).add_modifier(Modifier::BOLD | Modifier::REVERSED),
    };
    Mark { at: mark.at, letter: letter(mark.sign), style }
}
