//! The potential of bodies and device over the contact radius, with the control held.
//!
//! At a radius s that is not in equilibrium the control still fixes δ, the force being linear in δ. With x = δ − δₑ the
//! distance from the equilibrium (δₑ, Pₑ) of the same radius, and C(s) = δₑ, Pₑ or δₑ + Pₑ/k the value that the control
//! has there,
//!
//! ```text
//! x(s) = c·(value − C(s)),   c = 1 (displacement), 1/P_δ (force), k/(P_δ + k) (stiffness k)
//! Π    = U (displacement),   U − Pδ (force),   U + ½k(Δ − δ)² (stiffness k)
//! Π'   = ∂U/∂s = P_s x + ½ P_sδ x²     since ∂U/∂s vanishes at x = 0, ∂²U/∂s∂δ = P_s, and U is quadratic in δ
//! ```
//!
//! so one explicit equilibrium per radius gives the slope, which vanishes to full precision where the state is in
//! equilibrium. Π is its integral from the present radius (four Lobatto nodes a step), not a difference of energies
//! that nearly cancel. It has a minimum where C grows with s, which is stability, and a maximum where C falls.
//!
//! With tension at the edge `x < −P_s/P_sδ`. Beyond that, the edge is pressed: the bodies overlap just outside, and
//! the potential is that of an impossible state. Such samples are marked.

use super::curve::Curve;
use super::energy::potential;
use super::equilibrium::{Equilibrium, State};
use super::jump::EdgeDirection;
use super::monotone::Monotone;
use crate::disc::{Evaluation, Order, Solution};
use crate::elementary::ln;
use crate::problem::Control;
use crate::progress::Unwatched;

/// The least number of samples of a landscape: even a short range is drawn with this many steps.
const SAMPLES: f64 = 100.0;

/// The least number of samples on each panel of the solution, and the largest step relative to the radius.
const SAMPLES_PER_PANEL: f64 = 20.0;
const RATIO: f64 = 0.025;

/// The radii of a landscape from `lo` out to `hi`, the borders of the panels among them.
fn grid(solution: &dyn Solution, lo: f64, hi: f64) -> Vec<f64> {
    let mut grid = vec![lo];
    for panel in 0..solution.len() {
        let span = solution.span(panel);
        let (from, to) = (span.lo.max(lo), span.hi.min(hi));
        if from >= to {
            continue;
        }
        let steps = (SAMPLES_PER_PANEL * (to - from) / (span.hi - span.lo))
            .max(SAMPLES * (to - from) / (hi - lo))
            .max(ln(to / from.max(f64::MIN_POSITIVE)).min(10.0) / RATIO)
            .ceil();
        let inner = std::iter::successors(Some(1.0), |j| Some(j + 1.0)).take_while(|j| *j < steps);
        grid.extend(inner.map(|j| from + (to - from) * (j / steps)));
        grid.push(to);
    }
    grid
}

/// Lobatto's inner nodes on (−1, 1) at ±1/√5; weights 1/6, 5/6, 5/6, 1/6 of the step.
const INNER: f64 = 0.447_213_595_499_958;

/// The potential at one radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LandscapeSample {
    /// s.
    pub contact_radius: f64,
    /// Π minus its value at the present radius.
    pub potential: f64,
    /// Whether the edge pulls; where it is pressed the bodies overlap just outside, and no such state exists.
    pub pulled: bool,
}

/// An equilibrium at the held control value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stationary {
    /// s.
    pub contact_radius: f64,
    /// Π minus its value at the present radius.
    pub potential: f64,
    /// A minimum of the potential; a maximum otherwise.
    pub stable: bool,
}

/// The potential over the contact radius at one value of a control, in reduced units.
#[derive(Debug, Clone, PartialEq)]
pub struct Landscape {
    /// What is held.
    pub control: Control,
    /// The value it is held at.
    pub value: f64,
    /// The present radius, at which the potential counts as zero.
    pub present: f64,
    /// The potential there in full.
    pub level: f64,
    /// The potential, radii ascending.
    pub points: Vec<LandscapeSample>,
    /// The equilibria in the range, radii ascending.
    pub stationary: Vec<Stationary>,
}

impl Landscape {
    /// The potential from `from` to `to` as seen from the radius `present` between them, `control` at `value`.
    ///
    /// The range is cut to the curve. `None` where that leaves nothing, or where the basis has no equilibrium on the way.
    pub fn of(
        curve: &Curve,
        control: Control,
        value: f64,
        present: f64,
        [from, to]: [f64; 2],
    ) -> Option<Self> {
        let equilibrium = &curve.equilibrium;
        let (from, to) = (from.max(curve.innermost()), to.min(curve.outermost()));
        // A NaN is in no range, and ends here too.
        if !(from < to && (from..=to).contains(&present)) {
            return None;
        }
        let mut grid = grid(&*curve.solution, from, to);
        let monotone = curve.monotone(control);
        let held = HeldControl { equilibrium, control, value };
        let crossings = held.crossings(curve, &monotone);
        // The present state may be an end of the curve, and beyond it by rounding.
        let within = |s: f64| {
            let inside = s.clamp(from, to);
            if (s - inside).abs() <= ROUNDING * to { inside } else { s }
        };
        let found = crossings.into_iter().map(|(s, stable)| (within(s), stable));
        let mut found: Vec<(f64, bool)> = found.filter(|(s, _)| (from..=to).contains(s)).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        grid.extend(found.iter().map(|(s, _)| *s));
        grid.push(present);
        grid.sort_by(f64::total_cmp);
        grid.dedup();

        let mut points = held.integrate(&grid)?;
        let here = points.iter().find(|p| p.contact_radius >= present)?.potential;
        for point in &mut points {
            point.potential -= here;
        }
        let stationary = found
            .into_iter()
            .filter_map(|(s, stable)| {
                let potential = points.iter().find(|p| p.contact_radius >= s)?.potential;
                Some(Stationary { contact_radius: s, potential, stable })
            })
            .collect();
        let level = held.level(present)?;
        Some(Self { control, value, present, level, points, stationary })
    }

    /// How far the next maximum lies above the present minimum when the edge runs that way.
    ///
    /// The present state is the equilibrium nearest to the present radius. `None` where it is not stable, at a limit
    /// point (where it has merged with the maximum), and where the range ends before there is a maximum.
    pub fn barrier(&self, run: EdgeDirection) -> Option<f64> {
        let distance = |at: &Stationary| (at.contact_radius - self.present).abs();
        let order = |a: &Stationary, b: &Stationary| distance(a).total_cmp(&distance(b));
        let (index, here) = self.stationary.iter().enumerate().min_by(|a, b| order(a.1, b.1))?;
        let next = match run {
            EdgeDirection::Inward => index.checked_sub(1)?,
            EdgeDirection::Outward => index + 1,
        };
        let top = self.stationary.get(next).filter(|top| here.stable && !top.stable)?;
        Some(top.potential - here.potential)
    }
}

/// Radii that differ by this share are the same.
const ROUNDING: f64 = 1e-12;

/// A rise of the potential below this share of its range is rounding.
const RISE: f64 = 1e-6;

/// Whether the potential falls all the way when the edge runs between two radii, the control held at `value`.
///
/// Inward from an unstable state it always does: the control is below its value in equilibrium there, x < 0, and Π' is
/// positive. Outward x > 0, and it falls only while `x < −2 P_s/P_sδ`: with weak adhesion, and always without, the
/// edge is soon pressed so much that the potential rises again, and the next equilibrium may lie higher than the first.
/// `false` also where the basis has no equilibrium on the way.
pub fn falls(curve: &Curve, control: Control, value: f64, from: f64, to: f64) -> bool {
    let equilibrium = &curve.equilibrium;
    let (lo, hi) = (from.min(to), from.max(to));
    let mut grid = grid(&*curve.solution, lo, hi);
    grid.dedup();
    let Some(mut samples) = (HeldControl { equilibrium, control, value }).integrate(&grid) else {
        return false;
    };
    if from > to {
        samples.reverse();
    }
    let (mut lowest, mut highest, mut rise) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
    for sample in &samples {
        lowest = lowest.min(sample.potential);
        highest = highest.max(sample.potential);
        rise = rise.max(sample.potential - lowest);
    }
    rise <= RISE * (highest - lowest)
}

/// A control held at a value.
struct HeldControl<'a> {
    equilibrium: &'a Equilibrium,
    control: Control,
    value: f64,
}

impl HeldControl<'_> {
    /// The equilibria of the solution at the held value, with their stability.
    fn crossings(&self, curve: &Curve, monotone: &Monotone) -> Vec<(f64, bool)> {
        let value = match self.control {
            Control::Displacement | Control::Force => self.value,
            // Weighted as in the stretches, whatever the stiffness.
            Control::Stiffness(k) => self.value * (k / (1.0 + k)),
        };
        let radius = |place| curve.solution.radius(place);
        monotone
            .crossings(&*curve.solution, value)
            .into_iter()
            .map(|(place, stable)| (radius(place), stable))
            .collect()
    }

    /// x = δ − δₑ of the held control at the radius of `e`.
    fn distance(&self, e: &Evaluation) -> f64 {
        let miss = self.value - self.control.value(e.approach, e.force);
        let stiffness = e.force_gradient[0];
        match self.control {
            Control::Displacement => miss,
            Control::Force => miss / stiffness,
            Control::Stiffness(k) => miss * k / (stiffness + k),
        }
    }

    /// Π', and whether the edge pulls.
    fn slope(&self, e: &Evaluation) -> (f64, bool) {
        let x = self.distance(e);
        let (p_s, p_sd) = (e.force_gradient[1], e.force_second[1]);
        ((p_s + 0.5 * p_sd * x) * x, p_s + p_sd * x <= 0.0)
    }

    /// Π from the first radius of `grid`, which ascends.
    fn integrate(&self, grid: &[f64]) -> Option<Vec<LandscapeSample>> {
        let mut nodes = Vec::with_capacity(3 * grid.len());
        for pair in grid.windows(2) {
            let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            nodes.extend([pair[0], middle - INNER * half, middle + INNER * half]);
        }
        nodes.extend(grid.last());
        let Equilibrium { problem, basis, .. } = self.equilibrium;
        let evaluations = basis.equilibria(problem, &nodes, Order::State, &Unwatched);
        if evaluations.len() < nodes.len() {
            return None;
        }
        let slopes: Vec<(f64, bool)> = evaluations.iter().map(|e| self.slope(e)).collect();
        let mut sum = 0.0;
        let mut samples =
            vec![LandscapeSample { contact_radius: nodes[0], potential: 0.0, pulled: slopes[0].1 }];
        for (step, slope) in grid.windows(2).zip(slopes.windows(4).step_by(3)) {
            sum += (step[1] - step[0]) / 12.0 * (slope[0].0 + slope[3].0 + 5.0 * (slope[1].0 + slope[2].0));
            samples.push(LandscapeSample { contact_radius: step[1], potential: sum, pulled: slope[3].1 });
        }
        Some(samples)
    }

    /// Π in full at `s`.
    fn level(&self, s: f64) -> Option<f64> {
        let Equilibrium { problem, basis, .. } = self.equilibrium;
        let e = basis.equilibrium(problem, s)?;
        let approach = e.approach + self.distance(&e);
        let energy = basis.evaluate(problem, s, approach).energy;
        let force = e.force + e.force_gradient[0] * (approach - e.approach);
        Some(potential(self.control, self.value, &State { contact_radius: s, approach, force, energy }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disc::{Basis, ExactBasis, Table};
    use crate::gap::Shape;
    use crate::problem::{Problem, Reduced};
    use crate::quasistatic::{Detail, Extremum};
    use crate::ritz::Rings;
    use std::f64::consts::PI;
    use std::sync::Arc;

    const CONTROLS: [Control; 3] = [Control::Displacement, Control::Force, Control::Stiffness(0.15)];

    fn problem(amplitude: f64) -> Reduced {
        let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude, wavelength: 0.05 };
        Problem { effective_modulus: 1.0, work_of_adhesion: 0.004, shape }.reduced()
    }

    fn curve(problem: &Reduced, rings: Option<usize>) -> Curve {
        let table = Arc::new(Table::new(Arc::clone(&problem.gap), 0.5, &Unwatched).unwrap());
        let basis: Arc<dyn Basis> = match rings {
            Some(rings) => Rings::shared(rings).unwrap(),
            None => Arc::new(ExactBasis::new(Arc::clone(&table), 0.5)),
        };
        Curve::new(problem.clone(), basis, table, [0.5, 0.02], Detail::Drawn, &Unwatched).unwrap().unwrap()
    }

    /// The radii at which `control` takes `value` on the curve, descending, with their stability.
    fn crossings(curve: &Curve, control: Control, value: f64) -> Vec<(f64, bool)> {
        let held = HeldControl { equilibrium: &curve.equilibrium, control, value };
        let mut found = held.crossings(curve, &curve.monotone(control));
        found.retain(|(s, _)| (0.02..=0.5).contains(s));
        found.reverse();
        found
    }

    #[test]
    fn of_a_smooth_sphere_it_is_the_closed_form() {
        let (gamma, problem) = (0.004, problem(0.0));
        let curve = curve(&problem, None);
        // U = ∫₀^s (δ − a²)² da − πγs².
        let delta = 0.01;
        let energy =
            |s: f64| s * delta * delta - 2.0 / 3.0 * delta * s.powi(3) + s.powi(5) / 5.0 - PI * gamma * s * s;
        let control = Control::Displacement;
        let present = crossings(&curve, control, delta)[0].0;
        let seen = Landscape::of(&curve, control, delta, present, [0.0, 1.0]).unwrap();
        assert!((seen.level / energy(present) - 1.0).abs() < 1e-12);
        for at in &seen.points {
            let exact = energy(at.contact_radius) - energy(present);
            assert!((at.potential - exact).abs() < 1e-9 * seen.level.abs(), "{at:?} {exact}");
            // q = s² − δ ≥ 0.
            assert_eq!(at.pulled, at.contact_radius.powi(2) >= delta, "{at:?}");
        }
        assert_eq!(seen.stationary.len(), 1);
        assert!(seen.stationary[0].stable && seen.barrier(EdgeDirection::Outward).is_none());
    }

    #[test]
    fn its_extremes_are_the_equilibria_and_its_differences_those_of_the_potential() {
        let problem = problem(0.0025);
        for rings in [None, Some(100)] {
            let curve = curve(&problem, rings);
            for control in CONTROLS {
                for index in [60, 101, 150, 190] {
                    let at = &curve.samples[index];
                    let (present, value) = (at.contact_radius, control.value(at.approach, at.force));
                    let seen = Landscape::of(&curve, control, value, present, [0.03, 0.5]).unwrap();
                    let held = HeldControl { equilibrium: &curve.equilibrium, control, value };
                    assert!(seen.stationary.iter().any(|at| (at.contact_radius - present).abs() < 1e-9));
                    let deepest = seen.points.iter().fold(0.0_f64, |most, p| most.max(p.potential.abs()));
                    // The energies themselves are accurate only to their own rounding.
                    for at in seen.points.iter().step_by(9) {
                        let exact = held.level(at.contact_radius).unwrap() - seen.level;
                        let error = (at.potential - exact).abs();
                        assert!(
                            error < 1e-8 * deepest + 1e-12 * seen.level.abs(),
                            "{control} {at:?} {exact}"
                        );
                    }
                    for at in &seen.stationary {
                        let e = 1e-5 * at.contact_radius;
                        let [before, after] = [-e, e].map(|e| {
                            let s = at.contact_radius + e;
                            held.slope(&curve.equilibrium.basis.equilibrium(&problem, s).unwrap()).0
                        });
                        assert_eq!(after > before, at.stable, "{control} {at:?}");
                        assert!(before * after < 0.0, "{control} {at:?}");
                    }
                    // Minima and maxima in turn, and no other sign change of the slope while the edge pulls.
                    assert!(seen.stationary.windows(2).all(|pair| pair[0].stable != pair[1].stable));
                    let falls = |pair: &[LandscapeSample]| pair[1].potential < pair[0].potential;
                    let turns = seen.points.windows(3).filter(|three| {
                        three.iter().all(|p| p.pulled) && falls(&three[..2]) != falls(&three[1..])
                    });
                    for turn in turns {
                        let near =
                            |at: &Stationary| (at.contact_radius - turn[1].contact_radius).abs() < 1e-9;
                        assert!(seen.stationary.iter().any(near), "{control} {turn:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_barrier_vanishes_towards_a_limit_point() {
        let problem = problem(0.0025);
        let curve = curve(&problem, None);
        for control in CONTROLS {
            let limits = curve.limit_points(control);
            let limit = limits.iter().find(|limit| limit.turn == Extremum::Minimum).unwrap();
            let (at, value) = (limit.contact_radius, control.value(limit.approach, limit.force));
            let size = value.abs();
            let barrier = |above: f64| {
                let value = value + above * size;
                // The stable state outward of the limit point.
                let present = crossings(&curve, control, value)
                    .iter()
                    .map(|(s, _)| *s)
                    .filter(|s| *s >= at)
                    .fold(f64::INFINITY, f64::min);
                Landscape::of(&curve, control, value, present.min(0.5), [at - 0.03, at + 0.03])?
                    .barrier(EdgeDirection::Inward)
            };
            let [high, low, least] = [1e-4, 1e-6, 1e-8].map(|above| barrier(above).unwrap());
            // A fold: the height scales as the distance of the control to the power 3/2.
            assert!(least > 0.0, "{control}: {least}");
            for ratio in [high / low, low / least] {
                assert!((ratio / 1e3 - 1.0).abs() < 0.2, "{control}: {high} {low} {least}");
            }
            assert_eq!(barrier(-1e-8), None, "{control}");
        }
    }

    #[test]
    fn outside_the_curve_there_is_nothing() {
        let problem = problem(0.0);
        let curve = curve(&problem, None);
        let seen = |present, range| Landscape::of(&curve, Control::Displacement, 0.0, present, range);
        assert!(seen(0.6, [0.1, 0.7]).is_none() && seen(0.2, [0.3, 0.4]).is_none());
        assert!(seen(0.2, [0.2, 0.2]).is_none() && seen(f64::NAN, [0.1, 0.4]).is_none());
        assert!(seen(0.2, [0.1, 9.0]).is_some());
    }
}
