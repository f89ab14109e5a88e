//! A formula as the gap of a problem.

use super::bound::Bound;
use super::survey::NoGap;
use crate::gap::{Breaks, ComplexDisc, Gap, Jet, Parity};

/// How far a formula is examined, as a multiple of the radius asked for.
const BEYOND: f64 = 16.0;

/// The share of the radius that is needed where none is asked for.
const NEAR_AXIS: f64 = 1e-3;

/// A formula with its parameters, known to be finite up to a radius.
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaGap {
    bound: Bound,
    largest: f64,
    feature_length: Option<f64>,
    known: Option<f64>,
    corners: Vec<f64>,
    /// How far out corners have been looked for.
    searched: f64,
    axis: Parity,
}

impl Bound {
    /// The formula as a gap on 0 ≤ r ≤ `largest`, which must be positive and at least every radius of contact.
    ///
    /// # Errors
    /// Where h, h' or h'' is not finite, or h jumps.
    pub fn over(self, largest: f64) -> Result<FormulaGap, NoGap> {
        self.check(largest)?;
        Ok(self.gap(largest, largest, None))
    }

    /// The formula as a gap that is known as far as it is finite; its waves are looked for up to `largest`.
    ///
    /// If `needed`, it must be finite up to there, otherwise at least near the axis.
    ///
    /// # Errors
    /// Where h, h' or h'' is not finite, or h jumps.
    pub fn from_axis(self, largest: f64, needed: bool) -> Result<FormulaGap, NoGap> {
        let most = if needed { largest } else { NEAR_AXIS * largest };
        let known = match self.check(BEYOND * largest) {
            Ok(()) => None,
            Err(no_gap) if no_gap.radius <= most => return Err(NoGap { largest: most, ..no_gap }),
            Err(NoGap { radius, .. }) => Some(radius),
        };
        let waves = known.map_or(largest, |known| largest.min(known * (1.0 - f64::EPSILON)));
        Ok(self.gap(largest, waves, known))
    }

    /// The gap, with its waves and corners looked for up to `surveyed`.
    fn gap(self, largest: f64, surveyed: f64, known: Option<f64>) -> FormulaGap {
        let feature_length = self.feature_length(surveyed);
        // A path may run outward from its start.
        let searched = known.map_or(BEYOND * surveyed, |known| known.min(BEYOND * surveyed));
        let corners = self.breaks(searched);
        let first = corners.first().copied().unwrap_or(surveyed).min(feature_length.unwrap_or(surveyed));
        let axis = self.axis(first);
        FormulaGap { bound: self, largest, feature_length, known, corners, searched, axis }
    }
}

impl FormulaGap {
    /// The formula with its parameters.
    pub fn bound(&self) -> &Bound {
        &self.bound
    }
}

impl Gap for FormulaGap {
    fn jet(&self, r: f64) -> Jet {
        if self.known.is_some_and(|known| r >= known) { Jet::UNKNOWN } else { self.bound.jet(r) }
    }

    fn values(&self, s: f64, nodes: &[f64], values: &mut [f64]) {
        self.bound.values(s, nodes, values);
        for (value, x) in values.iter_mut().zip(nodes) {
            if self.known.is_some_and(|known| s * x >= known) {
                *value = f64::NAN;
            }
        }
    }

    fn derivatives(&self, s: f64, nodes: &[f64], [first, second, third]: [&mut [f64]; 3]) {
        self.bound.derivatives(s, nodes, [&mut *first, &mut *second, &mut *third]);
        for (i, x) in nodes.iter().enumerate() {
            if self.known.is_some_and(|known| s * x >= known) {
                (first[i], second[i], third[i]) = (f64::NAN, f64::NAN, f64::NAN);
            }
        }
    }

    fn feature_length(&self) -> Option<f64> {
        self.feature_length
    }

    fn breaks(&self) -> Breaks<'_> {
        Breaks { knots: &self.corners, axis: self.axis, cubic: false }
    }

    fn slope_bound(&self, disc: ComplexDisc) -> Option<f64> {
        Some(self.bound.slope_bound(disc))
    }

    fn breaks_up_to(&self, to: f64) -> Vec<f64> {
        if to <= self.searched {
            self.breaks().between(0.0, to).to_vec()
        } else {
            self.bound.breaks(self.known.map_or(to, |known| known.min(to)))
        }
    }

    /// The largest radius, since a formula need not have a radius of curvature.
    fn reference_length(&self) -> f64 {
        self.largest
    }

    fn largest_radius(&self) -> Option<f64> {
        self.known
    }
}
