//! The paper's wavy spheres against the exact solution.
//!
//! `tests/data/fig8.json` and `fig9.json` hold the exact curve (Sneddon/Abel), its limit points and the quasi-static
//! unloading under three controls, accurate to 1e-13, and the range of each column of the curve.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use crate::support::presets::reference;
use pulloff_engine::disc::{Basis, ExactBasis};
use pulloff_engine::problem::{Control, Problem};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::path::{PathSetting, unload};
use pulloff_engine::quasistatic::{Curve, EventKind};
use pulloff_engine::ritz::Rings;
use serde_json::Value;
use std::sync::Arc;

struct Case {
    data: Value,
    problem: Problem,
    start: f64,
}

fn case(text: &str) -> Case {
    let (data, problem) = reference(text);
    let start = data["case"]["a_start"].as_f64().unwrap();
    Case { data, problem, start }
}

fn fig8() -> Case {
    case(include_str!("../data/fig8.json"))
}

fn fig9() -> Case {
    case(include_str!("../data/fig9.json"))
}

fn rings(number: usize) -> Arc<dyn Basis> {
    Rings::shared(number).unwrap()
}

/// The largest errors of an unloading: states relative to the range of their column, losses relative.
fn errors(case: &Case, control: Control, basis: Arc<dyn Basis>) -> (f64, f64) {
    let curve = Curve::of(case.problem.reduced(), basis, case.start, 0.004 * case.start).unwrap();
    let ours = unload(&curve, &PathSetting::one_disc(control), &Unwatched).unwrap();
    let exact = case.data["control"][control.to_string()]["unloading"].as_array().unwrap();
    assert_eq!(ours.events.len(), exact.len(), "{control}");
    let range = |column: &str| case.data["range"][column].as_f64().unwrap();
    let (mut state_error, mut loss_error) = (0.0_f64, 0.0_f64);
    for (event, exact) in ours.events.iter().zip(exact) {
        let snap = exact["kind"] == "snap";
        assert_eq!(event.kind == EventKind::Snap, snap);
        let number = |key: &str| exact[key].as_f64().unwrap();
        let mut compare = |ours: f64, exact: f64, column: &str| {
            state_error = state_error.max((ours - exact).abs() / range(column));
        };
        compare(event.before.as_ref().unwrap().contact_radius, number("s_from"), "contact_radius");
        compare(event.before.as_ref().unwrap().force, number("P_from"), "force");
        if snap {
            let after = event.after.as_ref().unwrap();
            compare(event.before.as_ref().unwrap().approach, number("delta_from"), "approach");
            compare(after.contact_radius, number("s_to"), "contact_radius");
            compare(after.approach, number("delta_to"), "approach");
            compare(after.force, number("P_to"), "force");
        } else {
            assert_eq!(event.after, None);
            compare(event.before.as_ref().unwrap().approach, number("delta"), "approach");
        }
        match exact["dissipated"].as_f64() {
            None => assert_eq!(event.dissipated, None),
            Some(loss) => {
                let ours = event.dissipated.unwrap();
                loss_error = loss_error.max((ours / loss - 1.0).abs());
                let area = event.dissipated_by_area.unwrap();
                assert!((area / ours - 1.0).abs() < 1e-6, "{control}: {area} {ours}");
            }
        }
    }
    let min_force = case.data["min_force"].as_f64().unwrap();
    let min_approach = case.data["min_approach"].as_f64().unwrap();
    match control {
        Control::Force => {
            assert!((ours.largest_pull().unwrap().force - min_force).abs() < 1e-3 * range("force"));
        }
        Control::Displacement => {
            assert!((ours.farthest().unwrap().approach - min_approach).abs() < 1e-3 * range("approach"));
        }
        Control::Stiffness(_) => {}
    }
    (state_error, loss_error)
}

fn controls(case: &Case) -> Vec<Control> {
    case.data["control"].as_object().unwrap().keys().map(|key| key.parse().unwrap()).collect()
}

#[test]
fn unloading_agrees_with_the_exact_solution() {
    for (case, name) in [(fig8(), "fig8"), (fig9(), "fig9")] {
        for control in controls(&case) {
            // The losses of Fig. 8's snaps are tiny differences near a cusp (the smallest is 1.5e-7): the rings'
            // first-order error leaves 0.41 % and 0.11 % of them at N = 800, and halves with every doubling of N.
            let fine_loss = if name == "fig8" { 5e-3 } else { 1e-3 };
            for (rings, state_bound, loss_bound) in [(200, 1e-3, 1e-2), (800, 3e-4, fine_loss)] {
                let (state, loss) = errors(&case, control, self::rings(rings));
                println!(
                    "{name} {control} {rings} rings: states {state:.1e} of the range, losses {loss:.1e}"
                );
                assert!(
                    state < state_bound,
                    "{name} {control} {rings} rings: states off by {state:.2e} of the range"
                );
                assert!(loss < loss_bound, "{name} {control} {rings} rings: losses off by {loss:.2e}");
            }
        }
    }
}

#[test]
fn seven_snaps_and_a_pull_off_under_displacement_control_four_under_force() {
    let case = fig9();
    for (control, snaps) in [(Control::Displacement, 7), (Control::Force, 4)] {
        let exact = case.data["control"][control.to_string()]["unloading"].as_array().unwrap();
        assert_eq!(exact.len(), snaps + 1);
        errors(&case, control, rings(200));
    }
}

#[test]
fn the_exact_basis_gives_curve_events_and_losses_to_rounding() {
    for (case, name) in [(fig8(), "fig8"), (fig9(), "fig9")] {
        let basis: Arc<dyn Basis> = Arc::new(ExactBasis::of(&case.problem.reduced(), case.start).unwrap());
        for control in controls(&case) {
            let (state, loss) = errors(&case, control, Arc::clone(&basis));
            println!("{name} {control}: states {state:.1e}, losses {loss:.1e}");
            assert!(state < 1e-10, "{name} {control}: states off by {state:.2e} of the range");
            assert!(loss < 1e-8, "{name} {control}: losses off by {loss:.2e}");
        }
    }
}

#[test]
fn the_exact_basis_gives_the_curve_and_every_limit_point() {
    for (case, name) in [(fig8(), "fig8"), (fig9(), "fig9")] {
        let problem = case.problem.reduced();
        let basis: Arc<dyn Basis> = Arc::new(ExactBasis::of(&problem, case.start).unwrap());
        let range = |column: &str| case.data["range"][column].as_f64().unwrap();
        let number = |row: &Value, key: &str| row[key].as_f64().unwrap();
        let mut worst = 0.0_f64;
        for row in case.data["curve"].as_array().unwrap() {
            // s, δ, P, U.
            let [s, approach, force, energy]: [f64; 4] = serde_json::from_value(row.clone()).unwrap();
            let ours = basis.equilibrium(&problem, s).unwrap();
            worst = worst.max((ours.approach - approach).abs() / range("approach"));
            worst = worst.max((ours.force - force).abs() / range("force"));
            let size = range("approach") * range("force");
            worst = worst.max((ours.energy - energy).abs() / size);
        }
        println!("{name} curve: {worst:.1e} of the range");
        assert!(worst < 1e-12, "{name}: the curve is off by {worst:.1e} of the range");

        let end = 0.004 * case.start;
        let curve = Curve::of(problem.clone(), Arc::clone(&basis), case.start, end).unwrap();
        for control in controls(&case) {
            let exact = case.data["control"][control.to_string()]["limit_points"].as_array().unwrap();
            let ours = curve.limit_points(control);
            assert_eq!(ours.len(), exact.len(), "{name} {control}");
            let mut worst = 0.0_f64;
            // The table runs outward, our curve inward.
            for (limit, exact) in ours.iter().rev().zip(exact) {
                let off =
                    |ours: f64, key: &str, column: &str| (ours - number(exact, key)).abs() / range(column);
                worst = worst.max(off(limit.approach, "delta", "approach"));
                worst = worst.max(off(limit.force, "P", "force"));
                worst = worst.max(off(limit.contact_radius, "s", "contact_radius"));
            }
            println!("{name} {control} limit points: {worst:.1e} of the range");
            assert!(worst < 1e-10, "{name} {control}: limit points off by {worst:.1e} of the range");
        }
    }
}
