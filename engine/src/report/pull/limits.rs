//! Where a pull leaves the range in which its numbers hold.

use super::super::number::significant;
use super::super::table::ascii_unit;
use super::text::shown;
use super::{Factors, RELAXED};
use crate::case::Case;
use crate::preset::Preset;
use crate::problem::Control;
use crate::progress::Progress;
use crate::quasistatic::admissible::Judge;
use crate::rate::Pull;
use crate::units::Quantity;

/// The contact radius at which a dead load has all but fallen: the last hundredth of the time is left.
fn before_fall(pull: &Pull) -> f64 {
    const OF_TIME: f64 = 0.99;
    let last = pull.moments.last().map_or(0.0, |moment| moment.time);
    let before = pull.moments.iter().rfind(|moment| moment.time <= OF_TIME * last);
    before.map_or(0.0, |moment| moment.contact_radius)
}

impl Factors {
    /// Where a pull leaves the range in which the law is good.
    pub(super) fn limits(
        &self,
        preset: &Preset,
        case: &Case,
        rate: Option<&f64>,
        pull: &Pull,
        progress: &dyn Progress,
    ) -> Vec<String> {
        let spec = &preset.edge;
        let at = rate.map_or_else(String::new, |rate| {
            let quantity = if case.control == Control::Force { Quantity::ForceRate } else { Quantity::Speed };
            format!("at the rate {}: ", shown(&case.shown, quantity, *rate))
        });
        let mut warnings = Vec::new();
        // Towards the last contact G grows without bound whatever the rate: what matters is what the edge passes before
        // that, up to the largest pull, or to the fall of a dead load, and in every snap.
        let falls = if case.control == Control::Force { before_fall(pull) } else { pull.peak.contact_radius };
        let inner = pull.snaps.iter().map(|snap| snap.to).fold(falls, f64::min);
        let watched =
            pull.moments.iter().filter(|moment| moment.contact_radius >= inner.max(f64::MIN_POSITIVE));
        let ratios =
            watched.map(|at| [at.energy_release_rate / case.reduced.work_of_adhesion, at.contact_radius]);
        let highest = ratios.max_by(|a, b| a[0].total_cmp(&b[0]));
        if let Some((bound, [ratio, radius])) =
            spec.highest_ratio.zip(highest).filter(|(bound, at)| at[0] > *bound)
        {
            let radius = shown(&case.shown, Quantity::Length, radius * self.length);
            warnings.push(format!(
                "{at}G/gamma reaches {} at the contact radius {radius}, above edge.highest_ratio = {bound}: the law of the \
                 edge does not extend that far",
                significant(ratio, 4)
            ));
        }
        if let Some(tau) = spec.relaxation_time {
            let tau = tau / self.time();
            let way = pull.last_contact.map_or(pull.peak.control, |last| last.control).abs();
            let rate = rate.map(|rate| rate / self.control * self.time());
            if let Some(rate) = rate.filter(|rate| rate * tau > RELAXED * way) {
                warnings.push(format!(
                    "{at}within edge.relaxation_time the control moves by {} of its value at the last contact; above \
                     {RELAXED} the bodies are not relaxed, and the force is larger than computed",
                    significant(rate * tau / way, 3)
                ));
            }
            let length = case.reduced.gap.feature_length().unwrap_or(f64::INFINITY);
            for snap in &pull.snaps {
                let (zone, room) = (snap.top_speed * tau, length.min(snap.to.max(f64::MIN_POSITIVE)));
                if zone > room {
                    warnings.push(format!(
                        "{at}in the snap from {} the edge moves {} times min(s, wavelength) within edge.relaxation_time: \
                         its zone of dissipation does not fit there",
                        shown(&case.shown, Quantity::Length, snap.from * self.length),
                        significant(zone / room, 3)
                    ));
                    break;
                }
            }
        }
        if let Some([s, delta]) = pull.closed_to {
            let judge = Judge::new(&case.reduced, &case.table);
            if let Some(crest) = judge.verdict(s, delta, progress).overlapping() {
                warnings.push(format!(
                    "{at}while the edge closes to {}, the bodies would touch ahead of it, at {}: a pull follows only one \
                     disc",
                    shown(&case.shown, Quantity::Length, s * self.length),
                    shown(&case.shown, Quantity::Length, crest.radius * self.length)
                ));
            }
        }
        warnings
    }

    /// Where the bodies would overlap outside the disc at the start, at this approach. An edge that opens takes them apart.
    pub(super) fn overlap_at_start(
        &self,
        case: &Case,
        approach: f64,
        progress: &dyn Progress,
    ) -> Option<f64> {
        let judge = Judge::new(&case.reduced, &case.table);
        Some(judge.verdict(case.start, approach, progress).overlapping()?.radius * self.length)
    }

    pub(super) fn warning_of_start(&self, case: &Case, overlap: f64) -> String {
        let start = shown(&case.shown, Quantity::Length, case.start * self.length);
        // The same place for all loads, and said once.
        let overlap = ascii_unit(&case.shown, Quantity::Length, overlap, |r| significant(r, 3));
        format!(
            "the disc of radius {start} at the start cannot exist alone: outside it the bodies would overlap at r = {overlap}. \
             One disc is followed all the same, and its numbers do not hold"
        )
    }
}
