//! The states that are not admissible, as part of a document and in words.

use super::number::{significant, with_unit};
use crate::problem::Units;
use crate::quasistatic::Overlap;
use crate::units::{Quantity, UnitSystem};
use serde::Serialize;

/// Neighbouring states that are not admissible.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct OverlapReport {
    /// The largest contact radius.
    pub from_contact_radius: f64,
    /// The smallest contact radius.
    pub to_contact_radius: f64,
    /// r of the crest that would overlap most; null where only the pressure is at fault.
    pub crest_radius: Option<f64>,
    /// Which crest of the waves it is.
    pub crest_wave: Option<u64>,
}

/// The most intervals listed one by one in words; a document lists all.
const TOLD: usize = 3;

impl OverlapReport {
    /// Reduced intervals in the user's units.
    pub fn all(overlaps: &[Overlap], units: &Units) -> Vec<Self> {
        let report = |overlap: &Overlap| Self {
            from_contact_radius: overlap.from * units.length,
            to_contact_radius: overlap.to * units.length,
            crest_radius: overlap.crest.map(|crest| crest.radius * units.length),
            crest_wave: overlap.crest.and_then(|crest| crest.wave),
        };
        overlaps.iter().map(report).collect()
    }

    /// The interval in words, with its lengths as `units` show them, in ASCII where the terminal has no more.
    pub fn text(&self, units: &UnitSystem, ascii: bool) -> String {
        let length = |x| with_unit(units, Quantity::Length, x, ascii, |x| significant(x, 4));
        let fault = self.crest_radius.map_or_else(
            || "where the disc would have to pull".to_owned(),
            |radius| format!("at the crest r = {}", length(radius)),
        );
        let [from, to] = [self.from_contact_radius, self.to_contact_radius].map(length);
        format!("s = {from} to {to} {fault}")
    }
}

/// One line saying that something (`passes`: the curve, the path) crosses such states; `None` where there are none.
pub fn warning(passes: &str, overlaps: &[OverlapReport], units: &UnitSystem) -> Option<String> {
    if overlaps.is_empty() {
        return None;
    }
    let mut told: Vec<String> = overlaps.iter().take(TOLD).map(|overlap| overlap.text(units, true)).collect();
    if let Some(more) = overlaps.len().checked_sub(TOLD).filter(|more| *more > 0) {
        told.push(format!("and {more} more"));
    }
    let intervals = if overlaps.len() == 1 { "1 interval" } else { &format!("{} intervals", overlaps.len()) };
    // Where a crest touches, contact goes on in rings.
    let touches = overlaps.iter().any(|overlap| overlap.crest_radius.is_some());
    let rings = if touches { "; the real path has rings of contact there (pulloff cycle)" } else { "" };
    Some(format!("{passes} crosses {intervals} of inadmissible states: {}{rings}", told.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::DisplayUnits;

    #[test]
    fn many_intervals_are_one_line() {
        let overlap = |crest_radius| OverlapReport {
            from_contact_radius: 0.474_12,
            to_contact_radius: 0.463,
            crest_radius,
            crest_wave: None,
        };
        assert_eq!(warning("the curve", &[], &UnitSystem::Reduced), None);
        let one = warning("the path", &[overlap(None)], &UnitSystem::Reduced).unwrap();
        assert!(one.starts_with("the path crosses 1 interval of inadmissible states: s = 0.4741 to 0.4630"));
        assert!(one.ends_with("pull"), "{one}");
        let many = warning("the curve", &[overlap(Some(0.5)); 9], &UnitSystem::Reduced).unwrap();
        assert!(
            many.contains("9 intervals")
                && many.contains("at the crest r = 0.5000, and 6 more; the real path"),
            "{many}"
        );
        assert_eq!(many.lines().count(), 1);
        let si = UnitSystem::Si(DisplayUnits::default());
        assert_eq!(
            overlap(Some(0.5e-3)).text(&si, true),
            "s = 474120 um to 463000 um at the crest r = 500.0 um"
        );
    }
}
