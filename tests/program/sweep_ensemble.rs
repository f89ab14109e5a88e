//! Ensembles from the command line: members, their statistics, continuing, shards, figures.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::{Ended, Home};
use pulloff::store::Store;
use pulloff::sweep::{SweepResults, spec};
use pulloff_engine::preset::Value;
use pulloff_engine::progress::Unwatched;
use pulloff_engine::sweep::measure::measure;
use rustix::process::{Pid, Signal, kill_process};
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// Few waves and small contacts, so that a member costs little.
const SPEC: &str = r#"
preset = "random-waves"
set = ["gap.count=6", "path.start_contact_radius=0.45", "gap.rms=0.0003"]
quantities = ["enhancement", "snaps", "kesari_lew", "guduru"]
[ensemble]
members = 12
seed = 7
[[axis]]
key = "material.work_of_adhesion"
values = [0.003, 0.004, 0.006]
"#;

fn with_spec(text: &str) -> Home {
    let home = Home::new();
    home.file("s.toml", text);
    home
}

fn done(home: &Home, arguments: &[&str]) -> String {
    let Ended { status, out, err } = home.run(arguments);
    assert_eq!((status, out.as_str()), (0, ""), "{arguments:?}: {err}");
    err
}

/// A column of numbers; an empty cell gives NaN.
fn numbers(home: &Home, results: &str, name: &str) -> Vec<f64> {
    let all = SweepResults::open(&home.path(results)).unwrap().numbers(&[name]).unwrap();
    all[0].iter().map(|x| x.unwrap_or(f64::NAN)).collect()
}

/// The four files of an ensemble.
fn files(home: &Home, stem: &str) -> [String; 4] {
    ["csv", "csv.spec.toml", "members.csv", "members.csv.spec.toml"]
        .map(|ending| home.text(&format!("{stem}.{ending}")))
}

#[test]
fn statistics_are_those_of_a_plain_loop_over_the_surfaces() {
    let home = with_spec(SPEC);
    let said = done(&home, &["sweep", "s.toml", "-o", "r.csv", "--jobs", "2"]);
    assert!(said.starts_with("pulloff: 36 of 36 rows in r.members.csv; "), "{said}");
    let loaded = spec::load(&Store::at(home.path("presets"), &[]), &home.path("s.toml"), &[]).unwrap().spec;
    let seeds: Vec<u64> = (0..36).map(|row| loaded.values(row)[1].to_string().parse().unwrap()).collect();
    // A member is the same surface at every point, and no two members are the same.
    assert!(seeds.chunks(3).all(|same| same.iter().all(|seed| *seed == same[0])));
    let mut apart = seeds.clone();
    apart.dedup();
    assert_eq!(apart.len(), 12);
    for (point, adhesion) in [0.003, 0.004, 0.006].into_iter().enumerate() {
        let mut found = Vec::new();
        for seed in &apart {
            let mut preset = loaded.preset.clone();
            preset.set("material.work_of_adhesion", adhesion.into()).unwrap();
            preset.set("gap.seed", Value::Integer(i64::try_from(*seed).unwrap())).unwrap();
            let cells = measure(&preset, &loaded.columns, &Unwatched).unwrap().cells;
            let cells: Vec<f64> =
                cells.iter().map(|cell| cell.unwrap().to_string().parse().unwrap()).collect();
            // No phases give more than the worst ones.
            assert!(cells[0] <= cells[3] * (1.0 + 1e-9), "{cells:?}");
            found.push(cells[0]);
        }
        let mean = found.iter().sum::<f64>() / 12.0;
        let deviation = (found.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 11.0).sqrt();
        found.sort_by(f64::total_cmp);
        let close = |name: &str, expected: f64, share: f64| {
            let ours = numbers(&home, "r.csv", &format!("enhancement.{name}"))[point];
            assert!((ours - expected).abs() <= share * expected, "{name}: {ours} {expected}");
        };
        close("mean", mean, 1e-14);
        close("sd", deviation, 1e-12);
        close("q50", 0.5 * (found[5] + found[6]), 1e-14);
        close("mean.error", deviation * (11.0_f64).sqrt() / 12.0, 0.1);
        close("count", 12.0, 0.0);
    }
    assert_eq!(numbers(&home, "r.csv", "members"), [12.0; 3]);
    assert_eq!(numbers(&home, "r.csv", "refused"), [0.0; 3]);
    // Any number of threads; nothing is computed again.
    let whole = files(&home, "r");
    done(&home, &["sweep", "s.toml", "-o", "one.csv", "--jobs", "1"]);
    assert_eq!(files(&home, "one"), whole);
    assert!(done(&home, &["sweep", "s.toml", "-o", "r.csv"]).contains("(36 from before)"));
    assert_eq!(files(&home, "r"), whole);
    for (file, rows) in [("r.csv", "3 of 3 rows"), ("r.members.csv", "36 of 36 rows")] {
        let Ended { status, out, err } = home.run(&["sweep", "check", file]);
        assert!(status == 0 && out.contains(rows), "{out} {err}");
    }
    // Statistics of members that are not all there, or are not theirs, are not complete.
    let all = home.text("r.members.csv");
    let fewer: String = all.split_inclusive('\n').take(20).collect();
    home.file("r.members.csv", &fewer);
    let Ended { out, err, .. } = home.run(&["sweep", "check", "r.csv"]);
    assert!(out.contains("19 of 36 rows"), "{out} {err}");
    home.file("r.members.csv", &all.replace(",0.", ",x."));
    assert_ne!(home.run(&["sweep", "check", "r.csv"]).status, 0);
    std::fs::remove_file(home.path("r.members.csv")).unwrap();
    let Ended { status, err, .. } = home.run(&["sweep", "check", "r.csv"]);
    assert!(status != 0 && err.contains("r.members.csv"), "{err}");
}

#[test]
fn what_was_killed_goes_on_to_the_byte() {
    let home = with_spec(&SPEC.replace("members = 12", "members = 300"));
    for signal in [Signal::KILL, Signal::TERM] {
        let before = rows(&home.path("r.members.csv"));
        let mut command = home.command(&["sweep", "s.toml", "-o", "r.csv"]);
        let mut child = command.stderr(Stdio::null()).spawn().unwrap();
        let deadline = Instant::now() + Duration::from_secs(120);
        while rows(&home.path("r.members.csv")) <= before + 20 {
            assert!(Instant::now() < deadline && child.try_wait().unwrap().is_none(), "no rows");
            std::thread::sleep(Duration::from_millis(5));
        }
        kill_process(Pid::from_child(&child), signal).unwrap();
        child.wait().unwrap();
    }
    // Told to stop, it says how much is there, and of how much.
    assert!(home.text("r.csv").contains("incomplete: "), "{}", home.text("r.csv"));
    assert!(numbers(&home, "r.csv", "members")[0] < 300.0);
    done(&home, &["sweep", "s.toml", "-o", "r.csv"]);
    done(&home, &["sweep", "s.toml", "-o", "whole.csv"]);
    assert!(files(&home, "r") == files(&home, "whole"));
}

fn rows(path: &Path) -> usize {
    std::fs::read_to_string(path).map_or(0, |text| text.lines().count())
}

#[test]
fn shards_join_to_the_single_run() {
    let home = with_spec(SPEC);
    done(&home, &["sweep", "s.toml", "-o", "whole.csv"]);
    for part in ["1", "2"] {
        done(&home, &["sweep", "s.toml", "-o", &format!("{part}.csv"), "--shard", &format!("{part}/2")]);
        assert!(!home.path(&format!("{part}.csv")).exists(), "a part says nothing of the whole");
    }
    // By the given names, or by those of the files.
    done(&home, &["sweep", "merge", "2.csv", "1.members.csv", "-o", "all.csv"]);
    assert_eq!(files(&home, "all"), files(&home, "whole"));
    home.refused(&["sweep", "merge", "1.csv", "2.csv", "-o", "all.csv"], &["all.csv: already exists"]);
    home.refused(&["sweep", "merge", "1.csv", "2.csv", "-o", "-"], &["an ensemble writes two files"]);
    home.refused(&["sweep", "s.toml", "-o", "-"], &["an ensemble writes two files"]);
}

#[test]
fn members_with_an_error_are_counted_and_left_out() {
    // What the members draw need not be a surface; half of these ends lie outside the start.
    let home = with_spec(
        "preset = \"wavy-sphere\"\nset = [\"path.start_contact_radius=0.3\"]\nquantities = [\"least_force\"]\n\
         ensemble = { members = 20, seed = 3 }\n\
         [[axis]]\nkey = \"path.end_contact_radius\"\ndistribution = { uniform = [0.1, 0.5] }\n",
    );
    let said = done(&home, &["sweep", "s.toml", "-o", "r.csv"]);
    let members = numbers(&home, "r.members.csv", "least_force");
    let refused = members.iter().filter(|x| x.is_nan()).count();
    assert!((3..18).contains(&refused) && said.contains(&format!("{refused} with an error")), "{said}");
    let count = 20 - refused;
    let mean = members.iter().filter(|x| x.is_finite()).sum::<f64>() / count as f64;
    assert!((numbers(&home, "r.csv", "least_force.mean")[0] / mean - 1.0).abs() < 1e-14);
    assert_eq!(numbers(&home, "r.csv", "least_force.count"), [count as f64]);
    assert_eq!(numbers(&home, "r.csv", "refused"), [refused as f64]);
    let error = SweepResults::open(&home.path("r.csv")).unwrap().texts(&["error"]).unwrap().remove(0);
    assert_eq!(error, [format!("members: {refused} of 20 with an error ({refused} refused value)")]);
    home.refused(&["plot", "--sweep", "r.csv", "-o", "x.svg"], &["without an axis"]);
}

#[test]
fn results_of_something_else_are_not_touched() {
    let home = with_spec(SPEC);
    home.file("r.csv", "mine\n");
    home.refused(
        &["sweep", "s.toml", "-o", "r.csv"],
        &["r.csv: already exists, and is not known to belong to a sweep"],
    );
    assert!(home.text("r.csv") == "mine\n" && !home.path("r.members.csv").exists());
    done(&home, &["sweep", "s.toml", "-o", "r.csv", "--overwrite"]);
    home.file("t.toml", &SPEC.replace("seed = 7", "seed = 8"));
    home.refused(&["sweep", "t.toml", "-o", "r.csv"], &["another sweep: other rows of the same axes"]);
}

#[test]
fn a_figure_has_the_median_and_where_the_members_are() {
    let home = with_spec(SPEC);
    done(&home, &["sweep", "s.toml", "-o", "r.csv"]);
    done(&home, &["plot", "--sweep", "r.csv", "-o", "x.svg", "--data"]);
    let svg = home.text("x.svg");
    assert!(svg.contains("5-95 % of the members") && svg.contains("25-75 % of the members"), "{svg}");
    assert!(svg.contains("enhancement"), "{svg}");
    let data = home.text("x.csv");
    let column = |name: &str| -> Vec<f64> {
        let of = data.lines().filter(|line| line.starts_with(&format!("{name},")));
        of.map(|line| line.rsplit(',').next().unwrap().parse().unwrap()).collect()
    };
    let of = |name: &str| numbers(&home, "r.csv", &format!("enhancement.{name}"));
    assert_eq!(column("median"), of("q50"));
    let [low, mut high] = [of("q25"), of("q75")];
    high.reverse();
    assert_eq!(column("25-75 % of the members"), [low, high].concat());
    // Any statistic is a column of its own.
    done(&home, &["plot", "--sweep", "r.csv", "--quantity", "snaps.mean", "-o", "y.svg"]);
    assert!(home.text("y.svg").contains("mean of snaps"));
}
