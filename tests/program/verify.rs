//! The program's numbers against theory, as reported by `pulloff verify`.

#![allow(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use pulloff_engine::report::{VerifyReport, table};
use pulloff_engine::verify::{Group, VerifyRow, VerifySettings, verify};
use serde_json::Value;
use std::process::{Command, Stdio};
use std::sync::LazyLock;

/// The rows as the program computes them, once for all tests.
static GROUPS: LazyLock<Vec<Group>> = LazyLock::new(|| verify(&VerifySettings::default()).unwrap());

/// Status, standard output and standard error of the program.
fn run(arguments: &[&str]) -> (i32, String, String) {
    let home = tempfile::tempdir().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_pulloff"));
    command.env_clear().env("HOME", home.path()).env("XDG_CONFIG_HOME", home.path());
    let output = command.arg("verify").args(arguments).stdin(Stdio::null()).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

#[test]
fn every_row_passes() {
    let report = VerifyReport::new(&GROUPS, None);
    let text = table::verify(&report);
    println!("{text}");
    let failed: Vec<_> = report.rows.iter().filter(|row| !row.passes).collect();
    assert!(failed.is_empty(), "{failed:#?}");
    assert_eq!(report.total, GROUPS.iter().map(|group| group.rows.len()).sum::<usize>());
    assert_eq!(text.lines().last(), Some(format!("{0} of {0} pass", report.total).as_str()));
}

/// The subjects of the rows, in order, without any digit that could differ between machines.
#[test]
fn the_groups_are_these() {
    let titles: Vec<&str> = GROUPS.iter().map(|group| group.title.as_str()).collect();
    insta::assert_snapshot!(titles.join("\n"), @r"
    Smooth sphere at s = 0.3 R, exact basis
    Hertz at approach 0.1 R, uniform rings
    JKR at approach 0.1 R, uniform rings
    Hertz at approach 0.1 R, rings crowded towards the edge
    JKR at approach 0.1 R, rings crowded towards the edge
    Newton-Raphson from three times the contact radius, JKR sphere
    Fig. 8, extreme values, exact basis
    Fig. 8, extreme values, 200 rings
    Fig. 9, extreme values, exact basis
    Fig. 9, extreme values, 200 rings
    Fig. 9 under displacement control, exact basis
    Fig. 9 under force control, exact basis
    Fig. 9 under stiffness=0.15 control, exact basis
    Fig. 9 under displacement control, 200 rings
    Fig. 9 under force control, 200 rings
    Fig. 9 under stiffness=0.15 control, 200 rings
    Adhesion with a range: a sphere against Maugis
    Pulls at a rate against the laws of slow pulls
    Fig. 9, the law of stability, exact
    Rigid flat annulus, force over 2E*δb
    Fig. 9: the loop up to δ = 0.14
    Fig. 9, γ = 1e-4: the loop up to δ = 0.14
    Self-consistency: Fig. 9 under displacement control, exact basis
    Self-consistency: Fig. 9 under force control, exact basis
    Self-consistency: Fig. 9 under stiffness=0.15 control, exact basis
    Self-consistency: Fig. 9 under displacement control, 200 rings
    Self-consistency: Fig. 9 under force control, 200 rings
    Self-consistency: Fig. 9 under stiffness=0.15 control, 200 rings
    Self-consistency: whole loops
    Self-consistency: Fig. 9, a slow pull
    ");
    for group in GROUPS.iter() {
        let heading = group.title.chars().count() + group.measure.chars().count() + 3;
        assert!(heading <= 100, "{}", group.title);
        assert!(group.rows.iter().all(|row| row.bound.is_finite() && row.bound >= 0.0), "{}", group.title);
    }
    let text = table::verify(&VerifyReport::new(&GROUPS, None));
    assert!(text.lines().all(|line| line.chars().count() <= 100));
}

/// Numbers that the program finds in two of its own ways agree, and are marked as not compared with theory.
#[test]
fn two_of_our_own_numbers_stand_apart() {
    let own = |group: &&Group| group.title.starts_with("Self-consistency: ");
    for group in GROUPS.iter() {
        let is_own = own(&group);
        assert!(
            !group.rows.is_empty() && group.rows.iter().all(|row| row.other.is_some() == is_own),
            "{}",
            group.title
        );
        assert!(group.rows.iter().all(|row| row.exact.is_nan() == is_own), "{}", group.title);
    }
    for what in ["area against drop", "device's work against stored and lost"] {
        let rows = GROUPS.iter().filter(own).flat_map(|group| &group.rows);
        assert!(rows.filter(|row| row.what.ends_with(what)).count() >= 6, "{what}");
    }
}

/// The numbers from the papers of the method, where rows have them: here, nothing is computed twice by the same code.
#[test]
fn the_exact_column_has_the_known_values() {
    let exact = |group: &str, what: &str| {
        let is_it = |g: &&Group| g.title.starts_with(group) && g.title.ends_with("exact basis");
        let rows = &GROUPS.iter().find(is_it).unwrap().rows;
        rows.iter().find(|row| row.what == what).unwrap().exact
    };
    for (group, what, known, digits) in [
        ("Fig. 8, extreme", "smallest force over P_c", -1.076_356_8, 5e-8),
        ("Fig. 8, extreme", "contact radius of smallest force", 0.290_07, 5e-6),
        ("Fig. 8, extreme", "smallest approach", -0.065_247_2, 5e-8),
        ("Fig. 8, extreme", "contact radius of smallest approach", 0.182_10, 6e-6),
        ("Fig. 9, extreme", "smallest force over P_c", -1.479_672_9, 5e-8),
        ("Fig. 9, extreme", "contact radius of smallest force", 0.293_389, 5e-7),
        ("Fig. 9, extreme", "smallest approach", -0.050_106_6, 5e-8),
        ("Fig. 9, extreme", "contact radius of smallest approach", 0.143_65, 5e-6),
        ("Fig. 9 under displacement", "snaps", 7.0, 0.0),
        ("Fig. 9 under displacement", "last contacts", 1.0, 0.0),
        ("Fig. 9 under force", "snaps", 4.0, 0.0),
    ] {
        let ours = exact(group, what);
        assert!((ours - known).abs() <= digits, "{group} {what}: {ours} {known}");
    }
}

#[test]
fn too_coarse_a_basis_fails() {
    let failing = |settings: VerifySettings| {
        let report = VerifyReport::new(&verify(&settings).unwrap(), None);
        let failed: Vec<String> =
            report.rows.iter().filter(|row| !row.passes).map(|row| row.group.clone()).collect();
        assert_eq!(report.passed + failed.len(), report.total);
        assert!(table::verify(&report).lines().any(|line| line.ends_with("FAIL")));
        failed
    };
    // Forty rings are four per wave: the figures fail, the exact basis does not.
    let rings = failing(VerifySettings { rings: 40 });
    assert!(rings.iter().any(|group| group.starts_with("Fig. 9")), "{rings:?}");
    assert!(rings.iter().all(|group| !group.ends_with("exact basis")), "{rings:?}");
}

#[test]
fn a_number_that_is_wrong_is_counted_and_written_as_null_where_there_is_none() {
    let groups = [
        Group {
            title: "Spheres".to_owned(),
            measure: "relative",
            rows: vec![
                VerifyRow::relative("approach", 0.102, 0.1, 0.05),
                VerifyRow::relative("force of a sphere", -2.5e-7, -2e-7, 0.05),
            ],
        },
        Group {
            title: "Counts".to_owned(),
            measure: "absolute",
            rows: vec![
                VerifyRow::new("snaps", 7.0, 7.0, 1.0, 0.0),
                VerifyRow::worst("limit points", [], 1.0, 1e-10),
            ],
        },
        Group {
            title: "Losses".to_owned(),
            measure: "relative",
            rows: vec![
                VerifyRow::own("area against drop", 0.25, 0.26, 0.26, 0.05),
                VerifyRow::own("work", f64::NAN, f64::NAN, 1.0, 0.05),
            ],
        },
    ];
    let report = VerifyReport::new(&groups, None);
    assert_eq!((report.passed, report.total), (3, 6));
    insta::assert_snapshot!(table::verify(&report), @r"
                               ours       exact  difference  bound

    Spheres (relative)
      approach           0.10200000  0.10000000     +2.0e-2   0.05  pass
      force of a sphere     -2.5e-7       -2e-7     -2.5e-1   0.05  FAIL

    Counts (absolute)
      snaps                       7           7           0      0  pass
      limit points                -           -           -  1e-10  FAIL

                               ours    ours too  difference  bound

    Losses (relative)
      area against drop  0.25000000  0.26000000     -3.8e-2   0.05  pass
      work                        -           -           -   0.05  FAIL

    3 of 6 pass
    ");
    let json = serde_json::to_value(&report).unwrap();
    assert!(json["rows"][3]["ours"].is_null() && json["rows"][3]["passes"] == false);
    // Our own numbers are never called exact.
    assert!(json["rows"][0]["exact"] == 0.1 && json["rows"][0]["other"].is_null());
    assert!(json["rows"][4]["exact"].is_null() && json["rows"][4]["other"] == 0.26);
    // By heading or by name, in upper or lower case.
    for (only, total) in [("spheres", 2), ("SPHERE", 2), ("of a", 1), ("count", 2), ("nothing", 0)] {
        assert_eq!(VerifyReport::new(&groups, Some(only)).total, total, "{only}");
    }
}

#[test]
fn the_program_writes_a_table_or_json_and_nothing_else() {
    let (status, table, error) = run(&[]);
    assert_eq!((status, error.as_str()), (0, ""));
    let rows = GROUPS.iter().map(|group| group.rows.len()).sum::<usize>();
    assert_eq!(table.lines().last(), Some(format!("{rows} of {rows} pass").as_str()));

    let (status, text, error) = run(&["--format=json", "--only", "smooth sphere"]);
    assert_eq!((status, error.as_str()), (0, ""));
    let json: Value = serde_json::from_str(&text).unwrap();
    let keys = |value: &Value| -> Vec<String> { value.as_object().unwrap().keys().cloned().collect() };
    assert_eq!(keys(&json), ["schema", "document", "program_version", "passed", "total", "rows"]);
    assert_eq!((json["schema"].as_u64(), json["passed"].as_u64()), (Some(1), Some(6)));
    for row in json["rows"].as_array().unwrap() {
        let fields = ["group", "measure", "what", "ours", "exact", "other", "difference", "bound", "passes"];
        assert_eq!(keys(row), fields);
        assert!(row["group"].as_str().unwrap().starts_with("Smooth sphere"));
        assert!(row["ours"].is_number() && row["bound"].is_number() && row["passes"] == true);
    }
}

#[test]
fn a_pattern_that_no_row_has_is_bad_usage_that_lists_the_headings() {
    let (status, out, error) = run(&["--only", "quantum"]);
    assert_eq!((status, out.as_str()), (2, ""));
    assert!(error.contains("--only") && error.contains(&GROUPS[0].title), "{error}");
}
