//! Fits as rows of a sweep: the values of `pulloff fit`, in shards, continued, and recognised by the bytes of their files.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::{Ended, Home};
use std::fs;

fn done(home: &Home, arguments: &[&str]) {
    let Ended { status, err, .. } = home.run(arguments);
    assert_eq!(status, 0, "{err}");
}

/// The second file has every other row of the first; the third ends long before the bodies touch.
fn with_files() -> Home {
    let home = Home::new();
    let text = concat!(env!("CARGO_MANIFEST_DIR"), "/engine/presets/data/lens.csv");
    let text = fs::read_to_string(text).unwrap();
    let (head, rows): (Vec<&str>, Vec<&str>) =
        text.lines().partition(|line| !line.starts_with(|c: char| c.is_ascii_digit() || c == '-'));
    let file = |name: &str, rows: &[&str]| {
        home.file(name, &format!("{}\n{}\n", head.join("\n"), rows.join("\n")));
    };
    file("half.csv", &rows.iter().copied().step_by(2).collect::<Vec<_>>());
    file("apart.csv", &rows[..40]);
    home.file(
        "s.toml",
        r#"
preset = "lens"
quantities = ["fitted_modulus", "fitted_modulus_error", "fitted_adhesion", "fitted_offset", "fitted_radius",
    "fit_chi_squared", "fit_outliers", "fit_warnings", "tabor"]
[[axis]]
key = "data.file"
values = ["shipped:lens.csv", "half.csv", "apart.csv", "nowhere.csv"]
"#,
    );
    home
}

#[test]
fn a_row_is_the_fit_of_its_file_and_says_why_there_is_none() {
    let home = with_files();
    done(&home, &["sweep", "s.toml", "-o", "r.csv"]);
    let text = home.text("r.csv");
    let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.splitn(12, ',').collect()).collect();
    assert_eq!(rows.len(), 4, "{text}");
    for (row, file) in rows.iter().zip(["shipped:lens.csv", "half.csv"]) {
        assert_eq!((row[1], row[11]), (file, ""), "{text}");
        let found = home.run(&["fit", "lens", "--format=json", "--set", &format!("data.file={file}")]).out;
        let found: serde_json::Value = serde_json::from_str(&found).unwrap();
        let of = |key: &str, what: &str| {
            let all = found["parameters"].as_array().unwrap();
            all.iter().find(|parameter| parameter["key"] == key).unwrap()[what].as_f64().unwrap()
        };
        let number = |at: usize| row[at].parse::<f64>().unwrap();
        assert_eq!(number(2).to_bits(), of("material.effective_modulus", "value").to_bits());
        assert_eq!(number(3).to_bits(), of("material.effective_modulus", "standard_error").to_bits());
        assert_eq!(number(4).to_bits(), of("material.work_of_adhesion", "value").to_bits());
        assert_eq!(number(5).to_bits(), of("data.offset", "value").to_bits());
        assert_eq!(number(7).to_bits(), found["chi_squared"].as_f64().unwrap().to_bits());
        assert_eq!(number(8).to_bits(), found["outliers"].as_f64().unwrap().to_bits());
        assert!((number(2) / 1e6 - 1.0).abs() < 3e-3 && (number(4) / 0.05 - 1.0).abs() < 5e-3);
        // R is not free.
        assert_eq!(row[6], "");
    }
    // Values that the points do not determine are not given.
    assert!(rows[2][2..10].iter().all(|cell| cell.is_empty()), "{text}");
    assert!(rows[2][11].trim_matches('"').starts_with("no fit: "), "{text}");
    assert!(rows[3][11].contains("refused value: data.file"), "{text}");
}

#[test]
fn fits_run_in_shards_and_are_gone_on_with() {
    let home = with_files();
    done(&home, &["sweep", "s.toml", "-o", "whole.csv"]);
    let whole = home.text("whole.csv");
    for shard in ["1/2", "2/2"] {
        let part = format!("part-{}.csv", &shard[..1]);
        done(&home, &["sweep", "s.toml", "-o", &part, "--shard", shard]);
    }
    done(&home, &["sweep", "merge", "part-1.csv", "part-2.csv", "-o", "merged.csv"]);
    assert_eq!(home.text("merged.csv"), whole);
    // Torn in its third row.
    let torn = whole.match_indices('\n').nth(2).unwrap().0 + 8;
    fs::write(home.path("whole.csv"), &whole[..torn]).unwrap();
    done(&home, &["sweep", "s.toml", "-o", "whole.csv"]);
    assert_eq!(home.text("whole.csv"), whole);
    // Another file of the same name is another sweep.
    let half = home.text("half.csv");
    home.file("half.csv", half.trim_end().rsplit_once('\n').unwrap().0);
    home.refused(&["sweep", "s.toml", "-o", "whole.csv"], &["other measured data"]);
    assert_eq!(home.text("whole.csv"), whole);
}
