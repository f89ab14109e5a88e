//! The cost of the engine, over a fixed table of ring numbers and in the exact basis.
//!
//! `cargo bench`; the numbers serve to compare two versions on one machine.

#![allow(clippy::unwrap_used, reason = "a bench that cannot be set up must stop")]

use divan::{Bencher, black_box};
use pulloff::store::Store;
use pulloff_engine::annuli::{Contacts, Ground, Wanted};
use pulloff_engine::case::Case;
use pulloff_engine::disc::{Basis, Evaluation, ExactBasis, Order, Table};
use pulloff_engine::gap::Shape;
use pulloff_engine::preset::BasisSpec;
use pulloff_engine::problem::Turn;
use pulloff_engine::problem::{Cohesion, Control, Part, Problem};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::Detail;
use pulloff_engine::quasistatic::path::{Losses, PathSetting, cycle, cycle_in_zone};
use pulloff_engine::rate::{EdgeLaw, MovingEdge, Pull, PullSettings, Puller};
use pulloff_engine::ritz::{Grading, Rings};
use pulloff_engine::stability::{Family, Law, MapAxis};
use pulloff_engine::zone::Zone;
use std::sync::Arc;

/// The ring numbers.
const SIZES: [usize; 3] = [50, 200, 800];
/// The ring numbers whose construction is timed, up to the largest allowed.
const BUILT: [usize; 5] = [50, 200, 800, 1000, 2000];
/// The arc-length trace at the largest size takes too long to repeat.
const TRACED: [usize; 2] = [50, 200];

fn main() {
    divan::main();
}

/// Fig. 9 with this number of rings.
fn fig_9(rings: usize) -> Case {
    fig_9_in(BasisSpec::Rings { rings, grading: Grading::Uniform })
}

/// Fig. 9 in the exact basis.
fn fig_9_exact() -> Case {
    fig_9_in(BasisSpec::Exact)
}

fn fig_9_in(basis: BasisSpec) -> Case {
    // The folder need not exist: the preset is a shipped one.
    let store = Store::at("presets", &[]);
    let mut preset = store.load(&store.resolve("fig-9").unwrap(), &[] as &[&str]).unwrap().preset;
    preset.basis = basis;
    Case::new(&preset).unwrap()
}

/// B̃, W̃ and the factorization.
#[divan::bench(args = BUILT, max_time = 5)]
fn assembly_and_factorization(rings: usize) -> Rings {
    Rings::new(black_box(rings), Grading::Uniform, &pulloff_engine::progress::Unwatched).unwrap()
}

/// Residual, force, energy and their derivatives at one (s, δ).
#[divan::bench(args = SIZES)]
fn evaluation(bencher: Bencher, rings: usize) {
    let case = fig_9(rings);
    bencher.bench_local(|| case.basis.evaluate(&case.reduced, black_box(0.3), black_box(-0.01)));
}

/// The equilibria over all radii, with the states to draw.
#[divan::bench(args = SIZES, max_time = 5)]
fn curve(bencher: Bencher, rings: usize) {
    let case = fig_9(rings);
    bencher.bench_local(|| case.curve(&Unwatched).unwrap());
}

/// The curve by arc-length continuation.
#[divan::bench(args = TRACED, max_time = 5)]
fn trace(bencher: Bencher, rings: usize) {
    let case = fig_9(rings);
    let curve = case.curve(&Unwatched).unwrap();
    bencher.bench_local(|| case.trace(&curve, &Unwatched).unwrap());
}

/// Every jump of the curve with its two losses.
fn unload(bencher: Bencher, case: &Case, control: Control) {
    let curve = case.curve(&Unwatched).unwrap();
    bencher.bench_local(|| case.unload(&curve, &PathSetting::one_disc(control), &Unwatched).unwrap());
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

/// The number of radii of the dense curve.
const DENSE: usize = 2000;

fn dense_radii() -> Vec<f64> {
    (0..DENSE).map(|i| 0.5 + (0.002 - 0.5) * i as f64 / (DENSE - 1) as f64).collect()
}

fn dense(case: &Case, radii: &[f64]) -> Vec<Evaluation> {
    case.basis.equilibria(&case.reduced, radii, Order::State, &Unwatched)
}

/// 2000 explicit points.
#[divan::bench(args = TRACED, max_time = 5)]
fn dense_curve(bencher: Bencher, rings: usize) {
    let (case, radii) = (fig_9(rings), dense_radii());
    bencher.bench_local(|| dense(&case, black_box(&radii)));
}

/// The same in the exact basis, with a new table each time.
#[divan::bench]
fn exact_dense_curve(bencher: Bencher) {
    let (problem, radii) = (problem(), dense_radii());
    bencher.bench_local(|| {
        let basis = ExactBasis::of(&problem, 0.5).unwrap();
        basis.equilibria(&problem, black_box(&radii), Order::State, &Unwatched)
    });
}

/// Only the table.
#[divan::bench]
fn exact_table(bencher: Bencher) {
    let problem = problem();
    bencher.bench_local(|| Table::new(Arc::clone(&problem.gap), black_box(0.5), &Unwatched).unwrap());
}

/// The problem of Fig. 9, reduced.
fn problem() -> pulloff_engine::problem::Reduced {
    let shape = Shape::WavySphere { radius_of_curvature: 1.0, amplitude: 0.0025, wavelength: 0.05 };
    let work_of_adhesion = 0.025 / std::f64::consts::TAU;
    Problem { effective_modulus: 1.0, work_of_adhesion, shape }.reduced()
}

/// The limit points under displacement, force and a spring, and every jump and both losses of the three unloadings, on
/// an existing curve.
fn events(bencher: Bencher, case: &Case) {
    let curve = case.curve(&Unwatched).unwrap();
    let controls = [Control::Displacement, Control::Force, Control::Stiffness(0.15)];
    bencher.with_inputs(|| curve.clone()).bench_local_values(|mut curve| {
        for control in controls {
            curve.hold(control);
        }
        let setting = |control| PathSetting { detail: Detail::Borders, ..PathSetting::new(control) };
        controls.map(|control| case.unload(&curve, &setting(control), &Unwatched).unwrap())
    });
}

#[divan::bench(args = TRACED, max_time = 5)]
fn all_events(bencher: Bencher, rings: usize) {
    events(bencher, &fig_9(rings));
}

#[divan::bench(max_time = 5)]
fn exact_all_events(bencher: Bencher) {
    events(bencher, &fig_9_exact());
}

#[divan::bench]
fn exact_evaluation(bencher: Bencher) {
    let case = fig_9_exact();
    bencher.bench_local(|| case.basis.evaluate(&case.reduced, black_box(0.3), black_box(-0.01)));
}

#[divan::bench(max_time = 5)]
fn exact_curve(bencher: Bencher) {
    let case = fig_9_exact();
    bencher.bench_local(|| case.curve(&Unwatched).unwrap());
}

#[divan::bench(max_time = 5)]
fn exact_trace(bencher: Bencher) {
    let case = fig_9_exact();
    let curve = case.curve(&Unwatched).unwrap();
    bencher.bench_local(|| case.trace(&curve, &Unwatched).unwrap());
}

#[divan::bench(max_time = 5)]
fn exact_unload_by_displacement(bencher: Bencher) {
    unload(bencher, &fig_9_exact(), Control::Displacement);
}

#[divan::bench(max_time = 5)]
fn exact_unload_by_force(bencher: Bencher) {
    unload(bencher, &fig_9_exact(), Control::Force);
}

#[divan::bench(max_time = 5)]
fn exact_unload_by_spring(bencher: Bencher) {
    unload(bencher, &fig_9_exact(), Control::Stiffness(0.15));
}

/// The gap of Fig. 9, as far as three rings go.
fn ground() -> Ground {
    Ground::of(problem().gap, 0.6).unwrap()
}

/// A disc and the rings on the next crests, with all derivatives with respect to the edges.
#[divan::bench(args = [1, 3])]
fn state_with_rings(bencher: Bencher, rings: u32) {
    let ground = ground();
    let ring = |crest: u32| [0.05 * f64::from(crest) - 0.008, 0.05 * f64::from(crest) + 0.007];
    let contacts = Contacts { disc: 0.12, rings: (3..3 + rings).map(ring).collect() };
    bencher.bench_local(|| {
        let state = ground.state(black_box(&contacts), Wanted::Rates).unwrap();
        state.jacobian(black_box(0.02), ground.slope(contacts.disc))
    });
}

/// The loop on the waves of Fig. 9 up to this approach, with a new table each time and losses from energy only.
fn whole_loop(bencher: Bencher, work_of_adhesion: f64, turn: f64) {
    let gap = problem().gap;
    let turn = Turn::Approach(turn);
    let setting = PathSetting { losses: Losses::Once, ..PathSetting::new(Control::Displacement) };
    bencher.bench_local(|| {
        let table = Arc::new(Table::new(Arc::clone(&gap), 0.5, &Unwatched).unwrap());
        cycle(&table, black_box(work_of_adhesion), turn, &setting, &Unwatched).unwrap()
    });
}

#[divan::bench(max_time = 5)]
fn loop_of_fig_9(bencher: Bencher) {
    whole_loop(bencher, problem().work_of_adhesion, 0.14);
}

#[divan::bench(max_time = 5)]
fn loop_of_weak_adhesion(bencher: Bencher) {
    whole_loop(bencher, 1e-4, 0.14);
}

#[divan::bench(max_time = 5)]
fn loop_of_very_weak_adhesion(bencher: Bencher) {
    whole_loop(bencher, 1e-5, 0.14);
}

/// The tension E* in the gap of Fig. 9, with its work of adhesion.
fn cohesion() -> Cohesion {
    Cohesion { strength: 1.0, range: problem().work_of_adhesion }
}

/// The state in contact with one zone of adhesion with a range, starting from the neighbouring state.
#[divan::bench]
fn state_with_a_range(bencher: Bencher) {
    let ground = ground();
    let zone = Zone::new(Arc::clone(&ground.gap), Arc::clone(&ground.panels), cohesion());
    let near = zone.state(0.1601, None).map(|state| state.share);
    bencher.bench_local(|| zone.state(black_box(0.16), near).unwrap());
}

/// The loop on the waves of Fig. 9 to δ = 0.02 with a range, with a new table each time and losses computed in both ways.
#[divan::bench(max_time = 5)]
fn loop_with_a_range(bencher: Bencher) {
    let gap = problem().gap;
    let setting = PathSetting::new(Control::Displacement);
    bencher.bench_local(|| {
        let table = Arc::new(Table::new(Arc::clone(&gap), 0.5, &Unwatched).unwrap());
        cycle_in_zone(&table, black_box(cohesion()), Turn::Approach(0.02), &setting, &Unwatched).unwrap()
    });
}

/// The adhesion at which each of 2000 states is a limit point, from an existing table.
#[divan::bench]
fn critical_adhesion(bencher: Bencher) {
    let case = fig_9_exact();
    let law = Law { panels: case.table.up_to(0.5).unwrap(), control: Control::Displacement };
    let radii: Vec<f64> = (1..=2000).map(|k| 0.5 * f64::from(k) / 2000.0).collect();
    bencher.bench_local(|| law.over(black_box(&radii)));
}

/// All lines of a map of the waves of Fig. 9, for one pair where they follow from the radius, and one for which they are traced.
#[divan::bench(args = ["groups.amplitude_over_wavelength", "groups.wavelength_over_radius"], max_time = 10)]
fn map_lines(bencher: Bencher, key: &str) {
    let store = Store::at("presets", &[]);
    let preset = store.load(&store.resolve("fig-9").unwrap(), &[] as &[&str]).unwrap().preset;
    let range = if key.contains("radius") { [0.02, 0.1] } else { [0.0, 0.0125] };
    let x = MapAxis::new(key, range, false, 1.0).unwrap();
    let y = MapAxis::new("groups.adhesion", [1e-3, 1.0], true, 1.0).unwrap();
    bencher.bench_local(|| {
        Family::new(&preset, vec![x.clone(), y.clone()]).unwrap().map([32, 24], &Unwatched).unwrap()
    });
}

/// One pull of Fig. 9 from s = 0.5, n = 1/2.
fn pulled(case: &Case, rate: f64, tolerance: f64) -> Pull {
    let gamma = case.reduced.work_of_adhesion;
    let puller = Puller {
        table: &case.table,
        control: Control::Displacement,
        edge: MovingEdge { law: EdgeLaw::symmetric(0.5), opening: gamma, closing: gamma },
        start: 0.5,
        wave: case.reduced.gap.feature_length(),
        rise: None,
        settings: PullSettings { tolerance, ..PullSettings::default() },
    };
    puller.pull(&[Part::Apart { rate }], &Unwatched).unwrap()
}

/// A pull at a rate over v₀, with errors of 1e-9.
#[divan::bench(args = [1e-8, 1e-4, 1e-2, 1.0, 100.0])]
fn pull_at_a_rate(bencher: Bencher, rate: f64) {
    let case = fig_9_exact();
    bencher.bench_local(|| pulled(&case, black_box(rate), 1e-9));
}

/// A hundred rates over eight decades, with errors of 1e-6.
#[divan::bench]
fn pull_at_a_hundred_rates(bencher: Bencher) {
    let case = fig_9_exact();
    let rates: Vec<f64> = (0..100).map(|k| 1e-6 * 10.0_f64.powf(8.0 * f64::from(k) / 99.0)).collect();
    bencher.bench_local(|| rates.iter().map(|rate| pulled(&case, *rate, 1e-6).steps).sum::<usize>());
}
