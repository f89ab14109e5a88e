//! `pulloff fit`: its document, its exit statuses, and its refusals.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::Home;
use serde_json::Value;
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::fs;

pub const LENS: &str = include_str!("../../presets/data/lens.csv");
pub const FREE: [&str; 2] = ["--free", "E*,gamma,data.offset"];

#[test]
fn the_preset_may_stand_anywhere_among_the_files_and_there_is_one() {
    let home = Home::new();
    let ended = home.run(&[&["fit", "lens", "shipped:lens.csv"], &FREE[..]].concat());
    assert!(ended.status == 0 && ended.out.contains("the model describes"), "{} {}", ended.out, ended.err);
    let ended = home.run(&[&["fit", "lens", "shipped:lens.csv", "fig-9.toml"], &FREE[..]].concat());
    let said = "lens and fig-9.toml are presets: files with points go with one";
    assert!(ended.status == 2 && ended.err.contains(said), "{} {}", ended.status, ended.err);
}

#[test]
fn the_truth_of_the_shipped_curve_is_found_and_written() {
    let home = Home::new();
    let ended = home.run(
        &[
            &[
                "fit",
                "shipped:lens.csv",
                "lens",
                "--format=json",
                "-o",
                "fitted.toml",
                "--residuals",
                "r.csv",
            ],
            &FREE[..],
        ]
        .concat(),
    );
    let said = "pulloff: note: units of the columns: x in m; force in N\n";
    assert_eq!((ended.status, ended.err.as_str()), (0, said));
    let document: Value = serde_json::from_str(&ended.out).unwrap();
    assert_eq!((document["schema"].as_u64(), document["verdict"].as_str()), (Some(1), Some("describes")));
    assert!(document["reasons"].as_array().unwrap().is_empty());
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
    let rows = &document["rows"];
    assert_eq!(rows["approach"], serde_json::json!({"contact": 191, "free": 159, "jump": 0, "dropped": 0}));
    assert_eq!(counted(rows, "contact") + counted(rows, "free"), 700);
    let residuals = home.text("r.csv");
    assert!(residuals.starts_with("row,line,segment,part,"), "{residuals}");
    assert_eq!(residuals.matches(",retraction,free,").count(), counted(&rows["retraction"], "free"));
    // Each row corresponds to its line, in JSON as in CSV.
    let beside = document["residuals"].as_array().unwrap();
    assert_eq!(beside.len(), 700);
    let lines: Vec<&str> = LENS.lines().collect();
    for (row, csv) in beside.iter().zip(residuals.lines().skip(1)) {
        let line = usize::try_from(row["line"].as_u64().unwrap()).unwrap();
        let [x, force] = ["x", "force"].map(|key| row[key].as_f64().unwrap());
        let cells: Vec<&str> = lines[line - 1].split(", ").collect();
        let told = [
            format!("{:.3}", 1e6 * x),
            format!("{:.1}", 1e6 * force),
            row["segment"].as_str().unwrap().to_owned(),
        ];
        assert_eq!(cells, told, "{row}");
        let [part, off] = [&row["part"], &row["residual"]];
        assert!(
            csv.starts_with(&format!("{},{line},{},{},", row["row"], told[2], part.as_str().unwrap())),
            "{csv}"
        );
        assert!(csv.contains(&format!(",{off},")), "{row} {csv}");
        assert!(row["outlier"] == true || off.as_f64().unwrap().abs() < 6.0, "{row}");
    }
    let outliers = beside.iter().filter(|row| row["outlier"] == true).count();
    assert_eq!(document["outliers"].as_u64(), Some(outliers as u64));
    assert_eq!(document["correlations"].as_array().unwrap().len(), 4);
    assert_eq!(home.text("r.csv").lines().count(), 701);
    // The fitted preset is a valid preset, and fits as it is.
    assert!(home.text("fitted.toml").contains("stiffness"));
    let again = home.run(&["fit", "shipped:lens.csv", "fitted.toml", "--no-scan", FREE[0], FREE[1]]);
    assert_eq!(again.status, 0, "{}", again.err);
}

#[test]
fn models_are_compared() {
    let home = Home::new();
    let both = ["fit", "lens", "--segment", "retraction", "--model", "short-range,dugdale"];
    let ended = home.run(&[&both[..], &["--format", "json", "-o", "both.json"]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    let document: Value = serde_json::from_str(&home.text("both.json")).unwrap();
    assert_eq!((&document["document"], &document["best"]), (&"fit-models".into(), &"short-range".into()));
    let [pair] = &document["pairs"].as_array().unwrap()[..] else { panic!("{document}") };
    assert_eq!(pair["told_apart"], false, "{pair}");
    let [sharp, ranged] = &document["fits"].as_array().unwrap()[..] else { panic!("{document}") };
    assert_eq!([&sharp["model"], &sharp["verdict"]], ["short-range", "describes"]);
    // The cohesive strength is free without being named, and is not determined.
    assert_eq!([&ranged["model"], &ranged["verdict"]], ["dugdale", "not-determined"]);
    let keys: Vec<&str> =
        ranged["parameters"].as_array().unwrap().iter().map(|of| of["key"].as_str().unwrap()).collect();
    assert!(keys.contains(&"material.cohesive_strength"), "{keys:?}");
    assert!(ranged["direction"].as_str().unwrap().contains("how far the adhesion reaches"), "{ranged}");
    let ended =
        home.run(&["fit", "shipped:lens.csv", "shipped:lens.csv", "lens", "--model", "short-range,dugdale"]);
    assert_ne!(ended.status, 0);
    assert!(ended.err.contains("on one file of points"), "{}", ended.err);
    let ended = home.run(&["fit", "lens", "--model", "hertz"]);
    assert!(ended.status == 2 && ended.err.contains("dugdale"), "{}", ended.err);
}

/// The number of rows in this part, in one branch or in both.
fn counted(rows: &Value, part: &str) -> usize {
    let of = |rows: &Value| usize::try_from(rows[part].as_u64().unwrap()).unwrap();
    if rows[part].is_u64() { of(rows) } else { of(&rows["approach"]) + of(&rows["retraction"]) }
}

#[test]
fn rows_are_mended_by_hand_and_counted() {
    let home = Home::new();
    let fit = |more: &[&str]| {
        let ended = home.run(&[&["fit", "lens", "--format=json", "--accept"], more].concat());
        assert_eq!(ended.status, 0, "{more:?}: {}", ended.err);
        serde_json::from_str::<Value>(&ended.out).unwrap()
    };
    let idle = fit(&["--range", "x=-40..90"])["warnings"].to_string();
    assert!(idle.contains("from -4e7 um to 9e7 um leaves no row out: the rows have "), "{idle}");
    // Rows between the jump of the approach and the named part are neither in contact nor apart.
    let named = fit(&["--free-part", "x=..9um"]);
    let (approach, rows) = (&named["rows"]["approach"], &named["rows"]);
    assert_eq!([counted(approach, "contact"), counted(approach, "free")], [191, 102]);
    assert_eq!(counted(approach, "dropped") + counted(approach, "jump"), 57, "{rows}");
    assert_eq!(named["verdict"], "describes");
    assert_eq!(fit(&["--set", "data.free_part=x=..9um"])["rows"], *rows);
    let retraction = fit(&["--segment", "retraction", "--free-part", "x=..9um"]);
    assert_eq!(retraction["rows"]["approach"]["dropped"], 350);
    let none = fit(&["--free-part", "none", "--segment=retraction", "--range", "x=10um.."]);
    assert_eq!(counted(&none["rows"], "free"), 0);
    let notes = none["notes"].to_string();
    assert!(notes.contains("data.baseline is fitted too, known to within 20 uN beforehand"), "{notes}");
    let held =
        fit(&["--free-part=none", "--segment=retraction", "--range=x=10um..", "--set=data.baseline=4uN"]);
    let notes = held["notes"].to_string();
    assert!(notes.contains("there is no free part: the baseline is held as given"), "{notes}");
    let skipped = fit(&["--skip", "50", "--signs", "x=+,f=+"]);
    assert_eq!(skipped["rows"]["approach"]["dropped"], 50);
    assert_eq!(skipped["rows"]["retraction"], fit(&[])["rows"]["retraction"]);
    // The written file has it.
    let ended =
        home.run(&["fit", "lens", "--skip=50", "--signs=x=+,force=+", "--free-part=x=..9um", "-o", "f.toml"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    let written = home.text("f.toml");
    for line in ["skip = 50", "signs = \"x=+,force=+\"", "free_part = \"x=..9um\""] {
        assert!(written.contains(line), "{written}");
    }
    assert!(ended.out.contains("rows        contact  free  jump  dropped"), "{}", ended.out);
    for (arguments, expected) in [
        (["--free-part", "9um"], "--free-part: \"9um\": expected x=LO..HI, or none"),
        (["--free-part", "x=9um..2um"], "--free-part: \"x=9um..2um\": the range is empty"),
        (["--free-part", "x=1N..2N"], "--free-part: "),
        (["--free-part", "x=1m..2m"], "no row lies in the requested free part"),
        (["--signs", "x=-"], "--signs: \"x=-\": expected the signs of both columns, as in x=-,force=+"),
        (["--skip", "697"], "only 3 rows are left after the range, the segment and the rows to skip"),
        (["--skip", "-1"], "--skip"),
        (["--range", "y=1..2"], "--range: \"y=1..2\": expected x=LO..HI or force=LO..HI"),
    ] {
        for command in
            ["fit", "plot"].iter().filter(|command| **command == "fit" || arguments[0] != "--range")
        {
            let ended = home.run(&[&[*command, "lens"], &arguments[..]].concat());
            assert!(
                ended.status == 2 && ended.err.contains(expected),
                "{arguments:?}: {} {}",
                ended.status,
                ended.err
            );
        }
    }
    let ended =
        home.run(&["plot", "lens", "--free-part=x=..9um", "--view=residuals", "-o", "o.svg", "--data"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    let data = home.text("o.csv");
    assert_eq!(data.matches("\nmeasured approach,").count(), 191);
    assert_eq!(data.matches("\"measured approach, apart\",").count(), 102);
}

/// A preset's own measured curve, which states another radius, is no obstacle where it is not used.
#[test]
fn what_does_not_use_the_points_takes_values_that_contradict_them() {
    let home = Home::new();
    for command in ["trace", "unload", "cycle"] {
        let ended = home.run(&[command, "lens", "--set", "R=5mm"]);
        assert_eq!((ended.status, ended.err.contains("lens.csv")), (0, false), "{command}: {}", ended.err);
    }
    // What is wrong besides is not blamed on the file.
    let ended = home.run(&["unload", "lens", "--set", "R=1um"]);
    let said = ended.err.contains("path.start_contact_radius") && !ended.err.contains("lens.csv");
    assert!(ended.status == 2 && said, "{}", ended.err);
    let ended = home.run(&["plot", "lens", "--set", "R=5mm", "-o", "a.svg"]);
    assert!(ended.status == 2 && ended.err.contains("states a tip radius"), "{}", ended.err);
}

#[test]
fn many_rows_without_numbers_are_told() {
    let home = Home::new();
    let without = |share: usize| {
        let of = |(i, line): (usize, &str)| match line.split(", ").collect::<Vec<_>>()[..] {
            [x, _, segment] if i.is_multiple_of(share) && !line.contains("force") => {
                format!("{x}, , {segment}\n")
            }
            _ => format!("{line}\n"),
        };
        home.file("a.csv", &LENS.lines().enumerate().map(of).collect::<String>());
        home.run(&[&["fit", "a.csv", "lens"], &FREE[..]].concat()).err
    };
    let said = "rows have no number in a column that is used, and are left out";
    assert!(without(3).contains(said));
    assert!(!without(10).contains(said));
}

#[test]
fn what_is_not_determined_has_a_status_of_its_own() {
    let home = Home::new();
    let ended =
        home.run(&["fit", "shipped:lens.csv", "lens", "--free", "R,E*,gamma,data.offset", "--format=json"]);
    assert_eq!(ended.status, 3, "{}", ended.err);
    let document: Value = serde_json::from_str(&ended.out).unwrap();
    assert!(document["direction"].as_str().unwrap().starts_with("R +10 %, E* −4.7 %, γ −9.1 % together"));
    assert!(document["parameters"][0]["standard_error"].is_null());
}

#[test]
fn a_model_that_does_not_describe_the_points_has_a_status_of_its_own() {
    let home = Home::new();
    let wrong = [
        &["fit", "shipped:lens.csv", "lens", "--format=json", "--set", "path.control.stiffness=300 N/m"],
        &FREE[..],
    ]
    .concat();
    let ended = home.run(&wrong);
    assert_eq!(ended.status, 4, "{}", ended.err);
    let document: Value = serde_json::from_str(&ended.out).unwrap();
    assert_eq!(document["verdict"].as_str(), Some("does-not-describe"));
    assert_eq!(document["parameters"][0]["error_holds"].as_bool(), Some(false));
    let reason = &document["reasons"][0];
    assert!(reason["kind"].is_string() && reason["value"].is_number(), "{reason}");
    assert!(ended.err.contains(reason["sentence"].as_str().unwrap()), "{}", ended.err);
    let accepted = home.run(&[&wrong[..], &["--accept"]].concat());
    assert_eq!((accepted.status, &accepted.out), (0, &ended.out));
}

/// A record that ends in contact, and is flat there, looks as if its last rows were apart: the fit takes them in contact, and says so;
/// where they are said to be apart, it says what helps.
#[test]
fn rows_that_are_only_taken_to_be_apart_are_told() {
    let home = Home::new();
    let trace = home.run(&["trace", "wavy-sphere"]);
    let unstable = [
        [0.3565, 0.3920],
        [0.3056, 0.3422],
        [0.2545, 0.2925],
        [0.2031, 0.2428],
        [0.1505, 0.1931],
        [0.0, 0.1435],
    ];
    let mut rows = "approach,force\n".to_owned();
    for (k, line) in trace.out.lines().skip(1).enumerate() {
        // As irregular as noise.
        let noise = 2e-4 * (7919.0 * k as f64).sin();
        let cell: Vec<f64> = line.split(',').take(4).map(|cell| cell.parse().unwrap()).collect();
        if unstable.iter().all(|[lo, hi]| cell[1] < *lo || cell[1] > *hi) {
            writeln!(rows, "{},{}", cell[2], cell[3] + noise).unwrap();
        }
    }
    home.file("ends-in-contact.csv", &rows);
    let fit = ["fit", "ends-in-contact.csv", "wavy-sphere", "--free", "E*,gamma", "--format=json"];
    let found = |ended: &crate::support::home::Ended| -> Value { serde_json::from_str(&ended.out).unwrap() };
    let taken = found(&home.run(&fit));
    assert!(taken["notes"].to_string().contains("9 rows that may look apart are in contact"), "{taken}");
    let document = found(&home.run(&[&fit[..], &["--free-part", "x=-0.0502..-0.0471"]].concat()));
    let reasons = document["reasons"].as_array().unwrap();
    let off = reasons.iter().find(|reason| reason["kind"] == "not-apart").expect("what is off");
    assert!(off["sentence"].as_str().unwrap().contains("--free-part none"), "{off}");
    assert!(
        document["warnings"].to_string().contains("if that is no disturbance, the values are wrong"),
        "{document}"
    );
    assert!(reasons.iter().all(|reason| reason["kind"] != "tilt"), "{reasons:?}");
    let ended = home.run(&[&fit[..], &["--free-part", "none"]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    let document = found(&ended);
    assert_eq!(document["verdict"].as_str(), Some("describes"));
    assert_eq!(document["parameters"], taken["parameters"]);
    // Modulus and adhesion follow from one another here, which their errors do not say.
    let notes = document["notes"].to_string();
    assert!(notes.contains("a combination of E* and γ is known far better than either of them"), "{notes}");
}

/// Values known with an error add to the errors of the fit, whether given by option or by key.
#[test]
fn an_error_of_what_is_given_is_in_those_of_the_values() {
    let home = Home::new();
    let fit = |more: &[&str]| {
        let ran = home.run(&[&["fit", "lens", "--no-scan", "--format=json"], &FREE[..], more].concat());
        assert_eq!(ran.status, 0, "{}", ran.err);
        let json: serde_json::Value = serde_json::from_str(&ran.out).unwrap();
        json
    };
    let error = |json: &serde_json::Value| json["parameters"][0]["standard_error"].as_f64().unwrap();
    let held = fit(&[]);
    let known = fit(&["--uncertain", "R=3%"]);
    assert!(error(&known) > 1.2 * error(&held), "{known}");
    assert_eq!(known["priors"][0]["key"], "gap.radius_of_curvature");
    assert_eq!(held["priors"], serde_json::json!([]));
    let by_key = fit(&["--set", "data.uncertain=gap.radius_of_curvature=3%"]);
    assert_eq!(known["parameters"], by_key["parameters"]);
    let refused = |given: &str, said: &[&str]| {
        home.refused(&[&["fit", "lens", "--no-scan"], &FREE[..], &["--uncertain", given]].concat(), said);
    };
    refused(
        "gap.radius_of_curvatre=3%",
        &["uncertain value", "gap.radius_of_curvatre=3%", "did you mean gap.radius_of_curvature"],
    );
    refused("R=0%", &["uncertain value", "above 0"]);
    refused("R", &["expected KEY=ERROR"]);
}

/// The columns are those of the given file, whatever the preset's own file has.
#[test]
fn columns_are_judged_by_the_file_that_is_given() {
    let home = Home::new();
    let free = [FREE[0], FREE[1], "--no-scan"];
    // The same curve with other column names, after five other columns.
    let wide: String = LENS
        .lines()
        .filter(|line| !line.starts_with('#'))
        .enumerate()
        .map(|(at, line)| {
            let line =
                if at == 0 { "i,j,k,l,m,way,pull,branch".to_owned() } else { format!("0,0,0,0,0,{line}") };
            line + "\n"
        })
        .collect();
    let wide = home.file("wide.csv", &wide);
    home.file("mine.toml", &home.quiet(&["presets", "show", "lens"]).replace("shipped:lens.csv", "mine.csv"));
    home.file("mine.csv", LENS);
    let columns = "position=way [um],force=pull [uN],segment=branch";
    for columns in [columns, "position=6 [um],force=7 [uN],segment=8"] {
        for preset in ["lens", "mine.toml"] {
            let fitted = home.run(&[&["fit", &wide, preset, "--columns", columns], &free[..]].concat());
            assert_eq!(fitted.status, 0, "{preset} {columns}: {}", fitted.err);
            let drawn = home.run(&[
                "plot",
                preset,
                "--measured",
                &wide,
                "--columns",
                columns,
                "-o",
                "x.svg",
                "--data",
            ]);
            assert_eq!(drawn.status, 0, "{preset} {columns}: {}", drawn.err);
            fs::remove_file(home.path("x.svg")).unwrap();
            fs::remove_file(home.path("x.csv")).unwrap();
        }
    }
    // The message names the right file, or the option.
    let wrong = |columns: &str, said: &[&str]| {
        home.refused(&[&["fit", &wide, "lens", "--columns", columns], &free[..]].concat(), said);
        home.refused(&["plot", "lens", "--measured", &wide, "--columns", columns], said);
    };
    wrong("x=9,force=7", &["wide.csv", "no column 9"]);
    wrong("way=6", &["--columns", "way"]);
    // For the preset's own curve, where no other file is given.
    home.refused(
        &[&["fit", "lens", "--columns", "x=9,force=2"], &free[..]].concat(),
        &["lens.csv", "no column 9"],
    );
}

/// The list of free keys is kept with the fitted values.
#[test]
fn a_fitted_preset_keeps_what_was_free() {
    let home = Home::new();
    let fit = ["fit", "lens", "--free", "E*, gamma,data.offset", "--no-scan", "-o", "fitted.toml"];
    assert_eq!(home.run(&fit).status, 0);
    assert!(
        home.text("fitted.toml").contains("free = \"E*,gamma,data.offset\""),
        "{}",
        home.text("fitted.toml")
    );
    let again = home.run(&["fit", "fitted.toml", "--no-scan"]);
    assert_eq!(again.status, 0, "{}", again.err);
    assert_eq!(again.out.matches("material.").count(), 2, "{}", again.out);
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
            vec!["fit", &path, "lense", FREE[0], FREE[1]],
            "lense: there is no such file, and no preset is called \"lense\"; did you mean lens?",
        ),
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
    let ended = home.run(&["plot", "lens", "--measured", &path, "--view", "force-radius"]);
    assert!(
        ended.status == 2 && ended.err.contains("does not have the columns of force-radius"),
        "{}",
        ended.err
    );
}

/// A column headed `displacement` may be that of the bodies or that of the device, and an error that does not hold has
/// no cell.
#[test]
fn a_displacement_is_tried_as_a_position_where_it_does_not_describe() {
    let home = Home::new();
    home.file("d.csv", &LENS.replace("position [um]", "displacement [um]"));
    let base = ["fit", "d.csv", "lens"];
    let ended = home.run(&[&base[..], &["-o", "d.out.csv", "--residuals", "r.csv"]].concat());
    assert_eq!(ended.status, 4, "{}", ended.err);
    let first = ended.err.lines().find(|line| line.contains("warning: ")).unwrap();
    assert!(first.contains("x, headed \"displacement\", is read as the approach of the bodies"), "{first}");
    assert!(first.ends_with("position=1,force=2,segment=3. As that, the model describes it"), "{first}");
    let units = "note: units of the columns: material.effective_modulus in Pa; ";
    assert!(
        ended.err.contains(units) && ended.err.contains("note: units of the columns: x in m; force in N\n")
    );
    let text = home.text("d.out.csv");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    let row = reader.records().next().unwrap().unwrap();
    for (name, cell) in header.iter().zip(&row).filter(|(name, _)| name.ends_with(" error")) {
        assert_eq!(cell, "", "{name}");
    }
    let other = home.run(&[&base[..], &["--columns", "position=1,force=2,segment=3"]].concat());
    assert_eq!(other.status, 0, "{}", other.out);
}

/// Of a heading that says what x is, the other reading is told only where the model describes it.
#[test]
fn an_approach_that_is_headed_as_a_position_is_told() {
    let home = Home::new();
    let rows = |spring: f64| {
        (0..160_u32).map(move |i| {
            // JKR with E* = 1 MPa, γ = 50 mJ/m² and R = 1 mm, in SI, from 100 µm of contact radius down, then apart.
            let s = 1e-4 * (1.0 - f64::from(i) / 100.0);
            let (delta, force) = if s > 2.8e-5 {
                let root = (2.0 * std::f64::consts::PI * 0.05 * s / 1e6).sqrt();
                let delta = s * s / 1e-3 - root;
                (delta, 2e6 * (delta * s - s.powi(3) / 3e-3))
            } else {
                (-2.2e-6 - 1e-7 * f64::from(i - 72), 0.0)
            };
            let noise = 1e-6 * f64::from(i * 7 % 11) / 11.0;
            format!("{:.6},{:.5}\n", 1e6 * (delta + force / spring), 1e6 * (force + noise))
        })
    };
    for (spring, is_told) in [(f64::INFINITY, true), (300.0, false)] {
        let text: String = rows(spring).collect();
        home.file("p.csv", &format!("position [um],force [uN]\n{text}"));
        let ended = home.run(&["fit", "p.csv", "lens", FREE[0], FREE[1]]);
        let told = "x, headed \"position\", is read as the position of the device and may be the approach of the bodies";
        assert_eq!(ended.err.contains(told), is_told, "{spring}: {}", ended.err);
    }
}

/// The force is k times a deflection, and all values of the bodies are in proportion to it: k cannot be fitted, and a note of it is
/// exact.
#[test]
fn the_stiffness_is_not_fitted_to_deflections() {
    let home = Home::new();
    let deflected = |line: &str| {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let force: f64 = cells[1].parse().unwrap();
        format!("{},{:.6},{}\n", cells[0], force / 500.0, cells[2])
    };
    let rows: String = LENS
        .lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit() || c == '-'))
        .map(deflected)
        .collect();
    home.file(
        "d.csv",
        &format!("# segment: approach, then retraction\nposition [um],deflection [um],segment\n{rows}"),
    );
    let base = ["fit", "d.csv", "lens"];
    let ended = home.run(&base);
    assert_eq!(ended.status, 0, "{} {}", ended.out, ended.err);
    let exact = "note: with k 10 % larger: E* +10.0 %, γ +10.0 %; with k 10 % smaller: E* −10.0 %, γ −10.0 %";
    assert!(ended.out.contains(exact), "{}", ended.out);
    for more in [["--free", "E*,gamma,data.offset,k"], ["--uncertain", "path.control.stiffness=10%"]] {
        home.refused(&[&base[..], &more].concat(), &["is held: the points have the deflection"]);
    }
}

/// The rows of the lens with the other sign of x and of the force.
fn turned_lens() -> String {
    let turned = LENS.lines().map(|line| match line.split(", ").collect::<Vec<_>>()[..] {
        [x, force, segment] if x.parse::<f64>().is_ok() => {
            let [x, force] = [x, force].map(|number| -number.parse::<f64>().unwrap());
            format!("{x}, {force}, {segment}\n")
        }
        _ => format!("{line}\n"),
    });
    turned.collect()
}

/// Turned signs are said where the turned numbers are written.
#[test]
fn the_signs_of_residuals_are_said() {
    let home = Home::new();
    home.file("t.csv", &turned_lens());
    let ended = home.run(&["fit", "t.csv", "lens", "--residuals", "r.csv"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    let said = "note: units of the columns: x in m; force in N; the signs of x and force are those of the fit, turned against the \
                file: x=-,force=-\n";
    assert!(ended.err.contains(said), "{}", ended.err);
}

/// What a fit says of the instrument of a turned file is what `--set` and `plot` take.
#[test]
fn offset_and_baseline_of_a_turned_file_are_numbers_of_the_file() {
    let home = Home::new();
    home.file("t.csv", &turned_lens());
    home.file("t0.csv", LENS);
    let drawn = |file: &str, signs: f64| {
        let fitted = home.run(&[&["fit", file, "lens"], &FREE[..], &["--format=json"]].concat());
        assert_eq!(fitted.status, 0, "{}", fitted.err);
        let found: Value = serde_json::from_str(&fitted.out).unwrap();
        let of = |key: &str| {
            let mut all = found["parameters"].as_array().unwrap().iter();
            all.find(|parameter| parameter["key"] == key).unwrap()["value"].as_f64().unwrap()
        };
        let [offset, baseline] = [of("data.offset"), of("data.baseline")];
        assert!((signs * offset - 12.3e-6).abs() < 2e-8 && (signs * baseline - 4e-6).abs() < 5e-7);
        let [offset, baseline] = [("--offset", offset, "m"), ("--baseline", baseline, "N")]
            .map(|(name, x, unit)| format!("{name}={x}{unit}"));
        let plot = home.run(&[
            "plot",
            "lens",
            "--measured",
            file,
            &offset,
            &baseline,
            "-o",
            "o.svg",
            "--data",
            "--overwrite",
        ]);
        assert_eq!(plot.status, 0, "{}", plot.err);
        home.text("o.csv")
            .lines()
            .filter(|line| line.contains("measured"))
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let [one, other] = [drawn("t0.csv", 1.0), drawn("t.csv", -1.0)];
    assert!(!one.is_empty() && one.len() == other.len());
    let numbers = |line: &String| line.split(',').filter_map(|cell| cell.parse().ok()).collect::<Vec<f64>>();
    for (a, b) in one.iter().zip(&other) {
        for (a, b) in numbers(a).iter().zip(numbers(b)) {
            assert!((a - b).abs() <= 1e-6 * a.abs() + 1e-10, "{a} {b}");
        }
    }
}

#[test]
fn noise_of_the_force_may_be_given_as_a_share() {
    let home = Home::new();
    home.file("a.csv", LENS);
    let fit =
        |sigma: &str| home.run(&[&["fit", "a.csv", "lens"], &FREE[..], &["--sigma-force", sigma]].concat());
    for (sigma, said) in [
        ("3%", "sigma of P is the root of (2.08"),
        ("2uN + 3 %", "sigma of P is the root of (2 uN)^2 + (3 % of P)^2"),
        ("2uN+3%", "of P 2 uN (given) and 3 % of P"),
    ] {
        let ended = fit(sigma);
        assert!(ended.status == 0 && ended.out.contains(said), "{sigma}: {} {}", ended.out, ended.err);
    }
    for sigma in ["2uN+x%", "0%", "-3%", "3+%"] {
        assert_eq!(fit(sigma).status, 2, "{sigma}");
    }
}

/// A ball of 10 mm, 50 kPa and 40 mJ/m², retracted, with the force in N though it is in mN, or with δ measured from
/// elsewhere.
#[test]
fn a_wrong_unit_of_the_force_and_a_held_offset_are_suspected() {
    let home = Home::new();
    let rows = |offset: f64| -> String {
        let row = |i: i32| {
            let s = 2.2e-3 - 2e-5 * f64::from(i);
            let force = 4.0 * 5e4 * s.powi(3) / 0.03 - (8.0 * PI * 0.04 * 5e4 * s.powi(3)).sqrt();
            let approach = s * s / 0.01 - (TAU * 0.04 * s / 5e4).sqrt();
            let noise = 1e-3 * f64::from(i * 7919 % 101 - 50) / 50.0;
            format!("{:.6},{:.6}\n", approach * 1e3 + offset, force * 1e3 + noise)
        };
        (0..80).map(row).collect()
    };
    home.file("newton.csv", &format!("delta [mm],force [N]\n{}", rows(0.0)));
    home.file("offset.csv", &format!("delta [mm],force [mN]\n{}", rows(0.05)));
    let fit = |file: &str| {
        let set = ["--set", "R=10 mm", "--control=displacement", "--free=E*,gamma", "--accept"];
        home.run(&[&["fit", file, "lens"][..], &set].concat())
    };
    let newton = fit("newton.csv");
    assert!(newton.err.contains("check the unit of the force"), "{}", newton.err);
    let offset = fit("offset.csv");
    assert!(offset.err.contains("most likely data.offset, where x is zero"), "{}", offset.err);
}
