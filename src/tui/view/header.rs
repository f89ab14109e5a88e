//! The first line: which preset, what is controlled, what to be careful about.

use crate::tui::app::App;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use ratatui::text::{Line, Span};

/// Draws the first line.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let (model, theme) = (&app.model, app.theme);
    let name = match &model.source {
        crate::preset::Source::File(path) => {
            path.file_name().map_or_else(|| model.source.shown(), |name| name.to_string_lossy().into_owned())
        }
        source => source.shown(),
    };
    let mut spans = vec![Span::styled(
        format!(" {}", theme.text(&crate::preset::text::sanitize(&name, 30))),
        theme.strong(),
    )];
    if model.is_unsaved() {
        spans.push(Span::styled(" * unsaved", theme.error()));
    }
    let control = model.preset.path.control.to_string().to_uppercase();
    spans.push(Span::raw("  control "));
    spans.push(Span::styled(control, theme.strong()));
    let warning = model.curve.as_ref().and_then(|curve| curve.warnings.first());
    for (key, name) in [("basis.rings", "rings"), ("basis.functions", "functions")] {
        // A warning needs the room more than what the Problem panel says as well.
        if let (Some(count), None) = (model.preset.get(key), warning) {
            spans.push(Span::raw(format!("  {name} {count}")));
        }
    }
    if model.is_computing() {
        spans.push(Span::styled("  computing", theme.key().add_modifier(Modifier::BOLD)));
    }
    if let Some(warning) = warning {
        spans.push(Span::styled(format!("  ! {}", theme.text(warning)), theme.error()));
    } else {
        spans.push(Span::styled(format!("  {}", theme.text(&model.preset.title)), theme.dim()));
    }
    frame.render_widget(Line::from(spans), area);
}
