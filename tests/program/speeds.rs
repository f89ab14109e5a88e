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
}

#[test]
fn without_a_curve_it_says_what_is_missing() {
    let ended = pulloff(&["wavy-sphere"]).code(2);
    let said = String::from_utf8(ended.get_output().stderr.clone()).unwrap();
    assert!(said.contains("no measured curve"), "{said}");
}
