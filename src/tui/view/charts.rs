//! The views: figures with their legends, the cross-hair and the selected event.

use super::legend::{legend, on_its_line};
use super::parts::is_selected;
use super::states;
use crate::explorer::{Id, Model, ScreenPanel, View, Window, reach};
use crate::figure::{Area, Axis, Figure, Meaning, Sign, Subject, nearest};
use crate::tui::app::App;
use crate::tui::chart::{Chart, LegendRow};
use crate::tui::marks::style;
use crate::tui::theme::Theme;
use pulloff_engine::gap::Gap;
use pulloff_engine::report::number::short;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Modifier;

/// The role of a view among those on the screen.
#[derive(Debug, Clone, Copy)]
pub struct Seat {
    /// Whether it is the first one, to which the cross-hair and the keys belong.
    pub first: bool,
    /// The view beside it that shares its force axis, and where it is.
    pub beside: Option<(View, Rect)>,
}

/// Draws one view.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App, view: View, seat: Seat) {
    let (model, first) = (&app.model, seat.first);
    let selected = first && is_selected(app, ScreenPanel::Charts);
    if view.is_table() {
        return states::draw(frame, area, app, selected);
    }
    let Some(subject) = Subject::of(model) else {
        chart(&without_curve(app), view, &Window::WHOLE, app.theme).draw(frame, area, selected);
        return;
    };
    let figure = subject.figure(view).on_screen();
    let mut chart = chart(&figure, view, &model.window(view), app.theme);
    if figure.is_even {
        chart.make_even(area);
        chart.hides_tension = is_thin(&subject, area, &chart);
    }
    if first {
        let next = reach::next(model, true).name();
        let hint = format!("  ({}: {next})", app.keymap.first(Id::NextView));
        if chart.heading() + hint.chars().count() + 3 <= usize::from(area.width) {
            chart.title.push_str(&hint);
        }
        chart.cross = model.cross.map(|share| chart.bounds.at(share));
        chart.cross = chart.cross.map(|at| on_its_line(&subject, view, &figure, at));
        let found = chart.cross.and_then(|at| nearest(&subject, view, &chart.bounds, at));
        chart.nearest = found.map(|nearest| nearest.at);
    }
    if view.is_curve() || matches!(view, View::Unloading | View::Map) {
        select_event(model, &mut chart);
    }
    chart.is_paired = seat.beside.is_some();
    if let Some((beside, area)) = seat.beside.filter(|_| !first) {
        let other = subject.figure(beside).on_screen();
        let mut other = self::chart(&other, beside, &model.window(beside), app.theme);
        other.is_paired = true;
        select_event(model, &mut other);
        chart.go_on_with_legend(&other, area);
    }
    chart.draw(frame, area, selected);
}

/// What is shown while there is no curve: it is on its way, or was given up or failed, which the status line explains.
fn without_curve(app: &App) -> Figure {
    let missing = if app.model.is_computing() {
        "computing".to_owned()
    } else {
        let key = app.keymap.first(Id::Restart);
        format!("no curve: {key} or another value computes it again")
    };
    let axis = || Axis::pure(String::new());
    Figure { missing: Some(missing), ..Figure::empty("Curve".to_owned(), axis(), axis()) }
}

/// The part of a figure of `view` in a window, as a chart.
pub fn chart<'a>(figure: &'a Figure, view: View, window: &Window, theme: Theme) -> Chart<'a> {
    // A chart zoomed only vertically shares that part of the axis with its neighbour, whose heading says so.
    let zoom = if window.x == Window::WHOLE.x {
        String::new()
    } else {
        format!(", zoom {}x", short(window.magnification(), 3))
    };
    let bounds = figure.bounds.part(window);
    Chart {
        figure,
        theme,
        title: format!("{}{zoom}", figure.title),
        legend: legend(figure, &bounds, theme),
        bounds,
        compares: view.is_curve(),
        selected: None,
        cross: None,
        nearest: None,
        is_paired: false,
        hides_tension: false,
    }
}

/// With fewer cells than this for half a wave, compression and tension would form a moiré of two shades.
const THIN: f64 = 3.0;

/// Whether half a wave (or, for a gap without waves, a ring under tension) is too thin to be told apart on a screen.
fn is_thin(subject: &Subject<'_>, area: Rect, chart: &Chart<'_>) -> bool {
    let Some(plot) = chart.plot(area) else { return false };
    let cell = (chart.bounds.x[1] - chart.bounds.x[0]) / f64::from(plot.width);
    let wave = subject.curve.case.problem.shape.wavelength();
    let half_wave = wave.map(|wave| 0.5 * subject.scale().radius(wave));
    let width = |area: &Area| {
        let radius = |at: Option<&(f64, f64)>| at.map_or(0.0, |(x, y)| x.hypot(*y));
        // From the outer semicircle to the inner one.
        radius(area.outline.first()) - radius(area.outline.last())
    };
    let tensions = chart.figure.areas.iter().filter(|area| area.meaning == Meaning::Tension);
    tensions.map(width).any(|width| half_wave.unwrap_or(width) < THIN * cell)
}

/// Makes the mark of the selected event stand out, with its number in the legend if the letter does not show it.
fn select_event(model: &Model, chart: &mut Chart<'_>) {
    let log = model.log();
    let Some(number) = log.entries.get(model.event).and_then(|entry| entry.number) else { return };
    chart.selected = chart.figure.marks.iter().position(|mark| match mark.sign {
        Sign::Event(other) | Sign::Passing(other) | Sign::LastContact(other) => other == number,
        _ => false,
    });
    if let Some(at) = chart.selected
        && number > 9
        && let sign @ (Sign::Event(_) | Sign::Passing(_)) = chart.figure.marks[at].sign
    {
        let style = style(sign, chart.theme).add_modifier(Modifier::REVERSED);
        chart
            .legend
            .insert(0, LegendRow { glyph: "v".to_owned(), style, meaning: format!("event {number}") });
    }
}
