//! The loading device in the explorer: its stiffness is a knob that does not compute the curve again.

use crate::support::session::Session;
use pulloff::explorer::device::line;
use pulloff::explorer::{Axes, Command, CurveData, Effect, Id, NodeKind, Staged, update};
use pulloff_engine::problem::Control;
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::PathState;
use std::sync::Arc;

fn curve(session: &Session) -> Arc<CurveData> {
    session.model.curve.clone().expect("a curve")
}

fn on_control_knob(preset: &str) -> Session {
    let mut session = Session::new(preset);
    let knobs = session.model.knobs();
    session.model.parameter = knobs.iter().position(|(row, _)| row.key == "path.control").expect("a knob");
    session
}

fn radii(curve: &CurveData) -> Vec<f64> {
    curve.limits.iter().map(|limit| limit.contact_radius).collect()
}

/// Everything that depends on the control is as if the whole curve had been computed for it.
fn assert_as_computed_afresh(session: &Session) {
    let fresh = CurveData::compute(&session.model.preset, &Staged::unwatched()).expect("a curve");
    let (ours, fresh) = (curve(session), fresh.checked(&Unwatched).expect("not stopped"));
    assert_eq!(ours.case.control, fresh.case.control);
    assert_eq!(radii(&ours), radii(&fresh));
    assert_eq!(ours.points, fresh.points);
    assert_eq!(ours.other_limits, fresh.other_limits);
    assert_eq!(ours.unloading, fresh.unloading);
    assert_eq!(ours.report, fresh.report);
}

#[test]
fn turning_the_stiffness_moves_limit_points_and_events_and_sweeps_nothing_again() {
    let mut session = on_control_knob("wavy-sphere");
    let base = Arc::clone(&curve(&session).base);
    let displacement = radii(&curve(&session));
    let mut ends = Vec::new();
    let mut limits = Vec::new();
    for turn in 0..60 {
        let effects = update(&mut session.model, Id::MuchLess.into());
        let [Effect::Curve(wish)] = effects.as_slice() else { panic!("{effects:?}") };
        assert!(wish.base.as_ref().is_some_and(|known| Arc::ptr_eq(known, &base)));
        session.driver.settle(&mut session.model, effects);
        assert!(Arc::ptr_eq(&curve(&session).base, &base));
        assert!(!session.model.is_computing());
        if turn % 11 == 0 {
            assert_as_computed_afresh(&session);
        }
        limits.push(radii(&curve(&session)));
        ends.push(session.model.preset.path.control);
        if session.model.preset.path.control == Control::Force {
            break;
        }
    }
    // At the stiff end the limit points are nearly those of displacement; in between they differ.
    let near =
        |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 5e-3 * a);
    assert!(near(&limits[0], &displacement));
    assert!(!near(&limits[limits.len() / 2], &displacement));
    assert_eq!(ends.last(), Some(&Control::Force));
    assert!(near(&limits[limits.len() - 2], limits.last().unwrap()));
    // Another problem is another curve, whatever was changed before.
    session.set("gap.amplitude", "0.003");
    assert!(!Arc::ptr_eq(&curve(&session).base, &base));
    assert_as_computed_afresh(&session);
}

#[test]
fn the_walker_stays_and_its_flags_follow_the_device() {
    let mut session = on_control_knob("wavy-sphere");
    session.does(Id::NextEvent);
    let (state, nodes) = (session.radius(), session.model.history.nodes().len());
    assert!(session.status().starts_with("Event 1 of"), "{}", session.status());
    // With a device softer than fixed grips, the same state is past its limit point: unstable.
    session.set("path.control", "0.15");
    assert_eq!(session.model.preset.path.control, Control::Stiffness(0.15));
    assert_eq!((session.radius(), session.model.history.nodes().len()), (state, nodes));
    assert!(session.status().starts_with("Off the path, unstable under spring"), "{}", session.status());
    assert!(session.model.can_jump());
    session.set("path.control", "displacement");
    assert!(session.status().starts_with("Event 1 of"), "{}", session.status());
    // A limit point of the spring is located for the spring.
    session.set("path.control", "stiffness=0.15").does(Id::Restart).does(Id::NextEvent);
    assert!(session.radius() > state);
    session.does(Id::Less);
    assert!(session.model.can_jump());
    assert_eq!(session.model.limit_number(), None);
    session.does(Id::Jump);
    assert!(matches!(session.kind(), NodeKind::Jump(_)));
}

#[test]
fn a_stiffness_is_turned_and_ends_where_it_is_softest() {
    let mut session = on_control_knob("fig-8");
    session.set("path.control", "0.31").does(Id::More);
    assert_eq!(session.model.preset.path.control, Control::Stiffness(0.32));
    // At an end of the range the knob says so.
    session.set("path.control", "force").does(Id::Less);
    assert!(session.status().contains("softest"), "{}", session.status());
}

#[test]
fn an_outward_jump_is_announced_as_an_inward_one_is() {
    let mut session = Session::new("wavy-sphere");
    session.all(&[Id::NextEvent, Id::Jump, Id::NextEvent, Id::Jump, Id::Reverse, Id::NextEvent]);
    let status = session.status();
    assert!(status.contains("jump lets the edge snap to crest") && status.contains("(loses "), "{status}");
    let ahead = session.model.history.current().unwrap().ahead.unwrap();
    session.does(Id::Jump);
    let NodeKind::Jump(event) = session.kind() else { panic!() };
    assert_eq!(
        (event.after.as_ref().map(PathState::state), event.dissipated),
        (ahead.after, ahead.dissipated)
    );
    assert!(event.after.as_ref().unwrap().contact_radius > event.before.as_ref().unwrap().contact_radius);
    // And the pull-off under a dead load, whose loss has no bound.
    session.set("path.control", "force");
    for _ in 0..20 {
        session.model.inward = true;
        session.does(Id::NextEvent);
        if session.status().contains("come apart") {
            break;
        }
        session.does(Id::Jump);
    }
    assert!(session.status().contains("lets the bodies come apart; step goes on"), "{}", session.status());
}

#[test]
fn the_line_of_the_device_has_its_slope_and_ends_at_the_landing() {
    let mut session = Session::new("wavy-sphere");
    session.does(pulloff::explorer::Command::Steps(3));
    assert_eq!(line(&session.model), None);
    session.does(pulloff::explorer::Command::Overlay(pulloff::explorer::Overlay::Device));
    let [from, to] = line(&session.model).unwrap();
    assert!((from.0 - to.0).abs() <= f64::EPSILON && from.1 < to.1);
    session
        .does(pulloff::explorer::Command::Overlay(pulloff::explorer::Overlay::Device))
        .set("path.control", "force");
    assert_eq!(line(&session.model), None);
    session.does(pulloff::explorer::Command::Overlay(pulloff::explorer::Overlay::Device));
    let [from, to] = line(&session.model).unwrap();
    assert!(from.0 < to.0 && (from.1 - to.1).abs() <= f64::EPSILON);

    let mut session = Session::new("wavy-sphere");
    session.set("path.control", "0.3").does(pulloff::explorer::Command::Steps(3));
    let slope = |[from, to]: [(f64, f64); 2]| (to.1 - from.1) / (to.0 - from.0);
    let across = line(&session.model).unwrap();
    assert!((slope(across) / -0.3 - 1.0).abs() < 1e-9, "{across:?}");
    let points = &curve(&session).points;
    for (delta, force) in across {
        assert!(
            points.iter().any(|p| p.approach <= delta + 1e-9)
                && points.iter().any(|p| p.approach >= delta - 1e-9)
        );
        assert!(
            points.iter().any(|p| p.force <= force + 1e-9) && points.iter().any(|p| p.force >= force - 1e-9)
        );
    }
    session.does(Id::NextEvent);
    let ends = line(&session.model).unwrap();
    assert!((slope(ends) / -0.3 - 1.0).abs() < 1e-6, "{ends:?}");
    let event = session.model.path_events()[0].clone();
    assert!((ends[0].0 - event.before.as_ref().unwrap().approach).abs() < 1e-9);
    assert!((ends[1].0 - event.after.as_ref().unwrap().approach).abs() < 1e-9);
    assert!((ends[1].1 - event.after.as_ref().unwrap().force).abs() < 1e-9);
    session.does(pulloff::explorer::Command::Overlay(pulloff::explorer::Overlay::Device));
    assert_eq!(line(&session.model), None);
}

#[test]
fn a_curve_can_be_given_up_and_undo_takes_the_values_back() {
    let mut session = Session::new("wavy-sphere");
    let shown = curve(&session);
    // Requested, but not there yet.
    let late = update(&mut session.model, Id::MuchMore.into());
    let effects = update(&mut session.model, Id::Cancel.into());
    assert!(matches!(effects.as_slice(), [Effect::StopCurve(id)] if *id == session.model.curve_wanted));
    assert!(session.status().starts_with("cancelled"), "{}", session.status());
    assert!(!session.model.is_computing() && session.model.is_unsaved());
    // A late answer is not wanted.
    session.driver.settle(&mut session.model, late);
    assert!(Arc::ptr_eq(&curve(&session), &shown));
    session.does(Id::Axes);
    assert_eq!(session.model.axes, Axes::Raw);
    assert!(session.status().contains("undo restores its values"), "{}", session.status());
    session.does(Id::Undo);
    assert!(!session.model.is_unsaved());
    assert!(Arc::ptr_eq(&curve(&session), &shown));
    assert_eq!(session.status(), "undone: A 0.003 → 0.0025");
    // A control change given up leaves everything as before.
    let force = Command::Set { key: "path.control".into(), text: "force".to_owned() };
    let late = update(&mut session.model, force);
    session.does(Id::Cancel);
    session.driver.settle(&mut session.model, late);
    assert!(!session.model.is_unsaved());
    assert_eq!(session.model.control(), Some(Control::Displacement));
    // Values changed back before their curve has come need no curve.
    update(&mut session.model, Id::MuchMore.into());
    let effects = update(&mut session.model, Id::Undo.into());
    assert!(matches!(effects.as_slice(), [Effect::StopCurve(_)]), "{effects:?}");
}
