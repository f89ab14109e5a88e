//! A preset laid over the text it was read from: what a user wrote around the values stays as it is.
//!
//! The text is not written anew. Each changed value is replaced in place, a key that the preset no longer has is
//! removed with its line, and a key that the text does not have is added at the end of its table. Not a byte else
//! changes, so comments, order, blank lines, dotted keys and inline tables stay. A comment after a removed key stays on
//! a line of its own, unless it is the one that the program itself writes there.
//!
//! `toml_edit` finds where things are, and edits inline tables. It does not print the text: it would bring dotted keys
//! of one table together, write LF for CR LF and end the last line.
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
use super::write::{COMMENTS, FOLLOWING, comment, following, head, header, line, toml, toml_of_parameter};
use crate::problem::Control;
use std::collections::btree_map::Entry;
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
    // Which keys are written out even if the text seems to give their value; without a list, all.
    let mut forced = Some(BTreeSet::<Key>::new());
    loop {
        let edited = layout.edited(before.as_ref(), preset, forced.as_ref())?;
        let back = held(&edited);
        if back.as_ref() == Some(preset) {
            return Some(edited);
        }
        let known = forced?;
        let mut more = known.clone();
        if let Some(back) = back {
            let keys = preset.rows().map(|row| row.key.clone());
            more.extend(keys.filter(|key| back.get(key) != preset.get(key)));
        }
        forced = (more != known).then_some(more);
    }
}

/// A key as a path; waves are counted from 1, as in dotted keys.
type Route = Vec<String>;

fn route(key: &str) -> Route {
    key.split('.').map(str::to_owned).collect()
}

fn below(route: &[String], name: &str) -> Route {
    [route, &[name.to_owned()]].concat()
}

/// Where a value is in the text.
#[derive(Clone)]
struct ValueText {
    /// Where its line begins, and where the value on the line is.
    start: usize,
    value: Range<usize>,
    /// Its place within that value; empty if it is the whole value.
    inner: Route,
    /// The table that contains it.
    section: usize,
}

impl ValueText {
    fn below(&self, name: &str) -> Self {
        Self { inner: below(&self.inner, name), ..self.clone() }
    }
}

/// A value of the text.
struct Leaf {
    route: Route,
    place: ValueText,
    /// Its text, if it is a string.
    string: Option<String>,
}

/// A table with a header, or the top of the text.
struct TextSection {
    route: Route,
    /// Its header; empty for the top.
    header: Range<usize>,
    /// Where its last value ends, or its header if it has none.
    end: usize,
}

/// Where the keys of a table are.
enum Holder {
    /// In lines of a section that begin with this prefix, empty except for dotted keys.
    Lines(usize, String),
    /// In a value.
    Inline(ValueText),
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
        let top = TextSection { route: Route::new(), header: 0..0, end: 0 };
        let mut layout = Self { text, leaves: Vec::new(), sections: vec![top], holders: BTreeMap::new() };
        layout.table(&Route::new(), document.as_table(), 0, "");
        Some(layout)
    }

    /// Records a table with keys of its own; for a dotted one, with the prefix of its lines.
    fn table(&mut self, above: &Route, table: &Table, section: usize, dotted: &str) {
        self.holders.insert(above.clone(), Holder::Lines(section, dotted.to_owned()));
        self.keys(above, table, section, dotted);
    }

    fn keys(&mut self, above: &Route, table: &Table, section: usize, dotted: &str) {
        for (name, item) in table {
            let Some(key) = table.key(name) else { continue };
            let route = below(above, name);
            match item {
                Item::None => {}
                Item::Value(value) => {
                    let (Some(at), Some(span)) = (key.span(), value.span()) else { continue };
                    let own = &mut self.sections[section];
                    own.end = own.end.max(span.end);
                    let place = ValueText { start: at.start, value: span, inner: Route::new(), section };
                    self.value(route, value, place);
                }
                Item::Table(inner) if inner.is_dotted() => {
                    self.table(&route, inner, section, &format!("{dotted}{}.", key.display_repr()));
                }
                Item::Table(inner) if inner.is_implicit() => {
                    self.holders.insert(route.clone(), Holder::Implied);
                    self.keys(&route, inner, section, "");
                }
                Item::Table(inner) => self.section(&route, inner),
                Item::ArrayOfTables(all) => {
                    self.holders.insert(route.clone(), Holder::Implied);
                    for (i, inner) in all.iter().enumerate() {
                        self.section(&below(&route, &(i + 1).to_string()), inner);
                    }
                }
            }
        }
    }

    fn section(&mut self, route: &Route, table: &Table) {
        let header = table.span().unwrap_or_default();
        self.sections.push(TextSection { route: route.clone(), end: header.end, header });
        self.table(route, table, self.sections.len() - 1, "");
    }

    /// Records what is in the value of a line.
    fn value(&mut self, route: Route, value: &Value, place: ValueText) {
        match value {
            Value::InlineTable(table) => {
                for (name, value) in table {
                    self.value(below(&route, name), value, place.below(name));
                }
                self.holders.insert(route, Holder::Inline(place));
            }
            Value::Array(all) if route.join(".") == family::WAVE_TABLE => {
                for (i, value) in all.iter().enumerate() {
                    let number = (i + 1).to_string();
                    self.value(below(&route, &number), value, place.below(&number));
                }
                self.holders.insert(route, Holder::Inline(place));
            }
            scalar => self.leaves.push(Leaf { route, place, string: scalar.as_str().map(str::to_owned) }),
        }
    }

    /// The values that the text is to have for `preset`, in the forms that it uses.
    fn wanted(&self, preset: &Preset) -> Vec<WantedValue> {
        let mut all = Vec::new();
        for row in preset.rows().filter(|row| !row.is_part() && !is_range(&row.key)) {
            let Some(value) = preset.get(&row.key) else { continue };
            let own = route(&row.key);
            let is_table = self.holders.contains_key(&own);
            let mut want = |route: Route, key: Key, value: String| {
                all.push(WantedValue { route, key, value, comment: comment(&row) });
            };
            if is_parameter(&row.key) && is_table {
                want(below(&own, "value"), row.key.clone(), toml(preset, &row, &value));
                for part in PARAMETER_KEYS {
                    let key = format!("{}.{part}", row.key);
                    if let Some(value) = preset.get(&key) {
                        want(below(&own, part), key.into(), toml(preset, &row, &value));
                    }
                }
            } else if is_parameter(&row.key) {
                want(own, row.key.clone(), toml_of_parameter(preset, &row, &value));
            } else if let (true, Number::Control(Control::Stiffness(_))) = (is_table, &value) {
                let whole = toml(preset, &row, &value).parse::<Value>().ok();
                let stiffness = whole.as_ref().and_then(|whole| whole.as_inline_table()?.get("stiffness"));
                want(below(&own, "stiffness"), row.key.clone(), stiffness.map(printed).unwrap_or_default());
            } else {
                want(own, row.key.clone(), toml(preset, &row, &value));
            }
        }
        all
    }

    /// The text for `preset`, given that it was the text for `before`.
    fn edited(
        &self,
        before: Option<&Preset>,
        preset: &Preset,
        forced: Option<&BTreeSet<Key>>,
    ) -> Option<String> {
        let (wanted, changes) = (self.wanted(preset), TextChanges { before, preset, forced });
        let mut edits = Edits::default();
        let (mut kept, replaced) = self.put(&wanted, &changes, &mut edits)?;
        let is_kept = |leaf: &&Leaf| {
            let key = key_of(leaf);
            // Some keys only spell out a default, such as reduced units.
            let is_idle = changes.leaves(&key) && preset.get(&key).is_none() && forced.is_some();
            is_idle
                || wanted.iter().any(|want| want.route == leaf.route)
                || replaced.iter().any(|whole| leaf.route.starts_with(whole))
        };
        let (stays, goes): (Vec<&Leaf>, Vec<&Leaf>) = self.leaves.iter().partition(is_kept);
        kept.extend(stays.iter().map(|leaf| leaf.place.section));
        self.take(&stays, &goes, &kept, &mut edits)?;
        let edited = edits.made(self.text);
        // The first line, if the program wrote it, states the units.
        Some(match before.and_then(|before| edited.strip_prefix(head(&before.units))) {
            Some(rest) => format!("{}{rest}", head(&preset.units)),
            None => edited,
        })
    }

    /// Writes what is wanted, and returns the sections that are kept for it and the values that are replaced as a whole
    /// because the text holds them as an inline table.
    fn put<'b>(
        &self,
        wanted: &'b [WantedValue],
        changes: &TextChanges<'_>,
        edits: &mut Edits,
    ) -> Option<(BTreeSet<usize>, Vec<&'b Route>)> {
        let (mut kept, mut replaced) = (BTreeSet::new(), Vec::new());
        for want in wanted {
            let there = self.leaves.iter().find(|leaf| leaf.route == want.route);
            // A parameter that gains or loses a range is replaced as a whole.
            let parts = PARAMETER_KEYS.map(|part| format!("{}.{part}", want.key));
            let is_same = changes.leaves(&want.key)
                && parts.iter().all(|part| changes.leaves(part))
                && changes.forced.is_some_and(|keys| !keys.contains(&want.key));
            match (there, self.holders.get(&want.route)) {
                (Some(leaf), _) => {
                    kept.insert(leaf.place.section);
                    // The rows of a file may be in memory, whatever its name.
                    let is_file = want.key == "gap.file" || want.key == data::FILE;
                    if !(if is_file {
                        leaf.string == changes.preset.get(&want.key).map(|value| value.to_string())
                    } else {
                        is_same
                    }) {
                        edits.set(self.text, &leaf.place, &[], Some(&want.value))?;
                    }
                }
                (None, Some(Holder::Inline(place))) => {
                    replaced.push(&want.route);
                    edits.set(self.text, place, &[], Some(&want.value))?;
                }
                (None, _) if !is_same => self.add(want, edits, &mut kept)?,
                (None, _) => {}
            }
        }
        Some((kept, replaced))
    }

    /// Takes out the values that go, and the tables that have lost all their keys.
    fn take(&self, stays: &[&Leaf], goes: &[&Leaf], kept: &BTreeSet<usize>, edits: &mut Edits) -> Option<()> {
        let mut gone = BTreeSet::new();
        // From the last to the first: removing a wave does not change the numbers of those before it.
        for leaf in goes.iter().rev() {
            let place = &leaf.place;
            gone.insert(place.section);
            if stays.iter().any(|other| other.place.value == place.value) {
                edits.set(self.text, place, &[], None)?;
            } else {
                edits.take_line(self.text, place.start, place.value.end, &key_of(leaf));
            }
        }
        // A table is removed when it, and the tables below it, have lost all their keys.
        for section in &self.sections[1..] {
            let below = |set: &BTreeSet<usize>| {
                set.iter().any(|other| self.sections[*other].route.starts_with(&section.route))
            };
            if below(&gone) && !below(kept) {
                edits.take_line(self.text, section.header.start, section.header.end, "");
            }
        }
        Some(())
    }

    /// Adds a value at the end of its table, and marks the section that contains it as `kept`.
    fn add(&self, want: &WantedValue, edits: &mut Edits, kept: &mut BTreeSet<usize>) -> Option<()> {
        let (name, above) = want.route.split_last()?;
        // In the innermost value that holds what is above it.
        for depth in (0..=above.len()).rev() {
            if let Some(Holder::Inline(place)) = self.holders.get(&above[..depth]) {
                kept.insert(place.section);
                return edits.set(self.text, place, &want.route[depth..], Some(&want.value));
            }
        }
        let Some(Holder::Lines(section, dotted)) = self.holders.get(above) else {
            edits.add_table(above, &line(name, &want.value, &want.comment));
            return Some(());
        };
        // After the other keys of the same table, which with dotted keys need not be the last lines.
        let near =
            self.leaves.iter().filter(|leaf| leaf.place.section == *section && leaf.route.starts_with(above));
        let end = near.map(|leaf| leaf.place.value.end).max().unwrap_or(self.sections[*section].end);
        let at = if end > 0 { end_of_line(self.text, end) } else { self.top() };
        if want.key == FOLLOWING
            && let Some(row) = parameter(&want.key)
            && let Some(begin) = self.text.find(&format!("{}\n", following(&row)))
        {
            edits.take_line(self.text, begin, begin, "");
        }
        edits.add_line(self.text, at, &line(&format!("{dotted}{name}"), &want.value, &want.comment));
        kept.insert(*section);
        Some(())
    }

    /// Where a key goes before all tables: above the first of them and above the comments directly before it.
    fn top(&self) -> usize {
        let first = self.sections[1..].iter().map(|section| section.header.start).min();
        let mut at = start_of_line(self.text, first.unwrap_or(self.text.len()));
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

/// From which preset to which a text is edited, and the keys that are written even if they stay as they are; without them
/// all are.
struct TextChanges<'a> {
    before: Option<&'a Preset>,
    preset: &'a Preset,
    forced: Option<&'a BTreeSet<Key>>,
}

impl TextChanges<'_> {
    /// Whether the value of this key stays as it is.
    fn leaves(&self, key: &str) -> bool {
        self.before.is_some_and(|before| before.get(key) == self.preset.get(key))
    }
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
    /// Sets another value at a place, or `below` it, or removes it.
    fn set(&mut self, text: &str, place: &ValueText, below: &[String], value: Option<&str>) -> Option<()> {
        let value = value.map(str::parse::<Value>).transpose().ok()?;
        let (_, whole) = match self.values.entry(place.value.start) {
            Entry::Occupied(there) => there.into_mut(),
            Entry::Vacant(free) => {
                free.insert((place.value.clone(), text.get(place.value.clone())?.parse().ok()?))
            }
        };
        set_in(whole, &[&place.inner, below].concat(), value)
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
            let name = header(&route.join("."));
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
    let start = start_of_line(text, place.start);
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
    // The number of a wave, as an index.
    let index = name.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
    let there = match value {
        Value::InlineTable(table) => table.get_mut(name),
        Value::Array(all) => all.get_mut(index?),
        _ => None,
    };
    let is_taken = new.is_none();
    if let Some(inner) = there.filter(|_| !is_taken || !rest.is_empty()) {
        set_in(inner, rest, new.clone())?;
        if !is_taken || !inner.as_inline_table().is_some_and(InlineTable::is_empty) {
            return Some(());
        }
    }
    match (value, new) {
        (Value::InlineTable(table), Some(new)) => {
            // The space before the brace moves behind the new last value.
            if let Some((_, last)) = table.iter_mut().last() {
                last.decor_mut().set_suffix("");
            }
            table.insert(name, nested(rest, new).decorated(" ", " "));
        }
        (Value::InlineTable(table), None) => drop(table.remove(name)?),
        (Value::Array(all), Some(new)) if index? == all.len() => all.push(nested(rest, new)),
        (Value::Array(all), None) if index? < all.len() => drop(all.remove(index?)),
        _ => return None,
    }
    Some(())
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
