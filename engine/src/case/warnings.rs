//! What to be careful about in a case, in words.

use super::Case;
use crate::problem::cohesion::TABOR_OVER_MAUGIS;
use crate::problem::groups::LARGE_TABOR;
use crate::problem::{Control, Problem};
use crate::quasistatic::admissible::{Judge, falls};
use crate::quasistatic::beyond::{is_smaller_beyond, is_smaller_beyond_zone, is_smaller_within};
use crate::quasistatic::monotone::weighted;
use crate::quasistatic::path::{Direction, Path, PathState, PathStop};
use crate::theory::maugis::Maugis;
use crate::units::Quantity;
use crate::units::number::{said, short};

impl Case {
    /// Warnings for a largest contact of radius `largest` (reduced).
    pub fn warnings(&self, largest: f64) -> Vec<String> {
        let mut warnings = self.warnings_of_problem(largest);
        warnings.extend(self.basis.cautions(&self.reduced, largest));
        warnings
    }

    /// The same without those of the basis.
    pub fn warnings_of_problem(&self, largest: f64) -> Vec<String> {
        let mut warnings = self.problem.shape.notes(&self.shown);
        if let Some(tabor) = self.tabor.filter(|tabor| self.cohesion.is_none() && *tabor < LARGE_TABOR) {
            warnings.push(format!(
                "Tabor's mu = {tabor:.2} is below {LARGE_TABOR}: the adhesion reaches beyond the edge, and the JKR limit \
                 of this method does not hold{}",
                self.change_with_range(tabor)
            ));
        }
        warnings.extend(self.warning_of_slope(largest));
        warnings.extend(self.warning_of_size(largest));
        warnings
    }

    /// A warning, if the gap is steep within the radius `largest` (reduced): the theory of a half-space needs small slopes.
    fn warning_of_slope(&self, largest: f64) -> Option<String> {
        let said = short(self.problem.shape.steep_slope(largest * self.units().length)?, 2);
        Some(format!("the gap has slopes up to {said}: this theory is for slopes small beside 1"))
    }

    /// A warning, if an unloading starts where larger contacts pull more than all on its way.
    pub fn warning_of_start(&self, path: &Path) -> Option<String> {
        // A path from the first touch has no start that could be elsewhere, even if it stops before it turns.
        let opens = |start: &&PathState| start.direction == Direction::Unloading;
        let start =
            path.start().filter(|start| start.rings() == 0 && start.contact_radius > 0.0).filter(opens)?;
        let start = start.contact_radius;
        if !self.is_cut_off(path, Control::Force) {
            return None;
        }
        let radius = said(&self.shown, Quantity::Length, start * self.units().length);
        Some(format!("start further out than {radius} for the largest pull: larger contacts pull more"))
    }

    /// Whether a stable contact larger than that at the start of an unloading has a smaller force, or a smaller approach,
    /// as `of` says, than all on its way.
    pub fn is_cut_off(&self, path: &Path, of: Control) -> bool {
        let least = if of == Control::Force { path.largest_pull() } else { path.farthest() };
        let ends = path.start().zip(least).filter(|(start, least)| start.rings() + least.rings() == 0);
        let Some((start, least)) = ends.filter(|_| path.turn.is_none()) else { return false };
        let (begun, held) = (start.contact_radius, Some(path.control));
        if let Some(law) = self.cohesion {
            let here = if of == Control::Force { least.force } else { least.approach };
            return is_smaller_beyond_zone((&self.table, &self.reduced, law), (begun, here), of, held);
        }
        of == Control::Force && path.pulls_most_at_start()
            || is_smaller_beyond(&self.table, &self.reduced, [begun, least.contact_radius], of, held)
    }

    /// A warning, if an unloading ends in contact, and would pull more further on.
    pub fn warning_of_end(&self, path: &Path) -> Option<String> {
        let end = said(&self.shown, Quantity::Length, self.end * self.units().length);
        let further = if self.end_is_given {
            "path.end_contact_radius = none goes on to the last contact"
        } else {
            "smaller contacts are not resolved"
        };
        self.ends_early(path, Control::Force).then(|| {
            format!(
                "the path ends in contact, at the contact radius {end}, and would pull more further on: {further}"
            )
        })
    }

    /// Whether an unloading ends in contact, and smaller contacts have a smaller force, or a smaller approach, as `of`
    /// says, than all on its way.
    pub fn ends_early(&self, path: &Path, of: Control) -> bool {
        if path.stop != PathStop::End || path.turn.is_some() || self.reduced.work_of_adhesion <= 0.0 {
            return false;
        }
        let value = |state: &PathState| weighted(of, state.approach, state.force);
        let least = path.states.iter().map(value).fold(f64::INFINITY, f64::min);
        let is_last = path.states.last().is_some_and(|last| value(last) <= least);
        is_last || is_smaller_within(&self.table, &self.reduced, (self.end, least), of, Some(path.control))
    }

    /// A warning, if a contact of radius `largest` (reduced) is larger than the bodies are round.
    fn warning_of_size(&self, largest: f64) -> Option<String> {
        let radius = self.problem.shape.radius_of_curvature()?;
        let largest = largest * self.units().length;
        let [shown, round] = [largest, radius].map(|r| said(&self.shown, Quantity::Length, r));
        (largest > radius).then(|| {
            format!(
                "the contact grows to {shown}, beyond the radius of curvature {round}: this theory is for contacts \
                 small beside it"
            )
        })
    }

    /// A warning, if there is a dead band, about states that do not include it.
    pub fn warning_of_dead_band(&self) -> Option<String> {
        self.closing?;
        Some(
            "these are states of an opening edge: a closing one gains only material.closing_work_of_adhesion, and in \
             between the edge rests; paths and pulls include both"
                .to_owned(),
        )
    }

    /// By how much the range of the adhesion changes the largest pull, and which key computes it.
    fn change_with_range(&self, tabor: f64) -> String {
        let Problem { effective_modulus, work_of_adhesion, ref shape } = self.problem;
        let Some(radius) = shape.radius_of_curvature() else { return String::new() };
        let sphere = Maugis::of(tabor / TABOR_OVER_MAUGIS, work_of_adhesion / (effective_modulus * radius));
        let change = 100.0 * (sphere.largest_pull() / 1.5 - 1.0);
        format!(
            ": for the smooth sphere, its range makes the largest pull {change:.1} % larger; material.adhesion = \
             \"dugdale\" includes it"
        )
    }

    /// Other remarks worth knowing, for a largest contact of radius `largest` (reduced).
    pub fn notes(&self, largest: f64) -> Vec<String> {
        let text = if self.reduced.work_of_adhesion > 0.0 {
            "the gap decreases within the contact: without adhesion it would not be one connected disc. Whether the \
             bodies stay apart outside the disc is checked; tension inside is not: in the JKR limit any adhesion, \
             however weak, bears tension"
        } else {
            "the gap decreases within the contact, and there is no adhesion: for a connected disc it is checked that \
             the bodies stay apart outside it and that nothing pulls inside it"
        };
        let mut notes = self.problem.shape.remarks(&self.shown);
        notes.extend(falls(self.reduced.gap.as_ref(), largest).then(|| text.to_owned()));
        if let Some(radius) = Judge::new(&self.reduced, &self.table).unknown_beyond(largest) {
            let radius = said(&self.shown, Quantity::Length, radius * self.units().length);
            notes.push(format!(
                "whether the bodies stay apart outside the disc is known up to r = {radius}, and unknown beyond"
            ));
        }
        notes
    }
}
