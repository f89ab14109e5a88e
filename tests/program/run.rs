//! `pulloff run`: scripts of the explorer's commands, without a terminal.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use crate::support::home::{Ended, Home};
use crate::support::pty::Pty;
use std::fs;
use std::io::Write;
use std::os::unix::fs::symlink;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// A home, and the folder in it in which scripts run.
struct Scripts(Home);

impl Scripts {
    fn new() -> Self {
        let home = Home::new();
        fs::create_dir(home.path("here")).unwrap();
        Self(home)
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path(name)
    }

    /// Runs `script` from standard input.
    fn run(&self, script: &str, arguments: &[&str]) -> Ended {
        self.run_in("here", script, arguments)
    }

    /// The same in another folder.
    fn run_in(&self, folder: &str, script: &str, arguments: &[&str]) -> Ended {
        let mut command = self.0.command(&[&["run", "-"], arguments].concat());
        command.current_dir(self.at(folder));
        let mut child =
            command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // A refused script may not be read to its end.
        let _ = child.stdin.take().unwrap().write_all(script.as_bytes());
        Ended::of(child.wait_with_output().unwrap())
    }

    /// A run that succeeds silently.
    fn quiet(&self, script: &str, arguments: &[&str]) {
        let ended = self.run(script, arguments);
        assert_eq!((ended.status, ended.err.as_str()), (0, ""), "{script}");
    }

    /// A run that fails with this status and this message.
    fn fails(&self, script: &str, arguments: &[&str], status: i32, said: &str) {
        let ended = self.run(script, arguments);
        assert_eq!((ended.status, ended.out.as_str()), (status, ""), "{script}: {}", ended.err);
        assert!(ended.err.contains(said), "{script}: {}", ended.err);
    }
}

#[test]
fn a_preset_in_place_of_a_script_is_told() {
    let ended = Scripts::new().0.run(&["run", "wavy-sphere"]);
    assert_eq!(ended.status, 2);
    assert!(
        ended.err.contains("wavy-sphere is a preset, and run takes a script of commands"),
        "{}",
        ended.err
    );
}

#[test]
fn a_script_walks_and_exports_and_its_session_walks_again() {
    let home = Scripts::new();
    let script = "# the first instability\nopen wavy-sphere gap.amplitude=0.003\nstep 3\nrun\njump\n\
                  set gap.amplitude=0.0025\ncontrol force\nmove-to event 2\nundo\nnext-event\n\
                  export walk walk.csv\nexport script again.pulloff\npin\npins all\nexport curve curve.json\n";
    home.quiet(script, &[]);
    let walk = fs::read(home.at("here/walk.csv")).unwrap();
    assert!(String::from_utf8_lossy(&walk).lines().count() > 5);
    let again = fs::read_to_string(home.at("here/again.pulloff")).unwrap();
    assert!(again.contains("\nopen wavy-sphere gap.amplitude=0.003\nstep 3\nrun\njump\n"), "{again}");
    home.quiet(&format!("{again}export walk again.csv\nexport script third.pulloff\n"), &[]);
    assert_eq!(fs::read(home.at("here/again.csv")).unwrap(), walk);
    assert_eq!(fs::read_to_string(home.at("here/third.pulloff")).unwrap(), again);
    let curve: serde_json::Value =
        serde_json::from_slice(&fs::read(home.at("here/curve.json")).unwrap()).unwrap();
    assert!(curve["points"].as_array().unwrap().len() > 100);
}

#[test]
fn an_exported_script_finds_its_files_from_any_folder() {
    let home = Scripts::new();
    fs::create_dir(home.at("there")).unwrap();
    for (name, factor) in [("a.csv", 0.1), ("b.csv", 0.2)] {
        let rows: Vec<String> =
            (0..50).map(|i| format!("{},{}", 0.01 * f64::from(i), factor * f64::from(i * i))).collect();
        fs::write(home.at("here").join(name), format!("delta,force\n{}\n", rows.join("\n"))).unwrap();
    }
    let rows: Vec<String> = (0..20).map(f64::from).map(|i| format!("{i}, {}", i * i / 1000.0)).collect();
    fs::write(home.at("here/scan.csv"), format!("r, h\n{}\n", rows.join("\n"))).unwrap();
    let own = "[material]\neffective_modulus=1\nwork_of_adhesion=0.1\n[gap]\nshape='profile'\nfile='scan.csv'\n\
               [path]\nstart_contact_radius=5\n";
    fs::write(home.at("here/own.toml"), own).unwrap();
    for (at, begins) in [
        "open wavy-sphere data.file=a.csv\nstep 2\nset data.file=b.csv\nstep\n",
        "open wavy-sphere\nset data.file=a.csv gap.amplitude=0.003\nstep 2\n",
        "open own.toml\nset data.file=a.csv\nstep 2\n",
        "open fig-3-jkr\nset gap.shape=profile gap.file=scan.csv path.start_contact_radius=5\nstep\n",
    ]
    .into_iter()
    .enumerate()
    {
        let there = format!("../there/{at}.pulloff");
        home.quiet(&format!("{begins}export script {there}\nexport walk {at}.csv\n"), &["--anywhere"]);
        let script = fs::read_to_string(home.at(&format!("there/{at}.pulloff"))).unwrap();
        let ended = home.run_in("there", &format!("{script}export walk {at}.csv\n"), &[]);
        assert_eq!((ended.status, &*ended.err), (0, ""), "{script}");
        let walk = |folder: &str| fs::read_to_string(home.at(&format!("{folder}/{at}.csv"))).unwrap();
        // A column may hold the names of files.
        let above = format!("{}/", home.at("here").display());
        assert_eq!(walk("here"), walk("there").replace(&above, ""), "{script}");
    }
}

#[test]
fn a_script_studies_a_quantity_over_a_value() {
    let home = Scripts::new();
    home.fails("export study s.csv", &[], 2, "there is no study to export");
    home.fails("study", &[], 2, "study needs a quantity");
    home.fails("study largest_pull gap.radius", &[], 2, "unknown key gap.radius");
    // The study is that of the values at its export.
    let script = "open fig-3-jkr\nstudy largest_pull work_of_adhesion\nexport study first.csv\n\
                  set work_of_adhesion=0.5\nstep\nexport study s.csv\nexport study s.toml\nexport figure s.svg study\n\
                  study largest_pull work_of_adhesion\nexport figure seen.svg\n";
    home.quiet(script, &[]);
    let [named, seen] = ["s", "seen"].map(|name| fs::read(home.at(&format!("here/{name}.svg"))).unwrap());
    assert!(named == seen);
    let [first, second] =
        ["first", "s"].map(|name| fs::read_to_string(home.at(&format!("here/{name}.csv"))).unwrap());
    assert!(first != second && first.lines().count() > 50);
    let mut sweep = home.0.command(&["sweep", "s.toml", "--output", "sweep.csv"]);
    let ended = Ended::of(sweep.current_dir(home.at("here")).output().unwrap());
    assert_eq!(ended.status, 0, "{}", ended.err);
}

/// A bare number of a formula's parameter is in the parameter's own unit, in a study, in its sweep, and in any sweep.
#[test]
fn a_parameter_with_a_unit_is_counted_in_it_by_studies_and_sweeps() {
    let home = Scripts::new();
    let gap = "formula = \"r^2/(2*R) + A*(1 - cos(2*pi*r/L))\"\nparameters.R = { value = 5, unit = \"mm\" }\n\
               parameters.A = { value = 1, unit = \"um\" }\nparameters.L = { value = 250, unit = \"um\" }\n";
    let si = fs::read_to_string("presets/fig-9-si.toml").unwrap();
    let (head, rest) = si.split_once("[gap]").unwrap();
    let (_, tail) = rest.split_once("\n[").unwrap();
    fs::write(home.at("here/f.toml"), format!("{head}[gap]\nshape = \"formula\"\n{gap}\n[{tail}")).unwrap();
    home.quiet("open f.toml\nstudy largest_pull R=4..6\nexport study s.csv\nexport study s.toml", &[]);
    let spec = "preset = \"f.toml\"\nquantities = [\"largest_pull\"]\n[[axis]]\nkey = \"R\"\n";
    let own = format!("{spec}values = [5, \"5 mm\", 5.0, \"5\", \"5000 um\"]\n");
    let even = format!("{spec}linear = {{ from = 4, to = 6, count = 3 }}\n");
    fs::write(home.at("here/own.toml"), own).unwrap();
    fs::write(home.at("here/even.toml"), even).unwrap();
    let rows = |name: &str| -> Vec<[f64; 2]> {
        let text = fs::read_to_string(home.at(&format!("here/{name}"))).unwrap();
        let cells = text.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
        cells.map(|cells| [1, 2].map(|at| cells[at].parse().unwrap())).collect()
    };
    for name in ["s", "own", "even"] {
        let spec = format!("{name}.toml");
        let mut sweep = home.0.command(&["sweep", &spec, "--output", &format!("{name}-rows.csv")]);
        let ended = Ended::of(sweep.current_dir(home.at("here")).output().unwrap());
        assert_eq!(ended.status, 0, "{}", ended.err);
    }
    let swept = rows("s-rows.csv");
    let [first, last] = [swept[0][0], swept[swept.len() - 1][0]];
    assert_eq!((first, last), (4e-3, 6e-3));
    let own = rows("own-rows.csv");
    assert_eq!(own, vec![[5e-3, own[0][1]]; 5]);
    assert_eq!(rows("even-rows.csv").iter().map(|row| row[0]).collect::<Vec<_>>(), [4e-3, 5e-3, 6e-3]);
    let studied = fs::read_to_string(home.at("here/s.csv")).unwrap();
    for (line, [value, pull]) in studied.lines().skip(1).zip(&swept) {
        let cells: Vec<f64> = line.split(',').take(2).map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(cells, [*value, *pull]);
    }
}

#[test]
fn a_script_in_si_takes_units_and_bare_si_numbers() {
    let home = Scripts::new();
    let set = "set material.work_of_adhesion=\"20 mJ/m^2\"\nset material.work_of_adhesion=0.03\n";
    home.quiet(&format!("open fig-9-si\n{set}step\nexport script a.pulloff"), &[]);
    let lines = fs::read_to_string(home.at("here/a.pulloff")).unwrap();
    assert!(
        lines.contains("set material.work_of_adhesion=0.02\nset material.work_of_adhesion=0.03\nstep 1\n"),
        "{lines}"
    );
}

#[test]
fn the_first_line_that_fails_ends_the_script_and_what_ended_a_run_does_not() {
    let home = Scripts::new();
    let preset = ["--preset", "wavy-sphere", "--set", "path.end_contact_radius=0.39"];
    home.fails("step\n\njump\nexport walk w.csv", &preset, 2, "standard input:3: jump: the state is stable");
    assert!(!home.at("here/w.csv").exists());
    // The end of the path, twice, and then a line that may fail.
    home.quiet("next-event\nnext-event\ntry jump\ntry open none\nquit\nundo\nundo\nundo\nundo", &preset);
    for (script, said) in [
        ("set gap.amplitude=-1", "1: set gap.amplitude=-1: gap.amplitude = -1.0 is out of range"),
        ("move-to event 9", "there is no event 9: the path has"),
        ("open wavy", "no preset is called \"wavy\""),
        ("set gap.shape=profile gap.file=none.csv", "none.csv"),
    ] {
        home.fails(script, &[], 2, said);
    }
    for (script, said) in [
        ("step\nstepp", "standard input:2:1: no command is called \"stepp\"; did you mean step?"),
        ("zoom-in", "zoom-in only changes what a screen shows"),
        // Refused before anything is walked.
        ("step 500\nexport walk w.txt", "standard input:2:13: the file must end in .csv or .json"),
        ("export script w.csv", "1:15: the file must end in .pulloff or .txt"),
    ] {
        home.fails(script, &[], 2, said);
    }
    home.fails("open cone", &preset, 2, "--preset, --set and --control would be lost");
    home.fails("step", &["--preset", "none"], 2, "no preset is called");
    home.fails(&"#\n".repeat(600_000), &[], 2, "more than the 1048576 bytes");
    let output = home.run("step 2\nnext-event\n", &["--verbose"]);
    assert!(output.err.starts_with("1: step 2: Stable under"), "{}", output.err);
    assert_eq!(output.err.lines().count(), 2);
}

#[test]
fn a_walk_records_every_key_that_changed_during_it() {
    let home = Scripts::new();
    let script = "step\nset material.effective_modulus=\"25 kPa\"\nstep\nset path.start_contact_radius=\"400 um\"\n\
                  control force\nset gap.shape=sphere\nexport walk w.csv\nexport walk w.json\n";
    home.quiet(script, &["--preset", "fig-9-si"]);
    let text = fs::read_to_string(home.at("here/w.csv")).unwrap();
    let mut lines = csv::Reader::from_reader(text.as_bytes());
    let names: Vec<String> = lines.headers().unwrap().iter().map(str::to_owned).collect();
    let known = names.iter().position(|name| name == "admissible").unwrap();
    assert_eq!(
        names[known + 1..],
        [
            "material.effective_modulus",
            "gap.shape",
            "gap.amplitude",
            "gap.wavelength",
            "path.control",
            "path.start_contact_radius"
        ]
    );
    let rows: Vec<csv::StringRecord> = lines.records().map(|row| row.unwrap()).collect();
    let cell = |row: &csv::StringRecord, name: &str| {
        row[names.iter().position(|known| known == name).unwrap()].to_owned()
    };
    let number = |row: &csv::StringRecord, name: &str| cell(row, name).parse::<f64>().unwrap();
    let (first, last) = (&rows[0], &rows[rows.len() - 1]);
    // In the units of the preset's numbers: SI.
    let modulus = |row| cell(row, "material.effective_modulus");
    assert_ne!(modulus(first), "25000.0");
    assert_eq!([modulus(&rows[2]), modulus(last)], ["25000.0", "25000.0"]);
    assert_eq!(cell(last, "path.start_contact_radius"), "0.0004");
    assert_eq!(
        (cell(first, "path.control"), cell(last, "path.control")),
        ("displacement".into(), "force".into())
    );
    // Values that the preset no longer has are empty, and values that did not change have no column.
    assert!(number(first, "gap.amplitude") > 0.0 && cell(last, "gap.amplitude").is_empty());
    assert_eq!(cell(last, "gap.shape"), "sphere");
    let json: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(home.at("here/w.json")).unwrap()).unwrap();
    let points = json["points"].as_array().unwrap();
    assert_eq!(points.len(), rows.len());
    assert_eq!(points[0]["material.effective_modulus"].as_f64(), modulus(first).parse().ok());
    assert!(points[points.len() - 1]["gap.amplitude"].is_null());
    // Nothing changed: the columns are the usual ones.
    home.quiet("step\nexport walk plain.csv\n", &["--preset", "fig-9-si"]);
    let plain = fs::read_to_string(home.at("here/plain.csv")).unwrap();
    assert!(plain.lines().next().unwrap().ends_with(",admissible"), "{plain}");
}

#[test]
fn a_script_writes_below_the_current_folder_and_replaces_nothing_unless_told() {
    let home = Scripts::new();
    let here = home.at("here");
    fs::create_dir_all(here.join("sub")).unwrap();
    fs::create_dir(home.at("there")).unwrap();
    symlink(home.at("there"), here.join("link")).unwrap();
    symlink(home.at("there/target.csv"), here.join("file.csv")).unwrap();
    symlink(here.join("sub"), home.at("back")).unwrap();
    let absolute = here.join("sub/absolute.csv");
    for inside in
        ["a.csv", "sub/b.csv", "sub/../c.csv", "../here/d.csv", "../back/e.csv", absolute.to_str().unwrap()]
    {
        home.quiet(&format!("export walk {inside}"), &[]);
    }
    let outside = home.at("there/x.csv");
    for path in ["../x.csv", "link/x.csv", "file.csv", "../there/x.csv", "~/x.csv", outside.to_str().unwrap()]
    {
        home.fails(&format!("export walk {path}"), &[], 2, "is not below the current folder");
    }
    assert_eq!(fs::read_dir(home.at("there")).unwrap().count(), 0);
    home.fails("export walk none/x.csv", &[], 2, "No such file");
    home.quiet("export walk link/x.csv\nexport walk ../y.csv", &["--anywhere"]);
    assert!(outside.exists() && home.at("y.csv").exists());
    // Replacing files.
    fs::write(here.join("a.csv"), "mine").unwrap();
    home.fails("export walk a.csv", &[], 2, "a.csv: already exists; --overwrite replaces it");
    home.fails("export walk a.csv replace", &[], 2, "--overwrite replaces it");
    assert_eq!(fs::read(here.join("a.csv")).unwrap(), b"mine");
    home.quiet("export walk a.csv\nexport walk a.csv replace", &["--overwrite"]);
    assert_ne!(fs::read(here.join("a.csv")).unwrap(), b"mine");
    // Presets: by name into their folder; a file only where it may be replaced.
    home.quiet("set gap.amplitude=0.003\nsave-as mine", &[]);
    home.fails("save-as mine", &[], 2, "a preset called mine exists");
    home.fails("open mine\nset gap.amplitude=0.004\nsave", &[], 2, "only with --overwrite");
    home.quiet("open mine\nset gap.amplitude=0.004\nsave", &["--overwrite"]);
    let mine = home.at("config/pulloff/presets/mine.toml");
    assert!(fs::read_to_string(&mine).unwrap().contains("amplitude = 0.004"));
    fs::copy(&mine, home.at("there/p.toml")).unwrap();
    home.fails("open ../there/p.toml\nset gap.amplitude=0.0041\nsave", &["--overwrite"], 2, "is not below");
}

const SUBCOMMANDS: [&str; 7] = ["trace", "unload", "verify", "run", "presets", "completions", "man"];

#[test]
fn the_completions_of_every_shell_ask_the_program() {
    let home = Home::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let text = home.quiet(&["completions", shell]);
        assert!(text.contains("pulloff") && text.contains("COMPLETE"), "{shell}: {text}");
    }
    let path = home.path("pulloff.bash");
    fs::write(&path, home.quiet(&["completions", "bash"])).unwrap();
    // If there is a bash, it finds no fault in the script.
    if let Ok(checked) = Command::new("bash").arg("-n").arg(&path).output() {
        assert!(checked.status.success(), "{}", String::from_utf8_lossy(&checked.stderr));
    }
}

#[test]
fn the_manual_page_has_every_subcommand_and_every_command_with_its_keys() {
    let home = Home::new();
    let page = home.quiet(&["man"]);
    assert!(page.contains(".TH pulloff 1"), "{page}");
    for name in SUBCOMMANDS {
        let heading = format!(".SH \"PULLOFF {}\"", name.to_uppercase());
        assert!(page.contains(&heading), "no {heading} in\n{page}");
    }
    for text in
        ["overwrite", "\\fBnext\\-event\\fR", "\\fBset\\fR [KEY=VALUE ...]", "write curve, walk, events"]
    {
        assert!(page.contains(text), "no {text} in\n{page}");
    }
    assert!(page.contains("\\fBstep\\fR [number of steps] (Space)"), "{page}");
    fs::create_dir_all(home.path("config/pulloff")).unwrap();
    fs::write(home.path("config/pulloff/config.toml"), "[keys]\nstep = \"F4\"").unwrap();
    assert!(home.quiet(&["man"]).contains("[number of steps] (F4)"));
}

#[test]
fn a_script_draws_what_is_seen() {
    let home = Scripts::new();
    let script = "step 5\nexport figure curve.svg\nexport figure cycle.png cycle\nexport figure in.svg pressure\n\
                  export figure law.svg stability\nexport screen screen.txt\n";
    home.quiet(script, &[]);
    let drawn = |name: &str| fs::read_to_string(home.at("here").join(name)).unwrap();
    let axes = |name: &str| {
        let text = drawn(name);
        let document = roxmltree::Document::parse(&text).unwrap();
        document.descendants().filter_map(|node| node.text().map(str::to_owned)).collect::<Vec<_>>().join("|")
    };
    assert!(
        axes("curve.svg").contains("δ/R") && axes("curve.svg").contains("state"),
        "{}",
        axes("curve.svg")
    );
    assert!(axes("in.svg").contains("p/E*") && axes("law.svg").contains("s/λ"));
    assert_eq!(fs::read(home.at("here/cycle.png")).unwrap()[1..4], *b"PNG");
    // The screen of 100x30, including the walk.
    let screen = drawn("screen.txt");
    assert_eq!(screen.lines().count(), 30);
    assert!(screen.lines().all(|line| line.chars().count() <= 100) && screen.contains("@ 5 "), "{screen}");
    // Nothing is replaced unless asked; what cannot be drawn says why.
    home.fails("export screen screen.txt\n", &[], 2, "exists");
    home.fails("export figure walk.svg walk\n", &[], 2, "export walk writes it");
    home.fails("export figure far.svg residuals\n", &[], 2, "no measured curve");
    home.fails("export figure curve.txt\n", &[], 2, "must end in");
}

#[test]
fn a_script_that_takes_long_shows_its_line_on_a_terminal() {
    let home = tempfile::tempdir().unwrap();
    let script = home.path().join("s.pulloff");
    // Two thousand rings take seconds.
    fs::write(&script, "step 1\nset basis.kind=rings\nset basis.rings=2000\n").unwrap();
    let (folder, path) = (home.path().to_str().unwrap(), script.to_str().unwrap());
    let env = [("HOME", folder), ("XDG_CONFIG_HOME", folder)];
    let mut pty = Pty::spawn(env!("CARGO_BIN_EXE_pulloff").as_ref(), &["run", path], &env, 80, 24);
    pty.wait_for(|screen| screen.contains("line 3 of 3"), "the line that takes long");
    pty.signal(rustix::process::Signal::KILL);
    pty.exit_code();
}
