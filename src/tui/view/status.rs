//! What the state is and which key comes next; and the keys.

use super::legend::reading;
use super::parts::fitted;
use crate::explorer::model::Level;
use crate::explorer::table::{is_available, row_of};
use crate::explorer::{Home, Id, Node, ScreenPanel, View};
use crate::tui::app::App;
use crate::tui::overlay::{Dialog, Prompt, Purpose};
use crossterm::event::KeyCode;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

/// The commands that the footer offers, as many as fit: those available everywhere come first, then those of the
/// selected panel, then the rest.
pub fn offered(app: &App) -> Vec<(Id, &'static str)> {
    let word = |id: Id| (id, row_of(id).short);
    let model = &app.model;
    let is_apart = !model.is_computing() && model.history.current().is_some_and(Node::is_apart);
    let walk: &[Id] = if is_apart {
        &[Id::Undo, Id::Restart]
    } else {
        &[Id::Step, Id::NextEvent, Id::Jump, Id::Reverse, Id::Undo]
    };
    let own: &[(Id, &str)] = match (model.panel, model.view) {
        (ScreenPanel::Problem, _) if model.fitted().is_some() => &[
            (Id::Less, "less"),
            (Id::More, "more"),
            (Id::About, "report"),
            (Id::Free, "free"),
            (Id::Fit, "fit"),
        ],
        (ScreenPanel::Problem, _) if model.preset.data.source.is_some() => &[
            (Id::Less, "less"),
            (Id::More, "more"),
            (Id::Edit, "type"),
            (Id::Free, "free"),
            (Id::Fit, "fit"),
        ],
        (ScreenPanel::Problem, _) => &[(Id::Less, "less"), (Id::More, "more"), (Id::Edit, "type")],
        (ScreenPanel::Log, _) => &[(Id::Edit, "go there")],
        (ScreenPanel::Charts, view) if view.is_table() => &[(Id::Edit, "go there")],
        (ScreenPanel::Charts, view) if model.cross.is_some() && view.leads_somewhere() => {
            &[(Id::Edit, "go there"), (Id::CrossHair, "off")]
        }
        (ScreenPanel::Charts, _) if model.cross.is_some() => &[(Id::CrossHair, "off")],
        (ScreenPanel::Charts, View::Study) => &[(Id::Edit, "quantity"), (Id::CrossHair, "cross-hair")],
        (ScreenPanel::Charts, View::Map) => &[(Id::Edit, "axes"), (Id::CrossHair, "cross-hair")],
        (ScreenPanel::Charts, _) => {
            &[(Id::CrossHair, "cross-hair"), (Id::ZoomIn, "closer"), (Id::ZoomOut, "wider")]
        }
        (ScreenPanel::Here | ScreenPanel::Result, _) => &[],
    };
    let rest = [
        Id::Quit,
        Id::Go,
        Id::NextView,
        Id::NextPanel,
        Id::CommandLine,
        Id::Save,
        Id::Open,
        Id::Pin,
        Id::Export,
        Id::Control,
        Id::Axes,
        Id::Rings,
        Id::Enlarge,
        Id::Restart,
        Id::Run,
        Id::About,
    ];
    // In charts of values the walker is not seen: reading them comes before turning it round.
    let reads = matches!(model.view, View::Study | View::Map) && model.panel != ScreenPanel::Charts;
    let walk = walk.iter().map(|id| word(if reads && *id == Id::Reverse { Id::CrossHair } else { *id }));
    // Whoever does not know a key looks for this one, so it stands where a narrow screen has room for it.
    let (first, more) = own.split_at(own.len().min(2));
    let own = first.iter().copied().chain([word(Id::Help)]).chain(more.iter().copied());
    let rest = rest.into_iter().filter(|id| !(is_apart && *id == Id::Restart));
    walk.chain(own).chain(rest.map(word)).collect()
}

/// The narrowest footer with two blanks between its words, and with the words of [`offered`].
const WIDE: u16 = 60;

/// What a narrow footer offers first: the walk, the way to all places and panels, the help.
const NARROW: [(Id, &str); 5] = [
    (Id::Step, "step"),
    (Id::NextEvent, "event"),
    (Id::Go, "go"),
    (Id::NextPanel, "next"),
    (Id::Help, "keys"),
];

/// The blanks between the words of a footer.
fn between(width: u16) -> usize {
    if width < WIDE { 1 } else { 2 }
}

/// Draws the status line and the footer.
pub fn draw(frame: &mut Frame<'_>, status: Rect, footer: Rect, app: &App) {
    let theme = app.theme;
    // The cross-hair is reported while there is nothing else to say.
    let reading = if app.model.message.is_none() { reading(&app.model) } else { None };
    let is_reading = reading.is_some();
    let (level, text) = reading.map_or_else(|| app.model.status(), |text| (Level::Info, text));
    let text = app.keymap.spelled(&text);
    let style = if level.is_bad() { theme.error() } else { ratatui::style::Style::new() };
    let room = usize::from(status.width).saturating_sub(1);
    // The help has the full status, and can be opened while nothing else is open.
    let text = match theme.text(&text) {
        text if app.overlay.is_some() || is_reading => theme.whole_words(&text, room),
        text => fitted(&app.keymap, &text, "", room),
    };
    let line = Line::styled(format!(" {text}"), style);
    frame.render_widget(line, status);

    let mut spans = vec![Span::raw(" ")];
    for word in words(app, footer.width) {
        spans.push(Span::styled(word.key, theme.key()));
        spans.push(Span::raw(format!(" {}{}", word.text, " ".repeat(between(footer.width)))));
    }
    frame.render_widget(Line::from(spans), footer);
}

/// What a word of the footer does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Does {
    Command(Id),
    Place(Home),
    /// What a key does in the overlay on the screen.
    Key(KeyCode),
}

/// A key of the footer and its effect in a word.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FooterWord {
    pub key: String,
    pub text: &'static str,
    pub does: Does,
}

impl FooterWord {
    /// Its columns, with a blank between.
    fn width(&self) -> usize {
        self.key.chars().count() + self.text.chars().count() + 1
    }
}

/// The words of the footer that fit into `width`.
fn words(app: &App, width: u16) -> Vec<FooterWord> {
    let key = |id: Id| app.keymap.first(id);
    let command = |(id, text): (Id, &'static str)| FooterWord { key: key(id), text, does: Does::Command(id) };
    let in_list = |(id, text, code): (Id, &'static str, KeyCode)| FooterWord {
        key: key(id),
        text,
        does: Does::Key(code),
    };
    let (accept, back) = ((Id::Edit, "accept", KeyCode::Enter), (Id::Cancel, "back", KeyCode::Esc));
    let all: Vec<FooterWord> = match &app.overlay {
        None if app.going => {
            let place = |home: Home| FooterWord {
                key: home.name().chars().take(1).collect(),
                text: home.name(),
                does: Does::Place(home),
            };
            Home::ALL.into_iter().map(place).chain([in_list(back)]).collect()
        }
        None => {
            let first: &[(Id, &str)] = if width < WIDE { &NARROW } else { &[] };
            let others =
                offered(app).into_iter().filter(|(id, _)| first.iter().all(|(other, _)| other != id));
            let all = first.iter().copied().chain(others);
            all.filter(|(id, _)| is_available(&app.model, *id)).map(command).collect()
        }
        Some(Dialog::Prompt(Prompt { purpose: Purpose::Line { .. }, .. })) => {
            let take = FooterWord { key: "Tab".to_owned(), text: "take", does: Does::Key(KeyCode::Tab) };
            [(Id::Edit, "run", KeyCode::Enter), (Id::Down, "down", KeyCode::Down), back]
                .map(in_list)
                .into_iter()
                .chain([take])
                .collect()
        }
        Some(Dialog::Offer(_)) => {
            [(Id::Edit, "resume", KeyCode::Enter), (Id::Cancel, "start afresh", KeyCode::Esc)]
                .map(in_list)
                .to_vec()
        }
        Some(Dialog::Prompt(_)) => [accept, back].map(in_list).to_vec(),
        Some(Dialog::Choose(_) | Dialog::Help(_)) => {
            let through = [(Id::Up, "up", KeyCode::Up), (Id::Down, "down", KeyCode::Down)];
            through.into_iter().chain([accept, back]).map(in_list).collect()
        }
        Some(Dialog::Confirm(confirm)) => {
            let yes = FooterWord { key: "y".to_owned(), text: "yes", does: Does::Key(KeyCode::Char('y')) };
            let save = (confirm.yes.id() == Id::Quit).then(|| command((Id::SaveAs, "save")));
            std::iter::once(yes).chain(save).chain([in_list(back)]).collect()
        }
    };
    let between = between(width);
    let mut used = 1;
    let fits = |word: &FooterWord| {
        used += word.width() + between;
        used <= usize::from(width) + between
    };
    all.into_iter().take_while(fits).collect()
}

/// What the word at this column of the footer does.
pub fn word_at(app: &App, width: u16, column: u16) -> Option<Does> {
    let mut left = 1;
    words(app, width).into_iter().find_map(|word| {
        let is_it = (left..left + word.width()).contains(&usize::from(column));
        left += word.width() + between(width);
        is_it.then_some(word.does)
    })
}
