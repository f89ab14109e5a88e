//! The spectral basis through everything that computes for a person.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff::case::Case;
use pulloff::contact::Control;
use pulloff::preset::{Preset, Store};

/// A shipped preset in eigenfunctions.
fn preset(name: &str, assignments: &[&str]) -> Preset {
    // A folder that need not exist: the preset is a shipped one.
    let store = Store::at("presets", &[]);
    let all = [&["basis.kind=spectral"], assignments].concat();
    store.load(&store.resolve(name).unwrap(), &all).unwrap().preset
}

#[test]
fn trace_sweep_and_unloading_work_under_every_control() {
    let case = Case::new(&preset("fig-9", &[])).unwrap();
    assert!(case.warnings(case.start).is_empty());
    for control in [Control::Displacement, Control::Force, Control::Stiffness(0.15)] {
        let mut swept = case.sweep(|| true).unwrap();
        let mut traced = case.trace().unwrap();
        let (a, b) = (case.unload(&mut swept, control).unwrap(), case.unload(&mut traced, control).unwrap());
        assert_eq!(a.events.len(), b.events.len(), "{control}");
        for (a, b) in a.events.iter().zip(&b.events) {
            assert!((a.before.contact_radius - b.before.contact_radius).abs() < 1e-9, "{control}");
            assert!((a.before.force - b.before.force).abs() < 1e-10, "{control}");
        }
    }
}

#[test]
fn every_way_to_start_finds_the_same_state_with_an_automatic_number() {
    let s = 0.31;
    let here = Case::new(&preset("fig-8", &["path.start_contact_radius=0.31"])).unwrap();
    let at = here.basis.equilibrium(&here.reduced, s).unwrap();
    for (key, value) in [("path.start_approach", at.approach), ("path.start_force", at.force)] {
        let case = Case::new(&preset("fig-8", &[&format!("{key}={value:?}")])).unwrap();
        assert!((case.start - s).abs() < 1e-10, "{key}: {}", case.start);
        assert_eq!(case.basis.size(), here.basis.size(), "{key}");
    }
}

#[test]
fn too_few_functions_are_a_warning_and_too_many_waves_an_error_with_numbers() {
    let few = Case::new(&preset("fig-9", &["basis.functions=20"])).unwrap();
    let warning = &few.warnings(few.start)[0];
    assert!(warning.starts_with("20 functions are good for"), "{warning}");
    assert!(warning.contains("set basis.functions to"), "{warning}");
    let error = Case::new(&preset("fig-9", &["gap.wavelength=1e-5"])).unwrap_err().to_string();
    assert!(error.contains("50001 waves") && error.contains("4096 functions"), "{error}");
}
