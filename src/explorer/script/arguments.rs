//! What follows the name of a command: what a command takes, and how it is read.

use super::fault::ScriptFault;
use super::keys::{known, short};
use super::lexer::Word;
use super::offers::{Offer, Typing};
use crate::explorer::command::{Assignment, Command, Id, LENGTHS, MOST_STEPS};
use crate::explorer::export::{Export, ends_in};
use crate::explorer::pins;
use crate::explorer::view::{Home, Overlay, View};
use pulloff_engine::preset::called::is_called;
use pulloff_engine::preset::schema::Kind;
use pulloff_engine::preset::{Key, PARAMETERS};
use pulloff_engine::sweep::QuantityColumn;
use pulloff_engine::text::{closest, quote};
use pulloff_engine::units::parse_quantity;

/// What a command takes.
#[derive(Debug, Clone, Copy)]
#[must_use]
pub struct Takes {
    /// In a word or two; what is typed literally is in capitals; empty if it takes nothing.
    pub what: &'static str,
    /// Reads it.
    pub read: fn(&mut Rest<'_>) -> Result<Command, ScriptFault>,
    /// What can be typed as its first word.
    pub offers: fn(&Typing<'_>) -> Vec<Offer>,
    /// Whether more is offered after the first word.
    pub goes_on: bool,
    /// Whether the command is meaningless without it.
    pub is_needed: bool,
    /// Whether the screen lists what is offered when it is missing.
    pub is_listed: bool,
}

/// What a command takes, and how it is read.
pub const fn takes(what: &'static str, read: fn(&mut Rest<'_>) -> Result<Command, ScriptFault>) -> Takes {
    Takes { what, read, offers: |_| Vec::new(), goes_on: false, is_needed: false, is_listed: false }
}

impl Takes {
    /// A command takes nothing.
    pub const NOTHING: Self = takes("", |rest| Err(ScriptFault::new(rest.end, "nothing goes here")));

    /// The same, with what can be typed there.
    pub const fn offering(self, offers: fn(&Typing<'_>) -> Vec<Offer>) -> Self {
        Self { offers, ..self }
    }

    /// The same, with what can be typed there, listed on the screen when it is missing.
    pub const fn listing(self, offers: fn(&Typing<'_>) -> Vec<Offer>) -> Self {
        Self { offers, is_listed: true, ..self }
    }

    /// The same, with what can be typed there, word by word.
    pub const fn going_on(self, offers: fn(&Typing<'_>) -> Vec<Offer>) -> Self {
        Self { offers, goes_on: true, ..self }
    }

    /// The same, for a command that is meaningless without it.
    pub const fn always(self) -> Self {
        Self { is_needed: true, ..self }
    }
}

/// The words after the name of a command.
pub struct Rest<'a> {
    pub(super) words: &'a [Word],
    /// The column in which a missing word would be.
    pub(super) end: usize,
}

impl<'a> Rest<'a> {
    fn next(&mut self) -> Option<&'a Word> {
        let (first, rest) = self.words.split_first()?;
        self.words = rest;
        Some(first)
    }

    pub(super) fn need(&mut self, what: &str) -> Result<&'a Word, ScriptFault> {
        let end = self.end;
        self.next().ok_or_else(|| ScriptFault::new(end, format!("{what} is missing")))
    }

    /// Takes the next word if it is this one.
    fn takes(&mut self, word: &str) -> bool {
        let is_next = self.words.first().is_some_and(|next| next.text == word);
        if is_next {
            self.words = &self.words[1..];
        }
        is_next
    }

    /// No more words may follow.
    pub(super) fn done(&self, command: Command) -> Result<Command, ScriptFault> {
        match self.words.first() {
            None => Ok(command),
            // It can only be meant as the view of a figure.
            Some(word) if matches!(command, Command::Export { what: Export::Figure(None), .. }) => {
                Err(unknown(word, "view", &View::ALL.map(View::name)))
            }
            Some(word) => {
                let name = command.id().name();
                Err(ScriptFault::new(word.column, format!("{name} takes no \"{}\" here", quote(&word.text))))
            }
        }
    }

    /// A whole number from 1.
    pub fn count(&mut self, what: &str, most: usize) -> Result<usize, ScriptFault> {
        let allowed = format!("a number from 1 to {most}");
        number(self.need(what)?, &allowed, |count| (1..=most).contains(count))
    }

    /// The longest step.
    pub fn length(&mut self) -> Result<f64, ScriptFault> {
        let allowed = format!("a length from {:?} to {:?}", LENGTHS.start(), LENGTHS.end());
        number(self.need("a length")?, &allowed, |length| LENGTHS.contains(length))
    }

    /// A value for a known key, and its unit.
    pub fn assigned(&mut self, what: &str, key: &'static str) -> Result<Command, ScriptFault> {
        let mut text = self.need(what)?.text.clone();
        while let Some(unit) = self.words.first().filter(|_| ends_in_number(&text)) {
            text = format!("{text} {}", unit.text);
            self.next();
        }
        Ok(Command::Assign(vec![(key.into(), text)]))
    }

    /// One of several, by its name.
    fn one<T>(
        &mut self,
        what: &str,
        find: impl Fn(&str) -> Option<T>,
        known: &[&str],
    ) -> Result<T, ScriptFault> {
        let article = if what.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
        let word = self.need(&format!("{article} {what}"))?;
        find(&word.text).ok_or_else(|| unknown(word, what, known))
    }

    fn assignments(
        &mut self,
        key: fn(&str, usize) -> Result<Key, ScriptFault>,
    ) -> Result<Vec<Assignment>, ScriptFault> {
        let mut all: Vec<Assignment> = Vec::new();
        while let Some(word) = self.next() {
            match all.last_mut() {
                // A unit after its number.
                Some((_, number)) if is_value(word) && ends_in_number(number) => {
                    *number = format!("{number} {}", word.text);
                }
                // A further word of a text.
                Some((key, text)) if is_value(word) && takes_text(key) => {
                    *text = format!("{text} {}", word.text);
                }
                // A value after its key, as behind `:` without `set`.
                None if is_value(word) && self.words.first().is_some_and(is_value) => {
                    let value = self.next().map_or("", |value| &value.text);
                    all.push((key(&word.text, word.column)?, value.to_owned()));
                }
                _ => all.push(assignment(word, key)?),
            }
        }
        Ok(all)
    }
}

/// Whether a word is no assignment of its own.
fn is_value(word: &Word) -> bool {
    !word.text.contains('=')
}

/// Whether any text may be the value of a key, or of one with this short name.
fn takes_text(key: &str) -> bool {
    PARAMETERS.iter().any(|row| is_called(row, key) && matches!(row.kind, Kind::Text { .. }))
}

/// Whether a value is a number without a unit, or ends with one after `=`.
fn ends_in_number(text: &str) -> bool {
    text.rsplit('=').next().is_some_and(|number| number.parse::<f64>().is_ok())
}

/// A number that is allowed.
fn number<T: std::str::FromStr>(
    word: &Word,
    allowed: &str,
    may_be: impl Fn(&T) -> bool,
) -> Result<T, ScriptFault> {
    let refused = || ScriptFault::new(word.column, format!("\"{}\" is not {allowed}", quote(&word.text)));
    word.text.parse().ok().filter(may_be).ok_or_else(refused)
}

pub(super) fn unknown(word: &Word, what: &str, known: &[&str]) -> ScriptFault {
    let meant = closest(&word.text, known.iter().copied());
    let hint = meant.map_or_else(String::new, |meant| format!("; did you mean {meant}?"));
    let allowed = if known.len() <= 12 { format!(": it is {}", known.join(", ")) } else { String::new() };
    ScriptFault::new(word.column, format!("no {what} is called \"{}\"{allowed}{hint}", quote(&word.text)))
}

/// A number of commands.
pub(in crate::explorer) fn travelled(rest: &mut Rest<'_>, id: Id) -> Result<Command, ScriptFault> {
    Ok(Command::Travel { id, count: rest.count("a number", MOST_STEPS)? })
}

/// Where the walker goes: A, an event, or a contact radius.
pub(in crate::explorer) fn destination(rest: &mut Rest<'_>) -> Result<Command, ScriptFault> {
    if rest.takes("A") {
        return Ok(Id::MoveTo.into());
    }
    if rest.takes("event") {
        return Ok(Command::SelectEvent(rest.count("the number of an event", MOST_STEPS)?));
    }
    let word = rest.need("a contact radius")?;
    let is_radius = word.text == "B" || parse_quantity(&word.text).is_ok_and(|radius| radius.number > 0.0);
    is_radius.then(|| Command::MoveTo(word.text.clone())).ok_or_else(|| {
        let allowed = "a contact radius: a positive number, which may have a unit in an SI preset";
        ScriptFault::new(word.column, format!("\"{}\" is not {allowed}", quote(&word.text)))
    })
}

pub(in crate::explorer) fn assigned(rest: &mut Rest<'_>) -> Result<Command, ScriptFault> {
    let all = rest.assignments(short)?;
    if all.is_empty() {
        rest.need("KEY=VALUE")?;
    }
    Ok(Command::Assign(all))
}

pub(in crate::explorer) fn place(rest: &mut Rest<'_>) -> Result<Command, ScriptFault> {
    rest.one("place", Home::named, &Home::ALL.map(Home::name)).map(Command::Go)
}

pub(in crate::explorer) fn view(rest: &mut Rest<'_>) -> Result<Command, ScriptFault> {
    rest.one("view", View::named, &View::ALL.map(View::name)).map(Command::Show)
}

pub(in crate::explorer) fn quantity(rest: &mut Rest<'_>) -> Result<Command, ScriptFault> {
    let word = rest.need("a quantity")?;
    let column = QuantityColumn::named(&word.text).map_err(|what| ScriptFault::new(word.column, what))?;
    Ok(Command::Study { column, over: rest.next().map(|key| key.text.clone()) })
}

pub(in crate::explorer) fn theory(rest: &mut Rest<'_>) -> Result<Command, ScriptFault> {
    rest.one("theory", Overlay::named, &Overlay::ALL.map(Overlay::name)).map(Command::Overlay)
}

pub(in crate::explorer) fn axes(rest: &mut Rest<'_>) -> Result<Command, ScriptFault> {
    // The preset that is open knows the short names.
    let x = rest.need("a key")?.text.clone().into();
    Ok(Command::Map { x, y: rest.next().map(|word| word.text.clone().into()) })
}

pub(in crate::explorer) fn pin(rest: &mut Rest<'_>) -> Result<Command, ScriptFault> {
    if rest.takes("all") {
        return Ok(Command::Unpin(None));
    }
    rest.one("pin", pins::number_called, &pins::LETTERS).map(|number| Command::Unpin(Some(number)))
}

pub(in crate::explorer) fn preset(rest: &mut Rest<'_>) -> Result<Command, ScriptFault> {
    let name = rest.need("a preset")?.text.clone();
    let assignments = rest.assignments(known)?;
    Ok(if assignments.is_empty() { Command::Open(name) } else { Command::OpenWith { name, assignments } })
}

/// A word, or a name of one's own to save under.
pub(in crate::explorer) fn saved(rest: &mut Rest<'_>) -> Result<Command, ScriptFault> {
    if rest.words.first().is_some_and(|word| word.text != "replace") {
        return saved_as(rest);
    }
    rest.one("word", |word| (word == "replace").then_some(Command::SaveAnyway), &["replace"])
}

pub(in crate::explorer) fn saved_as(rest: &mut Rest<'_>) -> Result<Command, ScriptFault> {
    let name = rest.need("a name")?.text.clone();
    let with_data = rest.takes("with-data");
    Ok(Command::SaveAs { name, with_data, replace: rest.takes("replace") })
}

/// What is exported, and its file; for a figure also which view.
pub(in crate::explorer) fn exported(rest: &mut Rest<'_>) -> Result<Command, ScriptFault> {
    let word = rest.need("a document")?;
    let mut all = Export::ALL.into_iter();
    let Some(mut what) = all.find(|what| what.name() == word.text) else {
        return Err(unknown(word, "document", &Export::ALL.each_ref().map(Export::name)));
    };
    let file = rest.need("a file")?;
    if !ends_in(&file.text, what.endings()) {
        let text = format!("the file must end in .{}", what.endings().join(" or ."));
        return Err(ScriptFault::new(file.column, text));
    }
    if let Export::Figure(view) = &mut what {
        *view = rest.words.first().and_then(|word| View::named(&word.text));
        if view.is_some() {
            rest.next();
        }
    }
    Ok(Command::Export { what, path: file.text.clone(), replace: rest.takes("replace") })
}

/// Reads a key in a column.
type ReadKey = fn(&str, usize) -> Result<Key, ScriptFault>;

fn assignment(word: &Word, read: ReadKey) -> Result<Assignment, ScriptFault> {
    let Some((key, text)) = word.text.split_once('=') else {
        let what = format!(
            "\"{}\" is not KEY=VALUE, as in gap.amplitude=0.002; put a value with spaces in quotes",
            quote(&word.text)
        );
        return Err(ScriptFault::new(word.column, what));
    };
    Ok((read(key, word.column)?, text.to_owned()))
}
