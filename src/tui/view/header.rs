//! The first line: which preset, what is controlled, what to be careful about.

use super::parts::fitted;
use crate::explorer::pins::changes;
use crate::explorer::{Axes, Model};
use crate::tui::app::App;
use crate::tui::keymap::Keymap;
use pulloff_engine::problem::Control;
use pulloff_engine::report::number::{significant, with_unit};
use pulloff_engine::text::greek;
use pulloff_engine::units::Quantity;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use ratatui::text::{Line, Span};

/// The stiffness of the device over that of the contact at the walker, on reduced axes.
fn stiffness_share(model: &Model) -> Option<f64> {
    let node = model.history.current().filter(|node| !node.is_apart() && model.axes == Axes::Reduced)?;
    let Control::Stiffness(k) = model.preset.path.control else { return None };
    Some(k / node.stiffness.in_units(node.setting.units()).contact)
}

/// Draws the first line.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let (model, theme) = (&app.model, app.theme);
    let name = match &model.source {
        crate::store::Source::File(path) => {
            path.file_name().map_or_else(|| model.source.shown(), |name| name.to_string_lossy().into_owned())
        }
        source => source.shown(),
    };
    let mut spans = vec![Span::styled(
        format!(" {}", theme.text(&pulloff_engine::text::sanitize(&name, 30))),
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
    let warnings = model.curve.iter().flat_map(|curve| &curve.base.warnings);
    let warnings: Vec<String> = warnings.map(|text| theme.text(text)).collect();
    // What is under way and a warning need the room more than what the Problem panel says as well.
    if let (Some(count), true) = (model.preset.get("basis.rings"), warnings.is_empty() && app.late.is_none())
    {
        spans.push(Span::raw(format!("  rings {count}")));
    }
    if model.is_computing() {
        let far = model.stage.map_or_else(String::new, |stage| format!(" {}", stage.text()));
        spans.push(Span::styled(format!("  computing{far}"), theme.key().add_modifier(Modifier::BOLD)));
    }
    if model.curve.is_some() && !model.is_computing() && !model.shows_its_curve() {
        spans.push(Span::styled("  curve and state of other values", theme.error()));
    }
    if let Some(beside) = app.late {
        let text = theme.text(&app.keymap.spelled(&beside.text()));
        spans.push(Span::styled(format!("  {text}"), theme.key().add_modifier(Modifier::BOLD)));
    }
    let used: usize = spans.iter().map(Span::width).sum();
    let room = usize::from(area.width).saturating_sub(used + 2);
    if let Some(text) = warned(&app.keymap, &warnings, room) {
        spans.push(Span::styled(format!("  {text}"), theme.error()));
    } else {
        let text = theme.whole_words(&theme.text(&said(model)), room);
        spans.push(Span::styled(format!("  {text}"), theme.dim()));
    }
    frame.render_widget(Line::from(spans), area);
}

/// What there is to read of the preset, the first that there is: what was changed since it was read, what it says, its title.
fn said(model: &Model) -> String {
    let changes = changes(&model.saved, &model.preset);
    if !changes.is_empty() {
        return greek(&changes.join(", "));
    }
    let comment = model.comment.lines().next().filter(|line| !line.is_empty());
    comment.unwrap_or(&model.preset.title).to_owned()
}

/// The first warning, as much of it as `room` holds, and the key that tells the rest.
fn warned(keymap: &Keymap, warnings: &[String], room: usize) -> Option<String> {
    let (first, others) = warnings.split_first()?;
    let more = if others.is_empty() { String::new() } else { format!("+{}", others.len()) };
    Some(fitted(keymap, &format!("! {first}"), &more, room))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_that_is_cut_says_where_the_rest_is() {
        let warnings = |all: &[&str]| all.iter().map(ToString::to_string).collect::<Vec<_>>();
        assert_eq!(warned(&Keymap::default(), &[], 40), None);
        assert_eq!(
            warned(&Keymap::default(), &warnings(&["too coarse"]), 12).as_deref(),
            Some("! too coarse")
        );
        for (all, room, text) in [
            (&["much too coarse"][..], 16, "! much... ?: all"),
            (&["coarse", "sharp"], 40, "! coarse... +1 ?: all"),
            (&["coarse", "sharp"], 3, "... +1 ?: all"),
        ] {
            assert_eq!(warned(&Keymap::default(), &warnings(all), room).as_deref(), Some(text));
        }
    }
}
