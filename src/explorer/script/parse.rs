//! Words → a command.

use super::fault::Fault;
use super::lexer::{Word, split};
use super::print::overlay_name;
use crate::explorer::command::{Assignment, Command, Id, LENGTHS, MOST_STEPS, ROWS, row_of};
use crate::explorer::export::{ExportKind, Picture, ends_in};
use crate::explorer::maps::CURVES;
use crate::explorer::pins;
use crate::explorer::view::{Home, Overlay, View};
use pulloff_engine::preset::data;
use pulloff_engine::preset::groups::{self, GROUPS};
use pulloff_engine::preset::{Key, PARAMETERS, parameter};
use pulloff_engine::stability::COMPLIANCE;
use pulloff_engine::sweep::Column;
use pulloff_engine::text::{closest, closest_key, quote};

/// The word before a command that may fail.
const TRY: &str = "try";
/// What is drawn rather than written.
pub(super) const PICTURES: [Picture; 2] = [Picture::Figure(None), Picture::Screen];
/// What a synonym of `next-event` runs to.
pub(super) const RUN_TO: (&str, [&str; 2]) = ("run-to", ["instability", "limit"]);

/// The command of a line; `None` where there is none.
pub fn parse(line: &str) -> Result<Option<Command>, Fault> {
    let words = split(line)?;
    let Some((name, rest)) = words.split_first() else { return Ok(None) };
    command(name, Rest { words: rest, end: line.trim_end().chars().count() + 2 }).map(Some)
}

/// The command of a script's line and whether it may fail.
pub(super) fn script_line(line: &str) -> Result<Option<(bool, Command)>, Fault> {
    let words = split(line)?;
    let may_fail = words.first().is_some_and(|word| word.text == TRY);
    let Some((name, rest)) = words[usize::from(may_fail)..].split_first() else {
        return if may_fail { Err(Fault::new(1, "try stands before a command")) } else { Ok(None) };
    };
    let command = command(name, Rest { words: rest, end: line.trim_end().chars().count() + 2 })?;
    match for_script(&command) {
        Ok(()) => Ok(Some((may_fail, command))),
        Err(what) => Err(Fault::new(name.column, what)),
    }
}

/// Whether a command means something without a screen.
pub fn for_script(command: &Command) -> Result<(), String> {
    let row = row_of(command.id());
    let missing = |what: &str| Err(format!("{} needs {what}", row.name));
    match command {
        Command::Plain(Id::Open) => missing("a preset"),
        Command::Plain(Id::Data) => missing("a file, or none"),
        Command::Plain(Id::SaveAs) => missing("a name"),
        Command::Plain(Id::Export) => missing("a document and a file"),
        Command::Plain(Id::Branches) => missing("the reduced approach, force and contact radius of a state"),
        Command::Plain(Id::Pins) => missing("the number of a pin, or all"),
        Command::Plain(
            Id::FineLess | Id::FineMore | Id::Less | Id::More | Id::MuchLess | Id::MuchMore | Id::Edit,
        ) => Err(format!("{} needs a selection on the screen; a script says set KEY=VALUE", row.name)),
        Command::Plain(Id::Free) => {
            Err(format!("{} needs a selection on the screen; a script says set data.free=KEY,...", row.name))
        }
        command if is_of_screen(command.id()) => {
            Err(format!("{} only changes what a screen shows", row.name))
        }
        _ => Ok(()),
    }
}

/// Whether a command only changes what a screen shows.
fn is_of_screen(id: Id) -> bool {
    matches!(
        id,
        Id::Up
            | Id::Down
            | Id::Left
            | Id::Right
            | Id::Slower
            | Id::Faster
            | Id::NextPanel
            | Id::PreviousPanel
            | Id::Enlarge
            | Id::NextView
            | Id::PreviousView
            | Id::Go
            | Id::ChooseView
            | Id::Study
            | Id::Rings
            | Id::ZoomIn
            | Id::ZoomOut
            | Id::Whole
            | Id::CrossHair
            | Id::Map
            | Id::Axes
            | Id::Device
            | Id::Overlays
            | Id::CommandLine
            | Id::Copy
            | Id::Mouse
            | Id::About
            | Id::Help
            | Id::Cancel
    )
}

/// What stands behind the name of a command.
struct Rest<'a> {
    words: &'a [Word],
    /// The column where a missing word would stand.
    end: usize,
}

impl<'a> Rest<'a> {
    fn next(&mut self) -> Option<&'a Word> {
        let (first, rest) = self.words.split_first()?;
        self.words = rest;
        Some(first)
    }

    fn need(&mut self, what: &str) -> Result<&'a Word, Fault> {
        let end = self.end;
        self.next().ok_or_else(|| Fault::new(end, format!("{what} is missing")))
    }

    /// Takes the next word if it is this one.
    fn takes(&mut self, word: &str) -> bool {
        let is_next = self.words.first().is_some_and(|next| next.text == word);
        if is_next {
            self.words = &self.words[1..];
        }
        is_next
    }

    /// A picture, and nothing behind it but that a file may be replaced.
    fn picture(mut self, picture: Picture, path: String) -> Result<Command, Fault> {
        let replace = self.takes("replace");
        if let (Picture::Figure(None), Some(word)) = (picture, self.words.first()) {
            return Err(unknown(word, "view", &View::ALL.map(View::name)));
        }
        self.done(Command::Picture { picture, path, replace })
    }

    /// Nothing more may stand there.
    fn done(self, command: Command) -> Result<Command, Fault> {
        match self.words.first() {
            None => Ok(command),
            Some(word) => {
                let name = row_of(command.id()).name;
                Err(Fault::new(word.column, format!("{name} takes no \"{}\" here", quote(&word.text))))
            }
        }
    }
}

fn unknown(word: &Word, what: &str, known: &[&str]) -> Fault {
    let meant = closest(&word.text, known.iter().copied());
    let hint = meant.map_or_else(String::new, |meant| format!("; did you mean {meant}?"));
    let allowed = if known.len() <= 12 { format!(": it is {}", known.join(", ")) } else { String::new() };
    Fault::new(word.column, format!("no {what} is called \"{}\"{allowed}{hint}", quote(&word.text)))
}

fn command(name: &Word, mut rest: Rest<'_>) -> Result<Command, Fault> {
    if name.text == RUN_TO.0 {
        let word = rest.need("instability")?;
        if !RUN_TO.1.contains(&&*word.text) {
            return Err(unknown(word, "such end of a run", &RUN_TO.1));
        }
        return rest.done(Id::Run.into());
    }
    if name.text == TRY {
        return Err(Fault::new(name.column, "try stands in a script, once, before a command"));
    }
    let Some(row) = ROWS.iter().find(|row| row.name == name.text) else {
        let names: Vec<&str> = ROWS.iter().map(|row| row.name).chain([RUN_TO.0, TRY]).collect();
        return Err(unknown(name, "command", &names));
    };
    let bare = rest.words.is_empty();
    let command = match row.id {
        Id::Step if !bare => Command::Steps(count(rest.need("a number of steps")?, MOST_STEPS)?),
        Id::Run if !bare => Command::RunOf(count(rest.need("a number of states")?, MOST_STEPS)?),
        Id::Undo | Id::Redo if !bare => {
            let count = count(rest.need("a number")?, MOST_STEPS)?;
            Command::Travel { id: row.id, count, states: rest.takes("states") }
        }
        Id::StepLength => Command::StepLength(length(rest.need("a length")?)?),
        Id::SelectEvent => Command::SelectEvent(count(rest.need("the number of an event")?, MOST_STEPS)?),
        Id::Branches if !bare => {
            let mut number = |what| finite(rest.need(what)?);
            let state = [number("an approach")?, number("a force")?, number("a contact radius")?];
            Command::GoToState(state)
        }
        Id::MoveTo => Command::MoveTo(radius(rest.need("a contact radius")?)?),
        Id::Assign => {
            let first = assignment(rest.need("KEY=VALUE")?)?;
            Command::Assign(assignments(vec![first], &mut rest)?)
        }
        Id::Control if !bare => {
            let word = rest.need("a control")?;
            Command::Assign(vec![("path.control".into(), word.text.clone())])
        }
        Id::Data if !bare => {
            let word = rest.need("a file")?;
            Command::Assign(vec![(data::FILE.into(), word.text.clone())])
        }
        Id::Go if !bare => {
            let word = rest.need("a place")?;
            let names = Home::ALL.map(Home::name);
            Command::Go(Home::named(&word.text).ok_or_else(|| unknown(word, "place", &names))?)
        }
        Id::ChooseView if !bare => {
            let word = rest.need("a view")?;
            let names = View::ALL.map(View::name);
            Command::Show(View::named(&word.text).ok_or_else(|| unknown(word, "view", &names))?)
        }
        Id::Study if !bare => {
            let word = rest.need("a quantity")?;
            Command::Study(Column::named(&word.text).map_err(|what| Fault::new(word.column, what))?)
        }
        Id::Overlays if !bare => {
            let word = rest.need("a theory")?;
            let found = Overlay::ALL.into_iter().find(|overlay| overlay_name(*overlay) == word.text);
            let names = Overlay::ALL.map(overlay_name);
            Command::Overlay(found.ok_or_else(|| unknown(word, "theory", &names))?)
        }
        Id::Map if !bare => {
            let x = axis(rest.need("a key")?, &[])?;
            let y = rest.next().map(|word| axis(word, &CURVES.map(|(name, _)| name))).transpose()?;
            Command::Map { x, y }
        }
        Id::Pins if !bare => {
            let word = rest.need("a number")?;
            Command::Unpin(if word.text == "all" { None } else { Some(count(word, pins::MOST)?) })
        }
        Id::Open if !bare => {
            let name = rest.need("a preset")?.text.clone();
            match assignments(Vec::new(), &mut rest)? {
                none if none.is_empty() => Command::Open(name),
                assignments => Command::OpenWith { name, assignments },
            }
        }
        Id::Save if rest.takes("replace") => Command::SaveAnyway,
        Id::SaveAs if !bare => {
            let name = rest.need("a name")?.text.clone();
            let with_data = rest.takes("with-data");
            Command::SaveAs { name, with_data, replace: rest.takes("replace") }
        }
        Id::Export if !bare => return export(rest),
        id => id.into(),
    };
    rest.done(command)
}

/// An export of a document or of a picture.
fn export(mut rest: Rest<'_>) -> Result<Command, Fault> {
    let word = rest.need("a document")?;
    if let Some(picture) = PICTURES.into_iter().find(|picture| picture.name() == word.text) {
        let path = file(&mut rest, picture.endings())?;
        let view = rest.words.first().and_then(|word| View::named(&word.text));
        let picture = match picture {
            Picture::Figure(_) if view.is_some() => {
                rest.next();
                Picture::Figure(view)
            }
            picture => picture,
        };
        return rest.picture(picture, path);
    }
    let names = ExportKind::ALL.map(ExportKind::name).into_iter().chain(PICTURES.map(Picture::name));
    let names: Vec<&str> = names.collect();
    let what = ExportKind::ALL.into_iter().find(|what| what.name() == word.text);
    let what = what.ok_or_else(|| unknown(word, "document", &names))?;
    let path = file(&mut rest, what.endings())?;
    let command = Command::Export { what, path, replace: rest.takes("replace") };
    rest.done(command)
}

/// The file of an export.
fn file(rest: &mut Rest<'_>, endings: &[&str]) -> Result<String, Fault> {
    let file = rest.need("a file")?;
    if ends_in(&file.text, endings) {
        return Ok(file.text.clone());
    }
    Err(Fault::new(file.column, format!("the file must end in .{}", endings.join(" or ."))))
}

fn count(word: &Word, most: usize) -> Result<usize, Fault> {
    let found = word.text.parse().ok().filter(|count| (1..=most).contains(count));
    found.ok_or_else(|| {
        Fault::new(word.column, format!("\"{}\" is no number from 1 to {most}", quote(&word.text)))
    })
}

fn finite(word: &Word) -> Result<f64, Fault> {
    let found = word.text.parse().ok().filter(|x: &f64| x.is_finite());
    found.ok_or_else(|| Fault::new(word.column, format!("\"{}\" is no finite number", quote(&word.text))))
}

fn radius(word: &Word) -> Result<f64, Fault> {
    let found = word.text.parse().ok().filter(|radius: &f64| radius.is_finite() && *radius > 0.0);
    found.ok_or_else(|| {
        let quoted = quote(&word.text);
        Fault::new(
            word.column,
            format!("\"{quoted}\" is no contact radius: a positive number in the preset's units"),
        )
    })
}

fn length(word: &Word) -> Result<f64, Fault> {
    let found = word.text.parse().ok().filter(|length| LENGTHS.contains(length));
    found.ok_or_else(|| {
        let (least, most) = (LENGTHS.start(), LENGTHS.end());
        Fault::new(word.column, format!("\"{}\" is no length from {least:?} to {most:?}", quote(&word.text)))
    })
}

fn assignments(mut all: Vec<Assignment>, rest: &mut Rest<'_>) -> Result<Vec<Assignment>, Fault> {
    while let Some(word) = rest.next() {
        all.push(assignment(word)?);
    }
    Ok(all)
}

fn assignment(word: &Word) -> Result<Assignment, Fault> {
    let Some((key, text)) = word.text.split_once('=') else {
        let what = format!(
            "\"{}\" is no KEY=VALUE, as in gap.amplitude=0.002; a value with spaces stands in quotes",
            quote(&word.text)
        );
        return Err(Fault::new(word.column, what));
    };
    Ok((known(key, word.column)?, text.to_owned()))
}

/// A key or a group.
fn known(key: &str, column: usize) -> Result<Key, Fault> {
    if parameter(key).is_none() && groups::row(key).is_none() {
        let known = PARAMETERS.iter().chain(&GROUPS).map(|row| (&*row.key, &*row.label));
        let meant = closest_key(key, known);
        let hint = meant.map_or_else(String::new, |meant| format!("; did you mean {meant}?"));
        return Err(Fault::new(column, format!("unknown key {}{hint}", quote(key))));
    }
    Ok(key.to_owned().into())
}

/// What stands on an axis of a map: a key, a group, the compliance, or one of these words.
fn axis(word: &Word, words: &[&str]) -> Result<Key, Fault> {
    if word.text == COMPLIANCE || words.contains(&&*word.text) {
        return Ok(word.text.clone().into());
    }
    known(&word.text, word.column)
}
