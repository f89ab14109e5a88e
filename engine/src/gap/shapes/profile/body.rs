//! Rows turned into a curve: the paraboloid is taken off, and what is left is averaged in cells or smoothed.

use super::curve::ProfileGap;
use super::invalid::{CLOSEST, Cells, FEWEST_ROWS, InvalidProfile, MOST_KNOTS, largest};
use crate::elementary::{exp2, log2, log10, pow};
use crate::gap::Jet;
use crate::gap::shapes::spline::{SplineFit, SplineRows, widths};
use std::f64::consts::TAU;

/// The number of cells in a cutoff.
const CELLS_IN_CUTOFF: f64 = 8.0;

/// The largest cutoff at which rows stay knots, in mean distances between rows: nine digits of the curve are left.
const KEPT_SPACINGS: f64 = 64.0;

/// The same where a cell would otherwise be empty: six digits are left.
const MOST_SPACINGS: f64 = 1000.0;

/// A cutoff that is out of range by less than this share counts as in range: messages round to six digits.
const ROUNDED: f64 = 1e-5;

/// A cutoff of this many times the widest distance between neighbours leaves no cell empty. It is more than eight
/// because the number of cells is whole, so they can be up to an eighth narrower than asked for.
const WIDE_ENOUGH: f64 = 9.1;

/// Rows this many mean distances apart leave no hole, even if a cell falls between them.
const NO_HOLE: f64 = 2.0;

/// Below this share of the largest gap, what the paraboloid leaves is rounding.
const NO_WAVES: f64 = 1e-12;

/// The rows scaled to order one by powers of two: fourth powers of lengths stay in range, and numbers keep their
/// digits.
pub(super) struct Body {
    /// The units of x and y.
    pub(super) length: f64,
    height: f64,
    /// The largest gap.
    highest: f64,
    curvature: f64,
    x: Vec<f64>,
    /// What the paraboloid leaves.
    left: Vec<f64>,
    weights: Vec<f64>,
}

/// What the spline goes through or near: rows, or means of cells.
pub(super) struct SplinePoints {
    x: Vec<f64>,
    values: Vec<f64>,
    weights: Vec<f64>,
    /// The number of cells.
    cells: Option<usize>,
}

impl Body {
    pub(super) fn new(radii: &[f64], gaps: &[f64]) -> Self {
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

    /// The mean distance between the rows.
    fn spacing(&self) -> f64 {
        (self.last() - self.x[0]) / (self.x.len() - 1) as f64
    }

    /// Whether every row can be a knot.
    pub(super) fn is_small(&self) -> bool {
        self.x.len() <= MOST_KNOTS
    }

    pub(super) fn rows(&self) -> SplinePoints {
        SplinePoints {
            x: self.x.clone(),
            values: self.left.clone(),
            weights: self.weights.clone(),
            cells: None,
        }
    }

    /// The means in `count` cells of equal width.
    pub(super) fn cells(&self, count: usize) -> Result<SplinePoints, InvalidProfile> {
        let (x, last) = (&self.x, self.last());
        let width = last / count as f64;
        let widest = width.max(NO_HOLE * self.spacing()) * (1.0 + ROUNDED);
        let mut values = Vec::with_capacity(count);
        // How many rows have been passed, and how far the integral has come.
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
        Ok(SplinePoints { x: middles, values, weights: vec![width; count], cells: Some(count) })
    }

    /// What the paraboloid leaves at x, on the straight line from the row before `next` to row `next`. Before the first
    /// row it is constant.
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

    /// The error for a cell between these radii that has no row.
    fn empty(&self, radii: [f64; 2], cells: Cells) -> InvalidProfile {
        let [before, behind] = radii.map(|x| x * self.length);
        let widest = self.x.windows(2).map(|pair| pair[1] - pair[0]).fold(self.x[0], f64::max);
        let works = two_digits_up(WIDE_ENOUGH * widest * self.length);
        let works = (works <= self.last() * self.length).then_some(works);
        InvalidProfile::Empty { before, behind, cells, works }
    }

    /// The cutoff found from the noise.
    pub(super) fn found(&self) -> Result<f64, InvalidProfile> {
        let last = self.last();
        let (points, spacing) = if self.is_small() {
            (self.rows(), self.spacing())
        } else {
            (self.cells(MOST_KNOTS)?, last / MOST_KNOTS as f64)
        };
        let rows = SplineRows::new(&points.x, &points.values, &points.weights);
        Ok(rows.cutoff(2.0 * spacing, last.min(MOST_SPACINGS * spacing)))
    }

    /// The curve smoothed with a cutoff. A `given` cutoff is refused if it needs more cells than are allowed.
    pub(super) fn smoothed(&self, cutoff: f64, given: bool) -> Result<ProfileGap, InvalidProfile> {
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
        // Between 8 and the largest number of cells.
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
    pub(super) fn curve(
        &self,
        points: &SplinePoints,
        cutoff: Option<f64>,
    ) -> Result<ProfileGap, InvalidProfile> {
        let rows = SplineRows::new(&points.x, &points.values, &points.weights);
        let unsolved = || InvalidProfile::Unsolved(cutoff.unwrap_or(0.0) * self.length);
        let fit = rows.fit(cutoff.unwrap_or(0.0)).ok_or_else(unsolved)?;
        let last = self.last();
        let axis = axis(&fit, points.x[0]);
        let (knots, pieces) = pieces(&rows, &fit, &points.x, last, self.curvature);
        let count_in = |count: usize| Cells { rows: self.x.len(), count, width: last / count as f64 };
        let mut profile = ProfileGap {
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

/// The mean distance between the crests of f; none where f is only rounding or the distance exceeds the profile.
fn feature(rows: &SplineRows, fit: &SplineFit, height: f64, widest: f64) -> Option<f64> {
    let weights = rows.weights();
    let mean = fit.values.iter().zip(weights).map(|(g, w)| g * w).sum::<f64>() / weights.iter().sum::<f64>();
    if rms(fit.values.iter().map(|g| g - mean), weights) <= NO_WAVES * height {
        return None;
    }
    let slope = rms(rows.pieces(fit).iter().map(|piece| piece.first), weights);
    let bend = rms(fit.second.iter().copied(), weights);
    Some(TAU * slope / bend).filter(|wave| *wave < widest)
}

/// f(0): an even cubic is a parabola, so the second derivative at the first radius holds up to the axis.
fn axis(fit: &SplineFit, first: f64) -> f64 {
    fit.values[0] - 0.5 * fit.second[0] * first * first
}

/// The knots from the axis to `last`, and the jets of h there.
fn pieces(rows: &SplineRows, fit: &SplineFit, x: &[f64], last: f64, curvature: f64) -> (Vec<f64>, Vec<Jet>) {
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
