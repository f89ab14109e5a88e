//! A walk through rings in the explorer: started at the first touch, saved, resumed, undone, replayed.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::session::Session;
use pulloff::explorer::log::EventMark;
use pulloff::explorer::{Command, Id, NodeKind, View};
use pulloff::figure::{Meaning, Role, Subject};
use pulloff_engine::report::path::EventReport;

/// Weak adhesion, started at the first touch.
fn begun() -> Session {
    Session::new("fig-9-weak")
}

/// The same with a disc and a ring.
fn with_ring() -> Session {
    let mut session = begun();
    session.all(&[Id::NextEvent, Id::Jump, Id::NextEvent, Id::Jump]);
    assert!(session.model.walker().unwrap().has_rings(), "{}", session.status());
    session
}

#[test]
fn a_gap_inside_that_closes_is_no_snap_of_the_outer_edge() {
    let mut session = with_ring();
    while !session.status().starts_with("Event 4 of ") {
        session.does(Id::NextEvent);
    }
    assert!(session.status().contains("lets an inner edge jump"), "{}", session.status());
    let before = session.model.walker().unwrap().state.contact_radius;
    session.does(Id::Jump);
    let after = session.model.walker().unwrap();
    assert!(!after.has_rings() && (after.state.contact_radius / before - 1.0).abs() < 0.01);
}

#[test]
fn it_begins_at_the_first_touch_and_says_at_each_touch_what_can_be_done() {
    let mut session = begun();
    let start = session.model.walker().unwrap();
    assert_eq!((start.kind.clone(), start.contacts().len()), (NodeKind::Start, 1));
    assert!((start.state.contact_radius - 0.007_794_041).abs() < 1e-8 && start.state.approach.abs() < 1e-12);
    assert!(!session.model.inward && start.stability.under(start.control));
    session.does(Id::NextEvent);
    let NodeKind::Touch(radius) = session.kind() else { panic!("{:?}", session.kind()) };
    assert!((radius - 0.049).abs() < 1e-3);
    let said = session.status();
    assert!(said.contains("a crest touches at r 0.04") && said.contains("inadmissible"), "{said}");
    // Without the ring, the walk continues through inadmissible states, and says so.
    session.does(Command::Steps(3));
    let said = session.status();
    assert!(
        said.starts_with("Inadmissible: crest 1 would touch") && said.contains("leads back to the path"),
        "{said}"
    );
    assert!(!session.model.walker().unwrap().admissibility.holds);
    assert!(!session.model.walker().unwrap().has_rings());
}

#[test]
fn the_loop_is_walked_and_its_states_are_kept_undone_and_resumed() {
    let mut session = with_ring();
    let node = session.model.walker().unwrap();
    let contacts = node.contacts();
    assert_eq!(contacts.len(), 2);
    assert!(
        (contacts.rings[0][1] - 0.106_108_4).abs() < 1e-6
            && node.state.contact_radius.to_bits() == contacts.outermost().to_bits()
    );
    let state = node.state;
    session.does(Command::Steps(2));
    session.resume();
    let node = session.model.walker().unwrap();
    assert!(node.has_rings() && node.stability.under(node.control) && node.admissibility.holds);
    session.does(Id::Undo);
    assert_eq!(session.model.walker().unwrap().state, state);
    // On to the merge, around the turn, and off.
    session.all(&[Id::NextEvent, Id::Jump]);
    let merged = session.model.walker().unwrap();
    assert!(!merged.has_rings() && (merged.state.contact_radius - 0.110_140_7).abs() < 1e-6);
    session.all(&[Id::Reverse, Id::NextEvent, Id::Jump, Id::NextEvent, Id::Jump]);
    assert!(session.model.history.current().unwrap().is_apart(), "{}", session.status());
    let kinds: Vec<&str> = session.model.walked_events().iter().map(|(_, event)| event.kind).collect();
    assert_eq!(kinds, ["touch", "touch", "snap-in", "snap", "last-contact"]);
}

#[test]
fn a_script_walks_the_rings_again() {
    let mut session = with_ring();
    session.does(Command::Steps(2)).set("material.work_of_adhesion", "0.000101").does(Id::NextEvent);
    let last = session.model.walker().unwrap().state;
    let lines = session.model.journal.lines();
    let mut again = Session::new("fig-9-weak");
    for line in &lines {
        again.does(pulloff::explorer::script::parse(line).unwrap().unwrap());
    }
    assert_eq!(again.model.walker().unwrap().state, last, "{lines:?}");
}

#[test]
fn edges_follow_a_changed_value_or_the_state_is_stale_with_the_reason() {
    let mut session = with_ring();
    let before = session.model.walker().unwrap().contacts();
    session.set("material.work_of_adhesion", "0.000102");
    let node = session.model.walker().unwrap();
    assert_eq!((node.kind.clone(), node.contacts().len()), (NodeKind::Solved, before.len()));
    assert!((node.contacts().outermost() - before.outermost()).abs() < 1e-3);
    // With forty times the adhesion there is one disc: nothing is claimed.
    session.set("material.work_of_adhesion", "0.004");
    let NodeKind::Stale(reason) = session.kind() else { panic!("{:?}", session.kind()) };
    assert!(reason.contains("no equilibrium of these contacts"), "{reason}");
}

#[test]
fn every_view_of_a_state_knows_its_rings() {
    let mut session = with_ring();
    session.does(Command::Steps(1));
    for view in [View::Pressure, View::Gap, View::Contact, View::Energy] {
        session.does(Command::Show(view));
        let figure = Subject::of(&session.model).unwrap().figure(view);
        let count = |role: Role| figure.lines.iter().filter(|line| line.role == role).count();
        match view {
            View::Pressure => assert_eq!(count(Role::Body), 2),
            // Between the disc and the ring, and outside.
            View::Gap => assert_eq!((count(Role::Body), count(Role::Contact)), (2, 2)),
            View::Contact => {
                assert_eq!(figure.areas.iter().filter(|area| area.meaning == Meaning::Contact).count(), 2);
                assert_eq!(count(Role::Edges), 3);
            }
            _ => assert!(figure.missing.unwrap().contains("rings")),
        }
    }
    let figure = Subject::of(&session.model).unwrap().figure(View::ForceRadius);
    // The walk's own line, and the two inner edges.
    assert!(figure.lines.iter().filter(|line| line.role == Role::Walk).count() >= 3);
}

#[test]
fn a_digit_leads_to_an_event_with_rings_too_and_the_experiment_goes_on_there() {
    for control in ["displacement", "force", "stiffness=1"] {
        let mut session = begun();
        session.set("path.control", control).does(Id::Restart);
        let events = session.model.path_events().to_vec();
        let with_rings = |event: &EventReport| event.before.as_ref().is_some_and(|at| at.contacts.len() > 1);
        assert!(events.iter().filter(|event| with_rings(event)).count() > 3, "{control}");
        for event in &events[1..] {
            session.does(Command::SelectEvent(event.number));
            let (log, before) = (session.model.log(), event.before.as_ref().unwrap());
            let at = event.number - 1;
            assert!(
                log.entries[..at].iter().all(|entry| entry.mark == EventMark::Done),
                "{control} {event:?}"
            );
            assert_eq!(log.entries[at].mark, EventMark::Here, "{control} {event:?} {}", session.status());
            let state = session.model.walker().unwrap().state;
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs().max(1e-3);
            let is_there = near(state.force, before.force) && near(state.approach, before.approach);
            assert!(is_there && near(state.contact_radius, before.contact_radius), "{state:?} {before:?}");
            if event.kind == "turn" {
                continue;
            }
            session.does(Id::NextEvent);
            match &event.after {
                Some(after) => {
                    let state = session.model.walker().unwrap().state;
                    let lands =
                        near(state.force, after.force) && near(state.contact_radius, after.contact_radius);
                    assert!(lands, "{control} {event:?} {state:?}");
                }
                None => assert!(session.model.walker().unwrap().is_apart(), "{control} {event:?}"),
            }
        }
        // The largest pull, too, with all that happened before it.
        session.does(Id::MoveTo);
        let pull = session.model.path().unwrap().totals.largest_pull.clone().unwrap();
        let state = session.model.walker().unwrap().state;
        assert!((state.force - pull.force).abs() <= 1e-9 * pull.force.abs(), "{control}");
        assert!(
            session.model.log().entries.iter().all(|entry| entry.mark != EventMark::PassedBy),
            "{control}"
        );
    }
}

#[test]
fn a_crater_is_first_touched_by_a_ring() {
    let mut session = Session::new("crater");
    session.set("path.begin", "apart").does(Id::Restart);
    let node = session.model.walker().unwrap();
    assert_eq!((node.contacts().disc, node.contacts().rings.len()), (0.0, 1));
    session.does(Command::Steps(5));
    assert!(session.model.walker().unwrap().has_rings(), "{}", session.status());
}

#[test]
fn a_gap_that_is_nowhere_least_begins_with_the_disc() {
    let mut session = Session::new("formula");
    session.set("path.begin", "apart").does(Id::Restart);
    assert!(session.model.walker().is_some(), "{}", session.status());
}
