//! A measured profile: a smooth even curve through its rows, or near them.
//!
//! Radii and gaps are lengths in one unit, the radii from the axis. With κ and c from the weighted least squares of
//! h ≈ c + κr²/2 over all rows,
//!
//! ```text
//! h(r) = κr²/2 + f(r) − f(0)
//! ```
//!
//! f is the even spline of the module [`spline`](super::spline) through what the paraboloid leaves, so that smoothing does
//! not flatten the body and a measured paraboloid stays one to its last row. h and two derivatives are continuous,
//! h'(0) = 0, and h''' jumps from knot to knot: where limit points are located with it, bracketing stands in.
//!
//! Every row is a knot as long as there are at most [`MOST_KNOTS`]. Of more, what the paraboloid leaves is averaged in cells
//! of equal width from the axis to the last row, and a knot lies in the middle of each. The mean is that of the straight
//! lines between the rows, so that it does not matter how many of them fall in a cell. So it is too where the cutoff
//! is long against the distance of the rows, since the equations of the spline lose a digit for each factor of 1.8 in their
//! ratio; cells of an eighth of the cutoff are then fine enough. The mean over a cell passes a wave of
//!
//! | cells | 1.66 | 4 | 8 |
//! |---|---|---|---|
//! | the share | 0.5 | 0.90 | 0.974 |
//!
//! Rows that do not begin at 0 are continued to the axis by the even parabola that the spline has there; h(0) = 0 then
//! holds by subtraction, whatever height the rows were measured from. From the mean of the last cell to the last row f is
//! straight, as the smoothest curve is. Beyond the last row nothing is known and nothing is extrapolated:
//! [`Gap::largest_radius`] says where, and jets beyond are NaN.
//!
//! The reference length is R = 1/κ, or the largest radius where κ is not positive. The feature length is the mean
//! distance of the crests of f as a random profile would have it, 2π √(∫f'²/∫f''²) (λ itself for a single wave), and
//! none where f is rounding, or bends over more than the profile is wide. M. S. Longuet-Higgins, Phil. Trans. R. Soc. A
//! 249, 321 (1957), doi:10.1098/rsta.1957.0002.

use super::spline::{Fit, Rows, widths};
use crate::elementary::{exp2, log2, log10, pow};
use crate::gap::{Axis, Breaks, Disc, Gap, Jet};
use crate::gap::{function::Form, function::Piece};
use crate::units::number::said;
use crate::units::{Quantity, UnitSystem};
use std::f64::consts::TAU;

/// The fewest rows of a profile.
pub const FEWEST_ROWS: usize = 8;

/// The most rows that are knots themselves, and the most cells in which more rows are averaged.
pub const MOST_KNOTS: usize = 4000;

/// Cells in a cutoff.
const CELLS_IN_CUTOFF: f64 = 8.0;

/// The largest cutoff in mean distances of the rows with which they stay knots: nine digits of the curve are left.
const KEPT_SPACINGS: f64 = 64.0;

/// The same where a cell would be empty: six digits are left.
const MOST_SPACINGS: f64 = 1000.0;

/// A cutoff out of range by less than this share is in range: messages round to six digits.
const ROUNDED: f64 = 1e-5;

/// A cutoff of so many widest distances of neighbours leaves no cell empty: more than eight, since the cells are a whole
/// number, hence narrower than asked for by up to an eighth.
const WIDE_ENOUGH: f64 = 9.1;

/// Rows this many mean distances apart are no hole even if a cell falls between them.
const NO_HOLE: f64 = 2.0;

/// Neighbours closer than this share of the largest radius are one row measured twice.
pub const CLOSEST: f64 = 1e-9;

/// Beyond the last row by rounding: what a change of units there and back may cost.
const ROUNDING: f64 = 1e-15;

/// What the paraboloid leaves is rounding below this share of the largest gap.
const NO_WAVES: f64 = 1e-12;

/// How near the curve keeps to the rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Smoothing {
    /// Through every row, or every mean of a cell.
    None,
    /// Waves of this length, in the unit of the radii, pass by half; shorter ones less, longer ones more.
    Cutoff(f64),
    /// The cutoff that generalized cross-validation finds: noise that differs from row to row at random goes.
    Auto,
}

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

/// The gap of a measured profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// 0, the radii of the rows or the middles of the cells, and the last radius.
    knots: Vec<f64>,
    /// The jet at each knot but the last: the cubic from there on.
    pieces: Vec<Jet>,
    curvature: f64,
    feature: Option<f64>,
    cutoff: Option<f64>,
    removed: f64,
    cells: Option<Cells>,
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
    /// A number is infinite or no number.
    #[error("row {0} of the profile is not finite")]
    NotFinite(usize),
    /// A radius is negative.
    #[error("row {row} of the profile has the radius {radius:e}: radii count from the axis")]
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
        /// The radius before it.
        before: f64,
    },
    /// The cutoff is out of range.
    #[error("{}", far_cutoff(&UnitSystem::Reduced, [*.cutoff, *.least, *.most], *.rows))]
    Cutoff {
        /// The cutoff.
        cutoff: f64,
        /// The smallest, 0 where the rows are few enough to be knots.
        least: f64,
        /// The largest.
        most: f64,
        /// The rows.
        rows: usize,
    },
    /// A cell in which rows are averaged has none.
    #[error("{}", empty(&UnitSystem::Reduced, [*.before, *.behind], .cells, *.works))]
    Empty {
        /// The last radius before the cell.
        before: f64,
        /// The first behind it.
        behind: f64,
        /// The rows and their cells.
        cells: Cells,
        /// A cutoff with cells wide enough, where there is one.
        works: Option<f64>,
    },
    /// The equations of the spline cannot be solved.
    #[error("{}", unsolved(&UnitSystem::Reduced, *.0))]
    Unsolved(f64),
}

/// A length in a message.
fn length(units: &UnitSystem, x: f64) -> String {
    said(units, Quantity::Length, x)
}

fn not_ascending(units: &UnitSystem, row: usize, radii: [f64; 2]) -> String {
    let [radius, before] = radii.map(|r| length(units, r));
    format!(
        "row {row} of the profile has the radius {radius}, which is not above the one before, {before}, by {CLOSEST:e} of \
         the largest"
    )
}

fn far_cutoff(units: &UnitSystem, lengths: [f64; 3], rows: usize) -> String {
    let [cutoff, least, most] = lengths.map(|x| length(units, x));
    let why = if lengths[1] > 0.0 {
        let rows = grouped(rows);
        format!(
            "{rows} rows are averaged in cells of an eighth of it, of which there are at most {MOST_KNOTS}, so it must be \
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
        // A value with a unit is text.
        Some(works) => {
            let works = if *units == UnitSystem::Reduced { works } else { format!("\"{works}\"") };
            format!("gap.smoothing = {works} averages in cells wide enough")
        }
        None => {
            format!("no gap.smoothing has cells wide enough, but at most {MOST_KNOTS} rows need no cells")
        }
    };
    format!(
        "no row lies between the radii {before} and {behind}, and of the {count} cells of {width} in which {rows} rows are \
         averaged none may be empty: {way}"
    )
}

fn unsolved(units: &UnitSystem, cutoff: f64) -> String {
    let cutoff = length(units, cutoff);
    format!(
        "no smooth curve was found for the profile: its radii are too uneven for the cutoff {cutoff}; gap.smoothing = \
         \"none\" takes any"
    )
}

/// A number of rows with its thousands apart: 1 000 000.
fn grouped(number: usize) -> String {
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

    /// Whether another smoothing mends it, and not other rows.
    pub fn is_of_smoothing(&self) -> bool {
        matches!(self, Self::Cutoff { .. } | Self::Empty { .. } | Self::Unsolved(_))
    }
}

impl Profile {
    /// The profile of `gaps` at `radii ≥ 0`, ascending, both in one unit of length.
    ///
    /// # Errors
    /// [`InvalidProfile`] with the row or the number.
    pub fn new(radii: &[f64], gaps: &[f64], smoothing: Smoothing) -> Result<Self, InvalidProfile> {
        check(radii, gaps)?;
        let body = Body::new(radii, gaps);
        match smoothing {
            Smoothing::None if body.is_small() => body.curve(&body.rows(), None),
            Smoothing::None => body.curve(&body.cells(MOST_KNOTS)?, None),
            Smoothing::Cutoff(cutoff) => body.smoothed(cutoff / body.length, true),
            Smoothing::Auto => body.smoothed(body.found()?, false),
        }
    }

    /// The same in half as many cells, to see whether they are fine enough: `radii` and `gaps` are those it was made of.
    /// None where the rows are knots themselves, or there are no fewer cells.
    pub fn coarser(&self, radii: &[f64], gaps: &[f64]) -> Option<Self> {
        let half = Some(self.cells?.count / 2).filter(|half| *half >= FEWEST_ROWS)?;
        let body = Body::new(radii, gaps);
        let points = body.cells(half).ok()?;
        body.curve(&points, self.cutoff.map(|cutoff| cutoff / body.length)).ok()
    }

    /// R of the paraboloid nearest to the rows, where they rise.
    pub fn radius_of_curvature(&self) -> Option<f64> {
        (self.curvature > 0.0).then_some(self.curvature.recip())
    }

    /// The cutoff of the smoothing, given or found.
    pub fn cutoff(&self) -> Option<f64> {
        self.cutoff
    }

    /// Root mean square of what the smoothing took away: the noise, where it was found automatically.
    pub fn removed(&self) -> f64 {
        self.removed
    }

    /// How the rows were averaged, where they are too many or too close to be knots.
    pub fn cells(&self) -> Option<&Cells> {
        self.cells.as_ref()
    }

    /// The radii where h''' jumps: 0, the radii of the rows or the middles of the cells, and the last radius.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// What of the rows is not in the curve, in words with numbers as `units` show them.
    pub fn remarks(&self, units: &UnitSystem) -> Vec<String> {
        let averaged = self.cells.map(|Cells { rows, count, width }| {
            let said =
                format!("{} rows averaged in {count} cells of {}", grouped(rows), length(units, width));
            if self.cutoff.is_some() {
                return said;
            }
            format!("{said}: waves shorter than {} are not in the gap", length(units, 4.0 * width))
        });
        let passed = self.cutoff.map(|cutoff| {
            let [cutoff, removed] = [cutoff, self.removed].map(|x| length(units, x));
            format!("smoothing: waves of {cutoff} pass by half, shorter ones less; what it takes away has the rms {removed}")
        });
        averaged.into_iter().chain(passed).collect()
    }

    /// The same in other units, of which the ones it is in are so many.
    fn scaled(mut self, length: f64, height: f64) -> Self {
        for jet in &mut self.pieces {
            jet.value *= height;
            jet.first *= height / length;
            jet.second *= height / (length * length);
            jet.third *= height / (length * length * length);
        }
        for knot in &mut self.knots {
            *knot *= length;
        }
        self.curvature *= height / (length * length);
        self.feature = self.feature.map(|wave| wave * length);
        self.cutoff = self.cutoff.map(|cutoff| cutoff * length);
        self.removed *= height;
        self.cells = self.cells.map(|cells| Cells { width: cells.width * length, ..cells });
        self
    }
}

/// Rows of the order of one, by powers of two: fourth powers of lengths keep their range, numbers their digits.
struct Body {
    /// The units of x and y.
    length: f64,
    height: f64,
    /// The largest gap.
    highest: f64,
    curvature: f64,
    x: Vec<f64>,
    /// What the paraboloid leaves.
    left: Vec<f64>,
    weights: Vec<f64>,
}

/// What the spline goes through or near: rows, or the means of cells.
struct Points {
    x: Vec<f64>,
    values: Vec<f64>,
    weights: Vec<f64>,
    /// How many cells.
    cells: Option<usize>,
}

impl Body {
    fn new(radii: &[f64], gaps: &[f64]) -> Self {
        let (length, height) = (power_of_two(largest(radii)), power_of_two(largest(gaps)));
        let x: Vec<f64> = radii.iter().map(|r| r / length).collect();
        let y: Vec<f64> = gaps.iter().map(|h| h / height).collect();
        let weights = widths(&x);
        let curvature = paraboloid(&x, &y, &weights);
        let left = x.iter().zip(&y).map(|(x, y)| y - 0.5 * curvature * x * x).collect();
        Self { length, height, highest: largest(&y), curvature, x, left, weights }
    }

    fn last(&self) -> f64 {
        self.x[self.x.len() - 1]
    }

    /// The mean distance of the rows.
    fn spacing(&self) -> f64 {
        (self.last() - self.x[0]) / (self.x.len() - 1) as f64
    }

    /// Whether every row can be a knot.
    fn is_small(&self) -> bool {
        self.x.len() <= MOST_KNOTS
    }

    fn rows(&self) -> Points {
        Points { x: self.x.clone(), values: self.left.clone(), weights: self.weights.clone(), cells: None }
    }

    /// The means in `count` cells of equal width.
    fn cells(&self, count: usize) -> Result<Points, InvalidProfile> {
        let (x, last) = (&self.x, self.last());
        let width = last / count as f64;
        let widest = width.max(NO_HOLE * self.spacing()) * (1.0 + ROUNDED);
        let mut values = Vec::with_capacity(count);
        // The rows passed, and how far the integral has come.
        let (mut passed, mut from) = (0, 0.0);
        for cell in 1..=count {
            let to = if cell == count { last } else { cell as f64 * width };
            let (passed_before, mut sum) = (passed, 0.0);
            while let Some(row) = x.get(passed).filter(|row| **row <= to) {
                sum += (row - from) * self.straight(0.5 * (from + row), passed);
                from = *row;
                passed += 1;
            }
            let before = passed.checked_sub(1).map_or(0.0, |before| x[before]);
            if let Some(&behind) = x.get(passed)
                && passed == passed_before
                && behind - before > widest
            {
                let cells = Cells { rows: x.len(), count, width: width * self.length };
                return Err(self.empty([before, behind], cells));
            }
            sum += (to - from) * self.straight(0.5 * (from + to), passed);
            from = to;
            values.push(sum / width);
        }
        let middles = (0..count).map(|cell| (cell as f64 + 0.5) * width).collect();
        Ok(Points { x: middles, values, weights: vec![width; count], cells: Some(count) })
    }

    /// What the paraboloid leaves at x, on the straight line from the row before `next` to this one; to the axis it stays.
    fn straight(&self, x: f64, next: usize) -> f64 {
        match (next.checked_sub(1), self.x.get(next)) {
            (Some(i), Some(end)) => {
                let share = (x - self.x[i]) / (end - self.x[i]);
                self.left[i] + share * (self.left[next] - self.left[i])
            }
            (Some(i), None) => self.left[i],
            (None, _) => self.left[0],
        }
    }

    /// A cell between these radii has no row.
    fn empty(&self, radii: [f64; 2], cells: Cells) -> InvalidProfile {
        let [before, behind] = radii.map(|x| x * self.length);
        let widest = self.x.windows(2).map(|pair| pair[1] - pair[0]).fold(self.x[0], f64::max);
        let works = two_digits_up(WIDE_ENOUGH * widest * self.length);
        let works = (works <= self.last() * self.length).then_some(works);
        InvalidProfile::Empty { before, behind, cells, works }
    }

    /// The cutoff of the noise.
    fn found(&self) -> Result<f64, InvalidProfile> {
        let last = self.last();
        let (points, spacing) = if self.is_small() {
            (self.rows(), self.spacing())
        } else {
            (self.cells(MOST_KNOTS)?, last / MOST_KNOTS as f64)
        };
        let rows = Rows::new(&points.x, &points.values, &points.weights);
        Ok(rows.cutoff(2.0 * spacing, last.min(MOST_SPACINGS * spacing)))
    }

    /// The curve of a cutoff. One that was `given` is refused where it needs more cells than there may be.
    fn smoothed(&self, cutoff: f64, given: bool) -> Result<Profile, InvalidProfile> {
        let last = self.last();
        let least = if self.is_small() { 0.0 } else { CELLS_IN_CUTOFF * last / MOST_KNOTS as f64 };
        let (from, to) = (least * (1.0 - ROUNDED), last * (1.0 + ROUNDED));
        if given && !(cutoff > 0.0 && (from..=to).contains(&cutoff)) {
            let [cutoff, least, most] = [cutoff, least, last].map(|x| x * self.length);
            return Err(InvalidProfile::Cutoff { cutoff, least, most, rows: self.x.len() });
        }
        let rows = || self.curve(&self.rows(), Some(cutoff));
        if self.is_small() && cutoff <= KEPT_SPACINGS * self.spacing() {
            return rows();
        }
        // Between 8 and the most.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let cells =
            (CELLS_IN_CUTOFF * last / cutoff).ceil().clamp(FEWEST_ROWS as f64, MOST_KNOTS as f64) as usize;
        match self.cells(cells) {
            Ok(points) => self.curve(&points, Some(cutoff)),
            Err(_) if self.is_small() && cutoff <= MOST_SPACINGS * self.spacing() => rows(),
            Err(empty) => Err(empty),
        }
    }

    /// The curve through the points, or near them.
    fn curve(&self, points: &Points, cutoff: Option<f64>) -> Result<Profile, InvalidProfile> {
        let rows = Rows::new(&points.x, &points.values, &points.weights);
        let unsolved = || InvalidProfile::Unsolved(cutoff.unwrap_or(0.0) * self.length);
        let fit = rows.fit(cutoff.unwrap_or(0.0)).ok_or_else(unsolved)?;
        let last = self.last();
        let axis = axis(&fit, points.x[0]);
        let (knots, pieces) = pieces(&rows, &fit, &points.x, last, self.curvature);
        let count_in = |count: usize| Cells { rows: self.x.len(), count, width: last / count as f64 };
        let mut profile = Profile {
            knots,
            pieces,
            curvature: self.curvature,
            feature: feature(&rows, &fit, self.highest, last),
            cutoff,
            removed: 0.0,
            cells: points.cells.map(count_in),
        };
        profile.removed = if points.cells.is_none() {
            rms(points.values.iter().zip(&fit.values).map(|(y, g)| y - g), &points.weights)
        } else {
            let mut at = 0;
            let f =
                |x: f64, at: &mut usize| profile.jet_near(x, at).value - 0.5 * self.curvature * x * x + axis;
            rms(self.x.iter().zip(&self.left).map(|(x, y)| y - f(*x, &mut at)), &self.weights)
        };
        Ok(profile.scaled(self.length, self.height))
    }
}

impl Profile {
    /// The jet at `r`; `at` is the piece it is looked for in first, and then that of `r`.
    fn jet_near(&self, r: f64, at: &mut usize) -> Jet {
        if !self.is_known(r) {
            return Jet::UNKNOWN;
        }
        // Sums ask in order: most radii lie in the piece of the one before.
        if r < self.knots[*at] || r >= self.knots[*at + 1] {
            *at = self.piece(r);
        }
        self.cubic(*at, r)
    }

    fn is_known(&self, r: f64) -> bool {
        r <= self.knots[self.knots.len() - 1] * (1.0 + ROUNDING)
    }

    /// The piece that holds at `r`.
    fn piece(&self, r: f64) -> usize {
        let above = self.knots.partition_point(|knot| *knot <= r);
        above.saturating_sub(1).min(self.pieces.len() - 1)
    }

    /// The cubic of this piece at `r`, within it or continued.
    fn cubic(&self, i: usize, r: f64) -> Jet {
        let (x, Jet { value, first, second, third }) = (r - self.knots[i], self.pieces[i]);
        Jet {
            value: value + x * (first + x * (0.5 * second + x * third / 6.0)),
            first: first + x * (second + 0.5 * x * third),
            second: second + x * third,
            third,
        }
    }
}

impl Gap for Profile {
    fn jet(&self, r: f64) -> Jet {
        self.jet_near(r, &mut 0)
    }

    fn values(&self, s: f64, nodes: &[f64], values: &mut [f64]) {
        let mut at = 0;
        for (value, x) in values.iter_mut().zip(nodes) {
            *value = self.jet_near(s * x, &mut at).value;
        }
    }

    fn derivatives(&self, s: f64, nodes: &[f64], [first, second, third]: [&mut [f64]; 3]) {
        let mut at = 0;
        for (((first, second), third), x) in first.iter_mut().zip(second).zip(third).zip(nodes) {
            let jet = self.jet_near(s * x, &mut at);
            (*first, *second, *third) = (jet.first, jet.second, jet.third);
        }
    }

    /// The knots without the axis, where the cubic of the first piece is not even.
    fn breaks(&self) -> Breaks<'_> {
        Breaks { knots: &self.knots[1..], axis: Axis::Odd, cubic: true }
    }

    /// h' is a parabola on each piece.
    fn slope_bound(&self, Disc { centre, radius, branch }: Disc) -> Option<f64> {
        if !self.is_known(branch) {
            return Some(f64::INFINITY);
        }
        let Jet { first, second, third, .. } = self.cubic(self.piece(branch), centre);
        Some(first.abs() + radius * (second.abs() + 0.5 * radius * third.abs()))
    }

    fn feature_length(&self) -> Option<f64> {
        self.feature
    }

    fn form(&self) -> Form {
        let piece = |(ends, jet): (&[f64], &Jet)| Piece {
            lo: ends[0],
            hi: ends[1],
            slope: [jet.first, jet.second, 0.5 * jet.third],
        };
        Form::Cubic(self.knots.windows(2).zip(&self.pieces).map(piece).collect())
    }

    fn reference_length(&self) -> f64 {
        self.radius_of_curvature().unwrap_or(self.knots[self.knots.len() - 1])
    }

    fn largest_radius(&self) -> Option<f64> {
        self.knots.last().copied()
    }
}

fn check(radii: &[f64], gaps: &[f64]) -> Result<(), InvalidProfile> {
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
    // Averaged rows may be as close as they are.
    let closest = if radii.len() > MOST_KNOTS { 0.0 } else { CLOSEST * largest(radii) };
    for (row, pair) in radii.windows(2).enumerate() {
        if pair[1] - pair[0] <= closest {
            return Err(InvalidProfile::NotAscending { row: row + 1, radius: pair[1], before: pair[0] });
        }
    }
    Ok(())
}

fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |most, x| x.abs().max(most))
}

/// A power of two of the size of `x ≥ 0`; 1 for 0.
fn power_of_two(x: f64) -> f64 {
    if x > 0.0 { exp2(log2(x).round()) } else { 1.0 }
}

fn rms(values: impl Iterator<Item = f64>, weights: &[f64]) -> f64 {
    let square: f64 = values.zip(weights).map(|(x, w)| w * x * x).sum();
    (square / weights.iter().sum::<f64>()).sqrt()
}

/// κ of the paraboloid c + κx²/2 nearest to the rows.
fn paraboloid(x: &[f64], y: &[f64], weights: &[f64]) -> f64 {
    let total: f64 = weights.iter().sum();
    let mean =
        |values: &mut dyn Iterator<Item = f64>| values.zip(weights).map(|(v, w)| v * w).sum::<f64>() / total;
    let halves: Vec<f64> = x.iter().map(|x| 0.5 * x * x).collect();
    let (half, height) = (mean(&mut halves.iter().copied()), mean(&mut y.iter().copied()));
    let product = mean(&mut halves.iter().zip(y).map(|(x, y)| (x - half) * (y - height)));
    product / mean(&mut halves.iter().map(|x| (x - half) * (x - half)))
}

/// The mean distance of the crests of f; none where f is rounding or wider than the profile.
fn feature(rows: &Rows, fit: &Fit, height: f64, widest: f64) -> Option<f64> {
    let weights = rows.weights();
    let mean = fit.values.iter().zip(weights).map(|(g, w)| g * w).sum::<f64>() / weights.iter().sum::<f64>();
    if rms(fit.values.iter().map(|g| g - mean), weights) <= NO_WAVES * height {
        return None;
    }
    let slope = rms(rows.pieces(fit).iter().map(|piece| piece.first), weights);
    let bend = rms(fit.second.iter().copied(), weights);
    Some(TAU * slope / bend).filter(|wave| *wave < widest)
}

/// f(0): an even cubic is a parabola, so the second derivative at the first radius stays to the axis.
fn axis(fit: &Fit, first: f64) -> f64 {
    fit.values[0] - 0.5 * fit.second[0] * first * first
}

/// The knots from the axis on to `last`, and the jets of h there.
fn pieces(rows: &Rows, fit: &Fit, x: &[f64], last: f64, curvature: f64) -> (Vec<f64>, Vec<Jet>) {
    let mut jets = rows.pieces(fit);
    let mut knots = x.to_vec();
    let n = x.len() - 1;
    if last - x[n] > CLOSEST * last {
        let (d, end) = (x[n] - x[n - 1], jets[n - 1]);
        let first = end.first + d * (end.second + 0.5 * d * end.third);
        jets.push(Jet { value: fit.values[n], first, ..Jet::default() });
        knots.push(last);
    } else {
        knots[n] = last;
    }
    let axis = axis(fit, x[0]);
    for (jet, &x) in jets.iter_mut().zip(x) {
        jet.value += 0.5 * curvature * x * x - axis;
        jet.first += curvature * x;
        jet.second += curvature;
    }
    let second = fit.second[0] + curvature;
    if x[0] > 0.0 {
        knots.insert(0, 0.0);
        jets.insert(0, Jet { second, ..Jet::default() });
    } else {
        // Zero but for rounding.
        jets[0] = Jet { value: 0.0, first: 0.0, ..jets[0] };
    }
    (knots, jets)
}

/// x rounded up to two digits.
fn two_digits_up(x: f64) -> f64 {
    let unit = pow(10.0_f64, log10(x).floor() - 1.0);
    (x / unit).ceil() * unit
}

#[cfg(test)]
mod tests {
    use super::super::examples::check_two_derivatives;
    use super::*;
    use crate::gap::shapes::split_mix::SplitMix64;
    use crate::gap::{shapes::Harmonic, shapes::Harmonics};

    fn even(n: usize, last: f64) -> Vec<f64> {
        (0..=n).map(|i| last * i as f64 / n as f64).collect()
    }

    fn sampled(gap: &dyn Gap, radii: &[f64]) -> Vec<f64> {
        radii.iter().map(|&r| gap.jet(r).value).collect()
    }

    fn wavy() -> Harmonics {
        let wave = Harmonic { amplitude: 0.0025, wavelength: 0.1, phase: 0.0 };
        Harmonics::new(1.0, vec![wave]).unwrap()
    }

    #[test]
    fn derivatives_agree_with_central_differences_between_the_rows() {
        let radii = even(300, 0.5);
        let profile = Profile::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
        for i in 1..299 {
            // In the middle of a piece, over less than its width: there h is one cubic and h''' its own.
            let r = 0.5 * (radii[i] + radii[i + 1]);
            check_two_derivatives(&profile, r, 0.1);
            let (e, at) = (1e-4, profile.jet(r));
            let third = (profile.jet(r + e).second - profile.jet(r - e).second) / (2.0 * e);
            assert!((third - at.third).abs() <= 1e-9 * at.second.abs() / e);
        }
    }

    #[test]
    fn it_passes_the_rows_and_nears_the_gap_in_the_fourth_order() {
        let error = |n: usize| {
            let radii = even(n, 0.5);
            let rows = sampled(&wavy(), &radii);
            let profile = Profile::new(&radii, &rows, Smoothing::None).unwrap();
            for (&r, h) in radii.iter().zip(&rows) {
                assert!((profile.jet(r).value - h).abs() <= 1e-15, "{r}");
            }
            (0..1000)
                .map(|i| 4e-4 * f64::from(i))
                .map(|r| (profile.jet(r).value - wavy().jet(r).value).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(100) / error(200)).log2();
        assert!((3.7..4.3).contains(&order), "{order}");
    }

    #[test]
    fn a_measured_paraboloid_stays_one() {
        // In odd units, with the heights counted from elsewhere, and not from the axis.
        let radii: Vec<f64> = even(50, 3e-4).into_iter().skip(1).collect();
        let gaps: Vec<f64> = radii.iter().map(|r| 5e-6 + r * r / (2.0 * 2e-2)).collect();
        for smoothing in [Smoothing::None, Smoothing::Cutoff(1e-4), Smoothing::Auto] {
            let profile = Profile::new(&radii, &gaps, smoothing).unwrap();
            assert!((profile.radius_of_curvature().unwrap() / 2e-2 - 1.0).abs() < 1e-8);
            assert_eq!((profile.knots()[0], profile.largest_radius()), (0.0, Some(3e-4)));
            for r in [0.0, 1e-6, 1.1e-4, 3e-4] {
                let jet = profile.jet(r);
                assert!((jet.value - r * r / 4e-2).abs() < 1e-8 * 2.25e-6, "{smoothing:?} {r}");
                assert!((jet.first - r / 2e-2).abs() < 1e-7 * 1.5e-2, "{smoothing:?} {r}");
            }
            let axis = profile.jet(0.0);
            assert_eq!(axis, Jet { second: axis.second, ..Jet::default() });
        }
    }

    #[test]
    fn the_wave_and_the_sphere_are_told_apart() {
        let radii = even(500, 0.5);
        let profile = Profile::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
        assert!(
            (profile.feature_length().unwrap() / 0.1 - 1.0).abs() < 0.03,
            "{:?}",
            profile.feature_length()
        );
        assert!((profile.reference_length() - 1.0).abs() < 0.01);
        assert_eq!((profile.cutoff(), profile.removed()), (None, 0.0));
        let sphere = crate::gap::Shape::Sphere { radius_of_curvature: 0.7 };
        let smooth = Profile::new(&radii, &sampled(&sphere, &radii), Smoothing::None).unwrap();
        assert_eq!(smooth.feature_length(), None);
    }

    #[test]
    fn noise_is_measured_and_removed() {
        let radii = even(2000, 0.5);
        let mut random = SplitMix64::new(5);
        let noise = 1e-4;
        let gaps: Vec<f64> = sampled(&wavy(), &radii)
            .into_iter()
            .map(|h| h + noise * 6.0_f64.sqrt() * (random.unit() + random.unit() - 1.0))
            .collect();
        let profile = Profile::new(&radii, &gaps, Smoothing::Auto).unwrap();
        assert!((profile.removed() / noise - 1.0).abs() < 0.1, "{}", profile.removed());
        let cutoff = profile.cutoff().unwrap();
        assert!((0.01..0.1).contains(&cutoff), "{cutoff}");
        assert!(
            (profile.feature_length().unwrap() / 0.1 - 1.0).abs() < 0.2,
            "{:?}",
            profile.feature_length()
        );
    }

    #[test]
    fn nothing_is_known_beyond_the_last_row() {
        let radii = even(20, 0.3);
        let profile = Profile::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
        assert!(profile.jet(0.3).value.is_finite() && profile.jet(0.3_f64.next_up()).value.is_finite());
        for r in [0.300_000_1, 1e9, f64::NAN] {
            assert!(profile.jet(r).value.is_nan() && profile.jet(r).third.is_nan(), "{r}");
        }
    }

    #[test]
    fn a_dimple_is_reduced_by_its_width() {
        let radii = even(20, 0.3);
        let gaps: Vec<f64> = radii.iter().map(|r| -r * r).collect();
        let profile = Profile::new(&radii, &gaps, Smoothing::None).unwrap();
        assert_eq!((profile.radius_of_curvature(), profile.reference_length()), (None, 0.3));
        let flat = Profile::new(&radii, &[0.0; 21], Smoothing::Auto).unwrap();
        assert_eq!(flat.jet(0.1), Jet::default());
    }

    #[test]
    fn rows_that_are_no_profile_are_refused_with_their_number() {
        let good = even(9, 1.0);
        let refused = |change: &dyn Fn(&mut Vec<f64>, &mut Vec<f64>), smoothing| {
            let (mut radii, mut gaps) = (good.clone(), vec![0.5; 10]);
            change(&mut radii, &mut gaps);
            Profile::new(&radii, &gaps, smoothing).unwrap_err()
        };
        let plain = |change: &dyn Fn(&mut Vec<f64>, &mut Vec<f64>)| refused(change, Smoothing::None);
        assert_eq!(plain(&|r, _| r.truncate(9)), InvalidProfile::Columns { radii: 9, gaps: 10 });
        let few = |r: &mut Vec<f64>, h: &mut Vec<f64>| (r.truncate(7), h.truncate(7)).0;
        assert_eq!(plain(&few), InvalidProfile::TooFew(7));
        assert_eq!(plain(&|_, h| h[4] = f64::INFINITY), InvalidProfile::NotFinite(4));
        assert_eq!(plain(&|r, _| r[0] = -0.1), InvalidProfile::Negative { row: 0, radius: -0.1 });
        let same = InvalidProfile::NotAscending { row: 3, radius: good[2], before: good[2] };
        assert_eq!(plain(&|r, _| r[3] = r[2]), same);
        for cutoff in [0.0, -1.0, f64::NAN, 112.0] {
            let error = refused(&|_, _| (), Smoothing::Cutoff(cutoff)).to_string();
            assert!(error.contains("out of range"), "{error}");
        }
    }

    fn noisy(radii: &[f64], noise: f64) -> Vec<f64> {
        let mut random = SplitMix64::new(5);
        let noise = noise * 6.0_f64.sqrt();
        sampled(&wavy(), radii)
            .into_iter()
            .map(|h| h + noise * (random.unit() + random.unit() - 1.0))
            .collect()
    }

    /// The largest error of the slope up to `to`.
    fn error(profile: &Profile, to: f64) -> f64 {
        (0..=2000)
            .map(|i| to * f64::from(i) / 2000.0)
            .map(|r| (profile.jet(r).first - wavy().jet(r).first).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn many_rows_are_averaged_in_cells() {
        let radii = even(40_000, 0.5);
        let profile = Profile::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
        let cells = profile.cells().unwrap();
        assert_eq!((cells.rows, cells.count), (40_001, MOST_KNOTS));
        assert!((cells.width / 1.25e-4 - 1.0).abs() < 1e-12);
        // The axis, every mean, the last row.
        assert_eq!((profile.knots().len(), profile.largest_radius()), (MOST_KNOTS + 2, Some(0.5)));
        // A cell mean passes sin(x)/x of the wave, x = πw/λ.
        let x = std::f64::consts::PI * cells.width / 0.1;
        let lost = 0.0025 * TAU / 0.1 * (1.0 - x.sin() / x);
        assert!(error(&profile, 0.45) < 2.0 * lost + 1e-7, "{}", error(&profile, 0.45));
        assert_eq!(
            profile.remarks(&UnitSystem::Reduced),
            ["40 001 rows averaged in 4000 cells of 0.000125: waves shorter than 0.0005 are not in the gap"]
        );
        // As many rows as there may be knots are knots.
        let radii = even(3999, 0.5);
        let profile = Profile::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
        assert_eq!(
            (profile.cells(), profile.knots().len(), profile.remarks(&UnitSystem::Reduced).len()),
            (None, 4000, 0)
        );
        assert_eq!(profile.coarser(&radii, &sampled(&wavy(), &radii)), None);
    }

    #[test]
    fn averaging_takes_noise_away_and_leaves_the_wave() {
        let radii = even(200_000, 0.6);
        let gaps = noisy(&radii, 2e-5);
        let auto = Profile::new(&radii, &gaps, Smoothing::Auto).unwrap();
        assert!((auto.removed() / 2e-5 - 1.0).abs() < 0.02, "{}", auto.removed());
        assert!((0.004..0.1).contains(&auto.cutoff().unwrap()), "{:?}", auto.cutoff());
        assert!(error(&auto, 0.55) < 3e-3, "{}", error(&auto, 0.55));
        let given = Profile::new(&radii, &gaps, Smoothing::Cutoff(0.04)).unwrap();
        let cells = given.cells().unwrap();
        assert_eq!(cells.count, 120);
        assert!(error(&given, 0.55) < 0.05 * 0.157, "{}", error(&given, 0.55));
        let said = given.remarks(&UnitSystem::Reduced);
        assert_eq!(said[0], "200 001 rows averaged in 120 cells of 0.005");
        assert!(said[1].starts_with("smoothing: waves of 0.04 pass by half, shorter ones less"), "{said:?}");
        // The same cutoff in cells of twice the width.
        let coarser = given.coarser(&radii, &gaps).unwrap();
        assert_eq!((coarser.cells().unwrap().count, coarser.cutoff()), (60, given.cutoff()));
        assert_ne!(coarser.pieces, given.pieces);
    }

    #[test]
    fn a_cutoff_passes_half_of_its_wave_through_cells_too() {
        // Beside the wave a parabola, of which the paraboloid takes nearly all.
        let (n, wavelength) = (100_000, 0.02);
        let radii = even(n, 1.0);
        let gaps: Vec<f64> =
            radii.iter().map(|r| r * r / 2.0 + 1e-3 * (TAU * r / wavelength).cos()).collect();
        for (cutoff, share) in [(0.02, 0.487), (0.01, 0.93)] {
            let profile = Profile::new(&radii, &gaps, Smoothing::Cutoff(cutoff)).unwrap();
            let (crest, trough) = (profile.jet(0.5).value, profile.jet(0.51).value);
            let passed = (crest - trough + (0.51 * 0.51 - 0.25) / 2.0) / 2e-3;
            assert!((passed - share).abs() < 0.01, "{cutoff}: {passed}");
        }
    }

    #[test]
    fn any_cutoff_up_to_the_last_radius_smooths() {
        let mut random = SplitMix64::new(9);
        for n in [300, 4000, 20_000] {
            let radii = even(n, 2e-4);
            let gaps: Vec<f64> = radii.iter().map(|r| r * r / 2e-2 + 1e-9 * (random.unit() - 0.5)).collect();
            for share in [0.002, 0.01, 0.1, 0.3, 0.77, 1.0] {
                let profile = Profile::new(&radii, &gaps, Smoothing::Cutoff(share * 2e-4)).unwrap();
                assert!(profile.cutoff().is_some_and(|cutoff| (cutoff / (share * 2e-4) - 1.0).abs() < 1e-14));
                let noise = if share < 0.1 { 1e-9 } else { 1e-10 };
                for r in [1e-5, 1e-4, 2e-4] {
                    let off = (profile.jet(r).value - r * r / 2e-2).abs();
                    assert!(off < noise, "{n} rows, {share}: {off:e} at {r}");
                }
            }
        }
    }

    #[test]
    fn cutoffs_that_need_too_many_cells_are_refused_with_one_that_works() {
        let radii = even(50_000, 0.5);
        let gaps = noisy(&radii, 1e-5);
        let refused = |cutoff| Profile::new(&radii, &gaps, Smoothing::Cutoff(cutoff)).unwrap_err();
        for cutoff in [1e-4, 0.6, 0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = refused(cutoff);
            assert!(error.is_of_smoothing());
            let said = error.to_string();
            assert!(said.contains("out of range") && said.contains("from 0.001 to 0.5"), "{said}");
        }
        for cutoff in [0.001, 0.5] {
            assert!(Profile::new(&radii, &gaps, Smoothing::Cutoff(cutoff)).is_ok());
        }
    }

    #[test]
    fn empty_cells_are_refused_with_their_radius_and_a_cutoff_that_works() {
        let radii: Vec<f64> = even(50_000, 0.5).into_iter().filter(|r| !(0.2..0.21).contains(r)).collect();
        let gaps = noisy(&radii, 1e-5);
        for smoothing in [Smoothing::None, Smoothing::Auto, Smoothing::Cutoff(0.01)] {
            let error = Profile::new(&radii, &gaps, smoothing).unwrap_err();
            assert!(error.is_of_smoothing());
            let said = error.to_string();
            assert!(said.contains("no row lies between the radii 0.19999 and 0.21"), "{said}");
            let works =
                said.split("gap.smoothing = ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
            let cutoff = works.parse().unwrap();
            assert!(Profile::new(&radii, &gaps, Smoothing::Cutoff(cutoff)).is_ok(), "{said}");
        }
        // Without half of the radii no cutoff helps.
        let radii: Vec<f64> = even(50_000, 0.5).into_iter().filter(|r| !(0.2..0.4).contains(r)).collect();
        let said = Profile::new(&radii, &noisy(&radii, 1e-5), Smoothing::None).unwrap_err().to_string();
        assert!(
            said.contains("no gap.smoothing has cells wide enough, but at most 4000 rows need no cells"),
            "{said}"
        );
        // Few rows stay knots instead.
        let radii: Vec<f64> = even(2000, 0.5).into_iter().filter(|r| !(0.2..0.3).contains(r)).collect();
        let profile = Profile::new(&radii, &noisy(&radii, 1e-5), Smoothing::Cutoff(0.05)).unwrap();
        assert_eq!(profile.cells(), None);
    }

    #[test]
    fn it_does_not_matter_how_many_rows_fall_in_a_cell() {
        let mut random = SplitMix64::new(21);
        let mut radii: Vec<f64> = (0..100_000).map(|_| 0.5 * random.unit()).collect();
        radii.extend([0.0, 0.5]);
        radii.sort_by(f64::total_cmp);
        radii.dedup();
        let profile = Profile::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
        assert!(error(&profile, 0.49) < 1e-4, "{}", error(&profile, 0.49));
        // As many as the cells, to rounding on their borders, and a few more.
        for n in [4000, 4001, 4100, 5500, 7999, 8000, 8001] {
            let radii = even(n, 0.5);
            let profile = Profile::new(&radii, &sampled(&wavy(), &radii), Smoothing::None).unwrap();
            assert!(
                profile.cells().is_some() && error(&profile, 0.49) < 3e-4,
                "{n}: {}",
                error(&profile, 0.49)
            );
        }
    }
}
