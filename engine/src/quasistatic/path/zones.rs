//! The equilibria of one disc in one zone, and which of them are no more than that.

use super::error::PathError;
use crate::disc::{Place, Solution, Table};
use crate::elementary::{atan2, sin};
use crate::problem::Cohesion;
use crate::progress::Progress;
use crate::quasistatic::places::{Detail, places};
use crate::root;
use crate::zone::{Ends, Equilibria, FaultKind, ZoneAt, ZoneFault, ZoneState, equilibria};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// The edge of the smallest zone that is drawn, as a share of the edge of the largest.
const SMALLEST: f64 = 1e-4;

/// How much further the equilibria reach each time they are grown.
pub(super) const FURTHER: f64 = 1.3;

/// Equilibria of one disc in one zone as far out as they are known, and what may lie beside them.
#[derive(Debug)]
pub struct Zones {
    equilibria: Equilibria,
    /// The equilibria over the outer edge of the zone.
    pub solution: Arc<dyn Solution>,
    /// The outermost place with contact of the radius that was asked for.
    pub start: Place,
}

impl Zones {
    /// The equilibria up to contact of the radius `s`.
    ///
    /// # Errors
    /// [`PathError`] where there is no such contact.
    pub fn up_to(
        table: &Arc<Table>,
        cohesion: Cohesion,
        s: f64,
        progress: &dyn Progress,
    ) -> Result<Self, PathError> {
        let about = equilibria::about(cohesion, s);
        let mut found = Self::grown(table, cohesion, about, &|state| state.contact_radius >= s, progress)?;
        let radius = found.equilibria.reach();
        let beyond = PathError::BeyondGap { radius, approach: f64::NAN, force: f64::NAN };
        found.start = place_of(&*found.solution, s).ok_or(beyond)?;
        Ok(found)
    }

    /// The equilibria up to the first panel at whose end `enough` says that they reach far enough, or to the end of
    /// the gap. They start at their outer end; the table begins with the reach `about`.
    ///
    /// # Errors
    /// [`PathError`] where the gap has no table.
    pub fn grown(
        table: &Arc<Table>,
        cohesion: Cohesion,
        about: f64,
        enough: &dyn Fn(&ZoneState) -> bool,
        progress: &dyn Progress,
    ) -> Result<Self, PathError> {
        let mut equilibria = Equilibria::new(table, cohesion, about, progress)?;
        equilibria.grow(enough, progress)?;
        let solution = equilibria.solution();
        let start = Place { panel: solution.len().saturating_sub(1), x: 1.0 };
        Ok(Self { equilibria, solution, start })
    }

    /// How s, δ and P of the zone at a place change with σ₀ and with `h_c` while its outer edge c is held (E* = 1, s = c cos ψ):
    ///
    /// ```text
    /// δ' = −(π/2ψ) h_c' − (2c/ψ)(1 − cos ψ) σ₀'      P' = 2s δ' − 2c²(ψ − sin ψ cos ψ) σ₀'      s' = −c sin ψ ψ'
    /// ψ' = [h_c' − (4c/π)(ψ sin ψ − 1 + cos ψ) σ₀']/D_ψ      D_ψ = (2ψ/π) c sin ψ [g'(s) + 2σ₀s/(c sin ψ)]
    /// ```
    ///
    /// from D(c, ψ) = `h_c` in the header of [`crate::zone::state`].
    pub fn moves(&self, place: Place) -> [[f64; 3]; 2] {
        let ZoneAt { edge: c, contact_radius: s, .. } = zone_at(&*self.solution, place);
        let sine = ((c - s) * (c + s)).max(0.0).sqrt() / c;
        let cosine = s / c;
        let angle = atan2(sine, cosine);
        let zone = &self.equilibria.zone;
        let half = 2.0 * sin(0.5 * angle).powi(2);
        let opening =
            zone.panels.values(zone.panels.place(s)).slope + 2.0 * zone.cohesion.strength * cosine / sine;
        let turning = angle * c * sine * opening / FRAC_PI_2;
        let of = |strength: f64, range: f64| {
            let approach = -(FRAC_PI_2 * range + 2.0 * c * half * strength) / angle;
            let force = 2.0 * s * approach - 2.0 * c * c * (angle - sine * cosine) * strength;
            let turned = (range - 2.0 * c / FRAC_PI_2 * (angle * sine - half) * strength) / turning;
            [if s > 0.0 { -c * sine * turned } else { 0.0 }, approach, force]
        };
        [of(1.0, 0.0), of(0.0, 1.0)]
    }

    /// The error of the state at a place if it is not one disc in one zone; `None` if it is.
    ///
    /// # Errors
    /// [`PathError`] where that cannot be known.
    pub fn fault(&self, place: Place, progress: &dyn Progress) -> Result<Option<PathError>, PathError> {
        let found = fault(&self.equilibria, &*self.solution, place, Ends::Both, progress)?;
        Ok(found.map(|found| beyond(&*self.solution, place, Some(found))))
    }

    /// The places from the start inward, as dense as they are drawn, up to the first that is not one disc in one zone;
    /// and the error of that one.
    ///
    /// # Errors
    /// [`PathError`] of the start where the start is not, and where that cannot be known.
    pub fn drawn(&self, progress: &dyn Progress) -> Result<(Vec<Place>, Option<PathError>), PathError> {
        let start = self.solution.radius(self.start);
        let mut found = Vec::new();
        for place in places(&*self.solution, start, SMALLEST * start, Detail::Drawn) {
            match self.fault(place, progress)? {
                None => found.push(place),
                Some(fault) if found.is_empty() => return Err(fault),
                fault => return Ok((found, fault)),
            }
        }
        Ok((found, None))
    }

    /// ds/dc at a place: the edge of the disc follows that of its zone so that ω stays zero there.
    pub fn contact_slope(&self, place: Place) -> f64 {
        let ZoneAt { edge, contact_radius, .. } = zone_at(&*self.solution, place);
        let zone = &self.equilibria.zone;
        let pull = 2.0 * zone.cohesion.strength / ((edge - contact_radius) * (edge + contact_radius)).sqrt();
        let slope = self.solution.at(place).stability().approach;
        let rise = zone.panels.values(zone.panels.place(contact_radius)).slope;
        (slope + pull * edge) / (rise + pull * contact_radius)
    }
}

/// The state at a place.
pub(super) fn zone_at(solution: &dyn Solution, place: Place) -> ZoneAt {
    let (state, edges) = (solution.at(place), solution.edges(place));
    ZoneAt {
        edge: edges.zone.unwrap_or(edges.contact_radius),
        contact_radius: edges.contact_radius,
        approach: state.approach,
    }
}

/// What a state has besides one disc in one zone, if anything.
pub(super) fn fault(
    Equilibria { zone, ground, .. }: &Equilibria,
    solution: &dyn Solution,
    place: Place,
    ends: Ends,
    progress: &dyn Progress,
) -> Result<Option<ZoneFault>, PathError> {
    progress.go_on()?;
    let at = zone_at(solution, place);
    let radius = zone.sees(ground, at);
    if radius >= ground.reach() && ground.reach() < ground.table.end() * (1.0 - 1e-9) {
        return Err(PathError::Unseen { radius: FURTHER * radius });
    }
    Ok(zone.fault(ground, at, ends))
}

/// The error of a state that is not one disc in one zone.
pub(super) fn beyond(solution: &dyn Solution, place: Place, fault: Option<ZoneFault>) -> PathError {
    let at = solution.at(place);
    let radius = fault.map_or(at.contact_radius, |fault| fault.radius);
    let kind = fault.map(|fault| fault.kind);
    PathError::BeyondZone { kind, radius, approach: at.approach, force: at.force }
}

/// The place of the outermost zone with contact of the radius `s`.
pub(in crate::quasistatic) fn place_of(solution: &dyn Solution, s: f64) -> Option<Place> {
    let contact = |c: f64| solution.place(c).map(|place| solution.edges(place).contact_radius);
    if contact(solution.reach())? < s {
        return None;
    }
    let [_, c] = root::halved(s, solution.reach(), |c| contact(c).is_none_or(|found| found < s));
    solution.place(c)
}

impl FaultKind {
    /// What is wrong, with the radius as it is shown.
    pub(crate) fn words(self, radius: &str) -> String {
        match self {
            Self::SecondZone => format!("a second zone forms at r = {radius}"),
            Self::Touches => format!("the bodies touch in the zone at r = {radius}"),
            Self::Opens => format!("the zone opens inside at r = {radius}"),
            Self::Torn => format!("the contact is torn inside at r = {radius}"),
        }
    }
}
