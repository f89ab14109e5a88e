//! Parts that several regions use: frames of panels, shortened texts, pairs of key and value.

use crate::explorer::{Id, ScreenPanel};
use crate::tui::app::App;
use crate::tui::keymap::Keymap;
use crate::tui::theme::Theme;
use pulloff_engine::problem::Control;
use ratatui::text::Span;
use ratatui::widgets::Block;

pub(super) fn panel<'a>(theme: Theme, title: &str, selected: bool) -> Block<'a> {
    theme.block(selected).title(Span::styled(theme.text(title), theme.title(selected)))
}

/// Whether a panel is the selected one and nothing lies over it.
pub(super) fn is_selected(app: &App, panel: ScreenPanel) -> bool {
    app.model.panel == panel && app.overlay.is_none()
}

/// As many words of `text` as fit; if it is cut, or there is more to tell, followed by the key of the help, which shows
/// everything.
pub(super) fn fitted(keymap: &Keymap, text: &str, more: &str, room: usize) -> String {
    if more.is_empty() && text.chars().count() <= room {
        return text.to_owned();
    }
    let rest = if more.is_empty() { "...".to_owned() } else { format!("... {more}") };
    let rest = format!("{rest} {}: all", keymap.label(Id::Help));
    let room = room.saturating_sub(rest.chars().count());
    let kept: String = text.chars().take(room).collect();
    let is_whole = text.chars().nth(room).is_none_or(char::is_whitespace);
    let end = if is_whole { kept.len() } else { kept.rfind(' ').unwrap_or(kept.len()) };
    format!("{}{rest}", kept[..end].trim_end())
}

/// What is held, as a symbol.
pub(super) fn symbol(control: Control) -> &'static str {
    match control {
        Control::Displacement => "δ",
        Control::Force => "P",
        Control::Stiffness(_) => "k",
    }
}

/// `key value` with the key dim.
pub(super) fn pair(theme: Theme, key: &str, value: &str) -> [Span<'static>; 2] {
    [Span::styled(theme.text(key), theme.dim()), Span::raw(theme.text(value))]
}
