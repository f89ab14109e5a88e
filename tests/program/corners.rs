//! Where the slope of the gap jumps, the equilibrium curve has a corner: traces land on it, manual steps stop there,
//! and it may be a limit point.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff::explorer::walk::{Action, Request, WalkOutcome, walk};
use pulloff::explorer::{CurveData, Staged};
use pulloff::store::Store;
use pulloff_engine::case::Case;
use pulloff_engine::preset::Preset;
use pulloff_engine::problem::Control;
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::path::PathSetting;
use pulloff_engine::quasistatic::walk::At;
use pulloff_engine::quasistatic::{CurveStop, EventKind};
use pulloff_engine::report::TraceReport;
use std::sync::Arc;

/// r²/2 with a corner of this height at r = 0.12.
fn preset(height: f64) -> Preset {
    let store = Store::at("presets", &[]);
    let formula = format!("gap.formula=r^2/2 + {height}*abs(r-0.12)");
    let set = [formula.as_str(), "material.work_of_adhesion=0.003", "path.start_contact_radius=0.6"]
        .map(str::to_owned);
    store.load(&store.resolve("formula").unwrap(), &set).unwrap().preset
}

#[test]
fn a_trace_lands_on_the_corner_and_goes_on_behind_it() {
    // Downward, the corner is a limit point; upward and slight, it is not, and the curve is stable on both sides.
    for height in [0.07, 0.01, -0.01] {
        let preset = preset(height);
        let case = Case::new(&preset).unwrap();
        let unit = case.units().length;
        let curve = case.curve(&Unwatched).unwrap();
        assert_eq!(curve.corners().len(), 1, "{height}");
        let (branch, stop) = case.trace(&curve, &Unwatched).unwrap();
        assert_eq!(stop, CurveStop::End, "{height}");
        let corner = curve.corners()[0];
        assert!((corner * unit - 0.12).abs() < 1e-15);
        let on_it = |s: f64| (s / corner - 1.0).abs() < 1e-12;
        let radii: Vec<f64> =
            branch.points.iter().map(|point| curve.equilibrium.contact_radius(point)).collect();
        assert_eq!(radii.iter().filter(|s| on_it(**s)).count(), 1, "{height}");
        assert!(radii.is_sorted_by(|a, b| a > b), "{height}");
        // Every point is on the curve, those next to the corner among them.
        for point in &branch.points {
            let [delta, force, s] = curve.equilibrium.quantities(point.y());
            let exact = case.basis.equilibrium(&case.reduced, s).unwrap();
            assert!((delta - exact.approach).abs() < 1e-9 * unit.recip(), "{height} {s}");
            assert!((force - exact.force).abs() < 1e-9, "{height} {s}");
        }
        let report = TraceReport::compute(&preset, &Unwatched).unwrap();
        let at = report.points.iter().find(|point| (point.contact_radius - 0.12).abs() < 1e-12).unwrap();
        // There are two slopes here, so none is given.
        assert!(at.tangent_stiffness.is_none() && at.area_slope.is_none() && at.contact_stiffness > 0.0);
    }
}

#[test]
fn a_limit_point_sits_on_the_corner() {
    let case = Case::new(&preset(0.07)).unwrap();
    let curve = case.curve(&Unwatched).unwrap();
    let unloading = case.unload(&curve, &PathSetting::one_disc(Control::Displacement), &Unwatched).unwrap();
    assert_eq!(unloading.events.len(), 1);
    let event = &unloading.events[0];
    let units = case.units();
    assert_eq!(event.kind, EventKind::LastContact);
    assert!((event.before.as_ref().unwrap().contact_radius * units.length - 0.12).abs() < 1e-15);
    assert!((event.before.as_ref().unwrap().approach * units.length + 0.046_354_616_716_3).abs() < 1e-12);
    for loss in [event.dissipated, event.dissipated_by_area].into_iter().flatten() {
        assert!((loss * units.energy / 1.026_780_252_15e-4 - 1.0).abs() < 1e-9, "{loss}");
    }
    assert!(curve.limit_points(Control::Displacement).iter().any(|limit| limit.corner));
}

/// The radii of a manual walk from the start inward or, with `back`, from far inside outward.
fn walked(preset: &Preset, back: bool) -> (Vec<f64>, WalkOutcome, f64) {
    let curve = Arc::new(CurveData::compute(preset, &Staged::unwatched()).unwrap());
    let drawn = &curve.base.curve;
    let corner = drawn.corners()[0];
    let from = if back { 0.94 * corner } else { 1.3 * corner };
    let request = Request {
        id: 0,
        action: Action::Steps(5),
        from: drawn.equilibrium.explicit(from),
        on_path: None,
        at: At::Nothing,
        control: curve.case.control,
        inward: !back,
        length: 0.02,
        curve: Arc::clone(&curve),
        pace: None,
    };
    let mut radii = Vec::new();
    let outcome = walk(&request, &mut |made| {
        radii.push(made.state.contact_radius);
        true
    });
    (radii, outcome, corner)
}

#[test]
fn a_step_by_hand_ends_on_the_corner_and_the_next_begins_behind_it() {
    for back in [false, true] {
        // No limit point: the steps continue behind it.
        let (radii, outcome, corner) = walked(&preset(0.003), back);
        assert_eq!(outcome, WalkOutcome::Done, "{back}: {radii:?}");
        let at = radii.iter().position(|s| (s / corner - 1.0).abs() < 1e-13);
        assert!(at.is_some_and(|at| at + 1 < radii.len()), "{back}: {radii:?} {corner}");
        let inward = |a: &f64, b: &f64| a > b;
        assert!(if back { radii.is_sorted() } else { radii.is_sorted_by(inward) }, "{back}: {radii:?}");
    }
    // A limit point of the control: the walk stops there.
    let (radii, outcome, corner) = walked(&preset(0.07), false);
    assert_eq!(outcome, WalkOutcome::AtLimit);
    assert!((radii.last().unwrap() / corner - 1.0).abs() < 1e-13, "{radii:?}");
}
