//! Unloadings known to many digits, and verdicts of admissibility, with presets as a user writes them:
//! `data/truths.toml` lists each with its events.

#![allow(
    clippy::float_cmp,
    clippy::unreadable_literal,
    clippy::maybe_infinite_iter,
    clippy::items_after_statements,
    reason = "numbers copied digit by digit, and special cases told by their exact values"
)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::quadrature::{Disc, Term};
use pulloff::store::read;
use pulloff_engine::case::Case;
use pulloff_engine::gap::shapes::ProfileGap;
use pulloff_engine::gap::{Gap, Shape};
use pulloff_engine::preset::Preset;
use pulloff_engine::problem::{ContactKind, Control};
use pulloff_engine::progress::Unwatched;
use pulloff_engine::quasistatic::Admissibility;
use pulloff_engine::quasistatic::path::PathSetting;
use pulloff_engine::report::PathReport;
use pulloff_engine::report::path::{EventReport, Extent};
use std::f64::consts::{PI, TAU};
use toml::{Table, Value};

/// The number of units in the last place by which a number may differ from its written value.
const LAST_PLACE: f64 = 1.0;

/// The preset of these tables, with E* = 1.
fn preset(work_of_adhesion: f64, gap: &Table, path: &Table) -> Preset {
    let mut document = Table::new();
    document.insert("format".to_owned(), Value::Integer(1));
    let mut material = Table::new();
    material.insert("effective_modulus".to_owned(), Value::Float(1.0));
    material.insert("work_of_adhesion".to_owned(), Value::Float(work_of_adhesion));
    document.insert("material".to_owned(), Value::Table(material));
    document.insert("gap".to_owned(), Value::Table(gap.clone()));
    document.insert("path".to_owned(), Value::Table(path.clone()));
    read("truth", &toml::to_string(&document).unwrap()).unwrap()
}

/// The preset of a formula, under displacement control, from this radius.
fn formula(text: &str, work_of_adhesion: f64, start: f64) -> Preset {
    let gap = format!("shape = \"formula\"\nformula = \"{text}\"").parse().unwrap();
    preset(work_of_adhesion, &gap, &format!("start_contact_radius = {start:e}").parse().unwrap())
}

/// The paper's wavy sphere with R = 1.
fn wavy(amplitude: f64, wavelength: f64, work_of_adhesion: f64, start: f64) -> Preset {
    let gap = format!(
        "shape = \"wavy-sphere\"\nradius_of_curvature = 1.0\namplitude = {amplitude:e}\nwavelength = {wavelength:e}"
    );
    let path = format!("start_contact_radius = {start:e}");
    preset(work_of_adhesion, &gap.parse().unwrap(), &path.parse().unwrap())
}

/// The rows of r²/2 + 0.0025(1 − cos(2πr/0.1)) + 2·10⁻⁵ sin(i²), rᵢ = i/100.
fn wavy_rows() -> String {
    let row = |i: u32| {
        let r = f64::from(i) / 100.0;
        let h = r * r / 2.0 + 0.0025 * (1.0 - (TAU * r / 0.1).cos()) + 2e-5 * f64::from(i * i).sin();
        format!("{r:?}, {h:?}\n")
    };
    (0..61).map(row).collect()
}

/// Whether `x` agrees with what is written, to its last place.
fn is(x: f64, written: &str) -> bool {
    if written == "-" {
        return true;
    }
    let (digits, power) = written.split_once('e').unwrap_or((written, "0"));
    let places = digits.split_once('.').map_or(0, |(_, places)| places.len());
    let unit = 10f64.powi(power.parse::<i32>().unwrap() - i32::try_from(places).unwrap());
    (x - written.parse::<f64>().unwrap()).abs() <= LAST_PLACE * unit
}

fn check_event(name: &str, event: &EventReport, written: &str) {
    let mut words = written.split_whitespace();
    let mut next = || words.next().unwrap();
    assert_eq!(event.kind, next(), "{name}");
    let before = event.before.as_ref().unwrap();
    for x in [before.contact_radius, before.approach, before.force] {
        assert!(is(x, next()), "{name}: {x:?} of {written}");
    }
    let (after, loss) = (next(), next());
    assert!(
        is(event.after.as_ref().map_or(f64::NAN, |after| after.contact_radius), after),
        "{name}: {event:?} {written}"
    );
    if loss != "-" {
        for ours in [event.dissipated, event.dissipated_by_area] {
            assert!(ours.is_some_and(|ours| is(ours, loss)), "{name}: {ours:?} of {written}");
        }
    }
}

#[test]
fn unloadings_are_those_of_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let rows = folder.path().join("rows.csv");
    std::fs::write(&rows, wavy_rows()).unwrap();
    let table: Table = include_str!("../data/truths.toml").parse().unwrap();
    for case in table["case"].as_array().unwrap() {
        let case = case.as_table().unwrap();
        let name = case["name"].as_str().unwrap();
        let mut gap = case["gap"].as_table().unwrap().clone();
        if let Some(file) = gap.get_mut("file") {
            *file = Value::String(rows.to_str().unwrap().to_owned());
        }
        let preset =
            preset(case["work_of_adhesion"].as_float().unwrap(), &gap, case["path"].as_table().unwrap());
        let report = PathReport::unload(&preset, Extent::default(), &Unwatched)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        if let Some(start) = case.get("start") {
            let (ours, start) = (report.states[0].state.contact_radius, start.as_str().unwrap());
            assert!(is(ours, start), "{name}: starts at {ours:?}");
        }
        let events = case["events"].as_array().unwrap();
        assert_eq!(report.events.len(), events.len(), "{name}: {:?}", report.events);
        for (event, written) in report.events.iter().zip(events) {
            check_event(name, event, written.as_str().unwrap());
        }
    }
}

#[test]
fn a_start_just_inside_a_limit_point_is_the_nearest_stable_state() {
    let shipped = |control: &str, start: Option<f64>| {
        let mut preset = read("t", pulloff::store::shipped::find("wavy-sphere").unwrap().text).unwrap();
        preset.path.control = control.parse().unwrap();
        if let Some(start) = start {
            preset.set("path.start_contact_radius", start.into()).unwrap();
        }
        PathReport::unload(&preset, Extent::default(), &Unwatched).unwrap()
    };
    for control in ["displacement", "force", "stiffness=0.15"] {
        let whole = shipped(control, None);
        assert!(whole.events.len() > 2, "{control}");
        for (i, event) in whole.events.iter().enumerate() {
            let limit = event.before.as_ref().unwrap().contact_radius;
            for below in [1e-15, 1e-13, 1e-11, 1e-9] {
                let start = limit * (1.0 - below);
                let path = shipped(control, Some(start));
                let reached = path.states[0].state.contact_radius;
                assert!(
                    (reached - limit).abs() <= 2e-8 * limit,
                    "{control} {limit}: {start:?} > {reached:?}"
                );
                assert_eq!(path.events.len(), whole.events.len() - i, "{control} {limit} {below}");
                let first = path.events[0].before.as_ref().unwrap().contact_radius;
                assert!((first / limit - 1.0).abs() <= 1e-13, "{control}: {first:?} {limit:?}");
            }
        }
    }
}

#[test]
fn losses_do_not_depend_on_how_stiff_the_device_is() {
    let mut preset = read("t", pulloff::store::shipped::find("wavy-sphere").unwrap().text).unwrap();
    let mut losses = |control: Control| -> Vec<[f64; 2]> {
        preset.path.control = control;
        let case = Case::new(&preset).unwrap();
        let path = case
            .unload(&case.curve(&Unwatched).unwrap(), &PathSetting::one_disc(control), &Unwatched)
            .unwrap();
        let both = |event: &pulloff_engine::quasistatic::Event| {
            [event.dissipated, event.dissipated_by_area].map(Option::unwrap)
        };
        path.events.iter().map(both).collect()
    };
    let stiff = losses(Control::Displacement);
    assert!(stiff.iter().any(|both| both.iter().all(|loss| is(*loss, "1.217e-4"))), "{stiff:?}");
    for k in [1e9, 1e13, 1e30] {
        let ours = losses(Control::Stiffness(k));
        assert_eq!(ours.len(), stiff.len(), "{k:e}");
        // The device itself has an effect of the order of 1/k.
        let tolerance = 1e-11 + 100.0 / k;
        for (ours, stiff) in ours.iter().zip(&stiff) {
            for loss in ours {
                assert!((loss / stiff[0] - 1.0).abs() <= tolerance, "{k:e}: {ours:?} {stiff:?}");
            }
        }
    }
}

/// The verdict on the state of radius `s`.
fn verdict(case: &Case, s: f64) -> Admissibility {
    let curve = case.curve(&Unwatched).unwrap();
    let state = case.basis.equilibrium(&case.reduced, s / case.units().length).unwrap();
    curve.equilibrium.judge().judge(state.contact_radius, state.approach, &Unwatched)
}

#[test]
fn overlaps_are_found_wherever_they_are() {
    // The preset, the radius, the smallest gap and the radius, in contact radii, at which it occurs.
    let wave =
        [0.15, 0.145, 0.13].map(|s| wavy(0.041313855589045656, 0.20830420097041344, 9.968404576450257e-5, s));
    let far = formula("r^2/2 - 0.97*exp(-((r-1.4)/0.15)^2)", 0.001, 0.3);
    let narrow = formula("r^2/2 - 0.12*exp(-((r-0.5)/0.01)^2)", 0.001, 0.3);
    let [first, second, third] = wave;
    for (preset, least) in [
        (first, Some(("-0.0137", "1.30"))),
        (second, None),
        (third, None),
        (far, Some(("-0.0456", "4.61"))),
        (narrow, Some(("-0.03556", "1.67"))),
    ] {
        let case = Case::new(&preset).unwrap();
        let found = verdict(&case, case.start * case.units().length);
        assert!(!found.holds, "{found:?}");
        let crest = found.nearest.unwrap();
        if let Some((gap, ratio)) = least {
            let ours = crest.gap * case.units().length;
            assert!(is(ours, gap) && is(crest.radius / case.start, ratio), "{ours} {crest:?}");
        }
    }
    let mut one_disc = formula("r^2/2 - 0.12*exp(-((r-0.5)/0.01)^2)", 0.001, 0.3);
    one_disc.path.contact = ContactKind::OneDisc;
    let report = PathReport::unload(&one_disc, Extent::default(), &Unwatched).unwrap();
    let intervals = report.inadmissible.unwrap();
    assert_eq!(intervals.len(), 1, "{intervals:?}");
    let from = intervals[0].from_contact_radius;
    assert!((from - 0.3).abs() < 1e-12 && report.events.iter().all(|event| event.admissible.is_some()));
}

#[test]
fn of_ninety_seven_radii_so_many_are_inadmissible() {
    for (amplitude, wavelength, gamma, count) in [
        (0.0025, 0.05, 1e-4, 26),
        (0.01, 0.1, 2e-3, 12),
        (0.01, 0.1, 1e-4, 54),
        (0.0025, 0.05, 0.025 / TAU, 0),
    ] {
        let case = Case::new(&wavy(amplitude, wavelength, gamma, 0.5)).unwrap();
        let curve = case.curve(&Unwatched).unwrap();
        let judge = curve.equilibrium.judge();
        let holds = |s: f64| {
            let state = case.basis.equilibrium(&case.reduced, s).unwrap();
            judge.judge(s, state.approach, &Unwatched).holds
        };
        let found = (0..97).filter(|i| !holds(0.02 + 0.005 * f64::from(*i))).count();
        assert_eq!(found, count, "{amplitude} {wavelength} {gamma}");
    }
}

/// h' of a spline in the form that the quadrature takes.
fn spline(profile: &ProfileGap) -> Term {
    let knots = profile.knots().to_vec();
    let slopes = knots.windows(2).map(|ends| {
        let middle = 0.5 * (ends[0] + ends[1]);
        let (t, jet) = (ends[0] - middle, profile.jet(middle));
        let third = 0.5 * jet.third;
        [jet.first + t * (jet.second + t * third), jet.second + 2.0 * t * third, third]
    });
    Term::Spline { slopes: slopes.collect(), knots: knots.clone() }
}

#[test]
fn eight_rows_are_enough() {
    let rows = [0.0, 0.05, 0.13, 0.2, 0.31, 0.4, 0.52, 0.6].map(|r: f64| {
        let h = r * r / 2.0 + 0.008 * (1.0 - (TAU * r / 0.25).cos());
        format!("{r:?}, {h:?}\n")
    });
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rows.csv");
    std::fs::write(&path, rows.concat()).unwrap();
    let gap = format!("shape = \"profile\"\nfile = {:?}", path.to_str().unwrap()).parse().unwrap();
    // With weak adhesion the pull-offs lie closer to the axis than the second row.
    for (gamma, control) in [(1e-3, "displacement"), (1e-3, "force"), (2e-6, "displacement"), (2e-6, "force")]
    {
        let start =
            format!("control = \"{control}\"\nstart_contact_radius = 0.55\nend_contact_radius = 1e-4");
        let preset = preset(gamma, &gap, &start.parse().unwrap());
        let Shape::Profile(measured) = &preset.gap else { unreachable!() };
        let disc = Disc::new(&[spline(measured.profile())], gamma, 0.599);
        let held = control.parse().unwrap();
        let truth = disc.unload(held, &disc.rising(held, 1), 0.55, 1e-4).unwrap();
        let report = PathReport::unload(&preset, Extent::default(), &Unwatched).unwrap();
        assert_eq!(report.events.len(), truth.jumps.len(), "{gamma} {control}: {truth:?}");
        let last = truth.jumps.last().unwrap();
        assert!(last.after.is_none() && (gamma > 1e-5 || last.before.radius < 0.05), "{last:?}");
        for (event, jump) in report.events.iter().zip(&truth.jumps) {
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-11 * b.abs();
            assert!(
                near(event.before.as_ref().unwrap().contact_radius, jump.before.radius),
                "{event:?} {jump:?}"
            );
            assert!(near(event.before.as_ref().unwrap().force, jump.before.force), "{event:?} {jump:?}");
            assert_eq!(event.dissipated.is_some(), jump.loss.is_some());
            if let Some((ours, truth)) = event.dissipated.zip(jump.loss) {
                assert!((ours / truth - 1.0).abs() <= 1e-7, "{event:?} {jump:?}");
            }
        }
    }
}

/// A thousand waves down to 0.003 of the radius, against a sum over the waves themselves at the nodes of a single rule.
#[test]
fn a_thousand_waves_have_the_events_of_their_sum() {
    let mut preset = read("t", pulloff::store::shipped::find("random-waves").unwrap().text).unwrap();
    preset.set("gap.count", 1000_i64.into()).unwrap();
    preset.set("gap.shortest_wavelength", 0.003.into()).unwrap();
    preset.set("path.start_contact_radius", 1.0.into()).unwrap();
    let (case, gamma) = (Case::new(&preset).unwrap(), preset.material.work_of_adhesion);
    let curve = case.curve(&Unwatched).unwrap();
    let path = case.unload(&curve, &PathSetting::one_disc(Control::Displacement), &Unwatched).unwrap();
    assert!(path.events.len() > 5, "{:?}", path.events.len());
    let rule = crate::support::quadrature::gauss(1300);
    // δ and dδ/ds.
    let curve_at = |s: f64| {
        let [mut value, mut slope] = [0.0; 2];
        for [x, weight] in &rule {
            let r = s * (0.25 * PI * (1.0 + x)).sin();
            let jet = case.problem.shape.jet(r);
            value += 0.25 * PI * weight * s * jet.first;
            slope += 0.25 * PI * weight * (jet.first + r * jet.second);
        }
        let edge = (TAU * gamma * s).sqrt();
        [value - edge, slope - 0.5 * edge / s]
    };
    let stable = |s: f64| curve_at(s)[1] > 0.0;
    for event in &path.events {
        let s = event.before.as_ref().unwrap().contact_radius;
        assert!(stable(s * (1.0 + 1e-10)) && !stable(s * (1.0 - 1e-10)), "{event:?}");
        assert!((curve_at(s)[0] - event.before.as_ref().unwrap().approach).abs() <= 1e-13, "{event:?}");
        let Some(after) = &event.after else { continue };
        assert!(
            (curve_at(after.contact_radius)[0] - event.before.as_ref().unwrap().approach).abs() <= 1e-13,
            "{event:?}"
        );
        assert!(stable(after.contact_radius), "{event:?}");
    }
    // Between two radii, the parity of the number of limit points is that of the changes of stability.
    let limits: Vec<f64> =
        curve.limit_points(Control::Displacement).iter().map(|limit| limit.contact_radius).collect();
    let radii: Vec<f64> = (1..=60).map(|i| f64::from(i) / 60.0).collect();
    for ends in radii.windows(2) {
        let between = limits.iter().filter(|s| ends[0] < **s && **s < ends[1]).count();
        assert_eq!(stable(ends[0]) == stable(ends[1]), between % 2 == 0, "{ends:?}: {between}");
    }
}
