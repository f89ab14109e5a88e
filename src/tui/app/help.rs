//! The help: its pages are chosen by Tab, scrolled, and searched with `/`, `n` and `N`.

use super::state::App;
use crate::explorer::Id;
use crate::tui::overlay::{Dialog, Help, Occurrence};
use crate::tui::view::help::{PAGES, plain};
use crossterm::event::{Event, KeyCode, KeyEvent};
use tui_input::Input;
use tui_input::backend::crossterm::EventHandler;

/// The longest text that can be searched for.
const PATTERN: usize = 60;
/// Lines per page.
const PAGE: usize = 10;

impl App {
    pub(super) fn help_key(&mut self, mut help: Help, key: KeyEvent) {
        if let Some(input) = help.typing.take() {
            self.type_pattern(&mut help, input, key);
            self.overlay = Some(Dialog::Help(help));
            return;
        }
        let has_pattern = !help.pattern.is_empty();
        match (self.keymap.in_list(key), key.code) {
            (_, KeyCode::Char('/')) => help.typing = Some(Input::default()),
            (_, KeyCode::Char('n')) if has_pattern => self.look(&mut help, true),
            (_, KeyCode::Char('N')) if has_pattern => self.look(&mut help, false),
            (_, KeyCode::Tab) => (help.page, help.line) = ((help.page + 1) % PAGES.len(), 0),
            (_, KeyCode::BackTab) => {
                (help.page, help.line) = ((help.page + PAGES.len() - 1) % PAGES.len(), 0);
            }
            (Some(Id::Up), _) => help.line = help.line.saturating_sub(1),
            (Some(Id::Down), _) => help.line += 1,
            (_, KeyCode::PageUp) => help.line = help.line.saturating_sub(PAGE),
            (Some(Id::Step), _) | (_, KeyCode::PageDown) => help.line += PAGE,
            (Some(Id::Cancel | Id::Quit | Id::Help | Id::Edit), _) => return,
            _ => {}
        }
        help.line = help.line.min(plain(self, help.page).len());
        self.overlay = Some(Dialog::Help(help));
    }

    fn type_pattern(&self, help: &mut Help, mut input: Input, key: KeyEvent) {
        match key.code {
            KeyCode::Esc => {}
            _ if self.closes(key) => {}
            KeyCode::Enter => {
                if !input.value().is_empty() {
                    input.value().clone_into(&mut help.pattern);
                }
                help.found = None;
                self.look(help, true);
            }
            code => {
                let is_full = input.value().chars().count() >= PATTERN && matches!(code, KeyCode::Char(_));
                if !is_full {
                    input.handle_event(&Event::Key(key));
                }
                help.typing = Some(input);
            }
        }
    }

    /// The next or previous occurrence of the pattern on any page, in a cycle; the first one is not above what is
    /// shown.
    fn look(&self, help: &mut Help, down: bool) {
        let wanted = help.pattern.to_lowercase();
        let lines = (0..PAGES.len()).flat_map(|page| {
            plain(self, page).into_iter().enumerate().map(move |(line, text)| ((page, line), text))
        });
        let has = |text: &str| !wanted.is_empty() && text.to_lowercase().contains(&wanted);
        let places: Vec<(usize, usize)> = lines.filter(|(_, text)| has(text)).map(|(at, _)| at).collect();
        let shown = (help.page, help.line);
        let here = help.found.map(|found| (found.page, found.line));
        let next = if down {
            places.iter().position(|place| here.map_or(*place >= shown, |here| *place > here)).or(Some(0))
        } else {
            let before = places.iter().rposition(|place| *place < here.unwrap_or(shown));
            before.or_else(|| places.len().checked_sub(1))
        };
        help.found = next.and_then(|at| {
            let (page, line) = *places.get(at)?;
            Some(Occurrence { page, line, number: at + 1, of: places.len() })
        });
        if let Some(found) = help.found {
            (help.page, help.line) = (found.page, found.line);
        }
    }
}
