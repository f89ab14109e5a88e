//! User input: assignments, preset files, names; and the messages about what is wrong with them.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::Home;
use serde_json::Value;
use std::path::Path;

fn kinds(document: &Value) -> Vec<&str> {
    document["events"].as_array().unwrap().iter().map(|event| event["kind"].as_str().unwrap()).collect()
}

// ---- --set and --control ----

#[test]
fn set_changes_a_key_and_the_last_of_one_key_holds() {
    let home = Home::new();
    let document =
        home.json(&["unload", "fig-8", "--set", "gap.amplitude=0.001", "--set", "gap.amplitude=0.002"]);
    assert_eq!(document["problem"]["preset"]["gap"]["amplitude"], 0.002);
}

#[test]
fn a_bad_assignment_names_the_key_and_what_was_meant() {
    let home = Home::new();
    for (assignment, said) in [
        ("gap.amplitud=3", ["gap.amplitud", "did you mean gap.amplitude?"]),
        ("amplitud=3", ["unknown key", "gap.amplitude"]),
        ("gap.amplitude=-3", ["gap.amplitude", "out of range"]),
        ("gap.amplitude=wide", ["gap.amplitude", "number"]),
        ("gap.shape=spere", ["gap.shape", "did you mean sphere?"]),
        ("basis.rings=3", ["basis.rings", "from 4 to 2000"]),
        ("basis.rings=20.5", ["basis.rings", "whole number"]),
        ("path.control=load", ["path.control", "displacement"]),
        ("path.end_contact_radius=0.6", ["path.end_contact_radius", "0.5"]),
        ("material.work_of_adhesion=nan", ["material.work_of_adhesion", "out of range"]),
        // A key of the preset comes before a group of the same name.
        ("adhesion=3", ["adhesion=3: material.adhesion", "short-range"]),
        ("nothing", ["KEY=VALUE", "nothing"]),
    ] {
        for command in ["trace", "unload"] {
            home.refused(&[command, "fig-9", "--set", assignment], &said);
        }
    }
}

#[test]
fn a_bad_control_is_bad_usage() {
    let home = Home::new();
    for control in [
        "",
        "load",
        "Force",
        "stiffness",
        "stiffness=",
        "stiffness=0",
        "stiffness=-1",
        "stiffness=inf",
        "stiffness=nan",
        "stiffness=1e-40",
    ] {
        home.refused(&["unload", "fig-9", "--control", control], &["control"]);
    }
}

#[test]
fn bad_usage_is_refused() {
    let home = Home::new();
    home.refused(&["unload", "fig-9", "--format", "xml"], &["xml"]);
    home.refused(&["trace", "fig-9", "--format", "xml"], &["xml"]);
    home.refused(&["unload", "fig-9", "extra"], &["extra"]);
    home.refused(&["presets"], &["list"]);
}

// ---- what assignments did that their text does not show ----

#[test]
fn what_a_group_changed_is_told() {
    let home = Home::new();
    let ended = home.run(&["unload", "fig-9-si", "--set", "groups.amplitude_over_wavelength=0.04"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    assert!(ended.err.contains("note: groups changed gap.amplitude = 10 um\n"), "{}", ended.err);
    // An assignment beside a group is not a change by the group.
    let beside = [
        "unload",
        "fig-9-si",
        "--set",
        "gap.wavelength=200 um",
        "--set",
        "groups.amplitude_over_wavelength=0.05",
    ];
    let ended = home.run(&beside);
    assert!(ended.err.contains("note: groups changed gap.amplitude = 10 um\n"), "{}", ended.err);
}

#[test]
fn a_bare_number_far_from_the_presets_own_is_worth_a_word_in_si() {
    let home = Home::new();
    let said = |preset: &str, assignment: &str| {
        home.run(&["plot", preset, "--set", assignment, "-o", "out.svg"]).err
    };
    let warning = said("fig-9-si", "material.effective_modulus=40");
    let expected =
        "warning: material.effective_modulus is 0.04 kPa now, 40 kPa in the preset: a bare number is SI";
    assert!(warning.contains(expected), "{warning}");
    // Close enough, or with a unit, or in a preset without units.
    for (preset, assignment) in [
        ("fig-9-si", "gap.amplitude=11e-6"),
        ("fig-9-si", "gap.amplitude=0.001 um"),
        ("fig-9", "gap.amplitude=1e-7"),
    ] {
        let said = said(preset, assignment);
        assert!(!said.contains("bare number"), "{preset} {assignment}: {said}");
    }
}

// ---- preset files ----

const FILE: &str = "[material]\neffective_modulus = 1.0\nwork_of_adhesion = 0.01\n[gap]\nshape = \"sphere\"\n\
                    radius_of_curvature = 1.0\n";

#[test]
fn a_preset_file_needs_only_its_required_keys() {
    let home = Home::new();
    let file = home.file("mine.toml", FILE);
    let document = home.json(&["unload", &file]);
    assert_eq!(kinds(&document), ["last-contact"]);
    let basis = &document["problem"]["preset"]["basis"];
    assert_eq!(*basis, serde_json::json!({"kind": "exact"}));
    let end = document["problem"]["end_contact_radius"].as_f64().unwrap();
    assert!((end - 0.002).abs() < 1e-15, "{end}");
    // Relative and without a slash, but a file because it ends in .toml.
    assert_eq!(home.json(&["unload", "mine.toml"])["events"], document["events"]);
}

#[test]
fn a_mistake_in_a_file_is_named_with_file_line_and_key() {
    let home = Home::new();
    for (text, said) in [
        (
            FILE.replace("radius_of_curvature", "radius_of_curvatur"),
            vec!["bad.toml:6", "radius_of_curvature"],
        ),
        (
            FILE.replace("[gap]", "work_of_adhesion = 0.02\n[gap]"),
            vec!["bad.toml:4", "duplicate", "work_of_adhesion"],
        ),
        (FILE.replace("0.01", "-0.01"), vec!["bad.toml:3", "material.work_of_adhesion"]),
        (FILE.replace("[gap]", "[gap"), vec!["bad.toml:4"]),
        (FILE.replace("effective_modulus = 1.0\n", ""), vec!["bad.toml", "material.effective_modulus"]),
        (
            format!("{FILE}[path]\nstart_force = 0.1\nstart_approach = 0.1\n"),
            vec!["bad.toml", "start_force", "start_approach"],
        ),
    ] {
        let file = home.file("bad.toml", &text);
        home.refused(&["trace", &file], &said);
    }
    home.refused(&["trace", "none.toml"], &["none.toml"]);
    home.refused(&["trace", "./"], &["regular file"]);
}

#[test]
fn an_unknown_preset_is_bad_input() {
    let home = Home::new();
    for command in ["trace", "unload"] {
        home.refused(&[command, "fig-99"], &["fig-99"]);
    }
    home.refused(&["presets", "show", "fig-99"], &["fig-99"]);
}

// ---- warnings ----

#[test]
fn too_few_rings_per_wave_is_a_warning_on_stderr_and_in_the_document() {
    let home = Home::new();
    for command in ["trace", "unload"] {
        let ended = home.run(&[command, "fig-9", "--set", "basis.rings=99", "--format", "json"]);
        assert_eq!(ended.status, 0);
        let document: Value = serde_json::from_str(&ended.out).unwrap();
        let warnings = document["warnings"].as_array().unwrap();
        assert_eq!(warnings.len(), 1);
        let warning = warnings[0].as_str().unwrap();
        assert!(warning.contains("rings per wave") && warning.contains("basis.rings"), "{warning}");
        assert_eq!(ended.err, format!("pulloff: warning: {warning}\n"));
        // Ten are enough.
        home.quiet(&[command, "fig-9", "--set", "basis.rings=100"]);
    }
}

#[test]
fn a_curve_that_ends_is_no_pull_off() {
    let home = Home::new();
    // One ring per wave cannot resolve the gap: beyond some radius the basis has no equilibrium.
    let file = home.file(
        "coarse.toml",
        "[material]\neffective_modulus = 7e10\nwork_of_adhesion = 0.0473\n[gap]\nshape = \"wavy-sphere\"\n\
         radius_of_curvature = 2e-8\namplitude = 5.8363e-12\nwavelength = 7.2086e-10\n[basis]\nrings = 30\n\
         [path]\nstart_contact_radius = 1.8156e-8\n",
    );
    let ended = home.run(&["unload", &file, "--format", "json"]);
    assert_eq!(ended.status, 1, "{}", ended.err);
    let document: Value = serde_json::from_str(&ended.out).unwrap();
    assert_eq!(kinds(&document), [""; 0]);
    let stop = document["stop"].as_str().unwrap();
    // The radius at which it ends, in the units of the preset.
    assert!(stop.contains("no equilibrium") && stop.contains("e-8"), "{stop}");
    assert!(ended.err.contains("stopped early") && ended.err.contains(stop), "{}", ended.err);
}

// ---- presets ----

#[test]
fn presets_are_listed_shown_and_located() {
    let home = Home::new();
    let list = home.quiet(&["presets", "list"]);
    let listed: Vec<&str> = list.lines().map(|line| line.split_whitespace().next().unwrap()).collect();
    let shipped: Vec<&str> = pulloff::store::SHIPPED.iter().map(|shipped| shipped.name).collect();
    assert_eq!(listed, shipped);
    assert!(listed.starts_with(&["wavy-sphere", "fig-1-hertz"]) && listed.contains(&"profile"), "{list}");
    assert!(list.lines().all(|line| line.contains("  shipped  ")), "{list}");

    let folder = home.path("config/pulloff/presets");
    assert_eq!(home.quiet(&["presets", "path"]), format!("{}\n", folder.to_str().unwrap()));

    let shown = home.quiet(&["presets", "show", "fig-9"]);
    assert!(shown.contains("shape = \"wavy-sphere\""), "{shown}");
    // The output is a preset file that gives the same result.
    let copy = home.file("copy.toml", &shown);
    assert_eq!(home.quiet(&["unload", &copy]), home.quiet(&["unload", "fig-9"]));

    home.file("config/pulloff/presets/mine.toml", FILE);
    home.file("config/pulloff/presets/broken.toml", "[material]\n");
    let list = home.quiet(&["presets", "list"]);
    let line = |name: &str| list.lines().find(|line| line.starts_with(name)).unwrap().to_owned();
    assert!(line("mine").contains("yours"), "{list}");
    assert!(line("broken").contains("cannot be read"), "{list}");
    assert_eq!(home.quiet(&["presets", "show", "mine"]), FILE);
    assert_eq!(kinds(&home.json(&["unload", "mine"])), ["last-contact"]);
}

// ---- the explorer without a terminal ----

#[test]
fn the_explorer_without_a_terminal_is_one_clear_line() {
    let home = Home::new();
    for arguments in [[].as_slice(), &["fig-9"]] {
        let ended = home.run(arguments);
        assert_eq!((ended.status, ended.out.as_str()), (2, ""), "{arguments:?}");
        assert!(ended.err.starts_with("pulloff: "), "{:?}", ended.err);
        assert_eq!(ended.err.trim_end().lines().count(), 1, "{:?}", ended.err);
        assert!(!ended.err.contains('\x1b'), "{:?}", ended.err);
    }
}

#[test]
fn help_and_version_are_no_errors() {
    let home = Home::new();
    assert_eq!(home.quiet(&["--version"]), format!("pulloff {}\n", env!("CARGO_PKG_VERSION")));
    for arguments in
        [["--help"].as_slice(), &["trace", "--help"], &["unload", "--help"], &["presets", "--help"]]
    {
        assert!(home.quiet(arguments).contains("Usage"), "{arguments:?}");
    }
}

#[test]
fn a_preset_of_ones_own_is_deleted_and_no_other() {
    let home = Home::new();
    let file = home.file("config/pulloff/presets/mine.toml", FILE);
    // Without a terminal nobody can answer.
    home.refused(&["presets", "delete", "mine"], &["--yes"]);
    home.refused(&["presets", "delete", "fig-9", "--yes"], &["fig-9 comes with the program"]);
    home.refused(&["presets", "delete", "mime", "--yes"], &["did you mean mine?"]);
    home.refused(&["presets", "delete", "./mine.toml", "--yes"], &["is not a preset name"]);
    assert!(Path::new(&file).exists());
    let ended = home.run(&["presets", "delete", "mine", "--yes"]);
    assert_eq!((ended.status, ended.out.as_str()), (0, ""));
    assert!(ended.err.contains("deleted") && ended.err.contains("mine.toml"), "{}", ended.err);
    assert!(!Path::new(&file).exists());
}

#[test]
fn a_profile_without_units_in_si_is_taken_in_metres_with_a_warning() {
    let home = Home::new();
    let rows = |unit: f64| -> String {
        (0..200)
            .map(f64::from)
            .map(|i| format!("{},{}\n", i * 5.0 * unit, (i * 0.005).powi(2) * 500.0 * unit))
            .collect::<Vec<_>>()
            .concat()
    };
    let preset = home.file(
        "scan.toml",
        "units = \"SI\"\n[material]\neffective_modulus = \"1 MPa\"\nwork_of_adhesion = \"50 mJ/m^2\"\n[gap]\n\
         shape = \"profile\"\nfile = \"scan.csv\"\n[path]\nstart_contact_radius = \"100 um\"\n",
    );
    home.file("scan.csv", &format!("r / um, h / um\n{}", rows(1.0)));
    let named = home.json(&["unload", &preset]);
    home.file("scan.csv", &format!("r, h\n{}", rows(1e-6)));
    let bare = home.run(&["unload", &preset, "--format", "json"]);
    assert!(
        bare.err.contains("scan.csv: names no unit of length, so its columns are taken to be in m"),
        "{}",
        bare.err
    );
    let bare: Value = serde_json::from_str(&bare.out).unwrap();
    let force = |document: &Value| document["totals"]["largest_pull"]["force"].as_f64().unwrap();
    assert!((force(&bare) / force(&named) - 1.0).abs() < 1e-9, "{bare} {named}");
    home.file("scan.csv", &format!("h [um],r [um]\n{}", rows(1.0)));
    home.refused(&["unload", &preset], &["the header names the gap \"h\" first", "scan.csv"]);
}

#[test]
fn many_rows_are_averaged_with_a_note_and_holes_refused_with_a_smoothing_that_works() {
    let home = Home::new();
    let preset = home.file(
        "scan.toml",
        "units = \"SI\"\n[material]\neffective_modulus = \"1 MPa\"\nwork_of_adhesion = \"50 mJ/m^2\"\n[gap]\n\
         shape = \"profile\"\nfile = \"scan.csv\"\n[path]\nstart_contact_radius = \"100 um\"\n",
    );
    let rows = |wanted: fn(f64) -> bool| -> String {
        let radii = (0..=20_000).map(|i| f64::from(i) * 0.03).filter(|r| wanted(*r));
        let rows = radii.map(|r| format!("{r:.2} {:.9}\n", r * r / 2000.0));
        format!("r [um] h [um]\n{}", rows.collect::<Vec<_>>().concat())
    };
    let notes = |arguments: &[&str]| {
        let document = home.json(&[&["unload", &preset], arguments].concat());
        let notes = document["notes"].as_array().unwrap();
        notes.iter().map(|note| note.as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    home.file("scan.csv", &rows(|_| true));
    let smooth = ["--set", "gap.smoothing=20 um"];
    assert_eq!(
        notes(&[]),
        [
            "20 001 rows averaged in 4000 cells of 0.15 um: waves shorter than 0.6 um are not in the gap",
            "whether the bodies stay apart outside the disc is known up to r = 600 um, and unknown beyond"
        ]
    );
    let said = notes(&smooth);
    assert_eq!(said[0], "20 001 rows averaged in 240 cells of 2.5 um");
    assert!(said[1].starts_with("smoothing: waves of 20 um are halved"), "{said:?}");
    home.file("scan.csv", &rows(|r| !(200.0..202.0).contains(&r)));
    let hole =
        ["scan.csv: no row lies between the radii 199.98 um and 202.02 um", "gap.smoothing = \"19 um\""];
    home.refused(&["unload", &preset], &hole);
    assert_eq!(notes(&["--set", "gap.smoothing=19 um"]).len(), 3);
}
