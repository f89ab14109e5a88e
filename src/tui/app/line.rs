//! The list of everything that can be done, and the line typed over it: the grammar of scripts.

use super::state::App;
use crate::explorer::data::list;
use crate::explorer::script::{palette, parse};
use crate::explorer::table::{called, row_of};
use crate::explorer::{Command, Effect, Id};
use crate::tui::overlay::{Dialog, Help, LONGEST_LINE, Prompt, Purpose};
use crate::tui::view::help::now;
use crate::tui::view::status;
use crossterm::event::{Event, KeyCode, KeyEvent};
use tui_input::Input;
use tui_input::backend::crossterm::EventHandler;

/// The note below an empty line.
const NOTE: &str = "type to search; Tab takes a line, Enter runs it, Up brings earlier lines back";
/// Lines per page.
const PAGE: usize = 8;

impl App {
    /// Opens the list, to type a line or to see what can be done.
    pub(super) fn ask_line(&mut self, is_help: bool) -> Vec<Effect> {
        let effects = self.run(Id::CommandLine.into());
        self.typed.at = self.typed.lines.len();
        let title = if is_help { "What can be done (Tab: how to read the screen)" } else { "Command" };
        let mut prompt = Prompt::new(title, NOTE, String::new(), Purpose::Line { is_help });
        self.changed(&mut prompt, Input::default());
        self.overlay = Some(Dialog::Prompt(prompt));
        effects
    }

    pub(super) fn line_key(&mut self, mut prompt: Prompt, key: KeyEvent) -> Vec<Effect> {
        let is_empty = prompt.input.value().is_empty();
        match key.code {
            KeyCode::Esc => return Vec::new(),
            _ if prompt.waits => {}
            KeyCode::Enter => return self.obey_line(prompt),
            KeyCode::Tab if is_empty && prompt.purpose == (Purpose::Line { is_help: true }) => {
                return self.lay(Dialog::Help(Help::default()));
            }
            KeyCode::Tab => self.take_entry(&mut prompt),
            // The lines typed earlier lie above the list.
            KeyCode::Up if prompt.selected.is_none() || self.is_recalled() => self.recall(&mut prompt, true),
            KeyCode::Down if self.is_recalled() => self.recall(&mut prompt, false),
            KeyCode::Up => prompt.selected = prompt.selected.and_then(|at| at.checked_sub(1)),
            KeyCode::Down => select(&mut prompt, |at| at.map_or(0, |at| at + 1)),
            KeyCode::PageUp => select(&mut prompt, |at| at.unwrap_or(0).saturating_sub(PAGE)),
            KeyCode::PageDown => select(&mut prompt, |at| at.unwrap_or(0) + PAGE),
            _ if self.closes(key) => return Vec::new(),
            _ if prompt.input.value().chars().count() >= LONGEST_LINE
                && matches!(key.code, KeyCode::Char(_)) => {}
            _ => {
                let mut input = prompt.input.clone();
                if input.handle_event(&Event::Key(key)).is_some_and(|change| change.value) {
                    self.typed.at = self.typed.lines.len();
                    self.changed(&mut prompt, input);
                } else {
                    // The list depends on the text before the cursor.
                    prompt.input = input;
                    self.list(&mut prompt);
                }
            }
        }
        self.lay(Dialog::Prompt(prompt))
    }

    fn is_recalled(&self) -> bool {
        self.typed.at < self.typed.lines.len()
    }

    fn recall(&mut self, prompt: &mut Prompt, older: bool) {
        if let Some(line) = self.typed.recall(older, prompt.input.value()) {
            self.changed(prompt, Input::new(line));
        }
    }

    /// Lists what the text before the cursor could become.
    fn list(&self, prompt: &mut Prompt) {
        let head: String = prompt.input.value().chars().take(prompt.input.cursor()).collect();
        let files = |folder: &str| self.files(folder);
        let first: Vec<Id> = status::offered(self).into_iter().map(|(id, _)| id).collect();
        let asked = head.trim();
        let keyed = self.keymap.called(asked.strip_prefix("key ").unwrap_or(asked));
        prompt.entries = palette(&head, &first, keyed, &self.model, &files);
        // A line that is a complete command is run as it stands.
        let is_command = parse(prompt.input.value()).is_ok();
        prompt.selected = (!is_command && !prompt.entries.is_empty()).then_some(0);
    }

    /// The text has changed: the error of the previous one is forgotten.
    fn changed(&self, prompt: &mut Prompt, input: Input) {
        let is_help = prompt.purpose == Purpose::Line { is_help: true } && input.value().is_empty();
        prompt.note = if is_help { now(self).join(" · ") } else { note(input.value()) };
        prompt.input = input;
        prompt.error = None;
        prompt.fault = None;
        self.list(prompt);
    }

    /// Renews the list of a line being typed when more is known, such as the names of presets.
    pub(super) fn list_again(&mut self) {
        let Some(Dialog::Prompt(mut prompt)) = self.overlay.take_if(|over| {
            matches!(
                over,
                Dialog::Prompt(Prompt { purpose: Purpose::Line { .. }, error: None, waits: false, .. })
            )
        }) else {
            return;
        };
        // The selected entry stays selected, wherever it now is.
        let selected = prompt.selected.and_then(|at| prompt.entries.get(at)).map(|entry| entry.line.clone());
        self.list(&mut prompt);
        prompt.selected =
            selected.and_then(|line| prompt.entries.iter().position(|entry| entry.line == line));
        self.overlay = Some(Dialog::Prompt(prompt));
    }

    /// Puts the selected entry, or the first, in place of the text before the cursor.
    fn take_entry(&mut self, prompt: &mut Prompt) {
        let Some(entry) = prompt.entries.get(prompt.selected.unwrap_or(0)) else {
            "nothing matches".clone_into(&mut prompt.note);
            return;
        };
        let takes_more = entry.id.is_some_and(|id| !row_of(id).takes.what.is_empty());
        let is_open = entry.line.ends_with(['=', '/']) || (entry.id.is_some() && !takes_more);
        let line = if is_open { entry.line.clone() } else { format!("{} ", entry.line) };
        let tail: String = prompt.input.value().chars().skip(prompt.input.cursor()).collect();
        let cursor = line.chars().count();
        let tail = if line.ends_with(' ') { tail.trim_start() } else { &tail };
        self.changed(prompt, Input::new(line + tail).with_cursor(cursor));
    }

    /// The folders and files in `folder` that a measured curve may be in, as a line names them.
    pub(super) fn files(&self, folder: &str) -> Vec<String> {
        let own = self.model.preset.data.source.as_ref().and_then(|source| source.folder.clone());
        let own = own.unwrap_or_else(|| ".".into());
        let asked = own.join(folder);
        let Ok(found) = list(Some(&asked), None) else { return Vec::new() };
        let folders = found.folders.iter().map(|name| format!("{folder}{name}/"));
        let files = found.files.iter().map(|name| format!("{folder}{name}"));
        folders.chain(files).collect()
    }

    fn obey_line(&mut self, mut prompt: Prompt) -> Vec<Effect> {
        let mut line = prompt.input.value().to_owned();
        if let Some(entry) = prompt.selected.and_then(|at| prompt.entries.get(at)) {
            // The text after the cursor is not dropped.
            if !entry.is_whole || prompt.input.cursor() < line.chars().count() {
                self.take_entry(&mut prompt);
                return self.lay(Dialog::Prompt(prompt));
            }
            line.clone_from(&entry.line);
        }
        let effects = match parse(&line) {
            Ok(None) => return Vec::new(),
            Err(fault) => {
                prompt.error = Some(format!("column {}: {fault}", fault.column));
                prompt.fault = Some(fault.column);
                return self.lay(Dialog::Prompt(prompt));
            }
            Ok(Some(command)) => {
                self.typed.remember(line.trim());
                self.typed.at = self.typed.lines.len();
                match command {
                    Command::Plain(id) => self.act(id),
                    command => self.open_or_ask(command),
                }
            }
        };
        // A refused line stays so that it can be corrected.
        if self.overlay.is_none() { self.taken(prompt, effects) } else { effects }
    }
}

/// Selects another entry.
fn select(prompt: &mut Prompt, to: impl Fn(Option<usize>) -> usize) {
    prompt.selected = prompt.entries.len().checked_sub(1).map(|last| to(prompt.selected).min(last));
}

fn note(line: &str) -> String {
    let name = line.split_whitespace().next().unwrap_or_default();
    let Some(row) = called(name) else { return NOTE.to_owned() };
    match row.takes.what {
        "" => row.help.to_owned(),
        // What is typed literally must look different from what stands for something else.
        what if what.chars().any(char::is_uppercase) => format!("{name} {what}: {}", row.help),
        what => format!("{name} {}: {}", what.to_uppercase(), row.help),
    }
}
