//! Reads a measured profile: two columns of text, radius and gap, from a file that nobody has checked.
//!
//! ```text
//! # any remark                     lines beginning with #, % or // are remarks, empty lines nothing
//! r [um], h (nm)                   one header before the first row, with the units in brackets, parentheses, or
//!                                  of length behind a slash or a space: r / um, h nm
//! 0.0, 0.00                        cells parted by semicolons, tabs, commas or spaces: what the first row shows,
//! 0.5, 0.13                        in this order; where no comma separates cells, one may
//!                                  mark the decimals
//! ```
//!
//! A header with a unit for one column and none for the other is refused. If there is no header, the last remark above
//! the first row serves as one, provided it has two cells and both name a unit. Rows may come in any order; a repeated
//! row counts once. Every other fault is reported with its line, the first [`FAULTS_SHOWN`] of them. A file with faults
//! yields no profile.
//!
//! The cells are separated as in any table from an instrument: [`cells`].

use crate::cells::{
    self, CellFault, ColumnHead, Decimals, LineFault, Separator, heads, is_header, is_unprintable, remark,
};
use crate::text::{NotText, decode, quote};
use crate::units::{Quantity, Unit};
use std::ops::RangeInclusive;
use thiserror::Error;

pub use crate::cells::{FAULTS_SHOWN, LARGEST, LARGEST_NUMBER, LONGEST_LINE};

/// The allowed numbers of rows: fewer are no profile, and more should be averaged first.
pub const ROW_RANGE: RangeInclusive<usize> = 8..=1_000_000;
/// A distance from the axis counts as one spacing up to this share: decimals are rounded.
const ROUNDED: f64 = 1e-6;

/// A profile as read: radii ascending from the axis, each once, and their gaps, in the units of the file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ProfileColumns {
    /// r.
    pub radii: Vec<f64>,
    /// h.
    pub gaps: Vec<f64>,
    /// The units of r and h as written in the header, without their brackets.
    pub units: [Option<String>; 2],
    /// The line of a header with units, from 1.
    pub header: Option<usize>,
    /// What was corrected, in words.
    pub notes: Vec<String>,
}

/// What is wrong with one line.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ProfileFault {
    /// A fault of the line as a whole.
    #[error(transparent)]
    Line(#[from] LineFault),
    /// A fault of one cell.
    #[error(transparent)]
    Cell(#[from] CellFault),
    /// The number of cells is not two.
    #[error("has {0} cells, and a row has two: radius and gap")]
    Cells(usize),
    /// A negative radius.
    #[error(
        "the radius {0:?} is negative: radii are measured from the axis, so first fold a scan over the whole \
         diameter there"
    )]
    Negative(f64),
    /// The first row is not at the axis.
    #[error(
        "the smallest radius is {first:?}, and the rows after it are at most {spacing:?} apart: measure the \
         centre too, or shift the radii so that they start there"
    )]
    Hollow {
        /// The smallest radius.
        first: f64,
        /// The largest distance of the first rows.
        spacing: f64,
    },
    /// A radius for which an earlier line gives another gap.
    #[error("the radius {radius:?} has a different gap in line {line}")]
    Twice {
        /// The radius.
        radius: f64,
        /// The earlier line.
        line: usize,
    },
}

/// The faults of a file, in the order of their lines.
pub type ProfileFaults = cells::Faults<ProfileFault>;

/// Why a text yields no profile.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TextError {
    /// Bytes that are not text.
    #[error("{0}")]
    NotText(NotText),
    /// Lines with faults.
    #[error("{0}")]
    Faults(ProfileFaults),
    /// The columns are swapped.
    #[error(
        "line {line}: the header names the gap \"{first}\" first and the radius \"{second}\" after it: a profile has \
         the radius first"
    )]
    Swapped {
        /// The line of the header.
        line: usize,
        /// The name of the gap.
        first: String,
        /// The name of the radius.
        second: String,
    },
    /// Too few or too many rows.
    #[error("has {0} rows, and a profile has {lo} to {hi}", lo = ROW_RANGE.start(), hi = ROW_RANGE.end())]
    Rows(usize),
    /// A unit that is not a length.
    #[error("line {line}: the unit \"{unit}\" of the {what} {}", .measures.as_ref().map_or_else(|| "is not known".to_owned(), |measures| format!("is {measures}, not a length")))]
    Unit {
        /// The line of the header.
        line: usize,
        /// Which column.
        what: &'static str,
        /// The unit, safe to show.
        unit: String,
        /// The quantity measured in it, if known.
        measures: Option<String>,
    },
    /// A unit for one column only.
    #[error(
        "line {line}: the header gives the {named} in {unit} but no unit for the {other}: write both, as in \
         r [um], h [nm]"
    )]
    OneUnit {
        /// The line of the header.
        line: usize,
        /// The column with a unit.
        named: &'static str,
        /// Its unit.
        unit: String,
        /// The column without.
        other: &'static str,
    },
}

/// The two columns, as messages call them.
const COLUMNS: [&str; 2] = ["radius", "gap"];

/// Names in a header that identify the radius.
const RADIUS_NAMES: &[&str] = &["r", "radius", "rho", "x", "distance", "position"];
/// Names that identify the gap.
const GAP_NAMES: &[&str] = &["h", "gap", "height", "z", "depth"];

impl ProfileColumns {
    /// The same with the gaps in the unit of the radii, and that unit, if the header names both.
    ///
    /// # Errors
    /// [`TextError::Unit`] for a unit that is not a length, [`TextError::OneUnit`] if only one column has one.
    pub fn in_one_unit(mut self) -> Result<(Self, Option<Unit>), TextError> {
        let line = self.header.unwrap_or(1);
        let mut units = [None, None];
        for ((unit, text), what) in units.iter_mut().zip(&self.units).zip(COLUMNS) {
            *unit = text.as_deref().map(|text| length(text, line, what)).transpose()?;
        }
        let one = |unit: &Unit, named, other| {
            Err(TextError::OneUnit { line, named: COLUMNS[named], unit: unit.ascii(), other: COLUMNS[other] })
        };
        match units {
            [None, None] => Ok((self, None)),
            [Some(unit), None] => one(&unit, 0, 1),
            [None, Some(unit)] => one(&unit, 1, 0),
            [Some(radius), Some(gap)] => {
                if radius != gap {
                    let factor = radius.from_si(gap.to_si(1.0));
                    for h in &mut self.gaps {
                        *h *= factor;
                    }
                }
                Ok((self, Some(radius)))
            }
        }
    }
}

/// The unit of length `text`, of the column `what` in the header in `line`.
fn length(text: &str, line: usize, what: &'static str) -> Result<Unit, TextError> {
    let unit = Unit::parse(text, 0).ok();
    let refused = |measures| TextError::Unit { line, what, unit: quote(text), measures };
    match unit {
        Some(unit) if unit.dimension() == Quantity::Length.dimension() => Ok(unit),
        Some(unit) => Err(refused(Some(unit.measures()))),
        None => Err(refused(None)),
    }
}

/// A row with its line.
#[derive(Debug, Clone, Copy)]
struct ProfileRow {
    line: usize,
    radius: f64,
    gap: f64,
}

/// Reads the profile in `bytes`, the content of a file.
///
/// # Errors
/// [`TextError`] with the faulty lines.
pub fn parse(bytes: &[u8]) -> Result<ProfileColumns, TextError> {
    let (text, note) = decode(bytes).map_err(TextError::NotText)?;
    let mut faults = ProfileFaults::default();
    let mut rows: Vec<ProfileRow> = Vec::new();
    let (mut separator, mut decimals) = (None, Decimals::default());
    // The header, or a remark that may serve as one.
    let (mut header, mut candidate) = (None, None);
    for (line, text) in text.lines().enumerate().map(|(i, text)| (i + 1, text.trim())) {
        if is_unprintable(text) {
            faults.add(line, LineFault::Unprintable.into());
            continue;
        }
        if text.is_empty() {
            continue;
        }
        if let Some(remark) = remark(text) {
            if separator.is_none() {
                candidate = Some((line, remark));
            }
            continue;
        }
        if text.len() > LONGEST_LINE {
            faults.add(line, LineFault::Long(text.len()).into());
            continue;
        }
        if separator.is_none() && header.is_none() && is_header(text) {
            header = Some((line, text));
            continue;
        }
        let separator = *separator.get_or_insert_with(|| Separator::of(text));
        match row(line, text, separator, &mut decimals) {
            Ok((radius, gap)) => rows.push(ProfileRow { line, radius, gap }),
            Err(fault) => faults.add(line, fault),
        }
    }
    let mut columns =
        ProfileColumns { notes: note.map(str::to_owned).into_iter().collect(), ..ProfileColumns::default() };
    if let Some(separator) = separator {
        (columns.header, columns.units) = units(header, candidate, separator)?;
    }
    columns.notes.extend(decimals.note());
    if let Some((line, fault)) = decimals.doubtful() {
        faults.add(line, fault.into());
    }
    gather(rows, &mut columns, &mut faults);
    if faults.total > 0 {
        return Err(TextError::Faults(faults));
    }
    if !ROW_RANGE.contains(&columns.radii.len()) {
        return Err(TextError::Rows(columns.radii.len()));
    }
    Ok(columns)
}

/// The units of the header and its line, if it has any; a remark counts only if it names both.
///
/// # Errors
/// [`TextError::Swapped`].
fn units(
    header: Option<(usize, &str)>,
    remark: Option<(usize, &str)>,
    separator: Separator,
) -> Result<(Option<usize>, [Option<String>; 2]), TextError> {
    // A header may be separated differently from the rows below it.
    let read = |(line, text): (usize, &str)| {
        let two = |separator| {
            <[ColumnHead; 2]>::try_from(heads(text, separator, &[Quantity::Length.dimension()])).ok()
        };
        let heads = two(separator).or_else(|| two(Separator::of(text)));
        heads.map(|heads| (line, heads))
    };
    let found = match header {
        Some(header) => read(header),
        None => remark
            .and_then(|(line, text)| read((line, text.trim())))
            .filter(|(_, heads)| heads.iter().all(|(_, unit)| unit.is_some())),
    };
    let Some((line, [(first, radii), (second, gaps)])) = found else { return Ok((None, [None, None])) };
    let is = |name: &str, names: &[&str]| names.contains(&name.to_lowercase().as_str());
    if is(&first, GAP_NAMES) && is(&second, RADIUS_NAMES) {
        return Err(TextError::Swapped { line, first: quote(&first), second: quote(&second) });
    }
    let named = radii.is_some() || gaps.is_some();
    Ok((named.then_some(line), [radii, gaps]))
}

/// The radius and the gap of a row.
fn row(
    line: usize,
    text: &str,
    separator: Separator,
    decimals: &mut Decimals,
) -> Result<(f64, f64), ProfileFault> {
    let cells = separator.cells(text);
    let &[radius, gap] = cells.as_slice() else {
        return Err(match cells.len() {
            1 => CellFault::Missing(COLUMNS[1]).into(),
            many => ProfileFault::Cells(many),
        });
    };
    let mut number = |text, what| decimals.number(line, text, what).map(|(number, _)| number);
    let (radius, gap) = (number(radius, COLUMNS[0])?, number(gap, COLUMNS[1])?);
    if radius < 0.0 { Err(ProfileFault::Negative(radius)) } else { Ok((radius, gap)) }
}

/// Sorts the rows, keeps each radius once, and checks whether they begin at the axis.
fn gather(mut rows: Vec<ProfileRow>, columns: &mut ProfileColumns, faults: &mut ProfileFaults) {
    if !rows.is_sorted_by(|a, b| a.radius <= b.radius) {
        columns.notes.push("the rows were not in the order of their radii and have been sorted".to_owned());
        // The sort is stable: of equal radii, the earlier line stays first.
        rows.sort_by(|a, b| a.radius.total_cmp(&b.radius));
    }
    let innermost = rows.first().map(|row| row.line);
    let mut last: Option<ProfileRow> = None;
    let (mut repeated, mut twice) = (0, Vec::new());
    for row in rows {
        match last {
            Some(ProfileRow { line, radius, gap }) if radius.total_cmp(&row.radius).is_eq() => {
                if gap.total_cmp(&row.gap).is_eq() {
                    repeated += 1;
                } else {
                    twice.push((row.line, ProfileFault::Twice { radius, line }));
                }
            }
            _ => {
                columns.radii.push(row.radius);
                columns.gaps.push(row.gap);
                last = Some(row);
            }
        }
    }
    if repeated > 0 {
        let rows = if repeated == 1 { "1 row was" } else { &format!("{repeated} rows were") };
        columns.notes.push(format!("{rows} listed twice and counted once"));
    }
    // If the radii are uneven, one distance says little: the widest of the first ones is used.
    let inner = columns.radii.windows(2).take(*ROW_RANGE.start() - 1).map(|pair| pair[1] - pair[0]);
    let spacing = inner.fold(0.0, f64::max);
    if let (Some(line), Some(&first)) = (innermost, columns.radii.first())
        && columns.radii.len() > 1
        && first > spacing * (1.0 + ROUNDED)
    {
        twice.push((line, ProfileFault::Hollow { first, spacing }));
    }
    faults.total += twice.len();
    faults.shown.append(&mut twice);
    faults.shown.sort_by_key(|(line, _)| *line);
    faults.shown.truncate(FAULTS_SHOWN);
}

#[cfg(test)]
mod tests;
