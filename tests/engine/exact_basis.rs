//! The exact basis through everything that computes for the user.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff::store::Store;
use pulloff_engine::case::Case;
use pulloff_engine::disc::Order;
use pulloff_engine::preset::Preset;
use pulloff_engine::problem::Control;
use pulloff_engine::progress::Unwatched;
use pulloff_engine::ritz::{NewtonSettings, solve};
use pulloff_engine::theory::Exact;
use std::cell::Cell;

/// A shipped preset in the exact basis.
fn preset(name: &str, assignments: &[&str]) -> Preset {
    // The folder need not exist: the preset is a shipped one.
    let store = Store::at("presets", &[]);
    let all = [&["basis.kind=exact"], assignments].concat();
    store.load(&store.resolve(name).unwrap(), &all).unwrap().preset
}

#[test]
fn every_way_to_start_finds_the_same_state() {
    let s = 0.31;
    let here = Case::new(&preset("fig-8", &["path.start_contact_radius=0.31"])).unwrap();
    let at = here.basis.equilibrium(&here.reduced, s).unwrap();
    for (key, value) in [("path.start_approach", at.approach), ("path.start_force", at.force)] {
        let case = Case::new(&preset("fig-8", &[&format!("{key}={value:?}")])).unwrap();
        assert!((case.start - s).abs() < 1e-10, "{key}: {}", case.start);
    }
}

/// Hertz: δ = s²/R and P = 4E*s³/(3R), with E* = R = 1.
#[test]
fn without_adhesion_every_way_gives_hertz_to_rounding() {
    let case = Case::new(&preset("fig-3-jkr", &["material.work_of_adhesion=0"])).unwrap();
    let check = |way: &str, [approach, force, s]: [f64; 3]| {
        assert!((approach / (s * s) - 1.0).abs() < 1e-12, "{way}: s = {s}, approach {approach}");
        assert!((force / (4.0 / 3.0 * s.powi(3)) - 1.0).abs() < 1e-12, "{way}: s = {s}, force {force}");
    };
    let curve = case.curve(&Unwatched).unwrap();
    assert!(curve.samples.len() > 100);
    for at in &curve.samples {
        check("curve", [at.approach, at.force, at.contact_radius]);
    }
    for s in [0.01_f64, 0.1, 0.4] {
        for (control, value) in [(Control::Displacement, s * s), (Control::Force, 4.0 / 3.0 * s.powi(3))] {
            let found =
                solve(case.basis.as_ref(), &case.reduced, control, value, 3.0 * s, NewtonSettings::default());
            let at = found.unwrap().evaluation;
            assert!((at.contact_radius / s - 1.0).abs() < 1e-12, "{control}: {} for {s}", at.contact_radius);
            check(&control.to_string(), [at.approach, at.force, at.contact_radius]);
        }
    }
}

#[test]
fn a_dense_curve_is_the_exact_one() {
    let case = Case::new(&preset("fig-9", &[])).unwrap();
    let radii: Vec<f64> = (0..2000).map(|i| 0.5 - 0.498 * f64::from(i) / 1999.0).collect();
    let ours = case.basis.equilibria(&case.reduced, &radii, Order::State, &Unwatched);
    assert_eq!(ours.len(), radii.len());
    let exact = Exact::of(&case.problem);
    let units = case.units();
    let mut columns = [[f64::INFINITY, f64::NEG_INFINITY, 0.0]; 2];
    for (e, s) in ours.iter().zip(&radii) {
        let s = s * units.length;
        let truth = [exact.approach(s), exact.force(s)];
        for ((column, ours), exact) in
            columns.iter_mut().zip([e.approach * units.length, e.force * units.force]).zip(truth)
        {
            let [lo, hi, worst] = *column;
            *column = [lo.min(exact), hi.max(exact), worst.max((ours - exact).abs())];
        }
    }
    for [lo, hi, worst] in columns {
        println!("off by {:.1e} of the range", worst / (hi - lo));
        assert!(worst < 1e-12 * (hi - lo), "off by {:.1e} of the range", worst / (hi - lo));
    }
    // The equilibria are computed in one call that can be given up between points.
    let asked = Cell::new(0);
    let few = case.basis.equilibria(&case.reduced, &radii, Order::State, &|| {
        asked.set(asked.get() + 1);
        asked.get() > 7
    });
    // Up to eight at a time.
    assert!(
        (7..=56).contains(&few.len())
            && few.iter().zip(&ours).all(|(few, all)| few.approach.to_bits() == all.approach.to_bits())
    );
}
