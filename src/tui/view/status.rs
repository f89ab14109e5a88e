//! What the state is and which key is next; and the keys.

use super::legend::reading;
use super::parts::fitted;
use crate::explorer::Id;
use crate::explorer::availability::is_available;
use crate::explorer::command::row_of;
use crate::explorer::model::Level;
use crate::tui::app::App;
use crate::tui::overlay::Overlay;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

/// The commands of the footer, the most wanted first; as many as fit are shown.
const FOOTER: &[Id] = &[
    Id::Step,
    Id::NextEvent,
    Id::Jump,
    Id::Reverse,
    Id::Undo,
    Id::Help,
    Id::Quit,
    Id::NextPanel,
    Id::NextView,
    Id::More,
    Id::Control,
    Id::Edit,
    Id::Save,
    Id::Open,
    Id::ZoomIn,
    Id::Axes,
    Id::Export,
    Id::Run,
    Id::Restart,
    Id::About,
    Id::CommandLine,
];

/// Draws the status line and the footer.
pub fn draw(frame: &mut Frame<'_>, status: Rect, footer: Rect, app: &App) {
    let theme = app.theme;
    // The cross-hair is read while nothing else is to be told.
    let reading = if app.model.message.is_none() { reading(&app.model) } else { None };
    let is_reading = reading.is_some();
    let (level, text) = reading.map_or_else(|| app.model.status(), |text| (Level::Info, text));
    let text = app.keymap.spelled(&text);
    let style = if level.is_bad() { theme.error() } else { ratatui::style::Style::new() };
    let count = app.count.map_or_else(|| " ".to_owned(), |count| format!(" {count} "));
    let room = usize::from(status.width).saturating_sub(count.len());
    // The help has the status whole, and can be opened while nothing else is open.
    let text = match theme.text(&text) {
        text if app.overlay.is_some() || is_reading => text,
        text => fitted(&app.keymap, &text, "", room),
    };
    let line = Line::from(vec![Span::styled(count, theme.key()), Span::styled(text, style)]);
    frame.render_widget(line, status);

    let mut spans = vec![Span::raw(" ")];
    let mut used = 1;
    let ids: Vec<Id> = match &app.overlay {
        Some(Overlay::Prompt(_) | Overlay::Offer(_)) => vec![Id::Edit, Id::Cancel],
        Some(Overlay::Choose(_) | Overlay::Help(_)) => vec![Id::Up, Id::Down, Id::Edit, Id::Cancel],
        Some(Overlay::Confirm(_)) => {
            spans.extend([Span::styled("y", theme.key()), Span::raw(" yes  ")]);
            vec![Id::Cancel]
        }
        None => FOOTER.to_vec(),
    };
    for id in ids {
        let row = row_of(id);
        if app.overlay.is_none() && !is_available(&app.model, row.id) {
            continue;
        }
        let key = app.keymap.first(id);
        let word = match (id, &app.overlay) {
            (Id::Edit, Some(_)) => "accept",
            _ => row.short,
        };
        let width = key.chars().count() + word.chars().count() + 3;
        if used + width > usize::from(footer.width) + 2 {
            break;
        }
        used += width;
        spans.push(Span::styled(key, theme.key()));
        spans.push(Span::raw(format!(" {word}  ")));
    }
    frame.render_widget(Line::from(spans), footer);
}
