//! What lies over the screen: prompts, choices, questions and the help, as data.

use crate::explorer::Command;
use crate::explorer::data::Foreign;
use crate::explorer::export::Export;
use crate::explorer::script::PaletteEntry;
use crate::explorer::session::Snapshot;
use crate::figure::Figure;
use pulloff_engine::gap::formula::{Formula, FormulaError};
use pulloff_engine::measured::ColumnRole;
use pulloff_engine::preset::{Key, data};
use std::sync::Arc;
use tui_input::Input;

/// What lies over the screen.
#[derive(Debug, Clone)]
pub enum Dialog {
    Prompt(Prompt),
    Choose(Choose),
    Confirm(Confirm),
    Offer(ResumeOffer),
    Help(Help),
}

impl Dialog {
    /// Whether a line was taken and waits for a file.
    pub fn waits(&self) -> bool {
        matches!(self, Self::Prompt(prompt) if prompt.waits)
    }
}

/// The longest line that can be typed or pasted, in characters.
pub const LONGEST_LINE: usize = 4096;

/// A line to be typed.
#[derive(Debug, Clone)]
pub struct Prompt {
    pub title: String,
    pub note: String,
    pub input: Input,
    /// Whether the text is still the old value, which the first character typed replaces.
    pub fresh: bool,
    pub purpose: Purpose,
    pub error: Option<String>,
    /// Whether its line was taken and waits for the file it needs: no key changes it until the file is read or written.
    pub waits: bool,
    /// The column of the error in the text, from 1, if it has one.
    pub fault: Option<usize>,
    /// What the line of a command could become.
    pub entries: Vec<PaletteEntry>,
    /// The entry that Enter runs; `None` if it runs the line itself.
    pub selected: Option<usize>,
}

/// What a typed line is for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Purpose {
    Value(Key),
    /// The gap as a formula: tried while it is typed.
    Formula(Key),
    Name {
        /// Whether the data of a profile are copied beside the preset.
        with_data: bool,
    },
    File(Export),
    Path,
    /// A command, from the list of all.
    Line {
        /// Whether it was opened to see what can be done.
        is_help: bool,
    },
}

/// The help, and the text being searched for in it.
#[derive(Debug, Clone, Default)]
pub struct Help {
    pub page: usize,
    pub line: usize,
    pub typing: Option<Input>,
    pub pattern: String,
    pub found: Option<Occurrence>,
}

/// Where a pattern was found in the help.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Occurrence {
    pub page: usize,
    pub line: usize,
    /// The number of this occurrence, from 1, over all pages.
    pub number: usize,
    /// How many there are in all.
    pub of: usize,
}

impl Prompt {
    /// A prompt that starts with `text`; the first character typed replaces a value or the name of a file.
    pub fn new(title: impl Into<String>, note: &str, text: String, purpose: Purpose) -> Self {
        Self {
            title: title.into(),
            note: note.to_owned(),
            input: Input::new(text),
            fresh: matches!(purpose, Purpose::Value(_) | Purpose::Name { .. } | Purpose::File(_)),
            purpose,
            error: None,
            waits: false,
            fault: None,
            entries: Vec::new(),
            selected: None,
        }
    }

    /// The message below the text and its list.
    pub fn said(&self) -> &str {
        let selected = self.selected.and_then(|at| self.entries.get(at));
        selected.map_or(&self.note, |entry| &entry.says)
    }

    /// The error in the text, if it is a formula.
    pub fn formula_error(&self) -> Option<FormulaError> {
        match self.purpose {
            Purpose::Formula(_) => Formula::parse(self.input.value()).err(),
            _ => None,
        }
    }

    /// Shows what is wrong with the text, and where.
    pub fn refuse(&mut self, fault: &FormulaError) {
        self.error = Some(fault.to_string());
        self.fault = Some(fault.place.column);
    }
}

impl Purpose {
    /// The command for a typed line; a line with a grammar of its own is read elsewhere.
    pub fn command(self, text: String) -> Option<Command> {
        Some(match self {
            Self::Value(key) | Self::Formula(key) => Command::Set { key, text },
            Self::Name { with_data } => Command::SaveAs { name: text, replace: false, with_data },
            Self::File(what) => Command::Export { what, path: text, replace: false },
            Self::Path => Command::Open(text),
            Self::Line { .. } => return None,
        })
    }
}

/// A list to choose from.
#[derive(Debug, Clone)]
pub struct Choose {
    pub title: String,
    pub items: Vec<Item>,
    /// The typed text: only lines that contain it are shown.
    pub filter: String,
    pub selected: usize,
    pub picture: Option<Figure>,
}

impl Choose {
    /// The lines that contain the typed text, with their index among all lines.
    pub fn shown(&self) -> Vec<(usize, &Item)> {
        let wanted = self.filter.to_lowercase();
        let items = self.items.iter().enumerate();
        let mut found: Vec<_> = items.filter(|(_, item)| item.has(&wanted)).collect();
        // Lines that begin with the text come first, then those whose name contains it.
        found.sort_by_key(|(_, item)| {
            let text = item.text.to_lowercase();
            let is_in_name = text.split_whitespace().next().is_some_and(|name| name.contains(&wanted));
            (!text.starts_with(&wanted), !is_in_name)
        });
        found
    }

    /// Whether some line contains this text.
    pub fn has(&self, text: &str) -> bool {
        let wanted = text.to_lowercase();
        self.items.iter().any(|item| item.has(&wanted))
    }

    /// Whether some lines have a note.
    pub fn has_notes(&self) -> bool {
        self.items.iter().any(|item| !item.note.is_empty())
    }

    /// The selected line, and its index among all; `None` if no line contains the typed text.
    pub fn current(&self) -> Option<(usize, &Item)> {
        self.shown().get(self.selected).copied()
    }
}

/// One line of a list.
#[derive(Debug, Clone)]
pub struct Item {
    pub text: String,
    /// The message below the list while the line is selected; may be empty.
    pub note: String,
    pub action: Choice,
    /// The question before it is deleted, and what deletes it; `None` if it cannot be deleted.
    pub delete: Option<Box<Confirm>>,
}

impl Item {
    /// A line that cannot be deleted.
    pub fn new(text: impl Into<String>, action: Choice) -> Self {
        Self { text: text.into(), note: String::new(), action, delete: None }
    }

    /// Whether it contains this text, which is in lower case.
    fn has(&self, wanted: &str) -> bool {
        self.text.to_lowercase().contains(wanted)
    }

    /// A word that a value can be, and what it means, which may be empty.
    pub fn of_word(word: &str, meaning: &str, action: Choice) -> Self {
        Self::new(format!("{word:<13} {meaning}").trim_end(), action)
    }
}

/// What choosing a line does.
#[derive(Debug, Clone)]
pub enum Choice {
    Command(Command),
    Prompt(Box<Prompt>),
    Copy(Excerpt),
    /// Continue naming the columns of a measured curve.
    Columns(Box<Choosing>),
}

impl Choice {
    /// Sets a key to what `text` says.
    pub fn set(key: &Key, text: impl Into<String>) -> Self {
        Self::Command(Command::Set { key: key.clone(), text: text.into() })
    }
}

/// The questions, asked one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnQuestion {
    X,
    Force,
    Segment,
}

impl ColumnQuestion {
    /// How many questions there are.
    pub const COUNT: usize = 3;

    /// What may be chosen, the most likely first.
    pub fn roles(self) -> &'static [ColumnRole] {
        match self {
            Self::X => &[
                ColumnRole::Approach,
                ColumnRole::Position,
                ColumnRole::Radius,
                ColumnRole::Diameter,
                ColumnRole::Area,
            ],
            Self::Force => &[ColumnRole::Force, ColumnRole::Deflection],
            Self::Segment => &[ColumnRole::Segment],
        }
    }
}

/// A file whose columns are being chosen, and what was chosen so far.
#[derive(Debug, Clone)]
pub struct Choosing {
    pub foreign: Arc<Foreign>,
    pub step: ColumnQuestion,
    /// What was chosen, in the form used by `data.columns`.
    pub said: Vec<String>,
    /// The column whose unit is being asked for: its role and its number.
    pub unit: Option<(ColumnRole, usize)>,
    /// The columns that were chosen.
    pub taken: Vec<usize>,
}

impl Choosing {
    /// Records what a column is, and goes to the next question.
    pub fn says(&mut self, role: ColumnRole, number: usize, unit: Option<&str>) {
        let unit = unit.map_or_else(String::new, |unit| format!(" [{unit}]"));
        self.said.push(format!("{}={number}{unit}", role.word()));
        self.unit = None;
        self.step = match self.step {
            ColumnQuestion::X => ColumnQuestion::Force,
            ColumnQuestion::Force | ColumnQuestion::Segment => ColumnQuestion::Segment,
        };
    }

    /// Whether there are no more questions.
    pub fn is_done(&self) -> bool {
        self.unit.is_none() && self.said.len() == ColumnQuestion::COUNT
    }

    /// The command that opens the file with the columns chosen, as one change.
    pub fn done(&self) -> Command {
        let mut assignments = vec![(data::COLUMNS.into(), self.said.join(","))];
        assignments.extend(self.foreign.assignments.iter().filter(|(key, _)| key != data::COLUMNS).cloned());
        Command::Assign(assignments)
    }
}

/// A session that may be resumed. Any key but those that accept it goes on without it, and does what it always does.
#[derive(Debug, Clone)]
pub struct ResumeOffer {
    pub question: String,
    pub snapshot: Box<Snapshot>,
}

/// A question.
#[derive(Debug, Clone)]
pub struct Confirm {
    /// The question; it ends with what `y` does.
    pub question: String,
    pub yes: Command,
}

/// What can be copied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Excerpt {
    /// The state of the walker, one quantity per line.
    State,
    Events,
    Chart,
    Screen,
}

impl Excerpt {
    /// All, in the order they are offered.
    pub const ALL: [Self; 4] = [Self::State, Self::Events, Self::Chart, Self::Screen];

    /// Its name, and what it is.
    pub fn words(self) -> [&'static str; 2] {
        match self {
            Self::State => ["state", "the walker's state: δ, P, s and what goes with them"],
            Self::Events => ["events", "the events of the path, tab-separated, for a spreadsheet"],
            Self::Chart => ["chart", "the first chart as text"],
            Self::Screen => ["screen", "the whole screen as text"],
        }
    }
}
