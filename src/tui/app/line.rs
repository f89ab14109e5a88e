//! The command line: the grammar of scripts, typed on the screen.

use super::state::App;
use crate::explorer::data::list;
use crate::explorer::script::{Completion, complete, parse};
use crate::explorer::table::called;
use crate::explorer::{Command, Effect, Id};
use crate::tui::overlay::{LONGEST_LINE, Overlay, Prompt, Purpose};
use crate::tui::view::overlays as prompt;
use crossterm::event::{Event, KeyCode, KeyEvent};
use pulloff_engine::text::sanitize;
use tui_input::Input;
use tui_input::backend::crossterm::EventHandler;

/// What stands below an empty line.
const NOTE: &str = "a command and what it takes; Tab completes, Up and Down bring lines back";

/// What stands behind names that are listed: how far the list is.
const BEHIND: usize = " (10 of 10, Tab goes on)".len();
/// The longest list of names, and the shortest.
const LISTED: [usize; 2] = [300, 24];

impl App {
    pub(super) fn ask_line(&mut self) -> Vec<Effect> {
        let effects = self.run(Id::CommandLine.into());
        self.typed.at = self.typed.lines.len();
        self.overlay = Some(Overlay::Prompt(Prompt::new("Command", NOTE, String::new(), Purpose::Line)));
        effects
    }

    pub(super) fn line_key(&mut self, mut prompt: Prompt, key: KeyEvent) -> Vec<Effect> {
        match key.code {
            KeyCode::Esc => return Vec::new(),
            _ if prompt.waits => {}
            KeyCode::Enter => return self.obey_line(prompt),
            KeyCode::Tab => self.complete(&mut prompt),
            KeyCode::Up | KeyCode::Down => {
                if let Some(line) = self.typed.recall(key.code == KeyCode::Up, prompt.input.value()) {
                    changed(&mut prompt, Input::new(line));
                }
            }
            _ if self.closes(key) => return Vec::new(),
            _ if prompt.input.value().chars().count() >= LONGEST_LINE
                && matches!(key.code, KeyCode::Char(_)) => {}
            _ => {
                let mut input = prompt.input.clone();
                if input.handle_event(&Event::Key(key)).is_some_and(|change| change.value) {
                    changed(&mut prompt, input);
                } else {
                    prompt.input = input;
                }
            }
        }
        self.overlay = Some(Overlay::Prompt(prompt));
        Vec::new()
    }

    /// What the text before the cursor can go on with.
    fn complete(&self, prompt: &mut Prompt) {
        let cursor = prompt.input.cursor();
        let head: String = prompt.input.value().chars().take(cursor).collect();
        let tail: String = prompt.input.value().chars().skip(cursor).collect();
        let files = |folder: &str| self.files(folder);
        let Completion { line, offers } = complete(&head, &self.model, &files);
        let cursor = line.chars().count();
        let listed = if line == head { prompt.listed } else { 0 };
        changed(prompt, Input::new(line + &tail).with_cursor(cursor));
        prompt.note = match &*offers {
            [] => "nothing begins so".to_owned(),
            [_] => note(prompt.input.value()),
            offers => {
                prompt.listed = listed + 1;
                let room = usize::from(self.screen.width.min(prompt::WIDEST).saturating_sub(4));
                offered(offers, listed, room.saturating_sub(BEHIND).clamp(LISTED[1], LISTED[0]))
            }
        };
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
        let line = prompt.input.value().to_owned();
        let effects = match parse(&line) {
            Ok(None) => return Vec::new(),
            Err(fault) => {
                prompt.error = Some(format!("column {}: {fault}", fault.column));
                prompt.fault = Some(fault.column);
                self.overlay = Some(Overlay::Prompt(prompt));
                return Vec::new();
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
        // What was refused stays to be mended.
        if self.overlay.is_none() { self.taken(prompt, effects) } else { effects }
    }
}

/// The names that can go on, as many as a line holds; `turn` counts how often they were listed.
fn offered(offers: &[String], turn: usize, room: usize) -> String {
    let mut pages: Vec<String> = Vec::new();
    for offer in offers {
        let offer = sanitize(offer, room);
        match pages.last_mut() {
            Some(page) if page.chars().count() + 2 + offer.chars().count() <= room => {
                page.push_str("  ");
                page.push_str(&offer);
            }
            _ => pages.push(offer),
        }
    }
    let at = turn % pages.len().max(1);
    match &*pages {
        [all] => all.clone(),
        pages => format!("{}  ({} of {}, Tab goes on)", pages[at], at + 1, pages.len()),
    }
}

/// Another text: what was wrong with the last is forgotten.
fn changed(prompt: &mut Prompt, input: Input) {
    prompt.note = note(input.value());
    prompt.input = input;
    prompt.error = None;
    prompt.fault = None;
    prompt.listed = 0;
}

fn note(line: &str) -> String {
    let name = line.split_whitespace().next().unwrap_or_default();
    let Some(row) = called(name) else { return NOTE.to_owned() };
    match row.takes.what {
        "" => row.help.to_owned(),
        // What is typed as it stands and what stands for something else look different.
        what if what.chars().any(char::is_uppercase) => format!("{name} {what}: {}", row.help),
        what => format!("{name} {}: {}", what.to_uppercase(), row.help),
    }
}
