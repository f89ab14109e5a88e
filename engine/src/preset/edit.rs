//! A preset laid over the text it was read from: what a user wrote around the values stays as it is.
//!
//! The text is not written anew. Each changed value is replaced in place, a key that the preset no longer has is
//! removed with its line, and a key that the text does not have is added at the end of its table. Not a byte else
//! changes, so comments, order, blank lines, dotted keys and inline tables stay. A comment after a removed key stays on
//! a line of its own, unless it is the one that the program itself writes there.
//!
//! What a text means can depend on what it leaves out: a start that is left out follows the radius of curvature. The
//! result is therefore read back, and any key that came back different is written out.

use super::data;
use super::family::{self, PARAMETER_KEYS, is_parameter};
use super::model::Preset;
use super::read::{HeldFiles, read_holding, read_in};
use super::rows::parameter;
use super::schema::Key;
use super::shape::is_range;
use super::value::Value as Number;
use super::write::{COMMENTS, FOLLOWING, comment, following, head, line, toml, toml_of_parameter};
use crate::problem::Control;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;
use toml_edit::{Array, Document, InlineTable, Item, Table, Value};

/// `text` edited so that it is `preset`; `None` if `text` is not a preset, or cannot be edited to that effect. A file
/// in it is relative to `folder`.
pub fn onto(folder: Option<&Path>, text: &str, preset: &Preset) -> Option<String> {
    let held = |text: &str| read_holding(preset.files, "", text, HeldFiles::by(preset)).ok();
    // A text with another profile is read with its own rows.
    let before = held(text).or_else(|| read_in(preset.files, folder, "", text, &[] as &[&str]).ok());
    let layout = TextLayout::of(text)?;
    let mut forced = Forced::Keys(BTreeSet::new());
    loop {
        let edited = layout.edited(before.as_ref(), preset, &forced)?;
        let back = held(&edited);
        if back.as_ref() == Some(preset) {
            return Some(edited);
        }
        forced = match (forced, back) {
            (Forced::All, _) => return None,
            (Forced::Keys(keys), Some(back)) => {
                let differs = |row: &super::schema::Row| back.get(&row.key) != preset.get(&row.key);
                let more: BTreeSet<Key> =
                    preset.rows().filter(differs).map(|row| row.key.clone()).chain(keys.clone()).collect();
                if more == keys { Forced::All } else { Forced::Keys(more) }
            }
            (Forced::Keys(_), None) => Forced::All,
        };
    }
}

/// Which keys are written out even if the text seems to give their value.
enum Forced {
    Keys(BTreeSet<Key>),
    All,
}

impl Forced {
    fn has(&self, key: &str) -> bool {
        match self {
            Self::Keys(keys) => keys.contains(key),
            Self::All => true,
        }
    }
}

/// A key as a path; waves are counted from 1, as in dotted keys.
type Route = Vec<String>;

fn route(key: &str) -> Route {
    key.split('.').map(str::to_owned).collect()
}

/// A value of the text.
struct Leaf {
    route: Route,
    /// Where its line begins, and where the value on the line is.
    start: usize,
    value: Range<usize>,
    /// Its place within that value; empty if it is the whole value.
    inner: Route,
    /// Its text, if it is a string.
    string: Option<String>,
    /// The table that contains it.
    section: usize,
}

/// A table with a header, or the top of the text.
struct TextSection {
    route: Route,
    /// Its header; the top has none.
    header: Option<Range<usize>>,
    /// Where its last value ends, or its header if it has none.
    end: usize,
}

/// Where the keys of a table are.
enum Holder {
    /// Below a header, or at the top.
    Section(usize),
    /// In lines of a section that begin with this prefix.
    Dotted(usize, String),
    /// In a value, at this place within it.
    Inline(Range<usize>, Route),
    /// Only in tables below it.
    Implied,
}

/// What is where in the text.
struct TextLayout<'a> {
    text: &'a str,
    leaves: Vec<Leaf>,
    sections: Vec<TextSection>,
    holders: BTreeMap<Route, Holder>,
}

/// A value that the text is to have.
struct WantedValue {
    route: Route,
    /// The key whose value it is, which shows whether it changed.
    key: Key,
    value: String,
    /// The comment that follows it where it is added.
    comment: String,
}

impl<'a> TextLayout<'a> {
    fn of(text: &'a str) -> Option<Self> {
        let document = Document::parse(text).ok()?;
        let top = TextSection { route: Route::new(), header: None, end: 0 };
        let mut layout = Self { text, leaves: Vec::new(), sections: vec![top], holders: BTreeMap::new() };
        layout.holders.insert(Vec::new(), Holder::Section(0));
        layout.table(&Vec::new(), document.as_table(), 0, "");
        Some(layout)
    }

    /// Records the keys of a table; for a dotted one, with the prefix of its lines.
    fn table(&mut self, above: &Route, table: &Table, section: usize, dotted: &str) {
        for (name, item) in table {
            let Some(key) = table.key(name) else { continue };
            let route = [above.as_slice(), &[name.to_owned()]].concat();
            match item {
                Item::None => {}
                Item::Value(value) => {
                    let (Some(at), Some(span)) = (key.span(), value.span()) else { continue };
                    let own = &mut self.sections[section];
                    own.end = own.end.max(span.end);
                    self.value(&route, value, (at.start, &span), &Vec::new(), section);
                }
                Item::Table(inner) if inner.is_dotted() => {
                    let dotted = format!("{dotted}{}.", key.display_repr());
                    self.holders.insert(route.clone(), Holder::Dotted(section, dotted.clone()));
                    self.table(&route, inner, section, &dotted);
                }
                Item::Table(inner) if inner.is_implicit() => {
                    self.holders.insert(route.clone(), Holder::Implied);
                    self.table(&route, inner, section, "");
                }
                Item::Table(inner) => self.section(&route, inner),
                Item::ArrayOfTables(all) => {
                    self.holders.insert(route.clone(), Holder::Implied);
                    for (i, inner) in all.iter().enumerate() {
                        self.section(&[route.as_slice(), &[(i + 1).to_string()]].concat(), inner);
                    }
                }
            }
        }
    }

    fn section(&mut self, route: &Route, table: &Table) {
        let header = table.span();
        let end = header.as_ref().map_or(0, |header| header.end);
        self.sections.push(TextSection { route: route.clone(), header, end });
        let section = self.sections.len() - 1;
        self.holders.insert(route.clone(), Holder::Section(section));
        self.table(route, table, section, "");
    }

    /// Records what is in the value of a line.
    fn value(
        &mut self,
        route: &Route,
        value: &Value,
        line: (usize, &Range<usize>),
        inner: &Route,
        section: usize,
    ) {
        let below = |route: &Route, name: &str| [route.as_slice(), &[name.to_owned()]].concat();
        let holder = || Holder::Inline(line.1.clone(), inner.clone());
        match value {
            Value::InlineTable(table) => {
                self.holders.insert(route.clone(), holder());
                for (name, value) in table {
                    self.value(&below(route, name), value, line, &below(inner, name), section);
                }
            }
            Value::Array(all) if route.join(".") == family::WAVE_TABLE => {
                self.holders.insert(route.clone(), holder());
                for (i, value) in all.iter().enumerate() {
                    let number = (i + 1).to_string();
                    self.value(&below(route, &number), value, line, &below(inner, &number), section);
                }
            }
            scalar => self.leaves.push(Leaf {
                route: route.clone(),
                start: line.0,
                value: line.1.clone(),
                inner: inner.clone(),
                string: scalar.as_str().map(str::to_owned),
                section,
            }),
        }
    }

    /// The values that the text is to have for `preset`, in the forms that it uses.
    fn wanted(&self, preset: &Preset) -> Vec<WantedValue> {
        let mut all = Vec::new();
        for row in preset.rows().filter(|row| !row.is_part() && !is_range(&row.key)) {
            let Some(value) = preset.get(&row.key) else { continue };
            let own = route(&row.key);
            let is_table = self.holders.contains_key(&own);
            let at = |name: &str| [own.as_slice(), &[name.to_owned()]].concat();
            let mut want = |route: Route, key: Key, value: String| {
                all.push(WantedValue { route, key, value, comment: comment(&row) });
            };
            if is_parameter(&row.key) && is_table {
                want(at("value"), row.key.clone(), toml(preset, &row, &value));
                for part in PARAMETER_KEYS {
                    let key = format!("{}.{part}", row.key);
                    if let Some(value) = preset.get(&key) {
                        want(at(part), key.into(), toml(preset, &row, &value));
                    }
                }
            } else if is_parameter(&row.key) {
                want(own.clone(), row.key.clone(), toml_of_parameter(preset, &row, &value));
            } else if let (true, Number::Control(Control::Stiffness(_))) = (is_table, &value) {
                let whole = toml(preset, &row, &value).parse::<Value>().ok();
                let stiffness = whole.as_ref().and_then(|whole| whole.as_inline_table()?.get("stiffness"));
                want(at("stiffness"), row.key.clone(), stiffness.map(printed).unwrap_or_default());
            } else {
                want(own.clone(), row.key.clone(), toml(preset, &row, &value));
            }
        }
        all
    }

    /// The text for `preset`, given that it was the text for `before`.
    fn edited(&self, before: Option<&Preset>, preset: &Preset, forced: &Forced) -> Option<String> {
        let wanted = self.wanted(preset);
        let same = |key: &str| before.is_some_and(|before| before.get(key) == preset.get(key));
        let mut edits = Edits::default();
        let (mut kept, mut gone) = (BTreeSet::new(), BTreeSet::new());
        // Values that the text holds as an inline table; they are replaced as a whole.
        let mut replaced: Vec<&Route> = Vec::new();
        for want in &wanted {
            let there = self.leaves.iter().find(|leaf| leaf.route == want.route);
            // A parameter that gains or loses a range is replaced as a whole.
            let parts = PARAMETER_KEYS.map(|part| format!("{}.{part}", want.key));
            let is_same = same(&want.key) && parts.iter().all(|part| same(part)) && !forced.has(&want.key);
            match (there, self.holders.get(&want.route)) {
                (Some(leaf), _) => {
                    kept.insert(leaf.section);
                    // The rows of a file may be in memory, whatever its name.
                    let is_file = want.key == "gap.file" || want.key == data::FILE;
                    if !(if is_file { leaf.string == name(preset, &want.key) } else { is_same }) {
                        edits.set(self.text, &leaf.value, &leaf.inner, Some(&want.value))?;
                    }
                }
                (None, Some(Holder::Inline(value, inner))) => {
                    replaced.push(&want.route);
                    edits.set(self.text, value, inner, Some(&want.value))?;
                }
                (None, _) if !is_same => {
                    self.add(want, &mut edits, &mut kept)?;
                }
                (None, _) => {}
            }
        }
        let is_kept = |leaf: &&Leaf| {
            let key = key_of(leaf);
            // Some keys only spell out a default, such as reduced units.
            let is_idle = same(&key) && preset.get(&key).is_none() && !matches!(forced, Forced::All);
            is_idle
                || wanted.iter().any(|want| want.route == leaf.route)
                || replaced.iter().any(|whole| leaf.route.starts_with(whole))
        };
        let (stays, goes): (Vec<&Leaf>, Vec<&Leaf>) = self.leaves.iter().partition(is_kept);
        kept.extend(stays.iter().map(|leaf| leaf.section));
        // From the last to the first: removing a wave does not change the numbers of those before it.
        for leaf in goes.iter().rev() {
            gone.insert(leaf.section);
            if stays.iter().any(|other| other.value == leaf.value) {
                edits.set(self.text, &leaf.value, &leaf.inner, None)?;
            } else {
                edits.take_line(self.text, leaf.start, leaf.value.end, &key_of(leaf));
            }
        }
        // A table is removed when it, and the tables below it, have lost all their keys.
        for section in &self.sections {
            let below = |set: &BTreeSet<usize>| {
                set.iter().any(|other| self.sections[*other].route.starts_with(&section.route))
            };
            if let (Some(header), true, false) = (&section.header, below(&gone), below(&kept)) {
                edits.take_line(self.text, header.start, header.end, "");
            }
        }
        let edited = edits.made(self.text);
        // The first line, if the program wrote it, states the units.
        Some(match before.and_then(|before| edited.strip_prefix(head(&before.units))) {
            Some(rest) => format!("{}{rest}", head(&preset.units)),
            None => edited,
        })
    }

    /// Adds a value at the end of its table, and marks the section that contains it as `kept`.
    fn add(&self, want: &WantedValue, edits: &mut Edits, kept: &mut BTreeSet<usize>) -> Option<()> {
        let (name, above) = want.route.split_last()?;
        // In the innermost value that holds what is above it.
        for depth in (0..=above.len()).rev() {
            if let Some(Holder::Inline(value, inner)) = self.holders.get(&above[..depth]) {
                let inner = [inner.as_slice(), &want.route[depth..]].concat();
                edits.set(self.text, value, &inner, Some(&want.value))?;
                let line = self.leaves.iter().find(|leaf| leaf.value == *value);
                kept.extend(line.map(|leaf| leaf.section));
                return Some(());
            }
        }
        let (section, name) = match self.holders.get(above) {
            Some(Holder::Section(section)) => (*section, name.clone()),
            Some(Holder::Dotted(section, dotted)) => (*section, format!("{dotted}{name}")),
            _ => {
                edits.add_table(above, &line(name, &want.value, &want.comment));
                return Some(());
            }
        };
        // After the other keys of the same table, which with dotted keys need not be the last lines.
        let near = self.leaves.iter().filter(|leaf| leaf.section == section && leaf.route.starts_with(above));
        let end = near.map(|leaf| leaf.value.end).max().unwrap_or(self.sections[section].end);
        let at = if end > 0 { end_of_line(self.text, end) } else { self.top() };
        if want.key == FOLLOWING
            && let Some(row) = parameter(&want.key)
            && let Some(begin) = self.text.find(&format!("{}\n", following(&row)))
        {
            edits.take_line(self.text, begin, begin, "");
        }
        edits.add_line(self.text, at, &line(&name, &want.value, &want.comment));
        kept.insert(section);
        Some(())
    }

    /// Where a key goes before all tables: above the first of them and above the comments directly before it.
    fn top(&self) -> usize {
        let first =
            self.sections.iter().filter_map(|section| section.header.as_ref()).map(|header| header.start);
        let mut at = start_of_line(self.text, first.min().unwrap_or(self.text.len()));
        while at > 0 {
            let before = start_of_line(self.text, at - 1);
            if !self.text[before..at].trim_start().starts_with('#') {
                break;
            }
            at = before;
        }
        at
    }
}

/// The dotted key of a leaf.
fn key_of(leaf: &Leaf) -> String {
    let key = leaf.route.join(".");
    match key.strip_suffix(".value").or_else(|| key.strip_suffix(".stiffness")) {
        Some(whole) if is_parameter(whole) || whole == "path.control" => whole.to_owned(),
        _ => key,
    }
}

/// The file name that the preset has for this key.
fn name(preset: &Preset, key: &str) -> Option<String> {
    preset.get(key).map(|value| value.to_string())
}

fn start_of_line(text: &str, at: usize) -> usize {
    text[..at].rfind('\n').map_or(0, |end| end + 1)
}

/// The position after the line end that follows `at`, or the end of the text.
fn end_of_line(text: &str, at: usize) -> usize {
    text[at..].find('\n').map_or(text.len(), |end| at + end + 1)
}

/// A value without surrounding spaces.
fn printed(value: &Value) -> String {
    value.to_string().trim().to_owned()
}

/// Changes to a text, made all at once.
#[derive(Default)]
struct Edits {
    /// What replaces what; an empty range is where something is inserted.
    places: Vec<(Range<usize>, String)>,
    /// The changed values of lines, by position.
    values: BTreeMap<usize, (Range<usize>, Value)>,
    /// New tables after all others, with their lines.
    tables: Vec<(Route, String)>,
}

impl Edits {
    /// Sets another value at the place `inner` within the value of a line, or removes it.
    fn set(&mut self, text: &str, line: &Range<usize>, inner: &[String], value: Option<&str>) -> Option<()> {
        let value = value.map(str::parse::<Value>).transpose().ok()?;
        let (_, whole) = match self.values.entry(line.start) {
            std::collections::btree_map::Entry::Occupied(there) => there.into_mut(),
            std::collections::btree_map::Entry::Vacant(free) => {
                free.insert((line.clone(), text.get(line.clone())?.parse().ok()?))
            }
        };
        set_in(whole, inner, value)
    }

    fn add_line(&mut self, text: &str, at: usize, line: &str) {
        // The last line may lack a line end.
        let begin = if at > 0 && !text[..at].ends_with('\n') { "\n" } else { "" };
        let line = format!("{begin}{line}\n");
        match self.places.iter_mut().find(|(place, _)| *place == (at..at)) {
            Some((_, lines)) => lines.push_str(&line[begin.len()..]),
            None => self.places.push((at..at, line)),
        }
    }

    fn add_table(&mut self, route: &[String], line: &str) {
        match self.tables.iter_mut().find(|(known, _)| known == route) {
            Some((_, lines)) => *lines = format!("{lines}{line}\n"),
            None => self.tables.push((route.to_vec(), format!("{line}\n"))),
        }
    }

    /// Removes what is from `start` to `end` with the rest of its line. A comment after it stays, unless it is the one
    /// that the program writes for `key`.
    fn take_line(&mut self, text: &str, start: usize, end: usize, key: &str) {
        let (begin, line_end) = (start_of_line(text, start), end_of_line(text, end));
        let rest = &text[end..line_end];
        let ours = parameter(key).map(|row| comment(&row));
        let is_kept = rest.contains('#') && start < end && ours.is_none_or(|ours| ours.trim() != rest.trim());
        let until = if is_kept { end + rest.find('#').unwrap_or(0) } else { line_end };
        let place = begin..until;
        // All values on a line are removed together with it.
        if self.places.iter().all(|(known, _)| *known != place) {
            self.places.push((place, String::new()));
        }
    }

    fn made(mut self, text: &str) -> String {
        let values = self.values.into_values().map(|(place, value)| in_line(text, place, &printed(&value)));
        self.places.extend(values);
        // What is inserted at the beginning or the end of something goes before or after it.
        self.places.sort_by_key(|(place, _)| (place.start, place.end));
        let (mut made, mut at) = (String::new(), 0);
        for (place, new) in self.places {
            // A line that is removed as a whole needs no new value.
            if place.start < at {
                continue;
            }
            made.push_str(&text[at..place.start]);
            made.push_str(&new);
            at = place.end;
        }
        made.push_str(&text[at..]);
        for (route, lines) in self.tables {
            if !made.ends_with('\n') && !made.is_empty() {
                made.push('\n');
            }
            let name = match family::below(&route.join("."), family::WAVE_TABLE) {
                Some(_) => format!("[[{}]]", family::WAVE_TABLE),
                None => format!("[{}]", route.join(".")),
            };
            made = format!("{made}\n{name}\n{lines}");
        }
        // If all line ends of the text are CR LF, the new ones are too.
        if text.contains('\n') && text.matches("\r\n").count() == text.matches('\n').count() {
            made.replace("\r\n", "\n").replace('\n', "\r\n")
        } else {
            made
        }
    }
}

/// The value `new` in its place, with the spaces after it: a comment on its line keeps its column where possible.
fn in_line(text: &str, place: Range<usize>, new: &str) -> (Range<usize>, String) {
    let behind = &text[place.end..];
    let spaces = behind.len() - behind.trim_start_matches(' ').len();
    let is_one_line = !new.contains('\n') && !text[place.clone()].contains('\n');
    if spaces == 0 || !is_one_line || !behind[spaces..].starts_with('#') {
        return (place, new.to_owned());
    }
    let start = text[..place.start].rfind('\n').map_or(0, |at| at + 1);
    let before = text[start..place.end].chars().count();
    let after = text[start..place.start].chars().count() + new.chars().count();
    let column = match spaces {
        // A comment that was pushed beyond the usual column goes back to it.
        1 if before >= COMMENTS => COMMENTS + 1,
        1 => after,
        more => before + more,
    };
    let spaces_after = column.saturating_sub(after).max(1);
    (place.start..place.end + spaces, format!("{new}{}", " ".repeat(spaces_after)))
}

/// Sets another value at the place `route` within `value`, keeping the spaces and comments around the old one, or
/// removes it. Tables that should hold it are created if missing, and removed if nothing is left in them.
fn set_in(value: &mut Value, route: &[String], new: Option<Value>) -> Option<()> {
    let Some((name, rest)) = route.split_first() else {
        let decor = value.decor().clone();
        *value = new?;
        *value.decor_mut() = decor;
        return Some(());
    };
    match value {
        Value::InlineTable(table) => {
            if !table.contains_key(name) {
                let new = new?;
                // The space before the brace moves behind the new last value.
                let last = table.iter().last().map(|(key, _)| key.to_owned());
                let last = last.and_then(|key| table.get_mut(&key));
                if let Some(last) = last {
                    last.decor_mut().set_suffix("");
                }
                table.insert(name, nested(rest, new).decorated(" ", " "));
                return Some(());
            }
            let is_taken = new.is_none();
            if rest.is_empty() && is_taken {
                table.remove(name);
                return Some(());
            }
            let inner = table.get_mut(name)?;
            set_in(inner, rest, new)?;
            if is_taken && inner.as_inline_table().is_some_and(InlineTable::is_empty) {
                table.remove(name);
            }
            Some(())
        }
        Value::Array(all) => {
            let at = name.parse::<usize>().ok()?.checked_sub(1)?;
            if at == all.len() {
                all.push(nested(rest, new?));
                return Some(());
            }
            let is_taken = new.is_none();
            let inner = all.get_mut(at)?;
            set_in(inner, rest, new)?;
            if is_taken && inner.as_inline_table().is_some_and(InlineTable::is_empty) {
                all.remove(at);
            }
            Some(())
        }
        _ => None,
    }
}

/// A value in the tables that a route names; a number is the number of a wave, the first of an array.
fn nested(route: &[String], value: Value) -> Value {
    route.iter().rev().fold(value, |value, name| {
        if name.parse::<usize>().is_ok() {
            return Array::from_iter([value]).into();
        }
        let mut table = InlineTable::new();
        table.insert(name, value);
        table.into()
    })
}

#[cfg(test)]
mod tests;
