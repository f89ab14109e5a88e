//! Every gap in both bases, against its exact solution: states, limit points, landings and losses.
//!
//! E* = 1. The closed forms themselves are checked against Sneddon's integrals of the same gap.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff_engine::disc::{Basis, ExactBasis};
use pulloff_engine::gap::Gap;
use pulloff_engine::gap::{
    shapes::ExactSphere, shapes::Harmonic, shapes::Harmonics, shapes::PowerLaw, shapes::ProfileGap,
    shapes::RandomWaves, shapes::Smoothing,
};
use pulloff_engine::problem::{Control, Reduced, Units};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::path::{PathSetting, unload};
use pulloff_engine::quasistatic::{Curve, Event, EventKind, PathStop};
use pulloff_engine::ritz::Rings;
use pulloff_engine::theory::sneddon::Sneddon;
use pulloff_engine::theory::{Disc, harmonics, power_law, sphere};
use std::sync::Arc;

/// One gap with the exact solution of its contact.
struct Case {
    name: &'static str,
    gap: Arc<dyn Gap>,
    exact: Box<dyn Disc>,
    gamma: f64,
    /// The largest contact.
    from: f64,
    /// The accuracy of δ and P, whatever the gap.
    tolerance: f64,
    /// The same for energies, whose terms decay as a power of their number where the gap is not even.
    energy: f64,
}

fn case<G: Gap + 'static>(name: &'static str, gap: G, exact: impl Disc + 'static, from: f64) -> Case {
    let gamma = exact.work_of_adhesion();
    let exact = Box::new(exact);
    Case { name, gap: Arc::new(gap), exact, gamma, from, tolerance: 1e-11, energy: 1e-9 }
}

fn law(name: &'static str, factor: f64, exponent: f64, gamma: f64, [tolerance, energy]: [f64; 2]) -> Case {
    let gap = PowerLaw { factor, exponent };
    Case { tolerance, energy, ..case(name, gap, power_law::PowerLawDisc::new(1.0, gamma, &gap), 0.8) }
}

fn waves(name: &'static str, gap: &Harmonics, gamma: f64, from: f64) -> Case {
    let exact = harmonics::HarmonicDisc { effective_modulus: 1.0, work_of_adhesion: gamma, gap: gap.clone() };
    // A phase gives the gap a slope on the axis, which affects energies as odd powers do.
    Case { energy: 1e-8, ..case(name, gap.clone(), exact, from) }
}

fn phased() -> Harmonics {
    let wave = |amplitude, wavelength, phase| Harmonic { amplitude, wavelength, phase };
    let waves = vec![wave(0.0025, 0.07, 0.9), wave(0.004, 0.11, -2.0), wave(0.01, 0.6, 3.0)];
    Harmonics::new(1.0, waves).unwrap()
}

fn rough() -> Harmonics {
    let drawn = RandomWaves {
        radius_of_curvature: 1.0,
        rms: 2.5e-3,
        longest: 0.4,
        shortest: 0.04,
        hurst: 0.8,
        count: 25,
        seed: 2,
    };
    drawn.harmonics().unwrap()
}

fn cases(adhesive: bool) -> Vec<Case> {
    let gamma = |gamma: f64| if adhesive { gamma } else { 0.0 };
    let ball = sphere::Sphere { effective_modulus: 1.0, work_of_adhesion: gamma(0.01), radius: 1.0 };
    vec![
        case("sphere", ExactSphere { radius: 1.0 }, ball, 0.9),
        law("cone", 0.3, 1.0, gamma(0.005), [1e-13, 1e-7]),
        law("n = 1.5", 0.4, 1.5, gamma(0.005), [1e-13, 1e-8]),
        law("n = 2.7", 0.5, 2.7, gamma(0.01), [1e-13, 1e-9]),
        law("n = 3", 0.5, 3.0, gamma(0.01), [1e-11, 1e-9]),
        law("n = 4", 0.7, 4.0, gamma(0.01), [1e-11, 1e-9]),
        law("n = 20", 0.7, 20.0, gamma(0.01), [1e-11, 1e-9]),
        waves("waves with phases", &phased(), gamma(0.004), 0.6),
        waves("random waves", &rough(), gamma(0.006), 0.6),
    ]
}

/// A problem that is its own reduced form.
fn reduced(gap: &Arc<dyn Gap>, gamma: f64) -> Reduced {
    let units =
        Units { length: 1.0, force: 1.0, energy: 1.0, stiffness: 1.0, pressure: 1.0, work_of_adhesion: 1.0 };
    Reduced { work_of_adhesion: gamma, gap: Arc::clone(gap), units }
}

fn sneddon(gap: &Arc<dyn Gap>, gamma: f64) -> Sneddon {
    Sneddon { effective_modulus: 1.0, work_of_adhesion: gamma, gap: Arc::clone(gap) }
}

/// From a tenth of a wave to the largest contact.
fn radii(from: f64) -> impl Iterator<Item = f64> {
    (0..12).map(move |i| from * 0.67_f64.powi(i))
}

/// The size by which an error of δ is measured: that of its two parts.
fn approach_scale(exact: &dyn Disc, s: f64) -> f64 {
    exact.transform(s).value.abs() + exact.edge(s)
}

/// The largest errors of δ and P, relative to their parts, of `basis` at the radii of the case.
fn errors(basis: &dyn Basis, problem: &Reduced, exact: &dyn Disc, from: f64) -> [f64; 2] {
    radii(from).fold([0.0, 0.0], |[approach, force]: [f64; 2], s| {
        let at = basis.equilibrium(problem, s).unwrap();
        let truth = exact.equilibrium(s, 0.0);
        [
            approach.max((at.approach - truth.approach).abs() / approach_scale(exact, s)),
            force.max((at.force - truth.force).abs() / truth.force_scale),
        ]
    })
}

#[test]
fn closed_forms_are_sneddons_integrals() {
    for Case { name, gap, exact, gamma, from, .. } in cases(true) {
        let integrals = sneddon(&gap, gamma);
        for s in radii(from).chain([1e-3 * from]) {
            let (a, b) = (exact.transform(s), integrals.transform(s));
            // Where there are waves, terms of their size nearly cancel.
            let waves = exact.wave().map_or(1.0, |_| 100.0);
            for (a, b, size) in [
                (a.value, b.value, b.value.abs().max(s * s)),
                (a.slope, b.slope, b.slope.abs()),
                (a.moment, b.moment, b.moment.abs()),
            ] {
                assert!((a - b).abs() <= 4e-13 * waves * size, "{name} {s}: {a} {b}");
            }
        }
        let (a, b) = (exact.energy(0.3), integrals.energy(0.3));
        assert!((a - b).abs() <= 1e-11 * (b.abs() + gamma), "{name}: {a} {b}");
    }
}

#[test]
fn both_bases_find_the_states() {
    for adhesive in [true, false] {
        for Case { name, gap, exact, gamma, from, tolerance, .. } in cases(adhesive) {
            let problem = reduced(&gap, gamma);
            let table = errors(&ExactBasis::of(&problem, from).unwrap(), &problem, exact.as_ref(), from);
            println!("{name} adhesive {adhesive}: table {table:?}");
            assert!(table.iter().all(|error| *error <= tolerance), "{name}: {table:?}");
            let [coarse, fine] =
                [200, 400].map(|n| errors(&*Rings::shared(n).unwrap(), &problem, exact.as_ref(), from));
            println!("{name} adhesive {adhesive}: rings {coarse:?} {fine:?}");
            // Without adhesion, the force on waves is a small difference of their parts.
            let bound = if exact.wave().is_some() && !adhesive { 0.2 } else { 0.05 };
            for (coarse, fine) in coarse.into_iter().zip(fine) {
                assert!(fine <= bound && fine <= 0.6 * coarse, "{name}: {coarse} {fine}");
            }
        }
    }
}

#[test]
fn limit_points_landings_and_losses_are_the_exact_ones() {
    for Case { name, gap, exact, gamma, from, tolerance, energy } in cases(true) {
        let problem = reduced(&gap, gamma);
        let basis: Arc<dyn Basis> = Arc::new(ExactBasis::of(&problem, from).unwrap());
        let curve = Curve::of(problem, basis, from, 0.004 * from).unwrap();
        // A slope vanishes at a limit point, so its position is accurate to the root of the tolerance, or to rounding.
        let tolerance = 100.0 * tolerance;
        for control in [Control::Displacement, Control::Force] {
            let unloading = unload(&curve, &PathSetting::one_disc(control), &Unwatched).unwrap();
            assert_eq!(unloading.stop, PathStop::Apart, "{name} {control}");
            let snaps = unloading.events.iter().filter(|event| event.kind == EventKind::Snap).count();
            println!("{name} {control}: {snaps} snaps");
            assert_eq!(snaps > 0, exact.wave().is_some(), "{name} {control}: {snaps}");
            for event in &unloading.events {
                let s = event.before.as_ref().unwrap().contact_radius;
                let (approach, force) = exact.slopes(s);
                let (slope, size) = match control {
                    Control::Force => (force, exact.equilibrium(s, 0.0).force_scale),
                    _ => (approach, approach_scale(exact.as_ref(), s)),
                };
                let bend = exact.wave().unwrap_or(s).min(s);
                assert!((slope * bend / size).abs() <= 10.0 * tolerance, "{name} {control} {s}: {slope}");
                for state in event.before.iter().chain(&event.after) {
                    let s = state.contact_radius;
                    let truth = exact.equilibrium(s, 0.0);
                    let error = (state.approach - truth.approach).abs();
                    assert!(error <= tolerance * approach_scale(exact.as_ref(), s), "{name} {control} {s}");
                    let error = (state.force - truth.force).abs();
                    assert!(error <= tolerance * truth.force_scale, "{name} {control} {s}");
                    let error = (state.energy - exact.energy(s)).abs();
                    assert!(error <= energy * (truth.force_scale * s), "{name} {control} {s}: {error:e}");
                }
                if let (Some(drop), Some(area)) = (event.dissipated, event.dissipated_by_area) {
                    // A small loss is a difference of energies of this size.
                    let size = exact.equilibrium(s, 0.0).force_scale * s;
                    assert!((drop - area).abs() <= energy * size, "{name} {control} {s}: {drop} {area}");
                }
            }
        }
    }
}

#[test]
fn a_profile_is_its_own_exact_solution_and_nears_that_of_its_source() {
    let source = rough();
    let (gamma, from) = (0.006, 0.4);
    let rows = |n: u16| {
        let radii: Vec<f64> = (0..=n).map(|i| 0.5 * f64::from(i) / f64::from(n)).collect();
        let gaps: Vec<f64> = radii.iter().map(|&r| source.jet(r).value).collect();
        Arc::new(ProfileGap::new(&radii, &gaps, Smoothing::None).unwrap()) as Arc<dyn Gap>
    };
    let truth = waves("source", &source, gamma, from).exact;
    let gap = rows(150);
    let (problem, own) = (reduced(&gap, gamma), sneddon(&gap, gamma));
    let table = errors(&ExactBasis::of(&problem, from).unwrap(), &problem, &own, from);
    println!("profile: table {table:?}");
    assert!(table.iter().all(|error| *error <= 1e-13), "{table:?}");
    let rings = errors(&*Rings::shared(400).unwrap(), &problem, &own, from);
    assert!(rings.iter().all(|error| *error <= 0.03), "{rings:?}");
    // Half the distance between rows gives an eighth to a sixteenth of the error.
    let [far, near] = [150, 300].map(|n| {
        let problem = reduced(&rows(n), gamma);
        errors(&ExactBasis::of(&problem, from).unwrap(), &problem, truth.as_ref(), from)
    });
    println!("profile: rows {far:?} {near:?}");
    assert!(near.iter().zip(far).all(|(near, far)| *near <= 0.2 * far && *near < 1e-3), "{far:?} {near:?}");
    // The unloading has the same jumps as that of the source.
    let unloaded = |gap: Arc<dyn Gap>| {
        let problem = reduced(&gap, gamma);
        let basis: Arc<dyn Basis> = Arc::new(ExactBasis::of(&problem, from).unwrap());
        let curve = Curve::of(problem, basis, from, 0.01).unwrap();
        unload(&curve, &PathSetting::one_disc(Control::Displacement), &Unwatched).unwrap()
    };
    let (ours, theirs) = (unloaded(rows(600)), unloaded(Arc::new(source.clone())));
    assert!(theirs.events.len() > 1 && theirs.stop == PathStop::Apart);
    assert_eq!(ours.events.len(), theirs.events.len());
    let radius = |event: &Event| event.before.as_ref().unwrap().contact_radius;
    for (a, b) in ours.events.iter().zip(&theirs.events) {
        assert_eq!(a.kind, b.kind);
        assert!((radius(a) / radius(b) - 1.0).abs() < 1e-3, "{a:?} {b:?}");
        assert!((a.dissipated.unwrap() / b.dissipated.unwrap() - 1.0).abs() < 1e-2, "{a:?} {b:?}");
    }
}

#[test]
fn beyond_the_largest_radius_there_is_no_equilibrium() {
    let ball: Arc<dyn Gap> = Arc::new(ExactSphere { radius: 1.0 });
    let problem = reduced(&ball, 0.01);
    let exact = ExactBasis::of(&problem, 0.5).unwrap();
    assert!(exact.equilibrium(&problem, 0.99).is_some() && exact.equilibrium(&problem, 1.01).is_none());
    assert!(Rings::shared(20).unwrap().equilibrium(&problem, 0.99).is_some());
    assert!(Rings::shared(20).unwrap().equilibrium(&problem, 1.01).is_none());
    assert!(Curve::of(problem, Arc::new(exact), 1.2, 0.1).is_none());
}
