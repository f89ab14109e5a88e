//! `pulloff fit` of many files: its table, which goes on where it ended.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::fit::{FREE, LENS};
use crate::support::home::Home;
use rustix::process::Signal;

#[test]
fn a_table_goes_on_where_it_ended() {
    let home = Home::new();
    let (good, bad) = (home.file("a.csv", LENS), home.file("b.csv", &LENS.replace("retraction", "back")));
    let arguments = [&["fit", &good, &bad, "lens", "--table", "t.csv"], &FREE[..]].concat();
    let ended = home.run(&arguments);
    assert!(ended.status == 2 && ended.err.contains("the segment \"back\" is not known"), "{}", ended.err);
    let first = home.text("t.csv");
    assert!(first.lines().count() == 3 && first.contains("a.csv,describes,"), "{first}");
    // The bad file, once corrected, is fitted; the good one is skipped.
    home.file("b.csv", LENS);
    let ended = home.run(&arguments);
    assert!(ended.status == 0 && ended.err.contains("a.csv: is already in the table"), "{}", ended.err);
    let second = home.text("t.csv");
    assert_eq!((second.lines().count(), second.matches(",describes,").count()), (3, 2), "{second}");
}

/// A pattern also matches what earlier fits wrote: the command may be run twice in one folder.
#[test]
fn what_fits_wrote_is_not_fitted() {
    let home = Home::new();
    let free = [FREE[0], FREE[1], "--no-scan"];
    home.file("a.csv", LENS);
    home.file("b.csv", LENS);
    let alone = [&["fit", "a.csv", "lens", "--residuals", "rest.csv"], &free[..]].concat();
    assert_eq!(home.run(&alone).status, 0);
    let all = ["fit", "a.csv", "b.csv", "rest.csv", "results.csv", "lens", "--table", "results.csv"];
    let first = home.run(&[&all[..3], &all[5..], &free].concat());
    assert_eq!(first.status, 0, "{}", first.err);
    let table = home.text("results.csv");
    let again = home.run(&[&all[..], &free].concat());
    assert_eq!(again.status, 0, "{}", again.err);
    assert_eq!(home.text("results.csv"), table);
    for said in [
        "note: rest.csv: is the residuals of a fit, not a measured curve; it is left out",
        "note: results.csv: is a table of fits, not a measured curve; it is left out",
        "note: a.csv: is already in the table: describes",
    ] {
        assert!(again.err.contains(said), "{}", again.err);
    }
    // Given alone they are refused, and a measured curve is not a table.
    home.refused(
        &[&["fit", "rest.csv", "lens"], &free[..]].concat(),
        &["rest.csv: is the residuals of a fit"],
    );
    home.refused(
        &[&["fit", "a.csv", "b.csv", "lens", "--table", "b.csv"], &free[..]].concat(),
        &["--table", "b.csv: is also read, as the points"],
    );
    assert_eq!(home.text("b.csv"), LENS);
}

/// A fit that was cut off is in no table, and a rerun computes it.
#[test]
fn a_table_has_no_row_that_was_cut_off() {
    let home = Home::new();
    home.file("a.csv", LENS);
    home.file("b.csv", LENS);
    // The second fit takes far longer than stopping it does.
    let common = ["lens", "--table", "t.csv", FREE[0], FREE[1], "--no-scan"];
    let bootstrap = ["--bootstrap", "100000"];
    let first = [&["fit", "a.csv"], &common[..]].concat();
    assert_eq!(home.run(&first).status, 0);
    let before = home.text("t.csv");
    let arguments = [&["fit", "a.csv", "b.csv"], &common[..], &bootstrap].concat();
    let ended = home.stopped(&arguments, Signal::INT);
    assert_eq!(ended.status, 130, "{}", ended.err);
    assert!(ended.err.contains("the same command goes on from there"), "{}", ended.err);
    assert_eq!(home.text("t.csv"), before);
    // For a single file without a table the best values are written, with a message.
    let ended =
        home.stopped(&[&["fit", "b.csv", "lens", FREE[0], FREE[1]], &bootstrap[..]].concat(), Signal::TERM);
    assert_eq!(ended.status, 143, "{}", ended.err);
    assert!(ended.err.contains("pulloff: stopped: "), "{}", ended.err);
    let ended = home.run(&[&["fit", "a.csv", "b.csv"], &common[..]].concat());
    assert!(ended.status == 0 && ended.err.contains("a.csv: is already in the table"), "{}", ended.err);
    assert_eq!(home.text("t.csv").matches(",describes,").count(), 2);
}

/// The status of a rerun of a table is that of its worst row.
#[test]
fn a_rerun_says_how_good_the_rows_are_that_it_passes_over() {
    let home = Home::new();
    home.file("a.csv", LENS);
    let arguments =
        ["fit", "a.csv", "lens", "--free", "R,E*,gamma,data.offset", "--no-scan", "--table", "t.csv"];
    for _ in 0..2 {
        assert_eq!(home.run(&arguments).status, 3);
    }
}

/// However many threads there are, the files come in order and are summed up at the end.
#[test]
fn many_files_are_summed_up_in_their_order_on_any_number_of_threads() {
    let home = Home::new();
    let files: Vec<String> = (0..5).map(|i| format!("{i}.csv")).collect();
    for file in &files {
        home.file(file, LENS);
    }
    home.file("2.csv", "x,force\n1,2\n");
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let with =
        |more: &[&str]| home.run(&[&["fit"], &files[..], &["lens", "--no-scan"], &FREE, more].concat());
    let [one, four] = ["--jobs=1", "--jobs=4"].map(|jobs| with(&[jobs, "--format=json"]));
    assert_eq!((one.status, four.status), (2, 2), "{}", one.err);
    assert!(one.out == four.out && one.err == four.err);
    let json: serde_json::Value = serde_json::from_str(&one.out).unwrap();
    let names: Vec<&str> =
        json["fits"].as_array().unwrap().iter().map(|fit| fit["file"].as_str().unwrap()).collect();
    assert_eq!(names, ["0.csv", "1.csv", "3.csv", "4.csv"]);
    let value = &json["fits"][0]["parameters"][0];
    let summed = &json["summary"]["values"][0];
    assert_eq!((&summed["key"], &summed["count"]), (&value["key"], &serde_json::json!(4)));
    // Four times the same curve.
    let [mean, of_one] = [&summed["mean"], &value["value"]].map(|number| number.as_f64().unwrap());
    assert!(
        (mean / of_one - 1.0).abs() < 1e-12 && summed["standard_deviation"].as_f64().unwrap() < 1e-9 * mean
    );
    // With a table, a file that cannot be fitted is in the table and in the list.
    let said = with(&["--table", "t.csv"]).out;
    assert!(said.contains("4 of 5 files are described by the model"), "{said}");
    assert!(said.contains("material.effective_modulus: mean ") && said.contains("\n  2.csv: "), "{said}");
}
