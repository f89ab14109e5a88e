//! `pulloff speeds`: the energy release rate of a measured curve, from the command line.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use crate::support::schema;
use assert_cmd::Command;
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

fn pulloff(arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("pulloff").unwrap().arg("speeds").args(arguments).assert()
}

/// A retraction of a sphere whose edge costs 0.05 J/m² at every speed, one row per second.
fn curve(folder: &Path) -> String {
    let mut text = "time [s],contact radius [m],force [N]\n".to_owned();
    for i in 0..60 {
        let s = 1.2e-4 - 5e-7 * f64::from(i);
        let force = 4e6 * s.powi(3) / 3e-3 - (8.0 * std::f64::consts::PI * 1e6 * 0.05 * s.powi(3)).sqrt();
        writeln!(text, "{i},{s:e},{force:e}").unwrap();
    }
    let file = folder.join("curve.csv");
    std::fs::write(&file, text).unwrap();
    file.to_str().unwrap().to_owned()
}

const SPHERE: [&str; 5] =
    ["lens", "--set", "material.effective_modulus=1 MPa", "--set", "gap.radius_of_curvature=1 mm"];

#[test]
fn every_row_has_its_energy_and_speed() {
    let folder = tempfile::tempdir().unwrap();
    let file = curve(folder.path());
    let set = ["--set", "path.control=displacement", "--set", "data.baseline=0"];
    let ended = pulloff(&[&[&*file], &SPHERE[..], &set, &["--format=json"]].concat()).success();
    let text = String::from_utf8(ended.get_output().stdout.clone()).unwrap();
    schema::check(&text);
    let found: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&found["document"], &found["from"]), (&"speeds".into(), &"force and contact radius".into()));
    let rows = found["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 60);
    for row in rows {
        let number = |key: &str| row[key].as_f64().unwrap();
        assert!((number("energy_release_rate") / 0.05 - 1.0).abs() < 1e-6, "{row}");
        assert!((number("speed") / 5e-7 - 1.0).abs() < 1e-6, "{row}");
        assert!(number("window") >= 3.0 && number("error") > 0.0);
    }
    let ended = pulloff(&[&[&*file], &SPHERE[..], &set, &["--format=csv"]].concat()).success();
    let text = String::from_utf8(ended.get_output().stdout.clone()).unwrap();
    assert!(
        text.starts_with("time,contact_radius,speed,energy_release_rate,error,")
            && text.lines().count() == 61
    );
    for format in ["csv", "table"] {
        let ended = pulloff(&[&[&*file], &SPHERE[..], &set, &["--format", format]].concat()).success();
        let said = String::from_utf8(ended.get_output().stderr.clone()).unwrap();
        assert!(said.contains("note: units of the columns: "), "{said}");
    }
}

#[test]
fn without_a_curve_it_says_what_is_missing() {
    let ended = pulloff(&["wavy-sphere"]).code(2);
    let said = String::from_utf8(ended.get_output().stderr.clone()).unwrap();
    assert!(said.contains("no measured curve"), "{said}");
}

/// A pull, from this contact radius to its last contact, in sixty rows of displacement and force.
fn pull(folder: &Path, start: &str) -> [String; 2] {
    let preset = format!(
        "format = 1\ntitle = \"pull\"\nunits = \"SI\"\n[material]\neffective_modulus = 1.5e6\nwork_of_adhesion = 0.045\n\
         [gap]\nshape = \"sphere\"\nradius_of_curvature = 0.01\n[edge]\nreference_speed = 1e-6\nexponent = 0.5\n\
         [path]\nstart_contact_radius = {start}\nrate = 1e-5\n"
    );
    let [toml, file] = ["p.toml", "p.csv"].map(|name| folder.join(name).to_str().unwrap().to_owned());
    std::fs::write(&toml, preset).unwrap();
    let mut command = Command::cargo_bin("pulloff").unwrap();
    let made = command.args(["pull", &toml, "--rows", "moments", "--format", "csv"]).assert().success();
    let mut moments = csv::Reader::from_reader(&*made.get_output().stdout);
    let header = moments.headers().unwrap().clone();
    let at = ["time", "approach", "force", "contact_radius"]
        .map(|name| header.iter().position(|column| column == name).unwrap());
    let rows = moments.records().map(|row| at.map(|at| row.as_ref().unwrap()[at].parse::<f64>().unwrap()));
    let rows: Vec<[f64; 4]> = rows.filter(|[.., s]| *s > 0.0).collect();
    let mut text = "time [s],displacement [m],force [N]\n".to_owned();
    for i in 0..60 {
        let t = 0.999 * rows[rows.len() - 1][0] * f64::from(i) / 59.0;
        let next = rows.partition_point(|row| row[0] < t).clamp(1, rows.len() - 1);
        let [a, b] = [rows[next - 1], rows[next]];
        let between = |k: usize| a[k] + (b[k] - a[k]) * (t - a[0]) / (b[0] - a[0]);
        writeln!(text, "{t:e},{:e},{:e}", between(1), between(2)).unwrap();
    }
    std::fs::write(&file, text).unwrap();
    [file, toml]
}

#[test]
fn a_sign_that_no_row_apart_explains_is_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let warned = |start: &str, signs: &[&str]| {
        let [file, toml] = pull(folder.path(), start);
        let ended = pulloff(&[&[&*file, &*toml, "--from", "force-approach"], signs].concat()).success();
        let said = String::from_utf8(ended.get_output().stderr.clone()).unwrap();
        said.contains("warning: the points leave it open which way their columns run: x=-,force=+ is assumed")
    };
    // So few rows hardly rise where the force is largest, which looks like rows apart.
    assert!(warned("3e-4", &[]));
    assert!(!warned("3e-4", &["--signs", "x=+,force=+"]) && !warned("6e-4", &[]));
    // A fit tries both, and only the right ones describe the points.
    let [file, toml] = pull(folder.path(), "3e-4");
    let mut command = Command::cargo_bin("pulloff").unwrap();
    let free = "edge.reference_speed,edge.exponent";
    let ended = command.args(["fit", &file, &toml, "--free", free]).assert().success();
    let fitted = String::from_utf8(ended.get_output().stdout.clone()).unwrap();
    assert!(fitted.contains("x=+,force=+ is taken") && fitted.contains("0.50004"), "{fitted}");
}
