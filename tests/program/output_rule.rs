//! One rule for every file that a command writes: nothing is replaced unless asked, no input is overwritten, and two
//! outputs are two files.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::Home;
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;

const PRESET: &str = "[material]\neffective_modulus = 1.0\nwork_of_adhesion = 0.01\n[gap]\nshape = \"profile\"\n\
    file = \"scan.csv\"\n[path]\nstart_contact_radius = 0.5\n";
const SPEC: &str = "preset = \"mine.toml\"\nquantities = [\"snaps\"]\n[[axis]]\nkey = \"material.work_of_adhesion\"\n\
    values = [0.01, 0.02]\n";
/// A sweep over two parameters, for `map --over`.
const GRID: &str = "preset = \"wavy-sphere\"\nquantities = [\"snaps\"]\n[[axis]]\nkey = \"gap.amplitude\"\n\
    values = [1e-4, 2e-4]\n[[axis]]\nkey = \"groups.adhesion\"\nvalues = [0.01, 0.02]\n";
const LENS: &str = include_str!("../../presets/data/lens.csv");
const MAP: &str = "map --x-key groups.adhesion=log:0.005..0.2 --y approach";
const OVER: &str =
    "map wavy-sphere --x-key gap.amplitude=1e-4..2e-4 --y-key groups.adhesion=0.01..0.02 --over grid.csv";

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// A home with everything that a command reads.
fn home() -> Home {
    let home = Home::new();
    home.file("mine.toml", PRESET);
    let rows = (0..100).map(f64::from).map(|i| format!("{},{}\n", i / 50.0, i * i / 5000.0));
    home.file("scan.csv", &rows.collect::<String>());
    home.file("points.csv", LENS);
    home.file("s.toml", SPEC);
    home.file("grid.toml", GRID);
    home.file("p.csv", "");
    home.file("export.pulloff", "step\nexport curve x.csv replace\n");
    for line in [
        "sweep s.toml -o 1.csv --shard 1/2 --quiet",
        "sweep s.toml -o 2.csv --shard 2/2 --quiet",
        "sweep s.toml -o all.csv --quiet",
        "sweep grid.toml -o grid.csv --quiet",
    ] {
        home.quiet(&words(line));
    }
    home
}

/// All files below a folder with their bytes.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let (path, name) = (entry.path(), entry.file_name().into_string().unwrap());
        if path.is_dir() {
            all.extend(files(&path).into_iter().map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else {
            all.insert(name, fs::read(&path).unwrap_or_default());
        }
    }
    all
}

#[test]
fn what_is_there_is_replaced_only_with_overwrite_and_asked_before_anything_is_computed() {
    let home = home();
    home.file("run.pulloff", "step\nexport curve x.csv\n");
    for (line, file, is_quick) in [
        ("trace fig-3-jkr -o x.csv", "x.csv", true),
        ("unload fig-3-jkr -o x.json", "x.json", true),
        ("cycle fig-9-weak -o x.txt", "x.txt", false),
        (&format!("{MAP} -o x.csv"), "x.csv", true),
        (&format!("{MAP} -o x.svg"), "x.svg", false),
        ("fit lens -o x.toml", "x.toml", false),
        ("fit lens -o x.json", "x.json", false),
        ("fit lens --residuals x.csv", "x.csv", false),
        ("fit lens --table x.csv", "x.csv", true),
        ("plot fig-3-jkr -o x.svg", "x.svg", true),
        ("plot fig-3-jkr --data -o x.svg", "x.csv", false),
        ("plot --sweep all.csv --quantity snaps -o x.svg", "x.svg", true),
        ("figures -o fig", "fig/fig-10b.svg", false),
        ("figures -o fig", "fig/captions.md", false),
        ("sweep s.toml -o x.csv", "x.csv", true),
        ("sweep s.toml -o x.csv", "x.csv.spec.toml", true),
        ("sweep s.toml -o x.csv --status state.json", "state.json", true),
        ("sweep merge 1.csv 2.csv -o x.csv", "x.csv", true),
        ("sweep merge 1.csv 2.csv -o x.csv", "x.csv.spec.toml", true),
        ("verify --only uniform -o x.csv", "x.csv", false),
        ("run run.pulloff", "x.csv", true),
    ] {
        // The file itself, and a link to another file.
        for is_link in [false, true] {
            home.file("kept", "mine");
            let path = home.path(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            if is_link {
                symlink(home.path("kept"), &path).unwrap();
            } else {
                fs::write(&path, "mine").unwrap();
            }
            let before = files(home.folder());
            home.refused(&words(line), &["--overwrite", file]);
            assert_eq!(files(home.folder()), before, "{line}: {file}");
            if is_quick && !is_link {
                let ended = home.run(&[&words(line)[..], &["--overwrite"]].concat());
                assert_eq!(ended.status, 0, "{line}: {}", ended.err);
                let now = fs::read(&path).unwrap();
                assert!(now != b"mine" && !now.is_empty(), "{line}: {file}");
            }
            for stray in ["x.csv", "x.csv.spec.toml", "x.svg", "state.json"] {
                let _ = fs::remove_file(home.path(stray));
            }
            fs::remove_file(&path).unwrap_or_default();
        }
    }
}

#[test]
fn what_is_read_is_not_written_over_through_links_neither() {
    let home = home();
    home.file("free.toml", &SPEC.replace("mine.toml", "wavy-sphere"));
    let before = files(home.folder());
    for (line, inputs) in [
        ("trace mine.toml -o @.csv", &["mine.toml", "scan.csv"][..]),
        ("unload mine.toml -o @", &["mine.toml", "scan.csv"]),
        ("cycle mine.toml -o @.json", &["mine.toml", "scan.csv"]),
        (
            "map mine.toml --x-key material.work_of_adhesion=0.01..0.02 --y force -o @.csv",
            &["mine.toml", "scan.csv"],
        ),
        (&format!("{OVER} -o @.svg"), &["grid.csv", "grid.csv.spec.toml"]),
        ("plot mine.toml -o @.svg", &["mine.toml", "scan.csv"]),
        ("plot lens --measured points.csv -o @.svg", &["points.csv"]),
        ("plot --sweep all.csv --quantity snaps -o @.svg", &["all.csv", "all.csv.spec.toml"]),
        ("fit points.csv lens -o @.toml", &["points.csv"]),
        ("fit points.csv lens -o @.json", &["points.csv"]),
        ("fit points.csv lens --residuals @.csv", &["points.csv"]),
        ("fit points.csv mine.toml --free E* --residuals @.csv", &["mine.toml", "scan.csv"]),
        ("sweep s.toml -o @.csv", &["s.toml", "mine.toml", "scan.csv"]),
        ("sweep s.toml -o new.csv --status @.json", &["s.toml", "mine.toml", "scan.csv"]),
        ("sweep merge 1.csv 2.csv -o @.csv", &["1.csv", "2.csv", "1.csv.spec.toml", "2.csv.spec.toml"]),
        ("run @.pulloff --preset mine.toml", &["mine.toml", "scan.csv", "@.pulloff"]),
    ] {
        for input in inputs {
            for is_hard in [false, true] {
                // The output, with its extension, is a link to the input.
                let line = line.replace('@', "out");
                let input = input.replace('@', "out");
                let is_script = line.starts_with("run");
                let last = words(&line).pop().unwrap().to_owned();
                let name = if is_script { "link.csv".to_owned() } else { last };
                if is_script {
                    home.file("out.pulloff", "step\nexport curve link.csv replace\n");
                }
                let all = files(home.folder());
                let link = home.path(&name);
                if is_hard { fs::hard_link(home.path(&input), &link) } else { symlink(&input, &link) }
                    .unwrap();
                let arguments = [&words(&line)[..], &["--overwrite"]].concat();
                home.refused(&arguments, &["write to another file", &name]);
                fs::remove_file(&link).unwrap();
                assert_eq!(files(home.folder()), all, "{line}: {input}");
            }
        }
    }
    let _ = fs::remove_file(home.path("out.pulloff"));
    assert_eq!(files(home.folder()), before);
    // What is generated beside the results is an output too; a spec must not be that file.
    home.file("x.csv.spec.toml", &home.text("free.toml"));
    home.refused(&words("sweep x.csv.spec.toml -o x.csv --overwrite"), &["is also read, as the spec"]);
    // There are files behind standard input and output.
    let mut trace = home.command(&words("trace - -o mine.toml --overwrite"));
    let ended = crate::support::home::Ended::of(
        trace.stdin(fs::File::open(home.path("mine.toml")).unwrap()).output().unwrap(),
    );
    assert_eq!((ended.status, home.text("mine.toml").as_str()), (2, PRESET), "{}", ended.err);
    let mut trace = home.command(&words("trace mine.toml"));
    let end = fs::File::options().append(true).open(home.path("mine.toml")).unwrap();
    let status = trace.stdout(end).status().unwrap();
    assert_eq!((status.code(), home.text("mine.toml").as_str()), (Some(2), PRESET));
}

#[test]
fn two_outputs_of_a_command_are_two_files() {
    let home = home();
    symlink("x.csv", home.path("link.csv")).unwrap();
    home.file("twice.pulloff", "step\nexport curve x.csv\nexport walk ./x.csv\n");
    let before = files(home.folder());
    for line in [
        "fit points.csv lens -o x.csv --residuals x.csv",
        "fit points.csv lens -o x.csv --residuals ./link.csv",
        "fit points.csv lens --table x.csv --residuals x.csv --overwrite",
        "fit points.csv lens --residuals -",
        "sweep s.toml -o x.csv --status x.csv.spec.toml",
        "sweep s.toml -o x --status ./x",
        "run twice.pulloff --overwrite",
    ] {
        let ended = home.run(&words(line));
        assert_eq!(ended.status, 2, "{line}: {}", ended.err);
        assert!(
            ["is where the output of", "is written twice", "ends in .json"]
                .iter()
                .any(|said| ended.err.contains(said))
                || ended.err.contains("x.csv"),
            "{line}: {}",
            ended.err
        );
        assert_eq!(files(home.folder()), before, "{line}");
    }
    home.quiet(&words("trace fig-3-jkr -o /dev/null"));
}

#[test]
fn a_status_is_replaced_unasked_only_by_its_own_sweep() {
    let home = home();
    home.file("other.toml", &SPEC.replace("0.02]", "0.03]"));
    let line = "sweep s.toml -o x.csv --status state.json --quiet";
    home.quiet(&words(line));
    home.quiet(&words(line));
    let status = home.text("state.json");
    for other in [
        "sweep other.toml -o y.csv --status state.json",
        "sweep s.toml -o z.csv --shard 1/2 --status state.json",
        "sweep s.toml -o z.csv --set path.start_contact_radius=0.4 --status state.json",
    ] {
        home.refused(
            &words(other),
            &["--status state.json: already exists, and is not the status of this sweep"],
        );
        assert_eq!(home.text("state.json"), status);
    }
    assert!(!home.path("y.csv").exists());
    home.quiet(&words("sweep other.toml -o y.csv --status state.json --overwrite --quiet"));
    assert_ne!(home.text("state.json"), status);
    home.refused(
        &words("sweep s.toml -o x.csv --status thesis.tex"),
        &["--status thesis.tex", "ends in .json"],
    );
    home.refused(&words("sweep s.toml -o x.csv --status /dev/stderr"), &["name a file"]);
}

#[test]
fn a_name_says_the_format_or_is_refused() {
    let home = home();
    let before = files(home.folder());
    for command in ["trace fig-3-jkr", "unload fig-3-jkr", "cycle fig-9-weak", "verify", "fit lens"] {
        for ending in ["svg", "xlsx", "png", "pdf", "md"] {
            for format in ["", "--format csv"] {
                let line = format!("{command} -o x.{ending} {format}");
                home.refused(&words(&line), &["table, csv or json", ".csv, .json or .txt", "pulloff plot"]);
            }
        }
        for (name, format) in [("x.csv", "json"), ("x.json", "csv"), ("X.JSON", "table"), ("x.csv", "table")]
        {
            let line = format!("{command} -o {name} --format {format}");
            home.refused(&words(&line), &["its extension says", &format!("--format says {format}")]);
        }
    }
    home.refused(
        &words(&format!("{MAP} -o x.svg --format csv")),
        &["its extension says svg, --format says csv"],
    );
    home.refused(&words(&format!("{MAP} -o x.gif")), &[".csv, .json or .txt", ".svg, .png or .pdf"]);
    for line in ["fit lens --residuals x.json", "fit lens --table x.toml", "sweep s.toml -o x.svg"] {
        home.refused(&words(line), &["is written as CSV, and its file ends in .csv or .txt"]);
    }
    assert_eq!(files(home.folder()), before);
}

#[test]
fn every_result_comes_as_table_csv_and_json() {
    let home = home();
    for command in ["trace fig-3-jkr", "unload fig-3-jkr", MAP, "fit lens", "verify --only uniform"] {
        let of = |format: &str| {
            let ended = home.run(&[&words(command)[..], &["--format", format]].concat());
            assert_eq!(ended.status, 0, "{command} {format}: {}", ended.err);
            ended.out
        };
        let rows = of("csv");
        let mut reader = csv::Reader::from_reader(rows.as_bytes());
        let records = reader.records().map(Result::unwrap).count();
        assert!(records > 0, "{command}");
        let json: serde_json::Value = serde_json::from_str(&of("json")).unwrap();
        assert_eq!(json["schema"], 1, "{command}");
        let table = of("table");
        assert!(table != rows && table.lines().count() >= records, "{command}: {table}");
    }
}

#[test]
fn what_is_not_whole_is_no_success() {
    let home = home();
    home.refused(
        &words("plot fig-3-jkr --view residuals"),
        &["--view residuals: there are no measured points"],
    );
    // Rows are missing, or no row is complete.
    let all = home.text("all.csv");
    let torn = all.trim_end().rsplit_once('\n').unwrap().0;
    home.file("all.csv", &format!("{torn}\n"));
    let ended = home.run(&words("sweep check all.csv"));
    assert!(ended.status == 1 && ended.out.contains("1 of 2 rows"), "{} {}", ended.out, ended.err);
    let limit = "sweep s.toml -o late.csv --row-limit 0.000001ms";
    for line in [limit, "sweep check late.csv"] {
        let ended = home.run(&words(line));
        assert!(ended.status == 1 && ended.err.contains("every row failed"), "{line}: {}", ended.err);
    }
    home.refused(
        &words("sweep s.toml -o x.csv --set material.work_of_adhesion=1"),
        &["gives each point its own"],
    );
}

#[test]
fn strict_makes_any_warning_exit_status_3_and_quiet_says_none() {
    let home = home();
    let range = "--set material.range_of_action=0.1";
    for command in ["trace", "unload", "cycle", "plot"] {
        let line = format!("{command} fig-9-weak {range}");
        let plain = home.run(&words(&line));
        assert!(
            plain.status == 0 && plain.err.contains("pulloff: warning: Tabor's mu"),
            "{line}: {}",
            plain.err
        );
        let quiet = home.quiet(&words(&format!("{line} --quiet")));
        assert_eq!(quiet, plain.out, "{line}");
        let strict = home.run(&words(&format!("{line} --strict")));
        assert_eq!((strict.status, &strict.out), (3, &plain.out), "{line}: {}", strict.err);
        let both = home.run(&words(&format!("{line} --strict -q")));
        assert_eq!((both.status, both.err.lines().count()), (3, 1), "{line}: {}", both.err);
    }
    // A row with an error is a warning in a sweep.
    home.file(
        "bad.toml",
        &SPEC.replace("material.work_of_adhesion", "path.start_contact_radius").replace("0.02", "50"),
    );
    for line in ["sweep bad.toml -o bad.csv", "sweep check bad.csv"] {
        let plain = home.run(&words(line));
        assert!(plain.status == 0 && plain.err.contains("warning: 1 with an error"), "{line}: {}", plain.err);
        assert_eq!(home.run(&words(&format!("{line} --strict"))).status, 3, "{line}");
    }
}
