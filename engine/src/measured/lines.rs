//! The lines of a file → its tables of rows, with the words above each.
//!
//! A row is a line whose first cell is a number, a missing value or the name of a branch, and which has as many cells
//! as the rows above it. In a file without such rows, a row may begin with text, such as the name of a sample. Words
//! separate tables: settings and headers stand above them, a footer below. A line among the rows that begins like a
//! number remains a row, so that its fault is reported.

use super::error::{CurveReadError, MOST_COLUMNS, ROW_RANGE};
use super::words::{Words, is_branch, is_gap, is_number, is_stamp, parts_tables, row_under};
use crate::cells::{LONGEST_LINE, LineFault, Separator, is_unprintable, remark};

/// At most this many lines of words above a table are searched for its header.
const LINES_ABOVE: usize = 256;

/// A table: rows with the same number of cells.
#[derive(Debug)]
pub(super) struct TextTable<'a> {
    /// The words above it and below the previous table.
    pub above: Vec<Words<'a>>,
    /// What separates the cells.
    pub separator: Separator,
    /// The number of cells in the first row.
    pub cells: usize,
    /// The cell by which a row is recognized, the first that is not text.
    pub lead: usize,
    /// The rows with their line numbers.
    pub rows: Vec<(usize, &'a str)>,
}

impl TextTable<'_> {
    /// How many cells the first row has up to its last value.
    pub(super) fn filled(&self) -> usize {
        let cells = self.rows.first().map(|(_, text)| self.separator.cells(text)).unwrap_or_default();
        cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1)
    }
}

/// The lines of a file: tables and words.
#[derive(Debug, Default)]
pub(super) struct Outline<'a> {
    /// The tables.
    pub tables: Vec<TextTable<'a>>,
    /// All words, including those below the last table.
    pub words: Vec<Words<'a>>,
    /// The lines that are faulty as a whole.
    pub faults: Vec<(usize, LineFault)>,
    /// Whether rows may begin with text.
    is_led: bool,
    /// Whether it is an Igor text file.
    pub is_igor: bool,
    /// The first and last line of the words below the last table that are not remarks.
    pub footer: Option<(usize, usize)>,
}

/// Whether a line begins as numbers do and does not continue as a rule.
fn begins_as_number(text: &str) -> bool {
    let text = text.trim_start_matches(['"', '\t']);
    let rest = text.trim_start_matches(['+', '-', '\u{2212}']);
    text.starts_with(|c: char| c.is_ascii_digit() || c == '.')
        || (rest.len() < text.len() && rest.starts_with(|c: char| c.is_alphanumeric() || c == '.'))
}

/// Whether a cell may be the first of a row.
fn is_value(cell: &str) -> bool {
    is_number(cell) || is_gap(cell) || is_branch(cell) || is_stamp(cell)
}

/// How the cells of a line that begins with text are separated, if it is a row, that is, has at least two numbers; and
/// where the first number is.
fn led_row(text: &str) -> Option<(Separator, usize, usize)> {
    let of = |separator: Separator| {
        let cells = separator.cells(text);
        let lead = cells.iter().position(|cell| is_number(cell))?;
        let is_row = cells.iter().filter(|cell| is_number(cell)).count() >= 2
            && cells[lead..].iter().all(|cell| is_value(cell) || separator != Separator::Spaces);
        is_row.then_some((separator, cells.len(), lead))
    };
    separators(text).find_map(of)
}

/// What may separate the cells of a line.
fn separators(text: &str) -> impl Iterator<Item = Separator> {
    let parting = [';', '\t', '|', ','].into_iter().filter(|c| text.contains(*c)).map(Separator::Character);
    parting.chain([Separator::Spaces])
}

/// How the cells of a line are separated, if it is a row by itself: at least two values with a number among them, or
/// one number.
fn row(text: &str) -> Option<(Separator, usize)> {
    let of = |separator: Separator| {
        let cells = separator.cells(text);
        // Where commas separate cells, they do not occur in numbers, except between quotation marks.
        let is_parting = separator == Separator::Character(',') && !text.contains('"');
        let number = |cell: &str| is_number(cell) && !(is_parting && cell.contains(','));
        let value = |cell: &str| number(cell) || is_gap(cell) || is_branch(cell) || is_stamp(cell);
        let word = |cell: &str| separator != Separator::Spaces && cell.contains(char::is_alphabetic);
        let values = cells.iter().filter(|cell| value(cell)).count();
        let is_row = cells.iter().any(|cell| number(cell))
            && cells.iter().find(|cell| !cell.is_empty()).is_some_and(|cell| value(cell))
            && cells.iter().all(|cell| value(cell) || word(cell))
            && (values >= 2 || cells.len() == 1);
        is_row.then_some((separator, cells.len()))
    };
    separators(text).find_map(of)
}

impl<'a> Outline<'a> {
    /// The pieces of a text. Rows begin with a value or, if there are too few of those, with text.
    ///
    /// # Errors
    /// [`CurveReadError`] if reading on would be of no use.
    pub(super) fn of(text: &'a str) -> Result<Self, CurveReadError> {
        let outline = Self::led(text, false)?;
        let most = |of: &Self| of.tables.iter().map(|table| table.rows.len()).max().unwrap_or(0);
        if most(&outline) >= *ROW_RANGE.start() {
            return Ok(outline);
        }
        let led = Self::led(text, true)?;
        Ok(if most(&led) > most(&outline) { led } else { outline })
    }

    /// The pieces of a text whose rows may begin with text if `is_led`.
    fn led(text: &'a str, is_led: bool) -> Result<Self, CurveReadError> {
        let mut outline = Self {
            is_led,
            is_igor: text.lines().next().is_some_and(|first| first.trim() == "IGOR"),
            ..Self::default()
        };
        let mut above: Vec<Words<'a>> = Vec::new();
        let mut is_open = false;
        let mut rows = 0;
        for (line, text) in text.lines().enumerate().map(|(i, text)| (i + 1, trimmed(text))) {
            // Igor indents its rows with a tab.
            let text = if outline.is_igor { text.trim() } else { text };
            if text.chars().all(|c| c.is_whitespace() || ";,|\"".contains(c)) {
                continue;
            }
            if is_unprintable(text) {
                outline.faults.push((line, LineFault::Unprintable));
                continue;
            }
            let remark = remark(text);
            if remark.is_none() && begins_as_number(text) && text.len() > LONGEST_LINE {
                outline.faults.push((line, LineFault::Long(text.len())));
                continue;
            }
            let is_row = remark.is_none()
                && (is_open && outline.goes_on(line, text) || outline.begins(line, text, &mut above)?);
            if is_row {
                is_open = true;
                rows += 1;
                if rows > *ROW_RANGE.end() {
                    return Err(CurveReadError::Rows { rows, skipped: 0 });
                }
                continue;
            }
            let words = Words { line, text: remark.unwrap_or(text).trim(), is_remark: remark.is_some() };
            is_open &= words.is_remark && !parts_tables(words.text);
            outline.words.push(words);
            if above.len() == LINES_ABOVE {
                above.remove(0);
            }
            above.push(words);
        }
        let mut below = above.iter().filter(|words| !words.is_remark).map(|words| words.line);
        let first = below.next().filter(|_| !outline.tables.is_empty());
        outline.footer = first.map(|first| (first, below.next_back().unwrap_or(first)));
        Ok(outline)
    }

    /// Adds a line to the open table, if it is one of its rows.
    fn goes_on(&mut self, line: usize, text: &'a str) -> bool {
        let Some(table) = self.tables.last_mut() else { return false };
        // A single number above rows gives their count.
        if table.cells == 1 && row(text).is_some_and(|(_, cells)| cells > 1) {
            return false;
        }
        let cells = || table.separator.cells(text);
        let is_row = begins_as_number(text) || {
            let cells = cells();
            cells.len() == table.cells && cells.get(table.lead).is_some_and(|cell| is_value(cell))
        };
        if is_row {
            table.rows.push((line, text));
        }
        is_row
    }

    /// Begins a table with a line that is a row; the words above it go to `above`.
    fn begins(
        &mut self,
        line: usize,
        text: &'a str,
        above: &mut Vec<Words<'a>>,
    ) -> Result<bool, CurveReadError> {
        let plain =
            || row(text).or_else(|| row_under(above, text)).map(|(separator, cells)| (separator, cells, 0));
        let Some((separator, cells, lead)) = self.is_led.then(|| led_row(text)).flatten().or_else(plain)
        else {
            return Ok(false);
        };
        if cells > MOST_COLUMNS {
            return Err(CurveReadError::ManyColumns { line, found: cells });
        }
        // Words among rows that are separated like them are a row with a fault, not a header.
        if let Some(table) = self.tables.last_mut()
            && (table.separator, table.cells) == (separator, cells)
            && above.iter().any(|words| !words.is_remark)
            && above.iter().all(|words| words.is_remark || broken(table, words.text))
        {
            let broken =
                above.drain(..).filter(|words| !words.is_remark).map(|words| (words.line, words.text));
            table.rows.extend(broken);
            table.rows.push((line, text));
            return Ok(true);
        }
        let separator = commas(separator, above, text).ok_or(CurveReadError::Commas(line))?;
        let cells = separator.cells(text).len();
        self.tables.push(TextTable {
            above: std::mem::take(above),
            separator,
            cells,
            lead,
            rows: vec![(line, text)],
        });
        Ok(true)
    }
}

/// Whether words have the same cells as a row, with a number among them.
fn broken(table: &TextTable, text: &str) -> bool {
    let cells = table.separator.cells(text);
    cells.len() > 1 && cells.len() == table.cells && cells.iter().any(|cell| is_number(cell))
}

/// What separates the cells of a row in which some commas are followed by a space and some by a digit; `None` if the
/// number of words above does not tell.
fn commas(separator: Separator, above: &[Words], text: &str) -> Option<Separator> {
    let wide = Separator::CommaSpace.cells(text);
    let plain = separator.cells(text).len();
    if separator != Separator::Character(',') || wide.len() == 1 || wide.len() == plain {
        return Some(separator);
    }
    if text.contains('"') || !wide.iter().all(|cell| is_number(cell)) {
        return Some(separator);
    }
    let names = above.iter().rev().map(|words| separator.cells(words.text).len()).find(|names| *names > 1)?;
    if names == wide.len() { Some(Separator::CommaSpace) } else { (names == plain).then_some(separator) }
}

/// A line without surrounding spaces; tabs stay, because they separate cells that may be empty.
fn trimmed(text: &str) -> &str {
    text.trim_end_matches([' ', '\u{1a}']).trim_start_matches(' ')
}
