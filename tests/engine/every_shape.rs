//! Every shape that a user can choose, as shipped, in both bases: the curve, the limit points, the landings and the
//! losses against its exact solution, which uses neither the bases nor Newton nor continuation.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use pulloff::store::Store;
use pulloff_engine::case::Case;
use pulloff_engine::preset::schema::Kind;
use pulloff_engine::preset::{BasisSpec, PARAMETERS, Preset};
use pulloff_engine::problem::Control;
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::path::{Path as Ours, PathSetting, PathState};
use pulloff_engine::ritz::Grading;
use pulloff_engine::theory::Exact;
use pulloff_engine::theory::disc::ExactEquilibrium;
use pulloff_engine::theory::unloading::{ExactPath, unload};

/// The tolerances for an automatic number of eigenfunctions: δ and P relative to their parts, radii of limit points and
/// landings over that of the start, and losses. The loss of a small snap is a difference of energies a thousand times
/// larger.
const EXACT: [f64; 3] = [1e-13, 1e-12, 1e-7];

/// The usual tolerances for 400 rings.
const RINGS: [f64; 3] = [5e-3, 1e-3, 5e-3];

/// The same where the waves of a profile make the losses of snaps that small.
const RINGS_SMALL_SNAPS: [f64; 3] = [5e-3, 1e-3, 0.1];

/// The same at a corner of the gap, where the curve is a root of the radius: the nodes of the rings pass it one by one.
const RINGS_CORNER: [f64; 3] = [5e-3, 0.1, 5e-3];

/// A preset of every shape, and formulas that are not smooth, with the tolerances for rings.
const SHAPES: [(&str, &[&str], [f64; 3]); 14] = [
    ("fig-3-jkr", &[], RINGS),
    ("fig-9", &[], RINGS),
    ("wavy-sphere", &[], RINGS),
    ("exact-sphere", &[], RINGS),
    ("cone", &[], RINGS),
    ("power-law", &[], RINGS),
    ("power-law", &["gap.exponent=2.5"], RINGS),
    ("power-law", &["gap.exponent=1.5"], RINGS),
    ("harmonics", &[], RINGS),
    ("random-waves", &[], RINGS),
    ("formula", &[], RINGS),
    ("formula", &["gap.formula=r^2/(2*R) + A*abs(r - 0.2)/lambda"], RINGS_CORNER),
    // A step in the curvature.
    ("formula", &["gap.formula=r^2/(2*R) + 20*A*max(r - 4*lambda, 0)^2/lambda^2"], RINGS),
    ("profile", &[], RINGS_SMALL_SNAPS),
];

fn preset(name: &str, assignments: &[&str]) -> Preset {
    let store = Store::at("presets", &[]);
    store.load(&store.resolve(name).unwrap(), assignments).unwrap().preset
}

/// The largest differences of δ and P from the exact curve, relative to their parts.
fn off_the_curve(case: &Case, exact: &Exact) -> f64 {
    let units = case.units();
    let mut worst = 0.0_f64;
    for i in 0..25 {
        let s = case.start * (case.end / case.start).powf(f64::from(i) / 24.0);
        let radius = s * units.length;
        let ours = case.basis.equilibrium(&case.reduced, s);
        let ours = ours.unwrap_or_else(|| panic!("no equilibrium at the radius {radius}"));
        let truth = exact.equilibrium(radius, 0.0);
        let approach = exact.transform(radius).value.abs() + exact.edge(radius);
        worst = worst
            .max((ours.approach * units.length - truth.approach).abs() / approach)
            .max((ours.force * units.force - truth.force).abs() / truth.force_scale);
    }
    worst
}

/// The largest differences of radii and losses from the exact path.
fn off_the_path(case: &Case, ours: &Ours, exact: &ExactPath) -> [f64; 2] {
    let (length, energy) = (case.units().length, case.units().energy);
    let scale = exact.start.contact_radius;
    let radius = |ours: &PathState, exact: &ExactEquilibrium| {
        (ours.contact_radius * length - exact.contact_radius).abs() / scale
    };
    let mut off = [radius(ours.start().unwrap(), &exact.start), 0.0];
    for (event, jump) in ours.events.iter().zip(&exact.jumps) {
        off[0] = off[0].max(radius(event.before.as_ref().unwrap(), &jump.before));
        assert_eq!(event.after.is_some(), jump.after.is_some());
        if let (Some(after), Some(truth)) = (&event.after, &jump.after) {
            off[0] = off[0].max(radius(after, truth));
        }
        assert_eq!(event.dissipated.is_some(), jump.dissipated.is_some());
        for loss in [event.dissipated, event.dissipated_by_area].into_iter().flatten() {
            off[1] = off[1].max((loss * energy / jump.dissipated.unwrap() - 1.0).abs());
        }
    }
    off
}

fn check(name: &str, preset: &Preset, tolerances: [f64; 3]) {
    let case = Case::new(preset).unwrap();
    let exact = Exact::of(&case.problem);
    let curve = off_the_curve(&case, &exact);
    println!("{name}: curve {curve:.1e}");
    assert!(curve <= tolerances[0], "{name}: {curve:e}");
    for control in [Control::Displacement, Control::Force] {
        let curve = case.curve(&Unwatched).unwrap();
        let ours = case.unload(&curve, &PathSetting::one_disc(control), &Unwatched).unwrap();
        let truth = unload(&*exact, control, case.start * case.units().length).unwrap();
        // The exact path continues to the pull-off, ours to the requested end.
        let jumps = truth.jumps.len();
        let off = off_the_path(&case, &ours, &truth);
        println!(
            "{name} {control}: {} of {jumps} jumps, radii {:.1e}, losses {:.1e}",
            ours.events.len(),
            off[0],
            off[1]
        );
        assert!(off[0] <= tolerances[1] && off[1] <= tolerances[2], "{name} {control}: {off:?}");
        assert_eq!(ours.events.len(), jumps, "{name} {control}");
    }
}

#[test]
fn no_shape_is_missing() {
    let row = PARAMETERS.iter().find(|row| row.name() == "shape").unwrap();
    let Kind::Choice(names) = row.kind else { unreachable!() };
    for name in names {
        let found = SHAPES.iter().any(|(shipped, set, _)| preset(shipped, set).gap.name() == *name);
        assert!(found, "{name}");
    }
}

#[test]
fn the_exact_basis_is_exact() {
    for (name, assignments, _) in SHAPES {
        let mut preset = preset(name, assignments);
        preset.basis = BasisSpec::Exact;
        check(&format!("{name} {assignments:?}"), &preset, EXACT);
    }
}

#[test]
fn rings_are_near() {
    for (name, assignments, tolerances) in SHAPES {
        let mut preset = preset(name, assignments);
        preset.basis = BasisSpec::Rings { rings: 400, grading: Grading::Uniform };
        check(&format!("{name} {assignments:?}"), &preset, tolerances);
    }
}

#[test]
fn the_table_follows_a_start_that_runs_far_outward() {
    let far = |start: f64| {
        let start = format!("path.start_contact_radius={start}");
        let wave = "gap.amplitude=0.0005";
        let set = ["basis.kind=exact", "path.control=force", wave, &start];
        let case = Case::new(&preset("fig-9", &set)).unwrap();
        let exact = Exact::of(&case.problem);
        let truth = unload(&*exact, Control::Force, case.start * case.units().length).unwrap();
        let waves = (truth.start.contact_radius - case.start) / 0.05;
        (waves > 1.5).then_some((case, truth, waves))
    };
    let found: Vec<_> = (0..20).filter_map(|i| far(0.1 + 0.005 * f64::from(i))).step_by(4).collect();
    assert!(found.len() > 1);
    for (case, truth, waves) in found {
        let curve = case.curve(&Unwatched).unwrap();
        let ours = case.unload(&curve, &PathSetting::one_disc(Control::Force), &Unwatched).unwrap();
        let off = off_the_path(&case, &ours, &truth);
        println!("outward by {waves:.2} waves, {off:?}");
        assert_eq!(ours.events.len(), truth.jumps.len(), "{waves}");
        assert!(off[0] <= EXACT[1] && off[1] <= EXACT[2], "{waves}: {off:?}");
    }
}
