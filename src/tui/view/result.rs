//! What comes of the path: A, B, the last contact, the snaps and what they lose.

use super::log::snaps;
use super::parts::{is_selected, pair, panel};
use crate::explorer::{Model, Panel, View};
use crate::figure::Scale;
use crate::tui::app::App;
use crate::tui::theme::Theme;
use pulloff_engine::report::PathReport;
use pulloff_engine::report::number::{loss, significant, with_unit};
use pulloff_engine::report::path::StateReport;
use pulloff_engine::units::Quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

/// Draws what comes of the path.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let (model, theme) = (&app.model, app.theme);
    let block = panel(theme, "Result", is_selected(app, Panel::Result));
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let lines = match model.path() {
        Some(path) => lines(theme, model, path),
        None => vec![Line::styled(" no path yet", theme.dim())],
    };
    frame.render_widget(Paragraph::new(lines), inner);
}

fn lines(theme: Theme, model: &Model, path: &PathReport) -> Vec<Line<'static>> {
    let Some(curve) = model.curve.as_deref() else { return Vec::new() };
    let scale = Scale::of(curve, model.axes);
    let [length, force] = scale.axes(View::ForceApproach);
    let [radius, _] = scale.axes(View::ForceRadius);
    let shown = |symbol: &str, x: f64| pair(theme, &format!("{symbol} "), &significant(x, 4));
    let state = |at: &StateReport| {
        let approach = shown(&length.symbol, scale.length(at.approach));
        let radius = shown(&radius.symbol, scale.radius(at.contact_radius));
        Line::from(
            [vec![Span::raw("  ")], approach.to_vec(), vec![Span::raw("  ")], radius.to_vec()].concat(),
        )
    };
    let head = |name: &str, value: [Span<'static>; 2]| {
        Line::from([vec![Span::raw(theme.text(name))], value.to_vec()].concat())
    };
    let totals = &path.totals;
    let mut lines = Vec::new();
    for (name, at) in [(" A largest pull", &totals.largest_pull), (" B farthest", &totals.farthest)] {
        let Some(at) = at else { continue };
        lines.push(Line::raw(name.to_owned()));
        lines.push(head("  ", shown(&force.symbol, scale.force(at.force))));
        lines.push(state(at));
    }
    if let Some(event) = path.events.iter().find(|event| event.kind == "last-contact") {
        lines.push(head(" last contact", pair(theme, "  event ", &event.number.to_string())));
    }
    let lost = totals.dissipated.unwrap_or(totals.dissipated_before_last_contact);
    let lost = with_unit(&model.preset.units, Quantity::Energy, lost, theme.ascii, loss);
    let fall = if totals.dissipated.is_none() { "+" } else { "" };
    lines.push(head(" ", pair(theme, "snaps ", &format!("{}", snaps(path)))));
    lines.push(head(" ", pair(theme, "lost ", &format!("{lost}{fall}"))));
    lines
}
