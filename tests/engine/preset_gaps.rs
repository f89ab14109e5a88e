//! Every gap that a preset can have, from its file to the jumps, in both bases against the exact solution.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff::store::{read, shipped};
use pulloff_engine::case::Case;
use pulloff_engine::gap::Gap;
use pulloff_engine::preset::{Preset, Value};
use pulloff_engine::problem::Control;
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::path::PathSetting;
use pulloff_engine::theory::{Exact, unloading};
use pulloff_engine::{Extent, PathReport};
use std::sync::Arc;

const NAMES: [&str; 7] =
    ["exact-sphere", "cone", "power-law", "harmonics", "random-waves", "formula", "profile"];

/// The shipped preset with some values changed.
fn preset(name: &str, sets: &[(&str, Value)]) -> Preset {
    let mut preset = read(name, shipped::find(name).unwrap().text).unwrap();
    for (key, value) in sets {
        preset.set(key, value.clone()).unwrap();
    }
    preset
}

/// The largest error of force and approach over the curve, each over its scale, against `exact`.
fn error(case: &Case, exact: &Exact) -> f64 {
    let units = case.units();
    let mut worst = 0.0f64;
    for share in [0.02, 0.11, 0.36, 0.7, 1.0] {
        let s = case.end + share * (case.start - case.end);
        let found = case.basis.equilibrium(&case.reduced, s).unwrap();
        let radius = s * units.length;
        let (force, approach) = (exact.force(radius), exact.approach(radius));
        // Both are differences of an elastic and an adhesive part, so errors are measured by what is subtracted.
        let drop =
            (std::f64::consts::TAU * exact.work_of_adhesion() * radius / exact.effective_modulus()).sqrt();
        let length = approach.abs() + drop;
        let press = exact.effective_modulus() * radius * length;
        worst = worst.max((found.approach * units.length - approach).abs() / length);
        worst = worst.max((found.force * units.force - force).abs() / press);
    }
    worst
}

#[test]
fn both_bases_find_sneddons_integrals() {
    for name in NAMES {
        let spectral = Case::new(&preset(name, &[])).unwrap();
        let rings = preset(name, &[("basis.kind", "rings".into()), ("basis.rings", 800.into())]);
        let rings = Case::new(&rings).unwrap();
        let problem = &spectral.problem;
        let gap = Arc::new(problem.shape.clone());
        let sneddon = Exact::by_quadrature(problem.effective_modulus, problem.work_of_adhesion, gap);
        for exact in [&sneddon, &Exact::of(problem)] {
            let (fine, coarse) = (error(&spectral, exact), error(&rings, exact));
            // The derivatives of a cone and of a measured curve jump, so there is no exponential convergence.
            let bound = if matches!(name, "cone" | "profile") { 1e-3 } else { 1e-9 };
            assert!(fine < bound, "{name}, spectral: off by {fine:e} from {}", exact.name());
            assert!(coarse < 0.02, "{name}, rings: off by {coarse:e} from {}", exact.name());
        }
    }
}

#[test]
fn limit_points_and_jumps_are_those_of_the_exact_path() {
    // The exact path of a profile integrates over every row for every state; its states are checked above.
    for name in NAMES.into_iter().filter(|name| *name != "profile") {
        let case = Case::new(&preset(name, &[])).unwrap();
        let exact = Exact::of(&case.problem);
        let units = *case.units();
        let curve = case.curve(&Unwatched).unwrap();
        for control in [Control::Displacement, Control::Force] {
            let start = case.start * units.length;
            let limits = unloading::limit_points(&*exact, control, start, case.end * units.length);
            let found = curve.limit_points(control);
            assert_eq!(found.len(), limits.len(), "{name}, {control}");
            let ours = case.unload(&curve, &PathSetting::one_disc(control), &Unwatched).unwrap();
            let theirs = unloading::unload(&*exact, control, start).unwrap();
            let jumps =
                theirs.jumps.iter().filter(|jump| jump.before.contact_radius > case.end * units.length);
            assert_eq!(ours.events.len(), jumps.clone().count(), "{name}, {control}");
            for (event, jump) in ours.events.iter().zip(jumps) {
                let radius = event.before.as_ref().unwrap().contact_radius * units.length;
                let off = (radius / jump.before.contact_radius - 1.0).abs();
                let bound = if name == "cone" { 5e-3 } else { 1e-6 };
                assert!(off < bound, "{name}, {control}: {radius} {}", jump.before.contact_radius);
                assert_eq!(event.after.is_some(), jump.after.is_some(), "{name}, {control}");
            }
        }
    }
}

#[test]
fn figure_9_as_a_formula_is_figure_9() {
    let formula = preset("formula", &[]);
    let built_in = preset("fig-9", &[("basis.kind", "exact".into())]);
    assert_eq!(formula.gap.radius_of_curvature(), built_in.gap.radius_of_curvature());
    let [formula, built_in] = [formula, built_in].map(|preset| Case::new(&preset).unwrap());
    let close = |a: Option<f64>, b: Option<f64>| (a.unwrap() / b.unwrap() - 1.0).abs() < 1e-12;
    let feature = |case: &Case| case.problem.shape.feature_length();
    assert!(close(feature(&formula), feature(&built_in)));
    assert!(close(formula.critical_force(), built_in.critical_force()));
    for i in 1..=50 {
        let s = 0.01 * f64::from(i);
        let [ours, theirs] =
            [&formula, &built_in].map(|case| case.basis.equilibrium(&case.reduced, s).unwrap());
        assert!((ours.force - theirs.force).abs() < 1e-12 && (ours.approach - theirs.approach).abs() < 1e-12);
    }
}

#[test]
fn without_a_radius_nothing_is_said_of_a_smooth_sphere() {
    let case = Case::new(&preset("cone", &[])).unwrap();
    assert!(case.smooth().is_none() && case.critical_force().is_none());
    let groups =
        serde_json::to_value(pulloff_engine::problem::Groups::of(&case.problem, None, None)).unwrap();
    assert!(groups.as_object().unwrap().values().all(serde_json::Value::is_null));
    // Reduced by the contact radius at the start.
    assert!((case.start - 1.0).abs() < 1e-12);
}

#[test]
fn a_start_by_approach_or_force_stays_where_the_gap_is_known() {
    for name in ["exact-sphere", "profile"] {
        let case = Case::new(&preset(name, &[])).unwrap();
        let known = case.problem.shape.largest_radius().unwrap();
        let exact = Exact::of(&case.problem);
        let s = 0.9 * case.start * case.units().length;
        for (key, value) in [("path.start_approach", exact.approach(s)), ("path.start_force", exact.force(s))]
        {
            let near = preset(name, &[("path.end_contact_radius", (0.01 * s).into()), (key, value.into())]);
            let found = Case::new(&near).unwrap().start * case.units().length;
            // The outermost of several contacts with this value, within the known range.
            assert!(found >= s * (1.0 - 1e-3) && found < known, "{name}, {key}: {found} {s}");
            let far = preset(
                name,
                &[("path.end_contact_radius", (0.01 * s).into()), (key, (1e4 * value.abs()).into())],
            );
            let refused = Case::new(&far).unwrap_err().to_string();
            assert!(refused.contains("the gap is known only up to the radius"), "{name}, {key}: {refused}");
        }
    }
}

#[test]
fn a_path_without_an_end_of_its_own_goes_on_to_the_last_contact() {
    // From soft spheres, whose pull-off is far out, to stiff ones, whose contact is tiny beside the start.
    for modulus in [1e4, 1e7, 1e10, 1e13, 1e16] {
        for control in ["displacement", "force", "stiffness=100"] {
            for (shape, end) in [("sphere", None), ("sphere", Some("0.3 mm")), ("exact-sphere", None)] {
                let text = format!(
                    "format = 1\nunits = \"SI\"\n[material]\neffective_modulus = {modulus}\nwork_of_adhesion = 0.05\n\
                     [gap]\nshape = \"{shape}\"\nradius_of_curvature = \"1 mm\"\n"
                );
                let mut preset = read("t", &text).unwrap();
                preset.assign("path.control", control).unwrap();
                if let Some(end) = end {
                    preset.assign("path.end_contact_radius", end).unwrap();
                }
                let report = PathReport::unload(&preset, Extent::default(), &Unwatched).unwrap();
                let is_apart = report.events.last().is_some_and(|event| event.after.is_none());
                let pull = report.totals.largest_pull.as_ref().map_or(0.0, |at| -at.force);
                let critical = 1.5 * std::f64::consts::PI * 0.05 * 1e-3;
                let told = format!("{modulus} {control} {shape}: {pull} {critical} {:?}", report.warnings);
                let is_early =
                    report.warnings.iter().any(|warning| warning.contains("would pull more further on"));
                assert_eq!(is_early, !is_apart, "{told}");
                if is_apart && shape == "sphere" {
                    assert!((pull / critical - 1.0).abs() < 1e-6, "{told}");
                }
                assert!(is_apart || end.is_some(), "{told}");
            }
        }
    }
}
