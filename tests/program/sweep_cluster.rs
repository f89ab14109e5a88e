//! Unattended sweeps: a status file, rows that take too long, results checked later.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::{Ended, Home};
use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Stdio};

const SPEC: &str = "preset = \"wavy-sphere\"\nset = [\"path.start_contact_radius=0.3\"]\nquantities = [\"snaps\", \"least_force\"]\n\
                    [[axis]]\nkey = \"gap.amplitude\"\nlinear = { from = 1e-4, to = 2e-3, count = 12 }\n";

fn with_spec() -> Home {
    let home = Home::new();
    fs::write(home.path("s.toml"), SPEC).unwrap();
    home
}

fn said(home: &Home, arguments: &[&str], status: i32) -> (String, String) {
    let Ended { status: found, out, err } = home.run(arguments);
    assert_eq!(found, status, "{arguments:?}: {out} {err}");
    (out, err)
}

#[test]
fn the_status_says_how_far_it_is_and_spares_the_files_of_the_sweep() {
    let home = with_spec();
    said(&home, &["sweep", "s.toml", "-o", "r.csv", "--shard", "2/3", "--status", "state.json"], 0);
    let text = fs::read_to_string(home.path("state.json")).unwrap();
    let status: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(status["state"], "complete", "{text}");
    assert_eq!((&status["rows"], &status["of"], &status["shard"]), (&4.into(), &4.into(), &"2/3".into()));
    assert_eq!((&status["before"], &status["with_error"]), (&0.into(), &0.into()));
    // When it is run again there is nothing to do, and the file says so.
    said(&home, &["sweep", "s.toml", "-o", "r.csv", "--shard", "2/3", "--status", "state.json"], 0);
    let text = fs::read_to_string(home.path("state.json")).unwrap();
    let status: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&status["before"], &status["state"]), (&4.into(), &"complete".into()));
    for file in ["s.toml", "r.csv", "r.csv.spec.toml"] {
        let before = fs::read(home.path(file)).unwrap();
        let again = ["sweep", "s.toml", "-o", "r.csv", "--shard", "2/3", "--status", file];
        let (_, err) = said(&home, &again, 2);
        assert!(err.contains(file), "{err}");
        assert_eq!(fs::read(home.path(file)).unwrap(), before);
    }
}

#[test]
fn a_row_that_takes_too_long_has_an_error_that_says_so() {
    let home = with_spec();
    let (_, err) = said(&home, &["sweep", "s.toml", "-o", "r.csv", "--row-limit", "0.001ms"], 1);
    assert!(err.contains("every row failed"), "{err}");
    assert!(err.contains("12 row limit"), "{err}");
    let rows = fs::read_to_string(home.path("r.csv")).unwrap();
    assert_eq!(
        rows.lines().filter(|row| row.contains("row limit: it took longer than")).count(),
        12,
        "{rows}"
    );
    let (out, _) = said(&home, &["sweep", "check", "r.csv"], 1);
    assert!(out.contains("12 of 12 rows, complete") && out.contains("12 row limit"), "{out}");
    for wrong in ["0s", "-1s", "10 parsecs", "nan", "1e40h"] {
        let (_, err) = said(&home, &["sweep", "s.toml", "-o", "x.csv", &format!("--row-limit={wrong}")], 2);
        assert!(err.contains("is not a time above 0, such as 10s"), "{wrong}: {err}");
    }
    // A limit that no row reaches changes nothing.
    said(&home, &["sweep", "s.toml", "-o", "a.csv"], 0);
    said(&home, &["sweep", "s.toml", "-o", "b.csv", "--row-limit", "2h"], 0);
    assert_eq!(fs::read(home.path("a.csv")).unwrap(), fs::read(home.path("b.csv")).unwrap());
}

#[test]
fn results_are_looked_at_without_computing() {
    let home = with_spec();
    said(&home, &["sweep", "s.toml", "-o", "r.csv"], 0);
    let (out, _) = said(&home, &["sweep", "check", "r.csv"], 0);
    assert!(out.contains("r.csv: 12 of 12 rows, complete"), "{out}");
    assert!(out.contains("columns  row, gap.amplitude, snaps, least_force, error"), "{out}");
    assert!(out.contains("errors   none"), "{out}");
    let whole = fs::read_to_string(home.path("r.csv")).unwrap();
    let beside = fs::read_to_string(home.path("r.csv.spec.toml")).unwrap();
    assert!(out.contains(beside.split('"').nth(1).unwrap()), "{out}");
    // Torn in the middle of a line.
    fs::write(home.path("r.csv"), &whole[..whole.len() - 3]).unwrap();
    let (out, _) = said(&home, &["sweep", "check", "r.csv"], 1);
    assert!(out.contains("11 of 12 rows, the same command goes on") && out.contains("torn"), "{out}");
    assert_eq!(fs::read_to_string(home.path("r.csv")).unwrap().len(), whole.len() - 3);
    // A changed row, one row too many, a changed sweep, a file of unknown origin.
    fs::write(home.path("r.csv"), whole.replacen("\n3,", "\n4,", 1)).unwrap();
    assert!(said(&home, &["sweep", "check", "r.csv"], 2).1.contains("r.csv:5:"));
    let last = whole.lines().last().unwrap();
    fs::write(home.path("r.csv"), format!("{whole}{last}\n")).unwrap();
    assert!(said(&home, &["sweep", "check", "r.csv"], 2).1.contains("r.csv:14:"));
    fs::write(home.path("r.csv"), &whole).unwrap();
    fs::write(home.path("r.csv.spec.toml"), beside.replacen("0.3", "0.31", 1)).unwrap();
    assert!(said(&home, &["sweep", "check", "r.csv"], 2).1.contains("changed by hand"));
    fs::write(home.path("other.csv"), "a,b\n").unwrap();
    assert!(said(&home, &["sweep", "check", "other.csv"], 2).1.contains("other.csv"));
}

/// The script for Slurm, run as Slurm runs it.
fn slurm(home: &Home, variables: &[(&str, &str)], arguments: &[&str]) -> Ended {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/cluster/slurm.sh");
    let mut command = Command::new("bash");
    command.env_clear().env("HOME", home.folder()).env("XDG_CONFIG_HOME", home.path("config"));
    command.env("PATH", format!("{}:/usr/bin:/bin", home.path("bin").display()));
    command.env("PULLOFF", env!("CARGO_BIN_EXE_pulloff")).envs(variables.iter().copied());
    command.arg(script).args(arguments).current_dir(home.folder()).stdin(Stdio::null());
    Ended::of(command.output().unwrap())
}

#[test]
fn the_shards_of_a_job_array_are_those_of_the_sweep() {
    let home = with_spec();
    let arguments = ["s.toml", "my results.csv", "5"];
    // Whatever tasks the array has, task i is shard i of 5.
    let task = |number: &str, array: &[(&str, &str)]| {
        let variables = [&[("SLURM_JOB_ID", "7"), ("SLURM_ARRAY_TASK_ID", number)], array].concat();
        slurm(&home, &variables, &arguments)
    };
    for number in ["1", "2", "3", "4", "5"] {
        let ended = task(number, &[("SLURM_ARRAY_TASK_COUNT", "5"), ("SLURM_CPUS_PER_TASK", "2")]);
        assert_eq!(ended.status, 0, "{}", ended.err);
    }
    let part = "my results.csv.parts/3-of-5.csv";
    let third = home.text(part);
    // A subset of the array, where the parts exist and where one was lost.
    for lost in [false, true] {
        if lost {
            fs::remove_file(home.path(part)).unwrap();
        }
        for number in ["3", "5"] {
            let subset = [("SLURM_ARRAY_TASK_COUNT", "2"), ("SLURM_ARRAY_TASK_MAX", "5")];
            let ended = task(number, &subset);
            assert_eq!(ended.status, 0, "{}", ended.err);
        }
        assert_eq!(home.text(part), third);
    }
    // A task that is not a shard.
    for number in ["0", "6"] {
        let ended = task(number, &[]);
        assert!(ended.status == 2 && ended.err.contains("shards 1 to 5"), "{}", ended.err);
    }
    // A job without an array joins them.
    let ended = slurm(&home, &[("SLURM_JOB_ID", "8")], &arguments);
    assert_eq!(ended.status, 0, "{}", ended.err);
    said(&home, &["sweep", "s.toml", "-o", "whole.csv"], 0);
    assert_eq!(home.text("my results.csv"), home.text("whole.csv"));
    // Shards of another number beside them are other files, and a failure has the status of the program.
    let ended = slurm(&home, &[("SLURM_JOB_ID", "9")], &["s.toml", "joined.csv", "4"]);
    assert!(ended.status == 2 && ended.err.contains("1-of-4.csv"), "{}", ended.err);
    for wrong in ["0", "-1", "x", "", "1.5"] {
        let ended = slurm(&home, &[("SLURM_JOB_ID", "9")], &["s.toml", "x.csv", wrong]);
        assert!(ended.status == 2 && ended.err.contains("from 1 up"), "{wrong}: {}", ended.err);
    }
    assert_eq!(slurm(&home, &[], &["s.toml", "x.csv"]).status, 2);
}

#[test]
fn the_job_that_joins_waits_for_the_array() {
    let home = with_spec();
    // Records what Slurm would be told, and answers with a job number.
    home.file(
        "bin/sbatch",
        "#!/bin/sh\nprintf '%s|' \"$@\" >>calls\necho >>calls\necho \"$((40 + $(wc -l <calls)));cluster\"\n",
    );
    fs::set_permissions(home.path("bin/sbatch"), Permissions::from_mode(0o755)).unwrap();
    let ended = slurm(&home, &[], &["s.toml", "my results.csv", "5"]);
    assert_eq!(ended.status, 0, "{}", ended.err);
    assert_eq!(ended.out, "the shards are job 41, joined by job 42\n");
    let calls = home.text("calls");
    let (array, join) = calls.split_once('\n').unwrap();
    assert!(array.starts_with("--parsable|--array=1-5|") && array.ends_with("|s.toml|my results.csv|5|"));
    assert!(join.contains("|--dependency=afterok:41|") && !join.contains("--array"), "{join}");
    assert!(join.trim_end().ends_with("|s.toml|my results.csv|5|"), "{join}");
}
