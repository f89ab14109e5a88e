//! The exit status: the same fault has the same status in every command.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::Home;
use pulloff::cli::Status;
use rustix::fs::{CWD, FileType, Mode, mknodat};
use rustix::process::Signal;
use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;

const SPEC: &str = "preset = \"wavy-sphere\"\nset = [\"path.start_contact_radius=0.3\", \"gap.wavelength=0.1\"]\n\
    quantities = [\"snaps\"]\n[[axis]]\nkey = \"gap.amplitude\"\nvalues = [0.001, 0.002]\n";

/// A home with files of every kind.
fn home() -> Home {
    let home = Home::new();
    home.file("s.toml", SPEC);
    for part in ["1", "2"] {
        let ended =
            home.run(&["sweep", "s.toml", "-o", &format!("{part}.csv"), "--shard", &format!("{part}/2")]);
        assert_eq!(ended.status, 0, "{}", ended.err);
    }
    home.file("bad.toml", "rings = ");
    home.file("bad.csv", "a,b\n");
    home.file("there/mine.csv", "mine");
    home.file("marked.csv", "mine");
    home.file("marked.svg", "mine");
    home.file("marked/fig-1.csv", "mine");
    for name in ["marked.csv", "marked.svg", "marked/fig-1.csv"] {
        fs::set_permissions(home.path(name), Permissions::from_mode(0o444)).unwrap();
    }
    mknodat(CWD, home.path("socket.toml"), FileType::Socket, Mode::from_raw_mode(0o600), 0).unwrap();
    for (name, text) in [
        ("value", "set gap.amplitude=-1"),
        ("key", "set gap.amplitud=1"),
        ("preset", "open none"),
        ("no-folder", "export curve none/x.csv"),
        ("exists", "export curve there/mine.csv"),
        ("marked", "export curve marked.csv replace"),
        ("folder", "export curve folder.csv replace"),
        ("outside", "export curve ../x.csv"),
        ("start", "set path.start_force=-1"),
        ("unavailable", "jump"),
        ("fine", "step\nexport curve new.csv replace\nexport walk walk.csv replace"),
    ] {
        home.file(&format!("{name}.pulloff"), text);
    }
    fs::create_dir(home.path("folder.csv")).unwrap();
    fs::create_dir(home.path("folder.toml")).unwrap();
    home
}

/// Faults that another call or another file mends.
const MENDABLE: &[&str] = &[
    // A bad value or key.
    "trace fig-9 --set gap.amplitude=-1",
    "unload fig-9 --set gap.amplitude=-1",
    "plot fig-9 --set gap.amplitude=-1",
    "run value.pulloff",
    "run fine.pulloff --set gap.amplitude=-1",
    "sweep bad.toml -o x.csv",
    "trace bad.toml",
    "presets show bad.toml",
    "fig-9 --set gap.amplitude=-1",
    "trace fig-9 --set gap.amplitud=1",
    "run key.pulloff",
    "plot --sweep 1.csv --quantity nothing",
    "verify --only nothing-like-it",
    "unload fig-9 --control load",
    // A start that no contact has.
    "trace fig-3-jkr --set path.start_force=-1",
    "unload fig-3-jkr --set path.start_force=-1",
    "plot fig-3-jkr --set path.start_force=-1",
    "run start.pulloff --preset fig-3-jkr",
    // A bad option.
    "trace --nothing",
    "sweep s.toml",
    "sweep s.toml -o x.csv --shard 3/2",
    "sweep s.toml -o x.json",
    "trace -o x.json --format csv",
    "plot -o x.json",
    "completions none",
    // A number with a sign is a number, though out of range.
    "fit shipped:lens.csv lens --sigma-x -1",
    "fit shipped:lens.csv lens --sigma-force -1uN",
    "fit shipped:lens.csv lens --bootstrap -1",
    "fit shipped:lens.csv lens --seed -1",
    "sweep s.toml -o x.csv --row-limit -1s",
    "sweep s.toml -o x.csv --jobs -1",
    "sweep s.toml -o x.csv --shard -1/2",
    "plot --contact-radius -1 --view gap",
    "plot --width -3",
    "map --x-key gap.amplitude=1e-3..2e-3 --y control --width -3",
    "cycle --to-radius -1",
    // The axes of a map.
    "map --x-key compliance=-1..1 --y control",
    "map --x-key compliance=-1..inf --y control",
    "map --x-key compliance=nan..1 --y control",
    "map --x-key banana=0..1",
    "map --x-key gap.amplitude=-1..1 --y control",
    "map --x-key gap.amplitude=1e-3..2e-3",
    "figures -o -",
    // Nothing of that name.
    "trace none",
    "trace none.toml",
    "unload none/none.toml",
    "plot none",
    "run none.pulloff",
    "run fine.pulloff --preset none",
    "run preset.pulloff",
    "sweep none.toml -o x.csv",
    "sweep merge none.csv -o x.csv",
    "plot --sweep none.csv",
    "presets show none",
    "presets delete none --yes",
    "sessions show none",
    "sessions delete none --yes",
    "--resume none",
    "--config none.toml",
    // No file, or none of the right kind.
    "trace folder.toml",
    "trace socket.toml",
    "run folder.toml",
    "sweep folder.toml -o x.csv",
    "sweep merge bad.csv -o x.csv",
    "plot --sweep bad.csv",
    // No folder to write into.
    "trace -o none/x.csv",
    "unload -o none/x.csv",
    "plot -o none/x.svg",
    "sweep s.toml -o none/x.csv",
    "sweep merge 1.csv 2.csv -o none/x.csv",
    "figures -o s.toml/x",
    "run no-folder.pulloff",
    // A folder in place of a file.
    "trace -o folder.csv",
    "unload -o folder.csv",
    "sweep s.toml -o folder.csv",
    "sweep s.toml -o folder.csv --overwrite",
    "sweep merge 1.csv 2.csv -o folder.csv --overwrite",
    "run folder.pulloff --overwrite",
    "figures -o s.toml",
    // A file that must not be replaced.
    "sweep s.toml -o there/mine.csv",
    "sweep merge 1.csv 2.csv -o there/mine.csv",
    "run exists.pulloff",
    "trace -o marked.csv --overwrite",
    "unload -o marked.csv --overwrite",
    "plot -o marked.svg --overwrite",
    "sweep s.toml -o marked.csv --overwrite",
    "sweep merge 1.csv 2.csv -o marked.csv --overwrite",
    "run marked.pulloff --overwrite",
    "run outside.pulloff",
    "figures -o marked --overwrite",
    // Parts of a sweep that do not fit, and an action refused without a yes.
    "sweep merge 1.csv -o x.csv",
    "sweep merge 1.csv 1.csv -o x.csv",
    "sweep s.toml -o 1.csv --shard 2/2",
    "sessions delete none",
    // A command that cannot be run now.
    "run unavailable.pulloff",
];

#[test]
fn what_the_person_can_mend_is_2() {
    let home = home();
    for line in MENDABLE {
        let arguments: Vec<&str> = line.split(' ').collect();
        let ended = home.run(&arguments);
        assert_eq!((ended.status, ended.out.as_str()), (2, ""), "{line}: {}", ended.err);
        assert!(!ended.err.is_empty(), "{line}");
        assert!(!ended.err.contains("unexpected argument '-1"), "{line}: {}", ended.err);
        assert!(
            !line.contains("banana") || ended.err.contains("unknown key banana"),
            "{line}: {}",
            ended.err
        );
    }
    assert_eq!(home.text("there/mine.csv"), "mine");
    assert_eq!(home.text("marked.csv"), "mine");
}

#[test]
fn what_failed_is_1() {
    let home = home();
    // A full disk.
    for line in [
        "trace -o /dev/full",
        "unload -o /dev/full",
        "plot -o /dev/full",
        "sweep s.toml -o /dev/full",
        "sweep merge 1.csv 2.csv -o /dev/full",
        "trace >/dev/full",
        "presets list >/dev/full",
        "man >/dev/full",
        "completions bash >/dev/full",
        "sweep quantities >/dev/full",
    ] {
        let ended = home.shell(&format!("$pulloff {line}"));
        assert_eq!(ended.status, 1, "{line}: {}", ended.err);
        assert!(ended.err.contains("No space left on device"), "{line}: {}", ended.err);
    }
    // A sweep in which every row failed: complete, joined from shards, or checked again. A shard may be part of a good one.
    let spec = |forces: &str| {
        format!(
            "preset = \"fig-3-jkr\"\nquantities = [\"snaps\"]\n[[axis]]\nkey = \"path.start_force\"\nvalues = {forces}\n"
        )
    };
    home.file("none.toml", &spec("[-1.0, -2.0]"));
    for (line, status) in [
        ("sweep none.toml -o none.csv", 1),
        ("sweep none.toml -o none.csv", 1),
        ("sweep check none.csv", 1),
        ("sweep none.toml -o none-1.csv --shard 1/2", 0),
        ("sweep none.toml -o none-2.csv --shard 2/2", 0),
        ("sweep merge none-1.csv none-2.csv -o joined.csv", 1),
        ("sweep merge none-1.csv none-2.csv -o -", 1),
    ] {
        let ended = home.shell(&format!("$pulloff {line}"));
        assert_eq!(ended.status, status, "{line}: {}", ended.err);
        assert_eq!(status == 1, ended.err.contains("every row failed"), "{line}: {}", ended.err);
    }
    assert!(home.text("joined.csv") == home.text("none.csv"));
    home.file("some.toml", &spec("[-1.0, 0.1]"));
    assert_eq!(home.shell("$pulloff sweep some.toml -o some.csv").status, 0);
    // A curve that could not be followed to its end.
    let coarse = "trace fig-9 --set basis.rings=5";
    let ended = home.shell(&format!("$pulloff {coarse}"));
    assert_eq!(ended.status, 1, "{}", ended.err);
}

/// The status is that of the worst of many fits, and none prevents the others.
#[test]
fn many_fits_end_with_the_worst() {
    let home = Home::new();
    let free = "material.effective_modulus,material.work_of_adhesion,data.offset";
    let good = home.file("good.csv", include_str!("../../presets/data/lens.csv"));
    let (bad, gone) = (home.file("bad.csv", "a,b\n1,2\n"), "none.csv".to_owned());
    let of = |files: &[&String], free: &str, expected: i32| {
        let mut arguments = vec!["fit"];
        arguments.extend(files.iter().map(|file| file.as_str()));
        arguments.extend(["lens", "--no-scan", "--free", free]);
        let ended = home.run(&arguments);
        assert_eq!(ended.status, expected, "{arguments:?}: {}", ended.err);
        assert_eq!(ended.out.matches("end: converged").count(), files.len() - usize::from(expected == 2));
    };
    of(&[&good, &good], free, 0);
    of(&[&good, &bad], free, 2);
    of(&[&gone, &good], free, 2);
    of(&[&good, &good], &format!("gap.radius_of_curvature,{free}"), 3);
    of(&[&bad, &good], &format!("gap.radius_of_curvature,{free}"), 2);
}

/// A command stopped by a signal writes nothing and says which signal it was.
#[test]
fn what_a_signal_stops_has_the_status_of_the_signal() {
    let home = Home::new();
    home.file("there.csv", "mine");
    let map =
        ["map", "random-waves", "--x-key", "gap.rms=1e-4..1e-3", "--y-key", "groups.adhesion=1e-3..1e-1"];
    for (arguments, signal, status) in [
        (
            vec!["trace", "fig-9", "--set", "basis.rings=2000", "-o", "there.csv", "--overwrite"],
            Signal::INT,
            130,
        ),
        (vec!["unload", "fig-9", "--set", "basis.rings=2000"], Signal::TERM, 143),
        (
            vec![
                "cycle",
                "fig-9-weak",
                "--set",
                "groups.wavelength_over_radius=0.005",
                "--to-radius",
                "0.9",
                "-o",
                "new.csv",
            ],
            Signal::INT,
            130,
        ),
        (map.to_vec(), Signal::TERM, 143),
    ] {
        let ended = home.stopped(&arguments, signal);
        assert_eq!((ended.status, ended.out.as_str()), (status, ""), "{arguments:?}: {}", ended.err);
        assert!(
            ended.err.ends_with("pulloff: stopped: nothing was written\n"),
            "{arguments:?}: {}",
            ended.err
        );
    }
    assert_eq!(home.text("there.csv"), "mine");
    assert!(!home.path("new.csv").exists());
}

/// The table in the book and the manual page is that of the program.
#[test]
fn every_status_is_listed_once_with_its_meaning() {
    let codes: Vec<u8> = Status::ALL.into_iter().map(Status::code).collect();
    assert!(codes.is_sorted_by(|a, b| a < b), "{codes:?}");
    let home = Home::new();
    let page = home.quiet(&["man"]).replace("\\-", "-");
    let section = page.split(".SH \"EXIT STATUS\"").nth(1).unwrap().split(".SH ").next().unwrap();
    for status in Status::ALL {
        assert!(section.contains(&format!("\\fB{}\\fR", status.code())), "{section}");
        assert!(section.contains(status.meaning().split(',').next().unwrap()), "{section}");
    }
}

/// The file-size limit is not a signal that kills, but an error like a full disk.
#[test]
fn a_file_larger_than_the_limit_is_a_failure_and_nothing_is_lost() {
    let home = home();
    for (name, text) in
        [("old.csv", "old"), ("old.json", "old"), ("old.svg", "old"), ("figures/fig-1.csv", "x,y\nold\n")]
    {
        home.file(name, text);
    }
    for line in [
        "trace fig-9 -o old.csv --overwrite",
        "unload random-waves -o old.json --overwrite",
        "plot fig-9 -o old.svg --overwrite",
        "figures -o figures --overwrite",
        "trace fig-9 >new.csv",
        "trace fig-9 -o /dev/stdout >new.csv",
        "run fine.pulloff --preset fig-9 --overwrite",
    ] {
        let ended = home.shell(&format!("ulimit -f 1; $pulloff {line}"));
        assert_eq!(ended.status, 1, "{line}: {}", ended.err);
        assert!(
            ended.err.contains("over the limit on the size of files (ulimit -f)"),
            "{line}: {}",
            ended.err
        );
    }
    assert!(["old.csv", "old.json", "old.svg"].iter().all(|name| home.text(name) == "old"));
    assert_eq!(home.text("figures/fig-1.csv"), "x,y\nold\n");
    // No temporary is left behind.
    let left = fs::read_dir(home.folder()).unwrap().filter_map(Result::ok);
    assert!(left.map(|entry| entry.file_name()).all(|name| !name.to_string_lossy().starts_with(".pulloff-")));
    // A sweep keeps its complete rows, and continues from them.
    let many = SPEC.replace("values = [0.001, 0.002]", "linear = { from = 0.001, to = 0.002, count = 300 }");
    home.file("many.toml", &many.replace("\"snaps\"", "\"snaps\", \"enhancement\", \"last_contact_force\""));
    let limited = home.shell("ulimit -f 6; $pulloff sweep many.toml -o r.csv");
    assert_eq!(limited.status, 1, "{}", limited.err);
    assert!(limited.err.contains("r.csv: cannot write: over the limit"), "{}", limited.err);
    let rows = home.text("r.csv").lines().count();
    assert!(rows > 2 && rows < 301, "{rows}");
    let rest = home.shell("$pulloff sweep many.toml -o r.csv && $pulloff sweep many.toml -o whole.csv");
    assert!(rest.status == 0 && rest.err.contains("300 of 300 rows in r.csv ("), "{}", rest.err);
    assert!(home.text("r.csv") == home.text("whole.csv"));
}
