//! The equilibrium of a zone with a given outer edge.
//!
//! With s = c cos ψ and g the transform of the gap (E* = 1):
//!
//! ```text
//! D(c, ψ) = (2/π)∫₀^ψ [g(c cos t) − g(s)] dt + (4σ₀c/π)[ψ sin ψ − (1 − cos ψ)] = h_c         the gap at c
//! δ = g(s) − 2σ₀c sin ψ,      P = 2(δs − ∫₀ˢ g) − 2σ₀c²(ψ − sin ψ cos ψ)
//! U = ∫₀ˢ (δ − g)² da + ∫_s^c [2θ(δ − g) − θ²] da − πγc²,      θ = −2σ₀√(c² − a²)
//! dδ/dc = [∫₀^ψ g'(c cos t) cos t dt − 2σ₀(1 − cos ψ)]/ψ,      dP/dc = 2s dδ/dc − 4σ₀cψ
//! no contact (ψ = π/2), where h(c) + 2σ₀c(1 − 2/π) ≤ h_c:      δ = h(c) − 4σ₀c/π − h_c,      P = −πσ₀c²
//! ```
//!
//! The unknown is z = sin²ψ = 1 − (s/c)², in which D is nearly a line both where the zone is thin and where contact begins. D grows
//! with z while the gap opens just outside s, so that a zone has one state at most; one at which it does not open is none.
//!
//! D. Maugis, J. Colloid Interface Sci. 150, 243 (1992), doi:10.1016/0021-9797(92)90285-T, for a sphere.

use crate::disc::{Panels, outside};
use crate::elementary::asin;
use crate::gap::Gap;
use crate::problem::Cohesion;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// Newton's steps, each kept in its bracket.
const STEPS: usize = 80;

/// Below this angle ψ − sin ψ cos ψ is a series.
const SMALL_ANGLE: f64 = 0.2;

/// A gap in whose zone a tension acts.
#[derive(Debug, Clone)]
pub struct Zone {
    /// The gap.
    pub gap: Arc<dyn Gap>,
    /// Its table, at least as far out as zones are asked for.
    pub panels: Arc<Panels>,
    /// σ₀ and `h_c`.
    pub cohesion: Cohesion,
}

/// The equilibrium of one disc in one zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZoneState {
    /// c.
    pub edge: f64,
    /// s; 0 where there is no contact.
    pub contact_radius: f64,
    /// 1 − (s/c)².
    pub free: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// U.
    pub energy: f64,
    /// dδ/dc and dP/dc.
    pub slopes: [f64; 2],
}

/// ψ − sin ψ cos ψ.
fn sliver(angle: f64, [sine, cosine]: [f64; 2]) -> f64 {
    if angle > SMALL_ANGLE {
        return angle - sine * cosine;
    }
    // (2ψ − sin 2ψ)/2.
    let square = 4.0 * angle * angle;
    let mut term = 4.0 / 3.0 * angle * angle.powi(2) * 0.5;
    let mut sum = term;
    for k in 2..8 {
        let k = f64::from(k);
        term *= -square / (2.0 * k * (2.0 * k + 1.0));
        sum += term;
    }
    sum
}

impl Zone {
    /// How much the gap at the edge c of a zone that only just touches is wider than `h_c`: there is contact where it is positive.
    pub fn excess(&self, c: f64) -> f64 {
        let Cohesion { strength, range } = self.cohesion;
        self.gap.jet(c).value + 2.0 * strength * c * (1.0 - 2.0 / PI) - range
    }

    /// The equilibrium of the zone with the outer edge `c`, a positive length; z is looked for from `near` on. `None` where there is
    /// none of one disc.
    pub fn state(&self, c: f64, near: Option<f64>) -> Option<ZoneState> {
        if self.excess(c) <= 0.0 { self.without_contact(c) } else { self.in_contact(c, near) }
    }

    fn without_contact(&self, c: f64) -> Option<ZoneState> {
        let Cohesion { strength, range } = self.cohesion;
        let jet = self.gap.jet(c);
        let approach = jet.value - 4.0 * strength * c / PI - range;
        let slope = jet.first - 4.0 * strength / PI;
        approach.is_finite().then(|| ZoneState {
            edge: c,
            contact_radius: 0.0,
            free: 1.0,
            approach,
            force: -PI * strength * c * c,
            energy: self.energy(c, 0.0, approach),
            slopes: [slope, -2.0 * PI * strength * c],
        })
    }

    /// U, where s > 0 with what is stored in the disc.
    fn energy(&self, c: f64, s: f64, approach: f64) -> f64 {
        let Cohesion { strength, .. } = self.cohesion;
        let panels = &*self.panels;
        let pulled = outside::sum_from(panels, s, c, &|place| {
            let a = panels.radius(place);
            (c - a) * (c + a) * (approach - panels.value(place))
        });
        let width = c - s;
        // ∫_s^c (c² − a²) da.
        let square = width * width * (2.0 * c + s) / 3.0;
        let disc = if s > 0.0 {
            let at = panels.place(s);
            let [_, area] = panels.value_and_area(at);
            approach * approach * s - 2.0 * approach * area + panels.square(at)
        } else {
            0.0
        };
        disc - 4.0 * strength * (pulled + strength * square) - PI * self.cohesion.work() * c * c
    }

    fn in_contact(&self, c: f64, near: Option<f64>) -> Option<ZoneState> {
        let Cohesion { strength, range } = self.cohesion;
        let panels = &*self.panels;
        let (mut lo, mut hi) = (0.0, 1.0);
        // Of a thin zone the second term of D is σ₀c z 2/π.
        let mut z = near.unwrap_or(0.5 * PI * range / (strength * c)).clamp(1e-12, 1.0 - 1e-12);
        let mut opens = false;
        for _ in 0..STEPS {
            let s = c * (1.0 - z).sqrt();
            let values = panels.values(panels.place(s));
            let (sine, cosine) = (z.sqrt(), (1.0 - z).sqrt());
            let angle = asin(sine);
            let ring = outside::sum_from(panels, s, c, &|place| panels.value(place) - values.value);
            let miss =
                2.0 / PI * ring + 4.0 * strength * c / PI * (angle * sine - z / (1.0 + cosine)) - range;
            let slope = values.slope / cosine + 2.0 * strength / sine;
            opens = slope > 0.0;
            if miss > 0.0 {
                hi = z;
            } else {
                lo = z;
            }
            let step = miss / (angle * c / PI * slope);
            if miss.abs() <= 2.0 * f64::EPSILON * range || step.abs() <= 2.0 * f64::EPSILON * z {
                break;
            }
            let next = z - step;
            z = if next > lo && next < hi { next } else { 0.5 * (lo + hi) };
        }
        opens.then(|| self.at(c, z)).flatten()
    }

    /// The state with the free share z, which is in equilibrium.
    fn at(&self, c: f64, z: f64) -> Option<ZoneState> {
        let Cohesion { strength, .. } = self.cohesion;
        let panels = &*self.panels;
        let (sine, cosine) = (z.sqrt(), (1.0 - z).sqrt());
        let angle = asin(sine).min(FRAC_PI_2);
        let s = c * cosine;
        let [value, area] = panels.value_and_area(panels.place(s));
        let approach = value - 2.0 * strength * c * sine;
        let rise = outside::rise_from(panels, s, c);
        let slope = (rise - 2.0 * strength * z / (1.0 + cosine)) / angle;
        let ring = 2.0 * strength * c * c * sliver(angle, [sine, cosine]);
        approach.is_finite().then(|| ZoneState {
            edge: c,
            contact_radius: s,
            free: z,
            approach,
            force: 2.0 * (approach * s - area) - ring,
            energy: self.energy(c, s, approach),
            slopes: [slope, 2.0 * s * slope - 4.0 * strength * c * angle],
        })
    }
}
