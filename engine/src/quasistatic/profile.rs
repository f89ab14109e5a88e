//! One state across the radius: the pressure inside the contact, the deformed gap outside.
//!
//! ```text
//! r < s    p(r), compression positive; p → −√(γE*/(π(s − r))) towards an adhesive edge
//! r > s    h(r) + u(r) − δ, the gap between the deformed bodies; h(r) between the undeformed ones
//! ```
//!
//! The gap opens like √(r − s) at an adhesive edge and like (r − s)^{3/2} without adhesion, so its points follow
//! r = s√(1 + ζ²) with even steps in ζ near the edge and steps by the wave further out.

use super::admissible::{Crest, Judge};
use crate::annuli::around::BESIDE;
use crate::annuli::{Around, Contacts, Ground, Wanted};
use crate::disc::{Basis, Table};
use crate::elementary::sin;
use crate::gap::wave_index;
use crate::problem::{Cohesion, Reduced};
use crate::progress::Unwatched;
use crate::zone::{Zone, ZoneAt};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// Points of the gap per wave.
const POINTS_PER_WAVE: f64 = 20.0;
/// Points of the gap at least and at most.
const POINTS: [f64; 2] = [80.0, 1000.0];
/// The picture ends this many waves or this share of s outside the edge, whichever is more.
const WAVES_SHOWN: f64 = 3.0;
const RADII_SHOWN: f64 = 0.5;

/// The pressure at a radius inside the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inside {
    /// r < s.
    pub radius: f64,
    /// p, compression positive.
    pub pressure: f64,
}

/// The gap at a radius outside the contact, or at its edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outside {
    /// r ≥ s.
    pub radius: f64,
    /// h(r) + u(r) − δ: between the deformed bodies.
    pub gap: f64,
    /// h(r): between the undeformed bodies.
    pub undeformed: f64,
}

/// A state across the radius, in reduced units, from the axis outward.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// The outermost edge; s of one disc.
    pub contact_radius: f64,
    /// Where the bodies touch, as [inner, outer]; a disc is [0, s].
    pub contacts: Vec<[f64; 2]>,
    /// δ.
    pub approach: f64,
    /// The pressure, finite and dense towards the edge. The basis of rings gives values at mid-ring: its pressure is a
    /// step function.
    pub inside: Vec<Inside>,
    /// The gap outside the contacts, from the axis outward, as far as it is known: 0 at their edges.
    pub outside: Vec<Outside>,
    /// The outer edge of the zone in which adhesion with a range pulls; `None` where it has none.
    pub zone: Option<f64>,
    /// The crest outside at which the bodies come nearest; `None` where the gap only grows.
    pub nearest: Option<Crest>,
}

impl Profile {
    /// The profile of the bodies of `problem` at (s, δ), which need not be an equilibrium.
    pub fn of(problem: &Reduced, basis: &dyn Basis, judge: &Judge, s: f64, delta: f64) -> Self {
        let pressure = basis.pressure(problem, s, delta);
        let inside = pressure.into_iter().map(|(radius, pressure)| Inside { radius, pressure }).collect();
        let known = |r: f64| (r, problem.gap.jet(r).value);
        // A measured gap ends, and is not a number beyond its end.
        let (radii, gap): (Vec<f64>, Vec<f64>) = radii(s, problem.gap.feature_length())
            .into_iter()
            .map(known)
            .take_while(|(_, undeformed)| undeformed.is_finite())
            .unzip();
        let deformed = basis.gap_outside(problem, s, delta, &radii);
        let outside = radii.iter().zip(gap).zip(deformed).filter(|(_, gap)| gap.is_finite());
        let outside =
            outside.map(|((&radius, undeformed), gap)| Outside { radius, gap, undeformed }).collect();
        let nearest = judge.nearest_crest(s, delta, &Unwatched);
        Self {
            contact_radius: s,
            contacts: vec![[0.0, s]],
            approach: delta,
            inside,
            outside,
            zone: None,
            nearest,
        }
    }

    /// The profile of one disc in one zone, or of a zone without contact, with the pressure out to the edge of the
    /// zone. `None` where the gap is not known that far.
    pub fn of_zone(problem: &Reduced, table: &Arc<Table>, cohesion: Cohesion, at: ZoneAt) -> Option<Self> {
        let ZoneAt { edge, contact_radius: s, approach } = at;
        let outer = radii(edge, problem.gap.feature_length());
        let reach = outer.last().copied().unwrap_or(edge);
        let ground = Ground::new(Arc::clone(table), reach, &Unwatched).ok()?;
        let zone = Zone::new(Arc::clone(&ground.gap), Arc::clone(&ground.panels), cohesion);
        let [few, most] = POINTS;
        let count = |width: f64| (POINTS_PER_WAVE * width / ground.wave).clamp(few, most).ceil();
        // Dense towards both ends.
        let between = |lo: f64, hi: f64| {
            let count = count(hi - lo);
            std::iter::successors(Some(0.0), |j| Some(j + 1.0))
                .take_while(move |j| *j <= count)
                .map(move |j| lo + (hi - lo) * sin(FRAC_PI_2 * j / count).powi(2))
        };
        let pressed = |radius: f64| Inside { radius, pressure: zone.pressure_at(at, radius) };
        let disc = between(0.0, s).filter(|r| s > 0.0 && *r < s);
        let inside = disc.chain(between(s, edge).filter(|r| *r < edge)).map(pressed).collect();
        let opened = |radius: f64| Outside {
            radius,
            gap: zone.gap_at(at, radius),
            undeformed: problem.gap.jet(radius).value,
        };
        let outside = between(s, edge).chain(outer.into_iter().skip(1).filter(|r| *r <= ground.reach()));
        Some(Self {
            contact_radius: s,
            contacts: if s > 0.0 { vec![[0.0, s]] } else { Vec::new() },
            approach,
            inside,
            outside: outside.map(opened).filter(|at| at.gap.is_finite()).collect(),
            zone: Some(edge),
            nearest: None,
        })
    }

    /// The profile of a disc and rings, or of rings alone, at the approach `delta`; `None` where there is no such state.
    pub fn of_contacts(
        problem: &Reduced,
        table: &Arc<Table>,
        contacts: &Contacts,
        delta: f64,
    ) -> Option<Self> {
        let outermost = contacts.outermost();
        let outer = radii(outermost, problem.gap.feature_length());
        let reach = outer.last().copied().unwrap_or(outermost);
        let ground = Ground::new(Arc::clone(table), reach, &Unwatched).ok()?;
        let state = ground.state(contacts, Wanted::Values).ok()?;
        let around = Around::new(&ground, &state, delta);
        let count =
            |lo: f64, hi: f64| (POINTS_PER_WAVE * (hi - lo) / ground.wave).clamp(POINTS[0], POINTS[1]).ceil();
        // Shares of an interval, dense towards both ends, which are left out.
        let shares = |count: f64| {
            std::iter::successors(Some(0.5), |j| Some(j + 1.0))
                .take_while(move |j| *j < count)
                .map(move |j| sin(FRAC_PI_2 * j / count).powi(2))
        };
        let mut inside = Vec::new();
        for [lo, hi] in contacts.intervals() {
            inside.extend(shares(count(lo, hi)).map(|share| {
                let radius = lo + (hi - lo) * share;
                Inside { radius, pressure: around.pressure(radius) }
            }));
        }
        let at = |radius: f64, gap: f64| Outside { radius, gap, undeformed: problem.gap.jet(radius).value };
        let beside = BESIDE * ground.wave;
        let mut outside = Vec::new();
        for [lo, hi] in contacts.gaps() {
            outside.push(if lo > 0.0 { at(lo, 0.0) } else { at(0.0, around.gap(0.0)) });
            let inner = shares(count(lo, hi)).map(|share| lo + (hi - lo) * share);
            // Beside an edge the sums are poor: there the gap is drawn from the edge.
            let clear = inner.filter(|r| hi - r > beside && (lo == 0.0 || r - lo > beside));
            outside.extend(clear.map(|r| at(r, around.gap(r))));
            outside.push(at(hi, 0.0));
        }
        outside.push(at(outermost, 0.0));
        let known = outer.into_iter().filter(|r| *r > outermost + beside && *r <= ground.reach());
        outside.extend(known.map(|r| at(r, around.gap(r))));
        let wave = problem.gap.wavelength();
        let crests = around.crests(ground.can_touch_up_to(delta), &Unwatched).unwrap_or_default();
        let nearest = crests.into_iter().min_by(|a, b| a.gap.total_cmp(&b.gap)).map(|crest| Crest {
            radius: crest.radius,
            gap: crest.gap,
            wave: wave_index(crest.radius, wave),
        });
        Some(Self {
            contact_radius: outermost,
            contacts: contacts.intervals(),
            approach: delta,
            inside,
            outside,
            zone: None,
            nearest,
        })
    }
}

/// The radii of the picture of the gap, from `s` outward.
fn radii(s: f64, wave: Option<f64>) -> Vec<f64> {
    let shown = wave.map_or(0.0, |wave| WAVES_SHOWN * wave).max(RADII_SHOWN * s);
    let end = s + shown;
    let [least, most] = POINTS;
    let points = wave.map_or(0.0, |wave| POINTS_PER_WAVE * (end - s) / wave).clamp(least, most).ceil();
    // With r − s = (end − s)·x², even steps in x are even steps in ζ near the edge.
    std::iter::successors(Some(0.0), |j| Some(j + 1.0))
        .take_while(|j| *j <= points)
        .map(|j| s + (end - s) * (j / points).powi(2))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disc::{ExactBasis, Table};
    use crate::gap::Shape;
    use crate::problem::Problem;
    use crate::ritz::Rings;
    use std::f64::consts::PI;
    use std::sync::Arc;

    fn problem(amplitude: f64, gamma: f64) -> Reduced {
        let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude, wavelength: 0.05 };
        Problem { effective_modulus: 1.0, work_of_adhesion: gamma, shape }.reduced()
    }

    fn exact(problem: &Reduced) -> (ExactBasis, Judge) {
        let table = Arc::new(Table::new(Arc::clone(&problem.gap), 0.5, &Unwatched).unwrap());
        let judge = Judge::new(problem, &table);
        (ExactBasis::new(table, 0.5), judge)
    }

    #[test]
    fn of_a_smooth_sphere_it_is_hertz_and_jkr() {
        for gamma in [0.0, 0.004] {
            let (problem, s) = (problem(0.0, gamma), 0.2_f64);
            let (basis, judge) = exact(&problem);
            let at = basis.equilibrium(&problem, s).unwrap();
            let profile = Profile::of(&problem, &basis, &judge, s, at.approach);
            let tension = (2.0 * PI * gamma * s).sqrt();
            for at in &profile.inside {
                let t = (s * s - at.radius * at.radius).sqrt();
                let exact = (2.0 * t - tension / t) / PI;
                assert!((at.pressure - exact).abs() < 1e-12 * (s + tension / t), "{at:?} {exact}");
            }
            for at in &profile.outside {
                let r = at.radius;
                // u of Hertz, and of the flat punch that adhesion pulls back.
                let (angle, t) = ((s / r).min(1.0).asin(), (r * r - s * s).max(0.0).sqrt());
                let hertz = ((2.0 * s * s - r * r) * angle + s * t) / PI;
                let exact = r * r / 2.0 + hertz - 2.0 / PI * tension * angle - (s * s - tension);
                assert!((at.gap - exact).abs() < 1e-12, "{at:?} {exact}");
                assert!((at.undeformed - r * r / 2.0).abs() < 1e-15);
            }
            assert_eq!(profile.nearest, None);
            assert!(profile.outside[0].gap.abs() < 1e-14 && profile.outside.last().unwrap().gap > 0.0);
        }
    }

    #[test]
    fn of_rings_it_bears_their_force_and_touches_at_their_edges() {
        let problem = problem(0.0025, 1e-4);
        let table = Arc::new(Table::new(Arc::clone(&problem.gap), 0.5, &Unwatched).unwrap());
        let ground = Ground::new(Arc::clone(&table), 0.5, &Unwatched).unwrap();
        // A state of the loop with a disc and one ring.
        let contacts = Contacts { disc: 0.064, rings: vec![[0.0879, 0.1061]] };
        let delta = 0.0066;
        let state = ground.state(&contacts, Wanted::Values).unwrap();
        let profile = Profile::of_contacts(&problem, &table, &contacts, delta).unwrap();
        assert_eq!(profile.contacts, contacts.intervals());
        let force: f64 = profile
            .contacts
            .iter()
            .map(|[lo, hi]| {
                let of: Vec<&Inside> =
                    profile.inside.iter().filter(|at| at.radius > *lo && at.radius < *hi).collect();
                // The trapezoidal rule, as good as the singular ends allow.
                of.windows(2)
                    .map(|p| {
                        let [a, b] = [p[0], p[1]].map(|at| 2.0 * PI * at.radius * at.pressure);
                        0.5 * (a + b) * (p[1].radius - p[0].radius)
                    })
                    .sum::<f64>()
            })
            .sum();
        let expected = state.force_at(delta);
        assert!((force - expected).abs() < 0.05 * expected.abs(), "{force} {expected}");
        for at in &profile.outside {
            let on_edge = profile.contacts.iter().flatten().any(|edge| edge.to_bits() == at.radius.to_bits());
            assert!(at.gap.is_finite() && (!on_edge || at.gap == 0.0), "{at:?}");
        }
        assert!(profile.outside.windows(2).all(|pair| pair[0].radius <= pair[1].radius));
    }

    #[test]
    fn points_are_finite_in_order_and_dense_at_the_edge() {
        let (problem, s) = (problem(0.0025, 1e-4), 0.37);
        let (exact, judge) = exact(&problem);
        let rings = Rings::shared(50).unwrap();
        for basis in [&exact as &dyn Basis, rings.as_ref()] {
            let at = basis.equilibrium(&problem, s).unwrap();
            let profile = Profile::of(&problem, basis, &judge, s, at.approach);
            assert!(profile.inside.iter().all(|at| at.pressure.is_finite() && at.radius < s));
            assert!(profile.inside.windows(2).all(|pair| pair[0].radius < pair[1].radius));
            assert!(profile.outside.windows(2).all(|pair| pair[0].radius < pair[1].radius));
            assert!((80..=1001).contains(&profile.outside.len()));
            assert!(profile.outside.last().unwrap().radius > s + 0.14);
            // The nearest crest is the least of the picture's own minima, to the picture's resolution.
            let nearest = profile.nearest.unwrap();
            let drawn = profile.outside.windows(3).filter(|g| g[1].gap < g[0].gap && g[1].gap < g[2].gap);
            let least = drawn.map(|g| g[1].gap).fold(f64::INFINITY, f64::min);
            assert!((least - nearest.gap).abs() < 2e-4 && least >= nearest.gap - 1e-9, "{least} {nearest:?}");
        }
        let profile = Profile::of(&problem, &exact, &judge, s, 0.1);
        let [last, before] = [1, 2].map(|k| profile.inside[profile.inside.len() - k].radius);
        assert!(last - before < 1e-3 * s && s - last < 1e-3 * s);
        assert_eq!(Profile::of(&problem, rings.as_ref(), &judge, s, 0.1).inside.len(), 50);
    }
}
