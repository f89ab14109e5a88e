//! `pulloff fit`: its document, its table, its statuses, and what it refuses.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

#[path = "support/home.rs"]
mod home;

use home::Home;
use serde_json::Value;

const LENS: &str = include_str!("../presets/data/lens.csv");
const FREE: [&str; 2] = ["--free", "E*,gamma,data.offset"];

#[test]
fn the_truth_of_the_shipped_curve_is_found_and_written() {
    let home = Home::new();
    let ended = home.run(
        &[
            &["fit", "shipped:lens.csv", "lens", "--json", "-o", "fitted.toml", "--residuals", "r.csv"],
            &FREE[..],
        ]
        .concat(),
    );
    assert_eq!((ended.status, ended.err.as_str()), (0, ""));
    let document: Value = serde_json::from_str(&ended.out).unwrap();
    assert_eq!((document["schema"].as_u64(), document["determined"].as_bool()), (Some(1), Some(true)));
    let truth = [
        ("material.effective_modulus", 1e6, "Pa"),
        ("material.work_of_adhesion", 0.05, "J/m^2"),
        ("data.offset", 12.3e-6, "m"),
        ("data.baseline", 4e-6, "N"),
    ];
    for (found, (key, value, unit)) in document["parameters"].as_array().unwrap().iter().zip(truth) {
        assert_eq!((found["key"].as_str(), found["unit"].as_str()), (Some(key), Some(unit)));
        let (at, error) = (found["value"].as_f64().unwrap(), found["standard_error"].as_f64().unwrap());
        assert!((at - value).abs() < 4.0 * error && error < 0.05 * value, "{key}: {at} +- {error}");
    }
    assert_eq!(document["points"].as_u64(), Some(700));
    assert_eq!(document["correlations"].as_array().unwrap().len(), 4);
    assert_eq!(home.text("r.csv").lines().count(), 701);
    // The fitted preset is a preset, and fits as it is.
    assert!(home.text("fitted.toml").contains("stiffness"));
    let again = home.run(&["fit", "shipped:lens.csv", "fitted.toml", "--no-scan", FREE[0], FREE[1]]);
    assert_eq!(again.status, 0, "{}", again.err);
}

#[test]
fn what_is_not_determined_has_a_status_of_its_own() {
    let home = Home::new();
    let ended = home.run(&["fit", "shipped:lens.csv", "lens", "--free", "R,E*,gamma,data.offset", "--json"]);
    assert_eq!(ended.status, 3, "{}", ended.err);
    let document: Value = serde_json::from_str(&ended.out).unwrap();
    assert!(document["direction"].as_str().unwrap().starts_with("R +10 %, E* −4.7 %, γ −9.1 % together"));
    assert!(document["parameters"][0]["standard_error"].is_null());
}

#[test]
fn a_table_goes_on_where_it_ended() {
    let home = Home::new();
    let (good, bad) = (home.file("a.csv", LENS), home.file("b.csv", &LENS.replace("retraction", "back")));
    let arguments = [&["fit", &good, &bad, "lens", "--table", "t.csv"], &FREE[..]].concat();
    let ended = home.run(&arguments);
    assert!(ended.status == 1 && ended.err.contains("the segment \"back\" is not known"), "{}", ended.err);
    let first = home.text("t.csv");
    assert!(first.lines().count() == 3 && first.contains("a.csv,ok,"), "{first}");
    // The bad one, mended, is fitted; the good one is passed over.
    home.file("b.csv", LENS);
    let ended = home.run(&arguments);
    assert!(ended.status == 0 && ended.err.contains("a.csv: is in the table already"), "{}", ended.err);
    let second = home.text("t.csv");
    assert_eq!((second.lines().count(), second.matches(",ok,").count()), (3, 2), "{second}");
}

#[test]
fn what_a_person_can_mend_is_said_with_status_2() {
    let home = Home::new();
    let path = home.file("a.csv", LENS);
    for (arguments, expected) in [
        (
            vec!["fit", &path, "lens", "--free", "material.effectiv_modulus"],
            "did you mean material.effective_modulus?",
        ),
        (vec!["fit", "fig-9", FREE[0], FREE[1]], "a preset that names one in data.file"),
        (vec!["fit", "none.csv", "lens", FREE[0], FREE[1]], "none.csv"),
        (
            vec!["fit", &path, "fig-9", FREE[0], FREE[1]],
            "has a unit, um, and the problem is in reduced units",
        ),
        (vec!["fit", &path, "lens", FREE[0], FREE[1], "--range", "x=3..1"], "is empty"),
        (vec!["fit", &path, "lens", FREE[0], FREE[1], "--columns", "x=9,force=2"], "no column 9"),
        (vec!["fit", "shipped:none", "lens", FREE[0], FREE[1]], "there is shipped:lens.csv"),
        (vec!["fit", &path, "lens", FREE[0], FREE[1], "--poisson", "0.7"], "from -1 to 0.5"),
    ] {
        let ended = home.run(&arguments);
        assert!(
            ended.status == 2 && ended.err.contains(expected),
            "{arguments:?}: {} {}",
            ended.status,
            ended.err
        );
    }
}

#[test]
fn measured_points_lie_behind_a_curve() {
    let home = Home::new();
    let path = home.file("a.csv", LENS);
    let ended =
        home.run(&["plot", "lens", "--measured", &path, "--offset", "12.3um", "-o", "o.svg", "--data"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    let data = home.text("o.csv");
    assert!(
        data.matches("measured approach").count() == 350
            && data.matches("measured retraction").count() == 350
    );
    let ended = home.run(&["plot", "lens", "--measured", &path, "--view", "radius-force"]);
    assert!(ended.status == 2 && ended.err.contains("has not the columns of radius-force"), "{}", ended.err);
}
