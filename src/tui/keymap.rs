//! Command id → keys. Every command has a key that every terminal sends.
//!
//! Never Ctrl-S or Ctrl-Q (flow control); never a function or Alt key as the only way.

use crate::explorer::Id;
use crate::explorer::command::ROWS;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// One key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Key {
    /// A character.
    Char(char),
    /// A character with Ctrl.
    Ctrl(char),
    /// A key with a name.
    Named(KeyCode),
}

impl Key {
    /// How it is written in the help and the footer.
    pub fn label(self) -> String {
        match self {
            Self::Char(' ') => "Space".to_owned(),
            Self::Char(c) => c.to_string(),
            Self::Ctrl(c) => format!("Ctrl-{}", c.to_ascii_uppercase()),
            Self::Named(KeyCode::BackTab) => "Shift-Tab".to_owned(),
            Self::Named(code) => code.to_string(),
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

/// The keys of a command, the one shown in the footer first.
pub fn keys(id: Id) -> &'static [Key] {
    use Key::{Char, Ctrl, Named};
    match id {
        Id::Step => &[Char(' ')],
        Id::Run => &[Char('r')],
        Id::NextLimit => &[Char('n')],
        Id::PreviousLimit => &[Char('N')],
        Id::Jump => &[Char('x')],
        Id::Reverse => &[Char('b')],
        Id::Halve => &[Char('[')],
        Id::Double => &[Char(']')],
        Id::Undo => &[Char('u')],
        Id::UndoCommand => &[Char('U')],
        Id::Redo => &[Ctrl('r')],
        Id::Restart => &[Char('0')],
        Id::Control => &[Char('c')],
        Id::Less => &[Char('<'), Char(',')],
        Id::More => &[Char('>'), Char('.')],
        Id::MuchLess => &[Char('{')],
        Id::MuchMore => &[Char('}')],
        Id::Edit => &[Named(KeyCode::Enter)],
        Id::Up => &[Named(KeyCode::Up), Char('k')],
        Id::Down => &[Named(KeyCode::Down), Char('j')],
        Id::Left => &[Named(KeyCode::Left), Char('h')],
        Id::Right => &[Named(KeyCode::Right), Char('l')],
        Id::NextPanel => &[Named(KeyCode::Tab)],
        Id::PreviousPanel => &[Named(KeyCode::BackTab)],
        Id::NextView => &[Char('t')],
        Id::PreviousView => &[Char('T')],
        Id::ZoomIn => &[Char('+'), Char('=')],
        Id::ZoomOut => &[Char('-')],
        Id::Fit => &[Char('f')],
        Id::CrossHair => &[Char('i')],
        Id::Axes => &[Char('a')],
        Id::Events => &[Char('v')],
        Id::Device => &[Char('K')],
        Id::Overlays => &[Char('y')],
        Id::Pin => &[Char('p')],
        Id::Pins => &[Char('P')],
        Id::Open => &[Char('o')],
        Id::Save => &[Char('s')],
        Id::SaveAs => &[Char('S')],
        Id::Export => &[Char('e')],
        Id::Copy => &[Char('Y')],
        Id::Mouse => &[Char('m')],
        Id::Help => &[Char('?')],
        Id::Cancel => &[Named(KeyCode::Esc)],
        Id::Quit => &[Char('q'), Ctrl('c')],
    }
}

/// The command of a key.
pub fn command(key: KeyEvent) -> Option<Id> {
    ROWS.iter().map(|row| row.id).find(|id| keys(*id).iter().any(|k| k.matches(key)))
}

/// Whether a key asks to stop the program for a while.
pub fn is_suspend(key: KeyEvent) -> bool {
    Key::Ctrl('z').matches(key)
}

/// The keys of a command as text.
pub fn label(id: Id) -> String {
    keys(id).iter().map(|key| key.label()).collect::<Vec<_>>().join(" ")
}

/// The key table of the manual, as Markdown.
pub fn markdown() -> String {
    use std::fmt::Write;
    let mut text = String::from("| key | does |\n|---|---|\n");
    for row in ROWS {
        let keys: Vec<String> = keys(row.id).iter().map(|key| format!("`{}`", key.label())).collect();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "| {} | {} |", keys.join(" "), row.help);
    }
    text.push_str("| `Ctrl-Z` | back to the shell; `fg` returns |\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_command_has_a_key_of_its_own_and_none_is_flow_control() {
        let mut seen = HashSet::new();
        for row in ROWS {
            assert!(!keys(row.id).is_empty(), "{}", row.name);
            for key in keys(row.id) {
                assert!(seen.insert(key.label()), "{} twice", key.label());
                assert!(!matches!(key, Key::Ctrl('s' | 'q' | 'z')));
                assert!(!matches!(key, Key::Char('g' | 'G' | ':' | '/' | '1'..='9')), "reserved");
            }
        }
    }
}
