//! What the engine costs, over a fixed table of ring numbers and with eigenfunctions.
//!
//! `cargo bench --no-default-features`; the numbers are for comparing two versions on one machine.

#![allow(clippy::unwrap_used, reason = "a bench that cannot be set up must stop")]

use divan::{Bencher, black_box};
use pulloff::case::Case;
use pulloff::contact::Control;
use pulloff::preset::{BasisSpec, Functions, Store};
use pulloff::ritz::moments::EdgeRules;
use pulloff::ritz::{Evaluation, Grading, Order, Rings};

/// The ring numbers.
const SIZES: [usize; 3] = [50, 200, 800];
/// Those whose construction is timed: up to the most allowed.
const BUILT: [usize; 5] = [50, 200, 800, 1000, 2000];
/// The arc-length trace at the largest takes too long to repeat.
const TRACED: [usize; 2] = [50, 200];

fn main() {
    divan::main();
}

/// Fig. 9 with this number of rings.
fn fig_9(rings: usize) -> Case {
    fig_9_in(BasisSpec::Rings { rings, grading: Grading::Uniform })
}

/// Fig. 9 with enough eigenfunctions.
fn fig_9_spectral() -> Case {
    fig_9_in(BasisSpec::Spectral { functions: Functions::Auto })
}

fn fig_9_in(basis: BasisSpec) -> Case {
    // A folder that need not exist: the preset is a shipped one.
    let store = Store::at("presets", &[]);
    let mut preset = store.load(&store.resolve("fig-9").unwrap(), &[] as &[&str]).unwrap().preset;
    preset.basis = basis;
    Case::new(&preset).unwrap()
}

/// B̃, W̃ and the factorization.
#[divan::bench(args = BUILT, max_time = 5)]
fn assembly_and_factorization(rings: usize) -> Rings {
    Rings::new(black_box(rings), Grading::Uniform, &mut |_| true).unwrap()
}

/// Residual, force, energy and their derivatives at one (s, δ).
#[divan::bench(args = SIZES)]
fn evaluation(bencher: Bencher, rings: usize) {
    let case = fig_9(rings);
    bencher.bench_local(|| case.basis.evaluate(&case.reduced, black_box(0.3), black_box(-0.01)));
}

/// The curve through the explicit root, 500 points.
#[divan::bench(args = SIZES, max_time = 5)]
fn sweep(bencher: Bencher, rings: usize) {
    let case = fig_9(rings);
    bencher.bench_local(|| case.sweep(|| true).unwrap());
}

/// The curve by arc-length continuation.
#[divan::bench(args = TRACED, max_time = 5)]
fn trace(bencher: Bencher, rings: usize) {
    let case = fig_9(rings);
    bencher.bench_local(|| case.trace().unwrap());
}

/// Every jump of the swept curve with its two losses.
fn unload(bencher: Bencher, case: &Case, control: Control) {
    let curve = case.sweep(|| true).unwrap();
    bencher
        .with_inputs(|| curve.clone())
        .bench_local_values(|mut curve| case.unload(&mut curve, control).unwrap());
}

#[divan::bench(args = SIZES, max_time = 5)]
fn unload_by_displacement(bencher: Bencher, rings: usize) {
    unload(bencher, &fig_9(rings), Control::Displacement);
}

#[divan::bench(args = SIZES, max_time = 5)]
fn unload_by_force(bencher: Bencher, rings: usize) {
    unload(bencher, &fig_9(rings), Control::Force);
}

#[divan::bench(args = SIZES, max_time = 5)]
fn unload_by_spring(bencher: Bencher, rings: usize) {
    unload(bencher, &fig_9(rings), Control::Stiffness(0.15));
}

/// Radii of the dense curve.
const DENSE: usize = 2000;

fn dense_radii() -> Vec<f64> {
    (0..DENSE).map(|i| 0.5 + (0.002 - 0.5) * i as f64 / (DENSE - 1) as f64).collect()
}

fn dense(case: &Case, radii: &[f64]) -> Vec<Evaluation> {
    case.basis.equilibria(&case.reduced, radii, Order::State, &mut || true)
}

/// 2000 explicit points.
#[divan::bench(args = TRACED, max_time = 5)]
fn dense_curve(bencher: Bencher, rings: usize) {
    let (case, radii) = (fig_9(rings), dense_radii());
    bencher.bench_local(|| dense(&case, black_box(&radii)));
}

#[divan::bench]
fn spectral_dense_curve(bencher: Bencher) {
    let (case, radii) = (fig_9_spectral(), dense_radii());
    bencher.bench_local(|| dense(&case, black_box(&radii)));
}

/// The gap alone, sampled where the dense curve samples it: what no basis can go below.
#[divan::bench]
fn spectral_dense_curve_floor(bencher: Bencher) {
    let (case, radii) = (fig_9_spectral(), dense_radii());
    let rules = EdgeRules::new(case.basis.size());
    let gap = case.reduced.gap.as_ref();
    let mut values = vec![0.0; case.basis.size() + 16];
    bencher.bench_local(|| {
        for &s in black_box(&radii) {
            let nodes = rules.nodes(gap, s);
            gap.values(s, &nodes, &mut values[..nodes.len()]);
            black_box(&mut values);
        }
    });
}

/// The limit points under displacement, force and a spring, on a curve that is there.
#[divan::bench(max_time = 5)]
fn spectral_limit_points(bencher: Bencher) {
    let curve = fig_9_spectral().sweep(|| true).unwrap();
    let controls = [Control::Displacement, Control::Force, Control::Stiffness(0.15)];
    bencher.bench_local(|| controls.map(|control| curve.limit_points(control).len()));
}

/// The same, and every jump and loss of the three unloadings, from one swept curve.
fn events(bencher: Bencher, case: &Case) {
    let curve = case.sweep(|| true).unwrap();
    bencher.with_inputs(|| curve.clone()).bench_local_values(|mut curve| {
        let controls = [Control::Displacement, Control::Force, Control::Stiffness(0.15)];
        for control in controls {
            curve.hold(control);
        }
        controls.map(|control| case.unload(&mut curve.clone(), control).unwrap())
    });
}

#[divan::bench(args = TRACED, max_time = 5)]
fn all_events(bencher: Bencher, rings: usize) {
    events(bencher, &fig_9(rings));
}

#[divan::bench(max_time = 5)]
fn spectral_all_events(bencher: Bencher) {
    events(bencher, &fig_9_spectral());
}

/// The smallest automatic number of functions, its tail checked.
#[divan::bench]
fn spectral_case() -> Case {
    fig_9_spectral()
}

#[divan::bench]
fn spectral_evaluation(bencher: Bencher) {
    let case = fig_9_spectral();
    bencher.bench_local(|| case.basis.evaluate(&case.reduced, black_box(0.3), black_box(-0.01)));
}

#[divan::bench]
fn spectral_energy(bencher: Bencher) {
    let case = fig_9_spectral();
    bencher.bench_local(|| case.basis.energy(&case.reduced, black_box(0.3), black_box(-0.01)));
}

#[divan::bench(max_time = 5)]
fn spectral_sweep(bencher: Bencher) {
    let case = fig_9_spectral();
    bencher.bench_local(|| case.sweep(|| true).unwrap());
}

#[divan::bench(max_time = 5)]
fn spectral_trace(bencher: Bencher) {
    let case = fig_9_spectral();
    bencher.bench_local(|| case.trace().unwrap());
}

#[divan::bench(max_time = 5)]
fn spectral_unload_by_displacement(bencher: Bencher) {
    unload(bencher, &fig_9_spectral(), Control::Displacement);
}

#[divan::bench(max_time = 5)]
fn spectral_unload_by_force(bencher: Bencher) {
    unload(bencher, &fig_9_spectral(), Control::Force);
}

#[divan::bench(max_time = 5)]
fn spectral_unload_by_spring(bencher: Bencher) {
    unload(bencher, &fig_9_spectral(), Control::Stiffness(0.15));
}
