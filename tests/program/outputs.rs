//! The destinations of results and the sources of presets, specs and scripts: files, standard streams, pipes, devices.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::Home;
use rustix::fs::{CWD, FileType, Mode, mknodat};
use std::fs::{self, Permissions};
use std::io::Write;
use std::os::unix::fs::{FileTypeExt, PermissionsExt};
use std::process::Stdio;

const PRESET: &str = "units = \"reduced\"\ntitle = \"piped\"\n[material]\neffective_modulus = 1.0\n\
    work_of_adhesion = 0.004\n[gap]\nshape = \"sphere\"\nradius_of_curvature = 1.0\n[path]\n\
    start_contact_radius = 0.3\n";

const SPEC: &str = "preset = \"wavy-sphere\"\nset = [\"path.start_contact_radius=0.3\", \"gap.wavelength=0.1\"]\n\
    quantities = [\"last_contact_force\"]\n[[axis]]\nkey = \"gap.amplitude\"\nvalues = [0.001, 0.002]\n";

/// Runs a line of the shell that succeeds; returns its output.
fn piped(home: &Home, line: &str) -> String {
    let ended = home.shell(line);
    assert_eq!(ended.status, 0, "{line}: {}", ended.err);
    ended.out
}

fn fifo(home: &Home, name: &str) {
    mknodat(CWD, home.path(name), FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
}

#[test]
fn results_go_straight_into_standard_output_pipes_and_devices() {
    let home = Home::new();
    home.file("s.toml", SPEC);
    for part in ["1", "2"] {
        piped(&home, &format!("$pulloff sweep s.toml -o {part}.csv --shard {part}/2"));
    }
    fifo(&home, "pipe");
    for (command, usual) in [
        ("trace fig-3-jkr --format csv", "step,contact_radius,"),
        ("unload fig-3-jkr --format json", "{"),
        ("unload fig-3-jkr", "control: displacement"),
        ("plot fig-3-jkr", "<svg"),
        ("sweep s.toml", "row,gap.amplitude,"),
        ("sweep merge 1.csv 2.csv", "row,gap.amplitude,"),
    ] {
        let plain = piped(&home, &format!("$pulloff {command} -o - 2>err"));
        assert!(plain.contains(usual), "{command}: {plain}");
        for line in [
            "-o /dev/stdout 2>err",
            "-o /dev/stdout 2>err | cat",
            "-o /dev/fd/3 3>&1 2>err >none",
            "-o >(cat) 2>err | cat",
            "-o pipe 2>err & cat pipe; wait",
        ] {
            let out = piped(&home, &format!("$pulloff {command} {line}"));
            assert!(out == plain, "{command} {line}: {out}");
        }
        assert_eq!(piped(&home, &format!("$pulloff {command} -o /dev/null 2>err")), "");
        // A file behind an open descriptor grows in place, whatever was written before.
        piped(
            &home,
            &format!("{{ echo before; $pulloff {command} -o /dev/stdout 2>err; echo after; }} >file"),
        );
        assert!(home.text("file") == format!("before\n{plain}after\n"), "{command}");
        piped(&home, &format!("{{ echo before >&3; $pulloff {command} -o /dev/fd/3 2>err; }} 3>file"));
        assert!(home.text("file") == format!("before\n{plain}"), "{command}");
        // A reader that goes away ends the program quietly.
        let gone = home.shell(&format!("set -o pipefail; $pulloff {command} -o /dev/fd/3 3>&1 >&2 | true"));
        assert!(gone.status == 0 && !gone.err.contains("roken pipe"), "{command}: {}", gone.err);
    }
    assert!(home.path("pipe").symlink_metadata().unwrap().file_type().is_fifo());
    assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
    assert!(!home.path("-").exists() && !home.path("-.spec.toml").exists());
    home.refused(&["figures", "-o", "-"], &["-o -: the figures are many files; name a folder"]);
    home.refused(&["plot", "--data", "-o", "/dev/stdout"], &["--data: the data go beside the figure's file"]);
}

#[test]
fn merged_shards_are_looked_at_before_anything_is_written_straight() {
    let home = Home::new();
    home.file("s.toml", SPEC);
    for part in ["1", "2"] {
        piped(&home, &format!("$pulloff sweep s.toml -o {part}.csv --shard {part}/2"));
    }
    let text = home.text("2.csv");
    home.file("2.csv", &text.replace(",0.002,", ",0.003,"));
    home.refused(
        &["sweep", "merge", "1.csv", "2.csv", "-o", "-"],
        &["2.csv:2: row 1: column gap.amplitude is 0.003, expected 0.002"],
    );
}

#[test]
fn the_ending_of_a_file_is_its_format() {
    let home = Home::new();
    home.file("s.toml", SPEC);
    for command in ["trace", "unload"] {
        let json: serde_json::Value = {
            assert_eq!(home.quiet(&[command, "fig-3-jkr", "-o", "r.json", "--overwrite"]), "");
            serde_json::from_str(&home.text("r.json")).unwrap()
        };
        assert_eq!(json["schema"], 1);
        home.quiet(&[command, "fig-3-jkr", "-o", "R.CSV", "--overwrite"]);
        let text = home.text("R.CSV");
        assert!(
            text.lines().next().unwrap().contains(",contact_radius,") || text.starts_with("number,kind,"),
            "{text}"
        );
        home.quiet(&[command, "fig-3-jkr", "-o", "none", "--format=csv", "--overwrite"]);
        home.refused(
            &[command, "fig-3-jkr", "-o", "x.json", "--format", "csv"],
            &["-o x.json: its extension says json, --format says csv"],
        );
        home.refused(&[command, "fig-3-jkr", "-o", "x.csv", "--format=json"], &["its extension says csv"]);
        // No extension, or one that says nothing.
        home.quiet(&[command, "fig-3-jkr", "-o", "r.txt", "--format=json", "--overwrite"]);
        assert!(home.text("r.txt").starts_with('{'));
    }
    home.refused(&["unload", "fig-3-jkr", "-o", "x.csv", "--format=table"], &["--format says table"]);
    home.refused(
        &["sweep", "s.toml", "-o", "x.json"],
        &["-o x.json: is written as CSV, and its file ends in .csv or .txt"],
    );
    home.refused(
        &["sweep", "merge", "1.csv", "-o", "x.json"],
        &["-o x.json: is written as CSV, and its file ends in .csv or .txt"],
    );
    home.refused(&["plot", "fig-3-jkr", "-o", "x.json"], &["x.json: a figure's file ends in .svg"]);
    assert!(!home.path("x.json").exists() && !home.path("x.csv").exists());
}

#[test]
fn presets_specs_and_scripts_come_through_pipes() {
    let home = Home::new();
    home.file("p.toml", PRESET);
    home.file("s.toml", SPEC);
    home.file(
        "own.toml",
        &SPEC
            .replace(
                "wavy-sphere\"\nset = [\"path.start_contact_radius=0.3\", \"gap.wavelength=0.1\"]",
                "p.toml\"",
            )
            .replace("gap.amplitude", "gap.radius_of_curvature")
            .replace("[0.001, 0.002]", "[1, 2]"),
    );
    home.file("walk.pulloff", "step\nexport walk walk.csv replace\n");
    fifo(&home, "pipe.toml");
    for (command, file) in [
        ("trace @ --set basis.kind=rings", "p.toml"),
        ("unload @ --format json", "p.toml"),
        ("plot @", "p.toml"),
        ("presets show @", "p.toml"),
        ("sweep @ -o -", "s.toml"),
        ("sweep @ -o -", "own.toml"),
        ("run walk.pulloff --overwrite --preset @; cat walk.csv", "p.toml"),
        ("run @ --overwrite --preset p.toml; cat walk.csv", "walk.pulloff"),
    ] {
        let from =
            |source: &str| format!("$pulloff {} 2>err", command.replace('@', source).replace(';', " 2>err;"));
        let plain = piped(&home, &from(file));
        assert!(!plain.is_empty(), "{command}");
        for line in [
            format!("cat {file} | {{ {}; }}", from("-")),
            format!("{} < {file}", from("/dev/stdin").replace(" 2>err;", &format!(" < {file} 2>err;"))),
            from(&format!("<(cat {file})")),
            format!("cat {file} > pipe.toml & {}; wait", from("./pipe.toml")),
        ] {
            assert!(piped(&home, &line) == plain, "{line}");
        }
    }
    // A fault is reported with name and line, and a preset that is too large is not read to its end.
    let bad = home.shell("echo 'rings = ' | $pulloff trace -");
    assert!(bad.status == 2 && bad.err.starts_with("pulloff: standard input:1: "), "{}", bad.err);
    for (command, limit) in [("trace", "1048576"), ("run", "1048576"), ("sweep -o x.csv", "1048576")] {
        let endless = home.shell(&format!("yes '#' | $pulloff {command} -"));
        let said = format!("pulloff: standard input: has more than the {limit} bytes that are read\n");
        assert_eq!((endless.status, endless.err), (2, said), "{command}");
    }
    home.refused(
        &["run", "-", "--preset", "-"],
        &["standard input holds the script or the preset, not both"],
    );
}

#[test]
fn read_only_files_are_not_replaced() {
    let home = Home::new();
    home.file("s.toml", SPEC);
    for part in ["1", "2"] {
        piped(&home, &format!("$pulloff sweep s.toml -o {part}.csv --shard {part}/2"));
    }
    home.file("config/pulloff/presets/mine.toml", PRESET);
    let kept = ["out.csv", "out.svg", "fig/fig-1.csv", "config/pulloff/presets/mine.toml"];
    for file in kept {
        if !file.starts_with("config") {
            home.file(file, "mine");
        }
        fs::set_permissions(home.path(file), Permissions::from_mode(0o444)).unwrap();
    }
    home.file("save.pulloff", "set material.work_of_adhesion=0.005\nsave replace\n");
    home.file("export.pulloff", "export curve out.csv replace\n");
    for line in [
        "trace fig-3-jkr -o out.csv --overwrite",
        "unload fig-3-jkr -o out.csv --overwrite",
        "plot fig-3-jkr -o out.svg --overwrite",
        "sweep s.toml -o out.csv --overwrite",
        "sweep merge 1.csv 2.csv -o out.csv --overwrite",
        "figures -o fig --overwrite",
        "run save.pulloff --preset mine --overwrite --anywhere",
        "run export.pulloff --overwrite",
    ] {
        let ended = home.shell(&format!("$pulloff {line}"));
        assert!(ended.err.contains("is read-only and is not replaced"), "{line}: {}", ended.err);
        assert_ne!(ended.status, 0, "{line}");
    }
    for file in &kept[..3] {
        assert_eq!(home.text(file), "mine");
    }
    assert_eq!(home.text(kept[3]), PRESET);
}

#[test]
fn a_script_that_came_through_a_pipe_has_no_preset_to_save_back_to() {
    let home = Home::new();
    let mut command = home.command(&["run", "-", "--overwrite", "--preset", "/dev/fd/0"]);
    let mut child = command.stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(b"step\n").unwrap();
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(2));
    home.file("p.toml", PRESET);
    home.file("save.pulloff", "save replace\n");
    home.file("script.pulloff", "step\nexport script s.pulloff\n");
    let save = home.shell("cat p.toml | $pulloff run save.pulloff --overwrite --preset -");
    assert!(save.err.contains("the preset has no file of its own; save it under a name"), "{}", save.err);
    let script = home.shell("cat p.toml | $pulloff run script.pulloff --preset -");
    assert!(script.err.contains("a script cannot open it: save it under a name"), "{}", script.err);
}
