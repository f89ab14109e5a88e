//! The text of a measured curve → its columns.
//!
//! ```text
//! # any remark                       lines beginning with #, % or // are remarks, empty lines nothing
//! Spring constant (N/m): 0.2         settings above the rows: a stiffness and a tip radius are taken from them
//! delta [um], force (nN), segment    a header above the rows, or as the last remark there
//! 0.10, -3.2, approach               cells parted by semicolons, tabs, bars, commas or spaces: what the first row shows
//! ```
//!
//! `lines` finds which lines are rows, `header` and `choice` what their columns are, and [`stated`](super::stated) what
//! the file states about its instrument. Rows without a number in a column that is used are left out and counted. The
//! first faults are reported with line and column; a file with faults yields no curve.

use super::choice::{self, WantedColumn, in_si, open, sides, units_of};
use super::error::{CurveFault, CurveReadError, ROW_RANGE};
use super::header::{Header, headed, same, segment};
use super::lines::{Outline, TextTable};
use super::names::named;
use super::role::{ColumnRole, ColumnSpec, Segment};
use super::rows::CellFindings;
pub use super::rows::{Column, Measured, UsedColumn};
use super::stated::FileSettings;
use crate::cells;
use crate::text::{decode, quote, sanitize};
use crate::units::Unit;
use std::borrow::Cow;

/// This many values of a column are shown when choosing it.
const SEEN: usize = 3;
/// The longest column name that is shown.
const LONGEST_NAME: usize = 60;

/// A column as the user sees it before choosing its role.
#[derive(Debug, Clone, PartialEq)]
pub struct SeenColumn {
    /// Its number, from 1.
    pub number: usize,
    /// Its name in the header, safe to show; empty if there is none.
    pub name: String,
    /// Its unit in the header, as written.
    pub unit: Option<String>,
    /// Its first cells, safe to show.
    pub first: Vec<String>,
    /// What it is taken for.
    pub role: Option<ColumnRole>,
}

/// The columns of `side` that are not among the `others`.
fn alone(side: &[WantedColumn], others: &[WantedColumn]) -> Vec<usize> {
    let is_alone = |at: &usize| others.iter().all(|other| other.at != *at);
    side.iter().map(|want| want.at).filter(is_alone).collect()
}

/// A file in pieces, with the tables to read already chosen.
struct Pieces<'a> {
    outline: Outline<'a>,
    /// The tables to read, in the order of the file.
    tables: Vec<usize>,
    /// Whether their columns stand side by side, one wave in each.
    are_beside: bool,
    header: Option<Header>,
    /// The headers of further tables that continue the one of `header`.
    further: Vec<Header>,
    notes: Vec<String>,
}

/// Text with line feeds as line ends, which old files end with a carriage return alone, and with the brackets, digits and units of
/// East Asian texts, which are as wide as a letter there, as the usual characters. Wide commas, semicolons and quotation marks are part of the
/// text: none of them separates cells.
fn plain(text: Cow<'_, str>) -> Cow<'_, str> {
    let is_wide = |c: char| matches!(c, '\u{ff01}'..='\u{ff5e}' | '\u{3000}' | '\u{3380}'..='\u{33df}');
    if !text.contains('\r') && !text.contains(is_wide) {
        return text;
    }
    let mut plain = String::with_capacity(text.len());
    for c in text.replace("\r\n", "\n").replace('\r', "\n").chars() {
        // The wide form of a character follows at a fixed distance.
        let is_mark = matches!(c, '\u{ff0c}' | '\u{ff1b}' | '\u{ff02}');
        let is_usual = ('\u{ff01}'..='\u{ff5e}').contains(&c) && !is_mark;
        let usual = char::from_u32(u32::from(c).wrapping_sub(0xfee0)).filter(|_| is_usual);
        match (c, usual) {
            (_, Some(usual)) => plain.push(usual),
            ('\u{3000}', _) => plain.push(' '),
            ('\u{339a}', _) => plain.push_str("nm"),
            ('\u{339b}', _) => plain.push_str("µm"),
            ('\u{339c}', _) => plain.push_str("mm"),
            ('\u{339d}', _) => plain.push_str("cm"),
            ('\u{33b2}', _) => plain.push_str("µs"),
            ('\u{33b3}', _) => plain.push_str("ms"),
            (other, _) => plain.push(other),
        }
    }
    plain.into()
}

/// Reads the curve in `bytes`, the content of a file, with what the user says about its columns.
///
/// # Errors
/// [`CurveReadError`] with the faulty lines.
pub fn parse(bytes: &[u8], spec: &ColumnSpec) -> Result<Measured, CurveReadError> {
    let (text, note) = decode(bytes).map_err(CurveReadError::NotText)?;
    let text = plain(text);
    let pieces = Pieces::of(&text)?;
    let settings = FileSettings::of(&pieces.outline.words);
    let mut measured = Measured {
        header: pieces.header.as_ref().map(|header| header.line),
        is_said: !spec.0.is_empty(),
        is_computed: pieces.header.as_ref().is_some_and(Header::is_computed),
        ..Measured::default()
    };
    measured.notes.extend(note.map(str::to_owned));
    measured.notes.extend(pieces.notes.iter().chain(&settings.notes).cloned());
    let mut state = CellFindings::default();
    pieces.read(spec, settings.is_si, &mut measured, &mut state)?;
    state.judge_numbers();
    let lines = pieces.outline.faults.iter().map(|(line, fault)| (*line, fault.clone().into()));
    let doubtful = state.decimals.doubtful().filter(|_| !pieces.rules_out_thousands());
    let doubtful = doubtful.map(|(line, fault)| (line, CurveFault::Decimals(fault)));
    let faults = std::mem::take(&mut state.faults).and(lines.chain(doubtful));
    if faults.total > 0 {
        return Err(CurveReadError::Faults(faults));
    }
    if let Some(line) = measured.without_gaps_of_radius() {
        state.skipped = Some(state.skipped.map_or(line, |first| first.min(line)));
    }
    let rows = measured.columns.first().map_or(0, |column| column.values.len());
    measured.notes.extend(state.decimals.note());
    if let Some(line) = state.skipped {
        let skipped = measured.skipped;
        let rows = if skipped == 1 { "1 row has" } else { &format!("{skipped} rows have") };
        measured.notes.push(format!(
            "{rows} no number in a column that is used (empty, NaN or out of range); left out, the first in \
             line {line}"
        ));
    }
    if !ROW_RANGE.contains(&rows) {
        return Err(CurveReadError::Rows { rows, skipped: measured.skipped });
    }
    measured.in_radii();
    measured.without_gaps_of_time();
    (measured.stiffness, measured.radius) = (settings.stiffness, settings.radius);
    Ok(measured)
}

/// The columns of a file to choose from, with the roles given by its header.
///
/// # Errors
/// [`CurveReadError`] if there is no table.
pub fn columns(bytes: &[u8]) -> Result<Vec<SeenColumn>, CurveReadError> {
    let (text, _) = decode(bytes).map_err(CurveReadError::NotText)?;
    let text = plain(text);
    let pieces = Pieces::of(&text)?;
    let tables = pieces.chosen();
    let Some(table) = tables.first() else { return Err(CurveReadError::Rows { rows: 0, skipped: 0 }) };
    let rows: Vec<Vec<&str>> = (0..SEEN).filter_map(|row| pieces.cells(&tables, table, row)).collect();
    let of = |at: usize| {
        let head = pieces.header.as_ref().and_then(|header| header.heads.get(at));
        let named = head.and_then(|(name, _)| named(name));
        let name = head.map_or_else(String::new, |(name, _)| sanitize(name, LONGEST_NAME));
        let unit =
            head.and_then(|(_, unit)| unit.clone()).or(named.as_ref().and_then(|named| named.unit.clone()));
        let cells = rows.iter().filter_map(|row| row.get(at)).map(|cell| quote(cell));
        let role = named.map(|named| named.role);
        SeenColumn { number: at + 1, name, unit, first: cells.collect(), role }
    };
    Ok((0..pieces.width(table)).map(of).collect())
}

impl<'a> Pieces<'a> {
    /// The pieces of a text, with the table to read: the one with the most rows, and those that continue it.
    fn of(text: &'a str) -> Result<Self, CurveReadError> {
        let outline = Outline::of(text)?;
        let headers: Vec<Option<Header>> =
            outline.tables.iter().map(|table| headed(table, &outline.words)).collect();
        let mut groups: Vec<(Vec<usize>, usize)> = Vec::new();
        for (at, table) in outline.tables.iter().enumerate() {
            let goes_on = |group: &(Vec<usize>, usize)| {
                let first = group.0[0];
                outline.tables[first].cells == table.cells
                    && same(headers[first].as_ref(), headers[at].as_ref())
            };
            match groups.iter_mut().find(|group| goes_on(group)) {
                Some((tables, rows)) => {
                    tables.push(at);
                    *rows += table.rows.len();
                }
                None => groups.push((vec![at], table.rows.len())),
            }
        }
        let waves = outline.tables.iter().filter(|table| table.cells == 1).count();
        let are_beside = waves > 1 && outline.is_igor && waves == outline.tables.len();
        let (tables, further, notes) = (Vec::new(), Vec::new(), Vec::new());
        let mut pieces = Self { outline, tables, are_beside, header: None, further, notes };
        if are_beside {
            pieces.tables = (0..waves).collect();
            pieces.joined(&headers)?;
        } else {
            // Of two equally long ones, the first.
            let longest = groups
                .iter()
                .rev()
                .max_by_key(|(tables, rows)| (pieces.outline.tables[tables[0]].cells > 1, *rows));
            pieces.tables = longest.map(|(tables, _)| tables.clone()).unwrap_or_default();
            let mut own = pieces.tables.iter().filter_map(|at| headers[*at].clone());
            pieces.header = own.next();
            pieces.further = own.collect();
            pieces.tell();
        }
        Ok(pieces)
    }

    /// Combines the headers of waves, one of which stands in each table.
    fn joined(&mut self, headers: &[Option<Header>]) -> Result<(), CurveReadError> {
        let rows = self.outline.tables.iter().map(|table| table.rows.len());
        if let (Some(least), Some(most)) = (rows.clone().min(), rows.max())
            && least != most
        {
            return Err(CurveReadError::Waves { least, most });
        }
        let line = headers.iter().flatten().map(|header| header.line).next();
        let head = |header: &Option<Header>| header.as_ref().and_then(|header| header.heads.first().cloned());
        let heads = headers.iter().map(|header| head(header).unwrap_or_default()).collect();
        self.header = line.map(|line| Header { line, heads });
        Ok(())
    }

    /// Notes which lines are left out.
    fn tell(&mut self) {
        let lines = |table: &TextTable| Some((table.rows.first()?.0, table.rows.last()?.0));
        for (at, table) in self.outline.tables.iter().enumerate() {
            if let (false, Some((first, last))) = (self.tables.contains(&at), lines(table)) {
                // One or two numbers above the rows are a setting.
                if first != last {
                    self.notes.push(format!("lines {first} to {last} are another table, which is left out"));
                }
            }
        }
        if let Some((first, last)) = self.outline.footer {
            let lines = if first == last {
                format!("line {first} is")
            } else {
                format!("lines {first} to {last} are")
            };
            self.notes.push(format!("{lines} text below the rows, which is left out"));
        }
        if self.tables.len() > 1 && self.chosen().iter().any(|table| segment(table).is_none()) {
            let count = self.tables.len();
            self.notes.push(format!("the rows are in {count} tables, which are read one after the other"));
        }
    }

    fn chosen(&self) -> Vec<&TextTable<'a>> {
        self.tables.iter().map(|at| &self.outline.tables[*at]).collect()
    }

    /// How many columns a row of `table` has.
    fn width(&self, table: &TextTable) -> usize {
        if self.are_beside { self.tables.len() } else { table.cells }
    }

    /// The cells of a row of `table`, or of the tables side by side.
    fn cells(&self, all: &[&TextTable<'a>], table: &TextTable<'a>, row: usize) -> Option<Vec<&'a str>> {
        if self.are_beside {
            return all.iter().map(|wave| wave.rows.get(row).map(|(_, text)| cells::bare(text))).collect();
        }
        Some(table.separator.cells(table.rows.get(row)?.1))
    }

    /// Whether a number in any column, used or not, would not be written so with commas between thousands.
    fn rules_out_thousands(&self) -> bool {
        let all = self.chosen();
        let rows = all.iter().flat_map(|table| table.rows.iter().map(|(_, row)| table.separator.cells(row)));
        rows.flatten().any(cells::rules_out_thousands)
    }

    /// Reads the rows of these tables, each of a branch, into both sides; the second has no columns where the branches do
    /// not stand side by side.
    fn read_rows(
        &self,
        all: &[&TextTable<'a>],
        branches: &[Option<Segment>],
        mut sides: [(&[WantedColumn], &mut Measured); 2],
        state: &mut CellFindings,
    ) {
        let Some(width) = all.first().map(|table| self.width(table)) else { return };
        let [own, others] = [sides[0].0, sides[1].0];
        let is_one = others.is_empty();
        let alone = [alone(own, others), alone(others, own)];
        let tables = if self.are_beside { &all[..1] } else { all };
        for (table, branch) in tables.iter().zip(branches) {
            let fewest = table.filled().min(width);
            for (row, (line, _)) in table.rows.iter().enumerate() {
                let Some(cells) = self.cells(all, table, row) else { continue };
                let filled = cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1);
                if filled > width || cells.len() < fewest {
                    state.faults.add(*line, CurveFault::Cells { found: cells.len(), expected: width });
                    continue;
                }
                for ((wanted, into), alone) in sides.iter_mut().zip(&alone) {
                    // Of two branches side by side, one may be shorter.
                    let is_over = alone.iter().all(|at| cells.get(*at).is_none_or(|cell| cell.is_empty()));
                    if is_one || !is_over {
                        state.takes(*line, &cells, wanted, *branch, into);
                    }
                }
            }
        }
    }

    /// Reads the rows into `measured`.
    fn read(
        &self,
        spec: &ColumnSpec,
        is_si: bool,
        measured: &mut Measured,
        state: &mut CellFindings,
    ) -> Result<(), CurveReadError> {
        let all = self.chosen();
        let Some((line, first)) = all.first().and_then(|table| Some((table.rows.first()?.0, *table))) else {
            return Ok(());
        };
        let header = self.header.as_ref();
        let beside = header.filter(|_| spec.0.is_empty()).and_then(sides);
        let width = self.width(first);
        let [mut wanted, retraction] = match beside {
            Some(sides) => {
                let listed = |side: &[WantedColumn]| {
                    let numbers: Vec<String> = side.iter().map(|want| (want.at + 1).to_string()).collect();
                    numbers.join(" and ")
                };
                let [approach, retraction] = sides.each_ref().map(|side| listed(side));
                measured.notes.push(format!(
                    "columns {approach} are the approach, {retraction} the retraction, whose rows are numbered on \
                     from those of the approach"
                ));
                sides
            }
            None => [choice::wanted(spec, header, line, width, &mut measured.notes)?, Vec::new()],
        };
        if is_si {
            in_si(&mut wanted);
        }
        let units = header.map_or_else(Vec::new, units_of);
        for further in &self.further {
            let faults = units_of(further).into_iter().filter_map(|(at, unit)| {
                let used = wanted.iter().chain(&retraction).find(|used| used.at == at)?;
                // What the user says of a column without a unit holds for all tables.
                let own = units.iter().find(|(before, _)| *before == at).map(|(_, unit)| unit);
                let before = own.or(used.unit.as_ref());
                let is_same = before.is_some_and(|before| before.is_same(&unit));
                let before = || before.map_or_else(|| "no unit".to_owned(), Unit::ascii);
                (!is_same).then(|| CurveFault::Unit { number: at + 1, unit: unit.ascii(), before: before() })
            });
            faults.for_each(|fault| state.faults.add(further.line, fault));
        }
        if retraction.is_empty() {
            let used = |want: &WantedColumn| UsedColumn {
                role: want.role,
                number: want.at + 1,
                has_unit: want.unit.is_some(),
            };
            measured.used = wanted.iter().map(used).collect();
            measured.open = open(spec, header, &wanted);
        }
        let branches: Vec<Option<Segment>> = all.iter().map(|table| segment(table)).collect();
        let is_said = retraction.is_empty() && branches.iter().all(Option::is_some);
        let all_rows = if retraction.is_empty() { None } else { Some(Segment::Approach) };
        measured.begins(&wanted, all_rows.or(branches.first().copied().flatten().filter(|_| is_said)));
        let mut other = Measured::default();
        other.begins(&retraction, None);
        let branches = branches.into_iter().map(|branch| branch.filter(|_| is_said)).collect::<Vec<_>>();
        self.read_rows(&all, &branches, [(&wanted, measured), (&retraction, &mut other)], state);
        measured.skipped += other.skipped;
        if !retraction.is_empty() {
            measured.appends(&other);
        }
        measured.notes.extend(other.notes);
        Ok(())
    }
}
