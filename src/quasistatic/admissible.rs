//! Whether a state is possible: the bodies must stay apart outside the contact.
//!
//! The method assumes one connected disc. Once solved, the deformed gap
//!
//! ```text
//! w(r) = h(r) + u(r) − δ,   r > s
//! ```
//!
//! must not be negative: where it is, the next crest would already touch, and the state cannot be reached as computed. A
//! gap that opens at the edge and is positive far away is negative somewhere only if a minimum of it is, so the minima are
//! looked for, near the crests of h. Without adhesion the pressure inside must not be negative either.
//!
//! With adhesion tension inside is allowed, whatever its size: the JKR limit has adhesion without range, which bears any
//! tension until an edge runs, and no edge is there. So the limit γ → 0 is not γ = 0: states that an adhesion however
//! weak allows are refused without any.
//!
//! Far out a crest cannot be reached: u is no lower than (2/π) asin(s/r) times the least δ − g(a) inside (see
//! [`disc`](crate::theory::disc)), which is −√(2πγs) but for the waves of g. The search ends where h stays above δ by
//! that and a margin for the waves.

use super::equilibrium::wave_index;
use crate::contact::{Gap, Reduced};
use crate::ritz::Basis;
use std::f64::consts::TAU;

/// The search for crests ends at this multiple of s or this many waves outside the edge, whichever is more.
const FARTHEST: f64 = 4.0;
const FARTHEST_WAVES: f64 = 3.0;

/// Steps per wave: a parabola through three of them sees every crest.
const STEPS_PER_WAVE: f64 = 8.0;
/// Steps in the first wave outside the edge, where the gap has a root at the edge: even in √(r − s).
const STEPS_AT_EDGE: f64 = 12.0;
/// Steps from the edge to the end of the search for a gap without waves.
const STEPS_WITHOUT_WAVES: f64 = 24.0;
/// Crests are searched while h is not above δ by this many times √(2πγs) and this share of g(s): for the waves of g.
const MARGIN: [f64; 2] = [2.0, 0.5];
/// A gap counts as negative below this share of the lengths whose difference it is: rounding and truncation.
const ROUNDING: f64 = 1e-9;
/// Steps per wave, and at least and at most on the whole range, in the search for a falling gap.
const SLOPE_STEPS_PER_WAVE: f64 = 32.0;
const SLOPE_STEPS: f64 = 200.0;
const MOST_SLOPE_STEPS: f64 = 40_000.0;
/// Halvings of a step for the least slope in it: its value is then good to rounding.
const HALVINGS: usize = 30;

/// A place outside the contact at which the bodies come near.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crest {
    /// r, where the deformed gap has a minimum.
    pub radius: f64,
    /// The gap there, negative where the bodies would overlap.
    pub gap: f64,
    /// Which crest of the waves it is; `None` without waves.
    pub wave: Option<u64>,
}

/// What a state must satisfy beyond equilibrium, in reduced units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Admissibility {
    /// The nearest crest outside; `None` where the gap only grows.
    pub nearest: Option<Crest>,
    /// The least pressure inside and its radius, without adhesion only: adhesion may pull.
    pub least_pressure: Option<(f64, f64)>,
    /// Whether the bodies stay apart outside and, without adhesion, nothing pulls inside.
    pub holds: bool,
}

impl Admissibility {
    /// The crest that would overlap; `None` where the state is admissible or only the pressure is at fault.
    pub fn overlapping(&self) -> Option<Crest> {
        self.nearest.filter(|crest| !self.holds && crest.gap < 0.0)
    }

    /// The admissibility of the state (s, δ).
    pub fn of(problem: &Reduced, basis: &dyn Basis, s: f64, delta: f64) -> Self {
        let nearest = nearest_crest(problem, basis, s, delta);
        let edge = problem.gap.jet(s).value;
        let size = delta.abs() + edge.abs() + opening(problem, s);
        let apart = nearest.is_none_or(|crest| crest.gap >= -ROUNDING * size);
        if problem.work_of_adhesion > 0.0 {
            return Self { nearest, least_pressure: None, holds: apart };
        }
        let pressure = basis.pressure_profile(problem, s, delta);
        let most = pressure.iter().fold(0.0_f64, |most, (_, p)| most.max(p.abs()));
        let least = pressure.into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
        // The pressure falls like √(s − r) to the free edge: an edge that is off by ε s is a pressure off by √(2ε).
        let edge_error = 10f64.powf(-basis.trusted_digits(problem, s));
        let pressed = least.is_none_or(|(_, p)| p >= -(2.0 * edge_error).sqrt() * most);
        Self { nearest, least_pressure: least, holds: apart && pressed }
    }
}

/// Whether h falls somewhere on (0, `largest`]: without adhesion a disc of every radius up to there could then not be
/// connected, for which h' > 0 is needed (on the wavy sphere λ²/(AR) > 8.5761).
pub fn falls(gap: &dyn Gap, largest: f64) -> bool {
    let step = gap.feature_length().map_or(f64::INFINITY, |wave| wave / SLOPE_STEPS_PER_WAVE);
    let step = step.min(largest / SLOPE_STEPS).max(largest / MOST_SLOPE_STEPS);
    let outward = std::iter::successors(Some(step), |r| Some(r + step)).take_while(|r| *r < largest);
    let mut last = 0.0;
    for r in outward.chain([largest]) {
        let jet = gap.jet(r);
        if jet.first < 0.0 {
            return true;
        }
        // Where h'' turns from falling to rising the slope is least, between two radii of the search.
        if gap.jet(last).second < 0.0 && jet.second > 0.0 {
            let (mut falling, mut rising) = (last, r);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (falling + rising);
                let side = if gap.jet(middle).second < 0.0 { &mut falling } else { &mut rising };
                *side = middle;
            }
            if gap.jet(rising).first < 0.0 {
                return true;
            }
        }
        last = r;
    }
    false
}

/// √(2πγs): by how much adhesion lowers the edge.
fn opening(problem: &Reduced, s: f64) -> f64 {
    (TAU * problem.work_of_adhesion * s).sqrt()
}

/// The minimum of the deformed gap outside that is smallest; `None` where the gap only grows.
pub fn nearest_crest(problem: &Reduced, basis: &dyn Basis, s: f64, delta: f64) -> Option<Crest> {
    let wave = problem.gap.feature_length();
    let mut radii = radii(s, wave);
    // A measured gap ends, and is no number beyond.
    let h: Vec<f64> = radii.iter().map(|&r| problem.gap.jet(r).value).take_while(|h| h.is_finite()).collect();
    let opening = opening(problem, s);
    let reach = delta + MARGIN[0] * opening + MARGIN[1] * (delta + opening).abs();
    // One step more, so that a minimum at the last radius within reach has two neighbours.
    let within = h.iter().rposition(|&h| h < reach).map_or(0, |at| at + 2).min(h.len());
    radii.truncate(within);
    let gaps = |radii: &[f64]| -> Vec<f64> {
        let u = basis.outside_displacement(problem, s, delta, radii);
        radii.iter().zip(u).map(|(&r, u)| problem.gap.jet(r).value - delta + u).collect()
    };
    let w = if radii.len() < 3 { return None } else { gaps(&radii) };
    let minima = radii.windows(3).zip(w.windows(3)).filter(|(_, w)| w[1] <= w[0] && w[1] <= w[2]);
    let vertices = minima.map(|(r, w)| vertex([r[0], r[1], r[2]], [w[0], w[1], w[2]]));
    let (mut radius, mut gap, mut width) = vertices.min_by(|a, b| a.1.total_cmp(&b.1))?;
    // A parabola narrowed twice is at the minimum to about 1e-8 of a wave, and its value to rounding.
    for _ in 0..2 {
        width *= 0.1;
        let near = [(radius - width).max(s), radius, radius + width];
        let w = gaps(&near);
        let [Some(&a), Some(&b), Some(&c)] = [w.first(), w.get(1), w.get(2)] else { return None };
        let (r, w, _) = vertex(near, [a, b, c]);
        (radius, gap) = (r, w);
    }
    Some(Crest { radius, gap, wave: wave_index(radius, problem.gap.wavelength()) })
}

/// Where the parabola through three points is smallest, its value, and half their width.
fn vertex([a, b, c]: [f64; 3], [fa, fb, fc]: [f64; 3]) -> (f64, f64, f64) {
    let (left, right) = ((fb - fa) / (b - a), (fc - fb) / (c - b));
    let bend = (right - left) / (c - a);
    let slope = left + bend * (b - a);
    let width = 0.5 * (c - a);
    if bend.is_nan() || bend <= 0.0 {
        return (b, fb, width);
    }
    // Not beyond the three: they bracket the minimum, or nearly do.
    let step = (-0.5 * slope / bend).clamp(a - b, c - b);
    (b + step, fb + (slope + bend * step) * step, width)
}

/// How far out crests are looked for at most.
pub(super) fn farthest(s: f64, wave: Option<f64>) -> f64 {
    (FARTHEST * s).max(s + FARTHEST_WAVES * wave.unwrap_or(0.0))
}

/// The radii of the search, from `s` outward.
fn radii(s: f64, wave: Option<f64>) -> Vec<f64> {
    let end = farthest(s, wave);
    let (first, count, step) = match wave {
        Some(wave) => (wave.min(end - s), STEPS_AT_EDGE, wave / STEPS_PER_WAVE),
        None => (end - s, STEPS_WITHOUT_WAVES, end),
    };
    let graded = std::iter::successors(Some(0.0), |j| Some(j + 1.0))
        .take_while(|j| *j <= count)
        .map(|j| s + first * (j / count).powi(2));
    let even = std::iter::successors(Some(s + first + step), |r| Some(r + step)).take_while(|r| *r <= end);
    graded.chain(even).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Problem, Shape};
    use crate::ritz::{Rings, Spectral};
    use crate::theory::Exact;
    use crate::theory::quadrature::integrate;
    use std::f64::consts::FRAC_2_PI;
    use std::sync::Arc;

    fn wavy(amplitude: f64, wavelength: f64, gamma: f64) -> Problem {
        let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude, wavelength };
        Problem { effective_modulus: 1.0, work_of_adhesion: gamma, shape }
    }

    fn at(problem: &Reduced, basis: &dyn Basis, s: f64) -> Admissibility {
        Admissibility::of(problem, basis, s, basis.equilibrium(problem, s).unwrap().approach)
    }

    /// The least gap from `s` to far outside among many radii, from the exact solution by quadrature.
    fn exact_least(problem: &Problem, s: f64) -> f64 {
        let exact = Exact::of(problem);
        let delta = exact.approach(s);
        let gap = |r: f64| {
            let wave = exact.wave().map(|wave| wave / r);
            let transform = |psi: f64| [delta - exact.transform(r * psi.sin()).value];
            let [sum] = integrate(0.0, (s / r).asin(), wave, transform).values;
            problem.shape.jet(r).value + FRAC_2_PI * sum - delta
        };
        (1..=400).map(|j| s + 0.2 * (f64::from(j) / 400.0).powi(2)).map(gap).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn counts_of_inadmissible_states() {
        for (amplitude, wavelength, gamma, count) in [
            (0.001, 0.1, 0.05 / TAU, 0),
            (0.0025, 0.05, 0.025 / TAU, 0),
            (0.0025, 0.05, 1e-4, 26),
            (0.01, 0.1, 2e-3, 12),
            (0.01, 0.1, 1e-4, 54),
        ] {
            let problem = wavy(amplitude, wavelength, gamma).reduced();
            let spectral = Spectral::resolving(&problem, 0.5).unwrap();
            let rings = Rings::shared(100).unwrap();
            for (basis, slack) in [(&spectral as &dyn Basis, 0), (rings.as_ref(), 2)] {
                let radii = (0..97).map(|i| 0.02 + 0.005 * f64::from(i));
                let found = radii.filter(|&s| !at(&problem, basis, s).holds).count();
                assert!(found.abs_diff(count) <= slack, "{amplitude} {wavelength} {gamma}: {found}");
            }
        }
    }

    #[test]
    fn the_exact_gap_agrees() {
        for (problem, step) in [(wavy(0.0025, 0.05, 1e-4), 7), (wavy(0.01, 0.1, 2e-3), 5)] {
            let reduced = problem.reduced();
            let spectral = Spectral::resolving(&reduced, 0.5).unwrap();
            let mut seen = [0, 0];
            for i in (0..97).step_by(step) {
                let s = 0.02 + 0.005 * f64::from(i);
                let (ours, exact) = (at(&reduced, &spectral, s), exact_least(&problem, s));
                assert_eq!(ours.holds, exact >= 0.0, "{s}: {ours:?} {exact}");
                seen[usize::from(ours.holds)] += 1;
                if exact < 0.0 {
                    // Ours is the minimum itself, the other the least of some radii near it.
                    let gap = ours.nearest.unwrap().gap;
                    assert!(gap <= exact + 1e-12 && exact - gap < 1e-5, "{s}: {gap} {exact}");
                }
            }
            assert!(seen[0] > 0 && seen[1] > 0, "{seen:?}");
        }
    }

    #[test]
    fn where_the_gap_ends_the_search_ends() {
        /// The wavy sphere up to r = 0.43, at which a crest near 0.445 is not known.
        #[derive(Debug)]
        struct Measured(Shape);

        impl Gap for Measured {
            fn jet(&self, r: f64) -> crate::contact::Jet {
                let unknown = crate::contact::Jet { value: f64::NAN, ..Default::default() };
                if r <= 0.43 { self.0.jet(r) } else { unknown }
            }

            fn feature_length(&self) -> Option<f64> {
                self.0.feature_length()
            }

            fn reference_length(&self) -> f64 {
                1.0
            }
        }

        let problem = wavy(0.0025, 0.05, 1e-4);
        let known = problem.reduced();
        let measured = Reduced { gap: Arc::new(Measured(problem.shape)), ..known.clone() };
        let spectral = Spectral::resolving(&known, 0.5).unwrap();
        for (s, seen) in [(0.42, false), (0.372, true)] {
            assert!(!at(&known, &spectral, s).holds);
            assert_eq!(!at(&measured, &spectral, s).holds, seen, "{s}");
        }
        let delta = spectral.equilibrium(&measured, 0.42).unwrap().approach;
        let drawn = crate::quasistatic::Profile::of(&measured, &spectral, 0.42, delta).outside;
        assert!(drawn.iter().all(|at| at.gap.is_finite() && at.radius <= 0.43) && drawn.len() > 10);
    }

    #[test]
    fn the_wavy_sphere_falls_below_its_connectivity() {
        // λ²/(AR) just below and above 8.5761; within half a wave every gap rises.
        for (connectivity, falling) in [(1.0, true), (8.575, true), (8.577, false), (100.0, false)] {
            let problem = wavy(0.0025 / connectivity, 0.05, 0.0).reduced();
            assert_eq!(falls(&problem.gap, 0.5), falling, "{connectivity}");
            assert!(!falls(&problem.gap, 0.024), "{connectivity}");
        }
        assert!(!falls(&wavy(0.0, 0.05, 0.0).reduced().gap, 0.5));
    }

    #[test]
    fn without_adhesion_the_gap_must_rise() {
        // λ²/(AR) below and above 8.5761: a connected disc of every radius, or not.
        for (amplitude, possible) in [(0.0, true), (0.0002, true), (0.0025, false)] {
            let problem = wavy(amplitude, 0.05, 0.0).reduced();
            let spectral = Spectral::resolving(&problem, 0.5).unwrap();
            for i in 0..40 {
                let s = 0.021 + 0.01 * f64::from(i);
                let found = at(&problem, &spectral, s);
                assert_eq!(found.holds, possible, "{amplitude} {s}: {found:?}");
                assert!(found.least_pressure.is_some());
            }
        }
        assert_eq!(
            at(&wavy(0.0, 0.05, 0.004).reduced(), &Spectral::new(8).unwrap(), 0.2).least_pressure,
            None
        );
    }
}
