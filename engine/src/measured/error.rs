//! What is wrong with the text of a measured curve.

use super::role::{ColumnRole, ColumnSpecError};
use super::words::is_grouped;
use crate::cells::{CellFault, Faults, LineFault};
use crate::text::NotText;
use std::ops::RangeInclusive;
use thiserror::Error;

/// The allowed numbers of rows.
pub const ROW_RANGE: RangeInclusive<usize> = 8..=1_000_000;
/// The largest number of columns in a file.
pub const MOST_COLUMNS: usize = 64;
/// What is wrong with one line.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CurveFault {
    /// A fault of the line as a whole.
    #[error(transparent)]
    Line(#[from] LineFault),
    /// The number of cells differs from that of the first row.
    #[error("has {found} cells, and the first row has {expected}")]
    Cells {
        /// How many it has.
        found: usize,
        /// How many are expected.
        expected: usize,
    },
    /// A fault of one cell.
    #[error("column {number}: {fault}")]
    Cell {
        /// The column, from 1.
        number: usize,
        /// What is wrong.
        fault: CellFault,
    },
    /// A unit other than that of the same column in the tables before.
    #[error("column {number} is in {unit} here and in {before} before: write all tables in the same units")]
    Unit {
        /// The column, from 1.
        number: usize,
        /// Its unit.
        unit: String,
        /// Its unit before.
        before: String,
    },
    /// Decimals that may be thousands.
    #[error(transparent)]
    Decimals(CellFault),
    /// An unknown branch.
    #[error(
        "column {number}: the segment \"{text}\" is not known: expected approach or retraction, False or True, 0 or 1"
    )]
    Segment {
        /// The column, from 1.
        number: usize,
        /// Its text, safe to show.
        text: String,
    },
    /// Numbers for the branches whose meaning differs between instruments.
    #[error(
        "column {number}: which branches are numbered {numbers} is not known: 0 is an approach, 1 a retraction, and 2 a pause between \
         them. Write approach and retraction in the column, or leave it out by naming the others in --columns or \
         data.columns"
    )]
    Numbered {
        /// The column, from 1.
        number: usize,
        /// The numbers, in their order.
        numbers: String,
    },
}

/// Why a text yields no curve.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CurveReadError {
    /// Bytes that are not text.
    #[error(
        "{0}; a force curve in an instrument's own format can be read in Python with pulloff.read_afm(path), \
         or exported as text by its software"
    )]
    NotText(NotText),
    /// Lines that contain faults.
    #[error("{0}")]
    Faults(Faults<CurveFault>),
    /// Too few or too many rows.
    #[error(
        "has {rows} rows of numbers{}, and a measured curve has {lo} to {hi}",
        if *skipped > 0 { format!(" besides {skipped} without a number") } else { String::new() },
        lo = ROW_RANGE.start(),
        hi = ROW_RANGE.end()
    )]
    Rows {
        /// How many.
        rows: usize,
        /// How many further rows have no number.
        skipped: usize,
    },
    /// Commas that may separate cells, mark decimals, or both.
    #[error(
        "line {0}: some commas are followed by a space and some by a digit, and no header shows which \
         separate the columns: separate them by semicolons or tabs"
    )]
    Commas(usize),
    /// Waves of an Igor text file that are not columns of one table.
    #[error("its waves have {least} to {most} rows: export the waves of one curve only")]
    Waves {
        /// The number of rows of the shortest wave.
        least: usize,
        /// The number of rows of the longest wave.
        most: usize,
    },
    /// A column in volts or amperes.
    #[error(
        "line {line}: column {number}, \"{name}\", is the {} in {unit}, and the sensitivity of the detector is missing: export \
         it in nm, or as a force in nN",
        role.word()
    )]
    Signal {
        /// The header.
        line: usize,
        /// The column, from 1.
        number: usize,
        /// Its name, safe to show.
        name: String,
        /// Its unit, safe to show.
        unit: String,
        /// The role that its name indicates.
        role: ColumnRole,
    },
    /// More columns than any measurement has.
    #[error("line {line}: has {found} columns; at most {MOST_COLUMNS} are read")]
    ManyColumns {
        /// The first row.
        line: usize,
        /// How many it has.
        found: usize,
    },
    /// Neither the header nor the user says what the columns are.
    #[error(
        "line {line}: {} say what they are, as in --columns or data.columns \"approach=1,force=2\"",
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
    /// A row, in place of a header, in which not all cells are numbers.
    #[error(
        "line {line}: \"{text}\" is not a number, in a row of numbers{}",
        if is_grouped(text) { ": thousands must not be separated" } else { "" }
    )]
    NotNumber {
        /// The row.
        line: usize,
        /// The cell, safe to show.
        text: String,
    },
    /// Two columns of lengths.
    #[error(
        "line {line}: the columns {names} are lengths, like those of a profile: a profile belongs in \
         gap.file, with gap.shape=profile; for a measured curve, say what they are, as in --columns or data.columns \"approach=1,force=2\""
    )]
    Profile {
        /// The header.
        line: usize,
        /// The names of the header, safe to show.
        names: String,
    },
    /// A column that is needed is not there.
    #[error(
        "line {line}: there is no column for the {missing}{}",
        if known.is_empty() {
            String::new()
        } else {
            format!("; the columns are {known}: say what they are, as in --columns or data.columns \"approach=1,force=2\"")
        }
    )]
    Lacks {
        /// The header, or the first row.
        line: usize,
        /// What is missing.
        missing: &'static str,
        /// What there is, safe to show.
        known: String,
    },
    /// A column that the user names is missing.
    #[error(
        "line {line}: there is no column {place}{}",
        if known.is_empty() { String::new() } else { format!("; the columns are {known}") }
    )]
    NoColumn {
        /// The header, or the first row.
        line: usize,
        /// What was asked for, safe to show.
        place: String,
        /// What there is, safe to show.
        known: String,
    },
    /// A unit in the header does not fit its quantity.
    #[error("line {line}: {cause}")]
    Unit {
        /// The header.
        line: usize,
        /// What is wrong.
        cause: ColumnSpecError,
    },
}
