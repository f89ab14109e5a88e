//! Splits text tables from instruments: cells, headers with units, and the list of what is wrong in which line.
//!
//! The text is split here and not by a CSV library, because the separator is not known beforehand, spaces come in runs,
//! and every fault must name its line.

use crate::text::{is_unsafe, quote};
use crate::units::{Dimension, Unit};
use std::borrow::Cow;
use std::fmt;
use thiserror::Error;

/// The largest file, in bytes.
pub const LARGEST: u64 = 64 << 20;
/// How many faults a message lists.
pub const FAULTS_SHOWN: usize = 3;
/// The longest row, in bytes; a row of numbers needs far less.
pub const LONGEST_LINE: usize = 2048;
/// The largest number, as in presets.
pub const LARGEST_NUMBER: f64 = 1e30;

/// The faults of a file, in the order of their lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Faults<F> {
    /// The line of each, from 1, and what is wrong; the first [`FAULTS_SHOWN`].
    pub shown: Vec<(usize, F)>,
    /// How many there are.
    pub total: usize,
}

impl<F> Default for Faults<F> {
    fn default() -> Self {
        Self { shown: Vec::new(), total: 0 }
    }
}

impl<F> Faults<F> {
    /// Adds one more fault, in `line`.
    pub fn add(&mut self, line: usize, fault: F) {
        if self.shown.len() < FAULTS_SHOWN {
            self.shown.push((line, fault));
        }
        self.total += 1;
    }

    /// These faults and `more`, in the order of their lines.
    #[must_use]
    pub fn and(mut self, more: impl Iterator<Item = (usize, F)>) -> Self {
        let mut other = Self::default();
        more.for_each(|(line, fault)| other.add(line, fault));
        self.total += other.total;
        self.shown.append(&mut other.shown);
        self.shown.sort_by_key(|(line, _)| *line);
        self.shown.truncate(FAULTS_SHOWN);
        self
    }
}

impl<F: fmt::Display> fmt::Display for Faults<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (line, fault)) in self.shown.iter().enumerate() {
            write!(f, "{}line {line}: {fault}", if i > 0 { "\n" } else { "" })?;
        }
        match self.total - self.shown.len() {
            0 => Ok(()),
            more => write!(f, "\nand {more} more"),
        }
    }
}

/// What is wrong with a line, regardless of its columns.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum LineFault {
    /// The line is far too long.
    #[error("has {0} bytes, more than the {LONGEST_LINE} allowed")]
    Long(usize),
    /// Characters that cannot be seen.
    #[error("holds control or invisible characters")]
    Unprintable,
}

/// What is wrong with a cell that should hold a number.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum CellFault {
    /// It is empty.
    #[error("the {0} is missing")]
    Missing(&'static str),
    /// Not a number.
    #[error("the {what} \"{text}\" is not a number")]
    Number {
        /// What the cell should hold.
        what: &'static str,
        /// Its text, safe to show.
        text: String,
    },
    /// Not finite, or absurdly large.
    #[error(
        "the {what} \"{text}\" is out of range: it must be a number from -{LARGEST_NUMBER:e} to {LARGEST_NUMBER:e}"
    )]
    Range {
        /// What the cell should hold.
        what: &'static str,
        /// Its text, safe to show.
        text: String,
    },
    /// A comma and a point in one number. The text is safe to show.
    #[error("\"{0}\" has more than one comma or point: write numbers without thousands separators")]
    Thousands(String),
    /// Commas that may as well separate thousands. The text is safe to show.
    #[error(
        "in \"{0}\", as in all numbers with a comma, three digits follow it: it may separate thousands; write numbers without \
         thousands separators, and decimals with a point"
    )]
    Grouped(String),
    /// A decimal point in a file with decimal commas, or the reverse.
    #[error(
        "\"{text}\" has {}: one of them separates thousands; write all decimals alike",
        if text.contains(',') {
            format!("a comma, and line {line} has a number with a point")
        } else {
            format!("a point, and line {line} has a number with a comma")
        }
    )]
    Marks {
        /// Its text, safe to show.
        text: String,
        /// The line with the other mark.
        line: usize,
    },
}

/// Reads the numbers of a file, and knows how it writes decimals.
#[derive(Debug, Default)]
pub struct Decimals {
    /// The line of the first number with a decimal point, and of the first with a decimal comma.
    marks: [Option<usize>; 2],
    /// The first number whose comma may separate thousands, with its line.
    grouped: Option<(usize, String)>,
    /// Whether another number would not be written so with commas between thousands.
    is_sure: bool,
}

/// Whether a number would not be written so with commas between thousands: `0,95` or `1234,5`.
pub fn rules_out_thousands(cell: &str) -> bool {
    let cell = bare(cell);
    let is_number = || cell.replace(',', ".").replace('\u{2212}', "-").parse::<f64>().is_ok();
    cell.matches(',').count() == 1 && is_number() && !is_grouped(cell)
}

/// Whether the comma of a number may separate thousands: `1,234` and `-643,950`, but not `0,950` or `1,2345`.
fn is_grouped(number: &str) -> bool {
    let digits = number.trim_start_matches(['+', '-', '\u{2212}']);
    digits.split_once(',').is_some_and(|(before, behind)| {
        let is_whole = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
        (1..=3).contains(&before.len())
            && behind.len() == 3
            && !before.starts_with('0')
            && is_whole(before)
            && is_whole(behind)
    })
}

impl Decimals {
    /// The number in a cell of `line` that holds `what`, and its text with a decimal point.
    ///
    /// # Errors
    /// [`CellFault`].
    pub fn number<'a>(
        &mut self,
        line: usize,
        text: &'a str,
        what: &'static str,
    ) -> Result<(f64, Cow<'a, str>), CellFault> {
        let marks = text.bytes().filter(|byte| [b',', b'.'].contains(byte)).count();
        let comma = text.contains(',');
        if comma && marks > 1 {
            return Err(CellFault::Thousands(quote(text)));
        }
        if marks == 1 {
            let [same, other] = if comma { [1, 0] } else { [0, 1] };
            self.marks[same] = self.marks[same].or(Some(line));
            if let Some(line) = self.marks[other] {
                return Err(CellFault::Marks { text: quote(text), line });
            }
        }
        if text.is_empty() {
            return Err(CellFault::Missing(what));
        }
        if comma && is_grouped(text) {
            self.grouped.get_or_insert_with(|| (line, quote(text)));
        } else if comma {
            self.is_sure = true;
        }
        let mut plain = Cow::Borrowed(text);
        if comma || text.contains(['\u{2212}', 'd', 'D']) {
            // 1.5D-05 is how Fortran writes 1.5e-05.
            plain = text.replace(',', ".").replace('\u{2212}', "-").replace(['d', 'D'], "e").into();
        }
        let number: f64 = plain.parse().map_err(|_| CellFault::Number { what, text: quote(text) })?;
        if number.abs() <= LARGEST_NUMBER {
            // -0 becomes 0, so that rows can be compared as numbers.
            Ok((number + 0.0, plain))
        } else {
            Err(CellFault::Range { what, text: quote(text) })
        }
    }

    /// The line of a number whose comma may separate thousands, where no other number tells, and what is wrong with it.
    pub fn doubtful(&self) -> Option<(usize, CellFault)> {
        let (line, text) = self.grouped.clone().filter(|_| !self.is_sure)?;
        Some((line, CellFault::Grouped(text)))
    }

    /// What to say of decimals that are written with a comma.
    pub fn note(&self) -> Option<String> {
        self.marks[1].map(|_| "decimals are written with a comma: 0,1 is read as 0.1".to_owned())
    }
}

/// Whether a line holds characters that cannot be seen; a tab is allowed, because it separates cells.
pub fn is_unprintable(line: &str) -> bool {
    line.chars().any(|c| c != '\t' && is_unsafe(c))
}

/// What separates the cells of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Separator {
    /// One character.
    Character(char),
    /// Any run of spaces.
    Spaces,
    /// Two spaces or more, for names that contain spaces themselves.
    Wide,
    /// A comma and a space, for lines in which commas without a space belong to numbers.
    CommaSpace,
}

impl Separator {
    /// The separator that a line shows.
    pub fn of(line: &str) -> Self {
        [';', '\t', ','].into_iter().find(|c| line.contains(*c)).map_or(Self::Spaces, Self::Character)
    }

    /// The cells of a row. Text in quotation marks is not split.
    pub fn cells(self, line: &str) -> Vec<&str> {
        match self {
            Self::Character(c) if line.contains('"') => quoted(line, |at| at == c),
            Self::Character(c) => line.split(c).map(bare).collect(),
            Self::Spaces if line.contains('"') => {
                quoted(line, char::is_whitespace).into_iter().filter(|cell| !cell.is_empty()).collect()
            }
            Self::Spaces => line.split_whitespace().map(bare).collect(),
            Self::Wide => line.split("  ").map(bare).filter(|cell| !cell.is_empty()).collect(),
            Self::CommaSpace => line.split(", ").map(bare).collect(),
        }
    }
}

/// The cells of a line with quotation marks.
fn quoted(line: &str, parts: impl Fn(char) -> bool) -> Vec<&str> {
    let mut is_open = false;
    let parting = |c: char| {
        is_open ^= c == '"';
        !is_open && parts(c)
    };
    line.split(parting).map(bare).collect()
}

/// A cell without the spaces and the quotation marks around it.
pub fn bare(cell: &str) -> &str {
    let cell = cell.trim();
    cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')).map_or(cell, str::trim)
}

/// The text of a remark.
pub fn remark(line: &str) -> Option<&str> {
    ["#", "%", "//"].into_iter().find_map(|mark| line.strip_prefix(mark))
}

/// Whether a line before the first row is a header: no cell of it is a number, and it does not begin like one.
pub fn is_header(line: &str) -> bool {
    let cells = Separator::of(line).cells(line);
    cells.iter().any(|cell| cell.chars().any(char::is_alphabetic))
        && cells.iter().all(|cell| cell.parse::<f64>().is_err())
        && !line.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
}

/// A column as given in a header: its name, and its unit as written.
pub type ColumnHead = (String, Option<String>);

/// The columns of a header. A unit stands in brackets or parentheses, or, if its dimension is one of `dimensions`,
/// after a slash or a space.
///
/// Text in brackets or quotation marks is not split; that in brackets belongs to the cell before it.
pub fn heads(line: &str, separator: Separator, dimensions: &[Dimension]) -> Vec<ColumnHead> {
    let mut cells: Vec<ColumnHead> = Vec::new();
    let mut at: ColumnHead = Default::default();
    let mut open: Option<(char, String)> = None;
    let is_unit = |unit: &str| Unit::parse(unit, 0).is_ok_and(|unit| dimensions.contains(&unit.dimension()));
    let (has_pairs, mut is_quoted) = (line.matches('"').count().is_multiple_of(2), false);
    for c in line.chars() {
        // Inches stand behind a number, a quotation mark before a cell.
        if c == '"' && has_pairs && (is_quoted || at.0.trim().is_empty()) {
            is_quoted = !is_quoted;
        }
        match (&mut open, separator) {
            (Some((close, unit)), _) if c == *close => {
                let unit = unit.trim().to_owned();
                open = None;
                // Spaces between a name and its unit have started one cell too many.
                if separator == Separator::Spaces
                    && at.0.is_empty()
                    && let Some(before) = cells.pop()
                {
                    at = before;
                }
                // Of two texts one is the unit, and the other a remark, which only matters if it is a factor.
                let is_remark = at.1.as_deref().is_some_and(is_unit) && !is_unit(&unit);
                let new = Some(unit).filter(|unit| !unit.is_empty());
                let old = at.1.take();
                let (unit, remark) = if is_remark { (old, new) } else { (new, old) };
                at.1 = unit;
                match remark {
                    Some(factor) if has_factor(&factor) => at.0 = format!("{} {factor}", at.0),
                    // The tenth column may be numbered.
                    Some(factor) if is_power_of_ten(&factor) && factor != "10" => {
                        at.0 = format!("{} × {factor}", at.0.trim_end());
                    }
                    _ => {}
                }
            }
            (Some((_, unit)), _) => unit.push(c),
            (None, _) if c == '[' || c == '(' => {
                open = Some((if c == '[' { ']' } else { ')' }, String::new()));
            }
            (None, Separator::Character(parting)) if c == parting && is_quoted => at.0.push(' '),
            (None, Separator::Character(parting)) if c == parting => cells.push(std::mem::take(&mut at)),
            (None, Separator::Spaces) if c.is_whitespace() => {
                if !(at.0.is_empty() && at.1.is_none()) {
                    cells.push(std::mem::take(&mut at));
                }
            }
            (None, Separator::CommaSpace) if c == ',' => cells.push(std::mem::take(&mut at)),
            (None, _) => at.0.push(c),
        }
    }
    cells.push(at);
    if separator == Separator::Spaces {
        cells.retain(|(name, unit)| !name.is_empty() || unit.is_some());
    }
    let apart = |(name, unit): ColumnHead| match unit {
        Some(unit) => (bare(&name).to_owned(), Some(unit)),
        None => unbracketed(bare(&name), dimensions),
    };
    cells.into_iter().map(apart).collect()
}

/// A name with its unit after a slash or a space, if the unit's dimension is one of `dimensions`: `r / um`,
/// `height nm`.
///
/// Any other word there may mean anything: `r/R` is a ratio. The factor of a unit stays with it, so that nobody takes the
/// unit alone for that of the column.
fn unbracketed(text: &str, dimensions: &[Dimension]) -> ColumnHead {
    let is_unit = |unit: &str| Unit::parse(unit, 0).is_ok_and(|unit| dimensions.contains(&unit.dimension()));
    let ways = [text.rsplit_once('/'), text.rsplit_once(char::is_whitespace)];
    let mut ways = ways.into_iter().flatten().map(|(name, unit)| (name.trim(), unit.trim()));
    let found = ways.find(|(name, unit)| !name.is_empty() && (is_unit(unit) || is_multiple(unit, is_unit)));
    let Some((name, unit)) = found else { return (text.to_owned(), None) };
    match name.rsplit_once(char::is_whitespace) {
        // Behind several words it is the number of a channel.
        Some((word, factor)) if is_power_of_ten(factor) && !word.contains(char::is_whitespace) => {
            (word.to_owned(), Some(format!("{factor} {unit}")))
        }
        _ => (name.to_owned(), Some(unit.to_owned())),
    }
}

/// Whether a word is a power of ten, as a factor before a unit. A smaller number is that of a channel.
fn is_power_of_ten(word: &str) -> bool {
    let number = word.trim_start_matches(['x', '×', '*', '·']);
    let is_begun = number.starts_with("10") || number.starts_with("0.");
    number.contains('^')
        || is_begun && number.matches('1').count() == 1 && number.chars().all(|c| "01.".contains(c))
}

/// Whether text is a multiple of a unit, such as `10 mN`, `10^-3 N` or `N/1000`, or the factor of one. A number behind a
/// unit, without a sign of multiplication, is that of a column.
pub fn is_multiple(text: &str, is_unit: impl Fn(&str) -> bool) -> bool {
    let is_of_factor = |c: char| c.is_ascii_digit() || " .^+-*·×()".contains(c);
    let has_digit = |text: &str| text.contains(|c: char| c.is_ascii_digit());
    let rest = text.trim_start_matches(is_of_factor);
    if rest.is_empty() {
        return has_digit(text) && text.contains(['^', '*', '×']);
    }
    if has_digit(&text[..text.len() - rest.len()]) && is_unit(rest) {
        return true;
    }
    let behind = text.trim_end_matches(|c: char| is_of_factor(c) || c == '/').trim_end();
    let factor = &text[behind.len()..];
    has_digit(factor) && factor.contains(['^', '*', '·', '×', '/']) && is_unit(behind)
}

/// Whether a name has a factor in it: `Force × 1000`, `Force*10`, `Force 10^3`, `Force /10`.
pub fn has_factor(name: &str) -> bool {
    let (is_digit, signs) = (|c: char| c.is_ascii_digit(), ['*', '·', '×']);
    let beside = |(before, behind): (&str, &str)| {
        behind.trim_start().starts_with(is_digit) || before.trim_end().ends_with(is_digit)
    };
    // Between two numbers a slash makes a date, or counts samples.
    let divides = |(before, divisor): (&str, &str)| {
        !before.trim_end().ends_with(is_digit)
            && divisor.trim_start().starts_with(is_digit)
            && is_power_of_ten(divisor.trim())
    };
    name.contains("10^")
        || name.rsplit_once('/').is_some_and(divides)
        || signs.iter().any(|sign| name.split_once(*sign).is_some_and(beside))
}
