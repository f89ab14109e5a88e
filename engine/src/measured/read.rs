//! The text of a measured curve → its columns.
//!
//! ```text
//! # any remark                       lines beginning with #, % or // are remarks, empty lines nothing
//! delta [um], force (nN), segment    a header before the first row, or as the last remark above it; units as in profiles
//! 0.10, -3.2, approach               cells parted by semicolons, tabs, commas or spaces: what the first row shows
//! ```
//!
//! The `.tab` files of afmformats have a block of JSON in their remarks, from which the spring constant is taken; their columns
//! are in SI (A. Müller et al., afmformats, github.com/AFM-analysis/afmformats, `formats/fmt_tab.py`).
//! Every fault is told with its line and its column, the first of them; a file with faults gives no curve.

use super::role::{Place, Role, Segment, Spec, SpecError, dimensions, unit_of};
use crate::cells::{
    self, Faults, Head, LARGEST_NUMBER, LONGEST_LINE, Separator, heads, is_header, is_unprintable, remark,
};
use crate::text::{quote, sanitize};
use crate::units::Unit;
use std::ops::RangeInclusive;
use thiserror::Error;

/// The allowed numbers of rows.
pub const ROW_RANGE: RangeInclusive<usize> = 8..=1_000_000;
/// The most columns of a file.
const MOST_COLUMNS: usize = 64;
/// The longest block of metadata that is read, in bytes.
const LONGEST_METADATA: usize = 1 << 20;

/// One column that is used.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// What it is.
    pub role: Role,
    /// Its number in the file, from 1.
    pub number: usize,
    /// Its unit, where the file or a person names one.
    pub unit: Option<Unit>,
    /// Its values, in that unit.
    pub values: Vec<f64>,
    /// The place of the last digit of its numbers, in that unit: they are known no better.
    pub step: f64,
}

/// A measured curve as read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measured {
    /// The columns of numbers that are used.
    pub columns: Vec<Column>,
    /// The branch of each row, where a column says it.
    pub segments: Option<Vec<Segment>>,
    /// The stiffness of the device that the file states, N/m.
    pub stiffness: Option<f64>,
    /// The line of the header, from 1.
    pub header: Option<usize>,
    /// What was assumed, in words.
    pub notes: Vec<String>,
}

/// What is wrong with one line.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Fault {
    /// The line is far too long.
    #[error("has {0} bytes, more than the {LONGEST_LINE} of a row")]
    Long(usize),
    /// Characters that are not for the eye.
    #[error("holds control or invisible characters")]
    Unprintable,
    /// Another number of cells than the first row.
    #[error("has {found} cells, and the first row has {expected}")]
    Cells {
        /// How many it has.
        found: usize,
        /// How many are expected.
        expected: usize,
    },
    /// An empty cell.
    #[error("column {number}: the {what} is missing")]
    Missing {
        /// The column, from 1.
        number: usize,
        /// What it holds.
        what: &'static str,
    },
    /// Not a number.
    #[error("column {number}: the {what} \"{text}\" is no number{}", if text.contains(',') { " (decimals have a point)" } else { "" })]
    Number {
        /// The column, from 1.
        number: usize,
        /// What it holds.
        what: &'static str,
        /// Its text, safe to show.
        text: String,
    },
    /// Not finite, or absurdly large.
    #[error(
        "column {number}: the {what} \"{text}\" is out of range: it must be a number from -{LARGEST_NUMBER:e} to \
         {LARGEST_NUMBER:e}"
    )]
    Range {
        /// The column, from 1.
        number: usize,
        /// What it holds.
        what: &'static str,
        /// Its text, safe to show.
        text: String,
    },
    /// A branch that is not known.
    #[error(
        "column {number}: the segment \"{text}\" is not known: expected approach or retraction, or False or True"
    )]
    Segment {
        /// The column, from 1.
        number: usize,
        /// Its text, safe to show.
        text: String,
    },
}

/// Why a text gives no curve.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ReadError {
    /// Bytes that are no text.
    #[error("line {0}: is not UTF-8 text")]
    NotText(usize),
    /// Lines with faults.
    #[error("{0}")]
    Faults(Faults<Fault>),
    /// Too few or too many rows.
    #[error("has {0} rows, and a measured curve has {lo} to {hi}", lo = ROW_RANGE.start(), hi = ROW_RANGE.end())]
    Rows(usize),
    /// More columns than anybody measures.
    #[error("line {line}: has {found} columns; at most {MOST_COLUMNS} are read")]
    ManyColumns {
        /// The first row.
        line: usize,
        /// How many it has.
        found: usize,
    },
    /// The header does not say what the columns are, nor does a person.
    #[error(
        "line {line}: {} say what they are, as in --columns x=1,force=2",
        if names.is_empty() { format!("{cells} columns without a header;") } else { format!("the columns {names} are not known;") }
    )]
    Unknown {
        /// The header, or the first row.
        line: usize,
        /// The number of columns.
        cells: usize,
        /// The names of the header, safe to show.
        names: String,
    },
    /// A column that is needed is not there.
    #[error("line {line}: there is no column of the {missing}{}", if known.is_empty() { String::new() } else { format!("; there is {known}") })]
    Lacks {
        /// The header, or the first row.
        line: usize,
        /// What is missing.
        missing: &'static str,
        /// What there is, safe to show.
        known: String,
    },
    /// A column that a person names is not there.
    #[error("line {line}: there is no column {place}{}", if known.is_empty() { String::new() } else { format!("; there is {known}") })]
    NoColumn {
        /// The header, or the first row.
        line: usize,
        /// What was asked for, safe to show.
        place: String,
        /// What there is, safe to show.
        known: String,
    },
    /// A unit in the header that is none of its quantity.
    #[error("line {line}: {cause}")]
    Unit {
        /// The header.
        line: usize,
        /// What is wrong.
        cause: SpecError,
    },
}

/// A column that is looked for in each row.
struct Wanted {
    role: Role,
    at: usize,
    unit: Option<Unit>,
}

/// A header: the names and units of the columns.
struct Header {
    line: usize,
    heads: Vec<Head>,
}

/// Reads the curve in `bytes`, the content of a file, with what a person says of its columns.
///
/// # Errors
/// [`ReadError`] with the lines that are wrong.
pub fn parse(bytes: &[u8], spec: &Spec) -> Result<Measured, ReadError> {
    let text = cells::text_of(bytes).map_err(ReadError::NotText)?;
    let mut faults = Faults::default();
    let mut measured = Measured::default();
    // Lines with their numbers: the header, and a remark that may be one.
    let mut header: Option<(usize, &str)> = None;
    let mut candidate: Option<(usize, &str)> = None;
    let mut metadata = Metadata::default();
    let mut layout: Option<(Separator, usize, Vec<Wanted>)> = None;
    let mut rows = 0;
    for (line, text) in text.lines().enumerate().map(|(i, text)| (i + 1, text.trim_end_matches('\r'))) {
        // A trailing tab is an empty cell; a leading one is not there in files of ours.
        let trimmed = text.trim();
        if trimmed.is_empty() {
            continue;
        }
        if is_unprintable(trimmed) {
            faults.add(line, Fault::Unprintable);
            continue;
        }
        if let Some(remark) = remark(trimmed) {
            if layout.is_none() && !metadata.takes(remark) {
                candidate = Some((line, remark.trim()));
            }
            continue;
        }
        if trimmed.len() > LONGEST_LINE {
            faults.add(line, Fault::Long(trimmed.len()));
            continue;
        }
        if layout.is_none() && header.is_none() && is_header(trimmed) {
            header = Some((line, trimmed));
            continue;
        }
        if layout.is_none() {
            let separator = Separator::of(trimmed);
            let cells = separator.cells(trimmed).len();
            if cells > MOST_COLUMNS {
                return Err(ReadError::ManyColumns { line, found: cells });
            }
            let header = headed(header, candidate, separator, cells);
            measured.header = header.as_ref().map(|header| header.line);
            let wanted = wanted(spec, header.as_ref(), line, cells, metadata.found, &mut measured.notes)?;
            for column in wanted.iter().filter(|column| column.role != Role::Segment) {
                let (role, unit) = (column.role, column.unit.clone());
                let number = column.at + 1;
                measured.columns.push(Column { role, number, unit, values: Vec::new(), step: f64::INFINITY });
            }
            if wanted.iter().any(|column| column.role == Role::Segment) {
                measured.segments = Some(Vec::new());
            }
            layout = Some((separator, cells, wanted));
        }
        if let Some((separator, cells, wanted)) = &layout {
            rows += 1;
            if let Err(fault) = row(trimmed, *separator, *cells, wanted, &mut measured) {
                faults.add(line, fault);
            }
            if rows > *ROW_RANGE.end() {
                return Err(ReadError::Rows(rows));
            }
        }
    }
    if faults.total > 0 {
        return Err(ReadError::Faults(faults));
    }
    if !ROW_RANGE.contains(&rows) {
        return Err(ReadError::Rows(rows));
    }
    measured.stiffness = metadata.stiffness();
    Ok(measured)
}

/// The block of JSON in the remarks of an afmformats file.
#[derive(Default)]
struct Metadata {
    inside: bool,
    found: bool,
    text: String,
}

impl Metadata {
    /// Whether the remark belongs to the block.
    fn takes(&mut self, remark: &str) -> bool {
        let text = remark.trim();
        if text.starts_with("BEGIN METADATA") {
            (self.inside, self.found) = (true, true);
            return true;
        }
        if text.starts_with("END METADATA") {
            self.inside = false;
            return true;
        }
        if self.inside && self.text.len() + text.len() <= LONGEST_METADATA {
            self.text.push_str(text);
            self.text.push('\n');
        }
        self.inside
    }

    /// The spring constant in N/m, where there is a positive one.
    fn stiffness(&self) -> Option<f64> {
        let value: serde_json::Value = serde_json::from_str(&self.text).ok()?;
        value.get("spring constant")?.as_f64().filter(|k| *k > 0.0 && *k <= LARGEST_NUMBER)
    }
}

/// The header: a line of its own, or the last remark above the rows where it has as many cells as they.
fn headed(
    header: Option<(usize, &str)>,
    candidate: Option<(usize, &str)>,
    separator: Separator,
    cells: usize,
) -> Option<Header> {
    // A header may be parted otherwise than the rows below it.
    let read = |(line, text): (usize, &str)| {
        let of = |separator| Some(heads(text, separator, &dimensions())).filter(|heads| heads.len() == cells);
        let heads = of(separator).or_else(|| of(Separator::of(text)))?;
        Some(Header { line, heads: heads.into_iter().map(whole).collect() })
    };
    header.and_then(read).or_else(|| {
        let header = candidate.and_then(read)?;
        // A remark of the right number of words need not be a header.
        let known = header.heads.iter().filter(|(name, _)| Role::of(name).is_some()).count();
        (known >= 2).then_some(header)
    })
}

/// What stands in parentheses and is no unit belongs to the name: `height (measured)`.
fn whole((name, unit): Head) -> Head {
    match unit {
        Some(text) if Unit::parse(&text, 0).is_err() => {
            let longer = format!("{name} {text}");
            if Role::of(&longer).is_some() || Role::of(&name).is_none() {
                (longer, None)
            } else {
                (name, Some(text))
            }
        }
        unit => (name, unit),
    }
}

/// Which columns are used.
fn wanted(
    spec: &Spec,
    header: Option<&Header>,
    row: usize,
    cells: usize,
    is_tab: bool,
    notes: &mut Vec<String>,
) -> Result<Vec<Wanted>, ReadError> {
    let line = header.map_or(row, |header| header.line);
    let names = || header.map_or_else(String::new, |header| listed(&header.heads));
    let mut wanted: Vec<Wanted> = Vec::new();
    let of_header = |at: usize, role: Role| -> Result<Option<Unit>, ReadError> {
        let text = header.and_then(|header| header.heads.get(at)?.1.as_deref());
        text.map(|text| unit_of(role, text)).transpose().map_err(|cause| ReadError::Unit { line, cause })
    };
    for said in &spec.0 {
        let at = match &said.place {
            Place::Number(number) => Some(number - 1).filter(|at| *at < cells),
            Place::Name(name) => header.and_then(|header| {
                header.heads.iter().position(|(known, _)| known.eq_ignore_ascii_case(name))
            }),
        };
        let Some(at) = at else {
            let place = match &said.place {
                Place::Number(number) => format!("{number}: a row has {cells}"),
                Place::Name(name) => format!("\"{}\"", quote(name)),
            };
            return Err(ReadError::NoColumn { line, place, known: names() });
        };
        let unit = match &said.unit {
            Some(unit) => Some(unit.clone()),
            None => of_header(at, said.role)?,
        };
        wanted.push(Wanted { role: said.role, at, unit });
    }
    if let (Some(header), true) = (header, spec.0.is_empty()) {
        for (at, (name, _)) in header.heads.iter().enumerate() {
            let Some(role) = Role::of(name) else { continue };
            if let Some(known) = wanted.iter_mut().find(|column| column.role == role) {
                // Of two heights that of the sensor is the one that was reached.
                let better = name.to_lowercase().contains("measured");
                let (taken, left) = if better { (at, known.at) } else { (known.at, at) };
                known.at = taken;
                notes.push(format!(
                    "columns {} and {} are both a {}: the {} is read, the other left out",
                    known.at.min(left) + 1,
                    known.at.max(left) + 1,
                    role.word(),
                    if taken < left { "first" } else { "second" }
                ));
                continue;
            }
            wanted.push(Wanted { role, at, unit: None });
        }
        for column in &mut wanted {
            column.unit = of_header(column.at, column.role)?;
        }
    } else if spec.0.is_empty() && cells == 2 {
        notes.push(
            "there is no header: the first column is taken for the approach, the second for the force"
                .to_owned(),
        );
        wanted = vec![
            Wanted { role: Role::Approach, at: 0, unit: None },
            Wanted { role: Role::Force, at: 1, unit: None },
        ];
    } else if spec.0.is_empty() {
        return Err(ReadError::Unknown { line, cells, names: String::new() });
    }
    if wanted.is_empty() {
        return Err(ReadError::Unknown { line, cells, names: names() });
    }
    if is_tab {
        for column in wanted.iter_mut().filter(|column| column.unit.is_none()) {
            let si = column.role.quantity().and_then(crate::units::Quantity::si);
            column.unit = si.and_then(|si| Unit::parse(si, 0).ok());
        }
    }
    let has = |role| wanted.iter().any(|column: &Wanted| column.role == role);
    let lacks = |missing| Err(ReadError::Lacks { line, missing, known: names() });
    if !(has(Role::Force) || has(Role::Deflection)) {
        return lacks("force, or of the deflection");
    }
    if !(has(Role::Approach) || has(Role::Position) || has(Role::Radius)) {
        return lacks("approach, of the position or of the contact radius");
    }
    Ok(wanted)
}

/// The names of a header, safe to show.
fn listed(heads: &[Head]) -> String {
    let names: Vec<String> = heads.iter().map(|(name, _)| format!("\"{}\"", quote(name))).collect();
    sanitize(&names.join(", "), 200)
}

/// Takes a row in, or leaves no trace of it.
fn row(
    text: &str,
    separator: Separator,
    expected: usize,
    wanted: &[Wanted],
    measured: &mut Measured,
) -> Result<(), Fault> {
    let cells = separator.cells(text);
    if cells.len() != expected {
        return Err(Fault::Cells { found: cells.len(), expected });
    }
    let mut column = 0;
    for want in wanted {
        let number = want.at + 1;
        let text = cells.get(want.at).copied().unwrap_or_default();
        let what = want.role.word();
        if text.is_empty() {
            return Err(Fault::Missing { number, what });
        }
        if want.role == Role::Segment {
            let segment = Segment::of(text).ok_or_else(|| Fault::Segment { number, text: quote(text) })?;
            measured.segments.get_or_insert_default().push(segment);
            continue;
        }
        let value: f64 = text.parse().map_err(|_| Fault::Number { number, what, text: quote(text) })?;
        // Not a number has no size.
        if !matches!(value.abs().partial_cmp(&LARGEST_NUMBER), Some(order) if order.is_le()) {
            return Err(Fault::Range { number, what, text: quote(text) });
        }
        if let Some(column) = measured.columns.get_mut(column) {
            column.values.push(value + 0.0);
            column.step = column.step.min(last_digit(text));
        }
        column += 1;
    }
    Ok(())
}

/// The place of the last digit of a number: 0.01 of 1.23, 1e-9 of 12e-9.
fn last_digit(text: &str) -> f64 {
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let exponent: i32 = exponent.parse().unwrap_or(0);
    10.0_f64.powi(exponent.saturating_sub(i32::try_from(decimals).unwrap_or(i32::MAX)).clamp(-300, 300))
}
