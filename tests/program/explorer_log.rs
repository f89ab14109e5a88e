//! The log of the explorer: what is done, where the walker is, what lies ahead, and what was passed by.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::session::Session;
use pulloff::explorer::log::EventMark;
use pulloff::explorer::{Command, Id, NodeKind, ScreenPanel};
use pulloff_engine::quasistatic::EventKind;

#[test]
fn the_next_event_again_and_again_detaches_and_ticks_the_log() {
    for (preset, assignments) in [
        ("wavy-sphere", &[][..]),
        ("wavy-sphere", &["path.control=force"][..]),
        ("fig-3-jkr", &[][..]),
        ("fig-8", &[][..]),
    ] {
        let mut session = Session::with(preset, assignments);
        let count = session.model.path_events().len();
        for _ in 0..2 * count {
            session.does(Id::NextEvent);
        }
        let log = session.model.log();
        assert!(session.model.history.current().unwrap().is_apart(), "{preset}: {}", session.status());
        assert!(log.entries.iter().all(|entry| entry.mark == EventMark::Done), "{preset}: {log:?}");
        // The losses of a manual walk are those of the path.
        let (lost, unbounded) = log.lost();
        let totals = session.model.path().unwrap().totals.clone();
        let all = totals.dissipated.unwrap_or(totals.dissipated_before_last_contact);
        assert_eq!(unbounded, totals.dissipated.is_none());
        assert!((lost - all).abs() <= 1e-12 * all, "{preset}: {lost} {all}");
        // After a restart, none of it has happened.
        session.does(Id::Restart);
        assert!(session.model.log().entries.iter().all(|entry| entry.mark == EventMark::Ahead));
    }
}

#[test]
fn a_step_past_a_limit_point_says_so_and_the_next_event_goes_on_from_there() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::NextEvent);
    assert!(session.status().starts_with("Event 1 of 6: next-event or jump"), "{}", session.status());
    session.all(&[Id::Step, Id::Step]);
    assert!(session.status().starts_with("Off the path, unstable"), "{}", session.status());
    session.does(Id::NextEvent);
    assert!(matches!(session.kind(), NodeKind::Jump(_)));
    // What happened off the path has no number.
    let log = session.model.log();
    assert!(
        log.entries.iter().any(|entry| entry.number.is_none() && entry.mark == EventMark::Done),
        "{log:?}"
    );
    assert_eq!(log.entries.iter().filter_map(|entry| entry.number).collect::<Vec<_>>(), [1, 2, 3, 4, 5, 6]);
    for _ in 0..14 {
        session.does(Id::NextEvent);
    }
    assert!(session.model.history.current().unwrap().is_apart(), "{}", session.status());
}

#[test]
fn a_change_that_leaves_the_curve_as_it_was_leaves_the_walker_at_its_limit_point() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::NextEvent);
    let before = session.model.walker().unwrap().clone();
    session.set("material.range_of_action", "0.005");
    let after = session.model.walker().unwrap();
    assert_eq!((&after.kind, after.state), (&NodeKind::Limit, before.state));
    session.does(Id::NextEvent);
    let NodeKind::Jump(event) = session.kind() else { panic!("{:?}", session.kind()) };
    assert_eq!(event.kind, EventKind::Snap);
    // Earlier events did not happen at these values, and are not counted.
    session.does(Id::NextEvent).set("gap.amplitude", "0.0026");
    let log = session.model.log();
    assert_eq!(log.entries[0].mark, EventMark::PassedBy, "{log:?}");
    assert!(log.lost().0.abs() < f64::EPSILON, "{log:?}");
}

#[test]
fn an_event_that_a_jump_off_the_path_went_round_is_passed_by_and_not_counted_as_lost() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::NextEvent).does(Command::Steps(4));
    assert!(!session.model.log().has_left_path());
    session.does(Id::Jump);
    let log = session.model.log();
    let marks: Vec<(Option<usize>, EventMark)> =
        log.entries.iter().take(3).map(|entry| (entry.number, entry.mark)).collect();
    let expected = [(None, EventMark::Done), (Some(1), EventMark::PassedBy), (Some(2), EventMark::Ahead)];
    assert_eq!(marks, expected);
    let [walked, passed] = [0, 1].map(|at: usize| log.entries[at].event.dissipated.unwrap());
    assert!((log.lost().0 - walked).abs() <= 1e-12 * walked);
    assert!((log.passed_by().0 - passed).abs() <= 1e-12 * passed && log.has_left_path());
    // Later events are numbered as usual.
    session.does(Id::NextEvent).does(Id::NextEvent);
    assert_eq!(session.model.log().entries[2].mark, EventMark::Done);
    session.all(&[Id::Undo; 4]);
    assert_eq!(session.model.log().entries[0].mark, EventMark::Here);
}

#[test]
fn nothing_has_happened_at_an_unstable_start() {
    let mut session = Session::with("wavy-sphere", &["path.start_contact_radius=0.385"]);
    for _ in 0..2 {
        let log = session.model.log();
        assert!(log.entries.iter().all(|entry| entry.mark == EventMark::Ahead), "{log:?}");
        session.does(Id::Restart);
    }
    let lost = |session: &Session| session.model.log().lost().0;
    let mut before = 0.0;
    for _ in 0..6 {
        session.does(Id::NextEvent);
        assert!(lost(&session) >= before, "what was lost stays lost: {:?}", session.model.log());
        before = lost(&session);
    }
}

#[test]
fn what_was_lost_under_another_control_is_not_counted() {
    let mut session = Session::new("wavy-sphere");
    session.set("path.control", "force");
    for _ in 0..4 {
        session.does(Id::NextEvent);
    }
    assert!(session.model.log().lost().0 > 0.0);
    session.set("path.control.stiffness", "0.3");
    let log = session.model.log();
    assert!(log.entries.iter().all(|entry| entry.number.is_some()), "{log:?}");
    assert_eq!(log.entries[0].mark, EventMark::PassedBy, "{log:?}");
    assert!(log.lost().0.abs() < f64::EPSILON, "{log:?}");
}

#[test]
fn the_largest_pull_is_no_event_that_happened() {
    // A under displacement is where the last contact under force begins.
    let mut session = Session::new("wavy-sphere");
    session.does(Id::MoveTo).set("path.control", "force");
    let log = session.model.log();
    assert!(log.entries.iter().all(|entry| entry.mark != EventMark::Done), "{log:?}");
    // An outward jump of a path that only unloads leaves behind what was behind.
    let mut session = Session::new("wavy-sphere");
    session.does(Command::SelectEvent(3)).does(Id::Reverse).does(Id::NextEvent);
    session.set("path.control", "force").does(Id::NextEvent).set("path.control", "displacement");
    let log = session.model.log();
    let ahead = log.entries.iter().position(|entry| entry.mark == EventMark::Ahead);
    let stands = session.radius();
    let begins = |at: usize| log.entries[at].event.before.as_ref().map(|before| before.contact_radius);
    assert!(
        ahead.is_none_or(|at| begins(at).is_some_and(|s| s <= stands * (1.0 + 1e-6))),
        "{stands} {log:?}"
    );
}

#[test]
fn selecting_an_event_moves_the_walker_to_its_limit_point() {
    let mut session = Session::new("wavy-sphere");
    session.model.panel = ScreenPanel::Log;
    session.all(&[Id::Down, Id::Down, Id::Edit]);
    let event = &session.model.path_events()[2];
    assert!((session.radius() / event.before.as_ref().unwrap().contact_radius - 1.0).abs() < 1e-9);
    assert!(session.status().contains("snap to crest 5"), "{}", session.status());
    let marks: Vec<EventMark> = session.model.log().entries.iter().map(|entry| entry.mark).take(4).collect();
    // It is reached through the events before it.
    assert_eq!(marks, [EventMark::Done, EventMark::Done, EventMark::Here, EventMark::Ahead]);
    assert!(!session.model.is_unsaved());
    // Once done, it is ticked, and one can go back to it.
    session.all(&[Id::Jump, Id::NextEvent]);
    let marks: Vec<EventMark> = session.model.log().entries.iter().map(|entry| entry.mark).collect();
    assert_eq!(
        marks,
        [
            EventMark::Done,
            EventMark::Done,
            EventMark::Done,
            EventMark::Here,
            EventMark::Ahead,
            EventMark::Ahead
        ]
    );
    session.does(Id::Edit);
    assert_eq!(session.kind(), NodeKind::Limit);
    assert!(
        (session.radius()
            / session.model.curve.as_ref().unwrap().report.as_ref().unwrap().events[2]
                .before
                .as_ref()
                .unwrap()
                .contact_radius
            - 1.0)
            .abs()
            < 1e-9
    );
}

#[test]
fn what_is_lost_again_counts_again() {
    let mut session = Session::new("wavy-sphere");
    let jumped = |session: &mut Session, ids: &[Id]| {
        let before = session.model.log().lost().0;
        session.all(ids);
        let NodeKind::Jump(event) = session.kind() else { panic!("{:?}", session.kind()) };
        let node = session.model.walker().unwrap();
        let lost = event.dissipated.unwrap() * node.setting.units().energy;
        let after = session.model.log().lost().0;
        assert!((after - before - lost).abs() <= 1e-9 * after, "{before} {after} {lost}");
        lost
    };
    let jump = [Id::NextEvent, Id::NextEvent];
    let mut lost = jumped(&mut session, &jump) + jumped(&mut session, &jump);
    // Back through two jumps that are none of the path, and down again through the first one.
    session.does(Id::Reverse);
    lost += jumped(&mut session, &jump) + jumped(&mut session, &jump);
    session.all(&[Id::Reverse, Id::NextEvent]);
    assert_eq!(session.model.log().here().unwrap().number, Some(1));
    assert!((session.model.log().lost().0 - lost).abs() <= 1e-9 * lost);
    lost += jumped(&mut session, &[Id::NextEvent]);
    let log = session.model.log();
    assert_eq!((log.entries[0].times, log.entries[1].times), (2, 1), "{log:?}");
    assert!((log.lost().0 - lost).abs() <= 1e-9 * lost);
    assert_eq!(log.latest(), Some(0), "{log:?}");
    assert!(session.model.history.current().is_some());
}
