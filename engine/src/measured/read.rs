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

use super::error::{Fault, MOST_COLUMNS, ROW_RANGE, ReadError};
use super::header::{Header, Wanted, headed, in_si, is_units, sides, wanted};
use super::role::{Role, Segment, Spec};
use crate::cells::{
    self, CellFault, Faults, LARGEST_NUMBER, LONGEST_LINE, LineFault, Separator, is_header, is_unprintable,
    remark,
};
use crate::text::quote;
use crate::units::{Quantity, Unit};

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

/// How rows are taken apart, as the first of them shows.
struct Layout {
    separator: Separator,
    cells: usize,
    wanted: Vec<Wanted>,
    /// The columns of the retraction, where they stand beside those of the approach.
    beside: Vec<Wanted>,
}

/// A file on its way to columns: what the lines so far have said.
#[derive(Default)]
struct Reader<'a> {
    header: Option<(usize, &'a str)>,
    /// The line below it that has the units.
    units: Option<&'a str>,
    /// A remark that may be the header.
    candidate: Option<(usize, &'a str)>,
    metadata: Metadata,
    layout: Option<Layout>,
    rows: usize,
    measured: Measured,
    /// The retraction, where its columns stand beside those of the approach.
    beside: Measured,
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
    let mut measured = reader.measured;
    if !reader.beside.columns.is_empty() {
        measured.appends(&reader.beside);
    }
    measured.stiffness = reader.metadata.stiffness();
    Ok(measured)
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
        if self.layout.is_none() && self.metadata.takes_setting(text) {
            return Ok(None);
        }
        if self.layout.is_none() && is_header(text) {
            // The last line of words above the rows, and one with their units below it.
            if self.header.is_some() && is_units(text) {
                self.units = Some(text);
            } else {
                (self.header, self.units) = (Some((line, text)), None);
            }
            return Ok(None);
        }
        if self.layout.is_none() {
            self.layout = Some(self.lay_out(spec, line, text)?);
        }
        self.rows += 1;
        if self.rows > *ROW_RANGE.end() {
            return Err(ReadError::Rows(self.rows));
        }
        let Some(layout) = &self.layout else { return Ok(None) };
        let cells = layout.separator.cells(text);
        if cells.len() != layout.cells {
            return Ok(Some(Fault::Cells { found: cells.len(), expected: layout.cells }));
        }
        for (wanted, measured) in [(&layout.wanted, &mut self.measured), (&layout.beside, &mut self.beside)] {
            // Of two branches beside each other one may be shorter.
            let is_over = wanted.iter().all(|want| cells.get(want.at).is_none_or(|cell| cell.is_empty()));
            if (layout.beside.is_empty() || !is_over)
                && let Err(fault) = row(&cells, layout.separator, wanted, measured)
            {
                return Ok(Some(fault));
            }
        }
        Ok(None)
    }

    /// What the first row, in `line`, and the header above it say of the columns; makes them.
    fn lay_out(&mut self, spec: &Spec, line: usize, text: &str) -> Result<Layout, ReadError> {
        let separator = Separator::of(text);
        let cells = separator.cells(text).len();
        if cells > MOST_COLUMNS {
            return Err(ReadError::ManyColumns { line, found: cells });
        }
        let header = headed(self.header, self.units, self.candidate, separator, cells);
        self.measured.header = header.as_ref().map(|header| header.line);
        let (mut wanted, beside) = self.columns(spec, header.as_ref(), line, cells)?;
        if self.metadata.found {
            in_si(&mut wanted);
        }
        self.measured.begins(&wanted, (!beside.is_empty()).then_some(Segment::Approach));
        self.beside.begins(&beside, None);
        Ok(Layout { separator, cells, wanted, beside })
    }

    /// The columns that are used, and those of the retraction where they stand beside those of the approach.
    fn columns(
        &mut self,
        spec: &Spec,
        header: Option<&Header>,
        line: usize,
        cells: usize,
    ) -> Result<(Vec<Wanted>, Vec<Wanted>), ReadError> {
        let sides = header.filter(|_| spec.0.is_empty()).map(sides).transpose()?.flatten();
        let Some([approach, retraction]) = sides else {
            return Ok((wanted(spec, header, line, cells, &mut self.measured.notes)?, Vec::new()));
        };
        let listed = |side: &[Wanted]| {
            let numbers: Vec<String> = side.iter().map(|want| (want.at + 1).to_string()).collect();
            numbers.join(" and ")
        };
        self.measured.notes.push(format!(
            "columns {} are the approach, {} the retraction, whose rows are counted on from its own",
            listed(&approach),
            listed(&retraction)
        ));
        Ok((approach, retraction))
    }
}

impl Measured {
    /// Makes the columns; `all` is the branch of all rows, where no column says it.
    fn begins(&mut self, wanted: &[Wanted], all: Option<Segment>) {
        for column in wanted.iter().filter(|column| column.role != Role::Segment) {
            let (role, unit) = (column.role, column.unit.clone());
            let (number, values) = (column.at + 1, Vec::new());
            self.columns.push(Column { role, number, unit, values, step: f64::INFINITY });
        }
        if all.is_some() || wanted.iter().any(|column| column.role == Role::Segment) {
            self.segments = Some(Vec::new());
        }
    }

    /// Appends the rows of the retraction, whose columns are the same.
    fn appends(&mut self, retraction: &Self) {
        let rows = |of: &Self| of.columns.first().map_or(0, |column| column.values.len());
        let mut segments = vec![Segment::Approach; rows(self)];
        segments.resize(rows(self) + rows(retraction), Segment::Retraction);
        self.segments = Some(segments);
        for column in &mut self.columns {
            let Some(other) = retraction.columns.iter().find(|other| other.role == column.role) else {
                continue;
            };
            column.values.extend_from_slice(&other.values);
            column.step = column.step.min(other.step);
        }
    }
}

/// The block of JSON in the remarks of an afmformats file.
#[derive(Default)]
struct Metadata {
    inside: bool,
    found: bool,
    text: String,
    /// A stiffness on a line of its own.
    stated: Option<f64>,
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

    /// Whether a line above the rows is a setting, as in `Force Constant, nN/nm: 0.2`.
    fn takes_setting(&mut self, text: &str) -> bool {
        let Some((key, value)) = text.split_once(':') else { return false };
        let is_key = key.starts_with(char::is_alphabetic) && !key.contains(['\t', ';']);
        if !is_key || !(value.is_empty() || value.starts_with(char::is_whitespace)) {
            return false;
        }
        let lower = key.to_lowercase();
        if let (true, Some((_, unit))) = (
            ["force constant", "spring constant"].iter().any(|name| lower.starts_with(name)),
            key.split_once(','),
        ) {
            let unit = Unit::parse(unit.trim(), 0).ok();
            let unit = unit.filter(|unit| unit.dimension() == Quantity::ForcePerLength.dimension());
            let value: Option<f64> = value.trim().parse().ok();
            // 1 is what instruments write that have not been calibrated.
            let value = value.filter(|k| *k > 0.0 && *k <= LARGEST_NUMBER && k.total_cmp(&1.0).is_ne());
            self.stated = unit.zip(value).map(|(unit, value)| unit.to_si(value)).or(self.stated);
        }
        true
    }

    /// The spring constant in N/m, where there is a positive one.
    fn stiffness(&self) -> Option<f64> {
        if self.stated.is_some() {
            return self.stated;
        }
        let value: serde_json::Value = serde_json::from_str(&self.text).ok()?;
        value.get("spring constant")?.as_f64().filter(|k| *k > 0.0 && *k <= LARGEST_NUMBER)
    }
}

/// Takes a row in, up to its first fault.
fn row(
    cells: &[&str],
    separator: Separator,
    wanted: &[Wanted],
    measured: &mut Measured,
) -> Result<(), Fault> {
    const COMMAS: &str = "decimals have a comma: 0,1 is read as 0.1";
    let mut columns = measured.columns.iter_mut();
    for want in wanted {
        let number = want.at + 1;
        let text = cells.get(want.at).copied().unwrap_or_default();
        let what = want.role.word();
        if want.role == Role::Segment {
            let known = |text| Segment::of(text).ok_or_else(|| Fault::Segment { number, text: quote(text) });
            let missing = Fault::Cell { number, fault: CellFault::Missing(what) };
            let segment = if text.is_empty() { Err(missing) } else { known(text) };
            measured.segments.get_or_insert_default().push(segment?);
        } else if let Some(column) = columns.next() {
            // Where cells are parted otherwise.
            let has_comma = separator != Separator::Character(',')
                && text.matches(',').count() == 1
                && !text.contains('.');
            let pointed = if has_comma { text.replace(',', ".") } else { String::new() };
            if has_comma && measured.notes.iter().all(|note| note != COMMAS) {
                measured.notes.push(COMMAS.to_owned());
            }
            let text = if has_comma { &pointed } else { text };
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
