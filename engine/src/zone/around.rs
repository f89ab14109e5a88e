//! The bodies around a zone, and whether one disc in one zone is all of the state.
//!
//! ```text
//! r > s   gap(r) = (2/π)∫_s^r (g(a) − δ)/√(r² − a²) da − (4σ₀/π) Q(r),     Q(r) = ∫_s^{min(r, c)} √((c² − a²)/(r² − a²)) da
//! r < s   p(r)   = (1/π)∫_r^s g'/√(a² − r²) da − 2σ₀(½ − arcsin √((s² − r²)/(c² − r²))/π)
//! ```
//!
//! A state is whole if in the zone the gap is positive and below `h_c`, beyond the zone it is not below `h_c`, and in
//! the contact p ≥ −σ₀. Along a stable stretch δ and c grow together. With them the gap falls everywhere outside the
//! contact and the pressure grows everywhere inside, because the increment due to a tension that pulls at the edge, and
//! to an approach, is a pressure. What the edge s reaches is already closed, except at a corner at which h' falls, and
//! what c reaches has the gap `h_c`. So the stretch is whole if at its outer end nothing touches in the zone or comes
//! within range beyond it, and at its inner end nothing opens in the zone or under the contact.

use super::state::Zone;
use crate::annuli::Ground;
use crate::annuli::ground::gauss;
use crate::disc::outside;
use crate::elementary::{acos, asin, sin};
use crate::problem::Cohesion;
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, PI};

/// The tolerance of a gap, as a share of `h_c`, and of a pressure, as a share of σ₀.
const ROUNDING: f64 = 1e-9;

/// Radii in a zone, and per wave in it, at which the gap is checked, and the most of them.
const IN_ZONE: f64 = 24.0;
const PER_WAVE: f64 = 16.0;
const MOST: f64 = 4000.0;

/// At a corner of the gap at which h' falls, a disc pulls without bound and a hole opens. A hole narrower than this
/// share of the contact radius does not count.
const HOLE: f64 = 1e-6;

/// How many times that at its edge a displacement beyond the zone may be.
const FARTHER: f64 = 1.2;

/// Why a state is not one disc in one zone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultKind {
    /// Beyond the zone the bodies are within range.
    SecondZone,
    /// In the zone they touch.
    Touches,
    /// In the zone they are out of range.
    Opens,
    /// Under the contact the tension is larger than possible.
    Torn,
}

/// The numbers ½, 1½, … up to the count of places checked between two radii, each with that count.
fn places(ground: &Ground, ends: [f64; 2]) -> impl Iterator<Item = [f64; 2]> + use<> {
    let count = (IN_ZONE + PER_WAVE * ground.lengths_between(ends)).min(MOST).ceil();
    std::iter::successors(Some(0.5), |k| Some(k + 1.0))
        .take_while(move |k| *k < count)
        .map(move |k| [k, count])
}

/// Where a state is not one disc in one zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZoneFault {
    /// What is wrong there.
    pub kind: FaultKind,
    /// Where, a length.
    pub radius: f64,
}

/// Which faults are looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// Those that appear first at the outer end of a stable stretch.
    Outer,
    /// Those at its inner end.
    Inner,
    /// All.
    Both,
}

/// A state, given by its numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZoneAt {
    /// c.
    pub edge: f64,
    /// s.
    pub contact_radius: f64,
    /// δ.
    pub approach: f64,
}

impl Zone {
    /// ∫_s^{min(r, c)} √((c² − a²)/(r² − a²)) da.
    fn pull(at: ZoneAt, r: f64) -> f64 {
        let (c, s) = (at.edge, at.contact_radius);
        if r <= s || c <= 0.0 {
            return 0.0;
        }
        let inner = r.min(c);
        // a = inner sin(π/2 − χ): next to the edge the integrand changes within χ = d/c.
        let square = (c - r) * (c + r);
        let end = acos((s / inner).min(1.0));
        let of = |chi: f64| {
            let sine = inner * sin(chi);
            if r < c { (square + sine * sine).sqrt() } else { sine * sine / (sine * sine - square).sqrt() }
        };
        let mut near = (square.abs().sqrt() / c).max(1e-12 * end);
        let (mut from, mut sum) = (0.0, 0.0);
        while from < end {
            let to = if near >= 0.7 * end { end } else { near };
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
            sum += half * gauss(16).iter().map(|[x, weight]| weight * of(middle + half * x)).sum::<f64>();
            (from, near) = (to, 3.0 * to);
        }
        sum
    }

    /// The gap at `r ≥ s`; the table must reach there.
    pub fn gap_at(&self, at: ZoneAt, r: f64) -> f64 {
        let ring = 4.0 * FRAC_1_PI * self.cohesion.strength * Self::pull(at, r);
        outside::gap_from(&self.panels, at.contact_radius, at.approach, r) - ring
    }

    /// The pressure at a radius, compression positive: −σ₀ in the free part of the zone, zero beyond it.
    pub fn pressure_at(&self, at: ZoneAt, r: f64) -> f64 {
        let Cohesion { strength, .. } = self.cohesion;
        let (c, s) = (at.edge, at.contact_radius);
        if r >= c {
            return 0.0;
        }
        if r >= s {
            return -strength;
        }
        let panels = &*self.panels;
        let value = panels.value(panels.place(s));
        let share = (((s - r) * (s + r)) / ((c - r) * (c + r))).sqrt();
        outside::pressure(panels, s, value, r) - 2.0 * strength * (0.5 - asin(share.min(1.0)) / PI)
    }

    /// Radii in the zone, denser towards both edges, and the corners in it, each with the gap there; without contact
    /// the axis is one of them.
    fn gaps<'a>(&'a self, ground: &Ground, at: ZoneAt) -> impl Iterator<Item = (f64, f64)> + 'a {
        let (c, s) = (at.edge, at.contact_radius);
        let from = 0.5 * f64::from(u8::from(s <= 0.0));
        let even = places(ground, [s, c]).map(move |[k, count]| {
            let sine = sin(FRAC_PI_2 * (k - from) / count);
            s + (c - s) * sine * sine
        });
        let corners: Vec<f64> = ground.breaks.iter().copied().filter(|r| s < *r && *r < c).collect();
        even.chain(corners).map(move |radius| (radius, self.gap_at(at, radius)))
    }

    /// Radii just beside the corners in the contact at which h' falls, each with the pressure there.
    fn at_corners(&self, at: ZoneAt) -> impl Iterator<Item = (f64, f64)> + '_ {
        let s = at.contact_radius;
        let beside = self.corners().flat_map(move |r| [r - HOLE * s, r + HOLE * s]);
        beside.filter(move |r| 0.0 < *r && *r < s).map(move |radius| (radius, self.pressure_at(at, radius)))
    }

    /// Radii in the contact, each with the pressure there.
    fn pressures<'a>(&'a self, ground: &Ground, at: ZoneAt) -> impl Iterator<Item = (f64, f64)> + 'a {
        let s = at.contact_radius;
        let even = places(ground, [0.0, s]).map(move |[k, count]| s * k / count);
        even.take_while(move |_| s > 0.0).map(move |radius| (radius, self.pressure_at(at, radius)))
    }

    /// The first fault of a state on the gap of `ground`, among those asked for.
    pub fn fault(&self, ground: &Ground, at: ZoneAt, ends: Ends) -> Option<ZoneFault> {
        let Cohesion { strength, range } = self.cohesion;
        let (outer, inner) = (ends != Ends::Inner, ends != Ends::Outer);
        for (radius, gap) in self.gaps(ground, at).take_while(|_| at.edge > 0.0) {
            if outer && gap < -ROUNDING * range {
                return Some(ZoneFault { kind: FaultKind::Touches, radius });
            }
            if inner && gap > range * (1.0 + ROUNDING) {
                return Some(ZoneFault { kind: FaultKind::Opens, radius });
            }
        }
        if outer && let Some(radius) = self.second_zone(ground, at) {
            return Some(ZoneFault { kind: FaultKind::SecondZone, radius });
        }
        self.at_corners(at)
            .chain(self.pressures(ground, at).take_while(|_| inner))
            .find(|(_, pressure)| *pressure < -strength * (1.0 + ROUNDING))
            .map(|(radius, _)| ZoneFault { kind: FaultKind::Torn, radius })
    }

    /// By how much δ and P of the zone with the same edge may exceed those of this state if its contact is not a disc;
    /// zero if it is a disc.
    ///
    /// If the gap is raised by as much as it is below zero, and a pressure is added where the tension exceeds σ₀, the
    /// displacement is a supersolution of the contact problem. The pressure, nowhere larger than p on the disc, raises
    /// the gap at c by at most (4/π)ps; an approach lowers it by the share (2/π)ψ, to first order in the edges of
    /// contact.
    pub fn slack(&self, ground: &Ground, at: ZoneAt) -> [f64; 2] {
        let (c, s) = (at.edge, at.contact_radius);
        let lowest = self.gaps(ground, at).fold(0.0_f64, |least, (_, gap)| least.min(gap));
        let excess = |(_, pressure): (f64, f64)| -self.cohesion.strength - pressure;
        let torn = self.pressures(ground, at).map(excess).fold(0.0_f64, f64::max);
        let below = |most: f64, unit: f64| if most > ROUNDING * unit { most } else { 0.0 };
        let (lifted, torn) = (below(-lowest, self.cohesion.range), below(torn, self.cohesion.strength));
        let approach = (lifted + 4.0 * FRAC_1_PI * s * torn) / (2.0 * FRAC_1_PI * acos((s / c).min(1.0)));
        [approach, 2.0 * c * (approach + lifted) + PI * s * s * torn]
    }

    /// A radius beyond the zone at which the bodies are within range.
    ///
    /// The displacement θ has one sign at the rim and the other inside, so beyond the zone it is nowhere much lower
    /// than at the zone's edge. Only crests of the gap that are lower than the edge can therefore be within range.
    fn second_zone(&self, ground: &Ground, at: ZoneAt) -> Option<f64> {
        let Cohesion { range, .. } = self.cohesion;
        let c = at.edge;
        let height = |r: f64| self.gap.jet(r).value;
        let raised = (range + at.approach - height(c)).min(0.0);
        let low = at.approach + range - FARTHER * raised;
        let end = ground.reach();
        let mut candidates: Vec<f64> =
            ground.samples().into_iter().chain(ground.breaks.iter().copied()).collect();
        if c <= 0.0 {
            // For bodies apart, the lowest place comes within range.
            let lowest = candidates
                .into_iter()
                .filter(|r| *r < end)
                .min_by(|a, b| height(*a).total_cmp(&height(*b)))?;
            return (height(lowest) < low - ROUNDING * range).then_some(lowest);
        }
        candidates.retain(|r| *r > c * (1.0 + ROUNDING) && *r < end && height(*r) < low);
        candidates.into_iter().find(|r| self.gap_at(at, *r) < range * (1.0 - ROUNDING))
    }

    /// How far out the gap must be known for a state: nothing further out can come within range.
    pub fn sees(&self, ground: &Ground, at: ZoneAt) -> f64 {
        let low = at.approach
            + self.cohesion.range
            + FARTHER * (self.gap.jet(at.edge).value - at.approach - self.cohesion.range).max(0.0);
        ground.can_touch_up_to(low).max(at.edge)
    }
}
