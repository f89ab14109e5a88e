//! Sweeps from the command line: rows, faults, continuing, shards, refusals.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::{Ended, Home};
use pulloff::store::Store;
use pulloff::sweep::{SweepResults, spec};
use pulloff_engine::sweep::QUANTITIES;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use std::fs;
use std::io::{self, BufRead, BufReader};
use std::ops::Deref;
use std::path::Path;
use std::process::{Child, Output, Stdio};
use std::time::{Duration, Instant};

/// A home with its sweeps.
pub struct Sweeps(Home);

impl Deref for Sweeps {
    type Target = Home;

    fn deref(&self) -> &Home {
        &self.0
    }
}

impl Sweeps {
    pub fn new() -> Self {
        Self(Home::new())
    }

    /// Runs to the end: status, standard output, standard error.
    pub fn run(&self, arguments: &[&str]) -> (i32, String, String) {
        let Ended { status, out, err } = self.0.run(arguments);
        (status, out, err)
    }

    /// A sweep that succeeds; returns its messages.
    pub fn sweep(&self, spec: &str, results: &str, more: &[&str]) -> String {
        let (status, out, err) = self.run(&[&["sweep", spec, "-o", results], more].concat());
        assert_eq!((status, out.as_str()), (0, ""), "{err}");
        err
    }

    pub fn refused(&self, arguments: &[&str], said: &str) {
        self.0.refused(arguments, &[said]);
    }

    /// Columns of results as text.
    pub fn columns(&self, results: &str, names: &[&str]) -> Vec<Vec<String>> {
        SweepResults::open(&self.path(results)).unwrap().texts(names).unwrap()
    }

    pub fn numbers(&self, results: &str, name: &str) -> Vec<f64> {
        let all = SweepResults::open(&self.path(results)).unwrap().numbers(&[name]).unwrap();
        all[0].iter().map(|x| x.unwrap()).collect()
    }
}

/// Rows that cost little, because there are few waves.
const GRID: &str = r#"
preset = "wavy-sphere"
set = ["path.start_contact_radius=0.3", "gap.wavelength=0.1"]
quantities = ["last_contact_force", "snaps_force", "enhancement", "kesari_lew"]
[[axis]]
key = "gap.amplitude"
values = [0.001, "0.004/2"]
[[axis]]
key = "groups.adhesion"
logarithmic = { from = 0.01, to = 0.03, count = 5 }
"#;

/// Enough rows for a signal to arrive in the middle.
fn long(rows: u64) -> String {
    GRID.replace("count = 5", &format!("count = {}", rows / 2))
}

#[test]
fn a_grid_has_every_row_and_each_can_be_repeated() {
    let home = Sweeps::new();
    home.file("grid.toml", GRID);
    let said = home.sweep("grid.toml", "r.csv", &["--jobs", "2"]);
    assert!(
        said.starts_with("pulloff: 10 of 10 rows in r.csv; ") && said.contains("pulloff plot --sweep"),
        "{said}"
    );
    assert!(!said.contains('\u{1b}'), "no progress where there is no terminal: {said}");
    let text = home.text("r.csv");
    assert!(text.starts_with(
        "row,gap.amplitude,groups.adhesion,last_contact_force,snaps_force,enhancement,kesari_lew,error\n0,0.001,0.01,"
    ));
    // The last axis varies fastest, and its ends are exactly as typed.
    let all = home.columns("r.csv", &["row", "gap.amplitude", "groups.adhesion", "error"]);
    let rows: Vec<String> = (0..10).map(|row| row.to_string()).collect();
    assert_eq!(all[0], rows);
    assert_eq!((&*all[1][4], &*all[1][5], &*all[2][4], &*all[2][5]), ("0.001", "0.002", "0.03", "0.01"));
    assert!(all[3].iter().all(String::is_empty));
    // The values of a row reproduce its problem, to the bit.
    let sets = [1, 2]
        .map(|column| format!("{}={}", ["", "gap.amplitude", "groups.adhesion"][column], all[column][7]));
    let (_, out, _) = home.run(&[
        "unload",
        "wavy-sphere",
        "--set=path.start_contact_radius=0.3",
        "--set=gap.wavelength=0.1",
        &format!("--set={}", sets[0]),
        &format!("--set={}", sets[1]),
        "--format=json",
    ]);
    let report: serde_json::Value = serde_json::from_str(&out).unwrap();
    let last = report["events"].as_array().unwrap().last().unwrap();
    assert_eq!(
        last["before"]["force"].as_f64().unwrap().to_bits(),
        home.numbers("r.csv", "last_contact_force")[7].to_bits()
    );
    // Any number of threads.
    home.sweep("grid.toml", "one.csv", &["--jobs", "1"]);
    assert_eq!(home.text("one.csv"), text);
    assert_eq!(home.text("one.csv.spec.toml"), home.text("r.csv.spec.toml"));
}

#[test]
fn paths_of_one_disc_are_said_not_to_be_checked_unless_a_quantity_does() {
    let home = Sweeps::new();
    for (set, quantities, is_told) in [
        ("path.contact=one-disc", "'largest_pull'", true),
        ("path.contact=one-disc", "'largest_pull','inadmissible_share'", false),
        ("basis.kind=rings", "'snaps'", true),
        ("basis.kind=rings", "'critical_force'", false),
        ("path.contact=rings", "'largest_pull'", false),
    ] {
        let spec = format!(
            "preset='wavy-sphere'\nset=['{set}','path.start_contact_radius=0.3']\nquantities=[{quantities}]\n\
             [[axis]]\nkey='A'\nvalues=[0.002]"
        );
        home.file("s.toml", &spec);
        let said = home.sweep("s.toml", "r.csv", &["--overwrite"]);
        assert_eq!(said.contains("inadmissible states of it are not looked for"), is_told, "{spec}: {said}");
    }
}

#[test]
fn pairs_go_together_and_units_are_read() {
    let home = Sweeps::new();
    home.file(
        "pairs.toml",
        r#"
preset = "fig-9-si"
set = ["basis.kind=exact", "path.start_contact_radius=1 mm"]
combine = "pairs"
quantities = ["critical_force", "start_contact_radius", "snap_loss_displacement", "inadmissible_share_force"]
[[axis]]
key = "gap.amplitude"
values = ["10 um", 1.2e-5, "0.01 mm"]
[[axis]]
key = "path.control"
values = ["displacement", "stiffness=5 N/m", "force"]
"#,
    );
    let said = home.sweep("pairs.toml", "r.csv", &[]);
    assert!(!said.contains("to plot it"), "pairs are no map: {said}");
    let all =
        home.columns("r.csv", &["gap.amplitude", "path.control", "start_contact_radius", "critical_force"]);
    assert_eq!(all[0], ["1e-5", "1.2e-5", "1e-5"]);
    assert_eq!(all[1], ["displacement", "stiffness=5", "force"]);
    assert_eq!(all[2], ["0.001"; 3]);
    let force: f64 = all[3][0].parse().unwrap();
    assert!((force / (1.5 * std::f64::consts::PI * 0.795_774_715_459_476_8 * 5e-3) - 1.0).abs() < 1e-12);
    let loss = home.numbers("r.csv", "snap_loss_displacement");
    assert!(loss[0] > 0.0 && loss[0].to_bits() == loss[2].to_bits());
    assert!(home.numbers("r.csv", "inadmissible_share_force").iter().all(|share| (0.0..1.0).contains(share)));
    let results = SweepResults::open(&home.path("r.csv")).unwrap();
    let units: Vec<Option<&str>> = results.columns.iter().map(|column| column.unit.as_deref()).collect();
    assert_eq!(units, [None, Some("m"), None, Some("N"), Some("m"), Some("J"), None, None]);
    let message = results.numbers(&["gap.amplitud"]).unwrap_err().to_string();
    assert!(message.ends_with("has no column \"gap.amplitud\"; did you mean gap.amplitude?"), "{message}");
    assert!(results.numbers(&["path.control"]).is_err());
}

const RANDOM: &str = r#"
preset = "random-waves"
set = ["path.start_contact_radius=0.45"]
quantities = ["least_force", "limit_points"]
[random]
draws = 12
seed = 7
[[axis]]
key = "gap.seed"
distribution = { integers = [1, 1000] }
[[axis]]
key = "gap.rms"
distribution = { log-uniform = [1e-5, "1/1000"] }
[[axis]]
key = "material.work_of_adhesion"
distribution = { normal = { mean = 0.01, deviation = 0.001 } }
[[axis]]
key = "gap.hurst"
distribution = { uniform = [0.2, 0.9] }
"#;

#[test]
fn random_rows_follow_from_seed_and_number() {
    let home = Sweeps::new();
    home.file("a.toml", RANDOM);
    home.file("b.toml", &RANDOM.replace("seed = 7\n[[", "seed = 8\n[["));
    home.sweep("a.toml", "a.csv", &[]);
    home.sweep("b.toml", "b.csv", &[]);
    let names = ["gap.seed", "gap.rms", "material.work_of_adhesion", "gap.hurst"];
    let (a, b) = (home.columns("a.csv", &names), home.columns("b.csv", &names));
    for (a, b) in a.iter().zip(&b) {
        assert!(a.iter().zip(b).all(|(a, b)| a != b));
        assert!((1..12).all(|row| a[row] != a[0]));
    }
    for (name, range) in [("gap.seed", 1.0..1001.0), ("gap.rms", 1e-5..1e-3), ("gap.hurst", 0.2..0.9)] {
        assert!(home.numbers("a.csv", name).iter().all(|x| range.contains(x)));
    }
    assert!(home.numbers("a.csv", "least_force").iter().all(|force| *force < 0.0));
    // A shard draws the same as the whole sweep.
    home.sweep("a.toml", "part.csv", &["--shard", "3/5"]);
    let whole = home.text("a.csv");
    let rows: Vec<&str> = whole.lines().collect();
    assert_eq!(home.text("part.csv").lines().collect::<Vec<_>>(), [rows[0], rows[3], rows[8]]);
    // Many draws have the requested mean and spread.
    let store = Store::at(home.path("presets"), &[]);
    let many = RANDOM.replace("draws = 12", "draws = 20000");
    let spec = spec::read(&store, home.folder(), "many", &many).unwrap();
    let draws: Vec<f64> =
        (0..20000).map(|row| spec.values(row)[2].to_string().parse::<f64>().unwrap()).collect();
    let mean = draws.iter().sum::<f64>() / 2e4;
    let spread = (draws.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 2e4).sqrt();
    assert!((mean - 0.01).abs() < 5e-5 && (spread - 0.001).abs() < 5e-5, "{mean} {spread}");
}

#[test]
fn a_row_that_fails_says_why_and_stops_nothing() {
    let home = Sweeps::new();
    home.file(
        "s.toml",
        r#"
preset = "wavy-sphere"
set = ["gap.wavelength=0.1", "basis.kind=rings"]
quantities = ["kesari_lew", "enhancement", "snaps"]
combine = "pairs"
[[axis]]
key = "path.start_contact_radius"
values = [0.3, 0.002, 0.1, 0.3]
[[axis]]
key = "basis.rings"
values = [200, 200, 200, 60]
"#,
    );
    let said = home.sweep("s.toml", "r.csv", &[]);
    assert!(
        said.contains("2 with an error (1 refused value, 1 small start): the column error says why"),
        "{said}"
    );
    let all = home.columns("r.csv", &["kesari_lew", "enhancement", "snaps", "error"]);
    assert_eq!((&*all[0][1], &*all[1][1], &*all[3][0]), ("", "", ""));
    assert_eq!(
        all[3][1],
        "refused value: path.end_contact_radius = 0.002 is not below path.start_contact_radius = 0.002"
    );
    // Quantities that do not follow from the start are there all the same.
    assert_eq!(all[0][2], all[0][0]);
    assert!(all[3][2].starts_with("small start: ") && all[1][2].is_empty() && !all[2][2].is_empty());
    // A rerun knows the faults of the existing rows.
    let again = home.sweep("s.toml", "r.csv", &[]);
    assert!(
        again.starts_with(
            "pulloff: 4 of 4 rows in r.csv (4 from before)\npulloff: warning: 2 with an error (1 ref"
        ),
        "{again}"
    );
}

/// A control names a spring with its stiffness, so that an axis of its own would win; numbers that another shape
/// brings are named.
#[test]
fn axes_that_give_one_value_are_refused_and_numbers_of_another_shape_are_told() {
    let home = Sweeps::new();
    let axes = [
        "key = 'path.control'\nvalues = ['force', 'stiffness=5']",
        "key = 'path.control.stiffness'\nvalues = [0.1, 1]",
    ];
    for order in [[0, 1], [1, 0]] {
        let [one, other] = order.map(|i| format!("[[axis]]\n{}\n", axes[i]));
        home.file("s.toml", &format!("preset = 'wavy-sphere'\nquantities = ['snaps']\n{one}{other}"));
        home.refused(&["sweep", "s.toml", "-o", "r.csv"], "conflicts with the axis path.control");
    }
    let axis = "[[axis]]\nkey = 'gap.shape'\nvalues = ['sphere', 'cone']\n";
    home.file("s.toml", &format!("preset = 'wavy-sphere'\nquantities = ['last_contact_force']\n{axis}"));
    let said = home.sweep("s.toml", "shapes.csv", &[]);
    assert!(
        said.contains("numbers that nobody gave, which another shape or law brings: gap.slope = 0.1"),
        "{said}"
    );
    let force = home.numbers("shapes.csv", "last_contact_force")[1];
    let sets = ["--set", "gap.shape=cone", "--set", "gap.slope=0.1"];
    let ended = home.0.run(&[&["unload", "wavy-sphere", "--format", "json"], &sets[..]].concat());
    let cone: Value = serde_json::from_str(&ended.out).unwrap();
    let events = cone["events"].as_array().unwrap();
    let last = events.last().unwrap()["before"]["force"].as_f64().unwrap();
    assert_eq!(force.to_bits(), last.to_bits());
}

#[test]
fn a_sweep_goes_on_from_any_byte() {
    let home = Sweeps::new();
    home.file("s.toml", GRID);
    home.sweep("s.toml", "whole.csv", &[]);
    let whole = home.text("whole.csv");
    // Torn within the header, at its end, in the middle of a number, before and after a line end, at the end.
    let first = whole.find('\n').unwrap();
    let last = whole.trim_end().rfind('\n').unwrap();
    for cut in
        [0, 1, first, first + 1, first + 2, whole.len() / 2, last, last + 1, whole.len() - 1, whole.len()]
    {
        fs::copy(home.path("whole.csv.spec.toml"), home.path("cut.csv.spec.toml")).unwrap();
        fs::write(home.path("cut.csv"), &whole[..cut]).unwrap();
        home.sweep("s.toml", "cut.csv", &[]);
        assert_eq!(home.text("cut.csv"), whole, "cut at {cut}");
    }
}

/// Waits until the results have this many rows.
fn wait_for_rows(child: &mut Child, results: &Path, rows: usize) {
    let deadline = Instant::now() + Duration::from_secs(120);
    while fs::read_to_string(results).map_or(0, |text| text.lines().count()) <= rows {
        assert!(Instant::now() < deadline, "no rows");
        assert!(child.try_wait().unwrap().is_none(), "it ended too early");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn signals_keep_what_is_done() {
    let home = Sweeps::new();
    home.file("s.toml", &long(6000));
    let ended = |results: &str, signal: Signal| {
        // Wait for rows of its own, because by then it catches signals.
        let before = fs::read_to_string(home.path(results)).map_or(0, |text| text.lines().count());
        let mut child =
            home.command(&["sweep", "s.toml", "-o", results]).stderr(Stdio::piped()).spawn().unwrap();
        wait_for_rows(&mut child, &home.path(results), before + 20);
        kill_process(Pid::from_child(&child), signal).unwrap();
        let Output { status, stderr, .. } = child.wait_with_output().unwrap();
        (status.code(), String::from_utf8(stderr).unwrap())
    };
    // A killed program cannot say anything.
    assert_eq!(ended("r.csv", Signal::KILL).0, None);
    for (signal, status) in [(Signal::TERM, 143), (Signal::INT, 130)] {
        let before = home.text("r.csv").lines().count();
        let (code, said) = ended("r.csv", signal);
        assert_eq!(code, Some(status), "{said}");
        assert!(said.contains("of 6000 rows, all kept; the same command goes on from there"), "{said}");
        let text = home.text("r.csv");
        assert!(text.ends_with('\n') && text.lines().count() >= before);
    }
    let said = home.sweep("s.toml", "r.csv", &[]);
    assert!(said.contains("6000 of 6000 rows in r.csv (") && said.contains(" from before)"), "{said}");
    home.sweep("s.toml", "whole.csv", &[]);
    assert!(home.text("r.csv") == home.text("whole.csv"));
}

#[test]
fn two_at_once_do_not_write_one_file() {
    let home = Sweeps::new();
    home.file("s.toml", &long(3000));
    let mut child = home.command(&["sweep", "s.toml", "-o", "r.csv"]).stderr(Stdio::null()).spawn().unwrap();
    wait_for_rows(&mut child, &home.path("r.csv"), 2);
    home.refused(&["sweep", "s.toml", "-o", "r.csv"], "pulloff: r.csv: another pulloff is writing it");
    // The waiting one continues from where the other was ended.
    let mut waiting = home.command(&["sweep", "s.toml", "-o", "r.csv", "--wait"]);
    let mut waiting = waiting.stderr(Stdio::piped()).spawn().unwrap();
    let mut said = BufReader::new(waiting.stderr.take().unwrap());
    let mut line = String::new();
    said.read_line(&mut line).unwrap();
    assert_eq!(line, "pulloff: r.csv: another pulloff is writing it; waiting for it to end\n");
    child.kill().unwrap();
    child.wait().unwrap();
    line.clear();
    said.read_line(&mut line).unwrap();
    assert!(
        line.starts_with("pulloff: 3000 of 3000 rows in r.csv (") && line.contains(" from before)"),
        "{line}"
    );
    // Read to its end, so that the program can write everything.
    io::copy(&mut said, &mut io::sink()).unwrap();
    assert!(waiting.wait().unwrap().success());
}

#[test]
fn shards_join_to_the_single_run() {
    let home = Sweeps::new();
    home.file("s.toml", GRID);
    home.sweep("s.toml", "whole.csv", &[]);
    let parts = ["1.csv", "2.csv", "3.csv"];
    for (number, part) in parts.iter().enumerate() {
        home.sweep("s.toml", part, &["--shard", &format!("{}/3", number + 1)]);
    }
    let (status, _, said) = home.run(&["sweep", "merge", "2.csv", "3.csv", "1.csv", "-o", "all.csv"]);
    assert_eq!((status, &*said), (0, "pulloff: 10 rows of 3 shards in all.csv\n"));
    assert_eq!(home.text("all.csv"), home.text("whole.csv"));
    assert_eq!(home.text("all.csv.spec.toml"), home.text("whole.csv.spec.toml"));
    // The result is that of a single run, so it can be continued.
    assert!(home.sweep("s.toml", "all.csv", &[]).contains("(10 from before)"));
    home.refused(
        &["sweep", "merge", "1.csv", "2.csv", "3.csv", "-o", "all.csv"],
        "all.csv: already exists; --overwrite replaces it",
    );

    let merge = |parts: &[&'static str]| [&["sweep", "merge"], parts, &["-o", "no.csv"]].concat();
    home.refused(&merge(&["1.csv", "3.csv"]), "shards are missing: 2/3");
    home.refused(&merge(&["1.csv", "3.csv", "2.csv", "3.csv"]), "3.csv: is shard 3/3, as is 3.csv");
    home.refused(&merge(&["1.csv", "none.csv"]), "none.csv: is not known to be a part of a sweep");
    home.refused(&["sweep", "s.toml", "-o", "1.csv", "--shard", "2/3"], "1.csv: holds shard 1/3, not 2/3");
    home.sweep("s.toml", "half.csv", &["--shard", "1/2"]);
    home.refused(&merge(&["1.csv", "half.csv"]), "half.csv: is shard 1/2, while 1.csv is one of 3");
    home.file("t.toml", &GRID.replace("0.001,", "0.0011,"));
    home.sweep("t.toml", "other.csv", &["--shard", "2/3"]);
    home.refused(
        &merge(&["1.csv", "other.csv", "3.csv"]),
        "other.csv: belongs to a different sweep from 1.csv",
    );
    // A part with a changed row, and one that was stopped.
    let text = home.text("2.csv");
    let row = text.lines().nth(2).unwrap();
    let with = |at: usize, cell: &str| {
        let mut cells: Vec<&str> = row.split(',').collect();
        cells[at] = cell;
        cells.join(",")
    };
    for (changed, wrong) in [
        (row.replacen(",0.001,", ",0.0011,", 1), "row 4: column gap.amplitude is 0.0011, expected 0.001"),
        (row.replacen("4,", "7,", 1), "row 4: column row is 7, expected 4"),
        (row.replacen(",0.001,", ",\"0.001\",", 1), "row 4: is not written as a sweep writes it"),
        (row.split_once(',').unwrap().0.to_owned(), "row 4: column gap.amplitude is empty, expected 0.001"),
        (row.replacen(",0.001,0.03,", ",0.001,0.03,x", 1), "row 4: column last_contact_force is x-"),
        (with(3, "nan"), "row 4: column last_contact_force is nan, expected a finite number or nothing"),
        (with(3, "1e999"), "row 4: column last_contact_force is 1e999, expected a finite number or nothing"),
        (with(4, "7.5"), "row 4: column snaps_force is 7.5, expected a whole number"),
        (
            with(4, ""),
            "row 4: column snaps_force is empty, expected a whole number, or nothing in a row with an error",
        ),
        (format!("{row}why"), "row 4: column error is why, expected a fault or nothing"),
        (format!("{row},"), "row 4: has 9 fields, expected 8"),
    ] {
        assert_ne!(changed, row, "{wrong}");
        home.file("2.csv", &text.replace(row, &changed));
        home.refused(&merge(&["1.csv", "2.csv", "3.csv"]), &format!("2.csv:3: {wrong}"));
        // Continuing finds the same fault.
        home.refused(&["sweep", "s.toml", "-o", "2.csv", "--shard", "2/3"], &format!("2.csv:3: {wrong}"));
    }
    home.file("2.csv", &text.replace("gap.amplitude", "gap.wavelength"));
    home.refused(&merge(&["1.csv", "2.csv", "3.csv"]), "2.csv:1: the columns are not row, gap.amplitude, ");
    home.file("2.csv", &format!("{text}{row}\n"));
    home.refused(&merge(&["1.csv", "2.csv", "3.csv"]), "2.csv:5: there are more lines than rows");
    home.file("2.csv", &text[..text.len() - 3]);
    home.refused(
        &merge(&["1.csv", "2.csv", "3.csv"]),
        "2.csv: has 2 of the 3 rows of shard 2/3; run it again to go on",
    );
    assert!(!home.path("no.csv").exists() && !home.path("no.csv.spec.toml").exists());
}

#[test]
fn shards_of_every_kind_of_axis_join() {
    let home = Sweeps::new();
    let head = "preset = \"wavy-sphere\"\nset = [\"path.start_contact_radius=0.3\", \"gap.wavelength=0.1\"]\n\
                quantities = [\"snaps\"]\n";
    for (name, axes) in [
        ("values", "[[axis]]\nkey = \"path.control\"\nvalues = [\"force\", \"stiffness=0.15\"]\n"),
        ("whole", "[[axis]]\nkey = \"basis.rings\"\nlinear = { from = 20, to = 40, count = 3 }\n"),
        (
            "pairs",
            "combine = \"pairs\"\n[[axis]]\nkey = \"gap.amplitude\"\nlinear = { from = 0.001, to = 2e-3, count = 3 }\n\
             [[axis]]\nkey = \"groups.adhesion\"\nlogarithmic = { from = 0.01, to = 0.02, count = 3 }\n",
        ),
        (
            "drawn",
            "random = { draws = 3, seed = 5 }\n[[axis]]\nkey = \"gap.amplitude\"\n\
             distribution = { log-uniform = [1e-3, 2e-3] }\n[[axis]]\nkey = \"groups.adhesion\"\n\
             distribution = { normal = { mean = 0.02, deviation = 0.001 } }\n[[axis]]\nkey = \"basis.rings\"\n\
             distribution = { integers = [20, 40] }\n[[axis]]\nkey = \"path.start_contact_radius\"\n\
             distribution = { uniform = [0.3, 0.4] }\n",
        ),
    ] {
        let mut set = head.to_owned();
        if axes.contains("rings") {
            set = set.replace("set = [", "set = [\"basis.kind=rings\", ");
        }
        if axes.contains("start_contact_radius") {
            set = set.replace("\"path.start_contact_radius=0.3\", ", "");
        }
        home.file("s.toml", &format!("{set}{axes}"));
        let [whole, one, two, all] = ["whole", "1", "2", "all"].map(|part| format!("{name}-{part}.csv"));
        home.sweep("s.toml", &whole, &[]);
        home.sweep("s.toml", &one, &["--shard=1/2"]);
        home.sweep("s.toml", &two, &["--shard=2/2"]);
        let (status, _, said) = home.run(&["sweep", "merge", &one, &two, "-o", &all]);
        assert_eq!(status, 0, "{name}: {said}");
        assert_eq!(home.text(&all), home.text(&whole), "{name}");
    }
}

#[test]
fn results_of_something_else_are_not_touched() {
    let home = Sweeps::new();
    home.file("s.toml", GRID);
    home.sweep("s.toml", "r.csv", &[]);
    let whole = home.text("r.csv");
    // Comments and line breaks do not make another sweep; a value does, and so does the preset.
    home.file("same.toml", &GRID.replace("values = [0.001, ", "# the same\nvalues = [\n1e-3, "));
    home.sweep("same.toml", "r.csv", &[]);
    for (name, text) in [
        ("value.toml", GRID.replace("0.001,", "0.0011,")),
        ("preset.toml", GRID.replace("wavelength=0.1", "wavelength=0.11")),
        ("quantity.toml", GRID.replace("\"snaps_force\", ", "")),
        (
            "pairs.toml",
            GRID.replace("count = 5", "count = 2").replace("preset =", "combine = \"pairs\"\npreset ="),
        ),
    ] {
        home.file(name, &text);
        let differs = match name {
            "value.toml" => "another sweep: other axes or values; --overwrite",
            "preset.toml" => "another sweep: another preset (gap.wavelength); --overwrite",
            "quantity.toml" => "another sweep: other quantities; --overwrite",
            _ => "another sweep: other rows of the same axes, other axes or values; --overwrite",
        };
        home.refused(&["sweep", name, "-o", "r.csv"], &format!("r.csv: holds the results of {differs}"));
        assert_eq!(home.text("r.csv"), whole);
    }
    // Another title does not either, but an older program does.
    home.file("title.toml", &GRID.replace("set = [", "set = [\"title=of today\", "));
    assert!(home.sweep("title.toml", "r.csv", &[]).contains("(10 from before)"));
    let side = home.text("r.csv.spec.toml");
    let version = format!("program_version = \"{}\"", env!("CARGO_PKG_VERSION"));
    let identity = side.lines().find(|line| line.starts_with("identity")).unwrap();
    let older = side.replace(&version, "program_version = \"0.0.1\"").replace(identity, "identity = \"0\"");
    home.file("r.csv.spec.toml", &older);
    home.refused(
        &["sweep", "s.toml", "-o", "r.csv"],
        "another sweep: another version of pulloff; --overwrite",
    );
    home.sweep("value.toml", "r.csv", &["--overwrite"]);
    assert!(home.text("r.csv").contains("\n0,0.0011,"));
    // A row changed by hand, too many rows, a file that was never ours.
    home.sweep("s.toml", "r.csv", &["--overwrite"]);
    home.file("r.csv", &whole.replace("\n3,0.001,", "\n3,0.002,"));
    home.refused(
        &["sweep", "s.toml", "-o", "r.csv"],
        "r.csv:5: row 3: column gap.amplitude is 0.002, expected 0.001: the file was changed; --overwrite starts afresh",
    );
    // A row that lost a field, or that is not a valid row.
    let row = whole.lines().nth(4).unwrap();
    let (kept, last) = row.trim_end_matches(',').rsplit_once(',').unwrap();
    for damaged in [format!("{kept},"), format!("{kept},x{last},"), format!("{row}lost")] {
        home.file("r.csv", &whole.replace(row, &damaged));
        home.refused(&["sweep", "s.toml", "-o", "r.csv"], "r.csv:5: row 3: ");
    }
    home.file("r.csv", &format!("{whole}10,1,1,1,1,1,1,\n"));
    home.refused(
        &["sweep", "s.toml", "-o", "r.csv"],
        "r.csv:12: there are more lines than rows: the file was changed",
    );
    home.file("mine.csv", "a,b\n");
    home.refused(
        &["sweep", "s.toml", "-o", "mine.csv"],
        "mine.csv: already exists, and is not known to belong to a sweep",
    );
    assert_eq!(home.text("mine.csv"), "a,b\n");
    home.refused(&["sweep", "s.toml", "-o", "."], "is a folder, not a regular file");
    home.refused(&["sweep", "none.toml", "-o", "x.csv"], "none.toml: cannot read");
    home.refused(&["sweep", "s.toml"], "--output <RESULTS.csv>");
    home.refused(&["sweep", "s.toml", "-o", "x.csv", "--shard", "4/3"], "such as 3/8");
    home.refused(&["sweep", "s.toml", "-o", "x.csv", "--jobs", "0"], "1..=1024");
    assert!(!home.path("x.csv").exists());
}

#[test]
fn a_preset_is_found_beside_the_spec() {
    let home = Sweeps::new();
    fs::create_dir(home.path("specs")).unwrap();
    let (_, preset, _) = home.run(&["presets", "show", "wavy-sphere"]);
    home.file("specs/mine.toml", &preset);
    home.file("specs/s.toml", &GRID.replace("\"wavy-sphere\"", "\"./mine.toml\""));
    home.sweep("specs/s.toml", "r.csv", &[]);
    assert_eq!(home.text("r.csv").lines().count(), 11);
    home.file("specs/mine.toml", &preset.replace("wavelength = 0.05", "wavelength = -1"));
    home.refused(
        &["sweep", "specs/s.toml", "-o", "x.csv"],
        "specs/mine.toml:17: gap.wavelength = -1.0 is out of range",
    );
}

#[test]
fn the_quantities_are_listed() {
    let home = Sweeps::new();
    let (status, out, _) = home.run(&["sweep", "quantities"]);
    assert_eq!(status, 0);
    for quantity in QUANTITIES {
        assert!(out.contains(&format!("{} ", quantity.name)) && out.contains(quantity.meaning));
    }
}
