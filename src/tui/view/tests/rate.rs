//! The pull at the rate of the preset, on the screen.

use super::Screen;
use crate::explorer::View;
use crate::explorer::pulls::PullData;
use crate::explorer::speeds::SpeedsData;
use crate::figure::{Figure, Role, Sign, Subject};
use pulloff_engine::preset::edge::RATE;
use pulloff_engine::progress::Unwatched;
use pulloff_engine::report::PullReport;
use pulloff_engine::report::pull::AskedPulls;
use std::sync::Arc;

/// Fig. 9 from s = 0.5, pulled at v₀.
pub fn pulled() -> Screen {
    let mut screen = Screen::new("wavy-sphere");
    screen.keys(":set path.start_contact_radius=0.5\r:set edge.exponent=0.5\r:set path.rate=1\r");
    screen
}

fn figure(screen: &Screen, view: View) -> Figure {
    Subject::of(&screen.app.model).unwrap().figure(view)
}

fn pull(screen: &Screen) -> Option<&PullData> {
    screen.app.model.results.shown()
}

/// The least P/Pc of the pull in a view.
fn least(figure: &Figure) -> f64 {
    let of_pull = figure.lines.iter().filter(|line| line.role == Role::Pull);
    of_pull.flat_map(|line| &line.points).fold(f64::INFINITY, |least, (_, force)| least.min(*force))
}

#[test]
fn the_pull_lies_over_the_curve_with_the_largest_pull_of_the_command() {
    let mut screen = pulled();
    let report = PullReport::compute(&screen.app.model.preset, &AskedPulls::default(), &Unwatched).unwrap();
    assert_eq!(report.runs, pull(&screen).unwrap().report.as_ref().unwrap().runs);
    let critical = report.head.problem.critical_force.unwrap();
    assert!((report.runs[0].peak.force / critical + 2.729_97).abs() < 5e-6);
    for view in [View::ForceApproach, View::ForceRadius, View::ForceTime] {
        let figure = figure(&screen, view);
        assert!((least(&figure) + 2.729_97).abs() < 1e-3, "{view:?} {}", least(&figure));
        assert!(figure.bounds.y[0] < -2.73, "{view:?} {:?}", figure.bounds);
    }
    let over_time = figure(&screen, View::ForceTime);
    let peak = over_time.marks.last().unwrap();
    assert_eq!(peak.at, (report.runs[0].peak.time, report.runs[0].peak.force / critical));
    assert_eq!(over_time.marks.iter().filter(|mark| mark.sign == Sign::Minimum).count(), 6);
    screen.keys(":view force-time\r");
    let drawn = screen.text(160, 45);
    assert!(drawn.contains("P/Pc over t") && drawn.contains("P/Pc -2.730"), "{drawn}");
    let said = "Largest pull 2.73 P_c at 1 v₀, 1.12 × smooth; 6/8 jumps seen; edge to 11.6 v₀";
    assert!(screen.text(80, 24).contains(said), "{drawn}");
}

#[test]
fn the_numbers_of_the_path_are_called_quasi_static_beside_a_pull() {
    let mut screen = pulled();
    let text = screen.text(120, 40);
    assert!(
        text.contains("Result, quasi-static") && text.contains("at the rate -2.730 Pc; quasi-static: A -"),
        "{text}"
    );
    for (width, height) in [(80, 24), (60, 20)] {
        let text = screen.text(width, height);
        let title = text.lines().find(|line| line.contains("Log")).unwrap();
        assert!(title.contains("static"), "{text}");
    }
    // No point over time is a state of the curve.
    screen.keys(":view force-time\ri");
    assert!(!screen.text(120, 40).contains("go there"));
    screen.keys("\r");
    assert!(screen.text(80, 24).contains("no point of force-time is a state to go to"));
    assert!(!Screen::new("wavy-sphere").text(120, 40).contains("static"));
}

#[test]
fn a_turned_rate_is_pulled_anew_over_the_same_curve() {
    let mut screen = pulled();
    let curve = screen.app.model.curve.clone().unwrap();
    let before = least(&figure(&screen, View::ForceApproach));
    let knobs = screen.app.model.knobs();
    screen.app.model.parameter = knobs.iter().position(|(row, _)| row.key == RATE).unwrap();
    screen.keys(">");
    assert!(Arc::ptr_eq(&curve, screen.app.model.curve.as_ref().unwrap()));
    let rate = pull(&screen).unwrap().run().unwrap().rate.unwrap();
    assert!((rate - 2.154_43).abs() < 1e-9, "{rate}");
    let after = least(&figure(&screen, View::ForceApproach));
    assert!(after < before - 0.3, "{before} {after}");
    assert!(screen.text(160, 45).contains("Largest pull 3.3 P_c at 2.15 v₀, 1.1 × smooth"));
    // So does any other value.
    screen.keys(":set gap.amplitude=0.001\r");
    assert!(least(&figure(&screen, View::ForceApproach)) > after);
    // Under a dead load, a rate is a force per time.
    screen.keys(":set path.control=force\r");
    assert!(pull(&screen).unwrap().report.is_ok());
    let figure = figure(&screen, View::ForceTime);
    assert!(figure.missing.is_none() && least(&figure).is_finite());
}

#[test]
fn where_the_law_ends_is_said_before_the_numbers() {
    let mut screen = pulled();
    screen.keys(":set edge.highest_ratio=1.5\r:view force-time\r");
    assert!(screen.text(160, 45).contains("G/gamma reaches "));
}

#[test]
fn without_a_rate_nothing_is_pulled() {
    let mut screen = Screen::new("wavy-sphere");
    // The last one undoes a rate.
    for keys in ["", ":set edge.exponent=0.5\r", ":set path.rate=1\ru"] {
        screen.keys(keys);
        assert!(pull(&screen).is_none(), "{keys}");
        for view in [View::ForceApproach, View::ForceRadius, View::ForceTime] {
            assert!(!figure(&screen, view).lines.iter().any(|line| line.role == Role::Pull));
        }
        assert!(crate::explorer::reach::why_not(&screen.app.model, View::ForceTime).is_some(), "{keys}");
    }
    screen.keys(":set reference_speed=2\r");
    let drawn = screen.text(100, 30);
    assert!(
        drawn.contains("edge.reference_speed has no effect until path.rate or path.steps is set"),
        "{drawn}"
    );
    screen.keys(":set exponent=none\r:set reference_speed=3\r");
    let drawn = screen.text(100, 30);
    assert!(drawn.contains("edge.reference_speed has no effect until edge.exponent gives"), "{drawn}");
    screen.keys("uu:view force-time\r");
    let drawn = screen.text(160, 45);
    assert!(drawn.contains("no rate is given: set path.rate or path.steps"), "{drawn}");
}

#[test]
fn measured_rows_lie_on_the_law_of_their_edge() {
    let mut screen = Screen::new("fig-3-jkr");
    screen.keys(":set edge.exponent=0.5\r:set path.rate=0.1\r");
    let run = pull(&screen).unwrap().run().unwrap();
    // As from an instrument whose clock runs on between two rows.
    let mut next = 0.0;
    let rows = run.moments.iter().filter(|at| {
        let is_due = at.contact_radius > 0.0 && at.time >= next;
        next = if is_due { at.time + 5e-3 } else { next };
        is_due
    });
    let rows = rows.map(|at| format!("{:e},{:e},{:e},retraction\n", at.contact_radius, at.force, at.time));
    let text = std::iter::once("contact radius,force,time,segment\n".to_owned()).chain(rows);
    let path = screen.folder.path().join("made.csv");
    std::fs::write(&path, text.collect::<String>()).unwrap();
    let why = |screen: &Screen| crate::explorer::reach::why_not(&screen.app.model, View::Speeds);
    assert!(why(&screen).unwrap().starts_with("no measured curve"));
    screen.keys(&format!(":data {}\r", path.display()));
    assert_eq!(why(&screen), None);
    assert!(screen.app.model.results.found::<SpeedsData>().is_none(), "nobody looks");
    screen.keys("gd:view speeds\r");
    let shown = figure(&screen, View::Speeds);
    let [law] = &shown.lines[..] else { panic!("{:?}", shown.lines) };
    assert!(shown.marks.len() > 50, "{}", shown.marks.len());
    for mark in &shown.marks {
        let next =
            law.points[1..].iter().position(|at| at.0 >= mark.at.0).map_or(law.points.len() - 1, |at| at + 1);
        let [a, b] = [law.points[next - 1], law.points[next]];
        let on_line = a.1 + (b.1 - a.1) * (mark.at.0 - a.0) / (b.0 - a.0);
        assert!((mark.at.1 - on_line).abs() < 0.03, "{mark:?} {on_line}");
    }
    // The law does not affect what is measured.
    screen.keys(":set edge.exponent=0.6\r");
    assert_eq!(figure(&screen, View::Speeds).marks, shown.marks);
}

#[test]
fn a_pull_is_exported_with_its_moments() {
    let mut screen = Screen::new("wavy-sphere");
    let path = |name: &str| screen.folder.path().join(name).display().to_string();
    let [rows, document] = [path("p.csv"), path("p.json")];
    screen.keys(&format!(":export pull {rows}\r"));
    assert!(screen.text(100, 30).contains("no pull to export"));
    let mut screen = pulled();
    for path in [&rows, &document] {
        screen.keys(&format!(":export pull {path}\r"));
    }
    let run = pull(&screen).unwrap().run().unwrap();
    let read = |path: &str| std::fs::read_to_string(path).unwrap();
    assert_eq!(read(&rows).lines().count(), run.moments.len() + 1);
    let document: serde_json::Value = serde_json::from_str(&read(&document)).unwrap();
    assert_eq!((&document["document"], document["runs"].as_array().unwrap().len()), (&"pull".into(), 1));
}
