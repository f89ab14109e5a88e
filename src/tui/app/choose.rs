//! A list to choose from: the arrows move through it, typed text keeps the lines that contain it.

use super::keys::title;
use super::state::App;
use crate::explorer::script::offers::{DEVICES, Typing};
use crate::explorer::script::parse;
use crate::explorer::table::{CommandRow, row_of};
use crate::explorer::{Command, Effect, Id, ScreenPanel, nudge, reach};
use crate::tui::overlay::{Choice, Choose, Dialog, Item, Prompt, Purpose};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use pulloff_engine::preset::schema::Kind;
use pulloff_engine::preset::{Row, Value};
use pulloff_engine::problem::Control;

/// Lines per page.
const PAGE: usize = 10;
/// The longest text a list is filtered by.
const FILTER: usize = 40;

/// The line, out of `count`, to which a key or its command leads from `line`; `None` for another key.
fn turned(key: KeyEvent, id: Option<Id>, line: usize, count: usize) -> Option<usize> {
    let last = count.saturating_sub(1);
    Some(match (key.code, id) {
        (KeyCode::Home, _) => 0,
        (KeyCode::End, _) => last,
        (KeyCode::PageUp, _) => line.saturating_sub(PAGE),
        (KeyCode::PageDown, _) => (line + PAGE).min(last),
        (_, Some(Id::Up)) => line.saturating_sub(1),
        (_, Some(Id::Down)) => (line + 1).min(last),
        _ => return None,
    })
}

/// The prompt that a text typed into a list leads to: `stiffness=` to that of the line that begins so, a path to that of
/// files.
fn goes_on(choose: &Choose, typed: char) -> Option<Prompt> {
    let (line, begun) = match typed {
        '=' => {
            let (_, line) = choose.current()?;
            (line, line.text.split_whitespace().next().unwrap_or_default())
        }
        // Titles have these characters, too.
        '/' | '.' if choose.filter.is_empty() || !choose.has(&format!("{}{typed}", choose.filter)) => {
            let is_of_files =
                |action: &Choice| matches!(action, Choice::Prompt(of) if of.purpose == Purpose::Path);
            (choose.items.iter().find(|item| is_of_files(&item.action))?, &*choose.filter)
        }
        _ => return None,
    };
    let Choice::Prompt(prompt) = &line.action else { return None };
    Some(Prompt { input: format!("{begun}{typed}").into(), fresh: false, ..(**prompt).clone() })
}

impl App {
    /// End and the page keys in the selected panel, if it has lines.
    pub(super) fn page_key(&mut self, key: KeyEvent) -> Option<Vec<Effect>> {
        let (panel, model) = (self.model.panel, &self.model);
        let (line, count) = match panel {
            ScreenPanel::Problem => (model.parameter, model.knobs().len()),
            ScreenPanel::Log => (model.event, model.log_lines()),
            ScreenPanel::Charts if model.view.is_table() => {
                (reach::walk_line(model), model.history.path().len())
            }
            ScreenPanel::Here | ScreenPanel::Result | ScreenPanel::Charts => return None,
        };
        let line = turned(key, None, line, count)?;
        Some(self.run(Command::Pick { panel, line: Some(line) }))
    }

    pub(super) fn choose_key(&mut self, mut choose: Choose, key: KeyEvent) -> Vec<Effect> {
        let count = choose.shown().len();
        // Letters are text, but before the first one, keys that move through a list or leave it do what they always do.
        let id = self.keymap.in_list(key);
        let is_command = choose.filter.is_empty()
            && matches!(id, Some(Id::Up | Id::Down | Id::Cancel | Id::Quit | Id::Edit));
        let is_text = key.modifiers.difference(KeyModifiers::SHIFT).is_empty() && !is_command;
        match key.code {
            KeyCode::Char('D') | KeyCode::Delete => {
                if let Some(confirm) = choose.current().and_then(|(_, item)| item.delete.clone()) {
                    return self.lay(Dialog::Confirm(*confirm));
                }
            }
            KeyCode::Char(c) if is_text => {
                if let Some(prompt) = goes_on(&choose, c) {
                    return self.lay(Dialog::Prompt(prompt));
                }
                if choose.filter.chars().count() < FILTER {
                    choose.filter.push(c);
                    choose.selected = 0;
                }
            }
            KeyCode::Backspace => {
                choose.filter.pop();
                choose.selected = 0;
            }
            _ => match (turned(key, id, choose.selected, count), id) {
                (Some(line), _) => choose.selected = line,
                (_, Some(Id::Cancel | Id::Quit)) => return Vec::new(),
                (_, Some(Id::Edit)) if count > 0 => return self.take(&choose),
                _ => {}
            },
        }
        self.lay_list(choose)
    }

    /// Puts a list over the screen, with the picture of its selected line.
    pub(super) fn lay_list(&mut self, mut choose: Choose) -> Vec<Effect> {
        choose.picture = choose.current().and_then(|(_, item)| self.picture(&item.action));
        self.lay(Dialog::Choose(choose))
    }

    pub(super) fn choose(&mut self, title: &str, items: Vec<Item>, selected: usize) -> Vec<Effect> {
        let (title, filter) = (title.to_owned(), String::new());
        self.lay_list(Choose { title, items, filter, selected, picture: None })
    }

    /// Asks for one of the words that a value can be; `meanings` says what some of them are.
    pub(super) fn ask_word(
        &mut self,
        (row, value): (&Row, Option<&Value>),
        words: &[&str],
        meanings: &[(&str, &str)],
        title: &str,
    ) -> Vec<Effect> {
        let item = |word: &&str| {
            let meaning = meanings.iter().find(|(name, _)| name == word).map_or("", |(_, meaning)| meaning);
            Item::of_word(word, meaning, Choice::set(&row.key, *word))
        };
        let here = words.iter().position(|word| value.is_some_and(|value| value.to_string() == *word));
        self.choose(title, words.iter().map(item).collect(), here.unwrap_or(0))
    }

    /// Asks what the device prescribes; the stiffness of a spring is typed.
    pub(super) fn ask_control(&mut self) -> Vec<Effect> {
        let model = &self.model;
        let Some(row) = model.preset.rows().find(|row| row.kind == Kind::Control) else { return Vec::new() };
        let here = match model.preset.path.control {
            Control::Displacement => 0,
            Control::Force => 1,
            Control::Stiffness(_) => 2,
        };
        let spring = Value::Control(Control::Stiffness(nudge::spring(&model.preset, model.stiffness)));
        let spring = Choice::Prompt(Box::new(self.value_prompt(&row, Some(spring))));
        let [grips, load, device] = DEVICES;
        let items = vec![
            Item::of_word("displacement", grips, Choice::set(&row.key, "displacement")),
            Item::of_word("force", load, Choice::set(&row.key, "force")),
            Item::of_word("stiffness ...", device, spring),
        ];
        self.choose(&title(&row), items, here)
    }

    /// Lists what a command can take, one line each.
    pub(super) fn ask_argument(&mut self, row: &'static CommandRow) -> Vec<Effect> {
        let files = |folder: &str| self.files(folder);
        let typing = Typing { model: &self.model, words: &[], word: "", files: &files };
        let offers = (row.takes.offers)(&typing);
        let width = offers.iter().map(|offer| offer.word.len()).max().unwrap_or(0);
        let items = offers.iter().filter_map(|offer| {
            let said = self.theme.symbols(&self.keymap.spelled(&offer.says));
            let does =
                offer.does.clone().or_else(|| parse(&format!("{} {}", row.name, offer.word)).ok()?)?;
            Some(Item::new(format!("{:<width$} {said}", offer.word), Choice::Command(does)))
        });
        let here = offers.iter().position(|offer| offer.is_here).unwrap_or(0);
        let title = row.help.split([':', ';']).next().unwrap_or_default();
        let title = format!("{}{}", title[..1].to_uppercase(), &title[1..]);
        self.choose(&title, items.collect(), here)
    }

    fn take(&mut self, choose: &Choose) -> Vec<Effect> {
        let Some((at, item)) = choose.current() else { return Vec::new() };
        match item.action.clone() {
            // The person may want several: the list stays until it is closed.
            Choice::Command(command @ Command::Overlay(_)) => {
                let effects = self.run(command);
                self.ask_argument(row_of(Id::Overlays));
                if let Some(Dialog::Choose(choose)) = &mut self.overlay {
                    choose.selected = at;
                }
                effects
            }
            Choice::Command(command) => {
                let is_formula =
                    matches!(&command, Command::Set { key, text } if key == "gap.shape" && text == "formula");
                let effects = self.open_or_ask(command);
                if is_formula {
                    self.ask_formula_of_shape();
                }
                effects
            }
            Choice::Prompt(prompt) => self.lay(Dialog::Prompt(*prompt)),
            Choice::Columns(choosing) => self.columns_chosen(&choosing),
            Choice::Copy(content) => self.copy(content),
        }
    }
}
