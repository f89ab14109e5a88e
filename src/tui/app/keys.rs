//! Keys and pastes, prompts, questions, and what the explorer answers.

use super::gap::SHAPES;
use super::state::App;
use crate::explorer::job::Done;
use crate::explorer::look::{MIDDLE, make_room};
use crate::explorer::model::{Level, Question};
use crate::explorer::table::{is_available, row_of};
use crate::explorer::{Command, Effect, Home, Id, Reply, ScreenPanel, View, answer, update};
use crate::figure::Subject;
use crate::store::{Listed, Listing, Source};
use crate::tui::copy::drawn;
use crate::tui::layout::{is_alone, is_too_small};
use crate::tui::overlay::{Choice, Confirm, Dialog, Help, Item, LONGEST_LINE, Prompt, Purpose};
use crate::tui::view::help::ABOUT;
use crate::tui::view::{cells, places, problem};
use crossterm::event::{Event, KeyCode, KeyEvent, KeyModifiers};
use pulloff_engine::preset::data;
use pulloff_engine::preset::schema::{Kind, NONE};
use pulloff_engine::preset::{Row, Value, groups};
use pulloff_engine::problem::Control;
use pulloff_engine::report::number::{short, with_unit};
use pulloff_engine::text::{sanitize, show_path};
use pulloff_engine::units::Quantity;
use ratatui::layout::Rect;
use tui_input::backend::crossterm::EventHandler;

/// The title of what asks for a value.
pub(super) fn title(row: &Row) -> String {
    format!("{}: {}", row.label, row.meaning)
}

/// The question before the person's own preset is deleted; what ships with the program stays.
fn deletion(source: &Source) -> Option<Box<Confirm>> {
    let Source::User { name, path } = source else { return None };
    let question = format!("Delete {} for good? y deletes it, Esc goes back.", show_path(path));
    Some(Box::new(Confirm { question, yes: Command::Delete(name.clone()) }))
}

impl App {
    /// Handles a key press.
    pub fn key(&mut self, key: KeyEvent) -> Vec<Effect> {
        if key.modifiers.contains(KeyModifiers::ALT) {
            // No command has an Alt key; Escape followed at once by another key looks like one.
            let mut effects = self.key(KeyCode::Esc.into());
            effects.extend(self.key(KeyEvent { modifiers: key.modifiers - KeyModifiers::ALT, ..key }));
            return effects;
        }
        // Where nothing can be drawn, nobody sees what a key does: it may only quit, and answer what that asks.
        let answers = matches!(self.overlay, Some(Dialog::Confirm(_)));
        if is_too_small(self.screen) && !answers && self.keymap.command(key) != Some(Id::Quit) {
            return Vec::new();
        }
        let mut effects = self.pause(key);
        effects.extend(match self.overlay.take() {
            None => self.command_key(key),
            Some(Dialog::Prompt(prompt)) => self.prompt_key(prompt, key),
            Some(Dialog::Choose(choose)) => self.choose_key(choose, key),
            Some(Dialog::Confirm(confirm)) => self.confirm_key(confirm, key),
            Some(Dialog::Offer(offer)) => self.offer_key(offer, key),
            Some(Dialog::Help(help)) => {
                self.help_key(help, key);
                Vec::new()
            }
        });
        effects
    }

    /// Ends a run before the key takes effect; the keys of the pace, and those that end it themselves, do not.
    fn pause(&mut self, key: KeyEvent) -> Vec<Effect> {
        let ends = !matches!(self.keymap.command(key), Some(Id::Slower | Id::Faster | Id::Run | Id::Cancel));
        if ends && self.model.is_running() { self.run(Id::Cancel.into()) } else { Vec::new() }
    }

    /// Handles pasted text: it goes into a prompt and nowhere else, and is never taken as commands.
    pub fn paste(&mut self, text: &str) -> Vec<Effect> {
        let Some(mut over) = self.overlay.take() else { return Vec::new() };
        let mut effects = Vec::new();
        if let Dialog::Prompt(prompt) = &mut over
            && !prompt.waits
        {
            if std::mem::take(&mut prompt.fresh) {
                prompt.input.reset();
            }
            for c in sanitize(text.split(['\n', '\r']).next().unwrap_or(""), LONGEST_LINE).chars() {
                prompt.input.handle(tui_input::InputRequest::InsertChar(c));
            }
            effects = self.check(prompt);
        }
        self.overlay = Some(over);
        effects
    }

    /// The size of the screen is known, and how many views it has room for.
    pub fn make_room(&mut self, screen: Rect, views: usize) -> Vec<Effect> {
        self.screen = screen;
        let drawn = places(self, screen).map(|regions| regions.panels(is_alone(screen, self.enlarged)));
        if drawn.is_some_and(|drawn| !drawn.contains(&self.model.panel)) {
            self.model.panel = ScreenPanel::Charts;
        }
        let problem = places(self, screen).filter(|regions| !regions.is_stacked);
        if let Some(area) = problem.and_then(|regions| regions.problem) {
            self.first_value = problem::first_value(self, area);
        }
        make_room(&mut self.model, views)
    }

    /// Handles the reply of a worker.
    pub fn reply(&mut self, reply: Reply) -> Vec<Effect> {
        let is_file = matches!(reply, Reply::File(_));
        let is_named = matches!(&reply, Reply::File(done) if matches!(**done, Done::Named(_)));
        let effects = answer(&mut self.model, reply);
        if is_named {
            self.list_again();
        } else if is_file {
            self.file_answered();
        }
        // A line being typed, or an offer, is not interrupted: the question waits until it is over.
        if !matches!(self.overlay, Some(Dialog::Prompt(_) | Dialog::Offer(_))) {
            self.raise_questions();
        }
        effects
    }

    /// A prompt that waited for a file closes, or stays with the reason for the refusal.
    pub(super) fn file_answered(&mut self) {
        let model = &mut self.model;
        let Some(Dialog::Prompt(prompt)) = self.overlay.as_mut().filter(|over| over.waits()) else { return };
        // A question that replaces it states the reason itself.
        if model.question.is_none()
            && let Some((_, reason)) = model.message.take_if(|(level, _)| level.is_bad())
        {
            (prompt.waits, prompt.error) = (false, Some(self.keymap.spelled(&reason)));
        } else {
            self.overlay = None;
        }
    }

    /// A prompt whose line was taken: it stays with the reason if the line was refused, and also while it waits for a
    /// file.
    pub(super) fn taken(&mut self, mut prompt: Prompt, effects: Vec<Effect>) -> Vec<Effect> {
        let refused = self.model.message.take_if(|(level, _)| level.is_bad());
        prompt.error = refused.map(|(_, reason)| self.keymap.spelled(&reason));
        prompt.waits =
            prompt.error.is_none() && effects.iter().any(|effect| matches!(effect, Effect::File(_)));
        if prompt.waits || prompt.error.is_some() {
            self.overlay = Some(Dialog::Prompt(prompt));
        }
        effects
    }

    /// Runs a command, and notices if it leaves a question.
    pub(super) fn run(&mut self, mut command: Command) -> Vec<Effect> {
        if let Command::Export { what, .. } = &mut command {
            match drawn(self, what.clone()) {
                Ok(page) => *what = page,
                Err(why) => return self.say(Level::Error, format!("not exported: {why}")),
            }
        }
        let (view, goes) = (self.model.view, matches!(command, Command::Go(_) | Command::Show(_)));
        let effects = update(&mut self.model, command);
        // If one panel fills the screen, the requested chart would otherwise be out of sight.
        if (goes || self.model.view != view) && is_alone(self.screen, self.enlarged) {
            self.model.panel = ScreenPanel::Charts;
        }
        self.raise_questions();
        effects
    }

    /// Turns the questions of the model into overlays.
    pub(super) fn raise_questions(&mut self) {
        if let Some(Question::ReplacePreset(..) | Question::ReplaceFile(..)) = self.model.question {
            // The question says that it exists; that nothing was written would be an answer to it.
            self.model.message = None;
        }
        match self.model.question.take() {
            None => {}
            Some(Question::File(key, folder)) => self.choose_file(&key, &folder),
            Some(Question::Columns(foreign)) => self.choose_columns(*foreign),
            Some(Question::Preset(listing)) => self.choose_preset(&listing),
            Some(Question::SaveAnyway) => {
                let question = "The file was changed by someone else. y saves over it, Esc goes back.";
                self.ask(question.to_owned(), Command::SaveAnyway);
            }
            Some(Question::ReplacePreset(name, with_data)) => {
                let question = format!("A preset called {name} exists. Replace it? y does, Esc goes back.");
                self.ask(question, Command::SaveAs { name, replace: true, with_data });
            }
            Some(Question::ReplaceFile(what, path)) => {
                let question = format!("{} exists. Replace it? y does, Esc goes back.", sanitize(&path, 60));
                self.ask(question, Command::Export { what, path, replace: true });
            }
        }
    }

    pub(super) fn choose_preset(&mut self, listing: &Listing) {
        let shown = |title: &Result<String, String>| match title {
            Ok(title) => title.clone(),
            Err(error) => format!("cannot be read: {error}"),
        };
        // A preset saved under another name keeps its title, so the list must say which one it is.
        let titles: Vec<_> = listing.presets.iter().filter_map(|entry| entry.title.as_ref().ok()).collect();
        let own = |entry: &Listed| {
            let same = titles.iter().filter(|title| Ok(**title) == entry.title.as_ref()).count();
            if same > 1 && matches!(entry.source, Source::User { .. }) { " (saved by you)" } else { "" }
        };
        let mut items: Vec<Item> = listing
            .presets
            .iter()
            .map(|entry| Item {
                text: format!("{:<14} {}{}", entry.name, sanitize(&shown(&entry.title), 90), own(entry)),
                note: entry.comment.clone(),
                action: Choice::Command(Command::Open(entry.name.clone())),
                delete: deletion(&entry.source),
            })
            .collect();
        let note = "a path with a / or ending in .toml";
        let prompt = Prompt::new("Open a file", note, String::new(), Purpose::Path);
        items.push(Item::new("a file ...", Choice::Prompt(Box::new(prompt))));
        self.choose("Open a preset", items, 0);
    }

    /// Puts something over the screen, which asks for nothing to be done yet.
    pub(super) fn lay(&mut self, over: Dialog) -> Vec<Effect> {
        self.overlay = Some(over);
        Vec::new()
    }

    /// Says something on the status line, which is all that is done.
    pub(super) fn say(&mut self, level: Level, text: impl Into<String>) -> Vec<Effect> {
        self.model.message = Some((level, text.into()));
        Vec::new()
    }

    pub(super) fn ask(&mut self, question: String, yes: Command) -> Vec<Effect> {
        self.lay(Dialog::Confirm(Confirm { question, yes }))
    }

    pub(super) fn command_key(&mut self, key: KeyEvent) -> Vec<Effect> {
        let is_plain = key.modifiers.is_empty();
        if std::mem::take(&mut self.going) {
            let letter = |home: &Home| Some(key.code) == home.name().chars().next().map(KeyCode::Char);
            match Home::ALL.iter().find(|home| letter(home) && is_plain) {
                Some(home) => return self.run(Command::Go(*home)),
                None if self.keymap.in_list(key) == Some(Id::Cancel) => return Vec::new(),
                None => {}
            }
        }
        if let KeyCode::Char(digit @ '1'..='9') = key.code
            && is_plain
        {
            let number = usize::try_from(u32::from(digit) - u32::from('0')).unwrap_or(1);
            return self.run(Command::SelectEvent(number));
        }
        let Some(id) = self.keymap.command(key) else {
            if let Some(effects) = self.page_key(key) {
                return effects;
            }
            let text = format!("that key does nothing here; {} shows all keys", self.keymap.first(Id::Help));
            return self.say(Level::Info, text);
        };
        self.act(id)
    }

    /// Runs a command, or asks for what it takes.
    pub(super) fn act(&mut self, id: Id) -> Vec<Effect> {
        match id {
            Id::Step => self.run(Command::HeldStep(self.held)),
            Id::Go => {
                (self.going, self.model.message) = (true, None);
                Vec::new()
            }
            Id::Help | Id::CommandLine => self.ask_line(id == Id::Help),
            Id::Quit if self.model.is_unsaved() => {
                let saves =
                    self.keymap.keys(Id::SaveAs).first().map(|key| format!(", {} saves", key.label()));
                let kept =
                    if self.model.kept.is_ok() { "; the session keeps it" } else { ", nor is the session" };
                let question = format!("Not saved{kept}. y quits, Esc stays{}.", saves.unwrap_or_default());
                self.ask(question, Id::Quit.into())
            }
            Id::Save if self.model.source.path().is_none() => self.ask_name(),
            Id::SaveAs => self.ask_name(),
            Id::Export => self.ask_export(),
            Id::Data => self.browse(data::FILE.into()),
            Id::Copy => self.ask_copy(),
            Id::Control => self.ask_control(),
            id if row_of(id).takes.is_listed && is_available(&self.model, id) => {
                self.ask_argument(row_of(id))
            }
            Id::ZoomIn | Id::ZoomOut => {
                let about = self.place_here();
                self.run(Command::Zoom { view: self.model.view, closer: id == Id::ZoomIn, about })
            }
            Id::Cancel if self.enlarged && !self.model.is_busy() && self.model.cross.is_none() => {
                self.enlarged = false;
                Vec::new()
            }
            Id::CrossHair if self.model.cross.is_none() => {
                let here = self.place_here();
                let effects = self.run(id.into());
                self.model.cross = self.model.cross.map(|_| here);
                effects
            }
            Id::Enlarge => {
                self.enlarged = !self.enlarged;
                Vec::new()
            }
            Id::Mouse => self.switch_mouse(),
            Id::About => self.lay(Dialog::Help(Help { page: ABOUT, ..Help::default() })),
            Id::NextPanel | Id::PreviousPanel => self.next_panel(id == Id::NextPanel),
            Id::Up | Id::Down if self.model.panel == ScreenPanel::Problem => {
                self.value_beside(id == Id::Down)
            }
            Id::Edit if self.model.panel == ScreenPanel::Charts && self.model.cross.is_none() => {
                match self.model.view {
                    View::Study => self.ask_argument(row_of(Id::Study)),
                    View::Map => self.run(Id::Map.into()),
                    _ => self.run(Id::Edit.into()),
                }
            }
            Id::Edit if self.model.panel == ScreenPanel::Charts => self.go_to_cross_hair(),
            Id::Edit if self.model.panel == ScreenPanel::Problem => self.ask_value(),
            id => self.run(id.into()),
        }
    }

    /// The next panel that is on the screen.
    fn next_panel(&mut self, forward: bool) -> Vec<Effect> {
        let id = if forward { Id::NextPanel } else { Id::PreviousPanel };
        let Some(regions) = places(self, self.screen) else { return self.run(id.into()) };
        let panels = regions.panels(is_alone(self.screen, self.enlarged));
        let here = panels.iter().position(|panel| *panel == self.model.panel);
        let by = if forward { 1 } else { panels.len().saturating_sub(1) };
        let next = here.map_or(0, |here| here + by) % panels.len().max(1);
        panels.get(next).map_or_else(Vec::new, |panel| self.run(Command::Pick { panel: *panel, line: None }))
    }

    /// Selects the value one line further down or up in Problem.
    fn value_beside(&mut self, down: bool) -> Vec<Effect> {
        let stacked = places(self, self.screen).filter(|regions| regions.is_stacked);
        let Some(area) = stacked.and_then(|regions| regions.problem) else {
            return self.run(if down { Id::Down } else { Id::Up }.into());
        };
        let line = Some(cells::value_beside(self, area.width.saturating_sub(2), down));
        self.run(Command::Pick { panel: ScreenPanel::Problem, line })
    }

    /// The cross-hair, or else where the walker stands in the window of the first view, or else the middle of that
    /// window.
    pub fn place_here(&self) -> (f64, f64) {
        let view = self.model.view;
        if let Some(cross) = self.model.cross {
            return cross;
        }
        let place = Subject::of(&self.model).and_then(|subject| {
            let figure = subject.figure(view).on_screen();
            figure.bounds.part(&self.model.window(view)).share(figure.here()?)
        });
        place.unwrap_or(MIDDLE)
    }

    pub(super) fn ask_value(&mut self) -> Vec<Effect> {
        let Some((row, value)) = self.model.selected_knob() else { return Vec::new() };
        match (&*row.key, row.kind) {
            ("gap.shape", Kind::Choice(words)) => {
                return self.ask_word((&row, value.as_ref()), words, &SHAPES, "Gap");
            }
            ("gap.formula", _) => return self.ask_formula(row.key.clone(), value),
            (_, Kind::File | Kind::Points) => return self.browse(row.key.clone()),
            (_, Kind::Choice(words)) => {
                return self.ask_word((&row, value.as_ref()), words, &[], &title(&row));
            }
            (_, Kind::Control) => return self.ask_control(),
            _ => {}
        }
        self.lay(Dialog::Prompt(self.value_prompt(&row, value)))
    }

    /// Asks for the text of a value.
    pub(super) fn value_prompt(&self, row: &Row, value: Option<Value>) -> Prompt {
        let units = &self.model.preset.units;
        let text = value.map_or_else(String::new, |value| match value {
            // With its unit, which also applies to a bare number typed in its place.
            Value::Number(x) => {
                let shown = row.shown(units, x);
                // A group is computed, so its last digit is rounding.
                let is_group = groups::effect(&row.key).is_some();
                let number = if is_group { short(shown.number, 15) } else { format!("{:?}", shown.number) };
                shown.text(&number, true)
            }
            Value::Control(Control::Stiffness(k)) => {
                with_unit(units, Quantity::ForcePerLength, k, true, |k| format!("stiffness={k}"))
            }
            other => other.to_string(),
        });
        let note = match row.unit_in(units) {
            Some(unit) => format!("a value with a unit; a bare number is in {}", unit.ascii()),
            None => row.allowed(),
        };
        let can_go = row.is_optional() && self.model.preset.get(&row.key).is_some();
        let note = if can_go { format!("{note}; {NONE} removes it") } else { note };
        Prompt::new(title(row), &note, text, Purpose::Value(row.key.clone()))
    }

    pub(super) fn prompt(&mut self, title: &str, note: &str, text: String, purpose: Purpose) -> Vec<Effect> {
        self.lay(Dialog::Prompt(Prompt::new(title, note, text, purpose)))
    }

    /// Whether a key closes a prompt: one of those that quit, unless it is text.
    pub(super) fn closes(&self, key: KeyEvent) -> bool {
        let is_text = matches!(key.code, KeyCode::Char(_)) && !key.modifiers.contains(KeyModifiers::CONTROL);
        self.keymap.command(key) == Some(Id::Quit) && !is_text
    }

    pub(super) fn prompt_key(&mut self, mut prompt: Prompt, key: KeyEvent) -> Vec<Effect> {
        let mut effects = Vec::new();
        if matches!(prompt.purpose, Purpose::Line { .. }) {
            return self.line_key(prompt, key);
        }
        match key.code {
            KeyCode::Esc => return self.close(&prompt),
            _ if prompt.waits => {}
            KeyCode::Enter => {
                let text = prompt.input.value().to_owned();
                if let Some(fault) = prompt.formula_error() {
                    prompt.refuse(&fault);
                    return self.lay(Dialog::Prompt(prompt));
                }
                let Some(command) = prompt.purpose.clone().command(text) else { return effects };
                let effects = self.run(command);
                return self.taken(prompt, effects);
            }
            _ if self.closes(key) => return self.close(&prompt),
            _ if prompt.input.value().chars().count() >= LONGEST_LINE
                && matches!(key.code, KeyCode::Char(_)) => {}
            code => {
                let plain = key.modifiers.difference(KeyModifiers::SHIFT).is_empty();
                if std::mem::take(&mut prompt.fresh) && matches!(code, KeyCode::Char(_)) && plain {
                    prompt.input.reset();
                }
                let is_changed =
                    prompt.input.handle_event(&Event::Key(key)).is_some_and(|change| change.value);
                if is_changed {
                    effects = self.check(&mut prompt);
                }
            }
        }
        self.overlay = Some(Dialog::Prompt(prompt));
        effects
    }

    /// Opening another preset gives up unsaved changes, so it asks first.
    pub(super) fn open_or_ask(&mut self, command: Command) -> Vec<Effect> {
        if self.model.is_unsaved() && matches!(command, Command::Open(_) | Command::OpenWith { .. }) {
            let question =
                "The preset has unsaved changes. y opens the other (undo brings them back), Esc goes back.";
            return self.ask(question.to_owned(), command);
        }
        self.run(command)
    }

    pub(super) fn confirm_key(&mut self, confirm: Confirm, key: KeyEvent) -> Vec<Effect> {
        match key.code {
            KeyCode::Char('y') => self.run(confirm.yes),
            KeyCode::Char('n') | KeyCode::Esc => Vec::new(),
            _ if self.keymap.command(key) == Some(Id::SaveAs) => self.ask_name(),
            _ => self.lay(Dialog::Confirm(confirm)),
        }
    }
}
