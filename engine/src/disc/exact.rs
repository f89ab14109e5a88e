//! The exact basis: one disc, read from the table of its gap.
//!
//! ```text
//! q = g(s) − δ                          the edge pulls where it is positive; G = q²/2πs
//! ρ = q/√(2πs) − √γ = 0   ⇔   δ = g(s) − √(2πγs)          one equation, linear in δ, for every γ ≥ 0
//! P = 2(δs − ∫₀ˢ g),      U = δ²s − 2δ∫g + ∫g² − πγs²
//! ```

use super::basis::{Basis, Evaluation, Order};
use super::outside;
use super::panels::{Panels, TransformValues};
use super::solution::{ExactSolution, Solution};
use super::span::Place;
use super::spans::TableError;
use super::table::Table;
use crate::elementary::sin;
use crate::problem::Reduced;
use crate::progress::{Progress, Stopped, Unwatched};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

/// Rounding of the edge functional relative to the sizes in it, over Newton's tolerance of 1e-10: 1e-13 leaves room for
/// the rounding of the phase of a few hundred waves.
const EDGE_ROUNDING: f64 = 1e-3;

/// Points per wave in a picture of the pressure, enough that its crests look round on paper, and the fewest and the
/// most points.
const PICTURE_POINTS_PER_WAVE: f64 = 48.0;
const PICTURE_POINTS: [f64; 2] = [80.0, 2000.0];

/// Fewer digits than this cause a warning.
pub const DIGITS_WANTED: f64 = 11.0;

/// Beyond this many radii of a disc the gap around it follows from the pressure inside, and needs no table out there.
pub const FAR: f64 = 2.0;

/// The exact basis of one gap.
#[derive(Debug, Clone)]
pub struct ExactBasis {
    table: Arc<Table>,
    /// Smaller discs are read from panels up to here.
    reach: f64,
}

impl ExactBasis {
    /// The exact basis of the gap of `table`; discs of a radius below `reach` are read from the same panels.
    pub fn new(table: Arc<Table>, reach: f64) -> Self {
        Self { table, reach }
    }

    /// The exact basis of the gap of `problem`, tabulated up to the radius `reach` to begin with.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn of(problem: &Reduced, reach: f64) -> Result<Self, TableError> {
        Ok(Self::new(Arc::new(Table::new(Arc::clone(&problem.gap), reach, &Unwatched)?), reach))
    }

    /// The table.
    pub fn table(&self) -> &Arc<Table> {
        &self.table
    }

    /// The panels that hold the radius `s`; `None` where the gap is not known.
    fn panels(&self, s: f64) -> Option<Arc<Panels>> {
        let panels = self.table.up_to(s.max(self.reach)).ok()?;
        (s > 0.0 && s <= panels.reach()).then_some(panels)
    }
}

/// Residual, force and energy at (s, δ) from the transform there.
fn evaluated(values: &TransformValues, delta: f64, gamma: f64) -> Evaluation {
    let TransformValues { radius: s, value, slope, bend, area, square } = *values;
    let q = value - delta;
    let unit = (TAU * s).sqrt().recip();
    let rounding = EDGE_ROUNDING * (value.abs() + delta.abs()) * unit;
    Evaluation {
        contact_radius: s,
        approach: delta,
        residual: q * unit - gamma.sqrt(),
        residual_scale: gamma.sqrt().max(rounding).max(f64::MIN_POSITIVE),
        residual_gradient: [-unit, (slope - q / (2.0 * s)) * unit],
        residual_second: [0.0, unit / (2.0 * s), (bend - slope / s + 0.75 * q / (s * s)) * unit],
        force: 2.0 * (delta * s - area),
        force_scale: 2.0 * (s * delta.abs() + area.abs()),
        force_gradient: [2.0 * s, -2.0 * q],
        force_second: [0.0, 2.0, -2.0 * slope],
        energy: delta * delta * s - 2.0 * delta * area + square - PI * gamma * s * s,
    }
}

/// The equilibrium at s, from g, ∫g and √(2πγs), as far as [`Order::State`] asks for it.
fn state(s: f64, value: f64, area: f64, root: f64) -> Evaluation {
    let delta = value - root;
    Evaluation {
        contact_radius: s,
        approach: delta,
        residual: 0.0,
        residual_scale: f64::NAN,
        residual_gradient: [f64::NAN; 2],
        residual_second: [f64::NAN; 3],
        force: 2.0 * (delta * s - area),
        force_scale: 2.0 * (s * delta.abs() + area.abs()),
        force_gradient: [2.0 * s, -2.0 * root],
        force_second: [0.0, 2.0, f64::NAN],
        energy: f64::NAN,
    }
}

/// An empty evaluation: beyond the known part of the gap.
fn nothing(s: f64, delta: f64) -> Evaluation {
    let values = TransformValues {
        radius: s,
        value: f64::NAN,
        slope: f64::NAN,
        bend: f64::NAN,
        area: f64::NAN,
        square: f64::NAN,
    };
    evaluated(&values, delta, 0.0)
}

impl Basis for ExactBasis {
    fn evaluate(&self, problem: &Reduced, s: f64, delta: f64) -> Evaluation {
        let Some(panels) = self.panels(s) else { return nothing(s, delta) };
        evaluated(&panels.values(panels.place(s)), delta, problem.work_of_adhesion)
    }

    fn equilibrium(&self, problem: &Reduced, s: f64) -> Option<Evaluation> {
        let panels = self.panels(s)?;
        let values = panels.values(panels.place(s));
        let gamma = problem.work_of_adhesion;
        let delta = values.value - (TAU * gamma * s).sqrt();
        delta.is_finite().then(|| evaluated(&values, delta, gamma))
    }

    fn equilibria(
        &self,
        problem: &Reduced,
        radii: &[f64],
        order: Order,
        progress: &dyn Progress,
    ) -> Vec<Evaluation> {
        let mut found = Vec::with_capacity(radii.len());
        let farthest = radii.iter().fold(0.0_f64, |most, s| most.max(*s));
        let Ok(panels) = self.table.up_to(farthest.max(self.reach)) else { return found };
        let gamma = problem.work_of_adhesion;
        let known = |s: f64| s > 0.0 && s <= panels.reach();
        let mut rest = radii;
        let mut place = Place { panel: 0, x: 0.0 };
        let on = |panel: usize, s: f64| {
            let span = &panels.list()[panel].span;
            s > span.lo && s <= span.hi
        };
        while let Some((&s, others)) = rest.split_first() {
            if !known(s) || progress.stop() {
                break;
            }
            if !on(place.panel, s) {
                place = panels.place(s);
            }
            let eight = rest
                .first_chunk::<8>()
                .filter(|eight| order == Order::State && eight.iter().all(|s| on(place.panel, *s)));
            if let Some(eight) = eight {
                let [values, areas] = panels.eight(place.panel, eight);
                let roots = eight.map(|s| (TAU * gamma * s).sqrt());
                for i in 0..8 {
                    found.push(state(eight[i], values[i], areas[i], roots[i]));
                }
                rest = &rest[8..];
                continue;
            }
            place = panels.place(s);
            let values = panels.values(place);
            found.push(evaluated(&values, values.value - (TAU * gamma * s).sqrt(), gamma));
            rest = others;
        }
        found
    }

    fn solution(
        &self,
        problem: &Reduced,
        _from: f64,
        to: f64,
        progress: &dyn Progress,
    ) -> Result<Option<Arc<dyn Solution>>, Stopped> {
        match ExactSolution::refined(&self.table, to.max(self.reach), problem.work_of_adhesion, progress) {
            Err(TableError::Stopped(stopped)) => Err(stopped),
            // A gap without a table has no equilibria.
            Err(_) => Ok(None),
            Ok(found) => Ok((!found.is_empty()).then(|| Arc::new(found) as Arc<dyn Solution>)),
        }
    }

    fn pressure(&self, problem: &Reduced, s: f64, delta: f64) -> Vec<(f64, f64)> {
        let Some(panels) = self.panels(s) else { return Vec::new() };
        let waves = problem.gap.feature_length().map_or(0.0, |wave| s / wave);
        let [least, most] = PICTURE_POINTS;
        let points = (PICTURE_POINTS_PER_WAVE * waves).clamp(least, most).ceil();
        // r = s sin θ: evenly spaced near the axis and, as √(s² − r²) = s cos θ, near the edge too; the edge itself is
        // left out.
        let angles = std::iter::successors(Some(0.0), |j| Some(j + 1.0)).take_while(|j| *j < points);
        let radii = angles.map(|j| s * sin(FRAC_PI_2 * j / points));
        radii.map(|r| (r, outside::pressure(&panels, s, delta, r))).collect()
    }

    fn gap_outside(&self, problem: &Reduced, s: f64, delta: f64, radii: &[f64]) -> Vec<f64> {
        let near = FAR * s;
        let farthest = radii.iter().fold(s, |most, r| most.max(r.min(near)));
        // Where the table ends before that, radii beyond its end are computed as far ones.
        let panels = self.table.up_to(farthest.max(self.reach)).ok().or_else(|| self.panels(s));
        let Some(panels) = panels.filter(|panels| s <= panels.reach()) else {
            return vec![f64::NAN; radii.len()];
        };
        let end = self.table.end();
        let gap = |r: f64| {
            if r <= near.min(panels.reach()) {
                // What is needed of δ is δ − g(s), of which the edge is made.
                outside::gap_from(&panels, s, delta, r)
            } else if r <= end {
                outside::gap_far(&panels, problem.gap.jet(r).value, s, delta, r)
            } else {
                f64::NAN
            }
        };
        radii.iter().map(|r| gap(*r)).collect()
    }

    fn size(&self) -> usize {
        0
    }

    fn trusted_digits(&self, _problem: &Reduced, _s: f64) -> f64 {
        self.table.up_to(self.reach).map_or(0.0, |panels| self.table.digits(&panels))
    }

    fn cautions(&self, problem: &Reduced, s: f64) -> Vec<String> {
        let mut cautions = Vec::new();
        let digits = self.trusted_digits(problem, s);
        if digits < DIGITS_WANTED {
            cautions.push(format!(
                "the gap is tabulated to only {:.1} digits: at a few radii the table does not reproduce the \
                 gap itself",
                digits.max(0.0)
            ));
        }
        cautions
    }
}

/// The place of the outer side of the radius `s` where it is the border of two panels of `solution`.
pub fn outer_side(solution: &dyn Solution, place: Place) -> Place {
    if place.x >= 1.0 && solution.is_joined(place.panel) {
        Place { panel: place.panel + 1, x: -1.0 }
    } else {
        place
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gap::Shape;
    use crate::gap::shapes::PowerLaw;
    use crate::problem::{Control, Problem};
    use crate::ritz::fixtures::{check_derivatives, check_units, wavy};

    fn sphere(gamma: f64) -> Reduced {
        let shape = Shape::Sphere { radius_of_curvature: 1.0 };
        Problem { effective_modulus: 1.0, work_of_adhesion: gamma, shape }.reduced()
    }

    #[test]
    fn smooth_spheres_are_exact() {
        for gamma in [0.0, 1e-12, 1e-6, 0.01] {
            let problem = sphere(gamma);
            let basis = ExactBasis::of(&problem, 0.7).unwrap();
            for s in [1e-3_f64, 0.1, 0.7] {
                let at = basis.equilibrium(&problem, s).unwrap();
                let adhesion = (TAU * gamma * s).sqrt();
                let (delta, force) = (s * s - adhesion, 4.0 / 3.0 * s.powi(3) - 2.0 * s * adhesion);
                assert!((at.approach - delta).abs() <= 1e-14 * s * s, "γ={gamma} s={s}");
                assert!((at.force - force).abs() <= 1e-14 * (s.powi(3) + s * adhesion), "γ={gamma} s={s}");
                // Hertz's 8s⁵/15 less what the adhesion takes back, U = ∫₀^s (δ − a²)² da − πγs².
                let energy = s * delta * delta - 2.0 / 3.0 * delta * s.powi(3) + s.powi(5) / 5.0;
                let energy = energy - PI * gamma * s * s;
                assert!((at.energy - energy).abs() <= 1e-14 * (s.powi(5) + gamma * s * s), "γ={gamma} s={s}");
                // Hertz: p = (2/π)√(s² − r²); adhesion adds −√(2πγs)/(π√(s² − r²)).
                for (r, p) in basis.pressure(&problem, s, at.approach) {
                    let t = ((s - r) * (s + r)).sqrt();
                    let exact = 2.0 / PI * t - adhesion / (PI * t);
                    assert!((p - exact).abs() <= 1e-12 * (s + adhesion / t), "γ={gamma} s={s} r={r}");
                }
            }
        }
    }

    #[test]
    fn derivatives_agree_with_central_differences() {
        for gamma in [0.004, 0.0] {
            let problem = wavy(gamma);
            let basis = ExactBasis::of(&problem, 0.5).unwrap();
            for i in 0..40 {
                // Off the curve on both sides: the residual is signed.
                let s = 0.05 + 0.011 * f64::from(i);
                let delta = basis.equilibrium(&problem, s).unwrap().approach + 0.003 * f64::from(i % 5 - 2);
                let (here, by_radius) = check_derivatives(&basis, &problem, s, delta);
                // G follows from the residual, and ∂U/∂s = 2πs(G − γ).
                let root = here.residual + gamma.sqrt();
                assert!((by_radius - TAU * s * (root * root - gamma)).abs() < 1e-7, "γ={gamma} s={s}");
            }
        }
    }

    #[test]
    fn slopes_and_tendencies_are_those_of_the_evaluation() {
        let problem = wavy(0.004);
        let basis = ExactBasis::of(&problem, 0.5).unwrap();
        let solution = basis.solution(&problem, 0.01, 0.5, &Unwatched).unwrap().unwrap();
        for i in 1..100 {
            let s = 0.005 * f64::from(i);
            let place = solution.place(s).unwrap();
            let (at, exact) = (solution.at(place), basis.equilibrium(&problem, s).unwrap());
            let [approach, force] = exact.slopes();
            for (ours, exact, size) in [
                (at.approach, exact.approach, 0.01_f64),
                (at.force, exact.force, 0.01),
                (at.slopes[0] / at.stretch, approach, 1.0),
                (at.slopes[1] / at.stretch, force, 1.0),
                (solution.energy(place), exact.energy, 1e-3),
            ] {
                assert!((ours - exact).abs() <= 1e-13 * size.max(exact.abs()), "{s}: {ours} {exact}");
            }
            for control in [Control::Displacement, Control::Force, Control::Stiffness(0.15)] {
                let slope = control.value(approach, force);
                let (series, size) = solution.tendency(place.panel, control);
                let sign = crate::disc::chebyshev::sum(&series, place.x);
                assert!((sign > 0.0) == (slope > 0.0) || sign.abs() < 1e-12 * size, "{s} {control}");
            }
        }
    }

    #[test]
    fn reduced_answers_do_not_depend_on_the_units() {
        check_units(&|problem| Arc::new(ExactBasis::of(problem, 0.5).unwrap()));
    }

    #[test]
    fn the_gap_far_out_is_that_of_the_table_and_needs_none() {
        let shapes = [
            Shape::Sphere { radius_of_curvature: 1.0 },
            Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 },
            Shape::PowerLaw(PowerLaw { factor: 0.5, exponent: 6.0 }),
        ];
        for shape in shapes {
            let problem =
                Problem { effective_modulus: 1.0, work_of_adhesion: 0.004, shape: shape.clone() }.reduced();
            let (basis, s) = (ExactBasis::of(&problem, 0.3).unwrap(), 0.2);
            let delta = basis.equilibrium(&problem, s).unwrap().approach;
            let radii: Vec<f64> = (0..200).map(|i| s * (1.0 + 0.05 * f64::from(i))).collect();
            let ours = basis.gap_outside(&problem, s, delta, &radii);
            let panels = basis.table().up_to(11.0 * s).unwrap();
            for (r, ours) in radii.iter().zip(&ours) {
                let exact = outside::gap_from(&panels, s, delta, *r);
                let size = problem.gap.jet(*r).value + delta.abs();
                assert!((ours - exact).abs() <= 1e-12 * size, "{shape:?} {r}: {ours} {exact}");
            }
            // A radius that no table reaches does not affect the others.
            let with_far = basis.gap_outside(&problem, s, delta, &[radii.clone(), vec![1e9]].concat());
            assert_eq!(with_far[..200], ours, "{shape:?}");
            let (far, undeformed) = (with_far[200], problem.gap.jet(1e9).value);
            assert!((far / undeformed - 1.0).abs() < 1e-12, "{shape:?}: {far} {undeformed}");
        }
    }

    #[test]
    fn the_smallest_disc_is_unstable_however_weak_the_adhesion() {
        // Down to where a table made for the start would have no digits left.
        for gamma in [1e-9, 1e-20, 1e-60] {
            let problem = sphere(gamma);
            let basis = ExactBasis::of(&problem, 0.5).unwrap();
            let solution = basis.solution(&problem, 0.1, 0.5, &Unwatched).unwrap().unwrap();
            let limits = crate::quasistatic::Monotone::of(&*solution, Control::Force).limits;
            let exact = (1.125 * PI * gamma).cbrt();
            assert_eq!(limits.len(), 1, "{gamma}");
            assert!((limits[0].contact_radius / exact - 1.0).abs() < 1e-12, "{gamma}: {limits:?} {exact}");
        }
    }
}
