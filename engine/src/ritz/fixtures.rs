//! What the tests of every basis share.

use crate::disc::{Basis, Evaluation};
use crate::gap::Shape;
use crate::problem::{Problem, Reduced};
use std::sync::Arc;

/// The wavy sphere of the paper's Fig. 9 with another work of adhesion.
pub fn wavy(gamma: f64) -> Reduced {
    scaled(gamma, 1.0, 1.0).reduced()
}

/// The same in units of this modulus and length.
fn scaled(gamma: f64, modulus: f64, length: f64) -> Problem {
    Problem {
        effective_modulus: modulus,
        work_of_adhesion: gamma * modulus * length,
        shape: Shape::WavySphere {
            radius_of_curvature: length,
            amplitude: 0.0025 * length,
            wavelength: 0.05 * length,
        },
    }
}

/// Holds what a basis answers to the same problem in other units.
pub fn check_units(basis: &dyn Fn(&Reduced) -> Arc<dyn Basis>) {
    let answer = |problem: &Reduced| basis(problem).equilibrium(problem, 0.3).unwrap();
    let reference = answer(&wavy(0.004));
    for (modulus, length) in [(2.5e6, 1e-9), (7e10, 3.0)] {
        let ours = answer(&scaled(0.004, modulus, length).reduced());
        assert!((ours.approach / reference.approach - 1.0).abs() < 1e-12);
        assert!((ours.force / reference.force - 1.0).abs() < 1e-12);
    }
}

/// Holds every derivative a basis gives at (s, δ) against central differences, P against ∂U/∂δ among them, and
/// returns its answer there with ∂U/∂s by differences.
pub fn check_derivatives(basis: &dyn Basis, problem: &Reduced, s: f64, delta: f64) -> (Evaluation, f64) {
    let at = |s: f64, d: f64| basis.evaluate(problem, s, d);
    let here = at(s, delta);
    let (es, ed) = (1e-6 * s, 1e-6);
    let (s0, s1, d0, d1) = (at(s - es, delta), at(s + es, delta), at(s, delta - ed), at(s, delta + ed));
    let by_s = |f: &dyn Fn(&Evaluation) -> f64| (f(&s1) - f(&s0)) / (2.0 * es);
    let by_d = |f: &dyn Fn(&Evaluation) -> f64| (f(&d1) - f(&d0)) / (2.0 * ed);
    let energy = |s: f64, d: f64| basis.evaluate(problem, s, d).energy;
    let energy_by_approach = (energy(s, delta + ed) - energy(s, delta - ed)) / (2.0 * ed);
    let pairs = [
        (by_d(&|e| e.residual), here.residual_gradient[0]),
        (by_s(&|e| e.residual), here.residual_gradient[1]),
        (by_d(&|e| e.residual_gradient[0]), here.residual_second[0]),
        (by_s(&|e| e.residual_gradient[0]), here.residual_second[1]),
        (by_d(&|e| e.residual_gradient[1]), here.residual_second[1]),
        (by_s(&|e| e.residual_gradient[1]), here.residual_second[2]),
        (by_d(&|e| e.force), here.force_gradient[0]),
        (by_s(&|e| e.force), here.force_gradient[1]),
        (by_d(&|e| e.force_gradient[0]), here.force_second[0]),
        (by_s(&|e| e.force_gradient[0]), here.force_second[1]),
        (by_s(&|e| e.force_gradient[1]), here.force_second[2]),
    ];
    for (n, (difference, exact)) in pairs.into_iter().enumerate() {
        let size = exact.abs().max(here.residual_second[2].abs() * 1e-3).max(1e-3);
        assert!((difference - exact).abs() < 2e-5 * size, "s={s} δ={delta} #{n}: {difference} {exact}");
    }
    let energy_error = (energy_by_approach - here.force).abs();
    assert!(energy_error < 1e-8_f64.max(2e-5 * here.force.abs()), "s={s} δ={delta}: {energy_error}");
    (here, (energy(s + es, delta) - energy(s - es, delta)) / (2.0 * es))
}
