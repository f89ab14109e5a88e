//! Every limit point of sixty random wavy spheres is found by the arc-length trace.
//!
//! The truth is the explicit curve δ(s), P(s) of the same discretization: sign changes of its exact slopes on
//! a grid of a hundredth of a wave. In the exact basis that is the exact solution.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff_engine::continuation::Tracer;
use pulloff_engine::disc::{Basis, ExactBasis};
use pulloff_engine::gap::Shape;
use pulloff_engine::problem::{Control, Problem, Reduced};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::curve::settings;
use pulloff_engine::quasistatic::{Curve, CurveStop, Equilibrium, StatePoint};
use pulloff_engine::ritz::Rings;
use std::sync::Arc;

const FROM: f64 = 1.0;
const TO: f64 = 0.03;

/// A wavy sphere with E* = R = 1 and its wavelength.
fn draw(random: &mut fastrand::Rng) -> (Reduced, f64) {
    let between = |random: &mut fastrand::Rng, lo: f64, hi: f64| lo + (hi - lo) * random.f64();
    let gamma = 10f64.powf(between(random, -3.5, -2.5));
    let amplitude = between(random, 0.002, 0.006);
    let wavelength = between(random, 0.1, 0.25);
    let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude, wavelength };
    (Problem { effective_modulus: 1.0, work_of_adhesion: gamma, shape }.reduced(), wavelength)
}

/// The intervals of s in which a slope of the explicit curve changes its sign: of δ, of P.
fn sign_changes(problem: &Reduced, basis: &Arc<dyn Basis>, wavelength: f64) -> [Vec<(f64, f64)>; 2] {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let steps = ((FROM - TO) / (wavelength / 100.0)).ceil() as usize;
    let mut found = [Vec::new(), Vec::new()];
    let mut last: Option<(f64, [f64; 2])> = None;
    for i in 0..=steps {
        let s = FROM + (TO - FROM) * i as f64 / steps as f64;
        let slopes = basis.equilibrium(problem, s).unwrap().slopes();
        if let Some((before, old)) = last {
            for (found, (a, b)) in found.iter_mut().zip(old.into_iter().zip(slopes)) {
                if (a > 0.0) != (b > 0.0) {
                    found.push((s, before));
                }
            }
        }
        last = Some((s, slopes));
    }
    found
}

/// The radii of the limit points of `control` on an arc-length trace, by the tracer's own search and location.
fn located(equilibrium: &Equilibrium, points: &[StatePoint], control: Control) -> Vec<f64> {
    let (settings, row) = (settings(equilibrium), equilibrium.control_row(control));
    let mut tracer = Tracer::new(equilibrium, settings);
    let brackets = tracer.brackets(points, &row).unwrap();
    let found = brackets.iter().map(|bracket| tracer.limit_point(bracket, &row.normalize()).unwrap());
    found.map(|limit| equilibrium.contact_radius(&limit.point)).collect()
}

#[test]
fn the_trace_finds_every_limit_point_of_sixty_random_wavy_spheres_in_rings() {
    every_limit_point_is_found("400 rings", |_| Rings::shared(400).unwrap());
}

#[test]
fn the_trace_finds_every_limit_point_of_sixty_random_wavy_spheres_in_the_exact_basis() {
    every_limit_point_is_found("exact basis", |problem| Arc::new(ExactBasis::of(problem, FROM).unwrap()));
}

fn every_limit_point_is_found(name: &str, basis: impl Fn(&Reduced) -> Arc<dyn Basis>) {
    let mut random = fastrand::Rng::with_seed(20_260_611);
    let (mut points, mut evaluations, mut rejections, mut total) = (Vec::new(), 0, 0, 0);
    for problem_number in 0..60 {
        let (problem, wavelength) = draw(&mut random);
        let basis = basis(&problem);
        let truth = sign_changes(&problem, &basis, wavelength);
        let curve = Curve::of(problem, basis, FROM, TO).unwrap();
        let (branch, stop) = curve.traced(|_| {}, &Unwatched).unwrap();
        assert_eq!(stop, CurveStop::End, "{problem_number}");
        for (control, truth) in [Control::Displacement, Control::Force].into_iter().zip(truth) {
            let by_trace = located(&curve.equilibrium, &branch.points, control);
            let by_panels: Vec<f64> =
                curve.limit_points(control).iter().map(|limit| limit.contact_radius).collect();
            for (lo, hi) in &truth {
                let inside = by_trace.iter().any(|s| lo <= s && s <= hi);
                assert!(
                    inside,
                    "problem {problem_number}, {control}: none between {lo} and {hi}: {by_trace:?}"
                );
            }
            // From the panels, without a trace: the same limit points, to rounding.
            assert_eq!(by_trace.len(), by_panels.len(), "problem {problem_number}, {control}");
            for (a, b) in by_trace.iter().zip(&by_panels) {
                assert!((a / b - 1.0).abs() < 1e-8, "problem {problem_number}, {control}: {a} {b}");
            }
            total += by_trace.len();
        }
        points.push(branch.points.len());
        evaluations += branch.work.evaluations;
        rejections += branch.work.rejections;
    }
    points.sort_unstable();
    let median = points[30];
    println!(
        "{name}: median {median} points (from {} to {}), {} evaluations and {} rejections a trace, {total} limit points",
        points[0],
        points[59],
        evaluations / 60,
        rejections / 60,
    );
    assert!(median < 100, "median of {median} points");
}
