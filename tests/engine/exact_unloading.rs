//! The exact quasi-static path against reference tables made by another program, and against closed forms.
//!
//! `tests/data/fig8.json` and `fig9.json` hold limit points, jumps and losses under three controls, accurate to 1e-13.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff_engine::gap::Shape;
use pulloff_engine::problem::{Control, Problem};
use pulloff_engine::theory::Exact;
use pulloff_engine::theory::jkr::Jkr;
use pulloff_engine::theory::unloading::{INWARD_REACH, limit_points, unload};
use serde_json::Value;
use std::sync::Arc;

struct Case {
    data: Value,
    problem: Problem,
    start: f64,
}

fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().unwrap()
}

fn cases() -> [Case; 2] {
    [include_str!("../data/fig8.json"), include_str!("../data/fig9.json")].map(|text| {
        let data: Value = serde_json::from_str(text).unwrap();
        let profile = &data["case"]["profile"];
        let problem = Problem {
            effective_modulus: 1.0,
            work_of_adhesion: number(&data["case"], "w"),
            shape: Shape::WavySphere {
                radius_of_curvature: number(profile, "R"),
                amplitude: number(profile, "A"),
                wavelength: number(profile, "lambda"),
            },
        };
        let start = number(&data["case"], "a_start");
        Case { data, problem, start }
    })
}

fn controls(case: &Case) -> Vec<Control> {
    case.data["control"].as_object().unwrap().keys().map(|key| key.parse().unwrap()).collect()
}

#[test]
fn limit_points_and_jumps_are_those_of_the_reference() {
    for case in cases() {
        let closed = Exact::of(&case.problem);
        let numerical =
            Exact::by_quadrature(1.0, case.problem.work_of_adhesion, Arc::new(case.problem.shape.clone()));
        for control in controls(&case) {
            let exact = &case.data["control"][control.to_string()];
            for disc in [&closed, &numerical] {
                let close = |ours: f64, row: &Value, key: &str| {
                    assert!((ours - number(row, key)).abs() <= 2e-13, "{control} {key}: {ours} {row}");
                };
                let limits = limit_points(&**disc, control, case.start, INWARD_REACH * case.start);
                // The table runs outward.
                let table = exact["limit_points"].as_array().unwrap();
                assert_eq!(limits.len(), table.len(), "{control}");
                for (ours, row) in limits.iter().rev().zip(table) {
                    assert_eq!(ours.minimum, row["type"] == "min", "{control}");
                    close(ours.state.contact_radius, row, "s");
                    close(ours.state.approach, row, "delta");
                    close(ours.state.force, row, "P");
                }
                let path = unload(&**disc, control, case.start).unwrap();
                assert_eq!(path.start.contact_radius.to_bits(), case.start.to_bits());
                let table = exact["unloading"].as_array().unwrap();
                assert_eq!(path.jumps.len(), table.len(), "{control}");
                for (jump, row) in path.jumps.iter().zip(table) {
                    let snap = row["kind"] == "snap";
                    assert_eq!(jump.after.is_some(), snap, "{control}");
                    close(jump.before.contact_radius, row, "s_from");
                    close(jump.before.force, row, "P_from");
                    close(jump.before.approach, row, if snap { "delta_from" } else { "delta" });
                    if let Some(after) = jump.after {
                        close(after.contact_radius, row, "s_to");
                        close(after.approach, row, "delta_to");
                        close(after.force, row, "P_to");
                        let held = control.value(after.approach, after.force);
                        assert!((held - jump.control_value).abs() <= 2e-14);
                    }
                    assert_eq!(jump.dissipated.is_none(), row["dissipated"].is_null(), "{control}");
                    if let Some(loss) = jump.dissipated {
                        let reference = number(row, "dissipated");
                        assert!((loss / reference - 1.0).abs() <= 1e-8, "{control}: {loss} {reference}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_jkr_sphere_pulls_off_where_its_closed_form_says() {
    let jkr = Jkr { effective_modulus: 2.0, work_of_adhesion: 0.01, radius_of_curvature: 3.0 };
    for (control, radius) in
        [(Control::Displacement, jkr.fixed_grips_radius()), (Control::Force, jkr.pull_off_radius())]
    {
        let path = unload(&jkr, control, 1.0).unwrap();
        let [jump] = path.jumps[..] else { unreachable!("{control}") };
        assert!((jump.before.contact_radius / radius - 1.0).abs() < 1e-14, "{control}");
        assert_eq!(jump.after, None);
        assert_eq!(jump.dissipated, (control == Control::Displacement).then_some(jump.before.energy));
    }
}

#[test]
fn without_adhesion_a_smooth_sphere_has_no_jump() {
    let hertz = Jkr { effective_modulus: 2.0, work_of_adhesion: 0.0, radius_of_curvature: 3.0 };
    for control in [Control::Displacement, Control::Force, Control::Stiffness(0.1)] {
        assert!(unload(&hertz, control, 1.0).unwrap().jumps.is_empty(), "{control}");
    }
}

#[test]
fn an_unstable_start_runs_outward_at_constant_control() {
    let [_, case] = cases();
    let disc = Exact::of(&case.problem);
    for control in controls(&case) {
        // Between a minimum and the next maximum inward.
        let limits = limit_points(&*disc, control, case.start, 0.2);
        let at = limits.iter().position(|limit| limit.minimum).unwrap();
        let asked = 0.5 * (limits[at].state.contact_radius + limits[at + 1].state.contact_radius);
        let path = unload(&*disc, control, asked).unwrap();
        assert!(path.start.contact_radius > limits[at].state.contact_radius, "{control}");
        let value = |s: f64| control.value(disc.approach(s), disc.force(s));
        assert!((value(path.start.contact_radius) - value(asked)).abs() < 1e-14, "{control}");
        let (approach, force) = disc.slopes(path.start.contact_radius);
        assert!(control.value(approach, force) > 0.0, "{control}");
        // The first jump starts from exactly that minimum.
        let radius = path.jumps[0].before.contact_radius;
        assert!((radius - limits[at].state.contact_radius).abs() < 1e-12, "{control}");
    }
}

#[test]
fn where_nothing_outward_is_stable_there_is_no_path() {
    // An infinite flat punch: only adhesion acts, and the control falls with s without end.
    #[derive(Debug)]
    struct Flat;
    impl pulloff_engine::gap::Gap for Flat {
        fn jet(&self, _: f64) -> pulloff_engine::gap::Jet {
            pulloff_engine::gap::Jet::default()
        }
        fn feature_length(&self) -> Option<f64> {
            None
        }
        fn reference_length(&self) -> f64 {
            1.0
        }
    }
    let flat = Exact::by_quadrature(1.0, 0.01, Arc::new(Flat));
    assert_eq!(unload(&*flat, Control::Displacement, 0.1), None);
}
