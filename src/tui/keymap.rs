//! Command id → keys: those from the table of commands, or the person's own.
//!
//! Never Ctrl-S or Ctrl-Q (flow control) or Ctrl-Z (suspend); by default, a function or Alt key is never the only way.
//! A command without a key is reached through the command line.

use super::config::{Config, ConfigError, ConfigMistake};
use crate::explorer::Id;
use crate::explorer::command::spelled;
use crate::explorer::table::{CommandRow, ROWS};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use pulloff_engine::text::quote;

/// One key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keystroke {
    Char(char),
    Ctrl(char),
    Named(KeyCode),
}

/// The names of keys that are not characters.
const NAMES: [(&str, Keystroke); 25] = [
    ("Space", Keystroke::Char(' ')),
    ("Enter", Keystroke::Named(KeyCode::Enter)),
    ("Esc", Keystroke::Named(KeyCode::Esc)),
    ("Tab", Keystroke::Named(KeyCode::Tab)),
    ("Shift-Tab", Keystroke::Named(KeyCode::BackTab)),
    ("Backspace", Keystroke::Named(KeyCode::Backspace)),
    ("Delete", Keystroke::Named(KeyCode::Delete)),
    ("Insert", Keystroke::Named(KeyCode::Insert)),
    ("Up", Keystroke::Named(KeyCode::Up)),
    ("Down", Keystroke::Named(KeyCode::Down)),
    ("Left", Keystroke::Named(KeyCode::Left)),
    ("Right", Keystroke::Named(KeyCode::Right)),
    ("Home", Keystroke::Named(KeyCode::Home)),
    ("End", Keystroke::Named(KeyCode::End)),
    ("PageUp", Keystroke::Named(KeyCode::PageUp)),
    ("PageDown", Keystroke::Named(KeyCode::PageDown)),
    ("F2", Keystroke::Named(KeyCode::F(2))),
    ("F3", Keystroke::Named(KeyCode::F(3))),
    ("F4", Keystroke::Named(KeyCode::F(4))),
    ("F5", Keystroke::Named(KeyCode::F(5))),
    ("F6", Keystroke::Named(KeyCode::F(6))),
    ("F7", Keystroke::Named(KeyCode::F(7))),
    ("F8", Keystroke::Named(KeyCode::F(8))),
    ("F9", Keystroke::Named(KeyCode::F(9))),
    ("F12", Keystroke::Named(KeyCode::F(12))),
];

/// Keys no command can have, and why.
const RESERVED: [(Keystroke, &str); 8] = [
    (Keystroke::Ctrl('s'), "a terminal stops its output on it"),
    (Keystroke::Ctrl('q'), "a terminal resumes its output on it"),
    (Keystroke::Ctrl('z'), "it returns to the shell"),
    (Keystroke::Ctrl('i'), "terminals send it as Tab"),
    (Keystroke::Ctrl('m'), "terminals send it as Enter"),
    (Keystroke::Ctrl('j'), "terminals send it as Enter"),
    (Keystroke::Ctrl('h'), "terminals send it as Backspace"),
    (Keystroke::Ctrl('['), "terminals send it as Esc"),
];

impl Keystroke {
    /// How it is written in the help, the footer and the settings.
    pub fn label(self) -> String {
        match (NAMES.iter().find(|(_, key)| *key == self), self) {
            (Some((name, _)), _) => (*name).to_owned(),
            (None, Self::Char(c)) => c.to_string(),
            (None, Self::Ctrl(c)) => format!("Ctrl-{}", c.to_ascii_uppercase()),
            (None, Self::Named(code)) => code.to_string(),
        }
    }

    /// The key with this label.
    pub fn parse(label: &str) -> Result<Self, String> {
        let named = NAMES.iter().find(|(name, _)| name.eq_ignore_ascii_case(label)).map(|(_, key)| *key);
        let ctrl = label
            .get(..5)
            .filter(|start| start.eq_ignore_ascii_case("Ctrl-"))
            .and_then(|_| single(&label[5..]));
        let key = match (named, ctrl, single(label)) {
            (Some(key), _, _) => key,
            (_, Some(c), _) if c.is_ascii_alphabetic() || c == '[' => Self::Ctrl(c.to_ascii_lowercase()),
            (_, _, Some(c)) if c.is_ascii_digit() => {
                return Err(format!("{c} cannot be bound: digits go to events"));
            }
            (_, _, Some(c)) if !c.is_control() && !c.is_whitespace() => Self::Char(c),
            _ => {
                let names: Vec<&str> = NAMES.iter().map(|(name, _)| *name).collect();
                let quoted = quote(label);
                let names = names.join(", ");
                return Err(format!("\"{quoted}\" is not a key: use a character, Ctrl-A to Ctrl-Z, {names}"));
            }
        };
        match RESERVED.iter().find(|(reserved, _)| *reserved == key) {
            Some((key, why)) => Err(format!("{} cannot be bound: {why}", key.label())),
            None => Ok(key),
        }
    }

    fn matches(self, key: KeyEvent) -> bool {
        let ctrl = key.modifiers.contains(KeyModifiers::CONTROL);
        let alt = key.modifiers.contains(KeyModifiers::ALT);
        match self {
            Self::Char(c) => key.code == KeyCode::Char(c) && !ctrl && !alt,
            Self::Ctrl(c) => key.code == KeyCode::Char(c) && ctrl,
            Self::Named(code) => key.code == code,
        }
    }
}

/// The only character of a text, if it has just one.
fn single(text: &str) -> Option<char> {
    let mut chars = text.chars();
    chars.next().filter(|_| chars.next().is_none())
}

/// The keys a command has unless the person chooses others; the one shown in the footer comes first.
fn usual(row: &CommandRow) -> Vec<Keystroke> {
    row.keys.split_whitespace().filter_map(|label| Keystroke::parse(label).ok()).collect()
}

/// The keys of every command.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Keymap(Vec<(Id, Vec<Keystroke>)>);

impl Default for Keymap {
    fn default() -> Self {
        Self(ROWS.iter().map(|row| (row.id, usual(row))).collect())
    }
}

impl Keymap {
    /// The usual keys, replaced by those of `config` where it has some.
    /// Errors: A key that does not exist or is reserved, one shared by two commands, or no key for the command line.
    pub fn of(config: &Config) -> Result<Self, ConfigError> {
        let (mut map, mut mistakes) = (Self::default(), Vec::new());
        for binding in &config.keys {
            let parsed: Result<Vec<Keystroke>, String> =
                binding.keys.iter().map(|key| Keystroke::parse(key)).collect();
            match parsed {
                Ok(keys) if keys.is_empty() && binding.id == Id::CommandLine => {
                    mistakes.push(ConfigMistake {
                        line: binding.line,
                        what: "command-line needs a key: commands without one are reached through it"
                            .to_owned(),
                    });
                }
                Ok(keys) => map.bind(binding.id, keys),
                Err(what) => mistakes.push(ConfigMistake { line: binding.line, what }),
            }
        }
        if mistakes.is_empty() {
            mistakes.extend(map.clashes(config));
        }
        if mistakes.is_empty() {
            return Ok(map);
        }
        mistakes.sort_by_key(|mistake| mistake.line);
        Err(ConfigError::Mistakes { name: config.name.clone(), mistakes })
    }

    fn bind(&mut self, id: Id, keys: Vec<Keystroke>) {
        if let Some((_, bound)) = self.0.iter_mut().find(|(known, _)| *known == id) {
            *bound = keys;
        }
    }

    fn clashes(&self, config: &Config) -> Vec<ConfigMistake> {
        let all: Vec<(Id, Keystroke)> =
            self.0.iter().flat_map(|(id, keys)| keys.iter().map(|key| (*id, *key))).collect();
        let line = |id: Id| config.keys.iter().find(|binding| binding.id == id).map(|binding| binding.line);
        all.iter()
            .enumerate()
            .filter_map(|(i, (second, key))| {
                let (first, _) = all[..i].iter().find(|(_, other)| other == key)?;
                let (first, second) = if line(*second).is_some() { (first, second) } else { (second, first) };
                let (a, b) = (second.name(), first.name());
                let what = if first == second {
                    format!("{} is given twice for {a}", key.label())
                } else {
                    format!("{} would be the key for both {a} and {b}: give {b} another", key.label())
                };
                Some(ConfigMistake { line: line(*second).unwrap_or(1), what })
            })
            .collect()
    }

    /// The keys of a command; the one shown in the footer comes first.
    pub fn keys(&self, id: Id) -> &[Keystroke] {
        self.0.iter().find(|(known, _)| *known == id).map_or(&[], |(_, keys)| keys)
    }

    /// The command of a key.
    pub fn command(&self, key: KeyEvent) -> Option<Id> {
        self.0.iter().find(|(_, keys)| keys.iter().any(|k| k.matches(key))).map(|(id, _)| *id)
    }

    /// The command of a key given by its label, as in the help.
    pub fn called(&self, label: &str) -> Option<Id> {
        let key = Keystroke::parse(label).ok()?;
        self.0.iter().find(|(_, keys)| keys.contains(&key)).map(|(id, _)| *id)
    }

    /// The command of a key in a list: arrows, Enter and Esc do the same there as everywhere.
    pub fn in_list(&self, key: KeyEvent) -> Option<Id> {
        match key.code {
            KeyCode::Up => Some(Id::Up),
            KeyCode::Down => Some(Id::Down),
            KeyCode::Enter => Some(Id::Edit),
            KeyCode::Esc => Some(Id::Cancel),
            _ => self.command(key),
        }
    }

    /// The first key of a command, or else how to type it.
    pub fn first(&self, id: Id) -> String {
        self.keys(id).first().map_or_else(|| self.typed(id), |key| key.label())
    }

    /// A sentence with each command in it replaced by its first key.
    pub fn spelled(&self, sentence: &str) -> String {
        spelled(sentence, |id| self.first(id))
    }

    /// How to type a command without a key.
    fn typed(&self, id: Id) -> String {
        let line = self.keys(Id::CommandLine).first().map_or_else(String::new, |key| key.label());
        format!("{line}{}", id.name())
    }

    /// The keys of a command as text; empty if it has none.
    pub fn keys_of(&self, id: Id) -> String {
        self.keys(id).iter().map(|key| key.label()).collect::<Vec<_>>().join(" ")
    }

    /// The keys of a command as text, or else how to type it.
    pub fn label(&self, id: Id) -> String {
        let keys = self.keys_of(id);
        if keys.is_empty() { self.typed(id) } else { keys }
    }
}

/// Whether a key asks to suspend the program.
pub fn is_suspend(key: KeyEvent) -> bool {
    Keystroke::Ctrl('z').matches(key)
}

/// The key table of the manual, as Markdown.
pub fn markdown() -> String {
    use std::fmt::Write;
    let map = Keymap::default();
    let mut text = String::from("| key | name | does |\n|---|---|---|\n");
    for row in ROWS {
        let keys: Vec<String> = map.keys(row.id).iter().map(|key| format!("`{}`", key.label())).collect();
        let keys = if keys.is_empty() { format!("`{}`", map.typed(row.id)) } else { keys.join(" ") };
        // Writing to a String cannot fail.
        let _ = writeln!(text, "| {keys} | `{}` | {} |", row.name, row.help);
    }
    text.push_str("| `Ctrl-Z` | | back to the shell; `fg` returns |\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::config::read;
    use std::collections::HashSet;

    #[test]
    fn every_command_has_a_key_of_its_own_and_none_is_flow_control() {
        let mut seen = HashSet::new();
        for row in ROWS {
            assert!(!row.takes.what.is_empty() || !row.keys.is_empty(), "{}", row.name);
            for label in row.keys.split_whitespace() {
                let key = Keystroke::parse(label).unwrap();
                assert!(seen.insert(key.label()), "{} twice", key.label());
                assert_eq!(key.label(), label);
                assert!(!matches!(key, Keystroke::Char('G' | '/' | '0'..='9')), "reserved");
            }
        }
    }

    fn of(text: &str) -> Result<Keymap, String> {
        Keymap::of(&read("c", text).unwrap()).map_err(|error| error.to_string())
    }

    #[test]
    fn a_persons_keys_take_the_place_of_the_usual_ones() {
        let map =
            of("[keys]\njump = []\nstep = [\"x\", \"ctrl-x\", \"F5\", \"space\"]\nundo = \"W\"").unwrap();
        assert_eq!(map.label(Id::Step), "x Ctrl-X F5 Space");
        assert_eq!((map.first(Id::Jump), map.label(Id::Undo)), (":jump".to_owned(), "W".to_owned()));
        assert_eq!(map.command(KeyEvent::new(KeyCode::Char('x'), KeyModifiers::NONE)), Some(Id::Step));
        assert_eq!(map.command(KeyEvent::new(KeyCode::Char('x'), KeyModifiers::CONTROL)), Some(Id::Step));
        assert_eq!(map.command(KeyEvent::new(KeyCode::Char('u'), KeyModifiers::NONE)), None);
        assert_eq!(map.label(Id::NextEvent), Keymap::default().label(Id::NextEvent));
        let line = of("[keys]\ncommand-line = \";\"\njump = []").unwrap();
        assert_eq!(line.first(Id::Jump), ";jump");
    }

    #[test]
    fn clashes_and_keys_that_cannot_be_are_refused_with_line_and_reason() {
        for (text, said) in [
            ("[keys]\nstep = \"x\"", "c:2: x would be the key for both step and jump: give jump another"),
            ("[keys]\njump = \"F2\"\nundo = \"F2\"", "F2 would be the key for both "),
            ("[keys]\nstep = [\"F2\", \"f2\"]", "c:2: F2 is given twice for step"),
            ("[keys]\nstep = \"Ctrl-S\"", "c:2: Ctrl-S cannot be bound: a terminal stops"),
            ("[keys]\nstep = \"ctrl-q\"", "Ctrl-Q cannot be bound"),
            ("[keys]\nstep = \"Ctrl-Z\"", "Ctrl-Z cannot be bound: it returns to the shell"),
            ("[keys]\nstep = \"Ctrl-i\"", "terminals send it as Tab"),
            ("[keys]\nstep = \"3\"", "3 cannot be bound: digits go to events"),
            ("[keys]\nstep = \"Hyper-x\"", "\"Hyper-x\" is not a key"),
            ("[keys]\nstep = \"\"", "\"\" is not a key"),
            ("[keys]\nstep = \"\u{e9}\u{e9}\"", "is not a key"),
            ("[keys]\ncommand-line = []", "command-line needs a key"),
        ] {
            let error = of(text).unwrap_err();
            assert!(error.contains(said), "{text}: {error}");
        }
    }
}
