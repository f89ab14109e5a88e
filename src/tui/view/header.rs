//! The first line: which preset, what is controlled, what to be careful about.

use super::parts::fitted;
use crate::explorer::pins::{changed_labels, changes};
use crate::explorer::{Axes, Home, Id, Model};
use crate::tui::app::App;
use crate::tui::keymap::Keymap;
use pulloff_engine::problem::Control;
use pulloff_engine::report::number::{short, significant, with_unit};
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

/// What there is, what is held, and what is under way, in `room` columns.
fn heading(app: &App, warnings: &[String], room: u16) -> Vec<Span<'static>> {
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
            let k = with_unit(&model.preset.units, Quantity::ForcePerLength, k, theme.ascii, |k| short(k, 6));
            format!("STIFFNESS={k}")
        }
        other => other.to_string().to_uppercase(),
    };
    spans.push(Span::raw("  control "));
    spans.push(Span::styled(control, theme.strong()));
    let after_control = spans.len();
    // A job under way, a warning and the places need the room more than what the Problem panel says anyway.
    let is_free = warnings.is_empty() && app.late.is_none();
    if let (Some(count), true) = (model.preset.get("basis.rings"), is_free) {
        let rings = Span::raw(format!("  rings {count}"));
        if width(&spans) + rings.width() + width(&places(app)) < usize::from(room) {
            spans.push(rings);
        }
    }
    if model.is_computing() {
        let far = model.stage.map_or_else(String::new, |stage| format!(" {}", stage.text()));
        spans.push(Span::styled(format!("  computing{far}"), theme.key().add_modifier(Modifier::BOLD)));
    }
    if model.curve.is_some() && !model.is_computing() && !model.shows_its_curve() {
        spans.push(Span::styled("  curve and state of other values", theme.error()));
    }
    if let Some(says) = &app.late {
        let left = usize::from(room).saturating_sub(width(&spans) + 2);
        let text = theme.whole_words(&theme.text(&app.keymap.spelled(says)), left);
        spans.push(Span::styled(format!("  {text}"), theme.key().add_modifier(Modifier::BOLD)));
    }
    if let Some(share) = stiffness_share(model) {
        let share = Span::styled(theme.text(&format!(" ({} of 2E*s)", significant(share, 3))), theme.dim());
        let (room, own, beside) = (usize::from(room), width(&spans), beside(app, warnings));
        let with_share = own + share.width();
        // The way to the places needs the room more.
        let takes_places = room > own + beside && room <= with_share + beside;
        if with_share <= room && !takes_places {
            spans.insert(after_control, share);
        }
    }
    spans
}

/// The columns of the places and of a warning, or of its beginning.
fn beside(app: &App, warnings: &[String]) -> usize {
    const BEGINNING: usize = 16;
    let whole = |first: &String| first.chars().count() + "  !  +9 ?: all".len();
    let warning = warnings.first().map_or(0, |first| whole(first).min(BEGINNING));
    width(&places(app)) + warning
}

fn width(spans: &[Span<'_>]) -> usize {
    spans.iter().map(Span::width).sum()
}

fn warnings(app: &App) -> Vec<String> {
    app.model.warnings().iter().map(|text| app.theme.text(text)).collect()
}

/// Whether there is room for the places: a job under way needs it more.
fn has_places(app: &App, room: u16) -> bool {
    let warnings = warnings(app);
    usize::from(room) > width(&heading(app, &warnings, room)) + beside(app, &warnings)
}

/// Draws the first line.
pub fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let theme = app.theme;
    let warnings = warnings(app);
    let mut spans = heading(app, &warnings, area.width);
    let (places, has_places) = (places(app), has_places(app, area.width));
    let taken = width(&spans) + if has_places { width(&places) } else { 0 };
    let room = usize::from(area.width).saturating_sub(taken + 2);
    if let Some(text) = warned(&app.keymap, &warnings, room) {
        spans.push(Span::styled(format!("  {text}"), theme.error()));
    } else {
        let text = theme.whole_words(&theme.text(&said(&app.model, room)), room);
        spans.push(Span::styled(format!("  {text}"), theme.dim()));
    }
    frame.render_widget(Line::from(spans), area);
    if has_places {
        let at = area.right().saturating_sub(u16::try_from(width(&places)).unwrap_or(u16::MAX));
        frame.render_widget(Line::from(places), Rect { x: at, width: area.right() - at, ..area });
    }
}

/// The place whose name is at this column of the header.
pub fn place_at(app: &App, area: Rect, column: u16) -> Option<Home> {
    let mut right = Some(usize::from(area.width)).filter(|_| has_places(app, area.width))?;
    Home::ALL.into_iter().rev().find(|home| {
        let from = right.saturating_sub(home.name().len());
        let is_it = (from..right).contains(&usize::from(column));
        right = from.saturating_sub(2);
        is_it
    })
}

/// The key that goes to another place, and the four of them, the current one in capitals.
fn places(app: &App) -> Vec<Span<'static>> {
    let theme = app.theme;
    let here = app.model.view.home();
    let name = |home: Home| {
        if home == here {
            Span::styled(format!("  {}", home.name().to_uppercase()), theme.strong())
        } else {
            Span::styled(format!("  {}", home.name()), theme.dim())
        }
    };
    let key = Span::styled(format!("  {}:", app.keymap.first(Id::Go)), theme.key());
    std::iter::once(key).chain(Home::ALL.into_iter().map(name)).collect()
}

/// With no more columns than this, nothing of a title can be read.
const FEW: usize = 8;

/// What to say of the preset in `room` columns, the first of these that there is: what was changed since it was read,
/// its comment, its title.
fn said(model: &Model, room: usize) -> String {
    let changes = changes(&model.saved, &model.preset);
    if !changes.is_empty() {
        let labels = changed_labels(&model.saved, &model.preset).join(", ");
        // If cut, an old value would look like the new one.
        let texts = [changes.join(", "), format!("changed: {labels}"), format!("{} changed", changes.len())];
        let texts = texts.map(|text| greek(&text));
        return texts.into_iter().find(|text| text.chars().count() <= room).unwrap_or_default();
    }
    let comment = model.comment.lines().next().filter(|line| !line.is_empty());
    let text = comment.unwrap_or(&model.preset.title);
    if room < FEW { String::new() } else { text.to_owned() }
}

/// The first warning, as much of it as fits into `room`, and the key that shows the rest; only their number where a word of it
/// would say nothing.
fn warned(keymap: &Keymap, warnings: &[String], room: usize) -> Option<String> {
    const A_FEW_WORDS: usize = 30;
    let (first, others) = warnings.split_first()?;
    let count = match warnings.len() {
        1 => "warning".to_owned(),
        count => format!("{count} warnings"),
    };
    let count = format!("! {count} {}: all", keymap.label(Id::Help));
    let more = if others.is_empty() { String::new() } else { format!("+{}", others.len()) };
    let text = format!("! {first}");
    let is_cut = text.chars().count() > room || !others.is_empty();
    let says = if is_cut && (count.chars().count()..A_FEW_WORDS).contains(&room) {
        count
    } else {
        fitted(keymap, &text, &more, room)
    };
    Some(says)
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
            (&["much too coarse"][..], 16, "! warning ?: all"),
            (&["much too coarse", "sharp"], 19, "! 2 warnings ?: all"),
            (&["coarse", "sharp"], 40, "! coarse... +1 ?: all"),
            (&["coarse", "sharp"], 3, "... +1 ?: all"),
        ] {
            assert_eq!(warned(&Keymap::default(), &warnings(all), room).as_deref(), Some(text));
        }
    }
}
