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

use super::role::{Place, Role, Said, Segment, Spec, SpecError, dimensions, unit_of};
use crate::cells::{
    self, CellFault, Faults, Head, LARGEST_NUMBER, LONGEST_LINE, LineFault, Separator, heads, is_header,
    is_unprintable, remark,
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
    /// Of the line as a whole.
    #[error(transparent)]
    Line(#[from] LineFault),
    /// Another number of cells than the first row.
    #[error("has {found} cells, and the first row has {expected}")]
    Cells {
        /// How many it has.
        found: usize,
        /// How many are expected.
        expected: usize,
    },
    /// Of one cell.
    #[error("column {number}: {fault}")]
    Cell {
        /// The column, from 1.
        number: usize,
        /// What is wrong.
        fault: CellFault,
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

/// How rows are taken apart, as the first of them shows.
struct Layout {
    separator: Separator,
    cells: usize,
    wanted: Vec<Wanted>,
}

/// A file on its way to columns: what the lines so far have said.
#[derive(Default)]
struct Reader<'a> {
    header: Option<(usize, &'a str)>,
    /// A remark that may be the header.
    candidate: Option<(usize, &'a str)>,
    metadata: Metadata,
    layout: Option<Layout>,
    rows: usize,
    measured: Measured,
}

/// Reads the curve in `bytes`, the content of a file, with what a person says of its columns.
///
/// # Errors
/// [`ReadError`] with the lines that are wrong.
pub fn parse(bytes: &[u8], spec: &Spec) -> Result<Measured, ReadError> {
    let text = cells::text_of(bytes).map_err(ReadError::NotText)?;
    let mut faults = Faults::default();
    let mut reader = Reader::default();
    for (line, text) in text.lines().enumerate().map(|(i, text)| (i + 1, text.trim())) {
        if let Some(fault) = reader.takes(spec, line, text)? {
            faults.add(line, fault);
        }
    }
    if faults.total > 0 {
        return Err(ReadError::Faults(faults));
    }
    if !ROW_RANGE.contains(&reader.rows) {
        return Err(ReadError::Rows(reader.rows));
    }
    reader.measured.stiffness = reader.metadata.stiffness();
    Ok(reader.measured)
}

impl<'a> Reader<'a> {
    /// Takes a line in; answers with what is wrong with it, and fails where there is no use in reading on.
    fn takes(&mut self, spec: &Spec, line: usize, text: &'a str) -> Result<Option<Fault>, ReadError> {
        if text.is_empty() {
            return Ok(None);
        }
        if is_unprintable(text) {
            return Ok(Some(LineFault::Unprintable.into()));
        }
        if let Some(remark) = remark(text) {
            if self.layout.is_none() && !self.metadata.takes(remark) {
                self.candidate = Some((line, remark.trim()));
            }
            return Ok(None);
        }
        if text.len() > LONGEST_LINE {
            return Ok(Some(LineFault::Long(text.len()).into()));
        }
        if self.layout.is_none() && self.header.is_none() && is_header(text) {
            self.header = Some((line, text));
            return Ok(None);
        }
        if self.layout.is_none() {
            self.layout = Some(self.lay_out(spec, line, text)?);
        }
        self.rows += 1;
        if self.rows > *ROW_RANGE.end() {
            return Err(ReadError::Rows(self.rows));
        }
        let layout = self.layout.as_ref();
        Ok(layout.and_then(|layout| row(text, layout, &mut self.measured).err()))
    }

    /// What the first row, in `line`, and the header above it say of the columns; makes them.
    fn lay_out(&mut self, spec: &Spec, line: usize, text: &str) -> Result<Layout, ReadError> {
        let separator = Separator::of(text);
        let cells = separator.cells(text).len();
        if cells > MOST_COLUMNS {
            return Err(ReadError::ManyColumns { line, found: cells });
        }
        let header = headed(self.header, self.candidate, separator, cells);
        self.measured.header = header.as_ref().map(|header| header.line);
        let mut wanted = wanted(spec, header.as_ref(), line, cells, &mut self.measured.notes)?;
        if self.metadata.found {
            in_si(&mut wanted);
        }
        for column in wanted.iter().filter(|column| column.role != Role::Segment) {
            let (role, unit) = (column.role, column.unit.clone());
            let number = column.at + 1;
            self.measured.columns.push(Column {
                role,
                number,
                unit,
                values: Vec::new(),
                step: f64::INFINITY,
            });
        }
        if wanted.iter().any(|column| column.role == Role::Segment) {
            self.measured.segments = Some(Vec::new());
        }
        Ok(Layout { separator, cells, wanted })
    }
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

/// Which columns are used, in a file whose first row is in the line `row`.
fn wanted(
    spec: &Spec,
    header: Option<&Header>,
    row: usize,
    cells: usize,
    notes: &mut Vec<String>,
) -> Result<Vec<Wanted>, ReadError> {
    let line = header.map_or(row, |header| header.line);
    let known = || header.map_or_else(String::new, |header| listed(&header.heads));
    let wanted = match header {
        _ if !spec.0.is_empty() => of_person(spec, header, line, cells)?,
        Some(header) => of_header(header, notes)?,
        None if cells == 2 => {
            notes.push(
                "there is no header: the first column is taken for the approach, the second for the force"
                    .to_owned(),
            );
            let of = |(at, role)| Wanted { role, at, unit: None };
            [(0, Role::Approach), (1, Role::Force)].map(of).into()
        }
        None => Vec::new(),
    };
    if wanted.is_empty() {
        return Err(ReadError::Unknown { line, cells, names: known() });
    }
    let has = |role| wanted.iter().any(|column: &Wanted| column.role == role);
    let lacks = |missing| Err(ReadError::Lacks { line, missing, known: known() });
    if !(has(Role::Force) || has(Role::Deflection)) {
        return lacks("force, or of the deflection");
    }
    if !(has(Role::Approach) || has(Role::Position) || has(Role::Radius)) {
        return lacks("approach, of the position or of the contact radius");
    }
    Ok(wanted)
}

/// The unit that a header names for the column `at`, of the role `role`.
fn unit_in(header: &Header, at: usize, role: Role) -> Result<Option<Unit>, ReadError> {
    let text = header.heads.get(at).and_then(|head| head.1.as_deref());
    text.map(|text| unit_of(role, text))
        .transpose()
        .map_err(|cause| ReadError::Unit { line: header.line, cause })
}

/// The columns that a person names.
fn of_person(
    spec: &Spec,
    header: Option<&Header>,
    line: usize,
    cells: usize,
) -> Result<Vec<Wanted>, ReadError> {
    let column = |said: &Said| {
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
            let known = header.map_or_else(String::new, |header| listed(&header.heads));
            return Err(ReadError::NoColumn { line, place, known });
        };
        let unit = match (&said.unit, header) {
            (Some(unit), _) => Some(unit.clone()),
            (None, Some(header)) => unit_in(header, at, said.role)?,
            (None, None) => None,
        };
        Ok(Wanted { role: said.role, at, unit })
    };
    spec.0.iter().map(column).collect()
}

/// The columns whose names in the header are known.
fn of_header(header: &Header, notes: &mut Vec<String>) -> Result<Vec<Wanted>, ReadError> {
    let mut wanted: Vec<Wanted> = Vec::new();
    for (at, (name, _)) in header.heads.iter().enumerate() {
        let Some(role) = Role::of(name) else { continue };
        let Some(known) = wanted.iter_mut().find(|column| column.role == role) else {
            wanted.push(Wanted { role, at, unit: None });
            continue;
        };
        // Of two heights that of the sensor is the one that was reached.
        let better = name.to_lowercase().contains("measured");
        let (taken, left) = if better { (at, known.at) } else { (known.at, at) };
        known.at = taken;
        notes.push(format!(
            "columns {} and {} are both a {}: the {} is read, the other left out",
            taken.min(left) + 1,
            taken.max(left) + 1,
            role.word(),
            if taken < left { "first" } else { "second" }
        ));
    }
    for column in &mut wanted {
        column.unit = unit_in(header, column.at, column.role)?;
    }
    Ok(wanted)
}

/// Gives columns without a unit that of SI.
fn in_si(wanted: &mut [Wanted]) {
    for column in wanted.iter_mut().filter(|column| column.unit.is_none()) {
        let si = column.role.quantity().and_then(crate::units::Quantity::si);
        column.unit = si.and_then(|si| Unit::parse(si, 0).ok());
    }
}

/// The names of a header, safe to show.
fn listed(heads: &[Head]) -> String {
    let names: Vec<String> = heads.iter().map(|(name, _)| format!("\"{}\"", quote(name))).collect();
    sanitize(&names.join(", "), 200)
}

/// Takes a row in, up to its first fault.
fn row(text: &str, layout: &Layout, measured: &mut Measured) -> Result<(), Fault> {
    let cells = layout.separator.cells(text);
    if cells.len() != layout.cells {
        return Err(Fault::Cells { found: cells.len(), expected: layout.cells });
    }
    let mut columns = measured.columns.iter_mut();
    for want in &layout.wanted {
        let number = want.at + 1;
        let text = cells.get(want.at).copied().unwrap_or_default();
        let what = want.role.word();
        if want.role == Role::Segment {
            let known = |text| Segment::of(text).ok_or_else(|| Fault::Segment { number, text: quote(text) });
            let missing = Fault::Cell { number, fault: CellFault::Missing(what) };
            let segment = if text.is_empty() { Err(missing) } else { known(text) };
            measured.segments.get_or_insert_default().push(segment?);
        } else if let Some(column) = columns.next() {
            let value = cells::number(text, what).map_err(|fault| Fault::Cell { number, fault })?;
            column.values.push(value);
            column.step = column.step.min(last_digit(text));
        }
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
