//! Walks along the path of the device, where the states lie on no single curve: an edge that rests between two works of
//! adhesion, and adhesion with a range.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::session::Session;
use pulloff::explorer::log::EventMark;
use pulloff::explorer::{Command, Id, Node, NodeKind, View};
use pulloff::figure::{Figure, Role, Subject};
use pulloff_engine::quasistatic::EventKind;

type Set = [(&'static str, &'static str)];

const RESTS: &Set = &[("material.closing_work_of_adhesion", "0.002")];
const RESTS_AFTER_LOADING: &Set = &[
    ("material.closing_work_of_adhesion", "0.002"),
    ("path.begin", "apart"),
    ("path.turn_approach", "0.05"),
];
const RANGE: &Set = &[("material.adhesion", "dugdale"), ("material.cohesive_strength", "1")];
const RANGE_FROM_APART: &Set = &[
    ("material.adhesion", "dugdale"),
    ("material.cohesive_strength", "1"),
    ("path.begin", "apart"),
    ("path.turn_approach", "0.02"),
];

fn session(set: &Set) -> Session {
    let mut session = Session::with("fig-9-cycle", &["path.begin=disc"]);
    for (key, value) in set {
        session.set(key, value);
    }
    session.does(Id::Restart);
    session
}

/// Walks until the bodies are apart; returns the number of events.
fn to_the_end(session: &mut Session) -> usize {
    let mut events = 0;
    while !session.model.history.current().unwrap().is_apart() {
        session.does(Id::NextEvent);
        events += 1;
        assert!(events < 60, "{}", session.status());
    }
    events
}

#[test]
fn every_event_of_the_path_is_walked_once_and_none_besides() {
    for set in [RESTS, RESTS_AFTER_LOADING, RANGE, RANGE_FROM_APART] {
        let mut session = session(set);
        to_the_end(&mut session);
        let log = session.model.log();
        let path = session.model.path().unwrap();
        let done = log.entries.iter().filter(|entry| entry.mark == EventMark::Done && entry.number.is_some());
        assert_eq!((done.count(), log.entries.len()), (path.events.len(), path.events.len()), "{set:?}");
        // The losses on the walk equal those of the path; each is summed separately.
        let (lost, all) = (log.lost().0, path.totals.dissipated.unwrap());
        assert!((lost - all).abs() <= 1e-9 * all, "{set:?}: {lost} {all}");
        // A walk can go only one way, and says so.
        let walk = session.model.history.path();
        let numbers: Vec<usize> = walk.iter().map(|(_, node)| node.on_path.unwrap()).collect();
        assert!(numbers.windows(2).all(|pair| pair[0] <= pair[1]), "{set:?}: {numbers:?}");
        assert!(session.model.inward, "{set:?}");
        // What the device holds is reported as held.
        let is_held = |node: &Node| node.kind == NodeKind::Limit || node.stability.under(node.control);
        assert!(walk.iter().all(|(_, node)| node.is_apart() || is_held(node)), "{set:?}");
    }
}

#[test]
fn an_edge_that_rests_answers_as_the_contact_does_until_its_g_is_that_of_opening() {
    let mut session = session(RESTS);
    let start = session.model.walker().unwrap();
    let (s, state) = (start.state.contact_radius, start.state);
    // While the edge is held, dP/dδ is 2E*s (E* = 1), and no area opens.
    assert!((start.stiffness.tangent - 2.0 * s).abs() <= 1e-12 * s && start.stiffness.area_slope == 0.0);
    assert!(start.stability.under(start.control));
    session.does(Id::NextEvent);
    let NodeKind::Jump(event) = session.kind() else { panic!("{:?}", session.kind()) };
    assert_eq!(event.kind, EventKind::Depin);
    let free = session.model.walker().unwrap().state;
    assert_eq!(free.contact_radius.to_bits(), s.to_bits());
    let slope = (free.force - state.force) / (free.approach - state.approach);
    assert!((slope - 2.0 * s).abs() <= 1e-9 * s, "{slope} {s}");
    assert!(session.status().contains("the resting edge"), "{}", session.status());
}

#[test]
fn a_walk_along_a_path_is_kept_resumed_and_replayed() {
    for set in [RESTS_AFTER_LOADING, RANGE_FROM_APART] {
        let mut session = session(set);
        session.all(&[Id::NextEvent, Id::NextEvent, Id::NextEvent]);
        session.does(Command::Steps(2));
        let last = session.model.walker().unwrap().clone();
        let lines = session.model.script().unwrap();
        session.resume();
        let back = session.model.walker().unwrap();
        assert_eq!((back.state, back.on_path), (last.state, last.on_path), "{set:?}");
        assert_eq!(back.stability.under(back.control), last.stability.under(last.control));
        to_the_end(&mut session);
        let mut again = Session::new("fig-9-cycle");
        for line in &lines {
            again.does(pulloff::explorer::script::parse(line).unwrap().unwrap());
        }
        assert_eq!(again.model.walker().unwrap().state, last.state, "{lines:?}");
    }
}

#[test]
fn steps_wait_for_a_jump_and_the_way_is_not_turned_round() {
    let mut session = session(RANGE);
    while session.kind() != NodeKind::Limit {
        session.does(Id::NextEvent);
    }
    let here = session.model.walker().unwrap().state;
    session.does(Id::Step);
    assert_eq!(session.model.walker().unwrap().state, here);
    assert!(session.status().contains("after the jump"), "{}", session.status());
    session.does(Id::Reverse);
    assert!(
        session.model.inward && session.status().contains("begin = apart walks the whole loop"),
        "{}",
        session.status()
    );
    session.does(Id::Jump);
    assert!(session.model.walker().unwrap().state.contact_radius < here.contact_radius);
    session.does(Id::Undo);
    assert_eq!(session.model.walker().unwrap().state, here);
}

/// Under another control the bodies touch first elsewhere: a loop begins anew, and counts no energy that was not lost.
#[test]
fn a_loop_under_another_control_begins_where_that_touches_first() {
    for control in ["force", "stiffness=0.1"] {
        let mut session = Session::new("fig-9-cycle");
        let rigid = session.model.walker().unwrap().state;
        session.does(pulloff::explorer::script::parse(&format!("control {control}")).unwrap().unwrap());
        let fresh = Session::with("fig-9-cycle", &[&format!("path.control={control}")]);
        let [here, there] = [&session, &fresh].map(|session| session.model.walker().unwrap());
        assert_ne!(here.state, rigid, "{control}");
        assert_eq!((here.state, here.on_path), (there.state, there.on_path), "{control}");
        let lost = |session: &Session| session.model.log().lost().0.to_bits();
        assert_eq!(lost(&session), lost(&fresh), "{control}");
    }
}

#[test]
fn another_value_leaves_the_walker_at_the_control_that_is_held() {
    let mut session = session(RANGE);
    session.all(&[Id::NextEvent, Id::NextEvent]).does(Command::Steps(3));
    let before = session.model.walker().unwrap().state;
    session.set("material.cohesive_strength", "1.05");
    let after = session.model.walker().unwrap();
    assert_eq!(after.kind, NodeKind::Solved);
    // The states of a path are as dense as it is drawn.
    assert!((after.state.approach - before.approach).abs() < 2e-3, "{before:?} {:?}", after.state);
    assert!((after.state.contact_radius - before.contact_radius).abs() < 0.01);
}

#[test]
fn a_zone_pulls_with_its_strength_and_is_no_further_open_than_its_range() {
    let mut session = session(RANGE);
    session.does(Id::NextEvent);
    let mut figure = |view| -> Figure {
        session.does(Command::Show(view));
        Subject::of(&session.model).unwrap().figure(view)
    };
    let zone = |figure: &Figure| {
        let line = figure.lines.iter().find(|line| line.role == Role::Zone);
        line.unwrap_or_else(|| panic!("{figure:?}")).points.clone()
    };
    // p/E*, with σ₀ = E*.
    assert!(zone(&figure(View::Pressure)).iter().all(|(_, p)| (p + 1.0).abs() < 1e-9));
    // gap/R: from 0 at the contact to h_c = γ/σ₀ at the edge of the zone.
    let gap = zone(&figure(View::Gap));
    let range = 0.003_978_873_577_297_383_6;
    assert!(gap[0].1.abs() < 1e-9 && gap.windows(2).all(|pair| pair[0].1 <= pair[1].1), "{gap:?}");
    assert!((gap[gap.len() - 1].1 - range).abs() < 1e-6 * range, "{gap:?}");
    assert!(figure(View::Energy).missing.is_some() && figure(View::Stability).missing.is_some());
}

#[test]
fn an_event_that_is_gone_to_is_the_one_where_the_walker_stands() {
    for set in [RESTS, RESTS_AFTER_LOADING, RANGE, RANGE_FROM_APART] {
        let mut session = session(set);
        let count = session.model.path_events().len();
        // At the start no part of the unloading has begun.
        assert!(session.model.log().here().is_none(), "{set:?}: {:?}", session.model.log().here());
        for number in (1..=count).rev() {
            let is_first = session.model.path_events()[number - 1].before.is_none();
            session.does(Command::SelectEvent(number));
            let log = session.model.log();
            let marks: Vec<EventMark> = log.entries.iter().map(|entry| entry.mark).collect();
            let at = number - 1;
            assert!(marks[..at].iter().all(|mark| *mark == EventMark::Done), "{set:?} {number}: {marks:?}");
            assert!(is_first || marks[at] == EventMark::Here, "{set:?} {number}: {marks:?}");
            assert!(
                marks[number..].iter().all(|mark| *mark == EventMark::Ahead),
                "{set:?} {number}: {marks:?}"
            );
        }
    }
}

#[test]
fn the_largest_pull_is_gone_to_from_anywhere() {
    // A smooth edge that rests to the end: the turn, the end of rest and the pull-off have the same radius.
    let smooth: &Set = &[
        ("gap.amplitude", "0"),
        ("material.closing_work_of_adhesion", "0.0005"),
        ("path.begin", "apart"),
        ("path.turn_approach", "-0.001"),
        ("path.control", "force"),
    ];
    for set in [RESTS_AFTER_LOADING, RANGE_FROM_APART, smooth] {
        let mut session = session(set);
        session.does(Id::MoveTo);
        let pull = session.model.path().unwrap().totals.largest_pull.clone().unwrap();
        let here = session.model.walker().unwrap().state;
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b.abs();
        assert!(
            near(here.force, pull.force) && near(here.approach, pull.approach),
            "{set:?}: {here:?} {pull:?}"
        );
    }
}

#[test]
fn another_device_or_turn_has_another_path_and_the_walker_stands_on_it() {
    for (key, value) in [("path.control", "force"), ("path.turn_approach", "0.06"), ("path.begin", "disc")] {
        let mut session = session(RESTS_AFTER_LOADING);
        session.all(&[Id::NextEvent, Id::NextEvent]);
        session.set(key, value);
        let node = session.model.walker().unwrap_or_else(|| panic!("{key}: {}", session.status()));
        let curve = session.model.curve.as_ref().unwrap();
        let path = curve.along.as_ref().unwrap().as_ref().unwrap();
        assert_eq!(path.states[node.on_path.unwrap()].state(), node.state, "{key}");
        to_the_end(&mut session);
    }
}

/// What was walked on the path that began elsewhere is none of its events.
#[test]
fn another_beginning_starts_the_walk_again() {
    for keys in [&[][..], &[("material.closing_work_of_adhesion", "0.002")]] {
        let mut session = Session::new("wavy-sphere");
        for (key, value) in keys {
            session.set(key, value).does(Id::Restart);
        }
        while !session.model.history.current().unwrap().is_apart() {
            session.does(Id::NextEvent);
        }
        let apart = session.model.history.cursor();
        let happened = |session: &Session| {
            let log = session.model.log();
            log.entries.iter().filter(|entry| entry.mark == EventMark::Done).count()
        };
        let before = happened(&session);
        assert!(before > 3, "{keys:?}");
        session.set("path.begin", "apart");
        assert_eq!(happened(&session), 1, "{keys:?}: only the first touch");
        assert_eq!(
            session.status(),
            "The bodies have touched, event 1, and are at rest. next-event runs to the next event"
        );
        // In one command, both are taken back.
        session.does(Id::Undo);
        assert_eq!((session.model.history.cursor(), happened(&session)), (apart, before), "{keys:?}");
        session.does(Id::Redo);
        assert_eq!(happened(&session), 1, "{keys:?}");
        // At another value the walker stays on its way.
        session.does(Id::NextEvent).set("gap.amplitude", "0.0026");
        assert!(session.model.history.current().unwrap().state.contact_radius > 0.0);
        assert!(!matches!(session.model.history.current().unwrap().kind, NodeKind::Start), "{keys:?}");
    }
}

/// Without adhesion the contact grows from nothing, and the walk begins where no event of the path ends.
#[test]
fn without_adhesion_only_the_touch_has_happened() {
    let mut session = Session::with("wavy-sphere", &["material.work_of_adhesion=0", "path.begin=apart"]);
    let done = |session: &Session| {
        let entries = session.model.log().entries;
        entries.iter().take_while(|entry| entry.mark == EventMark::Done).count()
    };
    assert_eq!(session.model.path_events()[0].kind, "first-touch");
    assert_eq!(done(&session), 1);
    session.does(Id::NextEvent);
    assert!((1..4).contains(&done(&session)), "{}", session.status());
}
