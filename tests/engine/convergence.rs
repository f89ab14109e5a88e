//! Observed orders of convergence against Hertz and JKR, and Newton iterations from three times the true radius.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use pulloff_engine::disc::{Basis, ExactBasis};
use pulloff_engine::gap::Shape;
use pulloff_engine::problem::{Control, Problem, Reduced};
use pulloff_engine::ritz::{Grading, NewtonSettings, Rings, SolvedState, solve};
use pulloff_engine::theory;
use pulloff_engine::theory::hertz;
use pulloff_engine::theory::jkr::Jkr;

/// The smooth sphere E* = R = 1.
fn sphere(gamma: f64) -> Reduced {
    let shape = Shape::Sphere { radius_of_curvature: 1.0 };
    Problem { effective_modulus: 1.0, work_of_adhesion: gamma, shape }.reduced()
}

/// s of JKR at the approach `delta`, on the stable branch.
fn jkr_radius(jkr: &Jkr, delta: f64) -> f64 {
    let (mut lo, mut hi) = (jkr.fixed_grips_radius(), 10.0);
    for _ in 0..200 {
        let s = 0.5 * (lo + hi);
        if jkr.approach(s) > delta { hi = s } else { lo = s }
    }
    lo
}

/// Newton in uniform rings from three times the true radius.
fn from_threefold(gamma: f64, rings: usize, control: Control, value: f64, exact: f64) -> SolvedState {
    with_grading(Grading::Uniform, gamma, rings, control, value, exact)
}

/// Newton from three times the true radius.
fn with_grading(
    grading: Grading,
    gamma: f64,
    rings: usize,
    control: Control,
    value: f64,
    exact: f64,
) -> SolvedState {
    let basis = Rings::shared_with(rings, grading, &pulloff_engine::progress::Unwatched).unwrap();
    solve(basis.as_ref(), &sphere(gamma), control, value, 3.0 * exact, NewtonSettings::default())
        .unwrap_or_else(|failure| panic!("γ={gamma} {control}={value}: {failure}"))
}

fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|pair| (pair[0] / pair[1]).abs().log2()).collect()
}

#[test]
fn jkr_converges_linearly_in_force_and_radius() {
    let (delta, gamma) = (0.1, 0.01);
    let jkr = Jkr { effective_modulus: 1.0, work_of_adhesion: gamma, radius_of_curvature: 1.0 };
    let exact = jkr_radius(&jkr, delta);
    let (mut radius, mut force) = (Vec::new(), Vec::new());
    for rings in [80, 160, 320, 640, 1280] {
        let found = from_threefold(gamma, rings, Control::Displacement, delta, exact).evaluation;
        radius.push(found.contact_radius / exact - 1.0);
        force.push(found.force / jkr.force(exact) - 1.0);
    }
    for order in orders(&radius).into_iter().chain(orders(&force)) {
        assert!((0.9..=1.1).contains(&order), "orders {:?} {:?}", orders(&radius), orders(&force));
    }
    // The constants documented for the rings.
    assert!((radius[1].abs() * 160.0 - 0.16).abs() < 0.02, "{radius:?}");
    assert!((force[1].abs() * 160.0 - 1.4).abs() < 0.1, "{force:?}");
}

#[test]
fn rings_crowded_towards_the_edge_converge_quadratically_to_jkr() {
    let delta = 0.1;
    for gamma in [1e-4, 0.01, 0.1] {
        let jkr = Jkr { effective_modulus: 1.0, work_of_adhesion: gamma, radius_of_curvature: 1.0 };
        let exact = jkr_radius(&jkr, delta);
        let (mut radius, mut force) = (Vec::new(), Vec::new());
        for rings in [50, 100, 200, 400] {
            let found =
                with_grading(Grading::Edge, gamma, rings, Control::Displacement, delta, exact).evaluation;
            radius.push(found.contact_radius / exact - 1.0);
            force.push(found.force / jkr.force(exact) - 1.0);
        }
        println!("γ={gamma}: {radius:?} {:?}, {force:?} {:?}", orders(&radius), orders(&force));
        for order in orders(&radius).into_iter().chain(orders(&force)) {
            assert!((1.8..=2.2).contains(&order), "γ={gamma}: {radius:?} {force:?}");
        }
        // The constants documented for the rings, at γ = 0.01.
        if (gamma - 0.01).abs() < 1e-9 {
            assert!((radius[2].abs() * 4e4 / 0.34 - 1.0).abs() < 0.1, "{radius:?}");
            assert!((force[2].abs() * 4e4 / 9.4 - 1.0).abs() < 0.1, "{force:?}");
        }
    }
}

#[test]
fn rings_crowded_towards_the_edge_without_adhesion_and_with_little() {
    let delta = 0.1;
    let exact = hertz::contact_radius(1.0, delta);
    for rings in [25, 50, 100, 200, 400] {
        let found = with_grading(Grading::Edge, 0.0, rings, Control::Displacement, delta, exact).evaluation;
        let (radius, force) =
            (found.contact_radius / exact - 1.0, found.force / hertz::force(1.0, 1.0, delta) - 1.0);
        println!("Hertz {rings}: {radius:.2e} {force:.2e}");
        assert!(radius.abs() < 0.4 / rings as f64 && force.abs() < 0.35 / (rings * rings) as f64);
    }
    // At the weakest adhesion that passes without a caution, its part of the approach still shows.
    let (gamma, s) = (1e-6, 0.3);
    let jkr = Jkr { effective_modulus: 1.0, work_of_adhesion: gamma, radius_of_curvature: 1.0 };
    let [uniform, edge] = Grading::ALL.map(|grading| {
        let basis = Rings::shared_with(200, grading, &pulloff_engine::progress::Unwatched).unwrap();
        let adhesion = basis.equilibrium(&sphere(gamma), s).unwrap().approach - s * s;
        (adhesion / (jkr.approach(s) - s * s) - 1.0).abs()
    });
    println!("γ={gamma}: {uniform:.1e}, {edge:.1e} of the adhesion's part");
    assert!(edge < 0.04 && edge < uniform && uniform < 0.15);
}

#[test]
fn hertz_force_converges_quadratically() {
    let delta = 0.1;
    let exact = hertz::contact_radius(1.0, delta);
    let mut errors = Vec::new();
    for rings in [20, 40, 80, 160, 320] {
        let found = from_threefold(0.0, rings, Control::Displacement, delta, exact).evaluation;
        errors.push(found.force / hertz::force(1.0, 1.0, delta) - 1.0);
        assert!((found.contact_radius / exact - 1.0).abs() < 0.6 / rings as f64);
    }
    assert!((errors[0].abs() / 5.9e-4 - 1.0).abs() < 0.05, "{errors:?}");
    for order in orders(&errors) {
        assert!((1.8..=2.2).contains(&order), "{:?}", orders(&errors));
    }
}

#[test]
fn newton_needs_at_most_six_rounds_from_a_threefold_radius_at_given_approach() {
    for gamma in [1e-5, 1e-4, 1e-3, 0.01, 0.1] {
        let jkr = Jkr { effective_modulus: 1.0, work_of_adhesion: gamma, radius_of_curvature: 1.0 };
        let smallest = jkr.approach(jkr.fixed_grips_radius());
        for delta in [0.9 * smallest, 0.5 * smallest, 0.0, 0.01, 0.1, 0.5] {
            let exact = jkr_radius(&jkr, delta);
            let found = from_threefold(gamma, 200, Control::Displacement, delta, exact);
            let s = found.evaluation.contact_radius;
            assert!((s / exact - 1.0).abs() < 0.02, "γ={gamma} δ={delta}: {s} {exact}");
            println!("γ={gamma} δ={delta}: {}", found.rounds);
            assert!(found.rounds <= 6, "γ={gamma} δ={delta}: {} rounds", found.rounds);
        }
    }
}

#[test]
fn newton_at_given_force_from_a_threefold_radius() {
    for gamma in [1e-4, 1e-3, 0.01, 0.1] {
        let jkr = Jkr { effective_modulus: 1.0, work_of_adhesion: gamma, radius_of_curvature: 1.0 };
        for share in [-0.9, -0.5, 0.0, 1.0, 10.0] {
            let force = share * jkr.pull_off_force();
            let (mut lo, mut hi) = (jkr.pull_off_radius(), 10.0);
            for _ in 0..200 {
                let s = 0.5 * (lo + hi);
                if jkr.force(s) > force { hi = s } else { lo = s }
            }
            let found = from_threefold(gamma, 200, Control::Force, force, lo);
            let s = found.evaluation.contact_radius;
            assert!((s / lo - 1.0).abs() < 0.03, "γ={gamma} P={share}P_c: {s} {lo}");
            println!("γ={gamma} P={share}P_c: {}", found.rounds);
            assert!(found.rounds <= 7, "γ={gamma} P={share}P_c: {} rounds", found.rounds);
        }
    }
}

/// Newton in the exact basis from three times the true radius.
fn exactly_from_threefold(gamma: f64, control: Control, value: f64, exact: f64) -> SolvedState {
    let (problem, settings) = (sphere(gamma), NewtonSettings::default());
    let basis = ExactBasis::of(&problem, 1.0).unwrap();
    solve(&basis, &problem, control, value, 3.0 * exact, settings)
        .unwrap_or_else(|failure| panic!("γ={gamma} {control}={value}: {failure}"))
}

#[test]
fn the_exact_basis_needs_at_most_six_rounds_to_jkr_at_given_approach() {
    for gamma in [1e-12, 1e-8, 1e-5, 1e-4, 1e-3, 0.01, 0.1] {
        let jkr = Jkr { effective_modulus: 1.0, work_of_adhesion: gamma, radius_of_curvature: 1.0 };
        let smallest = jkr.approach(jkr.fixed_grips_radius());
        for delta in [0.9 * smallest, 0.5 * smallest, 0.0, 0.01, 0.1, 0.5] {
            let exact = jkr_radius(&jkr, delta);
            let found = exactly_from_threefold(gamma, Control::Displacement, delta, exact);
            let s = found.evaluation.contact_radius;
            println!("γ={gamma} δ={delta}: {} rounds, {:.1e}", found.rounds, s / exact - 1.0);
            assert!((s / exact - 1.0).abs() < 1e-9, "γ={gamma} δ={delta}: {s} {exact}");
            assert!(found.rounds <= 6, "γ={gamma} δ={delta}: {} rounds", found.rounds);
        }
    }
}

#[test]
fn the_exact_basis_reaches_hertz_to_rounding() {
    for delta in [1e-4, 0.1, 0.5] {
        let (radius, force) = (hertz::contact_radius(1.0, delta), hertz::force(1.0, 1.0, delta));
        for (control, value) in [(Control::Displacement, delta), (Control::Force, force)] {
            let found = exactly_from_threefold(0.0, control, value, radius);
            println!("{control} {value}: {} rounds", found.rounds);
            assert!((found.evaluation.contact_radius / radius - 1.0).abs() < 1e-12, "{control}");
            assert!((found.evaluation.force / force - 1.0).abs() < 1e-12, "{control}");
            assert!((found.evaluation.approach / delta - 1.0).abs() < 1e-12, "{control}");
            assert!(found.rounds <= 7, "{control}: {} rounds", found.rounds);
        }
    }
}

#[test]
fn hundreds_of_waves_are_resolved_to_rounding() {
    for (wavelength, s) in [(0.05, 0.1), (0.05, 5.0), (0.001, 0.5)] {
        let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.05 * wavelength, wavelength };
        let problem = Problem { effective_modulus: 1.0, work_of_adhesion: 1e-3, shape };
        let exact = theory::Exact::of(&problem);
        let reduced = problem.reduced();
        let ours = ExactBasis::of(&reduced, s).unwrap().equilibrium(&reduced, s).unwrap();
        let truth = exact.curve(&[s])[0];
        let slopes = exact.slopes(s);
        let errors = [
            (ours.approach, truth.approach),
            (ours.force, truth.force),
            (ours.energy, truth.energy),
            (ours.slopes()[0], slopes.0),
            (ours.slopes()[1], slopes.1),
        ]
        .map(|(ours, exact)| (ours / exact - 1.0).abs());
        println!("{} waves: {errors:?}", s / wavelength);
        assert!(errors.iter().all(|e| *e < 1e-10), "{errors:?}");
    }
}
