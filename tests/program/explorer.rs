//! The explorer without a terminal: commands in, model out, every effect done inline.

use crate::support::session::Session;
use pulloff::explorer::export::Export;
use pulloff::explorer::log::EventMark;
use pulloff::explorer::model::Level;
use pulloff::explorer::{
    Axes, Command, Effect, Home, Id, NodeKind, Overlay, Reply, ScreenPanel, View, answer, update,
};
use pulloff::store::Source;
use pulloff_engine::quasistatic::EventKind;

#[test]
fn the_walk_meets_the_events_of_the_curve() {
    let mut session = Session::new("wavy-sphere");
    let curve = session.model.curve.clone().unwrap();
    let events = curve.unloading.as_ref().unwrap().events.clone();
    assert_eq!(events.len(), 6);
    for expected in &events {
        session.does(Id::NextEvent);
        assert!((session.radius() / expected.before.as_ref().unwrap().contact_radius - 1.0).abs() < 1e-9);
        assert!(session.model.can_jump());
        session.does(Id::Jump);
        let NodeKind::Jump(event) = session.kind() else { panic!("{:?}", session.kind()) };
        assert_eq!(event.kind, expected.kind);
        assert!((event.dissipated.unwrap() / expected.dissipated.unwrap() - 1.0).abs() < 1e-8);
        if let (Some(ours), Some(theirs)) = (&event.after, &expected.after) {
            assert!((ours.contact_radius / theirs.contact_radius - 1.0).abs() < 1e-9);
        }
    }
    assert_eq!(session.model.walked_events().len(), 6);
    assert_eq!(session.model.walked_events()[5].1.kind, "last-contact");
    // The bodies are apart: there is nothing to walk, but nothing is lost either.
    session.does(Id::Step);
    assert!(session.status().contains("apart"));
    session.does(Id::Undo).does(Id::Step);
    assert_eq!(session.kind(), NodeKind::Step);
}

#[test]
fn outward_the_next_event_ends_where_the_path_does() {
    let mut session = Session::new("wavy-sphere");
    let start = session.radius();
    session.does(Command::Steps(3)).does(Id::Reverse).does(Id::NextEvent);
    assert!((session.radius() - start).abs() <= 1e-12 * start, "{} {start}", session.radius());
    assert!(session.status().starts_with("Here the path begins"), "{}", session.status());
    let nodes = session.model.history.len();
    session.does(Id::NextEvent);
    assert_eq!(session.model.history.len(), nodes);
    assert!(session.status().contains("reverse turns round"), "{}", session.status());
    // A step continues the walk, and a script reproduces all of it.
    session.does(Id::Step);
    assert!(session.radius() > start);
    assert!(
        session.model.script().unwrap().contains(&"next-event".to_owned()),
        "{:?}",
        session.model.script()
    );
}

#[test]
fn from_apart_the_path_goes_up_to_its_turn_and_back() {
    let mut session = Session::with("wavy-sphere", &["path.begin=apart"]);
    let events = session.model.path_events().to_vec();
    let turn = events.iter().position(|event| event.kind == "turn").unwrap();
    assert!(turn > 0 && events.len() > turn + 1, "{events:?}");
    assert_eq!(session.model.log().entries[0].mark, EventMark::Done, "the first touch");
    for _ in 0..4 * events.len() {
        session.does(Id::NextEvent);
        if session.model.history.current().unwrap().is_apart() {
            break;
        }
    }
    let log = session.model.log();
    assert!(session.model.history.current().unwrap().is_apart(), "{}", session.status());
    assert!(log.entries.iter().all(|entry| entry.mark == EventMark::Done), "{log:#?}");
    assert!(log.entries.iter().all(|entry| entry.number.is_some()), "{log:#?}");
}

#[test]
fn outward_the_edge_jumps_on_loading() {
    let mut session = Session::new("wavy-sphere");
    // Down to the third stable piece, then back up: the maximum there is left in the outward direction.
    session.all(&[Id::NextEvent, Id::Jump, Id::NextEvent, Id::Jump, Id::Reverse, Id::NextEvent]);
    let before = session.radius();
    session.does(Id::Jump);
    let NodeKind::Jump(event) = session.kind() else { panic!() };
    assert_eq!(event.kind, EventKind::SnapIn);
    assert!(session.radius() > before);
    assert!(event.dissipated.unwrap() > 0.0);
    let node = session.model.history.current().unwrap();
    assert!(node.stability.under(session.model.control().unwrap()));
}

#[test]
fn steps_stop_at_a_limit_point_and_go_on_along_the_unstable_branch() {
    let mut session = Session::new("wavy-sphere");
    for _ in 0..200 {
        session.does(Id::Step);
        if session.kind() == NodeKind::Limit {
            break;
        }
    }
    let control = session.model.control().unwrap();
    assert_eq!(session.kind(), NodeKind::Limit);
    session.does(Id::Step).does(Id::Step);
    assert_eq!(session.kind(), NodeKind::Step);
    assert!(!session.model.history.current().unwrap().stability.under(control));
    assert!(session.status().starts_with("Off the path, unstable"));
    // The edge runs from an unstable state too, in the direction of the walk.
    session.does(Id::Jump);
    let NodeKind::Jump(event) = session.kind() else { panic!() };
    assert!(event.dissipated.unwrap() > 0.0);
}

#[test]
fn a_count_is_so_many_steps_and_the_length_is_the_longest_step() {
    let mut session = Session::new("fig-3-jkr");
    session.does(Id::Halve).does(Id::Halve);
    let length = session.model.length;
    session.does(Command::Steps(5));
    let path = session.model.history.path();
    assert_eq!(path.len(), 6);
    for (_, node) in &path[1..] {
        assert!(node.point.length <= length * (1.0 + 1e-9), "{} {length}", node.point.length);
    }
}

#[test]
fn undo_moves_a_cursor_a_step_after_it_makes_a_branch_and_nothing_is_erased() {
    let mut session = Session::new("wavy-sphere");
    session.all(&[Id::Step, Id::Step, Id::Step]);
    let first = session.radius();
    session.all(&[Id::Undo, Id::Undo]).does(Id::Reverse).does(Id::Step);
    assert!(session.radius() > first);
    assert_eq!(session.model.history.nodes().len(), 5);
    session.all(&[Id::Undo, Id::Redo]);
    assert_eq!(session.model.history.cursor(), Some(4));
    // The step, the direction, and the first step.
    session.all(&[Id::Undo, Id::Undo, Id::Undo, Id::Undo]);
    assert!(session.status().contains("nothing to undo"));
}

#[test]
fn a_knob_moves_curve_log_and_walker_and_undo_brings_the_value_back() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::NextEvent).does(Id::Jump);
    let before = session.model.history.current().unwrap().state;
    let events = session.model.path_events().to_vec();
    session.does(Id::MuchMore);
    assert!(session.model.is_unsaved());
    assert_eq!(session.kind(), NodeKind::Solved);
    let after = session.model.history.current().unwrap().state;
    // Solved again at its control value: the same approach, another force.
    assert!((after.approach - before.approach).abs() < 1e-9);
    assert!((after.force / before.force - 1.0).abs() > 1e-3);
    assert_ne!(session.model.path_events()[0].before, events[0].before);
    // Further turns belong to the same command; after a step in between, a turn is a new one.
    session.does(Id::More).does(Id::Step).does(Id::More).does(Id::Undo).does(Id::Undo);
    assert!(session.model.is_unsaved());
    session.does(Id::Undo);
    assert!(!session.model.is_unsaved());
    assert_eq!(session.model.history.current().unwrap().state, before);
    assert_eq!(session.model.path_events()[0], events[0]);
}

#[test]
fn undo_before_the_answer_takes_the_value_back() {
    let mut session = Session::new("wavy-sphere");
    // The curve has been requested but has not come when undo is pressed.
    let late = update(&mut session.model, Id::MuchMore.into());
    let effects = update(&mut session.model, Id::Undo.into());
    assert!(!session.model.is_unsaved());
    session.driver.settle(&mut session.model, late);
    session.driver.settle(&mut session.model, effects);
    assert_eq!(session.model.path_events().len(), 6);
    assert!(session.model.walker().is_some());
    assert!(!session.model.is_computing());
}

#[test]
fn a_state_that_cannot_be_solved_stays_with_the_reason() {
    let mut session = Session::new("wavy-sphere");
    session.all(&[Id::NextEvent, Id::Jump, Id::NextEvent, Id::Jump, Id::NextEvent, Id::Jump]);
    let before = session.radius();
    // Without adhesion no contact exists at this negative approach.
    session.set("material.work_of_adhesion", "0");
    assert!(matches!(session.kind(), NodeKind::Stale(_)), "{:?}", session.kind());
    assert!((session.radius() / before - 1.0).abs() < 1e-15);
    session.does(Id::Step);
    assert!(session.status().contains("restart starts again"), "{}", session.status());
    session.does(Id::Restart).does(Id::Step);
    assert_eq!(session.kind(), NodeKind::Step);
}

#[test]
fn values_out_of_range_are_refused_with_the_reason() {
    let mut session = Session::new("wavy-sphere");
    let preset = session.model.preset.clone();
    for (key, text) in [
        ("gap.amplitude", "-1"),
        ("gap.amplitude", "many"),
        ("basis.rings", "3"),
        ("gap.wavelength", "0"),
        ("material.effective_modulus", "nan"),
        ("path.control", "load"),
        ("path.end_contact_radius", "0.5"),
    ] {
        session.set(key, text);
        let (level, reason) = session.model.status();
        assert_eq!(level, Level::Error, "{key}={text}");
        assert!(reason.contains(key) || reason.contains("path."), "{reason}");
        assert_eq!(session.model.preset, preset);
    }
}

#[test]
fn the_control_can_change_in_mid_walk() {
    let mut session = Session::new("wavy-sphere");
    session.does(Command::Steps(4));
    let nodes = session.model.history.nodes().len();
    session.set("path.control", "force");
    // The state stays the same; only its stability is judged again.
    assert_eq!(session.model.history.nodes().len(), nodes);
    assert_eq!(session.model.path_events().last().unwrap().dissipated, None);
    session.does(Id::NextEvent);
    assert!(session.status().starts_with("Event 1 of"), "{}", session.status());
    session.does(Id::Jump);
    let NodeKind::Jump(event) = session.kind() else { panic!() };
    assert!((event.before.as_ref().unwrap().force - event.after.as_ref().unwrap().force).abs() < 1e-12);
    session.set("path.control", "displacement");
    assert!(!session.model.is_unsaved());
}

#[test]
fn presets_are_saved_opened_and_never_replaced_unasked() {
    let mut session = Session::new("wavy-sphere");
    session.set("gap.amplitude", "0.003");
    session.does(Id::Save);
    assert!(session.status().contains("read-only"));
    for bad in ["", "Trace", "trace", "fig-9", "a/b", "x.toml"] {
        session.does(Command::SaveAs { name: bad.to_owned(), replace: false, with_data: false });
        assert_eq!(session.model.status().0, Level::Error, "{bad}");
        assert!(session.model.is_unsaved());
    }
    session.does(Command::SaveAs { name: "lab-3".to_owned(), replace: false, with_data: false });
    assert!(!session.model.is_unsaved());
    assert!(matches!(&session.model.source, Source::User { name, .. } if name == "lab-3"));
    // A title given to other values is not kept; one of the user's own is.
    assert_eq!(session.model.preset.title, "changed from wavy-sphere");
    // What undo brings back has the new title too.
    session.does(Id::Step).does(Id::Undo);
    assert_eq!(session.model.preset.title, "changed from wavy-sphere");
    assert!(!session.model.is_unsaved());
    session.set("title", "mine").set("gap.amplitude", "0.0035");
    session.does(Command::SaveAs { name: "lab-4".to_owned(), replace: false, with_data: false });
    assert_eq!((&*session.model.preset.title, session.model.is_unsaved()), ("mine", false));
    session.does(Command::Open("lab-3".to_owned()));
    assert_eq!(session.model.preset.title, "changed from wavy-sphere");
    session.set("gap.amplitude", "0.004").does(Id::Save);
    assert!(!session.model.is_unsaved(), "{}", session.status());
    session.does(Command::Open("wavy-sphere".to_owned()));
    assert_eq!(session.model.history.nodes().len(), 1);
    session.does(Command::SaveAs { name: "lab-3".to_owned(), replace: false, with_data: false });
    assert!(session.model.question.take().is_some());
    session.does(Command::Open("lab-3".to_owned()));
    assert_eq!(session.model.preset.gap.wave(), Some((0.004, 0.05)));
    // Changed by another program: it asks before it replaces the file.
    let path = session.folder.path().join("presets/lab-3.toml");
    let text = std::fs::read_to_string(&path).unwrap().replace("0.004", "0.0045");
    std::fs::write(&path, &text).unwrap();
    session.set("gap.amplitude", "0.005").does(Id::Save);
    assert!(session.model.is_unsaved());
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
    session.does(Command::SaveAnyway);
    assert!(!session.model.is_unsaved());
}

#[test]
fn a_walker_that_was_stable_stays_so_when_a_value_changes() {
    let set = |session: &mut Session, amplitude: &str| {
        session.does(Command::Assign(vec![("gap.amplitude".into(), amplitude.into())]));
    };
    // The smooth sphere is far from the waves, and the state nearest to it is not stable.
    let mut session = Session::new("wavy-sphere");
    set(&mut session, "0");
    set(&mut session, "0.003");
    let node = session.model.history.current().unwrap();
    assert!(node.stability.under(node.control), "{}", session.status());
    let direct = {
        let mut session = Session::new("wavy-sphere");
        set(&mut session, "0.003");
        session.model.history.current().unwrap().state.contact_radius
    };
    assert!((node.state.contact_radius - direct).abs() < 1e-9 * direct);
    // While its part of the curve still exists, there is no message; once a limit point has passed the state, there is one.
    let mut session = Session::new("wavy-sphere");
    session.all(&[Id::NextEvent, Id::Reverse]).does(Command::Steps(1));
    set(&mut session, "0.00251");
    assert!(!session.status().contains("next stable part"), "{}", session.status());
    set(&mut session, "0.004");
    assert!(session.status().starts_with("now on the next stable part, s "), "{}", session.status());
    // From an unstable state its own branch is followed.
    let mut session = Session::new("wavy-sphere");
    session.all(&[Id::NextEvent, Id::Step]);
    set(&mut session, "0.00251");
    let node = session.model.history.current().unwrap();
    assert!(!node.stability.under(node.control), "{}", session.status());
}

#[test]
fn the_least_force_is_one_key_away_under_every_control() {
    for control in ["displacement", "force"] {
        let mut session = Session::new("wavy-sphere");
        session.set("path.control", control).does(Id::MoveTo);
        let model = &session.model;
        let least = model
            .curve
            .as_ref()
            .unwrap()
            .report
            .as_ref()
            .unwrap()
            .totals
            .largest_pull
            .as_ref()
            .unwrap()
            .force;
        let node = model.history.current().unwrap();
        let force = node.state.force * node.setting.units().force;
        assert!((force - least).abs() < 1e-9 * least.abs(), "{control}: {force} {least}");
        assert_eq!(node.is_limit(node.control), control == "force", "{}", session.status());
        // It is a place like any other, and the script names it.
        let place = if control == "force" { "move-to event" } else { "move-to" };
        assert!(model.script().unwrap().last().unwrap().starts_with(place), "{:?}", model.script());
        session.does(Id::Undo);
        let node = session.model.history.current().unwrap();
        assert!((node.state.force * node.setting.units().force - least).abs() > 1e-3 * least.abs());
    }
}

#[test]
fn exports_hold_what_is_on_the_screen_and_never_replace_a_file_unasked() {
    let mut session = Session::new("fig-8");
    session.all(&[Id::NextEvent, Id::Jump]);
    for what in [Export::Curve, Export::Walk, Export::Events] {
        for ending in ["csv", "json"] {
            let path = session.folder.path().join(format!("{}.{ending}", what.name()));
            let shown = path.to_str().unwrap().to_owned();
            let export =
                |path: &str| Command::Export { what: what.clone(), path: path.to_owned(), replace: false };
            session.does(export(&format!("{shown}.txt")));
            assert!(session.status().contains("must end in"), "{}", session.status());
            session.does(export(&shown));
            assert!(session.status().contains("exported"), "{}", session.status());
            let text = std::fs::read_to_string(&path).unwrap();
            if ending == "json" {
                let document: serde_json::Value = serde_json::from_str(&text).unwrap();
                assert_eq!(document["schema"], 1);
                assert!(document["problem"]["critical_force"].as_f64().unwrap() > 0.0);
            } else {
                let rows = csv::Reader::from_reader(text.as_bytes()).into_records().count();
                let expected = match what {
                    Export::Curve => session.model.curve.as_ref().unwrap().base.curve.samples.len(),
                    Export::Walk => session.model.history.path().len(),
                    _ => 2,
                };
                assert_eq!(rows, expected, "{what:?}");
            }
            session.does(export(&shown));
            assert!(session.model.question.take().is_some());
        }
    }
}

#[test]
fn an_export_in_si_tells_the_units_of_its_columns() {
    for (name, units) in [("fig-8", ""), ("fig-9-si", "approach in m; force")] {
        let mut session = Session::new(name);
        session.does(Id::Step);
        for (file, expected) in [("walk.csv", units), ("walk.json", "")] {
            let path = session.folder.path().join(file).to_str().unwrap().to_owned();
            session.does(Command::Export { what: Export::Walk, path, replace: false });
            let has_units = session.status().contains("units of the columns");
            assert_eq!(has_units, !expected.is_empty(), "{name} {file}: {}", session.status());
            assert!(session.status().contains(expected), "{}", session.status());
        }
    }
}

#[test]
fn walking_selecting_and_views_are_not_unsaved_changes() {
    let mut session = Session::new("wavy-sphere");
    session.all(&[
        Id::Step,
        Id::NextEvent,
        Id::Jump,
        Id::Undo,
        Id::Redo,
        Id::Restart,
        Id::Reverse,
        Id::Halve,
        Id::Double,
        Id::Axes,
        Id::NextView,
        Id::PreviousView,
        Id::ZoomIn,
        Id::ZoomOut,
        Id::CrossHair,
        Id::Right,
        Id::Whole,
        Id::Pin,
        Id::NextPanel,
        Id::Down,
        Id::Up,
        Id::PreviousPanel,
    ]);
    assert!(!session.model.is_unsaved());
    assert_eq!(session.model.axes, Axes::Raw);
}

#[test]
fn a_restart_begins_a_walk_of_its_own() {
    let mut session = Session::new("wavy-sphere");
    session.all(&[Id::NextEvent, Id::Jump, Id::NextEvent, Id::Jump]);
    assert_eq!(session.model.walked_events().len(), 2);
    session.all(&[Id::Restart, Id::NextEvent, Id::Jump]);
    assert_eq!(session.model.walked_events().len(), 1);
    // Nothing is erased: undo leads back to the earlier walk.
    session.all(&[Id::Restart, Id::Undo]);
    assert_eq!(session.model.walked_events().len(), 1);
}

#[test]
fn from_an_unstable_start_the_edge_runs_outward_as_in_an_unloading() {
    let mut session = Session::new("wavy-sphere");
    session.set("path.start_contact_radius", "0.385").does(Id::Restart);
    assert!(session.status().contains("next-event lets the edge run outward"), "{}", session.status());
    session.does(Id::Jump);
    let start = session.model.curve.as_ref().unwrap().unloading.clone().unwrap();
    let start = start.start().unwrap();
    assert!((session.radius() / start.contact_radius - 1.0).abs() < 1e-9);
}

#[test]
fn a_problem_without_adhesion_or_waves_can_be_walked() {
    let mut session = Session::new("fig-1-hertz");
    session.does(Command::Steps(10));
    assert_eq!(session.kind(), NodeKind::Step);
    session.does(Id::NextEvent);
    assert!(session.status().contains("end contact radius"), "{}", session.status());
    session.does(Id::MoveTo);
    assert!(session.status().contains("nothing pulls on this path"), "{}", session.status());
    session.does(Id::MuchMore).set("path.control", "force").set("path.control", "0.15");
    assert!(session.model.curve_error.is_none());
}

#[test]
fn what_is_not_admissible_is_known_after_the_curve_and_logged_behind_its_events() {
    let mut session = Session::new("wavy-sphere");
    assert!(session.model.curve.as_ref().unwrap().is_checked());
    assert!(session.model.shown_inadmissible().is_empty());
    let events = session.model.path_events().to_vec();
    assert!(events.iter().all(|event| event.admissible != Some(false)));

    let effects = update(
        &mut session.model,
        Command::Set { key: "material.work_of_adhesion".into(), text: "1e-4".to_owned() },
    );
    // While a newer curve is on its way, nothing is requested about the old one.
    let [Effect::Curve(_)] = effects.as_slice() else { panic!("{effects:?}") };
    let curve = session.driver.run(effects[0].clone()).unwrap();
    let effects = answer(&mut session.model, curve);
    // The curve is on the screen first.
    assert!(!session.model.curve.as_ref().unwrap().is_checked() && !session.model.is_computing());
    let (check, walk): (Vec<_>, Vec<_>) = effects
        .into_iter()
        .partition(|effect| matches!(effect, Effect::Compute(task) if task.name == "check"));
    session.driver.settle(&mut session.model, walk);
    assert!(!session.model.curve.as_ref().unwrap().is_checked());
    // A curve requested meanwhile makes the answer void; giving it up requests the answer again.
    let late = session.driver.run(check[0].clone()).unwrap();
    update(&mut session.model, Command::Set { key: "gap.amplitude".into(), text: "0.003".to_owned() });
    answer(&mut session.model, late);
    assert!(!session.model.curve.as_ref().unwrap().is_checked());
    let effects = update(&mut session.model, Id::Cancel.into());
    assert!(
        effects.iter().any(|effect| matches!(effect, Effect::Compute(task) if task.name == "check")),
        "{effects:?}"
    );
    session.driver.settle(&mut session.model, effects);
    session.does(Id::Undo);

    let parts = session.model.shown_inadmissible().to_vec();
    assert!(parts.len() > 3, "{parts:?}");
    let mut last = f64::INFINITY;
    for part in &parts {
        let (from, to) = (part.report.from_contact_radius, part.report.to_contact_radius);
        assert!(to < from && from < last && part.report.crest_radius.unwrap() > from, "{part:?}");
        let ends = [part.places[0], *part.places.last().unwrap()].map(|[_, _, s]| s);
        assert!((ends[0] / from - 1.0).abs() < 1e-12 && (ends[1] / to - 1.0).abs() < 1e-12);
        last = to;
    }
    // A path with rings passes no such state.
    assert!(session.model.path_events().iter().all(|event| event.admissible.is_none()));
    session.set("path.contact", "one-disc");
    assert!(session.model.path_events().iter().all(|event| event.admissible.is_some()));
    session.does(Id::Undo);

    // The log lists them as well, but they are not places to go to.
    session.model.panel = ScreenPanel::Log;
    let count = session.model.path_events().len();
    for _ in 0..50 {
        session.does(Id::Down);
    }
    assert_eq!(session.model.event, count + parts.len() - 1);
    let before = session.radius();
    session.does(Id::Edit);
    assert!(session.status().contains("crest would touch"), "{}", session.status());
    assert!((session.radius() - before).abs() < f64::EPSILON);
    // Another control keeps what is known about the curve.
    session.set("path.control", "force");
    assert_eq!(session.model.shown_inadmissible(), parts);
    // The curve is drawn as inadmissible exactly where the walker is reported to be.
    let part = parts[0].report;
    let mut told = [0, 0];
    session.does(Id::Restart).does(Id::Halve).does(Id::Halve);
    for _ in 0..150 {
        session.does(Id::Step);
        let node = session.model.walker().unwrap();
        let inside = (part.to_contact_radius..=part.from_contact_radius).contains(&node.state.contact_radius);
        if inside || node.state.contact_radius > part.from_contact_radius {
            assert_eq!(node.admissibility.holds, !inside);
            told[usize::from(inside)] += 1;
        }
    }
    assert!(told[0] > 0 && told[1] > 0, "{told:?}");
}

#[test]
fn pins_and_views_go_on_in_another_preset() {
    let mut session = Session::new("wavy-sphere");
    session.all(&[Id::Pin, Id::NextView]).does(Command::Overlay(Overlay::Exact));
    session.set("gap.amplitude", "0.002").does(Id::Pin);
    session.does(Command::Open("fig-8".to_owned()));
    assert_eq!((session.model.view, session.model.overlays.exact), (View::ForceRadius, true));
    let pins = session.model.pins.all();
    assert_eq!(pins.iter().map(|pin| pin.number).collect::<Vec<_>>(), [1, 2]);
    assert!(pins[1].name(&session.model.preset).contains("A 0.002"));
    session.does(Id::Pin).does(Id::Pin);
    assert!(session.status().contains("the same values are pinned as F"), "{}", session.status());
    session.does(Command::Unpin(Some(2))).does(Command::Unpin(Some(2)));
    assert!(session.status().contains("no curve is pinned under that letter"));
}

#[test]
fn the_inside_of_a_state_is_computed_only_where_a_view_shows_it_and_follows_the_walker() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::Step);
    assert!(session.model.shown_profile().is_none());
    session.does(Command::Go(Home::Inside));
    assert_eq!(session.model.view, View::Gap);
    let shown = |session: &Session| session.model.shown_profile().unwrap().profile.contact_radius.to_bits();
    assert_eq!(shown(&session), session.radius().to_bits());
    session.does(Command::Steps(3));
    assert_eq!(shown(&session), session.radius().to_bits());
    // Requested once only: nothing has changed.
    let [asked] = update(&mut session.model, Id::Reverse.into()).try_into().unwrap();
    assert!(update(&mut session.model, Id::Axes.into()).is_empty());
    // Late answers for older states do not replace newer ones.
    let newest = session.driver.run(asked).unwrap();
    assert!(matches!(newest, Reply::Found(_)));
    session.all(&[Id::Undo, Id::Undo]);
    let back = shown(&session);
    answer(&mut session.model, newest);
    assert_eq!(shown(&session), back);
}

#[test]
fn zoom_and_cross_hair_have_their_limits() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::Whole);
    assert!(session.status().contains("the whole chart is shown"));
    session.does(Id::CrossHair);
    assert_eq!(session.model.panel, ScreenPanel::Charts);
    for _ in 0..100 {
        session.does(Id::Left);
    }
    // At the edge it moves the window along.
    assert_eq!(session.model.cross.map(|(x, _)| x), Some(0.0));
    assert!(session.model.window(View::ForceApproach).x[0] < -0.5);
    for _ in 0..40 {
        session.does(Id::ZoomIn);
    }
    assert!(session.status().contains("no closer"), "{}", session.status());
    session.does(Id::Whole).does(Id::Cancel);
    assert!(session.model.cross.is_none() && session.model.window(View::ForceApproach).is_whole());
}
