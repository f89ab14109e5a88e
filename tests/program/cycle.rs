//! `pulloff cycle`: its documents, its turns, and its refusals.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::{Ended, Home};
use rustix::process::Signal;
use serde_json::Value;
use std::collections::BTreeSet;

fn keys(value: &Value) -> BTreeSet<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn near(value: &Value, expected: f64) -> bool {
    (number(value) - expected).abs() <= 1e-9 * expected.abs()
}

/// The kinds of the events, in order.
fn kinds(document: &Value) -> Vec<&str> {
    document["events"].as_array().unwrap().iter().map(|event| event["kind"].as_str().unwrap()).collect()
}

const STATE: [&str; 9] =
    ["approach", "area", "contact_radius", "contacts", "energy", "force", "held_stiffness", "stable", "wave"];

#[test]
fn the_document_has_its_form() {
    let home = Home::new();
    let document = home.json(&["cycle", "fig-9-weak"]);
    let all = [
        "contact",
        "control",
        "document",
        "events",
        "inadmissible",
        "notes",
        "problem",
        "program_version",
        "schema",
        "start_note",
        "states",
        "stop",
        "totals",
        "turn",
        "units",
        "warnings",
    ];
    assert_eq!(keys(&document), BTreeSet::from(all));
    assert_eq!((&document["schema"], &document["document"]), (&1.into(), &"path".into()));
    assert_eq!((&document["control"], &document["turn"]["of"]), (&"displacement".into(), &"approach".into()));
    assert_eq!(keys(&document["turn"]), BTreeSet::from(["asked", "of", "reached"]));
    assert_eq!(document["stop"], "the bodies are apart");
    assert_eq!((&document["warnings"], &document["notes"]), (&Value::Array(vec![]), &Value::Array(vec![])));
    let unload = home.run(&["unload", "fig-9-weak", "--format", "json"]);
    let unload: Value = serde_json::from_str(&unload.out).unwrap();
    assert_eq!(document["problem"], unload["problem"]);
    let event = [
        "admissible",
        "after",
        "before",
        "control",
        "direction",
        "dissipated",
        "dissipated_by_area",
        "kind",
        "number",
        "passed",
        "radius",
    ];
    for found in document["events"].as_array().unwrap() {
        assert_eq!(keys(found), BTreeSet::from(event));
        for state in [&found["before"], &found["after"]].into_iter().filter(|state| !state.is_null()) {
            assert_eq!(keys(state), BTreeSet::from(STATE));
            // The outermost edge, and the area of all contacts.
            let contacts = state["contacts"].as_array().unwrap();
            assert_eq!(contacts.last().unwrap()[1], state["contact_radius"]);
            let area: f64 =
                contacts.iter().map(|edges| number(&edges[1]).powi(2) - number(&edges[0]).powi(2)).sum();
            assert!(near(&state["area"], std::f64::consts::PI * area));
        }
        for passed in found["passed"].as_array().unwrap() {
            assert_eq!(keys(passed), BTreeSet::from(["kind", "radius"]));
        }
    }
    let (first, last) = (&document["events"][0], document["events"].as_array().unwrap().last().unwrap());
    assert!(first["before"].is_null() && first["kind"] == "first-touch" && first["direction"] == "loading");
    assert!(last["after"].is_null() && last["kind"] == "last-contact" && last["direction"] == "unloading");
    assert!(first["radius"] == 0.0 && last["radius"].is_null());
    let sums = [
        "dissipated",
        "dissipated_before_last_contact",
        "dissipated_by_area",
        "farthest",
        "largest_pull",
        "last_contact",
        "work_of_loading",
        "work_of_unloading",
    ];
    let whole = &document["totals"];
    assert_eq!(keys(whole), BTreeSet::from(sums));
    // The work that the hand does and does not get back is lost.
    let lost = number(&whole["dissipated"]);
    let work = number(&whole["work_of_loading"]) + number(&whole["work_of_unloading"]);
    assert!((work - lost).abs() < 1e-7 * lost, "{work} {lost}");
    let states = document["states"].as_array().unwrap();
    assert!(states.len() > 200);
    let place = ["control", "direction", "piece"];
    assert_eq!(keys(&states[0]), STATE.into_iter().chain(place).collect());
    let pieces: Vec<u64> = states.iter().map(|state| state["piece"].as_u64().unwrap()).collect();
    assert!(pieces.is_sorted());
}

#[test]
fn the_loop_of_the_paper_has_its_numbers() {
    let document = Home::new().json(&["cycle", "fig-9-cycle"]);
    let expected =
        [&["first-touch"][..], &["snap-in"; 5], &["turn"], &["snap"; 7], &["last-contact"]].concat();
    assert_eq!(kinds(&document), expected);
    // Two other programs agree on them.
    assert!((number(&document["totals"]["dissipated"]) - 2.112_003_387_3e-3).abs() < 1e-12);
    assert!((number(&document["events"][1]["control"]) - 0.011_284_022_05).abs() < 1e-10);
    assert!((number(&document["events"][14]["before"]["force"]) + 0.017_090_567_2).abs() < 1e-10);
}

#[test]
fn a_loop_that_comes_to_two_contacts_in_one_zone_keeps_what_it_has() {
    let home = Home::new();
    let strength = |value: &str| format!("material.cohesive_strength={value}");
    let run = |value: &str| {
        let sets = ["--set", &strength(value), "--set", "material.adhesion=dugdale", "--to-approach", "0.02"];
        home.run(&[&["cycle", "fig-9-cycle", "--format", "json"], &sets[..]].concat())
    };
    let Ended { status, out, err } = run("0.4");
    assert_eq!(status, 1, "{err}");
    for words in
        ["the path stopped early, its 6 events were written", "the contact is torn inside at r = 0.1288"]
    {
        assert!(err.contains(words), "{err}");
    }
    let document: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(kinds(&document), ["jump-in", "snap-in", "turn", "snap", "snap", "snap"]);
    for key in
        ["dissipated", "dissipated_by_area", "largest_pull", "farthest", "last_contact", "work_of_unloading"]
    {
        assert!(document["totals"][key].is_null(), "{key}: {}", document["totals"]);
    }
    assert!((number(&document["totals"]["dissipated_before_last_contact"]) - 6.684e-4).abs() < 1e-7);
    let Ended { status, err, .. } = run("0.42");
    assert_eq!((status, err.as_str()), (0, ""));
    // In a sweep that row is incomplete.
    let spec = "preset = 'fig-9'\nset = ['basis.kind=exact', 'material.range_of_action=0.004', 'material.adhesion=dugdale', \
                'path.turn_approach=0.02']\nquantities = ['cycle_loss']\n[[axis]]\nkey = 'material.cohesive_strength'\n\
                values = [0.4, 1.0]\n";
    home.file("range.toml", spec);
    home.run(&["sweep", "range.toml", "-o", "range.csv"]);
    let rows = std::fs::read_to_string(home.path("range.csv")).unwrap();
    let rows: Vec<&str> = rows.lines().collect();
    assert!(rows[1].contains("torn inside") && rows[2].contains("0.00115619"), "{rows:?}");
}

#[test]
fn a_table_and_csv_say_the_same() {
    let home = Home::new();
    let table = home.quiet(&["cycle", "fig-9-weak"]);
    for words in [
        "Wavy sphere, A/λ = 0.05, weak adhesion\ncontrol: displacement\n",
        "touch 0.097929  0.018459 [0.032749, 0.062483]  0.063614 [0.087999, 0.10611]",
        "turn: asked for the approach 0.140000, reached 0.140000",
        "most rings at a time: 1",
        "energy lost: 1.298e-4, including 1.242e-4 before the last contact",
    ] {
        assert!(table.contains(words), "{words}: {table}");
    }
    let document = home.json(&["cycle", "fig-9-weak"]);
    let csv = home.quiet(&["cycle", "fig-9-weak", "--rows", "states", "--format", "csv"]);
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let columns = "state,piece,direction,control,approach,force,energy,area,held_stiffness,contact,inner_radius,outer_radius";
    assert_eq!(reader.headers().unwrap().iter().collect::<Vec<_>>().join(","), columns);
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let mut next = rows.iter();
    for (i, state) in document["states"].as_array().unwrap().iter().enumerate() {
        for (k, edges) in state["contacts"].as_array().unwrap().iter().enumerate() {
            let row = next.next().unwrap();
            assert_eq!((&row[0], &row[9]), (&*i.to_string(), &*k.to_string()));
            assert_eq!(row[2], *state["direction"].as_str().unwrap());
            for (column, value) in [(5, &state["force"]), (10, &edges[0]), (11, &edges[1])] {
                assert_eq!(row[column].parse::<f64>().unwrap().to_bits(), number(value).to_bits());
            }
        }
    }
    assert!(next.next().is_none());
    // By the extension of the file.
    home.quiet(&["cycle", "fig-9-weak", "--rows", "states", "-o", "loop.csv"]);
    assert_eq!(home.text("loop.csv"), csv);
    home.quiet(&["cycle", "fig-9-weak", "-o", "loop.json"]);
    assert_eq!(serde_json::from_str::<Value>(&home.text("loop.json")).unwrap(), document);
}

/// A table takes the cells that its columns name: one whose name no cell has would be empty.
#[test]
fn every_column_has_a_value_in_some_row() {
    const ZONE: &str = "--set=material.adhesion=dugdale --set=material.cohesive_strength=1";
    let home = Home::new();
    let (mut seen, mut filled) = (BTreeSet::new(), BTreeSet::new());
    for arguments in [
        "cycle fig-9-weak".to_owned(),
        "cycle fig-9-weak --rows states".to_owned(),
        "unload fig-9".to_owned(),
        format!("unload wavy-sphere {ZONE}"),
        format!("unload wavy-sphere --rows states {ZONE}"),
        "pull wavy-sphere --set edge.exponent=0.5 --rate 0.1".to_owned(),
    ] {
        let arguments: Vec<&str> = arguments.split(' ').chain(["--format", "csv"]).collect();
        let csv = home.run(&arguments).out;
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        let columns: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
        for row in reader.records().map(Result::unwrap) {
            let cells = columns.iter().zip(&row);
            filled.extend(cells.filter(|(_, cell)| !cell.is_empty()).map(|(column, _)| column.clone()));
        }
        seen.extend(columns);
    }
    assert!(seen.len() > 40 && seen.contains("before_zone_radius"), "{seen:?}");
    assert_eq!(seen, filled);
}

#[test]
fn a_loop_turns_where_it_is_told() {
    let home = Home::new();
    let turn = |more: &[&str]| {
        let document = home.json(&[&["cycle", "fig-9-weak", "--no-area"], more].concat());
        let turn = &document["turn"];
        (turn["of"].as_str().unwrap().to_owned(), number(&turn["asked"]), number(&turn["reached"]), document)
    };
    for (flag, value, of) in [
        ("--to-approach", "0.05", "approach"),
        ("--to-force", "0.01", "force"),
        ("--to-control", "0.05", "control"),
    ] {
        let (found, asked, reached, _) = turn(&[flag, value]);
        let value: f64 = value.parse().unwrap();
        assert_eq!((&*found, asked), (of, value));
        assert!((reached - value).abs() < 1e-9, "{flag}: {reached}");
    }
    // The edge jumps over this radius: the state is the first one beyond it.
    let (of, asked, reached, document) = turn(&["--to-radius", "0.13"]);
    assert_eq!((&*of, asked), ("contact_radius", 0.13));
    assert!(reached > 0.15 && document["events"].as_array().unwrap().iter().any(|e| e["kind"] == "turn"));
    // Other controls: the value given is the one that they hold.
    let (of, _, reached, document) = turn(&["--control", "force", "--to-control", "0.01"]);
    assert_eq!((&*of, reached, &document["control"]), ("control", 0.01, &"force".into()));
    assert!(document["totals"]["dissipated"].is_null() && document["totals"]["work_of_unloading"].is_null());
    assert!(number(&document["totals"]["dissipated_before_last_contact"]) > 0.0);
    let (_, _, reached, document) = turn(&["--control", "stiffness=0.2", "--to-control", "0.06"]);
    assert!((reached - 0.06).abs() < 1e-12 && near(&document["control"]["stiffness"], 0.2));
    // Without areas the fields are null, and nothing else changes.
    let (.., without) = turn(&[]);
    let with = home.json(&["cycle", "fig-9-weak"]);
    assert!(without["totals"]["dissipated_by_area"].is_null());
    assert!(without["events"].as_array().unwrap().iter().all(|event| event["dissipated_by_area"].is_null()));
    assert!(near(&with["totals"]["dissipated_by_area"], number(&without["totals"]["dissipated"])));
    assert_eq!(with["states"], without["states"]);
}

#[test]
fn the_turn_of_a_preset_comes_from_the_file_and_is_set() {
    let home = Home::new();
    let of = |arguments: &[&str]| {
        let document = home.json(&[&["cycle", "--no-area"], arguments].concat());
        (document["turn"]["of"].as_str().unwrap().to_owned(), number(&document["turn"]["asked"]))
    };
    // By default, the radius at which the unloading starts.
    assert_eq!(of(&["wavy-sphere"]), ("contact_radius".to_owned(), 0.41));
    assert_eq!(of(&["fig-9-weak"]), ("approach".to_owned(), 0.14));
    // One replaces another.
    assert_eq!(of(&["fig-9-weak", "--set", "path.turn_force=0.01"]), ("force".to_owned(), 0.01));
    assert_eq!(
        of(&["fig-9-weak", "--set", "path.turn_contact_radius=0.2"]),
        ("contact_radius".to_owned(), 0.2)
    );
    let text = home.quiet(&["presets", "show", "fig-9-weak"]);
    home.file("mine.toml", &text.replace("turn_approach = 0.14", "turn_force = 0.02"));
    assert_eq!(of(&["./mine.toml"]), ("force".to_owned(), 0.02));
    home.file("two.toml", &format!("{text}turn_force = 0.02\n"));
    home.refused(&["cycle", "./two.toml"], &["turn_approach", "turn_force"]);
    // With units, in a preset that has them.
    let (kind, asked) = of(&["fig-9-si", "--set", "path.turn_approach=10um"]);
    assert!(kind == "approach" && (asked - 1e-5).abs() < 1e-18, "{asked}");
    let (kind, asked) = of(&["fig-9-si", "--to-radius", "0.3mm"]);
    assert!(kind == "contact_radius" && (asked - 3e-4).abs() < 1e-16, "{asked}");
    home.refused(&["cycle", "fig-9-si", "--to-radius", "3mN"], &["--to-radius"]);
}

#[test]
fn what_cannot_be_is_said_with_the_number_that_would_do() {
    let home = Home::new();
    home.refused(&["cycle", "fig-9-weak", "--to-approach", "-0.01"], &["-0.01", "0"]);
    home.refused(&["cycle", "fig-9-weak", "--to-approach", "1", "--to-force", "1"], &["--to-force"]);
    home.refused(&["cycle", "fig-9-weak", "--to-approach", "x"], &["--to-approach"]);
    home.refused(&["cycle", "fig-9-weak", "--to-radius", "-1"], &[]);
    home.refused(&["cycle", "fig-9-weak", "--control", "glue"], &["--control"]);
    // Beyond the rows of a profile.
    home.refused(&["cycle", "profile", "--to-radius", "1000"], &["1000"]);
    home.refused(&["cycle", "profile", "--to-approach", "1000"], &["approach"]);
    // Without adhesion the contact cannot bear a pull.
    let zero = ["--set", "material.work_of_adhesion=0"];
    for flags in
        [["--control", "force", "--to-force", "-0.01"], ["--control", "force", "--to-control", "-0.01"]]
    {
        home.refused(&[&["cycle", "fig-9-weak"], &zero[..], &flags[..]].concat(), &["0"]);
    }
    home.refused(&["cycle", "nothing"], &["nothing"]);
}

#[test]
fn strict_makes_a_warning_a_failure_and_writes_all_the_same() {
    let home = Home::new();
    assert!(home.quiet(&["cycle", "fig-9-weak", "--strict"]).contains("last-contact"));
    let range = "material.range_of_action=0.1";
    let ended = home.run(&["cycle", "fig-9-weak", "--set", range, "--strict"]);
    assert_eq!(ended.status, 3, "{}", ended.err);
    assert!(ended.out.contains("last-contact") && ended.err.contains("Tabor"), "{}", ended.err);
    assert_eq!(home.run(&["cycle", "fig-9-weak", "--set", range]).status, 0);
}

#[test]
fn a_signal_ends_it_and_leaves_no_file() {
    let home = Home::new();
    // Long enough that the signal comes before the end.
    let long = [
        "cycle",
        "fig-9-weak",
        "--set",
        "gap.wavelength=0.005",
        "--set",
        "gap.amplitude=2.5e-5",
        "--set",
        "material.work_of_adhesion=1e-9",
        "-o",
        "loop.json",
    ];
    let ended = home.stopped(&long, Signal::INT);
    assert_eq!(ended.status, 130, "{}", ended.err);
    assert!(!home.path("loop.json").exists());
    let left = std::fs::read_dir(home.folder()).unwrap().count();
    assert!(left <= 1, "{left} files left");
}

#[test]
fn a_gap_whose_first_touch_is_a_ring() {
    let document = Home::new().json(&["cycle", "crater"]);
    let first = &document["events"][0];
    assert!(number(&first["radius"]) > 0.1 && number(&first["control"]) < 0.0);
    let contacts = first["after"]["contacts"].as_array().unwrap();
    assert!(contacts.len() == 1 && number(&contacts[0][0]) > 0.05);
    assert_eq!(kinds(&document), ["first-touch", "snap-in", "turn", "last-contact"]);
}

#[test]
fn without_adhesion_the_way_back_is_the_way_there() {
    let home = Home::new();
    let set = ["--set", "material.work_of_adhesion=0", "--to-approach", "0.06"];
    let document = home.json(&[&["cycle", "fig-9-weak"], &set[..]].concat());
    let events = document["events"].as_array().unwrap();
    assert!(events.iter().all(|event| number(&event["dissipated"]) == 0.0));
    let count = |kind: &str| kinds(&document).into_iter().filter(|found| *found == kind).count();
    assert_eq!((count("touch"), count("vanish")), (5, 5));
    let Ended { status, .. } = home.run(&["plot", "fig-9-weak", "--view", "contact-map", set[0], set[1]]);
    assert_eq!(status, 0);
}

/// The jumps of unloading as (s before, s after); the last one has no landing.
fn ways_down(document: &Value) -> Vec<(f64, Option<f64>)> {
    let events = document["events"].as_array().unwrap().iter();
    let down = events.filter(|event| event["direction"] == "unloading");
    let radius = |state: &Value| state["contact_radius"].as_f64();
    down.map(|event| (radius(&event["before"]).unwrap(), radius(&event["after"]))).collect()
}

/// One disc is followed on its exact panels: no jump is missed because it is close to another or on a corner, wherever
/// the loop turns.
#[test]
fn no_jump_of_one_disc_is_missed() {
    let home = Home::new();
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/loops");
    let of = |name: &str, turn: [&str; 2]| {
        let document = home.json(&["cycle", &format!("{folder}/{name}.toml"), turn[0], turn[1]]);
        assert_eq!(document["warnings"], Value::Array(vec![]), "{name}");
        document
    };
    let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
    // A corner: its limit point is known in closed form, and accounts for a sixth of the losses.
    let corner = of("concave-corner", ["--to-radius", "0.3"]);
    let down = ways_down(&corner);
    assert!(
        down.len() == 2 && near(down[0].0, 0.156_698_8) && near(down[0].1.unwrap(), 0.143_420),
        "{down:?}"
    );
    let events = corner["events"].as_array().unwrap();
    let lost: Vec<f64> = events.iter().map(|event| number(&event["dissipated"])).collect();
    let snap = lost[lost.len() - 2] / lost.iter().sum::<f64>();
    assert!((0.15..0.18).contains(&snap), "{snap}");
    // Two limit points that nearly coincide: both snaps are found, whatever the turn.
    for turn in ["0.01", "0.02", "0.03"] {
        let down = ways_down(&of("near-cusp", ["--to-control", turn]));
        assert_eq!(down.iter().filter(|(_, after)| after.is_some()).count(), 2, "{turn}: {down:?}");
    }
    // Knots close to the axis: the end is not an unstable piece.
    let down = ways_down(&of("lost-pull-off", ["--to-radius", "0.3"]));
    assert!(down.len() == 2 && near(down[0].0, 0.022_322), "{down:?}");
    assert!(near(down[1].0, 0.021_344) && down[1].1.is_none(), "{down:?}");
    // Waves too short to matter have no effect: the loop of the smooth sphere.
    let short = of("short-wave", ["--to-radius", "0.4"]);
    assert_eq!(kinds(&short), ["first-touch", "turn", "last-contact"]);
    assert!((number(&short["events"][0]["after"]["contact_radius"]) - 0.293).abs() < 1e-3);
    let smooth = home.json(&[
        "cycle",
        &format!("{folder}/short-wave.toml"),
        "--set",
        "gap.amplitude=0",
        "--to-radius",
        "0.4",
    ]);
    let [a, b] = [&short, &smooth].map(|document| ways_down(document)[0].0);
    assert!((a / b - 1.0).abs() < 0.01, "{a} {b}");
    // A wavy sphere whose loop turns just outside a limit point.
    let set = [
        "gap.amplitude=4.2667028e-4",
        "gap.wavelength=0.0842836816",
        "material.work_of_adhesion=1.913167e-3",
    ];
    let set: Vec<&str> = set.iter().flat_map(|value| ["--set", value]).collect();
    let wavy = home.json(&[&["cycle", "wavy-sphere", "--to-radius", "0.30842864"], &set[..]].concat());
    let down = ways_down(&wavy);
    assert!((down[0].0 - 0.13781).abs() < 1e-5 && (down[0].1.unwrap() - 0.12857).abs() < 1e-5, "{down:?}");
    // A power law as shipped gives a loop, and so does a profile up to its end, without a warning.
    assert_eq!(kinds(&home.json(&["cycle", "power-law"])), ["first-touch", "turn", "last-contact"]);
    let profile = home.json(&["cycle", "profile", "--to-radius", "99"]);
    assert_eq!(profile["warnings"], Value::Array(vec![]));
    assert_eq!(ways_down(&profile).len(), 3);
}

/// A bump far narrower than the contact touches at its own place, before the disc reaches it or anything else does.
#[test]
fn a_narrow_bump_is_touched() {
    let home = Home::new();
    // A vanishing ring costs the losses by area some digits, and a warning says so.
    let loop_of = |arguments: &[&str]| -> Value {
        let ended = home.run(&[arguments, &["--format=json"]].concat());
        assert_eq!(ended.status, 0, "{}", ended.err);
        serde_json::from_str(&ended.out).unwrap()
    };
    let preset = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/loops/narrow-bump.toml");
    let document = loop_of(&["cycle", preset, "--to-approach", "0.035"]);
    let touch = document["events"].as_array().unwrap().iter().find(|event| event["kind"] == "touch").unwrap();
    assert!((number(&touch["control"]) - 0.0181).abs() < 1e-4, "{touch}");
    let contacts = touch["after"]["contacts"].as_array().unwrap();
    let ring: Vec<f64> = contacts[1].as_array().unwrap().iter().map(number).collect();
    assert!(contacts.len() == 2 && ring[0] < 0.3 && ring[1] > 0.3 && ring[1] - ring[0] < 1e-3, "{touch}");
    let higher = ["--set", "gap.parameters.a=0.06", "--to-approach", "0.002"];
    let document = loop_of(&[&["cycle", preset], &higher[..]].concat());
    let first = &document["events"][0];
    assert_eq!(first["kind"], "first-touch");
    assert!(
        (number(&first["radius"]) - 0.3).abs() < 1e-6 && (number(&first["control"]) + 0.015).abs() < 1e-5,
        "{first}"
    );
}

#[test]
fn one_disc_alone_is_marked_where_bodies_would_overlap_on_the_way_up_too() {
    let ended = Home::new().run(&["cycle", "fig-9-weak", "--one-disc", "--no-area", "--format", "json"]);
    assert!(ended.err.contains("the path crosses 7 intervals of inadmissible states"), "{}", ended.err);
    let document: Value = serde_json::from_str(&ended.out).unwrap();
    let parts = document["inadmissible"].as_array().unwrap();
    // The crest at 0.0488 touches when the disc has the radius 0.01069, on its way to the limit point at 0.02027.
    let innermost = parts.last().unwrap();
    assert!((number(&innermost["to_contact_radius"]) - 0.010_691_08).abs() < 1e-7, "{innermost}");
    let limit = number(&document["events"][1]["before"]["contact_radius"]);
    assert!((number(&innermost["from_contact_radius"]) - limit).abs() < 1e-6 && limit < 0.021, "{innermost}");
    assert_eq!(document["events"][1]["admissible"], false);
}
