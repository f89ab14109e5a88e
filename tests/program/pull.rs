//! `pulloff pull`: pulls at a rate and dead loads, from the command line.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use crate::support::schema;
use assert_cmd::Command;
use serde_json::Value;

fn pulloff(arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("pulloff").unwrap().arg("pull").args(arguments).assert()
}

fn document(arguments: &[&str]) -> Value {
    let output = pulloff(&[arguments, &["--format", "json"]].concat()).success();
    let text = String::from_utf8(output.get_output().stdout.clone()).unwrap();
    schema::check(&text);
    serde_json::from_str(&text).unwrap()
}

/// The wavy sphere, starting from the radius of the known numbers.
const WAVY: [&str; 5] =
    ["wavy-sphere", "--set", "edge.exponent=0.5", "--set", "path.start_contact_radius=0.5"];

#[test]
fn the_document_has_what_its_contract_says() {
    let found = document(&[&WAVY[..], &["--rate", "0.01", "--rate", "1"]].concat());
    assert_eq!(found["document"], "pull");
    let critical = found["problem"]["critical_force"].as_f64().unwrap();
    let runs = found["runs"].as_array().unwrap();
    for (run, (rate, peak, count)) in runs.iter().zip([(0.01, 1.64877, 7), (1.0, 2.72997, 6)]) {
        assert_eq!(run["rate"].as_f64(), Some(rate));
        let force = run["peak"]["force"].as_f64().unwrap();
        assert!((-force / critical / peak - 1.0).abs() < 1e-5, "{force}");
        assert_eq!(run["tension_peaks"].as_array().unwrap().len(), count);
        for moment in [&run["start"], &run["pinned_until"], &run["peak"], &run["tension_peaks"][0]] {
            for key in ["time", "contact_radius", "approach", "force"] {
                assert!(moment[key].is_number(), "{key}");
            }
        }
        for key in ["from", "to", "top_speed", "dissipated"] {
            assert!(run["snaps"][0][key].is_number(), "{key}");
        }
        assert!(run["last_contact"]["time"].is_number() && run["last_contact"]["control"].is_number());
        assert!(run["dissipated"].as_f64().unwrap() > 0.0 && run["balance"].as_f64().unwrap() < 1e-9);
    }
    assert_eq!(found["failures"], Value::Array(Vec::new()));
}

#[test]
fn an_edge_that_closed_before_it_opens_is_not_called_pinned() {
    let said = |steps: &str| {
        let set = format!("path.steps={steps}");
        let output = pulloff(&[&WAVY[..], &["--set", &set]].concat()).success();
        String::from_utf8(output.get_output().stdout.clone()).unwrap()
    };
    assert!(said("apart at 0.1").contains("\npinned until  t "));
    let closed = said("to 0.2 at 0.1; apart at 0.1");
    assert!(closed.contains("\nopens from    t ") && !closed.contains("pinned"), "{closed}");
}

#[test]
fn a_dead_load_falls_without_end_or_is_borne() {
    let force = ["--control", "force", "--rate", "1e-3"];
    let found = document(&[&WAVY[..], &force].concat());
    assert_eq!(found["runs"][0]["dissipated"], Value::Null);
    // It pulls most at the last contact, whose approach has no bound, whatever the integrator's last step is.
    let of = |exponent: &str| {
        let set = format!("edge.exponent={exponent}");
        let sphere =
            ["fig-3-jkr", "--set", "basis.kind=exact", "--set", &set, "--set", "edge.reference_speed=1"];
        document(&[&sphere[..], &force].concat())["runs"][0].clone()
    };
    // Its edge is fastest at the end, without bound, and a smooth sphere has no snap before.
    assert_eq!(of("0.5")["top_edge_speed"], Value::Null);
    for run in ["0.05", "0.06", "0.5"].map(of) {
        let peak = &run["peak"];
        assert_eq!((&peak["contact_radius"], &peak["approach"]), (&Value::from(0.0), &Value::Null), "{run}");
        assert_eq!(peak["time"], run["last_contact"]["time"]);
        assert_eq!(peak["force"], run["last_contact"]["control"]);
    }
    // The law is judged before the load has all but fallen, on a smooth sphere too.
    let bound =
        ["fig-3-jkr", "--set", "edge.exponent=1", "--set", "path.rate=1", "--set", "edge.highest_ratio=1.5"];
    let warnings =
        document(&[&bound[..], &["--control", "force", "--set", "edge.reference_speed=1"]].concat());
    let warning = warnings["warnings"]
        .as_array()
        .unwrap()
        .iter()
        .find_map(|warning| warning.as_str().filter(|text| text.contains("above edge.highest_ratio")));
    assert!(warning.is_some_and(|text| text.contains("G/gamma reaches 20")), "{warnings}");
    let loads = ["--hold-force=-0.02", "--hold-force=-0.03"];
    let found = document(&[&WAVY[..], &loads].concat());
    assert_eq!(found["runs"], Value::Array(Vec::new()));
    assert_eq!(found["failures"][0]["time"], Value::Null);
    assert!(found["failures"][1]["time"].as_f64().unwrap() > 0.0);
}

/// Doubling both speeds gives the same in half the time.
#[test]
fn only_the_ratio_of_the_speeds_counts() {
    let one = document(&[&WAVY[..], &["--rate", "0.01"]].concat());
    let two = document(&[&WAVY[..], &["--set", "edge.reference_speed=2", "--rate", "0.02"]].concat());
    let of = |found: &Value, key: &str| found["runs"][0]["peak"][key].as_f64().unwrap();
    assert!((of(&one, "force") / of(&two, "force") - 1.0).abs() < 1e-15);
    assert!((of(&one, "time") / of(&two, "time") / 2.0 - 1.0).abs() < 1e-12);
}

#[test]
fn ranges_steps_and_rows() {
    let output = pulloff(&[&WAVY[..], &["--rate", "log:1e-3..1e1:5", "--format", "csv"]].concat()).success();
    let text = String::from_utf8(output.get_output().stdout.clone()).unwrap();
    assert_eq!(text.lines().count(), 6);
    assert!(text.lines().nth(5).unwrap().starts_with("10"), "{text}");
    let steps = ["--set", "path.steps=to 0.12 at 0.01; hold 5; apart at 0.02"];
    let found = document(&[&WAVY[..], &steps].concat());
    assert_eq!(found["runs"][0]["rate"], Value::Null);
    assert!(found["runs"][0]["last_contact"].is_object());
    let early = ["--set", "path.steps=to -2 at 0.01; hold 5; apart at 0.02"];
    let early = pulloff(&[&WAVY[..], &early].concat()).success();
    let said = String::from_utf8_lossy(&early.get_output().stderr).into_owned();
    assert!(said.contains("the bodies are apart in step 1 of 3: the steps after it are not made"), "{said}");
    let moments = pulloff(&[&WAVY[..], &["--rate", "1", "--rows", "moments", "--format", "csv"]].concat());
    let text = String::from_utf8(moments.success().get_output().stdout.clone()).unwrap();
    assert!(
        text.starts_with(
            "rate,time,control,contact_radius,approach,force,speed,energy_release_rate,dissipated"
        )
    );
    assert!(text.lines().count() > 100);
}

/// A crater beside the disc at the start: there the bodies overlap by 0.0249, by another program.
#[test]
fn a_start_outside_which_the_bodies_overlap_is_told_once() {
    let dip = |depth: f64| {
        let gap = format!("gap.formula=r^2/2-{depth}*exp(-((r-0.5)/0.05)^2)");
        let set = [gap.as_str(), "gamma=0.002", "start_contact_radius=0.3", "edge.exponent=0.5"];
        let set = set.iter().flat_map(|value| ["--set", *value]);
        let all = ["formula"].into_iter().chain(set).chain(["--rate", "0.01", "--rate", "0.02"]);
        document(&all.collect::<Vec<_>>())
    };
    let told = |found: &Value| {
        let warnings = found["warnings"].as_array().unwrap();
        warnings.iter().filter(|text| text.as_str().unwrap().contains("would overlap at r = 0.49")).count()
    };
    let found = dip(0.12);
    assert_eq!(told(&found), 1, "{}", found["warnings"]);
    let at = found["runs"][1]["overlaps_at"].as_f64().unwrap();
    assert!((at - 0.494_716).abs() < 1e-5, "{at}");
    let found = dip(0.01);
    assert!(told(&found) == 0 && found["runs"][0]["overlaps_at"].is_null(), "{}", found["warnings"]);
    let set = ["gap.formula=r^2/2-0.12*exp(-((r-0.5)/0.05)^2)", "gamma=0.002", "start_contact_radius=0.3"];
    let set = set.iter().flat_map(|value| ["--set", *value]).chain(["--set", "edge.exponent=0.5"]);
    let all: Vec<&str> = ["formula"].into_iter().chain(set).chain(["--hold-force", "-0.002"]).collect();
    assert!(told(&document(&all)) == 1);
}

/// What is beyond the theory is told of all of the way, not only of its start.
#[test]
fn a_programme_that_grows_beyond_the_radius_of_curvature_is_told() {
    let steps = "path.steps=to 5 at 0.01; apart at 1";
    let found = document(&["fig-9", "--set", "edge.exponent=1", "--set", steps]);
    let told = found["warnings"].to_string();
    assert!(
        told.contains("the gap has slopes up to 2.") && told.contains("beyond the radius of curvature"),
        "{told}"
    );
    let found = document(&["fig-9", "--set", "edge.exponent=1", "--rate", "1"]);
    assert!(!found["warnings"].to_string().contains("beyond the radius of curvature"), "{found}");
}

/// The snap after the largest pull is the fastest.
#[test]
fn a_snap_beyond_the_range_of_the_law_is_told() {
    let set = ["--set", "edge.highest_ratio=2", "--rate", "0.01"];
    let output = pulloff(&[&WAVY[..], &set].concat()).success();
    let said = String::from_utf8_lossy(&output.get_output().stderr).into_owned();
    assert!(said.contains("G/gamma reaches 2.438 at the contact radius 0.118632, above"), "{said}");
}

#[test]
fn what_cannot_be_says_what_could() {
    for (arguments, said) in [
        (vec!["wavy-sphere", "--rate", "1"], "edge.exponent"),
        (vec!["wavy-sphere", "--set", "edge.exponent=0.5"], "no rate"),
        (vec!["wavy-sphere", "--set", "edge.exponent=0.5", "--rate", "0"], "--rate"),
        (
            vec!["wavy-sphere", "--set", "edge.exponent=0.5", "--rate", "-1e-6"],
            "--rate: path.rate = -1e-6 is out of",
        ),
        (vec!["wavy-sphere", "--set", "edge.exponent=0.5", "--rate", "log:1..2"], "log:FROM..TO:COUNT"),
        (vec!["wavy-sphere", "--set", "edge.exponent=9"], "edge.exponent"),
        (vec!["wavy-sphere", "--set", "path.steps=jump"], "to VALUE at RATE"),
        (vec!["wavy-sphere", "--set", "path.steps=apart at 1; hold 1"], "nothing follows \"apart\""),
        (vec!["fig-9-si", "--set", "edge.exponent=0.5", "--rate", "1 um/s"], "edge.reference_speed"),
        (vec!["wavy-sphere", "--set", "material.closing_work_of_adhesion=1"], "out of range"),
    ] {
        let output = pulloff(&arguments).failure().code(2);
        let text = String::from_utf8_lossy(&output.get_output().stderr).into_owned();
        assert!(text.contains(said), "{arguments:?}: {text}");
    }
}

/// A loop reports the cost of the dead band, and a command that ignores the dead band says so.
#[test]
fn a_dead_band_is_told_of_where_it_does_not_count() {
    let set = ["wavy-sphere", "--set", "material.closing_work_of_adhesion=0.002"];
    for (command, warns) in [("unload", false), ("cycle", false), ("trace", true)] {
        let output = Command::cargo_bin("pulloff").unwrap().arg(command).args(set).assert().success();
        let [out, text] = [&output.get_output().stdout, &output.get_output().stderr]
            .map(|bytes| String::from_utf8_lossy(bytes).into_owned());
        assert_eq!(text.contains("material.closing_work_of_adhesion"), warns, "{command}: {text}");
        assert_eq!(out.contains("depin"), !warns, "{command}: {out}");
        assert_eq!(out.contains("energy lost in the dead band"), command == "cycle", "{command}: {out}");
    }
    let json =
        Command::cargo_bin("pulloff").unwrap().arg("cycle").args(set).args(["--format", "json"]).assert();
    let document: Value = serde_json::from_slice(&json.success().get_output().stdout).unwrap();
    let totals = &document["totals"];
    let of = |name: &str| totals[name].as_f64().unwrap();
    let band = totals["dead_band"]["dissipated"].as_f64().unwrap();
    let area = totals["dead_band"]["area"].as_f64().unwrap();
    assert!((band / area / (0.003_978_873_577_297_383_6 - 0.002) - 1.0).abs() < 1e-12);
    let work = of("work_of_loading") + of("work_of_unloading");
    assert!((work / (of("dissipated") + band) - 1.0).abs() < 1e-9);
    let range = ["--set", "material.adhesion=dugdale", "--set", "material.cohesive_strength=1"];
    let refused =
        Command::cargo_bin("pulloff").unwrap().arg("unload").args(set).args(range).assert().failure();
    let text = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(text.contains("needs short-range adhesion"), "{text}");
}
