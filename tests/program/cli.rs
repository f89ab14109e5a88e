//! The program without a terminal: what goes to which stream, in which form, with which exit status.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::Home;
use serde_json::Value;

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

/// Holds a document to its fields: those that all reports have, then its own.
fn assert_fields(document: &Value, own: &[&str]) {
    let all = ["schema", "document", "program_version", "problem", "units", "warnings", "notes"];
    assert_eq!(keys(document), [&all[..], own].concat());
}

/// The number at `a/b/c` in a document.
fn number(document: &Value, pointer: &str) -> f64 {
    document.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("no number at {pointer}"))
}

fn events(document: &Value) -> &Vec<Value> {
    document["events"].as_array().unwrap()
}

fn kinds(document: &Value) -> Vec<&str> {
    events(document).iter().map(|event| event["kind"].as_str().unwrap()).collect()
}

/// The records of a CSV text without its header.
fn records(text: &str) -> Vec<Vec<String>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    reader.records().map(|record| record.unwrap().iter().map(str::to_owned).collect()).collect()
}

const TRACE_HEADER: &str = "step,contact_radius,approach,force,energy,newton_iterations,\
                            stable_displacement,stable_force,stable_chosen,\
                            contact_stiffness,tangent_stiffness,area_slope,admissible";
const UNLOAD_HEADER: &str = "number,kind,direction,control,radius,\
                             before_contact_radius,before_approach,before_force,before_wave,before_rings,\
                             before_area,before_energy,after_contact_radius,after_approach,after_force,\
                             after_wave,after_rings,after_area,after_energy,dissipated,dissipated_by_area,\
                             admissible";
/// A short case: enough rings for the few waves that it crosses.
const SHORT: &[&str] = &["fig-9", "--set", "basis.rings=60", "--set", "path.start_contact_radius=0.3"];

pub(super) fn short<'a>(command: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&[command], SHORT, more].concat()
}

// ---- trace ----

#[test]
fn trace_says_how_force_and_area_answer_to_the_approach() {
    let home = Home::new();
    let (modulus, end) = (3.0, 0.05);
    let changed = ["material.effective_modulus=3", "path.end_contact_radius=0.05"];
    let document = home.json(&["trace", "wavy-sphere", "--set", changed[0], "--set", changed[1]]);
    let points = document["points"].as_array().unwrap();
    let of = |point: &Value, name: &str| point[name].as_f64().unwrap();
    assert!(of(points.last().unwrap(), "contact_radius") <= end);
    let mut signs = [false, false];
    let mut agree = Vec::new();
    for window in points.windows(3) {
        let [before, here, after] = window else { panic!() };
        // A disc pressed by δ with its radius fixed responds like a flat punch.
        let punch = 2.0 * modulus * of(here, "contact_radius");
        assert!((of(here, "contact_stiffness") / punch - 1.0).abs() < 1e-9);
        let between = |name: &str| of(after, name) - of(before, name);
        let delta = between("approach");
        let Some(tangent) = here["tangent_stiffness"].as_f64() else { continue };
        signs[usize::from(tangent > 0.0)] = true;
        let area = 2.0 * std::f64::consts::PI * of(here, "contact_radius") * between("contact_radius");
        let near = |chord: f64, slope: f64| (chord / slope - 1.0).abs() < 0.1;
        agree.push(near(between("force") / delta, tangent) && near(area / delta, of(here, "area_slope")));
    }
    // Chords agree with the slopes of the curve except where the curve turns within them.
    let agreeing = agree.iter().filter(|agrees| **agrees).count();
    assert!(10 * agreeing > 7 * agree.len(), "{agreeing} of {}", agree.len());
    assert_eq!(signs, [true, true]);
}

#[test]
fn trace_writes_one_csv_row_per_point() {
    let home = Home::new();
    let text = home.quiet(&short("trace", &[]));
    assert_eq!(text.lines().next().unwrap(), TRACE_HEADER);
    let rows = records(&text);
    assert!(rows.len() > 50, "{}", rows.len());
    for (step, row) in rows.iter().enumerate() {
        assert_eq!(row[0], step.to_string());
        assert!(row[1..5].iter().all(|cell| cell.parse::<f64>().unwrap().is_finite()), "{row:?}");
        assert!(row[5].parse::<u32>().is_ok());
        assert!(row[6..9].iter().all(|cell| cell == "true" || cell == "false"), "{row:?}");
        assert!(row[9..12].iter().all(|cell| cell.parse::<f64>().unwrap().is_finite()), "{row:?}");
        assert_eq!(row[12], "true");
    }
    // From the start exactly to the end.
    assert_eq!(rows[0][1].parse::<f64>().unwrap().to_bits(), 0.3f64.to_bits());
    assert_eq!(rows.last().unwrap()[1].parse::<f64>().unwrap().to_bits(), 0.002f64.to_bits());
}

#[test]
fn trace_json_has_the_fields_of_the_contract() {
    let home = Home::new();
    let document = home.json(&short("trace", &["--set", "path.control=stiffness=0.15"]));
    assert_fields(
        &document,
        &["stop", "curve_min_force", "curve_min_approach", "limit_points", "inadmissible", "points"],
    );
    assert_eq!(document["schema"], 1);
    assert_eq!(document["program_version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(document["warnings"], Value::Array(Vec::new()));
    assert_eq!(document["stop"], "the end contact radius was reached");
    let first = &document["points"][0];
    assert_eq!(
        keys(first),
        [
            "step",
            "contact_radius",
            "approach",
            "force",
            "energy",
            "newton_iterations",
            "stable",
            "contact_stiffness",
            "tangent_stiffness",
            "area_slope",
            "admissible"
        ]
    );
    assert_eq!(keys(&first["stable"]), ["displacement", "force", "chosen"]);

    let limits = document["limit_points"].as_array().unwrap();
    let of = |control: &Value| limits.iter().filter(|limit| limit["control"] == *control).count();
    let spring = serde_json::json!({"stiffness": 0.15});
    for control in [Value::from("displacement"), Value::from("force"), spring.clone()] {
        assert!(of(&control) > 0, "{control}");
    }
    assert_eq!(limits.len(), of(&"displacement".into()) + of(&"force".into()) + of(&spring));
    assert_eq!(keys(&limits[0]), ["control", "contact_radius", "approach", "force", "wave"]);
    assert!(limits[0]["wave"].is_u64());

    // The smallest values of the curve are those of its limit points.
    let smallest = |control: &str, key: &str| {
        let of = limits.iter().filter(|limit| limit["control"] == control);
        of.map(|limit| limit[key].as_f64().unwrap()).fold(f64::INFINITY, f64::min)
    };
    assert!((number(&document, "/curve_min_force") - smallest("force", "force")).abs() < 1e-15);
    assert!((number(&document, "/curve_min_approach") - smallest("displacement", "approach")).abs() < 1e-15);
}

#[test]
fn both_documents_carry_the_resolved_problem() {
    let home = Home::new();
    for command in ["trace", "unload"] {
        let document = home.json(&short(command, &["--set", "path.control={ stiffness = 0.15 }"]));
        let problem = &document["problem"];
        assert_eq!(
            keys(problem),
            ["preset", "start_contact_radius", "end_contact_radius", "groups", "critical_force"]
        );
        assert_eq!(
            keys(&problem["groups"]),
            [
                "amplitude_over_wavelength",
                "wavelength_over_radius",
                "connectivity",
                "adhesion",
                "johnson",
                "tabor"
            ]
        );
        let preset = &problem["preset"];
        assert_eq!(keys(preset), ["format", "title", "material", "gap", "basis", "path"]);
        assert_eq!(preset["basis"], serde_json::json!({"kind": "rings", "rings": 60, "grading": "uniform"}));
        assert_eq!(preset["path"]["control"], serde_json::json!({"stiffness": 0.15}));
        assert!((number(problem, "/critical_force") - 0.01875).abs() < 1e-15);
        assert!((number(problem, "/groups/adhesion") - 0.025).abs() < 1e-15);
    }
}

#[test]
fn the_csv_of_a_trace_is_its_json() {
    let home = Home::new();
    let rows = records(&home.quiet(&short("trace", &[])));
    let document = home.json(&short("trace", &[]));
    let points = document["points"].as_array().unwrap();
    assert_eq!(rows.len(), points.len());
    for (row, point) in rows.iter().zip(points) {
        // Full precision in both: the same double is recovered.
        let bits = |cell: &str| cell.parse::<f64>().unwrap().to_bits();
        for (column, key) in [(1, "contact_radius"), (2, "approach"), (3, "force"), (4, "energy")] {
            assert_eq!(bits(&row[column]), point[key].as_f64().unwrap().to_bits());
        }
        assert_eq!(row[7], point["stable"]["force"].to_string());
    }
}

#[test]
fn theory_adds_the_exact_columns_behind_the_others() {
    let home = Home::new();
    let (plain, text) = (home.quiet(&short("trace", &[])), home.quiet(&short("trace", &["--theory"])));
    let added = ",exact_approach,exact_force,exact_energy,exact_relative_difference";
    assert_eq!(text.lines().next().unwrap(), format!("{TRACE_HEADER}{added}"));
    let document = home.json(&short("trace", &["--theory"]));
    let points = document["points"].as_array().unwrap();
    assert_eq!(plain.lines().count(), text.lines().count());
    for (plain, with) in plain.lines().zip(text.lines()) {
        assert!(with.starts_with(&format!("{plain},")), "{plain} {with}");
    }
    for (row, point) in records(&text).iter().zip(points) {
        let members = ["approach", "force", "energy", "relative_difference"];
        for (cell, key) in row[13..].iter().zip(members) {
            assert_eq!(
                cell.parse::<f64>().unwrap().to_bits(),
                number(point, &format!("/exact/{key}")).to_bits()
            );
        }
        // Sixty rings on five waves: accurate to a few per cent.
        assert!(number(point, "/exact/relative_difference").abs() < 0.1, "{row:?}");
        assert!((number(point, "/approach") - number(point, "/exact/approach")).abs() < 0.002, "{row:?}");
    }
    assert!(home.json(&short("trace", &[]))["points"][0].get("exact").is_none());
    for preset in ["fig-1-hertz", "fig-3-jkr"] {
        let rows = records(&home.quiet(&["trace", preset, "--theory"]));
        // Over the largest force, because P itself passes through zero.
        let cell = |row: &Vec<String>, at: usize| row[at].parse::<f64>().unwrap().abs();
        let largest = rows.iter().map(|row| cell(row, 14)).fold(0.0, f64::max);
        assert!(rows.iter().all(|row| cell(row, 16) * cell(row, 14) < 0.01 * largest), "{preset}");
    }
}

// ---- unload ----

#[test]
fn unload_writes_a_table_by_default() {
    let home = Home::new();
    let text = home.quiet(&["unload", "fig-9"]);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "Wavy sphere, A/λ = 0.05, Fig. 9");
    assert_eq!(lines[1], "control: displacement");
    assert!(lines[2].starts_with("start: delta "), "{}", lines[2]);
    let events: Vec<&&str> =
        lines.iter().filter(|l| l.contains(" snap ") || l.contains(" last-contact ")).collect();
    assert_eq!(events.len(), 8);
    assert!(events.iter().all(|line| line.ends_with("agrees")), "{text}");
    assert!(events[0].contains("10>9") && events[7].contains("3>-"), "{text}");
    assert!(text.contains("P_c") && text.contains("end: the bodies are apart"), "{text}");
}

#[test]
fn unload_json_has_the_fields_of_the_contract() {
    let home = Home::new();
    let document = home.json(&short("unload", &[]));
    assert_fields(
        &document,
        &["control", "contact", "start_note", "turn", "stop", "events", "totals", "inadmissible", "states"],
    );
    assert_eq!(document["schema"], 1);
    assert_eq!((&document["document"], &document["start_note"]), (&"path".into(), &Value::Null));
    let events = events(&document);
    for event in events {
        assert_eq!(
            keys(event),
            [
                "number",
                "kind",
                "direction",
                "control",
                "radius",
                "before",
                "after",
                "dissipated",
                "dissipated_by_area",
                "passed",
                "admissible"
            ]
        );
        let state = "approach force contact_radius wave contacts stable held_stiffness area energy";
        assert_eq!(keys(&event["before"]), state.split(' ').collect::<Vec<_>>());
        let (drop, area) = (number(event, "/dissipated"), number(event, "/dissipated_by_area"));
        assert!((drop - area).abs() <= 1e-6 * drop, "{drop} {area}");
    }
    let (last, snaps) = events.split_last().unwrap();
    assert!(!snaps.is_empty());
    assert!(snaps.iter().all(|snap| snap["kind"] == "snap" && keys(&snap["after"]) == keys(&snap["before"])));
    assert_eq!((&last["kind"], &last["after"]), (&Value::from("last-contact"), &Value::Null));
    let lost: f64 = events.iter().map(|event| number(event, "/dissipated")).sum();
    assert!((number(&document, "/totals/dissipated") / lost - 1.0).abs() < 1e-12);
}

#[test]
fn unload_csv_leaves_null_empty() {
    let home = Home::new();
    let text = home.quiet(&short("unload", &["--format", "csv", "--control", "force"]));
    assert_eq!(text.lines().next().unwrap(), UNLOAD_HEADER);
    let rows = records(&text);
    let last = rows.last().unwrap();
    assert_eq!(last[1], "last-contact");
    // No landing and, under a dead load, no loss.
    assert!(last[12..21].iter().all(String::is_empty), "{last:?}");
}

#[test]
fn the_control_has_one_form_everywhere() {
    let home = Home::new();
    for (argument, json) in [
        ("displacement", Value::from("displacement")),
        ("force", Value::from("force")),
        ("stiffness=0.15", serde_json::json!({"stiffness": 0.15})),
    ] {
        let by_option = home.json(&short("unload", &["--control", argument]));
        assert_eq!(by_option["control"], json);
        assert_eq!(by_option["problem"]["preset"]["path"]["control"], json);
        let assignment = format!("path.control={argument}");
        assert_eq!(home.json(&short("unload", &["--set", &assignment])), by_option);
    }
    let toml = home.json(&short("unload", &["--set", "path.control={ stiffness = 0.15 }"]));
    let dotted = home.json(&short("unload", &["--set", "path.control.stiffness=0.15"]));
    assert_eq!(toml, dotted);
}

#[test]
fn the_control_is_the_same_before_and_after_a_snap() {
    let home = Home::new();
    for control in ["displacement", "force", "stiffness=0.15"] {
        let document = home.json(&short("unload", &["--control", control]));
        for event in events(&document).iter().filter(|event| event["kind"] == "snap") {
            let value = number(event, "/control");
            for side in ["before", "after"] {
                let (delta, force) = (number(&event[side], "/approach"), number(&event[side], "/force"));
                let held = match control {
                    "displacement" => delta,
                    "force" => force,
                    _ => delta + force / 0.15,
                };
                assert!((held - value).abs() < 1e-12, "{control} {side}: {held} {value}");
            }
        }
    }
}

#[test]
fn a_dead_load_pull_off_has_no_loss_and_says_why() {
    let home = Home::new();
    let document = home.json(&short("unload", &["--control", "force"]));
    let last = events(&document).last().unwrap();
    assert_eq!(last["kind"], "last-contact");
    assert_eq!((&last["dissipated"], &last["dissipated_by_area"]), (&Value::Null, &Value::Null));
    let table = home.quiet(&short("unload", &["--control", "force"]));
    assert!(table.contains("dead load"), "{table}");
}

#[test]
fn the_paper_cases_have_their_events() {
    let home = Home::new();
    let snaps = |n: usize| [vec!["snap"; n], vec!["last-contact"]].concat();
    assert_eq!(kinds(&home.json(&["unload", "fig-9"])), snaps(7));
    assert_eq!(kinds(&home.json(&["unload", "fig-9", "--control", "force"])), snaps(4));
    assert_eq!(kinds(&home.json(&["unload", "fig-10-force"])), snaps(4));
    assert_eq!(kinds(&home.json(&["unload", "fig-3-jkr"])), snaps(0));
    assert_eq!(kinds(&home.json(&["unload"])), kinds(&home.json(&["unload", "wavy-sphere"])));
}

#[test]
fn an_unstable_start_runs_outward_and_says_so() {
    let home = Home::new();
    let arguments = ["unload", "fig-9", "--set", "path.start_contact_radius=0.385"];
    let document = home.json(&arguments);
    let note = document["start_note"].as_str().unwrap();
    assert!(note.contains("unstable under displacement control") && note.contains("0.385"), "{note}");
    assert!(number(&document, "/states/0/contact_radius") > 0.385);
    assert!(home.quiet(&arguments).contains(&format!("note: {note}")));
    // The run outward counts as no loss: the first event is the next snap inward.
    assert!(
        number(&document, "/events/0/before/contact_radius") < number(&document, "/states/0/contact_radius")
    );
}

#[test]
fn a_start_can_be_an_approach_or_a_preload() {
    let home = Home::new();
    for (key, value, pointer) in [
        ("path.start_approach", 0.05, "/states/0/approach"),
        ("path.start_force", 0.01, "/states/0/force"),
        ("path.start_force", -0.02, "/states/0/force"),
    ] {
        let assignment = format!("{key}={value}");
        let document = home.json(&["unload", "fig-9", "--set", &assignment]);
        assert!((number(&document, pointer) - value).abs() < 1e-12, "{assignment}");
        let path = &document["problem"]["preset"]["path"];
        assert_eq!(path[key.strip_prefix("path.").unwrap()], value);
        assert_eq!(path.get("start_contact_radius"), None);
        let start = number(&document, "/problem/start_contact_radius");
        assert!((start - number(&document, "/states/0/contact_radius")).abs() < 1e-12);
    }
    home.refused(&["unload", "fig-9", "--set", "path.start_force=-0.05"], &["no contact has the force"]);
}

#[test]
fn without_adhesion_nothing_snaps_on_a_sphere() {
    let home = Home::new();
    let document = home.json(&["unload", "fig-1-hertz"]);
    assert_eq!(events(&document).len(), 0);
    assert_eq!(number(&document, "/totals/dissipated").to_bits(), 0.0f64.to_bits());
    assert_eq!(number(&document, "/problem/critical_force").to_bits(), 0.0f64.to_bits());
    let table = home.quiet(&["unload", "fig-1-hertz"]);
    assert!(!table.contains("P_c") && !table.contains("NaN") && !table.contains("inf"), "{table}");
    for control in ["force", "stiffness=0.3"] {
        assert_eq!(events(&home.json(&["unload", "fig-1-hertz", "--control", control])).len(), 0);
    }
    // Nothing pulls: before the bodies are apart there is no largest pull, and at last contact it is none.
    assert!(document["totals"]["largest_pull"].is_null() && table.contains("largest pull: none"), "{table}");
    let apart = home.json(&["cycle", "fig-1-hertz"]);
    for at in
        ["/totals/largest_pull/force", "/totals/farthest/approach", "/totals/largest_pull/contact_radius"]
    {
        assert_eq!(number(&apart, at).to_bits(), 0.0f64.to_bits(), "{at}");
    }
    assert!(home.quiet(&["cycle", "fig-1-hertz"]).contains("largest pull: 0: nothing pulls\n"));
    let trace = home.json(&["trace", "fig-1-hertz"]);
    assert_eq!(trace["limit_points"], Value::Array(Vec::new()));
    for point in trace["points"].as_array().unwrap() {
        let (s, force) = (number(point, "/contact_radius"), number(point, "/force"));
        assert!((force / (4.0 / 3.0 * s.powi(3)) - 1.0).abs() < 0.02, "{point}");
    }
    let preload = home.json(&["unload", "fig-1-hertz", "--set", "path.start_force=0.1"]);
    assert!((number(&preload, "/states/0/force") - 0.1).abs() < 1e-12);
    // Nor on waves so shallow that the curve rises throughout.
    let shallow = ["--set", "material.work_of_adhesion=0", "--set", "gap.amplitude=0.0005"];
    // The gap rises throughout, so the disc is connected and there is nothing to report.
    let wavy = home.json(&[["unload", "fig-8"].as_slice(), &shallow].concat());
    assert_eq!(events(&wavy).len(), 0);
    assert_eq!((&wavy["notes"], &wavy["inadmissible"]), (&Value::Array(vec![]), &Value::Array(vec![])));
}

#[test]
fn any_consistent_units_give_the_same_reduced_answer() {
    let home = Home::new();
    // Fig. 9 in SI: E* = 2 MPa, R = 10 µm.
    let (modulus, length) = (2e6, 1e-5);
    let si = home.file(
        "si.toml",
        &format!(
            "[material]\neffective_modulus = {modulus:e}\nwork_of_adhesion = {:e}\n[gap]\nshape = \"wavy-sphere\"\n\
             radius_of_curvature = {length:e}\namplitude = {:e}\nwavelength = {:e}\n[path]\n\
             start_contact_radius = {:e}\n",
            0.003_978_873_577_297_384 * modulus * length,
            0.0025 * length,
            0.05 * length,
            0.5 * length
        ),
    );
    for kind in ["basis.kind=exact", "basis.kind=rings"] {
        let unload = |preset: &str| home.json(&["unload", preset, "--set", kind]);
        let (ours, reduced) = (unload(&si), unload("fig-9"));
        assert_eq!(kinds(&ours), kinds(&reduced));
        for (a, b) in events(&ours).iter().zip(events(&reduced)) {
            let near = |pointer: &str, unit: f64| {
                let (a, b) = (number(a, pointer) / unit, number(b, pointer));
                assert!((a - b).abs() <= 1e-7 * b.abs(), "{kind} {pointer}: {a} {b}");
            };
            near("/before/contact_radius", length);
            near("/before/force", modulus * length * length);
            near("/dissipated", modulus * length.powi(3));
        }
    }
}

// ---- admissibility ----

#[test]
fn the_states_of_the_paper_are_all_possible() {
    let home = Home::new();
    for preset in ["fig-8", "fig-9"] {
        let trace = home.json(&["trace", preset, "--strict"]);
        assert_eq!(trace["inadmissible"], Value::Array(Vec::new()), "{preset}");
        assert!(trace["points"].as_array().unwrap().iter().all(|point| point["admissible"] == true));
        let unload = home.json(&["unload", preset, "--strict"]);
        assert_eq!(unload["inadmissible"], Value::Array(Vec::new()), "{preset}");
        assert!(events(&unload).iter().all(|event| event["admissible"] == true));
    }
    // The waves of Fig. 9 fall, which matters only without adhesion; those of Fig. 8 rise.
    let notes = |preset: &str| home.json(&["unload", preset])["notes"].as_array().unwrap().len();
    assert_eq!((notes("fig-8"), notes("fig-9"), notes("fig-3-jkr")), (0, 1, 0));
    assert!(home.quiet(&["unload", "fig-9"]).contains("note: the gap decreases within the contact"));
}

/// Fig. 9 with adhesion so weak that the next crest would touch.
const WEAK: &[&str] = &["fig-9", "--set", "material.work_of_adhesion=1e-4", "--set", "basis.kind=exact"];
/// Without adhesion, where the disc would have to pull.
const BARE: &[&str] = &["fig-9", "--set", "material.work_of_adhesion=0"];

/// The result of a command with inadmissible states, which are reported and have their own status with `--strict`.
fn inadmissible(home: &Home, command: &str, of: &[&str], passes: &str) -> Value {
    let run = |more: &[&str]| home.run(&[&[command], of, more].concat());
    let ended = run(&["--format", "json"]);
    let document: Value = serde_json::from_str(&ended.out).unwrap();
    let count = document["inadmissible"].as_array().unwrap().len();
    let told = format!("pulloff: warning: {passes} crosses {count} intervals of inadmissible states: s = ");
    assert_eq!(ended.status, 0);
    assert!(ended.err.starts_with(&told) && ended.err.lines().count() == 1, "{}", ended.err);
    let strict = run(&["--format", "json", "--strict"]);
    assert_eq!((strict.status, &strict.out), (3, &ended.out), "{}", strict.err);
    assert!(strict.err.contains("--strict"), "{}", strict.err);
    let mut outside = f64::INFINITY;
    for interval in document["inadmissible"].as_array().unwrap() {
        assert_eq!(
            keys(interval),
            ["from_contact_radius", "to_contact_radius", "crest_radius", "crest_wave"]
        );
        let [from, to] = ["/from_contact_radius", "/to_contact_radius"].map(|key| number(interval, key));
        assert!(to < from && from < outside, "{interval}");
        outside = to;
    }
    document
}

/// Whether the state of contact radius `s` is in one of the intervals of `document`.
fn is_inside(document: &Value, s: f64) -> bool {
    let of = |interval: &Value, key: &str| interval[key].as_f64().unwrap();
    let holds = |i: &Value| of(i, "to_contact_radius") <= s && s <= of(i, "from_contact_radius");
    document["inadmissible"].as_array().unwrap().iter().any(holds)
}

#[test]
fn a_trace_says_where_the_next_crest_would_touch() {
    let home = Home::new();
    let document = inadmissible(&home, "trace", WEAK, "the curve");
    for interval in document["inadmissible"].as_array().unwrap() {
        let [from, crest] = ["/from_contact_radius", "/crest_radius"].map(|key| number(interval, key));
        assert!(from < crest && crest < from + 0.05, "{interval}");
        assert!((crest / 0.05 - number(interval, "/crest_wave")).abs() < 0.5, "{interval}");
    }
    let rows = records(&home.run(&[&["trace"], WEAK].concat()).out);
    let mut seen = [0, 0];
    for (point, row) in document["points"].as_array().unwrap().iter().zip(&rows) {
        let admissible = !is_inside(&document, number(point, "/contact_radius"));
        assert_eq!(point["admissible"], admissible);
        assert_eq!(row[12], admissible.to_string());
        seen[usize::from(admissible)] += 1;
    }
    // As many as the radii counted separately: about a quarter.
    assert!(seen[0] > 10 && seen[1] > seen[0], "{seen:?}");
    // The jumps of the unloading bypass all of them.
    let path = home.json(&[&["unload"], WEAK, &["--strict", "--one-disc"]].concat());
    assert_eq!(path["inadmissible"], Value::Array(Vec::new()));
    assert!(events(&path).iter().all(|event| event["admissible"] == true));
}

#[test]
fn an_unloading_marks_the_events_that_cannot_be() {
    let home = Home::new();
    let document = inadmissible(&home, "unload", BARE, "the path");
    let run = |more: &[&str]| home.run(&[&["unload"], BARE, more].concat()).out;
    let rows = records(&run(&["--format", "csv"]));
    let mut marked = 0;
    for (event, row) in events(&document).iter().zip(&rows) {
        let landing = event.pointer("/after/contact_radius").and_then(Value::as_f64);
        let touched = is_inside(&document, number(event, "/before/contact_radius"))
            || landing.is_some_and(|s| is_inside(&document, s));
        assert_eq!(event["admissible"], !touched);
        assert_eq!(row[21], (!touched).to_string());
        marked += usize::from(touched);
    }
    let table = run(&[]);
    let lines = table.lines().filter(|line| line.contains(" snap ! ") || line.contains(" last-contact ! "));
    assert!(marked > 0 && lines.count() == marked, "{table}");
    assert!(table.contains("\n! limit point or landing inadmissible"), "{table}");
}

// ---- where it goes ----
