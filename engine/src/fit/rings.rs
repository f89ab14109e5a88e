//! Loading with rings of contact, which no path of one disc describes: where it begins, and the fit without it.

use super::options::FitError;
use super::path::Foot;
use super::problem::FitProblem;
use crate::measured::Segment;
use crate::units::{Quantity, number::said};

impl FitProblem {
    /// Where the disc of loading at `u` would overlap a crest outside before the last point of the approach, in words.
    pub(super) fn overlapping(&self, u: &[f64]) -> Option<String> {
        if !self.loops {
            return None;
        }
        let paths = self.paths(u)?;
        let feet = self.feet(&paths, &self.instrument_at(u))?;
        let of = self.data.iter().zip(&feet).filter(|(datum, _)| datum.segment == Segment::Approach);
        let radius = |foot: &super::distance::Nearest| match foot.foot {
            Foot::Radius(s) => Some(s),
            _ => None,
        };
        let widest = of.filter_map(|(_, foot)| foot.as_ref().and_then(radius)).fold(0.0, f64::max);
        let overlap = paths.of(Segment::Approach).overlap(widest)?;
        let shown = |s: f64| said(&self.preset.units, Quantity::Length, s);
        Some(format!("a crest outside touches when the contact radius is {}", shown(overlap)))
    }

    /// The same problem without the approach.
    ///
    /// # Errors
    /// [`FitError::Loading`] where nothing is left, or the approach has a work of adhesion of its own.
    pub(super) fn without_loading(mut self, why: String, notes: &mut Vec<String>) -> Result<Self, FitError> {
        let before = self.data.len();
        self.data.retain(|datum| datum.segment == Segment::Retraction);
        if self.data.is_empty() || self.splits() {
            return Err(FitError::Loading(why));
        }
        notes.push(format!(
            "the {} points of the approach are left out: {why}, and rings of contact are not fitted",
            before - self.data.len()
        ));
        self.loops = false;
        Ok(self)
    }
}
