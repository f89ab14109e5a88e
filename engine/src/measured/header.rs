//! What the words above a table say about its columns: their names, their units, the branch of its rows.

use super::lines::TextTable;
use super::names::{named, squashed};
use super::role::{Segment, unit_named};
use super::words::{Words, count_known, is_branch, is_gap, is_number, is_units, keyed, unit_cells};
use crate::cells::{ColumnHead, Separator, has_factor, heads, is_multiple};
use std::collections::HashMap;

/// A header: the names and units of the columns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    pub line: usize,
    pub heads: Vec<ColumnHead>,
}

/// The names in the line with which an Igor text file begins its waves: `WAVES/D/N=(512) ZSnsr, Defl`.
fn waves(text: &str) -> Option<Vec<ColumnHead>> {
    let mut rest = text.strip_prefix("WAVES")?;
    while let Some(flag) = rest.trim_start().strip_prefix('/') {
        rest = flag.find(|c: char| c.is_whitespace() || c == ',').map_or("", |at| &flag[at..]);
    }
    let names = rest.split(|c: char| c.is_whitespace() || c == ',').filter(|name| !name.is_empty());
    Some(names.map(|name| (name.trim_matches('\'').to_owned(), None)).collect())
}

/// The units that Igor assigns to waves by name: `X SetScale y 0,0,"m", ZSnsr`.
fn scales<'a>(words: &[Words<'a>]) -> HashMap<&'a str, &'a str> {
    let mut units = HashMap::new();
    for text in words.iter().filter(|words| words.text.starts_with("X ")).map(|words| words.text) {
        for scale in text.split("SetScale").skip(1) {
            let axis = scale.trim_start_matches(|c: char| c == '/' || c.is_ascii_uppercase()).trim_start();
            let quoted: Vec<&str> = scale.splitn(3, '"').collect();
            if let (true, &[_, unit, names]) = (axis.starts_with(['d', 'y']), &quoted[..]) {
                let names = names.split([',', ';', ' ', '\t']).filter(|name| !name.is_empty());
                units.extend(names.map(|name| (name.trim_matches('\''), unit)));
            }
        }
    }
    units
}

/// The cells of words for each way of separating them; the first way is that of the rows.
fn parted(text: &str, separator: Separator) -> impl Iterator<Item = Vec<ColumnHead>> {
    let dimensions = super::role::dimensions();
    let ways = [separator, Separator::of(text), Separator::Wide, Separator::Spaces];
    ways.into_iter().map(move |way| match way {
        Separator::Wide => {
            let cells = way.cells(text).into_iter();
            cells.flat_map(|cell| heads(cell, Separator::Character('\0'), &dimensions)).collect()
        }
        way => heads(text, way, &dimensions),
    })
}

/// `heads` as the names of the columns of `table`, if they fit: names behind the last column must mean nothing, and
/// columns without a name must be empty.
fn fitted(mut heads: Vec<ColumnHead>, table: &TextTable) -> Option<Vec<ColumnHead>> {
    let is_empty = |head: &ColumnHead| head.0.is_empty() && head.1.is_none();
    while heads.len() > table.cells
        && heads.last().is_some_and(|head| is_empty(head) || named(&head.0).is_none())
    {
        heads.pop();
    }
    while heads.last().is_some_and(is_empty) && heads.len() > table.filled() {
        heads.pop();
    }
    if heads.len() > table.cells || heads.len() < table.filled() {
        return None;
    }
    heads.resize(table.cells, ColumnHead::default());
    Some(heads.into_iter().map(whole).collect())
}

/// The header of a table, from the words above it; `all` are the words of the whole file.
pub(super) fn headed(table: &TextTable, all: &[Words]) -> Option<Header> {
    let last = |key: &str| table.above.iter().rev().find_map(|words| Some((words.line, keyed(words, key)?)));
    // JPK names its columns in one remark and describes them further in others.
    if let Some((line, names)) = last("columns").or_else(|| last("fancyNames")) {
        let heads = Separator::Spaces.cells(names).into_iter().map(|name| (name.to_owned(), None)).collect();
        let units = last("units").map(|(_, units)| Separator::Spaces.cells(units)).unwrap_or_default();
        return fitted(heads, table).map(|heads| Header { line, heads: with_units(heads, &units) });
    }
    if let Some((line, heads)) =
        table.above.iter().rev().find_map(|words| Some((words.line, waves(words.text)?)))
    {
        let scales = scales(all);
        let with_unit = |(name, _): ColumnHead| {
            let unit = scales.get(&*name).map(|unit| (*unit).to_owned());
            (name, unit)
        };
        return fitted(heads, table)
            .map(|heads| Header { line, heads: heads.into_iter().map(with_unit).collect() });
    }
    let labels = table.above.iter().rev().map(|words| Separator::Character('\t').cells(words.text));
    let mut units = labels
        .into_iter()
        .find(|cells| cells.first().is_some_and(|cell| *cell == "Y_Unit_Label"))
        .map(|cells| std::iter::once("").chain(cells.into_iter().skip(1)).collect())
        .unwrap_or_default();
    for words in table.above.iter().rev().filter(|words| words.text.contains(char::is_alphanumeric)) {
        if !words.is_remark && is_units(words.text, table.separator) {
            units = unit_cells(words.text, table.separator);
            continue;
        }
        // A row in which nothing was measured is no header.
        let is_of_row = |name: &str| is_gap(name) || is_number(name) || is_branch(name);
        let cells = table.separator.cells(words.text);
        if cells.iter().any(|cell| cell.contains(char::is_alphanumeric) && is_gap(cell))
            && cells.iter().all(|cell| is_of_row(cell))
        {
            continue;
        }
        let mut found =
            parted(words.text, table.separator).map(|heads| (count_known(&heads), fitted(heads, table)));
        let fits = |(known, heads): (usize, Option<Vec<ColumnHead>>)| heads.map(|heads| (known, heads));
        // A remark with the right number of words need not be a header, nor need words that are separated differently
        // from the rows.
        let first = found.next().and_then(fits).filter(|(known, _)| !words.is_remark || *known >= 2);
        let heads = first.or_else(|| found.filter_map(fits).find(|(known, _)| *known >= 2));
        if let Some((_, heads)) = heads.filter(|(_, heads)| heads.len() > 1) {
            return Some(Header { line: words.line, heads: with_units(heads, &units) });
        }
        if !words.is_remark && parted(words.text, table.separator).any(|heads| count_known(&heads) >= 2) {
            return None;
        }
    }
    None
}

/// Gives columns without a unit the corresponding one of `units`.
fn with_units(mut heads: Vec<ColumnHead>, units: &[&str]) -> Vec<ColumnHead> {
    for (head, unit) in heads.iter_mut().zip(units) {
        head.1 =
            head.1.take().or_else(|| Some((*unit).to_owned()).filter(|unit| !unit.is_empty() && unit != "-"));
    }
    heads
}

/// The branch of all rows of a table: `# segment: retract`, or a line that consists of its name.
pub(super) fn segment(table: &TextTable) -> Option<Segment> {
    let of = |text: &str| {
        let text = text.trim_matches(|c: char| !c.is_alphanumeric());
        text.starts_with(char::is_alphabetic).then(|| Segment::of(text)).flatten()
    };
    table.above.iter().rev().find_map(|words| match keyed(words, "segment") {
        // Of a sentence about both branches neither is that of the rows.
        Some(value) => {
            /// Shorter words, such as "in", are words of any sentence.
            const WORD: usize = 4;
            let mut named = value.split_whitespace();
            let first = of(named.next()?)?;
            named
                .filter(|word| word.len() >= WORD)
                .filter_map(of)
                .all(|other| other == first)
                .then_some(first)
        }
        None => of(words.text),
    })
}

/// Text in parentheses that is not a unit belongs to the name: `height (measured)`.
fn whole((name, unit): ColumnHead) -> ColumnHead {
    let is_unit = |text: &str| unit_named(text, true).is_some();
    match unit {
        // The factor of a unit is not part of a name: whether the numbers include it is not known.
        Some(text) if !is_unit(&text) && is_multiple(&text, is_unit) => (name, Some(text)),
        Some(text) if has_factor(&name) => {
            let with = format!("{text}, as in {name}");
            (name, Some(with))
        }
        Some(text) if !is_unit(&text) && text != "V" => {
            let longer = format!("{name} {text}");
            // A single letter is the symbol of another quantity only by chance: "approach [A]" is meant in ångström.
            let role = |name: &str| named(name).map(|named| named.role);
            let is_symbol =
                text.chars().count() == 1 && role(&name).is_some() && role(&longer) != role(&name);
            if !is_symbol && (named(&longer).is_some() || named(&name).is_none()) {
                (longer, None)
            } else {
                (name, Some(text))
            }
        }
        unit => (name, unit),
    }
}

impl Header {
    /// Whether it is the header of a curve or a walk that this program wrote.
    pub(super) fn is_computed(&self) -> bool {
        /// Columns that both have.
        const OWN: [&str; 5] = ["contact_radius", "approach", "force", "newton_iterations", "stable_chosen"];
        OWN.iter().all(|own| self.heads.iter().any(|(name, _)| name == own))
    }
}

/// Whether the names of two headers are the same.
pub(super) fn same(one: Option<&Header>, other: Option<&Header>) -> bool {
    let names = |header: &Header| header.heads.iter().map(|(name, _)| squashed(name)).collect::<Vec<_>>();
    match (one, other) {
        (Some(one), Some(other)) => names(one) == names(other),
        // A table without a header has that of the table before it.
        _ => true,
    }
}
