//! The single list behind a typed line: commands, charts, quantities, presets, files and keys, filtered by the text.

use super::offers::{FolderNames, Offer, Typing};
use super::parse::parse;
use crate::explorer::command::Id;
use crate::explorer::model::Model;
use crate::explorer::table::{CommandRow, ROWS, called};
use pulloff_engine::preset::Parameter;
use pulloff_engine::preset::called::rows_called;

/// One line of the list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PaletteEntry {
    /// What one would type for it.
    pub line: String,
    /// What it does, or why it cannot be done now.
    pub says: String,
    /// The command, if it is a single one.
    pub id: Option<Id>,
    /// Whether nothing more needs to be typed.
    pub is_whole: bool,
}

impl PaletteEntry {
    fn new(line: String, says: impl Into<String>) -> Self {
        let is_whole = !line.ends_with(['=', '/']) && parse(&line).is_ok();
        Self { line, says: says.into(), id: None, is_whole }
    }

    fn command(row: &CommandRow, model: &Model) -> Self {
        let says = (row.needs)(model).map_or_else(|why| format!("- {why}"), |()| row.help.to_owned());
        Self { id: Some(row.id), ..Self::new(row.name.to_owned(), says) }
    }

    fn offer(before: &str, offer: &Offer) -> Self {
        Self::new(format!("{before}{}", offer.word), offer.says.trim())
    }
}

/// What `line` could become. With no text: all commands, those of `first` before the others. After the name of a
/// command: what it takes. Otherwise the command `keyed`, whose key the text is, and then everything that has all words
/// of the text, the best match first.
pub fn palette(
    line: &str,
    first: &[Id],
    keyed: Option<Id>,
    model: &Model,
    files: FolderNames<'_>,
) -> Vec<PaletteEntry> {
    let start = line.rfind([' ', '\t']).map_or(0, |at| at + 1);
    let (before, word) = line.split_at(start);
    let words: Vec<&str> = before.split_whitespace().collect();
    // Inside quotes anything may be meant.
    if line.matches('"').count() % 2 == 1 {
        return Vec::new();
    }
    let Some((name, words)) = words.split_first() else {
        return if word.is_empty() { commands(first, model) } else { anything(word, keyed, model, files) };
    };
    let Some(row) = called(name) else { return anything(line.trim(), keyed, model, files) };
    // After a word that is complete, nothing more follows.
    if !words.is_empty() && !row.takes.goes_on {
        return Vec::new();
    }
    let offers = (row.takes.offers)(&Typing { model, words, word, files });
    let entries = offers.iter().map(|offer| PaletteEntry::offer(before, offer));
    let compared = |entry: &PaletteEntry| {
        rank(&[entry.line[start..].to_lowercase(), entry.says.to_lowercase(), String::new()], word)
    };
    // What has the word only in its description may not be what was meant: it is typed for a look first.
    let offered = |(rank, entry): (u8, PaletteEntry)| PaletteEntry {
        is_whole: entry.is_whole && rank < DESCRIBED,
        ..entry
    };
    ranked(entries, compared).into_iter().map(offered).collect()
}

/// All commands, those of `first` before the others.
fn commands(first: &[Id], model: &Model) -> Vec<PaletteEntry> {
    let of_pane = first.iter().filter_map(|id| ROWS.iter().find(|row| row.id == *id));
    let others = ROWS.iter().filter(|row| !first.contains(&row.id));
    of_pane.chain(others).map(|row| PaletteEntry::command(row, model)).collect()
}

/// Everything that has all words of `text`, or else as many as possible; nothing for a text longer than any search.
fn anything(text: &str, keyed: Option<Id>, model: &Model, files: FolderNames<'_>) -> Vec<PaletteEntry> {
    /// The longest text, in bytes, and the most words: the list is made again for every letter, also for those of a
    /// text that was pasted by mistake.
    const LONGEST: usize = 255;
    const MOST: usize = 12;
    let wanted: Vec<&str> = text.split_whitespace().collect();
    if text.len() > LONGEST || wanted.len() > MOST {
        return Vec::new();
    }
    let last = wanted.last().copied().unwrap_or_default();
    let offered = ROWS.iter().flat_map(|row| {
        let before = format!("{} ", row.name);
        let offers = (row.takes.offers)(&Typing { model, words: &[], word: last, files });
        offers.into_iter().map(move |offer| PaletteEntry::offer(&before, &offer))
    });
    let keyed = ROWS.iter().filter(|row| Some(row.id) == keyed).map(|row| PaletteEntry::command(row, model));
    let mut found: Vec<PaletteEntry> =
        keyed.chain(of_key(&wanted, model)).chain(of_event(&wanted, model)).collect();
    let all = ROWS.iter().map(|row| PaletteEntry::command(row, model)).chain(offered);
    // How many words each entry lacks, and how well it matches the others.
    let compared = |entry: &PaletteEntry| {
        let known =
            called(&entry.line).map_or_else(String::new, |row| format!("{} {}", row.short, row.words));
        let texts = [&entry.line, &entry.says, &known].map(|text| text.to_lowercase());
        let ranks: Vec<u8> = wanted.iter().filter_map(|word| rank(&texts, word)).collect();
        let (lacks, worst) = (wanted.len() - ranks.len(), ranks.into_iter().max()?);
        // A word within another one of a description means little where the others are not found.
        (lacks == 0 || worst < WITHIN).then_some((lacks, worst))
    };
    let others = ranked(all.filter(|entry| found.iter().all(|key| key.line != entry.line)), compared);
    // If nothing has all words, take what has most of them.
    let least = if found.is_empty() { others.first().map_or(0, |((lacks, _), _)| *lacks) } else { 0 };
    let best = others.into_iter().take_while(|((lacks, _), _)| *lacks <= least);
    // What lacks a word may not be what was meant: it is typed for a look first.
    let offered = |((lacks, _), entry): ((usize, u8), PaletteEntry)| PaletteEntry {
        is_whole: entry.is_whole && lacks == 0,
        ..entry
    };
    found.extend(best.map(offered));
    found
}

/// A value for a key given by its symbol or the end of its name: `A 0.003`, `amplitude=0.003`.
fn of_key(wanted: &[&str], model: &Model) -> Vec<PaletteEntry> {
    let (symbol, value) = match wanted {
        [symbol, value] => (*symbol, *value),
        [one] => one.split_once('=').unwrap_or((one, "")),
        _ => return Vec::new(),
    };
    let entry = |row: &Parameter| PaletteEntry::new(format!("set {}={value}", row.key), &*row.meaning);
    // The units of the screen are named like what they show, and are meant less often.
    let is_meant = |row: &&Parameter| !value.is_empty() || !row.key.starts_with("display.");
    let rows = rows_called(&model.preset, symbol);
    rows.iter().filter(is_meant).map(entry).collect()
}

/// An event by its number: `event 3`, `snap 3`.
fn of_event(wanted: &[&str], model: &Model) -> Option<PaletteEntry> {
    let [word, number] = wanted else { return None };
    let number = number.parse::<usize>().ok()?;
    let event = model.path_events().iter().find(|event| event.number == number)?;
    let kind = event.kind.replace('-', " ");
    let is_meant = *word == "event" || kind.split(' ').any(|part| part == *word);
    is_meant.then(|| PaletteEntry::new(format!("move-to event {number}"), format!("the {kind}")))
}

/// The entries that have a rank, with it, the best first; equal ranks keep their order.
fn ranked<R: Ord + Copy>(
    entries: impl Iterator<Item = PaletteEntry>,
    rank: impl Fn(&PaletteEntry) -> Option<R>,
) -> Vec<(R, PaletteEntry)> {
    let mut found: Vec<_> = entries.filter_map(|entry| rank(&entry).map(|rank| (rank, entry))).collect();
    found.sort_by_key(|(rank, _)| *rank);
    found
}

/// The rank of a word with which one of the description begins.
const DESCRIBED: u8 = 4;

/// The rank of a word that is only found within another one of the description.
const WITHIN: u8 = 5;

/// How well a line, its description and its synonyms, all in lower case, match a word: 0 is best; `None` if they do not
/// contain it.
fn rank([line, says, words]: &[String; 3], word: &str) -> Option<u8> {
    let word = &*word.to_lowercase();
    let has =
        |text: &str, is_it: &dyn Fn(&str) -> bool| text.split(|c: char| !c.is_alphanumeric()).any(is_it);
    let begins = |text: &str| has(text, &|part| part.starts_with(word));
    let is_in = |text: &str| has(text, &|part| part == word);
    if line == word {
        Some(0)
    } else if line.starts_with(word) || is_in(line) || is_in(words) {
        Some(1)
    } else if begins(line) || begins(words) {
        Some(2)
    } else if line.contains(word) {
        Some(3)
    } else if begins(says) {
        Some(DESCRIBED)
    } else {
        says.contains(word).then_some(WITHIN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::{Loaded, Source, read, shipped};

    fn found(line: &str) -> Vec<PaletteEntry> {
        let text = shipped::find("wavy-sphere").unwrap();
        let preset = read("t", text.text).unwrap();
        let loaded = Loaded { source: Source::Shipped(text), preset, text: String::new(), fingerprint: None };
        let mut model = Model::new(loaded);
        model.preset_names =
            ["lab-3", "lab-4"].map(|name| [name.to_owned(), "rubber on glass".to_owned()]).to_vec();
        let files = |folder: &str| match folder {
            "" => ["mine.csv", "more.txt", "curves/", "a b.csv"].map(str::to_owned).to_vec(),
            "curves/" => vec!["curves/first.csv".to_owned()],
            _ => Vec::new(),
        };
        palette(line, &[Id::Pin], None, &model, &files)
    }

    #[test]
    fn what_is_typed_finds_commands_keys_values_presets_and_documents() {
        for (line, first, is_whole) in [
            ("ste", "step", true),
            ("step-", "step-length", false),
            ("wq", "quit", true),
            ("compare", "pin", true),
            ("figure", "export", true),
            ("export fig", "export figure", false),
            ("potential", "view energy", true),
            ("largest", "move-to", true),
            ("smooth", "overlays smooth", true),
            ("lab-4", "open lab-4", true),
            ("glass", "open lab-3", true),
            ("mine", "data mine.csv", true),
            ("svg", "export", true),
            ("export figure ", "export figure wavy-sphere-force-approach.svg", true),
            ("export events ", "export events wavy-sphere-events.csv", true),
            ("resume", "quit", true),
            ("curves/fi", "data curves/first.csv", true),
            ("A 0.003", "set gap.amplitude=0.003", true),
            ("A=0.003", "set gap.amplitude=0.003", true),
            ("γ 0.004", "set material.work_of_adhesion=0.004", true),
            ("wavelength", "set gap.wavelength=", false),
            ("spring", "control stiffness=", false),
            ("dead load", "control force", true),
            ("half step", "halve-step", true),
            ("own formula", "set gap.formula=", false),
            ("set gap.am", "set gap.amplitude=", false),
            ("set gap.amplitude=1 path.contr", "set gap.amplitude=1 path.control=", false),
            ("set gap.shape=po", "set gap.shape=power-law", true),
            ("set amplitude", "set gap.amplitude=", false),
            ("open lab-3 basis.k", "open lab-3 basis.kind=", false),
            ("map gap.amplitude fo", "map gap.amplitude force", true),
            ("export figure x.svg con", "export figure x.svg contact", true),
            ("control f", "control force", true),
            ("study gamma", "study critical_force", false),
            ("data mi", "data mine.csv", true),
            ("data cu", "data curves/", false),
        ] {
            let found = found(line);
            let entry = found.first().map(|entry| (&*entry.line, entry.is_whole));
            assert_eq!(entry, Some((first, is_whole)), "{line}: {found:?}");
        }
        // One letter is that of a pin, not the beginning of `all`.
        for line in ["zzz", "theme light", "set title=\"a ", "quit 3", "pins A", "pins L"] {
            assert_eq!(found(line), [], "{line}");
        }
        // Text that nobody searches for costs nothing.
        assert!(!found(&"largest ".repeat(12)).is_empty());
        assert_eq!(found(&"largest ".repeat(13)), []);
    }

    #[test]
    fn the_command_of_a_key_stands_first() {
        let text = shipped::find("wavy-sphere").unwrap();
        let preset = read("t", text.text).unwrap();
        let loaded = Loaded { source: Source::Shipped(text), preset, text: String::new(), fingerprint: None };
        let found = palette("L", &[], Some(Id::MoveTo), &Model::new(loaded), &|_| Vec::new());
        assert_eq!(found[0].id, Some(Id::MoveTo));
        assert_eq!(found.iter().filter(|entry| entry.id == Some(Id::MoveTo)).count(), 1);
    }

    #[test]
    fn without_text_all_commands_are_listed_once_and_say_why_not_now() {
        let all = found("");
        assert_eq!((all.len(), &*all[0].line), (ROWS.len(), "pin"));
        let jump = all.iter().find(|entry| entry.id == Some(Id::Jump)).unwrap();
        assert!(jump.says.starts_with("- "), "{}", jump.says);
    }
}
