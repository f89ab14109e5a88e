//! What the rows of a profile must satisfy, and why rows are no profile.

use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};

/// The fewest rows of a profile.
pub const FEWEST_ROWS: usize = 8;

/// The largest number of rows that are knots themselves, and of cells in which more rows are averaged.
pub const MOST_KNOTS: usize = 4000;

/// Neighbours closer than this share of the largest radius are one row measured twice.
pub const CLOSEST: f64 = 1e-9;

/// How rows were averaged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cells {
    /// The rows.
    pub rows: usize,
    /// The cells.
    pub count: usize,
    /// The width of each.
    pub width: f64,
}

/// Why rows are no profile. Rows are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum InvalidProfile {
    /// The columns are not equally long.
    #[error("{radii} radii and {gaps} gaps: every row needs both")]
    Columns {
        /// Radii.
        radii: usize,
        /// Gaps.
        gaps: usize,
    },
    /// Too few rows.
    #[error("{0} rows are too few for a profile: at least {FEWEST_ROWS} are needed")]
    TooFew(usize),
    /// A number is infinite or NaN.
    #[error("row {0} of the profile is not finite")]
    NotFinite(usize),
    /// A radius is negative.
    #[error("row {row} of the profile has the radius {radius:e}: radii are measured from the axis")]
    Negative {
        /// The row.
        row: usize,
        /// Its radius.
        radius: f64,
    },
    /// The radii do not ascend.
    #[error("{}", not_ascending(&UnitSystem::Reduced, *.row, [*.radius, *.before]))]
    NotAscending {
        /// The row.
        row: usize,
        /// Its radius.
        radius: f64,
        /// The previous radius.
        before: f64,
    },
    /// The cutoff is out of range.
    #[error("{}", far_cutoff(&UnitSystem::Reduced, [*.cutoff, *.least, *.most], *.rows))]
    Cutoff {
        /// The cutoff.
        cutoff: f64,
        /// The smallest allowed, 0 where the rows are few enough to be knots.
        least: f64,
        /// The largest allowed.
        most: f64,
        /// The rows.
        rows: usize,
    },
    /// A cell has no rows to average.
    #[error("{}", empty(&UnitSystem::Reduced, [*.before, *.behind], .cells, *.works))]
    Empty {
        /// The last radius before the cell.
        before: f64,
        /// The first radius behind it.
        behind: f64,
        /// The rows and their cells.
        cells: Cells,
        /// A cutoff whose cells are wide enough, where there is one.
        works: Option<f64>,
    },
    /// The equations of the spline cannot be solved.
    #[error("{}", unsolved(&UnitSystem::Reduced, *.0))]
    Unsolved(f64),
}

/// A length in a message.
pub(super) fn length(units: &UnitSystem, x: f64) -> String {
    said(units, Quantity::Length, x)
}

fn not_ascending(units: &UnitSystem, row: usize, radii: [f64; 2]) -> String {
    let [radius, before] = radii.map(|r| length(units, r));
    format!(
        "row {row} of the profile has the radius {radius}, which does not exceed the one before, {before}, \
         by {CLOSEST:e} of the largest"
    )
}

fn far_cutoff(units: &UnitSystem, lengths: [f64; 3], rows: usize) -> String {
    let [cutoff, least, most] = lengths.map(|x| length(units, x));
    let why = if lengths[1] > 0.0 {
        let rows = grouped(rows);
        format!(
            "{rows} rows are averaged in cells an eighth as wide, at most {MOST_KNOTS} of them, so it must be \
             from {least} to {most}, the last radius"
        )
    } else {
        format!("it must be positive and at most {most}, the last radius")
    };
    format!("the cutoff {cutoff} is out of range: {why}")
}

fn empty(units: &UnitSystem, [before, behind]: [f64; 2], cells: &Cells, works: Option<f64>) -> String {
    let [before, behind, width] = [before, behind, cells.width].map(|x| length(units, x));
    let (rows, count) = (grouped(cells.rows), cells.count);
    let way = match works.map(|works| length(units, works)) {
        // A value with a unit is written as text.
        Some(works) => {
            let works = if *units == UnitSystem::Reduced { works } else { format!("\"{works}\"") };
            format!("gap.smoothing = {works} gives cells that are wide enough")
        }
        None => {
            format!(
                "no gap.smoothing gives cells that are wide enough, but up to {MOST_KNOTS} rows need no cells"
            )
        }
    };
    format!(
        "no row lies between the radii {before} and {behind}, but none of the {count} cells of {width} in \
         which {rows} rows are averaged may be empty: {way}"
    )
}

fn unsolved(units: &UnitSystem, cutoff: f64) -> String {
    let cutoff = length(units, cutoff);
    format!(
        "no smooth curve was found for the profile: its radii are too uneven for the cutoff {cutoff}; \
         gap.smoothing = \"none\" accepts any"
    )
}

/// A number of rows with its thousands separated: 1 000 000.
pub(super) fn grouped(number: usize) -> String {
    let digits = number.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

impl InvalidProfile {
    /// What is wrong, with lengths as `units` show them.
    pub fn words(&self, units: &UnitSystem) -> String {
        match *self {
            Self::NotAscending { row, radius, before } => not_ascending(units, row, [radius, before]),
            Self::Cutoff { cutoff, least, most, rows } => far_cutoff(units, [cutoff, least, most], rows),
            Self::Empty { before, behind, ref cells, works } => empty(units, [before, behind], cells, works),
            Self::Unsolved(cutoff) => unsolved(units, cutoff),
            other => other.to_string(),
        }
    }

    /// Whether a different smoothing would solve it, rather than different rows.
    pub fn is_of_smoothing(&self) -> bool {
        matches!(self, Self::Cutoff { .. } | Self::Empty { .. } | Self::Unsolved(_))
    }
}

/// Whether rows can be a profile at all.
pub(super) fn check(radii: &[f64], gaps: &[f64]) -> Result<(), InvalidProfile> {
    if radii.len() != gaps.len() {
        return Err(InvalidProfile::Columns { radii: radii.len(), gaps: gaps.len() });
    }
    if radii.len() < FEWEST_ROWS {
        return Err(InvalidProfile::TooFew(radii.len()));
    }
    if let Some(row) = radii.iter().zip(gaps).position(|(r, h)| !(r.is_finite() && h.is_finite())) {
        return Err(InvalidProfile::NotFinite(row));
    }
    if radii[0] < 0.0 {
        return Err(InvalidProfile::Negative { row: 0, radius: radii[0] });
    }
    // Rows that are averaged may be arbitrarily close.
    let closest = if radii.len() > MOST_KNOTS { 0.0 } else { CLOSEST * largest(radii) };
    for (row, pair) in radii.windows(2).enumerate() {
        if pair[1] - pair[0] <= closest {
            return Err(InvalidProfile::NotAscending { row: row + 1, radius: pair[1], before: pair[0] });
        }
    }
    Ok(())
}

pub(super) fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |most, x| x.abs().max(most))
}
