//! `pulloff fit` of pulls at a rate: one law for several files, and what a held law means.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::Home;
use pulloff::store::{Source, Store};
use pulloff_engine::fit::residuals::residuals_own;
use serde_json::Value;
use std::fmt::Write as _;

/// A soft ball with a law of the edge.
pub const SOFT: &str = "format = 1
units = \"SI\"
[material]
effective_modulus = \"1.5 MPa\"
work_of_adhesion = \"45 mJ/m^2\"
[edge]
reference_speed = \"1 um/s\"
exponent = 0.5
[gap]
shape = \"sphere\"
radius_of_curvature = \"10 mm\"
[path]
control = \"displacement\"
start_contact_radius = \"600 um\"
";

/// Rates, and the files of the pulls at these rates.
pub const SPEEDS: [(&str, &str); 3] =
    [("0.1um/s", "slow.csv"), ("1um/s", "middle.csv"), ("10um/s", "fast.csv")];

/// The pull of a preset at a rate, as [`recorded`] has it.
pub fn pulled(home: &Home, preset: &str, rate: &str, file: &str) {
    recorded(home, &[preset, "--rate", rate], (120, [3e-8, 4e-3]), file);
}

/// A pull, as `asked`, in so many rows evenly spaced in time, and a quarter as many after it, each displaced from the curve
/// by the sine of its number: its approach by at most `noise[0]`, in metres, and its force by at most `noise[1]` of the largest.
fn recorded(home: &Home, asked: &[&str], (rows, noise): (u32, [f64; 2]), file: &str) {
    let ended = home.run(&[&["pull"], asked, &["--rows", "moments", "--format", "csv"]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    let cells =
        |line: &str| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect::<Vec<f64>>();
    let moments: Vec<Vec<f64>> = ended.out.lines().skip(1).map(cells).collect();
    let moments: Vec<[f64; 3]> =
        moments.iter().filter(|row| row[3] > 0.0).map(|row| [row[1], row[4], row[5]]).collect();
    let last = moments.last().unwrap();
    let before = moments.iter().rfind(|[time, ..]| *time < last[0]).unwrap();
    let speed = (before[1] - last[1]) / (last[0] - before[0]);
    let most = moments.iter().map(|[.., force]| force.abs()).fold(0.0, f64::max);
    let mut text = "time [s], approach [m], force [N]\n".to_owned();
    for i in 0..rows * 5 / 4 {
        let time = f64::from(i) / f64::from(rows) * last[0];
        let after = moments.partition_point(|[at, ..]| *at <= time);
        let [approach, force] = moments.get(after).map_or([last[1] - speed * (time - last[0]), 0.0], |to| {
            let from = moments[after - 1];
            [1, 2].map(|k| from[k] + (time - from[0]) / (to[0] - from[0]) * (to[k] - from[k]))
        });
        let [one, other] = [f64::from(i).powi(2), f64::from(i).powi(3)].map(|x| (1.7 * x).sin());
        let (approach, force) = (approach + noise[0] * one, force + noise[1] * most * other);
        writeln!(text, "{time}, {approach}, {force}").unwrap();
    }
    home.file(file, &text);
}

/// The rows of a record from its turn on.
fn from_turn(text: &str) -> String {
    let at = |line: &&str| line.split(',').nth(1).unwrap().trim().parse::<f64>().unwrap();
    let rows: Vec<&str> = text.lines().skip(1).collect();
    let top = (0..rows.len()).max_by(|a, b| at(&rows[*a]).total_cmp(&at(&rows[*b]))).unwrap();
    [&["time [s], approach [m], force [N]"], &rows[top..]].concat().join("\n")
}

#[test]
fn the_law_of_all_files_contradicts_rows_that_one_file_bends_to() {
    let home = Home::new();
    home.file("soft.toml", SOFT);
    let files = ["0.3", "1", "3"].map(|rate| {
        let steps = format!("path.steps=to 25um at {rate}um/s; apart at {rate}um/s");
        let file = format!("{rate}.csv");
        let start = ["soft.toml", "--set", "path.start_contact_radius=150um", "--set", &steps];
        recorded(&home, &start, (400, [3e-9, 9.2e-4]), &file);
        home.file(&file, &from_turn(&home.text(&file)));
        file
    });
    let fit = |files: &[&str], more: &[&str]| {
        let free = ["soft.toml", "--free", "E*,gamma,v0,edge.exponent,data.offset"];
        let ended = home.run(&[&["fit"], files, &free, more].concat());
        assert_eq!(ended.status, 0, "{}", ended.err);
        ended.out.contains("rows of the retraction are left out: they contradict an edge that rests")
    };
    for file in &files {
        assert!(!fit(&[file], &[]), "{file}");
    }
    assert!(fit(&files.each_ref().map(String::as_str), &["--together"]));
}

#[test]
fn three_speeds_are_fitted_together() {
    let home = Home::new();
    home.file("soft.toml", SOFT);
    home.file("sticky.toml", &SOFT.replace("45 mJ", "54 mJ"));
    for (rate, file) in SPEEDS {
        pulled(&home, "soft.toml", rate, file);
    }
    pulled(&home, "sticky.toml", "10um/s", "other.csv");
    let fit = |files: &[&str], more: &[&str]| {
        let free = ["soft.toml", "--together", "--free", "gamma,v0,edge.exponent"];
        home.run(&[&["fit"], files, &free, more].concat())
    };
    // The times give the rates.
    let ended = fit(&["slow.csv", "middle.csv", "fast.csv"], &["--format=json", "-o", "law.toml"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    let document: Value = serde_json::from_str(&ended.out).unwrap();
    assert_eq!((&document["document"], &document["verdict"]), (&"fit-together".into(), &"describes".into()));
    assert_eq!(document["collapse"]["collapses"], true, "{}", document["collapse"]);
    let law = document["law"].as_array().unwrap();
    for (of, (key, truth)) in law.iter().zip([
        ("material.work_of_adhesion", 0.045),
        ("edge.reference_speed", 1e-6),
        ("edge.exponent", 0.5),
    ]) {
        let [value, error] = ["value", "standard_error"].map(|name| of[name].as_f64().unwrap());
        assert!(of["key"] == key && (value - truth).abs() < 4.0 * error && error < 0.2 * truth, "{of}");
    }
    assert_eq!(document["runs"].as_array().unwrap().len(), 3);
    let written = home.text("law.toml");
    assert!(written.contains("reference_speed") && !written.contains("exponent = 0.5\n"), "{written}");
    // A fast pull alone tells how much G grows, and whether the error of that holds.
    for (free, status, holds) in
        [("gamma,v0", 0, " J/m^2 (s/m)^n\n"), ("gamma,v0,edge.exponent", 3, "; its error is not known")]
    {
        let ended = home.run(&["fit", "fast.csv", "soft.toml", "--free", free]);
        let growth = ended.out.split_inclusive('\n').find(|line| line.contains("K = gamma/v0^n")).unwrap();
        assert!(
            ended.status == status && growth.contains(holds) && growth.contains("+-") == (status == 0),
            "{growth}"
        );
    }
    // The fitted preset has the rate of the times, and its points lie on its pull.
    home.run(&["fit", "fast.csv", "soft.toml", "--free", "gamma,v0", "-o", "own.toml"]);
    let store = Store::at(home.folder(), &[]);
    let own = store.load::<&str>(&Source::File(home.path("own.toml")), &[]).unwrap().preset;
    assert!((own.edge.rate.unwrap() / 1e-5 - 1.0).abs() < 0.01, "{:?}", own.edge);
    let (_, beside) = residuals_own(&own).unwrap();
    let in_contact: Vec<f64> =
        beside.iter().filter(|found| !found.datum.free).map(|found| found.residual.abs()).collect();
    assert!(in_contact.len() > 80 && in_contact.iter().all(|off| *off < 5.0), "{in_contact:?}");
    // A start that the fitted preset cannot have is told, and the rest is written.
    let ends = ["--set", "path.start_contact_radius=700um", "--set", "path.end_contact_radius=650um"];
    let free = ["--free", "gamma,v0", "-o", "ends.toml"];
    let ended = home.run(&[&["fit", "fast.csv", "soft.toml"][..], &ends, &free].concat());
    assert!(ended.status == 0 && home.path("ends.toml").exists(), "{}", ended.err);
    assert!(ended.out.contains("path.start_contact_radius could not be set in the preset"), "{}", ended.out);
    // A file with another work of adhesion does not follow the law.
    let ended = fit(&["slow.csv", "other.csv"], &[]);
    assert_eq!(ended.status, 4, "{}", ended.err);
    assert!(ended.out.contains("the runs do NOT follow one law"), "{}", ended.out);
    let ended = fit(&["slow.csv"], &[]);
    assert!(ended.status == 2 && ended.err.contains("two or more files"), "{}", ended.err);
    let ended = fit(&["slow.csv", "fast.csv"], &["--rate", "1um/s,2um/s,3um/s"]);
    assert!(ended.status == 2 && ended.err.contains("3 rates are given for 2 files"), "{}", ended.err);
    // A rate that the times contradict.
    let ended = fit(&["slow.csv", "fast.csv"], &["--rate", "0.1um/s,1um/s"]);
    let said = "fast.csv: the rate is given as 1 um/s, but the times of the file give 10";
    assert!(ended.status == 2 && ended.err.contains(said), "{}", ended.err);
    // A law that is held is that of the curve too, once there is a rate; without a law there is none.
    let held = |file: &str, more: &[&str]| {
        let ended = home.run(&[&["fit", file, "soft.toml", "--free", "E*", "--accept"], more].concat());
        (ended.status, ended.out + &ended.err)
    };
    let (status, said) = held("fast.csv", &["--rate", "10um/s"]);
    assert!(status == 0 && said.contains("verdict: the model describes"), "{said}");
    let (status, said) = held("slow.csv", &["--rate", "7um/s"]);
    assert!(status == 2 && said.contains("slow.csv: the rate is given as 7 um/s"), "{said}");
    let (_, said) = held("slow.csv", &[]);
    assert!(said.contains("the law of the edge plays no part, as path.rate is not set"), "{said}");
    let (_, said) = held("slow.csv", &["--rate", "7um/s", "--set", "edge.exponent=none"]);
    assert!(said.contains("--rate plays no part, as the edge has no law"), "{said}");
    let ended = fit(&["slow.csv", "fast.csv"], &["--residuals", "r.csv"]);
    assert!(ended.status == 2 && ended.err.contains("--together"), "{}", ended.err);
}

#[test]
fn rows_in_which_the_edge_still_closes_are_left_out() {
    let home = Home::new();
    home.file("soft.toml", SOFT);
    let programme = ["--set", "path.steps=to 25um at 1um/s; apart at 1um/s"];
    let start = ["soft.toml", "--set", "path.start_contact_radius=150um"];
    recorded(&home, &[&start[..], &programme].concat(), (400, [3e-9, 4e-4]), "loop.csv");
    home.file("back.csv", &from_turn(&home.text("loop.csv")));
    let fit = |file: &str, more: &[&str]| {
        let fit = [
            "fit",
            file,
            "soft.toml",
            "--free",
            "E*,gamma,v0",
            "--format=json",
            "-o",
            "own.toml",
            "--overwrite",
        ];
        let ended = home.run(&[&fit[..], more].concat());
        let document: Value = serde_json::from_str(&ended.out).expect(&ended.err);
        let off =
            document["parameters"].as_array().unwrap().iter().zip([1.5e6, 0.045, 1e-6]).map(|(of, truth)| {
                let [value, error] = ["value", "standard_error"].map(|name| of[name].as_f64().unwrap());
                (value - truth).abs() / error
            });
        (ended.status, off.fold(0.0, f64::max), ended.err, document)
    };
    let (status, off, err, document) = fit("loop.csv", &[]);
    assert!(status == 0 && off < 2.0, "{off} {err}");
    let notes = document["notes"].to_string();
    assert!(
        notes.contains("after an approach at 1.0") && notes.contains("the edge still closes there"),
        "{notes}"
    );
    // What is left out of a fit is left out beside its curve, too.
    let store = Store::at(home.folder(), &[]);
    let own = store.load::<&str>(&Source::File(home.path("own.toml")), &[]).unwrap().preset;
    let (_, beside) = residuals_own(&own).unwrap();
    let in_contact = beside.iter().filter(|found| !found.datum.free).map(|found| found.residual.abs());
    assert!(in_contact.fold(0.0, f64::max) < 6.0, "{beside:?}");
    // A retraction alone does not show how fast the approach was: its first rows contradict an edge that rests.
    let (status, off, err, document) = fit("back.csv", &[]);
    let notes = document["notes"].to_string();
    assert!(
        status == 0 && off < 2.0 && notes.contains("contradict an edge that rests"),
        "{off} {err} {notes}"
    );
}
