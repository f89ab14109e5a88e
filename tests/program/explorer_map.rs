//! The map in the explorer: limit points over a parameter, its axes, and where snaps begin.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::session::Session;
use pulloff::explorer::map_axes::MapAxes;
use pulloff::explorer::maps::MapData;
use pulloff::explorer::onset::FirstSnap;
use pulloff::explorer::session::{Document, Ended, Snapshot};
use pulloff::explorer::{Command, Id, ScreenPanel, View};
use pulloff::figure::{Figure, Role, Sign, Subject};

fn figure(session: &Session) -> Figure {
    Subject::of(&session.model).unwrap().figure(View::Map)
}

fn count(figure: &Figure, is_it: impl Fn(&Sign) -> bool) -> usize {
    figure.marks.iter().filter(|mark| is_it(&mark.sign)).count()
}

fn map(x: &str, y: Option<&str>) -> Command {
    Command::Map { x: x.to_owned().into(), y: y.map(|y| y.to_owned().into()) }
}

#[test]
fn the_limit_points_over_the_amplitude_carry_the_events_and_the_selected_one_is_told() {
    let mut session = Session::new("wavy-sphere");
    session.does(Id::Map);
    assert_eq!(session.model.view, View::Map);
    let report = session.model.results.share::<MapData>().unwrap();
    let report = report.report().unwrap();
    assert_eq!((&*report.x.key, &*report.y.key), ("gap.amplitude", "control"));
    let shown = figure(&session);
    assert!(shown.title.contains("δ over A"), "{}", shown.title);
    let events = session.model.path_events().len();
    assert_eq!(count(&shown, |sign| matches!(sign, Sign::Event(_) | Sign::LastContact(_))), events);
    assert!(
        count(&shown, |sign| *sign == Sign::Cusp) > 2 && count(&shown, |sign| *sign == Sign::Landing) > 0
    );
    assert!(count(&shown, |sign| matches!(sign, Sign::OfCrest(_))) > 2);
    // The curve of each event passes through its mark, and each has its own.
    let mut chosen = Vec::new();
    for number in 1..=events {
        session.does(Command::Pick { panel: ScreenPanel::Log, line: Some(number - 1) });
        let shown = figure(&session);
        let line = shown.lines.iter().find(|line| line.role == Role::Chosen).unwrap();
        assert_eq!(line.name, format!("event {number}"));
        let is_it = |sign: &Sign| {
            if number == events { *sign == Sign::LastContact(number) } else { *sign == Sign::Event(number) }
        };
        let (x, y) = shown.marks.iter().find(|mark| is_it(&mark.sign)).unwrap().at;
        let height = shown.bounds.y[1] - shown.bounds.y[0];
        let passes = line.points.windows(2).any(|pair| {
            let [(a, from), (b, to)] = [pair[0], pair[1]];
            (a - x) * (b - x) <= 0.0 && (from + (to - from) * (x - a) / (b - a) - y).abs() < 2e-3 * height
        });
        assert!(passes, "event {number}");
        assert!(!chosen.contains(&line.points), "event {number} has the curve of another");
        chosen.push(line.points.clone());
    }
}

#[test]
fn pressed_again_it_is_the_map_of_the_number_and_the_adhesion_and_any_axes_can_be_said() {
    let mut session = Session::new("wavy-sphere");
    session.all(&[Id::Map, Id::Map]);
    let axes = session.model.map_axes.clone().unwrap();
    assert_eq!((&*axes.x, &*axes.y), ("gap.amplitude", "groups.adhesion"));
    assert!(session.model.results.found::<MapData>().unwrap().report().unwrap().counts.is_some());
    session.does(map("compliance", Some("gap.amplitude")));
    let shown = figure(&session);
    // Under displacement control the preset is at the start of the compliance axis.
    let place = shown.marks.iter().find(|mark| mark.sign == Sign::Preset).unwrap().at;
    assert!(place.0 == 0.0 && shown.lines.iter().any(|line| line.role == Role::Cusps), "{place:?}");
    session.does(map("path.control", None));
    assert_eq!(session.model.map_axes, Some(MapAxes { x: "compliance".into(), y: "force".into() }));
    // The map is kept with the session.
    let bytes = Document::new(&Snapshot::of(&session.model), Ended::Running, 7).json().unwrap();
    let (model, _) = Document::read(&bytes).unwrap().snapshot().unwrap().resume(None);
    assert_eq!(model.map_axes, session.model.map_axes);
    session.does(map("gap.amplitude", Some("gap.amplitude")));
    assert!(session.status().contains("must be different keys"), "{}", session.status());
    // A key that this preset does not have is refused, and the map stays.
    session.does(map("gap.rms", None));
    assert!(session.status().contains("gap.rms"), "{}", session.status());
    assert!(figure(&session).missing.is_none());
}

#[test]
fn where_snaps_begin_follows_the_device_and_is_not_sought_again_for_another_amplitude() {
    let mut session = Session::new("wavy-sphere");
    let first = session.model.first_snap().unwrap();
    assert!((first - 1.2152e-3).abs() < 1e-6, "{first}");
    let known = session.model.results.share::<FirstSnap>().unwrap();
    session.set("gap.amplitude", "0.001");
    assert!(std::sync::Arc::ptr_eq(&known, &session.model.results.share::<FirstSnap>().unwrap()));
    assert_eq!(session.model.first_snap(), Some(first));
    session.set("path.control", "force");
    let dead = session.model.first_snap().unwrap();
    assert!((dead - 2.430e-3).abs() < 1e-6, "{dead}");
    session.set("material.work_of_adhesion", "0");
    assert_eq!(session.model.first_snap(), None);
}
