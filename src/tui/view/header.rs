//! The first line: which preset, what is controlled, what to be careful about.

use crate::contact::Control;
use crate::explorer::{Axes, Model};
use crate::report::number::{significant, with_unit};
use crate::tui::app::App;
use crate::units::Quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use ratatui::text::{Line, Span};

/// The stiffness of the device over that of the contact at the walker, on reduced axes.
fn stiffness_share(model: &Model) -> Option<f64> {
    let node = model.history.current().filter(|node| !node.is_apart() && model.axes == Axes::Reduced)?;
    let Control::Stiffness(k) = model.preset.path.control else { return None };
    Some(k / node.stiffness.in_units(node.setting.case.units()).contact)
}

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
    let control = match model.preset.path.control {
        Control::Stiffness(k) => {
            let k =
                with_unit(&model.preset.units, Quantity::ForcePerLength, k, theme.ascii, |k| k.to_string());
            format!("STIFFNESS={k}")
        }
        other => other.to_string().to_uppercase(),
    };
    spans.push(Span::raw("  control "));
    spans.push(Span::styled(control, theme.strong()));
    if let Some(share) = stiffness_share(model) {
        spans.push(Span::styled(
            theme.text(&format!(" ({} of the contact's)", significant(share, 3))),
            theme.dim(),
        ));
    }
    let warning = model.curve.as_ref().and_then(|curve| curve.sweep.warnings.first());
    for (key, name) in [("basis.rings", "rings"), ("basis.functions", "functions")] {
        // A warning needs the room more than what the Problem panel says as well.
        if let (Some(count), None) = (model.preset.get(key), warning) {
            spans.push(Span::raw(format!("  {name} {count}")));
        }
    }
    if model.is_computing() {
        let far = model.progress.map_or_else(String::new, |progress| format!(" {}", progress.text()));
        spans.push(Span::styled(format!("  computing{far}"), theme.key().add_modifier(Modifier::BOLD)));
    }
    if let Some(warning) = warning {
        spans.push(Span::styled(format!("  ! {}", theme.text(warning)), theme.error()));
    } else {
        spans.push(Span::styled(format!("  {}", theme.text(&model.preset.title)), theme.dim()));
    }
    frame.render_widget(Line::from(spans), area);
}
