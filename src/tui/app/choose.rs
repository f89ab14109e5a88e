//! A list to choose from: the arrows move through it, typed text keeps the lines that contain it.

use super::state::App;
use crate::explorer::script::offers::{DEVICES, Typing};
use crate::explorer::script::parse;
use crate::explorer::table::{CommandRow, row_of};
use crate::explorer::{Command, Effect, Id, ScreenPanel, nudge, reach};
use crate::tui::overlay::{Choice, Choose, Dialog, Item};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use pulloff_engine::preset::schema::Kind;
use pulloff_engine::preset::{Row, Value};
use pulloff_engine::problem::Control;

/// Lines per page.
const PAGE: usize = 10;
/// The longest text a list is filtered by.
const FILTER: usize = 40;

/// The line, out of `count`, to which a key leads from `line`; `None` for another key.
fn turned(key: KeyEvent, line: usize, count: usize) -> Option<usize> {
    let last = count.saturating_sub(1);
    Some(match key.code {
        KeyCode::Home => 0,
        KeyCode::End => last,
        KeyCode::PageUp => line.saturating_sub(PAGE),
        KeyCode::PageDown => (line + PAGE).min(last),
        _ => return None,
    })
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
        let line = turned(key, line, count)?;
        Some(self.run(Command::Pick { panel, line: Some(line) }))
    }

    pub(super) fn choose_key(&mut self, mut choose: Choose, key: KeyEvent) -> Vec<Effect> {
        let count = choose.shown().len();
        // Letters are text, but before the first one, keys that move through a list or leave it do what they always do.
        let is_command = choose.filter.is_empty()
            && matches!(self.keymap.in_list(key), Some(Id::Up | Id::Down | Id::Cancel | Id::Quit | Id::Edit));
        let is_text = key.modifiers.difference(KeyModifiers::SHIFT).is_empty() && !is_command;
        match key.code {
            KeyCode::Char('D') | KeyCode::Delete => {
                if let Some(confirm) = choose.current().and_then(|(_, item)| item.delete.clone()) {
                    self.overlay = Some(Dialog::Confirm(*confirm));
                    return Vec::new();
                }
            }
            KeyCode::Char(c) if is_text => {
                if choose.filter.chars().count() < FILTER {
                    choose.filter.push(c);
                    choose.selected = 0;
                }
            }
            KeyCode::Backspace => {
                choose.filter.pop();
                choose.selected = 0;
            }
            _ => match (self.keymap.in_list(key), turned(key, choose.selected, count)) {
                (_, Some(line)) => choose.selected = line,
                (Some(Id::Up), _) => choose.selected = choose.selected.saturating_sub(1),
                (Some(Id::Down), _) => choose.selected = (choose.selected + 1).min(count.saturating_sub(1)),
                (Some(Id::Cancel | Id::Quit), _) => return Vec::new(),
                (Some(Id::Edit), _) if count > 0 => return self.take(&choose),
                _ => {}
            },
        }
        choose.picture = choose.current().and_then(|(_, item)| self.picture(&item.action));
        self.overlay = Some(Dialog::Choose(choose));
        Vec::new()
    }

    /// Asks for one of the words that a value can be.
    pub(super) fn ask_choice(&mut self, row: &Row, words: &[&str], value: Option<&Value>) -> Vec<Effect> {
        let set = |word: &str| Choice::Command(Command::Set { key: row.key.clone(), text: word.to_owned() });
        let items = words.iter().map(|word| Item::new(*word, set(word))).collect();
        let here = words.iter().position(|word| value.is_some_and(|value| value.to_string() == *word));
        self.choose(&format!("{}: {}", row.label, row.meaning), items, here.unwrap_or(0));
        Vec::new()
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
        let set = |word: &str| Choice::Command(Command::Set { key: row.key.clone(), text: word.to_owned() });
        let [grips, load, device] = DEVICES;
        let items = vec![
            Item::new(format!("displacement  {grips}"), set("displacement")),
            Item::new(format!("force         {load}"), set("force")),
            Item::new(
                format!("stiffness ... {device}"),
                Choice::Prompt(Box::new(self.value_prompt(&row, Some(spring)))),
            ),
        ];
        self.choose(&format!("{}: {}", row.label, row.meaning), items, here);
        Vec::new()
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
        self.choose(&title, items.collect(), here);
        Vec::new()
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
            Choice::Prompt(prompt) => {
                self.overlay = Some(Dialog::Prompt(*prompt));
                Vec::new()
            }
            Choice::Columns(choosing) => self.columns_chosen(&choosing),
            Choice::Copy(content) => {
                self.copy(content);
                Vec::new()
            }
        }
    }
}
