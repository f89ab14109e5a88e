//! `pulloff map`: its rows, its figures, its refusals; the same counts as in a sweep.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

const MAP: [&str; 4] = [
    "--x-key",
    "groups.amplitude_over_wavelength=0.0005..0.0125",
    "--y-key",
    "groups.adhesion=log:0.002..0.2",
];

fn pulloff(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pulloff"));
    command.env_clear().env("HOME", folder).env("XDG_CONFIG_HOME", folder).current_dir(folder);
    command.args(arguments).stdin(Stdio::null()).output().unwrap()
}

fn text(folder: &Path, arguments: &[&str]) -> String {
    let output = pulloff(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_rows_are_points_of_lines_and_the_smallest_amplitude_is_said() {
    let home = tempfile::tempdir().unwrap();
    let output = pulloff(home.path(), &[&["map", "wavy-sphere"][..], &MAP].concat());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("smallest A/lambda at which this preset snaps is 0.001215"), "{said}");
    let text = String::from_utf8(output.stdout).unwrap();
    let mut rows = csv::Reader::from_reader(text.as_bytes());
    let header: Vec<String> = rows.headers().unwrap().iter().map(str::to_owned).collect();
    assert_eq!(header, ["line", "kind", "crest", "contact_radius", "x", "y", "control", "stable", "changes"]);
    let mut kinds = std::collections::BTreeSet::new();
    for row in rows.records() {
        let row = row.unwrap();
        kinds.insert(row[1].to_owned());
        let [x, y]: [f64; 2] = [4, 5].map(|k| row[k].parse().unwrap());
        assert!((0.0005..=0.0125).contains(&x) && (0.002..=0.2).contains(&y), "{row:?}");
    }
    assert_eq!(kinds.into_iter().collect::<Vec<_>>(), ["cusp", "landing", "swallowtail"]);
}

#[test]
fn a_map_over_the_device_has_no_control_and_no_onset_of_its_own() {
    let home = tempfile::tempdir().unwrap();
    for (axis, control) in [("k=0.1..10", "null"), ("gamma=0.002..0.006", "\"displacement\"")] {
        let asked = ["map", "wavy-sphere", "--x-key", axis, "--y", "force", "--format", "json"];
        let json: serde_json::Value = serde_json::from_str(&text(home.path(), &asked)).unwrap();
        assert_eq!(json["control"].to_string(), control);
        assert_eq!(json["onset"].is_null(), control == "null", "{}", json["onset"]);
    }
}

#[test]
fn the_counts_are_those_of_a_sweep_and_it_is_drawn_over_one() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let json: serde_json::Value = {
        text(folder, &[&["map", "wavy-sphere"][..], &MAP, &["-o", "map.json"]].concat());
        serde_json::from_str(&fs::read_to_string(folder.join("map.json")).unwrap()).unwrap()
    };
    let numbers = |key: &str| -> Vec<f64> {
        json["counts"][key].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
    };
    let (x, y) = (numbers("x"), numbers("y"));
    let all = |all: &[f64]| all.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(", ");
    let spec = format!(
        "preset = \"wavy-sphere\"\nquantities = [\"snaps\"]\n[[axis]]\nkey = \"groups.amplitude_over_wavelength\"\nvalues = [{}]\n\
         [[axis]]\nkey = \"groups.adhesion\"\nvalues = [{}]\n",
        all(&x),
        all(&y)
    );
    fs::write(folder.join("sweep.toml"), spec).unwrap();
    text(folder, &["sweep", "sweep.toml", "-o", "sweep.csv"]);
    let swept = fs::read_to_string(folder.join("sweep.csv")).unwrap();
    let mut rows = csv::Reader::from_reader(swept.as_bytes());
    let at = |rows: &csv::StringRecord, name: &str| rows.iter().position(|cell| cell == name).unwrap();
    let header = rows.headers().unwrap().clone();
    let columns =
        ["groups.amplitude_over_wavelength", "groups.adhesion", "snaps"].map(|name| at(&header, name));
    let mut compared = 0;
    for row in rows.records() {
        let row = row.unwrap();
        let [a, b, snaps]: [f64; 3] = columns.map(|k| row[k].parse().unwrap());
        let place =
            |all: &[f64], x: f64| all.iter().position(|other| (other - x).abs() <= 1e-12 * x).unwrap();
        let ours = json["counts"]["snaps"][place(&y, b)][place(&x, a)].as_f64().unwrap();
        assert_eq!(ours.to_bits(), snaps.to_bits(), "{row:?}");
        compared += 1;
    }
    assert_eq!(compared, x.len() * y.len());
    text(folder, &[&["map", "wavy-sphere"][..], &MAP, &["--over", "sweep.csv", "-o", "over.svg"]].concat());
    let picture = fs::read_to_string(folder.join("over.svg")).unwrap();
    assert!(picture.contains("line of cusps") && picture.contains("line of landings"));
}

#[test]
fn limit_points_over_one_number() {
    let home = tempfile::tempdir().unwrap();
    let all = text(home.path(), &["map", "--x-key", "groups.adhesion=0.005..0.2", "--y", "control"]);
    let count = |kind: &str| all.lines().filter(|line| line.split(',').nth(1) == Some(kind)).count();
    assert!(count("fold") > 100 && count("landing") == 3 && count("cusp") == 1, "{}", all.len());
    assert!(all.contains(",outward,") && all.contains(",inward,"));
}

#[test]
fn forces_over_the_modulus_are_those_of_its_values() {
    let folder = tempfile::tempdir().unwrap();
    let of = |modulus: &str| {
        let preset = include_str!("../../presets/fig-9.toml");
        let changed = preset.replace("effective_modulus = 1.0", &format!("effective_modulus = {modulus}"));
        fs::write(folder.path().join("of.toml"), changed).unwrap();
        let asked = ["map", "of.toml", "--set", "basis.kind=exact", "--control", "force"];
        let axes = ["--x-key", "material.effective_modulus=1.5..2.5", "--y", "force", "--format", "csv"];
        text(folder.path(), &[&asked[..], &axes].concat())
    };
    let rows = of("1.0");
    assert_eq!(rows, of("2.0"));
    // The path begins its jumps at limit points of the force.
    let path = [
        "unload",
        "fig-9",
        "--set",
        "basis.kind=exact",
        "--set",
        "E*=1.5",
        "--control",
        "force",
        "--format",
        "csv",
    ];
    let path = text(folder.path(), &path);
    let numbers =
        |line: &str| -> Vec<f64> { line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect() };
    let at = path.lines().next().unwrap().split(',').position(|name| name == "before_force").unwrap();
    let begins: Vec<f64> = path.lines().skip(1).map(|line| numbers(line)[at]).collect();
    let limits: Vec<f64> = rows
        .lines()
        .skip(1)
        .map(numbers)
        .filter(|row| (row[4] - 1.5).abs() < 1e-12)
        .map(|row| row[5])
        .collect();
    assert!(begins.len() > 5, "{path}");
    for force in begins {
        assert!(limits.iter().any(|limit| (limit / force - 1.0).abs() < 1e-8), "{force} {limits:?}");
    }
}

#[test]
fn files_are_replaced_only_when_told_and_figures_are_of_their_format() {
    let home = tempfile::tempdir().unwrap();
    let folds = ["map", "--x-key", "groups.adhesion=log:0.005..0.2", "--y", "approach"];
    fs::write(home.path().join("a.csv"), "mine").unwrap();
    let again = pulloff(home.path(), &[&folds[..], &["-o", "a.csv"]].concat());
    assert_eq!(again.status.code(), Some(2));
    text(home.path(), &[&folds[..], &["-o", "a.csv", "--overwrite"]].concat());
    let rows = fs::read_to_string(home.path().join("a.csv")).unwrap();
    assert!(rows.starts_with("line,kind,crest,"), "{rows}");
    // A logarithmic axis begins where requested, and -o - is standard output.
    assert_eq!(text(home.path(), &[&folds[..], &["-o", "-"]].concat()), rows);
    let numbers = rows.lines().skip(1).filter_map(|row| row.split(',').nth(4)?.parse::<f64>().ok());
    let [lo, hi] = numbers.fold([f64::INFINITY, 0.0], |[lo, hi]: [f64; 2], x| [lo.min(x), hi.max(x)]);
    assert!((lo / 0.005 - 1.0).abs() < 1e-9 && (hi / 0.2 - 1.0).abs() < 1e-9, "{lo} {hi}");
    let document: serde_json::Value = {
        text(home.path(), &[&folds[..], &["-o", "a.json"]].concat());
        serde_json::from_slice(&fs::read(home.path().join("a.json")).unwrap()).unwrap()
    };
    assert_eq!(
        (&document["x"]["logarithmic"], &document["counts"]),
        (&true.into(), &serde_json::Value::Null)
    );
    assert_eq!(document["rows"].as_array().unwrap().len(), rows.lines().count() - 1);
    text(home.path(), &[&folds[..], &["-o", "a.png"]].concat());
    assert!(fs::read(home.path().join("a.png")).unwrap().starts_with(b"\x89PNG"));
    let pdf = pulloff(home.path(), &[&folds[..], &["-o", "a.pdf"]].concat());
    if cfg!(feature = "pdf") {
        assert!(fs::read(home.path().join("a.pdf")).unwrap().starts_with(b"%PDF"));
    } else {
        let said = String::from_utf8_lossy(&pdf.stderr).into_owned();
        assert!(pdf.status.code() == Some(2) && said.contains("cannot write PDF"), "{said}");
        assert!(!home.path().join("a.pdf").exists());
    }
}

#[test]
fn results_of_another_sweep_are_not_drawn_under_the_lines() {
    let home = tempfile::tempdir().unwrap();
    let spec = "preset = \"wavy-sphere\"\nquantities = [\"snaps\"]\n[[axis]]\nkey = \"gap.amplitude\"\nvalues = [1e-4, 2e-4]\n\
                [[axis]]\nkey = \"groups.adhesion\"\nvalues = [0.01, 0.02]\n";
    fs::write(home.path().join("sweep.toml"), spec).unwrap();
    text(home.path(), &["sweep", "sweep.toml", "-o", "sweep.csv"]);
    // The same axes, on a gap whose other values differ.
    let same = spec
        .replace("gap.amplitude", "groups.amplitude_over_wavelength")
        .replace("[1e-4, 2e-4]", "[0.005, 0.01]");
    fs::write(home.path().join("same.toml"), same).unwrap();
    text(home.path(), &["sweep", "same.toml", "-o", "same.csv"]);
    let own = ["--set", "gap.wavelength=0.1"];
    for (more, words) in [
        (
            &[&["--over", "same.csv", "-o", "a.svg"][..], &own].concat()[..],
            "same.csv: is a sweep of another problem: gap.wavelength is 0.05 there, and 0.1 here",
        ),
        (
            &["--over", "sweep.csv", "-o", "a.svg"][..],
            "is a sweep over gap.amplitude and groups.adhesion, not over",
        ),
        (&["--over", "sweep.csv", "-o", "a.csv"], "under the lines of a figure"),
        (&["--over", "none.csv", "-o", "a.svg"], "none.csv"),
    ] {
        let output = pulloff(home.path(), &[&["map", "wavy-sphere"][..], &MAP, more].concat());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && said.contains(words), "{more:?}: {said}");
    }
}

#[test]
fn refusals_name_what_is_wrong_and_keep_files() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("there.csv"), "mine").unwrap();
    let over = |range: &str| {
        vec!["map".to_owned(), "--x-key".to_owned(), range.to_owned(), "--y".into(), "force".into()]
    };
    let cases: Vec<(Vec<String>, &str)> = vec![
        (over("gap.amplitud=0..1"), "gap.amplitude"),
        (over("gap.amplitude"), "KEY=FROM..TO"),
        (over("groups.adhesion=1..0.5"), "from a number to a larger one"),
        (over("groups.adhesion=log:0..1"), "must begin above zero"),
        (over("basis.kind=1..2"), "a range must be of a number"),
        (over("basis.rings=10..20"), "must be a real number of the preset"),
        (over("material.closing_work_of_adhesion=1e-3..3e-3"), "it changes nothing on a map"),
        (
            [over("groups.adhesion=0.01..0.02"), vec!["--set".into(), "gamma=0.003".into()]].concat(),
            "--set material.work_of_adhesion: the axis groups.adhesion gives each point its own",
        ),
        (
            [over("compliance=0..inf"), vec!["--control".into(), "force".into()]].concat(),
            "--control: the axis compliance gives each point its own",
        ),
        (over("gap.wavelength=1e-9..1"), "waves; a map takes at most 3000"),
        (over("gap.amplitude=nan..1"), "gap.amplitude = NaN is out of range"),
        (over("gap.amplitude=0..inf"), "gap.amplitude = inf is out of range"),
        (over("compliance=-1..inf"), "a compliance is from 0 (displacement)"),
        (over("path.start_contact_radius=0.2..20"), "at most 10 x the radius of curvature"),
        (
            [over("groups.adhesion=0.01..0.02"), vec!["-o".into(), "there.csv".into()]].concat(),
            "-o there.csv: already exists; --overwrite replaces it",
        ),
        (
            [over("groups.adhesion=0.01..0.02"), vec!["-o".into(), "there.gif".into()]].concat(),
            "a figure's in .svg, .png or .pdf",
        ),
    ];
    // Of two axes that give the same value only one would count.
    let twice = [
        ["gap.amplitude=1e-4..4e-3", "groups.amplitude_over_wavelength=0.01..0.1"],
        ["material.work_of_adhesion=1e-3..4e-3", "groups.adhesion=0.01..0.1"],
        ["gap.wavelength=0.04..0.06", "groups.wavelength_over_radius=0.04..0.06"],
        ["compliance=0..10", "path.control.stiffness=0.1..1"],
    ]
    .map(|[x, y]| (["map", "--x-key", x, "--y-key", y].map(str::to_owned).to_vec(), "give the same value"));
    for (arguments, words) in cases.into_iter().chain(twice) {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let output = pulloff(home.path(), &arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(words), "{arguments:?}: {said}");
    }
    assert_eq!(fs::read_to_string(home.path().join("there.csv")).unwrap(), "mine");
}

#[test]
fn a_line_of_cusps_that_crosses_the_map_within_a_hair_of_radii_is_on_it() {
    let home = tempfile::tempdir().unwrap();
    // Crest, x and y of the points of the cusps, over a range of adhesion that begins at zero.
    let cusps = |most: f64| -> Vec<(String, [f64; 2])> {
        let y = format!("material.work_of_adhesion=0.0005..{most}");
        let rows = text(
            home.path(),
            &["map", "wavy-sphere", "--x-key", "gap.amplitude=0.0002..0.001", "--y-key", &y],
        );
        let mut rows = csv::Reader::from_reader(rows.as_bytes());
        let rows = rows.records().map(|row| row.unwrap());
        let cusps = rows.filter(|row| &row[1] == "cusp");
        cusps.map(|row| (row[2].to_owned(), [4, 5].map(|k| row[k].parse().unwrap()))).collect()
    };
    let whole = cusps(0.02);
    for most in [0.0075, 0.003, 0.001] {
        let part = cusps(most);
        let near =
            |[x, y]: [f64; 2], [u, v]: [f64; 2]| ((x - u) / 0.0008).hypot((y - v) / (most - 0.0005)) < 0.03;
        let within: Vec<_> = whole.iter().filter(|(_, [_, y])| *y < most).collect();
        let crests: std::collections::BTreeSet<&str> = within.iter().map(|(crest, _)| &**crest).collect();
        assert!(crests.len() > 5, "{crests:?}");
        for (crest, at) in within {
            assert!(
                part.iter().any(|(other, place)| other == crest && near(*place, *at)),
                "up to {most} the cusp of crest {crest} at {at:?} is missing"
            );
        }
    }
}
