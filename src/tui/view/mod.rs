//! One file per screen region; each takes the app by shared reference and draws.

pub mod cells;
pub mod charts;
pub mod header;
pub mod help;
pub mod here;
pub mod legend;
pub mod log;
pub mod overlays;
mod parts;
pub mod problem;
pub mod result;
pub mod states;
pub mod status;

use super::app::App;
use super::layout::{Regions, SMALLEST, Wants, column_width, regions};
use super::overlay::Dialog;
use crate::explorer::ScreenPanel;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::widgets::{Paragraph, Wrap};

use parts::is_selected;

/// Lines of inadmissible parts that get their own room: they come late, and more of them would move the charts far.
const PARTS: usize = 3;

/// Draws the whole screen, and returns how many views it has room for.
pub fn draw(frame: &mut Frame<'_>, app: &App) -> usize {
    // Only the frame's own area: the terminal may have changed its size meanwhile.
    let area = frame.area();
    let Some(regions) = places(app, area) else {
        let (width, height) = SMALLEST;
        let text = format!("pulloff needs {width}x{height}, this is {}x{}", area.width, area.height);
        frame.render_widget(Paragraph::new(text).wrap(Wrap { trim: true }), area);
        return 1;
    };
    header::draw(frame, regions.header, app);
    // The selected panel is drawn last, since shared walls take its style.
    for selected in [false, true] {
        draw_panels(frame, app, &regions, selected);
    }
    status::draw(frame, regions.status, regions.footer, app);
    match &app.overlay {
        None => {}
        Some(Dialog::Help(shown)) => help::draw(frame, area, app, shown),
        Some(overlay) => overlays::draw(frame, area, app, overlay),
    }
    app.theme.shown_by_terminal(frame.buffer_mut());
    regions.charts.len()
}

/// Draws the selected panel, or the others.
fn draw_panels(frame: &mut Frame<'_>, app: &App, regions: &Regions, selected: bool) {
    let is_due = |panel| is_selected(app, panel) == selected;
    if let Some(area) = regions.problem.filter(|_| is_due(ScreenPanel::Problem)) {
        if regions.is_stacked {
            cells::draw(frame, area, app);
        } else {
            problem::draw(frame, area, app);
        }
    }
    if let Some(area) = regions.here.filter(|_| is_due(ScreenPanel::Here)) {
        here::draw(frame, area, app);
    }
    if let Some(area) = regions.result.filter(|_| is_due(ScreenPanel::Result)) {
        result::draw(frame, area, app);
    }
    let pair = match &regions.charts[..] {
        [a, b, ..] if a.0.is_of_force() && b.0.is_of_force() => Some([*a, *b]),
        _ => None,
    };
    for (i, (view, area)) in regions.charts.iter().enumerate() {
        // The keys act on the first one.
        if (i == 0 && is_selected(app, ScreenPanel::Charts)) == selected {
            let beside = pair.filter(|_| i < 2).map(|[a, b]| if i == 0 { b } else { a });
            let seat = charts::Seat { first: i == 0, beside };
            charts::draw(frame, *area, app, *view, seat);
        }
    }
    if let Some(area) = regions.log.filter(|_| is_due(ScreenPanel::Log)) {
        log::draw(frame, area, app);
    }
}

/// Where the regions of a screen of this size are.
pub fn places(app: &App, area: Rect) -> Option<Regions> {
    let model = &app.model;
    let notes = model.curve.as_ref().map_or(0, |curve| curve.base.notes.len());
    let bar = usize::from(model.path().is_some_and(|path| path.turn.is_some()));
    let log = model.log().entries.len() + model.shown_inadmissible().len().min(PARTS) + notes + bar;
    let problem = problem::rows(app, column_width(area));
    let (panel, is_whole) = (model.panel, app.enlarged);
    regions(area, Wants { view: model.view, log, problem, panel, is_whole })
}

#[cfg(test)]
mod tests;
