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
//! The unknown is z = sin²ψ = 1 − (s/c)² where the zone is thin, and 1 − z where little of it is in contact, so that
//! both keep their digits; D is almost linear in either. D grows with z as long as the gap opens just outside s,
//!
//! ```text
//! ω'(s) = g'(s) + 2σ₀s/√(c² − s²) > 0
//! ```
//!
//! and turns where the gap does not, which requires a falling g. Then one zone may have several s. **Only the s with
//! the largest δ can be a state**: the displacement of each is a subsolution of the contact problem of its zone,
//! because nothing presses where the bodies are apart, and where they touch the tension may exceed σ₀. So at that δ the
//! gap of the true contact, a disc or not, is nowhere smaller, and the zone is in equilibrium at no smaller δ and P
//! than any of them.
//!
//! D. Maugis, J. Colloid Interface Sci. 150, 243 (1992), doi:10.1016/0021-9797(92)90285-T, for a sphere.

use crate::disc::{Panels, Place, outside};
use crate::elementary::asin;
use crate::gap::Gap;
use crate::gap::panels::Variable;
use crate::problem::Cohesion;
use crate::root::RootBracket;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;
use wide::f64x4;

/// Most steps of Newton's method, each kept in its bracket.
const STEPS: usize = 80;

/// The share solved for, z or 1 − z, is the one that is at most this.
const HALF: f64 = 0.5;

/// The fraction of a share at which to go on where Newton's method would go below zero.
const TOWARDS_NOTHING: f64 = 0.1;

/// Below this angle ψ − sin ψ cos ψ is computed by a series.
const SMALL_ANGLE: f64 = 0.2;

/// Places on a panel of the table at which g is checked for falling.
const ON_PANEL: u32 = 16;

/// This share of a panel, or of a stretch, from its end is still beside the end.
const BESIDE: f64 = 1e-6;

/// Places on a falling stretch of g at which the gap may close outside s.
const ON_FALL: u32 = 8;

/// If the least opening is below this share of the slope of g, the gap may close nearby; the shortest step of the
/// search for that, as a share of the step between places.
const NEARLY: f64 = 0.3;
const SHORTEST: f64 = 1e-4;

/// A turn of D is located to this share of c.
const TURN: f64 = 1e-14;

/// Further in than an s whose gap at c is this many ranges there is no other s.
const FAR: f64 = 2.0;

/// Radii between which g falls, and its least slope there.
#[derive(Debug, Clone, Copy)]
struct Fall {
    lo: f64,
    hi: f64,
    slope: f64,
}

/// A gap in whose zone a tension acts.
#[derive(Debug, Clone)]
pub struct Zone {
    /// The gap.
    pub gap: Arc<dyn Gap>,
    /// Its table, at least as far out as zones are asked for.
    pub panels: Arc<Panels>,
    /// σ₀ and `h_c`.
    pub cohesion: Cohesion,
    falls: Arc<[Fall]>,
}

/// The equilibrium of one disc in one zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZoneState {
    /// c.
    pub edge: f64,
    /// s; 0 where there is no contact.
    pub contact_radius: f64,
    /// (s/c)².
    pub share: f64,
    /// δ.
    pub approach: f64,
    /// P.
    pub force: f64,
    /// U.
    pub energy: f64,
    /// dδ/dc and dP/dc.
    pub slopes: [f64; 2],
}

/// The share of a zone that is free, z, and the share in contact, 1 − z. The smaller of the two is known to all its
/// digits.
#[derive(Debug, Clone, Copy)]
struct Shares {
    free: f64,
    contact: f64,
}

impl Shares {
    fn of_free(free: f64) -> Self {
        Self { free, contact: 1.0 - free }
    }

    fn of_contact(contact: f64) -> Self {
        Self { free: 1.0 - contact, contact }
    }

    /// ψ, sin ψ and cos ψ.
    fn angle(self) -> [f64; 3] {
        let (sine, cosine) = (self.free.sqrt(), self.contact.sqrt());
        [if sine < cosine { asin(sine) } else { FRAC_PI_2 - asin(cosine) }, sine, cosine]
    }
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

/// Where g falls, ascending.
fn falls(panels: &Panels) -> Vec<Fall> {
    let mut found: Vec<Fall> = Vec::new();
    let mut before = 0.0;
    let mut falling = false;
    for (panel, of) in panels.list().iter().enumerate() {
        // Just outside a corner at which h' falls, g falls like a square root.
        let corner = matches!(of.span.variable, Variable::Root { base } if base > 0.0 && base >= of.span.lo);
        if corner && panels.values(Place { panel, x: BESIDE - 1.0 }).slope < 0.0 {
            found.push(Fall { lo: of.span.lo, hi: of.span.lo, slope: f64::NEG_INFINITY });
            falling = true;
        }
        for k in 0..ON_PANEL {
            let x = 2.0 * (f64::from(k) + 0.5) / f64::from(ON_PANEL) - 1.0;
            let (radius, slope) = (of.span.radius(x), panels.values(Place { panel, x }).slope);
            match found.last_mut().filter(|_| falling) {
                Some(fall) => (fall.hi, fall.slope) = (radius, fall.slope.min(slope)),
                None if slope < 0.0 => found.push(Fall { lo: before, hi: radius, slope }),
                None => {}
            }
            falling = slope < 0.0;
            before = radius;
        }
    }
    found
}

impl Zone {
    /// The zone of a gap with its table.
    #[must_use]
    pub fn new(gap: Arc<dyn Gap>, panels: Arc<Panels>, cohesion: Cohesion) -> Self {
        let falls = falls(&panels).into();
        Self { gap, panels, cohesion, falls }
    }

    /// The radii, ascending, at which h' falls at a corner, the axis among them.
    pub fn corners(&self) -> impl Iterator<Item = f64> {
        let axis = (self.falls.first().is_some_and(|fall| fall.lo <= 0.0)).then_some(0.0);
        axis.into_iter()
            .chain(self.falls.iter().filter(|fall| fall.slope == f64::NEG_INFINITY).map(|fall| fall.lo))
    }

    /// How much wider than `h_c` the gap is at the edge c of a zone that only just touches: where this is positive
    /// there is contact.
    pub fn excess(&self, c: f64) -> f64 {
        let Cohesion { strength, range } = self.cohesion;
        self.gap.jet(c).value + 2.0 * strength * c * (1.0 - 2.0 / PI) - range
    }

    /// The equilibrium of the zone with the outer edge `c`, a positive length; the search for (s/c)² begins at `near`.
    /// `None` if there is no equilibrium of one disc.
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
            share: 0.0,
            approach,
            force: -PI * strength * c * c,
            energy: self.energy(c, 0.0, approach),
            slopes: [slope, -2.0 * PI * strength * c],
        })
    }

    /// U; for s > 0 with the energy stored in the disc.
    fn energy(&self, c: f64, s: f64, approach: f64) -> f64 {
        let Cohesion { strength, .. } = self.cohesion;
        let panels = &*self.panels;
        let pulled = outside::sum_from(panels, s, c, &|a, g| {
            (f64x4::splat(c) - a) * (a + c) * (f64x4::splat(approach) - g)
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

    /// ω'(s): how fast the gap opens just outside a contact.
    fn opening(&self, c: f64, s: f64) -> f64 {
        let pull = 2.0 * self.cohesion.strength * s / ((c - s) * (c + s)).sqrt();
        self.panels.values(self.panels.place(s)).slope + pull
    }

    /// The radius between two at which the gap closes fastest outside a contact, to some digits; `unit` is the size of
    /// g'.
    fn closing(&self, c: f64, [lo, hi]: [f64; 2], unit: f64) -> Option<f64> {
        let step = (hi - lo) / f64::from(ON_FALL);
        let even = (0..ON_FALL).map(|k| lo + step * (f64::from(k) + 0.5));
        let openings = even.chain([lo + BESIDE * step]).map(|s| (s, self.opening(c, s)));
        let (mut at, mut least) = openings.min_by(|a, b| a.1.total_cmp(&b.1))?;
        // Where D has only just begun to turn, it does so over a short distance, beside the least of these.
        let mut by = 0.5 * step;
        while least >= 0.0 && least < NEARLY * unit && by > SHORTEST * step {
            let around = [at - by, at + by].map(|s| (s, self.opening(c, s.clamp(lo, hi))));
            for (s, opening) in around {
                if opening < least {
                    (at, least) = (s.clamp(lo, hi), opening);
                }
            }
            by *= 0.5;
        }
        (least < 0.0).then_some(at)
    }

    /// z at the largest D and at the smallest D further in, for each stretch on which D falls with z. The stretches
    /// come from the edge inward, as far in as there may be a state.
    fn turns(&self, c: f64) -> Vec<[f64; 2]> {
        let mut turns = Vec::new();
        let inner = self.falls.partition_point(|fall| fall.lo < c);
        for fall in self.falls[..inner].iter().rev() {
            let least = 2.0 * self.cohesion.strength * fall.lo / ((c - fall.lo) * (c + fall.lo)).sqrt();
            if least + fall.slope >= 0.0 {
                continue;
            }
            let hi = fall.hi.min(c);
            let free = (c - hi) * (c + hi) / (c * c);
            // D falls by no more than this on the way in.
            let drop = -fall.slope * (hi - fall.lo);
            if free > 0.0 && drop.is_finite() && self.is_far(c, free, drop) {
                break;
            }
            let Some(closing) = self.closing(c, [fall.lo, hi], -fall.slope) else { continue };
            let ends = [hi, fall.lo].map(|opens| {
                let at = |s: f64| [s, self.opening(c, s)];
                let closes = RootBracket::new(at(closing), at(opens)).map_or(opens, |mut turn| {
                    turn.close(TURN * c, |s| Some(self.opening(c, s)));
                    turn.end(false)
                });
                (c - closes) * (c + closes) / (c * c)
            });
            turns.push(ends);
            if self.is_far(c, ends[1], 0.0) {
                break;
            }
        }
        turns
    }

    /// Whether there is no state with a larger free share than this, if D falls by no more than `drop` on the way in.
    fn is_far(&self, c: f64, free: f64, drop: f64) -> bool {
        self.miss(c, Shares::of_free(free)).0 - drop > (FAR - 1.0) * self.cohesion.range
    }

    /// D − `h_c` and, where z is not 0, its slope by z.
    fn miss(&self, c: f64, at: Shares) -> (f64, f64) {
        let Cohesion { strength, range } = self.cohesion;
        let panels = &*self.panels;
        let [angle, sine, cosine] = at.angle();
        let s = c * cosine;
        let values = panels.values(panels.place(s));
        let ring = outside::sum_from(panels, s, c, &|_, g| g - values.value);
        let pull = 4.0 * strength * c / PI * (angle * sine - at.free / (1.0 + cosine));
        let slope = angle * c / PI * (values.slope / cosine + 2.0 * strength / sine);
        (2.0 / PI * ring + pull - range, slope)
    }

    fn in_contact(&self, c: f64, near: Option<f64>) -> Option<ZoneState> {
        let turns = self.turns(c);
        if turns.is_empty() {
            return self.root(c, [0.0, 1.0], near);
        }
        let borders: Vec<f64> = std::iter::once(0.0).chain(turns.concat()).chain([1.0]).collect();
        let opens = borders.chunks_exact(2).filter(|ends| {
            let above = |z: f64| z > 0.0 && (z >= 1.0 || self.miss(c, Shares::of_free(z)).0 > 0.0);
            ends[0] < ends[1] && !above(ends[0]) && above(ends[1])
        });
        opens
            .filter_map(|ends| self.root(c, [ends[0], ends[1]], near))
            .max_by(|a, b| a.approach.total_cmp(&b.approach))
    }

    /// The state between two values of z between which D grows from below `h_c` to above it.
    fn root(&self, c: f64, [lo, hi]: [f64; 2], near: Option<f64>) -> Option<ZoneState> {
        let Cohesion { strength, range } = self.cohesion;
        let half = Shares::of_free(HALF);
        let is_thin = hi <= HALF || lo < HALF && self.miss(c, half).0 > 0.0;
        let (shares, sense): (fn(f64) -> Shares, f64) =
            if is_thin { (Shares::of_free, 1.0) } else { (Shares::of_contact, -1.0) };
        let [mut lo, mut hi] = if is_thin { [lo, hi.min(HALF)] } else { [1.0 - hi, (1.0 - lo).min(HALF)] };
        let begin = match near {
            Some(share) if is_thin => 1.0 - share,
            Some(share) => share,
            // For a thin zone the second term of D is σ₀c z 2/π.
            None if is_thin => (0.5 * PI * range / (strength * c)).max(1e-12),
            None => hi,
        };
        let mut x = if begin > lo && begin < hi { begin } else { 0.5 * (lo + hi) };
        let mut opens = false;
        for _ in 0..STEPS {
            let (miss, slope) = self.miss(c, shares(x));
            opens = slope > 0.0;
            if miss * sense > 0.0 {
                hi = x;
            } else {
                lo = x;
            }
            let step = miss * sense / slope;
            if miss.abs() <= 2.0 * f64::EPSILON * range || step.abs() <= 2.0 * f64::EPSILON * x {
                break;
            }
            let next = x - step;
            x = if next > lo && next < hi {
                next
            } else if lo > 0.0 {
                0.5 * (lo + hi)
            } else {
                // Beside a cone D varies as the root of the share in contact: Newton's method comes up from below.
                TOWARDS_NOTHING * hi
            };
        }
        opens.then(|| self.at(c, shares(x))).flatten()
    }

    /// The state with these shares, which is in equilibrium.
    fn at(&self, c: f64, shares: Shares) -> Option<ZoneState> {
        let Cohesion { strength, .. } = self.cohesion;
        let panels = &*self.panels;
        let [angle, sine, cosine] = shares.angle();
        let s = c * cosine;
        let [value, area] = panels.value_and_area(panels.place(s));
        let approach = value - 2.0 * strength * c * sine;
        let rise = outside::rise_from(panels, s, c, angle);
        let slope = (rise - 2.0 * strength * shares.free / (1.0 + cosine)) / angle;
        let ring = 2.0 * strength * c * c * sliver(angle, [sine, cosine]);
        approach.is_finite().then(|| ZoneState {
            edge: c,
            contact_radius: s,
            share: shares.contact,
            approach,
            force: 2.0 * (approach * s - area) - ring,
            energy: self.energy(c, s, approach),
            slopes: [slope, 2.0 * s * slope - 4.0 * strength * c * angle],
        })
    }
}
