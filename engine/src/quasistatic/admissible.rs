//! Whether a state is possible: the bodies must stay apart outside the contact.
//!
//! The method assumes one connected disc. Once solved, the deformed gap
//!
//! ```text
//! w(r) = h(r) + u(r) − δ = (2/π) ∫_s^r (g(a) − δ)/√(r² − a²) da,   r > s
//! ```
//!
//! must not be negative: where it is, the next crest would already touch, and the state cannot be reached as computed.
//! It can become negative for the first time only where g < δ (see [`outside`]), so the table of g is searched for
//! such radii, and w is computed only there. The search is complete: waves far out cannot touch, because
//!
//! ```text
//! g(a) ≥ κa² − Σ A (√(πqa/2) + 1)
//! ```
//!
//! and a gap that ends is searched to its end. A formula is searched to ten times its length. What is unknown, or was
//! not examined, is reported as such. Without adhesion the pressure inside must not be negative either.
//!
//! With adhesion, tension inside is allowed, however large: in the JKR limit adhesion has no range and bears any
//! tension until an edge runs, and there is no edge inside. So the limit γ → 0 differs from γ = 0: states that any
//! adhesion allows, however weak, are refused without it.

use crate::disc::{Panels, Table, outside};
use crate::elementary::{pow, sin};
use crate::gap::panels::Variable;
use crate::gap::wave_index;
use crate::gap::{Form, Gap};
use crate::problem::Reduced;
use crate::progress::Progress;
use crate::root;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

/// A formula is searched out to this many of its lengths.
const LENGTHS: f64 = 10.0;

/// The gap outside is drawn, and the nearest crest is looked for, up to this multiple of s or this many waves outside the edge, whichever is more, but
/// over no more waves than the last of these: the gap at a crest is a sum over all waves up to there.
const FARTHEST: f64 = 4.0;
const FARTHEST_WAVES: f64 = 3.0;
const MOST_WAVES: f64 = 100.0;

/// Steps per wave: a parabola through three of them sees every crest.
const STEPS_PER_WAVE: f64 = 8.0;
/// Steps in the first wave outside the edge, evenly spaced in √(r − s): the gap has a square root at the edge.
const STEPS_AT_EDGE: f64 = 12.0;
/// Steps from the edge to the end of the search for a gap without waves.
const STEPS_WITHOUT_WAVES: f64 = 24.0;
/// The nearest crest is looked for as long as h exceeds δ by no more than this many times √(2πγs) plus this share of
/// g(s).
const MARGIN: [f64; 2] = [2.0, 0.5];
/// A gap counts as negative where it is below minus this share of |δ| + √(2πγs): less is rounding.
const ROUNDING: f64 = 1e-12;
/// A pressure counts as negative below minus this share of the largest: the square root of rounding, because the
/// pressure falls off towards the edge.
const PRESSED: f64 = 1e-7;
/// Steps in the search for a falling gap: per wave, and at least and at most over the whole range.
const SLOPE_STEPS_PER_WAVE: f64 = 32.0;
const SLOPE_STEPS: f64 = 200.0;
const MOST_SLOPE_STEPS: f64 = 40_000.0;
/// Points at which the pressure without adhesion is evaluated, evenly spaced in the angle θ of r = s sin θ, and points
/// for each wave.
const PRESSURES: f64 = 100.0;
const PRESSURES_PER_WAVE: f64 = 16.0;

/// Waves are searched at least this far out, however far they could reach: this many of the shortest waves from the
/// axis.
fn minimum_searched(steepest: f64) -> f64 {
    const WAVES: f64 = 1500.0;
    if steepest > 0.0 { WAVES * TAU / steepest } else { 0.0 }
}

/// A place outside the contact where the bodies come near each other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Crest {
    /// r, where the deformed gap has a minimum.
    #[serde(with = "crate::exact")]
    pub radius: f64,
    /// The gap there, negative where the bodies would overlap.
    #[serde(with = "crate::exact")]
    pub gap: f64,
    /// Which crest of the waves it is; `None` without waves.
    pub wave: Option<u64>,
}

/// The error of g in the panel beside the axis where the edge of a disc of radius `s` lies in it, 0 elsewhere: there a
/// high power of r is resolved to fewer digits than on any other panel.
fn error_beside_axis(panels: &Panels, s: f64) -> f64 {
    const SHARE: f64 = 1e-6;
    let panel = panels.place(s).panel;
    if panels.list()[panel].span.variable != Variable::Fifth {
        return 0.0;
    }
    SHARE * panels.value_series(panel).iter().map(|c| c.abs()).sum::<f64>()
}

/// What a state must satisfy beyond equilibrium, in reduced units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Admissibility {
    /// The nearest crest outside; `None` where the gap only grows.
    pub nearest: Option<Crest>,
    /// The least pressure inside and its radius, without adhesion only: adhesion may pull.
    #[serde(with = "crate::exact")]
    pub least_pressure: Option<(f64, f64)>,
    /// Whether the bodies stay apart outside, as far as the gap is known, and, without adhesion, nothing pulls inside.
    pub holds: bool,
    /// The radius up to which the gap was examined, if what lies beyond is unknown; `None` where nothing can follow.
    #[serde(with = "crate::exact")]
    pub known_to: Option<f64>,
}

impl Admissibility {
    /// The crest that would overlap; `None` where the state is admissible or only the pressure is at fault.
    pub fn overlapping(&self) -> Option<Crest> {
        self.nearest.filter(|crest| !self.holds && crest.gap < 0.0)
    }
}

/// Decides whether the states of one problem are admissible.
#[derive(Debug, Clone)]
pub struct Judge {
    problem: Reduced,
    table: Arc<Table>,
    form: Form,
}

impl Judge {
    /// The judge of `problem`, whose gap has this table.
    pub fn new(problem: &Reduced, table: &Arc<Table>) -> Self {
        Self { problem: problem.clone(), table: Arc::clone(table), form: problem.gap.form() }
    }

    /// The admissibility of the state (s, δ), with the nearest crest whether it touches or not.
    pub fn judge(&self, s: f64, delta: f64, progress: &dyn Progress) -> Admissibility {
        let found = self.verdict(s, delta, progress);
        let nearest = match (found.nearest, self.nearest_crest(s, delta, progress)) {
            (Some(a), Some(b)) => Some(if b.gap < a.gap { b } else { a }),
            (a, b) => a.or(b),
        };
        Admissibility { nearest, ..found }
    }

    /// The same, but with a crest only where one overlaps, which is enough when there are many states. Where
    /// `progress` says stop, nothing is known about the gap outside.
    pub fn verdict(&self, s: f64, delta: f64, progress: &dyn Progress) -> Admissibility {
        let (end, known_to) = self.search_end(s, delta);
        let mut overlap = -ROUNDING * (delta.abs() + self.opening(s));
        let panels = if end > s { self.table.up_to_while(end, 0, progress).ok() } else { None };
        let searched = panels.map(|panels| {
            overlap = overlap.min(-error_beside_axis(&panels, s));
            let end = end.min(panels.reach());
            match outside::overlap_on_many(&panels, s, delta, end, overlap) {
                None => outside::least_gap(&panels, s, delta, end, overlap, progress),
                found => outside::LeastGap { at: found, given_up: None },
            }
        });
        let known_to = searched.and_then(|searched| searched.given_up).or(known_to);
        let least = searched.and_then(|searched| searched.at);
        let nearest = least.filter(|[_, gap]| *gap < overlap).map(|[radius, gap]| Crest {
            radius,
            gap,
            wave: wave_index(radius, self.problem.gap.wavelength()),
        });
        let least_pressure = if self.problem.work_of_adhesion > 0.0 { None } else { self.least_pressure(s) };
        let pressed = least_pressure.is_none_or(|(_, least, most)| least >= -PRESSED * most);
        Admissibility {
            nearest,
            least_pressure: least_pressure.map(|(radius, least, _)| (radius, least)),
            holds: nearest.is_none() && pressed,
            known_to,
        }
    }

    /// The radius beyond which it is not known whether the bodies stay apart outside a disc of radius `s`; `None`
    /// where nothing can follow.
    pub fn unknown_beyond(&self, s: f64) -> Option<f64> {
        self.search_end(s, 0.0).1
    }

    /// √(2πγs): by how much adhesion lowers the edge.
    fn opening(&self, s: f64) -> f64 {
        (TAU * self.problem.work_of_adhesion * s).sqrt()
    }

    /// How far out the gap must be examined, and that radius again if what follows is unknown.
    fn search_end(&self, s: f64, delta: f64) -> (f64, Option<f64>) {
        match &self.form {
            // g only grows.
            Form::Power { .. } => (s, None),
            Form::Waves { curvature, waves } => {
                let root: f64 =
                    waves.iter().map(|w| w.amplitude.abs() * (FRAC_PI_2 * w.wavenumber).sqrt()).sum();
                let rest: f64 = waves.iter().map(|w| w.amplitude.abs()).sum();
                let lowest = |a: f64| curvature * a * a - root * a.sqrt() - rest - delta;
                // Beyond its minimum the bound only grows.
                let minimum = pow(root / (4.0 * curvature), 2.0 / 3.0);
                let mut far = minimum.max(s);
                while lowest(far) <= 0.0 && far.is_finite() {
                    far *= 1.1;
                }
                let steepest = waves.iter().fold(0.0_f64, |most, wave| most.max(wave.wavenumber));
                let most = s.max(minimum_searched(steepest));
                if far > most { (most, Some(most)) } else { (far.max(s), None) }
            }
            Form::Any if self.table.end() == f64::INFINITY => {
                let end = LENGTHS * self.problem.gap.reference_length().max(s);
                (end, Some(end))
            }
            Form::Any | Form::Cubic(_) => {
                let end = self.table.end();
                (end, Some(end))
            }
        }
    }

    /// In a disc of radius `s` without adhesion: the radius of the least pressure, that pressure, and the largest
    /// pressure.
    ///
    /// In equilibrium its edge neither pulls nor presses, so δ = g(s). The δ of rings is slightly off, and an edge
    /// that pulled by that much would be mistaken for a disc that pulls.
    fn least_pressure(&self, s: f64) -> Option<(f64, f64, f64)> {
        let panels = self.table.up_to(s).ok()?;
        let delta = panels.value(panels.place(s));
        let waves = self.problem.gap.feature_length().map_or(0.0, |wave| s / wave);
        let points = (PRESSURES_PER_WAVE * waves).max(PRESSURES).ceil();
        let angles = std::iter::successors(Some(0.0), |j| Some(j + 1.0)).take_while(|j| *j < points);
        let mut least: Option<(f64, f64)> = None;
        let mut most = 0.0_f64;
        for r in angles.map(|j| s * sin(FRAC_PI_2 * j / points)) {
            let p = outside::pressure(&panels, s, delta, r);
            most = most.max(p.abs());
            if least.is_none_or(|(_, least)| p < least) {
                least = Some((r, p));
            }
        }
        least.map(|(r, p)| (r, p, most))
    }

    /// The smallest minimum of the deformed gap outside, near the edge; `None` where the gap only grows, and where
    /// `progress` said stop.
    pub fn nearest_crest(&self, s: f64, delta: f64, progress: &dyn Progress) -> Option<Crest> {
        let gap = &self.problem.gap;
        let mut radii = radii(s, gap.feature_length());
        // A measured gap ends, and is not a number beyond its end.
        let h: Vec<f64> = radii.iter().map(|&r| gap.jet(r).value).take_while(|h| h.is_finite()).collect();
        let opening = self.opening(s);
        let reach = delta + MARGIN[0] * opening + MARGIN[1] * (delta + opening).abs();
        // One more step, so that a minimum at the last radius within reach has two neighbours.
        let within = h.iter().rposition(|&h| h < reach).map_or(0, |at| at + 2).min(h.len());
        radii.truncate(within);
        let panels = self.table.up_to(radii.last().copied()?).ok()?;
        radii.retain(|r| *r <= panels.reach());
        let gaps = |radii: &[f64]| -> Option<Vec<f64>> {
            let gap = |&r: &f64| (!progress.stop()).then(|| outside::gap_from(&panels, s, delta, r));
            radii.iter().map(gap).collect()
        };
        let w = if radii.len() < 3 { return None } else { gaps(&radii)? };
        let minima = radii.windows(3).zip(w.windows(3)).filter(|(_, w)| w[1] <= w[0] && w[1] <= w[2]);
        let vertices = minima.map(|(r, w)| vertex([r[0], r[1], r[2]], [w[0], w[1], w[2]]));
        let (mut radius, mut least, mut width) = vertices.min_by(|a, b| a.1.total_cmp(&b.1))?;
        // A parabola narrowed twice is at the minimum to about 1e-8 of a wave, and its value to rounding.
        for _ in 0..2 {
            width *= 0.1;
            let near = [(radius - width).max(s), radius, (radius + width).min(panels.reach())];
            let w = gaps(&near)?;
            let [Some(&a), Some(&b), Some(&c)] = [w.first(), w.get(1), w.get(2)] else { return None };
            let (r, w, _) = vertex(near, [a, b, c]);
            (radius, least) = (r, w);
        }
        Some(Crest { radius, gap: least, wave: wave_index(radius, gap.wavelength()) })
    }
}

/// Whether h falls anywhere on (0, `largest`]. If it does, a disc without adhesion cannot be connected at every radius
/// up to there: that needs h' > 0 (on the wavy sphere λ²/(AR) > 8.5761).
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
        // Where h'' turns from negative to positive the slope is least, between two radii of the search.
        if gap.jet(last).second < 0.0 && jet.second > 0.0 {
            let [_, rising] = root::halved(last, r, |r| gap.jet(r).second < 0.0);
            if gap.jet(rising).first < 0.0 {
                return true;
            }
        }
        last = r;
    }
    false
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
    // Stay within the three points: they bracket the minimum, or nearly do.
    let step = (-0.5 * slope / bend).clamp(a - b, c - b);
    (b + step, fb + (slope + bend * step) * step, width)
}

/// How far out, at most, the nearest crest is looked for.
fn farthest(s: f64, wave: Option<f64>) -> f64 {
    let most = wave.map_or(f64::INFINITY, |wave| s + MOST_WAVES * wave);
    (FARTHEST * s).max(s + FARTHEST_WAVES * wave.unwrap_or(0.0)).min(most)
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
    use crate::disc::{Basis, ExactBasis};
    use crate::gap::Shape;
    use crate::problem::Problem;
    use crate::progress::Unwatched;
    use crate::ritz::Rings;
    use crate::theory;
    use crate::theory::quadrature::integrate;
    use std::f64::consts::FRAC_2_PI;
    use std::sync::Arc;

    fn wavy(amplitude: f64, wavelength: f64, gamma: f64) -> Problem {
        let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude, wavelength };
        Problem { effective_modulus: 1.0, work_of_adhesion: gamma, shape }
    }

    /// The judge of `problem`, and the exact basis of its gap.
    fn exact(problem: &Reduced) -> (Judge, ExactBasis) {
        let table = Arc::new(Table::new(Arc::clone(&problem.gap), 0.5, &Unwatched).unwrap());
        (Judge::new(problem, &table), ExactBasis::new(table, 0.5))
    }

    fn at(problem: &Reduced, judge: &Judge, basis: &dyn Basis, s: f64) -> Admissibility {
        judge.judge(s, basis.equilibrium(problem, s).unwrap().approach, &Unwatched)
    }

    /// The least gap over many radii from `s` to far outside, by quadrature of the exact solution.
    fn exact_least(problem: &Problem, s: f64) -> f64 {
        let exact = theory::Exact::of(problem);
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
            let (judge, exact) = exact(&problem);
            let rings = Rings::shared(100).unwrap();
            for (basis, slack) in [(&exact as &dyn Basis, 0), (rings.as_ref(), 2)] {
                let radii = (0..97).map(|i| 0.02 + 0.005 * f64::from(i));
                let found = radii.filter(|&s| !at(&problem, &judge, basis, s).holds).count();
                assert!(found.abs_diff(count) <= slack, "{amplitude} {wavelength} {gamma}: {found}");
            }
        }
    }

    #[test]
    fn bodies_that_overlap_along_many_waves_are_found_at_a_few_places() {
        const ROUNDING: f64 = -1e-12;
        let (problem, s) = (wavy(0.01, 0.002, 1e-4).reduced(), 0.02);
        let (judge, basis) = exact(&problem);
        let rests = basis.equilibrium(&problem, s).unwrap().approach;
        for (delta, overlaps) in [(rests, false), (rests + 0.1, true)] {
            let (end, _) = judge.search_end(s, delta);
            let panels = judge.table.up_to_while(end, 0, &Unwatched).unwrap();
            let end = end.min(panels.reach());
            let pieces = outside::below(&panels, s, delta, end).len();
            let few = outside::overlap_on_many(&panels, s, delta, end, ROUNDING);
            let [_, least] = outside::least_gap(&panels, s, delta, end, ROUNDING, &Unwatched).at.unwrap();
            assert!(pieces > 300 && (least < 0.0) == overlaps, "{pieces} {least}");
            assert_eq!(few.map(|[_, gap]| gap < 0.0), overlaps.then_some(true), "{few:?}");
        }
    }

    #[test]
    fn the_exact_gap_agrees() {
        for (problem, step) in [(wavy(0.0025, 0.05, 1e-4), 7), (wavy(0.01, 0.1, 2e-3), 5)] {
            let reduced = problem.reduced();
            let (judge, basis) = exact(&reduced);
            let mut seen = [0, 0];
            for i in (0..97).step_by(step) {
                let s = 0.02 + 0.005 * f64::from(i);
                let (ours, exact) = (at(&reduced, &judge, &basis, s), exact_least(&problem, s));
                assert_eq!(ours.holds, exact >= 0.0, "{s}: {ours:?} {exact}");
                seen[usize::from(ours.holds)] += 1;
                if exact < 0.0 {
                    // Ours is the minimum itself, the other the least value at some radii near it.
                    let gap = ours.nearest.unwrap().gap;
                    assert!(gap <= exact + 1e-12 && exact - gap < 1e-5, "{s}: {gap} {exact}");
                }
            }
            assert!(seen[0] > 0 && seen[1] > 0, "{seen:?}");
        }
    }

    #[test]
    fn a_flat_tip_overlaps_nowhere_however_small_the_disc() {
        use crate::gap::formula::TypedGap;
        for text in ["r^6", "r^8"] {
            let shape = Shape::Formula(Arc::new(TypedGap::new(text, Vec::new(), None).unwrap()));
            let problem = Problem { effective_modulus: 1.0, work_of_adhesion: 0.0, shape }.reduced();
            let table = Arc::new(Table::new(Arc::clone(&problem.gap), 0.65, &Unwatched).unwrap());
            let (judge, basis) = (Judge::new(&problem, &table), ExactBasis::new(table, 0.65));
            for k in 0..200 {
                let s = 0.6 * 0.94_f64.powi(k);
                assert!(at(&problem, &judge, &basis, s).holds, "{text} {s}");
            }
        }
    }

    #[test]
    fn where_the_gap_ends_the_search_ends() {
        /// The wavy sphere known only up to r = 0.43, so that a crest near 0.445 is not known.
        #[derive(Debug)]
        struct Measured(Shape);

        impl Gap for Measured {
            fn jet(&self, r: f64) -> crate::gap::Jet {
                let unknown = crate::gap::Jet { value: f64::NAN, ..Default::default() };
                if r <= 0.43 { self.0.jet(r) } else { unknown }
            }

            fn feature_length(&self) -> Option<f64> {
                self.0.feature_length()
            }

            fn largest_radius(&self) -> Option<f64> {
                Some(0.43)
            }

            fn slope_bound(&self, disc: crate::gap::ComplexDisc) -> Option<f64> {
                self.0.slope_bound(disc)
            }

            fn reference_length(&self) -> f64 {
                1.0
            }
        }

        let problem = wavy(0.0025, 0.05, 1e-4);
        let known = problem.reduced();
        let measured = Reduced { gap: Arc::new(Measured(problem.shape)), ..known.clone() };
        let ((judge, basis), (short, measured_basis)) = (exact(&known), exact(&measured));
        for (s, seen) in [(0.42, false), (0.372, true)] {
            let all = at(&known, &judge, &basis, s);
            assert!(!all.holds && all.known_to.is_none());
            let found = at(&measured, &short, &measured_basis, s);
            assert_eq!(!found.holds, seen, "{s}");
            // What lies beyond is unknown, and the result says so.
            assert!(found.known_to.is_some_and(|r| (r - 0.43).abs() < 1e-5), "{found:?}");
        }
        let delta = basis.equilibrium(&measured, 0.42).unwrap().approach;
        let drawn = crate::quasistatic::Profile::of(&measured, &measured_basis, &short, 0.42, delta).outside;
        assert!(drawn.iter().all(|at| at.gap.is_finite() && at.radius <= 0.43) && drawn.len() > 10);
    }

    #[test]
    fn the_wavy_sphere_falls_below_its_connectivity() {
        // λ²/(AR) just below and above 8.5761; within half a wave every gap rises.
        for (connectivity, falling) in [(1.0, true), (8.575, true), (8.577, false), (100.0, false)] {
            let problem = wavy(0.0025 / connectivity, 0.05, 0.0).reduced();
            assert_eq!(falls(problem.gap.as_ref(), 0.5), falling, "{connectivity}");
            assert!(!falls(problem.gap.as_ref(), 0.024), "{connectivity}");
        }
        assert!(!falls(wavy(0.0, 0.05, 0.0).reduced().gap.as_ref(), 0.5));
    }

    #[test]
    fn without_adhesion_the_gap_must_rise() {
        // λ²/(AR) below and above 8.5761: a connected disc of every radius, or not.
        for (amplitude, possible) in [(0.0, true), (0.0002, true), (0.0025, false)] {
            let problem = wavy(amplitude, 0.05, 0.0).reduced();
            let (judge, basis) = exact(&problem);
            for i in 0..40 {
                let s = 0.021 + 0.01 * f64::from(i);
                let found = at(&problem, &judge, &basis, s);
                assert_eq!(found.holds, possible, "{amplitude} {s}: {found:?}");
                assert!(found.least_pressure.is_some());
            }
        }
        let problem = wavy(0.0, 0.05, 0.004).reduced();
        let (judge, basis) = exact(&problem);
        assert_eq!(at(&problem, &judge, &basis, 0.2).least_pressure, None);
    }
}
