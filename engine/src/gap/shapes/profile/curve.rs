//! The curve of a profile, cubics between knots, as a gap.

use super::invalid::{Cells, grouped, length};
use crate::gap::{Breaks, ComplexDisc, Gap, Jet, Parity};
use crate::gap::{function::Form, function::Piece};
use crate::units::UnitSystem;

/// How far beyond the last row rounding may put a radius: what converting units there and back may cost.
const ROUNDING: f64 = 1e-15;

/// The gap of a measured profile.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileGap {
    /// 0, the radii of the rows or the middles of the cells, and the last radius.
    pub(super) knots: Vec<f64>,
    /// The jet at each knot but the last, which gives the cubic from there on.
    pub(super) pieces: Vec<Jet>,
    pub(super) curvature: f64,
    pub(super) feature: Option<f64>,
    pub(super) cutoff: Option<f64>,
    pub(super) removed: f64,
    pub(super) cells: Option<Cells>,
}

impl ProfileGap {
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

    /// Which details of the rows the curve leaves out, in words, with numbers as `units` show them.
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
            format!(
                "smoothing: waves of {cutoff} are halved, shorter ones reduced more; what it removes has \
                an rms of {removed}"
            )
        });
        averaged.into_iter().chain(passed).collect()
    }

    /// The same curve in other units; its present units of length and height are `length` and `height` of the new ones.
    pub(super) fn scaled(mut self, length: f64, height: f64) -> Self {
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

    /// The jet at `r`. The piece `at` is tried first, and is then set to the piece of `r`.
    pub(super) fn jet_near(&self, r: f64, at: &mut usize) -> Jet {
        if !self.is_known(r) {
            return Jet::UNKNOWN;
        }
        // Sums ask for radii in order: most lie in the same piece as the previous one.
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

    /// The cubic of this piece at `r`, inside the piece or continued beyond it.
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

impl Gap for ProfileGap {
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
        Breaks { knots: &self.knots[1..], axis: Parity::Odd, cubic: true }
    }

    /// h' is a parabola on each piece.
    fn slope_bound(&self, ComplexDisc { centre, radius, branch }: ComplexDisc) -> Option<f64> {
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
