//! Rows of cells → columns of numbers.

use super::choice::WantedColumn;
use super::error::CurveFault;
use super::noise::{median, range};
use super::role::{ColumnRole, Segment};
use super::stated::StatedValue;
use super::words::{is_gap, last_digit};
use crate::cells::{self, CellFault, Decimals, Faults};
use crate::text::quote;
use crate::units::Unit;
use std::f64::consts::PI;

/// One column that is used.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// What it is.
    pub role: ColumnRole,
    /// Its number in the file, from 1.
    pub number: usize,
    /// Its unit, if the file or the user names one.
    pub unit: Option<Unit>,
    /// Its values, in that unit.
    pub values: Vec<f64>,
    /// The place of the last digit of its numbers, in that unit: they are known no better than this.
    pub step: f64,
}

/// A column that is used, as the user would name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UsedColumn {
    /// What it is.
    pub role: ColumnRole,
    /// Its number in the file, from 1.
    pub number: usize,
    /// Whether it has a unit.
    pub has_unit: bool,
}

/// A measured curve as read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measured {
    /// The columns of numbers that are used.
    pub columns: Vec<Column>,
    /// The branch of each row, where the file says it.
    pub segments: Option<Vec<Segment>>,
    /// The stiffness of the device that the file states, N/m.
    pub stiffness: Option<StatedValue>,
    /// The radius of the tip that the file states, m.
    pub radius: Option<StatedValue>,
    /// The line of the header, from 1.
    pub header: Option<usize>,
    /// Whether the header is that of a walk or a curve of this program: its signs are then known, and there is no free
    /// part to find.
    pub is_computed: bool,
    /// The line of each row, from 1.
    pub lines: Vec<usize>,
    /// What would give the same columns, if the user said it; empty for two branches side by side.
    pub used: Vec<UsedColumn>,
    /// Whether the user says which columns they are.
    pub is_said: bool,
    /// The column of x, in words, if it may be an approach where it is read as a position, or the reverse, and whether its heading
    /// may as well mean the other.
    pub open: Option<(String, bool)>,
    /// How many rows have no number in a column that is used; they are left out.
    pub skipped: usize,
    /// What was assumed, in words.
    pub notes: Vec<String>,
}

/// What the cells of all rows have revealed.
#[derive(Default)]
pub(super) struct CellFindings {
    /// How decimals are written.
    pub decimals: Decimals,
    /// The line of the first row that was left out.
    pub skipped: Option<usize>,
    /// What is wrong.
    pub faults: Faults<CurveFault>,
    /// The numbers that stand for branches, in the order in which they appear, each with its line and column.
    numbers: Vec<(u8, usize, usize)>,
    /// Whether a branch is given by a word.
    has_words: bool,
}

impl CellFindings {
    /// Adds the row in `line` to `measured`, if it has a number in each column that is `wanted`; `branch` is that of
    /// its table.
    pub(super) fn takes(
        &mut self,
        line: usize,
        cells: &[&str],
        wanted: &[WantedColumn],
        branch: Option<Segment>,
        measured: &mut Measured,
    ) {
        let mut row = Vec::with_capacity(wanted.len());
        let mut segment = branch;
        let mut written = None;
        let mut is_whole = true;
        for want in wanted {
            let text = cells.get(want.at).copied().unwrap_or_default();
            if want.role == ColumnRole::Time && !want.is_said {
                row.push((time(text), f64::INFINITY));
            } else if is_gap(text) && want.role.is_contact() {
                // Nothing is seen of a contact while the bodies are apart.
                row.push((f64::NAN, f64::INFINITY));
            } else if is_gap(text) {
                is_whole = false;
            } else if want.role == ColumnRole::Segment {
                segment = Segment::of(text);
                written = Some((text, want.at + 1));
                if segment.is_none() {
                    return self
                        .faults
                        .add(line, CurveFault::Segment { number: want.at + 1, text: quote(text) });
                }
            } else {
                match self.number(line, text, want) {
                    Ok(Some(number)) => row.push(number),
                    Ok(None) => is_whole = false,
                    Err(fault) => return self.faults.add(line, fault),
                }
            }
        }
        if !is_whole {
            measured.skipped += 1;
            self.skipped = self.skipped.or(Some(line));
            return;
        }
        if let (Some(segment), Some((text, column))) = (segment, written) {
            self.numbered(segment, text, [line, column]);
        }
        measured.lines.push(line);
        for (column, (value, step)) in measured.columns.iter_mut().zip(row) {
            column.values.push(value);
            column.step = column.step.min(step);
        }
        if let (Some(segments), Some(segment)) = (&mut measured.segments, segment) {
            segments.push(segment);
        }
    }

    /// Takes note of a branch that is given by a number, and of one that is given by a word.
    fn numbered(&mut self, branch: Segment, text: &str, [line, column]: [usize; 2]) {
        if text.parse::<f64>().is_err() {
            self.has_words = true;
            return;
        }
        let number = match branch {
            Segment::Approach => 0,
            Segment::Retraction => 1,
            Segment::Other => 2,
        };
        if self.numbers.iter().all(|(known, ..)| *known != number) {
            self.numbers.push((number, line, column));
        }
    }

    /// Refuses numbers of branches unless they are 0 and 1, or with a 2 before the 1, or a 2 among words: others count from 1, or
    /// give the pause the number 1.
    pub(super) fn judge_numbers(&mut self) {
        let numbers: Vec<u8> = self.numbers.iter().map(|(number, ..)| *number).collect();
        let Some((_, line, number)) = self.numbers.iter().copied().find(|(number, ..)| *number == 2) else {
            return;
        };
        let is_known = matches!(numbers[..], [0, 2, 1] | [2, 0, 1]) || numbers == [2] && self.has_words;
        if !is_known {
            let numbers = numbers.iter().map(u8::to_string).collect::<Vec<_>>().join(", ");
            self.faults.add(line, CurveFault::Numbered { number, numbers });
        }
    }

    /// The number in a cell and the place of its last digit; `None` if it is beyond the range of any instrument.
    fn number(
        &mut self,
        line: usize,
        text: &str,
        want: &WantedColumn,
    ) -> Result<Option<(f64, f64)>, CurveFault> {
        match self.decimals.number(line, text, want.role.word()) {
            Ok((value, plain)) => Ok(Some((value, last_digit(&plain)))),
            Err(CellFault::Range { .. }) => Ok(None),
            Err(fault) => Err(CurveFault::Cell { number: want.at + 1, fault }),
        }
    }
}

/// The time in a cell; NaN if it has none. A time of day counts as none.
fn time(text: &str) -> f64 {
    text.replace(',', ".")
        .parse()
        .ok()
        .filter(|time: &f64| time.abs() <= cells::LARGEST_NUMBER)
        .unwrap_or(f64::NAN)
}

/// This many rows with a radius tell the force beside those without one.
const BESIDE: usize = 3;

/// Whether rows without a contact radius are apart: their force is constant, and jumped from that of the rows `beside`.
fn is_apart(force: &[f64], beside: impl Iterator<Item = f64>) -> bool {
    /// The fewest such rows, and how many times the range of their force the jump is.
    const FEWEST: usize = 3;
    const JUMP: f64 = 3.0;
    let own = median(force.to_vec());
    let Some((own, beside)) = own.zip(median(beside.collect())) else { return false };
    force.len() >= FEWEST && (own - beside).abs() > JUMP * range(force.iter().copied())
}

/// Drops the rows that are not to be kept.
fn kept<T>(rows: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    rows.retain(|_| keep.next().is_none_or(|keep| *keep));
}

impl Measured {
    /// Creates the columns; `all` is the branch of all rows, if no column gives it.
    pub(super) fn begins(&mut self, wanted: &[WantedColumn], all: Option<Segment>) {
        for column in wanted.iter().filter(|column| column.role != ColumnRole::Segment) {
            let (role, unit) = (column.role, column.unit.clone());
            let (number, values) = (column.at + 1, Vec::new());
            self.columns.push(Column { role, number, unit, values, step: f64::INFINITY });
        }
        if all.is_some() || wanted.iter().any(|column| column.role == ColumnRole::Segment) {
            self.segments = Some(Vec::new());
        }
    }

    /// Appends the rows of the retraction, which has the same columns.
    pub(super) fn appends(&mut self, retraction: &Self) {
        let rows = |of: &Self| of.columns.first().map_or(0, |column| column.values.len());
        let mut segments = vec![Segment::Approach; rows(self)];
        segments.resize(rows(self) + rows(retraction), Segment::Retraction);
        self.segments = Some(segments);
        self.lines.extend_from_slice(&retraction.lines);
        for column in &mut self.columns {
            let Some(other) = retraction.columns.iter().find(|other| other.role == column.role) else {
                continue;
            };
            column.values.extend_from_slice(&other.values);
            column.step = column.step.min(other.step);
        }
    }

    /// Decides what rows without a contact radius are. Beside an approach the force tells whether they are apart. For force
    /// over radius alone, they are so before the first radius or after the last one, if their force is constant and far
    /// from that of the rows beside them. All others are left out; returns the line of the first of these.
    pub(super) fn without_gaps_of_radius(&mut self) -> Option<usize> {
        let at = |is: fn(ColumnRole) -> bool| self.columns.iter().position(|column| is(column.role));
        let (radii, force) = (at(ColumnRole::is_contact)?, at(ColumnRole::is_force)?);
        if at(ColumnRole::is_approach).is_some() {
            return None;
        }
        let force = self.columns[force].values.clone();
        let radii = &mut self.columns[radii].values;
        let is_seen = |radius: &f64| !radius.is_nan();
        let seen: Vec<usize> = (0..radii.len()).filter(|row| is_seen(&radii[*row])).collect();
        let (first, last) = (*seen.first()?, *seen.last()?);
        let few = BESIDE.min(seen.len());
        let ends = [(0..first, &seen[..few]), (last + 1..radii.len(), &seen[seen.len() - few..])];
        let mut apart = 0;
        for (rows, beside) in ends {
            if is_apart(&force[rows.clone()], beside.iter().map(|row| force[*row])) {
                apart += rows.len();
                radii[rows].fill(0.0);
            }
        }
        let keep: Vec<bool> = radii.iter().map(is_seen).collect();
        if apart > 0 {
            self.notes.push(format!(
                "rows without a contact radius and with a constant force, taken to be apart: {apart}"
            ));
        }
        self.skipped += keep.iter().filter(|keep| !**keep).count();
        let left_out = keep.iter().position(|keep| !keep).map(|row| self.lines[row]);
        kept(&mut self.lines, &keep);
        for column in &mut self.columns {
            kept(&mut column.values, &keep);
        }
        if let Some(segments) = &mut self.segments {
            kept(segments, &keep);
        }
        left_out
    }

    /// Drops a time column that lacks a number in some row: nothing else needs it.
    pub(super) fn without_gaps_of_time(&mut self) {
        let is_left = |column: &Column| {
            column.role == ColumnRole::Time && column.values.iter().any(|time| time.is_nan())
        };
        if let Some(at) = self.columns.iter().position(is_left) {
            let Column { number, .. } = self.columns.remove(at);
            self.notes
                .push(format!("column {number} is a time, but not a number in every row: it is left out"));
        }
    }

    /// Converts diameters, s = d/2, and areas, s = √(A/π), into contact radii.
    pub(super) fn in_radii(&mut self) {
        for column in &mut self.columns {
            let (word, number) = (column.role.word(), column.number);
            let into: fn(f64) -> f64 = match column.role {
                ColumnRole::Diameter => |d| 0.5 * d,
                // An area below 0 is noise around no contact; its sign is kept, so that it is refused like a negative
                // radius.
                ColumnRole::Area => |area| (area.abs() / PI).sqrt().copysign(area),
                _ => continue,
            };
            if let Some(unit) = column.unit.take() {
                for value in &mut column.values {
                    *value = unit.to_si(*value);
                }
                column.step = unit.to_si(column.step);
                column.unit = Unit::parse("m", 0).ok();
            }
            let largest = column.values.iter().copied().fold(0.0, f64::max);
            // ds = dA/(2πs), at the largest area.
            column.step = if column.role == ColumnRole::Area && largest > 0.0 {
                column.step / (2.0 * PI * into(largest))
            } else {
                into(column.step)
            };
            for value in &mut column.values {
                *value = into(*value);
            }
            column.role = ColumnRole::Radius;
            let formula = if word == "area" { "s = √(A/π)" } else { "s = d/2" };
            self.notes.push(format!("column {number} is the {word} of the contact: its radius is {formula}"));
        }
    }
}
