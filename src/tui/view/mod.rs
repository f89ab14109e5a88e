//! One file per screen region; each takes the app by shared reference and draws.

pub mod charts;
pub mod events;
pub mod header;
pub mod help;
pub mod legend;
mod marks;
pub mod overlays;
mod parts;
pub mod pictures;
pub mod problem;
pub mod status;
pub mod walker;

use super::app::App;
use super::layout::{Regions, SMALLEST, regions};
use super::overlay::Overlay;
use crate::explorer::Panel;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

use parts::is_selected;
pub use pictures::Pictures;
use pictures::What;

/// Lines of inadmissible parts that get room of their own: they come late, and more would move the charts far.
const PARTS: usize = 3;

/// Draws the whole screen, as far as it can from the pictures of the last one, and says for how many views it has room.
pub fn draw(frame: &mut Frame<'_>, app: &App, pictures: &mut Pictures) -> usize {
    // The frame's own area only: the terminal may have changed its size meanwhile.
    let area = frame.area();
    let Some(regions) = places(app, area) else {
        let (width, height) = SMALLEST;
        let text = format!("pulloff needs {width}x{height}, this is {}x{}", area.width, area.height);
        frame.render_widget(Line::raw(text), Rect { height: area.height.min(1), ..area });
        return 1;
    };
    header::draw(frame, regions.header, app);
    if let Some(area) = regions.problem {
        problem::draw(frame, area, app);
    }
    pictures.begin(app);
    draw_kept(frame, app, &regions, pictures);
    pictures.end();
    status::draw(frame, regions.status, regions.footer, app);
    match &app.overlay {
        None => {}
        Some(Overlay::Help(shown)) => help::draw(frame, area, app, shown),
        Some(overlay) => overlays::draw(frame, area, app, overlay),
    }
    regions.charts.len()
}

/// Draws the panels that most keys do not change.
fn draw_kept(frame: &mut Frame<'_>, app: &App, regions: &Regions, pictures: &mut Pictures) {
    let model = &app.model;
    if let Some(area) = regions.walker {
        let selected = is_selected(app, Panel::Walker);
        pictures.show(frame, area, What::Walker, selected, |frame| walker::draw(frame, area, app));
    }
    for (i, (view, area)) in regions.charts.iter().enumerate() {
        let is_first = i == 0;
        let (window, cross) = (model.window(*view), model.cross.filter(|_| is_first));
        let selected = is_first && is_selected(app, Panel::Charts);
        let what = What::Chart { view: *view, window, cross, is_first };
        pictures.show(frame, *area, what, selected, |frame| {
            charts::draw(frame, *area, app, *view, is_first);
        });
    }
    if let Some(area) = regions.events {
        let selected = is_selected(app, Panel::Events);
        let what = What::Events(model.event);
        pictures.show(frame, area, what, selected, |frame| events::draw(frame, area, app));
    }
}

/// Where the regions of a screen of this size are.
pub fn places(app: &App, area: Rect) -> Option<Regions> {
    let events = app.model.shown_events().len() + app.model.shown_inadmissible().len().min(PARTS);
    regions(area, app.model.view, events)
}

#[cfg(test)]
mod tests;
