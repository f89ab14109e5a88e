//! What lies over the screen: prompts, choices, questions and the help, as data.

use crate::explorer::Command;
use crate::explorer::files::Document;
use crate::preset::Key;
use tui_input::Input;

/// What lies over the screen.
#[derive(Debug, Clone)]
pub enum Overlay {
    /// A line to type.
    Prompt(Prompt),
    /// A list to choose from.
    Choose(Choose),
    /// A question to answer with yes or no.
    Confirm(Confirm),
    /// The help, scrolled by so many lines.
    Help(u16),
}

/// A line to type.
#[derive(Debug, Clone)]
pub struct Prompt {
    /// What is asked for.
    pub title: String,
    /// What is allowed, in one line.
    pub note: String,
    /// What has been typed.
    pub input: Input,
    /// Whether the text is still the old value: the first character typed replaces it.
    pub fresh: bool,
    /// What it is for.
    pub purpose: Purpose,
    /// Why the last try was refused.
    pub error: Option<String>,
}

/// What a typed line is for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Purpose {
    /// The value of a key.
    Value(Key),
    /// The name to save under.
    Name,
    /// The file to export to.
    File(Document),
    /// The path of a preset to open.
    Path,
}

impl Purpose {
    /// The command for a typed line.
    pub fn command(self, text: String) -> Command {
        match self {
            Self::Value(key) => Command::Set { key, text },
            Self::Name => Command::SaveAs { name: text, replace: false },
            Self::File(what) => Command::Export { what, path: text, replace: false },
            Self::Path => Command::Open(text),
        }
    }
}

/// A list to choose from.
#[derive(Debug, Clone)]
pub struct Choose {
    /// What is chosen.
    pub title: String,
    /// Its lines.
    pub items: Vec<Item>,
    /// The selected one.
    pub selected: usize,
}

/// One line of a list.
#[derive(Debug, Clone)]
pub struct Item {
    /// What it shows.
    pub text: String,
    /// What it does.
    pub action: Action,
}

/// What choosing a line does.
#[derive(Debug, Clone)]
pub enum Action {
    /// A command.
    Command(Command),
    /// Asks for a line.
    Prompt(Box<Prompt>),
}

/// A question.
#[derive(Debug, Clone)]
pub struct Confirm {
    /// The question, ending in what `y` does.
    pub question: String,
    /// What yes does.
    pub yes: Command,
}
